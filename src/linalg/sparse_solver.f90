!> The sparse solver (atrito_multifrontal) for a body, with the retained equations as the last front.
!>
!> The multifrontal method eliminates supernodes, groups of equations, in dense matrices. Supernode p has a front: its own
!> equations, the pivots, and those of later supernodes that it couples to, the border. Into the front go the matrices of the
!> elements that have a pivot in it, and what the children of p in the tree of supernodes have left. Partial elimination,
!>
!>     [ F_pp  F_pb ]       F_pp = L L',   H = L^-1 F_pb,   F_bb - H'H,
!>     [ F_bp  F_bb ]
!>
!> leaves the columns of the factor, L and H, and a matrix on the border that is added to the front of the parent. The last front
!> has the retained equations alone; it is assembled and not eliminated, and so is the Schur complement.
!>
!> Of a plane mesh of n unknowns, numbered by nested dissection, the factor has about n log n entries and takes n^1.5 operations; a
!> band or a skyline has n^1.5 and n^2, as a front line across the mesh has n^0.5 unknowns all the way. Most operations are in the
!> last few fronts, which are dense matrices of n^0.5 rows: there the work goes at the rate of BLAS.
!>
!> Fronts that are equal, number by number, are factored once (atrito_front_tree): of a regular mesh a few hundred out of many
!> thousands.
!>
!> No pivot is chosen: the matrix is positive definite, and the loss of digits is known from its pivots as in the other solvers.
module atrito_sparse_solver
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: elimination_t, chain_elimination, element_store_t, begin_store, add_to_store, move_store, &
                                  sum_diagonals, unpack_matrix, fronts_t, front_bytes_t, plan_fronts, expect_factors, &
                                  factor_fronts, forward, backward, held_bytes, tell_of_memory
   use atrito_profile, only: profile_t
   use atrito_status, only: status_t
   use atrito_linear_solver, only: linear_solver_t, factor_report_t, add_one_by_one, note_pivot, set_pivot_status
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: sparse_t, expect_fronts

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INDEX_BYTES = storage_size(1_ip)/8, &
                             LONG_BYTES = storage_size(1_lp)/8
   !> Numbers of a supernode.
   integer(lp), parameter :: SUPERNODE_NUMBERS = 4_lp

   type, extends(linear_solver_t) :: sparse_t
      private
      type(elimination_t) :: elimination         !< order of the equations, and supernodes
      type(element_store_t) :: store             !< until factor
      type(fronts_t) :: fronts                   !< tree of fronts, and their factors after factor
   contains
      procedure :: create => create_fronts
      procedure :: add => add_to_fronts
      procedure :: add_store => add_store_to_fronts
      procedure :: factor => factor_and_report
      procedure :: get_schur => get_last_front
      procedure :: reduce => reduce_by_fronts
      procedure :: expand => expand_by_fronts
      procedure :: memory_bytes => fronts_memory
   end type sparse_t

contains

   !> Takes the order of elimination that came with the profile; without one the equations are eliminated as they are numbered, by
   !> blocks. Nothing is known of the fronts before all elements are there.
   subroutine create_fronts(self, profile, status)
      class(sparse_t), intent(inout) :: self !< its store is emptied
      type(profile_t), intent(in) :: profile !< closed
      type(status_t), intent(out) :: status  !< OK, since memory is asked for later

      self%n = profile%n
      self%n_retained = profile%n_retained
      self%report = factor_report_t()
      if (allocated(profile%elimination%position)) then
         self%elimination = profile%elimination
      else
         self%elimination = chain_elimination(self%n, self%n_retained)
      end if
      call begin_store(self%store)
   end subroutine create_fronts

   !> Keeps an element matrix until factor.
   subroutine add_to_fronts(self, equations, matrix)
      class(sparse_t), intent(inout) :: self  !< created, not yet factored
      integer(ip), intent(in) :: equations(:) !< equation numbers; 0 = prescribed, skipped
      real(wp), intent(in) :: matrix(:, :)    !< symmetric, of these equations

      call add_to_store(self%store, equations, matrix)
   end subroutine add_to_fronts

   !> The first store is taken as it is.
   subroutine add_store_to_fronts(self, store)
      class(sparse_t), intent(inout) :: self        !< created, not yet factored
      type(element_store_t), intent(inout) :: store !< is empty on return where it was the first

      if (self%store%n > 0) then
         call add_one_by_one(self, store)
      else
         call move_store(store, self%store)
      end if
   end subroutine add_store_to_fronts

   !> Finds the fronts and their classes, factors them, and tells of their pivots. What it will take at the most is known before a
   !> number is computed, from the tree alone. The diagonal is summed up first, since pivots are compared with what stood there
   !> before.
   subroutine factor_and_report(self, status)
      class(sparse_t), intent(inout) :: self !< all matrices added; they are given up
      type(status_t), intent(out) :: status  !< STATUS_SINGULAR, or STATUS_INTERNAL without memory
      real(wp), allocatable :: by_equation(:), diagonal(:)
      integer(lp) :: held
      integer :: no_memory
      logical :: enough

      self%report = factor_report_t()
      call plan_fronts(self%elimination, self%n, self%n_retained, self%store, self%fronts)
      call expect_bytes(self%fronts, self%n, self%store, held, self%report%most_bytes)
      allocate (by_equation(self%n), diagonal(self%n), stat=no_memory)
      enough = self%fronts%enough .and. no_memory == 0
      if (enough) then
         call sum_diagonals(self%store, self%store%n, by_equation)
         diagonal(self%elimination%position) = by_equation
         deallocate (by_equation)
      end if
      if (enough) call factor_fronts(self%fronts, self%store, diagonal, enough)
      self%store = element_store_t()
      if (enough) then
         call report_pivots(self, diagonal, status)
      else
         call tell_of_memory(status)
      end if
   end subroutine factor_and_report

   !> What the solver will hold of a body, and for a while at the most [bytes], from the tree of its fronts.
   subroutine expect_fronts(elimination, n, n_retained, store, held, most, enough)
      type(elimination_t), intent(in) :: elimination !< order of the equations and supernodes
      integer(ip), intent(in) :: n, n_retained       !< equations, and how many of the last ones are retained
      type(element_store_t), intent(in) :: store     !< matrices of all elements
      integer(lp), intent(out) :: held, most         !< of the factors [bytes]; at the peak of the factorisation [bytes]
      logical, intent(out) :: enough                 !< memory to tell
      type(fronts_t) :: fronts

      call plan_fronts(elimination, n, n_retained, store, fronts)
      call expect_bytes(fronts, n, store, held, most)
      enough = fronts%enough
   end subroutine expect_fronts

   !> What factors and fronts take, and beside them the lists that lead through the tree; at the most, also the element matrices,
   !> which are given back after the factorisation.
   subroutine expect_bytes(fronts, n, store, held, most)
      type(fronts_t), intent(in) :: fronts
      integer(ip), intent(in) :: n
      type(element_store_t), intent(in) :: store
      integer(lp), intent(out) :: held, most     !< 0 without the memory to tell
      type(front_bytes_t) :: bytes

      held = 0
      most = 0
      if (.not. fronts%enough) return
      call expect_factors(fronts, bytes)
      associate (lists => INDEX_BYTES*(fronts%start(fronts%n_classes + 1) + SUPERNODE_NUMBERS*fronts%n_supernodes + n), &
                 elements => (LONG_BYTES + INDEX_BYTES)*store%n + INDEX_BYTES*size(store%equations, kind=lp) &
                 + REAL_BYTES*size(store%values, kind=lp))
         held = bytes%held + lists
         most = bytes%most + lists + elements + REAL_BYTES*n
      end associate
   end subroutine expect_bytes

   !> The report of the pivots, class by class; the equation named is that of the first supernode of its class.
   !>
   !> Each class has kept the pivot that lost most of its diagonal, and its least and greatest ones; that is enough for the worst of
   !> all. Cholesky's method stops in a front at a pivot that is not positive, and the class is the last one that is looked at.
   !> Pivots of later fronts would have been made with what that one has left.
   subroutine report_pivots(self, diagonal, status)
      type(sparse_t), intent(inout) :: self
      real(wp), intent(in) :: diagonal(:)
      type(status_t), intent(out) :: status
      integer(ip) :: c, position
      logical :: usable

      usable = .true.
      self%report%n_fronts = self%fronts%n_supernodes
      self%report%n_different = self%fronts%n_classes
      do c = 1, self%fronts%n_classes
         associate (factor => self%fronts%factors(c))
            if (allocated(factor%columns)) self%report%entries = self%report%entries + size(factor%columns, kind=lp)
            if (factor%worst == 0 .or. .not. usable) cycle
            position = self%fronts%first(self%fronts%representative(c)) + factor%worst - 1
            call note_pivot(self%report, position, self%n, diagonal(position), factor%worst_pivot, usable)
            self%report%smallest_pivot = min(self%report%smallest_pivot, factor%smallest_pivot)
            self%report%largest_pivot = max(self%report%largest_pivot, factor%largest_pivot)
            usable = factor%failed == 0
         end associate
      end do
      if (self%report%worst_equation > 0) then
         self%report%worst_equation = findloc(self%elimination%position, self%report%worst_equation, dim=1)
      end if
      call set_pivot_status(self%report,.not. usable, status)
   end subroutine report_pivots

   !> The last front is S, as it was assembled.
   subroutine get_last_front(self, schur)
      class(sparse_t), intent(in) :: self  !< factored
      real(wp), intent(out) :: schur(:, :) !< (n_retained, n_retained)

      call unpack_matrix(self%fronts%factors(self%fronts%n_classes)%update, schur)
   end subroutine get_last_front

   !> f by positions, then forward through the tree, from the leaves to the root: x_p <- L^-1 x_p, and H' x_p is taken off the
   !> border. The half-solved supernode is left by positions.
   subroutine reduce_by_fronts(self, f)
      class(sparse_t), intent(in) :: self            !< factored
      real(wp), intent(inout), contiguous :: f(:, :) !< (n, loads)
      real(wp), allocatable :: x(:)
      integer(ip) :: load, i

      allocate (x(self%n))
      do load = 1, size(f, 2, kind=ip)
         !$omp parallel do default(none) shared(self, x, f, load) if(is_shared(self%n))
         do i = 1, self%n
            x(self%elimination%position(i)) = f(i, load)
         end do
         !$omp end parallel do
         call forward(self%fronts, x)
         f(:, load) = x
      end do
   end subroutine reduce_by_fronts

   !> Backward, from the root to the leaves: x_p <- L^-T (x_p - H x_b), with the border x_b that the ancestors have found; then by
   !> equations.
   subroutine expand_by_fronts(self, x)
      class(sparse_t), intent(in) :: self            !< factored
      real(wp), intent(inout), contiguous :: x(:, :) !< (n, loads): f_i above, x_c below
      real(wp), allocatable :: by_position(:)
      integer(ip) :: load, i

      do load = 1, size(x, 2, kind=ip)
         by_position = x(:, load)
         call backward(self%fronts, by_position)
         !$omp parallel do default(none) shared(self, x, by_position, load) if(is_shared(self%n))
         do i = 1, self%n
            x(i, load) = by_position(self%elimination%position(i))
         end do
         !$omp end parallel do
      end do
   end subroutine expand_by_fronts

   !> The factors and what leads through them.
   pure integer(lp) function fronts_memory(self) result(bytes)
      class(sparse_t), intent(in) :: self !< 0 before factor

      bytes = 0
      if (.not. allocated(self%fronts%factors)) return
      bytes = INDEX_BYTES*(self%fronts%start(self%fronts%n_classes + 1) + self%n) + sum(held_bytes(self%fronts%factors, 0_lp))
   end function fronts_memory

end module atrito_sparse_solver
