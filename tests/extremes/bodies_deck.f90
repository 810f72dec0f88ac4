!> A scene of up to six quadrilateral bodies, rigid lines, contact pairs, supports and loads, and its deck.
module bodies_deck
   use, intrinsic :: iso_fortran_env, only: real64
   use random_numbers, only: random_t, uniform
   implicit none (type, external)
   private
   public :: body_t, pair_t, bodies_t, write_bodies, side_length, side_count, area, MOST_BODIES, MOST_ELEMENTS

   integer, parameter :: MOST_BODIES = 6, MOST_ELEMENTS = 24, MOST_PAIRS = 24
   character(len=6), parameter :: SIDE_NAME(4) = ['BOTTOM', 'RIGHT ', 'TOP   ', 'LEFT  ']

   !> Sides: 1 bottom and 3 top from corner 1 to 2 and 4 to 3, 2 right and 4 left upwards.
   type :: body_t
      real(real64) :: corner(2, 4) = 0           !< counter-clockwise
      integer :: nx = 2, ny = 2, order = 1
      logical :: stress = .false., as_block = .false. !< plane stress; written as *BLOCK, else as nodes and elements
      real(real64) :: bx(0:MOST_ELEMENTS) = 0, by(0:MOST_ELEMENTS) = 0 !< break points, 0..1
      real(real64) :: shake = 0                  !< inner nodes are moved by up to this part of an element
      real(real64) :: e = 1, mu = 0, thickness = 1
      real(real64) :: force(2) = 0               !< per volume
      logical :: as_weight = .false.             !< written as GRAV
      real(real64) :: pressure(4) = 0            !< on the sides
      integer :: pushed_corner = 0
      real(real64) :: push(2) = 0                !< force at that corner
      logical :: touches(4) = .false.            !< sides in a pair
      logical :: held(2, 4) = .false.            !< dofs of the sides that are prescribed
      real(real64) :: moved(2, 4) = 0            !< to these values
      integer :: pinned_corner = 0, first_node = 1, first_element = 1
   end type body_t

   type :: pair_t
      integer :: slave = 0, slave_side = 1, slave_first = 1, slave_last = 0
      integer :: master = 0, master_side = 1, master_first = 1, master_last = 0 !< master 0: the rigid line
      real(real64) :: line(2, 2) = 0
      logical :: matching = .false., line_kernel = .false.
      character(len=7) :: behaviour = 'HARD'
      real(real64) :: stiffness = 0              !< slope or delta
      character(len=8) :: friction = 'NONE'      !< NONE, LOCAL, NONLOCAL
      real(real64) :: nu = 0, slope = 0, eps = 0, rho = 0 !< slope 0: exact stick
   end type pair_t

   type :: bodies_t
      character(len=16) :: kind = ''
      integer :: n = 0, n_pairs = 0
      integer :: digits = 17                     !< of the coordinates
      type(body_t) :: body(MOST_BODIES)
      type(pair_t) :: pair(MOST_PAIRS)
   end type bodies_t

contains

   pure integer function side_count(body, side)
      type(body_t), intent(in) :: body
      integer, intent(in) :: side

      side_count = merge(body%nx, body%ny, mod(side, 2) == 1)
   end function side_count

   pure real(real64) function side_length(body, side)
      type(body_t), intent(in) :: body
      integer, intent(in) :: side

      side_length = norm2(body%corner(:, mod(side, 4) + 1) - body%corner(:, side))
   end function side_length

   pure real(real64) function area(body)
      type(body_t), intent(in) :: body
      real(real64) :: d(2), e(2)

      d = body%corner(:, 3) - body%corner(:, 1)
      e = body%corner(:, 4) - body%corner(:, 2)
      area = 0.5_real64*(d(1)*e(2) - d(2)*e(1))
   end function area

   !> Node at place (i, j) of the grid, counted from 0.
   pure integer function node_at(body, i, j)
      type(body_t), intent(in) :: body
      integer, intent(in) :: i, j

      node_at = body%first_node + j*(body%nx*body%order + 1) + i
   end function node_at

   !> The element at face k of a side.
   pure integer function element_at(body, side, k)
      type(body_t), intent(in) :: body
      integer, intent(in) :: side, k

      select case (side)
      case (1)
         element_at = body%first_element + k - 1
      case (2)
         element_at = body%first_element + k*body%nx - 1
      case (3)
         element_at = body%first_element + (body%ny - 1)*body%nx + k - 1
      case default
         element_at = body%first_element + (k - 1)*body%nx
      end select
   end function element_at

   pure integer function corner_node(body, corner)
      type(body_t), intent(in) :: body
      integer, intent(in) :: corner
      integer, parameter :: RIGHT(4) = [0, 1, 1, 0], UP(4) = [0, 0, 1, 1]

      corner_node = node_at(body, RIGHT(corner)*body%nx*body%order, UP(corner)*body%ny*body%order)
   end function corner_node

   pure integer function side_node(body, side, k)
      type(body_t), intent(in) :: body
      integer, intent(in) :: side, k             !< k from 0

      select case (side)
      case (1)
         side_node = node_at(body, k, 0)
      case (2)
         side_node = node_at(body, body%nx*body%order, k)
      case (3)
         side_node = node_at(body, k, body%ny*body%order)
      case default
         side_node = node_at(body, 0, k)
      end select
   end function side_node

   !> x at the fractions (a, b) of a body.
   pure function place(body, a, b) result(x)
      type(body_t), intent(in) :: body
      real(real64), intent(in) :: a, b
      real(real64) :: x(2)

      x = (1 - b)*((1 - a)*body%corner(:, 1) + a*body%corner(:, 2)) + b*((1 - a)*body%corner(:, 4) + a*body%corner(:, 3))
   end function place

   !> A number with so many digits, short where it can be.
   function text(x, digits) result(word)
      real(real64), intent(in) :: x
      integer, intent(in) :: digits
      character(len=:), allocatable :: word
      character(len=40) :: field, layout

      if (.not. abs(x) > 0) then
         word = '0.'
         return
      end if
      write (layout, '(a,i0,a)') '(es39.', digits - 1, 'e3)'
      write (field, layout) x
      word = trim(adjustl(field))
   end function text

   function real_text(x) result(word)
      real(real64), intent(in) :: x
      character(len=:), allocatable :: word

      word = text(x, 17)
   end function real_text

   function name_of(letter, k) result(word)
      character(len=*), intent(in) :: letter
      integer, intent(in) :: k
      character(len=:), allocatable :: word
      character(len=12) :: number

      write (number, '(i0)') k
      word = letter//trim(number)
   end function name_of

   !> The deck. r moves the inner nodes.
   subroutine write_bodies(unit, scene, title, r)
      integer, intent(in) :: unit
      type(bodies_t), intent(inout) :: scene
      character(len=*), intent(in) :: title
      type(random_t), intent(inout) :: r
      integer :: b, k

      write (unit, '(a)') '*HEADING', title
      call number_bodies(scene)
      do b = 1, scene%n
         if (scene%body(b)%as_block) then
            call write_block(unit, scene%body(b), name_of('B', b), scene%digits)
         else
            call write_mesh(unit, scene%body(b), name_of('B', b), scene%digits, r)
         end if
         call write_material(unit, scene%body(b), name_of('B', b))
      end do
      do k = 1, scene%n_pairs
         call write_pair(unit, scene, scene%pair(k), name_of('P', k))
      end do
      write (unit, '(a)') '*STEP', '*STATIC'
      call write_supports(unit, scene)
      call write_loads(unit, scene)
      write (unit, '(a)') '*NODE PRINT', 'U, RF', '*CONTACT PRINT', '*END STEP'
   end subroutine write_bodies

   subroutine number_bodies(scene)
      type(bodies_t), intent(inout) :: scene
      integer :: b, node, element

      node = 1
      element = 1
      do b = 1, scene%n
         associate (body => scene%body(b))
            body%first_node = node
            body%first_element = element
            node = node + (body%nx*body%order + 1)*(body%ny*body%order + 1)
            element = element + body%nx*body%ny
         end associate
      end do
   end subroutine number_bodies

   function type_name(body) result(word)
      type(body_t), intent(in) :: body
      character(len=4) :: word

      word = merge('CPS', 'CPE', body%stress)//merge('9', '4', body%order == 2)
   end function type_name

   subroutine write_block(unit, body, name, digits)
      integer, intent(in) :: unit, digits
      type(body_t), intent(in) :: body
      character(len=*), intent(in) :: name
      integer :: i

      write (unit, '(5a,2(a,i0))') '*BLOCK, TYPE=', type_name(body), ', ELSET=', name, ',', ' NX=', body%nx, ', NY=', body%ny
      do i = 1, 4
         write (unit, '(3a)') text(body%corner(1, i), digits), ', ', text(body%corner(2, i), digits)
      end do
      if (body%nx > 1) call write_breaks(unit, 'X', body%bx(1:body%nx - 1))
      if (body%ny > 1) call write_breaks(unit, 'Y', body%by(1:body%ny - 1))
   end subroutine write_block

   subroutine write_breaks(unit, letter, breaks)
      integer, intent(in) :: unit
      character(len=*), intent(in) :: letter
      real(real64), intent(in) :: breaks(:)
      character(len=:), allocatable :: line
      integer :: i

      line = letter
      do i = 1, size(breaks)
         line = line//', '//real_text(breaks(i))
      end do
      write (unit, '(a)') line
   end subroutine write_breaks

   !> Corners of elements first, moved where they lie inside; the other nodes of an element half way between them.
   subroutine write_mesh(unit, body, name, digits, r)
      integer, intent(in) :: unit, digits
      type(body_t), intent(in) :: body
      character(len=*), intent(in) :: name
      type(random_t), intent(inout) :: r
      real(real64) :: x(2, 0:body%nx*body%order, 0:body%ny*body%order)
      integer :: i, j, o

      o = body%order
      do j = 0, body%ny
         do i = 0, body%nx
            x(:, i*o, j*o) = place(body, body%bx(i), body%by(j))
         end do
      end do
      if (body%shake > 0) call shake_nodes(body, x, r)
      if (o == 2) call fill_between(body, x)
      write (unit, '(a)') '*NODE'
      do j = 0, body%ny*o
         do i = 0, body%nx*o
            write (unit, '(i0,4a)') node_at(body, i, j), ', ', text(x(1, i, j), digits), ', ', text(x(2, i, j), digits)
         end do
      end do
      write (unit, '(4a)') '*ELEMENT, TYPE=', type_name(body), ', ELSET=', name
      do j = 1, body%ny
         do i = 1, body%nx
            write (unit, '(*(i0,:,", "))') body%first_element + (j - 1)*body%nx + i - 1, element_nodes(body, i, j)
         end do
      end do
   end subroutine write_mesh

   subroutine shake_nodes(body, x, r)
      type(body_t), intent(in) :: body
      real(real64), intent(inout) :: x(:, 0:, 0:)
      type(random_t), intent(inout) :: r
      real(real64) :: a, b
      integer :: i, j

      do j = 1, body%ny - 1
         do i = 1, body%nx - 1
            a = uniform(r, -body%shake, body%shake)*min(body%bx(i + 1) - body%bx(i), body%bx(i) - body%bx(i - 1))
            b = uniform(r, -body%shake, body%shake)*min(body%by(j + 1) - body%by(j), body%by(j) - body%by(j - 1))
            x(:, i*body%order, j*body%order) = place(body, body%bx(i) + a, body%by(j) + b)
         end do
      end do
   end subroutine shake_nodes

   subroutine fill_between(body, x)
      type(body_t), intent(in) :: body
      real(real64), intent(inout) :: x(:, 0:, 0:)
      integer :: i, j

      do j = 0, 2*body%ny, 2
         do i = 1, 2*body%nx, 2
            x(:, i, j) = 0.5_real64*(x(:, i - 1, j) + x(:, i + 1, j))
         end do
      end do
      do j = 1, 2*body%ny, 2
         do i = 0, 2*body%nx
            x(:, i, j) = 0.5_real64*(x(:, i, j - 1) + x(:, i, j + 1))
         end do
      end do
   end subroutine fill_between

   pure function element_nodes(body, i, j) result(nodes)
      type(body_t), intent(in) :: body
      integer, intent(in) :: i, j
      integer, allocatable :: nodes(:)
      integer :: a, b

      a = (i - 1)*body%order
      b = (j - 1)*body%order
      if (body%order == 1) then
         nodes = [node_at(body, a, b), node_at(body, a + 1, b), node_at(body, a + 1, b + 1), node_at(body, a, b + 1)]
      else
         nodes = [node_at(body, a, b), node_at(body, a + 2, b), node_at(body, a + 2, b + 2), node_at(body, a, b + 2), &
                  node_at(body, a + 1, b), node_at(body, a + 2, b + 1), node_at(body, a + 1, b + 2), node_at(body, a, b + 1), &
                  node_at(body, a + 1, b + 1)]
      end if
   end function element_nodes

   subroutine write_material(unit, body, name)
      integer, intent(in) :: unit
      type(body_t), intent(in) :: body
      character(len=*), intent(in) :: name

      write (unit, '(a)') '*MATERIAL, NAME=M-'//name, '*ELASTIC', real_text(body%e)//', '//real_text(body%mu)
      if (body%as_weight) write (unit, '(a)') '*DENSITY', real_text(norm2(body%force))
      write (unit, '(a)') '*SOLID SECTION, ELSET='//name//', MATERIAL=M-'//name, real_text(body%thickness)
   end subroutine write_material

   subroutine write_pair(unit, scene, pair, name)
      integer, intent(in) :: unit
      type(bodies_t), intent(in) :: scene
      type(pair_t), intent(in) :: pair
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: rule

      call write_faces(unit, scene%body(pair%slave), pair%slave_side, pair%slave_first, pair%slave_last, name//'-S')
      if (pair%master > 0) then
         call write_faces(unit, scene%body(pair%master), pair%master_side, pair%master_first, pair%master_last, name//'-M')
      else
         write (unit, '(a)') '*SURFACE, NAME='//name//'-M, TYPE=SEGMENTS', &
            'START, '//text(pair%line(1, 1), scene%digits)//', '//text(pair%line(2, 1), scene%digits), &
            'LINE, '//text(pair%line(1, 2), scene%digits)//', '//text(pair%line(2, 2), scene%digits), &
            '*RIGID BODY, ANALYTICAL SURFACE='//name//'-M'
      end if
      write (unit, '(a)') '*SURFACE INTERACTION, NAME='//name
      call write_law(unit, pair)
      rule = ', QUADRATURE=NODAL'
      if (pair%matching .or. pair%master == 0) rule = ''
      write (unit, '(a)') '*CONTACT PAIR, INTERACTION='//name//rule, name//'-S, '//name//'-M'
   end subroutine write_pair

   subroutine write_faces(unit, body, side, first, last, name)
      integer, intent(in) :: unit, side, first, last
      type(body_t), intent(in) :: body
      character(len=*), intent(in) :: name
      integer :: k

      write (unit, '(a)') '*SURFACE, NAME='//name
      do k = first, last
         write (unit, '(i0,a,i0)') element_at(body, side, k), ', S', side
      end do
   end subroutine write_faces

   subroutine write_law(unit, pair)
      integer, intent(in) :: unit
      type(pair_t), intent(in) :: pair
      character(len=:), allocatable :: kernel

      write (unit, '(a)') '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE='//trim(pair%behaviour)
      if (pair%behaviour /= 'HARD') write (unit, '(a)') real_text(pair%stiffness)
      select case (pair%friction)
      case ('LOCAL')
         write (unit, '(a)') '*FRICTION'
         if (pair%slope > 0) then
            write (unit, '(a)') real_text(pair%nu)//', '//real_text(pair%slope)
         else
            write (unit, '(a)') real_text(pair%nu)
         end if
      case ('NONLOCAL')
         kernel = ''
         if (pair%line_kernel) kernel = ', KERNEL=LINE'
         write (unit, '(a)') '*FRICTION, NONLOCAL'//kernel, real_text(pair%nu)//', '//real_text(pair%eps)//', '//real_text(pair%rho)
      end select
   end subroutine write_law

   !> A corner of two held sides takes the value of the first.
   subroutine write_supports(unit, scene)
      integer, intent(in) :: unit
      type(bodies_t), intent(in) :: scene
      logical :: begun
      integer :: b

      begun = .false.
      do b = 1, scene%n
         call write_held_sides(unit, scene%body(b), begun)
      end do
   end subroutine write_supports

   subroutine write_held_sides(unit, body, begun)
      integer, intent(in) :: unit
      type(body_t), intent(in) :: body
      logical, intent(inout) :: begun
      logical, allocatable :: done(:, :)
      integer :: side, dof, k, node

      allocate (done(2, body%first_node:node_at(body, body%nx*body%order, body%ny*body%order)), source=.false.)
      do side = 1, 4
         do dof = 1, 2
            if (.not. body%held(dof, side)) cycle
            do k = 0, side_count(body, side)*body%order
               node = side_node(body, side, k)
               if (.not. done(dof, node)) call write_support(unit, node, dof, body%moved(dof, side), begun)
               done(dof, node) = .true.
            end do
         end do
      end do
      if (body%pinned_corner == 0) return
      node = corner_node(body, body%pinned_corner)
      do dof = 1, 2
         if (.not. done(dof, node)) call write_support(unit, node, dof, 0.0_real64, begun)
      end do
   end subroutine write_held_sides

   subroutine write_support(unit, node, dof, value, begun)
      integer, intent(in) :: unit, node, dof
      real(real64), intent(in) :: value
      logical, intent(inout) :: begun

      if (.not. begun) write (unit, '(a)') '*BOUNDARY'
      begun = .true.
      write (unit, '(3(i0,a),a)') node, ', ', dof, ', ', dof, ', ', real_text(value)
   end subroutine write_support

   subroutine write_loads(unit, scene)
      integer, intent(in) :: unit
      type(bodies_t), intent(in) :: scene
      integer :: b, side

      do b = 1, scene%n
         associate (body => scene%body(b))
            if (any(abs(body%force) > 0)) call write_volume_force(unit, body, name_of('B', b))
            do side = 1, 4
               if (abs(body%pressure(side)) > 0) call write_pressure(unit, body, side, name_of('B', b))
            end do
            if (body%pushed_corner > 0) call write_push(unit, body)
         end associate
      end do
   end subroutine write_loads

   subroutine write_pressure(unit, body, side, name)
      integer, intent(in) :: unit, side
      type(body_t), intent(in) :: body
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: value
      integer :: k

      value = real_text(body%pressure(side))
      if (body%as_block) then
         write (unit, '(a)') '*DSLOAD', name//'-'//trim(SIDE_NAME(side))//', P, '//value
         return
      end if
      write (unit, '(a)') '*DLOAD'
      do k = 1, side_count(body, side)
         write (unit, '(2(i0,a),a)') element_at(body, side, k), ', P', side, ', ', value
      end do
   end subroutine write_pressure

   subroutine write_volume_force(unit, body, name)
      integer, intent(in) :: unit
      type(body_t), intent(in) :: body
      character(len=*), intent(in) :: name

      write (unit, '(a)') '*DLOAD'
      if (body%as_weight) then
         write (unit, '(a)') name//', GRAV, 1., '//real_text(body%force(1)/norm2(body%force))//', ' &
            //real_text(body%force(2)/norm2(body%force))
      else
         write (unit, '(a)') name//', BX, '//real_text(body%force(1)), name//', BY, '//real_text(body%force(2))
      end if
   end subroutine write_volume_force

   subroutine write_push(unit, body)
      integer, intent(in) :: unit
      type(body_t), intent(in) :: body
      integer :: dof

      write (unit, '(a)') '*CLOAD'
      do dof = 1, 2
         write (unit, '(2(i0,a),a)') corner_node(body, body%pushed_corner), ', ', dof, ', ', real_text(body%push(dof))
      end do
   end subroutine write_push

end module bodies_deck
