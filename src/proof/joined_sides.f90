!> Contact sides with their states held, as a linear problem has them: joined along the normal where a face is closed at all its
!> nodes, along T where it sticks at all of them, and loaded elsewhere by the tractions that were found.
!>
!> Joined sides have the jump of displacements that the gap (along T the rest slip) prescribes, or it gives way by c times the
!> traction, c = delta, or along T eps/tau or 1/k:
!>
!>     u_n - s = delta p,     u_T - rest = c t,     of either sign.                                                    (1)
!>
!> Stresses and displacements that do not belong to each other differ there by the energy int ((u_n - s) - delta p)^2/delta, and the
!> same along T; without compliance (1) is a condition on the displacements.
module atrito_joined_sides
   use atrito_balanced_contact, only: add_segments
   use atrito_bound_qp, only: FREE
   use atrito_contact_segments, only: between, overlap_at, segment_forces, segment_t, slip_at
   use atrito_contact_solution, only: contact_solution_t
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_kinds, only: ip, wp
   use atrito_problem, only: problem_t
   implicit none (type, external)
   private
   public :: joints_t, find_joints, tractions_of_forces, forces_of_held, interface_energy, interface_product, misfit_of_joints

   !> Where sides are joined: along the normal (1), along T (2).
   type :: joints_t
      logical, allocatable :: joined(:, :)          !< (2, segments)
      integer(ip), allocatable :: point(:, :)       !< (2, segments) at both ends, of the contact line; 0: none
      integer(ip), allocatable :: on_face(:, :)     !< (3, segments) the same at the nodes of its face
      integer(ip), allocatable :: row(:, :)         !< (2, points) 0: none
      integer(ip) :: n_rows = 0
      integer(ip), allocatable :: slave(:), master(:) !< (rows) nodes; master 0: rigid
      real(wp), allocatable :: direction(:, :)      !< (2, rows)
      real(wp), allocatable :: weight(:)            !< (rows) area that the row stands for [L^2]
      real(wp), allocatable :: compliance(:)        !< (rows) [L/F]
   end type joints_t

   integer, parameter :: ROUNDS = 60                !< of the fit of tractions to forces: each halves what is missing
   real(wp), parameter :: PACE = 1.5_wp
   !> Three Gauss points on [0,1].
   real(wp), parameter :: GAUSS_PLACES(3) = 0.5_wp + 0.38729833462074168852_wp*[real(wp) :: -1, 0, 1]
   real(wp), parameter :: GAUSS_WEIGHTS(3) = [real(wp) :: 5, 8, 5]/18

contains

   !> Which segments are joined, and a row for each node of them and direction. why_not: sides are joined that do not match.
   subroutine find_joints(problem, solution, segments, joints, why_not)
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      type(segment_t), intent(inout) :: segments(:) !< of all pairs; tau becomes that of the points where they are joined
      type(joints_t), intent(out) :: joints
      character(len=:), allocatable, intent(inout) :: why_not
      logical :: is_matched
      integer(ip) :: i, d, j

      allocate (joints%joined(2, size(segments)), source=.false.)
      allocate (joints%point(2, size(segments)), joints%on_face(3, size(segments)), source=0_ip)
      allocate (joints%row(2, problem%line%n), source=0_ip)
      call list_points(problem, segments, joints)
      is_matched = .true.
      do i = 1, size(segments, kind=ip)
         associate (points => joints%on_face(:segments(i)%n, i))
            if (any(points == 0)) cycle
            joints%joined(1, i) = all(solution%p(points) > 0.0_wp)
            joints%joined(2, i) = joints%joined(1, i) .and. all([(sticks(points(j)), j=1, size(points, kind=ip))])
            if (.not. joints%joined(1, i)) cycle
            is_matched = is_matched .and. all([(faces_node(problem, segments(i), points(j)), j=1, size(points, kind=ip))])
            joints%point(:, i) = points(:2)
            if (segments(i)%n == 3 .and. sum(segments(i)%on_slave) < 1.0_wp) joints%point(2, i) = points(3)
            if (segments(i)%n == 3 .and. sum(segments(i)%on_slave) > 1.0_wp) joints%point(1, i) = points(3)
            segments(i)%tau = solution%tau(joints%point(:, i))
         end associate
      end do
      if (is_matched) call number_rows(problem, segments, joints)
      do i = 1, size(segments, kind=ip)             ! a face of which a part faces nothing
         do d = 1, 2
            if (joints%joined(d, i)) is_matched = is_matched .and. all(joints%row(d, joints%on_face(:segments(i)%n, i)) > 0)
         end do
      end do
      if (.not. is_matched) why_not = 'joined sides that do not match'

   contains

      logical function sticks(j)
         integer(ip), intent(in) :: j               !< point

         sticks = problem%line%tangential(j) > 0 .and. problem%line%law(j)%kind /= FRICTION_NONE .and. solution%tau(j) > 0.0_wp
         if (sticks) sticks = solution%state%state(problem%line%tangential(j)) == FREE
      end function sticks

   end subroutine find_joints

   !> The points at the nodes of the faces.
   subroutine list_points(problem, segments, joints)
      class(problem_t), intent(in) :: problem
      type(segment_t), intent(in) :: segments(:)
      type(joints_t), intent(inout) :: joints
      integer(ip) :: point(size(problem%held, 2)), pair, first, k

      first = 0
      do pair = 1, size(problem%points, kind=ip)
         associate (points => problem%points(pair))
            point = 0
            do k = 1, points%n
               point(points%node(k)) = first + k
            end do
            do k = 1, size(segments, kind=ip)
               if (segments(k)%pair == pair) joints%on_face(:segments(k)%n, k) = point(segments(k)%node(:segments(k)%n))
            end do
            first = first + points%n
         end associate
      end do
   end subroutine list_points

   !> Whether a point of a segment's face faces a node of the master's face, or a rigid one.
   pure logical function faces_node(problem, segment, j)
      class(problem_t), intent(in) :: problem
      type(segment_t), intent(in) :: segment
      integer(ip), intent(in) :: j                  !< point
      real(wp), parameter :: ROUND_OFF = 1.0e-9_wp
      integer(ip) :: k

      faces_node = .not. allocated(problem%rows%turn) .and. (segment%n == segment%n_master .or. segment%master(1) == 0)
      do k = problem%rows%first(j), problem%rows%first(j + 1) - 1
         associate (share => problem%rows%coefficient(k), node => problem%rows%node(k))
            if (abs(share) <= ROUND_OFF) cycle
            if (abs(abs(share) - 1.0_wp) > ROUND_OFF) faces_node = .false.
            if (share < 0.0_wp .and. .not. any(segment%master_node(:segment%n_master) == node)) faces_node = .false.
         end associate
      end do
   end function faces_node

   !> A row for each point and direction that is joined, with its nodes, and the area that it stands for.
   subroutine number_rows(problem, segments, joints)
      class(problem_t), intent(in) :: problem
      type(segment_t), intent(in) :: segments(:)
      type(joints_t), intent(inout) :: joints
      real(wp) :: tau
      integer(ip) :: i, d, e, j, k

      joints%n_rows = 0
      do i = 1, size(segments, kind=ip)
         do d = 1, 2
            do e = 1, merge(2, 0, joints%joined(d, i))
               associate (row => joints%row(d, joints%point(e, i)))
                  if (row > 0) cycle
                  joints%n_rows = joints%n_rows + 1
                  row = joints%n_rows
               end associate
            end do
         end do
      end do
      associate (n => joints%n_rows)
         allocate (joints%slave(n), joints%master(n), source=0_ip)
         allocate (joints%direction(2, n), joints%weight(n), joints%compliance(n), source=0.0_wp)
      end associate
      do i = 1, size(segments, kind=ip)
         do d = 1, 2
            do e = 1, merge(2, 0, joints%joined(d, i))
               j = joints%point(e, i)
               associate (row => joints%row(d, j))
                  do k = problem%rows%first(j), problem%rows%first(j + 1) - 1
                     if (problem%rows%coefficient(k) > 0.5_wp) joints%slave(row) = problem%rows%node(k)
                     if (problem%rows%coefficient(k) < -0.5_wp) joints%master(row) = problem%rows%node(k)
                  end do
                  joints%direction(:, row) = problem%rows%normal(:, j)
                  if (d == 2) joints%direction(:, row) = problem%rows%tangent(:, j)
                  joints%weight(row) = joints%weight(row) + 0.5_wp*segments(i)%length*segments(i)%thickness
                  tau = segments(i)%tau(e)
                  joints%compliance(row) = segments(i)%delta
                  if (d == 2) joints%compliance(row) = compliance_along(segments(i), tau)
               end associate
            end do
         end do
      end do
      joints%compliance = joints%compliance/joints%weight
   end subroutine number_rows

   !> Slip over shear below the bound tau [L^3/F].
   pure real(wp) function compliance_along(segment, tau)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: tau                   !< [F/L^2]

      compliance_along = segment%compliance
      if (segment%eps > 0.0_wp) compliance_along = compliance_along + segment%eps/tau
   end function compliance_along

   !> The tractions of joined sides, linear from point to point, whose forces on the nodes of the slave are given; elsewhere there
   !> are none.
   !>
   !> The matrix of int N_i phi_j over its row sums has values from 1/3 to 1: each round halves what is missing.
   subroutine tractions_of_forces(joints, q, segments)
      type(joints_t), intent(in) :: joints
      real(wp), intent(in) :: q(:)                  !< (rows) [F]
      type(segment_t), intent(inout) :: segments(:) !< p and t are set
      real(wp) :: stress(joints%n_rows), sums(joints%n_rows)
      integer :: round

      stress = 1.0_wp
      call put(stress)
      sums = forces_of()
      stress = q/sums
      do round = 1, ROUNDS
         call put(stress)
         stress = stress + PACE*(q - forces_of())/sums
      end do
      call put(stress)

   contains

      subroutine put(stress)
         real(wp), intent(in) :: stress(:)
         integer(ip) :: i

         do i = 1, size(segments, kind=ip)
            segments(i)%p = 0.0_wp
            segments(i)%t = 0.0_wp
            if (joints%joined(1, i)) segments(i)%p = stress(joints%row(1, joints%point(:, i)))
            if (joints%joined(2, i)) segments(i)%t = stress(joints%row(2, joints%point(:, i)))
         end do
      end subroutine put

      !> int N_i p, or t, of each row.
      function forces_of() result(force)
         real(wp) :: force(joints%n_rows)
         real(wp) :: on_slave(2, 3), on_master(2, 3)
         integer(ip) :: i, d, k, row

         force = 0.0_wp
         do i = 1, size(segments, kind=ip)
            if (.not. joints%joined(1, i)) cycle
            call segment_forces(segments(i), on_slave, on_master)
            do d = 1, 2
               if (.not. joints%joined(d, i)) cycle
               do k = 1, segments(i)%n
                  row = joints%row(d, joints%on_face(k, i))
                  force(row) = force(row) - dot_product(on_slave(:, k), joints%direction(:, row))
               end do
            end do
         end do
      end function forces_of

   end subroutine tractions_of_forces

   !> The forces of the tractions that are held, not joined, on the nodes of both sides.
   subroutine forces_of_held(joints, segments, force)
      type(joints_t), intent(in) :: joints
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(inout) :: force(:, :)        !< (2, n_nodes) to which they are added [F]
      type(segment_t) :: held(size(segments))
      integer(ip) :: i

      held = segments
      do i = 1, size(held, kind=ip)
         if (joints%joined(1, i)) held(i)%p = 0.0_wp
         if (joints%joined(2, i)) held(i)%t = 0.0_wp
      end do
      call add_segments(held, force)
   end subroutine forces_of_held

   !> By how much displacements miss the jump (1) of joined sides without compliance [L].
   pure real(wp) function misfit_of_joints(joints, segments, u) result(most)
      type(joints_t), intent(in) :: joints
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      integer(ip) :: i, k

      most = 0.0_wp
      do i = 1, size(segments, kind=ip)
         do k = 0, 2
            if (joints%joined(1, i) .and. .not. segments(i)%delta > 0.0_wp) then
               most = max(most, abs(overlap_at(segments(i), u, 0.5_wp*k)))
            end if
            if (joints%joined(2, i) .and. .not. (segments(i)%eps > 0.0_wp .or. segments(i)%compliance > 0.0_wp)) then
               most = max(most, abs(slip_at(segments(i), u, 0.5_wp*k)))
            end if
         end do
      end do
   end function misfit_of_joints

   !> The energy by which tractions and displacements of joined sides differ; where the compliance along T varies it is not less.
   pure real(wp) function interface_energy(joints, segments, u) result(energy)
      type(joints_t), intent(in) :: joints
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      integer(ip) :: i, k
      real(wp) :: at, c, more

      energy = 0.0_wp
      do i = 1, size(segments, kind=ip)
         associate (s => segments(i))
            do k = 1, 3
               at = GAUSS_PLACES(k)
               associate (weight => GAUSS_WEIGHTS(k)*s%length*s%thickness)
                  if (joints%joined(1, i) .and. s%delta > 0.0_wp) then
                     energy = energy + weight*(overlap_at(s, u, at) - s%delta*between(s%p, at))**2/s%delta
                  end if
                  if (.not. joints%joined(2, i)) cycle
                  c = compliance_along(s, between(s%tau, at))
                  if (.not. c > 0.0_wp) cycle
                  ! 1/tau is not more than linear between its ends
                  more = 0.0_wp
                  if (s%eps > 0.0_wp) more = max(between(s%compliance + s%eps/s%tau, at) - c, 0.0_wp)
                  energy = energy + weight*((slip_at(s, u, at) - c*between(s%t, at))**2/c + more*between(s%t, at)**2)
               end associate
            end do
         end associate
      end do
   end function interface_energy

   !> The work of the tractions that the jumps of u make on joined sides on those of z: int (u_n - s) (z_n - s')/delta, and along T.
   pure real(wp) function interface_product(joints, segments, u, others, z) result(product_of)
      type(joints_t), intent(in) :: joints
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(segment_t), intent(in) :: others(:)      !< the same ones with the gaps and rest slips of z
      real(wp), intent(in) :: z(:, :)               !< (2, n_nodes) [L]
      integer(ip) :: i, k
      real(wp) :: at, c

      product_of = 0.0_wp
      do i = 1, size(segments, kind=ip)
         associate (s => segments(i))
            do k = 1, 3
               at = GAUSS_PLACES(k)
               associate (weight => GAUSS_WEIGHTS(k)*s%length*s%thickness)
                  if (joints%joined(1, i) .and. s%delta > 0.0_wp) then
                     product_of = product_of + weight*overlap_at(s, u, at)*overlap_at(others(i), z, at)/s%delta
                  end if
                  if (.not. joints%joined(2, i)) cycle
                  c = compliance_along(s, between(s%tau, at))
                  if (c > 0.0_wp) product_of = product_of + weight*slip_at(s, u, at)*slip_at(others(i), z, at)/c
               end associate
            end do
         end associate
      end do
   end function interface_product

end module atrito_joined_sides
