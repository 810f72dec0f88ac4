!> Parts, instances and the assembly: which of them is open, and what may stand in it.
module atrito_part_order
   use atrito_deck, only: deck_t, card_t, token_t, token_text
   use atrito_diagnostics, only: report_error, refuse_card
   use atrito_kinds, only: ip
   use atrito_strings, only: same_name
   implicit none (type, external)
   private
   public :: parts_t, check_parts, check_open_parts

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

   !> What a part may hold.
   character(len=*), parameter :: MEMBERS(18) = [character(len=19) :: 'NODE', 'NGEN', 'NFILL', 'ELEMENT', 'ELGEN', 'NSET', &
                                                                  'ELSET', 'SURFACE', 'SOLID SECTION', 'TRANSFORM', 'ORIENTATION', &
                                                               'NODAL THICKNESS', 'EQUATION', 'RIGID BODY', 'SPRING', 'PARAMETER', &
                                                                                                   'INCLUDE', 'PRE-TENSION SECTION']

contains

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

end module atrito_part_order
