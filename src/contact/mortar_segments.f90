!> Segments of a pair whose sides do not match: the slave's faces, cut at their own ends and where they face the nodes of the
!> master, so that on a segment the shape functions of both sides are smooth.
!>
!> A place x(t) of the slave, t in [-1,1] on its face, looks along
!>
!>     d(t) = sum_a phi_a(t) d_a,
!>
!> d_a the normals at the nodes of the face (the means of both faces that meet there): the direction turns from the one
!> end to the other and is the same on both sides of a node, so nothing of a smooth master is seen twice or left out.
!>
!> 1. Cuts. The end y of a piece of the master is faced from where its line of sight goes through it,
!>
!>        F(t) = cross(y - x(t), d(t)) = 0,     F' = cross(y - x, d') - cross(x', d),
!>
!>    by Newton's method from the foot of y on the chord; on straight faces with parallel directions that is one step.
!>    Pieces that lie aside of the strip that the face looks into are left out by the tree (strip_of), ends that lie
!>    behind by can_see.
!> 2. Segments. The middle of each part between two cuts looks for its piece as a NODAL point does; a part
!>    that sees nothing is left out.
!> 3. A face that is covered to less than LEAST_COVER is not covered.
module atrito_mortar_segments
   use atrito_face_geometry, only: face_direction, outward_normal
   use atrito_faces, only: face_list_t
   use atrito_growth, only: make_room
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_master, only: master_t, sight_t, look_along
   use atrito_mesh, only: mesh_t, face_nodes
   use atrito_piece_tree, only: search_t, begin_search, next_leaf, FACING
   use atrito_pieces, only: place_at, normal_at, cross
   use atrito_shape_functions, only: face_shape_values, face_shape_slopes
   use atrito_slave_faces, only: sine
   use atrito_smooth_normals, only: smooth_surface
   use atrito_sorting, only: sorted_places
   implicit none (type, external)
   private
   public :: segments_t, slave_face_t, cut_slave, join_curves, take_face, place_on_face, direction_at

   !> The segments of all faces of a slave; those of face i are first(i) .. first(i+1) - 1.
   type :: segments_t
      integer(ip), allocatable :: first(:)          !< (faces + 1)
      integer(ip), allocatable :: piece(:)          !< of the master
      real(wp), allocatable :: from(:), to(:)       !< on the face, in [-1,1]
      real(wp), allocatable :: direction(:, :, :)   !< (2, 3, faces) of sight, at the nodes of each face in the order of face_nodes
      real(wp), allocatable :: curvature(:)         !< (faces) [1/L]
      real(wp), allocatable :: bend(:)              !< (faces) [1/L] the same, convex > 0
      real(wp), allocatable :: common(:)            !< (segments) [1/L] of the curve that both sides take under pressure
   end type segments_t

   !> A face of the slave with what is needed of it.
   type :: slave_face_t
      integer(ip) :: n = 0                          !< nodes: 2 or 3
      integer(ip) :: node(3) = 0                    !< in the order of face_nodes
      real(wp) :: x(2, 3) = 0.0_wp                  !< [L]
      real(wp) :: direction(2, 3) = 0.0_wp          !< of sight, unit vectors
      real(wp) :: curvature = 0.0_wp                !< [1/L]
      real(wp) :: length = 0.0_wp                   !< of the chord [L]
      integer(ip) :: state = 0                      !< of its element
      real(wp) :: thickness = 0.0_wp                !< of its element [L]
      logical :: is_corner(3) = .false.             !< at the node it meets another face that sees the master, at a corner
      real(wp) :: places(3) = 0.0_wp                !< what the depth goes by at the nodes (depth_places) [L]
   end type slave_face_t

   !> Cuts that are nearer to each other than this, on [-1,1], are one.
   real(wp), parameter :: SAME_CUT = 1.0e-9_wp
   !> A face that is covered to less than this is not covered.
   real(wp), parameter :: LEAST_COVER = 2.0e-6_wp
   !> Steps of Newton's method for a cut, and when it has come to an end: the error behind a step is about its square.
   integer, parameter :: MOST_STEPS = 30
   real(wp), parameter :: DONE = 1.0e-9_wp
   !> Errors of rounding that a place may have.
   real(wp), parameter :: ROUND_OFFS = 64.0_wp

contains

   !> Cuts all faces of a slave. The directions of sight at the ends of faces are normals of the smooth surface.
   pure subroutine cut_slave(mesh, slave, master, segments)
      type(mesh_t), intent(in) :: mesh              !< the slave's and the master's elements
      type(face_list_t), intent(in) :: slave        !< one chain, ordered (order_chain)
      type(master_t), intent(in) :: master          !< which the faces see
      type(segments_t), intent(out) :: segments     !< without their common curve
      type(slave_face_t) :: face
      real(wp), allocatable :: ends(:, :, :), cuts(:)
      integer(ip) :: i

      call smooth_surface(mesh, slave, ends, segments%curvature, segments%bend, master%digit_error)
      allocate (segments%direction(2, 3, slave%n), segments%first(slave%n + 1))
      segments%direction(:, :2, :) = ends
      segments%first(1) = 1
      do i = 1, slave%n
         segments%direction(:, 3, i) = outward_normal(mesh%x(:, face_nodes(mesh, slave%element(i), slave%face(i))), 0.0_wp)
         face = take_face(mesh, slave, i, segments)
         segments%first(i + 1) = segments%first(i)
         call find_cuts(face, master, cuts)
         if (size(cuts) > 0) call add_segments(i, segments)
      end do

   contains

      !> The parts of the face between cuts that face a piece of the master. Between two cuts the line of sight passes no
      !> end of a piece, so what the middle sees is seen from the whole part.
      pure subroutine add_segments(i_face, segments)
         integer(ip), intent(in) :: i_face             !< number of the face
         type(segments_t), intent(inout) :: segments   !< those of the faces before
         type(sight_t) :: sight
         real(wp) :: t, covered
         integer(ip) :: k, before

         before = segments%first(i_face)
         covered = 0.0_wp
         associate (next => segments%first(i_face + 1))
            do k = 1, size(cuts, kind=ip) - 1
               t = 0.5_wp*(cuts(k) + cuts(k + 1))
               sight = look_along(place_on_face(face, t), direction_at(face, t), face%length, master)
               if (sight%piece == 0) cycle
               covered = covered + (cuts(k + 1) - cuts(k))
               call make_room(segments%piece, next - 1, next)
               call make_room(segments%from, next - 1, next)
               call make_room(segments%to, next - 1, next)
               segments%piece(next) = sight%piece
               segments%from(next) = cuts(k)
               segments%to(next) = cuts(k + 1)
               next = next + 1
            end do
            if (covered < LEAST_COVER) next = before
         end associate
      end subroutine add_segments

   end subroutine cut_slave

   !> The curve that both sides take under pressure. Of the curvature k_s + k_m that they have against each other (> 0: convex) each
   !> gives up its share, in the ratio of the compliances C = 1/E* (Hertz); a rigid master keeps its own:
   !>
   !>     k = k_s - (k_s + k_m) C_s/(C_s + C_m)     out of the slave, -k out of the master.
   !>
   !> Between chords of such a curve the gap shows a sawtooth of k c^2/8, c the chord, that is not there:
   !> atrito_mortar_points adds what the chords are short of it.
   pure subroutine join_curves(master, slave_compliance, master_compliance, segments)
      type(master_t), intent(in) :: master                              !< with the bend of its pieces
      real(wp), intent(in) :: slave_compliance(:), master_compliance(:) !< of the faces [L^2/F]; nothing of a rigid master
      type(segments_t), intent(inout) :: segments   !< those of the faces before
      real(wp) :: share
      integer(ip) :: i, k

      allocate (segments%common(segments%first(size(segments%first)) - 1))
      do i = 1, size(slave_compliance, kind=ip)
         do k = segments%first(i), segments%first(i + 1) - 1
            share = 1.0_wp
            if (.not. master%rigid) share = slave_compliance(i)/(slave_compliance(i) + master_compliance(segments%piece(k)))
            segments%common(k) = segments%bend(i) - share*(segments%bend(i) + master%bend(segments%piece(k)))
         end do
      end do
   end subroutine join_curves

   !> Face i of the slave.
   pure function take_face(mesh, slave, i, segments) result(face)
      type(mesh_t), intent(in) :: mesh              !< nodes, thickness
      type(face_list_t), intent(in) :: slave        !< one chain, ordered
      integer(ip), intent(in) :: i                  !< face of the slave
      type(segments_t), intent(in) :: segments      !< with directions and curvatures
      type(slave_face_t) :: face

      associate (nodes => face_nodes(mesh, slave%element(i), slave%face(i)))
         face%n = size(nodes, kind=ip)
         face%node(:face%n) = nodes
      end associate
      face%x(:, :face%n) = mesh%x(:, face%node(:face%n))
      face%direction = segments%direction(:, :, i)
      face%curvature = segments%curvature(i)
      face%length = norm2(face%x(:, 2) - face%x(:, 1))
   end function take_face

   !> The place on a face of the slave at a coordinate of its own [L].
   pure function place_on_face(face, t) result(x)
      type(slave_face_t), intent(in) :: face        !< of the slave
      real(wp), intent(in) :: t                     !< in [-1,1]
      real(wp) :: x(2)                              !< [L]

      x = matmul(face%x(:, :face%n), face_shape_values(face%n, t))
   end function place_on_face

   !> The unit vector along which a place of the face looks for the master.
   pure function direction_at(face, t) result(d)
      type(slave_face_t), intent(in) :: face        !< of the slave
      real(wp), intent(in) :: t                     !< in [-1,1]
      real(wp) :: d(2)                              !< unit vector

      d = matmul(face%direction(:, :face%n), face_shape_values(face%n, t))
      d = d/norm2(d)
   end function direction_at

   !> Ends of the face and places that face an end of a piece of the master, in ascending order; none where the master
   !> lies aside. The pieces are those within the strip of the face, by a search that passes over what does not face it;
   !> both ends of a piece are looked for, since at an end of the master no other piece has it.
   pure subroutine find_cuts(face, master, cuts)
      type(slave_face_t), intent(in) :: face        !< of the slave
      type(master_t), intent(in) :: master
      real(wp), allocatable, intent(out) :: cuts(:) !< on the face, from -1 to 1
      type(search_t) :: search
      real(wp) :: strip, t
      integer(ip) :: first, last, i, k, n

      n = 0
      strip = strip_of(face, master)
      call begin_search(master%tree, place_on_face(face, 0.0_wp), direction_at(face, 0.0_wp), .false., search)
      do
         call next_leaf(master%tree, strip, search, first, last)
         if (last < first) exit
         call make_room(cuts, n, n + 2*(last - first + 1))
         do i = first, last
            do k = 0, 1
               t = facing_place(face, place_at(master, master%tree%order(i), real(k, wp)))
               if (abs(t) >= 1 - SAME_CUT) cycle
               if (.not. can_see(face, t, master, master%tree%order(i), k)) cycle
               n = n + 1
               cuts(n) = t
            end do
         end do
      end do
      if (.not. allocated(cuts)) allocate (cuts(0))
      if (size(cuts) > 0) cuts = sorted_cuts(cuts(:n))
   end subroutine find_cuts

   !> Whether a place of the face that looks at an end of a piece may see it: from in front, and not from deep inside. What lies on
   !> the other side of a ring is behind the point where the directions meet; whether it cuts would hang on rounding.
   pure logical function can_see(face, t, master, i, k)
      type(slave_face_t), intent(in) :: face        !< of the slave
      real(wp), intent(in) :: t                     !< in [-1,1]
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i, k               !< the piece; 0 its first end, 1 the last
      real(wp) :: d(2), distance

      d = direction_at(face, t)
      distance = dot_product(place_at(master, i, real(k, wp)) - place_on_face(face, t), d)
      can_see = dot_product(d, normal_at(master, i, real(k, wp))) <= FACING .and. &
                distance >= -max(face%length, norm2(master%d(:, i)))
   end function can_see

   !> Cuts in ascending order between -1 and 1, each once; those nearer than SAME_CUT to the one before are it.
   pure function sorted_cuts(list) result(cuts)
      real(wp), intent(in) :: list(:)               !< in (-1,1)
      real(wp), allocatable :: cuts(:)
      real(wp), parameter :: STEPS = 2.0_wp**60
      integer(ip) :: i, n

      cuts = [-1.0_wp, list(sorted_places(int(list*STEPS, lp))), 1.0_wp]
      n = 1
      do i = 2, size(cuts, kind=ip)
         if (cuts(i) - cuts(n) <= SAME_CUT) cycle
         n = n + 1
         cuts(n) = cuts(i)
      end do
      cuts = cuts(:n)
   end function sorted_cuts

   !> Half of the width [L] of the strip that a face looks into: its own length, which is twice what is needed for
   !> straight sides, and what the directions spread on the way to the master, the sine between them times the distance
   !> of the farthest piece.
   pure real(wp) function strip_of(face, master) result(strip)
      type(slave_face_t), intent(in) :: face        !< of the slave
      type(master_t), intent(in) :: master
      real(wp) :: spread, far

      spread = max(sine(face%direction(:, 1), direction_at(face, 0.0_wp)), sine(face%direction(:, 2), direction_at(face, 0.0_wp)))
      strip = face%length
      if (.not. spread > 0.0_wp .or. master%tree%n == 0) return
      associate (x => place_on_face(face, 0.0_wp), box => master%tree%branches(1))
         far = norm2(max(abs(box%low - x), abs(box%high - x)))
      end associate
      strip = strip + spread*far
   end function strip_of

   !> Where on the face the line of sight goes through x: Newton's method for F(t) = cross(x - x(t), d(t)) = 0; outside
   !> [-1,1] if nowhere.
   !>
   !> It begins at the foot of x on the chord, and ends behind a step below DONE, whose error is about the square of
   !> that, or below the rounding of the coordinates. Where the derivative vanishes, as where the directions of sight
   !> meet, there is no such place.
   pure real(wp) function facing_place(face, x) result(t)
      type(slave_face_t), intent(in) :: face        !< of the slave
      real(wp), intent(in) :: x(2)                  !< [L]
      real(wp), parameter :: NOWHERE = 9.0_wp
      real(wp) :: away(2), d(2), slope(2), value, derivative, step
      integer :: i

      t = 2*dot_product(x - face%x(:, 1), face%x(:, 2) - face%x(:, 1))/face%length**2 - 1
      do i = 1, MOST_STEPS
         if (.not. abs(t) < 4.0_wp) exit
         away = x - place_on_face(face, t)
         d = matmul(face%direction(:, :face%n), face_shape_values(face%n, t))
         slope = matmul(face%direction(:, :face%n), face_shape_slopes(face%n, t))
         value = cross(away, d)
         derivative = cross(away, slope) - cross(face_direction(face%x(:, :face%n), t), d)
         if (.not. abs(derivative) > 0.0_wp) exit
         step = value/derivative
         t = t - step
         if (abs(step) <= max(DONE, ROUND_OFFS*EPS_MACH*maxval(abs(x))/face%length)) return
      end do
      if (i <= MOST_STEPS) t = NOWHERE
   end function facing_place

end module atrito_mortar_segments
