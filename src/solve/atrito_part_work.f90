!> What a part of a body is predicted to take of its rank: nothing that depends on the machine.
!>
!> Nested dissection needs some n^(3/2) operations for n unknowns, and n w where they lie in a strip w of them wide (George, SIAM
!> J. Numer. Anal. 10 (1973) 345-363). Each of k unknowns that are kept goes through the fronts of what lies beside it. So
!>
!>     work = n (A min(sqrt(n), w) + B k + C)
!>
!> with C for what grows with the elements alone: ordering, assembling, pages of memory. A, B and C were fitted to counted
!> operations and times of parts of 2e5 to 5e5 unknowns, squares and rectangles, which they tell to within a sixth
!> (docs/developer/solvers.md).
module atrito_part_work
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: body_work_t, work_of_body, work_of_share, share_of_work

   !> What the work of a body and of its parts depends on.
   type :: body_work_t
      real(wp) :: n = 0.0_wp                     !< unknowns
      real(wp) :: width = 0.0_wp                 !< of them, across the body
      real(wp) :: n_kept = 0.0_wp                !< those that are kept: in contact
   end type body_work_t

   real(wp), parameter :: A = 60.0_wp, B = 17.0_wp, C = 2.3e4_wp
   !> Unknowns of a cut over those of a straight one.
   real(wp), parameter :: CUT = 1.2_wp
   !> Halvings of an interval that give a share to round-off.
   integer, parameter :: HALVINGS = 50

contains

   !> Of the whole body, in operations.
   elemental real(wp) function work_of_body(body) result(work)
      type(body_work_t), intent(in) :: body

      work = work_of_share(body, 1.0_wp, 0_ip)
   end function work_of_body

   !> Of a part with this share of the unknowns and as many sides that are cuts. It grows with both.
   elemental real(wp) function work_of_share(body, share, n_cuts) result(work)
      type(body_work_t), intent(in) :: body
      real(wp), intent(in) :: share              !< 0..1
      integer(ip), intent(in) :: n_cuts
      real(wp) :: n, n_kept

      n = share*body%n
      n_kept = share*body%n_kept + CUT*body%width*real(n_cuts, wp)
      work = n*(A*min(sqrt(n), body%width) + B*n_kept + C)
   end function work_of_share

   !> The share of a part that takes so much work; 1: more than the whole body with such cuts.
   elemental real(wp) function share_of_work(body, work, n_cuts) result(share)
      type(body_work_t), intent(in) :: body
      real(wp), intent(in) :: work
      integer(ip), intent(in) :: n_cuts
      real(wp) :: low, high
      integer :: i

      low = 0.0_wp
      high = 1.0_wp
      do i = 1, HALVINGS
         share = 0.5_wp*(low + high)
         if (work_of_share(body, share, n_cuts) > work) then
            high = share
         else
            low = share
         end if
      end do
      share = high
   end function share_of_work

end module atrito_part_work
