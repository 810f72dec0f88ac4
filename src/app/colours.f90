!> Colours of the words that say how grave a message is, on a terminal that has them.
module atrito_colours
   use, intrinsic :: iso_c_binding, only: c_int
   use atrito_messages, only: message_t, place_of_message, severity_word, SEVERITY_NOTE
   use atrito_system, only: c_is_terminal
   implicit none (type, external)
   private
   public :: wants_colours, paint_message

   integer(c_int), parameter :: STANDARD_ERROR = 2
   character(len=*), parameter :: ESCAPE = achar(27)//'['
   !> Bold red, bold magenta and bold cyan, as compilers have them (ECMA-48).
   character(len=5), parameter :: COLOURS(SEVERITY_NOTE) = ['1;31m', '1;35m', '1;36m']

contains

   !> Standard error is a terminal, which is not a dumb one, and the user does not object: NO_COLOR, where it is set, is empty.
   logical function wants_colours()
      character(len=:), allocatable :: terminal

      wants_colours = c_is_terminal(STANDARD_ERROR) /= 0
      if (.not. wants_colours) return
      terminal = variable('TERM')
      wants_colours = len(variable('NO_COLOR')) == 0 .and. len(terminal) > 0 .and. terminal /= 'dumb'
   end function wants_colours

   !> A variable of the environment; empty where it is not set.
   function variable(name) result(value)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: value
      integer :: length

      call get_environment_variable(name, length=length)
      allocate (character(len=length) :: value)
      if (length > 0) call get_environment_variable(name, value)
   end function variable

   !> The first line of a message, the word of its severity coloured.
   function paint_message(message, line) result(painted)
      type(message_t), intent(in) :: message
      character(len=*), intent(in) :: line          !< as format_message gives it
      character(len=:), allocatable :: painted, word
      integer :: first

      word = severity_word(message%severity)
      first = len(place_of_message(message)) + 1
      painted = line(:first - 1)//ESCAPE//COLOURS(message%severity)//word//ESCAPE//'0m'//line(first + len(word):)
   end function paint_message

end module atrito_colours
