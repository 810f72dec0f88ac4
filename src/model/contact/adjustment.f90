!> *CONTACT PAIR, ADJUST=: slave nodes are moved onto the master before anything is computed, without strain.
module atrito_adjustment
   use atrito_build_context, only: build_context_t
   use atrito_check_shapes, only: check_shapes
   use atrito_deck, only: card_t, option_t, token_text
   use atrito_diagnostics, only: report_error, report_note
   use atrito_items, only: find_option, get_real
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp
   use atrito_master, only: master_t, sight_t, look_along, look_at_end, nearest_end, smooth_normal
   use atrito_mesh, only: mesh_t
   use atrito_model, only: pair_t
   use atrito_pairing, only: make_master
   use atrito_pieces, only: place_at
   use atrito_points, only: contact_points_t
   use atrito_references, only: find_nodes
   use atrito_sets, only: find_set, grow_set, members_of
   use atrito_slave_faces, only: nodal_rule_t, nodal_rule, turn_at
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: adjusted_t, read_adjustment, adjust_pairs, close_adjusted

   !> Turns of the direction in which a node is moved to a curved master: each is less by orders of magnitude.
   integer(ip), parameter :: MOST_TURNS = 20
   real(wp), parameter :: SAME_DIRECTION = 1.0e-14_wp
   !> A foot this near to a node of the master, in parts of the way to it, is that node.
   real(wp), parameter :: AT_NODE = 0.05_wp

   !> The nodes of a pair that have been moved onto its master, or were there.
   type :: adjusted_t
      logical, allocatable :: node(:)                  !< (n_nodes); not allocated: none
   end type adjusted_t

contains

   !> ADJUST of a *CONTACT PAIR: a distance or a node set.
   subroutine read_adjustment(context, card, pair)
      type(build_context_t), intent(in) :: context     !< its model may get a node set
      type(card_t), intent(in) :: card                 !< *CONTACT PAIR
      type(pair_t), intent(inout) :: pair              !< adjust, adjust_set and is_adjusted are set
      character(len=*), parameter :: WHAT = 'largest gap that is closed, a real >= 0 [L], or a node set'
      type(option_t) :: option
      character(len=:), allocatable :: text
      integer(ip), allocatable :: nodes(:)
      logical :: found, ok

      call find_option(context%deck, card, 'ADJUST', option, found)
      if (.not. found) return
      pair%is_adjusted = .true.
      text = token_text(context%deck, option%value)
      if (scan(text(1:1), '0123456789+-.<') > 0) then
         call get_real(context%deck, option%value, WHAT, pair%adjust, ok, keyword='CONTACT PAIR')
         if (ok .and. pair%adjust < 0.0_wp) call report_error(context%deck, option%value, 'E-VALUE', 'ADJUST = '// &
                                                              to_text(pair%adjust), expected=WHAT, keyword='CONTACT PAIR')
      else
         call find_nodes(context, option%value, nodes, ok)
         if (ok) pair%adjust_set = find_set(context%model%node_sets, text)
         if (.not. ok .or. pair%adjust_set > 0) return
         call grow_set(context%model%node_sets, text, nodes)    ! of an element set, or a place of a block
         pair%adjust_set = find_set(context%model%node_sets, text)
      end if
   end subroutine read_adjustment

   !> Moves the nodes of all pairs that ask for it, one pair after the other.
   subroutine adjust_pairs(context, adjusted)
      type(build_context_t), intent(inout) :: context           !< nodes of slaves get other coordinates
      type(adjusted_t), allocatable, intent(out) :: adjusted(:) !< of each pair
      integer(ip) :: i

      allocate (adjusted(size(context%model%pairs)))
      if (.not. any(context%model%pairs%is_adjusted)) return
      do i = 1, size(adjusted, kind=ip)
         if (context%model%pairs(i)%is_adjusted) call adjust_pair(i, context, adjusted(i))
      end do
      call check_shapes(context%model%mesh, context)
   end subroutine adjust_pairs

   !> Moves the nodes of a pair: those of its set, or those with an overlap or with a gap of at most ADJUST along their normal.
   subroutine adjust_pair(i, context, adjusted)
      integer(ip), intent(in) :: i
      type(build_context_t), intent(inout) :: context
      type(adjusted_t), intent(inout) :: adjusted
      type(master_t) :: master
      type(sight_t) :: sight
      real(wp), dimension(2, context%model%mesh%n_nodes) :: normal, foot
      real(wp), dimension(context%model%mesh%n_nodes) :: length, turn, moves
      character(len=:), allocatable :: text
      logical, allocatable :: is_member(:)
      integer(ip) :: k, n_blind

      associate (model => context%model, mesh => context%model%mesh, pair => context%model%pairs(i))
         allocate (adjusted%node(mesh%n_nodes), is_member(mesh%n_nodes), source=.false.)
         if (pair%adjust_set > 0) is_member(members_of(model%node_sets%sets(pair%adjust_set))) = .true.
         call make_master(model, pair%master, master)
         call measure_nodes(mesh, model%surfaces(pair%slave)%faces, normal, length, turn)
         foot = mesh%x(:, :mesh%n_nodes)
         n_blind = 0
         do k = 1, mesh%n_nodes
            if (.not. length(k) > 0.0_wp .or. (pair%adjust_set > 0 .and. .not. is_member(k))) cycle
            sight = look_along(mesh%x(:, k), normal(:, k), 2*length(k), master)
            if (sight%piece == 0) sight = look_at_end(mesh%x(:, k), normal(:, k), 2*length(k), turn(k), master)
            adjusted%node(k) = sight%piece > 0
            if (adjusted%node(k)) then
               foot(:, k) = foot_of(mesh%x(:, k), normal(:, k), 2*length(k), master)
            else
               n_blind = n_blind + 1
            end if
            if (pair%adjust_set > 0) cycle
            ! overlaps, however deep, and gaps up to the value
            if (dot_product(foot(:, k) - mesh%x(:, k), normal(:, k)) > pair%adjust) adjusted%node(k) = .false.
         end do
         moves = merge(norm2(foot - mesh%x(:, :mesh%n_nodes), dim=1), 0.0_wp, adjusted%node)
         if (.not. any(adjusted%node)) then
            text = 'ADJUST moves no node: none of the slave is near enough'
         else if (.not. any(moves > 0.0_wp)) then
            text = 'ADJUST moves no node: '//to_text(count(adjusted%node, kind=ip))//' of the slave lie on the master'
         else
            k = maxloc(moves, dim=1, kind=ip)
            text = 'ADJUST moves '//to_text(count(moves > 0.0_wp, kind=ip))//' nodes of the slave onto the master, at most by '// &
                   to_text(moves(k), 3)//' at node '//to_text(mesh%node_id(k))
         end if
         if (n_blind > 0 .and. pair%adjust_set > 0) text = text//'; '//to_text(n_blind)//' of the set face no master'
         call report_note(context%deck, context%slaves(i), 'N-ADJUST', text, keyword='CONTACT PAIR')
         do k = 1, mesh%n_nodes
            if (adjusted%node(k)) mesh%x(:, k) = foot(:, k)
         end do
      end associate
   end subroutine adjust_pair

   !> Normals and lengths at the nodes of a slave, as of its NODAL points, whether their faces find the master whole or not.
   pure subroutine measure_nodes(mesh, faces, normal, length, turn)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces           !< in order
      real(wp), intent(out) :: normal(:, :)            !< (2, n_nodes)
      real(wp), intent(out) :: length(:)               !< (n_nodes) [L]; 0: none of the slave
      real(wp), intent(out) :: turn(:)                 !< (n_nodes) sine of the angle by which the normal is in doubt
      type(nodal_rule_t) :: rule
      integer(ip) :: i, k

      normal = 0.0_wp
      length = 0.0_wp
      turn = 0.0_wp
      do i = 1, faces%n
         rule = nodal_rule(mesh, faces%element(i), faces%face(i))
         do k = 1, rule%n
            associate (node => rule%node(k))
               normal(:, node) = normal(:, node) + rule%weight(k)*rule%normal(:, k)
               length(node) = length(node) + rule%weight(k)
               turn(node) = max(turn(node), turn_at(mesh, faces, i, rule))
            end associate
         end do
      end do
      do i = 1, mesh%n_nodes
         if (length(i) > 0.0_wp) normal(:, i) = normal(:, i)/norm2(normal(:, i))
      end do
   end subroutine measure_nodes

   !> The place of the master that is nearest to a node x, where x - foot is along the master's smoothed normal n(foot): a fixed
   !> point. Along the slave's normal first, then along the master's where that leads to, until the direction stays; the curvature
   !> times the distance is small, so each turn is less than the one before by orders of magnitude. Next to a node of the master it
   !> is that node, so that the ends of both sides stay together.
   pure function foot_of(x, normal, reach, master) result(foot)
      real(wp), intent(in) :: x(2), normal(2)
      real(wp), intent(in) :: reach                    !< length of the slave's faces [L]
      type(master_t), intent(in) :: master
      real(wp) :: foot(2), direction(2), next(2), t
      type(sight_t) :: sight
      integer(ip) :: k, side

      direction = normal
      foot = x
      do k = 1, MOST_TURNS
         sight = look_along(x, direction, reach, master)
         if (sight%piece == 0) sight = nearest_end(x, direction, master, any_side=.true.)
         if (sight%piece == 0) return
         t = min(max(sight%t, 0.0_wp), 1.0_wp)
         foot = place_at(master, sight%piece, t)
         next = -smooth_normal(master, sight%piece, t)
         if (norm2(next - direction) <= SAME_DIRECTION) exit
         direction = next
      end do
      do side = 0, 1
         associate (node => place_at(master, sight%piece, real(side, wp)))
            if (norm2(node - foot) <= AT_NODE*norm2(foot - x)) foot = node
         end associate
      end do
   end function foot_of

   !> Points all of whose slave nodes lie on the master have no gap, of what shape its faces are.
   pure subroutine close_adjusted(adjusted, points)
      type(adjusted_t), intent(in) :: adjusted         !< of the pair, by adjust_pairs
      type(contact_points_t), intent(inout) :: points  !< of the pair: some gaps become 0
      integer(ip) :: j

      if (.not. allocated(adjusted%node)) return
      do j = 1, points%n
         associate (row => points%entry(points%first(j):points%first(j + 1) - 1), &
                    coefficient => points%coefficient(points%first(j):points%first(j + 1) - 1))
            if (all(adjusted%node(row) .or. coefficient <= 0.0_wp)) points%gap(j) = 0.0_wp
         end associate
      end do
   end subroutine close_adjusted

end module atrito_adjustment
