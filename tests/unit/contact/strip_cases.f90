!> Two bodies one on the other, for the tests of the contact points.
module strip_cases
   use atrito_faces, only: face_list_t, add_face
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, add_element, add_node, trim_mesh
   use atrito_plane_state, only: PLANE_STRAIN
   implicit none (type, external)
   private
   public :: add_strip, begin_scene, FACE_BELOW, FACE_ABOVE

   integer(ip), parameter :: FACE_BELOW = 1, FACE_ABOVE = 3   !< faces of the elements of a strip

contains

   !> An empty mesh.
   subroutine begin_scene(mesh)
      type(mesh_t), intent(out) :: mesh

      mesh%n_nodes = 0
   end subroutine begin_scene

   !> A strip of elements between the abscissae x, from y_below up by 1 (down by 1 where `hangs`, so that y_below is its top).
   !> faces: those of its lower (upper where it hangs) side in the order of a chain, counter-clockwise round the strip. All is
   !> turned by `angle` about the origin.
   subroutine add_strip(mesh, x, y, hangs, order, angle, faces)
      type(mesh_t), intent(inout) :: mesh
      real(wp), intent(in) :: x(:)                  !< ends of the elements, ascending
      real(wp), intent(in) :: y                     !< of the side that is asked for
      logical, intent(in) :: hangs
      integer(ip), intent(in) :: order              !< 1: Q1, 2: Q2
      real(wp), intent(in) :: angle
      type(face_list_t), intent(out) :: faces
      integer(ip) :: i, j, columns, first, rows, corner, e, up, k
      integer(ip) :: nodes(9)
      logical :: known
      real(wp) :: low, place(2)

      rows = order + 1
      columns = order*(size(x, kind=ip) - 1) + 1
      first = mesh%n_nodes
      low = merge(y - 1.0_wp, y, hangs)
      do j = 0, rows - 1
         do i = 1, columns
            k = (i - 1)/order + 1
            place(1) = x(k)
            if (mod(i - 1, order) /= 0) place(1) = 0.5_wp*(x(k) + x(k + 1))
            place(2) = low + real(j, wp)/order
            call add_node(mesh, mesh%n_nodes + 1, turned(place, angle), known)
         end do
      end do
      do e = 1, size(x, kind=ip) - 1
         corner = first + order*(e - 1) + 1
         up = order*columns
         nodes(:4) = [corner, corner + order, corner + order + up, corner + up]
         if (order == 2) nodes(5:) = [corner + 1, corner + 2 + columns, corner + 1 + up, corner + columns, corner + 1 + columns]
         call add_element(mesh, mesh%n_elements + 1, PLANE_STRAIN, nodes(:merge(4, 9, order == 1)), known)
      end do
      first = mesh%n_elements - size(x, kind=ip) + 1
      do e = 1, size(x, kind=ip) - 1
         if (hangs) call add_face(faces, first + size(x, kind=ip) - e, FACE_ABOVE)
         if (.not. hangs) call add_face(faces, first + e, FACE_BELOW)
      end do
   end subroutine add_strip

   pure function turned(x, angle) result(y)
      real(wp), intent(in) :: x(2), angle
      real(wp) :: y(2)

      y = [cos(angle)*x(1) - sin(angle)*x(2), sin(angle)*x(1) + cos(angle)*x(2)]
   end function turned

end module strip_cases
