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
module atrito_end_points
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_master, only: master_t, sight_t, look_along
   use atrito_mesh, only: mesh_t, face_nodes, is_revolved
   use atrito_model, only: model_t
   use atrito_pairing, only: make_master
   use atrito_pieces, only: normal_at, place_at, END_TOLERANCE
   use atrito_points, only: contact_points_t, sliding_t, allocate_points, add_entries, insert_point
   use atrito_shape_functions, only: face_shape_values
   use atrito_sliding_motions, only: velocity
   implicit none (type, external)
   private
   public :: add_end_points

   !> Most entries of such a point: a face of either side.
   integer(ip), parameter :: MOST_ENTRIES = 6
   !> How far from an end its side must face the other one, of the shorter face, and the length of a point there, of the slave's.
   real(wp), parameter :: NEAR = 0.01_wp
   real(wp), parameter :: ROUND_OFFS = 8.0_wp        !< of a distance

contains

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

end module atrito_end_points
