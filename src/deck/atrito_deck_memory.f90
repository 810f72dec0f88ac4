!> Whether the machine can hold what a file will be taken apart into, asked before it is.
module atrito_deck_memory
   use atrito_deck, only: deck_t
   use atrito_diagnostics, only: report_deck_error
   use atrito_kinds, only: ip, lp
   use atrito_memory, only: available_memory, memory_text
   use atrito_strings, only: to_text, count_symbol
   implicit none (type, external)
   private
   public :: fits_memory

   !> What an item or a line takes at the most, the lists of them being copied as they double.
   integer(lp), parameter :: ITEM_BYTES = 100_lp
   !> A smaller file is not worth the question.
   integer(ip), parameter :: SMALL_FILE = 1000000

contains

   !> False, and an error, when the items of a file need more memory than there is.
   logical function fits_memory(deck, source) result(fits)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: source
      integer(lp) :: items, memory

      fits = len(deck%sources(source)%text) <= SMALL_FILE
      if (fits) return
      items = count_symbol(deck%sources(source)%text, ',') + count_symbol(deck%sources(source)%text, achar(10))
      memory = available_memory()
      fits = ITEM_BYTES*items <= memory
      if (.not. fits) call report_deck_error(deck, 'E-MEMORY', 'a file of '//to_text(items)//' items and lines needs about '// &
                                             memory_text(ITEM_BYTES*items)//' of memory, there are '//memory_text(memory), &
                                             expected='a smaller deck, or a larger machine; *BLOCK, *NGEN and *ELGEN save lines', &
                                             source=source)
   end function fits_memory

end module atrito_deck_memory
