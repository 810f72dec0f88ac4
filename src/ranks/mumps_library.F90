!> The library of MUMPS: its one routine and the type of its argument.
!>
!> It is loaded when it is asked for, not with the program: starting would cost a millisecond more for it and for what it needs, and
!> most scenes do without. CMake says which file that is (ATRITO_MUMPS_LIBRARY, its name with the version in it) and which version
!> the header has whose dmumps_struc is compiled in (ATRITO_MUMPS_VERSION).
!>
!> There are two such files of one version: the sequential one, with an MPI of its own that does nothing, for the plain program, and
!> that for ranks (ATRITO_MUMPS_RANKS_LIBRARY). A process may never have both, whose MPI would be that of the first: the program
!> with ranks takes the second one for the bodies of a single rank as well.
module atrito_mumps_library
   use, intrinsic :: iso_c_binding, only: c_associated, c_f_procpointer, c_funptr
   use atrito_mpi, only: has_mpi, own_communicator
   use atrito_halting, only: halting_t, suspend_halting, restore_halting
   use atrito_kinds, only: ip
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   use atrito_strings, only: to_text
   use atrito_system, only: find_routine
   implicit none (type, external)
   private
   public :: dmumps_struc, begin_mumps, run_mumps, has_mumps, mumps_name, mumps_trouble, mumps_failure

   include 'dmumps_struc.h'

   abstract interface
      subroutine call_mumps(instance)
         import :: dmumps_struc
         type(dmumps_struc), intent(inout) :: instance
      end subroutine call_mumps
   end interface

   integer, parameter :: BEGIN = -1              ! JOB
   integer, parameter :: NO_MEMORY = -13         ! INFOG(1)

contains

   !> Whether the library can be loaded.
   logical function has_mumps()
      procedure(call_mumps), pointer :: mumps

      call load_mumps(mumps)
      has_mumps = associated(mumps)
   end function has_mumps

   !> For the listing: 'MUMPS 5.5.1'.
   pure function mumps_name() result(name)
      character(len=:), allocatable :: name

      name = 'MUMPS '//ATRITO_MUMPS_VERSION
   end function mumps_name

   !> Why there is no MUMPS, where there is none.
   pure function mumps_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'the library '//library_file()//' cannot be loaded'
   end function mumps_trouble

   !> What is loaded.
   pure function library_file() result(file)
      character(len=:), allocatable :: file

      file = ATRITO_MUMPS_LIBRARY
      if (has_mpi()) file = ATRITO_MUMPS_RANKS_LIBRARY
   end function library_file

   !> An instance for a symmetric positive definite matrix whose diagonal is about 1, of this rank alone or of all ranks, which call
   !> it together then.
   !>
   !> status: STATUS_INTERNAL: there is no library, or it is of a version whose dmumps_struc may be another one. Such an instance is
   !> left alone.
   subroutine begin_mumps(instance, status, communicator)
      type(dmumps_struc), intent(inout) :: instance
      type(status_t), intent(out) :: status
      integer, intent(in), optional :: communicator   !< of the ranks that work on it; this rank alone without it

      if (.not. has_mumps()) then
         call set_status(status, STATUS_INTERNAL, mumps_trouble())
         return
      end if
      instance%comm = own_communicator()
      if (present(communicator)) instance%comm = communicator
      instance%par = 1
      instance%sym = 1                           ! positive definite: pivots in the order of the analysis
      instance%version_number = ''
      call run_mumps(instance, BEGIN)
      if (instance%version_number /= ATRITO_MUMPS_VERSION) then
         call set_status(status, STATUS_INTERNAL, version_text(instance%version_number))
         return
      end if
      instance%icntl(1:4) = 0                    ! prints nothing
      instance%icntl(6) = 0                      ! no column permutation
      instance%icntl(7) = 0                      ! approximate minimum degree where no order is given
      instance%icntl(8) = 0                      ! scaled already
      instance%icntl(12) = 1                     ! the plain symmetric analysis
   end subroutine begin_mumps

   pure function version_text(found) result(text)
      character(len=*), intent(in) :: found
      character(len=:), allocatable :: text

      text = 'another version'
      if (verify(trim(found), '0123456789.') == 0 .and. len_trim(found) > 0) text = 'version '//trim(found)
      text = 'the library '//library_file()//' is '//text//' of MUMPS, and this program was built for '// &
             ATRITO_MUMPS_VERSION//': build it anew'
   end function version_text

   !> One call of MUMPS, which raises harmless floating-point exceptions.
   subroutine run_mumps(instance, job)
      type(dmumps_struc), intent(inout) :: instance
      integer, intent(in) :: job
      procedure(call_mumps), pointer :: mumps
      type(halting_t) :: halting

      call load_mumps(mumps)
      call suspend_halting(halting)
      instance%job = job
      call mumps(instance)
      call restore_halting(halting)
   end subroutine run_mumps

   !> Why the last call failed, in words where they are known.
   pure function mumps_failure(instance) result(text)
      type(dmumps_struc), intent(in) :: instance
      character(len=:), allocatable :: text

      associate (code => instance%infog(1:2))
         text = 'INFOG(1:2) = '//to_text(int(code(1), ip))//', '//to_text(int(code(2), ip))
         if (code(1) == NO_MEMORY) text = 'not enough memory ('//text//')'
      end associate
   end function mumps_failure

   !> Not associated where the library is not installed. Loading it again costs next to nothing.
   subroutine load_mumps(mumps)
      procedure(call_mumps), pointer, intent(out) :: mumps
      type(c_funptr) :: routine

      mumps => null()
      routine = find_routine(library_file(), 'dmumps_')
      if (c_associated(routine)) call c_f_procpointer(routine, mumps)
   end subroutine load_mumps

end module atrito_mumps_library
