!> The nonlocal average S_rho of the paper on the quadrature points of one contact pair: P = W p.
module atrito_average
   use atrito_kinds, only: ip, wp
   use atrito_friction_law, only: KERNEL_LINE
   implicit none (type, external)
   private
   public :: average_t, identity_average, build_average, append_average, apply_average

   !> 1 / integral of exp(1/(r^2-1)) over (-1,1): the constant c of the kernel, times rho.
   real(wp), parameter :: KERNEL_CONSTANT = 2.252283621043581_wp

   !> A weight below this is none: it would make a friction bound whose inverse, in eps/tau, overflows.
   real(wp), parameter :: NO_WEIGHT = 1.0e-200_wp

   !> W by rows: entries(first(j) : first(j+1)-1) stand in the columns of the same places.
   type :: average_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: first(:), column(:)
      real(wp), allocatable :: entry(:)
      logical :: is_identity = .true.
   end type average_t

contains

   !> W = 1: the local law.
   pure function identity_average(n) result(w)
      integer(ip), intent(in) :: n
      type(average_t) :: w
      integer(ip) :: j

      w%n = n
      w%first = [(j, j=1, n + 1)]
      w%column = [(j, j=1, n)]
      allocate (w%entry(n), source=1.0_wp)
   end function identity_average

   !> W_jk = omega_rho(|x_j - x_k|) l_k, with rows that sum to one (KERNEL_POINTS) or with the constant of the whole line
   !> (KERNEL_LINE). The identity when rho is at most the least spacing of the points.
   pure function build_average(x, length, rho, kernel) result(w)
      real(wp), intent(in) :: x(:, :)      !< (2, n) [L]
      real(wp), intent(in) :: length(:)    !< quadrature weights [L]
      real(wp), intent(in) :: rho          !< [L], >= 0
      integer(ip), intent(in) :: kernel
      type(average_t) :: w
      integer(ip) :: j, k, n
      logical :: near(size(length))

      n = size(length, kind=ip)
      if (rho <= least_spacing(x)) then
         w = identity_average(n)
         return
      end if
      w%n = n
      w%is_identity = .false.
      allocate (w%first(n + 1))
      w%first(1) = 1
      do j = 1, n
         near = within(x, j, rho)
         w%first(j + 1) = w%first(j) + count(near, kind=ip)
      end do
      allocate (w%column(w%first(n + 1) - 1), w%entry(w%first(n + 1) - 1))
      do j = 1, n
         near = within(x, j, rho)
         associate (first => w%first(j), last => w%first(j + 1) - 1)
            w%column(first:last) = pack([(k, k=1, n)], near)
            do k = first, last
               w%entry(k) = kernel_value(norm2(x(:, w%column(k)) - x(:, j))/rho)*length(w%column(k))
            end do
            if (kernel == KERNEL_LINE) then
               w%entry(first:last) = w%entry(first:last)*(KERNEL_CONSTANT/rho)
            else
               w%entry(first:last) = w%entry(first:last)/sum(w%entry(first:last))
            end if
         end associate
      end do
   end function build_average

   !> Which points lie within rho of point j.
   pure function within(x, j, rho) result(near)
      real(wp), intent(in) :: x(:, :), rho
      integer(ip), intent(in) :: j
      logical :: near(size(x, 2))

      near = hypot(x(1, :) - x(1, j), x(2, :) - x(2, j)) < rho
   end function within

   !> exp(rho^2/(r^2 - rho^2)) at q = r/rho, zero from q = 1 on.
   pure real(wp) function kernel_value(q)
      real(wp), intent(in) :: q

      kernel_value = 0.0_wp
      if (q < 1.0_wp) kernel_value = exp(1.0_wp/((q - 1.0_wp)*(q + 1.0_wp)))
      if (kernel_value < NO_WEIGHT) kernel_value = 0.0_wp
   end function kernel_value

   !> The least distance [L] of two points that follow each other.
   pure real(wp) function least_spacing(x)
      real(wp), intent(in) :: x(:, :)
      integer(ip) :: j

      least_spacing = huge(least_spacing)
      do j = 2, size(x, 2, kind=ip)
         least_spacing = min(least_spacing, norm2(x(:, j) - x(:, j - 1)))
      end do
   end function least_spacing

   !> Adds the points of one more pair, which are averaged among themselves.
   pure subroutine append_average(w, more)
      type(average_t), intent(inout) :: w
      type(average_t), intent(in) :: more
      integer(ip) :: entries

      if (.not. allocated(w%first)) then
         w = more
         return
      end if
      entries = w%first(w%n + 1) - 1
      w%first = [w%first, more%first(2:) + entries]
      w%column = [w%column, more%column + w%n]
      w%entry = [w%entry, more%entry]
      w%is_identity = w%is_identity .and. more%is_identity
      w%n = w%n + more%n
   end subroutine append_average

   !> P = W p.
   pure function apply_average(w, p) result(average)
      type(average_t), intent(in) :: w
      real(wp), intent(in) :: p(:)
      real(wp) :: average(size(p))
      integer(ip) :: j

      do j = 1, w%n
         average(j) = dot_product(w%entry(w%first(j):w%first(j + 1) - 1), p(w%column(w%first(j):w%first(j + 1) - 1)))
      end do
   end function apply_average

end module atrito_average
