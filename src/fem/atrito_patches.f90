!> The patches of a stress recovery: which elements have one smooth stress field, and the elements round each corner node.
!>
!> Stresses jump where the material, the thickness or the plane state changes, so a zone is what these do not divide. A node has
!> a place of its own in every zone that it belongs to; different bodies share no node, so no zone reaches over a contact.
module atrito_patches
   use atrito_assembly, only: fem_t
   use atrito_elasticity, only: elastic_t
   use atrito_kinds, only: ip
   use atrito_mesh, only: Q1_NODES, Q2_NODES
   implicit none (type, external)
   private
   public :: patches_t, build_patches
   public :: PATCH_NONE, PATCH_INTERIOR, PATCH_OUTER, PATCH_SINGLE

   integer(ip), parameter :: PATCH_NONE = 0      !< takes its stress from the patches of other nodes
   integer(ip), parameter :: PATCH_INTERIOR = 1  !< elements of the zone all round the node
   integer(ip), parameter :: PATCH_OUTER = 2     !< on the outline, where no interior patch is at hand; two elements or more
   integer(ip), parameter :: PATCH_SINGLE = 3    !< a corner of an element without neighbours

   integer(ip), parameter :: CORNERS = Q1_NODES

   type :: patches_t
      integer(ip) :: n = 0                        !< places: pairs of a node and a zone
      integer(ip), allocatable :: node(:)         !< (n) the node of a place
      integer(ip), allocatable :: place(:, :)     !< (Q2_NODES, n_elements): places of an element's nodes
      integer(ip), allocatable :: kind(:)         !< (n) PATCH_*
      integer(ip), allocatable :: first(:)        !< (n + 1): element(first(i):first(i+1)-1) have place i as a corner
      integer(ip), allocatable :: element(:), corner(:)
   end type patches_t

contains

   !> Zones, places and patches of all elements.
   subroutine build_patches(fem, patches)
      type(fem_t), intent(in) :: fem
      type(patches_t), intent(out) :: patches

      call number_places(fem, zones_of_elements(fem), patches)
      call list_elements_at_corners(fem, patches)
      call choose_patches(fem, patches)
   end subroutine build_patches

   !> Number of the zone's kind for each element: alike are elements of equal elastic section, plane state and shape. (Two parts of
   !> the mesh that do not touch may have the same number: they share no node.)
   pure function zones_of_elements(fem) result(zone)
      type(fem_t), intent(in) :: fem
      integer(ip) :: zone(fem%mesh%n_elements)
      integer(ip) :: like(size(fem%sections)), i, j, e

      do i = 1, size(fem%sections, kind=ip)
         do j = 1, i
            if (same_section(fem%sections(i), fem%sections(j))) exit
         end do
         like(i) = j
      end do
      do e = 1, fem%mesh%n_elements
         zone(e) = 4*(like(fem%section_of(e)) - 1) + 2*(fem%mesh%state(e) - 1) + merge(1_ip, 2_ip, fem%mesh%shape(e) == Q1_NODES)
      end do
   end function zones_of_elements

   pure logical function same_section(a, b)
      type(elastic_t), intent(in) :: a, b

      same_section = a%young == b%young .and. a%poisson == b%poisson .and. a%thickness == b%thickness
   end function same_section

   !> Gives every pair of a node and a zone its place, zone by zone.
   pure subroutine number_places(fem, zone, patches)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: zone(:)
      type(patches_t), intent(inout) :: patches
      integer(ip), allocatable :: first(:), order(:), zone_at(:), place_at(:), node(:)
      integer(ip) :: i, k, e, at

      call sort_by_key(zone, first, order)
      allocate (zone_at(fem%mesh%n_nodes), place_at(fem%mesh%n_nodes), source=0_ip)
      allocate (patches%place(Q2_NODES, fem%mesh%n_elements), source=0_ip)
      allocate (node(size(fem%mesh%nodes)))
      do i = 1, fem%mesh%n_elements
         e = order(i)
         do k = 1, fem%mesh%shape(e)
            at = fem%mesh%nodes(k, e)
            if (zone_at(at) /= zone(e)) then
               zone_at(at) = zone(e)
               patches%n = patches%n + 1
               place_at(at) = patches%n
               node(patches%n) = at
            end if
            patches%place(k, e) = place_at(at)
         end do
      end do
      patches%node = node(:patches%n)
   end subroutine number_places

   !> Numbers 1, 2, ... in the order of their keys: those of key j are order(first(j):first(j+1)-1), rising.
   pure subroutine sort_by_key(key, first, order)
      integer(ip), intent(in) :: key(:)              !< positive
      integer(ip), allocatable, intent(out) :: first(:), order(:)
      integer(ip) :: i, n

      n = 0
      if (size(key) > 0) n = maxval(key)
      allocate (first(n + 1), order(size(key)))
      first = 0
      do i = 1, size(key, kind=ip)
         first(key(i)) = first(key(i)) + 1
      end do
      call counts_to_ends(first)
      do i = size(key, kind=ip), 1, -1
         first(key(i)) = first(key(i)) - 1
         order(first(key(i))) = i
      end do
   end subroutine sort_by_key

   !> From the lengths of the lists (the last entry is 0) to the places behind their ends; filling backwards makes these the starts.
   pure subroutine counts_to_ends(first)
      integer(ip), intent(inout) :: first(:)
      integer(ip) :: i

      first(1) = first(1) + 1
      do i = 2, size(first, kind=ip)
         first(i) = first(i - 1) + first(i)
      end do
   end subroutine counts_to_ends

   pure subroutine list_elements_at_corners(fem, patches)
      type(fem_t), intent(in) :: fem
      type(patches_t), intent(inout) :: patches
      integer(ip) :: e, k, i

      allocate (patches%first(patches%n + 1), source=0_ip)
      do e = 1, fem%mesh%n_elements
         do k = 1, CORNERS
            i = patches%place(k, e)
            patches%first(i) = patches%first(i) + 1
         end do
      end do
      call counts_to_ends(patches%first)
      allocate (patches%element(patches%first(patches%n + 1) - 1), patches%corner(patches%first(patches%n + 1) - 1))
      do e = fem%mesh%n_elements, 1, -1
         do k = CORNERS, 1, -1
            i = patches%place(k, e)
            patches%first(i) = patches%first(i) - 1
            patches%element(patches%first(i)) = e
            patches%corner(patches%first(i)) = k
         end do
      end do
   end subroutine list_elements_at_corners

   !> Interior nodes have patches. Elements that touch none (a zone one or two elements wide) get patches at their nodes that
   !> have a neighbour; those that still have none are alone.
   pure subroutine choose_patches(fem, patches)
      type(fem_t), intent(in) :: fem
      type(patches_t), intent(inout) :: patches
      integer(ip) :: i

      allocate (patches%kind(patches%n), source=PATCH_NONE)
      do i = 1, patches%n
         if (is_interior(patches, i)) patches%kind(i) = PATCH_INTERIOR
      end do
      call patch_the_bare(fem, 2_ip, PATCH_OUTER, patches)
      call patch_the_bare(fem, 1_ip, PATCH_SINGLE, patches)
   end subroutine choose_patches

   !> Gives a patch to the corners, of at least `least` elements, of all elements without a patch at any corner.
   pure subroutine patch_the_bare(fem, least, kind, patches)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: least, kind
      type(patches_t), intent(inout) :: patches
      logical :: bare(fem%mesh%n_elements)
      integer(ip) :: e, k, i

      do e = 1, fem%mesh%n_elements
         bare(e) = all(patches%kind(patches%place(:CORNERS, e)) == PATCH_NONE)
      end do
      do e = 1, fem%mesh%n_elements
         if (.not. bare(e)) cycle
         do k = 1, CORNERS
            i = patches%place(k, e)
            if (patches%first(i + 1) - patches%first(i) >= least) patches%kind(i) = kind
         end do
      end do
   end subroutine patch_the_bare

   !> Elements of the zone lie all round a corner node when each edge that leaves it has one of them on either side.
   pure logical function is_interior(patches, i)
      type(patches_t), intent(in) :: patches
      integer(ip), intent(in) :: i
      integer(ip) :: j, k, wanted

      is_interior = .false.
      if (patches%first(i + 1) - patches%first(i) < 3) return
      do j = patches%first(i), patches%first(i + 1) - 1
         wanted = patches%place(mod(patches%corner(j), CORNERS) + 1, patches%element(j))
         do k = patches%first(i), patches%first(i + 1) - 1
            if (patches%place(mod(patches%corner(k) + 2, CORNERS) + 1, patches%element(k)) == wanted) exit
         end do
         if (k == patches%first(i + 1)) return
      end do
      is_interior = .true.
   end function is_interior

end module atrito_patches
