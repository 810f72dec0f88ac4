!> atrito: contact with friction between elastic bodies by finite elements.
program atrito_main
   use atrito_driver, only: run_program
   implicit none (type, external)
   integer :: code

   call run_program(code)
   stop code, quiet = .true.
end program atrito_main
