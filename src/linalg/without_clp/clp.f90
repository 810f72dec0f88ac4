!> The twin of src/linalg/clp.F90 in a build without Clp.
module atrito_clp
   use atrito_linear_program, only: linear_program_t, linear_solution_t
   implicit none (type, external)
   private
   public :: solve_linear_program, has_clp, clp_version, clp_trouble

contains

   !> solution%status: LP_NOT_AVAILABLE.
   subroutine solve_linear_program(program, method, solution)
      type(linear_program_t), intent(in) :: program    !< not looked at
      integer, intent(in) :: method                    !< not looked at
      type(linear_solution_t), intent(out) :: solution !< status alone: LP_NOT_AVAILABLE

   end subroutine solve_linear_program

   !> This build has no Clp.
   pure logical function has_clp()
      has_clp = .false.
   end function has_clp

   !> For --version.
   pure function clp_version() result(version)
      character(len=:), allocatable :: version

      version = 'none'
   end function clp_version

   !> Why there is no Clp, for messages.
   pure function clp_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'this build has none'
   end function clp_trouble

end module atrito_clp
