!> *INITIAL CONDITIONS, TYPE=TEMPERATURE and *TEMPERATURE: by how much the nodes grow warmer.
!>
!> Nodes that no line names keep their initial temperature, which is 0 where none is given. The deck's elements interpolate what
!> their nodes have; --refine and --elements change nothing of that field.
module atrito_build_temperatures
   use atrito_build_context, only: build_context_t, place_text, ids_text, has_errors
   use atrito_build_steps, only: open_step
   use atrito_deck, only: data_line_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error, report_note, report_warning
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF
   use atrito_items, only: get_real
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_model, only: step_t
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_propagation, only: removes_all
   use atrito_references, only: find_nodes, in_no_element
   use atrito_refinement, only: map_element
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_temperatures, refine_temperatures, refine_field, check_temperatures, double_temperatures

   !> Two values of one node are the same when they differ by less than this part of them: expressions are rounded.
   real(wp), parameter :: SAME_VALUE = 1.0e-12_wp

   !> The temperatures of one keyword.
   type :: temperatures_t
      character(len=18) :: keyword = ''
      integer(ip), allocatable :: token(:)             !< (n_nodes) first of the line that gives it; 0: none
      real(wp), allocatable :: value(:)
      integer(ip) :: last = 0                          !< token of the last line; 0: there is none
   end type temperatures_t

contains

   !> The rise of the temperature of each node of the deck's mesh; heating stays unallocated where nothing grows warmer.
   subroutine read_temperatures(context)
      type(build_context_t), intent(inout) :: context
      type(temperatures_t) :: before, now
      integer(ip) :: k

      call begin_temperatures(context, 'INITIAL CONDITIONS', before)
      call read_cards(context, 0_ip, before)
      call begin_temperatures(context, 'TEMPERATURE', now)
      do k = 1, size(context%model%steps, kind=ip)
         call open_step(context, k)
         call read_step(context, before, now)
      end do
      if (before%last == 0 .and. now%last == 0) return
      if (now%last == 0) then
         call report_note(context%deck, context%deck%tokens(before%last), 'N-TEMPERATURE', 'no *TEMPERATURE of the step makes' &
                          //' anything warmer or colder than that', keyword='INITIAL CONDITIONS')
         return
      end if
      call warn_of_middles(context, before)
   end subroutine read_temperatures

   !> The temperatures of a step: those of the step before but for what its lines change.
   subroutine read_step(context, before, now)
      type(build_context_t), intent(inout) :: context
      type(temperatures_t), intent(in) :: before
      type(temperatures_t), intent(inout) :: now
      integer(ip) :: last

      associate (steps => context%model%steps, k => context%open%number)
         if (removes_all(context, 'TEMPERATURE')) now%token = 0
         last = now%last
         call read_cards(context, k, now)
         if (now%last /= last) call warn_of_middles(context, now)
         if (now%last == 0) return
         where (now%token == 0) now%value = before%value
         if (any(abs(now%value - before%value) > 0.0_wp)) steps(k)%heating = now%value - before%value
         if (k == 1) return
         if (.not. allocated(steps(k - 1)%heating)) return
         if (any(abs(steps(k - 1)%heating) > 0.0_wp)) steps(k)%heating_from = steps(k - 1)%heating
         if (.not. allocated(steps(k)%heating) .and. allocated(steps(k)%heating_from)) steps(k)%heating = now%value - before%value
      end associate
   end subroutine read_step

   subroutine begin_temperatures(context, keyword, temperatures)
      type(build_context_t), intent(in) :: context
      character(len=*), intent(in) :: keyword
      type(temperatures_t), intent(out) :: temperatures

      temperatures%keyword = keyword
      allocate (temperatures%token(context%model%mesh%n_nodes), source=0_ip)
      allocate (temperatures%value(context%model%mesh%n_nodes), source=0.0_wp)
   end subroutine begin_temperatures

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

   !> Node or set, temperature.
   subroutine read_line(line, context, temperatures)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      type(temperatures_t), intent(inout) :: temperatures
      type(number_list_t) :: clashes
      integer(ip), allocatable :: nodes(:)
      real(wp) :: value
      integer(ip) :: i
      logical :: ok(2)

      call find_nodes(context, context%deck%tokens(line%first_token), nodes, ok(1), trim(temperatures%keyword))
      call get_real(context%deck, line_item(context%deck, line, 2_ip), 'temperature, a real', value, ok(2), &
                    keyword=trim(temperatures%keyword))
      if (.not. all(ok)) return
      temperatures%last = line%first_token
      call note_loose(line, context, nodes, trim(temperatures%keyword))
      do i = 1, size(nodes, kind=ip)
         associate (token => temperatures%token(nodes(i)), there => temperatures%value(nodes(i)))
            if (token == 0 .or. token < context%open%first_token) then
               token = line%first_token
               there = value
            else if (abs(there - value) > SAME_VALUE*max(abs(there), abs(value))) then
               call add_number(clashes, nodes(i))
            end if
         end associate
      end do
      if (clashes%n > 0) call report_clash(line, context, numbers_of(clashes), value, temperatures)
   end subroutine read_line

   subroutine note_loose(line, context, nodes, keyword)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:)
      character(len=*), intent(in) :: keyword
      logical :: loose(size(nodes))

      loose = in_no_element(context, nodes)
      if (any(loose) .and. .not. has_errors()) then
         call report_note(context%deck, line_item(context%deck, line, 1_ip), 'N-NODE', 'node ' &
                          //ids_text(pack(context%model%mesh%node_id(nodes), loose)) &
                          //' belongs to no element; the temperature has no effect there', keyword=keyword)
      end if
   end subroutine note_loose

   subroutine report_clash(line, context, nodes, value, temperatures)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:)
      real(wp), intent(in) :: value
      type(temperatures_t), intent(in) :: temperatures
      integer, parameter :: FEW = 6, ALL_DIGITS = 15
      real(wp) :: other
      integer :: digits

      other = temperatures%value(nodes(1))
      digits = merge(ALL_DIGITS, FEW, to_text(value, FEW) == to_text(other, FEW))
      call report_error(context%deck, line_item(context%deck, line, 1_ip), 'E-CONFLICT', 'the temperature of node ' &
                        //ids_text(context%model%mesh%node_id(nodes))//' is '//to_text(value, digits)//' here but ' &
                        //to_text(other, digits)//' in '//place_text(context%deck, &
                                                                     context%deck%tokens(temperatures%token(nodes(1))), &
                                                                     context%deck%tokens(line%first_token)), &
                        expected='one temperature for each node', keyword=trim(temperatures%keyword))
   end subroutine report_clash

   !> Nodes between two corners that have a temperature, without one of their own: hardly meant.
   subroutine warn_of_middles(context, temperatures)
      type(build_context_t), intent(in) :: context
      type(temperatures_t), intent(in) :: temperatures
      type(number_list_t) :: forgotten
      logical, allocatable :: is_told(:)
      integer(ip) :: e, i, k, n

      if (temperatures%last == 0) return
      allocate (is_told(context%model%mesh%n_nodes), source=.false.)
      associate (mesh => context%model%mesh)
         do e = 1, mesh%n_elements
            n = CORNERS_OF(mesh%shape(e))
            if (DEGREE_OF(mesh%shape(e)) == 1) cycle
            do i = 1, n
               k = mesh%nodes(n + i, e)
               if (temperatures%token(k) > 0 .or. is_told(k)) cycle
               if (any(temperatures%token(mesh%nodes([i, mod(i, n) + 1], e)) == 0)) cycle
               is_told(k) = .true.
               call add_number(forgotten, mesh%node_id(k))
            end do
         end do
      end associate
      if (forgotten%n == 0) return
      call report_warning(context%deck, context%deck%tokens(temperatures%last), 'W-TEMPERATURE', 'node ' &
                          //ids_text(numbers_of(forgotten))//' in the middle of a side has no temperature, though both ends' &
                          //' have one: it keeps '//trim(merge('0                      ', 'its initial temperature', &
                                                               temperatures%keyword == 'INITIAL CONDITIONS')), &
                          expected='a set with the nodes in the middle of sides, too', keyword=trim(temperatures%keyword))
   end subroutine warn_of_middles

   !> The same field on the refined mesh: it goes the way of the coordinates.
   subroutine refine_temperatures(coarse, context)
      type(mesh_t), intent(in) :: coarse
      type(build_context_t), intent(inout) :: context
      integer(ip) :: k

      do k = 1, size(context%model%steps, kind=ip)
         call refine_field(coarse, context, context%model%steps(k)%heating)
         call refine_field(coarse, context, context%model%steps(k)%heating_from)
      end do
   end subroutine refine_temperatures

   !> Values of the deck's nodes, interpolated at the new ones.
   subroutine refine_field(coarse, context, values)
      type(mesh_t), intent(in) :: coarse
      type(build_context_t), intent(in) :: context
      real(wp), allocatable, intent(inout) :: values(:)  !< of the nodes
      type(mesh_t) :: field                            ! the coarse mesh with temperatures for coordinates
      real(wp), allocatable :: value(:, :)
      integer(ip), allocatable :: grid(:, :)
      integer(ip) :: e

      if (.not. allocated(values)) return
      field = coarse
      field%x(1, :coarse%n_nodes) = values
      field%x(2, :coarse%n_nodes) = 0.0_wp
      allocate (value(2, context%model%mesh%n_nodes), source=0.0_wp)
      value(:, :coarse%n_nodes) = field%x(:, :coarse%n_nodes)
      do e = 1, coarse%n_elements
         call map_element(field, context%refinement, e, value, grid)
      end do
      values = value(1, :)
   end subroutine refine_field

   !> New nodes behind the others, as warm as those that they double.
   pure subroutine double_temperatures(steps, nodes)
      type(step_t), intent(inout) :: steps(:)
      integer(ip), intent(in) :: nodes(:)
      integer(ip) :: i

      do i = 1, size(steps, kind=ip)
         if (allocated(steps(i)%heating)) steps(i)%heating = [steps(i)%heating, steps(i)%heating(nodes)]
         if (allocated(steps(i)%heating_from)) steps(i)%heating_from = [steps(i)%heating_from, steps(i)%heating_from(nodes)]
      end do
   end subroutine double_temperatures

   !> What grows warmer and has no *EXPANSION is told; where nothing expands there are no temperatures.
   subroutine check_temperatures(context)
      type(build_context_t), intent(inout) :: context
      logical, allocatable :: is_heated(:)             ! of the materials
      logical :: expands
      integer(ip) :: i, e

      if (has_errors()) return
      associate (model => context%model)
         allocate (is_heated(size(model%materials)), source=.false.)
         do i = 1, size(model%steps, kind=ip)
            ! The materials of elements that grow warmer or colder.
            if (allocated(model%steps(i)%heating)) then
               do e = 1, model%mesh%n_elements
                  if (model%section_of(e) < 1) cycle
                  if (.not. any(abs(model%steps(i)%heating(model%mesh%nodes(:model%mesh%shape(e), e))) > 0.0_wp)) cycle
                  is_heated(model%sections(model%section_of(e))%material) = .true.
               end do
            end if
         end do
         expands = any(is_heated .and. abs(model%materials%expansion) > 0.0_wp)
         do i = 1, size(is_heated, kind=ip)
            if (is_heated(i) .and. .not. model%materials(i)%has_expansion) then
               call report_warning(context%deck, context%materials(i), 'W-EXPANSION', 'elements of material ' &
                                   //model%materials(i)%name//' grow warmer or colder, but it has no *EXPANSION: they do not' &
                                   //' expand', expected='*EXPANSION in this material, 0 if this is meant', keyword='EXPANSION')
            end if
         end do
         do i = 1, size(model%steps, kind=ip)
            if (expands) exit
            if (allocated(model%steps(i)%heating)) deallocate (model%steps(i)%heating)
            if (allocated(model%steps(i)%heating_from)) deallocate (model%steps(i)%heating_from)
         end do
      end associate
   end subroutine check_temperatures

end module atrito_build_temperatures
