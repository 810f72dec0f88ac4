!> docs/user/keywords.md, from the keyword table.
module atrito_manual
   use atrito_foreign_keywords, only: IGNORED_KEYWORDS, OUTSIDE_KEYWORDS, SUBJECTS, FOREIGN_IGNORED, FOREIGN_OUTSIDE
   use atrito_keyword, only: keyword_t, option_spec_t, form_t
   use atrito_keyword_table, only: keyword_table, find_keyword
   use atrito_keyword_text, only: form_text, option_text_of, choices_text, lines_text, condition_text, level_text, item_meaning
   use atrito_strings, only: string_t, append_string
   implicit none (type, external)
   private
   public :: help_manual, foreign_names

   character(len=96), parameter :: INTRODUCTION(14) = [character(len=96) :: &
                                                       '# Keywords of a deck', &
                                                       '', &
                                 'This page is printed by `atrito help all > docs/user/keywords.md` from the table that the deck', &
                                                       'reader uses; do not edit it. `atrito help KEYWORD` prints one section.', &
                                                       '', &
                                 'A + marks what is atrito''s own; the rest is read by Abaqus or CalculiX too. Dimensions are in', &
                                                     'force F, length L and time T; the units are yours, if they are consistent.', &
                                                       '', &
                                    'A deck is made of lines `*KEYWORD, OPTION=value`, each with its data lines of items between', &
                                    'commas. `**` begins a comment. A comma at the end of a keyword line continues it. Names are', &
                                 'without case and have at most 80 characters; "quotes" may stand round them; all digits means a', &
                                 'number. A real may be written as an integer, an integer not as a real. An empty item takes its', &
                                                       'default.', &
                                                       '']

contains

   !> The manual page in Markdown.
   subroutine help_manual(lines)
      type(string_t), allocatable, intent(out) :: lines(:)
      type(keyword_t), allocatable :: table(:)
      integer :: i

      allocate (lines(0))
      table = keyword_table()
      do i = 1, size(INTRODUCTION)
         call append_string(lines, trim(INTRODUCTION(i)))
      end do
      call append_overview(lines, table)
      do i = 1, size(table)
         call append_section(lines, table(i))
      end do
      call append_foreign(lines, table)
   end subroutine help_manual

   subroutine append_overview(lines, table)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), intent(in) :: table(:)
      integer :: i

      call append_string(lines, '| keyword | where | what |')
      call append_string(lines, '|---|---|---|')
      do i = 1, size(table)
         call append_string(lines, '| '//escaped(title_of(table(i)))//' | '//escaped(level_text(table(i)%level))//' | '// &
                            escaped(table(i)%summary)//' |')
      end do
   end subroutine append_overview

   subroutine append_section(lines, keyword)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), intent(in) :: keyword
      character(len=:), allocatable :: text
      integer :: i

      call append_string(lines, '')
      call append_string(lines, '## '//escaped(title_of(keyword)))
      call append_string(lines, '')
      text = capitalised(escaped(keyword%summary))//'. Place: '//escaped(level_text(keyword%level))
      if (len(keyword%parent) > 0) text = text//', behind '//escaped('*'//keyword%parent)
      call append_string(lines, text//'.')
      if (len(keyword%doc) > 0) then
         call append_string(lines, '')
         call append_string(lines, escaped(keyword%doc))
      end if
      call append_options(lines, keyword%options)
      do i = 1, size(keyword%forms)
         call append_form(lines, keyword%forms(i))
      end do
      call append_example(lines, keyword%example)
   end subroutine append_section

   subroutine append_options(lines, options)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(option_spec_t), intent(in) :: options(:)
      character(len=:), allocatable :: text
      integer :: i

      if (size(options) == 0) return
      call append_string(lines, '')
      call append_string(lines, '| option | meaning | default |')
      call append_string(lines, '|---|---|---|')
      do i = 1, size(options)
         text = options(i)%doc
         if (len(options(i)%dimension) > 0) text = text//' ['//options(i)%dimension//']'
         if (size(options(i)%choices) > 0) text = text//': '//choices_text(options(i)%choices)
         if (len(options(i)%needs) > 0) text = text//'; goes with '//options(i)%needs
         if (.not. options(i)%built) text = text//' (not built yet)'
         if (options(i)%harmless) text = text//' (no effect, a note)'
         call append_string(lines, '| '//escaped(option_text_of(options(i)))//' | '//escaped(text)//' | '// &
                            default_of(options(i))//' |')
      end do
   end subroutine append_options

   pure function default_of(option) result(text)
      type(option_spec_t), intent(in) :: option
      character(len=:), allocatable :: text

      text = option%default
      if (option%required) text = 'required'
   end function default_of

   subroutine append_form(lines, form)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(form_t), intent(in) :: form
      character(len=:), allocatable :: text
      integer :: i

      text = 'Data lines'
      if (len(form%option) > 0) text = text//' '//condition_text(form)
      text = text//': '//form%doc//' ('//lines_text(form)//')'
      if (form%harmless) text = text//' (no effect)'
      call append_string(lines, '')
      call append_string(lines, escaped(text)//':')
      call append_string(lines, '`'//form_text(form)//'`')
      call append_string(lines, '')
      do i = 1, size(form%items)
         call append_string(lines, '- '//escaped(form%items(i)%name//': '//item_meaning(form%items(i))))
      end do
   end subroutine append_form

   subroutine append_example(lines, example)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(string_t), intent(in) :: example(:)
      integer :: i

      if (size(example) == 0) return
      call append_string(lines, '')
      call append_string(lines, '```')
      do i = 1, size(example)
         call append_string(lines, example(i)%s)
      end do
      call append_string(lines, '```')
   end subroutine append_example

   subroutine append_foreign(lines, table)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), intent(in) :: table(:)
      character(len=:), allocatable :: names
      integer :: i

      call append_string(lines, '')
      call append_string(lines, '## Keywords of other programs')
      call append_string(lines, '')
      call append_string(lines, 'These have no effect on a linear static run, and a note says so once:')
      call append_string(lines, escaped(foreign_names(table, FOREIGN_IGNORED))//'.')
      call append_string(lines, '')
      call append_string(lines, 'These are outside of atrito, and an error says so by name:')
      call append_string(lines, '')
      call append_string(lines, '| what | keywords | instead |')
      call append_string(lines, '|---|---|---|')
      do i = 1, size(SUBJECTS)
         names = foreign_names(table, FOREIGN_OUTSIDE, i)
         if (len(names) > 0) call append_string(lines, '| '//escaped(trim(SUBJECTS(i)%what))//' | '//escaped(names)//' | '// &
                                                escaped(trim(SUBJECTS(i)%instead))//' |')
      end do
   end subroutine append_foreign

   !> `*CONDUCTIVITY, *DAMPING`: what is known of other programs and is not in the table.
   function foreign_names(table, verdict, subject) result(names)
      type(keyword_t), intent(in) :: table(:)
      integer, intent(in) :: verdict                !< FOREIGN_IGNORED, FOREIGN_OUTSIDE
      integer, intent(in), optional :: subject      !< these alone; place in SUBJECTS
      character(len=:), allocatable :: names
      integer :: i

      names = ''
      if (verdict == FOREIGN_IGNORED) then
         do i = 1, size(IGNORED_KEYWORDS)
            call add_name(IGNORED_KEYWORDS(i))
         end do
         return
      end if
      do i = 1, size(OUTSIDE_KEYWORDS)
         if (present(subject)) then
            if (OUTSIDE_KEYWORDS(i)%subject /= subject) cycle
         end if
         call add_name(OUTSIDE_KEYWORDS(i)%name)
      end do
   contains
      subroutine add_name(name)
         character(len=*), intent(in) :: name

         if (find_keyword(table, name) > 0) return
         if (len(names) > 0) names = names//', '
         names = names//'*'//trim(name)
      end subroutine add_name
   end function foreign_names

   pure function title_of(keyword) result(title)
      type(keyword_t), intent(in) :: keyword
      character(len=:), allocatable :: title

      title = '*'//keyword%name
      if (keyword%own) title = title//' +'
   end function title_of

   pure function capitalised(text) result(capital)
      character(len=*), intent(in) :: text
      character(len=len(text)) :: capital

      capital = text
      if (text(1:1) >= 'a' .and. text(1:1) <= 'z') capital(1:1) = achar(iachar(text(1:1)) - 32)
   end function capitalised

   !> Characters that Markdown would take for its own.
   pure function escaped(text) result(safe)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: safe
      integer :: i

      safe = ''
      do i = 1, len(text)
         if (scan(text(i:i), '*<>|_') > 0) safe = safe//'\'
         safe = safe//text(i:i)
      end do
   end function escaped

end module atrito_manual
