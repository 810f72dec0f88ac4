!> What `atrito compare` asks of the columns of tables: tolerances of their own, and which are left out.
!>
!> A file of tolerances has a line a rule, `TABLE COLUMN RTOL [ATOL]`, # before comments; * for any table or column, for COLUMN the
!> quantity in summary and extremes. The last rule that fits counts. --ignore names tables, or TABLE.COLUMN.
module atrito_compare_rules
   use atrito_files, only: read_file
   use atrito_kinds, only: ip, wp
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_status, only: status_t, is_ok, set_status, STATUS_FILE, STATUS_USAGE
   use atrito_strings, only: string_t, append_string, join, nearest_names, split_words, to_text, trimmed_strings
   use atrito_write_tables, only: TABLE_NAMES, SHOWN_TABLES
   implicit none (type, external)
   private
   public :: rule_t, rules_t, read_rules, leave_out, take_tables, rule_of, takes_table, ANY_NAME, COMPARED_TABLES

   !> A line of a file of tolerances, or a name of --ignore.
   type :: rule_t
      character(len=:), allocatable :: table, column !< * any
      real(wp) :: rtol = 0.0_wp, atol = 0.0_wp       !< relative; in the dimension of the column
      logical :: is_left_out = .false.               !< the column is not compared
   end type rule_t

   !> All that is asked of the tables.
   type :: rules_t
      real(wp) :: rtol = 0.0_wp, atol = 0.0_wp       !< where no rule fits
      type(rule_t), allocatable :: list(:)           !< allocated
      type(string_t), allocatable :: tables(:)       !< that are compared; not allocated: all
   end type rules_t

   character(len=12), parameter :: COMPARED_TABLES(*) = [TABLE_NAMES, SHOWN_TABLES]
   character(len=*), parameter :: ANY_NAME = '*'
   character(len=*), parameter :: BETWEEN = ' ,'//achar(9)//achar(13)   !< words

contains

   !> Adds the rules of a file. status: STATUS_FILE where it cannot be read or has another line.
   subroutine read_rules(path, rules, status)
      character(len=*), intent(in) :: path           !< of the file, as the user wrote it
      type(rules_t), intent(inout) :: rules          !< get the rules of the file behind their own
      type(status_t), intent(out) :: status          !< STATUS_OK or STATUS_FILE
      type(string_t), allocatable :: words(:)
      type(rule_t) :: rule
      character(len=:), allocatable :: text
      integer(ip) :: line
      integer :: first, last, outcome(2)
      logical :: is_rule

      call read_file(path, text, status)
      if (.not. is_ok(status)) return
      line = 0
      first = 1
      do while (first <= len(text) .and. is_ok(status))
         line = line + 1
         last = first + index(text(first:)//achar(10), achar(10)) - 2
         call split_words(text(first:first + index(text(first:last)//'#', '#') - 2), BETWEEN, words)   ! # begins a comment
         first = last + 2
         if (size(words) == 0) cycle
         if (size(words) == 3) call append_string(words, '0')
         is_rule = size(words) == 4
         if (is_rule) then
            rule%table = words(1)%s
            rule%column = words(2)%s
            call read_real(words(3)%s, rule%rtol, outcome(1))
            call read_real(words(4)%s, rule%atol, outcome(2))
            is_rule = all(outcome == NUMBER_OK) .and. min(rule%rtol, rule%atol) >= 0.0_wp
         end if
         if (is_rule) then
            call add_rule(rule, path//', line '//to_text(line)//': ', rules, status)
         else
            call set_status(status, STATUS_FILE, path//', line '//to_text(line)//' is no rule; expected: TABLE COLUMN RTOL '// &
                            '[ATOL], numbers not negative, * for any table or column')
         end if
      end do
   end subroutine read_rules

   !> What --ignore names: tables, TABLE.COLUMN, commas between them. status: STATUS_USAGE for a name that no table has.
   subroutine leave_out(text, rules, status)
      character(len=*), intent(in) :: text           !< of the option
      type(rules_t), intent(inout) :: rules          !< get a rule a name
      type(status_t), intent(out) :: status          !< STATUS_OK or STATUS_USAGE
      type(string_t), allocatable :: names(:)
      type(rule_t) :: rule
      integer :: i, dot

      rule%is_left_out = .true.
      call split_words(text, BETWEEN, names)
      do i = 1, size(names)
         dot = index(names(i)%s//'.', '.')
         rule%table = names(i)%s(:dot - 1)
         rule%column = ANY_NAME
         if (dot < len(names(i)%s)) rule%column = names(i)%s(dot + 1:)
         if (is_ok(status)) call add_rule(rule, '--ignore: ', rules, status)
      end do
   end subroutine leave_out

   !> What --tables names, commas between them. status: STATUS_USAGE for a name that no table has.
   subroutine take_tables(text, rules, status)
      character(len=*), intent(in) :: text           !< of the option
      type(rules_t), intent(inout) :: rules          !< compare these tables alone
      type(status_t), intent(out) :: status          !< STATUS_OK or STATUS_USAGE
      integer :: i

      call split_words(text, BETWEEN, rules%tables)
      do i = 1, size(rules%tables)
         if (is_ok(status)) call check_table(rules%tables(i)%s, '--tables: ', status)
      end do
   end subroutine take_tables

   subroutine check_table(name, place, status)
      character(len=*), intent(in) :: name, place
      type(status_t), intent(inout) :: status

      if (name == ANY_NAME .or. any(COMPARED_TABLES == name)) return
      call set_status(status, STATUS_USAGE, place//'there is no table '//name//'; nearest: '// &
                      join(nearest_names(name, trimmed_strings(COMPARED_TABLES), 2), ', '))
   end subroutine check_table

   subroutine add_rule(rule, place, rules, status)
      type(rule_t), intent(in) :: rule
      character(len=*), intent(in) :: place
      type(rules_t), intent(inout) :: rules
      type(status_t), intent(inout) :: status
      type(rule_t), allocatable :: longer(:)

      allocate (longer(size(rules%list) + 1))
      longer(:size(rules%list)) = rules%list
      longer(size(longer)) = rule
      call move_alloc(longer, rules%list)
      call check_table(rule%table, place, status)
   end subroutine add_rule

   !> What is asked of a column, or of a quantity.
   pure type(rule_t) function rule_of(rules, table, column) result(rule)
      type(rules_t), intent(in) :: rules             !< the last one that fits counts
      character(len=*), intent(in) :: table, column  !< names; of summaries the quantity
      integer :: i

      rule%rtol = rules%rtol
      rule%atol = rules%atol
      do i = 1, size(rules%list)
         associate (next => rules%list(i))
            if (next%table /= ANY_NAME .and. next%table /= table) cycle
            if (next%column == ANY_NAME .or. next%column == column) rule = next
         end associate
      end do
   end function rule_of

   !> Whether a table is compared at all.
   pure logical function takes_table(rules, table)
      type(rules_t), intent(in) :: rules             !< tables and list are read
      character(len=*), intent(in) :: table          !< name without ending
      integer :: i

      takes_table = .true.
      if (allocated(rules%tables)) takes_table = any([(rules%tables(i)%s == table, i=1, size(rules%tables))])
      do i = 1, size(rules%list)
         associate (rule => rules%list(i))
            if (rule%is_left_out .and. rule%column == ANY_NAME .and. rule%table == table) takes_table = .false.
         end associate
      end do
   end function takes_table

end module atrito_compare_rules
