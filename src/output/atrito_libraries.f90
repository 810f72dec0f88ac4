!> The compiler and the libraries of this program, for the listing and `--version`.
module atrito_libraries
   use, intrinsic :: iso_fortran_env, only: compiler_version
   use atrito_kinds, only: ip
   use atrito_blas_info, only: blas_name, is_reference_blas, lapack_version
   use atrito_clp, only: has_clp, clp_version, clp_trouble
   use atrito_mpi, only: has_mpi, mpi_name, rank_count
   use atrito_multifrontal, only: has_metis, metis_version, metis_trouble
   use atrito_mumps_library, only: has_mumps, mumps_name, mumps_trouble
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: library_t, list_libraries, version_lines, USED, NOT_USED

   type :: library_t
      character(len=8) :: name = ''
      character(len=:), allocatable :: version      !< or why there is none
   end type library_t

   integer, parameter :: USED = 1, NOT_USED = 2, NOT_KNOWN = 3

contains

   !> Compiler, BLAS, LAPACK, MUMPS, Clp and METIS; and MPI, where a run has several ranks or a build that has it is asked for.
   !> A library that a run does not need is not loaded to ask for it.
   subroutine list_libraries(mumps, list, uses_metis)
      integer, intent(in) :: mumps                  !< USED or NOT_USED by a run; NOT_KNOWN: what this build could use
      type(library_t), allocatable, intent(out) :: list(:)
      logical, intent(in), optional :: uses_metis   !< a run does; default: no

      logical :: by_ranks

      by_ranks = rank_count() > 1 .or. (has_mpi() .and. mumps == NOT_KNOWN)
      allocate (list(merge(7, 6, by_ranks)))
      call list_numerical(mumps, list(:6), uses_metis)
      if (by_ranks) then
         list(7)%name = 'MPI'
         list(7)%version = ranks_text()
      end if
   end subroutine list_libraries

   !> `Open MPI v4.1.4, 2 ranks`
   function ranks_text() result(text)
      character(len=:), allocatable :: text

      text = mpi_name()//', '//to_text(rank_count())//' rank'
      if (rank_count() /= 1_ip) text = text//'s'
   end function ranks_text

   !> All but MPI.
   subroutine list_numerical(mumps, list, uses_metis)
      integer, intent(in) :: mumps
      type(library_t), intent(inout) :: list(:)     !< six of them
      logical, intent(in), optional :: uses_metis
      logical :: there(3)
      character(len=*), parameter :: LOADED = ', loaded where it is used'

      list%name = [character(len=8) :: 'compiler', 'BLAS', 'LAPACK', 'MUMPS', 'Clp', 'METIS']
      list(1)%version = compiler_version()
      list(2)%version = trim(blas_name())
      if (is_reference_blas()) list(2)%version = list(2)%version//' (the reference one, slow)'
      list(3)%version = lapack_version()
      if (mumps == NOT_KNOWN) then
         there = [has_mumps(), has_clp(), has_metis()]      ! which looks for them
         list(4)%version = 'not used: '//mumps_trouble()
         if (there(1)) list(4)%version = number_of(mumps_name())//LOADED
         list(5)%version = 'not used: '//clp_trouble()
         if (there(2)) list(5)%version = clp_version()//LOADED
         list(6)%version = 'not used: '//metis_trouble()
         if (there(3)) list(6)%version = metis_version()//LOADED
         return
      end if
      list(4)%version = 'not used'
      if (mumps == USED) list(4)%version = number_of(mumps_name())
      list(5)%version = 'not used, but where no solution is found'
      list(6)%version = 'not used'
      if (present(uses_metis)) then
         if (uses_metis) list(6)%version = metis_version()
      end if
   end subroutine list_numerical

   !> `5.5.1` of `MUMPS 5.5.1`.
   pure function number_of(name) result(number)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: number

      number = name(index(name, ' ') + 1:)
   end function number_of

   !> What `--version` prints below the name of the program: `BLAS: OpenBLAS 0.3.21 ...`
   subroutine version_lines(lines)
      type(string_t), allocatable, intent(out) :: lines(:)
      type(library_t), allocatable :: list(:)
      integer :: i

      call list_libraries(NOT_KNOWN, list)
      allocate (lines(size(list)))
      do i = 1, size(list)
         lines(i)%s = trim(list(i)%name)//': '//list(i)%version
      end do
   end subroutine version_lines

end module atrito_libraries
