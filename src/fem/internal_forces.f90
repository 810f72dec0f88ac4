!> Nodal forces of a displacement field, summed over the elements of all bodies:
!>
!>     f = sum of A_e' K_e A_e u,      A_e u: the displacements of the nodes of element e.
!>
!> No matrix of a body is formed; neighbours that are equal share one K_e. The energy u'K u/2 comes along with it. Displacements are
!> divided by a power of two near the largest of them before energies are summed, so that squares stay in the range of numbers.
!>
!> The elements are cut into parts, one a thread. A node belongs to the first part that touches it, which adds what it has to give
!> at once; what later parts give is put down and added afterwards, part by part. So the terms of every node are added in the order
!> of the elements, whatever the number of parts.
module atrito_internal_forces
   use, intrinsic :: iso_c_binding, only: c_bool
   use atrito_assembly, only: fem_t, stiffness_cache_t, cached_stiffness
   use atrito_element_table, only: MOST_NODES
   use atrito_growth, only: resize
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_range, only: work_of, unit_of
   use atrito_threads, only: n_threads, is_shared, chunk_count, find_chunk
   implicit none (type, external)
   private
   public :: internal_forces, internal_force_sizes

   !> What a part of the elements gives to nodes of earlier parts.
   type :: late_forces_t
      integer(ip) :: part = 0                        !< of the elements, from which they come
      integer(ip) :: n = 0                           !< nodes that forces are kept for
      integer(ip), allocatable :: node(:)            !< (n or more) places; a node may come several times
      real(wp), allocatable :: force(:, :)           !< (2, n) [F]
   end type late_forces_t

contains

   !> Adds the nodal forces K u of all elements to `force`, and u K u / 2 to `energy`.
   subroutine internal_forces(fem, u, force, energy)
      type(fem_t), intent(in) :: fem                 !< mesh and sections are read
      real(wp), intent(in) :: u(:, :)                !< (2, n_nodes) [L]
      real(wp), intent(inout) :: force(:, :)         !< (2, n_nodes) [F]
      real(wp), intent(inout) :: energy              !< [F L]
      type(late_forces_t), allocatable :: late(:)
      integer(ip), allocatable :: owner(:)
      real(wp), allocatable :: work(:)
      real(wp) :: unit
      integer(ip) :: n_parts, part, i

      n_parts = 1
      allocate (work(chunk_count(fem%mesh%n_elements)))
      if (is_shared(fem%mesh%n_elements)) n_parts = min(n_threads(), size(work, kind=ip))
      allocate (late(n_parts))
      call find_owners(fem%mesh, n_parts, owner)
      unit = unit_of(u)
      !$omp parallel do schedule(static, 1) if (n_parts > 1)
      do part = 1, n_parts
         late(part)%part = part
         call add_part(fem, n_parts, owner, u, unit, force, work, late(part))
      end do
      !$omp end parallel do
      do part = 2, n_parts
         do i = 1, late(part)%n
            force(:, late(part)%node(i)) = force(:, late(part)%node(i)) + late(part)%force(:, i)
         end do
      end do
      energy = energy + 0.5_wp*work_of(1_ip, [sum(work)], [unit])
   end subroutine internal_forces

   !> The first part that touches each node.
   subroutine find_owners(mesh, n_parts, owner)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: n_parts
      integer(ip), allocatable, intent(out) :: owner(:)
      logical(c_bool), allocatable :: touched(:, :)  ! of one byte
      integer(ip) :: part, node

      allocate (owner(mesh%n_nodes))
      if (n_parts == 1) then
         owner = 1
         return
      end if
      allocate (touched(mesh%n_nodes, n_parts))
      !$omp parallel do schedule(static, 1)
      do part = 1, n_parts
         call mark_nodes(mesh, part, n_parts, touched(:, part))
      end do
      !$omp end parallel do
      !$omp parallel do schedule(static) private(part)
      do node = 1, mesh%n_nodes
         do part = 1, n_parts - 1
            if (touched(node, part)) exit
         end do
         owner(node) = part
      end do
      !$omp end parallel do
   end subroutine find_owners

   pure subroutine mark_nodes(mesh, part, n_parts, touched)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: part, n_parts
      logical(c_bool), intent(out) :: touched(:)
      integer(ip) :: chunk, first, last, e, k

      touched = .false._c_bool
      do chunk = first_chunk(part, n_parts, mesh%n_elements), first_chunk(part + 1, n_parts, mesh%n_elements) - 1
         call find_chunk(chunk, mesh%n_elements, first, last)
         do e = first, last
            do k = 1, mesh%shape(e)
               touched(mesh%nodes(k, e)) = .true._c_bool
            end do
         end do
      end do
   end subroutine mark_nodes

   !> Parts are whole chunks of elements.
   pure integer(ip) function first_chunk(part, n_parts, n_elements)
      integer(ip), intent(in) :: part, n_parts, n_elements

      first_chunk = 1 + ((part - 1)*chunk_count(n_elements))/n_parts
   end function first_chunk

   !> The elements of a part, chunk by chunk: fe = K_e u_e, its work u_e.fe, and fe to the nodes. A part may add to the nodes that
   !> it owns; forces at those of others are put down, and added when all parts are done, part by part: sums come out the same for
   !> any number of threads.
   pure subroutine add_part(fem, n_parts, owner, u, unit, force, work, late)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: n_parts, owner(:)
      real(wp), intent(in) :: u(:, :), unit
      real(wp), intent(inout) :: force(:, :)
      real(wp), intent(inout) :: work(:)             !< of each chunk, over the unit [F]
      type(late_forces_t), intent(inout) :: late
      type(stiffness_cache_t) :: cache
      real(wp) :: ue(2*MOST_NODES), fe(2*MOST_NODES)
      integer(ip) :: chunk, first, last, e, n

      ue = 0.0_wp
      do chunk = first_chunk(late%part, n_parts, fem%mesh%n_elements), first_chunk(late%part + 1, n_parts, fem%mesh%n_elements) - 1
         call find_chunk(chunk, fem%mesh%n_elements, first, last)
         cache%shape = 0                             ! each chunk has a first stiffness of its own
         work(chunk) = 0.0_wp
         do e = first, last
            n = 2*fem%mesh%shape(e)
            call fetch_displacements(fem%mesh, e, u, ue)
            if (all(ue(:n) == 0.0_wp)) cycle         ! of prescribed displacements most elements know nothing
            call cached_stiffness(fem, e, cache)
            call multiply_stiffness(n, cache%k, ue, fe)
            work(chunk) = work(chunk) + work_over(n, fe, ue, 1/unit)
            call hand_out(fem%mesh, e, fe, owner, force, late)
         end do
      end do
   end subroutine add_part

   pure subroutine fetch_displacements(mesh, e, u, ue)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: u(:, :)
      real(wp), intent(inout) :: ue(2*MOST_NODES)
      integer(ip) :: k

      do k = 1, mesh%shape(e)
         ue(2*k - 1) = u(1, mesh%nodes(k, e))
         ue(2*k) = u(2, mesh%nodes(k, e))
      end do
   end subroutine fetch_displacements

   !> Two loops, since the compiler makes much more of eight than of n.
   pure subroutine multiply_stiffness(n, k, u, f)
      integer(ip), intent(in) :: n                   !< dofs of the element
      real(wp), intent(in) :: k(2*MOST_NODES, 2*MOST_NODES), u(2*MOST_NODES)
      real(wp), intent(inout) :: f(2*MOST_NODES)
      integer(ip) :: j

      f(:n) = 0.0_wp
      if (n == 8) then
         do j = 1, 8
            f(:8) = f(:8) + k(:8, j)*u(j)
         end do
      else
         do j = 1, n
            f(:n) = f(:n) + k(:n, j)*u(j)
         end do
      end if
   end subroutine multiply_stiffness

   pure real(wp) function work_over(n, f, u, per_unit) result(work)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: f(n), u(n), per_unit
      integer(ip) :: i

      work = 0.0_wp
      do i = 1, n
         work = work + f(i)*(u(i)*per_unit)
      end do
   end function work_over

   pure subroutine hand_out(mesh, e, fe, owner, force, late)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: fe(2*MOST_NODES)
      integer(ip), intent(in) :: owner(:)
      real(wp), intent(inout) :: force(:, :)
      type(late_forces_t), intent(inout) :: late
      integer(ip) :: k, node

      do k = 1, mesh%shape(e)
         node = mesh%nodes(k, e)
         if (owner(node) == late%part) then
            force(1, node) = force(1, node) + fe(2*k - 1)
            force(2, node) = force(2, node) + fe(2*k)
         else
            call put_down(node, fe(2*k - 1:2*k), late)
         end if
      end do
   end subroutine hand_out

   pure subroutine put_down(node, f, late)
      integer(ip), intent(in) :: node
      real(wp), intent(in) :: f(2)
      type(late_forces_t), intent(inout) :: late

      if (.not. allocated(late%node)) allocate (late%node(1024), late%force(2, 1024))
      if (late%n == size(late%node)) then
         call resize(late%node, late%n, 2*late%n)
         call resize(late%force, late%n, 2*late%n)
      end if
      late%n = late%n + 1
      late%node(late%n) = node
      late%force(:, late%n) = f
   end subroutine put_down

   !> Sums of |K||u| over the elements, which measure the round-off of internal_forces; wanted seldom, so done plainly.
   pure subroutine internal_force_sizes(fem, u, size_of_force)
      type(fem_t), intent(in) :: fem                 !< mesh and sections are read
      real(wp), intent(in) :: u(:, :)                !< (2, n_nodes) [L]
      real(wp), intent(out) :: size_of_force(:, :)   !< (2, n_nodes) [F]
      type(stiffness_cache_t) :: cache
      real(wp) :: ue(2*MOST_NODES), fe(2*MOST_NODES)
      integer(ip) :: e, k, node

      size_of_force = 0.0_wp
      ue = 0.0_wp
      do e = 1, fem%mesh%n_elements
         call fetch_displacements(fem%mesh, e, u, ue)
         call cached_stiffness(fem, e, cache)
         call multiply_stiffness(2*fem%mesh%shape(e), abs(cache%k), abs(ue), fe)
         do k = 1, fem%mesh%shape(e)
            node = fem%mesh%nodes(k, e)
            size_of_force(:, node) = size_of_force(:, node) + fe(2*k - 1:2*k)
         end do
      end do
   end subroutine internal_force_sizes

end module atrito_internal_forces
