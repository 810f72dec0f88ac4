!> Recovered stresses and the estimated error over the ranks, each with its own elements.
!>
!> A rank gets its elements first, then those in RINGS round them: patches of stresses at the nodes of its own elements look no
!> farther (a node of the outline takes its stress from the patches of corners next to it, a triangle in a corner from those of its
!> neighbour, and what a patch is told by the elements round it). So nothing is exchanged at borders, and each value is that of one
!> process but for the order of sums.
module atrito_shared_fields
   use atrito_assembly, only: fem_t
   use atrito_error_estimate, only: energies_t, integrate_error, relative_error, share_errors
   use atrito_fem_piece, only: take_piece
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_mpi, only: rank_count, receive_buffer, send_buffer
   use atrito_buffer, only: buffer_t, put, take
   use atrito_piece_buffer, only: put_piece, receive_piece
   use atrito_plane_state, only: STRESS_NAMES
   use atrito_range, only: unit_of
   use atrito_rank_services, only: SERVICE_FIELDS
   use atrito_results, only: results_t
   use atrito_scene_data, only: distribution_t
   use atrito_stress_recovery, only: stress_field_t, nodal_stresses, recover_stress_field
   use atrito_thermal_loads, only: largest_thermal_strain
   implicit none (type, external)
   private
   public :: field_distribution_t, answer_fields

   integer(ip), parameter :: RINGS = 4

   !> The elements of a rank, and what is round them.
   type :: region_t
      integer(ip) :: n_own = 0                       !< elements of the rank: the first ones
      integer(ip) :: n_nodes = 0                     !< of them: the first ones
      integer(ip), allocatable :: element(:)         !< place in the mesh of the scene
      integer(ip), allocatable :: node(:)            !< place in the mesh of the scene
   end type region_t

   !> What of a distributed scene the stresses are; atrito_rank_distribution adds the matrix.
   type, extends(distribution_t), abstract :: field_distribution_t
      integer(ip), allocatable :: rank_of(:)         !< (n_elements) from 0
      type(region_t), allocatable, private :: regions(:)   !< from 0, while fields have begun
      real(wp), private :: unit = 0.0_wp             !< of displacements, a power of two [L] (measure_error)
      logical, private :: by_element = .false.       !< the error of each is wanted
   contains
      procedure :: begin_fields
      procedure :: end_fields
   end type field_distribution_t

contains

   !> Gives the other ranks their elements; they begin. end_fields has to follow, with nothing else for the ranks between.
   subroutine begin_fields(self, fem, u, by_element)
      class(field_distribution_t), intent(inout) :: self
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)                !< (2, n_nodes) [L]
      logical, intent(in) :: by_element
      type(buffer_t) :: request
      integer(ip), allocatable :: near(:)
      integer(ip) :: rank

      if (allocated(self%regions)) return
      self%unit = unit_of(u)
      self%by_element = by_element
      allocate (self%regions(0:rank_count() - 1))
      call list_near(fem%mesh, self%rank_of, near)
      do rank = 0, rank_count() - 1
         call find_region(fem%mesh, self%rank_of, near, rank, self%regions(rank))
         if (rank == 0) cycle
         call put_region(self, fem, u, self%regions(rank), request)
         call send_buffer(request, rank)
      end do
   end subroutine begin_fields

   !> The same as estimate_error.
   subroutine end_fields(self, fem, results, strain_bound)
      class(field_distribution_t), intent(inout) :: self
      type(fem_t), intent(in) :: fem
      type(results_t), intent(inout) :: results      !< with the displacements with which they have
      real(wp), intent(out) :: strain_bound          !< no strain is larger than this
      type(energies_t) :: energies
      type(buffer_t) :: request, answer
      integer(ip) :: rank, service

      allocate (results%nodal_stress(size(STRESS_NAMES), fem%mesh%n_nodes), source=0.0_wp)
      if (self%by_element .and. .not. allocated(results%element_error)) then
         allocate (results%element_error(fem%mesh%n_elements), source=0.0_wp)
      end if
      do rank = 0, ubound(self%regions, 1)
         if (rank == 0) then
            call put_region(self, fem, results%u, self%regions(0), request)
            call take(request, service)
            call answer_fields(request, answer)
         else
            call receive_buffer(answer, rank)
         end if
         call take_found(self%regions(rank))
      end do
      deallocate (self%regions)
      if (self%by_element) results%element_error = share_errors(energies, results%element_error)
      results%error_estimate = relative_error(energies)
      strain_bound = energies%strain + 2*largest_thermal_strain(fem)   ! as estimate_error

   contains

      !> Adds what was found in a region; at a border the last rank has its way.
      subroutine take_found(region)
         type(region_t), intent(in) :: region
         real(wp), allocatable :: stress(:, :), sums(:), square(:)

         if (region%n_own == 0) return
         call take(answer, stress)
         call take(answer, sums)
         call take(answer, square)
         results%nodal_stress(:, region%node(:region%n_nodes)) = stress
         energies = energies_t(energies%solution + sums(1), energies%error + sums(2), energies%round_off + sums(3), &
                               max(energies%strain, sums(4)))
         if (allocated(results%element_error)) results%element_error(region%element(:region%n_own)) = square
      end subroutine take_found

   end subroutine end_fields

   subroutine put_region(self, fem, u, region, request)
      class(field_distribution_t), intent(in) :: self
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)                !< (2, n_nodes) [L]
      type(region_t), intent(in) :: region
      type(buffer_t), intent(out) :: request
      type(fem_t) :: piece

      call put(request, SERVICE_FIELDS)
      call put(request, region%n_own)
      call put(request, region%n_nodes)
      call put(request, self%unit)
      call put(request, self%by_element)
      call put(request, u(:, region%node))
      if (region%n_own == 0) return
      call take_piece(fem, region%node, region%element, piece)
      call put_piece(request, piece)
      deallocate (piece%mesh)
   end subroutine put_region

   !> Stresses at the nodes of the rank's elements [F/L^2], and their error: the energies, and ||e||^2 of each element [F L] where
   !> it is wanted. Without elements there is no answer.
   subroutine answer_fields(request, answer)
      type(buffer_t), intent(inout) :: request       !< by begin_fields; its items are taken
      type(buffer_t), intent(out) :: answer          !< nodal stresses, energies, errors squared of elements
      type(fem_t) :: piece
      type(stress_field_t) :: field
      type(energies_t) :: e
      real(wp), allocatable :: u(:, :), stress(:, :), square(:)
      integer(ip) :: n_own, n_nodes
      real(wp) :: unit
      logical :: by_element

      call take(request, n_own)
      call take(request, n_nodes)
      call take(request, unit)
      call take(request, by_element)
      call take(request, u)
      if (n_own == 0) return
      call receive_piece(request, piece)
      request = buffer_t()                           ! what was taken needs no copy
      call recover_stress_field(piece, u, field)
      call nodal_stresses(piece, field, stress)
      piece%mesh%n_elements = n_own                  ! those round them have served
      allocate (square(merge(n_own, 0_ip, by_element)))
      if (by_element) call integrate_error(piece, u, field, e, unit, square)
      if (.not. by_element) call integrate_error(piece, u, field, e, unit)
      deallocate (piece%mesh)
      call put(answer, stress(:, :n_nodes))
      call put(answer, [e%solution, e%error, e%round_off, e%strain])
      call put(answer, square)
   end subroutine answer_fields

   !> The elements of a rank, then those of the rings round them; and their nodes in this order.
   pure subroutine find_region(mesh, rank_of, near, rank, region)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: rank_of(:)          !< (n_elements) from 0
      integer(ip), intent(in) :: near(:)             !< elements that may lie in the rings
      integer(ip), intent(in) :: rank
      type(region_t), intent(out) :: region
      integer(ip) :: place(mesh%n_nodes), i, k, n, e
      logical :: is_in(size(near))

      region%element = pack([(i, i=1, mesh%n_elements)], rank_of == rank)
      region%n_own = size(region%element, kind=ip)
      place = RINGS + 1                              ! first the ring of each node
      do i = 1, region%n_own
         associate (e => region%element(i))
            place(mesh%nodes(:mesh%shape(e), e)) = 0
         end associate
      end do
      is_in = .false.
      call add_rings(mesh, near, place, is_in)
      region%element = [region%element, pack(near, is_in .and. rank_of(near) /= rank)]
      allocate (region%node(count(place <= RINGS)))
      place = 0
      n = 0
      do i = 1, size(region%element, kind=ip)
         e = region%element(i)
         do k = 1, mesh%shape(e)
            if (place(mesh%nodes(k, e)) > 0) cycle
            n = n + 1
            place(mesh%nodes(k, e)) = n
            region%node(n) = mesh%nodes(k, e)
         end do
         if (i == region%n_own) region%n_nodes = n
      end do
   end subroutine find_region

   !> The elements in the rings round any node that elements of several ranks have: what is near no border is looked at RINGS
   !> times, for any number of ranks.
   pure subroutine list_near(mesh, rank_of, near)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: rank_of(:)
      integer(ip), allocatable, intent(out) :: near(:)
      integer(ip) :: ring_of(mesh%n_nodes), owner(mesh%n_nodes), e
      logical :: is_near(mesh%n_elements)

      owner = -1
      ring_of = RINGS + 1
      do e = 1, mesh%n_elements
         associate (nodes => mesh%nodes(:mesh%shape(e), e))
            where (owner(nodes) >= 0 .and. owner(nodes) /= rank_of(e)) ring_of(nodes) = 0
            owner(nodes) = rank_of(e)
         end associate
      end do
      is_near = .false.
      call add_rings(mesh, [(e, e=1, mesh%n_elements)], ring_of, is_near)
      near = pack([(e, e=1, mesh%n_elements)], is_near)
   end subroutine list_near

   !> Goes out ring by ring from the nodes of ring 0.
   pure subroutine add_rings(mesh, elements, ring_of, is_in)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: elements(:)         !< those that are looked at
      integer(ip), intent(inout) :: ring_of(:)       !< (n_nodes) RINGS + 1: outside
      logical, intent(inout) :: is_in(:)             !< (elements) lies in a ring
      integer(ip) :: ring, i

      do ring = 1, RINGS
         do i = 1, size(elements, kind=ip)
            if (is_in(i)) cycle
            associate (nodes => mesh%nodes(:mesh%shape(elements(i)), elements(i)))
               is_in(i) = any(ring_of(nodes) < ring)
               if (is_in(i)) ring_of(nodes) = min(ring_of(nodes), ring)
            end associate
         end do
      end do
   end subroutine add_rings

end module atrito_shared_fields
