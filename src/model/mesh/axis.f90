!> What axisymmetric elements ask of a scene: radii that are not negative, one state, no thickness; the axis stays where it is.
module atrito_axis
   use atrito_build_context, only: build_context_t, place_token, ids_text, has_errors
   use atrito_diagnostics, only: report_error, report_note
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: condition_t, add_condition
   use atrito_model, only: model_t
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_plane_state, only: STATES
   use atrito_propagation, only: is_inherited
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: hold_axis, check_axis

   !> A node this close to the axis, in parts of the largest radius, lies on it.
   real(wp), parameter :: NEAR_AXIS = 1.0e-10_wp

contains

   !> Holds u1 at the nodes on the axis: a circle of radius 0 that grew would tear the body, its hoop strain u1/x1 has no end. What
   !> the deck prescribes there itself stands.
   subroutine hold_axis(context)
      type(build_context_t), intent(inout) :: context
      type(number_list_t) :: held, moved
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i, element

      call find_axis(context, nodes, element)
      if (element == 0) return
      do i = 1, size(nodes, kind=ip)
         associate (entry => context%dof_entry(1, nodes(i)), id => context%model%mesh%node_id(nodes(i)), &
                    supports => context%open%supports)
            if (entry == 0) then
               call add_number(held, id)
               call add_condition(supports, condition_t(place=nodes(i), dof=1_ip))
               entry = supports%n
            else if (abs(supports%list(entry)%value(1)) > 0.0_wp) then
               ! what is inherited has been told
               if (.not. is_inherited(context, supports%list(entry))) call add_number(moved, id)
            end if
         end associate
      end do
      if (moved%n > 0) call report_error(context%deck, place_token(context%deck, context%elements%place(element)), 'E-AXIS', &
                                         'u1 of node '//ids_text(numbers_of(moved))// &
                                         ' on the axis x1 = 0 is prescribed, not as 0', &
                                         expected='u1 = 0 [L] on the axis, or no *BOUNDARY there', keyword='BOUNDARY')
      if (held%n > 0 .and. .not. has_errors()) then
         call report_note(context%deck, place_token(context%deck, context%elements%place(element)), 'N-AXIS', &
                          'u1 of node '//ids_text(numbers_of(held))//' on the axis x1 = 0 is held at 0', keyword='ELEMENT')
      end if
   end subroutine hold_axis

   !> The nodes of axisymmetric elements on the axis, rising, and the first of these elements.
   subroutine find_axis(context, nodes, element)
      type(build_context_t), intent(in) :: context
      integer(ip), allocatable, intent(out) :: nodes(:)
      integer(ip), intent(out) :: element              !< 0: there are none
      logical, allocatable :: on_axis(:)
      real(wp) :: nearly
      integer(ip) :: e, k, i

      allocate (nodes(0))
      associate (mesh => context%model%mesh)
         element = first_of_kind(context%model, .true.)
         if (element == 0) return
         nearly = NEAR_AXIS*maxval(mesh%x(1, :mesh%n_nodes))
         allocate (on_axis(mesh%n_nodes), source=.false.)
         do e = element, mesh%n_elements
            if (.not. STATES(mesh%state(e))%has_hoop) cycle
            do k = 1, mesh%shape(e)
               if (abs(mesh%x(1, mesh%nodes(k, e))) <= nearly) on_axis(mesh%nodes(k, e)) = .true.
            end do
         end do
         nodes = pack([(i, i=1, mesh%n_nodes)], on_axis)
      end associate
   end subroutine find_axis

   !> Reports what no axisymmetric scene can have.
   subroutine check_axis(model, context)
      type(model_t), intent(inout) :: model
      type(build_context_t), intent(in) :: context
      integer(ip) :: first

      if (first_of_kind(model, .true.) == 0) return
      associate (state => model%mesh%state)
         first = first_of_kind(model,.not. STATES(state(1))%has_hoop)
         if (first > 0) then
            call report_error(context%deck, place_token(context%deck, context%elements%place(first)), 'E-STATE', 'element '// &
                              to_text(model%mesh%element_id(first))//' is '//trim(STATES(state(first))%name)//', element '// &
                              to_text(model%mesh%element_id(1))//' is '//trim(STATES(state(1))%name)// &
                              ': a scene is a plane or the section of a body of revolution', &
                              expected='CAX elements alone, or none', keyword='ELEMENT')
            return
         end if
      end associate
      call check_radii(model, context)
      call drop_thickness(model, context)
   end subroutine check_axis

   !> The first element that is axisymmetric or not; 0: there is none.
   pure integer(ip) function first_of_kind(model, has_hoop) result(e)
      type(model_t), intent(in) :: model
      logical, intent(in) :: has_hoop
      logical, parameter :: HAS(size(STATES)) = STATES%has_hoop

      do e = 1, model%mesh%n_elements
         if (HAS(model%mesh%state(e)) .eqv. has_hoop) return
      end do
      e = 0
   end function first_of_kind

   !> No node lies beyond the axis.
   subroutine check_radii(model, context)
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      type(number_list_t) :: beyond
      real(wp) :: nearly
      integer(ip) :: i, first

      nearly = NEAR_AXIS*maxval(abs(model%mesh%x(1, :model%mesh%n_nodes)))
      first = 0
      do i = 1, model%mesh%n_nodes
         if (model%mesh%x(1, i) >= -nearly .or. context%around%first(i + 1) == context%around%first(i)) cycle
         if (first == 0) first = i
         call add_number(beyond, model%mesh%node_id(i))
      end do
      if (first == 0) return
      call report_error(context%deck, place_token(context%deck, context%nodes%place(first)), 'E-AXIS', 'node '// &
                        ids_text(numbers_of(beyond))//' of axisymmetric elements has x < 0', &
                        expected='x >= 0 [L]: x is the radius, y the axis', keyword='NODE')
   end subroutine check_radii

   !> Loads and forces are those of the full circle; a thickness, which preprocessors write, says nothing.
   subroutine drop_thickness(model, context)
      type(model_t), intent(inout) :: model
      type(build_context_t), intent(in) :: context
      character(len=:), allocatable :: amount
      integer(ip) :: i

      do i = 1, size(model%sections, kind=ip)
         if (abs(model%sections(i)%thickness - 1) <= 0.0_wp .and. .not. model%sections(i)%is_tapered) cycle
         amount = to_text(model%sections(i)%thickness)
         if (model%sections(i)%is_tapered) amount = 'of the nodes'
         call report_note(context%deck, context%sections(i), 'N-THICKNESS', 'the thickness '//amount// &
                          ' of axisymmetric elements has no effect: they reach round '// &
                          'the full circle', keyword='SOLID SECTION')
         model%sections(i)%thickness = 1.0_wp
         model%sections(i)%is_tapered = .false.
      end do
   end subroutine drop_thickness

end module atrito_axis
