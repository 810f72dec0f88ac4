!> Tractions of contact that balance the loads of bodies which nothing else holds.
module atrito_balanced_contact
   use atrito_contact_segments, only: segment_forces, segment_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_contact_tractions, only: list_segments
   use atrito_displacements, only: add_bilateral_forces
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_ordering, only: build_graph, graph_t, order_contact_last
   use atrito_problem, only: problem_t
   use atrito_profile, only: add_to_profile, begin_profile, close_profile, profile_t
   use atrito_row_entries, only: first_motions, modes_at_node
   use atrito_skyline, only: skyline_t
   use atrito_status, only: is_ok, status_t
   implicit none (type, external)
   private
   public :: balanced_segments, add_joints, add_segments

   real(wp), parameter :: UNBALANCED = 1.0e-10_wp   !< of the forces on a body: more is no balance
   real(wp), parameter :: RATHER = 1000.0_wp        !< ties are changed, not contact

contains

   !> The segments of all pairs with tractions that balance the loads of bodies that can move. They have the resultants of the run,
   !> pair by pair, if this is asked and leaves such a balance; else they are those of the points.
   subroutine balanced_segments(model, problem, solution, keeps, segments, joints, why_not)
      type(model_t), intent(in) :: model
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      logical, intent(in) :: keeps                  !< the resultants
      type(segment_t), allocatable, intent(out) :: segments(:)
      real(wp), allocatable, intent(out) :: joints(:) !< (bilateral rows) forces of ties that balance bodies, too [F]
      character(len=:), allocatable, intent(out) :: why_not
      integer(ip) :: n
      integer :: attempt

      associate (rows => problem%rows, before => problem%rows%n - problem%rows%n_bilateral)
         if (any(rows%first(before + 2:rows%n + 1) - rows%first(before + 1:rows%n) /= 2)) why_not = 'joints of several nodes'
         if (allocated(why_not)) return
         joints = problem%line%weight(before + 1:)*solution%p(before + 1:)
      end associate
      do attempt = merge(1, 2, keeps), 2
         call list_segments(model, problem, solution, attempt == 1, segments, n, why_not)
         if (allocated(why_not)) return
         segments = segments(:n)
         call balance(problem, segments, joints, why_not)
         if (.not. allocated(why_not) .or. attempt == 2) return
         deallocate (why_not)
      end do
   end subroutine balanced_segments

   !> Makes the tractions of contact balance the loads of bodies that can move: by the pressures alone where that is enough, else by
   !> friction, too. The forces of ties, whatever they are, are those of a continuous displacement: they are changed first.
   !>
   !> why_not: no such change leaves pressures positive and friction within its bound.
   subroutine balance(problem, segments, joints, why_not)
      class(problem_t), intent(in) :: problem
      type(segment_t), intent(inout) :: segments(:)
      real(wp), intent(inout) :: joints(:)          !< (bilateral rows) [F]
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp), allocatable :: work(:), size_of(:)
      type(segment_t), allocatable :: changed(:)
      real(wp) :: changed_joints(size(joints))
      integer(ip), allocatable :: first(:)
      logical :: is_found
      integer :: attempt

      first = first_motions(problem%fem%bodies)
      if (first(size(first)) == 1) return
      call work_on_motions(problem, joints, segments, first, work, size_of)
      if (all(abs(work) <= UNBALANCED*size_of)) return
      do attempt = 1, 2
         changed = segments
         changed_joints = joints
         call change_least(problem, first, work, attempt == 2, changed, changed_joints, is_found)
         if (is_found) then
            segments = changed
            joints = changed_joints
            return
         end if
      end do
      why_not = 'tractions that balance a body'
   end subroutine balance

   !> The least change, at every end of a segment
   !>
   !>     p (1 + sum_m c_m z_m),     t + (tau - |t|) sum_m c_m y_m,
   !>
   !> z_m the approach of the sides there by motion m, y_m the same along the sides. The work on the motions is then W + G c = 0,
   !> G_mn = sum over the ends of the forces of p times z_m z_n, and those of tau - |t| times y_m y_n: motions of bodies that touch,
   !> so that their numbers are those of a mesh whose elements are the segments.
   subroutine change_least(problem, first, work, with_friction, segments, joints, is_found)
      class(problem_t), intent(in) :: problem
      integer(ip), intent(in) :: first(:)           !< motions of the bodies
      real(wp), intent(in) :: work(:)               !< W [F L]
      logical, intent(in) :: with_friction
      type(segment_t), intent(inout) :: segments(:)
      real(wp), intent(inout) :: joints(:)
      logical, intent(out) :: is_found
      type(skyline_t) :: gram
      type(profile_t) :: profile
      type(status_t) :: status
      real(wp), allocatable :: change(:), left(:), size_of(:), solved(:, :)
      integer(ip), allocatable :: number(:)
      integer(ip) :: motion(6), n, i, m, end_of, n_motions
      real(wp) :: z(6, 2), force(2), factor(2), most, unit

      n = size(work, kind=ip)
      unit = 0.0_wp
      do i = 1, size(segments, kind=ip)
         unit = max(unit, maxval(segments(i)%p))
      end do
      is_found = unit > 0.0_wp
      if (.not. is_found) return
      unit = scale(1.0_wp, exponent(unit)) ! [F/L^2], a power of two: G and W of any units are of size 1
      call number_motions(problem, segments, first, number, profile)
      call gram%create(profile, status)
      is_found = is_ok(status)
      if (.not. is_found) return
      allocate (solved(n, 1), source=0.0_wp)        ! at first the diagonal
      do i = 1, size(segments, kind=ip)
         do end_of = 1, 2
            call approach_of(problem, segments(i), end_of, first, n_motions, motion, z)
            force = 0.5_wp*segments(i)%length*segments(i)%thickness/unit* &
                    [segments(i)%p(end_of), room_of(segments(i), end_of, with_friction)]
            call add_forces(force)
         end do
      end do
      do i = 1, size(joints, kind=ip)
         call approach_of_joint(problem, i, first, n_motions, motion, z)
         call add_forces([weight_of(problem, i), 0.0_wp])
      end do
      most = maxval(solved)
      do m = 1, n                                   ! what no traction works on keeps what it has
         call gram%add([m], reshape([1.0e-12_wp*most], [1, 1]))
      end do
      call gram%factor(status)
      is_found = is_ok(status)
      if (.not. is_found) return
      solved(number, 1) = -work/unit
      call gram%reduce(solved)
      call gram%expand(solved)
      change = solved(number, 1)
      do i = 1, size(segments, kind=ip)
         do end_of = 1, 2
            call approach_of(problem, segments(i), end_of, first, n_motions, motion, z)
            factor = matmul(change(motion(:n_motions)), z(:n_motions, :))
            associate (p => segments(i)%p(end_of), room => room_of(segments(i), end_of, with_friction))
               if (p > 0.0_wp .and. .not. factor(1) > -1.0_wp) is_found = .false.
               if (room > 0.0_wp .and. .not. abs(factor(2)) <= 1.0_wp) is_found = .false.
               segments(i)%t(end_of) = segments(i)%t(end_of) + room*factor(2)
               p = p*(1 + factor(1))
            end associate
         end do
      end do
      do i = 1, size(joints, kind=ip)
         call approach_of_joint(problem, i, first, n_motions, motion, z)
         joints(i) = joints(i) + unit*weight_of(problem, i)*dot_product(change(motion(:n_motions)), z(:n_motions, 1))
      end do
      call work_on_motions(problem, joints, segments, first, left, size_of)
      is_found = is_found .and. all(abs(left) <= UNBALANCED*size_of)

   contains

      !> What forces along the normal and along the side do to the motions there.
      subroutine add_forces(force)
         real(wp), intent(in) :: force(2)
         real(wp) :: part(6, 6)
         integer(ip) :: k

         do k = 1, n_motions
            part(:n_motions, k) = matmul(z(:n_motions, :), force*z(k, :))
            solved(number(motion(k)), 1) = solved(number(motion(k)), 1) + part(k, k)
         end do
         call gram%add(number(motion(:n_motions)), part(:n_motions, :n_motions))
      end subroutine add_forces

   end subroutine change_least

   !> Numbers of the motions in which those of bodies that touch are near each other, and the profile of G in these numbers.
   subroutine number_motions(problem, segments, first, number, profile)
      class(problem_t), intent(in) :: problem
      type(segment_t), intent(in) :: segments(:)
      integer(ip), intent(in) :: first(:)
      integer(ip), allocatable, intent(out) :: number(:)
      type(profile_t), intent(out) :: profile
      type(graph_t) :: graph
      integer(ip), allocatable :: together(:, :), order(:)
      integer(ip) :: i, n
      real(wp) :: z(6, 2)

      associate (m => size(segments, kind=ip), n_joints => problem%rows%n_bilateral)
         allocate (together(6, m + n_joints), order(first(size(first)) - 1), source=0_ip)
         do i = 1, m + n_joints
            if (i <= m) call approach_of(problem, segments(i), 1, first, n, together(:, i), z)
            if (i > m) call approach_of_joint(problem, i - m, first, n, together(:, i), z)
            together(n + 1:, i) = 0
         end do
      end associate
      call build_graph(size(order, kind=ip), together, graph)
      call order_contact_last(graph, [integer(ip) ::], order)
      allocate (number(size(order)))
      number(order) = [(i, i=1, size(order, kind=ip))]
      call begin_profile(profile, size(order, kind=ip), 0_ip)
      do i = 1, size(together, 2, kind=ip)
         call add_to_profile(profile, number(pack(together(:, i), together(:, i) > 0)))
      end do
      call close_profile(profile)
   end subroutine number_motions

   !> What friction may be more at one end of a segment, in either direction, where it is to change [F/L^2].
   pure real(wp) function room_of(segment, end_of, with_friction)
      type(segment_t), intent(in) :: segment
      integer(ip), intent(in) :: end_of
      logical, intent(in) :: with_friction

      room_of = 0.0_wp
      if (with_friction) room_of = max(segment%tau(end_of) - abs(segment%t(end_of)), 0.0_wp)
   end function room_of

   !> The approach of the sides by the motions of both bodies and what they slip by, where the hat of one end has its force: a third
   !> of the way.
   subroutine approach_of(problem, segment, end_of, first, n, motion, z)
      class(problem_t), intent(in) :: problem
      type(segment_t), intent(in) :: segment
      integer(ip), intent(in) :: end_of, first(:)
      integer(ip), intent(out) :: n, motion(6)
      real(wp), intent(out) :: z(6, 2)              !< along the normal, along the side
      integer(ip) :: side, b, m
      real(wp) :: at, modes(2, 3), share(2)

      n = 0
      share = merge(2.0_wp, 1.0_wp, [end_of == 1, end_of == 2])/3
      do side = 1, 2
         if (side == 2 .and. segment%master(1) == 0) exit
         associate (nodes => merge(segment%node, segment%master_node, side == 1), &
                    places => merge(segment%on_slave, segment%on_master, side == 1))
            b = problem%fem%bodies%of_node(nodes(1))
            at = dot_product(share, places)
            modes = (1 - at)*modes_at_node(problem%fem, b, nodes(1)) + at*modes_at_node(problem%fem, b, nodes(2))
            do m = first(b), first(b + 1) - 1
               n = n + 1
               motion(n) = m
               z(n, :) = merge(-1, 1, side == 1)*[dot_product(segment%normal, modes(:, m - first(b) + 1)), &
                                                  dot_product([-segment%normal(2), segment%normal(1)], modes(:, m - first(b) + 1))]
            end do
         end associate
      end do
   end subroutine approach_of

   !> How far the force of a bilateral row gives way where bodies are to balance [L^2].
   pure real(wp) function weight_of(problem, i)
      class(problem_t), intent(in) :: problem
      integer(ip), intent(in) :: i                  !< row

      weight_of = RATHER*problem%line%weight(problem%rows%n - problem%rows%n_bilateral + i)
   end function weight_of

   !> The work on the motions of both bodies that the force of a bilateral row does.
   subroutine approach_of_joint(problem, i, first, n, motion, z)
      class(problem_t), intent(in) :: problem
      integer(ip), intent(in) :: i, first(:)        !< row
      integer(ip), intent(out) :: n, motion(6)
      real(wp), intent(out) :: z(6, 2)
      real(wp) :: modes(2, 3)
      integer(ip) :: j, k, b, m

      n = 0
      z = 0.0_wp
      j = problem%rows%n - problem%rows%n_bilateral + i
      do k = problem%rows%first(j), problem%rows%first(j) + 1
         associate (node => problem%rows%node(k), v => problem%rows%vector(:, k - problem%rows%before_vectors))
            b = problem%fem%bodies%of_node(node)
            modes = modes_at_node(problem%fem, b, node)
            do m = first(b), first(b + 1) - 1
               n = n + 1
               motion(n) = m
               z(n, 1) = -dot_product(v, modes(:, m - first(b) + 1))
            end do
         end associate
      end do
   end subroutine approach_of_joint

   !> The work of loads, ties and tractions of contact on the rigid motions that supports leave, and the size of what it sums up.
   subroutine work_on_motions(problem, joints, segments, first, work, size_of)
      class(problem_t), intent(in) :: problem
      real(wp), intent(in) :: joints(:)             !< (bilateral rows) [F]
      type(segment_t), intent(in) :: segments(:)
      integer(ip), intent(in) :: first(:)
      real(wp), allocatable, intent(out) :: work(:), size_of(:)
      real(wp), allocatable :: force(:, :)

      force = problem%f
      call add_joints(problem, joints, -1.0_wp, force)
      call add_segments(segments, force)
      call sum_works(force)

   contains

      subroutine sum_works(force)
         real(wp), intent(in) :: force(:, :)
         real(wp) :: z(2, 3)
         integer(ip) :: b, i, m

         allocate (work(first(size(first)) - 1), size_of(first(size(first)) - 1), source=0.0_wp)
         do b = 1, problem%fem%bodies%n
            if (first(b + 1) == first(b)) cycle
            do i = 1, size(problem%fem%bodies%list(b)%nodes, kind=ip)
               associate (node => problem%fem%bodies%list(b)%nodes(i))
                  z = modes_at_node(problem%fem, b, node)
                  do m = first(b), first(b + 1) - 1
                     work(m) = work(m) + dot_product(z(:, m - first(b) + 1), force(:, node))
                     size_of(m) = size_of(m) + dot_product(abs(z(:, m - first(b) + 1)), abs(force(:, node)))
                  end do
               end associate
            end do
         end do
      end subroutine sum_works

   end subroutine work_on_motions

   !> Adds what joints take from the loads, times a factor.
   subroutine add_joints(problem, joints, factor, force)
      class(problem_t), intent(in) :: problem
      real(wp), intent(in) :: joints(:), factor     !< (bilateral rows) [F]
      real(wp), intent(inout) :: force(:, :)        !< (2, n_nodes) [F]
      real(wp) :: q(problem%rows%n)
      integer(ip) :: j

      if (size(joints) == 0) return
      q(problem%rows%n - size(joints) + 1:) = factor*joints
      call add_bilateral_forces(problem%rows, [(.true., j=1, size(joints))], q, force)
   end subroutine add_joints

   !> Adds the forces of the tractions of contact on the nodes of both sides.
   subroutine add_segments(segments, force)
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(inout) :: force(:, :)        !< (2, n_nodes) [F]
      real(wp) :: on_slave(2, 3), on_master(2, 3)
      integer(ip) :: i

      do i = 1, size(segments, kind=ip)
         call segment_forces(segments(i), on_slave, on_master)
         associate (slave => segments(i)%node(:segments(i)%n), master => segments(i)%master_node(:segments(i)%n_master))
            force(:, slave) = force(:, slave) + on_slave(:, :size(slave))
            force(:, master) = force(:, master) + on_master(:, :size(master))
         end associate
      end do
   end subroutine add_segments

end module atrito_balanced_contact
