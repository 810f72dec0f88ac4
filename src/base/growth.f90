!> Lists and texts that grow: longer ones take the place of shorter ones, their entries kept.
module atrito_growth
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: grow, resize, make_room, number_list_t, add_number, add_numbers, numbers_of, growing_text_t, append_text, take_text

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

   integer(ip), parameter :: FIRST_LENGTH = 16, FIRST_LETTERS = 256

   !> Numbers in the order in which they were added.
   type :: number_list_t
      integer(ip) :: n = 0                       !< numbers in use
      integer(ip), allocatable :: values(:)      !< (>= n); not allocated: none was added yet
   end type number_list_t

   !> A text that grows at its end: `text = text//more` copies all of it each time, which a text of a million pieces does not bear.
   type :: growing_text_t
      integer(ip) :: n = 0                              !< characters so far
      character(len=:), allocatable :: letters          !< those up to n are in use; not allocated: there is no text
   end type growing_text_t

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

   !> Adds a number at the end.
   pure subroutine add_number(list, value)
      type(number_list_t), intent(inout) :: list !< becomes longer by one
      integer(ip), intent(in) :: value           !< it may be there already

      call make_room(list%values, list%n, list%n + 1_ip)
      list%n = list%n + 1
      list%values(list%n) = value
   end subroutine add_number

   !> Adds numbers at the end, in their order.
   pure subroutine add_numbers(list, values)
      type(number_list_t), intent(inout) :: list !< becomes longer by size(values)
      integer(ip), intent(in) :: values(:)       !< they may be there already

      call make_room(list%values, list%n, list%n + size(values, kind=ip))
      list%values(list%n + 1:list%n + size(values)) = values
      list%n = list%n + size(values, kind=ip)
   end subroutine add_numbers

   !> The numbers, without the room kept for growing.
   pure function numbers_of(list) result(values)
      type(number_list_t), intent(in) :: list    !< may be empty
      integer(ip), allocatable :: values(:)

      if (allocated(list%values)) then
         values = list%values(:list%n)
      else
         allocate (values(0))
      end if
   end function numbers_of

   !> Puts characters behind those that are there; where there is no room, it doubles.
   pure subroutine append_text(text, more)
      type(growing_text_t), intent(inout) :: text !< gets longer
      character(len=*), intent(in) :: more        !< may be empty
      character(len=:), allocatable :: longer
      integer(ip) :: needed

      needed = text%n + len(more, kind=ip)
      if (.not. allocated(text%letters)) allocate (character(len=max(needed, FIRST_LETTERS)) :: text%letters)
      if (needed > len(text%letters)) then
         allocate (character(len=max(needed, 2*len(text%letters))) :: longer)
         longer(:text%n) = text%letters(:text%n)
         call move_alloc(longer, text%letters)
      end if
      text%letters(text%n + 1:needed) = more
      text%n = needed
   end subroutine append_text

   !> Gives the text away; what is left is an empty one.
   pure subroutine take_text(text, whole)
      type(growing_text_t), intent(inout) :: text         !< is empty afterwards
      character(len=:), allocatable, intent(out) :: whole !< all letters; '' of an empty text

      whole = ''
      if (text%n > 0) whole = text%letters(:text%n)
      text = growing_text_t()
   end subroutine take_text

end module atrito_growth
