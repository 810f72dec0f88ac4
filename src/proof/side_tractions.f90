!> Tractions along the sides of elements that are in equilibrium with every element.
!>
!> The nodal forces of a finite element solution, R_E = K_E u_E - f_E, are in equilibrium element by element, and they add up to the
!> loads at every node. Tractions with the moments of R_E,
!>
!>     sum over the sides G of E at node i of  int_G T N_i ds = R_E,i      for every element and node,                        (1)
!>
!> are in equilibrium with E, too, forces and moments, since the shape functions N_i along the sides add up to 1 and to x
!> (Ladeveze). At a middle node (1) has one side alone. At a corner the elements follow one another round the node, and the moment
!> b_j at the side behind the j-th of them, taken on that element, is
!>
!>     b_j = b_0 + sum over the first j elements of R,                                                                      (2)
!>
!> one free number a chain and direction. It is known where the chain begins or ends at a side with known traction; else the moments
!> come as near to those of the averaged stress as they can, weighted by 1/length.
module atrito_side_tractions
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_mesh_sides, only: mesh_sides_t, chain_t, find_chains
   implicit none (type, external)
   private
   public :: equilibrate_sides, side_length, traction_of, MOST_CHAINS

   integer(ip), parameter :: MOST_CHAINS = 8        !< through one node

contains

   !> Changes the tractions that are not known so that they are in equilibrium with all elements.
   !>
   !> residual: what (1) is off by where all is known, over the largest force.
   subroutine equilibrate_sides(mesh, sides, force, known, traction, residual)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      real(wp), intent(in) :: force(:, :, :)        !< (2, nodes, n_elements) R_E [F]
      logical, intent(in) :: known(:, :)            !< (2, sides) by component
      real(wp), intent(inout) :: traction(:, 0:, :) !< (2, 0:k, sides) Bernstein coefficients on the first element [F/L]
      real(wp), intent(out) :: residual
      real(wp) :: moment(2, 2)
      real(wp), allocatable :: b(:, :, :)           !< (2, ends and middle, sides) moments on the first element
      integer(ip) :: i, node, n, k
      type(chain_t) :: chains(MOST_CHAINS)
      real(wp) :: worst

      allocate (b(2, size(traction, 2) + 1, sides%n))
      do i = 1, sides%n
         b(:, :, i) = moments_of(traction(:, :, i), side_length(mesh, sides, i))
         if (sides%middle(i) == 0 .or. size(traction, 2) < 3) cycle
         associate (e => sides%element(1, i))
            k = findloc(mesh%nodes(:mesh%shape(e), e), sides%middle(i), dim=1, kind=ip)
            where (.not. known(:, i)) b(:, 3, i) = force(:, k, e)
         end associate
      end do
      worst = 0.0_wp
      do node = 1, mesh%n_nodes
         call find_chains(mesh, sides, node, chains, n)
         do k = 1, n
            call go_round(chains(k))
         end do
      end do
      residual = worst/max(maxval(abs(force)), tiny(worst))
      do i = 1, sides%n
         moment = b(:, :2, i)
         traction(:, :, i) = traction_of(b(:, :, i), side_length(mesh, sides, i), size(traction, 2, kind=ip) - 1)
      end do

   contains

      !> The moments round one node, (2).
      subroutine go_round(chain)
         type(chain_t), intent(in) :: chain
         real(wp) :: run(0:chain%n), b0, weight, sum_w
         integer(ip) :: j, c, first

         first = merge(1_ip, 0_ip, chain%is_closed)
         do c = 1, 2
            run(0) = 0.0_wp
            do j = 1, chain%n
               run(j) = run(j - 1) + force(c, chain%corner(j), chain%element(j))
            end do
            if (chain%is_closed) worst = max(worst, abs(run(chain%n)))
            if (.not. chain%is_closed .and. known(c, chain%side(0))) then
               b0 = on_element_before(chain, 0_ip, c)
               if (known(c, chain%side(chain%n))) worst = max(worst, abs(on_element_before(chain, chain%n, c) - b0 - run(chain%n)))
            else if (.not. chain%is_closed .and. known(c, chain%side(chain%n))) then
               b0 = on_element_before(chain, chain%n, c) - run(chain%n)
            else
               b0 = 0.0_wp
               sum_w = 0.0_wp
               do j = first, chain%n
                  weight = 1/side_length(mesh, sides, chain%side(j))
                  b0 = b0 + weight*(on_element_before(chain, j, c) - run(j))
                  sum_w = sum_w + weight
               end do
               b0 = b0/sum_w
            end if
            do j = 0, chain%n
               if (known(c, chain%side(j))) cycle
               associate (i => chain%side(j))
                  b(c, merge(1, 2, sides%node(1, i) == node), i) = sign_before(chain, j)*(b0 + run(j))
               end associate
            end do
         end do
      end subroutine go_round

      !> The moment at the j-th side of a chain, on the element before it.
      real(wp) function on_element_before(chain, j, c)
         type(chain_t), intent(in) :: chain
         integer(ip), intent(in) :: j, c

         associate (i => chain%side(j))
            on_element_before = sign_before(chain, j)*b(c, merge(1, 2, sides%node(1, i) == node), i)
         end associate
      end function on_element_before

      !> 1 where the element before the j-th side is the first one of the side: the side ends at the node then.
      real(wp) function sign_before(chain, j)
         type(chain_t), intent(in) :: chain
         integer(ip), intent(in) :: j

         sign_before = merge(1.0_wp, -1.0_wp, sides%node(2, chain%side(j)) == node)
      end function sign_before

   end subroutine equilibrate_sides

   pure real(wp) function side_length(mesh, sides, i)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      integer(ip), intent(in) :: i

      side_length = norm2(mesh%x(:, sides%node(2, i)) - mesh%x(:, sides%node(1, i)))
   end function side_length

   !> int T N_i ds: at the ends, and of three coefficients at the middle.
   pure function moments_of(traction, length) result(b)
      real(wp), intent(in) :: traction(:, 0:)       !< (2, 0:k) Bernstein coefficients
      real(wp), intent(in) :: length
      real(wp) :: b(2, size(traction, 2))
      real(wp) :: middle(2)

      if (size(traction, 2) == 2) then
         b(:, 1) = length/6*(2*traction(:, 0) + traction(:, 1))
         b(:, 2) = length/6*(traction(:, 0) + 2*traction(:, 1))
      else
         middle = 0.25_wp*(traction(:, 0) + 2*traction(:, 1) + traction(:, 2))
         b(:, 1) = length/30*(4*traction(:, 0) - traction(:, 2) + 2*middle)
         b(:, 2) = length/30*(4*traction(:, 2) - traction(:, 0) + 2*middle)
         b(:, 3) = length/30*(2*traction(:, 0) + 2*traction(:, 2) + 16*middle)
      end if
   end function moments_of

   !> The Bernstein coefficients with these moments.
   pure function traction_of(b, length, degree) result(traction)
      real(wp), intent(in) :: b(:, :)               !< (2, degree + 1)
      real(wp), intent(in) :: length
      integer(ip), intent(in) :: degree
      real(wp) :: traction(2, 0:degree)
      real(wp) :: middle(2)

      if (degree == 1) then
         traction(:, 0) = 2/length*(2*b(:, 1) - b(:, 2))
         traction(:, 1) = 2/length*(2*b(:, 2) - b(:, 1))
      else
         ! inverse of [4 -1 2; -1 4 2; 2 2 16]/30
         traction(:, 0) = (9*b(:, 1) + 3*b(:, 2) - 1.5_wp*b(:, 3))/length
         traction(:, 2) = (9*b(:, 2) + 3*b(:, 1) - 1.5_wp*b(:, 3))/length
         middle = (-1.5_wp*b(:, 1) - 1.5_wp*b(:, 2) + 2.25_wp*b(:, 3))/length
         traction(:, 1) = 2*middle - 0.5_wp*(traction(:, 0) + traction(:, 2))
      end if
   end function traction_of

end module atrito_side_tractions
