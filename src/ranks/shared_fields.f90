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
   use atrito_mesh_parcel, only: put_mesh, put_sections, take_mesh, take_sections
   use atrito_mpi, only: rank_count, receive_parcel, send_parcel
   use atrito_parcel, only: parcel_t, put, take
   use atrito_plane_state, only: STRESS_NAMES
   use atrito_range, only: unit_of
   use atrito_rank_services, only: SERVICE_FIELDS
   use atrito_results, only: results_t
   use atrito_stress_recovery, only: stress_field_t, nodal_stresses, recover_stress_field
   use atrito_thermal_loads, only: largest_thermal_strain
   implicit none (type, external)
   private
   public :: shared_fields_t, begin_fields, end_fields, serve_fields, hand_over, kept_share
   public :: EQUILIBRIUM_WORK, STRESS_WORK

   integer(ip), parameter :: RINGS = 4
   !> Elements of a square, nearly: what is near in the plane is to be near in memory.
   real(wp), parameter :: OF_A_SQUARE = 64.0_wp
   !> What the equilibrium and the stresses of all elements take, over recovered stresses and their error.
   real(wp), parameter :: EQUILIBRIUM_WORK = 0.3_wp, STRESS_WORK = 0.25_wp

   !> The elements of a rank, and what is round them.
   type :: region_t
      integer(ip) :: n_own = 0                       !< elements of the rank: the first ones
      integer(ip) :: n_nodes = 0                     !< of them: the first ones
      integer(ip), allocatable :: element(:)         !< place in the mesh of the scene
      integer(ip), allocatable :: node(:)
   end type region_t

   !> Fields that have begun, or may.
   type :: shared_fields_t
      type(region_t), allocatable :: regions(:)      !< from 0
      logical :: has_begun = .false.
      real(wp) :: unit = 0.0_wp
      logical :: by_element = .false.
   end type shared_fields_t

   !> What is found in a region.
   type :: found_t
      real(wp), allocatable :: stress(:, :)          !< (5, nodes of the rank's elements) [F/L^2]
      type(energies_t) :: energies
      real(wp), allocatable :: square(:)             !< (elements of the rank) ||e||^2 [F L]; none where nobody asks
   end type found_t

contains

   !> Gives the other ranks their elements; they begin. end_fields has to follow, with nothing else for the ranks between.
   subroutine begin_fields(fem, rank_of, u, by_element, besides, fields)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: rank_of(:)          !< (n_elements)
      real(wp), intent(in) :: u(:, :)                !< (2, n_nodes) [L]
      logical, intent(in) :: by_element              !< the error of each is wanted
      real(wp), intent(in) :: besides                !< what the first rank does meanwhile, over the fields of all elements
      type(shared_fields_t), intent(inout) :: fields
      integer(ip) :: rank
      type(fem_t) :: piece

      call find_regions(fem%mesh, rank_of, besides, rank_count(), fields%regions)
      fields%has_begun = .true.
      fields%unit = unit_of(u)
      fields%by_element = by_element
      do rank = rank_count() - 1, 1, -1
         associate (region => fields%regions(rank))
            call take_piece(fem, region%node, region%element, piece)
            call give_region(region, piece, u(:, region%node), fields%unit, by_element, rank)
            deallocate (piece%mesh)
         end associate
      end do
   end subroutine begin_fields

   !> The elements of the first rank that the others take over, slice by slice: it has other things to do.
   pure subroutine hand_over(order, besides, n_ranks, owner)
      integer(ip), intent(in) :: order(:)            !< (n_elements) elements, neighbours near each other
      real(wp), intent(in) :: besides
      integer(ip), intent(in) :: n_ranks
      integer(ip), intent(inout) :: owner(:)         !< (n_elements)
      integer(ip), allocatable :: own(:)
      integer(ip) :: keeps, n, i

      own = pack(order, owner(order) == 0)
      n = size(own, kind=ip)
      keeps = int(kept_share(besides, n_ranks)*real(size(order), wp), ip)
      do i = keeps + 1, n
         owner(own(i)) = 1 + int(real(n_ranks - 1, wp)*real(i - keeps - 1, wp)/real(n - keeps, wp), ip)
      end do
   end subroutine hand_over

   !> The most elements, over all, of which the first rank has the fields.
   pure real(wp) function kept_share(besides, n_ranks) result(share)
      real(wp), intent(in) :: besides
      integer(ip), intent(in) :: n_ranks

      share = max(0.0_wp, (1.0_wp - besides*real(n_ranks - 1, wp))/real(n_ranks, wp))
   end function kept_share

   !> The same as estimate_error.
   subroutine end_fields(fem, fields, results, strain_bound)
      type(fem_t), intent(in) :: fem
      type(shared_fields_t), intent(inout) :: fields !< that have begun; they have not on return
      type(results_t), intent(inout) :: results      !< with the displacements with which they have
      real(wp), intent(out) :: strain_bound          !< no strain is larger than this
      type(found_t) :: found
      type(energies_t) :: energies
      type(fem_t) :: piece
      integer(ip) :: rank

      allocate (results%nodal_stress(size(STRESS_NAMES), fem%mesh%n_nodes), source=0.0_wp)
      if (fields%by_element .and. .not. allocated(results%element_error)) then
         allocate (results%element_error(fem%mesh%n_elements), source=0.0_wp)
      end if
      do rank = 0, rank_count() - 1
         associate (region => fields%regions(rank))
            if (rank > 0) then
               call receive_found(rank, found)
            else
               if (region%n_own == 0) cycle
               call take_piece(fem, region%node, region%element, piece)
               call measure_region(region, piece, results%u(:, region%node), fields%unit, fields%by_element, found)
               deallocate (piece%mesh)
            end if
            call take_found(region, found, results, energies)
         end associate
      end do
      deallocate (fields%regions)
      fields%has_begun = .false.
      if (fields%by_element) results%element_error = share_errors(energies, results%element_error)
      results%error_estimate = relative_error(energies)
      strain_bound = energies%strain + 2*largest_thermal_strain(fem)   ! as estimate_error
   end subroutine end_fields

   !> Joins in; what is left of the parcel comes behind SERVICE_FIELDS.
   subroutine serve_fields(request)
      type(parcel_t), intent(inout) :: request
      type(region_t) :: region
      type(fem_t) :: piece
      type(found_t) :: found
      type(parcel_t) :: answer
      real(wp), allocatable :: u(:, :)
      real(wp) :: unit
      logical :: by_element

      call take(request, region%n_own)
      call take(request, region%n_nodes)
      call take(request, unit)
      call take(request, by_element)
      call take(request, u)
      allocate (piece%mesh)
      call take_mesh(request, piece%mesh)
      call take_sections(request, piece)
      call measure_region(region, piece, u, unit, by_element, found)
      deallocate (piece%mesh)
      call put(answer, found%stress)
      associate (e => found%energies)
         call put(answer, [e%solution, e%error, e%round_off, e%strain])
      end associate
      call put(answer, found%square)
      call send_parcel(answer, 0_ip)
   end subroutine serve_fields

   subroutine give_region(region, piece, u, unit, by_element, rank)
      type(region_t), intent(in) :: region
      type(fem_t), intent(in) :: piece               !< its elements, with a mesh of their own
      real(wp), intent(in), contiguous :: u(:, :)    !< (2, nodes of the region) [L]
      real(wp), intent(in) :: unit
      logical, intent(in) :: by_element
      integer(ip), intent(in) :: rank
      type(parcel_t) :: request

      call put(request, SERVICE_FIELDS)
      call put(request, region%n_own)
      call put(request, region%n_nodes)
      call put(request, unit)
      call put(request, by_element)
      call put(request, u)
      call put_mesh(request, piece%mesh)
      call put_sections(request, piece)
      call send_parcel(request, rank)
   end subroutine give_region

   subroutine receive_found(rank, found)
      integer(ip), intent(in) :: rank
      type(found_t), intent(out) :: found
      type(parcel_t) :: answer
      real(wp), allocatable :: sums(:)

      call receive_parcel(answer, rank)
      call take(answer, found%stress)
      call take(answer, sums)
      found%energies = energies_t(sums(1), sums(2), sums(3), sums(4))
      call take(answer, found%square)
   end subroutine receive_found

   !> Adds what was found in a region; at a border the last rank has its way.
   pure subroutine take_found(region, found, results, energies)
      type(region_t), intent(in) :: region
      type(found_t), intent(in) :: found
      type(results_t), intent(inout) :: results
      type(energies_t), intent(inout) :: energies

      results%nodal_stress(:, region%node(:region%n_nodes)) = found%stress
      energies%solution = energies%solution + found%energies%solution
      energies%error = energies%error + found%energies%error
      energies%round_off = energies%round_off + found%energies%round_off
      energies%strain = max(energies%strain, found%energies%strain)
      if (allocated(results%element_error)) results%element_error(region%element(:region%n_own)) = found%square
   end subroutine take_found

   !> Stresses at the nodes of the rank's elements, and their error.
   subroutine measure_region(region, piece, u, unit, by_element, found)
      type(region_t), intent(in) :: region
      type(fem_t), intent(inout) :: piece            !< its elements
      real(wp), intent(in) :: u(:, :)                !< (2, nodes of the region) [L]
      real(wp), intent(in) :: unit
      logical, intent(in) :: by_element
      type(found_t), intent(out) :: found
      type(stress_field_t) :: field
      real(wp), allocatable :: stress(:, :)

      call recover_stress_field(piece, u, field)
      call nodal_stresses(piece, field, stress)
      found%stress = stress(:, :region%n_nodes)
      piece%mesh%n_elements = region%n_own      ! those round them have served
      allocate (found%square(merge(region%n_own, 0_ip, by_element)))
      if (by_element) then
         call integrate_error(piece, u, field, found%energies, unit, found%square)
      else
         call integrate_error(piece, u, field, found%energies, unit)
      end if
   end subroutine measure_region

   !> The elements of each rank, its own less those that the first one hands over, and what is round them.
   pure subroutine find_regions(mesh, rank_of, besides, n_ranks, regions)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: rank_of(:)          !< (n_elements) from 0
      real(wp), intent(in) :: besides                !< what the first rank does meanwhile, over the fields of all elements
      integer(ip), intent(in) :: n_ranks
      type(region_t), allocatable, intent(out) :: regions(:)   !< from 0
      integer(ip), allocatable :: order(:)
      integer(ip) :: owner(size(rank_of))

      call sort_by_squares(mesh%x, mesh%nodes(1, :), order)
      owner = rank_of
      call hand_over(order, besides, n_ranks, owner)
      allocate (regions(0:n_ranks - 1))
      call list_regions(mesh, order, owner, regions)
   end subroutine find_regions

   !> The elements of each rank, then those in the rings round them; and their nodes in this order. What is near no border is looked
   !> at RINGS times, for any number of ranks.
   pure subroutine list_regions(mesh, order, rank_of, regions)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: order(:)            !< (n_elements) in which they come
      integer(ip), intent(in) :: rank_of(:)          !< (n_elements) from 0; beyond the last rank: nobody's
      type(region_t), intent(out) :: regions(0:)     !< (ranks) from 0
      integer(ip) :: known(mesh%n_nodes), n_own(0:maxval(rank_of)), i, rank
      integer(ip), allocatable :: near(:)

      n_own = 0
      do i = 1, size(rank_of, kind=ip)
         n_own(rank_of(i)) = n_own(rank_of(i)) + 1
      end do
      do rank = 0, ubound(regions, 1)
         allocate (regions(rank)%element(n_own(rank)))
      end do
      do i = 1, size(order, kind=ip)
         if (rank_of(order(i)) > ubound(regions, 1)) cycle
         associate (region => regions(rank_of(order(i))))
            region%n_own = region%n_own + 1
            region%element(region%n_own) = order(i)
         end associate
      end do
      call list_near_border(mesh, order, rank_of, near)
      known = -1
      do rank = 0, ubound(regions, 1)
         call add_rings(mesh, near, rank_of, rank, known, regions(rank))
      end do
   end subroutine list_regions

   !> The elements in the rings round any node that elements of several ranks have.
   pure subroutine list_near_border(mesh, order, rank_of, near)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: order(:), rank_of(:)
      integer(ip), allocatable, intent(out) :: near(:)   !< in the order of the elements
      integer(ip) :: ring_of(mesh%n_nodes)           ! of those that are known; before that -2 - a rank that has the node
      logical :: is_near(mesh%n_elements)
      integer(ip) :: ring, e, i, k
      integer(ip), parameter :: NOWHERE = huge(1_ip)

      ring_of = NOWHERE
      do e = 1, mesh%n_elements
         do k = 1, mesh%shape(e)
            i = mesh%nodes(k, e)
            if (ring_of(i) == NOWHERE) ring_of(i) = -2 - rank_of(e)
            if (ring_of(i) /= -2 - rank_of(e)) ring_of(i) = 0
         end do
      end do
      where (ring_of < 0) ring_of = NOWHERE
      is_near = .false.
      do ring = 1, RINGS
         do i = 1, mesh%n_elements
            e = order(i)
            if (is_near(e)) cycle
            do k = 1, mesh%shape(e)
               if (ring_of(mesh%nodes(k, e)) < ring) exit
            end do
            is_near(e) = k <= mesh%shape(e)
            if (.not. is_near(e)) cycle
            do k = 1, mesh%shape(e)
               ring_of(mesh%nodes(k, e)) = min(ring_of(mesh%nodes(k, e)), ring)
            end do
         end do
      end do
      near = pack(order, is_near(order))
   end subroutine list_near_border

   !> The nodes of the elements of a rank, then the rings round them.
   pure subroutine add_rings(mesh, near, rank_of, rank, known, region)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: near(:)             !< elements that may lie in them
      integer(ip), intent(in) :: rank_of(:), rank
      integer(ip), intent(inout) :: known(:)         !< (n_nodes) the ring of a node behind all rings of the ranks before; -1
      type(region_t), intent(inout) :: region        !< with its own elements
      integer(ip), allocatable :: element(:), node(:)
      logical :: is_in(size(near))
      integer(ip) :: before, ring, i, n, m

      before = rank*(RINGS + 1_ip)
      n = 0
      allocate (node(min(mesh%n_nodes, sum(mesh%shape(region%element)) + sum(mesh%shape(near)))))
      do i = 1, region%n_own
         call add_nodes_of(mesh, region%element(i), before, before, known, node, n)
      end do
      region%n_nodes = n
      m = 0
      allocate (element(size(near)))
      is_in = rank_of(near) == rank
      do ring = before + 1, before + RINGS
         do i = 1, size(near, kind=ip)
            if (is_in(i)) cycle
            associate (of_nodes => known(mesh%nodes(:mesh%shape(near(i)), near(i))))
               is_in(i) = any(of_nodes >= before .and. of_nodes < ring)
            end associate
            if (.not. is_in(i)) cycle
            m = m + 1
            element(m) = near(i)
            call add_nodes_of(mesh, near(i), before, ring, known, node, n)
         end do
      end do
      region%element = [region%element, element(:m)]
      region%node = node(:n)
   end subroutine add_rings

   pure subroutine add_nodes_of(mesh, element, before, ring, known, list, n)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element, before, ring
      integer(ip), intent(inout) :: known(:), list(:), n
      integer(ip) :: k

      do k = 1, mesh%shape(element)
         associate (node => mesh%nodes(k, element))
            if (known(node) >= before) cycle
            known(node) = ring
            n = n + 1
            list(n) = node
         end associate
      end do
   end subroutine add_nodes_of

   !> The places in a list of nodes, square by square: what is near in the plane is near in the list.
   pure subroutine sort_by_squares(x, nodes, order)
      real(wp), intent(in) :: x(:, :)            !< (2, all nodes) [L]
      integer(ip), intent(in) :: nodes(:)
      integer(ip), allocatable, intent(out) :: order(:)
      integer(ip), allocatable :: first(:), square(:)
      real(wp) :: low(2), high(2), side
      integer(ip) :: n(2), at(2), i, s

      allocate (square(size(nodes)), order(size(nodes)))
      if (size(nodes) == 0) return
      low = x(:, nodes(1))
      high = low
      do i = 2, size(nodes, kind=ip)
         low = min(low, x(:, nodes(i)))
         high = max(high, x(:, nodes(i)))
      end do
      associate (extent => high - low, n_nodes => real(size(nodes), wp))
         side = sqrt(max(product(extent), maxval(extent)**2/n_nodes)*OF_A_SQUARE/n_nodes)
         n = int(extent/max(side, tiny(side)), ip) + 1_ip
      end associate
      allocate (first(0:n(1)*n(2)), source=0_ip)
      do i = 1, size(nodes, kind=ip)
         at = min(int((x(:, nodes(i)) - low)/max(side, tiny(side)), ip), n - 1_ip)
         square(i) = at(1) + n(1)*at(2)          ! from 0
         first(square(i) + 1) = first(square(i) + 1) + 1
      end do
      do s = 1, n(1)*n(2)
         first(s) = first(s) + first(s - 1)
      end do
      do i = 1, size(nodes, kind=ip)
         first(square(i)) = first(square(i)) + 1
         order(first(square(i))) = i
      end do
   end subroutine sort_by_squares

end module atrito_shared_fields
