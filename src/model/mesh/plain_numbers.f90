!> Nodes and elements of data lines that are numbers alone, of which there is nothing to tell: all threads read them. A line that is
!> anything else is left to who reads line by line and has the messages.
module atrito_plain_numbers
   use atrito_coordinates, only: is_coordinate
   use atrito_deck, only: deck_t, data_line_t, token_t
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, find_node
   use atrito_numbers, only: read_integer, read_real, NUMBER_OK
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: read_plain_nodes, read_plain_elements, SLICE

   !> Lines that are read at a time: their numbers need no more memory than this.
   integer(ip), parameter :: SLICE = 262144_ip

contains

   !> The numbers and coordinates of lines of *NODE, as they stand there: those of an instance are not moved.
   subroutine read_plain_nodes(deck, lines, id, x, is_plain)
      type(deck_t), intent(in) :: deck                 !< as read
      type(data_line_t), intent(in) :: lines(:)        !< of one card
      integer(ip), intent(inout) :: id(:)              !< (>= lines) in the model
      real(wp), intent(inout) :: x(:, :)               !< (2, >= lines) [L]
      logical, intent(inout) :: is_plain(:)            !< (>= lines) what is not has no numbers here
      real(wp) :: z
      integer(ip) :: i

      !$omp parallel do schedule(static) private(z) if (is_shared(size(lines, kind=ip)))
      do i = 1, size(lines, kind=ip)
         id(i) = 0
         x(:, i) = 0.0_wp
         z = 0.0_wp
         is_plain(i) = lines(i)%ok .and. (lines(i)%n_tokens == 3 .or. lines(i)%n_tokens == 4)
         if (.not. is_plain(i)) cycle
         associate (first => lines(i)%first_token)
            call read_id(deck, deck%tokens(first), id(i), is_plain(i))
            if (is_plain(i)) call read_coordinate(deck, deck%tokens(first + 1), x(1, i), is_plain(i))
            if (is_plain(i)) call read_coordinate(deck, deck%tokens(first + 2), x(2, i), is_plain(i))
            if (is_plain(i) .and. lines(i)%n_tokens == 4) call read_coordinate(deck, deck%tokens(first + 3), z, is_plain(i))
         end associate
         is_plain(i) = is_plain(i) .and. .not. abs(z) > 0.0_wp
      end do
   end subroutine read_plain_nodes

   !> The numbers of lines of *ELEMENT, and the places of their nodes, which are there and different.
   subroutine read_plain_elements(deck, mesh, lines, id, nodes, is_plain)
      type(deck_t), intent(in) :: deck                 !< as read
      type(mesh_t), intent(in) :: mesh                 !< its nodes are complete
      type(data_line_t), intent(in) :: lines(:)        !< of one card
      integer(ip), intent(inout) :: id(:)              !< (>= lines) in the model
      integer(ip), intent(inout) :: nodes(:, :)        !< (nodes of an element, >= lines)
      logical, intent(inout) :: is_plain(:)            !< (>= lines) what is not has no numbers here
      integer(ip) :: i, k, node_id

      !$omp parallel do schedule(static) private(k, node_id) if (is_shared(size(lines, kind=ip)))
      do i = 1, size(lines, kind=ip)
         id(i) = 0
         nodes(:, i) = 0
         is_plain(i) = lines(i)%ok .and. lines(i)%n_tokens == size(nodes, 1) + 1
         if (is_plain(i)) call read_id(deck, deck%tokens(lines(i)%first_token), id(i), is_plain(i))
         do k = 1, size(nodes, 1, kind=ip)
            if (is_plain(i)) call read_id(deck, deck%tokens(lines(i)%first_token + k), node_id, is_plain(i))
            if (.not. is_plain(i)) exit
            nodes(k, i) = find_node(mesh, node_id)
            is_plain(i) = nodes(k, i) > 0 .and. all(nodes(:k - 1, i) /= nodes(k, i))
         end do
      end do
   end subroutine read_plain_elements

   !> The number in the model of a node or element.
   pure subroutine read_id(deck, token, id, is_plain)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      integer(ip), intent(out) :: id
      logical, intent(out) :: is_plain
      integer :: outcome

      call read_integer(deck%sources(token%source)%text(token%first:token%last), id, outcome)
      is_plain = outcome == NUMBER_OK .and. id > 0
      if (.not. is_plain .or. .not. allocated(deck%scopes)) return
      associate (scope => deck%scopes(token%scope))
         is_plain = scope%ok .and. id <= scope%span
         if (is_plain) id = id + scope%shift
      end associate
   end subroutine read_id

   !> A coordinate that is a plain number.
   pure subroutine read_coordinate(deck, token, x, is_plain)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      real(wp), intent(out) :: x                       !< [L]
      logical, intent(out) :: is_plain
      integer :: outcome

      call read_real(deck%sources(token%source)%text(token%first:token%last), x, outcome)
      is_plain = outcome == NUMBER_OK
      if (is_plain) is_plain = is_coordinate(x)
   end subroutine read_coordinate

end module atrito_plain_numbers
