!> The outlines of all bodies, and what each face of them looks at: for contact that is found and not given pair by pair.
!>
!> The middle x of each face looks along its outward normal n, both ways: faces of another body at y = x + s n count
!> where they face it, in front (s > 0, a gap) or behind (s < 0, an overlap). The own body hides what lies behind it:
!> with the nearest own faces at
!>
!>     front = min s > 0,     back = max s < 0     over the faces of the same body,
!>
!> only back < s < front can be seen, so thin plates are not looked through. Of those the nearest is taken, no farther
!> off than `distance` or half of the longer one of the two faces, as they are in the deck; a rigid surface has to be
!> nearer than that, and within half of the face. All faces stand in one tree (atrito_piece_tree), so a search takes some
!> log n steps, all of them n log n.
module atrito_outlines
   use atrito_element_table, only: MOST_SIDES
   use atrito_face_geometry, only: face_arc_length, outward_normal
   use atrito_faces, only: face_list_t, node_elements_t, outer_faces
   use atrito_growth, only: make_room
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_master, only: master_t, master_of_faces
   use atrito_mesh, only: mesh_t, face_nodes, face_end
   use atrito_piece_tree, only: search_t, begin_search, next_leaf, FACING
   use atrito_pieces, only: place_at, normal_at, cross_piece, END_TOLERANCE
   use atrito_slave_faces, only: sine, CORNER
   use atrito_shape_functions, only: face_shape_values
   implicit none (type, external)
   private
   public :: outlines_t, sighting_t, list_outlines, look_around

   !> All faces on the outlines of the bodies.
   type :: outlines_t
      type(face_list_t) :: faces                     !< in the order of their elements
      integer(ip), allocatable :: body(:)            !< (faces)
      real(wp), allocatable :: length(:)             !< (faces) [L]
      real(wp), allocatable :: reach(:)              !< (faces) half of the length of the deck's face that it is a part of [L]
      integer(ip), allocatable :: next(:)            !< (faces) the one that goes on where it ends; 0: there is a corner
      integer(ip), allocatable :: place(:, :)        !< (4, elements) where a face stands in this list; 0: inside a body
   end type outlines_t

   !> What a face looks at from its middle.
   type :: sighting_t
      integer(ip) :: face = 0                        !< of another body, its place among the outlines; 0: none
      integer(ip) :: rigid = 0                       !< of the rigid masters; 0: none
      real(wp) :: distance = 0.0_wp                  !< [L] along its normal
   end type sighting_t

   !> Where the line of sight is.
   type :: line_t
      real(wp) :: x(2) = 0.0_wp, normal(2) = 0.0_wp  !< place [L] and outward unit normal
      real(wp) :: near = 0.0_wp                      !< [L] what is no farther off than this touches
      real(wp) :: limit = 0.0_wp                     !< [L]
   end type line_t

   !> Errors of rounding that a distance may have.
   real(wp), parameter :: ROUND_OFFS = 64.0_wp

contains

   !> The outer faces of all elements in the order of these, without those of cuts: both sides of a pre-tension section
   !> hold together, and are no contact.
   subroutine list_outlines(mesh, around, body_of_element, outlines, cut)
      type(mesh_t), intent(in) :: mesh              !< elements and nodes
      type(node_elements_t), intent(in) :: around   !< elements round each node
      integer(ip), intent(in) :: body_of_element(:) !< (elements)
      type(outlines_t), intent(out) :: outlines     !< of all bodies
      type(face_list_t), intent(in), optional :: cut !< faces that hold together with others
      integer(ip) :: i

      outlines%faces = outer_faces(mesh, around, [(i, i=1, mesh%n_elements)])
      if (present(cut)) call leave_out(cut, outlines%faces)
      associate (faces => outlines%faces)
         outlines%body = body_of_element(faces%element(:faces%n))
         allocate (outlines%length(faces%n), outlines%reach(faces%n), outlines%next(faces%n))
         allocate (outlines%place(MOST_SIDES, mesh%n_elements), source=0_ip)
         do i = 1, faces%n
            outlines%place(faces%face(i), faces%element(i)) = i
            outlines%length(i) = face_arc_length(mesh%x(:, face_nodes(mesh, faces%element(i), faces%face(i))), 1.0_wp)
         end do
         outlines%reach = 0.5_wp*outlines%length
      end associate
      call join_faces(mesh, outlines)
   end subroutine list_outlines

   !> Takes some faces out of a list.
   pure subroutine leave_out(some, faces)
      type(face_list_t), intent(in) :: some         !< that go
      type(face_list_t), intent(inout) :: faces
      integer(ip) :: i

      if (some%n == 0) return
      associate (kept => pack([(i, i=1, faces%n)], [(.not. any(some%element(:some%n) == faces%element(i) .and. &
                                                               some%face(:some%n) == faces%face(i)), i=1, faces%n)]))
         faces%n = size(kept, kind=ip)
         faces%element(:faces%n) = faces%element(kept)
         faces%face(:faces%n) = faces%face(kept)
      end associate
   end subroutine leave_out

   !> The face that goes on where each ends: the one that begins at its last node, unless the normal turns by a corner
   !> there. Where corners of two bodies, or of one, meet in a node two faces begin, and neither goes on.
   subroutine join_faces(mesh, outlines)
      type(mesh_t), intent(in) :: mesh
      type(outlines_t), intent(inout) :: outlines
      integer(ip) :: from(mesh%n_nodes), i, node
      integer(ip), parameter :: MANY = -1_ip

      from = 0
      associate (faces => outlines%faces)
         do i = 1, faces%n
            node = mesh%nodes(faces%face(i), faces%element(i))
            from(node) = merge(MANY, i, from(node) /= 0)
         end do
         do i = 1, faces%n
            outlines%next(i) = max(from(mesh%nodes(face_end(mesh, faces%element(i), faces%face(i)), faces%element(i))), 0_ip)
            if (outlines%next(i) == 0) cycle
            if (sine(normal_of(mesh, faces, i, 1.0_wp), normal_of(mesh, faces, outlines%next(i), -1.0_wp)) > CORNER) then
               outlines%next(i) = 0
            end if
         end do
      end associate
   end subroutine join_faces

   !> Outward unit normal of a face of the outlines at t in [-1, 1], -1 at its first node and 1 at its last.
   pure function normal_of(mesh, faces, i, t) result(normal)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces        !< of the outlines
      integer(ip), intent(in) :: i                  !< face
      real(wp), intent(in) :: t                     !< on the face, in [-1,1]
      real(wp) :: normal(2)

      normal = outward_normal(mesh%x(:, face_nodes(mesh, faces%element(i), faces%face(i))), t)
   end function normal_of

   !> What each face looks at: the nearest face of another body, or the nearest rigid surface, no farther off than `distance`. Its
   !> own body hides what lies behind it.
   subroutine look_around(mesh, outlines, rigid, distance, seen)
      type(mesh_t), intent(in) :: mesh !< elements and nodes
      type(outlines_t), intent(in) :: outlines      !< of all bodies
      type(master_t), intent(in) :: rigid(:)        !< all rigid surfaces that may be seen
      real(wp), intent(in) :: distance               !< [L]; 0: the longer reach of the two faces, of the face for a rigid one
      type(sighting_t), allocatable, intent(out) :: seen(:)   !< (faces)
      type(master_t) :: all
      type(line_t) :: line
      integer(ip), allocatable :: piece(:)
      real(wp), allocatable :: away(:)
      real(wp) :: longest
      integer(ip) :: i

      allocate (seen(outlines%faces%n))
      if (outlines%faces%n == 0) return
      longest = maxval(outlines%reach)
      call master_of_faces(mesh, outlines%faces, all)
      do i = 1, outlines%faces%n
         call aim(mesh, outlines, i, line)
         line%limit = distance
         if (.not. distance > 0.0_wp) line%limit = longest
         call look_at_bodies(outlines, i, line, all, distance > 0.0_wp, piece, away, seen(i))
         if (.not. distance > 0.0_wp) line%limit = outlines%reach(i)
         call look_at_rigid(line, rigid, piece, away, seen(i))
      end do
   end subroutine look_around

   !> The line of sight of a face: from its middle along its normal. Crossings no farther off than rounding of the
   !> coordinates (near) are the face itself or what touches it, and hide nothing.
   pure subroutine aim(mesh, outlines, i, line)
      type(mesh_t), intent(in) :: mesh
      type(outlines_t), intent(in) :: outlines
      integer(ip), intent(in) :: i                  !< face
      type(line_t), intent(out) :: line             !< of sight
      integer(ip), allocatable :: nodes(:)

      nodes = face_nodes(mesh, outlines%faces%element(i), outlines%faces%face(i))
      line%x = matmul(mesh%x(:, nodes), face_shape_values(size(nodes, kind=ip), 0.0_wp))
      line%normal = outward_normal(mesh%x(:, nodes), 0.0_wp)
      line%near = ROUND_OFFS*EPS_MACH*maxval(abs(mesh%x(:, nodes)))
   end subroutine aim

   !> The nearest face of another body that is not hidden by the own one, in front or behind: of the faces that the line
   !> crosses those of the own body make front and back, then each of another body between these is asked. Of faces as
   !> near the first of the list counts.
   pure subroutine look_at_bodies(outlines, i, line, all, is_given, piece, away, seen)
      type(outlines_t), intent(in) :: outlines
      integer(ip), intent(in) :: i                  !< face
      type(line_t), intent(in) :: line              !< of sight
      type(master_t), intent(in) :: all              !< all faces of the outlines
      logical, intent(in) :: is_given                !< the limit is the distance that the user gives
      integer(ip), allocatable, intent(inout) :: piece(:) !< room for a list
      real(wp), allocatable, intent(inout) :: away(:) !< room for its distances [L]
      type(sighting_t), intent(inout) :: seen       !< the best so far
      real(wp) :: front, back, limit
      integer(ip) :: k, n

      call look_both_ways(line, all, piece, away, n)
      front = huge(front)
      back = -huge(back)
      do k = 1, n
         if (outlines%body(piece(k)) /= outlines%body(i)) cycle
         if (away(k) > line%near) front = min(front, away(k))
         if (away(k) < -line%near) back = max(back, away(k))
      end do
      do k = 1, n
         if (outlines%body(piece(k)) == outlines%body(i) .or. away(k) >= front .or. away(k) <= back) cycle
         limit = line%limit
         if (.not. is_given) limit = max(outlines%reach(i), outlines%reach(piece(k)))
         if (abs(away(k)) > limit) cycle
         if (seen%face > 0) then
            if (abs(away(k)) > abs(seen%distance)) cycle
            if (.not. abs(away(k)) < abs(seen%distance) .and. piece(k) >= seen%face) cycle
         end if
         seen = sighting_t(face=piece(k), distance=away(k))
      end do
   end subroutine look_at_bodies

   !> All pieces of a master that face the line and lie on it, no farther off than the limit on either side; a piece that is
   !> crossed twice stands there twice. The list is in the order of the search, not of the distances.
   pure subroutine look_both_ways(line, master, piece, away, n)
      type(line_t), intent(in) :: line              !< of sight
      type(master_t), intent(in) :: master          !< whose pieces are looked at
      integer(ip), allocatable, intent(inout) :: piece(:)    !< the first n are they; they grow where they are too short
      real(wp), allocatable, intent(inout) :: away(:)        !< [L] along the normal
      integer(ip), intent(out) :: n
      type(search_t) :: search
      integer(ip) :: i, first, last

      n = 0
      call begin_search(master%tree, line%x, line%normal, .true., search)
      do
         call next_leaf(master%tree, line%limit, search, first, last)
         if (last < first) return
         do i = first, last
            call add_crossings(line, master, master%tree%order(i), piece, away, n)
         end do
      end do
   end subroutine look_both_ways

   !> Adds the places where the line meets one piece, each with its distance along the line.
   pure subroutine add_crossings(line, master, i, piece, away, n)
      type(line_t), intent(in) :: line              !< of sight
      type(master_t), intent(in) :: master          !< whose pieces are looked at
      integer(ip), intent(in) :: i                   !< the piece
      integer(ip), allocatable, intent(inout) :: piece(:) !< room for a list
      real(wp), allocatable, intent(inout) :: away(:) !< room for its distances [L]
      integer(ip), intent(inout) :: n               !< crossings so far
      real(wp) :: t(2), distance
      integer(ip) :: k, n_roots

      call cross_piece(master, i, line%x, line%normal, t, n_roots)
      do k = 1, n_roots
         if (t(k) < -END_TOLERANCE .or. t(k) > 1 + END_TOLERANCE) cycle
         distance = dot_product(place_at(master, i, t(k)) - line%x, line%normal)
         if (abs(distance) > line%limit) cycle
         if (dot_product(line%normal, normal_at(master, i, min(max(t(k), 0.0_wp), 1.0_wp))) > FACING) cycle
         call make_room(piece, n, n + 1)
         call make_room(away, n, n + 1)
         n = n + 1
         piece(n) = i
         away(n) = distance
      end do
   end subroutine add_crossings

   !> A rigid surface that is nearer than what is seen of the bodies; of several the nearest, of those as near the first.
   pure subroutine look_at_rigid(line, rigid, piece, away, seen)
      type(line_t), intent(in) :: line              !< of sight
      type(master_t), intent(in) :: rigid(:)        !< all rigid surfaces that may be seen
      integer(ip), allocatable, intent(inout) :: piece(:) !< room for a list
      real(wp), allocatable, intent(inout) :: away(:) !< room for its distances [L]
      type(sighting_t), intent(inout) :: seen       !< the best so far
      integer(ip) :: r, k, n

      do r = 1, size(rigid, kind=ip)
         call look_both_ways(line, rigid(r), piece, away, n)
         do k = 1, n
            if (max(seen%face, seen%rigid) > 0 .and. .not. abs(away(k)) < abs(seen%distance)) cycle
            seen = sighting_t(rigid=r, distance=away(k))
         end do
      end do
   end subroutine look_at_rigid

end module atrito_outlines
