!> The parts of a scene as whoever solves sees them, wherever they are: on several ranks (atrito_ranked_parts).
!>
!> Vectors over the parts are those of part 1, then those of part 2, and so on: a shared unknown stands in them once for each part
!> that has it. The system that holds the parts together, the top, is the sum of what is left of each part (part_matrix).
module atrito_scene_parts
   use atrito_kinds, only: ip, lp, wp
   use atrito_scene_part, only: scene_part_t
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: scene_parts_t, part_lists_t

   !> Where in the vectors the parts are: part p has first(p)..first(p + 1) - 1.
   type :: part_lists_t
      integer(ip) :: n_parts = 0
      integer(ip) :: n_top = 0                   !< shared unknowns
      integer(ip), allocatable :: first_unknown(:) !< (n_parts + 1) the last n_kept of each part are shared
      integer(ip), allocatable :: n_kept(:)      !< (n_parts)
      integer(ip), allocatable :: first_row(:), first_pull(:) !< (n_parts + 1)
      integer(ip), allocatable :: first_top(:)   !< (n_parts + 1)
      integer(ip), allocatable :: top(:)         !< numbers in the top of the unknowns that are kept, part by part
   end type part_lists_t

   type, abstract :: scene_parts_t
   contains
      procedure(begin_parts), deferred :: begin
      procedure(take_part), deferred :: take
      procedure(assemble_parts), deferred :: assemble
      procedure(multiply_parts), deferred :: multiply
      procedure(factor_parts), deferred :: factor
      procedure(solve_parts), deferred :: solve
      procedure(release_parts), deferred :: release
      procedure(parts_bytes), deferred :: memory_bytes
      procedure(parts_bytes), deferred :: solving_bytes
   end type scene_parts_t

   abstract interface

      !> Before the first part comes.
      subroutine begin_parts(self, n_parts)
         import :: scene_parts_t, ip
         class(scene_parts_t), intent(inout) :: self
         integer(ip), intent(in) :: n_parts
      end subroutine begin_parts

      !> Takes part p, not assembled, to where it belongs; nothing is left of it.
      subroutine take_part(self, p, part)
         import :: scene_parts_t, scene_part_t, ip
         class(scene_parts_t), intent(inout) :: self
         integer(ip), intent(in) :: p
         type(scene_part_t), intent(inout) :: part
      end subroutine take_part

      !> Assembles all parts. status: STATUS_INTERNAL when the memory does not suffice.
      subroutine assemble_parts(self, lists, is_near, order, status)
         import :: scene_parts_t, part_lists_t, status_t
         class(scene_parts_t), intent(inout) :: self
         type(part_lists_t), intent(in) :: lists
         logical, intent(out) :: is_near         !< a part has fronts of elements that are near, and not equal
         character(len=:), allocatable, intent(out) :: order !< of elimination: how that of the first part was found
         type(status_t), intent(out) :: status
      end subroutine assemble_parts

      !> y = A x, each part by itself.
      subroutine multiply_parts(self, x, y)
         import :: scene_parts_t, wp
         class(scene_parts_t), intent(in) :: self
         real(wp), intent(in) :: x(:)            !< over the unknowns of the parts [L]
         real(wp), intent(out) :: y(:)           !< the same [F]
      end subroutine multiply_parts

      !> Factors the parts and the top. status: STATUS_SINGULAR when a pivot is not positive, STATUS_INTERNAL when the memory does
      !> not suffice.
      subroutine factor_parts(self, stiffness, pull, failed, failed_top, status)
         import :: scene_parts_t, ip, wp, status_t
         class(scene_parts_t), intent(inout) :: self
         real(wp), intent(in) :: stiffness(:)    !< over the rows of the parts [F/L]
         real(wp), intent(in) :: pull(:)         !< over their amplitudes [F/L]
         integer(ip), intent(out) :: failed      !< place of the unknown with that pivot, over those of the parts; 0: none
         integer(ip), intent(out) :: failed_top  !< its number in the top; 0: it is not there
         type(status_t), intent(out) :: status
      end subroutine factor_parts

      !> x: in, loads on the unknowns that are not shared, and 0 for those that are; out, the solution, also for these.
      subroutine solve_parts(self, x, top)
         import :: scene_parts_t, wp
         class(scene_parts_t), intent(in) :: self
         real(wp), intent(inout) :: x(:)         !< over the unknowns of the parts [F] in, [L] out
         real(wp), intent(inout) :: top(:)       !< (n_top) loads on the shared unknowns in, their solution out
      end subroutine solve_parts

      !> Gives back what other processes hold; what is here goes with the parts.
      subroutine release_parts(self)
         import :: scene_parts_t
         class(scene_parts_t), intent(inout) :: self
      end subroutine release_parts

      !> Memory held by this process; what solving will take of it beyond what is held before the first factorisation [bytes].
      pure integer(lp) function parts_bytes(self)
         import :: scene_parts_t, lp
         class(scene_parts_t), intent(in) :: self
      end function parts_bytes

   end interface

end module atrito_scene_parts
