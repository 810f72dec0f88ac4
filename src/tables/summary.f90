!> The quantities of a pair and of a step that summary.tab, the listing and the screen tell alike.
module atrito_summary
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, lp, wp
   use atrito_page, only: number, plural
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_model, only: model_t
   use atrito_results, only: results_t, history_t, scene_t, contact_result_t, quantity_bound_t, uniqueness_t, view_frame, &
                             POINT_OPEN, POINT_STICK, POINT_SLIP
   use atrito_threads, only: CHUNK_LENGTH
   implicit none (type, external)
   private
   public :: pair_summary_t, quantity_t, scales_t
   public :: summarise_pair, error_text, uniqueness_text, pair_quantities, step_quantities, quantity_names, states_text, closed_word
   public :: all_step_quantities, bound_text, large_text, measure_history
   public :: pair_count, pair_name, body_count

   !> What the contact tractions of one pair come to.
   type :: pair_summary_t
      real(wp) :: candidate_area = 0.0_wp                               !< [L^2]
      real(wp) :: effective_area = 0.0_wp                               !< [L^2] weights with p > 0
      real(wp) :: effective_area_percent = 0.0_wp                       !< effective over candidate area
      real(wp) :: normal_resultant = 0.0_wp                             !< [F]
      real(wp) :: shear_resultant = 0.0_wp                              !< [F] along T, on the slave
      real(wp) :: max_pressure = 0.0_wp                                 !< [F/L^2]
      real(wp) :: max_pressure_over_uniform = 0.0_wp                    !< times candidate area over normal resultant
      real(wp) :: max_pressure_over_triangular = 0.0_wp                 !< half of that: over the peak of a triangle
      real(wp) :: resultant_from_start = 0.0_wp                         !< [L] along s
      real(wp) :: resultant_from_end = 0.0_wp                           !< [L] along s
      real(wp) :: max_abs_shear = 0.0_wp                                !< [F/L^2]
      real(wp) :: max_abs_slip = 0.0_wp                                 !< [L], all points
      real(wp) :: max_penetration = 0.0_wp                              !< [L]
      integer(ip) :: open_points = 0, stick_points = 0, slip_points = 0 !< at the end of the increment
   end type pair_summary_t

   !> A row of summary.tab.
   type :: quantity_t
      character(len=32) :: name = ''               !< as in summary.tab
      character(len=8) :: dimension = '-'          !< in F and L; '-': none
      real(wp) :: value = 0.0_wp                   !< NaN where it is not defined
      real(wp) :: scale = 0.0_wp                   !< of its field; 0: nothing is rounding
      logical :: is_count = .false.                !< written as an integer
   end type quantity_t

   !> The largest value of each field.
   type :: scales_t
      real(wp) :: length = 0.0_wp                  !< coordinates [L]
      real(wp) :: displacement = 0.0_wp            !< [L]
      real(wp) :: slip = 0.0_wp                    !< of a pair [L]
      real(wp) :: pressure = 0.0_wp                !< contact pressure, all pairs [F/L^2]
      real(wp) :: stress = 0.0_wp                  !< stresses and pressure [F/L^2]
      real(wp) :: nodal_stress = 0.0_wp            !< stresses recovered at the nodes [F/L^2]
      real(wp) :: force = 0.0_wp                   !< reactions and applied resultants [F]
      real(wp) :: area = 0.0_wp                    !< largest candidate area of a pair [L^2]
   end type scales_t

contains

   !> Summarises the fields at the quadrature points of a pair. A ratio that is not defined, for want of points or of pressure,
   !> is NaN.
   pure function summarise_pair(contact) result(summary)
      type(contact_result_t), intent(in) :: contact !< of one pair
      type(pair_summary_t) :: summary
      real(wp) :: moment
      integer(ip) :: n

      n = contact%n
      if (n > 0) then
         associate (w => contact%weight(:n), p => contact%pressure(:n))
            summary%candidate_area = sum(w)
            summary%effective_area = sum(w, mask=p > 0.0_wp)
            summary%normal_resultant = sum(w*p)
            summary%shear_resultant = sum(w*contact%shear(:n))
            summary%max_pressure = max(maxval(p), 0.0_wp)
            moment = sum(w*p*contact%s(:n))
         end associate
         summary%max_abs_shear = maxval(abs(contact%shear(:n)))
         summary%max_abs_slip = maxval(abs(contact%slip(:n)))
         summary%max_penetration = max(0.0_wp, maxval(-contact%gap(:n)))
         summary%open_points = count(contact%status(:n) == POINT_OPEN, kind=ip)
         summary%stick_points = count(contact%status(:n) == POINT_STICK, kind=ip)
         summary%slip_points = count(contact%status(:n) == POINT_SLIP, kind=ip)
      else
         moment = 0.0_wp
      end if
      associate (s => summary)
         s%effective_area_percent = 100.0_wp*ratio(s%effective_area, s%candidate_area)
         s%max_pressure_over_uniform = ratio(s%max_pressure*s%candidate_area, s%normal_resultant)
         s%max_pressure_over_triangular = 0.5_wp*s%max_pressure_over_uniform
         s%resultant_from_start = ratio(moment, s%normal_resultant)
         s%resultant_from_end = contact%s_end - s%resultant_from_start
      end associate
   end function summarise_pair

   !> `2 open, 0 stick, 5 slip`; without friction a closed point is closed, whatever it does along the surface.
   pure function states_text(contact, summary) result(text)
      type(contact_result_t), intent(in) :: contact !< of one pair; whether it has friction is read
      type(pair_summary_t), intent(in) :: summary   !< of the same pair
      character(len=:), allocatable :: text

      text = to_text(summary%open_points)//' open, '
      if (contact%has_friction) text = text//to_text(summary%stick_points)//' stick, '
      text = text//to_text(summary%slip_points)//trim(merge(' slip  ', ' closed', contact%has_friction))
   end function states_text

   !> What points are that are neither open nor stick: `slip`, without any friction `closed`.
   pure function closed_word(scene) result(word)
      type(scene_t), intent(in) :: scene !< its tangential unknowns are counted
      character(len=:), allocatable :: word

      word = trim(merge('slip  ', 'closed', scene%n_tangential > 0))
   end function closed_word

   !> a/b, NaN where b is not positive.
   pure real(wp) function ratio(a, b)
      real(wp), intent(in) :: a, b

      ratio = ieee_value(1.0_wp, ieee_quiet_nan)
      if (b > 0.0_wp) ratio = a/b
   end function ratio

   !> The rows of a pair, in the order of summary.tab.
   pure function pair_quantities(summary, scales) result(list)
      type(pair_summary_t), intent(in) :: summary !< of one pair
      type(scales_t), intent(in) :: scales        !< of this pair
      type(quantity_t), allocatable :: list(:)
      real(wp) :: force

      force = scales%pressure*scales%area
      associate (s => summary)
         list = [quantity_t('candidate_area', 'L^2', s%candidate_area, 0.0_wp), &
                 quantity_t('effective_area', 'L^2', s%effective_area, 0.0_wp), &
                 quantity_t('effective_area_percent', '-', s%effective_area_percent, 0.0_wp), &
                 quantity_t('normal_resultant', 'F', s%normal_resultant, force), &
                 quantity_t('shear_resultant', 'F', s%shear_resultant, force), &
                 quantity_t('max_pressure', 'F/L^2', s%max_pressure, scales%pressure), &
                 quantity_t('max_pressure_over_uniform', '-', s%max_pressure_over_uniform, 0.0_wp), &
                 quantity_t('max_pressure_over_triangular', '-', s%max_pressure_over_triangular, 0.0_wp), &
                 quantity_t('resultant_from_start', 'L', s%resultant_from_start, scales%length), &
                 quantity_t('resultant_from_end', 'L', s%resultant_from_end, scales%length), &
                 quantity_t('max_abs_shear', 'F/L^2', s%max_abs_shear, scales%pressure), &
                 quantity_t('max_abs_slip', 'L', s%max_abs_slip, scales%slip), &
                 quantity_t('max_penetration', 'L', s%max_penetration, scales%displacement), &
                 counted('open_points', s%open_points), &
                 counted('stick_points', s%stick_points), &
                 counted('slip_points', s%slip_points)]
      end associate
   end function pair_quantities

   !> The rows of a step (pair 0), in the order of summary.tab.
   pure function step_quantities(results) result(list)
      type(results_t), intent(in) :: results !< of one increment
      type(quantity_t), allocatable :: list(:), large(:)
      integer :: i

      list = [counted('picard_iterations', int(results%outer_iterations, ip)), &
              counted('linear_solves', int(results%linear_solves, ip)), &
              quantity_t('equilibrium_residual', '-', results%equilibrium_residual, 0.0_wp), &
              quantity_t('strain_energy', 'F L', results%strain_energy, 0.0_wp), &
              quantity_t('external_work', 'F L', results%external_work, 0.0_wp), &
              quantity_t('error_estimate_percent', '-', results%error_estimate, 0.0_wp)]
      associate (bound => results%error_bound)      ! of its square the shares of the bodies and of both laws of contact
         if (bound%exists) list = [list, quantity_t('error_bound_percent', '-', bound%percent, 0.0_wp), &
                                   counted('error_certified', merge(1_ip, 0_ip, bound%is_certified)), &
                                   quantity_t('error_bound_bulk', '-', bound%bulk, 1.0_wp), &
                                   quantity_t('error_bound_normal', '-', bound%normal, 1.0_wp), &
                                   quantity_t('error_bound_tangential', '-', bound%tangential, 1.0_wp)]
      end associate
      associate (known => results%uniqueness)       ! with friction what is certified, and the index; of a search what it found
         list = [list, pack([quantity_t('unique_up_to_nu', '-', known%up_to_nu, 0.0_wp), counted('index', known%index), &
                             counted('solutions_found', known%solutions)], &
                            known%nu > 0.0_wp .and. [len_trim(known%why_not) == 0, known%index /= 0, known%solutions > 0])]
      end associate
      large = [quantity_t('large_strain', '-', results%large_strain%value, 0.0_wp), &
               quantity_t('large_rotation', '-', results%large_rotation%value, 0.0_wp), &
               quantity_t('large_slip', 'L', results%large_slip%value, 0.0_wp)]
      list = [list, pack(large, large%value > 0.0_wp)]   ! what passes the bounds of a linear theory (W-LARGE), and only that
      if (.not. allocated(results%observed)) return
      ! what --observe asks for: nothing is rounding, for of an expression no scale is known
      list = [list, [(quantity_t(results%observed(i)%name, '-', results%observed(i)%value, 0.0_wp), i=1, size(results%observed))]]
   end function step_quantities

   !> The bound of the error and the estimate, or the estimate alone: one line of some 65 columns.
   pure function error_text(results) result(text)
      type(results_t), intent(in) :: results !< of one increment
      character(len=:), allocatable :: text

      associate (bound => results%error_bound)
         if (bound%exists) then
            text = ' in the energy norm ('//trim(merge('certified    ', 'not certified', bound%is_certified))
            if (bound%is_of_polygon) text = text(20:)//', of the polygon'
            text = 'at most '//number(bound%percent, 3)//' %'//text//'), estimated '//number(results%error_estimate, 2)//' %'
         else
            text = number(results%error_estimate, 3)//' %; no bound: '//trim(bound%why_not)
            if (len_trim(bound%why_not) == 0) text = 'error of '//number(results%error_estimate, 3)//' % of the energy norm'
         end if
      end associate
   end function error_text

   !> `-0.01234 to -0.01231 (certified)`: between what a quantity is, and of which problem this is proved.
   pure function bound_text(bound) result(text)
      type(quantity_bound_t), intent(in) :: bound
      character(len=:), allocatable :: text
      integer, parameter :: DIGITS = 6

      if (.not. bound%exists) then
         text = 'has no bound: '//trim(bound%why_not)
         return
      end if
      text = number(bound%least, DIGITS)//' to '//number(bound%most, DIGITS)//' ('// &
             trim(merge('certified    ', 'not certified', bound%is_certified))
      if (bound%is_of_states) text = text//', contact states held'
      text = text//')'
   end function bound_text

   !> `strain 0.2, slip 1.5`: what passes its bound.
   pure function large_text(large) result(text)
      real(wp), intent(in) :: large(3)              !< strain, rotation [1] and slip [L]; 0: within their bounds
      character(len=:), allocatable :: text
      character(len=*), parameter :: NAMES(3) = [character(len=8) :: 'strain', 'rotation', 'slip']
      integer :: i

      text = ''
      do i = 1, size(large)
         if (large(i) > 0.0_wp) text = text//', '//trim(NAMES(i))//' '//to_text(large(i), 3)
      end do
      text = text(3:)
   end function large_text

   !> What is proved of the solution being the only one, in words that promise no more: one line of some 65 columns; '' without
   !> friction.
   pure function uniqueness_text(known) result(text)
      type(uniqueness_t), intent(in) :: known !< of one increment
      character(len=:), allocatable :: text
      character(len=:), allocatable :: up_to

      text = ''
      if (known%starts > 0) text = 'no search: without friction the energy has one minimum'
      if (.not. known%nu > 0.0_wp) return
      up_to = 'nu = '//number(known%up_to_nu, 3)
      if (known%solutions > 1) then
         text = 'not the only solution: '//to_text(known%solutions - 1)//merge(' other ', ' others', known%solutions == 2)
         text = trim(text)//' found from '//plural(known%starts, 'start', 'starts')
      else if (known%index < 0) then
         text = 'not the only solution: its index is -1'
      else if (known%up_to_nu >= known%nu) then
         text = 'exactly one solution for every load up to '//up_to//' (certified)'
      else
         text = 'not proved'
         if (known%up_to_nu > 0.0_wp) text = text//' beyond '//up_to
         if (known%solutions == 1) then
            text = text//'; '//plural(known%starts, 'start finds', 'starts find')//' no other solution'
         else if (len_trim(known%why_not) > 0) then
            text = text//': '//trim(known%why_not)
         else if (known%same_way_up_to_nu >= known%nu) then
            text = text//'; no other moves alike everywhere'
         end if
      end if
   end function uniqueness_text

   !> Every quantity that summary.tab can have.
   pure function quantity_names() result(names)
      type(string_t), allocatable :: names(:)
      type(quantity_t), allocatable :: list(:)
      integer :: i

      list = [pair_quantities(pair_summary_t(), scales_t()), all_step_quantities()]
      allocate (names(0))
      do i = 1, size(list)
         call append_string(names, trim(list(i)%name))
      end do
   end function quantity_names

   !> Every quantity that a step can have there, without values.
   pure function all_step_quantities() result(list)
      type(quantity_t), allocatable :: list(:)
      type(results_t) :: full

      full%uniqueness = uniqueness_t(nu=1.0_wp, index=1_ip, solutions=1_ip)
      full%error_bound%exists = .true.
      full%large_strain%value = 1.0_wp
      full%large_rotation%value = 1.0_wp
      full%large_slip%value = 1.0_wp
      list = step_quantities(full)
   end function all_step_quantities

   pure function counted(name, value)
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: value
      type(quantity_t) :: counted

      counted = quantity_t(name, value=real(value, wp), is_count=.true.)
   end function counted

   !> Finds the scales of all fields. What is not there counts as 0.
   function measure_fields(model, results) result(scales)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(scales_t) :: scales
      integer(ip) :: i

      scales%length = largest(size(model%mesh%x, kind=lp), model%mesh%x)
      if (allocated(results%u)) scales%displacement = largest(size(results%u, kind=lp), results%u)
      if (allocated(results%reaction)) scales%force = largest(size(results%reaction, kind=lp), results%reaction)
      scales%force = max(scales%force, maxval(abs(results%balance%applied(:2))))
      do i = 1, pair_count(results)
         associate (contact => results%contact(i))
            if (contact%n == 0) cycle
            scales%pressure = max(scales%pressure, maxval(abs(contact%pressure(:contact%n))))
            scales%area = max(scales%area, sum(contact%weight(:contact%n)))
         end associate
      end do
      scales%stress = scales%pressure
      if (allocated(results%stress)) scales%stress = max(scales%stress, largest(size(results%stress, kind=lp), results%stress))
      if (.not. allocated(results%extremes)) return
      associate (name => results%extremes%quantity)   ! no stress at a node is larger than the largest of these
         scales%nodal_stress = max(0.0_wp, maxval(abs(results%extremes%value), &
                                                  mask=name == 'mises' .or. name == 's1_max' .or. name == 's3_min'))
      end associate
   end function measure_fields

   !> The scales that one pair's fields have of their own: its pressure and area, and the displacements that meet there.
   pure function scales_of_pair(contact) result(own)
      type(contact_result_t), intent(in) :: contact
      type(scales_t) :: own

      if (contact%n == 0) return
      own%pressure = maxval(abs(contact%pressure(:contact%n)))
      own%area = sum(contact%weight(:contact%n))
      own%slip = maxval(abs(contact%slip(:contact%n)))
      own%displacement = own%slip
      if (allocated(contact%u)) own%displacement = max(own%displacement, maxval(abs(contact%u)))
   end function scales_of_pair

   !> The scales of a history: what is rounding beside the largest value of any of its frames is rounding in all of them.
   subroutine measure_history(model, history, scales, own)
      type(model_t), intent(in) :: model                 !< mesh and loads are read
      type(history_t), intent(in), target :: history     !< all frames are shown, one after the other
      type(scales_t), intent(out) :: scales              !< of all frames
      type(scales_t), allocatable, intent(out) :: own(:) !< of each pair's fields
      type(results_t), pointer :: frame
      logical, allocatable :: is_bare(:)             !< a pair that has no points in some frame
      integer(ip) :: i, pair

      do i = 1, size(history%frames, kind=ip)
         call view_frame(history, i, frame)
         scales = larger(scales, measure_fields(model, frame))
         if (i == 1) then
            allocate (own(pair_count(frame)))
            allocate (is_bare(size(own)), source=.false.)
         end if
         do pair = 1, size(own, kind=ip)
            own(pair) = larger(own(pair), scales_of_pair(frame%contact(pair)))
            is_bare(pair) = is_bare(pair) .or. frame%contact(pair)%n == 0
         end do
      end do
      do pair = 1, size(own, kind=ip)
         associate (its => own(pair))               ! the scales of all fields, but those that the pair has of its own
            its = merge(larger(its, scales), scales_t(scales%length, its%displacement, its%slip, its%pressure, scales%stress, &
                                                      scales%nodal_stress, scales%force, its%area), is_bare(pair))
         end associate
      end do
   end subroutine measure_history

   pure type(scales_t) function larger(a, b)
      type(scales_t), intent(in) :: a, b

      larger = scales_t(max(a%length, b%length), max(a%displacement, b%displacement), max(a%slip, b%slip), &
                        max(a%pressure, b%pressure), max(a%stress, b%stress), max(a%nodal_stress, b%nodal_stress), &
                        max(a%force, b%force), max(a%area, b%area))
   end function larger

   !> Contact pairs of a frame.
   pure integer(ip) function pair_count(results)
      type(results_t), intent(in) :: results !< of one increment

      pair_count = 0
      if (allocated(results%contact)) pair_count = size(results%contact, kind=ip)
   end function pair_count

   !> `SLAVE on MASTER`; nothing where the scene is not known.
   pure function pair_name(results, i) result(name)
      type(results_t), intent(in) :: results !< of one increment, with its scene
      integer(ip), intent(in) :: i           !< place of the pair, from 1
      character(len=:), allocatable :: name

      name = ''
      if (.not. allocated(results%scene%pairs)) return
      if (i <= size(results%scene%pairs)) name = results%scene%pairs(i)%slave//' on '//results%scene%pairs(i)%master
   end function pair_name

   !> Bodies of a scene.
   pure integer(ip) function body_count(scene)
      type(scene_t), intent(in) :: scene !< not described yet: 0

      body_count = 0
      if (allocated(scene%bodies)) body_count = size(scene%bodies, kind=ip)
   end function body_count

   !> Largest absolute value; 0 for an empty array.
   real(wp) function largest(n, values)
      integer(lp), intent(in) :: n
      real(wp), intent(in) :: values(n)            !< an array of any rank
      integer(lp) :: i

      largest = 0.0_wp
      !$omp parallel do default(none) shared(n, values) reduction(max:largest) if(n >= CHUNK_LENGTH)
      do i = 1, n
         largest = max(largest, abs(values(i)))
      end do
      !$omp end parallel do
   end function largest

end module atrito_summary
