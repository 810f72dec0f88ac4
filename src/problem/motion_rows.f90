!> The rigid motions of all bodies seen from the contact line: G by rows, and what the loads work on the motions.
!>
!> Equilibrium of the bodies is G' q = h (docs/theory/formulation.md, section 4), q being the contact forces in the order of the
!> unknowns of the line. A row touches the motions of two bodies at most, so G is kept by its entries.
!>
!>     motion_rates     G v:  how fast the motion v opens the points and lets them slip
!>     motion_forces    G' q: the work of the contact forces on each motion
!>
!> With `sizes` the terms of the sums are taken without their signs: a sum that is less than some EPS_MACH of that is round-off.
module atrito_motion_rows
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: motion_rows_t, motion_rates, motion_forces

   type :: motion_rows_t
      integer(ip) :: m = 0                       !< unknown contact forces
      integer(ip) :: k = 0                       !< rigid motions
      integer(ip), allocatable :: first(:)       !< (m + 1) entries of row i: first(i) : first(i+1) - 1
      integer(ip), allocatable :: motion(:)      !< of each entry, 1 .. k
      real(wp), allocatable :: value(:)          !< of each entry, dimensionless
      integer(ip), allocatable :: body(:)        !< (k) whose motion it is; the motions of a body follow each other
      real(wp), allocatable :: work(:)           !< (k) h: of the loads on the motion of amplitude one [F]
      real(wp), allocatable :: work_size(:)      !< (k) the same, of the terms without their signs: what may have cancelled [F]
   end type motion_rows_t

contains

   !> G v; or, with sizes, the sum of the terms without their signs.
   pure function motion_rates(rows, v, sizes) result(rate)
      type(motion_rows_t), intent(in) :: rows
      real(wp), intent(in) :: v(:)               !< (k) [L]
      logical, intent(in) :: sizes
      real(wp) :: rate(rows%m)                   !< [L]
      integer(ip) :: i, e

      rate = 0.0_wp
      do i = 1, rows%m
         do e = rows%first(i), rows%first(i + 1) - 1
            if (sizes) then
               rate(i) = rate(i) + abs(rows%value(e)*v(rows%motion(e)))
            else
               rate(i) = rate(i) + rows%value(e)*v(rows%motion(e))
            end if
         end do
      end do
   end function motion_rates

   !> G' q; or, with sizes, the sum of the terms without their signs.
   pure function motion_forces(rows, q, sizes) result(force)
      type(motion_rows_t), intent(in) :: rows
      real(wp), intent(in) :: q(:)               !< (m) [F]
      logical, intent(in) :: sizes
      real(wp) :: force(rows%k)                  !< [F]
      integer(ip) :: i, e

      force = 0.0_wp
      do i = 1, rows%m
         do e = rows%first(i), rows%first(i + 1) - 1
            associate (f => force(rows%motion(e)))
               if (sizes) then
                  f = f + abs(rows%value(e)*q(i))
               else
                  f = f + rows%value(e)*q(i)
               end if
            end associate
         end do
      end do
   end function motion_forces

end module atrito_motion_rows
