!> The part of a scene that a rank has (atrito_scene_part), and what the first rank asks of it.
!>
!> With A_p the matrix of part p, its unknowns in the order interior i, kept c, the system of the scene is solved by direct
!> substructuring:
!>
!>     S_p = A_cc - A_ci A_ii^-1 A_ic        REFACTOR, on each rank, which keeps it
!>     S = sum of S_p, factored              SCHUR_FACTOR, by MUMPS on all ranks together
!>     g_c = f_c - A_ci A_ii^-1 f_i          REDUCE, on each rank
!>     S x_c = sum of g_c                    SCHUR_SOLVE, the same
!>     x_i = A_ii^-1 (f_i - A_ic x_c)        EXPAND, on each rank
!>
!> A question is a buffer: SERVICE_PART, what is wanted, and what goes with it. The first rank asks itself as it asks the others,
!> but after them, so that all work at the same time. A rank has one part, and that of one scene at a time.
module atrito_part_service
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: receive_buffer, send_buffer
   use atrito_mumps, only: mumps_system_t, begin_mumps_system, end_mumps_system, factor_mumps_system, mumps_system_bytes, &
                           solve_mumps_system
   use atrito_multifrontal, only: expand_variable, kept_values, reduce_variable
   use atrito_buffer, only: buffer_t, put, put_status, put_text, take
   use atrito_rank_services, only: SERVICE_PART
   use atrito_scene_part, only: scene_part_t, assemble_scene_part, take_scene_part
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: begin_question, ask, ask_with, hear, hear_values
   public :: held_bytes, ASSEMBLE, MULTIPLY, REFACTOR, REDUCE, EXPAND, SCHUR_BEGIN, SCHUR_FACTOR, SCHUR_SOLVE, FORGET, &
             answer_question

   ! What is wanted.
   integer(ip), parameter :: ASSEMBLE = 1, MULTIPLY = 2, REFACTOR = 3, REDUCE = 4, EXPAND = 5, &
                             SCHUR_BEGIN = 6, SCHUR_FACTOR = 7, SCHUR_SOLVE = 8, FORGET = 9

   !> What a rank has.
   type :: store_t
      type(scene_part_t) :: part                 !< this rank's own; one at a time
      real(wp), allocatable :: x(:)              !< loads that were reduced
      type(mumps_system_t) :: schur              !< S, of all ranks
   end type store_t

   type(store_t), target :: own
   type(buffer_t) :: own_answer                  !< of the first rank to itself

contains

   !> The head of a question about a part: what is wanted, one of the constants above; what it needs is put behind it.
   subroutine begin_question(wanted, request)
      integer(ip), intent(in) :: wanted          !< a constant of this module, e.g. REFACTOR
      type(buffer_t), intent(out) :: request     !< what goes with it is put behind

      call put(request, SERVICE_PART)
      call put(request, wanted)
   end subroutine begin_question

   !> Asks a rank; the first one, the last that is asked, works at once. The answer comes with hear.
   subroutine ask(rank, request)
      integer(ip), intent(in) :: rank            !< 0.. of the run
      type(buffer_t), intent(inout) :: request   !< by begin_question
      integer(ip) :: service

      if (rank > 0) then
         call send_buffer(request, rank)
      else
         call take(request, service)
         own_answer = buffer_t()
         call answer_question(request, own_answer)
      end if
   end subroutine ask

   !> Asks with one vector over the unknowns of the part: MULTIPLY, REDUCE, EXPAND.
   subroutine ask_with(rank, wanted, values)
      integer(ip), intent(in) :: rank, wanted       !< 0.. of the run; MULTIPLY, REDUCE or EXPAND
      real(wp), intent(in), contiguous :: values(:) !< over unknowns of the part; EXPAND: those it shares
      type(buffer_t) :: request

      call begin_question(wanted, request)
      call put(request, values)
      call ask(rank, request)
   end subroutine ask_with

   !> The answer to ask, from the rank that was asked.
   subroutine hear(rank, answer)
      integer(ip), intent(in) :: rank            !< 0.. of the run, as it was asked
      type(buffer_t), intent(out) :: answer      !< as the question has it

      if (rank > 0) call receive_buffer(answer, rank)
      if (rank == 0) answer = own_answer
   end subroutine hear

   !> The answer to ask_with.
   subroutine hear_values(rank, values)
      integer(ip), intent(in) :: rank                 !< 0.. of the run, as it was asked
      real(wp), allocatable, intent(out) :: values(:) !< over the unknowns of the part, or those it shares
      type(buffer_t) :: answer

      call hear(rank, answer)
      call take(answer, values)
   end subroutine hear_values

   !> Does what a question asks of this rank's part of the scene, and puts what rank 0 wants to know into the answer.
   subroutine answer_question(request, answer)
      type(buffer_t), intent(inout) :: request, answer
      type(scene_part_t) :: no_part
      integer(ip) :: wanted

      call take(request, wanted)
      select case (wanted)
      case (ASSEMBLE)
         call answer_assembled(request, answer)
      case (REFACTOR)
         call answer_factored(request, answer)
      case (MULTIPLY, REDUCE, EXPAND)
         call answer_values()
      case (SCHUR_BEGIN, SCHUR_FACTOR, SCHUR_SOLVE)
         call answer_schur()
      case (FORGET)
         call end_mumps_system(own%schur)
         own%part = no_part
      end select

   contains

      !> Vectors: A_p x; g_c of the loads f; x of x_c.
      subroutine answer_values()
         real(wp), allocatable :: x(:), y(:)
         integer(ip) :: n_interior

         call take(request, x)
         n_interior = own%part%scene%n - own%part%n_kept
         select case (wanted)
         case (MULTIPLY)
            allocate (y(size(x)))
            call own%part%scene%multiply(x, y)
         case (REDUCE)
            call reduce_variable(own%part%scene%matrix, x)
            y = x(n_interior + 1:)
            call move_alloc(x, own%x)
         case (EXPAND)
            own%x(n_interior + 1:) = x
            call expand_variable(own%part%scene%matrix, own%x)
            call move_alloc(own%x, y)
         end select
         call put(answer, y)
      end subroutine answer_values

      !> All ranks are asked, for MUMPS wants them together: to begin, with the number of shared unknowns and those of this rank;
      !> to factor; to solve, with the loads [F], which the first rank alone has. Answer: status, the unknown that moves most in the
      !> softest motion of an S that has no factor, or the solution [L].
      subroutine answer_schur()
         type(status_t) :: status
         integer(ip) :: n
         integer(ip), allocatable :: unknown(:)
         real(wp), allocatable :: x(:)
         real(wp), pointer, contiguous :: values(:)
         real(wp), target :: nothing(0)

         select case (wanted)
         case (SCHUR_BEGIN)
            call take(request, n)
            call take(request, unknown)
            call begin_mumps_system(own%schur, n, unknown, status)
            call put_status(answer, status)
         case (SCHUR_FACTOR)
            values => kept_values(own%part%scene%matrix)
            if (.not. associated(values)) values => nothing   ! the rank has no part, or shares nothing
            call factor_mumps_system(own%schur, values, status)
            call put_status(answer, status)
            call put(answer, own%schur%weakest)
         case (SCHUR_SOLVE)
            call take(request, x)
            call solve_mumps_system(own%schur, x, status)
            call put_status(answer, status)
            call put(answer, x)
         end select
      end subroutine answer_schur

   end subroutine answer_question

   !> Takes the part, in the place of the one that there was. Answer: status, is_near, the order, what factoring will take [bytes].
   subroutine answer_assembled(request, answer)
      type(buffer_t), intent(inout) :: request, answer
      type(status_t) :: status
      real(wp) :: bytes

      call take_scene_part(request, own%part)
      request = buffer_t()                       ! what was taken needs no copy
      call assemble_scene_part(own%part, status)
      bytes = 0.0_wp
      if (is_ok(status)) bytes = real(own%part%scene%solving_bytes(), wp)
      call put_status(answer, status)
      call put(answer, own%part%scene%is_near)
      call put_text(answer, own%part%scene%order)
      call put(answer, bytes)
   end subroutine answer_assembled

   !> Takes the stiffness of rows and pulls [F/L]. Answer: status, the unknown whose pivot was not positive, whether S_p is another.
   subroutine answer_factored(request, answer)
      type(buffer_t), intent(inout) :: request, answer
      real(wp), allocatable :: stiffness(:), pull(:)
      type(status_t) :: status

      call take(request, stiffness)
      call take(request, pull)
      associate (scene => own%part%scene)
         call scene%factor(stiffness, pull, status)
         call put_status(answer, status)
         call put(answer, scene%failed)
         call put(answer, is_ok(status) .and. scene%matrix%n_refactored > 0)   ! what failed is factored again
      end associate
   end subroutine answer_factored

   !> Memory held by this process for its part and S [bytes].
   pure integer(lp) function held_bytes() result(bytes)
      bytes = mumps_system_bytes(own%schur)
      if (own%part%scene%n > 0) bytes = bytes + own%part%scene%memory_bytes()
   end function held_bytes

end module atrito_part_service
