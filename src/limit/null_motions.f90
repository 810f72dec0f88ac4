!> The motions of the bodies that no row of a list sees.
module atrito_null_motions
   use atrito_dense, only: eigen_symmetric
   use atrito_dense_blocks, only: factor_in_blocks
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, wp
   use atrito_motion_rows, only: motion_rows_t
   implicit none (type, external)
   private
   public :: find_idle, MOST_MOTIONS

   integer(ip), parameter :: MOST_MOTIONS = 300_ip  !< of a group: its null space takes their cube of operations
   real(wp), parameter :: NULL_MOTION = 1.0e-14_wp  !< square of what rows see of an idle motion, over that of the others

contains

   !> The null space of the rows that hold, group by group; of those with more than MOST_MOTIONS none is sought.
   !>
   !> v is idle when G_i v = 0 for all rows i that hold, so when v'A v = 0 with A = sum_i G_i'G_i, which is positive semidefinite:
   !> the idle motions of a group are the eigenvectors of its A whose eigenvalue is zero. A row has entries in one group alone, so a
   !> group with g motions takes g^3 operations whatever there is beside it. Eigenvalues are squares of what the rows see of a
   !> motion of length one, which is why NULL_MOTION, beside the largest, is a part of 1e-7 in lengths. By the digits of the deck
   !> each row may see a part of a motion that it would not: then v'A v is no more than the sum of their squares.
   subroutine find_idle(rows, holds, group, idle, doubt)
      type(motion_rows_t), intent(in) :: rows
      logical, intent(in) :: holds(:)               !< (m)
      integer(ip), intent(in) :: group(:)           !< (k)
      real(wp), allocatable, intent(out) :: idle(:, :) !< (k, motions), columns of length one
      real(wp), intent(in), optional :: doubt(:)    !< (m) these parts (note_digits); left out: none
      real(wp) :: seen                              ! square of what rows may see of an idle motion
      real(wp) :: found(size(group), size(group))
      real(wp), allocatable :: a(:, :), values(:)
      integer(ip), allocatable :: first(:), member(:), of_group(:), list(:)
      integer(ip) :: place(size(group)), g, i, j, n, info

      n = 0
      allocate (of_group(rows%n), source=0_ip)
      do i = 1, rows%n
         if (holds(i) .and. rows%first(i + 1) > rows%first(i)) of_group(i) = group(rows%column(rows%first(i)))
      end do
      call list_holders(rows%n_columns, reshape(of_group, [1_ip, rows%n]), first, member)
      do g = 1, rows%n_columns
         if (group(g) /= g) cycle
         list = pack([(i, i=1, rows%n_columns)], group == g)
         if (size(list) > MOST_MOTIONS) cycle
         place(list) = [(i, i=1, size(list, kind=ip))]
         allocate (a(size(list), size(list)), source=0.0_wp)
         seen = 0.0_wp
         do j = first(g), first(g + 1) - 1
            call add_row(rows, member(j), place, a)
            if (.not. present(doubt)) cycle
            associate (first => rows%first(member(j)), last => rows%first(member(j) + 1) - 1)
               seen = seen + doubt(member(j))**2*sum(rows%value(first:last)**2)
            end associate
         end do
         if (may_be_singular(a, seen)) then
            allocate (values(size(list)))
            call eigen_symmetric(a, values, info)
            do j = 1, size(list, kind=ip)
               if (info /= 0 .or. values(j) > max(NULL_MOTION*values(size(list)), seen)) exit
               n = n + 1
               found(:, n) = 0.0_wp
               found(list, n) = a(:, j)
            end do
            deallocate (values)
         end if
         deallocate (a)
      end do
      idle = found(:, :n)
   end subroutine find_idle

   !> Whether A may have an eigenvalue that is none. It has not where A - s 1 has a Cholesky factor, s being CLEARLY_HELD of the
   !> norm of A, far more than the rounding of the factor. That takes a thirtieth of the time of the eigenvectors, and few groups
   !> are idle.
   logical function may_be_singular(a, seen)
      real(wp), intent(in) :: a(:, :)
      real(wp), intent(in) :: seen                  !< what counts as none in any case
      real(wp), parameter :: CLEARLY_HELD = 1.0e-10_wp
      real(wp) :: shifted(size(a, 1), size(a, 2)), shift
      integer(ip) :: j, failed

      shifted = a
      shift = max(CLEARLY_HELD*maxval(sum(abs(a), dim=1)), 2*seen)
      do j = 1, size(a, 1, kind=ip)
         shifted(j, j) = a(j, j) - shift
      end do
      call factor_in_blocks(shifted, failed)
      may_be_singular = failed > 0
   end function may_be_singular

   !> Adds G_i' G_i of a row to the matrix of its group.
   pure subroutine add_row(rows, i, place, a)
      type(motion_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: i
      integer(ip), intent(in) :: place(:)           !< (k) of the motions in their group
      real(wp), intent(inout) :: a(:, :)
      integer(ip) :: d, e

      do d = rows%first(i), rows%first(i + 1) - 1
         do e = rows%first(i), rows%first(i + 1) - 1
            a(place(rows%column(d)), place(rows%column(e))) = a(place(rows%column(d)), place(rows%column(e))) &
                                                              + rows%value(d)*rows%value(e)
         end do
      end do
   end subroutine add_row

end module atrito_null_motions
