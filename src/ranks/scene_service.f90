!> What the first rank asks of the parts of a scene that other ranks have (atrito_scene_part), and their answers.
!>
!> A question is a parcel: SERVICE_SCENE_PARTS, what is wanted, and what goes with it. `serve_scene_parts` is the other end. A rank
!> has one part, and that of one scene at a time.
!>
!> A solution takes two questions: of reduce_remote, behind which the rank keeps the reduced loads, and of expand_remote. So loads
!> and solutions of what is not shared go to and fro once.
module atrito_scene_service
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: receive_parcel, send_parcel
   use atrito_packed_matrices, only: packed_matrices_t, packed_length, put_packed
   use atrito_parcel, only: parcel_t, put, take
   use atrito_part_parcel, only: put_scene_part, take_scene_part
   use atrito_rank_services, only: SERVICE_SCENE_PARTS
   use atrito_scene_part, only: scene_part_t, assemble_scene_part, part_matrix, reduce_part, expand_part
   use atrito_status_parcel, only: put_status, put_text, take_status
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: scene_store_t, part_outcome_t, serve_scene_parts, factor_scene_part, solving_of_part
   public :: give_scene_part, ask_to_assemble, hear_assembled, ask_to_factor, hear_factored, ask_to_multiply, ask_to_reduce_scene, &
             ask_to_expand_scene, hear_values, ask_to_release

   !> What a rank has.
   type :: scene_store_t
      type(scene_part_t) :: part
      real(wp), allocatable :: x(:)              !< loads that were reduced
      real(wp), allocatable :: left(:)           !< of the part, the lower triangle by columns, where it stays here
   end type scene_store_t

   !> What became of a part.
   type :: part_outcome_t
      type(status_t) :: status
      logical :: is_near = .false.               !< of assembling, as is the order
      character(len=:), allocatable :: order
      integer(lp) :: solving = 0                 !< bytes that factoring will take
      integer(ip) :: failed = 0                  !< of factoring: unknown of the part whose pivot was not positive; 0: none
      logical :: is_changed = .false.            !< what is left of the part is another than before
      real(wp), allocatable :: left(:)           !< its lower triangle by columns, where it is another one
   end type part_outcome_t

   ! What is wanted.
   integer(ip), parameter :: HOLD = 1, MAKE = 2, MULTIPLY = 3, FACTOR = 4, REDUCE = 5, EXPAND = 6, FORGET = 7

contains

   !> Answers a question; what is left of the parcel comes behind SERVICE_SCENE_PARTS.
   subroutine serve_scene_parts(store, request)
      type(scene_store_t), intent(inout) :: store
      type(parcel_t), intent(inout) :: request
      type(scene_store_t) :: nothing
      integer(ip) :: wanted

      call take(request, wanted)
      select case (wanted)
      case (HOLD)
         store = nothing
         call take_scene_part(request, store%part)
      case (MAKE)
         call answer_assembled(store)
      case (FACTOR)
         call answer_factored(store, request)
      case (MULTIPLY, REDUCE, EXPAND)
         call answer_values(store, wanted, request)
      case (FORGET)
         store = nothing
      end select
   end subroutine serve_scene_parts

   subroutine answer_assembled(store)
      type(scene_store_t), intent(inout) :: store
      type(status_t) :: status
      type(parcel_t) :: answer

      call assemble_scene_part(store%part, status)
      call put_status(answer, status)
      call put(answer, store%part%scene%is_near)
      call put_text(answer, store%part%scene%order)
      call put(answer, solving_of_part(store%part, status))
      call send_parcel(answer, 0_ip)
   end subroutine answer_assembled

   !> What factoring a part will take, and what is left of it as a full matrix and packed [bytes]; 0 where it was not assembled.
   integer(lp) function solving_of_part(part, status) result(bytes)
      type(scene_part_t), intent(in) :: part
      type(status_t), intent(in) :: status           !< of assembling it
      integer(lp), parameter :: LEFT_BYTES = 12_lp

      bytes = 0
      if (is_ok(status)) bytes = part%scene%solving_bytes() + LEFT_BYTES*int(part%n_kept, lp)**2
   end function solving_of_part

   subroutine answer_factored(store, request)
      type(scene_store_t), intent(inout) :: store
      type(parcel_t), intent(inout) :: request
      real(wp), allocatable :: stiffness(:), pull(:)
      type(part_outcome_t) :: outcome
      type(parcel_t) :: answer
      logical :: is_wanted

      call take(request, is_wanted)
      call take(request, stiffness)
      call take(request, pull)
      call factor_scene_part(store%part, stiffness, pull, outcome)
      call put_status(answer, outcome%status)
      call put(answer, outcome%failed)
      call put(answer, outcome%is_changed)
      if (outcome%is_changed) then
         if (is_wanted) then
            call put(answer, outcome%left)
         else
            call move_alloc(outcome%left, store%left)
         end if
      end if
      call send_parcel(answer, 0_ip)
   end subroutine answer_factored

   !> Vectors: a product, what loads leave at the shared unknowns, or all unknowns from the shared ones.
   subroutine answer_values(store, wanted, request)
      type(scene_store_t), intent(inout) :: store
      integer(ip), intent(in) :: wanted
      type(parcel_t), intent(inout) :: request
      real(wp), allocatable :: x(:), y(:)
      type(parcel_t) :: answer
      integer(ip) :: n_interior

      call take(request, x)
      n_interior = store%part%scene%n - store%part%n_kept
      select case (wanted)
      case (MULTIPLY)
         allocate (y(size(x)))
         call store%part%scene%multiply(x, y)
      case (REDUCE)
         call reduce_part(store%part, x)
         y = x(n_interior + 1:)
         call move_alloc(x, store%x)
      case (EXPAND)
         store%x(n_interior + 1:) = x
         call expand_part(store%part, store%x)
         call move_alloc(store%x, y)
      end select
      call put(answer, y)
      call send_parcel(answer, 0_ip)
   end subroutine answer_values

   !> Factors a part, wherever it is, and gets what is left of it where that is another than before.
   subroutine factor_scene_part(part, stiffness, pull, outcome)
      type(scene_part_t), intent(inout) :: part
      real(wp), intent(in) :: stiffness(:), pull(:)  !< of the rows and amplitudes of the part [F/L]
      type(part_outcome_t), intent(out) :: outcome
      real(wp), allocatable :: s(:, :)
      type(packed_matrices_t) :: packed

      call part%scene%factor(stiffness, pull, outcome%status)
      outcome%failed = part%scene%failed
      if (.not. is_ok(outcome%status)) return    ! it will be factored again
      outcome%is_changed = part%scene%matrix%n_refactored > 0
      if (.not. outcome%is_changed) return
      packed%start = [1_ip, part%n_kept + 1_ip]
      allocate (s(part%n_kept, part%n_kept), outcome%left(packed_length(packed)))
      call part_matrix(part, s)
      call put_packed(packed, 1_ip, s, outcome%left)
   end subroutine factor_scene_part

   subroutine begin_request(wanted, request)
      integer(ip), intent(in) :: wanted
      type(parcel_t), intent(out) :: request

      call put(request, SERVICE_SCENE_PARTS)
      call put(request, wanted)
   end subroutine begin_request

   !> Sends a part to its rank, in the place of the one that it had.
   subroutine give_scene_part(rank, part)
      integer(ip), intent(in) :: rank
      type(scene_part_t), intent(in) :: part
      type(parcel_t) :: request

      call begin_request(HOLD, request)
      call put_scene_part(request, part)
      call send_parcel(request, rank)
   end subroutine give_scene_part

   !> The rank begins; hear_assembled waits for its end.
   subroutine ask_to_assemble(rank)
      integer(ip), intent(in) :: rank

      call ask_alone(MAKE, rank)
   end subroutine ask_to_assemble

   subroutine hear_assembled(rank, outcome)
      integer(ip), intent(in) :: rank
      type(part_outcome_t), intent(out) :: outcome
      type(parcel_t) :: answer

      call receive_parcel(answer, rank)
      call take_status(answer, outcome%status)
      call take(answer, outcome%is_near)
      call take(answer, outcome%order)
      call take(answer, outcome%solving)
   end subroutine hear_assembled

   !> The rank begins; hear_factored waits for its end.
   subroutine ask_to_factor(rank, is_wanted, stiffness, pull)
      integer(ip), intent(in) :: rank
      logical, intent(in) :: is_wanted           !< what is left comes to the first rank
      real(wp), intent(in), contiguous :: stiffness(:), pull(:)  !< of the rows and amplitudes of its part [F/L]
      type(parcel_t) :: request

      call begin_request(FACTOR, request)
      call put(request, is_wanted)
      call put(request, stiffness)
      call put(request, pull)
      call send_parcel(request, rank)
   end subroutine ask_to_factor

   subroutine hear_factored(rank, is_wanted, outcome)
      integer(ip), intent(in) :: rank
      logical, intent(in) :: is_wanted           !< as it was asked
      type(part_outcome_t), intent(out) :: outcome
      type(parcel_t) :: answer

      call receive_parcel(answer, rank)
      call take_status(answer, outcome%status)
      call take(answer, outcome%failed)
      call take(answer, outcome%is_changed)
      if (outcome%is_changed .and. is_wanted) call take(answer, outcome%left)
   end subroutine hear_factored

   !> The rank multiplies; hear_values has the product.
   subroutine ask_to_multiply(rank, x)
      integer(ip), intent(in) :: rank
      real(wp), intent(in), contiguous :: x(:)   !< (unknowns of its part) [L]

      call ask_with_values(MULTIPLY, rank, x)
   end subroutine ask_to_multiply

   !> The rank reduces loads; hear_values has what they leave at the shared unknowns.
   subroutine ask_to_reduce_scene(rank, f)
      integer(ip), intent(in) :: rank
      real(wp), intent(in), contiguous :: f(:)   !< (unknowns of its part) [F]

      call ask_with_values(REDUCE, rank, f)
   end subroutine ask_to_reduce_scene

   !> Behind that the rank expands the solution; hear_values has it.
   subroutine ask_to_expand_scene(rank, kept)
      integer(ip), intent(in) :: rank
      real(wp), intent(in), contiguous :: kept(:) !< (shared unknowns of its part) [L]

      call ask_with_values(EXPAND, rank, kept)
   end subroutine ask_to_expand_scene

   subroutine ask_with_values(wanted, rank, values)
      integer(ip), intent(in) :: wanted, rank
      real(wp), intent(in), contiguous :: values(:)
      type(parcel_t) :: request

      call begin_request(wanted, request)
      call put(request, values)
      call send_parcel(request, rank)
   end subroutine ask_with_values

   subroutine hear_values(rank, values)
      integer(ip), intent(in) :: rank
      real(wp), intent(out) :: values(:)
      type(parcel_t) :: answer
      real(wp), allocatable :: heard(:)

      call receive_parcel(answer, rank)
      call take(answer, heard)
      values = heard
   end subroutine hear_values

   subroutine ask_to_release(rank)
      integer(ip), intent(in) :: rank

      call ask_alone(FORGET, rank)
   end subroutine ask_to_release

   subroutine ask_alone(wanted, rank)
      integer(ip), intent(in) :: wanted, rank
      type(parcel_t) :: request

      call begin_request(wanted, request)
      call send_parcel(request, rank)
   end subroutine ask_alone

end module atrito_scene_service
