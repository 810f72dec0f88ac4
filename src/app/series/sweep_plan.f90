!> The --vary of a sweep and of a limit. The runs of a sweep: every combination of the values, the last parameter changing fastest.
!>
!> sweep.journal, beside the tables of a sweep: which of its runs have been done, so that `--resume` leaves them alone.
!>
!> A line is added when a run begins and when it has come to an end that says something of the scene (exit code 0, 3 or 4). The last
!> line of a run counts. It counts only where deck, options and program are those of this sweep (its key), and where the table
!> summary in the run's folder is still the one that the run wrote: the digest of the file stands in the line.
module atrito_sweep_plan
   use, intrinsic :: iso_c_binding, only: c_null_char
   use atrito_command_line, only: command_t, output_folder
   use atrito_digest, only: text_digest_t, add_characters, hexadecimal
   use atrito_files, only: file_exists, read_file, remove_file
   use atrito_given_options, only: options_of_run
   use atrito_kinds, only: ip, wp
   use atrito_model, only: provenance_t
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_parameters, only: settings_t, read_settings
   use atrito_read_table, only: table_path
   use atrito_status, only: status_t, set_status, is_ok, STATUS_USAGE, STATUS_OK, STATUS_NOT_CONVERGED, STATUS_SINGULAR
   use atrito_strings, only: string_t, append_string, same_name, to_text
   use atrito_system, only: c_append_line
   use atrito_version, only: PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: sweep_plan_t, plan_sweep, read_range, sweep_journal_t, begin_journal, note_begin, note_end, find_done, &
             remove_journal, OUTCOMES, JOURNAL_NAME

   integer(ip), parameter :: MOST_RUNS = 10000_ip

   !> The runs of a sweep.
   type :: sweep_plan_t
      integer(ip) :: n_runs = 0                      !< >= 1; product of the numbers of values
      type(string_t), allocatable :: names(:)        !< the parameters that vary
      type(string_t), allocatable :: texts(:, :)     !< (parameters, runs) values as the user wrote them
      real(wp), allocatable :: values(:, :)          !< (parameters, runs)
      type(string_t), allocatable :: labels(:)       !< (runs) 'nu=0.3, eps=1e-4'
      type(string_t), allocatable :: folders(:)      !< (runs) 'nu_0.3,eps_1e-4': no blank, and no = that awk takes for an order
   end type sweep_plan_t

   !> One --vary.
   type :: variation_t
      character(len=:), allocatable :: name          !< of the parameter
      type(string_t), allocatable :: texts(:)        !< as the user wrote them
      real(wp), allocatable :: values(:)             !< of the texts
   end type variation_t

   integer, parameter :: OUTCOMES = 3                !< exit code, factorisations, what was written: nothing, some, all (0, 1, 2)

   !> The journal of a sweep.
   type :: sweep_journal_t
      character(len=:), allocatable :: folder, path, key !< of the sweep; of the journal; of deck, options, program
      logical :: has_earlier = .false.               !< lines of earlier sweeps
   end type sweep_journal_t

   character(len=*), parameter :: JOURNAL_NAME = 'sweep.journal', BEGUN = 'begun', DONE = 'done', NO_TABLE = '-'
   character(len=1), parameter :: NEW_LINE_CHARACTER = achar(10)

contains

   !> Makes the plan. status: STATUS_USAGE for what is not NAME=v1,v2,..., a name given twice, also by --set, or a value twice.
   subroutine plan_sweep(vary, settings, plan, status)
      type(string_t), intent(in) :: vary(:)            !< 'NAME=v1,v2,...'
      type(string_t), intent(in) :: settings(:)        !< 'NAME=VALUE' of --set
      type(sweep_plan_t), intent(out) :: plan          !< of no use where status is not OK
      type(status_t), intent(out) :: status            !< STATUS_OK or STATUS_USAGE
      type(variation_t) :: variations(size(vary))
      integer :: i

      allocate (plan%names(0))
      plan%n_runs = 1
      do i = 1, size(vary)
         call read_variation(vary(i)%s, variations(i), status)
         if (is_ok(status)) call check_name(variations(i)%name, vary(i)%s, plan%names, settings, status)
         if (.not. is_ok(status)) return
         call append_string(plan%names, variations(i)%name)
         if (size(variations(i)%texts) > MOST_RUNS/plan%n_runs) then
            call set_status(status, STATUS_USAGE, '--vary: more than '//to_text(MOST_RUNS)//' runs')
            return
         end if
         plan%n_runs = plan%n_runs*size(variations(i)%texts, kind=ip)
      end do
      call combine(variations, plan)
   end subroutine plan_sweep

   !> Takes NAME=v1,v2,... apart.
   subroutine read_variation(text, variation, status)
      character(len=*), intent(in) :: text
      type(variation_t), intent(out) :: variation
      type(status_t), intent(out) :: status
      integer :: i, j, equals

      equals = index(text, '=')
      if (index(text, ':') > 0) then
         call complain(text, 'a sweep takes values with commas between them, NAME=v1,v2,...; a range a:b is for atrito limit', &
                       status)
         return
      end if
      variation%name = trim(adjustl(text(:max(equals - 1, 0))))
      variation%texts = split_at_commas(text(equals + 1:))
      allocate (variation%values(size(variation%texts)))
      do i = 1, size(variation%texts)
         call read_value(text, variation%name, variation%texts(i)%s, variation%values(i), status)
         if (.not. is_ok(status)) return
         do j = 1, i - 1
            if (variation%values(j) /= variation%values(i)) cycle
            call complain(text, variation%texts(i)%s//' is given twice', status)
            return
         end do
      end do
   end subroutine read_variation

   subroutine check_name(name, text, names, settings, status)
      character(len=*), intent(in) :: name, text
      type(string_t), intent(in) :: names(:), settings(:)
      type(status_t), intent(inout) :: status
      integer :: i

      do i = 1, size(names)
         if (same_name(names(i)%s, name)) call complain(text, name//' varies already', status)
      end do
      do i = 1, size(settings)
         if (.not. same_name(trim(adjustl(settings(i)%s(:index(settings(i)%s, '=') - 1))), name)) cycle
         call complain(text, name//' is given by --set '//settings(i)%s, status)
      end do
   end subroutine check_name

   !> The parts between commas; those within parentheses belong to a function.
   pure function split_at_commas(text) result(parts)
      character(len=*), intent(in) :: text
      type(string_t), allocatable :: parts(:)
      integer :: i, first, depth

      allocate (parts(0))
      first = 1
      depth = 0
      do i = 1, len(text)
         if (text(i:i) == '(') depth = depth + 1
         if (text(i:i) == ')') depth = depth - 1
         if (text(i:i) /= ',' .or. depth > 0) cycle
         call append_string(parts, trim(adjustl(text(first:i - 1))))
         first = i + 1
      end do
      call append_string(parts, trim(adjustl(text(first:))))
   end function split_at_commas

   pure subroutine combine(variations, plan)
      type(variation_t), intent(in) :: variations(:)
      type(sweep_plan_t), intent(inout) :: plan
      integer(ip) :: i, run, rest, place, n

      allocate (plan%texts(size(variations), plan%n_runs), plan%values(size(variations), plan%n_runs))
      allocate (plan%labels(plan%n_runs), plan%folders(plan%n_runs))
      do run = 1, plan%n_runs
         rest = run - 1
         do i = size(variations, kind=ip), 1, -1
            n = size(variations(i)%texts, kind=ip)
            place = mod(rest, n) + 1
            rest = rest/n
            plan%texts(i, run)%s = variations(i)%texts(place)%s
            plan%values(i, run) = variations(i)%values(place)
         end do
         call name_run(plan, run)
      end do
   end subroutine combine

   pure subroutine name_run(plan, run)
      type(sweep_plan_t), intent(inout) :: plan
      integer(ip), intent(in) :: run
      character(len=:), allocatable :: label, folder
      integer(ip) :: i

      label = ''
      folder = ''
      do i = 1, size(plan%names, kind=ip)
         if (i > 1) label = label//', '
         if (i > 1) folder = folder//','
         label = label//plan%names(i)%s//'='//plan%texts(i, run)%s
         folder = folder//plan%names(i)%s//'_'//plain(plan%texts(i, run)%s)
      end do
      do i = 1, run - 1
         if (plan%folders(i)%s /= folder) cycle       ! 1/3 and 1*3 read alike
         folder = folder//'-'//to_text(run)
         exit
      end do
      call move_alloc(label, plan%labels(run)%s)
      call move_alloc(folder, plan%folders(run)%s)
   end subroutine name_run

   !> A value as part of the name of a folder: letters, digits, point and signs stay.
   pure function plain(text) result(name)
      character(len=*), intent(in) :: text
      character(len=len(text)) :: name
      integer :: i
      character(len=*), parameter :: HARMLESS = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.+-'

      name = text
      do i = 1, len(text)
         if (scan(text(i:i), HARMLESS) == 0) name(i:i) = '_'
      end do
   end function plain

   !> Takes NAME=a:b apart. status: STATUS_USAGE for anything else, a that is not below b, or a name that --set gives as well.
   subroutine read_range(text, settings, name, ends, status)
      character(len=*), intent(in) :: text             !< 'NAME=a:b'
      type(string_t), intent(in) :: settings(:)        !< 'NAME=VALUE' of --set
      character(len=:), allocatable, intent(out) :: name !< of the parameter
      real(wp), intent(out) :: ends(2)                 !< ascending
      type(status_t), intent(out) :: status            !< STATUS_OK or STATUS_USAGE
      integer :: equals, colon

      ends = 0.0_wp
      equals = index(text, '=')
      colon = index(text, ':')
      name = trim(adjustl(text(:max(equals - 1, 0))))
      if (colon < equals + 1) then
         call complain(text, 'NAME=a:b is expected, the limit being between a and b', status)
         return
      end if
      call read_value(text, name, text(equals + 1:colon - 1), ends(1), status)
      if (is_ok(status)) call read_value(text, name, text(colon + 1:), ends(2), status)
      if (is_ok(status) .and. ends(1) >= ends(2)) call complain(text, 'the first value is not below the second one', status)
      if (is_ok(status)) call check_name(name, text, [string_t ::], settings, status)
   end subroutine read_range

   subroutine read_value(text, name, expression, x, status)
      character(len=*), intent(in) :: text, name, expression
      real(wp), intent(out) :: x
      type(status_t), intent(out) :: status
      type(settings_t) :: setting
      type(string_t) :: texts(1)

      x = 0.0_wp
      texts(1)%s = name//'='//trim(adjustl(expression))
      call read_settings(texts, setting, status)
      if (is_ok(status)) then
         x = setting%values(1)
      else
         call complain(text, status%text, status)
      end if
   end subroutine read_value

   subroutine complain(text, what, status)
      character(len=*), intent(in) :: text, what
      type(status_t), intent(inout) :: status
      character(len=:), allocatable :: copy

      copy = what                                      ! it may be the text of this status
      call set_status(status, STATUS_USAGE, '--vary '//text//': '//copy)
   end subroutine complain

   !> What is done from now on is noted. What was done before is forgotten unless the sweep resumes.
   subroutine begin_journal(command, provenance, journal)
      type(command_t), intent(in) :: command         !< folder, deck, options and --resume are read
      type(provenance_t), intent(in) :: provenance   !< of the deck without the values that vary
      type(sweep_journal_t), intent(out) :: journal  !< file is removed unless the sweep resumes
      character(len=:), allocatable :: options
      type(text_digest_t) :: digest
      integer :: i

      journal%folder = output_folder(command)
      journal%path = journal%folder//'/'//JOURNAL_NAME
      ! All that runs depend on besides the values that vary, as a word.
      call add_characters(digest, PROGRAM_VERSION//NEW_LINE_CHARACTER//command%names(1)%s//NEW_LINE_CHARACTER)
      if (allocated(provenance%digest)) call add_characters(digest, provenance%digest//NEW_LINE_CHARACTER)
      call options_of_run(command, options)
      if (allocated(options)) call add_characters(digest, options//NEW_LINE_CHARACTER)
      do i = 1, size(command%settings)
         call add_characters(digest, '--set '//command%settings(i)%s//NEW_LINE_CHARACTER)
      end do
      if (command%is_csv) call add_characters(digest, '--format csv')
      journal%key = hexadecimal(digest)
      journal%has_earlier = command%resume
      if (.not. command%resume) call remove_journal(journal)
   end subroutine begin_journal

   !> Forgets what was done.
   subroutine remove_journal(journal)
      type(sweep_journal_t), intent(in) :: journal   !< begun; its file goes

      call remove_file(journal%path)
   end subroutine remove_journal

   !> What an earlier sweep noted of a run counts no longer. A journal that cannot be written keeps nothing from being done.
   subroutine note_begin(journal, plan, run)
      type(sweep_journal_t), intent(in) :: journal   !< gets a line, if it has earlier ones
      type(sweep_plan_t), intent(in) :: plan         !< names the run
      integer(ip), intent(in) :: run                 !< place in the plan

      if (journal%has_earlier) call add_line(journal, BEGUN//' '//name_of(plan, run))
   end subroutine note_begin

   !> A run has come to its end; one that failed for reasons that may be gone the next time is not noted.
   subroutine note_end(journal, plan, run, outcome)
      type(sweep_journal_t), intent(in) :: journal   !< gets a line
      type(sweep_plan_t), intent(in) :: plan         !< names the run
      integer(ip), intent(in) :: run                 !< place in the plan
      integer, intent(in) :: outcome(OUTCOMES)       !< exit code, factorisations, what was written

      if (all(outcome(1) /= [STATUS_OK, STATUS_NOT_CONVERGED, STATUS_SINGULAR])) return
      call add_line(journal, DONE//' '//to_text(int(outcome(1), ip))//' '//to_text(int(outcome(2), ip))//' ' &
                    //to_text(int(outcome(3), ip))//' '//digest_of_summary(journal, plan, run, outcome)//' '//name_of(plan, run))
   end subroutine note_end

   subroutine add_line(journal, text)
      type(sweep_journal_t), intent(in) :: journal
      character(len=*), intent(in) :: text
      integer :: ignored

      ignored = c_append_line(journal%path//c_null_char, journal%key//' '//text//c_null_char)
   end subroutine add_line

   !> The folder, which has no blanks, and the values.
   pure function name_of(plan, run) result(name)
      type(sweep_plan_t), intent(in) :: plan
      integer(ip), intent(in) :: run
      character(len=:), allocatable :: name

      name = plan%folders(run)%s//' '//plan%labels(run)%s
   end function name_of

   !> Of the file as it is; a word in its place where the run wrote none, or none can be read.
   function digest_of_summary(journal, plan, run, outcome) result(word)
      type(sweep_journal_t), intent(in) :: journal
      type(sweep_plan_t), intent(in) :: plan
      integer(ip), intent(in) :: run
      integer, intent(in) :: outcome(OUTCOMES)
      character(len=:), allocatable :: word, text
      type(text_digest_t) :: digest
      type(status_t) :: status

      word = NO_TABLE
      if (outcome(3) == 0) return
      call read_file(table_path(journal%folder//'/'//plan%folders(run)%s, 'summary'), text, status)
      word = 'missing'
      if (.not. is_ok(status)) return
      call add_characters(digest, text)
      word = hexadecimal(digest)
   end function digest_of_summary

   !> Which runs are done, and how they ended.
   subroutine find_done(journal, plan, is_done, outcomes_of)
      type(sweep_journal_t), intent(in) :: journal   !< begun
      type(sweep_plan_t), intent(in) :: plan         !< of this sweep
      logical, intent(out) :: is_done(:)             !< (n_runs)
      integer, intent(out) :: outcomes_of(:, :)      !< (OUTCOMES, n_runs)
      character(len=:), allocatable :: text
      type(status_t) :: status
      integer :: first, last
      integer(ip) :: run

      is_done = .false.
      outcomes_of = 0
      if (.not. file_exists(journal%path)) return
      call read_file(journal%path, text, status)
      if (.not. is_ok(status)) return
      run = 1
      first = 1
      do while (first <= len(text))
         last = first + index(text(first:), NEW_LINE_CHARACTER) - 2
         if (last < first - 1) exit                  ! a line that is not complete
         call take_line(text(first:last))
         first = last + 2
      end do

   contains

      !> A line of the journal; one that is not of this sweep is passed over.
      subroutine take_line(line)
         character(len=*), intent(in) :: line
         character(len=:), allocatable :: rest, digest
         integer :: i
         logical :: ok

         rest = line
         ok = next_word(rest) == journal%key
         select case (next_word(rest))
         case (BEGUN)
            call find_run(rest, run, ok) ! of another key, too: the folder has other files then
            if (ok) is_done(run) = .false.
         case (DONE)
            if (.not. ok) return
            outcome: block
               integer :: found(OUTCOMES)
               do i = 1, OUTCOMES
                  call take_number(next_word(rest), found(i), ok)
                  if (.not. ok) return
               end do
               digest = next_word(rest)
               call find_run(rest, run, ok)
               if (.not. ok) return
               is_done(run) = digest == digest_of_summary(journal, plan, run, found)
               outcomes_of(:, run) = found
            end block outcome
         end select
      end subroutine take_line

      !> The run of a name, looked for from the one of the line before on.
      pure subroutine find_run(name, run, found)
         character(len=*), intent(in) :: name
         integer(ip), intent(inout) :: run
         logical, intent(out) :: found
         integer(ip) :: i, place

         found = .false.
         do i = 0, plan%n_runs - 1
            place = modulo(run - 1 + i, plan%n_runs) + 1
            found = name_of(plan, place) == name
            if (found) exit
         end do
         if (found) run = place
      end subroutine find_run
   end subroutine find_done

   !> Takes the first word off.
   function next_word(rest) result(word)
      character(len=:), allocatable, intent(inout) :: rest
      character(len=:), allocatable :: word
      integer :: blank

      blank = index(rest//' ', ' ')
      word = rest(:blank - 1)
      rest = rest(min(blank + 1, len(rest) + 1):)
   end function next_word

   subroutine take_number(word, number, ok)
      character(len=*), intent(in) :: word
      integer, intent(out) :: number
      logical, intent(out) :: ok
      integer(ip) :: found
      integer :: outcome

      call read_integer(word, found, outcome)
      ok = outcome == NUMBER_OK
      number = merge(int(found), 0, ok)
   end subroutine take_number

end module atrito_sweep_plan
