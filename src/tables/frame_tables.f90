!> The tables with rows of one increment each, docs/user/tables.md: contact, nodes, reactions, stress, bodies, joints, sections,
!> path, by atrito_rigid_report rigid, and by atrito_row_tables ties, equations, springs.
module atrito_frame_tables
   use atrito_extreme_report, only: build_extremes
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: STRESS_NAMES
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_model, only: model_t, path_t, is_due
   use atrito_place_fields, only: along_direction, place_field, principal_stresses, place_values_t, PLACE_FIELDS
   use atrito_results, only: results_t, contact_result_t
   use atrito_resultant_report, only: has_resultants, build_resultants
   use atrito_rigid_report, only: build_rigid_table
   use atrito_row_tables, only: has_rows, build_ties, build_equations, build_springs
   use atrito_summary, only: scales_t, pair_count, pair_name
   use atrito_table, only: table_t, begin_step_table, add_reals, add_real_columns, add_field, add_integers, add_integer_field, &
                           add_words, clear_small, one_word
   implicit none (type, external)
   private
   public :: has_frame_rows, build_frame_table, stress_rows, path_values, PATH_COLUMNS

   !> The reals of contact.tab, as copy_fields has them. The column status stands among them.
   integer, parameter :: BEFORE_STATUS = 8
   character(len=17), parameter :: CONTACT_NAMES(*) = [character(len=17) :: 's', 'x', 'y', 'gap', 'pressure', 'weighted_pressure', &
                                                                                        'shear', 'slip', 'weight', 'slip_increment']
   character(len=5), parameter :: CONTACT_DIMENSIONS(*) = [character(len=5) :: 'L', 'L', 'L', 'L', 'F/L^2', 'F/L^2', 'F/L^2', 'L', &
                                                                                                                         'L^2', 'L']

   !> What path.tab has behind s, x, y and element. Those that are no PLACE_FIELDS go by the direction of the path.
   character(len=8), parameter :: PATH_COLUMNS(20) = [character(len=8) :: 'u1', 'u2', 's11', 's22', 's33', 's12', 'mises', 's1', &
                                                          's2', 'tresca', 'u_along', 'u_across', 's_along', 's_across', 's_shear', &
                                                                                               'u_r', 'u_t', 's_rr', 's_tt', 's_rt']
   integer, parameter :: FIRST_ALONG = 11, LAST_ALONG = 15

contains

   !> Whether a frame has rows in a table: its step asks for them and they are due, or it is the last, whatever that is.
   pure logical function has_frame_rows(model, frame, name, is_last) result(has)
      type(model_t), intent(in) :: model   !< what its steps ask for is read
      type(results_t), intent(in) :: frame !< of one increment
      character(len=*), intent(in) :: name !< of the table
      logical, intent(in) :: is_last       !< the last frame of the history
      character(len=*), parameter :: NAMES(12) = [character(len=12) :: 'contact', 'nodes', 'reactions', 'stress', 'nodal_stress', &
                                                          'bodies', 'joints', 'sections', 'path', 'rigid', 'extremes', 'resultants']
      integer, parameter :: OWN = 9         !< the first so many are printed as often as their steps say
      integer(ip) :: frequencies(OWN)
      logical :: is_there(size(NAMES))
      integer :: i

      ! Whether the frame can have rows in the table, and its step asks for them.
      i = findloc(NAMES == name, .true., dim=1)
      associate (requests => model%steps(frame%step)%requests)
         is_there = [pair_count(frame) > 0, requests%nodes .and. allocated(frame%u), &
                     requests%reactions .and. allocated(frame%reaction), requests%stress .and. allocated(frame%stress), &
                     requests%nodal_stress .and. allocated(frame%nodal_stress), requests%bodies .and. allocated(frame%bodies), &
                     requests%joints .and. allocated(frame%joints), allocated(requests%cuts) .and. allocated(frame%cuts), &
                     allocated(requests%paths) .and. allocated(frame%nodal_stress), &
                     allocated(frame%rigid), allocated(frame%extremes), has_resultants(model)]
      end associate
      if (i > 0) has = is_there(i)
      if (i == 0) has = has_rows(model, frame, name)
      if (name == 'extremes' .or. name == 'resultants') return      ! they have rows of every frame
      if (is_last .or. .not. has) return
      associate (every => model%steps(frame%step)%requests%every)
         ! what ties, equations and springs transmit and rigid surfaces do is printed as often as the contact
         frequencies = [every%contact, every%nodes, every%reactions, every%stress, every%nodal_stress, every%bodies, every%joints, &
                        every%sections, every%paths]
      end associate
      has = is_due(frequencies(merge(i, 1, i >= 1 .and. i <= OWN)), frame%increment, frame%ends_step)
   end function has_frame_rows

   !> The rows of a frame in a table; the table may point at the fields of model and frame.
   subroutine build_frame_table(model, frame, scales, own, name, table)
      type(model_t), intent(in), target :: model    !< stays while the table is in use
      type(results_t), intent(in), target :: frame  !< of one increment; stays while the table is in use
      type(scales_t), intent(in) :: scales          !< of the history
      type(scales_t), intent(in) :: own(:)          !< of each pair
      character(len=*), intent(in) :: name          !< of the table
      type(table_t), intent(out) :: table           !< rows of the frame; the last column is their increment
      integer(ip), allocatable :: node(:)
      integer(ip) :: n

      select case (name)
      case ('contact')
         call build_contact(frame, own, table)
      case ('nodes', 'nodal_stress')
         call build_nodes(model, frame, scales, name, table)
      case ('reactions')
         node = places(model%steps(frame%step)%requests%node_rf, model%mesh%n_nodes)
         node = pack(node, any(frame%prescribed(:, node), dim=1))
         n = size(node, kind=ip)
         call begin_step_table(table, 'reactions', 'a row a node with a prescribed displacement', n, frame%step)
         call add_integers(table, 'node', model%mesh%node_id(node))
         call add_reals(table, 'r1', 'F', frame%reaction(1, node), scales%force)
         call add_reals(table, 'r2', 'F', frame%reaction(2, node), scales%force)
      case ('stress')
         call build_stress(model, frame, scales, table)
      case ('bodies')
         call build_bodies(frame, scales, table)
      case ('extremes')
         call build_extremes(frame, scales, table)
      case ('resultants')
         call build_resultants(model, frame, scales, table)
      case ('rigid')
         call build_rigid_table(frame, scales, table)
      case ('joints')
         call build_joints(frame, scales, own, table)
      case ('sections')
         call build_sections(frame, scales, table)
      case ('path')
         call build_path_table(model, frame, scales, table)
      case ('ties')
         call build_ties(model, frame, scales, table)
      case ('equations')
         call build_equations(model, frame, scales, table)
      case ('springs')
         call build_springs(model, frame, scales, table)
      end select
      call add_integers(table, 'increment', [frame%increment])
   end subroutine build_frame_table

   !> A row a quadrature point, by pair, then along s.
   subroutine build_contact(results, own, table)
      type(results_t), intent(in) :: results
      type(scales_t), intent(in) :: own(:)          !< of each pair
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
         call copy_fields(results%contact(i), own(i), field(first:last, :))
      end do
      call begin_step_table(table, 'contact', 'a row a quadrature point of the slave surface', n, results%step)
      do i = 1, pair_count(results)
         if (len(pair_name(results, i)) > 0) call append_string(table%remarks, 'pair '//to_text(i)//': '//pair_name(results, i))
      end do
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
      if (allocated(contact%slip_increment)) then
         call copy(contact%slip_increment, own%slip)
      else
         call copy(contact%slip, own%slip)          ! from rest
      end if

   contains

      subroutine copy(values, scale)
         real(wp), intent(in) :: values(:), scale

         k = k + 1
         field(:, k) = values(:contact%n)
         call clear_small(scale, field(:, k))
      end subroutine copy

   end subroutine copy_fields

   !> Displacements, or stresses, a row a node. The table points at the fields of model and results.
   subroutine build_nodes(model, results, scales, name, table)
      type(model_t), intent(in), target :: model
      type(results_t), intent(in), target :: results
      type(scales_t), intent(in) :: scales
      character(len=*), intent(in) :: name          !< nodes, nodal_stress
      type(table_t), intent(out) :: table
      character(len=:), allocatable :: title
      integer :: i

      title = 'a row a node'
      if (name == 'nodal_stress') title = title//' of an element: recovered stresses, the mean of all elements round it'
      call begin_step_table(table, name, title, model%mesh%n_nodes, results%step)
      associate (requests => model%steps(results%step)%requests)
         if (name == 'nodes' .and. .not. takes_all(requests%node_u)) table%places = places(requests%node_u, model%mesh%n_nodes)
         if (name /= 'nodes' .and. .not. takes_all(requests%node_s)) table%places = places(requests%node_s, model%mesh%n_nodes)
      end associate
      if (allocated(table%places)) table%n_rows = size(table%places, kind=ip)
      call add_integer_field(table, 'node', model%mesh%node_id)
      call add_field(table, 'x', 'L', model%mesh%x(1, :), scales%length)
      call add_field(table, 'y', 'L', model%mesh%x(2, :), scales%length)
      if (name == 'nodes') then
         call add_field(table, 'u1', 'L', results%u(1, :), scales%displacement)
         call add_field(table, 'u2', 'L', results%u(2, :), scales%displacement)
         return
      end if
      do i = 1, size(STRESS_NAMES)
         call add_field(table, trim(STRESS_NAMES(i)), 'F/L^2', results%nodal_stress(i, :), scales%nodal_stress)
      end do
      call add_principal(model, results%nodal_stress, scales%nodal_stress, table)
   end subroutine build_nodes

   !> Whether all nodes or elements are asked for; so it is where nothing is said.
   pure logical function takes_all(mask)
      logical, allocatable, intent(in) :: mask(:)

      takes_all = .true.
      if (allocated(mask)) takes_all = all(mask)
   end function takes_all

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
      type(results_t), intent(in) :: results      !< with stresses at points
      logical, allocatable, intent(in) :: mask(:) !< (n_elements) those asked for; not allocated: all
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

      call begin_step_table(table, 'stress', 'a row a quadrature point of an element', size(results%stress_element, kind=ip), &
                            results%step)
      if (.not. takes_all(model%steps(results%step)%requests%element_s)) then
         table%places = stress_rows(results, model%steps(results%step)%requests%element_s)
         table%n_rows = size(table%places, kind=ip)
      end if
      call add_integer_field(table, 'element', results%stress_element, model%mesh%element_id)
      call add_integer_field(table, 'point', results%stress_point)
      call add_field(table, 'x', 'L', results%stress_x(1, :), scales%length)
      call add_field(table, 'y', 'L', results%stress_x(2, :), scales%length)
      do i = 1, size(STRESS_NAMES)
         call add_field(table, trim(STRESS_NAMES(i)), 'F/L^2', results%stress(i, :), scales%stress)
      end do
      call add_principal(model, results%stress, scales%stress, table)
   end subroutine build_stress

   !> The principal stresses of the rows of a table, where a step asks for them.
   subroutine add_principal(model, stress, scale, table)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: stress(:, :)          !< (components, places) as STRESS_NAMES [F/L^2]
      real(wp), intent(in) :: scale
      type(table_t), intent(inout) :: table
      real(wp) :: principal(2, table%n_rows)
      integer(ip) :: i, place

      if (.not. any(model%steps%requests%principal)) return
      do i = 1, table%n_rows
         place = i
         if (allocated(table%places)) place = table%places(i)
         principal(:, i) = principal_stresses(stress(:4, place))
      end do
      call add_reals(table, 's1', 'F/L^2', principal(1, :), scale)
      call add_reals(table, 's2', 'F/L^2', principal(2, :), scale)
   end subroutine add_principal

   !> A row a body.
   subroutine build_bodies(results, scales, table)
      type(results_t), intent(in) :: results        !< with bodies
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      type(string_t) :: names(size(results%bodies))
      real(wp) :: field(size(results%bodies), 12)
      real(wp) :: force                              ! largest component of the resultants
      integer(ip) :: i, n
      integer :: k

      n = size(results%bodies, kind=ip)
      force = 0.0_wp
      do i = 1, n
         associate (body => results%bodies(i))
            force = max(force, maxval(abs([body%loads(:2), body%supports(:2), body%contact(:2)])))
         end associate
      end do
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
      call begin_step_table(table, 'bodies', 'a row a body: its best rigid motion, resultants and moments about its centre', n, &
                            results%step)
      call add_integers(table, 'body', [(i, i=1, n)])
      call add_words(table, 'name', '-', names, on_the_left=.true.)
      call add_real_columns(table, [character(len=15) :: 'u1', 'u2', 'rotation', 'loads_fx', 'loads_fy', 'loads_moment', &
                                    'supports_fx', 'supports_fy', 'supports_moment', 'contact_fx', 'contact_fy', &
                                    'contact_moment'], &
                            [character(len=3) :: 'L', 'L', '-', 'F', 'F', 'F*L', 'F', 'F', 'F*L', 'F', 'F', 'F*L'], field)
   end subroutine build_bodies

   !> A row a joint.
   subroutine build_joints(results, scales, own, table)
      type(results_t), intent(in) :: results        !< with joints
      type(scales_t), intent(in) :: scales
      type(scales_t), intent(in) :: own(:)          !< of each pair
      type(table_t), intent(out) :: table
      real(wp) :: field(size(results%joints), 7)
      integer(ip) :: i, n

      n = size(results%joints, kind=ip)
      do i = 1, n
         associate (joint => results%joints(i))
            field(i, :) = [joint%n, joint%t, joint%m, joint%place, joint%opening, joint%sliding]
            call clear_small(joint%force, field(i, 1:2))
            call clear_small(joint%force*joint%length, field(i, 3:3))
            call clear_small(scales%length, field(i, 4:5))
            call clear_small(own(joint%pair)%displacement, field(i, 6:6))
            call clear_small(own(joint%pair)%slip, field(i, 7:7))
         end associate
      end do
      call begin_step_table(table, 'joints', 'a row for each two bodies that a pair brings together; body 0 is a rigid surface', &
                            n, results%step)
      call add_integers(table, 'pair', results%joints%pair)
      call add_integers(table, 'body_1', results%joints%bodies(1))
      call add_integers(table, 'body_2', results%joints%bodies(2))
      call add_real_columns(table, [character(len=7) :: 'n', 't', 'm', 'x', 'y', 'opening', 'sliding'], &
                            ['F  ', 'F  ', 'F*L', 'L  ', 'L  ', 'L  ', 'L  '], field)
   end subroutine build_joints

   !> A row a cut.
   subroutine build_sections(results, scales, table)
      type(results_t), intent(in) :: results        !< with cuts
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      type(string_t) :: names(size(results%cuts))
      real(wp) :: field(size(results%cuts), 6)
      integer(ip) :: i, n

      n = size(results%cuts, kind=ip)
      do i = 1, n
         associate (cut => results%cuts(i))
            names(i)%s = one_word(cut%name)
            field(i, :) = [cut%middle, cut%length, cut%n, cut%v, cut%m]
            call clear_small(scales%length, field(i, 1:3))
            call clear_small(cut%terms(1), field(i, 4:5))
            call clear_small(cut%terms(2), field(i, 6:6))
         end associate
      end do
      call begin_step_table(table, 'sections', 'a row a cut: forces upon what is behind it, moment about its middle', n, &
                            results%step)
      call add_words(table, 'cut', '-', names, on_the_left=.true.)
      call add_real_columns(table, [character(len=6) :: 'x', 'y', 'length', 'n', 'v', 'm'], &
                            ['L  ', 'L  ', 'L  ', 'F  ', 'F  ', 'F*L'], field)
   end subroutine build_sections

   !> A row a point and body that holds it, path by path.
   subroutine build_path_table(model, results, scales, table)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results           !< with stresses at the nodes
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      type(string_t), allocatable :: names(:)
      real(wp), allocatable :: field(:, :), x(:, :), s(:)
      integer(ip), allocatable :: element(:)
      logical :: is_motion
      integer(ip) :: i, first, n
      integer :: k

      associate (asked => model%steps(results%step)%requests%paths)
         n = 0
         do i = 1, size(asked, kind=ip)
            n = n + size(model%paths(asked(i))%place, kind=ip)
         end do
         allocate (names(n), field(n, size(PATH_COLUMNS)), x(2, n), s(n), element(n))
         first = 0
         do i = 1, size(asked, kind=ip)
            associate (path => model%paths(asked(i)), rows => [(first + k, k=1, size(model%paths(asked(i))%place))])
               do k = 1, size(rows)
                  names(rows(k))%s = one_word(path%name)
               end do
               field(rows, :) = path_values(model, results, path)
               x(:, rows) = path%x
               s(rows) = path%s
               element(rows) = model%mesh%element_id(path%place%element)
               first = first + size(rows, kind=ip)
            end associate
         end do
      end associate
      call begin_step_table(table, 'path', 'a row a point of a path and body that holds it; stresses are those of the nodes, '// &
                            'interpolated', n, results%step)
      call add_words(table, 'path', '-', names, on_the_left=.true.)
      call add_reals(table, 's', 'L', s, 0.0_wp)
      call add_reals(table, 'x', 'L', x(1, :), scales%length)
      call add_reals(table, 'y', 'L', x(2, :), scales%length)
      call add_integers(table, 'element', element)
      do k = 1, size(PATH_COLUMNS)
         is_motion = PATH_COLUMNS(k) (1:1) == 'u'
         call add_reals(table, trim(PATH_COLUMNS(k)), trim(merge('L    ', 'F/L^2', is_motion)), field(:, k), &
                        merge(scales%displacement, scales%nodal_stress, is_motion))
      end do
   end subroutine build_path_table

   !> The values of a path: (rows, PATH_COLUMNS).
   pure function path_values(model, results, path) result(values)
      type(model_t), intent(in) :: model     !< elements and their nodes are read
      type(results_t), intent(in) :: results !< displacements, and stresses at the nodes
      type(path_t), intent(in) :: path       !< points, elements that hold them, directions
      real(wp) :: values(size(path%place), size(PATH_COLUMNS))
      type(place_values_t) :: at
      integer :: i, k

      do i = 1, size(path%place)
         associate (e => path%place(i)%element, n => model%mesh%shape(path%place(i)%element))
            associate (nodes => model%mesh%nodes(:n, e), share => path%place(i)%value(:n))
               at%u = matmul(results%u(:, nodes), share)
               at%s = matmul(results%nodal_stress(:4, nodes), share)
            end associate
         end associate
         at%arm = path%x(:, i) - path%centre
         values(i, FIRST_ALONG:LAST_ALONG) = along_direction(at, path%along(:, i))
         do k = 1, size(PATH_COLUMNS)
            if (k < FIRST_ALONG .or. k > LAST_ALONG) then
               values(i, k) = place_field(findloc(PLACE_FIELDS == PATH_COLUMNS(k), .true., dim=1), at)
            end if
         end do
      end do
   end function path_values

end module atrito_frame_tables
