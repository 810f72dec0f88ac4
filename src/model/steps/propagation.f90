!> How supports and loads propagate from step to step: a step has those of the one before with the values that they had at its end,
!> but for those whose place its own lines take (*BOUNDARY, *CLOAD, *DLOAD, *DSLOAD with OP=MOD) or that OP=NEW removes.
!>
!> A condition has two values, at the beginning and at the end of its step, between which it goes linearly. In the next step it
!> begins with the value that it has come to, and stays there: with an amplitude a that is value times a(end of the step). What is
!> removed or replaced goes from there to 0 or to the new value.
!>
!> What the lines of supports and loads act on, by the names of the deck: the rows of resultants.tab.
module atrito_propagation
   use atrito_step_loads, only: factor_at, time_before
   use atrito_build_context, only: build_context_t, inherited_t, place_text, replaced_t
   use atrito_deck, only: token_t, keyword_name, line_item, token_text, is_empty_token
   use atrito_items, only: evaluate_at, get_real, has_option, option_text, option_word
   use atrito_diagnostics, only: report_error, report_warning
   use atrito_growth, only: resize
   use atrito_id_map, only: id_map_t, add_id
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: condition_t, condition_list_t, add_condition, scaled
   use atrito_model, only: LOAD_HYDROSTATIC
   use atrito_name_list, only: add_name, find_name, names_of
   use atrito_strings, only: same_name, upper_case, string_t, to_text
   implicit none (type, external)
   private
   public :: is_of_step, is_inherited, removes_all, propagate, list_inherited, apply_condition, set_to_zero, warn_of_replaced, &
             open_source, keep_sources

   integer(ip), parameter :: LABEL_ITEM = 2, FIRST = 4, LAST = 9   !< of a line of a load: label; direction, or point and axis

   character(len=*), parameter :: ALL_ELEMENTS = 'all_elements'   !< of a line that names none

contains

   !> A card of the step that is being built; what stands outside of all steps, which is reported, is read with the first.
   pure logical function is_of_step(context, i)
      type(build_context_t), intent(in) :: context     !< its deck and open%number are read
      integer(ip), intent(in) :: i                     !< card of the deck

      is_of_step = max(context%deck%cards(i)%step, 1_ip) == context%open%number
   end function is_of_step

   !> Whether a condition is not given by a line of the step that is being built.
   pure logical function is_inherited(context, condition)
      type(build_context_t), intent(in) :: context     !< its deck and open%first_token are read
      type(condition_t), intent(in) :: condition       !< of supports or loads

      is_inherited = condition%line == 0
      if (.not. is_inherited) is_inherited = context%deck%lines(condition%line)%first_token < context%open%first_token
   end function is_inherited

   !> OP=NEW: the step has nothing of a keyword from the step before. All cards of the keyword in the step say the same, or
   !> nothing behind a first one that does: preprocessors write `*DLOAD, OP=NEW` alone, then `*DLOAD` with the lines.
   logical function removes_all(context, keyword)
      type(build_context_t), intent(in) :: context     !< cards of its open step are read
      character(len=*), intent(in) :: keyword          !< e.g. 'DLOAD'
      character(len=:), allocatable :: word
      type(token_t) :: place
      integer(ip) :: i
      logical :: is_first, found, is_new

      removes_all = .false.
      is_first = .true.
      do i = context%open%first_card, context%open%last_card
         associate (card => context%deck%cards(i))
            if (card%step /= context%open%number .or. keyword_name(card) /= keyword .or. .not. card%ok) cycle
            is_new = option_word(context%deck, card, 'OP') == 'NEW'
            if (is_first) removes_all = is_new
            if (.not. is_first .and. .not. has_option(context%deck, card, 'OP')) is_new = removes_all
            is_first = .false.
            if (is_new .eqv. removes_all) cycle
            call option_text(context%deck, card, 'OP', word, found, place)
            call report_error(context%deck, place, 'E-CONFLICT', '*'//keyword//' has '//trim(merge('OP=NEW', 'OP=MOD', is_new))// &
                              ' here, but '//trim(merge('OP=MOD', 'OP=NEW', is_new))//' before in this step', &
                              expected='the same OP= for all *'//keyword//' of a step; MOD when left out')
         end associate
      end do
   end function removes_all

   !> From the end of a step to the beginning of the next: values stay what they are, and amplitudes over all time go on. What was
   !> removed in the step before is gone.
   pure subroutine propagate(context, conditions, keeps_zeros)
      type(build_context_t), intent(in) :: context     !< amplitudes and steps of its model are read
      type(condition_list_t), intent(inout) :: conditions !< of the step before; of this one on return
      logical, intent(in) :: keeps_zeros               !< displacements of 0 are supports, loads of 0 are nothing
      type(condition_t) :: condition
      integer(ip) :: i, n
      logical :: goes_on

      n = 0
      associate (amplitudes => context%model%amplitudes, steps => context%model%steps, k => context%open%number)
         do i = 1, conditions%n
            condition = conditions%list(i)
            condition%from = scaled(condition%kind, condition%value, &
                                    factor_at(amplitudes, condition%amplitude, steps(k - 1)%increments%period, &
                                              time_before(steps, k)))
            goes_on = condition%amplitude > 0
            if (goes_on) goes_on = amplitudes(condition%amplitude)%is_total_time
            if (.not. goes_on) then
               condition%amplitude = 0
               condition%value = condition%from
            end if
            if (is_nothing(condition) .and. .not. keeps_zeros) cycle
            n = n + 1
            conditions%list(n) = condition
         end do
      end associate
      conditions%n = n
   end subroutine propagate

   pure logical function is_nothing(condition)
      type(condition_t), intent(in) :: condition

      is_nothing = .not. any(abs(condition%value(:merge(1, 3, condition%kind == LOAD_HYDROSTATIC))) > 0.0_wp)
   end function is_nothing

   !> A load goes to 0.
   pure subroutine set_to_zero(load)
      type(condition_t), intent(inout) :: load   !< its value and amplitude; from stays

      load%value = scaled(load%kind, load%value, 0.0_wp)
      load%amplitude = 0
   end subroutine set_to_zero

   !> Lists what a step inherits by the slots in which it acts: one for each dof, or one for each element.
   pure subroutine list_inherited(n_slots, slots, inherited)
      integer(ip), intent(in) :: n_slots               !< dofs, or elements
      integer(ip), intent(in) :: slots(:)              !< of each condition
      type(inherited_t), intent(out) :: inherited      !< lists by slots, each ascending
      integer(ip) :: i

      inherited%n = size(slots, kind=ip)
      allocate (inherited%head(n_slots), source=0_ip)
      allocate (inherited%next(inherited%n))
      do i = inherited%n, 1, -1
         inherited%next(i) = inherited%head(slots(i))
         inherited%head(slots(i)) = i
      end do
   end subroutine list_inherited

   !> Puts a load in the place of one that the step inherits, of the same face and label; others there go to 0. Where there is none,
   !> or a line of this step has taken its place, the load is added.
   pure subroutine apply_condition(load, slot, inherited, loads, replaced)
      type(condition_t), intent(in) :: load            !< of the line that is read
      integer(ip), intent(in) :: slot                  !< in which it acts, as in list_inherited
      type(inherited_t), intent(inout) :: inherited    !< what is replaced is taken out
      type(condition_list_t), intent(inout) :: loads   !< of the step; those inherited come first
      type(replaced_t), intent(inout) :: replaced      !< the line of each load that ends, and that of this one
      real(wp) :: from(3)
      integer(ip) :: i, place, before

      place = 0
      before = 0                                       ! the last that stays in the list; 0: none so far
      i = 0
      if (inherited%n > 0) i = inherited%head(slot)
      do while (i > 0)
         associate (old => loads%list(i))
            if (old%face == load%face .and. old%label == load%label) then
               if (old%kind > 0 .and. .not. is_nothing(old)) call note_replaced(old%line, load%line, replaced) ! else OP=NEW
               call set_to_zero(old)
               if (load%amplitude > 0) old%from = old%value
               if (place == 0) place = i
               if (before > 0) inherited%next(before) = inherited%next(i)
               if (before == 0) inherited%head(slot) = inherited%next(i)
            else
               before = i
            end if
         end associate
         i = inherited%next(i)
      end do
      if (place > 0) then                              ! a CENTRIF is two loads: the other one is added
         if (loads%list(place)%kind /= load%kind) place = 0
      end if
      if (place == 0) then
         call add_condition(loads, load)
      else
         from = loads%list(place)%from                 ! what the old one had come to is where the new one begins
         loads%list(place) = load
         loads%list(place)%from = from
      end if
   end subroutine apply_condition

   !> Each line that ends is reported once for each line that takes its place.
   pure subroutine note_replaced(old, new, replaced)
      integer(ip), intent(in) :: old, new              !< lines of the deck
      type(replaced_t), intent(inout) :: replaced
      logical :: known

      if (new /= replaced%by) replaced%before = id_map_t()
      replaced%by = new
      call add_id(replaced%before, old, 1_ip, known)
      if (known) return
      if (.not. allocated(replaced%lines)) allocate (replaced%lines(2, 16))
      if (replaced%n == size(replaced%lines, 2)) call resize(replaced%lines, replaced%n, 2*replaced%n)
      replaced%n = replaced%n + 1
      replaced%lines(:, replaced%n) = [old, new]
   end subroutine note_replaced

   !> Tells each line of the open step that takes the place of a load of an earlier one though it acts along another direction, or
   !> about another axis, unless another line of the step gives that again: other programs keep both.
   subroutine warn_of_replaced(context)
      type(build_context_t), intent(in) :: context     !< open%replaced is read
      character(len=:), allocatable :: label
      integer(ip) :: i, old, new

      do i = 1, context%open%replaced%n
         old = context%open%replaced%lines(1, i)
         new = context%open%replaced%lines(2, i)
         label = label_of(context, new)
         if (all(label(:1) /= ['G', 'T', 'C'])) cycle  ! GRAV, TRVEC, CENTRIF
         if (is_given_again(context, old)) cycle
         associate (deck => context%deck)
            call report_warning(deck, line_item(deck, deck%lines(new), LABEL_ITEM), 'W-REPLACED', label//' takes the place of '// &
                                'that in '//place_text(deck, deck%tokens(deck%lines(old)%first_token), &
                                                       deck%tokens(deck%lines(new)%first_token))//', which acts '// &
                                trim(merge('about another axis     ', 'along another direction', label == 'CENTRIF')), &
                                expected='both lines in this step, if both are to act; OP=NEW, if not')
         end associate
      end do
   end subroutine warn_of_replaced

   !> Whether a line of the open step has label, direction and axis of a line of an earlier one.
   logical function is_given_again(context, old) result(is_given)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: old                   !< line of the deck
      integer(ip) :: i, k

      is_given = .true.
      do i = context%open%first_card, context%open%last_card
         associate (card => context%deck%cards(i))
            if (.not. is_of_step(context, i) .or. all(keyword_name(card) /= ['DLOAD ', 'DSLOAD'])) cycle
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. context%deck%lines(k)%ok) cycle
               if (.not. same_name(label_of(context, k), label_of(context, old))) cycle
               if (acts_alike(context, k, old)) return
            end do
         end associate
      end do
      is_given = .false.
   end function is_given_again

   function label_of(context, line) result(label)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: line
      character(len=:), allocatable :: label

      label = upper_case(token_text(context%deck, line_item(context%deck, context%deck%lines(line), LABEL_ITEM)))
   end function label_of

   !> Lines of one label: the same direction, or the same point and axis.
   logical function acts_alike(context, a, b)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: a, b                  !< lines of the deck
      real(wp), parameter :: SAME = 1.0e-9_wp
      real(wp) :: x(FIRST:LAST, 2), size_of
      integer(ip) :: lines(2), i, k
      logical :: ok

      lines = [a, b]
      do k = 1, 2
         do i = FIRST, LAST
            call get_real(context%deck, line_item(context%deck, context%deck%lines(lines(k)), i), 'a real', x(i, k), ok, 0.0_wp)
         end do
         do i = FIRST, LAST, 3
            if (i == FIRST .and. label_of(context, a) == 'CENTRIF') cycle  ! a point
            size_of = norm2(x(i:i + 2, k))
            if (size_of > 0.0_wp) x(i:i + 2, k) = x(i:i + 2, k)/size_of
         end do
      end do
      acts_alike = .true.
      do i = FIRST, LAST, 3
         associate (part => x(i:i + 2, :))
            acts_alike = acts_alike .and. maxval(abs(part(:, 1) - part(:, 2))) <= SAME*maxval(abs(part))
         end associate
      end do
   end function acts_alike

   !> What is added from now on is of the line that begins with this token. Lines of a keyword that name the same are one source.
   subroutine open_source(context, keyword, token)
      type(build_context_t), intent(inout) :: context  !< open%source is set; a new source is kept
      character(len=*), intent(in) :: keyword          !< without blanks
      type(token_t), intent(in) :: token               !< its first item: set, surface or number; empty: all elements
      character(len=:), allocatable :: name
      type(token_t) :: inner
      real(wp) :: value
      logical :: known

      name = ALL_ELEMENTS
      if (.not. is_empty_token(token)) name = token_text(context%deck, token)
      if (index(name, '<') == 1) then                  ! of an expression the number that it is
         inner = token
         inner%first = token%first + 1
         inner%last = token%last - 1
         call evaluate_at(context%deck, inner, value, known, silent=.true.)
         if (known) known = abs(value) < real(huge(1_ip), wp)
         if (known) name = to_text(nint(value, ip))
      end if
      name = keyword//' '//name
      context%open%source = find_name(context%source_names, name)
      if (context%open%source > 0) return
      call add_name(context%source_names, name)
      context%open%source = context%source_names%n
   end subroutine open_source

   !> The model has them all.
   pure subroutine keep_sources(context)
      type(build_context_t), intent(inout) :: context !< its model gets sources
      type(string_t), allocatable :: names(:)
      integer :: i, blank

      names = names_of(context%source_names)
      allocate (context%model%sources(size(names)))
      do i = 1, size(names)
         blank = index(names(i)%s, ' ')
         context%model%sources(i)%keyword = names(i)%s(:blank - 1)
         context%model%sources(i)%name = names(i)%s(blank + 1:)
      end do
   end subroutine keep_sources

end module atrito_propagation
