!> Bounds of the potential energy of the exact solution, contact and friction included (docs/theory/proof.md):
!>
!>     F(v) = |C eps(v)|^2/2 - f(v) + int psi_n(g) + psi_t(r),
!>
!> psi_n = max(g, 0)^2/(2 delta), psi_t = r^2/(2 c) up to the slip c tau and tau |r| - c tau^2/2 beyond, tau the friction bound
!> of the run, c = eps/tau or 1/k. The exact solution has the least F, so F(u_h) is not less, if sides do not overlap or have delta.
!> With a stress s^ in equilibrium with p^, t^, and psi* the conjugates,
!>
!>     F(u) >= |C eps(u_h)|^2/2 - f(u_h) - |s^ - C eps(u_h)|^2/2 - int psi_n*(p^) - p^ g + psi_t*(t^) - t^ r.       (1)
module atrito_potential_bounds
   use atrito_contact_segments, only: between, overlap_at, segment_t, slip_at
   use atrito_kinds, only: ip, wp
   use atrito_law_lack, only: add_zeros
   use atrito_sorting, only: order_key, sorted_places
   implicit none (type, external)
   private
   public :: bound_potential

   !> Three Gauss points on [0,1].
   real(wp), parameter :: GAUSS_PLACES(3) = 0.5_wp + 0.38729833462074168852_wp*[real(wp) :: -1, 0, 1]
   real(wp), parameter :: GAUSS_WEIGHTS(3) = [real(wp) :: 5, 8, 5]/18

contains

   !> least and most [F L]; overlaps: sides without delta overlap, and there is no upper bound.
   subroutine bound_potential(segments, u, work, energy, difference, least, most, overlaps)
      type(segment_t), intent(in) :: segments(:)    !< with tractions that the laws allow
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: work                  !< f(u_h) [F L]
      real(wp), intent(in) :: energy, difference    !< |C eps(u_h)|^2, |s^ - C eps(u_h)|^2 [F L]
      real(wp), intent(out) :: least, most
      logical, intent(out) :: overlaps
      real(wp), parameter :: NONE = 1.0e-10_wp      !< of the largest displacement: an overlap that is round-off
      real(wp) :: potential, conjugate
      integer(ip) :: i

      least = 0.5_wp*energy - work
      most = least
      least = least - 0.5_wp*difference
      overlaps = .false.
      do i = 1, size(segments, kind=ip)
         call sum_segment(segments(i), u, NONE*maxval(abs(u)), potential, conjugate, overlaps)
         least = least - conjugate
         most = most + potential
      end do
   end subroutine bound_potential

   !> int psi_n + psi_t, and int psi_n* - p g + psi_t* - t r, of a segment, cut where a law changes its form.
   subroutine sum_segment(segment, u, none, potential, conjugate, overlaps)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)
      real(wp), intent(in) :: none                  !< [L]
      real(wp), intent(out) :: potential, conjugate !< [F L]
      logical, intent(inout) :: overlaps
      real(wp) :: cuts(8), places(3), g(3), r(3), full(3), at, weight
      integer :: k, l, n

      places = [0.0_wp, 0.5_wp, 1.0_wp]
      do k = 1, 3
         g(k) = overlap_at(segment, u, places(k))
         r(k) = slip_at(segment, u, places(k))
         full(k) = segment%eps + segment%compliance*between(segment%tau, places(k))
      end do
      n = 2
      cuts(:2) = [0.0_wp, 1.0_wp]
      call add_zeros(g, n, cuts)
      call add_zeros(r - full, n, cuts)
      call add_zeros(r + full, n, cuts)
      cuts(:n) = cuts(sorted_places(order_key(cuts(:n))))
      potential = 0.0_wp
      conjugate = 0.0_wp
      do k = 1, n - 1
         do l = 1, 3
            at = cuts(k) + (cuts(k + 1) - cuts(k))*GAUSS_PLACES(l)
            weight = (cuts(k + 1) - cuts(k))*GAUSS_WEIGHTS(l)*segment%length*segment%thickness
            call add_normal()
            if (maxval(segment%tau) > 0.0_wp) call add_tangential()
         end do
      end do

   contains

      subroutine add_normal()
         real(wp) :: g_here, p

         g_here = overlap_at(segment, u, at)
         p = between(segment%p, at)
         conjugate = conjugate + weight*(0.5_wp*segment%delta*p**2 - p*g_here)
         if (segment%delta > 0.0_wp) then
            potential = potential + weight*max(g_here, 0.0_wp)**2/(2*segment%delta)
         else
            overlaps = overlaps .or. g_here > none
         end if
      end subroutine add_normal

      !> Of eps t^2/(2 tau) what is not less: with 1/tau linear between the ends, or eps |t|/2 where tau ends.
      subroutine add_tangential()
         real(wp) :: slip, t, tau, slip_of_full

         slip = slip_at(segment, u, at)
         t = between(segment%t, at)
         tau = between(segment%tau, at)
         slip_of_full = segment%eps + segment%compliance*tau
         if (abs(slip) < slip_of_full) then
            potential = potential + weight*0.5_wp*tau*slip**2/slip_of_full
         else
            potential = potential + weight*tau*(abs(slip) - 0.5_wp*slip_of_full)
         end if
         conjugate = conjugate + weight*(0.5_wp*segment%compliance*t**2 - t*slip)
         if (.not. segment%eps > 0.0_wp) return
         if (minval(segment%tau) > 0.0_wp) then
            conjugate = conjugate + weight*0.5_wp*segment%eps*between(1/segment%tau, at)*t**2
         else
            conjugate = conjugate + weight*0.5_wp*segment%eps*abs(t)
         end if
      end subroutine add_tangential

   end subroutine sum_segment

end module atrito_potential_bounds
