!> A system that the ranks have together (atrito_shared_system), solved by MUMPS over all of them.
!>
!> Its matrix is the sum of dense matrices, each over a few of the unknowns; a rank has any number of them, or none:
!>
!>     K = sum over ranks, sum over their matrices of  B_m' S_m B_m,   B_m picks the unknowns of matrix m
!>
!> The last n_kept unknowns (index c) are kept, the others (interior, index i) eliminated. Rank 0 gets what is left of the kept
!> ones, and has all right-hand sides and solutions; every rank gets the values of the unknowns of its matrices.
!>
!>     S = K_cc - K_ci K_ii^-1 K_ic
!>
!> All ranks call every procedure in the same order (but memory_by_mumps, schur_by_mumps). With one rank it works as well.
!>
!> MUMPS sees the interior scaled to a diagonal between 1/2 and 2 by powers of two, as in atrito_mumps, for the same reasons. It
!> reads the matrices where they are (ICNTL(18)=3). Right-hand sides and solutions go through rank 0: they are little.
!>
!> Reference: MUMPS users' guide 5.5 (ICNTL, INFOG and RINFOG below are its names).
module atrito_ranks_mumps
   use atrito_coordinate_matrix, only: root_scale
   use atrito_kinds, only: ip, lp, wp
   use atrito_linear_solver, only: factor_report_t, smallest_ratio, ALL_DIGITS
   use atrito_mpi, only: all_ranks_communicator, largest_of_ranks, own_rank, spread_from_first, sum_to_first
   use atrito_mumps_library, only: dmumps_struc, begin_mumps, has_mumps, mumps_failure, mumps_trouble, run_mumps
   use atrito_packed_matrices, only: packed_matrices_t, add_diagonals, add_packed_column, list_coordinates, packed_length, &
                                     raise_diagonals, scale_packed
   use atrito_status, only: status_t, set_status, is_ok, STATUS_INTERNAL, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: ranks_mumps_t, begin_by_mumps, end_by_mumps, factor_by_mumps, schur_by_mumps
   public :: solve_by_mumps, reduce_by_mumps, expand_by_mumps
   public :: memory_by_mumps

   !> What MUMPS works on, behind a pointer.
   type :: instance_t
      type(dmumps_struc) :: mumps
      real(wp), allocatable :: reduced(:, :)     !< (n_interior, loads) on rank 0: the load whose half-solved part MUMPS holds
   end type instance_t

   !> Ended by end_by_mumps, which all ranks call: none can do so by itself, hence it is not ended when it goes out of scope.
   type :: ranks_mumps_t
      integer(ip) :: n = 0                       !< unknowns
      integer(ip) :: n_kept = 0                  !< the last n_kept are kept
      type(factor_report_t) :: report            !< of the last factorisation, the same on all ranks
      type(packed_matrices_t) :: own             !< unknowns of the matrices of this rank
      type(instance_t), pointer, private :: instance => null()
      real(wp), pointer, contiguous, private :: schur(:) => null()   !< (n_kept**2) on rank 0, by columns, between factor and schur
      real(wp), allocatable, private :: scale(:) !< (n) of rows and columns; 1 for the kept ones
   end type ranks_mumps_t

   ! JOB
   integer, parameter :: ANALYSE = 1, FACTOR = 2, SOLVE = 3, FINISH = -2
   ! ICNTL(26)
   integer, parameter :: INTERIOR_ALONE = 0, CONDENSE = 1, EXPAND = 2
   !> INFOG(1) of a pivot that is not positive: on a rank; in the last front, which all ranks share.
   integer, parameter :: NO_PIVOTS(2) = [-10, -40]
   !> INFOG(1) of work space that was predicted too small.
   integer, parameter :: NO_ROOM(*) = [-8, -9, -14, -15, -17, -20]
   !> More room than predicted, in per cent, at first and when that was too little.
   integer, parameter :: ROOM(*) = [30, 100, 400]
   !> Digits lost from which the place is worth two solves; what is added to a matrix that could not be factored, of its diagonal,
   !> to find the motion that it leaves free. As in atrito_mumps.
   real(wp), parameter :: MANY_DIGITS = 9.0_wp, SHIFT = 1.0e-13_wp

contains

   !> Says what the system consists of, and has MUMPS analyse it.
   !>
   !> status: STATUS_INTERNAL: there is no MUMPS, or too little memory; on all ranks if on one.
   subroutine begin_by_mumps(system, n, n_kept, start, unknown, status)
      type(ranks_mumps_t), intent(inout) :: system
      integer(ip), intent(in) :: n               !< unknowns, the same on all ranks
      integer(ip), intent(in) :: n_kept          !< the last ones are kept, the same on all ranks
      integer(ip), intent(in) :: start(:)        !< (matrices + 1) matrix m is over unknown(start(m):start(m + 1) - 1)
      integer(ip), intent(in) :: unknown(:)      !< 1 .. n, none twice in a matrix
      type(status_t), intent(out) :: status

      call end_by_mumps(system)
      system%n = n
      system%n_kept = n_kept
      system%own = packed_matrices_t(start, unknown)
      if (.not. has_mumps()) call set_status(status, STATUS_INTERNAL, mumps_trouble())
      call agree(status)
      if (n == n_kept .or. .not. is_ok(status)) return
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
      integer :: i

      associate (mumps => system%instance%mumps, n_kept => system%n_kept)
         mumps%n = system%n
         mumps%icntl(18) = 3                      ! each rank has entries
         mumps%icntl(14) = ROOM(1)
         if (n_kept > 0) then
            allocate (mumps%listvar_schur(n_kept))
            mumps%listvar_schur = [(i, i=system%n - n_kept + 1, system%n)]
            mumps%size_schur = n_kept
            mumps%icntl(19) = 1                   ! on rank 0, lower triangle by rows
         end if
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

   !> Factors K_ii and forms S.
   !>
   !> status: STATUS_SINGULAR when K_ii is singular or indefinite; `report` then names the unknown that moves most in its softest
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
      call make_schur(system, status)
      if (system%n == system%n_kept) then
         if (is_ok(status)) call add_up_kept(system, values)
         return
      end if
      if (is_ok(status)) call make_coordinates(system, status)
      if (.not. is_ok(status)) return
      call scale_packed(system%own, system%scale, values)
      system%instance%mumps%a_loc => values
      call run_with_room(system)
      call judge_pivots(system, values, status)
      call drop_coordinates(system)
   end subroutine factor_by_mumps

   !> From the diagonal of the sum. `empty`: the first interior unknown without stiffness, else 0.
   subroutine find_scale(system, values, empty)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(in) :: values(:)
      integer(ip), intent(out) :: empty
      real(wp) :: diagonal(system%n)
      integer(ip) :: n_interior

      diagonal = 0.0_wp
      call add_diagonals(system%own, values, diagonal)
      call sum_to_first(diagonal)
      call spread_from_first(diagonal)
      n_interior = system%n - system%n_kept
      if (.not. allocated(system%scale)) allocate (system%scale(system%n))
      system%scale = 1.0_wp
      where (abs(diagonal(:n_interior)) > 0.0_wp) system%scale(:n_interior) = root_scale(diagonal(:n_interior))
      empty = findloc(abs(diagonal(:n_interior)) > 0.0_wp, .false., dim=1, kind=ip)
   end subroutine find_scale

   !> Room for S on rank 0.
   subroutine make_schur(system, status)
      type(ranks_mumps_t), intent(inout) :: system
      type(status_t), intent(inout) :: status
      integer :: no_memory

      no_memory = 0
      if (associated(system%schur)) deallocate (system%schur)
      if (system%n_kept > 0 .and. own_rank() == 0) allocate (system%schur(int(system%n_kept, lp)**2), stat=no_memory)
      if (associated(system%instance)) system%instance%mumps%schur => system%schur
      if (no_memory /= 0) call set_status(status, STATUS_INTERNAL, 'not enough memory for what is kept of the shared system')
      call agree(status)
   end subroutine make_schur

   !> Nothing is eliminated: S is the sum of the matrices, column by column.
   subroutine add_up_kept(system, values)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(in) :: values(:)
      real(wp) :: column(system%n)
      integer(ip) :: j

      do j = 1, system%n
         column = 0.0_wp
         call add_packed_column(system%own, values, j, column)
         call sum_to_first(column)
         if (own_rank() == 0) system%schur(int(j - 1, lp)*int(system%n, lp) + 1:int(j, lp)*int(system%n, lp)) = column
      end do
   end subroutine add_up_kept

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

   !> Puts the unknown that moves most in the softest motion of the interior into the report, by inverse iteration. 0 where the
   !> matrix has no factor.
   subroutine find_weakest(system)
      type(ranks_mumps_t), intent(inout) :: system
      integer(ip) :: i, n_interior
      real(wp) :: x(system%n, 1), y(system%n), found(1)

      if (system%instance%mumps%infog(1) < 0) return
      n_interior = system%n - system%n_kept
      y = 0.0_wp
      ! without a symmetry that the motion could have
      y(:n_interior) = [(1.0_wp + real(modulo(37*modulo(i, 101), 101), wp)/101.0_wp, i=1, n_interior)]
      do i = 1, 3
         x(:, 1) = y/system%scale/maxval(abs(y))
         call solve_with(system, INTERIOR_ALONE, 1_ip, x)
         y = x(:, 1)/system%scale                  ! scaled unknowns: those of the deck may leave the range of numbers
         if (own_rank() > 0) y = 1.0_wp            ! rank 0 alone has the solution
      end do
      found = real(maxloc(abs(y(:n_interior)/maxval(abs(y))*system%scale(:n_interior)), dim=1), wp)
      call spread_from_first(found)
      system%report%worst_equation = nint(found(1), ip)
   end subroutine find_weakest

   !> S of the last factorisation, both triangles; rank 0 alone calls it, once: the room is given back.
   subroutine schur_by_mumps(system, schur)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(inout) :: schur(:, :)     !< (n_kept, n_kept)
      integer(ip) :: j
      integer(lp) :: first

      if (.not. associated(system%schur)) return
      associate (n => system%n_kept)
         do j = 1, n
            first = int(j - 1, lp)*int(n, lp)
            schur(:j, j) = system%schur(first + 1:first + j)
            schur(j, :j - 1) = schur(:j - 1, j)
         end do
      end associate
      deallocate (system%schur)
      if (associated(system%instance)) nullify (system%instance%mumps%schur)
   end subroutine schur_by_mumps

   !> Solves K_ii x_i = f_i, the kept unknowns being zero.
   subroutine solve_by_mumps(system, x, status)
      type(ranks_mumps_t), intent(inout) :: system
      !> (n, loads) on rank 0: f_i; on return x. Other ranks: of any size
      real(wp), intent(inout) :: x(:, :)
      type(status_t), intent(out) :: status

      if (own_rank() == 0) x(system%n - system%n_kept + 1:, :) = 0.0_wp
      call solve_loads(system, INTERIOR_ALONE, x, status)
   end subroutine solve_by_mumps

   !> f_c <- f_c - K_ci K_ii^-1 f_i on rank 0; f_i stays.
   subroutine reduce_by_mumps(system, f, status)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(inout) :: f(:, :)         !< (n, loads) on rank 0; other ranks: of any size
      type(status_t), intent(out) :: status

      if (system%n_kept == 0) return
      call solve_loads(system, CONDENSE, f, status)
   end subroutine reduce_by_mumps

   !> Solves K_ii x_i = f_i - K_ic x_c.
   subroutine expand_by_mumps(system, x, status)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(inout) :: x(:, :)         !< (n, loads) on rank 0: f_i and x_c; on return x. Other ranks: of any size
      type(status_t), intent(out) :: status

      call solve_loads(system, EXPAND, x, status)
   end subroutine expand_by_mumps

   !> All loads at once; how many, rank 0 knows.
   subroutine solve_loads(system, mode, x, status)
      type(ranks_mumps_t), intent(inout) :: system
      integer, intent(in) :: mode
      real(wp), intent(inout) :: x(:, :)
      type(status_t), intent(out) :: status
      integer(ip) :: loads
      real(wp) :: told(2)
      real(wp), allocatable :: copy(:, :)

      if (system%n == system%n_kept) return
      told = [real(size(x, 2), wp), 0.0_wp]
      if (own_rank() == 0) told(2) = merge(1.0_wp, 0.0_wp, mode == EXPAND .and. .not. is_reduced(system, x))
      call spread_from_first(told)
      loads = nint(told(1), ip)
      if (loads == 0) return
      if (mode == EXPAND .and. system%n_kept == 0) then
         call solve_with(system, INTERIOR_ALONE, loads, x)
      else
         if (told(2) > 0.0_wp) then
            copy = x
            call solve_with(system, CONDENSE, loads, copy)
            call judge_failure(system, status)
            if (.not. is_ok(status)) return       ! on all ranks: INFOG is the same
         end if
         call solve_with(system, mode, loads, x)
      end if
      call judge_failure(system, status)
   end subroutine solve_loads

   !> Whether MUMPS holds the half-solved part of this very load. Rank 0 knows.
   pure logical function is_reduced(system, f)
      type(ranks_mumps_t), intent(in) :: system
      real(wp), intent(in) :: f(:, :)

      is_reduced = system%n_kept == 0
      if (is_reduced .or. .not. allocated(system%instance%reduced)) return
      if (size(system%instance%reduced, 2) /= size(f, 2)) return
      is_reduced = all(system%instance%reduced == f(:system%n - system%n_kept, :))
   end function is_reduced

   !> One of MUMPS's solves in the unknowns of the caller, who has them on rank 0. CONDENSE changes x_c alone, EXPAND reads x_c and
   !> sets x_i, INTERIOR_ALONE sets x_i.
   subroutine solve_with(system, mode, loads, x)
      type(ranks_mumps_t), intent(inout) :: system
      integer, intent(in) :: mode
      integer(ip), intent(in) :: loads
      real(wp), intent(inout) :: x(:, :)         !< (n, loads)
      integer(ip) :: j, n_interior
      logical :: is_first
      real(wp), allocatable, target :: rhs(:, :), kept(:, :)

      n_interior = system%n - system%n_kept
      is_first = own_rank() == 0
      j = merge(loads, 0_ip, is_first)
      allocate (rhs(system%n, j), kept(system%n_kept, j))
      if (allocated(system%instance%reduced)) deallocate (system%instance%reduced)    ! MUMPS holds one such part, or none
      if (is_first .and. mode == CONDENSE) system%instance%reduced = x(:n_interior, :)
      do j = 1, size(rhs, 2, kind=ip)
         rhs(:, j) = x(:, j)*system%scale
         kept(:, j) = x(n_interior + 1:, j)
      end do
      associate (mumps => system%instance%mumps)
         mumps%nrhs = loads
         mumps%lrhs = system%n
         mumps%lredrhs = system%n_kept
         mumps%icntl(26) = mode
         mumps%rhs(1:size(rhs, kind=lp)) => rhs
         mumps%redrhs(1:size(kept, kind=lp)) => kept
         call run_mumps(mumps, SOLVE)
         nullify (mumps%rhs, mumps%redrhs)
         if (mumps%infog(1) < 0) return
      end associate
      do j = 1, size(rhs, 2, kind=ip)
         if (mode == CONDENSE) then
            x(n_interior + 1:, j) = kept(:, j)
         else
            x(:n_interior, j) = rhs(:n_interior, j)*system%scale(:n_interior)
         end if
      end do
   end subroutine solve_with

   !> What this rank holds of the factor, as MUMPS counts it, and the rest.
   pure integer(lp) function memory_by_mumps(system) result(bytes)
      type(ranks_mumps_t), intent(in) :: system
      integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8

      bytes = REAL_BYTES*int(system%n, lp)
      if (associated(system%schur)) bytes = bytes + REAL_BYTES*size(system%schur, kind=lp)
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
         associate (mumps => system%instance%mumps)
            if (associated(mumps%listvar_schur)) deallocate (mumps%listvar_schur)
            nullify (mumps%schur)                  ! of the system
         end associate
         call run_mumps(system%instance%mumps, FINISH)
         deallocate (system%instance)
      end if
      if (associated(system%schur)) deallocate (system%schur)
      system = ranks_mumps_t()
   end subroutine end_by_mumps

end module atrito_ranks_mumps
