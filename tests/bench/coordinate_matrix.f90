!> The lower triangle of a sparse symmetric matrix, summed up from element matrices, in coordinates.
!>
!> Until finish_matrix the entries are a list a column: column(k) is the entry that follows k in its list. The three arrays are
!> then what MUMPS reads, made in place: nothing is held twice.
module coordinate_matrix
   use atrito_kinds, only: ip, lp, wp
   use atrito_mumps, only: root_scale
   implicit none (type, external)
   private
   public :: coordinate_matrix_t, begin_matrix, add_element_matrix, finish_matrix, drop_matrix

   type :: coordinate_matrix_t
      integer(ip) :: n = 0                       !< order
      integer(ip) :: entries = 0                 !< of the lower triangle; row, column and values may be longer
      integer(ip), allocatable :: row(:), column(:)
      real(wp), allocatable :: values(:)
      integer(ip), allocatable :: newest(:)      !< (n) first entry of the list of column j, 0: none; until finish_matrix
   end type coordinate_matrix_t

contains

   !> Begins with nothing and room for as many entries as are expected; what is never touched takes no memory.
   pure subroutine begin_matrix(matrix, n, expected, no_memory)
      type(coordinate_matrix_t), intent(out) :: matrix
      integer(ip), intent(in) :: n
      integer(lp), intent(in) :: expected
      integer, intent(out) :: no_memory          !< where there is room: 0

      matrix%n = n
      call take_room(matrix, expected, no_memory)
      if (no_memory == 0) allocate (matrix%newest(n), source=0_ip, stat=no_memory)
   end subroutine begin_matrix

   !> Room for entries, those that are there kept.
   pure subroutine take_room(matrix, length, no_memory)
      type(coordinate_matrix_t), intent(inout) :: matrix
      integer(lp), intent(in) :: length
      integer, intent(out) :: no_memory          !< where there is room: 0
      integer(ip), allocatable :: row(:), column(:)
      real(wp), allocatable :: values(:)

      allocate (row(length), column(length), values(length), stat=no_memory)
      if (no_memory /= 0) return
      if (matrix%entries > 0) then
         row(:matrix%entries) = matrix%row(:matrix%entries)
         column(:matrix%entries) = matrix%column(:matrix%entries)
         values(:matrix%entries) = matrix%values(:matrix%entries)
      end if
      call move_alloc(row, matrix%row)
      call move_alloc(column, matrix%column)
      call move_alloc(values, matrix%values)
   end subroutine take_room

   !> Adds an element matrix.
   pure subroutine add_element_matrix(matrix, equations, element)
      type(coordinate_matrix_t), intent(inout) :: matrix
      integer(ip), intent(in) :: equations(:)    !< 0: prescribed, skipped
      real(wp), intent(in) :: element(:, :)      !< symmetric
      integer(lp) :: most
      integer :: no_memory

      most = matrix%entries + size(equations, kind=lp)**2
      if (most > size(matrix%row, kind=lp)) call take_room(matrix, 2*most, no_memory)
      call add_lower(equations, element, matrix%newest, matrix%entries, matrix%row, matrix%values, matrix%column)
   end subroutine add_element_matrix

   !> Adds the lower triangle of an element to the lists of its columns.
   pure subroutine add_lower(equations, matrix, newest, entries, row, values, next)
      integer(ip), intent(in) :: equations(:)
      real(wp), intent(in) :: matrix(:, :)
      integer(ip), intent(inout) :: newest(:)
      integer(ip), intent(inout) :: entries
      integer(ip), intent(inout), contiguous :: row(:), next(:)
      real(wp), intent(inout), contiguous :: values(:)
      integer(ip) :: a, b, i, j, k

      do b = 1, size(equations, kind=ip)
         j = equations(b)
         if (j == 0) cycle
         do a = 1, size(equations, kind=ip)
            i = equations(a)
            if (i < j) cycle
            k = newest(j)
            do while (k /= 0)
               if (row(k) == i) exit
               k = next(k)
            end do
            if (k == 0) then
               entries = entries + 1
               k = entries
               row(k) = i
               values(k) = 0.0_wp
               next(k) = newest(j)
               newest(j) = k
            end if
            values(k) = values(k) + matrix(a, b)
         end do
      end do
   end subroutine add_lower

   !> Turns the lists into coordinates and scales rows and columns of the interior to a diagonal between 1/2 and 2 by powers of two.
   pure subroutine finish_matrix(matrix, n_interior, scale, empty)
      type(coordinate_matrix_t), intent(inout) :: matrix
      integer(ip), intent(in) :: n_interior
      real(wp), intent(out) :: scale(:)          !< (n) 1 beyond the interior
      integer(ip), intent(out) :: empty          !< the first interior equation without diagonal; 0: none

      call walk_lists(matrix%newest, n_interior, matrix%row, matrix%values, matrix%column, scale, empty)
      call scale_entries(matrix%entries, scale, matrix%row, matrix%column, matrix%values)
      deallocate (matrix%newest)
   end subroutine finish_matrix

   !> Writes the column over the place of the next entry, and finds the scale from the diagonal.
   pure subroutine walk_lists(newest, n_interior, row, values, next, factor, empty)
      integer(ip), intent(in) :: newest(:), n_interior
      integer(ip), intent(in), contiguous :: row(:)
      real(wp), intent(in), contiguous :: values(:)
      integer(ip), intent(inout), contiguous :: next(:)
      real(wp), intent(out) :: factor(:)
      integer(ip), intent(out) :: empty
      integer(ip) :: j, k, following
      real(wp) :: diagonal

      empty = 0
      do j = 1, size(newest, kind=ip)
         diagonal = 0.0_wp
         k = newest(j)
         do while (k /= 0)
            if (row(k) == j) diagonal = values(k)
            following = next(k)
            next(k) = j
            k = following
         end do
         factor(j) = 1.0_wp
         if (j > n_interior) cycle
         if (abs(diagonal) > 0.0_wp) then
            factor(j) = root_scale(diagonal)
         else if (empty == 0) then
            empty = j
         end if
      end do
   end subroutine walk_lists

   pure subroutine scale_entries(entries, scale, row, column, values)
      integer(ip), intent(in) :: entries
      real(wp), intent(in) :: scale(:)
      integer(ip), intent(in), contiguous :: row(:), column(:)
      real(wp), intent(inout), contiguous :: values(:)
      integer(ip) :: k

      do k = 1, entries
         values(k) = values(k)*scale(row(k))*scale(column(k))
      end do
   end subroutine scale_entries

   !> Lets go of the entries.
   pure subroutine drop_matrix(matrix)
      type(coordinate_matrix_t), intent(inout) :: matrix

      if (allocated(matrix%row)) deallocate (matrix%row, matrix%column, matrix%values)
      if (allocated(matrix%newest)) deallocate (matrix%newest)
      matrix%entries = 0
   end subroutine drop_matrix

end module coordinate_matrix
