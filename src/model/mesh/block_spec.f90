!> What a *BLOCK says: its corners, how it is divided, and its copies.
module atrito_block_spec
   use atrito_block_arcs, only: read_arcs, is_unfolded
   use atrito_block_copies, only: copies_t, read_copies
   use atrito_block_map, only: block_map_t, has_arcs
   use atrito_build_elements, only: read_element_type
   use atrito_coordinates, only: get_coordinate
   use atrito_deck, only: deck_t, card_t, data_line_t, option_t, token_text, line_item
   use atrito_diagnostics, only: report_error
   use atrito_items, only: get_real, option_integer, find_option
   use atrito_kinds, only: ip, lp, wp
   use atrito_element_table, only: SHAPES
   use atrito_model_memory, only: most_nodes
   use atrito_strings, only: same_name, to_text
   implicit none (type, external)
   private
   public :: block_spec_t, read_block_spec, count_nodes, CORNERS

   integer(ip), parameter :: CORNERS = 4
   !> A corner whose Jacobian is smaller than this part of the longest side squared is flat.
   real(wp), parameter :: FLAT = 1.0e-12_wp
   !> The first or the last element would be flat beyond it.
   real(wp), parameter :: LARGEST_GRADE = 1.0e12_wp

   !> Words of the lines that divide a direction.
   character(len=5), parameter :: DIVISIONS(3) = ['GRADE', 'X    ', 'Y    ']
   !> Of the other lines that are no corners.
   character(len=5), parameter :: OTHERS(3) = ['COPY ', 'ARC  ', 'MERGE']

   !> What a *BLOCK says.
   type :: block_spec_t
      integer(ip) :: shape = 0                         !< place in SHAPES
      integer(ip) :: state = 0
      integer(ip) :: order = 1                         !< 1 for Q1, 2 for Q2: node intervals of an element along each direction
      integer(ip) :: n(2) = 0                          !< elements along and across
      type(block_map_t) :: map                         !< its corners and sides
      real(wp) :: grade(2) = 1.0_wp
      real(wp), allocatable :: along(:), across(:)     !< inner break points, 0..1; not allocated: graded
      type(copies_t) :: copies
   end type block_spec_t

contains

   !> What a *BLOCK card asks for. ok: it has no errors; all of them are reported.
   subroutine read_block_spec(deck, card, spec, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(block_spec_t), intent(out) :: spec
      logical, intent(out) :: ok
      logical :: good(6)

      call read_element_type(deck, card, spec%shape, spec%state, good(1))
      spec%order = SHAPES(spec%shape)%degree
      call read_count(deck, card, 'NX', spec%n(1), good(2))
      call read_count(deck, card, 'NY', spec%n(2), good(3))
      call read_corners(deck, card, spec, good(4))
      call read_divisions(deck, card, all(good(2:3)), spec, good(5))
      call read_copies(deck, card, spec%copies, good(6))
      ok = all(good)
      if (.not. all(good([2, 3, 6]))) return
      if (count_nodes(spec) <= most_nodes()) return
      ok = .false.
      call report_error(deck, card%place, 'E-VALUE', 'a block of more than '//to_text(most_nodes())//' nodes', &
                        expected='fewer elements NX, NY, or fewer copies', keyword='BLOCK')
   end subroutine read_block_spec

   !> Nodes of a block with all of its copies; huge of a default integer where there would be more.
   pure integer(lp) function count_nodes(spec) result(n)
      type(block_spec_t), intent(in) :: spec
      integer(lp) :: factors(4)

      factors = [int(spec%order, lp)*int(spec%n, lp) + 1_lp, int(spec%copies%n, lp)]
      n = huge(1_ip)
      if (product(real(factors, wp)) < real(n, wp)) n = product(factors)
   end function count_nodes

   pure logical function has_word(deck, line, words)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      character(len=*), intent(in) :: words(:)
      character(len=:), allocatable :: word
      integer :: i

      word = token_text(deck, line_item(deck, line, 1_ip))
      has_word = any([(same_name(word, words(i)), i=1, size(words))])
   end function has_word

   subroutine read_count(deck, card, name, n, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: name             !< NX or NY
      integer(ip), intent(out) :: n
      logical, intent(out) :: ok
      type(option_t) :: option
      character(len=*), parameter :: WHAT = 'number of elements, a positive integer'
      logical :: found

      n = 0
      call option_integer(deck, card, name, WHAT, n, ok)
      if (.not. ok .or. n > 0) return
      ok = .false.
      call find_option(deck, card, name, option, found)
      call report_error(deck, option%value, 'E-VALUE', name//' = '//to_text(n), expected=WHAT, keyword='BLOCK')
   end subroutine read_count

   subroutine read_corners(deck, card, spec, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(block_spec_t), intent(inout) :: spec
      logical, intent(out) :: ok
      integer(ip) :: i, k, n, lines(CORNERS)
      logical :: good

      ok = .true.
      n = 0
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (has_word(deck, deck%lines(i), [DIVISIONS, OTHERS]) .or. n == CORNERS) cycle
         n = n + 1
         lines(n) = i
         ok = ok .and. deck%lines(i)%ok
         if (.not. deck%lines(i)%ok) cycle
         do k = 1, 2
            call get_coordinate(deck, line_item(deck, deck%lines(i), k), 'coordinate of a corner, a real [L]', &
                                spec%map%corners(k, n), good, 'BLOCK')
            ok = ok .and. good
         end do
      end do
      ok = ok .and. n == CORNERS
      if (ok) call read_arcs(deck, card, spec%map, ok)
      if (.not. ok) return
      if (has_arcs(spec%map)) then
         ok = is_unfolded(deck, card, spec%map)
      else
         ok = is_convex(deck, lines, spec%map%corners)
      end if
   end subroutine read_corners

   subroutine read_divisions(deck, card, counted, spec, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      logical, intent(in) :: counted                   !< NX and NY are known
      type(block_spec_t), intent(inout) :: spec
      logical, intent(out) :: ok
      integer(ip) :: i
      logical :: good

      ok = .true.
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (.not. counted .or. .not. has_word(deck, deck%lines(i), DIVISIONS)) cycle
         call read_division(deck, deck%lines(i), spec, good)
         ok = ok .and. good
      end do
   end subroutine read_divisions

   logical function is_convex(deck, lines, x)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: lines(CORNERS)        !< places in deck%lines
      real(wp), intent(in) :: x(2, CORNERS)
      real(wp) :: jacobian(CORNERS), a(2), b(2), longest
      integer(ip) :: i

      longest = maxval([(norm2(x(:, modulo(i, CORNERS) + 1) - x(:, i)), i=1, CORNERS)])
      longest = max(longest, tiny(longest))
      do i = 1, CORNERS                                ! over the longest: products of sides are numbers, however small
         a = (x(:, modulo(i, CORNERS) + 1) - x(:, i))/longest
         b = (x(:, modulo(i - 2, CORNERS) + 1) - x(:, i))/longest
         jacobian(i) = a(1)*b(2) - a(2)*b(1)
      end do
      is_convex = all(jacobian > FLAT)
      if (is_convex) return
      i = minloc(jacobian, dim=1, kind=ip)
      if (all(jacobian < 0.0_wp)) then
         call report_error(deck, line_item(deck, deck%lines(lines(1)), 1_ip), 'E-SHAPE', &
                           'the corners of the block run clockwise', expected='four corners counter-clockwise', keyword='BLOCK')
      else
         call report_error(deck, line_item(deck, deck%lines(lines(i)), 1_ip), 'E-SHAPE', &
                           'the block has no angle between 0 and 180 degrees at its corner '//to_text(i), &
                           expected='four corners counter-clockwise of a convex quadrilateral', keyword='BLOCK')
      end if
   end function is_convex

   subroutine read_division(deck, line, spec, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(block_spec_t), intent(inout) :: spec
      logical, intent(out) :: ok
      character(len=:), allocatable :: word

      ok = line%ok
      if (.not. ok) return
      word = token_text(deck, line_item(deck, line, 1_ip))
      if (same_name(word, 'GRADE')) then
         call read_grade(deck, line, spec, ok)
      else if (same_name(word, 'X')) then
         call read_breaks(deck, line, spec%n(1), spec%grade(1), spec%along, ok)
      else
         call read_breaks(deck, line, spec%n(2), spec%grade(2), spec%across, ok)
      end if
   end subroutine read_division

   subroutine read_grade(deck, line, spec, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(block_spec_t), intent(inout) :: spec
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'last over first element length, a real, 1e-12 to 1e12 [-]'
      integer(ip) :: k
      logical :: good

      ok = .true.
      do k = 1, 2
         call get_real(deck, line_item(deck, line, k + 1), WHAT, spec%grade(k), good, 1.0_wp, 'BLOCK')
         ok = ok .and. good
         if (.not. good .or. (spec%grade(k) >= 1/LARGEST_GRADE .and. spec%grade(k) <= LARGEST_GRADE)) cycle
         ok = .false.
         call report_error(deck, line_item(deck, line, k + 1), 'E-VALUE', 'a grading of '//to_text(spec%grade(k)), &
                           expected=WHAT, keyword='BLOCK')
      end do
      if (allocated(spec%along) .and. abs(spec%grade(1) - 1) > 0 .or. allocated(spec%across) .and. abs(spec%grade(2) - 1) > 0) then
         ok = .false.
         call report_error(deck, line_item(deck, line, 1_ip), 'E-CONFLICT', 'GRADE and break points for one direction', &
                           expected='one of them', keyword='BLOCK')
      end if
   end subroutine read_grade

   subroutine read_breaks(deck, line, n, grade, breaks, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: n                     !< elements
      real(wp), intent(in) :: grade
      real(wp), allocatable, intent(inout) :: breaks(:)
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'rising inner break points between 0 and 1 [-]'
      real(wp) :: lower
      integer(ip) :: i
      logical :: good

      ok = .not. allocated(breaks) .and. .not. abs(grade - 1) > 0
      if (.not. ok) call report_error(deck, line_item(deck, line, 1_ip), 'E-CONFLICT', &
                                      'this direction has its break points already', expected='GRADE or break points, once', &
                                      keyword='BLOCK')
      if (line%n_tokens - 1 /= n - 1) then
         ok = .false.
         call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', to_text(line%n_tokens - 1)// &
                           ' inner break points for '//to_text(n)//' elements', expected=to_text(n - 1)//' '//WHAT, &
                           keyword='BLOCK')
      end if
      if (.not. ok) return
      allocate (breaks(n - 1))
      lower = 0.0_wp
      do i = 1, n - 1
         call get_real(deck, line_item(deck, line, i + 1), WHAT, breaks(i), good, keyword='BLOCK')
         ok = ok .and. good
         if (.not. good) cycle
         if (breaks(i) <= lower .or. breaks(i) >= 1.0_wp) then
            ok = .false.
            call report_error(deck, line_item(deck, line, i + 1), 'E-VALUE', to_text(breaks(i))//' does not lie between '// &
                              to_text(lower)//' and 1', expected=WHAT, keyword='BLOCK')
         end if
         lower = breaks(i)
      end do
   end subroutine read_breaks

end module atrito_block_spec
