!> atrito: contact with friction between elastic bodies by finite elements.
program atrito_main
   use atrito_driver, only: run_program
   use atrito_status, only: STATUS_INTERNAL
   use atrito_system, only: guard_exit, release_exit
   implicit none (type, external)
   integer :: code

   call guard_exit(STATUS_INTERNAL)
   call run_program(code)
   call release_exit()
   stop code, quiet = .true.
end program atrito_main
