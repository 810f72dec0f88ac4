!> The average S_rho over the points of all contact pairs.
!>
!> It is an average over a slave surface, not over a pair: a bed joint over two blocks is not cut at the joint between
!> them. So the pairs are put into groups whose slaves are parts of one surface, and each point of a group is averaged
!> over all points of it, by the rho and the kernel of its own pair. Where a group has several such laws, W is made once
!> for each over the points of the whole group, and every point takes its row from the W of its own law (part_t). Pairs
!> that look from the same face see different things from one place, a floor and a wall beyond it; the sum of their
!> pressures is nothing that either feels, and each of them is a group of its own.
module atrito_surface_average
   use atrito_average, only: average_t, build_average, count_entries
   use atrito_friction_law, only: KERNEL_POINTS
   use atrito_kinds, only: ip, lp, wp
   use atrito_points, only: contact_points_t
   use atrito_sorting, only: sorted_places
   implicit none (type, external)
   private
   public :: average_rule_t, average_surfaces, count_surface_entries

   !> How the pressure of a pair is averaged.
   type :: average_rule_t
      real(wp) :: rho = 0.0_wp                       !< [L], >= 0
      integer(ip) :: kernel = KERNEL_POINTS          !< KERNEL_*
      integer(ip) :: surface = 0                     !< the same for pairs on one slave surface, >= 0
   end type average_rule_t

   !> The points of the pairs on one slave surface, pair by pair, and the rows of the average that one law makes.
   type :: part_t
      type(average_rule_t) :: rule                   !< the law
      real(wp), allocatable :: x(:, :), length(:)    !< (2, n), (n) [L]
      integer(ip), allocatable :: point(:)           !< (n) their places among the points of all pairs
      integer(ip), allocatable :: start(:)           !< the first point of each pair
      logical, allocatable :: takes(:)               !< (n) this row of w is one of the average
      type(average_t) :: w                           !< of the points of this part
   end type part_t

contains

   !> W over the points of all pairs: P = W p, P_j the mean pressure round point j on its slave surface. W is the
   !> identity where no pair has neighbours within its radius; that is noted, since the law is local then.
   pure subroutine average_surfaces(points, rules, w)
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(average_rule_t), intent(in) :: rules(:)   !< one a pair
      type(average_t), intent(out) :: w             !< (points of all pairs)
      type(part_t) :: parts(size(points))
      integer(ip) :: i, n

      call list_parts(points, rules, parts, n)
      do i = 1, n
         associate (part => parts(i))
            part%w = build_average(part%x, part%length, part%rule%rho, part%rule%kernel, part%start)
         end associate
      end do
      call join_parts(sum(points%n), parts(:n), w)
   end subroutine average_surfaces

   !> How many entries average_surfaces would make, more than `most` only about: every law of a group is counted over
   !> all of its points, though each point takes one row in the end.
   pure integer(lp) function count_surface_entries(points, rules, most) result(entries)
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(average_rule_t), intent(in) :: rules(:)   !< one a pair
      integer(lp), intent(in) :: most               !< beyond which an estimate does
      type(part_t) :: parts(size(points))
      integer(ip) :: i, n

      call list_parts(points, rules, parts, n)
      entries = 0_lp
      do i = 1, n
         entries = entries + count_entries(parts(i)%x, parts(i)%rule%rho, most, parts(i)%start)
      end do
   end function count_surface_entries

   !> The groups of pairs on one surface, each as often as it has laws.
   pure subroutine list_parts(points, rules, parts, n)
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(average_rule_t), intent(in) :: rules(:)  !< one a pair
      type(part_t), intent(out) :: parts(:)          !< the first n are in use
      integer(ip), intent(out) :: n
      logical :: is_last(size(points))
      integer(ip) :: order(size(points)), first, last, i

      call group_pairs(points, rules, order, is_last)
      n = 0
      first = 1
      do last = 1, size(points, kind=ip)
         if (.not. is_last(last)) cycle
         do i = first, last
            if (any(same_law(rules(order(first:i - 1)), rules(order(i))))) cycle
            n = n + 1
            parts(n)%rule = rules(order(i))
            call gather_points(points, order(first:last), same_law(rules(order(first:last)), rules(order(i))), parts(n))
         end do
         first = last + 1
      end do
   end subroutine list_parts

   !> Whether two pairs are averaged by the same radius and kernel.
   elemental logical function same_law(a, b)
      type(average_rule_t), intent(in) :: a, b

      same_law = .not. abs(a%rho - b%rho) > 0.0_wp .and. a%kernel == b%kernel
   end function same_law

   !> The pairs, those that are averaged together one after the other; where such a group ends. The key of a pair is the
   !> number of its surface, and for one that is averaged by itself its own number besides.
   pure subroutine group_pairs(points, rules, order, is_last)
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(average_rule_t), intent(in) :: rules(:)  !< one a pair
      integer(ip), intent(out) :: order(:)           !< (pairs)
      logical, intent(out) :: is_last(:)             !< (pairs) the pair at this place is the last of its group
      logical :: is_alone(size(points))
      integer(lp) :: key(size(points))
      integer(ip) :: i, n

      n = size(points, kind=ip)
      is_alone = look_from_one_face(points, rules%surface)
      key = int(rules%surface, lp)*2_lp*int(n, lp) + merge([(int(i, lp), i=1, n)], 0_lp, is_alone)
      order = sorted_places(key)
      is_last = .true.
      do i = 1, n - 1
         is_last(i) = key(order(i)) /= key(order(i + 1))
      end do
   end subroutine group_pairs

   !> Which pairs have a face in common with another one on the same surface. All faces of all pairs are listed, the
   !> pairs in the order of their surfaces, and sorted by their number: equal faces then follow each other, and of these
   !> equal surfaces.
   pure function look_from_one_face(points, surface) result(is_alone)
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      integer(ip), intent(in) :: surface(:)          !< (pairs)
      logical :: is_alone(size(points))
      integer(lp), allocatable :: face(:)
      integer(ip), allocatable :: pair(:), order(:)
      integer(ip) :: by_surface(size(points)), i, k

      is_alone = .false.
      by_surface = sorted_places(int(surface, lp))
      allocate (face(0), pair(0))
      do i = 1, size(points, kind=ip)
         associate (p => by_surface(i))
            if (.not. allocated(points(p)%faces)) cycle
            face = [face, points(p)%faces]
            pair = [pair, [(p, k=1, size(points(p)%faces, kind=ip))]]
         end associate
      end do
      order = sorted_places(face)
      do i = 2, size(order, kind=ip)
         associate (a => order(i - 1), b => order(i))
            if (face(a) /= face(b) .or. surface(pair(a)) /= surface(pair(b))) cycle
            is_alone(pair([a, b])) = .true.
         end associate
      end do
   end function look_from_one_face

   !> The points of some pairs one after the other; those of the pairs that take part in its law take their rows from it.
   pure subroutine gather_points(points, pairs, takes, part)
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      integer(ip), intent(in) :: pairs(:)           !< of one group
      logical, intent(in) :: takes(:)                !< (pairs)
      type(part_t), intent(inout) :: part           !< empty; out: all but w
      integer(ip) :: i, k, n

      n = sum(points(pairs)%n)
      allocate (part%x(2, n), part%length(n), part%point(n), part%takes(n), part%start(size(pairs)))
      n = 0
      do i = 1, size(pairs, kind=ip)
         associate (one => points(pairs(i)), last => n + points(pairs(i))%n)
            part%start(i) = n + 1
            part%x(:, n + 1:last) = one%x(:, :one%n)
            part%length(n + 1:last) = one%length(:one%n)
            part%point(n + 1:last) = sum(points(:pairs(i) - 1)%n) + [(k, k=1, one%n)]
            part%takes(n + 1:last) = takes(i)
            n = last
         end associate
      end do
   end subroutine gather_points

   !> The rows of all parts, their columns numbered by the points of all pairs; each point has one row, from the part that takes it.
   pure subroutine join_parts(n, parts, w)
      integer(ip), intent(in) :: n                   !< points of all pairs
      type(part_t), intent(in) :: parts(:)          !< with their w
      type(average_t), intent(out) :: w             !< (points of all pairs)
      integer(ip) :: i, j, k

      w%n = n
      allocate (w%first(n + 1))
      do i = 1, size(parts, kind=ip)
         w%is_identity = w%is_identity .and. parts(i)%w%is_identity
         do j = 1, parts(i)%w%n
            if (parts(i)%takes(j)) w%first(parts(i)%point(j) + 1) = parts(i)%w%first(j + 1) - parts(i)%w%first(j)
         end do
      end do
      w%first(1) = 1
      do j = 1, n
         w%first(j + 1) = w%first(j) + w%first(j + 1)
      end do
      allocate (w%column(w%first(n + 1) - 1), w%value(w%first(n + 1) - 1))
      do i = 1, size(parts, kind=ip)
         do j = 1, parts(i)%w%n
            if (.not. parts(i)%takes(j)) cycle
            associate (to => w%first(parts(i)%point(j)), from => parts(i)%w%first(j), &
                       last => parts(i)%w%first(j + 1) - 1)
               do k = from, last
                  w%column(to + k - from) = parts(i)%point(parts(i)%w%column(k))
                  w%value(to + k - from) = parts(i)%w%value(k)
               end do
            end associate
         end do
      end do
   end subroutine join_parts

end module atrito_surface_average
