!> What `atrito compare` asks of the columns of tables: tolerances of their own, and which are left out.
!>
!> A file of tolerances has a line a rule, `TABLE COLUMN RTOL [ATOL]`, # before comments; * for any table or column, for COLUMN the
!> quantity in summary and extremes. The last rule that fits counts. --ignore names tables, or TABLE.COLUMN.
module atrito_compare_rules
   use atrito_files, only: read_file
   use atrito_kinds, only: ip, wp
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_status, only: status_t, is_ok, set_status, STATUS_FILE, STATUS_USAGE
   use atrito_strings, only: string_t, append_string, join, nearest_names, to_text
   use atrito_write_tables, only: TABLE_NAMES, SHOWN_TABLES
   implicit none (type, external)
   private
   public :: rule_t, rules_t, read_rules, leave_out, take_tables, rule_of, takes_table, ANY_NAME, COMPARED_TABLES

   type :: rule_t
      character(len=:), allocatable :: table, column !< * any
      real(wp) :: rtol = 0.0_wp, atol = 0.0_wp
      logical :: is_left_out = .false.
   end type rule_t

   type :: rules_t
      real(wp) :: rtol = 0.0_wp, atol = 0.0_wp       !< where no rule fits
      type(rule_t), allocatable :: list(:)
      type(string_t), allocatable :: tables(:)       !< that are compared; not allocated: all
   end type rules_t

   character(len=12), parameter :: COMPARED_TABLES(*) = [TABLE_NAMES, SHOWN_TABLES]
   character(len=*), parameter :: ANY_NAME = '*'

contains

   !> Adds the rules of a file. status: STATUS_FILE where it cannot be read or has another line.
   subroutine read_rules(path, rules, status)
      character(len=*), intent(in) :: path
      type(rules_t), intent(inout) :: rules
      type(status_t), intent(out) :: status
      type(string_t), allocatable :: words(:)
      type(rule_t) :: rule
      character(len=:), allocatable :: text
      integer(ip) :: line
      integer :: first, last, outcome(2)

      call read_file(path, text, status)
      if (.not. is_ok(status)) return
      line = 0
      first = 1
      do while (first <= len(text))
         line = line + 1
         last = first + index(text(first:)//achar(10), achar(10)) - 2
         call split(text(first:last), words)
         first = last + 2
         if (size(words) == 0) cycle
         outcome = NUMBER_OK
         if (size(words) == 3 .or. size(words) == 4) then
            rule%table = words(1)%s
            rule%column = words(2)%s
            call read_real(words(3)%s, rule%rtol, outcome(1))
            rule%atol = 0.0_wp
            if (size(words) == 4) call read_real(words(4)%s, rule%atol, outcome(2))
            if (all(outcome == NUMBER_OK) .and. min(rule%rtol, rule%atol) >= 0.0_wp) then
               call add_rule(rule, rules)
               call check_table(rule%table, path//', line '//to_text(line)//': ', status)
               if (.not. is_ok(status)) return
               cycle
            end if
         end if
         call set_status(status, STATUS_FILE, path//', line '//to_text(line)//' is no rule; expected: TABLE COLUMN RTOL '// &
                         '[ATOL], numbers not negative, * for any table or column')
         return
      end do
   end subroutine read_rules

   !> What --ignore names: tables, TABLE.COLUMN, commas between them. status: STATUS_USAGE for a name that no table has.
   subroutine leave_out(text, rules, status)
      character(len=*), intent(in) :: text
      type(rules_t), intent(inout) :: rules
      type(status_t), intent(out) :: status
      type(string_t), allocatable :: names(:)
      type(rule_t) :: rule
      integer :: i, dot

      rule%is_left_out = .true.
      call split(text, names)
      do i = 1, size(names)
         dot = index(names(i)%s//'.', '.')
         rule%table = names(i)%s(:dot - 1)
         rule%column = ANY_NAME
         if (dot < len(names(i)%s)) rule%column = names(i)%s(dot + 1:)
         call add_rule(rule, rules)
         call check_table(rule%table, '--ignore: ', status)
         if (.not. is_ok(status)) return
      end do
   end subroutine leave_out

   !> What --tables names, commas between them. status: STATUS_USAGE for a name that no table has.
   subroutine take_tables(text, rules, status)
      character(len=*), intent(in) :: text
      type(rules_t), intent(inout) :: rules
      type(status_t), intent(out) :: status
      integer :: i

      call split(text, rules%tables)
      do i = 1, size(rules%tables)
         if (is_ok(status)) call check_table(rules%tables(i)%s, '--tables: ', status)
      end do
   end subroutine take_tables

   subroutine check_table(name, place, status)
      character(len=*), intent(in) :: name, place
      type(status_t), intent(inout) :: status
      type(string_t) :: known(size(COMPARED_TABLES))
      integer :: i

      if (name == ANY_NAME .or. any(COMPARED_TABLES == name)) return
      do i = 1, size(known)
         known(i)%s = trim(COMPARED_TABLES(i))
      end do
      call set_status(status, STATUS_USAGE, place//'there is no table '//name//'; nearest: '// &
                      join(nearest_names(name, known, 2), ', '))
   end subroutine check_table

   !> Words between blanks, tabs and commas, up to a #.
   pure subroutine split(line, words)
      character(len=*), intent(in) :: line
      type(string_t), allocatable, intent(out) :: words(:)
      character(len=*), parameter :: BETWEEN = ' ,'//achar(9)//achar(13)
      integer :: first, last, ends

      allocate (words(0))
      ends = index(line//'#', '#') - 1
      last = 0
      do
         first = verify(line(last + 1:ends), BETWEEN)
         if (first == 0) exit
         first = last + first
         last = first + scan(line(first:ends)//' ', BETWEEN) - 2
         call append_string(words, line(first:last))
      end do
   end subroutine split

   pure subroutine add_rule(rule, rules)
      type(rule_t), intent(in) :: rule
      type(rules_t), intent(inout) :: rules
      type(rule_t), allocatable :: longer(:)
      integer :: n

      n = 0
      if (allocated(rules%list)) n = size(rules%list)
      allocate (longer(n + 1))
      if (n > 0) longer(:n) = rules%list
      longer(n + 1) = rule
      call move_alloc(longer, rules%list)
   end subroutine add_rule

   !> What is asked of a column, or of a quantity.
   pure type(rule_t) function rule_of(rules, table, column) result(rule)
      type(rules_t), intent(in) :: rules
      character(len=*), intent(in) :: table, column
      integer :: i

      rule%rtol = rules%rtol
      rule%atol = rules%atol
      if (.not. allocated(rules%list)) return
      do i = 1, size(rules%list)
         if (fits(rules%list(i), table, column)) rule = rules%list(i)
      end do
   end function rule_of

   pure logical function fits(rule, table, column)
      type(rule_t), intent(in) :: rule
      character(len=*), intent(in) :: table, column

      fits = (rule%table == ANY_NAME .or. rule%table == table) .and. (rule%column == ANY_NAME .or. rule%column == column)
   end function fits

   !> Whether a table is compared at all.
   pure logical function takes_table(rules, table)
      type(rules_t), intent(in) :: rules
      character(len=*), intent(in) :: table
      integer :: i

      takes_table = .true.
      if (allocated(rules%tables)) takes_table = any([(rules%tables(i)%s == table, i=1, size(rules%tables))])
      if (.not. allocated(rules%list)) return
      do i = 1, size(rules%list)
         associate (rule => rules%list(i))
            if (rule%is_left_out .and. rule%column == ANY_NAME .and. rule%table == table) takes_table = .false.
         end associate
      end do
   end function takes_table

end module atrito_compare_rules
