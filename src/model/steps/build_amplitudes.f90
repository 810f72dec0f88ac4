!> *AMPLITUDE: curves over time; and which of them a card of supports or loads follows.
module atrito_build_amplitudes
   use atrito_build_context, only: build_context_t, count_cards, define_name, invalidate_name
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, option_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_items, only: find_option, get_real, option_text, option_word
   use atrito_kinds, only: ip, wp
   use atrito_model, only: amplitude_t
   use atrito_name_list, only: find_name
   use atrito_references, only: report_unknown
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_amplitudes, take_amplitude, refuse_step_options

   integer(ip), parameter :: MOST_ITEMS = 8            !< of a line: four times and values
   character(len=*), parameter :: WHAT_LINE = 'up to four pairs of time and value'
   character(len=*), parameter :: WHAT_TIME = 'time, a real >= 0, later than the one before [time]'

contains

   !> All curves of a deck.
   subroutine build_amplitudes(context)
      type(build_context_t), intent(inout) :: context  !< its model gets amplitudes
      character(len=:), allocatable :: name
      integer(ip) :: i, place
      logical :: ok

      allocate (context%model%amplitudes(count_cards(context%deck, 'AMPLITUDE')))
      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i))
            if (keyword_name(card) /= 'AMPLITUDE') cycle
            call define_name(context%deck, card, 'amplitude', context%amplitude_names, context%amplitudes, name, place)
            if (place == 0) cycle
            call read_curve(context%deck, card, context%model%amplitudes(place), ok)
            context%model%amplitudes(place)%name = name
            if (.not. ok) call invalidate_name(context, name)
         end associate
      end do
      context%model%amplitudes = context%model%amplitudes(:context%amplitude_names%n)
   end subroutine build_amplitudes

   subroutine read_curve(deck, card, amplitude, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(amplitude_t), intent(inout) :: amplitude
      logical, intent(out) :: ok
      integer(ip) :: k, n
      logical :: good, is_table                        ! lines of a definition that is refused mean other things

      ok = card%ok
      n = 0
      allocate (amplitude%time(MOST_ITEMS/2*card%n_lines), amplitude%value(MOST_ITEMS/2*card%n_lines))
      amplitude%is_total_time = option_word(deck, card, 'TIME') == 'TOTAL TIME'
      amplitude%is_smooth = option_word(deck, card, 'DEFINITION') == 'SMOOTH STEP'
      is_table = amplitude%is_smooth .or. option_word(deck, card, 'DEFINITION') == 'TABULAR'
      do k = card%first_line, card%first_line + card%n_lines - 1
         good = deck%lines(k)%ok .and. is_table
         if (good) call read_pairs(deck%lines(k), good)
         ok = ok .and. good
      end do
      amplitude%time = amplitude%time(:n)
      amplitude%value = amplitude%value(:n)
      if (n > 0) return
      amplitude%time = [0.0_wp]                        ! of a faulty card
      amplitude%value = [1.0_wp]

   contains

      !> The pairs of a line, behind the n that there are.
      subroutine read_pairs(line, ok)
         type(data_line_t), intent(in) :: line
         logical, intent(out) :: ok
         real(wp) :: time, value
         integer(ip) :: i
         logical :: good(2)

         ok = mod(line%n_tokens, 2_ip) == 0 .and. line%n_tokens <= MOST_ITEMS
         if (.not. ok) then
            call report_error(deck, line_item(deck, line, min(line%n_tokens, MOST_ITEMS + 1)), 'E-ITEMS', to_text(line%n_tokens)// &
                              ' items are no pairs of time and value', expected=WHAT_LINE)
            return
         end if
         do i = 1, line%n_tokens, 2
            call get_real(deck, line_item(deck, line, i), WHAT_TIME, time, good(1))
            call get_real(deck, line_item(deck, line, i + 1), 'value, a real [-]', value, good(2))
            if (good(1)) call check_time(line_item(deck, line, i), time, amplitude%time(:n), good(1))
            ok = ok .and. all(good)
            if (.not. all(good)) cycle
            n = n + 1
            amplitude%time(n) = time
            amplitude%value(n) = value
         end do
      end subroutine read_pairs

      !> A time is not negative, and comes after those that there are.
      subroutine check_time(token, time, earlier, ok)
         type(token_t), intent(in) :: token
         real(wp), intent(in) :: time, earlier(:)
         logical, intent(out) :: ok
         character(len=:), allocatable :: wrong

         ok = time >= 0.0_wp
         wrong = ' is less than 0'
         if (ok .and. size(earlier) > 0) then
            ok = time > earlier(size(earlier))
            wrong = ' does not come after '//to_text(earlier(size(earlier)))
         end if
         if (.not. ok) call report_error(deck, token, 'E-VALUE', 'the time '//to_text(time)//wrong, expected=WHAT_TIME)
      end subroutine check_time
   end subroutine read_curve

   !> The amplitude that a card names becomes that of its lines; 0 where it is unknown, which is reported.
   subroutine take_amplitude(context, card)
      type(build_context_t), intent(inout) :: context  !< open%amplitude is set
      type(card_t), intent(in) :: card                 !< whose AMPLITUDE= is read
      character(len=:), allocatable :: name
      type(token_t) :: place
      logical :: found

      context%open%amplitude = 0
      call option_text(context%deck, card, 'AMPLITUDE', name, found, place)
      if (.not. found) return
      context%open%amplitude = find_name(context%amplitude_names, name)
      if (context%open%amplitude == 0) call report_unknown(context, place, 'amplitude', 'E-AMPLITUDE', context%amplitude_names)
   end subroutine take_amplitude

   !> What holds in every step follows no amplitude, and there is nothing before it that it could remove.
   subroutine refuse_step_options(deck, card)
      type(deck_t), intent(in) :: deck           !< as read; messages name its lines
      type(card_t), intent(in) :: card           !< of supports, before *STEP
      type(option_t) :: option
      logical :: found

      if (.not. card%ok) return
      call find_option(deck, card, 'AMPLITUDE', option, found)
      if (found) call report_error(deck, option%name, 'E-LEVEL', 'AMPLITUDE= before *STEP, where all displacements are 0', &
                                   expected='AMPLITUDE= in a step')
      call find_option(deck, card, 'OP', option, found)
      if (found .and. option_word(deck, card, 'OP') == 'NEW') then
         call report_error(deck, option%name, 'E-LEVEL', 'OP=NEW before *STEP, where there is nothing to remove', &
                           expected='OP=NEW in a step')
      end if
   end subroutine refuse_step_options

end module atrito_build_amplitudes
