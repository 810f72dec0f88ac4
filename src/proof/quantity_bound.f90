!> Bounds of a linear quantity of the exact solution, from two scenes (docs/theory/proof.md).
!>
!> The quantity loads a scene of its own, the dual one, with the solution z. Both have displacements u_h, z_h that keep the supports
!> and stresses in equilibrium, and D, D* are the differences of these to the stresses of the displacements. The work of the forces
!> of one scene on the displacements of the other gives
!>
!>     Q(u) = Q_h + (B, B*),     Q_h = q(u_h) + f(z_h) - a(u_h, z_h),                                             (1)
!>
!> B, B* the errors of the stresses of u_h and z_h, which are not known. But for any k > 0 k D + D*/k is k B + B*/k less the errors
!> of the equilibrium, which are orthogonal to it: so 4 (B, B*) = |k B + B*/k|^2 - |k B - B*/k|^2 lies between
!>
!>     -|k D - D*/k|^2     and     |k D + D*/k|^2,                                                               (2)
!>
!> closest together for k^2 = |D*|/|D|: (B, B*) is known to |D| |D*| then, half of what Cauchy's inequality tells.
!>
!> This is of a linear problem. Contact is one with its states held: atrito_joined_sides. The potential energy, contact and friction
!> included, is bounded without holding them: bound_potential.
module atrito_quantity_bound
   use atrito_assembly, only: fem_t
   use atrito_contact_segments, only: segment_t, between, overlap_at, slip_at
   use atrito_cut_elements, only: link_pieces, side_cuts_t
   use atrito_element_classes, only: element_classes_t, find_classes
   use atrito_element_table, only: DEGREE_OF
   use atrito_equilibrium_stress, only: sum_again, sum_stresses
   use atrito_error_bound, only: take_contact, take_elements, LEAST_DIGITS
   use atrito_joined_sides, only: forces_of_held, interface_energy, interface_product, joints_t
   use atrito_kinds, only: ip, wp
   use atrito_law_lack, only: add_zeros
   use atrito_linear_quantity, only: quantity_bound_t
   use atrito_mesh_sides, only: chains_t, list_chains, list_sides, mesh_sides_t
   use atrito_packed_energies, only: outlines_t
   use atrito_proof_loads, only: proof_loads_t
   use atrito_side_tractions, only: equilibrate_sides
   use atrito_sorting, only: order_key, sorted_places
   implicit none (type, external)
   private
   public :: held_scene_t, common_t, begin_common, find_stress, bound_between, has_digits, bound_potential

   !> A scene with its contact states held: the one that is solved, or the dual one.
   type :: held_scene_t
      type(fem_t) :: fem                            !< of the dual one with the strains that its stress means make
      type(segment_t), allocatable :: segments(:)   !< with tractions, and with what joined sides are held at as gap and rest
      type(proof_loads_t) :: loads
      real(wp), allocatable :: f(:, :)              !< (2, n_nodes) the same as forces [F]
      real(wp), allocatable :: u(:, :)              !< (2, n_nodes) [L]
      type(outlines_t) :: outlines                  !< of the stress in equilibrium
      real(wp) :: energy = 0.0_wp                   !< |D|^2 [F L]
      real(wp) :: residual = 0.0_wp                 !< of the equilibrium, over the largest force
      real(wp) :: of_displacements = 0.0_wp         !< |C eps(u)|^2, strains of their own taken out [F L]
   end type held_scene_t

   !> What both scenes have in common.
   type :: common_t
      type(joints_t) :: joints
      type(element_classes_t) :: classes
      type(mesh_sides_t) :: sides
      type(chains_t) :: chains
      integer(ip) :: degree = 0                     !< k
   end type common_t

   real(wp), parameter :: ROUND_OFF = 1.0e-13_wp    !< of the works that a quantity is a sum of
   real(wp), parameter :: NO_STRESS = 1.0e-8_wp     !< of these, what stresses of the dual scene may work that are round-off

   !> Three Gauss points on [0,1].
   real(wp), parameter :: GAUSS_PLACES(3) = 0.5_wp + 0.38729833462074168852_wp*[real(wp) :: -1, 0, 1]
   real(wp), parameter :: GAUSS_WEIGHTS(3) = [real(wp) :: 5, 8, 5]/18

contains

   !> Sides, chains and classes of the elements; the joints are found elsewhere.
   subroutine begin_common(fem, both)
      type(fem_t), intent(in) :: fem
      type(common_t), intent(inout) :: both

      both%degree = maxval(DEGREE_OF(fem%mesh%shape(:fem%mesh%n_elements)))
      call find_classes(fem, both%classes)
      call list_sides(fem%mesh, both%sides)
      call list_chains(fem%mesh, both%sides, both%chains)
   end subroutine begin_common

   !> The stress in equilibrium, and its distance from that of the displacements.
   subroutine find_stress(both, u_of_loads, scene, why_not)
      type(common_t), intent(in) :: both
      real(wp), intent(in) :: u_of_loads(:, :)      !< (2, n_nodes) the finite element solution for the tractions as loads [L]
      type(held_scene_t), intent(inout) :: scene
      character(len=:), allocatable, intent(inout) :: why_not
      type(side_cuts_t) :: cuts
      real(wp), allocatable :: force(:, :, :)

      call take_contact(scene%fem, both%sides, scene%segments, both%degree, scene%loads, cuts, why_not)
      if (allocated(why_not)) return
      call take_elements(scene%fem, both%classes, both%sides, u_of_loads, scene%loads, force)
      call equilibrate_sides(scene%fem%mesh, both%sides, both%chains, force, scene%loads%known, scene%loads%traction, &
                             scene%residual)
      deallocate (force)
      call sum_stresses(scene%fem, both%classes, both%sides, both%chains, scene%loads, scene%u, cuts, scene%outlines, &
                        scene%residual)
      if (any(scene%outlines%energy < 0.0_wp)) then
         why_not = 'a side of an element faces too many others'
         return
      end if
      scene%energy = sum(scene%outlines%energy) + interface_energy(both%joints, scene%segments, scene%u)
      scene%of_displacements = energy_of_displacements(both, scene)
   end subroutine find_stress

   !> The bounds from both scenes; bound%least and most have on entry the constant of the quantity.
   subroutine bound_between(both, primal, dual, bound, why_not)
      type(common_t), intent(in) :: both
      type(held_scene_t), intent(in) :: primal, dual
      type(quantity_bound_t), intent(inout) :: bound
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp), allocatable :: force(:, :)
      real(wp) :: k, works(4), above, below, norms, middle, lost

      force = primal%f
      call forces_of_held(both%joints, primal%segments, force)
      norms = sqrt(primal%of_displacements*dual%of_displacements)
      k = balance_of(primal%of_displacements, dual%of_displacements)
      works(1) = sum(dual%f*primal%u)
      works(2) = sum(force*dual%u)
      works(3) = -0.25_wp*(stress_energy(both, primal, dual, k, 1) - stress_energy(both, primal, dual, k, -1))
      works(4) = -interface_product(both%joints, primal%segments, primal%u, dual%segments, dual%u)
      k = balance_of(primal%energy, dual%energy)
      above = 0.0_wp
      below = 0.0_wp
      if (primal%energy > 0.0_wp .and. dual%energy > 0.0_wp) then
         call difference_energy(both, primal, dual, k, 1, above, why_not)
         call difference_energy(both, primal, dual, k, -1, below, why_not)
      end if
      if (allocated(why_not)) return
      middle = bound%least + sum(works)
      lost = ROUND_OFF*(abs(bound%least) + sum(abs(dual%f*primal%u)) + sum(abs(force*dual%u)) + sum(abs(works)) + norms)
      bound%is_certified = has_digits(primal) .and. has_digits(dual)
      if (norms <= NO_STRESS*sum(abs(works))) then     ! equilibrium alone determines it, and the dual strains are round-off
         lost = lost + norms
         bound%is_certified = has_digits(primal)
      end if
      bound%least = middle - 0.25_wp*below - lost
      bound%most = middle + 0.25_wp*above + lost
      bound%exists = .true.
      if (.not. bound%is_certified) bound%why_not = 'round-off of the equilibrium'
   end subroutine bound_between

   !> k, by which energies of k times a scene and 1/k times another one are equal.
   pure real(wp) function balance_of(energy, other) result(k)
      real(wp), intent(in) :: energy, other

      k = 1.0_wp
      if (energy > 0.0_wp .and. other > 0.0_wp) k = sqrt(sqrt(other)/sqrt(energy))
   end function balance_of

   !> Whether the equilibrium of a scene's stress is exact enough for its bound.
   pure logical function has_digits(scene)
      type(held_scene_t), intent(in) :: scene
      real(wp) :: share

      share = 0.0_wp
      if (scene%of_displacements > 0.0_wp) share = sqrt(scene%energy)/sqrt(scene%of_displacements)
      has_digits = scene%residual <= max(LEAST_DIGITS*share, 1.0e-12_wp)
   end function has_digits

   !> k times a scene and s/k times another one.
   subroutine combine(primal, dual, k, s, scene)
      type(held_scene_t), intent(in) :: primal, dual
      real(wp), intent(in) :: k
      integer, intent(in) :: s                      !< 1 or -1
      type(held_scene_t), intent(inout) :: scene

      scene%fem = primal%fem
      if (allocated(primal%fem%heating)) scene%fem%heating = k*primal%fem%heating
      if (allocated(dual%fem%own_strain)) scene%fem%own_strain = (s/k)*dual%fem%own_strain
      scene%u = k*primal%u + (s/k)*dual%u
      scene%segments = primal%segments
      scene%outlines%degree = primal%outlines%degree
      allocate (scene%outlines%energy(size(primal%outlines%energy)), source=0.0_wp)
      scene%outlines%a = k*primal%outlines%a + (s/k)*dual%outlines%a
      scene%loads%volume = k*primal%loads%volume + (s/k)*dual%loads%volume
      scene%loads%known = primal%loads%known
      allocate (scene%loads%traction, mold=primal%loads%traction)
      scene%loads%traction = 0.0_wp                 ! sides that are cut are looked for alone
      call add_segments_of()

   contains

      subroutine add_segments_of()
         integer(ip) :: i

         do i = 1, size(scene%segments, kind=ip)
            associate (one => primal%segments(i), other => dual%segments(i), both => scene%segments(i))
               both%p = k*one%p + (s/k)*other%p
               both%t = k*one%t + (s/k)*other%t
               both%gap = k*one%gap + (s/k)*other%gap
               both%rest = k*one%rest + (s/k)*other%rest
            end associate
         end do
      end subroutine add_segments_of

   end subroutine combine

   !> |C eps(k u + s z/k)|^2 of the bodies.
   real(wp) function stress_energy(both, primal, dual, k, s) result(energy)
      type(common_t), intent(in) :: both
      type(held_scene_t), intent(in) :: primal, dual
      real(wp), intent(in) :: k
      integer, intent(in) :: s
      type(held_scene_t) :: scene

      call combine(primal, dual, k, s, scene)
      energy = energy_of_displacements(both, scene)
   end function stress_energy

   !> |C eps(u)|^2 of the bodies.
   real(wp) function energy_of_displacements(both, scene) result(energy)
      type(common_t), intent(in) :: both
      type(held_scene_t), intent(in) :: scene
      type(outlines_t) :: nothing
      type(proof_loads_t) :: no_loads
      type(side_cuts_t) :: no_cuts
      character(len=:), allocatable :: no_reason

      nothing%degree = both%degree
      allocate (nothing%a, mold=scene%outlines%a)
      allocate (nothing%energy, mold=scene%outlines%energy)
      allocate (no_loads%volume, mold=scene%loads%volume)
      nothing%a = 0.0_wp
      no_loads%volume = 0.0_wp
      call link_pieces(both%sides%n, no_cuts, no_reason)
      call sum_again(scene%fem, both%classes, both%sides, no_cuts, no_loads, scene%u, nothing)
      energy = sum(nothing%energy)
   end function energy_of_displacements

   !> |k D + s D*/k|^2
   subroutine difference_energy(both, primal, dual, k, s, energy, why_not)
      type(common_t), intent(in) :: both
      type(held_scene_t), intent(in) :: primal, dual
      real(wp), intent(in) :: k
      integer, intent(in) :: s
      real(wp), intent(out) :: energy
      character(len=:), allocatable, intent(inout) :: why_not
      type(held_scene_t) :: scene
      type(side_cuts_t) :: cuts

      energy = 0.0_wp
      call combine(primal, dual, k, s, scene)
      call take_contact(scene%fem, both%sides, scene%segments, both%degree, scene%loads, cuts, why_not)
      if (allocated(why_not)) return
      call sum_again(scene%fem, both%classes, both%sides, cuts, scene%loads, scene%u, scene%outlines)
      energy = sum(scene%outlines%energy) + interface_energy(both%joints, scene%segments, scene%u)
   end subroutine difference_energy

   !> Bounds of the potential energy of the exact solution, contact and friction included (docs/theory/proof.md):
   !>
   !>     F(v) = |C eps(v)|^2/2 - f(v) + int psi_n(g) + psi_t(r),
   !>
   !> psi_n = max(g, 0)^2/(2 delta), psi_t = r^2/(2 c) up to the slip c tau and tau |r| - c tau^2/2 beyond, tau the friction bound
   !> of the run, c = eps/tau or 1/k. The exact solution has the least F, so F(u_h) is not less, if sides do not overlap or have
   !> delta. With a stress s^ in equilibrium with p^, t^, and psi* the conjugates,
   !>
   !>     F(u) >= |C eps(u_h)|^2/2 - f(u_h) - |s^ - C eps(u_h)|^2/2 - int psi_n*(p^) - p^ g + psi_t*(t^) - t^ r.
   !>
   !> least and most [F L]; overlaps: sides without delta overlap, and there is no upper bound.
   subroutine bound_potential(segments, u, work, energy, difference, least, most, overlaps)
      type(segment_t), intent(in) :: segments(:)    !< with tractions that the laws allow
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: work                  !< f(u_h) [F L]
      real(wp), intent(in) :: energy, difference    !< |C eps(u_h)|^2, |s^ - C eps(u_h)|^2 [F L]
      real(wp), intent(out) :: least, most
      logical, intent(out) :: overlaps
      real(wp), parameter :: NONE = 1.0e-10_wp      !< of the largest displacement: an overlap that is round-off
      real(wp) :: potential, conjugate
      integer(ip) :: i

      least = 0.5_wp*energy - work
      most = least
      least = least - 0.5_wp*difference
      overlaps = .false.
      do i = 1, size(segments, kind=ip)
         call sum_segment(segments(i), u, NONE*maxval(abs(u)), potential, conjugate, overlaps)
         least = least - conjugate
         most = most + potential
      end do
   end subroutine bound_potential

   !> int psi_n + psi_t, and int psi_n* - p g + psi_t* - t r, of a segment, cut where a law changes its form.
   subroutine sum_segment(segment, u, none, potential, conjugate, overlaps)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)
      real(wp), intent(in) :: none                  !< [L]
      real(wp), intent(out) :: potential, conjugate !< [F L]
      logical, intent(inout) :: overlaps
      real(wp) :: cuts(8), places(3), g(3), r(3), full(3), at, weight
      integer :: k, l, n

      places = [0.0_wp, 0.5_wp, 1.0_wp]
      do k = 1, 3
         g(k) = overlap_at(segment, u, places(k))
         r(k) = slip_at(segment, u, places(k))
         full(k) = segment%eps + segment%compliance*between(segment%tau, places(k))
      end do
      n = 2
      cuts(:2) = [0.0_wp, 1.0_wp]
      call add_zeros(g, n, cuts)
      call add_zeros(r - full, n, cuts)
      call add_zeros(r + full, n, cuts)
      cuts(:n) = cuts(sorted_places(order_key(cuts(:n))))
      potential = 0.0_wp
      conjugate = 0.0_wp
      do k = 1, n - 1
         do l = 1, 3
            at = cuts(k) + (cuts(k + 1) - cuts(k))*GAUSS_PLACES(l)
            weight = (cuts(k + 1) - cuts(k))*GAUSS_WEIGHTS(l)*segment%length*segment%thickness
            call add_normal()
            if (maxval(segment%tau) > 0.0_wp) call add_tangential()
         end do
      end do

   contains

      subroutine add_normal()
         real(wp) :: g_here, p

         g_here = overlap_at(segment, u, at)
         p = between(segment%p, at)
         conjugate = conjugate + weight*(0.5_wp*segment%delta*p**2 - p*g_here)
         if (segment%delta > 0.0_wp) then
            potential = potential + weight*max(g_here, 0.0_wp)**2/(2*segment%delta)
         else
            overlaps = overlaps .or. g_here > none
         end if
      end subroutine add_normal

      !> Of eps t^2/(2 tau) what is not less: with 1/tau linear between the ends, or eps |t|/2 where tau ends.
      subroutine add_tangential()
         real(wp) :: slip, t, tau, slip_of_full

         slip = slip_at(segment, u, at)
         t = between(segment%t, at)
         tau = between(segment%tau, at)
         slip_of_full = segment%eps + segment%compliance*tau
         if (abs(slip) < slip_of_full) then
            potential = potential + weight*0.5_wp*tau*slip**2/slip_of_full
         else
            potential = potential + weight*tau*(abs(slip) - 0.5_wp*slip_of_full)
         end if
         conjugate = conjugate + weight*(0.5_wp*segment%compliance*t**2 - t*slip)
         if (.not. segment%eps > 0.0_wp) return
         if (minval(segment%tau) > 0.0_wp) then
            conjugate = conjugate + weight*0.5_wp*segment%eps*between(1/segment%tau, at)*t**2
         else
            conjugate = conjugate + weight*0.5_wp*segment%eps*abs(t)
         end if
      end subroutine add_tangential

   end subroutine sum_segment

end module atrito_quantity_bound
