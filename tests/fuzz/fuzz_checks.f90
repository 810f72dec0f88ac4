!> What must hold after every reading, whatever the deck.
module fuzz_checks
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_deck, only: deck_t
   use atrito_files, only: read_file
   use atrito_kinds, only: ip
   use atrito_messages, only: json_of_message
   use atrito_messages, only: message_t, count_messages, get_message, format_message, sort_messages, SEVERITY_ERROR, &
                              SEVERITY_NOTE
   use atrito_mesh, only: signed_area
   use atrito_model, only: model_t
   use atrito_sets, only: numbers_in, set_list_t, set_count
   use atrito_results, only: results_t
   use atrito_status, only: status_t, is_ok, STATUS_DECK, STATUS_NOT_CONVERGED, STATUS_SINGULAR
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: check_reading, check_model, check_results

contains

   !> status agrees with the messages; every message has a place within its file and can be told.
   subroutine check_reading(deck, status, fault)
      type(deck_t), intent(in) :: deck
      type(status_t), intent(in) :: status
      character(len=:), allocatable, intent(inout) :: fault    !< what does not hold; not allocated: all does
      integer(ip) :: i

      if (.not. is_ok(status)) then
         if (status%code /= STATUS_DECK) fault = 'status '//to_text(int(status%code, ip))
         if (count_messages(SEVERITY_ERROR) == 0) fault = 'a status that is not OK, and no error'
      end if
      call sort_messages()
      do i = 1, count_messages()
         call check_message(deck, get_message(i), fault)
         if (allocated(fault)) return
      end do
   end subroutine check_reading

   subroutine check_message(deck, message, fault)
      type(deck_t), intent(in) :: deck
      type(message_t), intent(in) :: message
      character(len=:), allocatable, intent(inout) :: fault
      type(string_t), allocatable :: lines(:)
      integer(ip) :: i

      if (message%severity < SEVERITY_ERROR .or. message%severity > SEVERITY_NOTE) fault = 'a severity that does not exist'
      if (.not. allocated(message%id) .or. .not. allocated(message%text)) then
         fault = 'a message without id or text'
         return
      end if
      if (.not. allocated(message%file)) then
         fault = '['//message%id//'] without a file'
         return
      end if
      if (message%line > 0) call check_place(deck, message, fault)
      lines = format_message(message)
      do i = 1, size(lines, kind=ip)
         if (has_control(lines(i)%s)) fault = '['//message%id//'] is told with a control character'
      end do
      if (.not. is_json(json_of_message(message))) fault = '['//message%id//'] is no object of JSON'
   end subroutine check_message

   !> The place is one of the file: a line of it, a column at most one behind the line's end.
   subroutine check_place(deck, message, fault)
      type(deck_t), intent(in) :: deck
      type(message_t), intent(in) :: message
      character(len=:), allocatable, intent(inout) :: fault
      character(len=:), allocatable :: text
      type(status_t) :: status
      integer(ip) :: i

      do i = 1, deck%n_sources
         if (deck%sources(i)%name == message%file) exit
      end do
      if (i > deck%n_sources) then
         fault = '['//message%id//'] in a file that was not read'
         return
      end if
      text = deck%sources(i)%text
      if (len(text) == 0) call read_file(message%file, text, status) ! the text of a mesh is not kept
      call check_position(text, message, fault)
   end subroutine check_place

   subroutine check_position(text, message, fault)
      character(len=*), intent(in) :: text
      type(message_t), intent(in) :: message
      character(len=:), allocatable, intent(inout) :: fault
      integer(ip) :: line, first, last

      first = 1
      do line = 2, message%line
         last = index(text(first:), achar(10), kind=ip)
         if (last == 0) fault = '['//message%id//'] behind the end of the file, line '//to_text(message%line)
         if (last == 0) return
         first = first + last
      end do
      last = index(text(first:)//achar(10), achar(10), kind=ip)
      if (message%column < 1 .or. message%column > last) then
         fault = '['//message%id//'] in column '//to_text(message%column)//' of '//to_text(last - 1)
      else if (message%length < 1) then
         fault = '['//message%id//'] marks nothing'
      end if
   end subroutine check_position

   pure logical function has_control(text)
      character(len=*), intent(in) :: text
      integer :: i

      has_control = .false.
      do i = 1, len(text)
         has_control = has_control .or. ichar(text(i:i)) < 32 .or. ichar(text(i:i)) == 127
      end do
   end function has_control

   !> One object: brackets that fit, outside of texts nothing but what JSON has, inside no control character, broken UTF-8 or
   !> escape that does not exist.
   pure logical function is_json(text)
      character(len=*), intent(in) :: text
      logical :: in_text
      integer :: i, depth, n

      is_json = .false.
      in_text = .false.
      depth = 0
      i = 1
      do while (i <= len(text))
         n = 1
         if (.not. in_text) then
            if (scan(text(i:i), '{[') > 0) depth = depth + 1
            if (scan(text(i:i), '}]') > 0) depth = depth - 1
            if (scan(text(i:i), '{}[]:,-"0123456789nul') == 0) return
            if (depth < 1 .and. i < len(text)) return
         else if (text(i:i) == achar(92)) then
            n = escape_length(text(i:))
         else
            n = utf8_length(text(i:))
         end if
         if (n == 0) return
         if (n == 1 .and. text(i:i) == '"') in_text = .not. in_text
         i = i + n
      end do
      is_json = depth == 0 .and. .not. in_text
   end function is_json

   !> Of a backslash and what belongs to it; 0: JSON has no such escape.
   pure integer function escape_length(text) result(n)
      character(len=*), intent(in) :: text

      n = 0
      if (len(text) < 2) return
      if (scan(text(2:2), '"/bfnrt'//achar(92)) > 0) n = 2
      if (text(2:2) /= 'u' .or. len(text) < 6) return
      if (verify(text(3:6), '0123456789abcdefABCDEF') == 0) n = 6
   end function escape_length

   !> Of the character at the beginning; 0: a control character, or not UTF-8.
   pure integer function utf8_length(text) result(n)
      character(len=*), intent(in) :: text
      integer :: first, second, i

      first = iachar(text(1:1))
      n = 0
      if (first < 32) return
      if (first < 128) n = 1
      if (first >= 194 .and. first < 224) n = 2
      if (first >= 224 .and. first < 240) n = 3
      if (first >= 240 .and. first < 245) n = 4
      if (n < 2) return
      if (len(text) < n) n = 0
      if (n == 0) return
      do i = 2, n
         if (iand(iachar(text(i:i)), 192) /= 128) n = 0
      end do
      if (n == 0) return
      second = iachar(text(2:2))
      if (first == 224 .and. second < 160 .or. first == 237 .and. second > 159 .or. first == 240 .and. second < 144 .or. &
          first == 244 .and. second > 143) n = 0
   end function utf8_length

   !> A model without errors is whole and sound.
   subroutine check_model(model, fault)
      type(model_t), intent(in) :: model
      character(len=:), allocatable, intent(inout) :: fault
      integer(ip) :: e, n

      n = model%mesh%n_nodes
      if (n == 0 .or. model%mesh%n_elements == 0) then
         fault = 'a model without elements'
         return
      end if
      if (any(model%mesh%node_id < 1) .or. any(model%mesh%element_id < 1)) fault = 'a number that is not positive'
      if (.not. all(ieee_is_finite(model%mesh%x))) fault = 'a coordinate that is no number'
      do e = 1, model%mesh%n_elements
         if (all(model%mesh%shape(e) /= [3_ip, 4_ip, 6_ip, 8_ip, 9_ip])) fault = 'an element of no shape'
         if (allocated(fault)) return
         associate (nodes => model%mesh%nodes(:model%mesh%shape(e), e))
            if (any(nodes < 1) .or. any(nodes > n)) fault = 'an element with a node that does not exist'
         end associate
         if (allocated(fault)) return
         if (.not. signed_area(model%mesh, e) > 0) fault = 'an element without area'
      end do
      if (any(model%section_of < 1) .or. any(model%section_of > size(model%sections))) fault = 'an element without section'
      if (any(model%sections%material < 1)) fault = 'a section without material'
      if (.not. all(model%materials(model%sections%material)%young > 0)) fault = 'a modulus that is not positive'
      call check_sets(model%node_sets, n, fault)
      call check_sets(model%element_sets, model%mesh%n_elements, fault)
      call check_conditions(model, fault)
   end subroutine check_model

   subroutine check_sets(list, n, fault)
      type(set_list_t), intent(in) :: list
      integer(ip), intent(in) :: n
      character(len=:), allocatable, intent(inout) :: fault
      integer(ip) :: i

      do i = 1, set_count(list)
         associate (members => numbers_in(list%sets(i)%members))
            if (any(members < 1 .or. members > n)) fault = 'set '//list%sets(i)%name//' with a member that does not exist'
         end associate
      end do
   end subroutine check_sets

   subroutine check_conditions(model, fault)
      type(model_t), intent(in) :: model
      character(len=:), allocatable, intent(inout) :: fault
      integer(ip) :: i

      associate (prescribed => model%steps(1)%prescribed)
         do i = 1, prescribed%n
            if (prescribed%node(i) < 1 .or. prescribed%node(i) > model%mesh%n_nodes) fault = 'a support nowhere'
            if (all(prescribed%dof(i) /= [1, 2])) fault = 'a support of no direction'
            if (.not. ieee_is_finite(prescribed%value(i))) fault = 'a prescribed displacement that is no number'
         end do
      end associate
      do i = 1, model%steps(1)%node_loads%n
         if (.not. ieee_is_finite(model%steps(1)%node_loads%value(i))) fault = 'a force that is no number'
      end do
      do i = 1, model%steps(1)%element_loads%n
         if (.not. all(ieee_is_finite(model%steps(1)%element_loads%value(:, i)))) fault = 'a load that is no number'
      end do
      do i = 1, size(model%pairs, kind=ip)
         if (model%pairs(i)%slave < 1 .or. model%pairs(i)%slave > size(model%surfaces)) fault = 'a pair without slave'
         if (model%pairs(i)%master < 1 .or. model%pairs(i)%master > size(model%surfaces)) fault = 'a pair without master'
      end do
   end subroutine check_conditions

   !> A solution that is called one consists of numbers.
   subroutine check_results(results, status, fault)
      type(results_t), intent(in) :: results
      type(status_t), intent(in) :: status
      character(len=:), allocatable, intent(inout) :: fault

      if (.not. is_ok(status)) then
         if (all(status%code /= [STATUS_DECK, STATUS_NOT_CONVERGED, STATUS_SINGULAR])) then
            fault = 'status '//to_text(int(status%code, ip))//' of the solution'
            if (allocated(status%text)) fault = fault//': '//status%text
         end if
         return
      end if
      if (.not. (results%converged .and. results%law_holds)) return
      if (.not. allocated(results%u) .or. .not. allocated(results%reaction)) then
         fault = 'a solution without displacements'
         return
      end if
      if (.not. all(ieee_is_finite(results%u))) fault = 'a displacement that is no number'
      if (.not. all(ieee_is_finite(results%reaction))) fault = 'a reaction that is no number'
      if (allocated(results%stress)) then
         if (.not. all(ieee_is_finite(results%stress))) fault = 'a stress that is no number'
      end if
      if (.not. ieee_is_finite(results%strain_energy)) fault = 'an energy that is no number'
   end subroutine check_results

end module fuzz_checks
