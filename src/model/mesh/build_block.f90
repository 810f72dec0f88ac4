!> *BLOCK: a four-sided block of elements with its sets.
!>
!> Its nodes are made with those of *NODE, in the order of the deck, its elements with those of *ELEMENT, its surfaces with
!> those of *SURFACE; a context keeps the block in between.
module atrito_build_block
   use atrito_block_map, only: graded_lines, block_nodes, curved_nodes, has_arcs
   use atrito_block_joints, only: share_nodes, side_nodes
   use atrito_block_spec, only: block_spec_t, read_block_spec, count_nodes, copy_offset
   use atrito_build_context, only: build_context_t, block_t, BLOCK_SIDES, add_context_block, note_places, invalidate_block
   use atrito_build_nodes, only: put_node_set
   use atrito_diagnostics, only: report_error
   use atrito_items, only: option_text
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: add_nodes, add_block, reserve_mesh, is_hollow, elements_of_square
   use atrito_model_memory, only: fits_memory
   use atrito_growth, only: number_list_t, add_numbers, numbers_of
   use atrito_sets, only: grow_set
   use atrito_sliding_motions, only: printed_digit_error
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_block_card, place_block_elements

contains

   !> Makes the nodes and the node sets of a *BLOCK card, its copies too. A faulty block leaves the mesh undetermined, so that what
   !> names its nodes is not reported.
   subroutine read_block_card(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context  !< its mesh gets nodes and node sets
      type(block_spec_t) :: spec
      character(len=:), allocatable :: name
      type(number_list_t) :: at_side
      integer(lp) :: n_copies
      integer(ip) :: i, j, k
      logical :: ok, named

      call option_text(context%deck, context%deck%cards(i_card), 'ELSET', name, named)
      call read_block_spec(context%deck, context%deck%cards(i_card), spec, ok)
      ok = ok .and. named
      if (ok) call note_corners(spec%map%corners, context%model%mesh%digit_error)
      n_copies = product(int(spec%copies%n, lp))
      if (ok) ok = fits_memory(context%deck%cards(i_card)%place, context, count_nodes(spec), &
                               product(int(spec%n, lp))*n_copies*elements_of_square(spec%shape), spec%shape, n_copies)
      do j = 1, merge(spec%copies%n(2), 0_ip, ok)
         do i = 1, spec%copies%n(1)
            if (ok) call place_copy(name)
         end do
      end do
      if (.not. ok) then
         call invalidate_block(context, name)
      else if (spec%copies%given) then                 ! the node sets of all copies together
         j = context%block_of_card(i_card)
         call put_node_set(context, i_card, name, [(k, k=context%blocks(j)%nodes(0, 0), context%model%mesh%n_nodes)])
         do k = 1, size(BLOCK_SIDES, kind=ip)
            at_side%n = 0
            do i = j, context%n_blocks
               if (context%blocks(i)%at_side(k)) call add_numbers(at_side, side_nodes(context%blocks(i)%nodes, k))
            end do
            call put_node_set(context, i_card, name//trim(BLOCK_SIDES(k)), numbers_of(at_side))
         end do
      end if

   contains

      !> One of the copies: its nodes, its node sets, and the block that the context keeps.
      subroutine place_copy(name)
         character(len=*), intent(in) :: name             !< of the *BLOCK
         type(block_spec_t) :: shifted
         type(block_t) :: block
         integer(ip) :: k

         shifted = spec
         do k = 1, size(BLOCK_SIDES, kind=ip)             ! as many corners
            shifted%map%corners(:, k) = spec%map%corners(:, k) + copy_offset(spec%copies, i, j)
            shifted%map%centre(:, k) = spec%map%centre(:, k) + copy_offset(spec%copies, i, j)
         end do
         block%name = name
         if (spec%copies%given) then
            block%name = name//'-'//to_text(i)//'-'//to_text(j)
            block%array = name
            block%at_side = [j == 1, i == spec%copies%n(1), j == spec%copies%n(2), i == 1]
         end if
         block%card = i_card
         block%state = spec%state
         block%order = spec%order
         block%shape = spec%shape
         call place_block_nodes(i_card, shifted, context, block, ok)
         if (.not. ok) return
         call put_node_set(context, i_card, block%name, pack(block%nodes, block%nodes > 0))
         do k = 1, size(BLOCK_SIDES, kind=ip)
            call put_node_set(context, i_card, block%name//trim(BLOCK_SIDES(k)), side_nodes(block%nodes, k))
         end do
         call add_context_block(context, block)
         context%elements_to_come = context%elements_to_come + count_elements(block)
      end subroutine place_copy
   end subroutine read_block_card

   !> To what the corners are known, and so the nodes between them. With fewer than six digits they are meant as they are: a slope
   !> of two units of the fourth one is a wedge.
   pure subroutine note_corners(corners, digit_error)
      real(wp), intent(in) :: corners(:, :)            !< (2, 4) [L]
      real(wp), intent(inout) :: digit_error           !< the largest so far [L]
      real(wp), parameter :: SIX_DIGITS = 5.0e-6_wp
      real(wp) :: own

      own = printed_digit_error(corners)
      if (own <= SIX_DIGITS*maxval(abs(corners))) digit_error = max(digit_error, own)
   end subroutine note_corners

   !> The nodes of a block: places x along and across its map, less those that earlier blocks share with it and those that its
   !> elements do not have.
   subroutine place_block_nodes(i_card, spec, context, block, ok)
      integer(ip), intent(in) :: i_card
      type(block_spec_t), intent(in) :: spec
      type(build_context_t), intent(inout) :: context
      type(block_t), intent(inout) :: block
      logical, intent(out) :: ok
      real(wp), allocatable :: x(:, :)
      integer(ip) :: i, j, k, n(2), n_new

      n = spec%order*spec%n
      allocate (x(2, (n(1) + 1)*(n(2) + 1)))
      block%map = spec%map
      allocate (block%along(0:n(1)), block%across(0:n(2)))
      block%along(:) = node_lines(spec%n(1), spec%order, spec%grade(1), spec%of_halves(1), spec%along)
      block%across(:) = node_lines(spec%n(2), spec%order, spec%grade(2), spec%of_halves(2), spec%across)
      if (has_arcs(spec%map)) then
         context%model%has_arcs = .true.
         call curved_nodes(block%map, block%along, block%across, x)
      else
         call block_nodes(spec%map%corners, block%along, block%across, x)
         if (block%order == 2 .and. elements_of_square(block%shape) == 2) call straighten_diagonals(n(1) + 1, x)
      end if
      allocate (block%nodes(0:n(1), 0:n(2)), source=0_ip)
      call share_nodes(i_card, x, context, block, ok)
      if (.not. ok) return
      k = 0
      n_new = 0
      do j = 0, n(2)
         do i = 0, n(1)
            k = k + 1
            if (block%nodes(i, j) > 0 .or. is_hollow(block%shape, i, j)) cycle
            n_new = n_new + 1
            x(:, n_new) = x(:, k)
            block%nodes(i, j) = context%model%mesh%n_nodes + n_new
         end do
      end do
      ok = are_numbers_left(i_card, 'node', context%nodes%greatest, n_new, context)
      if (.not. ok .or. n_new == 0) return
      call add_nodes(context%model%mesh, context%nodes%greatest + 1, x(:, :n_new))
      call note_places(context%nodes%place, context%model%mesh%n_nodes - n_new + 1, context%model%mesh%n_nodes, -i_card)
      context%nodes%greatest = context%nodes%greatest + n_new
   end subroutine place_block_nodes

   !> So many numbers behind the greatest are in the range of an integer.
   logical function are_numbers_left(i_card, noun, greatest, n, context) result(are_left)
      integer(ip), intent(in) :: i_card
      character(len=*), intent(in) :: noun             !< 'node' or 'element'
      integer(ip), intent(in) :: greatest, n
      type(build_context_t), intent(in) :: context

      are_left = greatest <= huge(1_ip) - n
      if (.not. are_left) call report_error(context%deck, context%deck%cards(i_card)%place, 'E-ID', 'the '//noun// &
                                            ' numbers of the block, which follow the greatest so far, are too large')
   end function are_numbers_left

   !> The middle of each square of 3 x 3 nodes, which becomes that of the side that its two triangles share: where the map of the
   !> block has it, less what a square of straight sides is off its diagonal there. Triangles with a bent side have less accurate
   !> stresses.
   pure subroutine straighten_diagonals(width, x)
      integer(ip), intent(in) :: width                 !< nodes in a row, odd
      real(wp), intent(inout) :: x(:, :)               !< row by row [L]
      integer(ip) :: i, k

      do i = width, size(x, 2, kind=ip) - 2*width, 2*width
         do k = i + 2, i + width - 1, 2
            x(:, k) = x(:, k) + 0.25_wp*((x(:, k - width - 1) - x(:, k - width + 1)) + (x(:, k + width + 1) - x(:, k + width - 1)))
         end do
      end do
   end subroutine straighten_diagonals

   !> Places of the nodes along a direction, 0..1: those of the element lines and, of order 2, the middles between them.
   pure function node_lines(n, order, grade, of_halves, breaks) result(t)
      integer(ip), intent(in) :: n                     !< elements
      integer(ip), intent(in) :: order                 !< 1 or 2
      real(wp), intent(in) :: grade                    !< as of graded_lines, where there are no break points
      logical, intent(in) :: of_halves
      real(wp), allocatable, intent(in) :: breaks(:)   !< the inner lines
      real(wp) :: t(0:order*n), lines(0:n)

      if (allocated(breaks)) lines = [0.0_wp, breaks, 1.0_wp]
      if (.not. allocated(breaks)) lines = graded_lines(n, grade, of_halves)
      t(0::order) = lines
      if (order == 2) t(1::2) = 0.5_wp*(lines(:n - 1) + lines(1:))
   end function node_lines

   !> Makes the elements of a *BLOCK card, whose nodes are there, with their sets.
   subroutine place_block_elements(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context  !< its mesh gets elements and element sets
      integer(ip) :: b, first

      first = context%model%mesh%n_elements + 1
      b = context%block_of_card(i_card)
      if (b == 0) return
      do
         associate (block => context%blocks(b))
            block%first_element = context%model%mesh%n_elements + 1
            block%n_elements = count_elements(block)
            if (are_numbers_left(i_card, 'element', context%elements%greatest, block%n_elements, context)) then
               call reserve_mesh(context%model%mesh, 0_ip, context%elements_to_come)   ! with those of the blocks that follow
               call add_block(context%model%mesh, context%elements%greatest + 1, block%state, block%shape, block%nodes)
               call note_places(context%elements%place, block%first_element, context%model%mesh%n_elements, -i_card)
               context%elements%greatest = context%elements%greatest + block%n_elements
            end if
            context%elements_to_come = context%elements_to_come - block%n_elements
            call put_elements(block%name, block%first_element)
            if (b == context%n_blocks) exit
         end associate
         if (context%blocks(b + 1)%card /= i_card) exit
         b = b + 1
      end do
      if (allocated(context%blocks(b)%array)) call put_elements(context%blocks(b)%array, first)

   contains

      !> All elements from a first one on, into a set.
      subroutine put_elements(name, first)
         character(len=*), intent(in) :: name
         integer(ip), intent(in) :: first
         integer(ip) :: k

         call grow_set(context%model%element_sets, name, [(k, k=first, context%model%mesh%n_elements)])
      end subroutine put_elements

   end subroutine place_block_elements

   !> The elements of a block: one or two for each square of order x order node intervals.
   pure integer(ip) function count_elements(block) result(n)
      type(block_t), intent(in) :: block

      n = elements_of_square(block%shape)*product((int(shape(block%nodes), ip) - 1)/block%order)
   end function count_elements

end module atrito_build_block
