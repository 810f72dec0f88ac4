!> A motion that proves that loads cannot be balanced, freed from the round-off of the linear programme that found it.
!>
!> Where bodies slide, stay closed or stick in the motion, the programme leaves rates of some 1e-9 of it. Against forces that are
!> many times the loads, and a wedge can make such forces, that is a resistance. So the rates that are small are set to zero by the
!> least change of the motion; what cannot be, as the rates of a wedge, the check of the proof sees.
module atrito_motion_polish
   use atrito_contact_line, only: contact_line_t
   use atrito_dense, only: least_squares
   use atrito_kinds, only: ip, wp
   use atrito_motion_rows, only: motion_rows_t, motion_rates
   implicit none (type, external)
   private
   public :: polish_motion

   real(wp), parameter :: SMALL = 1.0e-6_wp      !< rate over the motion of the bodies there
   real(wp), parameter :: DEPENDENT = 1.0e-12_wp !< singular value over the largest
   integer(ip), parameter :: MOST_MOTIONS = 500_ip !< of a group: the least squares are dense

contains

   !> Motions whose scale is zero stay as they are.
   subroutine polish_motion(rows, line, scale, v)
      type(motion_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: scale(:)           !< (k) size of the forces on each motion [F]; 0: it takes no part
      real(wp), intent(inout) :: v(:)            !< (k) [L]
      real(wp), allocatable :: conditions(:, :), change(:)
      integer(ip) :: motions(rows%k), column(rows%k), n, i, rank, info

      n = count(scale > 0.0_wp, kind=ip)
      if (n > MOST_MOTIONS) return
      motions(:n) = pack([(i, i=1, rows%k)], scale > 0.0_wp)
      column = 0
      column(motions(:n)) = [(i, i=1, n)]
      call set_up_conditions(rows, line, column, v, conditions)
      do i = 1, n
         conditions(:, i) = conditions(:, i)/scale(motions(i))
      end do
      do i = 1, size(conditions, 1, kind=ip)
         conditions(i, :) = conditions(i, :)/norm2(conditions(i, :))
      end do
      allocate (change(n))
      call least_squares(conditions, matmul(conditions, scale(motions(:n))*v(motions(:n))), change, DEPENDENT, rank, info)
      if (info == 0) v(motions(:n)) = v(motions(:n)) - change/scale(motions(:n))
   end subroutine polish_motion

   !> Rows that are zero in a motion without round-off: N_k v + (1/w_k) sum_j w_j nu_j W_jk |T_j v| where that is small, and T_j v
   !> where points stick.
   subroutine set_up_conditions(rows, line, column, v, conditions)
      type(motion_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: column(:)       !< (k) of each motion, 0: none
      real(wp), intent(in) :: v(:)
      real(wp), allocatable, intent(out) :: conditions(:, :) !< (conditions, motions)
      real(wp) :: rate(rows%m), speed(rows%m), share
      real(wp), allocatable :: normal(:, :), tangential(:, :)
      real(wp) :: resisted(line%n), most(line%n)
      integer(ip) :: j, e
      logical :: wanted(line%n), sticks(line%n)

      rate = motion_rates(rows, v, .false.)
      speed = speeds(rows, v)
      allocate (normal(line%n, maxval(column)), tangential(line%n, maxval(column)), source=0.0_wp)
      resisted = 0.0_wp
      most = 0.0_wp
      sticks = .false.
      do j = 1, line%n
         call add(line%normal(j), 1.0_wp, j)
      end do
      do j = 1, line%n
         if (line%tangential(j) == 0) cycle
         call add_row(rows, line%tangential(j), 1.0_wp, column, tangential(j, :))
         sticks(j) = abs(rate(line%tangential(j))) <= SMALL*speed(line%tangential(j))
         if (sticks(j)) cycle
         do e = line%average%first(j), line%average%first(j + 1) - 1
            associate (k => line%average%column(e))
               share = line%weight(j)*line%law(j)%nu*line%average%entry(e)/line%weight(k)
               call add(line%tangential(j), sign(share, rate(line%tangential(j))), k)
            end associate
         end do
      end do
      wanted = line%normal > 0 .and. abs(resisted) <= SMALL*most .and. maxval(abs(normal), dim=2) > 0.0_wp
      sticks = sticks .and. maxval(abs(tangential), dim=2) > 0.0_wp
      conditions = reshape([pack(transpose(normal), spread(wanted, 1, size(normal, 2))), &
                            pack(transpose(tangential), spread(sticks, 1, size(normal, 2)))], &
                           [count(wanted) + count(sticks), size(normal, 2)], order=[2, 1])

   contains

      !> A part of a row of motions for the normal direction of point k.
      subroutine add(i, part, k)
         integer(ip), intent(in) :: i, k
         real(wp), intent(in) :: part

         if (i == 0) return
         call add_row(rows, i, part, column, normal(k, :))
         resisted(k) = resisted(k) + part*rate(i)
         most(k) = max(most(k), speed(i))
      end subroutine add

   end subroutine set_up_conditions

   !> The fastest motion of the bodies that each row touches.
   pure function speeds(rows, v) result(speed)
      type(motion_rows_t), intent(in) :: rows
      real(wp), intent(in) :: v(:)
      real(wp) :: speed(rows%m), of_body(0:maxval(rows%body))
      integer(ip) :: i, e

      of_body = 0.0_wp
      do i = 1, rows%k
         of_body(rows%body(i)) = max(of_body(rows%body(i)), abs(v(i)))
      end do
      speed = 0.0_wp
      do i = 1, rows%m
         do e = rows%first(i), rows%first(i + 1) - 1
            speed(i) = max(speed(i), of_body(rows%body(rows%motion(e))))
         end do
      end do
   end function speeds

   !> to <- to + part times row i of G, by the columns of the motions.
   subroutine add_row(rows, i, part, column, to)
      type(motion_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: i, column(:)
      real(wp), intent(in) :: part
      real(wp), intent(inout) :: to(:)
      integer(ip) :: e

      do e = rows%first(i), rows%first(i + 1) - 1
         associate (k => column(rows%motion(e)))
            if (k > 0) to(k) = to(k) + part*rows%value(e)
         end associate
      end do
   end subroutine add_row

end module atrito_motion_polish
