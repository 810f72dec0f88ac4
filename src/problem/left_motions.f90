!> Rigid motions that all supports leave to a body: a body knows those of its own dofs alone, and supports along directions of their
!> own (*TRANSFORM) are bilateral rows. So what is asked of motions has one answer however a scene is turned.
!>
!> Z are the motions that the body's own dofs leave, each scaled to size one. A support with the row v_k at the nodes k
!> sees of a motion
!>
!>     r = Z' sum_k v_k(x_k),     and all of them     A = sum r r',
!>
!> so the motions that no support sees are Z times the eigenvectors of A with the eigenvalue 0 (below 1e-14 a row, round-off of the
!> squares).
module atrito_left_motions
   use atrito_assembly, only: fem_t
   use atrito_bilateral_rows, only: bilateral_rows_t, ROW_SUPPORT
   use atrito_bodies, only: mode_at
   use atrito_dense, only: eigen_symmetric
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: motions_left

   real(wp), parameter :: NONE_HELD = 1.0e-14_wp    !< square of what a support sees of a motion that it leaves

contains

   !> The columns are motions as those of body_t: two translations and a rotation.
   function motions_left(fem, bilateral, b) result(left)
      type(fem_t), intent(in) :: fem
      type(bilateral_rows_t), intent(in) :: bilateral
      integer(ip), intent(in) :: b                  !< body
      real(wp), allocatable :: left(:, :)           !< (3, motions)
      real(wp), allocatable :: a(:, :), values(:), row(:)
      real(wp) :: all_rows
      integer(ip) :: i, k, dof, mode, n
      integer :: info

      associate (body => fem%bodies%list(b))
         left = body%modes
         n = size(left, 2, kind=ip)
         do mode = 1, n
            left(:, mode) = left(:, mode)/norm2(left(:, mode))
         end do
         if (n == 0 .or. bilateral%n == 0) return
         allocate (a(n, n), values(n), row(n), source=0.0_wp)
         all_rows = 0.0_wp
         do i = 1, bilateral%n
            if (bilateral%kind(i) /= ROW_SUPPORT) cycle
            k = bilateral%first(i)
            if (fem%bodies%of_node(bilateral%node(k)) /= b) cycle
            row = 0.0_wp
            do k = bilateral%first(i), bilateral%first(i + 1) - 1
               do mode = 1, n
                  do dof = 1, 2
                     if (fem%bodies%equation(dof, bilateral%node(k)) == 0) cycle
                     row(mode) = row(mode) + bilateral%vector(dof, k) &
                                 *mode_at(body, left(:, mode), fem%mesh%x(:, bilateral%node(k)), dof)
                  end do
               end do
            end do
            all_rows = all_rows + 1.0_wp
            a = a + spread(row, 2, n)*spread(row, 1, n)
         end do
         if (.not. all_rows > 0.0_wp) return
         call eigen_symmetric(a, values, info)
         if (info /= 0) return
         left = matmul(left, a(:, :count(values <= NONE_HELD*all_rows)))
      end associate
   end function motions_left

end module atrito_left_motions
