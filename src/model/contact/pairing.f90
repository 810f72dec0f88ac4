!> Pairs of a model: their slaves in order, and their points.
!>
!> Points of contact at ends of the sides of a pair where its own points stand inside them, for questions of balance.
!>
!> The points of a pair belong to the slave's nodes. Where a side hangs over the end of the other one the last of them stands inside
!> that end, by up to a face, or its mean is taken there: the forces of contact end too early, and loads that the end would take are
!> said to be out of balance. A point where the end of one side is across from the place t of a face of the other one has the row
!>
!>     +- (u_end - sum_a phi_a(t) u_a),
!>
!> and a force there takes part as at any other point. An end is one of a chain, or a convex corner of the master. Across is along
!> the normal at the end, but where the sides may slide along each other (atrito_sliding_motions) across that motion: from the
!> centre of a pin, or upright on the plane that a wheel stands on. A rotation moves neither of the two places along it then, and no
!> corner of chords holds what is free to turn or to roll away.
module atrito_pairing
   use atrito_faces, only: face_list_t, chain_report_t, order_chain
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_master, only: master_t, master_of_faces, master_of_segments, turn_master, sight_t, look_along
   use atrito_mesh, only: is_revolved, mesh_t, face_nodes
   use atrito_model, only: model_t, SURFACE_SEGMENTS, QUADRATURE_NODAL, QUADRATURE_MORTAR, elasticity_of
   use atrito_mortar_points, only: pair_by_mortar
   use atrito_nodal_points, only: pair_with_master
   use atrito_pieces, only: normal_at, place_at, END_TOLERANCE
   use atrito_plane_state, only: compliance_matrix, COMPONENTS
   use atrito_points, only: contact_points_t, sliding_t, allocate_points, add_entries, insert_point
   use atrito_shape_functions, only: face_shape_values
   use atrito_sliding_motions, only: chords_t, list_chords, find_sliding, note_doubt, printed_digit_error, serves, adopted, &
                                     sharpness, velocity
   use atrito_sorting, only: sorted_places
   implicit none (type, external)
   private
   public :: order_slaves, pair_all, pair_surfaces, make_master, slave_stiffness, add_end_points

   !> Most entries of such a point: a face of either side.
   integer(ip), parameter :: MOST_ENTRIES = 6
   !> How far from an end its side must face the other one, of the shorter face, and the length of a point there, of the slave's.
   real(wp), parameter :: NEAR = 0.01_wp
   real(wp), parameter :: ROUND_OFFS = 8.0_wp        !< of a distance

contains

   !> Puts the faces of slaves into the order of their chains; reports: of each surface, what is wrong with its chain.
   subroutine order_slaves(model, reports)
      type(model_t), intent(inout) :: model                        !< faces of its slaves change their order
      type(chain_report_t), allocatable, intent(out) :: reports(:) !< (surfaces) of what is no slave nothing is told
      logical :: is_slave(size(model%surfaces))
      integer(ip) :: i

      is_slave = .false.
      is_slave(model%pairs%slave) = .true.
      if (allocated(model%ties)) is_slave(model%ties%slave) = .true.
      allocate (reports(size(model%surfaces)))
      do i = 1, size(model%surfaces, kind=ip)
         associate (surface => model%surfaces(i))
            if (.not. is_slave(i) .or. surface%kind == SURFACE_SEGMENTS .or. surface%faces%n == 0) cycle
            call order_chain(model%mesh, surface%faces, reports(i))
         end associate
      end do
   end subroutine order_slaves

   !> The points of all pairs. Each has two surfaces that are what a slave and a master must be, the slave in its order; a master is
   !> made once for all of its pairs. In the plane the sides of a pair may slide along themselves in a motion of the whole body:
   !> pairs that have the same one but for digits, as rings in rings, take that of the one which tells it most sharply.
   subroutine pair_all(model, points)
      type(model_t), intent(in) :: model         !< surfaces, sections and mesh are read
      type(contact_points_t), allocatable, intent(out) :: points(:) !< of each pair; n is 0 where it faces nothing
      type(chords_t), allocatable :: chords(:)
      type(sliding_t) :: motions(size(model%pairs))
      integer(lp) :: sharp(size(model%pairs))
      integer(ip) :: order(size(model%pairs)), i, k, n

      call pair_surfaces(model, model%pairs%slave, model%pairs%master, model%pairs%quadrature, points, chords=chords)
      if (is_revolved(model%mesh)) return
      sharp = 0
      do i = 1, size(points, kind=ip)
         if (points(i)%n > 0) call find_sliding(chords(i), points(i)%sliding)
         if (points(i)%sliding%exists) sharp(i) = sharpness(chords(i), points(i)%sliding)
      end do
      order = sorted_places(-sharp)
      n = 0
      do i = 1, size(points, kind=ip)
         associate (own => chords(order(i)), sliding => points(order(i))%sliding)
            if (.not. sliding%exists) cycle
            do k = 1, n
               if (serves(own, motions(k), sliding)) exit
            end do
            if (k <= n) then
               sliding = adopted(motions(k), sliding)
            else
               n = n + 1
               motions(n) = sliding
            end if
         end associate
      end do
   end subroutine pair_all

   !> The same of any pairs of surfaces, by their places.
   subroutine pair_surfaces(model, slaves, partners, quadrature, points, from_behind, chords)
      type(model_t), intent(in) :: model               !< surfaces, sections and mesh are read
      integer(ip), intent(in) :: slaves(:), partners(:) !< slaves and masters
      integer(ip), intent(in) :: quadrature(:)         !< QUADRATURE_*
      type(contact_points_t), allocatable, intent(out) :: points(:) !< of each pair; n is 0 where it faces nothing
      logical, intent(in), optional :: from_behind(:)  !< the master's outside is taken for its inside; default: nowhere
      type(chords_t), allocatable, intent(out), optional :: chords(:) !< of the pairs
      type(master_t), allocatable, target :: masters(:) ! of the surfaces
      type(master_t), target :: turned
      type(master_t), pointer :: master
      logical :: is_master(size(model%surfaces)), is_done
      real(wp), allocatable :: thickness(:)            ! of the elements [L]
      real(wp) :: digit_error                          ! of coordinates of few digits [L]
      integer(ip) :: i

      allocate (points(size(slaves)), masters(size(model%surfaces)))
      if (present(chords)) allocate (chords(size(slaves)))
      if (size(points) == 0) return
      digit_error = max(printed_digit_error(model%mesh%x), model%mesh%digit_error)
      if (digit_error <= EPS_MACH*maxval(abs(model%mesh%x))) digit_error = 0.0_wp
      thickness = model%sections(model%section_of)%thickness
      is_master = .false.
      is_master(partners) = .true.
      do i = 1, size(masters, kind=ip)
         if (is_master(i)) call make_master(model, i, masters(i), digit_error)
      end do
      do i = 1, size(points, kind=ip)
         associate (slave => model%surfaces(slaves(i))%faces, others => model%surfaces(partners(i))%faces, mesh => model%mesh)
            master => masters(partners(i))
            if (present(from_behind)) then
               if (from_behind(i)) then
                  turned = master
                  call turn_master(turned)
                  master => turned
               end if
            end if
            ! by the quadrature that is asked for; else MORTAR where the sides do not match
            is_done = .false.
            if (quadrature(i) /= QUADRATURE_MORTAR) then
               call pair_with_master(mesh, thickness, slave, others, master, points(i))
               is_done = quadrature(i) == QUADRATURE_NODAL .or. points(i)%rigid .or. (points(i)%matching .and. points(i)%n > 0)
            end if
            if (.not. is_done) call pair_by_mortar(mesh, thickness, slave, others, master, face_compliance(model, slave), &
                                                   face_compliance(model, others), points(i))
            if (present(chords)) then
               call list_chords(mesh, slave, others, masters(partners(i)), points(i), digit_error, chords(i))
               call note_doubt(mesh, slave, others, chords(i)%digit_error, points(i))
            end if
         end associate
      end do
   end subroutine pair_surfaces

   !> A surface as the master of pairs: its faces or segments, with what finds the nearest of them.
   subroutine make_master(model, i, master, digit_error)
      type(model_t), intent(in) :: model               !< surfaces and mesh are read
      integer(ip), intent(in) :: i                     !< the surface
      type(master_t), intent(out) :: master            !< of faces, or of segments and arcs
      real(wp), intent(in), optional :: digit_error    !< to which the nodes of the mesh are known [L]; left out: all digits

      associate (surface => model%surfaces(i))
         if (surface%kind == SURFACE_SEGMENTS) then
            call master_of_segments(surface%points, master, surface%is_arc, surface%centre)
         else
            call master_of_faces(model%mesh, surface%faces, master, digit_error)
         end if
         if (present(digit_error)) master%digit_error = digit_error
      end associate
   end subroutine make_master

   !> How much the surface of a half plane gives way [L^2/F], of the material behind each face: 1/E* of Hertz, which is
   !> (1 - mu^2)/E in plane strain and 1/E in plane stress; of an orthotropic material the mean of its two axes.
   pure function face_compliance(model, faces) result(compliance)
      type(model_t), intent(in) :: model
      type(face_list_t), intent(in) :: faces
      real(wp) :: compliance(faces%n), c(COMPONENTS, COMPONENTS)
      integer(ip) :: i

      do i = 1, faces%n
         associate (section => model%sections(model%section_of(faces%element(i))))
            c = compliance_matrix(elasticity_of(section, model%materials(section%material)), model%mesh%state(faces%element(i)))
         end associate
         compliance(i) = 0.5_wp*(c(1, 1) + c(2, 2))    ! of an isotropic material they are the same
      end do
   end function face_compliance

   !> How many times as stiff the slave of a pair is as its master, in the mean along their sides; 0 of a rigid master.
   pure real(wp) function slave_stiffness(model, i) result(stiffness)
      type(model_t), intent(in) :: model               !< surfaces, sections and mesh are read
      integer(ip), intent(in) :: i                     !< the pair

      stiffness = 0.0_wp
      associate (slave => model%surfaces(model%pairs(i)%slave), master => model%surfaces(model%pairs(i)%master))
         if (min(slave%faces%n, master%faces%n) == 0 .or. master%kind == SURFACE_SEGMENTS) return
         stiffness = sum(face_compliance(model, master%faces))/master%faces%n &
                     /(sum(face_compliance(model, slave%faces))/slave%faces%n)
      end associate
   end function slave_stiffness

   !> Adds them to the points of all pairs in the plane whose gaps are those of the coordinates.
   subroutine add_end_points(model, places)
      type(model_t), intent(inout) :: model                        !< its points of contact grow
      real(wp), allocatable, intent(out), optional :: places(:, :) !< (2, points added) [L]
      type(master_t) :: sides(2)                     ! slave, master
      real(wp), allocatable :: added(:, :)
      integer(ip), allocatable :: joint(:, :)
      integer(ip) :: i, k, p

      allocate (added(2, 0))
      do i = 1, size(model%pairs, kind=ip)
         if (model%points(i)%n == 0 .or. model%pairs(i)%gap_is_given .or. is_revolved(model%mesh)) cycle
         call make_master(model, model%pairs(i)%slave, sides(1))
         call make_master(model, model%pairs(i)%master, sides(2))
         joint = joints_of(model%mesh, model%surfaces(model%pairs(i)%master)%faces, sides(2))
         do p = 1, sides(2)%n
            do k = 1, 2
               if (is_end(sides(2), joint, k, p)) call add_point(2, k, p)
            end do
         end do
         call add_point(1, 1_ip, 1_ip)
         call add_point(1, 2_ip, sides(1)%n)
      end do
      if (present(places)) call move_alloc(added, places)

   contains

      !> The point at an end of one side, unless it faces nothing or one is there.
      subroutine add_point(side, k, p)
         integer, intent(in) :: side                 !< 1 slave, 2 master
         integer(ip), intent(in) :: k, p             !< end 1 or 2 of its piece
         type(contact_points_t) :: one

         call find_point(i, side, k, p, one)
         if (one%n == 0) return
         call insert_point(one, model%points(i))
         added = reshape([added, one%x(:, :1)], [2, size(added, 2) + 1])
      end subroutine add_point

      !> The point at an end of one side. n = 0: the end faces no place between two nodes of the other one, or what is beside it
      !> faces
      !> nothing, or there is a point already.
      subroutine find_point(pair, side, k, p, one)
         integer(ip), intent(in) :: pair
         integer, intent(in) :: side                    !< which one ends
         integer(ip), intent(in) :: k, p                !< at end 1 or 2 of this piece
         type(contact_points_t), intent(out) :: one
         type(sight_t) :: sight, beside
         real(wp) :: end(2), x(2), normal(2), across(2), inwards(2), t(2), reach
         integer(ip) :: j, pieces(2)

         end = place_at(sides(side), p, real(k - 1, wp))
         normal = normal_at(sides(side), p, real(k - 1, wp))
         inwards = (3 - 2*k)*sides(side)%d(:, p)
         across = normal_across(model%points(pair)%sliding, end, normal)
         sight = look_along(end, across, norm2(inwards), sides(3 - side))
         if (sight%piece == 0) return
         pieces(side) = p
         pieces(3 - side) = sight%piece
         t(side) = real(k - 1, wp)
         t(3 - side) = sight%t
         x = place_at(sides(1), pieces(1), t(1))
         normal = normal_across(model%points(pair)%sliding, x, normal_at(sides(1), pieces(1), t(1)))
         associate (points => model%points(pair), face => norm2(sides(1)%d(:, pieces(1))))
            reach = min(face, norm2(sides(2)%d(:, pieces(2))))
            beside = look_along(end + (NEAR*reach/norm2(inwards))*inwards, across, reach, sides(3 - side))
            if (beside%piece == 0 .or. abs(sight%distance) > face) return
            if (minval(norm2(points%x(:, :points%n) - spread(x, 2, int(points%n)), dim=1)) <= 2*END_TOLERANCE*reach) return
            call allocate_points(1_ip, MOST_ENTRIES, one)
            one%n = 1
            one%x(:, 1) = x
            one%normal(:, 1) = normal
            one%gap = dot_product(place_at(sides(2), pieces(2), t(2)) - x, normal)
            if (abs(one%gap(1)) <= ROUND_OFFS*EPS_MACH*maxval(abs(x))) one%gap = 0.0_wp
            one%length = NEAR*face
            one%s = sum(norm2(sides(1)%d(:, :pieces(1) - 1), dim=1)) + t(1)*face
            j = minloc(abs(points%s(:points%n) - one%s(1)), dim=1, kind=ip)
            one%weight = one%length*points%weight(j)/points%length(j)
            if (allocated(points%doubt)) one%doubt = points%doubt(j:j)
            one%first(2) = 1
            associate (slave => model%surfaces(model%pairs(pair)%slave)%faces, &
                       master => model%surfaces(model%pairs(pair)%master)%faces)
               call add_face(model%mesh, slave, pieces(1), t(1), 1.0_wp, one)
               if (.not. sides(2)%rigid) call add_face(model%mesh, master, pieces(2), t(2), -1.0_wp, one)
            end associate
            one%node = one%entry(1)
         end associate
      end subroutine find_point
   end subroutine add_end_points

   !> What the ends of each piece are, the same number where two pieces meet: nodes of faces, or ends of segments.
   pure function joints_of(mesh, faces, master) result(joint)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces         !< of the master; n = 0: it is rigid
      type(master_t), intent(in) :: master
      integer(ip) :: joint(2, master%n), nodes(3), p

      do p = 1, master%n
         joint(:, p) = [p, p + 1]
         if (master%rigid) cycle
         associate (own => face_nodes(mesh, faces%element(p), faces%face(p)))
            nodes(:2) = own(:2)
         end associate
         joint(:, p) = nodes(:2)
      end do
      if (.not. master%rigid .or. master%n < 2) return
      if (all(place_at(master, master%n, 1.0_wp) == master%a(:, 1))) joint(2, master%n) = 1   ! a closed line
   end function joints_of

   !> Whether no piece continues another at its end, or one that turns away from the outside.
   pure logical function is_end(master, joint, k, p)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: joint(:, :)
      integer(ip), intent(in) :: k, p                !< end 1 or 2 of a piece
      integer(ip) :: other
      real(wp) :: middle(2)

      other = findloc(joint(3 - k, :), joint(k, p), dim=1, kind=ip)
      is_end = other == 0
      if (is_end .or. master%kink(k, p) < 1.0_wp) return
      middle = place_at(master, other, 0.5_wp) - place_at(master, p, real(k - 1, wp))
      is_end = dot_product(middle, normal_at(master, p, real(k - 1, wp))) < 0.0_wp
   end function is_end

   !> The normal at a place across the motion in which both sides of a pair slide; the same where there is none.
   pure function normal_across(sliding, x, normal) result(n)
      type(sliding_t), intent(in) :: sliding         !< of the pair
      real(wp), intent(in) :: x(2), normal(2)        !< place [L] and normal of the side there
      real(wp) :: n(2), v(2)

      n = normal
      if (.not. sliding%exists) return
      v = velocity(sliding, x)
      if (norm2(v) > 0.0_wp) n = sign(1.0_wp, v(2)*normal(1) - v(1)*normal(2))*[v(2), -v(1)]/norm2(v)
   end function normal_across

   !> The entries of a place of a face.
   pure subroutine add_face(mesh, faces, i, t, sign, one)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces
      integer(ip), intent(in) :: i                   !< face
      real(wp), intent(in) :: t, sign                !< place, 0..1; 1 of a slave, -1 of a master
      type(contact_points_t), intent(inout) :: one
      integer(ip), allocatable :: nodes(:)

      nodes = face_nodes(mesh, faces%element(i), faces%face(i))
      call add_entries(nodes, sign*face_shape_values(size(nodes, kind=ip), 2*t - 1), 1_ip, one)
   end subroutine add_face

end module atrito_pairing
