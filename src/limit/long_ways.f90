!> What the rounding of a long way leaves. Where rigid motions are 1e5 times the strains, the rows that hold are off by EPS_MACH
!> times the way, far more than their own rounding; and points that should just touch overlap by as much.
module atrito_long_ways
   use atrito_bound_qp, only: FREE, AT_LOWER
   use atrito_contact_line, only: rest_of
   use atrito_contact_rows, only: row_value
   use atrito_contact_solution, only: contact_solution_t
   use atrito_dense, only: least_squares
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_motion_rows, only: motion_rows_t, join_motions
   use atrito_scene_data, only: scene_data_t
   use atrito_sparse_rows, only: multiply_rows
   implicit none (type, external)
   private
   public :: take_rounding_off

   real(wp), parameter :: MOST_ENTRIES = 1.0e6_wp   !< of the rows that are closed again
   real(wp), parameter :: LEAST_ROUNDING = 20*EPS_MACH, ROUNDING = 1.0e-12_wp !< of a way that bodies went
   integer(ip), parameter :: MOST_CLOSINGS = 5_ip   !< of points that it has made overlap

contains

   !> After a long way: rows that hold are closed where their bodies have moved (others are exact to their own rounding, which
   !> may be far less), then open points that the rounding of the way has made overlap, with what holds the motions that they
   !> see.
   subroutine take_rounding_off(data, rows, group, way, u, holds, solution)
      type(scene_data_t), intent(in) :: data
      type(motion_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: group(:)           !< (k)
      real(wp), intent(in) :: way(:)                !< (k) that the bodies went [L]
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) without rigid motions [L]
      logical, intent(in) :: holds(:)               !< (m)
      type(contact_solution_t), intent(inout) :: solution
      logical :: closes(rows%n), overlaps(rows%n), is_seen(rows%n_columns)
      integer(ip), allocatable :: joined(:)
      integer(ip) :: closing, i

      call close_rows(data, rows, [(holds(i) .and. has_moved(rows, group, way, i), i=1, rows%n)], u, solution)
      closes = .false.
      do closing = 1, MOST_CLOSINGS
         associate (r => solution%state%r/maxval(abs(way)))
            overlaps = solution%state%state == AT_LOWER .and. r > LEAST_ROUNDING .and. r <= ROUNDING
         end associate
         overlaps(count(data%line%normal > 0) + 1:) = .false.
         if (.not. any(overlaps .and. .not. closes)) return
         closes = closes .or. overlaps .or. holds
         call join_motions(rows, closes, joined)
         is_seen = .false.
         is_seen(joined(rows%column(pack(rows%first(:rows%n), overlaps)))) = .true.
         closes = closes .and. [(any(is_seen(joined(rows%column(rows%first(i):rows%first(i + 1) - 1)))), i=1, rows%n)]
         call close_rows(data, rows, closes, u, solution)
      end do
   end subroutine take_rounding_off

   !> Whether a row is one of a group of bodies of which some have gone a way.
   pure logical function has_moved(rows, group, way, i)
      type(motion_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: group(:), i
      real(wp), intent(in) :: way(:)
      integer(ip) :: e

      has_moved = .false.
      do e = rows%first(i), rows%first(i + 1) - 1
         has_moved = has_moved .or. any(abs(way) > 0.0_wp .and. group == group(rows%column(e)))
      end do
   end function has_moved

   !> After a long way rows are off by its rounding: the least rigid motions that put them right.
   !>
   !> A row that holds says G_i a + row_i(u) = D_i q_i (gap, rest slip and value are in row_i); what it is off by then is EPS_MACH
   !> times the way or so. The least b with G b = off, in the sense of least squares, is taken off the motions.
   subroutine close_rows(data, rows, closes, u, solution)
      type(scene_data_t), intent(in) :: data
      type(motion_rows_t), intent(in) :: rows
      logical, intent(in) :: closes(:)              !< (m)
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) without rigid motions [L]
      type(contact_solution_t), intent(inout) :: solution !< motions, and r of open rows
      real(wp), parameter :: DEPENDENT = 1.0e-8_wp
      real(wp), allocatable :: g(:, :), off(:)
      real(wp) :: back(rows%n_columns), moved(rows%n), value
      integer(ip), allocatable :: list(:)
      integer(ip) :: i, rank, info

      list = pack([(i, i=1, rows%n)], closes)
      if (size(list) == 0 .or. real(size(list), wp)*rows%n_columns > MOST_ENTRIES) return
      allocate (g(size(list), rows%n_columns), source=0.0_wp)
      allocate (off(size(list)))
      call multiply_rows(rows, solution%state%a, moved)
      do i = 1, size(list, kind=ip)
         associate (k => list(i))
            g(i, rows%column(rows%first(k):rows%first(k + 1) - 1)) = rows%value(rows%first(k):rows%first(k + 1) - 1)
            ! What the displacements make of row i beyond its gap, rest slip or value [L].
            associate (j => data%line%point(k))
               if (data%line%normal(j) == k) then
                  value = row_value(data%rows, j, data%rows%normal(:, j), u) - data%rows%gap(j)
               else
                  value = row_value(data%rows, j, data%rows%tangent(:, j), u) - rest_of(data%line, j)
               end if
            end associate
            off(i) = moved(k) - solution%bounds%d(k)*solution%state%q(k) + value
         end associate
      end do
      call least_squares(g, off, back, DEPENDENT, rank, info)
      if (info /= 0) return
      solution%state%a = solution%state%a - back
      call multiply_rows(rows, back, moved)
      where (solution%state%state /= FREE) solution%state%r = solution%state%r - moved
   end subroutine close_rows

end module atrito_long_ways
