!> The fronts of the parts of an elimination as records of whole numbers.
!>
!>     pivots, border, children, elements,
!>     for each child:   its number, entries of its border, the place of each of them in the front
!>     for each element: its matrix, its equations, the place of each of them in the front (0: prescribed)
!>
!> The border of a part are the equations of its ancestors that its subtree couples to, in the order of their places.
module atrito_front_records
   use atrito_element_store, only: element_store_t
   use atrito_elimination, only: elimination_t
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: part_tree_t, record_writer_t, plant_tree, begin_writer, write_part, push_border, top_border, HEADER

   !> Numbers before the children in a record.
   integer(ip), parameter :: HEADER = 4_ip

   !> The parts with their elements. The last one holds the kept equations.
   type :: part_tree_t
      integer(ip) :: n_parts = 0
      integer(ip), allocatable :: first(:)       !< (n_parts + 1) places of part p: first(p)..first(p + 1) - 1
      integer(ip), allocatable :: parent(:)      !< (n_parts) 0 for the last
      integer(ip), allocatable :: n_descendants(:) !< (n_parts) they stand just before the part
      integer(ip), allocatable :: first_child(:), next_child(:) !< (n_parts) in the order of the parts; 0: none
      integer(lp), allocatable :: first_element(:) !< (n_parts + 1) elements of part p: element(first_element(p) + 1:...)
      integer(ip), allocatable :: element(:)
      logical :: enough = .true.                 !< memory; the tree is of no use without
   end type part_tree_t

   !> Writes the records of parts that follow one another: of a subtree, or of what stands above subtrees.
   type :: record_writer_t
      integer(ip), allocatable :: record(:)      !< (written or more) of the part in hand
      integer(lp) :: written = 0
      logical :: enough = .true.                 !< memory, for all parts so far; nothing more is written without
      integer(ip), allocatable, private :: at(:) !< (n) place in the front of the part in hand; 0: not in it
      integer(ip), allocatable, private :: border(:), buffer(:) !< (n) of that part
      integer(ip), private :: n_border = 0
      integer(ip), allocatable, private :: stack(:) !< borders of finished parts, the last one on top
      integer(lp), private :: top = 0
   end type record_writer_t

contains

   !> Sets up the tree of an elimination.
   subroutine plant_tree(elimination, n, n_kept, store, tree)
      type(elimination_t), intent(in) :: elimination
      integer(ip), intent(in) :: n, n_kept
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(out) :: tree
      integer(ip) :: p

      tree%n_parts = size(elimination%last, kind=ip) + 1
      call begin_parts(store%n, tree)
      if (.not. tree%enough) return
      tree%first(1) = 1
      tree%first(2:tree%n_parts) = elimination%last + 1
      tree%first(tree%n_parts) = n - n_kept + 1
      tree%first(tree%n_parts + 1) = n + 1
      do p = 1, tree%n_parts - 1
         tree%parent(p) = elimination%parent(p)
         if (tree%parent(p) == 0) tree%parent(p) = tree%n_parts
         tree%n_descendants(tree%parent(p)) = tree%n_descendants(tree%parent(p)) + 1 + tree%n_descendants(p)
      end do
      do p = tree%n_parts - 1, 1, -1
         tree%next_child(p) = tree%first_child(tree%parent(p))
         tree%first_child(tree%parent(p)) = p
      end do
      call sort_elements(elimination, n, store, tree)
   end subroutine plant_tree

   !> Room for the parts, without elements and children.
   pure subroutine begin_parts(n_elements, tree)
      integer(ip), intent(in) :: n_elements
      type(part_tree_t), intent(inout) :: tree
      integer :: no_memory

      allocate (tree%first(tree%n_parts + 1), tree%parent(tree%n_parts), tree%n_descendants(tree%n_parts), &
                tree%first_child(tree%n_parts), tree%next_child(tree%n_parts), tree%first_element(tree%n_parts + 1), &
                tree%element(n_elements), stat=no_memory)
      tree%enough = no_memory == 0
      if (.not. tree%enough) return
      tree%parent = 0
      tree%n_descendants = 0
      tree%first_child = 0
      tree%next_child = 0
      tree%first_element = 0
   end subroutine begin_parts

   !> An element belongs to the part that eliminates the first of its equations.
   subroutine sort_elements(elimination, n, store, tree)
      type(elimination_t), intent(in) :: elimination
      integer(ip), intent(in) :: n
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(inout) :: tree
      integer(ip), allocatable :: part_at(:), part_of(:)
      integer(ip) :: p, e
      integer(lp), allocatable :: next(:)
      integer(lp) :: k
      integer :: no_memory

      allocate (part_at(n), part_of(store%n), next(tree%n_parts), stat=no_memory)
      tree%enough = no_memory == 0
      if (.not. tree%enough) return
      do p = 1, tree%n_parts
         part_at(tree%first(p):tree%first(p + 1) - 1) = p
      end do
      !$omp parallel do default(none) private(p, k) shared(elimination, store, tree, part_at, part_of) if(is_shared(store%n))
      do e = 1, store%n
         p = tree%n_parts + 1
         do k = store%start(e) + 1, store%start(e + 1)
            if (store%equations(k) > 0) p = min(p, part_at(elimination%place(store%equations(k))))
         end do
         part_of(e) = p
      end do
      !$omp end parallel do
      do e = 1, store%n
         p = part_of(e)
         if (p <= tree%n_parts) tree%first_element(p + 1) = tree%first_element(p + 1) + 1
      end do
      do p = 1, tree%n_parts
         next(p) = tree%first_element(p)
         tree%first_element(p + 1) = tree%first_element(p + 1) + tree%first_element(p)
      end do
      do e = 1, store%n
         p = part_of(e)
         if (p > tree%n_parts) cycle             ! all of its equations are prescribed
         next(p) = next(p) + 1
         tree%element(next(p)) = e
      end do
   end subroutine sort_elements

   pure subroutine begin_writer(writer, n)
      type(record_writer_t), intent(inout) :: writer
      integer(ip), intent(in) :: n               !< equations
      integer(ip), parameter :: ROOM = 1024_ip
      integer :: no_memory

      writer%top = 0
      if (allocated(writer%at)) return
      allocate (writer%at(n), writer%border(n), writer%buffer(n), writer%stack(ROOM), writer%record(ROOM), stat=no_memory)
      writer%enough = no_memory == 0
      if (writer%enough) writer%at = 0
   end subroutine begin_writer

   !> Writes the record of a part; its children are the last ones that were written or pushed. Its border takes the place of theirs
   !> on the stack.
   subroutine write_part(elimination, store, tree, p, waiting, writer)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p
      integer(ip), intent(inout) :: waiting(:)   !< (n_parts) entries of the borders of finished parts
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: i

      if (.not. writer%enough) return
      call collect_border(elimination, store, tree, p, waiting, writer)
      call write_record(elimination, store, tree, p, waiting, writer)
      if (.not. writer%enough) return
      writer%top = below_children(tree, p, waiting, writer)
      do i = 1, writer%n_border
         writer%at(writer%border(i)) = 0
      end do
      call push_border(writer, writer%border(:writer%n_border))
      waiting(p) = writer%n_border
   end subroutine write_part

   !> The height of the stack below the borders of a part's children, which are on top.
   pure integer(lp) function below_children(tree, p, waiting, writer) result(height)
      type(part_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p, waiting(:)
      type(record_writer_t), intent(in) :: writer
      integer(ip) :: child

      height = writer%top
      child = tree%first_child(p)
      do while (child /= 0)
         height = height - waiting(child)
         child = tree%next_child(child)
      end do
   end function below_children

   !> The border on top of the stack.
   pure function top_border(writer, n) result(border)
      type(record_writer_t), intent(in) :: writer
      integer(ip), intent(in) :: n               !< its entries
      integer(ip) :: border(n)

      border = writer%stack(writer%top - n + 1:writer%top)
   end function top_border

   !> Puts a border on the stack.
   pure subroutine push_border(writer, border)
      type(record_writer_t), intent(inout) :: writer
      integer(ip), intent(in) :: border(:)
      integer(ip) :: n

      n = size(border, kind=ip)
      if (writer%top + n > size(writer%stack, kind=lp)) call grow(writer%stack, 2*(writer%top + n), writer%enough)
      if (.not. writer%enough) return
      writer%stack(writer%top + 1:writer%top + n) = border
      writer%top = writer%top + n
   end subroutine push_border

   !> The border of a part: the borders of its children and the equations of its elements, beyond its own, in order. `at` then
   !> holds the place in the front of each.
   subroutine collect_border(elimination, store, tree, p, waiting, writer)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p
      integer(ip), intent(in) :: waiting(:)
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: child, n_new, last, place, i, e
      integer(lp) :: k, base

      last = tree%first(p + 1) - 1
      writer%n_border = 0
      base = below_children(tree, p, waiting, writer)
      child = tree%first_child(p)
      do while (child /= 0)
         n_new = 0
         do k = base + 1, base + waiting(child)
            call take_place(writer%stack(k))
         end do
         base = base + waiting(child)
         call merge_new(writer, n_new)
         child = tree%next_child(child)
      end do
      n_new = 0
      do i = int(tree%first_element(p), ip) + 1, int(tree%first_element(p + 1), ip)
         e = tree%element(i)
         do k = store%start(e) + 1, store%start(e + 1)
            if (store%equations(k) == 0) cycle
            place = elimination%place(store%equations(k))
            call take_place(place)
         end do
      end do
      call sort_new(writer%buffer(:n_new))
      call merge_new(writer, n_new)
      do i = 1, writer%n_border
         writer%at(writer%border(i)) = tree%first(p + 1) - tree%first(p) + i
      end do

   contains

      subroutine take_place(place)
         integer(ip), intent(in) :: place

         if (place <= last) return
         if (writer%at(place) /= 0) return
         writer%at(place) = 1
         n_new = n_new + 1
         writer%buffer(n_new) = place
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
   pure subroutine merge_new(writer, n_new)
      type(record_writer_t), intent(inout) :: writer
      integer(ip), intent(in) :: n_new
      integer(ip) :: i, j, k

      i = writer%n_border
      j = n_new
      writer%n_border = i + j
      do k = writer%n_border, 1, -1
         if (j == 0) exit
         if (i > 0) then
            if (writer%border(i) > writer%buffer(j)) then
               writer%border(k) = writer%border(i)
               i = i - 1
               cycle
            end if
         end if
         writer%border(k) = writer%buffer(j)
         j = j - 1
      end do
   end subroutine merge_new

   !> Writes the record of a part.
   subroutine write_record(elimination, store, tree, p, waiting, writer)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p
      integer(ip), intent(in) :: waiting(:)
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: n_children
      integer(lp) :: length

      call measure_record(store, tree, p, waiting, n_children, length)
      if (length > size(writer%record, kind=lp)) call grow(writer%record, 2*length, writer%enough)
      if (.not. writer%enough) return
      writer%written = 0
      call put(writer, tree%first(p + 1) - tree%first(p))
      call put(writer, writer%n_border)
      call put(writer, n_children)
      call put(writer, int(tree%first_element(p + 1) - tree%first_element(p), ip))
      call write_children(tree, p, waiting, writer)
      call write_elements(elimination, store, tree, p, writer)
   end subroutine write_record

   pure subroutine measure_record(store, tree, p, waiting, n_children, length)
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p, waiting(:)
      integer(ip), intent(out) :: n_children
      integer(lp), intent(out) :: length
      integer(ip) :: child, e
      integer(lp) :: i

      n_children = 0
      length = HEADER
      child = tree%first_child(p)
      do while (child /= 0)
         n_children = n_children + 1
         length = length + 2 + waiting(child)
         child = tree%next_child(child)
      end do
      do i = tree%first_element(p) + 1, tree%first_element(p + 1)
         e = tree%element(i)
         length = length + 2 + store%start(e + 1) - store%start(e)
      end do
   end subroutine measure_record

   pure subroutine write_children(tree, p, waiting, writer)
      type(part_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p, waiting(:)
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: child
      integer(lp) :: k, base

      base = below_children(tree, p, waiting, writer)
      child = tree%first_child(p)
      do while (child /= 0)
         call put(writer, child)
         call put(writer, waiting(child))
         do k = base + 1, base + waiting(child)
            call put(writer, place_in_front(tree, p, writer, writer%stack(k)))
         end do
         base = base + waiting(child)
         child = tree%next_child(child)
      end do
   end subroutine write_children

   pure subroutine write_elements(elimination, store, tree, p, writer)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: e
      integer(lp) :: i, k

      do i = tree%first_element(p) + 1, tree%first_element(p + 1)
         e = tree%element(i)
         call put(writer, store%matrix_of(e))
         call put(writer, int(store%start(e + 1) - store%start(e), ip))
         do k = store%start(e) + 1, store%start(e + 1)
            if (store%equations(k) == 0) then
               call put(writer, 0_ip)
            else
               call put(writer, place_in_front(tree, p, writer, elimination%place(store%equations(k))))
            end if
         end do
      end do
   end subroutine write_elements

   !> The record has room.
   pure subroutine put(writer, number)
      type(record_writer_t), intent(inout) :: writer
      integer(ip), intent(in) :: number

      writer%written = writer%written + 1
      writer%record(writer%written) = number
   end subroutine put

   pure integer(ip) function place_in_front(tree, p, writer, place)
      type(part_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p
      type(record_writer_t), intent(in) :: writer
      integer(ip), intent(in) :: place           !< in the order of elimination

      if (place < tree%first(p + 1)) then
         place_in_front = place - tree%first(p) + 1
      else
         place_in_front = writer%at(place)
      end if
   end function place_in_front

end module atrito_front_records
