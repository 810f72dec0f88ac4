# Makes module funit: the assertions, and by name alone all else that pFUnit 4.14's module FUnit exports (its own,
# and those of FUnit_Core, PF_Assert and fHamcrest). A test module that has a procedure of such a name
# compiles with neither.
set(types
   Test TestSuite TestMethod TestResult TestRunner BaseTestRunner RemoteRunner RobustRunner TestListener TestListenerVector
   ListenerPointer ResultPrinter XmlPrinter DebugListener TapListener NameFilter TestCase AbstractTestParameter
   ParameterizedTestCase ParallelContext SerialContext Expectation Subject Predicate WasCalled WasNotCalled WasCalledOnce
   TestAnnotation StringTestAnnotationMap TimeoutAnnotation
   MatcherDescription StringDescription AbstractMatcher Is IsNot IsEqual IsGreater IsTrueOrFalse IsNear IsRelativelyNear AnyOf
   AllOf Every StringContains StringStartsWith StringEndsWith IsArrayWithSize Matchable)
set(procedures
   initialize run generic_run finalize get_context stub LoadTests_interface throw catch catchNext
   assertExceptionRaised assertSameShape assertAny assertAll assertNone assertNotAll assertRelMinEqual assertApprox
   assert_that is not equal_to greater_than greater_than_or_equal_to less_than less_than_or_equal_to true false near
   relatively_near any_of all_of every_item contains_string starts_with ends_with array_with_size empty_array)
set(constants Disable IGNORE_ALL IGNORE_DIFFERENCES)

set(text "")
foreach(name IN LISTS types)
   string(APPEND text "   type :: ${name}\n   end type ${name}\n")
endforeach()
# Generic names, so that `is` may be a type as well and `not` stays the intrinsic function.
foreach(name IN LISTS procedures)
   string(APPEND text "   interface ${name}\n      module procedure nothing\n   end interface ${name}\n")
endforeach()
foreach(name IN LISTS constants)
   string(APPEND text "   integer, parameter :: ${name} = 0\n")
endforeach()
set(ATRITO_FUNIT ${CMAKE_CURRENT_BINARY_DIR}/funit.f90)
file(CONFIGURE OUTPUT ${ATRITO_FUNIT} @ONLY CONTENT
"! Made by funit.cmake.
module funit
   use, intrinsic :: iso_fortran_env, only: output_unit
   use funit_assertions
   implicit none (type, external)
   private :: nothing
${text}
contains

   type(Test) function nothing(argument)
      type(Test), intent(in) :: argument
      nothing = argument
   end function nothing
end module funit
")
