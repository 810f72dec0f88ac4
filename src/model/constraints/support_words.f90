!> ENCASTRE, XSYMM, ...: words of *BOUNDARY that hold several dofs at once.
module atrito_support_words
   use atrito_deck, only: deck_t, data_line_t, token_t, token_text, line_item, is_empty_token
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, same_name
   implicit none (type, external)
   private
   public :: is_support_word, find_dofs_of_word

   integer(ip), parameter :: LAST_DOF = 6

   type :: support_word_t
      character(len=8) :: name
      logical :: holds(LAST_DOF)
   end type support_word_t

   logical, parameter :: T = .true., F = .false.
   type(support_word_t), parameter :: WORDS(8) = [ &
                                      support_word_t('ENCASTRE', [T, T, T, T, T, T]), &
                                      support_word_t('PINNED  ', [T, T, T, F, F, F]), &
                                      support_word_t('XSYMM   ', [T, F, F, F, T, T]), &
                                      support_word_t('YSYMM   ', [F, T, F, T, F, T]), &
                                      support_word_t('ZSYMM   ', [F, F, T, T, T, F]), &
                                      support_word_t('XASYMM  ', [F, T, T, T, F, F]), &
                                      support_word_t('YASYMM  ', [T, F, T, F, T, F]), &
                                      support_word_t('ZASYMM  ', [T, T, F, F, F, T])]

contains

   !> The second item of a line begins with a letter: no dof does.
   pure logical function is_support_word(deck, line)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      character(len=1) :: first
      type(token_t) :: token

      token = line_item(deck, line, 2_ip)
      is_support_word = .not. is_empty_token(token)
      if (.not. is_support_word) return
      first = deck%sources(token%source)%text(token%first:token%first)
      is_support_word = (first >= 'A' .and. first <= 'Z') .or. (first >= 'a' .and. first <= 'z')
   end function is_support_word

   !> The dofs that the word of a line holds.
   subroutine find_dofs_of_word(deck, line, holds, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      logical, intent(out) :: holds(LAST_DOF)
      logical, intent(out) :: ok
      type(string_t) :: known(size(WORDS))
      type(token_t) :: token
      integer :: i

      token = line_item(deck, line, 2_ip)
      holds = .false.
      ok = .false.
      do i = 1, size(WORDS)
         known(i)%s = trim(WORDS(i)%name)
         if (.not. same_name(token_text(deck, token), known(i)%s)) cycle
         holds = WORDS(i)%holds
         ok = .true.
      end do
      if (.not. ok) then
         call report_error(deck, token, 'E-DOF', token_text(deck, token)//' is neither a dof nor a word for several', &
                           expected='degree of freedom: 1 (x) or 2 (y), or a word: ENCASTRE and PINNED hold both, XSYMM '// &
                           'dof 1, YSYMM dof 2', known=known, keyword='BOUNDARY')
      else if (line%n_tokens > 2) then
         ok = .false.
         call report_error(deck, line_item(deck, line, 3_ip), 'E-ITEMS', 'items behind '//token_text(deck, token), &
                           expected='nothing: what a word holds is 0', keyword='BOUNDARY')
      end if
   end subroutine find_dofs_of_word

end module atrito_support_words
