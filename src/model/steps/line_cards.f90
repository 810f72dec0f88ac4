!> What *SECTION PRINT and *PATH PRINT have in common: each data line draws a line through the bodies, and has a name in its step.
module atrito_line_cards
   use atrito_build_context, only: build_context_t, place_text
   use atrito_build_parts, only: drawn_lines_t
   use atrito_deck, only: card_t, count_lines, token_t, line_item
   use atrito_diagnostics, only: report_error
   use atrito_items, only: option_text
   use atrito_kinds, only: ip
   use atrito_model, only: model_t
   use atrito_name_list, only: add_name, find_name, name_list_t
   use atrito_references, only: find_set_option
   use atrito_sets, only: members_of
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: begin_lines_of_step, read_line_options, name_line, note_line, elements_to_cross

contains

   !> In a step names are given anew.
   pure subroutine begin_lines_of_step(drawn)
      type(drawn_lines_t), intent(inout) :: drawn !< earlier lines stay, their names are free

      drawn%n_before = drawn%n
      drawn%names = name_list_t()
   end subroutine begin_lines_of_step

   !> NAME and ELSET of a card. ok: whether its lines may be read.
   subroutine read_line_options(context, card, name, place, elset, ok)
      type(build_context_t), intent(inout) :: context      !< its element sets are searched
      type(card_t), intent(in) :: card                     !< *SECTION PRINT or *PATH PRINT
      character(len=:), allocatable, intent(out) :: name   !< of the card, NAME=; '' without one
      type(token_t), intent(out) :: place                  !< of the name
      integer(ip), intent(out) :: elset                    !< place of the set that is crossed; 0: everything
      logical, intent(out) :: ok                           !< there is a name, and the set is known
      logical :: found

      elset = 0
      call option_text(context%deck, card, 'NAME', name, found, place)
      ok = card%ok .and. found
      if (ok) call find_set_option(context, card, 'ELSET', 'element set', context%model%element_sets, elset, ok)
   end subroutine read_line_options

   !> The name of line i: that of the card, with -i behind it where the card has several. ok: no other of the step has it; else
   !> E-TWICE.
   subroutine name_line(context, card, i, given, place, drawn, name, ok)
      type(build_context_t), intent(inout) :: context      !< its deck is read
      type(card_t), intent(in) :: card                     !< *SECTION PRINT or *PATH PRINT
      integer(ip), intent(in) :: i                         !< data line of the card, from 1
      character(len=*), intent(in) :: given                !< name of the card
      type(token_t), intent(in) :: place                   !< of that name
      type(drawn_lines_t), intent(in) :: drawn             !< names of the step's lines so far
      character(len=:), allocatable, intent(out) :: name   !< of the line
      logical, intent(out) :: ok                           !< it is free; else that is reported
      integer(ip) :: before

      name = given
      if (card%n_lines > 1) name = given//'-'//to_text(i)
      before = find_name(drawn%names, name)
      ok = before == 0
      if (ok) return
      call report_error(context%deck, place, 'E-TWICE', trim(drawn%what)//' '//name//' is defined already in this step, in '// &
                        place_text(context%deck, drawn%items(drawn%n_before + before), place), &
                        expected='another NAME=, or all lines in one card')
   end subroutine name_line

   !> Counts a line in, with its name and its first item. There is room for one of each line of the deck's cards of this kind.
   subroutine note_line(context, card, i, name, drawn)
      type(build_context_t), intent(in) :: context !< its deck is read
      type(card_t), intent(in) :: card             !< *SECTION PRINT or *PATH PRINT
      integer(ip), intent(in) :: i                 !< data line of the card, from 1
      character(len=*), intent(in) :: name         !< of the line
      type(drawn_lines_t), intent(inout) :: drawn  !< gets the line

      if (.not. allocated(drawn%items)) allocate (drawn%items(count_lines(context%deck, card%name)))
      drawn%n = drawn%n + 1
      drawn%items(drawn%n) = line_item(context%deck, context%deck%lines(card%first_line + i - 1), 1_ip)
      call add_name(drawn%names, name)
   end subroutine note_line

   !> Which elements a line may cross: those of a set, or all.
   pure function elements_to_cross(model, elset) result(wanted)
      type(model_t), intent(in) :: model                   !< its element sets are read
      integer(ip), intent(in) :: elset                     !< place of the set; 0: all
      logical :: wanted(model%mesh%n_elements)

      wanted = elset == 0
      if (elset > 0) wanted(members_of(model%element_sets%sets(elset))) = .true.
   end function elements_to_cross

end module atrito_line_cards
