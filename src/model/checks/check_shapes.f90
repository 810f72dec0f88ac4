!> Shapes of the elements: the Jacobian is positive; where it is not, the likely cause.
!>
!> The Jacobian of the map x(xi) = sum N_k(xi) x_k is J = det(sum x_k grad N_k). With straight sides it is least at a corner, where
!> it is in proportion to the cross product of the two sides that meet there: the corners say all. With bent sides it is looked at
!> where it is used, at the integration points, and at the nodes.
module atrito_check_shapes
   use atrito_deck, only: deck_t, token_t
   use atrito_diagnostics, only: report_error, report_deck_error
   use atrito_build_context, only: build_context_t, place_token
   use atrito_element_table, only: SHAPES, MOST_NODES, MOST_CORNERS
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_end, turned_nodes
   use atrito_messages, only: MOST_ERRORS
   use atrito_shape_functions, only: shape_gradients, shape_values, gauss_point
   use atrito_strings, only: to_text
   use atrito_threads, only: is_shared, chunk_count, find_chunk
   implicit none (type, external)
   private
   public :: check_shapes, corner_jacobians, judge_second_degree, nearest_order
   public :: SHAPE_GOOD, SHAPE_CLOCKWISE, SHAPE_DEGENERATE, SHAPE_ORDER, SHAPE_FOLDED

   !> First degree: GOOD, CLOCKWISE or DEGENERATE. Second degree also ORDER: mid-sides and centre in another order, and FOLDED:
   !> one of them too far off.
   integer(ip), parameter :: SHAPE_GOOD = 0, SHAPE_CLOCKWISE = 1, SHAPE_DEGENERATE = 2, SHAPE_ORDER = 3, SHAPE_FOLDED = 4, &
                             SHAPE_TINY = 5
   !> A corner whose Jacobian is smaller than this part of the longest side squared is flat.
   real(wp), parameter :: FLAT = 1.0e-12_wp
   !> What is shorter has no area that is a number of the machine [L].
   real(wp), parameter :: LEAST_LENGTH = 1.0e-152_wp

contains

   !> Reports elements whose shape makes no sense: nodes in clockwise order, sides folded over each other, nothing inside; the first
   !> of them one by one, the others by their number.
   subroutine check_shapes(mesh, context)
      type(mesh_t), intent(in) :: mesh                 !< as it is solved
      type(build_context_t), intent(in) :: context     !< places in the deck, for messages
      logical, allocatable :: good(:)                  !< (runs of elements)
      integer(ip) :: run, first, last, e, shape, node, n

      allocate (good(chunk_count(mesh%n_elements)), source=.true.)
      !$omp parallel do default(none) private(first, last, e, shape, node) shared(mesh, good) if(is_shared(mesh%n_elements))
      do run = 1, size(good, kind=ip)
         call find_chunk(run, mesh%n_elements, first, last)
         do e = first, last
            call judge_shape(mesh, e, shape, node)
            if (shape /= SHAPE_GOOD) good(run) = .false.
         end do
      end do
      !$omp end parallel do
      n = 0
      do run = 1, size(good, kind=ip)
         if (good(run)) cycle
         call find_chunk(run, mesh%n_elements, first, last)
         do e = first, last
            call judge_shape(mesh, e, shape, node)
            if (shape == SHAPE_GOOD) cycle
            n = n + 1
            if (n <= MOST_ERRORS) call report_shape(context%deck, mesh, e, shape, node, place_token(context%deck, &
                                                                                                    context%elements%place(e)))
         end do
      end do
      if (n > MOST_ERRORS) call report_deck_error(context%deck, 'E-SHAPE', to_text(n - int(MOST_ERRORS, ip))// &
                           ' further elements are clockwise or degenerate', expected='corners counter-clockwise', keyword='ELEMENT')
   end subroutine check_shapes

   !> Reports an element of a bad shape, with what would do instead.
   subroutine report_shape(deck, mesh, e, shape, node, place)
      type(deck_t), intent(in) :: deck
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e, shape, node
      type(token_t), intent(in) :: place
      character(len=:), allocatable :: text, expected
      character(len=43) :: also(3)                     ! what is said of a centre, where there is one
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: corners, side

      also = [character(len=43) :: ' and centre', ', the centre', ', the centre near the middle of the element']
      corners = SHAPES(mesh%shape(e))%n_corners
      if (mesh%shape(e) <= 2*corners) also = ''
      nodes = mesh%nodes(:mesh%shape(e), e)
      associate (at_node => 'node '//to_text(mesh%node_id(nodes(node))))
         select case (shape)
         case (SHAPE_TINY)
            text = ' is so small that its area is no number of the machine'
            expected = 'a unit of length in which elements are at least '//to_text(LEAST_LENGTH)//' across'
         case (SHAPE_CLOCKWISE)
            text = ' runs clockwise'
            expected = 'corners counter-clockwise, for example '//nodes_text(mesh, turned_nodes(nodes))
         case (SHAPE_DEGENERATE)
            text = ' is degenerate: its angle at '//at_node//' is not between 0 and 180 degrees'
            expected = trim(merge('a triangle with an area ', 'a convex quadrilateral  ', corners == 3))// &
                       ', corners counter-clockwise'
         case (SHAPE_ORDER)
            text = ' folds over near '//at_node//': its mid-side nodes'//trim(also(1))//' stand in another order'
            expected = 'corners counter-clockwise, the middles of sides 1-2, 2-3, '// &
                       trim(merge('3-1     ', '3-4, 4-1', corners == 3))//trim(also(2))//': '// &
                       nodes_text(mesh, nodes(nearest_order(mesh%x(:, nodes))))
         case default                                  ! SHAPE_FOLDED
            text = ' folds over: '//at_node//', the centre, lies too far off'
            side = node - corners
            if (side <= corners) text = ' folds over: '//at_node//', the middle of the side from node '// &
                                        to_text(mesh%node_id(nodes(side)))//' to node '// &
                                        to_text(mesh%node_id(mesh%nodes(face_end(mesh, e, side), e)))//', lies too far off'
            expected = 'a mid-side node in the middle half of its side'//trim(also(3))
         end select
      end associate
      call report_error(deck, place, 'E-SHAPE', 'element '//to_text(mesh%element_id(e))//text, expected=expected, keyword='ELEMENT')
   end subroutine report_shape

   !> Numbers of nodes, with commas between them.
   pure function nodes_text(mesh, nodes) result(text)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: nodes(:)              !< places
      character(len=:), allocatable :: text
      integer(ip) :: k

      text = to_text(mesh%node_id(nodes(1)))
      do k = 2, size(nodes, kind=ip)
         text = text//', '//to_text(mesh%node_id(nodes(k)))
      end do
   end function nodes_text

   !> What is wrong with the shape of an element, and at which of its nodes.
   pure subroutine judge_shape(mesh, e, shape, node)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e
      integer(ip), intent(out) :: shape                !< SHAPE_*
      integer(ip), intent(out) :: node                 !< the worst one
      real(wp) :: x(2, MOST_NODES)
      integer(ip) :: k, n

      n = mesh%shape(e)
      do k = 1, n
         x(:, k) = mesh%x(:, mesh%nodes(k, e))
      end do
      if (SHAPES(n)%degree == 1) then
         call judge_corners(x(:, :n), shape, node)
      else
         call judge_second_degree(x(:, :n), shape, node)
      end if
      if (shape /= SHAPE_GOOD) return
      do k = 2, n
         if (any(abs(x(:, k) - x(:, 1)) >= LEAST_LENGTH)) return
      end do
      shape = SHAPE_TINY
      node = 1
   end subroutine judge_shape

   !> The same of straight sides: every corner turns to the left.
   pure subroutine judge_corners(x, shape, corner)
      real(wp), intent(in) :: x(:, :)                  !< (2, corners) [L]
      integer(ip), intent(out) :: shape                !< SHAPE_*
      integer(ip), intent(out) :: corner               !< the worst one
      real(wp) :: jacobian(size(x, 2))

      jacobian = corner_jacobians(x)
      corner = minloc(jacobian, dim=1, kind=ip)
      shape = SHAPE_GOOD
      if (jacobian(corner) > FLAT) return
      shape = SHAPE_DEGENERATE
      if (maxval(jacobian) < -FLAT) shape = SHAPE_CLOCKWISE
   end subroutine judge_corners

   !> Cross product of the two sides at each corner over the longest side squared; 1 for a square.
   pure function corner_jacobians(x) result(jacobian)
      real(wp), intent(in) :: x(:, :)                  !< (2, corners) [L]
      real(wp) :: jacobian(size(x, 2))
      real(wp) :: side(2, MOST_CORNERS), longest
      integer(ip) :: k, n

      n = size(x, 2, kind=ip)
      side = 0.0_wp
      side(:, :n - 1) = x(:, 2:) - x(:, :n - 1)
      side(:, n) = x(:, 1) - x(:, n)
      longest = max(maxval(abs(side)), tiny(1.0_wp))
      side = side/longest
      do k = 1, n
         associate (before => side(:, modulo(k - 2, n) + 1), after => side(:, k))
            jacobian(k) = before(1)*after(2) - before(2)*after(1)
         end associate
      end do
   end function corner_jacobians

   !> An element of the second degree is good when its Jacobian is positive at its integration points and nodes; at a node it may be
   !> 0, since mid-side nodes at a quarter of the sides are a known way to the tip of a crack. If it is not good, the likely cause:
   !> the corners, as in the first degree; else the order of the others, if another order would do; else the one that is farthest
   !> off.
   pure subroutine judge_second_degree(x, shape, node)
      real(wp), intent(in) :: x(:, :)                  !< (2, nodes) [L]
      integer(ip), intent(out) :: shape                !< SHAPE_*
      integer(ip), intent(out) :: node                 !< the worst one
      real(wp), parameter :: SHARE = 1.0e-6_wp         !< of the element: mid-sides and centre are where those of straight sides are
      real(wp) :: away(2, size(x, 2))
      integer(ip) :: k, corners

      corners = SHAPES(size(x, 2))%n_corners
      away = x - straight_places(x)
      call judge_corners(x(:, :corners), shape, k)
      node = k
      associate (longest => maxval(maxval(x(:, :corners), dim=2) - minval(x(:, :corners), dim=2)))
         if (shape == SHAPE_GOOD .and. all(abs(away) <= SHARE*longest)) return    ! then the corners say all of the element
      end associate
      call find_fold(x, node)
      if (node == 0) then
         shape = SHAPE_GOOD
      else if (shape /= SHAPE_GOOD) then
         node = k
      else
         shape = SHAPE_ORDER
         call find_fold(x(:, nearest_order(x)), k)
         if (k == 0) return
         shape = SHAPE_FOLDED
         away(:, :corners) = 0.0_wp
         node = maxloc(norm2(away/maxval(abs(away)), dim=1), dim=1, kind=ip)
      end if
   end subroutine judge_second_degree

   !> The node at or next to which the Jacobian is least and too small; 0: it is good everywhere.
   pure subroutine find_fold(x, node)
      real(wp), intent(in) :: x(:, :)                  !< (2, nodes) [L]
      integer(ip), intent(out) :: node
      real(wp) :: y(2, size(x, 2)), j(2, 2), least, jacobian, xi(2), weight, limit
      integer(ip) :: k, n

      n = size(x, 2, kind=ip)
      y = x - spread(x(:, 1), 2, n)
      y = y/max(maxval(abs(y)), tiny(1.0_wp))
      node = 0
      least = FLAT
      do k = 1, n + SHAPES(n)%n_points
         if (k <= n) then
            xi = SHAPES(n)%place(:, k)
            limit = -FLAT
         else
            call gauss_point(n, k - n, xi, weight)
            limit = FLAT
         end if
         j = matmul(y, shape_gradients(n, xi))
         jacobian = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
         if (jacobian >= min(least, limit)) cycle
         least = jacobian
         node = minloc(norm2(SHAPES(n)%place(:, :n) - spread(xi, 2, n), dim=1), dim=1, kind=ip)
      end do
   end subroutine find_fold

   !> Places of the nodes in the element with the same corners and straight sides.
   pure function straight_places(x) result(straight)
      real(wp), intent(in) :: x(:, :)                  !< (2, nodes) [L]
      real(wp) :: straight(2, size(x, 2))
      integer(ip) :: k

      associate (shape => SHAPES(size(x, 2)))
         do k = 1, shape%n_nodes
            straight(:, k) = matmul(x(:, :shape%n_corners), shape_values(shape%n_corners, shape%place(:, k)))
         end do
      end associate
   end function straight_places

   !> The order in which the nodes behind the corners lie nearest to where they belong: the corners, and the others.
   pure function nearest_order(x) result(order)
      real(wp), intent(in) :: x(:, :)                  !< (2, nodes) [L]
      integer(ip) :: order(size(x, 2))
      real(wp) :: place(2, size(x, 2)), distance(size(x, 2)), scale
      integer(ip) :: k, n, corners

      n = size(x, 2, kind=ip)
      corners = SHAPES(n)%n_corners
      order(:corners) = [(k, k=1, corners)]
      place = straight_places(x)
      scale = max(maxval(abs(x - spread(x(:, 1), 2, n))), tiny(1.0_wp))
      do k = corners + 1, n
         distance = norm2((x - spread(place(:, k), 2, n))/scale, dim=1)
         distance(order(:k - 1)) = huge(1.0_wp)
         order(k) = minloc(distance, dim=1, kind=ip)
      end do
   end function nearest_order

end module atrito_check_shapes
