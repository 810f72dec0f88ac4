!> The patches of a stress recovery: which elements have one smooth stress field, and the elements round each corner node.
!>
!> Stresses jump where the material, the thickness or the plane state changes, so a zone is what these do not divide. A node has
!> a place of its own in every zone that it belongs to; different bodies share no node, so no zone reaches over a contact.
module atrito_patches
   use atrito_assembly, only: fem_t
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF, MOST_NODES, MOST_CORNERS
   use atrito_growth, only: resize
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t
   use atrito_plane_state, only: STATES
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: patches_t, build_patches
   public :: PATCH_NONE, PATCH_INTERIOR, PATCH_OUTER, PATCH_SINGLE

   integer(ip), parameter :: PATCH_NONE = 0      !< takes its stress from the patches of other nodes
   integer(ip), parameter :: PATCH_INTERIOR = 1  !< elements of the zone all round the node
   integer(ip), parameter :: PATCH_OUTER = 2     !< on the outline, where no interior patch is at hand; two elements or more
   integer(ip), parameter :: PATCH_SINGLE = 3    !< a corner of an element without neighbours

   type :: patches_t
      integer(ip) :: n = 0                        !< places: pairs of a node and a zone; the first zone of node i has place i
      integer(ip), allocatable :: node(:)         !< (n) the node of a place
      integer(ip), allocatable :: place(:, :)     !< (most nodes of an element, n_elements): places of an element's nodes
      integer(ip), allocatable :: kind(:)         !< (n) PATCH_*
      integer(ip), allocatable :: first(:)        !< (n + 1): element(first(i):first(i+1)-1) have place i as a corner
      integer(ip), allocatable :: element(:), corner(:) !< at a corner: place in the mesh; which corner of it
      integer(ip), allocatable :: owner(:)        !< (n) the first element that a place belongs to; 0: none
      logical, allocatable :: lends(:)            !< (n_elements) a node of the element takes its stress from patches of other nodes
      integer(ip), allocatable :: helper(:)       !< (n_elements, or none) of a triangle without a patch: its neighbour with one; 0
   end type patches_t

contains

   !> Zones, places and patches of all elements.
   subroutine build_patches(fem, patches)
      type(fem_t), intent(in) :: fem          !< mesh and sections are read
      type(patches_t), intent(out) :: patches !< of all zones

      call number_places(fem%mesh, zones_of_elements(fem), patches)
      call list_elements_at_corners(fem%mesh, patches)
      call choose_patches(fem%mesh, patches)
   end subroutine build_patches

   !> Number of the zone's kind for each element: alike are elements of equal elastic section, plane state and degree, triangles and
   !> quadrilaterals together. (Two parts of the mesh that do not touch may have the same number: they share no node.)
   function zones_of_elements(fem) result(zone)
      type(fem_t), intent(in) :: fem
      integer(ip), allocatable :: zone(:)
      integer(ip) :: like(size(fem%sections)), i, j, e

      do i = 1, size(fem%sections, kind=ip)
         do j = 1, i
            associate (a => fem%sections(i), b => fem%sections(j))
               if (a%young == b%young .and. a%poisson == b%poisson .and. a%thickness == b%thickness &
                   .and. all(a%stiffness == b%stiffness)) exit
            end associate
         end do
         like(i) = j
      end do
      allocate (zone(fem%mesh%n_elements))
      !$omp parallel do schedule(static) if (is_shared(fem%mesh%n_elements))
      do e = 1, fem%mesh%n_elements
         zone(e) = (like(fem%section_of(e))*size(STATES, kind=ip) + fem%mesh%state(e))*MOST_NODES + DEGREE_OF(fem%mesh%shape(e))
      end do
      !$omp end parallel do
   end function zones_of_elements

   !> Gives every pair of a node and a zone its place.
   subroutine number_places(mesh, zone, patches)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: zone(:)
      type(patches_t), intent(inout) :: patches
      integer(ip) :: e, i, most

      most = maxval([mesh%shape(:mesh%n_elements), MOST_CORNERS])
      allocate (patches%place(most, mesh%n_elements))
      !$omp parallel do schedule(static) if (is_shared(mesh%n_elements))
      do e = 1, mesh%n_elements
         patches%place(:, e) = mesh%nodes(:most, e)
      end do
      !$omp end parallel do
      patches%n = mesh%n_nodes
      allocate (patches%node(patches%n))
      do i = 1, patches%n
         patches%node(i) = i
      end do
      if (size(zone) == 0) return
      if (minval(zone) /= maxval(zone)) call add_places(mesh, zone, patches)
   end subroutine number_places

   !> Adds the places of the second zone at a node, of the third, ...
   !>
   !> The places of a node are a chain: the first has the node's number, next(at) leads to the one of a further zone, 0 ends it. An
   !> element goes along the chain of each of its nodes until it meets its own zone, and appends a place where there is none: few
   !> zones meet at a node, so that is a step or two, whatever the number of elements.
   pure subroutine add_places(mesh, zone, patches)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: zone(:)
      type(patches_t), intent(inout) :: patches
      integer(ip), allocatable :: zone_at(:), next(:)
      integer(ip) :: e, k, at, room

      allocate (zone_at(patches%n), next(patches%n), source=0_ip)
      do e = 1, mesh%n_elements
         do k = 1, mesh%shape(e)
            at = mesh%nodes(k, e)
            if (zone_at(at) == 0) zone_at(at) = zone(e)
            do while (zone_at(at) /= zone(e))
               if (next(at) == 0) then
                  if (patches%n == size(zone_at)) then
                     room = patches%n + patches%n/2 + 64
                     call resize(zone_at, patches%n, room)
                     call resize(next, patches%n, room)
                     call resize(patches%node, patches%n, room)
                  end if
                  patches%n = patches%n + 1
                  zone_at(patches%n) = zone(e)
                  next(patches%n) = 0
                  patches%node(patches%n) = mesh%nodes(k, e)
                  next(at) = patches%n
               end if
               at = next(at)
            end do
            patches%place(k, e) = at
         end do
      end do
      patches%node = patches%node(:patches%n)
   end subroutine add_places

   !> The elements round each corner, rising: counted and filled by parts of the elements, part by part at each place.
   subroutine list_elements_at_corners(mesh, patches)
      type(mesh_t), intent(in) :: mesh
      type(patches_t), intent(inout) :: patches
      integer(ip), allocatable :: corners(:, :)
      integer(ip) :: e, k

      if (any(mesh%shape(:mesh%n_elements) == 6)) then   ! their fourth node is the middle of a side
         corners = patches%place(:MOST_CORNERS, :)       ! and 0 behind those of triangles
         do e = 1, mesh%n_elements
            corners(CORNERS_OF(mesh%shape(e)) + 1:, e) = 0
         end do
         call list_holders(patches%n, corners, patches%first, patches%element, patches%corner)
      else
         call list_holders(patches%n, patches%place(:MOST_CORNERS, :), patches%first, patches%element, patches%corner)
      end if
      allocate (patches%owner(patches%n))
      !$omp parallel do schedule(static) if (is_shared(patches%n))
      do k = 1, patches%n
         patches%owner(k) = 0
         if (patches%first(k + 1) > patches%first(k)) patches%owner(k) = patches%element(patches%first(k))
      end do
      !$omp end parallel do
      if (size(patches%place, 1) == MOST_CORNERS) return  ! all nodes are corners
      do e = mesh%n_elements, 1, -1
         do k = CORNERS_OF(mesh%shape(e)) + 1, mesh%shape(e)
            patches%owner(patches%place(k, e)) = e
         end do
      end do
   end subroutine list_elements_at_corners

   !> Interior nodes have patches. Elements that touch none (a zone one or two elements wide) get patches at their nodes that
   !> have a neighbour; those that still have none are alone.
   subroutine choose_patches(mesh, patches)
      type(mesh_t), intent(in) :: mesh
      type(patches_t), intent(inout) :: patches
      integer(ip) :: i, e
      logical :: found

      allocate (patches%kind(patches%n), patches%lends(mesh%n_elements))
      !$omp parallel do schedule(static) if (is_shared(patches%n))
      do i = 1, patches%n
         patches%kind(i) = merge(PATCH_INTERIOR, PATCH_NONE, is_interior(mesh, patches, i))
      end do
      !$omp end parallel do
      if (any(CORNERS_OF(mesh%shape(:mesh%n_elements)) == 3)) call find_helpers(mesh, patches)
      call patch_the_bare(mesh, 2_ip, PATCH_OUTER, patches, found)
      if (found) call patch_the_bare(mesh, 1_ip, PATCH_SINGLE, patches, found)
      !$omp parallel do schedule(static) if (is_shared(mesh%n_elements))
      do e = 1, mesh%n_elements
         patches%lends(e) = DEGREE_OF(mesh%shape(e)) > 1 .or. patches_at(mesh, patches, e) < CORNERS_OF(mesh%shape(e))
      end do
      !$omp end parallel do
      if (.not. allocated(patches%helper)) return
      do e = 1, mesh%n_elements
         if (patches%helper(e) > 0) patches%lends(patches%helper(e)) = .true.
      end do
   end subroutine choose_patches

   !> A triangle in a corner of the outline has no node inside, but a neighbour that has one: the patches of that one serve both.
   pure subroutine find_helpers(mesh, patches)
      type(mesh_t), intent(in) :: mesh
      type(patches_t), intent(inout) :: patches
      integer(ip) :: e, side, j, other, from, to

      allocate (patches%helper(mesh%n_elements), source=0_ip)
      do e = 1, mesh%n_elements
         if (CORNERS_OF(mesh%shape(e)) /= 3 .or. patches_at(mesh, patches, e) > 0) cycle
         do side = 1, 3
            from = patches%place(side, e)
            to = patches%place(mod(side, 3_ip) + 1, e)
            do j = patches%first(from), patches%first(from + 1) - 1
               other = patches%element(j)
               if (.not. any(patches%place(:CORNERS_OF(mesh%shape(other)), other) == to)) cycle
               if (patches_at(mesh, patches, other) > 0) patches%helper(e) = other
            end do
         end do
      end do
   end subroutine find_helpers

   !> Corners of an element with a patch.
   pure integer(ip) function patches_at(mesh, patches, e)
      type(mesh_t), intent(in) :: mesh
      type(patches_t), intent(in) :: patches
      integer(ip), intent(in) :: e
      integer(ip) :: k

      patches_at = 0
      do k = 1, 3                                 ! a length that the compiler knows
         if (patches%kind(patches%place(k, e)) /= PATCH_NONE) patches_at = patches_at + 1
      end do
      if (CORNERS_OF(mesh%shape(e)) == 3) return
      if (patches%kind(patches%place(4, e)) /= PATCH_NONE) patches_at = patches_at + 1
   end function patches_at

   !> Gives a patch to the corners, of at least `least` elements, of all elements without a patch at any corner.
   subroutine patch_the_bare(mesh, least, kind, patches, found)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: least, kind
      type(patches_t), intent(inout) :: patches
      logical, intent(out) :: found                  !< there were such elements
      logical, allocatable :: bare(:)
      integer(ip) :: e, k, i

      allocate (bare(mesh%n_elements))
      !$omp parallel do schedule(static) if (is_shared(mesh%n_elements))
      do e = 1, mesh%n_elements
         bare(e) = patches_at(mesh, patches, e) == 0
      end do
      !$omp end parallel do
      if (allocated(patches%helper)) bare = bare .and. patches%helper == 0
      found = any(bare)
      do e = 1, mesh%n_elements
         if (.not. bare(e)) cycle
         do k = 1, CORNERS_OF(mesh%shape(e))
            i = patches%place(k, e)
            if (patches%first(i + 1) - patches%first(i) >= least) patches%kind(i) = kind
         end do
      end do
   end subroutine patch_the_bare

   !> Elements of the zone lie all round a corner node when each edge that leaves it has one of them on either side: in each element
   !> the edge to the next corner must be that to the corner before in another one. Nodes on an outline fail at its first edge.
   pure logical function is_interior(mesh, patches, i)
      type(mesh_t), intent(in) :: mesh
      type(patches_t), intent(in) :: patches
      integer(ip), intent(in) :: i
      integer(ip) :: j, k, next, before, wanted

      is_interior = .false.
      if (patches%first(i + 1) - patches%first(i) < 3) return
      do j = patches%first(i), patches%first(i + 1) - 1
         next = patches%corner(j) + 1
         if (next > CORNERS_OF(mesh%shape(patches%element(j)))) next = 1
         wanted = patches%place(next, patches%element(j))
         do k = patches%first(i), patches%first(i + 1) - 1
            before = patches%corner(k) - 1
            if (before == 0) before = CORNERS_OF(mesh%shape(patches%element(k)))
            if (patches%place(before, patches%element(k)) == wanted) exit
         end do
         if (k == patches%first(i + 1)) return
      end do
      is_interior = .true.
   end function is_interior

end module atrito_patches
