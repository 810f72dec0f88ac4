!> The largest ratio z'Rz/z'Hz of two quadratic forms, H positive definite: the largest eigenvalue of R z = lambda H z.
!>
!> The method of Lanczos with the product of H. Each step takes r = R z_j, takes off what the steps before have of it, and solves
!> H z_{j+1} = r:
!>
!>     r <- R z_j,     r <- r - sum_i (z_i' r) H z_i,     z_{j+1} = H^-1 r/|r|,     |r|^2 = r' H^-1 r.
!>
!> H z_{j+1} is that r/|r|, so H itself is never multiplied by, and its Cholesky factor is all that is wanted of it. On the vectors
!> of the steps R is a small matrix T with z_i'R z_j as entries; its largest eigenvalue is a lower bound of the one of all vectors,
!> and after a few steps near it. (All vectors are kept orthogonal: there are few.) A step costs some 5 n^2 multiplications.
!>
!> What is found is a lower bound and no more. Whoever wants a proof factors H - R/lambda.
module atrito_largest_ratio
   use atrito_certificate_forms, only: forms_t, multiply_r, norm_of, pencil_t, reduced, solve_h
   use atrito_dense, only: eigen_symmetric
   use atrito_kinds, only: ip, wp
   use atrito_line_certificate, only: friction_form_t
   implicit none (type, external)
   private
   public :: find_largest_ratio

   integer(ip), parameter :: STEPS = 8
   real(wp), parameter :: STIRRED = 0.1_wp          !< part of the start that is not z: of an eigenvector alone nothing else comes
   real(wp), parameter :: NOTHING_NEW = 1.0e-12_wp  !< part of R z that is rounding: the steps have all there is

contains

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

end module atrito_largest_ratio
