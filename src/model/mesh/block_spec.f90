!> What a *BLOCK says: its corners, sides that are arcs of circles, how it is divided, and its copies.
module atrito_block_spec
   use atrito_coordinates, only: centre_arc, get_point, get_coordinate
   use atrito_block_map, only: block_map_t, map_jacobian, has_arcs
   use atrito_build_context, only: BLOCK_SIDES
   use atrito_build_elements, only: read_element_type
   use atrito_check_shapes, only: corner_jacobians
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, token_text, line_item, is_empty_token
   use atrito_diagnostics, only: report_error
   use atrito_element_table, only: SHAPES
   use atrito_items, only: get_integer, get_real, has_option, option_integer, option_text
   use atrito_kinds, only: ip, lp, wp
   use atrito_model_memory, only: most_nodes
   use atrito_strings, only: same_name, to_text, upper_case
   implicit none (type, external)
   private
   public :: block_spec_t, read_block_spec, count_nodes, copy_offset

   integer(ip), parameter :: CORNERS = 4
   !> Corners where each side begins and ends.
   integer(ip), parameter :: FROM(4) = [1_ip, 2_ip, 4_ip, 1_ip], TO(4) = [2_ip, 3_ip, 3_ip, 4_ip]
   !> Places along and across at which a block is looked at for folds.
   integer(ip), parameter :: LOOKS = 32
   !> A Jacobian smaller than this part of the longest side squared is flat.
   real(wp), parameter :: FLAT = 1.0e-12_wp
   !> The first or the last element would be flat beyond it.
   real(wp), parameter :: LARGEST_GRADE = 1.0e12_wp

   !> COPY: columns and rows of equal blocks, each a body of its own.
   type :: copies_t
      logical :: given = .false.                       !< the card has COPY
      integer(ip) :: n(2) = 1                          !< columns and rows
      real(wp) :: step(2, 2) = 0.0_wp                  !< [L] from column to column, from row to row
   end type copies_t

   !> What a *BLOCK says.
   type :: block_spec_t
      integer(ip) :: shape = 0                         !< place in SHAPES
      integer(ip) :: state = 0                         !< place in STATES
      integer(ip) :: order = 1                         !< 1 for Q1, 2 for Q2: node intervals of an element along each direction
      integer(ip) :: n(2) = 0                          !< elements along and across
      type(block_map_t) :: map                         !< its corners and sides
      real(wp) :: grade(2) = 1.0_wp                    !< as of graded_lines
      logical :: of_halves(2) = .false.                !< as of graded_lines, along and across
      real(wp), allocatable :: along(:), across(:)     !< inner break points, 0..1; not allocated: graded
      type(copies_t) :: copies                         !< by the data line COPY
   end type block_spec_t

contains

   !> What a *BLOCK card asks for. ok: it has no errors; all of them are reported.
   subroutine read_block_spec(deck, card, spec, ok)
      type(deck_t), intent(in) :: deck           !< as read; messages name its lines
      type(card_t), intent(in) :: card           !< *BLOCK
      type(block_spec_t), intent(out) :: spec    !< of no use where not ok
      logical, intent(out) :: ok                 !< no error was reported
      character(len=*), parameter :: WHAT_CORNER(2) = 'coordinate of a corner, a real [L]'
      integer(ip) :: i, n, corner_line(CORNERS)
      logical :: is_good(4), is_counted(2), has_corners

      call read_element_type(deck, card, spec%shape, spec%state, is_good(1))
      spec%order = SHAPES(spec%shape)%degree
      call read_count(deck, card, 'NX', spec%n(1), is_counted(1))
      call read_count(deck, card, 'NY', spec%n(2), is_counted(2))
      is_good(2:) = .true.
      n = 0
      do i = card%first_line, card%first_line + card%n_lines - 1
         select case (first_word(deck, i))
         case ('GRADE')
            if (all(is_counted)) call read_grade(deck, deck%lines(i), spec, is_good(2))
         case ('X')
            if (all(is_counted)) call read_breaks(deck, deck%lines(i), spec%n(1), spec%grade(1), spec%along, is_good(2))
         case ('Y')
            if (all(is_counted)) call read_breaks(deck, deck%lines(i), spec%n(2), spec%grade(2), spec%across, is_good(2))
         case ('COPY')
            if (.not. spec%copies%given) call read_copies(deck, card, deck%lines(i), spec%copies, is_good(3))
         case ('ARC', 'MERGE')                         ! read when the corners are known, and by atrito_block_joints
         case default
            if (n == CORNERS) cycle
            n = n + 1
            corner_line(n) = i
            is_good(4) = is_good(4) .and. deck%lines(i)%ok
            if (deck%lines(i)%ok) call get_point(deck, deck%lines(i), 1_ip, WHAT_CORNER, spec%map%corners(:, n), is_good(4))
         end select
      end do
      has_corners = is_good(4) .and. n == CORNERS
      is_good(4) = has_corners
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (has_corners .and. first_word(deck, i) == 'ARC') call read_arc(deck, deck%lines(i), spec%map, is_good(4))
      end do
      if (is_good(4)) call check_map(deck, card, corner_line, spec%map, is_good(4))
      ok = all(is_good) .and. all(is_counted)
      if (.not. (all(is_counted) .and. is_good(3))) return
      if (count_nodes(spec) <= most_nodes()) return
      ok = .false.
      call report_error(deck, card%place, 'E-VALUE', 'a block of more than '//to_text(most_nodes())//' nodes', &
                        expected='fewer elements NX, NY, or fewer copies')
   end subroutine read_block_spec

   !> Nodes of a block with all of its copies; huge of a default integer where there would be more.
   pure integer(lp) function count_nodes(spec) result(n)
      type(block_spec_t), intent(in) :: spec     !< order, elements and copies are used
      integer(lp) :: factors(4)

      factors = [int(spec%order, lp)*int(spec%n, lp) + 1_lp, int(spec%copies%n, lp)]
      n = huge(1_ip)
      if (product(real(factors, wp)) < real(n, wp)) n = product(factors)
   end function count_nodes

   !> The word, in capitals, with which a line begins: that of a corner begins with a number.
   pure function first_word(deck, line) result(word)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: line                  !< place in deck%lines
      character(len=:), allocatable :: word

      word = upper_case(token_text(deck, line_item(deck, deck%lines(line), 1_ip)))
   end function first_word

   !> NX or NY.
   subroutine read_count(deck, card, name, n, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: name
      integer(ip), intent(out) :: n
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'number of elements, a positive integer'
      character(len=:), allocatable :: text
      type(token_t) :: place
      logical :: found

      n = 0
      call option_integer(deck, card, name, WHAT, n, ok)
      if (.not. ok .or. n > 0) return
      ok = .false.
      call option_text(deck, card, name, text, found, place)
      call report_error(deck, place, 'E-VALUE', name//' = '//to_text(n), expected=WHAT)
   end subroutine read_count

   !> ARC, side, xc, yc.
   subroutine read_arc(deck, line, map, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(block_map_t), intent(inout) :: map
      logical, intent(inout) :: ok                     !< false where there is an error
      character(len=*), parameter :: WHAT(2) = 'coordinate of the centre, a real [L]'
      character(len=:), allocatable :: name
      integer(ip) :: k, side
      logical :: good

      name = token_text(deck, line_item(deck, line, 2_ip))
      side = findloc([(same_name('-'//name, trim(BLOCK_SIDES(k))), k=1, 4)], .true., dim=1, kind=ip)
      if (.not. line%ok .or. side == 0) then           ! the reader has reported it
         ok = .false.
      else if (map%is_arc(side)) then
         ok = .false.
         call report_error(deck, line_item(deck, line, 2_ip), 'E-TWICE', name//' is an arc already', expected='one ARC a side')
      else
         good = .true.
         call get_point(deck, line, 3_ip, WHAT, map%centre(:, side), good)
         if (good) call centre_arc(deck, [line_item(deck, line, 3_ip), line_item(deck, line, 2_ip)], map%corners(:, FROM(side)), &
                                   map%corners(:, TO(side)), map%centre(:, side), good)
         map%is_arc(side) = .true.
         ok = ok .and. good
      end if
   end subroutine read_arc

   !> The map of a block is one to one where its Jacobian is positive. With straight sides it is least at a corner: they make a
   !> convex quadrilateral, counter-clockwise. With arcs it is looked at in a grid that has all of the sides. An angle of 180
   !> degrees at a corner is none.
   subroutine check_map(deck, card, corner_line, map, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      integer(ip), intent(in) :: corner_line(CORNERS)  !< places in deck%lines
      type(block_map_t), intent(in) :: map
      logical, intent(out) :: ok
      character(len=*), parameter :: CLOCKWISE = 'the corners of the block run clockwise'
      real(wp) :: at_corner(CORNERS), jacobian(0:LOOKS, 0:LOOKS), longest
      character(len=:), allocatable :: text
      integer(ip) :: i, j, place(2)

      if (.not. has_arcs(map)) then
         at_corner = corner_jacobians(map%corners)
         ok = all(at_corner > FLAT)
         i = minloc(at_corner, dim=1, kind=ip)
         if (all(at_corner < 0.0_wp)) then
            call report_error(deck, line_item(deck, deck%lines(corner_line(1)), 1_ip), 'E-SHAPE', CLOCKWISE, &
                              expected='four corners counter-clockwise')
         else if (.not. ok) then
            call report_error(deck, line_item(deck, deck%lines(corner_line(i)), 1_ip), 'E-SHAPE', &
                              'the block has no angle between 0 and 180 degrees at its corner '//to_text(i), &
                              expected='four corners counter-clockwise of a convex quadrilateral')
         end if
         return
      end if
      longest = maxval(norm2(map%corners(:, TO) - map%corners(:, FROM), dim=1))
      do j = 0, LOOKS
         do i = 0, LOOKS
            jacobian(i, j) = map_jacobian(map, real(i, wp)/real(LOOKS, wp), real(j, wp)/real(LOOKS, wp))
         end do
      end do
      ok = all(jacobian > FLAT*longest**2)
      if (ok) return
      place = nint(100.0_wp*real(minloc(jacobian) - 1, wp)/real(LOOKS, wp), ip)
      text = 'the block is folded, or has an angle of 180 degrees or more: worst at '//to_text(place(1))//' % along BOTTOM and '// &
             to_text(place(2))//' % along LEFT'
      if (all(jacobian < 0.0_wp)) text = CLOCKWISE
      call report_error(deck, card%place, 'E-SHAPE', text, expected='four corners counter-clockwise, and arcs that '// &
                        'do not cross another side; several blocks make other shapes')
   end subroutine check_map

   !> GRADE, along, across, words for both.
   subroutine read_grade(deck, line, spec, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(block_spec_t), intent(inout) :: spec
      logical, intent(inout) :: ok                     !< false where there is an error
      character(len=*), parameter :: WHAT = 'last over first element length, a real, 1e-12 to 1e12 [-]', &
                                     LONGEST = 'longest over shortest element length, a real, 1 to 1e12 [-]'
      character(len=:), allocatable :: word
      integer(ip) :: k
      logical :: good

      ok = ok .and. line%ok
      do k = 1, merge(2_ip, 0_ip, line%ok)
         call get_real(deck, line_item(deck, line, k + 1), WHAT, spec%grade(k), good, 1.0_wp)
         ok = ok .and. good
         if (.not. good) cycle
         word = upper_case(token_text(deck, line_item(deck, line, k + 3)))
         spec%of_halves(k) = len(word) > 0
         good = spec%grade(k) >= merge(1.0_wp, 1/LARGEST_GRADE, len(word) > 0) .and. spec%grade(k) <= LARGEST_GRADE
         if (.not. good) then
            ok = .false.
            if (len(word) > 0) word = ' towards '//word
            call report_error(deck, line_item(deck, line, k + 1), 'E-VALUE', 'a grading of '//to_text(spec%grade(k))//word, &
                              expected=trim(merge(WHAT//repeat(' ', len(LONGEST) - len(WHAT)), LONGEST, len(word) == 0)))
         else if (word == 'MIDDLE') then
            spec%grade(k) = 1/spec%grade(k)
         end if
      end do
      if (allocated(spec%along) .and. abs(spec%grade(1) - 1) > 0 .or. allocated(spec%across) .and. abs(spec%grade(2) - 1) > 0) then
         ok = .false.
         call report_error(deck, line_item(deck, line, 1_ip), 'E-CONFLICT', 'GRADE and break points for one direction', &
                           expected='one of them')
      end if
   end subroutine read_grade

   !> X or Y, inner break points.
   subroutine read_breaks(deck, line, n, grade, breaks, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: n                     !< elements
      real(wp), intent(in) :: grade
      real(wp), allocatable, intent(inout) :: breaks(:)
      logical, intent(inout) :: ok                     !< false where there is an error
      character(len=*), parameter :: WHAT = 'rising inner break points between 0 and 1 [-]'
      real(wp) :: lower
      integer(ip) :: i
      logical :: is_second, good

      ok = ok .and. line%ok
      if (.not. line%ok) return
      is_second = allocated(breaks) .or. abs(grade - 1) > 0
      if (is_second) call report_error(deck, line_item(deck, line, 1_ip), 'E-CONFLICT', &
                                       'this direction has its break points already', expected='GRADE or break points, once')
      if (line%n_tokens /= n) call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', to_text(line%n_tokens - 1)// &
                                                ' inner break points for '//to_text(n)//' elements', expected=to_text(n - 1)// &
                                                ' '//WHAT)
      ok = ok .and. .not. is_second .and. line%n_tokens == n
      if (is_second .or. line%n_tokens /= n) return
      allocate (breaks(n - 1))
      lower = 0.0_wp
      do i = 1, n - 1
         call get_real(deck, line_item(deck, line, i + 1), WHAT, breaks(i), good)
         ok = ok .and. good
         if (.not. good) cycle
         if (breaks(i) <= lower .or. breaks(i) >= 1.0_wp) then
            ok = .false.
            call report_error(deck, line_item(deck, line, i + 1), 'E-VALUE', to_text(breaks(i))//' does not lie between '// &
                              to_text(lower)//' and 1', expected=WHAT)
         end if
         lower = breaks(i)
      end do
   end subroutine read_breaks

   !> COPY, columns, rows, dx, dy[, dx of rows, dy of columns]. Copies in one and the same place are none, and nodes cannot be
   !> shared by copies.
   subroutine read_copies(deck, card, line, copies, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(data_line_t), intent(in) :: line
      type(copies_t), intent(inout) :: copies
      logical, intent(out) :: ok
      character(len=7), parameter :: NOUN(2) = ['columns', 'rows   ']
      character(len=*), parameter :: STEPS(4) = ['dx from column to column, a real [L]', 'dy from row to row, a real [L]      ', &
                                                 'dx from row to row, a real [L]      ', 'dy from column to column, a real [L]']
      integer(ip), parameter :: ALONG(4) = [1_ip, 2_ip, 1_ip, 2_ip], OF(4) = [1_ip, 2_ip, 2_ip, 1_ip]
      character(len=:), allocatable :: what
      integer(ip) :: i, k
      logical :: good, has_merge

      copies%given = .true.
      ok = line%ok
      if (.not. ok) return
      do k = 1, 2
         what = 'number of '//trim(NOUN(k))//', a positive integer'
         call get_integer(deck, line_item(deck, line, k + 1), what, copies%n(k), good)
         if (good .and. copies%n(k) <= 0) call report_error(deck, line_item(deck, line, k + 1), 'E-VALUE', 'COPY of '// &
                                                            to_text(copies%n(k))//' '//trim(NOUN(k)), expected=what)
         ok = ok .and. good .and. copies%n(k) > 0
      end do
      do k = 1, 4
         if (k > 2 .and. is_empty_token(line_item(deck, line, k + 3))) cycle
         call get_coordinate(deck, line_item(deck, line, k + 3), trim(STEPS(k)), copies%step(ALONG(k), OF(k)), good)
         ok = ok .and. good
      end do
      if (.not. ok) return
      do k = 1, 2
         if (copies%n(k) == 1 .or. any(abs(copies%step(:, k)) > 0.0_wp)) cycle
         ok = .false.
         call report_error(deck, line_item(deck, line, k + 3), 'E-VALUE', 'the '//trim(NOUN(k))// &
                           ' of COPY all stand in one place', expected='a distance that is not 0 [L]')
      end do
      if (.not. ok) return
      has_merge = has_option(deck, card, 'MERGE')
      do i = card%first_line, card%first_line + card%n_lines - 1
         has_merge = has_merge .or. first_word(deck, i) == 'MERGE'
      end do
      ok = .not. has_merge
      if (.not. ok) call report_error(deck, line_item(deck, line, 1_ip), 'E-CONFLICT', 'COPY and MERGE= in one *BLOCK', &
                                      expected='one of them: each copy is a body of its own')
   end subroutine read_copies

   !> Where copy i, j of columns and rows lies, from the first.
   pure function copy_offset(copies, i, j) result(offset)
      type(copies_t), intent(in) :: copies             !< step from one to the next is used
      integer(ip), intent(in) :: i, j                  !< 1 ..
      real(wp) :: offset(2)                            !< [L]

      offset = real(i - 1, wp)*copies%step(:, 1) + real(j - 1, wp)*copies%step(:, 2)
   end function copy_offset

end module atrito_block_spec
