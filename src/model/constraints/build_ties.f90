!> *TIE: surfaces that are joined. Reading, checks, the adjusting of the slave's nodes, and the bilateral rows.
module atrito_build_ties
   use atrito_bilateral_rows, only: add_row, ROW_TIE
   use atrito_build_context, only: build_context_t, ids_text, is_invalid, has_errors
   use atrito_check_shapes, only: check_shapes
   use atrito_deck, only: card_t, option_t, token_t, count_lines, line_item, keyword_name
   use atrito_diagnostics, only: report_error, report_note, report_warning
   use atrito_faces, only: face_list_t, chain_report_t
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_items, only: find_option, option_text, option_real, option_word
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes
   use atrito_model, only: model_t, tie_t, QUADRATURE_NODAL, QUADRATURE_MORTAR, SURFACE_SEGMENTS
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_pairing, only: pair_surfaces
   use atrito_plane_state, only: STATES
   use atrito_points, only: contact_points_t
   use atrito_refined_members, only: faces_of_deck
   use atrito_references, only: find_surface
   use atrito_strings, only: to_text
   use atrito_turned_points, only: first_of_master
   implicit none (type, external)
   private
   public :: read_ties, check_ties, build_ties

   character(len=*), parameter :: KEYWORD = 'TIE'
   character(len=*), parameter :: IN_FRONT = 'a master in front of the slave, its outward normal pointing back'
   real(wp), parameter :: USUAL_TOLERANCE = 0.05_wp   !< of the mean face of the master
   !> Nodes nearer than this part of the slave's faces are in one place, and there no more than a hundredth of a row on further
   !> nodes is what the curve of the sides leaves of an integral that is 0.
   real(wp), parameter :: ONE_PLACE = 1.0e-6_wp, LITTLE = 0.01_wp

contains

   !> All *TIE cards: model%ties.
   subroutine read_ties(context)
      type(build_context_t), intent(inout) :: context  !< gets ties, and so does its model
      integer(ip) :: i, n

      n = count_lines(context%deck, KEYWORD)
      allocate (context%model%ties(n), context%ties(n))
      n = 0
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == KEYWORD) call read_tie_card(context%deck%cards(i), context, n)
      end do
      context%model%ties = context%model%ties(:n)
   end subroutine read_ties

   !> *TIE: slave, master.
   subroutine read_tie_card(card, context, n)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(inout) :: n                  !< ties so far
      character(len=*), parameter :: WHAT = 'tolerance of the position, a real >= 0 [L]'
      type(option_t) :: option
      type(tie_t) :: tie
      logical :: found
      integer(ip) :: i

      call option_text(context%deck, card, 'NAME', tie%name, found)
      if (.not. found .or. .not. card%ok) return
      tie%adjusts = option_word(context%deck, card, 'ADJUST') /= 'NO'
      select case (option_word(context%deck, card, 'TYPE'))
      case ('NODE TO SURFACE')
         tie%quadrature = QUADRATURE_NODAL
      case ('SURFACE TO SURFACE')
         tie%quadrature = QUADRATURE_MORTAR
      end select
      call option_real(context%deck, card, 'POSITION TOLERANCE', WHAT, tie%tolerance, found)
      if (found .and. tie%tolerance < 0.0_wp) then
         call find_option(context%deck, card, 'POSITION TOLERANCE', option, found)
         call report_error(context%deck, option%value, 'E-VALUE', 'POSITION TOLERANCE='//to_text(tie%tolerance)//' is negative', &
                           expected=WHAT)
         return
      end if
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (.not. context%deck%lines(i)%ok) cycle
         call find_surface(context, line_item(context%deck, context%deck%lines(i), 1_ip), tie%slave)
         call find_surface(context, line_item(context%deck, context%deck%lines(i), 2_ip), tie%master)
         if (min(tie%slave, tie%master) == 0) cycle
         n = n + 1
         context%model%ties(n) = tie
         context%ties(n) = line_item(context%deck, context%deck%lines(i), 1_ip)
      end do
   end subroutine read_tie_card

   !> Checks of each tie that need none of its points.
   subroutine check_ties(context, chains)
      type(build_context_t), intent(in) :: context     !< its model's ties and surfaces are read
      type(chain_report_t), intent(in) :: chains(:)    !< of each surface
      integer(ip) :: i

      do i = 1, size(context%model%ties, kind=ip)
         call check_sides(context, context%ties(i), context%model%ties(i), chains)
      end do
   end subroutine check_ties

   subroutine check_sides(context, place, tie, chains)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: place
      type(tie_t), intent(in) :: tie
      type(chain_report_t), intent(in) :: chains(:)

      associate (slave => context%model%surfaces(tie%slave), master => context%model%surfaces(tie%master))
         if (is_invalid(context, slave%name) .or. is_invalid(context, master%name)) return
         if (tie%slave == tie%master) then
            call refuse(context, place, 'slave and master are the same surface', 'two surfaces that face each other')
         else if (slave%kind == SURFACE_SEGMENTS .or. master%kind == SURFACE_SEGMENTS) then
            call refuse(context, place, 'a drawn line cannot be tied', 'surfaces of element faces; *BOUNDARY holds nodes')
         else if (has_errors()) then
            return
         else if (min(slave%faces%n, master%faces%n) == 0) then
            call refuse(context, place, 'one of the surfaces has no faces: others join it everywhere', &
                        'surfaces on the outlines of bodies')
         else if (chains(tie%slave)%branch_node > 0 .or. chains(tie%slave)%loose_face > 0) then
            call refuse(context, place, 'the slave is not one chain of faces', &
                        'one connected chain of faces; otherwise a tie for each')
         else
            call check_shared_nodes(context, place, slave%faces, master%faces)
         end if
      end associate
   end subroutine check_sides

   subroutine refuse(context, place, text, expected)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: place
      character(len=*), intent(in) :: text, expected

      call report_error(context%deck, place, 'E-TIE', text, expected=expected)
   end subroutine refuse

   subroutine check_shared_nodes(context, place, slave, master)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: place
      type(face_list_t), intent(in) :: slave, master
      type(number_list_t) :: shared
      type(id_map_t) :: masters, found
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i, k
      logical :: known

      associate (mesh => context%model%mesh)
         do i = 1, master%n
            nodes = face_nodes(mesh, master%element(i), master%face(i))
            do k = 1, size(nodes, kind=ip)
               call add_id(masters, nodes(k), 1_ip, known)
            end do
         end do
         do i = 1, slave%n
            nodes = face_nodes(mesh, slave%element(i), slave%face(i))
            do k = 1, size(nodes, kind=ip)
               if (find_id(masters, nodes(k)) == 0) cycle
               call add_id(found, nodes(k), 1_ip, known)
               if (.not. known) call add_number(shared, mesh%node_id(nodes(k)))
            end do
         end do
      end associate
      if (shared%n > 0) call refuse(context, place, 'slave and master share node '//ids_text(numbers_of(shared)), &
                                    'surfaces that have their own nodes')
   end subroutine check_shared_nodes

   !> The rows of all ties; for models without any error. Nodes of the slaves may move.
   subroutine build_ties(context)
      type(build_context_t), intent(inout) :: context  !< its model gets bilateral rows; tolerances are set
      type(contact_points_t), allocatable :: points(:)
      logical, allocatable :: from_behind(:)
      integer(ip) :: i, tied_by(context%model%mesh%n_nodes)
      logical :: moved

      if (size(context%model%ties) == 0) return
      call set_tolerances()
      call pair_ties(context%model, points)
      from_behind = points%n == 0
      if (any(from_behind)) then
         call pair_ties(context%model, points, from_behind)
         do i = 1, size(points, kind=ip)               ! what lies farther off is no overlap
            if (from_behind(i)) from_behind(i) = any(is_near(points(i)%gap, context%model%ties(i)%tolerance, points(i)%length))
         end do
         call pair_ties(context%model, points, from_behind)
      end if
      moved = .false.
      do i = 1, size(points, kind=ip)
         ! sides that look the same way lie one over the other with their bodies
         if (from_behind(i)) call report_warning(context%deck, context%ties(i), 'W-TIE', 'the surfaces of tie '// &
                                                 context%model%ties(i)%name//' look the same way: their bodies lie over each '// &
                                                 'other, and are tied there', expected=IN_FRONT)
         call judge_points(context, i, points(i))
         if (context%model%ties(i)%adjusts) call adjust_nodes(points(i))
      end do
      if (moved) then
         call check_shapes(context%model%mesh, context)
         if (has_errors()) return
         call pair_ties(context%model, points, from_behind)
      end if
      tied_by = 0
      do i = 1, size(points, kind=ip)
         call add_tie(context, i, points(i), tied_by)
      end do

   contains

      !> Those that are left out: a part of the mean length of the master's faces, as they are in the deck.
      subroutine set_tolerances()
         integer(ip), allocatable :: own(:), nodes(:, :)
         integer(ip) :: j

         do j = 1, size(context%model%ties, kind=ip)
            if (context%model%ties(j)%tolerance >= 0.0_wp) cycle
            associate (faces => context%model%surfaces(context%model%ties(j)%master)%faces, mesh => context%model%mesh)
               if (allocated(own)) deallocate (own)
               allocate (own(faces%n))
               call faces_of_deck(mesh, context%refinement, faces, own, nodes)
               context%model%ties(j)%tolerance = USUAL_TOLERANCE*sum(norm2(mesh%x(:, nodes(2, :)) - mesh%x(:, nodes(1, :)), &
                                                                           dim=1))/size(nodes, 2)
            end associate
         end do
      end subroutine set_tolerances

      !> Moves the nodes of a slave onto the master, without strain.
      subroutine adjust_nodes(points)
         type(contact_points_t), intent(in) :: points
         real(wp), parameter :: NONE = 1.0e-9_wp          !< of the face
         real(wp) :: farthest
         integer(ip) :: j, n

         n = 0
         farthest = 0.0_wp
         do j = 1, points%n
            if (.not. is_near(points%gap(j), context%model%ties(i)%tolerance, points%length(j))) cycle
            if (abs(points%gap(j)) <= NONE*points%length(j)) cycle
            associate (x => context%model%mesh%x(:, points%node(j)))
               x = x + points%gap(j)*points%normal(:, j)
            end associate
            n = n + 1
            farthest = max(farthest, abs(points%gap(j)))
         end do
         if (n == 0) return
         moved = .true.
         call report_note(context%deck, context%ties(i), 'N-ADJUST', to_text(n)//trim(merge(' node of the slave is  ', &
                                                                                            ' nodes of the slave are', n == 1))// &
                          ' moved onto the master, by '//to_text(farthest, 4)// &
                          ' [L] at the most; ADJUST=NO leaves them where they are')
      end subroutine adjust_nodes
   end subroutine build_ties

   subroutine pair_ties(model, points, from_behind)
      type(model_t), intent(in) :: model
      type(contact_points_t), allocatable, intent(out) :: points(:)
      logical, intent(in), optional :: from_behind(:)  !< (ties) the master looks the same way as the slave

      call pair_surfaces(model, model%ties%slave, model%ties%master, model%ties%quadrature, points, from_behind)
   end subroutine pair_ties

   !> Whether a point is near enough to be tied; a gap that is round-off is.
   pure elemental logical function is_near(gap, tolerance, size)
      real(wp), intent(in) :: gap, tolerance           !< [L]
      real(wp), intent(in) :: size                     !< of the face at the point [L]
      real(wp), parameter :: NONE = 1.0e-9_wp

      is_near = abs(gap) <= max(tolerance, NONE*size)
   end function is_near

   !> Tells of faces and nodes that are not tied.
   subroutine judge_points(context, i, points)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: i                     !< the tie
      type(contact_points_t), intent(in) :: points
      character(len=:), allocatable :: name
      integer(ip) :: far, first
      real(wp) :: tolerance

      tolerance = context%model%ties(i)%tolerance
      name = context%model%ties(i)%name
      far = count(.not. is_near(points%gap, tolerance, points%length), kind=ip)
      context%model%ties(i)%n_far = far
      if (points%n == 0) then
         call refuse(context, context%ties(i), 'the surfaces of tie '//name//' do not face each other', IN_FRONT)
      else if (far == points%n) then
         call refuse(context, context%ties(i), 'no node of the slave lies within the tolerance of the master: the least '// &
                     'distance is '//to_text(minval(abs(points%gap)), 4), 'POSITION TOLERANCE='// &
                     to_text(minval(abs(points%gap)), 4)//' or more; it is '//to_text(tolerance, 4)//' here')
      else if (far > 0) then
         first = findloc(is_near(points%gap, tolerance, points%length), .false., dim=1, kind=ip)
         call report_warning(context%deck, context%ties(i), 'W-TIE', to_text(far)//' of '//to_text(points%n)//' nodes of the '// &
                             'slave are farther than '//to_text(tolerance, 4)//' from the master and are not tied, the first '// &
                             'of them node '//to_text(context%model%mesh%node_id(points%node(first))), &
                             expected='POSITION TOLERANCE=, if they are to be tied')
      end if
      if (points%n > 0 .and. points%n_left_out > 0) then
         call report_note(context%deck, context%ties(i), 'N-LEFT-OUT', to_text(points%n_left_out)//' of '// &
                          to_text(points%n_faces)//' faces of the slave face no master and are not tied')
      end if
   end subroutine judge_points

   !> Two rows for each point that is tied, along x and y. Where the places that they join are apart they join them as a rod does
   !> (add_lever), but in bodies of revolution, which do not turn in their section.
   subroutine add_tie(context, i, points, tied_by)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: i
      type(contact_points_t), intent(in) :: points
      integer(ip), intent(inout) :: tied_by(:)         !< (n_nodes) tie whose slave has the node
      type(number_list_t) :: twice
      real(wp), parameter :: NONE = 1.0e-9_wp          ! of the face
      real(wp), allocatable :: vectors(:, :)
      integer(ip) :: j, k, axis, group
      logical :: may_turn

      group = context%model%bilateral%n_groups + 1
      may_turn = all(STATES(context%model%mesh%state(1))%moves)
      do j = 1, points%n
         if (.not. is_near(points%gap(j), context%model%ties(i)%tolerance, points%length(j))) cycle
         if (tied_by(points%node(j)) > 0) call add_number(twice, context%model%mesh%node_id(points%node(j)))
         tied_by(points%node(j)) = i
         associate (first => points%first(j), last => points%first(j + 1) - 1)
            do axis = 1, 2
               vectors = reshape([(0.0_wp, k=1, 2*(last - first + 1))], [2, last - first + 1])
               vectors(axis, :) = row_of(context%model, points, j)
               if (may_turn) call add_lever(context%model%mesh%x(:, points%entry(first:last)), first_of_master(points, j) - first, &
                                            NONE*points%length(j), axis, vectors)
               call add_row(points%entry(first:last), vectors, 0.0_wp, 0.0_wp, points%weight(j), [ROW_TIE, group, i], &
                            context%model%bilateral)
            end do
         end associate
      end do
      context%model%ties(i)%n_nodes = points%n - context%model%ties(i)%n_far
      if (twice%n > 0) call refuse(context, context%ties(i), 'node '//ids_text(numbers_of(twice))// &
                                   ' is a slave in two ties', 'each node in one slave; the other tie may have it as master')
   end subroutine add_tie

   !> A row of a tie that no rigid motion of both bodies together strains, whose forces leave no moment.
   !>
   !> Its terms add up to the places x_s - x_m = d = sum_k c_k x_k, and a rotation w to w perp(d), perp(a) = (-a2, a1): by the
   !> distance of the sides, and by that of chords that stand for one curve and do not match. The rotation of the master's nodes
   !> about their mean is taken out:
   !>
   !>     w = sum_k perp(x_k - mean x) . u_k/sum_k |x_k - mean x|^2.
   pure subroutine add_lever(x, n_slave, least, axis, vectors)
      real(wp), intent(in) :: x(:, :)                  !< (2, entries) places of the nodes [L]
      integer(ip), intent(in) :: n_slave               !< entries of the slave, before those of the master
      real(wp), intent(in) :: least                    !< distance that is none [L]
      integer(ip), intent(in) :: axis                  !< of the row
      real(wp), intent(inout) :: vectors(:, :)         !< (2, entries)
      real(wp) :: away(2, size(x, 2)), d(2)
      integer(ip) :: k

      do k = 1, size(x, 2, kind=ip)
         away(:, k) = x(:, k) - x(:, size(x, 2))
      end do
      d = matmul(away, vectors(axis, :))
      if (norm2(d) <= least) return
      associate (of_master => away(:, n_slave + 1:))
         of_master = of_master - spread(sum(of_master, dim=2)/size(of_master, 2), 2, size(of_master, 2))
         if (norm2(of_master) <= least) return
         vectors(:, n_slave + 1:) = vectors(:, n_slave + 1:) &
                                    - (merge(-d(2), d(1), axis == 1)/norm2(of_master)**2) &
                                    *reshape([-of_master(2, :), of_master(1, :)], [2, size(of_master, 2)], order=[2, 1])
      end associate
   end subroutine add_lever

   !> The coefficients of a point. A node of the slave at one of the master is tied to that alone: the others have integrals of
   !> psi phi over faces on which phi is linear and 0 at the node, which are 0 on straight sides. On curved ones some 1e-4 is left
   !> of them, and where supports hold both nodes, as at a line of symmetry, that would hold the next one as well.
   pure function row_of(model, points, j) result(row)
      type(model_t), intent(in) :: model
      type(contact_points_t), intent(in) :: points
      integer(ip), intent(in) :: j
      real(wp), allocatable :: row(:)
      integer(ip) :: own, partner

      associate (nodes => points%entry(points%first(j):points%first(j + 1) - 1), x => model%mesh%x)
         row = points%coefficient(points%first(j):points%first(j + 1) - 1)
         own = findloc(nodes, points%node(j), dim=1, kind=ip)
         partner = minloc(row, 1, kind=ip)
         if (own == 0) return
         if (norm2(x(:, nodes(partner)) - x(:, nodes(own))) > ONE_PLACE*points%length(j)) return
      end associate
      if (sum(abs(row)) - abs(row(own)) - abs(row(partner)) > LITTLE) return
      row = 0.0_wp
      row(own) = 1.0_wp
      row(partner) = -1.0_wp
   end function row_of

end module atrito_build_ties
