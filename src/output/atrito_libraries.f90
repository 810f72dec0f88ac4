!> The compiler and the libraries of this program, for the listing and `--version`.
module atrito_libraries
   use, intrinsic :: iso_fortran_env, only: compiler_version
   use atrito_blas_info, only: blas_name, is_reference_blas, lapack_version
   use atrito_clp, only: has_clp, clp_version, clp_trouble
   use atrito_kinds, only: ip
   use atrito_mpi, only: has_mpi, mpi_name, rank_count
   use atrito_multifrontal, only: has_metis, metis_version, metis_trouble
   use atrito_mumps_library, only: has_mumps, mumps_name, mumps_trouble
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: library_t, list_libraries, version_lines

   type :: library_t
      character(len=8) :: name = ''
      character(len=:), allocatable :: version      !< or why there is none
   end type library_t

   character(len=*), parameter :: LOADED = ', loaded where it is used'

contains

   !> Compiler, BLAS, LAPACK, Clp and METIS; MUMPS and MPI, where a run has several ranks or a build that has them is asked for.
   !> A library that a run does not need is not loaded to ask for it.
   subroutine list_libraries(of_run, list, uses_metis)
      logical, intent(in) :: of_run                 !< those of a run; else what this build could use
      type(library_t), allocatable, intent(out) :: list(:)
      logical, intent(in), optional :: uses_metis   !< a run does; default: no
      logical :: by_ranks

      by_ranks = rank_count() > 1 .or. (has_mpi() .and. .not. of_run)
      allocate (list(merge(7, 5, by_ranks)))
      call list_numerical(of_run, list(:5), uses_metis)
      if (by_ranks) then
         list(6:)%name = [character(len=8) :: 'MUMPS', 'MPI']
         list(6)%version = 'not used: '//mumps_trouble()
         if (has_mumps()) list(6)%version = number_of(mumps_name())//LOADED
         list(7)%version = ranks_text()
      end if
   end subroutine list_libraries

   !> `Open MPI v4.1.4, 2 ranks`
   function ranks_text() result(text)
      character(len=:), allocatable :: text

      text = mpi_name()//', '//to_text(rank_count())//' rank'
      if (rank_count() /= 1_ip) text = text//'s'
   end function ranks_text

   !> Those of one process.
   subroutine list_numerical(of_run, list, uses_metis)
      logical, intent(in) :: of_run
      type(library_t), intent(inout) :: list(:)     !< five of them
      logical, intent(in), optional :: uses_metis

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
         return
      end if
      list(4)%version = 'not used: '//clp_trouble()
      if (has_clp()) list(4)%version = clp_version()//LOADED
      list(5)%version = 'not used: '//metis_trouble()
      if (has_metis()) list(5)%version = metis_version()//LOADED
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

      call list_libraries(.false., list)
      allocate (lines(size(list)))
      do i = 1, size(list)
         lines(i)%s = trim(list(i)%name)//': '//list(i)%version
      end do
   end subroutine version_lines

end module atrito_libraries
