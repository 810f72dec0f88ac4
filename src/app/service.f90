!> What ranks other than the first do: they wait for what the first wants of them, and do it.
module atrito_service
   use atrito_command_line, only: command_t, confine_command, TASK_STUDY, TASK_SWEEP
   use atrito_kinds, only: ip
   use atrito_mpi, only: receive_buffer, send_buffer
   use atrito_part_service, only: answer_question
   use atrito_shared_fields, only: answer_fields
   use atrito_buffer, only: buffer_t, take
   use atrito_rank_memory, only: serve_memory
   use atrito_rank_services, only: await_message, SERVICE_END, SERVICE_FIELDS, SERVICE_MEMORY, SERVICE_PART, SERVICE_RUNS
   use atrito_run_request, only: take_request
   use atrito_status, only: status_t
   use atrito_study, only: serve_study
   use atrito_sweep, only: serve_sweep
   implicit none (type, external)
   private
   public :: serve

contains

   !> Comes back when nothing more is wanted.
   subroutine serve()
      type(buffer_t) :: request, answer
      type(command_t) :: command
      type(status_t) :: status
      integer(ip) :: service

      do
         call await_message()
         call receive_buffer(request, 0_ip)
         call take(request, service)
         select case (service)
         case (SERVICE_END)
            return
         case (SERVICE_PART)
            answer = buffer_t()
            call answer_question(request, answer)
            call send_buffer(answer, 0_ip)
         case (SERVICE_FIELDS)
            call answer_fields(request, answer)
            call send_buffer(answer, 0_ip)
         case (SERVICE_MEMORY)
            call serve_memory()
         case (SERVICE_RUNS)
            call take_request(request, command)
            call confine_command(command, status)   ! rank 0 has told what is wrong
            if (command%task == TASK_SWEEP) call serve_sweep(command)
            if (command%task == TASK_STUDY) call serve_study(command)
         case default
            error stop 'atrito_service: an unknown service is wanted'
         end select
      end do
   end subroutine serve

end module atrito_service
