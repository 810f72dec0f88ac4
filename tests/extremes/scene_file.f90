!> Two-body scenes as lists of `name = value`: what a deck of atrito and the quadruple-precision reference have in common.
!>
!> A body lies on another, the upper one is the slave. The lower is a rectangle, the upper a quadrilateral with straight sides whose
!> bottom may be tilted. Each is a block of equal elements. A deck that is written here begins with the scene in comment lines,
!> `** scene: name = value`, so that it can be read as a scene again.
module scene_file
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none (type, external)
   private
   public :: scene_t, read_scene, set_value, get, count_of, write_scene, write_deck, lower_corners, upper_corners, set_from_text

   integer, parameter :: N_VALUES = 46
   integer, parameter :: NAME_LENGTH = 16

   !> Names and defaults. Lengths, moduli and loads in any consistent units; flags are 0 or 1.
   !>
   !> lower_x, lower_y: the lower left corner; the upper body stands on the lower one's top, at upper_x. order: 1 four-node, 2 nine-
   !> node elements; nx, ny: elements. gap: initial distance at the ends of the upper body, negative: overclosed. delta, nu, eps,
   !> rho: the law. Flags: plane_stress; base_x, base_y: the base of the lower body is held; left_x, right_x: u1 = 0 on a side;
   !> lower_hold_x: u1 = 0 on the whole lower body; upper_hold_y: u2 = 0 on the whole upper one; top_x, top_y: the top is
   !> prescribed, to top_u1, top_u2. Pressures act on the upper body; bx, by: force per volume. tolerance, maxit: of *CONTROLS, 0:
   !> not given.
   character(len=NAME_LENGTH), parameter :: NAMES(N_VALUES) = [character(len=NAME_LENGTH) :: &
                                                               'plane_stress', 'lower_order', 'upper_order', 'lower_nx', &
                                                               'lower_ny', 'upper_nx', 'upper_ny', 'lower_x', &
                                                               'lower_y', 'lower_width', 'lower_height', 'upper_x', &
                                                               'upper_width', 'upper_height', 'gap_left', 'gap_right', &
                                                               'lower_e', 'lower_mu', 'lower_thick', 'upper_e', &
                                                               'upper_mu', 'upper_thick', 'delta', 'nu', &
                                                               'eps', 'rho', 'base_x', 'base_y', &
                                                               'lower_left_x', 'lower_right_x', 'upper_left_x', 'upper_right_x', &
                                                               'lower_hold_x', 'upper_hold_y', 'top_x', 'top_y', &
                                                               'top_u1', 'top_u2', 'top_pressure', 'left_pressure', &
                                                               'right_pressure', 'upper_bx', 'upper_by', 'lower_by', &
                                                               'tolerance', 'maxit']
   real(real64), parameter :: DEFAULTS(N_VALUES) = [real(real64) :: &
                                                    0, 1, 1, 4, 3, 4, 3, 0, 0, 1, 0.5, 0, 1, 0.5, 0, 0, &
                                                    1, 0.3_real64, 1, 1, 0.3_real64, 1, 0, 0.3_real64, 0, 0, 1, 1, 0, 0, 0, 0, &
                                                    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
   character(len=*), parameter :: MARK = '** scene: '

   type :: scene_t
      real(real64) :: value(N_VALUES) = DEFAULTS
   end type scene_t

contains

   !> The value of a name; a name that does not exist stops the program.
   pure real(real64) function get(scene, name)
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: name

      get = scene%value(place_of(name))
   end function get

   !> The same as a whole number.
   pure integer function count_of(scene, name)
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: name

      count_of = nint(get(scene, name))
   end function count_of

   pure logical function is_name(name)
      character(len=*), intent(in) :: name

      is_name = any(NAMES == name)
   end function is_name

   pure integer function place_of(name)
      character(len=*), intent(in) :: name

      place_of = findloc(NAMES, name, dim=1)
      if (place_of == 0) error stop 'scene: no such name'
   end function place_of

   pure subroutine set_value(scene, name, value)
      type(scene_t), intent(inout) :: scene
      character(len=*), intent(in) :: name
      real(real64), intent(in) :: value

      scene%value(place_of(name)) = value
   end subroutine set_value

   !> Reads `name = value` lines, or those behind the mark in a deck; other lines starting with ** or # are comments.
   subroutine read_scene(unit, scene)
      integer, intent(in) :: unit
      type(scene_t), intent(inout) :: scene
      character(len=200) :: line
      logical :: is_deck
      integer :: status

      is_deck = .false.
      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) return
         if (line(1:1) == '*' .and. line(2:2) /= '*') is_deck = .true.
         if (index(line, MARK) == 1) then
            is_deck = .true.
            call set_from_text(scene, line(len(MARK) + 1:))
         else if (.not. is_deck .and. line /= '' .and. line(1:1) /= '*' .and. line(1:1) /= '#') then
            call set_from_text(scene, line)
         end if
      end do
   end subroutine read_scene

   subroutine set_from_text(scene, text)
      type(scene_t), intent(inout) :: scene
      character(len=*), intent(in) :: text
      real(real64) :: value
      integer :: equals, status

      equals = index(text, '=')
      read (text(equals + 1:), *, iostat=status) value
      if (equals < 2 .or. status /= 0) then
         print '(2a)', 'scene: not name = value: ', trim(text)
         stop 2, quiet = .true.
      end if
      if (.not. is_name(adjustl(text(:equals - 1)))) then
         print '(2a)', 'scene: no such name: ', trim(text)
         stop 2, quiet = .true.
      end if
      call set_value(scene, adjustl(text(:equals - 1)), value)
   end subroutine set_from_text

   subroutine write_scene(unit, scene, prefix)
      integer, intent(in) :: unit
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: prefix
      integer :: i

      do i = 1, N_VALUES
         if (scene%value(i) == DEFAULTS(i)) cycle
         write (unit, '(4a)') prefix, trim(NAMES(i)), ' = ', number_text(scene%value(i))
      end do
   end subroutine write_scene

   !> The shortest decimal that reads back as the same number.
   function number_text(x) result(text)
      real(real64), intent(in) :: x
      character(len=:), allocatable :: text
      character(len=32) :: buffer, form
      real(real64) :: back
      integer :: digits

      do digits = 0, 16
         write (form, '(a,i0,a)') '(es32.', digits, 'e3)'
         write (buffer, form) x
         read (buffer, *) back
         if (back == x) exit
      end do
      text = trim(adjustl(buffer))
   end function number_text

   !> Corners counter-clockwise from the lower left, as the deck has them.
   pure function lower_corners(scene) result(x)
      type(scene_t), intent(in) :: scene
      real(real64) :: x(2, 4)
      real(real64) :: right, top

      right = get(scene, 'lower_x') + get(scene, 'lower_width')
      top = get(scene, 'lower_y') + get(scene, 'lower_height')
      x = reshape([get(scene, 'lower_x'), get(scene, 'lower_y'), right, get(scene, 'lower_y'), right, top, &
                   get(scene, 'lower_x'), top], [2, 4])
   end function lower_corners

   pure function upper_corners(scene) result(x)
      type(scene_t), intent(in) :: scene
      real(real64) :: x(2, 4)
      real(real64) :: right, base, top

      right = get(scene, 'upper_x') + get(scene, 'upper_width')
      base = get(scene, 'lower_y') + get(scene, 'lower_height')
      top = base + get(scene, 'upper_height')
      x = reshape([get(scene, 'upper_x'), base + get(scene, 'gap_left'), right, base + get(scene, 'gap_right'), right, top, &
                   get(scene, 'upper_x'), top], [2, 4])
   end function upper_corners

   !> The deck of a scene.
   subroutine write_deck(unit, scene, title)
      integer, intent(in) :: unit
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: title

      write (unit, '(a)') '*HEADING', title
      call write_scene(unit, scene, MARK)
      call write_body(unit, scene, 'LOWER', 'lower', lower_corners(scene))
      call write_body(unit, scene, 'UPPER', 'upper', upper_corners(scene))
      write (unit, '(a)') '*SURFACE INTERACTION, NAME=JOINT', '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY', &
         number_text(get(scene, 'delta')), '*FRICTION, NONLOCAL', &
         number_text(get(scene, 'nu'))//', '//number_text(get(scene, 'eps'))//', '//number_text(get(scene, 'rho')), &
         '*CONTACT PAIR, INTERACTION=JOINT, QUADRATURE=NODAL', 'UPPER-BOTTOM, LOWER-TOP'
      call write_supports(unit, scene)
      write (unit, '(a)') '*STEP', '*STATIC'
      call write_loads(unit, scene)
      call write_controls(unit, scene)
      write (unit, '(a)') '*NODE PRINT', 'U', '*END STEP'
   end subroutine write_deck

   subroutine write_body(unit, scene, name, prefix, corners)
      integer, intent(in) :: unit
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: name, prefix
      real(real64), intent(in) :: corners(2, 4)
      character(len=4) :: element_type
      integer :: i

      element_type = merge('CPS', 'CPE', get(scene, 'plane_stress') > 0)//merge('9', '4', count_of(scene, prefix//'_order') == 2)
      write (unit, '(3a,2(a,i0))') '*BLOCK, TYPE='//element_type, ', ELSET=', name, ', NX=', count_of(scene, prefix//'_nx'), &
         ', NY=', count_of(scene, prefix//'_ny')
      do i = 1, 4
         write (unit, '(a)') number_text(corners(1, i))//', '//number_text(corners(2, i))
      end do
      write (unit, '(a)') '*MATERIAL, NAME='//name, '*ELASTIC', &
         number_text(get(scene, prefix//'_e'))//', '//number_text(get(scene, prefix//'_mu')), &
         '*SOLID SECTION, ELSET='//name//', MATERIAL='//name, number_text(get(scene, prefix//'_thick'))
   end subroutine write_body

   subroutine write_supports(unit, scene)
      integer, intent(in) :: unit
      type(scene_t), intent(in) :: scene

      write (unit, '(a)') '*BOUNDARY'
      call write_if(unit, scene, 'base_x', 'LOWER-BOTTOM, 1')
      call write_if(unit, scene, 'base_y', 'LOWER-BOTTOM, 2')
      call write_if(unit, scene, 'lower_left_x', 'LOWER-LEFT, 1')
      call write_if(unit, scene, 'lower_right_x', 'LOWER-RIGHT, 1')
      call write_if(unit, scene, 'lower_hold_x', 'LOWER, 1')
      call write_if(unit, scene, 'upper_left_x', 'UPPER-LEFT, 1')
      call write_if(unit, scene, 'upper_right_x', 'UPPER-RIGHT, 1')
      call write_if(unit, scene, 'upper_hold_y', 'UPPER, 2')
   end subroutine write_supports

   subroutine write_if(unit, scene, flag, line)
      integer, intent(in) :: unit
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: flag, line

      if (get(scene, flag) > 0) write (unit, '(a)') line
   end subroutine write_if

   subroutine write_loads(unit, scene)
      integer, intent(in) :: unit
      type(scene_t), intent(in) :: scene

      if (get(scene, 'top_x') > 0) write (unit, '(a)') '*BOUNDARY', 'UPPER-TOP, 1, 1, '//number_text(get(scene, 'top_u1'))
      if (get(scene, 'top_y') > 0) write (unit, '(a)') '*BOUNDARY', 'UPPER-TOP, 2, 2, '//number_text(get(scene, 'top_u2'))
      call write_load(unit, scene, 'top_pressure', '*DSLOAD', 'UPPER-TOP, P, ')
      call write_load(unit, scene, 'left_pressure', '*DSLOAD', 'UPPER-LEFT, P, ')
      call write_load(unit, scene, 'right_pressure', '*DSLOAD', 'UPPER-RIGHT, P, ')
      call write_load(unit, scene, 'upper_bx', '*DLOAD', 'UPPER, BX, ')
      call write_load(unit, scene, 'upper_by', '*DLOAD', 'UPPER, BY, ')
      call write_load(unit, scene, 'lower_by', '*DLOAD', 'LOWER, BY, ')
   end subroutine write_loads

   subroutine write_load(unit, scene, name, keyword, line)
      integer, intent(in) :: unit
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: name, keyword, line

      if (abs(get(scene, name)) > 0) write (unit, '(a)') keyword, line//number_text(get(scene, name))
   end subroutine write_load

   subroutine write_controls(unit, scene)
      integer, intent(in) :: unit
      type(scene_t), intent(in) :: scene
      character(len=12) :: most

      if (get(scene, 'tolerance') > 0) write (unit, '(a)') '*CONTROLS, TOLERANCE='//number_text(get(scene, 'tolerance'))
      write (most, '(i0)') count_of(scene, 'maxit')
      if (get(scene, 'maxit') > 0) write (unit, '(a)') '*CONTROLS, MAXIT='//trim(most)
   end subroutine write_controls

end module scene_file
