!> A small model and its results, made by hand: two elements side by side on a rigid line, three points.
module output_cases
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: PLANE_STRAIN
   use atrito_strings, only: string_t
   use atrito_mesh, only: add_node, add_element, trim_mesh
   use atrito_model, only: model_t, SURFACE_SEGMENTS, LOAD_PRESSURE, FRICTION_NONLOCAL
   use atrito_results, only: results_t, history_t, contact_result_t
   implicit none (type, external)
   private
   public :: make_model, make_results, make_contact, make_joints, one_frame

contains

   subroutine make_model(model)
      type(model_t), intent(out) :: model
      logical :: known
      integer(ip) :: i

      model%deck_path = 'some/folder/case.inp'
      model%deck_name = 'case'
      model%heading = [string_t('two elements on a line')]
      do i = 1, 6
         call add_node(model%mesh, 10_ip*i, [real(mod(i - 1, 3), wp), real((i - 1)/3, wp)], known)
      end do
      call add_element(model%mesh, 7_ip, PLANE_STRAIN, [1_ip, 2_ip, 5_ip, 4_ip], known)
      call add_element(model%mesh, 8_ip, PLANE_STRAIN, [2_ip, 3_ip, 6_ip, 5_ip], known)
      call trim_mesh(model%mesh)
      allocate (model%steps(1), model%parameters(0), model%materials(1), model%sections(1), model%surfaces(2), &
                model%interactions(1), model%pairs(1))
      model%materials(1)%name = 'C'
      model%materials(1)%young = 1000.0_wp
      model%sections(1)%elset = 'ALL'
      model%sections(1)%material = 1
      model%sections(1)%thickness = 2.0_wp
      model%section_of = [1_ip, 1_ip]
      model%surfaces(1)%name = 'UNDER'
      model%surfaces(2)%name = 'FLOOR'
      model%surfaces(2)%kind = SURFACE_SEGMENTS
      allocate (model%surfaces(2)%is_arc(0))
      model%interactions(1)%name = 'DRY'
      model%interactions(1)%friction = FRICTION_NONLOCAL
      model%pairs(1)%interaction = 1
      model%pairs(1)%slave = 1
      model%pairs(1)%master = 2
      model%steps(1)%prescribed%n = 0
      model%steps(1)%element_loads%n = 1
      model%steps(1)%element_loads%element = [2_ip]
      model%steps(1)%element_loads%kind = [LOAD_PRESSURE]
      model%steps(1)%element_loads%face = [3_ip]
      model%steps(1)%element_loads%value = reshape([0.5_wp, 0.0_wp, 0.0_wp], [3, 1])
      model%steps(1)%requests%nodes = .true.
      model%steps(1)%requests%reactions = .true.
   end subroutine make_model

   !> Pressures 0, 1/2, 3 with the weights 1/2, 1, 1/2: N = 2, its place s = (1/2 + 3)/2 = 1.75 of 2.
   function make_contact() result(contact)
      type(contact_result_t) :: contact

      contact%n = 3
      contact%s = [0.0_wp, 1.0_wp, 2.0_wp]
      contact%x = reshape([0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 2.0_wp, 0.0_wp], [2, 3])
      contact%normal = reshape([0.0_wp, -1.0_wp, 0.6_wp, -0.8_wp, 0.0_wp, -1.0_wp], [2, 3])
      contact%u = reshape([-0.5_wp, 0.0_wp, 0.0_wp, 0.25_wp, 0.0_wp, 0.0_wp], [2, 3])
      contact%gap = [1.0e-2_wp, 0.0_wp, -1.0e-6_wp]
      contact%pressure = [0.0_wp, 0.5_wp, 3.0_wp]
      contact%weighted_pressure = [0.0_wp, 0.5_wp, 3.0_wp]
      contact%shear = [0.0_wp, 0.125_wp, -0.75_wp]
      contact%slip = [1.0e-3_wp, 1.0e-5_wp, -1.0e-2_wp]
      contact%status = [0_ip, 1_ip, 2_ip]
      contact%weight = [0.5_wp, 1.0_wp, 0.5_wp]
      contact%follows = [.false., .true., .true.]
      contact%s_end = 2.0_wp
      contact%has_friction = .true.
   end function make_contact

   subroutine make_results(results)
      type(results_t), intent(out) :: results

      results%converged = .true.
      results%law_holds = .true.
      allocate (results%contact(1), results%scene%bodies(1), results%scene%pairs(1))
      results%contact(1) = make_contact()
      results%scene%bodies(1)%name = 'ALL'
      results%scene%bodies(1)%solver = 'skyline'
      results%scene%pairs(1)%slave = 'UNDER'
      results%scene%pairs(1)%master = 'FLOOR'
      results%scene%pairs(1)%n_points = 3
      allocate (results%u(2, 6), results%reaction(2, 6), source=0.0_wp)
      allocate (results%prescribed(2, 6), source=.false.)
      results%u(2, :) = 1.0e-2_wp
      results%u(1, 2) = 1.0e-17_wp
      results%prescribed(1, 3) = .true.
      results%reaction(1, 3) = 0.25_wp
      results%outer_iterations = 2
      results%linear_solves = 3
      results%equilibrium_residual = 1.0e-15_wp
      results%strain_energy = 0.5_wp
      results%external_work = 1.0_wp
      results%error_estimate = 12.5_wp
      allocate (results%iterations(2))
      results%iterations%outer = [1_ip, 2_ip]
   end subroutine make_results

   !> A run of one increment.
   pure type(history_t) function one_frame(results) result(history)
      type(results_t), intent(in) :: results

      history%frames = [results]
      allocate (history%rows(0))
      history%iterations = results%iterations
      history%iterations%step = results%step
      history%iterations%increment = results%increment
   end function one_frame

   !> Two bodies, the second with what is rounding beside the first and what is not; three joints of the one pair, the last open.
   subroutine make_joints(results)
      type(results_t), intent(inout) :: results     !< of make_results

      allocate (results%bodies(2), results%joints(3))
      associate (a => results%bodies(1), b => results%bodies(2))
         a%name = 'A'//achar(9)//'B#1'
         a%size = 2.0_wp
         a%u = [1.0e-3_wp, -2.0e-3_wp]
         a%rotation = 5.0e-4_wp
         a%loads = [1.0_wp, -2.0_wp, 3.0_wp]
         a%supports = [4.0_wp, 5.0_wp, 6.0_wp]
         a%contact = [7.0_wp, 8.0_wp, 9.0_wp]
         b%name = 'B'
         b%size = 2.0_wp
         b%u = [0.9e-16_wp, 2.0e-16_wp]
         b%rotation = 0.4e-16_wp
         b%loads = [0.7e-13_wp, 0.0_wp, 1.5e-13_wp]
         b%contact = [1.0e-13_wp, 0.0_wp, 2.0e-13_wp]
      end associate
      results%joints%pair = 1
      results%joints%bodies(1) = 1
      results%joints%length = 3.0_wp
      results%joints%n = [2.0_wp, 1.0_wp, 0.0_wp]
      results%joints%t = [-0.5_wp, 0.9e-14_wp, 0.0_wp]
      results%joints%m = [0.25_wp, 2.0e-14_wp, 0.0_wp]
      results%joints%force = [2.0_wp, 1.0_wp, 0.0_wp]
      results%joints(1)%place = [1.125_wp, 0.5_wp]
      results%joints(2)%place = [1.5_wp, 0.5_wp]
      results%joints(3)%place = ieee_value(1.0_wp, ieee_quiet_nan)
      results%joints%opening = [1.0e-2_wp, 0.0_wp, 0.0_wp]
      results%joints%sliding = [-4.0e-3_wp, 0.0_wp, 0.0_wp]
      results%contact(1)%joint = [1_ip, 1_ip, 1_ip]
      results%contact(1)%follows = [.false., .true., .true.]
   end subroutine make_joints

end module output_cases
