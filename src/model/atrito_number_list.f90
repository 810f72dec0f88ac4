!> A list of numbers that grows by doubling.
module atrito_number_list
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: number_list_t, add_number, add_numbers, numbers_of

   type :: number_list_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: values(:)
   end type number_list_t

contains

   pure subroutine add_number(list, value)
      type(number_list_t), intent(inout) :: list
      integer(ip), intent(in) :: value

      call make_room(list, list%n + 1)
      list%n = list%n + 1
      list%values(list%n) = value
   end subroutine add_number

   pure subroutine add_numbers(list, values)
      type(number_list_t), intent(inout) :: list
      integer(ip), intent(in) :: values(:)

      call make_room(list, list%n + size(values, kind=ip))
      list%values(list%n + 1:list%n + size(values)) = values
      list%n = list%n + size(values, kind=ip)
   end subroutine add_numbers

   pure subroutine make_room(list, n)
      type(number_list_t), intent(inout) :: list
      integer(ip), intent(in) :: n
      integer(ip), allocatable :: longer(:)

      if (.not. allocated(list%values)) allocate (list%values(16))
      if (n <= size(list%values)) return
      allocate (longer(max(n, 2*size(list%values, kind=ip))))
      longer(:list%n) = list%values(:list%n)
      call move_alloc(longer, list%values)
   end subroutine make_room

   !> The numbers, without the room kept for growing.
   pure function numbers_of(list) result(values)
      type(number_list_t), intent(in) :: list
      integer(ip), allocatable :: values(:)

      if (allocated(list%values)) then
         values = list%values(:list%n)
      else
         allocate (values(0))
      end if
   end function numbers_of

end module atrito_number_list
