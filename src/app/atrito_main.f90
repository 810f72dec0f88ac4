!> atrito: contact with friction between elastic bodies by finite elements.
program atrito_main
   use atrito_driver, only: begin_program, run_program
   use atrito_mpi, only: begin_ranks, end_ranks, own_rank
   use atrito_rank_services, only: dismiss_ranks
   use atrito_service, only: serve
   use atrito_status, only: STATUS_INTERNAL, STATUS_OK
   use atrito_system, only: guard_exit, release_exit
   implicit none (type, external)
   integer :: code

   call guard_exit(STATUS_INTERNAL)
   call begin_ranks()
   call begin_program()
   if (own_rank() == 0) then
      call run_program(code)
      call dismiss_ranks()
   else
      call serve()
      code = STATUS_OK
   end if
   call end_ranks()
   call release_exit()
   stop code, quiet = .true.
end program atrito_main
