!> The sparse solver: Cholesky's method by fronts (multifrontal), with the kept equations as the last front.
!>
!> Equal fronts are factored once (atrito_front_tree). No pivot is chosen: the matrix is positive definite, and the loss of digits
!> is told by its pivots as in the other storages.
!>
!> Reference: I. S. Duff, J. K. Reid, ACM Trans. Math. Software 9 (1983) 302-325.
module atrito_multifrontal
   use atrito_element_store, only: element_store_t, begin_store, add_to_store, move_store
   use atrito_elimination, only: elimination_t, chain_elimination
   use atrito_front, only: unpack_update
   use atrito_front_factors, only: factor_t, front_bytes_t, factor_fronts, expect_factors
   use atrito_front_solves, only: solve_plan_t, plan_solves, forward, backward
   use atrito_front_tree, only: front_tree_t, build_front_tree
   use atrito_kinds, only: ip, lp, wp
   use atrito_profile, only: profile_t
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   use atrito_storage, only: storage_t, factor_report_t, add_one_by_one, note_pivot, set_pivot_status
   use atrito_threads, only: n_threads, is_shared
   implicit none (type, external)
   private
   public :: multifrontal_t, expect_fronts

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INDEX_BYTES = storage_size(1_ip)/8, &
                             LONG_BYTES = storage_size(1_lp)/8
   !> Numbers of a part of the tree.
   integer(lp), parameter :: PART_NUMBERS = 4_lp

   !> Parts of the equations whose diagonal is summed side by side: for each, all elements are gone through.
   integer(ip), parameter :: MOST_PARTS = 8_ip

   type, extends(storage_t) :: multifrontal_t
      private
      type(elimination_t) :: elimination
      type(element_store_t) :: store             !< until factor
      real(wp), allocatable :: diagonal(:)       !< (n) of the matrix by places, until factor
      type(front_tree_t) :: tree
      type(factor_t), allocatable :: factors(:)  !< (tree%n_classes)
      type(solve_plan_t) :: plan
   contains
      procedure :: create => create_fronts
      procedure :: add => add_to_fronts
      procedure :: add_store => add_store_to_fronts
      procedure :: factor => factor_and_report
      procedure :: get_schur => get_last_front
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
      integer :: no_memory

      self%n = profile%n
      self%n_kept = profile%n_kept
      self%report = factor_report_t()
      if (allocated(profile%elimination%place)) then
         self%elimination = profile%elimination
      else
         self%elimination = chain_elimination(self%n, self%n_kept)
      end if
      call begin_store(self%store)
      if (allocated(self%diagonal)) deallocate (self%diagonal)
      allocate (self%diagonal(self%n), stat=no_memory)
      if (no_memory /= 0) then
         call tell_of_memory(status)
         return
      end if
      self%diagonal = 0.0_wp
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

   !> The first store is taken as it is.
   subroutine add_store_to_fronts(self, store)
      class(multifrontal_t), intent(inout) :: self
      type(element_store_t), intent(inout) :: store
      integer(ip) :: part, n_parts

      if (self%store%n > 0) then
         call add_one_by_one(self, store)
         return
      end if
      call move_store(store, self%store)
      n_parts = 1
      if (is_shared(self%store%n)) n_parts = min(n_threads(), MOST_PARTS)
      !$omp parallel do schedule(static, 1) default(none) shared(self, n_parts)
      do part = 1, n_parts
         call add_to_diagonal(self, part, n_parts)
      end do
      !$omp end parallel do
   end subroutine add_store_to_fronts

   !> Adds the diagonals of the matrices of all elements, at the equations of a part.
   pure subroutine add_to_diagonal(self, part, n_parts)
      type(multifrontal_t), intent(inout) :: self
      integer(ip), intent(in) :: part, n_parts
      integer(lp) :: k, at
      integer(ip) :: first, last, e, place, n

      first = int((int(self%n, lp)*(part - 1))/n_parts, ip) + 1
      last = int((int(self%n, lp)*part)/n_parts, ip)
      do e = 1, self%store%n
         n = int(self%store%start(e + 1) - self%store%start(e), ip)
         at = self%store%matrix_start(self%store%matrix_of(e)) + 1
         do k = self%store%start(e) + 1, self%store%start(e + 1)
            if (self%store%equations(k) >= first .and. self%store%equations(k) <= last) then
               place = self%elimination%place(self%store%equations(k))
               self%diagonal(place) = self%diagonal(place) + self%store%values(at)
            end if
            at = at + n                          ! the next column is shorter by one
            n = n - 1
         end do
      end do
   end subroutine add_to_diagonal

   subroutine factor_and_report(self, status)
      class(multifrontal_t), intent(inout) :: self
      type(status_t), intent(out) :: status
      integer(lp) :: held
      logical :: enough

      self%report = factor_report_t()
      call build_front_tree(self%elimination, self%n, self%n_kept, self%store, self%tree)
      call expect_bytes(self%tree, self%n, self%store, held, self%report%most_bytes, enough)
      if (enough) call factor_fronts(self%tree, self%store, self%diagonal, self%factors, enough)
      self%store = element_store_t()
      if (.not. enough) then
         call tell_of_memory(status)
         return
      end if
      call report_pivots(self, status)
      call report_fronts(self)
      call plan_solves(self%tree, self%plan)
      deallocate (self%diagonal)
   end subroutine factor_and_report

   !> What the solver will hold of a body, and for a while at the most [bytes], from the tree of its fronts.
   subroutine expect_fronts(elimination, n, n_kept, store, held, most, enough)
      type(elimination_t), intent(in) :: elimination
      integer(ip), intent(in) :: n, n_kept
      type(element_store_t), intent(in) :: store
      integer(lp), intent(out) :: held, most
      logical, intent(out) :: enough             !< memory to tell
      type(front_tree_t) :: tree

      call build_front_tree(elimination, n, n_kept, store, tree)
      call expect_bytes(tree, n, store, held, most, enough)
   end subroutine expect_fronts

   subroutine expect_bytes(tree, n, store, held, most, enough)
      type(front_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: n
      type(element_store_t), intent(in) :: store
      integer(lp), intent(out) :: held, most
      logical, intent(out) :: enough
      type(front_bytes_t) :: bytes

      held = 0
      most = 0
      enough = tree%enough
      if (enough) call expect_factors(tree, bytes, enough)
      if (.not. enough) return
      associate (lists => INDEX_BYTES*(tree%start(tree%n_classes + 1) + PART_NUMBERS*tree%n_parts + n), &
                 elements => (LONG_BYTES + INDEX_BYTES)*store%n + INDEX_BYTES*size(store%equations, kind=lp) &
                 + REAL_BYTES*size(store%values, kind=lp))
         held = bytes%held + lists
         most = bytes%most + lists + elements + REAL_BYTES*n
      end associate
   end subroutine expect_bytes

   subroutine tell_of_memory(status)
      type(status_t), intent(inout) :: status

      call set_status(status, STATUS_INTERNAL, 'not enough memory for the fronts')
   end subroutine tell_of_memory

   !> The report of the pivots, class by class; the equation named is that of the first part of its class.
   subroutine report_pivots(self, status)
      type(multifrontal_t), intent(inout) :: self
      type(status_t), intent(out) :: status
      integer(ip) :: c, place
      logical :: usable

      usable = .true.
      do c = 1, self%tree%n_classes
         associate (factor => self%factors(c))
            if (factor%worst == 0) cycle
            place = self%tree%first(self%tree%representative(c)) + factor%worst - 1
            call note_pivot(self%report, place, self%n, self%diagonal(place), factor%worst_pivot, usable)
            self%report%smallest_pivot = min(self%report%smallest_pivot, factor%smallest_pivot)
            self%report%largest_pivot = max(self%report%largest_pivot, factor%largest_pivot)
            if (factor%failed > 0) exit
         end associate
      end do
      if (self%report%worst_equation > 0) then
         self%report%worst_equation = findloc(self%elimination%place, self%report%worst_equation, dim=1)
      end if
      call set_pivot_status(self%report,.not. usable, status)
   end subroutine report_pivots

   pure subroutine report_fronts(self)
      type(multifrontal_t), intent(inout) :: self
      integer(ip) :: c

      self%report%n_fronts = self%tree%n_parts
      self%report%n_different = self%tree%n_classes
      self%report%entries = 0
      do c = 1, self%tree%n_classes
         if (.not. allocated(self%factors(c)%columns)) cycle
         self%report%entries = self%report%entries + size(self%factors(c)%columns, kind=lp)
      end do
   end subroutine report_fronts

   subroutine get_last_front(self, schur)
      class(multifrontal_t), intent(in) :: self
      real(wp), intent(out) :: schur(:, :)

      call unpack_update(self%n_kept, self%factors(self%tree%n_classes)%update, schur)
   end subroutine get_last_front

   !> The half-solved part is left by places.
   subroutine reduce_by_fronts(self, f)
      class(multifrontal_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: f(:, :)
      real(wp), allocatable :: x(:)
      integer(ip) :: load, i

      allocate (x(self%n))
      do load = 1, size(f, 2, kind=ip)
         !$omp parallel do default(none) shared(self, x, f, load) if(is_shared(self%n))
         do i = 1, self%n
            x(self%elimination%place(i)) = f(i, load)
         end do
         !$omp end parallel do
         call forward(self%tree, self%factors, self%plan, x)
         f(:, load) = x
      end do
   end subroutine reduce_by_fronts

   subroutine expand_by_fronts(self, x)
      class(multifrontal_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: x(:, :)
      real(wp), allocatable :: by_place(:)
      integer(ip) :: load, i

      do load = 1, size(x, 2, kind=ip)
         by_place = x(:, load)
         call backward(self%tree, self%factors, self%plan, by_place)
         !$omp parallel do default(none) shared(self, x, by_place, load) if(is_shared(self%n))
         do i = 1, self%n
            x(i, load) = by_place(self%elimination%place(i))
         end do
         !$omp end parallel do
      end do
   end subroutine expand_by_fronts

   !> The factors and what leads through them.
   pure integer(lp) function fronts_memory(self) result(bytes)
      class(multifrontal_t), intent(in) :: self
      integer(ip) :: c

      bytes = 0
      if (.not. allocated(self%factors)) return
      bytes = INDEX_BYTES*(self%tree%start(self%tree%n_classes + 1) + self%n)
      do c = 1, self%tree%n_classes
         if (allocated(self%factors(c)%columns)) bytes = bytes + REAL_BYTES*size(self%factors(c)%columns, kind=lp)
         if (allocated(self%factors(c)%update)) bytes = bytes + REAL_BYTES*size(self%factors(c)%update, kind=lp)
      end do
   end function fronts_memory

   pure function fronts_name() result(name)
      character(len=:), allocatable :: name

      name = 'sparse'
   end function fronts_name

end module atrito_multifrontal
