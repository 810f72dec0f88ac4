!> Places of contact, where corners of the triangles on both sides face one another.
module atrito_misfit_places
   use atrito_assembly, only: fem_t
   use atrito_contact_segments, only: between, segment_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_law_lack, only: law_t, laws_at, NO_LIMIT
   use atrito_sorting, only: sorted_places
   use atrito_strip_mesh, only: make_strip, strip_t
   implicit none (type, external)
   private
   public :: place_t, strip_places_t, list_places, jump_at, part_count, part_ends

   !> A place of both sides, with its laws along the normal and along T.
   type :: place_t
      integer(ip) :: vertex(2) = 0                  !< of the slave, of the master; 0: rigid
      integer(ip) :: segment = 0
      real(wp) :: weight = 0.0_wp                   !< [L^2]
      type(law_t) :: law(2)
   end type place_t

   !> The strip behind the sides, and where their places are: what does not depend on tractions and displacements.
   type :: strip_places_t
      type(strip_t) :: strip
      integer(ip), allocatable :: vertex(:, :)      !< (2, places) as those of place_t
      integer(ip), allocatable :: at(:, :)          !< (2, parts) places at the ends of each part; not allocated: not made yet
   end type strip_places_t

contains

   !> Parts that a segment is cut into, w being linear on each: overlaps are linear where both faces have two nodes.
   pure integer(ip) function part_count(segment)
      type(segment_t), intent(in) :: segment

      part_count = 1
      if (max(segment%n, segment%n_master) > 2) part_count = 2
   end function part_count

   !> Both ends of a part, 0 to 1 along the segment.
   pure function part_ends(segment, k) result(ends)
      type(segment_t), intent(in) :: segment
      integer(ip), intent(in) :: k
      real(wp) :: ends(2)

      ends = [real(wp) :: k - 1, k]/part_count(segment)
   end function part_ends

   !> The places of contact with their laws.
   subroutine list_places(fem, held, segments, u, behind, places)
      type(fem_t), intent(in) :: fem
      logical, intent(in) :: held(:, :)
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(in) :: u(:, :)
      type(strip_places_t), intent(inout) :: behind !< that of sides which are cut so, or nothing yet
      type(place_t), allocatable, intent(out) :: places(:)
      integer(ip) :: i

      if (.not. allocated(behind%at)) call make_places(fem, held, segments, behind)
      allocate (places(size(behind%vertex, 2)))
      do i = 1, size(places, kind=ip)
         places(i)%vertex = behind%vertex(:, i)
      end do
      call take_laws(segments, u, behind%at, places)
   end subroutine list_places

   !> The strip behind the sides, and the places of its contact: each pair of corners once.
   subroutine make_places(fem, held, segments, behind)
      type(fem_t), intent(in) :: fem
      logical, intent(in) :: held(:, :)
      type(segment_t), intent(in) :: segments(:)
      type(strip_places_t), intent(out) :: behind
      integer(ip), allocatable :: element(:), face(:), vertex(:, :, :), order(:)
      real(wp), allocatable :: place(:)
      integer(lp), allocatable :: key(:)
      integer(ip) :: i, k, n, m, n_parts, side
      real(wp) :: ends(2)

      n_parts = 0
      do i = 1, size(segments, kind=ip)
         n_parts = n_parts + part_count(segments(i))
      end do
      allocate (element(4*n_parts), face(4*n_parts), place(4*n_parts), vertex(2, 2, n_parts))
      m = 0
      do i = 1, size(segments, kind=ip)             ! both ends of the slave's parts, then those of the master
         do k = 1, part_count(segments(i))
            ends = part_ends(segments(i), k)
            do side = 1, 2
               if (side == 2 .and. segments(i)%master(1) == 0) cycle
               associate (of_face => merge(segments(i)%slave, segments(i)%master, side == 1), &
                          along => merge(segments(i)%on_slave, segments(i)%on_master, side == 1))
                  element(m + 1:m + 2) = of_face(1)
                  face(m + 1:m + 2) = of_face(2)
                  place(m + 1:m + 2) = [between(along, ends(1)), between(along, ends(2))]
               end associate
               m = m + 2
            end do
         end do
      end do
      block
         integer(ip) :: of_ends(m)

         call make_strip(fem, held, element(:m), face(:m), place(:m), behind%strip, of_ends)
         vertex = 0
         m = 0
         n = 0
         do i = 1, size(segments, kind=ip)
            do k = 1, part_count(segments(i))
               n = n + 1
               do side = 1, merge(1, 2, segments(i)%master(1) == 0)
                  vertex(side, :, n) = of_ends(m + 1:m + 2)
                  m = m + 2
               end do
            end do
         end do
      end block
      key = reshape(int(vertex(1, :, :), lp)*(behind%strip%n + 1_lp) + vertex(2, :, :), [2*n_parts])
      order = sorted_places(key)
      allocate (behind%vertex(2, 2*n_parts), behind%at(2, n_parts))
      n = 0
      do i = 1, 2*n_parts
         associate (part => (order(i) + 1)/2, end_of => 2 - mod(order(i), 2_ip))
            if (i == 1) then
               n = 1
            else if (key(order(i)) /= key(order(i - 1))) then
               n = n + 1
            end if
            behind%vertex(:, n) = vertex(:, end_of, part)
            behind%at(end_of, part) = n
         end associate
      end do
      behind%vertex = behind%vertex(:, :n)
   end subroutine make_places

   !> The laws of the parts as those of their ends, with half of the length for each. Without delta w must make up for overlaps
   !> between the ends, too.
   subroutine take_laws(segments, u, at, places)
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: at(:, :)
      type(place_t), intent(inout) :: places(:)
      type(law_t) :: law(2, 3)
      integer(ip) :: i, k, n, j, d
      real(wp) :: weight, rise, ends(2)

      do n = 1, size(places, kind=ip)
         places(n)%law(1)%y = -NO_LIMIT
      end do
      n = 0
      do i = 1, size(segments, kind=ip)
         do k = 1, part_count(segments(i))
            n = n + 1
            ends = part_ends(segments(i), k)
            do j = 1, 3
               law(:, j) = laws_at(segments(i), u, between(ends, 0.5_wp*(j - 1)), [real(wp) :: 0, 0])
            end do
            rise = max(0.0_wp, law(1, 2)%y - 0.5_wp*(law(1, 1)%y + law(1, 3)%y))
            weight = 0.5_wp*segments(i)%length*segments(i)%thickness/part_count(segments(i))
            do j = 1, 2
               associate (place => places(at(j, n)), end_of => law(:, 2*j - 1))
                  place%segment = i
                  place%law(1)%y = max(place%law(1)%y, end_of(1)%y + rise)
                  place%law(2)%y = new_mean(place%law(2)%y, end_of(2)%y)
                  place%law(1)%most = NO_LIMIT
                  place%law(2)%most = new_mean(place%law(2)%most, (2*law(2, 2)%most + end_of(2)%most)/3)
                  do d = 1, 2
                     place%law(d)%least = new_mean(place%law(d)%least, (2*law(d, 2)%least + end_of(d)%least)/3)
                     place%law(d)%compliance = new_mean(place%law(d)%compliance, law(d, 2)%compliance)
                  end do
                  place%weight = place%weight + weight
               end associate
            end do
         end do
      end do

   contains

      !> The mean so far and what is added to it.
      real(wp) function new_mean(before, more)
         real(wp), intent(in) :: before, more

         new_mean = before
         associate (place => places(at(j, n)))
            if (weight > 0.0_wp) new_mean = before + (more - before)*weight/(place%weight + weight)
         end associate
      end function new_mean

   end subroutine take_laws

   !> How far w moves the sides of a place apart, along the normal and along T.
   pure function jump_at(segment, place, w) result(jump)
      type(segment_t), intent(in) :: segment
      type(place_t), intent(in) :: place
      real(wp), intent(in) :: w(:, :)
      real(wp) :: jump(2), d(2)

      d = w(:, place%vertex(1))
      if (place%vertex(2) > 0) d = d - w(:, place%vertex(2))
      associate (n => segment%normal)
         jump = [dot_product(n, d), n(1)*d(2) - n(2)*d(1)]
      end associate
   end function jump_at

end module atrito_misfit_places
