!> `*PARAMETER` and `--set`, expressions of parameters and of the place, and the parameters in words.
module atrito_parameters
   use atrito_deck, only: deck_t, token_t, parameter_t, part_of, reading_order, token_text
   use atrito_items, only: evaluate_at, has_own_degree, report_fault, collect_known, put_before, index_of_parameter, is_known_at, &
                           LONGEST_NAME
   use atrito_diagnostics, only: report_error
   use atrito_expression_names, only: is_name, is_reserved_name, next_name
   use atrito_expressions, only: expression_fault_t, evaluate_expression
   use atrito_growth, only: growing_text_t, append_text, take_text
   use atrito_kinds, only: ip, wp
   use atrito_lexer, only: find_equals
   use atrito_name_list, only: name_list_t, add_name, find_name, has_name, names_of
   use atrito_numbers, only: exact_text
   use atrito_status, only: status_t, set_status, is_ok, STATUS_USAGE
   use atrito_strings, only: string_t, nearest_names, join, to_text, same_name
   implicit none (type, external)
   private
   public :: settings_t, read_settings, define_parameter, check_settings, evaluate_function, list_parameters

   !> Values that override parameters.
   type :: settings_t
      type(name_list_t) :: names                   !< without case, each once
      real(wp), allocatable :: values(:)           !< as many are in use
   end type settings_t

   integer, parameter :: MOST_NEAREST = 3

contains

   !> Reads the settings of the command line; of several for one name the last counts.
   !> status: STATUS_USAGE for one that is not NAME=VALUE.
   subroutine read_settings(list, settings, status)
      type(string_t), intent(in) :: list(:)            !< 'NAME=VALUE', VALUE an expression of numbers
      type(settings_t), intent(out) :: settings        !< of no use where the status is not OK
      type(status_t), intent(out) :: status            !< STATUS_USAGE where one is not NAME=VALUE, or has no value
      type(string_t) :: none(0)
      type(expression_fault_t) :: fault
      character(len=:), allocatable :: name
      integer :: i, equals

      allocate (settings%values(size(list)))
      do i = 1, size(list)
         equals = index(list(i)%s, '=')
         name = trim(adjustl(list(i)%s(:max(equals - 1, 0))))
         if (.not. is_name(name)) then
            call set_status(status, STATUS_USAGE, 'setting '//list(i)%s//': NAME=VALUE is expected')
            return
         end if
         if (.not. has_name(settings%names, name)) call add_name(settings%names, name)
         call evaluate_expression(list(i)%s(equals + 1:), none, [real(wp) ::], &
                                  settings%values(find_name(settings%names, name)), fault)
         if (allocated(fault%text)) then
            call set_status(status, STATUS_USAGE, 'setting '//list(i)%s//': '//fault%text)
            return
         end if
      end do
   end subroutine read_settings

   !> Defines the parameter of a line `name = expression`.
   subroutine define_parameter(deck, token, settings)
      type(deck_t), intent(inout) :: deck              !< gets the parameter, unless it is faulty
      type(token_t), intent(in) :: token               !< the whole line
      type(settings_t), intent(in) :: settings         !< of --set; they go before the deck
      type(parameter_t) :: parameter
      type(token_t) :: name, expression
      integer(ip) :: equals, i
      logical :: ok

      equals = find_equals(deck%sources(token%source)%text, token%first, token%last)
      if (equals == 0) then
         deck%has_lost_parameters = .true.
         call report_error(deck, token, 'E-PARAMETER', 'a parameter without a value', expected='name = expression', &
                           keyword='PARAMETER')
         return
      end if
      name = part_of(deck, token, token%first, equals - 1)
      expression = part_of(deck, token, equals + 1, token%last)
      parameter%name = deck%sources(token%source)%text(name%first:name%last)
      call check_name(deck, name, parameter%name, ok)
      if (.not. ok) deck%has_lost_parameters = deck%has_lost_parameters .or. index_of_parameter(deck, parameter%name) == 0
      if (.not. ok) return
      parameter%place = name
      parameter%expression = expression
      parameter%order = reading_order(deck, token%source, token%line)
      ! Takes the value of a setting, if there is one.
      i = find_name(settings%names, parameter%name)
      if (i /= 0) then
         parameter%known = .true.
         parameter%value = settings%values(i)
         parameter%overridden = .true.
      end if
      if (.not. parameter%known) call evaluate_at(deck, expression, parameter%value, parameter%known)
      if (deck%n_parameters == size(deck%parameters)) deck%parameters = [deck%parameters, deck%parameters]
      deck%n_parameters = deck%n_parameters + 1
      deck%parameters(deck%n_parameters) = parameter
      call add_name(deck%parameter_names, parameter%name)
   end subroutine define_parameter

   subroutine check_name(deck, place, name, ok)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: place
      character(len=*), intent(in) :: name
      logical, intent(out) :: ok
      integer(ip) :: i

      ok = .false.
      i = index_of_parameter(deck, name)
      if (.not. is_name(name) .or. len(name) > LONGEST_NAME) then
         call report_error(deck, place, 'E-PARAMETER', "'"//name//"' cannot be the name of a parameter", &
                           expected='letters, digits and underscores, a letter first, at most '// &
                           to_text(int(LONGEST_NAME, ip))//' characters', keyword='PARAMETER')
      else if (is_reserved_name(name)) then
         call report_error(deck, place, 'E-PARAMETER', name//' is a name of the expressions themselves', &
                           expected='another name', keyword='PARAMETER')
      else if (i > 0) then
         call report_error(deck, place, 'E-PARAMETER', 'parameter '//name//' is defined twice', expected='one definition; '// &
                           'the first is in '//deck%sources(deck%parameters(i)%place%source)%name//':'// &
                           to_text(deck%parameters(i)%place%line), keyword='PARAMETER')
      else
         ok = .true.
      end if
   end subroutine check_name

   !> An expression in x, y and earlier parameters at some places.
   subroutine evaluate_function(deck, expression, x, values, ok, keyword)
      type(deck_t), intent(in) :: deck                 !< its texts and parameters are read
      type(token_t), intent(in) :: expression          !< place of its text, without < and >
      real(wp), intent(in) :: x(:, :)                  !< (2, n) [L]; without a place only the text is checked
      real(wp), intent(out) :: values(:)               !< (n)
      logical, intent(out) :: ok                       !< .false.: reported, once
      character(len=*), intent(in) :: keyword          !< for `atrito help KEYWORD`
      type(expression_fault_t) :: fault
      type(string_t), allocatable :: names(:)
      real(wp), allocatable :: known(:)
      type(string_t) :: coordinates(2)
      real(wp) :: value
      integer(ip) :: i, k

      coordinates(1)%s = 'x'
      coordinates(2)%s = 'y'
      values = 0.0_wp
      do k = 1, 2
         i = index_of_parameter(deck, coordinates(k)%s)
         ok = .not. is_known_at(deck, i, expression)
         if (ok) cycle
         call report_error(deck, expression, 'E-EXPRESSION', 'parameter '//deck%parameters(i)%name// &
                           ' has the name of a coordinate', expected='another name of the parameter', keyword=keyword)
         return
      end do
      call collect_known(deck, expression, names, known)
      call put_before(coordinates, names)
      ok = .true.
      if (size(values) == 0) then                      ! only the text of the expression can be wrong
         call evaluate_expression(token_text(deck, expression), names, [0.0_wp, 0.0_wp, known], value, fault, has_own_degree(deck))
         ok = .not. allocated(fault%text) .or. fault%of_value
         if (.not. ok) call report_fault(deck, expression, fault, coordinates, keyword)
      end if
      do i = 1, size(values, kind=ip)
         call evaluate_expression(token_text(deck, expression), names, [x(:, i), known], values(i), fault, has_own_degree(deck))
         ok = .not. allocated(fault%text)
         if (ok) cycle
         if (fault%of_value) fault%text = fault%text//' at x = '//to_text(x(1, i))//', y = '//to_text(x(2, i))
         call report_fault(deck, expression, fault, coordinates, keyword)
         return
      end do
   end subroutine evaluate_function

   !> status: STATUS_USAGE when a setting names no parameter of the deck; tells those that it has.
   subroutine check_settings(deck, settings, status)
      type(deck_t), intent(in) :: deck         !< read to its end
      type(settings_t), intent(in) :: settings !< of --set
      type(status_t), intent(inout) :: status  !< STATUS_USAGE without a parameter of this name; stays where not OK
      type(string_t), allocatable :: near(:), names(:)
      character(len=:), allocatable :: text
      integer :: i

      if (.not. is_ok(status)) return
      names = names_of(settings%names)
      do i = 1, size(names)
         if (index_of_parameter(deck, names(i)%s) > 0) cycle
         text = 'setting '//names(i)%s//': '//deck%path//' has no such parameter'
         near = nearest_names(names(i)%s, names_of(deck%parameter_names), MOST_NEAREST)
         if (size(near) > 0) text = text//'; nearest: '//join(near, ', ')
         if (deck%n_parameters > 0) text = text//'; it has: '//join(names_of(deck%parameter_names), ', ')
         call set_status(status, STATUS_USAGE, text)
         return
      end do
   end subroutine check_settings

   !> `nu = 0.3, q = 10 (--set), eps varies`, in the order of the deck; not allocated where it has none.
   subroutine list_parameters(deck, varied, text)
      type(deck_t), intent(in) :: deck                   !< its parameters are read
      type(string_t), intent(in) :: varied(:)            !< names of those that take several values
      character(len=:), allocatable, intent(out) :: text !< in one line
      type(growing_text_t) :: words
      logical, allocatable :: varies(:)
      integer(ip) :: i, k

      if (deck%n_parameters == 0) return
      allocate (varies(deck%n_parameters), source=.false.)
      do i = 1, deck%n_parameters                      ! the varied ones and those that depend on them
         do k = 1, size(varied, kind=ip)
            varies(i) = varies(i) .or. same_name(deck%parameters(i)%name, varied(k)%s)
         end do
         if (.not. (varies(i) .or. deck%parameters(i)%overridden)) varies(i) = names_one(deck, i, varies)
      end do
      do i = 1, deck%n_parameters
         associate (parameter => deck%parameters(i))
            if (i > 1) call append_text(words, ', ')
            call append_text(words, parameter%name)
            if (varies(i)) then
               call append_text(words, ' varies')
            else
               call append_text(words, ' = '//exact_text(parameter%value))
               if (parameter%overridden) call append_text(words, ' (--set)')
            end if
         end associate
      end do
      call take_text(words, text)
   end subroutine list_parameters

   !> The expression of the i-th parameter names one before it that varies.
   pure logical function names_one(deck, i, varies)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i
      logical, intent(in) :: varies(:)
      character(len=:), allocatable :: expression
      integer :: first, last
      integer(ip) :: k

      names_one = .false.
      expression = token_text(deck, deck%parameters(i)%expression)
      last = 0
      do while (.not. names_one)
         call next_name(expression, last, first)
         if (first > len(expression)) return
         k = index_of_parameter(deck, expression(first:last))
         if (k > 0 .and. k < i) names_one = varies(k)
      end do
   end function names_one

end module atrito_parameters
