!> Why a scene has no solution, in words and numbers: which body moves how, what drives it, and what friction could hold.
module atrito_free_motion
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: body_t
   use atrito_box_problem, only: box_problem_t, FREE
   use atrito_condensed_body, only: motion_text
   use atrito_contact_line, only: contact_line_t, pressure_of, friction_bound
   use atrito_contact_problem, only: motion_body
   use atrito_contact_rows, only: contact_rows_t, row_value
   use atrito_contact_solution, only: contact_solution_t
   use atrito_kinds, only: ip, wp
   use atrito_recovery, only: add_rigid_motions
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: free_motion_text, motion_forces_t, measure_motion

   !> Forces on a motion whose fastest part is of size one: [F] along a translation, [F L] about a point.
   type :: motion_forces_t
      logical :: turns = .false.
      logical :: slides = .false.              !< no point that was closed opens
      logical :: together = .false.            !< a translation with what it touches: no point opens or slides
      real(wp) :: load = 0.0_wp                !< H
      real(wp) :: normal = 0.0_wp              !< N of the points that slide
      real(wp) :: friction = 0.0_wp            !< nu N, what friction can hold at most
      integer(ip) :: n_closed = 0
   end type motion_forces_t

   real(wp), parameter :: SMALL = 1.0e-6_wp    !< part of a motion that is none
   integer, parameter :: DIGITS = 5

contains

   !> The whole sentence.
   function free_motion_text(fem, held, rows, line, problem, solution) result(text)
      type(fem_t), intent(in) :: fem
      logical, intent(in) :: held(:, :)        !< (2, n_nodes)
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(box_problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      character(len=:), allocatable :: text
      type(motion_forces_t) :: forces
      real(wp) :: mode(3)
      integer(ip) :: b

      call motion_body(fem, solution%inner%motion, b, mode)
      forces = measure_motion(fem%bodies%list(b), mode, line, problem, solution)
      if (forces%n_closed > 0 .and. .not. forces%turns) then
         forces%together = moves_together(fem, rows, line, problem, solution)
      end if
      text = motion_text(fem, b, mode)
      if (forces%turns) text = text//pivot_text(fem, b, mode, rows)
      text = text//' under its load: '//cause_text(forces, line)//'; '//support_text(fem, b, held)
   end function free_motion_text

   !> What drives a motion and what could hold it, from the forces of the last inner problem.
   function measure_motion(body, mode, line, problem, solution) result(forces)
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: mode(3)          !< of the body that moves most
      type(contact_line_t), intent(in) :: line
      type(box_problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      type(motion_forces_t) :: forces
      real(wp) :: moved(problem%m), p(line%n), tau(line%n), scale, opening
      integer(ip) :: i, j, t

      associate (a => solution%inner%motion)
         forces%turns = abs(mode(3)) > SMALL*maxval(abs(mode))
         scale = norm2(mode(:2))
         if (forces%turns) scale = abs(mode(3))/body%size
         moved = matmul(problem%g, a)/scale
         forces%load = dot_product(problem%h, a)/scale
      end associate
      p = pressure_of(line, solution%state%q)        ! tensions too: N is what equilibrium asks for
      tau = friction_bound(line, p)
      opening = 0.0_wp
      do i = 1, problem%n_normal
         j = line%point(i)
         if (solution%state%state(i) /= FREE) cycle
         forces%n_closed = forces%n_closed + 1
         opening = max(opening, abs(moved(i)))
         t = line%tangential(j)
         if (t == 0) cycle
         forces%normal = forces%normal + p(j)*line%weight(j)*abs(moved(t))
         forces%friction = forces%friction + tau(j)*line%weight(j)*abs(moved(t))
      end do
      forces%slides = forces%n_closed > 0 .and. opening <= SMALL*maxval(abs([moved, 0.0_wp]))
   end function measure_motion

   !> Whether no closed point opens or slides: the motion takes along what the body touches.
   function moves_together(fem, rows, line, problem, solution) result(together)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(box_problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      logical :: together
      real(wp), allocatable :: u(:, :)
      real(wp) :: relative
      integer(ip) :: i, j

      allocate (u(2, fem%mesh%n_nodes), source=0.0_wp)
      call add_rigid_motions(fem, solution%inner%motion, u)
      together = .true.
      do i = 1, problem%n_normal
         if (solution%state%state(i) /= FREE) cycle
         j = line%point(i)
         relative = max(abs(row_value(rows, j, rows%normal(:, j), u)), abs(row_value(rows, j, rows%tangent(:, j), u)))
         together = together .and. relative <= SMALL*maxval(abs(u))
      end do
   end function moves_together

   function cause_text(forces, line) result(text)
      type(motion_forces_t), intent(in) :: forces
      type(contact_line_t), intent(in) :: line
      character(len=:), allocatable :: text

      if (line%n == 0) then
         text = 'the load drives it with '//amount(forces%load, forces%turns)
      else if (forces%together) then
         text = 'the load drives it, together with the body that it touches, with '//amount(forces%load, .false.)
      else if (forces%turns) then
         text = 'the load turns it with '//amount(forces%load, .true.)//' about that point, and no pressure there holds it'
      else if (forces%slides .and. line%has_friction) then
         text = 'it slides, the load drives it with H = '//amount(forces%load, .false.)//' and friction holds nu times N = ' &
                //amount(forces%friction, .false.)//' at most (N = '//amount(forces%normal, .false.) &
                //trim(merge(')                              ', ', its pressure averaged by rho)', line%average%is_identity))
      else if (forces%slides) then
         text = 'it slides, the load drives it with H = '//amount(forces%load, .false.)//' and there is no friction'
      else
         text = 'the contact opens, the load drives it with '//amount(forces%load, .false.)
      end if
   end function cause_text

   pure function amount(force, turns) result(text)
      real(wp), intent(in) :: force
      logical, intent(in) :: turns
      character(len=:), allocatable :: text

      text = to_text(force, DIGITS)//' [F'//trim(merge(' L]', ']  ', turns))
   end function amount

   !> The contact node about which a body turns, where there is one.
   pure function pivot_text(fem, b, mode, rows) result(text)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      real(wp), intent(in) :: mode(3)
      type(contact_rows_t), intent(in) :: rows
      character(len=:), allocatable :: text
      real(wp) :: centre(2)
      integer(ip) :: j

      text = ''
      associate (body => fem%bodies%list(b))
         centre = body%centre + [-mode(2), mode(1)]*body%size/mode(3)
         do j = 1, rows%n
            if (norm2(fem%mesh%x(:, rows%node(1, j)) - centre) > SMALL*body%size) cycle
            text = ', which is node '//to_text(fem%mesh%node_id(rows%node(1, j)))//' of the contact,'
            return
         end do
      end associate
   end function pivot_text

   !> Supports that the body has, though they leave it this motion.
   pure function support_text(fem, b, held) result(text)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      logical, intent(in) :: held(:, :)        !< (2, n_nodes)
      character(len=:), allocatable :: text
      integer(ip) :: i, dof, n, first, first_dof

      n = 0
      first = 0
      first_dof = 0
      associate (nodes => fem%bodies%list(b)%nodes)
         do i = 1, size(nodes, kind=ip)
            do dof = 1, 2
               if (.not. held(dof, nodes(i))) cycle
               n = n + 1
               if (first > 0) cycle
               first = fem%mesh%node_id(nodes(i))
               first_dof = dof
            end do
         end do
      end associate
      if (n == 0) then
         text = 'it has no support'
      else
         text = 'its supports (node '//to_text(first)//' along x'//to_text(first_dof)
         if (n > 1) text = text//' and '//to_text(n - 1)//' more'
         text = text//') do not prevent that'
      end if
   end function support_text

end module atrito_free_motion
