!> Exact solutions of plane elasticity without force per volume, against which errors are measured.
!>
!> All are given by Kolosov and Muskhelishvili's potentials phi and psi, with kappa = 3 - 4 mu (plane strain) or
!> (3 - mu)/(1 + mu) (plane stress) and G = E/(2 (1 + mu)):
!>    2 G (u1 + i u2) = kappa phi - z conj(phi') - conj(psi)
!>    s11 + s22 = 4 Re phi',   s22 - s11 + 2 i s12 = 2 (conj(z) phi'' + psi')
!> Ring: Lame's solution, phi = A z/2 and psi = B/z.
module exact_fields
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: elastic_t, FULL_STATE, PLANE_STRESS
   implicit none (type, external)
   private
   public :: field_t, make_field, exact_solution

   !> numbers: of `waves` k, a, b; of `ring` inner radius, outer radius, inside pressure, outside pressure; of `hole` its
   !> radius and the tension; of `rings` inner and
   !> outer radius of the inner ring, of the outer one, pressure on the inner ring (on the outer one times the radii of the joint).
   type :: field_t
      character(len=:), allocatable :: name
      real(wp) :: numbers(5) = 0.0_wp
   end type field_t

contains

   pure function make_field(name, numbers) result(field)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: numbers(5)
      type(field_t) :: field

      field%name = name
      field%numbers = numbers
   end function make_field

   !> Displacements [L] and stresses s11 s22 s12 [F/L^2] at a place.
   pure subroutine exact_solution(field, section, state, middle, x, u, s)
      type(field_t), intent(in) :: field
      type(elastic_t), intent(in) :: section
      integer(ip), intent(in) :: state
      real(wp), intent(in) :: middle(2)            !< of the element: tells the ring
      real(wp), intent(in) :: x(2)                 !< [L]
      real(wp), intent(out) :: u(2), s(3)
      complex(wp) :: phi(0:2), psi(0:1)
      complex(wp) :: z, displacement, difference
      real(wp) :: kappa, shear, mean

      z = cmplx(x(1), x(2), wp)
      select case (field%name)
      case ('waves')
         call waves(field%numbers(1), field%numbers(2), field%numbers(3), z, phi, psi)
      case ('ring')
         call ring(field%numbers(1), field%numbers(2), field%numbers(3), field%numbers(4), z, phi, psi)
      case ('hole')
         call hole(field%numbers(1), field%numbers(2), z, phi, psi)
      case ('rings')
         associate (a => field%numbers)
            if (norm2(middle) < a(2)) then
               call ring(a(1), a(2), 0.0_wp, a(5), z, phi, psi)
            else
               call ring(a(3), a(4), a(5)*a(2)/a(3), 0.0_wp, z, phi, psi)
            end if
         end associate
      case default
         error stop 'exact_fields: no such field'
      end select
      kappa = 3 - 4*section%poisson
      if (FULL_STATE(state) == PLANE_STRESS) kappa = (3 - section%poisson)/(1 + section%poisson)
      shear = section%young/(2*(1 + section%poisson))
      displacement = (kappa*phi(0) - z*conjg(phi(1)) - conjg(psi(0)))/(2*shear)
      u = [real(displacement, wp), aimag(displacement)]
      mean = 2*real(phi(1), wp)
      difference = conjg(z)*phi(2) + psi(1)
      s = [mean - real(difference, wp), mean + real(difference, wp), aimag(difference)]
   end subroutine exact_solution

   !> phi = a exp(k z), psi = b exp(k z).
   pure subroutine waves(k, a, b, z, phi, psi)
      real(wp), intent(in) :: k, a, b
      complex(wp), intent(in) :: z
      complex(wp), intent(out) :: phi(0:2), psi(0:1) !< with derivatives

      phi = a*exp(k*z)*[1.0_wp, k, k**2]
      psi = b*exp(k*z)*[1.0_wp, k]
   end subroutine waves

   !> A plate with a hole under tension along x (Kirsch).
   pure subroutine hole(radius, tension, z, phi, psi)
      real(wp), intent(in) :: radius, tension      !< [L], [F/L^2]
      complex(wp), intent(in) :: z
      complex(wp), intent(out) :: phi(0:2), psi(0:1)
      real(wp) :: a, s

      a = radius**2
      s = 0.25_wp*tension
      phi = [s*(z + 2*a/z), s*(1 - 2*a/z**2), 4*s*a/z**3]
      psi = [-2*s*(z + a/z - a**2/z**3), -2*s*(1 - a/z**2 + 3*a**2/z**4)]
   end subroutine hole

   !> A ring under pressure from inside and outside (positive pushes).
   pure subroutine ring(inner, outer, inside, outside, z, phi, psi)
      real(wp), intent(in) :: inner, outer         !< radii [L]
      real(wp), intent(in) :: inside, outside      !< pressures [F/L^2]
      complex(wp), intent(in) :: z
      complex(wp), intent(out) :: phi(0:2), psi(0:1)
      real(wp) :: a, b

      ! sr = 2 a + b/r^2, st = 2 a - b/r^2
      a = 0.5_wp*(inside*inner**2 - outside*outer**2)/(outer**2 - inner**2)
      b = -(inside - outside)*(inner*outer)**2/(outer**2 - inner**2)
      phi = [a*z, cmplx(a, 0.0_wp, wp), cmplx(0.0_wp, 0.0_wp, wp)]
      psi = [b/z, -b/z**2]
   end subroutine ring

end module exact_fields
