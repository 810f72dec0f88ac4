!> The largest and least displacements, stresses and tractions of an increment, and where they are.
!>
!> Of nodes whose values do not differ but for round-off the first is told: what is symmetric has one place, whatever the solver.
module atrito_extremes
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_points, only: contact_points_t
   use atrito_results, only: results_t, extreme_t, EXTREME_NAMES
   implicit none (type, external)
   private
   public :: find_extremes

   !> A least one is the largest of its negative.
   logical, parameter :: IS_LEAST(size(EXTREME_NAMES)) = [.false., .false., .true., .false., .true., .false., .false., .true., &
                                                          .false., .false.]
   integer, parameter :: U = 1, MISES = 6, S1 = 7, S3 = 8, PRESSURE = 9, SHEAR = 10

   !> A value takes the place of another one when it is larger by this part of it, and of the largest of its kind.
   real(wp), parameter :: NEAR = 1.0e-9_wp, ROUND_OFF = 1.0e-12_wp

   !> The largest so far.
   type :: largest_t
      real(wp) :: value(size(EXTREME_NAMES)) = 0.0_wp          !< as EXTREME_NAMES; of least ones the negative
      integer(ip) :: node(size(EXTREME_NAMES)) = 0             !< place; 0: none yet
      real(wp) :: x(2, size(EXTREME_NAMES)) = 0.0_wp           !< [L]
   end type largest_t

contains

   !> Fills results%extremes from the displacements, the stresses at the nodes and the contact; nodes in no element are left out.
   pure subroutine find_extremes(mesh, body_of_node, points, results)
      type(mesh_t), intent(in) :: mesh                 !< as solved
      integer(ip), intent(in) :: body_of_node(:)       !< (>= n_nodes) 0: in no element
      type(contact_points_t), intent(in) :: points(:)  !< of each pair
      type(results_t), intent(inout) :: results        !< with u, nodal stresses and contact; gets extremes
      type(largest_t) :: largest
      integer(ip) :: k, i, j
      real(wp) :: slack
      integer :: l, n

      do k = 1, mesh%n_nodes
         if (body_of_node(k) == 0) cycle
         associate (v => results%u(:, k), x => mesh%x(:, k))
            if (largest%node(U) == 0 .or. abs(v(1)) + abs(v(2)) > largest%value(U)) then
               call take(U, hypot(v(1), v(2)), 0.0_wp, k, x, largest)
            end if
            slack = ROUND_OFF*largest%value(U)
            call take(U + 1, v(1), slack, k, x, largest)
            call take(U + 2, -v(1), slack, k, x, largest)
            call take(U + 3, v(2), slack, k, x, largest)
            call take(U + 4, -v(2), slack, k, x, largest)
         end associate
         call take_stress(results%nodal_stress(:, k), k, mesh%x(:, k), largest)
      end do
      do i = 1, size(points, kind=ip)
         associate (c => results%contact(i), node => points(i)%node)
            do j = 1, c%n
               call take(PRESSURE, c%pressure(j), 0.0_wp, node(j), c%x(:, j), largest)
               call take(SHEAR, abs(c%shear(j)), ROUND_OFF*largest%value(PRESSURE), node(j), c%x(:, j), largest)
            end do
         end associate
      end do
      ! Those that there are, as results have them.
      if (allocated(results%extremes)) deallocate (results%extremes)
      allocate (results%extremes(count(largest%node > 0)))
      n = 0
      do l = 1, size(EXTREME_NAMES)
         if (largest%node(l) == 0) cycle
         n = n + 1
         results%extremes(n) = extreme_t(largest%value(l), mesh%node_id(largest%node(l)), largest%x(:, l), .true., EXTREME_NAMES(l))
         if (IS_LEAST(l)) results%extremes(n)%value = -results%extremes(n)%value
      end do
   end subroutine find_extremes

   !> Mises' stress and the principal stresses of a node. Those in the plane are the ends of Mohr's circle,
   !>
   !>     s = (s11 + s22)/2 +- r,     r^2 = ((s11 - s22)/2)^2 + s12^2,
   !>
   !> and the third one is s33: S1 is the greatest of the three, S3 the least. r is at most |s11 - s22|/2 + |s12|; where that bound
   !> reaches neither extreme, which is nearly everywhere, no root is taken.
   pure subroutine take_stress(s, node, x, largest)
      real(wp), intent(in) :: s(5)                     !< s11 s22 s33 s12 mises [F/L^2]
      integer(ip), intent(in) :: node
      real(wp), intent(in) :: x(2)
      type(largest_t), intent(inout) :: largest
      real(wp) :: mean, half, bound, radius, slack

      call take(MISES, s(5), 0.0_wp, node, x, largest)
      mean = 0.5_wp*s(1) + 0.5_wp*s(2)
      half = 0.5_wp*s(1) - 0.5_wp*s(2)
      bound = abs(half) + abs(s(4))
      if (largest%node(S1) > 0 .and. max(mean + bound, s(3)) <= largest%value(S1) &
          .and. max(bound - mean, -s(3)) <= largest%value(S3)) return
      radius = hypot(half, s(4))
      slack = ROUND_OFF*largest%value(MISES)
      call take(S1, max(mean + radius, s(3)), slack, node, x, largest)
      call take(S3, max(radius - mean, -s(3)), slack, node, x, largest)
   end subroutine take_stress

   !> Keeps the larger of a value and the largest one so far. Larger is what is so by a part NEAR of it, and by `slack`, which is
   !> the round-off of the largest of its kind: a component that is 0 but for round-off has no digits of its own by which to
   !> compare.
   pure subroutine take(quantity, value, slack, node, x, largest)
      integer, intent(in) :: quantity                  !< place in EXTREME_NAMES
      real(wp), intent(in) :: value, slack
      integer(ip), intent(in) :: node
      real(wp), intent(in) :: x(2)
      type(largest_t), intent(inout) :: largest

      associate (most => largest%value(quantity))
         if (largest%node(quantity) > 0 .and. value <= most + max(NEAR*abs(most), slack)) return
         most = value
         largest%node(quantity) = node
         largest%x(:, quantity) = x
      end associate
   end subroutine take

end module atrito_extremes
