!> Contact as the bound of the error sees it: tractions of both sides that the law allows, and what the law lacks of being met.
!>
!> Along a slave with straight faces the pressures p_j and shears t_j of the points are taken as linear from node to node: p >= 0,
!> and |t| <= tau with the bounds tau_j linear, too. With potentials of the law and their conjugates (Fenchel),
!>
!>     psi_n(g) = (g+)^2/(2 delta),  psi_n*(p) = delta p^2/2;      psi_t(r) = tau phi_eps(|r|),  psi_t*(t) = eps t^2/(2 tau),
!(1) >
!> g = u_n - s and r the slip, the brackets of
!>
!>     gap = int [psi_n(g) + psi_n*(p) - p g] + [psi_t(r) + psi_t*(t) - t r] ds
!(2) >
!> are never negative, and 0 where the law is met. Without delta (1) has g <= 0 as a condition: displacements that break it between
!> points are corrected by moving the slave's nodes back along the normal (`keep_apart`).
!>
!> The slave's faces are cut where they face nodes of the master (segments), so that all that stands in (2) is linear on a segment.
module atrito_contact_tractions
   use atrito_contact_line, only: rest_of
   use atrito_face_geometry, only: outward_normal
   use atrito_faces, only: face_list_t
   use atrito_friction_law, only: FRICTION_NONE, FRICTION_NONLOCAL
   use atrito_growth, only: make_room
   use atrito_kinds, only: ip, wp
   use atrito_master, only: master_t, look_along
   use atrito_mesh, only: face_nodes
   use atrito_model, only: model_t, SURFACE_SEGMENTS
   use atrito_mortar_segments, only: segments_t, cut_slave
   use atrito_pairing, only: make_master
   use atrito_pieces, only: cross, normal_at
   use atrito_problem, only: problem_t
   use atrito_contact_solution, only: contact_solution_t
   implicit none (type, external)
   private
   public :: segment_t, list_segments, segment_forces, law_gap, keep_apart, slip_at, overlap_at

   !> A part of a slave's face that faces one face of the master. Arrays of two: at its ends.
   type :: segment_t
      integer(ip) :: pair = 0
      integer(ip) :: slave(2) = 0, master(2) = 0    !< element and face; master 0: rigid
      integer(ip) :: node(2) = 0, master_node(2) = 0 !< of these faces
      real(wp) :: on_slave(2) = 0.0_wp, on_master(2) = 0.0_wp       !< places on the faces, 0 to 1
      real(wp) :: length = 0.0_wp                   !< on the slave [L]
      real(wp) :: thickness = 0.0_wp                !< [L]
      real(wp) :: normal(2) = 0.0_wp                !< out of the slave
      real(wp) :: p(2) = 0.0_wp, t(2) = 0.0_wp      !< pressure, shear on the master along T [F/L^2]
      real(wp) :: tau(2) = 0.0_wp                   !< friction bound [F/L^2]
      real(wp) :: gap(2) = 0.0_wp                   !< s [L]
      real(wp) :: delta = 0.0_wp                    !< [L^3/F]
      real(wp) :: eps = 0.0_wp                      !< largest slip of a sticking point where it does not depend on tau [L]
      real(wp) :: compliance = 0.0_wp               !< and over tau where it does [L^3/F]
      real(wp) :: rest(2) = 0.0_wp                  !< slip at which there is no shear [L]
   end type segment_t

   real(wp), parameter :: SAME_DIRECTION = 1.0e-6_wp

contains

   !> The segments of all pairs, with the stresses of a solution.
   !>
   !> why_not: what (2) cannot be had for, in words; not allocated: nothing.
   subroutine list_segments(model, problem, solution, segments, n, why_not)
      type(model_t), intent(in) :: model
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      type(segment_t), allocatable, intent(out) :: segments(:)
      integer(ip), intent(out) :: n
      character(len=:), allocatable, intent(inout) :: why_not
      integer(ip), allocatable :: point(:)          !< (n_nodes) of the pair
      type(master_t) :: master
      type(segments_t) :: cuts
      type(segment_t) :: one
      integer(ip) :: i, k, f, first

      n = 0
      first = 0
      allocate (segments(0))
      allocate (point(size(problem%held, 2)), source=0_ip)
      do i = 1, size(problem%points, kind=ip)
         associate (pair => model%pairs(i), points => problem%points(i))
            if (points%n > 0) then
               do k = 1, points%n
                  point(points%node(k)) = first + k
               end do
               call make_master(model, pair%master, master)
               associate (faces => model%surfaces(pair%slave)%faces)
                  call cut_slave(model%mesh, faces, master, cuts)
                  do f = 1, faces%n
                     do k = cuts%first(f), cuts%first(f + 1) - 1
                        call make_segment(f, cuts%piece(k), 0.5_wp*(1 + [cuts%from(k), cuts%to(k)]), one)
                        if (allocated(why_not)) return
                        if (.not. any(point(one%node) > 0)) cycle
                        call add_segment(one)
                     end do
                  end do
               end associate
               point(points%node(:points%n)) = 0
            end if
            first = first + points%n
         end associate
      end do

   contains

      !> A part of face f that faces a piece of the master.
      subroutine make_segment(f, piece, places, segment)
         integer(ip), intent(in) :: f, piece
         real(wp), intent(in) :: places(2)
         type(segment_t), intent(out) :: segment
         real(wp) :: x(2), distance, at
         integer(ip) :: j

         associate (pair => model%pairs(i), points => problem%points(i), mesh => model%mesh, &
                    surface => model%surfaces(model%pairs(i)%slave))
            segment%pair = i
            segment%slave = [surface%faces%element(f), surface%faces%face(f)]
            associate (nodes => face_nodes(mesh, segment%slave(1), segment%slave(2)))
               if (size(nodes) > 2) then
                  why_not = 'contact sides of the second degree'
                  return
               end if
               segment%node = nodes(:2)
            end associate
            segment%on_slave = places
            segment%normal = outward_normal(mesh%x(:, segment%node), 0.0_wp)
            segment%length = (places(2) - places(1))*norm2(mesh%x(:, segment%node(2)) - mesh%x(:, segment%node(1)))
            segment%thickness = model%sections(model%section_of(segment%slave(1)))%thickness
            if (model%surfaces(pair%master)%kind /= SURFACE_SEGMENTS) then
               associate (faces => model%surfaces(pair%master)%faces)
                  segment%master = [faces%element(piece), faces%face(piece)]
                  associate (nodes => face_nodes(mesh, segment%master(1), segment%master(2)))
                     segment%master_node = nodes(:2)
                     if (size(nodes) > 2) why_not = 'contact sides of the second degree'
                  end associate
               end associate
            end if
            if (abs(dot_product(normal_at(master, piece, 0.5_wp), segment%normal) + 1) > SAME_DIRECTION .and. &
                .not. pair%gap_is_given) why_not = 'contact sides that are not parallel'
            do j = 1, 2
               if (point(segment%node(j)) == 0) cycle
               if (norm2(problem%rows%normal(:, point(segment%node(j))) - segment%normal) > SAME_DIRECTION) then
                  why_not = 'curved contact sides'
               end if
            end do
            if (allocated(why_not)) return
            do j = 1, 2
               x = mesh%x(:, segment%node(1)) + places(j)*(mesh%x(:, segment%node(2)) - mesh%x(:, segment%node(1)))
               ! where the normal meets the master's piece: x + distance n = a + at d
               at = cross(x - master%a(:, piece), segment%normal)/cross(master%d(:, piece), segment%normal)
               distance = dot_product(master%a(:, piece) + at*master%d(:, piece) - x, segment%normal)
               segment%on_master(j) = min(max(at, 0.0_wp), 1.0_wp)
               segment%gap(j) = distance
            end do
            if (points%matching .or. pair%gap_is_given) segment%gap = along(problem%rows%gap)
            segment%p = along(max(solution%p, 0.0_wp))
            segment%t = along(solution%t)
            segment%tau = along(solution%tau)
            segment%rest = 0.0_wp
            if (allocated(problem%line%rest)) segment%rest = along(problem%line%rest)
            j = maxval(point(segment%node))
            segment%delta = problem%line%delta(j)
            associate (law => problem%line%law(j))
               if (law%kind == FRICTION_NONE) segment%tau = 0.0_wp
               if (law%kind == FRICTION_NONLOCAL) segment%eps = law%eps
               if (law%kind /= FRICTION_NONLOCAL) segment%compliance = law%compliance
            end associate
         end associate
      end subroutine make_segment

      !> The values of points at both ends of the segment; 0 at a node without a point.
      function along(of_points) result(values)
         real(wp), intent(in) :: of_points(:)
         real(wp) :: values(2)
         real(wp) :: at_nodes(2)
         integer(ip) :: j

         at_nodes = 0.0_wp
         do j = 1, 2
            if (point(one%node(j)) > 0) at_nodes(j) = of_points(point(one%node(j)))
         end do
         values = (1 - one%on_slave)*at_nodes(1) + one%on_slave*at_nodes(2)
      end function along

      subroutine add_segment(segment)
         type(segment_t), intent(in) :: segment
         type(segment_t), allocatable :: longer(:)

         if (n == size(segments)) then
            allocate (longer(2*n + 64))
            longer(:n) = segments(:n)
            call move_alloc(longer, segments)
         end if
         n = n + 1
         segments(n) = segment
      end subroutine add_segment

   end subroutine list_segments

   !> int T N_i ds on both sides: the forces of a segment's tractions on the nodes of the slave's face and of the master's.
   pure subroutine segment_forces(segment, on_slave, on_master)
      type(segment_t), intent(in) :: segment
      real(wp), intent(out) :: on_slave(2, 2), on_master(2, 2)      !< (component, node) [F]
      real(wp), parameter :: HALF = 0.28867513459481288225_wp
      real(wp) :: t, force(2), place
      integer :: k

      on_slave = 0.0_wp
      on_master = 0.0_wp
      do k = 1, 2                                   ! two Gauss points: linear times linear
         t = 0.5_wp + merge(-HALF, HALF, k == 1)
         force = -0.5_wp*segment%length*segment%thickness*(between(segment%p, t)*segment%normal + &
                                                           between(segment%t, t)*[-segment%normal(2), segment%normal(1)])
         place = between(segment%on_slave, t)
         on_slave(:, 1) = on_slave(:, 1) + (1 - place)*force
         on_slave(:, 2) = on_slave(:, 2) + place*force
         place = between(segment%on_master, t)
         on_master(:, 1) = on_master(:, 1) - (1 - place)*force
         on_master(:, 2) = on_master(:, 2) - place*force
      end do
   end subroutine segment_forces

   pure real(wp) function between(values, t)
      real(wp), intent(in) :: values(2), t

      between = (1 - t)*values(1) + t*values(2)
   end function between

   !> u_n - s at both ends of a segment [L].
   pure function overlap_at(segment, u) result(g)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp) :: g(2)

      g = [dot_product(segment%normal, relative(segment, u, 1)), dot_product(segment%normal, relative(segment, u, 2))] - segment%gap
   end function overlap_at

   !> The slip at both ends, from where there is no shear [L].
   pure function slip_at(segment, u) result(r)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)
      real(wp) :: r(2)
      real(wp) :: along(2)

      along = [-segment%normal(2), segment%normal(1)]
      r = [dot_product(along, relative(segment, u, 1)), dot_product(along, relative(segment, u, 2))] - segment%rest
   end function slip_at

   !> The displacement of the slave against the master at an end.
   pure function relative(segment, u, k) result(d)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)
      integer, intent(in) :: k
      real(wp) :: d(2)

      associate (s => segment%on_slave(k), m => segment%on_master(k))
         d = (1 - s)*u(:, segment%node(1)) + s*u(:, segment%node(2))
         if (segment%master(1) > 0) d = d - ((1 - m)*u(:, segment%master_node(1)) + m*u(:, segment%master_node(2)))
      end associate
   end function relative

   !> (2), twice, of one segment: the part of the normal law and that of friction [F L].
   subroutine law_gap(segment, u, normal, tangential)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(out) :: normal, tangential
      real(wp), parameter :: PLACE = 0.77459666924148337704_wp, WEIGHTS(3) = [5.0_wp, 8.0_wp, 5.0_wp]/18
      real(wp) :: g(2), r(2), cuts(7), a, b, t, w, slip, full, tau, shear
      integer :: k, l, n

      g = overlap_at(segment, u)
      r = slip_at(segment, u)
      n = 2
      cuts(:2) = [0.0_wp, 1.0_wp]
      call cut_at(g)
      call cut_at(r)
      call cut_at(r - (segment%eps + segment%compliance*segment%tau))
      call cut_at(r + (segment%eps + segment%compliance*segment%tau))
      call sort(cuts(:n))
      normal = 0.0_wp
      tangential = 0.0_wp
      do k = 1, n - 1
         a = cuts(k)
         b = cuts(k + 1)
         do l = 1, 3
            t = 0.5_wp*(a + b) + 0.5_wp*(b - a)*PLACE*(l - 2)
            w = 2*(b - a)*WEIGHTS(l)*segment%length*segment%thickness
            associate (overlap => between(g, t), p => between(segment%p, t))
               if (segment%delta > 0.0_wp) then
                  normal = normal + w*(max(overlap, 0.0_wp) - segment%delta*p)**2/(2*segment%delta) + w*p*max(-overlap, 0.0_wp)
               else
                  normal = normal - w*p*overlap
               end if
            end associate
            tau = between(segment%tau, t)
            if (.not. tau > 0.0_wp) cycle
            slip = between(r, t)
            shear = between(segment%t, t)
            full = segment%eps + segment%compliance*tau
            if (full > 0.0_wp) then
               if (abs(slip) <= full) then
                  tangential = tangential + w*(slip - full*shear/tau)**2*tau/(2*full)
               else
                  tangential = tangential + w*(tau*(abs(slip) - 0.5_wp*full) + 0.5_wp*full*shear**2/tau - shear*slip)
               end if
            else
               tangential = tangential + w*max(tau*abs(slip) - shear*slip, 0.0_wp)    ! below 0 it is round-off
            end if
         end do
      end do

   contains

      !> Adds the zero of a linear function.
      subroutine cut_at(values)
         real(wp), intent(in) :: values(2)

         if (.not. (values(1) < 0.0_wp .neqv. values(2) < 0.0_wp)) return
         n = n + 1
         cuts(n) = values(1)/(values(1) - values(2))
      end subroutine cut_at

      pure subroutine sort(list)
         real(wp), intent(inout) :: list(:)
         integer :: i, j
         real(wp) :: x

         do i = 2, size(list)
            x = list(i)
            do j = i - 1, 1, -1
               if (list(j) <= x) exit
               list(j + 1) = list(j)
            end do
            list(j + 1) = x
         end do
      end subroutine sort

   end subroutine law_gap

   !> Moves nodes of slaves back along the normal, so that nowhere u_n - s is larger than delta p.
   !>
   !> why_not: a support that does not let a node move.
   subroutine keep_apart(segments, held, u, why_not)
      type(segment_t), intent(in) :: segments(:)
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      real(wp), intent(inout) :: u(:, :)            !< (2, n_nodes) [L]
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp), parameter :: ROUND_OFF = 1.0e-13_wp
      real(wp), allocatable :: back(:)
      real(wp) :: beyond, none
      integer(ip) :: i, k

      allocate (back(size(u, 2)), source=0.0_wp)
      none = ROUND_OFF*maxval(abs(u))
      do i = 1, size(segments, kind=ip)
         beyond = maxval(overlap_at(segments(i), u) - segments(i)%delta*segments(i)%p)
         if (beyond > none) back(segments(i)%node) = max(back(segments(i)%node), beyond)
      end do
      if (all(back == 0.0_wp)) return
      do i = 1, size(segments, kind=ip)
         do k = 1, 2
            associate (node => segments(i)%node(k))
               if (.not. back(node) > 0.0_wp) cycle
               if (any(held(:, node) .and. abs(segments(i)%normal) > SAME_DIRECTION)) then
                  why_not = 'a support holds a node of a slave that would have to be moved back'
                  return
               end if
               u(:, node) = u(:, node) - back(node)*segments(i)%normal
               back(node) = 0.0_wp
            end associate
         end do
      end do
   end subroutine keep_apart

end module atrito_contact_tractions
