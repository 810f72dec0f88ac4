!> Better stresses in equilibrium: sweeps over the corners of a mesh.
!>
!> Airy functions that are 0, with their gradients, outside of the elements round a corner (its star) change the stress there and
!> leave it in equilibrium. Of their numbers, phi and its gradient at the corner and the inner numbers of the sides that meet there,
!> those are chosen for which the energy of the star is least: a small system a corner, one corner after the other (Gauss and
!> Seidel). So the sum of the energies can only fall. Known tractions stay as they are.
!>
!> What leaves the traction T = (d(phi,2)/ds, -d(phi,1)/ds) of a side as it is: both components known, phi = 0 with its gradient;
!> one of them on a side along an axis, the component of the gradient that belongs to it is 0. Sides in other directions with one
!> component known are held altogether, which costs a little of the bound.
module atrito_star_sweeps
   use atrito_airy_stress, only: side_place, MOST_OUTLINE
   use atrito_element_table, only: CORNERS_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_mesh_sides, only: mesh_sides_t, chains_t
   use atrito_packed_energies, only: outlines_t, take_columns
   implicit none (type, external)
   private
   public :: sweep_stars, solve_least

   !> The system of a star. It depends on the shapes of its elements alone: in a regular mesh the next star has the same one.
   type :: star_t
      integer(ip) :: n = 0, n_free = 0              !< numbers, and those that are free
      integer(ip) :: n_elements = 0                 !< there is room for more, as for more numbers
      integer(ip), allocatable :: class_of(:), corner(:) !< (elements)
      logical, allocatable :: is_first(:, :)        !< (2, elements) of the side before it and of the one behind it
      logical, allocatable :: is_held(:)            !< (n)
      integer(ip), allocatable :: place(:, :)       !< (m, elements) of its numbers among those of the element
      integer(ip), allocatable :: at(:, :)          !< the same among the free ones of the star; 0: held
      real(wp), allocatable :: sign_of(:, :)
      real(wp), allocatable :: factor(:, :)         !< (n_free, n_free)
      real(wp), allocatable :: h(:, :, :)           !< (numbers, numbers, elements) of outlines, columns of its own numbers
      real(wp), allocatable :: z(:, :, :)           !< (numbers, 3, elements) by which rows 1 to 3 follow, where corner /= 1
      real(wp), allocatable :: slope(:), step(:)    !< (n_free)
      logical, allocatable :: looks_first(:, :), looks_held(:) !< as is_first and is_held, of the star that is asked for
   end type star_t

   real(wp), parameter :: ROUND_OFF = 1.0e-11_wp    !< a pivot below this share of its diagonal is none
   real(wp), parameter :: ALONG_AXIS = 1.0e-10_wp

contains

   !> One sweep over all corners.
   subroutine sweep_stars(mesh, sides, chains, known, outlines, gain)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      type(chains_t), intent(in) :: chains
      logical, intent(in) :: known(:, :)            !< (2, sides)
      type(outlines_t), intent(inout) :: outlines
      real(wp), intent(out) :: gain                 !< what the energy has become less by [F L]
      type(star_t) :: star
      integer(ip) :: i, m, j, s

      gain = 0.0_wp
      ! Room for the largest star.
      associate (most => maxval(chains%first(2:chains%n + 1) - chains%first(:chains%n)))
         m = 3 + 2*(2*outlines%degree - 1)
         associate (n => 3 + (2*outlines%degree - 1)*(most + 1), numbers => size(outlines%a, 1))
            allocate (star%class_of(most), star%corner(most), star%is_first(2, most), star%is_held(n), star%place(m, most), &
                      star%at(m, most), star%sign_of(m, most), star%factor(n, n))
            allocate (star%h(numbers, numbers, most), star%z(numbers, 3, most), source=0.0_wp)
            allocate (star%slope(n), star%step(n), star%looks_first(2, most), star%looks_held(n))
         end associate
      end associate
      do i = 1, chains%n
         associate (first => chains%first(i), last => chains%first(i + 1) - 1)
            call take_star(mesh, sides, known, chains%element(first:last), chains%corner(first:last), &
                           chains%side(first + i - 1:last + i), outlines, star)
            if (star%n_free > 0) then
               ! The least energy over the numbers of one star.
               !
               ! With y the free numbers of the star, placed into those of its elements by P_e (zeros and signs), the sum of the
               ! energies is sum_e (a_e + P_e y)'H_e (a_e + P_e y) + 2 g_e'(a_e + P_e y) + c_e. It is least at
               !
               !     (sum_e P_e'H_e P_e) y = -sum_e P_e'(H_e a_e + g_e)
               !
               ! and is less there by y' times the right-hand side. H_e a_e + g_e (slope) is kept for each element and moved
               ! with it, so a star costs the product of some small matrices, whatever the mesh. The order of the system is
               ! 3 + (2k - 1) times the sides that meet at the corner, 15 with k = 2 in a grid of quadrilaterals.
               associate (element => chains%element(first:last))
                  star%slope(:star%n_free) = 0.0_wp
                  do j = 1, size(element, kind=ip)
                     do s = 1, size(star%at, 1, kind=ip)
                        associate (k => star%at(s, j), e => outlines%place(element(j)))
                           if (k > 0) star%slope(k) = star%slope(k) - star%sign_of(s, j)*outlines%slope(star%place(s, j), e)
                        end associate
                     end do
                  end do
                  star%step(:star%n_free) = star%slope(:star%n_free)
                  call solve_factored(star%n_free, star%factor, star%step)
                  gain = gain + dot_product(star%slope(:star%n_free), star%step(:star%n_free))
                  do j = 1, size(element, kind=ip)
                     call move_outline(star, j, outlines%place(element(j)), outlines)
                  end do
               end associate
            end if
         end associate
      end do
   end subroutine sweep_stars

   !> The system of a star, if it is not the one that is there.
   subroutine take_star(mesh, sides, known, element, corner, side, outlines, star)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      logical, intent(in) :: known(:, :)
      integer(ip), intent(in) :: element(:), corner(:), side(0:) !< a chain
      type(outlines_t), intent(in) :: outlines
      type(star_t), intent(inout) :: star
      integer(ip) :: n, j, per_side, n_elements
      logical :: is_same

      n_elements = size(element, kind=ip)
      per_side = 2*outlines%degree - 1
      n = 3 + per_side*(n_elements + merge(0, 1, side(0) == side(n_elements)))
      call find_held(mesh, sides, known, side, outlines%degree, star%looks_held(:n))
      do j = 1, n_elements
         star%looks_first(1, j) = sides%of_element(corner(j), element(j)) > 0
         star%looks_first(2, j) = sides%of_element(corner_before(mesh, element(j), corner(j)), element(j)) > 0
      end do
      is_same = star%n == n .and. star%n_elements == n_elements
      do j = 1, n_elements
         if (.not. is_same) exit
         is_same = star%class_of(j) == outlines%class_of(outlines%place(element(j))) .and. star%corner(j) == corner(j) .and. &
                   all(star%is_first(:, j) .eqv. star%looks_first(:, j))
      end do
      if (is_same) is_same = all(star%is_held(:n) .eqv. star%looks_held(:n))
      if (is_same) return
      star%n = n
      star%n_elements = n_elements
      star%class_of(:n_elements) = outlines%class_of(outlines%place(element))
      star%corner(:n_elements) = corner
      star%is_first(:, :n_elements) = star%looks_first(:, :n_elements)
      star%is_held(:n) = star%looks_held(:n)
      call make_star(mesh, element, side(0) == side(n_elements), outlines, star)
   end subroutine take_star

   !> Where the numbers of a star stand in its elements, and the factor of its system.
   subroutine make_star(mesh, element, is_round, outlines, star)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element(:)
      logical, intent(in) :: is_round               !< the chain has no ends
      type(outlines_t), intent(in) :: outlines
      type(star_t), intent(inout) :: star           !< with what it is known by
      integer(ip) :: j, m, r, s, free(star%n)

      m = size(star%place, 1, kind=ip)
      star%n_free = 0
      do j = 1, star%n
         free(j) = 0
         if (star%is_held(j)) cycle
         star%n_free = star%n_free + 1
         free(j) = star%n_free
      end do
      star%factor(:star%n_free, :star%n_free) = 0.0_wp
      do j = 1, size(element, kind=ip)
         call find_places(j)
         if (star%corner(j) == 1) then
            call take_columns(mesh, outlines, element(j), star%h(:, :, j), star%z(:, :, j))
         else
            call take_columns(mesh, outlines, element(j), star%h(:, :, j), star%z(:, :, j), star%place(:, j))
         end if
         associate (h => star%h(:, :, j), at => star%at(:, j), place => star%place(:, j), sign_of => star%sign_of(:, j))
            do s = 1, m
               if (at(s) == 0) cycle
               do r = 1, m
                  if (at(r) < at(s)) cycle          ! the lower triangle
                  star%factor(at(r), at(s)) = star%factor(at(r), at(s)) + sign_of(r)*sign_of(s)*h(place(r), place(s))
               end do
            end do
         end associate
      end do
      call factor_least(star%n_free, star%factor)

   contains

      !> Where the numbers of an element stand among those of the star, and their signs: seen from the second element of a side
      !> its normal points the other way, and its coefficients come in the other order.
      subroutine find_places(j)
         integer(ip), intent(in) :: j
         integer(ip) :: l, c, i, of_star, per_side

         associate (k => outlines%degree)
            per_side = 2*k - 1
            do l = 1, 3
               star%place(l, j) = 3*star%corner(j) - 3 + l
               star%at(l, j) = free(l)
               star%sign_of(l, j) = 1.0_wp
            end do
            do l = 0, 1                             ! the side before the element, and the one behind it
               i = star%corner(j)
               if (l == 1) i = corner_before(mesh, element(j), i)
               of_star = j - 1 + l
               if (of_star == size(element) .and. is_round) of_star = 0
               do c = 1, per_side
                  associate (at_l => 3 + l*per_side + c)
                     star%place(at_l, j) = side_place(CORNERS_OF(mesh%shape(element(j))), k, i) + c - 1
                     if (c <= k .and. .not. star%is_first(1 + l, j)) then
                        star%at(at_l, j) = free(3 + of_star*per_side + k + 1 - c)
                        star%sign_of(at_l, j) = -1.0_wp
                     else
                        star%at(at_l, j) = free(3 + of_star*per_side + c)
                        star%sign_of(at_l, j) = 1.0_wp
                     end if
                  end associate
               end do
            end do
         end associate
      end subroutine find_places

   end subroutine make_star

   pure integer(ip) function corner_before(mesh, e, corner)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e, corner

      corner_before = merge(CORNERS_OF(mesh%shape(e)), corner - 1, corner == 1)
   end function corner_before

   !> The step of a star in the numbers of its element j. E changes by the step times the slopes before and behind it.
   pure subroutine move_outline(star, j, e, outlines)
      type(star_t), intent(in) :: star
      integer(ip), intent(in) :: j
      integer(ip), intent(in) :: e                  !< its place
      type(outlines_t), intent(inout) :: outlines
      real(wp) :: of_number, slope(MOST_OUTLINE), change
      integer(ip) :: s, n, i

      n = size(star%h, 1, kind=ip)
      slope = 0.0_wp
      change = 0.0_wp
      do s = 1, size(star%at, 1, kind=ip)
         if (star%at(s, j) == 0) cycle
         of_number = star%sign_of(s, j)*star%step(star%at(s, j))
         associate (place => star%place(s, j))
            outlines%a(place, e) = outlines%a(place, e) + of_number
            change = change + 2*of_number*outlines%slope(place, e)
            do i = 1, n
               slope(i) = slope(i) + star%h(i, place, j)*of_number
            end do
         end associate
      end do
      if (star%corner(j) > 1 .and. star%z(1, 1, j) > 0.0_wp) then
         slope(:3) = 0.0_wp
         do i = 4, n
            slope(1) = slope(1) - star%z(i, 1, j)*slope(i)
            slope(2) = slope(2) - star%z(i, 2, j)*slope(i)
            slope(3) = slope(3) - star%z(i, 3, j)*slope(i)
         end do
      end if
      do s = 1, size(star%at, 1, kind=ip)
         if (star%at(s, j) > 0) change = change + star%sign_of(s, j)*star%step(star%at(s, j))*slope(star%place(s, j))
      end do
      outlines%slope(:, e) = outlines%slope(:, e) + slope(:n)
      outlines%energy(e) = outlines%energy(e) + change
   end subroutine move_outline

   !> Which numbers known tractions hold at 0.
   subroutine find_held(mesh, sides, known, side, degree, is_held)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      logical, intent(in) :: known(:, :)
      integer(ip), intent(in) :: side(0:)           !< of a chain
      integer(ip), intent(in) :: degree             !< k
      logical, intent(out) :: is_held(:)
      real(wp) :: t(2)
      integer(ip) :: j, c, first, per_side, last
      logical :: along(2)

      is_held = .false.
      last = ubound(side, 1, kind=ip)
      per_side = 2*degree - 1
      if (side(0) == side(last)) return    ! within a body nothing is known
      do j = 0, last, last
         associate (i => side(j))
            if (.not. any(known(:, i))) cycle
            first = 3 + j*per_side
            t = mesh%x(:, sides%node(2, i)) - mesh%x(:, sides%node(1, i))
            along = abs(t) >= (1.0_wp - ALONG_AXIS)*norm2(t)
            if (all(known(:, i)) .or. .not. any(along)) then
               is_held(:3) = .true.
               is_held(first + 1:first + per_side) = .true.
               cycle
            end if
            c = merge(1, 2, known(1, i))
            ! T_1 goes with phi,2, and T_2 with phi,1
            is_held(merge(3, 2, c == 1)) = .true.
            if (along(3 - c)) then               ! the component of the gradient that is known is the one along the side
               is_held(1) = .true.
               is_held(first + degree + 1:first + per_side) = .true.
            else
               is_held(first + 1:first + degree) = .true.
            end if
         end associate
      end do
   end subroutine find_held

   !> matrix step = step by Cholesky, of the lower triangle; numbers without a pivot stay 0.
   pure subroutine solve_least(n, matrix, step, n_more)
      integer(ip), intent(in) :: n
      real(wp), intent(inout) :: matrix(:, :), step(:)
      integer(ip), intent(in), optional :: n_more

      call factor_least(n, matrix, n_more)
      call solve_factored(n, matrix, step, n_more)
   end subroutine solve_least

   !> The lower triangle by Cholesky; numbers without a pivot have columns of 0.
   !>
   !> n_more: so many numbers behind them stay 0, too; their part of the matrix, and of step, becomes what is left without the first
   !> ones: x'S x/2 - r'x is the least that the whole has.
   pure subroutine factor_least(n, matrix, n_more)
      integer(ip), intent(in) :: n
      real(wp), intent(inout) :: matrix(:, :)
      integer(ip), intent(in), optional :: n_more
      real(wp) :: original
      integer(ip) :: j, k, last

      last = n
      if (present(n_more)) last = n + n_more
      do j = 1, n
         original = matrix(j, j)
         do k = 1, j - 1
            matrix(j, j) = matrix(j, j) - matrix(j, k)**2
         end do
         if (.not. matrix(j, j) > ROUND_OFF*original) then
            matrix(j:last, j) = 0.0_wp
            cycle
         end if
         matrix(j, j) = sqrt(matrix(j, j))
         do k = 1, j - 1
            matrix(j + 1:last, j) = matrix(j + 1:last, j) - matrix(j, k)*matrix(j + 1:last, k)
         end do
         matrix(j + 1:last, j) = matrix(j + 1:last, j)/matrix(j, j)
      end do
      do j = n + 1, last
         do k = 1, n
            matrix(j:last, j) = matrix(j:last, j) - matrix(j, k)*matrix(j:last, k)
         end do
      end do
   end subroutine factor_least

   pure subroutine solve_factored(n, matrix, step, n_more)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: matrix(:, :)          !< of factor_least
      real(wp), intent(inout) :: step(:)
      integer(ip), intent(in), optional :: n_more
      integer(ip) :: i, j, last

      last = n
      if (present(n_more)) last = n + n_more
      do j = 1, n
         if (.not. matrix(j, j) > 0.0_wp) then
            step(j) = 0.0_wp
            cycle
         end if
         step(j) = step(j)/matrix(j, j)
         step(j + 1:last) = step(j + 1:last) - matrix(j + 1:last, j)*step(j)
      end do
      do j = n, 1, -1
         if (.not. matrix(j, j) > 0.0_wp) cycle
         do i = j + 1, n
            step(j) = step(j) - matrix(i, j)*step(i)
         end do
         step(j) = step(j)/matrix(j, j)
      end do
   end subroutine solve_factored

end module atrito_star_sweeps
