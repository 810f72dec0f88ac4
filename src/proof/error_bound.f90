!> A proved bound of the error in the energy norm (docs/theory/proof.md).
!>
!> With the friction bound tau of the run the contact problem has one solution u, of least energy, with the stress s. For
!> the displacements u_h of the run, which keep the supports, a stress s^ in equilibrium with the loads and with tractions p^, t^
!> that the laws allow, and any displacements w that are 0 at supports,
!>
!>     ||u_h - u||^2 <= eta^2 = ||s^ - C eps(u_h)||^2 + ||w||^2 + 2 int rho_n + rho_t                                       (1)
!>
!> (Prager and Synge, for contact with friction), norms of the energy. No constant, no assumption on the mesh. The steps:
!>
!> 1. p^, t^: from point to point as those of the run, linear, of small scenes in two kinds, of which the better one counts;
!> balanced with the loads of bodies that nothing else holds (`balanced_segments`).
!> 2. One more solution with these tractions in place of the forces of contact, by which all that follows is a matter of loads.
!> 3. Tractions along all sides in equilibrium with every element (atrito_side_tractions).
!> 4. A stress in every element (atrito_airy_stress), bettered by sweeps over the corners (atrito_star_sweeps).
!> 5. w, by which the sides are moved to where the laws are met as well as it is worth, and rho, what they still lack
!> (`add_misfit`).
module atrito_error_bound
   use atrito_assembly, only: cached_stiffness, fem_t, stiffness_cache_t
   use atrito_balanced_contact, only: balanced_segments
   use atrito_cut_elements, only: add_piece, link_pieces, side_cuts_t
   use atrito_contact_segments, only: segment_forces, segment_t, traction_at
   use atrito_contact_solution, only: contact_solution_t
   use atrito_element_classes, only: element_classes_t, find_classes, given_of
   use atrito_element_energy, only: corner_stresses, MOST_GIVEN
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF, MOST_NODES
   use atrito_equilibrium_stress, only: sum_stresses
   use atrito_exchanged_tractions, only: exchange
   use atrito_glued_ties, only: glue_ties
   use atrito_internal_forces, only: internal_forces
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_mesh_sides, only: chains_t, list_chains, list_sides, mesh_sides_t
   use atrito_misfit_places, only: strip_places_t
   use atrito_model, only: model_t, step_t
   use atrito_packed_energies, only: outlines_t
   use atrito_problem, only: problem_t
   use atrito_proof_forecast, only: work_of_bound, work_of_run
   use atrito_proof_loads, only: proof_loads_t, take_loads
   use atrito_results, only: error_bound_t, results_t
   use atrito_side_misfit, only: add_misfit
   use atrito_side_tractions, only: equilibrate_sides, side_length, traction_of
   use atrito_thermal_loads, only: add_thermal_of, elastic_energy
   implicit none (type, external)
   private
   public :: bound_error, ground_t, is_tried_twice, terms_t, sum_terms, check_hypotheses, take_contact, take_elements, LEAST_DIGITS

   !> What both kinds of tractions of contact have in common.
   type :: ground_t
      type(element_classes_t) :: classes
      type(mesh_sides_t) :: sides                   !< these and what follows are made where they are first asked for
      type(chains_t) :: chains
      type(strip_places_t) :: strip
   end type ground_t

   !> What the square of the bound is the sum of.
   type :: terms_t
      real(wp), allocatable :: share(:)             !< (n_elements) all of it [F L]
      real(wp) :: of_law(3) = 0.0_wp                !< in them: the misfit of the sides, the normal law, friction [F L]
      real(wp) :: residual = 0.0_wp                 !< of the equilibrium
      character(len=:), allocatable :: why_not      !< allocated: there is no bound
      logical :: keeps_outlines = .false.           !< they are asked for: large
      real(wp) :: most_work = huge(1.0_wp)          !< more is not wanted (atrito_proof_forecast)
      real(wp) :: work = 0.0_wp
      type(outlines_t) :: outlines                  !< s^, but that of elements that are cut
   end type terms_t

   integer(ip), parameter :: TRIED_TWICE = 4000     !< elements of a scene for which two kinds of tractions of contact are tried
   real(wp), parameter :: LEAST_PERCENT = 1.0e-7_wp !< no bound is below what round-off may be
   real(wp), parameter :: SHARE_DIGITS = 1.0e-6_wp
   real(wp), parameter :: LARGEST = 1.0e100_wp      !< of displacements and stresses, 1/LARGEST the least: squares stay numbers
   !> A residual of equilibrium above this share of the bound takes the certificate away.
   real(wp), parameter :: LEAST_DIGITS = 1.0e-3_wp

contains

   !> The bound of a converged solution: results%error_bound, whose why_not tells what is missing.
   !>
   !> results%element_error, where it is allocated, becomes the share of each element, eta being the root of the sum of their
   !> squares.
   subroutine bound_error(model, acting, problem, solution, exchanged, other, if_quick, results)
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: acting            !< with the loads of the time
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      real(wp), allocatable, intent(inout) :: exchanged(:, :) !< what exchange_with_factors found; not allocated: it is asked now
      real(wp), allocatable, intent(inout) :: other(:, :)     !< the same without the resultants
      logical, intent(in) :: if_quick               !< a bound is wanted where it takes less time than the rest of the run
      type(results_t), intent(inout) :: results     !< with displacements and reactions
      type(terms_t) :: terms, other_terms
      type(ground_t) :: ground

      results%error_bound = error_bound_t()
      call check_hypotheses(problem, results%u, terms%why_not)
      call find_classes(problem%fem, ground%classes)
      if (if_quick) terms%most_work = work_of_run(problem%fem, ground%classes, sum(problem%points%n), solution%form, &
                                                  results%linear_solves)
      if (.not. allocated(terms%why_not)) then
         call sum_terms(model, acting, problem, solution, .true., exchanged, results, ground, terms)
      end if
      if (.not. allocated(terms%why_not) .and. is_tried_twice(problem)) then
         other_terms%most_work = terms%most_work - terms%work
         call sum_terms(model, acting, problem, solution, .false., other, results, ground, other_terms)
         if (.not. allocated(other_terms%why_not)) then
            if (sum(other_terms%share) < sum(terms%share)) terms = other_terms
         end if
      end if
      if (allocated(terms%why_not)) then
         results%error_bound%why_not = terms%why_not
      else
         call complete_bound(problem%fem, terms%residual, terms%share, terms%of_law, results)
         results%error_bound%is_of_polygon = model%has_arcs
      end if
   end subroutine bound_error

   !> Whether both kinds of tractions of contact are tried.
   logical function is_tried_twice(problem)
      class(problem_t), intent(in) :: problem

      is_tried_twice = size(problem%points) > 0 .and. problem%fem%mesh%n_elements <= TRIED_TWICE
   end function is_tried_twice

   !> The terms of (1) with tractions of contact that have the resultants of the run, pair by pair, or those of the points.
   subroutine sum_terms(model, acting, problem, solution, keeps, exchanged, results, ground, terms)
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: acting
      class(problem_t), intent(in), target :: problem
      type(contact_solution_t), intent(in) :: solution
      logical, intent(in) :: keeps                  !< the resultants
      real(wp), allocatable, intent(inout) :: exchanged(:, :)
      type(results_t), intent(in), target :: results
      type(ground_t), intent(inout) :: ground       !< with the classes
      type(terms_t), intent(inout) :: terms
      type(proof_loads_t) :: loads
      type(side_cuts_t) :: cuts
      type(segment_t), allocatable :: segments(:)
      real(wp), allocatable :: force(:, :, :), joints(:)
      type(fem_t), target :: glued                  ! tied bodies as one
      type(mesh_t), target :: mesh_glued
      logical, allocatable, target :: held_glued(:, :)
      real(wp), allocatable, target :: reaction_glued(:, :)
      type(fem_t), pointer :: fem
      logical, pointer :: held(:, :)
      real(wp), pointer :: reaction(:, :)
      integer(ip) :: degree

      fem => problem%fem
      held => problem%held
      reaction => results%reaction
      if (problem%rows%n_bilateral > 0) then
         glued = problem%fem
         mesh_glued = problem%fem%mesh
         glued%mesh => mesh_glued
         held_glued = problem%held
         reaction_glued = results%reaction
         fem => glued
         held => held_glued
         reaction => reaction_glued
         call glue_ties(model, mesh_glued, ground%sides, held_glued, reaction_glued, terms%why_not)
      else if (ground%sides%n == 0) then
         call list_sides(fem%mesh, ground%sides)
      end if
      associate (classes => ground%classes, sides => ground%sides, chains => ground%chains)
         if (.not. allocated(terms%why_not)) then
            call balanced_segments(model, problem, solution, keeps, segments, joints, terms%why_not)
         end if
         if (.not. allocated(terms%why_not)) then
            degree = maxval(DEGREE_OF(fem%mesh%shape(:fem%mesh%n_elements)))
            call take_loads(model, acting, fem, sides, degree, held, reaction, loads, terms%why_not)
         end if
         if (.not. (allocated(terms%why_not) .or. allocated(exchanged))) then
            call exchange(problem, solution, segments, joints, exchanged, terms%why_not)
         end if
         if (.not. allocated(terms%why_not)) call take_contact(problem%fem, sides, segments, degree, loads, cuts, terms%why_not)
         if (.not. allocated(terms%why_not)) then
            terms%work = work_of_bound(problem%fem, classes, sides, cuts)
            if (terms%work > terms%most_work) terms%why_not = 'it takes longer than the run: --proof on'
         end if
         if (.not. allocated(terms%why_not)) then
            if (chains%n == 0) call list_chains(fem%mesh, sides, chains)
            call take_elements(problem%fem, classes, sides, results%u + exchanged, loads, force)
            call equilibrate_sides(fem%mesh, sides, chains, force, loads%known, loads%traction, terms%residual)
            block
               type(outlines_t) :: found                ! large: they go before the sides are looked at

               deallocate (force)
               call sum_stresses(problem%fem, classes, sides, chains, loads, results%u, cuts, found, terms%residual)
               terms%share = found%energy(found%place)
               if (terms%keeps_outlines) terms%outlines = found
            end block
            if (any(terms%share < 0.0_wp)) terms%why_not = 'a side of an element faces too many others'
         end if
         if (.not. allocated(terms%why_not)) then
            call add_misfit(fem, held, segments, results%u, ground%strip, terms%share, terms%of_law, terms%why_not)
         end if
      end associate
   end subroutine sum_terms

   !> eta from the shares of the elements, and the norm that it is over.
   subroutine complete_bound(fem, residual, share, of_law, results)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: residual              !< of the equilibrium
      real(wp), intent(in) :: share(:)              !< (n_elements) [F L]
      real(wp), intent(in) :: of_law(3)             !< in them: the misfit of the sides, the normal law, friction [F L]
      type(results_t), intent(inout) :: results
      real(wp), allocatable :: force_of_u(:, :)
      real(wp) :: energy, eta2

      associate (bound => results%error_bound)
         bound%exists = .true.
         bound%residual = residual
         eta2 = sum(share)
         bound%norm = sqrt(max(eta2, 0.0_wp))
         energy = 0.0_wp
         force_of_u = results%u
         call internal_forces(fem, results%u, force_of_u, energy)
         energy = elastic_energy(fem, results%u, energy)
         if (.not. energy > 0.0_wp) then
            bound = error_bound_t(why_not='no strain that it would be a share of')
            return
         end if
         bound%percent = max(LEAST_PERCENT, 100*bound%norm/sqrt(2*energy))
         if (bound%percent > LEAST_PERCENT) then    ! else they are shares of round-off
            bound%normal = share_of((of_law(1) + of_law(2))/eta2)
            bound%tangential = share_of(of_law(3)/eta2)
            bound%bulk = 1.0_wp - bound%normal - bound%tangential
         end if
         bound%is_certified = residual <= max(LEAST_DIGITS*bound%percent/100, 1.0e-12_wp)
         if (.not. bound%is_certified) bound%why_not = 'round-off of the equilibrium'
      end associate
      if (allocated(results%element_error)) results%element_error = 100*sqrt(max(share, 0.0_wp)/(2*energy))
   end subroutine complete_bound

   !> A share with the digits that are worth telling: what is less is round-off of a law that is met.
   pure real(wp) function share_of(part)
      real(wp), intent(in) :: part                  !< 0 to 1

      share_of = nint(part/SHARE_DIGITS)*SHARE_DIGITS
   end function share_of

   !> What nothing can be proved for, whatever the loads are.
   subroutine check_hypotheses(problem, u, why_not)
      class(problem_t), intent(in) :: problem
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp) :: farthest

      if (any(problem%fem%sections%thickness <= 0.0_wp)) why_not = 'no thickness'
      if (problem%fem%bodies%n_rigid > 0) why_not = 'rigid bodies'
      farthest = maxval(abs(u))
      if (farthest > LARGEST .or. (farthest > 0.0_wp .and. farthest < 1/LARGEST)) then
         why_not = 'displacements above 1e100 or below 1e-100: other units'
      end if
   end subroutine check_hypotheses

   !> Puts the tractions of contact among the known ones: polynomials with the same moments on sides that are cut.
   subroutine take_contact(fem, sides, segments, degree, loads, cuts, why_not)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      type(segment_t), intent(in) :: segments(:)
      integer(ip), intent(in) :: degree
      type(proof_loads_t), intent(inout) :: loads
      type(side_cuts_t), intent(out) :: cuts
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp), parameter :: no_extent = 1.0e-9_wp !! of the side's length, below which a piece is a point
      real(wp) :: on_slave(2, 3), on_master(2, 3), ends(2, 2)
      real(wp), allocatable :: applied(:, :, :)
      integer(ip) :: i

      applied = loads%traction
      do i = 1, size(segments, kind=ip)
         if (all(segments(i)%p == 0.0_wp .and. segments(i)%t == 0.0_wp)) cycle
         call segment_forces(segments(i), on_slave, on_master)
         ends(:, 1) = traction_at(segments(i), 0.0_wp)
         ends(:, 2) = traction_at(segments(i), 1.0_wp)
         call put(segments(i)%slave, segments(i)%on_slave, 1.0_wp, on_slave)
         if (segments(i)%master(1) == 0) cycle
         if (abs(segments(i)%on_master(2) - segments(i)%on_master(1)) <= no_extent) then ! its force on the master is a point's
            why_not = 'contact beyond the end of a master side'
            cycle
         end if
         associate (share => segments(i)%length/(abs(segments(i)%on_master(2) - segments(i)%on_master(1))* &
                                      side_length(fem%mesh, sides, sides%of_element(segments(i)%master(2), segments(i)%master(1)))))
            call put(segments(i)%master, segments(i)%on_master, -share, on_master)
         end associate
      end do
      call link_pieces(sides%n, cuts, why_not)

   contains

      subroutine put(face, places, factor, moments)
         integer(ip), intent(in) :: face(2)
         real(wp), intent(in) :: places(2), factor, moments(2, 3)
         real(wp) :: linear(2, 0:1)
         integer(ip) :: side

         side = sides%of_element(face(2), face(1))
         if (.not. all(loads%known(:, side))) why_not = 'contact along a support'
         if (any(applied(:, :, side) /= 0.0_wp)) why_not = 'a load along a contact side'
         call add_piece(side, places, factor*ends, cuts)
         associate (length => side_length(fem%mesh, sides, side))
            if (degree == 2 .and. sides%middle(side) == 0) then ! a face of two nodes beside others of three
               linear = traction_of(moments(:, :2), length, 1_ip)
               loads%traction(:, :, side) = loads%traction(:, :, side) + &
                                            reshape([linear(:, 0), 0.5_wp*(linear(:, 0) + linear(:, 1)), linear(:, 1)], [2, 3])
            else
               loads%traction(:, :, side) = loads%traction(:, :, side) + traction_of(moments(:, :degree + 1), length, degree)
            end if
         end associate
      end subroutine put

   end subroutine take_contact

   !> R_E of all elements, the forces of their stresses less those of their loads, and where tractions are not known those of the
   !> stresses at the corners: the mean of both elements of a side.
   subroutine take_elements(fem, classes, sides, u, loads, force)
      type(fem_t), intent(in) :: fem
      type(element_classes_t), intent(in) :: classes
      type(mesh_sides_t), intent(in) :: sides
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(proof_loads_t), intent(inout) :: loads
      real(wp), allocatable, intent(out) :: force(:, :, :)  !< (2, nodes, n_elements) R_E [F]
      real(wp), allocatable :: thermal(:, :)
      integer(ip) :: c

      call move_alloc(loads%at_nodes, force)
      force = -force
      if (allocated(fem%heating)) allocate (thermal(2, fem%mesh%n_nodes), source=0.0_wp)
      do c = 1, classes%n
         call take_class(c)
      end do

   contains

      subroutine take_class(c)
         integer(ip), intent(in) :: c
         type(stiffness_cache_t) :: cache
         real(wp) :: corner(12, MOST_GIVEN), x(MOST_GIVEN), f(2*MOST_NODES), s(12)
         integer(ip) :: i, k, n, n_given

         call cached_stiffness(fem, classes%member(classes%first(c)), cache)
         corner = corner_stresses(fem, cache%form_t)
         n = cache%shape
         do i = classes%first(c), classes%first(c + 1) - 1
            associate (e => classes%member(i))
               call given_of(fem, e, u, x, n_given)
               f(:2*n) = 0.0_wp
               do k = 3, 2*n
                  f(:2*n) = f(:2*n) + cache%k(:2*n, k)*x(k)
               end do
               do k = 1, n
                  force(:, k, e) = force(:, k, e) + f(2*k - 1:2*k)
               end do
               if (allocated(thermal)) then
                  ! Less the forces of the temperatures of an element.
                  associate (nodes => fem%mesh%nodes(:n, e))
                     call add_thermal_of(fem, [e], thermal)
                     force(:, :n, e) = force(:, :n, e) - thermal(:, nodes)
                     thermal(:, nodes) = 0.0_wp
                  end associate
               end if
               s = 0.0_wp
               do k = 1, n_given
                  s = s + corner(:, k)*x(k)
               end do
               call share_out(fem, sides, e, s, loads)
            end associate
         end do
      end subroutine take_class

   end subroutine take_elements

   !> The stresses at the corners of an element, as tractions on the first element of its sides.
   subroutine share_out(fem, sides, e, s, loads)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: s(12)                 !< s11, s22, s12 corner by corner [F/L]
      type(proof_loads_t), intent(inout) :: loads
      real(wp) :: n(2), ends(2, 2), t(2), weight
      integer(ip) :: i, j, k, side, corners(2), degree

      degree = ubound(loads%traction, 2, kind=ip)
      do k = 1, CORNERS_OF(fem%mesh%shape(e))
         side = abs(sides%of_element(k, e))
         if (all(loads%known(:, side))) cycle
         corners = [k, 1 + mod(k, CORNERS_OF(fem%mesh%shape(e)))]
         if (sides%of_element(k, e) < 0) corners = corners(2:1:-1)
         t = fem%mesh%x(:, sides%node(2, side)) - fem%mesh%x(:, sides%node(1, side))
         n = [t(2), -t(1)]/norm2(t)
         weight = merge(1.0_wp, 0.5_wp, sides%element(2, side) == 0)
         do i = 1, 2
            associate (j => 3*corners(i))
               ends(:, i) = weight*[s(j - 2)*n(1) + s(j)*n(2), s(j)*n(1) + s(j - 1)*n(2)]
            end associate
         end do
         do j = 0, degree
            associate (place => real(j, wp)/degree)
               where (.not. loads%known(:, side))
                  loads%traction(:, j, side) = loads%traction(:, j, side) + (1 - place)*ends(:, 1) + place*ends(:, 2)
               end where
            end associate
         end do
      end do
   end subroutine share_out

end module atrito_error_bound
