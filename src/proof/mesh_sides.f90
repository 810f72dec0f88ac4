!> The sides of a mesh, each once, and the elements round its corners.
module atrito_mesh_sides
   use atrito_element_table, only: CORNERS_OF, MOST_SIDES
   use atrito_faces, only: node_elements_t, list_node_elements, find_across
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t, face_end, middle_node, side_count
   implicit none (type, external)
   private
   public :: mesh_sides_t, list_sides, chains_t, list_chains

   !> Side i goes from node(1, i) to node(2, i), counter-clockwise round its first element.
   type :: mesh_sides_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: node(:, :)        !< (2, n)
      integer(ip), allocatable :: middle(:)         !< (n) node; 0: none
      integer(ip), allocatable :: element(:, :)     !< (2, n) second one 0: on the outline
      integer(ip), allocatable :: of_element(:, :)  !< (MOST_SIDES, n_elements); negative: the side's second element
      type(node_elements_t) :: around               !< elements round each node
   end type mesh_sides_t

   !> Chains of elements that follow one another counter-clockwise round a node, each with its corner there, and the sides between
   !> them: of a chain with m elements m + 1 sides, side 0 before the first element and side m behind the last; these two are one
   !> where the chain is closed. A node has several chains where the outline goes through it more than once.
   type :: chains_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: node(:)           !< (n)
      integer(ip), allocatable :: first(:)          !< (n + 1) elements of chain i: first(i) .. first(i + 1) - 1
      integer(ip), allocatable :: element(:), corner(:)
      integer(ip), allocatable :: side(:)           !< those of chain i begin at first(i) + i - 1
   end type chains_t

contains

   !> Lists the sides of all elements.
   subroutine list_sides(mesh, sides)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(out) :: sides
      integer(ip) :: e, face, other, other_face, most

      sides%around = list_node_elements(mesh)
      most = sum(CORNERS_OF(mesh%shape(:mesh%n_elements)))
      allocate (sides%node(2, most), sides%middle(most), sides%element(2, most))
      allocate (sides%of_element(MOST_SIDES, mesh%n_elements), source=0_ip)
      do e = 1, mesh%n_elements
         do face = 1, side_count(mesh, e)
            if (sides%of_element(face, e) /= 0) cycle
            call find_across(mesh, sides%around, e, face, other, other_face)
            sides%n = sides%n + 1
            sides%node(:, sides%n) = mesh%nodes([face, face_end(mesh, e, face)], e)
            sides%middle(sides%n) = middle_node(mesh, e, face)
            sides%element(:, sides%n) = [e, other]
            sides%of_element(face, e) = sides%n
            if (other > 0) sides%of_element(other_face, other) = -sides%n
         end do
      end do
   end subroutine list_sides

   !> The chains round all corners, in the order of the nodes.
   subroutine list_chains(mesh, sides, chains)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      type(chains_t), intent(out) :: chains
      integer(ip) :: node, n_elements, n_sides, most

      most = sum(CORNERS_OF(mesh%shape(:mesh%n_elements)))
      allocate (chains%element(most), chains%corner(most), chains%side(2*most), chains%node(most), chains%first(most + 1))
      n_elements = 0
      n_sides = 0
      do node = 1, mesh%n_nodes
         call list_round(node)
      end do
      chains%first(chains%n + 1) = n_elements + 1

   contains

      !> The chains round one node: open ones first, which begin at the outline.
      subroutine list_round(node)
         integer(ip), intent(in) :: node
         integer(ip) :: k, e, i, before, pass

         before = n_elements
         do pass = 1, 2
            do k = sides%around%first(node), sides%around%first(node + 1) - 1
               e = sides%around%list(k)
               do i = 1, side_count(mesh, e)
                  if (mesh%nodes(i, e) == node) exit
               end do
               if (i > side_count(mesh, e)) return  ! no corner
               if (pass == 1) then
                  if (sides%element(2, abs(sides%of_element(i, e))) /= 0) cycle
               else if (any(chains%element(before + 1:n_elements) == e)) then
                  cycle
               end if
               call follow(node, e, i)
            end do
         end do
      end subroutine list_round

      !> From an element counter-clockwise round the node: across the side that ends there.
      subroutine follow(node, e_first, corner_first)
         integer(ip), intent(in) :: node, e_first, corner_first
         integer(ip) :: e, corner, side, begins_with

         chains%n = chains%n + 1
         chains%node(chains%n) = node
         chains%first(chains%n) = n_elements + 1
         e = e_first
         corner = corner_first
         begins_with = abs(sides%of_element(corner, e))
         call add_side(begins_with)
         do
            n_elements = n_elements + 1
            chains%element(n_elements) = e
            chains%corner(n_elements) = corner
            side = abs(sides%of_element(merge(side_count(mesh, e), corner - 1_ip, corner == 1), e))
            call add_side(side)
            if (sides%element(2, side) == 0 .or. side == begins_with) exit
            e = merge(sides%element(2, side), sides%element(1, side), sides%element(1, side) == e)
            corner = 1
            do while (mesh%nodes(corner, e) /= node)
               corner = corner + 1
            end do
         end do
      end subroutine follow

      subroutine add_side(side)
         integer(ip), intent(in) :: side

         n_sides = n_sides + 1
         chains%side(n_sides) = side
      end subroutine add_side

   end subroutine list_chains

end module atrito_mesh_sides
