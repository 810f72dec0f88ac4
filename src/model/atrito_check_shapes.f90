!> Shapes of the elements: the Jacobian is positive; where it is not, the likely cause.
module atrito_check_shapes
   use atrito_deck, only: deck_t, token_t
   use atrito_diagnostics, only: report_error, report_deck_error
   use atrito_draft, only: draft_t, place_token
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_end, FACES, Q1_NODES, Q2_NODES
   use atrito_messages, only: MOST_ERRORS
   use atrito_shape_functions, only: shape_gradients, shape_values, gauss_point, gauss_count
   use atrito_strings, only: to_text
   use atrito_threads, only: is_shared, run_count, find_run
   implicit none (type, external)
   private
   public :: check_shapes, corner_jacobians, judge_nine_nodes, nine_node_order
   public :: SHAPE_GOOD, SHAPE_CLOCKWISE, SHAPE_DEGENERATE, SHAPE_ORDER, SHAPE_FOLDED

   !> Q1: GOOD, CLOCKWISE or DEGENERATE. Q2 also ORDER: mid-sides and centre in another order, and FOLDED: one of them too far off.
   integer(ip), parameter :: SHAPE_GOOD = 0, SHAPE_CLOCKWISE = 1, SHAPE_DEGENERATE = 2, SHAPE_ORDER = 3, SHAPE_FOLDED = 4
   !> A corner whose Jacobian is smaller than this part of the longest side squared is flat.
   real(wp), parameter :: FLAT = 1.0e-12_wp
   integer(ip), parameter :: MIDDLES = Q2_NODES - FACES      !< mid-sides and centre
   !> Where the nodes of a nine-node element lie in [-1,1]^2.
   real(wp), parameter :: NODE_PLACE(2, Q2_NODES) = reshape([real(wp) :: -1, -1, 1, -1, 1, 1, -1, 1, 0, -1, 1, 0, 0, 1, &
                                                                                                        -1, 0, 0, 0], [2, Q2_NODES])

contains

   subroutine check_shapes(mesh, draft)
      type(mesh_t), intent(in) :: mesh
      type(draft_t), intent(in) :: draft
      logical, allocatable :: good(:)                  !< (runs of elements)
      integer(ip) :: run, first, last, e, shape, node, n

      allocate (good(run_count(mesh%n_elements)))
      !$omp parallel do default(none) private(first, last) shared(mesh, good) if(is_shared(mesh%n_elements))
      do run = 1, size(good, kind=ip)
         call find_run(run, mesh%n_elements, first, last)
         good(run) = all_good(mesh, first, last)
      end do
      !$omp end parallel do
      n = 0
      do run = 1, size(good, kind=ip)
         if (good(run)) cycle
         call find_run(run, mesh%n_elements, first, last)
         do e = first, last
            call judge_shape(mesh, e, shape, node)
            if (shape == SHAPE_GOOD) cycle
            n = n + 1
            if (n <= MOST_ERRORS) call report_shape(draft%deck, mesh, e, shape, node, place_token(draft%deck, &
                                                                                                  draft%element_place(e)))
         end do
      end do
      if (n > MOST_ERRORS) call report_deck_error(draft%deck, 'E-SHAPE', to_text(n - int(MOST_ERRORS, ip))// &
                           ' further elements are clockwise or degenerate', expected='corners counter-clockwise', keyword='ELEMENT')
   end subroutine check_shapes

   !> Whether some elements, one after the other, all have a good shape.
   pure logical function all_good(mesh, first, last)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: first, last
      integer(ip) :: e, shape, node

      all_good = .false.
      do e = first, last
         call judge_shape(mesh, e, shape, node)
         if (shape /= SHAPE_GOOD) return
      end do
      all_good = .true.
   end function all_good

   subroutine report_shape(deck, mesh, e, shape, node, place)
      type(deck_t), intent(in) :: deck
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e, shape, node
      type(token_t), intent(in) :: place
      character(len=:), allocatable :: name, at_node

      name = 'element '//to_text(mesh%element_id(e))
      at_node = 'node '//to_text(mesh%node_id(mesh%nodes(node, e)))
      select case (shape)
      case (SHAPE_CLOCKWISE)
         call report_error(deck, place, 'E-SHAPE', name//' runs clockwise', expected='corners counter-clockwise, for example '// &
                           nodes_text(mesh, e, [1, 4, 3, 2, 8, 7, 6, 5, 9]), keyword='ELEMENT')
      case (SHAPE_DEGENERATE)
         call report_error(deck, place, 'E-SHAPE', name//' is degenerate: its angle at '//at_node// &
                           ' is not between 0 and 180 degrees', &
                           expected='a convex quadrilateral, corners counter-clockwise', keyword='ELEMENT')
      case (SHAPE_ORDER)
         call report_error(deck, place, 'E-SHAPE', name//' folds over near '//at_node// &
                           ': its mid-side nodes and centre stand in another order', &
                           expected='corners counter-clockwise, the middles of sides 1-2, 2-3, 3-4, 4-1, the centre: '// &
                           nodes_text(mesh, e, nine_node_order(mesh%x(:, mesh%nodes(:, e)))), keyword='ELEMENT')
      case (SHAPE_FOLDED)
         call report_error(deck, place, 'E-SHAPE', name//' folds over: '//at_node//', the '//role_text(mesh, e, node)// &
                           ', lies too far off', expected='a mid-side node in the middle half of its side, the centre '// &
                           'near the middle of the element', keyword='ELEMENT')
      end select
   end subroutine report_shape

   !> What a node of a nine-node element is.
   pure function role_text(mesh, e, node) result(text)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e, node               !< node > 4
      character(len=:), allocatable :: text
      integer(ip) :: side

      text = 'centre'
      if (node == Q2_NODES) return
      side = node - FACES
      text = 'middle of the side from node '//to_text(mesh%node_id(mesh%nodes(side, e)))//' to node '// &
             to_text(mesh%node_id(mesh%nodes(face_end(side), e)))
   end function role_text

   !> The nodes of an element in some order.
   pure function nodes_text(mesh, e, order) result(text)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e, order(:)
      character(len=:), allocatable :: text
      integer(ip) :: k

      text = to_text(mesh%node_id(mesh%nodes(order(1), e)))
      do k = 2, mesh%shape(e)
         text = text//', '//to_text(mesh%node_id(mesh%nodes(order(k), e)))
      end do
   end function nodes_text

   pure subroutine judge_shape(mesh, e, shape, node)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e
      integer(ip), intent(out) :: shape                !< SHAPE_*
      integer(ip), intent(out) :: node                 !< 1..9, the worst one
      real(wp) :: x(2, Q2_NODES)
      integer(ip) :: k

      do k = 1, mesh%shape(e)
         x(:, k) = mesh%x(:, mesh%nodes(k, e))
      end do
      if (mesh%shape(e) == Q1_NODES) then
         call judge_corners(x(:, :FACES), shape, node)
      else
         call judge_nine_nodes(x, shape, node)
      end if
   end subroutine judge_shape

   pure subroutine judge_corners(x, shape, corner)
      real(wp), intent(in) :: x(2, FACES)              !< [L]
      integer(ip), intent(out) :: shape                !< SHAPE_*
      integer(ip), intent(out) :: corner               !< the worst one
      real(wp) :: jacobian(FACES)

      jacobian = corner_jacobians(x)
      corner = minloc(jacobian, dim=1, kind=ip)
      shape = SHAPE_GOOD
      if (jacobian(corner) > FLAT) return
      shape = SHAPE_DEGENERATE
      if (maxval(jacobian) < -FLAT) shape = SHAPE_CLOCKWISE
   end subroutine judge_corners

   !> Cross product of the two sides at each corner over the longest side squared; 1 for a square.
   pure function corner_jacobians(x) result(jacobian)
      real(wp), intent(in) :: x(2, FACES)              !< corners [L]
      real(wp) :: jacobian(FACES)
      real(wp) :: side(2, FACES), longest
      integer(ip) :: k

      side(:, :FACES - 1) = x(:, 2:) - x(:, :FACES - 1)
      side(:, FACES) = x(:, 1) - x(:, FACES)
      longest = max(maxval(abs(side)), tiny(1.0_wp))
      side = side/longest
      do k = 1, FACES
         associate (before => side(:, modulo(k - 2, FACES) + 1), after => side(:, k))
            jacobian(k) = before(1)*after(2) - before(2)*after(1)
         end associate
      end do
   end function corner_jacobians

   !> A nine-node element is good when its Jacobian is positive at its integration points and nodes; at a node it may be 0, since
   !> mid-side nodes at a quarter of the sides are a known way to the tip of a crack. If it is not good, the likely cause: the
   !> corners, as for four nodes; else the order of the others, if another order would do; else the one that is farthest off.
   pure subroutine judge_nine_nodes(x, shape, node)
      real(wp), intent(in) :: x(2, Q2_NODES)           !< [L]
      integer(ip), intent(out) :: shape                !< SHAPE_*
      integer(ip), intent(out) :: node                 !< 1..9, the worst one
      real(wp) :: away(2, MIDDLES)
      integer(ip) :: k, order(Q2_NODES)

      shape = SHAPE_GOOD
      node = 0
      if (has_straight_sides(x)) then
         call judge_corners(x(:, :FACES), shape, node)
         if (shape == SHAPE_GOOD) return
      end if
      shape = SHAPE_GOOD
      call find_fold(x, node)
      if (node == 0) return
      order = nine_node_order(x)
      call judge_corners(x(:, :FACES), shape, k)
      if (shape /= SHAPE_GOOD) then
         node = k
         return
      end if
      call find_fold(x(:, order), k)
      if (k == 0) then
         shape = SHAPE_ORDER
         return
      end if
      shape = SHAPE_FOLDED
      away = x(:, FACES + 1:) - straight_places(x(:, :FACES))
      node = FACES + maxloc(norm2(away/maxval(abs(away)), dim=1), dim=1, kind=ip)
   end subroutine judge_nine_nodes

   !> Whether mid-sides and centre are where those of straight sides are: then the corners say all of the element.
   pure logical function has_straight_sides(x) result(straight)
      real(wp), intent(in) :: x(2, Q2_NODES)           !< [L]
      real(wp), parameter :: SHARE = 1.0e-6_wp         !< of the element
      real(wp) :: tolerance
      integer(ip) :: k

      straight = .false.
      tolerance = SHARE*max(maxval(abs(x(:, 3) - x(:, 1))), maxval(abs(x(:, 4) - x(:, 2))))
      do k = 1, FACES
         if (any(abs(x(:, FACES + k) - 0.5_wp*(x(:, k) + x(:, mod(k, FACES) + 1))) > tolerance)) return
      end do
      straight = all(abs(x(:, Q2_NODES) - 0.25_wp*(x(:, 1) + x(:, 2) + x(:, 3) + x(:, 4))) <= tolerance)
   end function has_straight_sides

   !> The node at or next to which the Jacobian is least and too small; 0: it is good everywhere.
   pure subroutine find_fold(x, node)
      real(wp), intent(in) :: x(2, Q2_NODES)
      integer(ip), intent(out) :: node
      real(wp) :: y(2, Q2_NODES), least, jacobian, xi(2), weight, limit
      integer(ip) :: k

      y = x - spread(x(:, 1), 2, Q2_NODES)
      y = y/max(maxval(abs(y)), tiny(1.0_wp))
      node = 0
      least = FLAT
      do k = 1, Q2_NODES + gauss_count(Q2_NODES)**2
         if (k <= Q2_NODES) then
            xi = NODE_PLACE(:, k)
            limit = -FLAT
         else
            call gauss_point(Q2_NODES, k - Q2_NODES, xi, weight)
            limit = FLAT
         end if
         jacobian = jacobian_at(y, xi)
         if (jacobian >= min(least, limit)) cycle
         least = jacobian
         node = minloc(norm2(NODE_PLACE - spread(xi, 2, Q2_NODES), dim=1), dim=1, kind=ip)
      end do
   end subroutine find_fold

   pure real(wp) function jacobian_at(x, xi) result(jacobian)
      real(wp), intent(in) :: x(2, Q2_NODES), xi(2)
      real(wp) :: j(2, 2)

      j = matmul(x, shape_gradients(Q2_NODES, xi))
      jacobian = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
   end function jacobian_at

   !> Places of mid-sides and centre in the quadrilateral with straight sides.
   pure function straight_places(corners) result(x)
      real(wp), intent(in) :: corners(2, FACES)
      real(wp) :: x(2, MIDDLES)
      integer(ip) :: k

      do k = 1, MIDDLES
         x(:, k) = matmul(corners, shape_values(Q1_NODES, NODE_PLACE(:, FACES + k)))
      end do
   end function straight_places

   !> The order in which the mid-sides and the centre lie nearest to where they belong: 1, 2, 3, 4 and five others.
   pure function nine_node_order(x) result(order)
      real(wp), intent(in) :: x(2, Q2_NODES)           !< [L]
      integer(ip) :: order(Q2_NODES)
      real(wp) :: place(2, MIDDLES), distance(Q2_NODES), scale
      integer(ip) :: k

      order(:FACES) = [(k, k=1, FACES)]
      place = straight_places(x(:, :FACES))
      scale = max(maxval(abs(x - spread(x(:, 1), 2, Q2_NODES))), tiny(1.0_wp))
      do k = 1, MIDDLES
         distance = norm2((x - spread(place(:, k), 2, Q2_NODES))/scale, dim=1)
         distance(order(:FACES + k - 1)) = huge(1.0_wp)
         order(FACES + k) = minloc(distance, dim=1, kind=ip)
      end do
   end function nine_node_order

end module atrito_check_shapes
