!> Expressions that stand in a deck: the parameters that they may use, and their faults at their places.
module atrito_deck_expressions
   use atrito_kinds, only: ip, wp
   use atrito_deck, only: deck_t, token_t, token_text, reading_order
   use atrito_diagnostics, only: report_error
   use atrito_expression_names, only: next_name, reserved_names
   use atrito_expressions, only: expression_fault_t, evaluate_expression
   use atrito_growth, only: make_room
   use atrito_name_list, only: find_name
   use atrito_sorting, only: each_once
   use atrito_strings, only: string_t, join, to_text
   implicit none (type, external)
   private
   public :: evaluate_at, has_own_degree, report_fault, report_later, collect_known, put_before, index_of_parameter, is_known_at

contains

   !> The value of an expression of earlier parameters. known: .false. when it has none; that is reported, except when it
   !> uses a parameter that has none itself.
   subroutine evaluate_at(deck, expression, value, known, silent)
      type(deck_t), intent(in) :: deck                 !< its texts and parameters are read
      type(token_t), intent(in) :: expression          !< place of its text, without < and >
      real(wp), intent(out) :: value                   !< 0 where it is not known
      logical, intent(out) :: known                    !< the expression has a value
      logical, intent(in), optional :: silent          !< nothing is reported; default .false.
      type(string_t), allocatable :: names(:)
      real(wp), allocatable :: values(:)
      type(expression_fault_t) :: fault

      call collect_known(deck, expression, names, values)
      call evaluate_expression(token_text(deck, expression), names, values, value, fault, has_own_degree(deck))
      known = .not. allocated(fault%text)
      if (present(silent)) then
         if (silent) return
      end if
      if (.not. known) call report_fault(deck, expression, fault, [string_t ::], 'PARAMETER')
   end subroutine evaluate_at

   !> The deck has a parameter of the name deg: before its definition deg is nothing.
   pure logical function has_own_degree(deck)
      type(deck_t), intent(in) :: deck !< its parameters are read

      has_own_degree = index_of_parameter(deck, 'deg') > 0
   end function has_own_degree

   !> A fault of an expression, at its place. Passed over in silence when it is a parameter whose definition was reported.
   subroutine report_fault(deck, expression, fault, also, keyword)
      type(deck_t), intent(in) :: deck                 !< its texts and parameters are read
      type(token_t), intent(in) :: expression          !< the place that `fault` counts from
      type(expression_fault_t), intent(in) :: fault    !< of this expression
      type(string_t), intent(in) :: also(:)            !< names that the expression knows besides
      character(len=*), intent(in) :: keyword          !< for `atrito help KEYWORD`
      type(token_t) :: place
      type(string_t), allocatable :: names(:)
      character(len=:), allocatable :: others
      integer(ip) :: i

      place = expression
      place%first = expression%first + fault%first - 1
      place%last = min(expression%last, expression%first + fault%last - 1)
      place%column = expression%column + fault%first - 1
      others = join(also, ', ')
      if (len(others) > 0) others = others//', '
      i = 0
      if (fault%unknown_name) i = index_of_parameter(deck, token_text(deck, place))
      if (.not. fault%unknown_name) then
         call report_error(deck, place, 'E-EXPRESSION', fault%text, keyword=keyword, &
                           expected='numbers, '//others//'earlier parameters, + - * / ** ( ), functions')
      else if (i == 0) then
         if (deck%has_lost_parameters) return
         names = reserved_names()
         call put_before(also, names)
         call report_error(deck, place, 'E-EXPRESSION', fault%text, keyword=keyword, known=names, among=deck%parameter_names, &
                           expected=others//'an earlier parameter, a function or pi')
      else if (deck%parameters(i)%known) then
         call report_later(deck, place, i, others//'an earlier parameter, a function or pi')
      end if
   end subroutine report_fault

   !> Not an array constructor: what function results hold in one is never given back (gfortran 12).
   pure subroutine put_before(first, names)
      type(string_t), intent(in) :: first(:)                 !< names that come first; copied
      type(string_t), allocatable, intent(inout) :: names(:) !< (n) becomes longer; its strings are moved
      type(string_t), allocatable :: both(:)
      integer :: i

      allocate (both(size(first) + size(names)))
      do i = 1, size(first)
         both(i)%s = first(i)%s
      end do
      do i = 1, size(names)
         call move_alloc(names(i)%s, both(size(first) + i)%s)
      end do
      call move_alloc(both, names)
   end subroutine put_before

   !> The parameters that an expression names, have values and are defined before its place: a deck can have thousands of others.
   subroutine collect_known(deck, place, names, values)
      type(deck_t), intent(in) :: deck                     !< its texts and parameters are read
      type(token_t), intent(in) :: place                   !< of the expression
      type(string_t), allocatable, intent(out) :: names(:) !< (n) in the order of their definitions
      real(wp), allocatable, intent(out) :: values(:)      !< (n)
      character(len=:), allocatable :: text
      integer(ip), allocatable :: used(:)
      integer(ip) :: i, n
      integer :: first, last

      text = token_text(deck, place)
      n = 0
      last = 0
      do
         call next_name(text, last, first)
         if (first > len(text)) exit
         i = index_of_parameter(deck, text(first:last))
         if (.not. is_known_at(deck, i, place)) cycle
         call make_room(used, n, n + 1)
         n = n + 1
         used(n) = i
      end do
      if (n > 0) used = each_once(used(:n))
      if (n > 0) n = size(used, kind=ip)
      allocate (names(n), values(n))
      do i = 1, n
         names(i)%s = deck%parameters(used(i))%name
         values(i) = deck%parameters(used(i))%value
      end do
   end subroutine collect_known

   !> A parameter has a value, and is defined before a place.
   pure logical function is_known_at(deck, i, place)
      type(deck_t), intent(in) :: deck                 !< its parameters are read
      integer(ip), intent(in) :: i                     !< the parameter; 0: there is none
      type(token_t), intent(in) :: place               !< of an expression

      is_known_at = i > 0
      if (is_known_at) is_known_at = deck%parameters(i)%known .and. &
                                     deck%parameters(i)%order < reading_order(deck, place%source, place%line)
   end function is_known_at

   !> A parameter is used before its definition.
   subroutine report_later(deck, place, i, what)
      type(deck_t), intent(in) :: deck                 !< its texts and parameters are read
      type(token_t), intent(in) :: place               !< of the name
      integer(ip), intent(in) :: i                     !< the parameter
      character(len=*), intent(in) :: what             !< what was expected

      associate (parameter => deck%parameters(i))
         call report_error(deck, place, 'E-PARAMETER', 'parameter '//token_text(deck, place)//' is used before its '// &
                           'definition in '//deck%sources(parameter%place%source)%name//':'//to_text(parameter%place%line), &
                           expected=what, keyword='PARAMETER')
      end associate
   end subroutine report_later

   !> Index of a parameter, 0 when there is none of this name.
   pure integer(ip) function index_of_parameter(deck, name) result(i)
      type(deck_t), intent(in) :: deck     !< its parameters are read
      character(len=*), intent(in) :: name !< without case

      i = find_name(deck%parameter_names, name)
   end function index_of_parameter

end module atrito_deck_expressions
