!> Reference of the deck keywords for the terminal, 80 columns, from the keyword table.
module atrito_help
   use atrito_foreign_keywords, only: ask_keyword, SUBJECTS, NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE
   use atrito_keyword, only: keyword_t, option_spec_t, form_t
   use atrito_keyword_table, only: keyword_table, find_keyword, packed
   use atrito_keyword_text, only: form_text, option_text_of, choices_text, lines_text, condition_text, level_text, item_meaning
   use atrito_manual, only: help_manual, foreign_names
   use atrito_strings, only: string_t, append_string
   implicit none (type, external)
   private
   public :: help_overview, help_keyword, help_manual

   integer, parameter :: WIDTH = 80
   integer, parameter :: LEFT = 24               !< width of the left column

contains

   !> One line a keyword.
   subroutine help_overview(lines)
      type(string_t), allocatable, intent(out) :: lines(:)
      type(keyword_t), allocatable :: table(:)

      allocate (lines(0))
      table = keyword_table()
      call append_string(lines, "Keywords of a deck; + is atrito's own. More: atrito help KEYWORD")
      call append_group(lines, table, 'Model, before *STEP', [.true., .false., .false.])
      call append_group(lines, table, 'Step, between *STEP and *END STEP', [.false., .true., .false.])
      call append_group(lines, table, 'Both', [.false., .false., .true.])
      call append_string(lines, '')
      call append_string(lines, 'Of other programs, without effect, a note')
      call append_wrapped(lines, '  ', foreign_names(table, FOREIGN_IGNORED))
      call append_string(lines, '')
      call append_string(lines, 'Of other programs, outside of atrito; atrito help KEYWORD says what instead')
      call append_wrapped(lines, '  ', foreign_names(table, FOREIGN_OUTSIDE))
   end subroutine help_overview

   subroutine append_group(lines, table, title, levels)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), intent(in) :: table(:)
      character(len=*), intent(in) :: title
      logical, intent(in) :: levels(:)             !< by LEVEL_*
      character(len=:), allocatable :: name
      integer :: i

      call append_string(lines, '')
      call append_string(lines, title)
      do i = 1, size(table)
         if (.not. levels(table(i)%level)) cycle
         name = '*'//table(i)%name
         if (table(i)%own) name = name//' +'
         call append_entry(lines, name, table(i)%summary)
      end do
   end subroutine append_group

   !> The page of a keyword; found: .false. when there is none of this name, blanks and case apart.
   subroutine help_keyword(name, lines, found)
      character(len=*), intent(in) :: name           !< with or without the asterisk
      type(string_t), allocatable, intent(out) :: lines(:)
      logical, intent(out) :: found
      type(keyword_t), allocatable :: table(:)
      integer :: i, first

      allocate (lines(0))
      table = keyword_table()
      first = merge(2, 1, index(name, '*') == 1)
      i = find_keyword(table, name(first:))
      found = i > 0
      if (found) then
         call append_page(lines, table(i))
      else
         call append_foreign(lines, packed(name(first:)), found)
      end if
   end subroutine help_keyword

   !> What is known of a keyword of other programs.
   subroutine append_foreign(lines, word, found)
      type(string_t), allocatable, intent(inout) :: lines(:)
      character(len=*), intent(in) :: word
      logical, intent(out) :: found
      integer :: verdict, subject

      call ask_keyword(word, verdict, subject)
      found = verdict /= NOT_FOREIGN
      if (verdict == FOREIGN_IGNORED) then
         call append_string(lines, '*'//word//', of other programs, has no effect; a note says so.')
      else if (verdict == FOREIGN_OUTSIDE) then
         call append_wrapped(lines, '', '*'//word//', of other programs, is outside of atrito: '//trim(SUBJECTS(subject)%what)//'.')
         call append_wrapped(lines, '', 'Instead: '//trim(SUBJECTS(subject)%instead)//'.')
      end if
   end subroutine append_foreign

   subroutine append_page(lines, keyword)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), intent(in) :: keyword
      integer :: i

      call append_string(lines, title_line(keyword))
      call append_wrapped(lines, '  ', keyword%summary)
      if (len(keyword%doc) > 0) then
         call append_string(lines, '')
         call append_wrapped(lines, '  ', keyword%doc)
      end if
      if (size(keyword%options) > 0) then
         call append_string(lines, '')
         call append_string(lines, 'Options')
      end if
      do i = 1, size(keyword%options)
         call append_option(lines, keyword%options(i))
      end do
      do i = 1, size(keyword%forms)
         call append_form(lines, keyword%forms(i))
      end do
      if (size(keyword%example) == 0) return
      call append_string(lines, '')
      call append_string(lines, 'Example')
      do i = 1, size(keyword%example)
         call append_string(lines, '  '//keyword%example(i)%s)
      end do
   end subroutine append_page

   !> The keyword on the left, its place on the right.
   pure function title_line(keyword) result(line)
      type(keyword_t), intent(in) :: keyword
      character(len=:), allocatable :: line, place

      line = '*'//keyword%name
      if (keyword%own) line = line//" +"
      place = level_text(keyword%level)
      if (len(keyword%parent) > 0) place = 'behind *'//keyword%parent
      line = line//repeat(' ', max(2, WIDTH - len(line) - len(place)))//place
   end function title_line

   subroutine append_option(lines, option)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(option_spec_t), intent(in) :: option
      character(len=:), allocatable :: text

      text = option%doc
      if (len(option%dimension) > 0) text = text//' ['//option%dimension//']'
      if (size(option%choices) > 0) text = text//': '//choices_text(option%choices)
      if (len(option%default) > 0) text = text//'; default '//option%default
      if (len(option%needs) > 0) text = text//'; goes with '//option%needs
      if (option%required) text = text//' (required)'
      if (.not. option%built) text = text//' (not built yet)'
      if (option%harmless) text = text//' (no effect, a note)'
      call append_entry(lines, option_text_of(option), text)
   end subroutine append_option

   subroutine append_form(lines, form)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(form_t), intent(in) :: form
      character(len=:), allocatable :: title
      integer :: i

      title = 'Data lines'
      if (len(form%option) > 0) title = title//' '//condition_text(form)
      title = title//': '//form%doc//' ('//lines_text(form)//')'
      if (form%harmless) title = title//', no effect'
      call append_string(lines, '')
      call append_wrapped(lines, '', title)
      call append_wrapped(lines, '  ', form_text(form))
      do i = 1, size(form%items)
         call append_entry(lines, form%items(i)%name, item_meaning(form%items(i)))
      end do
   end subroutine append_form

   !> Two columns: a name, and its meaning wrapped beside it.
   subroutine append_entry(lines, name, text)
      type(string_t), allocatable, intent(inout) :: lines(:)
      character(len=*), intent(in) :: name, text
      integer :: first

      first = size(lines) + 1
      call append_wrapped(lines, repeat(' ', LEFT), text)
      if (len(name) + 4 <= LEFT) then
         lines(first)%s(3:2 + len(name)) = name
      else
         call append_string(lines, '')
         lines(first + 1:) = lines(first:size(lines) - 1)
         lines(first)%s = '  '//name
      end if
   end subroutine append_entry

   !> Appends a text broken at blanks, each line behind a margin.
   subroutine append_wrapped(lines, margin, text)
      type(string_t), allocatable, intent(inout) :: lines(:)
      character(len=*), intent(in) :: margin, text
      integer :: first, last, room

      room = WIDTH - len(margin)
      first = 1
      do while (first <= len(text))
         last = len(text)
         if (last - first + 1 > room) last = first - 1 + index(text(first:first + room), ' ', back=.true.)
         if (last < first) last = min(len(text), first + room - 1)       ! a word longer than the line
         call append_string(lines, margin//trim(text(first:last)))
         first = last + 1
      end do
   end subroutine append_wrapped

end module atrito_help
