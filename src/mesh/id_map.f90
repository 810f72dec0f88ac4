!> From the user's numbers (any positive integers) to places in an array.
!>
!> As long as the numbers come one after the other, and their places too, only the first number and its place are kept. From the
!> first that does not on there is a table: of all numbers up to the greatest, where many of these are there, else a hash table.
!> Either becomes the other when it is full.
!>
!> The hash table has open addressing: a number is sought from the slot that its hash gives on, one slot after the other, until it
!> is met, or a free slot, where it would be. No more than half of the slots are in use, so that a few steps do; a table that is
!> fuller is made anew, of twice as many numbers, which over all numbers costs a few steps each.
module atrito_id_map
   use atrito_kinds, only: ip, lp
   implicit none (type, external)
   private
   public :: id_map_t, add_id, add_sequence, find_id, is_whole_sequence

   type :: id_map_t
      integer(ip) :: n = 0                                          !< ids that are there
      integer(ip), private :: first_id = 0, first_place = 0         !< of the sequence
      integer(ip), private :: greatest = 0                          !< id of the table
      integer(ip), allocatable, private :: place(:)                 !< of the table, if there is one
      integer(ip), allocatable, private :: key(:)                   !< of the hash table; 0: free. Else place(id), 0: not there
   end type id_map_t

   !> Numbers up to the greatest over those that are there, at the most, in a table of all: no more memory than hashing takes.
   integer(lp), parameter :: MOST_OVER_ALL = 4_lp

contains

   !> Keeps id -> place. An id that is there already keeps its place and `known` is true.
   pure subroutine add_id(map, id, place, known)
      type(id_map_t), intent(inout) :: map !< changed unless the id is known
      integer(ip), intent(in) :: id        !< > 0
      integer(ip), intent(in) :: place     !< > 0
      logical, intent(out) :: known        !< the id was there already
      integer(ip) :: slot

      if (.not. allocated(map%place)) then
         known = is_in_sequence(map, id)
         if (known) return
         if (map%n == 0) then
            map%first_id = id
            map%first_place = place
         end if
         if (id - map%first_id == map%n .and. place - map%first_place == map%n) then
            map%n = map%n + 1
            return
         end if
      end if
      if (.not. has_room(map, id)) call grow_table(map, id)
      slot = id
      if (allocated(map%key)) slot = find_slot(map, id)
      known = map%place(slot) > 0
      if (known) return
      call put_id(map, id, place)
      map%n = map%n + 1
   end subroutine add_id

   !> Keeps first_id -> first_place, first_id + 1 -> first_place + 1, ...; none of the ids may be there yet.
   pure subroutine add_sequence(map, first_id, first_place, n)
      type(id_map_t), intent(inout) :: map               !< gets n ids more
      integer(ip), intent(in) :: first_id, first_place   !< > 0
      integer(ip), intent(in) :: n                       !< ids; < 1: none
      integer(ip) :: i
      logical :: known

      if (n < 1) return
      call add_id(map, first_id, first_place, known)
      if (.not. allocated(map%place)) then
         map%n = map%n + n - 1             ! the first goes on with the sequence, and so do the others
      else
         do i = 1, n - 1
            call add_id(map, first_id + i, first_place + i, known)
         end do
      end if
   end subroutine add_sequence

   !> Place of an id; 0 when it is not there.
   pure integer(ip) function find_id(map, id) result(place)
      type(id_map_t), intent(in) :: map !< is searched
      integer(ip), intent(in) :: id     !< the user's number; any number may be asked for
      integer(ip) :: slot

      place = 0
      if (map%n == 0 .or. id <= 0) return
      if (allocated(map%key)) then
         slot = find_slot(map, id)
         if (map%key(slot) == id) place = map%place(slot)
      else if (allocated(map%place)) then
         if (id <= size(map%place)) place = map%place(id)
      else if (is_in_sequence(map, id)) then
         place = map%first_place + (id - map%first_id)
      end if
   end function find_id

   !> All numbers of a range are there, and their places are one after the other; soon known, and false where it would not be.
   pure logical function is_whole_sequence(map, first, last)
      type(id_map_t), intent(in) :: map      !< false where it has a table
      integer(ip), intent(in) :: first, last !< range of ids, both ends included

      is_whole_sequence = first > 0 .and. first <= last .and. .not. allocated(map%place)
      if (is_whole_sequence) is_whole_sequence = is_in_sequence(map, first) .and. is_in_sequence(map, last)
   end function is_whole_sequence

   pure logical function is_in_sequence(map, id)
      type(id_map_t), intent(in) :: map
      integer(ip), intent(in) :: id       !< > 0

      is_in_sequence = id >= map%first_id .and. id - map%first_id < map%n
   end function is_in_sequence

   !> Whether the table, if there is one, takes another id.
   pure logical function has_room(map, id)
      type(id_map_t), intent(in) :: map
      integer(ip), intent(in) :: id

      has_room = .false.
      if (allocated(map%key)) then
         has_room = 2_lp*map%n < size(map%key, kind=lp)
      else if (allocated(map%place)) then
         has_room = id <= size(map%place)
      end if
   end function has_room

   !> A larger table, of the kind that fits, for what is there and another id.
   pure subroutine grow_table(map, id)
      type(id_map_t), intent(inout) :: map
      integer(ip), intent(in) :: id
      type(id_map_t) :: larger
      integer(ip) :: i
      integer(lp) :: greatest

      greatest = max(int(map%greatest, lp), int(id, lp))
      if (.not. allocated(map%place)) greatest = max(greatest, int(map%first_id, lp) + map%n - 1)
      call make_table(larger, map%n + 1_ip, greatest)
      if (.not. allocated(map%place)) then
         do i = 0, map%n - 1
            call put_id(larger, map%first_id + i, map%first_place + i)
         end do
      else
         do i = lbound(map%place, 1, ip), ubound(map%place, 1, ip)
            if (map%place(i) == 0) cycle
            if (allocated(map%key)) call put_id(larger, map%key(i), map%place(i))
            if (.not. allocated(map%key)) call put_id(larger, i, map%place(i))
         end do
      end if
      larger%n = map%n
      if (allocated(map%key)) deallocate (map%key)
      if (allocated(larger%key)) call move_alloc(larger%key, map%key)
      call move_alloc(larger%place, map%place)
      map%greatest = larger%greatest
   end subroutine grow_table

   !> An empty table for so many ids, with room for as many more.
   pure subroutine make_table(map, n, greatest)
      type(id_map_t), intent(inout) :: map
      integer(ip), intent(in) :: n
      integer(lp), intent(in) :: greatest        !< id
      integer(lp) :: length

      if (greatest <= MOST_OVER_ALL*n) then
         length = min(greatest + greatest/2, int(huge(1_ip), lp))
         allocate (map%place(length), source=0_ip)
         return
      end if
      length = 64_lp
      do while (length <= 2_lp*n)
         length = 2*length
      end do
      allocate (map%key(0:length - 1), map%place(0:length - 1), source=0_ip)
   end subroutine make_table

   !> Puts an id that is not there into the table, which has room for it.
   pure subroutine put_id(map, id, place)
      type(id_map_t), intent(inout) :: map
      integer(ip), intent(in) :: id, place
      integer(ip) :: slot

      slot = id
      if (allocated(map%key)) then
         slot = find_slot(map, id)
         map%key(slot) = id
      end if
      map%place(slot) = place
      map%greatest = max(map%greatest, id)
   end subroutine put_id

   !> The slot of an id, or the free slot where it would go (linear probing after a multiplicative hash).
   pure integer(ip) function find_slot(map, id) result(slot)
      type(id_map_t), intent(in) :: map
      integer(ip), intent(in) :: id
      integer(lp), parameter :: FACTOR = 2654435769_lp
      integer(lp) :: mask

      mask = size(map%key, kind=lp) - 1_lp
      slot = int(iand(shiftr(int(id, lp)*FACTOR, 7), mask), ip)
      do while (map%key(slot) /= 0 .and. map%key(slot) /= id)
         slot = int(iand(int(slot, lp) + 1_lp, mask), ip)
      end do
   end function find_slot

end module atrito_id_map
