!> Reads the definitions of keywords. Each line begins with a word that says what it is; a line that begins with a blank goes on
!> with the one before (tools/text-lines).
!>
!>     *NAME | LEVEL | what it does              LEVEL: model, step, both; `model *MATERIAL`: it belongs behind that keyword
!>     doc SENTENCES
!>     option NAME | VALUE | meaning
!>     lines COUNT | meaning                     a form of data line, COUNT of them: 1, 0-4, 1- (one or more)
!>     lines COUNT, with OPTION | meaning        that applies with an option; also `with OPTION=A or B`, `without OPTION`,
!>                                               `without A or B`, `word WORD` (with which the lines begin), `no effect`,
!>                                               `going on` (goes_on)
!>     item NAME, NAME | VALUE | meaning         its items
!>     > LINE                                    of the example
!>     define GROUP                              names the lines up to the next keyword or `define`, of which
!>     use GROUP                                 takes a copy
!>     element lines                             the forms of all elements; `<elements>` among words is their names
!>
!> VALUE is `KIND WORDS [DIMENSION], with OPTION = DEFAULT`, all but the kind (KIND_NAMES) only where there is such a thing; `_` in
!> a word stands for a blank. Marks of names: `NAME+` is atrito's own, `-NAME` is not built yet, `NAME!` must be given, `[name]` may
!> be left out, `(name)` is of another solver and has no effect, `name...` may be repeated.
module atrito_keyword_reader
   use atrito_element_table, only: SHAPES, KINDS, MOST_NODES
   use atrito_keyword, only: keyword_t, option_spec_t, choice_t, form_t, item_t, LEVEL_NAMES, KIND_NAMES, ANY_NUMBER, NO_EFFECT
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, string_list_t, add_string, take_strings, append_string, to_text
   implicit none (type, external)
   private
   public :: read_keywords, read_heads, define_keyword

   character(len=*), parameter :: ELEMENTS = '<elements>'

contains

   !> The keywords that some lines define, in their order.
   pure subroutine read_keywords(lines, table, wrong)
      type(string_t), intent(in) :: lines(:)                    !< those that go on joined
      type(keyword_t), allocatable, intent(out) :: table(:)     !< in the order of the lines, all defined
      character(len=:), allocatable, intent(out) :: wrong       !< the last line that cannot be read; not allocated: there is none
      integer :: i

      call read_heads(lines, table, wrong)
      do i = 1, size(table)
         call define_keyword(lines, table(i), wrong)
      end do
   end subroutine read_keywords

   !> The same by their heads alone.
   pure subroutine read_heads(lines, table, wrong)
      type(string_t), intent(in) :: lines(:)                    !< those that go on joined
      type(keyword_t), allocatable, intent(out) :: table(:)     !< in the order of the lines; heads alone
      character(len=:), allocatable, intent(out) :: wrong       !< the last line that cannot be read; not allocated: there is none
      integer :: i, n
      character(len=:), allocatable :: name, level

      n = 0
      do i = 1, size(lines)
         if (lines(i)%s(1:1) == '*') n = n + 1
      end do
      allocate (table(n))
      n = 0
      do i = 1, size(lines)
         if (lines(i)%s(1:1) /= '*') cycle
         n = n + 1
         table(n)%line = i
         ! `*NAME | LEVEL | summary`.
         associate (line => lines(i)%s, keyword => table(n))
            name = line(2:)
            call cut_off(name, ' | ', level)
            call cut_off(level, ' | ', keyword%summary)
            call cut_off(level, ' *', keyword%parent)
            keyword%name = bare(name)
            keyword%own = has_mark(name, '+')
            keyword%doc = ''
            keyword%level = place_of(level, LEVEL_NAMES)
            if (keyword%level == 0 .or. len(keyword%summary) == 0) wrong = line
         end associate
      end do
   end subroutine read_heads

   !> Reads what stands behind the head of a keyword, unless it has been read: a deck has a few of a hundred keywords.
   pure subroutine define_keyword(lines, keyword, wrong)
      type(string_t), intent(in) :: lines(:)                          !< as of read_heads
      type(keyword_t), intent(inout) :: keyword                       !< of read_heads; gets options, forms and example
      character(len=:), allocatable, intent(inout), optional :: wrong !< as of read_heads
      character(len=:), allocatable :: fault
      type(string_list_t) :: unfolded
      type(string_t), allocatable :: parts(:)
      integer :: i

      if (allocated(keyword%options)) return
      do i = keyword%line + 1, size(lines)
         if (begins(lines(i)%s, 'define ') .or. begins(lines(i)%s, '*')) exit
         call unfold(lines, lines(i)%s, unfolded)
      end do
      call take_strings(unfolded, parts)
      call read_definition(parts, keyword, fault)
      if (present(wrong) .and. allocated(fault)) wrong = fault
   end subroutine define_keyword

   !> Adds a line, or those of the group or the elements that it stands for.
   pure recursive subroutine unfold(lines, line, unfolded)
      type(string_t), intent(in) :: lines(:)
      character(len=*), intent(in) :: line
      type(string_list_t), intent(inout) :: unfolded
      integer :: first, i

      if (line == 'element lines') then
         do i = 1, MOST_NODES
            if (SHAPES(i)%n_nodes > 0) call add_element_lines(int(i, ip), unfolded)
         end do
         return
      else if (.not. begins(line, 'use ')) then
         call add_string(unfolded, line)
         return
      end if
      do first = 1, size(lines)
         if (.not. begins(lines(first)%s, 'define ')) cycle
         if (lines(first)%s(8:) == line(5:)) exit
      end do
      if (first > size(lines)) call add_string(unfolded, line)      ! there is no such group: a line that is wrong
      do i = first + 1, size(lines)
         if (begins(lines(i)%s, 'define ') .or. begins(lines(i)%s, '*')) return
         call unfold(lines, lines(i)%s, unfolded)
      end do
   end subroutine unfold

   pure logical function begins(text, word)
      character(len=*), intent(in) :: text, word

      begins = text(1:1) == word(1:1)                 ! no line is empty
      if (begins) begins = text(:min(len(text), len(word))) == word
   end function begins

   !> The data lines of the elements of one shape.
   pure subroutine add_element_lines(shape, lines)
      integer(ip), intent(in) :: shape                 !< place in SHAPES
      type(string_list_t), intent(inout) :: lines
      character(len=:), allocatable :: names
      integer(ip) :: i

      names = ''
      do i = 1, size(KINDS, kind=ip)
         if (KINDS(i)%shape /= shape) cycle
         names = names//' or '//trim(KINDS(i)%name)
         if (KINDS(i)%name(:3) == 'CPS') names = names//' or M3D'//trim(KINDS(i)%name(4:))
      end do
      call add_string(lines, 'lines 1-, with TYPE='//names(5:)//', going on | one element a line')
      call add_string(lines, 'item id | id | number of the element, positive')
      do i = 1, shape
         call add_string(lines, 'item node '//to_text(i)//' | id | '//merge('corner  ', 'mid-side', i <= SHAPES(shape)%n_corners))
      end do
   end subroutine add_element_lines

   !> The names of all elements, a + behind those that Abaqus has not.
   pure function element_types() result(names)
      character(len=:), allocatable :: names
      integer(ip) :: i

      names = trim(KINDS(1)%name)
      do i = 2, size(KINDS, kind=ip)
         names = names//' '//trim(KINDS(i)%name)//trim(merge('+', ' ', KINDS(i)%own))
      end do
   end function element_types

   pure subroutine read_definition(lines, keyword, wrong)
      type(string_t), intent(in) :: lines(:)           !< behind its head
      type(keyword_t), intent(inout) :: keyword
      character(len=:), allocatable, intent(inout) :: wrong
      character(len=:), allocatable :: word, rest
      integer :: i, n_options, n_forms

      n_options = count([(begins(lines(i)%s, 'option '), i=1, size(lines))])
      n_forms = count([(begins(lines(i)%s, 'lines '), i=1, size(lines))])
      allocate (keyword%options(n_options), keyword%forms(n_forms), keyword%example(0))
      n_options = 0
      n_forms = 0
      do i = 1, size(lines)
         word = lines(i)%s
         call cut_off(word, ' ', rest)
         select case (word)
         case ('doc')
            if (len(keyword%doc) > 0) keyword%doc = keyword%doc//' '
            keyword%doc = keyword%doc//rest
         case ('option')
            n_options = n_options + 1
            call read_option(rest, keyword%options(n_options), wrong)
         case ('lines')
            n_forms = n_forms + 1
            call read_form(rest, lines(i + 1:), keyword%forms(n_forms), wrong)
         case ('item')
            if (n_forms == 0) wrong = lines(i)%s
         case ('>')
            call append_string(keyword%example, rest)
         case default
            wrong = lines(i)%s
         end select
      end do
   end subroutine read_definition

   !> `NAME | VALUE | meaning`.
   pure subroutine read_option(text, option, wrong)
      character(len=*), intent(in) :: text
      type(option_spec_t), intent(inout) :: option
      character(len=:), allocatable, intent(inout) :: wrong
      character(len=:), allocatable :: name, value, doc

      name = text
      call cut_off(name, ' | ', value)
      call cut_off(value, ' | ', doc)
      call read_value(name, value, doc, option%item_t, option%needs, wrong)
      option%required = has_mark(name, '!')
      option%own = has_mark(name, '+')
      option%built = .not. has_mark(name, '-')
   end subroutine read_option

   !> What options and items have in common.
   pure subroutine read_value(name, text, doc, item, needs, wrong)
      character(len=*), intent(in) :: name, text, doc
      type(item_t), intent(inout) :: item
      character(len=:), allocatable, intent(out) :: needs
      character(len=:), allocatable, intent(inout) :: wrong
      character(len=:), allocatable :: kind, words

      kind = text
      call cut_off(kind, ' = ', item%default)
      call cut_off(kind, ', with ', needs)
      call cut_off(kind, ' [', item%dimension)
      if (len(item%dimension) > 0) item%dimension = item%dimension(:len(item%dimension) - 1)
      call cut_off(kind, ' ', words)
      item%kind = place_of(kind, KIND_NAMES)
      if (item%kind == 0 .or. len(doc) == 0) wrong = name//' | '//text
      item%name = bare(name)
      item%doc = doc
      item%harmless = has_mark(name, '(')
      item%is_unused = doc == NO_EFFECT
      item%required = .not. (len(item%default) > 0 .or. has_mark(name, '[') .or. has_mark(name, '('))
      call read_choices(words, item%choices)
   end subroutine read_value

   pure subroutine read_choices(text, choices)
      character(len=*), intent(in) :: text
      type(choice_t), allocatable, intent(out) :: choices(:)
      type(string_t), allocatable :: words(:)
      integer :: i, k

      if (index(text, ELEMENTS) == 1) then
         call split_text(element_types()//text(len(ELEMENTS) + 1:), ' ', words)
      else
         call split_text(text, ' ', words)
      end if
      allocate (choices(size(words)))
      do i = 1, size(words)
         associate (word => words(i)%s)
            choices(i)%built = .not. has_mark(word, '-')
            choices(i)%own = has_mark(word, '+')
            do k = 1, len(word)
               if (word(k:k) == '_') word(k:k) = ' '
            end do
            choices(i)%name = bare(word)
         end associate
      end do
   end subroutine read_choices

   !> `COUNT, with OPTION, ... | meaning`, and the items behind it.
   pure subroutine read_form(text, lines, form, wrong)
      character(len=*), intent(in) :: text
      type(string_t), intent(in) :: lines(:)           !< behind it, the first of them with its items
      type(form_t), intent(inout) :: form
      character(len=:), allocatable, intent(inout) :: wrong
      character(len=:), allocatable :: what, conditions, values

      what = text
      call cut_off(what, ' | ', form%doc)
      call cut_off(what, ', ', conditions)
      if (scan(what, '0123456789') /= 1 .or. len(form%doc) == 0) wrong = text
      form%min_lines = iachar(what(1:1)) - iachar('0')
      form%max_lines = form%min_lines
      if (len(what) == 2) form%max_lines = ANY_NUMBER
      if (len(what) == 3) form%max_lines = iachar(what(3:3)) - iachar('0')
      form%option = ''
      form%word = ''
      allocate (form%values(0))
      do while (len(conditions) > 0)
         what = conditions
         call cut_off(what, ', ', conditions)
         if (begins(what, 'with ') .or. begins(what, 'without ')) then
            form%absent = begins(what, 'without ')
            form%option = what(index(what, ' ') + 1:)
            call cut_off(form%option, '=', values)
            if (form%absent) call cut_off(form%option, ' or ', values)
            call split_text(values, ' or ', form%values)
         else if (begins(what, 'word ')) then
            form%word = what(6:)
         else if (what == 'no effect') then
            form%harmless = .true.
         else if (what == 'going on') then
            form%goes_on = .true.
         else
            wrong = text
         end if
      end do
      call read_items(lines, form, wrong)
   end subroutine read_form

   !> `item NAME, NAME | VALUE | meaning`: the items of a form.
   pure subroutine read_items(lines, form, wrong)
      type(string_t), intent(in) :: lines(:)           !< up to the first that is no item
      type(form_t), intent(inout) :: form
      character(len=:), allocatable, intent(inout) :: wrong
      character(len=:), allocatable :: list, value, doc, needs
      type(string_t), allocatable :: names(:)
      integer :: i, k, n, n_lines

      n = 0
      do n_lines = 0, size(lines) - 1
         if (.not. begins(lines(n_lines + 1)%s, 'item ')) exit
         n = n + count_names(lines(n_lines + 1)%s)
      end do
      allocate (form%items(n))
      form%min_items = merge(1, 0, len(form%word) > 0)
      form%max_items = form%min_items
      n = 0
      do i = 1, n_lines
         list = lines(i)%s(6:)
         call cut_off(list, ' | ', value)
         call cut_off(value, ' | ', doc)
         call split_text(list, ', ', names)
         do k = 1, size(names)
            n = n + 1
            call read_value(names(k)%s, value, doc, form%items(n), needs, wrong)
            form%max_items = form%max_items + 1
            if (form%items(n)%required) form%min_items = form%max_items
            if (has_mark(names(k)%s, '.')) form%max_items = ANY_NUMBER
         end do
      end do
   end subroutine read_items

   !> How many items a line gives: the commas before its first column ends, and one.
   pure integer function count_names(line) result(n)
      character(len=*), intent(in) :: line
      integer :: i

      n = 1
      do i = 1, len(line)
         if (line(i:i) == ',') n = n + 1
         if (line(i:i) == '|') return
      end do
   end function count_names

   !> Place of a word in a list; 0: it is none of it.
   pure integer function place_of(word, list) result(place)
      character(len=*), intent(in) :: word, list(:)

      do place = size(list), 1, -1
         if (list(place) == word) return
      end do
   end function place_of

   !> Cuts a text before a separator; rest: what stands behind it, '' where there is none.
   pure subroutine cut_off(text, separator, rest)
      character(len=:), allocatable, intent(inout) :: text
      character(len=*), intent(in) :: separator
      character(len=:), allocatable, intent(out) :: rest
      integer :: i

      i = place_in(text, separator)
      rest = text(min(i + len(separator), len(text) + 1):)
      if (i <= len(text)) text = text(:i - 1)
   end subroutine cut_off

   !> Where a separator begins; behind the end of the text where it is not there. Quicker than index, of short texts: the table is
   !> read at every start.
   pure integer function place_in(text, separator) result(i)
      character(len=*), intent(in) :: text, separator

      do i = 1, len(text) - len(separator) + 1
         if (text(i:i) /= separator(1:1)) cycle
         if (text(i:i + len(separator) - 1) == separator) return
      end do
      i = len(text) + 1
   end function place_in

   !> What stands between separators; of '' nothing.
   pure subroutine split_text(text, separator, list)
      character(len=*), intent(in) :: text, separator
      type(string_t), allocatable, intent(out) :: list(:)
      integer :: first, length, n, pass

      do pass = 1, 2
         n = 0
         first = 1
         do while (first <= len(text))
            length = place_in(text(first:), separator) - 1
            n = n + 1
            if (pass == 2) list(n)%s = text(first:first + length - 1)
            first = first + length + len(separator)
         end do
         if (pass == 1) allocate (list(n))
      end do
   end subroutine split_text

   !> A name or word begins or ends with this mark.
   pure logical function has_mark(name, mark)
      character(len=*), intent(in) :: name
      character(len=1), intent(in) :: mark

      has_mark = name(:1) == mark .or. name(len(name):) == mark
   end function has_mark

   !> A name without its marks.
   pure function bare(name)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: bare
      character(len=*), parameter :: MARKS = '-+!.()[]'

      bare = name(max(verify(name, MARKS), 1):verify(name, MARKS, back=.true.))
   end function bare

end module atrito_keyword_reader
