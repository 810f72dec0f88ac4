!> What the body solvers have in common: a symmetric positive definite matrix with retained equations.
!>
!> The last n_retained equations (contact, index c) are kept, the others (interior, index i) are eliminated:
!>
!>     S = K_cc - K_ci K_ii^-1 K_ic                                                (condensation, docs/theory)
!>
!> It comes from K_ii x_i + K_ic x_c = f_i, from which x_i is eliminated; what is left for the contact unknowns is
!>
!>     S x_c = f_c - K_ci K_ii^-1 f_i,      and then      x_i = K_ii^-1 (f_i - K_ic x_c).
!>
!> S is full, symmetric and positive semidefinite: singular where supports leave the body a motion. It is far smaller than K, and
!> all iterations of the contact problem work on it; K_ii is factored once.
!>
!> Two springs in a row, k_1 from the ground to a node and k_2 from there to the contact, have
!>
!>     K_ii = k_1 + k_2,   K_ic = -k_2,   K_cc = k_2,        S = k_2 - k_2^2/(k_1 + k_2) = k_1 k_2/(k_1 + k_2):
!>
!> S is what the contact feels of the body, here of the springs one behind the other. A column of S is the forces at the contact
!> when one of its unknowns is moved by 1, the others are held, and the interior is free.
!>
!> Use: create, add every element matrix (one by one, or all in a store), factor; then get_schur, and for every load reduce, find
!> x_c, expand. Without retained equations reduce followed by expand solves K x = f.
module atrito_linear_solver
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: element_store_t, unpack_matrix, smallest_ratio
   use atrito_profile, only: profile_t
   use atrito_status, only: status_t, set_status, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: linear_solver_t, factor_report_t, add_one_by_one, note_pivot, set_pivot_status, smallest_ratio, ALL_DIGITS

   !> What a factorisation tells.
   type :: factor_report_t
      real(wp) :: digits_lost = 0.0_wp      !< log10 of the worst ratio of original diagonal to pivot, 0..16
      integer(ip) :: worst_equation = 0     !< its equation, or the one that failed; 0 when nothing was eliminated
      integer(ip) :: sign_changes = 0       !< negative pivots (banded stops at the first)
      real(wp) :: smallest_pivot = 0.0_wp   !< [of the matrix]
      real(wp) :: largest_pivot = 0.0_wp    !< [of the matrix]
      integer(ip) :: n_fronts = 0           !< of the sparse solver; 0: no fronts
      integer(ip) :: n_different = 0        !< of them: these are factored
      integer(lp) :: entries = 0            !< of their factors
      integer(lp) :: most_bytes = 0         !< that the factorisation takes for a while
   end type factor_report_t

   type, abstract :: linear_solver_t
      integer(ip) :: n = 0                  !< equations
      integer(ip) :: n_retained = 0             !< the last n_retained are kept
      type(factor_report_t) :: report        !< of the last call of factor
   contains
      procedure(create_solver), deferred :: create
      procedure(add_matrix), deferred :: add
      procedure :: add_store => add_one_by_one
      procedure(factor_interior), deferred :: factor
      procedure(get_schur_complement), deferred :: get_schur
      procedure(reduce_load), deferred :: reduce
      procedure(expand_solution), deferred :: expand
      procedure(count_bytes), deferred :: memory_bytes
   end type linear_solver_t

   abstract interface

      !> Makes room for a zero matrix of the profile. status: STATUS_INTERNAL when the memory is too small.
      subroutine create_solver(self, profile, status)
         import :: linear_solver_t, profile_t, status_t
         class(linear_solver_t), intent(inout) :: self    !< what it held is given up
         type(profile_t), intent(in) :: profile           !< closed
         type(status_t), intent(out) :: status            !< OK, or as above
      end subroutine create_solver

      !> Adds an element matrix.
      subroutine add_matrix(self, equations, matrix)
         import :: linear_solver_t, ip, wp
         class(linear_solver_t), intent(inout) :: self    !< created, not yet factored
         integer(ip), intent(in) :: equations(:)          !< equation numbers; 0 = prescribed, skipped
         real(wp), intent(in) :: matrix(:, :)             !< symmetric, (size(equations), size(equations))
      end subroutine add_matrix

      !> Factors K_ii and forms S, in place. status: STATUS_SINGULAR when K_ii is singular or indefinite; `report` then names
      !> the equation, and the matrix is lost. STATUS_INTERNAL when the memory is too small.
      subroutine factor_interior(self, status)
         import :: linear_solver_t, status_t
         class(linear_solver_t), intent(inout) :: self !< all matrices added; holds the factor on return
         type(status_t), intent(out) :: status         !< OK, or as above
      end subroutine factor_interior

      !> The Schur complement, both triangles; after factor.
      subroutine get_schur_complement(self, schur)
         import :: linear_solver_t, wp
         class(linear_solver_t), intent(in) :: self       !< factored
         real(wp), intent(out) :: schur(:, :)             !< (n_retained, n_retained)
      end subroutine get_schur_complement

      !> f_c <- f_c - K_ci K_ii^-1 f_i; f_i <- the half-solved part that expand wants. After factor.
      subroutine reduce_load(self, f)
         import :: linear_solver_t, wp
         class(linear_solver_t), intent(in) :: self       !< factored
         real(wp), intent(inout), contiguous :: f(:, :)   !< (n, loads)
      end subroutine reduce_load

      !> x_i <- K_ii^-1 (f_i - K_ic x_c), with f_i as reduce left it and x_c given.
      subroutine expand_solution(self, x)
         import :: linear_solver_t, wp
         class(linear_solver_t), intent(in) :: self       !< factored
         real(wp), intent(inout), contiguous :: x(:, :)   !< (n, loads): f_i above, x_c below
      end subroutine expand_solution

      !> Memory held [bytes].
      pure integer(lp) function count_bytes(self)
         import :: linear_solver_t, lp
         class(linear_solver_t), intent(in) :: self !< 0 before create
      end function count_bytes

   end interface

   !> Digits of a double: the loss reported for a zero pivot.
   real(wp), parameter :: ALL_DIGITS = 16.0_wp

contains

   !> Adds the matrices of a store, in their order. Elements that follow one another and have one matrix in common get it unpacked
   !> once. The solver may empty the store.
   subroutine add_one_by_one(self, store)
      class(linear_solver_t), intent(inout) :: self !< created, not yet factored
      type(element_store_t), intent(inout) :: store !< each matrix with its equations; 0 there is skipped
      real(wp), allocatable :: matrix(:, :)
      integer(ip) :: e, m, n, held

      held = 0
      do e = 1, store%n
         n = int(store%start(e + 1) - store%start(e), ip)
         m = store%matrix_of(e)
         if (m /= held) then
            if (allocated(matrix)) then
               if (size(matrix, 1) /= n) deallocate (matrix)
            end if
            if (.not. allocated(matrix)) allocate (matrix(n, n))
            call unpack_matrix(store%values(store%matrix_start(m) + 1:store%matrix_start(m + 1)), matrix)
            held = m
         end if
         call self%add(store%equations(store%start(e) + 1:store%start(e + 1)), matrix)
      end do
   end subroutine add_one_by_one

   !> Enters a pivot into the report.
   !>
   !> The elimination takes positive numbers off a diagonal k_jj until the pivot d_j is left; the numbers have errors of eps k_jj,
   !> so the pivot has lost log10(k_jj/d_j) digits. The worst of all pivots is about what the solution loses: it is a lower bound of
   !> the condition of the matrix that is scaled to a unit diagonal.
   !>
   !> `usable` is false for a pivot that must not be divided by: one that is round-off, at most max(n eps, 1e-15) of its original
   !> diagonal. A pivot clearly below zero is counted and can be used.
   pure subroutine note_pivot(report, equation, n, original, pivot, usable)
      type(factor_report_t), intent(inout) :: report !< the pivot is counted in
      integer(ip), intent(in) :: equation            !< 1..n
      integer(ip), intent(in) :: n                   !< order of the matrix
      real(wp), intent(in) :: original               !< diagonal before the elimination
      real(wp), intent(in) :: pivot                  !< diagonal after it
      logical, intent(out) :: usable                 !< false where the pivot is round-off: stop
      real(wp) :: tolerance, lost

      tolerance = smallest_ratio(n)
      usable = abs(pivot) > tolerance*abs(original)
      lost = ALL_DIGITS
      if (usable) lost = max(log10(abs(original/pivot) + tiny(pivot)), 0.0_wp)
      if (report%worst_equation == 0) then
         report%smallest_pivot = pivot
         report%largest_pivot = pivot
      end if
      report%smallest_pivot = min(report%smallest_pivot, pivot)
      report%largest_pivot = max(report%largest_pivot, pivot)
      if (usable .and. pivot < 0.0_wp) report%sign_changes = report%sign_changes + 1
      if (is_worse()) report%worst_equation = equation
      report%digits_lost = max(report%digits_lost, lost)

   contains

      !> The first negative pivot is the one to name; until then the one that lost most.
      pure logical function is_worse()
         is_worse = report%worst_equation == 0 .or. lost > report%digits_lost
         if (report%sign_changes > 0) is_worse = usable .and. pivot < 0.0_wp .and. report%sign_changes == 1
      end function is_worse

   end subroutine note_pivot

   !> The status of a factorisation that stopped (`stopped`) or went on over negative pivots.
   pure subroutine set_pivot_status(report, stopped, status)
      type(factor_report_t), intent(in) :: report !< of all pivots so far
      logical, intent(in) :: stopped              !< at a pivot that was not usable
      type(status_t), intent(out) :: status       !< STATUS_SINGULAR with the equation; OK where neither is so

      if (report%sign_changes > 0) then
         call set_status(status, STATUS_SINGULAR, 'the matrix is singular or indefinite: negative pivot at equation ' &
                         //to_text(report%worst_equation))
      else if (stopped) then
         call set_status(status, STATUS_SINGULAR, 'the matrix is singular: no pivot left at equation ' &
                         //to_text(report%worst_equation))
      end if
   end subroutine set_pivot_status

end module atrito_linear_solver
