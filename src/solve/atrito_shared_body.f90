!> A body whose parts are on the ranks, as a solver of the first one.
!>
!> Each part eliminates its interior; what the parts leave of the unknowns that they have in common is the body's top system
!>
!>     S = sum_p A_p S_p A_p'        (border i, contact c)
!>
!> of which all ranks together eliminate the border (atrito_shared_system):  S_cc - S_ci S_ii^-1 S_ic  is the Schur complement of
!> the body. A body that is whole on one rank has no top; one in pieces has, even where these share contact dofs alone.
!>
!> A load that is reduced has the half-solved interior of the parts, then in the places of the border g_i, what the parts leave of
!> it there: all of it linear in the load, so that reduced loads can be added up.
!>
!> A solver has no status where it solves. The first solve of all ranks together that fails is noted, and told when somebody asks
!> (take_trouble): until then nothing that was found may be believed.
module atrito_shared_body
   use atrito_kinds, only: ip, lp, wp
   use atrito_linear_solver, only: linear_solver_t, factor_report_t
   use atrito_part_service, only: ask_to_expand, ask_to_forget, ask_to_reduce, fetch_schur, receive_columns
   use atrito_part_store, only: part_store_t, outcome_t, find_part, forget_part, get_part_schur
   use atrito_part_tops, only: top_store_t, ask_for_top, find_top, forget_top, make_top, TOP_EXPAND, TOP_FORGET, TOP_MAKE, &
                               TOP_REDUCE
   use atrito_profile, only: profile_t
   use atrito_shared_system, only: expand_shared, reduce_shared, schur_of_shared
   use atrito_shares, only: top_t
   use atrito_status, only: status_t, set_status, is_ok, STATUS_INTERNAL
   implicit none (type, external)
   private
   public :: shared_body_t, piece_t, first_rank_t, forget_pieces, take_trouble

   !> What the first rank has of the bodies that are shared out.
   type :: first_rank_t
      type(part_store_t) :: parts
      type(top_store_t) :: tops
      integer(ip) :: last_ticket = 0
      type(status_t) :: trouble                  !< of the first solve of all ranks together that failed
   end type first_rank_t

   !> A part as the first rank knows it.
   type :: piece_t
      integer(ip) :: ticket = 0
      integer(ip) :: rank = 0
      integer(ip) :: n_interior = 0
      integer(ip), allocatable :: equation(:)    !< (equations of the part) of the body
      integer(ip), allocatable :: top(:)         !< (retained equations of the part) place in the top
   end type piece_t

   type, extends(linear_solver_t) :: shared_body_t
      type(first_rank_t), pointer :: own => null()
      type(piece_t), allocatable :: piece(:)
      type(outcome_t), allocatable :: outcome(:) !< (pieces)
      type(top_t) :: top
      logical :: is_near = .false.
      character(len=:), allocatable :: order     !< how the order of elimination was found
      integer(lp) :: bytes = 0                   !< of the factors, on all ranks
   contains
      procedure :: create => create_nothing
      procedure :: add => add_nothing
      procedure :: factor => collect_outcomes
      procedure :: get_schur => get_body_schur
      procedure :: reduce => reduce_on_ranks
      procedure :: expand => expand_on_ranks
      procedure :: memory_bytes => bytes_of_ranks
   end type shared_body_t

contains

   !> Its matrix is made where its parts are.
   subroutine create_nothing(self, profile, status)
      class(shared_body_t), intent(inout) :: self
      type(profile_t), intent(in) :: profile
      type(status_t), intent(out) :: status

      self%n = profile%n
      self%n_retained = profile%n_retained
   end subroutine create_nothing

   subroutine add_nothing(self, equations, matrix)
      class(shared_body_t), intent(inout) :: self
      integer(ip), intent(in) :: equations(:)
      real(wp), intent(in) :: matrix(:, :)

      error stop 'atrito_shared_body: elements go to the ranks as parts'
   end subroutine add_nothing

   !> What became of the factors of all parts; then the ranks eliminate the border. status: of the first part that has none.
   subroutine collect_outcomes(self, status)
      class(shared_body_t), intent(inout) :: self
      type(status_t), intent(out) :: status
      integer(ip) :: p

      self%report = factor_report_t()
      do p = 1, size(self%piece, kind=ip)
         call add_report(self%piece(p), self%outcome(p), self%report)
         if (is_ok(status) .and. .not. is_ok(self%outcome(p)%status)) then
            call set_status(status, self%outcome(p)%status%code, self%outcome(p)%status%text)
         end if
      end do
      self%is_near = any(self%outcome%is_near)
      self%bytes = sum(self%outcome%bytes)
      self%order = self%outcome(1)%order
      if (is_ok(status) .and. size(self%piece) > 1) call factor_top(self, status)
   end subroutine collect_outcomes

   !> The worst of all parts, and their sums.
   pure subroutine add_report(piece, outcome, report)
      type(piece_t), intent(in) :: piece
      type(outcome_t), intent(in) :: outcome
      type(factor_report_t), intent(inout) :: report

      associate (own => outcome%report)
         if (own%worst_equation > 0 .and. (own%digits_lost > report%digits_lost .or. report%worst_equation == 0)) then
            report%digits_lost = own%digits_lost
            report%worst_equation = piece%equation(own%worst_equation)
            report%smallest_pivot = own%smallest_pivot
         end if
         report%largest_pivot = max(report%largest_pivot, own%largest_pivot)
         report%sign_changes = report%sign_changes + own%sign_changes
         report%n_fronts = report%n_fronts + own%n_fronts
         report%n_different = report%n_different + own%n_different
         report%entries = report%entries + own%entries
         report%most_bytes = report%most_bytes + own%most_bytes
      end associate
   end subroutine add_report

   !> The ranks eliminate the border; digits that it loses count like those of the parts.
   subroutine factor_top(self, status)
      class(shared_body_t), intent(inout) :: self
      type(status_t), intent(inout) :: status

      associate (group => self%piece(1)%ticket, sizes => [self%top%n, self%top%n_kept, self%n])
         call ask_for_top(TOP_MAKE, group, sizes)
         call make_top(self%own%parts, self%own%tops, group, sizes, status)
         if (status%code == STATUS_INTERNAL) return
         associate (own => self%own%tops%list(find_top(self%own%tops, group))%system%report)
            self%report%sign_changes = self%report%sign_changes + own%sign_changes
            if (own%worst_equation == 0 .or. own%digits_lost <= self%report%digits_lost) return
            self%report%digits_lost = own%digits_lost
            self%report%worst_equation = self%top%equation(own%worst_equation)
         end associate
      end associate
   end subroutine factor_top

   subroutine get_body_schur(self, schur)
      class(shared_body_t), intent(in) :: self
      real(wp), intent(out) :: schur(:, :)
      real(wp), allocatable :: found(:, :)

      if (size(self%piece) > 1) then
         call schur_of_shared(self%own%tops%list(find_top(self%own%tops, self%piece(1)%ticket))%system, schur)
         return
      end if
      associate (whole => self%piece(1))         ! in one piece
         if (whole%rank == 0) then
            call get_part_schur(self%own%parts%list(find_part(self%own%parts, whole%ticket)), found)
         else
            call fetch_schur(whole%ticket, whole%rank, found)
         end if
      end associate
      schur = found
   end subroutine get_body_schur

   !> The parts half-solve their interiors, then the border is condensed.
   subroutine reduce_on_ranks(self, f)
      class(shared_body_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: f(:, :)
      real(wp), allocatable :: top(:, :), columns(:, :)
      type(status_t) :: status
      integer(ip) :: p

      top = f(self%top%equation, :)
      do p = 1, size(self%piece, kind=ip)
         if (self%piece(p)%rank > 0) call ask_to_reduce(self%piece(p)%ticket, self%piece(p)%rank, load_of_piece(self%piece(p), f))
      end do
      do p = 1, size(self%piece, kind=ip)
         if (self%piece(p)%rank > 0) cycle
         columns = load_of_piece(self%piece(p), f)
         call self%own%parts%list(find_part(self%own%parts, self%piece(p)%ticket))%solver%reduce(columns)
         call take_reduced(self%piece(p), columns, f, top)
      end do
      do p = 1, size(self%piece, kind=ip)
         if (self%piece(p)%rank == 0) cycle
         call receive_columns(self%piece(p)%rank, columns)
         call take_reduced(self%piece(p), columns, f, top)
      end do
      if (size(self%piece) > 1) then
         call ask_for_top(TOP_REDUCE, self%piece(1)%ticket, [self%top%n, self%top%n_kept, self%n])
         call reduce_shared(self%own%tops%list(find_top(self%own%tops, self%piece(1)%ticket))%system, top, status)
         call note_trouble(self%own, status)
      end if
      f(self%top%equation, :) = top
   end subroutine reduce_on_ranks

   !> What acts on the interior of a part.
   pure function load_of_piece(piece, f) result(columns)
      type(piece_t), intent(in) :: piece
      real(wp), intent(in) :: f(:, :)
      real(wp) :: columns(size(piece%equation), size(f, 2))

      columns(:piece%n_interior, :) = f(piece%equation(:piece%n_interior), :)
      columns(piece%n_interior + 1:, :) = 0.0_wp
   end function load_of_piece

   !> The half-solved interior, and what the part leaves of its load on the top.
   pure subroutine take_reduced(piece, columns, f, top)
      type(piece_t), intent(in) :: piece
      real(wp), intent(in) :: columns(:, :)
      real(wp), intent(inout) :: f(:, :), top(:, :)

      f(piece%equation(:piece%n_interior), :) = columns(:piece%n_interior, :)
      top(piece%top, :) = top(piece%top, :) + columns(piece%n_interior + 1:, :)
   end subroutine take_reduced

   !> The border from the contact dofs, the interiors of the parts from both.
   subroutine expand_on_ranks(self, x)
      class(shared_body_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: x(:, :)
      real(wp), allocatable :: top(:, :), columns(:, :)
      type(status_t) :: status
      integer(ip) :: p

      if (size(self%piece) > 1) then
         top = x(self%top%equation, :)
         call ask_for_top(TOP_EXPAND, self%piece(1)%ticket, [self%top%n, self%top%n_kept, self%n])
         call expand_shared(self%own%tops%list(find_top(self%own%tops, self%piece(1)%ticket))%system, top, status)
         call note_trouble(self%own, status)
         x(self%top%equation, :) = top
      end if
      do p = 1, size(self%piece, kind=ip)
         if (self%piece(p)%rank > 0) call ask_to_expand(self%piece(p)%ticket, self%piece(p)%rank, x(self%piece(p)%equation, :))
      end do
      do p = 1, size(self%piece, kind=ip)
         if (self%piece(p)%rank > 0) cycle
         columns = x(self%piece(p)%equation, :)
         call self%own%parts%list(find_part(self%own%parts, self%piece(p)%ticket))%solver%expand(columns)
         x(self%piece(p)%equation(:self%piece(p)%n_interior), :) = columns(:self%piece(p)%n_interior, :)
      end do
      do p = 1, size(self%piece, kind=ip)
         if (self%piece(p)%rank == 0) cycle
         call receive_columns(self%piece(p)%rank, columns)
         x(self%piece(p)%equation(:self%piece(p)%n_interior), :) = columns(:self%piece(p)%n_interior, :)
      end do
   end subroutine expand_on_ranks

   !> The first failure stays until it is taken.
   pure subroutine note_trouble(first, status)
      type(first_rank_t), intent(inout) :: first
      type(status_t), intent(in) :: status

      if (is_ok(first%trouble) .and. .not. is_ok(status)) first%trouble = status
   end subroutine note_trouble

   !> What has failed since it was asked last. status: STATUS_INTERNAL then, in place of what it was; else it stays.
   pure subroutine take_trouble(first, status)
      type(first_rank_t), intent(inout) :: first
      type(status_t), intent(inout) :: status
      type(status_t) :: fine

      if (is_ok(first%trouble)) return
      status = first%trouble
      first%trouble = fine
   end subroutine take_trouble

   pure integer(lp) function bytes_of_ranks(self) result(bytes)
      class(shared_body_t), intent(in) :: self

      bytes = self%bytes
   end function bytes_of_ranks

   !> The ranks give back what they have of the body.
   subroutine forget_pieces(self)
      class(shared_body_t), intent(inout) :: self
      integer(ip) :: p

      if (.not. allocated(self%piece)) return
      if (size(self%piece) > 1) then
         call ask_for_top(TOP_FORGET, self%piece(1)%ticket, [self%top%n, self%top%n_kept, self%n])
         call forget_top(self%own%tops, self%piece(1)%ticket)
      end if
      do p = 1, size(self%piece, kind=ip)
         if (self%piece(p)%rank > 0) then
            call ask_to_forget(self%piece(p)%ticket, self%piece(p)%rank)
         else
            call forget_part(self%own%parts, self%piece(p)%ticket)
         end if
      end do
      deallocate (self%piece)
   end subroutine forget_pieces

end module atrito_shared_body
