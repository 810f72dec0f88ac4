!> The index of a solution: the sign of det M(nu)/det M(0), M the matrix of its state (atrito_newton) with the coefficient nu.
!>
!> Where every point is well inside its state the equations of the line are linear near the solution, with the matrix M, and the
!> solution is isolated where M is regular. At nu = 0 there is one solution, of index 1 (det M(0) > 0: A is positive definite on the
!> forces that balance). All solutions for coefficients from 0 to nu are bounded, where the motions of the bodies do not go along
!> the contact, and so the indices of those at nu add up to 1, too (degree of a map). A solution of index -1 therefore cannot be the
!> only one: there are two more at least, unless another one stands on the edge of its state or with a singular matrix, and then
!> one. An index of 1 says nothing.
!>
!> Most states are proved to be regular down to nu = 0 by one Cholesky factor of a quarter of the matrix (is_regular); where that
!> fails M is factored by LU. A state that is met again has the sign that it had, and one that is near another needs no factor
!> (is_near).
module atrito_state_index
   use atrito_bound_qp, only: bound_qp_t, FREE, AT_LOWER, AT_UPPER
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_dense, only: sign_of_determinant
   use atrito_friction_law, only: FRICTION_NONLOCAL
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_line_certificate, only: line_certificate_t, NOT_ASKED
   use atrito_newton, only: jacobian_of_state
   use atrito_one_solution, only: certify, is_regular
   implicit none (type, external)
   private
   public :: index_of_solution, meet_state

   real(wp), parameter :: ON_THE_EDGE = 1.0e-7_wp !< of the largest pressure, bound or gap
   real(wp), parameter :: AHEAD = 2.0_wp          !< times nu for which a state is tried, that others may be near to it

contains

   !> 1 or -1; 0 where a point stands on the edge of its state, or the matrix is singular but for rounding.
   !>
   !>     1. points on the edge of their state: no index
   !>     2. the state was met before, or a certificate covers nu: its sign
   !>     3. one Cholesky factor proves that det M has no zero from 0 to nu: 1 (is_regular, then another alpha by certify)
   !>     4. det M itself: slipping forces are eliminated, whose rows are sparse; the rest by LU with its exchanges of rows
   integer(ip) function index_of_solution(problem, line, solution, is_known, certificate) result(index_of)
      type(bound_qp_t), intent(in) :: problem     !< C and G
      type(contact_line_t), intent(in) :: line    !< points, laws, average S_rho
      type(contact_solution_t), intent(in) :: solution !< that has converged
      logical, intent(in) :: is_known             !< a certificate says that the determinant is positive
      type(line_certificate_t), intent(inout) :: certificate !< that has met the state, with the form
      real(wp), allocatable :: jacobian(:, :)
      logical, allocatable :: slips(:)
      real(wp) :: up_to_nu

      index_of = 0
      if (.not. is_inside(problem, line, solution)) return
      if (is_known) certificate%sign_of = 1
      associate (nu => certificate%known%nu, share => certificate%share)
         if (certificate%sign_of == NOT_ASKED) then
            if (is_proved_ahead(certificate)) certificate%sign_of = 1
         end if
         if (certificate%sign_of == NOT_ASKED) then
            if (is_regular(certificate%form, share, nu, certificate%alpha)) certificate%sign_of = 1
         end if
         if (certificate%sign_of == NOT_ASKED .and. .not. allocated(certificate%way)) then
            certificate%way = share               ! elastic stick: an alpha that may serve states to come, too
            call certify(certificate%form, up_to_nu, certificate%alpha, share)
            if (up_to_nu >= nu) certificate%sign_of = 1
         end if
      end associate
      if (certificate%sign_of == NOT_ASKED) then
         call jacobian_of_state(problem, line, solution, jacobian, slips)
         call eliminate(slips, jacobian)
         certificate%sign_of = sign_of_determinant(jacobian)
      end if
      index_of = certificate%sign_of
   end function index_of_solution

   !> Whether the state is near one that was tried for more than nu; else the one that it is on its way to is tried, as far from it
   !> as it has come from where that one was. One that serves no other state was the last.
   logical function is_proved_ahead(certificate) result(is_proved)
      type(line_certificate_t), intent(inout) :: certificate

      is_proved = .false.
      if (allocated(certificate%way)) return      ! alpha is another
      associate (share => certificate%share, nu => certificate%known%nu)
         if (.not. allocated(certificate%ahead)) certificate%ahead = 0*share
         is_proved = is_near(certificate)
         if (.not. is_proved .and. certificate%looks_ahead) then
            certificate%ahead = max(-1.0_wp, min(1.0_wp, 2*share - certificate%ahead))
            if (.not. is_regular(certificate%form, certificate%ahead, AHEAD*nu, certificate%alpha)) certificate%ahead = 0*share
            certificate%looks_ahead = .false.
            is_proved = is_near(certificate)
         else
            certificate%looks_ahead = is_proved
         end if
      end associate
   end function is_proved_ahead

   !> Whether a state is regular because another one, m_1, is for AHEAD nu, with the alpha of every load. The certified matrix is
   !> H - nu R(m), R linear in m; H > AHEAD nu R(m_1), and H > up_to_nu R(m) where |m| <= 1, so for any t from 0 to 1
   !>
   !>     H - nu R(m) = H - t nu R(m_1) - nu R(m - t m_1) > (1 - t/AHEAD - nu max|m - t m_1|/up_to_nu) H.
   pure logical function is_near(certificate)
      type(line_certificate_t), intent(in) :: certificate
      real(wp) :: t

      associate (m => certificate%share, other => certificate%ahead)
         t = dot_product(m, other)/max(dot_product(other, other), tiny(t))
         t = max(0.0_wp, min(1.0_wp, t))
         is_near = certificate%known%nu*maxval(abs(m - t*other)) < (1 - t/AHEAD)*certificate%known%up_to_nu
      end associate
   end function is_near

   !> Makes the state of a solution the one that is asked about: what is known of it stays where it was that before.
   pure subroutine meet_state(problem, line, solution, certificate)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(in) :: solution
      type(line_certificate_t), intent(inout) :: certificate
      real(wp) :: share(problem%m - problem%n_normal)
      logical :: is_new
      integer(ip) :: i

      ! m of a state: by how much of its bound the friction of a point changes with it. 1 and -1 where it slips; q over the bound
      ! where it sticks elastically by the law of Oden and Pires, whose compliance falls with the bound; else 0.
      associate (n => problem%n_normal)
         share = merge(1.0_wp, 0.0_wp, solution%state%state(n + 1:) == AT_UPPER) &
                 - merge(1.0_wp, 0.0_wp, solution%state%state(n + 1:) == AT_LOWER)
         do i = n + 1, problem%m
            associate (j => line%point(i))
               if (solution%state%state(i) /= FREE .or. line%law(j)%kind /= FRICTION_NONLOCAL) cycle
               if (solution%bounds%d(i) > 0.0_wp) share(i - n) = solution%state%q(i)/(line%weight(j)*solution%tau(j))
            end associate
         end do
      end associate
      associate (state => solution%state%state, d => solution%bounds%d)
         is_new = .not. allocated(certificate%state)
         if (.not. is_new) is_new = any(certificate%state /= state) .or. any(abs(certificate%compliance - d) > 0.0_wp) &
                                    .or. any(abs(certificate%share - share) > 0.0_wp)
         if (.not. is_new) return
         certificate%state = state
         certificate%compliance = d
      end associate
      certificate%share = share
      certificate%sign_of = NOT_ASKED
      certificate%contraction = -1.0_wp
   end subroutine meet_state

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
               inside = merge(q(i) > least_force*problem%weight(i), r(i) < -least_gap, state(i) == FREE)
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
