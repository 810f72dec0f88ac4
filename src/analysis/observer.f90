!> Who looks at each increment that is solved, while all that was found of it is at hand: what --observe means is not known here.
module atrito_observer
   use atrito_history_lists, only: add_observed
   use atrito_increment_results, only: complete_results
   use atrito_results, only: history_row_t, observed_list_t, results_t
   use atrito_rigid_results, only: leave_mesh_alone
   use atrito_scene_data, only: scene_data_t
   implicit none (type, external)
   private
   public :: observer_t, note_observed

   !> Who looks at each increment.
   type, abstract :: observer_t
      logical :: is_there = .false.                  !< something is observed
      logical :: wants_stress = .false.              !< of every increment: stresses at the nodes, and the estimate of their error
   contains
      procedure(observe_increment), deferred :: observe
   end type observer_t

   abstract interface
      !> Puts what is observed into the results, and changes nothing else of them.
      subroutine observe_increment(self, results, rows)
         import :: history_row_t, observer_t, results_t
         class(observer_t), intent(inout) :: self   !< may keep that it has warned
         type(results_t), intent(inout) :: results  !< of the increment; observed is set
         type(history_row_t), intent(in) :: rows(:) !< of the history so far
      end subroutine observe_increment
   end interface

contains

   !> Notes what is observed of a converged increment. Stresses of one that is not printed are there as long as that takes.
   subroutine note_observed(observer, data, results, rows, list)
      class(observer_t), intent(inout) :: observer   !< expressions, read for this model
      type(scene_data_t), intent(inout) :: data      !< of the increment
      type(results_t), intent(inout) :: results      !< of the increment; complete where it is printed
      type(history_row_t), intent(in) :: rows(:)     !< of the history so far
      type(observed_list_t), intent(inout) :: list   !< becomes longer by the increment
      type(results_t) :: whole

      if (observer%wants_stress .and. .not. data%is_printed) then
         whole = results
         call complete_results(data, whole)
         call leave_mesh_alone(data, whole)
         call observer%observe(whole, rows)
         call move_alloc(whole%observed, results%observed)
      else
         call observer%observe(results, rows)
      end if
      call add_observed(results, list)
   end subroutine note_observed

end module atrito_observer
