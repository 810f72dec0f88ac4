!> Element matrices as they come, for a solver that adds them up later.
!>
!> Elements that share one matrix with the element before share its place in memory: a regular mesh has a single matrix.
module atrito_element_store
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: element_store_t, begin_store, add_to_store, move_store, take_own_matrices, pack_matrix, unpack_matrix

   !> The matrices that elements have themselves, where they were stored with that of another one.
   type :: own_matrices_t
      integer(ip) :: n = 0                       !< the first so many elements
      integer(ip), allocatable :: matrix_of(:)   !< (n)
      integer(lp), allocatable :: matrix_start(:) !< matrix m: values(matrix_start(m) + 1:)
      real(wp), allocatable :: values(:)         !< lower triangles by columns
   end type own_matrices_t

   type :: element_store_t
      integer(ip) :: n = 0                       !< elements
      integer(lp), allocatable :: start(:)       !< (n + 1 or more) equations of element e: equations(start(e) + 1:start(e + 1))
      integer(ip), allocatable :: equations(:)   !< 0: prescribed
      integer(ip), allocatable :: matrix_of(:)   !< (n or more)
      integer(ip) :: n_matrices = 0              !< different ones
      integer(lp), allocatable :: matrix_start(:) !< (n_matrices + 1 or more) matrix m: values(matrix_start(m) + 1:)
      real(wp), allocatable :: values(:)         !< lower triangles by columns
      logical :: is_near = .false.               !< some elements have the matrix of one that they are near to, and not equal
      type(own_matrices_t) :: own                !< then, where they are wanted
      logical :: enough = .true.                 !< memory, for all elements so far; the others are left out
   end type element_store_t

contains

   pure subroutine begin_store(store)
      type(element_store_t), intent(out) :: store
      integer(ip), parameter :: ROOM = 1024_ip

      allocate (store%start(ROOM), store%equations(8*ROOM), store%matrix_of(ROOM), store%matrix_start(ROOM), store%values(64*ROOM))
      store%start(1) = 0
      store%matrix_start(1) = 0
   end subroutine begin_store

   pure subroutine add_to_store(store, equations, matrix)
      type(element_store_t), intent(inout) :: store
      integer(ip), intent(in) :: equations(:)    !< 0: prescribed
      real(wp), intent(in) :: matrix(:, :)       !< symmetric
      integer(lp) :: first
      integer(ip) :: m
      logical :: is_new

      m = size(equations, kind=ip)
      is_new = .not. is_newest(store, m, matrix)
      if (store%enough) call make_room(store, m)
      if (store%enough .and. is_new) call make_room_for_values(store, m)
      if (.not. store%enough) return
      first = store%start(store%n + 1)
      store%n = store%n + 1
      store%equations(first + 1:first + m) = equations
      store%start(store%n + 1) = first + m
      if (is_new) call add_values(store, m, matrix)
      store%matrix_of(store%n) = store%n_matrices
   end subroutine add_to_store

   !> Room for one element more.
   pure subroutine make_room(store, m)
      type(element_store_t), intent(inout) :: store
      integer(ip), intent(in) :: m               !< its equations
      integer(lp) :: needed

      if (store%n + 2 > size(store%start)) call grow(store%start, 2*size(store%start, kind=lp), store%enough)
      if (store%enough .and. store%n + 1 > size(store%matrix_of)) then
         call grow(store%matrix_of, 2*size(store%matrix_of, kind=lp), store%enough)
      end if
      needed = store%start(store%n + 1) + m
      if (store%enough .and. needed > size(store%equations, kind=lp)) call grow(store%equations, 2*needed, store%enough)
   end subroutine make_room

   !> Room for one matrix more.
   pure subroutine make_room_for_values(store, m)
      type(element_store_t), intent(inout) :: store
      integer(ip), intent(in) :: m               !< its order
      integer(lp) :: needed

      if (store%n_matrices + 2 > size(store%matrix_start)) then
         call grow(store%matrix_start, 2*size(store%matrix_start, kind=lp), store%enough)
      end if
      needed = store%matrix_start(store%n_matrices + 1) + int(m, lp)*int(m + 1, lp)/2
      if (store%enough .and. needed > size(store%values, kind=lp)) call grow(store%values, 2*needed, store%enough)
   end subroutine make_room_for_values

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
      if (store%matrix_start(store%n_matrices + 1) - first /= int(m, lp)*int(m + 1, lp)/2) return
      do j = 1, m
         if (any(store%values(first + 1:first + m - j + 1) /= matrix(j:, j))) return
         first = first + m - j + 1
      end do
      is_newest = .true.
   end function is_newest

   pure subroutine add_values(store, m, matrix)
      type(element_store_t), intent(inout) :: store
      integer(ip), intent(in) :: m
      real(wp), intent(in) :: matrix(m, m)
      integer(lp) :: first, last

      first = store%matrix_start(store%n_matrices + 1)
      last = first + int(m, lp)*int(m + 1, lp)/2
      store%n_matrices = store%n_matrices + 1
      call pack_matrix(matrix, store%values(first + 1:last))
      store%matrix_start(store%n_matrices + 1) = last
   end subroutine add_values

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

   !> Takes over the matrices of a store of the same elements, each with its own; nothing is left in it.
   pure subroutine take_own_matrices(from, store)
      type(element_store_t), intent(inout) :: from
      type(element_store_t), intent(inout) :: store

      store%own%n = from%n
      call move_alloc(from%matrix_of, store%own%matrix_of)
      call move_alloc(from%matrix_start, store%own%matrix_start)
      call move_alloc(from%values, store%own%values)
      from%n = 0
      from%n_matrices = 0
   end subroutine take_own_matrices

   !> Moves what a store holds into another one; nothing is left in it.
   pure subroutine move_store(from, to)
      type(element_store_t), intent(inout) :: from
      type(element_store_t), intent(out) :: to

      to%n = from%n
      to%n_matrices = from%n_matrices
      call move_alloc(from%start, to%start)
      call move_alloc(from%equations, to%equations)
      call move_alloc(from%matrix_of, to%matrix_of)
      call move_alloc(from%matrix_start, to%matrix_start)
      call move_alloc(from%values, to%values)
      to%is_near = from%is_near
      to%own%n = from%own%n
      call move_alloc(from%own%matrix_of, to%own%matrix_of)
      call move_alloc(from%own%matrix_start, to%own%matrix_start)
      call move_alloc(from%own%values, to%own%values)
      from%n = 0
      from%n_matrices = 0
   end subroutine move_store

end module atrito_element_store
