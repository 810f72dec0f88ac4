!> Least-squares fit of a stress polynomial to samples in a patch.
!>
!> With p(x) the terms 1, xi, eta, xi^2, xi eta, eta^2, or the first of them, and s_j the samples at x_j, p_j = p(x_j), the
!> coefficients a of a stress minimise
!>
!>     sum_j (p_j'a - (s_j - s_1))^2,     so that    M a = sum_j p_j (s_j - s_1),    M = sum_j p_j p_j'.
!>
!> M depends on the places of the samples alone. It is factored once, M = L L', for all components of the stress and for all
!> patches whose samples lie alike, which in a regular mesh are nearly all. At the patch's node p = (1, 0, ..., 0) = p_0, and the
!> value there is a weighted mean of the samples,
!>
!>     s = s_1 + sum_j w_j (s_j - s_1),     w_j = p_j' M^-1 p_0,
!>
!> whose weights are kept with the factor. Differences from the first sample reproduce a constant field to its last bit.
!>
!> The terms must be of one size, or M is near to singular: with x in metres and elements of a millimetre x^2 is a millionth of x.
!> The space of complete polynomials of degree 0, 1 or 2 does not change under an affine map, so each patch has coordinates of its
!> own, of size 1 whatever the units and the stretch of its elements. Places are given relative to the patch's node, so the origin
!> does not matter either.
module atrito_patch_fit
   use atrito_growth, only: resize
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: COMPONENTS
   implicit none (type, external)
   private
   public :: patch_fit_t, polynomial_t, clear_samples, add_sample, is_laid, lay_patch, determined_degree, fit_node, &
             fit_polynomial, fitted_value

   integer(ip), parameter :: MOST_TERMS = 6
   !> A term whose part that is independent of the terms before it is below this share of its square sum is not determined. It is
   !> 0.06 and more for equal elements round a node, however stretched; the samples of one row of elements give round-off.
   real(wp), parameter :: INDEPENDENT_SHARE = 1.0e-4_wp

   !> Polynomial in the terms 1, xi, eta, xi^2, xi eta, eta^2 of the patch's coordinates. (No default values: of an array of
   !> them the unused ones take no memory.)
   type :: polynomial_t
      integer(ip) :: n_terms                         !< 1, 3 or 6
      real(wp) :: axis(2, 2)                         !< xi = axis(:, 1) . x, eta with axis(:, 2) [1/L]
      real(wp) :: coefficient(COMPONENTS, MOST_TERMS) !< [F/L^2]
   end type polynomial_t

   !> Samples, and the patch that was laid last: another one with its samples at the same places takes its coordinates and factor.
   type :: patch_fit_t
      integer(ip) :: n = 0                                !< samples
      real(wp), allocatable :: x(:, :)                    !< (2, n or more) their places less the patch's node [L]
      real(wp), allocatable :: s(:, :)                    !< (COMPONENTS, n or more) [F/L^2]
      integer(ip) :: n_laid = 0, degree = -1              !< samples of the patch laid last, degree of its terms
      real(wp), allocatable :: laid(:, :)                 !< their places
      real(wp), allocatable :: p(:, :)                    !< (MOST_TERMS, n_laid) terms at the samples
      real(wp) :: axis(2, 2) = 0.0_wp                     !< of the patch laid last: columns xi and eta [1/L]
      real(wp) :: factor(MOST_TERMS, MOST_TERMS) = 0.0_wp !< lower Cholesky factor of the normal equations
      integer(ip) :: n_good = 0                           !< leading terms that the samples determine
      integer(ip) :: n_weighted = 0                       !< terms that the weights are made of
      real(wp), allocatable :: weight(:)                  !< (n_laid) of the samples in the value at the patch's node
   end type patch_fit_t

contains

   !> Forgets the samples.
   pure subroutine clear_samples(fit)
      type(patch_fit_t), intent(inout) :: fit !< its patch stays laid

      fit%n = 0
   end subroutine clear_samples

   !> Adds a point of the patch with its stresses to what the fit has to come near.
   pure subroutine add_sample(x, s, fit)
      real(wp), intent(in) :: x(2)                   !< less the patch's node [L]
      real(wp), intent(in) :: s(COMPONENTS)          !< [F/L^2]
      type(patch_fit_t), intent(inout) :: fit        !< gets one sample more

      if (.not. allocated(fit%x)) allocate (fit%x(2, 64), fit%s(COMPONENTS, 64))
      if (fit%n == size(fit%x, 2)) then
         call resize(fit%x, fit%n, 2*fit%n)
         call resize(fit%s, fit%n, 2*fit%n)
      end if
      fit%n = fit%n + 1
      fit%x(:, fit%n) = x
      fit%s(:, fit%n) = s
   end subroutine add_sample

   !> Whether the samples lie where those of the patch laid last were.
   pure logical function is_laid(degree, slack, fit)
      integer(ip), intent(in) :: degree              !< 1 or 2
      real(wp), intent(in) :: slack                  !< [L], the rounding of the coordinates
      type(patch_fit_t), intent(in) :: fit           !< with all samples of the patch
      integer(ip) :: i

      is_laid = .false.
      if (fit%n /= fit%n_laid .or. fit%degree /= degree) return
      do i = 1, fit%n
         if (abs(fit%x(1, i) - fit%laid(1, i)) > slack) return
         if (abs(fit%x(2, i) - fit%laid(2, i)) > slack) return
      end do
      is_laid = .true.
   end function is_laid

   !> Lays coordinates into the patch of the samples: xi along the line from its node to the farthest corner, eta across, each as
   !> long as the patch. Forms and factors the normal equations for polynomials up to a degree.
   pure subroutine lay_patch(corners, degree, fit)
      real(wp), intent(in) :: corners(:, :)          !< corners of the elements less the patch's node (2, n) [L]
      integer(ip), intent(in) :: degree              !< 1 or 2
      type(patch_fit_t), intent(inout) :: fit        !< with all samples of the patch
      real(wp) :: moments(MOST_TERMS, MOST_TERMS)
      integer(ip) :: i, j, n

      fit%axis = axes_of(corners)
      fit%degree = degree
      fit%n_laid = fit%n
      fit%n_weighted = 0
      fit%laid = fit%x(:, :fit%n)
      if (allocated(fit%p)) deallocate (fit%p)
      allocate (fit%p(MOST_TERMS, fit%n))
      n = term_count(degree)
      moments = 0.0_wp
      do j = 1, fit%n
         fit%p(:, j) = terms(fit%x(:, j), fit%axis)
         do i = 1, n
            moments(i:n, i) = moments(i:n, i) + fit%p(i:n, j)*fit%p(i, j)
         end do
      end do
      call factor_moments(n, moments, fit)
   end subroutine lay_patch

   !> xi = axis(:, 1) . x is the distance in the direction of the farthest corner, eta = axis(:, 2) . x that across it, each over
   !> the greatest that a corner has: the corners lie within -1..1. Of thin elements, however they are turned, xi runs along
   !> them.
   pure function axes_of(corners) result(axis)
      real(wp), intent(in) :: corners(:, :)
      real(wp) :: axis(2, 2)
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
      axis(:, 1) = far/longest
      axis(:, 2) = [-far(2), far(1)]/across
   end function axes_of

   !> M = L L' by columns, as far as the terms are determined.
   !>
   !> The pivot of column j is what is left of m_jj = sum of p_ij^2 over the samples i when the terms before it are eliminated: the
   !> square sum of that part of the term that no combination of the others has at the samples. Of samples on one straight line, xi
   !> say, eta has none: its pivot is round-off, and with INDEPENDENT_SHARE the fit ends with the terms before it. (Terms are in the
   !> order of their degree, so what is left is a lower degree.)
   pure subroutine factor_moments(n, moments, fit)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: moments(MOST_TERMS, MOST_TERMS)
      type(patch_fit_t), intent(inout) :: fit
      real(wp) :: pivot
      integer(ip) :: i, j

      associate (l => fit%factor)
         l = moments
         fit%n_good = 0
         do j = 1, n
            pivot = l(j, j)
            if (.not. pivot > INDEPENDENT_SHARE*moments(j, j)) return
            l(j:n, j) = l(j:n, j)/sqrt(pivot)
            do i = j + 1, n
               l(i:n, i) = l(i:n, i) - l(i:n, j)*l(i, j)
            end do
            fit%n_good = j
         end do
      end associate
   end subroutine factor_moments

   pure integer(ip) function term_count(degree)
      integer(ip), intent(in) :: degree              !< 0, 1 or 2

      term_count = ((degree + 1)*(degree + 2))/2
   end function term_count

   pure function terms(x, axis) result(p)
      real(wp), intent(in) :: x(2), axis(2, 2)
      real(wp) :: p(MOST_TERMS)
      real(wp) :: xi, eta

      xi = axis(1, 1)*x(1) + axis(2, 1)*x(2)
      eta = axis(1, 2)*x(1) + axis(2, 2)*x(2)
      p = [1.0_wp, xi, eta, xi*xi, xi*eta, eta*eta]
   end function terms

   !> The highest degree, up to the given one, that the samples of the patch determine.
   pure integer(ip) function determined_degree(degree, fit)
      integer(ip), intent(in) :: degree              !< not above that of lay_patch
      type(patch_fit_t), intent(in) :: fit           !< with the samples laid

      determined_degree = degree
      do while (determined_degree > 0 .and. term_count(determined_degree) > fit%n_good)
         determined_degree = determined_degree - 1
      end do
   end function determined_degree

   !> Value of the polynomial of a degree at the patch's node [F/L^2]: s_1 and the weighted differences of the samples. The weights
   !> are made when the first node asks: L L' y = p_0, w_j = p_j'y.
   pure subroutine fit_node(degree, fit, s)
      integer(ip), intent(in) :: degree              !< not above determined_degree
      type(patch_fit_t), intent(inout) :: fit        !< with the samples laid; its weights may be made
      real(wp), intent(out) :: s(COMPONENTS)         !< in the order of the samples' components [F/L^2]
      real(wp) :: y(1, MOST_TERMS)
      integer(ip) :: j, n

      n = term_count(degree)
      if (fit%n_weighted /= n) then
         y = 0.0_wp
         y(1, 1) = 1.0_wp                            ! the terms at the node
         call solve_moments(n, fit%factor, y)
         fit%weight = matmul(y(1, :n), fit%p(:n, :))
         fit%n_weighted = n
      end if
      s = 0.0_wp
      do j = 2, fit%n
         s = s + fit%weight(j)*(fit%s(:, j) - fit%s(:, 1))
      end do
      s = fit%s(:, 1) + s
   end subroutine fit_node

   !> The polynomial of a degree, for other nodes: its coefficients from M a = sum_j p_j (s_j - s_1), and s_1 added to the first.
   pure subroutine fit_polynomial(degree, fit, polynomial)
      integer(ip), intent(in) :: degree              !< not above determined_degree
      type(patch_fit_t), intent(in) :: fit           !< with the samples laid
      type(polynomial_t), intent(out) :: polynomial  !< of the patch laid last
      real(wp) :: right(MOST_TERMS, COMPONENTS)
      integer(ip) :: i, j, n

      n = term_count(degree)
      polynomial%n_terms = n
      polynomial%axis = fit%axis
      right = 0.0_wp
      do j = 2, fit%n
         do i = 1, COMPONENTS                        ! all terms: loops of a fixed length are faster
            right(:, i) = right(:, i) + fit%p(:, j)*(fit%s(i, j) - fit%s(i, 1))
         end do
      end do
      polynomial%coefficient = transpose(right)
      call solve_moments(n, fit%factor, polynomial%coefficient)
      polynomial%coefficient(:, 1) = polynomial%coefficient(:, 1) + fit%s(:, 1)
   end subroutine fit_polynomial

   !> Solves M x = L L'x = b for right sides b in rows: forward with L, backward with L'.
   pure subroutine solve_moments(n, l, x)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: l(MOST_TERMS, MOST_TERMS)
      real(wp), intent(inout) :: x(:, :)             !< (right sides, n or more)
      integer(ip) :: i, j

      do i = 1, n
         do j = 1, i - 1
            x(:, i) = x(:, i) - l(i, j)*x(:, j)
         end do
         x(:, i) = x(:, i)/l(i, i)
      end do
      do i = n, 1, -1
         do j = i + 1, n
            x(:, i) = x(:, i) - l(j, i)*x(:, j)
         end do
         x(:, i) = x(:, i)/l(i, i)
      end do
   end subroutine solve_moments

   !> Value of a polynomial [F/L^2].
   pure function fitted_value(x, polynomial) result(s)
      real(wp), intent(in) :: x(2)                   !< less the patch's node [L]
      type(polynomial_t), intent(in) :: polynomial   !< of the patch whose node x is relative to
      real(wp) :: s(COMPONENTS)
      real(wp) :: p(MOST_TERMS)
      integer(ip) :: i

      p = terms(x, polynomial%axis)
      s = polynomial%coefficient(:, 1)
      do i = 2, polynomial%n_terms
         s = s + polynomial%coefficient(:, i)*p(i)
      end do
   end function fitted_value

end module atrito_patch_fit
