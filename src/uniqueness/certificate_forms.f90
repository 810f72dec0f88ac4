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
   use atrito_dense, only: add_square, multiply_transposed, multiply_vector, transposed_product
   use atrito_dense_blocks, only: factor_in_blocks, multiply_symmetric, solve_with_half, solve_with_triangle
   use atrito_kinds, only: ip, wp
   use atrito_line_certificate, only: friction_form_t
   implicit none (type, external)
   private
   public :: forms_t, every_load_forms, given_way_forms, pencil_t, factor_pencil, solve_h, multiply_r
   public :: build_certified, reduced, norm_of

   !> What R is made of; lower triangles of what is symmetric. Only some of it is there: bound and slip, or way.
   type :: forms_t
      real(wp), allocatable :: bound(:, :)        !< (n, n) W'W/2
      real(wp), allocatable :: slip(:, :)         !< (m - n, m - n) L'L/2
      real(wp), allocatable :: way(:, :)          !< (m - n, n) Y
   end type forms_t

   !> H and R at one place.
   type :: pencil_t
      real(wp) :: alpha = 1.0_wp, gamma = 1.0_wp
      real(wp), allocatable :: t(:, :)            !< Cholesky factor of T
   end type pencil_t

   real(wp), parameter :: MARGIN = 1.0e-10_wp     !< of the diagonal of H: what is left of the certified matrix is no rounding
   integer, parameter :: FEW = 8                  !< entries of W for each force up to which they are taken one by one

contains

   !> R for every load.
   subroutine every_load_forms(form, forms)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(out) :: forms
      integer(ip) :: k

      k = size(form%l, 1, kind=ip)
      allocate (forms%bound(form%n, form%n), forms%slip(k, k), source=0.0_wp)
      call add_square(form%w, .false., 0.5_wp, forms%bound)
      call add_square(form%l, .true., 0.5_wp, forms%slip)
   end subroutine every_load_forms

   !> R where the friction of tangential force j goes with m_j times its bound.
   subroutine given_way_forms(form, share, forms)
      type(friction_form_t), intent(in) :: form
      real(wp), intent(in) :: share(:)            !< (m - n) m, from -1 to 1
      type(forms_t), intent(out) :: forms
      real(wp) :: bound(size(share), form%n)
      integer(ip) :: i, j

      allocate (forms%way(size(share), form%n), source=0.0_wp)
      do j = 1, size(share, kind=ip)
         bound(j, :) = share(j)*form%w(:, j)
      end do
      if (count(abs(bound) > 0.0_wp) > FEW*size(share)) then
         call transposed_product(form%l, bound, forms%way)
         return
      end if
      do i = 1, form%n
         do j = 1, size(share, kind=ip)
            if (abs(bound(j, i)) > 0.0_wp) forms%way(:j, i) = forms%way(:j, i) + bound(j, i)*form%l(j, :j)
         end do
      end do
   end subroutine given_way_forms

   !> Factors T. failed: /= 0 where H is not positive definite.
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
   !> For every load it is that of all forces as they are. Of a way it is what is left without v, and A_tt has its factor:
   !>
   !>     alpha S - |2 b X - s Y|^2/4
   subroutine build_certified(form, forms, factor, pencil, matrix)
      type(friction_form_t), intent(in) :: form
      type(forms_t), intent(in) :: forms
      real(wp), intent(in) :: factor              !< s
      type(pencil_t), intent(in) :: pencil        !< with alpha and gamma
      real(wp), allocatable, intent(out) :: matrix(:, :)
      integer(ip) :: i

      associate (n => form%n, alpha => pencil%alpha, gamma => pencil%gamma)
         if (allocated(forms%way)) then
            matrix = alpha*(form%a(:n, :n) - form%xx)
            do i = 1, n
               matrix(i, i) = matrix(i, i) - MARGIN*alpha*form%a(i, i)
            end do
            call add_square((alpha - 1)*form%x - factor*forms%way, .true., -0.25_wp, matrix)
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
