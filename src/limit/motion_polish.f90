!> A motion that proves that loads cannot be balanced, freed from the round-off of the linear programme that found it.
!>
!> Where bodies slide, stay closed or stick in the motion, the programme leaves rates of some 1e-9 of it. Against forces that are
!> many times the loads, and a wedge can make such forces, that is a resistance. So the rates that are small are set to zero by the
!> least change of the motion; what cannot be, as the rates of a wedge, the check of the proof sees.
module atrito_motion_polish
   use atrito_contact_line, only: contact_line_t
   use atrito_dense, only: least_squares
   use atrito_kinds, only: ip, wp
   use atrito_motion_rows, only: motion_rows_t
   use atrito_sparse_rows, only: multiply_rows
   implicit none (type, external)
   private
   public :: polish_motion

   real(wp), parameter :: SMALL = 1.0e-6_wp      !< rate over the motion of the bodies there
   real(wp), parameter :: DEPENDENT = 1.0e-12_wp !< singular value over the largest
   integer(ip), parameter :: MOST_MOTIONS = 500_ip !< of a group: the least squares are dense

   !> What each point must not do along its normal: a row of motions, its rate, and the fastest of its parts.
   type :: resistance_t
      real(wp), allocatable :: row(:, :)         !< (points, motions)
      real(wp), allocatable :: rate(:), most(:)  !< (points) [L]
   end type resistance_t

contains

   !> Motions whose scale is zero stay as they are.
   !>
   !> Let c_i be the conditions (set_up_conditions) and S the scales. The least change d that makes all of them hold, c_i (v - d) =
   !> 0, is sought in the work of the forces on each motion,
   !>
   !>     minimise sum_k (S_k d_k)^2     with   c_i d = c_i v,
   !>
   !> by the shortest least squares solution for S d, each condition scaled to length one. A light body among heavy ones then moves
   !> by what is little for it. Dependent conditions count once.
   subroutine polish_motion(rows, line, scale, v)
      type(motion_rows_t), intent(in) :: rows    !< G
      type(contact_line_t), intent(in) :: line   !< weights, laws and averages of its points
      real(wp), intent(in) :: scale(:)           !< (k) size of the forces on each motion [F]; 0: it takes no part
      real(wp), intent(inout) :: v(:)            !< (k) [L]
      real(wp), allocatable :: conditions(:, :), change(:)
      integer(ip) :: motions(rows%n_columns), column(rows%n_columns), n, i, rank, info

      n = count(scale > 0.0_wp, kind=ip)
      if (n > MOST_MOTIONS) return
      motions(:n) = pack([(i, i=1, rows%n_columns)], scale > 0.0_wp)
      column = 0
      column(motions(:n)) = [(i, i=1, n)]
      call set_up_conditions(conditions)
      do i = 1, n
         conditions(:, i) = conditions(:, i)/scale(motions(i))
      end do
      do i = 1, size(conditions, 1, kind=ip)
         conditions(i, :) = conditions(i, :)/norm2(conditions(i, :))
      end do
      allocate (change(n))
      call least_squares(conditions, matmul(conditions, scale(motions(:n))*v(motions(:n))), change, DEPENDENT, rank, info)
      if (info == 0) v(motions(:n)) = v(motions(:n)) - change/scale(motions(:n))

   contains

      !> Rows that are zero in a motion without round-off: N_k v + (1/w_k) sum_j w_j nu_j W_jk |T_j v| where that is small, and T_j
      !> v where points stick.
      subroutine set_up_conditions(conditions)
         real(wp), allocatable, intent(out) :: conditions(:, :) !< (conditions, motions)
         type(resistance_t) :: normal
         real(wp) :: rate(rows%n), speed(rows%n), share
         real(wp), allocatable :: tangential(:, :)
         integer(ip) :: j, e
         logical :: wanted(line%n), sticks(line%n)

         call multiply_rows(rows, v, rate)
         speed = speeds(rows, v)
         allocate (normal%row(line%n, maxval(column)), normal%rate(line%n), normal%most(line%n), source=0.0_wp)
         allocate (tangential(line%n, maxval(column)), source=0.0_wp)
         sticks = .false.
         do j = 1, line%n
            if (line%normal(j) > 0) call add_part(rows, line%normal(j), 1.0_wp, column, rate, speed, j, normal)
         end do
         do j = 1, line%n
            associate (i => line%tangential(j))
               if (i == 0) cycle
               call add_row(rows, i, 1.0_wp, column, tangential(j, :))
               sticks(j) = abs(rate(i)) <= SMALL*speed(i)
               if (sticks(j)) cycle
               do e = line%average%first(j), line%average%first(j + 1) - 1
                  share = line%weight(j)*line%law(j)%nu*line%average%value(e)/line%weight(line%average%column(e))
                  call add_part(rows, i, sign(share, rate(i)), column, rate, speed, line%average%column(e), normal)
               end do
            end associate
         end do
         wanted = line%normal > 0 .and. abs(normal%rate) <= SMALL*normal%most .and. maxval(abs(normal%row), dim=2) > 0.0_wp
         sticks = sticks .and. maxval(abs(tangential), dim=2) > 0.0_wp
         conditions = reshape([pack(transpose(normal%row), spread(wanted, 1, size(normal%row, 2))), &
                               pack(transpose(tangential), spread(sticks, 1, size(tangential, 2)))], &
                              [count(wanted) + count(sticks), size(tangential, 2)], order=[2, 1])
      end subroutine set_up_conditions

   end subroutine polish_motion

   !> Adds a part of row i to what point k must not do along its normal.
   subroutine add_part(rows, i, part, column, rate, speed, k, normal)
      type(motion_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: i, column(:), k
      real(wp), intent(in) :: part, rate(:), speed(:)
      type(resistance_t), intent(inout) :: normal

      call add_row(rows, i, part, column, normal%row(k, :))
      normal%rate(k) = normal%rate(k) + part*rate(i)
      normal%most(k) = max(normal%most(k), speed(i))
   end subroutine add_part

   !> The fastest motion of the bodies that each row touches.
   pure function speeds(rows, v) result(speed)
      type(motion_rows_t), intent(in) :: rows
      real(wp), intent(in) :: v(:)
      real(wp) :: speed(rows%n), of_body(0:maxval(rows%body))
      integer(ip) :: i, e

      of_body = 0.0_wp
      do i = 1, rows%n_columns
         of_body(rows%body(i)) = max(of_body(rows%body(i)), abs(v(i)))
      end do
      speed = 0.0_wp
      do i = 1, rows%n
         do e = rows%first(i), rows%first(i + 1) - 1
            speed(i) = max(speed(i), of_body(rows%body(rows%column(e))))
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
         associate (k => column(rows%column(e)))
            if (k > 0) to(k) = to(k) + part*rows%value(e)
         end associate
      end do
   end subroutine add_row

end module atrito_motion_polish
