!> A list of names that grows by doubling: a deck can be wrong in every line.
module atrito_name_list
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, same_name
   implicit none (type, external)
   private
   public :: name_list_t, add_name, has_name

   type :: name_list_t
      integer(ip) :: n = 0
      type(string_t), allocatable :: names(:)
   end type name_list_t

contains

   pure subroutine add_name(list, name)
      type(name_list_t), intent(inout) :: list
      character(len=*), intent(in) :: name
      type(string_t), allocatable :: longer(:)
      integer(ip) :: i

      if (.not. allocated(list%names)) allocate (list%names(16))
      if (list%n == size(list%names)) then
         allocate (longer(2*list%n))
         do i = 1, list%n
            call move_alloc(list%names(i)%s, longer(i)%s)
         end do
         call move_alloc(longer, list%names)
      end if
      list%n = list%n + 1
      list%names(list%n)%s = name
   end subroutine add_name

   !> The name is one of the list, without case.
   pure logical function has_name(list, name)
      type(name_list_t), intent(in) :: list
      character(len=*), intent(in) :: name
      integer(ip) :: i

      has_name = .false.
      do i = 1, list%n
         has_name = same_name(list%names(i)%s, name)
         if (has_name) return
      end do
   end function has_name

end module atrito_name_list
