!> The factors of the classes of fronts.
!>
!> A front is assembled from the updates of its children and from its elements, each entry at its position in the front
!> (atrito_front_records), and its pivots are eliminated (atrito_front). The update stays until the last parent has taken it; of a
!> class that stands for many fronts every one of its parents' classes does.
!>
!> Classes are factored in tasks: all that are new in a subtree of little work, and every other by itself. Tasks that need nothing
!> of one another make a wave, and are tasks side by side. How the work is cut depends on the tree alone: the numbers are the
!> same for any number of threads.
!>
!> Most of the work is near the root: of a square of n nodes the last separator has sqrt(n) of them and a dense front of that order,
!> n^(3/2)/3 operations, its two children a fraction of that each, and so on in a geometric series. So the large fronts are shared
!> out by their tiles, and the many small ones by subtrees.
module atrito_front_factors
   use atrito_element_store, only: element_store_t
   use atrito_elimination, only: elimination_t
   use atrito_front, only: clear_front, eliminate, add_element, add_update, pack_columns, packed_length
   use atrito_front_classes, only: children_of
   use atrito_front_records, only: HEADER
   use atrito_front_tree, only: front_tree_t, subtree_t, build_front_tree, cut_subtrees
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   use atrito_threads, only: n_threads, this_thread
   implicit none (type, external)
   private
   public :: fronts_t, factor_t, front_bytes_t, plan_fronts, factor_fronts, factor_class, expect_factors, count_class, held_bytes
   public :: smallest_ratio, tell_of_memory, REAL_BYTES, CHUNK_BYTES

   !> The factor of a class of fronts.
   type :: factor_t
      integer(ip) :: order = 0, n_pivots = 0     !< the last class, of the retained equations, has no pivots
      real(wp), allocatable :: columns(:)        !< those of L, packed from the diagonal down
      real(wp), allocatable :: update(:)         !< what is left of the border, packed, until the last parent has taken it
      logical :: done = .false.                  !< with usable pivots
      logical :: enough = .true.                 !< memory for it, its front and its update
      integer(ip) :: failed = 0                  !< pivot that could not be used
      integer(ip) :: worst = 0                   !< pivot that lost most
      real(wp) :: worst_pivot = 0.0_wp           !< value of the one at `worst`
      real(wp) :: smallest_pivot = 0.0_wp, largest_pivot = 0.0_wp !< of the front
   end type factor_t

   !> The fronts of a matrix.
   type, extends(front_tree_t) :: fronts_t
      type(factor_t), allocatable :: factors(:)  !< (n_classes)
      integer(ip), allocatable :: waiting(:)     !< (n_classes) fronts that have not taken the update of a class
      type(subtree_t), allocatable :: subtrees(:) !< what a thread takes at a time in a solution
      logical :: shares_solves = .false.         !< solutions are worth more than one thread
      logical, allocatable :: is_negative(:)     !< (n) by positions: pivots that have to be; not allocated: none
   end type fronts_t

   !> What fronts take [bytes].
   type :: front_bytes_t
      integer(lp) :: held = 0                    !< with the updates that wait
      integer(lp) :: most = 0                    !< at a time so far
   end type front_bytes_t

   !> Classes first..last, which are factored one after the other.
   type :: task_t
      integer(ip) :: first = 0, last = 0 !< place in the list of classes
      integer(ip) :: wave = 1            !< those of wave 1 need no other task
   end type task_t

   !> Where a thread assembles the fronts of its tasks, one after the other: memory that is asked for anew for each large front
   !> has to be made by the system every time. A task is tied, so no other one of its thread comes between.
   type :: workspace_t
      real(wp), allocatable :: front(:) !< (largest order**2, or less as yet) a front, by columns
   end type workspace_t

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8
   !> What the C library adds to each array.
   integer(lp), parameter :: CHUNK_BYTES = 16_lp

   !> The shares of the work of a task, unless it is a single class, and of a subtree in a solution.
   real(wp), parameter :: TASK_SHARE = 1.0_wp/64.0_wp, SOLVE_SHARE = 1.0_wp/48.0_wp
   !> Operations of the factorisation and entries of factors that are worth waking other threads.
   real(wp), parameter :: WORTH_SHARING = 1.0e7_wp, ENTRIES_WORTH_SHARING = 1.0e6_wp

contains

   !> Finds the fronts of a matrix, their classes and their sizes; nothing is factored. `enough` of the fronts tells of the memory.
   subroutine plan_fronts(elimination, n, n_retained, store, fronts)
      type(elimination_t), intent(in) :: elimination !< order of equations, and supernodes
      integer(ip), intent(in) :: n, n_retained       !< equations; the last ones of them, which are not eliminated
      type(element_store_t), intent(in) :: store     !< elements of the matrix; their values are not looked at
      type(fronts_t), intent(out) :: fronts          !< classes and sizes, without factors
      real(wp), allocatable :: entries(:)
      integer(ip) :: c
      integer :: no_memory

      call build_front_tree(elimination, n, n_retained, store, fronts%front_tree_t)
      if (.not. fronts%enough) return
      allocate (fronts%factors(fronts%n_classes), fronts%waiting(fronts%n_classes), stat=no_memory)
      fronts%enough = no_memory == 0
      if (.not. fronts%enough) return
      fronts%waiting = 0
      do c = 1, fronts%n_classes
         fronts%factors(c)%n_pivots = fronts%record(fronts%start(c) + 1)
         fronts%factors(c)%order = fronts%factors(c)%n_pivots + fronts%record(fronts%start(c) + 2)
         call change_waiting(children_of(fronts, c), 1_ip, fronts%waiting)
      end do
      fronts%factors(fronts%n_classes)%n_pivots = 0
      entries = real(packed_length(fronts%factors%order, fronts%factors%n_pivots), wp) + 50.0_wp
      entries = entries(fronts%class_of)
      call cut_subtrees(fronts%parent, fronts%n_descendants, SOLVE_SHARE, entries, fronts%subtrees)
      fronts%shares_solves = entries(fronts%n_supernodes) > ENTRIES_WORTH_SHARING
   end subroutine plan_fronts

   !> A class may be a child several times.
   pure subroutine change_waiting(children, step, waiting)
      integer(ip), intent(in) :: children(:), step
      integer(ip), intent(inout) :: waiting(:)
      integer(ip) :: i

      do i = 1, size(children, kind=ip)
         waiting(children(i)) = waiting(children(i)) + step
      end do
   end subroutine change_waiting

   !> Factors all classes. The last one, of the retained equations, is assembled only: its lower triangle, packed, is its update.
   !>
   !> With P_c for the places of a child's border in the front of its parent, and A_e for the elements that the front takes,
   !>
   !>     F = sum_e A_e + sum_c P_c U_c P_c',        [ F_pp  F_bp' ; F_bp  F_bb ]  ->  L_p, L_b and U = F_bb - L_b L_b'.
   !>
   !> Children come before parents. By induction U is the Schur complement of all that was eliminated in the subtree, as its
   !> ancestors see it, so the L of all fronts together is the Cholesky factor of the matrix in the order of the dissection, whose
   !> entries are 0 wherever no front has them. Nothing but dense matrices is ever worked on.
   !>
   !> A class is factored once for all fronts that are equal. In a regular mesh of n elements there are some log n classes, not n.
   subroutine factor_fronts(fronts, store, diagonal, enough)
      type(fronts_t), intent(inout) :: fronts    !< planned; gets its factors
      type(element_store_t), intent(in) :: store !< element matrices, their values included
      real(wp), intent(in) :: diagonal(:)        !< (n) of the matrix, by positions
      logical, intent(out) :: enough             !< memory; the factors are of no use without
      type(task_t), allocatable :: tasks(:)
      type(workspace_t), allocatable :: workspaces(:)
      integer(ip) :: wave, u
      real(wp) :: work

      call make_tasks(fronts, tasks, work)
      allocate (workspaces(n_threads()))
      !$omp parallel default(none) shared(fronts, store, diagonal, tasks, workspaces) private(wave, u) if(work > WORTH_SHARING)
      !$omp single
      do wave = 1, maxval(tasks%wave)
         !$omp taskgroup                        ! whose end helps with the tiles of the fronts, too
         do u = 1, size(tasks, kind=ip)
            if (tasks(u)%wave /= wave) cycle
            !$omp task default(none) shared(store, diagonal, tasks, fronts, workspaces) firstprivate(u)
            call factor_task(store, diagonal, tasks(u), fronts, workspaces(this_thread())%front)
            !$omp end task
         end do
         !$omp end taskgroup
      end do
      !$omp end single
      !$omp end parallel
      enough = all(fronts%factors%enough)
   end subroutine factor_fronts

   !> What factor_fronts will take, before it does: its classes in its order, with one thread; and a front for each thread.
   subroutine expect_factors(fronts, bytes)
      type(fronts_t), intent(in) :: fronts      !< planned
      type(front_bytes_t), intent(out) :: bytes !< `held` when all is factored, `most` at the peak
      type(task_t), allocatable :: tasks(:)
      integer(ip) :: waiting(fronts%n_classes), wave, u, c
      real(wp) :: work

      call make_tasks(fronts, tasks, work)
      waiting = fronts%waiting
      bytes%held = fronts%n_classes*(storage_size(fronts%factors, kind=lp)/8)
      do wave = 1, maxval(tasks%wave)
         do u = 1, size(tasks, kind=ip)
            if (tasks(u)%wave /= wave) cycle
            do c = tasks(u)%first, tasks(u)%last
               call count_class(fronts, c, waiting, bytes)
            end do
         end do
      end do
      bytes%most = bytes%most + n_threads()*(REAL_BYTES*int(maxval(fronts%factors%order), lp)**2)
   end subroutine expect_factors

   !> Counts a class as factor_class will make it: what its children leave is given back with their last parent.
   pure subroutine count_class(fronts, c, waiting, bytes)
      type(fronts_t), intent(in) :: fronts        !< planned
      integer(ip), intent(in) :: c                !< class that is counted, after its children
      integer(ip), intent(inout) :: waiting(:)    !< (n_classes)
      type(front_bytes_t), intent(inout) :: bytes !< `held` goes up and down, `most` up
      integer(ip), allocatable :: children(:)
      integer(ip) :: i

      children = children_of(fronts, c)
      call change_waiting(children, -1_ip, waiting)
      do i = 1, size(children, kind=ip)
         if (waiting(children(i)) > 0 .or. any(children(:i - 1) == children(i))) cycle
         bytes%held = bytes%held - update_bytes(fronts%factors(children(i)))
      end do
      associate (factor => fronts%factors(c))
         bytes%held = bytes%held + REAL_BYTES*packed_length(factor%order, factor%n_pivots) + CHUNK_BYTES + update_bytes(factor)
      end associate
      bytes%most = max(bytes%most, bytes%held)
   end subroutine count_class

   pure integer(lp) function update_bytes(factor) result(bytes)
      type(factor_t), intent(in) :: factor

      bytes = REAL_BYTES*packed_length(factor%order - factor%n_pivots, factor%order - factor%n_pivots) + CHUNK_BYTES
   end function update_bytes

   !> What the arrays of a factor take now.
   pure elemental integer(lp) function held_bytes(factor, chunk) result(bytes)
      type(factor_t), intent(in) :: factor       !< of one class
      integer(lp), intent(in) :: chunk           !< counted for each array besides

      bytes = 0
      if (allocated(factor%columns)) bytes = REAL_BYTES*size(factor%columns, kind=lp) + chunk
      if (allocated(factor%update)) bytes = bytes + REAL_BYTES*size(factor%update, kind=lp) + chunk
   end function held_bytes

   !> Operations of the elimination of a front.
   !>
   !> Of n pivots in a front with m rows more, the pivot that leaves j others and the border takes (j + m)^2 operations, lower
   !> triangle alone: the sum over j from 0 to n - 1 is about n^3/3 + m n^2 + m^2 n.
   pure elemental real(wp) function front_flops(order, n_pivots) result(flops)
      integer(ip), intent(in) :: order, n_pivots
      real(wp) :: n, m

      n = real(n_pivots, wp)
      m = real(order - n_pivots, wp)
      flops = n*(n*n/3.0_wp + m*n + m*m)
   end function front_flops

   !> Cuts the classes into tasks: those that are new in a subtree of little work follow one another.
   !>
   !>     class     1  2  3  4 | 5  6  7 | 8 | 9 | 10          | between tasks
   !>     wave      1            1         2   2   3
   !>
   !> Classes are numbered as they were met in postorder. Those that follow each other and are new in the same small subtree are
   !> one task; each class above the subtrees is a task by itself. A small subtree may need a class that an earlier one has made:
   !> then its task waits for the next wave (find_waves). Within a wave no task needs another one. The large fronts near the root
   !> come few at a time, so their tiles are shared out besides (atrito_front).
   pure subroutine make_tasks(fronts, tasks, work)
      type(fronts_t), intent(in) :: fronts
      type(task_t), allocatable, intent(out) :: tasks(:)
      real(wp), intent(out) :: work              !< operations
      real(wp) :: of_supernode(fronts%n_supernodes)
      type(subtree_t), allocatable :: subtrees(:)
      integer(ip) :: subtree_of(fronts%n_supernodes), c, u, n
      logical :: follows

      of_supernode = 0.0_wp
      of_supernode(fronts%representative(:fronts%n_classes)) = front_flops(fronts%factors%order, fronts%factors%n_pivots)
      work = sum(of_supernode)
      call cut_subtrees(fronts%parent, fronts%n_descendants, TASK_SHARE, of_supernode, subtrees)
      subtree_of = 0
      do u = 1, size(subtrees, kind=ip)
         subtree_of(subtrees(u)%first:subtrees(u)%last) = u
      end do
      allocate (tasks(fronts%n_classes))
      n = 0
      u = 0
      do c = 1, fronts%n_classes
         follows = u > 0 .and. subtree_of(fronts%representative(c)) == u
         u = subtree_of(fronts%representative(c))
         if (.not. follows) n = n + 1
         if (.not. follows) tasks(n)%first = c
         tasks(n)%last = c
      end do
      tasks = tasks(:n)
      call find_waves(fronts, tasks)
   end subroutine make_tasks

   !> A task belongs to the wave after the last of those that it needs.
   pure subroutine find_waves(fronts, tasks)
      type(fronts_t), intent(in) :: fronts
      type(task_t), intent(inout) :: tasks(:)
      integer(ip), allocatable :: children(:)
      integer(ip) :: wave_of(fronts%n_classes), u, c

      do u = 1, size(tasks, kind=ip)
         do c = tasks(u)%first, tasks(u)%last
            children = children_of(fronts, c)
            children = pack(children, children < tasks(u)%first)
            tasks(u)%wave = maxval([tasks(u)%wave, wave_of(children) + 1])
         end do
         wave_of(tasks(u)%first:tasks(u)%last) = tasks(u)%wave
      end do
   end subroutine find_waves

   subroutine factor_task(store, diagonal, task, fronts, front)
      type(element_store_t), intent(in) :: store
      real(wp), intent(in) :: diagonal(:)
      type(task_t), intent(in) :: task
      type(fronts_t), intent(inout) :: fronts
      real(wp), allocatable, intent(inout) :: front(:)
      integer(ip) :: c
      integer :: no_memory

      no_memory = 0                              ! room for the largest; what is not touched takes no memory
      if (.not. allocated(front)) allocate (front(int(maxval(fronts%factors%order), lp)**2), stat=no_memory)
      if (no_memory /= 0) fronts%factors(task%first)%enough = .false.
      if (no_memory /= 0) return
      do c = task%first, task%last
         call factor_class(store, diagonal, c, fronts%factors(c)%order, fronts, front)
      end do
   end subroutine factor_task

   !> Assembles and factors the fronts of a class. What was there of it before is overwritten.
   subroutine factor_class(store, diagonal, c, order, fronts, front)
      type(element_store_t), intent(in) :: store     !< element matrices, their values included
      real(wp), intent(in) :: diagonal(:)            !< (n) of the matrix, by positions
      integer(ip), intent(in) :: c, order            !< class; rows of its front
      type(fronts_t), intent(inout) :: fronts        !< the factors of the children have their updates
      real(wp), intent(inout) :: front(order, order) !< where it is assembled; of no use afterwards
      integer(ip) :: first, last, m
      integer :: no_memory
      logical :: complete, is_negative

      call assemble_front(store, c, order, fronts, front, complete)
      if (.not. complete) return
      first = fronts%first(fronts%representative(c))
      associate (factor => fronts%factors(c))
         last = first + factor%n_pivots - 1
         is_negative = .false.
         if (allocated(fronts%is_negative)) is_negative = any(fronts%is_negative(first:last))
         if (is_negative) front = -front
         m = order - factor%n_pivots
         call eliminate(order, factor%n_pivots, front, factor%failed)
         call judge_pivots(order, factor%n_pivots, front, diagonal(first:last), size(diagonal, kind=ip), factor)
         factor%done = .false.
         if (factor%failed > 0) return
         no_memory = 0
         if (.not. allocated(factor%columns)) allocate (factor%columns(packed_length(order, factor%n_pivots)), stat=no_memory)
         if (no_memory == 0 .and. .not. allocated(factor%update)) allocate (factor%update(packed_length(m, m)), stat=no_memory)
         factor%enough = no_memory == 0
         factor%done = factor%enough
         if (.not. factor%done) return
         call pack_columns(order, front, 1_ip, factor%n_pivots, factor%columns)
         call pack_columns(order, front, factor%n_pivots + 1, order, factor%update)
         if (is_negative) factor%update = -factor%update
      end associate
   end subroutine factor_class

   !> `complete` is false when a child has no factor: its pivots failed, or the memory did.
   subroutine assemble_front(store, c, order, fronts, front, complete)
      type(element_store_t), intent(in) :: store
      integer(ip), intent(in) :: c, order
      type(fronts_t), intent(inout) :: fronts
      real(wp), intent(inout) :: front(order, order)
      logical, intent(out) :: complete
      integer(ip) :: i, m, child
      integer(lp) :: k

      complete = .true.
      call clear_front(order, front)
      k = fronts%start(c) + HEADER
      do i = 1, fronts%record(fronts%start(c) + 3)
         child = fronts%record(k + 1)
         m = fronts%record(k + 2)
         complete = fronts%factors(child)%done
         if (.not. complete) return
         call add_update(order, front, m, fronts%record(k + 3:k + 2 + m), fronts%factors(child)%update)
         call give_back(fronts%waiting(child), fronts%factors(child)%update)
         k = k + 2 + m
      end do
      do i = 1, fronts%record(fronts%start(c) + 4)
         m = fronts%record(k + 2)
         call add_element(order, front, m, fronts%record(k + 3:k + 2 + m), &
                          store%values(store%matrix_start(fronts%record(k + 1)) + 1:))
         k = k + 2 + m
      end do
   end subroutine assemble_front

   !> Lets go of an update with the last front that takes it.
   subroutine give_back(waiting, update)
      integer(ip), intent(inout) :: waiting
      real(wp), allocatable, intent(inout) :: update(:)
      integer(ip) :: left

      !$omp atomic capture seq_cst              ! others have read all of it when the last one comes
      waiting = waiting - 1
      left = waiting
      !$omp end atomic
      if (left == 0) deallocate (update)
   end subroutine give_back

   !> status: STATUS_INTERNAL, there is not enough memory for the fronts.
   pure subroutine tell_of_memory(status)
      type(status_t), intent(inout) :: status !< set without condition

      call set_status(status, STATUS_INTERNAL, 'not enough memory for the fronts')
   end subroutine tell_of_memory

   !> A pivot of at most this share of its original diagonal is round-off alone: n eps, and 15 digits in any case.
   pure real(wp) function smallest_ratio(n)
      integer(ip), intent(in) :: n               !< order of the matrix

      smallest_ratio = max(real(n, wp)*EPS_MACH, 1.0e-15_wp)
   end function smallest_ratio

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
