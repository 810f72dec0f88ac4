!> Continuous stresses by superconvergent patch recovery (O. C. Zienkiewicz and J. Z. Zhu, Int. J. Numer. Methods Eng. 33, 1992).
!>
!> A polynomial of the elements' degree p is fitted to the stresses at their best points (first degree: the centre; second: 2 x 2
!> Gauss points, of triangles the three of the stiffness) round every corner node inside a zone; nodes on the outline of the zone
!> take their values from the patches inside. Where there is none at hand, the patch of an outer node takes all Gauss points of two
!> elements or more, and an element without neighbours its best points and degree p - 1.
!>
!> Why these points. The stresses of the displacements, of degree p, have errors of the order h^p in an element, and jump from one
!> to the next. At the best points of a regular mesh the leading term of that error is zero (Barlow; of degree one it is linear in
!> xi and eta, and zero in the middle): the samples there are of the order h^(p+1), and so is a polynomial of degree p through
!> them, everywhere in the patch. The recovered stresses are thus one order better than those that they come from, which is what
!> makes their distance an estimate of the error (atrito_error_estimate).
module atrito_stress_recovery
   use atrito_assembly, only: fem_t
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF, BEST_OF, POINTS_OF, MOST_NODES, MOST_CORNERS
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, side_count, is_revolved
   use atrito_patch_fit, only: patch_fit_t, polynomial_t, clear_samples, add_sample, is_laid, lay_patch, &
                               determined_degree, fit_node, fit_polynomial, fitted_value
   use atrito_patches, only: patches_t, build_patches, PATCH_NONE, PATCH_OUTER, PATCH_SINGLE
   use atrito_plane_state, only: stress_33, thermal_modulus_33, von_mises, IS_REDUCED, COMPONENTS, STATES, STRESS_NAMES
   use atrito_point_stress, only: point_rule_t, point_geometry_t, MOST_POINTS, make_point_rules, fetch_geometry, point_stresses
   use atrito_threads, only: is_shared, chunk_count, find_chunk
   implicit none (type, external)
   private
   public :: stress_field_t, recover_stress_field, nodal_stresses

   !> A stress field that is continuous in every zone: values at places, interpolated by the shape functions of the elements.
   type :: stress_field_t
      integer(ip) :: n = 0                         !< places; of node i in its first zone: place i
      integer(ip), allocatable :: node(:)          !< (n) node of a place
      integer(ip), allocatable :: element(:)       !< (n) an element that the place belongs to; 0: none
      integer(ip), allocatable :: place(:, :)      !< (most nodes of an element, n_elements): places of an element's nodes
      real(wp), allocatable :: stress(:, :)        !< (COMPONENTS, n) [F/L^2]
      real(wp), allocatable :: hoop(:)             !< (n) s33 of axisymmetric elements [F/L^2]; not allocated where there are none
   end type stress_field_t

   !> What a recovery works with.
   type :: recovery_t
      type(point_rule_t) :: best(MOST_NODES)           !< of each shape: the superconvergent points
      type(point_rule_t) :: all(MOST_NODES)            !< and the Gauss points of the stiffness
      type(patches_t) :: patches                       !< zones, and the elements round each place
      real(wp), allocatable :: x(:, :, :)              !< best points less the element's first node [L], (2, points, n_elements)
      real(wp), allocatable :: s(:, :, :)              !< stresses there [F/L^2], (COMPONENTS, points, n_elements)
      type(polynomial_t), allocatable :: polynomial(:) !< (places) of the patches that lend to other nodes
      logical :: of_hoop = .false.                     !< s is s33 of axisymmetric elements and twice 0: a recovery of its own
   end type recovery_t

   !> How good the patch of a corner is for a node of the element: 1 the node's own, or that of its edge or its element; then the
   !> corners next to it along an edge; then across the element. Only the best rank at hand is taken. (corner, node)
   integer(ip), parameter :: RANK_OF(MOST_CORNERS, MOST_NODES) = reshape([1, 2, 3, 2, 2, 1, 2, 3, 3, 2, 1, 2, 2, 3, 2, 1, &
                                                                          1, 1, 2, 2, 2, 1, 1, 2, 2, 2, 1, 1, 1, 2, 2, 1, &
                                                                          1, 1, 1, 1], [4, 9])
   !> The same of triangles; there is no fourth corner.
   integer(ip), parameter :: TRIANGLE_RANK_OF(MOST_CORNERS, 6) = reshape([1, 2, 2, 0, 2, 1, 2, 0, 2, 2, 1, 0, &
                                                                          1, 1, 2, 0, 2, 1, 1, 0, 1, 2, 1, 0], [4, 6])
   integer(ip), parameter :: RANK_NEIGHBOUR = 4, RANK_NONE = 5 !< of an element that has the patches of its neighbour

contains

   !> Recovers the stresses of a displacement field.
   !>
   !>     1. zones and patches (build_patches)
   !>     2. stresses of u at the best points of all elements (sample_stresses)
   !>     3. at each node with a patch the polynomial through the samples round it, and its value there (fit_chunk)
   !>     4. the others take the mean of what the best patches at hand have at their place (borrow_stresses)
   !>     5. in rings once more for the hoop stress, which goes the same way as if it were a component in the plane
   !>
   !> All patches are small: some 4 to 18 samples for 3 or 6 terms, so it takes a time in proportion to the number of elements.
   subroutine recover_stress_field(fem, u, field)
      type(fem_t), intent(in) :: fem               !< mesh, sections and temperatures are read
      real(wp), intent(in) :: u(:, :)              !< (2, n_nodes) [L]
      type(stress_field_t), intent(out) :: field   !< at all places
      type(recovery_t) :: work
      real(wp), allocatable :: hoop(:, :)
      integer(ip) :: k

      call build_patches(fem, work%patches)
      call make_point_rules(BEST_OF, work%best)
      call make_point_rules(POINTS_OF, work%all)
      k = max(1_ip, maxval(BEST_OF(fem%mesh%shape)))
      allocate (work%x(2, k, fem%mesh%n_elements), work%s(COMPONENTS, k, fem%mesh%n_elements))
      call sample_stresses(fem, u, work)
      field%n = work%patches%n
      allocate (field%stress(COMPONENTS, field%n), work%polynomial(field%n))
      call fit_stresses(fem, u, work, field%stress)
      if (is_revolved(fem%mesh)) then
         work%of_hoop = .true.
         call sample_stresses(fem, u, work)
         allocate (hoop(COMPONENTS, field%n))
         call fit_stresses(fem, u, work, hoop)
         field%hoop = hoop(1, :)
      end if
      call move_alloc(work%patches%place, field%place)
      call move_alloc(work%patches%node, field%node)
      call move_alloc(work%patches%owner, field%element)
   end subroutine recover_stress_field

   !> From the stresses at the best points to those at the places.
   subroutine fit_stresses(fem, u, work, stress)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      type(recovery_t), intent(inout) :: work
      real(wp), intent(inout) :: stress(:, :)
      integer(ip) :: chunk

      !$omp parallel do schedule(dynamic) if (is_shared(work%patches%n))
      do chunk = 1, chunk_count(work%patches%n)
         call fit_chunk(fem, u, chunk, work, stress)
      end do
      !$omp end parallel do
      call borrow_stresses(fem%mesh, work, stress)
   end subroutine fit_stresses

   !> The stresses at the best points of all elements.
   subroutine sample_stresses(fem, u, work)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      type(recovery_t), intent(inout) :: work
      integer(ip) :: chunk

      !$omp parallel do schedule(dynamic) if (is_shared(fem%mesh%n_elements))
      do chunk = 1, chunk_count(fem%mesh%n_elements)
         call sample_chunk(fem, u, chunk, work)
      end do
      !$omp end parallel do
   end subroutine sample_stresses

   pure subroutine sample_chunk(fem, u, chunk, work)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: chunk
      type(recovery_t), intent(inout) :: work      !< x and s of the chunk's elements are set
      type(point_geometry_t) :: geometry
      real(wp) :: s(MOST_POINTS, COMPONENTS)
      integer(ip) :: e, point, first, last

      call find_chunk(chunk, fem%mesh%n_elements, first, last)
      do e = first, last
         associate (rule => work%best(fem%mesh%shape(e)))
            call fetch_geometry(fem, e, rule, geometry)
            call stresses_at(fem, e, u, rule, geometry, work%of_hoop, s)
            do point = 1, rule%n
               work%s(:, point, e) = s(point, :)
               work%x(:, point, e) = geometry%place(point, :)
            end do
         end associate
      end do
   end subroutine sample_chunk

   !> The stresses of an element at the points of a rule; of a recovery of hoop stresses s33 in the place of the first one and 0 in
   !> that of the others.
   pure subroutine stresses_at(fem, e, u, rule, geometry, of_hoop, s)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: u(:, :)
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(in) :: geometry
      logical, intent(in) :: of_hoop
      real(wp), intent(inout) :: s(MOST_POINTS, COMPONENTS)
      real(wp) :: hoop(MOST_POINTS)

      if (.not. of_hoop) then
         call point_stresses(fem, e, u, rule, geometry, s)
         return
      end if
      hoop = 0.0_wp
      call point_stresses(fem, e, u, rule, geometry, s, hoop)
      s = 0.0_wp
      s(:, 1) = hoop
   end subroutine stresses_at

   !> The patches of one chunk of places: the stress at their nodes, and the polynomials that other nodes want.
   pure subroutine fit_chunk(fem, u, chunk, work, stress)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: chunk
      type(recovery_t), intent(inout) :: work      !< the polynomials of the chunk's places are set
      real(wp), intent(inout) :: stress(:, :)      !< those of the chunk's places are set
      type(patch_fit_t) :: fit
      integer(ip) :: i, first, last, degree

      call find_chunk(chunk, work%patches%n, first, last)
      do i = first, last
         stress(:, i) = 0.0_wp
         if (work%patches%kind(i) == PATCH_NONE) cycle
         call fit_patch(fem, u, i, work, fit, degree)
         call fit_node(degree, fit, stress(:, i))
         associate (elements => work%patches%element(work%patches%first(i):work%patches%first(i + 1) - 1))
            if (any(work%patches%lends(elements))) call fit_polynomial(degree, fit, work%polynomial(i))
         end associate
      end do
   end subroutine fit_chunk

   !> Samples of a patch, and the degree that they determine. When the best points do not determine what they should, all Gauss
   !> points and lower degrees are tried: four quadrilaterals of the first degree have four best points for the three terms
   !> 1, xi, eta; two in a row have two, on a line, which leave eta open. So patches on the outline take all Gauss points at once.
   pure subroutine fit_patch(fem, u, i, work, fit, degree)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: i                 !< place of the patch
      type(recovery_t), intent(in) :: work
      type(patch_fit_t), intent(inout) :: fit
      integer(ip), intent(out) :: degree
      integer(ip) :: full, k, point
      real(wp) :: first(2)

      associate (patches => work%patches)
         full = DEGREE_OF(fem%mesh%shape(patches%element(patches%first(i))))
         if (patches%kind(i) /= PATCH_OUTER) then
            call clear_samples(fit)
            do k = patches%first(i), patches%first(i + 1) - 1
               first = from_patch(fem%mesh, work%patches, i, fem%mesh%nodes(1, patches%element(k)))
               do point = 1, work%best(fem%mesh%shape(patches%element(k)))%n
                  call add_sample(first + work%x(:, point, patches%element(k)), work%s(:, point, patches%element(k)), fit)
               end do
            end do
            call lay_when_new(fem, i, patches, full, fit)
            degree = merge(full - 1, full, patches%kind(i) == PATCH_SINGLE)
            if (determined_degree(degree, fit) == degree) return
         end if
         call clear_samples(fit)
         do k = patches%first(i), patches%first(i + 1) - 1
            call add_all_points(fem, u, i, patches%element(k), work, fit)
         end do
         call lay_when_new(fem, i, patches, full, fit)
         degree = determined_degree(full, fit)
      end associate
   end subroutine fit_patch

   !> Lays the patch unless the one before has its shape within the rounding of the coordinates, never coarser than 1e-12 of it.
   pure subroutine lay_when_new(fem, i, patches, degree, fit)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i, degree
      type(patches_t), intent(in) :: patches
      type(patch_fit_t), intent(inout) :: fit
      integer(ip), parameter :: ENOUGH = 16        !< elements round a node; more give no better coordinates
      real(wp) :: corners(2, MOST_CORNERS*ENOUGH), here(2), slack
      integer(ip) :: j, k, n

      here = fem%mesh%x(:, patches%node(i))
      slack = min(4*EPS_MACH*max(abs(here(1)), abs(here(2))), 1.0e-12_wp*max(abs(fit%x(1, 1)), abs(fit%x(2, 1))))
      if (is_laid(degree, slack, fit)) return
      n = 0
      do j = patches%first(i), min(patches%first(i + 1), patches%first(i) + ENOUGH) - 1
         do k = 1, side_count(fem%mesh, patches%element(j))
            n = n + 1
            corners(:, n) = from_patch(fem%mesh, patches, i, fem%mesh%nodes(k, patches%element(j)))
         end do
      end do
      call lay_patch(corners(:, :n), degree, fit)
   end subroutine lay_when_new

   !> A node less the node of a patch [L].
   pure function from_patch(mesh, patches, i, node) result(x)
      type(mesh_t), intent(in) :: mesh
      type(patches_t), intent(in) :: patches
      integer(ip), intent(in) :: i, node
      real(wp) :: x(2)

      x = mesh%x(:, node) - mesh%x(:, patches%node(i))
   end function from_patch

   pure subroutine add_all_points(fem, u, i, e, work, fit)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: i, e
      type(recovery_t), intent(in) :: work
      type(patch_fit_t), intent(inout) :: fit
      type(point_geometry_t) :: geometry
      real(wp) :: first(2), s(MOST_POINTS, COMPONENTS)
      integer(ip) :: point

      first = from_patch(fem%mesh, work%patches, i, fem%mesh%nodes(1, e))
      if (IS_REDUCED(fem%mesh%state(e))) then        ! there are no others than the best
         do point = 1, work%best(fem%mesh%shape(e))%n
            call add_sample(first + work%x(:, point, e), work%s(:, point, e), fit)
         end do
         return
      end if
      associate (rule => work%all(fem%mesh%shape(e)))
         call fetch_geometry(fem, e, rule, geometry)
         call stresses_at(fem, e, u, rule, geometry, work%of_hoop, s)
         do point = 1, rule%n
            call add_sample(first + geometry%place(point, :), s(point, :), fit)
         end do
      end associate
   end subroutine add_all_points

   !> Gives the nodes without a patch of their own the mean of the best patches at hand. Most of them, the middles of sides and
   !> elements, find patches of rank 1, which are the same from all their elements; the few others ask all of theirs.
   !>
   !> Rank 1 are the patches at the ends of the node's own side, and for the middle of an element those of its corners; the next
   !> ones are those of corners beside, then across (RANK_OF). A node inside of a side belongs to two elements with the same
   !> corners at its ends, so one of them, its owner, can answer. Only where rank 1 is not at hand, on the outline, may its
   !> elements know different patches, and all are asked.
   subroutine borrow_stresses(mesh, work, stress)
      type(mesh_t), intent(in) :: mesh
      type(recovery_t), intent(in) :: work
      real(wp), intent(inout) :: stress(:, :)
      logical, allocatable :: asks(:)
      integer(ip) :: e

      allocate (asks(mesh%n_elements))
      !$omp parallel do schedule(dynamic, 256) if (is_shared(mesh%n_elements))
      do e = 1, mesh%n_elements
         asks(e) = .false.
         if (work%patches%lends(e)) call borrow_in_element(mesh, e, work, stress, asks(e))
      end do
      !$omp end parallel do
      if (any(asks)) call borrow_from_all(mesh, asks, work, stress)
   end subroutine borrow_stresses

   !> Rank of the best patches of an element for its node.
   pure integer(ip) function best_rank(mesh, patches, e, k)
      type(mesh_t), intent(in) :: mesh
      type(patches_t), intent(in) :: patches
      integer(ip), intent(in) :: e, k
      integer(ip) :: corner, lender

      lender = lender_to(patches, e)
      best_rank = RANK_NONE
      do corner = 1, CORNERS_OF(mesh%shape(lender))
         if (patches%kind(patches%place(corner, lender)) == PATCH_NONE) cycle
         best_rank = min(best_rank, rank_for(mesh%shape(e), lender == e, corner, k))
      end do
   end function best_rank

   !> The element whose patches an element takes: its own, or those of its neighbour.
   pure integer(ip) function lender_to(patches, e)
      type(patches_t), intent(in) :: patches
      integer(ip), intent(in) :: e

      lender_to = e
      if (.not. allocated(patches%helper)) return
      if (patches%helper(e) > 0) lender_to = patches%helper(e)
   end function lender_to

   pure integer(ip) function rank_for(shape, is_own, corner, k)
      integer(ip), intent(in) :: shape, corner, k
      logical, intent(in) :: is_own                !< the corner is of the element itself

      if (.not. is_own) then
         rank_for = RANK_NEIGHBOUR
      else if (CORNERS_OF(shape) == 3) then
         rank_for = TRIANGLE_RANK_OF(corner, k)
      else
         rank_for = RANK_OF(corner, k)
      end if
   end function rank_for

   !> Adds the values of an element's patches of a rank for its node.
   pure subroutine add_borrowed(mesh, e, k, wanted, work, stress, count)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e, k, wanted        !< wanted: the rank
      type(recovery_t), intent(in) :: work
      real(wp), intent(inout) :: stress(COMPONENTS)
      integer(ip), intent(inout) :: count
      integer(ip) :: corner, i, lender

      lender = lender_to(work%patches, e)
      do corner = 1, CORNERS_OF(mesh%shape(lender))
         i = work%patches%place(corner, lender)
         if (work%patches%kind(i) == PATCH_NONE .or. rank_for(mesh%shape(e), lender == e, corner, k) /= wanted) cycle
         stress = stress + fitted_value(from_patch(mesh, work%patches, i, mesh%nodes(k, e)), work%polynomial(i))
         count = count + 1
      end do
   end subroutine add_borrowed

   !> The nodes with patches of rank 1 that this element owns. asks: there are nodes without.
   pure subroutine borrow_in_element(mesh, e, work, stress, asks)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e
      type(recovery_t), intent(in) :: work
      real(wp), intent(inout) :: stress(:, :)
      logical, intent(inout) :: asks
      integer(ip) :: k, at, count

      do k = 1, mesh%shape(e)
         at = work%patches%place(k, e)
         if (work%patches%kind(at) /= PATCH_NONE) cycle
         if (best_rank(mesh, work%patches, e, k) > 1) then
            asks = .true.
         else if (work%patches%owner(at) == e) then
            count = 0
            call add_borrowed(mesh, e, k, 1_ip, work, stress(:, at), count)
            stress(:, at) = stress(:, at)/real(count, wp)
         end if
      end do
   end subroutine borrow_in_element

   !> The nodes of some elements that have no patch of rank 1: the best rank that one of their elements has is taken of all.
   pure subroutine borrow_from_all(mesh, asks, work, stress)
      type(mesh_t), intent(in) :: mesh
      logical, intent(in) :: asks(:)               !< of each element
      type(recovery_t), intent(in) :: work
      real(wp), intent(inout) :: stress(:, :)
      integer(ip), allocatable :: best(:), count(:)
      integer(ip) :: k, e, at, own

      allocate (best(work%patches%n), source=RANK_NONE)
      allocate (count(work%patches%n), source=0_ip)
      do e = 1, mesh%n_elements
         if (.not. asks(e)) cycle
         do k = 1, mesh%shape(e)
            at = work%patches%place(k, e)
            own = best_rank(mesh, work%patches, e, k)
            if (own == 1 .or. own > best(at) .or. work%patches%kind(at) /= PATCH_NONE) cycle
            if (own < best(at)) then
               best(at) = own
               count(at) = 0
               stress(:, at) = 0.0_wp
            end if
            call add_borrowed(mesh, e, k, own, work, stress(:, at), count(at))
         end do
      end do
      do at = 1, size(count, kind=ip)
         if (count(at) > 0) stress(:, at) = stress(:, at)/real(count(at), wp)
      end do
   end subroutine borrow_from_all

   !> s11 s22 s33 s12 mises at the nodes: the mean of the zones that meet there, and Mises' stress of that mean. 0 at nodes in no
   !> element.
   subroutine nodal_stresses(fem, field, stress)
      type(fem_t), intent(in) :: fem                      !< mesh, sections and temperatures are read
      type(stress_field_t), intent(in) :: field           !< recovered from the displacements
      real(wp), allocatable, intent(out) :: stress(:, :)  !< (5, n_nodes) [F/L^2]
      integer(ip), allocatable :: zones(:)
      integer(ip) :: i, node

      allocate (stress(size(STRESS_NAMES), fem%mesh%n_nodes), zones(fem%mesh%n_nodes))
      !$omp parallel do schedule(static) if (is_shared(fem%mesh%n_nodes))
      do node = 1, fem%mesh%n_nodes                ! also the number of the place in its first zone
         stress(:, node) = 0.0_wp
         zones(node) = 0
         call add_zone(fem, field, node, stress(:, node), zones(node))
      end do
      !$omp end parallel do
      do i = fem%mesh%n_nodes + 1, field%n
         call add_zone(fem, field, i, stress(:, field%node(i)), zones(field%node(i)))
      end do
      !$omp parallel do schedule(static) if (is_shared(fem%mesh%n_nodes))
      do node = 1, fem%mesh%n_nodes
         if (zones(node) > 1) stress(:4, node) = stress(:4, node)/real(zones(node), wp)
         stress(5, node) = von_mises([stress(1, node), stress(2, node), stress(4, node)], stress(3, node))
      end do
      !$omp end parallel do
   end subroutine nodal_stresses

   !> Adds the stresses at a place to those of its node.
   pure subroutine add_zone(fem, field, i, stress, zones)
      type(fem_t), intent(in) :: fem
      type(stress_field_t), intent(in) :: field
      integer(ip), intent(in) :: i
      real(wp), intent(inout) :: stress(size(STRESS_NAMES))
      integer(ip), intent(inout) :: zones
      integer(ip) :: e

      e = field%element(i)
      if (e == 0) return
      zones = zones + 1
      stress(1:2) = stress(1:2) + field%stress(1:2, i)
      if (allocated(field%hoop)) then                ! all elements are axisymmetric, or none
         stress(3) = stress(3) + field%hoop(i)
      else
         stress(3) = stress(3) + stress_33(fem%sections(fem%section_of(e)), fem%mesh%state(e), field%stress(:, i))
         if (allocated(fem%heating)) stress(3) = stress(3) + thermal_stress_33(fem, e, field%node(i))
      end if
      stress(4) = stress(4) + field%stress(3, i)
   end subroutine add_zone

   !> What the temperature of a node adds to the stress across the plane [F/L^2].
   pure real(wp) function thermal_stress_33(fem, e, node) result(s33)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e, node

      s33 = 0.0_wp
      if (STATES(fem%mesh%state(e))%is_thin) return
      associate (section => fem%sections(fem%section_of(e)))
         s33 = -thermal_modulus_33(section)*section%expansion*fem%heating(node)
      end associate
   end function thermal_stress_33

end module atrito_stress_recovery
