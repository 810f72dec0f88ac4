!> Error against run time: study.tab, its closing lines, and what is said of the error in words.
!>
!> A row is a run: an element type at a level of refinement. Errors are relative to a given value, or to the limit that Richardson's
!> extrapolation finds from the three finest levels: with differences d1, d2 of successive levels the order is
!> p = log2(d1/d2) and the limit is q3 + d2/(2**p - 1).
module atrito_study_table
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_files, only: file_set_t, begin_files, end_files
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_page, only: page_t, begin_page, add_line, add_rule, add_paragraph, left, right, number
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_table, only: table_t, origin_t, begin_table, add_reals, add_integers, add_words, write_table
   use atrito_timers, only: phase_time_t
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: study_t, study_row_t, study_quantity_t, judge_study, write_study, compose_study, richardson_limit

   !> A run of the study.
   type :: study_row_t
      character(len=:), allocatable :: element       !< cpe4, ..., or deck
      integer(ip) :: level = 0
      integer(ip) :: code = 0                        !< exit code of the run
      real(wp) :: h = 0.0_wp                         !< [L] side of a square of the mean area of the elements
      integer(ip) :: n_dofs = 0, n_points = 0
      real(wp), allocatable :: values(:)             !< one a quantity; nan where the run has none
      real(wp) :: estimate = 0.0_wp                  !< error_estimate_percent
      real(wp) :: penetration = 0.0_wp, slip = 0.0_wp, pressure = 0.0_wp  !< largest ones of pair 1
      type(phase_time_t), allocatable :: phases(:)
   end type study_row_t

   !> What is studied.
   type :: study_quantity_t
      character(len=:), allocatable :: name          !< of summary.tab
      logical :: is_given = .false.                  !< the reference, by the user
      real(wp) :: reference = 0.0_wp                 !< given, or extrapolated; nan: there is none
      character(len=:), allocatable :: source        !< of the reference, in words
      real(wp), allocatable :: error(:)              !< (rows) relative; absolute where the reference is 0
      real(wp), allocatable :: order(:)              !< (rows) log2 of the error of the level before over this one
   end type study_quantity_t

   type :: study_t
      type(study_row_t), allocatable :: rows(:)      !< by element, then level
      type(study_quantity_t), allocatable :: quantities(:)
      type(string_t), allocatable :: words(:)        !< where the error stops falling
   end type study_t

   character(len=8), parameter :: PHASES(9) = [character(len=8) :: 'read', 'mesh', 'order', 'assemble', 'factor', 'iterate', &
                                                                                                     'recover', 'estimate', 'write']
   integer, parameter :: WIDTH = 79
   real(wp), parameter :: STALLED = 0.3_wp           !< an order below this is none
   real(wp), parameter :: ROUNDING = 1.0e-12_wp      !< a relative error below this is none
   real(wp), parameter :: SINGULAR_GROWTH = 1.1_wp   !< of the largest pressure at each of two levels
   real(wp), parameter :: SHARE = 0.1_wp             !< of the error that a regularisation must have to be named

contains

   !> Fills references, errors, orders and words from the values of the rows.
   subroutine judge_study(study)
      type(study_t), intent(inout) :: study
      integer :: i

      allocate (study%words(0))
      do i = 1, size(study%quantities)
         if (.not. study%quantities(i)%is_given) call extrapolate(study, i)
         call measure_errors(study, i)
         call speak_of_quantity(study, i)
      end do
      call speak_of_pressure(study)
   end subroutine judge_study

   !> The limit of the element whose finest three levels leave the least to extrapolate.
   subroutine extrapolate(study, i)
      type(study_t), intent(inout) :: study
      integer, intent(in) :: i
      real(wp) :: limit, order, least
      integer :: k

      associate (quantity => study%quantities(i), rows => study%rows)
         quantity%reference = ieee_value(1.0_wp, ieee_quiet_nan)
         quantity%source = 'no limit: fewer than three levels of one element, or differences that do not shrink'
         least = huge(1.0_wp)
         do k = 3, size(rows)
            if (rows(k)%element /= rows(k - 2)%element .or. .not. is_last(rows, k)) cycle
            call richardson_limit([rows(k - 2)%values(i), rows(k - 1)%values(i), rows(k)%values(i)], limit, order)
            if (is_nan(limit)) cycle
            if (abs(rows(k)%values(i) - limit) >= least) cycle
            least = abs(rows(k)%values(i) - limit)
            quantity%reference = limit
            quantity%source = 'extrapolated from '//rows(k)%element//', order '//to_text(order, 3)
         end do
      end associate
   end subroutine extrapolate

   pure logical function is_last(rows, k)
      type(study_row_t), intent(in) :: rows(:)
      integer, intent(in) :: k

      is_last = k == size(rows)
      if (.not. is_last) is_last = rows(k + 1)%element /= rows(k)%element
   end function is_last

   !> Richardson's limit of three values at halved sizes; nan where their differences do not shrink with one sign.
   subroutine richardson_limit(q, limit, order)
      real(wp), intent(in) :: q(3)                   !< coarse to fine
      real(wp), intent(out) :: limit, order
      real(wp) :: d1, d2

      limit = ieee_value(1.0_wp, ieee_quiet_nan)
      order = limit
      if (any(is_nan(q))) return
      d1 = q(2) - q(1)
      d2 = q(3) - q(2)
      if (d2 == 0.0_wp) then
         limit = q(3)
         order = 0.0_wp
         return
      end if
      if (d1/d2 <= 1.0_wp) return
      order = log(d1/d2)/log(2.0_wp)
      limit = q(3) + d2/(d1/d2 - 1.0_wp)
   end subroutine richardson_limit

   subroutine measure_errors(study, i)
      type(study_t), intent(inout) :: study
      integer, intent(in) :: i
      real(wp) :: scale
      integer :: k

      associate (quantity => study%quantities(i), rows => study%rows)
         allocate (quantity%error(size(rows)), quantity%order(size(rows)), source=ieee_value(1.0_wp, ieee_quiet_nan))
         if (is_nan(quantity%reference)) return
         scale = abs(quantity%reference)
         if (scale <= 0.0_wp) scale = 1.0_wp
         do k = 1, size(rows)
            quantity%error(k) = abs(rows(k)%values(i) - quantity%reference)/scale
            if (k == 1) cycle
            if (rows(k)%element /= rows(k - 1)%element .or. is_nan(quantity%error(k)) .or. is_nan(quantity%error(k - 1))) cycle
            if (min(quantity%error(k), quantity%error(k - 1)) <= 0.0_wp) cycle
            quantity%order(k) = log(quantity%error(k - 1)/quantity%error(k))/log(2.0_wp)
         end do
      end associate
   end subroutine measure_errors

   !> Whether the error of a quantity still falls at the finest level of each element, and if not the likely reason.
   subroutine speak_of_quantity(study, i)
      type(study_t), intent(inout) :: study
      integer, intent(in) :: i
      integer :: k

      associate (quantity => study%quantities(i), rows => study%rows)
         if (is_nan(quantity%reference)) then
            call append_string(study%words, quantity%name//': '//quantity%source)
            return
         end if
         call append_string(study%words, quantity%name//': reference '//to_text(quantity%reference, 8)//', '//quantity%source)
         do k = 2, size(rows)
            if (.not. is_last(rows, k) .or. is_nan(quantity%error(k))) cycle
            if (quantity%error(k) <= ROUNDING) then
               call append_string(study%words, quantity%name//', '//rows(k)%element//': no error but rounding')
            else if (is_nan(quantity%order(k))) then
               cycle
            else if (quantity%order(k) >= STALLED) then
               call append_string(study%words, quantity%name//', '//rows(k)%element//': the error still falls, order '// &
                                  to_text(quantity%order(k), 2)//' at the last level')
            else
               call append_string(study%words, quantity%name//', '//rows(k)%element//': the error stops falling at '// &
                                  to_text(100*quantity%error(k), 2)//' %: '//likely_reason(rows(k), quantity%error(k)))
            end if
         end do
      end associate
   end subroutine speak_of_quantity

   !> Penetration and the slip of sticking points are what penalty and eps leave; they are named when they are of the error's size.
   function likely_reason(row, error) result(text)
      type(study_row_t), intent(in) :: row
      real(wp), intent(in) :: error
      character(len=:), allocatable :: text

      if (row%penetration >= SHARE*error*max(row%slip, row%penetration)) then
         text = 'the penalty lets the bodies overlap by up to '//to_text(row%penetration, 2) &
                //' [L]; a smaller delta moves that floor'
      else
         text = 'the reference, the regularisation of friction (eps) or the shape of the mesh differ from the solution by that'
      end if
   end function likely_reason

   !> A largest pressure that grows with every level has no limit.
   subroutine speak_of_pressure(study)
      type(study_t), intent(inout) :: study
      integer :: k

      associate (rows => study%rows)
         do k = 3, size(rows)
            if (.not. is_last(rows, k) .or. rows(k)%element /= rows(k - 2)%element) cycle
            if (rows(k - 1)%pressure <= SINGULAR_GROWTH*rows(k - 2)%pressure) cycle
            if (rows(k)%pressure <= SINGULAR_GROWTH*rows(k - 1)%pressure) cycle
            call append_string(study%words, rows(k)%element//': the largest pressure grows with every level (' &
                               //to_text(rows(k - 2)%pressure, 3)//', '//to_text(rows(k - 1)%pressure, 3)//', ' &
                               //to_text(rows(k)%pressure, 3)//'): it is singular and has no limit; compare resultants')
         end do
      end associate
   end subroutine speak_of_pressure

   !> Writes study.tab. status: STATUS_FILE.
   subroutine write_study(folder, origin, study, digits, status)
      character(len=*), intent(in) :: folder
      type(origin_t), intent(in) :: origin
      type(study_t), intent(in) :: study
      integer, intent(in) :: digits
      type(status_t), intent(out) :: status
      type(file_set_t) :: set
      type(table_t) :: table

      call begin_files(set, folder, status)
      if (.not. is_ok(status)) return
      call build_study(study, table)
      call write_table(set, table, origin, digits, status)
      call end_files(set, status)
   end subroutine write_study

   subroutine build_study(study, table)
      type(study_t), intent(in) :: study
      type(table_t), intent(out) :: table
      type(string_t) :: elements(size(study%rows))
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
         do i = 1, size(PHASES)
            call add_reals(table, trim(PHASES(i))//'_wall', 's', [(phase_seconds(rows(k), trim(PHASES(i)), 1), k=1, n)], 0.0_wp)
            call add_reals(table, trim(PHASES(i))//'_cpu', 's', [(phase_seconds(rows(k), trim(PHASES(i)), 2), k=1, n)], 0.0_wp)
         end do
         call add_reals(table, 'total_wall', 's', [(total_seconds(rows(k), 1), k=1, n)], 0.0_wp)
         call add_reals(table, 'total_cpu', 's', [(total_seconds(rows(k), 2), k=1, n)], 0.0_wp)
      end associate
   end subroutine build_study

   !> Wall (1) or processor (2) seconds of a phase.
   pure real(wp) function phase_seconds(row, name, clock) result(seconds)
      type(study_row_t), intent(in) :: row
      character(len=*), intent(in) :: name
      integer, intent(in) :: clock
      integer :: i

      seconds = 0.0_wp
      if (.not. allocated(row%phases)) return
      do i = 1, size(row%phases)
         if (row%phases(i)%name == name) seconds = merge(row%phases(i)%wall, row%phases(i)%cpu, clock == 1)
      end do
   end function phase_seconds

   pure real(wp) function total_seconds(row, clock) result(seconds)
      type(study_row_t), intent(in) :: row
      integer, intent(in) :: clock

      seconds = 0.0_wp
      if (.not. allocated(row%phases)) return
      seconds = merge(sum(row%phases%wall), sum(row%phases%cpu), clock == 1)
   end function total_seconds

   !> The closing lines: a row a run with the first quantity, and the words.
   subroutine compose_study(deck, folder, study, page)
      character(len=*), intent(in) :: deck, folder
      type(study_t), intent(in) :: study
      type(page_t), intent(out) :: page
      integer :: k

      call begin_page(page, WIDTH)
      call add_rule(page, '=')
      call add_line(page, left(PROGRAM_NAME//' '//PROGRAM_VERSION//'   study of '//deck, WIDTH))
      call add_rule(page, '-')
      associate (quantity => study%quantities(1))
         call add_line(page, row_text('element', 'level', 'dofs', quantity%name, 'error %', 'order', 'est. %', 'cpu s'))
         do k = 1, size(study%rows)
            associate (row => study%rows(k))
               call add_line(page, row_text(row%element, to_text(row%level), to_text(row%n_dofs), number(row%values(1), 6), &
                                            text_of(100*quantity%error(k)), text_of(quantity%order(k)), &
                                            number(row%estimate, 3), number(total_seconds(row, 2), 3)))
            end associate
         end do
      end associate
      call add_rule(page, '-')
      do k = 1, size(study%words)
         call add_paragraph(page, study%words(k)%s, 0)
      end do
      call add_rule(page, '-')
      call add_line(page, left(left('tables in', 13)//folder, WIDTH))
      call add_line(page, left('', 13)//'study, and a folder a run')
      call add_rule(page, '=')
   end subroutine compose_study

   pure function row_text(element, level, dofs, value, error, order, estimate, seconds) result(text)
      character(len=*), intent(in) :: element, level, dofs, value, error, order, estimate, seconds
      character(len=:), allocatable :: text

      text = left(element, 8)//right(level, 5)//right(dofs, 9)//right(value, 19)//right(error, 11)//right(order, 8) &
             //right(estimate, 9)//right(seconds, 10)
   end function row_text

   pure function text_of(x) result(text)
      real(wp), intent(in) :: x
      character(len=:), allocatable :: text

      text = '-'
      if (.not. is_nan(x)) text = number(x, 3)
   end function text_of

end module atrito_study_table
