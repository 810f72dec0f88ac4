!> The index of a solution: the sign of det M(nu)/det M(0), M the matrix of its state (atrito_newton) with the coefficient nu.
!>
!> Where every point is well inside its state the equations of the line are linear near the solution, with the matrix M, and the
!> solution is isolated where M is regular. At nu = 0 there is one solution, of index 1 (det M(0) > 0: A is positive definite on the
!> forces that balance). All solutions for coefficients from 0 to nu are bounded, where the motions of the bodies do not go along
!> the contact, and so the indices of those at nu add up to 1, too (degree of a map). A solution of index -1 therefore cannot be the
!> only one: there are two more at least, unless another one stands on the edge of its state or with a singular matrix, and then
!> one. An index of 1 says nothing. The price is one factorisation by LU.
module atrito_state_index
   use atrito_bound_qp, only: bound_qp_t, FREE, AT_LOWER
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_dense, only: sign_of_determinant
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_newton, only: jacobian_of_state
   implicit none (type, external)
   private
   public :: index_of_solution

   real(wp), parameter :: ON_THE_EDGE = 1.0e-7_wp !< of the largest pressure, bound or gap

contains

   !> 1 or -1; 0 where a point stands on the edge of its state, or the matrix is singular but for rounding.
   integer(ip) function index_of_solution(problem, line, solution, is_known) result(index_of)
      type(bound_qp_t), intent(in) :: problem     !< C and G
      type(contact_line_t), intent(in) :: line    !< points, laws, average S_rho
      type(contact_solution_t), intent(in) :: solution !< that has converged
      logical, intent(in) :: is_known             !< a certificate says that the determinant is positive
      real(wp), allocatable :: jacobian(:, :)
      logical, allocatable :: slips(:)

      index_of = 0
      if (.not. is_inside(problem, line, solution)) return
      index_of = 1
      if (is_known) return
      call jacobian_of_state(problem, line, solution, jacobian, slips)
      call eliminate(slips, jacobian)
      index_of = sign_of_determinant(jacobian)
   end function index_of_solution

   !> Takes slipping forces out of the matrix: their rows q -+ w tau = 0 have few entries, and a positive one on the diagonal.
   pure subroutine eliminate(slips, matrix)
      logical, intent(in) :: slips(:)             !< of the first rows
      real(wp), allocatable, intent(inout) :: matrix(:, :)
      integer(ip), allocatable :: left(:)
      integer(ip) :: i, j, n

      n = size(matrix, 1, kind=ip)
      do i = 1, size(slips, kind=ip)
         if (.not. slips(i)) cycle
         do j = 1, n
            if (j == i .or. abs(matrix(i, j)) <= 0.0_wp) cycle
            matrix(:, j) = matrix(:, j) - matrix(:, i)*(matrix(i, j)/matrix(i, i))
         end do
      end do
      left = [pack([(i, i=1, size(slips, kind=ip))],.not. slips), (i, i=size(slips, kind=ip) + 1, n)]
      matrix = matrix(left, left)
   end subroutine eliminate

   !> Whether no point is near another state: closed ones have pressure, open ones a gap, sticking ones friction left, slipping ones
   !> slip.
   pure logical function is_inside(problem, line, solution) result(inside)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(in) :: solution
      real(wp) :: least_gap, least_force
      integer(ip) :: i

      associate (state => solution%state%state, q => solution%state%q, r => solution%state%r, n => problem%n_normal)
         least_gap = ON_THE_EDGE*maxval([0.0_wp, abs(r), abs(problem%g0)])
         least_force = ON_THE_EDGE*maxval([0.0_wp, abs(q)/problem%weight])
         inside = .true.
         do i = 1, problem%m
            if (i <= n) then
               if (solution%bounds%lower(i) <= -HUGE_REAL) cycle
               if (state(i) == FREE) then
                  inside = q(i) > least_force*problem%weight(i)
               else
                  inside = r(i) < -least_gap
               end if
            else if (state(i) == FREE) then
               inside = abs(q(i)) < (1 - ON_THE_EDGE)*solution%bounds%upper(i)
            else if (solution%bounds%upper(i) > 0.0_wp) then
               inside = merge(-r(i), r(i), state(i) == AT_LOWER) > least_gap
            else                                  ! without a bound, as long as no point near it closes
               inside = line%normal(line%point(i)) > 0
            end if
            if (.not. inside) return
         end do
      end associate
   end function is_inside

end module atrito_state_index
