!> What the parts of random_scenes share: the scene while it is drawn, its bodies, joints and laws.
module scene_parts
   use, intrinsic :: iso_fortran_env, only: real64
   use bodies_deck, only: body_t, pair_t, bodies_t, side_length, side_count, MOST_BODIES
   use random_numbers, only: random_t, uniform, log_uniform, whole, chance
   implicit none (type, external)
   private
   public :: add_body, add_quad, refine_along, take_mesh, join, join_faces, join_rigid, put_down, draw_gap
   public :: draw_joint_laws, measure_pair

   type(random_t), public :: r
   type(bodies_t), public :: scene
   real(real64), public :: e_range, size_of_load
   logical, public :: mixed_orders, has_weak_bodies, hung
   logical, public :: loose(MOST_BODIES), base(MOST_BODIES), stacked

contains

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

end module scene_parts
