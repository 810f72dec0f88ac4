!> Stresses in equilibrium with tractions along all sides, and their distance from the stresses of displacements.
module atrito_equilibrium_stress
   use atrito_airy_stress, only: outline_of_tractions, volume_tractions, MOST_OUTLINE
   use atrito_assembly, only: fem_t
   use atrito_cut_elements, only: side_cuts_t, cut_difference, is_cut
   use atrito_element_classes, only: element_classes_t, given_of
   use atrito_element_energy, only: element_energy_t, energy_difference, make_energy, MOST_GIVEN
   use atrito_element_table, only: CORNERS_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh_sides, only: chains_t, mesh_sides_t
   use atrito_packed_energies, only: outlines_t, pack_energy, packed_size
   use atrito_proof_loads, only: proof_loads_t
   use atrito_star_sweeps, only: sweep_stars
   implicit none (type, external)
   private
   public :: sum_stresses, sum_again

   integer, parameter :: MOST_SWEEPS = 12
   real(wp), parameter :: FEW_DIGITS = 1.0e-9_wp
   !> Of the energy: a sweep that gained less is the last one. The one behind it gains a fifteenth of what it did, or so.
   real(wp), parameter :: LITTLE = 0.1_wp, LITTLE_OF_LARGE = 1.0_wp
   integer(ip), parameter :: LARGE = 4000           !< elements of a scene whose sweeps take time
   real(wp), parameter :: NOTHING = 1.0e-13_wp      !< of the energy of the stresses: round-off

contains

   !> The squares of the distance, element by element, behind as many sweeps as are worth it.
   subroutine sum_stresses(fem, classes, sides, chains, loads, u, cuts, outlines, residual)
      type(fem_t), intent(in) :: fem
      type(element_classes_t), intent(in) :: classes
      type(mesh_sides_t), intent(in) :: sides
      type(chains_t), intent(in) :: chains
      type(proof_loads_t), intent(in) :: loads      !< with tractions that are in equilibrium; sweeps leave what is known as it is
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(side_cuts_t), intent(in) :: cuts         !< sides whose tractions are polynomials by parts
      type(outlines_t), intent(out) :: outlines     !< of the stresses; < 0 where an element has too many cuts: its energy
      real(wp), intent(inout) :: residual           !< of the equilibrium; >= what outlines are open by, over the largest force
      integer(ip), allocatable :: cut(:)            ! elements
      type(element_energy_t) :: energy              ! of a class
      integer(ip) :: degree, most, c
      real(wp) :: gain, left, open, most_open, largest, least
      real(wp) :: of_stresses                       ! energy of those of the displacements
      integer :: sweep

      degree = ubound(loads%traction, 2, kind=ip)
      outlines%degree = degree
      outlines%class_of = classes%of_element(classes%member)
      allocate (outlines%place(fem%mesh%n_elements))
      outlines%place(classes%member) = [(c, c=1, fem%mesh%n_elements)]
      most = maxval(outline_size(fem%mesh%shape(:fem%mesh%n_elements), degree))
      cut = pack([(c, c=1, fem%mesh%n_elements)], [(is_cut(cuts, sides, c), c=1, fem%mesh%n_elements)])
      associate (n => fem%mesh%n_elements)
         allocate (outlines%h(packed_size(most), classes%n), outlines%of_cut(most, most, size(cut)), outlines%a(most, n), &
                   outlines%slope(most, n), outlines%energy(n), source=0.0_wp)
      end associate
      of_stresses = 0.0_wp
      most_open = 0.0_wp
      largest = 0.0_wp
      do c = 1, classes%n
         call begin_class(c)
      end do
      residual = max(residual, most_open/max(largest, tiny(open)))
      do c = 1, size(cut, kind=ip)
         call begin_cut(fem, sides, cuts, loads, u, cut(c), classes%n + c, outlines)
         if (outlines%energy(outlines%place(cut(c))) < 0.0_wp) return
      end do
      left = sum(outlines%energy)
      least = merge(LITTLE, LITTLE_OF_LARGE, fem%mesh%n_elements <= LARGE)
      do sweep = 1, MOST_SWEEPS
         if (.not. left > NOTHING*of_stresses) exit
         call sweep_stars(fem%mesh, sides, chains, loads%known, outlines, gain)
         left = left - gain
         if (.not. gain > least*left) exit
      end do
      if (sum(outlines%energy) <= FEW_DIGITS*of_stresses) call sum_again(fem, classes, sides, cuts, loads, u, outlines)
      outlines%energy = max(outlines%energy, 0.0_wp)   ! elsewhere than where the energy is, round-off of either sign

   contains

      !> Outlines and slopes of the energy of the elements of a class, and their energies.
      subroutine begin_class(c)
         integer(ip), intent(in) :: c
         real(wp) :: x(MOST_GIVEN), y(MOST_OUTLINE + MOST_GIVEN), of_x
         integer(ip) :: i, j

         call make_class_energy(fem, loads, u, classes%member(classes%first(c):classes%first(c + 1) - 1), degree, energy)
         call pack_energy(energy%slopes(:energy%n, :energy%n), c, outlines)
         do i = classes%first(c), classes%first(c + 1) - 1
            associate (e => classes%member(i), n => energy%n, corners => energy%macro%n)
               call outline_of_tractions(energy%macro%corner(:, :corners), &
                                         tractions_around(sides, loads, e, energy%macro%corner(:, :corners)), &
                                         outlines%a(:n, i), open)
               most_open = max(most_open, open)
               largest = max(largest, maxval(abs(outlines%a(2:3*corners:3, i))), maxval(abs(outlines%a(3:3*corners:3, i))))
               call take_given(fem, loads, u, e, energy, x)
               y = 0.0_wp
               do j = 1, energy%n_given
                  if (x(j) == 0.0_wp) cycle
                  y(:n + energy%n_given) = y(:n + energy%n_given) + energy%slopes(:, n + j)*x(j)
               end do
               of_x = dot_product(x(:energy%n_given), y(n + 1:n + energy%n_given))
               of_stresses = of_stresses + of_x
               of_x = of_x + dot_product(outlines%a(:n, i), y(:n))
               do j = 1, n
                  y(:n) = y(:n) + energy%slopes(:n, j)*outlines%a(j, i)
               end do
               outlines%slope(:n, i) = y(:n)
               outlines%energy(i) = of_x + dot_product(outlines%a(:n, i), y(:n))
            end associate
         end do
      end subroutine begin_class

   end subroutine sum_stresses

   !> What depends on the shape of the elements of a class; of one alone by its own numbers.
   subroutine make_class_energy(fem, loads, u, members, degree, energy)
      type(fem_t), intent(in) :: fem
      type(proof_loads_t), intent(in) :: loads
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      integer(ip), intent(in) :: members(:)
      integer(ip), intent(in) :: degree             !< k
      type(element_energy_t), intent(inout) :: energy
      real(wp) :: x(MOST_GIVEN, 1)
      integer(ip) :: n

      if (size(members) > 1) then
         call make_energy(fem, members(1), degree, energy)
      else
         call given_with_loads(fem, loads, u, members(1), x(:, 1), n)
         call make_energy(fem, members(1), degree, energy, given=x(:n, :))
      end if
   end subroutine make_class_energy

   !> The numbers of an element that its energy (make_class_energy) is to be taken with.
   subroutine take_given(fem, loads, u, e, energy, x)
      type(fem_t), intent(in) :: fem
      type(proof_loads_t), intent(in) :: loads
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      integer(ip), intent(in) :: e
      type(element_energy_t), intent(in) :: energy
      real(wp), intent(inout) :: x(:)
      real(wp) :: turn
      integer(ip) :: n, k

      x(1) = 1.0_wp
      if (energy%n_given == 1) return
      call given_with_loads(fem, loads, u, e, x, n)
      associate (far => energy%x(:, 3), at => energy%x)  ! the rotation of corner 3 about the first one makes no stress, and squares
         turn = (far(1)*x(6) - far(2)*x(5))/(far(1)**2 + far(2)**2)
         do k = 2, energy%shape
            x(2*k - 1) = x(2*k - 1) + turn*at(2, k)
            x(2*k) = x(2*k) - turn*at(1, k)
         end do
      end associate
   end subroutine take_given

   subroutine given_with_loads(fem, loads, u, e, x, n)
      type(fem_t), intent(in) :: fem
      type(proof_loads_t), intent(in) :: loads
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      integer(ip), intent(in) :: e
      real(wp), intent(inout) :: x(:)
      integer(ip), intent(out) :: n                 !< how many

      call given_of(fem, e, u, x, n)
      x(n + 1:n + 2) = loads%volume(:, e)
      n = n + 2
   end subroutine given_with_loads

   !> Outline, slope and energy of an element that is cut. It has an energy of its own, and so a class.
   subroutine begin_cut(fem, sides, cuts, loads, u, e, class, outlines)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      type(side_cuts_t), intent(in) :: cuts
      type(proof_loads_t), intent(in) :: loads
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      integer(ip), intent(in) :: e, class
      type(outlines_t), intent(inout) :: outlines   !< with the outline
      real(wp) :: x(MOST_GIVEN)
      integer(ip) :: n_x

      associate (n => outline_size(fem%mesh%shape(e), outlines%degree), i => outlines%place(e))
         call given_with_loads(fem, loads, u, e, x, n_x)
         outlines%class_of(i) = class
         call cut_difference(fem, sides, cuts, e, x(:n_x), outlines%a(:n, i), outlines%energy(i), &
                             outlines%of_cut(:n, :n, class - size(outlines%h, 2)), outlines%slope(:n, i))
      end associate
   end subroutine begin_cut

   !> The tractions along the sides of an element, counter-clockwise, with what its forces per volume add.
   pure function tractions_around(sides, loads, e, corner) result(traction)
      type(mesh_sides_t), intent(in) :: sides
      type(proof_loads_t), intent(in) :: loads
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: corner(:, :)          !< (2, corners) [L]
      real(wp) :: traction(2, 0:ubound(loads%traction, 2), size(corner, 2)) !< as loads%traction [F/L]
      integer(ip) :: degree, next, j

      degree = ubound(loads%traction, 2, kind=ip)
      do j = 1, size(corner, 2, kind=ip)
         next = 1 + mod(j, size(corner, 2, kind=ip))
         associate (side => sides%of_element(j, e))
            if (side > 0) then
               traction(:, :, j) = loads%traction(:, :, side)
            else
               traction(:, :, j) = -loads%traction(:, degree:0:-1, -side)
            end if
         end associate
         if (any(loads%volume(:, e) /= 0.0_wp)) then
            traction(:, :, j) = traction(:, :, j) + volume_tractions(loads%volume(:, e), corner(:, j), corner(:, next), degree)
         end if
      end do
   end function tractions_around

   !> Numbers of the outline of an element.
   pure elemental integer(ip) function outline_size(shape, degree)
      integer(ip), intent(in) :: shape
      integer(ip), intent(in) :: degree             !< k

      outline_size = CORNERS_OF(shape)*(2*degree + 2)
   end function outline_size

   !> The energies as sums of squares point by point, where the difference of large numbers would be round-off.
   subroutine sum_again(fem, classes, sides, cuts, loads, u, outlines)
      type(fem_t), intent(in) :: fem
      type(element_classes_t), intent(in) :: classes
      type(mesh_sides_t), intent(in) :: sides
      type(side_cuts_t), intent(in) :: cuts
      type(proof_loads_t), intent(in) :: loads
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(outlines_t), intent(inout) :: outlines
      type(element_energy_t) :: energy
      real(wp) :: x(MOST_GIVEN)
      integer(ip) :: c, i, n
      logical :: is_made

      do c = 1, classes%n
         is_made = .false.
         do i = classes%first(c), classes%first(c + 1) - 1
            associate (e => classes%member(i))
               if (is_cut(cuts, sides, e)) then
                  call given_with_loads(fem, loads, u, e, x, n)
                  call cut_difference(fem, sides, cuts, e, x(:n), &
                                      outlines%a(:outline_size(fem%mesh%shape(e), outlines%degree), i), outlines%energy(i))
               else
                  if (.not. is_made) then
                     call make_class_energy(fem, loads, u, classes%member(classes%first(c):classes%first(c + 1) - 1), &
                                            outlines%degree, energy)
                  end if
                  is_made = .true.
                  call take_given(fem, loads, u, e, energy, x)
                  outlines%energy(i) = energy_difference(energy, x(:energy%n_given), outlines%a(:energy%n, i))
               end if
            end associate
         end do
      end do
   end subroutine sum_again

end module atrito_equilibrium_stress
