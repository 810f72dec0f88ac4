!> Stands in for the MUMPS for ranks: it does what that does, but has too little memory for the solves whose ICNTL(26) is the digit
!> in FAILING_SOLVE (1: what is kept is condensed, 2: expanded).
subroutine dmumps(instance)
   use, intrinsic :: iso_c_binding, only: c_char, c_f_procpointer, c_funptr, c_int, c_null_char, c_ptr
   implicit none (type, external)
   include 'dmumps_struc.h'
   type(dmumps_struc), intent(inout) :: instance
   integer(c_int), parameter :: RTLD_LAZY = 1
   integer, parameter :: SOLVE = 3, NO_MEMORY = -13
   character(len=*), parameter :: FILE = &
      REAL_MUMPS
   character :: failing

   abstract interface
      subroutine call_mumps(instance)
         import :: dmumps_struc
         type(dmumps_struc), intent(inout) :: instance
      end subroutine call_mumps
   end interface
   interface
      function dlopen(file, flags) bind(c) result(library)
         import :: c_char, c_int, c_ptr
         character(kind=c_char), intent(in) :: file(*)
         integer(c_int), value :: flags
         type(c_ptr) :: library
      end function dlopen

      function dlsym(library, symbol) bind(c) result(routine)
         import :: c_char, c_funptr, c_ptr
         type(c_ptr), value :: library
         character(kind=c_char), intent(in) :: symbol(*)
         type(c_funptr) :: routine
      end function dlsym
   end interface
   procedure(call_mumps), pointer :: mumps

   call get_environment_variable('FAILING_SOLVE', failing)
   if (instance%job == SOLVE .and. failing == achar(iachar('0') + instance%icntl(26))) then
      instance%infog(1:2) = [NO_MEMORY, 1]
      return
   end if
   call c_f_procpointer(dlsym(dlopen(FILE//c_null_char, RTLD_LAZY), 'dmumps_'//c_null_char), mumps)
   call mumps(instance)
end subroutine dmumps
