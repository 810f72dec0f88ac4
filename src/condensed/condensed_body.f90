!> A body reduced to its contact degrees of freedom.
!>
!> The bodies are elastic and meet at the contact line alone, so all that the contact problem has to know of a body is how its
!> contact dofs move under forces on them. With the stiffness K partitioned into the interior i and the contact dofs c, block
!> elimination of the interior (the solver's factor) leaves
!>
!>     S u_c = f_c - B' q,    S = K_cc - K_ci K_ii^-1 K_ic,    f_c = f at the contact dofs - K_ci K_ii^-1 f_i,
!>
!> the Schur complement and the reduced load; K_ii u_i = f_i - K_ic u_c gives the interior afterwards (`expand_body`).
!>
!> A body that its supports hold has a positive definite S and moves by u_c = F (f_c - B' q), F = S^-1. One that they leave free,
!> with the rigid motions Z, has a singular S: with Q an orthonormal basis of Z at the contact dofs, F = (S + alpha Q Q')^-1, and
!> the body moves by that and any rigid motion Z a. The forces on it balance, Z' (f - B' q) = 0, so Q' (f_c - B' q) = 0: alpha has
!> no part in the answer, and F is as good as any generalised inverse. alpha = trace(S)/n gives the motions a stiffness of the
!> usual size.
!>
!> S or S + alpha Q Q' is kept as its Cholesky factor of n_retained^2 numbers. What is asked of it is F times forces
!> (`contact_response`) and the flexibility C = B F B' of all points (`add_flexibilities`). A pivot that is round-off, of the
!> interior or of S, means that a part of the body moves by itself: STATUS_SINGULAR, told with its node.
module atrito_condensed_body
   use atrito_assembly, only: fem_t, body_profile, assemble_body, retained_diagonal
   use atrito_bodies, only: order_by_dissection
   use atrito_body_cost, only: choose_solver, kept_bytes
   use atrito_body_motions, only: motion_text
   use atrito_dense, only: solve_cholesky, orthonormalise, add_product
   use atrito_dense_blocks, only: add_inverse_form, factor_in_blocks
   use atrito_hourglass, only: free_hourglass
   use atrito_kinds, only: ip, wp
   use atrito_profile, only: profile_t, begin_profile
   use atrito_row_entries, only: modes_at_node
   use atrito_results, only: body_result_t
   use atrito_solver_choice, only: new_solver, SOLVER_SPARSE
   use atrito_status, only: status_t, set_status, is_ok, STATUS_INTERNAL, STATUS_SINGULAR
   use atrito_linear_solver, only: linear_solver_t, smallest_ratio
   use atrito_strings, only: to_text
   use atrito_threads, only: is_shared
   use atrito_timers, only: start_phase, stop_phase
   implicit none (type, external)
   private
   public :: condensed_body_t, condense_body, set_load, contact_response, add_flexibilities, expand_body, check_held, &
             hourglass_text, loose_text

   type :: condensed_body_t
      class(linear_solver_t), allocatable :: solver !< factors of the interior, contact dofs last; S from it
      real(wp), allocatable :: factor(:, :)        !< (n_retained, n_retained) Cholesky factor of S or S + alpha Q Q'
      real(wp), allocatable :: load(:, :)          !< (n, 1) reduced load: half-solved interior, then f_c
      logical :: is_near = .false.                 !< some elements have the stiffness of one that they are near to, and not equal
   end type condensed_body_t

contains

   !> Assembles, factors and condenses a body, by the solver that was chosen for `result` or that is chosen now.
   !>
   !> status: STATUS_SINGULAR with the body, node and motion in words; STATUS_INTERNAL when the memory does not suffice.
   !>
   !> 1. A profile, for the skyline and the band, or an order of elimination by nested dissection, for the sparse solver: contact
   !> dofs last. 2. Assembly of K. 3. Factor of the interior; the solver hands over S (get_schur), from which the factor of F^-1 is
   !> made.
   subroutine condense_body(fem, i_body, asked, body, result, status)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: i_body !< its number in fem%bodies
      integer, intent(in) :: asked                 !< STORAGE_* or 0
      type(condensed_body_t), intent(out) :: body  !< factored; its load is not set
      type(body_result_t), intent(inout) :: result !< solver asked for in, measured memory and pivots out
      type(status_t), intent(out) :: status        !< STATUS_SINGULAR with body, node and motion; STATUS_INTERNAL: no memory
      type(profile_t) :: profile

      ! a body that nothing holds and no point touches has no solution
      call check_held(fem, i_body, status)
      if (.not. is_ok(status)) return
      call start_phase('order')
      if (result%solver_kind < SOLVER_SPARSE) then
         call body_profile(fem, i_body, profile)
         if (result%solver_kind == 0) call choose_solver(profile, asked, result)
      end if
      if (result%solver_kind >= SOLVER_SPARSE) then
         call begin_profile(profile, fem%bodies%list(i_body)%n, fem%bodies%list(i_body)%n_retained)
         call order_by_dissection(fem%mesh, fem%bodies, i_body, profile%elimination)
         result%order = profile%elimination%text
      end if
      call stop_phase('order')
      call new_solver(result%solver_kind, body%solver)
      call start_phase('assemble')
      call body%solver%create(profile, status)
      ! fronts alone are the fewer for elements that are taken as equal
      if (is_ok(status)) call assemble_body(fem, i_body, body%solver, &
                                            merge(fem%digit_error, 0.0_wp, result%solver_kind == SOLVER_SPARSE), body%is_near)
      call stop_phase('assemble')
      if (.not. is_ok(status)) return
      call start_phase('factor')
      call factor_body(fem, i_body, body, result, status)
      call stop_phase('factor')
   end subroutine condense_body

   !> A body that can move, or take a shape without strain, and that no contact point touches: status is STATUS_SINGULAR.
   !>
   !> A body that contact points touch may be held by them: that is known when the line is solved.
   subroutine check_held(fem, i_body, status)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: i_body !< its number in fem%bodies
      type(status_t), intent(inout) :: status !< unchanged where the body is held; else STATUS_SINGULAR

      if (fem%bodies%list(i_body)%n_retained > 0 .or. fem%bodies%list(i_body)%is_touched) return
      if (size(fem%bodies%list(i_body)%modes, 2) == 0) then
         if (len(hourglass_text(fem, i_body)) > 0) call set_status(status, STATUS_SINGULAR, hourglass_text(fem, i_body))
         return
      end if
      call set_status(status, STATUS_SINGULAR, motion_text(fem, i_body, fem%bodies%list(i_body)%modes(:, 1)) &
                      //'; no support and no contact pair holds it')
   end subroutine check_held

   !> Why a body has no stiffness at a node.
   function loose_text(fem, i_body, what, node, dof) result(text)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      character(len=*), intent(in) :: what         !< was found
      integer(ip), intent(in) :: node, dof         !< node: the user's number
      character(len=:), allocatable :: text

      text = hourglass_text(fem, i_body)
   if (len(text) == 0) text = 'body '//fem%bodies%list(i_body)%name//': '//what//', node '//to_text(node)//' dof '//to_text(dof)// &
                                 ': a part of the body can move by itself there (elements joined at one node only, or distorted)'
   end function loose_text

   !> That a body can take a shape that costs nothing, and what to do; '' where its supports prevent it.
   function hourglass_text(fem, i_body) result(text)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      character(len=:), allocatable :: text
      integer(ip) :: element

      text = ''
      element = free_hourglass(fem, fem%bodies%list(i_body))
      if (element > 0) text = 'body '//fem%bodies%list(i_body)%name//': element '//to_text(element)//' can take a shape that '// &
                              'strains none of its points, an hourglass of reduced integration, which no support and no other '// &
                              'element prevents; full integration (CPE8, CPS8, CAX8) does, or more elements'
   end function hourglass_text

   !> Factors and condenses a body whose solver has its matrix. status: as condense_body.
   subroutine factor_body(fem, i_body, body, result, status)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      type(condensed_body_t), intent(inout) :: body
      type(body_result_t), intent(inout) :: result
      type(status_t), intent(out) :: status

      call body%solver%factor(status)
      if (status%code == STATUS_INTERNAL) return
      result%digits_lost = body%solver%report%digits_lost
      result%sign_changes = body%solver%report%sign_changes
      if (body%solver%report%worst_equation > 0) call name_equation(fem, i_body, body%solver%report%worst_equation, result)
      call report_fronts(body%solver, result)
      if (.not. is_ok(status)) then
         call set_status(status, STATUS_SINGULAR, loose_text(fem, i_body, status%text, result%worst_node, result%worst_dof))
         return
      end if
      call factor_contact()
      if (is_ok(status)) call report_contact_pivots()

   contains

      !> The contact dofs are eliminated last, by the Cholesky factor; digits that their pivots lose count like those of the
      !> interior, and a pivot that is round-off alone there is none here. status: STATUS_SINGULAR then.
      !>
      !> The digits that an elimination loses at a pivot are log10(K_jj / pivot), the pivot being L_jj^2: what is left of the
      !> diagonal after all others were eliminated.
      subroutine report_contact_pivots()
         real(wp) :: original(size(body%factor, 1)), lost
         integer(ip) :: i, first

         if (size(original) == 0) return
         first = fem%bodies%list(i_body)%n - fem%bodies%list(i_body)%n_retained
         call retained_diagonal(fem, i_body, original)
         do i = 1, size(original, kind=ip)
            lost = log10(original(i)/body%factor(i, i)**2)
            if (lost <= result%digits_lost) cycle
            result%digits_lost = lost
            call name_equation(fem, i_body, first + i, result)
         end do
         if (10.0_wp**(-result%digits_lost) > smallest_ratio(fem%bodies%list(i_body)%n)) return
         if (len(hourglass_text(fem, i_body)) > 0) then
            call set_status(status, STATUS_SINGULAR, hourglass_text(fem, i_body))
            return
         end if
         call set_status(status, STATUS_SINGULAR, 'body '//fem%bodies%list(i_body)%name//': its stiffness seen from the contact' &
                         //' line is round-off alone at node '//to_text(result%worst_node)//' dof '//to_text(result%worst_dof) &
                         //': it is too slender, or hardly held')
      end subroutine report_contact_pivots

      !> Cholesky factor of the Schur complement; for a floating body with alpha Q Q' added, alpha = trace(S)/n.
      !>
      !> S of a floating body is singular on the rigid motions at its contact dofs. Q is an orthonormal basis of them: fewer than
      !> the motions where one contact dof alone is there, which two motions move alike. orthonormalise finds how many there are.
      !>
      !>     1. S = K_cc - K_ci K_ii^-1 K_ic, which the solver of the interior hands over; order n, a full matrix
      !>     2. z, the rigid motions at the contact dofs, made orthonormal: q, of as many columns as are independent there
      !>     3. S + alpha q q', regular, as S is positive on all that is no rigid motion
      !>     4. its Cholesky factor, n^3/3 operations
      !>
      !> A load in balance has no part along q, and the answer to it none that alpha makes: (S + alpha q q')^-1 f solves S u = f.
      subroutine factor_contact()
         real(wp), allocatable :: q(:, :), qs(:, :)
         real(wp) :: alpha
         integer(ip) :: n, i, n_independent, failed, info

         n = fem%bodies%list(i_body)%n_retained
         allocate (body%factor(n, n))
         if (n == 0) return
         call body%solver%get_schur(body%factor)
         if (size(fem%bodies%list(i_body)%modes, 2) > 0) then
            ! a stiffness of the usual size for the motions, in which the forces balance
            alpha = sum([(body%factor(i, i)/n, i=1, n)])
            q = modes_at_contact(fem, i_body)
            call orthonormalise(q, n_independent, 1.0e-12_wp, info)
            qs = alpha*q(:, :n_independent)
            call add_product(q(:, :n_independent), qs, body%factor)
         end if
         call factor_in_blocks(body%factor, failed)
         if (failed == 0) return
         call set_status(status, STATUS_SINGULAR, 'body '//fem%bodies%list(i_body)%name &
                         //': its stiffness seen from the contact line is not positive: a part of it can move by itself')
      end subroutine factor_contact

   end subroutine factor_body

   !> What the sparse solver holds in fact, in place of what was predicted for it.
   !>
   !> Equal fronts are held once, so a regular mesh takes less than was predicted.
   subroutine report_fronts(solver, result)
      class(linear_solver_t), intent(in) :: solver
      type(body_result_t), intent(inout) :: result

      result%n_fronts = solver%report%n_fronts
      result%n_different_fronts = solver%report%n_different
      if (solver%report%n_fronts == 0) return
      result%profile = solver%report%entries
      result%memory = solver%memory_bytes() + kept_bytes(solver%n_retained)
      result%most_memory = max(result%memory, solver%report%most_bytes)
   end subroutine report_fronts

   subroutine name_equation(fem, i_body, equation, result)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body, equation
      type(body_result_t), intent(inout) :: result
      integer(ip) :: i, dof

      associate (body => fem%bodies%list(i_body))
         do i = 1, size(body%nodes, kind=ip)
            do dof = 1, 2
               if (fem%bodies%equation(dof, body%nodes(i)) /= equation) cycle
               result%worst_node = fem%mesh%node_id(body%nodes(i))
               result%worst_dof = dof
            end do
         end do
      end associate
   end subroutine name_equation

   !> The rigid motions at the contact dofs, (n_retained, n_modes).
   !>
   !> Z restricted to the contact dofs, from which Q is made.
   function modes_at_contact(fem, i_body) result(z)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      real(wp), allocatable :: z(:, :)
      real(wp) :: at_node(2, 3)
      integer(ip) :: i, dof

      associate (body => fem%bodies%list(i_body))
         allocate (z(body%n_retained, size(body%modes, 2)))
         do i = 1, size(body%nodes, kind=ip)
            associate (dofs => fem%bodies%equation(:, body%nodes(i)) - (body%n - body%n_retained))
               if (all(dofs <= 0)) cycle
               at_node = modes_at_node(fem, i_body, body%nodes(i))
               do dof = 1, 2
                  if (dofs(dof) > 0) z(dofs(dof), :) = at_node(dof, :size(z, 2))
               end do
            end associate
         end do
      end associate
   end function modes_at_contact

   !> Takes the load of the free dofs, applied forces less the forces of prescribed displacements.
   !>
   !> reduce is the forward half of the solution: L y = f in the interior, f_c - K_ci K_ii^-1 f_i at the contact dofs behind it.
   subroutine set_load(fem, i_body, f, body)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: i_body !< its number in fem%bodies
      real(wp), intent(in) :: f(:, :)              !< (2, n_nodes) [F]
      type(condensed_body_t), intent(inout) :: body !< factored; its load is replaced
      integer(ip) :: i, dof, equation

      associate (list => fem%bodies%list(i_body))
         if (allocated(body%load)) deallocate (body%load)
         allocate (body%load(list%n, 1))
         !$omp parallel do default(shared) private(dof, equation) if(is_shared(size(list%nodes, kind=ip)))
         do i = 1, size(list%nodes, kind=ip)
            do dof = 1, 2
               equation = fem%bodies%equation(dof, list%nodes(i))
               if (equation > 0) body%load(equation, 1) = f(dof, list%nodes(i))
            end do
         end do
         !$omp end parallel do
      end associate
      call body%solver%reduce(body%load)
   end subroutine set_load

   !> F times forces at the contact dofs, in place.
   subroutine contact_response(body, x)
      type(condensed_body_t), intent(in) :: body !< factored
      real(wp), intent(inout), contiguous :: x(:, :) !< (n_retained, loads): forces [F] in, displacements [L] out

      call solve_cholesky(body%factor, x)
   end subroutine contact_response

   !> Adds B F B' to C for rows B on the contact dofs.
   subroutine add_flexibilities(body, forces, first, place, c)
      type(condensed_body_t), intent(in) :: body !< factored
      real(wp), intent(inout), contiguous :: forces(:, :) !< (n_retained, rows) B'; destroyed
      integer(ip), intent(in) :: first(:)          !< (rows) first entry of each that is not zero, ascending
      integer(ip), intent(in) :: place(:)          !< (rows) of each in C
      real(wp), intent(inout), contiguous :: c(:, :) !< [L/F]

      call add_inverse_form(body%factor, forces, first, place, c)
   end subroutine add_flexibilities

   !> Displacements of all free dofs from those of the contact dofs; without any, the plain solution.
   !>
   !> The backward half: the interior from y and the displacements of the contact dofs.
   subroutine expand_body(fem, i_body, body, u_contact, u)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: i_body !< its number in fem%bodies
      type(condensed_body_t), intent(in) :: body !< factored
      real(wp), intent(in) :: u_contact(:)         !< (n_retained) [L]
      real(wp), intent(inout) :: u(:, :)           !< (2, n_nodes) [L]: the free dofs of this body are set
      real(wp), allocatable :: x(:, :)
      integer(ip) :: i, dof, equation

      associate (list => fem%bodies%list(i_body))
         x = body%load
         x(list%n - list%n_retained + 1:, 1) = u_contact
         call body%solver%expand(x)
         !$omp parallel do default(shared) private(dof, equation) if(is_shared(size(list%nodes, kind=ip)))
         do i = 1, size(list%nodes, kind=ip)
            do dof = 1, 2
               equation = fem%bodies%equation(dof, list%nodes(i))
               if (equation > 0) u(dof, list%nodes(i)) = x(equation, 1)
            end do
         end do
         !$omp end parallel do
      end associate
   end subroutine expand_body

end module atrito_condensed_body
