!> Lists that grow: longer ones take the place of shorter ones, their entries kept.
module atrito_growth
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: grow, resize, make_room

   !> call grow(list, length): makes an allocated list longer; the new entries are undefined.
   !> call grow(list, length, enough): the same; where the memory does not suffice `enough` is false, and the list stays.
   interface grow
      module procedure grow_numbers
      module procedure grow_long_numbers
      module procedure grow_reals
   end interface grow

   !> call resize(list, used, length): another length, the first `used` entries (or columns) kept; one that is not there is made.
   interface resize
      module procedure resize_numbers
      module procedure resize_reals
      module procedure resize_number_columns
      module procedure resize_real_columns
   end interface resize

   !> call make_room(list, used, needed): room for so many entries; a list that is too short doubles, one that is not there is made.
   interface make_room
      module procedure make_room_for_numbers
      module procedure make_room_for_reals
   end interface make_room

   integer(ip), parameter :: FIRST_LENGTH = 16

contains

   pure subroutine grow_numbers(list, length, enough)
      integer(ip), allocatable, intent(inout) :: list(:) !< allocated; stays as it is where `enough` is false
      integer(lp), intent(in) :: length                  !< >= the present one
      logical, intent(out), optional :: enough           !< there was memory for it; left out: the program ends where not
      integer(ip), allocatable :: longer(:)
      integer :: no_memory

      allocate (longer(length), stat=no_memory)
      if (present(enough)) enough = no_memory == 0
      if (present(enough) .and. no_memory /= 0) return
      if (no_memory /= 0) allocate (longer(length))   ! ends the program
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_numbers

   pure subroutine grow_long_numbers(list, length, enough)
      integer(lp), allocatable, intent(inout) :: list(:) !< allocated; stays as it is where `enough` is false
      integer(lp), intent(in) :: length                  !< >= the present one
      logical, intent(out), optional :: enough           !< there was memory for it; left out: the program ends where not
      integer(lp), allocatable :: longer(:)
      integer :: no_memory

      allocate (longer(length), stat=no_memory)
      if (present(enough)) enough = no_memory == 0
      if (present(enough) .and. no_memory /= 0) return
      if (no_memory /= 0) allocate (longer(length))   ! ends the program
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_long_numbers

   pure subroutine grow_reals(list, length, enough)
      real(wp), allocatable, intent(inout) :: list(:) !< allocated; stays as it is where `enough` is false
      integer(lp), intent(in) :: length               !< >= the present one
      logical, intent(out), optional :: enough        !< there was memory for it; left out: the program ends where not
      real(wp), allocatable :: longer(:)
      integer :: no_memory

      allocate (longer(length), stat=no_memory)
      if (present(enough)) enough = no_memory == 0
      if (present(enough) .and. no_memory /= 0) return
      if (no_memory /= 0) allocate (longer(length))   ! ends the program
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_reals

   pure subroutine resize_numbers(list, used, length)
      integer(ip), allocatable, intent(inout) :: list(:) !< not allocated: it is made
      integer(ip), intent(in) :: used, length            !< entries that are kept, <= length; the new length
      integer(ip), allocatable :: other(:)

      allocate (other(length))
      if (allocated(list)) other(:used) = list(:used)
      call move_alloc(other, list)
   end subroutine resize_numbers

   pure subroutine resize_number_columns(list, used, length)
      integer(ip), allocatable, intent(inout) :: list(:, :)    !< allocated: it says how long a column is
      integer(ip), intent(in) :: used, length                  !< columns that are kept, <= length; the new number of columns
      integer(ip), allocatable :: other(:, :)

      allocate (other(size(list, 1), length))
      other(:, :used) = list(:, :used)
      call move_alloc(other, list)
   end subroutine resize_number_columns

   pure subroutine make_room_for_numbers(list, used, needed)
      integer(ip), allocatable, intent(inout) :: list(:) !< not allocated: it is made
      integer(ip), intent(in) :: used, needed            !< entries that are kept; those that there must be room for

      if (.not. allocated(list)) allocate (list(max(needed, FIRST_LENGTH)))
      if (needed > size(list)) call resize(list, used, max(needed, 2*size(list, kind=ip)))
   end subroutine make_room_for_numbers

   pure subroutine resize_reals(list, used, length)
      real(wp), allocatable, intent(inout) :: list(:) !< not allocated: it is made
      integer(ip), intent(in) :: used, length         !< entries that are kept, <= length; the new length
      real(wp), allocatable :: other(:)

      allocate (other(length))
      if (allocated(list)) other(:used) = list(:used)
      call move_alloc(other, list)
   end subroutine resize_reals

   pure subroutine resize_real_columns(list, used, length)
      real(wp), allocatable, intent(inout) :: list(:, :)    !< allocated: it says how long a column is
      integer(ip), intent(in) :: used, length               !< columns that are kept, <= length; the new number of columns
      real(wp), allocatable :: other(:, :)

      allocate (other(size(list, 1), length))
      other(:, :used) = list(:, :used)
      call move_alloc(other, list)
   end subroutine resize_real_columns

   pure subroutine make_room_for_reals(list, used, needed)
      real(wp), allocatable, intent(inout) :: list(:) !< not allocated: it is made
      integer(ip), intent(in) :: used, needed         !< entries that are kept; those that there must be room for

      if (.not. allocated(list)) allocate (list(max(needed, FIRST_LENGTH)))
      if (needed > size(list)) call resize(list, used, max(needed, 2*size(list, kind=ip)))
   end subroutine make_room_for_reals

end module atrito_growth
