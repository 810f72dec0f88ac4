!> The sections that all reports have in common, from the tables in the folder and from the messages of the run.
module atrito_report_sections
   use atrito_files, only: read_file
   use atrito_html, only: fact_t, add_fact, add_element, add_facts, add_note, add_pre, html_text, shortened
   use atrito_html_table, only: add_table, MOST_ROWS
   use atrito_kinds, only: ip
   use atrito_messages, only: count_messages, get_message, format_message
   use atrito_page, only: add_line, plural
   use atrito_plot_files, only: plot_folder
   use atrito_report, only: report_t, page_section_t, begin_section, add_section
   use atrito_report_numbers, only: add_extremes, add_summary_numbers, add_quantities
   use atrito_residual_chart, only: add_residual_chart
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string, join, to_text
   use atrito_table_top, only: table_top_t, read_top, ALL_ROWS
   implicit none (type, external)
   private
   public :: contents_t, read_contents, add_numbers, add_contact, add_steps, add_tables, add_convergence, add_times, add_messages, &
             add_origin, add_versions, add_files, add_listing

   !> The tables of a folder.
   type :: contents_t
      type(string_t), allocatable :: names(:)       !< without ending
      type(table_top_t), allocatable :: tops(:)
      type(string_t), allocatable :: unread(:)      !< files that could not be read, and why
   end type contents_t

   character(len=*), parameter :: ENDINGS(2) = ['.tab', '.csv']
   !> Tables that have sections of their own, of which all rows are read.
   character(len=*), parameter :: SUMMARY = 'summary', ITERATIONS = 'iterations', TIMING = 'timing', EXTREMES = 'extremes'
   !> Tables that come first.
   character(len=*), parameter :: FIRST(3) = [character(len=10) :: 'resultants', EXTREMES, 'sections']
   integer(ip), parameter :: MOST_MESSAGES = 100
   integer, parameter :: MOST_LISTED = 200000       !< bytes of the listing
   integer, parameter :: LONGEST_VALUE = 4000       !< bytes of a line of parameters
   integer, parameter :: MOST_FILES = 100

contains

   !> Reads the tops of all tables that the run wrote.
   subroutine read_contents(report, contents)
      type(report_t), intent(in) :: report
      type(contents_t), intent(out) :: contents
      type(table_top_t) :: top
      type(status_t) :: status
      integer :: i

      allocate (contents%names(0), contents%tops(0), contents%unread(0))
      do i = 1, size(report%files)
         associate (file => report%files(i)%s)
            if (.not. any(ENDINGS == ending_of(file))) cycle
            call read_top(report%folder//'/'//file, rows_of(stem_of(file)), top, status)
            if (is_ok(status)) then
               call append_string(contents%names, stem_of(file))
               contents%tops = [contents%tops, top]
            else
               call append_string(contents%unread, status%text)
            end if
         end associate
      end do
   end subroutine read_contents

   !> Rows of a table that are looked at.
   pure integer(ip) function rows_of(name)
      character(len=*), intent(in) :: name

      rows_of = MOST_ROWS
      if (has_own_section(name) .or. name == EXTREMES) rows_of = ALL_ROWS
   end function rows_of

   pure logical function has_own_section(name)
      character(len=*), intent(in) :: name

      has_own_section = name == SUMMARY .or. name == ITERATIONS .or. name == TIMING
   end function has_own_section

   !> `.tab` of `contact.tab`.
   pure function ending_of(file) result(ending)
      character(len=*), intent(in) :: file
      character(len=:), allocatable :: ending

      ending = file(len(stem_of(file)) + 1:)
   end function ending_of

   pure function stem_of(file) result(stem)
      character(len=*), intent(in) :: file
      character(len=:), allocatable :: stem
      integer :: dot

      dot = index(file, '.', back=.true.)
      stem = file
      if (dot > 0) stem = file(:dot - 1)
   end function stem_of

   !> Place of a table; 0: there is none.
   pure integer function place_of(contents, name) result(i)
      type(contents_t), intent(in) :: contents
      character(len=*), intent(in) :: name

      do i = 1, size(contents%names)
         if (contents%names(i)%s == name) return
      end do
      i = 0
   end function place_of

   !> Key numbers: extremes, what the maker of the report knows, energies and checks.
   subroutine add_numbers(report, contents, sections)
      type(report_t), intent(in) :: report
      type(contents_t), intent(in) :: contents
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      type(fact_t), allocatable :: facts(:)
      integer :: i

      allocate (facts(0))
      i = place_of(contents, EXTREMES)
      if (i > 0) call add_extremes(contents%tops(i), facts)
      if (allocated(report%facts)) facts = [facts, report%facts]
      i = place_of(contents, SUMMARY)
      if (i > 0) call add_summary_numbers(contents%tops(i), facts)
      call begin_section(section, 'Key numbers')
      call add_facts(section%page, facts, 'tiles')
      call add_section(sections, section)
   end subroutine add_numbers

   !> The pairs, with their names.
   subroutine add_contact(report, contents, sections)
      type(report_t), intent(in) :: report
      type(contents_t), intent(in) :: contents
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      integer :: i, k

      i = place_of(contents, SUMMARY)
      if (i == 0) return
      call begin_section(section, 'Contact pairs')
      if (allocated(report%pairs)) then
         do k = 1, min(size(report%pairs), int(MOST_ROWS))
            call add_element(section%page, 'p', report%pairs(k)%s)
         end do
         if (size(report%pairs) > MOST_ROWS) call add_note(section%page, 'The first '//to_text(MOST_ROWS)//' of '// &
                                                           to_text(size(report%pairs, kind=ip))//' pairs.')
      end if
      call add_quantities(section%page, contents%tops(i), .false.)
      call add_section(sections, section)
   end subroutine add_contact

   !> The quantities of each step, from the table summary.
   subroutine add_steps(contents, sections)
      type(contents_t), intent(in) :: contents
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      integer :: i

      i = place_of(contents, SUMMARY)
      if (i == 0) return
      call begin_section(section, 'Quantities of the step')
      call add_quantities(section%page, contents%tops(i), .true.)
      call add_section(sections, section)
   end subroutine add_steps

   !> Tables that are shown whole, then the tops of the others.
   subroutine add_tables(contents, sections)
      type(contents_t), intent(in) :: contents
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      logical :: done(size(contents%names))
      integer :: i, k

      call begin_section(section, 'Tables')
      done = [(has_own_section(contents%names(i)%s), i=1, size(contents%names))]
      do k = 1, size(FIRST)
         i = place_of(contents, trim(FIRST(k)))
         if (i == 0) cycle
         call add_table(section%page, contents%names(i)%s, contents%tops(i))
         done(i) = .true.
      end do
      do k = 1, 2
         do i = 1, size(done)
            if (done(i) .or. (k == 1 .and. .not. is_whole(contents%tops(i)))) cycle
            call add_table(section%page, contents%names(i)%s, contents%tops(i))
            done(i) = .true.
         end do
      end do
      do i = 1, size(contents%unread)
         call add_element(section%page, 'p', 'not read: '//contents%unread(i)%s)
      end do
      call add_section(sections, section)
   end subroutine add_tables

   !> Whether no row is left out.
   pure logical function is_whole(top)
      type(table_top_t), intent(in) :: top

      is_whole = top%n_rows <= MOST_ROWS
   end function is_whole

   !> The residuals over the iterations, as a chart and as a table.
   subroutine add_convergence(contents, sections)
      type(contents_t), intent(in) :: contents
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      integer :: i

      i = place_of(contents, ITERATIONS)
      if (i == 0) return
      if (contents%tops(i)%n_rows == 0) return
      call begin_section(section, 'Convergence')
      call add_residual_chart(section%page, contents%tops(i)%table)
      call add_table(section%page, ITERATIONS, contents%tops(i))
      call add_section(sections, section)
   end subroutine add_convergence

   !> The table timing.
   subroutine add_times(contents, sections)
      type(contents_t), intent(in) :: contents
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      integer :: i

      i = place_of(contents, TIMING)
      if (i == 0) return
      call begin_section(section, 'Times')
      call add_table(section%page, TIMING, contents%tops(i))
      call add_section(sections, section)
   end subroutine add_times

   !> Warnings and notes of the run, as they were printed.
   subroutine add_messages(report, sections)
      type(report_t), intent(in) :: report
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      type(string_t), allocatable :: lines(:)
      integer(ip) :: i

      call begin_section(section, 'Messages')
      if (count_messages() == 0) call add_element(section%page, 'p', 'No warnings, no notes.')
      do i = 1, min(count_messages(), MOST_MESSAGES)
         lines = format_message(get_message(i))
         call add_pre(section%page, shortened(join(lines, achar(10)), LONGEST_VALUE))
      end do
      if (count_messages() > MOST_MESSAGES) call add_note(section%page, 'And '//to_text(count_messages() - MOST_MESSAGES)//' more.')
      if (allocated(report%other_messages)) call add_element(section%page, 'p', report%other_messages)
      call add_section(sections, section)
   end subroutine add_messages

   !> The command, and what the heads of the tables tell of deck, parameters and options.
   subroutine add_origin(report, contents, sections)
      type(report_t), intent(in) :: report
      type(contents_t), intent(in) :: contents
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      type(fact_t), allocatable :: facts(:)
      integer :: i, colon

      allocate (facts(0))
      if (allocated(report%command)) call add_fact(facts, 'command', shortened(report%command, LONGEST_VALUE))
      call add_fact(facts, 'deck', report%deck)
      if (size(contents%tops) > 0) then
         associate (origin => contents%tops(1)%origin)
            do i = 1, size(origin)
               colon = index(origin(i)%s, ': ')
               if (colon < 2) cycle
               if (any(origin(i)%s(:colon - 1) == [character(len=7) :: 'program', 'deck', 'heading'])) cycle
               call add_fact(facts, origin(i)%s(:colon - 1), shortened(origin(i)%s(colon + 2:), LONGEST_VALUE))
            end do
         end associate
      end if
      call begin_section(section, 'Input')
      call add_facts(section%page, facts, 'plain')
      call add_section(sections, section)
   end subroutine add_origin

   !> The compiler and the libraries with their versions.
   subroutine add_versions(report, sections)
      type(report_t), intent(in) :: report
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section

      call begin_section(section, 'Versions')
      call add_facts(section%page, report%versions, 'plain')
      call add_section(sections, section)
   end subroutine add_versions

   !> The folder, and what stands in it.
   subroutine add_files(report, sections)
      type(report_t), intent(in) :: report
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      type(fact_t), allocatable :: facts(:)
      character(len=:), allocatable :: text
      integer(ip) :: n

      n = size(report%files, kind=ip)
      text = join(report%files(:min(n, int(MOST_FILES, ip))), ', ')
      if (n > MOST_FILES) text = text//', and '//plural(n - MOST_FILES, 'file', 'files')//' more'
      allocate (facts(0))
      call add_fact(facts, 'folder', report%folder)
      call add_fact(facts, 'files', text)
      if (size(report%pictures) > 0) call add_fact(facts, 'pictures', plot_folder(report%folder)//': '//join(report%pictures, ', '))
      call begin_section(section, 'Files')
      call add_facts(section%page, facts, 'plain')
      call add_section(sections, section)
   end subroutine add_files

   !> The listing, folded: it tells of materials, supports and loads, too.
   subroutine add_listing(report, sections)
      type(report_t), intent(in) :: report
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      type(status_t) :: status
      character(len=:), allocatable :: text
      integer :: i

      call begin_section(section, 'Listing')
      do i = 1, size(report%files)
         if (ending_of(report%files(i)%s) /= '.lst') cycle
         call read_file(report%folder//'/'//report%files(i)%s, text, status)
         if (.not. is_ok(status)) cycle
         call add_line(section%page, '<details><summary>'//html_text(report%files(i)%s)//'</summary>')
         call add_pre(section%page, shortened(text, MOST_LISTED))
         call add_line(section%page, '</details>')
      end do
      call add_section(sections, section)
   end subroutine add_listing

end module atrito_report_sections
