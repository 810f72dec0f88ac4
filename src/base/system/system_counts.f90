!> Numbers that Linux tells in text files: a line is a label and the number behind it.
module atrito_system_counts
   use atrito_files, only: read_system_line
   use atrito_kinds, only: lp
   implicit none (type, external)
   private
   public :: count_of, UNLIMITED

   !> What is said where the system does not tell, or sets no limit.
   integer(lp), parameter :: UNLIMITED = huge(1_lp)

contains

   !> The number that follows a label at the beginning of a line of a file; UNLIMITED where there is none.
   integer(lp) function count_of(path, label, unit) result(bytes)
      character(len=*), intent(in) :: path, label      !< of the file; with which the line begins
      integer(lp), intent(in) :: unit                  !< bytes
      character(len=:), allocatable :: line
      character(len=*), parameter :: BLANKS = ' '//achar(9)  ! a tab follows the labels of /proc/self/status
      logical :: found

      bytes = UNLIMITED
      call read_system_line(path, label, line, found)
      if (.not. found) return
      line = line(len(label) + 1:)
      line = line(max(verify(line, BLANKS), 1):)
      if (verify(line(:min(1, len(line))), '0123456789') > 0 .or. len(line) == 0) return
      bytes = unit*leading_number(line)
   end function count_of

   !> The number that a text begins with; 0 where it does not.
   pure integer(lp) function leading_number(text) result(number)
      character(len=*), intent(in) :: text
      integer :: i, d

      number = 0_lp
      do i = 1, min(len(text), 15)
         d = iachar(text(i:i)) - iachar('0')
         if (d < 0 .or. d > 9) exit
         number = 10_lp*number + int(d, lp)
      end do
   end function leading_number

end module atrito_system_counts
