!> The one table of all keywords that the program knows; and how keywords, options and data lines are written: for messages,
!> `atrito help` and the manual.
module atrito_keyword_table
   use atrito_keyword, only: keyword_t, choice_t, option_spec_t, form_t, item_t, ANY_NUMBER
   use atrito_keyword_lines, only: take_keyword_lines
   use atrito_keyword_reader, only: define_keyword, read_heads, read_keywords
   use atrito_strings, only: string_t, append_string, upper_case, to_text
   implicit none (type, external)
   private
   public :: keyword_table, take_table, define_keyword, find_keyword, find_option_spec, find_choice, keyword_names, option_names, &
             choice_names, packed, form_text, item_text, option_text_of, choices_text, lines_text, condition_text, with_dimension, &
             item_meaning, LEVEL_TEXTS

   !> Where a keyword may stand, by LEVEL_*.
   character(len=34), parameter :: LEVEL_TEXTS(3) = [character(len=34) :: 'model, before *STEP', &
                                                                               'step, between *STEP and *END STEP', 'model or step']
   !> By KIND_*: what stands behind the name of an option, and what a value is.
   character(len=15), parameter :: VALUES(11) = [character(len=15) :: '', '=name', '=word', '[=word]', '=real', '=integer', &
                                                                                '=file', '', '=number or name', '', '=real or name']
   character(len=20), parameter :: WORDS(11) = [character(len=20) :: 'no value', 'a name', 'a word', 'a word', 'a real', &
                                           'an integer', 'a file', 'an integer', 'an integer or a name', 'text', 'a real or a name']

contains

   !> The table, in the order of the manual.
   function keyword_table() result(table)
      type(keyword_t), allocatable :: table(:)
      type(string_t), allocatable :: lines(:)
      character(len=:), allocatable :: wrong       ! a unit test asks for it

      call take_keyword_lines(lines)
      call read_keywords(lines, table, wrong)
   end function keyword_table

   !> Its lines, and the keywords by their heads alone.
   subroutine take_table(lines, table)
      type(string_t), allocatable, intent(out) :: lines(:)  !< for define_keyword
      type(keyword_t), allocatable, intent(out) :: table(:) !< in the order of the manual
      character(len=:), allocatable :: wrong

      call take_keyword_lines(lines)
      call read_heads(lines, table, wrong)
   end subroutine take_table

   !> A keyword without its blanks and in capitals: they do not matter (`*ENDSTEP`).
   pure function packed(name) result(word)
      character(len=*), intent(in) :: name !< in any case, with any blanks
      character(len=:), allocatable :: word
      character(len=len(name)) :: capitals
      integer :: i, n

      capitals = upper_case(name)
      n = 0
      do i = 1, len(name)
         if (capitals(i:i) == ' ' .or. capitals(i:i) == achar(9)) cycle
         n = n + 1
         capitals(n:n) = capitals(i:i)
      end do
      word = capitals(:n)
   end function packed

   !> Whether a name of the tables is a word that is packed; quick, without a copy of the name: most differ in the first letters.
   pure logical function is_packed_as(name, word)
      character(len=*), intent(in) :: name, word
      integer :: i, n

      is_packed_as = .false.
      n = 0
      do i = 1, len(name)
         if (name(i:i) == ' ' .or. name(i:i) == achar(9)) cycle
         n = n + 1
         if (n > len(word)) return
         if (name(i:i) == word(n:n)) cycle
         if (upper_case(name(i:i)) /= word(n:n)) return
      end do
      is_packed_as = n == len(word)
   end function is_packed_as

   !> Index of a keyword, 0 when it is unknown.
   pure integer function find_keyword(table, name) result(i)
      type(keyword_t), intent(in) :: table(:) !< the keyword table
      character(len=*), intent(in) :: name    !< in any case, with any blanks
      character(len=:), allocatable :: word

      word = packed(name)
      i = 0
      if (len(word) == 0) return
      do i = size(table), 1, -1
         if (is_packed_as(table(i)%name, word)) return
      end do
   end function find_keyword

   !> Index of an option of a keyword, 0 when it is unknown.
   pure integer function find_option_spec(keyword, name) result(i)
      type(keyword_t), intent(in) :: keyword !< defined
      character(len=*), intent(in) :: name   !< in any case, with any blanks
      character(len=:), allocatable :: word

      word = packed(name)
      do i = size(keyword%options), 1, -1
         if (is_packed_as(keyword%options(i)%name, word)) return
      end do
   end function find_option_spec

   !> Index of a word among choices, 0 when it is none of them.
   pure integer function find_choice(choices, word) result(i)
      type(choice_t), intent(in) :: choices(:) !< of an option or an item
      character(len=*), intent(in) :: word     !< in any case, with any blanks
      character(len=:), allocatable :: wanted

      wanted = packed(word)
      do i = size(choices), 1, -1
         if (is_packed_as(choices(i)%name, wanted)) return
      end do
   end function find_choice

   !> The names of all keywords, for the nearest names in messages.
   pure function keyword_names(table) result(names)
      type(keyword_t), intent(in) :: table(:) !< the keyword table
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(size(table)))
      do i = 1, size(table)
         names(i)%s = table(i)%name
      end do
   end function keyword_names

   !> The names of the options of a keyword that have an effect, for messages.
   pure function option_names(options) result(names)
      type(option_spec_t), intent(in) :: options(:) !< of one keyword, defined
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(options)
         if (.not. options(i)%harmless) call append_string(names, options(i)%name)
      end do
   end function option_names

   !> The words that an option may have in this version, for messages.
   pure function choice_names(choices) result(names)
      type(choice_t), intent(in) :: choices(:) !< of an option or an item
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(choices)
         if (choices(i)%built) call append_string(names, choices(i)%name)
      end do
   end function choice_names

   !> The items of a data line: `id, x [L], y [L]`; without dimensions and what may be left out: `id, x, y`.
   pure function form_text(form, names_only) result(text)
      type(form_t), intent(in) :: form            !< of a data line
      logical, intent(in), optional :: names_only !< without dimensions; left out: with them
      character(len=:), allocatable :: text
      logical :: short
      integer :: i

      short = .false.
      if (present(names_only)) short = names_only
      text = form%word
      do i = 1, size(form%items)
         if (form%items(i)%harmless) cycle
         if (len(text) > 0) text = text//', '
         if (short) then
            text = text//form%items(i)%name
            cycle
         end if
         text = text//with_dimension(form%items(i)%name, form%items(i)%dimension)
         if (.not. form%items(i)%required) text = text//' (may be left out)'
      end do
      if (form%max_items == ANY_NUMBER .and. size(form%items) > 0) then
         if (.not. form%items(size(form%items))%harmless) text = text//', ...'
      end if
   end function form_text

   !> What an item is: `x: coordinate, a real [L]`.
   pure function item_text(item) result(text)
      type(item_t), intent(in) :: item !< of a data line
      character(len=:), allocatable :: text

      text = item%name//': '//item%doc//', '//with_dimension(trim(WORDS(item%kind)), item%dimension)
   end function item_text

   !> The meaning of an item for the reference: kind, dimension, choices, default.
   pure function item_meaning(item) result(text)
      type(item_t), intent(in) :: item !< of a data line
      character(len=:), allocatable :: text

      text = item%doc
      if (size(item%choices) > 0) then
         text = text//': '//choices_text(item%choices)
      else if (len(item%dimension) > 0) then            ! that is a real
         text = with_dimension(text, item%dimension)
      else
         text = text//'; '//trim(WORDS(item%kind))
      end if
      if (len(item%default) > 0) text = text//'; default '//item%default
      if (.not. item%required .and. len(item%default) == 0 .and. .not. item%harmless) text = text//'; optional'
      if (item%harmless) text = text//'; no effect'
   end function item_meaning

   !> How an option is written: `NAME=name`.
   pure function option_text_of(option) result(text)
      type(option_spec_t), intent(in) :: option !< of a keyword
      character(len=:), allocatable :: text

      text = option%name//trim(VALUES(option%kind))
      if (option%own) text = text//' +'
   end function option_text_of

   !> The words that can be chosen, those not built marked.
   pure function choices_text(choices) result(text)
      type(choice_t), intent(in) :: choices(:) !< of an option or an item
      character(len=:), allocatable :: text
      integer :: i

      text = ''
      do i = 1, size(choices)
         if (i > 1) text = text//', '
         text = text//choices(i)%name
         if (choices(i)%own) text = text//' +'
         if (.not. choices(i)%built) text = text//' (not built yet)'
      end do
   end function choices_text

   !> How many lines of a form there may be.
   pure function lines_text(form) result(text)
      type(form_t), intent(in) :: form !< of a data line
      character(len=:), allocatable :: text

      associate (least => form%min_lines, most => form%max_lines)
         if (least == most) then
            text = to_text(least)//trim(merge(' line ', ' lines', least == 1))
         else if (most == ANY_NUMBER) then
            text = 'any number of lines'
            if (least > 0) text = to_text(least)//' or more lines'
         else if (most == 1) then
            text = 'at most 1 line'
         else
            text = to_text(least)//trim(merge(' or', ' to', most == least + 1))//' '//to_text(most)//' lines'
         end if
      end associate
      if (form%goes_on) text = text//'; a line with too few items goes on in the next'
   end function lines_text

   !> When a form applies: `with TYPE=ELEMENT`, `without NONLOCAL`; '' when always.
   pure function condition_text(form) result(text)
      type(form_t), intent(in) :: form !< of a data line
      character(len=:), allocatable :: text
      integer :: i

      text = ''
      if (len(form%option) == 0) return
      text = 'with '//form%option
      if (form%absent) text = 'without '//form%option
      do i = 1, size(form%values)
         if (i == 1 .and. .not. form%absent) text = text//'='
         if (i > 1 .or. form%absent) text = text//' or '
         text = text//form%values(i)%s
      end do
   end function condition_text

   !> A text with its dimension behind it: `x [L]`; the text alone where there is none.
   pure function with_dimension(text, dimension) result(both)
      character(len=*), intent(in) :: text, dimension !< name or meaning; in F and L, '': none
      character(len=:), allocatable :: both

      both = text
      if (len(dimension) > 0) both = text//' ['//dimension//']'
   end function with_dimension

end module atrito_keyword_table
