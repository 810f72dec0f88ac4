!> Writes report.html: all that a folder of output tells, on one page that needs nothing else.
!>
!> Comes after tables and pictures, which are complete whatever happens here: every failure is a warning, W-REPORT. What has rows
!> is read from the folder, so that a table or picture that is new appears without a change here. Pictures are letters within the
!> page: drawings as SVG where that is small, else PNG; bytes as text of 64 letters (RFC 4648, section 4).
module atrito_write_report
   use atrito_files, only: file_set_t, text_file_t, begin_files, open_text, put_line, close_text, end_files, read_file, &
                           read_bytes, file_exists
   use atrito_html, only: add_element, html_text, shortened, add_note
   use atrito_kinds, only: ip
   use atrito_messages, only: add_warning
   use atrito_page, only: page_t, add_line, begin_page
   use atrito_report, only: report_t, page_section_t, begin_section, add_section
   use atrito_plot_files, only: REPORT_NAME, plot_folder, picture_endings
   use atrito_report_sections, only: contents_t, read_contents, add_numbers, add_results, add_messages, add_sources
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, to_text, append_string, join
   use atrito_style_lines, only: take_style_lines
   use atrito_model, only: name_units, units_t
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: write_report, compose_report, MOST_BYTES, compose_pictures, picture_caption, base64_text, base64_length

   integer, parameter :: MOST_BYTES = 3000000       !< of the page
   integer, parameter :: MOST_HEADING = 20          !< lines
   integer, parameter :: LONGEST_LINE = 1000

   !> A drawing of more bytes is taken as points, where these are fewer.
   integer, parameter :: LARGE_DRAWING = 200000
   integer, parameter :: FRAME_BYTES = 1000         !< what stands round a picture

   !> A picture as it stands in its file.
   type :: picture_t
      character(len=:), allocatable :: file         !< name within the folder of plots
      character(len=:), allocatable :: bytes        !< of the file; not allocated: no room
   end type picture_t

   character(len=*), parameter :: LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/'
   character(len=1), parameter :: FILLER = '='

contains

   !> Writes the report into its folder. is_written is false where it could not be, which is a warning.
   subroutine write_report(report, date, is_written)
      type(report_t), intent(in) :: report          !< as its maker filled it
      character(len=*), intent(in) :: date          !< and time
      logical, intent(out) :: is_written            !< false: there is no file, and a warning
      type(file_set_t) :: set
      type(text_file_t) :: file
      type(status_t) :: status
      type(page_t) :: page
      integer :: i

      call compose_report(report, date, page)
      call begin_files(set, report%folder, status)
      if (is_ok(status)) then
         call open_text(set, REPORT_NAME, file)
         do i = 1, page%n
            call put_line(file, page%lines(i)%s)
         end do
         call close_text(file, status)
         call end_files(set, status)
      end if
      is_written = is_ok(status)
      if (.not. is_written) call add_warning('W-REPORT', 'no report is written: '//status%text)
   end subroutine write_report

   !> Composes the page, without writing it.
   subroutine compose_report(report, date, page)
      type(report_t), intent(in) :: report          !< as its maker filled it
      character(len=*), intent(in) :: date          !< and time
      type(page_t), intent(out) :: page             !< the whole file
      type(page_section_t), allocatable :: before(:), behind(:), sections(:)
      type(page_section_t) :: pictures
      type(contents_t) :: contents
      integer :: i, line

      call read_contents(report, contents)
      call add_numbers(report, contents, before)
      call append_sections(before, report%leading)
      call append_sections(behind, report%sections)
      call add_results(report, contents, behind)
      call name_all(report%units, before)
      call name_all(report%units, behind)
      call add_messages(report, behind)
      call add_sources(report, contents, behind)
      call compose_top(report, date, page)
      call begin_section(pictures, 'Pictures')
      call compose_pictures(report%folder, report%pictures, MOST_BYTES - size_of_page(page) - size_of_sections(before) &
                            - size_of_sections(behind), pictures%page)
      if (size(report%pictures) == 0) call add_element(pictures%page, 'p', 'There are no pictures; the messages tell why.')
      call add_section(before, pictures)
      sections = [before, behind]
      call add_line(page, '<nav aria-label="sections">')
      do i = 1, size(sections)
         call add_line(page, '<a href="#s'//to_text(int(i, ip))//'">'//html_text(sections(i)%title)//'</a>')
      end do
      call add_line(page, '</nav>')
      do i = 1, size(sections)
         call add_line(page, '<section id="s'//to_text(int(i, ip))//'">')
         call add_element(page, 'h2', sections(i)%title)
         do line = 1, sections(i)%page%n
            call add_line(page, sections(i)%page%lines(line)%s)
         end do
         call add_line(page, '</section>')
      end do
      call add_line(page, '<footer><p>'//PROGRAM_NAME//' '//PROGRAM_VERSION//', '//html_text(date)//'</p></footer>')
      call add_line(page, '</main></body></html>')
   end subroutine compose_report

   !> The units of numbers and tables.
   pure subroutine name_all(units, sections)
      type(units_t), intent(in) :: units
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      integer :: i, line

      if (.not. allocated(sections)) return
      do i = 1, size(sections)
         do line = 1, sections(i)%page%n
            call name_units(units, sections(i)%page%lines(line)%s)
         end do
      end do
   end subroutine name_all

   pure subroutine append_sections(sections, others)
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t), intent(in), optional :: others(:)
      integer :: i

      if (.not. present(others)) return
      do i = 1, size(others)
         call add_section(sections, others(i))
      end do
   end subroutine append_sections

   !> What comes before the sections: the head, by which nothing is fetched from anywhere and no script is run, title and verdict.
   subroutine compose_top(report, date, page)
      type(report_t), intent(in) :: report
      character(len=*), intent(in) :: date
      type(page_t), intent(out) :: page
      character(len=:), allocatable :: title
      type(string_t), allocatable :: style(:)
      integer :: i, first

      call begin_page(page, 80)
      title = file_name(report%deck)
      first = 1
      if (size(report%heading) > 0) then
         if (len_trim(report%heading(1)%s) > 0) then
            title = trim(report%heading(1)%s)
            first = 2
         end if
      end if
      title = shortened(title, LONGEST_LINE)
      call add_line(page, '<!DOCTYPE html>')
      call add_line(page, '<html lang="en"><head><meta charset="utf-8">')
      call add_line(page, '<meta name="viewport" content="width=device-width, initial-scale=1">')
      call add_line(page, '<meta name="generator" content="'//PROGRAM_NAME//' '//PROGRAM_VERSION//'">')
      call add_line(page, '<meta http-equiv="Content-Security-Policy" content="default-src ''none''; img-src data:; '// &
                    'style-src ''unsafe-inline''">')
      call add_element(page, 'title', title)
      call add_line(page, '<style>')
      call take_style_lines(style)                   ! report.css: on all screens, light and dark, on narrow ones, on paper
      do i = 1, size(style)
         call add_line(page, style(i)%s)
      end do
      call add_line(page, '</style>')
      call add_line(page, '</head><body><main>')
      call add_element(page, 'p', PROGRAM_NAME//' '//PROGRAM_VERSION//', '//report%what//' of '//file_name(report%deck)// &
                       ', '//date, ' class="kind"')
      call add_element(page, 'h1', title)
      do i = first, min(size(report%heading), MOST_HEADING)
         call add_element(page, 'p', shortened(report%heading(i)%s, LONGEST_LINE))
      end do
      call add_line(page, '<div class="verdict '//trim(merge('good', 'bad ', report%is_good))//'">')
      call add_line(page, '<p><strong>'//html_text(report%verdict)//'</strong></p>')
      do i = 1, size(report%details)
         call add_element(page, 'p', report%details(i)%s)
      end do
      call add_line(page, '</div>')
   end subroutine compose_top

   pure function file_name(path) result(name)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: name

      name = path(index(path, '/', back=.true.) + 1:)
   end function file_name

   !> Bytes, with the ends of the lines and what stands round a section.
   pure integer function size_of_sections(sections) result(n)
      type(page_section_t), intent(in), optional :: sections(:)
      integer :: i

      n = 0
      if (.not. present(sections)) return
      do i = 1, size(sections)
         n = n + size_of_page(sections(i)%page) + 3*len(sections(i)%title) + 200
      end do
   end function size_of_sections

   pure integer function size_of_page(page) result(n)
      type(page_t), intent(in) :: page
      integer :: i

      n = 0
      do i = 1, page%n
         n = n + len(page%lines(i)%s) + 1
      end do
   end function size_of_page

   !> Puts pictures onto a page, in their order, as long as there is room. Those that find none are named.
   subroutine compose_pictures(folder, names, room, page)
      character(len=*), intent(in) :: folder        !< of the tables
      type(string_t), intent(in) :: names(:)        !< of pictures that were drawn, without ending
      integer, intent(in) :: room                   !< bytes
      type(page_t), intent(out) :: page             !< pictures as lines of HTML
      type(string_t), allocatable :: left_out(:)
      type(picture_t) :: picture
      integer :: i, free
      character(len=:), allocatable :: caption, kind

      call begin_page(page, 80)
      allocate (left_out(0))
      free = room
      if (size(names) > 0) call add_line(page, '<div class="pictures">')
      do i = 1, size(names)
         call choose_picture(plot_folder(folder), names(i)%s, free, picture)
         if (allocated(picture%bytes)) then
            associate (name => names(i)%s)
               caption = picture_caption(plot_folder(folder), name)
               kind = picture%file(index(picture%file, '.', back=.true.) + 1:)
               if (kind == 'svg') kind = 'svg+xml'
               call add_line(page, '<figure id="'//html_text('picture-'//name)//'">')
               call add_line(page, '<div class="scroll" tabindex="0" role="region" aria-label="'//html_text('picture '//name)//'">')
               call add_line(page, '<img alt="'//html_text(name//': '//caption)//'" src="data:image/'//kind//';base64,'// &
                             base64_text(picture%bytes)//'"></div>')
               call add_line(page, '<figcaption><strong>'//html_text(name)//'</strong> '//html_text(caption)//'. File: '// &
                             html_text('plots/'//picture%file)//'</figcaption>')
               call add_line(page, '</figure>')
            end associate
            free = free - base64_length(len(picture%bytes)) - FRAME_BYTES
         else
            call append_string(left_out, names(i)%s)
         end if
      end do
      if (size(names) > 0) call add_line(page, '</div>')
      if (size(left_out) > 0) call add_note(page, 'Left out, for the report would be too large: '//join(left_out, ', ')// &
                                            '. They are in '//plot_folder(folder)//'.')
   end subroutine compose_pictures

   !> The file of a picture to be taken; none where no file has room.
   subroutine choose_picture(folder, name, room, picture)
      character(len=*), intent(in) :: folder        !< of the plots
      character(len=*), intent(in) :: name
      integer, intent(in) :: room
      type(picture_t), intent(out) :: picture
      character(len=4), allocatable :: endings(:)
      character(len=:), allocatable :: bytes
      type(status_t) :: status
      integer :: k

      endings = picture_endings(name)
      do k = 1, size(endings)
         if (.not. file_exists(folder//'/'//name//endings(k))) cycle
         call read_bytes(folder//'/'//name//endings(k), bytes, status)
         if (.not. is_ok(status) .or. len(bytes) == 0) cycle
         if (base64_length(len(bytes)) + FRAME_BYTES > room) cycle
         if (allocated(picture%bytes)) then         ! lines are sharp at any size, as long as they are not too many
            if (len(bytes) >= len(picture%bytes) .and. .not. (endings(k) == '.svg' .and. len(bytes) <= LARGE_DRAWING)) cycle
         end if
         picture%file = name//endings(k)
         call move_alloc(bytes, picture%bytes)
      end do
   end subroutine choose_picture

   !> What a picture shows: the first line of its script says it behind the name of the program.
   function picture_caption(folder, name) result(caption)
      character(len=*), intent(in) :: folder        !< of the plots
      character(len=*), intent(in) :: name          !< of the picture, without ending
      character(len=:), allocatable :: caption, text
      type(status_t) :: status
      integer :: ends, colon

      caption = 'a picture'
      if (.not. file_exists(folder//'/'//name//'.gp')) return
      call read_file(folder//'/'//name//'.gp', text, status)
      if (.not. is_ok(status)) return
      ends = index(text, achar(10)) - 1
      if (ends < 1) return
      colon = index(text(:ends), ': ')
      if (text(1:1) == '#' .and. colon > 0) caption = text(colon + 2:ends)
   end function picture_caption

   !> Letters that so many bytes need.
   pure integer function base64_length(n_bytes) result(n)
      integer, intent(in) :: n_bytes !< >= 0

      n = 4*((n_bytes + 2)/3)
   end function base64_length

   !> Three bytes in four letters; what the last three lack is filled.
   pure function base64_text(bytes) result(text)
      character(len=*), intent(in) :: bytes         !< any bytes, one a character
      character(len=:), allocatable :: text
      integer :: i, k, word, there

      allocate (character(len=base64_length(len(bytes))) :: text)
      k = 0
      do i = 1, len(bytes), 3
         there = min(3, len(bytes) - i + 1)
         word = 65536*ichar(bytes(i:i))
         if (there > 1) word = word + 256*ichar(bytes(i + 1:i + 1))
         if (there > 2) word = word + ichar(bytes(i + 2:i + 2))
         text(k + 1:k + 4) = letter(word/262144)//letter(word/4096)//letter(word/64)//letter(word)
         if (there < 3) text(k + there + 2:k + 4) = repeat(FILLER, 3 - there)
         k = k + 4
      end do
   end function base64_text

   !> The letter of the last six bits.
   pure character(len=1) function letter(word)
      integer, intent(in) :: word
      integer :: i

      i = iand(word, 63) + 1
      letter = LETTERS(i:i)
   end function letter

end module atrito_write_report
