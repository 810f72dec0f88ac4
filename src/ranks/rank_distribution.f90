!> A scene distributed over the ranks (distribution_t): what whoever solves it is given by the program.
module atrito_rank_distribution
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: rank_count
   use atrito_rank_memory, only: check_ranks
   use atrito_results, only: results_t
   use atrito_scene_data, only: distribution_t
   use atrito_scene_system, only: scene_system_t
   use atrito_shared_fields, only: shared_fields_t, begin_fields, end_fields
   use atrito_shared_scene, only: shared_scene_t, share_scene
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: distribute_over_ranks, rank_distribution_t

   type, extends(distribution_t) :: rank_distribution_t
      logical :: is_always = .false.                 !< whether it pays off or not
      integer(ip), allocatable :: rank_of(:)         !< (n_elements) from 0
      type(shared_fields_t) :: fields
   contains
      procedure :: pays_off
      procedure, nopass :: check_memory => check_ranks
      procedure :: assemble
      procedure :: begin_fields => begin_own
      procedure :: end_fields => end_own
   end type rank_distribution_t

   !> Scenes with fewer displacements, some 0.3 s of one process, are not shared out. A contact force counts as some displacements:
   !> who has many iterates longer.
   integer(lp), parameter :: LEAST_DISPLACEMENTS = 200000_lp, OF_A_FORCE = 20_lp

contains

   !> Where there are several ranks.
   subroutine distribute_over_ranks(is_always, distribution)
      logical, intent(in) :: is_always               !< small scenes, too
      class(distribution_t), allocatable, intent(out) :: distribution
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

   subroutine begin_own(self, fem, u, by_element)
      class(rank_distribution_t), intent(inout) :: self
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      logical, intent(in) :: by_element

      if (.not. self%fields%has_begun) call begin_fields(fem, self%rank_of, u, by_element, self%fields)
   end subroutine begin_own

   subroutine end_own(self, fem, results, strain_bound)
      class(rank_distribution_t), intent(inout) :: self
      type(fem_t), intent(in) :: fem
      type(results_t), intent(inout) :: results
      real(wp), intent(out) :: strain_bound

      call end_fields(fem, self%fields, results, strain_bound)
   end subroutine end_own

end module atrito_rank_distribution
