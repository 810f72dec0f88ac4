!> What stands for a number of the solution in an expression of --observe, and how that is found in the results.
module atrito_observed_terms
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_contact_zones, only: contact_zone, stick_zone, time_of_change
   use atrito_kinds, only: ip, is_nan, wp
   use atrito_place_fields, only: place_field, place_values_t, FIRST_STRAIN, FIRST_STRESS, PLACE_FIELDS
   use atrito_results, only: contact_result_t, history_row_t, results_t
   use atrito_summary, only: all_step_quantities, pair_quantities, pair_summary_t, quantity_t, scales_t, step_quantities, &
                             summarise_pair
   implicit none (type, external)
   private
   public :: term_t, value_of_term, pair_quantity_list, is_of_strain, is_of_stress
   public :: TERM_NODES, TERM_POINTS, TERM_PAIR, TERM_ZONE, TERM_STEP, TERM_TIME
   public :: TAKE_ONE, TAKE_SUM, TAKE_MEAN, TAKE_LEAST, TAKE_LARGEST
   public :: NODAL_FIELDS, POINT_FIELDS, ZONE_FIELDS, FIRST_FORCE

   integer, parameter :: TERM_NODES = 1, TERM_POINTS = 2  !< a field of nodes, of contact points
   integer, parameter :: TERM_PAIR = 3, TERM_STEP = 4     !< a quantity of summary.tab
   integer, parameter :: TERM_TIME = 5                    !< of the history
   integer, parameter :: TERM_ZONE = 6                    !< where and when a pair touches
   integer, parameter :: TAKE_ONE = 1, TAKE_SUM = 2, TAKE_MEAN = 3, TAKE_LEAST = 4, TAKE_LARGEST = 5

   integer, parameter :: FIRST_FORCE = size(PLACE_FIELDS) + 1 !< in NODAL_FIELDS: reactions
   character(len=6), parameter :: NODAL_FIELDS(FIRST_FORCE + 1) = [PLACE_FIELDS, 'rf1   ', 'rf2   ']
   character(len=17), parameter :: POINT_FIELDS(5) = ['pressure         ', 'weighted_pressure', 'shear            ', &
                                                      'slip             ', 'gap              ']

   !> Of a pair: a zone with its ends, or a time.
   character(len=18), parameter :: ZONE_FIELDS(12) = [character(len=18) :: 'contact_start', 'contact_end', 'contact_extent', &
                                                               'contact_half_width', 'contact_centre', 'stick_start', 'stick_end', &
                                                               'stick_extent', 'stick_half_width', 'stick_centre', 'closing_time', &
                                                                                                                     'opening_time']

   !> A number of the solution.
   type :: term_t
      integer :: kind = TERM_TIME                    !< TERM_*
      integer :: field = 0                           !< place in NODAL_FIELDS or POINT_FIELDS, or among the quantities
      integer :: take = TAKE_ONE                     !< what of the values of a field
      integer(ip), allocatable :: nodes(:)           !< places of nodes
      real(wp), allocatable :: weights(:)            !< of theirs in a mean, or at a place between them; their sum is 1
      logical :: is_place = .false.                  !< what is asked for is at one place in an element, whose nodes these are
      real(wp), allocatable :: arm(:, :)             !< (2, places or nodes) from the centre of polar components [L]
      integer(ip) :: pair = 0                        !< place in model%pairs; 0: of no pair
      real(wp) :: nu = 0.0_wp                        !< friction of the pair
   end type term_t

contains

   !> The value of a term; nan where it has none, as without pressure.
   pure real(wp) function value_of_term(term, results, rows, strain) result(value)
      type(term_t), intent(in) :: term               !< of find_term
      type(results_t), intent(in) :: results         !< complete where a stress is asked for
      type(history_row_t), intent(in) :: rows(:)     !< of the history so far
      real(wp), allocatable, intent(in) :: strain(:, :) !< at the nodes, where a strain is
      type(quantity_t), allocatable :: list(:)

      select case (term%kind)
      case (TERM_NODES)
         value = taken(nodal_values(), term%weights, term%take)
      case (TERM_POINTS)
         associate (contact => results%contact(term%pair))
            value = taken(point_values(term%field, contact), contact%weight(:contact%n)/sum(contact%weight(:contact%n)), term%take)
         end associate
      case (TERM_PAIR)
         list = pair_quantities(summarise_pair(results%contact(term%pair)), scales_t())
         value = list(term%field)%value
      case (TERM_ZONE)
         value = zone_value(results%contact(term%pair))
      case (TERM_STEP)
         value = step_value(term%field, results)
      case default
         value = results%time
      end select

   contains

      !> One of ZONE_FIELDS. Without contact an extent is 0, and nothing else is defined.
      pure real(wp) function zone_value(contact) result(value)
         type(contact_result_t), intent(in) :: contact
         character(len=:), allocatable :: name
         real(wp) :: ends(2)

         name = trim(ZONE_FIELDS(term%field))
         ends = contact_zone(contact)
         if (name(:6) == 'stick_') ends = stick_zone(contact, term%nu)
         select case (name(index(name, '_') + 1:))
         case ('start')
            value = ends(1)
         case ('end')
            value = ends(2)
         case ('centre')
            value = 0.5_wp*(ends(1) + ends(2))
         case ('time')
            value = time_of_change(rows, term%pair, name == 'closing_time')
         case default
            value = 0.0_wp
            if (.not. any(is_nan(ends))) value = ends(2) - ends(1)
            if (index(name, 'half') > 0) value = 0.5_wp*value
         end select
      end function zone_value

      pure function nodal_values() result(values)
         real(wp) :: values(merge(1, size(term%nodes), term%is_place))
         type(place_values_t) :: at
         integer(ip) :: i
         integer :: k

         if (term%field >= FIRST_FORCE) then
            values = results%reaction(term%field - FIRST_FORCE + 1, term%nodes)
            return
         end if
         do k = 1, size(values)
            if (allocated(term%arm)) at%arm = term%arm(:, k)
            i = term%nodes(k)
            if (term%is_place) then
               at%u = matmul(results%u(:, term%nodes), term%weights)
               if (is_of_stress(term)) at%s = matmul(results%nodal_stress(:4, term%nodes), term%weights)
               if (is_of_strain(term)) at%e = matmul(strain(:, term%nodes), term%weights)
            else
               at%u = results%u(:, i)
               if (is_of_stress(term)) at%s = results%nodal_stress(:4, i)
               if (is_of_strain(term)) at%e = strain(:, i)
            end if
            values(k) = place_field(term%field, at)
         end do
      end function nodal_values
   end function value_of_term

   !> One of all_step_quantities; nan where the step has it not, as what a search finds without a search.
   pure real(wp) function step_value(field, results) result(value)
      integer, intent(in) :: field                   !< place among all
      type(results_t), intent(in) :: results
      type(quantity_t), allocatable :: list(:), all_of_them(:)
      integer :: i

      value = ieee_value(1.0_wp, ieee_quiet_nan)
      list = step_quantities(results)
      all_of_them = all_step_quantities()
      i = findloc(list%name, all_of_them(field)%name, dim=1)
      if (i > 0) value = list(i)%value
   end function step_value

   !> Whether a term wants stresses at the nodes.
   pure logical function is_of_stress(term)
      type(term_t), intent(in) :: term               !< of find_term

      is_of_stress = term%kind == TERM_NODES .and. term%field >= FIRST_STRESS .and. term%field < FIRST_STRAIN
   end function is_of_stress

   !> Whether it wants strains.
   pure logical function is_of_strain(term)
      type(term_t), intent(in) :: term               !< of find_term

      is_of_strain = term%kind == TERM_NODES .and. term%field >= FIRST_STRAIN .and. term%field < FIRST_FORCE
   end function is_of_strain

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

end module atrito_observed_terms
