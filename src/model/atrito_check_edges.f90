!> Elements that have an edge in common have all nodes of it in common: four-node beside nine-node elements, or large ones of nine
!> nodes beside small ones, would leave a crack between common corners that nobody sees in a list of nodes.
module atrito_check_edges
   use atrito_diagnostics, only: report_error
   use atrito_draft, only: draft_t, place_token, ids_text
   use atrito_element_table, only: SHAPES, DEGREE_OF
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t, side_count, face_end, middle_node
   use atrito_model, only: model_t
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   implicit none (type, external)
   private
   public :: check_edges

contains

   !> Reports the elements that do not fit their neighbours, all in one message.
   subroutine check_edges(model, draft)
      type(model_t), intent(in) :: model
      type(draft_t), intent(in) :: draft
      logical, allocatable :: misfit(:)
      type(number_list_t) :: ids
      integer(ip) :: e, first

      if (all(DEGREE_OF(model%mesh%shape(:model%mesh%n_elements)) == 1)) return
      allocate (misfit(model%mesh%n_elements), source=.false.)
      do e = 1, model%mesh%n_elements
         if (SHAPES(model%mesh%shape(e))%degree > 1) call compare_neighbours(model%mesh, draft, e, misfit)
      end do
      first = findloc(misfit, .true., dim=1, kind=ip)
      if (first == 0) return
      do e = first, model%mesh%n_elements
         if (misfit(e)) call add_number(ids, model%mesh%element_id(e))
      end do
      call report_error(draft%deck, place_token(draft%deck, draft%elements%place(first)), 'E-EDGE', 'element '// &
                        ids_text(numbers_of(ids))//' and a neighbour share nodes of an edge, but not all of them', &
                        expected='elements of one order and size on both sides of an edge (CPE4 or CPE9, CPS4 or CPS9), '// &
                        'or no common nodes and a *CONTACT PAIR', keyword='ELEMENT')
   end subroutine check_edges

   !> Marks the neighbours of an element of the second degree that have the corners of its edge and not its middle, or its middle
   !> as something else than the middle of the same edge; of two such elements the one that comes later.
   pure subroutine compare_neighbours(mesh, draft, element, misfit)
      type(mesh_t), intent(in) :: mesh
      type(draft_t), intent(in) :: draft
      integer(ip), intent(in) :: element
      logical, intent(inout) :: misfit(:)
      integer(ip) :: face, k, other, middle

      do face = 1, side_count(mesh, element)
         associate (a => mesh%nodes(face, element), b => mesh%nodes(face_end(mesh, element, face), element), &
                    first => draft%around%first)
            middle = middle_node(mesh, element, face)
            do k = first(middle), first(middle + 1) - 1
               other = draft%around%list(k)
               if (other == element .or. has_edge(mesh, other, b, a, middle)) cycle
               misfit(max(element, other)) = .true.
            end do
            do k = first(a), first(a + 1) - 1
               other = draft%around%list(k)
               if (.not. has_edge(mesh, other, b, a) .or. has_edge(mesh, other, b, a, middle)) cycle
               misfit(max(element, other)) = .true.
            end do
         end associate
      end do
   end subroutine compare_neighbours

   !> An element has an edge between two corners, with this node in its middle.
   pure logical function has_edge(mesh, element, a, b, middle)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element, a, b
      integer(ip), intent(in), optional :: middle
      integer(ip) :: face

      has_edge = .false.
      do face = 1, side_count(mesh, element)
         if (mesh%nodes(face, element) /= a .or. mesh%nodes(face_end(mesh, element, face), element) /= b) cycle
         has_edge = .true.
         if (present(middle)) has_edge = middle_node(mesh, element, face) == middle
         if (has_edge) return
      end do
   end function has_edge

end module atrito_check_edges
