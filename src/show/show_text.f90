!> What the views of --show have in common on the screen: matrices in blocks of columns, and drawings of characters.
module atrito_show_text
   use atrito_kinds, only: ip, wp
   use atrito_page, only: page_t, add_line
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: add_matrix

   integer(ip), parameter :: COLUMNS = 8             !< of a block: a terminal of 80 columns does not wrap

contains

   !> A matrix, its columns in blocks, as four decimals times a power of ten, which the title tells.
   pure subroutine add_matrix(page, title, a, first)
      type(page_t), intent(inout) :: page                !< gets the lines
      character(len=*), intent(in) :: title              !< what it is, with its dimension
      real(wp), intent(in) :: a(:, :)                    !< of any shape, finite
      character(len=*), intent(in), optional :: first(:) !< what stands before each row; left out: its number
      character(len=4 + 9*COLUMNS) :: line
      integer(ip) :: i, j, k, power

      power = 0
      if (maxval(abs(a)) > 0.0_wp) power = floor(log10(maxval(abs(a))), ip)
      call add_line(page, title//', in 1e'//to_text(power))
      do j = 1, size(a, 2, kind=ip), COLUMNS
         associate (last => min(j + COLUMNS - 1, size(a, 2, kind=ip)))
            if (size(a, 2) > COLUMNS) call add_line(page, '  columns '//to_text(j)//' to '//to_text(last))
            do i = 1, size(a, 1, kind=ip)
               line = ''
               if (present(first)) then
                  line(:4) = first(i)
               else
                  write (line(:4), '(i3)') i
               end if
               write (line(5:), '(*(f9.4))') (a(i, k)/10.0_wp**power, k=j, last)
               call add_line(page, line)
            end do
         end associate
      end do
   end subroutine add_matrix

end module atrito_show_text
