!> Named lists of nodes or elements. A set named again grows; members are kept once, in the order in which they came.
module atrito_sets
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, same_name
   implicit none (type, external)
   private
   public :: set_t, set_list_t, find_set, grow_set, set_names

   type :: set_t
      character(len=:), allocatable :: name
      integer(ip), allocatable :: members(:)   !< places, not ids
   end type set_t

   type :: set_list_t
      type(set_t), allocatable :: sets(:)
   end type set_list_t

contains

   !> Index of a set by name, without case; 0 when there is none.
   pure integer(ip) function find_set(list, name) result(i)
      type(set_list_t), intent(in) :: list
      character(len=*), intent(in) :: name

      if (allocated(list%sets)) then
         do i = 1, size(list%sets, kind=ip)
            if (same_name(list%sets(i)%name, name)) return
         end do
      end if
      i = 0
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
         i = size(list%sets, kind=ip)
      end if
      call add_members(list%sets(i), members)
   end subroutine grow_set

   !> A new set without members; the others are handed on without a copy.
   pure subroutine append_set(list, name)
      type(set_list_t), intent(inout) :: list
      character(len=*), intent(in) :: name
      type(set_t), allocatable :: longer(:)
      integer :: i, n

      n = 0
      if (allocated(list%sets)) n = size(list%sets)
      allocate (longer(n + 1))
      do i = 1, n
         call move_alloc(list%sets(i)%name, longer(i)%name)
         call move_alloc(list%sets(i)%members, longer(i)%members)
      end do
      longer(n + 1)%name = name
      allocate (longer(n + 1)%members(0))
      call move_alloc(longer, list%sets)
   end subroutine append_set

   pure subroutine add_members(set, members)
      type(set_t), intent(inout) :: set
      integer(ip), intent(in) :: members(:)
      logical, allocatable :: held(:), fresh(:)
      integer(ip) :: i

      if (size(members) == 0) return
      if (size(set%members) == 0 .and. all(members(2:) > members(:size(members) - 1))) then
         set%members = members                 ! rising: none stands there twice
         return
      end if
      allocate (held(max(maxval(members), max_member(set))), fresh(size(members)), source=.false.)
      do i = 1, size(set%members, kind=ip)
         held(set%members(i)) = .true.
      end do
      do i = 1, size(members, kind=ip)
         fresh(i) = .not. held(members(i))
         held(members(i)) = .true.
      end do
      set%members = [set%members, pack(members, fresh)]
   end subroutine add_members

   pure integer(ip) function max_member(set)
      type(set_t), intent(in) :: set

      max_member = 0
      if (size(set%members) > 0) max_member = maxval(set%members)
   end function max_member

   !> The names of a list of sets.
   pure function set_names(list) result(names)
      type(set_list_t), intent(in) :: list
      type(string_t), allocatable :: names(:)
      integer(ip) :: i

      if (.not. allocated(list%sets)) then
         allocate (names(0))
         return
      end if
      allocate (names(size(list%sets)))
      do i = 1, size(list%sets, kind=ip)
         names(i)%s = list%sets(i)%name
      end do
   end function set_names

end module atrito_sets
