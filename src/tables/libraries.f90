!> The compiler and the libraries of this program, for the listing and `--version`.
module atrito_libraries
   use, intrinsic :: iso_fortran_env, only: compiler_version
   use atrito_blas_info, only: blas_name, is_reference_blas, lapack_version
   use atrito_clp, only: has_clp, clp_version, clp_trouble
   use atrito_multifrontal, only: has_metis, metis_version, metis_trouble
   implicit none (type, external)
   private
   public :: library_t, add_libraries, list_libraries, LOADED

   type :: library_t
      character(len=8) :: name = ''                 !< what it is, e.g. BLAS
      character(len=:), allocatable :: version      !< or why there is none
   end type library_t

   type(library_t), allocatable :: besides(:)

   character(len=*), parameter :: LOADED = ', loaded where it is used'

contains

   !> What the program itself has besides, for all lists: before any of them is made.
   subroutine add_libraries(others)
      type(library_t), intent(in) :: others(:) !< they stand behind all others

      besides = others
   end subroutine add_libraries

   !> Compiler, BLAS, LAPACK, Clp and METIS, and what the program has besides (add_libraries). A library that a run does not need is
   !> not loaded to ask for it.
   subroutine list_libraries(of_run, list, uses_metis)
      logical, intent(in) :: of_run                        !< those of a run; else what this build could use
      type(library_t), allocatable, intent(out) :: list(:) !< name and version, or why there is none
      logical, intent(in), optional :: uses_metis          !< a run does; default: no

      allocate (list(5))
      list%name = [character(len=8) :: 'compiler', 'BLAS', 'LAPACK', 'Clp', 'METIS']
      list(1)%version = compiler_version()
      list(2)%version = trim(blas_name())
      if (is_reference_blas()) list(2)%version = list(2)%version//' (the reference one, slow)'
      list(3)%version = lapack_version()
      if (of_run) then
         list(4)%version = 'not used, but where no solution is found'
         list(5)%version = 'not used'
         if (present(uses_metis)) then
            if (uses_metis) list(5)%version = metis_version()
         end if
      else
         list(4)%version = 'not used: '//clp_trouble()
         if (has_clp()) list(4)%version = clp_version()//LOADED
         list(5)%version = 'not used: '//metis_trouble()
         if (has_metis()) list(5)%version = metis_version()//LOADED
      end if
      if (allocated(besides)) list = [list, besides]
   end subroutine list_libraries

end module atrito_libraries
