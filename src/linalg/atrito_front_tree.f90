!> The fronts of a multifrontal elimination, counted out before any number is computed.
!>
!> A part of the elimination has a front: its own equations (the pivots) and those of its ancestors that its subtree couples to
!> (the border), in the order of their places. Parts of the same class have the same elements, children of the same classes, and
!> the same places for them in the front: their fronts are the same numbers, and one factorisation serves them all. A regular mesh
!> has a few hundred classes where an irregular one has as many as parts.
!>
!> A class is a record of whole numbers:
!>
!>     pivots, border, children, elements,
!>     for each child:   its class, entries of its border, the place of each of them in the front
!>     for each element: its matrix, its equations, the place of each of them in the front (0: prescribed)
!>
!> Reference: J. W. H. Liu, SIAM Review 34 (1992) 82-109.
module atrito_front_tree
   use atrito_element_store, only: element_store_t
   use atrito_elimination, only: elimination_t
   use atrito_kinds, only: ip, lp
   implicit none (type, external)
   private
   public :: front_tree_t, build_front_tree, HEADER

   !> Numbers before the children in a record.
   integer(ip), parameter :: HEADER = 4_ip

   !> The last part holds the kept equations and is never eliminated.
   type :: front_tree_t
      integer(ip) :: n_parts = 0
      integer(ip), allocatable :: first(:)       !< (n_parts + 1) places of part p: first(p)..first(p + 1) - 1
      integer(ip), allocatable :: class_of(:)    !< (n_parts)
      integer(ip), allocatable :: parent(:)      !< (n_parts) 0 for the last
      integer(ip), allocatable :: n_descendants(:) !< (n_parts) they stand just before the part
      integer(ip) :: n_classes = 0               !< numbered so that children come before their parents
      integer(lp), allocatable :: start(:)       !< (n_classes + 1 or more) record of class c: record(start(c) + 1:start(c + 1))
      integer(ip), allocatable :: record(:)
      integer(ip), allocatable :: representative(:) !< (n_classes or more) the first part of the class
   end type front_tree_t

   !> What is needed while the tree is built.
   type :: builder_t
      integer(ip), allocatable :: at(:)          !< (n) place in the front of the part in hand; 0: not in it
      integer(ip), allocatable :: border(:), buffer(:) !< (n) of that part
      integer(ip) :: n_border = 0
      integer(ip), allocatable :: stack(:)       !< borders of finished parts, the last one on top
      integer(lp) :: top = 0
      integer(ip), allocatable :: waiting(:)     !< (n_parts) length of a finished part's border
      integer(ip), allocatable :: first_child(:), next_child(:) !< (n_parts) in the order of the parts
      integer(lp), allocatable :: first_element(:) !< (n_parts + 1) elements of part p: element(first_element(p) + 1:...)
      integer(ip), allocatable :: element(:)
      integer(ip), allocatable :: table(:)       !< hash table of the classes; 0: free
      integer(lp) :: written = 0                 !< end of the record being written
   end type builder_t

contains

   !> Finds the fronts and their classes.
   subroutine build_front_tree(elimination, n, n_kept, store, tree)
      type(elimination_t), intent(in) :: elimination
      integer(ip), intent(in) :: n, n_kept
      type(element_store_t), intent(in) :: store
      type(front_tree_t), intent(out) :: tree
      type(builder_t) :: builder
      integer(ip) :: p

      tree%n_parts = size(elimination%last, kind=ip) + 1
      call begin_tree(elimination, n, n_kept, tree)
      call begin_builder(elimination, n, store, tree, builder)
      do p = 1, tree%n_parts
         call collect_border(elimination, store, tree, p, builder)
         call write_record(elimination, store, tree, p, builder)
         call find_class(tree, p, builder)
         call push_border(p, builder)
      end do
   end subroutine build_front_tree

   pure subroutine begin_tree(elimination, n, n_kept, tree)
      type(elimination_t), intent(in) :: elimination
      integer(ip), intent(in) :: n, n_kept
      type(front_tree_t), intent(inout) :: tree
      integer(ip), parameter :: ROOM = 256_ip
      integer(ip) :: p

      allocate (tree%first(tree%n_parts + 1), tree%class_of(tree%n_parts))
      tree%first(1) = 1
      tree%first(2:tree%n_parts) = elimination%last + 1
      tree%first(tree%n_parts) = n - n_kept + 1
      tree%first(tree%n_parts + 1) = n + 1
      allocate (tree%parent(tree%n_parts), tree%n_descendants(tree%n_parts), source=0_ip)
      do p = 1, tree%n_parts - 1
         tree%parent(p) = elimination%parent(p)
         if (tree%parent(p) == 0) tree%parent(p) = tree%n_parts
         tree%n_descendants(tree%parent(p)) = tree%n_descendants(tree%parent(p)) + 1 + tree%n_descendants(p)
      end do
      allocate (tree%start(ROOM), tree%representative(ROOM), tree%record(ROOM))
      tree%start(1) = 0
   end subroutine begin_tree

   pure subroutine begin_builder(elimination, n, store, tree, builder)
      type(elimination_t), intent(in) :: elimination
      integer(ip), intent(in) :: n
      type(element_store_t), intent(in) :: store
      type(front_tree_t), intent(in) :: tree
      type(builder_t), intent(out) :: builder
      integer(ip) :: p, parent

      allocate (builder%at(n), source=0_ip)
      allocate (builder%border(n), builder%buffer(n), builder%stack(1024), builder%waiting(tree%n_parts))
      allocate (builder%first_child(tree%n_parts), builder%next_child(tree%n_parts), source=0_ip)
      do p = tree%n_parts - 1, 1, -1
         parent = tree%parent(p)
         builder%next_child(p) = builder%first_child(parent)
         builder%first_child(parent) = p
      end do
      call sort_elements(elimination, n, store, tree, builder)
      allocate (builder%table(0:2**ceiling(log(2.0*real(tree%n_parts))/log(2.0))), source=0_ip)
   end subroutine begin_builder

   !> An element belongs to the part that eliminates the first of its equations.
   pure subroutine sort_elements(elimination, n, store, tree, builder)
      type(elimination_t), intent(in) :: elimination
      integer(ip), intent(in) :: n
      type(element_store_t), intent(in) :: store
      type(front_tree_t), intent(in) :: tree
      type(builder_t), intent(inout) :: builder
      integer(ip) :: part_at(n), part_of(store%n), p, e
      integer(lp) :: k, next(tree%n_parts)

      do p = 1, tree%n_parts
         part_at(tree%first(p):tree%first(p + 1) - 1) = p
      end do
      allocate (builder%first_element(tree%n_parts + 1), source=0_lp)
      allocate (builder%element(store%n))
      do e = 1, store%n
         p = tree%n_parts + 1
         do k = store%start(e) + 1, store%start(e + 1)
            if (store%equations(k) > 0) p = min(p, part_at(elimination%place(store%equations(k))))
         end do
         part_of(e) = p
         if (p <= tree%n_parts) builder%first_element(p + 1) = builder%first_element(p + 1) + 1
      end do
      do p = 1, tree%n_parts
         next(p) = builder%first_element(p)
         builder%first_element(p + 1) = builder%first_element(p + 1) + builder%first_element(p)
      end do
      do e = 1, store%n
         p = part_of(e)
         if (p > tree%n_parts) cycle             ! all of its equations are prescribed
         next(p) = next(p) + 1
         builder%element(next(p)) = e
      end do
   end subroutine sort_elements

   !> The border of a part: the borders of its children and the equations of its elements, beyond its own, in order. `at` then
   !> holds the place in the front of each.
   subroutine collect_border(elimination, store, tree, p, builder)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(front_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p
      type(builder_t), intent(inout) :: builder
      integer(ip) :: child, n_new, last, place, i, e
      integer(lp) :: k, base

      last = tree%first(p + 1) - 1
      builder%n_border = 0
      base = builder%top
      child = builder%first_child(p)
      do while (child /= 0)
         base = base - builder%waiting(child)
         child = builder%next_child(child)
      end do
      child = builder%first_child(p)
      do while (child /= 0)
         n_new = 0
         do k = base + 1, base + builder%waiting(child)
            call take_place(builder%stack(k))
         end do
         base = base + builder%waiting(child)
         call merge_new(builder, n_new)
         child = builder%next_child(child)
      end do
      n_new = 0
      do i = int(builder%first_element(p), ip) + 1, int(builder%first_element(p + 1), ip)
         e = builder%element(i)
         do k = store%start(e) + 1, store%start(e + 1)
            if (store%equations(k) == 0) cycle
            place = elimination%place(store%equations(k))
            call take_place(place)
         end do
      end do
      call sort_new(builder%buffer(:n_new))
      call merge_new(builder, n_new)
      do i = 1, builder%n_border
         builder%at(builder%border(i)) = tree%first(p + 1) - tree%first(p) + i
      end do

   contains

      subroutine take_place(place)
         integer(ip), intent(in) :: place

         if (place <= last) return
         if (builder%at(place) /= 0) return
         builder%at(place) = 1
         n_new = n_new + 1
         builder%buffer(n_new) = place
      end subroutine take_place

   end subroutine collect_border

   !> Sorts a list, by insertion: it is short, and nearly in order.
   pure subroutine sort_new(list)
      integer(ip), intent(inout) :: list(:)
      integer(ip) :: i, j, item

      do i = 2, size(list, kind=ip)
         item = list(i)
         do j = i - 1, 1, -1
            if (list(j) <= item) exit
            list(j + 1) = list(j)
         end do
         list(j + 1) = item
      end do
   end subroutine sort_new

   !> Merges the first n_new places of the buffer, which are sorted, into the border.
   pure subroutine merge_new(builder, n_new)
      type(builder_t), intent(inout) :: builder
      integer(ip), intent(in) :: n_new
      integer(ip) :: i, j, k

      i = builder%n_border
      j = n_new
      builder%n_border = i + j
      do k = builder%n_border, 1, -1
         if (j == 0) exit
         if (i > 0) then
            if (builder%border(i) > builder%buffer(j)) then
               builder%border(k) = builder%border(i)
               i = i - 1
               cycle
            end if
         end if
         builder%border(k) = builder%buffer(j)
         j = j - 1
      end do
   end subroutine merge_new

   !> Writes the record of a part behind those of the classes.
   subroutine write_record(elimination, store, tree, p, builder)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(front_tree_t), intent(inout) :: tree
      integer(ip), intent(in) :: p
      type(builder_t), intent(inout) :: builder
      integer(ip) :: child, n_children, i, e
      integer(lp) :: k, base, needed

      n_children = 0
      needed = HEADER
      base = builder%top
      child = builder%first_child(p)
      do while (child /= 0)
         n_children = n_children + 1
         needed = needed + 2 + builder%waiting(child)
         base = base - builder%waiting(child)
         child = builder%next_child(child)
      end do
      do i = int(builder%first_element(p), ip) + 1, int(builder%first_element(p + 1), ip)
         e = builder%element(i)
         needed = needed + 2 + store%start(e + 1) - store%start(e)
      end do
      builder%written = tree%start(tree%n_classes + 1)
      if (builder%written + needed > size(tree%record, kind=lp)) call grow(tree%record, 2*(builder%written + needed))
      call put(tree%first(p + 1) - tree%first(p))
      call put(builder%n_border)
      call put(n_children)
      call put(int(builder%first_element(p + 1) - builder%first_element(p), ip))
      child = builder%first_child(p)
      do while (child /= 0)
         call put(tree%class_of(child))
         call put(builder%waiting(child))
         do k = base + 1, base + builder%waiting(child)
            call put(place_in_front(builder%stack(k)))
         end do
         base = base + builder%waiting(child)
         child = builder%next_child(child)
      end do
      do i = int(builder%first_element(p), ip) + 1, int(builder%first_element(p + 1), ip)
         e = builder%element(i)
         call put(store%matrix_of(e))
         call put(int(store%start(e + 1) - store%start(e), ip))
         do k = store%start(e) + 1, store%start(e + 1)
            if (store%equations(k) == 0) then
               call put(0_ip)
            else
               call put(place_in_front(elimination%place(store%equations(k))))
            end if
         end do
      end do

   contains

      subroutine put(number)
         integer(ip), intent(in) :: number

         builder%written = builder%written + 1
         tree%record(builder%written) = number
      end subroutine put

      pure integer(ip) function place_in_front(place)
         integer(ip), intent(in) :: place

         if (place < tree%first(p + 1)) then
            place_in_front = place - tree%first(p) + 1
         else
            place_in_front = builder%at(place)
         end if
      end function place_in_front

   end subroutine write_record

   !> Looks the record of a part up among the classes; it becomes a class when it is new.
   pure subroutine find_class(tree, p, builder)
      type(front_tree_t), intent(inout) :: tree
      integer(ip), intent(in) :: p
      type(builder_t), intent(inout) :: builder
      integer(ip) :: slot, class
      integer(lp) :: first, length

      first = tree%start(tree%n_classes + 1)
      length = builder%written - first
      slot = hash(tree%record(first + 1:first + length), size(builder%table, kind=ip) - 1)
      do
         class = builder%table(slot)
         if (class == 0 .or. p == tree%n_parts) exit
         if (tree%start(class + 1) - tree%start(class) == length) then
            if (all(tree%record(tree%start(class) + 1:tree%start(class) + length) == tree%record(first + 1:first + length))) exit
         end if
         slot = modulo(slot + 1, size(builder%table, kind=ip) - 1)
      end do
      if (class == 0 .or. p == tree%n_parts) then  ! the last part is not eliminated, and a class of its own
         tree%n_classes = tree%n_classes + 1
         class = tree%n_classes
         builder%table(slot) = class
         if (class + 1 > size(tree%start)) then
            call grow_starts(tree%start)
            call grow(tree%representative, 2*size(tree%representative, kind=lp))
         end if
         tree%start(class + 1) = builder%written
         tree%representative(class) = p
      end if
      tree%class_of(p) = class
   end subroutine find_class

   !> A number 0..range - 1 that differs between most records.
   pure integer(ip) function hash(record, range)
      integer(ip), intent(in) :: record(:), range
      integer(lp) :: state
      integer(lp), parameter :: MASK = 2_lp**40 - 1, FACTOR = 1299709_lp   ! a prime; the product stays below 2^63
      integer(ip) :: i

      state = 0
      do i = 1, size(record, kind=ip)
         state = iand(ieor(state, ishft(state, -17))*FACTOR + record(i), MASK)
      end do
      hash = int(modulo(state, int(range, lp)), ip)
   end function hash

   !> Takes the borders of the children off the stack and puts that of the part on it.
   pure subroutine push_border(p, builder)
      integer(ip), intent(in) :: p
      type(builder_t), intent(inout) :: builder
      integer(ip) :: child, i

      child = builder%first_child(p)
      do while (child /= 0)
         builder%top = builder%top - builder%waiting(child)
         child = builder%next_child(child)
      end do
      if (builder%top + builder%n_border > size(builder%stack, kind=lp)) then
         call grow(builder%stack, 2*(builder%top + builder%n_border))
      end if
      do i = 1, builder%n_border
         builder%at(builder%border(i)) = 0
         builder%stack(builder%top + i) = builder%border(i)
      end do
      builder%top = builder%top + builder%n_border
      builder%waiting(p) = builder%n_border
   end subroutine push_border

   pure subroutine grow(list, length)
      integer(ip), allocatable, intent(inout) :: list(:)
      integer(lp), intent(in) :: length
      integer(ip), allocatable :: longer(:)

      allocate (longer(length))
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow

   pure subroutine grow_starts(list)
      integer(lp), allocatable, intent(inout) :: list(:)
      integer(lp), allocatable :: longer(:)

      allocate (longer(2*size(list, kind=lp)))
      longer(:size(list)) = list
      call move_alloc(longer, list)
   end subroutine grow_starts

end module atrito_front_tree
