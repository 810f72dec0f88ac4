!> A list of names, each found by a hash of its letters: a deck can have names by the thousand, and be wrong in every line.
module atrito_name_list
   use atrito_growth, only: growing_text_t, append_text
   use atrito_kinds, only: ip, lp
   use atrito_strings, only: string_t, same_name, lower_case
   implicit none (type, external)
   private
   public :: name_list_t, add_name, has_name, find_name, names_of

   !> The letters of all names stand one after the other. (A list of strings here would make a module file that gfortran 12 cannot
   !> read again.)
   type :: name_list_t
      integer(ip) :: n = 0                                 !< names in the list
      type(growing_text_t), private :: text                !< the letters
      integer(ip), allocatable, private :: last(:)         !< (0:) last letter of each name; last(0) = 0
      integer(ip), allocatable, private :: place(:)        !< (0:2**k-1) hash table: places in the list; 0: free
   end type name_list_t

   integer(ip), parameter :: FIRST_LENGTH = 16

contains

   !> Appends a name; of several that are the same the first is found.
   pure subroutine add_name(list, name)
      type(name_list_t), intent(inout) :: list !< gets it as the last one
      character(len=*), intent(in) :: name     !< blanks at its end do not count
      integer(ip) :: slot

      call make_room(list)
      call append_text(list%text, name)
      list%n = list%n + 1
      list%last(list%n) = list%text%n
      slot = find_slot(list, name)
      if (list%place(slot) == 0) list%place(slot) = list%n
   end subroutine add_name

   !> The name is one of the list, without case.
   pure logical function has_name(list, name)
      type(name_list_t), intent(in) :: list !< may be empty
      character(len=*), intent(in) :: name  !< blanks at its end do not count

      has_name = find_name(list, name) > 0
   end function has_name

   !> Place of a name in the list, without case; 0 when it is not there.
   pure integer(ip) function find_name(list, name) result(place)
      type(name_list_t), intent(in) :: list !< may be empty
      character(len=*), intent(in) :: name  !< blanks at its end do not count

      place = 0
      if (list%n > 0) place = list%place(find_slot(list, name))
   end function find_name

   !> All names in their order.
   pure function names_of(list) result(names)
      type(name_list_t), intent(in) :: list !< may be empty
      type(string_t), allocatable :: names(:)
      integer(ip) :: i

      allocate (names(list%n))
      do i = 1, list%n
         names(i)%s = name_at(list, i)
      end do
   end function names_of

   pure function name_at(list, i) result(name)
      type(name_list_t), intent(in) :: list
      integer(ip), intent(in) :: i
      character(len=:), allocatable :: name

      name = list%text%letters(list%last(i - 1) + 1:list%last(i))
   end function name_at

   !> Room for one more name; where there is none, the lists double.
   pure subroutine make_room(list)
      type(name_list_t), intent(inout) :: list
      integer(ip), allocatable :: last(:)

      if (.not. allocated(list%last)) allocate (list%last(0:FIRST_LENGTH), list%place(0:2*FIRST_LENGTH - 1), source=0_ip)
      if (list%n < ubound(list%last, 1)) return
      allocate (last(0:2*list%n))
      last(:list%n) = list%last
      call move_alloc(last, list%last)
      call make_table(list, 4*list%n)
   end subroutine make_room

   pure subroutine make_table(list, length)
      type(name_list_t), intent(inout) :: list
      integer(ip), intent(in) :: length              !< a power of two, twice the names that there is room for
      integer(ip) :: i, slot

      deallocate (list%place)
      allocate (list%place(0:length - 1), source=0_ip)
      do i = 1, list%n
         slot = find_slot(list, name_at(list, i))
         if (list%place(slot) == 0) list%place(slot) = i
      end do
   end subroutine make_table

   !> The slot of a name, or the free slot where it would go (linear probing).
   pure integer(ip) function find_slot(list, name) result(slot)
      type(name_list_t), intent(in) :: list
      character(len=*), intent(in) :: name
      integer(lp) :: mask

      mask = size(list%place, kind=lp) - 1_lp
      slot = int(iand(hash(name), mask), ip)
      do while (list%place(slot) /= 0)
         if (same_name(name_at(list, list%place(slot)), name)) return
         slot = int(iand(int(slot, lp) + 1_lp, mask), ip)
      end do
   end function find_slot

   !> Fowler, Noll and Vo's hash of the letters, without case and without blanks at the end, with its high bits mixed in.
   pure integer(lp) function hash(name)
      character(len=*), intent(in) :: name
      integer(lp), parameter :: BASIS = 2166136261_lp, PRIME = 16777619_lp, BITS = 4294967295_lp
      integer :: i

      hash = BASIS
      do i = 1, len_trim(name)
         hash = iand(ieor(hash, int(iachar(lower_case(name(i:i))), lp))*PRIME, BITS)
      end do
      hash = ieor(hash, shiftr(hash, 15))
   end function hash

end module atrito_name_list
