!> What `atrito limit` writes: limit.tab, mechanism.tab, and the closing lines on the screen.
module atrito_stability_tables
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_page, only: page_t, begin_report, add_item, add_remark, add_files, add_rule, number, plural, add_paragraph
   use atrito_stability_result, only: stability_t, stability_value_t, CODE_NOT_RUN
   use atrito_status, only: status_t, STATUS_OK, STATUS_NOT_CONVERGED
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_summary, only: large_text
   use atrito_table, only: table_t, begin_table, add_reals, add_integers, add_words, one_word
   implicit none (type, external)
   private
   public :: build_values, build_mechanism, compose_stability, limit_text, values_text, list_remarks, large_where_it_stands

   integer, parameter :: DIGITS = 10

contains

   !> limit.tab: a row a value that was tried.
   pure subroutine build_values(limit, table)
      type(stability_t), intent(in) :: limit           !< as found
      type(table_t), intent(out) :: table              !< 'limit'
      integer :: i, k

      associate (values => limit%values)
         call begin_table(table, 'limit', 'a row a value of '//limit%parameter//'; displacement: '//limit%watched, &
                          size(values, kind=ip))
         call append_string(table%remarks, 'stands at '//to_text(limit%stands, 17)//', can be balanced at ' &
                            //to_text(limit%balanced, 17)//', falls at '//to_text(limit%falls, 17))
         if (is_undecided(limit)) then
            call append_string(table%remarks, 'static limit between the last two; neither a solution nor a proof from ' &
                               //to_text(first_undecided(limit), 17)//' on')
         end if
         call append_string(table%remarks, 'code: of the run, 4 also without one; -1: the loads can be balanced, no run was made')
         call add_reals(table, 'value', '-', values%value, 0.0_wp)
         call add_integers(table, 'code', int(values%code, ip))
         call add_reals(table, 'excess', '-', values%excess, 0.0_wp)
         call add_reals(table, 'displacement', 'L', values%displacement, 0.0_wp)
         call add_integers(table, 'iterations', values%iterations)
         call add_integers(table, 'linear_solves', values%solves)
         call add_integers(table, 'factorisations', values%factorisations)
         do k = 1, size(limit%observed)
            call add_reals(table, limit%observed(k)%s, 'mixed', [(observed_at(values(i), k), i=1, size(values))], 0.0_wp)
         end do
      end associate
   end subroutine build_values

   !> What is observed, k-th; nan where no run was made.
   pure real(wp) function observed_at(one, k)
      type(stability_value_t), intent(in) :: one
      integer, intent(in) :: k

      observed_at = ieee_value(1.0_wp, ieee_quiet_nan)
      if (allocated(one%observed)) observed_at = one%observed(k)
   end function observed_at

   !> mechanism.tab: the motions of the bodies as it falls.
   pure subroutine build_mechanism(limit, table)
      type(stability_t), intent(in) :: limit           !< with its collapse
      type(table_t), intent(out) :: table              !< 'mechanism'
      type(string_t) :: words(size(limit%collapse%bodies))
      integer :: i

      do i = 1, size(words)                            ! a name with blanks would be several items
         words(i)%s = one_word(limit%collapse%names(i)%s)
      end do
      associate (bodies => limit%collapse%bodies, centre => limit%collapse%centre, motion => limit%collapse%motion)
         call begin_table(table, 'mechanism', 'a row a body that moves at '//limit%parameter//' = '//to_text(limit%falls, 17), &
                          size(bodies, kind=ip))
         call append_string(table%remarks, 'the largest displacement of a node is 1; u1, u2: of the centre x, y; rotation: [1]')
         call add_integers(table, 'body', bodies)
         call add_words(table, 'name', '-', words, on_the_left=.true.)
         call add_reals(table, 'x', 'L', centre(1, :), 0.0_wp)
         call add_reals(table, 'y', 'L', centre(2, :), 0.0_wp)
         call add_reals(table, 'u1', 'L', motion(1, :), 1.0_wp)
         call add_reals(table, 'u2', 'L', motion(2, :), 1.0_wp)
         call add_reals(table, 'rotation', '-', motion(3, :), 0.0_wp)
      end associate
   end subroutine build_mechanism

   !> The closing lines.
   subroutine compose_stability(deck, folder, limit, seconds, page, pictures)
      character(len=*), intent(in) :: deck, folder     !< path as the user wrote it; of the tables
      type(stability_t), intent(in) :: limit           !< as found, with its collapse
      real(wp), intent(in) :: seconds(2)               !< wall clock and processor
      type(page_t), intent(out) :: page                !< what is to be printed
      type(string_t), intent(in) :: pictures(:)        !< that were drawn, names without folder and ending
      type(string_t), allocatable :: labels(:), texts(:)
      integer :: i, j
      character(len=:), allocatable :: displacement_text

      call begin_report(page, '   limit of '//limit%parameter//' in '//deck)
      call add_rule(page, '-')
      call add_item(page, 'stands at', limit%parameter//' = '//number(limit%stands, DIGITS)//': solved and checked')
      call add_item(page, 'falls at', limit%parameter//' = '//number(limit%falls, DIGITS)//': proved')
      if (.not. is_undecided(limit)) call add_item(page, 'limit', limit_text(limit))
      call list_remarks(limit, labels, texts)
      do i = 1, size(texts)
         call add_remark(page, labels(i)%s, texts(i)%s)
      end do
      ! What is watched, at the value that stands.
      displacement_text = limit%watched
      do j = 1, size(limit%values)
         if (abs(limit%values(j)%value - limit%stands) > 0.0_wp .or. limit%values(j)%code /= STATUS_OK) cycle
         displacement_text = displacement_text//' = '//number(limit%values(j)%displacement, 5)//' [L] where it stands'
      end do
      call add_item(page, 'displacement', displacement_text)
      call add_item(page, 'values', values_text(limit))
      call add_rule(page, '-')
      call add_paragraph(page, 'mechanism: '//limit%collapse%text, 0)
      call add_rule(page, '-')
      call add_item(page, 'time', number(seconds(1), 3)//' s ('//number(seconds(2), 3)//' s of processor)')
      call add_files(page, folder, 'limit mechanism', pictures)
   end subroutine compose_stability

   !> The limit in words: its middle, half of the interval that holds it, and whether that is as close as asked.
   function limit_text(limit) result(text)
      type(stability_t), intent(in) :: limit     !< its stands, falls and tolerance are read
      character(len=:), allocatable :: text
      real(wp) :: half

      half = 0.5_wp*abs(limit%falls - limit%stands)
      text = number(0.5_wp*(limit%stands + limit%falls), DIGITS)//', '//number(half, 2)//' more or less, '
      if (limit%is_close) then
         text = text//'as close as asked ('//number(limit%tolerance, 3)//')'
      else
         text = text//'farther than '//number(limit%tolerance, 3)
      end if
   end function limit_text

   !> What the two bounds are where they are not one, and what casts doubt on them.
   subroutine list_remarks(limit, labels, texts)
      type(stability_t), intent(in) :: limit     !< as found
      type(string_t), allocatable, intent(out) :: labels(:), texts(:) !< one of each a remark, plain text
      character(len=:), allocatable :: large
      integer(ip) :: runs, proofs

      allocate (labels(0), texts(0))
      runs = count(limit%values%code == STATUS_NOT_CONVERGED, kind=ip)
      proofs = count(limit%values%excess /= limit%values%excess .and. limit%values%code == CODE_NOT_RUN, kind=ip)
      if (is_undecided(limit)) then
         call add('static limit', number(0.5_wp*(limit%balanced + limit%falls), DIGITS)//', ' &
                  //number(0.5_wp*abs(limit%falls - limit%balanced), 2)//' more or less: up to it forces can balance the loads.' &
                  //' It holds for a flow rule that follows friction (sliding by 1 lifts by nu); with Coulomb''s law less may' &
                  //' stand')
         call add('solved up to', number(limit%stands, DIGITS)//', the last value for which a solution with Coulomb''s law was' &
                  //' found; from '//number(first_undecided(limit), DIGITS)//' on, at '//plural(runs, 'value', 'values')// &
                  ', neither a solution nor a proof was found (exit 3)')
      end if
      if (allocated(limit%gaps)) call add('but', limit%gaps)
      large = large_where_it_stands(limit)
      if (len(large) > 0) call add('but', 'where it stands '//large//': not small (W-LARGE)')
      if (proofs > 0) call add('undecided', plural(proofs, 'value is', 'values are')//' too near the limit for a proof')

   contains

      subroutine add(label, text)
         character(len=*), intent(in) :: label, text

         call append_string(labels, label)
         call append_string(texts, text)
      end subroutine add

   end subroutine list_remarks

   !> Whether runs between the bounds found neither a solution nor a proof.
   pure logical function is_undecided(limit)
      type(stability_t), intent(in) :: limit

      is_undecided = any(limit%values%code == STATUS_NOT_CONVERGED) .and. .not. limit%is_close
   end function is_undecided

   !> Of such values the one nearest to where it stands.
   pure real(wp) function first_undecided(limit) result(x)
      type(stability_t), intent(in) :: limit
      integer :: i

      x = limit%falls
      do i = 1, size(limit%values)
         associate (one => limit%values(i))
            if (one%code /= STATUS_NOT_CONVERGED .or. abs(one%value - limit%falls) > abs(limit%stands - limit%falls)) cycle
            if (abs(one%value - limit%stands) < abs(x - limit%stands)) x = one%value
         end associate
      end do
   end function first_undecided

   !> What is not small at the value that stands; '' where all is.
   pure function large_where_it_stands(limit) result(text)
      type(stability_t), intent(in) :: limit     !< its values are read
      character(len=:), allocatable :: text
      integer :: i

      text = ''
      do i = 1, size(limit%values)
         if (abs(limit%values(i)%value - limit%stands) <= 0.0_wp) text = large_text(limit%values(i)%large)
      end do
   end function large_where_it_stands

   !> How many values were tried, and how: `7: 3 solved, 4 by their balance alone; 2 factorisations`.
   function values_text(limit) result(text)
      type(stability_t), intent(in) :: limit     !< its values are read
      character(len=:), allocatable :: text
      integer(ip) :: n, solved

      n = size(limit%values, kind=ip)
      solved = count(limit%values%code == STATUS_OK .or. limit%values%code == STATUS_NOT_CONVERGED, kind=ip)
      text = to_text(n)//': '//to_text(solved)//' solved, '//to_text(n - solved)//' by their balance alone; '// &
             plural(sum(limit%values%factorisations), 'factorisation', 'factorisations')
   end function values_text

end module atrito_stability_tables
