! The assertions of pFUnit 4.14 that the tests use, with its names and its order of arguments;
! README.md says where they are narrower.
!
! Numbers arrive with assumed rank and are compared as flat arrays, so one procedure a type serves
! every rank. A NaN is looked for before any comparison, since < and <= of a NaN raise the invalid
! flag and would stop a program that runs with -ffpe-trap.
module funit_assertions
   use, intrinsic :: iso_fortran_env, only: int32, int64, real64
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_is_finite
   use funit_runner, only: SourceLocation, anyExceptions, run_test, finish_tests, fail, conformable, list_text
   implicit none (type, external)
   private
   public :: SourceLocation, anyExceptions, run_test, finish_tests
   public :: WhitespaceOptions, TRIM_ALL, KEEP_ALL
   public :: assertFail, assertTrue, assertFalse, assertEqual, assertNotEqual, assertRelativelyEqual
   public :: assertLessThan, assertLessThanOrEqual, assertGreaterThan, assertGreaterThanOrEqual
   public :: assertIsNaN, assertIsFinite

   type :: WhitespaceOptions
      integer :: value
   end type WhitespaceOptions
   type(WhitespaceOptions), parameter :: TRIM_ALL = WhitespaceOptions(1), KEEP_ALL = WhitespaceOptions(2)

   interface assertTrue
      module procedure true_scalar, true_array
   end interface
   interface assertFalse
      module procedure false_scalar, false_array
   end interface
   interface assertEqual
      module procedure equal_real, equal_int32, equal_int64, equal_int32_int64, equal_logical
      module procedure equal_string, equal_string_to_strings, equal_strings
   end interface
   interface assertNotEqual
      module procedure not_equal_real, not_equal_integer
   end interface
   interface assertLessThan
      module procedure less_real, less_integer
   end interface
   interface assertLessThanOrEqual
      module procedure at_most_real, at_most_integer
   end interface
   interface assertGreaterThan
      module procedure greater_real, greater_integer
   end interface
   interface assertGreaterThanOrEqual
      module procedure at_least_real, at_least_integer
   end interface

contains

   ! ---- conditions

   subroutine assertFail(message, location)
      character(len=*), intent(in) :: message
      type(SourceLocation), intent(in), optional :: location
      call fail('assertFail', message, location)
   end subroutine assertFail

   subroutine true_scalar(condition, message, location)
      logical, intent(in) :: condition
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      if (.not. condition) call fail('expected true, found false', message, location)
   end subroutine true_scalar

   subroutine true_array(condition, message, location)
      logical, intent(in) :: condition(:)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      if (.not. all(condition)) call fail('expected true, found false at index '// &
                                          list_text(findloc(condition, .false.)), message, location)
   end subroutine true_array

   subroutine false_scalar(condition, message, location)
      logical, intent(in) :: condition
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      if (condition) call fail('expected false, found true', message, location)
   end subroutine false_scalar

   subroutine false_array(condition, message, location)
      logical, intent(in) :: condition(:)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      if (any(condition)) call fail('expected false, found true at index '// &
                                    list_text(findloc(condition, .true.)), message, location)
   end subroutine false_array

   subroutine assertIsNaN(x, message, location)
      real(real64), intent(in) :: x
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      if (.not. ieee_is_nan(x)) call fail('expected NaN, found <'//real_text(x)//'>', message, location)
   end subroutine assertIsNaN

   subroutine assertIsFinite(x, message, location)
      real(real64), intent(in) :: x
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      if (.not. ieee_is_finite(x)) call fail('expected a finite number, found <'//real_text(x)//'>', message, location)
   end subroutine assertIsFinite

   ! ---- reals

   subroutine compare_real(a, shape_a, relation, b, shape_b, tolerance, message, location)
      real(real64), intent(in) :: a(:), b(:)
      integer, intent(in) :: shape_a(:), shape_b(:)
      character(len=*), intent(in) :: relation
      real(real64), intent(in), optional :: tolerance
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      real(real64) :: limit
      integer :: i

      if (.not. conformable(shape_a, shape_b, message, location)) return
      limit = 0.0_real64
      if (present(tolerance)) limit = tolerance
      do i = 1, size(b)
         associate (x => a(min(i, size(a))), y => b(i))
            if (holds_real(x, relation, y, limit)) cycle
            call fail('<'//real_text(x)//'> '//relation//' <'//real_text(y)//'> is false, tolerance <'// &
                      real_text(limit)//'>'//at_index(i, shape_b), message, location)
         end associate
         return
      end do
   end subroutine compare_real

   ! gfortran 12 passes an empty expression as if it were of assumed size, with an extent of -1 (sizes
   ! in `conformable` allow for it). Nothing else can come as rank (*) here.
   function flat_real(array) result(flat)
      real(real64), intent(in) :: array(..)
      real(real64), allocatable :: flat(:)

      select rank (array)
      rank (0)
         flat = [array]
      rank (1)
         flat = array
      rank (2)
         flat = reshape(array, [size(array)])
      rank (*)
         flat = [real(real64) ::]
      rank default
         error stop 'funit: an assertion on an array of more than two dimensions'
      end select
   end function flat_real

   ! Equality comes before the difference, which is invalid for two equal infinities. As in pFUnit
   ! nothing is relatively equal to zero.
   pure logical function holds_real(a, relation, b, tolerance) result(holds)
      character(len=*), intent(in) :: relation
      real(real64), intent(in) :: a, b, tolerance

      holds = .false.
      if (ieee_is_nan(a) .or. ieee_is_nan(b) .or. ieee_is_nan(tolerance)) return
      select case (relation)
      case ('==', '/=')
         holds = .not. (a < b .or. a > b)
         if (.not. holds) holds = abs(b - a) <= tolerance
         if (relation == '/=') holds = .not. holds
      case ('relatively ==')
         if (abs(a) > 0.0_real64 .and. ieee_is_finite(a)) holds = abs(b - a) <= tolerance*abs(a)
      case ('<')
         holds = a < b + tolerance
      case ('<=')
         holds = a <= b + tolerance
      case ('>')
         holds = a > b - tolerance
      case ('>=')
         holds = a >= b - tolerance
      end select
   end function holds_real

   subroutine equal_real(expected, actual, tolerance, message, location)
      real(real64), intent(in) :: expected(..), actual(..)
      real(real64), intent(in), optional :: tolerance
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_real(flat_real(expected), shape(expected), '==', flat_real(actual), shape(actual), tolerance, message, location)
   end subroutine equal_real

   subroutine assertRelativelyEqual(expected, actual, tolerance, message, location)
      real(real64), intent(in) :: expected(..), actual(..), tolerance
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_real(flat_real(expected), shape(expected), 'relatively ==', flat_real(actual), shape(actual), &
                        tolerance, message, location)
   end subroutine assertRelativelyEqual

   subroutine not_equal_real(expected, actual, tolerance, message, location)
      real(real64), intent(in) :: expected(..), actual(..)
      real(real64), intent(in), optional :: tolerance
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_real(flat_real(expected), shape(expected), '/=', flat_real(actual), shape(actual), tolerance, message, location)
   end subroutine not_equal_real

   subroutine less_real(lhs, rhs, tolerance, message, location)
      real(real64), intent(in) :: lhs(..), rhs(..)
      real(real64), intent(in), optional :: tolerance
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_real(flat_real(lhs), shape(lhs), '<', flat_real(rhs), shape(rhs), tolerance, message, location)
   end subroutine less_real

   subroutine at_most_real(lhs, rhs, tolerance, message, location)
      real(real64), intent(in) :: lhs(..), rhs(..)
      real(real64), intent(in), optional :: tolerance
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_real(flat_real(lhs), shape(lhs), '<=', flat_real(rhs), shape(rhs), tolerance, message, location)
   end subroutine at_most_real

   subroutine greater_real(lhs, rhs, tolerance, message, location)
      real(real64), intent(in) :: lhs(..), rhs(..)
      real(real64), intent(in), optional :: tolerance
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_real(flat_real(lhs), shape(lhs), '>', flat_real(rhs), shape(rhs), tolerance, message, location)
   end subroutine greater_real

   subroutine at_least_real(lhs, rhs, tolerance, message, location)
      real(real64), intent(in) :: lhs(..), rhs(..)
      real(real64), intent(in), optional :: tolerance
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_real(flat_real(lhs), shape(lhs), '>=', flat_real(rhs), shape(rhs), tolerance, message, location)
   end subroutine at_least_real

   ! ---- integers, widened to int64. Where `location` stands before `message`, pFUnit takes the
   ! message by keyword only, and this order makes the compiler say so.

   subroutine compare_integer(a, shape_a, relation, b, shape_b, message, location)
      integer(int64), intent(in) :: a(:), b(:)
      integer, intent(in) :: shape_a(:), shape_b(:)
      character(len=*), intent(in) :: relation
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      integer :: i

      if (.not. conformable(shape_a, shape_b, message, location)) return
      do i = 1, size(b)
         associate (x => a(min(i, size(a))), y => b(i))
            if (holds_integer(x, relation, y)) cycle
            call fail('<'//integer_text(x)//'> '//relation//' <'//integer_text(y)//'> is false'// &
                      at_index(i, shape_b), message, location)
         end associate
         return
      end do
   end subroutine compare_integer

   pure logical function holds_integer(a, relation, b) result(holds)
      character(len=*), intent(in) :: relation
      integer(int64), intent(in) :: a, b

      holds = .false.
      select case (relation)
      case ('==')
         holds = a == b
      case ('/=')
         holds = a /= b
      case ('<')
         holds = a < b
      case ('<=')
         holds = a <= b
      case ('>')
         holds = a > b
      case ('>=')
         holds = a >= b
      end select
   end function holds_integer

   function flat_int32(array) result(flat)
      integer(int32), intent(in) :: array(..)
      integer(int64), allocatable :: flat(:)

      select rank (array)
      rank (0)
         flat = [int(array, int64)]
      rank (1)
         flat = int(array, int64)
      rank (2)
         flat = reshape(int(array, int64), [size(array)])
      rank (*)
         flat = [integer(int64) ::]
      rank default
         error stop 'funit: an assertion on an array of more than two dimensions'
      end select
   end function flat_int32

   function flat_int64(array) result(flat)
      integer(int64), intent(in) :: array(..)
      integer(int64), allocatable :: flat(:)

      select rank (array)
      rank (0)
         flat = [array]
      rank (1)
         flat = array
      rank (2)
         flat = reshape(array, [size(array)])
      rank (*)
         flat = [integer(int64) ::]
      rank default
         error stop 'funit: an assertion on an array of more than two dimensions'
      end select
   end function flat_int64

   subroutine equal_int32(expected, actual, message, location)
      integer(int32), intent(in) :: expected(..), actual(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_integer(flat_int32(expected), shape(expected), '==', flat_int32(actual), shape(actual), message, location)
   end subroutine equal_int32

   subroutine equal_int64(expected, actual, message, location)
      integer(int64), intent(in) :: expected(..), actual(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_integer(flat_int64(expected), shape(expected), '==', flat_int64(actual), shape(actual), message, location)
   end subroutine equal_int64

   subroutine equal_int32_int64(expected, actual, message, location)
      integer(int32), intent(in) :: expected(..)
      integer(int64), intent(in) :: actual(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_integer(flat_int32(expected), shape(expected), '==', flat_int64(actual), shape(actual), message, location)
   end subroutine equal_int32_int64

   subroutine not_equal_integer(expected, actual, location, message)
      integer(int32), intent(in) :: expected(..), actual(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_integer(flat_int32(expected), shape(expected), '/=', flat_int32(actual), shape(actual), message, location)
   end subroutine not_equal_integer

   subroutine less_integer(lhs, rhs, location, message)
      integer(int32), intent(in) :: lhs(..), rhs(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_integer(flat_int32(lhs), shape(lhs), '<', flat_int32(rhs), shape(rhs), message, location)
   end subroutine less_integer

   subroutine at_most_integer(lhs, rhs, location, message)
      integer(int32), intent(in) :: lhs(..), rhs(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_integer(flat_int32(lhs), shape(lhs), '<=', flat_int32(rhs), shape(rhs), message, location)
   end subroutine at_most_integer

   subroutine greater_integer(lhs, rhs, location, message)
      integer(int32), intent(in) :: lhs(..), rhs(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_integer(flat_int32(lhs), shape(lhs), '>', flat_int32(rhs), shape(rhs), message, location)
   end subroutine greater_integer

   subroutine at_least_integer(lhs, rhs, location, message)
      integer(int32), intent(in) :: lhs(..), rhs(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_integer(flat_int32(lhs), shape(lhs), '>=', flat_int32(rhs), shape(rhs), message, location)
   end subroutine at_least_integer

   ! ---- logicals and strings

   subroutine equal_logical(expected, actual, location, message)
      logical, intent(in) :: expected(..), actual(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      call compare_integer(flat_logical(expected), shape(expected), '==', flat_logical(actual), shape(actual), message, location)
   end subroutine equal_logical

   function flat_logical(array) result(flat)
      logical, intent(in) :: array(..)
      integer(int64), allocatable :: flat(:)

      select rank (array)
      rank (0)
         flat = [merge(1_int64, 0_int64, array)]
      rank (1)
         flat = merge(1_int64, 0_int64, array)
      rank (2)
         flat = reshape(merge(1_int64, 0_int64, array), [size(array)])
      rank (*)
         flat = [integer(int64) ::]
      rank default
         error stop 'funit: an assertion on an array of more than two dimensions'
      end select
   end function flat_logical

   ! pFUnit's default: blanks and tabs at both ends do not count. KEEP_ALL compares to the letter.
   subroutine equal_string(expected, found, message, location, whitespace)
      character(len=*), intent(in) :: expected, found
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      type(WhitespaceOptions), intent(in), optional :: whitespace
      logical :: equal

      equal = trimmed(expected) == trimmed(found)
      if (present(whitespace)) then
         if (whitespace%value == KEEP_ALL%value) equal = expected == found .and. len(expected) == len(found)
      end if
      if (.not. equal) call fail('expected <'//expected//'>, found <'//found//'>', message, location)
   end subroutine equal_string

   subroutine equal_string_to_strings(expected, found, message, location, whitespace)
      character(len=*), intent(in) :: expected, found(:)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      type(WhitespaceOptions), intent(in), optional :: whitespace
      integer :: i

      do i = 1, size(found)
         call equal_string(expected, found(i), message, location, whitespace)
      end do
   end subroutine equal_string_to_strings

   subroutine equal_strings(expected, found, message, location, whitespace)
      character(len=*), intent(in) :: expected(:), found(:)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      type(WhitespaceOptions), intent(in), optional :: whitespace
      integer :: i

      if (.not. conformable(shape(expected), shape(found), message, location)) return
      do i = 1, size(found)
         call equal_string(expected(i), found(i), message, location, whitespace)
      end do
   end subroutine equal_strings

   pure function trimmed(text)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: trimmed
      integer :: first

      first = max(1, verify(text, ' '//achar(9)))
      trimmed = text(first:verify(text, ' '//achar(9), back=.true.))
   end function trimmed

   ! ---- text of numbers

   pure function real_text(x) result(text)
      real(real64), intent(in) :: x
      character(len=:), allocatable :: text
      character(len=30) :: buffer

      write (buffer, '(g0)') x
      text = trim(buffer)
   end function real_text

   pure function integer_text(i) result(text)
      integer(int64), intent(in) :: i
      character(len=:), allocatable :: text
      character(len=30) :: buffer

      write (buffer, '(i0)') i
      text = trim(buffer)
   end function integer_text

   ! Where the i-th element of an array of the given extents stands; nothing for a scalar.
   function at_index(i, extents) result(text)
      integer, intent(in) :: i, extents(:)
      character(len=:), allocatable :: text
      integer :: subscripts(size(extents)), rest, k

      text = ''
      if (size(extents) == 0) return
      rest = i - 1
      do k = 1, size(extents)
         subscripts(k) = mod(rest, extents(k)) + 1
         rest = rest/extents(k)
      end do
      text = ' at index '//list_text(subscripts)
   end function at_index
end module funit_assertions
