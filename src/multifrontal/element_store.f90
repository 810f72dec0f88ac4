!> Element matrices as they come, for a solver that adds them up later.
!>
!> Elements that share one matrix with the element before share its place in memory: a regular mesh has a single matrix.
module atrito_element_store
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: element_store_t, begin_store, add_to_store, move_store, take_own_matrices, sum_diagonals, sum_couplings
   public :: pack_matrix, unpack_matrix

   !> Matrices of elements, several of which may have one in common.
   type :: matrices_t
      integer(ip) :: n = 0                       !< elements
      integer(ip), allocatable :: matrix_of(:)   !< (n or more)
      integer(lp), allocatable :: matrix_start(:) !< matrix m: values(matrix_start(m) + 1:matrix_start(m + 1))
      real(wp), allocatable :: values(:)         !< lower triangles by columns
   end type matrices_t

   type, extends(matrices_t) :: element_store_t
      integer(lp), allocatable :: start(:)       !< (n + 1 or more) equations of element e: equations(start(e) + 1:start(e + 1))
      integer(ip), allocatable :: equations(:)   !< 0: prescribed
      integer(ip) :: n_matrices = 0              !< different ones
      logical :: is_near = .false.               !< some elements have the matrix of one that they are near to, and not equal
      type(matrices_t) :: own                    !< then those of the first elements themselves, where they are wanted
      logical :: enough = .true.                 !< memory, for all elements so far; the others are left out
      logical :: translates(2) = .true.          !< free of forces where the 1st, 3rd, ... equations move alike; the 2nd, 4th, ...
   end type element_store_t

contains

   !> An empty store with room for some elements.
   pure subroutine begin_store(store)
      type(element_store_t), intent(out) :: store !< holds no element
      integer(ip), parameter :: ROOM = 1024_ip

      allocate (store%start(ROOM), store%equations(8*ROOM), store%matrix_of(ROOM), store%matrix_start(ROOM), store%values(64*ROOM))
      store%start(1) = 0
      store%matrix_start(1) = 0
   end subroutine begin_store

   !> Adds the matrix of an element at its equations. A matrix that is the newest one bit by bit is stored once. store%enough is
   !> false, and nothing is added, where there is no memory for it.
   pure subroutine add_to_store(store, equations, matrix)
      type(element_store_t), intent(inout) :: store !< gets one element more, if there is memory
      integer(ip), intent(in) :: equations(:)       !< 0: prescribed
      real(wp), intent(in) :: matrix(:, :)          !< symmetric
      integer(lp) :: first
      integer(ip) :: m
      logical :: is_new

      m = size(equations, kind=ip)
      is_new = .not. is_newest(store, m, matrix)
      call make_room(store, m, is_new)
      if (.not. store%enough) return
      first = store%start(store%n + 1)
      store%n = store%n + 1
      store%equations(first + 1:first + m) = equations
      store%start(store%n + 1) = first + m
      if (is_new) then
         first = store%matrix_start(store%n_matrices + 1)
         store%n_matrices = store%n_matrices + 1
         store%matrix_start(store%n_matrices + 1) = first + packed_size(m)
         call pack_matrix(matrix, store%values(first + 1:first + packed_size(m)))
      end if
      store%matrix_of(store%n) = store%n_matrices
   end subroutine add_to_store

   pure integer(lp) function packed_size(m)
      integer(ip), intent(in) :: m

      packed_size = int(m, lp)*int(m + 1, lp)/2
   end function packed_size

   !> Room for one element more, and for its matrix.
   pure subroutine make_room(store, m, is_new)
      type(element_store_t), intent(inout) :: store
      integer(ip), intent(in) :: m               !< its equations
      logical, intent(in) :: is_new
      integer(lp) :: n, n_equations, n_values

      n = store%n + 2
      n_equations = store%start(store%n + 1) + m
      n_values = store%matrix_start(store%n_matrices + 1)
      if (is_new) n_values = n_values + packed_size(m)
      if (store%enough .and. n > size(store%start)) call grow(store%start, 2*n, store%enough)
      if (store%enough .and. n > size(store%matrix_of)) call grow(store%matrix_of, 2*n, store%enough)
      if (store%enough .and. n > size(store%matrix_start)) call grow(store%matrix_start, 2*n, store%enough)
      if (store%enough .and. n_equations > size(store%equations, kind=lp)) call grow(store%equations, 2*n_equations, store%enough)
      if (store%enough .and. n_values > size(store%values, kind=lp)) call grow(store%values, 2*n_values, store%enough)
   end subroutine make_room

   !> Whether a matrix is the one that was stored last.
   pure logical function is_newest(store, m, matrix)
      type(element_store_t), intent(in) :: store
      integer(ip), intent(in) :: m
      real(wp), intent(in) :: matrix(m, m)
      integer(lp) :: first
      integer(ip) :: j

      is_newest = .false.
      if (store%n_matrices == 0) return
      first = store%matrix_start(store%n_matrices)
      if (store%matrix_start(store%n_matrices + 1) - first /= packed_size(m)) return
      do j = 1, m
         if (any(store%values(first + 1:first + m - j + 1) /= matrix(j:, j))) return
         first = first + m - j + 1
      end do
      is_newest = .true.
   end function is_newest

   !> The lower triangle of a matrix, by columns.
   pure subroutine pack_matrix(matrix, packed)
      real(wp), intent(in) :: matrix(:, :)       !< symmetric, (m, m)
      real(wp), intent(out) :: packed(:)         !< (m(m + 1)/2)
      integer(ip) :: i, j, k

      k = 0
      do j = 1, size(matrix, 2, kind=ip)
         do i = j, size(matrix, 1, kind=ip)
            k = k + 1
            packed(k) = matrix(i, j)
         end do
      end do
   end subroutine pack_matrix

   !> The inverse of pack_matrix.
   pure subroutine unpack_matrix(packed, matrix)
      real(wp), intent(in) :: packed(:)          !< (m(m + 1)/2)
      real(wp), intent(out) :: matrix(:, :)      !< (m, m)
      integer(ip) :: i, j, k

      k = 0
      do j = 1, size(matrix, 2, kind=ip)
         do i = j, size(matrix, 1, kind=ip)
            k = k + 1
            matrix(i, j) = packed(k)
            matrix(j, i) = packed(k)
         end do
      end do
   end subroutine unpack_matrix

   !> The diagonal of the first elements.
   pure subroutine sum_diagonals(store, n_elements, diagonal)
      type(element_store_t), intent(in) :: store !< several elements may have one matrix
      integer(ip), intent(in) :: n_elements      !< the first so many are summed
      real(wp), intent(out) :: diagonal(:)       !< (equations)
      integer(ip) :: e, i, k, n
      integer(lp) :: first, at

      diagonal = 0.0_wp
      do e = 1, n_elements
         first = store%start(e)
         n = int(store%start(e + 1) - first, ip)
         at = store%matrix_start(store%matrix_of(e)) + 1
         do i = 1, n
            k = store%equations(first + i)
            if (k > 0) diagonal(k) = diagonal(k) + store%values(at)
            at = at + n - i + 1                  ! the next column is shorter by one
         end do
      end do
   end subroutine sum_diagonals

   !> What the first, third, ... equation of the first elements has with the next one: two displacements of a node.
   pure subroutine sum_couplings(store, n_elements, coupling)
      type(element_store_t), intent(in) :: store !< several elements may have one matrix
      integer(ip), intent(in) :: n_elements      !< the first so many are summed
      real(wp), intent(out) :: coupling(:)       !< (equations)
      integer(ip) :: e, i, k, n
      integer(lp) :: first, at

      coupling = 0.0_wp
      do e = 1, n_elements
         first = store%start(e)
         n = int(store%start(e + 1) - first, ip)
         at = store%matrix_start(store%matrix_of(e)) + 1
         do i = 1, n - 1, 2
            k = store%equations(first + i)
            if (k > 0) coupling(k) = coupling(k) + store%values(at + 1)
            at = at + 2*(n - i) + 1              ! two columns on
         end do
      end do
   end subroutine sum_couplings

   !> Takes over the matrices of a store of the same elements, each with its own; only its lists of equations are left in it.
   pure subroutine take_own_matrices(from, store)
      type(element_store_t), intent(inout) :: from  !< loses its matrices, keeps its equations
      type(element_store_t), intent(inout) :: store !< gets them as `own`

      call move_matrices(from%matrices_t, store%own)
      from%n_matrices = 0
   end subroutine take_own_matrices

   pure subroutine move_matrices(from, to)
      type(matrices_t), intent(inout) :: from
      type(matrices_t), intent(inout) :: to

      to%n = from%n
      from%n = 0
      call move_alloc(from%matrix_of, to%matrix_of)
      call move_alloc(from%matrix_start, to%matrix_start)
      call move_alloc(from%values, to%values)
   end subroutine move_matrices

   !> Moves what a store holds into another one; nothing is left in it.
   pure subroutine move_store(from, to)
      type(element_store_t), intent(inout) :: from !< is left empty
      type(element_store_t), intent(out) :: to     !< what it held is lost

      to%n_matrices = from%n_matrices
      to%is_near = from%is_near
      to%translates = from%translates
      from%n_matrices = 0
      call move_alloc(from%start, to%start)
      call move_alloc(from%equations, to%equations)
      call move_matrices(from%matrices_t, to%matrices_t)
      call move_matrices(from%own, to%own)
   end subroutine move_store

end module atrito_element_store
