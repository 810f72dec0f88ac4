!> Contact rows of bodies that turn together.
!>
!> The relative displacement of a point is that of the slave's place x_s less that of the master's place x_m. Where the two are
!> apart by d = x_s - x_m, by a gap or an overlap along the normal n, or along the tangent T where what the point faces was looked
!> for along another normal, a rotation w of both bodies makes a displacement w perp(d), though neither moves against the other:
!> sides that stick would hold a rotation that is free, and forces upon both sides leave a moment. So the rotation of the master's
!> face is taken out of the rows: with its nodes k at s_k = T . x_k along the face,
!>
!>    w = - sum_k e_k n . u_k,   e_k = (s_k - mean of s)/sum_i (s_i - mean of s)^2,
!>
!>    u_n = n . (u_s - u_m) + w (T . d),   u_T = T . (u_s - u_m) - w (n . d),
!>
!> which vanish for every rigid motion that both bodies have together. Of the forces it is the couple that balances their moment. A
!> point that faces a node has those that the points beside it face: which of the two faces there it was found on is round-off.
!>
!> It is done where a round side meets a round or a straight one along which it may slide or roll (atrito_sliding_motions). Straight
!> sides face each other over gaps that are as small as displacements, and have their rows as they are. So have bodies that supports
!> keep from turning: the supports take the moment (W-SUMS tells of it).
module atrito_turning_rows
   use atrito_assembly, only: fem_t
   use atrito_bilateral_rows, only: bilateral_rows_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_growth, only: make_room, resize
   use atrito_kinds, only: ip, wp
   use atrito_points, only: contact_points_t
   use atrito_sliding_bodies, only: motions_left
   use atrito_turned_points, only: first_of_master
   implicit none (type, external)
   private
   public :: balance_rows

   real(wp), parameter :: TOUCHING = 1.0e-12_wp     !< of the coordinates: a distance that is round-off
   real(wp), parameter :: SHORT = 1.0e-6_wp         !< of the length of a point: nodes at one place tell no rotation
   real(wp), parameter :: AT_NODE = 1.0e-2_wp       !< coefficient of the other nodes of a face, of a point that faces one of them
   real(wp), parameter :: NEXT = 1.1_wp             !< sums of the lengths of points that are beside each other
   real(wp), parameter :: FAR = 3.0_wp              !< lengths of a point, beyond which linear theory closes no gap
   integer(ip), parameter :: MOST_NODES = 64_ip     !< of a master at one point and those beside it

   !> What is n's of nodes in the rows of points, point by point.
   type :: turns_t
      integer(ip) :: n = 0 !< entries that are used
      integer(ip), allocatable :: row(:), node(:)   !< (n) of the points; node that it acts on
      real(wp), allocatable :: turn(:, :)           !< (2, n) in the normal and in the tangential row
   end type turns_t

contains

   !> Takes the rotation of the master out of the rows of points of curved sides between bodies that may turn: of pairs
   !> with friction, since without it nothing resists a slip that is none, and both of whose bodies have a rotation
   !> among the motions that supports leave.
   subroutine balance_rows(rubs, points, fem, bilateral, rows)
      logical, intent(in) :: rubs(:)                !< (pairs) with friction
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(fem_t), intent(in) :: fem                  !< bodies with their rigid modes
      type(bilateral_rows_t), intent(in) :: bilateral !< supports along their own directions
      type(contact_rows_t), intent(inout) :: rows   !< of all pairs
      real(wp), parameter :: NO_TURN = 1.0e-9_wp    ! of a motion
      logical :: may_turn(fem%bodies%n)
      type(turns_t) :: turns
      integer(ip) :: node(MOST_NODES), i, j, m, n
      real(wp) :: turn(2, MOST_NODES)

      may_turn = .false.
      do i = 1, merge(fem%bodies%n, 0_ip, any(rubs))
         if (fem%bodies%list(i)%is_rigid) cycle
         associate (left => motions_left(fem, bilateral, i))
            may_turn(i) = any(abs(left(3, :)) > NO_TURN)
         end associate
      end do
      if (.not. any(may_turn)) return
      allocate (turns%turn(2, 0))
      m = 0
      do i = 1, size(points, kind=ip)
         do j = 1, points(i)%n
            m = m + 1
            associate (sliding => points(i)%sliding)       ! one of the sides is round, and both slide along themselves
               if (points(i)%rigid .or. .not. (rubs(i) .and. sliding%exists)) cycle
               if (.not. (sliding%is_round .or. sliding%meets_round)) cycle
            end associate
            call find_turn(points(i), j, fem, may_turn, rows%normal(:, m), node, turn, n)
            if (n == 0) cycle
            call make_room(turns%row, turns%n, turns%n + n)
            call make_room(turns%node, turns%n, turns%n + n)
            if (turns%n + n > size(turns%turn, 2)) call resize(turns%turn, turns%n, size(turns%row, kind=ip))
            turns%row(turns%n + 1:turns%n + n) = m
            turns%node(turns%n + 1:turns%n + n) = node(:n)
            turns%turn(:, turns%n + 1:turns%n + n) = turn(:, :n)
            turns%n = turns%n + n
         end do
      end do
      if (turns%n > 0) call add_turns(turns, rows)
   end subroutine balance_rows

   !> The nodes that tell the rotation of the master at a point, and what is n's in its rows; n = 0: nothing is.
   !>
   !> d is the sum of all coefficients times places, x_s - x_m, since these are 1 and -1 in all. With s_k along the face
   !> less their mean the rotation is w = -sum s_k n . u_k/sum s_k^2, so the normal row gets w (T . d) and the
   !> tangential one -w (n . d).
   pure subroutine find_turn(points, j, fem, may_turn, normal, node, turn, n)
      type(contact_points_t), intent(in) :: points  !< of the pair
      integer(ip), intent(in) :: j                  !< point
      type(fem_t), intent(in) :: fem
      logical, intent(in) :: may_turn(:)            !< (bodies)
      real(wp), intent(in) :: normal(2)             !< of the point
      integer(ip), intent(out) :: node(:)           !< the first n are in use
      real(wp), intent(out) :: turn(:, :)           !< (2, n) [1]
      integer(ip), intent(out) :: n                 !< 0: nothing is taken out
      real(wp) :: o(2), d(2), apart(2), s(size(node)), spread_of
      integer(ip) :: body, k, last, other

      n = 0
      last = points%first(j + 1) - 1
      if (last <= points%first(j)) return
      body = fem%bodies%of_node(points%entry(last))
      k = fem%bodies%of_node(points%entry(points%first(j)))
      if (body == 0 .or. k == 0) return
      if (.not. (may_turn(body) .and. may_turn(k))) return
      o = fem%mesh%x(:, points%entry(last))
      d = 0.0_wp
      do k = points%first(j), last
         d = d + points%coefficient(k)*(fem%mesh%x(:, points%entry(k)) - o)
      end do
      apart = [dot_product(normal, d), normal(1)*d(2) - normal(2)*d(1)]
      where (abs(apart) <= TOUCHING*maxval(abs(o))) apart = 0.0_wp
      if (all(apart == 0.0_wp) .or. maxval(abs(apart)) > FAR*points%length(j)) return
      call add_master(j, AT_NODE, node, n)
      if (n == 1) then
         do k = j - 1, j + 1, 2
            other = modulo(k - 1, points%n) + 1_ip
            if (norm2(points%x(:, other) - points%x(:, j)) > NEXT*(points%length(other) + points%length(j))) cycle
            call add_master(other, AT_NODE, node, n)
         end do
      end if
      if (n == 1) call add_master(j, 0.0_wp, node, n)
      do k = 1, n
         s(k) = normal(1)*(fem%mesh%x(2, node(k)) - o(2)) - normal(2)*(fem%mesh%x(1, node(k)) - o(1))
      end do
      s(:n) = s(:n) - sum(s(:n))/n
      spread_of = sum(s(:n)**2)
      if (.not. spread_of > (SHORT*points%length(j))**2) then
         n = 0
         return
      end if
      turn(1, :n) = -s(:n)*(apart(2)/spread_of)
      turn(2, :n) = s(:n)*(apart(1)/spread_of)

   contains

      !> Adds the nodes of the master at a point that belong to a body, each once.
      pure subroutine add_master(j, least, node, n)
         integer(ip), intent(in) :: j                  !< point
         real(wp), intent(in) :: least                 !< coefficient of a node
         integer(ip), intent(inout) :: node(:), n      !< the first n are in use
         integer(ip) :: k

         do k = first_of_master(points, j), points%first(j + 1) - 1
            if (fem%bodies%of_node(points%entry(k)) /= body .or. n == size(node)) cycle
            if (abs(points%coefficient(k)) < least) cycle
            if (any(node(:n) == points%entry(k))) cycle
            n = n + 1
            node(n) = points%entry(k)
         end do
      end subroutine add_master

   end subroutine find_turn

   !> Gives the rows of points what is n's of some nodes; those that a row has not yet become entries of it, with a
   !> coefficient of 0. The rows are written anew, one behind the other, since they grow.
   pure subroutine add_turns(turns, rows)
      type(turns_t), intent(in) :: turns            !< rising by rows
      type(contact_rows_t), intent(inout) :: rows   !< of all pairs
      integer(ip), allocatable :: node(:)
      real(wp), allocatable :: coefficient(:), turn(:, :)
      integer(ip) :: first(rows%n + 1), m, i, k, e, n, last

      n = size(rows%node, kind=ip) + turns%n
      allocate (node(n), coefficient(n), turn(2, n))
      n = 0
      i = 1
      do m = 1, rows%n
         if (m == rows%n - rows%n_bilateral + 1) rows%before_vectors = n
         first(m) = n + 1
         last = n + rows%first(m + 1) - rows%first(m)
         node(n + 1:last) = rows%node(rows%first(m):rows%first(m + 1) - 1)
         coefficient(n + 1:last) = rows%coefficient(rows%first(m):rows%first(m + 1) - 1)
         turn(:, n + 1:last) = 0.0_wp
         n = last
         do e = i, turns%n
            if (turns%row(e) /= m) exit
            k = first(m) - 1 + findloc(node(first(m):n), turns%node(e), dim=1, kind=ip)
            if (k < first(m)) then
               n = n + 1
               k = n
               node(n) = turns%node(e)
               coefficient(n) = 0.0_wp
               turn(:, n) = 0.0_wp
            end if
            turn(:, k) = turn(:, k) + turns%turn(:, e)
         end do
         i = e
         rows%longest = max(rows%longest, n + 1 - first(m))
      end do
      first(rows%n + 1) = n + 1
      rows%first = first
      rows%node = node(:n)
      rows%coefficient = coefficient(:n)
      rows%turn = turn(:, :n)
   end subroutine add_turns

end module atrito_turning_rows
