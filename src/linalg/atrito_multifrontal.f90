!> The sparse solver: Cholesky's method by fronts (multifrontal), with the kept equations as the last front.
!>
!> Equal fronts are factored once (atrito_front_tree). No pivot is chosen: the matrix is positive definite, and the loss of digits
!> is told by its pivots as in the other storages.
!>
!> Reference: I. S. Duff, J. K. Reid, ACM Trans. Math. Software 9 (1983) 302-325.
module atrito_multifrontal
   use atrito_element_store, only: element_store_t, begin_store, add_to_store
   use atrito_elimination, only: elimination_t, chain_elimination
   use atrito_front, only: eliminate, add_element, add_update, pack_columns, unpack_update, packed_length
   use atrito_front_tree, only: front_tree_t, build_front_tree, HEADER
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_profile, only: profile_t
   use atrito_status, only: status_t
   use atrito_storage, only: storage_t, pivot_report_t, note_pivot, set_pivot_status, SMALLEST_RATIO
   implicit none (type, external)
   private
   public :: multifrontal_t

   !> The factor of a class of fronts.
   type :: factor_t
      integer(ip) :: order = 0, n_pivots = 0
      real(wp), allocatable :: columns(:)        !< those of L, packed from the diagonal down
      real(wp), allocatable :: update(:)         !< what is left of the border, packed, until the last parent has taken it
      integer(ip) :: waiting = 0                 !< fronts that have not taken it
      integer(ip) :: failed = 0                  !< pivot that could not be used
      integer(ip) :: worst = 0                   !< pivot that lost most
      real(wp) :: worst_pivot = 0.0_wp, largest_pivot = 0.0_wp
   end type factor_t

   type, extends(storage_t) :: multifrontal_t
      private
      type(elimination_t) :: elimination
      type(element_store_t) :: store             !< until factor
      real(wp), allocatable :: diagonal(:)       !< (n) by places, until factor
      type(front_tree_t) :: tree
      type(factor_t), allocatable :: factors(:)  !< (tree%n_classes)
      real(wp), allocatable :: schur(:)          !< packed lower triangle
   contains
      procedure :: create => create_fronts
      procedure :: add => add_to_fronts
      procedure :: factor => factor_fronts
      procedure :: get_schur => get_kept_front
      procedure :: reduce => reduce_by_fronts
      procedure :: expand => expand_by_fronts
      procedure :: memory_bytes => fronts_memory
      procedure, nopass :: name => fronts_name
   end type multifrontal_t

contains

   subroutine create_fronts(self, profile, status)
      class(multifrontal_t), intent(inout) :: self
      type(profile_t), intent(in) :: profile
      type(status_t), intent(out) :: status

      self%n = profile%n
      self%n_kept = profile%n_kept
      self%report = pivot_report_t()
      if (allocated(profile%elimination%place)) then
         self%elimination = profile%elimination
      else
         self%elimination = chain_elimination(self%n, self%n_kept)
      end if
      call begin_store(self%store)
      if (allocated(self%diagonal)) deallocate (self%diagonal)
      allocate (self%diagonal(self%n), source=0.0_wp)
      if (status%code /= 0) return
   end subroutine create_fronts

   subroutine add_to_fronts(self, equations, matrix)
      class(multifrontal_t), intent(inout) :: self
      integer(ip), intent(in) :: equations(:)
      real(wp), intent(in) :: matrix(:, :)
      integer(ip) :: i, place

      call add_to_store(self%store, equations, matrix)
      do i = 1, size(equations, kind=ip)
         if (equations(i) == 0) cycle
         place = self%elimination%place(equations(i))
         self%diagonal(place) = self%diagonal(place) + matrix(i, i)
      end do
   end subroutine add_to_fronts

   subroutine factor_fronts(self, status)
      class(multifrontal_t), intent(inout) :: self
      type(status_t), intent(out) :: status
      integer(ip) :: c

      call build_front_tree(self%elimination, self%n, self%n_kept, self%store, self%tree)
      allocate (self%factors(self%tree%n_classes))
      call count_parents(self)
      block
         real(wp), allocatable :: front(:)
         allocate (front(int(self%tree%largest, lp)**2))
         do c = 1, self%tree%n_classes
            call factor_class(self, c, front)
            if (self%factors(c)%failed > 0) exit
         end do
      end block
      call report_pivots(self, status)
   end subroutine factor_fronts

   subroutine count_parents(self)
      type(multifrontal_t), intent(inout) :: self
      integer(ip) :: c, i, child
      integer(lp) :: k

      do c = 1, self%tree%n_classes
         k = self%tree%start(c) + HEADER
         do i = 1, self%tree%record(self%tree%start(c) + 3)
            child = self%tree%record(k + 1)
            self%factors(child)%waiting = self%factors(child)%waiting + 1
            k = k + 2 + self%tree%record(k + 2)
         end do
      end do
   end subroutine count_parents

   subroutine factor_class(self, c, front)
      type(multifrontal_t), intent(inout) :: self
      integer(ip), intent(in) :: c
      real(wp), intent(inout) :: front(*)
      integer(ip) :: order, n_pivots
      integer(lp) :: start

      start = self%tree%start(c)
      n_pivots = self%tree%record(start + 1)
      order = n_pivots + self%tree%record(start + 2)
      self%factors(c)%order = order
      self%factors(c)%n_pivots = n_pivots
      call assemble_front(self, c, order, front)
      if (c == self%tree%class_of(self%tree%n_parts)) then
         allocate (self%schur(packed_length(order, order)))
         call pack_columns(order, front, 1_ip, order, self%schur)
         return
      end if
      call eliminate(order, n_pivots, front, self%factors(c)%failed)
      call judge_pivots(order, n_pivots, front, self%diagonal(self%tree%first(self%tree%representative(c)):), self%n, &
                        self%factors(c))
      if (self%factors(c)%failed > 0) return
      allocate (self%factors(c)%columns(packed_length(order, n_pivots)))
      call pack_columns(order, front, 1_ip, n_pivots, self%factors(c)%columns)
      allocate (self%factors(c)%update(packed_length(order - n_pivots, order - n_pivots)))
      call pack_columns(order, front, n_pivots + 1, order, self%factors(c)%update)
   end subroutine factor_class

   subroutine assemble_front(self, c, order, front)
      type(multifrontal_t), intent(inout) :: self
      integer(ip), intent(in) :: c, order
      real(wp), intent(out) :: front(order, order)
      integer(ip) :: i, m, child
      integer(lp) :: k, first

      do i = 1, order
         front(i:, i) = 0.0_wp
      end do
      associate (tree => self%tree, store => self%store)
         k = tree%start(c) + HEADER
         do i = 1, tree%record(tree%start(c) + 3)
            child = tree%record(k + 1)
            m = tree%record(k + 2)
            call add_update(order, front, m, tree%record(k + 3:k + 2 + m), self%factors(child)%update)
            self%factors(child)%waiting = self%factors(child)%waiting - 1
            if (self%factors(child)%waiting == 0) deallocate (self%factors(child)%update)
            k = k + 2 + m
         end do
         do i = 1, tree%record(tree%start(c) + 4)
            first = store%matrix_start(tree%record(k + 1))
            m = tree%record(k + 2)
            call add_element(order, front, m, tree%record(k + 3:k + 2 + m), store%values(first + 1:first + int(m, lp)**2))
            k = k + 2 + m
         end do
      end associate
   end subroutine assemble_front

   pure subroutine judge_pivots(order, n_pivots, front, original, n, factor)
      integer(ip), intent(in) :: order, n_pivots, n
      real(wp), intent(in) :: front(order, order), original(:)
      type(factor_t), intent(inout) :: factor
      real(wp) :: pivot, tolerance, ratio, worst_ratio
      integer(ip) :: i, last

      tolerance = max(real(n, wp)*EPS_MACH, SMALLEST_RATIO)
      last = n_pivots
      if (factor%failed > 0) last = factor%failed
      worst_ratio = huge(worst_ratio)
      do i = 1, last
         pivot = front(i, i)**2
         if (i == factor%failed) pivot = front(i, i)
         factor%largest_pivot = max(factor%largest_pivot, pivot)
         ratio = pivot/original(i)
         if (.not. ratio > tolerance .and. factor%failed == 0) factor%failed = i
         if (ratio < worst_ratio .or. i == factor%failed) then
            worst_ratio = ratio
            factor%worst = i
            factor%worst_pivot = pivot
            if (i == factor%failed) exit
         end if
      end do
   end subroutine judge_pivots

   subroutine report_pivots(self, status)
      type(multifrontal_t), intent(inout) :: self
      type(status_t), intent(out) :: status
      integer(ip) :: c, place, worst_place
      logical :: usable

      self%report = pivot_report_t()
      usable = .true.
      worst_place = 0
      do c = 1, self%tree%n_classes
         associate (factor => self%factors(c))
            if (factor%worst == 0) cycle
            place = self%tree%first(self%tree%representative(c)) + factor%worst - 1
            call note_pivot(self%report, place, self%n, self%diagonal(place), factor%worst_pivot, usable)
            self%report%largest_pivot = max(self%report%largest_pivot, factor%largest_pivot)
            if (factor%failed > 0) exit
         end associate
      end do
      if (self%report%worst_equation > 0) then
         self%report%worst_equation = findloc(self%elimination%place, self%report%worst_equation, dim=1)
      end if
      call set_pivot_status(self%report, .not. usable, status)
   end subroutine report_pivots

   subroutine get_kept_front(self, schur)
      class(multifrontal_t), intent(in) :: self
      real(wp), intent(out) :: schur(:, :)

      call unpack_update(self%n_kept, self%schur, schur)
   end subroutine get_kept_front

   !> The half-solved part is kept by places.
   subroutine reduce_by_fronts(self, f)
      class(multifrontal_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: f(:, :)
      real(wp) :: x(self%n)
      integer(ip) :: load

      do load = 1, size(f, 2, kind=ip)
         x(self%elimination%place) = f(:, load)
         call forward(self, x)
         f(:, load) = x
      end do
   end subroutine reduce_by_fronts

   subroutine forward(self, x)
      type(multifrontal_t), intent(in) :: self
      real(wp), intent(inout) :: x(:)            !< (n) by places
      real(wp), allocatable :: front(:), stack(:)
      integer(ip) :: p, c, i, m, n_pivots
      integer(lp) :: k, top, from

      allocate (front(self%tree%largest), stack(self%tree%widest))
      top = 0
      associate (tree => self%tree)
         do p = 1, tree%n_parts
            c = tree%class_of(p)
            n_pivots = self%factors(c)%n_pivots
            front(:n_pivots) = x(tree%first(p):tree%first(p + 1) - 1)
            front(n_pivots + 1:self%factors(c)%order) = 0.0_wp
            k = tree%start(c) + HEADER
            do i = 1, tree%record(tree%start(c) + 3)
               top = top - tree%record(k + 2)
               k = k + 2 + tree%record(k + 2)
            end do
            k = tree%start(c) + HEADER
            from = top
            do i = 1, tree%record(tree%start(c) + 3)
               m = tree%record(k + 2)
               call add_entries(m, tree%record(k + 3:k + 2 + m), stack(from + 1:from + m), front)
               from = from + m
               k = k + 2 + m
            end do
            if (p < tree%n_parts) call eliminate_load(self%factors(c)%order, n_pivots, self%factors(c)%columns, front)
            x(tree%first(p):tree%first(p + 1) - 1) = front(:n_pivots)
            m = self%factors(c)%order - n_pivots
            stack(top + 1:top + m) = front(n_pivots + 1:n_pivots + m)
            top = top + m
         end do
      end associate
   end subroutine forward

   pure subroutine add_entries(m, places, entries, front)
      integer(ip), intent(in) :: m, places(m)
      real(wp), intent(in) :: entries(m)
      real(wp), intent(inout) :: front(*)
      integer(ip) :: i

      do i = 1, m
         front(places(i)) = front(places(i)) + entries(i)
      end do
   end subroutine add_entries

   pure subroutine eliminate_load(order, n_pivots, columns, front)
      integer(ip), intent(in) :: order, n_pivots
      real(wp), intent(in) :: columns(*)
      real(wp), intent(inout) :: front(order)
      integer(ip) :: i, j
      integer(lp) :: k

      k = 0
      do j = 1, n_pivots
         front(j) = front(j)/columns(k + 1)
         !$omp simd
         do i = j + 1, order
            front(i) = front(i) - columns(k + 1 + i - j)*front(j)
         end do
         k = k + order - j + 1
      end do
   end subroutine eliminate_load

   subroutine expand_by_fronts(self, x)
      class(multifrontal_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: x(:, :)
      real(wp) :: y(self%n)
      integer(ip) :: load

      do load = 1, size(x, 2, kind=ip)
         y = x(:, load)
         call backward(self, y)
         x(:, load) = y(self%elimination%place)
      end do
   end subroutine expand_by_fronts

   subroutine backward(self, x)
      type(multifrontal_t), intent(in) :: self
      real(wp), intent(inout) :: x(:)            !< (n) by places
      real(wp), allocatable :: front(:), stack(:)
      integer(ip) :: p, c, i, m, n_pivots
      integer(lp) :: k, top

      allocate (front(self%tree%largest), stack(self%tree%widest))
      top = 0
      associate (tree => self%tree)
         do p = tree%n_parts, 1, -1
            c = tree%class_of(p)
            n_pivots = self%factors(c)%n_pivots
            m = self%factors(c)%order - n_pivots
            front(:n_pivots) = x(tree%first(p):tree%first(p + 1) - 1)
            front(n_pivots + 1:n_pivots + m) = stack(top - m + 1:top)
            top = top - m
            if (p < tree%n_parts) call solve_back(self%factors(c)%order, n_pivots, self%factors(c)%columns, front)
            x(tree%first(p):tree%first(p + 1) - 1) = front(:n_pivots)
            k = tree%start(c) + HEADER
            do i = 1, tree%record(tree%start(c) + 3)
               m = tree%record(k + 2)
               stack(top + 1:top + m) = front(tree%record(k + 3:k + 2 + m))
               top = top + m
               k = k + 2 + m
            end do
         end do
      end associate
   end subroutine backward

   pure subroutine solve_back(order, n_pivots, columns, front)
      integer(ip), intent(in) :: order, n_pivots
      real(wp), intent(in) :: columns(*)
      real(wp), intent(inout) :: front(order)
      integer(ip) :: i, j
      integer(lp) :: k
      real(wp) :: s

      k = packed_length(order, n_pivots)
      do j = n_pivots, 1, -1
         k = k - (order - j + 1)
         s = 0.0_wp
         !$omp simd reduction(+:s)
         do i = j + 1, order
            s = s + columns(k + 1 + i - j)*front(i)
         end do
         front(j) = (front(j) - s)/columns(k + 1)
      end do
   end subroutine solve_back

   pure integer(lp) function fronts_memory(self)
      class(multifrontal_t), intent(in) :: self
      integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INTEGER_BYTES = storage_size(1_ip)/8
      integer(ip) :: c

      fronts_memory = 0
      if (allocated(self%factors)) then
         do c = 1, size(self%factors, kind=ip)
            if (allocated(self%factors(c)%columns)) fronts_memory = fronts_memory &
                                                                    + REAL_BYTES*size(self%factors(c)%columns, kind=lp)
         end do
      end if
   end function fronts_memory

   pure function fronts_name() result(name)
      character(len=:), allocatable :: name

      name = 'sparse'
   end function fronts_name

end module atrito_multifrontal
