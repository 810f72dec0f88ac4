!> A scene distributed over the ranks (distribution_t): what whoever solves it is given by the program.
module atrito_rank_distribution
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: rank_count
   use atrito_rank_memory, only: check_ranks
   use atrito_scene_data, only: distribution_t
   use atrito_scene_system, only: scene_system_t
   use atrito_shared_fields, only: field_distribution_t
   use atrito_shared_scene, only: shared_scene_t, share_scene
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: distribute_over_ranks, rank_distribution_t

   !> A scene over the ranks (distribution_t).
   type, extends(field_distribution_t) :: rank_distribution_t
      logical :: is_always = .false.                 !< whether it pays off or not
   contains
      procedure :: pays_off
      procedure, nopass :: check_memory => check_ranks
      procedure :: assemble
   end type rank_distribution_t

   !> Scenes with fewer displacements, some 0.3 s of one process, are not shared out. A contact force counts as some displacements:
   !> who has many iterates longer.
   integer(lp), parameter :: LEAST_DISPLACEMENTS = 200000_lp, OF_A_FORCE = 20_lp

contains

   !> Where there are several ranks.
   subroutine distribute_over_ranks(is_always, distribution)
      logical, intent(in) :: is_always               !< small scenes, too
      class(distribution_t), allocatable, intent(out) :: distribution !< not allocated: there is one rank
      type(rank_distribution_t), allocatable :: ranks

      if (rank_count() == 1) return
      allocate (ranks)
      ranks%is_always = is_always
      ranks%reason = 'the one that goes over ranks'
      call move_alloc(ranks, distribution)
   end subroutine distribute_over_ranks

   !> Whether a scene is large enough, or is to be shared out in any case.
   logical function pays_off(self, n_displacements, n_forces)
      class(rank_distribution_t), intent(in) :: self
      integer(ip), intent(in) :: n_displacements, n_forces

      pays_off = self%is_always .or. n_displacements + OF_A_FORCE*n_forces >= LEAST_DISPLACEMENTS
   end function pays_off

   subroutine assemble(self, fem, rows, line, value, scene, status)
      class(rank_distribution_t), intent(inout) :: self
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: value(:, :)
      class(scene_system_t), allocatable, intent(out) :: scene
      type(status_t), intent(out) :: status
      type(shared_scene_t), allocatable :: shared

      allocate (shared)
      call share_scene(fem, rows, line, value, rank_count(), shared, self%rank_of, status)
      call move_alloc(shared, scene)
   end subroutine assemble

end module atrito_rank_distribution
