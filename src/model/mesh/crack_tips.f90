!> Nodes that both sides of a contact pair have: sound at the tip of a crack, where its faces end, and nowhere else.
module atrito_crack_tips
   use atrito_faces, only: face_list_t, face_normal, node_elements_t
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_end, side_count
   implicit none (type, external)
   private
   public :: is_crack_tip

   real(wp), parameter :: FACING = -1.0e-3_wp      !< cosine of normals of faces that see each other (atrito_master)
   real(wp), parameter :: HALF_TURN = acos(-1.0_wp)

contains

   !> Whether one face of either side ends at a node, they face each other, and the bodies fill more than half of what is around it.
   !> The sides of a corner that points outwards are no crack, however sharp it is: between them there is the body.
   pure logical function is_crack_tip(mesh, around, node, slave, master) result(is_tip)
      type(mesh_t), intent(in) :: mesh
      type(node_elements_t), intent(in) :: around
      integer(ip), intent(in) :: node
      type(face_list_t), intent(in) :: slave, master
      integer(ip) :: own, other

      own = only_face_at(mesh, node, slave)
      other = only_face_at(mesh, node, master)
      is_tip = own > 0 .and. other > 0
      if (.not. is_tip) return
      is_tip = dot_product(face_normal(mesh, slave%element(own), slave%face(own)), &
                           face_normal(mesh, master%element(other), master%face(other))) <= FACING
      if (is_tip) is_tip = filled_angle(mesh, around, node) > HALF_TURN
   end function is_crack_tip

   !> The one face of a list that begins or ends at a node; 0 where there is none, or more.
   pure integer(ip) function only_face_at(mesh, node, faces) result(found)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: node
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
   pure real(wp) function filled_angle(mesh, around, node) result(angle)
      type(mesh_t), intent(in) :: mesh
      type(node_elements_t), intent(in) :: around
      integer(ip), intent(in) :: node
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

end module atrito_crack_tips
