!> Which of many points lie near one another: a grid of square cells, of which only those that hold points are kept.
!>
!> A cell is a little longer than the reach, so a point and all its neighbours lie in its own cell and the eight round
!> it. The cells are numbered column by column, key = column 4 M + row, the points sorted by the key of their cell.
!> Three cells one above the other have keys that follow one another, so their points do, too: of each cell three ranges
!> of points are kept, one a column, found by bisection. Making the grid takes n log n, a point then as many steps as
!> nine cells have points.
module atrito_neighbours
   use atrito_kinds, only: ip, lp, wp
   use atrito_sorting, only: sorted_places, first_at_least
   implicit none (type, external)
   private
   public :: grid_t, build_grid, list_near

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

   !> A grid for points that are neighbours when they are less than `reach` apart. A cell has the width of the reach and
   !> some more, so that rounding of x/width puts no neighbour two cells away; no more than MOST cells along a direction
   !> have numbers.
   pure subroutine build_grid(x, reach, grid)
      real(wp), intent(in) :: x(:, :)                !< (2, n) [L]
      real(wp), intent(in) :: reach                  !< [L], > 0
      type(grid_t), intent(out) :: grid              !< with the points cell by cell
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
      allocate (grid%cell(n), cells(0:n))
      cells(0) = -1_lp
      n_cells = 0
      do i = 1, n
         if (key(grid%place(i)) > cells(n_cells)) then
            n_cells = n_cells + 1
            cells(n_cells) = key(grid%place(i))
         end if
         grid%cell(grid%place(i)) = n_cells
      end do
      call find_columns(key(grid%place), cells(1:n_cells), grid)
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

   !> The points near point j, itself one of them, in no particular order.
   pure subroutine list_near(grid, x, j, near, n)
      type(grid_t), intent(in) :: grid               !< of the same points
      real(wp), intent(in) :: x(:, :)                !< (2, n) those of the grid [L]
      integer(ip), intent(in) :: j                   !< number among the points of the grid
      integer(ip), intent(inout) :: near(:)          !< the first n are they; long enough
      integer(ip), intent(out) :: n                  !< neighbours, >= 1
      integer(ip) :: k, i

      n = 0
      do k = 1, 3
         do i = grid%first(k, grid%cell(j)), grid%last(k, grid%cell(j))
            associate (other => grid%place(i))
               if (hypot(x(1, other) - x(1, j), x(2, other) - x(2, j)) >= grid%reach) cycle
               n = n + 1
               near(n) = other
            end associate
         end do
      end do
   end subroutine list_near

end module atrito_neighbours
