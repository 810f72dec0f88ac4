!> Sums over the elements of a body: matrix and profile.
module atrito_assembly
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, Q2_NODES
   use atrito_bodies, only: body_t, bodies_t, element_equations
   use atrito_elasticity, only: elastic_t
   use atrito_element, only: element_stiffness
   use atrito_profile, only: profile_t, begin_profile, add_to_profile, close_profile, expect_profile
   use atrito_storage, only: storage_t
   implicit none (type, external)
   private
   public :: fem_t, stiffness_cache_t, body_profile, assemble_body, kept_diagonal, cached_stiffness, is_like_before

   !> The elements and their sections: what every sum over elements needs.
   type :: fem_t
      type(mesh_t) :: mesh
      type(bodies_t) :: bodies
      type(elastic_t), allocatable :: sections(:)
      integer(ip), allocatable :: section_of(:)    !< (n_elements)
   end type fem_t

   !> The stiffness computed last: neighbours in a regular mesh are equal, and one stiffness serves them all.
   type :: stiffness_cache_t
      integer(ip) :: section = 0, state = 0, shape = 0
      real(wp) :: x(2, Q2_NODES) = 0.0_wp          !< relative to the first node
      real(wp) :: k(2*Q2_NODES, 2*Q2_NODES) = 0.0_wp
   end type stiffness_cache_t

contains

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
   subroutine assemble_body(fem, i_body, storage)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      class(storage_t), intent(inout) :: storage
      type(stiffness_cache_t) :: cache
      integer(ip) :: i, e, n

      associate (body => fem%bodies%list(i_body))
         do i = 1, size(body%elements, kind=ip)
            e = body%elements(i)
            n = 2*fem%mesh%shape(e)
            call cached_stiffness(fem, e, cache)
            call storage%add(element_equations(fem%mesh, fem%bodies, e), cache%k(:n, :n))
         end do
      end associate
   end subroutine assemble_body

   !> Diagonal of a body's matrix at its kept equations, before any elimination.
   subroutine kept_diagonal(fem, i_body, diagonal)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      real(wp), intent(out) :: diagonal(:)         !< (n_kept) [F/L]
      type(stiffness_cache_t) :: cache
      integer(ip) :: equations(2*Q2_NODES), i, k, e, n, first

      diagonal = 0.0_wp
      associate (body => fem%bodies%list(i_body))
         first = body%n - body%n_kept
         do i = 1, size(body%elements, kind=ip)
            e = body%elements(i)
            n = 2*fem%mesh%shape(e)
            equations(:n) = element_equations(fem%mesh, fem%bodies, e)
            if (all(equations(:n) <= first)) cycle
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
      integer(ip) :: n, section, state

      section = fem%section_of(element)
      state = fem%mesh%state(element)
      if (cache%section == section .and. cache%state == state) then
         if (is_like_before(fem%mesh, element, cache%shape, cache%x)) return
      end if
      n = fem%mesh%shape(element)
      cache%section = section
      cache%state = state
      cache%shape = n
      call relative_coordinates(fem%mesh, element, cache%x)
      call element_stiffness(cache%x(:, :n), fem%sections(section), state, cache%k(:2*n, :2*n))
   end subroutine cached_stiffness

   pure subroutine relative_coordinates(mesh, element, x)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element
      real(wp), intent(inout) :: x(2, Q2_NODES)    !< less those of the first node [L]
      integer(ip) :: k

      do k = 1, mesh%shape(element)
         x(:, k) = mesh%x(:, mesh%nodes(k, element)) - mesh%x(:, mesh%nodes(1, element))
      end do
   end subroutine relative_coordinates

   !> Whether an element has the shape of another one, within the rounding of the coordinates and never coarser than 1e-12 of the
   !> element.
   pure logical function is_like_before(mesh, element, shape, x) result(alike)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element
      integer(ip), intent(in) :: shape             !< of the other one; 0: there is none
      real(wp), intent(in) :: x(2, Q2_NODES)       !< of the other one, less those of its first node [L]
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
      alike = difference <= min(2*EPS_MACH*largest, 1.0e-12_wp*size_of_element)
   end function is_like_before

end module atrito_assembly
