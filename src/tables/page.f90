!> A page of text for people: the listing, the closing summary and the report of `atrito check` are made of these lines.
module atrito_page
   use atrito_kinds, only: ip, lp, wp, is_nan
   use atrito_number_text, only: short_real
   use atrito_strings, only: string_t, break_line, join, to_text
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_system, only: hide_line
   use atrito_model, only: name_units, units_t
   use atrito_utf8, only: visible
   implicit none (type, external)
   private
   public :: page_t, begin_page, begin_report, add_item, add_remark, add_above_rule, add_files, add_line, add_rule, add_heading, &
             add_entry, add_paragraph, add_blank, print_page
   public :: left, right, number, bytes, plural, text_width

   type :: page_t
      integer :: width = 80                         !< columns
      integer :: n = 0                              !< lines so far
      type(string_t), allocatable :: lines(:)       !< the first n are in use
      type(units_t) :: units                        !< that have names
      integer :: n_titles = 0                       !< lines at its top that are the user's
   end type page_t

   integer, parameter :: SCREEN_WIDTH = 79          !< a terminal of 80 columns does not wrap
   integer, parameter :: ITEM_WIDTH = 13            !< room for the label of an item
   integer, parameter :: LABEL_WIDTH = 34           !< room for the label of an entry and its leader
   integer, parameter :: INDENT = 3

contains

   !> An empty page.
   pure subroutine begin_page(page, width)
      type(page_t), intent(out) :: page             !< has no lines yet
      integer, intent(in) :: width                  !< columns

      page%width = width
      allocate (page%lines(64))
   end subroutine begin_page

   !> Begins a page for the screen: a rule, and the program with what it did.
   pure subroutine begin_report(page, what)
      type(page_t), intent(out) :: page             !< has the first two lines
      character(len=*), intent(in) :: what          !< with blanks before it

      call begin_page(page, SCREEN_WIDTH)
      call add_rule(page, '=')
      call add_line(page, left(PROGRAM_NAME//' '//PROGRAM_VERSION//what, page%width))
   end subroutine begin_report

   !> `label     value`, cut where there is no room.
   pure subroutine add_item(page, label, value)
      type(page_t), intent(inout) :: page          !< gets one line more
      character(len=*), intent(in) :: label, value !< at most 12 letters; any text

      call add_line(page, left(left(label, ITEM_WIDTH)//value, page%width))
   end subroutine add_item

   !> An item of as many lines as its words take.
   pure subroutine add_remark(page, label, text)
      type(page_t), intent(inout) :: page         !< gets some lines more
      character(len=*), intent(in) :: label, text !< at most 12 letters; any text
      integer :: first

      first = page%n + 1
      call add_paragraph(page, text, ITEM_WIDTH)
      page%lines(first)%s(:len(label)) = label
   end subroutine add_remark

   !> An item before the rule that ends a report.
   pure subroutine add_above_rule(page, label, value)
      type(page_t), intent(inout) :: page          !< its last line is the rule
      character(len=*), intent(in) :: label, value !< at most 12 letters; any text
      character(len=:), allocatable :: rule

      rule = page%lines(page%n)%s
      page%n = page%n - 1
      call add_item(page, label, value)
      call add_line(page, rule)
   end subroutine add_above_rule

   !> The end of a report: the tables and pictures in a folder.
   pure subroutine add_files(page, folder, tables, pictures)
      type(page_t), intent(inout) :: page            !< gets the lines and the last rule
      character(len=*), intent(in) :: folder, tables !< as the user wrote it; names with blanks between them
      type(string_t), intent(in) :: pictures(:)      !< names without folder and ending; none: not told

      call add_item(page, 'tables in', folder)
      call add_item(page, '', tables)
      if (size(pictures) > 0) call add_item(page, 'plots in', folder//'/plots: '//join(pictures, ' '))
      call add_rule(page, '=')
   end subroutine add_files

   !> Adds a line; blanks at its end are dropped.
   pure subroutine add_line(page, text)
      type(page_t), intent(inout) :: page  !< gets one line more
      character(len=*), intent(in) :: text !< in UTF-8, without indentation of its own
      type(string_t), allocatable :: longer(:)
      integer :: i

      if (page%n == size(page%lines)) then
         allocate (longer(2*page%n))
         do i = 1, page%n
            call move_alloc(page%lines(i)%s, longer(i)%s)
         end do
         call move_alloc(longer, page%lines)
      end if
      page%n = page%n + 1
      page%lines(page%n)%s = trim(text)
   end subroutine add_line

   !> Adds an empty line.
   pure subroutine add_blank(page)
      type(page_t), intent(inout) :: page !< gets one line more

      call add_line(page, '')
   end subroutine add_blank

   !> A line across the page.
   pure subroutine add_rule(page, mark)
      type(page_t), intent(inout) :: page  !< gets one line more
      character(len=1), intent(in) :: mark !< one letter

      call add_line(page, repeat(mark, page%width))
   end subroutine add_rule

   !> A heading with a line below it.
   pure subroutine add_heading(page, text)
      type(page_t), intent(inout) :: page  !< gets three lines more
      character(len=*), intent(in) :: text !< of one line

      call add_blank(page)
      call add_line(page, text)
      call add_rule(page, '-')
   end subroutine add_heading

   !> `label ......... value`, the value on lines of its own where there is no room.
   pure subroutine add_entry(page, label, value)
      type(page_t), intent(inout) :: page          !< gets one line more, or some
      character(len=*), intent(in) :: label, value !< what it is; its value with the dimension

      character(len=:), allocatable :: start

      start = repeat(' ', INDENT)//label//' '//repeat('.', max(2, LABEL_WIDTH - 1 - text_width(label)))//' '
      if (text_width(start//value) <= page%width) then
         call add_line(page, start//value)
      else
         call add_line(page, start)
         call add_paragraph(page, value, 2*INDENT)
      end if
   end subroutine add_entry

   !> A text broken into lines at its blanks.
   pure subroutine add_paragraph(page, text, margin)
      type(page_t), intent(inout) :: page           !< gets some lines more
      character(len=*), intent(in) :: text          !< in UTF-8; '': no line
      integer, intent(in) :: margin                 !< blanks before each line
      integer :: first, last, next

      first = 1
      do while (first <= len_trim(text))
         call break_line(text(:len_trim(text)), page%width - margin, first, last, next)
         call add_line(page, repeat(' ', margin)//text(first:last))
         first = next
      end do
   end subroutine add_paragraph

   !> Prints a page. A failure (a closed pipe, a full disk behind it) is nobody's error.
   subroutine print_page(page, unit)
      type(page_t), intent(in) :: page !< all its lines are printed
      integer, intent(in) :: unit      !< of Fortran, open
      character(len=:), allocatable :: line
      integer :: i, ios

      call hide_line()
      do i = 1, page%n
         line = page%lines(i)%s
         if (i > page%n_titles) call name_units(page%units, line)
         write (unit, '(a)', iostat=ios) visible(line)
         if (ios /= 0) return
      end do
      flush (unit, iostat=ios)
   end subroutine print_page

   !> A text at the left of a field, cut with dots where it is too long.
   pure function left(text, width) result(field)
      character(len=*), intent(in) :: text !< in UTF-8
      integer, intent(in) :: width         !< letters of the field
      character(len=:), allocatable :: field
      integer :: last, letters

      field = trim(text)
      if (text_width(field) > width) then
         letters = 0
         do last = 1, len(field)                    ! the place behind those that fit
            if (.not. is_continuation(field(last:last))) letters = letters + 1
            if (letters > max(width - 2, 0)) exit
         end do
         field = field(:last - 1)//'..'
      end if
      field = field//repeat(' ', max(0, width - text_width(field)))
   end function left

   !> A text at the right of a field.
   pure function right(text, width) result(field)
      character(len=*), intent(in) :: text !< in UTF-8
      integer, intent(in) :: width         !< letters; a longer text is not cut
      character(len=:), allocatable :: field

      field = repeat(' ', max(0, width - text_width(text)))//text
   end function right

   !> Letters of a UTF-8 text.
   pure integer function text_width(text) result(width)
      character(len=*), intent(in) :: text !< in UTF-8
      integer :: i

      width = 0
      do i = 1, len(text)
         if (.not. is_continuation(text(i:i))) width = width + 1
      end do
   end function text_width

   pure logical function is_continuation(byte)
      character(len=1), intent(in) :: byte

      is_continuation = iand(iachar(byte), 192) == 128
   end function is_continuation

   !> A real for people.
   pure function number(x, digits) result(text)
      real(wp), intent(in) :: x                     !< any double
      integer, intent(in) :: digits                 !< significant digits
      character(len=:), allocatable :: text

      if (is_nan(x)) then
         text = 'undefined'
      else if (abs(x) > huge(x)) then
         text = 'infinite'
      else
         text = short_real(x, digits)
      end if
   end function number

   !> Bytes for people.
   pure function bytes(n) result(text)
      integer(lp), intent(in) :: n !< bytes, >= 0
      character(len=:), allocatable :: text
      integer(lp), parameter :: KIB = 1024_lp, MIB = KIB*KIB, GIB = KIB*MIB

      if (n < KIB) then
         text = to_text(n)//' bytes'
      else if (n < MIB) then
         text = to_text(real(n, wp)/real(KIB, wp), 4)//' KiB'
      else if (n < GIB) then
         text = to_text(real(n, wp)/real(MIB, wp), 4)//' MiB'
      else
         text = to_text(real(n, wp)/real(GIB, wp), 4)//' GiB'
      end if
   end function bytes

   !> `1 body`, `2 bodies`.
   pure function plural(n, one, many) result(text)
      integer(ip), intent(in) :: n              !< how many, >= 0
      character(len=*), intent(in) :: one, many !< of one; of several and of none
      character(len=:), allocatable :: text

      text = to_text(n)//' '//many
      if (n == 1_ip) text = '1 '//one
   end function plural

end module atrito_page
