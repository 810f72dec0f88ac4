!> A text that grows at its end: `text = text//more` copies all of it each time, which a text of a million pieces does not bear.
module atrito_growing_text
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: growing_text_t, append_text, take_text

   type :: growing_text_t
      integer(ip) :: n = 0                              !< characters so far
      character(len=:), allocatable :: letters  !< those up to n are in use; not allocated: there is no text
   end type growing_text_t

   integer(ip), parameter :: FIRST_LENGTH = 256

contains

   !> Puts characters behind those that are there; where there is no room, it doubles.
   pure subroutine append_text(text, more)
      type(growing_text_t), intent(inout) :: text !< gets longer
      character(len=*), intent(in) :: more        !< may be empty
      character(len=:), allocatable :: longer
      integer(ip) :: needed

      needed = text%n + len(more, kind=ip)
      if (.not. allocated(text%letters)) allocate (character(len=max(needed, FIRST_LENGTH)) :: text%letters)
      if (needed > len(text%letters)) then
         allocate (character(len=max(needed, 2*len(text%letters))) :: longer)
         longer(:text%n) = text%letters(:text%n)
         call move_alloc(longer, text%letters)
      end if
      text%letters(text%n + 1:needed) = more
      text%n = needed
   end subroutine append_text

   !> Gives the text away; what is left is an empty one.
   pure subroutine take_text(text, whole)
      type(growing_text_t), intent(inout) :: text         !< is empty afterwards
      character(len=:), allocatable, intent(out) :: whole !< all letters; '' of an empty text

      whole = ''
      if (text%n > 0) whole = text%letters(:text%n)
      text = growing_text_t()
   end subroutine take_text

end module atrito_growing_text
