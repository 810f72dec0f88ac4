!> Which of many points lie near one another: a grid of square cells, of which only those that hold points are kept. A point and all
!> its neighbours lie in nine cells.
module atrito_neighbours
   use atrito_kinds, only: ip, lp, wp
   use atrito_sorting, only: sorted_places, first_at_least
   implicit none (type, external)
   private
   public :: grid_t, build_grid, count_near, list_near

   type :: grid_t
      real(wp) :: reach = 0.0_wp                     !< [L] points that are nearer than this are neighbours
      integer(ip), allocatable :: place(:)           !< (n) the points, cell by cell
      integer(ip), allocatable :: cell(:)            !< (n) of each point
      integer(ip), allocatable :: first(:, :), last(:, :)  !< (3, cells): the points of three columns of cells round each
   end type grid_t

   !> A cell is longer than the reach by more than the rounding of what is divided by it.
   real(wp), parameter :: SPARE = 1.001_wp
   !> Most cells along a direction.
   integer(lp), parameter :: MOST = 2_lp**29

contains

   !> A grid for points that are neighbours when they are less than `reach` apart.
   pure subroutine build_grid(x, reach, grid)
      real(wp), intent(in) :: x(:, :)                !< (2, n) [L]
      real(wp), intent(in) :: reach                  !< [L], > 0
      type(grid_t), intent(out) :: grid
      integer(lp) :: key(size(x, 2))
      integer(lp), allocatable :: cells(:)           ! the keys of those with points, rising
      real(wp) :: low(2), extent, width
      integer(ip) :: i, n, n_cells

      grid%reach = reach
      n = size(x, 2, kind=ip)
      low = minval(x, dim=2)
      extent = maxval(maxval(x, dim=2) - low)
      width = 1.0_wp
      if (extent > 0.0_wp) width = SPARE*max(min(reach, extent), extent/real(MOST, wp))
      do i = 1, n
         key(i) = key_of(int((x(1, i) - low(1))/width, lp), int((x(2, i) - low(2))/width, lp))
      end do
      grid%place = sorted_places(key)
      allocate (grid%cell(n), cells(n))
      n_cells = 0
      do i = 1, n
         if (n_cells == 0) then
            n_cells = 1
            cells(1) = key(grid%place(i))
         else if (key(grid%place(i)) > cells(n_cells)) then
            n_cells = n_cells + 1
            cells(n_cells) = key(grid%place(i))
         end if
         grid%cell(grid%place(i)) = n_cells
      end do
      call find_columns(key(grid%place), cells(:n_cells), grid)
   end subroutine build_grid

   !> Cells that lie one above the other have keys that follow one another.
   pure integer(lp) function key_of(column, row)
      integer(lp), intent(in) :: column, row         !< 0 .. MOST

      key_of = column*(4*MOST) + row
   end function key_of

   !> Where the points of the three columns begin and end.
   pure subroutine find_columns(key, cells, grid)
      integer(lp), intent(in) :: key(:)              !< of the points in their order, rising
      integer(lp), intent(in) :: cells(:)
      type(grid_t), intent(inout) :: grid
      integer(ip) :: c, k
      integer(lp) :: middle

      allocate (grid%first(3, size(cells)), grid%last(3, size(cells)))
      do c = 1, size(cells, kind=ip)
         do k = 1, 3
            middle = cells(c) + key_of(int(k - 2, lp), 0_lp)
            grid%first(k, c) = first_at_least(key, middle - 1)
            grid%last(k, c) = first_at_least(key, middle + 2) - 1
         end do
      end do
   end subroutine find_columns

   pure logical function is_near(grid, x, i, j)
      type(grid_t), intent(in) :: grid
      real(wp), intent(in) :: x(:, :)
      integer(ip), intent(in) :: i, j

      is_near = hypot(x(1, i) - x(1, j), x(2, i) - x(2, j)) < grid%reach
   end function is_near

   !> How many points lie near point j, itself one of them.
   pure integer(ip) function count_near(grid, x, j) result(n)
      type(grid_t), intent(in) :: grid
      real(wp), intent(in) :: x(:, :)                !< (2, n) those of the grid [L]
      integer(ip), intent(in) :: j
      integer(ip) :: k, i

      n = 0
      do k = 1, 3
         do i = grid%first(k, grid%cell(j)), grid%last(k, grid%cell(j))
            if (is_near(grid, x, grid%place(i), j)) n = n + 1
         end do
      end do
   end function count_near

   !> The points near point j, in no particular order.
   pure subroutine list_near(grid, x, j, near, n)
      type(grid_t), intent(in) :: grid
      real(wp), intent(in) :: x(:, :)                !< (2, n) those of the grid [L]
      integer(ip), intent(in) :: j
      integer(ip), intent(inout) :: near(:)          !< the first n are they; long enough
      integer(ip), intent(out) :: n
      integer(ip) :: k, i

      n = 0
      do k = 1, 3
         do i = grid%first(k, grid%cell(j)), grid%last(k, grid%cell(j))
            if (.not. is_near(grid, x, grid%place(i), j)) cycle
            n = n + 1
            near(n) = grid%place(i)
         end do
      end do
   end subroutine list_near

end module atrito_neighbours
