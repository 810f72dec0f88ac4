!> A search for other solutions of a contact line: Newton's method on the states, from many starts.
!>
!> The states of the points and the bound of friction are solved for together (atrito_newton, with nu p inside), which finds
!> solutions that the Picard loop runs away from, those of index -1 among them. The starts, all points with the same force at first:
!>
!>     1 all stick     2, 3 all slip along T, against it     4, 5 one half one way, the other half the other way
!>     6 and on        each point open, sticking, or slipping either way at random, in proportions that are random too
!>
!> Random numbers are those of a fixed sequence: a run finds what it found before. What is found is a solution; what is not found
!> may be there.
module atrito_other_solutions
   use atrito_bound_qp, only: bound_qp_t, FREE, AT_LOWER, AT_UPPER
   use atrito_contact_line, only: contact_line_t, normal_bounds, set_friction_bounds, tangential_of
   use atrito_contact_solution, only: contact_solution_t, bound_of_state
   use atrito_controls, only: controls_t
   use atrito_dense_blocks, only: multiply_symmetric
   use atrito_kinds, only: ip, lp, wp, HUGE_REAL
   use atrito_newton, only: iterate_newton
   implicit none (type, external)
   private
   public :: find_others, MOST_OTHERS

   integer(ip), parameter :: MOST_OTHERS = 20
   integer(ip), parameter :: MOST_STEPS = 40        !< of a start
   real(wp), parameter :: OTHER_FORCES = 1.0e-6_wp  !< of the largest stress or displacement: less is the same solution

   !> A sequence of random numbers: x <- 48271 x mod (2^31 - 1).
   type :: random_t
      integer(lp) :: x = 20231127_lp
   end type random_t

contains

   !> Solutions that are neither the first nor each other, at most MOST_OTHERS. None of them has been checked by anything else.
   !>
   !> Newton's method takes at most MOST_STEPS from each start, every one an LU of the active unknowns. Pressures at the start are
   !> all alike and above zero, so every point has a friction bound and may have any state. Most starts lead to the solution that
   !> is known, or to none; a trial that converged is compared with all that were found. It is kept with its state, for its index
   !> and its check.
   subroutine find_others(problem, line, controls, first, starts, others)
      type(bound_qp_t), intent(in) :: problem       !< the QP: C, G, g0, h
      type(contact_line_t), intent(in) :: line      !< points, laws, average S_rho
      type(controls_t), intent(in) :: controls      !< of which the tolerance counts
      type(contact_solution_t), intent(in) :: first !< that has been found
      integer(ip), intent(in) :: starts
      type(contact_solution_t), allocatable, intent(out) :: others(:)
      type(contact_solution_t) :: found(MOST_OTHERS), trial
      type(controls_t) :: own
      type(random_t) :: random
      integer(ip) :: k, i, n
      logical :: is_new

      own = controls
      own%max_iterations = MOST_STEPS
      n = 0
      do k = 1, starts
         call begin_trial(problem, line, first, k, random, trial)
         call iterate_newton(problem, line, own, trial)
         if (.not. trial%converged) cycle
         is_new = is_another(problem, first, trial)
         do i = 1, n
            is_new = is_new .and. is_another(problem, found(i), trial)
         end do
         if (.not. is_new) cycle
         n = n + 1
         found(n) = trial
         found(n)%inner%condition = first%inner%condition
         if (n == MOST_OTHERS) exit
      end do
      others = found(:n)
   end subroutine find_others

   !> Whether forces and displacements of two solutions differ by more than rounding. Where points depend on each other their forces
   !> can be shared out in many ways that move nothing: C (q_a - q_b) = 0, and gaps and slips are the same.
   logical function is_another(problem, a, b)
      type(bound_qp_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: a, b
      real(wp) :: of_a(problem%m), of_b(problem%m), length

      associate (p => a%state%q/problem%weight, q => b%state%q/problem%weight)
         is_another = maxval(abs(p - q)) > OTHER_FORCES*max(maxval(abs(p)), maxval(abs(q)))
      end associate
      if (.not. is_another) return
      call multiply_symmetric(problem%c, a%state%q, of_a)
      call multiply_symmetric(problem%c, b%state%q, of_b)
      length = OTHER_FORCES*maxval(abs([of_a, of_b]))
      is_another = maxval(abs(of_a - of_b)) > length
      length = max(length, OTHER_FORCES*maxval(abs([problem%g0, a%state%r, b%state%r])))
      is_another = is_another .or. maxval(abs(a%state%r - b%state%r)) > length
   end function is_another

   !> States of start k, and equal pressures: with friction bounds above zero at all points, whatever the states.
   subroutine begin_trial(problem, line, first, k, random, trial)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(in) :: first
      integer(ip), intent(in) :: k
      type(random_t), intent(inout) :: random
      type(contact_solution_t), intent(out) :: trial
      real(wp) :: share(4), pressure
      integer(ip) :: choice, i, j

      call normal_bounds(line, problem, trial%bounds, trial%state)
      associate (n => problem%n_normal, state => trial%state)
         ! A pressure of the size of those of the problem [F/L^2].
         pressure = maxval([0.0_wp, first%state%q(:problem%n_normal)/problem%weight(:problem%n_normal)])
         if (pressure <= 0.0_wp) then
            ! nothing touches: what would press a point back to where it was
            do j = 1, problem%n_normal
               if (.not. problem%c(j, j) > 0.0_wp) cycle
               pressure = max(pressure, abs(problem%g0(j))/problem%c(j, j)/problem%weight(j))
            end do
         end if
         where (trial%bounds%lower(:n) > -HUGE_REAL) state%q(:n) = pressure*problem%weight(:n)
         trial%history%tangential_of = tangential_of(line, n)
         trial%tau = bound_of_state(line, trial)
         call set_friction_bounds(line, problem, trial%tau, trial%bounds, state)
         share = [(-log(next(random)), i=1, 4)]
         share = share/sum(share)
         do i = 1, n
            associate (t => line%tangential(line%point(i)))
               choice = choice_of(k, line%point(i), line%n)
               if (choice == 0) choice = count(next(random) > [0.0_wp, share(1), sum(share(:2)), sum(share(:3))], kind=ip)
               if (choice == 4 .and. trial%bounds%lower(i) > -HUGE_REAL) then
                  state%state(i) = AT_LOWER
                  state%q(i) = 0.0_wp
               end if
               if (t == 0) cycle
               if (state%state(t) /= FREE) cycle
               if (choice == 2) state%state(t) = AT_UPPER
               if (choice == 3) state%state(t) = AT_LOWER
            end associate
         end do
      end associate
   end subroutine begin_trial

   !> What a point does in start k: 1 sticks, 2 slips along T, 3 against it, 4 is open; 0: as chance has it.
   pure integer(ip) function choice_of(k, point, points) result(choice)
      integer(ip), intent(in) :: k, point, points

      select case (k)
      case (1:3)
         choice = k
      case (4)
         choice = merge(2_ip, 3_ip, 2*point <= points)
      case (5)
         choice = merge(3_ip, 2_ip, 2*point <= points)
      case default
         choice = 0
      end select
   end function choice_of

   !> Between 0 and 1, neither of them.
   real(wp) function next(random)
      type(random_t), intent(inout) :: random
      integer(lp), parameter :: MODULUS = 2147483647_lp

      random%x = mod(48271_lp*random%x, MODULUS)
      next = real(random%x, wp)/real(MODULUS, wp)
   end function next

end module atrito_other_solutions
