!> Bilateral rows of *EQUATION.
module atrito_build_equations
   use atrito_bilateral_rows, only: add_row, ROW_EQUATION
   use atrito_build_context, only: build_context_t
   use atrito_build_rigid_bodies, only: ROTATION_DOF
   use atrito_deck, only: data_line_t, token_t, line_item, is_empty_token, keyword_name
   use atrito_diagnostics, only: report_error, report_note
   use atrito_items, only: get_integer, get_real
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: add_nodal_value
   use atrito_references, only: find_nodes
   use atrito_refinement, only: is_refined
   use atrito_row_dofs, only: check_row_dof, check_row_nodes, row_terms, row_weight, TERMS_A_DOF, WHAT_DOF
   use atrito_refined_deck, only: order_like
   use atrito_refined_members, only: add_nodes_between
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_equations

   integer(ip), parameter :: ITEMS_A_TERM = 3, PLANE_DOFS = 2, LAST_DOF = 6, NO_DOF = 0
   character(len=*), parameter :: KEYWORD = 'EQUATION'
   character(len=*), parameter :: TERM = 'terms of node, dof, coefficient, up to as many as announced'

   !> One term of an equation: the same for all nodes of a set.
   type :: term_t
      integer(ip), allocatable :: nodes(:)       !< places in the mesh
      integer(ip) :: dof = 0                     !< 1, 2 or 6; NO_DOF: the term says nothing
      real(wp) :: coefficient = 0.0_wp           !< of the dof; of dof 6 the rotation is in rad
   end type term_t

contains

   !> All *EQUATION cards.
   subroutine build_equations(context)
      type(build_context_t), intent(inout) :: context  !< its model gets equations and bilateral rows
      type(term_t), allocatable :: terms(:)
      type(token_t) :: place
      integer(ip) :: i, j, k, last, group
      real(wp) :: weight
      logical :: ok

      weight = row_weight(context%model)
      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i))
            if (keyword_name(card) /= KEYWORD .or. .not. card%ok) cycle
            group = context%model%bilateral%n_groups + 1
            k = card%first_line
            last = card%first_line + card%n_lines - 1
            do while (k <= last)
               place = line_item(context%deck, context%deck%lines(k), 1_ip)
               call read_terms(context, last, k, terms, ok)
               if (.not. ok) exit                     ! where the next one begins is not known
               terms = terms(pack([(j, j=1, size(terms, kind=ip))], terms%dof /= NO_DOF))
               if (size(terms) == 0) cycle
               call order_sets(terms)
               if (ok) call add_equations()
            end do
         end associate
      end do

   contains

      !> The equations of terms: one for each node of the first.
      subroutine add_equations()
         integer(ip) :: i, k, node, nodes(TERMS_A_DOF, size(terms))
         real(wp) :: vectors(2, TERMS_A_DOF, size(terms)), scale

         associate (n => size(terms(1)%nodes, kind=ip))
            if (any([(size(terms(i)%nodes) /= 1 .and. size(terms(i)%nodes) /= n, i=1, size(terms, kind=ip))])) then
               call report_error(context%deck, place, 'E-EQUATION', 'the sets of this equation have different numbers of nodes', &
                                 expected='sets of as many nodes as the first, or single nodes')
               return
            end if
            do k = 1, n
               do i = 1, size(terms, kind=ip)
                  node = terms(i)%nodes(min(k, size(terms(i)%nodes, kind=ip)))
                  call row_terms(context, node, terms(i)%dof, 1.0_wp, nodes(:, i), vectors(:, :, i))
                  vectors(:, :, i) = terms(i)%coefficient*vectors(:, :, i)
               end do
               if (is_empty([nodes], reshape(vectors, [2_ip, size(nodes, kind=ip)]))) then
                  call report_error(context%deck, place, 'E-VALUE', 'all coefficients of this equation are 0, or cancel', &
                                    expected='a coefficient other than 0')
                  return
               end if
               scale = 1.0_wp                               ! rotations have another unit: the largest entry is 1 as of motions
               if (any(terms%dof == ROTATION_DOF)) scale = 1/maxval(abs(vectors))
               call add_nodal_value(context%model%equations, terms(1)%nodes(k), terms(1)%dof, scale*terms(1)%coefficient)
               call add_row([nodes], reshape(scale*vectors, [2_ip, size(nodes, kind=ip)]), 0.0_wp, 0.0_wp, &
                            weight, [ROW_EQUATION, group, context%model%equations%n], context%model%bilateral)
            end do
         end associate
      end subroutine add_equations

      !> On a refined mesh the nodes of sets are put into the order of those of the first. Where all of a set move as one node that
      !> is
      !> no member of it, what is new between members and that node belongs to the set, too.
      subroutine order_sets(terms)
         type(term_t), intent(inout) :: terms(:)
         integer(ip), allocatable :: nodes(:)
         integer(ip) :: i

         ok = .true.
         if (.not. is_refined(context%refinement) .or. size(terms(1)%nodes) == 1) return
         if (all([(size(terms(i)%nodes), i=2, size(terms, kind=ip))] == 1)) then
            do i = 2, size(terms, kind=ip)
               if (.not. is_idle_at(terms(i)%nodes(1), terms, context)) cycle
               nodes = [terms(i)%nodes(1), terms(1)%nodes]
               call add_nodes_between(context%model%mesh, context%refinement, nodes)
               terms(1)%nodes = nodes(2:)
            end do
            return
         end if
         do i = 2, size(terms, kind=ip)
            if (size(terms(i)%nodes) == 1 .or. size(terms(i)%nodes) /= size(terms(1)%nodes)) cycle
            if (ok) call order_like(context%refinement, terms(1)%nodes, terms(i)%nodes, ok)
         end do
         if (.not. ok) call report_error(context%deck, place, 'E-REFINE', 'the new nodes of these sets have no partners', &
                                         expected='sets along edges of elements, in the same order')
      end subroutine order_sets
   end subroutine build_equations

   !> One equation: a line with the number of its terms, and the lines of these. k: first line, and on return the one behind.
   subroutine read_terms(context, last, k, terms, ok)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: last                  !< line of the card
      integer(ip), intent(inout) :: k
      type(term_t), allocatable, intent(out) :: terms(:)
      logical, intent(out) :: ok
      type(token_t) :: place
      integer(ip) :: n, filled, items, more

      place = line_item(context%deck, context%deck%lines(k), 1_ip)
      call read_count(context, context%deck%lines(k), n, ok)
      if (.not. ok) return
      ! what is announced may be any number
      allocate (terms(min(n, sum(context%deck%lines(k + 1:k + min(n, last - k))%n_tokens)/ITEMS_A_TERM)))
      filled = 0
      do while (filled < n)
         k = k + 1
         if (k > last) then
            call report_error(context%deck, place, 'E-LINES', to_text(filled)//' terms, where '//to_text(n)//' belong', &
                              expected=TERM)
            ok = .false.
            return
         end if
         items = item_count(context, context%deck%lines(k))
         more = items/ITEMS_A_TERM
         ok = more > 0 .and. more <= n - filled .and. mod(items, ITEMS_A_TERM) == 0
         if (.not. ok) then
            call report_error(context%deck, line_item(context%deck, context%deck%lines(k), 1_ip), 'E-ITEMS', to_text(items)// &
                              ' items, where '//to_text(n - filled)//trim(merge(' term is  ', ' terms are', n - filled == 1))// &
                              ' missing', expected=TERM)
            return
         end if
         call read_term_line(context, context%deck%lines(k), terms(filled + 1:filled + more), ok)
         if (.not. ok) return
         filled = filled + more
      end do
      k = k + 1
   end subroutine read_terms

   !> The line with the number of terms.
   subroutine read_count(context, line, n, ok)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line
      integer(ip), intent(out) :: n
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'number of terms, an integer > 0'
      type(token_t) :: place

      n = 0
      place = line_item(context%deck, line, 1_ip)
      ok = item_count(context, line) == 1
      if (.not. ok) then
         call report_error(context%deck, place, 'E-ITEMS', 'an equation begins with the number of its terms, alone', expected=WHAT)
         return
      end if
      call get_integer(context%deck, place, WHAT, n, ok)
      if (.not. ok .or. n > 0) return
      ok = .false.
      call report_error(context%deck, place, 'E-VALUE', to_text(n)//' terms', expected=WHAT)
   end subroutine read_count

   !> Items of a line without empty ones at its end.
   pure integer(ip) function item_count(context, line) result(n)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line

      n = line%n_tokens
      do while (n > 0)
         if (.not. is_empty_token(context%deck%tokens(line%first_token + n - 1))) return
         n = n - 1
      end do
   end function item_count

   subroutine read_term_line(context, line, terms, ok)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line
      type(term_t), intent(inout) :: terms(:)
      logical, intent(out) :: ok
      type(token_t) :: place, dof_place
      logical :: good(3)
      integer(ip) :: i

      ok = .true.
      do i = 1, size(terms, kind=ip)
         associate (item => ITEMS_A_TERM*(i - 1))
            place = line_item(context%deck, line, item + 1)
            dof_place = line_item(context%deck, line, item + 2)
            call find_nodes(context, place, terms(i)%nodes, good(1))
            call get_integer(context%deck, dof_place, WHAT_DOF, terms(i)%dof, good(2))
            call get_real(context%deck, line_item(context%deck, line, item + 3), 'coefficient, a real', terms(i)%coefficient, &
                          good(3))
            ! where there are reference nodes dof 6 is a rotation, which the node may not have
            if (all(good) .and. terms(i)%dof > PLANE_DOFS .and. &
                terms(i)%dof <= merge(LAST_DOF, LAST_DOF - 1_ip, size(context%model%rigid_bodies) == 0)) then
               call report_note(context%deck, dof_place, 'N-DOF', 'the dofs 3 to 6 do not exist in the plane; this term is 0')
               terms(i)%dof = NO_DOF
               cycle
            end if
            if (good(2)) call check_row_dof(context, dof_place, terms(i)%nodes, terms(i)%dof, good(2))
         end associate
         if (good(1)) call check_row_nodes(context, place, terms(i)%nodes, 'nodes of elements', good(1))
         ok = ok .and. all(good)
      end do
   end subroutine read_term_line

   !> Whether an equation with a node in the place of its first one asks for nothing.
   logical function is_idle_at(node, terms, context)
      integer(ip), intent(in) :: node
      type(term_t), intent(in) :: terms(:)             !< all but the first of one node each
      type(build_context_t), intent(in) :: context
      integer(ip) :: i, nodes(TERMS_A_DOF, size(terms))
      real(wp) :: vectors(2, TERMS_A_DOF, size(terms))

      is_idle_at = .false.
      if (any(terms%dof == ROTATION_DOF)) return
      do i = 1, size(terms, kind=ip)
         call row_terms(context, merge(node, terms(i)%nodes(1), i == 1), terms(i)%dof, 1.0_wp, nodes(:, i), vectors(:, :, i))
         vectors(:, :, i) = vectors(:, :, i)*terms(i)%coefficient
      end do
      is_idle_at = is_empty([nodes], reshape(vectors, [2_ip, size(nodes, kind=ip)]))
   end function is_idle_at

   pure logical function is_empty(nodes, vectors)
      integer(ip), intent(in) :: nodes(:)
      real(wp), intent(in) :: vectors(:, :)
      real(wp) :: total(2)
      integer(ip) :: i, axis

      is_empty = .true.
      do i = 1, size(nodes, kind=ip)
         total = [(sum(vectors(axis, :), mask=nodes == nodes(i)), axis=1, 2)]
         is_empty = all(total == 0.0_wp)
         if (.not. is_empty) return                      ! a long equation is rarely empty
      end do
   end function is_empty

end module atrito_build_equations
