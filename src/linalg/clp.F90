!> Clp, the simplex method of COIN-OR (J. Forrest and others), by its C interface; the only module that knows it.
!>
!> The library is loaded when it is asked for, not with the program: CMake says which file that is (ATRITO_CLP_LIBRARY, its name
!> with the version in it). What it is asked for has been in its interface since version 1. A routine is found by its name each time
!> it is called, and the interface that it has is one of those below: what takes an integer, gives a real, and so on. A call that
!> goes through a pointer to a procedure costs nothing beside a programme.
module atrito_clp
   use, intrinsic :: iso_c_binding, only: c_associated, c_double, c_f_pointer, c_f_procpointer, c_funptr, c_int, c_ptr
   use atrito_system, only: find_routine
   use atrito_halting, only: halting_t, suspend_halting, restore_halting
   use atrito_kinds, only: ip
   use atrito_linear_program, only: linear_program_t, linear_solution_t, LP_OPTIMAL, LP_INFEASIBLE, LP_UNBOUNDED, LP_FAILED, &
                                    LP_BY_BARRIER
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: solve_linear_program, has_clp, clp_version, clp_trouble

   real(c_double), parameter :: TOLERANCE = 1.0e-9_c_double  !< of bounds and of reduced costs; entries are of size one
   integer(c_int), parameter :: MOST_STEPS_A_ROW = 30_c_int, FEWEST_STEPS = 20000_c_int

   abstract interface
      type(c_ptr) function new_model() bind(C)
         import :: c_ptr
      end function new_model
      subroutine delete_model(model) bind(C)
         import :: c_ptr
         type(c_ptr), value :: model
      end subroutine delete_model
      subroutine load_problem(model, columns, rows, start, index, value, lower, upper, objective, row_lower, row_upper) bind(C)
         import :: c_double, c_int, c_ptr
         type(c_ptr), value :: model
         integer(c_int), value :: columns, rows
         integer(c_int), intent(in) :: start(*), index(*)
         real(c_double), intent(in) :: value(*), lower(*), upper(*), objective(*), row_lower(*), row_upper(*)
      end subroutine load_problem
      subroutine set_integer(model, value) bind(C)
         import :: c_int, c_ptr
         type(c_ptr), value :: model
         integer(c_int), value :: value
      end subroutine set_integer
      subroutine set_real(model, value) bind(C)
         import :: c_double, c_ptr
         type(c_ptr), value :: model
         real(c_double), value :: value
      end subroutine set_real
      integer(c_int) function ask_integer(model) bind(C)
         import :: c_int, c_ptr
         type(c_ptr), value :: model
      end function ask_integer
      real(c_double) function ask_real(model) bind(C)
         import :: c_double, c_ptr
         type(c_ptr), value :: model
      end function ask_real
      type(c_ptr) function ask_array(model) bind(C)
         import :: c_ptr
         type(c_ptr), value :: model
      end function ask_array
      integer(c_int) function run_simplex(model, values_pass) bind(C)
         import :: c_int, c_ptr
         type(c_ptr), value :: model
         integer(c_int), value :: values_pass
      end function run_simplex
      integer(c_int) function ask_version() bind(C)
         import :: c_int
      end function ask_version
   end interface

contains

   !> solution%status: LP_*; x, dual and objective where it is LP_OPTIMAL. Columns and rows should be scaled to size one: they are
   !> taken as they are.
   subroutine solve_linear_program(program, method, solution)
      type(linear_program_t), intent(in) :: program    !< columns and rows scaled to size one; is not changed
      integer, intent(in) :: method                    !< LP_BY_*
      type(linear_solution_t), intent(out) :: solution !< arrays allocated only where status is LP_OPTIMAL
      procedure(new_model), pointer :: make
      type(c_ptr) :: model
      type(halting_t) :: halting
      procedure(ask_real), pointer :: objective

      if (.not. has_clp()) return
      call suspend_halting(halting)
      call c_f_procpointer(routine('Clp_newModel'), make)
      model = make()
      solution%status = LP_FAILED
      if (c_associated(model)) then
         call load(model, program)
         call solve()
         if (solution%status == LP_OPTIMAL) then
            call copy_array('Clp_primalColumnSolution', model, program%n_columns, solution%x)
            call copy_array('Clp_dualRowSolution', model, program%n_rows, solution%dual)
            call c_f_procpointer(routine('Clp_objectiveValue'), objective)
            solution%objective = objective(model)
         end if
         call release(model)
      end if
      call restore_halting(halting)

   contains

      !> The dual simplex method goes from basis to basis, each with reduced costs of the right signs, until no row is beyond its
      !> bounds: a few steps where the programme differs little from one that starts near its end. The barrier method goes through
      !> the interior in some twenty to fifty steps of a sparse factorisation each, whatever the size, and ends with simplex steps
      !> to a basis: it is for large programmes.
      subroutine solve()
         procedure(run_simplex), pointer :: simplex
         integer(c_int) :: ignored

         if (method == LP_BY_BARRIER) then
            ignored = ask('Clp_initialBarrierSolve', model)
         else
            call c_f_procpointer(routine('Clp_dual'), simplex)
            ignored = simplex(model, 0_c_int)
         end if
         select case (ask('Clp_status', model))
         case (0)
            solution%status = LP_OPTIMAL
         case (1)
            solution%status = LP_INFEASIBLE
         case (2)
            solution%status = LP_UNBOUNDED
         case default
            solution%status = LP_FAILED
         end select
         solution%iterations = int(ask('Clp_numberIterations', model), ip)
      end subroutine solve

   end subroutine solve_linear_program

   !> Hands the programme over, as Clp keeps it: A by columns, places counted from 0. Its own scaling is off, since columns and rows
   !> come scaled, and its tolerances then mean what they say.
   subroutine load(model, program)
      type(c_ptr), intent(in) :: model
      type(linear_program_t), intent(in) :: program
      procedure(load_problem), pointer :: load_into
      integer(c_int) :: steps

      call c_f_procpointer(routine('Clp_loadProblem'), load_into)
      call set('Clp_setLogLevel', model, 0_c_int)
      call load_into(model, int(program%n_columns, c_int), int(program%n_rows, c_int), program%first - 1_ip, program%row - 1_ip, &
                     program%entry, program%lower, program%upper, program%objective, program%row_lower, program%row_upper)
      call set('Clp_scaling', model, 0_c_int)
      call set_value('Clp_setPrimalTolerance', model, TOLERANCE)
      call set_value('Clp_setDualTolerance', model, TOLERANCE)
      steps = max(FEWEST_STEPS, MOST_STEPS_A_ROW*int(program%n_rows, c_int))
      call set('Clp_setMaximumIterations', model, steps)
   end subroutine load

   !> Gives the model back to Clp, with all it has.
   subroutine release(model)
      type(c_ptr), intent(in) :: model
      procedure(delete_model), pointer :: delete

      call c_f_procpointer(routine('Clp_deleteModel'), delete)
      call delete(model)
   end subroutine release

   !> n reals of an array inside Clp, which one of its routines points to; zeros where it has none.
   subroutine copy_array(symbol, model, n, values)
      character(len=*), intent(in) :: symbol
      type(c_ptr), intent(in) :: model
      integer(ip), intent(in) :: n
      real(c_double), allocatable, intent(out) :: values(:)
      procedure(ask_array), pointer :: array
      real(c_double), pointer :: inside(:)
      type(c_ptr) :: place

      allocate (values(n), source=0.0_c_double)
      call c_f_procpointer(routine(symbol), array)
      place = array(model)
      if (.not. c_associated(place)) return
      call c_f_pointer(place, inside, [n])
      values = inside
   end subroutine copy_array

   !> What a routine of Clp of this name answers about the model.
   integer(c_int) function ask(symbol, model) result(value)
      character(len=*), intent(in) :: symbol
      type(c_ptr), intent(in) :: model
      procedure(ask_integer), pointer :: question

      call c_f_procpointer(routine(symbol), question)
      value = question(model)
   end function ask

   !> Sets an integer of the model by the routine of this name.
   subroutine set(symbol, model, value)
      character(len=*), intent(in) :: symbol
      type(c_ptr), intent(in) :: model
      integer(c_int), intent(in) :: value
      procedure(set_integer), pointer :: setter

      call c_f_procpointer(routine(symbol), setter)
      call setter(model, value)
   end subroutine set

   !> Sets a real of the model.
   subroutine set_value(symbol, model, value)
      character(len=*), intent(in) :: symbol
      type(c_ptr), intent(in) :: model
      real(c_double), intent(in) :: value
      procedure(set_real), pointer :: setter

      call c_f_procpointer(routine(symbol), setter)
      call setter(model, value)
   end subroutine set_value

   !> A routine of Clp by its name; null where there is none.
   type(c_funptr) function routine(symbol)
      character(len=*), intent(in) :: symbol

      routine = find_routine(ATRITO_CLP_LIBRARY, symbol)
   end function routine

   !> Whether the library can be loaded.
   logical function has_clp()
      has_clp = c_associated(routine('Clp_newModel')) .and. c_associated(routine('Clp_dual'))
   end function has_clp

   !> For --version: '1.17.5'; the library must be there.
   function clp_version() result(version)
      character(len=:), allocatable :: version

      version = number('Clp_VersionMajor')//'.'//number('Clp_VersionMinor')//'.'//number('Clp_VersionRelease')
   end function clp_version

   !> One of the three numbers of the version; `?` where an old library does not say it.
   function number(symbol) result(text)
      character(len=*), intent(in) :: symbol
      character(len=:), allocatable :: text
      procedure(ask_version), pointer :: question
      type(c_funptr) :: place

      text = '?'
      place = routine(symbol)
      if (.not. c_associated(place)) return
      call c_f_procpointer(place, question)
      text = to_text(int(question(), ip))
   end function number

   !> Why there is no Clp, where there is none.
   pure function clp_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'the library '//ATRITO_CLP_LIBRARY//' cannot be loaded'
   end function clp_trouble

end module atrito_clp
