!> The classes of the fronts of a multifrontal elimination, found before any number is computed.
!>
!> A part of the elimination has a front: its own equations (the pivots) and those of its ancestors that its subtree couples to
!> (the border). Parts of the same class have the same elements, children of the same classes, and the same places for them in the
!> front (atrito_front_records): their fronts are the same numbers, and one factorisation serves them all. A regular mesh has a few
!> hundred classes where an irregular one has as many as parts.
!>
!> Reference: J. W. H. Liu, SIAM Review 34 (1992) 82-109.
module atrito_front_tree
   use atrito_element_store, only: element_store_t
   use atrito_elimination, only: elimination_t
   use atrito_front_classes, only: class_list_t, begin_classes, end_classes, find_class, name_classes
   use atrito_front_records, only: part_tree_t, record_writer_t, plant_tree, begin_writer, write_part, push_border, &
                                   top_border, HEADER
   use atrito_kinds, only: ip
   use atrito_threads, only: n_threads, this_thread
   implicit none (type, external)
   private
   public :: front_tree_t, build_front_tree, HEADER

   !> The parts and the classes of their fronts. The last part holds the kept equations and is never eliminated.
   type, extends(class_list_t) :: front_tree_t
      integer(ip) :: n_parts = 0
      integer(ip), allocatable :: first(:)       !< (n_parts + 1) places of part p: first(p)..first(p + 1) - 1
      integer(ip), allocatable :: class_of(:)    !< (n_parts)
      integer(ip), allocatable :: parent(:)      !< (n_parts) 0 for the last
      integer(ip), allocatable :: n_descendants(:) !< (n_parts) they stand just before the part
   end type front_tree_t

   !> A subtree whose classes are found by one thread.
   type :: unit_t
      integer(ip) :: first = 0, last = 0         !< parts
      type(class_list_t) :: classes              !< of these parts alone
      integer(ip), allocatable :: border(:)      !< of the last part; not allocated: the memory did not suffice
   end type unit_t

   !> A unit has at most this share of the parts, and there are units from so many parts on.
   integer(ip), parameter :: MOST_UNITS = 32_ip, WORTH_SHARING = 2048_ip

contains

   !> Finds the fronts and their classes.
   subroutine build_front_tree(elimination, n, n_kept, store, tree)
      type(elimination_t), intent(in) :: elimination
      integer(ip), intent(in) :: n, n_kept
      type(element_store_t), intent(in) :: store
      type(front_tree_t), intent(out) :: tree
      type(part_tree_t) :: parts
      type(unit_t), allocatable :: units(:)
      integer(ip), allocatable :: waiting(:)
      integer :: no_memory

      tree%enough = store%enough
      if (tree%enough) call plant_tree(elimination, n, n_kept, store, parts)
      tree%enough = tree%enough .and. parts%enough
      if (.not. tree%enough) return
      tree%n_parts = parts%n_parts
      allocate (waiting(parts%n_parts), tree%class_of(parts%n_parts), stat=no_memory)
      tree%enough = no_memory == 0
      if (.not. tree%enough) return
      call find_units(parts, units)
      call find_classes_of_units(elimination, store, parts, n, waiting, units, tree%class_of)
      call find_classes(elimination, store, parts, n, waiting, units, tree)
      call end_classes(tree%class_list_t)
      call move_alloc(parts%first, tree%first)
      call move_alloc(parts%parent, tree%parent)
      call move_alloc(parts%n_descendants, tree%n_descendants)
   end subroutine build_front_tree

   !> The largest subtrees of at most the share of a unit; none where that is not worth it.
   pure subroutine find_units(parts, units)
      type(part_tree_t), intent(in) :: parts
      type(unit_t), allocatable, intent(out) :: units(:)
      integer(ip) :: p, most, n, list(parts%n_parts)

      most = parts%n_parts/MOST_UNITS
      if (parts%n_parts < WORTH_SHARING) most = 0
      n = 0
      do p = 1, parts%n_parts - 1
         if (parts%n_descendants(p) >= most .or. parts%n_descendants(parts%parent(p)) < most) cycle
         n = n + 1
         list(n) = p
      end do
      allocate (units(n))
      do p = 1, n
         units(p)%first = list(p) - parts%n_descendants(list(p))
         units(p)%last = list(p)
      end do
   end subroutine find_units

   !> Finds the classes of each unit by itself. The threads' places for work are made anew: a thread has one for all of its units.
   subroutine find_classes_of_units(elimination, store, parts, n, waiting, units, class_of)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: parts
      integer(ip), intent(in) :: n
      integer(ip), intent(inout) :: waiting(:)
      type(unit_t), intent(inout) :: units(:)
      integer(ip), intent(inout) :: class_of(:)  !< set for the parts of the units: among the classes of the unit
      type(record_writer_t), allocatable :: writers(:)
      integer(ip) :: u

      if (size(units) == 0) return
      allocate (writers(n_threads()))
      !$omp parallel do schedule(dynamic, 1) default(none) &
      !$omp shared(elimination, store, parts, n, waiting, units, class_of, writers)
      do u = 1, size(units, kind=ip)
         call find_classes_of_unit(elimination, store, parts, n, waiting, units(u), class_of, writers(this_thread()))
      end do
      !$omp end parallel do
   end subroutine find_classes_of_units

   subroutine find_classes_of_unit(elimination, store, parts, n, waiting, unit, class_of, writer)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: parts
      integer(ip), intent(in) :: n
      integer(ip), intent(inout) :: waiting(:)
      type(unit_t), intent(inout) :: unit
      integer(ip), intent(inout) :: class_of(:)
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: p

      call begin_writer(writer, n)
      call begin_classes(unit%classes, unit%last - unit%first + 1)
      do p = unit%first, unit%last
         call write_part(elimination, store, parts, p, waiting, writer)
         if (.not. (writer%enough .and. unit%classes%enough)) return
         call class_of_part(writer, p, .false., class_of, unit%classes)
      end do
      call end_classes(unit%classes)
      if (unit%classes%enough) unit%border = top_border(writer, waiting(unit%last))
   end subroutine find_classes_of_unit

   !> The class of the part whose record was written last.
   pure subroutine class_of_part(writer, p, alone, class_of, classes)
      type(record_writer_t), intent(inout) :: writer
      integer(ip), intent(in) :: p
      logical, intent(in) :: alone
      integer(ip), intent(inout) :: class_of(:)
      type(class_list_t), intent(inout) :: classes

      call name_classes(class_of, writer%record(:writer%written))
      call find_class(classes, writer%record(:writer%written), p, alone, class_of(p))
   end subroutine class_of_part

   !> Goes through all parts: those of units have their classes, which join those of all; those above them find theirs now. Their
   !> numbers are those that one part after the other would give.
   subroutine find_classes(elimination, store, parts, n, waiting, units, tree)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: parts
      integer(ip), intent(in) :: n
      integer(ip), intent(inout) :: waiting(:)
      type(unit_t), intent(inout) :: units(:)
      type(front_tree_t), intent(inout) :: tree
      type(record_writer_t) :: writer
      integer(ip) :: p, u

      do u = 1, size(units, kind=ip)
         tree%enough = tree%enough .and. allocated(units(u)%border)
      end do
      if (tree%enough) call begin_classes(tree%class_list_t, parts%n_parts)
      if (tree%enough) call begin_writer(writer, n)
      p = 1
      u = 1
      do while (p <= parts%n_parts)
         tree%enough = tree%enough .and. writer%enough
         if (.not. tree%enough) return
         if (u <= size(units)) then
            if (p == units(u)%first) then
               call join_classes(units(u), tree)
               call push_border(writer, units(u)%border)
               p = units(u)%last + 1
               u = u + 1
               cycle
            end if
         end if
         call write_part(elimination, store, parts, p, waiting, writer)
         ! the last part is not eliminated: its front is of another kind
         if (writer%enough) call class_of_part(writer, p, p == parts%n_parts, tree%class_of, tree%class_list_t)
         p = p + 1
      end do
      tree%enough = tree%enough .and. writer%enough
   end subroutine find_classes

   !> Looks the classes of a unit up among those of all, and names its parts after them.
   subroutine join_classes(unit, tree)
      type(unit_t), intent(inout) :: unit        !< its classes are given back
      type(front_tree_t), intent(inout) :: tree
      integer(ip) :: class_of(unit%classes%n_classes), c, p

      do c = 1, unit%classes%n_classes
         associate (record => unit%classes%record(unit%classes%start(c) + 1:unit%classes%start(c + 1)))
            call name_classes(class_of, record)
            call find_class(tree%class_list_t, record, unit%classes%representative(c), .false., class_of(c))
         end associate
      end do
      do p = unit%first, unit%last
         tree%class_of(p) = class_of(tree%class_of(p))
      end do
      unit%classes = class_list_t()
   end subroutine join_classes

end module atrito_front_tree
