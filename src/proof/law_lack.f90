!> The laws of contact as the bound of the error sees them: by how much tractions p^, t^ and displacements together fail to meet
!> them.
!>
!> With y = g - delta p^ along the normal, g = u_n - s the overlap, and y = r - c t^/tau along T, r the slip and c that of full
!> friction, rho is the most that other tractions could work on y (docs/theory/proof.md),
!>
!>     rho_n(y) = max (q y - delta q^2)      over q = p - p^ >= -p^,
!>     rho_t(y) = max (q y - (c/tau) q^2)    over q = t - t^,  |t| <= tau.                                            (1)
!>
!> It is never negative, and 0 where the law is met. Without delta, y <= 0 is a condition.
module atrito_law_lack
   use atrito_contact_segments, only: between, overlap_at, segment_t, slip_at
   use atrito_kinds, only: ip, wp
   use atrito_sorting, only: order_key, sorted_places
   implicit none (type, external)
   private
   public :: law_t, laws_at, traction_of_law, balanced_jump, lack_of_part, axis_of, add_zeros, NO_LIMIT

   !> The law of contact for the traction in one direction, at a place or in the mean round it.
   type :: law_t
      real(wp) :: y = 0.0_wp                        !< g - delta p^ or r - c t^/tau [L]
      real(wp) :: compliance = 0.0_wp               !< 2 delta or 2 c/tau [L^3/F]
      real(wp) :: least = 0.0_wp, most = 0.0_wp     !< of q [F/L^2]
   end type law_t

   real(wp), parameter :: NO_LIMIT = huge(1.0_wp)
   !> Three Gauss points on [0,1].
   real(wp), parameter :: GAUSS_PLACES(3) = 0.5_wp + 0.38729833462074168852_wp*[real(wp) :: -1, 0, 1]
   real(wp), parameter :: GAUSS_WEIGHTS(3) = [real(wp) :: 5, 8, 5]/18

contains

   !> The laws along the normal (1) and along T (2), at a place of a segment; w moves the sides apart there.
   pure function laws_at(segment, u, t, jump) result(law)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)
      real(wp), intent(in) :: t                     !< 0 to 1 along the segment
      real(wp), intent(in) :: jump(2)               !< w_n, w_T [L]
      type(law_t) :: law(2)
      real(wp) :: full

      associate (p => between(segment%p, t), shear => between(segment%t, t), tau => between(segment%tau, t))
         law(1) = law_t(y=overlap_at(segment, u, t) - segment%delta*p - jump(1), compliance=2*segment%delta, &
                        least=-p, most=NO_LIMIT)
         law(2)%y = slip_at(segment, u, t) - jump(2)
         if (.not. tau > 0.0_wp) return
         full = segment%eps/tau + segment%compliance
         law(2) = law_t(y=law(2)%y - full*shear, compliance=2*full, least=-tau - shear, most=tau - shear)
      end associate
   end function laws_at

   !> The most that other tractions could work on y.
   pure real(wp) function rho(law)
      type(law_t), intent(in) :: law
      real(wp) :: q

      if (law%compliance > 0.0_wp) then
         q = min(max(law%y/law%compliance, law%least), law%most)
      else
         q = merge(law%least, law%most, law%y < 0.0_wp)
         if (.not. q < NO_LIMIT) q = 0.0_wp         ! sides that overlap by round-off
      end if
      rho = q*(law%y - 0.5_wp*law%compliance*q)
   end function rho

   !> q of a law at a place that w moves apart by a jump.
   pure real(wp) function traction_of_law(law, jump) result(q)
      type(law_t), intent(in) :: law
      real(wp), intent(in) :: jump
      real(wp), parameter :: VERY_LARGE = sqrt(huge(1.0_wp))

      associate (y => law%y - jump)
         if (law%compliance > 0.0_wp) then
            q = min(max(y/law%compliance, law%least), law%most)
         else if (y > 0.0_wp) then
            q = min(law%most, VERY_LARGE)
         else
            q = merge(law%least, 0.0_wp, y < 0.0_wp)
         end if
      end associate
   end function traction_of_law

   !> x where k x^2/2 - force x + weight rho(y - jump - x) is least.
   pure real(wp) function balanced_jump(law, weight, k, force, jump) result(x)
      type(law_t), intent(in) :: law
      real(wp), intent(in) :: weight, k, force, jump
      real(wp) :: q

      associate (y => law%y - jump, c => law%compliance)
         x = (force*c + weight*y)/(k*c + weight)
         q = (k*x - force)/weight
         if (q < law%least) x = (force + weight*law%least)/k
         if (q > law%most) x = (force + weight*law%most)/k
      end associate
   end function balanced_jump

   !> The normal (1), T (2).
   pure function axis_of(segment, d) result(axis)
      type(segment_t), intent(in) :: segment
      integer(ip), intent(in) :: d
      real(wp) :: axis(2)

      axis = segment%normal
      if (d == 2) axis = [-segment%normal(2), segment%normal(1)]
   end function axis_of

   !> 2 int rho of a part of a segment, w being given at its ends: y has degree 2 at the most, and the part is cut where it is 0 and
   !> where q reaches its limits.
   subroutine lack_of_part(segment, u, ends, jump, none, lack, overlaps)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)
      real(wp), intent(in) :: ends(2)
      real(wp), intent(in) :: jump(2, 2)            !< (normal and T, ends) [L]
      real(wp), intent(in) :: none                  !< overlaps that are round-off [L]
      real(wp), intent(out) :: lack(2)              !< of the normal law, of friction [F L]
      logical, intent(out) :: overlaps              !< what the law does not allow
      type(law_t) :: law(2)
      real(wp) :: cuts(8), t, y(3), low(3), high(3), most, scale
      integer :: d, i, k, n

      lack = 0.0_wp
      most = -NO_LIMIT
      do d = 1, 2
         do i = 1, 3
            t = 0.5_wp*(i - 1)
            law = laws_here(t)
            scale = 1.0_wp
            if (d == 2 .and. segment%eps > 0.0_wp) scale = between(segment%tau, between(ends, t)) ! no fractions
            y(i) = law(d)%y
            low(i) = scale*(law(d)%y - law(d)%compliance*law(d)%least)
            high(i) = 0.0_wp
            if (d == 2) high(i) = scale*(law(d)%y - law(d)%compliance*law(d)%most)
         end do
         n = 2
         cuts(:2) = [0.0_wp, 1.0_wp]
         call add_zeros(y, n, cuts)
         call add_zeros(low, n, cuts)
         call add_zeros(high, n, cuts)
         cuts(:n) = cuts(sorted_places(order_key(cuts(:n))))
         do k = 1, n - 1
            do i = 1, 3
               law = laws_here(cuts(k) + (cuts(k + 1) - cuts(k))*GAUSS_PLACES(i))
               lack(d) = lack(d) + (cuts(k + 1) - cuts(k))*GAUSS_WEIGHTS(i)*rho(law(d))
               if (d == 1) most = max(most, law(1)%y)
            end do
         end do
         if (d == 1) most = max(most, y(1), y(3))
      end do
      lack = lack*2*segment%length*segment%thickness*(ends(2) - ends(1))
      overlaps = .not. segment%delta > 0.0_wp .and. .not. most <= none

   contains

      function laws_here(t) result(laws)
         real(wp), intent(in) :: t
         type(law_t) :: laws(2)

         laws = laws_at(segment, u, between(ends, t), (1 - t)*jump(:, 1) + t*jump(:, 2))
      end function laws_here

   end subroutine lack_of_part

   !> Adds the zeros within [0,1] of a polynomial, values(2) in the middle: a t^2 + b t + c.
   pure subroutine add_zeros(values, n, cuts)
      real(wp), intent(in) :: values(3)
      integer, intent(inout) :: n
      real(wp), intent(inout) :: cuts(:)
      real(wp) :: a, b, root, zeros(2)
      integer :: i

      a = 2*values(1) - 4*values(2) + 2*values(3)
      b = -3*values(1) + 4*values(2) - values(3)
      root = b**2 - 4*a*values(1)
      if (root < 0.0_wp .or. all(values == 0.0_wp)) return
      root = -0.5_wp*(b + sign(sqrt(root), b))
      zeros = -1.0_wp
      if (abs(values(1)) < abs(root)) zeros(1) = values(1)/root
      if (abs(root) < abs(a)) zeros(2) = root/a
      do i = 1, 2
         if (.not. (zeros(i) > 0.0_wp .and. zeros(i) < 1.0_wp)) cycle
         n = n + 1
         cuts(n) = zeros(i)
      end do
   end subroutine add_zeros

end module atrito_law_lack
