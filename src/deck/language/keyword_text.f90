!> How keywords, options and data lines are written: for messages, `atrito help` and the manual.
module atrito_keyword_text
   use atrito_keyword, only: option_spec_t, choice_t, form_t, item_t, ANY_NUMBER, KIND_FLAG, KIND_NAME, KIND_WORD, &
                             KIND_OPTIONAL_WORD, KIND_REAL, KIND_INTEGER, KIND_FILE, KIND_ID, KIND_ID_OR_NAME, KIND_TEXT, &
                             KIND_REAL_OR_NAME, LEVEL_MODEL, LEVEL_STEP
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: form_text, item_text, option_text_of, choices_text, lines_text, condition_text, with_dimension, level_text, &
             item_meaning

contains

   !> The items of a data line: `id, x [L], y [L]`.
   pure function form_text(form) result(text)
      type(form_t), intent(in) :: form
      character(len=:), allocatable :: text
      integer :: i

      text = form%word
      do i = 1, size(form%items)
         if (form%items(i)%harmless) cycle
         if (len(text) > 0) text = text//', '
         text = text//with_dimension(form%items(i)%name, form%items(i)%dimension)
         if (.not. form%items(i)%required) text = text//' (may be left out)'
      end do
      if (form%max_items == ANY_NUMBER .and. size(form%items) > 0) then
         if (.not. form%items(size(form%items))%harmless) text = text//', ...'
      end if
   end function form_text

   !> What an item is: `x: coordinate, a real [L]`.
   pure function item_text(item) result(text)
      type(item_t), intent(in) :: item
      character(len=:), allocatable :: text

      text = item%name//': '//item%doc//', '//with_dimension(kind_words(item%kind), item%dimension)
   end function item_text

   !> The meaning of an item for the reference: kind, dimension, choices, default.
   pure function item_meaning(item) result(text)
      type(item_t), intent(in) :: item
      character(len=:), allocatable :: text

      text = item%doc
      if (size(item%choices) > 0) then
         text = text//': '//choices_text(item%choices)
      else
         text = text//'; '//with_dimension(kind_words(item%kind), item%dimension)
      end if
      if (len(item%default) > 0) text = text//'; default '//item%default
      if (.not. item%required .and. len(item%default) == 0 .and. .not. item%harmless) text = text//'; may be left out'
      if (item%harmless) text = text//'; no effect'
   end function item_meaning

   !> How an option is written: `NAME=name`.
   pure function option_text_of(option) result(text)
      type(option_spec_t), intent(in) :: option
      character(len=:), allocatable :: text

      text = option%name
      select case (option%kind)
      case (KIND_NAME)
         text = text//'=name'
      case (KIND_WORD)
         text = text//'=word'
      case (KIND_OPTIONAL_WORD)
         text = text//'[=word]'
      case (KIND_REAL)
         text = text//'=real'
      case (KIND_INTEGER)
         text = text//'=integer'
      case (KIND_FILE)
         text = text//'=file'
      case (KIND_ID_OR_NAME)
         text = text//'=number or name'
      case (KIND_REAL_OR_NAME)
         text = text//'=real or name'
      end select
      if (option%own) text = text//' +'
   end function option_text_of

   !> The words that can be chosen, those not built marked.
   pure function choices_text(choices) result(text)
      type(choice_t), intent(in) :: choices(:)
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

   !> Where a keyword may stand.
   pure function level_text(level) result(text)
      integer, intent(in) :: level
      character(len=:), allocatable :: text

      select case (level)
      case (LEVEL_MODEL)
         text = 'model, before *STEP'
      case (LEVEL_STEP)
         text = 'step, between *STEP and *END STEP'
      case default
         text = 'model or step'
      end select
   end function level_text

   !> How many lines of a form there may be.
   pure function lines_text(form) result(text)
      type(form_t), intent(in) :: form
      character(len=:), allocatable :: text

      if (form%min_lines == form%max_lines) then
         text = to_text(form%min_lines)//merge(' line ', ' lines', form%min_lines == 1)
         text = trim(text)
      else if (form%max_lines == ANY_NUMBER) then
         text = 'any number of lines'
         if (form%min_lines > 0) text = to_text(form%min_lines)//' or more lines'
      else
         text = to_text(form%min_lines)//' or '//to_text(form%max_lines)//' lines'
         if (form%max_lines - form%min_lines > 1) then
            text = to_text(form%min_lines)//' to '//to_text(form%max_lines)//' lines'
         end if
         if (form%max_lines == 1) text = 'at most 1 line'
      end if
      if (form%goes_on) text = text//'; a line with too few items goes on in the next'
   end function lines_text

   !> When a form applies: `with TYPE=ELEMENT`, `without NONLOCAL`; '' when always.
   pure function condition_text(form) result(text)
      type(form_t), intent(in) :: form
      character(len=:), allocatable :: text
      integer :: i

      text = ''
      if (len(form%option) == 0) return
      text = 'with '//form%option
      if (form%absent) text = 'without '//form%option
      do i = 1, size(form%values)
         text = text//merge('=', ' ', i == 1)
         if (i > 1) text = text//'or '
         text = text//form%values(i)%s
      end do
   end function condition_text

   pure function kind_words(kind) result(text)
      integer, intent(in) :: kind
      character(len=:), allocatable :: text

      select case (kind)
      case (KIND_FLAG)
         text = 'no value'
      case (KIND_NAME)
         text = 'a name'
      case (KIND_WORD, KIND_OPTIONAL_WORD)
         text = 'a word'
      case (KIND_REAL)
         text = 'a real'
      case (KIND_INTEGER)
         text = 'an integer'
      case (KIND_FILE)
         text = 'a file'
      case (KIND_ID)
         text = 'an integer'
      case (KIND_ID_OR_NAME)
         text = 'an integer or a name'
      case (KIND_TEXT)
         text = 'text'
      case (KIND_REAL_OR_NAME)
         text = 'a real or a name'
      end select
   end function kind_words

   !> A text with its dimension behind it: `x [L]`; the text alone where there is none.
   pure function with_dimension(text, dimension) result(both)
      character(len=*), intent(in) :: text, dimension
      character(len=:), allocatable :: both

      both = text
      if (len(dimension) > 0) both = text//' ['//dimension//']'
   end function with_dimension

end module atrito_keyword_text
