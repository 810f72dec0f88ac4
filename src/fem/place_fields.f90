!> What is computed from displacements, stresses and strains at one place: principal stresses, components along other directions.
module atrito_place_fields
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: element_coordinates, mesh_t
   use atrito_element_table, only: SHAPES
   use atrito_plane_state, only: von_mises
   use atrito_shape_functions, only: shape_gradients
   implicit none (type, external)
   private
   public :: place_values_t, place_field, along_direction, principal_stresses, nodal_strains
   public :: PLACE_FIELDS, FIRST_STRESS, FIRST_STRAIN, IS_POLAR

   !> What is known of a place.
   type :: place_values_t
      real(wp) :: u(2) = 0.0_wp                       !< [L]
      real(wp) :: s(4) = 0.0_wp                       !< s11 s22 s33 s12 [F/L^2]
      real(wp) :: e(3) = 0.0_wp                       !< e11 e22 and e12 = du1/dy + du2/dx [-]
      real(wp) :: arm(2) = 0.0_wp                     !< from the centre of polar components [L]
   end type place_values_t

   !> The fields by name: displacements, stresses, strains.
   character(len=6), parameter :: PLACE_FIELDS(19) = ['u1    ', 'u2    ', 'u     ', 'u_r   ', 'u_t   ', 's11   ', 's22   ', &
                                                      's33   ', 's12   ', 'mises ', 's1    ', 's2    ', 'tresca', 's_rr  ', &
                                                      's_tt  ', 's_rt  ', 'e11   ', 'e22   ', 'e12   ']
   integer, parameter :: FIRST_STRESS = 6, FIRST_STRAIN = 17
   integer, private :: i
   !> Those that ask for a centre.
   logical, parameter :: IS_POLAR(size(PLACE_FIELDS)) = [(index(PLACE_FIELDS(i), '_') > 0, i=1, size(PLACE_FIELDS))]

contains

   !> A field at a place. Polar components at their centre are nan.
   pure real(wp) function place_field(field, at) result(value)
      integer, intent(in) :: field                    !< place in PLACE_FIELDS
      type(place_values_t), intent(in) :: at          !< displacements, stresses and strains there
      real(wp) :: s(3)

      select case (PLACE_FIELDS(field))
      case ('u1', 'u2')
         value = at%u(field)
      case ('u')
         value = norm2(at%u)
      case ('s11', 's22', 's33', 's12')
         value = at%s(field - FIRST_STRESS + 1)
      case ('mises')
         value = von_mises([at%s(1), at%s(2), at%s(4)], at%s(3))
      case ('s1', 's2')
         s(:2) = principal_stresses(at%s)
         value = s(merge(1, 2, PLACE_FIELDS(field) == 's1'))
      case ('tresca')
         s = [principal_stresses(at%s), at%s(3)]
         value = maxval(s) - minval(s)
      case ('e11', 'e22', 'e12')
         value = at%e(field - FIRST_STRAIN + 1)
      case default
         value = ieee_value(1.0_wp, ieee_quiet_nan)
         if (any(abs(at%arm) > 0.0_wp)) value = polar_field(PLACE_FIELDS(field), at)
      end select
   end function place_field

   !> u_r, u_t, s_rr, s_tt, s_rt.
   pure real(wp) function polar_field(name, at) result(value)
      character(len=*), intent(in) :: name
      type(place_values_t), intent(in) :: at
      real(wp) :: v(5)
      character(len=4), parameter :: NAMES(5) = ['u_r ', 'u_t ', 's_rr', 's_tt', 's_rt']

      v = along_direction(at, at%arm/norm2(at%arm))
      value = v(findloc(NAMES == name, .true., dim=1))
   end function polar_field

   !> Displacement along a direction and along that turned by +90 degrees; normal stresses along both, and the shear stress between.
   pure function along_direction(at, n) result(v)
      type(place_values_t), intent(in) :: at          !< displacements and stresses are read
      real(wp), intent(in) :: n(2)                    !< unit vector
      real(wp) :: v(5)

      v(1) = dot_product(n, at%u)
      v(2) = n(1)*at%u(2) - n(2)*at%u(1)
      associate (s11 => at%s(1), s22 => at%s(2), s12 => at%s(4))
         v(3) = n(1)**2*s11 + n(2)**2*s22 + 2*n(1)*n(2)*s12
         v(4) = n(2)**2*s11 + n(1)**2*s22 - 2*n(1)*n(2)*s12
         v(5) = n(1)*n(2)*(s22 - s11) + (n(1)**2 - n(2)**2)*s12
      end associate
   end function along_direction

   !> The principal stresses in the plane, the larger one first [F/L^2].
   pure function principal_stresses(s) result(principal)
      real(wp), intent(in) :: s(:)                    !< s11 s22 s33 s12
      real(wp) :: principal(2)

      principal = 0.5_wp*s(1) + 0.5_wp*s(2) + [1, -1]*hypot(0.5_wp*s(1) - 0.5_wp*s(2), s(4))
   end function principal_stresses

   !> Strains e11, e22, e12 = du1/dy + du2/dx at the nodes: the mean over the elements round each; 0 in no element.
   pure subroutine nodal_strains(mesh, u, strain)
      type(mesh_t), intent(in) :: mesh                   !< elements and places of the nodes are read
      real(wp), intent(in) :: u(:, :)                 !< (2, n_nodes) [L]
      real(wp), allocatable, intent(out) :: strain(:, :) !< (3, n_nodes)
      real(wp) :: jacobian(2, 2), inverse(2, 2), slope(2, 2)
      integer(ip) :: elements(mesh%n_nodes), e, k

      allocate (strain(3, mesh%n_nodes), source=0.0_wp)
      elements = 0
      do e = 1, mesh%n_elements
         associate (n => mesh%shape(e), nodes => mesh%nodes(:mesh%shape(e), e))
            do k = 1, n
               associate (dn => shape_gradients(n, SHAPES(n)%place(:, k)))
                  jacobian = matmul(element_coordinates(mesh, e), dn)      ! dx_i/dxi_j
                  inverse = reshape([jacobian(2, 2), -jacobian(2, 1), -jacobian(1, 2), jacobian(1, 1)], [2, 2]) &
                            /(jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1))
                  slope = matmul(matmul(u(:, nodes), dn), inverse)         ! du_i/dx_j
               end associate
               strain(:, nodes(k)) = strain(:, nodes(k)) + [slope(1, 1), slope(2, 2), slope(1, 2) + slope(2, 1)]
               elements(nodes(k)) = elements(nodes(k)) + 1
            end do
         end associate
      end do
      do k = 1, mesh%n_nodes
         if (elements(k) > 1) strain(:, k) = strain(:, k)/elements(k)
      end do
   end subroutine nodal_strains

end module atrito_place_fields
