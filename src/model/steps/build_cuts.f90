!> *SECTION PRINT: the cuts that a step asks for, and where they go through the bodies.
module atrito_build_cuts
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_body_names, only: name_bodies
   use atrito_build_context, only: build_context_t
   use atrito_cross_section, only: find_cross_section
   use atrito_crossings, only: crossing_t, point_at, INSIDE
   use atrito_deck, only: card_t, data_line_t, token_t, line_item
   use atrito_diagnostics, only: report_error, report_note, report_warning
   use atrito_faces, only: list_node_elements
   use atrito_items, only: get_real, has_option
   use atrito_kinds, only: ip, wp
   use atrito_line_cards, only: elements_to_cross, name_line, note_line, read_line_options
   use atrito_model, only: cut_t, requests_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_cut_card, place_cuts

   character(len=2), parameter :: ITEMS(4) = ['x1', 'y1', 'x2', 'y2']
   integer, parameter :: DIGITS = 6                     !< of coordinates in messages

contains

   !> The cuts of a card; with SURFACE= it is that of another program, which has been noted.
   subroutine read_cut_card(context, card, requests)
      type(build_context_t), intent(inout) :: context   !< its model gets cuts
      type(card_t), intent(in) :: card                  !< *SECTION PRINT
      type(requests_t), intent(inout) :: requests       !< of the step; gets places of cuts
      character(len=:), allocatable :: name
      type(token_t) :: place
      type(cut_t) :: cut
      integer(ip) :: i
      logical :: ok

      if (has_option(context%deck, card, 'SURFACE')) return
      call read_line_options(context, card, name, place, cut%elset, ok)
      if (.not. ok) return
      do i = 1, card%n_lines
         associate (line => context%deck%lines(card%first_line + i - 1))
            if (.not. line%ok) cycle
            call name_line(context, card, i, name, place, context%drawn_cuts, cut%name, ok)
            if (.not. ok) return
            call read_line(context, line, cut%ends, ok)
         end associate
         if (.not. ok) cycle
         call note_line(context, card, i, cut%name, context%drawn_cuts)
         if (.not. allocated(context%model%cuts)) allocate (context%model%cuts(size(context%drawn_cuts%items)))
         if (.not. allocated(requests%cuts)) allocate (requests%cuts(0))
         context%model%cuts(context%drawn_cuts%n) = cut
         requests%cuts = [requests%cuts, context%drawn_cuts%n]
      end do
   end subroutine read_cut_card

   !> x1, y1, x2, y2
   subroutine read_line(context, line, ends, ok)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line
      real(wp), intent(out) :: ends(2, 2)
      logical, intent(out) :: ok
      real(wp) :: x(4)
      logical :: good(4)
      integer(ip) :: k

      do k = 1, 4
         call get_real(context%deck, line_item(context%deck, line, k), ITEMS(k)//', a real [L]', x(k), good(k))
      end do
      ok = all(good)
      if (.not. ok) return
      ends = reshape(x, [2, 2])
      if (any(ends(:, 1) /= ends(:, 2))) return
      ok = .false.
      call report_error(context%deck, line_item(context%deck, line, 3_ip), 'E-VALUE', 'both points of the cut are the same', &
                        expected='x1, y1, x2, y2: two points of a line through a body [L]')
   end subroutine read_line

   !> Finds where the cuts go through the bodies. The mesh is complete.
   subroutine place_cuts(context)
      type(build_context_t), intent(inout) :: context   !< cuts of its model get their sections
      type(bodies_t) :: bodies
      integer(ip) :: i

      if (.not. allocated(context%model%cuts)) return
      context%model%cuts = context%model%cuts(:context%drawn_cuts%n)
      call find_bodies(context%model%mesh, bodies)
      call name_bodies(context%model, bodies)
      context%around = list_node_elements(context%model%mesh)   ! bolts may have cut the mesh since it was listed
      do i = 1, size(context%model%cuts, kind=ip)
         call place_cut()
      end do

   contains

      subroutine place_cut()
         type(crossing_t), allocatable :: crossings(:)
         integer(ip) :: k

         associate (model => context%model, cut => context%model%cuts(i))
            call find_cross_section(model%mesh, context%around, bodies%of_element, cut%ends, &
                                    elements_to_cross(model, cut%elset), cut%section, crossings)
            if (.not. any(crossings%is_taken)) then
               call report_miss(crossings)
            else if (.not. all(crossings%is_whole .or. .not. crossings%is_taken)) then   ! through what is left forces go, too
               k = findloc(crossings%is_taken .and. .not. crossings%is_whole, .true., dim=1, kind=ip)
               call report_error(context%deck, context%drawn_cuts%items(i), 'E-CROSSING', 'cut '//cut%name//' ends within body '// &
                                 bodies%list(crossings(k)%body)%name, expected='a line through the whole of '// &
                                 span_text(crossings(k)))
            else
               call warn_of_several(context, bodies, i, pack(crossings, crossings%is_taken))
            end if
         end associate
      end subroutine place_cut

      !> The cut meets nothing: where its line would, or where the bodies are.
      subroutine report_miss(crossings)
         type(crossing_t), intent(in) :: crossings(:)
         character(len=:), allocatable :: text, hint
         integer(ip) :: k

         associate (cut => context%model%cuts(i), mesh => context%model%mesh)
            text = 'cut '//cut%name//' meets no body'
            if (cut%elset > 0) text = 'cut '//cut%name//' meets no element of '//context%model%element_sets%sets(cut%elset)%name
            k = findloc(crossings%kind == INSIDE .and. crossings%is_wanted, .true., dim=1, kind=ip)
            if (k > 0) then
               hint = 'points farther apart: the line goes through '//span_text(crossings(k))
            else
               hint = 'a line through a body; the bodies lie between '//point_text(minval(mesh%x(:, :mesh%n_nodes), dim=2))// &
                      ' and '//point_text(maxval(mesh%x(:, :mesh%n_nodes), dim=2))
            end if
         end associate
         call report_error(context%deck, context%drawn_cuts%items(i), 'E-CROSSING', text, expected=hint)
      end subroutine report_miss

      !> `BODY from (x, y) to (x, y)`.
      function span_text(crossing) result(text)
         type(crossing_t), intent(in) :: crossing
         character(len=:), allocatable :: text

         associate (line => context%model%cuts(i)%section%line)
            text = bodies%list(crossing%body)%name//', from '//point_text(point_at(line, crossing%from))//' to '// &
                   point_text(point_at(line, crossing%to))
         end associate
      end function span_text
   end subroutine place_cuts

   pure function point_text(x) result(text)
      real(wp), intent(in) :: x(2)
      character(len=:), allocatable :: text

      text = '('//to_text(x(1), DIGITS)//', '//to_text(x(2), DIGITS)//')'
   end function point_text

   !> What may not be meant: several bodies, one body several times, more than the set, an edge.
   subroutine warn_of_several(context, bodies, i, taken)
      type(build_context_t), intent(in) :: context
      type(bodies_t), intent(in) :: bodies
      integer(ip), intent(in) :: i
      type(crossing_t), intent(in) :: taken(:)
      character(len=:), allocatable :: text

      associate (cut => context%model%cuts(i), item => context%drawn_cuts%items(i), name => bodies%list(taken(1)%body)%name)
         if (size(taken) > 1) then
            if (all(taken%body == taken(1)%body)) then
               text = 'cut '//cut%name//' goes through body '//name//' '//to_text(size(taken, kind=ip))//' times'
            else
               text = 'cut '//cut%name//' goes through bodies at '//to_text(size(taken, kind=ip))//' places, from '//name// &
                      ' to '//bodies%list(taken(size(taken))%body)%name
            end if
            call report_warning(context%deck, item, 'W-CROSSING', text//': n, v and m are those of all together', &
                                expected='a shorter line, or ELSET=, for one of them')
         end if
         if (.not. all(taken%is_all_wanted)) then
            call report_warning(context%deck, item, 'W-CROSSING', 'cut '//cut%name//' goes through elements of '// &
                                context%model%element_sets%sets(cut%elset)%name//' and of others: it counts as a whole')
         end if
         if (any(taken%kind /= INSIDE)) then
            call report_note(context%deck, item, 'N-EDGE', 'cut '//cut%name//' runs along the edge of '// &
                             bodies%list(taken(findloc(taken%kind /= INSIDE, .true., dim=1))%body)%name// &
                             ': what acts on the edge is told')
         end if
      end associate
   end subroutine warn_of_several

end module atrito_build_cuts
