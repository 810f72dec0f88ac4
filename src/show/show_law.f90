!> --show law: the laws of friction and of pressure with the points of this run on them.
!>
!> Over the slip that a point may have while it sticks, u = u_T/eps (of Coulomb's law with a stick slope k, u = u_T k/(nu p)), all
!> laws are one: t/tau = phi'(u) = min(|u|, 1) sign(u), and phi(u) = u^2/2 up to |u| = 1, |u| - 1/2 beyond. Exact stick has no such
!> slip: the largest slip of the points takes its place then.
module atrito_show_law
   use atrito_contact_line, only: contact_line_t, rest_of
   use atrito_friction_law, only: sticking_slip
   use atrito_kinds, only: ip, wp
   use atrito_page, only: page_t, add_heading, add_line
   use atrito_results, only: results_t
   use atrito_strings, only: append_string, to_text
   use atrito_table, only: table_t, add_integers, add_real_columns, begin_table
   implicit none (type, external)
   private
   public :: view_law

   integer, parameter :: HALF = 32, HIGH = 6        !< of the drawing, in characters from its middle
   real(wp), parameter :: SHOWN = 2.0_wp            !< u of its ends: points beyond stand there

contains

   !> Page and table: a row a point.
   pure subroutine view_law(line, results, page, table)
      type(contact_line_t), intent(in) :: line      !< laws and deltas of the points
      type(results_t), intent(in) :: results        !< fields of the pairs at the end
      type(page_t), intent(inout) :: page           !< gets the view
      type(table_t), intent(out) :: table           !< show-law
      integer(ip), allocatable :: numbers(:, :)
      real(wp), allocatable :: values(:, :)
      real(wp) :: tau, limit, slip, u, most
      integer(ip) :: i, k, j

      allocate (numbers(line%n, 2), values(line%n, 9))
      most = 0.0_wp
      do i = 1, size(results%contact, kind=ip)
         if (results%contact(i)%n > 0) most = max(most, maxval(abs(results%contact(i)%slip)))
      end do
      j = 0
      do i = 1, size(results%contact, kind=ip)
         associate (c => results%contact(i))
            do k = 1, c%n
               j = j + 1
               tau = line%law(j)%nu*c%weighted_pressure(k)
               limit = sticking_slip(line%law(j), tau)
               slip = c%slip(k) - rest_of(line, j)
               u = slip/merge(limit, max(most, tiny(1.0_wp)), limit > 0.0_wp)
               numbers(j, :) = [i, k]
               values(j, :) = [c%s(k), -c%gap(k), line%delta(j), c%pressure(k), slip, limit, tau, -c%shear(k), u]
            end do
         end associate
      end do
      call begin_table(table, 'show-law', 'a row a contact point on its laws', j)
      call append_string(table%remarks, 'pressure = overlap/delta where the overlap is positive, delta 0: no overlap')
      call append_string(table%remarks, 'friction = bound min(|u|, 1) sign(u), u = slip/limit (exact stick has limit 0: over '// &
                         'the largest slip); friction: upon the master along T, slip: less that at which it is none')
      call add_integers(table, 'pair', numbers(:j, 1))
      call add_integers(table, 'point', numbers(:j, 2))
      call add_real_columns(table, [character(len=8) :: 's', 'overlap', 'delta', 'pressure', 'slip', 'limit', 'bound', &
                                    'friction', 'u'], &
                            [character(len=5) :: 'L', 'L', 'L^3/F', 'F/L^2', 'L', 'L', 'F/L^2', 'F/L^2', '-'], values(:j, :))
      call add_heading(page, 'law of friction: t/tau over u = slip/(slip at which it is full), and the points')
      if (all(values(:j, 7) <= 0.0_wp)) then
         call add_line(page, 'no point has friction')
      else
         call draw_friction(values(:j, :), page)
      end if
      call add_line(page, 'law of pressure: p = overlap/delta; largest overlap '// &
                    to_text(maxval([values(:j, 2), 0.0_wp]), 4)//', pressure '//to_text(maxval(values(:j, 4)), 4))
   end subroutine view_law

   !> The curve of dots, and how many points there are at each place of it: 1 to 9, + for more.
   pure subroutine draw_friction(values, page)
      real(wp), intent(in) :: values(:, :)
      type(page_t), intent(inout) :: page
      character(len=1) :: canvas(-HALF:HALF, -HIGH:HIGH)
      integer :: count_at(-HALF:HALF, -HIGH:HIGH), i, x, y
      character(len=2*HALF + 1) :: line

      canvas = ' '
      canvas(:, 0) = '-'
      count_at = 0
      do x = -HALF, HALF
         canvas(x, nint(HIGH*max(-1.0_wp, min(1.0_wp, SHOWN*x/HALF)))) = '.'
      end do
      do i = 1, size(values, 1)
         if (values(i, 7) <= 0.0_wp) cycle
         x = nint(HALF*max(-1.0_wp, min(1.0_wp, values(i, 9)/SHOWN)))
         y = nint(HIGH*max(-1.0_wp, min(1.0_wp, values(i, 8)/values(i, 7))))
         count_at(x, y) = count_at(x, y) + 1
         canvas(x, y) = merge('+', achar(iachar('0') + min(count_at(x, y), 9)), count_at(x, y) > 9)
      end do
      do y = HIGH, -HIGH, -1
         write (line, '(*(a))') canvas(:, y)
         call add_line(page, merge(' 1', merge('-1', merge(' 0', '  ', y == 0), y == -HIGH), y == HIGH)//' '//line)
      end do
      call add_line(page, '  u: -2'//repeat(' ', HALF - 5)//'0'//repeat(' ', HALF - 2)//'2')
      call add_line(page, 'a digit: so many points there (+: more than 9); those beyond |u| = 2 at the ends')
   end subroutine draw_friction

end module atrito_show_law
