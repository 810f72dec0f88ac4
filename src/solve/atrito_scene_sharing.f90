!> A scene in one matrix is shared out over the ranks: what belongs to the shares of a rank is its part.
module atrito_scene_sharing
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_ranked_parts, only: ranked_parts_t
   use atrito_scene_parts, only: scene_parts_t
   use atrito_shared_scene, only: shared_scene_t, share_scene
   use atrito_shares, only: shares_t
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: share_over_ranks, list_parts

contains

   !> status: STATUS_INTERNAL when the memory does not suffice.
   subroutine share_over_ranks(fem, rows, line, value, shares, scene, status)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: value(:, :)        !< (2, n_nodes) prescribed displacements [L]
      type(shares_t), intent(in) :: shares
      type(shared_scene_t), intent(out) :: scene
      type(status_t), intent(out) :: status
      type(ranked_parts_t), allocatable :: ranked
      class(scene_parts_t), allocatable :: parts
      integer(ip) :: part_of_element(fem%mesh%n_elements), n_parts

      allocate (ranked)
      call list_parts(shares, part_of_element, ranked%rank)
      n_parts = size(ranked%rank, kind=ip)
      call move_alloc(ranked, parts)
      call share_scene(fem, rows, line, value, part_of_element, n_parts, parts, scene, status)
   end subroutine share_over_ranks

   !> One part for each rank that has elements, in the order of the ranks; elements of rigid bodies, which have no stiffness, go
   !> with the first one.
   pure subroutine list_parts(shares, part_of_element, rank)
      type(shares_t), intent(in) :: shares
      integer(ip), intent(out) :: part_of_element(:) !< (n_elements)
      integer(ip), allocatable, intent(out) :: rank(:) !< (parts)
      integer(ip) :: part_of_rank(0:shares%n_ranks - 1), i

      part_of_rank = 0
      allocate (rank(0))
      do i = 0, shares%n_ranks - 1
         if (.not. any(shares%list%rank == i)) cycle
         rank = [rank, i]
         part_of_rank(i) = size(rank, kind=ip)
      end do
      part_of_element = 1
      do i = 1, shares%n
         part_of_element(shares%list(i)%elements) = part_of_rank(shares%list(i)%rank)
      end do
   end subroutine list_parts

end module atrito_scene_sharing
