!> From the user's numbers (any positive integers) to places in an array.
!>
!> As long as the numbers come one after the other, as do their places, their beginning tells all. From the first that does not on
!> there is a hash table that doubles.
module atrito_id_map
   use atrito_kinds, only: ip, lp
   implicit none (type, external)
   private
   public :: id_map_t, add_id, add_sequence, find_id

   type :: id_map_t
      integer(ip) :: n = 0
      integer(ip), private :: first_id = 0, first_place = 0         !< of the sequence
      integer(ip), allocatable, private :: key(:), place(:)         !< of the table, if there is one; key 0: free
   end type id_map_t

contains

   !> Keeps id -> place. An id that is there already keeps its place and `known` is true.
   pure subroutine add_id(map, id, place, known)
      type(id_map_t), intent(inout) :: map
      integer(ip), intent(in) :: id       !< > 0
      integer(ip), intent(in) :: place    !< > 0
      logical, intent(out) :: known
      integer(ip) :: slot

      if (.not. allocated(map%key)) then
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
         call leave_sequence(map)
      end if
      if (2*map%n >= size(map%key)) call grow_table(map)
      slot = find_slot(map, id)
      known = map%key(slot) == id
      if (known) return
      map%key(slot) = id
      map%place(slot) = place
      map%n = map%n + 1
   end subroutine add_id

   !> Keeps first_id -> first_place, first_id + 1 -> first_place + 1, ...; none of the ids may be there yet.
   pure subroutine add_sequence(map, first_id, first_place, n)
      type(id_map_t), intent(inout) :: map
      integer(ip), intent(in) :: first_id, first_place   !< > 0
      integer(ip), intent(in) :: n
      integer(ip) :: i
      logical :: known

      if (n < 1) return
      call add_id(map, first_id, first_place, known)
      if (.not. allocated(map%key)) then
         map%n = map%n + n - 1             ! the first goes on with the sequence, and so do the others
      else
         do i = 1, n - 1
            call add_id(map, first_id + i, first_place + i, known)
         end do
      end if
   end subroutine add_sequence

   !> Place of an id; 0 when it is not there.
   pure integer(ip) function find_id(map, id) result(place)
      type(id_map_t), intent(in) :: map
      integer(ip), intent(in) :: id
      integer(ip) :: slot

      place = 0
      if (map%n == 0 .or. id <= 0) return
      if (allocated(map%key)) then
         slot = find_slot(map, id)
         if (map%key(slot) == id) place = map%place(slot)
      else if (is_in_sequence(map, id)) then
         place = map%first_place + (id - map%first_id)
      end if
   end function find_id

   pure logical function is_in_sequence(map, id)
      type(id_map_t), intent(in) :: map
      integer(ip), intent(in) :: id       !< > 0

      is_in_sequence = id >= map%first_id .and. id - map%first_id < map%n
   end function is_in_sequence

   !> From the sequence to a table.
   pure subroutine leave_sequence(map)
      type(id_map_t), intent(inout) :: map
      integer(ip) :: i, slot, length

      length = 64
      do while (length <= 2*map%n)
         length = 2*length
      end do
      call make_table(map, length)
      do i = 0, map%n - 1
         slot = find_slot(map, map%first_id + i)
         map%key(slot) = map%first_id + i
         map%place(slot) = map%first_place + i
      end do
   end subroutine leave_sequence

   pure subroutine make_table(map, length)
      type(id_map_t), intent(inout) :: map
      integer(ip), intent(in) :: length   !< a power of two

      allocate (map%key(0:length - 1), map%place(0:length - 1), source=0_ip)
   end subroutine make_table

   pure subroutine grow_table(map)
      type(id_map_t), intent(inout) :: map
      type(id_map_t) :: larger
      integer(ip) :: i, slot

      call make_table(larger, 2*size(map%key, kind=ip))
      do i = 0, size(map%key, kind=ip) - 1
         if (map%key(i) == 0) cycle
         slot = find_slot(larger, map%key(i))
         larger%key(slot) = map%key(i)
         larger%place(slot) = map%place(i)
      end do
      call move_alloc(larger%key, map%key)
      call move_alloc(larger%place, map%place)
   end subroutine grow_table

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
