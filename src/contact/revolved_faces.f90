!> Faces of an axisymmetric slave: what their points weigh on the full circle, and what is done at the axis. Those of tapered
!> elements go the same way, with their thickness in the place of 2 pi r.
!>
!> The shape functions N of a face carry a uniform pressure by int N n 2 pi r ds, which the points have to have as weight and
!> normal, so that it passes from side to side exactly. (In the plane the trapezoidal rule and Simpson's do that.) A face of the
!> second degree gives a node on the axis nothing, int N 2 pi r ds = 0, and one near it next to nothing: there the points are those
!> of hat functions psi over the three nodes, as where the master ends under a face (atrito_mortar_points),
!>
!>     (1/W_j) int psi_j (u_slave - u_master) 2 pi r ds,   W_j = int psi_j 2 pi r ds > 0,
!>
!> whose sum is one, so that a uniform pressure is still carried exactly, and that on the axis has a value. The row of
!> such a point is a mean of the rows of the nodes of its faces: with S_ja = int psi_j N_a 2 pi r ds on a face, u_slave
!> = sum_a N_a u_a makes it sum_a S_ja/W_j (row of node a), and what the weight has from other faces stays with its own
!> node.
module atrito_revolved_faces
   use atrito_face_geometry, only: face_direction, outward_normal
   use atrito_growth, only: make_room
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, depth_places
   use atrito_plane_state, only: STATES, depth_at
   use atrito_points, only: contact_points_t, terms_t, add_term
   use atrito_shape_functions, only: face_shape_values, gauss_rule
   use atrito_slave_faces, only: nodal_rule_t
   use atrito_sorting, only: each_once
   implicit none (type, external)
   private
   public :: revolved_face_t, revolve_face, is_at_axis, hats, note_mixed, mix_rows

   integer(ip), parameter :: MOST = 3              !< nodes of a face
   !> A face of the second degree that begins within this part of its reach along the radius begins at the axis.
   real(wp), parameter :: AT_AXIS = 0.1_wp

   !> A face in the order of travel.
   type :: revolved_face_t
      integer(ip) :: n = 0                         !< nodes: 2 or 3
      logical :: mixes = .false.                   !< at the axis
      real(wp) :: weight(MOST) = 0.0_wp            !< of its points [L^2]
      real(wp) :: normal(2, MOST) = 0.0_wp         !< unit vectors
      real(wp) :: share(MOST, MOST) = 0.0_wp       !< int psi_j N_a 2 pi r ds where it mixes [L^2]
   end type revolved_face_t

contains

   !> Whether a face of the second degree touches the axis of its body of revolution, or nearly so: it begins within
   !> AT_AXIS of its extent along the radius from r = 0, where int N 2 pi r ds of its first node would be next to
   !> nothing, or negative.
   pure logical function is_at_axis(state, x)
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(in) :: x(:, :)              !< its nodes [L]

      is_at_axis = .false.
      if (.not. STATES(state)%has_hoop .or. size(x, 2) < MOST) return
      is_at_axis = minval(x(1, :)) < AT_AXIS*(maxval(x(1, :)) - minval(x(1, :)))
   end function is_at_axis

   !> Hat functions over the nodes at -1, 1 and 0 that are in use, constant beyond them: they add up to one and are not negative.
   pure function hats(in_use, t) result(psi)
      logical, intent(in) :: in_use(MOST)           !< nodes that have a function
      real(wp), intent(in) :: t                    !< [-1,1]
      real(wp) :: psi(MOST)

      psi = 0.0_wp
      select case (count(in_use))
      case (0)                                     ! both ends are tips
      case (1)
         where (in_use) psi = 1.0_wp
      case (2)
         if (in_use(1) .and. in_use(2)) then
            psi(:2) = [0.5_wp*(1 - t), 0.5_wp*(1 + t)]
         else if (in_use(1)) then
            psi([1, 3]) = [max(-t, 0.0_wp), min(1 + t, 1.0_wp)]
         else
            psi([2, 3]) = [max(t, 0.0_wp), min(1 - t, 1.0_wp)]
         end if
      case default
         psi = [max(-t, 0.0_wp), max(t, 0.0_wp), 1 - abs(t)]
      end select
   end function hats

   !> The weights and normals of a face: W_a n_a = int psi_a n 2 pi r ds, of which W_a is the length and n_a the
   !> direction, so that a uniform pressure has the nodal forces that the shape functions give it. With r and N of the
   !> first degree the integrand is of the second degree on straight faces of two nodes, of the fifth on parabolas (N, r
   !> and dx/dt): three Gauss points are exact.
   pure function revolve_face(mesh, state, thickness, rule) result(face)
      type(mesh_t), intent(in) :: mesh             !< nodes, and which elements are axisymmetric
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(in) :: thickness             !< of the element [L]
      type(nodal_rule_t), intent(in) :: rule       !< of the face
      type(revolved_face_t) :: face
      real(wp) :: x(2, MOST), vector(2, MOST), places(MOST)
      integer(ip) :: order(MOST), k, n

      n = rule%n
      order = [1_ip, 2_ip, 3_ip]
      if (n == MOST) order = [1_ip, 3_ip, 2_ip]    ! from the order of travel to corners, middle, and back
      do k = 1, n
         x(:, order(k)) = mesh%x(:, rule%node(k))
      end do
      places(order(:n)) = depth_places(mesh, state, rule%node(:n))
      face%n = n
      face%mixes = is_at_axis(state, x(:, :n))
      vector = 0.0_wp
      if (face%mixes) then                         ! the hats have a kink in the middle
         call add_part(x(:, :n), places(:n), state, thickness, [-1.0_wp, 0.0_wp], face, vector)
         call add_part(x(:, :n), places(:n), state, thickness, [0.0_wp, 1.0_wp], face, vector)
      else
         call add_part(x(:, :n), places(:n), state, thickness, [-1.0_wp, 1.0_wp], face, vector)
      end if
      do k = 1, n
         face%weight(k) = norm2(vector(:, order(k)))
         face%normal(:, k) = vector(:, order(k))/face%weight(k)
      end do
      face%share = face%share(order, order)
   end function revolve_face

   !> Adds the integrals over a part of a face: int psi_a n 2 pi r ds, and where rows are mixed int psi_j N_a 2 pi r ds.
   pure subroutine add_part(x, places, state, thickness, part, face, vector)
      real(wp), intent(in) :: x(:, :)              !< in the order of face_nodes [L]
      real(wp), intent(in) :: places(:)            !< what the depth goes by at these nodes (depth_places) [L]
      integer(ip), intent(in) :: state              !< place in STATES
      real(wp), intent(in) :: thickness, part(2)   !< part: of [-1,1]
      type(revolved_face_t), intent(inout) :: face
      real(wp), intent(inout) :: vector(2, MOST)   !< int psi n 2 pi r ds [L^2]
      real(wp) :: points(MOST), weights(MOST), t, ds, values(MOST), psi(MOST)
      integer(ip) :: g, n

      n = size(x, 2, kind=ip)
      call gauss_rule(MOST, points, weights)
      do g = 1, MOST
         t = 0.5_wp*((1 - points(g))*part(1) + (1 + points(g))*part(2))
         values = 0.0_wp
         values(:n) = face_shape_values(n, t)
         psi = values
         if (face%mixes) psi = hats([.true., .true., .true.], t)
         ds = 0.5_wp*weights(g)*(part(2) - part(1))*norm2(face_direction(x, t)) &
              *depth_at(state, thickness, dot_product(values(:n), places))
         vector = vector + ds*spread(outward_normal(x, t), 2, MOST)*spread(psi, 1, 2)
         if (face%mixes) face%share = face%share + ds*spread(psi, 2, MOST)*spread(values, 1, MOST)
      end do
   end subroutine add_part

   !> Notes that the points of a face mix the rows of its nodes: terms of a point, with other points in the place of
   !> nodes. The part of its weight that a point has from this face goes to the nodes of the face, in the ratio of int
   !> psi_j N_a 2 pi r ds.
   pure subroutine note_mixed(face, points, mixed)
      type(revolved_face_t), intent(in) :: face     !< from revolve_face
      integer(ip), intent(in) :: points(MOST)      !< of its nodes, in the order of travel
      type(terms_t), intent(inout) :: mixed         !< those of the faces so far
      integer(ip) :: j, a

      if (.not. face%mixes) return
      do j = 1, MOST
         do a = 1, MOST
            call add_term(points(j), points(a), face%share(j, a)/sum(face%share(j, :))*face%weight(j), mixed)
         end do
      end do
   end subroutine note_mixed

   !> From the rows of nodes to those of points: row j becomes the sum over its faces of share/W_j times the rows of
   !> their nodes, and its own with what is left of the weight. The gaps go with the rows. A row has its own node first,
   !> then others of the slave, then the master's.
   pure subroutine mix_rows(mixed, points)
      type(terms_t), intent(in) :: mixed            !< from note_mixed
      type(contact_points_t), intent(inout) :: points !< with the rows of nodes; out: of points
      integer(ip), allocatable :: terms(:), list(:), entry(:)
      real(wp), allocatable :: coefficient(:), gap(:)
      real(wp) :: part(points%n)                   ! of each point's row in row j
      integer(ip) :: first(points%n + 1), i, j, k, n

      if (mixed%n == 0) return
      allocate (entry(0), coefficient(0))
      gap = points%gap
      part = 0.0_wp
      n = 0
      do j = 1, points%n
         terms = pack([(k, k=1, mixed%n)], mixed%point(:mixed%n) == j)
         part(j) = points%weight(j)
         do k = 1, size(terms, kind=ip)
            associate (share => mixed%value(terms(k)), other => mixed%node(terms(k)))
               part(j) = part(j) - share
               part(other) = part(other) + share
            end associate
         end do
         list = each_once([j, mixed%node(terms)])
         part(list) = part(list)/points%weight(j)
         points%gap(j) = sum(part(list)*gap(list))
         first(j) = n + 1
         call add_to_row(points%node(j), part(j), first(j), entry, coefficient, n)
         list = pack(list, abs(part(list)) > 0.0_wp)
         do i = 1, size(list, kind=ip)
            if (list(i) /= j) call add_to_row(points%node(list(i)), part(list(i)), first(j), entry, coefficient, n)
         end do
         do i = 1, size(list, kind=ip)
            do k = points%first(list(i)) + 1, points%first(list(i) + 1) - 1
               call add_to_row(points%entry(k), part(list(i))*points%coefficient(k), first(j), entry, coefficient, n)
            end do
         end do
         part(list) = 0.0_wp
      end do
      first(points%n + 1) = n + 1
      points%first(:points%n + 1) = first
      points%entry = entry(:n)
      points%coefficient = coefficient(:n)
   end subroutine mix_rows

   !> Adds to the entry of a node in the last row, which is made where there is none yet.
   pure subroutine add_to_row(node, value, first, entry, coefficient, n)
      integer(ip), intent(in) :: node
      real(wp), intent(in) :: value                 !< of the entry
      integer(ip), intent(in) :: first             !< entry of the row
      integer(ip), allocatable, intent(inout) :: entry(:)
      real(wp), allocatable, intent(inout) :: coefficient(:)
      integer(ip), intent(inout) :: n              !< entries so far
      integer(ip) :: at

      at = first - 1 + findloc(entry(first:n), node, dim=1, kind=ip)
      if (at < first) then
         call make_room(entry, n, n + 1)
         call make_room(coefficient, n, n + 1)
         n = n + 1
         at = n
         entry(at) = node
         coefficient(at) = 0.0_wp
      end if
      coefficient(at) = coefficient(at) + value
   end subroutine add_to_row

end module atrito_revolved_faces
