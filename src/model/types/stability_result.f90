!> What `atrito limit` found: from where on a scene does not stand, the values that were looked at, and the mechanism.
module atrito_stability_result
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: stability_t, stability_value_t, collapse_t, CODE_NOT_RUN

   !> Instead of an exit code: the loads can be balanced, and no run was made.
   integer, parameter :: CODE_NOT_RUN = -1

   !> A value of the parameter.
   type :: stability_value_t
      real(wp) :: value = 0.0_wp                    !< of the parameter
      integer :: code = CODE_NOT_RUN                !< of the run: 0, 3 or 4; 4 also where the balance alone proves it
      real(wp) :: excess = 0.0_wp                   !< work that the contact cannot take, over that of the loads; nan: undecided
      real(wp) :: displacement = 0.0_wp             !< that is watched [L]; nan without a run
      integer(ip) :: iterations = 0, solves = 0     !< outer iterations and linear solves of the run
      integer(ip) :: factorisations = 0             !< of bodies
      real(wp) :: large(3) = 0.0_wp                 !< strain, rotation and slip beyond what a linear theory knows; 0: within
      real(wp), allocatable :: observed(:)          !< not allocated: no run was made
   end type stability_value_t

   !> The motion that a scene cannot resist.
   type :: collapse_t
      character(len=:), allocatable :: text         !< which bodies move how, in a sentence
      integer(ip), allocatable :: bodies(:)         !< that move, the fastest first
      type(string_t), allocatable :: names(:)       !< of these
      real(wp), allocatable :: centre(:, :)         !< (2, bodies) [L]
      real(wp), allocatable :: motion(:, :)         !< (3, bodies) translations of the centre [L], rotation [1]
      real(wp), allocatable :: u(:, :)              !< (2, n_nodes) [L], the largest is one
   end type collapse_t

   !> What a search for a limit asks and finds.
   type :: stability_t
      character(len=:), allocatable :: parameter    !< that varies
      real(wp) :: ends(2) = 0.0_wp, tolerance = 0.0_wp !< between which the limit is looked for, and its relative width
      character(len=:), allocatable :: watched      !< 'largest displacement', 'u1 of node 12'
      real(wp) :: stands = 0.0_wp, falls = 0.0_wp   !< the limit lies between them
      real(wp) :: balanced = 0.0_wp                 !< nearest to `falls` whose loads can be balanced
      logical :: is_close = .false.                 !< they are as close as the tolerance asks
      character(len=:), allocatable :: gaps         !< which points count in the balance although they are apart; '': none
      type(stability_value_t), allocatable :: values(:) !< in their order
      type(string_t), allocatable :: observed(:)    !< names of what is
      type(collapse_t) :: collapse                  !< at `falls`
   end type stability_t

end module atrito_stability_result
