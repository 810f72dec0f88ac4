!> Displacements by which contact sides do not overlap between their points.
module atrito_sides_apart
   use atrito_contact_tractions, only: segment_t, between, overlap_at, value_at, SAME_DIRECTION
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: keep_apart

contains

   !> Moves nodes back along the normal, so that nowhere u_n - s is larger than delta p.
   !>
   !> The softer side moves, which costs the least, unless supports hold it. Where delta > 0 and supports hold both, overlaps stay,
   !> since they are paid for in (2).
   !>
   !> why_not: supports that do not let the sides move apart, or sides that push one another together.
   subroutine keep_apart(segments, held, u, why_not)
      type(segment_t), intent(in) :: segments(:)
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      real(wp), intent(inout) :: u(:, :)            !< (2, n_nodes) [L]
      character(len=:), allocatable, intent(inout) :: why_not
      integer, parameter :: MOST_ROUNDS = 4         !< what one pair moves, another one may overlap by
      real(wp), parameter :: ROUND_OFF = 1.0e-13_wp
      real(wp), allocatable :: back(:)
      real(wp) :: none, beyond, at
      integer(ip) :: first, last
      integer :: round
      logical :: has_moved

      none = ROUND_OFF*maxval(abs(u))
      allocate (back(size(u, 2)), source=0.0_wp)
      do round = 1, MOST_ROUNDS
         has_moved = .false.
         last = 0
         do while (last < size(segments))
            first = last + 1
            do last = first, size(segments, kind=ip) - 1
               if (segments(last + 1)%pair /= segments(first)%pair) exit
            end do
            call part_pair(segments(first:last), held, none, u, back, has_moved, why_not)
            if (allocated(why_not)) return
         end do
         if (.not. has_moved) return
      end do
      do first = 1, size(segments, kind=ip)
         if (segments(first)%delta > 0.0_wp) cycle
         call find_overlap(segments(first), u, back, beyond, at)
         if (beyond > none) why_not = 'sides that cannot be moved apart'
      end do
   end subroutine keep_apart

   !> One pair. Corners move, and middle nodes by the mean of theirs, so that the motion is linear along a face; where an overlap v
   !> at the place s of a face is left, its corners move by v (1 - s) and v s over (1 - s)^2 + s^2 more, the least that is enough.
   subroutine part_pair(segments, held, none, u, back, has_moved, why_not)
      type(segment_t), intent(in) :: segments(:)
      logical, intent(in) :: held(:, :)
      real(wp), intent(in) :: none                  !< overlaps that are round-off [L]
      real(wp), intent(inout) :: u(:, :)
      real(wp), intent(inout) :: back(:)            !< (n_nodes) 0, in and out [L]
      logical, intent(inout) :: has_moved
      character(len=:), allocatable, intent(inout) :: why_not
      integer, parameter :: MOST_PASSES = 40
      integer(ip) :: i
      integer :: pass
      real(wp) :: beyond, at
      logical :: is_apart

      do pass = 1, MOST_PASSES
         is_apart = .true.
         do i = 1, size(segments, kind=ip)
            call find_overlap(segments(i), u, back, beyond, at)
            if (.not. beyond > none) cycle
            is_apart = .false.
            if (.not. raises(segments(i), segments(i)%master_is_softer)) then
               if (raises(segments(i),.not. segments(i)%master_is_softer)) cycle
               if (segments(i)%delta > 0.0_wp) cycle
               why_not = 'a support keeps contact sides from moving apart'
               return
            end if
         end do
         if (is_apart) exit
      end do
      do i = 1, size(segments, kind=ip)
         associate (s => segments(i))
            if (s%n == 3) back(s%node(3)) = 0.5_wp*sum(back(s%node(:2)))
            if (s%n_master == 3) back(s%master_node(3)) = 0.5_wp*sum(back(s%master_node(:2)))
         end associate
      end do
      do i = 1, size(segments, kind=ip)
         call move(segments(i)%node(:segments(i)%n), -segments(i)%normal)
         call move(segments(i)%master_node(:segments(i)%n_master), segments(i)%normal)
      end do

   contains

      !> Moves the corners of one side more; false: supports hold them.
      logical function raises(segment, of_master)
         type(segment_t), intent(in) :: segment
         logical, intent(in) :: of_master
         real(wp), parameter :: LITTLE = 0.05_wp    !< of a face's length: as near to a corner that is held nothing can be done
         real(wp) :: weight(2), s
         integer(ip) :: corner(2), k

         raises = .false.
         if (of_master .and. segment%n_master == 0) return
         corner = merge(segment%master_node(:2), segment%node(:2), of_master)
         s = between(merge(segment%on_master, segment%on_slave, of_master), at)
         weight = [1 - s, s]
         do k = 1, 2
            if (any(held(:, corner(k)) .and. abs(segment%normal) > SAME_DIRECTION)) weight(k) = 0.0_wp
         end do
         raises = maxval(weight) > LITTLE
         if (raises) back(corner) = back(corner) + beyond*weight/dot_product(weight, weight)
      end function raises

      subroutine move(nodes, direction)
         integer(ip), intent(in) :: nodes(:)
         real(wp), intent(in) :: direction(2)
         integer(ip) :: k

         do k = 1, size(nodes, kind=ip)
            if (.not. back(nodes(k)) > 0.0_wp) cycle
            u(:, nodes(k)) = u(:, nodes(k)) + back(nodes(k))*direction
            back(nodes(k)) = 0.0_wp
            has_moved = .true.
         end do
      end subroutine move

   end subroutine part_pair

   !> The largest of u_n - s - delta p on a segment whose corners move back besides, and where it is.
   pure subroutine find_overlap(segment, u, back, most, at)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :), back(:)
      real(wp), intent(out) :: most                 !< [L]
      real(wp), intent(out) :: at                   !< 0 to 1 along the segment
      real(wp) :: v(3), bend, t, place
      integer :: k

      do k = 1, 3
         t = 0.5_wp*(k - 1)
         place = between(segment%on_slave, t)
         v(k) = overlap_at(segment, u, t) - segment%delta*between(segment%p, t) - between(back(segment%node(:2)), place)
         if (segment%n_master > 0) v(k) = v(k) - between(back(segment%master_node(:2)), between(segment%on_master, t))
      end do
      k = maxloc(v, dim=1)
      most = v(k)
      at = 0.5_wp*(k - 1)
      bend = 4*(v(1) - 2*v(2) + v(3))
      if (.not. bend < 0.0_wp) return
      t = -(-3*v(1) + 4*v(2) - v(3))/bend
      if (.not. (t > 0.0_wp .and. t < 1.0_wp)) return
      if (.not. value_at(v, t) > most) return
      most = value_at(v, t)
      at = t
   end subroutine find_overlap

end module atrito_sides_apart
