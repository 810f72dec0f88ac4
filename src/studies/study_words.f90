!> What a study says of its errors: how soon they are below 1 %, whether they still fall, and what stops them.
module atrito_study_words
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: wp, is_nan
   use atrito_strings, only: append_string, to_text
   use atrito_study_errors, only: study_t, study_probe_t, find_errors, is_last, last_uniform, total_seconds, PROCESSOR
   implicit none (type, external)
   private
   public :: judge_study

   real(wp), parameter :: GOOD = 0.01_wp             !< the error that is asked for
   real(wp), parameter :: STALLED = 0.3_wp           !< an order below this is none
   real(wp), parameter :: SHARE = 0.1_wp             !< of the error that a regularisation must have to be felt
   real(wp), parameter :: NOT_SHRINKING = 0.95_wp    !< a difference over the one before it, where there is no limit
   real(wp), parameter :: GROWTH = 0.01_wp           !< of the largest pressure, relative; less is none
   real(wp), parameter :: CLOCK_NOISE = 0.2_wp       !< between times of runs, relative
   real(wp), parameter :: NEARLY = 0.85_wp           !< of the order of a smooth solution

contains

   !> Fills references, errors, orders and words from the values of the rows.
   subroutine judge_study(study)
      type(study_t), intent(inout) :: study          !< with values; errors, orders and words are set
      integer :: i

      allocate (study%words(0))
      if (.not. allocated(study%probes)) allocate (study%probes(0))
      call find_errors(study)
      do i = 1, size(study%quantities)
         call describe_quantity(study, i)
      end do
      do i = 1, size(study%probes)
         call describe_probe(study, study%probes(i))
      end do
      call describe_estimate(study)
      call describe_adapted(study)
      call describe_pressure(study)
   end subroutine judge_study

   subroutine describe_quantity(study, i)
      type(study_t), intent(inout) :: study
      integer, intent(in) :: i
      character(len=:), allocatable :: text
      integer :: k

      associate (quantity => study%quantities(i))
         text = quantity%name//': '
         if (is_nan(quantity%reference)) then
            call append_string(study%words, text//quantity%source)
         else if (quantity%is_held) then
            call append_string(study%words, text//to_text(quantity%reference, 8)//' in every run, but for rounding: loads or '// &
                               'supports prescribe it, or the elements hold it exactly; it tells nothing of the mesh')
         else
            text = text//'reference '//to_text(quantity%reference, 8)//', '//quantity%source
            if (quantity%doubt > study%rounding) then
               text = text//'; other levels and elements have limits up to '//percent(quantity%doubt)//' away'
            else if (.not. (quantity%is_given .or. quantity%doubt > 0.0_wp)) then
               text = text//'; there is no other limit to hold it against'
            end if
            call append_string(study%words, text)
            if (abs(quantity%reference) > 0.0_wp) call append_string(study%words, soonest(study, i))
            do k = 2, size(study%rows)
               if (is_last(study%rows, k)) call describe_last_error(study, i, k)
            end do
         end if
      end associate
   end subroutine describe_quantity

   !> 0.0123 -> `1.2 %`; what is no number -> `none`.
   pure function percent(x) result(text)
      real(wp), intent(in) :: x
      character(len=:), allocatable :: text

      text = 'none'
      if (.not. is_nan(x)) text = to_text(100*x, 2)//' %'
   end function percent

   !> Which element gives a good answer soonest: `1 % of strain_energy soonest: cpe9, level 0 (983 dofs, 0.0035 s); then cpe4, ...`.
   function soonest(study, i) result(text)
      type(study_t), intent(in) :: study
      integer, intent(in) :: i
      character(len=:), allocatable :: text
      logical, allocatable :: is_listed(:)
      character(len=:), allocatable :: failed
      real(wp) :: seconds(size(study%rows))
      integer :: k, n, next, before, j

      allocate (is_listed(size(study%rows)), source=.true.)
      before = 0
      seconds = [(total_seconds(study%rows(k), PROCESSOR), k=1, size(study%rows))]
      failed = ''
      do k = 1, size(study%rows)
         if (.not. is_last(study%rows, k)) cycle
         ! The coarsest row of an element from which on all its errors are small; 0: there is none.
         n = 0
         do j = k, 1, -1
            if (study%rows(j)%element /= study%rows(k)%element) exit
            if (is_nan(study%quantities(i)%error(j))) exit
            if (study%quantities(i)%error(j) > GOOD) exit
            n = j
         end do
         if (n > 0) then
            is_listed(n) = .false.
         else
            if (len(failed) > 0) failed = failed//', '
            failed = failed//study%rows(k)%element//' ('//percent(study%quantities(i)%error(k))//')'
         end if
      end do
      text = to_text(100*GOOD, 2)//' % of '//study%quantities(i)%name
      if (all(is_listed)) then
         text = text//': in no run; at the last level '//failed
         return
      end if
      text = text//' soonest: '
      do while (.not. all(is_listed))
         next = minloc(seconds, dim=1, mask=.not. is_listed)
         is_listed(next) = .true.
         if (before > 0) then                       ! times that differ by less than the noise of the clock count as equal
            if (seconds(next) < (1.0_wp + CLOCK_NOISE)*seconds(before)) then
               text = text//', as soon as '
            else
               text = text//'; then '
            end if
         end if
         before = next
         associate (row => study%rows(next))
            text = text//row%element//', level '//to_text(row%level)//' ('//to_text(row%n_dofs)//' dofs, ' &
                   //to_text(total_seconds(row, PROCESSOR), 2)//' s)'
         end associate
      end do
      if (len(failed) > 0) text = text//'; not reached by '//failed
   end function soonest

   !> Whether the error still falls at the finest level of an element, and if not the reason.
   subroutine describe_last_error(study, i, k)
      type(study_t), intent(inout) :: study
      integer, intent(in) :: i, k
      character(len=:), allocatable :: text
      real(wp) :: now, before

      associate (quantity => study%quantities(i), rows => study%rows)
         if (is_nan(quantity%error(k))) return
         text = quantity%name//', '//rows(k)%element//': '
         if (quantity%error(k) <= study%rounding) then
            text = text//'no error but rounding'
         else if (is_nan(quantity%order(k))) then
            return
         else
            now = (rows(k)%values(i) - quantity%reference)/quantity%scale
            before = (rows(k - 1)%values(i) - quantity%reference)/quantity%scale
            if (now*before < 0.0_wp) then
               text = text//'the values pass the reference between the last two levels, from '//percent(before)//' to ' &
                      //percent(now)//'; no order can be told'
            else if (quantity%order(k) >= STALLED) then
               text = text//'the error still falls, order '//to_text(quantity%order(k), 2)//' at the last level'
            else if (abs(now) <= (1.0_wp + STALLED)*abs(before)) then
               text = text//'the error stops falling at '//percent(abs(now))//': '//reason(study, i, k)
            else
               text = text//'the error grows, to '//percent(abs(now))//' at the last level: '//reason(study, i, k)
            end if
         end if
         call append_string(study%words, text)
      end associate
   end subroutine describe_last_error

   !> The regularisation that moves a quantity most, if it moves it enough; its whole effect is about twice that of its half.
   function reason(study, i, k) result(text)
      type(study_t), intent(in) :: study
      integer, intent(in) :: i, k
      character(len=:), allocatable :: text
      real(wp) :: most, moved
      integer :: j, best

      best = 0
      most = 0.5_wp*SHARE*study%quantities(i)%error(k)
      do j = 1, size(study%probes)
         moved = effect(study, study%probes(j), i)
         if (is_nan(moved)) cycle
         if (moved < most) cycle
         most = moved
         best = j
      end do
      if (best == 0) then
         text = 'neither penalty nor eps explains that; the reference, what the deck leaves out, or the shape of curved sides does'
         return
      end if
      associate (probe => study%probes(best))
         text = probe%what//' moves it by '//percent(most)//'. '
         if (probe%is_penalty) then
            text = text//'The penalty lets the bodies overlap, by up to '//to_text(study%rows(k)%penetration, 2) &
                   //' [L]; no mesh takes that away, a smaller delta does'
         else
            text = text//'Friction is regularised and needs slip to develop; no mesh takes that away, a stiffer law does'
         end if
      end associate
   end function reason

   !> What a probe does to a quantity, relative; nan where it is not known.
   pure real(wp) function effect(study, probe, i)
      type(study_t), intent(in) :: study
      type(study_probe_t), intent(in) :: probe
      integer, intent(in) :: i

      effect = ieee_value(1.0_wp, ieee_quiet_nan)
      if (is_nan(study%quantities(i)%reference) .or. .not. allocated(probe%values)) return
      effect = abs(probe%values(i) - study%rows(probe%row)%values(i))/study%quantities(i)%scale
   end function effect

   !> What half of a regularisation does: a limit that is extrapolated has it in itself, so its error never shows it.
   subroutine describe_probe(study, probe)
      type(study_t), intent(inout) :: study
      type(study_probe_t), intent(in) :: probe
      character(len=:), allocatable :: text
      real(wp) :: moved
      logical :: is_felt
      integer :: i

      text = ''
      is_felt = .false.
      do i = 1, size(study%quantities)
         moved = effect(study, probe, i)
         if (is_nan(moved) .or. study%quantities(i)%is_held) cycle
         if (len(text) > 0) text = text//', '
         text = text//study%quantities(i)%name//' by '//percent(moved)
         is_felt = is_felt .or. 2*moved >= SHARE*minval(study%quantities(i)%error, mask=.not. is_nan(study%quantities(i)%error))
      end do
      if (len(text) == 0) return
      text = probe%what//' moves '//text//' ('//study%rows(probe%row)%element//', level '// &
             to_text(study%rows(probe%row)%level)//'): '
      if (is_felt) then
         text = text//'beside the least error of these meshes that counts, and no mesh takes it away'
      else
         text = text//'small beside the errors of these meshes'
      end if
      call append_string(study%words, text)
   end subroutine describe_probe

   !> The order of the estimate is that of the elements where the solution is smooth, and that of the worst singularity elsewhere.
   subroutine describe_estimate(study)
      type(study_t), intent(inout) :: study
      character(len=:), allocatable :: found, smooth
      real(wp) :: order
      logical :: is_smooth
      integer :: k

      found = ''
      smooth = ''
      is_smooth = .true.
      associate (rows => study%rows)
         do k = 2, size(rows)
            if (.not. is_last(rows, k) .or. rows(k)%element /= rows(k - 1)%element .or. rows(k)%degree == 0) cycle
            if (rows(k)%is_adapted) cycle
            if (is_nan(rows(k)%estimate) .or. is_nan(rows(k - 1)%estimate)) cycle
            if (min(rows(k)%estimate, rows(k - 1)%estimate) <= 0.0_wp) cycle
            order = log(rows(k - 1)%estimate/rows(k)%estimate)/log(2.0_wp)
            is_smooth = is_smooth .and. order >= NEARLY*rows(k)%degree
            found = found//', '//to_text(order, 2)//' ('//rows(k)%element//')'
            smooth = smooth//', '//to_text(rows(k)%degree)//' ('//rows(k)%element//')'
         end do
      end associate
      if (len(found) == 0) return
      found = 'the error estimate falls with the order '//found(3:)//' at the last level'
      if (is_smooth) then
         found = found//', as for a smooth solution'
      else
         found = found//'; a smooth solution has '//smooth(3:)//'. Where the meshes are fine enough to tell, '// &
                 'singular points do that (corners, ends of contact, ends of a support): a mesh that is finer there '// &
                 'gains more than one that is finer everywhere'
      end if
      call append_string(study%words, found)
   end subroutine describe_estimate

   !> What --adapt needs for the smallest error that it was asked for, and the meshes that are refined everywhere for the same.
   subroutine describe_adapted(study)
      type(study_t), intent(inout) :: study
      character(len=:), allocatable :: text
      integer :: k, last

      last = size(study%rows)
      if (last == 0) return
      if (.not. study%rows(last)%is_adapted .or. is_nan(study%rows(last)%estimate)) return
      associate (rows => study%rows)
         text = 'an estimated error of '//to_text(rows(last)%estimate, 3)//' % takes --adapt '//effort(last)
         do k = 1, last_uniform(rows)
            if (rows(k)%estimate <= rows(last)%estimate) exit
         end do
         if (k > last_uniform(rows)) then
            text = text//'; the meshes that are refined everywhere do not reach it'
         else
            text = text//'; refined everywhere, '//rows(k)%element//', level '//to_text(rows(k)%level)//', of '// &
                   to_text(rows(k)%estimate, 3)//' %, takes '//effort(k)
         end if
      end associate
      call append_string(study%words, text)

   contains

      function effort(k) result(text)
         integer, intent(in) :: k
         character(len=:), allocatable :: text

         text = to_text(study%rows(k)%n_dofs)//' dofs and '//to_text(total_seconds(study%rows(k), PROCESSOR), 2)//' s'
      end function effort

   end subroutine describe_adapted

   !> A largest pressure that grows from level to level, by steps that do not shrink, has no limit.
   subroutine describe_pressure(study)
      type(study_t), intent(inout) :: study
      character(len=:), allocatable :: place
      integer :: k

      associate (rows => study%rows)
         do k = 3, size(rows)
            if (.not. is_last(rows, k) .or. rows(k)%element /= rows(k - 2)%element .or. rows(k)%is_adapted) cycle
            associate (p => rows(k - 2:k)%pressure)
               if (.not. (p(2) - p(1) > GROWTH*p(2) .and. p(3) - p(2) > GROWTH*p(3) .and. &
                          p(3) - p(2) >= NOT_SHRINKING*(p(2) - p(1)))) cycle
            end associate
            place = 'at ('//to_text(rows(k)%peak(1), 6)//', '//to_text(rows(k)%peak(2), 6)//')'
            if (rows(k)%peak_is_end) place = place//', an end of the contact surface'
            call append_string(study%words, rows(k)%element//': the largest pressure, '//place//', grows with every level (' &
                               //to_text(rows(k - 2)%pressure, 3)//', '//to_text(rows(k - 1)%pressure, 3)//', ' &
                               //to_text(rows(k)%pressure, 3)//'), at last with h^-' &
                               //to_text(log(rows(k)%pressure/rows(k - 1)%pressure)/log(2.0_wp), 2) &
                               //': it looks singular, without a limit; compare resultants')
         end do
      end associate
   end subroutine describe_pressure

end module atrito_study_words
