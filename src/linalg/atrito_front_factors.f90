!> The factors of the classes of fronts.
!>
!> Classes are factored in units: all that are new in a subtree of little work, and every other by itself. Units that need nothing
!> of one another make a wave, and are tasks side by side. How the work is cut depends on the tree alone: the numbers are the
!> same for any number of threads.
module atrito_front_factors
   use atrito_element_store, only: element_store_t
   use atrito_front, only: clear_front, eliminate, add_element, add_update, pack_columns, packed_length
   use atrito_front_tree, only: front_tree_t, HEADER
   use atrito_kinds, only: ip, lp, wp
   use atrito_storage, only: smallest_ratio
   use atrito_threads, only: n_threads, this_thread
   implicit none (type, external)
   private
   public :: factor_t, factor_fronts, begin_factors, factor_class, expect_factors, add_class
   public :: front_bytes_t, CHUNK_BYTES

   !> The factor of a class of fronts.
   type :: factor_t
      integer(ip) :: order = 0, n_pivots = 0
      real(wp), allocatable :: columns(:)        !< those of L, packed from the diagonal down
      real(wp), allocatable :: update(:)         !< what is left of the border, packed, until the last parent has taken it
      integer(ip) :: waiting = 0                 !< fronts that have not taken it
      logical :: done = .false.                  !< with usable pivots
      logical :: enough = .true.                 !< memory for it, its front and its update
      integer(ip) :: failed = 0                  !< pivot that could not be used
      integer(ip) :: worst = 0                   !< pivot that lost most
      real(wp) :: worst_pivot = 0.0_wp, smallest_pivot = 0.0_wp, largest_pivot = 0.0_wp
   end type factor_t

   !> What fronts take [bytes].
   type :: front_bytes_t
      integer(lp) :: held = 0                    !< with the updates that wait
      integer(lp) :: most = 0                    !< at a time so far
   end type front_bytes_t

   !> Classes first..last, which are factored one after the other.
   type :: unit_t
      integer(ip) :: first = 0, last = 0
      integer(ip) :: wave = 1
   end type unit_t

   !> Where a thread assembles the fronts of its units, one after the other: memory that is asked for anew for each large front
   !> has to be made by the system every time. A unit is a tied task, so no other one of its thread comes between.
   type :: workspace_t
      real(wp), allocatable :: front(:)
   end type workspace_t

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8
   !> What the C library adds to each array.
   integer(lp), parameter :: CHUNK_BYTES = 16_lp

   !> A unit has at most this share of the work, unless it is a single class.
   real(wp), parameter :: SHARE = 1.0_wp/64.0_wp
   !> Operations that are worth waking other threads.
   real(wp), parameter :: WORTH_SHARING = 1.0e7_wp

contains

   !> Factors all classes. The last one, of the kept equations, is assembled only: its lower triangle, packed, is its update.
   subroutine factor_fronts(tree, store, diagonal, factors, enough)
      type(front_tree_t), intent(in) :: tree
      type(element_store_t), intent(in) :: store
      real(wp), intent(in) :: diagonal(:)        !< (n) of the matrix, by places
      type(factor_t), allocatable, intent(out) :: factors(:)
      logical, intent(out) :: enough             !< memory; the factors are of no use without
      type(unit_t), allocatable :: units(:)
      real(wp) :: work(tree%n_classes)

      call begin_factors(tree, factors, enough)
      if (.not. enough) return
      work = front_flops(factors%order, factors%n_pivots)
      work(tree%n_classes) = 0.0_wp
      call make_units(tree, work, units)
      !$omp parallel default(none) shared(tree, store, diagonal, factors, units) if(sum(work) > WORTH_SHARING)
      !$omp single
      call factor_waves(tree, store, diagonal, units, factors)
      !$omp end single
      !$omp end parallel
      enough = all(factors%enough)
   end subroutine factor_fronts

   !> What factor_fronts will take, before it does: its classes in its order, with one thread; and a front for each thread.
   subroutine expect_factors(tree, bytes, enough)
      type(front_tree_t), intent(in) :: tree
      type(front_bytes_t), intent(out) :: bytes
      logical, intent(out) :: enough             !< memory to tell
      type(factor_t), allocatable :: factors(:)
      type(unit_t), allocatable :: units(:)
      real(wp) :: work(tree%n_classes)
      integer(ip) :: wave, u, c

      call begin_factors(tree, factors, enough)
      if (.not. enough) return
      work = front_flops(factors%order, factors%n_pivots)
      work(tree%n_classes) = 0.0_wp
      call make_units(tree, work, units)
      factors(tree%n_classes)%n_pivots = 0
      bytes%held = tree%n_classes*(storage_size(factors, kind=lp)/8)
      do wave = 1, maxval(units%wave)
         do u = 1, size(units, kind=ip)
            if (units(u)%wave /= wave) cycle
            do c = units(u)%first, units(u)%last
               call add_class(tree, c, factors, bytes)
            end do
         end do
      end do
      bytes%most = bytes%most + n_threads()*(REAL_BYTES*int(maxval(factors%order), lp)**2)
   end subroutine expect_factors

   !> Counts a class as factor_class will make it: what its children leave is given back with their last parent.
   pure subroutine add_class(tree, c, factors, bytes)
      type(front_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: c
      type(factor_t), intent(inout) :: factors(:) !< nothing but `waiting` changes
      type(front_bytes_t), intent(inout) :: bytes
      integer(ip) :: i, child
      integer(lp) :: k

      k = tree%start(c) + HEADER
      do i = 1, tree%record(tree%start(c) + 3)
         child = tree%record(k + 1)
         factors(child)%waiting = factors(child)%waiting - 1
         if (factors(child)%waiting == 0) bytes%held = bytes%held - update_bytes(factors(child))
         k = k + 2 + tree%record(k + 2)
      end do
      bytes%held = bytes%held + column_bytes(factors(c)) + update_bytes(factors(c))
      bytes%most = max(bytes%most, bytes%held)
   end subroutine add_class

   pure elemental integer(lp) function column_bytes(factor) result(bytes)
      type(factor_t), intent(in) :: factor

      bytes = REAL_BYTES*packed_length(factor%order, factor%n_pivots) + CHUNK_BYTES
   end function column_bytes

   pure elemental integer(lp) function update_bytes(factor) result(bytes)
      type(factor_t), intent(in) :: factor
      integer(ip) :: m

      m = factor%order - factor%n_pivots
      bytes = REAL_BYTES*packed_length(m, m) + CHUNK_BYTES
   end function update_bytes

   !> The sizes of all fronts, and how many parents wait for each; nothing is factored yet.
   pure subroutine begin_factors(tree, factors, enough)
      type(front_tree_t), intent(in) :: tree
      type(factor_t), allocatable, intent(out) :: factors(:)
      logical, intent(out) :: enough             !< memory
      integer(ip) :: c
      integer :: no_memory

      allocate (factors(tree%n_classes), stat=no_memory)
      enough = no_memory == 0
      if (.not. enough) return
      do c = 1, tree%n_classes
         factors(c)%n_pivots = tree%record(tree%start(c) + 1)
         factors(c)%order = factors(c)%n_pivots + tree%record(tree%start(c) + 2)
         call count_children(tree, c, factors)
      end do
   end subroutine begin_factors

   !> Operations of the elimination of a front.
   pure elemental real(wp) function front_flops(order, n_pivots) result(flops)
      integer(ip), intent(in) :: order, n_pivots
      real(wp) :: n, m

      n = real(n_pivots, wp)
      m = real(order - n_pivots, wp)
      flops = n*(n*n/3.0_wp + m*n + m*m)
   end function front_flops

   pure subroutine count_children(tree, c, factors)
      type(front_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: c
      type(factor_t), intent(inout) :: factors(:)
      integer(ip) :: i, child
      integer(lp) :: k

      k = tree%start(c) + HEADER
      do i = 1, tree%record(tree%start(c) + 3)
         child = tree%record(k + 1)
         factors(child)%waiting = factors(child)%waiting + 1
         k = k + 2 + tree%record(k + 2)
      end do
   end subroutine count_children

   !> Cuts the classes into units: those that are new in a subtree of little work follow one another.
   pure subroutine make_units(tree, work, units)
      type(front_tree_t), intent(in) :: tree
      real(wp), intent(in) :: work(:)            !< (n_classes) operations
      type(unit_t), allocatable, intent(out) :: units(:)
      real(wp) :: subtree(tree%n_parts), most
      integer(ip) :: unit_of(tree%n_parts), p, c, u, n_units

      most = SHARE*sum(work)
      subtree = 0.0_wp
      subtree(tree%representative(:tree%n_classes)) = work
      do p = 1, tree%n_parts - 1
         subtree(tree%parent(p)) = subtree(tree%parent(p)) + subtree(p)
      end do
      unit_of = 0                                ! of the parts
      do p = 1, tree%n_parts - 1
         if (subtree(p) <= most .and. subtree(tree%parent(p)) > most) unit_of(p - tree%n_descendants(p):p) = p
      end do
      allocate (units(tree%n_classes))
      n_units = 0
      do c = 1, tree%n_classes
         u = unit_of(tree%representative(c))
         if (c > 1 .and. u > 0) then
            if (u == unit_of(tree%representative(c - 1))) then
               units(n_units)%last = c
               cycle
            end if
         end if
         n_units = n_units + 1
         units(n_units) = unit_t(c, c)
      end do
      units = units(:n_units)
      call find_waves(tree, units)
   end subroutine make_units

   !> A unit belongs to the wave after the last of those that it needs.
   pure subroutine find_waves(tree, units)
      type(front_tree_t), intent(in) :: tree
      type(unit_t), intent(inout) :: units(:)
      integer(ip) :: wave_of(tree%n_classes), u, c, i, child
      integer(lp) :: k

      do u = 1, size(units, kind=ip)
         do c = units(u)%first, units(u)%last
            k = tree%start(c) + HEADER
            do i = 1, tree%record(tree%start(c) + 3)
               child = tree%record(k + 1)
               if (child < units(u)%first) units(u)%wave = max(units(u)%wave, wave_of(child) + 1)
               k = k + 2 + tree%record(k + 2)
            end do
         end do
         wave_of(units(u)%first:units(u)%last) = units(u)%wave
      end do
   end subroutine find_waves

   subroutine factor_waves(tree, store, diagonal, units, factors)
      type(front_tree_t), intent(in) :: tree
      type(element_store_t), intent(in) :: store
      real(wp), intent(in) :: diagonal(:)
      type(unit_t), intent(in) :: units(:)
      type(factor_t), intent(inout) :: factors(:)
      type(workspace_t), allocatable :: workspaces(:)
      integer(ip) :: wave, u

      allocate (workspaces(n_threads()))
      do wave = 1, maxval(units%wave)
         !$omp taskgroup                        ! whose end helps with the tiles of the fronts, too
         do u = 1, size(units, kind=ip)
            if (units(u)%wave /= wave) cycle
            !$omp task default(none) shared(tree, store, diagonal, units, factors, workspaces) firstprivate(u)
            call factor_unit(tree, store, diagonal, units(u), factors, workspaces(this_thread())%front)
            !$omp end task
         end do
         !$omp end taskgroup
      end do
   end subroutine factor_waves

   subroutine factor_unit(tree, store, diagonal, unit, factors, front)
      type(front_tree_t), intent(in) :: tree
      type(element_store_t), intent(in) :: store
      real(wp), intent(in) :: diagonal(:)
      type(unit_t), intent(in) :: unit
      type(factor_t), intent(inout) :: factors(:)
      real(wp), allocatable, intent(inout) :: front(:)
      integer(ip) :: c
      integer :: no_memory

      if (.not. allocated(front)) then           ! room for the largest; what is not touched takes no memory
         allocate (front(int(maxval(factors%order), lp)**2), stat=no_memory)
         if (no_memory /= 0) then
            factors(unit%first)%enough = .false.
            return
         end if
      end if
      do c = unit%first, unit%last
         call factor_class(tree, store, diagonal, c, factors(c)%order, factors, front)
      end do
   end subroutine factor_unit

   !> Assembles and factors the fronts of a class. What was there of it before is overwritten.
   subroutine factor_class(tree, store, diagonal, c, order, factors, front)
      type(front_tree_t), intent(in) :: tree
      type(element_store_t), intent(in) :: store
      real(wp), intent(in) :: diagonal(:)
      integer(ip), intent(in) :: c, order
      type(factor_t), intent(inout) :: factors(:) !< those of the children have their updates
      real(wp), intent(inout) :: front(order, order)
      integer(ip) :: n_pivots, place
      integer :: no_memory
      logical :: complete

      call assemble_front(tree, store, c, order, factors, front, complete)
      if (.not. complete) return
      n_pivots = factors(c)%n_pivots
      if (c == tree%n_classes) n_pivots = 0
      call eliminate(order, n_pivots, front, factors(c)%failed)
      place = tree%first(tree%representative(c))
      call judge_pivots(order, n_pivots, front, diagonal(place:place + n_pivots - 1), size(diagonal, kind=ip), factors(c))
      factors(c)%done = .false.
      if (factors(c)%failed > 0) return
      no_memory = 0
      if (.not. allocated(factors(c)%columns)) allocate (factors(c)%columns(packed_length(order, n_pivots)), stat=no_memory)
      if (no_memory == 0 .and. .not. allocated(factors(c)%update)) then
         allocate (factors(c)%update(packed_length(order - n_pivots, order - n_pivots)), stat=no_memory)
      end if
      factors(c)%enough = no_memory == 0
      if (.not. factors(c)%enough) return
      factors(c)%done = .true.
      call pack_columns(order, front, 1_ip, n_pivots, factors(c)%columns)
      call pack_columns(order, front, n_pivots + 1, order, factors(c)%update)
   end subroutine factor_class

   !> `complete` is false when a child has no factor: its pivots failed, or the memory did.
   subroutine assemble_front(tree, store, c, order, factors, front, complete)
      type(front_tree_t), intent(in) :: tree
      type(element_store_t), intent(in) :: store
      integer(ip), intent(in) :: c, order
      type(factor_t), intent(inout) :: factors(:)
      real(wp), intent(inout) :: front(order, order)
      logical, intent(out) :: complete
      integer(ip) :: i, m, child
      integer(lp) :: k, first

      complete = .true.
      call clear_front(order, front)
      k = tree%start(c) + HEADER
      do i = 1, tree%record(tree%start(c) + 3)
         child = tree%record(k + 1)
         m = tree%record(k + 2)
         complete = factors(child)%done
         if (.not. complete) return
         call add_update(order, front, m, tree%record(k + 3:k + 2 + m), factors(child)%update)
         call give_back(factors(child))
         k = k + 2 + m
      end do
      do i = 1, tree%record(tree%start(c) + 4)
         first = store%matrix_start(tree%record(k + 1))
         m = tree%record(k + 2)
         call add_element(order, front, m, tree%record(k + 3:k + 2 + m), &
                          store%values(first + 1:first + int(m, lp)*int(m + 1, lp)/2))
         k = k + 2 + m
      end do
   end subroutine assemble_front

   !> Lets go of an update with the last front that takes it.
   subroutine give_back(factor)
      type(factor_t), intent(inout) :: factor
      integer(ip) :: waiting

      !$omp atomic capture seq_cst              ! others have read all of it when the last one comes
      factor%waiting = factor%waiting - 1
      waiting = factor%waiting
      !$omp end atomic
      if (waiting == 0) deallocate (factor%update)
   end subroutine give_back

   !> A pivot is round-off alone when it is at most max(n eps, 1e-15) of the diagonal before the elimination.
   pure subroutine judge_pivots(order, n_pivots, front, original, n, factor)
      integer(ip), intent(in) :: order, n_pivots, n
      real(wp), intent(in) :: front(order, order), original(n_pivots)
      type(factor_t), intent(inout) :: factor
      real(wp) :: pivot, tolerance, lost, most_lost
      integer(ip) :: i

      tolerance = smallest_ratio(n)
      factor%smallest_pivot = huge(pivot)
      most_lost = 0.0_wp
      do i = 1, n_pivots
         pivot = front(i, i)
         if (i /= factor%failed) pivot = pivot**2   ! the diagonal of L; one that failed is as the elimination left it
         factor%smallest_pivot = min(factor%smallest_pivot, pivot)
         factor%largest_pivot = max(factor%largest_pivot, pivot)
         if (.not. pivot > tolerance*original(i)) factor%failed = i
         lost = 0.0_wp
         if (i /= factor%failed) lost = original(i)/pivot
         if (lost > most_lost .or. i == factor%failed) then
            most_lost = lost
            factor%worst = i
            factor%worst_pivot = pivot
         end if
         if (i == factor%failed) exit
      end do
   end subroutine judge_pivots

end module atrito_front_factors
