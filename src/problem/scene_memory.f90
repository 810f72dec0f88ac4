!> Whether the machine can hold the matrices of a scene, asked before they are made: a scene that is too large ends with
!> E-MEMORY and the numbers, not with the system's out-of-memory killer.
module atrito_scene_memory
   use atrito_kinds, only: ip, lp
   use atrito_memory, only: available_memory, memory_text
   use atrito_messages, only: message_t, add_message, SEVERITY_ERROR
   use atrito_status, only: status_t, STATUS_DECK
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: check_memory, check_average_memory, most_average_entries

   !> An entry of the average: its value and its column.
   integer(lp), parameter :: ENTRY_BYTES = 12_lp

contains

   !> Refuses, by STATUS_DECK and an error, a scene that needs more than there is: more than the limit that was asked for,
   !> or than the machine has free with what the process has already.
   subroutine check_memory(deck_path, what, needed, limit, status, held)
      character(len=:), allocatable, intent(in) :: deck_path   !< a model made without a deck has none
      character(len=*), intent(in) :: what             !< e.g. 'the scene, 12 equations,'
      integer(lp), intent(in) :: needed                !< bytes
      integer(lp), intent(in) :: limit                 !< bytes; what the machine has counts where it is less
      type(status_t), intent(inout) :: status          !< unchanged, or STATUS_DECK
      integer(lp), intent(in), optional :: held        !< bytes of what is needed that are the process's already
      integer(lp) :: memory

      memory = available_memory()
      if (present(held)) memory = memory + min(held, huge(memory) - memory)
      memory = min(limit, memory)
      if (needed > memory) call refuse(deck_path, what//' needs about '//memory_text(needed)//' of memory, there are '// &
                                       memory_text(memory), status)
   end subroutine check_memory

   !> So many entries of an average are not too many: 12 bytes each, and a number of the default kind for the last one.
   integer(lp) function most_average_entries(limit) result(most)
      integer(lp), intent(in) :: limit                 !< bytes; what the machine has counts where it is less

      most = min(min(limit, available_memory())/ENTRY_BYTES, int(huge(1_ip), lp))
   end function most_average_entries

   !> The same as check_memory of the average over contact points, before they are averaged: with n points and m
   !> neighbours of each within rho there are n m entries, which are many for a large rho. The entries must have
   !> numbers, too.
   subroutine check_average_memory(deck_path, n, entries, limit, status)
      character(len=:), allocatable, intent(in) :: deck_path !< for the message
      integer(ip), intent(in) :: n                     !< contact points
      integer(lp), intent(in) :: entries               !< of the average
      integer(lp), intent(in) :: limit                 !< bytes
      type(status_t), intent(inout) :: status          !< unchanged, or STATUS_DECK

      if (entries > int(huge(n), lp)) then
         call refuse(deck_path, 'an average over '//to_text(n)//' contact points is too large for the numbers of its entries', &
                     status)
      else
         call check_memory(deck_path, 'the average over '//to_text(n)//' contact points', ENTRY_BYTES*entries, limit, status)
      end if
   end subroutine check_average_memory

   !> Adds the message, and sets a status without a text of its own.
   subroutine refuse(deck_path, text, status)
      character(len=:), allocatable, intent(in) :: deck_path
      character(len=*), intent(in) :: text
      type(status_t), intent(inout) :: status
      type(message_t) :: message

      status%code = STATUS_DECK                        ! without a text: the message tells it
      message%severity = SEVERITY_ERROR
      message%id = 'E-MEMORY'
      if (allocated(deck_path)) message%file = deck_path
      message%text = text
      message%expected = 'a coarser mesh or fewer contact points, or a larger machine'
      call add_message(message)
   end subroutine refuse

end module atrito_scene_memory
