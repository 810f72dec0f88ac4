!> Sums of forces: over all nodes of the bodies, chunk by chunk of the nodes; over each body and each joint; and of bilateral rows,
!> of which those of inclined supports are reactions, while those of springs and equations may go to the ground.
module atrito_force_sums
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_assembly, only: fem_t
   use atrito_bilateral_rows, only: ROW_SUPPORT, ROW_SPRING, ROW_EQUATION
   use atrito_bodies, only: body_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_displacements, only: add_bilateral_forces
   use atrito_element, only: body_load
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: element_coordinates, is_revolved, depth_places
   use atrito_points, only: contact_points_t
   use atrito_range, only: work_of, unit_of
   use atrito_results, only: balance_t, results_t, body_motion_t, contact_result_t, joint_t
   use atrito_rigid_bodies, only: carriers_of, has_moving_surfaces
   use atrito_scene_data, only: scene_data_t
   use atrito_threads, only: is_shared, chunk_count, find_chunk
   implicit none (type, external)
   private
   public :: sum_forces, share_out_rows, clear_balance, leave_out_sections, sum_bodies, nodal_volumes, sum_joints

   !> Normals whose sum is a smaller share of their lengths have no mean: those of a closed ring.
   real(wp), parameter :: NO_DIRECTION = 1.0e-8_wp
   !> Round-off in the distance of points, in parts of it.
   real(wp), parameter :: SLACK = 1.0e-6_wp

contains

   !> Resultants, and the work of applied forces and reactions.
   subroutine sum_forces(x, u, f, reaction, contact, balance, work)
      real(wp), intent(in) :: x(:, :)            !< (2, n_nodes) [L]
      real(wp), intent(in) :: u(:, :)            !< (2, n_nodes) [L]
      real(wp), intent(in) :: f(:, :)            !< applied forces (2, n_nodes) [F]
      real(wp), intent(in) :: reaction(:, :)     !< (2, n_nodes) [F]
      real(wp), intent(in) :: contact(:, :)      !< B'q (2, n_nodes) [F]
      type(balance_t), intent(out) :: balance    !< applied, reactions and rigid parts are set
      real(wp), intent(out) :: work              !< [F L]
      type(balance_t) :: sums(chunk_count(size(u, 2, kind=ip)))
      real(wp) :: works(size(sums)), unit        ! over the unit of displacement [F]
      integer(ip) :: chunk, first, last

      unit = unit_of(u)
      !$omp parallel do schedule(static) private(first, last) if (is_shared(size(u, 2, kind=ip)))
      do chunk = 1, size(sums, kind=ip)
         call find_chunk(chunk, size(u, 2, kind=ip), first, last)
         call sum_run(x(:, first:last), u(:, first:last), 1/unit, f(:, first:last), reaction(:, first:last), &
                      contact(:, first:last), sums(chunk), works(chunk))
      end do
      !$omp end parallel do
      do chunk = 1, size(sums, kind=ip)
         balance%applied = balance%applied + sums(chunk)%applied
         balance%reactions = balance%reactions + sums(chunk)%reactions
         balance%rigid = balance%rigid + sums(chunk)%rigid
      end do
      work = work_of(1_ip, [sum(works)], [unit])
   end subroutine sum_forces

   !> Of a run of nodes the resultants of loads, reactions and contact, and the work of loads and reactions on the displacements
   !> over the unit.
   pure subroutine sum_run(x, u, per_unit, f, reaction, contact, balance, work)
      real(wp), intent(in) :: x(:, :), u(:, :), per_unit, f(:, :), reaction(:, :), contact(:, :)
      type(balance_t), intent(out) :: balance
      real(wp), intent(out) :: work
      real(wp) :: applied(3), reactions(3), rigid(3)
      integer(ip) :: i

      work = 0.0_wp
      applied = 0.0_wp
      reactions = 0.0_wp
      rigid = 0.0_wp
      do i = 1, size(x, 2, kind=ip)
         applied = applied + about_origin(x(:, i), f(:, i))
         reactions = reactions + about_origin(x(:, i), reaction(:, i))
         rigid = rigid + about_origin(x(:, i), contact(:, i))
         work = work + ((f(1, i) + reaction(1, i))*(u(1, i)*per_unit) + (f(2, i) + reaction(2, i))*(u(2, i)*per_unit))
      end do
      balance%applied = applied
      balance%reactions = reactions
      balance%rigid = rigid
   end subroutine sum_run

   !> A force at x, and its moment about the origin x1 F2 - x2 F1.
   pure function about_origin(x, force) result(both)
      real(wp), intent(in) :: x(2), force(2)     !< [L], [F]
      real(wp) :: both(3)

      both = [force, x(1)*force(2) - x(2)*force(1)]
   end function about_origin

   !> The forces of the bilateral rows: those of supports become reactions, those of others stay with the contact.
   subroutine share_out_rows(data, solution, contact, results, others)
      type(scene_data_t), intent(in) :: data               !< rows and line
      type(contact_solution_t), intent(in) :: solution     !< p of the rows
      real(wp), intent(inout) :: contact(:, :)             !< (2, n_nodes) with all rows; without supports on return [F]
      type(results_t), intent(inout) :: results            !< reaction, prescribed, row_force and row_x are set
      real(wp), intent(out) :: others(3)                   !< resultant of springs and equations [F], moment about the origin [F L]
      real(wp) :: q(data%rows%n), to_ground(2, data%fem%mesh%n_nodes)
      integer(ip) :: j

      associate (kind => data%model%bilateral%kind, n => data%rows%n - data%rows%n_bilateral)
         q = data%line%weight*solution%p
         results%row_force = q(n + 1:)
         results%row_x = data%fem%mesh%x(:, data%rows%node(data%rows%first(n + 1:data%rows%n)))
         to_ground = 0.0_wp
         call add_bilateral_forces(data%rows, kind == ROW_SUPPORT, q, to_ground)
         contact = contact - to_ground
         results%reaction = results%reaction - to_ground
         do j = 1, data%rows%n_bilateral                   ! reactions along both axes, whatever the direction of the support
            if (kind(j) == ROW_SUPPORT) results%prescribed(:, data%rows%node(data%rows%first(n + j))) = .true.
         end do
         to_ground = 0.0_wp
         call add_bilateral_forces(data%rows, kind == ROW_SPRING .or. kind == ROW_EQUATION, q, to_ground)
         associate (x => data%fem%mesh%x)
            others = [sum(to_ground, dim=2), sum(x(1, :)*to_ground(2, :) - x(2, :)*to_ground(1, :))]
         end associate
      end associate
   end subroutine share_out_rows

   !> A force at the node of a pre-tension section is one of two that balance each other: it is in no resultant.
   pure subroutine leave_out_sections(data, reaction, contact, balance)
      type(scene_data_t), intent(in) :: data                !< rigid bodies of its model, and loads
      real(wp), intent(in) :: reaction(:, :), contact(:, :) !< (2, n_nodes) [F]
      type(balance_t), intent(inout) :: balance             !< their applied, reactions and rigid go
      integer(ip) :: i, nodes(3)

      if (.not. has_moving_surfaces(data%model)) return
      do i = 1, size(data%model%rigid_bodies, kind=ip)
         if (.not. data%model%rigid_bodies(i)%is_section) cycle
         nodes = carriers_of(data%model, i)
         associate (x => data%fem%mesh%x(:, nodes(1)))
            balance%applied = balance%applied - about_origin(x, data%f(:, nodes(1)))
            balance%reactions = balance%reactions - about_origin(x, reaction(:, nodes(1)))
            balance%rigid = balance%rigid - about_origin(x, contact(:, nodes(1)))
         end associate
      end do
   end subroutine leave_out_sections

   !> What bodies that are tied do to each other adds up to round-off.
   pure subroutine clear_balance(balance)
      type(balance_t), intent(inout) :: balance  !< rigid and rows that are round-off become 0
      real(wp), parameter :: ROUND_OFF = 1.0e-13_wp
      real(wp) :: all_forces

      associate (rigid => balance%rigid(:2), rows => balance%rows(:2))
         all_forces = sum(abs(balance%applied(:2)) + abs(balance%reactions(:2)) + abs(rigid) + abs(rows))
         where (abs(rigid) <= ROUND_OFF*all_forces) rigid = 0.0_wp
         where (abs(rows) <= ROUND_OFF*all_forces) rows = 0.0_wp
      end associate
   end subroutine clear_balance

   !> All bodies. The contact's forces enter as contact_forces has them: what they take from the loads.
   subroutine sum_bodies(fem, u, f, reaction, contact, bodies)
      type(fem_t), intent(in) :: fem                        !< bodies, mesh and sections
      real(wp), intent(in) :: u(:, :)                       !< (2, n_nodes) [L]
      real(wp), intent(in) :: f(:, :)                       !< applied forces (2, n_nodes) [F]
      real(wp), intent(in) :: reaction(:, :)                !< (2, n_nodes) [F]
      real(wp), intent(in) :: contact(:, :)                 !< B'q (2, n_nodes) [F]
      type(body_motion_t), allocatable, intent(out) :: bodies(:) !< of elements, in the order of the bodies
      real(wp), allocatable :: volume(:)
      integer(ip) :: b

      volume = nodal_volumes(fem)
      allocate (bodies(fem%bodies%n - fem%bodies%n_rigid))
      do b = 1, size(bodies, kind=ip)
         associate (body => fem%bodies%list(b), row => bodies(b))
            row%name = body%name
            row%size = body%size
            call find_motion(fem, body, volume, u, row)
            call add_forces(fem, body, f, row%centre, row%loads, row%terms)
            call add_forces(fem, body, reaction, row%centre, row%supports, row%terms)
            call add_forces(fem, body, contact, row%centre, row%contact, row%terms)
            row%contact = -row%contact
            ! A body of revolution as a whole: its centre lies on the axis and stays there, forces along a radius have no
            ! resultant, and neither they nor those along the axis have a moment.
            if (is_revolved(fem%mesh)) then
               row%centre(1) = 0.0_wp
               row%u(1) = 0.0_wp
               row%rotation = 0.0_wp
               row%loads([1, 3]) = 0.0_wp
               row%supports([1, 3]) = 0.0_wp
               row%contact([1, 3]) = 0.0_wp
            end if
         end associate
      end do
   end subroutine sum_bodies

   !> The integral of the shape function of each node, times the thickness (n_nodes) [L^3].
   function nodal_volumes(fem) result(volume)
      type(fem_t), intent(in) :: fem             !< mesh and thicknesses are read
      real(wp), allocatable :: volume(:)
      real(wp), allocatable :: x(:, :), share(:, :)
      integer(ip) :: e, n

      allocate (volume(fem%mesh%n_nodes), source=0.0_wp)
      do e = 1, fem%mesh%n_elements
         n = fem%mesh%shape(e)
         x = element_coordinates(fem%mesh, e)
         if (allocated(share)) deallocate (share)
         allocate (share(2, n))
         call body_load(x, [1.0_wp, 0.0_wp], fem%sections(fem%section_of(e))%thickness, &
                        fem%mesh%state(e), share, places=depth_places(fem%mesh, fem%mesh%state(e), fem%mesh%nodes(:n, e)))
         associate (nodes => fem%mesh%nodes(:n, e))
            volume(nodes) = volume(nodes) + share(1, :)
         end associate
      end do
   end function nodal_volumes

   !> Centre, its displacement and the rotation, in parts of volume and size of the body so that no power of a length is formed.
   !>
   !> With the shares w of the volume, their sum 1, and r the way from the centre, the sum of
   !> w |u - u0 - theta (-r2, r1)|^2 is least for
   !>    u0 = sum w u,   theta = sum w (r1 (u2 - u02) - r2 (u1 - u01)) / sum w |r|^2,
   !> since sum w r = 0: the two do not mix.
   pure subroutine find_motion(fem, body, volume, u, row)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: volume(:), u(:, :)
      type(body_motion_t), intent(inout) :: row
      real(wp) :: weight(size(body%nodes)), arm(2), turned, inertia
      integer(ip) :: i

      associate (nodes => body%nodes)
         weight = volume(nodes)/sum(volume(nodes))
         do i = 1, 2
            ! from the middle of the body: far from the origin the sum of the places themselves would lose digits
            row%centre(i) = body%centre(i) + sum(weight*(fem%mesh%x(i, nodes) - body%centre(i)))
            row%u(i) = sum(weight*u(i, nodes))
         end do
         turned = 0.0_wp
         inertia = 0.0_wp
         do i = 1, size(nodes, kind=ip)
            arm = (fem%mesh%x(:, nodes(i)) - row%centre)/body%size
            turned = turned + weight(i)*(arm(1)*(u(2, nodes(i)) - row%u(2)) - arm(2)*(u(1, nodes(i)) - row%u(1)))
            inertia = inertia + weight(i)*(arm(1)**2 + arm(2)**2)
         end do
      end associate
      row%rotation = turned/inertia/body%size
   end subroutine find_motion

   !> Sum of nodal forces along x and y, and their moment about a point. The sizes of the terms are added.
   pure subroutine add_forces(fem, body, force, centre, resultant, terms)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: force(:, :)                   !< (2, n_nodes) [F]
      real(wp), intent(in) :: centre(2)                     !< [L]
      real(wp), intent(out) :: resultant(3)                 !< [F], [F L]
      real(wp), intent(inout) :: terms(2)                   !< [F], [F L]
      real(wp) :: arm(2)
      integer(ip) :: i

      resultant = 0.0_wp
      do i = 1, size(body%nodes, kind=ip)
         associate (f => force(:, body%nodes(i)))
            arm = fem%mesh%x(:, body%nodes(i)) - centre
            resultant(1:2) = resultant(1:2) + f
            resultant(3) = resultant(3) + (arm(1)*f(2) - arm(2)*f(1))
            terms = terms + [norm2(f), norm2(arm)*norm2(f)]
         end associate
      end do
   end subroutine add_forces

   !> The joints of all pairs, by pair, then along s. The points learn which joint is theirs.
   pure subroutine sum_joints(body_of_node, points, contact, joints)
      integer(ip), intent(in) :: body_of_node(:)            !< (n_nodes)
      type(contact_points_t), intent(in) :: points(:)       !< one a pair
      type(contact_result_t), intent(inout) :: contact(:)   !< one a pair
      type(joint_t), allocatable, intent(out) :: joints(:)  !< place of each is contact%joint
      type(joint_t) :: found(sum(points%n))
      integer(ip) :: i, n

      n = 0
      do i = 1, size(points, kind=ip)
         call find_joints(body_of_node, i, points(i), contact(i), found, n)
      end do
      joints = found(:n)
      do i = 1, n
         call sum_joint(contact(joints(i)%pair), i, joints(i))
      end do
   end subroutine sum_joints

   !> Adds the joints of a pair, in the order in which its points meet them.
   pure subroutine find_joints(body_of_node, pair, points, contact, joints, n)
      integer(ip), intent(in) :: body_of_node(:), pair
      type(contact_points_t), intent(in) :: points
      type(contact_result_t), intent(inout) :: contact
      type(joint_t), intent(inout) :: joints(:)
      integer(ip), intent(inout) :: n                       !< joints found so far
      type(joint_t) :: new
      integer(ip) :: before, j, k

      allocate (contact%joint(points%n), contact%follows(points%n))
      before = n
      new%pair = pair
      do j = 1, points%n
         new%bodies(1) = body_of_node(points%node(j))
         new%bodies(2) = 0
         if (.not. points%rigid) new%bodies(2) = body_of_node(points%entry(points%first(j + 1) - 1))
         do k = n, before + 1, -1                           ! most often that of the point before
            if (all(joints(k)%bodies == new%bodies)) exit
         end do
         if (k == before) then
            n = n + 1
            joints(n) = new
            k = n
         end if
         contact%joint(j) = k
         contact%follows(j) = .false.
         if (j == 1) cycle
         ! neighbours carry at least half of the face between them each
         contact%follows(j) = contact%joint(j - 1) == k .and. &
                              points%s(j) - points%s(j - 1) <= (1 + SLACK)*(points%length(j) + points%length(j - 1))
      end do
   end subroutine find_joints

   !> The sums of one joint. Forces are those of the master upon the slave.
   !>
   !> With n the outward normal of the slave, T the same turned by +90 degrees and w the weight of a point
   !>    F = sum w (sigma_T T - p n),   M = sum (x - middle) x w (sigma_T T - p n),
   !> the middle being the mean of x by the weights.
   pure subroutine sum_joint(contact, i, joint)
      type(contact_result_t), intent(in) :: contact         !< its pair
      integer(ip), intent(in) :: i                          !< the joint's number
      type(joint_t), intent(inout) :: joint
      real(wp) :: area, middle(2), normal(2), force(2), moment, at_point(2), arm(2)
      integer(ip) :: j

      area = sum(contact%weight, mask=contact%joint == i)
      middle = weighted_mean(contact, i, contact%x, area)
      normal = weighted_mean(contact, i, contact%normal, area)
      force = 0.0_wp
      moment = 0.0_wp
      do j = 1, contact%n
         if (contact%joint(j) /= i) cycle
         associate (n => contact%normal(:, j), w => contact%weight(j))
            at_point = w*(contact%shear(j)*[-n(2), n(1)] - contact%pressure(j)*n)
         end associate
         arm = contact%x(:, j) - middle
         force = force + at_point
         moment = moment + (arm(1)*at_point(2) - arm(2)*at_point(1))
         joint%length = max(joint%length, norm2(arm))
      end do
      joint%m = moment
      joint%force = norm2(force)
      joint%opening = maxval(contact%gap, mask=contact%joint == i)
      joint%sliding = sum(contact%weight/area*contact%slip, mask=contact%joint == i)
      call place_resultant(contact, i, middle, normal, force, joint)
   end subroutine sum_joint

   pure function weighted_mean(contact, i, values, area) result(mean)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: i                          !< the joint's number
      real(wp), intent(in) :: values(:, :)                  !< (2, n)
      real(wp), intent(in) :: area                          !< sum of the joint's weights [L^2]
      real(wp) :: mean(2)

      mean(1) = sum(contact%weight/area*values(1, :), mask=contact%joint == i)
      mean(2) = sum(contact%weight/area*values(2, :), mask=contact%joint == i)
   end function weighted_mean

   !> The resultant along the mean normal and its tangent, and where it crosses the line through the middle along the tangent: with
   !> the force -n N + t T at the distance e along T the moment is e n.
   pure subroutine place_resultant(contact, i, middle, normal, force, joint)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: i                          !< the joint's number
      real(wp), intent(in) :: middle(2), normal(2), force(2)
      type(joint_t), intent(inout) :: joint
      real(wp) :: along(2), across(2)

      joint%place = ieee_value(1.0_wp, ieee_quiet_nan)
      if (norm2(normal) <= NO_DIRECTION) then
         joint%n = joint%place(1)
         joint%t = joint%place(1)
         return
      end if
      across = normal/norm2(normal)
      along = [-across(2), across(1)]
      joint%n = -dot_product(across, force)
      joint%t = dot_product(along, force)
      if (joint%n <= 0.0_wp) return
      joint%place = middle + (joint%m/joint%n)*along
      joint%u = displacement_at(contact, i, middle, along, joint%m/joint%n)
   end subroutine place_resultant

   !> The slave's displacement at a distance from the middle, linear between the points; beyond the ends that of the end.
   pure function displacement_at(contact, i, middle, along, distance) result(u)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: i                          !< the joint's number
      real(wp), intent(in) :: middle(2), along(2), distance
      real(wp) :: u(2), here, before, share
      integer(ip) :: j, last

      u = 0.0_wp
      last = 0
      before = 0.0_wp
      do j = 1, contact%n
         if (contact%joint(j) /= i) cycle
         here = dot_product(contact%x(:, j) - middle, along)
         if (last == 0 .or. here <= distance) then
            u = contact%u(:, j)
         else if (before <= distance) then
            share = (distance - before)/(here - before)
            u = (1 - share)*contact%u(:, last) + share*contact%u(:, j)
         end if
         last = j
         before = here
      end do
   end function displacement_at

end module atrito_force_sums
