!> The bodies of a scene glued together along their contact pairs: one set of equations, no contact.
!>
!> Slave and master nodes that face each other share their displacements, whatever the gap between them. A rigid master holds the
!> slave's nodes along the normal, at zero. Where that normal is no axis the node has a frame of its own: its first dof is then
!> along the normal and held, its second along the tangent.
module atrito_tied_bodies
   use atrito_assembly, only: fem_t, stiffness_cache_t, cached_stiffness
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, Q2_NODES
   use atrito_model, only: model_t
   use atrito_points, only: contact_points_t
   use atrito_profile, only: profile_t, begin_profile, add_to_profile, close_profile
   use atrito_status, only: status_t, set_status, is_ok, STATUS_USAGE
   use atrito_storage, only: storage_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: tied_t, tie_bodies, node_order, number_tied, tied_profile, tied_load, assemble_tied, tied_displacements
   public :: name_tied_equation, NODE_ORDERS

   type :: tied_t
      integer(ip) :: n = 0                          !< equations
      integer(ip) :: n_glued = 0                    !< nodes that became one with another
      integer(ip) :: n_held = 0                     !< nodes held by rigid surfaces
      integer(ip), allocatable :: first(:)          !< (n_nodes) the node that a node became
      integer(ip), allocatable :: equation(:, :)    !< (2, n_nodes); 0 prescribed or unused
      logical, allocatable :: held(:, :)            !< (2, n_nodes) of the first nodes, in their frames
      real(wp), allocatable :: value(:, :)          !< (2, n_nodes) [L] prescribed, of all nodes, in their frames
      logical, allocatable :: is_turned(:)          !< (n_nodes) whether a node has a frame of its own
      real(wp), allocatable :: normal(:, :)         !< (2, n_nodes) its first direction
   end type tied_t

   !> Orders of the nodes that node_order knows.
   character(len=*), parameter :: NODE_ORDERS(3) = [character(len=28) :: 'the deck''s', 'the deck''s backward', &
                                                                                                     'the deck''s, last body first']
   !> Sine below which two rigid surfaces hold a node along one direction.
   real(wp), parameter :: PARALLEL = 1.0e-10_wp

contains

   !> Glues the bodies; number_tied gives them their equations. status: STATUS_USAGE where the sides of a pair do not match.
   subroutine tie_bodies(model, held, value, points, tied, status)
      type(model_t), intent(in) :: model
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      real(wp), intent(in) :: value(:, :)           !< (2, n_nodes) [L]
      type(contact_points_t), intent(in) :: points(:)
      type(tied_t), intent(out) :: tied
      type(status_t), intent(out) :: status
      integer(ip) :: i

      tied%first = [(i, i=1, model%mesh%n_nodes)]
      do i = 1, size(points, kind=ip)
         call glue_pair(model, i, points(i), tied%first, status)
         if (.not. is_ok(status)) return
      end do
      do i = 1, model%mesh%n_nodes
         tied%first(i) = first_of(tied%first, i)
         if (tied%first(i) /= i) tied%n_glued = tied%n_glued + 1
      end do
      call share_prescribed(held, value, tied)
      do i = 1, size(points, kind=ip)
         if (points(i)%rigid) call hold_pair(points(i), tied)
      end do
      call share_frames(tied)
   end subroutine tie_bodies

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
         call set_status(status, STATUS_USAGE, '--bench-limit: the sides of pair '//to_text(i)//', '// &
                         model%surfaces(model%pairs(i)%slave)%name//' on '//model%surfaces(model%pairs(i)%master)%name// &
                         ', do not match; bodies are glued together node by node')
         return
      end if
      do j = 1, points%n
         a = first_of(first, points%node(j))
         b = first_of(first, points%master_node(maxloc(points%master_shape(:, j), dim=1), j))
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
   subroutine share_prescribed(held, value, tied)
      logical, intent(in) :: held(:, :)
      real(wp), intent(in) :: value(:, :)
      type(tied_t), intent(inout) :: tied
      integer(ip) :: i, dof, n

      n = size(held, 2, kind=ip)
      allocate (tied%held(2, n), tied%is_turned(n), source=.false.)
      allocate (tied%value(2, n), tied%normal(2, n), source=0.0_wp)
      do i = 1, n
         do dof = 1, 2
            if (.not. held(dof, i)) cycle
            if (.not. tied%held(dof, tied%first(i))) tied%value(dof, tied%first(i)) = value(dof, i)
            tied%held(dof, tied%first(i)) = .true.
         end do
      end do
   end subroutine share_prescribed

   !> Holds the slave's nodes on a rigid surface.
   subroutine hold_pair(points, tied)
      type(contact_points_t), intent(in) :: points
      type(tied_t), intent(inout) :: tied
      integer(ip) :: j

      do j = 1, points%n
         associate (node => tied%first(points%node(j)))
            if (.not. all(tied%held(:, node))) tied%n_held = tied%n_held + 1
            call hold_normal(points%normal(:, j), tied%held(:, node), tied%value(:, node), tied%is_turned(node), &
                             tied%normal(:, node))
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
   pure subroutine share_frames(tied)
      type(tied_t), intent(inout) :: tied
      integer(ip) :: i

      do i = 1, size(tied%first, kind=ip)
         tied%value(:, i) = tied%value(:, tied%first(i))
         tied%is_turned(i) = tied%is_turned(tied%first(i))
         tied%normal(:, i) = tied%normal(:, tied%first(i))
      end do
   end subroutine share_frames

   !> An order of the nodes in which equations may be numbered: what minimum degree finds depends on it.
   subroutine node_order(mesh, kind_of_order, order)
      type(mesh_t), intent(in) :: mesh
      integer, intent(in) :: kind_of_order          !< place in NODE_ORDERS
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
   subroutine number_tied(mesh, order, tied)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: order(:)
      type(tied_t), intent(inout) :: tied
      logical :: waits(mesh%n_nodes)                !< first nodes without numbers so far
      integer(ip) :: e, k, dof

      waits = .false.
      do e = 1, mesh%n_elements
         waits(tied%first(mesh%nodes(:mesh%shape(e), e))) = .true.
      end do
      if (allocated(tied%equation)) deallocate (tied%equation)
      allocate (tied%equation(2, mesh%n_nodes), source=0_ip)
      tied%n = 0
      do k = 1, size(order, kind=ip)
         associate (node => tied%first(order(k)))
            if (.not. waits(node)) cycle
            waits(node) = .false.
            do dof = 1, 2
               if (tied%held(dof, node)) cycle
               tied%n = tied%n + 1
               tied%equation(dof, node) = tied%n
            end do
         end associate
      end do
      tied%equation = tied%equation(:, tied%first)
   end subroutine number_tied

   !> The profile of the glued bodies' matrix, nothing kept.
   subroutine tied_profile(fem, tied, profile)
      type(fem_t), intent(in) :: fem
      type(tied_t), intent(in) :: tied
      type(profile_t), intent(out) :: profile
      integer(ip) :: equations(2*Q2_NODES), e, n

      call begin_profile(profile, tied%n, 0_ip)
      do e = 1, fem%mesh%n_elements
         n = fem%mesh%shape(e)
         equations(:2*n) = reshape(tied%equation(:, fem%mesh%nodes(:n, e)), [2*n])
         call add_to_profile(profile, equations(:2*n))
      end do
      call close_profile(profile)
   end subroutine tied_profile

   !> The load of nodal forces, to which assemble_tied adds that of the prescribed displacements.
   subroutine tied_load(tied, f, load)
      type(tied_t), intent(in) :: tied
      real(wp), intent(in) :: f(:, :)               !< (2, n_nodes) [F]
      real(wp), allocatable, intent(out) :: load(:, :) !< (n, 1)
      real(wp) :: own(2)
      integer(ip) :: i, dof

      allocate (load(tied%n, 1), source=0.0_wp)
      do i = 1, size(f, 2, kind=ip)
         own = f(:, i)
         if (tied%is_turned(i)) own = matmul(own, frame_of(tied%normal(:, i)))
         do dof = 1, 2
            if (tied%equation(dof, i) == 0) cycle
            load(tied%equation(dof, i), 1) = load(tied%equation(dof, i), 1) + own(dof)
         end do
      end do
   end subroutine tied_load

   !> The directions of a turned node: normal and tangent, a column each.
   pure function frame_of(normal) result(frame)
      real(wp), intent(in) :: normal(2)
      real(wp) :: frame(2, 2)

      frame(:, 1) = normal
      frame(:, 2) = [-normal(2), normal(1)]
   end function frame_of

   !> Adds all elements to the matrix, and the forces of the prescribed displacements to the load.
   subroutine assemble_tied(fem, tied, storage, load)
      type(fem_t), intent(in) :: fem
      type(tied_t), intent(in) :: tied
      class(storage_t), intent(inout) :: storage
      real(wp), intent(inout) :: load(:, :)         !< (n, 1)
      type(stiffness_cache_t) :: cache
      real(wp) :: turned(2*Q2_NODES, 2*Q2_NODES)
      integer(ip) :: equations(2*Q2_NODES), e, n

      do e = 1, fem%mesh%n_elements
         n = 2*fem%mesh%shape(e)
         call cached_stiffness(fem, e, cache)
         associate (nodes => fem%mesh%nodes(:fem%mesh%shape(e), e))
            equations(:n) = reshape(tied%equation(:, nodes), [n])
            if (any(tied%is_turned(nodes))) then
               turned(:n, :n) = cache%k(:n, :n)
               call turn_matrix(tied, nodes, turned(:n, :n))
               call storage%add(equations(:n), turned(:n, :n))
               call subtract_forces(tied, nodes, turned, equations(:n), load)
            else
               call storage%add(equations(:n), cache%k(:n, :n))
               call subtract_forces(tied, nodes, cache%k, equations(:n), load)
            end if
         end associate
      end do
   end subroutine assemble_tied

   !> An element matrix in the frames of its nodes.
   pure subroutine turn_matrix(tied, nodes, k)
      type(tied_t), intent(in) :: tied
      integer(ip), intent(in) :: nodes(:)
      real(wp), intent(inout) :: k(:, :)
      real(wp) :: frame(2, 2)
      integer(ip) :: i

      do i = 1, size(nodes, kind=ip)
         if (.not. tied%is_turned(nodes(i))) cycle
         frame = frame_of(tied%normal(:, nodes(i)))
         k(:, 2*i - 1:2*i) = matmul(k(:, 2*i - 1:2*i), frame)
         k(2*i - 1:2*i, :) = matmul(transpose(frame), k(2*i - 1:2*i, :))
      end do
   end subroutine turn_matrix

   pure subroutine subtract_forces(tied, nodes, k, equations, load)
      type(tied_t), intent(in) :: tied
      integer(ip), intent(in) :: nodes(:), equations(:)
      real(wp), intent(in) :: k(:, :)
      real(wp), intent(inout) :: load(:, :)
      integer(ip) :: i, j, dof

      do i = 1, size(nodes, kind=ip)
         do dof = 1, 2
            associate (value => tied%value(dof, nodes(i)))
               if (value == 0.0_wp) cycle           ! of most nodes nothing is prescribed
               do j = 1, size(equations, kind=ip)
                  if (equations(j) > 0) load(equations(j), 1) = load(equations(j), 1) - k(j, 2*(i - 1) + dof)*value
               end do
            end associate
         end do
      end do
   end subroutine subtract_forces

   !> Displacements of all nodes along the axes.
   pure function tied_displacements(tied, x) result(u)
      type(tied_t), intent(in) :: tied
      real(wp), intent(in) :: x(:, :)               !< (n, 1) the solution
      real(wp) :: u(2, size(tied%first))
      integer(ip) :: i, dof

      u = tied%value
      do i = 1, size(tied%first, kind=ip)
         do dof = 1, 2
            if (tied%equation(dof, i) > 0) u(dof, i) = x(tied%equation(dof, i), 1)
         end do
         if (tied%is_turned(i)) u(:, i) = matmul(frame_of(tied%normal(:, i)), u(:, i))
      end do
   end function tied_displacements

   !> `node 12 dof 1` of an equation.
   pure function name_tied_equation(fem, tied, equation) result(text)
      type(fem_t), intent(in) :: fem
      type(tied_t), intent(in) :: tied
      integer(ip), intent(in) :: equation           !< 1..n
      character(len=:), allocatable :: text
      integer(ip) :: i, dof

      text = ''
      do i = 1, size(tied%first, kind=ip)
         do dof = 1, 2
            if (tied%equation(dof, i) /= equation) cycle
            text = 'node '//to_text(fem%mesh%node_id(i))//' dof '//to_text(dof)
            return
         end do
      end do
   end function name_tied_equation

end module atrito_tied_bodies
