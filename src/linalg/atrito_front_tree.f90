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
   use atrito_front_records, only: part_tree_t, record_writer_t, plant_tree, begin_writer, write_part, push_border, &
                                   top_border, HEADER
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp
   use atrito_threads, only: n_threads, this_thread
   implicit none (type, external)
   private
   public :: front_tree_t, build_front_tree, HEADER

   !> The last part holds the kept equations and is never eliminated.
   type :: front_tree_t
      integer(ip) :: n_parts = 0
      integer(ip), allocatable :: first(:)       !< (n_parts + 1) places of part p: first(p)..first(p + 1) - 1
      integer(ip), allocatable :: class_of(:)    !< (n_parts)
      integer(ip), allocatable :: parent(:)      !< (n_parts) 0 for the last
      integer(ip), allocatable :: n_descendants(:) !< (n_parts) they stand just before the part
      integer(ip) :: n_classes = 0               !< numbered so that children come before their parents
      integer(lp), allocatable :: start(:)       !< (n_classes + 1 or more) record of class c: record(start(c) + 1:start(c + 1))
      integer(ip), allocatable :: record(:)      !< records of atrito_front_records, with the classes of the children
      integer(ip), allocatable :: representative(:) !< (n_classes or more) the first part of the class
      logical :: enough = .true.                 !< memory; the tree is of no use without
   end type front_tree_t

   !> A subtree whose records are written by one thread.
   type :: unit_t
      integer(ip) :: first = 0, last = 0         !< parts
      integer(ip), allocatable :: record(:)      !< not allocated: the memory did not suffice
      integer(ip), allocatable :: border(:)      !< of the last part
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

      tree%enough = store%enough
      if (tree%enough) call plant_tree(elimination, n, n_kept, store, parts)
      tree%enough = tree%enough .and. parts%enough
      if (.not. tree%enough) return
      allocate (waiting(parts%n_parts))
      call find_units(parts, units)
      call write_units(elimination, store, parts, n, waiting, units)
      call find_classes(elimination, store, parts, n, waiting, units, tree)
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

   !> Writes the records of the units. The threads' places for work are made anew: a thread has one for all of its units.
   subroutine write_units(elimination, store, parts, n, waiting, units)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: parts
      integer(ip), intent(in) :: n
      integer(ip), intent(inout) :: waiting(:)
      type(unit_t), intent(inout) :: units(:)
      type(record_writer_t), allocatable :: writers(:)
      integer(ip) :: u

      if (size(units) == 0) return
      allocate (writers(n_threads()))
      !$omp parallel do schedule(dynamic, 1) default(none) shared(elimination, store, parts, n, waiting, units, writers)
      do u = 1, size(units, kind=ip)
         call write_unit(elimination, store, parts, n, waiting, units(u), writers(this_thread()))
      end do
      !$omp end parallel do
   end subroutine write_units

   subroutine write_unit(elimination, store, parts, n, waiting, unit, writer)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: parts
      integer(ip), intent(in) :: n
      integer(ip), intent(inout) :: waiting(:)
      type(unit_t), intent(inout) :: unit
      type(record_writer_t), intent(inout) :: writer
      integer(ip) :: p

      call begin_writer(writer, n)
      do p = unit%first, unit%last
         call write_part(elimination, store, parts, p, waiting, writer)
      end do
      if (.not. writer%enough) return
      call move_alloc(writer%record, unit%record)
      unit%border = top_border(writer, waiting(unit%last))
   end subroutine write_unit

   !> Goes through all parts: those of units have their records, those above them write theirs now.
   subroutine find_classes(elimination, store, parts, n, waiting, units, tree)
      type(elimination_t), intent(in) :: elimination
      type(element_store_t), intent(in) :: store
      type(part_tree_t), intent(in) :: parts
      integer(ip), intent(in) :: n
      integer(ip), intent(inout) :: waiting(:)
      type(unit_t), intent(inout) :: units(:)
      type(front_tree_t), intent(inout) :: tree
      type(record_writer_t) :: writer
      integer(ip), allocatable :: table(:)
      integer(ip) :: p, u

      do u = 1, size(units, kind=ip)
         tree%enough = tree%enough .and. allocated(units(u)%record)
      end do
      if (tree%enough) call begin_tree(parts%n_parts, tree, table)
      if (tree%enough) call begin_writer(writer, n)
      p = 1
      u = 1
      do while (p <= parts%n_parts)
         tree%enough = tree%enough .and. writer%enough
         if (.not. tree%enough) return
         if (u <= size(units)) then
            if (p == units(u)%first) then
               call find_classes_of_unit(units(u), table, tree)
               call push_border(writer, units(u)%border)
               p = units(u)%last + 1
               u = u + 1
               cycle
            end if
         end if
         writer%written = 0
         call write_part(elimination, store, parts, p, waiting, writer)
         if (writer%enough) call find_class(writer%record(:writer%written), p, table, tree)
         p = p + 1
      end do
      tree%enough = tree%enough .and. writer%enough
   end subroutine find_classes

   pure subroutine find_classes_of_unit(unit, table, tree)
      type(unit_t), intent(inout) :: unit        !< its record is given back
      integer(ip), intent(inout) :: table(0:)
      type(front_tree_t), intent(inout) :: tree
      integer(ip) :: p
      integer(lp) :: next, length

      next = 0
      do p = unit%first, unit%last
         length = record_length(unit%record(next + 1:))
         call find_class(unit%record(next + 1:next + length), p, table, tree)
         next = next + length
      end do
      deallocate (unit%record)
   end subroutine find_classes_of_unit

   pure subroutine begin_tree(n_parts, tree, table)
      integer(ip), intent(in) :: n_parts
      type(front_tree_t), intent(inout) :: tree
      integer(ip), allocatable, intent(out) :: table(:) !< (0:) a power of two from twice the parts on, and one
      integer(ip), parameter :: ROOM = 256_ip
      integer(ip) :: slots
      integer :: no_memory

      tree%n_parts = n_parts
      slots = 2
      do while (slots/2 < n_parts)
         slots = 2*slots
      end do
      allocate (tree%class_of(n_parts), tree%start(ROOM), tree%representative(ROOM), tree%record(ROOM), table(0:slots), &
                stat=no_memory)
      tree%enough = no_memory == 0
      if (.not. tree%enough) return
      tree%start(1) = 0
      table = 0
   end subroutine begin_tree

   !> Looks the record of a part up among the classes; it becomes a class when it is new, and always for the last part, which is
   !> not eliminated.
   pure subroutine find_class(record, p, table, tree)
      integer(ip), intent(inout) :: record(:)    !< the classes of the children take the place of their numbers
      integer(ip), intent(in) :: p
      integer(ip), intent(inout) :: table(0:)    !< hash table of the classes; 0: free
      type(front_tree_t), intent(inout) :: tree
      integer(ip) :: slot, class

      if (.not. tree%enough) return
      call name_classes(tree%class_of, record)
      slot = hash(record, size(table, kind=ip) - 1)
      do
         class = table(slot)
         if (class == 0 .or. p == tree%n_parts) exit
         if (is_class(tree, class, record)) exit
         slot = modulo(slot + 1, size(table, kind=ip) - 1)
      end do
      if (class == 0 .or. p == tree%n_parts) then
         call add_class(tree, p, record)
         if (.not. tree%enough) return
         class = tree%n_classes
         table(slot) = class
      end if
      tree%class_of(p) = class
   end subroutine find_class

   pure logical function is_class(tree, class, record)
      type(front_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: class, record(:)

      is_class = tree%start(class + 1) - tree%start(class) == size(record, kind=lp)
      if (is_class) is_class = all(tree%record(tree%start(class) + 1:tree%start(class + 1)) == record)
   end function is_class

   pure subroutine add_class(tree, p, record)
      type(front_tree_t), intent(inout) :: tree
      integer(ip), intent(in) :: p, record(:)
      integer(lp) :: first, last

      if (tree%n_classes + 2 > size(tree%start)) then
         call grow(tree%start, 2*size(tree%start, kind=lp), tree%enough)
         if (tree%enough) call grow(tree%representative, 2*size(tree%representative, kind=lp), tree%enough)
      end if
      first = tree%start(tree%n_classes + 1)
      last = first + size(record, kind=lp)
      if (tree%enough .and. last > size(tree%record, kind=lp)) call grow(tree%record, 2*last, tree%enough)
      if (.not. tree%enough) return
      tree%record(first + 1:last) = record
      tree%n_classes = tree%n_classes + 1
      tree%start(tree%n_classes + 1) = last
      tree%representative(tree%n_classes) = p
   end subroutine add_class

   pure integer(lp) function record_length(record) result(length)
      integer(ip), intent(in) :: record(:)       !< and what follows it
      integer(ip) :: i

      length = HEADER
      do i = 1, record(3) + record(4)
         length = length + 2 + record(length + 2)
      end do
   end function record_length

   pure subroutine name_classes(class_of, record)
      integer(ip), intent(in) :: class_of(:)
      integer(ip), intent(inout) :: record(:)
      integer(lp) :: k
      integer(ip) :: i

      k = HEADER
      do i = 1, record(3)
         record(k + 1) = class_of(record(k + 1))
         k = k + 2 + record(k + 2)
      end do
   end subroutine name_classes

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

end module atrito_front_tree
