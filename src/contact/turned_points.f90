!> Points of contact whose normals are turned along a motion in which both sides slide (atrito_sliding_motions), so that nothing but
!> friction resists it.
module atrito_turned_points
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: mesh_t
   use atrito_points, only: contact_points_t, sliding_t
   use atrito_slave_faces, only: clear_small_component
   use atrito_sliding_motions, only: velocity
   implicit none (type, external)
   private
   public :: turn_points, is_along, first_of_master

   real(wp), parameter :: NO_PART = 5.0e-14_wp      !< of a motion, along a normal
   real(wp), parameter :: MOST_TURN = 1.2_wp        !< of a row [rad]: more than coarse chords make of a curve
   real(wp), parameter :: MIXED_TURN = 30.0_wp      !< where one side alone has it: in digit errors over the length of a point
   real(wp), parameter :: ARC_TURN = 0.3_wp         !< there on an arc: in angles that the length of a point spans

contains

   !> Turns the rows of a pair along a motion that both sides have, so that it moves no point along its normal: n . v =
   !> 0. The normal of a point becomes the one across the motion where the force acts on the slave; where the master's
   !> share acts, the motion may have a part along that, and some of the force passes from the nodes on one side of that
   !> place to those on the other; of a single node to one of those that the points beside it see. Where one side alone is straight
   !> or round, points at which the other one has turned away stay as they are.
   pure subroutine turn_points(motion, mesh, points)
      type(sliding_t), intent(in) :: motion !< in which both sides slide along themselves
      type(mesh_t), intent(in) :: mesh      !< where the nodes lie
      type(contact_points_t), intent(inout) :: points !< of the pair
      real(wp) :: normal(2, points%n), v(2), most
      logical :: is_turned(points%n)
      integer(ip) :: j, k, m

      do j = 1, points%n
         v = velocity(motion, force_place())
         if (.not. norm2(v) > 0.0_wp) return
         normal(:, j) = [v(2), -v(1)]/norm2(v)
         normal(:, j) = sign(1.0_wp, dot_product(normal(:, j), points%normal(:, j)))*normal(:, j)
         most = MOST_TURN
         if (.not. motion%is_of_both) most = MIXED_TURN*motion%digit_error/points%length(j)
         if (.not. motion%is_of_both .and. motion%is_round) most = max(most, ARC_TURN*points%length(j)/motion%radius)
         is_turned(j) = norm2(normal(:, j) - points%normal(:, j)) <= most
         if (.not. is_turned(j) .and. motion%is_of_both) return
      end do
      if (motion%is_round) call lend_nodes(motion, mesh, normal, is_turned, points)
      do j = 1, points%n
         if (.not. is_turned(j)) cycle
         points%gap(j) = points%gap(j)/dot_product(normal(:, j), points%normal(:, j)) ! of faces across the old normal
         points%normal(:, j) = normal(:, j)
         call clear_small_component(points%x(:, j), points%length(j), points%normal(:, j))
         if (.not. motion%is_round) cycle
         k = first_of_master(points, j)
         m = points%first(j + 1) - 1
         if (m > k) call shift_force(points%normal(:, j), points%entry(k:m), points%coefficient(k:m))
      end do

   contains

      !> Where the force of a point acts on the slave [L]: sum c_k x_k over the slave's nodes, taken from the first of them.
      pure function force_place() result(x)
         real(wp) :: x(2), o(2), away(2)
         integer(ip) :: k

         o = mesh%x(:, points%entry(points%first(j)))
         away = 0.0_wp
         do k = points%first(j), first_of_master(points, j) - 1
            away = away + points%coefficient(k)*(mesh%x(:, points%entry(k)) - o)
         end do
         x = o + away
      end function force_place

      !> The least change of the master's coefficients, weighted by themselves, that keeps their sum and leaves no motion along n:
      !> with a_k = n . v(x_k) the changes d_k that minimise sum d_k^2/|c_k| under sum d_k = 0 and sum (c_k + d_k) a_k = 0 are
      !>
      !>     d_k = -|c_k| (a_k - mean a) (sum c_i a_i)/sum |c_i| (a_i - mean a)^2,     mean a = sum |c_i| a_i/sum |c_i|.
      pure subroutine shift_force(n, node, coefficient)
         real(wp), intent(in) :: n(2)                  !< normal of the point
         integer(ip), intent(in) :: node(:)            !< of the master
         real(wp), intent(inout) :: coefficient(:)     !< their sum is -1
         real(wp) :: along(size(node)), mean, spread_of
         integer(ip) :: k

         do k = 1, size(node, kind=ip)
            along(k) = dot_product(n, velocity(motion, mesh%x(:, node(k))))
         end do
         mean = sum(abs(coefficient)*along)/sum(abs(coefficient))
         spread_of = sum(abs(coefficient)*(along - mean)**2)
         if (.not. spread_of > (EPS_MACH*motion%extent)**2) return
         coefficient = coefficient - abs(coefficient)*(along - mean)*(sum(coefficient*along)/spread_of)
      end subroutine shift_force

   end subroutine turn_points

   !> Gives points whose master is a single node that is off the ray from the centre, by the last digits of the deck, a second one:
   !> of those that the points beside it see, the one that moves most, a2 = n . v(x_2), along its normal. The shares
   !> -a2/(a2 - a1) and a1/(a2 - a1) of both leave no motion along it.
   pure subroutine lend_nodes(motion, mesh, normal, is_turned, points)
      type(sliding_t), intent(in) :: motion
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: normal(:, :)          !< (2, points) that they will have
      logical, intent(in) :: is_turned(:)           !< (points)
      type(contact_points_t), intent(inout) :: points !< of the pair
      integer(ip), allocatable :: entry(:), seen(:)
      real(wp), allocatable :: coefficient(:), along(:)
      integer(ip) :: first(points%n + 1), i, j, k, n

      n = points%first(points%n + 1) - 1 + points%n
      allocate (entry(n), coefficient(n))
      first(1) = 1
      do j = 1, points%n
         n = first(j) + points%first(j + 1) - points%first(j)
         entry(first(j):n - 1) = points%entry(points%first(j):points%first(j + 1) - 1)
         coefficient(first(j):n - 1) = points%coefficient(points%first(j):points%first(j + 1) - 1)
         if (is_turned(j) .and. first_of_master(points, j) == points%first(j + 1) - 1) then
            seen = entry(n - 1:n - 1)
            do i = max(j - 1, 1), min(j + 1, points%n)
               seen = [seen, points%entry(first_of_master(points, i):points%first(i + 1) - 1)]
            end do
            along = [(dot_product(normal(:, j), velocity(motion, mesh%x(:, seen(k)))), k=1, size(seen, kind=ip))]
            k = maxloc(abs(along), dim=1, kind=ip)
            if (abs(along(1)) > NO_PART*motion%radius .and. abs(along(k)) > abs(along(1))) then
               entry(n) = seen(k)
               coefficient(n - 1:n) = [-along(k), along(1)]/(along(k) - along(1))
               n = n + 1
            end if
         end if
         first(j + 1) = n
      end do
      points%first = first
      points%entry = entry(:n - 1)
      points%coefficient = coefficient(:n - 1)
   end subroutine lend_nodes

   !> Whether no point moves along its normal as it is, neither what is the slave's of its row nor what is the master's.
   pure logical function is_along(motion, mesh, points)
      type(sliding_t), intent(in) :: motion
      type(mesh_t), intent(in) :: mesh
      type(contact_points_t), intent(in) :: points  !< of the pair
      real(wp) :: moved(2)                          ! by what is the slave's and what is the master's
      integer(ip) :: i, j, k

      is_along = .false.
      do j = 1, points%n
         moved = 0.0_wp
         do k = points%first(j), points%first(j + 1) - 1
            i = merge(1, 2, k < first_of_master(points, j))
            moved(i) = moved(i) + points%coefficient(k)*dot_product(points%normal(:, j), &
                                                                    velocity(motion, mesh%x(:, points%entry(k))))
         end do
         if (any(abs(moved) > NO_PART*merge(motion%radius, 1.0_wp, motion%is_round))) return
      end do
      is_along = .true.
   end function is_along

   !> The first of the master's entries of a point: those of the slave stand before and add up to one; beside a face of three nodes
   !> some may be negative.
   pure integer(ip) function first_of_master(points, j) result(k)
      type(contact_points_t), intent(in) :: points  !< of the pair
      integer(ip), intent(in) :: j                  !< point
      real(wp), parameter :: NEARLY = 1.0e-9_wp
      real(wp) :: total

      total = 0.0_wp
      do k = points%first(j), points%first(j + 1) - 1
         if (abs(total - 1) <= NEARLY) return
         total = total + points%coefficient(k)
      end do
   end function first_of_master

end module atrito_turned_points
