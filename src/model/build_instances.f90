!> *INSTANCE: where the instances of parts stand.
module atrito_build_instances
   use atrito_build_context, only: build_context_t
   use atrito_deck, only: card_t, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_items, only: option_text
   use atrito_kinds, only: ip, wp
   use atrito_motion, only: read_shift, read_rotation
   implicit none (type, external)
   private
   public :: build_instances

contains

   !> The motions of all instances and, for people, where their numbers begin. Of a deck without parts there are none.
   subroutine build_instances(context)
      type(build_context_t), intent(inout) :: context !< gets motions, its model instances
      type(card_t) :: card
      integer(ip) :: i, n
      logical :: found

      n = 0
      if (allocated(context%deck%scopes)) n = size(context%deck%scopes, kind=ip) - 1
      allocate (context%model%instances(n), context%motions(0:n))
      do i = 1, n
         associate (scope => context%deck%scopes(i), instance => context%model%instances(i))
            if (.not. scope%ok) cycle
            card = context%deck%cards(scope%card)      ! a line of the translation, and one of the rotation
            associate (deck => context%deck, motion => context%motions(i))
               if (card%n_lines > 0) then
                  if (deck%lines(card%first_line)%ok) call read_shift(deck, deck%lines(card%first_line), motion, found)
               end if
               if (card%n_lines > 1) then
                  if (deck%lines(card%first_line + 1)%ok) call read_rotation(deck, deck%lines(card%first_line + 1), 1.0_wp, &
                                                                             motion, found)
               end if
            end associate
            instance%name = scope%name
            call option_text(context%deck, card, 'PART', instance%part, found)
            instance%first_number = min(scope%shift, huge(scope%shift) - 1) + 1 ! too many are refused
            instance%shift = context%motions(i)%shift
            instance%angle = context%motions(i)%angle
         end associate
      end do
      if (n > 0) call refuse_turned_dofs(context)
   end subroutine build_instances

   !> In a part the axes turn with the instance, but dofs are along those of the scene.
   subroutine refuse_turned_dofs(context)
      type(build_context_t), intent(in) :: context
      integer(ip) :: i

      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i))
            if (.not. abs(context%motions(card%scope)%angle) > 0.0_wp) cycle
            if (keyword_name(card) /= 'EQUATION' .and. keyword_name(card) /= 'SPRING') cycle
            call report_error(context%deck, card%place, 'E-PART', '*'//keyword_name(card)//' in a part, of which the instance '// &
                              context%deck%scopes(card%scope)%name//' is turned', &
                              expected='its place in the assembly, where dofs are along x and y', keyword='INSTANCE')
         end associate
      end do
   end subroutine refuse_turned_dofs

end module atrito_build_instances
