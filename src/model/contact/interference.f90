!> *CONTACT INTERFERENCE, SHRINK: the initial overlap of a pair is resolved over a step, not at once.
!>
!> Until the step the whole overlap is allowed, so that contact does not feel it; over the step what is allowed goes to 0.
module atrito_interference
   use atrito_build_context, only: build_context_t, place_text
   use atrito_deck, only: card_t, data_line_t, keyword_name, line_item, option_t, token_t
   use atrito_diagnostics, only: report_error, report_note
   use atrito_items, only: find_option, get_name, has_option
   use atrito_kinds, only: ip, wp
   use atrito_pair_names, only: pair_index_t, index_pairs, find_pair
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: interference_t, read_interferences, set_interferences

   character(len=*), parameter :: KEYWORD = 'CONTACT INTERFERENCE'

   !> What a line says.
   type :: interference_t
      integer(ip) :: pair = 0                          !< place in model%pairs
      integer(ip) :: step = 0                          !< that resolves the overlap
      type(token_t) :: place
   end type interference_t

contains

   !> All lines of a deck. The surfaces of its pairs are known.
   subroutine read_interferences(context, list)
      type(build_context_t), intent(inout) :: context
      type(interference_t), allocatable, intent(out) :: list(:)
      type(interference_t) :: one
      type(pair_index_t) :: pairs
      integer(ip), allocatable :: of_pair(:)           ! place in the list; 0: none so far
      integer(ip) :: i, k, n

      allocate (list(size(context%model%pairs)))       ! a pair is resolved once
      allocate (of_pair(size(list)), source=0_ip)
      call index_pairs(context, pairs)
      n = 0
      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i))
            if (keyword_name(card) /= KEYWORD .or. .not. card%ok) cycle
            if (.not. has_shrink(context, card)) cycle
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. context%deck%lines(k)%ok) cycle
               call read_line(context, pairs, context%deck%lines(k), one)
               one%step = card%step
               if (one%pair > 0) call add_line(context, one, list, of_pair, n)
            end do
         end associate
      end do
      list = list(:n)
   end subroutine read_interferences

   !> A pair is resolved once.
   subroutine add_line(context, one, list, of_pair, n)
      type(build_context_t), intent(inout) :: context
      type(interference_t), intent(in) :: one
      type(interference_t), intent(inout) :: list(:)   !< the first n are in use
      integer(ip), intent(inout) :: of_pair(:), n
      integer(ip) :: twin

      twin = of_pair(one%pair)
      if (twin > 0) then
         call report_error(context%deck, one%place, 'E-TWICE', 'the overlap of this pair is resolved already, in '// &
                           place_text(context%deck, list(twin)%place, one%place), expected='each pair in one step', &
                           keyword=KEYWORD)
         return
      end if
      n = n + 1
      list(n) = one
      of_pair(one%pair) = n
      context%model%pairs(one%pair)%is_resolved = .true.
   end subroutine add_line

   !> Allowed interferences that are given are not built.
   logical function has_shrink(context, card)
      type(build_context_t), intent(in) :: context
      type(card_t), intent(in) :: card
      type(option_t) :: option
      logical :: found

      has_shrink = has_option(context%deck, card, 'SHRINK')
      if (.not. has_shrink) then
         call report_error(context%deck, card%place, 'E-NOT-BUILT', 'an interference that is given is not built', &
                           expected='SHRINK, which resolves the initial overlap over the step; *CLEARANCE, VALUE= gives it', &
                           keyword=KEYWORD)
         return
      end if
      call find_option(context%deck, card, 'AMPLITUDE', option, found)
      if (.not. found) return
      has_shrink = .false.
      call report_error(context%deck, option%name, 'E-CONFLICT', 'SHRINK resolves the overlap linearly over the step', &
                        expected='SHRINK without AMPLITUDE', keyword=KEYWORD)
   end function has_shrink

   !> slave, master.
   subroutine read_line(context, pairs, line, one)
      type(build_context_t), intent(in) :: context
      type(pair_index_t), intent(in) :: pairs
      type(data_line_t), intent(in) :: line
      type(interference_t), intent(out) :: one
      type(string_t) :: names(2)
      type(token_t) :: places(2)
      integer(ip) :: i
      logical :: ok(2)

      do i = 1, 2
         places(i) = line_item(context%deck, line, i)
         call get_name(context%deck, places(i), 'name of a surface', names(i)%s, ok(i), KEYWORD)
      end do
      one%place = places(1)
      if (all(ok)) call find_pair(context, pairs, names, places, names(2)%s//', '//names(1)%s, KEYWORD, one%pair)
   end subroutine read_line

   !> Gives the steps what they allow; the points of the pairs are known.
   subroutine set_interferences(list, context)
      type(interference_t), intent(in) :: list(:)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i, k

      if (size(list) == 0) return
      associate (model => context%model)
         do k = 1, size(model%steps, kind=ip)
            allocate (model%steps(k)%overlap(size(model%pairs)), model%steps(k)%overlap_from(size(model%pairs)), source=0.0_wp)
            do i = 1, size(list, kind=ip)
               if (k < list(i)%step) model%steps(k)%overlap(list(i)%pair) = 1.0_wp
               if (k <= list(i)%step) model%steps(k)%overlap_from(list(i)%pair) = 1.0_wp
            end do
         end do
      end associate
      do i = 1, size(list, kind=ip)
         call note_nothing_to_do(context, list(i))
      end do
   end subroutine set_interferences

   subroutine note_nothing_to_do(context, one)
      type(build_context_t), intent(in) :: context
      type(interference_t), intent(in) :: one

      associate (points => context%model%points(one%pair))
         if (any(points%gap < 0.0_wp)) return
         call report_note(context%deck, one%place, 'N-NO-OVERLAP', 'this pair has no initial overlap; its least gap is '// &
                          to_text(minval(points%gap), 4)//' [L]', keyword=KEYWORD)
      end associate
   end subroutine note_nothing_to_do

end module atrito_interference
