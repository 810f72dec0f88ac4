!> Tells which mutation was at work when the program is stopped by a signal (a crash, or the alarm of the watchdog), or by the
!> run-time library.
module fuzz_watch
   use, intrinsic :: iso_c_binding, only: c_char, c_funloc, c_funptr, c_int, c_long, c_null_funptr, c_size_t
   implicit none (type, external)
   private
   public :: begin_watch, watch_mutation, end_watch

   integer, parameter :: LENGTH = 200
   ! a handler has no arguments of its own: the only state of the fuzzer
   character(kind=c_char, len=LENGTH) :: label = ' '
   logical :: at_work = .false.

   interface
      type(c_funptr) function c_signal(number, handler) bind(C, name='signal')
         import :: c_funptr, c_int
         integer(c_int), value :: number
         type(c_funptr), value :: handler
      end function c_signal
      integer(c_int) function c_raise(number) bind(C, name='raise')
         import :: c_int
         integer(c_int), value :: number
      end function c_raise
      integer(c_int) function c_alarm(seconds) bind(C, name='alarm')
         import :: c_int
         integer(c_int), value :: seconds
      end function c_alarm
      integer(c_int) function c_atexit(handler) bind(C, name='atexit')
         import :: c_funptr, c_int
         type(c_funptr), value :: handler
      end function c_atexit
      integer(c_long) function c_write(descriptor, text, n) bind(C, name='write')
         import :: c_char, c_int, c_long, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: text(*)
         integer(c_size_t), value :: n
      end function c_write
   end interface

contains

   !> From now on the end of the program is told.
   subroutine begin_watch()
      integer(c_int), parameter :: SIGNALS(7) = [4_c_int, 6_c_int, 7_c_int, 8_c_int, 11_c_int, 14_c_int, 15_c_int]
      type(c_funptr) :: previous
      integer(c_int) :: ignored
      integer :: i

      do i = 1, size(SIGNALS)      ! ILL ABRT BUS FPE SEGV ALRM TERM
         previous = c_signal(SIGNALS(i), c_funloc(tell_signal))
      end do
      ignored = c_atexit(c_funloc(tell_exit))
   end subroutine begin_watch

   !> A mutation begins; it has some seconds.
   subroutine watch_mutation(text, seconds)
      character(len=*), intent(in) :: text
      integer, intent(in) :: seconds
      integer(c_int) :: ignored

      label = text
      at_work = .true.
      ignored = c_alarm(int(seconds, c_int))
   end subroutine watch_mutation

   !> None is at work any more.
   subroutine end_watch()
      integer(c_int) :: ignored

      at_work = .false.
      ignored = c_alarm(0_c_int)
   end subroutine end_watch

   subroutine tell(what)
      character(len=*), intent(in) :: what
      integer(c_long) :: ignored
      character(kind=c_char, len=LENGTH + 40) :: text

      text = what//': '//label
      text(len(text):) = achar(10)
      ignored = c_write(2_c_int, text, len(text, kind=c_size_t))
   end subroutine tell

   subroutine tell_signal(number) bind(C)
      integer(c_int), value :: number
      type(c_funptr) :: previous
      integer(c_int), parameter :: SIGALRM = 14_c_int
      type(c_funptr) :: default_action
      integer(c_int) :: ignored

      call tell(merge('HANGS  ', 'STOPPED', number == SIGALRM))
      at_work = .false.
      default_action = c_null_funptr
      previous = c_signal(number, default_action)
      ignored = c_raise(number)
   end subroutine tell_signal

   subroutine tell_exit() bind(C)
      if (at_work) call tell('LEFT')
   end subroutine tell_exit

end module fuzz_watch
