!> Rows of contact turned by what the digits of the deck leave in doubt, so that they do not hold what is free.
!>
!> A roller between two races stands on two points, and may spin about itself and roll round: both normals lie on one line. Rounding
!> of coordinates tilts them by some g/l_j to each other. Then the roller moves until points beside them bear the little moment, far
!> beyond all strains. Of the rows i that bear more than such doubts, the motions V are sought that these see by no more than the
!> digits (find_idle), and each normal n is turned by the angle that leaves least of them along it,
!>
!>     alpha = -sum_V (n . v)(T . v) / sum_V (T . v)^2
!>
!> which is no more than its doubt. With the rows that follow it is done again, until V is free of all of them to rounding.
module atrito_digit_turns
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_kinds, only: ip, wp
   use atrito_load_digits, only: rate_of_point
   use atrito_motion_rows, only: motion_rows_t, build_motion_rows
   use atrito_null_motions, only: find_idle
   use atrito_scene_data, only: scene_data_t, drop_assembled
   implicit none (type, external)
   private
   public :: turn_rows

   integer(ip), parameter :: MOST_TURNS = 60_ip
   integer(ip), parameter :: LONG_TURN = 3_ip       !< so often all that is to come is taken at once, by the ratio of the last two
   real(wp), parameter :: LEAST_TURN = 1.0e-13_wp
   real(wp), parameter :: MOST_RATIO = 0.95_wp

contains

   !> Turns the rows; has_changed: they are others now, and what was made of them is given back: solve again.
   subroutine turn_rows(data, rows, group, is_sure, near, has_changed)
      type(scene_data_t), intent(inout) :: data     !< its rows may change
      type(motion_rows_t), intent(inout) :: rows    !< whose doubt is noted; of the turned rows
      integer(ip), intent(in) :: group(:)           !< (k)
      logical, intent(in) :: is_sure(:)             !< (m) rows that bear more than what is in doubt
      real(wp), allocatable, intent(out) :: near(:, :) !< (k, motions) V
      logical, intent(out) :: has_changed
      type(motion_rows_t) :: turned
      real(wp), allocatable :: normals(:, :), tangents(:, :)
      real(wp) :: angle(rows%n), last(rows%n), sum_of(rows%n)
      integer(ip) :: i, n, turn

      has_changed = .false.
      call find_idle(rows, is_sure, group, near, rows%doubt)
      n = size(near, 2, kind=ip)
      if (n == 0) return
      normals = data%rows%normal
      tangents = data%rows%tangent
      angle = 0.0_wp
      sum_of = 0.0_wp
      do turn = 1, MOST_TURNS
         last = angle
         angle = [(angle_of(i), i=1, rows%n)]
         has_changed = maxval(abs(angle)) <= LEAST_TURN
         if (has_changed) exit
         if (modulo(turn, LONG_TURN) == 0) angle = angle/(1 - min(max(sum(angle*last)/sum(last**2), 0.0_wp), MOST_RATIO))
         sum_of = sum_of + angle
         if (any(abs(sum_of) > max(rows%doubt, data%rows%doubt(data%line%point)))) exit
         do i = 1, rows%n
            associate (j => data%line%point(i), a => angle(i))
               if (.not. abs(a) > 0.0_wp) cycle
               data%rows%normal(:, j) = data%rows%normal(:, j) + a*data%rows%tangent(:, j)
               data%rows%normal(:, j) = data%rows%normal(:, j)/norm2(data%rows%normal(:, j))
               data%rows%tangent(:, j) = [-data%rows%normal(2, j), data%rows%normal(1, j)]
            end associate
         end do
         call build_motion_rows(data%fem, data%rows, data%line, data%f, turned)
         call find_idle(turned, is_sure, group, near, rows%doubt)
         if (size(near, 2) < n) exit
      end do
      has_changed = has_changed .and. turn > 1
      if (.not. has_changed) then
         data%rows%normal = normals
         data%rows%tangent = tangents
         return
      end if
      turned%doubt = rows%doubt
      rows = turned
      call drop_assembled(data)
      if (allocated(data%flexibility)) deallocate (data%flexibility)
      if (allocated(data%certificate)) deallocate (data%certificate)

   contains

      !> By which the normal of row i turns; 0 where it stays as it is.
      real(wp) function angle_of(i) result(angle)
         integer(ip), intent(in) :: i
         real(wp) :: along, across, normal(2), tangent(2)
         integer(ip) :: k

         angle = 0.0_wp
         associate (j => data%line%point(i))
            if (.not. (is_sure(i) .and. rows%doubt(i) > 0.0_wp .and. data%line%normal(j) == i)) return
            if (data%line%law(j)%kind /= FRICTION_NONE .or. any(data%rows%is_held(:, j))) return
            normal = data%rows%normal(:, j)
            tangent = data%rows%tangent(:, j)
            along = 0.0_wp
            across = 0.0_wp
            do k = 1, size(near, 2, kind=ip)
               associate (slip => rate_of_point(data, j, tangent, near(:, k)))
                  along = along + slip**2
                  across = across + slip*rate_of_point(data, j, normal, near(:, k))
               end associate
            end do
         end associate
         if (along > 0.0_wp) angle = -across/along
      end function angle_of

   end subroutine turn_rows

end module atrito_digit_turns
