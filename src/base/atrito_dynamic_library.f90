!> Routines of a shared library that is loaded while the program runs.
module atrito_dynamic_library
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_funptr, c_int, c_null_char, c_null_funptr, c_ptr
   implicit none (type, external)
   private
   public :: find_routine

   interface
      type(c_ptr) function c_dlopen(file, mode) bind(C, name='dlopen')
         import :: c_char, c_int, c_ptr
         character(kind=c_char), intent(in) :: file(*)
         integer(c_int), value :: mode
      end function c_dlopen
      type(c_funptr) function c_dlsym(library, symbol) bind(C, name='dlsym')
         import :: c_char, c_funptr, c_ptr
         type(c_ptr), value :: library
         character(kind=c_char), intent(in) :: symbol(*)
      end function c_dlsym
   end interface

   integer(c_int), parameter :: RTLD_LAZY = 1_c_int

contains

   !> A routine by the name of its symbol; null where the library cannot be loaded or has none of that name. The library stays:
   !> asking again costs next to nothing.
   type(c_funptr) function find_routine(file, symbol) result(routine)
      character(len=*), intent(in) :: file, symbol
      type(c_ptr) :: library

      routine = c_null_funptr
      library = c_dlopen(file//c_null_char, RTLD_LAZY)
      if (c_associated(library)) routine = c_dlsym(library, symbol//c_null_char)
   end function find_routine

end module atrito_dynamic_library
