!> *STEP and *STATIC: the steps of the history, and how each goes through its time.
module atrito_build_steps
   use atrito_build_context, only: build_context_t, place_text
   use atrito_deck, only: deck_t, card_t, data_line_t, option_t, keyword_name, last_item, token_t, token_text, line_item, &
                          is_empty_token
   use atrito_diagnostics, only: report_error
   use atrito_items, only: find_option, get_real, has_option, option_integer, option_word
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, step_t, increments_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_steps, open_step

   !> The least increment where the deck gives none, in parts of the period.
   real(wp), parameter :: LEAST_PART = 1.0e-5_wp
   character(len=*), parameter :: WHAT_INITIAL = 'first increment, a real > 0 and not longer than the step [time]'
   character(len=*), parameter :: WHAT_PERIOD = 'length of the step, a real > 0 [time]'
   character(len=*), parameter :: WHAT_LEAST = 'least increment, a real > 0 and not longer than the first [time]'
   character(len=*), parameter :: WHAT_GREATEST = 'greatest increment, a real not less than the first [time]'
   character(len=*), parameter :: WHAT_MOST = 'most increments of the step, an integer >= 1'
   character(len=*), parameter :: WHAT_EVERY = 'increments between two restart files, an integer >= 1'

contains

   !> The steps, with nothing in them yet; one at least.
   subroutine build_steps(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      allocate (context%model%steps(max(1_ip, maxval(context%deck%cards(:context%deck%n_cards)%step))))
      do i = 1, size(context%model%steps, kind=ip)
         context%model%steps(i)%title = ''
      end do
      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i), step => context%model%steps(max(1_ip, context%deck%cards(i)%step)))
            select case (keyword_name(card))
            case ('STEP')
               call read_step_card(context%deck, card, step)
            case ('STATIC')
               call read_static_card(context%deck, i, step%increments)
            case ('RESTART')
               call read_restart_card(context%deck, card, context%model)
            end select
         end associate
      end do
   end subroutine build_steps

   subroutine read_step_card(deck, card, step)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(step_t), intent(inout) :: step
      integer(ip) :: k
      logical :: found

      step%at_once = option_word(deck, card, 'AMPLITUDE') == 'STEP'
      call option_integer(deck, card, 'INC', WHAT_MOST, step%increments%most, found)
      if (found .and. step%increments%most < 1) call refuse_option(deck, card, 'INC', WHAT_MOST)
      do k = card%first_line, card%first_line + card%n_lines - 1
         if (k > card%first_line) step%title = step%title//' '
         step%title = step%title//line_text(deck, deck%lines(k))
      end do
   end subroutine read_step_card

   subroutine refuse_option(deck, card, name, what)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: name, what
      type(option_t) :: option
      logical :: found

      call find_option(deck, card, name, option, found)
      call report_error(deck, option%value, 'E-VALUE', name//' = '//token_text(deck, option%value)//' is out of range', &
                        expected=what, keyword=keyword_name(card))
   end subroutine refuse_option

   !> A whole line, its commas, too.
   pure function line_text(deck, line) result(text)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      character(len=:), allocatable :: text
      type(token_t) :: whole, last

      text = ''
      if (line%n_tokens == 0) return
      whole = line_item(deck, line, 1_ip)
      last = last_item(deck, line)
      whole%last = last%last
      text = token_text(deck, whole)
   end function line_text

   !> Without a data line the step is one increment, which is not cut.
   subroutine read_static_card(deck, i, increments)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i                     !< the card
      type(increments_t), intent(inout) :: increments
      integer(ip) :: k

      associate (card => deck%cards(i))
         do k = 1, i - 1
            if (keyword_name(deck%cards(k)) /= 'STATIC' .or. deck%cards(k)%step /= card%step .or. .not. card%ok) cycle
            call report_error(deck, card%place, 'E-TWICE', 'the step has two *STATIC, the first in '// &
                              place_text(deck, deck%cards(k)%place, card%place), expected='one *STATIC in a step', &
                              keyword='STATIC')
            return
         end do
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
      logical :: ok(4)

      associate (this => increments)
         call get_real(deck, line_item(deck, line, 2_ip), WHAT_PERIOD, this%period, ok(2), 1.0_wp, 'STATIC')
         if (ok(2)) call check_time(deck, line, 2_ip, this%period > 0.0_wp, this%period, WHAT_PERIOD, ok(2))
         call get_real(deck, line_item(deck, line, 1_ip), WHAT_INITIAL, this%initial, ok(1), this%period, 'STATIC')
         if (all(ok(:2))) call check_time(deck, line, 1_ip, this%initial > 0.0_wp .and. this%initial <= this%period, &
                                          this%initial, WHAT_INITIAL, ok(1))
         if (.not. all(ok(:2))) return
         if (is_direct) then
            call check_direct(deck, line)
            this%least = this%initial
            this%greatest = this%initial
            return
         end if
         call get_real(deck, line_item(deck, line, 3_ip), WHAT_LEAST, this%least, ok(3), min(this%initial, &
                                                                                             LEAST_PART*this%period), 'STATIC')
         if (ok(3)) call check_time(deck, line, 3_ip, this%least > 0.0_wp .and. this%least <= this%initial, this%least, &
                                    WHAT_LEAST, ok(3))
         call get_real(deck, line_item(deck, line, 4_ip), WHAT_GREATEST, this%greatest, ok(4), this%initial, 'STATIC')
         if (ok(4)) call check_time(deck, line, 4_ip, this%greatest >= this%initial, this%greatest, WHAT_GREATEST, ok(4))
      end associate
   end subroutine read_times

   subroutine check_time(deck, line, item, in_range, time, what, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: item
      logical, intent(in) :: in_range
      real(wp), intent(in) :: time
      character(len=*), intent(in) :: what
      logical, intent(out) :: ok

      ok = in_range
      if (.not. ok) call report_error(deck, line_item(deck, line, item), 'E-VALUE', to_text(time)//' is out of range', &
                                      expected=what, keyword='STATIC')
   end subroutine check_time

   !> DIRECT: all increments are like the first.
   subroutine check_direct(deck, line)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip) :: i

      do i = 3, line%n_tokens
         if (is_empty_token(line_item(deck, line, i))) cycle
         call report_error(deck, line_item(deck, line, i), 'E-ITEMS', 'with DIRECT all increments are like the first', &
                           expected='first increment, length of the step [time]', keyword='STATIC')
         return
      end do
   end subroutine check_direct

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
                           expected='atrito --restart FILE, with the whole deck', keyword='RESTART')
         return
      else if (.not. has_option(deck, card, 'WRITE')) then
         call report_error(deck, card%place, 'E-OPTION-MISSING', '*RESTART needs the option WRITE', &
                           expected='*RESTART, WRITE; to go on: atrito --restart FILE', keyword='RESTART')
         return
      end if
      model%restart_every = 1
      call option_integer(deck, card, 'FREQUENCY', WHAT_EVERY, model%restart_every, found)
      if (found .and. model%restart_every < 1) call refuse_option(deck, card, 'FREQUENCY', WHAT_EVERY)
   end subroutine read_restart_card

   !> Begins with what a step holds.
   subroutine open_step(context, number)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: number
      integer(ip) :: i

      context%open%number = number
      context%open%first_token = 0
      context%open%amplitude = 0
      if (number == 1) return
      context%open%first_token = huge(1_ip)
      do i = 1, context%deck%n_cards
         if (context%deck%cards(i)%step /= number .or. context%deck%cards(i)%n_lines == 0) cycle
         context%open%first_token = context%deck%lines(context%deck%cards(i)%first_line)%first_token
         return
      end do
   end subroutine open_step

end module atrito_build_steps
