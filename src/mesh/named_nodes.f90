!> The nodes that a name means: those of a node set, of the elements of an element set, or that in a corner or a middle of a block.
!>
!> A corner or a middle has no set of its own, since few of them are asked for: it is found by the node sets of the four sides,
!> <block>-BOTTOM, -RIGHT, -TOP and -LEFT.
module atrito_named_nodes
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_sets, only: numbers_among, set_list_t, find_set, members_of
   use atrito_sorting, only: each_once
   use atrito_strings, only: ends_with, to_text, upper_case
   implicit none (type, external)
   private
   public :: find_named_nodes, nodes_of_elements, part_place_name, BLOCK_SIDES

   !> Ends of the names that a *BLOCK gives to its sides, in the order of the faces S1..S4; the corners at which they begin, their
   !> middles, and the centre.
   character(len=7), parameter :: BLOCK_SIDES(4) = ['-BOTTOM', '-RIGHT ', '-TOP   ', '-LEFT  ']
   character(len=14), parameter :: PLACES(9) = [character(len=14) :: '-BOTTOM-LEFT', '-BOTTOM-RIGHT', '-TOP-RIGHT', '-TOP-LEFT', &
                                                        '-BOTTOM-MIDDLE', '-RIGHT-MIDDLE', '-TOP-MIDDLE', '-LEFT-MIDDLE', '-CENTRE']
   integer(ip), parameter :: CENTRE = 9

   !> A node stands in a place if it is not farther from it than this part of the block's side.
   real(wp), parameter :: SAME_PLACE = 1.0e-6_wp

contains

   !> Of a name of both a node set and an element set the nodes are those of the node set.
   pure subroutine find_named_nodes(mesh, node_sets, element_sets, name, nodes, found, fault)
      type(mesh_t), intent(in) :: mesh                        !< places of nodes, and nodes of elements
      type(set_list_t), intent(in) :: node_sets, element_sets !< of the scene as far as it is read
      character(len=*), intent(in) :: name                    !< as the user wrote it, without case
      integer(ip), allocatable, intent(out) :: nodes(:)       !< places
      logical, intent(out) :: found                           !< the name means some nodes
      character(len=:), allocatable, intent(out) :: fault     !< allocated: what a corner or middle that is named lacks
      integer(ip) :: i

      i = find_set(node_sets, name)
      found = i > 0
      if (found) then
         nodes = members_of(node_sets%sets(i))
         return
      end if
      i = find_set(element_sets, name)
      found = i > 0
      if (found) then
         nodes = nodes_of_elements(mesh, members_of(element_sets%sets(i)))
      else
         call find_place_of_block(mesh, node_sets, name, nodes, fault)
         found = size(nodes) > 0
      end if
   end subroutine find_named_nodes

   !> All nodes of some elements, rising.
   pure function nodes_of_elements(mesh, elements) result(nodes)
      type(mesh_t), intent(in) :: mesh                       !< nodes of the elements are read
      integer(ip), intent(in) :: elements(:)                 !< places
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i, n

      allocate (nodes(sum(mesh%shape(elements))))
      n = 0
      do i = 1, size(elements, kind=ip)
         associate (of_element => mesh%nodes(:mesh%shape(elements(i)), elements(i)))
            nodes(n + 1:n + size(of_element)) = of_element
            n = n + size(of_element, kind=ip)
         end associate
      end do
      nodes = each_once(nodes)
   end function nodes_of_elements

   !> The node of <block>-TOP-RIGHT, -TOP-MIDDLE, -CENTRE and their like; none: the name is none of these, or none or several nodes
   !> stand there.
   pure subroutine find_place_of_block(mesh, sets, name, nodes, fault)
      type(mesh_t), intent(in) :: mesh
      type(set_list_t), intent(in) :: sets                   !< of nodes
      character(len=*), intent(in) :: name
      integer(ip), allocatable, intent(out) :: nodes(:)
      character(len=:), allocatable, intent(out) :: fault
      character(len=:), allocatable :: block
      real(wp) :: x(2, CENTRE)                               ! of the places [L]
      integer(ip) :: side(4), wanted, place, k

      nodes = [integer(ip) ::]
      call part_place_name(name, block, wanted)
      if (wanted == 0) return
      side = [(find_set(sets, block//trim(BLOCK_SIDES(k))), k=1, 4)]
      if (any(side == 0)) return                             ! it is no block
      do place = 1, wanted
         if (place > 4 .and. place < wanted .and. wanted < CENTRE) cycle
         k = mod(place - 1, 4_ip) + 1
         if (place <= 4) then
            nodes = numbers_among(sets%sets(side(k))%members, each_once(members_of(sets%sets(side(mod(k + 2, 4_ip) + 1)))))
         else if (place < CENTRE) then
            nodes = members_of(sets%sets(side(k)))
            nodes = pack(nodes, is_halfway(mesh%x(:, nodes), x(:, k), x(:, mod(k, 4_ip) + 1)))
         else                                                ! as the map of a block has it (atrito_block_map)
            nodes = members_of(sets%sets(find_set(sets, block)))
            x(:, CENTRE) = 0.5_wp*sum(x(:, 5:8), dim=2) - 0.25_wp*sum(x(:, :4), dim=2)
            nodes = pack(nodes, norm2(mesh%x(:, nodes) - spread(x(:, CENTRE), 2, size(nodes)), dim=1) <= &
                         SAME_PLACE*norm2(x(:, 3) - x(:, 1)))
         end if
         if (size(nodes) /= 1) exit
         x(:, place) = mesh%x(:, nodes(1))
      end do
      if (size(nodes) == 1) return
      fault = 'no node stands in '//name
      if (size(nodes) > 1) fault = to_text(size(nodes, kind=ip))//' nodes stand in '//name
      nodes = [integer(ip) ::]
   end subroutine find_place_of_block

   !> The block whose corner, middle or centre a name may be, and which of them.
   pure subroutine part_place_name(name, block, place)
      character(len=*), intent(in) :: name                   !< as the user wrote it
      character(len=:), allocatable, intent(out) :: block    !< name of the block; '' where there is none
      integer(ip), intent(out) :: place                      !< in PLACES; 0: none

      block = ''
      do place = CENTRE, 1, -1
         if (ends_with(upper_case(name), trim(PLACES(place)))) exit
      end do
      if (place > 0) block = name(:len(name) - len_trim(PLACES(place)))
   end subroutine part_place_name

   !> Points as far from one place as from another: of a straight side or an arc its middle.
   pure function is_halfway(points, a, b) result(halfway)
      real(wp), intent(in) :: points(:, :), a(2), b(2)       !< [L]
      logical :: halfway(size(points, 2))
      real(wp), dimension(size(points, 2)) :: to_a, to_b

      to_a = norm2(points - spread(a, 2, size(points, 2)), dim=1)
      to_b = norm2(points - spread(b, 2, size(points, 2)), dim=1)
      halfway = abs(to_a - to_b) <= SAME_PLACE*(to_a + to_b)
   end function is_halfway

end module atrito_named_nodes
