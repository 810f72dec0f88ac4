!> The arguments of quantities of nodes and places in an expression of --observe:
!>
!>     u2(P), u2(x, y), u2(x, y, BODY)                 P: a node, a set or a surface
!>     s_rr(P), s_rr(x, y), s_rr(x, y, BODY)           about the origin
!>     s_rr(P, xc, yc), s_rr(x, y, xc, yc[, BODY])     about a centre
module atrito_observed_arguments
   use atrito_expression_names, only: argument_t, call_t
   use atrito_expressions, only: evaluate_expression, expression_fault_t
   use atrito_kinds, only: ip, wp
   use atrito_messages, only: message_t
   use atrito_model, only: model_t
   use atrito_observed_places, only: find_place, find_point, has_element, has_support
   use atrito_observed_terms, only: is_of_strain, is_of_stress, term_t, FIRST_FORCE, TERM_NODES
   use atrito_place_fields, only: IS_POLAR
   use atrito_strings, only: string_t, same_name, to_text
   implicit none (type, external)
   private
   public :: find_nodes, complain_of_count, put_place

contains

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

end module atrito_observed_arguments
