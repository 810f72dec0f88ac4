!> Solving with the factors of fronts: down the tree of the parts, and up.
!>
!> A subtree of little work is a unit, and units are shared out among the threads; the parts above them follow one after the
!> other, each shared out by its rows or columns. What a part leaves for its parent waits on a stack, and is added in the order of
!> the children.
module atrito_front_solves
   use atrito_front, only: packed_length
   use atrito_front_factors, only: factor_t
   use atrito_front_tree, only: front_tree_t, HEADER
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: plan_solves, solve_plan_t, forward, backward

   !> The vector on a border that waits for another part.
   type :: waiting_t
      real(wp), allocatable :: entries(:)
   end type waiting_t

   type :: stack_t
      real(wp), allocatable :: entries(:)
      integer(lp) :: top = 0
   end type stack_t

   !> The subtrees that are units.
   type :: solve_plan_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: first(:), last(:) !< (n) parts of each, ascending
      logical :: shares_out = .false.            !< whether the work is worth more than one thread
   end type solve_plan_t

   !> A unit has at most this share of the work.
   real(wp), parameter :: SHARE = 1.0_wp/48.0_wp
   !> Entries of factors that are worth waking other threads.
   real(wp), parameter :: WORTH_SHARING = 1.0e6_wp
   !> Entries of the factor of one part that are.
   integer(lp), parameter :: LARGE_PART = 60000_lp
   !> Pivots that are dealt with at a time: what lies beyond them can be shared out.
   integer(ip), parameter :: BLOCK = 64_ip
   !> Rows that a thread takes at a time.
   integer(ip), parameter :: ROWS = 256_ip

contains

   !> Cuts the tree.
   pure subroutine plan_solves(tree, plan)
      type(front_tree_t), intent(in) :: tree
      type(solve_plan_t), intent(out) :: plan
      real(wp) :: subtree(tree%n_parts), total
      integer(ip) :: p, pivots
      integer(lp) :: start

      total = 0.0_wp
      subtree = 0.0_wp
      do p = 1, tree%n_parts - 1
         start = tree%start(tree%class_of(p))
         pivots = tree%record(start + 1)
         subtree(p) = subtree(p) + real(packed_length(pivots + tree%record(start + 2), pivots), wp) + 50.0_wp
         subtree(tree%parent(p)) = subtree(tree%parent(p)) + subtree(p)
      end do
      total = subtree(tree%n_parts)
      allocate (plan%first(tree%n_parts), plan%last(tree%n_parts))
      do p = 1, tree%n_parts - 1
         if (subtree(p) > SHARE*total .or. subtree(tree%parent(p)) <= SHARE*total) cycle
         plan%n = plan%n + 1
         plan%first(plan%n) = p - tree%n_descendants(p)
         plan%last(plan%n) = p
      end do
      plan%first = plan%first(:plan%n)
      plan%last = plan%last(:plan%n)
      plan%shares_out = total > WORTH_SHARING
   end subroutine plan_solves

   !> x <- L^-1 x for the eliminated places; the kept ones take what it leaves for them.
   subroutine forward(tree, factors, plan, x)
      type(front_tree_t), intent(in) :: tree
      type(factor_t), intent(in) :: factors(:)
      type(solve_plan_t), intent(in) :: plan
      real(wp), intent(inout) :: x(:)            !< (n) by places
      type(waiting_t) :: waiting(plan%n)
      type(stack_t) :: stack
      integer(ip) :: u, p, next

      !$omp parallel do schedule(dynamic, 1) default(none) shared(tree, factors, plan, x, waiting) if(plan%shares_out)
      do u = 1, plan%n
         call forward_unit(tree, factors, plan%first(u), plan%last(u), x, waiting(u))
      end do
      !$omp end parallel do
      next = 1
      do u = 1, plan%n
         do p = next, plan%first(u) - 1
            call forward_part(tree, factors, p, plan%shares_out, x, stack)
         end do
         call push(stack, waiting(u)%entries)
         next = plan%last(u) + 1
      end do
      do p = next, tree%n_parts
         call forward_part(tree, factors, p, plan%shares_out, x, stack)
      end do
   end subroutine forward

   subroutine forward_unit(tree, factors, first, last, x, waiting)
      type(front_tree_t), intent(in) :: tree
      type(factor_t), intent(in) :: factors(:)
      integer(ip), intent(in) :: first, last
      real(wp), intent(inout) :: x(:)
      type(waiting_t), intent(out) :: waiting
      type(stack_t) :: stack
      integer(ip) :: p

      do p = first, last
         call forward_part(tree, factors, p, .false., x, stack)
      end do
      waiting%entries = stack%entries(:stack%top)
   end subroutine forward_unit

   subroutine forward_part(tree, factors, p, by_threads, x, stack)
      type(front_tree_t), intent(in) :: tree
      type(factor_t), intent(in) :: factors(:)
      integer(ip), intent(in) :: p
      logical, intent(in) :: by_threads          !< whether there are threads to share with
      real(wp), intent(inout) :: x(:)
      type(stack_t), intent(inout) :: stack
      real(wp) :: front(factors(tree%class_of(p))%order)
      integer(ip) :: c, i, m, n_children
      integer(lp) :: k, start, from

      c = tree%class_of(p)
      start = tree%start(c)
      n_children = tree%record(start + 3)
      associate (n_pivots => factors(c)%n_pivots, order => factors(c)%order)
         front(:n_pivots) = x(tree%first(p):tree%first(p + 1) - 1)
         front(n_pivots + 1:) = 0.0_wp
         k = start + HEADER
         do i = 1, n_children
            stack%top = stack%top - tree%record(k + 2)
            k = k + 2 + tree%record(k + 2)
         end do
         k = start + HEADER
         from = stack%top
         do i = 1, n_children
            m = tree%record(k + 2)
            call add_entries(m, tree%record(k + 3:k + 2 + m), stack%entries(from + 1:from + m), front)
            from = from + m
            k = k + 2 + m
         end do
         if (p < tree%n_parts) call eliminate_load(order, n_pivots, factors(c)%columns, &
                                                   by_threads .and. packed_length(order, n_pivots) > LARGE_PART, front)
         x(tree%first(p):tree%first(p + 1) - 1) = front(:n_pivots)
         call push(stack, front(n_pivots + 1:))
      end associate
   end subroutine forward_part

   !> x_i <- L^-T (x_i - L_ci' x_c) for the eliminated places.
   subroutine backward(tree, factors, plan, x)
      type(front_tree_t), intent(in) :: tree
      type(factor_t), intent(in) :: factors(:)
      type(solve_plan_t), intent(in) :: plan
      real(wp), intent(inout) :: x(:)            !< (n) by places
      type(waiting_t) :: waiting(plan%n)
      type(stack_t) :: stack
      integer(ip) :: u, p, m, next

      next = tree%n_parts
      do u = plan%n, 1, -1
         do p = next, plan%last(u) + 1, -1
            call backward_part(tree, factors, p, plan%shares_out, x, stack)
         end do
         m = tree%record(tree%start(tree%class_of(plan%last(u))) + 2)
         waiting(u)%entries = stack%entries(stack%top - m + 1:stack%top)
         stack%top = stack%top - m
         next = plan%first(u) - 1
      end do
      do p = next, 1, -1
         call backward_part(tree, factors, p, plan%shares_out, x, stack)
      end do
      !$omp parallel do schedule(dynamic, 1) default(none) shared(tree, factors, plan, x, waiting) if(plan%shares_out)
      do u = 1, plan%n
         call backward_unit(tree, factors, plan%first(u), plan%last(u), x, waiting(u))
      end do
      !$omp end parallel do
   end subroutine backward

   subroutine backward_unit(tree, factors, first, last, x, waiting)
      type(front_tree_t), intent(in) :: tree
      type(factor_t), intent(in) :: factors(:)
      integer(ip), intent(in) :: first, last
      real(wp), intent(inout) :: x(:)
      type(waiting_t), intent(in) :: waiting
      type(stack_t) :: stack
      integer(ip) :: p

      call push(stack, waiting%entries)
      do p = last, first, -1
         call backward_part(tree, factors, p, .false., x, stack)
      end do
   end subroutine backward_unit

   subroutine backward_part(tree, factors, p, by_threads, x, stack)
      type(front_tree_t), intent(in) :: tree
      type(factor_t), intent(in) :: factors(:)
      integer(ip), intent(in) :: p
      logical, intent(in) :: by_threads          !< whether there are threads to share with
      real(wp), intent(inout) :: x(:)
      type(stack_t), intent(inout) :: stack
      real(wp) :: front(factors(tree%class_of(p))%order)
      integer(ip) :: c, i, m
      integer(lp) :: k, start

      c = tree%class_of(p)
      start = tree%start(c)
      associate (n_pivots => factors(c)%n_pivots, order => factors(c)%order)
         m = order - n_pivots
         front(:n_pivots) = x(tree%first(p):tree%first(p + 1) - 1)
         front(n_pivots + 1:) = stack%entries(stack%top - m + 1:stack%top)
         stack%top = stack%top - m
         if (p < tree%n_parts) call solve_back(order, n_pivots, factors(c)%columns, &
                                               by_threads .and. packed_length(order, n_pivots) > LARGE_PART, front)
         x(tree%first(p):tree%first(p + 1) - 1) = front(:n_pivots)
         k = start + HEADER
         do i = 1, tree%record(start + 3)
            m = tree%record(k + 2)
            call push_some(stack, m, tree%record(k + 3:k + 2 + m), front)
            k = k + 2 + m
         end do
      end associate
   end subroutine backward_part

   !> Puts a vector on the stack.
   pure subroutine push(stack, entries)
      type(stack_t), intent(inout) :: stack
      real(wp), intent(in) :: entries(:)

      call make_room(stack, size(entries, kind=ip))
      stack%entries(stack%top + 1:stack%top + size(entries)) = entries
      stack%top = stack%top + size(entries)
   end subroutine push

   !> Puts some entries of a front on the stack.
   pure subroutine push_some(stack, m, places, front)
      type(stack_t), intent(inout) :: stack
      integer(ip), intent(in) :: m, places(m)
      real(wp), intent(in) :: front(:)
      integer(ip) :: i

      call make_room(stack, m)
      do i = 1, m
         stack%entries(stack%top + i) = front(places(i))
      end do
      stack%top = stack%top + m
   end subroutine push_some

   pure subroutine make_room(stack, m)
      type(stack_t), intent(inout) :: stack
      integer(ip), intent(in) :: m
      integer(lp), parameter :: LEAST = 1024_lp

      if (.not. allocated(stack%entries)) allocate (stack%entries(max(LEAST, int(m, lp))))
      if (stack%top + m > size(stack%entries, kind=lp)) call grow(stack%entries, 2*(stack%top + m))
   end subroutine make_room

   pure subroutine add_entries(m, places, entries, front)
      integer(ip), intent(in) :: m, places(m)
      real(wp), intent(in) :: entries(m)
      real(wp), intent(inout) :: front(:)
      integer(ip) :: i

      do i = 1, m
         front(places(i)) = front(places(i)) + entries(i)
      end do
   end subroutine add_entries

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
