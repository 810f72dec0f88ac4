!> What has been found of a contact line that its loads do not change: a history keeps it as long as the bodies are factored.
module atrito_line_certificate
   use atrito_kinds, only: ip, wp
   use atrito_results, only: uniqueness_t
   use atrito_sparse_rows, only: sparse_rows_t
   implicit none (type, external)
   private
   public :: line_certificate_t, friction_form_t, NOT_ASKED

   integer(ip), parameter :: NOT_ASKED = -2

   !> The contact line as the certificates see it (atrito_friction_form); lower triangles of what is symmetric.
   type :: friction_form_t
      real(wp) :: nu = 0.0_wp                     !< the largest coefficient of friction; 0: none has friction
      integer(ip) :: n = 0                        !< normal forces, on the kernel of G'; the tangential ones follow
      real(wp), allocatable :: a(:, :)            !< (m, m) [L/F], both triangles
      type(sparse_rows_t) :: w                    !< W before the motions are left out: a row a tangential force
      real(wp), allocatable :: reflection(:, :)   !< (normal forces, motions left out) v of 1 - 2 v v'
      ! A without its tangential forces:
      logical :: is_definite = .false.            !< A_tt is, and the others are there
      real(wp), allocatable :: l(:, :)            !< (m - n, m - n) A_tt = L L', zeros above the diagonal
      real(wp), allocatable :: x(:, :)            !< (m - n, n) L^-1 A_tn
      real(wp), allocatable :: xx(:, :)           !< (n, n) X'X
   end type friction_form_t

   type :: line_certificate_t
      type(uniqueness_t) :: known                   !< for every load
      type(friction_form_t), allocatable :: form    !< while there are solutions to be judged by it
      real(wp), allocatable :: way(:)               !< (tangential unknowns) directions of slip; of elastic stick a state
      real(wp) :: way_up_to_nu = 0.0_wp             !< one solution at most moves that way at every point
      real(wp) :: alpha = 1.0_wp                    !< of that proof, or of every load: states are tried with it
      real(wp), allocatable :: ahead(:)             !< m of a state that is regular for more than nu: those near it are for nu
      logical :: looks_ahead = .true.               !< the last one of these has served
      ! The state that was met last, and what was found of it.
      integer(ip), allocatable :: state(:)          !< (m) of the unknowns
      real(wp), allocatable :: compliance(:)        !< [L/F]
      real(wp), allocatable :: share(:)             !< m of the tangential unknowns (atrito_one_solution)
      integer(ip) :: sign_of = NOT_ASKED            !< of its determinant
      real(wp) :: contraction = -1.0_wp             !< < 0: not estimated
   end type line_certificate_t

end module atrito_line_certificate
