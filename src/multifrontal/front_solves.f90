!> Solving with the factors of fronts: down the tree of the supernodes, and up.
!>
!> forward, from the leaves to the root: with p for the pivots of a supernode and b for its border
!>
!>     x_p <- L_p^-1 x_p,      and  -L_b x_p  for the rows b,
!>
!> which wait for the parent and are added to its front. backward, from the root to the leaves:
!>
!>     x_p <- L_p^-T (x_p - L_b' x_b),      with the x_b that the ancestors have found.
!>
!> Every entry of the factor is used once each way, so a solution takes as long as the factor takes to come from memory.
!>
!> Subtrees of little work are shared out among the threads; the supernodes above them follow one after the other, each shared out
!> by its rows or columns. What a supernode leaves for its parent waits on a stack, and is added in the order of the children: the
!> supernodes are in postorder, so that the children of one are on top of the stack when it comes.
module atrito_front_solves
   use atrito_front, only: packed_length
   use atrito_front_factors, only: fronts_t
   use atrito_front_records, only: HEADER
   use atrito_front_tree, only: subtree_t
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: forward, backward, solve_on_way

   !> The vectors on borders that wait for other supernodes, the last one on top.
   type :: stack_t
      real(wp), allocatable :: entries(:) !< those up to `top` are in use
      integer(lp) :: top = 0              !< entries on the stack
   end type stack_t

   !> Entries of the factor of one supernode that are worth waking other threads.
   integer(lp), parameter :: LARGE_SUPERNODE = 60000_lp
   !> Pivots that are dealt with at a time: what lies beyond them can be shared out.
   integer(ip), parameter :: BLOCK = 64_ip
   !> Rows that a thread takes at a time.
   integer(ip), parameter :: ROWS = 256_ip

contains

   !> x <- L^-1 x for the eliminated positions; the retained ones take what it leaves for them.
   subroutine forward(fronts, x)
      type(fronts_t), intent(in) :: fronts       !< factored
      real(wp), intent(inout) :: x(:)            !< (n) by positions
      type(stack_t) :: stack, stacks(size(fronts%subtrees))
      integer(ip) :: u, next

      !$omp parallel do schedule(dynamic, 1) default(none) shared(fronts, x, stacks) if(fronts%shares_solves)
      do u = 1, size(stacks, kind=ip)
         call forward_subtree(fronts, fronts%subtrees(u), .false., x, stacks(u))
      end do
      !$omp end parallel do
      next = 1
      do u = 1, size(stacks, kind=ip)
         call forward_subtree(fronts, subtree_t(next, fronts%subtrees(u)%first - 1), fronts%shares_solves, x, stack)
         call push(stack, stacks(u)%entries(:stacks(u)%top))
         next = fronts%subtrees(u)%last + 1
      end do
      call forward_subtree(fronts, subtree_t(next, fronts%n_supernodes), fronts%shares_solves, x, stack)
   end subroutine forward

   !> Goes up through some supernodes.
   subroutine forward_subtree(fronts, subtree, by_threads, x, stack)
      type(fronts_t), intent(in) :: fronts
      type(subtree_t), intent(in) :: subtree
      logical, intent(in) :: by_threads          !< whether there are threads to share with
      real(wp), intent(inout) :: x(:)
      type(stack_t), intent(inout) :: stack
      integer(ip) :: p

      do p = subtree%first, subtree%last
         associate (factor => fronts%factors(fronts%class_of(p)))
            call forward_supernode(fronts, p, factor%order, factor%n_pivots, by_threads, x, stack)
         end associate
      end do
   end subroutine forward_subtree

   !>     1. front = [ x of the pivots ; 0 ]
   !>     2. the vectors that the children have left are the last ones on the stack, one child after the other; each is added
   !>        to the front at the places that the record tells
   !>     3. x_p <- L_p^-1 x_p;  the border gets -L_b x_p  (eliminate_load)
   !>     4. x takes x_p; the border goes on the stack, for the parent
   !>
   !> The last supernode has no pivots: its front is what the retained equations get, f_c - K_ci K_ii^-1 f_i.
   subroutine forward_supernode(fronts, p, order, n_pivots, by_threads, x, stack)
      type(fronts_t), intent(in) :: fronts
      integer(ip), intent(in) :: p, order, n_pivots
      logical, intent(in) :: by_threads
      real(wp), intent(inout) :: x(:)
      type(stack_t), intent(inout) :: stack
      real(wp) :: front(order)
      integer(ip) :: c, i, j, n, n_children
      integer(lp) :: k, from

      c = fronts%class_of(p)
      n = fronts%record(fronts%start(c) + 1)
      n_children = fronts%record(fronts%start(c) + 3)
      front(:n) = x(fronts%first(p):fronts%first(p) + n - 1)
      front(n + 1:) = 0.0_wp
      k = fronts%start(c) + HEADER
      do i = 1, n_children
         stack%top = stack%top - fronts%record(k + 2)
         k = k + 2 + fronts%record(k + 2)
      end do
      k = fronts%start(c) + HEADER
      from = stack%top
      do i = 1, n_children
         do j = 1, fronts%record(k + 2)
            associate (at => fronts%record(k + 2 + j))
               front(at) = front(at) + stack%entries(from + j)
            end associate
         end do
         from = from + fronts%record(k + 2)
         k = k + 2 + fronts%record(k + 2)
      end do
      if (n_pivots > 0) call eliminate_load(order, n_pivots, fronts%factors(c)%columns, &
                                            by_threads .and. packed_length(order, n_pivots) > LARGE_SUPERNODE, front)
      x(fronts%first(p):fronts%first(p) + n - 1) = front(:n)
      call push(stack, front(n + 1:))
   end subroutine forward_supernode

   !> x_i <- L^-T (x_i - L_ci' x_c) for the eliminated positions.
   subroutine backward(fronts, x)
      type(fronts_t), intent(in) :: fronts       !< factored
      real(wp), intent(inout) :: x(:)            !< (n) by positions
      type(stack_t) :: stack, stacks(size(fronts%subtrees))
      integer(ip) :: u, m, next

      next = fronts%n_supernodes
      do u = size(stacks, kind=ip), 1, -1
         call backward_subtree(fronts, subtree_t(fronts%subtrees(u)%last + 1, next), fronts%shares_solves, x, stack)
         m = fronts%record(fronts%start(fronts%class_of(fronts%subtrees(u)%last)) + 2)
         stack%top = stack%top - m
         call push(stacks(u), stack%entries(stack%top + 1:stack%top + m))
         next = fronts%subtrees(u)%first - 1
      end do
      call backward_subtree(fronts, subtree_t(1, next), fronts%shares_solves, x, stack)
      !$omp parallel do schedule(dynamic, 1) default(none) shared(fronts, x, stacks) if(fronts%shares_solves)
      do u = 1, size(stacks, kind=ip)
         call backward_subtree(fronts, fronts%subtrees(u), .false., x, stacks(u))
      end do
      !$omp end parallel do
   end subroutine backward

   !> Goes down through some supernodes.
   subroutine backward_subtree(fronts, subtree, by_threads, x, stack)
      type(fronts_t), intent(in) :: fronts
      type(subtree_t), intent(in) :: subtree
      logical, intent(in) :: by_threads          !< whether there are threads to share with
      real(wp), intent(inout) :: x(:)
      type(stack_t), intent(inout) :: stack
      integer(ip) :: p

      do p = subtree%last, subtree%first, -1
         associate (factor => fronts%factors(fronts%class_of(p)))
            call backward_supernode(fronts, p, factor%order, factor%n_pivots, by_threads, x, stack)
         end associate
      end do
   end subroutine backward_subtree

   !> The mirror of forward_supernode: the parent has left x_b on the stack, x_p <- L_p^-T (x_p - L_b' x_b) follows, and each child
   !> gets the entries of [x_p ; x_b] that are its border. The first child is put on the stack first, so that the last one, which
   !> comes next on the way down, is on top.
   subroutine backward_supernode(fronts, p, order, n_pivots, by_threads, x, stack)
      type(fronts_t), intent(in) :: fronts
      integer(ip), intent(in) :: p, order, n_pivots
      logical, intent(in) :: by_threads
      real(wp), intent(inout) :: x(:)
      type(stack_t), intent(inout) :: stack
      real(wp) :: front(order)
      integer(ip) :: c, i, m, n
      integer(lp) :: k

      c = fronts%class_of(p)
      n = fronts%record(fronts%start(c) + 1)
      m = fronts%record(fronts%start(c) + 2)
      front(:n) = x(fronts%first(p):fronts%first(p) + n - 1)
      front(n + 1:) = stack%entries(stack%top - m + 1:stack%top)
      stack%top = stack%top - m
      if (n_pivots > 0) call solve_back(order, n_pivots, fronts%factors(c)%columns, &
                                        by_threads .and. packed_length(order, n_pivots) > LARGE_SUPERNODE, front)
      x(fronts%first(p):fronts%first(p) + n - 1) = front(:n)
      k = fronts%start(c) + HEADER
      do i = 1, fronts%record(fronts%start(c) + 3)
         m = fronts%record(k + 2)
         call make_room(stack, m)
         stack%entries(stack%top + 1:stack%top + m) = front(fronts%record(k + 3:k + 2 + m))
         stack%top = stack%top + m
         k = k + 2 + m
      end do
   end subroutine backward_supernode

   !> x <- (L L')^-1 x on a way through the tree, of a load that is there alone: supernodes with all those above them. Numbers below
   !> 0 stand for children of these that are not of the way: they leave nothing, and nobody asks for x there.
   subroutine solve_on_way(fronts, way, x)
      type(fronts_t), intent(in) :: fronts
      integer(ip), intent(in) :: way(:)          !< supernodes in their order
      real(wp), intent(inout) :: x(:)            !< (n) by positions
      type(stack_t) :: stack
      integer(ip) :: i, m

      do i = 1, size(way, kind=ip)
         associate (c => fronts%class_of(abs(way(i))))
            m = fronts%record(fronts%start(c) + 2)
            if (way(i) < 0) call push(stack, spread(0.0_wp, 1, m))
            if (way(i) > 0) call forward_supernode(fronts, way(i), fronts%factors(c)%order, fronts%factors(c)%n_pivots, &
                                                   fronts%shares_solves, x, stack)
         end associate
      end do
      do i = size(way, kind=ip), 1, -1
         associate (c => fronts%class_of(abs(way(i))))
            if (way(i) < 0) stack%top = stack%top - fronts%record(fronts%start(c) + 2)
            if (way(i) > 0) call backward_supernode(fronts, way(i), fronts%factors(c)%order, fronts%factors(c)%n_pivots, &
                                                    fronts%shares_solves, x, stack)
         end associate
      end do
   end subroutine solve_on_way

   !> Puts a vector on the stack.
   pure subroutine push(stack, entries)
      type(stack_t), intent(inout) :: stack
      real(wp), intent(in) :: entries(:)

      call make_room(stack, size(entries, kind=ip))
      stack%entries(stack%top + 1:stack%top + size(entries)) = entries
      stack%top = stack%top + size(entries)
   end subroutine push

   pure subroutine make_room(stack, m)
      type(stack_t), intent(inout) :: stack
      integer(ip), intent(in) :: m
      integer(lp), parameter :: LEAST = 1024_lp

      if (.not. allocated(stack%entries)) allocate (stack%entries(max(LEAST, int(m, lp))))
      if (stack%top + m > size(stack%entries, kind=lp)) call grow(stack%entries, 2*(stack%top + m))
   end subroutine make_room

   !> front <- L^-1 front for the pivots; the border takes what they leave for it.
   subroutine eliminate_load(order, n_pivots, columns, by_threads, front)
      integer(ip), intent(in) :: order, n_pivots
      real(wp), intent(in) :: columns(*)
      logical, intent(in) :: by_threads
      real(wp), intent(inout) :: front(order)
      integer(ip) :: first, last, low, j

      do first = 1, n_pivots, BLOCK
         last = min(first + BLOCK - 1, n_pivots)
         do j = first, last
            front(j) = front(j)/columns(packed_length(order, j - 1) + 1)
            call subtract_columns(order, j, j, columns, j + 1, last, front)
         end do
         if (by_threads) then
            !$omp parallel do default(none) shared(order, first, last, columns, front)
            do low = last + 1, order, ROWS
               call subtract_columns(order, first, last, columns, low, min(low + ROWS - 1, order), front)
            end do
            !$omp end parallel do
         else
            call subtract_columns(order, first, last, columns, last + 1, order, front)
         end if
      end do
   end subroutine eliminate_load

   !> Takes some columns, times their solved pivots, from some rows below them.
   pure subroutine subtract_columns(order, first, last, columns, low, high, front)
      integer(ip), intent(in) :: order
      integer(ip), intent(in) :: first, last     !< columns
      real(wp), intent(in) :: columns(*)
      integer(ip), intent(in) :: low, high       !< rows
      real(wp), intent(inout) :: front(order)
      integer(ip) :: i, j
      integer(lp) :: k

      do j = first, last
         k = packed_length(order, j - 1) + 1 - j
         !$omp simd
         do i = low, high
            front(i) = front(i) - columns(k + i)*front(j)
         end do
      end do
   end subroutine subtract_columns

   !> front <- L^-T (front - L_b' border) for the pivots.
   subroutine solve_back(order, n_pivots, columns, by_threads, front)
      integer(ip), intent(in) :: order, n_pivots
      real(wp), intent(in) :: columns(*)
      logical, intent(in) :: by_threads
      real(wp), intent(inout) :: front(order)
      integer(ip) :: first, last, j
      real(wp) :: beyond(BLOCK)                  !< what the rows beyond the block take from its pivots

      do first = 1 + BLOCK*((n_pivots - 1)/BLOCK), 1, -BLOCK
         last = min(first + BLOCK - 1, n_pivots)
         if (by_threads) then
            !$omp parallel do default(none) shared(order, first, last, columns, front, beyond)
            do j = first, last
               beyond(j - first + 1) = column_product(order, j, columns, last + 1, order, front)
            end do
            !$omp end parallel do
         else
            do j = first, last
               beyond(j - first + 1) = column_product(order, j, columns, last + 1, order, front)
            end do
         end if
         do j = last, first, -1
            front(j) = (front(j) - (beyond(j - first + 1) + column_product(order, j, columns, j + 1, last, front))) &
                       /columns(packed_length(order, j - 1) + 1)
         end do
      end do
   end subroutine solve_back

   !> Product of a column with a front, over some rows below its pivot.
   pure real(wp) function column_product(order, j, columns, low, high, front) result(s)
      integer(ip), intent(in) :: order, j
      real(wp), intent(in) :: columns(*)
      integer(ip), intent(in) :: low, high       !< rows
      real(wp), intent(in) :: front(order)
      integer(ip) :: i
      integer(lp) :: k

      k = packed_length(order, j - 1) + 1 - j
      s = 0.0_wp
      !$omp simd reduction(+:s)
      do i = low, high
         s = s + columns(k + i)*front(i)
      end do
   end function column_product

end module atrito_front_solves
