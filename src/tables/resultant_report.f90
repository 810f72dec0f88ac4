!> What holds and loads the bodies in an increment, set by set: the forces of supports and of rigid surfaces upon them, and loads;
!> resultants.tab, and their lines of the listing and on the screen.
module atrito_resultant_report
   use atrito_grid, only: grid_t, begin_grid, add_row, put_grid, CELL
   use atrito_kinds, only: ip, wp
   use atrito_load_resultants, only: force_t, add_to, add_value, add_element_load, is_section_node
   use atrito_mesh, only: is_revolved
   use atrito_model, only: model_t, step_t, nodal_values_t, element_load_t, SURFACE_SEGMENTS
   use atrito_page, only: page_t, add_blank, add_item, add_line, number
   use atrito_results, only: results_t
   use atrito_step_loads, only: act_at, is_end, moment_t
   use atrito_strings, only: string_t, to_text
   use atrito_summary, only: scales_t, pair_count
   use atrito_table, only: table_t, begin_step_table, add_real_columns, add_words, clear_small, one_word
   implicit none (type, external)
   private
   public :: has_resultants, build_resultants, describe_resultants, add_supports

   integer, parameter :: DIGITS = 6, SCREEN_DIGITS = 5
   real(wp), parameter :: SUMMED = 10.0_wp          !< round-offs of a reaction, which is a sum over elements
   real(wp), parameter :: SHOWN = 1.0e5_wp          !< what is less than 1e-9 of all forces is nothing to people

   character(len=*), parameter :: SUPPORT = 'BOUNDARY', RIGID_SURFACE = 'RIGID_BODY'

   !> What is of one keyword and one name of the deck.
   type :: resultant_t
      character(len=:), allocatable :: keyword      !< BOUNDARY, RIGID_BODY, CLOAD, DLOAD or DSLOAD
      character(len=:), allocatable :: name         !< of a set or a surface, or the number of a node or an element
      type(force_t) :: force                        !< upon the bodies; moment about the origin
   end type resultant_t

   !> Sums by source while they are made.
   type :: sums_t
      type(force_t), allocatable :: of(:)           !< (sources)
      logical, allocatable :: acts(:)               !< (sources) the step has something of it
   end type sums_t

contains

   !> Whether the deck has supports, loads or contact pairs.
   pure logical function has_resultants(model) result(has)
      type(model_t), intent(in) :: model !< its sources are read

      has = .false.
      if (allocated(model%sources)) has = size(model%sources) > 0
   end function has_resultants

   !> The resultants of a frame; what is rounding in them is 0.
   subroutine find_clear_resultants(model, results, length, list)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      real(wp), intent(in) :: length                !< of the mesh [L]
      type(resultant_t), allocatable, intent(out) :: list(:)
      real(wp) :: all_forces, scale, moment(1)
      integer :: i

      call find_resultants(model, results, list)
      all_forces = sum(list%force%terms)
      do i = 1, size(list)
         associate (force => list(i)%force)
            scale = force%terms
            if (holds(list(i))) scale = SUMMED*all_forces
            call clear_small(scale, force%f)
            moment = force%moment
            call clear_small(scale*length, moment)
            force%moment = moment(1)
         end associate
      end do
   end subroutine find_clear_resultants

   !> A row a support, a rigid surface or a load.
   subroutine build_resultants(model, results, scales, table)
      type(model_t), intent(in) :: model     !< its sources, loads and mesh are read
      type(results_t), intent(in) :: results !< of one increment
      type(scales_t), intent(in) :: scales   !< of the history; its length is read
      type(table_t), intent(out) :: table    !< a row a support or a load
      type(resultant_t), allocatable :: list(:)
      type(string_t), allocatable :: names(:), keywords(:)
      real(wp), allocatable :: field(:, :)
      integer :: i

      call find_clear_resultants(model, results, scales%length, list)
      allocate (names(size(list)), keywords(size(list)), field(size(list), 3))
      do i = 1, size(list)
         names(i)%s = one_word(list(i)%name)
         keywords(i)%s = list(i)%keyword
         field(i, :) = [list(i)%force%f, list(i)%force%moment]
      end do
      call begin_step_table(table, 'resultants', &
                            'a row a support or a load: its force upon the bodies, and moment about the origin', &
                            size(list, kind=ip), results%step)
      call add_words(table, 'set', '-', names, on_the_left=.true.)
      call add_words(table, 'keyword', '-', keywords, on_the_left=.true.)
      call add_real_columns(table, ['fx    ', 'fy    ', 'moment'], ['F  ', 'F  ', 'F*L'], field)
   end subroutine build_resultants

   !> For the listing: all of them.
   subroutine describe_resultants(page, model, results, scales)
      type(page_t), intent(inout) :: page            !< the lines are added to it
      type(model_t), intent(in) :: model             !< its sources, loads and mesh are read
      type(results_t), intent(in) :: results         !< of one increment
      type(scales_t), intent(in) :: scales           !< of the history; its length is read
      integer, parameter :: MOST = 40                !< lines
      type(resultant_t), allocatable :: list(:)
      type(grid_t) :: grid
      real(wp) :: moment(1)
      integer :: i

      call find_clear_resultants(model, results, scales%length, list)
      if (size(list) == 0) return
      call add_blank(page)
      call begin_grid(grid, 1, 'set by set'//CELL//'F1 [F]'//CELL//'F2 [F]'//CELL//'moment about 0,0 [F L]')
      do i = 1, min(size(list), MOST)
         associate (force => list(i)%force)
            moment = force%moment
            call clear_small(SHOWN*sum(list%force%terms), force%f)
            call clear_small(SHOWN*sum(list%force%terms)*scales%length, moment)
            call add_row(grid, '*'//list(i)%keyword//' '//list(i)%name//CELL//number(force%f(1), DIGITS)//CELL// &
                         number(force%f(2), DIGITS)//CELL//number(moment(1), DIGITS))
         end associate
      end do
      call put_grid(page, grid)
      if (size(list) > MOST) call add_line(page, '   ... and '//to_text(size(list, kind=ip) - MOST)//' more in resultants.tab')
   end subroutine describe_resultants

   !> For the screen: what holds the bodies, set by set where there is room, else in all. What is small beside the rest is 0.
   subroutine add_supports(page, model, results)
      type(page_t), intent(inout) :: page            !< one line is added to it
      type(model_t), intent(in) :: model             !< its sources, loads and mesh are read
      type(results_t), intent(in) :: results         !< of one increment
      integer, parameter :: ROOM = 66                !< columns behind the label
      type(resultant_t), allocatable :: list(:)
      character(len=:), allocatable :: text
      real(wp) :: f(2), total(2), scale
      integer :: i, n

      call find_clear_resultants(model, results, 0.0_wp, list)
      text = ''
      total = 0.0_wp
      scale = SHOWN*sum(list%force%terms)
      n = 0
      do i = 1, size(list)
         if (.not. holds(list(i))) cycle
         n = n + 1
         f = list(i)%force%f
         total = total + f
         call clear_small(scale, f)
         if (len(text) > ROOM) cycle
         if (n > 1) text = text//', '
         text = text//list(i)%name//' '//force_text(f)
      end do
      if (n == 0) return
      call clear_small(scale, total)
      text = text//' [F]'
      if (len(text) > ROOM) text = force_text(total)//' [F] in all; resultants.tab has the '//to_text(int(n, ip))//' sets'
      call add_item(page, 'held by', text)
   end subroutine add_supports

   !> `(1.5, 0)`
   pure function force_text(f) result(text)
      real(wp), intent(in) :: f(2)
      character(len=:), allocatable :: text

      text = '('//number(f(1), SCREEN_DIGITS)//', '//number(f(2), SCREEN_DIGITS)//')'
   end function force_text

   !> Supports in the order of the deck, then rigid surfaces that stay where they are, then loads. Of bodies of revolution what is
   !> radial, and moments, balance in themselves and are 0.
   pure subroutine find_resultants(model, frame, list)
      type(model_t), intent(in) :: model                     !< sources, steps and mesh are read
      type(results_t), intent(in) :: frame                   !< of one increment
      type(resultant_t), allocatable, intent(out) :: list(:) !< those that act in the increment
      type(sums_t) :: sums
      type(resultant_t), allocatable :: rigid(:)
      integer, allocatable :: supports(:), loads(:)
      integer :: i, n
      type(step_t) :: now
      type(moment_t) :: moment

      n = 0
      if (allocated(model%sources)) n = size(model%sources)
      allocate (sums%of(n), sums%acts(n))
      sums%acts = .false.
      call add_reactions(model, frame, sums)
      ! What acts at the time of the increment.
      moment = moment_t(frame%step_time, frame%time)
      if (is_end(model%steps(frame%step), moment)) then
         call add_loads_of(model, model%steps(frame%step), sums)
      else
         call act_at(model, model%steps(frame%step), moment, now)
         call add_loads_of(model, now, sums)
      end if
      call find_rigid_surfaces(model, frame, rigid)
      supports = pack([(i, i=1, n)], [(sums%acts(i) .and. model%sources(i)%keyword == SUPPORT, i=1, n)])
      loads = pack([(i, i=1, n)], [(sums%acts(i) .and. model%sources(i)%keyword /= SUPPORT, i=1, n)])
      allocate (list(size(supports) + size(rigid) + size(loads)))
      do i = 1, size(supports)
         list(i) = of_source(supports(i))
      end do
      do i = 1, size(rigid)
         list(size(supports) + i) = rigid(i)
      end do
      do i = 1, size(loads)
         list(size(supports) + size(rigid) + i) = of_source(loads(i))
      end do
      if (.not. is_revolved(model%mesh)) return
      do i = 1, size(list)
         list(i)%force%f(1) = 0.0_wp
         list(i)%force%moment = 0.0_wp
      end do

   contains

      pure type(resultant_t) function of_source(k)
         integer, intent(in) :: k

         of_source%keyword = model%sources(k)%keyword
         of_source%name = model%sources(k)%name
         of_source%force = sums%of(k)
      end function of_source

   end subroutine find_resultants

   !> Whether it holds the bodies, as supports and rigid surfaces do; loads do not.
   pure elemental logical function holds(resultant)
      type(resultant_t), intent(in) :: resultant !< of find_resultants

      holds = resultant%keyword == SUPPORT .or. resultant%keyword == RIGID_SURFACE
   end function holds

   !> The reactions, each by the line that prescribes its displacement.
   pure subroutine add_reactions(model, frame, sums)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: frame
      type(sums_t), intent(inout) :: sums
      integer(ip) :: i
      real(wp) :: value

      if (.not. allocated(frame%reaction)) return
      associate (held => model%steps(frame%step)%prescribed)
         do i = 1, merge(held%n, 0_ip, allocated(held%source))
            call add(held%source(i), held%dof(i), frame%reaction(held%dof(i), held%node(i)), model%mesh%x(:, held%node(i)), sums)
         end do
      end associate
      associate (held => model%inclined)
         do i = 1, merge(held%n, 0_ip, allocated(held%source))
            if (held%source(i) == 0) cycle
            sums%acts(held%source(i)) = .true.
            call add_to(sums%of(held%source(i)), frame%reaction(:, held%node(i)), model%mesh%x(:, held%node(i)))
         end do
      end associate
      ! Reactions at the reference nodes of rigid surfaces; a pre-tension section has none that holds a body.
      associate (held => model%steps(frame%step)%rigid_prescribed)
         do i = 1, merge(held%n, 0_ip, allocated(held%source) .and. allocated(frame%rigid))
            associate (body => findloc(model%rigid_bodies%node, held%node(i), dim=1))
               if (model%rigid_bodies(body)%is_section) cycle
               value = frame%rigid(body)%moment
               if (held%dof(i) <= 2) value = frame%rigid(body)%reaction(held%dof(i))
            end associate
            call add(held%source(i), held%dof(i), value, model%mesh%x(:, held%node(i)), sums)
         end do
      end associate
   end subroutine add_reactions

   !> A force along a dof at a place, or a moment.
   pure subroutine add(source, dof, value, x, sums)
      integer(ip), intent(in) :: source             !< 0: none
      integer(ip), intent(in) :: dof
      real(wp), intent(in) :: value, x(2)
      type(sums_t), intent(inout) :: sums

      if (source == 0) return
      sums%acts(source) = .true.
      call add_value(sums%of(source), dof, value, x)
   end subroutine add

   pure subroutine add_loads_of(model, now, sums)
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: now               !< with the loads of a moment
      type(sums_t), intent(inout) :: sums
      integer(ip) :: i

      call add_forces(model, now%node_loads, sums)
      call add_forces(model, now%rigid_loads, sums)
      if (allocated(now%element_loads%source)) then
         do i = 1, now%element_loads%n
            if (now%element_loads%source(i) == 0) cycle
            sums%acts(now%element_loads%source(i)) = .true.
            call add_element_load(model, now%element_loads, i, sums%of(now%element_loads%source(i)))
         end do
      end if
   end subroutine add_loads_of

   !> Forces at nodes, and moments at reference nodes. The force of a pre-tension section balances itself.
   pure subroutine add_forces(model, loads, sums)
      type(model_t), intent(in) :: model
      type(nodal_values_t), intent(in) :: loads
      type(sums_t), intent(inout) :: sums
      integer(ip) :: i

      if (.not. allocated(loads%source)) return
      do i = 1, loads%n
         if (is_section_node(model, loads%node(i))) cycle
         call add(loads%source(i), loads%dof(i), loads%value(i), model%mesh%x(:, loads%node(i)), sums)
      end do
   end subroutine add_forces

   !> The tractions of rigid surfaces without a reference node, whose support or load is told, over all pairs of each.
   pure subroutine find_rigid_surfaces(model, frame, rigid)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: frame
      type(resultant_t), allocatable, intent(out) :: rigid(:)
      integer(ip), allocatable :: surfaces(:)
      integer(ip) :: i, k, j

      allocate (surfaces(0))
      do i = 1, pair_count(frame)
         associate (master => model%pairs(i)%master)
            if (model%surfaces(master)%kind /= SURFACE_SEGMENTS .or. any(surfaces == master)) cycle
            if (allocated(model%rigid_bodies)) then
               if (any(model%rigid_bodies%surface == master)) cycle
            end if
            surfaces = [surfaces, master]
         end associate
      end do
      allocate (rigid(size(surfaces)))
      do k = 1, size(surfaces, kind=ip)
         rigid(k)%keyword = RIGID_SURFACE
         rigid(k)%name = model%surfaces(surfaces(k))%name
         do i = 1, pair_count(frame)
            if (model%pairs(i)%master == surfaces(k)) then
               associate (c => frame%contact(i))   ! pressure against the normal of the slave, shear along its tangent
                  do j = 1, c%n
                     call add_to(rigid(k)%force, c%weight(j)*(c%shear(j)*[-c%normal(2, j), c%normal(1, j)] &
                                                              - c%pressure(j)*c%normal(:, j)), c%x(:, j))
                  end do
               end associate
            end if
         end do
      end do
   end subroutine find_rigid_surfaces

end module atrito_resultant_report
