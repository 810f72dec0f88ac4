!> The least displacements that differ by idle motions (atrito_idle_motions).
!>
!> From the displacements u that were found, and u' of the increment before, the sum over all nodes of (u + V s - u')^2 is made
!> least, V being the idle motions, under the conditions that no point that is open closes beyond its gap and none that slips goes
!> back.
!>
!> What the rounding of a long way leaves. Where rigid motions are 1e5 times the strains, the rows that hold are off by EPS_MACH
!> times the way, far more than their own rounding; and points that should just touch overlap by as much.
module atrito_least_motions
   use atrito_assembly, only: fem_t
   use atrito_bound_qp, only: FREE, AT_LOWER, AT_UPPER
   use atrito_contact_line, only: rest_of
   use atrito_contact_rows, only: row_value
   use atrito_contact_solution, only: contact_solution_t
   use atrito_dense, only: eigen_symmetric, least_squares
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_motion_rows, only: motion_rows_t, join_motions
   use atrito_row_entries, only: first_motions, modes_at_node
   use atrito_scene_data, only: scene_data_t
   use atrito_sparse_rows, only: multiply_rows
   implicit none (type, external)
   private
   public :: measure_motions, take_least, take_rounding_off

   integer(ip), parameter :: MOST_SWEEPS = 1000_ip
   real(wp), parameter :: LEAST_SEEN = 1.0e-20_wp         !< square of what a row sees of the motions, of the largest
   real(wp), parameter :: NO_WAY = 1.0e-12_wp       !< of the displacements: it is rounding that is not least
   real(wp), parameter :: BACK = 1.0e-13_wp         !< what rounding leaves of a way and the way back
   real(wp), parameter :: SETTLED = 1.0e-14_wp

   real(wp), parameter :: MOST_ENTRIES = 1.0e6_wp   !< of the rows that are closed again
   real(wp), parameter :: LEAST_ROUNDING = 20*EPS_MACH, ROUNDING = 1.0e-12_wp !< of a way that bodies went
   integer(ip), parameter :: MOST_CLOSINGS = 5_ip   !< of points that it has made overlap

contains

   !> Of the displacements since the increment before, the sums over the nodes of each body with its motions: Z'(u + Z a - u') and
   !> Z'Z. Of a rigid surface these are the four places at its size from its reference node along the axes, counted as three, as
   !> the nodes that carry its motion are: so the sum is the same however the axes lie.
   pure subroutine measure_motions(fem, u, before, a, off, metric)
      type(fem_t), intent(in) :: fem                        !< bodies with their motions
      real(wp), intent(in) :: u(:, :)                       !< (2, n_nodes) without rigid motions [L]
      real(wp), pointer, intent(in) :: before(:, :)         !< (2, n_nodes) of the increment before [L]; null: zeros
      real(wp), intent(in) :: a(:)                          !< (k)
      real(wp), allocatable, intent(out) :: off(:)          !< (k) [L]
      real(wp), allocatable, intent(out) :: metric(:, :, :) !< (3, 3, bodies)
      real(wp) :: z(2, 3), moved(2), middle(2, 3), moved_middle(2)
      integer(ip) :: first(fem%bodies%n + 1), b, i

      allocate (off(size(a)), metric(3, 3, fem%bodies%n), source=0.0_wp)
      first = first_motions(fem%bodies)
      do b = 1, fem%bodies%n
         associate (nodes => fem%bodies%list(b)%nodes, n => first(b + 1) - first(b), own_a => a(first(b):first(b + 1) - 1), &
                    own_off => off(first(b):first(b + 1) - 1))
            do i = 1, merge(size(nodes, kind=ip), 0_ip, n > 0)
               z = modes_at_node(fem, b, nodes(i))
               moved = u(:, nodes(i)) + matmul(z(:, :n), own_a)
               if (associated(before)) then
                  if (nodes(i) <= size(before, 2)) moved = moved - before(:, nodes(i))
               end if
               if (fem%bodies%list(b)%is_rigid .and. i == 1) then ! the reference node
                  middle = z
                  moved_middle = moved
                  cycle
               end if
               if (fem%bodies%list(b)%is_rigid) then
                  call add_place(0.75_wp, moved, z(:, :n), own_off, metric(:n, :n, b))
                  call add_place(0.75_wp, 2*moved_middle - moved, 2*middle(:, :n) - z(:, :n), own_off, metric(:n, :n, b))
               else
                  call add_place(1.0_wp, moved, z(:, :n), own_off, metric(:n, :n, b))
               end if
            end do
         end associate
      end do

   contains

      pure subroutine add_place(weight, moved, z, off, metric)
         real(wp), intent(in) :: weight, moved(:), z(:, :) !< of the place, (2), (2, n)
         real(wp), intent(inout) :: off(:), metric(:, :) !< (n), (n, n)

         off = off + weight*matmul(moved, z)
         metric = metric + weight*matmul(transpose(z), z)
      end subroutine add_place

   end subroutine measure_motions

   !> Least squares over the idle motions, V' M V s = -V' off, and the same within the conditions of the rows that do not hold.
   !>
   !> The sum over the nodes of the squares of their displacements since the increment before, with the motions V s added, is
   !>
   !>     |u + Z a + Z V s - u'|^2 = s'V'M V s + 2 s'V'off + what does not depend on s,     M = Z'Z,   off = Z'(u + Z a - u')
   !>
   !> M has a block of order 3 a body (measure_motions). With V'M V = Q diag(l) Q' the columns of W = V Q diag(l)^-1/2 are as many
   !> motions with W'M W = 1, and of s over these the sum is |s + W'off|^2 but for a constant: the least is at s = -W'off, and the
   !> least under conditions is the point nearest to that one (within_conditions), in the plain sense of the distance.
   subroutine take_least(fem, rows, idle, off, metric, largest, may_hold, solution, way)
      type(fem_t), intent(in) :: fem                      !< bodies with their motions
      type(motion_rows_t), intent(in) :: rows             !< G
      real(wp), intent(in) :: idle(:, :)                  !< (k, motions)
      real(wp), intent(in) :: off(:)                      !< (k) [L]
      real(wp), intent(in) :: metric(:, :, :)             !< (3, 3, bodies) of measure_motions
      real(wp), intent(in) :: largest                     !< displacement [L]
      logical, intent(in) :: may_hold                     !< a thin wedge may, by friction: other methods are to find how
      type(contact_solution_t), intent(inout) :: solution !< its motions change, and `r` of rows at a bound
      real(wp), intent(out) :: way(:)                     !< (k) that the bodies went [L]; 0 where they did not
      real(wp) :: basis(size(idle, 1), size(idle, 2)), gram(size(idle, 2), size(idle, 2)), values(size(idle, 2))
      real(wp) :: rate(rows%n), product(size(idle, 1), size(idle, 2))
      integer(ip) :: j, info, first(fem%bodies%n + 1), b

      way = 0.0_wp
      first = first_motions(fem%bodies)
      do b = 1, fem%bodies%n
         associate (n => first(b + 1) - first(b), at => first(b))
            product(at:at + n - 1, :) = matmul(metric(:n, :n, b), idle(at:at + n - 1, :))
         end associate
      end do
      gram = matmul(transpose(idle), product)
      call eigen_symmetric(gram, values, info)
      if (info /= 0) return
      basis = matmul(idle, gram)
      do j = 1, size(values, kind=ip)
         basis(:, j) = basis(:, j)/sqrt(max(values(j), tiny(1.0_wp)))
      end do
      way = matmul(basis, within_conditions(rows, basis, -matmul(off, basis), may_hold, solution))
      if (maxval(abs(way)) <= NO_WAY*max(maxval(abs(solution%state%a)), largest)) then
         way = 0.0_wp
         return
      end if
      where (abs(way) <= NO_WAY*maxval(abs(way))) way = 0.0_wp
      ! a body that comes back to where it was is there
      way = merge(way, -solution%state%a, abs(solution%state%a + way) > BACK*abs(way))
      solution%state%a = solution%state%a + way
      call multiply_rows(rows, way, rate)
      where (solution%state%state /= FREE) solution%state%r = solution%state%r + rate
      solution%has_settled = .true.
   end subroutine take_least

   !> The point s nearest to the wanted one at which no row that is at a bound would have to leave it: r + A s <= 0 at the lower
   !> bound, >= 0 at the upper one. By Hildreth's method: projections onto one condition after the other, each with a multiplier >=
   !> 0.
   !>
   !> To minimise |s - s0|^2/2 under a_i's <= b_i is to find s = s0 - sum_i m_i a_i with m_i >= 0, which is 0 where a_i's < b_i.
   !> One condition alone is met by the step
   !>
   !>     c = max(-m_i, (a_i's - b_i)/|a_i|^2),     m_i <- m_i + c,     s <- s - c a_i
   !>
   !> which goes onto the plane a_i's = b_i from outside, and from inside back towards it as far as earlier steps had gone away from
   !> s0. Sweep after sweep that is coordinate ascent on the dual problem: its value rises with each step, and s converges, linearly
   !> in the end (C. Hildreth, Naval Research Logistics Quarterly 4 (1957) 79-85); slowly where conditions are nearly the same, as
   !> of a thin wedge: then another method ends it (meet_exactly). s = 0, the displacements as found,
   !> meets all conditions, so there always is such a point.
   function within_conditions(rows, basis, wanted, may_hold, solution) result(s)
      type(motion_rows_t), intent(in) :: rows
      real(wp), intent(in) :: basis(:, :), wanted(:)
      logical, intent(in) :: may_hold
      type(contact_solution_t), intent(in) :: solution
      real(wp) :: s(size(wanted)), a(size(wanted), rows%n), bound(rows%n), multiplier(rows%n), size_of(rows%n), step, most
      integer(ip), allocatable :: seen(:) ! rows that see a motion
      integer(ip) :: i, j, sweep

      do j = 1, size(wanted, kind=ip)
         call multiply_rows(rows, basis(:, j), a(j, :))
      end do
      bound = max(-solution%state%r, 0.0_wp)
      where (solution%state%state == AT_UPPER) bound = max(solution%state%r, 0.0_wp)
      do i = 1, rows%n
         if (solution%state%state(i) == AT_UPPER) a(:, i) = -a(:, i)
         size_of(i) = sum(a(:, i)**2)
         if (all(solution%state%state(i) /= [AT_LOWER, AT_UPPER])) size_of(i) = 0.0_wp
      end do
      seen = pack([(i, i=1, rows%n)], size_of > LEAST_SEEN*maxval(size_of))
      s = wanted
      multiplier = 0.0_wp
      do sweep = 1, MOST_SWEEPS
         most = 0.0_wp
         do j = 1, size(seen, kind=ip)
            i = seen(j)
            step = max(-multiplier(i), (dot_product(a(:, i), s) - bound(i))/size_of(i))
            multiplier(i) = multiplier(i) + step
            s = s - step*a(:, i)
            most = max(most, abs(step)*sqrt(size_of(i)))
         end do
         if (most <= SETTLED*norm2(wanted)) return
      end do
      if (.not. may_hold) call meet_exactly(a(:, seen), bound(seen), wanted, s)
   end function within_conditions

   !> The same point in finitely many steps: the way from s0 is the least x with -a_i . x >= a_i . s0 - b_i for each condition. Let
   !> E have these numbers of a condition in a column, and u >= 0 be the one for which |E u - e| is least, e being the last unit
   !> vector: then x is the upper part of r = E u - e over minus the last number of r (C. L. Lawson, R. J. Hanson, Solving Least
   !> Squares Problems, 1974, chapter 23). s stays where rounding finds no end.
   subroutine meet_exactly(a, bound, wanted, s)
      real(wp), intent(in) :: a(:, :)               !< (motions, rows)
      real(wp), intent(in) :: bound(:)              !< (rows)
      real(wp), intent(in) :: wanted(:)             !< (motions) s0
      real(wp), intent(inout) :: s(:)               !< (motions)
      real(wp), parameter :: DEPENDENT = 1.0e-13_wp, ROUND_OFF = 1.0e-13_wp
      real(wp) :: e(size(wanted) + 1, size(bound)), r(size(wanted) + 1), u(size(bound)), z(size(bound)), gain(size(bound))
      real(wp), allocatable :: own(:)
      logical :: is_free(size(bound))
      integer(ip) :: pass, i, n, rank, info

      n = size(wanted, kind=ip)
      e(:n, :) = -a/spread(norm2(a, dim=1), 1, n)
      e(n + 1, :) = (matmul(wanted, a) - bound)/norm2(a, dim=1)/norm2(wanted)
      u = 0.0_wp
      is_free = .false.
      do pass = 1, MOST_SWEEPS
         r = matmul(e, u)
         r(n + 1) = r(n + 1) - 1
         gain = merge(-huge(1.0_wp), -matmul(r, e), is_free)
         if (maxval(gain) <= ROUND_OFF .and. abs(r(n + 1)) > ROUND_OFF) then
            s = wanted - norm2(wanted)*r(:n)/r(n + 1)
            call go_onto_planes()
         end if
         if (maxval(gain) <= ROUND_OFF) return
         is_free(maxloc(gain, dim=1)) = .true.
         do                                           ! of the free ones one leaves at each turn
            own = pack(u, is_free)
            call least_squares(e(:, pack([(i, i=1, size(u, kind=ip))], is_free)), [spread(0.0_wp, 1, n), 1.0_wp], own, &
                               DEPENDENT, rank, info)
            if (info /= 0) return
            z = unpack(own, is_free, 0.0_wp)
            if (all(z > 0.0_wp .or. .not. is_free)) exit
            u = u + minval(u/(u - z), mask=is_free .and. z <= 0.0_wp)*(z - u)
            where (z <= 0.0_wp .and. u <= ROUND_OFF*maxval(u)) is_free = .false.
            where (.not. is_free) u = 0.0_wp
         end do
         u = z
      end do

   contains

      !> Conditions that are nearly the same are met by what the way to them rounds to: the least step meets them to their own
      !> digits.
      subroutine go_onto_planes()
         real(wp), allocatable :: planes(:, :)
         real(wp) :: step(n)

         planes = transpose(a(:, pack([(i, i=1, size(u, kind=ip))], u > 0.0_wp)))
         call least_squares(planes, matmul(planes, s) - pack(bound, u > 0.0_wp), step, DEPENDENT, rank, info)
         if (info == 0) s = s - step
      end subroutine go_onto_planes

   end subroutine meet_exactly

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

end module atrito_least_motions
