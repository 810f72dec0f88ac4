!> The plane states, which all rooms ask: stresses and elasticity, what a point weighs, how a body moves without strain.
!>
!> A state says also how the stiffness of its elements is integrated, since that makes other strains of the same displacements.
!>
!> Strains are e11, e22, 2 e12, of linear elasticity, isotropic or orthotropic; axisymmetric states have the hoop strain
!> u1/x1 besides, whose stress goes by itself (atrito_axisymmetric), so that plane states pay nothing for it. A new state is
!> a row of STATES and a branch in the procedures below; the strains of the shape functions are in strain_points
!> (atrito_point_stress) and integrate_products (atrito_element).
module atrito_plane_state
   use atrito_kinds, only: ip, wp, PI
   use atrito_orthotropy, only: SPATIAL, IN_PLANE, ACROSS, without_component
   implicit none (type, external)
   private
   public :: plane_state_t, STATES, PLANE_STRAIN, PLANE_STRESS, AXISYMMETRIC, PLANE_STRAIN_REDUCED, PLANE_STRESS_REDUCED, &
             AXISYMMETRIC_REDUCED
   public :: IS_REDUCED, IS_TAPERED, FULL_STATE, TAPERED_STATE, PLAIN_STATE, COMPONENTS, STRESS_NAMES
   public :: elastic_t, elasticity_matrix, compliance_matrix, stress_33, thermal_stresses, thermal_modulus_33, von_mises, depth_at
   public :: FORMULATION_STANDARD, FORMULATION_BBAR

   type :: plane_state_t
      character(len=3) :: prefix = ''            !< of the names of its elements
      character(len=12) :: name = ''             !< in words, for listing and messages
      logical :: is_thin = .false.               !< no stress across the plane; else no strain
      real(wp) :: depth(2) = [1.0_wp, 0.0_wp]    !< over the thickness at x1: depth(1) + depth(2) x1 [-, 1/L]
      logical :: moves(3) = .true.               !< rigid motions: translations along 1 and 2, rotation
      logical :: has_hoop = .false.              !< axisymmetric: x1 is a radius, u1/x1 a strain, s33 its stress
      logical :: is_reduced = .false.            !< the stiffness is integrated at the points where stresses are best
      integer(ip) :: full = 0_ip                 !< place of the same state with full integration and a thickness for all nodes
      logical :: is_tapered = .false.            !< the thickness is that of the nodes, interpolated, and depth(2) goes by it
   end type plane_state_t

   integer(ip), parameter :: PLANE_STRAIN = 1, PLANE_STRESS = 2, AXISYMMETRIC = 3, PLANE_STRAIN_REDUCED = 4, &
                             PLANE_STRESS_REDUCED = 5, AXISYMMETRIC_REDUCED = 6
   real(wp), parameter :: BY_NODES(2) = [0.0_wp, 1.0_wp]
   type(plane_state_t), parameter :: STATES(10) = [plane_state_t('CPE', 'plane strain', .false., full=1_ip), &
                                                   plane_state_t('CPS', 'plane stress', .true., full=2_ip), &
                                                   plane_state_t('CAX', 'axisymmetric', .false., [0.0_wp, 2*PI], &
                                                                 [.false., .true., .false.], .true., full=3_ip), &
                                                   plane_state_t('CPE', 'plane strain', .false., is_reduced=.true., full=1_ip), &
                                                   plane_state_t('CPS', 'plane stress', .true., is_reduced=.true., full=2_ip), &
                                                   plane_state_t('CAX', 'axisymmetric', .false., [0.0_wp, 2*PI], &
                                                                 [.false., .true., .false.], .true., .true., 3_ip), &
                                                   plane_state_t('CPE', 'plane strain', .false., BY_NODES, full=1_ip, &
                                                                 is_tapered=.true.), &
                                                   plane_state_t('CPS', 'plane stress', .true., BY_NODES, full=2_ip, &
                                                                 is_tapered=.true.), &
                                                   plane_state_t('CPE', 'plane strain', .false., BY_NODES, is_reduced=.true., &
                                                                 full=1_ip, is_tapered=.true.), &
                                                   plane_state_t('CPS', 'plane stress', .true., BY_NODES, is_reduced=.true., &
                                                                 full=2_ip, is_tapered=.true.)]
   !> The state of an element whose nodes have their own thickness; of a body of revolution its own.
   integer(ip), parameter :: TAPERED_STATE(size(STATES)) = [7_ip, 8_ip, 3_ip, 9_ip, 10_ip, 6_ip, 7_ip, 8_ip, 9_ip, 10_ip]
   !> And the one that its name says.
   integer(ip), parameter :: PLAIN_STATE(size(STATES)) = [1_ip, 2_ip, 3_ip, 4_ip, 5_ip, 6_ip, 1_ip, 2_ip, 4_ip, 5_ip]

   !> A column by itself: STATES(state)%is_reduced would copy the row.
   logical, parameter :: IS_REDUCED(size(STATES)) = STATES%is_reduced
   logical, parameter :: IS_TAPERED(size(STATES)) = STATES%is_tapered
   !> And the same state with full integration.
   integer(ip), parameter :: FULL_STATE(size(STATES)) = STATES%full

   integer(ip), parameter :: COMPONENTS = 3      !< of the stresses that work on strains: s11, s22, s12
   character(len=5), parameter :: STRESS_NAMES(5) = ['s11  ', 's22  ', 's33  ', 's12  ', 'mises'] !< in tables and fields

   integer(ip), parameter :: FORMULATION_STANDARD = 1   !< the strains of the displacements
   integer(ip), parameter :: FORMULATION_BBAR = 2       !< with the element's mean dilatation, where has_mean_dilatation

   !> What an element needs to know of its section.
   type :: elastic_t
      real(wp) :: young = 1.0_wp                        !< E [F/L^2]
      real(wp) :: poisson = 0.0_wp                      !< mu
      real(wp) :: thickness = 1.0_wp                    !< [L]
      real(wp) :: density = 0.0_wp                      !< mass of a unit of volume [F T^2/L^4]
      integer(ip) :: formulation = FORMULATION_STANDARD !< one of FORMULATION_...
      real(wp) :: expansion = 0.0_wp                    !< alpha, strain by a rise of the temperature [1/temperature]
      logical :: is_orthotropic = .false.               !< E and mu have no part in stresses
      real(wp) :: stiffness(SPATIAL, SPATIAL) = 0.0_wp  !< then, of the components 11, 22, 33, 12 [F/L^2] ...
      real(wp) :: compliance(SPATIAL, SPATIAL) = 0.0_wp !< ... and its inverse [L^2/F]
   end type elastic_t

contains

   !> What stands behind a point of the plane, and so what it weighs besides its share of the area or line [L].
   elemental real(wp) function depth_at(state, thickness, x1)
      integer(ip), intent(in) :: state     !< place in STATES
      real(wp), intent(in) :: thickness    !< [L]
      real(wp), intent(in) :: x1           !< of the point [L]; of tapered states the thickness of the nodes there

      depth_at = thickness*(STATES(state)%depth(1) + STATES(state)%depth(2)*x1)
   end function depth_at

   !> Stress = matrix * strain for s11, s22, s12 [F/L^2], without what a hoop strain adds.
   pure function elasticity_matrix(section, state) result(d)
      type(elastic_t), intent(in) :: section !< elastic constants
      integer(ip), intent(in) :: state       !< place in STATES
      real(wp) :: d(COMPONENTS, COMPONENTS)
      real(wp) :: lambda, shear

      if (section%is_orthotropic) then
         d = section%stiffness(IN_PLANE, IN_PLANE)
         if (STATES(state)%is_thin) d = without_component(section%stiffness)
         return
      end if
      associate (young => section%young, mu => section%poisson)
         shear = young/(2*(1 + mu))
         if (STATES(state)%is_thin) then
            lambda = young*mu/((1 + mu)*(1 - mu))
         else
            lambda = young*mu/((1 + mu)*(1 - 2*mu))
         end if
      end associate
      d = 0.0_wp
      d(1:2, 1:2) = lambda
      d(1, 1) = lambda + 2*shear
      d(2, 2) = lambda + 2*shear
      d(3, 3) = shear
   end function elasticity_matrix

   !> The inverse of the elasticity matrix [L^2/F]; it stays finite at Poisson's ratio 1/2. Where s33 is a stress of its own it is
   !> what s11, s22, s12 alone strain, as in plane stress.
   pure function compliance_matrix(section, state) result(c)
      type(elastic_t), intent(in) :: section !< elastic constants
      integer(ip), intent(in) :: state       !< place in STATES
      real(wp) :: c(COMPONENTS, COMPONENTS)

      if (section%is_orthotropic) then
         c = section%compliance(IN_PLANE, IN_PLANE)
         if (.not. (STATES(state)%is_thin .or. STATES(state)%has_hoop)) c = without_component(section%compliance)
         return
      end if
      c = 0.0_wp
      associate (young => section%young, mu => section%poisson)
         if (STATES(state)%is_thin .or. STATES(state)%has_hoop) then
            c(1, 1) = 1/young
            c(1, 2) = -mu/young
         else
            c(1, 1) = (1 + mu)*(1 - mu)/young
            c(1, 2) = -(1 + mu)*mu/young
         end if
         c(3, 3) = 2*(1 + mu)/young
      end associate
      c(2, 2) = c(1, 1)
      c(2, 1) = c(1, 2)
   end function compliance_matrix

   !> The stress across the plane that follows from those in it; where there is a hoop strain it does not.
   pure real(wp) function stress_33(section, state, s)
      type(elastic_t), intent(in) :: section !< elastic constants
      integer(ip), intent(in) :: state       !< place in STATES
      real(wp), intent(in) :: s(COMPONENTS)  !< s11, s22, s12 [F/L^2]

      stress_33 = section%poisson*(s(1) + s(2))
      if (section%is_orthotropic) then
         stress_33 = -dot_product(section%compliance(ACROSS, IN_PLANE), s)/section%compliance(ACROSS, ACROSS)
      end if
      if (STATES(state)%is_thin) stress_33 = 0.0_wp
   end function stress_33

   !> What a unit of thermal strain that cannot happen takes from s11, s22, s12 and s33 [F/L^2]: the sums of the rows of the
   !> elasticity for the normal strains, of isotropic elasticity E/(1 - 2 mu), or E/(1 - mu) where no stress goes across the plane.
   pure function thermal_stresses(section, state) result(b)
      type(elastic_t), intent(in) :: section !< elastic constants
      integer(ip), intent(in) :: state       !< place in STATES
      real(wp) :: b(COMPONENTS + 1)
      real(wp) :: d(COMPONENTS, COMPONENTS)

      if (.not. section%is_orthotropic) then
         b = section%young/(1 - merge(1, 2, STATES(state)%is_thin)*section%poisson)
         b(COMPONENTS) = 0.0_wp
      else if (STATES(state)%is_thin) then
         d = elasticity_matrix(section, state)
         b = [d(:, 1) + d(:, 2), 0.0_wp]
      else
         b = sum(section%stiffness([IN_PLANE, ACROSS], 1:3), dim=2)
      end if
   end function thermal_stresses

   !> What a unit of thermal strain takes from the stress across a plane without strain, beside what it takes by s11, s22 and s12.
   pure real(wp) function thermal_modulus_33(section)
      type(elastic_t), intent(in) :: section !< elastic constants

      thermal_modulus_33 = section%young
      if (section%is_orthotropic) thermal_modulus_33 = 1/section%compliance(ACROSS, ACROSS)
   end function thermal_modulus_33

   !> Von Mises' equivalent stress.
   pure real(wp) function von_mises(s, s33)
      real(wp), intent(in) :: s(COMPONENTS), s33 !< [F/L^2]
      real(wp), parameter :: SMALL = 1.0e-140_wp, LARGE = 1.0e140_wp !< between them squares stay in the range of numbers
      real(wp) :: scale, squares

      scale = max(abs(s(1)), abs(s(2)), abs(s(3)), abs(s33))
      if (scale > SMALL .and. scale < LARGE) then
         squares = 0.5_wp*((s(1) - s(2))**2 + (s(2) - s33)**2 + (s33 - s(1))**2) + 3*s(3)**2
         von_mises = sqrt(squares)
      else if (scale > 0.0_wp) then
         squares = 0.5_wp*(((s(1) - s(2))/scale)**2 + ((s(2) - s33)/scale)**2 + ((s33 - s(1))/scale)**2) + 3*(s(3)/scale)**2
         von_mises = scale*sqrt(squares)
      else
         von_mises = 0.0_wp
      end if
   end function von_mises

end module atrito_plane_state
