!> Linear quantities of a solution that have a bound (--bound), and what is found of one.
!>
!> A displacement or a stress at a point is none of them: the force that belongs to it acts at a point, and its energy is infinite.
module atrito_linear_quantity
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: linear_quantity_t, linear_part_t, quantity_bound_t
   public :: POTENTIAL_ENERGY, PART_FACES, PART_VOLUME, PART_STRESS, PART_REACTION, PART_PAIR

   !> The mean of a displacement over faces or over elements, the mean of a stress over elements, a sum of reactions, the resultant
   !> of a pair.
   integer, parameter :: PART_FACES = 1, PART_VOLUME = 2, PART_STRESS = 3, PART_REACTION = 4, PART_PAIR = 5

   type :: linear_part_t
      integer :: kind = 0                           !< PART_*
      integer :: component = 0                      !< 1 or 2; of a stress s11, s22, s12; of a pair pressure, shear
      real(wp) :: factor = 0.0_wp                   !< in the quantity
      integer(ip), allocatable :: element(:), face(:) !< of PART_FACES both, of PART_VOLUME and PART_STRESS elements
      integer(ip), allocatable :: node(:)           !< of PART_REACTION
      integer(ip) :: pair = 0                       !< of PART_PAIR
   end type linear_part_t

   !> What --bound takes besides: it is not linear, and has bounds of another kind.
   character(len=*), parameter :: POTENTIAL_ENERGY = 'potential_energy'

   !> constant + sum of the parts.
   type :: linear_quantity_t
      character(len=:), allocatable :: name         !< of the observed quantity, or POTENTIAL_ENERGY
      real(wp) :: constant = 0.0_wp
      type(linear_part_t), allocatable :: parts(:)
   end type linear_quantity_t

   type :: quantity_bound_t
      character(len=32) :: name = ''
      logical :: exists = .false.
      logical :: is_certified = .false.             !< every step is proved; else the equilibrium is not exact enough
      logical :: is_of_states = .false.             !< of the contact states that were found; else of the solution itself
      logical :: is_of_friction = .false.           !< for the friction bound of the run
      real(wp) :: least = 0.0_wp, most = 0.0_wp
      character(len=96) :: why_not = ''             !< why it is not certified, or is not there
   end type quantity_bound_t

end module atrito_linear_quantity
