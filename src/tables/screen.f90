!> The closing summary of a run, at most a screen of 80 columns by 24 lines, and what `atrito check` prints.
module atrito_screen
   use atrito_controls, only: METHOD_NAME
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, ends_with, to_text
   use atrito_messages, only: count_messages, SEVERITY_WARNING, SEVERITY_NOTE
   use atrito_system, only: peak_memory
   use atrito_timers, only: phase_time_t, get_phases
   use atrito_model, only: model_t, in_units
   use atrito_results, only: results_t, history_t, observed_t, quantity_bound_t, scene_t, has_forces, last_frame
   use atrito_increments, only: list_increments, has_history, increment_name, ending_text
   use atrito_extreme_report, only: add_extremes
   use atrito_model_report, only: describe_counts, describe_instances, describe_steps, is_history
   use atrito_resultant_report, only: add_supports
   use atrito_row_tables, only: joined_text
   use atrito_scene_report, only: describe_needs, describe_bodies, describe_names, describe_pairs
   use atrito_page, only: page_t, begin_report, add_blank, add_heading, add_item, add_line, add_rule, left, right, number, bytes, &
                          plural
   use atrito_plot_files, only: plot_folder, told_pictures, REPORT_NAME
   use atrito_summary, only: bound_text, error_text, large_text, pair_summary_t, summarise_pair, states_text, closed_word, &
                             body_count, pair_count, pair_name, uniqueness_text
   use atrito_table, only: TAB_ENDING, CSV_ENDING
   implicit none (type, external)
   private
   public :: compose_summary, compose_check

   integer, parameter :: WIDTH = 79                 !< columns; a terminal of 80 does not wrap
   integer, parameter :: SCREEN_LINES = 24
   integer, parameter :: CLOSING_LINES = 5          !< of the end, without pictures and field files
   integer, parameter :: ANSWER_LINES = 3           !< the largest displacement and stress, and supports
   integer, parameter :: LEAST_OF_PAIRS = 5         !< the first of them: before other answers, which are in the listing, too
   integer(ip), parameter :: MOST_STEPS = 200       !< that `check` describes
   integer, parameter :: MOST_OBSERVED = 2          !< lines of what is observed, and one that tells of more
   integer, parameter :: LABELS = 13                !< columns of the label of an item
   integer, parameter :: MOST_OUTER = 4             !< outer iterations shown of a run that did not converge
   integer, parameter :: UNSETTLED_LINES = 2
   integer, parameter :: DIGITS = 5
   integer, parameter :: LABEL_WIDTH = 34           !< columns of a pair's name

contains

   !> Begins the report on a deck with its first line of *HEADING.
   pure subroutine begin_deck_report(page, model, what)
      type(page_t), intent(out) :: page
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: what          !< was done, with a blank before it; empty for a run

      call begin_report(page, what//'   '//model%deck_path)
      if (size(model%heading) > 0) call add_line(page, left(model%heading(1)%s, page%width))
      page%units = model%units
      page%n_titles = page%n
   end subroutine begin_deck_report

   !> Composes the summary: of a history its last increment. folder and files: where the run was written.
   subroutine compose_summary(model, history, folder, files, page, pictures)
      type(model_t), intent(in) :: model                  !< as solved
      type(history_t), intent(in) :: history              !< with all frames; it is not empty
      character(len=*), intent(in) :: folder              !< as the user wrote it
      type(string_t), intent(in) :: files(:)              !< names without folder
      type(page_t), intent(out) :: page                   !< at most 24 lines of 79 columns
      type(string_t), intent(in), optional :: pictures(:) !< that were drawn, names without folder and ending
      integer :: after                              ! lines of the end
      integer :: i, n_bounded, extra_lines
      logical :: has_trail
      integer(ip) :: most

      call begin_deck_report(page, model, '')
      call add_rule(page, '-')
      associate (last => history%frames(last_frame(history)))
         call add_verdict(page, last, ending_text(history))
         call add_sizes(page, model, last)
         if (has_history(model, history)) then
            call add_item(page, 'history', plural(size(model%steps, kind=ip), 'step', 'steps')//', '// &
                          plural(size(list_increments(history), kind=ip), 'increment', 'increments')//'; below: '// &
                          increment_name(last%step, last%increment, last%time))
         end if
         n_bounded = 0
         if (allocated(last%bounded)) n_bounded = size(last%bounded)
         ! bounds, which stand behind all else that is observed, have lines of their own
         if (allocated(last%observed)) call add_observed(page, last%observed(:size(last%observed) - 2*n_bounded))
         ! A line for each of the first bounds, and what they are bounds of.
         do i = 1, min(n_bounded, MOST_OBSERVED)
            associate (bound => last%bounded(i))
               call add_item(page, trim(merge('bounded', '       ', i == 1)), trim(bound%name)//' '//bound_text(bound))
            end associate
         end do
         if (n_bounded > MOST_OBSERVED) call add_item(page, '', 'and '//to_text(int(n_bounded - MOST_OBSERVED, ip))// &
                                                      ' more in the listing')
         ! Lines of pictures, field files and the report.
         extra_lines = merge(1, 0, present(pictures))
         do i = 1, size(files)
            if (ends_with(files(i)%s, '.xdmf') .or. files(i)%s == REPORT_NAME) extra_lines = extra_lines + 1
         end do
         after = CLOSING_LINES + extra_lines
         if (last%converged .and. last%law_holds .and. SCREEN_LINES - page%n - after >= ANSWER_LINES + LEAST_OF_PAIRS) then
            call add_extremes(page, last)
            call add_supports(page, model, last)
         end if
         ! Whether the way of an iteration that did not converge is known.
         has_trail = .not. last%converged .and. last%scene%outer_loop .and. allocated(last%iterations)
         if (has_trail) has_trail = size(last%iterations) > 0
         if (has_trail) then                  ! the pairs of the last iterate say less than how it got there
            call add_trail(page, last, SCREEN_LINES - page%n - after)
         else
            ! How many pairs there is room for: two lines each behind a head of three, and one that tells of more.
            associate (room => SCREEN_LINES - page%n - after)
               most = int((room - 3)/2, ip)
               if (most < pair_count(last)) most = int((room - 4)/2, ip)
               most = max(0_ip, most)
            end associate
            call add_pairs(page, last, most)
         end if
      end associate
      call add_rule(page, '-')
      call add_closing(page, folder, files)
      if (present(pictures)) then
         if (size(pictures) > 0) call add_item(page, 'plots in', plot_folder(folder)//': '//told_pictures(pictures))
      end if
      call add_rule(page, '=')
   end subroutine compose_summary

   !> `tip = -0.012, peak = 3.4`: what some lines hold; all are in the listing.
   subroutine add_observed(page, observed)
      type(page_t), intent(inout) :: page
      type(observed_t), intent(in) :: observed(:)
      character(len=:), allocatable :: text, next
      integer :: i, n

      text = ''
      n = 0
      do i = 1, size(observed)
         next = trim(observed(i)%name)//' = '//number(observed(i)%value, DIGITS)
         if (len(text) > 0 .and. len(text) + len(next) + len(', ,') > WIDTH - LABELS) then
            n = n + 1
            call add_item(page, trim(merge('observed', '        ', n == 1)), text//',')
            text = ''
            if (n == MOST_OBSERVED) next = 'and '//to_text(size(observed, kind=ip) - int(i, ip) + 1)//' more in the listing'
         else if (i > 1) then
            text = text//', '
         end if
         text = text//next
         if (n == MOST_OBSERVED) exit
      end do
      call add_item(page, trim(merge('observed', '        ', n == 0)), text)
   end subroutine add_observed

   subroutine add_verdict(page, results, ending)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      character(len=*), intent(in) :: ending        !< of a history that ended early; '' of others
      integer :: colon

      if (len(ending) > 0) then
         colon = index(ending//': ', ': ')
         call add_line(page, left('NOT CONVERGED: '//ending(:colon - 1), WIDTH))
         call add_line(page, left(ending(min(len(ending) + 1, colon + 2):), WIDTH))
         return
      end if
      if (results%converged .and. results%law_holds) return
      call add_line(page, 'NOT CONVERGED: the tables hold the last iterate, not a solution.')
      if (allocated(results%verdict)) call add_line(page, left(results%verdict, WIDTH))
   end subroutine add_verdict

   subroutine add_sizes(page, model, results)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: large, unique, solvers, text
      integer(ip) :: i, n

      associate (scene => results%scene)
         ! millions would not fit beside the counts of elements and nodes, which are as many then
         call add_item(page, 'solved', plural(body_count(scene), 'body', 'bodies')//', '// &
                       plural(model%mesh%n_elements, 'element', 'elements')//', '// &
                       plural(model%mesh%n_nodes, 'node', 'nodes')//', '//to_text(scene%n_dofs)// &
                       ' '//trim(merge('free dofs         ', 'free displacements', scene%n_dofs >= 1000000)))
         n = 0
         if (allocated(scene%pairs)) n = size(scene%pairs, kind=ip)
         if (n == 0) then
            text = 'none'
         else
            text = plural(n, 'pair', 'pairs')//', '//plural(sum(scene%pairs%n_points), 'point', 'points')//': '// &
                   to_text(scene%n_normal - scene%n_rows)//' normal and '//to_text(scene%n_tangential)//' tangential unknowns'
         end if
         if (len(joined_text(model)) > 0) text = text//'; '//joined_text(model)
         call add_item(page, 'contact', text)
         ! The solvers in use, each once.
         solvers = ''
         if (is_sparse_form(scene)) solvers = 'sparse'
         do i = 1, merge(0_ip, body_count(scene), is_sparse_form(scene))
            if (.not. allocated(scene%bodies(i)%solver)) cycle
            if (index(solvers, scene%bodies(i)%solver) > 0 .or. scene%bodies(i)%solver == 'none') cycle
            if (len(solvers) > 0) solvers = solvers//' and '
            solvers = solvers//scene%bodies(i)%solver
         end do
         call add_item(page, 'solver', solvers//iteration_text(model, results))
      end associate
      if (results%converged .and. results%law_holds) then
         large = 'equilibrium to '//number(results%equilibrium_residual, 2)//' of the largest force'
         if (.not. (has_forces(results) .or. results%equilibrium_residual > 0.0_wp)) large = 'no forces act'
         if (pair_count(results) > 0) large = large//'; the contact law holds'
         call add_item(page, 'checked', large)
         call add_item(page, trim(merge('error    ', 'estimated', results%error_bound%exists)), error_text(results))
         unique = uniqueness_text(results%uniqueness)
         if (len(unique) > 0) call add_item(page, 'unique', unique)
         large = large_text([results%large_strain%value, results%large_rotation%value, results%large_slip%value])
         if (len(large) > 0) call add_item(page, 'but', large//': not small (W-LARGE)')
      else
         call add_item(page, 'checked', 'equilibrium to '//number(results%equilibrium_residual, 2)//' of the largest force')
      end if
   end subroutine add_sizes

   !> Whether all bodies are in one sparse matrix.
   pure logical function is_sparse_form(scene)
      type(scene_t), intent(in) :: scene

      is_sparse_form = .false.
      if (allocated(scene%contact_form)) is_sparse_form = scene%contact_form == 'sparse'
   end function is_sparse_form

   pure function iteration_text(model, results) result(text)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: text

      text = ', '//plural(int(results%linear_solves, ip), 'linear solve', 'linear solves')
      if (size(model%pairs) == 0) return
      if (is_sparse_form(results%scene)) then
         text = ', multipliers: '//plural(int(results%outer_iterations, ip), 'step', 'steps')//text
      else if (results%scene%outer_loop) then
         text = ', '//trim(METHOD_NAME(model%steps(results%step)%controls%method))//': '// &
                plural(int(results%outer_iterations, ip), 'outer iteration', 'outer iterations')//text
      else
         text = ', no outer loop'//text
      end if
   end function iteration_text

   !> The last outer iterations, and the points that are unsettled; all of them are in the listing.
   subroutine add_trail(page, results, room)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      integer, intent(in) :: room                   !< lines there are
      integer :: i, ends(size(results%iterations)), n, shown

      n = 0
      do i = 1, size(results%iterations)            ! the last solve of each outer iteration
         if (i < size(results%iterations)) then
            if (results%iterations(i + 1)%outer == results%iterations(i)%outer) cycle
         end if
         n = n + 1
         ends(n) = i
      end do
      shown = min(n, MOST_OUTER, room - 2 - UNSETTLED_LINES)
      call add_rule(page, '-')
      call add_line(page, right('outer', 7)//right('solves', 8)//right('open', 8)//right('stick', 8)// &
                    right(closed_word(results%scene), 8)//right('residual', 14))
      do i = n - shown + 1, n
         associate (row => results%iterations(ends(i)))
            call add_line(page, right(to_text(row%outer), 7)//right(to_text(row%inner), 8)//right(to_text(row%open), 8)// &
                          right(to_text(row%stick), 8)//right(to_text(row%slip), 8)//right(number(row%residual, 3), 14))
         end associate
      end do
      if (allocated(results%unsettled)) call add_unsettled(page, results)
   end subroutine add_trail

   !> `node 12 o=o=o=o=`: as many points as two lines hold.
   subroutine add_unsettled(page, results)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: text, next
      integer :: i

      if (size(results%unsettled) == 0) return
      call add_line(page, left(plural(size(results%unsettled, kind=ip), 'point is unsettled', 'points are unsettled') &
                               //' in the last outer iterations: o open, c closed, = stick, +- slip', WIDTH))
      text = ''
      do i = 1, size(results%unsettled)
         next = '  node '//to_text(results%unsettled(i)%node)//' '//trim(results%unsettled(i)%states)
         if (len(text) + len(next) > WIDTH) exit
         text = text//next
      end do
      call add_line(page, text)
   end subroutine add_unsettled

   !> A row a pair as in Quadro I of the paper, and a line of tractions.
   subroutine add_pairs(page, results, most)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: most               !< pairs on the screen; the rest is in the listing
      type(pair_summary_t) :: summary
      integer(ip) :: i, shown

      if (pair_count(results) == 0) return
      shown = min(size(results%contact, kind=ip), most)
      call add_rule(page, '-')
      if (shown == 0) then
         call add_line(page, plural(pair_count(results), 'contact pair', 'contact pairs')//': in the listing')
         return
      end if
      call add_line(page, row_text('', 'effective', 'max. p /', 'max. p /', 'resultant'))
      call add_line(page, row_text('contact pair', 'area [%]', 'uniform', 'triangular', &
                                   'from end ['//in_units(page%units, 'L')//']'))
      do i = 1, shown
         summary = summarise_pair(results%contact(i))
         call add_line(page, row_text(to_text(i)//' '//pair_name(results, i), number(summary%effective_area_percent, DIGITS), &
                                      number(summary%max_pressure_over_uniform, DIGITS), &
                                      number(summary%max_pressure_over_triangular, DIGITS), &
                                      number(summary%resultant_from_end, DIGITS)))
         call add_line(page, left('  normal '//number(summary%normal_resultant, DIGITS)//', shear '// &
                                  number(summary%shear_resultant, DIGITS)//' [F]; max. p '// &
                                  number(summary%max_pressure, DIGITS)//'; '//states_text(results%contact(i), summary), WIDTH))
      end do
      if (shown < size(results%contact)) then
         call add_line(page, '... and '//to_text(size(results%contact, kind=ip) - shown)//' more pairs in the listing')
      end if
   end subroutine add_pairs

   pure function row_text(label, area, uniform, triangular, distance) result(text)
      character(len=*), intent(in) :: label, area, uniform, triangular, distance
      character(len=:), allocatable :: text

      text = left(label, LABEL_WIDTH)//right(area, 10)//right(uniform, 10)//right(triangular, 11)//right(distance, 14)
   end function row_text

   subroutine add_closing(page, folder, files)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: folder
      type(string_t), intent(in) :: files(:)
      type(phase_time_t), allocatable :: phases(:)
      character(len=:), allocatable :: tables, name
      integer :: i

      phases = get_phases()
      call add_item(page, 'time', seconds(sum(phases%wall))//' s ('//seconds(sum(phases%cpu))//' s of processor), '// &
                    bytes(peak_memory())//'; '//plural(count_messages(SEVERITY_WARNING), 'warning', 'warnings')//', '// &
                    plural(count_messages(SEVERITY_NOTE), 'note', 'notes'))
      tables = ''
      do i = 1, size(files)
         if (ends_with(files(i)%s, TAB_ENDING) .or. ends_with(files(i)%s, CSV_ENDING)) then
            name = files(i)%s(:len(files(i)%s) - len(TAB_ENDING))
            if (.not. any(name == [character(len=10) :: 'iterations', 'timing'])) tables = tables//name//' '
         else if (ends_with(files(i)%s, '.lst')) then
            call add_line(page, left('listing', 13)//folder//'/'//files(i)%s)
         else if (ends_with(files(i)%s, '.xdmf')) then
            call add_line(page, left('fields', 13)//folder//'/'//files(i)%s//', with .h5')
         else if (files(i)%s == REPORT_NAME) then
            call add_line(page, left('report', 13)//folder//'/'//files(i)%s)
         end if
      end do
      call add_item(page, 'and tables', tables)
   end subroutine add_closing

   !> Seconds to the millisecond.
   pure function seconds(time) result(text)
      real(wp), intent(in) :: time
      character(len=:), allocatable :: text

      text = number(1.0e-3_wp*anint(1.0e3_wp*time), DIGITS)
   end function seconds

   !> Composes the report of a deck that has no errors.
   subroutine compose_check(model, scene, page)
      type(model_t), intent(in) :: model !< as read
      type(scene_t), intent(in) :: scene !< as it would be solved
      type(page_t), intent(out) :: page  !< lines of 79 columns

      call begin_deck_report(page, model, ' check')
      call add_rule(page, '=')
      call describe_counts(page, model)
      call describe_names(page, model)
      call describe_instances(page, model)
      if (is_history(model)) then
         call add_heading(page, 'history')
         call describe_steps(page, model, MOST_STEPS)
      end if
      if (allocated(scene%pairs)) then
         if (size(scene%pairs) > 0) call add_heading(page, 'contact')
      end if
      call describe_pairs(page, scene, some=.true.)
      call add_heading(page, 'solver')
      call describe_bodies(page, scene, factored=.false., some=.true.)
      call add_heading(page, 'needs')
      call describe_needs(page, scene)
      call add_blank(page)
      call add_line(page, 'no errors, '//plural(count_messages(SEVERITY_WARNING), 'warning', 'warnings')//', '// &
                    plural(count_messages(SEVERITY_NOTE), 'note', 'notes')//'; nothing was solved')
   end subroutine compose_check

end module atrito_screen
