!> *CONTACT PAIR, ADJUST=: slave nodes are moved onto the master before anything is computed, without strain.
module atrito_adjustment
   use atrito_build_context, only: build_context_t
   use atrito_check_shapes, only: check_shapes
   use atrito_deck, only: card_t, option_t, token_text
   use atrito_diagnostics, only: report_error, report_note
   use atrito_items, only: find_option, get_real
   use atrito_kinds, only: ip, wp
   use atrito_master, only: master_t, sight_t, look_along, nearest_end, smooth_normal
   use atrito_model, only: pair_t
   use atrito_nodal_points, only: pair_with_master
   use atrito_pairing, only: make_master, element_thickness
   use atrito_pieces, only: place_at
   use atrito_points, only: contact_points_t
   use atrito_references, only: report_unknown
   use atrito_sets, only: find_set
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
      type(build_context_t), intent(in) :: context
      type(card_t), intent(in) :: card
      type(pair_t), intent(inout) :: pair
      character(len=*), parameter :: WHAT = 'largest gap that is closed, a real >= 0 [L], or a node set'
      type(option_t) :: option
      character(len=:), allocatable :: text
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
         pair%adjust_set = find_set(context%model%node_sets, text)
         if (pair%adjust_set == 0) call report_unknown(context, option%value, 'node set', 'E-SET', &
                                                       context%model%node_sets%names, 'CONTACT PAIR')
      end if
   end subroutine read_adjustment

   !> Moves the nodes of all pairs that ask for it, one pair after the other.
   subroutine adjust_pairs(context, adjusted)
      type(build_context_t), intent(inout) :: context
      type(adjusted_t), allocatable, intent(out) :: adjusted(:) !< of each pair
      integer(ip) :: i

      allocate (adjusted(size(context%model%pairs)))
      if (.not. any(context%model%pairs%is_adjusted)) return
      do i = 1, size(adjusted, kind=ip)
         if (context%model%pairs(i)%is_adjusted) call adjust_pair(i, context, adjusted(i))
      end do
      call check_shapes(context%model%mesh, context)
   end subroutine adjust_pairs

   subroutine adjust_pair(i, context, adjusted)
      integer(ip), intent(in) :: i
      type(build_context_t), intent(inout) :: context
      type(adjusted_t), intent(inout) :: adjusted
      type(master_t) :: master
      type(contact_points_t) :: points
      real(wp), allocatable :: thickness(:), before(:, :)
      logical, allocatable :: is_member(:)
      integer(ip) :: k

      associate (model => context%model, pair => context%model%pairs(i))
         allocate (adjusted%node(model%mesh%n_nodes), is_member(model%mesh%n_nodes), source=.false.)
         if (pair%adjust_set > 0) is_member(model%node_sets%sets(pair%adjust_set)%members) = .true.
         call make_master(model, pair%master, master)
         thickness = element_thickness(model)
         before = model%mesh%x(:, :model%mesh%n_nodes)
         call pair_with_master(model%mesh, thickness, model%surfaces(pair%slave)%faces, model%surfaces(pair%master)%faces, &
                               master, points)
         adjusted%node(pack(points%node(:points%n), is_to_move(points, pair, is_member))) = .true.
         do k = 1, points%n
            if (.not. adjusted%node(points%node(k))) cycle
            model%mesh%x(:, points%node(k)) = foot_of(points%x(:, k), points%normal(:, k), 2*points%length(k), master)
         end do
         call tell_moves(context, i, adjusted%node, norm2(model%mesh%x(:, :model%mesh%n_nodes) - before, dim=1))
      end associate
   end subroutine adjust_pair

   !> Overlaps, however deep, and gaps up to the value; or the members of the set.
   pure function is_to_move(points, pair, is_member) result(is_chosen)
      type(contact_points_t), intent(in) :: points
      type(pair_t), intent(in) :: pair
      logical, intent(in) :: is_member(:)
      logical :: is_chosen(points%n)

      if (pair%adjust_set > 0) then
         is_chosen = is_member(points%node(:points%n))
      else
         is_chosen = points%gap(:points%n) <= pair%adjust
      end if
   end function is_to_move

   !> The place of the master that is nearest to a node: along the slave's normal first, then along the master's where that leads
   !> to. Next to a node of the master it is that node, so that the ends of both sides stay together.
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

   subroutine tell_moves(context, i, is_chosen, moves)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: i                     !< the pair
      logical, intent(in) :: is_chosen(:)
      real(wp), intent(in) :: moves(:)                 !< of each node [L]
      character(len=:), allocatable :: text
      integer(ip) :: node

      text = 'ADJUST moves no node: '
      if (.not. any(is_chosen)) then
         text = text//'none of the slave is near enough'
      else if (.not. any(moves > 0.0_wp)) then
         text = text//to_text(count(is_chosen, kind=ip))//' of the slave lie on the master'
      else
         node = maxloc(moves, dim=1, kind=ip)
         text = 'ADJUST moves '//to_text(count(moves > 0.0_wp, kind=ip))//' nodes of the slave onto the master, at most by '// &
                to_text(moves(node), 3)//' at node '//to_text(context%model%mesh%node_id(node))
      end if
      call report_note(context%deck, context%slaves(i), 'N-ADJUST', text, keyword='CONTACT PAIR')
   end subroutine tell_moves

   !> Points all of whose slave nodes lie on the master have no gap, of what shape its faces are.
   pure subroutine close_adjusted(adjusted, points)
      type(adjusted_t), intent(in) :: adjusted
      type(contact_points_t), intent(inout) :: points
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
