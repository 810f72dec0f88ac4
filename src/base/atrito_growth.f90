!> Lists that grow: longer ones take the place of shorter ones, their entries kept.
module atrito_growth
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: grow

   !> call grow(list, length): makes an allocated list longer; the new entries are undefined.
   !> call grow(list, length, enough): the same; where the memory does not suffice `enough` is false, and the list stays.
   interface grow
      module procedure grow_numbers
      module procedure grow_long_numbers
      module procedure grow_reals
   end interface grow

contains

   pure subroutine grow_numbers(list, length, enough)
      integer(ip), allocatable, intent(inout) :: list(:)
      integer(lp), intent(in) :: length          !< >= the present one
      logical, intent(out), optional :: enough
      integer(ip), allocatable :: longer(:)
      integer :: no_memory

      if (present(enough)) then
         allocate (longer(length), stat=no_memory)
         enough = no_memory == 0
         if (.not. enough) return
      else
         allocate (longer(length))
      end if
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_numbers

   pure subroutine grow_long_numbers(list, length, enough)
      integer(lp), allocatable, intent(inout) :: list(:)
      integer(lp), intent(in) :: length          !< >= the present one
      logical, intent(out), optional :: enough
      integer(lp), allocatable :: longer(:)
      integer :: no_memory

      if (present(enough)) then
         allocate (longer(length), stat=no_memory)
         enough = no_memory == 0
         if (.not. enough) return
      else
         allocate (longer(length))
      end if
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_long_numbers

   pure subroutine grow_reals(list, length, enough)
      real(wp), allocatable, intent(inout) :: list(:)
      integer(lp), intent(in) :: length          !< >= the present one
      logical, intent(out), optional :: enough
      real(wp), allocatable :: longer(:)
      integer :: no_memory

      if (present(enough)) then
         allocate (longer(length), stat=no_memory)
         enough = no_memory == 0
         if (.not. enough) return
      else
         allocate (longer(length))
      end if
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_reals

end module atrito_growth
