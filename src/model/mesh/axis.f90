!> What axisymmetric elements ask of a scene: radii that are not negative, one state, no thickness; the axis stays where it is.
module atrito_axis
   use atrito_build_context, only: build_context_t, place_token, ids_text, has_errors
   use atrito_deck, only: token_t
   use atrito_diagnostics, only: report_error, report_note
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: condition_t, add_condition
   use atrito_model, only: model_t
   use atrito_growth, only: number_list_t, add_number, numbers_of
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
      type(build_context_t), intent(inout) :: context !< open%supports gets u1 = 0 at the nodes on the axis
      type(number_list_t) :: held, moved
      type(token_t) :: place
      logical, allocatable :: on_axis(:)
      real(wp) :: nearly
      integer(ip) :: first, e, k, i

      first = first_of_kind(context%model, .true.)
      if (first == 0) return
      place = place_token(context%deck, context%elements%place(first))
      associate (mesh => context%model%mesh, supports => context%open%supports)
         nearly = NEAR_AXIS*maxval(mesh%x(1, :mesh%n_nodes))
         allocate (on_axis(mesh%n_nodes), source=.false.)
         do e = first, mesh%n_elements
            if (.not. STATES(mesh%state(e))%has_hoop) cycle
            do k = 1, mesh%shape(e)
               if (abs(mesh%x(1, mesh%nodes(k, e))) <= nearly) on_axis(mesh%nodes(k, e)) = .true.
            end do
         end do
         do i = 1, mesh%n_nodes
            if (.not. on_axis(i)) cycle
            associate (entry => context%dof_entry(1, i))
               if (entry == 0) then
                  call add_number(held, mesh%node_id(i))
                  call add_condition(supports, condition_t(place=i, dof=1_ip))
                  entry = supports%n
               else if (abs(supports%list(entry)%value(1)) > 0.0_wp) then
                  ! what is inherited has been reported
                  if (.not. is_inherited(context, supports%list(entry))) call add_number(moved, mesh%node_id(i))
               end if
            end associate
         end do
      end associate
      if (moved%n > 0) call report_error(context%deck, place, 'E-AXIS', 'u1 of node '//ids_text(numbers_of(moved))// &
                                         ' on the axis x1 = 0 is prescribed, not as 0', &
                                         expected='u1 = 0 [L] on the axis, or no *BOUNDARY there', keyword='BOUNDARY')
      if (held%n > 0 .and. .not. has_errors()) call report_note(context%deck, place, 'N-AXIS', 'u1 of node '// &
                                                                ids_text(numbers_of(held))// &
                                                                ' on the axis x1 = 0 is held at 0', keyword='ELEMENT')
   end subroutine hold_axis

   !> Reports what no axisymmetric scene can have: other elements, nodes beyond the axis. Loads and forces are those of the full
   !> circle; a thickness, which preprocessors write, has no effect.
   subroutine check_axis(model, context)
      type(model_t), intent(inout) :: model        !< thickness of its sections becomes 1
      type(build_context_t), intent(in) :: context !< places in the deck, for messages
      character(len=:), allocatable :: amount
      integer(ip), allocatable :: beyond(:)
      real(wp) :: nearly
      integer(ip) :: first, i

      if (first_of_kind(model, .true.) == 0) return
      associate (mesh => model%mesh, deck => context%deck)
         first = first_of_kind(model,.not. STATES(mesh%state(1))%has_hoop)
         if (first > 0) then
            call report_error(deck, place_token(deck, context%elements%place(first)), 'E-STATE', 'element '// &
                              to_text(mesh%element_id(first))//' is '//trim(STATES(mesh%state(first))%name)//', element '// &
                              to_text(mesh%element_id(1))//' is '//trim(STATES(mesh%state(1))%name)// &
                              ': a scene is a plane or the section of a body of revolution', &
                              expected='CAX elements alone, or none', keyword='ELEMENT')
            return
         end if
         nearly = NEAR_AXIS*maxval(abs(mesh%x(1, :mesh%n_nodes)))
         beyond = pack([(i, i=1, mesh%n_nodes)], mesh%x(1, :mesh%n_nodes) < -nearly .and. &
                       context%around%first(2:mesh%n_nodes + 1) > context%around%first(:mesh%n_nodes))
         if (size(beyond) > 0) call report_error(deck, place_token(deck, context%nodes%place(beyond(1))), 'E-AXIS', 'node '// &
                                                 ids_text(mesh%node_id(beyond))//' of axisymmetric elements has x < 0', &
                                                 expected='x >= 0 [L]: x is the radius, y the axis', keyword='NODE')
      end associate
      do i = 1, size(model%sections, kind=ip)
         associate (section => model%sections(i))
            if (abs(section%thickness - 1) <= 0.0_wp .and. .not. section%is_tapered) cycle
            amount = to_text(section%thickness)
            if (section%is_tapered) amount = 'of the nodes'
            call report_note(context%deck, context%sections(i), 'N-THICKNESS', 'the thickness '//amount// &
                             ' of axisymmetric elements has no effect: they reach round the full circle', keyword='SOLID SECTION')
            section%thickness = 1.0_wp
            section%is_tapered = .false.
         end associate
      end do
   end subroutine check_axis

   !> The first element that is axisymmetric or not; 0: there is none.
   pure integer(ip) function first_of_kind(model, has_hoop) result(e)
      type(model_t), intent(in) :: model
      logical, intent(in) :: has_hoop
      logical, parameter :: HAS(size(STATES)) = STATES%has_hoop

      e = findloc(HAS(model%mesh%state(:model%mesh%n_elements)), has_hoop, dim=1, kind=ip)
   end function first_of_kind

end module atrito_axis
