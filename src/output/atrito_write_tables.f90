!> The tables of a run, docs/user/tables.md: what is in them and when each is written.
module atrito_write_tables
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: STRESS_NAMES
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_set_t
   use atrito_system, only: peak_memory
   use atrito_timers, only: phase_time_t, get_phases
   use atrito_model, only: model_t
   use atrito_results, only: results_t, contact_result_t, iteration_t, body_motion_t
   use atrito_number_text, only: trimmed_real
   use atrito_rigid_report, only: build_rigid_table
   use atrito_row_tables, only: has_rows, build_row_table
   use atrito_summary, only: pair_summary_t, quantity_t, scales_t, summarise_pair, pair_quantities, step_quantities, &
                             measure_fields, scales_of_pair, pair_count
   use atrito_table, only: table_t, origin_t, begin_table, add_reals, add_real_columns, add_field, add_integers, &
                           add_integer_field, add_words, write_table, clear_small, abs_is_below, one_word, ZERO_SHARE
   implicit none (type, external)
   private
   public :: write_tables, write_timing, list_table_files, origin_of, stress_rows, TABLE_NAMES

   !> Every table that atrito can write.
   character(len=10), parameter :: TABLE_NAMES(13) = [character(len=10) :: 'contact', 'summary', 'nodes', 'reactions', 'stress', &
                                                                      'bodies', 'rigid', 'joints', 'ties', 'equations', 'springs', &
                                                                                                             'iterations', 'timing']

   !> The reals of contact.tab, as copy_fields has them. The column status stands among them.
   integer, parameter :: BEFORE_STATUS = 8
   character(len=17), parameter :: CONTACT_NAMES(*) = [character(len=17) :: 's', 'x', 'y', 'gap', 'pressure', &
                                                                                     'weighted_pressure', 'shear', 'slip', 'weight']
   character(len=5), parameter :: CONTACT_DIMENSIONS(*) = [character(len=5) :: 'L', 'L', 'L', 'L', 'F/L^2', 'F/L^2', 'F/L^2', &
                                                                                                                         'L', 'L^2']

   !> The rows of results%stress.

contains

   !> File names of every table that atrito can write: what a new run replaces or removes.
   pure function list_table_files() result(names)
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(TABLE_NAMES)
         call append_string(names, trim(TABLE_NAMES(i))//'.tab')
      end do
   end function list_table_files

   !> The comment lines at the top of all tables of a run.
   pure function origin_of(model, results) result(origin)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(origin_t) :: origin

      origin%deck = model%deck_path(index(model%deck_path, '/', back=.true.) + 1:)
      origin%heading = model%heading
      origin%not_converged = .not. (results%converged .and. results%law_holds)
   end function origin_of

   !> Writes all tables of a run but timing.tab, which comes last: contact whenever there is a pair, summary and iterations always,
   !> the rest when the deck asks.
   !>
   !> status: STATUS_FILE when one could not be written; the rest is not tried then.
   subroutine write_tables(model, results, digits, set, status)
      type(model_t), intent(in), target :: model
      type(results_t), intent(in), target :: results
      integer, intent(in) :: digits                 !< significant digits, 6..17
      type(file_set_t), intent(inout) :: set
      type(status_t), intent(out) :: status
      type(scales_t) :: scales
      type(table_t) :: table
      type(origin_t) :: origin
      integer :: i

      origin = origin_of(model, results)
      scales = measure_fields(model, results)
      do i = 1, size(TABLE_NAMES)
         select case (TABLE_NAMES(i))
         case ('contact')
            if (pair_count(results) == 0) cycle
            call build_contact(results, scales, table)
         case ('summary')
            call build_summary(results, scales, digits, table)
         case ('nodes')
            if (.not. (model%steps(results%step)%requests%nodes .and. allocated(results%u))) cycle
            call build_nodes(model, results, scales, table)
         case ('reactions')
            if (.not. (model%steps(results%step)%requests%reactions .and. allocated(results%reaction))) cycle
            call build_reactions(model, results, scales, table)
         case ('stress')
            if (.not. (model%steps(results%step)%requests%stress .and. allocated(results%stress))) cycle
            call build_stress(model, results, scales, table)
         case ('bodies')
            if (.not. (model%steps(results%step)%requests%bodies .and. allocated(results%bodies))) cycle
            call build_bodies(results, scales, table)
         case ('rigid')
            if (.not. allocated(results%rigid)) cycle
            call build_rigid_table(results, scales, table)
         case ('joints')
            if (.not. (model%steps(results%step)%requests%joints .and. allocated(results%joints))) cycle
            call build_joints(results, scales, table)
         case ('ties', 'equations', 'springs')
            if (.not. has_rows(model, results, trim(TABLE_NAMES(i)))) cycle
            call build_row_table(model, results, scales, trim(TABLE_NAMES(i)), table)
         case ('iterations')
            call build_iterations(results, table)
         case default
            cycle
         end select
         call write_table(set, table, origin, digits, status)
         if (.not. is_ok(status)) return
      end do
   end subroutine write_tables

   !> A row a quadrature point, by pair, then along s.
   subroutine build_contact(results, scales, table)
      type(results_t), intent(in) :: results
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      integer(ip), allocatable :: pair(:), point(:), point_status(:)
      real(wp), allocatable :: field(:, :)
      integer(ip) :: first, last, n, i, j

      n = sum(results%contact%n)
      allocate (pair(n), point(n), point_status(n), field(n, size(CONTACT_NAMES)))
      last = 0
      do i = 1, pair_count(results)
         first = last + 1
         last = last + results%contact(i)%n
         pair(first:last) = i
         point(first:last) = [(j, j=1, results%contact(i)%n)]
         point_status(first:last) = results%contact(i)%status(:results%contact(i)%n)
         call copy_fields(results%contact(i), scales_of_pair(scales, results%contact(i)), field(first:last, :))
      end do
      call begin_table(table, 'contact', 'a row a quadrature point of the slave surface', n)
      call add_integers(table, 'step', spread(results%step, 1, n))
      call add_integers(table, 'pair', pair)
      call add_integers(table, 'point', point)
      call add_real_columns(table, CONTACT_NAMES(:BEFORE_STATUS), CONTACT_DIMENSIONS(:BEFORE_STATUS), field)
      call add_integers(table, 'status', point_status)
      call add_real_columns(table, CONTACT_NAMES(BEFORE_STATUS + 1:), CONTACT_DIMENSIONS(BEFORE_STATUS + 1:), &
                            field(:, BEFORE_STATUS + 1:))
   end subroutine build_contact

   !> What a pair has in the columns CONTACT_NAMES; what is rounding in it becomes 0.
   subroutine copy_fields(contact, own, field)
      type(contact_result_t), intent(in) :: contact
      type(scales_t), intent(in) :: own              !< scales of the pair
      real(wp), intent(out) :: field(:, :)
      integer :: k

      k = 0
      call copy(contact%s, own%length)
      call copy(contact%x(1, :), own%length)
      call copy(contact%x(2, :), own%length)
      call copy(contact%gap, own%displacement)
      call copy(contact%pressure, own%pressure)
      call copy(contact%weighted_pressure, own%pressure)
      call copy(contact%shear, own%pressure)
      call copy(contact%slip, own%slip)
      call copy(contact%weight, 0.0_wp)

   contains

      subroutine copy(values, scale)
         real(wp), intent(in) :: values(:), scale

         k = k + 1
         field(:, k) = values(:contact%n)
         call clear_small(scale, field(:, k))
      end subroutine copy

   end subroutine copy_fields

   !> A row a quantity: the pairs, then the step as pair 0.
   subroutine build_summary(results, scales, digits, table)
      type(results_t), intent(in) :: results
      type(scales_t), intent(in) :: scales
      integer, intent(in) :: digits
      type(table_t), intent(out) :: table
      type(quantity_t), allocatable :: list(:), of_step(:)
      integer(ip), allocatable :: pair(:)
      type(string_t), allocatable :: names(:), values(:)
      integer(ip) :: i, n, n_each

      n_each = size(pair_quantities(pair_summary_t(), scales), kind=ip)
      of_step = step_quantities(results)
      n = n_each*pair_count(results)
      allocate (list(n + size(of_step)), pair(n + size(of_step)))
      do i = 1, pair_count(results)
         list(n_each*(i - 1) + 1:n_each*i) = pair_quantities(summarise_pair(results%contact(i)), &
                                                             scales_of_pair(scales, results%contact(i)))
         pair(n_each*(i - 1) + 1:n_each*i) = i
      end do
      list(n + 1:) = of_step
      pair(n + 1:) = 0
      n = size(list, kind=ip)
      allocate (names(n), values(n))
      do i = 1, n
         names(i)%s = trim(list(i)%name)
         values(i)%s = quantity_text(list(i), digits)
      end do
      call begin_table(table, 'summary', 'a row a quantity, by pair; pair 0 is the step', n)
      call add_integers(table, 'step', spread(results%step, 1, n))
      call add_integers(table, 'pair', pair)
      call add_words(table, 'quantity', '-', names, on_the_left=.true.)
      call add_words(table, 'value', 'mixed', values, on_the_left=.false.)
      call describe_dimensions(table, list)
   end subroutine build_summary

   pure function quantity_text(quantity, digits) result(text)
      type(quantity_t), intent(in) :: quantity
      integer, intent(in) :: digits
      character(len=:), allocatable :: text

      if (quantity%is_count) then
         text = to_text(nint(quantity%value, ip))
      else if (abs_is_below(quantity%value, ZERO_SHARE*quantity%scale)) then
         text = '0'
      else
         text = trimmed_real(quantity%value, digits)
      end if
   end function quantity_text

   !> The dimensions of the column `value`, one comment line a dimension.
   pure subroutine describe_dimensions(table, list)
      type(table_t), intent(inout) :: table
      type(quantity_t), intent(in) :: list(:)
      character(len=8), parameter :: DIMENSIONS(5) = [character(len=8) :: 'L', 'L^2', 'F', 'F/L^2', 'F L']
      character(len=:), allocatable :: names
      integer :: i, j

      do i = 1, size(DIMENSIONS)
         names = ''
         do j = 1, size(list)
            if (list(j)%dimension /= DIMENSIONS(i)) cycle
            if (index(names//' ', ' '//trim(list(j)%name)//' ') == 0) names = names//' '//trim(list(j)%name)
         end do
         if (len(names) > 0) call append_string(table%remarks, '['//trim(DIMENSIONS(i))//']:'//names)
      end do
   end subroutine describe_dimensions

   !> The table points at the fields of model and results.
   subroutine build_nodes(model, results, scales, table)
      type(model_t), intent(in), target :: model
      type(results_t), intent(in), target :: results
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      integer(ip), allocatable :: node(:)
      integer(ip) :: n

      node = places(model%steps(results%step)%requests%node_u, model%mesh%n_nodes)
      n = size(node, kind=ip)
      call begin_table(table, 'nodes', 'a row a node', n)
      call add_integers(table, 'step', spread(results%step, 1, n))
      call add_integers(table, 'node', model%mesh%node_id(node))
      call move_alloc(node, table%places)
      call add_field(table, 'x', 'L', model%mesh%x(1, :), scales%length)
      call add_field(table, 'y', 'L', model%mesh%x(2, :), scales%length)
      call add_field(table, 'u1', 'L', results%u(1, :), scales%displacement)
      call add_field(table, 'u2', 'L', results%u(2, :), scales%displacement)
   end subroutine build_nodes

   subroutine build_reactions(model, results, scales, table)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      integer(ip), allocatable :: node(:)
      integer(ip) :: n

      node = places(model%steps(results%step)%requests%node_rf, model%mesh%n_nodes)
      node = pack(node, any(results%prescribed(:, node), dim=1))
      n = size(node, kind=ip)
      call begin_table(table, 'reactions', 'a row a node with a prescribed displacement', n)
      call add_integers(table, 'step', spread(results%step, 1, n))
      call add_integers(table, 'node', model%mesh%node_id(node))
      call add_reals(table, 'r1', 'F', results%reaction(1, node), scales%force)
      call add_reals(table, 'r2', 'F', results%reaction(2, node), scales%force)
   end subroutine build_reactions

   !> Places of the nodes asked for; all where nothing is said.
   pure function places(mask, n) result(list)
      logical, allocatable, intent(in) :: mask(:)
      integer(ip), intent(in) :: n
      integer(ip), allocatable :: list(:)
      integer(ip) :: i

      list = [(i, i=1, n)]
      if (allocated(mask)) list = pack(list, mask)
   end function places

   !> Places in results%stress of the points of these elements; all where nothing is said.
   pure function stress_rows(results, mask) result(list)
      type(results_t), intent(in) :: results
      logical, allocatable, intent(in) :: mask(:)
      integer(ip), allocatable :: list(:)
      integer(ip) :: i

      list = [(i, i=1, size(results%stress_element, kind=ip))]
      if (allocated(mask)) list = pack(list, mask(results%stress_element))
   end function stress_rows

   !> The table points at the fields of results and at the ids of the model's elements.
   subroutine build_stress(model, results, scales, table)
      type(model_t), intent(in), target :: model
      type(results_t), intent(in), target :: results
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      integer :: i

      call begin_table(table, 'stress', 'a row a quadrature point of an element', size(results%stress_element, kind=ip))
      if (allocated(model%steps(results%step)%requests%element_s)) then
         table%places = stress_rows(results, model%steps(results%step)%requests%element_s)
         table%n_rows = size(table%places, kind=ip)
      end if
      call add_integers(table, 'step', [results%step])
      call add_integer_field(table, 'element', results%stress_element, model%mesh%element_id)
      call add_integer_field(table, 'point', results%stress_point)
      call add_field(table, 'x', 'L', results%stress_x(1, :), scales%length)
      call add_field(table, 'y', 'L', results%stress_x(2, :), scales%length)
      do i = 1, size(STRESS_NAMES)
         call add_field(table, trim(STRESS_NAMES(i)), 'F/L^2', results%stress(i, :), scales%stress)
      end do
   end subroutine build_stress

   !> A row an inner solve.
   subroutine build_iterations(results, table)
      type(results_t), intent(in) :: results
      type(table_t), intent(out) :: table
      type(iteration_t), allocatable :: rows(:)

      allocate (rows(0))
      if (allocated(results%iterations)) rows = results%iterations
      call begin_table(table, 'iterations', 'a row an inner solve', size(rows, kind=ip))
      call add_integers(table, 'step', spread(results%step, 1, size(rows)))
      call add_integers(table, 'outer', (rows%outer))
      call add_integers(table, 'inner', (rows%inner))
      call add_reals(table, 'change_displacement', '-', (rows%change_displacement), 0.0_wp)
      call add_reals(table, 'change_pressure', '-', (rows%change_pressure), 0.0_wp)
      call add_reals(table, 'change_friction', '-', (rows%change_friction), 0.0_wp)
      call add_integers(table, 'open', (rows%open))
      call add_integers(table, 'stick', (rows%stick))
      call add_integers(table, 'slip', (rows%slip))
      call add_reals(table, 'residual', '-', (rows%residual), 0.0_wp)
   end subroutine build_iterations

   !> Writes timing.tab: the phases that have ended, their sum, and the peak memory as a comment.
   subroutine write_timing(model, results, digits, set, status)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      integer, intent(in) :: digits
      type(file_set_t), intent(inout) :: set
      type(status_t), intent(out) :: status
      type(phase_time_t), allocatable :: phases(:)
      type(string_t), allocatable :: names(:)
      type(table_t) :: table
      integer :: i

      phases = get_phases()
      allocate (names(0))
      do i = 1, size(phases)
         call append_string(names, one_word(trim(phases(i)%name)))
      end do
      call append_string(names, 'total')
      call begin_table(table, 'timing', 'a row a phase, seconds', size(names, kind=ip))
      call append_string(table%remarks, 'peak memory [bytes]: '//to_text(peak_memory()))
      call add_words(table, 'phase', '-', names, on_the_left=.true.)
      call add_reals(table, 'wall', 's', [phases%wall, sum(phases%wall)], 0.0_wp)
      call add_reals(table, 'cpu', 's', [phases%cpu, sum(phases%cpu)], 0.0_wp)
      call write_table(set, table, origin_of(model, results), digits, status)
   end subroutine write_timing

   !> A row a body.
   subroutine build_bodies(results, scales, table)
      type(results_t), intent(in) :: results        !< with bodies
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      character(len=8), parameter :: GROUPS(3) = ['loads   ', 'supports', 'contact ']
      type(string_t) :: names(size(results%bodies))
      real(wp) :: field(size(results%bodies), 12), force
      integer(ip) :: i, n
      integer :: k

      n = size(results%bodies, kind=ip)
      force = largest_force(results%bodies)
      do i = 1, n
         associate (body => results%bodies(i))
            names(i)%s = one_word(body%name)
            field(i, :) = [body%u, body%rotation, body%loads, body%supports, body%contact]
            call clear_small(scales%displacement, field(i, 1:2))
            call clear_small(scales%displacement/body%size, field(i, 3:3))
            do k = 4, 10, 3
               call clear_small(max(force, body%terms(1)), field(i, k:k + 1))
               call clear_small(max(force*body%size, body%terms(2)), field(i, k + 2:k + 2))
            end do
         end associate
      end do
      call begin_table(table, 'bodies', 'a row a body: its best rigid motion, resultants and moments about its centre', n)
      call add_integers(table, 'step', [results%step])
      call add_integers(table, 'body', [(i, i=1, n)])
      call add_words(table, 'name', '-', names, on_the_left=.true.)
      call add_real_columns(table, ['u1      ', 'u2      ', 'rotation'], ['L', 'L', '-'], field(:, :3))
      do k = 1, size(GROUPS)
         call add_real_columns(table, trim(GROUPS(k))//['_fx    ', '_fy    ', '_moment'], ['F  ', 'F  ', 'F*L'], &
                               field(:, 3*k + 1:3*k + 3))
      end do
   end subroutine build_bodies

   !> Largest component of the resultants.
   pure real(wp) function largest_force(bodies) result(largest)
      type(body_motion_t), intent(in) :: bodies(:)
      integer(ip) :: i

      largest = 0.0_wp
      do i = 1, size(bodies, kind=ip)
         largest = max(largest, maxval(abs([bodies(i)%loads(:2), bodies(i)%supports(:2), bodies(i)%contact(:2)])))
      end do
   end function largest_force

   !> A row a joint.
   subroutine build_joints(results, scales, table)
      type(results_t), intent(in) :: results        !< with joints
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      type(scales_t) :: own
      real(wp) :: field(size(results%joints), 7)
      integer(ip) :: i, n

      n = size(results%joints, kind=ip)
      do i = 1, n
         associate (joint => results%joints(i))
            own = scales_of_pair(scales, results%contact(joint%pair))
            field(i, :) = [joint%n, joint%t, joint%m, joint%place, joint%opening, joint%sliding]
            call clear_small(joint%force, field(i, 1:2))
            call clear_small(joint%force*joint%length, field(i, 3:3))
            call clear_small(scales%length, field(i, 4:5))
            call clear_small(own%displacement, field(i, 6:6))
            call clear_small(own%slip, field(i, 7:7))
         end associate
      end do
      call begin_table(table, 'joints', 'a row for each two bodies that a pair brings together; body 0 is a rigid surface', n)
      call add_integers(table, 'step', [results%step])
      call add_integers(table, 'pair', results%joints%pair)
      call add_integers(table, 'body_1', results%joints%bodies(1))
      call add_integers(table, 'body_2', results%joints%bodies(2))
      call add_real_columns(table, [character(len=7) :: 'n', 't', 'm', 'x', 'y', 'opening', 'sliding'], &
                            ['F  ', 'F  ', 'F*L', 'L  ', 'L  ', 'L  ', 'L  '], field)
   end subroutine build_joints

end module atrito_write_tables
