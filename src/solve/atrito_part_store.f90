!> The parts of a scene that a rank has, and what it can do with them: factor, reduce a load, expand a solution.
!>
!> Every rank has such a store, the first one too. The others get what they do by parcels (atrito_part_service).
module atrito_part_store
   use atrito_assembly, only: assemble_body
   use atrito_bodies, only: order_by_dissection
   use atrito_kinds, only: ip, lp, wp
   use atrito_linear_solver, only: linear_solver_t, factor_report_t
   use atrito_part, only: part_t, release_part
   use atrito_profile, only: profile_t, begin_profile
   use atrito_solver_choice, only: new_solver, SOLVER_SPARSE
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: part_store_t, held_part_t, outcome_t, hold_part, find_part, factor_part, get_part_schur, forget_part, memory_of_part

   !> A part, and its factors.
   type :: held_part_t
      integer(ip) :: ticket = 0                  !< by which the first rank knows it
      integer(ip) :: group = 0                   !< the same for all parts of its body
      type(part_t) :: part
      class(linear_solver_t), allocatable :: solver
      real(wp), allocatable :: schur(:, :)       !< (n_retained, n_retained) of a piece; of a whole body the first rank has it
   end type held_part_t

   type :: part_store_t
      integer(ip) :: n = 0
      type(held_part_t), allocatable :: list(:)  !< (>= n)
   end type part_store_t

   !> What became of a factorisation.
   type :: outcome_t
      type(status_t) :: status                   !< of the solver
      type(factor_report_t) :: report            !< with equations of the part
      integer(lp) :: bytes = 0                   !< that its factors hold
      logical :: is_near = .false.               !< some elements have the stiffness of one that they are near to
      character(len=:), allocatable :: order     !< how the order of elimination was found
   end type outcome_t

contains

   !> Takes a part, whose mesh is the store's from now on.
   subroutine hold_part(store, ticket, group, part)
      type(part_store_t), intent(inout) :: store
      integer(ip), intent(in) :: ticket          !< that no other part has
      integer(ip), intent(in) :: group           !< that all parts of the body have
      type(part_t), intent(inout) :: part
      integer(ip) :: i

      if (.not. allocated(store%list)) allocate (store%list(4))
      if (store%n == size(store%list)) call make_longer(store)
      store%n = store%n + 1
      i = store%n
      store%list(i)%ticket = ticket
      store%list(i)%group = group
      store%list(i)%part = part
      nullify (part%fem%mesh)
   end subroutine hold_part

   subroutine make_longer(store)
      type(part_store_t), intent(inout) :: store
      type(held_part_t), allocatable :: longer(:)
      integer(ip) :: i

      allocate (longer(2*store%n))
      do i = 1, store%n
         call move_part(store%list(i), longer(i))
      end do
      call move_alloc(longer, store%list)
   end subroutine make_longer

   subroutine move_part(from, to)
      type(held_part_t), intent(inout) :: from
      type(held_part_t), intent(inout) :: to

      to%ticket = from%ticket
      to%group = from%group
      to%part = from%part
      nullify (from%part%fem%mesh)
      if (allocated(to%solver)) deallocate (to%solver)
      if (allocated(to%schur)) deallocate (to%schur)
      if (allocated(from%solver)) call move_alloc(from%solver, to%solver)
      if (allocated(from%schur)) call move_alloc(from%schur, to%schur)
   end subroutine move_part

   !> Its place in the list; 0: it is not there.
   pure integer(ip) function find_part(store, ticket) result(i)
      type(part_store_t), intent(in) :: store
      integer(ip), intent(in) :: ticket

      do i = store%n, 1, -1
         if (store%list(i)%ticket == ticket) return
      end do
   end function find_part

   !> Orders, assembles and factors the interior of a part.
   subroutine factor_part(held, outcome)
      type(held_part_t), intent(inout) :: held
      type(outcome_t), intent(out) :: outcome
      type(profile_t) :: profile

      associate (fem => held%part%fem, body => held%part%fem%bodies%list(1))
         call begin_profile(profile, body%n, body%n_retained)
         call order_by_dissection(fem%mesh, fem%bodies, 1_ip, profile%elimination)
         if (allocated(profile%elimination%text)) outcome%order = profile%elimination%text
         call new_solver(SOLVER_SPARSE, held%solver)
         call held%solver%create(profile, outcome%status)
         if (is_ok(outcome%status)) call assemble_body(fem, 1_ip, held%solver, fem%grain, outcome%is_near)
         if (is_ok(outcome%status)) call held%solver%factor(outcome%status)
         outcome%report = held%solver%report
         outcome%bytes = held%solver%memory_bytes()
         if (.not. is_ok(outcome%status) .or. held%part%is_whole) return
         allocate (held%schur(body%n_retained, body%n_retained))
         call held%solver%get_schur(held%schur)
      end associate
   end subroutine factor_part

   !> What the part leaves of its retained equations.
   subroutine get_part_schur(held, schur)
      type(held_part_t), intent(in) :: held
      real(wp), allocatable, intent(out) :: schur(:, :)

      if (allocated(held%schur)) then
         schur = held%schur
      else
         allocate (schur(held%solver%n_retained, held%solver%n_retained))
         call held%solver%get_schur(schur)
      end if
   end subroutine get_part_schur

   !> Gives a part back; one that is not there is none.
   subroutine forget_part(store, ticket)
      type(part_store_t), intent(inout) :: store
      integer(ip), intent(in) :: ticket
      integer(ip) :: i

      i = find_part(store, ticket)
      if (i == 0) return
      call release_part(store%list(i)%part)
      if (i < store%n) call move_part(store%list(store%n), store%list(i))
      associate (last => store%list(store%n))
         last%ticket = 0
         if (allocated(last%solver)) deallocate (last%solver)
         if (allocated(last%schur)) deallocate (last%schur)
      end associate
      store%n = store%n - 1
   end subroutine forget_part

   !> Factors and Schur complement [bytes].
   pure integer(lp) function memory_of_part(held) result(bytes)
      type(held_part_t), intent(in) :: held

      bytes = 0
      if (allocated(held%solver)) bytes = held%solver%memory_bytes()
      if (allocated(held%schur)) bytes = bytes + 8_lp*size(held%schur, kind=lp)
   end function memory_of_part

end module atrito_part_store
