!> The ladder: what is tried where an increment has no solution at first, rung by rung.
!>
!> Before a rung is tried it is asked whether there can be a solution (atrito_verdict): a proof that no forces which the contact
!> can take balance the loads ends the increment. A rung is one more attempt by another form, another method, or another start;
!> what it finds counts when it converges and passes the final check. C and the factors of the bodies serve all rungs of the
!> condensed form.
!>
!> METHOD=PICARD and NEWTON of a deck are the user's own choice, and have no rungs; nor has --contact sparse.
!>
!> Two more stand where they are used, as they are no other method: each element with its own last digits, where near elements
!> shared a stiffness (atrito_increment; tests/verify/near-elements, strip), and the plain start of a long line whose coarse line
!> leads nowhere (atrito_outer_loop; tests/verify/many-points, plain).
module atrito_ladder
   use atrito_contact_form, only: can_be_dense, CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE
   use atrito_controls, only: controls_t, METHOD_ANDERSON, METHOD_EASED, METHOD_NEWTON, METHOD_PICARD
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: rung_t, RUNGS, is_tried, controls_of_rung, rung_text

   type :: rung_t
      integer :: form, method                              !< CONTACT_DENSE or CONTACT_SPARSE; METHOD_*
      integer(ip) :: times = 1                             !< MAXIT of the deck
      real(wp) :: relaxation = 1.0_wp                      !< omega of Picard's step, or the mixing of Anderson's
      logical :: is_coarse = .false.                       !< all rows have the round-off of the largest
   end type rung_t

   !> In the order in which they are tried, each with scenes that have no solution without it (seed/number of random_scenes, in
   !> tests/extremes/CMakeLists.txt; in an optimised build, as round-off decides which states are tried). Small steps alone and more
   !> iterations of the dense form found nothing that these do not. EASED begins with NEWTON, as the line is (20290305/502).
   type(rung_t), parameter :: RUNGS(6) = [ &
                              rung_t(CONTACT_SPARSE, METHOD_ANDERSON), &           ! multipliers: 11/1, 11/137, 11/1172
                              rung_t(CONTACT_DENSE, METHOD_EASED), &               ! from more friction: 11/154, 4711/2464
                              rung_t(CONTACT_DENSE, METHOD_ANDERSON, 4_ip, 0.3_wp, .true.), & ! small steps, coarse: 11/542
                              rung_t(CONTACT_DENSE, METHOD_PICARD, 10_ip), &       ! the plain loop: 4711/3090, 11/2757
                              rung_t(CONTACT_DENSE, METHOD_PICARD, 10_ip, 0.3_wp), & ! damped: 11/1255, /1881, 4711/2888, /3289
                              rung_t(CONTACT_SPARSE, METHOD_ANDERSON, 10_ip)]      ! multipliers with more steps: 20290502/1146
   integer, parameter :: BRIEF = 2, QUICK = 2              !< of them in brief, and where points are many:
   integer(ip), parameter :: MOST_PATIENT = 400            !< unknown forces
   integer(ip), parameter :: FEW_FORCES = 50               !< so few that no rung costs anything

contains

   !> Whether a rung is tried after a first attempt in form `first`. With bounded effort none costs more than what it follows, but
   !> in scenes so small that none costs anything:
   !> behind the sparse form, which was taken because the dense one would cost more, there is none.
   pure logical function is_tried(i, first, asked, m, may_cut, is_brief)
      integer, intent(in) :: i                             !< of RUNGS
      integer, intent(in) :: first, asked                  !< CONTACT_*; asked: by the user, or CONTACT_AUTO
      integer(ip), intent(in) :: m                         !< unknown forces
      logical, intent(in) :: may_cut                       !< a shorter increment is tried next
      logical, intent(in) :: is_brief                      !< the effort is bounded

      if (RUNGS(i)%form == CONTACT_SPARSE) then
         is_tried = asked == CONTACT_AUTO .and. first == CONTACT_DENSE
      else
         is_tried = asked /= CONTACT_SPARSE .and. can_be_dense(m)
      end if
      if (may_cut .or. (is_brief .and. m > FEW_FORCES)) is_tried = is_tried .and. i <= BRIEF
      if (is_brief .and. m > FEW_FORCES) is_tried = is_tried .and. first == CONTACT_DENSE
      if (m > MOST_PATIENT) is_tried = is_tried .and. i <= QUICK
   end function is_tried

   !> The controls of a deck as a rung changes them.
   pure type(controls_t) function controls_of_rung(rung, usual) result(controls)
      type(rung_t), intent(in) :: rung
      type(controls_t), intent(in) :: usual

      controls = usual
      controls%method = rung%method
      controls%max_iterations = rung%times*usual%max_iterations
      controls%relaxation = rung%relaxation
      controls%is_coarse = rung%is_coarse
      controls%is_rung = .true.
   end function controls_of_rung

   !> What a rung is, besides its form.
   function rung_text(rung, controls) result(text)
      type(rung_t), intent(in) :: rung                     !< one of RUNGS
      type(controls_t), intent(in) :: controls             !< of the rung
      character(len=:), allocatable :: text

      text = ''
      if (rung%method == METHOD_NEWTON) text = ', NEWTON'
      if (rung%method == METHOD_EASED) text = ', from more friction'
      if (rung%method == METHOD_PICARD) text = ', PICARD'
      if (rung%relaxation < 1.0_wp) text = text//', RELAXATION='//to_text(rung%relaxation)
      if (rung%is_coarse) text = text//', coarse round-off'
      if (rung%times > 1) text = text//', MAXIT='//to_text(controls%max_iterations)
   end function rung_text

end module atrito_ladder
