!> An elastic block in quadruple precision: mesh, stiffness, supports, loads, and its flexibility seen from its contact nodes.
!>
!> Written apart from atrito on purpose: its own elements, its own elimination. A block is a quadrilateral of nx x ny equal
!> elements, nodes numbered column by column. A body that its supports leave free is pinned far from the contact; the pins take no
!> force where the loads balance, and the rigid motions are given apart.
module quad_body
   use, intrinsic :: iso_fortran_env, only: real64, real128
   implicit none (type, external)
   private
   public :: body_t, make_body, set_material, finish_body, node_of, add_pressure, add_body_force, prescribe, &
             SIDE_BOTTOM, SIDE_RIGHT, SIDE_TOP, SIDE_LEFT

   integer, parameter :: qp = real128
   integer, parameter :: SIDE_BOTTOM = 1, SIDE_RIGHT = 2, SIDE_TOP = 3, SIDE_LEFT = 4

   type :: body_t
      integer :: order = 1                             !< 1: four nodes, 2: nine nodes
      integer :: nx = 0, ny = 0                        !< elements
      integer :: mx = 0, my = 0                        !< intervals of nodes
      real(qp) :: thickness = 1
      real(qp) :: d(3, 3) = 0                          !< elasticity
      real(qp), allocatable :: x(:, :)                 !< (2, nodes)
      real(qp), allocatable :: f(:), value(:)          !< (2 nodes) loads, prescribed displacements
      logical, allocatable :: held(:)                  !< (2 nodes)
      integer :: contact_side = SIDE_BOTTOM
      integer, allocatable :: contact(:)               !< nodes of the contact side, left to right
      real(qp), allocatable :: flexibility(:, :)       !< (2 contact nodes)^2, zero rows for held dofs
      real(qp), allocatable :: u0(:)                   !< (2 contact nodes) displacement without contact forces
      real(qp), allocatable :: modes(:, :)             !< (2 contact nodes, k), zero at held dofs
      real(qp), allocatable :: work(:)                 !< (k) of the loads on the modes
      logical, allocatable :: contact_held(:)          !< (2 contact nodes)
   end type body_t

contains

   pure integer function node_of(body, i, j)
      type(body_t), intent(in) :: body
      integer, intent(in) :: i, j                      !< 0..mx, 0..my

      node_of = i*(body%my + 1) + j + 1
   end function node_of

   subroutine make_body(corners, order, nx, ny, contact_side, body)
      real(real64), intent(in) :: corners(2, 4)
      integer, intent(in) :: order, nx, ny, contact_side
      type(body_t), intent(out) :: body
      real(qp) :: s, t
      integer :: i, j, n

      body%order = order
      body%nx = nx
      body%ny = ny
      body%mx = nx*order
      body%my = ny*order
      body%contact_side = contact_side
      n = (body%mx + 1)*(body%my + 1)
      allocate (body%x(2, n), body%f(2*n), body%value(2*n), body%held(2*n))
      body%f = 0
      body%value = 0
      body%held = .false.
      do i = 0, body%mx
         do j = 0, body%my
            s = real(i, qp)/body%mx
            t = real(j, qp)/body%my
            body%x(:, node_of(body, i, j)) = (1 - s)*(1 - t)*corners(:, 1) + s*(1 - t)*corners(:, 2) + s*t*corners(:, 3) &
                                             + (1 - s)*t*corners(:, 4)
         end do
      end do
      j = merge(0, body%my, contact_side == SIDE_BOTTOM)
      body%contact = [(node_of(body, i, j), i=0, body%mx)]
   end subroutine make_body

   subroutine set_material(young, poisson, thickness, plane_stress, body)
      real(real64), intent(in) :: young, poisson, thickness
      logical, intent(in) :: plane_stress
      type(body_t), intent(inout) :: body
      real(qp) :: lambda, shear, e, mu

      body%thickness = thickness
      e = young
      mu = poisson
      shear = e/(2*(1 + mu))
      lambda = e*mu/((1 + mu)*(1 - 2*mu))
      if (plane_stress) lambda = e*mu/((1 + mu)*(1 - mu))
      body%d(1:2, 1:2) = lambda
      body%d(1, 1) = lambda + 2*shear
      body%d(2, 2) = lambda + 2*shear
      body%d(3, 3) = shear
   end subroutine set_material

   !> Nodes of a side in the order of travel round the block, counter-clockwise.
   pure function side_nodes(body, side) result(nodes)
      type(body_t), intent(in) :: body
      integer, intent(in) :: side
      integer, allocatable :: nodes(:)
      integer :: i

      select case (side)
      case (SIDE_BOTTOM)
         nodes = [(node_of(body, i, 0), i=0, body%mx)]
      case (SIDE_RIGHT)
         nodes = [(node_of(body, body%mx, i), i=0, body%my)]
      case (SIDE_TOP)
         nodes = [(node_of(body, i, body%my), i=body%mx, 0, -1)]
      case default
         nodes = [(node_of(body, 0, i), i=body%my, 0, -1)]
      end select
   end function side_nodes

   !> Prescribes a displacement on a side; side 0: on the whole body.
   subroutine prescribe(body, side, axis, value)
      type(body_t), intent(inout) :: body
      integer, intent(in) :: side, axis
      real(real64), intent(in) :: value
      integer, allocatable :: nodes(:)
      integer :: i

      if (side > 0) nodes = side_nodes(body, side)
      if (side == 0) nodes = [(i, i=1, size(body%x, 2))]
      do i = 1, size(nodes)
         body%held(2*(nodes(i) - 1) + axis) = .true.
         body%value(2*(nodes(i) - 1) + axis) = value
      end do
   end subroutine prescribe

   !> A uniform pressure on a straight side.
   subroutine add_pressure(body, side, pressure)
      type(body_t), intent(inout) :: body
      integer, intent(in) :: side
      real(real64), intent(in) :: pressure
      integer, allocatable :: nodes(:)
      real(qp) :: along(2), push(2), share(0:2)
      integer :: e, k, dof

      nodes = side_nodes(body, side)
      share = [0.5_qp, 0.5_qp, 0.0_qp]
      if (body%order == 2) share = [1.0_qp, 4.0_qp, 1.0_qp]/6
      do e = 1, size(nodes) - 1, body%order
         along = body%x(:, nodes(e + body%order)) - body%x(:, nodes(e))
         ! outward is the direction of travel turned by -90 degrees
         push = [-along(2), along(1)]*pressure*body%thickness
         do k = 0, body%order
            dof = 2*(nodes(e + k) - 1)
            body%f(dof + 1:dof + 2) = body%f(dof + 1:dof + 2) + share(k)*push
         end do
      end do
   end subroutine add_pressure

   subroutine add_body_force(body, force)
      type(body_t), intent(inout) :: body
      real(real64), intent(in) :: force(2)
      real(qp) :: shape(9), b(3, 18), weight
      integer :: nodes(9), n, i, j, point, k

      n = (body%order + 1)**2
      do i = 1, body%nx
         do j = 1, body%ny
            nodes(:n) = element_nodes(body, i, j)
            do point = 1, n
               call element_point(body, nodes(:n), point, shape, b, weight)
               do k = 1, n
                  body%f(2*nodes(k) - 1:2*nodes(k)) = body%f(2*nodes(k) - 1:2*nodes(k)) + shape(k)*weight*force
               end do
            end do
         end do
      end do
   end subroutine add_body_force

   !> Nodes of an element, column by column.
   pure function element_nodes(body, i, j) result(nodes)
      type(body_t), intent(in) :: body
      integer, intent(in) :: i, j                      !< 1..nx, 1..ny
      integer, allocatable :: nodes(:)
      integer :: a, b

      nodes = [((node_of(body, (i - 1)*body%order + a, (j - 1)*body%order + b), b=0, body%order), a=0, body%order)]
   end function element_nodes

   !> Shape functions, strain matrix and weight (with Jacobian and thickness) at a Gauss point. Tensor products of the functions
   !> of one direction at -1, (0,) 1.
   subroutine element_point(body, nodes, point, shape, b, weight)
      type(body_t), intent(in) :: body
      integer, intent(in) :: nodes(:), point
      real(qp), intent(out) :: shape(9), b(3, 18), weight
      real(qp) :: xi(2), w(2), f(3, 2), g(3, 2), dn(2, 9), jacobian(2, 2), det, dx(2)
      integer :: m, k, a, c, axis

      m = body%order + 1
      call gauss(m, (point - 1)/m + 1, xi(1), w(1))
      call gauss(m, mod(point - 1, m) + 1, xi(2), w(2))
      do axis = 1, 2
         if (m == 2) then
            f(1:2, axis) = [1 - xi(axis), 1 + xi(axis)]/2
            g(1:2, axis) = [-0.5_qp, 0.5_qp]
         else
            f(:, axis) = [xi(axis)*(xi(axis) - 1)/2, 1 - xi(axis)**2, xi(axis)*(xi(axis) + 1)/2]
            g(:, axis) = [xi(axis) - 0.5_qp, -2*xi(axis), xi(axis) + 0.5_qp]
         end if
      end do
      jacobian = 0
      do k = 1, m*m
         a = (k - 1)/m + 1
         c = mod(k - 1, m) + 1
         shape(k) = f(a, 1)*f(c, 2)
         dn(:, k) = [g(a, 1)*f(c, 2), f(a, 1)*g(c, 2)]
         do axis = 1, 2
            jacobian(:, axis) = jacobian(:, axis) + body%x(:, nodes(k))*dn(axis, k)
         end do
      end do
      det = jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1)
      b = 0
      do k = 1, m*m
         dx(1) = (jacobian(2, 2)*dn(1, k) - jacobian(2, 1)*dn(2, k))/det
         dx(2) = (jacobian(1, 1)*dn(2, k) - jacobian(1, 2)*dn(1, k))/det
         b(1, 2*k - 1) = dx(1)
         b(2, 2*k) = dx(2)
         b(3, 2*k - 1) = dx(2)
         b(3, 2*k) = dx(1)
      end do
      weight = w(1)*w(2)*det*body%thickness
   end subroutine element_point

   pure subroutine gauss(m, i, x, w)
      integer, intent(in) :: m, i
      real(qp), intent(out) :: x, w
      real(qp) :: two(2), three(3)

      if (m == 2) then
         two = [-1, 1]/sqrt(3.0_qp)
         x = two(i)
         w = 1
      else
         three = [-1, 0, 1]*sqrt(0.6_qp)
         x = three(i)
         w = merge(8.0_qp, 5.0_qp, i == 2)/9
      end if
   end subroutine gauss

   !> Assembles, eliminates, and fills flexibility, u0, modes and work.
   subroutine finish_body(body)
      type(body_t), intent(inout) :: body
      logical :: pinned(size(body%held))
      real(qp), allocatable :: modes(:, :), band(:, :), rhs(:, :)
      integer, allocatable :: equation(:), dofs(:)
      real(qp) :: k(18, 18)
      integer :: i, j, n, width

      pinned = body%held
      call find_modes(body, pinned, modes)
      allocate (equation(size(pinned)), source=0)
      n = 0
      do i = 1, size(pinned)
         if (pinned(i)) cycle
         n = n + 1
         equation(i) = n
      end do
      width = 2*(body%order*(body%my + 1) + body%order + 1)
      dofs = [([2*body%contact(i) - 1, 2*body%contact(i)], i=1, size(body%contact))]
      allocate (band(0:width, n), rhs(n, size(dofs) + 1))
      band = 0
      rhs = 0
      do i = 1, size(pinned)
         if (equation(i) > 0) rhs(equation(i), size(dofs) + 1) = body%f(i)
      end do
      do i = 1, body%nx
         do j = 1, body%ny
            call stiffness(body, element_nodes(body, i, j), k)
            call add_element(element_nodes(body, i, j), k, equation, body%value, band, rhs(:, size(dofs) + 1))
         end do
      end do
      do i = 1, size(dofs)
         if (equation(dofs(i)) > 0) rhs(equation(dofs(i)), i) = 1
      end do
      call solve_band(band, rhs)
      allocate (body%flexibility(size(dofs), size(dofs)), body%u0(size(dofs)), body%modes(size(dofs), size(modes, 2)))
      body%flexibility = 0
      body%contact_held = body%held(dofs)
      do i = 1, size(dofs)
         body%u0(i) = body%value(dofs(i))
         if (equation(dofs(i)) == 0) cycle
         body%u0(i) = rhs(equation(dofs(i)), size(dofs) + 1)
         body%flexibility(i, :) = rhs(equation(dofs(i)), :size(dofs))
      end do
      body%modes = modes(dofs, :)
      body%work = matmul(body%f, modes)
   end subroutine finish_body

   !> The rigid motions that the supports leave, and a pin for each at the corners opposite to the contact side.
   subroutine find_modes(body, pinned, modes)
      type(body_t), intent(in) :: body
      logical, intent(inout) :: pinned(:)
      real(qp), allocatable, intent(out) :: modes(:, :)
      logical :: held_x(size(body%x, 2)), held_y(size(body%x, 2)), turns
      real(qp) :: centre(2), scale
      integer :: a, b, k, n, row

      held_x = body%held(1::2)
      held_y = body%held(2::2)
      n = size(body%x, 2)
      centre = sum(body%x, dim=2)/n
      scale = maxval(body%x(1, :)) - minval(body%x(1, :))
      turns = spread_of(body%x(2, :), held_x) < scale*1.0e-12_qp .and. spread_of(body%x(1, :), held_y) < scale*1.0e-12_qp
      if (turns .and. any(held_y)) error stop 'a body held in y at one place of x: not foreseen'
      if (any(held_x)) centre(2) = maxval(body%x(2, :), mask=held_x)
      row = merge(body%my, 0, body%contact_side == SIDE_BOTTOM)
      a = node_of(body, 0, row)
      b = node_of(body, body%mx, row)
      allocate (modes(2*n, count([.not. any(held_x),.not. any(held_y), turns])))
      modes = 0
      k = 0
      if (.not. any(held_x)) then
         k = k + 1
         modes(1::2, k) = 1
         pinned(2*a - 1) = .true.
      end if
      if (.not. any(held_y)) then
         k = k + 1
         modes(2::2, k) = 1
         pinned(2*a) = .true.
      end if
      if (turns) then
         k = k + 1
         modes(1::2, k) = -(body%x(2, :) - centre(2))/scale
         modes(2::2, k) = (body%x(1, :) - centre(1))/scale
         pinned(2*b) = .true.
      end if
      do n = 1, size(pinned)
         if (body%held(n)) modes(n, :) = 0
      end do
   end subroutine find_modes

   pure real(qp) function spread_of(x, mask)
      real(qp), intent(in) :: x(:)
      logical, intent(in) :: mask(:)

      spread_of = 0
      if (any(mask)) spread_of = maxval(x, mask=mask) - minval(x, mask=mask)
   end function spread_of

   subroutine stiffness(body, nodes, k)
      type(body_t), intent(in) :: body
      integer, intent(in) :: nodes(:)
      real(qp), intent(out) :: k(18, 18)
      real(qp) :: shape(9), b(3, 18), weight
      integer :: point

      k = 0
      do point = 1, size(nodes)
         call element_point(body, nodes, point, shape, b, weight)
         k = k + weight*matmul(transpose(b), matmul(body%d, b))
      end do
   end subroutine stiffness

   !> Lower band: band(i - j, j). Prescribed displacements go to the right side.
   subroutine add_element(nodes, k, equation, value, band, load)
      integer, intent(in) :: nodes(:), equation(:)
      real(qp), intent(in) :: k(18, 18), value(:)
      real(qp), intent(inout) :: band(0:, :), load(:)
      integer :: dofs(2*size(nodes)), a, b, i, j

      dofs = [([2*nodes(a) - 1, 2*nodes(a)], a=1, size(nodes))]
      do b = 1, size(dofs)
         j = equation(dofs(b))
         do a = 1, size(dofs)
            i = equation(dofs(a))
            if (i == 0) cycle
            if (j == 0) then
               load(i) = load(i) - k(a, b)*value(dofs(b))
            else if (i >= j) then
               band(i - j, j) = band(i - j, j) + k(a, b)
            end if
         end do
      end do
   end subroutine add_element

   !> L D L' of a banded matrix, and the solution for all right sides.
   subroutine solve_band(band, rhs)
      real(qp), intent(inout) :: band(0:, :), rhs(:, :)
      real(qp) :: factor
      integer :: n, width, i, j, k

      n = size(band, 2)
      width = ubound(band, 1)
      do j = 1, n
         if (band(0, j) <= 0) error stop 'a body is not held'
         do i = j + 1, min(j + width, n)
            factor = band(i - j, j)/band(0, j)
            if (abs(factor) > 0) then
               do k = i, min(j + width, n)
                  band(k - i, i) = band(k - i, i) - factor*band(k - j, j)
               end do
               rhs(i, :) = rhs(i, :) - factor*rhs(j, :)
            end if
         end do
      end do
      do j = n, 1, -1
         rhs(j, :) = rhs(j, :)/band(0, j)
         do i = max(1, j - width), j - 1
            ! the column of L times D is still in the band
            rhs(i, :) = rhs(i, :) - band(j - i, i)*rhs(j, :)
         end do
      end do
   end subroutine solve_band

end module quad_body
