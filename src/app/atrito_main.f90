!> atrito: contact with friction between elastic bodies by finite elements.
program atrito_main
   use atrito_driver, only: run_program
   use atrito_exit_guard, only: guard_exit, release_exit
   implicit none (type, external)
   integer :: code

   call guard_exit()
   call run_program(code)
   call release_exit()
   stop code, quiet = .true.
end program atrito_main
