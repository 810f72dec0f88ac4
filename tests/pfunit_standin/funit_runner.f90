! Runs the tests of a program one by one, counts them, and prints what failed and where.
module funit_runner
   use, intrinsic :: iso_fortran_env, only: output_unit
   implicit none (type, external)
   private
   public :: SourceLocation, anyExceptions, run_test, finish_tests, fail, conformable, list_text

   type :: SourceLocation
      character(len=255) :: fileName = '<unknown file>'
      integer :: lineNumber = -1
   end type SourceLocation

   ! An assertion knows only its own place, so the state of the run is kept here.
   integer :: tests_passed = 0, tests_failed = 0, failures_of_this_test = 0
   character(len=:), allocatable :: current_test

   abstract interface
      subroutine test_procedure()
      end subroutine test_procedure
   end interface

contains

   ! As pFUnit: a failure in `before` skips the test and `after`; a failed test does not skip `after`.
   subroutine run_test(suite, name, test, before, after)
      character(len=*), intent(in) :: suite, name
      procedure(test_procedure) :: test
      procedure(test_procedure), optional :: before, after

      current_test = suite//'.'//trim(name)
      if (.not. is_selected(current_test)) return
      write (output_unit, '(a)') 'test '//current_test
      flush (output_unit) ! a test that brings the program down is then the last one named
      failures_of_this_test = 0
      if (present(before)) call before()
      if (.not. anyExceptions()) then
         call test()
         if (present(after)) call after()
      end if
      if (anyExceptions()) then
         tests_failed = tests_failed + 1
      else
         tests_passed = tests_passed + 1
      end if
   end subroutine run_test

   ! `program -f TEXT` runs the tests with TEXT in suite.name; any other argument is ignored.
   logical function is_selected(name)
      character(len=*), intent(in) :: name
      character(len=200) :: option, text

      is_selected = .true.
      if (command_argument_count() < 2) return
      call get_command_argument(1, option)
      call get_command_argument(2, text)
      if (option == '-f') is_selected = index(name, trim(text)) > 0
   end function is_selected

   subroutine finish_tests()
      if (tests_passed + tests_failed == 0) write (output_unit, '(a)') 'FAIL no test found'
      write (output_unit, '(i0, a, i0, a)') tests_passed, ' passed, ', tests_failed, ' failed'
      if (tests_failed > 0 .or. tests_passed == 0) stop 2, quiet = .true.
   end subroutine finish_tests

   logical function anyExceptions()
      anyExceptions = failures_of_this_test > 0
   end function anyExceptions

   subroutine fail(reason, message, location)
      character(len=*), intent(in) :: reason
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      type(SourceLocation) :: place
      character(len=:), allocatable :: text

      failures_of_this_test = failures_of_this_test + 1
      if (present(location)) place = location
      text = reason
      if (present(message)) text = text//'; '//trim(message)
      write (output_unit, '(5a, i0, 2a)') 'FAIL ', current_test, ' ', trim(place%fileName), ':', &
         place%lineNumber, ': ', text
   end subroutine fail

   ! An expected scalar goes with anything, else the shapes must agree.
   logical function conformable(expected, actual, message, location)
      integer, intent(in) :: expected(:), actual(:)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location

      conformable = size(expected) == 0
      if (size(expected) == size(actual)) conformable = all(max(expected, 0) == max(actual, 0))
      if (.not. conformable) call fail('shapes differ: expected '//list_text(max(expected, 0))//', actual '// &
                                       list_text(max(actual, 0)), message, location)
   end function conformable

   function list_text(list) result(text)
      integer, intent(in) :: list(:)
      character(len=:), allocatable :: text
      character(len=20) :: item
      integer :: i

      text = '['
      do i = 1, size(list)
         write (item, '(i0)') list(i)
         if (i > 1) text = text//','
         text = text//trim(item)
      end do
      text = text//']'
   end function list_text
end module funit_runner
