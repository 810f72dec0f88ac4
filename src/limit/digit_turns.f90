!> Rows of contact turned by what the digits of the deck leave in doubt, so that they do not hold what is free.
!>
!> A roller between two races stands on two points, and may spin about itself and roll round: both normals lie on one line. Rounding
!> of coordinates tilts them by some g/l_j to each other. Then the roller moves until points beside them bear the little moment, far
!> beyond all strains. Of the rows i that bear more than such doubts, the motions V are sought that these see by no more than the
!> digits (find_idle), and their normals n_i are turned by angles alpha_i so that there are as many motions V + dV that they do not
!> see at all:
!>
!>     G V + diag(alpha) T V + G dV = 0
!>
!> G and T having the rates along normals and tangents. Of all such angles those of the least sum of squares are taken, by Newton's
!> method: with the rows that follow it is done again, a few times. They may be no more than what is in doubt.
module atrito_digit_turns
   use atrito_dense, only: least_squares
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_kinds, only: ip, wp
   use atrito_load_digits, only: rate_of_point
   use atrito_motion_rows, only: motion_rows_t, build_motion_rows
   use atrito_null_motions, only: find_idle
   use atrito_scene_data, only: scene_data_t, drop_assembled
   use atrito_sparse_rows, only: multiply_rows
   implicit none (type, external)
   private
   public :: turn_rows

   integer(ip), parameter :: MOST_TURNS = 8_ip
   integer(ip), parameter :: MOST_EQUATIONS = 1000_ip !< of a step; their least squares take the cube of it
   real(wp), parameter :: LEAST_TURN = 1.0e-13_wp
   real(wp), parameter :: LEAST_RATE = 1.0e-11_wp   !< that a row sees of a motion of length one: rounding
   real(wp), parameter :: DEPENDENT = 5.0e-3_wp     !< of the largest rate: less may be what the digits show

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
      real(wp) :: angle(rows%n), sum_of(rows%n)
      integer(ip) :: i, n, turn

      has_changed = .false.
      call find_idle(rows, is_sure, group, near, rows%doubt)
      n = size(near, 2, kind=ip)
      if (n == 0 .or. n*count(is_sure) > MOST_EQUATIONS) return
      normals = data%rows%normal
      tangents = data%rows%tangent
      turned = rows
      sum_of = 0.0_wp
      do turn = 1, MOST_TURNS
         call find_angles(data, turned, rows%doubt, is_sure, near, angle)
         has_changed = maxval(abs(angle)) <= LEAST_TURN
         if (has_changed) exit
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
      do i = 1, n                                            ! lines of force that should meet may miss each other as well
         if (.not. has_changed) exit
         call multiply_rows(turned, near(:, i), angle)
         has_changed = maxval(abs(angle), mask=is_sure) <= LEAST_RATE
      end do
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
   end subroutine turn_rows

   !> One step of Newton's method: the least angles, with the changes of the motions; 0 of rows that stay as they are.
   subroutine find_angles(data, rows, doubt, is_sure, near, angle)
      type(scene_data_t), intent(in) :: data
      type(motion_rows_t), intent(in) :: rows       !< G
      real(wp), intent(in) :: doubt(:)              !< (m) of the rows
      logical, intent(in) :: is_sure(:)             !< (m)
      real(wp), intent(in) :: near(:, :)            !< (k, motions) V
      real(wp), intent(out) :: angle(:)             !< (m) [rad]
      real(wp), allocatable :: a(:, :), b(:), x(:)
      integer(ip), allocatable :: list(:), turns(:) ! rows; those of them that may turn
      integer(ip) :: place(rows%n_columns), e, i, k, m, n, t, v, rank, info
      real(wp) :: rate(rows%n)

      list = pack([(i, i=1, rows%n)], is_sure)
      turns = pack(list, [(may_turn(list(i)), i=1, size(list, kind=ip))])
      angle = 0.0_wp
      if (size(turns) == 0) return
      place = unpack([(i, i=1, rows%n_columns)], any(abs(near) > 0.0_wp, dim=2), 0_ip)
      m = size(list, kind=ip)
      n = count(place > 0, kind=ip)
      allocate (a(m*size(near, 2), size(turns) + n*size(near, 2)), source=0.0_wp)
      allocate (b(size(a, 1)), x(size(a, 2)), source=0.0_wp)
      do v = 1, size(near, 2, kind=ip)
         call multiply_rows(rows, near(:, v), rate)
         do i = 1, m
            e = (v - 1)*m + i
            b(e) = -rate(list(i))
            t = findloc(turns, list(i), dim=1, kind=ip)
            associate (j => data%line%point(list(i)))
               if (t > 0) a(e, t) = rate_of_point(data, j, data%rows%tangent(:, j), near(:, v))
            end associate
            do k = rows%first(list(i)), rows%first(list(i) + 1) - 1
               if (place(rows%column(k)) == 0) cycle
               associate (own => a(e, size(turns) + (v - 1)*n + place(rows%column(k))))
                  own = own + rows%value(k)
               end associate
            end do
         end do
      end do
      call least_squares(a, b, x, DEPENDENT, rank, info)
      if (info == 0) angle(turns) = x(:size(turns))

   contains

      pure logical function may_turn(i)
         integer(ip), intent(in) :: i

         associate (j => data%line%point(i))
            may_turn = doubt(i) > 0.0_wp .and. data%line%normal(j) == i .and. data%line%law(j)%kind == FRICTION_NONE &
                       .and. .not. any(data%rows%is_held(:, j))
         end associate
      end function may_turn

   end subroutine find_angles

end module atrito_digit_turns
