!> Proofs that a contact line with friction has one solution, up to a coefficient of friction.
!>
!> Take two solutions for the same loads, and write d for the difference. Whatever eps, the gaps and the loads are, at every point
!>
!>     dq_n dr_n >= 0,        (dq_t - m db) du >= 0  for some m in [-1, 1],                   b = nu W q_n, u the slip,
!>
!> for t = clip(u/c, -b, b) grows with u, and changes by no more than b does; the product of a pressure and a gap vanishes at both.
!> With dr = -A dq on the forces that balance (atrito_friction_form) this gives, for any alpha > 0,
!>
!>     -dq' diag(alpha 1, 1) A dq = alpha dq_n'dr_n + dq_t'du >= -sum_j |db_j| |du_j|,
!>
!> and 2 |db_j| |du_j| <= nu (gamma (W dq_n)_j^2 + du_j^2/gamma), du = -A_t dq. So dq = 0 where, for some alpha and gamma > 0,
!>
!>     sym(diag(alpha 1, 1) A) - nu/2 (gamma W'W (+) 0 + A_t'A_t/gamma) > 0.
!>
!> The largest nu is looked for; up to it there is one solution for all loads, gaps and directions of slip. It falls as 1/sqrt(n)
!> with the number n of points where friction is local, and does not fall where the average S_rho keeps its rho (Oden and Pires).
!>
!> With exact stick, two solutions of which no point moves against directions S (1 or -1) that are given, the open points too, have
!> m = S_j in all points, and dq = 0 where sym(diag(alpha 1, 1) A [1 0; nu S W 1]) > 0: at most one solution moves that way
!> everywhere. That reaches further, since no point is taken to slip against its neighbours.
!>
!> What is certified is the discrete problem, of this mesh; beyond the coefficient there may be one solution all the same.
module atrito_one_solution
   use atrito_certificate_forms, only: build_certified, every_load_forms, forms_t, given_way_forms, pencil_t
   use atrito_certificate_search, only: certified_factor
   use atrito_dense_blocks, only: factor_in_blocks
   use atrito_kinds, only: ip, wp
   use atrito_line_certificate, only: friction_form_t
   implicit none (type, external)
   private
   public :: certify, is_regular, MOST

   real(wp), parameter :: MOST = 1.0e3_wp         !< what is certified up to here is not looked for beyond

contains

   !> The largest nu found up to which there is one solution, whatever the loads; 0 where there is none, the points depending on
   !> each other.
   !>
   !> With a direction the same for solutions that move along it, or not at all, at every point. Exact stick is presumed.
   subroutine certify(form, nu, alpha, direction)
      type(friction_form_t), intent(in) :: form
      real(wp), intent(out) :: nu
      real(wp), intent(out) :: alpha              !< of the proof
      real(wp), intent(in), optional :: direction(:) !< (tangential unknowns) 1 or -1, or what is_regular takes
      type(forms_t) :: forms
      type(pencil_t) :: pencil

      nu = 0.0_wp
      alpha = 1.0_wp
      if (.not. form%is_definite) return
      if (present(direction)) then
         call given_way_forms(form, direction, forms)
      else
         call every_load_forms(form, forms)
      end if
      call certified_factor(form, forms, MOST, nu, pencil)
      alpha = pencil%alpha
   end subroutine certify

   !> Whether a state is proved to be regular for this nu and all smaller ones, given one alpha to try it with.
   !>
   !> Where the state stands, the friction of a point changes by m times its bound: m is 1 or -1 where it slips, the share of the
   !> bound that an elastic slip has come to, or any number where it sticks. Then dr_n dq_n = 0 and (dq_t - m db) du >= 0 along
   !> all that a singular matrix leaves free, so dq = 0 by the same matrix as that of a way.
   logical function is_regular(form, share, nu, alpha)
      type(friction_form_t), intent(in) :: form
      real(wp), intent(in) :: share(:)            !< (tangential unknowns) m
      real(wp), intent(in) :: nu, alpha
      type(forms_t) :: forms
      real(wp), allocatable :: matrix(:, :)
      integer(ip) :: failed

      is_regular = .false.
      if (.not. form%is_definite) return
      forms%share = share
      call build_certified(form, forms, nu, pencil_t(alpha=alpha), matrix)
      call factor_in_blocks(matrix, failed)
      is_regular = failed == 0
   end function is_regular

end module atrito_one_solution
