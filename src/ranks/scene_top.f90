!> What the parts of a scene share (atrito_scene_parts), when it is too large to be one full matrix: factored and solved by all
!> ranks together with MUMPS (atrito_ranks_mumps).
!>
!> The first rank tells the others what is to be done, with SERVICE_SCENE_TOP, and joins in; `serve_scene_top` is the other end.
!> There is one such system at a time. All ranks must end it together, so each has it here, whatever becomes of the scene that it
!> is of.
module atrito_scene_top
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: rank_count, send_parcel
   use atrito_parcel, only: parcel_t, put, take
   use atrito_rank_services, only: send_to_others, SERVICE_SCENE_TOP
   use atrito_ranks_mumps, only: ranks_mumps_t, begin_by_mumps, end_by_mumps, factor_by_mumps, memory_by_mumps, solve_by_mumps
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: serve_scene_top, begin_scene_top, factor_scene_top, solve_scene_top, end_scene_top, scene_top_bytes, trouble

   ! What is wanted.
   integer(ip), parameter :: MAKE = 1, FACTOR = 2, SOLVE = 3, FINISH = 4

   type(ranks_mumps_t) :: system
   type(status_t), target :: trouble             !< of the first solve that failed, until it is taken (scene_system_t)

contains

   !> Joins in what the first rank does; what is left of the parcel comes behind SERVICE_SCENE_TOP.
   subroutine serve_scene_top(left, request)
      real(wp), allocatable, intent(in) :: left(:)   !< what is left of the part of this rank; not allocated: it has none
      type(parcel_t), intent(inout) :: request
      integer(ip), allocatable :: unknown(:)
      real(wp) :: nothing(0, 0)
      type(status_t) :: status
      integer(ip) :: wanted, n

      call take(request, wanted)
      select case (wanted)
      case (MAKE)
         call take(request, n)
         call take(request, unknown)
         call begin_own(n, unknown, status)
      case (FACTOR)
         call factor_own(left, status)
      case (SOLVE)
         call solve_by_mumps(system, nothing, status)
      case (FINISH)
         call end_by_mumps(system)
      end select
   end subroutine serve_scene_top

   subroutine begin_own(n, unknown, status)
      integer(ip), intent(in) :: n, unknown(:)
      type(status_t), intent(out) :: status

      call begin_by_mumps(system, n, [1_ip, size(unknown, kind=ip) + 1_ip], unknown, status)
   end subroutine begin_own

   !> The system scales what it gets.
   subroutine factor_own(left, status)
      real(wp), allocatable, intent(in) :: left(:)
      type(status_t), intent(out) :: status
      real(wp), allocatable :: values(:)

      if (allocated(left)) then
         values = left
      else
         allocate (values(0))
      end if
      call factor_by_mumps(system, values, status)
   end subroutine factor_own

   !> Says which unknowns each part has. status: STATUS_INTERNAL: there is no MUMPS, or too little memory.
   subroutine begin_scene_top(n, rank, first, unknown, status)
      integer(ip), intent(in) :: n               !< unknowns
      integer(ip), intent(in) :: rank(:)         !< (parts)
      integer(ip), intent(in) :: first(:)        !< (parts + 1) of the unknowns of each part
      integer(ip), intent(in) :: unknown(:)      !< 1..n
      type(status_t), intent(out) :: status
      type(parcel_t) :: request, nothing
      integer(ip) :: r

      do r = 1, rank_count() - 1
         request = nothing
         call put(request, SERVICE_SCENE_TOP)
         call put(request, MAKE)
         call put(request, n)
         call put(request, unknowns_of(r))
         call send_parcel(request, r)
      end do
      call begin_own(n, unknowns_of(0_ip), status)

   contains

      !> Those of the part of a rank, if it has one.
      pure function unknowns_of(r) result(own)
         integer(ip), intent(in) :: r
         integer(ip), allocatable :: own(:)
         integer(ip) :: p

         p = findloc(rank, r, dim=1, kind=ip)
         if (p == 0) then
            allocate (own(0))
         else
            own = unknown(first(p):first(p + 1) - 1)
         end if
      end function unknowns_of

   end subroutine begin_scene_top

   !> Factors the sum of what is left of the parts. status: STATUS_SINGULAR when a pivot is not positive, STATUS_INTERNAL when the
   !> memory does not suffice.
   subroutine factor_scene_top(left, failed, status)
      real(wp), allocatable, intent(in) :: left(:)   !< of the part of the first rank; not allocated: it has none
      integer(ip), intent(out) :: failed         !< unknown that moves most in the softest motion; 0: none
      type(status_t), intent(out) :: status

      call ask(FACTOR)
      call factor_own(left, status)
      failed = 0
      if (.not. is_ok(status)) failed = system%report%worst_equation
   end subroutine factor_scene_top

   !> x <- A^-1 x; 0 where that failed, which is noted: nothing that was found may be believed then.
   subroutine solve_scene_top(x)
      real(wp), intent(inout) :: x(:)            !< (n)
      real(wp) :: column(size(x), 1)
      type(status_t) :: status

      call ask(SOLVE)
      column(:, 1) = x
      call solve_by_mumps(system, column, status)
      x = 0.0_wp
      if (is_ok(status)) then
         x = column(:, 1)
      else if (is_ok(trouble)) then
         trouble = status
      end if
   end subroutine solve_scene_top

   !> Nothing of it is needed any more.
   subroutine end_scene_top()
      call ask(FINISH)
      call end_by_mumps(system)
   end subroutine end_scene_top

   subroutine ask(wanted)
      integer(ip), intent(in) :: wanted
      type(parcel_t) :: request

      call put(request, SERVICE_SCENE_TOP)
      call put(request, wanted)
      call send_to_others(request)
   end subroutine ask

   !> Memory held by this process [bytes].
   pure integer(lp) function scene_top_bytes() result(bytes)
      bytes = memory_by_mumps(system)
   end function scene_top_bytes

end module atrito_scene_top
