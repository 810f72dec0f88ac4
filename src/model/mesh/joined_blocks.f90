!> The blocks of a deck so far: those of a name, which of them MERGE has made one body, and which lie where a box lies. Each is
!> found without a look at all blocks, since a deck may have them by the thousand, each merged with the one before.
module atrito_joined_blocks
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, lp, wp
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_sorting, only: each_once
   implicit none (type, external)
   private
   public :: joined_blocks_t, add_joined_block, blocks_named, join_blocks, are_joined_blocks, blocks_near

   !> Blocks are numbered as they come. Bodies are a forest (union by size): each block has a parent, the root stands for its
   !> body, and the way from a block to its root has log2(n) steps at the most. The boxes round the blocks lie in grids of squares:
   !> a box in the grid whose squares have the least power of two that is longer than its sides, so in four squares at most; only
   !> squares that have a box are kept, in a table by a hash of their place.
   type :: joined_blocks_t
      integer(ip) :: n = 0                                 !< blocks so far
      type(name_list_t), private :: names                  !< each once, in the order of their first blocks
      type(number_list_t), private :: last_of              !< (n) of each name, by its first block: the last block that has it
      type(number_list_t), private :: before               !< (n) the block before that has the same name; 0: none
      type(number_list_t), private :: parent               !< (n) another block of its body; itself: the one that stands for all
      type(number_list_t), private :: in_body              !< (n) blocks of the body, of the one that stands for all
      type(id_map_t), private :: squares                   !< by a hash
      type(number_list_t), private :: head                 !< of each square the last entry
      type(number_list_t), private :: block, next          !< (entries) a block in a square, and another entry of the square
      type(number_list_t), private :: grid                 !< (grids) exponents of the sides of their squares
      type(number_list_t), private :: filled               !< (grids) entries in each
   end type joined_blocks_t

   !> Squares are not smaller than this part of the coordinates, as a power of two: their numbers stay within 64 bits.
   integer(ip), parameter :: FINEST = 40

contains

   !> Appends a block.
   pure subroutine add_joined_block(blocks, name, low, high)
      type(joined_blocks_t), intent(inout) :: blocks       !< gets a block, a body of its own
      character(len=*), intent(in) :: name                 !< of the block; others may have it
      real(wp), intent(in) :: low(2), high(2)              !< the box round it [L]
      integer(lp) :: square(2), n(2), i, j
      integer(ip) :: first, side, g, hash, slot
      logical :: known

      blocks%n = blocks%n + 1
      call add_name(blocks%names, name)
      first = find_name(blocks%names, name)
      call add_number(blocks%last_of, blocks%n)
      call add_number(blocks%before, merge(0_ip, blocks%last_of%values(first), first == blocks%n))
      blocks%last_of%values(first) = blocks%n
      call add_number(blocks%parent, blocks%n)
      call add_number(blocks%in_body, 1_ip)
      ! the box goes into the squares of its grid
      side = max(exponent(max(maxval(high - low), tiny(1.0_wp))), exponent(max(maxval(abs([low, high])), tiny(1.0_wp))) - FINEST)
      g = 0
      if (blocks%grid%n > 0) g = findloc(blocks%grid%values(:blocks%grid%n), side, dim=1, kind=ip)
      if (g == 0) then
         call add_number(blocks%grid, side)
         call add_number(blocks%filled, 0_ip)
         g = blocks%grid%n
      end if
      square = square_of(low, side)
      n = square_of(high, side) - square + 1_lp
      do j = square(2), square(2) + n(2) - 1
         do i = square(1), square(1) + n(1) - 1
            hash = square_hash(side, i, j)
            slot = find_id(blocks%squares, hash)
            if (slot == 0) then
               call add_number(blocks%head, 0_ip)
               slot = blocks%head%n
               call add_id(blocks%squares, hash, slot, known)
            end if
            call add_number(blocks%block, blocks%n)
            call add_number(blocks%next, blocks%head%values(slot))
            blocks%head%values(slot) = blocks%block%n
            blocks%filled%values(g) = blocks%filled%values(g) + 1
         end do
      end do
   end subroutine add_joined_block

   !> The blocks of a name, in rising order.
   pure function blocks_named(blocks, name) result(list)
      type(joined_blocks_t), intent(in) :: blocks !< so far
      character(len=*), intent(in) :: name        !< of a *BLOCK; none may have it
      integer(ip), allocatable :: list(:)
      type(number_list_t) :: falling
      integer(ip) :: b

      b = find_name(blocks%names, name)
      if (b > 0) b = blocks%last_of%values(b)
      do while (b > 0)
         call add_number(falling, b)
         b = blocks%before%values(b)
      end do
      list = numbers_of(falling)
      list = list(size(list):1:-1)
   end function blocks_named

   !> Makes the bodies of two blocks one. The larger one stands for both, so the way to it is short.
   pure subroutine join_blocks(blocks, a, b)
      type(joined_blocks_t), intent(inout) :: blocks !< bodies of a and b become one
      integer(ip), intent(in) :: a, b                !< numbers of blocks, 1..n
      integer(ip) :: large, small

      large = body_of(blocks, a)
      small = body_of(blocks, b)
      if (large == small) return
      if (blocks%in_body%values(large) < blocks%in_body%values(small)) then
         large = small
         small = body_of(blocks, a)
      end if
      blocks%parent%values(small) = large
      blocks%in_body%values(large) = blocks%in_body%values(large) + blocks%in_body%values(small)
   end subroutine join_blocks

   !> Whether two blocks are of one body.
   pure logical function are_joined_blocks(blocks, a, b)
      type(joined_blocks_t), intent(in) :: blocks !< so far
      integer(ip), intent(in) :: a, b             !< numbers of blocks, 1..n

      are_joined_blocks = body_of(blocks, a) == body_of(blocks, b)
   end function are_joined_blocks

   !> The block that stands for the body of a block: the root of its tree.
   pure integer(ip) function body_of(blocks, b) result(body)
      type(joined_blocks_t), intent(in) :: blocks
      integer(ip), intent(in) :: b

      body = b
      do while (blocks%parent%values(body) /= body)
         body = blocks%parent%values(body)
      end do
   end function body_of

   !> Blocks that may lie where a box lies, in rising order: all that do, and some beside it.
   pure function blocks_near(blocks, low, high) result(near)
      type(joined_blocks_t), intent(in) :: blocks          !< so far
      real(wp), intent(in) :: low(2), high(2)              !< [L]
      integer(ip), allocatable :: near(:)
      type(number_list_t) :: found
      integer(lp) :: first(2), n(2), i, j
      integer(ip) :: g, slot, entry

      do g = 1, blocks%grid%n
         first = square_of(low, blocks%grid%values(g))    ! the squares over which the box goes
         n = square_of(high, blocks%grid%values(g)) - first + 1_lp
         if (n(1) > blocks%filled%values(g) .or. n(2) > blocks%filled%values(g)/max(1_lp, n(1))) then
            ! more squares than there are blocks
            near = [(entry, entry=1, blocks%n)]
            return
         end if
         do j = first(2), first(2) + n(2) - 1
            do i = first(1), first(1) + n(1) - 1
               slot = find_id(blocks%squares, square_hash(blocks%grid%values(g), i, j))
               if (slot == 0) cycle
               entry = blocks%head%values(slot)
               do while (entry > 0)
                  call add_number(found, blocks%block%values(entry))
                  entry = blocks%next%values(entry)
               end do
            end do
         end do
      end do
      near = each_once(numbers_of(found))
   end function blocks_near

   !> Number of the square along an axis. Those far beyond all that a grid has are one.
   pure elemental integer(lp) function square_of(x, side) result(square)
      real(wp), intent(in) :: x
      integer(ip), intent(in) :: side                      !< of a square, as a power of two

      if (abs(x) > 0.0_wp .and. exponent(x) - side > FINEST + 2) then
         square = int(sign(2.0_wp**(FINEST + 3), x), lp)
      else
         square = floor(scale(x, -side), lp)
      end if
   end function square_of

   !> A number > 0 for a square; several may have the same.
   pure integer(ip) function square_hash(side, i, j) result(hash)
      integer(ip), intent(in) :: side
      integer(lp), intent(in) :: i, j
      integer(lp), parameter :: MASK = 2147483647_lp, FACTOR(3) = [2654435769_lp, 2246822519_lp, 3266489917_lp]

      hash = int(1_lp + modulo(ieor(ieor(shiftr(iand(i, MASK)*FACTOR(1), 8), shiftr(iand(j, MASK)*FACTOR(2), 11)), &
                                    iand(int(side, lp), MASK)*FACTOR(3)), MASK), ip)
   end function square_hash

end module atrito_joined_blocks
