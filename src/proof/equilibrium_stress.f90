!> Stresses in equilibrium with tractions along all sides, and their distance from the stresses of displacements.
!>
!> Elements that are equal have one H; they are found by comparing each with the last few different ones, so that neighbours in a
!> regular mesh share it. What belongs to a class is made for a run of its elements and not kept.
module atrito_equilibrium_stress
   use atrito_airy_stress, only: outline_of_tractions, MOST_OUTLINE, MOST_PIECES
   use atrito_assembly, only: fem_t, form_t, has_form, take_form
   use atrito_cut_elements, only: side_cuts_t, cut_difference, is_cut
   use atrito_element_energy, only: element_energy_t, energy_difference, energy_slope, make_energy, volume_tractions
   use atrito_element_table, only: CORNERS_OF
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, wp
   use atrito_mesh_sides, only: mesh_sides_t
   use atrito_star_sweeps, only: outlines_t, sweep_stars
   implicit none (type, external)
   private
   public :: sum_stresses

   integer, parameter :: MOST_SWEEPS = 12
   real(wp), parameter :: LITTLE = 0.1_wp           !< of the energy: a sweep that gained less is the last one
   integer(ip), parameter :: COMPARED = 8             !< different elements that one is compared with

contains

   !> The squares of the distance, element by element, behind as many sweeps as are worth it.
   subroutine sum_stresses(fem, sides, known, traction, body, u, degree, cuts, share)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      logical, intent(in) :: known(:, :)            !< (2, sides): what sweeps leave as it is
      real(wp), intent(in) :: traction(:, 0:, :)    !< (2, 0:k, sides) Bernstein coefficients on the first element [F/L]
      real(wp), intent(in) :: body(:, :)            !< (2, n_elements) thickness times force per volume [F/L^2]
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      integer(ip), intent(in) :: degree             !< k
      type(side_cuts_t), intent(in) :: cuts         !< sides whose tractions are polynomials by parts
      real(wp), intent(out) :: share(:)             !< (n_elements) [F L]
      type(outlines_t) :: outlines
      integer(ip), allocatable :: first(:), member(:)
      integer(ip) :: n_classes, most
      real(wp) :: gain, left
      integer :: sweep

      call number_classes(fem, outlines%class_of, n_classes)
      call list_holders(n_classes, reshape(outlines%class_of, [1_ip, size(outlines%class_of, kind=ip)]), first, member)
      most = maxval(CORNERS_OF(fem%mesh%shape(:fem%mesh%n_elements)))*(2*degree + 2)
      outlines%degree = degree
      allocate (outlines%h(most, most, n_classes), outlines%a(most, fem%mesh%n_elements), outlines%slope(most, fem%mesh%n_elements))
      left = 0.0_wp
      call go_through(.false.)
      do sweep = 1, MOST_SWEEPS
         call sweep_stars(fem%mesh, sides, known, outlines, gain)
         left = left - gain
         if (.not. gain > LITTLE*left) exit
      end do
      call go_through(.true.)

   contains

      !> All elements, class by class: before the sweeps their outlines and the slopes of the energy, behind them the energies.
      subroutine go_through(is_last)
         logical, intent(in) :: is_last
         type(element_energy_t) :: energy
         real(wp) :: of_nodes(18), heating(9), g(MOST_OUTLINE), g_bubble(MOST_PIECES), constant
         real(wp) :: of_sides(2, 0:degree, 4)
         integer(ip) :: c, i, e, n, m, k, n_heat

         n_heat = 0
         do c = 1, n_classes
            do i = first(c), first(c + 1) - 1
               e = member(i)
               if (i == first(c)) call make_energy(fem, e, degree, energy)
               n = energy%shape
               m = energy%macro%n_outline
               associate (nodes => fem%mesh%nodes(:n, e))
                  do k = 1, n
                     of_nodes(2*k - 1:2*k) = u(:, nodes(k)) - u(:, nodes(1))
                  end do
                  if (allocated(fem%heating)) then
                     n_heat = n
                     heating(:n) = fem%heating(nodes)
                  end if
               end associate
               if (is_last) then
                  if (is_cut(cuts, sides, e)) then
                     share(e) = cut_difference(fem, sides, cuts, e, degree, of_nodes(:2*n), heating(:n_heat), body(:, e), &
                                               outlines%a(:m, e))
                  else
                     share(e) = energy_difference(energy, of_nodes(:2*n), heating(:n_heat), body(:, e), outlines%a(:m, e))
                  end if
                  cycle
               end if
               if (i == first(c)) outlines%h(:m, :m, c) = energy%outline(:m, :m)
               do k = 1, energy%macro%n
                  associate (side => sides%of_element(k, e), at => energy%macro%corner)
                     if (side > 0) then
                        of_sides(:, :, k) = traction(:, :, side)
                     else
                        of_sides(:, :, k) = -traction(:, degree:0:-1, -side)
                     end if
                     of_sides(:, :, k) = of_sides(:, :, k) + volume_tractions(body(:, e), at(:, k), &
                                                                              at(:, 1 + mod(k, energy%macro%n)), degree)
                  end associate
               end do
               k = energy%macro%n
               call outline_of_tractions(energy%macro%corner(:, :k), of_sides(:, :, :k), outlines%a(:m, e))
               call energy_slope(energy, of_nodes(:2*n), heating(:n_heat), body(:, e), g(:m), g_bubble, constant)
               outlines%slope(:m, e) = g(:m) + matmul(energy%outline(:m, :m), outlines%a(:m, e))
               left = left + dot_product(outlines%a(:m, e), outlines%slope(:m, e) + g(:m)) + constant
            end do
         end do
      end subroutine go_through

   end subroutine sum_stresses

   !> The class of each element.
   subroutine number_classes(fem, class_of, n)
      type(fem_t), intent(in) :: fem
      integer(ip), allocatable, intent(out) :: class_of(:)
      integer(ip), intent(out) :: n
      type(form_t) :: recent(COMPARED)
      integer(ip) :: number(COMPARED), e, k, next

      allocate (class_of(fem%mesh%n_elements))
      n = 0
      next = 0
      do e = 1, fem%mesh%n_elements
         do k = 1, COMPARED
            if (recent(k)%shape == 0) cycle
            if (has_form(fem, e, recent(k), 0.0_wp, may_turn=.false.)) exit
         end do
         if (k > COMPARED) then
            next = 1 + mod(next, COMPARED)
            k = next
            n = n + 1
            number(k) = n
            call take_form(fem, e, recent(k))
         end if
         class_of(e) = number(k)
      end do
   end subroutine number_classes

end module atrito_equilibrium_stress
