!> ARC of *BLOCK: sides that are arcs of circles.
module atrito_block_arcs
   use atrito_arcs, only: centre_arc
   use atrito_block_map, only: block_map_t, map_jacobian, has_arcs
   use atrito_build_context, only: BLOCK_SIDES
   use atrito_coordinates, only: get_coordinate
   use atrito_deck, only: deck_t, card_t, data_line_t, token_text, line_item
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: same_name, to_text
   implicit none (type, external)
   private
   public :: read_arcs, is_unfolded

   !> Places along and across at which a block is looked at for folds.
   integer(ip), parameter :: LOOKS = 32
   !> A Jacobian smaller than this part of the longest side squared is flat.
   real(wp), parameter :: FLAT = 1.0e-12_wp
   !> Corners where each side begins and ends.
   integer(ip), parameter :: FROM(4) = [1_ip, 2_ip, 4_ip, 1_ip], TO(4) = [2_ip, 3_ip, 3_ip, 4_ip]

contains

   !> The ARC lines of a *BLOCK whose corners are known.
   subroutine read_arcs(deck, card, map, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(block_map_t), intent(inout) :: map
      logical, intent(out) :: ok
      integer(ip) :: i
      logical :: good

      ok = .true.
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (.not. same_name(token_text(deck, line_item(deck, deck%lines(i), 1_ip)), 'ARC')) cycle
         good = deck%lines(i)%ok
         if (good) call read_arc(deck, deck%lines(i), map, good)
         ok = ok .and. good
      end do
   end subroutine read_arcs

   !> ARC, side, xc, yc.
   subroutine read_arc(deck, line, map, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(block_map_t), intent(inout) :: map
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'coordinate of the centre, a real [L]'
      character(len=:), allocatable :: name
      integer(ip) :: k, side
      logical :: good

      name = token_text(deck, line_item(deck, line, 2_ip))
      side = findloc([(same_name('-'//name, trim(BLOCK_SIDES(k))), k=1, 4)], .true., dim=1, kind=ip)
      ok = side > 0
      if (.not. ok) return                              ! the reader has told it
      ok = .not. map%is_arc(side)
      if (.not. ok) then
         call report_error(deck, line_item(deck, line, 2_ip), 'E-TWICE', name//' is an arc already', &
                           expected='one ARC a side', keyword='BLOCK')
         return
      end if
      do k = 1, 2
         call get_coordinate(deck, line_item(deck, line, k + 2_ip), WHAT, map%centre(k, side), good, 'BLOCK')
         ok = ok .and. good
      end do
      if (ok) call centre_arc(deck, [line_item(deck, line, 3_ip), line_item(deck, line, 2_ip)], map%corners(:, FROM(side)), &
                              map%corners(:, TO(side)), map%centre(:, side), ok, 'BLOCK')
      map%is_arc(side) = .true.
   end subroutine read_arc

   !> The map of a block with arcs is one to one: its Jacobian is looked at in a grid that has all of its sides. An angle of 180
   !> degrees at a corner is none.
   logical function is_unfolded(deck, card, map)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(block_map_t), intent(in) :: map
      real(wp) :: jacobian(0:LOOKS, 0:LOOKS), longest
      character(len=:), allocatable :: text
      integer(ip) :: i, j, place(2)

      is_unfolded = .true.
      if (.not. has_arcs(map)) return
      longest = maxval([(norm2(map%corners(:, TO(i)) - map%corners(:, FROM(i))), i=1, 4)])
      do j = 0, LOOKS
         do i = 0, LOOKS
            jacobian(i, j) = map_jacobian(map, real(i, wp)/real(LOOKS, wp), real(j, wp)/real(LOOKS, wp))
         end do
      end do
      is_unfolded = all(jacobian > FLAT*longest**2)
      if (is_unfolded) return
      place = int(minloc(jacobian), ip) - 1_ip
      if (all(jacobian < 0.0_wp)) then
         text = 'the corners of the block run clockwise'
      else
         text = 'the block is folded, or has an angle of 180 degrees or more: worst at '//part_text(place(1), LOOKS)// &
                ' along BOTTOM and '//part_text(place(2), LOOKS)//' along LEFT'
      end if
      call report_error(deck, card%place, 'E-SHAPE', text, expected='four corners counter-clockwise, and arcs that '// &
                        'do not cross another side; several blocks make other shapes', keyword='BLOCK')
   end function is_unfolded

   !> A part of a length in percent.
   pure function part_text(part, whole) result(text)
      integer(ip), intent(in) :: part, whole
      character(len=:), allocatable :: text

      text = to_text(nint(100.0_wp*real(part, wp)/real(whole, wp), ip))//' %'
   end function part_text

end module atrito_block_arcs
