!> The sides of a mesh, each once, and the elements round its corners.
module atrito_mesh_sides
   use atrito_element_table, only: CORNERS_OF, MOST_SIDES
   use atrito_faces, only: node_elements_t, list_node_elements, find_across
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t, face_end, middle_node, side_count
   implicit none (type, external)
   private
   public :: mesh_sides_t, list_sides, chain_t, find_chains, MOST_AROUND

   !> Elements round a node, at the most.
   integer(ip), parameter :: MOST_AROUND = 64

   !> Side i goes from node(1, i) to node(2, i), counter-clockwise round its first element.
   type :: mesh_sides_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: node(:, :)        !< (2, n)
      integer(ip), allocatable :: middle(:)         !< (n) node; 0: none
      integer(ip), allocatable :: element(:, :)     !< (2, n) second one 0: on the outline
      integer(ip), allocatable :: of_element(:, :)  !< (MOST_SIDES, n_elements); negative: the side's second element
      type(node_elements_t) :: around               !< elements round each node
   end type mesh_sides_t

   !> Elements that follow one another counter-clockwise round a node, each with its corner there, and the sides between them:
   !> side(0) lies before the first element, side(n) behind the last one, and they are one where the chain is closed.
   type :: chain_t
      integer(ip) :: n = 0
      logical :: is_closed = .false.
      integer(ip) :: element(MOST_AROUND) = 0, corner(MOST_AROUND) = 0
      integer(ip) :: side(0:MOST_AROUND) = 0        !< without their sign
   end type chain_t

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

   !> The elements round a node as chains: several where the outline goes through it more than once.
   subroutine find_chains(mesh, sides, node, chains, n)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      integer(ip), intent(in) :: node
      type(chain_t), intent(inout) :: chains(:)
      integer(ip), intent(out) :: n                 !< 0: the node is no corner; or more elements than a chain has room for
      integer(ip) :: element(MOST_AROUND), corner(MOST_AROUND), m, i, k
      logical :: is_taken(MOST_AROUND)

      n = 0
      m = 0
      do k = sides%around%first(node), sides%around%first(node + 1) - 1
         associate (e => sides%around%list(k))
            i = findloc(mesh%nodes(:side_count(mesh, e), e), node, dim=1, kind=ip)
            if (i == 0) cycle
            if (m == MOST_AROUND) return
            m = m + 1
            element(m) = e
            corner(m) = i
         end associate
      end do
      is_taken(:m) = .false.
      do k = 1, m                                   ! open chains first: those begin at the outline
         if (sides%element(2, abs(sides%of_element(corner(k), element(k)))) == 0) call follow(k)
      end do
      do k = 1, m
         if (.not. is_taken(k)) call follow(k)
      end do

   contains

      !> From an element counter-clockwise round the node: across the side that ends at the node.
      subroutine follow(start)
         integer(ip), intent(in) :: start
         integer(ip) :: at, side, next

         n = n + 1
         if (n > size(chains)) return
         associate (chain => chains(n))
            chain%n = 0
            at = start
            chain%side(0) = abs(sides%of_element(corner(at), element(at)))
            do
               is_taken(at) = .true.
               chain%n = chain%n + 1
               chain%element(chain%n) = element(at)
               chain%corner(chain%n) = corner(at)
               side = abs(sides%of_element(1 + mod(corner(at) + side_count(mesh, element(at)) - 2, side_count(mesh, element(at))), &
                                           element(at)))
               chain%side(chain%n) = side
               next = sum(sides%element(:, side)) - element(at)
               if (sides%element(2, side) == 0) next = 0
               chain%is_closed = side == chain%side(0)
               if (next == 0 .or. chain%is_closed) exit
               at = findloc(element(:m), next, dim=1, kind=ip)
            end do
         end associate
      end subroutine follow

   end subroutine find_chains

end module atrito_mesh_sides
