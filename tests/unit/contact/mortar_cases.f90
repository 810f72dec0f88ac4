!> Sides that do not match, for the tests of MORTAR.
module mortar_cases
   use atrito_faces, only: add_face, face_list_t
   use atrito_kinds, only: ip, wp, PI
   use atrito_master, only: master_t, master_of_faces, master_of_segments
   use atrito_mesh, only: add_element, add_node, mesh_t
   use atrito_mortar_points, only: pair_by_mortar
   use atrito_mortar_segments, only: segments_t, cut_slave
   use atrito_nodal_points, only: pair_with_master
   use atrito_plane_state, only: PLANE_STRAIN, AXISYMMETRIC
   use atrito_points, only: contact_points_t
   use strip_cases, only: add_strip, begin_scene
   implicit none (type, external)
   private
   public :: mortar_case_t, two_strips, revolved_strips, strip_on_line, ring_in_ring, pair_up, row_of, THICKNESS

   real(wp), parameter :: THICKNESS = 0.5_wp

   type :: mortar_case_t
      type(mesh_t) :: mesh
      type(face_list_t) :: slave, faces
      type(master_t) :: master
      type(segments_t) :: segments
      type(contact_points_t) :: points
   end type mortar_case_t

contains

   !> The upper strip (slave) between `upper` at height `gap` over the lower one between `lower`; turned, or bent to the parabola
   !> x2 + bend x1^2, and moved.
   subroutine two_strips(upper, lower, gap, order, scene, angle, bend, shift, softer)
      real(wp), intent(in) :: upper(:), lower(:), gap
      integer(ip), intent(in) :: order(2)
      type(mortar_case_t), intent(out) :: scene
      real(wp), intent(in), optional :: angle, bend, shift
      real(wp), intent(in), optional :: softer      !< the slave's compliance over the master's
      real(wp) :: tilt

      tilt = 0.0_wp
      if (present(angle)) tilt = angle
      call begin_scene(scene%mesh)
      call add_strip(scene%mesh, upper, gap, .false., order(1), tilt, scene%slave)
      call add_strip(scene%mesh, lower, 0.0_wp, .true., order(2), tilt, scene%faces)
      if (present(bend)) scene%mesh%x(2, :) = scene%mesh%x(2, :) + bend*scene%mesh%x(1, :)**2
      if (present(shift)) scene%mesh%x = scene%mesh%x + shift
      call pair_up(scene, softer)
   end subroutine two_strips

   !> Two strips that turn about the axis x1 = 0; their points by NODAL, or by MORTAR.
   subroutine revolved_strips(upper, lower, gap, order, nodal, scene)
      real(wp), intent(in) :: upper(:), lower(:), gap
      integer(ip), intent(in) :: order
      logical, intent(in) :: nodal
      type(mortar_case_t), intent(out) :: scene
      real(wp), allocatable :: depth(:)
      integer(ip) :: i

      call begin_scene(scene%mesh)
      call add_strip(scene%mesh, upper, gap, .false., order, 0.0_wp, scene%slave)
      call add_strip(scene%mesh, lower, 0.0_wp, .true., order, 0.0_wp, scene%faces)
      scene%mesh%state = AXISYMMETRIC
      call master_of_faces(scene%mesh, scene%faces, scene%master)
      allocate (depth(scene%mesh%n_elements), source=1.0_wp)
      if (nodal) then
         call pair_with_master(scene%mesh, depth, scene%slave, scene%faces, scene%master, scene%points)
      else
         call pair_by_mortar(scene%mesh, depth, scene%slave, scene%faces, scene%master, [(1.0_wp, i=1, scene%slave%n)], &
                             [(1.0_wp, i=1, scene%faces%n)], scene%points)
      end if
   end subroutine revolved_strips

   !> A strip at height `gap` on a rigid line through `ends`, or on an arc about `centre`.
   subroutine strip_on_line(x, gap, order, ends, scene, centre)
      real(wp), intent(in) :: x(:), gap, ends(:, :)
      integer(ip), intent(in) :: order
      type(mortar_case_t), intent(out) :: scene
      real(wp), intent(in), optional :: centre(2)
      integer(ip) :: n

      n = size(ends, 2, kind=ip) - 1
      call begin_scene(scene%mesh)
      call add_strip(scene%mesh, x, gap, .false., order, 0.0_wp, scene%slave)
      if (present(centre)) then
         call master_of_segments(ends, scene%master, spread(.true., 1, n), spread(centre, 2, n))
      else
         call master_of_segments(ends, scene%master)
      end if
      call pair_up(scene)
   end subroutine strip_on_line

   !> A ring of n elements with its corners on the circle of radius 1, inside one of m elements, which may be too tight.
   subroutine ring_in_ring(n, m, scene, tight)
      integer(ip), intent(in) :: n, m
      type(mortar_case_t), intent(out) :: scene
      real(wp), intent(in), optional :: tight       !< radius less that of the hole
      real(wp) :: hole

      hole = 1.0_wp
      if (present(tight)) hole = 1 - tight

      call begin_scene(scene%mesh)
      call add_ring(scene%mesh, n, 0.5_wp, 1.0_wp, 3_ip, scene%slave)
      call add_ring(scene%mesh, m, hole, 1.5_wp, 1_ip, scene%faces)
      call pair_up(scene)
   end subroutine ring_in_ring

   !> Face 1 of the elements is the inner side, face 3 the outer one; round the body in the order of a chain.
   subroutine add_ring(mesh, n, inner, outer, face, faces)
      type(mesh_t), intent(inout) :: mesh
      integer(ip), intent(in) :: n, face
      real(wp), intent(in) :: inner, outer
      type(face_list_t), intent(out) :: faces
      integer(ip) :: i, first, after, e
      real(wp) :: angle
      logical :: known

      first = mesh%n_nodes
      do i = 0, n - 1
         angle = -2*PI*i/n                          ! clockwise, so that the outside is face 3
         call add_node(mesh, first + 2*i + 1, inner*[cos(angle), sin(angle)], known)
         call add_node(mesh, first + 2*i + 2, outer*[cos(angle), sin(angle)], known)
      end do
      e = mesh%n_elements
      do i = 0, n - 1
         after = mod(i + 1, n)
         call add_element(mesh, e + i + 1, PLANE_STRAIN, first + [2*i + 1, 2*after + 1, 2*after + 2, 2*i + 2], known)
      end do
      do i = 0, n - 1
         call add_face(faces, e + merge(n - i, i + 1, face == 3), face)
      end do
   end subroutine add_ring

   !> Segments and points of a scene whose sides are there.
   subroutine pair_up(scene, softer)
      type(mortar_case_t), intent(inout) :: scene
      real(wp), intent(in), optional :: softer      !< the slave's compliance over the master's
      real(wp), allocatable :: depth(:)
      real(wp) :: compliance
      integer(ip) :: i

      compliance = 1.0_wp
      if (present(softer)) compliance = softer
      if (scene%faces%n > 0) call master_of_faces(scene%mesh, scene%faces, scene%master)
      allocate (depth(scene%mesh%n_elements), source=THICKNESS)
      call cut_slave(scene%mesh, scene%slave, scene%master, scene%segments)
      call pair_by_mortar(scene%mesh, depth, scene%slave, scene%faces, scene%master, [(compliance, i=1, scene%slave%n)], &
                          [(1.0_wp, i=1, scene%faces%n)], scene%points)
   end subroutine pair_up

   !> The coefficients of a point at all nodes.
   function row_of(scene, j) result(row)
      type(mortar_case_t), intent(in) :: scene
      integer(ip), intent(in) :: j
      real(wp) :: row(scene%mesh%n_nodes)
      integer(ip) :: k

      row = 0.0_wp
      do k = scene%points%first(j), scene%points%first(j + 1) - 1
         row(scene%points%entry(k)) = row(scene%points%entry(k)) + scene%points%coefficient(k)
      end do
   end function row_of

end module mortar_cases
