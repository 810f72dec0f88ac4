!> Normals and curvature of a surface of element faces, as of the smooth curve that the faces stand for.
module atrito_smooth_normals
   use atrito_face_geometry, only: outward_normal
   use atrito_faces, only: face_list_t
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_nodes
   use atrito_slave_faces, only: sine, CORNER
   implicit none (type, external)
   private
   public :: smooth_surface, common_normal

   !> A smaller turn of the normal [rad] is rounding of the coordinates: the surface is straight there.
   real(wp), parameter :: NO_TURN = 1.0e-6_wp

contains

   !> Unit normals at the ends of each face, the mean of both faces unless they meet at a corner; and the curvature of each, the
   !> turn of the normal along it and at its ends over its length.
   pure subroutine smooth_surface(mesh, faces, ends, curvature)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces
      real(wp), allocatable, intent(out) :: ends(:, :, :) !< (2, first and last end, faces)
      real(wp), allocatable, intent(out) :: curvature(:)  !< (faces) [1/L] >= 0
      type(id_map_t) :: begins                      ! face of its first node
      real(wp) :: turn(faces%n), joints(faces%n), own(2, 2)
      integer(ip) :: n_joints(faces%n), last(faces%n), i, k
      logical :: known

      allocate (ends(2, 2, faces%n), curvature(faces%n))
      do i = 1, faces%n
         associate (nodes => face_nodes(mesh, faces%element(i), faces%face(i)))
            ends(:, 1, i) = outward_normal(mesh%x(:, nodes), -1.0_wp)
            ends(:, 2, i) = outward_normal(mesh%x(:, nodes), 1.0_wp)
            curvature(i) = 1/norm2(mesh%x(:, nodes(2)) - mesh%x(:, nodes(1)))
            last(i) = nodes(2)
            call add_id(begins, nodes(1), i, known)
         end associate
         turn(i) = asin(min(sine(ends(:, 1, i), ends(:, 2, i)), 1.0_wp))
      end do
      joints = 0.0_wp
      n_joints = 0
      do i = 1, faces%n
         k = find_id(begins, last(i))
         if (k == 0) cycle
         own = reshape([ends(:, 2, i), ends(:, 1, k)], [2, 2])
         if (sine(own(:, 1), own(:, 2)) > CORNER) cycle
         joints([i, k]) = joints([i, k]) + asin(sine(own(:, 1), own(:, 2)))
         n_joints([i, k]) = n_joints([i, k]) + 1
         ends(:, 2, i) = (own(:, 1) + own(:, 2))/norm2(own(:, 1) + own(:, 2))
         ends(:, 1, k) = ends(:, 2, i)
      end do
      turn = turn + joints/max(n_joints, 1_ip)
      curvature = merge(turn*curvature, 0.0_wp, turn > NO_TURN)
   end subroutine smooth_surface

   !> The direction in which two surfaces touch, out of the slave: of their normals the mean with the radii as weights, so that for
   !> two circles that touch it is the line between their centres, for a curve on a straight side the normal of that, and it does
   !> not depend on who is the slave. Of straight sides it is the slave's.
   pure function common_normal(slave_normal, slave_curvature, master_normal, master_curvature) result(n)
      real(wp), intent(in) :: slave_normal(2), slave_curvature    !< unit vector out of the body, [1/L] >= 0
      real(wp), intent(in) :: master_normal(2), master_curvature
      real(wp) :: n(2)

      n = slave_normal
      if (.not. slave_curvature > 0.0_wp) return
      n = (master_curvature*slave_normal - slave_curvature*master_normal)/(master_curvature + slave_curvature)
      n = n/norm2(n)
   end function common_normal

end module atrito_smooth_normals
