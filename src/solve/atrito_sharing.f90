!> Bodies are shared out over the ranks: their parts go to them and are factored there, all at the same time.
module atrito_sharing
   use atrito_assembly, only: fem_t
   use atrito_condensed_body, only: condensed_body_t, check_held, factor_body
   use atrito_errand, only: errand_t
   use atrito_kinds, only: ip
   use atrito_part, only: part_t, make_part, release_part
   use atrito_part_service, only: ask_for_factors, give_part, receive_outcome
   use atrito_part_store, only: factor_part, find_part, hold_part
   use atrito_results, only: body_result_t
   use atrito_shared_body, only: shared_body_t, first_rank_t, piece_t, forget_pieces
   use atrito_shares, only: shares_t
   use atrito_solver_choice, only: solver_name, SOLVER_SPARSE
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text
   use atrito_timers, only: start_phase, stop_phase
   implicit none (type, external)
   private
   public :: share_bodies, condense_shared_body, forget_shared, give_up

contains

   !> Gives the parts of some bodies to their ranks and has all ranks factor them, at the same time. On return it is known what
   !> became of them all: a rank answers what it is asked in order, so nothing else may be asked before.
   subroutine share_bodies(fem, shares, wanted, first, shared, errand)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      logical, intent(in) :: wanted(:)               !< (bodies)
      type(first_rank_t), intent(inout), target :: first
      type(shared_body_t), intent(out) :: shared(:)  !< (bodies) those that are wanted
      class(errand_t), allocatable, intent(inout) :: errand  !< for the first rank while the others factor; may be none
      integer(ip) :: b

      call start_phase('order')
      do b = 1, fem%bodies%n
         if (.not. wanted(b)) cycle
         call begin_pieces(fem, shares, b, first, shared(b))
         call give_parts(fem, shares, b, shared(b))
      end do
      do b = 1, fem%bodies%n                         ! behind all parts: who factors takes none
         if (wanted(b)) call ask_for_parts(shared(b))
      end do
      do b = 1, fem%bodies%n                         ! the others have begun
         if (wanted(b)) call keep_parts(fem, shares, b, first, shared(b))
      end do
      call stop_phase('order')
      call start_phase('factor')
      do b = 1, fem%bodies%n
         if (wanted(b)) call factor_own(first, shared(b))
      end do
      call stop_phase('factor')
      if (allocated(errand)) call errand%run(fem, shares)
      call start_phase('factor')
      do b = 1, fem%bodies%n
         if (wanted(b)) call hear_parts(shared(b))
      end do
      call stop_phase('factor')
   end subroutine share_bodies

   !> The pieces of a body, with their tickets and ranks.
   subroutine begin_pieces(fem, shares, b, first, shared)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      integer(ip), intent(in) :: b
      type(first_rank_t), intent(inout), target :: first
      type(shared_body_t), intent(inout) :: shared
      integer(ip) :: i, n

      n = shares%first(b + 1) - shares%first(b)
      allocate (shared%piece(n), shared%outcome(n))
      shared%own => first
      shared%n = fem%bodies%list(b)%n
      shared%n_retained = fem%bodies%list(b)%n_retained
      shared%top = shares%tops(b)
      do i = 1, n
         shared%piece(i)%ticket = first%last_ticket + i
         shared%piece(i)%rank = shares%list(shares%first(b) + i - 1)%rank
      end do
      first%last_ticket = first%last_ticket + n
   end subroutine begin_pieces

   !> The parts of a body that other ranks have go to them.
   subroutine give_parts(fem, shares, b, shared)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      integer(ip), intent(in) :: b
      type(shared_body_t), intent(inout) :: shared
      type(part_t) :: part
      integer(ip) :: i

      do i = 1, size(shared%piece, kind=ip)
         if (shared%piece(i)%rank == 0) cycle
         call make_piece(fem, shares, shares%first(b) + i - 1, shared%piece(i), part)
         call give_part(shared%piece(i)%ticket, shared%piece(1)%ticket, part)
         call release_part(part)
      end do
   end subroutine give_parts

   subroutine ask_for_parts(shared)
      type(shared_body_t), intent(in) :: shared
      integer(ip) :: i

      do i = 1, size(shared%piece, kind=ip)
         if (shared%piece(i)%rank > 0) call ask_for_factors(shared%piece(i)%ticket, shared%piece(i)%rank)
      end do
   end subroutine ask_for_parts

   !> The first rank has its own.
   subroutine keep_parts(fem, shares, b, first, shared)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      integer(ip), intent(in) :: b
      type(first_rank_t), intent(inout) :: first
      type(shared_body_t), intent(inout) :: shared
      type(part_t) :: part
      integer(ip) :: i

      do i = 1, size(shared%piece, kind=ip)
         if (shared%piece(i)%rank > 0) cycle
         call make_piece(fem, shares, shares%first(b) + i - 1, shared%piece(i), part)
         call hold_part(first%parts, shared%piece(i)%ticket, shared%piece(1)%ticket, part)
      end do
   end subroutine keep_parts

   subroutine factor_own(first, shared)
      type(first_rank_t), intent(inout) :: first
      type(shared_body_t), intent(inout) :: shared
      integer(ip) :: i

      do i = 1, size(shared%piece, kind=ip)
         if (shared%piece(i)%rank > 0) cycle
         call factor_part(first%parts%list(find_part(first%parts, shared%piece(i)%ticket)), shared%outcome(i))
      end do
   end subroutine factor_own

   subroutine hear_parts(shared)
      type(shared_body_t), intent(inout) :: shared
      integer(ip) :: i

      do i = 1, size(shared%piece, kind=ip)
         if (shared%piece(i)%rank > 0) call receive_outcome(shared%piece(i)%rank, shared%outcome(i))
      end do
   end subroutine hear_parts

   subroutine make_piece(fem, shares, p, piece, part)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      integer(ip), intent(in) :: p                   !< place in the shares
      type(piece_t), intent(inout) :: piece
      type(part_t), intent(out) :: part

      call make_part(fem, shares, p, part)
      piece%equation = part%equation
      piece%top = part%top
      piece%n_interior = size(part%equation, kind=ip) - size(part%top, kind=ip)
   end subroutine make_piece

   !> Condenses a body by the factors of its parts. status: as condense_body.
   subroutine condense_shared_body(fem, i_body, body, result, status)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      type(condensed_body_t), intent(inout) :: body  !< its solver is a shared_body_t
      type(body_result_t), intent(inout) :: result
      type(status_t), intent(out) :: status

      call check_held(fem, i_body, status)
      if (.not. is_ok(status)) return
      result%solver_kind = SOLVER_SPARSE
      result%solver = solver_name(SOLVER_SPARSE)
      call start_phase('factor')
      call factor_body(fem, i_body, body, result, status)
      call stop_phase('factor')
      select type (solver => body%solver)
      type is (shared_body_t)
         body%is_near = solver%is_near
         if (allocated(solver%order)) result%order = solver%order
         result%reason = 'on '//rank_text(solver)
      end select
   end subroutine condense_shared_body

   !> 'rank 3', '4 ranks'
   function rank_text(solver) result(text)
      type(shared_body_t), intent(in) :: solver
      character(len=:), allocatable :: text

      if (size(solver%piece) == 1) then
         text = 'rank '//to_text(solver%piece(1)%rank)
      else
         text = to_text(size(solver%piece, kind=ip))//' ranks'
      end if
   end function rank_text

   !> The ranks give back bodies of which one has no factors.
   subroutine give_up(shared)
      type(shared_body_t), intent(inout) :: shared(:)
      integer(ip) :: b

      do b = 1, size(shared, kind=ip)
         call forget_pieces(shared(b))
      end do
   end subroutine give_up

   !> The ranks give back what they have of bodies that are not needed any more.
   subroutine forget_shared(bodies)
      type(condensed_body_t), intent(inout) :: bodies(:)
      integer(ip) :: b

      do b = 1, size(bodies, kind=ip)
         if (.not. allocated(bodies(b)%solver)) cycle
         select type (solver => bodies(b)%solver)
         type is (shared_body_t)
            call forget_pieces(solver)
         end select
      end do
   end subroutine forget_shared

end module atrito_sharing
