!> bodies.tab and joints.tab: what the parts of a wall come to, one row each.
module atrito_resultant_tables
   use atrito_kinds, only: ip, wp
   use atrito_results, only: results_t, body_motion_t
   use atrito_strings, only: string_t
   use atrito_summary, only: scales_t, scales_of_pair
   use atrito_table, only: table_t, begin_table, add_real_columns, add_integers, add_words, clear_small, one_word
   implicit none (type, external)
   private
   public :: build_bodies, build_joints

contains

   !> A row a body.
   subroutine build_bodies(results, scales, table)
      type(results_t), intent(in) :: results        !< with bodies
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      character(len=8), parameter :: GROUPS(3) = ['loads   ', 'supports', 'contact ']
      type(string_t) :: names(size(results%bodies))
      real(wp) :: field(size(results%bodies), 12), force
      integer(ip) :: i, n
      integer :: k

      n = size(results%bodies, kind=ip)
      force = largest_force(results%bodies)
      do i = 1, n
         associate (body => results%bodies(i))
            names(i)%s = one_word(body%name)
            field(i, :) = [body%u, body%rotation, body%loads, body%supports, body%contact]
            call clear_small(scales%displacement, field(i, 1:2))
            call clear_small(scales%displacement/body%size, field(i, 3:3))
            do k = 4, 10, 3
               call clear_small(max(force, body%terms(1)), field(i, k:k + 1))
               call clear_small(max(force*body%size, body%terms(2)), field(i, k + 2:k + 2))
            end do
         end associate
      end do
      call begin_table(table, 'bodies', 'a row a body: its best rigid motion, resultants and moments about its centre', n)
      call add_integers(table, 'step', [results%step])
      call add_integers(table, 'body', [(i, i=1, n)])
      call add_words(table, 'name', '-', names, on_the_left=.true.)
      call add_real_columns(table, ['u1      ', 'u2      ', 'rotation'], ['L', 'L', '-'], field(:, :3))
      do k = 1, size(GROUPS)
         call add_real_columns(table, trim(GROUPS(k))//['_fx    ', '_fy    ', '_moment'], ['F  ', 'F  ', 'F*L'], &
                               field(:, 3*k + 1:3*k + 3))
      end do
   end subroutine build_bodies

   !> Largest component of the resultants.
   pure real(wp) function largest_force(bodies) result(largest)
      type(body_motion_t), intent(in) :: bodies(:)
      integer(ip) :: i

      largest = 0.0_wp
      do i = 1, size(bodies, kind=ip)
         largest = max(largest, maxval(abs([bodies(i)%loads(:2), bodies(i)%supports(:2), bodies(i)%contact(:2)])))
      end do
   end function largest_force

   !> A row a joint.
   subroutine build_joints(results, scales, table)
      type(results_t), intent(in) :: results        !< with joints
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      type(scales_t) :: own
      real(wp) :: field(size(results%joints), 7)
      integer(ip) :: i, n

      n = size(results%joints, kind=ip)
      do i = 1, n
         associate (joint => results%joints(i))
            own = scales_of_pair(scales, results%contact(joint%pair))
            field(i, :) = [joint%n, joint%t, joint%m, joint%place, joint%opening, joint%sliding]
            call clear_small(joint%force, field(i, 1:2))
            call clear_small(joint%force*joint%length, field(i, 3:3))
            call clear_small(scales%length, field(i, 4:5))
            call clear_small(own%displacement, field(i, 6:6))
            call clear_small(own%slip, field(i, 7:7))
         end associate
      end do
      call begin_table(table, 'joints', 'a row for each two bodies that a pair brings together; body 0 is a rigid surface', n)
      call add_integers(table, 'step', [results%step])
      call add_integers(table, 'pair', results%joints%pair)
      call add_integers(table, 'body_1', results%joints%bodies(1))
      call add_integers(table, 'body_2', results%joints%bodies(2))
      call add_real_columns(table, [character(len=7) :: 'n', 't', 'm', 'x', 'y', 'opening', 'sliding'], &
                            ['F  ', 'F  ', 'F*L', 'L  ', 'L  ', 'L  ', 'L  '], field)
   end subroutine build_joints

end module atrito_resultant_tables
