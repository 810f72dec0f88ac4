!> Ends in ways that a whole run does not at will: interrupt_probe MODE FOLDER. What it leaves is judged by interrupts.sh.
program interrupt_probe
   use, intrinsic :: iso_c_binding, only: c_int, c_int64_t, c_ptr, c_null_ptr, c_f_pointer
   use atrito_files, only: file_set_t, text_file_t, begin_files, open_text, put_line, close_text, commit_files
   use atrito_status, only: status_t, is_ok, STATUS_INTERNAL
   use atrito_strings, only: string_t
   use atrito_system, only: guard_interrupts, hold_interrupts, release_interrupts
   implicit none (type, external)
   integer(c_int), parameter :: SIGTERM = 15_c_int
   character(len=:), allocatable :: mode, folder
   type(file_set_t) :: set
   type(status_t) :: status
   integer(c_int) :: ignored

   interface
      integer(c_int) function c_raise(number) bind(C, name='raise')
         import :: c_int
         integer(c_int), value :: number
      end function c_raise
   end interface

   mode = argument(1)
   folder = argument(2)
   call guard_interrupts(STATUS_INTERNAL)
   call write_files(set, status)
   if (.not. is_ok(status)) stop 5, quiet = .true.
   select case (mode)
   case ('at-once')
      ignored = c_raise(SIGTERM)
   case ('put-off')                                  ! comes before the renaming and waits until after it
      call hold_interrupts()
      call hold_interrupts()
      ignored = c_raise(SIGTERM)
      call release_interrupts()
      call commit_files(set, [string_t ::], status)
      call release_interrupts()
   case ('commit')
      call commit_files(set, [string_t ::], status)
      ignored = c_raise(SIGTERM)
   case ('fault')
      call write_nowhere(c_null_ptr)
   case ('overflow')
      if (depth_of(1_c_int64_t, [1.0]) > 0) stop 1, quiet = .true.
   case ('exit')                                     ! as the run-time library does
      call end_program(1)
   end select
   stop 0, quiet = .true.

contains

   function argument(i) result(text)
      integer, intent(in) :: i
      character(len=:), allocatable :: text
      integer :: length

      call get_command_argument(i, length=length)
      allocate (character(len=length) :: text)
      call get_command_argument(i, text)
   end function argument

   subroutine write_files(set, status)
      type(file_set_t), intent(out) :: set
      type(status_t), intent(out) :: status
      type(text_file_t) :: file

      call begin_files(set, folder, status)
      if (.not. is_ok(status)) return
      call open_text(set, 'a', file)
      call put_line(file, 'new')
      call close_text(file, status)
      call open_text(set, 'b', file)
      call put_line(file, 'new')
      call close_text(file, status)
   end subroutine write_files

   subroutine write_nowhere(place)
      type(c_ptr), intent(in) :: place
      integer, pointer :: number

      call c_f_pointer(place, number)
      number = 1
   end subroutine write_nowhere

   !> Never comes to an end: every call has a larger frame of its own that the next one needs.
   recursive function depth_of(n, before) result(depth)
      integer(c_int64_t), intent(in) :: n
      real, intent(in) :: before(:)
      integer(c_int64_t) :: depth
      real :: frame(1000)

      frame = before(1) + real(n)
      depth = n
      if (frame(1) >= 0.0) depth = depth_of(n + 1, frame) + int(sum(frame), c_int64_t)
   end function depth_of

   subroutine end_program(code)
      integer, intent(in) :: code

      if (code == 1) stop 1, quiet = .true.
   end subroutine end_program

end program interrupt_probe
