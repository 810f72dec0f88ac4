!> Elements that are equal, so that what depends on the shape alone is made once for them.
!>
!> An element is compared with the last few different ones, which finds the neighbours in a regular mesh; what is not found is a
!> class of its own.
module atrito_element_classes
   use atrito_assembly, only: fem_t, form_t, has_form, take_form
   use atrito_faces, only: list_node_elements, node_elements_t
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   implicit none (type, external)
   private
   public :: element_classes_t, find_classes, given_of

   type :: element_classes_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: of_element(:)     !< (n_elements)
      integer(ip), allocatable :: first(:)          !< (n + 1)
      integer(ip), allocatable :: member(:)         !< elements of class i: first(i) .. first(i + 1) - 1
   end type element_classes_t

   integer(ip), parameter :: COMPARED = 8           !< different elements that one is compared with

contains

   !> The classes of all elements; triangles turned by 180 degrees are others, since their sides are.
   subroutine find_classes(fem, classes)
      type(fem_t), intent(in) :: fem
      type(element_classes_t), intent(out) :: classes
      type(form_t) :: recent(COMPARED)
      integer(ip) :: number(COMPARED), e, k, next, latest

      allocate (classes%of_element(fem%mesh%n_elements))
      next = 0
      latest = 1
      do e = 1, fem%mesh%n_elements
         k = latest
         if (.not. is_like(k)) then
            do k = 1, COMPARED
               if (is_like(k)) exit
            end do
         end if
         if (k > COMPARED) then
            next = 1 + mod(next, COMPARED)
            k = next
            classes%n = classes%n + 1
            number(k) = classes%n
            call take_form(fem, e, recent(k))
         end if
         latest = k
         classes%of_element(e) = number(k)
      end do
      if (2*classes%n > fem%mesh%n_elements) call follow_nodes(fem%mesh, classes)
      call list_holders(classes%n, reshape(classes%of_element, [1_ip, size(classes%of_element, kind=ip)]), classes%first, &
                        classes%member)

   contains

      logical function is_like(k)
         integer(ip), intent(in) :: k

         is_like = .false.
         if (recent(k)%shape > 0) is_like = has_form(fem, e, recent(k), 0.0_wp, may_turn=.false.)
      end function is_like

   end subroutine find_classes

   !> Numbers classes as the nodes meet them one after the other, so that what is kept for the elements round a node lies together;
   !> the elements of a mesh of triangles may come in any order.
   subroutine follow_nodes(mesh, classes)
      type(mesh_t), intent(in) :: mesh
      type(element_classes_t), intent(inout) :: classes
      type(node_elements_t) :: around
      integer(ip) :: number(classes%n), k, n

      around = list_node_elements(mesh)
      number = 0
      n = 0
      do k = 1, size(around%list, kind=ip)
         associate (class => classes%of_element(around%list(k)))
            if (number(class) > 0) cycle
            n = n + 1
            number(class) = n
         end associate
      end do
      classes%of_element = number(classes%of_element)
   end subroutine follow_nodes

   !> What is given of an element: displacements of its nodes less those of the first one and those of its own strain, then
   !> temperatures where there are any.
   pure subroutine given_of(fem, e, u, x, n)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(inout) :: x(:)
      integer(ip), intent(out) :: n                 !< how many
      integer(ip) :: k

      associate (nodes => fem%mesh%nodes(:fem%mesh%shape(e), e))
         n = 2*size(nodes, kind=ip)
         do k = 1, size(nodes, kind=ip)
            x(2*k - 1:2*k) = u(:, nodes(k)) - u(:, nodes(1))
         end do
         if (allocated(fem%own_strain)) then        ! the displacements that it has are linear in the place
            do k = 1, size(nodes, kind=ip)
               associate (at => fem%mesh%x(:, nodes(k)) - fem%mesh%x(:, nodes(1)), strain => fem%own_strain(:, e))
                  x(2*k - 1:2*k) = x(2*k - 1:2*k) - [strain(1)*at(1) + 0.5_wp*strain(3)*at(2), &
                                                     0.5_wp*strain(3)*at(1) + strain(2)*at(2)]
               end associate
            end do
         end if
         if (.not. allocated(fem%heating)) return
         do k = 1, size(nodes, kind=ip)
            x(n + k) = fem%heating(nodes(k))
         end do
         n = n + size(nodes, kind=ip)
      end associate
   end subroutine given_of

end module atrito_element_classes
