!> Where --observe looks: the nodes that an argument names, with their weights in a mean.
module atrito_observed_places
   use atrito_element, only: body_load
   use atrito_element_table, only: MOST_NODES
   use atrito_expression_names, only: argument_t, DIGITS
   use atrito_face_loads, only: traction_load
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: depth_places, face_nodes, find_node
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_body_names, only: name_bodies
   use atrito_element_places, only: find_nearest, find_places, place_t
   use atrito_messages, only: message_t
   use atrito_model, only: model_t, nodal_values_t, SURFACE_ELEMENTS
   use atrito_name_list, only: names_of
   use atrito_sets, only: find_named_nodes, find_set, members_of
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_strings, only: string_t, append_string, same_name, to_text
   implicit none (type, external)
   private
   public :: find_place, find_point, has_support, has_element, index_of_surface

   integer, parameter :: DIGITS_TOLD = 6              !< of coordinates in messages
   character(len=*), parameter :: A_PLACE = 'a node number, a node set, an element set or a surface of elements'

contains

   !> The nodes of a place. A name is looked for among surfaces, element sets and node sets, in this order. The weights are areas of
   !> faces, volumes of elements, or the same for each node of a node set.
   subroutine find_place(model, argument, nodes, weights, fault)
      type(model_t), intent(in) :: model                !< mesh, sets and surfaces are searched
      type(argument_t), intent(in) :: argument          !< a number or a name
      integer(ip), allocatable, intent(out) :: nodes(:) !< places
      real(wp), allocatable, intent(out) :: weights(:)  !< their sum is 1
      type(message_t), intent(out) :: fault          !< text not allocated: nothing is wrong; known: names that may be meant
      real(wp), allocatable :: of_node(:)
      logical, allocatable :: is_there(:)
      integer(ip) :: i, surface, elements

      call find_numbered(argument%text, nodes)
      if (.not. (allocated(nodes) .or. allocated(fault%text))) then
         surface = index_of_surface(model, argument%text)
         elements = find_set(model%element_sets, argument%text)
         allocate (of_node(model%mesh%n_nodes), source=0.0_wp)
         allocate (is_there(model%mesh%n_nodes), source=.false.)
         if (surface > 0) then
            call weigh_faces(of_node, is_there)
         else if (elements > 0) then
            call weigh_elements(model, members_of(model%element_sets%sets(elements)), of_node, is_there)
         else
            call weigh_nodes(model, argument%text, of_node, is_there, fault)
         end if
         nodes = pack([(i, i=1, model%mesh%n_nodes)], is_there)
         weights = of_node(nodes)/sum(of_node(nodes))
         if (size(nodes) == 0 .and. .not. allocated(fault%text)) fault%text = argument%text//' is empty'
      else if (allocated(nodes)) then
         weights = [1.0_wp]
      end if

   contains

      !> `12`, or `LEFT.12` of an instance. nodes is not allocated where it is no number.
      subroutine find_numbered(text, nodes)
         character(len=*), intent(in) :: text
         integer(ip), allocatable, intent(out) :: nodes(:)
         integer(ip) :: id, first, next
         integer :: dot, outcome

         dot = index(text, '.', back=.true.)
         if (dot == len(text) .or. verify(text(dot + 1:), DIGITS) > 0) return
         call read_integer(text(dot + 1:), id, outcome)
         first = 1
         next = huge(1_ip)
         if (dot > 0) then
            call find_instance(model, text(:dot - 1), first, next)
            if (first == 0) return
         end if
         if (outcome == NUMBER_OK .and. id < next - first + 1) then
            nodes = pack([find_node(model%mesh, first - 1 + id)], [find_node(model%mesh, first - 1 + id) > 0])
            if (size(nodes) == 1) return
            deallocate (nodes)
         end if
         fault%text = 'node '//text//' does not exist'
         fault%expected = A_PLACE//' ('//to_text(model%mesh%n_nodes)//' nodes, the greatest ' &
                          //to_text(maxval(model%mesh%node_id(:model%mesh%n_nodes)))//')'
      end subroutine find_numbered

      !> Each node by the integral of its shape function over the faces, the depth included.
      subroutine weigh_faces(of_node, is_there)
         real(wp), intent(inout) :: of_node(:)
         logical, intent(inout) :: is_there(:)
         integer(ip), allocatable :: nodes(:)
         real(wp) :: f(2, 3)
         integer(ip) :: i, e

         if (model%surfaces(surface)%kind /= SURFACE_ELEMENTS) then
            fault%text = model%surfaces(surface)%name//' is a rigid surface and has no nodes'
            fault%expected = A_PLACE
            return
         end if
         associate (faces => model%surfaces(surface)%faces, mesh => model%mesh)
            do i = 1, faces%n
               e = faces%element(i)
               nodes = face_nodes(mesh, e, faces%face(i))
               call traction_load(mesh%x(:, nodes), [1.0_wp, 0.0_wp], model%sections(model%section_of(e))%thickness, &
                                  mesh%state(e), f(:, :size(nodes)), depth_places(mesh, mesh%state(e), nodes))
               of_node(nodes) = of_node(nodes) + f(1, :size(nodes))
               is_there(nodes) = .true.
            end do
         end associate
      end subroutine weigh_faces
   end subroutine find_place

   !> The nodes of the element that holds a point, and its shape functions there.
   subroutine find_point(model, x, body, nodes, weights, fault)
      type(model_t), intent(in) :: model             !< mesh, sets and instances are searched
      real(wp), intent(in) :: x(2)                   !< [L]
      character(len=*), intent(in) :: body           !< an element set or an instance that it is in; '': any
      integer(ip), allocatable, intent(out) :: nodes(:) !< places
      real(wp), allocatable, intent(out) :: weights(:)  !< their sum is 1
      type(message_t), intent(inout) :: fault        !< text not allocated: nothing is wrong
      logical :: wanted(model%mesh%n_elements)
      type(place_t), allocatable :: places(:)
      character(len=:), allocatable :: text
      integer(ip) :: i, near
      real(wp) :: distance

      call choose_elements(body)
      if (allocated(fault%text)) return
      call find_places(model%mesh, wanted, reshape(x, [2, 1]), places)
      text = '('//to_text(x(1), DIGITS_TOLD)//', '//to_text(x(2), DIGITS_TOLD)//')'
      if (size(places) == 0) then
         call find_nearest(model%mesh, wanted, x, near, distance)
         fault%text = text//' is outside of all bodies'
         if (len(body) > 0) fault%text = text//' is outside of '//body
         if (near > 0) fault%text = fault%text//', '//to_text(distance, 3)//' from '//body_name(near)
         fault%expected = 'a place x, y in a body [L]'
      else if (size(places) > 1) then
         fault%text = text//' is in '//body_name(places(1)%element)
         do i = 2, size(places, kind=ip)
            fault%text = fault%text//' and in '//body_name(places(i)%element)
         end do
         fault%expected = 'x, y and the element set or instance that is meant'
      else
         associate (e => places(1)%element, n => model%mesh%shape(places(1)%element))
            nodes = model%mesh%nodes(:n, e)
            weights = places(1)%value(:n)
         end associate
      end if

   contains

      !> The elements of an element set or an instance.
      subroutine choose_elements(name)
         character(len=*), intent(in) :: name           !< '': all
         integer(ip) :: set, first, next

         wanted = len(name) == 0
         if (len(name) == 0) return
         set = find_set(model%element_sets, name)
         if (set > 0) then
            wanted(members_of(model%element_sets%sets(set))) = .true.
            return
         end if
         call find_instance(model, name, first, next)
         if (first > 0) then
            wanted = model%mesh%element_id(:model%mesh%n_elements) >= first .and. &
                     model%mesh%element_id(:model%mesh%n_elements) < next
            return
         end if
         fault%text = 'the deck has no element set or instance '//name
         fault%expected = 'the name of one that holds the place'
         fault%known = names_of(model%element_sets%names)
      end subroutine choose_elements

      function body_name(element) result(name)
         integer(ip), intent(in) :: element
         character(len=:), allocatable :: name
         type(bodies_t) :: bodies

         call find_bodies(model%mesh, bodies)
         call name_bodies(model, bodies)
         name = bodies%list(bodies%of_element(element))%name
      end function body_name
   end subroutine find_point

   !> The numbers of an instance: from first on, before next. first is 0 where there is no such instance.
   pure subroutine find_instance(model, name, first, next)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: name
      integer(ip), intent(out) :: first, next
      integer(ip) :: i

      first = 0
      next = huge(1_ip)
      if (.not. allocated(model%instances)) return
      do i = 1, size(model%instances, kind=ip)
         if (same_name(model%instances(i)%name, name)) first = model%instances(i)%first_number
      end do
      if (first > 0) next = minval([huge(1_ip), model%instances%first_number], [.true., model%instances%first_number > first])
   end subroutine find_instance

   !> The place of a surface among those of the model; 0: there is none of the name.
   pure integer(ip) function index_of_surface(model, name) result(i)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: name

      do i = 1, size(model%surfaces, kind=ip)
         if (same_name(model%surfaces(i)%name, name)) return
      end do
      i = 0
   end function index_of_surface

   !> The same over elements.
   subroutine weigh_elements(model, elements, of_node, is_there)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(inout) :: of_node(:)
      logical, intent(inout) :: is_there(:)
      real(wp) :: f(2, MOST_NODES)
      integer(ip) :: i, e, n

      do i = 1, size(elements, kind=ip)
         e = elements(i)
         n = model%mesh%shape(e)
         associate (nodes => model%mesh%nodes(:n, e), state => model%mesh%state(e))
            call body_load(model%mesh%x(:, nodes), [1.0_wp, 0.0_wp], model%sections(model%section_of(e))%thickness, state, &
                           f(:, :n), places=depth_places(model%mesh, state, nodes))
            of_node(nodes) = of_node(nodes) + f(1, :n)
            is_there(nodes) = .true.
         end associate
      end do
   end subroutine weigh_elements

   !> Those of a node set, each the same.
   subroutine weigh_nodes(model, name, of_node, is_there, fault)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: name
      real(wp), intent(inout) :: of_node(:)
      logical, intent(inout) :: is_there(:)
      type(message_t), intent(inout) :: fault
      character(len=:), allocatable :: lacks
      integer(ip), allocatable :: nodes(:)
      logical :: found
      type(string_t), allocatable :: others(:)
      integer :: i, k

      call find_named_nodes(model%mesh, model%node_sets, model%element_sets, name, nodes, found, lacks)
      if (allocated(lacks)) then
         fault%text = lacks
         fault%expected = A_PLACE
         return
      else if (.not. found) then
         fault%text = 'the deck has no set or surface '//name
         fault%expected = A_PLACE
         ! The names that a place may have, each once.
         fault%known = names_of(model%node_sets%names)
         others = names_of(model%element_sets%names)
         do i = 1, size(model%surfaces)
            call append_string(others, model%surfaces(i)%name)
         end do
         do i = 1, size(others)
            do k = 1, size(fault%known)
               if (same_name(fault%known(k)%s, others(i)%s)) exit
            end do
            if (k > size(fault%known)) call append_string(fault%known, others(i)%s)
         end do
         return
      end if
      is_there(nodes) = .true.
      where (is_there) of_node = 1.0_wp
   end subroutine weigh_nodes

   !> Whether any of some nodes has a prescribed displacement in any step: else there is no reaction to be told.
   pure logical function has_support(model, nodes)
      type(model_t), intent(in) :: model             !< supports of its steps are read
      integer(ip), intent(in) :: nodes(:)            !< places in the mesh
      logical :: is_one(model%mesh%n_nodes)
      integer(ip) :: i

      is_one = .false.
      is_one(nodes) = .true.
      has_support = .false.
      do i = 1, size(model%steps, kind=ip)
         has_support = has_support .or. any_of(model%steps(i)%prescribed) .or. any_of(model%steps(i)%rigid_prescribed)
      end do
      has_support = has_support .or. any_of(model%inclined)

   contains

      pure logical function any_of(values)
         type(nodal_values_t), intent(in) :: values

         any_of = .false.
         if (values%n > 0) any_of = any(is_one(values%node(:values%n)))
      end function any_of

   end function has_support

   !> Whether each of some nodes belongs to an element: others have no stress.
   pure logical function has_element(model, nodes)
      type(model_t), intent(in) :: model             !< its mesh is read
      integer(ip), intent(in) :: nodes(:)            !< places in the mesh
      logical :: is_held(0:model%mesh%n_nodes)
      integer(ip) :: e

      is_held = .false.
      do e = 1, model%mesh%n_elements
         is_held(model%mesh%nodes(:, e)) = .true.
      end do
      has_element = all(is_held(nodes))
   end function has_element

end module atrito_observed_places
