!> Error against run time: study.tab and its closing lines.
module atrito_study_table
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_page, only: page_t, begin_page, begin_report, add_files, add_line, add_rule, add_paragraph, left, right, number
   use atrito_strings, only: string_t, to_text
   use atrito_study_errors, only: study_t, phase_seconds, total_seconds, WALL, PROCESSOR
   use atrito_table, only: table_t, begin_table, add_reals, add_integers, add_words
   implicit none (type, external)
   private
   public :: build_study, compose_study

   character(len=8), parameter :: PHASES(10) = [character(len=8) :: 'read', 'mesh', 'order', 'assemble', 'factor', 'iterate', &
                                                                                            'recover', 'estimate', 'check', 'write']
   integer, parameter :: LONGEST_NAME = 18           !< of a quantity, on the screen

contains

   !> study.tab: a row a run.
   subroutine build_study(study, table)
      type(study_t), intent(in) :: study            !< judged
      type(table_t), intent(out) :: table           !< 'study'
      type(string_t) :: elements(size(study%rows))
      character(len=:), allocatable :: phase
      integer(ip) :: n
      integer :: i, k

      n = size(study%rows, kind=ip)
      associate (rows => study%rows)
         do k = 1, n
            elements(k)%s = rows(k)%element
         end do
         call begin_table(table, 'study', 'a row a run; errors relative, times in seconds', n)
         table%remarks = study%words
         call add_integers(table, 'level', rows%level)
         call add_words(table, 'element', '-', elements, on_the_left=.true.)
         call add_reals(table, 'h', 'L', rows%h, 0.0_wp)
         call add_integers(table, 'dofs', rows%n_dofs)
         call add_integers(table, 'contact_points', rows%n_points)
         call add_integers(table, 'exit', rows%code)
         do i = 1, size(study%quantities)
            associate (quantity => study%quantities(i))
               call add_reals(table, quantity%name, 'mixed', [(rows(k)%values(i), k=1, n)], 0.0_wp)
               call add_reals(table, quantity%name//'_error', '-', quantity%error, 0.0_wp)
               call add_reals(table, quantity%name//'_order', '-', quantity%order, 0.0_wp)
            end associate
         end do
         call add_reals(table, 'error_estimate_percent', '%', rows%estimate, 0.0_wp)
         if (any(rows%bound >= 0.0_wp)) call add_reals(table, 'error_bound_percent', '%', rows%bound, 0.0_wp)
         do i = 1, size(PHASES)
            phase = trim(PHASES(i))
            call add_reals(table, phase//'_wall', 's', [(phase_seconds(rows(k), phase, WALL), k=1, n)], 0.0_wp)
            call add_reals(table, phase//'_cpu', 's', [(phase_seconds(rows(k), phase, PROCESSOR), k=1, n)], 0.0_wp)
         end do
         call add_reals(table, 'total_wall', 's', [(total_seconds(rows(k), WALL), k=1, n)], 0.0_wp)
         call add_reals(table, 'total_cpu', 's', [(total_seconds(rows(k), PROCESSOR), k=1, n)], 0.0_wp)
      end associate
   end subroutine build_study

   !> The closing lines: a row a run with the first quantity, and the words.
   subroutine compose_study(deck, folder, study, page)
      character(len=*), intent(in) :: deck, folder   !< path as the user wrote it; of the study
      type(study_t), intent(in) :: study             !< judged, with one quantity at least
      type(page_t), intent(out) :: page              !< what is to be printed
      integer :: k, i
      type(page_t) :: part
      character(len=:), allocatable :: text

      call begin_report(page, '   study of '//deck)
      call add_rule(page, '-')
      associate (quantity => study%quantities(1))
         call add_line(page, row_text('element', 'level', 'dofs', trim(left(quantity%name, LONGEST_NAME)), 'error %', 'order', &
                                      'est. %', 'cpu s'))
         do k = 1, size(study%rows)
            associate (row => study%rows(k))
               associate (x => 100*quantity%error(k))
                  text = '-'
                  if (.not. is_nan(x)) text = number(x, 3)
               end associate
               call add_line(page, row_text(row%element, to_text(row%level), to_text(row%n_dofs), number(row%values(1), 6), &
                                            text, order_text(quantity%order(k)), &
                                            number(row%estimate, 3), number(total_seconds(row, PROCESSOR), 3)))
            end associate
         end do
      end associate
      call add_rule(page, '-')
      do k = 1, size(study%words)
         ! A paragraph with a dash before it.
         call begin_page(part, page%width - 2)
         call add_paragraph(part, study%words(k)%s, 0)
         do i = 1, part%n
            call add_line(page, merge('- ', '  ', i == 1)//part%lines(i)%s)
         end do
      end do
      call add_rule(page, '-')
      call add_files(page, folder, 'study, and a folder a run', [string_t ::])
   end subroutine compose_study

   pure function row_text(element, level, dofs, value, error, order, estimate, seconds) result(text)
      character(len=*), intent(in) :: element, level, dofs, value, error, order, estimate, seconds
      character(len=:), allocatable :: text

      text = left(element, 8)//right(level, 5)//right(dofs, 9)//right(value, 19)//right(error, 11)//right(order, 8) &
             //right(estimate, 9)//right(seconds, 10)
   end function row_text

   !> Two decimals: a smaller order is none.
   pure function order_text(x) result(text)
      real(wp), intent(in) :: x
      character(len=:), allocatable :: text

      text = '-'
      if (.not. is_nan(x)) text = number(real(nint(100*x), wp)/100, 4)
   end function order_text

end module atrito_study_table
