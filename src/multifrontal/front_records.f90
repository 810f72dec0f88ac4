!> The fronts of the supernodes of an elimination as records of whole numbers.
!>
!>     pivots, border, children, elements,
!>     for each child:   its number, entries of its border, the position of each of them in the front
!>     for each element: its matrix, its equations, the position of each of them in the front (0: prescribed)
!>
!> The border of a supernode are the equations of its ancestors that its subtree couples to, in the order of their positions.
!>
!> Supernodes are written children first. The border of p is the union of the borders of its children and of the equations of its
!> elements, without its own pivots; after p the borders of its children are of no use to anybody. So borders live on a stack: when
!> p comes, those of its children are the top ones, in their order, and its own takes their place. Its height is at most the sum of
!> the borders along one way from the root to a leaf, with those of the children beside it: what a walk through the tree has open.
!>
!> A union is built by marks (`at`, one number an equation): what is not marked yet is new, is sorted by itself, since it is little,
!> and merged into the sorted rest. Marks are taken off by going through the border again, so the time is that of the entries
!> written, not of all equations.
module atrito_front_records
   use atrito_element_store, only: element_store_t
   use atrito_elimination, only: elimination_t
   use atrito_growth, only: grow
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, lp
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: assembly_tree_t, record_writer_t, plant_tree, begin_writer, write_supernode, push_border, top_border, HEADER

   !> Numbers before the children in a record.
   integer(ip), parameter :: HEADER = 4_ip

   !> The supernodes with their elements: what is assembled where. The last one holds the retained equations.
   type :: assembly_tree_t
      integer(ip) :: n = 0, n_supernodes = 0                    !< equations; supernodes
      integer(ip), allocatable :: first(:) !< (n_supernodes + 1) positions of supernode p: first(p)..first(p + 1) - 1
      integer(ip), allocatable :: parent(:)                     !< (n_supernodes) 0 for the last
      integer(ip), allocatable :: n_descendants(:)              !< (n_supernodes) they stand just before the supernode
      integer(ip), allocatable :: first_child(:), next_child(:) !< (n_supernodes) in the order of the supernodes; 0: none
      integer(ip), allocatable :: border_size(:)                !< (n_supernodes) of those that are written
      integer(ip), allocatable :: class_of(:)                   !< (n_supernodes) for the caller
      integer(ip), allocatable :: first_element(:) !< (n_supernodes + 1) element(first_element(p):first_element(p + 1) - 1)
      integer(ip), allocatable :: element(:)                    !< sorted by the supernode that assembles them
      integer(ip), allocatable :: position(:)                   !< of the equations of the store; 0: prescribed
      integer(lp) :: longest = 0                                !< most equations of an element
      logical :: enough = .true.                                !< memory; the tree is of no use without
   end type assembly_tree_t

   !> Writes the records of supernodes that follow one another: of a subtree, or of what stands above subtrees.
   type :: record_writer_t
      integer(ip), allocatable :: record(:)                     !< (written or more) of the supernode in hand
      integer(lp) :: written = 0                                !< numbers of the record in hand
      logical :: enough = .true. !< memory, for all supernodes so far; nothing more is written without
      integer(ip), allocatable, private :: at(:)                !< (n) position in the front of the supernode in hand; 0: not in it
      integer(ip), allocatable, private :: border(:), buffer(:) !< (n) of that supernode; new ones for it
      integer(ip), private :: n_border = 0, n_new = 0           !< equations in `border`; in `buffer`
      integer(ip), allocatable, private :: stack(:)             !< borders of finished supernodes, the last one on top
      integer(lp), private :: top = 0                           !< entries on the stack
   end type record_writer_t

contains

   !> Sets up the tree of an elimination.
   !>
   !> A supernode without a parent is joined to the last one, that of the retained equations, so that there is one tree, even where
   !> a mesh is in several pieces. Children are listed from the last supernode down, each put first: the list of a parent rises.
   subroutine plant_tree(elimination, n, n_retained, store, tree)
      type(elimination_t), intent(in) :: elimination !< order of equations, and supernodes
      integer(ip), intent(in) :: n, n_retained       !< equations; the last ones of them, which are not eliminated
      type(element_store_t), intent(in) :: store     !< equations of the elements are read
      type(assembly_tree_t), intent(out) :: tree     !< borders and classes are not known yet
      integer(ip) :: p, m
      integer :: no_memory

      m = size(elimination%last, kind=ip) + 1
      tree%n = n
      tree%n_supernodes = m
      allocate (tree%first(m + 1), tree%border_size(m), tree%class_of(m), stat=no_memory)
      if (no_memory == 0) allocate (tree%parent(m), tree%n_descendants(m), tree%first_child(m), tree%next_child(m), source=0_ip, &
                                    stat=no_memory)
      tree%enough = no_memory == 0
      if (.not. tree%enough) return
      tree%first = [1_ip, elimination%last + 1, n + 1]
      tree%first(m) = n - n_retained + 1
      do p = 1, m - 1
         tree%parent(p) = elimination%parent(p)
         if (tree%parent(p) == 0) tree%parent(p) = m
         tree%n_descendants(tree%parent(p)) = tree%n_descendants(tree%parent(p)) + 1 + tree%n_descendants(p)
      end do
      do p = m - 1, 1, -1
         tree%next_child(p) = tree%first_child(tree%parent(p))
         tree%first_child(tree%parent(p)) = p
      end do
      call sort_elements(elimination, store, tree)
   end subroutine plant_tree

   !> An element belongs to the supernode that eliminates the first of its equations.
   subroutine sort_elements(elimination, store, tree)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(assembly_tree_t), intent(inout) :: tree
      integer(ip), allocatable :: supernode_at(:), supernode_of(:, :)
      integer(ip) :: p, e
      integer(lp) :: k
      integer :: no_memory

      allocate (supernode_at(0:tree%n), supernode_of(1, store%n), tree%position(store%start(store%n + 1)), stat=no_memory)
      tree%enough = no_memory == 0
      if (.not. tree%enough) return
      supernode_at(0) = huge(p)
      do p = 1, tree%n_supernodes
         supernode_at(tree%first(p):tree%first(p + 1) - 1) = p
      end do
      !$omp parallel do default(none) private(p, k) shared(elimination, store, tree, supernode_at, supernode_of) &
      !$omp if(is_shared(store%n))
      do e = 1, store%n
         p = huge(p)
         do k = store%start(e) + 1, store%start(e + 1)
            tree%position(k) = 0
            if (store%equations(k) > 0) tree%position(k) = elimination%position(store%equations(k))
            p = min(p, supernode_at(tree%position(k)))
         end do
         supernode_of(1, e) = merge(p, 0_ip, p <= tree%n_supernodes) ! 0: all of its equations are prescribed
      end do
      !$omp end parallel do
      call list_holders(tree%n_supernodes, supernode_of, tree%first_element, tree%element)
      tree%longest = maxval(store%start(2:store%n + 1) - store%start(:store%n))
   end subroutine sort_elements

   !> Gets ready to write the records of fronts, once; writer%enough is false where there is no memory for it.
   pure subroutine begin_writer(writer, n)
      type(record_writer_t), intent(inout) :: writer !< its stack is emptied; memory is asked for once
      integer(ip), intent(in) :: n                   !< equations
      integer(ip), parameter :: ROOM = 1024_ip
      integer :: no_memory

      writer%top = 0
      if (allocated(writer%at)) return
      allocate (writer%at(n), writer%border(n), writer%buffer(n), writer%stack(ROOM), writer%record(ROOM), stat=no_memory)
      writer%enough = no_memory == 0
      if (writer%enough) writer%at = 0
   end subroutine begin_writer

   !> Writes the record of a supernode; its children are the last ones that were written or pushed. Its border takes the place of
   !> theirs on the stack.
   subroutine write_supernode(store, tree, p, writer)
      type(element_store_t), intent(in) :: store     !< elements of the matrix; their values are not looked at
      type(assembly_tree_t), intent(inout) :: tree   !< gets the size of the supernode's border
      integer(ip), intent(in) :: p                   !< supernode whose record is written
      type(record_writer_t), intent(inout) :: writer !< gets the record; its stack changes
      integer(ip) :: child, n_children, n_elements, i, e
      integer(lp) :: base, length

      if (.not. writer%enough) return
      base = writer%top                          ! of the stack below the borders of the children
      n_children = 0
      child = tree%first_child(p)
      do while (child /= 0)
         n_children = n_children + 1
         base = base - tree%border_size(child)
         child = tree%next_child(child)
      end do
      call collect_border(writer)
      n_elements = tree%first_element(p + 1) - tree%first_element(p)
      length = HEADER + 2*n_children + writer%top - base + n_elements*(2 + tree%longest)
      if (length > size(writer%record, kind=lp)) call grow(writer%record, 2*length, writer%enough)
      if (.not. writer%enough) return
      writer%record(:HEADER) = [tree%first(p + 1) - tree%first(p), writer%n_border, n_children, n_elements]
      writer%written = HEADER
      call write_children(writer)
      do i = tree%first_element(p), tree%first_element(p + 1) - 1
         e = tree%element(i)
         call write_positions(tree, p, store%matrix_of(e), tree%position(store%start(e) + 1:store%start(e + 1)), writer)
      end do
      writer%at(writer%border(:writer%n_border)) = 0
      writer%top = base
      call push_border(writer, writer%border(:writer%n_border))
      tree%border_size(p) = writer%n_border

   contains

      !> The border of a supernode: the borders of its children and the equations of its elements, beyond its own, in order. `at`
      !> then holds the position in the front of each.
      pure subroutine collect_border(writer)
         type(record_writer_t), intent(inout) :: writer
         integer(ip) :: child, i, e
         integer(lp) :: from

         writer%n_border = 0
         from = base
         child = tree%first_child(p)
         do while (child /= 0)
            call take_new(writer%stack(from + 1:from + tree%border_size(child)), tree%first(p + 1), writer)
            call merge_new(writer)
            from = from + tree%border_size(child)
            child = tree%next_child(child)
         end do
         do i = tree%first_element(p), tree%first_element(p + 1) - 1
            e = tree%element(i)
            call take_new(tree%position(store%start(e) + 1:store%start(e + 1)), tree%first(p + 1), writer)
         end do
         call sort_new(writer%buffer(:writer%n_new))
         call merge_new(writer)
         do i = 1, writer%n_border
            writer%at(writer%border(i)) = tree%first(p + 1) - tree%first(p) + i
         end do
      end subroutine collect_border

      pure subroutine write_children(writer)
         type(record_writer_t), intent(inout) :: writer
         integer(ip) :: child
         integer(lp) :: from

         from = base
         child = tree%first_child(p)
         do while (child /= 0)
            call write_positions(tree, p, child, writer%stack(from + 1:from + tree%border_size(child)), writer)
            from = from + tree%border_size(child)
            child = tree%next_child(child)
         end do
      end subroutine write_children

   end subroutine write_supernode

   !> The border on top of the stack.
   pure function top_border(writer, n) result(border)
      type(record_writer_t), intent(in) :: writer !< is not changed: the border stays on the stack
      integer(ip), intent(in) :: n                !< its entries
      integer(ip) :: border(n)

      border = writer%stack(writer%top - n + 1:writer%top)
   end function top_border

   !> Puts a border on the stack.
   pure subroutine push_border(writer, border)
      type(record_writer_t), intent(inout) :: writer !< `enough` tells of the memory
      integer(ip), intent(in) :: border(:)           !< positions, ascending
      integer(ip) :: n

      n = size(border, kind=ip)
      if (writer%top + n > size(writer%stack, kind=lp)) call grow(writer%stack, 2*(writer%top + n), writer%enough)
      if (.not. writer%enough) return
      writer%stack(writer%top + 1:writer%top + n) = border
      writer%top = writer%top + n
   end subroutine push_border

   !> Takes the positions from a first one on that are not in the border into the buffer.
   pure subroutine take_new(positions, first, writer)
      integer(ip), intent(in) :: positions(:), first
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: i

      do i = 1, size(positions, kind=ip)
         if (positions(i) < first) cycle
         if (writer%at(positions(i)) /= 0) cycle
         writer%at(positions(i)) = 1
         writer%n_new = writer%n_new + 1
         writer%buffer(writer%n_new) = positions(i)
      end do
   end subroutine take_new

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

   !> Merges the buffer, which is sorted, into the border, and empties it.
   pure subroutine merge_new(writer)
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: i, k

      i = writer%n_border
      writer%n_border = i + writer%n_new
      do k = writer%n_border, 1, -1
         if (writer%n_new == 0) exit
         if (i > 0) then
            if (writer%border(i) > writer%buffer(writer%n_new)) then
               writer%border(k) = writer%border(i)
               i = i - 1
               cycle
            end if
         end if
         writer%border(k) = writer%buffer(writer%n_new)
         writer%n_new = writer%n_new - 1
      end do
   end subroutine merge_new

   !> Writes a child or a matrix, and where in the front of supernode p its positions are.
   pure subroutine write_positions(tree, p, name, positions, writer)
      type(assembly_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: p, name
      integer(ip), intent(in) :: positions(:)       !< in the order of elimination; 0: prescribed
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: i, m
      integer(lp) :: k

      m = size(positions, kind=ip)
      k = writer%written + 2
      writer%record(k - 1) = name
      writer%record(k) = m
      do i = 1, m
         if (positions(i) >= tree%first(p + 1)) then
            writer%record(k + i) = writer%at(positions(i))
         else
            writer%record(k + i) = max(positions(i) - tree%first(p) + 1, 0_ip)
         end if
      end do
      writer%written = k + m
   end subroutine write_positions

end module atrito_front_records
