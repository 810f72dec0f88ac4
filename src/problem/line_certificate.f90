!> What has been found of a contact line that its loads do not change: a history keeps it as long as the bodies are factored.
module atrito_line_certificate
   use atrito_kinds, only: ip, wp
   use atrito_results, only: uniqueness_t
   implicit none (type, external)
   private
   public :: line_certificate_t

   type :: line_certificate_t
      type(uniqueness_t) :: known                   !< for every load
      real(wp), allocatable :: way(:)               !< (tangential unknowns) directions of slip, 1 or -1; not allocated: none asked
      real(wp) :: way_up_to_nu = 0.0_wp             !< one solution at most moves that way at every point
      ! The last estimate of the contraction, and of what it was made.
      integer(ip), allocatable :: state(:)
      real(wp), allocatable :: compliance(:)        !< [L/F]
      real(wp) :: contraction = 0.0_wp
   end type line_certificate_t

end module atrito_line_certificate
