!> What stands for a number of the solution in an expression of --observe, and how that is found in the results.
module atrito_observed_terms
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_results, only: contact_result_t, results_t
   use atrito_summary, only: pair_quantities, pair_summary_t, quantity_t, scales_t, step_quantities, summarise_pair
   implicit none (type, external)
   private
   public :: term_t, value_of_term, pair_quantity_list, step_quantity_list
   public :: TERM_NODES, TERM_POINTS, TERM_PAIR, TERM_STEP, TERM_TIME
   public :: TAKE_ONE, TAKE_SUM, TAKE_MEAN, TAKE_LEAST, TAKE_LARGEST
   public :: NODAL_FIELDS, POINT_FIELDS, FIRST_STRESS, FIRST_FORCE

   integer, parameter :: TERM_NODES = 1, TERM_POINTS = 2  !< a field of nodes, of contact points
   integer, parameter :: TERM_PAIR = 3, TERM_STEP = 4     !< a quantity of summary.tab
   integer, parameter :: TERM_TIME = 5                    !< of the history
   integer, parameter :: TAKE_ONE = 1, TAKE_SUM = 2, TAKE_MEAN = 3, TAKE_LEAST = 4, TAKE_LARGEST = 5

   character(len=5), parameter :: NODAL_FIELDS(10) = ['u1   ', 'u2   ', 'u    ', 's11  ', 's22  ', 's33  ', 's12  ', 'mises', &
                                                      'rf1  ', 'rf2  ']
   integer, parameter :: FIRST_STRESS = 4, FIRST_FORCE = 9 !< in NODAL_FIELDS: five of results%nodal_stress, two reactions
   character(len=17), parameter :: POINT_FIELDS(5) = ['pressure         ', 'weighted_pressure', 'shear            ', &
                                                      'slip             ', 'gap              ']

   type :: term_t
      integer :: kind = TERM_TIME
      integer :: field = 0                           !< place in NODAL_FIELDS or POINT_FIELDS, or among the quantities
      integer :: take = TAKE_ONE                     !< what of the values of a field
      integer(ip), allocatable :: nodes(:)           !< places of nodes
      real(wp), allocatable :: weights(:)            !< of theirs in a mean; their sum is 1
      integer(ip) :: pair = 0
   end type term_t

contains

   !> The value of a term; nan where it has none, as without pressure.
   pure real(wp) function value_of_term(term, results) result(value)
      type(term_t), intent(in) :: term
      type(results_t), intent(in) :: results         !< complete where a stress is asked for
      type(quantity_t), allocatable :: list(:)

      select case (term%kind)
      case (TERM_NODES)
         value = taken(nodal_values(term, results), term%weights, term%take)
      case (TERM_POINTS)
         associate (contact => results%contact(term%pair))
            value = taken(point_values(term%field, contact), contact%weight(:contact%n)/sum(contact%weight(:contact%n)), term%take)
         end associate
      case (TERM_PAIR)
         list = pair_quantities(summarise_pair(results%contact(term%pair)), scales_t())
         value = list(term%field)%value
      case (TERM_STEP)
         list = step_quantities(results)
         value = list(term%field)%value
      case default
         value = results%time
      end select
   end function value_of_term

   pure function nodal_values(term, results) result(values)
      type(term_t), intent(in) :: term
      type(results_t), intent(in) :: results
      real(wp) :: values(size(term%nodes))

      associate (i => term%field, nodes => term%nodes)
         if (i >= FIRST_FORCE) then
            values = results%reaction(i - FIRST_FORCE + 1, nodes)
         else if (i >= FIRST_STRESS) then
            values = results%nodal_stress(i - FIRST_STRESS + 1, nodes)
         else if (i == 3) then
            values = norm2(results%u(:, nodes), dim=1)
         else
            values = results%u(i, nodes)
         end if
      end associate
   end function nodal_values

   pure function point_values(field, contact) result(values)
      integer, intent(in) :: field                   !< place in POINT_FIELDS
      type(contact_result_t), intent(in) :: contact
      real(wp) :: values(contact%n)

      select case (field)
      case (1)
         values = contact%pressure(:contact%n)
      case (2)
         values = contact%weighted_pressure(:contact%n)
      case (3)
         values = contact%shear(:contact%n)
      case (4)
         values = contact%slip(:contact%n)
      case default
         values = contact%gap(:contact%n)
      end select
   end function point_values

   !> One number of many; nan of none.
   pure real(wp) function taken(values, weights, take)
      real(wp), intent(in) :: values(:)
      real(wp), intent(in) :: weights(:)             !< as many, of a mean
      integer, intent(in) :: take                    !< TAKE_*

      taken = ieee_value(1.0_wp, ieee_quiet_nan)
      if (size(values) == 0) return
      select case (take)
      case (TAKE_SUM)
         taken = sum(values)
      case (TAKE_MEAN)
         taken = dot_product(weights, values)
      case (TAKE_LEAST)
         taken = minval(values)
      case (TAKE_LARGEST)
         taken = maxval(values)
      case default
         taken = values(1)
      end select
   end function taken

   !> The quantities of a pair that summary.tab has, without values.
   pure function pair_quantity_list() result(list)
      type(quantity_t), allocatable :: list(:)

      list = pair_quantities(pair_summary_t(), scales_t())
   end function pair_quantity_list

   !> The same of a step.
   pure function step_quantity_list() result(list)
      type(quantity_t), allocatable :: list(:)

      list = step_quantities(results_t())
   end function step_quantity_list

end module atrito_observed_terms
