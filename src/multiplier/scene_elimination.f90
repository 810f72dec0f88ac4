!> Numbers and order of elimination of all bodies of a scene together, with the contact points as elements.
!>
!> Unknowns are the displacements of one body after the other, then the amplitudes of the rigid motions of floating bodies. As many
!> displacements of a floating body as it has motions get a spring to the ground, so that K is positive definite on u_e: those by
!> which the motions are best told apart. With Z the motions at the displacements, that is the largest row of Z, then the largest
!> of what is left of the others without its direction, and so on: the pivots of an elimination with row interchanges.
!>
!> The order is one nested dissection of the elements and the points (order_elements of the multifrontal solver). A point joins the
!> bodies that meet at it, the motions of a body are one more node of its points. A leaf of the dissection is cut in two: nodes
!> that no point touches have a front that never changes and may serve for equal leaves; the others come behind them.
module atrito_scene_elimination
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: body_t, mode_at
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t, bodies_of_row
   use atrito_mesh, only: side_count
   use atrito_kinds, only: ip, wp
   use atrito_multifrontal, only: dissection_t, order_elements, elimination_t
   implicit none (type, external)
   private
   public :: scene_numbering_t, number_scene, eliminate_scene

   !> The unknowns of a scene: the displacements body by body, then the amplitudes of the rigid motions.
   type :: scene_numbering_t
      integer(ip) :: n = 0, k = 0                !< unknowns; of them amplitudes
      integer(ip), allocatable :: before(:)      !< (bodies) unknowns of the bodies before
      integer(ip), allocatable :: first_motion(:) !< (bodies) unknown of the first motion
      integer(ip), allocatable :: n_motions(:)   !< (bodies)
      integer(ip), allocatable :: first_pull(:)  !< (bodies) place of the first motion among the k amplitudes; 0: none
      integer(ip), allocatable :: spring(:)      !< (k; of a part its springs) displacement at which a motion is held, so that u_e
      !< has no part in it; 0: of a rigid body, which has no u_e
      integer(ip), allocatable :: body(:)        !< (n)
   end type scene_numbering_t

   !> Corners that the dissection takes the centre of an element from.
   integer(ip), parameter :: CORNERS = 4_ip
   !> A node with more rows is no corner of them: of a face that as many points see it says nothing about where they are, and in a
   !> graph everything would be its neighbour.
   integer(ip), parameter :: MOST_ROWS = 64_ip

contains

   !> Numbers the unknowns of all bodies, one body behind the other, then the amplitudes of their rigid motions, and chooses for
   !> each motion the equations that a spring holds it by.
   !>
   !> With body b: its displacements are before(b) + 1 .. before(b) + n, its motions first_motion(b) .. first_motion(b) +
   !> n_motions(b) - 1.
   subroutine number_scene(fem, numbering)
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(scene_numbering_t), intent(out) :: numbering
      integer(ip) :: b, n, k

      associate (bodies => fem%bodies)
         allocate (numbering%before(bodies%n), numbering%first_motion(bodies%n), numbering%n_motions(bodies%n))
         allocate (numbering%first_pull(bodies%n), source=0_ip)
         n = 0
         do b = 1, bodies%n
            numbering%before(b) = n
            n = n + bodies%list(b)%n
            numbering%n_motions(b) = size(bodies%list(b)%modes, 2, kind=ip)
         end do
         numbering%k = sum(numbering%n_motions)
         numbering%n = n + numbering%k
         allocate (numbering%body(numbering%n), numbering%spring(numbering%k))
         k = 0
         do b = 1, bodies%n
            numbering%body(numbering%before(b) + 1:numbering%before(b) + bodies%list(b)%n) = b
            numbering%first_motion(b) = n + k + 1
            if (numbering%n_motions(b) == 0) cycle
            numbering%first_pull(b) = k + 1
            numbering%body(n + k + 1:n + k + numbering%n_motions(b)) = b
            call choose_springs(fem, bodies%list(b), numbering%before(b), numbering%spring(k + 1:k + numbering%n_motions(b)))
            k = k + numbering%n_motions(b)
         end do
      end associate
   end subroutine number_scene

   !> As many displacements as there are motions, by which the motions are best told apart: the largest row of Z, what is left of
   !> the others without it, and so on.
   !>
   !> z(:, i) is what is left of the motions at displacement i. The one that is left with most becomes a spring; its direction is
   !> taken out of all others (Gram and Schmidt). After as many as there are motions the springs hold them all, as firmly as single
   !> springs can.
   pure subroutine choose_springs(fem, body, before, spring)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      integer(ip), intent(in) :: before
      integer(ip), intent(out) :: spring(:)
      real(wp), allocatable :: z(:, :)
      real(wp) :: direction(size(spring))
      integer(ip) :: i, dof, m, at

      spring = 0
      if (body%is_rigid) return
      allocate (z(size(spring), body%n))
      do i = 1, size(body%nodes, kind=ip)
         do dof = 1, 2
            at = fem%bodies%equation(dof, body%nodes(i))
            if (at == 0) cycle
            do m = 1, size(spring, kind=ip)
               z(m, at) = mode_at(body, body%modes(:, m), fem%mesh%x(:, body%nodes(i)), dof)
            end do
         end do
      end do
      do m = 1, size(spring, kind=ip)
         at = maxloc(sum(z**2, dim=1), dim=1, kind=ip)
         spring(m) = before + at
         direction = z(:, at)/max(norm2(z(:, at)), tiny(1.0_wp))
         do i = 1, body%n
            z(:, i) = z(:, i) - direction*dot_product(direction, z(:, i))
         end do
      end do
   end subroutine choose_springs

   !> Nested dissection of the elements and the points; the rigid motions of a body are one more node of its points. The last
   !> unknowns may be kept: theirs are the last positions, in their order.
   !>
   !> 1. Elements of the mesh, then points, each as a list of nodes (list_elements); node n_nodes + b stands for the motions of body
   !> b. 2. order_elements cuts the graph of nodes in halves, again and again: parts of nodes with their parents. 3. Parts of nodes
   !> become parts of equations (build_elimination).
   function eliminate_scene(fem, rows, line, numbering, n_kept) result(elimination)
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(scene_numbering_t), intent(in) :: numbering !< of the unknowns
      integer(ip), intent(in), optional :: n_kept !< a node has all of its unknowns kept, or none; left out: none is
      type(elimination_t) :: elimination
      type(dissection_t) :: parts
      integer(ip), allocatable :: nodes(:, :), n_nodes_of(:)
      real(wp), allocatable :: x(:, :)
      logical, allocatable :: wanted(:), changes(:)
      character(len=:), allocatable :: text
      integer(ip) :: e, n

      call list_elements(fem, rows, line, numbering, nodes, n_nodes_of)
      n = fem%mesh%n_nodes
      allocate (x(2, n + fem%bodies%n), wanted(n + fem%bodies%n), changes(n + fem%bodies%n))
      x(:, :n) = fem%mesh%x(:, :n)
      x(:, n + 1:) = 0.0_wp
      wanted(:n) = any(fem%bodies%equation > 0, dim=1)
      wanted(n + 1:) = numbering%n_motions > 0
      if (present(n_kept)) call leave_out_kept(fem, numbering, numbering%n - n_kept, wanted)
      changes = .false.
      do e = fem%mesh%n_elements + 1, size(n_nodes_of, kind=ip)
         changes(nodes(:n_nodes_of(e), e)) = .true.
      end do
      call order_elements([(e, e=1, size(n_nodes_of, kind=ip))], nodes, n_nodes_of, x, wanted, parts, text)
      call build_elimination(fem, numbering, parts, changes, elimination)
      call move_alloc(text, elimination%text)
      if (.not. present(n_kept)) return
      do e = numbering%n - n_kept + 1, numbering%n
         elimination%position(e) = e
      end do
   end function eliminate_scene

   !> Nodes and motions whose unknowns are kept are not eliminated.
   !>
   !> A part of a scene that other processes have parts of keeps the unknowns that several of them have; they are the last ones.
   pure subroutine leave_out_kept(fem, numbering, n_eliminated, wanted)
      type(fem_t), intent(in) :: fem
      type(scene_numbering_t), intent(in) :: numbering
      integer(ip), intent(in) :: n_eliminated
      logical, intent(inout) :: wanted(:)        !< (nodes and bodies)
      integer(ip) :: i, b

      do i = 1, fem%mesh%n_nodes
         if (.not. wanted(i)) cycle
         wanted(i) = numbering%before(fem%bodies%of_node(i)) + maxval(fem%bodies%equation(:, i)) <= n_eliminated
      end do
      do b = 1, fem%bodies%n
         associate (motions => fem%mesh%n_nodes + b)
            wanted(motions) = wanted(motions) .and. numbering%first_motion(b) <= n_eliminated
         end associate
      end do
   end subroutine leave_out_kept

   !> The elements of the mesh, then the points that have a row. A motion that none of them sees stands with an element of its body.
   !>
   !> The dissection takes the centre of an element from its first CORNERS nodes. Nodes with more than MOST_ROWS rows say nothing
   !> about where a point is, and the carriers of a rigid surface are everywhere: they come behind the others.
   subroutine list_elements(fem, rows, line, numbering, nodes, n_nodes_of)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(scene_numbering_t), intent(in) :: numbering
      integer(ip), allocatable, intent(out) :: nodes(:, :), n_nodes_of(:)
      integer(ip) :: j, e, b, n_elements, n_points, most
      logical :: seen(fem%bodies%n), crowded(fem%mesh%n_nodes)

      n_elements = fem%mesh%n_elements
      n_points = count(line%normal > 0 .or. line%tangential > 0, kind=ip)
      crowded = find_crowded(fem%mesh%n_nodes, rows)
      do b = fem%bodies%n - fem%bodies%n_rigid + 1, fem%bodies%n ! a rigid body is everywhere, too
         crowded(fem%bodies%list(b)%nodes) = .true.
      end do
      most = max(CORNERS, rows%longest) + rows%longest
      if (any(crowded)) most = most + CORNERS
      most = max(most, size(fem%mesh%nodes, 1, kind=ip))
      allocate (nodes(most, n_elements + n_points + fem%bodies%n), &
                n_nodes_of(n_elements + n_points + fem%bodies%n))
      nodes(:size(fem%mesh%nodes, 1), :n_elements) = fem%mesh%nodes(:, :n_elements)
      n_nodes_of(:n_elements) = fem%mesh%shape(:n_elements)
      seen = .false.
      e = n_elements
      do j = 1, line%n
         if (line%normal(j) == 0 .and. line%tangential(j) == 0) cycle
         e = e + 1
         call list_nodes_of_point(fem, rows, crowded, numbering, j, nodes(:, e), n_nodes_of(e))
         seen(bodies_of_row(rows, j, fem%bodies%of_node)) = .true.
      end do
      do b = 1, fem%bodies%n
         if (seen(b) .or. numbering%n_motions(b) == 0) cycle
         e = e + 1
         n_nodes_of(e) = CORNERS + 1
         if (fem%bodies%list(b)%is_rigid) then
            nodes(:CORNERS, e) = fem%bodies%list(b)%nodes([1, 2, 3, 3])
         else
            j = fem%bodies%list(b)%elements(1)
            nodes(:CORNERS, e) = fem%mesh%nodes([1_ip, 2_ip, 3_ip, side_count(fem%mesh, j)], j)
         end if
         nodes(CORNERS + 1, e) = fem%mesh%n_nodes + b
      end do
      nodes = nodes(:, :e)
      n_nodes_of = n_nodes_of(:e)
   end subroutine list_elements

   !> Nodes with too many rows to be corners.
   !>
   !> One face that a thousand points see would join all of them in the graph of the dissection.
   pure function find_crowded(n_nodes, rows) result(crowded)
      integer(ip), intent(in) :: n_nodes
      type(contact_rows_t), intent(in) :: rows
      logical :: crowded(n_nodes)
      integer(ip) :: held(n_nodes), i

      held = 0
      do i = 1, size(rows%node, kind=ip)
         held(rows%node(i)) = held(rows%node(i)) + 1
      end do
      crowded = held > MOST_ROWS
   end function find_crowded

   !> The nodes of the row, those first that may be corners, as often as it takes to have four, and the motions of their bodies.
   !>
   !> order_elements wants at least CORNERS nodes of each element; a point on a point of a rigid surface has fewer, and repeats
   !> them.
   pure subroutine list_nodes_of_point(fem, rows, crowded, numbering, j, nodes, n)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      logical, intent(in) :: crowded(:)          !< (nodes)
      type(scene_numbering_t), intent(in) :: numbering
      integer(ip), intent(in) :: j
      integer(ip), intent(inout) :: nodes(:)
      integer(ip), intent(out) :: n
      integer(ip) :: entries, k, b

      associate (row => rows%node(rows%first(j):rows%first(j + 1) - 1))
         entries = count(.not. crowded(row), kind=ip)
         n = 0
         if (entries > 0) then
            n = max(entries, CORNERS)
            nodes(:entries) = pack(row,.not. crowded(row))
            do k = entries, n - 1
               nodes(k + 1) = nodes(mod(k, entries) + 1)
            end do
         end if
         if (entries < size(row)) then
            nodes(n + 1:n + size(row) - entries) = pack(row, crowded(row))
            n = n + size(row, kind=ip) - entries
            do while (n < CORNERS)
               n = n + 1
               nodes(n) = nodes(n - 1)
            end do
         end if
      end associate
      do k = rows%first(j), rows%first(j + 1) - 1
         b = fem%bodies%of_node(rows%node(k))
         if (numbering%n_motions(b) == 0) cycle
         if (any(nodes(:n) == fem%mesh%n_nodes + b)) cycle
         n = n + 1
         nodes(n) = fem%mesh%n_nodes + b
      end do
   end subroutine list_nodes_of_point

   !> From parts of nodes to parts of equations. A leaf is cut in two: first the nodes that no point touches, whose front never
   !> changes and has equals, then the others.
   !>
   !> Parts come in the order of elimination, children before parents: last(q) is the last position of part q, parent(q) the part
   !> whose front takes its update. new_part maps the parts of nodes to those of equations, of which a cut leaf has two.
   subroutine build_elimination(fem, numbering, parts, changes, elimination)
      type(fem_t), intent(in) :: fem
      type(scene_numbering_t), intent(in) :: numbering
      type(dissection_t), intent(in) :: parts
      logical, intent(in) :: changes(:)          !< (nodes) a point touches it
      type(elimination_t), intent(out) :: elimination
      integer(ip) :: new_part(parts%n), p, q, n, first
      logical :: is_leaf(parts%n)

      ! a part without children is a leaf
      is_leaf = .true.
      do p = 1, parts%n
         if (parts%parent(p) > 0) is_leaf(parts%parent(p)) = .false.
      end do
      allocate (elimination%position(numbering%n), elimination%last(2*parts%n), elimination%parent(2*parts%n))
      q = 0
      n = 0
      first = 1
      do p = 1, parts%n
         associate (nodes => parts%order(first:parts%last(p)))
            ! first the nodes that no point touches, in a part of their own
            if (is_leaf(p) .and. any(changes(nodes)) .and. .not. all(changes(nodes))) then
               q = q + 1
               call place_nodes(fem, numbering, pack(nodes,.not. changes(nodes)), n, elimination%position)
               elimination%last(q) = n
               elimination%parent(q) = q + 1
               call place_nodes(fem, numbering, pack(nodes, changes(nodes)), n, elimination%position)
            else
               call place_nodes(fem, numbering, nodes, n, elimination%position)
            end if
         end associate
         q = q + 1
         elimination%last(q) = n
         new_part(p) = q
         first = parts%last(p) + 1
      end do
      do p = 1, parts%n
         elimination%parent(new_part(p)) = 0
         if (parts%parent(p) > 0) elimination%parent(new_part(p)) = new_part(parts%parent(p))
      end do
      elimination%last = elimination%last(:q)
      elimination%parent = elimination%parent(:q)
   end subroutine build_elimination

   !> The next places in the order of elimination for the unknowns of some nodes: displacements, or the motions of a body.
   pure subroutine place_nodes(fem, numbering, nodes, n, place)
      type(fem_t), intent(in) :: fem
      type(scene_numbering_t), intent(in) :: numbering
      integer(ip), intent(in) :: nodes(:)
      integer(ip), intent(inout) :: n            !< places taken so far
      integer(ip), intent(inout) :: place(:)
      integer(ip) :: i, dof, b, equation

      do i = 1, size(nodes, kind=ip)
         if (nodes(i) > fem%mesh%n_nodes) then
            b = nodes(i) - fem%mesh%n_nodes
            do dof = 1, numbering%n_motions(b)
               n = n + 1
               place(numbering%first_motion(b) + dof - 1) = n
            end do
            cycle
         end if
         b = fem%bodies%of_node(nodes(i))
         do dof = 1, 2
            equation = fem%bodies%equation(dof, nodes(i))
            if (equation <= 0) cycle
            n = n + 1
            place(numbering%before(b) + equation) = n
         end do
      end do
   end subroutine place_nodes

end module atrito_scene_elimination
