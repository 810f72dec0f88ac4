!> *NODAL THICKNESS: the thickness of nodes, which the elements of sections with NODAL THICKNESS interpolate.
!>
!> The deck's elements interpolate; --refine and --elements change nothing of that field.
module atrito_build_thickness
   use atrito_build_context, only: build_context_t, place_text, ids_text, has_errors
   use atrito_build_temperatures, only: put_value, refine_field
   use atrito_deck, only: data_line_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error, report_note
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_plane_state, only: TAPERED_STATE, IS_TAPERED
   use atrito_read_elastic, only: get_positive
   use atrito_references, only: find_nodes
   implicit none (type, external)
   private
   public :: read_node_thickness, refine_thickness, taper_elements

   character(len=*), parameter :: KEYWORD = 'NODAL THICKNESS'

contains

   !> The thickness of the nodes of the deck's mesh, 0 where there is none; unallocated where no card gives any.
   subroutine read_node_thickness(context)
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable :: given(:)             ! (n_nodes) token of the line that gives it; 0: none
      integer(ip) :: i, k

      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i))
            if (keyword_name(card) /= KEYWORD) cycle
            if (.not. allocated(given)) then
               allocate (given(context%model%mesh%n_nodes), source=0_ip)
               allocate (context%node_thickness(context%model%mesh%n_nodes), source=0.0_wp)
            end if
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (context%deck%lines(k)%ok) call read_line(context%deck%lines(k), context, given)
            end do
            context%thickness_undetermined = context%thickness_undetermined .or. .not. card%ok
         end associate
      end do
   end subroutine read_node_thickness

   !> Node or set, thickness.
   subroutine read_line(line, context, given)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(inout) :: given(:)
      integer(ip), allocatable :: nodes(:), clashes(:)
      real(wp) :: value
      logical :: ok(2)

      associate (deck => context%deck)
         call find_nodes(context, deck%tokens(line%first_token), nodes, ok(1), KEYWORD)
         call get_positive(deck, line_item(deck, line, 2_ip), 'thickness, a real > 0 [L]', 'the thickness ', value, ok(2), KEYWORD)
         if (.not. all(ok)) context%thickness_undetermined = .true.
         if (.not. all(ok)) return
         call put_value(nodes, value, line%first_token, 0_ip, given, context%node_thickness, clashes)
         if (size(clashes) == 0) return
         call report_error(deck, line_item(deck, line, 1_ip), 'E-CONFLICT', 'node '// &
                           ids_text(context%model%mesh%node_id(clashes))//' has another thickness in '// &
                           place_text(deck, deck%tokens(given(clashes(1))), deck%tokens(line%first_token)), &
                           expected='one thickness for each node', keyword=KEYWORD)
      end associate
   end subroutine read_line

   !> The same field on the refined mesh.
   subroutine refine_thickness(coarse, context)
      type(mesh_t), intent(in) :: coarse
      type(build_context_t), intent(inout) :: context
      real(wp), allocatable :: values(:)

      call move_alloc(context%node_thickness, values)
      call refine_field(coarse, context, values)
      call move_alloc(values, context%node_thickness)
   end subroutine refine_thickness

   !> Elements of sections with NODAL THICKNESS become tapered; each of their nodes must have a thickness. One that no section asks
   !> for has no effect.
   subroutine taper_elements(context)
      type(build_context_t), intent(inout) :: context
      type(number_list_t) :: without
      logical, allocatable :: is_told(:)
      integer(ip) :: e, i, k, first

      if (.not. any(context%model%sections%is_tapered)) then
         i = findloc(context%deck%cards(:context%deck%n_cards)%name, KEYWORD, dim=1, kind=ip)
         if (i > 0 .and. .not. has_errors()) call report_note(context%deck, context%deck%cards(i)%place, 'N-THICKNESS', &
                                                   'no *SOLID SECTION has NODAL THICKNESS: the thickness of nodes has no effect', &
                                                              keyword=KEYWORD)
         return
      end if
      if (.not. allocated(context%node_thickness)) then
         allocate (context%node_thickness(context%model%mesh%n_nodes), source=0.0_wp)
      end if
      allocate (is_told(context%model%mesh%n_nodes), source=.false.)
      first = 0
      associate (mesh => context%model%mesh)
         do e = 1, mesh%n_elements
            if (context%model%section_of(e) < 1) cycle
            if (.not. context%model%sections(context%model%section_of(e))%is_tapered) cycle
            mesh%state(e) = TAPERED_STATE(mesh%state(e))
            if (.not. IS_TAPERED(mesh%state(e))) cycle ! a ring
            do k = 1, mesh%shape(e)
               associate (node => mesh%nodes(k, e))
                  if (context%node_thickness(node) > 0.0_wp .or. is_told(node)) cycle
                  is_told(node) = .true.
                  if (first == 0) first = context%model%section_of(e)
                  call add_number(without, mesh%node_id(node))
               end associate
            end do
         end do
         mesh%thickness = context%node_thickness
      end associate
      if (first == 0 .or. context%thickness_undetermined) return
      call report_error(context%deck, context%sections(first), 'E-THICKNESS', 'node '//ids_text(numbers_of(without))// &
                        ' of elements with NODAL THICKNESS has none', expected='*'//KEYWORD//' with each of their nodes', &
                        keyword=KEYWORD)
   end subroutine taper_elements

end module atrito_build_thickness
