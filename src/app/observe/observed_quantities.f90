!> Which observed quantities are linear and have bounds (--bound), and what they are made of.
module atrito_observed_quantities
   use atrito_expression_names, only: call_t
   use atrito_expressions, only: evaluate_expression, expression_fault_t
   use atrito_kinds, only: ip, wp
   use atrito_linear_quantity, only: linear_part_t, linear_quantity_t, PART_FACES, PART_PAIR, PART_REACTION, PART_STRESS, &
                                     PART_VOLUME
   use atrito_messages, only: message_t
   use atrito_model, only: model_t
   use atrito_observed_names, only: put_place
   use atrito_observed_places, only: index_of_surface
   use atrito_observed_terms, only: pair_quantity_list, term_t, NODAL_FIELDS, POINT_FIELDS, TAKE_LARGEST, TAKE_LEAST, TAKE_MEAN, &
                                    TAKE_SUM, TERM_NODES, TERM_PAIR, TERM_POINTS
   use atrito_sets, only: find_set, members_of
   use atrito_strings, only: string_t
   use atrito_summary, only: quantity_t
   implicit none (type, external)
   private
   public :: find_quantity

   character(len=*), parameter :: CAN_BE_BOUND = 'sums of mean(u1, SURFACE or ELSET), mean(s11, ELSET), rf1(SET), '// &
                                  'normal_resultant, shear_resultant, mean(pressure, pair) times numbers'

   character(len=*), parameter :: RESULTANTS(2) = [character(len=16) :: 'normal_resultant', 'shear_resultant']

contains

   !> An expression as a constant and parts. fault%text: it is not linear, or a part has no bound.
   subroutine find_quantity(model, text, names, values, own_degree, calls, terms, quantity, fault)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: text
      type(string_t), intent(in) :: names(:)         !< parameters of the deck
      real(wp), intent(in) :: values(:)
      logical, intent(in) :: own_degree
      type(call_t), intent(in) :: calls(:)
      type(term_t), intent(in) :: terms(:)           !< what they mean
      type(linear_quantity_t), intent(inout) :: quantity
      type(message_t), intent(out) :: fault
      real(wp) :: slope(size(calls))
      integer :: k
      logical :: is_linear

      call find_slopes(quantity%constant, slope, is_linear)
      if (.not. is_linear) then
         fault%text = 'it is not linear, so it has no bound'
         fault%expected = CAN_BE_BOUND
         return
      end if
      allocate (quantity%parts(size(calls)))
      do k = 1, size(calls)
         call find_part(model, calls(k), terms(k), quantity%parts(k), fault)
         if (allocated(fault%text)) return
         quantity%parts(k)%factor = quantity%parts(k)%factor*slope(k)
      end do

   contains

      !> The value where all terms are 0, and what each of them adds; linear where values of all sizes and signs add the same.
      subroutine find_slopes(constant, slope, is_linear)
         real(wp), intent(out) :: constant, slope(:)
         logical, intent(out) :: is_linear
         real(wp), parameter :: SIZES(7) = [1.0e-12_wp, 1.0e-8_wp, 1.0e-4_wp, 1.0_wp, 1.0e4_wp, 1.0e8_wp, 1.0e12_wp]
         real(wp), parameter :: DIGITS = 1.0e-9_wp
         real(wp) :: amounts(size(slope)), linear, found
         integer :: i, s

         amounts = 0.0_wp
         is_linear = size(slope) > 0
         call evaluate(amounts, constant, is_linear)
         do i = 1, size(slope)
            amounts(i) = 1.0_wp
            call evaluate(amounts, slope(i), is_linear)
            slope(i) = slope(i) - constant
            amounts(i) = 0.0_wp
         end do
         do s = -size(SIZES), size(SIZES)
            if (s == 0) cycle
            amounts = [(sign(SIZES(abs(s)), real(s, wp))*(1 + 0.3_wp*i)*(-1)**(i*abs(s)), i=1, size(amounts))]
            linear = constant + dot_product(slope, amounts)
            call evaluate(amounts, found, is_linear)
            is_linear = is_linear .and. abs(found - linear) <= DIGITS*(abs(constant) + sum(abs(slope*amounts)))
         end do
      end subroutine find_slopes

      subroutine evaluate(amounts, value, is_there)
         real(wp), intent(in) :: amounts(:)
         real(wp), intent(out) :: value
         logical, intent(inout) :: is_there
         type(expression_fault_t) :: wrong

         call evaluate_expression(text, names, values, value, wrong, own_degree, calls, amounts)
         is_there = is_there .and. .not. allocated(wrong%text)
      end subroutine evaluate

   end subroutine find_quantity

   !> A term as a part with its factor.
   subroutine find_part(model, call, term, part, fault)
      type(model_t), intent(in) :: model
      type(call_t), intent(in) :: call
      type(term_t), intent(in) :: term
      type(linear_part_t), intent(inout) :: part
      type(message_t), intent(inout) :: fault
      type(quantity_t), allocatable :: list(:)

      part%factor = 1.0_wp
      select case (term%kind)
      case (TERM_NODES)
         call find_part_of_nodes()
      case (TERM_PAIR)
         list = pair_quantity_list()
         part%kind = PART_PAIR
         part%pair = term%pair
         part%component = findloc(RESULTANTS == list(term%field)%name, .true., dim=1)
      case (TERM_POINTS)
         part%kind = PART_PAIR
         part%pair = term%pair
         part%component = findloc([character(len=8) :: 'pressure', 'shear'] == POINT_FIELDS(term%field), .true., dim=1)
         part%factor = 1/max(sum(model%points(term%pair)%weight), tiny(1.0_wp))
         if (term%take /= TAKE_MEAN) part%component = 0
      end select
      if (part%component > 0 .or. allocated(fault%text)) return
      fault%text = call%name//' has no bound'
      if (size(call%arguments) > 0) fault%text = call%name//'('//call%arguments(1)%text//', ...) has no bound'
      fault%expected = CAN_BE_BOUND
      fault%column = int(call%first, ip)
      fault%length = int(call%last - call%first + 1, ip)

   contains

      !> Means of displacements and of stresses, sums of reactions.
      subroutine find_part_of_nodes()
         character(len=:), allocatable :: field
         integer(ip) :: surface, elements

         field = trim(NODAL_FIELDS(term%field))
         surface = 0
         elements = 0
         if (term%take == TAKE_MEAN) then
            surface = index_of_surface(model, call%arguments(2)%text)
            if (surface == 0) elements = find_set(model%element_sets, call%arguments(2)%text)
            if (surface > 0) part%element = model%surfaces(surface)%faces%element(:model%surfaces(surface)%faces%n)
            if (surface > 0) part%face = model%surfaces(surface)%faces%face(:model%surfaces(surface)%faces%n)
            if (elements > 0) part%element = members_of(model%element_sets%sets(elements))
         end if
         select case (field)
         case ('u1', 'u2')
            part%component = merge(1, 2, field == 'u1')
            part%kind = merge(PART_FACES, PART_VOLUME, surface > 0)
         case ('s11', 's22', 's12')
            part%component = findloc(['s11', 's22', 's12'] == field, .true., dim=1)
            part%kind = PART_STRESS
            surface = 0                                 ! stresses along a line are no better than at a point
         case ('rf1', 'rf2')
            if (term%take /= TAKE_SUM) return
            part%component = merge(1, 2, field == 'rf1')
            part%kind = PART_REACTION
            part%node = term%nodes
            return
         case default
            return
         end select
         if (any(term%take == [TAKE_LEAST, TAKE_LARGEST])) part%component = 0
         if (surface > 0 .or. elements > 0 .or. part%component == 0) return
         fault%text = field//' at points has no bound: the energy of a force at a point is infinite'
         fault%expected = 'mean('//field//', ELSET) over an element set'
         if (part%kind /= PART_STRESS) fault%expected = fault%expected//', or mean('//field//', SURFACE) over a surface'
         call put_place(call%arguments(size(call%arguments)), fault)
      end subroutine find_part_of_nodes
   end subroutine find_part

end module atrito_observed_quantities
