!> Orthotropic elasticity of three dimensions whose third axis stands across the plane.
!>
!> Stresses and strains are of the components 11, 22, 33 and 12, the strain of the last being 2 e12. Shears across the plane do not
!> meet the others, so G13 and G23 have no part. Compliance S = C^-1.
module atrito_orthotropy
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: SPATIAL, IN_PLANE, ACROSS
   public :: compliance_of_constants, inverse_of, is_positive_definite, turned_stiffness, turned_compliance, without_component

   integer(ip), parameter :: SPATIAL = 4                         !< components
   integer(ip), parameter :: IN_PLANE(3) = [1_ip, 2_ip, 4_ip]    !< places of 11, 22, 12
   integer(ip), parameter :: ACROSS = 3                          !< and of 33

contains

   !> Compliance [L^2/F] of engineering constants: s_ii = 1/E_i, s_ij = -nu_ij/E_i.
   pure function compliance_of_constants(young, poisson, shear) result(s)
      real(wp), intent(in) :: young(3)             !< E1, E2, E3 [F/L^2]
      real(wp), intent(in) :: poisson(3)           !< nu12, nu13, nu23: strain along the second axis by a stress along the first [-]
      real(wp), intent(in) :: shear                !< G12 [F/L^2]
      real(wp) :: s(SPATIAL, SPATIAL)
      integer(ip) :: i

      s = 0.0_wp
      do i = 1, 3
         s(i, i) = 1/young(i)
      end do
      s(1, 2) = -poisson(1)/young(1)
      s(1, 3) = -poisson(2)/young(1)
      s(2, 3) = -poisson(3)/young(2)
      s(2, 1) = s(1, 2)
      s(3, 1) = s(1, 3)
      s(3, 2) = s(2, 3)
      s(4, 4) = 1/shear
   end function compliance_of_constants

   !> Stiffness from compliance along the axes of the material, or the other way round; by the cofactors of 11, 22, 33 over the
   !> roots of the diagonal, whose sizes may be far apart.
   pure function inverse_of(s) result(c)
      real(wp), intent(in) :: s(SPATIAL, SPATIAL)  !< positive definite, along the axes of the material
      real(wp) :: c(SPATIAL, SPATIAL)
      real(wp) :: a(3, 3), root(3), determinant
      integer(ip) :: i, j, i1, i2, j1, j2

      call normalize(s, a, root)
      determinant = determinant_of(a)
      c = 0.0_wp
      do j = 1, 3
         do i = 1, 3
            i1 = 1 + mod(i, 3_ip)
            i2 = 1 + mod(i + 1, 3_ip)
            j1 = 1 + mod(j, 3_ip)
            j2 = 1 + mod(j + 1, 3_ip)
            c(i, j) = (a(i1, j1)*a(i2, j2) - a(i1, j2)*a(i2, j1))/determinant/(root(i)*root(j))
         end do
      end do
      c(4, 4) = 1/s(4, 4)
   end function inverse_of

   !> Whether every strain costs energy.
   pure logical function is_positive_definite(s) result(good)
      real(wp), intent(in) :: s(SPATIAL, SPATIAL)  !< stiffness or compliance along the axes of the material
      real(wp), parameter :: ROUND_OFF = 64*epsilon(1.0_wp)
      real(wp) :: a(3, 3), root(3)

      good = s(1, 1) > 0.0_wp .and. s(2, 2) > 0.0_wp .and. s(3, 3) > 0.0_wp .and. s(4, 4) > 0.0_wp
      if (.not. good) return
      call normalize(s, a, root)
      good = abs(a(1, 2)) < 1.0_wp .and. abs(a(1, 3)) < 1.0_wp .and. abs(a(2, 3)) < 1.0_wp
      if (good) good = determinant_of(a) > ROUND_OFF
   end function is_positive_definite

   !> The block of 11, 22, 33 with 1 on its diagonal.
   pure subroutine normalize(s, a, root)
      real(wp), intent(in) :: s(SPATIAL, SPATIAL)
      real(wp), intent(out) :: a(3, 3), root(3)
      integer(ip) :: i, j

      root = sqrt([s(1, 1), s(2, 2), s(3, 3)])
      do j = 1, 3
         do i = 1, 3
            a(i, j) = s(i, j)/root(i)/root(j)
         end do
         a(j, j) = 1.0_wp
      end do
   end subroutine normalize

   !> Of a symmetric matrix with 1 on its diagonal.
   pure real(wp) function determinant_of(a) result(determinant)
      real(wp), intent(in) :: a(3, 3)

      determinant = 1 - a(1, 2)**2 - a(1, 3)**2 - a(2, 3)**2 + 2*a(1, 2)*a(1, 3)*a(2, 3)
   end function determinant_of

   !> Stiffness along x1, x2 of a material whose first axis is `axis`: T^-1 C T^-T.
   pure function turned_stiffness(c, axis) result(turned)
      real(wp), intent(in) :: c(SPATIAL, SPATIAL)  !< stiffness along the axes of the material [F/L^2]
      real(wp), intent(in) :: axis(2)              !< unit vector
      real(wp) :: turned(SPATIAL, SPATIAL)
      real(wp) :: t(SPATIAL, SPATIAL)

      t = stress_transformation([axis(1), -axis(2)])
      turned = symmetric(matmul(t, matmul(c, transpose(t))))
   end function turned_stiffness

   !> Compliance along x1, x2: T' S T.
   pure function turned_compliance(s, axis) result(turned)
      real(wp), intent(in) :: s(SPATIAL, SPATIAL)  !< compliance along the axes of the material [L^2/F]
      real(wp), intent(in) :: axis(2)              !< unit vector
      real(wp) :: turned(SPATIAL, SPATIAL)
      real(wp) :: t(SPATIAL, SPATIAL)

      t = stress_transformation(axis)
      turned = symmetric(matmul(transpose(t), matmul(s, t)))
   end function turned_compliance

   !> T: stresses along axes of which the first is `axis` from those along x1, x2.
   pure function stress_transformation(axis) result(t)
      real(wp), intent(in) :: axis(2)
      real(wp) :: t(SPATIAL, SPATIAL)

      associate (c => axis(1), s => axis(2))
         t = 0.0_wp
         t(1, :) = [c*c, s*s, 0.0_wp, 2*c*s]
         t(2, :) = [s*s, c*c, 0.0_wp, -2*c*s]
         t(3, 3) = 1.0_wp
         t(4, :) = [-c*s, c*s, 0.0_wp, c*c - s*s]
      end associate
   end function stress_transformation

   pure function symmetric(a)
      real(wp), intent(in) :: a(SPATIAL, SPATIAL)
      real(wp) :: symmetric(SPATIAL, SPATIAL)

      symmetric = 0.5_wp*(a + transpose(a))
   end function symmetric

   !> The matrix of 11, 22, 12 where what belongs to 33 is free to follow: of stiffness where there is no stress s33, of compliance
   !> where there is no strain e33.
   pure function without_component(a) result(b)
      real(wp), intent(in) :: a(SPATIAL, SPATIAL) !< stiffness or compliance
      real(wp) :: b(3, 3)
      integer(ip) :: j

      do j = 1, 3
         b(:, j) = a(IN_PLANE, IN_PLANE(j)) - a(IN_PLANE, ACROSS)*(a(ACROSS, IN_PLANE(j))/a(ACROSS, ACROSS))
      end do
   end function without_component

end module atrito_orthotropy
