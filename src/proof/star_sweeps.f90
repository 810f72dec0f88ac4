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
   use atrito_airy_stress, only: side_place
   use atrito_element_table, only: CORNERS_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_mesh_sides, only: mesh_sides_t, chains_t
   implicit none (type, external)
   private
   public :: outlines_t, sweep_stars, solve_least

   !> Elements by their outlines: E = a'H a + 2 g'a + c of each, elements of one class with one H.
   type :: outlines_t
      integer(ip) :: degree = 0                     !< k
      integer(ip), allocatable :: class_of(:)       !< (n_elements)
      real(wp), allocatable :: h(:, :, :)           !< (numbers, numbers, classes) [1/F] and so on
      real(wp), allocatable :: a(:, :)              !< (numbers, n_elements)
      real(wp), allocatable :: slope(:, :)          !< (numbers, n_elements) H a + g
      real(wp), allocatable :: energy(:)            !< (n_elements) E [F L]
   end type outlines_t

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
      integer(ip) :: i

      gain = 0.0_wp
      do i = 1, chains%n
         associate (first => chains%first(i), last => chains%first(i + 1) - 1)
            call improve_star(mesh, sides, known, last - first + 1, chains%element(first:last), chains%corner(first:last), &
                              chains%side(first + i - 1:last + i), outlines, gain)
         end associate
      end do
   end subroutine sweep_stars

   !> The least energy over the numbers of one star.
   !>
   !> With y the free numbers of the star, placed into those of its elements by P_e (zeros and signs), the sum of the energies is
   !> sum_e (a_e + P_e y)'H_e (a_e + P_e y) + 2 g_e'(a_e + P_e y) + c_e. It is least at
   !>
   !>     (sum_e P_e'H_e P_e) y = -sum_e P_e'(H_e a_e + g_e)
   !>
   !> and is less there by y' times the right-hand side. H_e a_e + g_e (slope) is kept for each element and moved with it, so a star
   !> costs the product of some small matrices, whatever the mesh. The order of the system is 3 + (2k - 1) times the sides that meet
   !> at the corner, 15 with k = 2 in a grid of quadrilaterals.
   subroutine improve_star(mesh, sides, known, n_elements, element, corner, side, outlines, gain)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      logical, intent(in) :: known(:, :)
      integer(ip), intent(in) :: n_elements, element(:), corner(:), side(0:) !< a chain
      type(outlines_t), intent(inout) :: outlines
      real(wp), intent(inout) :: gain
      integer(ip) :: n, j, r, s, per_side, m, n_free
      integer(ip) :: place(9, n_elements)           ! of its numbers among those of the element
      integer(ip) :: at(9, n_elements)              ! the same among the free ones of the star; 0: held
      real(wp) :: sign_of(9, n_elements)
      logical :: is_held(3*n_elements + 6)
      real(wp) :: matrix(3*n_elements + 6, 3*n_elements + 6), step(3*n_elements + 6), slope(3*n_elements + 6)
      integer(ip) :: free(3*n_elements + 6)

      per_side = 2*outlines%degree - 1
      m = 3 + 2*per_side
      n = 3 + per_side*(n_elements + merge(0, 1, side(0) == side(n_elements)))
      call find_held(mesh, sides, known, side, outlines%degree, is_held(:n))
      n_free = 0
      do j = 1, n
         free(j) = 0
         if (is_held(j)) cycle
         n_free = n_free + 1
         free(j) = n_free
      end do
      if (n_free == 0) return
      matrix(:n_free, :n_free) = 0.0_wp
      step(:n_free) = 0.0_wp
      do j = 1, n_elements
         call find_places(j)
         associate (h => outlines%h(:, :, outlines%class_of(element(j))), of_element => outlines%slope(:, element(j)))
            do s = 1, m
               if (at(s, j) == 0) cycle
               step(at(s, j)) = step(at(s, j)) - sign_of(s, j)*of_element(place(s, j))
               do r = 1, m
                  if (at(r, j) < at(s, j)) cycle    ! the lower triangle
                  matrix(at(r, j), at(s, j)) = matrix(at(r, j), at(s, j)) + sign_of(r, j)*sign_of(s, j)*h(place(r, j), place(s, j))
               end do
            end do
         end associate
      end do
      slope(:n_free) = step(:n_free)
      call solve_least(n_free, matrix, step)
      gain = gain + dot_product(slope(:n_free), step(:n_free))
      do j = 1, n_elements
         call move_outline(m, place(:, j), at(:, j), sign_of(:, j), step, element(j), outlines)
      end do

   contains

      !> Where the numbers of an element stand among those of the star, and their signs: seen from the second element of a side
      !> its normal points the other way, and its coefficients come in the other order.
      subroutine find_places(j)
         integer(ip), intent(in) :: j
         integer(ip) :: l, c, i, n_corners, of_star
         logical :: is_first

         associate (e => element(j), k => outlines%degree)
            n_corners = CORNERS_OF(mesh%shape(e))
            do l = 1, 3
               place(l, j) = 3*corner(j) - 3 + l
               at(l, j) = free(l)
               sign_of(l, j) = 1.0_wp
            end do
            do l = 0, 1                             ! the side before the element, and the one behind it
               i = corner(j)
               if (l == 1) i = merge(n_corners, i - 1, i == 1)
               of_star = j - 1 + l
               if (of_star == n_elements .and. side(0) == side(n_elements)) of_star = 0
               is_first = sides%of_element(i, e) > 0
               do c = 1, per_side
                  associate (at_l => 3 + l*per_side + c)
                     place(at_l, j) = side_place(n_corners, k, i) + c - 1
                     if (c <= k .and. .not. is_first) then
                        at(at_l, j) = free(3 + of_star*per_side + k + 1 - c)
                        sign_of(at_l, j) = -1.0_wp
                     else
                        at(at_l, j) = free(3 + of_star*per_side + c)
                        sign_of(at_l, j) = 1.0_wp
                     end if
                  end associate
               end do
            end do
         end associate
      end subroutine find_places

   end subroutine improve_star

   !> The step of a star in the numbers of one element. E changes by the step times the slopes before and behind it.
   subroutine move_outline(m, place, at, sign_of, step, e, outlines)
      integer(ip), intent(in) :: m                  !< numbers of the star in the element
      integer(ip), intent(in) :: place(:), at(:)    !< among those of the element, among the free ones of the star; 0: held
      real(wp), intent(in) :: sign_of(:), step(:)
      integer(ip), intent(in) :: e
      type(outlines_t), intent(inout) :: outlines
      real(wp) :: of_number(9), change
      integer(ip) :: s

      associate (h => outlines%h(:, :, outlines%class_of(e)), slope => outlines%slope(:, e))
         change = 0.0_wp
         do s = 1, m
            of_number(s) = 0.0_wp
            if (at(s) > 0) of_number(s) = sign_of(s)*step(at(s))
            change = change + of_number(s)*slope(place(s))
         end do
         do s = 1, m
            if (at(s) == 0) cycle
            outlines%a(place(s), e) = outlines%a(place(s), e) + of_number(s)
            slope = slope + h(:, place(s))*of_number(s)
         end do
         do s = 1, m
            change = change + of_number(s)*slope(place(s))
         end do
      end associate
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
   !>
   !> n_more: so many numbers behind them stay 0, too; their part of the matrix, and of step, becomes what is left without the first
   !> ones: x'S x/2 - r'x is the least that the whole has.
   pure subroutine solve_least(n, matrix, step, n_more)
      integer(ip), intent(in) :: n
      real(wp), intent(inout) :: matrix(:, :), step(:)
      integer(ip), intent(in), optional :: n_more
      real(wp) :: original
      integer(ip) :: i, j, k, last

      last = n
      if (present(n_more)) last = n + n_more
      do j = 1, n
         original = matrix(j, j)
         do k = 1, j - 1
            matrix(j, j) = matrix(j, j) - matrix(j, k)**2
         end do
         if (.not. matrix(j, j) > ROUND_OFF*original) then
            matrix(j:last, j) = 0.0_wp
            step(j) = 0.0_wp
            cycle
         end if
         matrix(j, j) = sqrt(matrix(j, j))
         do k = 1, j - 1
            matrix(j + 1:last, j) = matrix(j + 1:last, j) - matrix(j, k)*matrix(j + 1:last, k)
         end do
         matrix(j + 1:last, j) = matrix(j + 1:last, j)/matrix(j, j)
         step(j) = step(j)/matrix(j, j)
         step(j + 1:last) = step(j + 1:last) - matrix(j + 1:last, j)*step(j)
      end do
      do j = n + 1, last
         do k = 1, n
            matrix(j:last, j) = matrix(j:last, j) - matrix(j, k)*matrix(j:last, k)
         end do
      end do
      do j = n, 1, -1
         if (.not. matrix(j, j) > 0.0_wp) cycle
         do i = j + 1, n
            step(j) = step(j) - matrix(i, j)*step(i)
         end do
         step(j) = step(j)/matrix(j, j)
      end do
   end subroutine solve_least

end module atrito_star_sweeps
