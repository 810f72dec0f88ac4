!> A list of numbers that grows by doubling.
module atrito_number_list
   use atrito_growth, only: make_room
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: number_list_t, add_number, add_numbers, numbers_of

   !> Numbers in the order in which they were added.
   type :: number_list_t
      integer(ip) :: n = 0                       !< numbers in use
      integer(ip), allocatable :: values(:)      !< (>= n); not allocated: none was added yet
   end type number_list_t

contains

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

end module atrito_number_list
