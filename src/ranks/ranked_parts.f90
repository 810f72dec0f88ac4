!> The parts of a scene on several ranks, one part a rank, as the first rank sees them.
!>
!> Questions go to all ranks before the first one does its own part, and answers are taken in the order of the parts: all work at
!> the same time, and sums do not depend on who is first. What is left of a part comes when something in it has changed, and stays
!> here; their sum, the top, is a full matrix on the first rank. Where that would be large, it stays where it is, and all ranks have
!> the top together (atrito_scene_top).
module atrito_ranked_parts
   use atrito_dense_top, only: dense_top_t, begin_top, add_packed_to_top, factor_top, solve_top, top_bytes, expected_top_bytes
   use atrito_kinds, only: ip, lp, wp
   use atrito_scene_part, only: scene_part_t, assemble_scene_part, reduce_part, expand_part
   use atrito_scene_parts, only: scene_parts_t, part_lists_t
   use atrito_mumps_library, only: has_mumps
   use atrito_scene_service, only: part_outcome_t, factor_scene_part, solving_of_part, give_scene_part, ask_to_assemble, &
                                   hear_assembled, ask_to_factor, hear_factored, ask_to_multiply, ask_to_reduce_scene, &
                                   ask_to_expand_scene, hear_values, ask_to_release
   use atrito_scene_top, only: begin_scene_top, factor_scene_top, solve_scene_top, end_scene_top, scene_top_bytes
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: ranked_parts_t

   !> What is left of a part, the lower triangle by columns.
   type :: left_t
      real(wp), allocatable :: values(:)
   end type left_t

   type, extends(scene_parts_t) :: ranked_parts_t
      integer(ip), allocatable :: rank(:)        !< (parts) who has each, ascending: the first rank only the first one
      type(part_lists_t), private :: lists
      type(scene_part_t), private :: own         !< that of the first rank, where it has one
      type(left_t), allocatable, private :: left(:) !< (parts)
      logical, private :: has_full_top = .true.  !< the top is a full matrix here
      integer(lp), allocatable, private :: solving(:) !< (parts) bytes that factoring each will take, where it is
      logical, private :: is_stale = .true.      !< the top is not the sum of what is left
      type(dense_top_t), private :: top
   contains
      procedure :: begin => begin_ranked
      procedure :: take => take_ranked
      procedure :: assemble => assemble_ranked
      procedure :: multiply => multiply_ranked
      procedure :: factor => factor_ranked
      procedure :: solve => solve_ranked
      procedure :: release => release_ranked
      procedure :: memory_bytes => ranked_bytes
      procedure :: solving_bytes => ranked_solving_bytes
      procedure :: solving_of_ranks
   end type ranked_parts_t

   !> Unknowns of a top that is a full matrix, at most. All ranks together are as fast from some 500 on, a quarter faster from 1,200
   !> on, with less on the first rank.
   integer(ip), parameter :: MOST_FULL = 1000_ip

contains

   subroutine begin_ranked(self, n_parts)
      class(ranked_parts_t), intent(inout) :: self
      integer(ip), intent(in) :: n_parts

      allocate (self%left(n_parts), self%solving(n_parts))
   end subroutine begin_ranked

   subroutine take_ranked(self, p, part)
      class(ranked_parts_t), intent(inout) :: self
      integer(ip), intent(in) :: p
      type(scene_part_t), intent(inout) :: part
      type(scene_part_t) :: nothing

      if (self%rank(p) == 0) then
         self%own = part
      else
         call give_scene_part(self%rank(p), part)
      end if
      part = nothing
   end subroutine take_ranked

   subroutine assemble_ranked(self, lists, is_near, order, status)
      class(ranked_parts_t), intent(inout) :: self
      type(part_lists_t), intent(in) :: lists
      logical, intent(out) :: is_near
      character(len=:), allocatable, intent(out) :: order
      type(status_t), intent(out) :: status
      type(part_outcome_t) :: outcome
      integer(ip) :: p

      self%lists = lists
      is_near = .false.
      do p = 1, lists%n_parts
         if (self%rank(p) > 0) call ask_to_assemble(self%rank(p))
      end do
      do p = 1, lists%n_parts
         if (self%rank(p) > 0) then
            call hear_assembled(self%rank(p), outcome)
         else
            call assemble_scene_part(self%own, outcome%status)
            outcome%is_near = self%own%scene%is_near
            if (allocated(self%own%scene%order)) outcome%order = self%own%scene%order
            outcome%solving = solving_of_part(self%own, outcome%status)
         end if
         if (is_ok(status)) status = outcome%status
         is_near = is_near .or. outcome%is_near
         self%solving(p) = outcome%solving
         if (p == 1) call move_alloc(outcome%order, order)
      end do
      self%has_full_top = lists%n_top <= MOST_FULL .or. .not. has_mumps()
      if (self%has_full_top .or. .not. is_ok(status)) return
      call begin_scene_top(lists%n_top, self%rank, lists%first_top, lists%top, status)
   end subroutine assemble_ranked

   subroutine multiply_ranked(self, x, y)
      class(ranked_parts_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: y(:)
      integer(ip) :: p

      associate (first => self%lists%first_unknown)
         do p = 1, self%lists%n_parts
            if (self%rank(p) > 0) call ask_to_multiply(self%rank(p), x(first(p):first(p + 1) - 1))
         end do
         do p = 1, self%lists%n_parts
            if (self%rank(p) > 0) then
               call hear_values(self%rank(p), y(first(p):first(p + 1) - 1))
            else
               call self%own%scene%multiply(x(first(p):first(p + 1) - 1), y(first(p):first(p + 1) - 1))
            end if
         end do
      end associate
   end subroutine multiply_ranked

   subroutine factor_ranked(self, stiffness, pull, failed, failed_top, status)
      class(ranked_parts_t), intent(inout) :: self
      real(wp), intent(in) :: stiffness(:), pull(:)
      integer(ip), intent(out) :: failed, failed_top
      type(status_t), intent(out) :: status
      type(part_outcome_t) :: outcome
      integer(ip) :: p

      failed = 0
      failed_top = 0
      associate (row => self%lists%first_row, motion => self%lists%first_pull)
         do p = 1, self%lists%n_parts
            if (self%rank(p) > 0) call ask_to_factor(self%rank(p), self%has_full_top, stiffness(row(p):row(p + 1) - 1), &
                                                     pull(motion(p):motion(p + 1) - 1))
         end do
         do p = 1, self%lists%n_parts
            if (self%rank(p) > 0) then
               call hear_factored(self%rank(p), self%has_full_top, outcome)
            else
               call factor_scene_part(self%own, stiffness(row(p):row(p + 1) - 1), pull(motion(p):motion(p + 1) - 1), outcome)
            end if
            call note_outcome(self, p, outcome, failed, status)
         end do
      end associate
      if (.not. (is_ok(status) .and. self%is_stale)) return
      if (self%has_full_top) then
         call factor_sum(self, failed_top, status)
      else
         call factor_over_ranks(self, failed_top, status)
      end if
      self%is_stale = .not. is_ok(status)
   end subroutine factor_ranked

   !> What became of a part; the first failure counts.
   subroutine note_outcome(self, p, outcome, failed, status)
      class(ranked_parts_t), intent(inout) :: self
      integer(ip), intent(in) :: p
      type(part_outcome_t), intent(inout) :: outcome
      integer(ip), intent(inout) :: failed
      type(status_t), intent(inout) :: status

      if (outcome%is_changed) then
         if (allocated(outcome%left)) call move_alloc(outcome%left, self%left(p)%values)
         self%is_stale = .true.
      end if
      if (is_ok(outcome%status) .or. .not. is_ok(status)) return
      status = outcome%status
      if (outcome%failed > 0) failed = self%lists%first_unknown(p) + outcome%failed - 1
   end subroutine note_outcome

   !> The sum of what is left of the parts, in their order.
   subroutine factor_sum(self, failed_top, status)
      class(ranked_parts_t), intent(inout) :: self
      integer(ip), intent(out) :: failed_top
      type(status_t), intent(out) :: status
      integer(ip) :: p

      failed_top = 0
      call begin_top(self%lists%n_top, self%top, status)
      if (.not. is_ok(status)) return
      do p = 1, self%lists%n_parts
         associate (first => self%lists%first_top(p), last => self%lists%first_top(p + 1) - 1)
            call add_packed_to_top(self%lists%top(first:last), self%left(p)%values, self%top)
         end associate
      end do
      call factor_top(self%top, status)
      failed_top = self%top%failed
   end subroutine factor_sum

   subroutine factor_over_ranks(self, failed_top, status)
      class(ranked_parts_t), intent(in) :: self
      integer(ip), intent(out) :: failed_top
      type(status_t), intent(out) :: status
      real(wp), allocatable :: nothing(:)

      if (self%rank(1) == 0) then
         call factor_scene_top(self%left(1)%values, failed_top, status)
      else
         call factor_scene_top(nothing, failed_top, status)
      end if
   end subroutine factor_over_ranks

   subroutine solve_ranked(self, x, top)
      class(ranked_parts_t), intent(in) :: self
      real(wp), intent(inout) :: x(:), top(:)
      integer(ip) :: p

      associate (first => self%lists%first_unknown)
         do p = 1, self%lists%n_parts
            if (self%rank(p) > 0) call ask_to_reduce_scene(self%rank(p), x(first(p):first(p + 1) - 1))
         end do
         do p = 1, self%lists%n_parts
            associate (last => first(p + 1) - 1, own => self%lists%top(self%lists%first_top(p):self%lists%first_top(p + 1) - 1))
               if (self%rank(p) > 0) then
                  call hear_values(self%rank(p), x(last - self%lists%n_kept(p) + 1:last))
               else
                  call reduce_part(self%own, x(first(p):last))
               end if
               top(own) = top(own) + x(last - self%lists%n_kept(p) + 1:last)
            end associate
         end do
         if (self%has_full_top) then
            call solve_top(self%top, top)
         else
            call solve_scene_top(top)
         end if
         call expand_parts(self, top, x)
      end associate
   end subroutine solve_ranked

   !> All unknowns of all parts from the shared ones.
   subroutine expand_parts(self, top, x)
      class(ranked_parts_t), intent(in) :: self
      real(wp), intent(in) :: top(:)             !< (n_top) [L]
      real(wp), intent(inout) :: x(:)            !< over the unknowns of the parts: in, reduced loads of the first rank; out [L]
      integer(ip) :: p

      associate (first => self%lists%first_unknown)
         do p = 1, self%lists%n_parts
            associate (own => self%lists%top(self%lists%first_top(p):self%lists%first_top(p + 1) - 1))
               if (self%rank(p) > 0) call ask_to_expand_scene(self%rank(p), top(own))
            end associate
         end do
         do p = 1, self%lists%n_parts
            associate (last => first(p + 1) - 1, own => self%lists%top(self%lists%first_top(p):self%lists%first_top(p + 1) - 1))
               if (self%rank(p) > 0) then
                  call hear_values(self%rank(p), x(first(p):last))
               else
                  x(last - self%lists%n_kept(p) + 1:last) = top(own)
                  call expand_part(self%own, x(first(p):last))
               end if
            end associate
         end do
      end associate
   end subroutine expand_parts

   subroutine release_ranked(self)
      class(ranked_parts_t), intent(inout) :: self
      integer(ip) :: p

      do p = 1, size(self%rank, kind=ip)
         if (self%rank(p) > 0) call ask_to_release(self%rank(p))
      end do
      if (.not. self%has_full_top) call end_scene_top()
   end subroutine release_ranked

   pure integer(lp) function ranked_bytes(self) result(bytes)
      class(ranked_parts_t), intent(in) :: self
      integer(ip) :: p

      bytes = top_bytes(self%top)
      if (.not. self%has_full_top) bytes = bytes + scene_top_bytes()
      if (any(self%rank == 0)) bytes = bytes + self%own%scene%memory_bytes()
      do p = 1, size(self%left, kind=ip)
         if (allocated(self%left(p)%values)) bytes = bytes + size(self%left(p)%values, kind=lp)*(storage_size(1.0_wp)/8)
      end do
   end function ranked_bytes

   !> The top twice: as a full matrix, and what is left of the parts.
   pure integer(lp) function ranked_solving_bytes(self) result(bytes)
      class(ranked_parts_t), intent(in) :: self

      bytes = 2*expected_top_bytes(self%lists%n_top)
      if (any(self%rank == 0)) bytes = bytes + self%own%scene%solving_bytes()
   end function ranked_solving_bytes

   !> What solving will take of each rank beyond what it holds when the parts are assembled [bytes]. A top that is a full matrix is
   !> the first rank's, with what is left of the parts. Else each rank has a share in it, and what MUMPS makes of its own part.
   pure function solving_of_ranks(self, n_ranks) result(bytes)
      class(ranked_parts_t), intent(in) :: self
      integer(ip), intent(in) :: n_ranks
      integer(lp) :: bytes(0:n_ranks - 1)
      integer(lp), parameter :: PACKED_BYTES = 4_lp, MUMPS_BYTES = 18_lp
      integer(ip) :: p

      bytes = 0
      do p = 1, self%lists%n_parts
         bytes(self%rank(p)) = self%solving(p)
         associate (packed => int(self%lists%first_top(p + 1) - self%lists%first_top(p), lp)**2)
            if (self%has_full_top) then
               bytes(0) = bytes(0) + PACKED_BYTES*packed
            else
               bytes(self%rank(p)) = bytes(self%rank(p)) + MUMPS_BYTES*packed
            end if
         end associate
      end do
      if (self%has_full_top) then
         bytes(0) = bytes(0) + expected_top_bytes(self%lists%n_top)
      else
         bytes = bytes + expected_top_bytes(self%lists%n_top)/2/n_ranks
      end if
   end function solving_of_ranks

end module atrito_ranked_parts
