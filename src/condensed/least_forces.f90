!> The least of the contact forces that move the bodies alike.
!>
!> With the friction bound frozen the displacements of a scene are unique. Its contact forces are not where rows of the constraints
!> depend on each other: at the joint of three bodies, at a corner of two pairs, at a node with one free dof. All forces q with the
!> same B' q, within their bounds and 0 or at a bound where a gap or a slip says so, are solutions. Of them the least is given,
!>
!>     minimise sum q_i^2 / w_i,     B' q as it is,    lower <= q <= upper,    q_i as it is where the row may not change,
!>
!> the limit of a small compliance that is the same at all points. With y = q/sqrt(w) and A = B' W^1/2 it is the shortest y with
!> the same A y.
!>
!> Without bounds that is the part of y in the range of A': y = A' lambda + z with A z = 0, and z is left out (`split`). Bounds are
!> met by a primal active set, which keeps A y at every step: y goes towards y - z until the first row comes to a bound and stays
!> there; where none does, the row at a bound whose multiplier y - A' lambda has the wrong sign is let go. The objective falls at
!> every step, so it ends.
!>
!> What the ground takes at a held dof is no contact force, and costs nothing. Neither does it where a node is held along a
!> direction that is no axis, by a row of its own: such a row takes no part, nor does what other rows do along its direction
!> (leave_out), so that the answer does not hang on the axes of the deck. Its force is what balances in the end (balance_supports).
!>
!> Components that share no dof are solved each by itself (atrito_constraint_rows), small ones by a singular value decomposition,
!> larger ones by conjugate gradients on the normal equations. A row is shared where a part of the null space of A touches it:
!> where it can change with A y as it is (`find_shared`).
module atrito_least_forces
   use atrito_bound_qp, only: box_bounds_t, box_state_t, FREE
   use atrito_constraint_rows, only: constraint_rows_t, list_components
   use atrito_dense, only: least_squares
   use atrito_kinds, only: ip, lp, wp
   use atrito_sorting, only: each_once, first_at_least
   implicit none (type, external)
   private
   public :: find_least_forces

   !> The rows of a component, scaled, over dofs numbered from 1.
   type :: component_t
      integer(ip) :: n = 0, k = 0                !< rows, dofs
      integer(ip), allocatable :: first(:), column(:) !< rows of A' begin in column and value; dofs
      real(wp), allocatable :: value(:)          !< entries of A', each dof scaled to one
      real(wp), allocatable :: y(:), lower(:), upper(:) !< (n) forces over sqrt(w)
   end type component_t

   integer(ip), parameter :: MOST_DENSE = 100_ip     !< rows of a component that is decomposed
   integer(ip), parameter :: MOST_SINGLE = 400_ip    !< rows up to which each row at a bound is asked by itself
   real(wp), parameter :: DEPENDENT = 1.0e-10_wp     !< singular value over the largest that counts as none
   real(wp), parameter :: NO_PART = 1.0e-7_wp        !< entry of a unit vector's part in the null space that is none
   real(wp), parameter :: WRONG = 1.0e-10_wp         !< of the largest force: a multiplier of the wrong sign
   real(wp), parameter :: DONE = 1.0e-15_wp          !< of the first residual of the steps

contains

   !> Replaces state%q by the least forces; what is between its bounds then is free. is_shared tells the rows whose force is not
   !> unique.
   !>
   !>     1. list_components     the rows that may depend on each other, in groups that share no dof
   !>     2. extract_component   A and y of a group without its supports, scaled
   !>     3. find_shared         rows that the null space of A touches; none: the forces of the group are unique
   !>     4. shorten             the shortest y with the same A y within the bounds
   !>     5. find_shared again   its rows are those whose force is not unique
   !>
   !> Example. Where three bodies have a node each at one place, the rows of the three pairs along a direction are u_A - u_B, u_B -
   !> u_C and u_C - u_A. Their sum is nothing, so the same force may be added to all three and no body feels it. The least forces
   !> are those without such a part. Rows with a compliance of their own do not change (may_change): there the law says which force
   !> is right.
   subroutine find_least_forces(rows, weight, bounds, may_change, state, is_shared)
      type(constraint_rows_t), intent(in) :: rows !< A: what each force does at the displacements
      real(wp), intent(in) :: weight(:)          !< (n) of the rows' points [L^2]
      type(box_bounds_t), intent(in) :: bounds   !< of the n forces
      logical, intent(in) :: may_change(:)       !< (n) closed or sticking, r = 0 and no compliance
      type(box_state_t), intent(inout) :: state  !< with admissible forces
      logical, allocatable, intent(out) :: is_shared(:) !< (n)
      type(component_t) :: component
      integer(ip), allocatable :: first(:), member(:), own(:), supports(:)
      real(wp) :: scale(rows%n), before(rows%n)
      integer(ip) :: i
      logical, allocatable :: shared(:)

      allocate (is_shared(rows%n), source=.false.)
      call list_components(rows, may_change, first, member)
      if (size(first) <= 1) return
      scale = sqrt(weight)
      do i = 1, size(first, kind=ip) - 1
         call part_supports(rows, member(first(i):first(i + 1) - 1), own, supports)
         if (size(own) == 0) cycle
         ! before and after: what is shared may be at a bound first and between its bounds then
         call extract_component(rows, own, supports, scale, bounds, state%q, component)
         call find_shared(component, shared)
         if (.not. any(shared)) cycle
         call shorten(component)
         call find_shared(component, shared)
         before = state%q
         state%q(own) = component%y*scale(own)
         call balance_supports(rows, own, supports, before, state%q)
         is_shared(own) = shared
      end do
      where (is_shared .and. state%q > bounds%lower .and. state%q < bounds%upper) state%state = FREE
   end subroutine find_least_forces

   !> Rows of a component, and its supports: rows over the dofs of one node that share none with another such row.
   pure subroutine part_supports(rows, member, own, supports)
      type(constraint_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: member(:)
      integer(ip), allocatable, intent(out) :: own(:), supports(:)
      logical :: is_support(size(member))
      integer(ip), allocatable :: taken(:)
      integer(ip) :: i, e

      is_support = .false.
      allocate (taken(0))
      if (allocated(rows%to_ground)) then
         do i = 1, size(member, kind=ip)
            if (.not. rows%to_ground(member(i))) cycle
            associate (dofs => rows%column(rows%first(member(i)):rows%first(member(i) + 1) - 1))
               is_support(i) = all([(all(taken /= dofs(e)), e=1, size(dofs, kind=ip))])
               if (is_support(i)) taken = [taken, dofs]
            end associate
         end do
      end if
      own = pack(member,.not. is_support)
      supports = pack(member, is_support)
   end subroutine part_supports

   !> The forces of supports when other forces of their nodes have changed: B' q along their directions stays as it is.
   pure subroutine balance_supports(rows, own, supports, before, q)
      type(constraint_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: own(:), supports(:)
      real(wp), intent(in) :: before(:)          !< (n) forces before the change [F]
      real(wp), intent(inout) :: q(:)            !< (n) those of the supports change [F]
      real(wp) :: added(rows%n_columns)
      integer(ip) :: i, e

      if (size(supports) == 0) return
      added = 0.0_wp
      do i = 1, size(own, kind=ip)
         do e = rows%first(own(i)), rows%first(own(i) + 1) - 1
            added(rows%column(e)) = added(rows%column(e)) + rows%value(e)*(q(own(i)) - before(own(i)))
         end do
      end do
      do i = 1, size(supports, kind=ip)
         associate (from => rows%first(supports(i)), to => rows%first(supports(i) + 1) - 1)
            q(supports(i)) = q(supports(i)) - dot_product(rows%value(from:to), added(rows%column(from:to))) &
                             /sum(rows%value(from:to)**2)
         end associate
      end do
   end subroutine balance_supports

   !> Rows of a component in its own numbers.
   !>
   !> Rows of A' = W^1/2 B: entry (i, dof) is sqrt(w_i) B_i,dof. Dofs are numbered from 1 in ascending order, bounds are those of y
   !> = q/sqrt(w); a bound that is none, HUGE_REAL, must stay one when it is divided.
   subroutine extract_component(rows, own, supports, scale, bounds, q, component)
      type(constraint_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: own(:), supports(:)
      real(wp), intent(in) :: scale(:), q(:)
      type(box_bounds_t), intent(in) :: bounds
      type(component_t), intent(out) :: component
      integer(lp), allocatable :: dofs(:)
      integer(ip) :: i, k, n

      component%n = size(own, kind=ip)
      n = sum(rows%first(own + 1) - rows%first(own))
      allocate (component%first(component%n + 1), component%column(n), component%value(n))
      component%first(1) = 1
      do i = 1, component%n
         associate (from => rows%first(own(i)), to => rows%first(own(i) + 1) - 1, at => component%first(i))
            component%first(i + 1) = at + to - from + 1
            component%column(at:component%first(i + 1) - 1) = rows%column(from:to)
            component%value(at:component%first(i + 1) - 1) = rows%value(from:to)*scale(own(i))
         end associate
      end do
      dofs = int(each_once([component%column, (rows%column(rows%first(supports(i)):rows%first(supports(i) + 1) - 1), &
                                               i=1, size(supports, kind=ip))]), lp)
      do k = 1, n
         component%column(k) = first_at_least(dofs, int(component%column(k), lp))
      end do
      component%k = size(dofs, kind=ip)
      call leave_out(rows, supports, dofs, component)
      call scale_columns(component)
      component%y = q(own)/scale(own)
      ! no bound stays none
      component%lower = max(bounds%lower(own), -0.5_wp*huge(1.0_wp)*min(scale(own), 1.0_wp))/scale(own)
      component%upper = min(bounds%upper(own), 0.5_wp*huge(1.0_wp)*min(scale(own), 1.0_wp))/scale(own)
   end subroutine extract_component

   !> Leaves out what the rows do along supports: of a node that is held along d, the part across it, (-d2, d1), is one dof, and
   !> there is none of a node with one free dof.
   subroutine leave_out(rows, supports, dofs, component)
      type(constraint_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: supports(:)
      integer(lp), intent(in) :: dofs(:)         !< columns of rows, ascending
      type(component_t), intent(inout) :: component
      real(wp) :: part(component%k), d(2)
      integer(ip) :: to(component%k), at(2), i, k, n

      if (size(supports) == 0) return
      part = 1.0_wp
      to = [(k, k=1, component%k)]
      do i = 1, size(supports, kind=ip)
         associate (first => rows%first(supports(i)))
            n = rows%first(supports(i) + 1) - first
            at(:n) = [(first_at_least(dofs, int(rows%column(first + k - 1), lp)), k=1, n)]
            part(at(1)) = 0.0_wp
            if (n == 1) cycle
            d = rows%value(first:first + 1)/norm2(rows%value(first:first + 1))
            part(at) = [-d(2), d(1)]
            to(at(2)) = at(1)
         end associate
      end do
      component%value = component%value*part(component%column)
      component%column = to(component%column)
   end subroutine leave_out

   !> Each dof's entries to length one: the same A y, better conditioned.
   !>
   !> Scaling an equation of A y = const changes nothing but its weight in the least squares.
   pure subroutine scale_columns(component)
      type(component_t), intent(inout) :: component
      real(wp) :: length(component%k)
      integer(ip) :: k

      length = 0.0_wp
      do k = 1, size(component%column, kind=ip)
         length(component%column(k)) = hypot(length(component%column(k)), component%value(k))
      end do
      do k = 1, size(component%column, kind=ip)
         if (length(component%column(k)) > 0.0_wp) component%value(k) = component%value(k)/length(component%column(k))
      end do
   end subroutine scale_columns

   !> The shortest y with the same A y within the bounds, from the present one.
   !>
   !> A primal active set. The objective |y|^2/2 falls with every step of positive length, and a row that is let go makes it fall
   !> next; so sets do not come back, but for round-off, for which the number of steps is limited.
   subroutine shorten(component)
      type(component_t), intent(inout) :: component
      logical :: free(component%n)
      real(wp) :: along(component%n), lambda(component%k), step
      integer(ip) :: i, first, worst

      free = .true.
      do i = 1, 10*component%n + 10
         ! y of the free rows = A' lambda + along, A along = 0: without `along` they are as short as they can be
         call split(component, free, component%y, along, lambda)
         call longest_step(step, first)
         where (free) component%y = component%y - step*along
         component%y = min(max(component%y, component%lower), component%upper)
         if (first > 0) then
            free(first) = .false.
            component%y(first) = merge(component%lower(first), component%upper(first), along(first) > 0.0_wp)
         else
            ! the shortest y for these rows at their bounds: are the multipliers of the bounds right, too?
            call find_wrong(worst)
            if (worst == 0) return
            free(worst) = .true.
         end if
      end do

   contains

      !> How far y can go towards y - along within the bounds, and the row that ends it; 0: none does.
      !>
      !> 1 where nothing is in the way. Rows whose part is round-off of the largest y do not move, and a bound that is reached but
      !> for round-off is reached at the step before.
      pure subroutine longest_step(step, first)
         real(wp), intent(out) :: step
         integer(ip), intent(out) :: first
         real(wp) :: room, round_off
         integer(ip) :: i

         step = 1.0_wp
         first = 0
         round_off = 4*epsilon(1.0_wp)*maxval(abs(component%y))
         do i = 1, component%n
            if (.not. free(i) .or. abs(along(i)) <= round_off) cycle
            room = component%y(i) - merge(component%lower(i), component%upper(i), along(i) > 0.0_wp)
            if (abs(room) + round_off >= step*abs(along(i))) cycle
            step = room/along(i)
            first = i
         end do
      end subroutine longest_step

      !> The row at its bound that would most like to leave it; 0 where none would.
      !>
      !> The gradient of |y|^2/2 - lambda'(A y - A y_0) is y - A' lambda. At a lower bound y may only grow, so the gradient must
      !> be >= 0 there, at an upper one <= 0.
      pure subroutine find_wrong(worst)
         integer(ip), intent(out) :: worst
         real(wp) :: gradient(component%n), most
         integer(ip) :: i

         gradient = component%y - transposed_product(component, lambda)
         worst = 0
         most = WRONG*maxval(abs(component%y))
         do i = 1, component%n
            if (free(i) .or. component%lower(i) >= component%upper(i)) cycle
            ! at the lower bound y may only grow
            if (component%y(i) > component%lower(i)) gradient(i) = -gradient(i)
            if (-gradient(i) <= most) cycle
            most = -gradient(i)
            worst = i
         end do
      end subroutine find_wrong

   end subroutine shorten

   !> y of the free rows is A' lambda plus a part `along` in the null space of A.
   !>
   !> lambda is the least squares solution of A' lambda = y over the free rows, `along` the residual of that.
   subroutine split(component, free, y, along, lambda)
      type(component_t), intent(in) :: component
      logical, intent(in) :: free(:)
      real(wp), intent(in) :: y(:)
      real(wp), intent(out) :: along(:)          !< (n), 0 outside the free rows
      real(wp), intent(out) :: lambda(:)         !< (k)

      if (component%n <= MOST_DENSE .and. component%k <= 4*MOST_DENSE) then
         call split_dense()
      else
         call split_by_steps()
      end if

   contains

      subroutine split_dense()
         real(wp) :: a(component%n, component%k)
         integer(ip) :: i, k, rank, info

         a = 0.0_wp
         do i = 1, component%n
            if (.not. free(i)) cycle
            do k = component%first(i), component%first(i + 1) - 1
               a(i, component%column(k)) = a(i, component%column(k)) + component%value(k)
            end do
         end do
         call least_squares(a, merge(y, 0.0_wp, free), lambda, DEPENDENT, rank, info)
         along = merge(y - matmul(a, lambda), 0.0_wp, free)
      end subroutine split_dense

      !> Conjugate gradients on the normal equations A A' lambda = A y (CGLS), begun anew once for the digits.
      !>
      !> s = A along is the residual of the normal equations and p the direction; each step costs two products with the rows. The
      !> second round begins with a residual that is computed afresh, for the digits that the recurrence has lost.
      subroutine split_by_steps()
         real(wp) :: s(component%k), p(component%k), t(component%n), begin, now, last
         integer(ip) :: round, step

         lambda = 0.0_wp
         along = merge(y, 0.0_wp, free)
         s = product_of(component, along)
         begin = norm2(s)
         ! begun anew once, from a residual without the round-off of the recurrence
         do round = 1, 2
            p = s
            last = norm2(s)
            do step = 1, 4*(component%n + component%k)
               if (last <= DONE*begin) exit
               t = merge(transposed_product(component, p), 0.0_wp, free)
               if (norm2(t) <= DEPENDENT*norm2(p)) exit
               lambda = lambda + (last/norm2(t))**2*p
               along = along - (last/norm2(t))**2*t
               s = product_of(component, along)
               now = norm2(s)
               p = s + (now/last)**2*p
               last = now
            end do
            along = merge(y - transposed_product(component, lambda), 0.0_wp, free)
            s = product_of(component, along)
         end do
      end subroutine split_by_steps

   end subroutine split

   !> A y.
   pure function product_of(component, y) result(x)
      type(component_t), intent(in) :: component
      real(wp), intent(in) :: y(:)
      real(wp) :: x(component%k)
      integer(ip) :: i, k

      x = 0.0_wp
      do i = 1, component%n
         do k = component%first(i), component%first(i + 1) - 1
            x(component%column(k)) = x(component%column(k)) + component%value(k)*y(i)
         end do
      end do
   end function product_of

   !> A' x.
   pure function transposed_product(component, x) result(y)
      type(component_t), intent(in) :: component
      real(wp), intent(in) :: x(:)
      real(wp) :: y(component%n)
      integer(ip) :: i

      do i = 1, component%n
         associate (from => component%first(i), to => component%first(i + 1) - 1)
            y(i) = dot_product(component%value(from:to), x(component%column(from:to)))
         end associate
      end do
   end function transposed_product

   !> Rows that can change with A y as it is: those between their bounds among themselves, and each row at a bound with them. (Of
   !> many rows all at bounds are asked at once, which may name some that can only leave their bounds the wrong way.)
   !>
   !> A row between its bounds is shared where the null space of the free rows touches it. A row at a bound may be shared, too, if
   !> others would let it leave: so each is asked with the free ones, by itself, since two at bounds may need opposite ways.
   subroutine find_shared(component, shared)
      type(component_t), intent(in) :: component
      logical, allocatable, intent(out) :: shared(:)
      logical :: inside(component%n)
      integer(ip) :: i

      inside = min(component%y - component%lower, component%upper - component%y) > WRONG*maxval(abs(component%y))
      allocate (shared(component%n), source=.false.)
      if (component%n > MOST_SINGLE) then
         call add_shared(component, component%lower < component%upper, shared)
         return
      end if
      call add_shared(component, inside, shared)
      do i = 1, component%n
         if (inside(i) .or. component%lower(i) >= component%upper(i)) cycle
         inside(i) = .true.
         call add_shared(component, inside, shared, i)
         inside(i) = .false.
      end do
   end subroutine find_shared

   !> Rows that the null space touches: seen in the part that any vector has in it. With `asked`, only where that row is touched.
   !>
   !> The part of a vector in the null space of A over the free rows touches every row that the null space does, unless it is by
   !> chance orthogonal to it there: entries 1 + sin(i^2)/2 have no relation to a mesh.
   subroutine add_shared(component, free, shared, asked)
      type(component_t), intent(in) :: component
      logical, intent(in) :: free(:)
      logical, intent(inout) :: shared(:)
      integer(ip), intent(in), optional :: asked
      real(wp) :: along(component%n), lambda(component%k), any_vector(component%n)
      integer(ip) :: i

      any_vector = [(1.0_wp + 0.5_wp*sin(real(i, wp)**2), i=1, component%n)]
      call split(component, free, any_vector, along, lambda)
      if (present(asked)) then
         if (abs(along(asked)) <= NO_PART) return
      end if
      shared = shared .or. abs(along) > NO_PART
   end subroutine add_shared

end module atrito_least_forces
