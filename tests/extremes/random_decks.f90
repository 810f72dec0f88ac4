!> Random two-body decks: random_decks K S prints deck number K of seed S. Every deck is a function of (K, S) alone.
!>
!> Independent and mostly log-uniform: E ratio 1e-6..1e6 (lower over upper), delta E 1e-14..1e-4, eps 1e-12..1e-3, nu .01..100,
!> 4..12 contact elements, gaps and small overclosures, heights, Poisson's ratios, plane strain or stress. Half of the decks have
!> nine-node elements, a third is dragged sideways by a prescribed displacement or a force. Every deck has a solution: the upper
!> body is held from above, or pressed down with its resultant inside the contact line, and dragged only as far as friction can hold
!> it where nothing else does.
program random_decks
   use, intrinsic :: iso_fortran_env, only: int64, output_unit, real64
   use scene_file, only: scene_t, set_value, get, write_deck
   implicit none (type, external)

   !> State of L'Ecuyer's combined generator MRG32k3a (1999).
   integer(int64) :: s1(3), s2(3)
   type(scene_t) :: scene
   character(len=32) :: argument
   character(len=80) :: title
   integer :: k, seed

   if (command_argument_count() /= 2) error stop 'random_decks K S'
   call get_command_argument(1, argument)
   read (argument, *) k
   call get_command_argument(2, argument)
   read (argument, *) seed
   call start(k, seed)
   call draw_scene(scene)
   write (title, '(2(a,i0))') 'Random deck ', k, ' of seed ', seed
   call write_deck(output_unit, scene, trim(title))

contains

   subroutine start(k, seed)
      integer, intent(in) :: k, seed
      real(real64) :: dropped
      integer :: i

      s1 = [12345_int64 + k, 23456_int64 + 7_int64*seed, 34567_int64 + 3_int64*k]
      s2 = [45678_int64 + seed, 56789_int64 + 11_int64*k, 67891_int64 + 5_int64*seed]
      ! neighbouring seeds are alike for the first numbers
      do i = 1, 50
         dropped = uniform(0.0_real64, 1.0_real64)
      end do
   end subroutine start

   !> Uniform in (a, b).
   real(real64) function uniform(a, b)
      real(real64), intent(in) :: a, b
      integer(int64), parameter :: M1 = 4294967087_int64, M2 = 4294944443_int64
      integer(int64) :: p1, p2

      p1 = modulo(1403580_int64*s1(2) - 810728_int64*s1(1), M1)
      s1 = [s1(2), s1(3), p1]
      p2 = modulo(527612_int64*s2(3) - 1370589_int64*s2(1), M2)
      s2 = [s2(2), s2(3), p2]
      uniform = a + (b - a)*(real(modulo(p1 - p2, M1), real64) + 0.5_real64)/real(M1, real64)
   end function uniform

   !> 10**uniform.
   real(real64) function log_uniform(a, b)
      real(real64), intent(in) :: a, b

      log_uniform = 10.0_real64**uniform(a, b)
   end function log_uniform

   !> A whole number in a..b.
   integer function whole(a, b)
      integer, intent(in) :: a, b

      whole = min(a + int(uniform(0.0_real64, real(b - a + 1, real64))), b)
   end function whole

   logical function chance(share)
      real(real64), intent(in) :: share

      chance = uniform(0.0_real64, 1.0_real64) < share
   end function chance

   subroutine put(name, value)
      character(len=*), intent(in) :: name
      real(real64), intent(in) :: value

      call set_value(scene, name, value)
   end subroutine put

   subroutine draw_scene(scene)
      type(scene_t), intent(inout) :: scene

      call draw_meshes()
      call put('plane_stress', merge(1.0_real64, 0.0_real64, chance(0.5_real64)))
      call put('lower_e', log_uniform(-6.0_real64, 6.0_real64))
      call put('lower_mu', uniform(0.0_real64, 0.45_real64))
      call put('upper_mu', uniform(0.0_real64, 0.45_real64))
      call put('delta', log_uniform(-14.0_real64, -4.0_real64))
      call put('eps', log_uniform(-12.0_real64, -3.0_real64))
      call put('nu', log_uniform(-2.0_real64, 2.0_real64))
      call put('rho', 0.0_real64)
      if (chance(0.8_real64)) call put('rho', uniform(0.5_real64, 4.0_real64)/get(scene, 'upper_nx'))
      call draw_gaps()
      call draw_loads()
   end subroutine draw_scene

   !> The upper body is 1 wide. Three quarters of the meshes match; the lower body may be wider by whole elements.
   subroutine draw_meshes()
      real(real64) :: nx, beside, h
      logical :: quadratic

      nx = whole(4, 12)
      h = 1/nx
      quadratic = chance(0.5_real64)
      call put('upper_order', merge(2.0_real64, 1.0_real64, quadratic))
      call put('lower_order', merge(2.0_real64, 1.0_real64, quadratic))
      call put('upper_nx', nx)
      call put('upper_ny', real(whole(2, 6), real64))
      call put('lower_ny', real(whole(2, 6), real64))
      call put('upper_height', uniform(0.2_real64, 1.0_real64))
      call put('lower_height', uniform(0.2_real64, 1.0_real64))
      beside = whole(0, 2)
      call put('lower_x', -beside*h)
      call put('lower_width', 1 + 2*beside*h)
      call put('lower_nx', nx + 2*beside)
      if (chance(0.25_real64)) call put('lower_nx', real(whole(4, 12), real64))
   end subroutine draw_meshes

   !> Closed, a constant gap, a wedge, a small overclosure.
   subroutine draw_gaps()
      real(real64) :: kind, left, right

      kind = uniform(0.0_real64, 1.0_real64)
      left = 0
      right = 0
      if (kind > 0.4_real64) left = log_uniform(-6.0_real64, -3.0_real64)
      right = left
      if (kind > 0.6_real64) right = log_uniform(-6.0_real64, -3.0_real64)
      if (kind > 0.9_real64) then
         left = -log_uniform(-6.0_real64, -4.0_real64)
         right = left
      end if
      call put('gap_left', left)
      call put('gap_right', right)
   end subroutine draw_gaps

   !> Half of the decks: the top is prescribed. A quarter: pressed, held sideways at the right end. A quarter: pressed, held by
   !> friction alone.
   subroutine draw_loads()
      real(real64) :: kind, soft, pressure, side
      logical :: dragged

      kind = uniform(0.0_real64, 1.0_real64)
      dragged = chance(1.0_real64/3)
      side = merge(1.0_real64, -1.0_real64, chance(0.5_real64))
      soft = min(get(scene, 'lower_e'), 1.0_real64)
      pressure = soft*log_uniform(-5.0_real64, -2.0_real64)
      if (kind < 0.5_real64) then
         call put('top_x', 1.0_real64)
         call put('top_y', 1.0_real64)
         call put('top_u2', -max(get(scene, 'gap_left'), get(scene, 'gap_right')) - log_uniform(-4.0_real64, -2.0_real64))
         if (dragged) call put('top_u1', side*log_uniform(-4.0_real64, -2.0_real64))
      else
         call put('top_pressure', pressure)
         if (kind < 0.75_real64) then
            call put('upper_right_x', 1.0_real64)
            if (dragged) call put('upper_bx', side*pressure*log_uniform(-2.0_real64, 0.5_real64))
         else if (dragged) then
            ! the force is friction's at most, and its moment leaves the resultant inside the contact line
            call put('upper_bx', side*pressure*uniform(0.05_real64, 0.3_real64)*min(get(scene, 'nu'), 1.0_real64) &
                     /get(scene, 'upper_height'))
         end if
      end if
   end subroutine draw_loads

end program random_decks
