!> The nonlocal average S_rho of the paper on the quadrature points of one slave surface: P = W p.
!>
!> The friction bound of the nonlocal law is nu times the mean of the pressure round a point, not the pressure at it:
!>
!>     S_rho(p)(x) = int omega_rho(|x - y|) p(y) dy,     omega_rho(r) = c exp(rho^2/(r^2 - rho^2)) for r < rho, else 0.
!>
!> omega_rho is smooth, and c makes its integral one along a straight line: c = 2.252.../rho. With the points x_k, which
!> stand for the lengths l_k of the surface, the integral becomes a sum with a sparse matrix,
!>
!>     P_j = sum_k W_jk p_k,     W_jk = omega_rho(|x_j - x_k|) l_k.
!>
!> KERNEL_LINE takes this c; near the ends of the surface the rows sum to less than one, since a part of the kernel lies
!> beyond it. KERNEL_POINTS divides each row by its sum instead, so that a uniform pressure stays uniform. |x_j - x_k|
!> is the straight distance, not the way along the surface. Where rho is at most the least distance of neighbours each
!> point has itself alone: W = 1, the local law (is_identity).
module atrito_average
   use atrito_kinds, only: ip, lp, wp
   use atrito_friction_law, only: KERNEL_LINE
   use atrito_neighbours, only: grid_t, build_grid, list_near
   use atrito_sparse_rows, only: sparse_rows_t, multiply_rows
   implicit none (type, external)
   private
   public :: average_t, identity_average, add_identity_rows, build_average, count_entries, apply_average, least_spacing

   !> 1 / integral of exp(1/(r^2-1)) over (-1,1): the constant c of the kernel, times rho.
   real(wp), parameter :: KERNEL_CONSTANT = 2.252283621043581_wp

   !> A weight below this is none: it would make a friction bound whose inverse, in eps/tau, overflows.
   real(wp), parameter :: NO_WEIGHT = 1.0e-200_wp

   !> W by rows.
   type, extends(sparse_rows_t) :: average_t
      logical :: is_identity = .true. !< every point is its own average: the local law
   end type average_t

contains

   !> W = 1: the local law.
   pure function identity_average(n) result(w)
      integer(ip), intent(in) :: n                  !< points
      type(average_t) :: w

      w%first = [1_ip]
      allocate (w%column(0), w%value(0))
      call add_identity_rows(n, w)
   end function identity_average

   !> More points, each of them its own average.
   pure subroutine add_identity_rows(n, w)
      integer(ip), intent(in) :: n                  !< points
      type(average_t), intent(inout) :: w           !< with the rows of other points in
      integer(ip) :: j, entries

      entries = w%first(w%n + 1) - 1
      w%first = [w%first, [(entries + j + 1, j=1, n)]]
      w%column = [w%column, [(w%n + j, j=1, n)]]
      w%value = [w%value, [(1.0_wp, j=1, n)]]
      w%n = w%n + n
      w%n_columns = w%n
   end subroutine add_identity_rows

   !> W_jk = omega_rho(|x_j - x_k|) l_k, with rows that sum to one (KERNEL_POINTS) or with the constant of the whole line
   !> (KERNEL_LINE). The identity when rho is at most the least spacing of the points.
   pure function build_average(x, length, rho, kernel, start) result(w)
      real(wp), intent(in) :: x(:, :)      !< (2, n) [L]
      real(wp), intent(in) :: length(:)    !< quadrature weights [L]
      real(wp), intent(in) :: rho          !< [L], >= 0
      integer(ip), intent(in) :: kernel             !< KERNEL_*
      integer(ip), intent(in), optional :: start(:)  !< the first points of the pairs on the surface; two pairs may share a node
      type(average_t) :: w
      integer(ip) :: j, k

      if (rho <= least_spacing(x, start)) then
         w = identity_average(size(length, kind=ip))
         return
      end if
      call find_entries(x, rho, w)
      do j = 1, w%n
         associate (first => w%first(j), last => w%first(j + 1) - 1)
            do k = first, last
               w%value(k) = kernel_value(norm2(x(:, w%column(k)) - x(:, j))/rho)*length(w%column(k))
            end do
            if (kernel == KERNEL_LINE) then
               w%value(first:last) = w%value(first:last)*(KERNEL_CONSTANT/rho)
            else
               w%value(first:last) = w%value(first:last)/sum(w%value(first:last))
            end if
         end associate
      end do
   end function build_average

   !> Rows and columns of W: row j has the points that are nearer to point j than rho.
   !>
   !> A point is near another as that one is near it, so instead of sorting each row the points are put, one after the
   !> other, into the rows of all their neighbours: the columns of every row rise. It is done twice, the first time to
   !> count the entries of each row.
   pure subroutine find_entries(x, rho, w)
      real(wp), intent(in) :: x(:, :), rho          !< (2, n) [L]; [L]
      type(average_t), intent(inout) :: w
      type(grid_t) :: grid
      integer(ip), allocatable :: near(:), next(:)
      integer(ip) :: pass, i, j, n

      w%n = size(x, 2, kind=ip)
      w%n_columns = w%n
      w%is_identity = .false.
      call build_grid(x, rho, grid)
      allocate (w%first(w%n + 1), near(w%n), next(w%n))
      next = 0
      ! counted and filled by the same list: of two points whose distance is rho but for round-off, vector instructions and plain
      ! ones may say different things
      do pass = 1, 2
         do j = 1, w%n
            call list_near(grid, x, j, near, n)
            do i = 1, n
               if (pass == 2) w%column(next(near(i))) = j
               next(near(i)) = next(near(i)) + 1
            end do
         end do
         if (pass == 2) exit
         w%first(1) = 1
         do j = 1, w%n
            w%first(j + 1) = w%first(j) + next(j)
         end do
         allocate (w%column(w%first(w%n + 1) - 1), w%value(w%first(w%n + 1) - 1))
         next = w%first(:w%n)
      end do
   end subroutine find_entries

   !> How many entries build_average would make. Counting ends where there are more than `most`; what is told then is an estimate,
   !> from the points counted so far: their entries times the points there are over those that were counted.
   pure integer(lp) function count_entries(x, rho, most, start) result(entries)
      real(wp), intent(in) :: x(:, :)      !< (2, n) [L]
      real(wp), intent(in) :: rho          !< [L], >= 0
      integer(lp), intent(in) :: most               !< entries
      integer(ip), intent(in), optional :: start(:)  !< as in build_average
      type(grid_t) :: grid
      integer(ip) :: near(size(x, 2)), j, n, n_near

      n = size(x, 2, kind=ip)
      entries = n
      if (rho <= least_spacing(x, start)) return
      call build_grid(x, rho, grid)
      entries = 0_lp
      do j = 1, n
         call list_near(grid, x, j, near, n_near)
         entries = entries + int(n_near, lp)
         if (entries > most) then
            entries = int(real(entries, wp)*(real(n, wp)/real(j, wp)), lp)
            return
         end if
      end do
   end function count_entries

   !> exp(rho^2/(r^2 - rho^2)) at q = r/rho, that is exp(1/((q - 1)(q + 1))), zero from q = 1 on: all its derivatives vanish there.
   pure real(wp) function kernel_value(q)
      real(wp), intent(in) :: q                     !< >= 0

      kernel_value = 0.0_wp
      if (q < 1.0_wp) kernel_value = exp(1.0_wp/((q - 1.0_wp)*(q + 1.0_wp)))
      if (kernel_value < NO_WEIGHT) kernel_value = 0.0_wp
   end function kernel_value

   !> The least distance [L] of two points that follow each other in a pair: with rho at or below it no point has a
   !> neighbour. The first point of a pair may stand at the place of the last one of the pair before, which is no
   !> spacing.
   pure real(wp) function least_spacing(x, start)
      real(wp), intent(in) :: x(:, :)               !< (2, n) [L]
      integer(ip), intent(in), optional :: start(:) !< as in build_average
      logical :: begins(size(x, 2))
      integer(ip) :: j

      begins = .false.
      if (present(start)) begins(pack(start, start <= size(x, 2))) = .true.
      least_spacing = huge(least_spacing)
      do j = 2, size(x, 2, kind=ip)
         if (.not. begins(j)) least_spacing = min(least_spacing, norm2(x(:, j) - x(:, j - 1)))
      end do
   end function least_spacing

   !> P = W p.
   pure function apply_average(w, p) result(average)
      type(average_t), intent(in) :: w              !< a row a point
      real(wp), intent(in) :: p(:)                  !< (n) pressures [F/L^2]
      real(wp) :: average(size(p))

      call multiply_rows(w, p, average)
   end function apply_average

end module atrito_average
