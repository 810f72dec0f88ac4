!> What was understood of a deck, for the listing and for `atrito check`.
module atrito_model_report
   use atrito_element_table, only: KINDS, MOST_CORNERS, kind_of
   use atrito_row_tables, only: joined_text
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: depth_at
   use atrito_rigid_report, only: describe_references
   use atrito_strings, only: to_text
   use atrito_face_loads, only: traction_load, hydrostatic_load
   use atrito_mesh, only: face_end, face_nodes, side_count, is_revolved
   use atrito_sets, only: set_count
   use atrito_model, only: model_t, interaction_t, FORMULATION_NAME, METHOD_NAME, FRICTION_NAME, KERNEL_NAME, FRICTION_NONE, &
                           FRICTION_NONLOCAL, LOAD_PRESSURE, LOAD_BODY, LOAD_TRACTION, SURFACE_SEGMENTS
   use atrito_page, only: page_t, add_line, add_blank, add_entry, left, right, number, plural
   implicit none (type, external)
   private
   public :: describe_model, describe_counts, force_t, load_resultants

   !> A resultant [F] and its moment about the origin [F L].
   type :: force_t
      real(wp) :: f(2) = 0.0_wp
      real(wp) :: moment = 0.0_wp
   end type force_t

   integer, parameter :: DIGITS = 6                 !< of numbers for people

contains

   !> Everything that was read: counts, parameters, materials, sections, supports, loads, interactions, method.
   subroutine describe_model(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model

      call describe_counts(page, model)
      call describe_parameters(page, model)
      call describe_materials(page, model)
      call describe_supports(page, model)
      call describe_loads(page, model)
      call describe_interactions(page, model)
      call describe_fields(page, model)
   end subroutine describe_model

   !> How much there is of each kind.
   subroutine describe_counts(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model

      call add_entry(page, 'nodes', to_text(model%mesh%n_nodes))
      call add_entry(page, 'elements', to_text(model%mesh%n_elements)//element_types(model))
      if (model%levels > 0) call add_entry(page, 'refined', plural(model%levels, 'time', 'times')// &
                                           ': each element of the deck is '//to_text(4_ip**model%levels)//' now')
      call add_entry(page, 'node sets, element sets', &
                     to_text(set_count(model%node_sets))//', '//to_text(set_count(model%element_sets)))
      call add_entry(page, 'surfaces', surface_counts(model))
      call add_entry(page, 'materials, sections', to_text(size(model%materials, kind=ip))//', '// &
                     to_text(size(model%sections, kind=ip)))
      call add_entry(page, 'contact pairs', to_text(size(model%pairs, kind=ip)))
      if (len(joined_text(model)) > 0) call add_entry(page, 'joined by', joined_text(model))
   end subroutine describe_counts

   !> ` (75 CPE4, 36 CPS9)`
   pure function element_types(model) result(text)
      type(model_t), intent(in) :: model
      character(len=:), allocatable :: text
      integer(ip) :: counts(size(KINDS)), e, kind

      counts = 0
      do e = 1, model%mesh%n_elements
         kind = kind_of(model%mesh%shape(e), model%mesh%state(e))
         counts(kind) = counts(kind) + 1
      end do
      text = ''
      do kind = 1, size(KINDS, kind=ip)
         if (counts(kind) > 0) text = text//', '//to_text(counts(kind))//' '//trim(KINDS(kind)%name)
      end do
      if (len(text) > 0) text = ' ('//text(3:)//')'
   end function element_types

   pure function surface_counts(model) result(text)
      type(model_t), intent(in) :: model
      character(len=:), allocatable :: text
      integer(ip) :: i, rigid

      rigid = 0
      do i = 1, size(model%surfaces, kind=ip)
         if (model%surfaces(i)%kind == SURFACE_SEGMENTS) rigid = rigid + 1
      end do
      text = to_text(size(model%surfaces, kind=ip))
      if (rigid > 0) text = text//' ('//to_text(rigid)//' of rigid segments)'
   end function surface_counts

   subroutine describe_parameters(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip) :: i

      if (size(model%parameters, kind=ip) == 0) return
      call add_blank(page)
      call add_line(page, '   '//left('parameter', 24)//right('value', 16))
      do i = 1, size(model%parameters, kind=ip)
         associate (parameter => model%parameters(i))
            call add_line(page, '   '//left(parameter%name, 24)//right(number(parameter%value, 10), 16)// &
                          merge('   by --set', '           ', parameter%overridden))
         end associate
      end do
   end subroutine describe_parameters

   subroutine describe_materials(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip) :: elements(size(model%sections, kind=ip)), i

      elements = 0
      if (size(elements) > 0) then
         do i = 1, size(model%section_of, kind=ip)
            elements(model%section_of(i)) = elements(model%section_of(i)) + 1
         end do
      end if
      call add_blank(page)
      call add_line(page, '   '//left('material', 24)//right('E [F/L^2]', 16)//right('mu', 12)//right('density', 16))
      do i = 1, size(model%materials, kind=ip)
         associate (material => model%materials(i))
            call add_line(page, '   '//left(material%name, 24)//right(number(material%young, DIGITS), 16)// &
                          right(number(material%poisson, DIGITS), 12)//right(number(material%density, DIGITS), 16))
         end associate
      end do
      if (any(model%materials%has_expansion)) call describe_expansions(page, model)
      call add_blank(page)
      call add_line(page, '   '//left('section of elements', 24)//right('elements', 16)//right('thickness', 12)//'    '// &
                    left('material', 24)//'formulation')
      do i = 1, size(model%sections, kind=ip)
         associate (section => model%sections(i))
            call add_line(page, '   '//left(section%elset, 24)//right(to_text(elements(i)), 16)// &
                          right(number(section%thickness, DIGITS), 12)//'    '//left(model%materials(section%material)%name, 24)// &
                          trim(FORMULATION_NAME(section%formulation)))
         end associate
      end do
   end subroutine describe_materials

   subroutine describe_expansions(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip) :: i

      call add_blank(page)
      do i = 1, size(model%materials, kind=ip)
         associate (material => model%materials(i))
            if (material%has_expansion) call add_entry(page, material%name//', expansion', &
                                                       number(material%expansion, DIGITS)//' [1/temperature]')
         end associate
      end do
   end subroutine describe_expansions

   subroutine describe_supports(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip) :: along_1, moved, n
      character(len=:), allocatable :: text

      n = model%steps(1)%prescribed%n
      call add_blank(page)
      if (n == 0) then
         call add_entry(page, 'prescribed displacements', 'none')
         return
      end if
      along_1 = count(model%steps(1)%prescribed%dof(:n) == 1, kind=ip)
      moved = count(abs(model%steps(1)%prescribed%value(:n)) > 0.0_wp, kind=ip)
      text = to_text(n)//' ('//to_text(along_1)//' along 1, '//to_text(n - along_1)//' along 2)'
      if (moved > 0) text = text//', '//to_text(moved)//' not zero, the largest '// &
                            number(maxval(abs(model%steps(1)%prescribed%value(:n))), DIGITS)//' [L]'
      call add_entry(page, 'prescribed displacements', text)
   end subroutine describe_supports

   subroutine describe_loads(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(force_t) :: concentrated, pressure, body

      call load_resultants(model, concentrated, pressure, body)
      if (is_revolved(model%mesh)) then              ! the circle has no resultant along a radius, and no moment
         concentrated = force_t([0.0_wp, concentrated%f(2)])
         pressure = force_t([0.0_wp, pressure%f(2)])
         body = force_t([0.0_wp, body%f(2)])
      end if
      call describe_references(page, model)
      call add_blank(page)
      call add_line(page, '   '//left('loads, resultants', 24)//right('F1 [F]', 16)//right('F2 [F]', 16)// &
                    right('moment about 0,0', 18))
      call add_force(page, 'on nodes', concentrated)
      call add_force(page, trim(merge('loads on faces   ', 'pressure on faces', &
                                      any(model%steps(1)%element_loads%kind == LOAD_TRACTION))), pressure)
      call add_force(page, 'in elements', body)
      call add_force(page, 'all', force_t(concentrated%f + pressure%f + body%f, &
                                          concentrated%moment + pressure%moment + body%moment))
      if (.not. allocated(model%steps(1)%heating)) return
      call add_blank(page)
      call add_entry(page, 'rise of the temperature', number(minval(model%steps(1)%heating), DIGITS)//' to '// &
                     number(maxval(model%steps(1)%heating), DIGITS)//' at the nodes, '// &
                     to_text(count(abs(model%steps(1)%heating) > 0.0_wp, kind=ip))//' not zero')
   end subroutine describe_loads

   subroutine add_force(page, name, force)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: name
      type(force_t), intent(in) :: force

      call add_line(page, '   '//left(name, 24)//right(number(force%f(1), DIGITS), 16)// &
                    right(number(force%f(2), DIGITS), 16)//right(number(force%moment, DIGITS), 18))
   end subroutine add_force

   !> Resultants of the three kinds of load.
   pure subroutine load_resultants(model, concentrated, pressure, body)
      type(model_t), intent(in) :: model
      type(force_t), intent(out) :: concentrated    !< on nodes
      type(force_t), intent(out) :: pressure        !< on element faces
      type(force_t), intent(out) :: body            !< in elements, on the polygon of the corners
      real(wp) :: f(2)
      integer(ip) :: i

      associate (loads => model%steps(1)%node_loads)
         do i = 1, loads%n
            f = 0.0_wp
            f(loads%dof(i)) = loads%value(i)
            call add_to(concentrated, f, model%mesh%x(:, loads%node(i)))
         end do
      end associate
      associate (loads => model%steps(1)%rigid_loads)
         do i = 1, loads%n
            f = 0.0_wp
            if (loads%dof(i) <= 2) f(loads%dof(i)) = loads%value(i)
            call add_to(concentrated, f, model%mesh%x(:, loads%node(i)))
            if (loads%dof(i) > 2) concentrated%moment = concentrated%moment + loads%value(i)
         end do
      end associate
      do i = 1, model%steps(1)%element_loads%n
         select case (model%steps(1)%element_loads%kind(i))
         case (LOAD_PRESSURE)
            call add_pressure(model, i, pressure)
         case (LOAD_BODY)
            call add_body_force(model, i, body)
         case default
            call add_face_load(model, i, pressure)
         end select
      end do
   end subroutine load_resultants

   pure subroutine add_to(force, f, x)
      type(force_t), intent(inout) :: force
      real(wp), intent(in) :: f(2), x(2)

      force%f = force%f + f
      force%moment = force%moment + (x(1)*f(2) - x(2)*f(1))
   end subroutine add_to

   !> A uniform pressure on a face, curved or not, has the resultant of the same pressure on its chord.
   pure subroutine add_pressure(model, i, force)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                  !< place in the element_loads
      type(force_t), intent(inout) :: force
      real(wp) :: a(2), b(2), push
      integer(ip) :: e, face

      e = model%steps(1)%element_loads%element(i)
      face = model%steps(1)%element_loads%face(i)
      a = model%mesh%x(:, model%mesh%nodes(face, e))
      b = model%mesh%x(:, model%mesh%nodes(face_end(model%mesh, e, face), e))
      push = model%steps(1)%element_loads%value(1, i)*depth_of(model, e, 0.5_wp*a(1) + 0.5_wp*b(1))
      call add_to(force, push*[a(2) - b(2), b(1) - a(1)], 0.5_wp*a + 0.5_wp*b)
   end subroutine add_pressure

   !> A load that is not uniform, or whose length counts: shape functions add up to 1, and times the nodes to the place.
   pure subroutine add_face_load(model, i, force)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                  !< place in the element_loads
      type(force_t), intent(inout) :: force
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: f(:, :)
      integer(ip) :: e, k

      e = model%steps(1)%element_loads%element(i)
      nodes = face_nodes(model%mesh, e, model%steps(1)%element_loads%face(i))
      allocate (f(2, size(nodes)))
      associate (value => model%steps(1)%element_loads%value(:, i), x => model%mesh%x(:, nodes), &
                 thickness => model%sections(model%section_of(e))%thickness)
         if (model%steps(1)%element_loads%kind(i) == LOAD_TRACTION) then
            call traction_load(x, value(:2), thickness, model%mesh%state(e), f)
         else
            call hydrostatic_load(x, value(1), value(2:3), thickness, model%mesh%state(e), f)
         end if
         do k = 1, size(nodes, kind=ip)
            call add_to(force, f(:, k), x(:, k))
         end do
      end associate
   end subroutine add_face_load

   pure subroutine add_body_force(model, i, force)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                  !< place in the element_loads
      type(force_t), intent(inout) :: force
      real(wp) :: x(2, MOST_CORNERS), middle(2), area
      integer(ip) :: e, k, n

      e = model%steps(1)%element_loads%element(i)
      n = side_count(model%mesh, e)
      x(:, :n) = model%mesh%x(:, model%mesh%nodes(:n, e))
      do k = 3, n
         associate (d => x(:, k - 1) - x(:, 1), g => x(:, k) - x(:, 1))
            area = 0.5_wp*(d(1)*g(2) - d(2)*g(1))
         end associate
         middle = (x(:, 1) + x(:, k - 1) + x(:, k))/3.0_wp
         call add_to(force, area*depth_of(model, e, middle(1))*model%steps(1)%element_loads%value(:2, i), middle)
      end do
   end subroutine add_body_force

   pure real(wp) function depth_of(model, e, x1)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: x1

      depth_of = depth_at(model%mesh%state(e), model%sections(model%section_of(e))%thickness, x1)
   end function depth_of

   subroutine describe_interactions(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip) :: i

      if (size(model%pairs, kind=ip) == 0) return
      call add_blank(page)
      do i = 1, size(model%interactions, kind=ip)
         call add_entry(page, model%interactions(i)%name//', contact', contact_text(model%interactions(i)))
         call add_entry(page, model%interactions(i)%name//', friction', friction_text(model%interactions(i)))
      end do
      associate (controls => model%steps(1)%controls)
         call add_entry(page, 'outer loop', trim(METHOD_NAME(controls%method))//', tolerance '// &
                        number(controls%tolerance, 3)//', at most '//plural(controls%max_iterations, 'iteration', 'iterations'))
      end associate
   end subroutine describe_interactions

   !> The field file that the deck asks for.
   subroutine describe_fields(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      character(len=:), allocatable :: text

      associate (fields => model%steps(1)%requests%fields)
         text = ''
         if (fields%nodes) text = text//' U'
         if (fields%reactions) text = text//' RF'
         if (fields%stress) text = text//' S'
         if (fields%contact) text = text//' contact'
      end associate
      if (len(text) == 0) return
      call add_blank(page)
      call add_entry(page, 'field file', model%deck_name//'.xdmf, with .h5:'//text)
   end subroutine describe_fields

   pure function contact_text(interaction) result(text)
      type(interaction_t), intent(in) :: interaction
      character(len=:), allocatable :: text

      text = 'exact (delta = 0)'
      if (interaction%delta > 0.0_wp) text = 'penalty, delta '//number(interaction%delta, DIGITS)//' [L^3/F]'
   end function contact_text

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
   end function friction_text

end module atrito_model_report
