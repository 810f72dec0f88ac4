!> COPY of *BLOCK: columns and rows of equal blocks, each a body of its own.
module atrito_block_copies
   use atrito_coordinates, only: get_coordinate
   use atrito_deck, only: deck_t, card_t, data_line_t, token_text, line_item, is_empty_token
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: block_t
   use atrito_items, only: get_integer, has_option
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: same_name, to_text
   implicit none (type, external)
   private
   public :: copies_t, read_copies, copy_offset, name_copy

   !> How often a block stands there, and how far one is from the next.
   type :: copies_t
      logical :: given = .false.
      integer(ip) :: n(2) = 1                          !< columns and rows
      real(wp) :: step(2, 2) = 0.0_wp                  !< [L] from column to column, from row to row
   end type copies_t

contains

   !> The COPY line of a *BLOCK, if it has one.
   subroutine read_copies(deck, card, copies, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(copies_t), intent(out) :: copies
      logical, intent(out) :: ok
      integer(ip) :: i

      ok = .true.
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (.not. same_name(token_text(deck, line_item(deck, deck%lines(i), 1_ip)), 'COPY')) cycle
         copies%given = .true.
         ok = deck%lines(i)%ok
         if (ok) call read_line(deck, deck%lines(i), copies, ok)
         if (ok) ok = may_copy(deck, card, deck%lines(i))
         return
      end do
   end subroutine read_copies

   subroutine read_line(deck, line, copies, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(copies_t), intent(inout) :: copies
      logical, intent(out) :: ok
      character(len=40), parameter :: COUNTS(2) = ['number of columns, a positive integer   ', &
                                                   'number of rows, a positive integer      ']
      character(len=40), parameter :: STEPS(4) = ['dx from column to column, a real [L]    ', &
                                           'dy from row to row, a real [L]          ', 'dx from row to row, a real [L]          ', &
                                                  'dy from column to column, a real [L]    ']
      integer(ip), parameter :: ALONG(4) = [1_ip, 2_ip, 1_ip, 2_ip], OF(4) = [1_ip, 2_ip, 2_ip, 1_ip]
      integer(ip) :: k
      logical :: good

      ok = .true.
      do k = 1, 2
         call get_integer(deck, line_item(deck, line, k + 1), trim(COUNTS(k)), copies%n(k), good, keyword='BLOCK')
         ok = ok .and. good
         if (.not. good .or. copies%n(k) > 0) cycle
         ok = .false.
         call report_error(deck, line_item(deck, line, k + 1), 'E-VALUE', 'COPY of '//to_text(copies%n(k))// &
                           trim(merge(' columns', ' rows   ', k == 1)), expected=trim(COUNTS(k)), keyword='BLOCK')
      end do
      do k = 1, 4
         if (k > 2 .and. is_empty_token(line_item(deck, line, k + 3))) cycle
         call get_coordinate(deck, line_item(deck, line, k + 3), trim(STEPS(k)), copies%step(ALONG(k), OF(k)), good, 'BLOCK')
         ok = ok .and. good
      end do
      if (ok) ok = are_apart(deck, line, copies)
   end subroutine read_line

   !> Copies in one and the same place are none.
   logical function are_apart(deck, line, copies)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(copies_t), intent(in) :: copies
      integer(ip) :: k

      are_apart = .true.
      do k = 1, 2
         if (copies%n(k) == 1 .or. any(abs(copies%step(:, k)) > 0.0_wp)) cycle
         are_apart = .false.
         call report_error(deck, line_item(deck, line, k + 3), 'E-VALUE', 'the '//trim(merge('columns', 'rows   ', k == 1))// &
                           ' of COPY all stand in one place', expected='a distance that is not 0 [L]', keyword='BLOCK')
      end do
   end function are_apart

   !> Nodes cannot be shared by copies.
   logical function may_copy(deck, card, line)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(data_line_t), intent(in) :: line

      integer(ip) :: i

      may_copy = .not. has_option(deck, card, 'MERGE')
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (same_name(token_text(deck, line_item(deck, deck%lines(i), 1_ip)), 'MERGE')) may_copy = .false.
      end do
      if (.not. may_copy) call report_error(deck, line_item(deck, line, 1_ip), 'E-CONFLICT', 'COPY and MERGE= in one *BLOCK', &
                                            expected='one of them: each copy is a body of its own', keyword='BLOCK')
   end function may_copy

   !> Where copy i, j of columns and rows lies, from the first.
   pure function copy_offset(copies, i, j) result(offset)
      type(copies_t), intent(in) :: copies
      integer(ip), intent(in) :: i, j                  !< 1 ..
      real(wp) :: offset(2)                            !< [L]

      offset = real(i - 1, wp)*copies%step(:, 1) + real(j - 1, wp)*copies%step(:, 2)
   end function copy_offset

   !> The name of copy i, j, and which sides of all of them it lies at.
   pure subroutine name_copy(copies, name, i, j, block)
      type(copies_t), intent(in) :: copies
      character(len=*), intent(in) :: name             !< of the *BLOCK
      integer(ip), intent(in) :: i, j                  !< 1 ..
      type(block_t), intent(inout) :: block

      block%name = name
      if (.not. copies%given) return
      block%name = name//'-'//to_text(i)//'-'//to_text(j)
      block%array = name
      block%at_side = [j == 1, i == copies%n(1), j == copies%n(2), i == 1]
   end subroutine name_copy

end module atrito_block_copies
