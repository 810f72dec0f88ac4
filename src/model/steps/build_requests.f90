!> *CONTROLS, and the tables and fields that the step asks for.
module atrito_build_requests
   use atrito_controls, only: controls_t, METHOD_PICARD, METHOD_NAME
   use atrito_deck, only: deck_t, card_t, token_t, token_text, option_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t
   use atrito_drawn_lines, only: read_cut_card, read_path_card
   use atrito_propagation, only: is_of_step
   use atrito_foreign_keywords, only: variable_of_component
   use atrito_items, only: find_option, has_option, option_integer, option_real, option_text, option_word, refuse_option
   use atrito_kinds, only: ip, wp
   use atrito_model, only: requested_t, requests_t, step_t
   use atrito_references, only: find_nodes, find_elements
   use atrito_strings, only: to_text, upper_case
   implicit none (type, external)
   private
   public :: build_requests, refuse_field_files

   real(wp), parameter :: LARGEST_TOLERANCE = 0.1_wp
   character(len=*), parameter :: AT_NODES = 'AVERAGED AT NODES'
   character(len=*), parameter :: WHAT_TOLERANCE = 'tolerance of the outer iteration, 0 < r <= 0.1 [-]'
   character(len=*), parameter :: WHAT_MAXIT = 'most outer iterations, an integer >= 1'
   integer(ip), parameter :: MOST_STARTS = 100000
   character(len=*), parameter :: WHAT_UNIQUENESS = 'starts of a search for other solutions, 1 to 100000'
   character(len=*), parameter :: WHAT_RELAXATION = 'part of each change that is taken, 0 < r <= 1 [-]'

contains

   !> Controls and requests of a step: those of the step before, and what its own cards change. Cards of a keyword take the place
   !> of what the same keyword asked for in the steps before.
   subroutine build_requests(context)
      type(build_context_t), intent(inout) :: context  !< controls and requests of its open step are set
      integer(ip) :: i

      associate (steps => context%model%steps, k => context%open%number)
         if (k > 1) then
            steps(k)%controls = steps(k - 1)%controls
            steps(k)%requests = steps(k - 1)%requests
            call forget_replaced(context, steps(k)%requests)
         end if
         do i = context%open%first_card, context%open%last_card
            if (is_of_step(context, i)) call read_card(context, context%deck%cards(i), steps(k))
         end do
         call check_relaxation(context, steps(k)%controls)
      end associate
   end subroutine build_requests

   subroutine read_card(context, card, step)
      type(build_context_t), intent(inout) :: context
      type(card_t), intent(in) :: card
      type(step_t), intent(inout) :: step
      type(option_t) :: option
      logical :: found

      call find_option(context%deck, card, 'FREQUENCY', option, found)
      if (found) found = verify(token_text(context%deck, option%value), '0') == 0
      if (found) return                                ! FREQUENCY=0: what earlier steps asked for is not printed any more
      associate (requests => step%requests, every => step%requests%every)
         select case (keyword_name(card))
         case ('CONTROLS')
            call read_controls_card(context%deck, card, step%controls)
         case ('NODE PRINT')
            call read_request_card(card, context, requests%requested_t)
            if (asks_for(context%deck, card, 'U')) call read_frequency(context%deck, card, every%nodes)
            if (asks_for(context%deck, card, 'RF')) call read_frequency(context%deck, card, every%reactions)
         case ('EL PRINT')
            if (option_word(context%deck, card, 'POSITION') == AT_NODES) then
               call read_nodal_stress(card, context, requests)
               call read_frequency(context%deck, card, every%nodal_stress)
            else
               call read_request_card(card, context, requests%requested_t)
               call read_frequency(context%deck, card, every%stress)
            end if
         case ('CONTACT PRINT')
            requests%contact = .true.
            call read_frequency(context%deck, card, every%contact)
         case ('BODY PRINT')
            requests%bodies = .true.
            call read_frequency(context%deck, card, every%bodies)
         case ('JOINT PRINT')
            requests%joints = .true.
            call read_frequency(context%deck, card, every%joints)
         case ('SECTION PRINT')
            call read_cut_card(context, card, requests)
            call read_frequency(context%deck, card, every%sections)
         case ('PATH PRINT')
            call read_path_card(context, card, requests)
            call read_frequency(context%deck, card, every%paths)
         case ('NODE FILE', 'EL FILE')
            call read_request_card(card, context, requests%fields)
            call read_frequency(context%deck, card, every%fields)
         case ('CONTACT FILE')
            requests%fields%contact = .true.
            call read_frequency(context%deck, card, every%fields)
         end select
      end associate
   end subroutine read_card

   !> FREQUENCY= of a table or of the field file, one in a step.
   subroutine read_frequency(deck, card, every)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      integer(ip), intent(inout) :: every              !< 0: no card of the step has given it
      character(len=*), parameter :: WHAT = 'increments from one print to the next, an integer >= 1; 0: nothing is printed; '// &
                                     'else the end of the step is printed always'
      type(option_t) :: option
      integer(ip) :: n
      logical :: found

      n = 0
      call option_integer(deck, card, 'FREQUENCY', WHAT, n, found)
      if (.not. found) return
      call find_option(deck, card, 'FREQUENCY', option, found)
      if (n < 1) then
         call report_error(deck, option%value, 'E-VALUE', 'FREQUENCY = '//to_text(n)//' is out of range', expected=WHAT)
      else if (every > 0 .and. every /= n) then
         call report_error(deck, option%value, 'E-CONFLICT', 'FREQUENCY = '//to_text(n)//' here, but '//to_text(every)// &
                           ' before in this step', expected='one FREQUENCY= for a table, and for the field file, in a step')
      else
         every = n
      end if
   end subroutine read_frequency

   !> What the cards of this step give anew.
   subroutine forget_replaced(context, requests)
      type(build_context_t), intent(in) :: context
      type(requests_t), intent(inout) :: requests
      integer(ip) :: i

      associate (every => requests%every, fields => requests%fields)
         do i = context%open%first_card, context%open%last_card
            if (.not. is_of_step(context, i)) cycle
            select case (keyword_name(context%deck%cards(i)))
            case ('NODE PRINT')
               call forget(requests%nodes, requests%node_u, every%nodes)
               call forget(requests%reactions, requests%node_rf, every%reactions)
            case ('NODE FILE')
               call forget(fields%nodes, fields%node_u, every%fields)
               call forget(fields%reactions, fields%node_rf, every%fields)
            case ('EL PRINT')
               call forget(requests%stress, requests%element_s, every%stress)
               call forget(requests%nodal_stress, requests%node_s, every%nodal_stress)
            case ('EL FILE')
               call forget(fields%stress, fields%element_s, every%fields)
            case ('CONTACT FILE')
               every%fields = 0
            case ('CONTACT PRINT')
               every%contact = 0
            case ('BODY PRINT')
               every%bodies = 0
            case ('JOINT PRINT')
               every%joints = 0
            case ('SECTION PRINT')
               if (allocated(requests%cuts)) deallocate (requests%cuts)
               every%sections = 0
            case ('PATH PRINT')
               if (allocated(requests%paths)) deallocate (requests%paths)
               every%paths = 0
            end select
         end do
      end associate
   end subroutine forget_replaced

   !> A field is not asked for, and at no frequency.
   pure subroutine forget(wanted, mask, every)
      logical, intent(out) :: wanted
      logical, allocatable, intent(inout) :: mask(:)
      integer(ip), intent(out) :: every

      wanted = .false.
      if (allocated(mask)) deallocate (mask)
      every = 0
   end subroutine forget

   subroutine read_controls_card(deck, card, controls)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(controls_t), intent(inout) :: controls
      logical :: found

      if (has_option(deck, card, 'METHOD')) then
         controls%method = max(1_ip, findloc(METHOD_NAME == option_word(deck, card, 'METHOD'), .true., dim=1, kind=ip))
      end if
      call option_real(deck, card, 'TOLERANCE', WHAT_TOLERANCE, controls%tolerance, found)
      if (found .and. .not. (controls%tolerance > 0.0_wp .and. controls%tolerance <= LARGEST_TOLERANCE)) then
         call refuse_option(deck, card, 'TOLERANCE', WHAT_TOLERANCE)
      end if
      call option_integer(deck, card, 'MAXIT', WHAT_MAXIT, controls%max_iterations, found)
      if (found .and. controls%max_iterations < 1) call refuse_option(deck, card, 'MAXIT', WHAT_MAXIT)
      call option_real(deck, card, 'RELAXATION', WHAT_RELAXATION, controls%relaxation, found)
      if (found .and. .not. (controls%relaxation > 0.0_wp .and. controls%relaxation <= 1.0_wp)) then
         call refuse_option(deck, card, 'RELAXATION', WHAT_RELAXATION)
      end if
      call option_integer(deck, card, 'UNIQUENESS', WHAT_UNIQUENESS, controls%starts, found)
      if (found .and. .not. (controls%starts >= 1 .and. controls%starts <= MOST_STARTS)) then
         call refuse_option(deck, card, 'UNIQUENESS', WHAT_UNIQUENESS)
      end if
   end subroutine read_controls_card

   !> RELAXATION= belongs to PICARD: the other methods choose their steps themselves.
   subroutine check_relaxation(context, controls)
      type(build_context_t), intent(in) :: context
      type(controls_t), intent(in) :: controls
      type(option_t) :: option
      integer(ip) :: i
      logical :: found

      if (controls%method == METHOD_PICARD) return
      do i = context%open%first_card, context%open%last_card
         if (.not. is_of_step(context, i)) cycle
         if (keyword_name(context%deck%cards(i)) /= 'CONTROLS' .or. .not. context%deck%cards(i)%ok) cycle
         call find_option(context%deck, context%deck%cards(i), 'RELAXATION', option, found)
         if (.not. found) cycle
         call report_error(context%deck, option%name, 'E-CONFLICT', 'RELAXATION= is for METHOD=PICARD; the method here is '// &
                           trim(METHOD_NAME(controls%method)), expected='METHOD=PICARD, or no RELAXATION=')
      end do
   end subroutine check_relaxation

   !> *NODE PRINT, *NODE FILE, *EL PRINT, *EL FILE
   subroutine read_request_card(card, context, requested)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(in) :: context
      type(requested_t), intent(inout) :: requested
      logical, allocatable :: chosen(:)
      logical :: ok, with_principal

      if (index(keyword_name(card), 'NODE') == 1) then
         call choose_members(card, 'NSET', context%model%mesh%n_nodes, context, chosen, ok)
         if (ok .and. asks_for(context%deck, card, 'U')) call ask_for(chosen, requested%nodes, requested%node_u)
         if (ok .and. asks_for(context%deck, card, 'RF')) call ask_for(chosen, requested%reactions, requested%node_rf)
      else
         call choose_members(card, 'ELSET', context%model%mesh%n_elements, context, chosen, ok)
         with_principal = keyword_name(card) == 'EL PRINT' .and. asks_for(context%deck, card, 'SP')
         requested%principal = requested%principal .or. with_principal
         if (ok .and. (with_principal .or. asks_for(context%deck, card, 'S'))) then
            call ask_for(chosen, requested%stress, requested%element_s)
         end if
      end if
   end subroutine read_request_card

   !> *EL PRINT, POSITION=AVERAGED AT NODES: the nodes of the elements.
   subroutine read_nodal_stress(card, context, requests)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(in) :: context
      type(requests_t), intent(inout) :: requests
      logical, allocatable :: elements(:), nodes(:)
      integer(ip) :: e
      logical :: ok, with_principal

      associate (mesh => context%model%mesh)
         call choose_members(card, 'ELSET', mesh%n_elements, context, elements, ok)
         with_principal = asks_for(context%deck, card, 'SP')
         requests%principal = requests%principal .or. with_principal
         if (.not. ok .or. .not. (with_principal .or. asks_for(context%deck, card, 'S'))) return
         allocate (nodes(mesh%n_nodes), source=.false.)
         do e = 1, mesh%n_elements
            if (elements(e)) nodes(mesh%nodes(:mesh%shape(e), e)) = .true.
         end do
         call ask_for(nodes, requests%nodal_stress, requests%node_s)
      end associate
   end subroutine read_nodal_stress

   !> Adds members to those asked for before.
   pure subroutine ask_for(chosen, wanted, mask)
      logical, intent(in) :: chosen(:)
      logical, intent(inout) :: wanted
      logical, allocatable, intent(inout) :: mask(:)

      wanted = .true.
      if (.not. allocated(mask)) mask = chosen
      mask = mask .or. chosen
   end subroutine ask_for

   !> Reports every card that asks for fields or restart files: for a build that cannot write them.
   subroutine refuse_field_files(deck)
      type(deck_t), intent(in) :: deck           !< as read
      integer(ip) :: i

      do i = 1, deck%n_cards
         select case (keyword_name(deck%cards(i)))
         case ('NODE FILE', 'EL FILE', 'CONTACT FILE', 'RESTART')
            call report_error(deck, deck%cards(i)%place, 'E-NOT-BUILT', '*'//keyword_name(deck%cards(i))// &
                              ': this build of atrito has no HDF5', expected='an atrito built with -DATRITO_HDF5=ON, or no *'// &
                              keyword_name(deck%cards(i)))
         end select
      end do
   end subroutine refuse_field_files

   !> The members of the set that an option names; all without it.
   subroutine choose_members(card, option, n, context, chosen, ok)
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: option           !< NSET or ELSET
      integer(ip), intent(in) :: n                     !< nodes or elements of the mesh
      type(build_context_t), intent(in) :: context
      logical, allocatable, intent(out) :: chosen(:)
      logical, intent(out) :: ok
      character(len=:), allocatable :: name
      type(token_t) :: place
      integer(ip), allocatable :: members(:)
      logical :: given

      ok = .true.
      call option_text(context%deck, card, option, name, given, place)
      allocate (chosen(n), source=.not. given)
      if (.not. given) return
      if (option == 'NSET') call find_nodes(context, place, members, ok)
      if (option == 'ELSET') call find_elements(context, place, members, ok)
      chosen(members) = .true.
   end subroutine choose_members

   !> One of the card's items is this variable, or a component of it.
   pure logical function asks_for(deck, card, variable)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: variable
      character(len=:), allocatable :: word
      integer(ip) :: i, k

      asks_for = .false.
      do i = card%first_line, card%first_line + card%n_lines - 1
         do k = 1, deck%lines(i)%n_tokens
            word = upper_case(token_text(deck, line_item(deck, deck%lines(i), k)))
            asks_for = asks_for .or. word == variable .or. variable_of_component(word) == variable
         end do
      end do
   end function asks_for

end module atrito_build_requests
