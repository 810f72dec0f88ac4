!> Whether the solution of a contact line is the only one: what is proved, and what is not.
!>
!>     1. without friction there is one;
!>     2. a certificate of the matrix (atrito_one_solution), for every load up to a coefficient of friction. It does not depend on
!>        the loads: a history makes one as long as the bodies are factored;
!>     3. where it does not reach the deck's coefficients: the index of the solution (atrito_state_index); with exact stick, whether
!>        another one can move the same way at every point; and an estimate of the contraction (atrito_contraction), no proof.
!>
!> The largest coefficient stands for all: those of other pairs are scaled with it.
module atrito_uniqueness
   use atrito_bound_qp, only: bound_qp_t, AT_LOWER, AT_UPPER
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_contraction, only: estimate_contraction
   use atrito_friction_form, only: friction_form_t, build_form
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_kinds, only: ip, wp
   use atrito_one_solution, only: certify_every_load, certify_way
   use atrito_results, only: uniqueness_t
   use atrito_state_index, only: index_of_solution
   implicit none (type, external)
   private
   public :: certify_line, judge_solution, is_certified, LONGEST

   integer(ip), parameter :: LONGEST = 400        !< unknown forces of a line that is certified without being asked to

contains

   !> What is certified of a line for every load.
   subroutine certify_line(problem, line, is_asked, uniqueness)
      type(bound_qp_t), intent(in) :: problem     !< C and G
      type(contact_line_t), intent(in) :: line    !< points, laws, average S_rho
      logical, intent(in) :: is_asked             !< also where the line is long
      type(uniqueness_t), intent(out) :: uniqueness
      type(friction_form_t) :: form
      character(len=:), allocatable :: why_not
      real(wp) :: nu

      uniqueness%nu = maxval([0.0_wp, line%law(line%point(problem%n_normal + 1:))%nu])
      if (.not. uniqueness%nu > 0.0_wp) return
      if (problem%m > LONGEST .and. .not. is_asked) then
         uniqueness%why_not = 'the line is long: --unique asks for it'
         return
      end if
      call build_form(problem, line, form, why_not)
      if (len(why_not) == 0) then
         call certify_every_load(form, nu)
         uniqueness%up_to_nu = rounded_down(nu)
         if (.not. nu > 0.0_wp) why_not = 'contact points depend on each other'
      end if
      uniqueness%why_not = why_not
   end subroutine certify_line

   !> Adds what is proved of a solution that no certificate makes the only one, and the estimate of the contraction.
   !>
   !> For bodies that move along the contact, and where points depend on each other, the index proves nothing, as the certificates.
   subroutine judge_solution(problem, line, solution, in_full, uniqueness, contraction)
      type(bound_qp_t), intent(in) :: problem     !< C and G
      type(contact_line_t), intent(in) :: line    !< points, laws, average S_rho
      type(contact_solution_t), intent(in) :: solution !< converged or not
      logical, intent(in) :: in_full              !< else the index alone
      type(uniqueness_t), intent(inout) :: uniqueness  !< of certify_line
      real(wp), intent(out) :: contraction        !< estimate; 0 where it says nothing new
      type(friction_form_t) :: form
      character(len=:), allocatable :: why_not
      real(wp) :: nu

      contraction = 0.0_wp
      if (is_certified(uniqueness)) then
         uniqueness%index = 1
         return
      end if
      if (in_full) contraction = estimate_contraction(problem, line, solution%bounds%d, solution%state%state)
      if (.not. solution%converged .or. len_trim(uniqueness%why_not) > 0) return
      uniqueness%index = index_of_solution(problem, line, solution)
      if (.not. in_full .or. has_elastic_stick(line)) return
      call build_form(problem, line, form, why_not)
      call certify_way(form, way_of(problem, solution), nu)
      uniqueness%same_way_up_to_nu = rounded_down(nu)
   end subroutine judge_solution

   !> Whether there is one solution alone, as far as is proved.
   pure logical function is_certified(uniqueness)
      type(uniqueness_t), intent(in) :: uniqueness

      is_certified = .not. uniqueness%nu > uniqueness%up_to_nu
   end function is_certified

   !> Whether some law has elastic slip before its full friction.
   pure logical function has_elastic_stick(line)
      type(contact_line_t), intent(in) :: line

      has_elastic_stick = any(line%law%kind /= FRICTION_NONE .and. (line%law%eps > 0.0_wp .or. line%law%compliance > 0.0_wp))
   end function has_elastic_stick

   !> Three digits of a number, none larger: what is told is certified, whatever the last digits of the search.
   pure real(wp) function rounded_down(x)
      real(wp), intent(in) :: x                   !< >= 0
      character(len=9) :: text

      rounded_down = 0.0_wp
      if (.not. x > 0.0_wp) return
      associate (unit => 10.0_wp**(floor(log10(x)) - 2))
         write (text, '(es9.2)') floor(x/unit)*unit
      end associate
      read (text, '(es9.2)') rounded_down
   end function rounded_down

   !> The directions along which a solution moves; points that stick may be taken to go along with most of the others.
   pure function way_of(problem, solution) result(direction)
      type(bound_qp_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      real(wp) :: direction(problem%m - problem%n_normal)

      associate (state => solution%state%state(problem%n_normal + 1:), r => solution%state%r(problem%n_normal + 1:))
         direction = 0.0_wp
         where (state == AT_UPPER) direction = 1.0_wp
         where (state == AT_LOWER) direction = -1.0_wp
         where (solution%bounds%upper(problem%n_normal + 1:) <= 0.0_wp) direction = sign(1.0_wp, r)
         where (abs(direction) <= 0.0_wp) direction = merge(1.0_wp, -1.0_wp, sum(direction) >= 0.0_wp)
      end associate
   end function way_of

end module atrito_uniqueness
