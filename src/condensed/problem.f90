!> One increment as plain data: the bodies with what acts on them, the points where they meet, and what is left from the increment
!> before. Both forms of the contact system solve it (atrito_solve_condensed, atrito_solve_multiplier); neither knows the deck.
module atrito_problem
   use atrito_assembly, only: fem_t
   use atrito_base_loads, only: base_loads_t, load_of_bases, without_prescribed
   use atrito_bilateral_rows, only: bilateral_rows_t
   use atrito_bound_qp, only: bound_qp_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_kinds, only: wp
   use atrito_points, only: contact_points_t
   use atrito_reporter, only: reporter_t
   implicit none (type, external)
   private
   public :: problem_t, free_load

   !> What an increment is made of. The first group is the problem; the second is what the increments of a history hand on, and is
   !> empty where an increment stands alone.
   type :: problem_t
      type(reporter_t) :: reporter = reporter_t(quiet=.true.) !< a line an iteration, a factorisation
      type(fem_t) :: fem                                    !< bodies and elements
      logical, allocatable :: held(:, :)                    !< (2, n_nodes)
      real(wp), allocatable :: value(:, :)                  !< (2, n_nodes) prescribed displacements [L]
      real(wp), allocatable :: f(:, :)                      !< (2, n_nodes) applied forces [F]
      real(wp), allocatable :: thermal(:, :)                !< (2, n_nodes) of temperatures [F]; not allocated: none
      type(contact_points_t), allocatable :: points(:)      !< of each pair
      type(contact_rows_t) :: rows                          !< of the points, and of ties, equations, supports and springs
      type(contact_line_t) :: line                          !< laws and unknowns of the points
      type(bilateral_rows_t), pointer :: bilateral => null() !< of the model
      integer :: solver_kind = 0                            !< that the bodies are numbered for
      ! Of a history:
      logical :: keeps = .false.                            !< what one increment leaves serves the next
      type(base_loads_t), allocatable :: bases              !< whose sum the loads of each increment of the step are
      type(bound_qp_t), allocatable :: flexibility          !< C and G of the bodies that are factored
      type(contact_solution_t), allocatable :: last         !< of the increment before, to start from
      logical :: only_from_last = .false.                   !< where that leads nowhere, no other start is tried
   end type problem_t

contains

   !> Applied forces and those of the temperatures less those of the prescribed displacements. The temperatures' are in balance in
   !> every element, so they have no part in what moves a body: whoever sums forces takes problem%f alone.
   function free_load(problem) result(load)
      class(problem_t), intent(in) :: problem !< the increment
      real(wp), allocatable :: load(:, :)                   !< (2, n_nodes) [F]

      if (allocated(problem%bases)) then
         load = load_of_bases(problem%bases)
      else
         load = without_prescribed(problem%fem, problem%f, problem%thermal, problem%value)
      end if
   end function free_load

end module atrito_problem
