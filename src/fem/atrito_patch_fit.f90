!> Least-squares fit of a stress polynomial to samples in a patch.
!>
!> Complete polynomials of degree 0, 1 or 2 do not change under an affine map, so each patch has coordinates of its own, of size 1
!> whatever the units and the stretch of its elements. Places are given relative to the patch's node, so the origin does not
!> matter either. The stresses are fitted as differences from the
!> first sample: a constant field is reproduced to the last bit of the samples.
module atrito_patch_fit
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: patch_fit_t, COMPONENTS, begin_fit, clear_fit, add_sample, solve_fit, fitted_value

   integer(ip), parameter :: COMPONENTS = 3          !< s11, s22, s12
   integer(ip), parameter :: MOST_TERMS = 6
   !> A term whose part that is independent of the terms before it is below this share of its square sum is not determined. It is
   !> 0.06 and more for equal elements round a node, however stretched; the samples of one row of elements give round-off.
   real(wp), parameter :: INDEPENDENT_SHARE = 1.0e-4_wp

   !> Terms 1, xi, eta, xi^2, xi eta, eta^2 of the patch's coordinates.
   type :: patch_fit_t
      integer(ip) :: n_terms                         !< 1, 3 or 6
      integer(ip) :: n_samples
      real(wp) :: axis(2, 2)                         !< xi = axis(:, 1) . x, eta with axis(:, 2) [1/L]
      real(wp) :: moments(MOST_TERMS, MOST_TERMS)    !< lower triangle of the normal equations
      real(wp) :: right(COMPONENTS, MOST_TERMS)
      real(wp) :: reference(COMPONENTS)              !< the first sample
      real(wp) :: coefficient(COMPONENTS, MOST_TERMS)
   end type patch_fit_t

contains

   !> Lays the coordinates into a patch: xi along the line from its node to the farthest corner, eta across, each as long as the
   !> patch.
   pure subroutine begin_fit(corners, fit)
      real(wp), intent(in) :: corners(:, :)          !< corners of the elements less the patch's node (2, n) [L]
      type(patch_fit_t), intent(inout) :: fit
      real(wp) :: far(2), distance, longest, across
      integer(ip) :: i

      longest = 0.0_wp
      far = [1.0_wp, 0.0_wp]
      do i = 1, size(corners, 2, kind=ip)
         distance = max(abs(corners(1, i)), abs(corners(2, i)))
         if (distance <= longest) cycle
         longest = distance
         far = corners(:, i)
      end do
      far = far/norm2(far)
      longest = 0.0_wp
      across = 0.0_wp
      do i = 1, size(corners, 2, kind=ip)
         longest = max(longest, abs(far(1)*corners(1, i) + far(2)*corners(2, i)))
         across = max(across, abs(far(1)*corners(2, i) - far(2)*corners(1, i)))
      end do
      fit%axis(:, 1) = far/longest
      fit%axis(:, 2) = [-far(2), far(1)]/across
      call clear_fit(fit)
   end subroutine begin_fit

   !> Forgets the samples.
   pure subroutine clear_fit(fit)
      type(patch_fit_t), intent(inout) :: fit

      fit%n_samples = 0
      fit%moments = 0.0_wp
      fit%right = 0.0_wp
   end subroutine clear_fit

   !> Adds a sample for polynomials up to a degree.
   pure subroutine add_sample(x, s, degree, fit)
      real(wp), intent(in) :: x(2)                   !< less the patch's node [L]
      real(wp), intent(in) :: s(COMPONENTS)          !< [F/L^2]
      integer(ip), intent(in) :: degree              !< 1 or 2
      type(patch_fit_t), intent(inout) :: fit
      real(wp) :: p(MOST_TERMS)
      integer(ip) :: i, n

      if (fit%n_samples == 0) fit%reference = s
      fit%n_samples = fit%n_samples + 1
      n = term_count(degree)
      p = terms(x, fit)
      do i = 1, n
         fit%moments(i:n, i) = fit%moments(i:n, i) + p(i:n)*p(i)
         fit%right(:, i) = fit%right(:, i) + (s - fit%reference)*p(i)
      end do
   end subroutine add_sample

   pure integer(ip) function term_count(degree)
      integer(ip), intent(in) :: degree              !< 0, 1 or 2

      term_count = ((degree + 1)*(degree + 2))/2
   end function term_count

   pure function terms(x, fit) result(p)
      real(wp), intent(in) :: x(2)
      type(patch_fit_t), intent(in) :: fit
      real(wp) :: p(MOST_TERMS)
      real(wp) :: xi, eta

      xi = fit%axis(1, 1)*x(1) + fit%axis(2, 1)*x(2)
      eta = fit%axis(1, 2)*x(1) + fit%axis(2, 2)*x(2)
      p = [1.0_wp, xi, eta, xi*xi, xi*eta, eta*eta]
   end function terms

   !> Solves for the polynomial of a degree, not more than that of the samples, by Cholesky. determined: the samples are enough.
   pure subroutine solve_fit(degree, fit, determined)
      integer(ip), intent(in) :: degree              !< 0, 1 or 2
      type(patch_fit_t), intent(inout) :: fit
      logical, intent(out) :: determined
      real(wp) :: l(MOST_TERMS, MOST_TERMS), pivot
      integer(ip) :: i, j, n

      n = term_count(degree)
      fit%n_terms = n
      determined = .false.
      l = fit%moments
      do j = 1, n
         pivot = l(j, j)
         if (.not. pivot > INDEPENDENT_SHARE*fit%moments(j, j)) return
         l(j:n, j) = l(j:n, j)/sqrt(pivot)
         do i = j + 1, n
            l(i:n, i) = l(i:n, i) - l(i:n, j)*l(i, j)
         end do
      end do
      fit%coefficient = fit%right
      do i = 1, n
         do j = 1, i - 1
            fit%coefficient(:, i) = fit%coefficient(:, i) - l(i, j)*fit%coefficient(:, j)
         end do
         fit%coefficient(:, i) = fit%coefficient(:, i)/l(i, i)
      end do
      do i = n, 1, -1
         do j = i + 1, n
            fit%coefficient(:, i) = fit%coefficient(:, i) - l(j, i)*fit%coefficient(:, j)
         end do
         fit%coefficient(:, i) = fit%coefficient(:, i)/l(i, i)
      end do
      determined = .true.
   end subroutine solve_fit

   !> Value of the polynomial [F/L^2].
   pure function fitted_value(x, fit) result(s)
      real(wp), intent(in) :: x(2)                   !< less the patch's node [L]
      type(patch_fit_t), intent(in) :: fit
      real(wp) :: s(COMPONENTS)
      real(wp) :: p(MOST_TERMS)
      integer(ip) :: i

      p = terms(x, fit)
      s = fit%reference
      do i = 1, fit%n_terms
         s = s + fit%coefficient(:, i)*p(i)
      end do
   end function fitted_value

end module atrito_patch_fit
