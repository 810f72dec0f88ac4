!> The report of a run: verdict and key numbers from its results.
module atrito_run_report
   use atrito_html, only: fact_t, add_fact, unbroken
   use atrito_increments, only: list_increments, has_history, increment_name, ending_text
   use atrito_kinds, only: ip, wp
   use atrito_libraries, only: library_t
   use atrito_solver_report, only: list_used_libraries
   use atrito_messages, only: count_messages, SEVERITY_WARNING, SEVERITY_NOTE
   use atrito_model, only: model_t
   use atrito_page, only: bytes, number, plural
   use atrito_report, only: report_t
   use atrito_results, only: results_t, history_t, balance_t, last_frame
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_summary, only: body_count, pair_count, pair_name, error_text, uniqueness_text
   use atrito_system, only: peak_memory
   use atrito_table, only: abs_is_below
   use atrito_timers, only: phase_time_t, get_phases
   implicit none (type, external)
   private
   public :: report_of_run

   integer, parameter :: DIGITS = 6
   real(wp), parameter :: NOTHING = 1.0e-9_wp         !< of all forces: less is nothing to people

contains

   !> What the report of a run tells, but for the command.
   subroutine report_of_run(model, history, folder, files, pictures, report)
      type(model_t), intent(in) :: model            !< as solved
      type(history_t), intent(in) :: history        !< with frames
      character(len=*), intent(in) :: folder        !< of the tables
      type(string_t), intent(in) :: files(:)        !< that were written, names without folder
      type(string_t), intent(in) :: pictures(:)     !< that were drawn, names without ending
      type(report_t), intent(out) :: report         !< all but the command
      type(library_t), allocatable :: libraries(:)
      integer(ip) :: i
      type(phase_time_t), allocatable :: phases(:)
      character(len=:), allocatable :: points

      report%what = 'run'
      report%deck = model%deck_path
      report%folder = folder
      report%heading = model%heading
      report%files = files
      report%pictures = pictures
      associate (last => history%frames(last_frame(history)))
         call add_verdict(last, ending_text(history), report)
         allocate (report%facts(0))
         if (has_history(model, history)) then
            call add_fact(report%facts, 'history', plural(size(model%steps, kind=ip), 'step', 'steps')//', '// &
                          plural(size(list_increments(history), kind=ip), 'increment', 'increments'), &
                          'below: '//increment_name(last%step, last%increment, last%time))
         end if
         call add_fact(report%facts, 'loads, sum along 1 and 2', force_text(last%balance, last%balance%applied(:2)))
         call add_fact(report%facts, 'support reactions, sum', force_text(last%balance, last%balance%reactions(:2)))
         if (maxval(abs(last%balance%rigid(:2))) > 0.0_wp) call add_fact(report%facts, 'upon rigid surfaces, sum', &
                                                                         force_text(last%balance, last%balance%rigid(:2)))
         points = ''                                ! `, 7 contact points in 1 pair`
         if (allocated(last%scene%pairs)) then
            if (size(last%scene%pairs) > 0) points = ', '//plural(sum(last%scene%pairs%n_points), 'contact point', &
                                                                  'contact points')//' in '// &
                                                     plural(size(last%scene%pairs, kind=ip), 'pair', 'pairs')
         end if
         call add_fact(report%facts, 'model', plural(model%mesh%n_elements, 'element', 'elements')//', '// &
                       plural(model%mesh%n_nodes, 'node', 'nodes'), plural(body_count(last%scene), 'body', 'bodies')//', '// &
                       to_text(last%scene%n_dofs)//' free displacements'//points)
         phases = get_phases()
         call add_fact(report%facts, 'processor time', to_text(sum(phases%cpu), 3)//' s', bytes(peak_memory())//' of memory')
         report%units = model%units
         allocate (report%pairs(0), report%versions(0))
         do i = 1, pair_count(last)
            call append_string(report%pairs, 'pair '//to_text(i)//': '//pair_name(last, i))
         end do
         call list_used_libraries(last%scene, libraries)
      end associate
      do i = 1, size(libraries, kind=ip)
         call add_fact(report%versions, trim(libraries(i)%name), libraries(i)%version)
      end do
   end subroutine report_of_run

   subroutine add_verdict(last, ending, report)
      type(results_t), intent(in) :: last
      character(len=*), intent(in) :: ending        !< of a history that ended early; '' of others
      type(report_t), intent(inout) :: report
      character(len=:), allocatable :: unique

      allocate (report%details(0))
      report%is_good = last%converged .and. last%law_holds .and. len(ending) == 0
      if (report%is_good) then
         report%verdict = 'Solved and checked'
         call append_string(report%details, 'Equilibrium to '//number(last%equilibrium_residual, 2)//' of the largest force'// &
                            trim(merge('; the contact law holds at every point.', '.                                      ', &
                                       pair_count(last) > 0)))
         call append_string(report%details, 'Error: '//error_text(last)//'.')
         unique = uniqueness_text(last%uniqueness)
         if (len(unique) > 0) call append_string(report%details, 'Uniqueness: '//unique//'.')
      else if (len(ending) > 0) then
         report%verdict = 'NOT CONVERGED'
         call append_string(report%details, ending)
         call append_string(report%details, 'What is shown here converged before.')
      else
         report%verdict = 'NOT CONVERGED: this is the last iterate, not a solution'
         if (allocated(last%verdict)) call append_string(report%details, last%verdict)
      end if
      call append_string(report%details, plural(count_messages(SEVERITY_WARNING), 'warning', 'warnings')//', '// &
                         plural(count_messages(SEVERITY_NOTE), 'note', 'notes')//'.')
   end subroutine add_verdict

   !> Both components; what is rounding beside the others is 0.
   pure function force_text(balance, force) result(text)
      type(balance_t), intent(in) :: balance
      real(wp), intent(in) :: force(2)
      character(len=:), allocatable :: text
      real(wp) :: shown(2), least
      integer :: i

      least = NOTHING*max(maxval(abs(balance%applied(:2))), maxval(abs(balance%reactions(:2))))
      shown = force
      do i = 1, 2
         if (abs_is_below(shown(i), least)) shown(i) = 0.0_wp
      end do
      text = number(shown(1), DIGITS)//', '//unbroken(number(shown(2), DIGITS)//' [F]')
   end function force_text

end module atrito_run_report
