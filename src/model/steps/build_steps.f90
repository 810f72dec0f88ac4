!> *STEP and *STATIC: the steps of the history, and how each goes through its time. *AMPLITUDE: curves over time, and which of them
!> a card of supports or loads follows.
module atrito_build_steps
   use atrito_step_loads, only: time_before
   use atrito_build_context, only: build_context_t, place_text, count_cards, define_name, invalidate_name
   use atrito_deck, only: deck_t, card_t, data_line_t, option_t, keyword_name, last_item, token_t, token_text, line_item, &
                          is_empty_token
   use atrito_diagnostics, only: report_error, report_note, report_outside, report_warning
   use atrito_drawn_lines, only: begin_lines_of_step
   use atrito_foreign_keywords, only: subject_named
   use atrito_items, only: find_option, get_real, has_option, option_integer, option_word, refuse_option, option_text
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, step_t, increments_t, amplitude_t
   use atrito_name_list, only: find_name
   use atrito_references, only: report_unknown
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_steps, open_step, build_amplitudes, take_amplitude, refuse_step_options

   !> The least increment where the deck gives none, in parts of the period.
   real(wp), parameter :: LEAST_PART = 1.0e-5_wp
   real(wp), parameter :: ROUND_OFF = 1.0e-6_wp    !< of a sum of increments
   character(len=*), parameter :: WHAT_INITIAL = 'first increment, a real > 0 and not longer than the step [time]'
   character(len=*), parameter :: WHAT_PERIOD = 'length of the step, a real > 0 [time]'
   character(len=*), parameter :: WHAT_LEAST = 'least increment, a real > 0 and not longer than the first [time]'
   character(len=*), parameter :: WHAT_GREATEST = 'greatest increment, a real > 0 [time]'
   character(len=*), parameter :: WHAT_MOST = 'most increments of the step, an integer >= 1'
   character(len=*), parameter :: WHAT_EVERY = 'increments between two restart files, an integer >= 1; 0: none is written'

   integer(ip), parameter :: MOST_ITEMS = 8            !< of a line: four times and values
   character(len=*), parameter :: WHAT_LINE = 'up to four pairs of time and value'
   character(len=*), parameter :: WHAT_TIME = 'time, a real >= 0, later than the one before [time]'

contains

   !> The steps, with nothing in them yet; one at least.
   subroutine build_steps(context)
      type(build_context_t), intent(inout) :: context  !< its model gets steps; step_cards is set
      integer(ip), allocatable :: static_card(:)       ! of each step; 0: outside of steps
      type(option_t) :: option
      integer(ip) :: i, n
      logical :: found

      n = max(1_ip, maxval(context%deck%cards(:context%deck%n_cards)%step))
      allocate (static_card(0:n), context%step_cards(2, 0:n), source=0_ip)
      allocate (context%model%steps(n))
      do i = 1, n
         context%model%steps(i)%title = ''
      end do
      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i), step => context%model%steps(max(1_ip, context%deck%cards(i)%step)))
            if (context%step_cards(1, card%step) == 0) context%step_cards(1, card%step) = i
            context%step_cards(2, card%step) = i
            select case (keyword_name(card))
            case ('STEP')
               call read_step_card(context%deck, card, step)
               call read_nlgeom(context%deck, card, context%model)
               call find_option(context%deck, card, 'PERTURBATION', option, found)
               if (found .and. n > 1) call report_outside(context%deck, option%name, 'PERTURBATION in one of several steps', &
                                                          subject_named('linear step'))
            case ('STATIC')
               call read_static_card(context%deck, i, static_card(card%step), step%increments)
            case ('RESTART')
               call read_restart_card(context%deck, card, context%model)
            end select
         end associate
      end do
      do i = 2, n
         context%model%steps(i)%began = time_before(context%model%steps, i)
      end do
   end subroutine build_steps

   subroutine read_step_card(deck, card, step)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(step_t), intent(inout) :: step
      type(token_t) :: whole, last
      integer(ip) :: k
      logical :: found

      step%at_once = option_word(deck, card, 'AMPLITUDE') == 'STEP'
      call option_integer(deck, card, 'INC', WHAT_MOST, step%increments%most, found)
      if (found .and. step%increments%most < 1) call refuse_option(deck, card, 'INC', WHAT_MOST)
      do k = card%first_line, card%first_line + card%n_lines - 1
         if (k > card%first_line) step%title = step%title//' '
         if (deck%lines(k)%n_tokens == 0) cycle
         whole = line_item(deck, deck%lines(k), 1_ip)   ! a whole line, its commas, too
         last = last_item(deck, deck%lines(k))
         whole%last = last%last
         step%title = step%title//token_text(deck, whole)
      end do
   end subroutine read_step_card

   !> Small displacements are solved whatever a step asks for; whether that mattered is known at the end. Told once: in other
   !> programs later steps go on with large ones.
   subroutine read_nlgeom(deck, card, model)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(model_t), intent(inout) :: model
      type(option_t) :: option
      logical :: found

      call find_option(deck, card, 'NLGEOM', option, found)
      if (.not. found .or. model%asks_nlgeom) return
      model%asks_nlgeom = option_word(deck, card, 'NLGEOM') == 'YES'
      if (model%asks_nlgeom) call report_warning(deck, option%name, 'W-NLGEOM', 'small displacements are solved, not large '// &
                                                 'ones; at the end W-LARGE tells where that matters, or N-SMALL that it does not')
   end subroutine read_nlgeom

   !> Without a data line the step is one increment, which is not cut.
   subroutine read_static_card(deck, i, first, increments)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i                     !< the card
      integer(ip), intent(inout) :: first              !< the first of its step; 0: none so far
      type(increments_t), intent(inout) :: increments

      associate (card => deck%cards(i))
         if (first > 0 .and. card%ok) then
            call report_error(deck, card%place, 'E-TWICE', 'the step has two *STATIC, the first in '// &
                              place_text(deck, deck%cards(first)%place, card%place), expected='one *STATIC in a step')
            return
         end if
         if (first == 0) first = i
         if (card%n_lines == 0) return
         if (.not. deck%lines(card%first_line)%ok) return
         call read_times(deck, deck%lines(card%first_line), has_option(deck, card, 'DIRECT'), increments)
      end associate
   end subroutine read_static_card

   !> First increment, period, least, greatest.
   subroutine read_times(deck, line, is_direct, increments)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      logical, intent(in) :: is_direct
      type(increments_t), intent(inout) :: increments
      logical :: ok(4), reaches_end

      associate (this => increments)
         call get_time(2_ip, WHAT_PERIOD, 1.0_wp, this%period, ok(2))
         call get_time(1_ip, WHAT_INITIAL, this%period, this%initial, ok(1))
         if (all(ok(:2))) call check_time(1_ip, this%initial <= this%period, this%initial, WHAT_INITIAL, ok(1))
         if (.not. all(ok(:2))) return
         if (is_direct) then
            call note_direct()
            this%least = this%initial
            this%greatest = this%initial
            return
         end if
         ! where as many increments as the step may have do not reach its end, they may grow, as in Abaqus and CalculiX
         reaches_end = real(this%most, wp)*this%initial >= (1.0_wp - ROUND_OFF)*this%period
         call get_time(4_ip, WHAT_GREATEST, merge(this%initial, this%period, reaches_end), this%greatest, ok(4))
         if (ok(4) .and. this%initial > this%greatest) then      ! it is the greatest, as in CalculiX
            call report_note(deck, line_item(deck, line, 4_ip), 'N-INCREMENT', 'the first increment, '//to_text(this%initial)// &
                             ', is longer than the greatest, '//to_text(this%greatest)//', and becomes it', keyword='')
            this%initial = this%greatest
         end if
         call get_time(3_ip, WHAT_LEAST, min(this%initial, LEAST_PART*this%period), this%least, ok(3))
         if (ok(3)) call check_time(3_ip, this%least <= this%initial, this%least, WHAT_LEAST, ok(3))
      end associate

   contains

      !> A time; 0 is its default, as in Abaqus and CalculiX.
      subroutine get_time(item, what, default, time, ok)
         integer(ip), intent(in) :: item
         character(len=*), intent(in) :: what
         real(wp), intent(in) :: default
         real(wp), intent(out) :: time
         logical, intent(out) :: ok

         call get_real(deck, line_item(deck, line, item), what, time, ok, default)
         if (ok) call check_time(item, time >= 0.0_wp, time, what, ok)
         if (.not. ok .or. time > 0.0_wp) return
         time = default
         if (item == 1 .and. line%n_tokens > 2) then             ! perhaps 0.1 with a comma
            call report_note(deck, line_item(deck, line, item), 'N-INCREMENT', 'a first increment of 0 is the whole step, '// &
                             to_text(time), keyword='')
         end if
      end subroutine get_time

      subroutine check_time(item, in_range, time, what, ok)
         integer(ip), intent(in) :: item
         logical, intent(in) :: in_range
         real(wp), intent(in) :: time
         character(len=*), intent(in) :: what
         logical, intent(out) :: ok

         ok = in_range
         if (.not. ok) call report_error(deck, line_item(deck, line, item), 'E-VALUE', to_text(time)//' is out of range', &
                                         expected=what)
      end subroutine check_time

      !> DIRECT: all increments are like the first, whatever the least and the greatest are said to be.
      subroutine note_direct()
         integer(ip) :: i

         do i = 3, line%n_tokens
            if (is_empty_token(line_item(deck, line, i))) cycle
            call report_note(deck, line_item(deck, line, i), 'N-IGNORED', 'with DIRECT all increments are like the first: no '// &
                             'least or greatest', keyword='')
            return
         end do
      end subroutine note_direct
   end subroutine read_times

   !> WRITE[, FREQUENCY=]; the last card counts.
   subroutine read_restart_card(deck, card, model)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(model_t), intent(inout) :: model
      type(option_t) :: option
      logical :: found

      if (.not. card%ok) return
      call find_option(deck, card, 'READ', option, found)
      if (found) then
         call report_error(deck, option%name, 'E-NOT-BUILT', 'a deck does not say where it goes on', &
                           expected='atrito --restart FILE, with the whole deck')
         return
      else if (.not. has_option(deck, card, 'WRITE')) then
         call report_error(deck, card%place, 'E-OPTION-MISSING', '*RESTART needs the option WRITE', &
                           expected='*RESTART, WRITE; to go on: atrito --restart FILE')
         return
      end if
      model%restart_every = 1
      call option_integer(deck, card, 'FREQUENCY', WHAT_EVERY, model%restart_every, found)
      if (found .and. model%restart_every < 0) call refuse_option(deck, card, 'FREQUENCY', WHAT_EVERY)
   end subroutine read_restart_card

   !> Begins with what a step holds.
   subroutine open_step(context, number)
      type(build_context_t), intent(inout) :: context  !< open: number, cards and first token
      integer(ip), intent(in) :: number                !< of the step, from 1
      integer(ip) :: i

      context%open%number = number
      context%open%amplitude = 0
      call begin_lines_of_step(context%drawn_cuts)
      call begin_lines_of_step(context%drawn_paths)
      context%open%first_token = huge(1_ip)
      context%open%first_card = context%step_cards(1, number)
      context%open%last_card = context%step_cards(2, number)
      if (number == 1) then                            ! with what stands outside of all steps
         context%open%first_card = 1
         context%open%last_card = context%deck%n_cards
      end if
      do i = context%open%first_card, context%open%last_card
         if (context%deck%cards(i)%step /= number .or. context%deck%cards(i)%n_lines == 0) cycle
         context%open%first_token = context%deck%lines(context%deck%cards(i)%first_line)%first_token
         return
      end do
   end subroutine open_step

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

end module atrito_build_steps
