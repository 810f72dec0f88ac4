!> Sums over the elements of a body: matrix and profile.
!>
!> Neighbours in a regular mesh are equal, and one stiffness serves them all. Elements are compared with the last one that was
!> different, so that small differences do not add up along a mesh.
!>
!> Where the coordinates of a regular mesh were printed with 10 to 15 digits, no two elements are equal, but most are within the
!> `digit_error` of those digits. Whoever puts the difference right afterwards takes one stiffness for these, too.
module atrito_assembly
   use atrito_element_table, only: MOST_NODES
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, side_count
   use atrito_bodies, only: bodies_t, element_equations
   use atrito_element, only: element_stiffness
   use atrito_multifrontal, only: element_store_t, pack_matrix
   use atrito_plane_state, only: elastic_t, IS_TAPERED, STATES
   use atrito_profile, only: profile_t, begin_profile, add_to_profile, close_profile, expect_profile
   use atrito_linear_solver, only: linear_solver_t
   use atrito_tapered, only: has_thickness
   use atrito_threads, only: is_shared, chunk_count, find_chunk, CHUNK_LENGTH
   implicit none (type, external)
   private
   public :: fem_t, form_t, stiffness_cache_t, body_profile, collect_elements, assemble_body, &
             retained_diagonal, cached_stiffness, digit_error_of, has_form, take_form

   !> The elements and their sections: what every sum over elements needs.
   type :: fem_t
      type(mesh_t), pointer :: mesh => null()      !< the model's: a mesh is large, and nothing changes it
      type(bodies_t) :: bodies                     !< with their equations, once these are numbered
      type(elastic_t), allocatable :: sections(:)  !< elastic constants, thickness and integration of each
      integer(ip), allocatable :: section_of(:)    !< (n_elements)
      real(wp) :: digit_error = 0.0_wp             !< [L] what the last printed digits may make of equal elements; 0: nothing
      real(wp), allocatable :: heating(:)          !< (n_nodes) rise of the temperature; not allocated where nothing expands
      real(wp), allocatable :: own_strain(:, :)    !< (3, n_elements) e11, e22, e12 without stress; not allocated: none
   end type fem_t

   !> All that a stiffness, and the strains at the points of an element, depend on. Coordinates are relative to the first node, so
   !> that the place of the origin costs no digits.
   type :: form_t
      integer(ip) :: section = 0, state = 0        !< 0: nothing yet
      integer(ip) :: shape = 0                     !< nodes
      logical :: has_hoop = .false.                !< axisymmetric: the radius matters
      real(wp) :: x(2, MOST_NODES) = 0.0_wp        !< [L]
      real(wp) :: radius = 0.0_wp                  !< of the first node, where it matters [L]
      real(wp) :: thickness(MOST_NODES) = 0.0_wp   !< of the nodes, of tapered elements [L]
   end type form_t

   !> The stiffness computed last.
   type, extends(form_t) :: stiffness_cache_t
      real(wp) :: k(2*MOST_NODES, 2*MOST_NODES)    !< set with the form
   end type stiffness_cache_t

   !> A chunk of elements, compared one after the other. Places are those in the list of elements; 0: none.
   type :: chunk_t
      integer(ip) :: before = 0                    !< the last different one of earlier chunks
      logical :: is_due = .true.                   !< to be compared; also when `before` was wrong
      integer(ip) :: n = 0                         !< different ones
      integer(ip) :: last = 0                      !< the last of them, or that of earlier chunks
      integer(ip) :: offset = 0                    !< different ones in earlier chunks
   end type chunk_t

   !> A coordinate that was printed with 10 digits is off by half a unit of the last one, of which there are 1e9 to 1e10 in the
   !> largest coordinate; the difference of two differences of coordinates by two units.
   real(wp), parameter :: PRINTED = 2.0e-9_wp
   !> Elements that differ by more than this share of their size are not near.
   real(wp), parameter :: NEAR = 1.0e-6_wp
   !> Where more than this share of the elements differ it is asked whether they are near; it is worth it when no more than this
   !> share of the different ones is left.
   real(wp), parameter :: MANY = 0.1_wp, FEW = 0.25_wp

contains

   !> What the last digits of printed coordinates may make of equal elements [L].
   pure real(wp) function digit_error_of(x) result(digit_error)
      real(wp), intent(in) :: x(:, :)              !< (2, n_nodes) [L]

      digit_error = PRINTED*max(maxval(x), -minval(x), 0.0_wp)
   end function digit_error_of

   !> Column heights of a body's matrix; where it is not numbered for its profile, those that are to be expected if it were: a
   !> column reaches over two rows of nodes across the shorter side of the box round the body.
   subroutine body_profile(fem, i_body, profile)
      type(fem_t), intent(in) :: fem          !< the body and its elements are read
      integer(ip), intent(in) :: i_body       !< place in the list of bodies
      type(profile_t), intent(out) :: profile !< closed; expected where the body has no numbers for it
      integer(ip) :: i

      associate (body => fem%bodies%list(i_body))
         if (.not. body%by_profile) then
            call expect_profile(profile, body%n, body%n_retained, 4_ip + &
                                int(2.0_wp*sqrt(real(size(body%nodes), wp)*body%slenderness), ip))
            return
         end if
         call begin_profile(profile, body%n, body%n_retained)
         do i = 1, size(body%elements, kind=ip)
            call add_to_profile(profile, element_equations(fem%mesh, fem%bodies, body%elements(i)))
         end do
         call close_profile(profile)
      end associate
   end subroutine body_profile

   !> Adds all elements of a body to its matrix.
   subroutine assemble_body(fem, i_body, solver, digit_error, is_near)
      type(fem_t), intent(in) :: fem                  !< the body's elements, sections and equations are read
      integer(ip), intent(in) :: i_body               !< place in the list of bodies
      class(linear_solver_t), intent(inout) :: solver !< created with the profile of the body
      real(wp), intent(in), optional :: digit_error   !< [L] elements that differ by no more may have one stiffness
      logical, intent(out), optional :: is_near       !< some have that are not equal
      type(element_store_t) :: store

      call collect_elements(fem, fem%bodies%list(i_body)%elements, store, digit_error)
      if (present(is_near)) is_near = store%is_near
      call solver%add_store(store)
   end subroutine assemble_body

   !> Equations and stiffnesses of elements, in their order. Equal ones that follow one another have one stiffness in common.
   !>
   !>     1. equations of each element
   !>     2. each is compared with the last different one before it, in chunks side by side (compare_chunks)
   !>     3. where many differ, but few by more than the digit error, near ones are taken as equal (look_for_near)
   !>     4. matrices are numbered through all chunks, and each is computed once (compute_matrices)
   !>
   !> Equal elements have one matrix to the last bit: the first one's, so that equal fronts are equal for whoever compares numbers.
   !> A block of n equal elements costs n comparisons and one integration. What is not equal to the element before is not looked
   !> for farther back: meshes whose elements come in mixed order have more matrices than they need, and no other harm.
   subroutine collect_elements(fem, elements, store, digit_error)
      type(fem_t), intent(in) :: fem               !< elements, sections and equations are read
      integer(ip), intent(in) :: elements(:)       !< of one body
      type(element_store_t), intent(out) :: store  !< a list of equations each, a matrix for those alike
      real(wp), intent(in), optional :: digit_error !< [L] those that differ by no more may have one in common, too
      type(chunk_t) :: chunks(chunk_count(size(elements, kind=ip)))
      integer(ip), allocatable :: different(:)     ! the element of each matrix
      integer(ip) :: i

      store%n = size(elements, kind=ip)
      if (store%n > 0) store%translates = STATES(fem%mesh%state(elements(1)))%moves(:2)
      allocate (store%start(store%n + 1), store%matrix_of(store%n))
      store%start(1) = 0
      do i = 1, store%n
         store%start(i + 1) = store%start(i) + 2*fem%mesh%shape(elements(i))
      end do
      allocate (store%equations(store%start(store%n + 1)))
      !$omp parallel do schedule(dynamic, CHUNK_LENGTH) if (is_shared(store%n))
      do i = 1, store%n
         store%equations(store%start(i) + 1:store%start(i + 1)) = element_equations(fem%mesh, fem%bodies, elements(i))
      end do
      !$omp end parallel do
      call compare_chunks(fem, elements, 0.0_wp, chunks, store%matrix_of)
      if (present(digit_error)) call look_for_near(fem, elements, digit_error, chunks, store)
      store%n_matrices = sum(chunks%n)
      allocate (different(store%n_matrices))
      !$omp parallel do schedule(dynamic) if (is_shared(store%n))
      do i = 1, size(chunks, kind=ip)
         call number_matrices(elements, i, chunks(i), store%matrix_of, different)
      end do
      !$omp end parallel do
      call compute_matrices(fem, different, store)
   end subroutine collect_elements

   !> Where most elements differ from the one before, but few by more than the digit error, the near ones are taken as equal.
   subroutine look_for_near(fem, elements, digit_error, chunks, store)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(in) :: digit_error
      type(chunk_t), intent(inout) :: chunks(:)
      type(element_store_t), intent(inout) :: store
      type(chunk_t) :: near_chunks(size(chunks))
      integer(ip), allocatable :: number(:)

      if (.not. digit_error > 0.0_wp .or. sum(chunks%n) <= MANY*size(elements)) return
      allocate (number(size(elements)))
      call compare_chunks(fem, elements, digit_error, near_chunks, number)
      store%is_near = sum(near_chunks%n) <= FEW*sum(chunks%n)
      if (.not. store%is_near) return
      chunks = near_chunks
      call move_alloc(number, store%matrix_of)
   end subroutine look_for_near

   !> Compares every element with the last different one before it, chunks side by side. A chunk has to guess what came before it
   !> (the first element of all, which is right in a regular mesh), and is compared again when it turns out to be another.
   subroutine compare_chunks(fem, elements, digit_error, chunks, number)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(in) :: digit_error          !< [L] 0: equal but for rounding
      type(chunk_t), intent(inout) :: chunks(:)
      integer(ip), intent(inout) :: number(:)      !< of the elements: the different ones of their chunk until there
      integer(ip) :: i

      chunks(2:)%before = 1
      do while (any(chunks%is_due))
         !$omp parallel do schedule(dynamic) if (is_shared(size(elements, kind=ip)))
         do i = 1, size(chunks, kind=ip)
            if (chunks(i)%is_due) call compare_chunk(fem, elements, digit_error, i, chunks(i), number)
         end do
         !$omp end parallel do
         call join_chunks(fem, elements, digit_error, number, chunks)
      end do
   end subroutine compare_chunks

   !> Counts the different stiffnesses of a chunk: an element that has the form of the one before takes its number. The first is
   !> compared with the one that `before` names.
   !>
   !> A chunk may begin in the middle of a run of equal elements. With the guess that the run before it ended with the first
   !> element of all, right in a regular mesh, no chunk is done twice; a chunk whose guess was wrong in a way that matters is done
   !> again. In the end every number is what one thread alone would have given.
   pure subroutine compare_chunk(fem, elements, digit_error, i_chunk, chunk, number)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:), i_chunk
      real(wp), intent(in) :: digit_error
      type(chunk_t), intent(inout) :: chunk
      integer(ip), intent(inout) :: number(:)
      type(form_t) :: form
      integer(ip) :: first, last, i

      call find_chunk(i_chunk, size(elements, kind=ip), first, last)
      chunk%n = 0
      chunk%last = chunk%before
      if (chunk%before > 0) call take_form(fem, elements(chunk%before), form)
      do i = first, last
         if (.not. has_form(fem, elements(i), form, digit_error, may_turn=.true.)) then
            call take_form(fem, elements(i), form)
            chunk%n = chunk%n + 1
            chunk%last = i
         end if
         number(i) = chunk%n
      end do
   end subroutine compare_chunk

   !> What came before each chunk; the chunks that it makes a difference to have to be compared again.
   pure subroutine join_chunks(fem, elements, digit_error, number, chunks)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:), number(:)
      real(wp), intent(in) :: digit_error
      type(chunk_t), intent(inout) :: chunks(:)
      type(form_t) :: form
      integer(ip) :: i, first, last

      chunks%is_due = .false.
      do i = 2, size(chunks, kind=ip)
         chunks(i)%offset = chunks(i - 1)%offset + chunks(i - 1)%n
         if (chunks(i)%before == chunks(i - 1)%last) cycle
         chunks(i)%before = chunks(i - 1)%last
         if (chunks(i)%n == 0) chunks(i)%last = chunks(i)%before
         call find_chunk(i, size(elements, kind=ip), first, last)
         chunks(i)%is_due = number(first) == 0
         if (chunks(i)%is_due) cycle
         call take_form(fem, elements(chunks(i)%before), form)
         chunks(i)%is_due = has_form(fem, elements(first), form, digit_error, may_turn=.true.)
      end do
   end subroutine join_chunks

   !> From the numbers within a chunk to those of all; the element that each new matrix is of.
   pure subroutine number_matrices(elements, i_chunk, chunk, matrix_of, different)
      integer(ip), intent(in) :: elements(:), i_chunk
      type(chunk_t), intent(in) :: chunk
      integer(ip), intent(inout) :: matrix_of(:), different(:)
      integer(ip) :: first, last, i, newest

      call find_chunk(i_chunk, size(elements, kind=ip), first, last)
      newest = 0
      do i = first, last
         if (matrix_of(i) > newest) then
            newest = matrix_of(i)
            different(chunk%offset + newest) = elements(i)
         end if
         matrix_of(i) = chunk%offset + matrix_of(i)
      end do
   end subroutine number_matrices

   subroutine compute_matrices(fem, different, store)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: different(:)
      type(element_store_t), intent(inout) :: store
      integer(lp) :: n
      integer(ip) :: m

      allocate (store%matrix_start(store%n_matrices + 1))
      store%matrix_start(1) = 0
      do m = 1, store%n_matrices
         n = 2*fem%mesh%shape(different(m))
         store%matrix_start(m + 1) = store%matrix_start(m) + n*(n + 1)/2
      end do
      allocate (store%values(store%matrix_start(store%n_matrices + 1)))
      !$omp parallel do schedule(dynamic, CHUNK_LENGTH) if (is_shared(store%n_matrices))
      do m = 1, store%n_matrices
         call compute_matrix(fem, different(m), store%values(store%matrix_start(m) + 1:store%matrix_start(m + 1)))
      end do
      !$omp end parallel do
   end subroutine compute_matrices

   pure subroutine compute_matrix(fem, element, packed)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: element
      real(wp), intent(out) :: packed(:)
      type(stiffness_cache_t) :: cache
      integer(ip) :: n

      call cached_stiffness(fem, element, cache)
      n = 2*cache%shape
      call pack_matrix(cache%k(:n, :n), packed)
   end subroutine compute_matrix

   !> Diagonal of a body's matrix at its retained equations, before any elimination.
   subroutine retained_diagonal(fem, i_body, diagonal)
      type(fem_t), intent(in) :: fem               !< the body's elements, sections and equations are read
      integer(ip), intent(in) :: i_body            !< place in the list of bodies
      real(wp), intent(out) :: diagonal(:)         !< (n_retained) [F/L]
      type(stiffness_cache_t) :: cache
      logical, allocatable :: has_retained(:)          !< (elements of the body)
      integer(ip) :: equations(2*MOST_NODES), i, k, e, n, first

      diagonal = 0.0_wp
      associate (body => fem%bodies%list(i_body))
         first = body%n - body%n_retained
         allocate (has_retained(size(body%elements)))
         !$omp parallel do default(shared) private(n) if(is_shared(size(has_retained, kind=ip)))
         do i = 1, size(body%elements, kind=ip)
            n = fem%mesh%shape(body%elements(i))
            has_retained(i) = any(fem%bodies%equation(:, fem%mesh%nodes(:n, body%elements(i))) > first)
         end do
         !$omp end parallel do
         do i = 1, size(body%elements, kind=ip)
            if (.not. has_retained(i)) cycle
            e = body%elements(i)
            n = 2*fem%mesh%shape(e)
            equations(:n) = element_equations(fem%mesh, fem%bodies, e)
            call cached_stiffness(fem, e, cache)
            do k = 1, n
               if (equations(k) > first) diagonal(equations(k) - first) = diagonal(equations(k) - first) + cache%k(k, k)
            end do
         end do
      end associate
   end subroutine retained_diagonal

   !> Puts the stiffness of an element into cache%k, computing it only when the element differs from the one before.
   pure subroutine cached_stiffness(fem, element, cache)
      type(fem_t), intent(in) :: fem                  !< mesh and sections are read
      integer(ip), intent(in) :: element              !< place in the mesh
      type(stiffness_cache_t), intent(inout) :: cache !< of any element before, or empty
      integer(ip) :: n

      if (has_form(fem, element, cache%form_t, 0.0_wp, may_turn=.true.)) return
      call take_form(fem, element, cache%form_t)
      n = cache%shape
      call element_stiffness(cache%x(:, :n), fem%sections(cache%section), cache%state, cache%k(:2*n, :2*n), cache%radius, &
                             cache%thickness(:n))
   end subroutine cached_stiffness

   !> Whether an element has this form; where that is enough, a triangle also turned by 180 degrees, as every other one of a block
   !> is: their stiffness is the same to the last bit.
   pure logical function has_form(fem, element, form, digit_error, may_turn)
      type(fem_t), intent(in) :: fem               !< mesh and sections are read
      integer(ip), intent(in) :: element           !< place in the mesh
      type(form_t), intent(in) :: form             !< of another element, or empty
      real(wp), intent(in) :: digit_error          !< [L] 0: equal but for rounding
      logical, intent(in) :: may_turn              !< whether a triangle may be turned

      has_form = form%section == fem%section_of(element) .and. form%state == fem%mesh%state(element)
      if (.not. has_form) return
      if (form%has_hoop) has_form = abs(radius_of(fem%mesh, element) - form%radius) <= 2*EPS_MACH*form%radius
      if (.not. has_form) return
      has_form = is_like_before(fem%mesh, element, form%shape, form%x, digit_error)
      if (IS_TAPERED(form%state)) then
         if (has_form) has_form = has_thickness(fem%mesh, element, form%thickness)
         return
      end if
      if (has_form .or. .not. may_turn .or. form%has_hoop .or. form%shape /= fem%mesh%shape(element)) return
      if (side_count(fem%mesh, element) == 3) has_form = is_like_before(fem%mesh, element, form%shape, -form%x, digit_error)
   end function has_form

   !> The form of an element.
   pure subroutine take_form(fem, element, form)
      type(fem_t), intent(in) :: fem      !< mesh and sections are read
      integer(ip), intent(in) :: element  !< place in the mesh
      type(form_t), intent(inout) :: form !< what it was is overwritten
      integer(ip) :: k, n

      form%section = fem%section_of(element)
      form%state = fem%mesh%state(element)
      form%shape = fem%mesh%shape(element)
      form%has_hoop = STATES(form%state)%has_hoop
      form%radius = 0.0_wp
      if (form%has_hoop) form%radius = radius_of(fem%mesh, element)
      if (IS_TAPERED(form%state)) then
         n = fem%mesh%shape(element)
         form%thickness(:n) = fem%mesh%thickness(fem%mesh%nodes(:n, element))
      end if
      do k = 1, form%shape
         form%x(:, k) = fem%mesh%x(:, fem%mesh%nodes(k, element)) - fem%mesh%x(:, fem%mesh%nodes(1, element))
      end do
   end subroutine take_form

   !> The radius of the first node of an axisymmetric element [L].
   pure real(wp) function radius_of(mesh, element) result(radius)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element

      radius = mesh%x(1, mesh%nodes(1, element))
   end function radius_of

   !> Whether an element has the shape of another one, within the rounding of the coordinates and never coarser than 1e-12 of the
   !> element; or within a digit error.
   pure logical function is_like_before(mesh, element, shape, x, digit_error) result(alike)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element
      integer(ip), intent(in) :: shape             !< of the other one; 0: there is none
      real(wp), intent(in) :: x(2, MOST_NODES)       !< of the other one, less those of its first node [L]
      real(wp), intent(in) :: digit_error          !< [L]
      real(wp) :: first(2), here(2), way(2), largest, size_of_element, difference
      integer(ip) :: k

      alike = .false.
      if (shape /= mesh%shape(element)) return
      first = mesh%x(:, mesh%nodes(1, element))
      largest = max(abs(first(1)), abs(first(2)))
      size_of_element = 0.0_wp
      difference = 0.0_wp
      do k = 2, shape
         here = mesh%x(:, mesh%nodes(k, element))
         way = here - first
         largest = max(largest, abs(here(1)), abs(here(2)))
         size_of_element = max(size_of_element, abs(way(1)), abs(way(2)))
         difference = max(difference, abs(way(1) - x(1, k)), abs(way(2) - x(2, k)))
      end do
      alike = difference <= max(min(2*EPS_MACH*largest, 1.0e-12_wp*size_of_element), min(digit_error, NEAR*size_of_element))
   end function is_like_before

end module atrito_assembly
