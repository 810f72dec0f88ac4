!> The certificate for every load of a line in the sparse form, from a sparse matrix with signs (atrito_signed_scene).
!>
!> The form is H(alpha) - nu R(gamma), R = F'F with F = ((gamma/2)^(1/2) W q_n, (2 gamma)^(-1/2) B_t w) of the unknowns of that
!> matrix. With H factored a few steps on vectors (y_n, y_t), two linear solves each, find from below the largest eigenvalue of
!> F H^-1 F', which is 1/nu: of W alone it is L_n gamma/2, of the slip L_t/(2 gamma), and gamma = (L_t/L_n)^(1/2) makes them alike.
!> Then the matrix of a nu that is a little less is factored: its signs are the proof. alpha goes uphill in few steps, as any one
!> will do.
module atrito_sparse_certificate
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_dense, only: eigen_symmetric
   use atrito_kinds, only: ip, wp
   use atrito_signed_scene, only: build_signed_scene, factor_signed, multiply_compliance, signed_scene_t
   use atrito_status, only: is_ok, status_t
   implicit none (type, external)
   private
   public :: certify_sparse

   !> Vectors (y_n, 0) and (0, y_t), orthonormal, and what multiply_compliance makes of them.
   type :: subspace_t
      integer(ip) :: n = 0
      real(wp), allocatable :: y(:, :, :)         !< (tangential forces, STEPS, 2)
      real(wp), allocatable :: image(:, :, :, :)  !< (tangential forces, STEPS, 2, 2) part of the image, vector, its part
   end type subspace_t

   integer(ip), parameter :: STEPS = 5, LATER_STEPS = 3 !< with the first alpha; with others, from where the one before came
   integer, parameter :: TRIALS = 7, TRIES = 4
   real(wp), parameter :: FIRST = 1.0_wp          !< alpha = e^FIRST
   real(wp), parameter :: NARROW = 0.6_wp         !< of exponents between which the best lies
   real(wp), parameter :: BACK = 0.99_wp          !< of what the steps say, then its 3rd, 6th and 10th power
   real(wp), parameter :: MARGIN = 1.0e-3_wp      !< of nu, proved beyond what is told: no rounding

contains

   !> The largest nu found up to which there is one solution, at most `most`; 0: none.
   subroutine certify_sparse(fem, rows, line, most, nu, status)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: most
      real(wp), intent(out) :: nu
      type(status_t), intent(out) :: status       !< STATUS_INTERNAL when the memory does not suffice
      type(signed_scene_t) :: signed
      real(wp), allocatable :: y(:, :)
      real(wp) :: x(TRIALS), ratio(TRIALS), gamma(TRIALS)
      integer :: i, at, best, low, high
      logical :: is_definite

      nu = 0.0_wp
      call build_signed_scene(fem, rows, line, signed, status)
      if (.not. is_ok(status)) return
      ratio = huge(1.0_wp)
      best = 0
      low = 0
      high = 0
      do i = 1, TRIALS
         x(i) = next_place()
         call factor_signed(signed, exp(x(i)), 1.0_wp, 0.0_wp, is_definite)
         if (is_definite) call find_ratio(signed, y, ratio(i), gamma(i))
         at = max(best, 1)
         if (best > 0 .and. minloc(ratio, dim=1) == i) at = i     ! the one before is beside it
         if (at /= i) then
            if (x(i) > x(at)) high = i
            if (x(i) < x(at)) low = i
         else if (best > 0) then
            if (x(best) > x(i)) high = best
            if (x(best) < x(i)) low = best
         else if (.not. is_definite) then
            high = 1
         end if
         if (is_definite .and. minloc(ratio, dim=1) == i) best = i
         if (min(low, high, best) == 0) cycle
         if (max(x(high) - x(best), x(best) - x(low)) < NARROW) exit
      end do
      do while (any(ratio < huge(1.0_wp)))
         best = minloc(ratio, dim=1)
         do i = 1, TRIES
            nu = min(most, BACK**(i*(i + 1)/2)/max(ratio(best), tiny(1.0_wp)))
            call factor_signed(signed, exp(x(best)), gamma(best), (1 + MARGIN)*nu, is_definite)
            if (is_definite) return
         end do
         ratio(best) = huge(1.0_wp)               ! another alpha
      end do
      nu = 0.0_wp

   contains

      !> Up in steps that grow, or down, until the best lies between two others; then into the larger gap beside it, or of equal
      !> ones that with the better end.
      pure real(wp) function next_place() result(place)

         if (best == 0) then
            place = FIRST
            if (high > 0) place = x(high) - 1.0_wp
         else if (high == 0) then
            place = x(best) + 2.0_wp**(i - 2)
         else if (low == 0) then
            place = x(best) - 1.0_wp
         else
            associate (above => x(high) - x(best), below => x(best) - x(low))
               place = x(best) - 0.5_wp*below
               if (above > 1.5_wp*below .or. (below < 1.5_wp*above .and. ratio(high) < ratio(low))) place = x(best) + 0.5_wp*above
            end associate
         end if
      end function next_place

   end subroutine certify_sparse

   !> The largest ratio of R and H at the gamma that makes its two parts alike, as far as a few steps come.
   subroutine find_ratio(signed, y, ratio, gamma)
      type(signed_scene_t), intent(in) :: signed  !< factored with nu = 0
      real(wp), allocatable, intent(inout) :: y(:, :) !< (tangential forces, 2) where to begin; out: where that led
      real(wp), intent(out) :: ratio, gamma
      type(subspace_t) :: space
      real(wp) :: parts(2)
      integer(ip) :: m, i, j, most

      m = signed%w%n
      most = STEPS
      if (allocated(y)) most = LATER_STEPS
      allocate (space%y(m, most, 2), space%image(m, most, 2, 2))
      if (.not. allocated(y)) then                ! pressures that alternate, and slip all one way
         y = reshape([([(sin(real(5*i*i, wp)) + 0.3_wp*(-1.0_wp)**i, i=1, m)]), &
                      [(1.0_wp + 0.3_wp*sin(real(7*i*i, wp)), i=1, m)]], [m, 2_ip])
      end if
      do i = 1, most
         do j = 1, 2
            call add_vector(space, j, y(:, j))
         end do
         space%n = i
         call multiply_compliance(signed, space%y(:, i, 1), 0*y(:, 1), space%image(:, i, 1, 1), space%image(:, i, 1, 2))
         call multiply_compliance(signed, 0*y(:, 1), space%y(:, i, 2), space%image(:, i, 2, 1), space%image(:, i, 2, 2))
         do j = 1, 2
            call largest_of([j], [1.0_wp], parts(j))
         end do
         gamma = sqrt(max(parts(2), tiny(1.0_wp))/max(parts(1), tiny(1.0_wp)))
         call largest_of([1_ip, 2_ip], [sqrt(gamma/2), 1/sqrt(2*gamma)], ratio)
      end do

   contains

      !> The largest eigenvalue on some of the vectors, scaled; y gets what it leads to.
      subroutine largest_of(kinds, scale, value)
         integer(ip), intent(in) :: kinds(:)
         real(wp), intent(in) :: scale(:)
         real(wp), intent(out) :: value
         real(wp) :: t(size(kinds)*space%n, size(kinds)*space%n), values(size(kinds)*space%n)
         integer(ip) :: a, b, p, q, info

         associate (n => space%n)
            do a = 1, size(kinds, kind=ip)
               do b = 1, size(kinds, kind=ip)
                  do p = 1, n
                     do q = 1, n
                        t((a - 1)*n + p, (b - 1)*n + q) = scale(a)*scale(b) &
                                                        *dot_product(space%y(:, p, kinds(a)), space%image(:, q, kinds(b), kinds(a)))
                     end do
                  end do
               end do
            end do
            t = 0.5_wp*(t + transpose(t))
            call eigen_symmetric(t, values, info)
            value = values(size(values))
            if (info /= 0) value = huge(1.0_wp)
            do a = 1, size(kinds, kind=ip)
               if (size(kinds) == 1) y(:, kinds(a)) = 0.0_wp
               do b = 1, size(kinds, kind=ip)
                  y(:, kinds(a)) = y(:, kinds(a)) + scale(a)*scale(b)/max(value, tiny(1.0_wp)) &
                                   *matmul(space%image(:, :n, kinds(b), kinds(a)), t((b - 1)*n + 1:b*n, size(values)))
               end do
            end do
         end associate
      end subroutine largest_of

   end subroutine find_ratio

   !> What a vector has that those before have not, of length one; anything where that is nothing.
   subroutine add_vector(space, kind_of, vector)
      type(subspace_t), intent(inout) :: space
      integer(ip), intent(in) :: kind_of
      real(wp), intent(in) :: vector(:)
      integer(ip) :: i, repeat
      real(wp), parameter :: NOTHING = 1.0e-10_wp

      associate (new => space%y(:, space%n + 1, kind_of))
         new = vector/max(norm2(vector), tiny(1.0_wp))
         do repeat = 1, 2
            do i = 1, space%n
               new = new - dot_product(new, space%y(:, i, kind_of))*space%y(:, i, kind_of)
            end do
            if (norm2(new) <= NOTHING) new = 0.0_wp
            new = new/max(norm2(new), tiny(1.0_wp))
         end do
      end associate
   end subroutine add_vector

end module atrito_sparse_certificate
