!> Named lists of nodes or elements. A set named again grows; members are kept once, in the order in which they came.
module atrito_sets
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip
   use atrito_name_list, only: name_list_t, add_name, find_name
   implicit none (type, external)
   private
   public :: set_t, set_list_t, set_count, find_set, grow_set

   type :: set_t
      character(len=:), allocatable :: name
      integer(ip), allocatable :: members(:)   !< places, not ids
   end type set_t

   type :: set_list_t
      type(set_t), allocatable :: sets(:)      !< the first set_count are in use
      type(name_list_t) :: names               !< of them, in their order
   end type set_list_t

   integer(ip), parameter :: FIRST_LENGTH = 8

contains

   pure integer(ip) function set_count(list) result(n)
      type(set_list_t), intent(in) :: list

      n = list%names%n
   end function set_count

   !> Index of a set by name, without case; 0 when there is none.
   pure integer(ip) function find_set(list, name) result(i)
      type(set_list_t), intent(in) :: list
      character(len=*), intent(in) :: name

      i = find_name(list%names, name)
   end function find_set

   !> Adds members to a set, which is made when it is new.
   pure subroutine grow_set(list, name, members)
      type(set_list_t), intent(inout) :: list
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: members(:)
      integer(ip) :: i

      i = find_set(list, name)
      if (i == 0) then
         call append_set(list, name)
         i = set_count(list)
      end if
      call add_members(list%sets(i), members)
   end subroutine grow_set

   !> A new set without members. Where there is no room the list doubles, the sets handed on without a copy.
   pure subroutine append_set(list, name)
      type(set_list_t), intent(inout) :: list
      character(len=*), intent(in) :: name
      type(set_t), allocatable :: longer(:)
      integer(ip) :: i, n

      n = set_count(list)
      if (.not. allocated(list%sets)) allocate (list%sets(FIRST_LENGTH))
      if (n == size(list%sets)) then
         allocate (longer(2*n))
         do i = 1, n
            call move_alloc(list%sets(i)%name, longer(i)%name)
            call move_alloc(list%sets(i)%members, longer(i)%members)
         end do
         call move_alloc(longer, list%sets)
      end if
      list%sets(n + 1)%name = name
      allocate (list%sets(n + 1)%members(0))
      call add_name(list%names, name)
   end subroutine append_set

   pure subroutine add_members(set, members)
      type(set_t), intent(inout) :: set
      integer(ip), intent(in) :: members(:)
      type(id_map_t) :: first                  ! where each of the members stands first
      logical, allocatable :: fresh(:)
      logical :: known
      integer(ip) :: i, k

      if (size(members) == 0) return
      if (size(set%members) == 0 .and. all(members(2:) > members(:size(members) - 1))) then
         set%members = members                 ! rising: none stands there twice
         return
      end if
      allocate (fresh(size(members)))
      do i = 1, size(members, kind=ip)
         call add_id(first, members(i), i, known)
         fresh(i) = .not. known
      end do
      do i = 1, size(set%members, kind=ip)
         k = find_id(first, set%members(i))
         if (k > 0) fresh(k) = .false.
      end do
      set%members = [set%members, pack(members, fresh)]
   end subroutine add_members

end module atrito_sets
