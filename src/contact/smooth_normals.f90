!> Normals and curvature of a surface of element faces, as of the smooth curve that the faces stand for.
!>
!> Between two faces that meet at a node without a corner the curve has one tangent. The normal there is the mean of
!> both faces' normals; where a chord is the last one it is that of the chord, turned by its angle with the curve. The curvature
!> of a face of length c is taken from the angles by which the normal turns:
!>
!>     k = (turn along the face + mean of the turns at its joints)/c,
!>
!> a parabola turning along itself and a chord at its ends alone. Turns below NO_TURN are rounding of coordinates, and,
!> where the nodes are known to g only, those below 12 g/c: they fade out by 3 x^2 - 2 x^3 (`shown`), since a step would
!> make neighbours with nearly the same turn differ. A parabola through such nodes may turn more: where all nodes of a face and of
!> those beside it lie within 3 g of a line it is straight (doubt_digits).
!>
!> `bend` is the curvature of a chord with its sign, > 0 where convex, and not of its polygon but of the curve through
!> its nodes: at a joint the tangent of a circle through three nodes makes the angles turn c_1/(c_1 + c_2) and turn
!> c_2/(c_1 + c_2) with the chords c_1, c_2, and a chord with the angles alpha at its ends has k = 2 tan(alpha)/c. Of
!> both ends the flatter one counts, so that a straight face beside a curve stays straight, and of two ends that bend
!> opposite ways none.
module atrito_smooth_normals
   use atrito_face_geometry, only: outward_normal
   use atrito_faces, only: face_list_t
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_end, face_nodes
   use atrito_slave_faces, only: sine, CORNER
   implicit none (type, external)
   private
   public :: smooth_surface, common_normal

   !> A smaller turn of the normal [rad] is rounding of the coordinates: the surface is straight there; a turn like this is not.
   real(wp), parameter :: NO_TURN = 1.0e-6_wp, A_TURN = 1.0e-4_wp
   !> What the last digits of its nodes may turn the normal by along a face: in digit errors over its length.
   real(wp), parameter :: DIGITS_TURN = 12.0_wp
   real(wp), parameter :: OFF_LINE = 3.0_wp         !< what they may move a node off the line through two others by: in digit errors
   real(wp), parameter :: LATTICE = 10.0_wp         !< length of a face in digit errors, of nodes that were not rounded

contains

   !> Unit normals at the ends of each face, the mean of both faces unless they meet at a corner; the curvature of each, the
   !> turn of the normal along it and at its ends over its length, but for what is rounding; and the same with its sign.
   !>
   !> The faces may come in any order: the face that goes on where another ends is found by its first node. A first loop
   !> looks at each face by itself, a second one at each joint; the turn at a joint belongs to both of its faces, half
   !> and half where a face has two.
   pure subroutine smooth_surface(mesh, faces, ends, curvature, bend, digit_error)
      type(mesh_t), intent(in) :: mesh !< nodes of the faces
      type(face_list_t), intent(in) :: faces              !< of one surface
      real(wp), allocatable, intent(out) :: ends(:, :, :) !< (2, first and last end, faces)
      real(wp), allocatable, intent(out) :: curvature(:)  !< (faces) [1/L] >= 0
      real(wp), allocatable, intent(out) :: bend(:)       !< (faces) [1/L] > 0: convex
      real(wp), intent(in), optional :: digit_error !< to which the nodes are known [L]; left out: all digits
      type(id_map_t) :: begins                      ! face of its first node
      real(wp) :: turn(faces%n), joints(faces%n), slope(2, faces%n), own(2, 2), length(2)
      integer(ip) :: n_joints(faces%n), beside(2, faces%n), last(faces%n), i, k
      logical :: is_chord(faces%n), known

      allocate (ends(2, 2, faces%n), curvature(faces%n), bend(faces%n))
      do i = 1, faces%n
         associate (nodes => face_nodes(mesh, faces%element(i), faces%face(i)))
            ends(:, 1, i) = outward_normal(mesh%x(:, nodes), -1.0_wp)
            ends(:, 2, i) = outward_normal(mesh%x(:, nodes), 1.0_wp)
            curvature(i) = 1/norm2(mesh%x(:, nodes(2)) - mesh%x(:, nodes(1)))
            is_chord(i) = size(nodes) == 2
            last(i) = nodes(2)
            call add_id(begins, nodes(1), i, known)
         end associate
         turn(i) = asin(min(sine(ends(:, 1, i), ends(:, 2, i)), 1.0_wp))
         bend(i) = turn_between(ends(:, 1, i), ends(:, 2, i))*curvature(i)
      end do
      joints = 0.0_wp
      n_joints = 0
      beside = 0
      slope = 0.0_wp
      do i = 1, faces%n
         k = find_id(begins, last(i))
         if (k == 0) cycle
         own = reshape([ends(:, 2, i), ends(:, 1, k)], [2, 2])
         if (sine(own(:, 1), own(:, 2)) > CORNER) cycle
         joints([i, k]) = joints([i, k]) + asin(sine(own(:, 1), own(:, 2)))
         n_joints([i, k]) = n_joints([i, k]) + 1
         beside(2, i) = k
         beside(1, k) = i
         length = 1/curvature([i, k])               ! the turn is shared in the ratio of the chords
         slope(2, i) = tan(turn_between(own(:, 1), own(:, 2))*(length(1)/(length(1) + length(2))))
         slope(1, k) = tan(turn_between(own(:, 1), own(:, 2))*(length(2)/(length(1) + length(2))))
         ends(:, 2, i) = (own(:, 1) + own(:, 2))/norm2(own(:, 1) + own(:, 2))
         ends(:, 1, k) = ends(:, 2, i)
      end do
      call bend_chords(curvature, bend)
      call turn_outer_ends(curvature, ends)
      turn = turn + joints/max(n_joints, 1_ip)
      joints = 0.0_wp                               ! of the turns, what is rounding
      if (present(digit_error)) call doubt_digits(mesh, faces, beside, curvature, digit_error, turn, joints)
      curvature = turn*shown(turn, joints)*curvature

   contains

      !> The curvature of chords by the slopes at their ends. At the end of a chain the chord has that of its neighbour besides: two
      !> chords alone are no curve.
      pure subroutine bend_chords(per_length, bend)
         real(wp), intent(in) :: per_length(:)         !< (faces) [1/L]
         real(wp), intent(inout) :: bend(:)            !< (faces) [1/L] those of chords are set
         logical :: inside(size(bend))
         integer(ip) :: i, k

         inside = .not. is_chord .or. all(beside > 0, dim=1)
         where (is_chord) bend = merge(2*flatter(slope(1, :), slope(2, :))*per_length, 0.0_wp, inside)
         do i = 1, size(bend, kind=ip)
            k = maxval(beside(:, i))
            if (inside(i) .or. k == 0) cycle
            if (inside(k)) bend(i) = flatter(2*sum(slope(:, i))*per_length(i), bend(k))
         end do
      end subroutine bend_chords

      !> Where no face goes on, the normal of the curve is that of the chord turned by the angle atan(k c/2) at its end.
      pure subroutine turn_outer_ends(per_length, ends)
         real(wp), intent(in) :: per_length(:)         !< (faces) [1/L]
         real(wp), intent(inout) :: ends(:, :, :)      !< (2, first and last end, faces)
         real(wp) :: slope
         integer(ip) :: i, k

         do i = 1, size(per_length, kind=ip)
            if (.not. is_chord(i)) cycle
            do k = 1, 2
               if (beside(k, i) /= 0) cycle
               slope = merge(-0.5_wp, 0.5_wp, k == 1)*bend(i)/per_length(i)
               ends(:, k, i) = ends(:, k, i) + slope*[-ends(2, k, i), ends(1, k, i)]
               ends(:, k, i) = ends(:, k, i)/norm2(ends(:, k, i))
            end do
         end do
      end subroutine turn_outer_ends

   end subroutine smooth_surface

   !> What the last digits of the nodes make of turns. Of faces all of whose nodes, and those of the faces beside them, lie within
   !> OFF_LINE of the line through the outermost two, the turn is none; from there to twice as far off it comes back.
   pure subroutine doubt_digits(mesh, faces, beside, per_length, digit_error, turn, rounding)
      type(mesh_t), intent(in) :: mesh              !< nodes of the faces
      type(face_list_t), intent(in) :: faces        !< of one surface
      integer(ip), intent(in) :: beside(:, :)       !< (2, faces) those before and behind without a corner; 0: none
      real(wp), intent(in) :: per_length(:)         !< (faces) [1/L]
      real(wp), intent(in) :: digit_error           !< to which the nodes are known [L]
      real(wp), intent(inout) :: turn(:)            !< (faces) [rad]
      real(wp), intent(inout) :: rounding(:)        !< (faces) of the turns [rad]; kept where the nodes were not rounded
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: ends(2), i, j, k
      real(wp) :: d(2), off

      if (.not. (digit_error > 0.0_wp .and. all(1 > LATTICE*digit_error*per_length))) return
      rounding = DIGITS_TURN*digit_error*per_length
      do i = 1, faces%n
         nodes = face_nodes(mesh, faces%element(i), faces%face(i))
         ends = nodes(:2)
         do k = 1, 2
            j = beside(k, i)
            if (j == 0) cycle
            nodes = [nodes, face_nodes(mesh, faces%element(j), faces%face(j))]
            ends(k) = mesh%nodes(faces%face(j), faces%element(j))
            if (k == 2) ends(k) = mesh%nodes(face_end(mesh, faces%element(j), faces%face(j)), faces%element(j))
         end do
         d = mesh%x(:, ends(2)) - mesh%x(:, ends(1))
         if (.not. norm2(d) > digit_error) cycle    ! a ring
         off = maxval([(abs((mesh%x(1, nodes(k)) - mesh%x(1, ends(1)))*d(2) - (mesh%x(2, nodes(k)) - mesh%x(2, ends(1)))*d(1)), &
                        k=1, size(nodes, kind=ip))])/norm2(d)
         turn(i) = turn(i)*smooth_step(off/(OFF_LINE*digit_error) - 1)
      end do
   end subroutine doubt_digits

   !> The angle from one normal to the next [rad], > 0: convex.
   pure real(wp) function turn_between(a, b) result(turn)
      real(wp), intent(in) :: a(2), b(2)            !< unit vectors

      turn = atan2(a(1)*b(2) - a(2)*b(1), dot_product(a, b))
      if (abs(turn) <= NO_TURN) turn = 0.0_wp
   end function turn_between

   !> The smaller of two slopes, so that a straight face beside a curved one stays straight.
   elemental real(wp) function flatter(a, b)
      real(wp), intent(in) :: a, b

      flatter = sign(min(abs(a), abs(b)), a)
      if (.not. a*b > 0.0_wp) flatter = 0.0_wp
   end function flatter

   !> The part of a turn [rad] that is no rounding, without a step in between.
   elemental real(wp) function shown(turn, rounding)
      real(wp), intent(in) :: turn
      real(wp), intent(in) :: rounding              !< that is known to be there [rad]
      real(wp) :: none

      none = max(NO_TURN, rounding)
      shown = smooth_step((turn - none)/(max(A_TURN - NO_TURN, none)))
   end function shown

   !> 0 below 0, 1 above 1, and 3 x^2 - 2 x^3 between.
   elemental real(wp) function smooth_step(x)
      real(wp), intent(in) :: x

      smooth_step = min(max(x, 0.0_wp), 1.0_wp)
      smooth_step = smooth_step**2*(3 - 2*smooth_step)
   end function smooth_step

   !> The direction in which two surfaces touch, out of the slave: of their normals the mean, in which the master's has the share
   !> that share_of_master tells.
   pure function common_normal(slave_normal, master_normal, share) result(n)
      real(wp), intent(in) :: slave_normal(2), master_normal(2) !< unit vectors out of the bodies
      real(wp), intent(in) :: share                 !< 0..1
      real(wp) :: n(2)

      n = slave_normal
      if (.not. share > 0.0_wp) return
      n = (1 - share)*slave_normal - share*master_normal
      n = n/norm2(n)
   end function common_normal

end module atrito_smooth_normals
