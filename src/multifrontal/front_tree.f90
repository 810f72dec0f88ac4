!> The classes of the fronts of a multifrontal elimination, found before any number is computed.
!>
!> A supernode has a front: its own equations (the pivots) and those of its ancestors that its subtree couples to (the border).
!> Supernodes of the same class have the same elements, children of the same classes, and the same positions for them in the
!> front (atrito_front_records): their fronts are the same numbers, and one factorisation serves them all. A regular mesh has a few
!> hundred classes where an irregular one has as many as supernodes.
!>
!> Reference: J. W. H. Liu, SIAM Review 34 (1992) 82-109.
module atrito_front_tree
   use atrito_element_store, only: element_store_t
   use atrito_elimination, only: elimination_t
   use atrito_front_classes, only: class_list_t, begin_classes, end_classes, find_class, name_classes
   use atrito_front_records, only: assembly_tree_t, record_writer_t, plant_tree, begin_writer, write_supernode, push_border, &
                                   top_border
   use atrito_kinds, only: ip, wp
   use atrito_threads, only: n_threads, this_thread
   implicit none (type, external)
   private
   public :: front_tree_t, subtree_t, build_front_tree, cut_subtrees

   !> The supernodes and the classes of their fronts. The last supernode holds the retained equations and is never eliminated.
   type, extends(class_list_t) :: front_tree_t
      integer(ip) :: n_supernodes = 0              !< the retained equations count as one
      integer(ip), allocatable :: first(:)         !< (n_supernodes + 1) positions of supernode p: first(p)..first(p + 1) - 1
      integer(ip), allocatable :: class_of(:)      !< (n_supernodes)
      integer(ip), allocatable :: parent(:)        !< (n_supernodes) 0 for the last
      integer(ip), allocatable :: n_descendants(:) !< (n_supernodes) they stand just before the supernode
   end type front_tree_t

   !> Supernodes first..last.
   type :: subtree_t
      integer(ip) :: first = 0, last = 0 !< places in postorder
   end type subtree_t

   !> The classes of a subtree, found by one thread.
   type :: subtree_classes_t
      type(class_list_t) :: classes              !< of these supernodes alone
      integer(ip), allocatable :: border(:)      !< of the last supernode; not allocated: the memory did not suffice
   end type subtree_classes_t

   !> A subtree of one thread has at most this share of the supernodes, and there are some from so many supernodes on.
   real(wp), parameter :: SHARE = 1.0_wp/32.0_wp
   integer(ip), parameter :: WORTH_SHARING = 2048_ip

contains

   !> Finds the fronts and their classes.
   subroutine build_front_tree(elimination, n, n_retained, store, tree)
      type(elimination_t), intent(in) :: elimination !< order of equations, and supernodes
      integer(ip), intent(in) :: n, n_retained       !< equations; the last ones of them, which are not eliminated
      type(element_store_t), intent(in) :: store     !< elements of the matrix; their values are not looked at
      type(front_tree_t), intent(out) :: tree        !< `enough` is false where the memory did not suffice
      type(assembly_tree_t) :: assembly
      type(subtree_t), allocatable :: subtrees(:)
      type(subtree_classes_t), allocatable :: found(:)
      type(record_writer_t), allocatable :: writers(:)
      real(wp), allocatable :: work(:)
      integer(ip) :: u

      tree%enough = store%enough
      if (tree%enough) call plant_tree(elimination, n, n_retained, store, assembly)
      tree%enough = tree%enough .and. assembly%enough
      if (.not. tree%enough) return
      tree%n_supernodes = assembly%n_supernodes
      allocate (work(assembly%n_supernodes), source=1.0_wp)
      call cut_subtrees(assembly%parent, assembly%n_descendants, merge(SHARE, 0.0_wp, tree%n_supernodes >= WORTH_SHARING), work, &
                        subtrees)
      allocate (found(size(subtrees)))
      allocate (writers(n_threads()))
      !$omp parallel do schedule(dynamic, 1) default(none) shared(store, subtrees, assembly, found, writers) if(size(subtrees) > 0)
      do u = 1, size(subtrees, kind=ip)          ! a thread has one writer for all of its subtrees
         call find_classes_of_subtree(store, subtrees(u), assembly, found(u), writers(this_thread()))
      end do
      !$omp end parallel do
      call find_classes(store, subtrees, assembly, found, tree)
      call end_classes(tree%class_list_t)
      call move_alloc(assembly%first, tree%first)
      call move_alloc(assembly%class_of, tree%class_of)
      call move_alloc(assembly%parent, tree%parent)
      call move_alloc(assembly%n_descendants, tree%n_descendants)
   end subroutine build_front_tree

   !> The largest subtrees of at most a share of the work. The last supernode belongs to none.
   !>
   !> Supernodes are in postorder: those of a subtree stand one behind the other, just before its root, so a subtree is a range.
   !> Work is summed up from children to parents in one pass, since parents come later; then a supernode is the root of a subtree
   !> of the list if its own work is not above the share and that of its parent is. So no subtree of the list lies in another one,
   !> and what is in none of them are the few large supernodes near the root. The cut depends on the tree alone, not on the number
   !> of threads.
   pure subroutine cut_subtrees(parent, n_descendants, share, work, subtrees)
      integer(ip), intent(in) :: parent(:), n_descendants(:)   !< (n_supernodes)
      real(wp), intent(in) :: share                            !< of all work, 0 .. 1; 0: no subtree
      real(wp), intent(inout) :: work(:)                       !< (n_supernodes) of each; becomes that of its subtree
      type(subtree_t), allocatable, intent(out) :: subtrees(:) !< ascending, without common supernodes
      integer(ip) :: list(size(parent)), p, n
      real(wp) :: most

      most = share*sum(work)
      n = 0
      do p = 1, size(parent, kind=ip) - 1
         work(parent(p)) = work(parent(p)) + work(p)
      end do
      do p = 1, size(parent, kind=ip) - 1
         if (work(p) > most .or. work(parent(p)) <= most) cycle
         n = n + 1
         list(n) = p
      end do
      subtrees = [(subtree_t(list(p) - n_descendants(list(p)), list(p)), p=1, n)]
   end subroutine cut_subtrees

   !> Finds the classes of a subtree by itself.
   subroutine find_classes_of_subtree(store, subtree, assembly, found, writer)
      type(element_store_t), intent(in) :: store
      type(subtree_t), intent(in) :: subtree
      type(assembly_tree_t), intent(inout) :: assembly
      type(subtree_classes_t), intent(inout) :: found
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: p

      call begin_writer(writer, assembly%n)
      call begin_classes(found%classes, subtree%last - subtree%first + 1)
      do p = subtree%first, subtree%last
         call find_class_of_supernode(store, p, assembly, writer, found%classes)
         if (.not. (writer%enough .and. found%classes%enough)) return
      end do
      call end_classes(found%classes)
      found%border = top_border(writer, assembly%border_size(subtree%last))
   end subroutine find_classes_of_subtree

   subroutine find_class_of_supernode(store, p, assembly, writer, classes)
      type(element_store_t), intent(in) :: store
      integer(ip), intent(in) :: p
      type(assembly_tree_t), intent(inout) :: assembly
      type(record_writer_t), intent(inout) :: writer
      type(class_list_t), intent(inout) :: classes

      call write_supernode(store, assembly, p, writer)
      if (.not. writer%enough) return
      call name_classes(assembly%class_of, writer%record(:writer%written))
      ! the last supernode is not eliminated: its front is of another kind
      call find_class(classes, writer%record(:writer%written), p, p == assembly%n_supernodes, assembly%class_of(p))
   end subroutine find_class_of_supernode

   !> Goes through all supernodes: those of subtrees have their classes, which join those of all; those above find theirs now. Their
   !> numbers are those that one supernode after the other would give.
   subroutine find_classes(store, subtrees, assembly, found, tree)
      type(element_store_t), intent(in) :: store
      type(subtree_t), intent(in) :: subtrees(:)
      type(assembly_tree_t), intent(inout) :: assembly
      type(subtree_classes_t), intent(inout) :: found(:)
      type(front_tree_t), intent(inout) :: tree
      type(record_writer_t) :: writer
      integer(ip) :: p, u, next, last

      call begin_classes(tree%class_list_t, assembly%n_supernodes)
      call begin_writer(writer, assembly%n)
      next = 1
      do u = 1, size(subtrees, kind=ip) + 1
         last = assembly%n_supernodes
         if (u <= size(subtrees)) last = subtrees(u)%first - 1
         do p = next, last
            tree%enough = tree%enough .and. writer%enough
            if (.not. tree%enough) return
            call find_class_of_supernode(store, p, assembly, writer, tree%class_list_t)
         end do
         if (u > size(subtrees)) exit
         tree%enough = tree%enough .and. writer%enough .and. allocated(found(u)%border)
         if (.not. tree%enough) return
         call join_classes(subtrees(u), found(u)%classes, assembly, tree)
         call push_border(writer, found(u)%border)
         next = subtrees(u)%last + 1
      end do
      tree%enough = tree%enough .and. writer%enough
   end subroutine find_classes

   !> Looks the classes of a subtree up among those of all, and names its supernodes after them.
   subroutine join_classes(subtree, classes, assembly, tree)
      type(subtree_t), intent(in) :: subtree
      type(class_list_t), intent(inout) :: classes !< given back
      type(assembly_tree_t), intent(inout) :: assembly
      type(front_tree_t), intent(inout) :: tree
      integer(ip) :: class_of(classes%n_classes), c

      do c = 1, classes%n_classes
         associate (record => classes%record(classes%start(c) + 1:classes%start(c + 1)))
            call name_classes(class_of, record)
            call find_class(tree%class_list_t, record, classes%representative(c), .false., class_of(c))
         end associate
      end do
      associate (own => assembly%class_of(subtree%first:subtree%last))
         own = class_of(own)
      end associate
      classes = class_list_t()
   end subroutine join_classes

end module atrito_front_tree
