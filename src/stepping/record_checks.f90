!> What the checks of a restart file (atrito_check_found, atrito_check_start) ask of numbers, lists and texts.
module atrito_record_checks
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan
   use atrito_kinds, only: ip, wp
   use atrito_utf8, only: has_controls
   implicit none (type, external)
   private
   public :: require, is_finite, is_any_infinite, is_list, has_length, may_be, is_text, is_plain, is_same_time

   !> Round-off of times, which are sums.
   real(wp), parameter :: SAME_TIME = 1.0e-12_wp

   !> An allocated array of so many finite numbers.
   interface is_list
      module procedure is_list_of_reals, is_list_of_columns
   end interface is_list

contains

   !> Keeps the first complaint.
   pure subroutine require(wrong, condition, what)
      character(len=:), allocatable, intent(inout) :: wrong !< an earlier complaint stays
      logical, intent(in) :: condition                      !< what is asked for holds
      character(len=*), intent(in) :: what                  !< name of the record, or a few words

      if (.not. (condition .or. allocated(wrong))) wrong = what
   end subroutine require

   !> Whether two times are the same but for round-off.
   pure logical function is_same_time(one, other)
      real(wp), intent(in) :: one, other !< finite

      is_same_time = abs(one - other) <= SAME_TIME*(abs(one) + abs(other))
   end function is_same_time

   !> Whether all values are numbers, none of them infinite.
   pure logical function is_finite(values)
      real(wp), intent(in) :: values(:) !< any doubles

      is_finite = all(ieee_is_finite(values))
   end function is_finite

   !> NaN is none.
   pure logical function is_any_infinite(values)
      real(wp), intent(in) :: values(:) !< any doubles

      is_any_infinite = any(.not. (ieee_is_finite(values) .or. ieee_is_nan(values)))
   end function is_any_infinite

   pure logical function is_list_of_reals(values, n) result(is_list)
      real(wp), allocatable, intent(in) :: values(:) !< as the file has it
      integer(ip), intent(in) :: n                   !< length that it must have

      is_list = has_length(values, n)
      if (is_list) is_list = is_finite(values)
   end function is_list_of_reals

   pure logical function is_list_of_columns(values, m, n) result(is_list)
      real(wp), allocatable, intent(in) :: values(:, :) !< as the file has it
      integer(ip), intent(in) :: m, n                   !< shape that it must have
      integer(ip) :: i

      is_list = allocated(values)
      if (is_list) is_list = all(shape(values) == [m, n])
      if (.not. is_list) return
      do i = 1, n
         is_list = is_list .and. is_finite(values(:, i))
      end do
   end function is_list_of_columns

   !> Whether an allocated list is there, and has so many elements.
   pure logical function has_length(list, n)
      type(*), intent(in), optional :: list(:) !< as the file has it; one that is not allocated is absent
      integer, intent(in) :: n                 !< length that it must have

      has_length = present(list)
      if (has_length) has_length = size(list) == n
   end function has_length

   !> Whether a text is there, and is the one that the deck gives, blanks at its end included.
   pure logical function is_text(text, expected)
      character(len=:), allocatable, intent(in) :: text !< as the file has it
      character(len=*), intent(in) :: expected          !< as the deck gives it

      is_text = allocated(text)
      if (is_text) is_text = len(text) == len(expected) .and. text == expected
   end function is_text

   !> A line without control characters; what is not allocated has none.
   pure logical function is_plain(text)
      character(len=:), allocatable, intent(in) :: text !< as the file has it

      is_plain = .true.
      if (allocated(text)) is_plain = .not. has_controls(text) .and. scan(text, achar(9)//achar(10)//achar(13)) == 0
   end function is_plain

   !> Whether a list is not there, or is one of so many finite numbers (is_list).
   pure logical function may_be(values, n)
      real(wp), allocatable, intent(in) :: values(:) !< as the file has it
      integer(ip), intent(in) :: n                   !< length that it must have

      may_be = .not. allocated(values)
      if (.not. may_be) may_be = is_list(values, n)
   end function may_be

end module atrito_record_checks
