!> Random scenes of one to six bodies: random_scenes K S prints the deck of scene K of seed S, a function of (K, S) alone.
!>
!> The distribution stands in scenes.head. Unlike random_decks, a scene need not have a solution: the push may be more than
!> friction can hold. What is right is for the judge (judge.py) to say.
program random_scenes
   use, intrinsic :: iso_fortran_env, only: output_unit, real64
   use bodies_deck, only: body_t, pair_t, bodies_t, write_bodies, side_length, side_count, area, MOST_BODIES
   use random_numbers, only: random_t, start, uniform, log_uniform, whole, chance
   implicit none (type, external)

   type(random_t) :: r
   type(bodies_t) :: scene
   character(len=32) :: argument
   character(len=80) :: title
   real(real64) :: e_range, size_of_load
   logical :: mixed_orders, has_weak_bodies, hung
   logical :: loose(MOST_BODIES), base(MOST_BODIES), stacked
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

   ! -- bodies ------------------------------------------------------------------------------------------------------------------

   !> A body with vertical sides: x from x0 to x1, bottom and top from y(1) to y(2) and y(3) to y(4).
   integer function add_body(x0, x1, y) result(b)
      real(real64), intent(in) :: x0, x1, y(4)

      b = add_quad(reshape([x0, y(1), x1, y(2), x1, y(4), x0, y(3)], [2, 4]))
   end function add_body

   integer function add_quad(corner) result(b)
      real(real64), intent(in) :: corner(2, 4)

      scene%n = scene%n + 1
      b = scene%n
      associate (body => scene%body(b))
         body%corner = corner
         body%order = 1
         body%order = whole(r, 1, 2)
         if (b > 1 .and. .not. mixed_orders) body%order = scene%body(1)%order
         body%stress = chance(r, 0.5_real64)
         body%as_block = chance(r, 0.35_real64)
         if (chance(r, 0.4_real64)) body%shake = uniform(r, 0.0_real64, 0.25_real64)
         body%e = log_uniform(r, -e_range, e_range)
         body%mu = max(uniform(r, -0.5_real64, 0.49_real64), -0.3_real64)
         if (chance(r, 0.2_real64)) body%mu = 0
         body%thickness = 1
         if (chance(r, 0.2_real64)) body%thickness = log_uniform(r, -1.0_real64, 1.0_real64)
         body%nx = elements_along(body, 1, 8)
         body%ny = elements_along(body, 2, 4)
         call draw_breaks(body%nx, body%bx)
         call draw_breaks(body%ny, body%by)
      end associate
   end function add_quad

   integer function elements_along(body, side, most)
      type(body_t), intent(in) :: body
      integer, intent(in) :: side, most

      elements_along = nint(side_length(body, side)*uniform(r, 1.5_real64, 5.0_real64)/body%order)
      elements_along = min(max(elements_along, 1), most)
   end function elements_along

   subroutine refine_along(body)
      type(body_t), intent(inout) :: body

      body%nx = max(body%nx, 4)
      call draw_breaks(body%nx, body%bx)
   end subroutine refine_along

   subroutine draw_breaks(n, breaks)
      integer, intent(in) :: n
      real(real64), intent(inout) :: breaks(0:)
      integer :: i
      logical :: even

      even = chance(r, 0.6_real64)
      breaks = 0
      do i = 1, n
         breaks(i) = breaks(i - 1) + merge(1.0_real64, uniform(r, 0.6_real64, 1.7_real64), even)
      end do
      breaks(1:n) = breaks(1:n)/breaks(n)
      breaks(n) = 1
   end subroutine draw_breaks

   !> Body b takes order, number and places of the elements of another body along its sides 1 and 3, or 2 and 4.
   subroutine take_mesh(b, other, sides_1_and_3)
      integer, intent(in) :: b, other
      logical, intent(in) :: sides_1_and_3

      associate (body => scene%body(b), like => scene%body(other))
         body%order = like%order
         if (sides_1_and_3) then
            body%nx = like%nx
            body%bx = like%bx
         else
            body%ny = like%ny
            body%by = like%by
         end if
      end associate
   end subroutine take_mesh

   ! -- pairs -------------------------------------------------------------------------------------------------------------------

   !> Whole sides that face each other.
   subroutine join(slave, slave_side, master, master_side, matching)
      integer, intent(in) :: slave, slave_side, master, master_side
      logical, intent(in) :: matching

      call join_faces(slave, slave_side, [1, side_count(scene%body(slave), slave_side)], master, master_side, &
                      [1, side_count(scene%body(master), master_side)], matching)
   end subroutine join

   subroutine join_faces(slave, slave_side, slave_faces, master, master_side, master_faces, matching)
      integer, intent(in) :: slave, slave_side, slave_faces(2), master, master_side, master_faces(2)
      logical, intent(in) :: matching

      scene%n_pairs = scene%n_pairs + 1
      associate (pair => scene%pair(scene%n_pairs))
         pair%slave = slave
         pair%slave_side = slave_side
         pair%slave_first = slave_faces(1)
         pair%slave_last = slave_faces(2)
         pair%master = master
         pair%master_side = master_side
         pair%master_first = master_faces(1)
         pair%master_last = master_faces(2)
         pair%matching = matching
      end associate
      scene%body(slave)%touches(slave_side) = .true.
      scene%body(master)%touches(master_side) = .true.
   end subroutine join_faces

   !> A rigid line before a side, at a distance at its beginning and at its end. Longer than the side by half of it.
   subroutine join_rigid(slave, side, distance)
      integer, intent(in) :: slave, side
      real(real64), intent(in) :: distance(2)
      real(real64) :: from(2), to(2), along(2), normal(2)

      associate (body => scene%body(slave))
         from = body%corner(:, side)
         to = body%corner(:, mod(side, 4) + 1)
         along = (to - from)/norm2(to - from)
         normal = [along(2), -along(1)]
         from = from + distance(1)*normal
         to = to + distance(2)*normal
         along = to - from
         body%touches(side) = .true.
      end associate
      scene%n_pairs = scene%n_pairs + 1
      associate (pair => scene%pair(scene%n_pairs))
         pair%slave = slave
         pair%slave_side = side
         pair%slave_last = side_count(scene%body(slave), side)
         ! the line is drawn along the side: its normal, travel turned by +90 degrees, looks at the body
         pair%line = reshape([from - 0.5_real64*along, to + 0.5_real64*along], [2, 2])
      end associate
   end subroutine join_rigid

   !> What holds the bottom of a body: a rigid floor in contact, or supports.
   subroutine put_down(b, share_of_floors)
      integer, intent(in) :: b
      real(real64), intent(in) :: share_of_floors

      base(b) = .true.
      if (chance(r, share_of_floors)) then
         call join_rigid(b, 1, draw_gap(.false.))
      else
         scene%body(b)%held(2, 1) = .true.
         scene%body(b)%held(1, 1) = chance(r, 0.7_real64)
         if (.not. scene%body(b)%held(1, 1)) scene%body(b)%pinned_corner = merge(1, 0, chance(r, 0.7_real64))
      end if
   end subroutine put_down

   !> Distances at the two ends of a joint: mostly none, else a constant one or a wedge; with overlaps only where asked for.
   function draw_gap(may_overlap) result(gap)
      logical, intent(in) :: may_overlap
      real(real64) :: gap(2), kind

      kind = uniform(r, 0.0_real64, 1.0_real64)
      gap = 0
      if (kind > 0.65_real64) gap = log_uniform(r, -9.0_real64, -3.0_real64)
      ! the ends of a wider wedge would not lie before each other
      if (kind > 0.8_real64) gap = log_uniform(r, -9.0_real64, -4.0_real64)
      if (kind > 0.8_real64) gap(2) = log_uniform(r, -9.0_real64, -4.0_real64)
      if (kind > 0.93_real64 .and. may_overlap) gap = -log_uniform(r, -9.0_real64, -4.0_real64)
   end function draw_gap

   !> Laws that mostly are those of the first pair, or each its own.
   subroutine draw_joint_laws()
      logical :: alike
      integer :: i

      alike = chance(r, 0.4_real64)
      do i = 1, scene%n_pairs
         if (alike .and. i > 1) then
            call copy_law(scene%pair(1), scene%pair(i))
         else
            call draw_behaviour(scene%pair(i))
            call draw_friction(scene%pair(i))
         end if
      end do
   end subroutine draw_joint_laws

   subroutine copy_law(from, to)
      type(pair_t), intent(in) :: from
      type(pair_t), intent(inout) :: to

      to%behaviour = from%behaviour
      to%stiffness = from%stiffness
      to%friction = from%friction
      to%nu = from%nu
      to%slope = from%slope
      to%eps = from%eps
      to%rho = from%rho
      to%line_kernel = from%line_kernel
   end subroutine copy_law

   !> E of the softer side and the length of a slave face.
   subroutine measure_pair(pair, e, h)
      type(pair_t), intent(in) :: pair
      real(real64), intent(out) :: e, h

      e = scene%body(pair%slave)%e
      if (pair%master > 0) e = min(e, scene%body(pair%master)%e)
      h = side_length(scene%body(pair%slave), pair%slave_side)/side_count(scene%body(pair%slave), pair%slave_side)
   end subroutine measure_pair

   subroutine draw_behaviour(pair)
      type(pair_t), intent(inout) :: pair
      real(real64) :: kind, e, h

      call measure_pair(pair, e, h)
      kind = uniform(r, 0.0_real64, 1.0_real64)
      if (kind < 0.45_real64) return
      if (kind < 0.7_real64) then
         pair%behaviour = 'LINEAR'
         pair%stiffness = e*log_uniform(r, -1.0_real64, 8.0_real64)
      else
         pair%behaviour = 'PENALTY'
         pair%stiffness = log_uniform(r, -12.0_real64, 1.0_real64)/e
         if (chance(r, 0.1_real64)) pair%stiffness = 0
      end if
   end subroutine draw_behaviour

   subroutine draw_friction(pair)
      type(pair_t), intent(inout) :: pair
      real(real64) :: kind, e, h

      call measure_pair(pair, e, h)
      kind = uniform(r, 0.0_real64, 1.0_real64)
      if (kind < 0.08_real64) return
      pair%nu = uniform(r, 0.1_real64, 1.0_real64)
      if (chance(r, 0.35_real64)) pair%nu = log_uniform(r, -3.0_real64, log10(5.0_real64))
      if (chance(r, 0.05_real64)) pair%nu = 0
      if (kind < 0.3_real64) then
         pair%friction = 'LOCAL'
      else if (kind < 0.5_real64) then
         pair%friction = 'LOCAL'
         pair%slope = e*log_uniform(r, -2.0_real64, 8.0_real64)
      else
         pair%friction = 'NONLOCAL'
         if (.not. chance(r, 0.35_real64)) pair%eps = log_uniform(r, -12.0_real64, -3.0_real64)
         pair%line_kernel = chance(r, 0.4_real64)
         kind = uniform(r, 0.0_real64, 1.0_real64)
         if (kind > 0.3_real64) pair%rho = h*uniform(r, 0.1_real64, 0.4_real64)
         if (kind > 0.45_real64) pair%rho = h*uniform(r, 1.1_real64, 5.0_real64)
      end if
   end subroutine draw_friction

   ! -- layouts -----------------------------------------------------------------------------------------------------------------

   !> Bodies on each other; joints may slope, bodies may be narrower or stand over the edge.
   subroutine lay_stack(n)
      integer, intent(in) :: n
      real(real64) :: from, to, w
      real(real64) :: slope, y, height, gap(2)
      integer :: i, b, before

      scene%kind = 'stack'
      stacked = .true.
      w = uniform(r, 0.6_real64, 2.5_real64)
      from = 0
      to = w
      y = 0
      slope = 0
      before = 0
      do i = 1, n
         gap = 0
         if (i > 1) then
            gap = draw_gap(.true.)
            call draw_interval(from, to)
            ! sides that end together lie before each other only where the gap is small
            if (abs(slope) > 0) gap = sign(min(abs(gap), 1.0e-7_real64), gap)
         end if
         height = uniform(r, 0.25_real64, 1.1_real64)
         b = put_layer(from, to, y, slope, height, gap)
         if (before > 0) call join_layers(before, b)
         if (i == 1) call put_down(b, merge(0.5_real64, 1.0_real64, n > 1))
         before = b
      end do
      hung = chance(r, 0.2_real64)
   end subroutine lay_stack

   !> The next body's place along the last one: mostly the same, else within it, or over the edge.
   subroutine draw_interval(from, to)
      real(real64), intent(inout) :: from, to
      real(real64) :: kind, length

      kind = uniform(r, 0.0_real64, 1.0_real64)
      length = to - from
      if (kind < 0.55_real64) return
      if (kind < 0.85_real64) then
         from = from + length*uniform(r, 0.0_real64, 0.3_real64)
         to = to - length*uniform(r, 0.0_real64, 0.3_real64)
      else
         from = from + length*uniform(r, 0.1_real64, 0.3_real64)
         to = to + length*uniform(r, 0.0_real64, 0.2_real64)
      end if
   end subroutine draw_interval

   !> A body over the line y + slope x; y and slope become those of its top.
   integer function put_layer(from, to, y, slope, height, gap) result(b)
      real(real64), intent(in) :: from, to, height, gap(2)
      real(real64), intent(inout) :: y, slope
      real(real64) :: top_slope, top

      top_slope = 0
      if (chance(r, 0.15_real64)) top_slope = uniform(r, -0.2_real64, 0.2_real64)
      top = y + height + max(slope*from, slope*to) - min(top_slope*from, top_slope*to)
      b = add_body(from, to, [y + slope*from + gap(1), y + slope*to + gap(2), top + top_slope*from, top + top_slope*to])
      y = top
      slope = top_slope
   end function put_layer

   subroutine join_layers(lower, upper)
      integer, intent(in) :: lower, upper
      logical :: same, above, matching

      ! a slave over the edge loses the faces that hang over
      if (scene%body(upper)%corner(1, 2) > scene%body(lower)%corner(1, 2)) call refine_along(scene%body(upper))
      same = all(abs(scene%body(lower)%corner(1, :) - scene%body(upper)%corner(1, :)) < 1.0e-12_real64)
      matching = chance(r, 0.6_real64)
      matching = matching .and. same
      if (matching) call take_mesh(upper, lower, .true.)
      above = chance(r, 0.6_real64)
      above = above .or. .not. same
      if (above) then
         call join(upper, 1, lower, 3, matching)
      else
         call join(lower, 3, upper, 1, matching)
      end if
   end subroutine join_layers

   !> Blocks side by side with head joints, on a floor or between two ends alone.
   subroutine lay_row(n)
      integer, intent(in) :: n
      real(real64) :: x, width, height, gap(2)
      logical :: floor, matching
      integer :: i, b

      scene%kind = 'row'
      floor = chance(r, 0.65_real64)
      x = 0
      height = uniform(r, 0.4_real64, 1.2_real64)
      do i = 1, n
         width = uniform(r, 0.3_real64, 1.2_real64)
         gap = 0
         if (i > 1) gap = abs(draw_gap(.false.))
         if (chance(r, 0.2_real64)) height = uniform(r, 0.4_real64, 1.2_real64)
         b = add_quad(reshape([x + gap(1), 0.0_real64, x + width, 0.0_real64, x + width, height, x + gap(2), height], [2, 4]))
         x = x + width
         if (i > 1) then
            matching = chance(r, 0.6_real64)
            matching = matching .and. abs(scene%body(b)%corner(2, 4) - scene%body(b - 1)%corner(2, 3)) < 1.0e-12_real64
            if (matching) call take_mesh(b, b - 1, .false.)
            if (scene%body(b)%corner(2, 4) > scene%body(b - 1)%corner(2, 3)) then
               call join(b - 1, 2, b, 4, matching)
            else
               call join(b, 4, b - 1, 2, matching)
            end if
         end if
         if (floor) call put_down(b, 0.85_real64)
      end do
      call close_end(1, 4)
      call close_end(n, 2)
   end subroutine lay_row

   !> The end of a row: a rigid wall, held, or free.
   subroutine close_end(b, side)
      integer, intent(in) :: b, side
      real(real64) :: kind

      kind = uniform(r, 0.0_real64, 1.0_real64)
      if (kind < 0.4_real64) then
         call join_rigid(b, side, draw_gap(.false.))
      else if (kind < 0.65_real64) then
         scene%body(b)%held(1, side) = .true.
         scene%body(b)%held(2, side) = chance(r, 0.6_real64)
      end if
   end subroutine close_end

   !> Courses of blocks with head joints, three to six of them: T-joints.
   subroutine lay_bond()
      integer, parameter :: N_PATTERNS = 8
      ! course, from, to of each block, in half lengths of a block
      integer, parameter :: PATTERN(3, 6, N_PATTERNS) = reshape([ &
                                                                1, 0, 2, 2, 0, 1, 2, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, &
                                                                1, 0, 1, 1, 1, 2, 2, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, &
                                                                1, 0, 2, 1, 2, 4, 2, 1, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, &
                                                                1, 0, 2, 1, 2, 4, 2, 0, 1, 2, 1, 3, 2, 3, 4, 0, 0, 0, &
                                                                1, 0, 2, 1, 2, 4, 1, 4, 6, 2, 1, 3, 2, 3, 5, 3, 2, 4, &
                                                                1, 0, 2, 2, 0, 1, 2, 1, 2, 3, 0, 2, 0, 0, 0, 0, 0, 0, &
                                                                1, 0, 1, 1, 1, 2, 2, 0, 2, 3, 0, 1, 3, 1, 2, 0, 0, 0, &
                                                          1, 0, 1, 1, 1, 2, 1, 2, 3, 2, 0, 3, 0, 0, 0, 0, 0, 0], [3, 6, N_PATTERNS])
      integer :: p, i, j, units(MOST_BODIES), m
      real(real64) :: unit, height, floors
      logical :: alike, heads

      scene%kind = 'bond'
      p = whole(r, 1, N_PATTERNS)
      unit = uniform(r, 0.4_real64, 1.2_real64)
      height = uniform(r, 0.4_real64, 1.2_real64)
      alike = chance(r, 0.7_real64)
      heads = chance(r, 0.85_real64)
      floors = merge(1.0_real64, 0.0_real64, chance(r, 0.5_real64))
      m = whole(r, 1, 3)
      do i = 1, count(PATTERN(1, :, p) > 0)
         associate (at => PATTERN(:, i, p))
            j = add_body(at(2)*unit, at(3)*unit, [at(1) - 1, at(1) - 1, at(1), at(1)]*height)
            units(i) = m
            if (.not. alike) units(i) = whole(r, 1, 3)
            call make_regular(scene%body(i), units(i)*(at(3) - at(2)), alike)
            if (at(1) == 1) call put_down(i, floors)
            do j = 1, i - 1
               if (PATTERN(1, j, p) == at(1) .and. PATTERN(3, j, p) == at(2) .and. heads) call join_heads(j, i, alike)
               if (PATTERN(1, j, p) == at(1) - 1) call join_courses(PATTERN(:, j, p), units(j), j, at, units(i), i, alike)
            end do
         end associate
      end do
   end subroutine lay_bond

   !> Equal elements along the courses; of one order and number along the head joints where the deck is of one mesh.
   subroutine make_regular(body, n, alike)
      type(body_t), intent(inout) :: body
      integer, intent(in) :: n
      logical, intent(in) :: alike
      integer :: i

      body%nx = n
      body%bx(0:n) = [(real(i, real64)/n, i=0, n)]
      if (.not. alike) return
      body%order = scene%body(1)%order
      body%ny = scene%body(1)%ny
      body%by = scene%body(1)%by
   end subroutine make_regular

   subroutine join_heads(left, right, matching)
      integer, intent(in) :: left, right
      logical, intent(in) :: matching

      if (chance(r, 0.5_real64)) then
         call join(left, 2, right, 4, matching)
      else
         call join(right, 4, left, 2, matching)
      end if
   end subroutine join_heads

   !> The bed joint of two blocks, over the length that they share.
   subroutine join_courses(below, below_units, lower, above, above_units, upper, matching)
      integer, intent(in) :: below(3), below_units, lower, above(3), above_units, upper
      logical, intent(in) :: matching
      integer :: from, to, lower_faces(2), upper_faces(2)

      from = max(below(2), above(2))
      to = min(below(3), above(3))
      if (from >= to) return
      lower_faces = [(from - below(2))*below_units + 1, (to - below(2))*below_units]
      upper_faces = [(from - above(2))*above_units + 1, (to - above(2))*above_units]
      if (chance(r, 0.7_real64)) then
         call join_faces(upper, 1, upper_faces, lower, 3, lower_faces, matching)
      else
         call join_faces(lower, 3, lower_faces, upper, 1, upper_faces, matching)
      end if
   end subroutine join_courses

   !> One body or two in the corner of a rigid floor and one or two rigid walls, all rough.
   subroutine lay_corner()
      real(real64) :: w, h
      integer :: b, upper
      logical :: matching

      scene%kind = 'corner'
      w = uniform(r, 0.5_real64, 2.0_real64)
      h = uniform(r, 0.4_real64, 1.2_real64)
      b = add_body(0.0_real64, w, [0.0_real64, 0.0_real64, h, h])
      base(b) = .true.
      call join_rigid(b, 1, draw_gap(.false.))
      call join_rigid(b, 2, draw_gap(.false.))
      if (chance(r, 0.3_real64)) call join_rigid(b, 4, draw_gap(.false.))
      if (chance(r, 0.4_real64)) then
         upper = add_body(0.0_real64, w, [h, h, h + 0.7_real64, h + 0.7_real64])
         matching = chance(r, 0.6_real64)
         if (matching) call take_mesh(upper, b, .true.)
         call join(upper, 1, b, 3, matching)
         if (chance(r, 0.5_real64)) call join_rigid(upper, 2, draw_gap(.false.))
      end if
   end subroutine lay_corner

   !> One body or two on a tilted rigid floor, with a roller at a side or friction alone.
   subroutine lay_tilted(turn)
      real(real64), intent(inout) :: turn
      real(real64) :: slope, w, h
      integer :: b, side

      scene%kind = 'tilted'
      slope = uniform(r, -0.5_real64, 0.5_real64)
      w = uniform(r, 0.6_real64, 2.0_real64)
      h = uniform(r, 0.4_real64, 1.0_real64)
      b = add_body(0.0_real64, w, [0.0_real64, slope*w, h + max(slope*w, 0.0_real64), h + max(slope*w, 0.0_real64)])
      base(b) = .true.
      call join_rigid(b, 1, draw_gap(.false.))
      side = merge(2, 4, chance(r, 0.5_real64))
      if (chance(r, 0.6_real64)) scene%body(b)%held(1, side) = .true.
      if (chance(r, 0.4_real64)) then
         h = scene%body(b)%corner(2, 3)
         b = add_body(0.1_real64*w, 0.9_real64*w, [h, h, h + 0.5_real64, h + 0.5_real64])
         call join(b, 1, 1, 3, .false.)
         if (chance(r, 0.4_real64)) scene%body(b)%held(1, side) = .true.
      end if
      ! a block that slides as a whole: everything is turned by its slope
      if (chance(r, 0.2_real64)) turn = -atan(slope)
   end subroutine lay_tilted

   !> A wedge on a rigid floor under a body that a rigid wall or a roller holds.
   subroutine lay_wedge()
      real(real64) :: w, left, right, top
      integer :: wedge, b
      logical :: matching

      scene%kind = 'wedge'
      w = uniform(r, 0.8_real64, 2.0_real64)
      left = uniform(r, 0.5_real64, 0.9_real64)
      right = left - w*uniform(r, 0.03_real64, 0.2_real64)
      top = left + uniform(r, 0.2_real64, 0.8_real64)
      wedge = add_body(0.0_real64, w, [0.0_real64, 0.0_real64, left, right])
      base(wedge) = .true.
      call join_rigid(wedge, 1, draw_gap(.false.))
      b = add_body(0.0_real64, w, [left, right, top, top])
      matching = chance(r, 0.6_real64)
      if (matching) call take_mesh(b, wedge, .true.)
      call join(b, 1, wedge, 3, matching)
      if (chance(r, 0.6_real64)) then
         call join_rigid(b, 2, draw_gap(.false.))
      else
         scene%body(b)%held(1, 2) = .true.
      end if
      if (chance(r, 0.2_real64)) call join_rigid(b, 3, draw_gap(.false.))
   end subroutine lay_wedge

   !> Straight-sided voussoirs between rigid springings.
   subroutine lay_arch(n)
      integer, intent(in) :: n
      real(real64) :: inner, outer, from, step, corner(2, 4)
      integer :: i, b
      logical :: matching

      scene%kind = 'arch'
      inner = 1
      outer = 1 + uniform(r, 0.15_real64, 0.8_real64)
      from = uniform(r, 0.0_real64, 0.9_real64)
      step = (acos(-1.0_real64) - 2*from)/n
      matching = chance(r, 0.7_real64)
      do i = 1, n
         ! from the right springing to the left one; side 1 is the intrados, side 4 the joint before
         corner(:, 1) = inner*direction(from + (i - 1)*step)
         corner(:, 2) = outer*direction(from + (i - 1)*step)
         corner(:, 3) = outer*direction(from + i*step)
         corner(:, 4) = inner*direction(from + i*step)
         b = add_quad(corner)
         if (matching .and. i > 1) call take_mesh(b, b - 1, .true.)
         if (i > 1) call join(b, 1, b - 1, 3, matching)
      end do
      call join_rigid(1, 1, [0.0_real64, 0.0_real64])
      if (chance(r, 0.7_real64)) then
         call join_rigid(n, 3, [0.0_real64, 0.0_real64])
      else
         scene%body(n)%held(:, 3) = .true.
      end if
   end subroutine lay_arch

   pure function direction(angle) result(d)
      real(real64), intent(in) :: angle
      real(real64) :: d(2)

      d = [cos(angle), sin(angle)]
   end function direction

   !> Punches side by side on one body, loaded very differently.
   subroutine lay_punches(n)
      integer, intent(in) :: n
      real(real64) :: x, gap(2), w
      integer :: i, b

      scene%kind = 'punches'
      has_weak_bodies = .true.
      b = add_body(0.0_real64, real(n, real64), [0.0_real64, 0.0_real64, 0.8_real64, 0.8_real64])
      call put_down(b, 0.4_real64)
      do i = 1, n
         w = uniform(r, 0.4_real64, 0.8_real64)
         x = i - 1 + uniform(r, 0.05_real64, 0.15_real64)
         gap = 0.8_real64 + draw_gap(.false.)
         b = add_body(x, x + w, [gap(1), gap(2), 1.5_real64, 1.5_real64])
         call join(b, 1, 1, 3, .false.)
      end do
   end subroutine lay_punches

   !> A pile whose middle bodies carry nothing and lie loose, mostly under a body that is held.
   subroutine lay_loose(n)
      integer, intent(in) :: n

      call lay_stack(n)
      scene%kind = 'loose'
      loose(2:n - 1) = .true.
      hung = chance(r, 0.6_real64)
   end subroutine lay_loose

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
