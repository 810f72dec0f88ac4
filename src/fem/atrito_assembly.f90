!> Sums over the elements of a body: matrix and profile.
!>
!> Neighbours in a regular mesh are equal, and one stiffness serves them all. Elements are compared with the last one that was
!> different, so that small differences do not add up along a mesh.
!>
!> Where the coordinates of a regular mesh were printed with 10 to 15 digits, no two elements are equal, but most are within the
!> `grain` of those digits. Whoever puts the difference right afterwards takes one stiffness for these, too.
module atrito_assembly
   use atrito_element_table, only: MOST_NODES
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_mesh, only: mesh_t
   use atrito_bodies, only: bodies_t, element_equations
   use atrito_element, only: element_stiffness
   use atrito_multifrontal, only: element_store_t, pack_matrix
   use atrito_plane_state, only: elastic_t
   use atrito_profile, only: profile_t, begin_profile, add_to_profile, close_profile, expect_profile
   use atrito_storage, only: storage_t
   use atrito_threads, only: is_shared, run_count, find_run, RUN_LENGTH
   implicit none (type, external)
   private
   public :: fem_t, stiffness_cache_t, body_profile, collect_elements, assemble_body, &
             kept_diagonal, cached_stiffness, is_like_before, grain_of

   !> The elements and their sections: what every sum over elements needs.
   type :: fem_t
      type(mesh_t), pointer :: mesh => null()      !< the model's: a mesh is large, and nothing changes it
      type(bodies_t) :: bodies
      type(elastic_t), allocatable :: sections(:)
      integer(ip), allocatable :: section_of(:)    !< (n_elements)
      real(wp) :: grain = 0.0_wp                   !< [L] what the last printed digits may make of equal elements; 0: nothing
   end type fem_t

   !> All that a stiffness depends on.
   type :: form_t
      integer(ip) :: section = 0, state = 0, shape = 0
      real(wp) :: x(2, MOST_NODES) = 0.0_wp          !< relative to the first node
   end type form_t

   !> The stiffness computed last.
   type, extends(form_t) :: stiffness_cache_t
      real(wp) :: k(2*MOST_NODES, 2*MOST_NODES) = 0.0_wp
   end type stiffness_cache_t

   !> A run of elements, compared one after the other. Places are those in the list of elements; 0: none.
   type :: run_t
      integer(ip) :: before = 0                    !< the last different one of earlier runs
      logical :: is_due = .true.                   !< to be compared; also when `before` was wrong
      integer(ip) :: n = 0                         !< different ones
      integer(ip) :: last = 0                      !< the last of them, or that of earlier runs
      integer(ip) :: offset = 0                    !< different ones in earlier runs
   end type run_t

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
   pure real(wp) function grain_of(x) result(grain)
      real(wp), intent(in) :: x(:, :)              !< (2, n_nodes) [L]

      grain = PRINTED*max(maxval(x), -minval(x), 0.0_wp)
   end function grain_of

   !> Column heights of a body's matrix; where it is not numbered for its profile, those that are to be expected if it were: a
   !> column reaches over two rows of nodes across the shorter side of the box round the body.
   subroutine body_profile(fem, i_body, profile)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      type(profile_t), intent(out) :: profile
      integer(ip) :: i

      associate (body => fem%bodies%list(i_body))
         if (.not. body%by_profile) then
            call expect_profile(profile, body%n, body%n_kept, 4_ip + &
                                int(2.0_wp*sqrt(real(size(body%nodes), wp)*body%slenderness), ip))
            return
         end if
         call begin_profile(profile, body%n, body%n_kept)
         do i = 1, size(body%elements, kind=ip)
            call add_to_profile(profile, element_equations(fem%mesh, fem%bodies, body%elements(i)))
         end do
         call close_profile(profile)
      end associate
   end subroutine body_profile

   !> Adds all elements of a body to its matrix.
   subroutine assemble_body(fem, i_body, storage, grain, is_near)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      class(storage_t), intent(inout) :: storage
      real(wp), intent(in), optional :: grain      !< [L] elements that differ by no more may have one stiffness
      logical, intent(out), optional :: is_near    !< some have that are not equal
      type(element_store_t) :: store

      call collect_elements(fem, fem%bodies%list(i_body)%elements, store, grain)
      if (present(is_near)) is_near = store%is_near
      call storage%add_store(store)
   end subroutine assemble_body

   !> Equations and stiffnesses of elements, in their order. Equal ones that follow one another have one stiffness in common.
   subroutine collect_elements(fem, elements, store, grain)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:)       !< of one body
      type(element_store_t), intent(out) :: store
      real(wp), intent(in), optional :: grain      !< [L] those that differ by no more may have one in common, too
      type(run_t) :: runs(run_count(size(elements, kind=ip)))
      integer(ip), allocatable :: different(:)     ! the element of each matrix
      integer(ip) :: i

      store%n = size(elements, kind=ip)
      allocate (store%start(store%n + 1), store%matrix_of(store%n))
      store%start(1) = 0
      do i = 1, store%n
         store%start(i + 1) = store%start(i) + 2*fem%mesh%shape(elements(i))
      end do
      call collect_equations(fem, elements, store)
      call compare_runs(fem, elements, 0.0_wp, runs, store%matrix_of)
      if (present(grain)) call look_for_near(fem, elements, grain, runs, store)
      store%n_matrices = sum(runs%n)
      allocate (different(store%n_matrices))
      !$omp parallel do schedule(dynamic) if (is_shared(store%n))
      do i = 1, size(runs, kind=ip)
         call number_matrices(elements, i, runs(i), store%matrix_of, different)
      end do
      !$omp end parallel do
      call compute_matrices(fem, different, store)
   end subroutine collect_elements

   !> Where most elements differ from the one before, but few of them by more than the grain, the near ones are taken as equal.
   subroutine look_for_near(fem, elements, grain, runs, store)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(in) :: grain
      type(run_t), intent(inout) :: runs(:)
      type(element_store_t), intent(inout) :: store
      type(run_t) :: near_runs(size(runs))
      integer(ip), allocatable :: number(:)

      if (.not. grain > 0.0_wp .or. sum(runs%n) <= MANY*size(elements)) return
      allocate (number(size(elements)))
      call compare_runs(fem, elements, grain, near_runs, number)
      store%is_near = sum(near_runs%n) <= FEW*sum(runs%n)
      if (.not. store%is_near) return
      runs = near_runs
      call move_alloc(number, store%matrix_of)
   end subroutine look_for_near

   subroutine collect_equations(fem, elements, store)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:)
      type(element_store_t), intent(inout) :: store
      integer(ip) :: i

      allocate (store%equations(store%start(store%n + 1)))
      !$omp parallel do schedule(dynamic, RUN_LENGTH) if (is_shared(store%n))
      do i = 1, store%n
         store%equations(store%start(i) + 1:store%start(i + 1)) = element_equations(fem%mesh, fem%bodies, elements(i))
      end do
      !$omp end parallel do
   end subroutine collect_equations

   !> Compares every element with the last different one before it, runs side by side. A run has to guess what came before it (the
   !> first element of all, which is right in a regular mesh), and is compared again when it turns out to be another.
   subroutine compare_runs(fem, elements, grain, runs, number)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(in) :: grain                !< [L] 0: equal but for rounding
      type(run_t), intent(inout) :: runs(:)
      integer(ip), intent(inout) :: number(:)      !< of the elements: the different ones of their run until there
      integer(ip) :: i

      runs(2:)%before = 1
      do while (any(runs%is_due))
         !$omp parallel do schedule(dynamic) if (is_shared(size(elements, kind=ip)))
         do i = 1, size(runs, kind=ip)
            if (runs(i)%is_due) call compare_run(fem, elements, grain, i, runs(i), number)
         end do
         !$omp end parallel do
         call join_runs(fem, elements, grain, number, runs)
      end do
   end subroutine compare_runs

   pure subroutine compare_run(fem, elements, grain, i_run, run, number)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:), i_run
      real(wp), intent(in) :: grain
      type(run_t), intent(inout) :: run
      integer(ip), intent(inout) :: number(:)
      type(form_t) :: form
      integer(ip) :: first, last, i

      call find_run(i_run, size(elements, kind=ip), first, last)
      run%n = 0
      run%last = run%before
      if (run%before > 0) call take_form(fem, elements(run%before), form)
      do i = first, last
         if (.not. has_form(fem, elements(i), form, grain)) then
            call take_form(fem, elements(i), form)
            run%n = run%n + 1
            run%last = i
         end if
         number(i) = run%n
      end do
   end subroutine compare_run

   !> What came before each run; the runs that it makes a difference to have to be compared again.
   pure subroutine join_runs(fem, elements, grain, number, runs)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:), number(:)
      real(wp), intent(in) :: grain
      type(run_t), intent(inout) :: runs(:)
      type(form_t) :: form
      integer(ip) :: i, first, last

      runs%is_due = .false.
      do i = 2, size(runs, kind=ip)
         runs(i)%offset = runs(i - 1)%offset + runs(i - 1)%n
         if (runs(i)%before == runs(i - 1)%last) cycle
         runs(i)%before = runs(i - 1)%last
         if (runs(i)%n == 0) runs(i)%last = runs(i)%before
         call find_run(i, size(elements, kind=ip), first, last)
         runs(i)%is_due = number(first) == 0
         if (runs(i)%is_due) cycle
         call take_form(fem, elements(runs(i)%before), form)
         runs(i)%is_due = has_form(fem, elements(first), form, grain)
      end do
   end subroutine join_runs

   !> From the numbers within a run to those of all; the element that each new matrix is of.
   pure subroutine number_matrices(elements, i_run, run, matrix_of, different)
      integer(ip), intent(in) :: elements(:), i_run
      type(run_t), intent(in) :: run
      integer(ip), intent(inout) :: matrix_of(:), different(:)
      integer(ip) :: first, last, i, newest

      call find_run(i_run, size(elements, kind=ip), first, last)
      newest = 0
      do i = first, last
         if (matrix_of(i) > newest) then
            newest = matrix_of(i)
            different(run%offset + newest) = elements(i)
         end if
         matrix_of(i) = run%offset + matrix_of(i)
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
      !$omp parallel do schedule(dynamic, RUN_LENGTH) if (is_shared(store%n_matrices))
      do m = 1, store%n_matrices
         call compute_matrix(fem, different(m), store%values(store%matrix_start(m) + 1:store%matrix_start(m + 1)))
      end do
      !$omp end parallel do
   end subroutine compute_matrices

   pure subroutine compute_matrix(fem, element, packed)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: element
      real(wp), intent(out) :: packed(:)
      type(form_t) :: form
      real(wp) :: k(2*MOST_NODES, 2*MOST_NODES)
      integer(ip) :: n

      call take_form(fem, element, form)
      n = 2*form%shape
      call element_stiffness(form%x(:, :form%shape), fem%sections(form%section), form%state, k(:n, :n))
      call pack_matrix(k(:n, :n), packed)
   end subroutine compute_matrix

   !> Diagonal of a body's matrix at its kept equations, before any elimination.
   subroutine kept_diagonal(fem, i_body, diagonal)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      real(wp), intent(out) :: diagonal(:)         !< (n_kept) [F/L]
      type(stiffness_cache_t) :: cache
      logical, allocatable :: has_kept(:)          !< (elements of the body)
      integer(ip) :: equations(2*MOST_NODES), i, k, e, n, first

      diagonal = 0.0_wp
      associate (body => fem%bodies%list(i_body))
         first = body%n - body%n_kept
         allocate (has_kept(size(body%elements)))
         !$omp parallel do default(shared) private(n) if(is_shared(size(has_kept, kind=ip)))
         do i = 1, size(body%elements, kind=ip)
            n = fem%mesh%shape(body%elements(i))
            has_kept(i) = any(fem%bodies%equation(:, fem%mesh%nodes(:n, body%elements(i))) > first)
         end do
         !$omp end parallel do
         do i = 1, size(body%elements, kind=ip)
            if (.not. has_kept(i)) cycle
            e = body%elements(i)
            n = 2*fem%mesh%shape(e)
            equations(:n) = element_equations(fem%mesh, fem%bodies, e)
            call cached_stiffness(fem, e, cache)
            do k = 1, n
               if (equations(k) > first) diagonal(equations(k) - first) = diagonal(equations(k) - first) + cache%k(k, k)
            end do
         end do
      end associate
   end subroutine kept_diagonal

   !> Puts the stiffness of an element into cache%k, computing it only when the element differs from the one before.
   pure subroutine cached_stiffness(fem, element, cache)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: element
      type(stiffness_cache_t), intent(inout) :: cache
      integer(ip) :: n

      if (has_form(fem, element, cache%form_t, 0.0_wp)) return
      call take_form(fem, element, cache%form_t)
      n = cache%shape
      call element_stiffness(cache%x(:, :n), fem%sections(cache%section), cache%state, cache%k(:2*n, :2*n))
   end subroutine cached_stiffness

   pure logical function has_form(fem, element, form, grain)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: element
      type(form_t), intent(in) :: form
      real(wp), intent(in) :: grain                !< [L] 0: equal but for rounding

      has_form = form%section == fem%section_of(element) .and. form%state == fem%mesh%state(element)
      if (has_form) has_form = is_like_before(fem%mesh, element, form%shape, form%x, grain)
   end function has_form

   pure subroutine take_form(fem, element, form)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: element
      type(form_t), intent(inout) :: form
      integer(ip) :: k

      form%section = fem%section_of(element)
      form%state = fem%mesh%state(element)
      form%shape = fem%mesh%shape(element)
      do k = 1, form%shape
         form%x(:, k) = fem%mesh%x(:, fem%mesh%nodes(k, element)) - fem%mesh%x(:, fem%mesh%nodes(1, element))
      end do
   end subroutine take_form

   !> Whether an element has the shape of another one, within the rounding of the coordinates and never coarser than 1e-12 of the
   !> element; or within a grain.
   pure logical function is_like_before(mesh, element, shape, x, grain) result(alike)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element
      integer(ip), intent(in) :: shape             !< of the other one; 0: there is none
      real(wp), intent(in) :: x(2, MOST_NODES)       !< of the other one, less those of its first node [L]
      real(wp), intent(in) :: grain                !< [L]
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
      alike = difference <= max(min(2*EPS_MACH*largest, 1.0e-12_wp*size_of_element), min(grain, NEAR*size_of_element))
   end function is_like_before

end module atrito_assembly
