!> Data lines of a card against the forms that its keyword allows: how many, how many items, which words.
module atrito_card_data
   use atrito_kinds, only: ip, wp
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, token_text, is_empty_token, line_item, last_item
   use atrito_diagnostics, only: report_error, report_note
   use atrito_foreign_keywords, only: is_foreign_variable, variable_of_component, may_be_empty
   use atrito_items, only: get_real, has_option, option_word
   use atrito_keyword, only: form_t, item_t, ANY_NUMBER, KIND_INTEGER, KIND_REAL, KIND_WORD
   use atrito_keyword_table, only: find_choice, choice_names, form_text, item_text, choices_text
   use atrito_strings, only: string_t, append_string, same_name, to_text, upper_case
   implicit none (type, external)
   private
   public :: check_data, form_applies

   !> The forms that apply to a card, and what was found of each.
   type :: tally_t
      integer, allocatable :: forms(:)                 !< indices in the forms of the keyword
      integer, allocatable :: n_lines(:)               !< lines of each
      integer :: n_words = 0                           !< forms that begin with a word
      logical :: faulty = .false.                      !< an error has been told: no word about missing lines
      logical :: noted = .false.                       !< a note is given once a card
   end type tally_t

   character(len=*), parameter :: BLANKS = ' '//achar(9)

contains

   !> Checks the data lines of a card; lines(:)%ok tells the outcome.
   subroutine check_data(deck, card)
      type(deck_t), intent(inout) :: deck              !< its lines and tokens; lines that go on are joined
      type(card_t), intent(inout) :: card              !< its lines become fewer where some go on
      type(tally_t) :: tally
      integer(ip) :: i
      integer :: f
      type(token_t) :: token

      ! which forms apply is not known when an option is wrong
      if (.not. card%ok) then
         if (any([(len(deck%keywords(card%keyword)%forms(f)%option) > 0, f=1, size(deck%keywords(card%keyword)%forms))])) return
      end if
      call find_forms(deck, card, tally)
      if (size(tally%forms) == 1) call join_lines(deck, card, deck%keywords(card%keyword)%forms(tally%forms(1)))
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (.not. deck%lines(i)%ok) then              ! a stray quote: what its items are is not known
            tally%faulty = .true.
            cycle
         end if
         call find_form(deck, card, deck%lines(i), tally, f)
         if (f == 0) then
            deck%lines(i)%ok = .false.
            if (tally%n_words == 0) exit               ! one line too many: one message
            cycle
         end if
         ! Checks the line against its form.
         associate (line => deck%lines(i), form => deck%keywords(card%keyword)%forms(tally%forms(f)))
            if (form%harmless) then
               call check_unused(deck, card, line, form, 1_ip)
               if (line%ok) call note_once(line_item(deck, line, 1_ip), form%doc)
            else if (line%n_tokens < form%min_items .or. line%n_tokens > form%max_items) then
               line%ok = .false.
               token = last_item(deck, line)
               if (line%n_tokens > form%max_items) token = line_item(deck, line, int(form%max_items, ip) + 1)
               call report_error(deck, token, 'E-ITEMS', count_text(line%n_tokens, form), expected=form_text(form), &
                                 keyword=trim(card%name))
            else
               call check_items(line, form)
            end if
         end associate
         tally%n_lines(f) = tally%n_lines(f) + 1
         if (.not. deck%lines(i)%ok) tally%faulty = .true.
      end do
      if (.not. tally%faulty) call check_counts(deck, card, tally)

   contains

      subroutine check_items(line, form)
         type(data_line_t), intent(inout) :: line
         type(form_t), intent(in) :: form
         type(token_t) :: token
         integer(ip) :: i
         integer :: offset, spec

         offset = merge(1, 0, len(form%word) > 0)
         do i = 1 + offset, line%n_tokens
            spec = min(i - offset, size(form%items))
            token = deck%tokens(line%first_token + i - 1)
            if (is_empty_token(token)) then
               if (.not. form%items(spec)%required) cycle
               line%ok = .false.
               call report_error(deck, token, 'E-MISSING', form%items(spec)%name//' is missing', &
                                 expected=item_text(form%items(spec)), keyword=trim(card%name))
            else if (form%items(spec)%harmless) then
               call check_unused(deck, card, line, form, i)
               if (line%ok) call note_once(token, form%items(spec)%name//' items')
               return
            else if (form%items(spec)%is_unused) then
               call check_unused(deck, card, line, form, i)
            else if (form%items(spec)%kind == KIND_WORD) then
               call check_word(deck, card, token, form%items(spec), line%ok)
            end if
         end do
      end subroutine check_items

      subroutine note_once(token, text)
         type(token_t), intent(in) :: token
         character(len=*), intent(in) :: text

         if (.not. tally%noted) call report_note(deck, token, 'N-IGNORED', '*'//trim(card%name)//': data without effect, '//text)
         tally%noted = .true.
      end subroutine note_once
   end subroutine check_data

   !> Puts lines that go on together with those in which they do.
   subroutine join_lines(deck, card, form)
      type(deck_t), intent(inout) :: deck
      type(card_t), intent(inout) :: card
      type(form_t), intent(in) :: form
      type(data_line_t) :: line
      integer(ip) :: i, kept, last

      if (.not. form%goes_on) return
      kept = card%first_line - 1
      last = kept + card%n_lines
      i = card%first_line
      do while (i <= last)
         line = deck%lines(i)
         i = i + 1
         if (line%n_tokens < form%min_items) call take_more(deck, form, last, line, i)
         kept = kept + 1
         deck%lines(kept) = line
      end do
      card%n_lines = kept - card%first_line + 1
   end subroutine join_lines

   !> The items of the lines in which one goes on. Where the next line is complete by itself, items are missing here. A line that no
   !> comma ends goes on only where that makes it complete; lines of equal lengths are then elements of another type.
   pure subroutine take_more(deck, form, last, line, i)
      type(deck_t), intent(in) :: deck
      type(form_t), intent(in) :: form
      integer(ip), intent(in) :: last                  !< line of the card
      type(data_line_t), intent(inout) :: line
      integer(ip), intent(inout) :: i                  !< the next line
      integer(ip) :: more
      logical :: goes_on

      do while (line%n_tokens < form%min_items .and. i <= last)
         more = deck%lines(i)%n_tokens
         if (more >= form%min_items .and. more <= form%max_items) return
         goes_on = ends_with_comma(deck, line)
         if (.not. goes_on) goes_on = line%n_tokens + more >= form%min_items .and. line%n_tokens + more <= form%max_items &
                                      .and. line%n_tokens /= more
         if (.not. goes_on) return
         line%n_tokens = line%n_tokens + more
         i = i + 1
      end do
   end subroutine take_more

   !> A comma stands behind the last item of a line.
   pure logical function ends_with_comma(deck, line)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(token_t) :: token
      integer(ip) :: i

      token = last_item(deck, line)
      ends_with_comma = .false.
      do i = token%last + 1, len(deck%sources(token%source)%text)
         ends_with_comma = deck%sources(token%source)%text(i:i) == ','
         if (ends_with_comma .or. verify(deck%sources(token%source)%text(i:i), BLANKS) > 0) return
      end do
   end function ends_with_comma

   subroutine find_forms(deck, card, tally)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(tally_t), intent(out) :: tally
      integer :: i

      allocate (tally%forms(0))
      associate (forms => deck%keywords(card%keyword)%forms)
         do i = 1, size(forms)
            if (.not. form_applies(deck, card, forms(i))) cycle
            tally%forms = [tally%forms, i]
            if (len(forms(i)%word) > 0) tally%n_words = tally%n_words + 1
         end do
      end associate
      allocate (tally%n_lines(size(tally%forms)), source=0)
   end subroutine find_forms

   !> Whether lines of this form may stand in a card, by its options.
   pure logical function form_applies(deck, card, form) result(applies)
      type(deck_t), intent(in) :: deck !< its keyword table is read
      type(card_t), intent(in) :: card !< its options are asked
      type(form_t), intent(in) :: form !< one of the card's keyword
      integer :: i

      if (len(form%option) == 0) then
         applies = .true.
      else if (size(form%values) == 0) then
         applies = has_option(deck, card, form%option) .neqv. form%absent
      else if (form%absent) then
         applies = .not. (has_option(deck, card, form%option) .or. &
                          any([(has_option(deck, card, form%values(i)%s), i=1, size(form%values))]))
      else
         applies = .false.
         do i = 1, size(form%values)
            applies = applies .or. form%values(i)%s == option_word(deck, card, form%option)
         end do
      end if
   end function form_applies

   !> The form of a line among those that apply: by its leading word, else by its position. 0 when there is none (reported).
   subroutine find_form(deck, card, line, tally, f)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(data_line_t), intent(in) :: line
      type(tally_t), intent(inout) :: tally
      integer, intent(out) :: f

      associate (forms => deck%keywords(card%keyword)%forms)
         if (tally%n_words > 0) then
            do f = 1, size(tally%forms)
               if (len(forms(tally%forms(f))%word) == 0) cycle
               if (.not. same_name(token_text(deck, line_item(deck, line, 1_ip)), forms(tally%forms(f))%word)) cycle
               if (tally%n_lines(f) < forms(tally%forms(f))%max_lines) return
               exit
            end do
         end if
         do f = 1, size(tally%forms)
            if (len(forms(tally%forms(f))%word) > 0) cycle
            if (tally%n_lines(f) < forms(tally%forms(f))%max_lines) return
         end do
      end associate
      f = 0
      tally%faulty = .true.
      call report_superfluous()

   contains

      subroutine report_superfluous()
         character(len=:), allocatable :: text
         type(token_t) :: first
         type(string_t), allocatable :: words(:)
         logical :: is_word
         integer :: f

         first = line_item(deck, line, 1_ip)
         text = token_text(deck, first)
         allocate (words(0))
         is_word = .false.
         do f = 1, size(tally%forms)
            associate (word => deck%keywords(card%keyword)%forms(tally%forms(f))%word)
               if (len(word) == 0) cycle
               call append_string(words, word)
               is_word = is_word .or. same_name(word, text)
            end associate
         end do
         if (is_word) then
            call report_error(deck, first, 'E-LINES', 'one '//text//' line too many', keyword=trim(card%name))
         else if (size(words) > 0) then
            call report_error(deck, first, 'E-CHOICE', "'"//text//"' begins no data line of *"//trim(card%name), known=words, &
                              keyword=trim(card%name), expected=expected_forms())
         else if (size(tally%forms) == 0) then
            call report_error(deck, first, 'E-LINES', 'no data lines belong to this *'//trim(card%name), keyword=trim(card%name))
         else
            call report_error(deck, first, 'E-LINES', 'a data line too many', keyword=trim(card%name), expected=expected_forms())
         end if
      end subroutine report_superfluous

      !> The forms that apply, as they are written.
      pure function expected_forms() result(text)
         character(len=:), allocatable :: text
         integer :: f

         text = ''
         do f = 1, size(tally%forms)
            associate (form => deck%keywords(card%keyword)%forms(tally%forms(f)))
               if (f > 1) text = text//'; '
               if (form%max_lines < ANY_NUMBER .and. form%max_lines > 1) text = text//to_text(form%max_lines)//' lines '
               text = text//form_text(form)
            end associate
         end do
      end function expected_forms
   end subroutine find_form

   !> `2 items, where 3 to 4 belong`.
   pure function count_text(n, form) result(text)
      integer(ip), intent(in) :: n
      type(form_t), intent(in) :: form
      character(len=:), allocatable :: text

      text = to_text(n)//trim(merge(' item ', ' items', n == 1))//', where '//to_text(form%min_items)
      if (form%max_items == ANY_NUMBER) then
         text = text//' or more belong'
      else if (form%max_items > form%min_items) then
         text = text//' to '//to_text(form%max_items)//' belong'
      else
         text = text//trim(merge(' belongs', ' belong ', form%max_items == 1))
      end if
   end function count_text

   !> Where a number without effect belongs, a name is hardly without meaning: a second set on the line of one.
   subroutine check_unused(deck, card, line, form, first)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(data_line_t), intent(inout) :: line
      type(form_t), intent(in) :: form
      integer(ip), intent(in) :: first                 !< item of the line
      type(token_t) :: token
      real(wp) :: unused
      integer(ip) :: i
      logical :: ok

      do i = first, line%n_tokens
         token = deck%tokens(line%first_token + i - 1)
         associate (item => form%items(min(int(i) - merge(1, 0, len(form%word) > 0), size(form%items))))
            if (is_empty_token(token) .or. all(item%kind /= [KIND_REAL, KIND_INTEGER])) cycle
            call get_real(deck, token, item_text(item), unused, ok, keyword=trim(card%name))
            line%ok = line%ok .and. ok
         end associate
      end do
   end subroutine check_unused

   subroutine check_word(deck, card, token, item, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(token_t), intent(in) :: token
      type(item_t), intent(in) :: item
      logical, intent(inout) :: ok
      character(len=:), allocatable :: word
      integer :: choice, whole
      logical :: is_foreign

      word = upper_case(token_text(deck, token))
      choice = find_choice(item%choices, word)
      whole = 0
      is_foreign = .false.
      if (choice == 0 .and. item%name == 'variable') then
         whole = find_choice(item%choices, variable_of_component(word))
         is_foreign = is_foreign_variable(word)
      end if
      if (whole > 0) then
         call report_note(deck, token, 'N-IGNORED', 'variable '//word//' of *'//trim(card%name)//' is written with all '// &
                          'components of '//item%choices(whole)%name)
      else if (is_foreign) then
         call report_note(deck, token, 'N-IGNORED', 'variable '//word//' of *'//trim(card%name)//' is not written')
      else if (choice == 0) then
         ok = .false.
         call report_error(deck, token, 'E-CHOICE', 'unknown '//item%name//' '//token_text(deck, token), &
                           expected=item%doc//': '//choices_text(item%choices), known=choice_names(item%choices), &
                           keyword=trim(card%name))
      else if (.not. item%choices(choice)%built) then
         ok = .false.
         call report_error(deck, token, 'E-NOT-BUILT', item%name//' '//item%choices(choice)%name//' is not built yet', &
                           keyword=trim(card%name))
      end if
   end subroutine check_word

   !> Enough lines of every form.
   subroutine check_counts(deck, card, tally)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(tally_t), intent(in) :: tally
      character(len=:), allocatable :: text
      integer :: f

      if (option_word(deck, card, 'OP') == 'NEW' .and. has_option(deck, card, 'OP')) return  ! nothing replaces what is removed
      if (card%n_lines == 0 .and. may_be_empty(trim(card%name))) then
         call report_note(deck, card%place, 'N-IGNORED', '*'//trim(card%name)//' without data lines has no effect')
         return
      end if
      do f = 1, size(tally%forms)
         associate (form => deck%keywords(card%keyword)%forms(tally%forms(f)))
            if (tally%n_lines(f) >= form%min_lines) cycle
            if (form%min_lines == 1) then
               text = '*'//trim(card%name)//' needs a data line: '//form%doc
            else
               text = '*'//trim(card%name)//' needs '//to_text(form%min_lines)//' data lines, there are '// &
                      to_text(tally%n_lines(f))//': '//form%doc
            end if
            call report_error(deck, card%place, 'E-LINES', text, expected=form_text(form), keyword=trim(card%name))
         end associate
      end do
   end subroutine check_counts

end module atrito_card_data
