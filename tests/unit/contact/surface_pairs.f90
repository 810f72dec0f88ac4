!> A pair made from its two sides, and the averages of several pairs as one, for tests.
module surface_pairs
   use atrito_average, only: average_t
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp
   use atrito_master, only: master_t, master_of_faces, master_of_segments
   use atrito_mesh, only: mesh_t
   use atrito_nodal_points, only: pair_with_master
   use atrito_points, only: contact_points_t
   implicit none (type, external)
   private
   public :: pair_surfaces, join_averages

contains

   !> Points of the slave that face the master. n = 0 when none does.
   pure subroutine pair_surfaces(mesh, thickness, slave, master_faces, master_points, points, is_arc, centre)
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: thickness(:)          !< of each element [L]
      type(face_list_t), intent(in) :: slave        !< one chain, ordered (order_chain)
      type(face_list_t), intent(in) :: master_faces !< n = 0: the master is rigid
      real(wp), intent(in) :: master_points(:, :)   !< ends of the rigid segments [L], (2, pieces+1) or (2, 0)
      type(contact_points_t), intent(out) :: points
      logical, intent(in), optional :: is_arc(:)    !< (pieces) of the rigid segments; default: straight
      real(wp), intent(in), optional :: centre(:, :) !< (2, pieces) of the arcs [L]
      type(master_t) :: master

      if (master_faces%n > 0) then
         call master_of_faces(mesh, master_faces, master)
      else
         call master_of_segments(master_points, master, is_arc, centre)
      end if
      call pair_with_master(mesh, thickness, slave, master_faces, master, points)
   end subroutine pair_surfaces

   !> The averages of several pairs as one: the points of each are averaged among themselves.
   pure function join_averages(list) result(w)
      type(average_t), intent(in) :: list(:)
      type(average_t) :: w
      integer(ip) :: i, entries, n

      n = sum(list%n)
      entries = 0
      do i = 1, size(list, kind=ip)
         entries = entries + size(list(i)%value, kind=ip)
      end do
      allocate (w%first(n + 1), w%column(entries), w%value(entries))
      w%first(1) = 1
      entries = 0
      do i = 1, size(list, kind=ip)
         associate (more => list(i), last => entries + size(list(i)%value))
            w%first(w%n + 2:w%n + 1 + more%n) = more%first(2:) + entries
            w%column(entries + 1:last) = more%column + w%n
            w%value(entries + 1:last) = more%value
            w%is_identity = w%is_identity .and. more%is_identity
            w%n = w%n + more%n
            entries = last
         end associate
      end do
   end function join_averages

end module surface_pairs
