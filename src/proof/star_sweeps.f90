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
   use atrito_mesh_sides, only: mesh_sides_t, chain_t, find_chains, MOST_AROUND
   use atrito_side_tractions, only: MOST_CHAINS
   implicit none (type, external)
   private
   public :: outlines_t, sweep_stars, solve_held

   !> Elements by their outlines: E = a'H a + 2 g'a + c of each, elements of one class with one H.
   type :: outlines_t
      integer(ip) :: degree = 0                     !< k
      integer(ip), allocatable :: class_of(:)       !< (n_elements)
      real(wp), allocatable :: h(:, :, :)           !< (numbers, numbers, classes) [1/F] and so on
      real(wp), allocatable :: a(:, :)              !< (numbers, n_elements)
      real(wp), allocatable :: slope(:, :)          !< (numbers, n_elements) H a + g
   end type outlines_t

   integer(ip), parameter :: MOST_OF_STAR = 3 + 3*(MOST_AROUND + 1)
   real(wp), parameter :: ROUND_OFF = 1.0e-11_wp    !< a pivot below this share of its diagonal is none
   real(wp), parameter :: ALONG_AXIS = 1.0e-10_wp

contains

   !> One sweep over all corners.
   subroutine sweep_stars(mesh, sides, known, outlines, gain)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      logical, intent(in) :: known(:, :)            !< (2, sides)
      type(outlines_t), intent(inout) :: outlines
      real(wp), intent(out) :: gain                 !< what the energy has become less by [F L]
      type(chain_t) :: chains(MOST_CHAINS)
      integer(ip) :: node, k, n

      gain = 0.0_wp
      do node = 1, mesh%n_nodes
         call find_chains(mesh, sides, node, chains, n)
         do k = 1, n
            call improve_star(mesh, sides, known, node, chains(k), outlines, gain)
         end do
      end do
   end subroutine sweep_stars

   !> The least energy over the numbers of one star.
   subroutine improve_star(mesh, sides, known, node, chain, outlines, gain)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      logical, intent(in) :: known(:, :)
      integer(ip), intent(in) :: node
      type(chain_t), intent(in) :: chain
      type(outlines_t), intent(inout) :: outlines
      real(wp), intent(inout) :: gain
      real(wp) :: matrix(MOST_OF_STAR, MOST_OF_STAR), step(MOST_OF_STAR), slope(MOST_OF_STAR), local(9)
      logical :: is_held(MOST_OF_STAR)
      integer(ip) :: n, j, r, s, per_side, at(9), place(9)
      real(wp) :: sign_of(9)

      per_side = 2*outlines%degree - 1
      n = 3 + per_side*(chain%n + merge(0, 1, chain%is_closed))
      call find_held(n, is_held)
      if (all(is_held(:n))) return
      matrix(:n, :n) = 0.0_wp
      step(:n) = 0.0_wp
      do j = 1, chain%n
         call find_places(j)
         associate (e => chain%element(j), h => outlines%h(:, :, outlines%class_of(chain%element(j))))
            do s = 1, 3 + 2*per_side
               step(at(s)) = step(at(s)) - sign_of(s)*outlines%slope(place(s), e)
               do r = 1, 3 + 2*per_side
                  matrix(at(r), at(s)) = matrix(at(r), at(s)) + sign_of(r)*sign_of(s)*h(place(r), place(s))
               end do
            end do
         end associate
      end do
      slope(:n) = step(:n)
      call solve_held(n, is_held, matrix, step)
      gain = gain + dot_product(slope(:n), step(:n))
      do j = 1, chain%n
         call find_places(j)
         associate (e => chain%element(j), h => outlines%h(:, :, outlines%class_of(chain%element(j))))
            do s = 1, 3 + 2*per_side
               local(s) = sign_of(s)*step(at(s))
               outlines%a(place(s), e) = outlines%a(place(s), e) + local(s)
            end do
            do s = 1, 3 + 2*per_side
               if (local(s) == 0.0_wp) cycle
               outlines%slope(:, e) = outlines%slope(:, e) + h(:, place(s))*local(s)
            end do
         end associate
      end do

   contains

      !> Where the numbers of an element stand among those of the star, and their signs: seen from the second element of a side
      !> its normal points the other way, and its coefficients come in the other order.
      subroutine find_places(j)
         integer(ip), intent(in) :: j
         integer(ip) :: m, c, i, n_corners, side
         logical :: is_first

         associate (e => chain%element(j), corner => chain%corner(j), k => outlines%degree)
            n_corners = CORNERS_OF(mesh%shape(e))
            place(:3) = [3*corner - 2, 3*corner - 1, 3*corner]
            at(:3) = [1_ip, 2_ip, 3_ip]
            sign_of = 1.0_wp
            do m = 0, 1
               i = merge(corner, 1 + mod(corner + n_corners - 2, n_corners), m == 0)     ! the side before the element, behind it
               side = j - 1 + m
               if (chain%is_closed .and. side == chain%n) side = 0
               is_first = sides%of_element(i, e) > 0
               do c = 1, per_side
                  associate (l => 3 + m*per_side + c)
                     place(l) = side_place(n_corners, k, i) + c - 1
                     at(l) = 3 + side*per_side + c
                     if (c <= k .and. .not. is_first) then
                        at(l) = 3 + side*per_side + k + 1 - c
                        sign_of(l) = -1.0_wp
                     end if
                  end associate
               end do
            end do
         end associate
      end subroutine find_places

      !> Which numbers known tractions hold at 0.
      subroutine find_held(n, is_held)
         integer(ip), intent(in) :: n
         logical, intent(out) :: is_held(:)
         real(wp) :: t(2)
         integer(ip) :: j, c, first
         logical :: along(2)

         is_held(:n) = .false.
         do j = 0, (n - 3)/per_side - 1
            associate (i => chain%side(j))
               if (.not. any(known(:, i))) cycle
               first = 3 + j*per_side
               t = mesh%x(:, sides%node(2, i)) - mesh%x(:, sides%node(1, i))
               along = abs(t) >= (1.0_wp - ALONG_AXIS)*norm2(t)
               if (all(known(:, i)) .or. .not. any(along)) then
                  is_held(:3) = .true.
                  is_held(first + 1:first + per_side) = .true.
                  cycle
               end if
               c = findloc(known(:, i), .true., dim=1, kind=ip)
               ! T_1 goes with phi,2, and T_2 with phi,1
               is_held(merge(3, 2, c == 1)) = .true.
               if (along(3 - c)) then               ! the component of the gradient that is known is the one along the side
                  is_held(1) = .true.
                  is_held(first + outlines%degree + 1:first + per_side) = .true.
               else
                  is_held(first + 1:first + outlines%degree) = .true.
               end if
            end associate
         end do
         ! a side with known tractions elsewhere holds its other corner alone
      end subroutine find_held

   end subroutine improve_star

   !> matrix step = step by Cholesky; numbers that are held, and those without a pivot, stay 0.
   pure subroutine solve_held(n, is_held, matrix, step)
      integer(ip), intent(in) :: n
      logical, intent(inout) :: is_held(:)
      real(wp), intent(inout) :: matrix(:, :), step(:)
      integer(ip) :: i, j, m, list(n)
      real(wp) :: pivot, original

      m = 0
      do i = 1, n
         if (is_held(i)) then
            step(i) = 0.0_wp
            cycle
         end if
         original = matrix(i, i)
         do j = 1, m                                ! row i of the factor, in its lower triangle
            associate (c => list(j))
               matrix(i, c) = (matrix(i, c) - dot_product(matrix(i, list(:j - 1)), matrix(c, list(:j - 1))))/matrix(c, c)
            end associate
         end do
         pivot = original - sum(matrix(i, list(:m))**2)
         if (.not. pivot > ROUND_OFF*original) then
            is_held(i) = .true.
            step(i) = 0.0_wp
            cycle
         end if
         matrix(i, i) = sqrt(pivot)
         m = m + 1
         list(m) = i
         step(i) = (step(i) - dot_product(matrix(i, list(:m - 1)), step(list(:m - 1))))/matrix(i, i)
      end do
      do j = m, 1, -1
         i = list(j)
         step(i) = step(i)/matrix(i, i)
         step(list(:j - 1)) = step(list(:j - 1)) - matrix(i, list(:j - 1))*step(i)
      end do
   end subroutine solve_held

end module atrito_star_sweeps
