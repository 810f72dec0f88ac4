!> The sections that all reports have in common, from the tables in the folder and from the messages of the run.
module atrito_report_sections
   use atrito_files, only: read_file
   use atrito_html, only: fact_t, add_fact, add_element, add_facts, add_note, add_pre, html_text, shortened
   use atrito_html_table, only: table_top_t, read_top, ALL_ROWS, add_table, MOST_ROWS
   use atrito_kinds, only: ip, lp
   use atrito_messages, only: message_t, count_messages, get_message, format_message, SEVERITY_NOTE
   use atrito_page, only: page_t, add_line, plural
   use atrito_plot_files, only: plot_folder
   use atrito_report, only: report_t, page_section_t, begin_section, add_section
   use atrito_report_numbers, only: add_extremes, add_summary_numbers, add_quantities
   use atrito_residual_chart, only: add_residual_chart
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string, count_symbol, join, to_text
   implicit none (type, external)
   private
   public :: contents_t, read_contents, add_numbers, add_results, add_messages, add_sources

   !> The tables of a folder.
   type :: contents_t
      type(string_t), allocatable :: names(:)       !< without ending
      type(table_top_t), allocatable :: tops(:)     !< of each name the first rows
      type(string_t), allocatable :: unread(:)      !< files that could not be read, and why
   end type contents_t

   character(len=*), parameter :: ENDINGS(2) = ['.tab', '.csv']
   !> Tables that have sections of their own, of which all rows are read.
   character(len=*), parameter :: SUMMARY = 'summary', ITERATIONS = 'iterations', TIMING = 'timing', EXTREMES = 'extremes'
   !> Tables that come first.
   character(len=*), parameter :: FIRST(3) = [character(len=10) :: 'resultants', EXTREMES, 'sections']
   integer(ip), parameter :: MOST_NOTES = 100
   integer, parameter :: WHOLE_DECK = 200, ENDS_OF_DECK(2) = [150, 40]   !< lines that are shown of a deck, and of a longer one
   integer, parameter :: MOST_LISTED = 200000       !< bytes of the listing
   integer, parameter :: LONGEST_VALUE = 4000       !< bytes of a line of parameters
   integer(ip), parameter :: MOST_FILES = 100

contains

   !> Reads the tops of all tables that the run wrote, all rows of those that are summed up.
   subroutine read_contents(report, contents)
      type(report_t), intent(in) :: report          !< its folder and files are read
      type(contents_t), intent(out) :: contents     !< of all files that are tables
      type(table_top_t) :: top
      type(status_t) :: status
      character(len=:), allocatable :: ending, name
      integer(ip) :: rows
      integer :: i

      allocate (contents%names(0), contents%tops(0), contents%unread(0))
      do i = 1, size(report%files)
         associate (file => report%files(i)%s)
            ending = ending_of(file)
            if (.not. any(ENDINGS == ending)) cycle
            name = file(:len(file) - len(ending))
            rows = MOST_ROWS
            if (has_own_section(name) .or. name == EXTREMES) rows = ALL_ROWS
            call read_top(report%folder//'/'//file, rows, top, status)
            if (is_ok(status)) then
               call append_string(contents%names, name)
               contents%tops = [contents%tops, top]
            else
               call append_string(contents%unread, status%text)
            end if
         end associate
      end do
   end subroutine read_contents

   pure logical function has_own_section(name)
      character(len=*), intent(in) :: name

      has_own_section = name == SUMMARY .or. name == ITERATIONS .or. name == TIMING
   end function has_own_section

   !> `.tab` of `contact.tab`.
   pure function ending_of(file) result(ending)
      character(len=*), intent(in) :: file
      character(len=:), allocatable :: ending
      integer :: dot

      dot = index(file, '.', back=.true.)
      ending = ''
      if (dot > 0) ending = file(dot:)
   end function ending_of

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
      type(report_t), intent(in) :: report          !< its facts are read
      type(contents_t), intent(in) :: contents      !< extremes and summary are read
      type(page_section_t), allocatable, intent(inout) :: sections(:) !< get one, if there are numbers
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

   !> What the tables hold: the pairs with their names and the quantities of each step, from the table summary; tables; the
   !> residuals over the iterations, as a chart and as a table; times.
   subroutine add_results(report, contents, sections)
      type(report_t), intent(in) :: report          !< names of its pairs are read
      type(contents_t), intent(in) :: contents      !< of all tables of the folder
      type(page_section_t), allocatable, intent(inout) :: sections(:) !< get those that have lines
      type(page_section_t) :: section
      integer :: i, k

      i = place_of(contents, SUMMARY)
      if (i > 0) then
         call begin_section(section, 'Contact pairs')
         if (allocated(report%pairs)) then
            do k = 1, min(size(report%pairs), int(MOST_ROWS))
               call add_element(section%page, 'p', report%pairs(k)%s)
            end do
            if (size(report%pairs) > MOST_ROWS) call add_note(section%page, 'The first '//to_text(MOST_ROWS)//' of '// &
                                                              to_text(size(report%pairs, kind=ip))//' pairs.')
         end if
         call add_quantities(section%page, contents%tops(i), .false.)
         call add_quantities(section%page, contents%tops(i), .true.)
         call add_section(sections, section)
      end if
      call begin_section(section, 'Tables')
      if (size(contents%tops) > 0) call add_note(section%page, 'Reals have six digits here; all digits are in the files.')
      call add_tables(section%page, contents)
      call add_section(sections, section)
      i = place_of(contents, ITERATIONS)
      if (i > 0) then
         call begin_section(section, 'Convergence')
         if (contents%tops(i)%n_rows > 0) then
            call add_residual_chart(section%page, contents%tops(i)%table)
            call add_table(section%page, ITERATIONS, contents%tops(i))
         end if
         call add_section(sections, section)
      end if
      i = place_of(contents, TIMING)
      if (i > 0) then
         call begin_section(section, 'Times')
         call add_table(section%page, TIMING, contents%tops(i))
         call add_section(sections, section)
      end if
   end subroutine add_results

   !> Tables that come first, then those that are shown whole, then the first rows of the others.
   subroutine add_tables(page, contents)
      type(page_t), intent(inout) :: page
      type(contents_t), intent(in) :: contents
      integer :: rank(size(contents%names)), i, k

      do i = 1, size(rank)
         rank (i) = findloc(FIRST == contents%names(i)%s, .true., dim=1)
         if (rank(i) == 0) rank(i) = size(FIRST) + merge(1, 2, contents%tops(i)%n_rows <= MOST_ROWS)
         if (has_own_section(contents%names(i)%s)) rank(i) = 0
      end do
      do k = 1, size(FIRST) + 2
         do i = 1, size(rank)
            if (rank(i) == k) call add_table(page, contents%names(i)%s, contents%tops(i))
         end do
      end do
      do i = 1, size(contents%unread)
         call add_element(page, 'p', 'not read: '//contents%unread(i)%s)
      end do
   end subroutine add_tables

   !> All warnings of the run and its first notes, as they were printed.
   subroutine add_messages(report, sections)
      type(report_t), intent(in) :: report          !< what it says of other messages is read
      type(page_section_t), allocatable, intent(inout) :: sections(:) !< get one
      type(page_section_t) :: section
      type(message_t) :: message
      integer(ip) :: i, n_notes

      call begin_section(section, 'Messages')
      if (count_messages() == 0) call add_element(section%page, 'p', 'No warnings, no notes.')
      n_notes = 0
      do i = 1, count_messages()
         message = get_message(i)
         if (message%severity == SEVERITY_NOTE) n_notes = n_notes + 1
         if (message%severity == SEVERITY_NOTE .and. n_notes > MOST_NOTES) cycle
         call add_pre(section%page, shortened(join(format_message(message), achar(10)), LONGEST_VALUE), '')
      end do
      if (n_notes > MOST_NOTES) call add_note(section%page, 'And '//to_text(n_notes - MOST_NOTES)//' more notes.')
      if (allocated(report%other_messages)) call add_element(section%page, 'p', report%other_messages)
      call add_section(sections, section)
   end subroutine add_messages

   !> Where all that comes from and where it is: the command, and what the heads of the tables tell of deck, parameters and options;
   !> the compiler and the libraries; the folder, and what stands in it; the listing, folded, which tells of materials, supports and
   !> loads, too.
   subroutine add_sources(report, contents, sections)
      type(report_t), intent(in) :: report          !< command, deck, versions, folder, files and pictures
      type(contents_t), intent(in) :: contents      !< origin of the first table is read
      type(page_section_t), allocatable, intent(inout) :: sections(:) !< get those that have lines
      type(page_section_t) :: section
      type(fact_t), allocatable :: facts(:), places(:)
      type(status_t) :: status
      character(len=:), allocatable :: text
      integer(ip) :: i, n, colon

      if (allocated(report%command)) call add_fact(facts, 'command', shortened(report%command, LONGEST_VALUE))
      call add_fact(facts, 'deck', report%deck)
      if (size(contents%tops) > 0) then
         associate (origin => contents%tops(1)%origin)
            do i = 1, size(origin, kind=ip)
               colon = index(origin(i)%s, ': ', kind=ip)
               if (colon < 2) cycle
               if (any(origin(i)%s(:colon - 1) == [character(len=7) :: 'program', 'deck', 'heading'])) cycle
               call add_fact(facts, origin(i)%s(:colon - 1), shortened(origin(i)%s(colon + 2:), LONGEST_VALUE))
            end do
         end associate
      end if
      call add_plain('Input', facts)
      call add_plain('Versions', report%versions)
      n = size(report%files, kind=ip)
      text = join(report%files(:min(n, MOST_FILES)), ', ')
      if (n > MOST_FILES) text = text//', and '//plural(n - MOST_FILES, 'file', 'files')//' more'
      call add_fact(places, 'folder', report%folder)
      call add_fact(places, 'files', text)
      if (size(report%pictures) > 0) call add_fact(places, 'pictures', &
                                                   plot_folder(report%folder)//': '//join(report%pictures, ', '))
      call add_plain('Files', places)
      call add_deck(report, sections)
      call begin_section(section, 'Listing')
      do i = 1, n
         if (ending_of(report%files(i)%s) /= '.lst') cycle
         call read_file(report%folder//'/'//report%files(i)%s, text, status)
         if (.not. is_ok(status)) cycle
         call add_line(section%page, '<details><summary>'//html_text(report%files(i)%s)//'</summary>')
         call add_pre(section%page, shortened(text, MOST_LISTED), '')
         call add_line(section%page, '</details>')
      end do
      call add_section(sections, section)

   contains

      subroutine add_plain(title, list)
         character(len=*), intent(in) :: title
         type(fact_t), intent(in) :: list(:)

         call begin_section(section, title)
         call add_facts(section%page, list, 'plain')
         call add_section(sections, section)
      end subroutine add_plain

   end subroutine add_sources

   !> The deck as it was run, where its run wrote it, else as it stands in its file.
   subroutine add_deck(report, sections)
      type(report_t), intent(in) :: report
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t) :: section
      character(len=:), allocatable :: path, text, ends
      type(status_t) :: status
      integer :: i, j, first, last
      integer(lp) :: n

      path = report%deck
      do i = 1, size(report%files)
         if (ending_of(report%files(i)%s) == '.inp') path = report%folder//'/'//report%files(i)%s
      end do
      call read_file(path, text, status)
      if (.not. is_ok(status)) return
      call begin_section(section, 'Deck')
      call add_note(section%page, path)
      ! A text with some of its first and last lines, where it has many.
      ends = text
      n = count_symbol(text, achar(10))
      if (n > WHOLE_DECK) then
         first = 0
         do j = 1, ENDS_OF_DECK(1)
            first = first + index(text(first + 1:), achar(10))
         end do
         last = len(text) + 1
         do j = 0, ENDS_OF_DECK(2)
            last = index(text(:last - 1), achar(10), back=.true.)
         end do
         ends = text(:first)//'   ... '//to_text(n - sum(ENDS_OF_DECK))//' lines ...'//text(last:)
      end if
      call add_pre(section%page, shortened(ends, MOST_LISTED), ' class="deck"')
      call add_section(sections, section)
   end subroutine add_deck

end module atrito_report_sections
