!> Bodies: the connected components of the elements, their equations and their rigid motions.
module atrito_bodies
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_dense, only: null_space
   use atrito_multifrontal, only: dissection_t, order_elements, elimination_t
   use atrito_ordering, only: graph_t, build_graph, mesh_components, order_contact_last
   use atrito_plane_state, only: STATES
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: body_t, bodies_t, find_bodies, number_equations, order_by_dissection, find_rigid_modes, element_equations, mode_at
   public :: simplest_motion, MOVES_RIGIDLY

   integer(ip), parameter :: MOVES_RIGIDLY = -1_ip

   type :: body_t
      character(len=:), allocatable :: name    !< for messages and tables
      integer(ip), allocatable :: elements(:)  !< places in the mesh, ascending; none of a rigid body
      integer(ip), allocatable :: nodes(:)     !< after number_equations in the order of their equations
      integer(ip) :: n = 0                     !< equations
      integer(ip) :: n_retained = 0                !< the last ones: the free dofs of the contact nodes
      logical :: by_profile = .true.           !< numbered for a small profile, and not as the nodes come
      real(wp) :: centre(2) = 0.0_wp           !< [L], middle of the nodes
      real(wp) :: size = 1.0_wp                !< [L], largest distance from the centre
      real(wp) :: slenderness = 1.0_wp         !< shorter over longer side of the box round the nodes
      real(wp), allocatable :: modes(:, :)     !< (3, n_modes): translations along 1 and 2, rotation about the centre at `size`
      real(wp), allocatable :: slides(:, :)    !< (4, n) motions in which its contacts let it slide, as modes; the work of loads on
      !< each that is none, over their sizes
      logical :: is_rigid = .false.            !< a rigid surface that moves: no elements, no equations, its nodes carry its motion
      logical :: is_touched = .false.          !< of a rigid one: a contact point sees it, or a bilateral row holds it
   end type body_t

   type :: bodies_t
      integer(ip) :: n = 0                                  !< bodies, the rigid ones among them
      integer(ip) :: n_rigid = 0                            !< the last ones are rigid
      type(body_t), allocatable :: list(:)                  !< (n), the elastic ones first
      integer(ip), allocatable :: of_node(:), of_element(:) !< body of a node (0: in no element) and of an element
      integer(ip), allocatable :: equation(:, :)            !< (2, n_nodes): number within the body; 0 prescribed or unused;
      !< MOVES_RIGIDLY: of a rigid body, none of its own, but a motion has a part there
   end type bodies_t

   !> A prescribed combination smaller than this, relative to the largest, does not hold the body.
   real(wp), parameter :: HELD_TOLERANCE = 1.0e-10_wp
   !> Entries of a mode below this are round-off.
   real(wp), parameter :: MODE_ROUND_OFF = 1.0e-14_wp

contains

   !> Finds the connected components of the elements.
   subroutine find_bodies(mesh, bodies)
      type(mesh_t), intent(in) :: mesh      !< elements and their nodes are read
      type(bodies_t), intent(out) :: bodies !< elastic ones, without names, equations and motions
      integer(ip), allocatable :: component(:), number(:), first(:), member(:)
      integer(ip) :: n_components, e, i

      allocate (component(mesh%n_nodes))
      call mesh_components(mesh%n_nodes, mesh%nodes(:, :mesh%n_elements), component, n_components)
      allocate (number(n_components), bodies%of_node(mesh%n_nodes), bodies%of_element(mesh%n_elements), source=0_ip)
      do e = 1, mesh%n_elements
         i = component(mesh%nodes(1, e))
         if (number(i) == 0) then
            bodies%n = bodies%n + 1
            number(i) = bodies%n
         end if
         bodies%of_element(e) = number(i)
      end do
      bodies%of_node = number(component)
      allocate (bodies%list(bodies%n))
      allocate (bodies%equation(2, mesh%n_nodes), source=0_ip)
      call list_parts(bodies%n, mesh%n_elements, bodies%of_element, first, member)
      do i = 1, bodies%n
         bodies%list(i)%elements = member(first(i):first(i + 1) - 1)
      end do
      call list_parts(bodies%n, mesh%n_nodes, bodies%of_node, first, member)
      do i = 1, bodies%n
         bodies%list(i)%nodes = member(first(i):first(i + 1) - 1)
         call measure_body(mesh, bodies%list(i))
      end do
   end subroutine find_bodies

   !> The members of parts that have none in common, in their order, in linear time for any number of parts.
   subroutine list_parts(n_parts, n, part_of, first, member)
      integer(ip), intent(in) :: n_parts, n
      integer(ip), intent(in) :: part_of(1, n)      !< 0 .. n_parts; 0: in none
      integer(ip), allocatable, intent(out) :: first(:)    !< (n_parts + 1)
      integer(ip), allocatable, intent(out) :: member(:)   !< those of part i are member(first(i):first(i + 1) - 1)

      call list_holders(n_parts, part_of, first, member)
   end subroutine list_parts

   !> Of the box round the nodes of a body its middle, half its diagonal, and its shorter side over the longer one.
   subroutine measure_body(mesh, body)
      type(mesh_t), intent(in) :: mesh
      type(body_t), intent(inout) :: body
      real(wp) :: low(2), high(2)
      integer(ip) :: i

      low = huge(1.0_wp)
      high = -huge(1.0_wp)
      !$omp parallel do default(none) shared(mesh, body) reduction(min:low) reduction(max:high) &
      !$omp if(is_shared(size(body%nodes, kind=ip)))
      do i = 1, size(body%nodes, kind=ip)
         low = min(low, mesh%x(:, body%nodes(i)))
         high = max(high, mesh%x(:, body%nodes(i)))
      end do
      !$omp end parallel do
      body%centre = 0.5_wp*low + 0.5_wp*high
      body%size = 0.5_wp*norm2(high - low)
      body%slenderness = minval(high - low)/maxval(high - low)
   end subroutine measure_body

   !> Numbers the equations of a body, one for each dof that is not prescribed.
   !>
   !> The contact nodes come last, in their chain order: elimination of all equations before them leaves the Schur complement of the
   !> stiffness on the contact line. The others are ordered so that the profile is small. A solver with an order of its own does not
   !> need that: without `by_profile` they stay in the order they have.
   subroutine number_equations(mesh, bodies, i_body, held, contact_nodes, by_profile)
      type(mesh_t), intent(in) :: mesh              !< nodes of its elements are read
      type(bodies_t), intent(inout) :: bodies       !< the body and its rows of `equation` are changed
      integer(ip), intent(in) :: i_body             !< place in the list
      logical, intent(in) :: held(:, :)             !< (2, n_nodes): prescribed dofs
      integer(ip), intent(in) :: contact_nodes(:)   !< of this body, each once
      logical, intent(in) :: by_profile             !< the numbers are to make a small profile
      integer(ip) :: i, dof, node

      associate (body => bodies%list(i_body))
         body%by_profile = by_profile
         ! the nodes have no equations yet: until then these hold what the order needs of them
         if (by_profile) then
            call order_by_profile(mesh, contact_nodes, body, bodies%equation(1, :))
         else
            bodies%equation(1, body%nodes) = 0
            bodies%equation(1, contact_nodes) = 1
            body%nodes = [pack(body%nodes, bodies%equation(1, body%nodes) == 0), contact_nodes]
         end if
         body%n = 0
         body%n_retained = 0
         do i = 1, size(body%nodes, kind=ip)
            node = body%nodes(i)
            do dof = 1, 2
               bodies%equation(dof, node) = 0
               if (held(dof, node)) cycle
               body%n = body%n + 1
               bodies%equation(dof, node) = body%n
               if (i > size(body%nodes) - size(contact_nodes)) body%n_retained = body%n_retained + 1
            end do
         end do
      end associate
   end subroutine number_equations

   !> Orders a body by the graph of its nodes, which are numbered by their places in body%nodes. (A list of all nodes of the mesh
   !> for each body would make thousands of bodies slow: `local` is one for all of them.)
   subroutine order_by_profile(mesh, contact_nodes, body, local)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: contact_nodes(:)
      type(body_t), intent(inout) :: body
      integer(ip), intent(inout) :: local(:)        !< (n_nodes) used for the nodes of the body: their places
      integer(ip), allocatable :: connectivity(:, :), order(:)
      type(graph_t) :: graph
      integer(ip) :: i

      local(body%nodes) = [(i, i=1, size(body%nodes, kind=ip))]
      allocate (connectivity(maxval(mesh%shape(body%elements)), size(body%elements)), source=0_ip)
      do i = 1, size(body%elements, kind=ip)
         associate (nodes => mesh%nodes(:mesh%shape(body%elements(i)), body%elements(i)))
            connectivity(:size(nodes), i) = local(nodes)
         end associate
      end do
      call build_graph(size(body%nodes, kind=ip), connectivity, graph)
      allocate (order(size(body%nodes)))
      call order_contact_last(graph, local(contact_nodes), order, connected=.true.)
      body%nodes = body%nodes(order)
   end subroutine order_by_profile

   !> The order of elimination of the sparse solver: nested dissection of the nodes, the retained equations last.
   !>
   !> Dissection gives parts, lists of nodes, in the order of elimination, and the parent of each part. The positions of a part's
   !> equations follow those of the part before it: last(p) is the number of equations of the parts 1 to p. Retained equations keep
   !> their numbers, which are the last ones of the body.
   subroutine order_by_dissection(mesh, bodies, i_body, elimination)
      type(mesh_t), intent(in) :: mesh                !< elements and places of the nodes are read
      type(bodies_t), intent(in) :: bodies            !< equations numbered by number_equations
      integer(ip), intent(in) :: i_body               !< place in the list
      type(elimination_t), intent(out) :: elimination !< order of the body's equations; `text` says how
      type(dissection_t) :: parts
      integer(ip) :: dof, i, k, n, p

      associate (body => bodies%list(i_body))
         call order_elements(body%elements, mesh%nodes, mesh%shape, mesh%x, is_eliminated(mesh, bodies, body), parts, &
                             elimination%text)
         allocate (elimination%position(body%n), elimination%last(parts%n))
         elimination%parent = parts%parent(:parts%n)
         n = 0
         i = 1
         do p = 1, parts%n
            do i = i, parts%last(p)
               do dof = 1, 2
                  k = bodies%equation(dof, parts%order(i))
                  if (k == 0) cycle
                  n = n + 1
                  elimination%position(k) = n
               end do
            end do
            elimination%last(p) = n
         end do
         do k = body%n - body%n_retained + 1, body%n
            elimination%position(k) = k
         end do
      end associate
   end subroutine order_by_dissection

   !> Which nodes of the mesh are the body's and have equations that are not kept.
   function is_eliminated(mesh, bodies, body) result(eliminated)
      type(mesh_t), intent(in) :: mesh
      type(bodies_t), intent(in) :: bodies
      type(body_t), intent(in) :: body
      logical, allocatable :: eliminated(:)
      integer(ip) :: i

      allocate (eliminated(mesh%n_nodes), source=.false.)
      do i = 1, size(body%nodes, kind=ip)
         associate (node => body%nodes(i))
            eliminated(node) = any(bodies%equation(:, node) > 0) .and. all(bodies%equation(:, node) <= body%n - body%n_retained)
         end associate
      end do
   end function is_eliminated

   !> The rigid motions that the supports of a body leave free.
   !>
   !> A rigid motion m = (m1, m2, m3), two translations and the rotation about the centre c times the size R of the body, displaces
   !> the point x by
   !>    u1 = m1 - m3 (x2 - c2)/R,   u2 = m2 + m3 (x1 - c1)/R,
   !> so that its three entries are lengths of like size. Each prescribed dof asks for u = 0 there, a row of a matrix with three
   !> columns; so does each motion that strains the body, as that along the radius of a body of revolution does. What is left free
   !> is the null space of the matrix. Its basis is reduced to the simplest one, so that a motion can be named.
   subroutine find_rigid_modes(mesh, body, held)
      type(mesh_t), intent(in) :: mesh              !< places of the nodes, and states of the elements
      type(body_t), intent(inout) :: body           !< `modes` is set; centre and size are known
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      real(wp), allocatable :: rows(:, :)
      real(wp), parameter :: UNIT(3, 3) = reshape([1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [3, 3])
      integer(ip) :: i, j, dof, k, n_held, info
      logical :: moves(3)

      moves = STATES(mesh%state(body%elements(1)))%moves
      n_held = count(.not. moves, kind=ip)
      do i = 1, size(body%nodes, kind=ip)
         n_held = n_held + count(held(:, body%nodes(i)), kind=ip)
      end do
      allocate (rows(n_held, 3), source=0.0_wp)
      k = 0
      do j = 1, 3                                   ! a motion that strains is one that supports hold
         if (moves(j)) cycle
         k = k + 1
         rows(k, j) = 1.0_wp
      end do
      do i = 1, size(body%nodes, kind=ip)
         do dof = 1, 2
            if (.not. held(dof, body%nodes(i))) cycle
            k = k + 1
            do j = 1, 3
               rows(k, j) = mode_at(body, UNIT(:, j), mesh%x(:, body%nodes(i)), dof)
            end do
         end do
      end do
      call null_space(rows, HELD_TOLERANCE, body%modes, info)
      ! the simplest basis, so that a motion can be named
      call reduce_columns(body%modes, HELD_TOLERANCE)
      where (abs(body%modes) < MODE_ROUND_OFF) body%modes = 0.0_wp
      do j = 1, size(body%modes, 2, kind=ip)
         body%modes(:, j) = body%modes(:, j)/maxval(abs(body%modes(:, j)))
      end do
   end subroutine find_rigid_modes

   !> Reduces the columns of a basis: its space is the same, and each vector has an entry of 1 where the others have 0, the first
   !> such entries as far up as may be.
   !>
   !> Gauss and Jordan by columns, row by row from the top: of the columns that have no row yet the one with the largest entry
   !> takes it, is scaled to 1 there, and is taken off all others. Two translations and a rotation come out as (1, 0, 0), (0, 1, 0)
   !> and (0, 0, 1) even if the decomposition had mixed them, so a body is said to move along x1, not along a slope and about a
   !> place somewhere.
   pure subroutine reduce_columns(basis, round_off)
      real(wp), intent(inout) :: basis(:, :)        !< (entries, vectors)
      real(wp), intent(in) :: round_off             !< smaller entries are none
      real(wp) :: column(size(basis, 1))
      integer(ip) :: row, j, k, pivot

      k = 0
      do row = 1, size(basis, 1, kind=ip)
         if (k == size(basis, 2)) exit
         pivot = k + maxloc(abs(basis(row, k + 1:)), dim=1, kind=ip)
         if (abs(basis(row, pivot)) < round_off) cycle
         k = k + 1
         column = basis(:, pivot)/basis(row, pivot)
         basis(:, pivot) = basis(:, k)
         basis(:, k) = column
         do j = 1, size(basis, 2, kind=ip)
            if (j /= k) basis(:, j) = basis(:, j) - column*basis(row, j)
         end do
      end do
   end subroutine reduce_columns

   !> The vector of a space with the fewest entries, those that come first: what a motion is named by.
   pure function simplest_motion(basis) result(motion)
      real(wp), intent(in) :: basis(:, :)           !< (entries, vectors >= 1)
      real(wp) :: motion(size(basis, 1)), reduced(size(basis, 1), size(basis, 2))
      real(wp), parameter :: ROUND_OFF = 1.0e-6_wp

      reduced = basis
      call reduce_columns(reduced, ROUND_OFF)
      motion = reduced(:, 1)
      where (abs(motion) < ROUND_OFF*maxval(abs(motion))) motion = 0.0_wp
   end function simplest_motion

   !> Displacement of a rigid mode at a place, along a dof; dimensionless.
   pure real(wp) function mode_at(body, mode, x, dof) result(u)
      type(body_t), intent(in) :: body              !< its centre and its size are read
      real(wp), intent(in) :: mode(3)               !< a column of body%modes
      real(wp), intent(in) :: x(2)                  !< [L]
      integer(ip), intent(in) :: dof                !< 1 or 2

      if (dof == 1) then
         u = mode(1) - mode(3)*(x(2) - body%centre(2))/body%size
      else
         u = mode(2) + mode(3)*(x(1) - body%centre(1))/body%size
      end if
   end function mode_at

   !> Equation numbers of an element's dofs (u1, u2 of its first node, of its second, ...); 0 prescribed.
   pure function element_equations(mesh, bodies, element) result(equations)
      type(mesh_t), intent(in) :: mesh     !< nodes of the element are read
      type(bodies_t), intent(in) :: bodies !< equations numbered
      integer(ip), intent(in) :: element   !< place in the mesh
      integer(ip) :: equations(2*mesh%shape(element)), k

      do k = 1, mesh%shape(element)
         equations(2*k - 1:2*k) = bodies%equation(:, mesh%nodes(k, element))
      end do
   end function element_equations

end module atrito_bodies
