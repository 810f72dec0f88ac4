!> The average S_rho over the points of all contact pairs. It is an average over a slave surface: pairs whose slaves are parts of
!> one surface are averaged together, each point by the law of its own pair. Pairs that look from the same face are not parts of
!> one surface but two, and each of them is averaged by itself.
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
      integer(ip) :: kernel = KERNEL_POINTS
      integer(ip) :: surface = 0                     !< the same for pairs on one slave surface, >= 0
   end type average_rule_t

   !> The points of the pairs on one slave surface, pair by pair, and the rows of the average that one law makes.
   type :: part_t
      real(wp), allocatable :: x(:, :), length(:)    !< (2, n), (n) [L]
      integer(ip), allocatable :: point(:)           !< (n) their places among the points of all pairs
      integer(ip), allocatable :: start(:)           !< the first point of each pair
      logical, allocatable :: takes(:)               !< (n) this row of w is one of the average
      type(average_t) :: w
   end type part_t

contains

   !> W over the points of all pairs.
   pure subroutine average_surfaces(points, rules, w)
      type(contact_points_t), intent(in) :: points(:)
      type(average_rule_t), intent(in) :: rules(:)   !< one a pair
      type(average_t), intent(out) :: w
      type(part_t) :: parts(size(points))
      logical :: is_last(size(points))
      integer(ip) :: order(size(points)), before(size(points)), first, last, i, k, n_parts

      call group_pairs(points, rules, order, is_last)
      before = points_before(points)
      n_parts = 0
      first = 1
      do last = 1, size(points, kind=ip)
         if (.not. is_last(last)) cycle
         associate (pairs => order(first:last))
            do i = 1, size(pairs, kind=ip)
               if (any([(same_law(rules(pairs(i)), rules(pairs(k))), k=1, i - 1)])) cycle
               n_parts = n_parts + 1
               call gather_points(points, before, pairs, parts(n_parts))
               call choose_rows(points, rules, pairs, i, parts(n_parts))
               parts(n_parts)%w = build_average(parts(n_parts)%x, parts(n_parts)%length, rules(pairs(i))%rho, &
                                                rules(pairs(i))%kernel, parts(n_parts)%start)
            end do
         end associate
         first = last + 1
      end do
      call join_parts(sum(points%n), parts(:n_parts), w)
   end subroutine average_surfaces

   !> How many entries average_surfaces would make, more than `most` only about.
   pure integer(lp) function count_surface_entries(points, rules, most) result(entries)
      type(contact_points_t), intent(in) :: points(:)
      type(average_rule_t), intent(in) :: rules(:)
      integer(lp), intent(in) :: most
      type(part_t) :: part
      logical :: is_last(size(points))
      integer(ip) :: order(size(points)), before(size(points)), first, last, i, k

      call group_pairs(points, rules, order, is_last)
      before = points_before(points)
      entries = 0_lp
      first = 1
      do last = 1, size(points, kind=ip)
         if (.not. is_last(last)) cycle
         associate (pairs => order(first:last))
            call gather_points(points, before, pairs, part)
            do i = 1, size(pairs, kind=ip)
               if (any([(same_law(rules(pairs(i)), rules(pairs(k))), k=1, i - 1)])) cycle
               entries = entries + count_entries(part%x, rules(pairs(i))%rho, most, part%start)
            end do
         end associate
         first = last + 1
      end do
   end function count_surface_entries

   pure logical function same_law(a, b)
      type(average_rule_t), intent(in) :: a, b

      same_law = .not. abs(a%rho - b%rho) > 0.0_wp .and. a%kernel == b%kernel
   end function same_law

   !> The pairs, those that are averaged together one after the other; where such a group ends.
   pure subroutine group_pairs(points, rules, order, is_last)
      type(contact_points_t), intent(in) :: points(:)
      type(average_rule_t), intent(in) :: rules(:)
      integer(ip), intent(out) :: order(:)           !< (pairs)
      logical, intent(out) :: is_last(:)             !< (pairs) the pair at this place is the last of its group
      logical :: is_alone(size(points))
      integer(lp) :: key(size(points))
      integer(ip) :: i, n

      n = size(points, kind=ip)
      is_alone = look_from_one_face(points, rules%surface)
      do i = 1, n
         key(i) = int(rules(i)%surface, lp)*2_lp*int(n, lp)
         if (is_alone(i)) key(i) = key(i) + int(i, lp)
      end do
      order = sorted_places(key)
      is_last = .true.
      do i = 1, n - 1
         is_last(i) = key(order(i)) /= key(order(i + 1))
      end do
   end subroutine group_pairs

   !> Which pairs have a face in common with another one on the same surface.
   pure function look_from_one_face(points, surface) result(is_alone)
      type(contact_points_t), intent(in) :: points(:)
      integer(ip), intent(in) :: surface(:)
      logical :: is_alone(size(points))
      integer(lp), allocatable :: face(:)
      integer(ip), allocatable :: pair(:), order(:)
      integer(ip) :: by_surface(size(points)), i, k, n

      is_alone = .false.
      by_surface = sorted_places(int(surface, lp))
      n = 0
      do i = 1, size(points, kind=ip)
         if (allocated(points(i)%faces)) n = n + size(points(i)%faces, kind=ip)
      end do
      allocate (face(n), pair(n))
      n = 0
      do i = 1, size(points, kind=ip)
         associate (p => by_surface(i))
            if (.not. allocated(points(p)%faces)) cycle
            k = n + size(points(p)%faces, kind=ip)
            face(n + 1:k) = points(p)%faces
            pair(n + 1:k) = p
            n = k
         end associate
      end do
      ! equal faces follow each other, and of these equal surfaces
      order = sorted_places(face)
      do i = 2, n
         associate (a => order(i - 1), b => order(i))
            if (face(a) /= face(b) .or. surface(pair(a)) /= surface(pair(b))) cycle
            is_alone(pair([a, b])) = .true.
         end associate
      end do
   end function look_from_one_face

   !> The points of the pairs before each of them.
   pure function points_before(points) result(before)
      type(contact_points_t), intent(in) :: points(:)
      integer(ip) :: before(size(points)), i

      before = 0
      do i = 2, size(points, kind=ip)
         before(i) = before(i - 1) + points(i - 1)%n
      end do
   end function points_before

   pure subroutine gather_points(points, before, pairs, part)
      type(contact_points_t), intent(in) :: points(:)
      integer(ip), intent(in) :: before(:), pairs(:)
      type(part_t), intent(out) :: part
      integer(ip) :: i, k, n

      n = sum(points(pairs)%n)
      allocate (part%x(2, n), part%length(n), part%point(n), part%start(size(pairs)))
      n = 0
      do i = 1, size(pairs, kind=ip)
         associate (one => points(pairs(i)))
            part%start(i) = n + 1
            part%x(:, n + 1:n + one%n) = one%x(:, :one%n)
            part%length(n + 1:n + one%n) = one%length(:one%n)
            part%point(n + 1:n + one%n) = [(before(pairs(i)) + k, k=1, one%n)]
            n = n + one%n
         end associate
      end do
   end subroutine gather_points

   !> The points of the pairs with the law of the i-th.
   pure subroutine choose_rows(points, rules, pairs, i, part)
      type(contact_points_t), intent(in) :: points(:)
      type(average_rule_t), intent(in) :: rules(:)
      integer(ip), intent(in) :: pairs(:), i
      type(part_t), intent(inout) :: part
      integer(ip) :: k

      allocate (part%takes(size(part%point)))
      do k = 1, size(pairs, kind=ip)
         part%takes(part%start(k):part%start(k) + points(pairs(k))%n - 1) = same_law(rules(pairs(k)), rules(pairs(i)))
      end do
   end subroutine choose_rows

   !> The rows of all parts; each point has one.
   pure subroutine join_parts(n, parts, w)
      integer(ip), intent(in) :: n                   !< points of all pairs
      type(part_t), intent(in) :: parts(:)
      type(average_t), intent(out) :: w
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
      allocate (w%column(w%first(n + 1) - 1), w%entry(w%first(n + 1) - 1))
      do i = 1, size(parts, kind=ip)
         do j = 1, parts(i)%w%n
            if (.not. parts(i)%takes(j)) cycle
            associate (to => w%first(parts(i)%point(j)), from => parts(i)%w%first(j), &
                       last => parts(i)%w%first(j + 1) - 1)
               do k = from, last
                  w%column(to + k - from) = parts(i)%point(parts(i)%w%column(k))
                  w%entry(to + k - from) = parts(i)%w%entry(k)
               end do
            end associate
         end do
      end do
   end subroutine join_parts

end module atrito_surface_average
