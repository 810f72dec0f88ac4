!> Rigid surfaces that move, as bodies of a scene: without elements and equations, with up to three motions about their reference
!> node.
!>
!> A rigid body with the reference node R moves by u(x) = u_R + phi perp(x - x_R), perp(a) = (-a2, a1). Three nodes
!> carry this motion (model%solver_mesh), at R and at its size L along either axis: with (a1, a2) = (x - x_R)/L a place
!> x has the barycentric coordinates
!>
!>     N = (1 - a1 - a2, a1, a2),     u(x) = sum_i N_i(x) u_i,     exactly so for a rigid motion, inside the triangle or not.
!>
!> So a contact point that faces the body at x + g n has these nodes among its entries with -N_i, like those of a face
!> of elements. What is prescribed of u_R and phi comes in with the displacements of the three nodes; what is free are
!> up to three motions about R, with amplitudes like those of a floating body. There is no stiffness: the body adds
!> nothing to C, and to G and h what other bodies do. A force on R is one on the first node; a moment M is the couple
!> -M/L, M/L along the second axis on the first two.
module atrito_rigid_bodies
   use atrito_bodies, only: bodies_t, body_t, mode_at, MOVES_RIGIDLY
   use atrito_build_rigid_bodies, only: carriers_of, CARRIERS
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_model, only: model_t, rigid_body_name, rigid_body_t, nodal_values_t
   use atrito_plane_state, only: STATES
   use atrito_points, only: contact_points_t
   implicit none (type, external)
   private
   public :: attach_points, hold_carriers, append_rigid_bodies, set_rigid_motions, add_rigid_loads, carriers_of, &
             prescribed_motion, hold_the_same, has_moving_surfaces, DOF_OF_MOTION

   integer(ip), parameter :: MOTIONS = 3_ip
   integer(ip), parameter :: DOF_OF_MOTION(MOTIONS) = [1_ip, 2_ip, 6_ip]
   real(wp), parameter :: IDENTITY(MOTIONS, MOTIONS) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1]*1.0_wp, [MOTIONS, MOTIONS])

contains

   !> Whether rigid surfaces move with reference nodes: the mesh that is solved is then solver_mesh, with the nodes that
   !> carry the motions behind those of the deck.
   pure logical function has_moving_surfaces(model)
      type(model_t), intent(in) :: model

      has_moving_surfaces = allocated(model%solver_mesh)
   end function has_moving_surfaces

   !> Adds to the points of each pair whose master moves what that moves by where they meet it, x + g n. In a rotation
   !> the places along a normal move alike along it, n . perp(x + g n - x_R) = n . perp(x - x_R), so it does not matter
   !> which of them is taken for the gap. The coefficients are -N_i, that is -(1 - a1 - a2), -a1, -a2, for the three
   !> nodes of the body.
   pure subroutine attach_points(model, points)
      type(model_t), intent(in) :: model                   !< surfaces and rigid bodies
      type(contact_points_t), intent(inout) :: points(:)   !< one a pair
      integer(ip) :: of_surface(size(model%surfaces)), i, body

      of_surface = bodies_of_surfaces(model)
      do i = 1, size(points, kind=ip)
         if (.not. points(i)%rigid) cycle
         body = of_surface(model%pairs(i)%master)
         if (body > 0) call attach_to(model%rigid_bodies(body), model%mesh%x(:, model%rigid_bodies(body)%node), &
                                      carriers_of(model, body), points(i))
      end do
   end subroutine attach_points

   !> The rigid body of each surface, 0 where there is none: a surface that no reference node moves stays where it is.
   pure function bodies_of_surfaces(model) result(body)
      type(model_t), intent(in) :: model
      integer(ip) :: body(size(model%surfaces)), i

      body = 0
      do i = size(model%rigid_bodies, kind=ip), 1, -1
         if (model%rigid_bodies(i)%surface > 0) body(model%rigid_bodies(i)%surface) = i
      end do
   end function bodies_of_surfaces

   !> The rows of a pair with the nodes of its rigid master behind those of the slave. The slave's coefficients add up
   !> to `whole`, 1.
   pure subroutine attach_to(body, reference, nodes, points)
      type(rigid_body_t), intent(in) :: body        !< the master of the pair
      real(wp), intent(in) :: reference(2)             !< [L]
      integer(ip), intent(in) :: nodes(CARRIERS)    !< that carry its motion
      type(contact_points_t), intent(inout) :: points !< of the pair
      integer(ip) :: first(points%n + 1), entry(size(points%entry) + CARRIERS*points%n), j, n
      real(wp) :: coefficient(size(entry)), arm(2), whole

      first(1) = 1
      do j = 1, points%n
         associate (from => points%first(j), to => points%first(j + 1) - 1)
            n = first(j) + to - from
            entry(first(j):n) = points%entry(from:to)
            coefficient(first(j):n) = points%coefficient(from:to)
            whole = sum(points%coefficient(from:to))
         end associate
         arm = (points%x(:, j) + points%gap(j)*points%normal(:, j) - reference)/body%size
         entry(n + 1:n + CARRIERS) = nodes
         coefficient(n + 1:n + CARRIERS) = -whole*[1 - arm(1) - arm(2), arm(1), arm(2)]
         first(j + 1) = n + CARRIERS + 1
      end do
      points%first = first
      points%entry = entry
      points%coefficient = coefficient
   end subroutine attach_to

   !> The nodes of moving surfaces have no free displacements: they move by what is prescribed of the body, u_R + phi
   !> perp(x_i - x_R), and the rest comes in with the motions. Of the reference node, a node of the mesh, those
   !> displacements are held that are prescribed.
   pure subroutine hold_carriers(model, prescribed, held, value)
      type(model_t), intent(in) :: model               !< surfaces, rigid bodies, mesh
      type(nodal_values_t), intent(in) :: prescribed   !< dofs of reference nodes
      logical, intent(inout) :: held(:, :)             !< (2, nodes of the solver's mesh)
      real(wp), intent(inout) :: value(:, :)           !< (2, nodes of the solver's mesh) [L]
      logical :: is_prescribed(MOTIONS)
      real(wp) :: motion(MOTIONS), arm(2)
      integer(ip) :: i, k, nodes(CARRIERS)

      do i = 1, size(model%rigid_bodies, kind=ip)
         nodes = carriers_of(model, i)
         call prescribed_motion(model, prescribed, i, is_prescribed, motion)
         held(:, nodes) = .true.
         held(:, model%rigid_bodies(i)%node) = is_prescribed(:2)
         do k = 1, CARRIERS
            arm = model%solver_mesh%x(:, nodes(k)) - model%solver_mesh%x(:, nodes(1))
            value(:, nodes(k)) = motion(:2) + motion(3)*[-arm(2), arm(1)]
         end do
      end do
   end subroutine hold_carriers

   !> Which of u1, u2 and the rotation of a rigid body are prescribed, and their values: 0 for those that are free. On
   !> the full circle a body of revolution can neither leave its axis nor turn: u1 and the rotation are held. A
   !> pre-tension section moves along u1 of its reference node alone.
   pure subroutine prescribed_motion(model, prescribed, i, is_prescribed, motion)
      type(model_t), intent(in) :: model
      type(nodal_values_t), intent(in) :: prescribed   !< dofs of reference nodes
      integer(ip), intent(in) :: i                     !< of the rigid bodies
      logical, intent(out) :: is_prescribed(MOTIONS)
      real(wp), intent(out) :: motion(MOTIONS)         !< [L], rotation [-]
      integer(ip) :: k, m

      is_prescribed = .not. STATES(model%mesh%state(1))%moves ! what would strain the bodies of the scene is held
      if (model%rigid_bodies(i)%is_section) is_prescribed = [.false., .true., .true.]
      motion = 0.0_wp
      do k = 1, prescribed%n
         if (prescribed%node(k) /= model%rigid_bodies(i)%node) cycle
         m = findloc(DOF_OF_MOTION, prescribed%dof(k), dim=1, kind=ip)
         is_prescribed(m) = .true.
         motion(m) = prescribed%value(k)
      end do
   end subroutine prescribed_motion

   !> Whether two lists of prescribed dofs leave the same motions free: the unknowns of both have the same numbers then.
   pure logical function hold_the_same(model, one, other) result(same)
      type(model_t), intent(in) :: model
      type(nodal_values_t), intent(in) :: one, other !< dofs of reference nodes
      logical :: is_prescribed(MOTIONS), is_in_other(MOTIONS)
      real(wp) :: motion(MOTIONS)
      integer(ip) :: i

      same = .true.
      if (.not. allocated(model%rigid_bodies)) return
      do i = 1, size(model%rigid_bodies, kind=ip)
         call prescribed_motion(model, one, i, is_prescribed, motion)
         call prescribed_motion(model, other, i, is_in_other, motion)
         same = same .and. all(is_prescribed .eqv. is_in_other)
      end do
   end function hold_the_same

   !> The rigid bodies behind those of elements. One takes part (is_touched) where points face its surface, a row has
   !> one of its nodes, or it is a pre-tension section.
   pure subroutine append_rigid_bodies(model, points, bodies)
      type(model_t), intent(in) :: model              !< surfaces, rigid bodies, mesh
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(bodies_t), intent(inout) :: bodies         !< those of elements in, all out
      type(body_t), allocatable :: list(:)
      logical :: has_points(0:size(model%surfaces)), has_row(model%mesh%n_nodes + CARRIERS*size(model%rigid_bodies))
      integer(ip) :: i, k, nodes(CARRIERS)

      has_points = .false.
      do k = 1, size(points, kind=ip)
         if (points(k)%n > 0) has_points(model%pairs(k)%master) = .true.
      end do
      has_row = .false.
      if (model%bilateral%n > 0) has_row(model%bilateral%node) = .true.
      bodies%n_rigid = size(model%rigid_bodies, kind=ip)
      allocate (list(bodies%n + bodies%n_rigid))
      list(:bodies%n) = bodies%list
      do i = 1, bodies%n_rigid
         nodes = carriers_of(model, i)
         associate (body => list(bodies%n + i))
            body%name = rigid_body_name(model, i)
            body%is_rigid = .true.
            body%nodes = nodes
            allocate (body%elements(0), body%modes(MOTIONS, 0))
            body%centre = model%mesh%x(:, model%rigid_bodies(i)%node)
            body%size = model%rigid_bodies(i)%size
            body%is_touched = model%rigid_bodies(i)%is_section .or. has_points(model%rigid_bodies(i)%surface) &
                              .or. any(has_row(nodes))
         end associate
         bodies%of_node(nodes) = bodies%n + i
      end do
      call move_alloc(list, bodies%list)
      bodies%n = bodies%n + bodies%n_rigid
   end subroutine append_rigid_bodies

   !> What is left free of each rigid body: its modes, columns of the identity (u1, u2, rotation), and where they move
   !> the nodes that carry it. It changes from step to step with what is prescribed.
   pure subroutine set_rigid_motions(model, prescribed, bodies)
      type(model_t), intent(in) :: model               !< surfaces, rigid bodies, mesh
      type(nodal_values_t), intent(in) :: prescribed   !< dofs of reference nodes
      type(bodies_t), intent(inout) :: bodies          !< modes of the rigid ones are replaced
      logical :: is_prescribed(MOTIONS)
      real(wp) :: motion(MOTIONS)
      integer(ip) :: i, m

      do i = 1, bodies%n_rigid
         call prescribed_motion(model, prescribed, i, is_prescribed, motion)
         associate (body => bodies%list(bodies%n - bodies%n_rigid + i))
            body%modes = IDENTITY(:, pack([(m, m=1, MOTIONS)],.not. is_prescribed))
            call mark_moving(model%solver_mesh, body, bodies%equation)
         end associate
      end do
   end subroutine set_rigid_motions

   !> The dofs of its nodes that a rigid body's free motions move; the others are held. They have no equations of their
   !> own: MOVES_RIGIDLY says that a contact row with such a dof has an unknown force all the same.
   pure subroutine mark_moving(mesh, body, equation)
      type(mesh_t), intent(in) :: mesh
      type(body_t), intent(in) :: body              !< a rigid one, with its modes
      integer(ip), intent(inout) :: equation(:, :)  !< (2, n_nodes)
      integer(ip) :: k, dof, m

      do k = 1, size(body%nodes, kind=ip)
         do dof = 1, 2
            equation(dof, body%nodes(k)) = 0
            do m = 1, size(body%modes, 2, kind=ip)
               if (abs(mode_at(body, body%modes(:, m), mesh%x(:, body%nodes(k)), dof)) > 0.0_wp) then
                  equation(dof, body%nodes(k)) = MOVES_RIGIDLY
               end if
            end do
         end do
      end do
   end subroutine mark_moving

   !> The forces on reference nodes; a moment M as the couple -M/L, M/L along x2 on the first two nodes that carry the
   !> motion, L apart along x1.
   pure subroutine add_rigid_loads(model, loads, f)
      type(model_t), intent(in) :: model               !< rigid bodies, and how far their carriers are apart
      type(nodal_values_t), intent(in) :: loads        !< at dofs of reference nodes
      real(wp), allocatable, intent(inout) :: f(:, :)  !< (2, n_nodes) of the mesh in, of the solver's mesh out [F]
      real(wp), allocatable :: all_forces(:, :)
      integer(ip) :: i, k, nodes(CARRIERS)

      allocate (all_forces(2, model%solver_mesh%n_nodes), source=0.0_wp)
      all_forces(:, :size(f, 2)) = f
      do k = 1, loads%n
         i = findloc(model%rigid_bodies%node, loads%node(k), dim=1, kind=ip)
         nodes = carriers_of(model, i)
         associate (dof => loads%dof(k), value => loads%value(k))
            if (dof <= 2) then
               all_forces(dof, nodes(1)) = all_forces(dof, nodes(1)) + value
            else
               all_forces(2, nodes(1)) = all_forces(2, nodes(1)) - value/model%rigid_bodies(i)%size
               all_forces(2, nodes(2)) = all_forces(2, nodes(2)) + value/model%rigid_bodies(i)%size
            end if
         end associate
      end do
      call move_alloc(all_forces, f)
   end subroutine add_rigid_loads

end module atrito_rigid_bodies
