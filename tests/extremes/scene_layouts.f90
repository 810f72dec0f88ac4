!> How the bodies of random_scenes lie: stacks, rows, bonds, corners, wedges, arches.
module scene_layouts
   use, intrinsic :: iso_fortran_env, only: real64
   use bodies_deck, only: body_t, MOST_BODIES
   use random_numbers, only: uniform, whole, chance
   use scene_parts, only: add_body, add_quad, refine_along, take_mesh, join, join_faces, join_rigid, put_down, draw_gap, r, &
                          scene, has_weak_bodies, hung, loose, base, stacked
   implicit none (type, external)
   private
   public :: lay_stack, lay_row, lay_bond, lay_corner, lay_tilted, lay_wedge, lay_arch, direction, lay_punches, lay_loose

contains

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

end module scene_layouts
