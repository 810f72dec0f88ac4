!> How a scene is cut into parts (atrito_scene_part), given which element is in which part; atrito_part_maker makes them.
!>
!> A contact point belongs to the part of its slave node, a bilateral row to that of its first node. The other nodes and the motions
!> of the bodies come with it, so a node belongs to the parts of its elements and of the points that see it, and the motions of a
!> body to the parts of the points that see it. What belongs to several parts is shared: all of its unknowns are kept by all of
!> them, and numbered in the order of the scene's unknowns in the system that holds the parts together.
!>
!> The pulls of a body are in the first part that sees it; without a point, in that of its first element. Springs that hold u_e are
!> in the part of the first element at their node. What a rigid body moves is no unknown but its motions: they are like others.
module atrito_scene_cut
   use atrito_assembly, only: fem_t, collect_elements
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: element_store_t, sum_couplings, sum_diagonals
   use atrito_scene_elimination, only: scene_numbering_t
   implicit none (type, external)
   private
   public :: place_t, scene_cut_t, plan_cut, unknowns_at, diagonals_of_rows

   !> What belongs to which part. Nodes and motions: those of body b are the last but bodies%n - b.
   type :: scene_cut_t
      integer(ip) :: n_parts = 0                     !< not one of them empty
      integer(ip) :: n_shared = 0                    !< unknowns that are shared
      integer(ip), allocatable :: first_element(:), element(:) !< of part p: element(first_element(p):first_element(p + 1) - 1)
      integer(ip), allocatable :: first_point(:), point(:)     !< the same of points with a row
      logical, allocatable :: is_shared(:)           !< (nodes and motions)
      integer(ip), allocatable :: pull_part(:)       !< (bodies) 0: it has no motions
      integer(ip), allocatable :: spring_part(:)     !< (k) 0: none
      real(wp), allocatable :: spring_stiffness(:)   !< (k) [F/L]
      integer(ip), allocatable :: shared_number(:)   !< (n) number of an unknown among those that are shared; 0: it is not
      integer(ip), allocatable :: place(:)           !< (nodes and motions) for whoever makes the parts: 0
      integer(ip), allocatable :: unknown_at(:)      !< (n) the same
   end type scene_cut_t

   !> What a part has of the scene, in its own order.
   type :: place_t
      integer(ip) :: rank = 0                    !< who has the part
      integer(ip) :: n_elements = 0              !< of the part
      integer(ip), allocatable :: unknown(:)     !< those that other parts have, too, last
      integer(ip), allocatable :: shared(:)      !< number of each of these among all that are shared
      integer(ip), allocatable :: row(:), pull(:) !< contact rows of the scene; amplitudes of its pulls
      real(wp) :: solving = 0.0_wp               !< what factoring it will take, where it is [bytes]
   end type place_t

contains

   !> Finds what belongs to which part, and what is shared.
   subroutine plan_cut(fem, rows, line, numbering, diagonal, part_of_element, n_parts, cut)
      type(fem_t), intent(in) :: fem                 !< bodies and mesh of the scene
      type(contact_rows_t), intent(in) :: rows       !< nodes of each contact point
      type(contact_line_t), intent(in) :: line       !< which points have rows
      type(scene_numbering_t), intent(in) :: numbering !< of the scene's unknowns
      real(wp), intent(in) :: diagonal(:)            !< (n) of the stiffness, at the springs at least (diagonals_of_rows)
      integer(ip), intent(in) :: part_of_element(:)  !< (n_elements) 1..n_parts
      integer(ip), intent(in) :: n_parts             !< >= 1
      type(scene_cut_t), intent(out) :: cut          !< whole, as described above
      integer(ip) :: home(fem%mesh%n_nodes), part(1, line%n), node(numbering%k), b, e, i

      cut%n_parts = n_parts
      home = 0
      do e = fem%mesh%n_elements, 1, -1              ! the first element at a node is the last to tell
         home(fem%mesh%nodes(:fem%mesh%shape(e), e)) = part_of_element(e)
      end do
      call list_holders(n_parts, reshape(part_of_element, [1_ip, fem%mesh%n_elements]), cut%first_element, cut%element)
      part = 0
      do i = 1, line%n
         if (line%normal(i) > 0 .or. line%tangential(i) > 0) part(1, i) = part_of_point(rows, i, home)
      end do
      call list_holders(n_parts, part, cut%first_point, cut%point)
      call find_shared(fem, rows, numbering, cut)
      ! Bodies that no point sees.
      do b = 1, fem%bodies%n
         if (numbering%n_motions(b) == 0 .or. cut%pull_part(b) > 0) cycle
         cut%pull_part(b) = 1
         if (.not. fem%bodies%list(b)%is_rigid) cut%pull_part(b) = part_of_element(fem%bodies%list(b)%elements(1))
      end do
      allocate (cut%spring_part(numbering%k), source=0_ip)
      allocate (cut%spring_stiffness(numbering%k), source=0.0_wp)
      node = spring_nodes(fem, numbering)
      do i = 1, numbering%k
         if (node(i) > 0) cut%spring_part(i) = home(node(i))
         if (numbering%spring(i) > 0) cut%spring_stiffness(i) = diagonal(numbering%spring(i))
      end do
      call number_shared(cut)
      allocate (cut%place(fem%mesh%n_nodes + fem%bodies%n), cut%unknown_at(numbering%n), source=0_ip)

   contains

      !> Numbers the unknowns that are shared, in the order of all.
      pure subroutine number_shared(cut)
         type(scene_cut_t), intent(inout) :: cut
         integer(ip) :: i

         allocate (cut%shared_number(numbering%n), source=0_ip)
         do i = 1, fem%mesh%n_nodes + fem%bodies%n
            if (cut%is_shared(i)) cut%shared_number(unknowns_at(fem, numbering, i)) = 1
         end do
         do i = 1, numbering%n
            if (cut%shared_number(i) == 0) cycle
            cut%n_shared = cut%n_shared + 1
            cut%shared_number(i) = cut%n_shared
         end do
      end subroutine number_shared

   end subroutine plan_cut

   !> The part of the first slave node with elements, else of any node; 1 where rigid bodies meet alone.
   pure integer(ip) function part_of_point(rows, j, home) result(part)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: j, home(:)
      integer(ip) :: k

      part = 0
      do k = rows%first(j), rows%first(j + 1) - 1
         if (part == 0) part = home(rows%node(k))
         if (rows%coefficient(k) > 0.0_wp .and. home(rows%node(k)) > 0) exit
      end do
      if (k < rows%first(j + 1)) part = home(rows%node(k))
      part = max(part, 1_ip)
   end function part_of_point

   !> Goes through the parts: a node or motion that had another one before is shared.
   subroutine find_shared(fem, rows, numbering, cut)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(scene_numbering_t), intent(in) :: numbering
      type(scene_cut_t), intent(inout) :: cut
      integer(ip) :: last(fem%mesh%n_nodes + fem%bodies%n), p, i, k, b

      last = 0
      allocate (cut%is_shared(size(last)), source=.false.)
      allocate (cut%pull_part(fem%bodies%n), source=0_ip)
      do p = 1, cut%n_parts
         do i = cut%first_element(p), cut%first_element(p + 1) - 1
            do k = 1, fem%mesh%shape(cut%element(i))
               call touch(fem%mesh%nodes(k, cut%element(i)))
            end do
         end do
         do i = cut%first_point(p), cut%first_point(p + 1) - 1
            do k = rows%first(cut%point(i)), rows%first(cut%point(i) + 1) - 1
               call touch(rows%node(k))
               b = fem%bodies%of_node(rows%node(k))
               if (numbering%n_motions(b) == 0) cycle
               call touch(fem%mesh%n_nodes + b)
               if (cut%pull_part(b) == 0) cut%pull_part(b) = p
            end do
         end do
      end do

   contains

      subroutine touch(item)
         integer(ip), intent(in) :: item

         cut%is_shared(item) = cut%is_shared(item) .or. (last(item) > 0 .and. last(item) /= p)
         last(item) = p
      end subroutine touch

   end subroutine find_shared

   !> The node of each spring; 0 where there is none.
   pure function spring_nodes(fem, numbering) result(node)
      type(fem_t), intent(in) :: fem
      type(scene_numbering_t), intent(in) :: numbering
      integer(ip) :: node(numbering%k)
      integer(ip) :: b, i, s

      node = 0
      do b = 1, fem%bodies%n
         if (fem%bodies%list(b)%is_rigid) cycle
         do s = numbering%first_pull(b), numbering%first_pull(b) + numbering%n_motions(b) - 1
            do i = 1, size(fem%bodies%list(b)%nodes, kind=ip)
               associate (here => fem%bodies%list(b)%nodes(i))
                  if (any(fem%bodies%equation(:, here) == numbering%spring(s) - numbering%before(b))) node(s) = here
               end associate
            end do
         end do
      end do
   end function spring_nodes

   !> The unknowns of a node, or of the motions of a body.
   pure function unknowns_at(fem, numbering, i) result(unknowns)
      type(fem_t), intent(in) :: fem                   !< bodies of the scene
      type(scene_numbering_t), intent(in) :: numbering !< of the scene's unknowns
      integer(ip), intent(in) :: i                     !< node, or n_nodes + body
      integer(ip), allocatable :: unknowns(:)
      integer(ip) :: b, k

      if (i > fem%mesh%n_nodes) then
         b = i - fem%mesh%n_nodes
         unknowns = [(numbering%first_motion(b) + k - 1, k=1, numbering%n_motions(b))]
      else
         unknowns = pack(fem%bodies%equation(:, i), fem%bodies%equation(:, i) > 0)
         if (size(unknowns) > 0) unknowns = unknowns + numbering%before(fem%bodies%of_node(i))
      end if
   end function unknowns_at

   !> The diagonal of the stiffness, and what the two displacements of a node have in common (sum_diagonals), at the nodes of the
   !> rows and at the springs: elsewhere they are of no use. The elements there are all that is computed.
   subroutine diagonals_of_rows(fem, rows, numbering, diagonal, coupling)
      type(fem_t), intent(in) :: fem                    !< whole scene; elements at the rows are computed
      type(contact_rows_t), intent(in) :: rows          !< nodes of each contact point
      type(scene_numbering_t), intent(in) :: numbering  !< of the scene's unknowns
      real(wp), intent(out) :: diagonal(:), coupling(:) !< (n) [F/L]
      type(element_store_t) :: store
      logical :: wanted(fem%mesh%n_nodes)
      integer(ip), allocatable :: elements(:)
      integer(ip) :: at(numbering%k), e
      integer(lp) :: k

      wanted = .false.
      wanted(rows%node) = .true.
      at = spring_nodes(fem, numbering)
      wanted(pack(at, at > 0)) = .true.
      elements = pack([(e, e=1, fem%mesh%n_elements)], [(any(wanted(fem%mesh%nodes(:fem%mesh%shape(e), e))), &
                                                         e=1, fem%mesh%n_elements)])
      call collect_elements(fem, elements, store, fem%digit_error)
      do e = 1, store%n
         do k = store%start(e) + 1, store%start(e + 1)
            if (store%equations(k) > 0) store%equations(k) = store%equations(k) &
                                                             + numbering%before(fem%bodies%of_element(elements(e)))
         end do
      end do
      call sum_diagonals(store, store%n, diagonal)
      call sum_couplings(store, store%n, coupling)
   end subroutine diagonals_of_rows

end module atrito_scene_cut
