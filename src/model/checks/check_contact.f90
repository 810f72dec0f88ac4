!> Checks of the contact pairs: first what their surfaces are, then, in a model that is right otherwise, where their points lie.
module atrito_check_contact
   use atrito_average, only: least_spacing
   use atrito_contact_roles, only: follows_polygon, polygon_angle, STIFFER
   use atrito_deck, only: token_t
   use atrito_diagnostics, only: report_error, report_warning, report_note
   use atrito_element_table, only: DEGREE_OF
   use atrito_build_context, only: build_context_t, ids_text, place_text, has_errors, is_invalid
   use atrito_face_geometry, only: has_quarter_node
   use atrito_faces, only: chain_report_t, face_list_t, face_normal, node_elements_t
   use atrito_kinds, only: ip, lp, wp, PI
   use atrito_mesh, only: mesh_t, face_end, face_nodes, side_count
   use atrito_model, only: model_t, SURFACE_SEGMENTS, QUADRATURE_AUTO, FRICTION_NONLOCAL, KERNEL_LINE
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_pairing, only: slave_stiffness
   use atrito_sorting, only: sorted_places, each_once
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: check_surfaces_of_pairs, check_points_of_pairs, note_unused_interactions

   real(wp), parameter :: LINE_SPACINGS = 3.0_wp       !< KERNEL=LINE needs so many spacings within rho

   real(wp), parameter :: FACING = -1.0e-3_wp          !< cosine of normals of faces that see each other (atrito_master)

   !> Distance of slave nodes over that of the master's from which on NODAL points are too few: of faces with two nodes 3 elements
   !> on 2 are not; of those with three only the finer side has enough, since their forces are not those of a uniform pressure.
   real(wp), parameter :: COARSE(2) = [1.6_wp, 0.8_wp]

contains

   !> What can be reported of each pair without looking for its points.
   subroutine check_surfaces_of_pairs(model, context, chains)
      type(model_t), intent(in) :: model               !< pairs, surfaces and mesh
      type(build_context_t), intent(in) :: context     !< places of pairs in the deck, for messages
      type(chain_report_t), intent(in) :: chains(:)    !< of each surface
      logical :: is_judged(size(model%surfaces))       ! it was the slave of an earlier pair
      type(number_list_t) :: shared(size(model%pairs)) ! nodes of both sides
      integer(lp) :: key(size(model%pairs))
      integer(ip) :: order(size(model%pairs)), i
      integer(ip) :: first_of(size(model%pairs))       ! the first one of the same two surfaces

      key = int(model%pairs%slave, lp)*(int(huge(1_ip), lp) + 1_lp) + int(model%pairs%master, lp)
      order = sorted_places(key)
      first_of = [(i, i=1, size(key, kind=ip))]
      do i = 2, size(key, kind=ip)
         if (key(order(i)) == key(order(i - 1))) first_of(order(i)) = first_of(order(i - 1))
      end do
      is_judged = .false.
      call list_shared_nodes(model, shared)
      do i = 1, size(model%pairs, kind=ip)
         associate (slave => model%pairs(i)%slave, master => model%pairs(i)%master, first => first_of(i))
            if (slave == master) then
               call report_error(context%deck, context%masters(i), 'E-PAIR', 'slave and master are the same surface', &
                                 expected='two surfaces that face each other', keyword='CONTACT PAIR')
            else if (first < i) then
               call report_error(context%deck, context%slaves(i), 'E-TWICE', 'this pair is given twice, first in '// &
                                 place_text(context%deck, context%slaves(first), context%slaves(i)), &
                                 expected='each pair of surfaces once', keyword='CONTACT PAIR')
            else
               call check_side(model, context, slave, context%slaves(i), .true., chains(slave), is_judged(slave))
               call check_side(model, context, master, context%masters(i), .false., chains(master), is_judged(master))
               if (model%surfaces(slave)%kind /= SURFACE_SEGMENTS .and. model%surfaces(master)%kind /= SURFACE_SEGMENTS) then
                  call check_shared_nodes(context, model, slave, master, context%masters(i), shared(i))
               end if
            end if
         end associate
      end do
   end subroutine check_surfaces_of_pairs

   !> A side has faces. A drawn line can only be a master, and that of a rigid body.
   subroutine check_side(model, context, i, place, is_slave, report, is_judged)
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: i                     !< the surface
      type(token_t), intent(in) :: place
      logical, intent(in) :: is_slave
      type(chain_report_t), intent(in) :: report       !< of the surface as a chain
      logical, intent(inout) :: is_judged              !< it was a slave before

      associate (surface => model%surfaces(i), deck => context%deck)
         if (is_invalid(context, surface%name)) return
         if (surface%kind == SURFACE_SEGMENTS .and. is_slave) then
            call report_error(deck, place, 'E-PAIR', 'surface '//surface%name//' is a drawn line and cannot be the slave', &
                              expected='a surface of element faces as slave; the rigid surface is the master', &
                              keyword='CONTACT PAIR')
         else if (surface%kind == SURFACE_SEGMENTS) then
            if (surface%is_rigid_body .or. (context%rigid_undetermined .and. has_errors())) return
            call report_error(deck, place, 'E-PAIR', 'the drawn surface '//surface%name//' belongs to no body', &
                              expected='*RIGID BODY, ANALYTICAL SURFACE='//surface%name, keyword='RIGID BODY')
         else if (surface%faces%n > 0) then
            if (is_slave .and. .not. is_judged) call check_slave(surface%faces)
            is_judged = is_judged .or. is_slave
         else if (.not. has_errors()) then              ! else elements are missing, and that was reported
            call report_error(deck, place, 'E-SURFACE', 'surface '//surface%name//' has no faces: others join it everywhere', &
                              expected='a surface on the outline of a body', keyword='CONTACT PAIR')
         end if
      end associate

   contains

      !> A slave is one chain of faces, with the middle nodes of these in their middles: where one lies at a quarter of its face,
      !> as at
      !> the tip of a crack, a node of the face has no part of the surface.
      subroutine check_slave(faces)
         type(face_list_t), intent(in) :: faces
         type(number_list_t) :: elements
         integer(ip) :: k

         if (has_errors()) return               ! the chain may be broken by what was reported already
         associate (mesh => model%mesh)
            if (report%branch_node > 0) then
               call report_error(context%deck, place, 'E-CHAIN', 'the slave branches at node '// &
                                 to_text(mesh%node_id(report%branch_node)), expected='one connected chain of faces', &
                                 keyword='CONTACT PAIR')
            else if (report%loose_face > 0) then
               call report_error(context%deck, place, 'E-CHAIN', 'the slave is not connected: face S'// &
                                 to_text(faces%face(report%loose_face))//' of element '// &
                                 to_text(mesh%element_id(faces%element(report%loose_face)))//' does not continue the others', &
                                 expected='one connected chain of faces; otherwise a pair for each', keyword='CONTACT PAIR')
            end if
            do k = 1, faces%n
               if (has_quarter_node(mesh%x(:, face_nodes(mesh, faces%element(k), faces%face(k))))) then
                  call add_number(elements, mesh%element_id(faces%element(k)))
               end if
            end do
         end associate
         if (elements%n > 0) call report_error(context%deck, place, 'E-PAIR', 'a slave face of element '// &
                                               ids_text(numbers_of(elements))//' has its middle node at a quarter of it', &
                                               expected='middle nodes in the middle of the faces of a slave', &
                                               keyword='CONTACT PAIR')
      end subroutine check_slave
   end subroutine check_side

   !> Of each pair the nodes that both sides have. Pairs of one master come together: its nodes are marked once for all of them.
   subroutine list_shared_nodes(model, shared)
      type(model_t), intent(in) :: model
      type(number_list_t), intent(inout) :: shared(:)  !< (pairs)
      integer(ip), allocatable :: master_of(:), nodes(:)   ! master_of: of each node the last master that has it
      integer(ip) :: order(size(shared)), last, p, i, k

      allocate (master_of(model%mesh%n_nodes), source=0_ip)
      order = sorted_places(int(model%pairs%master, lp))
      last = 0
      do p = 1, size(order, kind=ip)
         associate (pair => model%pairs(order(p)), faces => model%surfaces(model%pairs(order(p))%slave)%faces, &
                    others => model%surfaces(model%pairs(order(p))%master)%faces)
            do k = 1, merge(others%n, 0_ip, pair%master /= last)
               master_of(face_nodes(model%mesh, others%element(k), others%face(k))) = pair%master
            end do
            last = pair%master
            do k = 1, faces%n
               nodes = face_nodes(model%mesh, faces%element(k), faces%face(k))
               do i = 1, size(nodes, kind=ip)
                  if (master_of(nodes(i)) == pair%master) call add_number(shared(order(p)), nodes(i))
               end do
            end do
         end associate
      end do
   end subroutine list_shared_nodes

   !> Nodes of both sides: the tips of a crack, where there is no contact, or an error.
   subroutine check_shared_nodes(context, model, slave, master, place, shared)
      type(build_context_t), intent(in) :: context
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: slave, master
      type(token_t), intent(in) :: place
      type(number_list_t), intent(in) :: shared        !< of list_shared_nodes
      integer(ip), allocatable :: nodes(:)
      logical, allocatable :: is_tip(:)
      integer(ip) :: k

      if (shared%n == 0) return
      nodes = each_once(numbers_of(shared))
      allocate (is_tip(size(nodes)), source=.false.)
      ! a crack has two tips: where there are more, none of them needs to be looked at
      if (size(nodes) <= 2) is_tip = [(is_crack_tip(model%mesh, context%around, nodes(k), model%surfaces(slave)%faces, &
                                                    model%surfaces(master)%faces), k=1, size(nodes))]
      if (any(.not. is_tip)) then
         call report_error(context%deck, place, 'E-PAIR', 'slave and master share node '// &
                           ids_text(model%mesh%node_id(pack(nodes,.not. is_tip))), &
                           expected='surfaces of different bodies, each with its own nodes, or faces of a crack that end at '// &
                           'common tips', keyword='CONTACT PAIR')
      else if (.not. has_errors()) then
         call report_note(context%deck, place, 'N-TIP', 'slave and master share node '//ids_text(model%mesh%node_id(nodes))// &
                          ', the tip of a crack: there is no contact point there', keyword='CONTACT PAIR')
      end if
   end subroutine check_shared_nodes

   !> Whether one face of either side ends at a node, they face each other, and the bodies fill more than half of what is around it.
   !> The sides of a corner that points outwards are no crack, however sharp it is: between them there is the body.
   pure logical function is_crack_tip(mesh, around, node, slave, master) result(is_tip)
      type(mesh_t), intent(in) :: mesh
      type(node_elements_t), intent(in) :: around
      integer(ip), intent(in) :: node
      type(face_list_t), intent(in) :: slave, master
      integer(ip) :: own, other

      own = only_face_at(slave)
      other = only_face_at(master)
      is_tip = own > 0 .and. other > 0
      if (.not. is_tip) return
      is_tip = dot_product(face_normal(mesh, slave%element(own), slave%face(own)), &
                           face_normal(mesh, master%element(other), master%face(other))) <= FACING
      if (is_tip) is_tip = filled_angle() > PI

   contains

      !> The one face of a list that begins or ends at a node; 0 where there is none, or more.
      pure integer(ip) function only_face_at(faces) result(found)
         type(face_list_t), intent(in) :: faces
         integer(ip) :: i

         found = 0
         do i = 1, faces%n
            associate (e => faces%element(i), f => faces%face(i))
               if (all(mesh%nodes([f, face_end(mesh, e, f)], e) /= node)) cycle
            end associate
            if (found > 0) then
               found = 0
               return
            end if
            found = i
         end do
      end function only_face_at

      !> The angle that the elements round a node take there, by the chords of their sides.
      pure real(wp) function filled_angle() result(angle)
         real(wp) :: a(2), b(2)
         integer(ip) :: i, k, n

         angle = 0.0_wp
         do i = around%first(node), around%first(node + 1) - 1
            associate (corners => mesh%nodes(:side_count(mesh, around%list(i)), around%list(i)))
               n = size(corners, kind=ip)
               k = findloc(corners, node, dim=1, kind=ip)
               if (k == 0) cycle                      ! in the middle of a side, which is no corner
               a = mesh%x(:, corners(mod(k, n) + 1)) - mesh%x(:, node)
               b = mesh%x(:, corners(mod(k + n - 2, n) + 1)) - mesh%x(:, node)
               angle = angle + atan2(abs(a(1)*b(2) - a(2)*b(1)), dot_product(a, b))
            end associate
         end do
      end function filled_angle
   end function is_crack_tip

   !> Reports interactions that no pair has; for models without any error.
   subroutine note_unused_interactions(model, context)
      type(model_t), intent(in) :: model               !< all of it built
      type(build_context_t), intent(in) :: context     !< places of interactions in the deck, for messages
      logical :: is_used(size(model%interactions))
      integer(ip) :: i

      is_used = .false.
      is_used(model%pairs%interaction) = .true.
      do i = 1, size(model%interactions, kind=ip)
         if (is_used(i)) cycle
         call report_note(context%deck, context%interactions(i), 'N-UNUSED', 'no contact pair uses the surface interaction '// &
                          model%interactions(i)%name, keyword='CONTACT PAIR')
      end do
   end subroutine note_unused_interactions

   !> Judges the points of each pair; for models without any error.
   subroutine check_points_of_pairs(model, context)
      type(model_t), intent(in) :: model               !< with the points of all pairs
      type(build_context_t), intent(in) :: context     !< places in the deck, for messages
      logical :: is_judged(size(model%interactions))         ! its radius, too small for some points, was reported
      integer(ip) :: i

      is_judged = .false.
      do i = 1, size(model%pairs, kind=ip)
         if (model%points(i)%n == 0) then
            call report_blind()
         else
            call judge_points(context, model, i)
            if (.not. is_judged(model%pairs(i)%interaction)) call judge_radius(is_judged(model%pairs(i)%interaction))
         end if
      end do

   contains

      !> No face of the slave finds the master, or none has a node that is no tip of a crack.
      subroutine report_blind()
         character(len=:), allocatable :: text, expected
         real(wp) :: normal(2)

         associate (points => model%points(i), faces => model%surfaces(model%pairs(i)%slave)%faces)
            if (points%n_left_out < points%n_faces) then
               text = 'the slave has no other nodes than the tips of the crack'
               expected = 'a slave of several faces, or the other surface as the slave'
            else if (points%n_seeing > 0) then
               text = 'no face of the slave finds the master with all of its nodes: the master ends in front of '// &
                      to_text(points%n_seeing)//trim(merge(' face ', ' faces', points%n_seeing == 1))
               expected = 'a slave with finer faces, or the other surface as the slave'
            else
               normal = face_normal(model%mesh, faces%element(1), faces%face(1))
               text = 'no point of the slave finds the master: the outward normal of the slave''s first face is ('// &
                      to_text(normal(1), 3)//', '//to_text(normal(2), 3)// &
                      '), and along the normals there is no surface that faces the other way'
               expected = 'a master in front of the slave, its own normal pointing back; a drawn line faces the side at its left'
            end if
         end associate
         call report_error(context%deck, context%slaves(i), 'E-PAIR', text, expected=expected, keyword='CONTACT PAIR')
      end subroutine report_blind

      !> The radius of the average against the distance of the points.
      subroutine judge_radius(is_reported)
         logical, intent(inout) :: is_reported
         real(wp) :: spacing

         associate (law => model%interactions(model%pairs(i)%interaction), &
                    place => context%interactions(model%pairs(i)%interaction))
            if (law%friction /= FRICTION_NONLOCAL .or. .not. law%rho > 0.0_wp) return
            spacing = least_spacing(model%points(i)%x)
            is_reported = law%rho < spacing .or. (law%kernel == KERNEL_LINE .and. law%rho < LINE_SPACINGS*spacing)
            if (law%rho < spacing) then
               call report_note(context%deck, place, 'N-RADIUS', 'rho = '//to_text(law%rho)// &
                                ' is less than the least distance of '//'contact points, '//to_text(spacing)// &
                                ': the average leaves the pressure as it is', keyword='FRICTION')
            else if (is_reported) then
               call report_warning(context%deck, place, 'W-RADIUS', 'rho = '//to_text(law%rho)// &
                                   ' is less than three distances of '//'contact points, '//to_text(spacing)// &
                                   ': with KERNEL=LINE a uniform pressure does not stay '//'uniform', expected='rho >= '// &
                                   to_text(LINE_SPACINGS*spacing)//' [L], or KERNEL=POINTS', keyword='FRICTION')
            end if
         end associate
      end subroutine judge_radius
   end subroutine check_points_of_pairs

   !> Notes what the points of a pair leave out, and by which quadrature they are; warns of a coarse slave.
   subroutine judge_points(context, model, i)
      type(build_context_t), intent(in) :: context
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                     !< the pair
      character(len=:), allocatable :: sides           ! of a pair that the deck does not give
      integer(ip) :: degree                            ! of the slave's faces

      sides = ''
      associate (points => model%points(i), pair => model%pairs(i), place => context%slaves(i))
         if (pair%outline > 0) sides = 'of '//model%surfaces(pair%slave)%name//' on '//model%surfaces(pair%master)%name//' '
         if (points%n_left_out > 0) call report_note(context%deck, place, 'N-LEFT-OUT', to_text(points%n_left_out)//' of '// &
                                                     to_text(points%n_faces)//' faces of the slave are left out: a point of '// &
                                                     'them finds no master', keyword='CONTACT PAIR')
         if (points%is_mortar .and. pair%quadrature == QUADRATURE_AUTO) then
            call report_note(context%deck, place, 'N-MORTAR', 'the nodes of the two sides '//sides// &
                             'do not match: QUADRATURE=MORTAR', keyword='CONTACT PAIR')
         end if
         degree = DEGREE_OF(model%mesh%shape(model%surfaces(pair%slave)%faces%element(1)))
         if (points%coarseness > COARSE(degree) .and. .not. (points%is_mortar .or. points%matching)) then
            call report_warning(context%deck, place, 'W-COARSE-SLAVE', 'at node ' &
                                //to_text(model%mesh%node_id(points%coarse_node))//' the nodes of the slave '//sides// &
                                'lie '//to_text(points%coarseness, 2)//' times as far apart as those of the master, and with '// &
                                'QUADRATURE=NODAL '//trim(merge('nothing keeps the master out between them           ', &
                                                                'pressures on faces of three nodes may be off by 40 %', &
                                                                points%coarseness > COARSE(1))), &
                                expected='QUADRATURE=MORTAR'//trim(merge(', or the finer side as slave', repeat(' ', 28), &
                                                                         can_be_master())), keyword='CONTACT PAIR')
         end if
      end associate

   contains

      !> Whether the pressures of the other side are stable: that is not much stiffer, and no polygon is its master.
      logical function can_be_master() result(can)
         real(wp) :: stiffness

         stiffness = slave_stiffness(model, i)
         can = stiffness*STIFFER > 1.0_wp
         if (can) can = .not. follows_polygon(1/stiffness, model%points(i)%coarseness, &
                                              polygon_angle(model%mesh, model%surfaces(model%pairs(i)%slave)%faces))
      end function can_be_master
   end subroutine judge_points

end module atrito_check_contact
