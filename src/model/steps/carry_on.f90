!> What a step has from the one before: its supports and loads with the values that they had at the end, and how lines of the step
!> take their place.
module atrito_carry_on
   use atrito_amplitudes, only: factor_at, time_before
   use atrito_build_context, only: build_context_t, carried_t, replaced_t
   use atrito_deck, only: token_t, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_growth, only: resize
   use atrito_id_map, only: id_map_t, add_id
   use atrito_items, only: has_option, option_text, option_word
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: replace_nodal_value, replace_element_load
   use atrito_model, only: model_t, nodal_values_t, element_load_t, LOAD_HYDROSTATIC
   implicit none (type, external)
   private
   public :: is_of_step, removes_all, carry_values, carry_loads, list_carried, take_force_place, take_load_place, remove_load

contains

   !> A card of the step that is being built; what stands outside of all steps, which is reported, is read with the first.
   pure logical function is_of_step(context, i)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: i                     !< card of the deck

      is_of_step = max(context%deck%cards(i)%step, 1_ip) == context%open%number
   end function is_of_step

   !> OP=NEW: the step has nothing of a keyword from the step before. All cards of the keyword in the step say the same, or
   !> nothing behind a first one that does: preprocessors write `*DLOAD, OP=NEW` alone, then `*DLOAD` with the lines.
   logical function removes_all(context, keyword)
      type(build_context_t), intent(in) :: context
      character(len=*), intent(in) :: keyword
      character(len=:), allocatable :: word
      type(token_t) :: place
      integer(ip) :: i
      logical :: is_first, found, is_new

      removes_all = .false.
      is_first = .true.
      do i = context%open%first_card, context%open%last_card
         if (context%deck%cards(i)%step /= context%open%number) cycle
         if (keyword_name(context%deck%cards(i)) /= keyword .or. .not. context%deck%cards(i)%ok) cycle
         is_new = option_word(context%deck, context%deck%cards(i), 'OP') == 'NEW'
         if (is_first) removes_all = is_new
         if (.not. is_first .and. .not. has_option(context%deck, context%deck%cards(i), 'OP')) is_new = removes_all
         is_first = .false.
         if (is_new .eqv. removes_all) cycle
         call option_text(context%deck, context%deck%cards(i), 'OP', word, found, place)
         call report_error(context%deck, place, 'E-CONFLICT', '*'//keyword//' has '//trim(merge('OP=NEW', 'OP=MOD', is_new))// &
                           ' here, but '//trim(merge('OP=MOD', 'OP=NEW', is_new))//' before in this step', &
                           expected='the same OP= for all *'//keyword//' of a step; MOD when left out', keyword=keyword)
      end do
   end function removes_all

   !> What an amplitude multiplies by at the end of the step before.
   pure real(wp) function last_factor(context, amplitude) result(factor)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: amplitude
      integer(ip) :: k

      k = context%open%number
      factor = factor_at(context%model%amplitudes, amplitude, context%model%steps(k - 1)%increments%period, &
                         time_before(context%model%steps, k))
   end function last_factor

   !> From the end of a step to the beginning of the next: values stay what they are, and amplitudes over all time go on. What was
   !> removed in the step before is gone.
   subroutine carry_values(context, list, keeps_zeros)
      type(build_context_t), intent(in) :: context
      type(nodal_values_t), intent(inout) :: list
      logical, intent(in) :: keeps_zeros               !< displacements of 0 are supports, forces of 0 are nothing
      integer(ip) :: amplitude, i, n
      real(wp) :: value

      if (.not. allocated(list%value)) return
      if (.not. allocated(list%from)) allocate (list%from(size(list%value)))
      if (.not. allocated(list%amplitude)) allocate (list%amplitude(size(list%value)), source=0_ip)
      n = 0
      do i = 1, list%n
         amplitude = list%amplitude(i)
         value = list%value(i)*last_factor(context, amplitude)
         if (.not. goes_on(context%model, amplitude)) then
            amplitude = 0
            list%value(i) = value
         end if
         if (.not. (keeps_zeros .or. abs(list%value(i)) > 0.0_wp)) cycle
         n = n + 1
         list%node(n) = list%node(i)
         list%dof(n) = list%dof(i)
         list%value(n) = list%value(i)
         list%from(n) = value
         list%amplitude(n) = amplitude
         if (allocated(list%source)) list%source(n) = list%source(i)
      end do
      list%n = n
   end subroutine carry_values

   pure logical function goes_on(model, amplitude)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: amplitude

      goes_on = amplitude > 0
      if (goes_on) goes_on = model%amplitudes(amplitude)%is_total_time
   end function goes_on

   !> As carry_values, of loads on elements.
   subroutine carry_loads(context, list)
      type(build_context_t), intent(in) :: context
      type(element_load_t), intent(inout) :: list
      integer(ip) :: amplitude, i, n
      real(wp) :: value(3)

      if (.not. allocated(list%from)) allocate (list%from(3, size(list%element)))
      if (.not. allocated(list%amplitude)) allocate (list%amplitude(size(list%element)), source=0_ip)
      n = 0
      do i = 1, list%n
         amplitude = list%amplitude(i)
         value = times(list%value(:, i), list%kind(i), last_factor(context, amplitude))
         if (.not. goes_on(context%model, amplitude)) then
            amplitude = 0
            list%value(:, i) = value
         end if
         if (is_nothing(list%value(:, i), list%kind(i))) cycle
         n = n + 1
         list%element(n) = list%element(i)
         list%kind(n) = list%kind(i)
         list%face(n) = list%face(i)
         list%line(n) = list%line(i)
         list%value(:, n) = list%value(:, i)
         list%from(:, n) = value
         list%amplitude(n) = amplitude
         if (allocated(list%source)) list%source(n) = list%source(i)
      end do
      list%n = n
   end subroutine carry_loads

   !> The levels of a hydrostatic pressure stay where they are.
   pure function times(value, kind, factor) result(product)
      real(wp), intent(in) :: value(3), factor
      integer(ip), intent(in) :: kind
      real(wp) :: product(3)

      product = value*factor
      if (kind == LOAD_HYDROSTATIC) product(2:) = value(2:)
   end function times

   pure logical function is_nothing(value, kind)
      real(wp), intent(in) :: value(3)
      integer(ip), intent(in) :: kind

      is_nothing = .not. any(abs(value(:merge(1, 3, kind == LOAD_HYDROSTATIC))) > 0.0_wp)
   end function is_nothing

   !> Lists what is carried on by the places on which it acts.
   pure subroutine list_carried(n_places, places, carried)
      integer(ip), intent(in) :: n_places, places(:)
      type(carried_t), intent(out) :: carried
      integer(ip) :: i

      carried%n = size(places, kind=ip)
      allocate (carried%head(n_places), source=0_ip)
      allocate (carried%next(carried%n), source=0_ip)
      allocate (carried%is_given(carried%n), source=.false.)
      do i = carried%n, 1, -1
         carried%next(i) = carried%head(places(i))
         carried%head(places(i)) = i
      end do
   end subroutine list_carried

   !> The force of the step before whose place a line takes; others on the same dof go to 0. 0: there is none, or a line of this
   !> step has taken it.
   pure subroutine take_force_place(dof_place, amplitude, carried, list, place)
      integer(ip), intent(in) :: dof_place             !< in the lists of carried
      integer(ip), intent(in) :: amplitude             !< of the line
      type(carried_t), intent(inout) :: carried
      type(nodal_values_t), intent(inout) :: list
      integer(ip), intent(out) :: place
      integer(ip) :: i, before

      place = 0
      if (carried%n == 0) return
      before = 0
      i = carried%head(dof_place)
      do while (i > 0)
         if (.not. carried%is_given(i)) then
            carried%is_given(i) = .true.
            call replace_nodal_value(list, i, 0.0_wp, 0_ip)
            if (amplitude > 0) list%from(i) = 0.0_wp
            if (place == 0) place = i
         end if
         call step_on(dof_place, carried, before, i)
      end do
   end subroutine take_force_place

   !> A load goes to 0.
   pure subroutine remove_load(list, i)
      type(element_load_t), intent(inout) :: list
      integer(ip), intent(in) :: i

      call replace_element_load(list, i, times(list%value(:, i), list%kind(i), 0.0_wp), 0_ip)
   end subroutine remove_load

   !> As take_force_place, of a load of this face and label on an element. replaced: the line of each load that ends, and this one.
   pure subroutine take_load_place(element, face, label, amplitude, line, carried, list, replaced, place)
      integer(ip), intent(in) :: element, face, label, amplitude, line
      type(carried_t), intent(inout) :: carried
      type(element_load_t), intent(inout) :: list
      type(replaced_t), intent(inout) :: replaced
      integer(ip), intent(out) :: place
      integer(ip) :: i, before

      place = 0
      if (carried%n == 0) return
      before = 0
      i = carried%head(element)
      do while (i > 0)
         if (list%face(i) == face .and. carried%label(i) == label .and. .not. carried%is_given(i)) then
            carried%is_given(i) = .true.
            if (.not. is_nothing(list%value(:, i), list%kind(i))) call note_replaced(list%line(i), line, replaced) ! else OP=NEW
            call remove_load(list, i)
            if (amplitude > 0) list%from(:, i) = list%value(:, i)
            if (place == 0) place = i
         end if
         call step_on(element, carried, before, i)
      end do
   end subroutine take_load_place

   !> Goes on to the next of what is carried on at a place; who has been given leaves the list, or every line would pass by it.
   pure subroutine step_on(place, carried, before, i)
      integer(ip), intent(in) :: place
      type(carried_t), intent(inout) :: carried
      integer(ip), intent(inout) :: before             !< the last that stays in the list; 0: none so far
      integer(ip), intent(inout) :: i

      if (.not. carried%is_given(i)) then
         before = i
      else if (before > 0) then
         carried%next(before) = carried%next(i)
      else
         carried%head(place) = carried%next(i)
      end if
      i = carried%next(i)
   end subroutine step_on

   !> Each line that ends is told once of each line that takes its place.
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

end module atrito_carry_on
