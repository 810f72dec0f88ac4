!> The bodies of a scene glued together along their contact pairs: one set of equations, no contact.
!>
!> Slave and master nodes that face each other share their displacements, whatever the gap between them. A rigid master holds the
!> slave's nodes along the normal, at zero. Where that normal is no axis the node has a frame of its own: its first dof is then
!> along the normal and held, its second along the tangent.
module glued_bodies
   use atrito_assembly, only: fem_t, stiffness_cache_t, cached_stiffness
   use atrito_bodies, only: bodies_t, find_bodies
   use coordinate_matrix, only: coordinate_matrix_t, add_element_matrix
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t
   use atrito_model, only: model_t
   use atrito_points, only: contact_points_t
   use atrito_status, only: status_t, set_status, is_ok, STATUS_USAGE
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: glued_t, glue_bodies, node_order, number_glued, count_entries, glued_load, assemble_glued, glued_displacements
   public :: NUMBERINGS, NUMBERING_TEXTS

   type :: glued_t
      integer(ip) :: n = 0                          !< equations
      integer(ip) :: n_glued = 0                    !< nodes that became one with another
      integer(ip) :: n_held = 0                     !< nodes held by rigid surfaces
      integer(ip), allocatable :: first(:)          !< (n_nodes) the node that a node became
      integer(ip), allocatable :: equation(:, :)    !< (2, n_nodes); 0 prescribed or unused
      logical, allocatable :: held(:, :)            !< (2, n_nodes) of the first nodes, in their frames
      real(wp), allocatable :: value(:, :)          !< (2, n_nodes) [L] prescribed, of all nodes, in their frames
      logical, allocatable :: is_turned(:)          !< (n_nodes) whether a node has a frame of its own
      real(wp), allocatable :: normal(:, :)         !< (2, n_nodes) its first direction
   end type glued_t

   !> Orders of the nodes that node_order knows, in a word of the command line and on the page.
   character(len=*), parameter :: NUMBERINGS(3) = [character(len=8) :: 'deck', 'backward', 'bodies']
   character(len=*), parameter :: NUMBERING_TEXTS(3) = [character(len=28) :: 'the deck''s', 'the deck''s backward', &
                                                                                                     'the deck''s, last body first']
   !> Sine below which two rigid surfaces hold a node along one direction.
   real(wp), parameter :: PARALLEL = 1.0e-10_wp

contains

   !> Glues the bodies; number_glued gives them their equations. status: STATUS_USAGE where the sides of a pair do not match.
   subroutine glue_bodies(model, held, value, points, glued, status)
      type(model_t), intent(in) :: model
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      real(wp), intent(in) :: value(:, :)           !< (2, n_nodes) [L]
      type(contact_points_t), intent(in) :: points(:)
      type(glued_t), intent(out) :: glued
      type(status_t), intent(out) :: status
      integer(ip) :: i

      glued%first = [(i, i=1, model%mesh%n_nodes)]
      do i = 1, size(points, kind=ip)
         call glue_pair(model, i, points(i), glued%first, status)
         if (.not. is_ok(status)) return
      end do
      do i = 1, model%mesh%n_nodes
         glued%first(i) = first_of(glued%first, i)
         if (glued%first(i) /= i) glued%n_glued = glued%n_glued + 1
      end do
      call share_prescribed(held, value, glued)
      do i = 1, size(points, kind=ip)
         if (points(i)%rigid) call hold_pair(points(i), glued)
      end do
      call share_frames(glued)
   end subroutine glue_bodies

   !> Joins each slave node with the master node that it faces.
   subroutine glue_pair(model, i, points, first, status)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i
      type(contact_points_t), intent(in) :: points
      integer(ip), intent(inout) :: first(:)
      type(status_t), intent(out) :: status
      integer(ip) :: j, a, b

      if (points%rigid .or. points%n == 0) return
      if (.not. points%matching) then
         call set_status(status, STATUS_USAGE, 'the sides of pair '//to_text(i)//', '// &
                         model%surfaces(model%pairs(i)%slave)%name//' on '//model%surfaces(model%pairs(i)%master)%name// &
                         ', do not match; bodies are glued together node by node')
         return
      end if
      do j = 1, points%n
         a = first_of(first, points%node(j))
         b = first_of(first, points%entry(points%first(j) - 1 + &
                                          minloc(points%coefficient(points%first(j):points%first(j + 1) - 1), dim=1)))
         first(max(a, b)) = min(a, b)
      end do
   end subroutine glue_pair

   !> The node that a node became.
   pure integer(ip) function first_of(first, node)
      integer(ip), intent(in) :: first(:), node

      first_of = node
      do while (first(first_of) /= first_of)
         first_of = first(first_of)
      end do
   end function first_of

   !> A prescribed displacement holds all nodes that became one; of two different ones the first node's counts.
   subroutine share_prescribed(held, value, glued)
      logical, intent(in) :: held(:, :)
      real(wp), intent(in) :: value(:, :)
      type(glued_t), intent(inout) :: glued
      integer(ip) :: i, dof, n

      n = size(held, 2, kind=ip)
      allocate (glued%held(2, n), glued%is_turned(n), source=.false.)
      allocate (glued%value(2, n), glued%normal(2, n), source=0.0_wp)
      do i = 1, n
         do dof = 1, 2
            if (.not. held(dof, i)) cycle
            if (.not. glued%held(dof, glued%first(i))) glued%value(dof, glued%first(i)) = value(dof, i)
            glued%held(dof, glued%first(i)) = .true.
         end do
      end do
   end subroutine share_prescribed

   !> Holds the slave's nodes on a rigid surface.
   subroutine hold_pair(points, glued)
      type(contact_points_t), intent(in) :: points
      type(glued_t), intent(inout) :: glued
      integer(ip) :: j

      do j = 1, points%n
         associate (node => glued%first(points%node(j)))
            if (.not. all(glued%held(:, node))) glued%n_held = glued%n_held + 1
            call hold_normal(points%normal(:, j), glued%held(:, node), glued%value(:, node), glued%is_turned(node), &
                             glued%normal(:, node))
         end associate
      end do
   end subroutine hold_pair

   !> Adds n . u = 0 to what holds a node.
   pure subroutine hold_normal(n, held, value, is_turned, frame)
      real(wp), intent(in) :: n(2)                  !< unit normal
      logical, intent(inout) :: held(2), is_turned
      real(wp), intent(inout) :: value(2), frame(2)
      integer(ip) :: h, other

      if (all(held)) return
      if (is_turned) then
         if (abs(frame(1)*n(2) - frame(2)*n(1)) <= PARALLEL) return
         is_turned = .false.                        ! two directions hold the node
         held = .true.
      else if (any(held)) then
         h = merge(1_ip, 2_ip, held(1))
         other = 3 - h
         if (abs(n(other)) <= PARALLEL) return
         held(other) = .true.
         value(other) = -n(h)*value(h)/n(other)
      else if (any(abs(n) <= PARALLEL)) then
         held(maxloc(abs(n), dim=1)) = .true.
      else
         is_turned = .true.
         frame = n
         held(1) = .true.
      end if
   end subroutine hold_normal

   !> What holds the first node of a group, and its frame, for all of the group.
   pure subroutine share_frames(glued)
      type(glued_t), intent(inout) :: glued
      integer(ip) :: i

      do i = 1, size(glued%first, kind=ip)
         glued%value(:, i) = glued%value(:, glued%first(i))
         glued%is_turned(i) = glued%is_turned(glued%first(i))
         glued%normal(:, i) = glued%normal(:, glued%first(i))
      end do
   end subroutine share_frames

   !> An order of the nodes in which equations may be numbered: what minimum degree finds depends on it.
   subroutine node_order(mesh, kind_of_order, order)
      type(mesh_t), intent(in) :: mesh
      integer, intent(in) :: kind_of_order          !< place in NUMBERINGS
      integer(ip), allocatable, intent(out) :: order(:)
      type(bodies_t) :: bodies
      integer(ip) :: i, n

      order = [(i, i=1, mesh%n_nodes)]
      if (kind_of_order == 2) order = order(mesh%n_nodes:1:-1)
      if (kind_of_order /= 3) return
      call find_bodies(mesh, bodies)
      n = 0
      do i = bodies%n, 1, -1
         associate (nodes => bodies%list(i)%nodes)
            order(n + 1:n + size(nodes)) = nodes
            n = n + size(nodes, kind=ip)
         end associate
      end do
      order = order(:n)                             ! without nodes of no element
   end subroutine node_order

   !> Equations of the free dofs of all nodes that belong to an element, in an order of the nodes.
   subroutine number_glued(mesh, order, glued)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: order(:)
      type(glued_t), intent(inout) :: glued
      logical :: waits(mesh%n_nodes)                !< first nodes without numbers so far
      integer(ip) :: e, k, dof

      waits = .false.
      do e = 1, mesh%n_elements
         waits(glued%first(mesh%nodes(:mesh%shape(e), e))) = .true.
      end do
      if (allocated(glued%equation)) deallocate (glued%equation)
      allocate (glued%equation(2, mesh%n_nodes), source=0_ip)
      glued%n = 0
      do k = 1, size(order, kind=ip)
         associate (node => glued%first(order(k)))
            if (.not. waits(node)) cycle
            waits(node) = .false.
            do dof = 1, 2
               if (glued%held(dof, node)) cycle
               glued%n = glued%n + 1
               glued%equation(dof, node) = glued%n
            end do
         end associate
      end do
      glued%equation = glued%equation(:, glued%first)
   end subroutine number_glued

   !> Entries of the lower triangles of all element matrices: the most that the matrix has.
   pure integer(lp) function count_entries(mesh, glued) result(entries)
      type(mesh_t), intent(in) :: mesh
      type(glued_t), intent(in) :: glued
      integer(lp) :: free
      integer(ip) :: e

      entries = 0
      do e = 1, mesh%n_elements
         free = count(glued%equation(:, mesh%nodes(:mesh%shape(e), e)) > 0, kind=lp)
         entries = entries + free*(free + 1)/2
      end do
   end function count_entries

   !> The load of nodal forces, to which assemble_glued adds that of the prescribed displacements.
   subroutine glued_load(glued, f, load)
      type(glued_t), intent(in) :: glued
      real(wp), intent(in) :: f(:, :)               !< (2, n_nodes) [F]
      real(wp), allocatable, intent(out) :: load(:, :) !< (n, 1)
      real(wp) :: own(2)
      integer(ip) :: i, dof

      allocate (load(glued%n, 1), source=0.0_wp)
      do i = 1, size(f, 2, kind=ip)
         own = f(:, i)
         if (glued%is_turned(i)) own = matmul(own, frame_of(glued%normal(:, i)))
         do dof = 1, 2
            if (glued%equation(dof, i) == 0) cycle
            load(glued%equation(dof, i), 1) = load(glued%equation(dof, i), 1) + own(dof)
         end do
      end do
   end subroutine glued_load

   !> The directions of a turned node: normal and tangent, a column each.
   pure function frame_of(normal) result(frame)
      real(wp), intent(in) :: normal(2)
      real(wp) :: frame(2, 2)

      frame(:, 1) = normal
      frame(:, 2) = [-normal(2), normal(1)]
   end function frame_of

   !> Adds all elements to the matrix, and the forces of the prescribed displacements to the load.
   subroutine assemble_glued(fem, glued, matrix, load)
      type(fem_t), intent(in) :: fem
      type(glued_t), intent(in) :: glued
      type(coordinate_matrix_t), intent(inout) :: matrix
      real(wp), intent(inout) :: load(:, :)         !< (n, 1)
      type(stiffness_cache_t) :: cache
      real(wp) :: turned(2*9_ip, 2*9_ip)
      integer(ip) :: equations(2*9_ip), e, n

      do e = 1, fem%mesh%n_elements
         n = 2*fem%mesh%shape(e)
         call cached_stiffness(fem, e, cache)
         associate (nodes => fem%mesh%nodes(:fem%mesh%shape(e), e))
            equations(:n) = reshape(glued%equation(:, nodes), [n])
            if (any(glued%is_turned(nodes))) then
               turned(:n, :n) = cache%k(:n, :n)
               call turn_matrix(glued, nodes, turned(:n, :n))
               call add_element_matrix(matrix, equations(:n), turned(:n, :n))
               call subtract_forces(glued, nodes, turned, equations(:n), load)
            else
               call add_element_matrix(matrix, equations(:n), cache%k(:n, :n))
               call subtract_forces(glued, nodes, cache%k, equations(:n), load)
            end if
         end associate
      end do
   end subroutine assemble_glued

   !> An element matrix in the frames of its nodes.
   pure subroutine turn_matrix(glued, nodes, k)
      type(glued_t), intent(in) :: glued
      integer(ip), intent(in) :: nodes(:)
      real(wp), intent(inout) :: k(:, :)
      real(wp) :: frame(2, 2)
      integer(ip) :: i

      do i = 1, size(nodes, kind=ip)
         if (.not. glued%is_turned(nodes(i))) cycle
         frame = frame_of(glued%normal(:, nodes(i)))
         k(:, 2*i - 1:2*i) = matmul(k(:, 2*i - 1:2*i), frame)
         k(2*i - 1:2*i, :) = matmul(transpose(frame), k(2*i - 1:2*i, :))
      end do
   end subroutine turn_matrix

   pure subroutine subtract_forces(glued, nodes, k, equations, load)
      type(glued_t), intent(in) :: glued
      integer(ip), intent(in) :: nodes(:), equations(:)
      real(wp), intent(in) :: k(:, :)
      real(wp), intent(inout) :: load(:, :)
      integer(ip) :: i, j, dof

      do i = 1, size(nodes, kind=ip)
         do dof = 1, 2
            associate (value => glued%value(dof, nodes(i)))
               if (value == 0.0_wp) cycle           ! of most nodes nothing is prescribed
               do j = 1, size(equations, kind=ip)
                  if (equations(j) > 0) load(equations(j), 1) = load(equations(j), 1) - k(j, 2*(i - 1) + dof)*value
               end do
            end associate
         end do
      end do
   end subroutine subtract_forces

   !> Displacements of all nodes along the axes.
   pure function glued_displacements(glued, x) result(u)
      type(glued_t), intent(in) :: glued
      real(wp), intent(in) :: x(:, :)               !< (n, 1) the solution
      real(wp) :: u(2, size(glued%first))
      integer(ip) :: i, dof

      u = glued%value
      do i = 1, size(glued%first, kind=ip)
         do dof = 1, 2
            if (glued%equation(dof, i) > 0) u(dof, i) = x(glued%equation(dof, i), 1)
         end do
         if (glued%is_turned(i)) u(:, i) = matmul(frame_of(glued%normal(:, i)), u(:, i))
      end do
   end function glued_displacements

end module glued_bodies
