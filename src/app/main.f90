!> atrito: contact with friction between elastic bodies by finite elements.
program atrito_main
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   use atrito_driver, only: begin_program, run_program, serve
   use atrito_kinds, only: ip
   use atrito_mpi, only: begin_ranks, end_ranks, has_mpi, own_rank, rank_count, ranks_on_host
   use atrito_rank_services, only: dismiss_ranks
   use atrito_status, only: STATUS_INTERNAL, STATUS_OK
   use atrito_system, only: be_rank, forgive_faults, guard_exit, release_exit
   implicit none (type, external)
   integer(ip) :: n_on_host
   integer :: code

   call guard_exit(STATUS_INTERNAL)
   call begin_ranks()
   call begin_program()
   if (rank_count() > 1) call be_rank(int(own_rank()))
   n_on_host = ranks_on_host()
   if (own_rank() == 0) then
      call run_program(n_on_host, code)
      call dismiss_ranks()
   else
      call serve()
      code = STATUS_OK
   end if
   if (has_mpi()) then
      flush (output_unit)
      flush (error_unit)
      call forgive_faults(code)
   end if
   call end_ranks()
   call release_exit()
   stop code, quiet = .true.
end program atrito_main
