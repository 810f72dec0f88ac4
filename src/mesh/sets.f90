!> Named lists of nodes or elements. A set named again grows; members are kept once, in the order in which they came.
module atrito_sets
   use atrito_kinds, only: ip
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_ranges, only: ranges_t, add_numbers, add_ranges, move_ranges, numbers_in, count_numbers
   implicit none (type, external)
   private
   public :: set_t, set_list_t, set_count, find_set, grow_set, members_of, member_count, replace_members

   type :: set_t
      character(len=:), allocatable :: name    !< as it was written first
      type(ranges_t) :: members                !< places, not ids
   end type set_t

   type :: set_list_t
      type(set_t), allocatable :: sets(:)      !< the first set_count are in use
      type(name_list_t) :: names               !< of them, in their order
   end type set_list_t

   !> Adds members to a set, which is made when it is new: call grow_set(list, name, places), or those of a ranges_t.
   interface grow_set
      module procedure grow_by_numbers, grow_by_ranges
   end interface grow_set

   integer(ip), parameter :: FIRST_LENGTH = 8

contains

   !> How many sets a list has.
   pure integer(ip) function set_count(list) result(n)
      type(set_list_t), intent(in) :: list !< may be empty

      n = list%names%n
   end function set_count

   !> Index of a set by name, without case; 0 when there is none.
   pure integer(ip) function find_set(list, name) result(i)
      type(set_list_t), intent(in) :: list !< searched by hash
      character(len=*), intent(in) :: name !< as written, in either case

      i = find_name(list%names, name)
   end function find_set

   !> The members of a set, one by one.
   pure function members_of(set) result(members)
      type(set_t), intent(in) :: set !< places of nodes or of elements
      integer(ip), allocatable :: members(:)

      members = numbers_in(set%members)
   end function members_of

   !> How many numbers a set has, each counted once.
   pure integer(ip) function member_count(set) result(n)
      type(set_t), intent(in) :: set !< places of nodes or of elements

      n = count_numbers(set%members)
   end function member_count

   !> Gives a set other members (places of nodes or elements), in any order.
   pure subroutine replace_members(set, members)
      type(set_t), intent(inout) :: set     !< keeps its name
      integer(ip), intent(in) :: members(:) !< places; may be repeated

      set%members = ranges_t()
      call add_numbers(set%members, members)
   end subroutine replace_members

   pure subroutine grow_by_numbers(list, name, members)
      type(set_list_t), intent(inout) :: list !< gets a set, or a longer one
      character(len=*), intent(in) :: name    !< in either case
      integer(ip), intent(in) :: members(:)   !< places; those that are there already are passed over
      integer(ip) :: i

      call find_or_append(list, name, i)
      call add_numbers(list%sets(i)%members, members)
   end subroutine grow_by_numbers

   pure subroutine grow_by_ranges(list, name, members)
      type(set_list_t), intent(inout) :: list !< gets a set, or a longer one
      character(len=*), intent(in) :: name    !< in either case
      type(ranges_t), intent(in) :: members   !< places; those that are there already are passed over
      integer(ip) :: i

      call find_or_append(list, name, i)
      call add_ranges(list%sets(i)%members, members)
   end subroutine grow_by_ranges

   !> The place of a set; a new one has no members. Where there is no room the list doubles, the sets handed on without a copy.
   pure subroutine find_or_append(list, name, i)
      type(set_list_t), intent(inout) :: list
      character(len=*), intent(in) :: name
      integer(ip), intent(out) :: i
      type(set_t), allocatable :: longer(:)
      integer(ip) :: k

      i = find_set(list, name)
      if (i > 0) return
      i = set_count(list) + 1
      if (.not. allocated(list%sets)) allocate (list%sets(FIRST_LENGTH))
      if (i > size(list%sets)) then
         allocate (longer(2*i))
         do k = 1, i - 1
            call move_alloc(list%sets(k)%name, longer(k)%name)
            call move_ranges(list%sets(k)%members, longer(k)%members)
         end do
         call move_alloc(longer, list%sets)
      end if
      list%sets(i)%name = name
      call add_name(list%names, name)
   end subroutine find_or_append

end module atrito_sets
