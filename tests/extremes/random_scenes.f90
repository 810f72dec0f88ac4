!> Random scenes of one to six bodies: random_scenes K S prints the deck of scene K of seed S, a function of (K, S) alone.
!>
!> The distribution stands in scenes.head. Unlike random_decks, a scene need not have a solution: the push may be more than
!> friction can hold. What is right is for the judge (judge.py) to say.
program random_scenes
   use, intrinsic :: iso_fortran_env, only: output_unit, real64
   use bodies_deck, only: body_t, pair_t, write_bodies, side_length, area
   use random_numbers, only: start, uniform, log_uniform, whole, chance
   use scene_layouts, only: lay_stack, lay_row, lay_bond, lay_corner, lay_tilted, lay_wedge, lay_arch, direction, lay_punches, &
                            lay_loose
   use scene_parts, only: r, scene, e_range, size_of_load, mixed_orders, has_weak_bodies, hung, loose, base, stacked, &
                          draw_joint_laws, measure_pair
   implicit none (type, external)

   character(len=32) :: argument
   character(len=80) :: title
   integer :: k, seed

   if (command_argument_count() /= 2) error stop 'random_scenes K S'
   call get_command_argument(1, argument)
   read (argument, *) k
   call get_command_argument(2, argument)
   read (argument, *) seed
   call start(r, k, seed)
   call draw_scene()
   write (title, '(2(a,i0),2a)') 'Scene ', k, ' of seed ', seed, ': ', trim(scene%kind)
   call write_bodies(output_unit, scene, trim(title), r)

contains

   subroutine draw_scene()
      real(real64) :: kind, turn

      e_range = 0
      kind = uniform(r, 0.0_real64, 1.0_real64)
      if (kind > 0.35_real64) e_range = 2
      if (kind > 0.6_real64) e_range = 9
      mixed_orders = chance(r, 0.3_real64)
      has_weak_bodies = chance(r, 0.3_real64)
      hung = .false.
      stacked = .false.
      loose = .false.
      base = .false.
      turn = 0
      call lay_out(turn)
      call draw_joint_laws()
      call draw_loads()
      if (chance(r, 0.12_real64)) call draw_extra_support()
      call soften_held_pairs()
      kind = uniform(r, 0.0_real64, 1.0_real64)
      if (kind < 0.28_real64) then
         turn = turn + uniform(r, -3.1_real64, 3.1_real64)
      else if (kind < 0.4_real64) then
         turn = turn + 0.5_real64*acos(-1.0_real64)*whole(r, 1, 3)
      end if
      call transform(turn)
   end subroutine draw_scene

   subroutine lay_out(turn)
      real(real64), intent(inout) :: turn
      real(real64) :: kind

      kind = uniform(r, 0.0_real64, 1.0_real64)
      if (kind < 0.24_real64) then
         call lay_stack(whole(r, 1, 6))
      else if (kind < 0.36_real64) then
         call lay_row(whole(r, 2, 6))
      else if (kind < 0.52_real64) then
         call lay_bond()
      else if (kind < 0.64_real64) then
         call lay_corner()
      else if (kind < 0.72_real64) then
         call lay_tilted(turn)
      else if (kind < 0.80_real64) then
         call lay_wedge()
      else if (kind < 0.86_real64) then
         call lay_arch(whole(r, 3, 6))
      else if (kind < 0.93_real64) then
         call lay_punches(whole(r, 2, 5))
      else
         call lay_loose(whole(r, 3, 5))
      end if
   end subroutine lay_out

   ! -- loads and supports ------------------------------------------------------------------------------------------------------

   subroutine draw_loads()
      real(real64) :: weak, kind
      integer :: b
      logical :: weights, weight_as_density, pressures

      size_of_load = minval(scene%body(:scene%n)%e)
      size_of_load = size_of_load*log_uniform(r, -7.0_real64, -2.5_real64)
      weights = chance(r, 0.7_real64)
      pressures = chance(r, 0.7_real64)
      pressures = pressures .or. .not. weights
      weight_as_density = chance(r, 0.3_real64)
      do b = 1, scene%n
         weak = min(log_uniform(r, -9.0_real64, 6.0_real64), 1.0_real64)
         if (.not. has_weak_bodies) weak = 1
         kind = uniform(r, 0.0_real64, 1.0_real64)
         if (loose(b)) cycle
         associate (body => scene%body(b))
            if (weights) body%force(2) = -size_of_load*weak*uniform(r, 0.3_real64, 2.0_real64)
            if (kind < 0.01_real64) body%force(2) = -body%force(2)
            body%as_weight = weight_as_density .and. weights
            if (pressures .and. .not. any([body%touches(3), body%held(:, 3)])) &
               body%pressure(3) = size_of_load*weak*uniform(r, 0.2_real64, 2.0_real64)
         end associate
      end do
      if (hung) call hang_top()
      if (chance(r, 0.12_real64)) call squeeze()
      if (chance(r, 0.6_real64)) call draw_push()
   end subroutine draw_loads

   !> The top of the last body is held, or moved.
   subroutine hang_top()
      associate (body => scene%body(scene%n))
         body%pressure(3) = 0
         body%held(2, 3) = .true.
         body%held(1, 3) = chance(r, 0.6_real64)
         if (chance(r, 0.6_real64)) body%moved(2, 3) = -log_uniform(r, -6.0_real64, -2.5_real64)
         if (chance(r, 0.5_real64)) body%moved(1, 3) = log_uniform(r, -6.0_real64, -2.5_real64)
         if (chance(r, 0.5_real64)) body%moved(1, 3) = -body%moved(1, 3)
         if (.not. body%held(1, 3)) body%moved(1, 3) = 0
      end associate
   end subroutine hang_top

   !> Pressed from both sides with the same force; sometimes without any other load.
   subroutine squeeze()
      real(real64) :: p
      integer :: b

      b = whole(r, 1, scene%n)
      p = size_of_load*uniform(r, 0.2_real64, 3.0_real64)
      scene%kind = 'squeezed '//scene%kind(:7)
      if (chance(r, 0.4_real64)) call remove_loads()
      associate (body => scene%body(b))
         if (any([body%touches(2), body%touches(4), body%held(1, 2), body%held(1, 4)])) return
         body%pressure(2) = p
         body%pressure(4) = p
      end associate
   end subroutine squeeze

   subroutine remove_loads()
      integer :: b

      do b = 1, scene%n
         scene%body(b)%force = 0
         scene%body(b)%as_weight = .false.
         scene%body(b)%pressure = 0
      end do
   end subroutine remove_loads

   !> A push to the side, less, about or more than friction holds: as a pressure, a force per volume or at a corner.
   subroutine draw_push()
      real(real64) :: total, factor, height
      integer :: b, side
      real(real64) :: kind

      b = whole(r, 1, scene%n)
      if (loose(b)) return
      factor = draw_factor()
      total = factor*friction_at(b)*load_over(b)
      side = merge(4, 2, chance(r, 0.5_real64))
      kind = uniform(r, 0.0_real64, 1.0_real64)
      associate (body => scene%body(b))
         height = side_length(body, side)
         if (kind < 0.4_real64 .and. .not. any([body%touches(side), body%held(:, side)])) then
            body%pressure(side) = body%pressure(side) + total/(height*body%thickness)
         else if (kind < 0.75_real64) then
            body%force(1) = sign(total/(area(body)*body%thickness), real(side - 3, real64))
         else
            body%pushed_corner = merge(4, 3, side == 4)
            body%push = [sign(total, real(side - 3, real64)), -0.1_real64*total*whole(r, 0, 2)]
         end if
      end associate
   end subroutine draw_push

   real(real64) function draw_factor() result(factor)
      real(real64) :: kind

      kind = uniform(r, 0.0_real64, 1.0_real64)
      if (kind < 0.6_real64) then
         factor = uniform(r, 0.05_real64, 0.8_real64)
      else if (kind < 0.78_real64) then
         factor = log_uniform(r, -3.5_real64, -1.0_real64)
         if (chance(r, 0.4_real64)) factor = -factor
         factor = 1 + factor
      else if (kind < 0.86_real64) then
         factor = uniform(r, 1.1_real64, 3.0_real64)
      else
         factor = log_uniform(r, -9.0_real64, -1.0_real64)
      end if
   end function draw_factor

   !> The friction of the joint under a body, or of any of its joints.
   real(real64) function friction_at(b) result(nu)
      integer, intent(in) :: b
      integer :: i

      nu = 0
      do i = 1, scene%n_pairs
         associate (pair => scene%pair(i))
            if ((pair%slave == b .and. pair%slave_side == 1) .or. (pair%master == b .and. pair%master_side == 1)) nu = pair%nu
            if (.not. nu > 0 .and. (pair%slave == b .or. pair%master == b)) nu = pair%nu
         end associate
      end do
      if (.not. nu > 0) nu = 0.3_real64
   end function friction_at

   !> What presses down on the joint under a body.
   real(real64) function load_over(b) result(total)
      integer, intent(in) :: b
      integer :: i

      total = 0
      do i = merge(b, 1, stacked .or. scene%kind == 'punches'), merge(b, scene%n, scene%kind == 'punches')
         associate (body => scene%body(i))
            total = total + body%thickness*(body%pressure(3)*side_length(body, 3) - body%force(2)*area(body))
         end associate
      end do
      if (.not. total > 0) total = size_of_load
   end function load_over

   !> A roller on a side that nothing else holds, or a pinned corner.
   subroutine draw_extra_support()
      integer :: b, side

      b = whole(r, 1, scene%n)
      side = whole(r, 1, 4)
      if (loose(b)) return
      associate (body => scene%body(b))
         if (body%touches(side) .or. any(body%held)) return
         if (chance(r, 0.8_real64)) then
            body%held(whole(r, 1, 2), side) = .true.
         else if (.not. any(body%touches([side, mod(side + 2, 4) + 1]))) then
            body%pinned_corner = side
         end if
      end associate
   end subroutine draw_extra_support

   !> Hard contact where a held corner meets a held corner or a rigid line would be an overlap that no force can mend, if the last
   !> digits of the coordinates have it so: such pairs give way.
   subroutine soften_held_pairs()
      integer :: i
      real(real64) :: e, h

      do i = 1, scene%n_pairs
         associate (pair => scene%pair(i))
            if (pair%behaviour /= 'HARD' .and. pair%stiffness > 0) cycle
            if (.not. has_held_corner(scene%body(pair%slave), pair%slave_side)) cycle
            if (pair%master > 0) then
               if (.not. has_held_corner(scene%body(pair%master), pair%master_side)) cycle
            end if
            call measure_pair(pair, e, h)
            pair%behaviour = 'LINEAR'
            pair%stiffness = 1.0e6_real64*e
         end associate
      end do
   end subroutine soften_held_pairs

   pure logical function has_held_corner(body, side)
      type(body_t), intent(in) :: body
      integer, intent(in) :: side
      integer :: before, after

      before = mod(side + 2, 4) + 1
      after = mod(side, 4) + 1
      has_held_corner = any(body%held(:, [before, side, after])) .or. any(body%pinned_corner == [side, after])
   end function has_held_corner

   ! -- units and place ---------------------------------------------------------------------------------------------------------

   !> Turned, moved, and in other units of length and force.
   subroutine transform(turn)
      real(real64), intent(in) :: turn
      real(real64) :: length, modulus, away(2)
      integer :: b, i

      length = 1
      modulus = 1
      if (chance(r, 0.5_real64)) length = log_uniform(r, -6.0_real64, 6.0_real64)
      if (chance(r, 0.5_real64)) modulus = log_uniform(r, -9.0_real64, 9.0_real64)
      away = 0
      if (chance(r, 0.2_real64)) then
         away(1) = log_uniform(r, 0.0_real64, 2.0_real64)
         away = away(1)*direction(uniform(r, -3.1_real64, 3.1_real64))
      end if
      if (chance(r, 1.0_real64/3)) scene%digits = 10
      do b = 1, scene%n
         call transform_body(scene%body(b), turn, length, modulus, away)
      end do
      do i = 1, scene%n_pairs
         call transform_pair(scene%pair(i), turn, length, modulus, away)
      end do
   end subroutine transform

   subroutine transform_body(body, turn, length, modulus, away)
      type(body_t), intent(inout) :: body
      real(real64), intent(in) :: turn, length, modulus, away(2)
      integer :: i

      do i = 1, 4
         body%corner(:, i) = length*(turned(body%corner(:, i), turn) + away)
         ! a side with one prescribed dof keeps it: rollers along the axes
         if (all(body%held(:, i))) body%moved(:, i) = turned(body%moved(:, i), turn)
         body%moved(:, i) = length*body%moved(:, i)
      end do
      call turn_rollers(body, turn)
      body%thickness = body%thickness*length
      body%e = body%e*modulus
      body%force = turned(body%force, turn)*modulus/length
      body%pressure = body%pressure*modulus
      body%push = turned(body%push, turn)*modulus*length**2
   end subroutine transform_body

   !> Rollers take the axis that is nearer to theirs.
   subroutine turn_rollers(body, turn)
      type(body_t), intent(inout) :: body
      real(real64), intent(in) :: turn
      integer :: i

      if (abs(cos(turn)) > abs(sin(turn))) then
         if (cos(turn) < 0) body%moved = merge(body%moved, -body%moved, spread(all(body%held, dim=1), 1, 2))
         return
      end if
      do i = 1, 4
         if (all(body%held(:, i))) cycle
         body%held(:, i) = body%held([2, 1], i)
         body%moved(:, i) = body%moved([2, 1], i)*[-sign(1.0_real64, sin(turn)), sign(1.0_real64, sin(turn))]
      end do
   end subroutine turn_rollers

   subroutine transform_pair(pair, turn, length, modulus, away)
      type(pair_t), intent(inout) :: pair
      real(real64), intent(in) :: turn, length, modulus, away(2)
      integer :: i

      do i = 1, 2
         pair%line(:, i) = length*(turned(pair%line(:, i), turn) + away)
      end do
      if (pair%behaviour == 'LINEAR') pair%stiffness = pair%stiffness*modulus/length
      if (pair%behaviour == 'PENALTY') pair%stiffness = pair%stiffness*length/modulus
      pair%slope = pair%slope*modulus/length
      pair%eps = pair%eps*length
      pair%rho = pair%rho*length
   end subroutine transform_pair

   !> Quarter turns are exact.
   pure function turned(v, angle) result(w)
      real(real64), intent(in) :: v(2), angle
      real(real64) :: w(2), c, s

      c = cos(angle)
      s = sin(angle)
      if (abs(c) < 1.0e-14_real64) c = 0
      if (abs(s) < 1.0e-14_real64) s = 0
      w = [c*v(1) - s*v(2), s*v(1) + c*v(2)]
   end function turned

end program random_scenes
