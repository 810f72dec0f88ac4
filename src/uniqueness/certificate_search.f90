!> The largest coefficient of friction up to which a matrix with two free numbers is positive definite.
!>
!> The certificates (atrito_one_solution) ask for
!>
!>     H(alpha) - s R(alpha, gamma) > 0,      H = sym(diag(alpha 1, 1) A),
!>     R = (gamma W'W (+) 0 + A_t'A_t/gamma)/2           every load
!>     R = -sym(diag(alpha 1, 1) [A_t S W, 0])           the directions S of slip given, or shares from -1 to 1 of the bounds
!>
!> for some alpha, gamma > 0; A_t are the tangential rows of A. The least s at which this fails is 1/lambda, lambda the largest
!> ratio z'Rz/z'Hz. Each vector z that a search for it finds is a cut: for all alpha and gamma
!>
!>     lambda(alpha, gamma) >= (a gamma + b/gamma + e alpha + f)/(c alpha + d),
!>
!> with a = |W z_n|^2/2, b = |A_t z|^2/2, c = z_n'(A z)_n, d = z_t'(A z)_t. So (Kelley's method) the next alpha and gamma are those
!> where the greatest of all cuts is least, not too far from the best so far, and the greatest there is what can be gained at most.
!> An alpha for which H is not positive is not come nearer to than half way. The set of (alpha, gamma) that serve an s is convex, so
!> there is one least; a few rounds come to within some per cent of it, and any (alpha, gamma) will do. In the end the matrix of the
!> best is factored: its Cholesky factor is the proof.
module atrito_certificate_search
   use atrito_certificate_forms, only: build_certified, factor_pencil, forms_t, pencil_t, multiply_r, norm_of, reduced, solve_h
   use atrito_dense, only: multiply_transposed, multiply_vector, eigen_symmetric
   use atrito_dense_blocks, only: factor_in_blocks, multiply_symmetric
   use atrito_kinds, only: ip, wp
   use atrito_line_certificate, only: friction_form_t
   implicit none (type, external)
   private
   public :: certified_factor

   type :: cut_t
      real(wp) :: a = 0.0_wp, b = 0.0_wp, c = 0.0_wp, d = 0.0_wp, e = 0.0_wp, f = 0.0_wp
   end type cut_t

   !> The two numbers, as exponents of e, and the ratio there.
   type :: place_t
      real(wp) :: x = 2.0_wp, y = 0.0_wp          !< alpha = e^x, gamma = e^y
      real(wp) :: ratio = huge(1.0_wp)
   end type place_t

   integer, parameter :: ROUNDS = 8, HALVINGS = 5, MOST_POLISHING = 6
   integer, parameter :: SMALL = 16               !< unknowns of a line whose ratios stand after the steps of the rounds
   real(wp), parameter :: FAR = 2.0_wp            !< first change of an exponent at most, twice as much where it was all used
   real(wp), parameter :: GOOD_ENOUGH = 0.98_wp   !< of the ratio: no more to be gained
   integer, parameter :: TRIES = 12
   real(wp), parameter :: BACK = 0.998_wp         !< of the factor, and again where the largest ratio was not met by the steps

   integer(ip), parameter :: STEPS = 8
   real(wp), parameter :: STIRRED = 0.1_wp          !< part of the start that is not z: of an eigenvector alone nothing else comes
   real(wp), parameter :: NOTHING_NEW = 1.0e-12_wp  !< part of R z that is rounding: the steps have all there is

contains

   !> The largest s found for which the matrix is positive definite, at most `most`; 0 where none was, A itself being singular.
   !>
   !> The ratios come from a few steps of Lanczos and may be too low, the coefficient too high. So the matrix at the best place is
   !> built and factored. A Cholesky factor that comes to its end, with MARGIN for its own round-off, is a proof; where it does
   !> not, the coefficient goes down, by more each time. What is returned has been proved, whatever the search was worth.
   subroutine certified_factor(form, forms, most, factor, pencil)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(in) :: forms
      real(wp), intent(in) :: most
      real(wp), intent(out) :: factor
      type(pencil_t), intent(out) :: pencil       !< its alpha and gamma
      type(place_t) :: best
      real(wp), allocatable :: matrix(:, :)
      integer :: i
      integer(ip) :: failed

      call search(form, forms, most, best)
      pencil%alpha = exp(best%x)
      pencil%gamma = exp(best%y)
      factor = 0.0_wp
      if (best%ratio >= huge(1.0_wp)) return
      factor = most
      if (best%ratio*most > BACK) factor = BACK/best%ratio    ! also where it is not positive: then any s will do
      do i = 1, TRIES
         call build_certified(form, forms, factor, pencil, matrix)
         call factor_in_blocks(matrix, failed)
         if (failed == 0) return
         factor = BACK**(2**(i - 1))*factor       ! 0.2, 0.6, 1.4, 3 per cent less, ...
      end do
      factor = 0.0_wp
   end subroutine certified_factor

   !> The alpha and gamma with the least of the largest ratios, as far as a few rounds come.
   !>
   !> Each round, at (alpha, gamma) = (e^x, e^y):
   !>
   !>     1. the Cholesky factor of H; where there is none alpha is too far from 1, and x goes back towards 0, which is A itself
   !>     2. the largest ratio there, and its vector z, by some steps of Lanczos from the z of the round before
   !>     3. the cut of z; the best place so far
   !>     4. from that the place where the greatest of all cuts is least, within reach; reach doubles where all of it was used
   !>
   !> It ends where the ratio is low enough for the coefficient that is asked for, or where the cuts, which are lower bounds of the
   !> ratio, say that no place within reach is better by more than two per cent.
   subroutine search(form, forms, most, best)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(in) :: forms
      real(wp), intent(in) :: most
      type(place_t), intent(out) :: best
      type(place_t) :: now
      type(cut_t) :: cuts(ROUNDS)
      type(pencil_t) :: pencil
      real(wp) :: z(size(form%a, 1)), reach, ceiling, bound, slip, y
      integer :: round, n_cuts
      integer(ip) :: failed, i

      z = 0.0_wp
      ! gamma for alpha = 1 at which both parts of R are alike, as an exponent.
      y = 0.0_wp
      if (allocated(forms%bound)) then
         bound = sum([(forms%bound(i, i), i=1, form%n)])
         slip = 0.5_wp*sum(form%a(form%n + 1:, form%n + 1:)**2)
         if (bound > 0.0_wp .and. slip > 0.0_wp) y = 0.5_wp*log(slip/bound)
      end if
      now%y = y + 0.5_wp*now%x
      n_cuts = 0
      reach = FAR
      ceiling = huge(ceiling)
      do round = 1, ROUNDS
         pencil%alpha = exp(now%x)
         pencil%gamma = exp(now%y)
         call factor_pencil(form, pencil, failed)
         if (failed /= 0) then
            if (abs(now%x) <= 0.0_wp) return      ! A itself
            if (now%x > 0.0_wp) ceiling = min(ceiling, now%x)
            now%y = now%y - 0.5_wp*now%x
            now%x = 0.0_wp
            if (n_cuts > 0) now%x = 0.5_wp*(best%x + now%x)
            now%y = now%y + 0.5_wp*now%x
            cycle
         end if
         call find_largest_ratio(form, forms, pencil, z, now%ratio)
         n_cuts = n_cuts + 1
         cuts(n_cuts) = cut_of(form, forms, now, z)
         if (now%ratio < best%ratio) best = now
         if (best%ratio*most <= BACK .or. round == ROUNDS) exit
         now = best
         if (ceiling < huge(ceiling)) reach = min(reach, 0.5_wp*(ceiling - best%x))
         call go_downhill(cuts(:n_cuts), reach, allocated(forms%bound), now)
         reach = merge(2*reach, FAR, abs(now%x - best%x) > 0.9_wp*reach)
         if (now%ratio > GOOD_ENOUGH*best%ratio) exit
      end do
      if (best%ratio < huge(1.0_wp) .and. size(z) > SMALL) call polish(form, forms, z, best)
   end subroutine search

   !> More steps at the best place, until the ratio stands.
   subroutine polish(form, forms, z, best)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(in) :: forms
      real(wp), intent(inout), contiguous :: z(:)
      type(place_t), intent(inout) :: best
      type(pencil_t) :: pencil
      real(wp) :: before
      integer :: i
      integer(ip) :: failed

      pencil%alpha = exp(best%x)
      pencil%gamma = exp(best%y)
      call factor_pencil(form, pencil, failed)
      do i = 1, MOST_POLISHING
         before = best%ratio
         call find_largest_ratio(form, forms, pencil, z, best%ratio)
         best%ratio = max(best%ratio, before)
         if (best%ratio <= before + (1 - BACK)*abs(before)) exit
      end do
   end subroutine polish

   !> The cut of a vector z, of which the ratio at one place is known.
   !>
   !> With x = X z_n and v = L' z_t + x the two halves of z'A z are
   !>
   !>     c = z_n'A_nn z_n + x'(v - x),     d = (v - x)'v,     so that z'H z = alpha c + d.
   !>
   !> z'R z is known from the ratio, lambda (alpha c + d). One of its two terms is computed, the other one is what is left.
   type(cut_t) function cut_of(form, forms, place, z) result(cut)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(in) :: forms
      type(place_t), intent(in) :: place          !< with the ratio of z
      real(wp), intent(in), contiguous :: z(:)    !< (z_n, v)
      real(wp) :: x(size(z) - form%n), normal(form%n), all

      associate (n => form%n, v => z(form%n + 1:))
         call multiply_vector(form%x, z(:n), x)
         call multiply_symmetric(form%a(:n, :n), z(:n), normal)
         cut%c = dot_product(z(:n), normal) + dot_product(x, v - x)
         cut%d = dot_product(v - x, v)
         all = place%ratio*(exp(place%x)*cut%c + cut%d)
         if (allocated(forms%bound)) then
            call multiply_symmetric(forms%bound, z(:n), normal)
            cut%a = dot_product(z(:n), normal)
            cut%b = max(all/exp(place%y) - cut%a, 0.0_wp)*exp(2*place%y)
         else
            call multiply_transposed(forms%way, x, normal)
            cut%e = -dot_product(z(:n), normal)
            cut%f = all - exp(place%x)*cut%e
         end if
      end associate
   end function cut_of

   !> From a place to where the greatest of the cuts is least, within reach of it; the ratio is that of the cuts, a lower bound.
   pure subroutine go_downhill(cuts, reach, has_gamma, place)
      type(cut_t), intent(in) :: cuts(:)
      real(wp), intent(in) :: reach
      logical, intent(in) :: has_gamma
      type(place_t), intent(inout) :: place
      type(place_t) :: centre, next
      real(wp) :: step
      integer :: i, side

      place%ratio = greatest(cuts, place)
      centre = place
      step = reach
      do i = 1, HALVINGS
         step = 0.5_wp*step
         do side = 1, merge(6, 2, has_gamma)
            next = place
            if (side <= 2) then                   ! along alpha gamma is best where it goes with its root
               next%x = place%x + merge(step, -step, side == 1)
               next%y = place%y + 0.5_wp*(next%x - place%x)
               if (abs(next%x - centre%x) > reach) cycle
            else if (side <= 4) then
               next%y = place%y + merge(step, -step, side == 3)
            else
               next%x = place%x + merge(step, -step, side == 5)
               if (abs(next%x - centre%x) > reach) cycle
            end if
            next%ratio = greatest(cuts, next)
            if (next%ratio < place%ratio) place = next
         end do
      end do
   end subroutine go_downhill

   !> The greatest of the cuts at a place; huge where H is not positive.
   pure real(wp) function greatest(cuts, place)
      type(cut_t), intent(in) :: cuts(:)
      type(place_t), intent(in) :: place
      real(wp) :: alpha, gamma, below
      integer :: i

      alpha = exp(place%x)
      gamma = exp(place%y)
      greatest = -huge(1.0_wp)
      do i = 1, size(cuts)
         associate (cut => cuts(i))
            below = cut%c*alpha + cut%d
            if (.not. below > 0.0_wp) then
               greatest = huge(1.0_wp)
               return
            end if
            greatest = max(greatest, (cut%a*gamma + cut%b/gamma + cut%e*alpha + cut%f)/below)
         end associate
      end do
   end function greatest

   !> The largest ratio z'Rz/z'Hz of two quadratic forms, H positive definite: the largest eigenvalue of R z = lambda H z.
   !>
   !> The method of Lanczos with the product of H. Each step takes r = R z_j, takes off what the steps before have of it, and solves
   !> H z_{j+1} = r:
   !>
   !>     r <- R z_j,     r <- r - sum_i (z_i' r) H z_i,     z_{j+1} = H^-1 r/|r|,     |r|^2 = r' H^-1 r.
   !>
   !> H z_{j+1} is that r/|r|, so H itself is never multiplied by, and its Cholesky factor is all that is wanted of it. On the
   !> vectors of the steps R is a small matrix T with z_i'R z_j as entries; its largest eigenvalue is a lower bound of the one
   !> of all vectors, and after a few steps near it. (All vectors are kept orthogonal: there are few.) A step costs some 5 n^2
   !> multiplications.
   !>
   !> What is found is a lower bound and no more. Whoever wants a proof factors H - R/lambda.
   !>
   !> Goes STEPS steps from about H^-1 R z; on return z is the vector of the largest ratio that was met, with z'Hz = 1.
   subroutine find_largest_ratio(form, forms, pencil, z, ratio)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(in) :: forms
      type(pencil_t), intent(in) :: pencil              !< factored
      real(wp), intent(inout), contiguous :: z(:)       !< (m) (z_n, v); 0: none yet
      real(wp), intent(out) :: ratio                    !< <= the largest there is
      real(wp) :: v(size(z), STEPS), hv(size(z), STEPS), t(STEPS, STEPS), values(STEPS)
      real(wp) :: image(size(z)), next(size(z)), length, before
      integer(ip) :: i, j, n, info

      t = 0.0_wp
      n = 0
      length = norm_of(form, z)
      if (length > 0.0_wp) z = z/length
      z = z + STIRRED/sqrt(real(size(z), wp))*reduced(form, [(1.0_wp + 0.9_wp*sin(real(5*i*i, wp)), i=1, size(z))])
      call multiply_r(form, forms, pencil, z, image)
      before = 0.0_wp
      do j = 1, min(STEPS, size(z, kind=ip))
         next = image
         call solve_h(form, pencil, next)
         length = sqrt(max(dot_product(image, next), 0.0_wp))
         if (.not. length > NOTHING_NEW*before) exit
         n = j
         v(:, j) = next/length
         hv(:, j) = image/length
         call multiply_r(form, forms, pencil, v(:, j), image)
         before = norm2(image)*norm2(v(:, j))
         do i = 1, j
            t(j, i) = dot_product(v(:, i), image)
         end do
         do i = 1, j
            image = image - dot_product(v(:, i), image)*hv(:, i)
         end do
      end do
      ratio = 0.0_wp
      if (n == 0) return
      call eigen_symmetric(t(:n, :n), values(:n), info)
      if (info /= 0) return
      ratio = values(n)
      z = matmul(v(:, :n), t(:n, n))
   end subroutine find_largest_ratio

end module atrito_certificate_search
