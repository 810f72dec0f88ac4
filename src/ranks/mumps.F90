!> A symmetric positive definite system that the ranks have together, solved by MUMPS over all of them.
!>
!> Its matrix is the sum of dense matrices over a few of the unknowns each, one a rank, or none:
!>
!>     K = sum over ranks of  B_r' S_r B_r,   B_r picks the unknowns of rank r
!>
!> Rank 0 has all right-hand sides and solutions. All ranks call every procedure in the same order (but mumps_system_bytes). With
!> one rank it works as well.
!>
!> MUMPS sees the matrix scaled to a diagonal between 1/2 and 2 by powers of two, which rounds nothing: its smallest pivot then
!> tells whether digits are left, and no unit of the deck matters. It does not tell the equation of that pivot, which is looked for
!> by inverse iteration where the matrix is singular. It reads the matrices where they are (ICNTL(18)=3). Right-hand sides and
!> solutions go through rank 0: they are little.
!>
!> The library is loaded when it is asked for: starting would cost a millisecond more for it and for what it needs. CMake says which
!> file that is and which version the header has whose dmumps_struc is compiled in (ATRITO_MUMPS_VERSION). There are two such files
!> of one version: the sequential one (ATRITO_MUMPS_LIBRARY), with an MPI of its own that does nothing, for tests, and that for
!> ranks (ATRITO_MUMPS_RANKS_LIBRARY). A process may never have both, whose MPI would be that of the first.
!>
!> Reference: P. R. Amestoy, I. S. Duff, J. Koster, J.-Y. L'Excellent, SIAM J. Matrix Anal. Appl. 23 (2001) 15-41; MUMPS users'
!> guide 5.5 (JOB, ICNTL, INFOG and RINFOG below are its names).
module atrito_mumps
   use, intrinsic :: iso_c_binding, only: c_associated, c_f_procpointer, c_funptr
   use atrito_halting, only: halting_t, suspend_halting, restore_halting
   use atrito_kinds, only: ip, lp, wp
   use atrito_linear_solver, only: smallest_ratio
   use atrito_mpi, only: all_ranks_communicator, has_mpi, own_rank, sum_over_ranks
   use atrito_status, only: status_t, set_status, is_ok, STATUS_INTERNAL, STATUS_SINGULAR
   use atrito_strings, only: to_text
   use atrito_system, only: find_routine
   implicit none (type, external)
   private
   public :: mumps_system_t, begin_mumps_system, end_mumps_system, factor_mumps_system, solve_mumps_system, mumps_system_bytes
   public :: dmumps_struc, begin_mumps, run_mumps, has_mumps, mumps_version, mumps_trouble, mumps_failure, root_scale

   include 'dmumps_struc.h'

   !> What MUMPS works on, behind a pointer.
   type :: instance_t
      type(dmumps_struc) :: mumps                !< MUMPS's own record
   end type instance_t

   !> Ended by end_mumps_system, which all ranks call: none can do so by itself, hence it is not ended when it goes out of scope.
   type :: mumps_system_t
      integer(ip) :: n = 0                       !< unknowns
      integer(ip) :: weakest = 0                 !< on rank 0, of a matrix without factor: what moves most in its softest motion
      integer(ip), allocatable, private :: own(:) !< unknowns of the matrix of this rank
      type(instance_t), pointer, private :: instance => null() !< not associated: not begun
      real(wp), allocatable, private :: scale(:) !< (n) of rows and columns
   end type mumps_system_t

   abstract interface
      subroutine call_mumps(instance)
         import :: dmumps_struc
         type(dmumps_struc), intent(inout) :: instance !< with its job; of this rank
      end subroutine call_mumps
   end interface

   integer, parameter :: BEGIN = -1, ANALYSE = 1, FACTOR = 2, SOLVE = 3, FINISH = -2 !< JOB
   !> INFOG(1) of a pivot that is not positive: on a rank; in the last front, which all ranks share.
   integer, parameter :: NO_PIVOTS(2) = [-10, -40]
   !> INFOG(1) of work space that was predicted too small, and of too little memory.
   integer, parameter :: NO_ROOM(*) = [-8, -9, -14, -15, -17, -20], NO_MEMORY = -13
   !> More room than predicted, in per cent, at first and when that was too little.
   integer, parameter :: ROOM(*) = [30, 100, 400]
   !> Added to a matrix that could not be factored, of its diagonal, to find the motion that it leaves free: far below the softest
   !> elastic one.
   real(wp), parameter :: SHIFT = 1.0e-13_wp

contains

   !> Says what the system consists of, and has MUMPS analyse it; one that was begun before is ended first.
   !>
   !> status: STATUS_INTERNAL: there is no MUMPS, or too little memory; on all ranks if on one.
   subroutine begin_mumps_system(system, n, unknown, status)
      type(mumps_system_t), intent(inout) :: system !< of any state; begun on return where status is OK
      integer(ip), intent(in) :: n               !< unknowns, the same on all ranks
      integer(ip), intent(in) :: unknown(:)      !< 1..n, of the matrix of this rank, none twice
      type(status_t), intent(out) :: status      !< STATUS_OK or STATUS_INTERNAL, the same on all ranks

      call end_mumps_system(system)
      system%n = n
      system%own = unknown
      if (n == 0) return
      if (.not. has_mumps()) call set_status(status, STATUS_INTERNAL, mumps_trouble())
      call agree(status)
      if (.not. is_ok(status)) return
      allocate (system%instance)
      call begin_mumps(system%instance%mumps, status)
      call agree(status)
      if (.not. is_ok(status)) then
         deallocate (system%instance)
         return
      end if
      associate (mumps => system%instance%mumps)
         mumps%n = n
         mumps%icntl(18) = 3                     ! each rank has entries
         mumps%icntl(14) = ROOM(1)
      end associate
      call make_coordinates(system, status)
      if (.not. is_ok(status)) return
      call run_mumps(system%instance%mumps, ANALYSE)   ! once: the pattern stays
      call drop_coordinates(system)
      call judge_failure(system, status)
   end subroutine begin_mumps_system

   !> What one rank cannot do, none can.
   subroutine agree(status)
      type(status_t), intent(inout) :: status
      real(wp) :: failures(1)

      failures = merge(0.0_wp, 1.0_wp, is_ok(status))
      call sum_over_ranks(failures)
      if (failures(1) > 0.0_wp .and. is_ok(status)) call set_status(status, STATUS_INTERNAL, 'another rank failed')
   end subroutine agree

   !> Rows and columns of the lower triangle of this rank's matrix, as factor_mumps_system has its values.
   subroutine make_coordinates(system, status)
      type(mumps_system_t), intent(inout) :: system
      type(status_t), intent(inout) :: status
      integer(lp) :: k
      integer(ip) :: i, j
      integer :: no_memory

      associate (mumps => system%instance%mumps, n => size(system%own, kind=ip))
         mumps%nnz_loc = int(n, lp)*(n + 1)/2
         allocate (mumps%irn_loc(mumps%nnz_loc), mumps%jcn_loc(mumps%nnz_loc), stat=no_memory)
         if (no_memory /= 0) call set_status(status, STATUS_INTERNAL, 'not enough memory for the matrices of a rank')
         call agree(status)
         if (is_ok(status)) then
            k = 0
            do j = 1, n
               do i = j, n
                  k = k + 1
                  mumps%irn_loc(k) = system%own(i)
                  mumps%jcn_loc(k) = system%own(j)
               end do
            end do
         end if
      end associate
      if (.not. is_ok(status)) call drop_coordinates(system)
   end subroutine make_coordinates

   !> MUMPS wants them no more.
   subroutine drop_coordinates(system)
      type(mumps_system_t), intent(inout) :: system

      associate (mumps => system%instance%mumps)
         if (associated(mumps%irn_loc)) deallocate (mumps%irn_loc)
         if (associated(mumps%jcn_loc)) deallocate (mumps%jcn_loc)
         nullify (mumps%a_loc)
      end associate
   end subroutine drop_coordinates

   !> Factors K.
   !>
   !> status: STATUS_SINGULAR when K is singular or indefinite, STATUS_INTERNAL when the memory is too small. The same on all ranks.
   subroutine factor_mumps_system(system, values, status)
      type(mumps_system_t), intent(inout) :: system !< begun; factored on return where status is OK
      real(wp), intent(inout), contiguous, target :: values(:) !< (m (m + 1)/2, m own) lower triangle by columns, scaled meanwhile
      type(status_t), intent(out) :: status      !< STATUS_OK, STATUS_SINGULAR or STATUS_INTERNAL

      system%weakest = 0
      if (system%n == 0) return
      call find_scale()
      if (system%weakest > 0) then
         call set_status(status, STATUS_SINGULAR, 'the matrix is singular: unknown '//to_text(system%weakest)//' is empty')
         return
      end if
      call make_coordinates(system, status)
      if (.not. is_ok(status)) return
      call scale_values(system, system%scale, values)
      system%instance%mumps%a_loc => values
      call run_with_room(system)
      call judge_pivots()
      call scale_values(system, 1.0_wp/system%scale, values)   ! powers of two: nothing is lost
      call drop_coordinates(system)

   contains

      !> The status, and the weakest unknown where there is no factor, from what MUMPS says. A pivot that is negative, or no larger
      !> than the rounding errors of the elimination (smallest_ratio of the scaled diagonal, which is about 1), is none. Where MUMPS
      !> could not finish the factor, the matrix is factored once more with its diagonal raised by SHIFT, which leaves its softest
      !> motion as it is.
      subroutine judge_pivots()
         real(wp) :: diagonal(size(system%own))

         associate (mumps => system%instance%mumps, places => diagonal_places(size(system%own, kind=ip)))
            if (any(mumps%infog(1) == NO_PIVOTS)) then   ! once more, with what find_weakest wants
               diagonal = values(places)
               values(places) = (1.0_wp + SHIFT)*diagonal
               call run_with_room(system)
               values(places) = diagonal
            else
               call judge_failure(system, status)
               if (.not. is_ok(status)) return
               if (mumps%rinfog(19) > smallest_ratio(system%n) .and. mumps%infog(12) == 0) return   ! smallest pivot, negative ones
            end if
         end associate
         call find_weakest(system)
         call set_status(status, STATUS_SINGULAR, &
                         'the matrix is singular or indefinite: its softest motion is largest at unknown '// &
                         to_text(system%weakest))
      end subroutine judge_pivots

      !> From the diagonal of the sum. The weakest unknown is the first one without stiffness, if there is any.
      subroutine find_scale()
         real(wp) :: diagonal(system%n)

         diagonal = 0.0_wp
         diagonal(system%own) = values(diagonal_places(size(system%own, kind=ip)))
         call sum_over_ranks(diagonal)
         if (.not. allocated(system%scale)) allocate (system%scale(system%n))
         system%scale = 1.0_wp
         where (abs(diagonal) > 0.0_wp) system%scale = root_scale(diagonal)
         system%weakest = findloc(abs(diagonal) > 0.0_wp, .false., dim=1, kind=ip)
      end subroutine find_scale

   end subroutine factor_mumps_system

   !> Where the diagonal of a lower triangle of order n stands in its columns.
   pure function diagonal_places(n) result(places)
      integer(ip), intent(in) :: n
      integer(lp) :: places(n)
      integer(lp) :: j

      places = [(1 + (j - 1)*n - (j - 1)*(j - 2)/2, j=1, n)]
   end function diagonal_places

   !> A power of two that brings a diagonal to 1/2 .. 2 when it multiplies row and column.
   elemental real(wp) function root_scale(diagonal)
      real(wp), intent(in) :: diagonal             !< not 0
      integer, parameter :: EVEN = 4096            !< beyond all exponents: the quotient rounds down

      root_scale = set_exponent(1.0_wp, EVEN/2 + 1 - (exponent(diagonal) + EVEN)/2)
   end function root_scale

   pure subroutine scale_values(system, scale, values)
      type(mumps_system_t), intent(in) :: system
      real(wp), intent(in) :: scale(:)           !< (n) of rows and columns
      real(wp), intent(inout) :: values(:)
      integer(lp) :: k, length
      integer(ip) :: j

      k = 0
      do j = 1, size(system%own, kind=ip)
         length = size(system%own, kind=lp) - j + 1
         values(k + 1:k + length) = values(k + 1:k + length)*scale(system%own(j))*scale(system%own(j:))
         k = k + length
      end do
   end subroutine scale_values

   !> Factors, again with more room where MUMPS predicted too little.
   subroutine run_with_room(system)
      type(mumps_system_t), intent(inout) :: system
      integer :: k

      do k = 1, size(ROOM)
         system%instance%mumps%icntl(14) = ROOM(k)
         call run_mumps(system%instance%mumps, FACTOR)
         if (.not. any(system%instance%mumps%infog(1) == NO_ROOM)) exit
      end do
   end subroutine run_with_room

   subroutine judge_failure(system, status)
      type(mumps_system_t), intent(in) :: system
      type(status_t), intent(inout) :: status

      associate (mumps => system%instance%mumps)
         if (mumps%infog(1) < 0) call set_status(status, STATUS_INTERNAL, &
                                                 'the solver over the ranks failed: '//mumps_failure(mumps))
      end associate
   end subroutine judge_failure

   !> The unknown that moves most in the softest motion of a matrix that is singular but for round-off, by inverse iteration: x <-
   !> K^-1 x, three times from a vector without symmetry. Each time the eigenvector of the smallest eigenvalue grows against the
   !> others by the ratio of their eigenvalues to it. 0 where the matrix has no factor.
   subroutine find_weakest(system)
      type(mumps_system_t), intent(inout) :: system
      integer(ip) :: i
      real(wp) :: x(system%n), y(system%n)

      if (system%instance%mumps%infog(1) < 0) return
      ! without a symmetry that the motion could have
      y = [(1.0_wp + real(modulo(37*modulo(i, 101), 101), wp)/101.0_wp, i=1, system%n)]
      do i = 1, 3
         x = y/system%scale/maxval(abs(y))
         call solve_with(system, x)
         if (own_rank() == 0) y = x/system%scale   ! scaled unknowns: those of the deck may leave the range of numbers
      end do
      system%weakest = maxloc(abs(y/maxval(abs(y))*system%scale), dim=1, kind=ip)
   end subroutine find_weakest

   !> Solves K x = f.
   !>
   !> status: STATUS_INTERNAL when MUMPS fails, the same on all ranks.
   subroutine solve_mumps_system(system, x, status)
      type(mumps_system_t), intent(inout) :: system !< factored
      real(wp), intent(inout) :: x(:)            !< (n) on rank 0: f; on return x. Other ranks: of any size
      type(status_t), intent(out) :: status      !< STATUS_OK or STATUS_INTERNAL

      if (system%n == 0) return
      call solve_with(system, x)
      call judge_failure(system, status)
   end subroutine solve_mumps_system

   !> A solve of MUMPS in the unknowns of the caller, who has them on rank 0.
   subroutine solve_with(system, x)
      type(mumps_system_t), intent(inout) :: system
      real(wp), intent(inout) :: x(:)            !< (n)
      real(wp), target :: rhs(system%n)

      if (own_rank() == 0) rhs = x*system%scale
      associate (mumps => system%instance%mumps)
         mumps%nrhs = 1
         mumps%lrhs = system%n
         mumps%rhs => rhs
         call run_mumps(mumps, SOLVE)
         nullify (mumps%rhs)
         if (mumps%infog(1) < 0) return
      end associate
      if (own_rank() == 0) x = rhs*system%scale
   end subroutine solve_with

   !> What this rank holds of the factor, as MUMPS counts it, and the rest [bytes].
   pure integer(lp) function mumps_system_bytes(system) result(bytes)
      type(mumps_system_t), intent(in) :: system !< of any state
      integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8

      bytes = REAL_BYTES*int(system%n, lp)
      if (.not. associated(system%instance)) return
      associate (factor => system%instance%mumps%info(27))
         ! a negative number counts millions
         bytes = bytes + REAL_BYTES*merge(int(factor, lp), -1000000_lp*int(factor, lp), factor >= 0)
      end associate
   end function mumps_system_bytes

   !> Lets go of everything. All ranks call it; where there is nothing, nothing happens.
   subroutine end_mumps_system(system)
      type(mumps_system_t), intent(inout) :: system !< of any state; empty on return

      if (associated(system%instance)) then
         call run_mumps(system%instance%mumps, FINISH)
         deallocate (system%instance)
      end if
      system = mumps_system_t()
   end subroutine end_mumps_system

   !> Whether the library can be loaded.
   logical function has_mumps()
      procedure(call_mumps), pointer :: mumps

      call load_mumps(mumps)
      has_mumps = associated(mumps)
   end function has_mumps

   !> '5.5.1'
   pure function mumps_version() result(version)
      character(len=:), allocatable :: version

      version = ATRITO_MUMPS_VERSION
   end function mumps_version

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

   !> An instance for a symmetric positive definite matrix whose diagonal is about 1, of all ranks, which call it together.
   !>
   !> status: STATUS_INTERNAL: there is no library, or it is of a version whose dmumps_struc may be another one. Such an instance is
   !> left alone.
   subroutine begin_mumps(instance, status)
      type(dmumps_struc), intent(inout) :: instance !< not begun; of all ranks on return
      type(status_t), intent(out) :: status         !< STATUS_OK or STATUS_INTERNAL

      if (.not. has_mumps()) then
         call set_status(status, STATUS_INTERNAL, mumps_trouble())
         return
      end if
      instance%comm = all_ranks_communicator()
      instance%par = 1
      instance%sym = 1                           ! positive definite: pivots in the order of the analysis
      instance%version_number = ''
      call run_mumps(instance, BEGIN)
      if (instance%version_number /= ATRITO_MUMPS_VERSION) then
         call set_status(status, STATUS_INTERNAL, 'the library '//library_file()//' is version '//trim(instance%version_number)// &
                         ' of MUMPS, and this program was built for '//ATRITO_MUMPS_VERSION//': build it anew')
         return
      end if
      instance%icntl(1:4) = 0                    ! prints nothing
      instance%icntl(6) = 0                      ! no column permutation
      instance%icntl(7) = 0                      ! approximate minimum degree where no order is given
      instance%icntl(8) = 0                      ! scaled already
      instance%icntl(12) = 1                     ! the plain symmetric analysis
   end subroutine begin_mumps

   !> One call of MUMPS, which raises harmless floating-point exceptions.
   subroutine run_mumps(instance, job)
      type(dmumps_struc), intent(inout) :: instance !< begun, or about to be
      integer, intent(in) :: job                    !< JOB of MUMPS: BEGIN, ANALYSE, FACTOR, SOLVE, FINISH
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
      type(dmumps_struc), intent(in) :: instance !< its INFOG is read
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

end module atrito_mumps
