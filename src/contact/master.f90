!> The master of a contact pair as a list of pieces, and what a point of the slave sees of it.
!>
!> A point at x looks along its normal n: it sees the piece with the least |s| among those that the line x + s n
!> crosses, that face it (n.m < FACING, m the normal of the piece there), and that lie no deeper inside than the longer
!> of the two faces (s >= -reach). Of pieces that are equally good the first of the list is taken, as if all of them had
!> been looked at, so the tree changes nothing.
!>
!> Faces stand for a smooth curve. Each end of a piece has the mean of the normals of both faces that meet there, and so
!> has the curvature; at a corner (a turn of more than 53 degrees) each face keeps its own. Between the ends the normal
!> of a piece is drawn to these means linearly, or, on a parabola, by functions that are 1 at one end and 0 in the
!> middle and at the other end, since a parabola's normal is right in its middle (smooth_normal).
!>
!> Where two curves are to touch they have one normal. With the curvatures k_s and k_m of slave and master it is (share_of_master)
!>
!>     n ~ (1 - f) n_s - f n_m,     f = k_s/(k_s + k_m):
!>
!> of two circles that is the line between their centres, of a curve on a straight side the normal of that side, and it
!> does not depend on which of them is the slave. Of two straight sides it is the slave's normal, without a jump from
!> the one case to the other (`straight`); but where the slave ends and stands on the master at an angle, on a corner of its
!> body, it is the master's (TILTED in atrito_slave_faces).
module atrito_master
   use atrito_element_table, only: DEGREE_OF
   use atrito_faces, only: face_list_t
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_end, face_nodes
   use atrito_piece_tree, only: piece_tree_t, search_t, plant, begin_search, next_leaf, FACING
   use atrito_pieces, only: pieces_t, allocate_pieces, sag_of, place_at, normal_at, cross_piece, cross, END_TOLERANCE
   use atrito_slave_faces, only: sine, CORNER
   use atrito_smooth_normals, only: smooth_surface
   implicit none (type, external)
   private
   public :: master_t, sight_t, master_of_faces, master_of_segments, turn_master, smooth_normal, share_of_master, is_straight, &
             kink_near, look_along, look_at_end, nearest_end

   !> Faces of elements, or rigid segments and arcs.
   type, extends(pieces_t) :: master_t
      logical :: rigid = .false.                    !< segments and arcs that do not deform
      integer(ip) :: degree = 0                     !< of the elements of all faces; 0: rigid, none, or not the same
      real(wp) :: digit_error = 0.0_wp              !< to which nodes are known, those of slaves as well [L]; 0: all digits
      real(wp), allocatable :: ends(:, :, :)        !< (2, first and last end, n) unit normals of the smooth surface
      real(wp), allocatable :: curvature(:, :)      !< (first and last end, n) [1/L] >= 0
      real(wp), allocatable :: kink(:, :)           !< (first and last end, n) 0..1: how far the next piece is another side
      real(wp) :: straight = 0.0_wp                 !< [1/L] a curvature that is nothing beside those of curves
      real(wp), allocatable :: bend(:)              !< (n) [1/L] the same, convex > 0
      logical, allocatable :: is_floor(:)           !< (n) straight segments beside which no other turns away; not allocated: none
      type(piece_tree_t) :: tree                    !< over the pieces, by their boxes and normals
   end type master_t

   !> What a point sees.
   type :: sight_t
      integer(ip) :: piece = 0                      !< 0: nothing
      real(wp) :: t = 0.0_wp                        !< place on the piece, 0..1
      real(wp) :: distance = 0.0_wp                 !< along the normal [L]
      integer(ip) :: n_tried = 0                    !< pieces that were looked at
   end type sight_t

   real(wp), parameter :: ANY_SIDE_FACES = 2.0_wp  !< no cosine of two normals is above it
   !> Of the turn at a rigid joint [rad] from which on it is a kink, and of a curvature by the length of a piece that is none.
   real(wp), parameter :: A_KINK = 0.1_wp, NO_CURVE = 1.0e-5_wp
   real(wp), parameter :: NO_TURN = 1.0e-6_wp      !< [rad]
   !> Closer than this to a node of the master is at the node.
   real(wp), parameter :: NODE_TOLERANCE = 1.0e-10_wp

contains

   !> The faces of elements as a master; their outside lies at the right of the direction of travel.
   pure subroutine master_of_faces(mesh, faces, master, digit_error)
      type(mesh_t), intent(in) :: mesh              !< the faces are of its elements
      type(face_list_t), intent(in) :: faces        !< of the master, in the order of its pieces
      type(master_t), intent(out) :: master         !< with smooth normals, curvatures, kinks and tree
      real(wp), intent(in), optional :: digit_error !< to which the nodes of the mesh are known [L]; left out: all digits
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: curvature(:)
      integer(ip) :: i

      call allocate_pieces(faces%n, master)
      do i = 1, faces%n
         nodes = face_nodes(mesh, faces%element(i), faces%face(i))
         master%a(:, i) = mesh%x(:, nodes(1))
         master%d(:, i) = mesh%x(:, nodes(2)) - mesh%x(:, nodes(1))
         master%sag(:, i) = sag_of(mesh%x(:, nodes))
      end do
      if (faces%n > 0) then
         master%degree = DEGREE_OF(mesh%shape(faces%element(1)))
         if (any(DEGREE_OF(mesh%shape(faces%element(:faces%n))) /= master%degree)) master%degree = 0
      end if
      if (present(digit_error)) master%digit_error = digit_error
      call smooth_surface(mesh, faces, master%ends, curvature, master%bend, master%digit_error)
      call begin_ends(curvature, master)
      call join_faces(mesh, faces, curvature, master)
      call plant(master%pieces_t, master%tree)
   end subroutine master_of_faces

   !> Each end has the curvature of its piece.
   pure subroutine begin_ends(curvature, master)
      real(wp), intent(in) :: curvature(:)          !< of the pieces [1/L]
      type(master_t), intent(inout) :: master

      master%curvature = spread(curvature, 1, 2)
      allocate (master%kink(2, master%n), source=0.0_wp)
      if (master%n > 0) master%straight = NO_CURVE*master%n/sum(norm2(master%d, dim=1))
   end subroutine begin_ends

   !> At a node that two faces share the curvature is the mean of theirs, so that it does not matter which one is seen; at a corner
   !> each has its own, and the corner is noted as a kink.
   pure subroutine join_faces(mesh, faces, curvature, master)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces        !< of the master, in the order of its pieces
      real(wp), intent(in) :: curvature(:)
      type(master_t), intent(inout) :: master
      type(id_map_t) :: begins                      ! face of its first node
      integer(ip) :: i, k
      logical :: known

      do i = 1, faces%n
         call add_id(begins, mesh%nodes(faces%face(i), faces%element(i)), i, known)
      end do
      do i = 1, faces%n
         k = find_id(begins, mesh%nodes(face_end(mesh, faces%element(i), faces%face(i)), faces%element(i)))
         if (k == 0) cycle
         if (sine(normal_at(master, i, 1.0_wp), normal_at(master, k, 0.0_wp)) > CORNER) then
            master%kink(2, i) = 1.0_wp
            master%kink(1, k) = 1.0_wp
         else
            master%curvature(2, i) = 0.5_wp*(curvature(i) + curvature(k))
            master%curvature(1, k) = master%curvature(2, i)
         end if
      end do
   end subroutine join_faces

   !> The same pieces with their outside on the other side.
   pure subroutine turn_master(master)
      type(master_t), intent(inout) :: master !< its sides, bends and tree change

      master%side = -master%side
      master%ends = -master%ends
      master%bend = -master%bend
      call plant(master%pieces_t, master%tree)
   end subroutine turn_master

   !> Rigid segments and arcs: the outward normal is the direction of travel turned by +90 degrees. They have the
   !> curvature that they are given, 1/R of an arc and 0 of a segment, and no smooth surface is made of them: a joint is
   !> a kink where the normal turns, by A_KINK or more altogether, or where the curvature jumps.
   pure subroutine master_of_segments(ends, master, is_arc, centre)
      real(wp), intent(in) :: ends(:, :)            !< (2, segments + 1) [L]
      type(master_t), intent(out) :: master         !< without a smooth surface
      logical, intent(in), optional :: is_arc(:)    !< (segments); default: none
      real(wp), intent(in), optional :: centre(:, :) !< (2, segments) of arcs [L], as far from one end as from the other
      real(wp), allocatable :: curvature(:)
      integer(ip) :: i, n

      n = max(size(ends, 2, kind=ip) - 1, 0)
      call allocate_pieces(n, master)
      master%rigid = .true.
      master%side = -1.0_wp
      master%a = ends(:, :n)
      master%d = ends(:, 2:) - ends(:, :n)
      if (present(is_arc) .and. present(centre)) then
         do i = 1, n
            if (.not. is_arc(i)) cycle
            master%centre(:, i) = centre(:, i)
            associate (from => ends(:, i) - centre(:, i), to => ends(:, i + 1) - centre(:, i))
               master%sweep(i) = atan2(cross(from, to), dot_product(from, to))
            end associate
         end do
      end if
      allocate (master%ends(2, 2, n), curvature(n), master%bend(n), source=0.0_wp)
      do i = 1, n
         master%ends(:, 1, i) = normal_at(master, i, 0.0_wp)
         master%ends(:, 2, i) = normal_at(master, i, 1.0_wp)
         if (.not. abs(master%sweep(i)) > 0.0_wp) cycle
         curvature(i) = 1/norm2(master%a(:, i) - master%centre(:, i))
         master%bend(i) = sign(curvature(i), dot_product(master%ends(:, 1, i), master%a(:, i) - master%centre(:, i)))
      end do
      call begin_ends(curvature, master)
      master%is_floor = [(.not. abs(master%sweep(i)) > 0.0_wp, i=1, n)]
      do i = 1, n - 1
         if (dot_product(master%d(:, i + 1), master%ends(:, 2, i)) < -NO_TURN*norm2(master%d(:, i + 1))) then
            master%is_floor(i:i + 1) = .false.
         end if
         master%kink(2, i) = min(sine(master%ends(:, 2, i), master%ends(:, 1, i + 1))/A_KINK, 1.0_wp)
         if (abs(master%bend(i) - master%bend(i + 1)) > NO_CURVE*maxval(curvature(i:i + 1))) master%kink(2, i) = 1.0_wp
         master%kink(1, i + 1) = master%kink(2, i)
      end do
      call plant(master%pieces_t, master%tree)
   end subroutine master_of_segments

   !> Unit normal of the smooth surface at a place of a piece: that of the piece, drawn to the means at its ends; in the middle of a
   !> bent piece it is right as it is.
   pure function smooth_normal(master, i, t) result(n)
      type(master_t), intent(in) :: master          !< with its smooth surface
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(in) :: t                     !< in [0,1]
      real(wp) :: n(2), share(2)

      share = [1 - t, t]
      if (any(abs(master%sag(:, i)) > 0.0_wp)) share = [(1 - t)*(1 - 2*t), t*(2*t - 1)]
      n = normal_at(master, i, t) + share(1)*(master%ends(:, 1, i) - normal_at(master, i, 0.0_wp)) &
          + share(2)*(master%ends(:, 2, i) - normal_at(master, i, 1.0_wp))
      n = n/norm2(n)
   end function smooth_normal

   !> The share of the master's normal, at a place of a piece, in the direction in which two surfaces touch. The radii are the
   !> weights, so that of two circles that touch it is the line between their centres, of a curve on a straight side the normal of
   !> that, and it does not depend on who is the slave. Of straight sides it is the slave's,
   !> but over a rigid floor that of the floor: a body that leans stands on it with a corner.
   pure real(wp) function share_of_master(master, i, t, slave_curvature) result(share)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(in) :: t                     !< in [0,1]
      real(wp), intent(in) :: slave_curvature       !< [1/L] >= 0
      real(wp) :: both

      share = 1.0_wp
      if (allocated(master%is_floor)) then
         if (master%is_floor(i)) return
      end if
      both = slave_curvature + ((1 - t)*master%curvature(1, i) + t*master%curvature(2, i))
      share = slave_curvature/(both + max(master%straight - 0.1_wp*both, 0.0_wp))
   end function share_of_master

   !> Whether a piece has no curvature, beside those of curves.
   pure logical function is_straight(master, i)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i                  !< piece

      is_straight = all(master%curvature(:, i) <= master%straight)
   end function is_straight

   !> How far a place of a piece is a kink of the master, 0..1: the next piece, which is another side, begins within
   !> `reach` of it. It falls linearly with the distance a from the end, kink (1 - a/reach), so that a point that moves
   !> past a kink has no jump of its normal.
   pure real(wp) function kink_near(master, i, t, reach) result(kink)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(in) :: t                     !< in [0,1]
      real(wp), intent(in) :: reach                 !< [L]
      real(wp) :: away
      integer(ip) :: k

      kink = 0.0_wp
      do k = 1, 2
         away = norm2(place_at(master, i, t) - place_at(master, i, real(k - 1, wp)))
         kink = max(kink, master%kink(k, i)*max(1 - away/reach, 0.0_wp))
      end do
   end function kink_near

   !> The nearest piece of the master on the line through x along the normal; a piece seen from behind is not seen, nor one that
   !> lies deeper inside than the longer of the slave's face and the piece. A piece that the line misses by END_TOLERANCE or less is
   !> taken only where no other is as near. The distance is that to the piece or its continuation.
   pure function look_along(x, normal, reach, master) result(best)
      real(wp), intent(in) :: x(2), normal(2)       !< place [L] and unit vector of the line
      real(wp), intent(in) :: reach                 !< length of the slave's face [L]
      type(master_t), intent(in) :: master
      type(sight_t) :: best
      type(search_t) :: search
      real(wp) :: nearest
      integer(ip) :: i, first, last

      call begin_search(master%tree, x, normal, .true., search)
      nearest = huge(nearest)
      do
         call next_leaf(master%tree, nearest, search, first, last)
         if (last < first) return
         do i = first, last
            call look_at_piece(x, normal, reach, master, master%tree%order(i), nearest, best)
         end do
         best%n_tried = best%n_tried + (last - first + 1)
      end do
   end function look_along

   !> Takes a piece where it is nearer than the best so far, or as near and earlier in the list. A line that misses the
   !> piece by no more than END_TOLERANCE of it is moved to its end, but counts as farther off by twice that, so that a
   !> piece that is met properly wins.
   pure subroutine look_at_piece(x, normal, reach, master, i, nearest, best)
      real(wp), intent(in) :: x(2), normal(2), reach !< line; length of the slave's face [L]
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(inout) :: nearest            !< [L]
      type(sight_t), intent(inout) :: best          !< the best so far
      real(wp) :: t(2), distance, nearness
      integer(ip) :: k, n_roots

      call cross_piece(master, i, x, normal, t, n_roots)
      do k = 1, n_roots
         if (t(k) < -END_TOLERANCE .or. t(k) > 1 + END_TOLERANCE) cycle
         distance = dot_product(place_at(master, i, t(k)) - x, normal)
         nearness = abs(distance)
         if (t(k) < -NODE_TOLERANCE .or. t(k) > 1 + NODE_TOLERANCE) nearness = nearness + 2*END_TOLERANCE*norm2(master%d(:, i))
         t(k) = at_node(min(max(t(k), 0.0_wp), 1.0_wp))
         if (dot_product(normal, normal_at(master, i, t(k))) > FACING) cycle
         if (distance < -max(reach, norm2(master%d(:, i))) .or. nearness > nearest) cycle
         if (.not. nearness < nearest .and. i >= best%piece) cycle
         nearest = nearness
         best = sight_t(i, t(k), distance, best%n_tried)
      end do
   end subroutine look_at_piece

   !> Round-off does not move a point off a node of the master.
   pure real(wp) function at_node(t) result(place)
      real(wp), intent(in) :: t                     !< share of the piece, 0 to 1
      integer(ip) :: k

      place = t
      do k = 0, 2
         if (abs(t - 0.5_wp*k) < NODE_TOLERANCE) place = 0.5_wp*k
      end do
   end function at_node

   !> The end of the master that the line through x along the normal misses by no more than its distance times `turn`.
   pure function look_at_end(x, normal, reach, turn, master) result(best)
      real(wp), intent(in) :: x(2), normal(2), reach !< line; length of the slave's face [L]
      real(wp), intent(in) :: turn                  !< sine of the angle by which the normal is in doubt
      type(master_t), intent(in) :: master
      type(sight_t) :: best
      real(wp) :: away

      best = nearest_end(x, normal, master)
      if (best%piece == 0) return
      away = abs(cross(place_at(master, best%piece, best%t) - x, normal))
      if (away > turn*abs(best%distance) .or. best%distance < -max(reach, norm2(master%d(:, best%piece)))) best = sight_t()
   end function look_at_end

   !> The master's end y that is nearest to the line through x along the normal n, |cross(y - x, n)| being the least, of
   !> the pieces that face it. Where none does, piece 0; or the nearest of all, on any side. A corner of the slave needs
   !> one where the mean normal of its two faces misses the master.
   pure function nearest_end(x, normal, master, any_side) result(best)
      real(wp), intent(in) :: x(2), normal(2)       !< place [L] and unit vector of the line
      type(master_t), intent(in) :: master
      logical, intent(in), optional :: any_side
      type(sight_t) :: best
      type(search_t) :: search
      real(wp) :: least
      integer(ip) :: i, first, last

      call begin_search(master%tree, x, normal, .false., search)
      least = huge(least)
      do
         call next_leaf(master%tree, least, search, first, last)
         if (last < first) exit
         do i = first, last
            call look_at_ends(x, normal, master, master%tree%order(i), FACING, least, best)
         end do
         best%n_tried = best%n_tried + (last - first + 1)
      end do
      if (best%piece > 0 .or. .not. present(any_side)) return
      do i = 1, size(master%tree%order, kind=ip)
         call look_at_ends(x, normal, master, i, ANY_SIDE_FACES, least, best)
      end do
   end function nearest_end

   !> Takes an end of a piece where it is nearer than the best so far, or as near and earlier in the list.
   pure subroutine look_at_ends(x, normal, master, i, facing_below, least, best)
      real(wp), intent(in) :: x(2), normal(2)       !< place [L] and unit vector of the line
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(in) :: facing_below          !< cosine of the two normals from which on it is seen from behind
      real(wp), intent(inout) :: least              !< [L]
      type(sight_t), intent(inout) :: best          !< the best so far
      real(wp) :: away, d(2), t
      integer(ip) :: k

      do k = 0, 1
         t = real(k, wp)
         d = place_at(master, i, t) - x
         away = abs(cross(d, normal))
         if (away > least .or. dot_product(normal, normal_at(master, i, t)) > facing_below) cycle
         if (.not. away < least .and. i >= best%piece) cycle
         least = away
         best = sight_t(i, t, dot_product(d, normal), best%n_tried)
      end do
   end subroutine look_at_ends

end module atrito_master
