!> Loads of earlier steps whose place a line takes though they act along another direction, or about another axis: other programs
!> keep both.
module atrito_replaced_loads
   use atrito_build_context, only: build_context_t, place_text
   use atrito_propagation, only: is_of_step
   use atrito_deck, only: line_item, token_text, keyword_name
   use atrito_diagnostics, only: report_warning
   use atrito_items, only: get_real
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: same_name, upper_case
   implicit none (type, external)
   private
   public :: warn_of_replaced

   integer(ip), parameter :: LABEL_ITEM = 2, FIRST = 4, LAST = 9   !< of a line: label; direction, or point and axis

contains

   !> Tells each line of the open step that takes the place of such a load, unless another line of the step gives that again.
   subroutine warn_of_replaced(context)
      type(build_context_t), intent(in) :: context
      character(len=:), allocatable :: label
      integer(ip) :: i, old, new

      do i = 1, context%open%replaced%n
         old = context%open%replaced%lines(1, i)
         new = context%open%replaced%lines(2, i)
         label = label_of(context, new)
         if (all(label(:1) /= ['G', 'T', 'C'])) cycle  ! GRAV, TRVEC, CENTRIF
         if (is_given_again(context, old)) cycle
         associate (deck => context%deck)
            call report_warning(deck, line_item(deck, deck%lines(new), LABEL_ITEM), 'W-REPLACED', label//' takes the place of '// &
                                'that in '//place_text(deck, deck%tokens(deck%lines(old)%first_token), &
                                                       deck%tokens(deck%lines(new)%first_token))//', which acts '// &
                                trim(merge('about another axis     ', 'along another direction', label == 'CENTRIF')), &
                                expected='both lines in this step, if both are to act; OP=NEW, if not', &
                                keyword=trim(merge('DSLOAD', 'DLOAD ', label == 'TRVEC')))
         end associate
      end do
   end subroutine warn_of_replaced

   !> Whether a line of the open step has label, direction and axis of a line of an earlier one.
   logical function is_given_again(context, old) result(is_given)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: old                   !< line of the deck
      integer(ip) :: i, k

      is_given = .true.
      do i = context%open%first_card, context%open%last_card
         associate (card => context%deck%cards(i))
            if (.not. is_of_step(context, i) .or. all(keyword_name(card) /= ['DLOAD ', 'DSLOAD'])) cycle
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. context%deck%lines(k)%ok) cycle
               if (.not. same_name(label_of(context, k), label_of(context, old))) cycle
               if (acts_alike(context, k, old)) return
            end do
         end associate
      end do
      is_given = .false.
   end function is_given_again

   function label_of(context, line) result(label)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: line
      character(len=:), allocatable :: label

      label = upper_case(token_text(context%deck, line_item(context%deck, context%deck%lines(line), LABEL_ITEM)))
   end function label_of

   !> Lines of one label: the same direction, or the same point and axis.
   logical function acts_alike(context, a, b)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: a, b                  !< lines of the deck
      real(wp), parameter :: SAME = 1.0e-9_wp
      real(wp) :: x(FIRST:LAST, 2), size_of
      integer(ip) :: lines(2), i, k
      logical :: ok

      lines = [a, b]
      do k = 1, 2
         do i = FIRST, LAST
            call get_real(context%deck, line_item(context%deck, context%deck%lines(lines(k)), i), 'a real', x(i, k), ok, 0.0_wp)
         end do
         do i = FIRST, LAST, 3
            if (i == FIRST .and. label_of(context, a) == 'CENTRIF') cycle  ! a point
            size_of = norm2(x(i:i + 2, k))
            if (size_of > 0.0_wp) x(i:i + 2, k) = x(i:i + 2, k)/size_of
         end do
      end do
      acts_alike = .true.
      do i = FIRST, LAST, 3
         associate (part => x(i:i + 2, :))
            acts_alike = acts_alike .and. maxval(abs(part(:, 1) - part(:, 2))) <= SAME*maxval(abs(part))
         end associate
      end do
   end function acts_alike

end module atrito_replaced_loads
