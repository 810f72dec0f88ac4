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
   use atrito_mesh_sides, only: mesh_sides_t, chains_t
   implicit none (type, external)
   private
   public :: equilibrate_sides, side_length, traction_of

contains

   !> Changes the tractions that are not known so that they are in equilibrium with all elements.
   !>
   !> residual: what (1) is off by where all is known, over the largest force.
   subroutine equilibrate_sides(mesh, sides, chains, force, known, traction, residual)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      type(chains_t), intent(in) :: chains
      real(wp), intent(in) :: force(:, :, :)        !< (2, nodes, n_elements) R_E [F]
      logical, intent(in) :: known(:, :)            !< (2, sides) by component
      real(wp), intent(inout) :: traction(:, 0:, :) !< (2, 0:k, sides) Bernstein coefficients on the first element [F/L]
      real(wp), intent(out) :: residual
      real(wp), allocatable :: b(:, :, :)           !< (2, ends and middle, sides) moments on the first element
      real(wp), allocatable :: length(:), run(:), sign_of(:), weight(:) !< of all sides [L]; of one chain
      integer(ip), allocatable :: ends(:)
      real(wp) :: worst
      integer(ip) :: i, k, n_terms

      n_terms = size(traction, 2, kind=ip)
      allocate (b(2, n_terms, sides%n), length(sides%n))
      do i = 1, sides%n
         length(i) = side_length(mesh, sides, i)
         b(:, :, i) = moments_of(traction(:, :, i), length(i))
         if (n_terms < 3) cycle
         if (sides%middle(i) == 0) then             ! a side of two nodes beside others of three: linear functions
            b(:, :2, i) = b(:, :2, i) + 0.5_wp*spread(b(:, 3, i), 2, 2)
         else
            associate (e => sides%element(1, i))
               k = findloc(mesh%nodes(:mesh%shape(e), e), sides%middle(i), dim=1, kind=ip)
               where (.not. known(:, i)) b(:, 3, i) = force(:, k, e)
            end associate
         end if
      end do
      worst = 0.0_wp
      associate (most => maxval(chains%first(2:chains%n + 1) - chains%first(:chains%n)))
         allocate (run(0:most), sign_of(0:most), weight(0:most), ends(0:most))
      end associate
      do i = 1, chains%n
         associate (first => chains%first(i), last => chains%first(i + 1) - 1)
            call go_round(chains%node(i), last - first + 1, chains%element(first:last), chains%corner(first:last), &
                          chains%side(first + i - 1:last + i))
         end associate
      end do
      residual = worst/max(maxval(abs(force)), tiny(worst))
      do i = 1, sides%n
         if (n_terms < 3 .or. sides%middle(i) > 0) then
            traction(:, :, i) = traction_of(b(:, :, i), length(i), n_terms - 1)
         else if (.not. all(known(:, i))) then      ! a side of two nodes beside others of three
            traction(:, ::2, i) = traction_of(b(:, :2, i), length(i), 1_ip)
            traction(:, 1, i) = 0.5_wp*(traction(:, 0, i) + traction(:, 2, i))
         end if
      end do

   contains

      !> The moments round one node, (2).
      subroutine go_round(node, n, element, corner, side)
         integer(ip), intent(in) :: node, n         !< n: elements
         integer(ip), intent(in) :: element(:), corner(:), side(0:)
         real(wp) :: b0
         integer(ip) :: j, c, first

         do j = 0, n
            ends(j) = merge(1, 2, sides%node(1, side(j)) == node)
            ! the first element of a side that ends at the node lies before it
            sign_of(j) = merge(-1, 1, ends(j) == 1)
            weight(j) = 1/length(side(j))
         end do
         first = merge(1, 0, side(0) == side(n))
         do c = 1, 2
            run(0) = 0.0_wp
            do j = 1, n
               run(j) = run(j - 1) + force(c, corner(j), element(j))
            end do
            if (first == 1) worst = max(worst, abs(run(n)))
            if (first == 0 .and. known(c, side(0))) then
               b0 = sign_of(0)*b(c, ends(0), side(0))
               if (known(c, side(n))) worst = max(worst, abs(sign_of(n)*b(c, ends(n), side(n)) - b0 - run(n)))
            else if (first == 0 .and. known(c, side(n))) then
               b0 = sign_of(n)*b(c, ends(n), side(n)) - run(n)
            else
               b0 = 0.0_wp
               do j = first, n
                  b0 = b0 + weight(j)*(sign_of(j)*b(c, ends(j), side(j)) - run(j))
               end do
               b0 = b0/sum(weight(first:n))
            end if
            do j = first, n
               if (.not. known(c, side(j))) b(c, ends(j), side(j)) = sign_of(j)*(b0 + run(j))
            end do
         end do
      end subroutine go_round

   end subroutine equilibrate_sides

   !> The length of a straight side [L].
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
