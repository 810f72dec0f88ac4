!> What a study measures: its runs, its quantities, their references, errors and orders.
!>
!> A row is a run: an element type at a level of refinement. Errors are relative to a given value, or to the limit that Richardson's
!> extrapolation finds from the three finest levels: with differences d1, d2 of successive levels the order is
!> p = log2(d1/d2) and the limit is q3 + d2/(2**p - 1).
module atrito_study_errors
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_strings, only: string_t, to_text
   use atrito_timers, only: phase_time_t
   implicit none (type, external)
   private
   public :: run_facts_t, study_t, study_row_t, study_quantity_t, study_probe_t
   public :: find_errors, richardson_limit, is_last, last_uniform, total_seconds, phase_seconds, WALL, PROCESSOR

   integer, parameter :: WALL = 1, PROCESSOR = 2     !< clocks

   !> What a study wants to know of a run besides its tables.
   type :: run_facts_t
      logical :: is_written = .false.                !< tables of this run were written
      logical :: is_whole = .false.                  !< to the end of the history
      integer(ip) :: n_dofs = 0, n_points = 0        !< free displacements, points of contact
      real(wp) :: h = 0.0_wp                         !< [L] side of a square of the mean area of the elements
      integer(ip) :: degree = 0                      !< of the elements' shape functions, 1 or 2; 0: both, or unknown
      real(wp) :: peak(2) = 0.0_wp                   !< [L] place of the largest pressure of the first pair
      logical :: peak_is_end = .false.               !< the first or last point of the slave surface
      logical :: has_delta = .false., has_eps = .false., has_stick_slope = .false.   !< regularisations of contact and friction
   end type run_facts_t

   !> A run of the study.
   type, extends(run_facts_t) :: study_row_t
      character(len=:), allocatable :: element       !< cpe4, ..., deck, or adapt
      integer(ip) :: level = 0                       !< of refinement; --adapt: the target [%]
      logical :: is_adapted = .false.                !< by --adapt: levels are percents, not sizes
      integer(ip) :: code = 0                        !< exit code of the run
      real(wp), allocatable :: values(:)             !< one a quantity; nan where the run has none
      real(wp) :: estimate = 0.0_wp                  !< error_estimate_percent
      real(wp) :: bound = -1.0_wp                    !< error_bound_percent; < 0: there is none
      real(wp) :: penetration = 0.0_wp, pressure = 0.0_wp   !< largest ones of pair 1
      type(phase_time_t), allocatable :: phases(:)   !< times of the run; not allocated: there are none
   end type study_row_t

   !> What is studied.
   type :: study_quantity_t
      character(len=:), allocatable :: name          !< of summary.tab
      logical :: is_given = .false.                  !< the reference, by the user
      real(wp) :: reference = 0.0_wp                 !< given, or extrapolated; nan: there is none
      real(wp) :: scale = 1.0_wp                     !< of errors: |reference|; 1 where that is 0
      real(wp) :: doubt = 0.0_wp                     !< how far other limits are from this one, relative
      character(len=:), allocatable :: source        !< of the reference, in words
      logical :: is_held = .false.                   !< no error but rounding in any run
      real(wp), allocatable :: error(:)              !< (rows) relative; absolute where the reference is 0
      real(wp), allocatable :: order(:)              !< (rows) log2 of the error of the level before over this one
   end type study_quantity_t

   !> One run once more with half of a regularisation: what it does to the quantities.
   type :: study_probe_t
      character(len=:), allocatable :: what          !< `half the delta`
      logical :: is_penalty = .false.                !< of the pressure; else of friction
      integer :: row = 0                             !< the run
      real(wp), allocatable :: values(:)             !< one a quantity
   end type study_probe_t

   !> A study: its runs, what is measured of them, and what it says.
   type :: study_t
      type(study_row_t), allocatable :: rows(:)      !< by element, then level
      type(string_t), allocatable :: elements(:)     !< each once
      type(study_quantity_t), allocatable :: quantities(:) !< what is measured of each run
      type(study_probe_t), allocatable :: probes(:)  !< runs with half of a regularisation
      real(wp) :: rounding = 1.0e-12_wp              !< a relative error up to this is none
      type(string_t), allocatable :: words(:)        !< what becomes of the errors
   end type study_t

contains

   !> Fills references, errors and orders from the values of the rows.
   subroutine find_errors(study)
      type(study_t), intent(inout) :: study          !< values of its rows in, all of its quantities out
      integer :: i

      do i = 1, size(study%quantities)
         if (.not. study%quantities(i)%is_given) call extrapolate()
         call measure_errors()
      end do

   contains

      !> The limit of the element whose finest three levels leave the least to extrapolate.
      subroutine extrapolate()
         real(wp) :: limit, order, least
         integer :: k, best

         associate (quantity => study%quantities(i), rows => study%rows)
            quantity%reference = ieee_value(1.0_wp, ieee_quiet_nan)
            quantity%source = 'no limit: fewer than three levels of one element, or differences that do not shrink'
            least = huge(1.0_wp)
            best = 0
            do k = 3, size(rows)
               if (.not. is_last(rows, k)) cycle
               call limit_of_three(study, i, k, limit, order)
               if (is_nan(limit)) cycle
               if (abs(rows(k)%values(i) - limit) >= least) cycle
               least = abs(rows(k)%values(i) - limit)
               best = k
               quantity%reference = limit
               quantity%source = 'extrapolated from '//rows(k)%element//', order '//to_text(order, 3)
            end do
            if (best > 0) quantity%doubt = distance_of_limits(study, i, best)
         end associate
      end subroutine extrapolate

      subroutine measure_errors()
         integer :: k

         associate (quantity => study%quantities(i), rows => study%rows)
            allocate (quantity%error(size(rows)), quantity%order(size(rows)), source=ieee_value(1.0_wp, ieee_quiet_nan))
            if (is_nan(quantity%reference)) return
            quantity%scale = abs(quantity%reference)
            if (quantity%scale <= 0.0_wp) quantity%scale = 1.0_wp
            do k = 1, size(rows)
               quantity%error(k) = abs(rows(k)%values(i) - quantity%reference)/quantity%scale
               if (k == 1) cycle
               if (rows(k)%is_adapted) cycle
               if (rows(k)%element /= rows(k - 1)%element .or. is_nan(quantity%error(k)) .or. is_nan(quantity%error(k - 1))) cycle
               if (min(quantity%error(k), quantity%error(k - 1)) <= 0.0_wp) cycle
               quantity%order(k) = log(quantity%error(k - 1)/quantity%error(k))/log(2.0_wp)
            end do
            quantity%is_held = .not. any(is_nan(quantity%error))
            if (quantity%is_held) quantity%is_held = all(quantity%error <= study%rounding)
         end associate
      end subroutine measure_errors

   end subroutine find_errors

   !> How far the limits of other elements, and of the same element without its finest level, are from the reference; relative.
   real(wp) function distance_of_limits(study, i, best) result(distance)
      type(study_t), intent(in) :: study
      integer, intent(in) :: i, best                 !< quantity; row that the reference comes from
      real(wp) :: limit, order
      integer :: k

      distance = 0.0_wp
      associate (quantity => study%quantities(i), rows => study%rows)
         do k = 3, size(rows)
            if (.not. is_last(rows, k) .and. k /= best - 1) cycle
            call limit_of_three(study, i, k, limit, order)
            if (is_nan(limit)) cycle
            distance = max(distance, abs(limit - quantity%reference))
         end do
         if (abs(quantity%reference) > 0.0_wp) distance = distance/abs(quantity%reference)
      end associate
   end function distance_of_limits

   !> Richardson's limit of a row and the two before it; nan where they are not of one element.
   subroutine limit_of_three(study, i, k, limit, order)
      type(study_t), intent(in) :: study
      integer, intent(in) :: i, k
      real(wp), intent(out) :: limit, order
      real(wp) :: q(3)

      limit = ieee_value(1.0_wp, ieee_quiet_nan)
      order = limit
      associate (rows => study%rows)
         if (rows(k)%element /= rows(k - 2)%element .or. rows(k)%is_adapted) return
         q = [rows(k - 2)%values(i), rows(k - 1)%values(i), rows(k)%values(i)]
      end associate
      if (any(is_nan(q))) return
      if (all(abs(q - q(3)) <= study%rounding*abs(q(3)))) q = q(3)
      call richardson_limit(q, limit, order)
   end subroutine limit_of_three

   !> The finest row of its element.
   pure logical function is_last(rows, k)
      type(study_row_t), intent(in) :: rows(:)       !< by element, then level
      integer, intent(in) :: k                       !< row, from 1

      is_last = k == size(rows)
      if (.not. is_last) is_last = rows(k + 1)%element /= rows(k)%element
   end function is_last

   !> The last row of a mesh that is refined everywhere.
   pure integer function last_uniform(rows) result(k)
      type(study_row_t), intent(in) :: rows(:)       !< those of --adapt are the last

      k = count(.not. rows%is_adapted)
   end function last_uniform

   !> Richardson's limit of three values at halved sizes; nan where their differences do not shrink with one sign.
   !>
   !> If q(h) = q + C h^p, the differences of values at h, h/2 and h/4 are
   !>    d1 = q2 - q1 = -C h^p (1 - 2^-p),  d2 = q3 - q2 = d1 2^-p,
   !> so the order is p = log2(d1/d2). The error of the last value is q3 - q = C (h/4)^p = -d2/(2^p - 1), hence the limit is
   !> q = q3 + d2/(d1/d2 - 1).
   !> Equal differences, growing ones or some of other sign belong to no such law; a d2 of 0 means that the limit is reached.
   subroutine richardson_limit(q, limit, order)
      real(wp), intent(in) :: q(3)                   !< coarse to fine
      real(wp), intent(out) :: limit, order          !< of q; p, 0 where the limit is reached, nan without
      real(wp) :: d1, d2

      limit = ieee_value(1.0_wp, ieee_quiet_nan)
      order = limit
      if (any(is_nan(q))) return
      d1 = q(2) - q(1)
      d2 = q(3) - q(2)
      if (d2 == 0.0_wp) then
         limit = q(3)
         order = 0.0_wp
         return
      end if
      if (d1/d2 <= 1.0_wp) return
      order = log(d1/d2)/log(2.0_wp)
      limit = q(3) + d2/(d1/d2 - 1.0_wp)
   end subroutine richardson_limit

   !> Seconds of a phase by one of the clocks.
   pure real(wp) function phase_seconds(row, name, clock) result(seconds)
      type(study_row_t), intent(in) :: row           !< of the study
      character(len=*), intent(in) :: name           !< of the phase
      integer, intent(in) :: clock                   !< WALL or PROCESSOR
      integer :: i

      seconds = 0.0_wp
      if (.not. allocated(row%phases)) return
      do i = 1, size(row%phases)
         if (row%phases(i)%name == name) seconds = merge(row%phases(i)%wall, row%phases(i)%cpu, clock == WALL)
      end do
   end function phase_seconds

   !> Seconds of all phases of a run, by the wall clock (WALL) or of the processor (PROCESSOR); 0 where there are none.
   pure real(wp) function total_seconds(row, clock) result(seconds)
      type(study_row_t), intent(in) :: row           !< of the study
      integer, intent(in) :: clock                   !< WALL or PROCESSOR

      seconds = 0.0_wp
      if (.not. allocated(row%phases)) return
      seconds = merge(sum(row%phases%wall), sum(row%phases%cpu), clock == WALL)
   end function total_seconds

end module atrito_study_errors
