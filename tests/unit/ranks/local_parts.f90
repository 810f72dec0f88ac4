!> The parts of a scene in one process, one after the other, for the tests of how a scene is cut and put together.
module local_parts
   use atrito_dense_top, only: dense_top_t, begin_top, add_packed_to_top, factor_top, solve_top, top_bytes, expected_top_bytes
   use atrito_kinds, only: ip, lp, wp
   use atrito_scene_part, only: scene_part_t, assemble_scene_part, reduce_part, expand_part
   use atrito_scene_parts, only: scene_parts_t, part_lists_t
   use atrito_scene_service, only: part_outcome_t, factor_scene_part
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: local_parts_t

   type, extends(scene_parts_t) :: local_parts_t
      type(part_lists_t), private :: lists
      type(scene_part_t), allocatable :: parts(:)
      type(part_outcome_t), allocatable, private :: outcome(:)
      type(dense_top_t), private :: top
   contains
      procedure :: begin => begin_local
      procedure :: take => take_local
      procedure :: assemble => assemble_local
      procedure :: multiply => multiply_local
      procedure :: factor => factor_local
      procedure :: solve => solve_local
      procedure :: release => release_local
      procedure :: memory_bytes => local_bytes
      procedure :: solving_bytes => local_solving_bytes
   end type local_parts_t

contains

   subroutine begin_local(self, n_parts)
      class(local_parts_t), intent(inout) :: self
      integer(ip), intent(in) :: n_parts

      if (allocated(self%parts)) deallocate (self%parts, self%outcome)
      allocate (self%parts(n_parts), self%outcome(n_parts))
   end subroutine begin_local

   subroutine take_local(self, p, part)
      class(local_parts_t), intent(inout) :: self
      integer(ip), intent(in) :: p
      type(scene_part_t), intent(inout) :: part
      type(scene_part_t) :: nothing

      self%parts(p) = part
      part = nothing
   end subroutine take_local

   subroutine assemble_local(self, lists, is_near, order, status)
      class(local_parts_t), intent(inout) :: self
      type(part_lists_t), intent(in) :: lists
      logical, intent(out) :: is_near
      character(len=:), allocatable, intent(out) :: order
      type(status_t), intent(out) :: status
      integer(ip) :: p

      self%lists = lists
      is_near = .false.
      do p = 1, lists%n_parts
         call assemble_scene_part(self%parts(p), status)
         if (.not. is_ok(status)) return
         is_near = is_near .or. self%parts(p)%scene%is_near
      end do
      order = self%parts(1)%scene%order
   end subroutine assemble_local

   subroutine multiply_local(self, x, y)
      class(local_parts_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: y(:)
      integer(ip) :: p

      do p = 1, self%lists%n_parts
         associate (first => self%lists%first_unknown(p), last => self%lists%first_unknown(p + 1) - 1)
            call self%parts(p)%scene%multiply(x(first:last), y(first:last))
         end associate
      end do
   end subroutine multiply_local

   subroutine factor_local(self, stiffness, pull, failed, failed_top, status)
      class(local_parts_t), intent(inout) :: self
      real(wp), intent(in) :: stiffness(:), pull(:)
      integer(ip), intent(out) :: failed, failed_top
      type(status_t), intent(out) :: status
      type(part_outcome_t) :: outcome
      integer(ip) :: p

      failed = 0
      failed_top = 0
      do p = 1, self%lists%n_parts
         associate (lists => self%lists)
            call factor_scene_part(self%parts(p), stiffness(lists%first_row(p):lists%first_row(p + 1) - 1), &
                                   pull(lists%first_pull(p):lists%first_pull(p + 1) - 1), outcome)
            if (outcome%failed > 0) failed = lists%first_unknown(p) + outcome%failed - 1
         end associate
         status = outcome%status
         if (.not. is_ok(status)) return
         if (outcome%is_changed) self%outcome(p) = outcome
      end do
      call begin_top(self%lists%n_top, self%top, status)
      do p = 1, self%lists%n_parts
         call add_packed_to_top(self%lists%top(self%lists%first_top(p):self%lists%first_top(p + 1) - 1), self%outcome(p)%left, &
                                self%top)
      end do
      call factor_top(self%top, status)
      failed_top = self%top%failed
   end subroutine factor_local

   subroutine solve_local(self, x, top)
      class(local_parts_t), intent(in) :: self
      real(wp), intent(inout) :: x(:), top(:)
      integer(ip) :: p

      associate (lists => self%lists)
         do p = 1, lists%n_parts
            associate (last => lists%first_unknown(p + 1) - 1, numbers => lists%top(lists%first_top(p):lists%first_top(p + 1) - 1))
               call reduce_part(self%parts(p), x(lists%first_unknown(p):last))
               top(numbers) = top(numbers) + x(last - lists%n_kept(p) + 1:last)
            end associate
         end do
         call solve_top(self%top, top)
         do p = 1, lists%n_parts
            associate (last => lists%first_unknown(p + 1) - 1, numbers => lists%top(lists%first_top(p):lists%first_top(p + 1) - 1))
               x(last - lists%n_kept(p) + 1:last) = top(numbers)
               call expand_part(self%parts(p), x(lists%first_unknown(p):last))
            end associate
         end do
      end associate
   end subroutine solve_local

   pure integer(lp) function local_bytes(self) result(bytes)
      class(local_parts_t), intent(in) :: self
      integer(ip) :: p

      bytes = top_bytes(self%top)
      do p = 1, self%lists%n_parts
         bytes = bytes + self%parts(p)%scene%memory_bytes()
      end do
   end function local_bytes

   pure integer(lp) function local_solving_bytes(self) result(bytes)
      class(local_parts_t), intent(in) :: self
      integer(ip) :: p

      bytes = expected_top_bytes(self%lists%n_top)
      do p = 1, self%lists%n_parts
         bytes = bytes + self%parts(p)%scene%solving_bytes()
      end do
   end function local_solving_bytes

   subroutine release_local(self)
      class(local_parts_t), intent(inout) :: self

      if (allocated(self%parts)) deallocate (self%parts)
   end subroutine release_local

end module local_parts
