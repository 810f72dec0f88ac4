!> What the user gave on the command line that changes results or tables, for the heads of tables, in a fixed order.
module atrito_given_options
   use atrito_kinds, only: wp
   use atrito_command_line, only: command_t, TASK_STUDY, TASK_LIMIT
   use atrito_number_text, only: DEFAULT_DIGITS
   use atrito_numbers, only: exact_text
   use atrito_strings, only: join, to_text
   implicit none (type, external)
   private
   public :: options_of_run, options_of_series

contains

   !> Of a run; not allocated where nothing was given that differs from what is there unasked.
   pure subroutine options_of_run(command, text)
      type(command_t), intent(in) :: command                 !< of a run, or of a series
      character(len=:), allocatable, intent(inout) :: text   !< of a series: what it does, before what its runs have in common
      integer :: i

      if (command%refine > 0) call add_option('--refine', to_text(command%refine), text)
      if (command%adapt > 0.0_wp) call add_option('--adapt', exact_text(command%adapt), text)
      if (command%starts > 0) call add_option('--unique', to_text(command%starts), text)
      if (len_trim(command%element) > 0) call add_option('--elements', trim(command%element), text)
      if (command%solver /= 'auto') call add_option('--solver', trim(command%solver), text)
      if (command%proof /= 'auto') call add_option('--proof', trim(command%proof), text)
      if (command%contact /= 'auto') call add_option('--contact', trim(command%contact), text)
      if (allocated(command%observe)) then
         do i = 1, size(command%observe)
            call add_option('--observe', command%observe(i)%s, text)
         end do
      end if
      if (allocated(command%bound)) then
         if (size(command%bound) > 0) call add_option('--bound', join(command%bound, ','), text)
      end if
      if (command%digits /= DEFAULT_DIGITS) call add_option('--digits', to_text(command%digits), text)
   end subroutine options_of_run

   !> Of a sweep, a study or a limit: what it does, then what its runs have in common.
   pure subroutine options_of_series(command, text)
      type(command_t), intent(in) :: command                 !< of a sweep, a study or a limit
      character(len=:), allocatable, intent(out) :: text     !< options, blanks between them
      type(command_t) :: fresh
      integer :: i

      do i = 1, size(command%vary)
         call add_option('--vary', command%vary(i)%s, text)
      end do
      select case (command%task)
      case (TASK_STUDY)
         call add_option('--levels', to_text(command%levels), text)
         if (size(command%elements) > 0) call add_option('--elements', join(command%elements, ','), text)
         do i = 1, size(command%references)
            call add_option('--reference', command%references(i)%s, text)
         end do
      case (TASK_LIMIT)
         if (abs(command%limit_tolerance - fresh%limit_tolerance) > 0.0_wp) then
            call add_option('--tolerance', exact_text(command%limit_tolerance), text)
         end if
         if (command%watched(1) > 0) call add_option('--watch', to_text(command%watched(1))//','//to_text(command%watched(2)), text)
      end select
      call options_of_run(command, text)
   end subroutine options_of_series

   !> A value with blanks stands in quotes, as it was given.
   pure subroutine add_option(name, value, text)
      character(len=*), intent(in) :: name, value
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: quote

      quote = ''
      if (scan(value, ' ''"') > 0) quote = '"'
      if (allocated(text)) text = text//' '
      if (.not. allocated(text)) text = ''
      text = text//name//' '//quote//value//quote
   end subroutine add_option

end module atrito_given_options
