!> Reference of the deck keywords, from the keyword table: pages of 80 columns for the terminal, and docs/user/keywords.md.
module atrito_help
   use atrito_foreign_keywords, only: subject_t, ask_keyword, foreign_keywords, take_subjects, NOT_FOREIGN, FOREIGN_IGNORED, &
                                      FOREIGN_OUTSIDE
   use atrito_introduction_lines, only: take_introduction_lines
   use atrito_keyword, only: keyword_t, option_spec_t, form_t
   use atrito_keyword_table, only: keyword_table, find_keyword, packed, form_text, option_text_of, choices_text, lines_text, &
                                   condition_text, with_dimension, item_meaning, LEVEL_TEXTS
   use atrito_strings, only: break_line, string_t, append_string, upper_case, recoded
   implicit none (type, external)
   private
   public :: help_overview, help_keyword, help_manual

   integer, parameter :: WIDTH = 80
   integer, parameter :: LEFT = 24               !< width of the left column

   !> Where a keyword stands, by LEVEL_*, in the manual.
   character(len=23), parameter :: PLACES(3) = [character(len=23) :: 'In the model', 'In a step', 'In the model or a step']

contains

   !> One line a keyword.
   subroutine help_overview(lines)
      type(string_t), allocatable, intent(out) :: lines(:) !< for the terminal, at most 80 columns
      type(keyword_t), allocatable :: table(:)
      character(len=33), parameter :: TITLES(3) = [character(len=33) :: 'Model, before *STEP', &
                                                                                        'Step, between *STEP and *END STEP', 'Both']
      integer :: i, level

      allocate (lines(0))
      table = keyword_table()
      call append_string(lines, "Keywords of a deck; + is atrito's own. More: atrito help KEYWORD")
      do level = 1, size(TITLES)                       ! LEVEL_*
         call append_block(lines, trim(TITLES(level)))
         do i = 1, size(table)
            if (table(i)%level == level) call append_entry(lines, title_of(table(i)), table(i)%summary)
         end do
      end do
      call append_block(lines, 'Of other programs, without effect, a note')
      call append_wrapped(lines, '  ', foreign_names(table, FOREIGN_IGNORED))
      call append_block(lines, 'Of other programs, outside of atrito; atrito help KEYWORD says what instead')
      call append_wrapped(lines, '  ', foreign_names(table, FOREIGN_OUTSIDE))
   end subroutine help_overview

   !> The page of a keyword; found: .false. when there is none of this name, blanks and case apart.
   subroutine help_keyword(name, lines, found)
      character(len=*), intent(in) :: name                 !< with or without the asterisk
      type(string_t), allocatable, intent(out) :: lines(:) !< for the terminal, at most 80 columns; none where not found
      logical, intent(out) :: found                        !< a keyword, or one of other programs
      type(keyword_t), allocatable :: table(:)
      integer :: i, first
      character(len=:), allocatable :: title, place

      allocate (lines(0))
      table = keyword_table()
      first = merge(2, 1, index(name, '*') == 1)
      i = find_keyword(table, name(first:))
      found = i > 0
      if (found) then
         title = title_of(table(i))
         place = trim(LEVEL_TEXTS(table(i)%level))
         if (len(table(i)%parent) > 0) place = 'behind *'//table(i)%parent
         call append_string(lines, title//repeat(' ', max(2, WIDTH - len(title) - len(place)))//place)
         call append_wrapped(lines, '  ', table(i)%summary)
         call append_keyword(lines, table(i), .false.)
      else
         call append_foreign(lines, packed(name(first:)), found)
      end if
   end subroutine help_keyword

   !> The manual page in Markdown.
   subroutine help_manual(lines)
      type(string_t), allocatable, intent(out) :: lines(:) !< of Markdown
      type(keyword_t), allocatable :: table(:)
      integer :: i
      character(len=:), allocatable :: text

      call take_introduction_lines(lines)
      table = keyword_table()
      do i = 1, size(table)
         call append_block(lines, '## '//escaped(title_of(table(i))))
         text = upper_case(table(i)%summary(:1))//table(i)%summary(2:)//'. '//trim(PLACES(table(i)%level))
         if (len(table(i)%parent) > 0) text = text//', behind *'//table(i)%parent
         call append_block(lines, escaped(text)//'.')
         call append_keyword(lines, table(i), .true.)
      end do
      call append_all_foreign(lines, table)
   end subroutine help_manual

   !> What is known of a keyword of other programs.
   subroutine append_foreign(lines, word, found)
      type(string_t), allocatable, intent(inout) :: lines(:)
      character(len=*), intent(in) :: word
      logical, intent(out) :: found
      type(subject_t), allocatable :: subjects(:)
      integer :: verdict, subject

      call ask_keyword(word, verdict, subject)
      found = verdict /= NOT_FOREIGN
      if (verdict == FOREIGN_IGNORED) then
         call append_string(lines, '*'//word//', of other programs, has no effect; a note says so.')
      else if (verdict == FOREIGN_OUTSIDE) then
         call take_subjects(subjects)
         call append_wrapped(lines, '', '*'//word//', of other programs, is outside of atrito: '//subjects(subject)%what//'.')
         call append_wrapped(lines, '', 'Instead: '//subjects(subject)%instead//'.')
      end if
   end subroutine append_foreign

   !> What stands below the title, for the terminal or in Markdown.
   subroutine append_keyword(lines, keyword, markdown)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), intent(in) :: keyword
      logical, intent(in) :: markdown
      integer :: i

      if (len(keyword%doc) > 0) then
         call append_string(lines, '')
         if (markdown) call append_string(lines, escaped(keyword%doc))
         if (.not. markdown) call append_wrapped(lines, '  ', keyword%doc)
      end if
      if (size(keyword%options) > 0) call append_block(lines, trim(merge('Options:', 'Options ', markdown)))
      if (size(keyword%options) > 0 .and. markdown) call append_string(lines, '')
      do i = 1, size(keyword%options)
         call append_option(keyword%options(i))
      end do
      do i = 1, size(keyword%forms)
         call append_form(keyword%forms(i))
      end do
      if (size(keyword%example) == 0) return
      call append_block(lines, trim(merge('```    ', 'Example', markdown)))
      do i = 1, size(keyword%example)
         call append_string(lines, repeat(' ', merge(0, 2, markdown))//keyword%example(i)%s)
      end do
      if (markdown) call append_string(lines, '```')

   contains

      subroutine append_option(option)
         type(option_spec_t), intent(in) :: option
         character(len=:), allocatable :: text

         text = with_dimension(option%doc, option%dimension)
         if (size(option%choices) > 0) text = text//': '//choices_text(option%choices)
         if (len(option%default) > 0) text = text//'; default '//option%default
         if (len(option%needs) > 0) text = text//'; goes with '//option%needs
         if (option%required) text = text//' (required)'
         if (.not. option%built) text = text//' (not built yet)'
         if (option%harmless) text = text//trim(merge(' (ignored)          ', ' (no effect, a note)', markdown))
         if (markdown) then
            call append_string(lines, '- `'//option_text_of(option)//'`: '//escaped(text))
         else
            call append_entry(lines, option_text_of(option), text)
         end if
      end subroutine append_option

      subroutine append_form(form)
         type(form_t), intent(in) :: form
         character(len=:), allocatable :: title
         integer :: i

         title = 'Data lines'
         if (len(form%option) > 0) title = title//' '//condition_text(form)
         title = title//': '//form%doc//' ('//lines_text(form)//')'
         call append_string(lines, '')
         if (markdown) then
            if (form%harmless) title = title//' (no effect)'
            call append_string(lines, escaped(title)//':')
            call append_string(lines, '`'//form_text(form, names_only=.true.)//'`')
            call append_string(lines, '')
         else
            if (form%harmless) title = title//', no effect'
            call append_wrapped(lines, '', title)
            call append_wrapped(lines, '  ', form_text(form))
         end if
         do i = 1, size(form%items)
            if (markdown) then
               call append_string(lines, '- '//escaped(form%items(i)%name//': '//item_meaning(form%items(i))))
            else
               call append_entry(lines, form%items(i)%name, item_meaning(form%items(i)))
            end if
         end do
      end subroutine append_form
   end subroutine append_keyword

   !> All keywords of other programs, a section of the manual.
   subroutine append_all_foreign(lines, table)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), intent(in) :: table(:)
      type(subject_t), allocatable :: subjects(:)
      character(len=:), allocatable :: names
      integer :: i

      call append_block(lines, '## Keywords of other programs')
      call append_block(lines, 'These have no effect on a linear static run, and a note says so once:')
      call append_string(lines, escaped(foreign_names(table, FOREIGN_IGNORED))//'.')
      call append_block(lines, 'These are outside of atrito, and an error says so by name:')
      call append_block(lines, '| what | keywords | instead |')
      call append_string(lines, '|---|---|---|')
      call take_subjects(subjects)
      do i = 1, size(subjects)
         names = foreign_names(table, FOREIGN_OUTSIDE, subjects(i)%key)
         if (len(names) > 0) then
            call append_string(lines, '| '//escaped(subjects(i)%what)//' | '//escaped(names)//' | ' &
                               //escaped(subjects(i)%instead)//' |')
         end if
      end do
   end subroutine append_all_foreign

   !> `*CONDUCTIVITY, *DAMPING`: what is known of other programs and is not in the table.
   function foreign_names(table, verdict, subject) result(names)
      type(keyword_t), intent(in) :: table(:)
      integer, intent(in) :: verdict                !< FOREIGN_IGNORED, FOREIGN_OUTSIDE
      character(len=*), intent(in), optional :: subject !< those of this key alone
      character(len=:), allocatable :: names
      type(string_t), allocatable :: list(:)
      integer :: i

      names = ''
      list = foreign_keywords(verdict, subject)
      do i = 1, size(list)
         if (find_keyword(table, list(i)%s) > 0) cycle
         if (len(names) > 0) names = names//', '
         names = names//'*'//list(i)%s
      end do
   end function foreign_names

   pure function title_of(keyword) result(title)
      type(keyword_t), intent(in) :: keyword
      character(len=:), allocatable :: title

      title = '*'//keyword%name
      if (keyword%own) title = title//' +'
   end function title_of

   !> An empty line and a line.
   subroutine append_block(lines, line)
      type(string_t), allocatable, intent(inout) :: lines(:)
      character(len=*), intent(in) :: line

      call append_string(lines, '')
      call append_string(lines, line)
   end subroutine append_block

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
      integer :: first, last, next

      first = 1
      do while (first <= len_trim(text))
         call break_line(trim(text), WIDTH - len(margin), first, last, next)
         call append_string(lines, margin//text(first:last))
         first = next
      end do
   end subroutine append_wrapped

   !> Characters that Markdown would take for its own.
   pure function escaped(text) result(safe)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: safe

      safe = recoded(text, '*<>|_', ['\*', '\<', '\>', '\|', '\_'])
   end function escaped

end module atrito_help
