!> A scene in one matrix is shared out over the ranks: the elements of a rank, with what belongs to them, are its part.
module atrito_scene_sharing
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_ranked_parts, only: ranked_parts_t
   use atrito_scene_elimination, only: scene_numbering_t, number_scene, eliminate_scene
   use atrito_scene_parts, only: scene_parts_t
   use atrito_scene_shares, only: share_elements
   use atrito_scene_top, only: trouble
   use atrito_shared_scene, only: shared_scene_t, share_scene
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: share_over_ranks

contains

   !> status: STATUS_INTERNAL when the memory does not suffice.
   subroutine share_over_ranks(fem, rows, line, value, n_ranks, scene, rank_of, status)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: value(:, :)        !< (2, n_nodes) prescribed displacements [L]
      integer(ip), intent(in) :: n_ranks
      type(shared_scene_t), intent(out) :: scene
      integer(ip), allocatable, intent(out) :: rank_of(:) !< (n_elements) 0..n_ranks - 1
      type(status_t), intent(out) :: status
      type(ranked_parts_t), allocatable :: ranked
      class(scene_parts_t), allocatable :: parts
      type(scene_numbering_t) :: numbering
      integer(ip) :: part_of_element(fem%mesh%n_elements), n_parts

      allocate (ranked)
      call number_scene(fem, numbering)
      call share_elements(fem, numbering, eliminate_scene(fem, rows, line, numbering), n_ranks, part_of_element, ranked%rank)
      rank_of = ranked%rank(part_of_element)
      n_parts = size(ranked%rank, kind=ip)
      call move_alloc(ranked, parts)
      call share_scene(fem, rows, line, value, part_of_element, n_parts, parts, scene, status)
      scene%rank_of = rank_of
      scene%trouble => trouble
   end subroutine share_over_ranks

end module atrito_scene_sharing
