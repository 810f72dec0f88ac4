!> Sums over the elements of a body: matrix, profile, nodal forces of a displacement field.
module atrito_assembly
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_range, only: work_of
   use atrito_mesh, only: mesh_t, element_coordinates, Q2_NODES
   use atrito_bodies, only: body_t, bodies_t, element_equations
   use atrito_elasticity, only: elastic_t
   use atrito_element, only: element_stiffness
   use atrito_profile, only: profile_t, begin_profile, add_to_profile, close_profile
   use atrito_storage, only: storage_t
   implicit none (type, external)
   private
   public :: fem_t, stiffness_cache_t, body_profile, assemble_body, kept_diagonal, internal_forces, cached_stiffness

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

   !> Column heights of a body's matrix.
   subroutine body_profile(fem, i_body, profile)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      type(profile_t), intent(out) :: profile
      integer(ip) :: i

      associate (body => fem%bodies%list(i_body))
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
      real(wp) :: x(2, fem%mesh%shape(element)), origin(2), size_of_element, tolerance
      integer(ip) :: n, section, state

      n = fem%mesh%shape(element)
      section = fem%section_of(element)
      state = fem%mesh%state(element)
      x = element_coordinates(fem%mesh, element)
      origin = x(:, 1)
      ! Equal within the rounding of the coordinates, and never coarser than 1e-12 of the element.
      tolerance = 2*EPS_MACH*maxval(abs(x))
      x(1, :) = x(1, :) - origin(1)
      x(2, :) = x(2, :) - origin(2)
      size_of_element = maxval(abs(x))
      tolerance = min(tolerance, 1.0e-12_wp*size_of_element)
      if (cache%section == section .and. cache%state == state .and. cache%shape == n) then
         if (maxval(abs(cache%x(:, :n) - x)) <= tolerance) return
      end if
      cache%section = section
      cache%state = state
      cache%shape = n
      cache%x(:, :n) = x
      call element_stiffness(x, fem%sections(section), state, cache%k(:2*n, :2*n))
   end subroutine cached_stiffness

   !> Nodal forces K u of a body's elements, added to `force`; with `size`, the sums |K||u| that measure their round-off are added
   !> to it; with `energy`, u K u / 2 is added to it.
   subroutine internal_forces(fem, i_body, u, force, size_of_force, energy)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      real(wp), intent(in) :: u(:, :)              !< (2, n_nodes) [L]
      real(wp), intent(inout) :: force(:, :)       !< (2, n_nodes) [F]
      real(wp), intent(inout) :: size_of_force(:, :) !< (2, n_nodes) [F]
      real(wp), intent(inout) :: energy            !< [F L]
      type(stiffness_cache_t) :: cache
      real(wp) :: ue(2*Q2_NODES), fe(2*Q2_NODES), se(2*Q2_NODES)
      integer(ip) :: i, k, e, n, node

      associate (body => fem%bodies%list(i_body))
         do i = 1, size(body%elements, kind=ip)
            e = body%elements(i)
            n = fem%mesh%shape(e)
            ue(:2*n) = reshape(u(:, fem%mesh%nodes(:n, e)), [2*n])
            if (all(ue(:2*n) == 0.0_wp)) cycle    ! of prescribed displacements most elements know nothing
            call cached_stiffness(fem, e, cache)
            fe(:2*n) = matmul(cache%k(:2*n, :2*n), ue(:2*n))
            se(:2*n) = matmul(abs(cache%k(:2*n, :2*n)), abs(ue(:2*n)))
            energy = energy + 0.5_wp*work_of(2*n, fe, ue)
            do k = 1, n
               node = fem%mesh%nodes(k, e)
               force(:, node) = force(:, node) + fe(2*k - 1:2*k)
               size_of_force(:, node) = size_of_force(:, node) + se(2*k - 1:2*k)
            end do
         end do
      end associate
   end subroutine internal_forces

end module atrito_assembly
