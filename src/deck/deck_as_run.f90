!> A deck as it was run: all files that it includes in their places, parameters replaced by their values. It runs by itself.
!>
!> What is replaced is noted (note_edits) as the cards were read, before instances take copies of them, in their order and each item
!> once: expressions by their values, *PARAMETER by comments, meshes of other programs by the names of their copies. Nothing is
!> reported, and of a deck with errors nothing is noted: it is not run.
module atrito_deck_as_run
   use atrito_as_run_names, only: as_run_name, mesh_copy_name
   use atrito_card_data, only: form_applies
   use atrito_deck, only: deck_t, after_byte_order_mark, count_lines, card_t, token_t, data_line_t, token_text, is_empty_token, &
                          KEYWORD_UNKNOWN
   use atrito_items, only: evaluate_at, index_of_parameter, has_option, option_text
   use atrito_edits, only: put_before_steps, append_edit, append_known_edit, take_known_edit
   use atrito_expression_names, only: next_name
   use atrito_keyword, only: KIND_NAME, KIND_REAL, KIND_INTEGER, KIND_ID, KIND_ID_OR_NAME, KIND_REAL_OR_NAME, KIND_TEXT
   use atrito_kinds, only: ip, wp
   use atrito_messages, only: count_messages, SEVERITY_ERROR
   use atrito_numbers, only: exact_text
   use atrito_own_files, only: DECK_MARK, MESH_MARK
   use atrito_patched_text, only: patched_text_t, named_text_t, append_place, append_words, OWN_WORDS, UNCOUNTED
   use atrito_strings, only: deck_name, same_name
   implicit none (type, external)
   private
   public :: take_deck_as_run, note_edits

   character(len=1), parameter :: LINE_FEED = achar(10)

   character(len=1), parameter :: FOR_INTEGERS = '#'   !< before the text of an expression that is to be whole
   character(len=1), parameter :: OPENING = '<'

contains

   !> The deck first, then the meshes of other programs that it includes. The texts of the deck are moved; it is of no use
   !> afterwards.
   subroutine take_deck_as_run(deck, files, before_steps)
      type(deck_t), intent(inout) :: deck                      !< edits noted; loses its texts
      type(named_text_t), allocatable, intent(out) :: files(:) !< deck, then copies of meshes, with their names
      character(len=*), intent(in), optional :: before_steps   !< cards that are put before the first *STEP
      integer(ip) :: i, n, edit, last

      if (present(before_steps)) call put_before_steps(deck%edits, before_steps)
      n = count(deck%sources(:deck%n_sources)%is_mesh, kind=ip)
      allocate (files(n + 1))
      files(1)%name = as_run_name(deck_name(deck%path))
      files(1)%text%words%n = deck%edits%words%n
      if (deck%edits%words%n > 0) call move_alloc(deck%edits%words%letters, files(1)%text%words%letters)
      edit = 1
      call put_source(1_ip, files(1)%text)
      allocate (files(1)%text%texts(deck%n_sources))
      n = 1
      do i = 1, deck%n_sources
         if (deck%sources(i)%is_mesh) then
            n = n + 1
            files(n)%name = mesh_copy_name(deck_name(deck%path), n - 1)
            allocate (files(n)%text%texts(1))
            ! up to the words by which the copy of a mesh says that atrito wrote it; the writer adds them anew
            last = index(deck%sources(i)%text, MESH_MARK, back=.true., kind=ip) - 1
            if (last < 0) last = len(deck%sources(i)%text, kind=ip)
            call append_place(files(n)%text, 1_ip, 1_ip, last)
            call move_alloc(deck%sources(i)%text, files(n)%text%texts(1)%s)
         else
            call move_alloc(deck%sources(i)%text, files(1)%text%texts(i)%s)
         end if
      end do

   contains

      !> A file of the deck, with what it includes.
      recursive subroutine put_source(source, patched)
         integer(ip), intent(in) :: source
         type(patched_text_t), intent(inout) :: patched
         integer(ip) :: position, child, last

         last = len(deck%sources(source)%text, kind=ip)
         associate (text => deck%sources(source)%text)
            position = after_byte_order_mark(text)
            if (index(text(position:), DECK_MARK) == 1) position = position + index(text(position:)//LINE_FEED, LINE_FEED, kind=ip)
         end associate
         child = next_child(deck, source, source)
         do while (child > 0)
            associate (included => deck%sources(child))
               call put_edited(source, included%include_first - 1, position, patched)
               call put_source(child, patched)
               ! What follows an included file begins a line.
               if (len(included%text) /= 0) then
                  if (included%text(len(included%text):) /= LINE_FEED) call append_words(patched, LINE_FEED)
               end if
               position = included%include_last + 1
            end associate
            child = next_child(deck, source, child)
         end do
         call put_edited(source, last, position, patched)
      end subroutine put_source

      !> The characters of a file up to `last`, with the edits among them.
      subroutine put_edited(source, last, position, patched)
         integer(ip), intent(in) :: source, last
         integer(ip), intent(inout) :: position           !< the first character that is left
         type(patched_text_t), intent(inout) :: patched

         do while (edit <= deck%edits%n)
            associate (one => deck%edits%list(edit))
               if (one%source /= source .or. one%first > last) exit
               call append_place(patched, source, position, one%first - 1)
               call append_place(patched, merge(UNCOUNTED, OWN_WORDS, one%is_name), one%from, one%to)
               position = one%last + 1
            end associate
            edit = edit + 1
         end do
         call append_place(patched, source, position, last)
         position = max(position, last + 1)
      end subroutine put_edited
   end subroutine take_deck_as_run

   !> The next file, not a mesh, that one includes; 0: there is none.
   pure integer(ip) function next_child(deck, source, before) result(child)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: source, before

      do child = before + 1, deck%n_sources
         if (deck%sources(child)%parent == source .and. .not. deck%sources(child)%is_mesh) return
      end do
      child = 0
   end function next_child

   !> Notes what is to be edited in the text so that the deck reads as it was run: values in the place of parameters and
   !> expressions, names of included meshes. Nothing where the deck has errors.
   subroutine note_edits(deck)
      type(deck_t), intent(inout) :: deck !< its `edits` are filled
      character(len=:), allocatable :: name
      type(token_t) :: place
      integer(ip) :: i, first, n_parameters, n_meshes
      logical :: found, is_used
      integer :: k

      if (count_messages(SEVERITY_ERROR) > 0) return
      n_parameters = 0
      is_used = count_lines(deck, 'OBSERVE') > 0      ! by name: parameters stay, with their values
      n_meshes = 0
      do i = 1, deck%n_cards
         if (deck%cards(i)%keyword == KEYWORD_UNKNOWN) cycle
         select case (deck%cards(i)%name)
         case ('PARAMETER')
            call note_parameters(deck, deck%cards(i), is_used, n_parameters)
         case ('INCLUDE')
            n_meshes = n_meshes + 1
            call option_text(deck, deck%cards(i), 'INPUT', name, found, place)
            if (found) call append_edit(deck%edits, place%source, place%first, place%last, &
                                        mesh_copy_name(deck_name(deck%path), n_meshes), is_name=.true.)
         case default
            if (deck%cards(i)%name == 'STEP' .and. deck%edits%before_steps == 0) then
               associate (place => deck%cards(i)%place)
                  first = index(deck%sources(place%source)%text(:place%first - 1), '*', back=.true.)
                  call append_edit(deck%edits, place%source, first, first - 1_ip, '')
               end associate
               deck%edits%before_steps = deck%edits%n
            end if
            ! Values of options that are numbers.
            associate (card => deck%cards(i))
               do k = 1, size(card%options)
                  if (card%options(k)%spec < 1 .or. .not. card%options(k)%has_value) cycle
                  if (.not. is_bracketed(deck, card%options(k)%value)) cycle
                  select case (deck%keywords(card%keyword)%options(card%options(k)%spec)%kind)
                  case (KIND_REAL, KIND_REAL_OR_NAME)
                     call note_value(deck, card%options(k)%value, .false.)
                  case (KIND_INTEGER)
                     call note_value(deck, card%options(k)%value, .true.)
                  end select
               end do
            end associate
            call note_lines(deck, deck%cards(i))
         end select
      end do
   end subroutine note_edits

   !> `** PARAMETER`, and a comment a line with the value; no comments where the deck still needs them.
   subroutine note_parameters(deck, card, stay, n)
      type(deck_t), intent(inout) :: deck
      type(card_t), intent(in) :: card
      logical, intent(in) :: stay
      integer(ip), intent(inout) :: n              !< parameters so far: each line defines the next
      character(len=:), allocatable :: mark
      type(token_t) :: token
      integer(ip) :: i

      mark = '** '
      if (stay) mark = ''
      associate (place => card%place)
         i = index(deck%sources(place%source)%text(:place%first - 1), '*', back=.true.)
         if (.not. stay) call append_edit(deck%edits, place%source, i, place%first - 1, mark)
      end associate
      do i = card%first_line, card%first_line + card%n_lines - 1
         token = deck%tokens(deck%lines(i)%first_token)
         n = n + 1
         associate (parameter => deck%parameters(n))
            call append_edit(deck%edits, token%source, token%first, token%last, mark// &
                             parameter%name//' = '//exact_text(parameter%value))
         end associate
      end do
   end subroutine note_parameters

   subroutine note_lines(deck, card)
      type(deck_t), intent(inout) :: deck
      type(card_t), intent(in) :: card
      integer(ip) :: i, k, first                       ! item of a function of x and y

      first = first_of_function(deck, card)
      do i = card%first_line, card%first_line + card%n_lines - 1
         associate (line => deck%lines(i))
            do k = 1, min(line%n_tokens, first - 1)
               if (.not. is_bracketed(deck, deck%tokens(line%first_token + k - 1))) cycle
               call note_item(line)
            end do
            if (line%n_tokens >= first) call note_function(line, first)
         end associate
      end do

   contains

      !> The k-th item of a line, unless it is a name.
      subroutine note_item(line)
         type(data_line_t), intent(in) :: line
         logical :: is_name, is_whole
         integer :: f, i

         is_name = .true.
         is_whole = .true.
         associate (forms => deck%keywords(card%keyword)%forms)
            do f = 1, size(forms)
               if (size(forms(f)%items) == 0 .or. .not. form_applies(deck, card, forms(f))) cycle
               if (len(forms(f)%word) > 0) then               ! it begins with that word
                  if (.not. same_name(forms(f)%word, token_text(deck, deck%tokens(line%first_token)))) cycle
               end if
               i = min(int(k) - merge(1, 0, len(forms(f)%word) > 0), size(forms(f)%items))  ! the last item may be repeated
               select case (forms(f)%items(max(1, i))%kind)
               case (KIND_NAME)
                  cycle
               case (KIND_INTEGER, KIND_ID, KIND_ID_OR_NAME)
                  is_name = .false.
               case (KIND_TEXT)                        ! further terms of an equation: node, dof, coefficient
                  is_name = .false.
                  is_whole = is_whole .and. mod(k, 3_ip) /= 0
               case default
                  is_name = .false.
                  is_whole = .false.
               end select
            end do
         end associate
         if (.not. is_name) call note_value(deck, deck%tokens(line%first_token + k - 1), is_whole)
      end subroutine note_item

      !> The names of parameters in an expression of x and y; a value below 0 stands in parentheses, for a power of it.
      subroutine note_function(line, k)
         type(data_line_t), intent(in) :: line
         integer(ip), intent(in) :: k                     !< its first item
         character(len=:), allocatable :: text, value
         integer(ip) :: i
         integer :: first, last

         associate (token => deck%tokens(line%first_token + k - 1), end => deck%tokens(line%first_token + line%n_tokens - 1)%last)
            text = deck%sources(token%source)%text(token%first:end)
            last = 0
            do
               call next_name(text, last, first)
               if (first > len(text)) exit
               i = index_of_parameter(deck, text(first:last))
               if (i == 0) cycle
               value = exact_text(deck%parameters(i)%value)
               if (value(1:1) == '-') value = '('//value//')'
               call append_edit(deck%edits, token%source, token%first + first - 1, token%first + last - 1, value)
            end do
         end associate
      end subroutine note_function
   end subroutine note_lines

   !> The item at which a function begins: the last of its form. Beyond all items where there is none.
   pure integer(ip) function first_of_function(deck, card) result(first)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      integer :: f

      first = huge(first)
      if (.not. has_option(deck, card, 'FUNCTION')) return
      associate (forms => deck%keywords(card%keyword)%forms)
         do f = 1, size(forms)
            if (form_applies(deck, card, forms(f))) first = size(forms(f)%items, kind=ip)
         end do
      end associate
   end function first_of_function

   !> An item begins like an expression.
   pure logical function is_bracketed(deck, token)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token

      is_bracketed = .false.
      if (is_empty_token(token)) return
      associate (text => deck%sources(token%source)%text, first => token%first)
         is_bracketed = text(first:first) == OPENING
         if (text(first:first) == '-' .and. token%last > first) is_bracketed = text(first + 1:first + 1) == OPENING
      end associate
   end function is_bracketed

   !> `<expression>` or `-<expression>` becomes a number that reads as the same value.
   subroutine note_value(deck, token, is_whole)
      type(deck_t), intent(inout) :: deck
      type(token_t), intent(in) :: token
      logical, intent(in) :: is_whole
      character(len=:), allocatable :: text
      type(token_t) :: place
      real(wp) :: value
      integer(ip) :: parameter
      logical :: known

      text = deck%sources(token%source)%text(token%first:token%last)
      if (is_whole) text = FOR_INTEGERS//text
      call take_known_edit(deck%edits, text, token%source, token%first, token%last, known)
      if (known) return
      place = token
      place%first = token%first + index(text, OPENING) - merge(1, 0, is_whole)
      place%last = token%last - 1
      parameter = index_of_parameter(deck, deck%sources(place%source)%text(place%first:place%last))
      if (parameter > 0) then
         value = deck%parameters(parameter)%value
      else
         call evaluate_at(deck, place, value, known, silent=.true.)
         if (.not. known) return
      end if
      if (index(text, '-'//OPENING) > 0 .and. index(text, '-') < index(text, OPENING)) value = -value
      if (is_whole) value = anint(value)
      call append_known_edit(deck%edits, text, token%source, token%first, token%last, exact_text(value))
   end subroutine note_value

end module atrito_deck_as_run
