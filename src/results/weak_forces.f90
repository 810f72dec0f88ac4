!> Equilibrium where forces are small: the nodes of each body are judged by the forces on that body, those of a contact pair by the
!> forces of that pair. (An error of 1e-7 of the largest force of a scene may be all that a weak pair has.)
module atrito_weak_forces
   use atrito_assembly, only: fem_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_contact_scales, only: printed_as_none, had_t, had_force, NONE_OF_HAD
   use atrito_internal_forces, only: internal_force_sizes
   use atrito_kinds, only: ip, wp, EPS_MACH
   implicit none (type, external)
   private
   public :: contact_sizes_t, forces_of_bodies, motion_round_off, weak_parts_hold

   !> The forces at the contact points, and how far rigid motions take the bodies.
   type :: contact_sizes_t
      real(wp), allocatable :: force(:)          !< (points) [F]
      integer(ip), allocatable :: pair(:)        !< (points) contact pair of each
      real(wp), allocatable :: motion(:)         !< (bodies) [L]
      type(contact_rows_t) :: rows               !< of the points
      type(had_t) :: had                         !< of the increments before
   end type contact_sizes_t

   real(wp), parameter :: FORCE_TOLERANCE = 5.0e-8_wp !< of the largest force of the pair, of the body
   real(wp), parameter :: ROUND_OFFS = 5.0e4_wp  !< EPS_MACH |K||u_e|: the backward error of a solution by condensation
   real(wp), parameter :: OF_MOTION = 32.0_wp    !< EPS_MACH of the motion of a body, of which its deformation is a part

contains

   !> Whether the residual of every node is small beside the forces of its body and pairs. Its round-off is asked for where
   !> it is not.
   !>
   !>     |residual| - round-off <= FORCE_TOLERANCE (largest force of the body; of the pair, or the own load)
   !>
   !> First without round-off, which is enough for most scenes and costs nothing; only where that fails is sum |K||du| formed, du
   !> being what a backward stable solution leaves of u, and of a motion of the body that u is a small part of.
   function weak_parts_hold(fem, u, f, contact, held, residual, sizes) result(holds)
      type(fem_t), intent(in) :: fem             !< its bodies are judged
      real(wp), intent(in) :: u(:, :)            !< u_e, without rigid motions, (2, n_nodes) [L]
      real(wp), intent(in) :: f(:, :), contact(:, :) !< loads and B'q (2, n_nodes) [F]
      logical, intent(in) :: held(:, :)          !< (2, n_nodes) dofs with a prescribed displacement
      real(wp), intent(in) :: residual(:, :)     !< (2, n_nodes) K u_e - f + B'q; at held dofs the reaction [F]
      type(contact_sizes_t), intent(in) :: sizes !< forces of pairs, and what bodies had
      logical :: holds
      real(wp), allocatable :: round_off(:, :)
      integer(ip) :: b

      allocate (round_off(2, 1), source=0.0_wp)
      holds = bodies_hold(fem, f, contact, held, residual, sizes, round_off) .and. pairs_hold(f, held, residual, sizes, round_off)
      if (holds) return
      deallocate (round_off)
      allocate (round_off(2, fem%mesh%n_nodes))
      call internal_force_sizes(fem, uncertain_part(fem, u, sizes%motion), round_off)
      do b = 1, fem%bodies%n
         associate (nodes => fem%bodies%list(b)%nodes)
            round_off(:, nodes) = round_off(:, nodes) + NONE_OF_HAD*had_force(sizes%had, b)
         end associate
      end do
      holds = bodies_hold(fem, f, contact, held, residual, sizes, round_off) .and. pairs_hold(f, held, residual, sizes, round_off)
   end function weak_parts_hold

   !> What is round-off in displacements of which the motion of the body was taken out [L].
   pure function motion_round_off(fem, motion) result(uncertain)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: motion(:)          !< (bodies) how far rigid motions take them [L]
      real(wp) :: uncertain(2, fem%mesh%n_nodes)
      integer(ip) :: b

      uncertain = 0.0_wp
      do b = 1, fem%bodies%n
         uncertain(:, fem%bodies%list(b)%nodes) = OF_MOTION*EPS_MACH*motion(b)
      end do
   end function motion_round_off

   !> What round-off, and the printing of small displacements, may do to the displacements [L].
   pure function uncertain_part(fem, u, motion) result(uncertain)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :), motion(:)
      real(wp) :: uncertain(size(u, 1), size(u, 2))
      real(wp) :: of_body(fem%bodies%n)
      integer(ip) :: b

      uncertain = ROUND_OFFS*EPS_MACH*abs(u)
      of_body = [(motion(b) + maxval(abs(u(:, fem%bodies%list(b)%nodes))), b=1, fem%bodies%n)]
      do b = 1, fem%bodies%n
         associate (nodes => fem%bodies%list(b)%nodes)
            uncertain(:, nodes) = uncertain(:, nodes) + OF_MOTION*EPS_MACH*of_body(b) + printed_as_none(of_body(b), maxval(of_body))
         end associate
      end do
   end function uncertain_part

   !> The largest force of a row that each body takes part in [F].
   pure function forces_of_bodies(fem, sizes) result(forces)
      type(fem_t), intent(in) :: fem
      type(contact_sizes_t), intent(in) :: sizes
      real(wp) :: forces(fem%bodies%n), largest(0:fem%bodies%n)
      integer(ip) :: j, k

      largest = 0.0_wp
      do j = 1, sizes%rows%n
         do k = sizes%rows%first(j), sizes%rows%first(j + 1) - 1
            associate (most => largest(fem%bodies%of_node(sizes%rows%node(k))))
               most = max(most, sizes%force(j))
            end associate
         end do
      end do
      forces = largest(1:)
   end function forces_of_bodies

   !> Each body by the largest load, contact force or reaction at a node of it, or force of a row that it takes part in: rows of a
   !> node, as of contact and of a rigid body, may leave nothing of each other.
   pure logical function bodies_hold(fem, f, contact, held, residual, sizes, round_off) result(holds)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: f(:, :), contact(:, :), residual(:, :)
      logical, intent(in) :: held(:, :)
      type(contact_sizes_t), intent(in) :: sizes
      real(wp), intent(in) :: round_off(:, :)    !< (2, n_nodes), or (2, 1) for all [F]
      real(wp) :: force, excess, of_rows(fem%bodies%n)
      integer(ip) :: b, i

      of_rows = forces_of_bodies(fem, sizes)
      holds = .true.
      do b = 1, fem%bodies%n
         force = of_rows(b)
         excess = 0.0_wp
         associate (nodes => fem%bodies%list(b)%nodes)
            do i = 1, size(nodes, kind=ip)
               associate (node => nodes(i), k => min(nodes(i), size(round_off, 2, kind=ip)))
                  force = max(force, abs(f(1, node)), abs(f(2, node)), abs(contact(1, node)), abs(contact(2, node)), &
                              merge(abs(residual(1, node)), 0.0_wp, held(1, node)), &
                              merge(abs(residual(2, node)), 0.0_wp, held(2, node)))
                  excess = max(excess, merge(0.0_wp, abs(residual(1, node)) - round_off(1, k), held(1, node)), &
                               merge(0.0_wp, abs(residual(2, node)) - round_off(2, k), held(2, node)))
               end associate
            end do
         end associate
         holds = holds .and. excess <= FORCE_TOLERANCE*force
      end do
   end function bodies_hold

   !> The nodes of each pair by its largest force, or by their own load.
   pure logical function pairs_hold(f, held, residual, sizes, round_off) result(holds)
      real(wp), intent(in) :: f(:, :), residual(:, :)
      logical, intent(in) :: held(:, :)
      type(contact_sizes_t), intent(in) :: sizes
      real(wp), intent(in) :: round_off(:, :)
      real(wp) :: largest(maxval([sizes%pair, 0_ip])), excess
      integer(ip) :: j, k, dof

      largest = 0.0_wp
      do j = 1, sizes%rows%n
         largest(sizes%pair(j)) = max(largest(sizes%pair(j)), sizes%force(j))
      end do
      holds = .true.
      do j = 1, sizes%rows%n
         ! a pair without any force asks for nothing
         if (largest(sizes%pair(j)) <= 0.0_wp) cycle
         do k = sizes%rows%first(j), sizes%rows%first(j + 1) - 1
            associate (node => sizes%rows%node(k), other => min(sizes%rows%node(k), size(round_off, 2, kind=ip)))
               do dof = 1, 2
                  if (held(dof, node)) cycle
                  excess = abs(residual(dof, node)) - round_off(dof, other)
                  holds = holds .and. excess <= FORCE_TOLERANCE*max(largest(sizes%pair(j)), abs(f(dof, node)))
               end do
            end associate
         end do
      end do
   end function pairs_hold

end module atrito_weak_forces
