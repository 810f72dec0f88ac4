!> The quadratic forms of the certificates, H(alpha) and R(alpha, gamma) of atrito_certificate_search, and products with them.
!>
!> Vectors are (z_n, v) of atrito_friction_form, where with b = (alpha - 1)/2, Y = L' diag(m) W
!>
!>     H = | alpha S   b X' |     R = | gamma W'W/2       0         |       R = -| b (X'Y + Y'X)   Y'/2 |
!>         | b X       1    |         | 0            L'L/(2 gamma)  |            | Y/2             0    |
!>                                         every load                          given way, m
!>
!> and H has T = alpha S - b^2 X'X = alpha A_nn - ((alpha + 1)/2)^2 X'X left without v: all that is to be factored for an alpha.
module atrito_certificate_forms
   use atrito_dense, only: add_square, multiply_transposed, multiply_vector
   use atrito_dense_blocks, only: factor_in_blocks, multiply_symmetric, solve_with_half, solve_with_triangle
   use atrito_friction_form, only: multiply_bounds
   use atrito_kinds, only: ip, wp
   use atrito_line_certificate, only: friction_form_t
   implicit none (type, external)
   private
   public :: forms_t, every_load_forms, given_way_forms, pencil_t, factor_pencil, solve_h, multiply_r
   public :: build_certified, reduced, norm_of

   !> What R is made of; lower triangles of what is symmetric. Only some of it is there: bound and slip, or share and way.
   type :: forms_t
      real(wp), allocatable :: bound(:, :)        !< (n, n) W'W/2
      real(wp), allocatable :: slip(:, :)         !< (m - n, m - n) L'L/2
      real(wp), allocatable :: share(:)           !< (m - n) m
      real(wp), allocatable :: way(:, :)          !< (m - n, n) Y; build_certified does without
   end type forms_t

   !> H and R at one place.
   type :: pencil_t
      real(wp) :: alpha = 1.0_wp, gamma = 1.0_wp
      real(wp), allocatable :: t(:, :)            !< Cholesky factor of T
   end type pencil_t

   real(wp), parameter :: MARGIN = 1.0e-10_wp     !< of the diagonal of H: what is left of the certified matrix is no rounding

contains

   !> R for every load.
   subroutine every_load_forms(form, forms)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(out) :: forms
      real(wp), allocatable :: unit(:, :), w(:, :), all(:)
      integer(ip) :: i, k

      k = size(form%l, 1, kind=ip)
      allocate (all(k), source=1.0_wp)
      allocate (unit(k, k), source=0.0_wp)
      do i = 1, k
         unit(i, i) = 1.0_wp
      end do
      call multiply_bounds(form, unit, all, w)
      call multiply_bounds(form, 0.5_wp*transpose(w(:, :form%n)), all, forms%bound)
      forms%bound = forms%bound(:, :form%n)
      allocate (forms%slip(k, k), source=0.0_wp)
      call add_square(form%l, .true., 0.5_wp, forms%slip)
   end subroutine every_load_forms

   !> R where the friction of tangential force j goes with m_j times its bound.
   subroutine given_way_forms(form, share, forms)
      type(friction_form_t), intent(in) :: form
      real(wp), intent(in) :: share(:)            !< (m - n) m, from -1 to 1
      type(forms_t), intent(out) :: forms

      forms%share = share
      call multiply_bounds(form, transpose(form%l), share, forms%way)
      forms%way = forms%way(:, :form%n)
   end subroutine given_way_forms

   !> Factors T. failed: /= 0 where H is not positive definite.
   !>
   !> H = [ alpha S  b X' ; b X  1 ] has the unit matrix in its lower corner, so it is positive definite where what is left of it
   !> without v is, T = alpha S - b^2 X'X. With S = A_nn - X'X and alpha + b^2 = ((alpha + 1)/2)^2 that is what is formed here: one
   !> factor of the order of the normal forces, n^3/3 operations, for each alpha.
   subroutine factor_pencil(form, pencil, failed)
      type(friction_form_t), intent(in) :: form
      type(pencil_t), intent(inout) :: pencil     !< with alpha
      integer(ip), intent(out) :: failed

      associate (n => form%n, alpha => pencil%alpha)
         pencil%t = alpha*form%a(:n, :n) - ((alpha + 1)/2)**2*form%xx
      end associate
      call factor_in_blocks(pencil%t, failed)
   end subroutine factor_pencil

   !> z <- H^-1 z
   subroutine solve_h(form, pencil, z)
      type(friction_form_t), intent(in) :: form
      type(pencil_t), intent(in) :: pencil
      real(wp), intent(inout), contiguous :: z(:)
      real(wp) :: normal(form%n), tangential(size(z) - form%n), b

      b = (pencil%alpha - 1)/2
      associate (n => form%n)
         call multiply_transposed(form%x, z(n + 1:), normal)
         normal = z(:n) - b*normal
         call solve_with_triangle(pencil%t, normal)
         call multiply_vector(form%x, normal, tangential)
         z(:n) = normal
         z(n + 1:) = z(n + 1:) - b*tangential
      end associate
   end subroutine solve_h

   !> image = R z
   subroutine multiply_r(form, forms, pencil, z, image)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(in) :: forms
      type(pencil_t), intent(in) :: pencil
      real(wp), intent(in), contiguous :: z(:)
      real(wp), intent(out), contiguous :: image(:)
      real(wp) :: normal(form%n), x(size(z) - form%n), y(size(z) - form%n), b

      associate (n => form%n)
         if (allocated(forms%bound)) then
            call multiply_symmetric(forms%bound, z(:n), image(:n))
            call multiply_symmetric(forms%slip, z(n + 1:), image(n + 1:))
            image(:n) = pencil%gamma*image(:n)
            image(n + 1:) = image(n + 1:)/pencil%gamma
         else
            b = (pencil%alpha - 1)/2
            call multiply_vector(form%x, z(:n), x)
            call multiply_vector(forms%way, z(:n), y)
            call multiply_transposed(form%x, y, normal)
            image(n + 1:) = -0.5_wp*y
            y = b*x + 0.5_wp*z(n + 1:)
            call multiply_transposed(forms%way, y, image(:n))
            image(:n) = -(image(:n) + b*normal)
         end if
      end associate
   end subroutine multiply_r

   !> H - s R less MARGIN of the diagonal of H, lower triangle: what has a Cholesky factor where s is certified.
   !>
   !> For every load it is that of all forces as they are. Of a way it is what is left without v, and A_tt has its factor; as
   !> X'Y = A_nt diag(m) W and Y'Y = W'diag(m) A_tt diag(m) W, and W has few entries, some m^2 operations suffice:
   !>
   !>     alpha S - |2 b X - s Y|^2/4 = T - (V + V')/4,      V = s (s/2 W'diag(m) A_tt - 2 b A_nt) diag(m) W
   subroutine build_certified(form, forms, factor, pencil, matrix)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(in) :: forms
      real(wp), intent(in) :: factor              !< s
      type(pencil_t), intent(in) :: pencil        !< with alpha and gamma
      real(wp), allocatable, intent(out) :: matrix(:, :)
      real(wp), allocatable :: w(:, :), left(:, :), v(:, :)
      integer(ip) :: i, j

      associate (n => form%n, alpha => pencil%alpha, gamma => pencil%gamma)
         if (allocated(forms%share)) then
            call multiply_bounds(form, form%a(n + 1:, n + 1:), forms%share, w)
            allocate (left(n, size(w, 1)))
            do j = 1, size(w, 1, kind=ip)
               left(:, j) = factor*(0.5_wp*factor*w(j, :n) - (alpha - 1)*form%a(:n, n + j))
            end do
            deallocate (w)                        ! its memory is near, and serves v
            call multiply_bounds(form, left, forms%share, v)
            deallocate (left)
            allocate (matrix(n, n))
            do j = 1, n
               do i = j, n
                  matrix(i, j) = alpha*form%a(i, j) - ((alpha + 1)/2)**2*form%xx(i, j) - 0.25_wp*(v(i, j) + v(j, i))
               end do
               matrix(j, j) = matrix(j, j) - MARGIN*alpha*form%a(j, j)
            end do
         else
            matrix = form%a
            matrix(:n, :n) = alpha*matrix(:n, :n)
            matrix(n + 1:, :n) = (0.5_wp*(alpha + 1))*matrix(n + 1:, :n)
            do i = 1, size(matrix, 1, kind=ip)
               matrix(i, i) = (1 - MARGIN)*matrix(i, i)
            end do
            matrix(:n, :n) = matrix(:n, :n) - factor*gamma*forms%bound
            call add_square(form%a(:, n + 1:), .false., -0.5_wp*factor/gamma, matrix)
         end if
      end associate
   end subroutine build_certified

   !> (z_n, v) of forces.
   function reduced(form, forces) result(z)
      type(friction_form_t), intent(in) :: form
      real(wp), intent(in), contiguous :: forces(:)
      real(wp) :: z(size(forces))

      call multiply_symmetric(form%a, forces, z)
      z(:form%n) = forces(:form%n)
      call solve_with_half(form%l, .false., z(form%n + 1:))
   end function reduced

   !> The length of the forces of (z_n, v).
   real(wp) function norm_of(form, z) result(length)
      type(friction_form_t), intent(in) :: form
      real(wp), intent(in), contiguous :: z(:)
      real(wp) :: tangential(size(z) - form%n)

      call multiply_vector(form%x, z(:form%n), tangential)
      tangential = z(form%n + 1:) - tangential
      call solve_with_half(form%l, .true., tangential)
      length = norm2([z(:form%n), tangential])
   end function norm_of

end module atrito_certificate_forms
