!> A symmetric positive definite matrix of which some element matrices change from one factorisation to the next.
!>
!> Fronts whose subtrees hold no such element are factored once, equal ones together. The others keep what they leave for their
!> parents, so a change is followed from its leaf up to the root, and nothing else is factored again.
!>
!> The last unknowns may be kept: they are assembled as the last front and not eliminated. With i for the others and k for these,
!> S = A_kk - A_ki A_ii^-1 A_ik is what the last factorisation leaves of the matrix, reduce_variable leaves f_k - A_ki A_ii^-1 f_i
!> of a load, and expand_variable finds x_i = A_ii^-1 (f_i - A_ik x_k).
!>
!> Some parts of the elimination may have negative pivots in place of positive ones (take_signs): F = -L L' of their fronts. Then it
!> is an elimination of a symmetric matrix without pivoting, and that all pivots have their signs tells how many eigenvalues are
!> negative.
!>
!> Use: create_variable_matrix; then set_variable_element, factor_variable_matrix and solve_variable_matrix as often as wanted; with
!> kept unknowns kept_values, reduce_variable and expand_variable in place of the last.
module atrito_variable_matrix
   use atrito_element_store, only: element_store_t, pack_matrix, move_store, sum_couplings, sum_diagonals
   use atrito_elimination, only: elimination_t
   use atrito_front_classes, only: children_of
   use atrito_front_factors, only: fronts_t, front_bytes_t, plan_fronts, factor_class, count_class, held_bytes, tell_of_memory, &
                                   REAL_BYTES, CHUNK_BYTES
   use atrito_front_records, only: HEADER
   use atrito_front_solves, only: forward, backward, solve_on_way
   use atrito_kinds, only: ip, lp, wp
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL, STATUS_SINGULAR
   implicit none (type, external)
   private
   public :: variable_matrix_t, create_variable_matrix, set_variable_element, factor_variable_matrix, solve_variable_matrix, &
             solve_at_variable, take_signs, kept_values, reduce_variable, expand_variable, add_fixed_product, fixed_diagonal, &
             variable_matrix_bytes, expect_variable_factors

   type :: variable_matrix_t
      integer(ip) :: n = 0                             !< equations
      integer(ip) :: n_kept = 0                        !< the last ones of them, which are not eliminated
      integer(ip) :: n_fixed = 0                       !< elements that do not change, the first ones
      integer(ip) :: n_fronts = 0, n_refactored = 0    !< all that are different; those of the last factorisation
      integer(ip) :: failed = 0                        !< equation whose pivot was not positive
      type(elimination_t), private :: elimination      !< order of equations, and supernodes
      type(element_store_t), private :: store          !< fixed elements, then the variable ones
      type(fronts_t), private :: fronts                !< factors of the last factorisation
      integer(ip), private :: first_matrix = 0         !< that of variable element v is first_matrix + v
      integer(ip), allocatable, private :: class_of(:) !< (variable elements) front that it is assembled in; 0: none
      logical, allocatable, private :: is_due(:)       !< (classes)
      integer(ip), allocatable, private :: way(:)  !< supernodes that vary, and less their children that do not (solve_on_way)
      integer(ip), allocatable, private :: reached(:) !< equations of the variable elements
      real(wp), allocatable, private :: front(:)       !< where fronts are assembled
   end type variable_matrix_t

   !> More parents than there are: what a front leaves is kept.
   integer(ip), parameter :: FOR_EVER = 1000000000_ip
   integer(lp), parameter :: INDEX_BYTES = storage_size(1_ip)/8, PART_BYTES = 5*INDEX_BYTES

contains

   !> Sets up the fronts. status: STATUS_INTERNAL when the memory does not suffice.
   subroutine create_variable_matrix(matrix, n, elimination, fixed, start, equations, status, n_kept)
      type(variable_matrix_t), intent(out) :: matrix !< all fronts are due
      integer(ip), intent(in) :: n                   !< equations
      type(elimination_t), intent(in) :: elimination !< of all of them; those that are kept last, in the order of their numbers
      type(element_store_t), intent(inout) :: fixed  !< elements that do not change; it is emptied
      integer(lp), intent(in) :: start(:)            !< (n_variable + 1)
      integer(ip), intent(in) :: equations(:)        !< of variable element v: start(v) + 1..start(v + 1); 0: prescribed
      type(status_t), intent(out) :: status          !< STATUS_INTERNAL where the memory does not suffice
      integer(ip), intent(in), optional :: n_kept    !< equations that are not eliminated, the last ones; none where it is left out

      matrix%n = n
      if (present(n_kept)) matrix%n_kept = n_kept
      matrix%n_fixed = fixed%n
      matrix%elimination = elimination
      matrix%first_matrix = fixed%n_matrices
      call move_store(fixed, matrix%store)
      call append_variable(start, equations, matrix%store)
      call plan_fronts(elimination, n, matrix%n_kept, matrix%store, matrix%fronts)
      if (.not. matrix%fronts%enough) call tell_of_memory(status)
      if (.not. matrix%fronts%enough) return
      matrix%n_fronts = matrix%fronts%n_classes - 1
      if (matrix%n_kept > 0) matrix%n_fronts = matrix%fronts%n_classes
      allocate (matrix%class_of(size(start) - 1), source=0_ip)
      allocate (matrix%is_due(matrix%fronts%n_classes), source=.true.)
      call find_variable_fronts(matrix)
   end subroutine create_variable_matrix

   !> Every variable element has a matrix of its own, so the fronts that it reaches have no equals.
   subroutine append_variable(start, equations, store)
      integer(lp), intent(in) :: start(:)
      integer(ip), intent(in) :: equations(:)
      type(element_store_t), intent(inout) :: store
      integer(lp) :: length, first
      integer(ip) :: v, n_variable
      integer(lp), allocatable :: matrix_start(:)
      real(wp), allocatable :: values(:)

      n_variable = size(start, kind=ip) - 1
      first = store%start(store%n + 1)
      store%start = [store%start(:store%n + 1), start(2:) + first]
      store%equations = [store%equations(:first), equations]
      store%matrix_of = [store%matrix_of(:store%n), (store%n_matrices + v, v=1, n_variable)]
      allocate (matrix_start(store%n_matrices + n_variable + 1))
      matrix_start(:store%n_matrices + 1) = store%matrix_start(:store%n_matrices + 1)
      do v = 1, n_variable
         length = start(v + 1) - start(v)
         matrix_start(store%n_matrices + v + 1) = matrix_start(store%n_matrices + v) + length*(length + 1)/2
      end do
      first = store%matrix_start(store%n_matrices + 1)
      allocate (values(matrix_start(size(matrix_start))))
      values(:first) = store%values(:first)
      values(first + 1:) = 0.0_wp
      call move_alloc(values, store%values)
      call move_alloc(matrix_start, store%matrix_start)
      store%n = store%n + n_variable
      store%n_matrices = store%n_matrices + n_variable
   end subroutine append_variable

   !> Where each variable element is assembled. What the children of such fronts, and of those above them, leave is kept.
   !>
   !> A front varies when one of its elements does or one of its children. Fronts stand behind their children, so one pass finds
   !> them all. The update of a child is given back as soon as its parents are factored; below a front that varies it is needed
   !> again with the next factorisation, and the number of parents it waits for is set beyond reach.
   subroutine find_variable_fronts(matrix)
      type(variable_matrix_t), intent(inout) :: matrix
      logical :: varies(matrix%fronts%n_classes)
      integer(ip), allocatable :: children(:)
      integer(ip) :: c, i, m
      integer(lp) :: k

      varies = .true.                              ! the root, where nothing is kept, is no front and joins the trees
      do c = 1, matrix%n_fronts
         children = children_of(matrix%fronts, c)
         varies(c) = any(varies(children))
         associate (record => matrix%fronts%record(matrix%fronts%start(c) + 1:matrix%fronts%start(c + 1)))
            k = HEADER
            do i = 1, record(3)
               k = k + 2 + record(k + 2)
            end do
            do i = 1, record(4)
               m = record(k + 1) - matrix%first_matrix
               if (m > 0) varies(c) = .true.
               if (m > 0) matrix%class_of(m) = c
               k = k + 2 + record(k + 2)
            end do
         end associate
         if (.not. varies(c)) cycle
         do i = 1, size(children, kind=ip)
            matrix%fronts%waiting(children(i)) = FOR_EVER
         end do
      end do
      call find_way(matrix, varies)
   end subroutine find_variable_fronts

   !> The supernodes that vary and their children, and the equations of the variable elements.
   !>
   !> From the root down: parents wait on a stack, once for each child, as in atrito_front_solves.
   subroutine find_way(matrix, varies)
      type(variable_matrix_t), intent(inout) :: matrix
      logical, intent(in) :: varies(:)             !< (classes)
      integer(ip) :: way(matrix%fronts%n_supernodes), p, first
      logical :: waits(matrix%fronts%n_supernodes + 1), of_way
      logical :: is_reached(matrix%n)
      integer(ip) :: top, i

      first = size(way, kind=ip) + 1
      top = 0
      do p = size(way, kind=ip), 1, -1
         associate (c => matrix%fronts%class_of(p))
            of_way = varies(c)
            if (top > 0) of_way = waits(top)
            top = max(top - 1, 0)
            if (of_way) then
               first = first - 1
               way(first) = merge(p, -p, varies(c))
            end if
            do i = 1, matrix%fronts%record(matrix%fronts%start(c) + 3)
               top = top + 1
               waits(top) = varies(c)
            end do
         end associate
      end do
      matrix%way = way(first:)
      is_reached = .false.
      associate (store => matrix%store)
         do i = int(store%start(matrix%n_fixed + 1), ip) + 1, int(store%start(store%n + 1), ip)
            if (store%equations(i) > 0) is_reached(store%equations(i)) = .true.
         end do
      end associate
      matrix%reached = pack([(i, i=1, matrix%n)], is_reached)
   end subroutine find_way

   !> Which equations have negative pivots; all of a part of the elimination have, or none. status: STATUS_INTERNAL where parts that
   !> have and parts that have not share a front.
   subroutine take_signs(matrix, is_negative, status)
      type(variable_matrix_t), intent(inout) :: matrix
      logical, intent(in) :: is_negative(:)        !< (n)
      type(status_t), intent(out) :: status
      integer(ip) :: p

      allocate (matrix%fronts%is_negative(matrix%n))
      matrix%fronts%is_negative(matrix%elimination%position) = is_negative
      associate (fronts => matrix%fronts, first => matrix%fronts%first)
         do p = 1, fronts%n_supernodes - 1
            associate (shared => first(fronts%representative(fronts%class_of(p))))
               if (any(fronts%is_negative(first(p):first(p + 1) - 1) .neqv. fronts%is_negative(min(shared, matrix%n)))) then
                  call set_status(status, STATUS_INTERNAL, 'a front of both signs')
               end if
            end associate
         end do
      end associate
   end subroutine take_signs

   !> The next factorisation takes this matrix for a variable element.
   subroutine set_variable_element(matrix, v, values)
      type(variable_matrix_t), intent(inout) :: matrix !< the front of the element becomes due
      integer(ip), intent(in) :: v                     !< variable element, 1 .. n_variable
      real(wp), intent(in) :: values(:, :)             !< symmetric, of its equations
      integer(lp) :: first, last

      first = matrix%store%matrix_start(matrix%first_matrix + v)
      last = matrix%store%matrix_start(matrix%first_matrix + v + 1)
      call pack_matrix(values, matrix%store%values(first + 1:last))
      if (matrix%class_of(v) > 0) matrix%is_due(matrix%class_of(v)) = .true.
   end subroutine set_variable_element

   !> Factors what has changed.
   !>
   !> A front is due when one of its elements has another matrix or one of its children was due: those on the ways from the changed
   !> elements to the root, and no other.
   !>
   !> status: STATUS_SINGULAR when a pivot is not positive (matrix%failed), STATUS_INTERNAL when the
   !> memory does not suffice.
   subroutine factor_variable_matrix(matrix, status)
      type(variable_matrix_t), intent(inout) :: matrix !< every variable element has been set once
      type(status_t), intent(out) :: status            !< OK, or as above
      real(wp), allocatable :: no_diagonal(:)      ! pivots are judged by their sign alone
      integer(ip) :: c
      integer :: no_memory

      matrix%n_refactored = 0
      matrix%failed = 0
      allocate (no_diagonal(matrix%n), source=0.0_wp)
      associate (fronts => matrix%fronts)
         if (.not. allocated(matrix%front)) allocate (matrix%front(int(maxval(fronts%factors%order), lp)**2), stat=no_memory)
         if (.not. allocated(matrix%front)) call tell_of_memory(status)
         if (.not. allocated(matrix%front)) return
         do c = 1, matrix%n_fronts
            matrix%is_due(c) = matrix%is_due(c) .or. any(matrix%is_due(children_of(fronts, c)))
            if (.not. matrix%is_due(c)) cycle
            matrix%n_refactored = matrix%n_refactored + 1
            call factor_class(matrix%store, no_diagonal, c, fronts%factors(c)%order, fronts, matrix%front)
            if (fronts%factors(c)%done) cycle
            call report_failure(matrix, c, status)
            return
         end do
      end associate
      matrix%is_due = .false.
   end subroutine factor_variable_matrix

   subroutine report_failure(matrix, c, status)
      type(variable_matrix_t), intent(inout) :: matrix
      integer(ip), intent(in) :: c
      type(status_t), intent(out) :: status
      integer(ip) :: position

      if (all(matrix%fronts%waiting(children_of(matrix%fronts, c)) > FOR_EVER/2)) then
         matrix%is_due(:c - 1) = .false.           ! what was factored has its update, and others may not be there any more
      else
         matrix%is_due = .true.
      end if
      if (.not. matrix%fronts%factors(c)%enough) call tell_of_memory(status)
      if (.not. matrix%fronts%factors(c)%enough) return
      position = matrix%fronts%first(matrix%fronts%representative(c)) + max(matrix%fronts%factors(c)%failed, 1_ip) - 1
      matrix%failed = findloc(matrix%elimination%position, position, dim=1, kind=ip)
      call set_status(status, STATUS_SINGULAR, 'a pivot is not positive')
   end subroutine report_failure

   !> x <- A^-1 x.
   subroutine solve_variable_matrix(matrix, x)
      type(variable_matrix_t), intent(in) :: matrix !< factored, nothing kept
      real(wp), intent(inout) :: x(:)               !< (n)

      call reduce_variable(matrix, x)
      call expand_variable(matrix, x)
   end subroutine solve_variable_matrix

   !> x <- A^-1 x at the equations of the variable elements, of a load at these alone; x elsewhere stays.
   !>
   !> Only the fronts on the ways from these elements to the root take part, those that a change of all of them would factor anew.
   subroutine solve_at_variable(matrix, x)
      type(variable_matrix_t), intent(in) :: matrix
      real(wp), intent(inout) :: x(:)              !< (n)
      real(wp) :: by_position(matrix%n)

      by_position = 0.0_wp
      associate (at => matrix%elimination%position(matrix%reached))
         by_position(at) = x(matrix%reached)
         call solve_on_way(matrix%fronts, matrix%way, by_position)
         x(matrix%reached) = by_position(at)
      end associate
   end subroutine solve_at_variable

   !> What the last factorisation leaves of the matrix at the kept unknowns, their Schur complement: the lower triangle by columns,
   !> where the matrix has it. Whoever changes it puts it back. Not associated where nothing is kept.
   function kept_values(matrix) result(values)
      type(variable_matrix_t), intent(in), target :: matrix !< factored
      real(wp), pointer, contiguous :: values(:)            !< (n_kept (n_kept + 1)/2)

      nullify (values)
      if (matrix%n_kept > 0) values => matrix%fronts%factors(matrix%n_fronts)%update
   end function kept_values

   !> f <- L^-1 f by positions; the last n_kept are what it leaves at the kept unknowns.
   subroutine reduce_variable(matrix, f)
      type(variable_matrix_t), intent(in) :: matrix !< factored
      real(wp), intent(inout) :: f(:)               !< (n) in: by unknowns; out: by positions
      real(wp), allocatable :: by_position(:)

      allocate (by_position(matrix%n))
      by_position(matrix%elimination%position) = f
      call forward(matrix%fronts, by_position)
      f = by_position
   end subroutine reduce_variable

   !> x <- L^-T x behind reduce_variable, with the kept unknowns in the last n_kept places.
   subroutine expand_variable(matrix, x)
      type(variable_matrix_t), intent(in) :: matrix !< factored
      real(wp), intent(inout) :: x(:)               !< (n) in: by positions; out: by unknowns
      real(wp), allocatable :: by_position(:)

      by_position = x
      if (allocated(matrix%fronts%is_negative)) by_position = merge(-x, x, matrix%fronts%is_negative)
      call backward(matrix%fronts, by_position)
      x = by_position(matrix%elimination%position)
   end subroutine expand_variable

   !> y <- y + A x for the elements that do not change, each with the matrix that it has itself.
   subroutine add_fixed_product(matrix, x, y)
      type(variable_matrix_t), intent(in) :: matrix !< need not be factored
      real(wp), intent(in) :: x(:)                  !< (n)
      real(wp), intent(inout) :: y(:)               !< (n)
      integer(ip) :: e, n
      integer(lp) :: first

      associate (store => matrix%store)
         do e = 1, matrix%n_fixed
            first = store%start(e)
            n = int(store%start(e + 1) - first, ip)
            if (e <= store%own%n) then
               call add_element_product(n, store%equations(first + 1:first + n), &
                                        store%own%values(store%own%matrix_start(store%own%matrix_of(e)) + 1:), store%translates, &
                                        x, y)
            else
               call add_element_product(n, store%equations(first + 1:first + n), &
                                        store%values(store%matrix_start(store%matrix_of(e)) + 1:), store%translates, x, y)
            end if
         end do
      end associate
   end subroutine add_fixed_product

   !> With the displacements less those of the first node, whose part in the forces is none: a stiffness is free of forces under
   !> translation, and what cancels is left out. (Along a radius it is not.)
   !>
   !> Of a packed lower triangle column j has a_jj and the a_ij below it, which stand for a_ji, too:
   !>
   !>     y_j <- y_j + a_jj x_j + sum_i a_ij x_i,     y_i <- y_i + a_ij x_j     (i > j)
   !>
   !> n^2 multiplications and additions with half as many numbers from memory.
   pure subroutine add_element_product(n, equations, packed, translates, x, y)
      integer(ip), intent(in) :: n, equations(n)
      real(wp), intent(in) :: packed(*)
      logical, intent(in) :: translates(2)
      real(wp), intent(in) :: x(:)
      real(wp), intent(inout) :: y(:)
      real(wp) :: xe(n), ye(n)
      integer(ip) :: i, j, k

      do i = 1, n
         xe(i) = 0.0_wp
         if (equations(i) > 0) xe(i) = x(equations(i))
      end do
      if (n > 2) then
         do i = n, 1, -1
            if (translates(2 - mod(i, 2_ip))) xe(i) = xe(i) - xe(2 - mod(i, 2_ip))
         end do
      end if
      ye = 0.0_wp
      k = 0
      do j = 1, n
         ye(j) = ye(j) + packed(k + 1)*xe(j) + dot_product(packed(k + 2:k + 1 + n - j), xe(j + 1:))
         ye(j + 1:) = ye(j + 1:) + packed(k + 2:k + 1 + n - j)*xe(j)
         k = k + n - j + 1
      end do
      do i = 1, n
         if (equations(i) > 0) y(equations(i)) = y(equations(i)) + ye(i)
      end do
   end subroutine add_element_product

   !> The diagonal of the elements that do not change, and the coupling of sum_couplings.
   pure subroutine fixed_diagonal(matrix, diagonal, coupling)
      type(variable_matrix_t), intent(in) :: matrix  !< need not be factored
      real(wp), intent(out) :: diagonal(:)           !< (n)
      real(wp), intent(out), optional :: coupling(:) !< (n)

      call sum_diagonals(matrix%store, matrix%n_fixed, diagonal)
      if (present(coupling)) call sum_couplings(matrix%store, matrix%n_fixed, coupling)
   end subroutine fixed_diagonal

   !> What the first factorisation will add to the matrix, before it does.
   pure subroutine expect_variable_factors(matrix, bytes)
      type(variable_matrix_t), intent(in) :: matrix !< created, not factored yet
      type(front_bytes_t), intent(out) :: bytes     !< what it held is left out; both count the front in hand
      integer(ip) :: waiting(matrix%fronts%n_classes), c

      waiting = matrix%fronts%waiting
      do c = 1, matrix%n_fronts
         call count_class(matrix%fronts, c, waiting, bytes)
      end do
      associate (front => REAL_BYTES*int(maxval(matrix%fronts%factors%order), lp)**2)
         bytes%held = bytes%held + front
         bytes%most = bytes%most + front
      end associate
   end subroutine expect_variable_factors

   !> What the matrix holds now [bytes].
   pure integer(lp) function variable_matrix_bytes(matrix) result(bytes)
      type(variable_matrix_t), intent(in) :: matrix !< with factors, if there are any

      associate (fronts => matrix%fronts, store => matrix%store)
         bytes = INDEX_BYTES*(size(fronts%record, kind=lp) + matrix%n) + PART_BYTES*fronts%n_supernodes &
                 + INDEX_BYTES*size(store%equations, kind=lp) + REAL_BYTES*size(store%values, kind=lp) &
                 + (REAL_BYTES + INDEX_BYTES)*int(store%n, lp) + fronts%n_classes*(storage_size(fronts%factors, kind=lp)/8) &
                 + sum(held_bytes(fronts%factors, CHUNK_BYTES))
         if (store%own%n > 0) bytes = bytes + REAL_BYTES*size(store%own%values, kind=lp) &
                                      + (REAL_BYTES + INDEX_BYTES)*int(store%own%n, lp)
         if (allocated(matrix%front)) bytes = bytes + REAL_BYTES*size(matrix%front, kind=lp)
      end associate
   end function variable_matrix_bytes

end module atrito_variable_matrix
