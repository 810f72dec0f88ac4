!> One run once more with half of a regularisation, to see what it does to the quantities of a study. Nothing is written.
module atrito_study_probe
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_body_store, only: body_store_t
   use atrito_command_line, only: command_t
   use atrito_kinds, only: ip, wp
   use atrito_messages, only: clear_messages
   use atrito_model, only: model_t, interaction_t
   use atrito_reporter, only: reporter_t
   use atrito_results, only: results_t
   use atrito_run, only: load_model, solve_options, agree_on_outcome
   use atrito_solve, only: solve_static
   use atrito_status, only: status_t, is_ok, STATUS_OK
   use atrito_strings, only: string_t
   use atrito_summary, only: quantity_t, scales_t, pair_quantities, step_quantities, summarise_pair
   implicit none (type, external)
   private
   public :: probe_deck

contains

   !> Quantities of summary.tab, of the first pair or of the step, with scaled regularisations; nan without a solution.
   subroutine probe_deck(command, delta_factor, eps_factor, names, values)
      type(command_t), intent(in) :: command
      real(wp), intent(in) :: delta_factor           !< of delta
      real(wp), intent(in) :: eps_factor             !< of eps, and of the compliance of the stick slope
      type(string_t), intent(in) :: names(:)
      real(wp), intent(out) :: values(:)
      type(body_store_t) :: store
      type(model_t) :: model
      type(results_t) :: results
      type(reporter_t) :: reporter
      type(status_t) :: status
      integer(ip) :: told
      integer :: code

      values = ieee_value(1.0_wp, ieee_quiet_nan)
      reporter%quiet = .true.
      call clear_messages()
      call load_model(command, reporter, model, told, code)
      if (code /= STATUS_OK) return
      call scale_laws(model%interactions, delta_factor, eps_factor)
      call solve_static(model, solve_options(command), reporter, results, status, store)
      if (is_ok(status)) call agree_on_outcome(status, results)
      if (is_ok(status)) call find_values(results, names, values)
      call clear_messages()
   end subroutine probe_deck

   pure elemental subroutine scale_laws(law, delta_factor, eps_factor)
      type(interaction_t), intent(inout) :: law
      real(wp), intent(in) :: delta_factor, eps_factor

      law%delta = delta_factor*law%delta
      law%eps = eps_factor*law%eps
      law%stick_slope = law%stick_slope/eps_factor
   end subroutine scale_laws

   pure subroutine find_values(results, names, values)
      type(results_t), intent(in) :: results
      type(string_t), intent(in) :: names(:)
      real(wp), intent(inout) :: values(:)
      type(quantity_t), allocatable :: list(:)
      integer :: i, k

      list = [pair_quantities(summarise_pair(results%contact(1)), scales_t()), step_quantities(results)]
      do i = 1, size(names)
         do k = 1, size(list)
            if (list(k)%name == names(i)%s) values(i) = list(k)%value
         end do
      end do
   end subroutine find_values

end module atrito_study_probe
