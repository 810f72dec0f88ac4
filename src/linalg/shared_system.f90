!> A symmetric positive definite system that the ranks have together.
!>
!> Its matrix is the sum of dense matrices, each over a few of the unknowns; a rank has any number of them, or none:
!>
!>     K = sum over ranks, sum over their matrices of  B_m' S_m B_m,   B_m picks the unknowns of matrix m
!>
!> Rank 0 has all right-hand sides and solutions. A tree of dense fronts over the ranks solves it (atrito_shared_fronts) as long as
!> each of them fits well into one rank; larger systems go to MUMPS over all ranks (atrito_ranks_mumps), which shares out its
!> fronts, too, and takes two to four times as long where both can (docs/developer/solvers.md).
!>
!> All ranks call every procedure in the same order (but memory_of_shared). With one rank it works as well.
module atrito_shared_system
   use atrito_kinds, only: ip, lp, wp
   use atrito_linear_solver, only: factor_report_t
   use atrito_mpi, only: spread_from_first
   use atrito_mumps_library, only: has_mumps
   use atrito_packed_matrices, only: packed_diagonals, packed_matrices_t
   use atrito_ranks_mumps, only: ranks_mumps_t, begin_by_mumps, end_by_mumps, factor_by_mumps, solve_by_mumps, memory_by_mumps
   use atrito_shared_fronts, only: shared_fronts_t, plan_shared_fronts, factor_shared_fronts, fronts_bytes
   use atrito_shared_loads, only: solve_load
   use atrito_status, only: status_t, set_status, is_ok, STATUS_INTERNAL
   implicit none (type, external)
   private
   public :: shared_system_t, begin_shared, end_shared, factor_shared, solve_shared, memory_of_shared, MOST_ORDER

   !> Ended by end_shared, which all ranks call: none can do so by itself, hence it is not ended when it goes out of scope.
   type :: shared_system_t
      integer(ip) :: n = 0                       !< unknowns
      type(factor_report_t) :: report            !< of the last factorisation, the same on all ranks
      type(packed_matrices_t) :: own             !< unknowns of the matrices of this rank
      logical, private :: has_fronts = .true.    !< else MUMPS has it
      logical, private :: is_factored = .false.
      type(shared_fronts_t), private :: fronts
      type(ranks_mumps_t), private :: mumps
   end type shared_system_t

   !> Of a front: 800 MB, and half a minute of one core.
   integer(ip), parameter :: MOST_ORDER = 10000_ip

contains

   !> Says what the system consists of. status: STATUS_INTERNAL: too little memory, or MUMPS failed; on all ranks if on one.
   subroutine begin_shared(system, n, start, unknown, status, most_order)
      type(shared_system_t), intent(inout) :: system
      integer(ip), intent(in) :: n               !< unknowns, the same on all ranks
      integer(ip), intent(in) :: start(:)        !< (matrices + 1) matrix m is over unknown(start(m):start(m + 1) - 1)
      integer(ip), intent(in) :: unknown(:)      !< 1 .. n, none twice in a matrix
      type(status_t), intent(out) :: status
      integer(ip), intent(in) :: most_order      !< of a front: MOST_ORDER; 0: by MUMPS in any case
      integer(ip) :: order

      call end_shared(system)
      system%n = n
      system%own = packed_matrices_t(start, unknown)
      call plan_shared_fronts(n, system%own, system%fronts, order)
      system%has_fronts = order <= most_order .or. .not. has_mumps()
      if (.not. system%has_fronts) call begin_by_mumps(system%mumps, n, start, unknown, status)
   end subroutine begin_shared

   !> Factors K.
   !>
   !> status: STATUS_SINGULAR when K is singular or indefinite; `report` then names the unknown that has no pivot, or moves most
   !> in the softest motion. STATUS_INTERNAL when the memory is too small. The same on all ranks.
   subroutine factor_shared(system, values, status)
      type(shared_system_t), intent(inout) :: system
      !> (packed_length(system%own)) values of the matrices of this rank, as put_packed puts them; scaled on return
      real(wp), intent(inout), contiguous, target :: values(:)
      type(status_t), intent(out) :: status

      if (system%has_fronts) then
         call factor_shared_fronts(system%fronts, system%own, values, packed_diagonals(system%own, values), system%n, &
                                   system%report, status)
      else
         call factor_by_mumps(system%mumps, values, status)
         system%report = system%mumps%report
      end if
      system%is_factored = is_ok(status)
   end subroutine factor_shared

   !> Solves K x = f.
   subroutine solve_shared(system, x, status)
      type(shared_system_t), intent(inout) :: system
      real(wp), intent(inout) :: x(:, :)         !< (n, loads) on rank 0: f; on return x. Other ranks: of any size
      type(status_t), intent(out) :: status

      if (lacks_factor(system, status)) return
      if (system%has_fronts) then
         call solve_load(system%fronts, loads_of_first(x), x)
      else
         call solve_by_mumps(system%mumps, x, status)
      end if
   end subroutine solve_shared

   !> Fronts that have no factor solve nothing; MUMPS says so itself. status: STATUS_INTERNAL then, on all ranks.
   logical function lacks_factor(system, status)
      type(shared_system_t), intent(in) :: system
      type(status_t), intent(inout) :: status

      lacks_factor = system%has_fronts .and. .not. system%is_factored
      if (lacks_factor) call set_status(status, STATUS_INTERNAL, 'the solver over the ranks failed: it has no factor')
   end function lacks_factor

   !> Rank 0 knows how many there are.
   integer(ip) function loads_of_first(x) result(loads)
      real(wp), intent(in) :: x(:, :)
      real(wp) :: told(1)

      told = real(size(x, 2), wp)
      call spread_from_first(told)
      loads = nint(told(1), ip)
   end function loads_of_first

   !> What this rank holds [bytes].
   pure integer(lp) function memory_of_shared(system) result(bytes)
      type(shared_system_t), intent(in) :: system

      bytes = fronts_bytes(system%fronts)
      if (.not. system%has_fronts) bytes = bytes + memory_by_mumps(system%mumps)
   end function memory_of_shared

   !> Lets go of everything. All ranks call it; where there is nothing, nothing happens.
   subroutine end_shared(system)
      type(shared_system_t), intent(inout) :: system
      type(shared_system_t) :: nothing

      if (.not. system%has_fronts) call end_by_mumps(system%mumps)
      system = nothing
   end subroutine end_shared

end module atrito_shared_system
