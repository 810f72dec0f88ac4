!> A scene of two bodies in contact, solved in quadruple precision apart from atrito.
!>
!>    quad_reference SCENE [contact.tab]
!>
!> SCENE is a list of name = value, or a deck that scene_deck wrote (tests/extremes/scene_file.f90). With a table, Newton's method
!> starts from it: the exact solution next to what another program found. Prints a row a point: s, x, y, pressure, shear, gap, slip
!> and whether the point is open (0), sticks (1) or slips (2), then what the contact law says of them. Exit code 3: no solution.
program quad_reference
   use, intrinsic :: iso_fortran_env, only: real64, real128
   use quad_body, only: body_t, make_body, set_material, finish_body, add_pressure, add_body_force, prescribe, &
                        SIDE_BOTTOM, SIDE_RIGHT, SIDE_TOP, SIDE_LEFT
   use quad_contact, only: contact_t, build_contact, place_of, bound_of
   use quad_solve, only: state_t, solve_contact, refine, law_error, new_state
   use scene_file, only: scene_t, read_scene, get, count_of, lower_corners, upper_corners
   implicit none (type, external)
   integer, parameter :: qp = real128
   type(scene_t) :: scene
   type(body_t) :: upper, lower
   type(contact_t) :: contact
   type(state_t) :: state
   character(len=1000) :: path
   character(len=:), allocatable :: how
   integer :: unit
   logical :: found

   call get_command_argument(1, path)
   open (newunit=unit, file=trim(path), action='read', status='old')
   call read_scene(unit, scene)
   close (unit)
   call make_lower()
   call make_upper()
   call build_contact(upper, lower, get(scene, 'nu'), get(scene, 'eps'), get(scene, 'rho'), get(scene, 'delta'), contact)
   if (command_argument_count() > 1) then
      call get_command_argument(2, path)
      call start_from_table(trim(path))
      call refine(contact, contact%nu, state, found)
      how = 'Newton from '//trim(path)
      if (.not. found) how = ''
   else
      call solve_contact(contact, state, how)
   end if
   call print_solution()
   if (how == '') stop 3, quiet = .true.

contains

   subroutine begin_body(prefix, corners, contact_side, body)
      character(len=*), intent(in) :: prefix
      real(real64), intent(in) :: corners(2, 4)
      integer, intent(in) :: contact_side
      type(body_t), intent(out) :: body

      call make_body(corners, count_of(scene, prefix//'_order'), count_of(scene, prefix//'_nx'), count_of(scene, prefix//'_ny'), &
                     contact_side, body)
      call set_material(get(scene, prefix//'_e'), get(scene, prefix//'_mu'), get(scene, prefix//'_thick'), &
                        get(scene, 'plane_stress') > 0, body)
   end subroutine begin_body

   subroutine make_lower()
      call begin_body('lower', lower_corners(scene), SIDE_TOP, lower)
      call hold(lower, 'base_x', SIDE_BOTTOM, 1, 0.0_real64)
      call hold(lower, 'base_y', SIDE_BOTTOM, 2, 0.0_real64)
      call hold(lower, 'lower_left_x', SIDE_LEFT, 1, 0.0_real64)
      call hold(lower, 'lower_right_x', SIDE_RIGHT, 1, 0.0_real64)
      call hold(lower, 'lower_hold_x', 0, 1, 0.0_real64)
      call add_body_force(lower, [0.0_real64, get(scene, 'lower_by')])
      call finish_body(lower)
   end subroutine make_lower

   subroutine make_upper()
      call begin_body('upper', upper_corners(scene), SIDE_BOTTOM, upper)
      call hold(upper, 'upper_left_x', SIDE_LEFT, 1, 0.0_real64)
      call hold(upper, 'upper_right_x', SIDE_RIGHT, 1, 0.0_real64)
      call hold(upper, 'upper_hold_y', 0, 2, 0.0_real64)
      call hold(upper, 'top_x', SIDE_TOP, 1, get(scene, 'top_u1'))
      call hold(upper, 'top_y', SIDE_TOP, 2, get(scene, 'top_u2'))
      call add_pressure(upper, SIDE_TOP, get(scene, 'top_pressure'))
      call add_pressure(upper, SIDE_LEFT, get(scene, 'left_pressure'))
      call add_pressure(upper, SIDE_RIGHT, get(scene, 'right_pressure'))
      call add_body_force(upper, [get(scene, 'upper_bx'), get(scene, 'upper_by')])
      call finish_body(upper)
   end subroutine make_upper

   subroutine hold(body, flag, side, axis, value)
      type(body_t), intent(inout) :: body
      character(len=*), intent(in) :: flag
      integer, intent(in) :: side, axis
      real(real64), intent(in) :: value

      if (get(scene, flag) > 0) call prescribe(body, side, axis, value)
   end subroutine hold

   !> Forces and states from a contact.tab; columns as in docs/user/tables.md.
   subroutine start_from_table(path)
      character(len=*), intent(in) :: path
      character(len=1000) :: line
      real(real64) :: s, x, y, gap, pressure, weighted, shear, slip
      real(qp) :: tau(contact%n)
      integer :: unit, status, j, ids(3), n

      call new_state(contact, state)
      n = contact%n
      open (newunit=unit, file=path, action='read', status='old')
      j = 0
      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) exit
         if (line(1:1) == '#') cycle
         j = j + 1
         read (line, *) ids, s, x, y, gap, pressure, weighted, shear, slip
         state%q(j) = pressure*contact%weight(j)
         state%q(n + j) = -shear*contact%weight(j)
         state%normal(j) = merge(1, 0, pressure > 0)
      end do
      close (unit)
      if (j /= n) error stop 'the table has another number of points'
      tau = bound_of(contact, state%q, contact%nu)
      do j = 1, n
         state%tangential(j) = 0
         if (abs(state%q(n + j)) >= (1 - 1.0e-9_qp)*tau(j)*contact%weight(j)) &
            state%tangential(j) = merge(1, -1, state%q(n + j) > 0)
         if (.not. tau(j) > 0) state%tangential(j) = 2
      end do
   end subroutine start_from_table

   subroutine print_solution()
      real(qp) :: place(2*contact%n), p, tau(contact%n), t
      integer :: j, n, status

      n = contact%n
      print '(2a)', '# columns: s x y pressure shear gap slip status'
      if (how /= '') then
         place = place_of(contact, state%q, state%a)
         tau = bound_of(contact, state%q, contact%nu)
         do j = 1, n
            p = state%q(j)/contact%weight(j)
            t = state%q(n + j)/contact%weight(j)
            status = 0
            if (p > 0) status = merge(1, 2, abs(t) < tau(j)*(1 - 1.0e-20_qp) .or. contact%known(n + j))
            print '(7es44.32e4,i3)', contact%s(j), contact%x(:, j), p, -t, -place(j), place(n + j), status
         end do
         print '(a,es10.2e4)', '# worst breach of the contact law: ', law_error(contact, contact%nu, state)
         print '(2a)', '# found by: ', how
      else
         print '(a)', '# no solution found'
      end if
   end subroutine print_solution

end program quad_reference
