!> Where a keyword stands: model, step, or behind the end; and to what it belongs.
!>
!> Parts, instances and the assembly: which of them is open, and what may stand in it.
module atrito_card_order
   use atrito_deck, only: deck_t, card_t, token_t, token_text, KEYWORD_UNKNOWN, LEVEL_MODEL, LEVEL_STEP
   use atrito_diagnostics, only: report_error, refuse_card, report_deck_error
   use atrito_keyword, only: LEVEL_BOTH
   use atrito_kinds, only: ip
   use atrito_strings, only: upper_case, same_name
   implicit none (type, external)
   private
   public :: order_t, check_order, check_end

   !> In the place of a parent: one that is misspelt, which is reported.
   character(len=*), parameter :: LOST = '?'

   !> In the place of a parent: a keyword that changes the model within a step, refused.
   character(len=*), parameter :: CHANGED = '*'

   !> What is open between two cards: a *PART or an *INSTANCE (the block), and round an *INSTANCE the assembly.
   type :: parts_t
      integer(ip) :: n_blocks = 0                          !< so far
      logical :: in_block = .false., in_assembly = .false. !< between *PART, *INSTANCE or *ASSEMBLY and their ends
      logical :: is_loose = .false.                        !< an *INSTANCE without an assembly has been reported
      logical :: is_told = .false.                         !< of the block: something stands in it that cannot
      character(len=8) :: block = ''                       !< PART or INSTANCE
      type(token_t) :: block_place, assembly_place         !< the keywords that opened them
      character(len=:), allocatable :: name                !< of the block
   end type parts_t

   !> What has been read so far.
   type :: order_t
      logical :: in_step = .false.                 !< between *STEP and *END STEP
      integer(ip) :: n_steps = 0                   !< steps begun so far
      type(token_t) :: step                        !< the *STEP begun last
      character(len=32) :: parent = ''             !< keyword to whose block the next ones belong
      logical :: parent_ok = .true.                !< false where the parent was refused or is not known
      logical :: lost_step = .false.               !< a *STEP is misspelt: what stands outside of all steps may be in it
      type(parts_t) :: parts                       !< parts, instances and assembly
      logical :: incomplete = .false.              !< a file could not be read: no word about what is missing
   end type order_t

   !> What a part may hold.
   character(len=*), parameter :: MEMBERS(18) = [character(len=19) :: 'NODE', 'NGEN', 'NFILL', 'ELEMENT', 'ELGEN', 'NSET', &
                                                                  'ELSET', 'SURFACE', 'SOLID SECTION', 'TRANSFORM', 'ORIENTATION', &
                                                               'NODAL THICKNESS', 'EQUATION', 'RIGID BODY', 'SPRING', 'PARAMETER', &
                                                                                                   'INCLUDE', 'PRE-TENSION SECTION']

contains

   !> Checks the place of a card and marks its level.
   subroutine check_order(deck, order, card)
      type(deck_t), intent(in) :: deck      !< its texts and keyword table are read
      type(order_t), intent(inout) :: order !< what stands before the card; then with it
      type(card_t), intent(inout) :: card   !< gets its level, step and block; may be refused

      card%level = merge(LEVEL_STEP, LEVEL_MODEL, order%in_step)
      card%step = merge(order%n_steps, 0_ip, order%in_step)
      if (order%parts%in_block) card%block = order%parts%n_blocks
      if (card%keyword == KEYWORD_UNKNOWN) then
         if (card%changes_model) then
            order%parent = CHANGED
         else
            call follow_meaning()
         end if
         return
      end if
      if (order%parent == CHANGED .and. order%in_step .and. len(deck%keywords(card%keyword)%parent) > 0) then
         card%ok = .false.                         ! it belongs to what was refused
         card%is_refused = .true.
         return
      end if
      select case (card%name)
      case ('STEP')
         if (order%in_step) call refuse_card(deck, card, 'E-STEP', '*STEP inside a step', 'the *END STEP of the step before')
         order%n_steps = order%n_steps + 1
         order%in_step = .true.
         order%step = card%place
         card%level = LEVEL_STEP
         card%step = order%n_steps
      case ('END STEP')
         if (.not. (order%in_step .or. order%lost_step)) call refuse_card(deck, card, 'E-STEP', '*END STEP without a *STEP', &
                                                                          '*STEP before it')
         order%in_step = .false.
      case default
         call check_level()
      end select
      call check_parent()
      if (card%ok) call check_parts(deck, order%parts, card)

   contains

      !> A misspelt keyword is reported; what would only follow from it is not.
      subroutine follow_meaning()
         character(len=:), allocatable :: name
         integer :: i

         name = trim(card%meant)
         if (len(name) == 0) return
         if (name == 'STEP') order%lost_step = .true.
         if (name == 'END STEP') order%in_step = .false.
         do i = 1, size(deck%keywords)
            if (deck%keywords(i)%parent == name) order%parent = LOST
         end do
      end subroutine follow_meaning

      subroutine check_level()
         integer :: level

         level = deck%keywords(card%keyword)%level
         if (follows_only(deck, order, card)) then
            card%ok = .false.
         else if (order%n_steps > 0 .and. .not. order%in_step) then
            call refuse_card(deck, card, 'E-STEP', '*'//trim(card%name)//' stands after an *END STEP', &
                             'a *STEP, or nothing behind it')
         else if (level == LEVEL_MODEL .and. order%in_step .and. .not. is_removal(deck, card)) then
            call refuse_card(deck, card, 'E-LEVEL', '*'//trim(card%name)//' stands inside the step', 'its place before *STEP')
         else if (level == LEVEL_STEP .and. .not. order%in_step) then
            call refuse_card(deck, card, 'E-LEVEL', '*'//trim(card%name)//' stands outside of a step', &
                             'its place between *STEP and *END STEP')
         end if
      end subroutine check_level

      !> *ELASTIC belongs to the *MATERIAL before it; what may stand anywhere may stand between.
      subroutine check_parent()

         associate (keyword => deck%keywords(card%keyword))
            if (len(keyword%parent) == 0) then
               if (keyword%level == LEVEL_BOTH) return
               order%parent = card%name
               order%parent_ok = card%ok
            else if (keyword%parent /= order%parent .and. order%parent /= LOST) then
               call refuse_card(deck, card, 'E-PARENT', '*'//trim(card%name)//' belongs to no *'//keyword%parent, &
                                'its place behind *'//keyword%parent)
            end if
         end associate
      end subroutine check_parent
   end subroutine check_order

   !> REMOVE, which is reported by itself: no step changes the model.
   pure logical function is_removal(deck, card)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      integer :: i

      is_removal = .false.
      do i = 1, size(card%options)
         is_removal = is_removal .or. upper_case(token_text(deck, card%options(i)%name)) == 'REMOVE'
      end do
   end function is_removal

   !> What is wrong with the place of a card follows from what has been reported: of its *STEP, or of the keyword that it belongs
   !> to.
   pure logical function follows_only(deck, order, card)
      type(deck_t), intent(in) :: deck
      type(order_t), intent(in) :: order
      type(card_t), intent(in) :: card

      associate (keyword => deck%keywords(card%keyword))
         follows_only = order%lost_step .and. .not. order%in_step .and. (keyword%level == LEVEL_STEP .or. card%name == 'BOUNDARY')
         if (len(keyword%parent) == 0 .or. follows_only) return
         follows_only = order%parent == LOST .or. (keyword%parent == order%parent .and. .not. order%parent_ok)
      end associate
   end function follows_only

   !> Checks at the end of the deck that there was a step and that it ended.
   subroutine check_end(deck, order)
      type(deck_t), intent(in) :: deck   !< its texts, for messages; all is read
      type(order_t), intent(in) :: order !< at the end of the deck

      if (order%incomplete) return
      call check_open_parts(deck, order%parts)
      if (deck%n_cards == 0) then
         call report_deck_error(deck, 'E-EMPTY', 'the deck holds no keyword', expected='a deck, see atrito help')
      else if (order%n_steps == 0 .and. .not. order%lost_step) then
         call report_deck_error(deck, 'E-STEP', 'the deck has no *STEP', expected='*STEP ... *END STEP', keyword='STEP')
      else if (order%in_step) then
         call report_error(deck, order%step, 'E-STEP', '*STEP without *END STEP', expected='*END STEP at the end of the deck', &
                           keyword='STEP')
      end if
   end subroutine check_end

   !> Checks the place of a card and marks its block. Afterwards the block of a card that opens one is open.
   subroutine check_parts(deck, parts, card)
      type(deck_t), intent(in) :: deck      !< its texts, for messages
      type(parts_t), intent(inout) :: parts !< what is open before the card; then behind it
      type(card_t), intent(inout) :: card   !< gets its block; may be refused

      select case (card%name)
      case ('PART', 'INSTANCE')
         call check_assembly()
         call open_block()
      case ('ASSEMBLY')
         call refuse_nesting()
         if (parts%in_assembly .and. card%ok) call refuse_card(deck, card, 'E-PART', '*ASSEMBLY inside the assembly', &
                                                               'one *ASSEMBLY')
         parts%in_assembly = .true.
         parts%assembly_place = card%place
      case ('END PART', 'END INSTANCE')
         call close_block(deck, parts, card)
      case ('END ASSEMBLY')
         call refuse_nesting()
         if (.not. (parts%in_assembly .or. parts%is_loose)) then
            call refuse_card(deck, card, 'E-PART', '*END ASSEMBLY without an *ASSEMBLY', '*ASSEMBLY before it')
         end if
         parts%in_assembly = .false.
      case ('STEP')
         call check_open_parts(deck, parts)
         parts%in_block = .false.
         parts%in_assembly = .false.
      case default
         if (.not. parts%in_block) return
         card%block = merge(parts%n_blocks, 0_ip, any(MEMBERS == card%name))
         if (card%block > 0 .or. parts%is_told) return
         ! the first card that is of the whole deck is reported; what follows may be of it, or the end of the block is missing
         parts%is_told = .true.
         call refuse_card(deck, card, 'E-PART', '*'//trim(card%name)//' stands inside '//open_text(parts), &
                          'its place outside of parts and instances, which hold nodes, elements, sets, surfaces and sections')
      end select

   contains

      !> A part stands outside of the assembly, an instance in it.
      subroutine check_assembly()

         call refuse_nesting()
         if (.not. card%ok) then
            return
         else if (card%name == 'PART' .and. parts%in_assembly) then
            call refuse_card(deck, card, 'E-PART', '*PART inside the assembly', 'its place before *ASSEMBLY')
         else if (card%name == 'INSTANCE' .and. .not. (parts%in_assembly .or. parts%is_loose)) then
            call refuse_card(deck, card, 'E-PART', '*INSTANCE outside of an assembly', &
                             'its place between *ASSEMBLY and *END ASSEMBLY')
            parts%is_loose = .true.
         end if
      end subroutine check_assembly

      subroutine open_block()
         integer :: i

         parts%n_blocks = parts%n_blocks + 1
         parts%in_block = .true.
         parts%is_told = .false.
         parts%block = card%name(:len(parts%block))
         parts%block_place = card%place
         card%block = parts%n_blocks
         parts%name = 'it'
         do i = 1, size(card%options)                 ! they have not been looked up in the table yet
            if (.not. same_name(token_text(deck, card%options(i)%name), 'NAME')) cycle
            parts%name = token_text(deck, card%options(i)%value)
         end do
      end subroutine open_block

      !> Nothing of this kind may stand inside a part or an instance, which ends here.
      subroutine refuse_nesting()

         if (parts%in_block .and. .not. parts%is_told) call refuse_card(deck, card, 'E-PART', '*'//trim(card%name)//' inside '// &
                                                                        open_text(parts), '*END '//trim(parts%block)//' before it')
         parts%in_block = .false.
      end subroutine refuse_nesting
   end subroutine check_parts

   !> At the end of the model: all is closed. What is open is reported where it was opened.
   subroutine check_open_parts(deck, parts)
      type(deck_t), intent(in) :: deck   !< its texts, for messages
      type(parts_t), intent(in) :: parts !< what is open

      if (parts%in_block .and. parts%is_told) then
         return                                    ! its end is missing before that
      else if (parts%in_block) then
         call report_error(deck, parts%block_place, 'E-PART', '*'//trim(parts%block)//' without *END '//trim(parts%block), &
                           expected='*END '//trim(parts%block)//' behind what belongs to '//parts%name, keyword=trim(parts%block))
      else if (parts%in_assembly) then
         call report_error(deck, parts%assembly_place, 'E-PART', '*ASSEMBLY without *END ASSEMBLY', &
                           expected='*END ASSEMBLY before *STEP', keyword='ASSEMBLY')
      end if
   end subroutine check_open_parts

   subroutine close_block(deck, parts, card)
      type(deck_t), intent(in) :: deck
      type(parts_t), intent(inout) :: parts
      type(card_t), intent(inout) :: card

      if (.not. parts%in_block) then
         call refuse_card(deck, card, 'E-PART', '*'//trim(card%name)//' without '//trim(merge('a *PART     ', 'an *INSTANCE', &
                                                                                              card%name == 'END PART')), &
                          '*'//trim(card%name(5:))//' before it')
      else if (parts%block /= card%name(5:)) then
         call refuse_card(deck, card, 'E-PART', '*'//trim(card%name)//' inside '//open_text(parts), '*END '//trim(parts%block))
      end if
      card%block = merge(parts%n_blocks, 0_ip, parts%in_block)
      parts%in_block = .false.
   end subroutine close_block

   pure function open_text(parts) result(text)
      type(parts_t), intent(in) :: parts
      character(len=:), allocatable :: text

      text = 'the part '//parts%name
      if (parts%block == 'INSTANCE') text = 'the instance '//parts%name
   end function open_text

end module atrito_card_order
