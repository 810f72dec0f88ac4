!> Classes of equal fronts: a list of different records (atrito_front_records) in which a hash table finds the one that is asked.
!>
!> A front is the sum of the matrices of its own elements and of what its children leave. Two fronts are the same to the last bit
!> where they add the same element matrices at the same places, and children of the same classes, and eliminate as many unknowns:
!> then one of them is factored for all. The record of a front says that in whole numbers, with the classes of the children for
!> their numbers, so equality of records is equality of fronts, from the leaves up. In a mesh of equal elements that is cut in
!> halves again and again, only a few fronts a level of the tree are different. The hash of a record gives the slot to begin at; a
!> slot that another class has leads on to the next one, and the table is at most half full, so a few are looked at.
module atrito_front_classes
   use atrito_front_records, only: HEADER
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp
   implicit none (type, external)
   private
   public :: class_list_t, begin_classes, end_classes, find_class, name_classes, children_of

   type :: class_list_t
      integer(ip) :: n_classes = 0               !< numbered so that children come before their parents
      integer(lp), allocatable :: start(:)       !< (n_classes + 1 or more) record of class c: record(start(c) + 1:start(c + 1))
      integer(ip), allocatable :: record(:)      !< with the classes of the children
      integer(ip), allocatable :: representative(:) !< (n_classes or more) the first supernode of the class
      logical :: enough = .true.                 !< memory; the list is of no use without
      integer(ip), allocatable, private :: table(:) !< (0:) hash table of the classes, a power of two and one; 0: free
   end type class_list_t

contains

   !> An empty list, in which the records of so many supernodes will be looked up.
   pure subroutine begin_classes(list, n_supernodes)
      type(class_list_t), intent(inout) :: list !< nothing allocated in it
      integer(ip), intent(in) :: n_supernodes   !< not more are looked up
      integer(ip), parameter :: ROOM = 256_ip
      integer(ip) :: slots
      integer :: no_memory

      slots = 2
      do while (slots/2 < n_supernodes)
         slots = 2*slots
      end do
      allocate (list%start(ROOM), list%representative(ROOM), list%record(ROOM), list%table(0:slots), stat=no_memory)
      list%enough = no_memory == 0
      if (.not. list%enough) return
      list%start(1) = 0
      list%table = 0
   end subroutine begin_classes

   !> Gives back what only find_class needs.
   pure subroutine end_classes(list)
      type(class_list_t), intent(inout) :: list !< loses its hash table

      if (allocated(list%table)) deallocate (list%table)
   end subroutine end_classes

   !> Looks the record of a supernode up, with the classes of its children; it becomes a class when it is new.
   pure subroutine find_class(list, record, p, alone, found)
      type(class_list_t), intent(inout) :: list  !< a new class is added to it
      integer(ip), intent(in) :: record(:)       !< children by their classes (name_classes)
      integer(ip), intent(in) :: p               !< supernode, which stands for its class if that is new
      logical, intent(in) :: alone               !< a class of its own, whatever there is
      integer(ip), intent(out) :: found          !< of no use when there was not enough memory
      integer(ip) :: slot, range

      found = 0
      if (.not. list%enough) return
      range = size(list%table, kind=ip) - 1
      slot = hash(record, range)
      do
         found = list%table(slot)
         if (found == 0 .or. alone) exit
         if (is_class(list, found, record)) return
         slot = modulo(slot + 1, range)
      end do
      call add_class(list, p, record)
      found = list%n_classes
      list%table(slot) = found
   end subroutine find_class

   pure logical function is_class(list, class, record)
      type(class_list_t), intent(in) :: list
      integer(ip), intent(in) :: class, record(:)

      is_class = list%start(class + 1) - list%start(class) == size(record, kind=lp)
      if (is_class) is_class = all(list%record(list%start(class) + 1:list%start(class + 1)) == record)
   end function is_class

   pure subroutine add_class(list, p, record)
      type(class_list_t), intent(inout) :: list
      integer(ip), intent(in) :: p, record(:)
      integer(lp) :: first, last

      if (list%n_classes + 2 > size(list%start)) then
         call grow(list%start, 2*size(list%start, kind=lp), list%enough)
         if (list%enough) call grow(list%representative, 2*size(list%representative, kind=lp), list%enough)
      end if
      first = list%start(list%n_classes + 1)
      last = first + size(record, kind=lp)
      if (list%enough .and. last > size(list%record, kind=lp)) call grow(list%record, 2*last, list%enough)
      if (.not. list%enough) return
      list%record(first + 1:last) = record
      list%n_classes = list%n_classes + 1
      list%start(list%n_classes + 1) = last
      list%representative(list%n_classes) = p
   end subroutine add_class

   !> Puts the classes of the children in the place of their numbers.
   pure subroutine name_classes(class_of, record)
      integer(ip), intent(in) :: class_of(:)  !< (supernodes) of the children at least
      integer(ip), intent(inout) :: record(:) !< children by their supernodes; then by their classes
      integer(lp) :: k
      integer(ip) :: i

      k = HEADER
      do i = 1, record(3)
         record(k + 1) = class_of(record(k + 1))
         k = k + 2 + record(k + 2)
      end do
   end subroutine name_classes

   !> The classes of the children of a class.
   pure function children_of(list, c) result(children)
      class(class_list_t), intent(in) :: list !< complete
      integer(ip), intent(in) :: c            !< 1 .. n_classes
      integer(ip), allocatable :: children(:)
      integer(lp) :: k
      integer(ip) :: i

      allocate (children(list%record(list%start(c) + 3)))
      k = list%start(c) + HEADER
      do i = 1, size(children, kind=ip)
         children(i) = list%record(k + 1)
         k = k + 2 + list%record(k + 2)
      end do
   end function children_of

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

end module atrito_front_classes
