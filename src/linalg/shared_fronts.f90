!> A system that the ranks have together, solved by dense fronts: a tree of them over the ranks (atrito_front_plan).
!>
!> Each rank adds up what it has and eliminates what nobody else has; what is left goes to the rank of the front above, and so on.
!> All ranks call every procedure in the same order, and go through the fronts in the same order: each does its own. A front that
!> has no factor leaves nothing, which those above it take for a failure, so nobody waits for what does not come.
!>
!> Right-hand sides and solutions are on rank 0.
module atrito_shared_fronts
   use atrito_front_plan, only: front_plan_t, make_front_plan, put_plan, take_plan, largest_order
   use atrito_kinds, only: ip, lp, wp
   use atrito_linear_solver, only: factor_report_t, note_pivot, set_pivot_status
   use atrito_mpi, only: own_rank, rank_count, receive_parcel, send_parcel
   use atrito_multifrontal, only: add_element, add_update, clear_front, eliminate, pack_columns, packed_triangle => packed_length
   use atrito_packed_matrices, only: packed_matrices_t
   use atrito_parcel, only: parcel_t, put, take
   use atrito_rank_services, only: send_to_others
   use atrito_status, only: status_t, set_status, is_ok, STATUS_INTERNAL, STATUS_SINGULAR
   use atrito_status_parcel, only: put_status, take_status
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: shared_fronts_t, plan_shared_fronts, factor_shared_fronts, fronts_bytes

   !> What this rank has of a front.
   type :: held_front_t
      real(wp), allocatable :: columns(:, :)     !< (order, n_pivots) of L
      real(wp), allocatable :: update(:)         !< what is left, packed, until the front above has taken it; of no size: nothing is
      integer(ip), allocatable :: position(:)    !< of what is left; of the own matrix of a rank in its order, else ascending
      real(wp), allocatable :: diagonal(:)       !< (unknowns left) of the matrix, as far as it was added up
      real(wp), allocatable :: x(:, :)           !< (order, loads) while a load is solved
   end type held_front_t

   type :: shared_fronts_t
      type(front_plan_t) :: plan
      type(held_front_t), allocatable :: held(:) !< (fronts)
   end type shared_fronts_t

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INDEX_BYTES = storage_size(1_ip)/8

contains

   !> All ranks get the plan; order: of the largest front.
   subroutine plan_shared_fronts(n, own, fronts, order)
      integer(ip), intent(in) :: n
      type(packed_matrices_t), intent(in) :: own     !< unknowns of this rank
      type(shared_fronts_t), intent(out) :: fronts
      integer(ip), intent(out) :: order
      type(parcel_t) :: parcel, plan
      integer(ip), allocatable :: first(:), unknown(:), of_rank(:)
      integer(ip) :: rank

      if (own_rank() == 0) then
         first = [1_ip, size(own%unknown, kind=ip) + 1_ip]
         unknown = own%unknown
         do rank = 1, rank_count() - 1
            call receive_parcel(parcel, rank)
            call take(parcel, of_rank)
            unknown = [unknown, of_rank]
            first = [first, size(unknown, kind=ip) + 1_ip]
         end do
         call make_front_plan(n, first, unknown, fronts%plan)
         call put_plan(plan, fronts%plan)
         call send_to_others(plan)
      else
         call put(parcel, own%unknown)
         call send_parcel(parcel, 0_ip)
         call receive_parcel(plan, 0_ip)
         call take_plan(plan, fronts%plan)
      end if
      allocate (fronts%held(size(fronts%plan%front)))
      order = largest_order(fronts%plan)
   end subroutine plan_shared_fronts

   !> Factors the sum of the matrices.
   !>
   !> status: STATUS_SINGULAR when a pivot is not positive, report%worst_equation is its unknown; STATUS_INTERNAL when the memory is
   !> too small. The same on all ranks.
   subroutine factor_shared_fronts(fronts, own, values, original, n_before, report, status)
      type(shared_fronts_t), intent(inout) :: fronts
      type(packed_matrices_t), intent(in) :: own
      real(wp), intent(in), contiguous :: values(:)          !< (packed_length(own)) of the matrices of this rank
      real(wp), intent(in) :: original(:)        !< (size(own%unknown)) diagonals, by which pivots are judged
      integer(ip), intent(in) :: n_before        !< equations of which the system is what is left, itself included
      type(factor_report_t), intent(out) :: report
      type(status_t), intent(out) :: status
      integer(ip) :: f

      do f = 1, size(fronts%held, kind=ip)
         if (fronts%plan%front(f)%holder /= own_rank()) cycle
         call factor_front(fronts, f, own, values, original, n_before, report, status)
         call pass_on(fronts, f)
      end do
      call agree_on_report(report, status)
      if (report%worst_equation > 0) report%worst_equation = fronts%plan%unknown(report%worst_equation)
      if (status%code == STATUS_SINGULAR) then
         call set_status(status, STATUS_SINGULAR, 'the matrix is singular or indefinite: no pivot left at unknown '// &
                         to_text(report%worst_equation))
      end if
   end subroutine factor_shared_fronts

   !> A front that fails leaves nothing; the first failure counts.
   subroutine factor_front(fronts, f, own, values, original, n_before, report, status)
      type(shared_fronts_t), intent(inout) :: fronts
      integer(ip), intent(in) :: f
      type(packed_matrices_t), intent(in) :: own
      real(wp), intent(in), contiguous :: values(:)
      integer(ip), intent(in) :: n_before
      real(wp), intent(in) :: original(:)
      type(factor_report_t), intent(inout) :: report
      type(status_t), intent(inout) :: status
      type(status_t) :: fine
      real(wp), allocatable :: front(:, :), diagonal(:)
      integer(ip) :: failed
      integer :: no_memory
      logical :: complete

      associate (plan => fronts%plan%front(f), held => fronts%held(f), order => size(fronts%plan%front(f)%position, kind=ip))
         call forget(held)
         if (is_as_it_is(fronts%plan, f, own)) then
            call keep_own(fronts%plan, own, values, original, held)
            return
         end if
         allocate (held%update(0), held%position(0), held%diagonal(0), diagonal(order), front(order, order), stat=no_memory)
         if (no_memory /= 0) then
            call set_status(status, STATUS_INTERNAL, 'not enough memory for what the ranks share')
            allocate (front(0, 0))
         else
            call clear_front(order, front)
            diagonal = 0.0_wp
            if (all(plan%child == 0)) call add_own(fronts%plan, f, own, values, original, front, diagonal)
         end if
         call add_children(fronts, f, front, diagonal, complete)
         if (no_memory /= 0 .or. .not. complete) return
         call eliminate(order, plan%n_pivots, front, failed)
         if (is_ok(status)) call note_pivots(plan%position, plan%n_pivots, n_before, front, diagonal, failed, report, fine)
         if (.not. is_ok(fine)) status = fine
         if (failed > 0 .or. .not. is_ok(status)) return
         held%columns = front(:, :plan%n_pivots)
         held%diagonal = diagonal(plan%n_pivots + 1:)
         held%position = plan%position(plan%n_pivots + 1:)
         deallocate (held%update)
         allocate (held%update(packed_triangle(order - plan%n_pivots, order - plan%n_pivots)))
         call pack_columns(order, front, plan%n_pivots + 1, order, held%update)
      end associate
   end subroutine factor_front

   !> A rank has one matrix and eliminates nothing of it: it is what is left.
   pure logical function is_as_it_is(plan, f, own)
      type(front_plan_t), intent(in) :: plan
      integer(ip), intent(in) :: f
      type(packed_matrices_t), intent(in) :: own

      is_as_it_is = all(plan%front(f)%child == 0) .and. plan%front(f)%n_pivots == 0 .and. size(own%start) == 2
   end function is_as_it_is

   subroutine keep_own(plan, own, values, original, held)
      type(front_plan_t), intent(in) :: plan
      type(packed_matrices_t), intent(in) :: own
      real(wp), intent(in), contiguous :: values(:)
      real(wp), intent(in) :: original(:)
      type(held_front_t), intent(inout) :: held

      held%update = values
      held%position = plan%position(own%unknown)
      held%diagonal = original
   end subroutine keep_own

   subroutine forget(held)
      type(held_front_t), intent(inout) :: held
      type(held_front_t) :: nothing

      held = nothing
   end subroutine forget

   !> The matrices of this rank.
   subroutine add_own(plan, f, own, values, original, front, diagonal)
      type(front_plan_t), intent(in) :: plan
      integer(ip), intent(in) :: f
      type(packed_matrices_t), intent(in) :: own
      real(wp), intent(in), contiguous :: values(:)
      real(wp), intent(in) :: original(:)
      real(wp), intent(inout), contiguous :: front(:, :)
      real(wp), intent(inout) :: diagonal(:)
      integer(ip) :: place(plan%n), m, i
      integer(lp) :: k

      place(plan%front(f)%position) = [(i, i=1, size(front, 1, kind=ip))]
      k = 0
      do m = 1, size(own%start, kind=ip) - 1
         associate (at => place(plan%position(own%unknown(own%start(m):own%start(m + 1) - 1))))
            call add_element(size(front, 1, kind=ip), front, size(at, kind=ip), at, values(k + 1:))
            k = k + packed_triangle(size(at, kind=ip), size(at, kind=ip))
            diagonal(at) = diagonal(at) + original(own%start(m):own%start(m + 1) - 1)
         end associate
      end do
   end subroutine add_own

   !> What the fronts below have left, from wherever they are. complete: they all have left something.
   subroutine add_children(fronts, f, front, diagonal, complete)
      type(shared_fronts_t), intent(inout) :: fronts
      integer(ip), intent(in) :: f
      real(wp), intent(inout), contiguous :: front(:, :)
      real(wp), intent(inout) :: diagonal(:)
      logical, intent(out) :: complete
      type(parcel_t) :: parcel
      integer(ip) :: i, place(fronts%plan%n)
      integer(ip), allocatable :: at(:)

      complete = .true.
      place(fronts%plan%front(f)%position) = [(i, i=1, size(fronts%plan%front(f)%position, kind=ip))]
      do i = 1, 2
         if (fronts%plan%front(f)%child(i) == 0) cycle
         associate (child => fronts%plan%front(fronts%plan%front(f)%child(i)), held => fronts%held(fronts%plan%front(f)%child(i)))
            if (child%holder /= own_rank()) then
               call receive_parcel(parcel, child%holder)
               call take(parcel, held%update)
               call take(parcel, held%diagonal)
               call take(parcel, held%position)
            end if
            complete = complete .and. size(held%diagonal) == size(child%position) - child%n_pivots
            if (complete .and. size(front) > 0) then
               at = place(held%position)
               if (all(at(2:) > at(:size(at) - 1))) then
                  call add_update(size(front, 1, kind=ip), front, size(at, kind=ip), at, held%update)
               else
                  call add_element(size(front, 1, kind=ip), front, size(at, kind=ip), at, held%update)
               end if
               diagonal(at) = diagonal(at) + held%diagonal
            end if
            deallocate (held%update, held%diagonal, held%position)
         end associate
      end do
   end subroutine add_children

   !> What is left goes to the front above, if that is elsewhere.
   subroutine pass_on(fronts, f)
      type(shared_fronts_t), intent(inout) :: fronts
      integer(ip), intent(in) :: f
      type(parcel_t) :: parcel
      integer(ip) :: to

      if (fronts%plan%front(f)%parent == 0) return
      to = fronts%plan%front(fronts%plan%front(f)%parent)%holder
      if (to == own_rank()) return
      associate (held => fronts%held(f))
         call put(parcel, held%update)
         call put(parcel, held%diagonal)
         call put(parcel, held%position)
         call send_parcel(parcel, to)
         deallocate (held%update, held%diagonal, held%position)
      end associate
   end subroutine pass_on

   !> The pivots of a front go into the report, with positions for equations.
   subroutine note_pivots(position, n_pivots, n, front, diagonal, failed, report, status)
      integer(ip), intent(in) :: position(:), n_pivots, n
      real(wp), intent(in), contiguous :: front(:, :)
      real(wp), intent(in) :: diagonal(:)
      integer(ip), intent(inout) :: failed       !< pivot; 0: none
      type(factor_report_t), intent(inout) :: report
      type(status_t), intent(out) :: status
      integer(ip) :: i
      logical :: usable

      do i = 1, n_pivots
         if (i == failed) then
            call note_pivot(report, position(i), n, diagonal(i), min(front(i, i), 0.0_wp), usable)
            usable = .false.
         else
            call note_pivot(report, position(i), n, diagonal(i), front(i, i)**2, usable)
         end if
         if (usable) cycle
         failed = i
         report%worst_equation = position(i)
         exit
      end do
      call set_pivot_status(report, failed > 0, status)
   end subroutine note_pivots

   !> The worst of all ranks; of failures that of the pivot which comes first.
   subroutine agree_on_report(report, status)
      type(factor_report_t), intent(inout) :: report
      type(status_t), intent(inout) :: status
      type(parcel_t) :: parcel
      type(factor_report_t) :: other
      type(status_t) :: other_status
      integer(ip) :: rank

      if (own_rank() > 0) then
         call put_outcome(parcel, report, status)
         call send_parcel(parcel, 0_ip)
         call receive_parcel(parcel, 0_ip)
         call take_outcome(parcel, report, status)
         return
      end if
      do rank = 1, rank_count() - 1
         call receive_parcel(parcel, rank)
         call take_outcome(parcel, other, other_status)
         call add_outcome(other, other_status, report, status)
      end do
      call put_outcome(parcel, report, status)
      call send_to_others(parcel)
   end subroutine agree_on_report

   subroutine put_outcome(parcel, report, status)
      type(parcel_t), intent(out) :: parcel
      type(factor_report_t), intent(in) :: report
      type(status_t), intent(in) :: status

      call put_status(parcel, status)
      call put(parcel, [report%digits_lost, report%smallest_pivot, report%largest_pivot])
      call put(parcel, [report%worst_equation, report%sign_changes])
   end subroutine put_outcome

   subroutine take_outcome(parcel, report, status)
      type(parcel_t), intent(inout) :: parcel
      type(factor_report_t), intent(out) :: report
      type(status_t), intent(out) :: status
      real(wp), allocatable :: numbers(:)
      integer(ip), allocatable :: counts(:)

      call take_status(parcel, status)
      call take(parcel, numbers)
      call take(parcel, counts)
      report%digits_lost = numbers(1)
      report%smallest_pivot = numbers(2)
      report%largest_pivot = numbers(3)
      report%worst_equation = counts(1)
      report%sign_changes = counts(2)
   end subroutine take_outcome

   subroutine add_outcome(other, other_status, report, status)
      type(factor_report_t), intent(in) :: other
      type(status_t), intent(in) :: other_status
      type(factor_report_t), intent(inout) :: report
      type(status_t), intent(inout) :: status
      type(factor_report_t) :: own
      logical :: is_first

      if (other_status%code == STATUS_INTERNAL) status = other_status
      if (other%worst_equation == 0) return
      own = report
      if (own%worst_equation == 0) report = other
      if (own%worst_equation == 0 .and. is_ok(status)) status = other_status
      if (own%worst_equation == 0) return
      report%sign_changes = own%sign_changes + other%sign_changes
      report%smallest_pivot = min(own%smallest_pivot, other%smallest_pivot)
      report%largest_pivot = max(own%largest_pivot, other%largest_pivot)
      is_first = other%digits_lost > own%digits_lost
      if (other_status%code == STATUS_SINGULAR) then
         is_first = is_ok(status)
         if (status%code == STATUS_SINGULAR) is_first = other%worst_equation < own%worst_equation
         if (is_first) status = other_status
      else if (status%code == STATUS_SINGULAR) then
         is_first = .false.
      end if
      report%digits_lost = max(own%digits_lost, other%digits_lost)
      if (is_first) report%worst_equation = other%worst_equation
   end subroutine add_outcome

   !> What this rank holds [bytes].
   pure integer(lp) function fronts_bytes(fronts) result(bytes)
      type(shared_fronts_t), intent(in) :: fronts
      integer(ip) :: f

      bytes = 0
      if (.not. allocated(fronts%held)) return
      bytes = 2*INDEX_BYTES*int(fronts%plan%n, lp)
      do f = 1, size(fronts%held, kind=ip)
         bytes = bytes + INDEX_BYTES*size(fronts%plan%front(f)%position, kind=lp)
         if (allocated(fronts%held(f)%columns)) bytes = bytes + REAL_BYTES*size(fronts%held(f)%columns, kind=lp)
         if (allocated(fronts%held(f)%update)) bytes = bytes + REAL_BYTES*size(fronts%held(f)%update, kind=lp)
      end do
   end function fronts_bytes

end module atrito_shared_fronts
