!> What the first rank asks of the parts that other ranks have, and their answers.
!>
!> A question is a parcel: SERVICE_PARTS, what is wanted, the ticket of the part, and what goes with it. `serve_parts` is the other
!> end. Questions about one part are answered in their order, so that several ranks work while the first waits for one.
module atrito_part_service
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: receive_parcel, send_parcel
   use atrito_parcel, only: parcel_t, put, take
   use atrito_part, only: part_t, put_part, take_part
   use atrito_part_store, only: part_store_t, outcome_t, hold_part, find_part, factor_part, get_part_schur, forget_part
   use atrito_rank_services, only: SERVICE_PARTS
   use atrito_status_parcel, only: put_status, put_text, take_status
   implicit none (type, external)
   private
   public :: serve_parts, give_part, ask_for_factors, receive_outcome, fetch_schur, ask_to_reduce, ask_to_expand, receive_columns, &
             ask_to_forget

   ! What is wanted.
   integer(ip), parameter :: HOLD = 1, FACTOR = 2, SCHUR = 3, REDUCE = 4, EXPAND = 5, FORGET = 6

contains

   !> Answers a question; what is left of the parcel comes behind SERVICE_PARTS.
   subroutine serve_parts(store, request)
      type(part_store_t), intent(inout) :: store
      type(parcel_t), intent(inout) :: request
      type(part_t) :: part
      type(outcome_t) :: outcome
      type(parcel_t) :: answer
      real(wp), allocatable :: columns(:, :)
      integer(ip) :: wanted, ticket, group, i

      call take(request, wanted)
      call take(request, ticket)
      i = find_part(store, ticket)
      select case (wanted)
      case (HOLD)
         call take(request, group)
         call take_part(request, part)
         call hold_part(store, ticket, group, part)
      case (FACTOR)
         call factor_part(store%list(i), outcome)
         call put_outcome(outcome, answer)
         call send_parcel(answer, 0_ip)
      case (SCHUR)
         call get_part_schur(store%list(i), columns)
         call put(answer, columns)
         call send_parcel(answer, 0_ip)
      case (REDUCE, EXPAND)
         call take(request, columns)
         if (wanted == REDUCE) then
            call store%list(i)%solver%reduce(columns)
         else
            call store%list(i)%solver%expand(columns)
         end if
         call put(answer, columns)
         call send_parcel(answer, 0_ip)
      case (FORGET)
         call forget_part(store, ticket)
      end select
   end subroutine serve_parts

   subroutine begin_request(wanted, ticket, request)
      integer(ip), intent(in) :: wanted, ticket
      type(parcel_t), intent(out) :: request

      call put(request, SERVICE_PARTS)
      call put(request, wanted)
      call put(request, ticket)
   end subroutine begin_request

   !> Sends a part to its rank.
   subroutine give_part(ticket, group, part)
      integer(ip), intent(in) :: ticket, group
      type(part_t), intent(in) :: part
      type(parcel_t) :: request

      call begin_request(HOLD, ticket, request)
      call put(request, group)
      call put_part(part, request)
      call send_parcel(request, part%rank)
   end subroutine give_part

   !> The rank begins; receive_outcome waits for its end.
   subroutine ask_for_factors(ticket, rank)
      integer(ip), intent(in) :: ticket, rank
      type(parcel_t) :: request

      call begin_request(FACTOR, ticket, request)
      call send_parcel(request, rank)
   end subroutine ask_for_factors

   subroutine receive_outcome(rank, outcome)
      integer(ip), intent(in) :: rank
      type(outcome_t), intent(out) :: outcome
      type(parcel_t) :: answer

      call receive_parcel(answer, rank)
      call take_outcome(answer, outcome)
   end subroutine receive_outcome

   subroutine fetch_schur(ticket, rank, matrix)
      integer(ip), intent(in) :: ticket, rank
      real(wp), allocatable, intent(out) :: matrix(:, :)
      type(parcel_t) :: request

      call begin_request(SCHUR, ticket, request)
      call send_parcel(request, rank)
      call receive_columns(rank, matrix)
   end subroutine fetch_schur

   !> The rank reduces loads; receive_columns has them.
   subroutine ask_to_reduce(ticket, rank, f)
      integer(ip), intent(in) :: ticket, rank
      real(wp), intent(in), contiguous :: f(:, :)    !< (equations of the part, loads) [F]

      call ask_with_columns(REDUCE, ticket, rank, f)
   end subroutine ask_to_reduce

   !> The rank expands solutions; receive_columns has them.
   subroutine ask_to_expand(ticket, rank, x)
      integer(ip), intent(in) :: ticket, rank
      real(wp), intent(in), contiguous :: x(:, :)    !< (equations of the part, loads)

      call ask_with_columns(EXPAND, ticket, rank, x)
   end subroutine ask_to_expand

   subroutine ask_with_columns(wanted, ticket, rank, columns)
      integer(ip), intent(in) :: wanted, ticket, rank
      real(wp), intent(in), contiguous :: columns(:, :)
      type(parcel_t) :: request

      call begin_request(wanted, ticket, request)
      call put(request, columns)
      call send_parcel(request, rank)
   end subroutine ask_with_columns

   subroutine receive_columns(rank, columns)
      integer(ip), intent(in) :: rank
      real(wp), allocatable, intent(out) :: columns(:, :)
      type(parcel_t) :: answer

      call receive_parcel(answer, rank)
      call take(answer, columns)
   end subroutine receive_columns

   subroutine ask_to_forget(ticket, rank)
      integer(ip), intent(in) :: ticket, rank
      type(parcel_t) :: request

      call begin_request(FORGET, ticket, request)
      call send_parcel(request, rank)
   end subroutine ask_to_forget

   subroutine put_outcome(outcome, parcel)
      type(outcome_t), intent(in) :: outcome
      type(parcel_t), intent(inout) :: parcel

      call put_status(parcel, outcome%status)
      associate (report => outcome%report)
         call put(parcel, [report%digits_lost, report%smallest_pivot, report%largest_pivot])
         call put(parcel, [report%worst_equation, report%sign_changes, report%n_fronts, report%n_different])
         call put(parcel, [report%entries, report%most_bytes, outcome%bytes])
      end associate
      call put(parcel, outcome%is_near)
      call put_text(parcel, outcome%order)
   end subroutine put_outcome

   subroutine take_outcome(parcel, outcome)
      type(parcel_t), intent(inout) :: parcel
      type(outcome_t), intent(out) :: outcome
      real(wp), allocatable :: reals(:)
      integer(ip), allocatable :: numbers(:)
      integer(lp), allocatable :: longs(:)

      call take_status(parcel, outcome%status)
      call take(parcel, reals)
      call take(parcel, numbers)
      call take(parcel, longs)
      associate (report => outcome%report)
         report%digits_lost = reals(1)
         report%smallest_pivot = reals(2)
         report%largest_pivot = reals(3)
         report%worst_equation = numbers(1)
         report%sign_changes = numbers(2)
         report%n_fronts = numbers(3)
         report%n_different = numbers(4)
         report%entries = longs(1)
         report%most_bytes = longs(2)
      end associate
      outcome%bytes = longs(3)
      call take(parcel, outcome%is_near)
      call take(parcel, outcome%order)
   end subroutine take_outcome

end module atrito_part_service
