!> What one linear solve of a scene costs: filled by atrito_limit, printed by atrito_limit_page.
module atrito_limit_result
   use atrito_kinds, only: ip, lp, wp
   use atrito_timers, only: phase_time_t
   implicit none (type, external)
   private
   public :: limit_t, LIMIT_PARTS

   character(len=8), parameter :: LIMIT_PARTS(4) = ['assemble', 'analyse ', 'factor  ', 'solve   ']

   type :: limit_t
      integer(ip) :: n_equations = 0
      integer(ip) :: n_glued = 0                    !< nodes that became one with another
      integer(ip) :: n_held = 0                     !< nodes held along the normal of a rigid surface, or altogether
      integer(lp) :: entries = 0, factor_entries = 0 !< of the lower triangle of the matrix, and of the factor
      integer(lp) :: memory = 0                     !< bytes that MUMPS took, the matrix not counted
      real(wp) :: operations = 0.0_wp               !< floating-point, of the factorisation
      character(len=:), allocatable :: order        !< of the nodes, in words, by which equations were numbered
      type(phase_time_t) :: parts(size(LIMIT_PARTS))
      real(wp), allocatable :: u(:, :)              !< (2, n_nodes) [L] displacements of the glued bodies
   end type limit_t

end module atrito_limit_result
