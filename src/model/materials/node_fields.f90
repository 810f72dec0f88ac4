!> What a deck gives node by node: temperatures (*INITIAL CONDITIONS, TYPE=TEMPERATURE and *TEMPERATURE), by which the nodes grow
!> warmer, and the thickness (*NODAL THICKNESS), which the elements of sections with NODAL THICKNESS interpolate.
!>
!> Nodes that no line names keep their initial temperature, which is 0 where none is given. The deck's elements interpolate what
!> their nodes have; --refine and --elements change nothing of these fields.
module atrito_node_fields
   use atrito_build_context, only: build_context_t, place_text, ids_text, has_errors
   use atrito_build_steps, only: open_step
   use atrito_deck, only: data_line_t, token_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error, report_note, report_warning
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF
   use atrito_items, only: get_real
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_plane_state, only: TAPERED_STATE, IS_TAPERED
   use atrito_propagation, only: removes_all
   use atrito_coordinates, only: get_positive
   use atrito_references, only: find_nodes, in_no_element
   use atrito_refinement, only: map_element, refinement_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_temperatures, read_node_thickness, refine_node_fields, taper_elements, check_temperatures

   !> Two values of one node are the same when they differ by less than this part of them: expressions are rounded.
   real(wp), parameter :: SAME_VALUE = 1.0e-12_wp

   !> The temperatures of one keyword.
   type :: temperatures_t
      character(len=18) :: keyword = ''                !< whose lines are read
      integer(ip), allocatable :: token(:)             !< (n_nodes) first of the line that gives it; 0: none
      real(wp), allocatable :: value(:)                !< (n_nodes) temperatures
      integer(ip) :: last = 0                          !< token of the last line; 0: there is none
   end type temperatures_t

   character(len=*), parameter :: THICKNESS = 'NODAL THICKNESS'

contains

   !> The rise of the temperature of each node of the deck's mesh; heating stays unallocated where nothing grows warmer.
   subroutine read_temperatures(context)
      type(build_context_t), intent(inout) :: context  !< steps of its model get heating
      type(temperatures_t) :: before, now
      integer(ip) :: k, last

      allocate (before%token(context%model%mesh%n_nodes), source=0_ip)
      allocate (before%value(context%model%mesh%n_nodes), source=0.0_wp)
      now = before
      before%keyword = 'INITIAL CONDITIONS'
      now%keyword = 'TEMPERATURE'
      call read_cards(context, 0_ip, before)
      ! the temperatures of a step: those of the step before but for what its lines change
      associate (steps => context%model%steps)
         do k = 1, size(steps, kind=ip)
            call open_step(context, k)
            if (removes_all(context, 'TEMPERATURE')) now%token = 0
            last = now%last
            call read_cards(context, k, now)
            if (now%last /= last) call warn_of_middles(context, now)
            if (now%last == 0) cycle
            where (now%token == 0) now%value = before%value
            if (any(abs(now%value - before%value) > 0.0_wp)) steps(k)%heating = now%value - before%value
            if (k == 1) cycle
            if (.not. allocated(steps(k - 1)%heating)) cycle
            if (any(abs(steps(k - 1)%heating) > 0.0_wp)) steps(k)%heating_from = steps(k - 1)%heating
            if (.not. allocated(steps(k)%heating) .and. allocated(steps(k)%heating_from)) then
               steps(k)%heating = now%value - before%value
            end if
         end do
      end associate
      if (before%last == 0 .and. now%last == 0) return
      if (now%last == 0) then
         call report_note(context%deck, context%deck%tokens(before%last), 'N-TEMPERATURE', 'no *TEMPERATURE of the step makes' &
                          //' anything warmer or colder than that', keyword='INITIAL CONDITIONS')
         return
      end if
      call warn_of_middles(context, before)
   end subroutine read_temperatures

   !> All cards of a step; 0: of the model.
   subroutine read_cards(context, step, temperatures)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: step
      type(temperatures_t), intent(inout) :: temperatures
      integer(ip) :: i, k

      do i = merge(1_ip, context%open%first_card, step == 0), merge(context%deck%n_cards, context%open%last_card, step == 0)
         associate (card => context%deck%cards(i))
            if (keyword_name(card) /= temperatures%keyword .or. card%step /= step) cycle
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (context%deck%lines(k)%ok) call read_line(context%deck%lines(k), context, temperatures)
            end do
         end associate
      end do
   end subroutine read_cards

   !> Node or set, temperature. What an earlier step has given is replaced.
   subroutine read_line(line, context, temperatures)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      type(temperatures_t), intent(inout) :: temperatures
      integer, parameter :: FEW = 6, ALL_DIGITS = 15
      type(token_t) :: place
      integer(ip), allocatable :: nodes(:), clashes(:)
      logical, allocatable :: loose(:)
      real(wp) :: value
      integer :: digits
      logical :: ok(2)

      associate (deck => context%deck, node_id => context%model%mesh%node_id)
         place = line_item(deck, line, 1_ip)
         call find_nodes(context, deck%tokens(line%first_token), nodes, ok(1))
         call get_real(deck, line_item(deck, line, 2_ip), 'temperature, a real', value, ok(2))
         if (.not. all(ok)) return
         temperatures%last = line%first_token
         loose = in_no_element(context, nodes)
         if (any(loose) .and. .not. has_errors()) then
            call report_note(deck, place, 'N-NODE', 'node '//ids_text(pack(node_id(nodes), loose))// &
                             ' belongs to no element; the temperature has no effect there')
         end if
         call put_value(nodes, value, line%first_token, context%open%first_token, temperatures%token, temperatures%value, clashes)
         if (size(clashes) == 0) return
         associate (other => temperatures%value(clashes(1)), earlier => deck%tokens(temperatures%token(clashes(1))))
            digits = merge(ALL_DIGITS, FEW, to_text(value, FEW) == to_text(other, FEW))
            call report_error(deck, place, 'E-CONFLICT', 'the temperature of node '//ids_text(node_id(clashes))//' is '// &
                              to_text(value, digits)//' here but '//to_text(other, digits)//' in '// &
                              place_text(deck, earlier, deck%tokens(line%first_token)), expected='one temperature for each node')
         end associate
      end associate
   end subroutine read_line

   !> Gives nodes a value. Those to which a line has given another one since some place of the deck keep that.
   pure subroutine put_value(nodes, value, place, since, token, there, clashes)
      integer(ip), intent(in) :: nodes(:)
      real(wp), intent(in) :: value
      integer(ip), intent(in) :: place, since          !< tokens of the deck: the first of the line, and the first that counts
      integer(ip), intent(inout) :: token(:)           !< (n_nodes) first of the line that has given a node its value; 0: none
      real(wp), intent(inout) :: there(:)              !< (n_nodes)
      integer(ip), allocatable, intent(out) :: clashes(:) !< nodes that have another value
      type(number_list_t) :: list
      integer(ip) :: i

      do i = 1, size(nodes, kind=ip)
         associate (k => nodes(i))
            if (token(k) == 0 .or. token(k) < since) then
               token(k) = place
               there(k) = value
            else if (abs(there(k) - value) > SAME_VALUE*max(abs(there(k)), abs(value))) then
               call add_number(list, k)
            end if
         end associate
      end do
      clashes = numbers_of(list)
   end subroutine put_value

   !> Nodes between two corners that have a temperature, without one of their own: hardly meant.
   subroutine warn_of_middles(context, temperatures)
      type(build_context_t), intent(in) :: context
      type(temperatures_t), intent(in) :: temperatures
      type(number_list_t) :: forgotten
      logical, allocatable :: is_reported(:)
      integer(ip) :: e, i, k, n

      if (temperatures%last == 0) return
      allocate (is_reported(context%model%mesh%n_nodes), source=.false.)
      associate (mesh => context%model%mesh)
         do e = 1, mesh%n_elements
            n = CORNERS_OF(mesh%shape(e))
            if (DEGREE_OF(mesh%shape(e)) == 1) cycle
            do i = 1, n
               k = mesh%nodes(n + i, e)
               if (temperatures%token(k) > 0 .or. is_reported(k)) cycle
               if (any(temperatures%token(mesh%nodes([i, mod(i, n) + 1], e)) == 0)) cycle
               is_reported(k) = .true.
               call add_number(forgotten, mesh%node_id(k))
            end do
         end do
      end associate
      if (forgotten%n == 0) return
      call report_warning(context%deck, context%deck%tokens(temperatures%last), 'W-TEMPERATURE', 'node '// &
                          ids_text(numbers_of(forgotten))//' in the middle of a side has no temperature, though both ends'// &
                          ' have one: it keeps '//trim(merge('0                      ', 'its initial temperature', &
                                                             temperatures%keyword == 'INITIAL CONDITIONS')), &
                          expected='a set with the nodes in the middle of sides, too')
   end subroutine warn_of_middles

   !> The same fields on the refined mesh: they go the way of the coordinates.
   subroutine refine_node_fields(coarse, context)
      type(mesh_t), intent(in) :: coarse               !< mesh of the deck
      type(build_context_t), intent(inout) :: context  !< heating and node_thickness, in place
      integer(ip) :: k

      do k = 1, size(context%model%steps, kind=ip)
         call refine_field(coarse, context%refinement, context%model%mesh%n_nodes, context%model%steps(k)%heating)
         call refine_field(coarse, context%refinement, context%model%mesh%n_nodes, context%model%steps(k)%heating_from)
      end do
      call refine_field(coarse, context%refinement, context%model%mesh%n_nodes, context%node_thickness)
   end subroutine refine_node_fields

   !> Values of the deck's nodes, interpolated at the new ones.
   subroutine refine_field(coarse, refinement, n_nodes, values)
      type(mesh_t), intent(in) :: coarse
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: n_nodes               !< of the refined mesh
      real(wp), allocatable, intent(inout) :: values(:)  !< of the nodes
      type(mesh_t) :: field                            ! the coarse mesh with temperatures for coordinates
      real(wp), allocatable :: value(:, :)
      integer(ip), allocatable :: grid(:, :)
      integer(ip) :: e

      if (.not. allocated(values)) return
      field = coarse
      field%x(1, :coarse%n_nodes) = values
      field%x(2, :coarse%n_nodes) = 0.0_wp
      allocate (value(2, n_nodes), source=0.0_wp)
      value(:, :coarse%n_nodes) = field%x(:, :coarse%n_nodes)
      do e = 1, coarse%n_elements
         call map_element(field, refinement, e, value, grid)
      end do
      values = value(1, :)
   end subroutine refine_field

   !> What grows warmer and has no *EXPANSION is reported; where nothing expands there are no temperatures.
   subroutine check_temperatures(context)
      type(build_context_t), intent(inout) :: context  !< heating goes where nothing expands
      logical, allocatable :: is_heated(:)             ! of the materials
      integer(ip) :: i, e

      if (has_errors()) return
      associate (model => context%model, steps => context%model%steps)
         allocate (is_heated(size(model%materials)), source=.false.)
         do i = 1, size(steps, kind=ip)                ! the materials of elements that grow warmer or colder
            do e = 1, merge(model%mesh%n_elements, 0_ip, allocated(steps(i)%heating))
               if (model%section_of(e) < 1) cycle
               if (.not. any(abs(steps(i)%heating(model%mesh%nodes(:model%mesh%shape(e), e))) > 0.0_wp)) cycle
               is_heated(model%sections(model%section_of(e))%material) = .true.
            end do
         end do
         do i = 1, size(is_heated, kind=ip)
            if (is_heated(i) .and. .not. model%materials(i)%has_expansion) then
               call report_warning(context%deck, context%materials(i), 'W-EXPANSION', 'elements of material ' &
                                   //model%materials(i)%name//' grow warmer or colder, but it has no *EXPANSION: they do not' &
                                   //' expand', expected='*EXPANSION in this material, 0 if this is meant', keyword='EXPANSION')
            end if
         end do
         if (any(is_heated .and. abs(model%materials%expansion) > 0.0_wp)) return
         do i = 1, size(steps, kind=ip)
            if (allocated(steps(i)%heating)) deallocate (steps(i)%heating)
            if (allocated(steps(i)%heating_from)) deallocate (steps(i)%heating_from)
         end do
      end associate
   end subroutine check_temperatures

   !> The thickness of the nodes of the deck's mesh, 0 where there is none; unallocated where no card gives any. Data lines: node or
   !> set, thickness.
   subroutine read_node_thickness(context)
      type(build_context_t), intent(inout) :: context  !< gets node_thickness
      integer(ip), allocatable :: given(:)             ! (n_nodes) token of the line that gives it; 0: none
      integer(ip), allocatable :: nodes(:), clashes(:)
      real(wp) :: value
      integer(ip) :: i, k
      logical :: ok(2)

      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= THICKNESS) cycle
         if (.not. allocated(given)) then
            allocate (given(context%model%mesh%n_nodes), source=0_ip)
            allocate (context%node_thickness(context%model%mesh%n_nodes), source=0.0_wp)
         end if
         associate (card => context%deck%cards(i), deck => context%deck)
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. deck%lines(k)%ok) cycle
               associate (line => deck%lines(k), first => deck%tokens(deck%lines(k)%first_token))
                  call find_nodes(context, first, nodes, ok(1))
                  call get_positive(deck, line_item(deck, line, 2_ip), 'thickness, a real > 0 [L]', 'the thickness ', value, ok(2))
                  context%thickness_undetermined = context%thickness_undetermined .or. .not. all(ok)
                  if (.not. all(ok)) cycle
                  call put_value(nodes, value, line%first_token, 0_ip, given, context%node_thickness, clashes)
                  if (size(clashes) > 0) call report_error(deck, first, 'E-CONFLICT', 'node '// &
                                                           ids_text(context%model%mesh%node_id(clashes))// &
                                                           ' has another thickness in '// &
                                                           place_text(deck, deck%tokens(given(clashes(1))), first), &
                                                           expected='one thickness for each node')
               end associate
            end do
            context%thickness_undetermined = context%thickness_undetermined .or. .not. card%ok
         end associate
      end do
   end subroutine read_node_thickness

   !> Elements of sections with NODAL THICKNESS become tapered; each of their nodes must have a thickness. One that no section asks
   !> for has no effect.
   subroutine taper_elements(context)
      type(build_context_t), intent(inout) :: context  !< mesh of its model gets states and thickness
      type(number_list_t) :: without
      logical, allocatable :: is_reported(:)
      integer(ip) :: e, i, k, first

      if (.not. any(context%model%sections%is_tapered)) then
         i = findloc(context%deck%cards(:context%deck%n_cards)%name, THICKNESS, dim=1, kind=ip)
         if (i > 0 .and. .not. has_errors()) call report_note(context%deck, context%deck%cards(i)%place, 'N-THICKNESS', &
                                                      'no *SOLID SECTION has NODAL THICKNESS: the thickness of nodes has no effect')
         return
      end if
      if (.not. allocated(context%node_thickness)) allocate (context%node_thickness(context%model%mesh%n_nodes), source=0.0_wp)
      allocate (is_reported(context%model%mesh%n_nodes), source=.false.)
      first = 0
      associate (mesh => context%model%mesh)
         do e = 1, mesh%n_elements
            if (context%model%section_of(e) < 1) cycle
            if (.not. context%model%sections(context%model%section_of(e))%is_tapered) cycle
            mesh%state(e) = TAPERED_STATE(mesh%state(e))
            if (.not. IS_TAPERED(mesh%state(e))) cycle ! a ring
            do k = 1, mesh%shape(e)
               associate (node => mesh%nodes(k, e))
                  if (context%node_thickness(node) > 0.0_wp .or. is_reported(node)) cycle
                  is_reported(node) = .true.
                  if (first == 0) first = context%model%section_of(e)
                  call add_number(without, mesh%node_id(node))
               end associate
            end do
         end do
         mesh%thickness = context%node_thickness
      end associate
      if (first == 0 .or. context%thickness_undetermined) return
      call report_error(context%deck, context%sections(first), 'E-THICKNESS', 'node '//ids_text(numbers_of(without))// &
                        ' of elements with NODAL THICKNESS has none', expected='*'//THICKNESS//' with each of their nodes', &
                        keyword=THICKNESS)
   end subroutine taper_elements

end module atrito_node_fields
