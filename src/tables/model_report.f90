!> What was understood of a deck, for the listing and for `atrito check`.
module atrito_model_report
   use atrito_controls, only: METHOD_NAME
   use atrito_element_table, only: KINDS, kind_of
   use atrito_load_resultants, only: force_t, load_resultants, last_value
   use atrito_row_tables, only: joined_text
   use atrito_kinds, only: ip, wp
   use atrito_grid, only: grid_t, begin_grid, add_row, put_grid, CELL
   use atrito_rigid_report, only: describe_references
   use atrito_table, only: clear_small
   use atrito_strings, only: to_text
   use atrito_model, only: unit_names, model_t, step_t, requested_t, increments_t, interaction_t, FORMULATION_NAME, FRICTION_NAME, &
                           KERNEL_NAME, FRICTION_NONE, FRICTION_NONLOCAL, LOAD_TRACTION, SURFACE_SEGMENTS
   use atrito_mesh, only: is_revolved
   use atrito_orthotropy, only: SPATIAL, inverse_of
   use atrito_sets, only: set_count
   use atrito_page, only: page_t, add_line, add_blank, add_entry, number, plural
   implicit none (type, external)
   private
   public :: describe_model, describe_counts, describe_instances, describe_steps, is_history

   integer, parameter :: DIGITS = 6                 !< of numbers for people

contains

   !> Everything that was read: counts, parameters, materials, sections, supports, loads, interactions, method.
   subroutine describe_model(page, model)
      type(page_t), intent(inout) :: page !< the lines are added to it
      type(model_t), intent(in) :: model  !< as read, refined if that was asked

      call describe_counts(page, model)
      call describe_instances(page, model)
      call describe_parameters(page, model)
      call describe_materials(page, model)
      call describe_amplitudes(page, model)
      call describe_steps(page, model)
      call describe_interactions(page, model)
      call describe_fields(page, model)
   end subroutine describe_model

   !> How much there is of each kind.
   subroutine describe_counts(page, model)
      type(page_t), intent(inout) :: page !< the lines are added to it
      type(model_t), intent(in) :: model  !< mesh, sets, materials and pairs are counted
      character(len=:), allocatable :: text
      integer(ip) :: counts(size(KINDS)), e, kind, rigid

      text = unit_names(model%units)
      if (len(text) > 0) call add_entry(page, 'units', text)
      call add_entry(page, 'nodes', to_text(model%mesh%n_nodes))
      counts = 0
      do e = 1, model%mesh%n_elements
         kind = kind_of(model%mesh%shape(e), model%mesh%state(e))
         counts(kind) = counts(kind) + 1
      end do
      text = ''                                     ! ` (75 CPE4, 36 CPS9)`
      do kind = 1, size(KINDS, kind=ip)
         if (counts(kind) > 0) text = text//', '//to_text(counts(kind))//' '//trim(KINDS(kind)%name)
      end do
      if (len(text) > 0) text = ' ('//text(3:)//')'
      call add_entry(page, 'elements', to_text(model%mesh%n_elements)//text)
      if (model%levels > 0) call add_entry(page, 'refined', plural(model%levels, 'time', 'times')// &
                                           ': each element of the deck is '//to_text(4_ip**model%levels)//' now')
      if (model%n_cut > 0) call add_entry(page, 'refined', 'where the error is: '//to_text(model%n_cut)// &
                                          ' elements of the deck are cut')
      call add_entry(page, 'node sets, element sets', &
                     to_text(set_count(model%node_sets))//', '//to_text(set_count(model%element_sets)))
      text = to_text(size(model%surfaces, kind=ip))
      rigid = count(model%surfaces%kind == SURFACE_SEGMENTS, kind=ip)
      if (rigid > 0) text = text//' ('//to_text(rigid)//' of rigid segments)'
      call add_entry(page, 'surfaces', text)
      call add_entry(page, 'materials, sections', to_text(size(model%materials, kind=ip))//', '// &
                     to_text(size(model%sections, kind=ip)))
      call add_entry(page, 'contact pairs', to_text(size(model%pairs, kind=ip)))
      if (len(joined_text(model)) > 0) call add_entry(page, 'joined by', joined_text(model))
   end subroutine describe_counts

   !> The instances of parts: what their numbers are here, and where they stand.
   subroutine describe_instances(page, model)
      type(page_t), intent(inout) :: page !< the lines are added to it
      type(model_t), intent(in) :: model  !< its instances are read
      type(grid_t) :: grid
      integer(ip) :: i

      if (.not. allocated(model%instances)) return
      if (size(model%instances, kind=ip) == 0) return
      call add_blank(page)
      call begin_grid(grid, 2, 'instance'//CELL//'part'//CELL//'number 1 is'//CELL//'dx [L]'//CELL//'dy [L]'//CELL//'turned [deg]')
      do i = 1, size(model%instances, kind=ip)
         associate (instance => model%instances(i))
            call add_row(grid, instance%name//CELL//instance%part//CELL//to_text(instance%first_number)//CELL// &
                         number(instance%shift(1), DIGITS)//CELL//number(instance%shift(2), DIGITS)//CELL// &
                         number(instance%angle, DIGITS))
         end associate
      end do
      call put_grid(page, grid)
   end subroutine describe_instances

   subroutine describe_parameters(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(grid_t) :: grid
      character(len=:), allocatable :: written
      integer(ip) :: i

      if (size(model%parameters, kind=ip) == 0) return
      call add_blank(page)
      call begin_grid(grid, 2, 'parameter'//CELL//'as written'//CELL//'value')
      do i = 1, size(model%parameters, kind=ip)
         associate (parameter => model%parameters(i))
            written = ''
            if (allocated(parameter%written)) written = parameter%written
            if (parameter%overridden) written = 'by --set, not '//written
            call add_row(grid, parameter%name//CELL//written//CELL//number(parameter%value, 10))
         end associate
      end do
      call put_grid(page, grid)
   end subroutine describe_parameters

   subroutine describe_materials(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      character(len=:), allocatable :: thickness, elastic
      type(grid_t) :: grid
      integer(ip) :: elements(size(model%sections, kind=ip)), i, k

      elements = 0
      if (size(elements) > 0) then
         do i = 1, size(model%section_of, kind=ip)
            elements(model%section_of(i)) = elements(model%section_of(i)) + 1
         end do
      end if
      call add_blank(page)
      call begin_grid(grid, 1, 'material'//CELL//'E [F/L^2]'//CELL//'mu'//CELL//'density')
      do i = 1, size(model%materials, kind=ip)
         associate (material => model%materials(i))
            elastic = number(material%young, DIGITS)//CELL//number(material%poisson, DIGITS)
            if (material%is_orthotropic) elastic = 'orthotropic'//CELL
            call add_row(grid, material%name//CELL//elastic//CELL//number(material%density, DIGITS))
         end associate
      end do
      call put_grid(page, grid)
      if (any(model%materials%is_orthotropic)) call describe_orthotropic(page, model)
      if (any(model%materials%has_expansion)) then
         call add_blank(page)
         do k = 1, size(model%materials, kind=ip)
            associate (material => model%materials(k))
               if (material%has_expansion) call add_entry(page, material%name//', expansion', number(material%expansion, DIGITS)// &
                                                          ' [1/temperature]')
            end associate
         end do
      end if
      call add_blank(page)
      call begin_grid(grid, 3, 'section of elements'//CELL//'material'//CELL//'formulation'//CELL//'elements'//CELL//'thickness')
      do i = 1, size(model%sections, kind=ip)
         associate (section => model%sections(i))
            thickness = number(section%thickness, DIGITS)
            if (section%is_tapered) thickness = 'of nodes'
            call add_row(grid, section%elset//CELL//model%materials(section%material)%name//CELL// &
                         trim(FORMULATION_NAME(section%formulation))//CELL//to_text(elements(i))//CELL//thickness)
         end associate
      end do
      call put_grid(page, grid)
   end subroutine describe_materials

   !> Moduli and Poisson's ratios of orthotropic materials, and the axes of the sections that have them.
   subroutine describe_orthotropic(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      real(wp) :: s(SPATIAL, SPATIAL), moduli(7)
      type(grid_t) :: grid
      character(len=:), allocatable :: text
      integer(ip) :: i
      integer :: k

      call add_blank(page)
      call begin_grid(grid, 1, 'orthotropic'//CELL//'E1'//CELL//'E2'//CELL//'E3'//CELL//'nu12'//CELL//'nu13'//CELL//'nu23'//CELL// &
                      'G12')
      do i = 1, size(model%materials, kind=ip)
         if (.not. model%materials(i)%is_orthotropic) cycle
         s = inverse_of(model%materials(i)%stiffness)
         moduli = [1/s(1, 1), 1/s(2, 2), 1/s(3, 3), -s(1, 2)/s(1, 1), -s(1, 3)/s(1, 1), -s(2, 3)/s(2, 2), 1/s(4, 4)]
         text = model%materials(i)%name
         do k = 1, size(moduli)
            text = text//CELL//number(moduli(k), DIGITS)
         end do
         call add_row(grid, text)
      end do
      call put_grid(page, grid)
      do i = 1, size(model%sections, kind=ip)
         associate (section => model%sections(i))
            if (model%materials(section%material)%is_orthotropic) then
               call add_entry(page, section%elset//', first axis', '('//number(section%axis(1), DIGITS)//', '// &
                              number(section%axis(2), DIGITS)//')')
            end if
         end associate
      end do
   end subroutine describe_orthotropic

   subroutine describe_amplitudes(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip) :: i

      if (.not. allocated(model%amplitudes)) return
      if (size(model%amplitudes) > 0) call add_blank(page)
      do i = 1, size(model%amplitudes, kind=ip)
         associate (curve => model%amplitudes(i))
            call add_entry(page, curve%name//', amplitude', number(minval(curve%value), DIGITS)//' to '// &
                           number(maxval(curve%value), DIGITS)//' at times '//number(curve%time(1), DIGITS)//' to '// &
                           number(curve%time(size(curve%time)), DIGITS)//trim(merge(' of the history', ' of the step   ', &
                                                                         curve%is_total_time))//trim(merge(', smooth', '        ', &
                                                                                                                  curve%is_smooth)))
         end associate
      end do
   end subroutine describe_amplitudes

   !> What acts in each step; of a single one that is a single increment without more words.
   subroutine describe_steps(page, model, most)
      type(page_t), intent(inout) :: page            !< the lines are added to it
      type(model_t), intent(in) :: model             !< its steps are read
      integer(ip), intent(in), optional :: most      !< so many of the first; left out: all
      character(len=:), allocatable :: title
      integer(ip) :: k, n, i

      n = size(model%steps, kind=ip)
      do k = 1, n
         if (present(most)) then
            if (k > most) exit
         end if
         if (n > 1) then
            call add_blank(page)
            title = ''
            if (allocated(model%steps(k)%title)) title = model%steps(k)%title
            if (len(title) > 0) title = ': '//title
            call add_line(page, '   step '//to_text(k)//title)
         end if
         call describe_increments(page, model%steps(k), n)
         ! Overlaps that *CONTACT INTERFERENCE resolves, until they are.
         if (allocated(model%steps(k)%overlap)) then
            do i = 1, size(model%pairs, kind=ip)
               if (model%steps(k)%overlap_from(i) <= 0.0_wp) cycle
               call add_entry(page, 'overlap of pair '//to_text(i), 'up to '// &
                              number(max(0.0_wp, -minval(model%points(i)%gap)), DIGITS)//' [L], '// &
                              trim(merge('allowed                 ', 'resolved over the step  ', &
                                         model%steps(k)%overlap(i) > 0.0_wp)))
            end do
         end if
         call describe_supports(page, model, k)
         call describe_loads(page, model, k)
      end do
      if (k > n) return
      call add_blank(page)
      call add_line(page, '   and '//to_text(n - k + 1)//' more steps')
   end subroutine describe_steps

   !> Several steps, or several increments of one.
   pure logical function is_history(model)
      type(model_t), intent(in) :: model !< its steps are read; it has one at least

      is_history = size(model%steps) > 1
      if (.not. is_history) is_history = model%steps(1)%increments%initial < model%steps(1)%increments%period
   end function is_history

   subroutine describe_increments(page, step, n_steps)
      type(page_t), intent(inout) :: page
      type(step_t), intent(in) :: step
      integer(ip), intent(in) :: n_steps
      type(increments_t), parameter :: ONE = increments_t()
      character(len=:), allocatable :: text

      associate (this => step%increments)
         text = 'one, of time '//number(this%period, DIGITS)
         if (this%least < this%period) then
            text = number(this%initial, DIGITS)//' to begin with, '//number(this%least, DIGITS)//' to '// &
                   number(this%greatest, DIGITS)//', '//number(this%period, DIGITS)//' in all; at most '//to_text(this%most)
         else if (n_steps == 1) then
            if (this%period == ONE%period .and. .not. step%at_once) return
         end if
         if (n_steps == 1) call add_blank(page)
      end associate
      call add_entry(page, 'increments', text)
      if (step%at_once) call add_entry(page, 'loads', 'at once, not over the step')
   end subroutine describe_increments

   subroutine describe_supports(page, model, k)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: k                  !< the step
      real(wp), allocatable :: value(:)
      integer(ip) :: along_1, i, moved, n
      character(len=:), allocatable :: text

      n = model%steps(k)%prescribed%n
      call add_blank(page)
      if (n == 0) then
         call add_entry(page, 'prescribed displacements', 'none')
         return
      end if
      along_1 = count(model%steps(k)%prescribed%dof(:n) == 1, kind=ip)
      value = [(last_value(model, k, model%steps(k)%prescribed, i), i=1, n)]
      moved = count(abs(value) > 0.0_wp, kind=ip)
      text = to_text(n)//' ('//to_text(along_1)//' along 1, '//to_text(n - along_1)//' along 2)'
      if (moved > 0) text = text//', '//to_text(moved)//' not zero, the largest '//number(maxval(abs(value)), DIGITS)//' [L]'
      call add_entry(page, 'prescribed displacements', text)
   end subroutine describe_supports

   subroutine describe_loads(page, model, k)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: k                  !< the step
      type(force_t) :: concentrated, pressure, body
      type(grid_t) :: grid
      real(wp) :: force, arm
      integer(ip) :: n_loads

      call load_resultants(model, concentrated, pressure, body, k)
      force = concentrated%terms + pressure%terms + body%terms       ! by which round-off is measured
      if (is_revolved(model%mesh)) then              ! the circle has no resultant along a radius, and no moment
         concentrated = force_t([0.0_wp, concentrated%f(2)])
         pressure = force_t([0.0_wp, pressure%f(2)])
         body = force_t([0.0_wp, body%f(2)])
      end if
      call describe_references(page, model, k)
      call add_blank(page)
      associate (step => model%steps(k))
         n_loads = step%node_loads%n + step%element_loads%n + step%rigid_loads%n
      end associate
      if (size(model%steps) > 1 .and. n_loads == 0) then
         call add_entry(page, 'loads', 'none')
      else
         arm = maxval(abs(model%mesh%x))
         call begin_grid(grid, 1, 'loads, resultants'//CELL//'F1 [F]'//CELL//'F2 [F]'//CELL//'moment about 0,0 [F L]')
         call add_force(grid, 'on nodes', concentrated, force, arm)
         call add_force(grid, trim(merge('loads on faces   ', 'pressure on faces', &
                                         any(model%steps(k)%element_loads%kind == LOAD_TRACTION))), pressure, force, arm)
         call add_force(grid, 'in elements', body, force, arm)
         call add_force(grid, 'all', force_t(concentrated%f + pressure%f + body%f, &
                                             concentrated%moment + pressure%moment + body%moment), force, arm)
         call put_grid(page, grid)
      end if
      if (.not. allocated(model%steps(k)%heating)) return
      call add_blank(page)
      call add_entry(page, 'rise of the temperature', number(minval(model%steps(k)%heating), DIGITS)//' to '// &
                     number(maxval(model%steps(k)%heating), DIGITS)//' at the nodes, '// &
                     to_text(count(abs(model%steps(k)%heating) > 0.0_wp, kind=ip))//' not zero')
   end subroutine describe_loads

   !> A resultant in a row; what is round-off of a force, or of its moment with an arm, is 0.
   pure subroutine add_force(grid, name, force, scale, arm)
      type(grid_t), intent(inout) :: grid
      character(len=*), intent(in) :: name
      type(force_t), intent(in) :: force
      real(wp), intent(in) :: scale, arm
      real(wp) :: values(3)
      real(wp), parameter :: SUMMED = 10.0_wp        !< round-offs of a sum over elements

      values = [force%f, force%moment]
      call clear_small(SUMMED*scale, values(:2))
      call clear_small(SUMMED*scale*arm, values(3:))
      call add_row(grid, name//CELL//number(values(1), DIGITS)//CELL//number(values(2), DIGITS)//CELL//number(values(3), DIGITS))
   end subroutine add_force

   subroutine describe_interactions(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      character(len=:), allocatable :: text
      integer(ip) :: i

      if (size(model%pairs, kind=ip) == 0) return
      call add_blank(page)
      do i = 1, size(model%interactions, kind=ip)
         associate (law => model%interactions(i))
            text = 'exact (delta = 0)'
            if (law%delta > 0.0_wp) text = 'penalty, delta '//number(law%delta, DIGITS)//' [L^3/F]'
            call add_entry(page, law%name//', contact', text)
            call add_entry(page, law%name//', friction', friction_text(law))
         end associate
      end do
      associate (controls => model%steps(size(model%steps))%controls)
         call add_entry(page, 'outer loop', trim(METHOD_NAME(controls%method))//', tolerance '// &
                        number(controls%tolerance, 3)//', at most '//plural(controls%max_iterations, 'iteration', 'iterations'))
      end associate
   end subroutine describe_interactions

   !> The field file that the deck asks for.
   subroutine describe_fields(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(requested_t) :: fields
      integer :: k
      character(len=:), allocatable :: text

      fields = requested_t()
      do k = 1, size(model%steps)
         associate (of_step => model%steps(k)%requests%fields)
            fields%nodes = fields%nodes .or. of_step%nodes
            fields%reactions = fields%reactions .or. of_step%reactions
            fields%stress = fields%stress .or. of_step%stress
            fields%contact = fields%contact .or. of_step%contact
         end associate
      end do
      text = ''
      if (fields%nodes) text = text//' U'
      if (fields%reactions) text = text//' RF'
      if (fields%stress) text = text//' S'
      if (fields%contact) text = text//' contact'
      if (len(text) == 0) return
      call add_blank(page)
      call add_entry(page, 'field file', model%deck_name//'.xdmf, with .h5:'//text)
   end subroutine describe_fields

   pure function friction_text(interaction) result(text)
      type(interaction_t), intent(in) :: interaction
      character(len=:), allocatable :: text

      text = 'none'
      if (interaction%friction == FRICTION_NONE) return
      text = trim(FRICTION_NAME(interaction%friction))//', nu '//number(interaction%nu, DIGITS)
      if (interaction%friction == FRICTION_NONLOCAL) then
         text = text//', eps '//number(interaction%eps, DIGITS)//' [L], rho '//number(interaction%rho, DIGITS)//' [L], '// &
                trim(KERNEL_NAME(interaction%kernel))
      else if (interaction%stick_slope > 0.0_wp) then
         text = text//', stick slope '//number(interaction%stick_slope, DIGITS)//' [F/L^3]'
      end if
      ! the other way than the law has by itself
      if (interaction%friction == FRICTION_NONLOCAL .and. interaction%is_incremental) text = text//', incremental slip'
      if (interaction%friction /= FRICTION_NONLOCAL .and. .not. interaction%is_incremental) text = text//', total slip'
   end function friction_text

end module atrito_model_report
