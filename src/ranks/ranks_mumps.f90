!> A symmetric positive definite system that the ranks have together, solved by MUMPS over all of them.
!>
!> Its matrix is the sum of dense matrices, each over a few of the unknowns; a rank has any number of them, or none:
!>
!>     K = sum over ranks, sum over their matrices of  B_m' S_m B_m,   B_m picks the unknowns of matrix m
!>
!> Rank 0 has all right-hand sides and solutions. All ranks call every procedure in the same order (but memory_by_mumps). With one
!> rank it works as well.
!>
!> MUMPS sees the matrix scaled to a diagonal between 1/2 and 2 by powers of two, which rounds nothing: its smallest pivot then
!> tells the digits lost, and no unit of the deck matters. It does not tell the equation of that pivot, which is looked for by inverse
!> iteration where the matrix is singular or nearly so. It reads the matrices where they are (ICNTL(18)=3). Right-hand sides and solutions go through rank 0: they are little.
!>
!> Reference: MUMPS users' guide 5.5 (ICNTL, INFOG and RINFOG below are its names).
module atrito_ranks_mumps
   use atrito_kinds, only: ip, lp, wp
   use atrito_linear_solver, only: factor_report_t, smallest_ratio, ALL_DIGITS
   use atrito_mpi, only: all_ranks_communicator, largest_of_ranks, own_rank, spread_from_first, sum_to_first
   use atrito_mumps_library, only: dmumps_struc, begin_mumps, has_mumps, mumps_failure, mumps_trouble, run_mumps
   use atrito_packed_matrices, only: packed_matrices_t, add_diagonals, list_coordinates, packed_length, &
                                     raise_diagonals, scale_packed
   use atrito_status, only: status_t, set_status, is_ok, STATUS_INTERNAL, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: ranks_mumps_t, begin_by_mumps, end_by_mumps, factor_by_mumps, solve_by_mumps, memory_by_mumps, root_scale

   !> What MUMPS works on, behind a pointer.
   type :: instance_t
      type(dmumps_struc) :: mumps
   end type instance_t

   !> Ended by end_by_mumps, which all ranks call: none can do so by itself, hence it is not ended when it goes out of scope.
   type :: ranks_mumps_t
      integer(ip) :: n = 0                       !< unknowns
      type(factor_report_t) :: report            !< of the last factorisation, the same on all ranks
      type(packed_matrices_t) :: own             !< unknowns of the matrices of this rank
      type(instance_t), pointer, private :: instance => null()
      real(wp), allocatable, private :: scale(:) !< (n) of rows and columns
   end type ranks_mumps_t

   ! JOB
   integer, parameter :: ANALYSE = 1, FACTOR = 2, SOLVE = 3, FINISH = -2
   !> INFOG(1) of a pivot that is not positive: on a rank; in the last front, which all ranks share.
   integer, parameter :: NO_PIVOTS(2) = [-10, -40]
   !> INFOG(1) of work space that was predicted too small.
   integer, parameter :: NO_ROOM(*) = [-8, -9, -14, -15, -17, -20]
   !> More room than predicted, in per cent, at first and when that was too little.
   integer, parameter :: ROOM(*) = [30, 100, 400]
   !> Digits lost from which the place is worth two solves; what is added to a matrix that could not be factored, of its diagonal,
   !> to find the motion that it leaves free; far below the softest elastic one.
   real(wp), parameter :: MANY_DIGITS = 9.0_wp, SHIFT = 1.0e-13_wp

contains

   !> Says what the system consists of, and has MUMPS analyse it.
   !>
   !> status: STATUS_INTERNAL: there is no MUMPS, or too little memory; on all ranks if on one.
   subroutine begin_by_mumps(system, n, start, unknown, status)
      type(ranks_mumps_t), intent(inout) :: system
      integer(ip), intent(in) :: n               !< unknowns, the same on all ranks
      integer(ip), intent(in) :: start(:)        !< (matrices + 1) matrix m is over unknown(start(m):start(m + 1) - 1)
      integer(ip), intent(in) :: unknown(:)      !< 1 .. n, none twice in a matrix
      type(status_t), intent(out) :: status

      call end_by_mumps(system)
      system%n = n
      system%own = packed_matrices_t(start, unknown)
      if (.not. has_mumps()) call set_status(status, STATUS_INTERNAL, mumps_trouble())
      call agree(status)
      if (n == 0 .or. .not. is_ok(status)) return
      allocate (system%instance)
      call begin_mumps(system%instance%mumps, status, all_ranks_communicator())
      call agree(status)
      if (.not. is_ok(status)) then
         deallocate (system%instance)
         return
      end if
      call analyse_system(system, status)
   end subroutine begin_by_mumps

   !> What one rank cannot do, none can.
   subroutine agree(status)
      type(status_t), intent(inout) :: status
      integer(ip) :: worst

      worst = largest_of_ranks(int(status%code, ip))
      if (worst /= 0 .and. is_ok(status)) call set_status(status, int(worst), 'another rank failed')
   end subroutine agree

   !> The pattern stays, so this is done once.
   subroutine analyse_system(system, status)
      type(ranks_mumps_t), intent(inout) :: system
      type(status_t), intent(inout) :: status

      associate (mumps => system%instance%mumps)
         mumps%n = system%n
         mumps%icntl(18) = 3                      ! each rank has entries
         mumps%icntl(14) = ROOM(1)
      end associate
      call make_coordinates(system, status)
      if (.not. is_ok(status)) return
      call run_mumps(system%instance%mumps, ANALYSE)
      call drop_coordinates(system)
      call judge_failure(system, status)
   end subroutine analyse_system

   !> Rows and columns of the lower triangles of the matrices of this rank, as factor_by_mumps has their values.
   subroutine make_coordinates(system, status)
      type(ranks_mumps_t), intent(inout) :: system
      type(status_t), intent(inout) :: status
      integer :: no_memory

      associate (mumps => system%instance%mumps)
         mumps%nnz_loc = packed_length(system%own)
         allocate (mumps%irn_loc(mumps%nnz_loc), mumps%jcn_loc(mumps%nnz_loc), stat=no_memory)
         if (no_memory /= 0) call set_status(status, STATUS_INTERNAL, 'not enough memory for the matrices of a rank')
         call agree(status)
         if (is_ok(status)) call list_coordinates(system%own, mumps%irn_loc, mumps%jcn_loc)
      end associate
      if (.not. is_ok(status)) call drop_coordinates(system)
   end subroutine make_coordinates

   !> MUMPS wants them no more.
   subroutine drop_coordinates(system)
      type(ranks_mumps_t), intent(inout) :: system

      associate (mumps => system%instance%mumps)
         if (associated(mumps%irn_loc)) deallocate (mumps%irn_loc)
         if (associated(mumps%jcn_loc)) deallocate (mumps%jcn_loc)
         nullify (mumps%a_loc)
      end associate
   end subroutine drop_coordinates

   !> Factors K.
   !>
   !> status: STATUS_SINGULAR when K is singular or indefinite; `report` then names the unknown that moves most in its softest
   !> motion. STATUS_INTERNAL when the memory is too small. The same on all ranks.
   subroutine factor_by_mumps(system, values, status)
      type(ranks_mumps_t), intent(inout) :: system
      !> (packed_length(system%own)) values of the matrices of this rank, as put_packed puts them; scaled on return
      real(wp), intent(inout), contiguous, target :: values(:)
      type(status_t), intent(out) :: status
      integer(ip) :: empty

      system%report = factor_report_t()
      call find_scale(system, values, empty)
      if (empty > 0) then
         system%report%worst_equation = empty
         system%report%digits_lost = ALL_DIGITS
         call set_status(status, STATUS_SINGULAR, 'the matrix is singular: unknown '//to_text(empty)//' is empty')
         return
      end if
      if (system%n == 0) return
      call make_coordinates(system, status)
      if (.not. is_ok(status)) return
      call scale_packed(system%own, system%scale, values)
      system%instance%mumps%a_loc => values
      call run_with_room(system)
      call judge_pivots(system, values, status)
      call drop_coordinates(system)
   end subroutine factor_by_mumps

   !> From the diagonal of the sum. `empty`: the first unknown without stiffness, else 0.
   subroutine find_scale(system, values, empty)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(in) :: values(:)
      integer(ip), intent(out) :: empty
      real(wp) :: diagonal(system%n)

      diagonal = 0.0_wp
      call add_diagonals(system%own, values, diagonal)
      call sum_to_first(diagonal)
      call spread_from_first(diagonal)
      if (.not. allocated(system%scale)) allocate (system%scale(system%n))
      system%scale = 1.0_wp
      where (abs(diagonal) > 0.0_wp) system%scale = root_scale(diagonal)
      empty = findloc(abs(diagonal) > 0.0_wp, .false., dim=1, kind=ip)
   end subroutine find_scale

   !> A power of two that brings a diagonal to 1/2 .. 2 when it multiplies row and column.
   elemental real(wp) function root_scale(diagonal)
      real(wp), intent(in) :: diagonal             !< not 0
      integer, parameter :: EVEN = 4096            !< beyond all exponents: the quotient rounds down

      root_scale = set_exponent(1.0_wp, EVEN/2 + 1 - (exponent(diagonal) + EVEN)/2)
   end function root_scale

   !> Factors, again with more room where MUMPS predicted too little.
   subroutine run_with_room(system)
      type(ranks_mumps_t), intent(inout) :: system
      integer :: k

      do k = 1, size(ROOM)
         system%instance%mumps%icntl(14) = ROOM(k)
         call run_mumps(system%instance%mumps, FACTOR)
         if (.not. any(system%instance%mumps%infog(1) == NO_ROOM)) exit
      end do
   end subroutine run_with_room

   !> Fills the report and the status from what MUMPS says.
   subroutine judge_pivots(system, values, status)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(inout) :: values(:)
      type(status_t), intent(inout) :: status
      logical :: singular, failed

      associate (mumps => system%instance%mumps, report => system%report)
         failed = any(mumps%infog(1) == NO_PIVOTS)
         if (.not. failed) call judge_failure(system, status)
         if (.not. is_ok(status)) return
         singular = failed
         if (.not. singular) then
            report%sign_changes = mumps%infog(12)
            report%smallest_pivot = mumps%rinfog(19)
            report%largest_pivot = mumps%rinfog(21)
            singular = report%smallest_pivot <= smallest_ratio(system%n) .or. report%sign_changes > 0
         end if
         report%digits_lost = ALL_DIGITS
         if (.not. singular) report%digits_lost = max(-log10(report%smallest_pivot), 0.0_wp)
         if (failed) then                         ! once more, with what find_weakest wants
            call raise_diagonals(system%own, 1.0_wp + SHIFT, values)
            call run_with_room(system)
         end if
         if (singular .or. report%digits_lost > MANY_DIGITS) call find_weakest(system)
         if (singular) call set_status(status, STATUS_SINGULAR, 'the matrix is singular or indefinite: its softest '// &
                                       'motion is largest at unknown '//to_text(report%worst_equation))
      end associate
   end subroutine judge_pivots

   subroutine judge_failure(system, status)
      type(ranks_mumps_t), intent(in) :: system
      type(status_t), intent(inout) :: status

      associate (mumps => system%instance%mumps)
         if (mumps%infog(1) < 0) call set_status(status, STATUS_INTERNAL, &
                                                 'the solver over the ranks failed: '//mumps_failure(mumps))
      end associate
   end subroutine judge_failure

   !> Puts the unknown that moves most in the softest motion into the report, by inverse iteration. 0 where the
   !> matrix has no factor.
   subroutine find_weakest(system)
      type(ranks_mumps_t), intent(inout) :: system
      integer(ip) :: i
      real(wp) :: x(system%n, 1), y(system%n), found(1)

      if (system%instance%mumps%infog(1) < 0) return
      ! without a symmetry that the motion could have
      y = [(1.0_wp + real(modulo(37*modulo(i, 101), 101), wp)/101.0_wp, i=1, system%n)]
      do i = 1, 3
         x(:, 1) = y/system%scale/maxval(abs(y))
         call solve_with(system, 1_ip, x)
         y = x(:, 1)/system%scale                  ! scaled unknowns: those of the deck may leave the range of numbers
         if (own_rank() > 0) y = 1.0_wp            ! rank 0 alone has the solution
      end do
      found = real(maxloc(abs(y/maxval(abs(y))*system%scale), dim=1), wp)
      call spread_from_first(found)
      system%report%worst_equation = nint(found(1), ip)
   end subroutine find_weakest

   !> Solves K x = f: all loads at once; how many, rank 0 knows.
   subroutine solve_by_mumps(system, x, status)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(inout) :: x(:, :)         !< (n, loads) on rank 0: f; on return x. Other ranks: of any size
      type(status_t), intent(out) :: status
      real(wp) :: told(1)

      if (system%n == 0) return
      told = real(size(x, 2), wp)
      call spread_from_first(told)
      if (nint(told(1)) == 0) return
      call solve_with(system, nint(told(1), ip), x)
      call judge_failure(system, status)
   end subroutine solve_by_mumps

   !> A solve of MUMPS in the unknowns of the caller, who has them on rank 0.
   subroutine solve_with(system, loads, x)
      type(ranks_mumps_t), intent(inout) :: system
      integer(ip), intent(in) :: loads
      real(wp), intent(inout) :: x(:, :)         !< (n, loads)
      integer(ip) :: j
      real(wp), allocatable, target :: rhs(:, :)

      allocate (rhs(system%n, merge(loads, 0_ip, own_rank() == 0)))
      do j = 1, size(rhs, 2, kind=ip)
         rhs(:, j) = x(:, j)*system%scale
      end do
      associate (mumps => system%instance%mumps)
         mumps%nrhs = loads
         mumps%lrhs = system%n
         mumps%rhs(1:size(rhs, kind=lp)) => rhs
         call run_mumps(mumps, SOLVE)
         nullify (mumps%rhs)
         if (mumps%infog(1) < 0) return
      end associate
      do j = 1, size(rhs, 2, kind=ip)
         x(:, j) = rhs(:, j)*system%scale
      end do
   end subroutine solve_with

   !> What this rank holds of the factor, as MUMPS counts it, and the rest.
   pure integer(lp) function memory_by_mumps(system) result(bytes)
      type(ranks_mumps_t), intent(in) :: system
      integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8

      bytes = REAL_BYTES*int(system%n, lp)
      if (.not. associated(system%instance)) return
      associate (factor => system%instance%mumps%info(27))
         ! a negative number counts millions
         bytes = bytes + REAL_BYTES*merge(int(factor, lp), -1000000_lp*int(factor, lp), factor >= 0)
      end associate
   end function memory_by_mumps

   !> Lets go of everything. All ranks call it; where there is nothing, nothing happens.
   subroutine end_by_mumps(system)
      type(ranks_mumps_t), intent(inout) :: system

      if (associated(system%instance)) then
         call run_mumps(system%instance%mumps, FINISH)
         deallocate (system%instance)
      end if
      system = ranks_mumps_t()
   end subroutine end_by_mumps

end module atrito_ranks_mumps
