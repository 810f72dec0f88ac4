!> What one linear solve of a deck's own scene costs: its bodies glued together, assembled, factored once by MUMPS in the order of
!> minimum degree (AMD), solved once. Nothing else: no contact, no stresses, no tables. `--bench-limit` prints it, and a run is
!> measured by it (docs/performance.md).
!>
!> The matrix is a plain sum of element matrices. What minimum degree finds depends on how the equations are numbered, by a factor
!> of two and more, since ties decide: of the orders of atrito_tied_bodies the one with the fewest operations is taken, so that no
!> chance of the deck makes the limit easy to meet. Looking for it is not counted, nor is what comes before (reading, pairing,
!> numbering) and after (going back to the nodes).
module atrito_limit
   use atrito_assembly, only: fem_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_limit_result, only: limit_t, LIMIT_PARTS
   use atrito_model, only: model_t
   use atrito_mumps, only: mumps_t, mumps_facts_t
   use atrito_nodal_loads, only: nodal_loads
   use atrito_points, only: contact_points_t
   use atrito_profile, only: profile_t, sparse_bytes
   use atrito_scene_builder, only: build_scene
   use atrito_scene_memory, only: check_memory
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use atrito_strings, only: to_text
   use atrito_tied_bodies, only: tied_t, tie_bodies, node_order, number_tied, tied_profile, tied_load, assemble_tied, &
                                 tied_displacements, name_tied_equation, NODE_ORDERS
   use atrito_timers, only: phase_time_t, start_phase, stop_phase, get_phases
   implicit none (type, external)
   private
   public :: measure_limit

contains

   !> Measures. status: STATUS_USAGE where the bodies cannot be glued, STATUS_DECK where the memory is too small (told by a
   !> message), STATUS_SINGULAR where the glued bodies are free to move.
   subroutine measure_limit(model, limit, status)
      type(model_t), intent(in), target :: model
      type(limit_t), intent(out) :: limit
      type(status_t), intent(out) :: status
      type(fem_t) :: fem
      type(tied_t) :: tied
      type(profile_t) :: profile
      type(contact_points_t), allocatable :: points(:)
      logical, allocatable :: held(:, :)
      real(wp), allocatable :: value(:, :), f(:, :), x(:, :)

      call build_scene(model, fem, held, value, points)
      call tie_bodies(model, held, value, points, tied, status)
      if (.not. is_ok(status)) return
      call find_cheapest_order(model, fem, tied, limit%order, status)
      if (.not. is_ok(status)) return
      call tied_profile(fem, tied, profile)
      limit%n_equations = tied%n
      limit%n_glued = tied%n_glued
      limit%n_held = tied%n_held
      call nodal_loads(model, f)
      call tied_load(tied, f, x)
      call solve_once(fem, tied, profile, x, limit, status)
      if (is_ok(status)) limit%u = tied_displacements(tied, x)
   end subroutine measure_limit

   !> Numbers the equations in each of the orders, asks MUMPS for the operations of each, and leaves those of the cheapest.
   subroutine find_cheapest_order(model, fem, tied, order_text, status)
      type(model_t), intent(in) :: model
      type(fem_t), intent(in) :: fem
      type(tied_t), intent(inout) :: tied
      character(len=:), allocatable, intent(out) :: order_text
      type(status_t), intent(out) :: status
      type(profile_t) :: profile
      integer(ip), allocatable :: order(:)
      real(wp) :: operations(size(NODE_ORDERS))
      integer :: i

      do i = 1, size(NODE_ORDERS)
         call node_order(fem%mesh, i, order)
         call number_tied(fem%mesh, order, tied)
         call tied_profile(fem, tied, profile)
         call check_memory(model%deck_path, 'the matrix of '//to_text(tied%n)//' equations', sparse_bytes(profile), huge(1_lp), &
                           status)
         if (is_ok(status)) call count_operations(fem, tied, profile, operations(i), status)
         if (.not. is_ok(status)) return
      end do
      i = minloc(operations, dim=1)
      call node_order(fem%mesh, i, order)
      call number_tied(fem%mesh, order, tied)
      order_text = trim(NODE_ORDERS(i))
   end subroutine find_cheapest_order

   !> What MUMPS's analysis predicts.
   subroutine count_operations(fem, tied, profile, operations, status)
      type(fem_t), intent(in) :: fem
      type(tied_t), intent(in) :: tied
      type(profile_t), intent(in) :: profile
      real(wp), intent(out) :: operations
      type(status_t), intent(out) :: status
      class(mumps_t), allocatable :: matrix        ! of class: a build without MUMPS has a twin of it to link with
      type(mumps_facts_t) :: facts
      real(wp), allocatable :: load(:, :)

      operations = 0.0_wp
      allocate (matrix)
      call matrix%create(profile, status)
      if (.not. is_ok(status)) return
      allocate (load(tied%n, 1), source=0.0_wp)
      call assemble_tied(fem, tied, matrix, load)
      call matrix%analyse()
      facts = matrix%facts()
      operations = facts%operations
   end subroutine count_operations

   !> The four parts, each with its clock.
   subroutine solve_once(fem, tied, profile, x, limit, status)
      type(fem_t), intent(in) :: fem
      type(tied_t), intent(in) :: tied
      type(profile_t), intent(in) :: profile
      real(wp), intent(inout) :: x(:, :)            !< (n, 1): nodal forces in, displacements out
      type(limit_t), intent(inout) :: limit
      type(status_t), intent(out) :: status
      class(mumps_t), allocatable :: matrix
      type(mumps_facts_t) :: facts

      allocate (matrix)
      call start_phase(LIMIT_PARTS(1))
      call matrix%create(profile, status)
      if (.not. is_ok(status)) return
      call assemble_tied(fem, tied, matrix, x)
      call matrix%close()
      call stop_phase(LIMIT_PARTS(1))
      call start_phase(LIMIT_PARTS(2))
      call matrix%analyse()
      call stop_phase(LIMIT_PARTS(2))
      call start_phase(LIMIT_PARTS(3))
      call matrix%factor(status)
      call stop_phase(LIMIT_PARTS(3))
      if (.not. is_ok(status)) then
         if (status%code == STATUS_SINGULAR) call set_status(status, STATUS_SINGULAR, 'the bodies glued together: '//status%text &
                                                             //', '//name_tied_equation(fem, tied, matrix%report%worst_equation))
         return
      end if
      call start_phase(LIMIT_PARTS(4))
      call matrix%expand(x)
      call stop_phase(LIMIT_PARTS(4))
      facts = matrix%facts()
      limit%entries = facts%entries
      limit%factor_entries = facts%factor_entries
      limit%memory = facts%memory
      limit%operations = facts%operations
      call collect_times(limit)
   end subroutine solve_once

   subroutine collect_times(limit)
      type(limit_t), intent(inout) :: limit
      type(phase_time_t), allocatable :: phases(:)
      integer :: i, k

      phases = get_phases()
      do i = 1, size(LIMIT_PARTS)
         limit%parts(i)%name = LIMIT_PARTS(i)
         do k = 1, size(phases)
            if (phases(k)%name == LIMIT_PARTS(i)) limit%parts(i) = phases(k)
         end do
      end do
   end subroutine collect_times

end module atrito_limit
