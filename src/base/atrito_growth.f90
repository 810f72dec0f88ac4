!> Lists that grow: longer ones take the place of shorter ones, their entries kept.
module atrito_growth
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: grow

   !> call grow(list, length): makes an allocated list longer; the new entries are undefined.
   interface grow
      module procedure grow_numbers
      module procedure grow_long_numbers
      module procedure grow_reals
   end interface grow

contains

   pure subroutine grow_numbers(list, length)
      integer(ip), allocatable, intent(inout) :: list(:)
      integer(lp), intent(in) :: length          !< >= the present one
      integer(ip), allocatable :: longer(:)

      allocate (longer(length))
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_numbers

   pure subroutine grow_long_numbers(list, length)
      integer(lp), allocatable, intent(inout) :: list(:)
      integer(lp), intent(in) :: length          !< >= the present one
      integer(lp), allocatable :: longer(:)

      allocate (longer(length))
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_long_numbers

   pure subroutine grow_reals(list, length)
      real(wp), allocatable, intent(inout) :: list(:)
      integer(lp), intent(in) :: length          !< >= the present one
      real(wp), allocatable :: longer(:)

      allocate (longer(length))
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_reals

end module atrito_growth
