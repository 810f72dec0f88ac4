!> What the names of an expression of --observe mean in a model: terms, or what is wrong with them.
!>
!> The arguments of quantities of nodes and places in an expression of --observe:
!>
!>     u2(P), u2(x, y), u2(x, y, BODY)                 P: a node, a set or a surface
!>     s_rr(P), s_rr(x, y), s_rr(x, y, BODY)           about the origin
!>     s_rr(P, xc, yc), s_rr(x, y, xc, yc[, BODY])     about a centre
module atrito_observed_names
   use atrito_expression_names, only: call_t, DIGITS, reserved_names, argument_t
   use atrito_expressions, only: evaluate_expression, expression_fault_t
   use atrito_kinds, only: ip, wp
   use atrito_messages, only: message_t
   use atrito_model, only: model_t
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_observed_places, only: find_place, find_point, has_element, has_support
   use atrito_observed_terms, only: pair_quantity_list, term_t, FIRST_FORCE, NODAL_FIELDS, POINT_FIELDS, TAKE_LARGEST, TAKE_LEAST, &
                TAKE_MEAN, TAKE_ONE, TAKE_SUM, TERM_PAIR, TERM_POINTS, TERM_STEP, TERM_TIME, TERM_ZONE, ZONE_FIELDS, is_of_strain, &
                                    is_of_stress, TERM_NODES
   use atrito_place_fields, only: IS_POLAR
   use atrito_strings, only: string_t, append_string, lower_case, same_name, to_text
   use atrito_summary, only: all_step_quantities, quantity_t
   implicit none (type, external)
   private
   public :: find_term, field_names, observable_names, put_place

   character(len=*), parameter :: TIME_NAME = 'time'
   character(len=*), parameter :: AGGREGATES(3) = ['mean', 'min ', 'max ']
   integer, parameter :: TAKES(3) = [TAKE_MEAN, TAKE_LEAST, TAKE_LARGEST]

contains

   !> The term of a call. fault%text is allocated where it means nothing; its place is that in the expression, and `known` has the
   !> names of which the nearest may be meant.
   subroutine find_term(model, call, term, fault)
      type(model_t), intent(in) :: model             !< its names and places are searched
      type(call_t), intent(in) :: call               !< in the expression
      type(term_t), intent(out) :: term              !< of no use where there is a fault
      type(message_t), intent(out) :: fault          !< text not allocated: nothing is wrong
      character(len=:), allocatable :: name
      integer :: i

      name = lower_case(call%name)
      fault%column = int(call%first, ip)
      fault%length = int(call%last - call%first + 1, ip)
      i = findloc(AGGREGATES == name, .true., dim=1)
      if (i > 0) then
         call find_aggregate(model, call, TAKES(i), term, fault)
      else if (any(NODAL_FIELDS == name)) then
         call find_of_node(findloc(NODAL_FIELDS == name, .true., dim=1))
      else if (any(POINT_FIELDS == name)) then
         fault%text = name//' has a value at each contact point'
         fault%expected = 'max('//name//', pair), min(...) or mean(...)'
      else if (index_of(pair_quantity_list(), name) > 0) then
         call find_of_pair(TERM_PAIR, index_of(pair_quantity_list(), name))
      else if (any(ZONE_FIELDS == name)) then
         call find_of_pair(TERM_ZONE, findloc(ZONE_FIELDS == name, .true., dim=1))
      else
         call find_of_step(name)
      end if

   contains

      !> A quantity of the step, or the time.
      subroutine find_of_step(name)
         character(len=*), intent(in) :: name
         integer :: i

         term%field = index_of(all_step_quantities(), name)
         term%kind = merge(TERM_STEP, TERM_TIME, term%field > 0)
         if (term%field == 0 .and. name /= TIME_NAME) then
            fault%length = len(call%name, kind=ip)
            fault%text = 'unknown quantity '//call%name
            fault%expected = 'u2(node), s11(x, y), rf1(set), mean(mises, set), a quantity of summary.tab, a parameter of '// &
                             'the deck, a function'
            fault%known = observable_names()
            do i = 1, size(model%parameters)
               call append_string(fault%known, model%parameters(i)%name)
            end do
         else if (call%has_parentheses) then
            fault%text = call%name//' is one number of the step'
            fault%expected = call%name//' without parentheses'
         end if
      end subroutine find_of_step

      !> `max_pressure`, `max_pressure(2)` or `contact_half_width(2)`.
      subroutine find_of_pair(kind, field)
         integer, intent(in) :: kind, field             !< TERM_PAIR or TERM_ZONE

         term%kind = kind
         term%field = field
         if (call%has_parentheses .and. size(call%arguments) /= 1) then
            call complain_of_count(call, call%name//'(pair), pair being its number or its slave', fault)
         else
            call find_pair(model, call, 1, term%pair, fault)
            if (.not. allocated(fault%text)) term%nu = model%interactions(model%pairs(term%pair)%interaction)%nu
         end if
      end subroutine find_of_pair

      !> `u2(12)`, `rf2(BASE)`.
      subroutine find_of_node(field)
         integer, intent(in) :: field                   !< place in NODAL_FIELDS
         character(len=:), allocatable :: form

         form = call%name//'(node or set of one node), '//call%name//'(x, y), '//call%name//'(x, y, element set or instance)'
         if (field >= FIRST_FORCE) then
            form = call%name//'(node or set), the sum over the set'
         else if (IS_POLAR(field)) then
            form = call%name//'(x, y), '//call%name//'(x, y, xc, yc) about another centre than (0, 0), or a node or set for x, y'
         end if
         call find_nodes(model, call, 1, field, form, term, fault)
         if (allocated(fault%text)) return
         term%take = merge(TAKE_SUM, TAKE_ONE, field >= FIRST_FORCE)
         if (term%take == TAKE_SUM .or. term%is_place .or. size(term%nodes) == 1) return
         call put_place(call%arguments(1), fault)
         fault%text = call%arguments(1)%text//' has '//to_text(size(term%nodes, kind=ip))//' nodes'
         fault%expected = form//'; or mean('//call%name//', '//call%arguments(1)%text//'), min(...), max(...)'
      end subroutine find_of_node
   end subroutine find_term

   !> The pair that an argument names, or the only one.
   subroutine find_pair(model, call, i, pair, fault)
      type(model_t), intent(in) :: model
      type(call_t), intent(in) :: call
      integer, intent(in) :: i                       !< of the argument, which may be missing
      integer(ip), intent(out) :: pair
      type(message_t), intent(inout) :: fault
      integer(ip) :: k, n, outcome

      n = size(model%pairs, kind=ip)
      pair = 1
      if (n == 0) then
         fault%text = 'the deck has no contact pair'
      else if (i > size(call%arguments)) then
         if (n == 1) return
         fault%text = 'of which of the '//to_text(n)//' pairs?'
      else
         associate (argument => call%arguments(i))
            if (verify(argument%text, DIGITS) == 0) then
               call read_integer(argument%text, pair, outcome)
               if (outcome == NUMBER_OK .and. pair >= 1 .and. pair <= n) return
               fault%text = 'pair '//argument%text//' does not exist'
            else
               pair = 0
               do k = 1, n
                  if (.not. same_name(slave_name(model, k), argument%text)) cycle
                  if (pair > 0) fault%text = argument%text//' is the slave of pair '//to_text(pair)//' and of pair '//to_text(k)
                  pair = k
               end do
               if (pair > 0 .and. .not. allocated(fault%text)) return
               if (pair == 0) fault%text = 'no pair has the slave '//argument%text
            end if
            call put_place(argument, fault)
         end associate
         allocate (fault%known(n))
         do k = 1, n
            fault%known(k)%s = slave_name(model, k)
         end do
      end if
      fault%expected = 'the number of a pair, 1 to '//to_text(n)//', or the name of its slave'
      if (n == 1) fault%expected = '1, or the name of its slave'
      if (n == 0) fault%expected = 'quantities of nodes or of the step'
   end subroutine find_pair

   !> As the deck has it.
   pure function slave_name(model, pair) result(name)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: pair
      character(len=:), allocatable :: name

      associate (one => model%pairs(pair))
         name = model%surfaces(merge(one%master, one%slave, one%is_exchanged))%name
      end associate
   end function slave_name

   !> `mean(u2, TOP)`, `max(pressure, 1)`.
   subroutine find_aggregate(model, call, take, term, fault)
      type(model_t), intent(in) :: model
      type(call_t), intent(in) :: call
      integer, intent(in) :: take
      type(term_t), intent(inout) :: term
      type(message_t), intent(inout) :: fault
      character(len=:), allocatable :: field
      integer :: of_nodes, of_points

      field = ''
      if (size(call%arguments) > 0) field = lower_case(call%arguments(1)%text)
      of_nodes = findloc(NODAL_FIELDS == field, .true., dim=1)
      of_points = findloc(POINT_FIELDS == field, .true., dim=1)
      term%take = take
      if (field == '') then
         call complain_of_count(call, call%name//'(quantity, set)', fault)
      else if (of_nodes + of_points == 0) then
         call put_place(call%arguments(1), fault)
         fault%text = 'unknown quantity '//call%arguments(1)%text
         fault%expected = 'a quantity of nodes or contact points: '//call%name//'(mises, set), '//call%name//'(pressure, pair)'
         fault%known = field_names()
      else if (of_nodes > 0) then
         call find_nodes(model, call, 2, of_nodes, call%name//'('//field//', set)'// &
                         trim(merge(', with xc, yc behind it about a centre', repeat(' ', 38), index(field, '_') > 0)), term, fault)
      else if (size(call%arguments) > 2) then
         call complain_of_count(call, call%name//'('//field//', pair)', fault)
      else
         term%kind = TERM_POINTS
         term%field = of_points
         call find_pair(model, call, 2, term%pair, fault)
      end if
   end subroutine find_aggregate

   !> Place of a quantity among others; 0: it is none of them.
   pure integer function index_of(list, name) result(i)
      type(quantity_t), intent(in) :: list(:)
      character(len=*), intent(in) :: name

      i = findloc(list%name == name, .true., dim=1)
   end function index_of

   !> Fields of nodes and of contact points: what mean, min and max take.
   pure function field_names() result(names)
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(NODAL_FIELDS)
         call append_string(names, trim(NODAL_FIELDS(i)))
      end do
      do i = 1, size(POINT_FIELDS)
         call append_string(names, trim(POINT_FIELDS(i)))
      end do
   end function field_names

   !> All names that an expression knows, without the parameters of the deck.
   pure function observable_names() result(names)
      type(string_t), allocatable :: names(:), functions(:)
      type(quantity_t), allocatable :: list(:)
      integer :: i

      names = field_names()
      list = [pair_quantity_list(), all_step_quantities()]
      do i = 1, size(list)
         call append_string(names, trim(list(i)%name))
      end do
      do i = 1, size(ZONE_FIELDS)
         call append_string(names, trim(ZONE_FIELDS(i)))
      end do
      call append_string(names, TIME_NAME)
      call append_string(names, trim(AGGREGATES(1)))
      functions = reserved_names()
      do i = 1, size(functions)
         call append_string(names, functions(i)%s)
      end do
   end function observable_names

   !> The nodes of the arguments from the first one on, or the place in an element; of a mean and the like nodes alone.
   subroutine find_nodes(model, call, first, field, form, term, fault)
      type(model_t), intent(in) :: model             !< its mesh, sets and surfaces are searched
      type(call_t), intent(in) :: call               !< in the expression
      integer, intent(in) :: first                   !< argument
      integer, intent(in) :: field                   !< place in NODAL_FIELDS
      character(len=*), intent(in) :: form           !< how it should read
      type(term_t), intent(inout) :: term            !< its kind, nodes, weights and arm are set
      type(message_t), intent(inout) :: fault        !< text not allocated: nothing is wrong
      real(wp) :: x(2), centre(2)
      integer :: n, n_place
      logical :: polar, has_body

      term%kind = TERM_NODES
      term%field = field
      polar = .false.
      if (field < FIRST_FORCE) polar = IS_POLAR(field)
      n = size(call%arguments) - first + 1
      has_body = n == 3 .or. n == 5
      if (n == 3 .and. polar) has_body = .not. is_number(model, call%arguments(3))
      n_place = n - merge(1, 0, has_body) - merge(2, 0, polar .and. (n == 4 .or. n == 5 .or. (n == 3 .and. .not. has_body)))
      term%is_place = n_place == 2 .and. first == 1 .and. field < FIRST_FORCE
      if (.not. (n_place == 1 .or. term%is_place) .or. (n == 5 .and. .not. polar)) then
         call complain_of_count(call, form, fault)
         return
      end if
      centre = 0.0_wp
      associate (arguments => call%arguments(first:))
         if (n - n_place >= 2) call read_point(model, arguments(n_place + 1:n_place + 2), centre, fault)
         if (term%is_place) call read_point(model, arguments(:2), x, fault)
         if (allocated(fault%text)) return
         if (.not. term%is_place) then
            call find_named(model, arguments(1), field, term, fault)
         else if (has_body) then
            call find_point(model, x, arguments(n)%text, term%nodes, term%weights, fault)
            if (allocated(fault%known)) call put_place(arguments(n), fault)
         else
            call find_point(model, x, '', term%nodes, term%weights, fault)
         end if
      end associate
      if (allocated(fault%text)) return
      if (polar .and. term%is_place) term%arm = reshape(x - centre, [2, 1])
      if (polar .and. .not. term%is_place) term%arm = model%mesh%x(:, term%nodes) - spread(centre, 2, size(term%nodes))
   end subroutine find_nodes

   !> The nodes of one argument, where they have the field.
   subroutine find_named(model, argument, field, term, fault)
      type(model_t), intent(in) :: model
      type(argument_t), intent(in) :: argument
      integer, intent(in) :: field                   !< place in NODAL_FIELDS
      type(term_t), intent(inout) :: term
      type(message_t), intent(inout) :: fault

      call find_place(model, argument, term%nodes, term%weights, fault)
      if (.not. allocated(fault%text)) then
         if (field >= FIRST_FORCE) then
            if (has_support(model, term%nodes)) return
            fault%text = argument%text//' has no node with a prescribed displacement, so no reaction'
            fault%expected = 'a node or set with supports'
         else if (is_of_stress(term) .or. is_of_strain(term)) then
            if (has_element(model, term%nodes)) return
            fault%text = argument%text//' has a node without elements, so without stresses'
            fault%expected = 'nodes of elements'
         else
            return
         end if
      end if
      call put_place(argument, fault)
   end subroutine find_named

   !> Two coordinates, expressions of numbers and parameters.
   subroutine read_point(model, arguments, x, fault)
      type(model_t), intent(in) :: model
      type(argument_t), intent(in) :: arguments(2)
      real(wp), intent(out) :: x(2)                  !< [L]
      type(message_t), intent(inout) :: fault
      type(expression_fault_t) :: wrong
      integer :: i

      x = 0.0_wp
      do i = 1, 2
         if (allocated(fault%text)) return
         call evaluate(model, arguments(i), x(i), wrong)
         if (.not. allocated(wrong%text)) cycle
         fault%text = wrong%text
         fault%expected = 'a coordinate [L]: a number, or an expression of parameters of the deck'
         fault%column = int(arguments(i)%first + wrong%first - 1, ip)
         fault%length = int(wrong%last - wrong%first + 1, ip)
      end do
   end subroutine read_point

   subroutine evaluate(model, argument, value, wrong)
      type(model_t), intent(in) :: model
      type(argument_t), intent(in) :: argument
      real(wp), intent(out) :: value
      type(expression_fault_t), intent(out) :: wrong
      type(string_t) :: names(size(model%parameters))
      integer :: i
      logical :: own_degree

      own_degree = .false.
      do i = 1, size(names)
         names(i)%s = model%parameters(i)%name
         own_degree = own_degree .or. same_name(names(i)%s, 'deg')
      end do
      call evaluate_expression(argument%text, names, model%parameters%value, value, wrong, own_degree)
   end subroutine evaluate

   logical function is_number(model, argument)
      type(model_t), intent(in) :: model
      type(argument_t), intent(in) :: argument
      type(expression_fault_t) :: wrong
      real(wp) :: value

      call evaluate(model, argument, value, wrong)
      is_number = .not. allocated(wrong%text)
   end function is_number

   !> The arguments are too few or too many.
   subroutine complain_of_count(call, form, fault)
      type(call_t), intent(in) :: call               !< in the expression
      character(len=*), intent(in) :: form           !< how it should read
      type(message_t), intent(inout) :: fault        !< gets text and what is expected
      integer(ip) :: n

      n = size(call%arguments, kind=ip)
      fault%text = call%name//' stands with '//to_text(n)//trim(merge(' argument ', ' arguments', n == 1))
      if (n == 0) fault%text = call%name//' stands without argument'
      fault%expected = form
   end subroutine complain_of_count

   !> The place of a fault is that of an argument.
   subroutine put_place(argument, fault)
      type(argument_t), intent(in) :: argument       !< in the expression
      type(message_t), intent(inout) :: fault        !< column and length are set

      fault%column = int(argument%first, ip)
      fault%length = int(argument%last - argument%first + 1, ip)
   end subroutine put_place

end module atrito_observed_names
