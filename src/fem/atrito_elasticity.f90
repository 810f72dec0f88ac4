!> Linear isotropic elasticity in the plane. Strains are e11, e22, 2 e12.
module atrito_elasticity
   use atrito_element_table, only: STATES, can_average
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: elastic_t, elasticity_matrix, compliance_matrix, stress_33, von_mises, has_mean_dilatation
   public :: FORMULATION_STANDARD, FORMULATION_BBAR

   integer(ip), parameter :: FORMULATION_STANDARD = 1   !< the strains of the displacements
   integer(ip), parameter :: FORMULATION_BBAR = 2       !< with the element's mean dilatation, where has_mean_dilatation

   !> What an element needs to know of its section.
   type :: elastic_t
      real(wp) :: young = 1.0_wp           !< E [F/L^2]
      real(wp) :: poisson = 0.0_wp         !< mu
      real(wp) :: thickness = 1.0_wp       !< [L]
      real(wp) :: density = 0.0_wp
      integer(ip) :: formulation = FORMULATION_STANDARD
   end type elastic_t

contains

   !> Stress = matrix * strain for s11, s22, s12 [F/L^2].
   pure function elasticity_matrix(section, state) result(d)
      type(elastic_t), intent(in) :: section
      integer(ip), intent(in) :: state     !< place in STATES
      real(wp) :: d(3, 3)
      real(wp) :: lambda, shear

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

   !> The inverse of the elasticity matrix [L^2/F]; it stays finite at Poisson's ratio 1/2.
   pure function compliance_matrix(section, state) result(c)
      type(elastic_t), intent(in) :: section
      integer(ip), intent(in) :: state     !< place in STATES
      real(wp) :: c(3, 3)

      c = 0.0_wp
      associate (young => section%young, mu => section%poisson)
         if (STATES(state)%is_thin) then
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

   !> Whether the strains of an element have one dilatation, the mean of the element (B-bar).
   pure logical function has_mean_dilatation(section, state, n_nodes)
      type(elastic_t), intent(in) :: section
      integer(ip), intent(in) :: state     !< place in STATES
      integer(ip), intent(in) :: n_nodes   !< of the element

      has_mean_dilatation = section%formulation == FORMULATION_BBAR .and. can_average(n_nodes, state)
   end function has_mean_dilatation

   !> The stress across the plane.
   pure real(wp) function stress_33(section, state, s)
      type(elastic_t), intent(in) :: section
      integer(ip), intent(in) :: state
      real(wp), intent(in) :: s(3)         !< s11, s22, s12 [F/L^2]

      stress_33 = section%poisson*(s(1) + s(2))
      if (STATES(state)%is_thin) stress_33 = 0.0_wp
   end function stress_33

   !> Von Mises' equivalent stress.
   pure real(wp) function von_mises(s, s33)
      real(wp), intent(in) :: s(3), s33    !< s11, s22, s12 and s33 [F/L^2]
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

end module atrito_elasticity
