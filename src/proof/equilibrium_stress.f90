!> Stresses in equilibrium with tractions along all sides, and their distance from the stresses of displacements.
module atrito_equilibrium_stress
   use atrito_airy_stress, only: outline_of_tractions
   use atrito_assembly, only: fem_t
   use atrito_cut_elements, only: side_cuts_t, cut_difference, is_cut
   use atrito_element_classes, only: element_classes_t, given_of
   use atrito_element_energy, only: element_energy_t, energy_difference, given_rows, make_energy, volume_tractions, MOST_GIVEN
   use atrito_element_table, only: CORNERS_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh_sides, only: chains_t, mesh_sides_t
   use atrito_proof_loads, only: proof_loads_t
   use atrito_star_sweeps, only: outlines_t, sweep_stars
   implicit none (type, external)
   private
   public :: sum_stresses

   integer, parameter :: MOST_SWEEPS = 12
   real(wp), parameter :: FEW_DIGITS = 1.0e-9_wp
   real(wp), parameter :: LITTLE = 0.1_wp           !< of the energy: a sweep that gained less is the last one

contains

   !> The squares of the distance, element by element, behind as many sweeps as are worth it.
   subroutine sum_stresses(fem, classes, sides, chains, loads, u, cuts, share, residual)
      type(fem_t), intent(in) :: fem
      type(element_classes_t), intent(in) :: classes
      type(mesh_sides_t), intent(in) :: sides
      type(chains_t), intent(in) :: chains
      type(proof_loads_t), intent(in) :: loads      !< with tractions that are in equilibrium; sweeps leave what is known as it is
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(side_cuts_t), intent(in) :: cuts         !< sides whose tractions are polynomials by parts
      real(wp), intent(out) :: share(:)             !< (n_elements) [F L]
      real(wp), intent(inout) :: residual           !< of the equilibrium; >= what outlines are open by, over the largest force
      type(outlines_t) :: outlines
      integer(ip), allocatable :: cut(:)            ! elements
      integer(ip) :: degree, most, c
      real(wp) :: gain, left, open, most_open, largest
      real(wp) :: of_stresses                       ! energy of those of the displacements
      integer :: sweep

      degree = ubound(loads%traction, 2, kind=ip)
      outlines%degree = degree
      outlines%class_of = classes%of_element
      most = maxval(outline_size(fem%mesh%shape(:fem%mesh%n_elements), degree))
      cut = pack([(c, c=1, fem%mesh%n_elements)], [(is_cut(cuts, sides, c), c=1, fem%mesh%n_elements)])
      allocate (outlines%h(most, most, classes%n + size(cut)), outlines%a(most, size(share)), outlines%slope(most, size(share)), &
                outlines%energy(size(share)), source=0.0_wp)
      of_stresses = 0.0_wp
      most_open = 0.0_wp
      largest = 0.0_wp
      do c = 1, classes%n
         call begin_class(c)
      end do
      residual = max(residual, most_open/max(largest, tiny(open)))
      do c = 1, size(cut, kind=ip)
         call begin_cut(cut(c), classes%n + c)
      end do
      left = sum(outlines%energy)
      do sweep = 1, MOST_SWEEPS
         call sweep_stars(fem%mesh, sides, chains, loads%known, outlines, gain)
         left = left - gain
         if (.not. gain > LITTLE*left) exit
      end do
      share = outlines%energy
      ! sums of squares point by point where the difference of large numbers would be round-off
      call sum_again(fem, classes, sides, cuts, loads, u, outlines, sum(share) <= FEW_DIGITS*of_stresses, share)

   contains

      !> Outlines and slopes of the energy of the elements of a class, and their energies.
      subroutine begin_class(c)
         integer(ip), intent(in) :: c
         type(element_energy_t) :: energy
         real(wp) :: x(MOST_GIVEN), of_sides(2, 0:degree, 4)
         real(wp), allocatable :: rows(:)
         integer(ip) :: i, n_given, j

         call make_energy(fem, classes%member(classes%first(c)), degree, energy)
         outlines%h(:energy%n, :energy%n, c) = energy%slopes(:, :energy%n)
         allocate (rows(energy%n_rows))
         do i = classes%first(c), classes%first(c + 1) - 1
            associate (e => classes%member(i), n => energy%n, corners => energy%macro%n)
               call given_of(fem, e, u, x, n_given)
               x(n_given + 1:n_given + 2) = loads%volume(:, e)
               do j = 1, corners
                  associate (side => sides%of_element(j, e), at => energy%macro%corner)
                     if (side > 0) then
                        of_sides(:, :, j) = loads%traction(:, :, side)
                     else
                        of_sides(:, :, j) = -loads%traction(:, degree:0:-1, -side)
                     end if
                     if (any(loads%volume(:, e) /= 0.0_wp)) then
                        associate (next => at(:, 1 + mod(j, corners)))
                           of_sides(:, :, j) = of_sides(:, :, j) + volume_tractions(loads%volume(:, e), at(:, j), next, degree)
                        end associate
                     end if
                  end associate
               end do
               call outline_of_tractions(energy%macro%corner(:, :corners), of_sides(:, :, :corners), outlines%a(:n, e), open)
               most_open = max(most_open, open)
               largest = max(largest, maxval(abs(outlines%a(2:3*corners:3, e))), maxval(abs(outlines%a(3:3*corners:3, e))))
               call given_rows(energy, x(:energy%n_given), rows)
               do j = 1, energy%n_given
                  outlines%slope(:n, e) = outlines%slope(:n, e) + energy%slopes(:, n + j)*x(j)
               end do
               outlines%energy(e) = dot_product(rows, rows) + dot_product(outlines%a(:n, e), outlines%slope(:n, e))
               of_stresses = of_stresses + dot_product(rows, rows)
               do j = 1, n
                  outlines%slope(:n, e) = outlines%slope(:n, e) + energy%slopes(:, j)*outlines%a(j, e)
               end do
               outlines%energy(e) = outlines%energy(e) + dot_product(outlines%a(:n, e), outlines%slope(:n, e))
            end associate
         end do
      end subroutine begin_class

      !> An element that is cut has an energy of its own, and so a class.
      subroutine begin_cut(e, class)
         integer(ip), intent(in) :: e, class
         real(wp) :: x(MOST_GIVEN)
         integer(ip) :: n_given

         associate (n => outline_size(fem%mesh%shape(e), degree))
            call given_of(fem, e, u, x, n_given)
            x(n_given + 1:n_given + 2) = loads%volume(:, e)
            outlines%class_of(e) = class
            call cut_difference(fem, sides, cuts, e, x(:n_given + 2), outlines%a(:n, e), outlines%energy(e), &
                                outlines%h(:n, :n, class), outlines%slope(:n, e))
         end associate
      end subroutine begin_cut

   end subroutine sum_stresses

   !> Numbers of the outline of an element.
   pure elemental integer(ip) function outline_size(shape, degree)
      integer(ip), intent(in) :: shape
      integer(ip), intent(in) :: degree             !< k

      outline_size = CORNERS_OF(shape)*(2*degree + 2)
   end function outline_size

   !> The energies of elements that are cut, or of all, by their stresses.
   subroutine sum_again(fem, classes, sides, cuts, loads, u, outlines, is_all, share)
      type(fem_t), intent(in) :: fem
      type(element_classes_t), intent(in) :: classes
      type(mesh_sides_t), intent(in) :: sides
      type(side_cuts_t), intent(in) :: cuts
      type(proof_loads_t), intent(in) :: loads
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(outlines_t), intent(in) :: outlines
      logical, intent(in) :: is_all
      real(wp), intent(inout) :: share(:)           !< (n_elements) [F L]
      type(element_energy_t) :: energy
      real(wp) :: x(MOST_GIVEN)
      integer(ip) :: c, i, n_given
      logical :: is_made

      do c = 1, classes%n
         is_made = .false.
         do i = classes%first(c), classes%first(c + 1) - 1
            associate (e => classes%member(i))
               if (.not. (is_all .or. is_cut(cuts, sides, e))) cycle
               call given_of(fem, e, u, x, n_given)
               x(n_given + 1:n_given + 2) = loads%volume(:, e)
               if (is_cut(cuts, sides, e)) then
                  call cut_difference(fem, sides, cuts, e, x(:n_given + 2), &
                                      outlines%a(:outline_size(fem%mesh%shape(e), outlines%degree), e), share(e))
               else
                  if (.not. is_made) call make_energy(fem, e, outlines%degree, energy)
                  is_made = .true.
                  share(e) = energy_difference(energy, x(:n_given + 2), outlines%a(:energy%n, e))
               end if
            end associate
         end do
      end do

   end subroutine sum_again

end module atrito_equilibrium_stress
