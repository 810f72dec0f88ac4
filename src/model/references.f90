!> What the items of a deck refer to: nodes and elements by their numbers or the names of their sets; and the message for what is
!> not there.
module atrito_references
   use atrito_deck, only: card_t, deck_t, token_t, token_text, is_id_token, scope_shift, scope_text
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t, numbered_t, is_invalid, is_undetermined, has_errors, ids_text
   use atrito_element_table, only: CORNERS_OF
   use atrito_id_map, only: find_id
   use atrito_items, only: get_integer, get_name, option_text
   use atrito_kinds, only: ip
   use atrito_mesh, only: find_node, find_element
   use atrito_name_list, only: name_list_t, find_name
   use atrito_sets, only: find_named_nodes, set_list_t, find_set, members_of
   use atrito_refined_members, only: fine_elements
   use atrito_refinement, only: is_refined
   use atrito_strings, only: to_text, upper_case
   implicit none (type, external)
   private
   public :: get_id, find_nodes, find_elements, find_one_node, find_one_element, find_set_option, find_surface, &
             check_faces, element_of_deck, in_no_element, report_unknown

contains

   !> The positive number of a node or element.
   subroutine get_id(deck, token, what, id, ok)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(token_t), intent(in) :: token               !< the item; messages point at it
      character(len=*), intent(in) :: what             !< e.g. 'node number'
      integer(ip), intent(out) :: id                   !< in the model, of an instance shifted; undefined where not ok
      logical, intent(out) :: ok                       !< it is one; else that is reported
      character(len=*), parameter :: POSITIVE = ', a positive integer'
      character(len=len(what) + len(POSITIVE)) :: expected   ! // would take memory for each of millions

      expected(:len(what)) = what
      expected(len(what) + 1:) = POSITIVE
      call get_integer(deck, token, expected, id, ok)
      if (ok .and. id <= 0) then
         ok = .false.
         call report_error(deck, token, 'E-ID', to_text(id)//' is not positive', expected=expected)
      else if (ok .and. allocated(deck%scopes)) then
         call take_scope()
      end if

   contains

      !> The number in the model of a node or element of an instance, or of the assembly.
      subroutine take_scope()
         character(len=:), allocatable :: noun

         associate (scope => deck%scopes(token%scope))
            ok = scope%ok                                 ! if not, that is reported
            if (.not. ok) return
            ok = id <= scope%span
            if (ok) then
               id = id + scope%shift
               return
            end if
         end associate
         noun = 'node'
         if (index(what, noun) == 0) noun = 'element'
         call report_error(deck, token, 'E-'//upper_case(noun), noun//' '//to_text(id)//scope_text(deck, token)// &
                           ' does not exist', expected=what//scope_text(deck, token)//scope_hint(deck, token))
      end subroutine take_scope
   end subroutine get_id

   !> Outside of parts a bare number is that of the assembly.
   pure function scope_hint(deck, token) result(text)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      character(len=:), allocatable :: text

      text = ''
      if (.not. allocated(deck%scopes) .or. token%scope > 0) return
      text = '; here a bare number is one of the assembly, that of an instance is instance.number'
      if (size(deck%scopes) > 1) text = text//', as '//deck%scopes(1)%name//'.1'
   end function scope_hint

   !> The place of the node whose number an item is.
   subroutine find_one_node(context, token, node, ok)
      type(build_context_t), intent(in) :: context     !< its mesh is searched
      type(token_t), intent(in) :: token               !< the item; messages point at it
      integer(ip), intent(out) :: node                 !< place in the mesh; 0: not ok
      logical, intent(out) :: ok                       !< there is one; else that is reported
      integer(ip) :: id

      node = 0
      call get_id(context%deck, token, 'node number', id, ok)
      if (.not. ok) return
      node = find_node(context%model%mesh, id)
      ok = node > 0
      if (.not. ok) call report_missing(context, token, context%nodes, 'node', id, context%model%mesh%n_nodes)
   end subroutine find_one_node

   !> The place of the element whose number an item is, in the mesh of the deck.
   subroutine find_one_element(context, token, element, ok)
      type(build_context_t), intent(in) :: context     !< its mesh, or that of the deck, is searched
      type(token_t), intent(in) :: token               !< the item; messages point at it
      integer(ip), intent(out) :: element              !< place in the mesh of the deck; 0: not ok
      logical, intent(out) :: ok                       !< there is one; else that is reported
      integer(ip) :: id

      element = 0
      call get_id(context%deck, token, 'element number', id, ok)
      if (.not. ok) return
      element = element_of_deck(context, id)
      ok = element > 0
      if (.not. ok) call report_missing(context, token, context%elements, 'element', id, context%model%mesh%n_elements)
   end subroutine find_one_element

   !> The place of an element in the mesh of the deck by its number; 0: there is none.
   pure integer(ip) function element_of_deck(context, id)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: id

      if (is_refined(context%refinement)) then
         element_of_deck = find_id(context%deck_elements, id)
      else
         element_of_deck = find_element(context%model%mesh, id)
      end if
   end function element_of_deck

   !> A number that no node or element has, unless an earlier error explains it.
   subroutine report_missing(context, token, numbered, noun, id, n)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: token
      type(numbered_t), intent(in) :: numbered
      character(len=*), intent(in) :: noun             !< 'node' or 'element'
      integer(ip), intent(in) :: id
      integer(ip), intent(in) :: n                     !< how many there are
      character(len=:), allocatable :: makers, known

      if (has_errors() .and. find_id(numbered%invalid, id) > 0 .or. is_undetermined(context, noun)) return
      makers = '*NODE, *NGEN, *NFILL or *BLOCK'
      if (noun == 'element') makers = '*ELEMENT, *ELGEN or *BLOCK'
      known = ' that '//makers//' defines ('//to_text(n)//' '//noun//'s, the greatest '//to_text(numbered%greatest)//')'
      if (n == 0) known = ' that '//makers//' defines (there is none)'
      if (allocated(context%deck%scopes)) known = scope_text(context%deck, token)//scope_hint(context%deck, token)
      call report_error(context%deck, token, 'E-'//upper_case(noun), noun//' '//to_text(id - scope_shift(context%deck, token))// &
                        scope_text(context%deck, token)//' does not exist', expected='the number of '//article(noun)//noun//known)
   end subroutine report_missing

   !> The places of the nodes that an item names: a number or a node set.
   subroutine find_nodes(context, token, members, ok)
      type(build_context_t), intent(in) :: context        !< its mesh and sets are searched
      type(token_t), intent(in) :: token                  !< the item; messages point at it
      integer(ip), allocatable, intent(out) :: members(:) !< places in the mesh; empty where not ok
      logical, intent(out) :: ok                          !< there are such; else that is reported
      character(len=:), allocatable :: name, fault
      integer(ip) :: node

      if (is_id_token(context%deck, token)) then
         call find_one_node(context, token, node, ok)
         members = pack([node], [ok])
         return
      end if
      members = [integer(ip) ::]
      call get_name(context%deck, token, 'node number, or name of a set', name, ok)
      if (.not. ok) return
      call find_named_nodes(context%model%mesh, context%model%node_sets, context%model%element_sets, name, members, ok, fault)
      if (allocated(fault)) then
         call report_error(context%deck, token, 'E-SET', fault, expected='a corner, or a middle with a node: of an even number '// &
                           'of elements; *NSET, AT takes the nearest')
      else if (.not. ok) then
         call report_unknown(context, token, 'node set', 'E-SET', context%model%node_sets%names)
      end if
   end subroutine find_nodes

   !> The places of the elements that an item names: a number or an element set.
   subroutine find_elements(context, token, members, ok)
      type(build_context_t), intent(in) :: context        !< its mesh and sets are searched
      type(token_t), intent(in) :: token                  !< the item; messages point at it
      integer(ip), allocatable, intent(out) :: members(:) !< places in the mesh as it is solved; empty where not ok
      logical, intent(out) :: ok                          !< there are such; else that is reported
      character(len=:), allocatable :: name
      integer(ip) :: i

      members = [integer(ip) ::]
      if (is_id_token(context%deck, token)) then
         call find_one_element(context, token, i, ok)
         members = pack([i], [ok])
         if (is_refined(context%refinement)) members = fine_elements(context%refinement, members)
         return
      end if
      call get_name(context%deck, token, 'element number, or name of a set', name, ok)
      if (.not. ok) return
      associate (sets => context%model%element_sets)
         i = find_set(sets, name)
         ok = i > 0
         if (ok) members = members_of(sets%sets(i))
         if (.not. ok) call report_unknown(context, token, 'element set', 'E-SET', sets%names)
      end associate
   end subroutine find_elements

   !> The set that an option of a card names; 0: the option is not given.
   subroutine find_set_option(context, card, option, noun, sets, set, ok)
      type(build_context_t), intent(in) :: context     !< its deck names the option's place
      type(card_t), intent(in) :: card                 !< whose option it is
      character(len=*), intent(in) :: option           !< NSET or ELSET
      character(len=*), intent(in) :: noun             !< 'node set' or 'element set'
      type(set_list_t), intent(in) :: sets             !< of nodes or of elements, of the model
      integer(ip), intent(out) :: set                  !< place
      logical, intent(out) :: ok                       !< false: an unknown set, which is reported
      character(len=:), allocatable :: name
      type(token_t) :: place
      logical :: found

      set = 0
      call option_text(context%deck, card, option, name, found, place)
      if (found) set = find_set(sets, name)
      ok = set > 0 .or. .not. found
      if (.not. ok) call report_unknown(context, place, noun, 'E-SET', sets%names)
   end subroutine find_set_option

   !> An unknown name, unless an earlier error explains it.
   subroutine report_unknown(context, token, noun, id, known)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: token
      character(len=*), intent(in) :: noun             !< what should have this name, e.g. 'element set'
      character(len=*), intent(in) :: id
      type(name_list_t), intent(in) :: known           !< names of these that there are
      character(len=:), allocatable :: expected

      if (is_invalid(context, token_text(context%deck, token)) .or. is_undetermined(context, noun)) return
      expected = 'name of '//article(noun)//noun//' of this deck'
      if (known%n == 0) expected = expected//'; there is none'
      if (noun == 'surface') then
         if (find_set(context%model%node_sets, token_text(context%deck, token)) > 0) then
            expected = expected//'; this is a node set: on the outline '// &
                       '*SURFACE, TYPE=NODE makes a surface of it, inside the mesh there are no faces'
         end if
      end if
      call report_error(context%deck, token, id, 'unknown '//noun//' '//token_text(context%deck, token), expected=expected, &
                        among=known)
   end subroutine report_unknown

   !> The surface of a name that an item has; one that nobody defines is reported.
   subroutine find_surface(context, token, surface)
      type(build_context_t), intent(in) :: context     !< names of its surfaces are searched
      type(token_t), intent(in) :: token               !< the item
      integer(ip), intent(out) :: surface              !< place among the surfaces of the model; 0: there is none

      surface = find_name(context%surface_names, token_text(context%deck, token))
      if (surface == 0) call report_unknown(context, token, 'surface', 'E-SURFACE', context%surface_names)
   end subroutine find_surface

   !> Elements have a face of this number: triangles have no fourth. Of a refined mesh that has been asked of the deck's.
   subroutine check_faces(context, token, elements, face, ok)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: token               !< S1..S4 or P1..P4
      integer(ip), intent(in) :: elements(:), face
      logical, intent(out) :: ok
      integer(ip), allocatable :: without(:)

      ok = face <= 3 .or. is_refined(context%refinement)
      if (ok) return
      without = pack(context%model%mesh%element_id(elements), CORNERS_OF(context%model%mesh%shape(elements)) < face)
      ok = size(without) == 0
      if (ok) return
      call report_error(context%deck, token, 'E-FACE', 'element '//ids_text(without)//' has no face '//to_text(face), &
                        expected='a face that each of the elements has: triangles have 1-2, 2-3 and 3-1')
   end subroutine check_faces

   !> The nodes of a list that belong to no element.
   pure function in_no_element(context, nodes) result(loose)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:)              !< places
      logical :: loose(size(nodes))

      loose = context%around%first(nodes + 1) == context%around%first(nodes)
   end function in_no_element

   pure function article(noun) result(text)
      character(len=*), intent(in) :: noun
      character(len=:), allocatable :: text

      text = 'a '
      if (scan(noun(1:1), 'aeiou') > 0) text = 'an '
   end function article

end module atrito_references
