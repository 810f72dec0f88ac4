!> Contact as the bound of the error sees it: tractions of both sides that the law allows.
!>
!> Along a slave with straight faces the pressures p_j and shears t_j of the points are taken as linear from node to node: p >= 0,
!> and |t| <= tau with the bounds tau_j linear, too. All of a pair may be multiplied so that resultant and moment are those of the
!> run; else those of a face of three nodes are, so that it has the resultant of Simpson's rule.
!>
!> The slave's faces are cut where they face nodes of the master (segments), so that gaps, stresses and, of faces of two nodes,
!> displacements are linear on a segment. What the law lacks of being met there: atrito_law_lack.
module atrito_contact_tractions
   use atrito_assembly, only: fem_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_contact_segments, only: along, between, segment_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_element_table, only: DEGREE_OF
   use atrito_face_geometry, only: outward_normal
   use atrito_friction_law, only: FRICTION_NONE, FRICTION_NONLOCAL
   use atrito_kinds, only: ip, wp
   use atrito_master, only: master_t
   use atrito_mesh, only: face_nodes
   use atrito_model, only: model_t, SURFACE_SEGMENTS
   use atrito_mortar_segments, only: segments_t, cut_slave
   use atrito_pairing, only: make_master
   use atrito_pieces, only: cross, normal_at
   use atrito_points, only: contact_points_t
   use atrito_problem, only: problem_t
   implicit none (type, external)
   private
   public :: list_segments, SAME_DIRECTION

   real(wp), parameter :: SAME_DIRECTION = 1.0e-6_wp
contains

   !> The segments of all pairs, with the stresses of a solution.
   !>
   !> why_not: what (2) cannot be had for, in words; not allocated: nothing.
   subroutine list_segments(model, problem, solution, keeps, segments, n, why_not)
      type(model_t), intent(in) :: model
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      logical, intent(in) :: keeps                  !< the resultants of the pairs
      type(segment_t), allocatable, intent(out) :: segments(:)
      integer(ip), intent(out) :: n
      character(len=:), allocatable, intent(inout) :: why_not
      integer(ip), allocatable :: point(:), given(:) !< (n_nodes) of the pair; place of its gap among those that are given, or 0
      logical, allocatable :: is_slave(:)           !< (n_nodes)
      type(master_t) :: master
      type(segments_t) :: cuts
      integer(ip) :: i, k, f, first, before

      n = 0
      first = 0
      allocate (segments(0))
      allocate (point(size(problem%held, 2)), given(size(problem%held, 2)), source=0_ip)
      allocate (is_slave(size(point)))
      do i = 1, size(problem%points, kind=ip)
         associate (pair => model%pairs(i), points => problem%points(i))
            before = n
            if (points%n > 0) then
               do k = 1, points%n
                  point(points%node(k)) = first + k
               end do
               call number_gaps(points, given)
               call make_master(model, pair%master, master)
               associate (faces => model%surfaces(pair%slave)%faces)
                  is_slave = .false.
                  do f = 1, faces%n
                     is_slave(face_nodes(model%mesh, faces%element(f), faces%face(f))) = .true.
                  end do
                  call name_nodes_between(problem%rows, first, points%n, is_slave, point)
                  call cut_slave(model%mesh, faces, master, cuts)
                  do f = 1, faces%n
                     do k = cuts%first(f), cuts%first(f + 1) - 1
                        call add_part(f, cuts%piece(k), 0.5_wp*(1 + [cuts%from(k), cuts%to(k)]))
                        if (allocated(why_not)) return
                     end do
                  end do
               end associate
               point = 0
               if (keeps) call keep_resultant(problem, solution, first, points%n, is_slave, segments(before + 1:n))
            end if
            first = first + points%n
         end associate
      end do

   contains

      !> A part of face f that faces a piece of the master: on a face of three nodes two, where its middle node is in between.
      subroutine add_part(f, piece, places)
         integer(ip), intent(in) :: f, piece
         real(wp), intent(in) :: places(2)
         real(wp), parameter :: MIDDLE = 0.5_wp, AT_MIDDLE = 1.0e-9_wp

         associate (faces => model%surfaces(model%pairs(i)%slave)%faces)
            if (.not. any(point(face_nodes(model%mesh, faces%element(f), faces%face(f))) > 0)) return
            if (DEGREE_OF(model%mesh%shape(faces%element(f))) == 2 .and. places(1) < MIDDLE - AT_MIDDLE .and. &
                places(2) > MIDDLE + AT_MIDDLE) then
               call add_segment(f, piece, [places(1), MIDDLE])
               call add_segment(f, piece, [MIDDLE, places(2)])
            else
               call add_segment(f, piece, places)
            end if
         end associate
      end subroutine add_part

      subroutine add_segment(f, piece, places)
         integer(ip), intent(in) :: f, piece
         real(wp), intent(in) :: places(2)
         type(segment_t), allocatable :: longer(:)

         if (n == size(segments)) then
            allocate (longer(2*n + 64))
            longer(:n) = segments(:n)
            call move_alloc(longer, segments)
         end if
         n = n + 1
         call place_segment(model, i, f, master, piece, places, segments(n))
         call take_stresses(problem, solution, point, keeps, segments(n), why_not)
         call take_gaps(problem, problem%points(i), point, given, segments(n), why_not)
         if (model%pairs(i)%gap_is_given) return
         if (abs(dot_product(normal_at(master, piece, 0.5_wp), segments(n)%normal) + 1) > SAME_DIRECTION) then
            why_not = 'contact sides that are not parallel'
         end if
      end subroutine add_segment

   end subroutine list_segments

   !> The place of the gap of each node among those that are given.
   pure subroutine number_gaps(points, given)
      type(contact_points_t), intent(in) :: points
      integer(ip), intent(inout) :: given(:)        !< (n_nodes) 0: none is
      integer(ip) :: k

      given = 0
      if (allocated(points%given_node)) then
         given(points%given_node) = [(k, k=1, size(points%given_node))]
      else if (allocated(points%given_gap)) then
         given = 1
      end if
   end subroutine number_gaps

   !> Nodes of a slave that have no point of their own have the stresses of the one that stands most for them: at the end
   !> of a master.
   pure subroutine name_nodes_between(rows, first, n_points, is_slave, point)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: first, n_points    !< points first + 1 .. first + n_points
      logical, intent(in) :: is_slave(:)            !< (n_nodes)
      integer(ip), intent(inout) :: point(:)        !< (n_nodes)
      real(wp) :: most(size(point))
      logical :: is_named(size(point))
      integer(ip) :: j, l

      is_named = point > 0
      most = 0.0_wp
      do j = first + 1, first + n_points
         do l = rows%first(j), rows%first(j + 1) - 1
            associate (node => rows%node(l), share => rows%coefficient(l))
               if (is_named(node) .or. .not. (is_slave(node) .and. share > most(node))) cycle
               most(node) = share
               point(node) = j
            end associate
         end do
      end do
   end subroutine name_nodes_between

   !> Where a segment lies: a part of face f of the slave of a pair, which faces a piece of the master.
   subroutine place_segment(model, i_pair, f, master, piece, places, segment)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i_pair, f
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: piece
      real(wp), intent(in) :: places(2)             !< of its ends on the face, 0 to 1
      type(segment_t), intent(out) :: segment
      real(wp) :: x(2), at
      integer(ip) :: j

      segment%pair = i_pair
      segment%on_slave = places
      associate (pair => model%pairs(i_pair), mesh => model%mesh)
         segment%slave = [model%surfaces(pair%slave)%faces%element(f), model%surfaces(pair%slave)%faces%face(f)]
         call take_nodes(face_nodes(mesh, segment%slave(1), segment%slave(2)), segment%n, segment%node)
         if (model%surfaces(pair%master)%kind /= SURFACE_SEGMENTS) then
            segment%master = [model%surfaces(pair%master)%faces%element(piece), model%surfaces(pair%master)%faces%face(piece)]
            call take_nodes(face_nodes(mesh, segment%master(1), segment%master(2)), segment%n_master, segment%master_node)
         end if
         associate (first => mesh%x(:, segment%node(1)), last => mesh%x(:, segment%node(2)))
            segment%normal = outward_normal(mesh%x(:, segment%node(:2)), 0.0_wp)
            segment%length = (places(2) - places(1))*norm2(last - first)
            segment%thickness = model%sections(model%section_of(segment%slave(1)))%thickness
            do j = 1, 2
               x = first + places(j)*(last - first)
               ! where the normal meets the master's piece: x + distance n = a + at d
               at = cross(x - master%a(:, piece), segment%normal)/cross(master%d(:, piece), segment%normal)
               segment%gap(j) = dot_product(master%a(:, piece) + at*master%d(:, piece) - x, segment%normal)
               segment%on_master(j) = min(max(at, 0.0_wp), 1.0_wp)
            end do
         end associate
      end associate
   end subroutine place_segment

   pure subroutine take_nodes(nodes, n, node)
      integer(ip), intent(in) :: nodes(:)
      integer(ip), intent(out) :: n, node(3)

      n = size(nodes, kind=ip)
      node = 0
      node(:n) = nodes
   end subroutine take_nodes

   !> The stresses of a solution along a segment, its law, and which side gives way.
   subroutine take_stresses(problem, solution, point, keeps, segment, why_not)
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      integer(ip), intent(in) :: point(:)           !< (n_nodes) of the pair; 0: none
      logical, intent(in) :: keeps                  !< the resultant of the pair; else that of each face
      type(segment_t), intent(inout) :: segment     !< in its place
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp) :: share
      integer(ip) :: j

      do j = 1, segment%n
         if (point(segment%node(j)) == 0) cycle
         if (norm2(problem%rows%normal(:, point(segment%node(j))) - segment%normal) > SAME_DIRECTION) then
            why_not = 'curved contact sides'
         end if
      end do
      share = 1.0_wp
      if (.not. keeps) share = share_of_face(segment, point, max(solution%p, 0.0_wp))
      segment%p = share*along_points(segment, point, max(solution%p, 0.0_wp))
      segment%t = share*along_points(segment, point, solution%t)
      segment%tau = share*along_points(segment, point, solution%tau)
      if (allocated(problem%line%rest)) segment%rest = along_points(segment, point, problem%line%rest)
      j = maxval(point(segment%node(:segment%n)))
      segment%delta = problem%line%delta(j)
      associate (law => problem%line%law(j))
         if (law%kind == FRICTION_NONE) segment%tau = 0.0_wp
         if (law%kind == FRICTION_NONLOCAL) segment%eps = law%eps
         if (law%kind /= FRICTION_NONLOCAL) segment%compliance = law%compliance
      end associate
      if (segment%master(1) > 0) segment%master_is_softer = stiffness_of(problem%fem, segment%master(1)) < &
                                                            stiffness_of(problem%fem, segment%slave(1))
   end subroutine take_stresses

   !> Gaps at the ends of a segment, where they are not those of the mesh. At a point between nodes (MORTAR) the run has the mean of
   !> what the nodes are given; the gap itself is linear from node to node.
   subroutine take_gaps(problem, points, point, given, segment, why_not)
      class(problem_t), intent(in) :: problem
      type(contact_points_t), intent(in) :: points  !< of the pair
      integer(ip), intent(in) :: point(:), given(:)
      type(segment_t), intent(inout) :: segment
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp) :: at_nodes(3)
      integer(ip) :: j

      if (allocated(problem%rows%allowed) .and. points%is_mortar) then
         if (any(problem%rows%allowed(pack(point, point > 0)) > 0.0_wp)) why_not = 'overlaps that are still being resolved'
      end if
      if (.not. (allocated(points%given_gap) .or. (points%matching .and. .not. points%is_mortar))) return
      at_nodes = 0.0_wp
      do j = 1, segment%n
         associate (k => given(segment%node(j)), own => point(segment%node(j)))
            if (k > 0 .and. (own == 0 .or. points%is_mortar)) then
               at_nodes(j) = points%given_gap(k)
            else if (own > 0 .and. .not. points%is_mortar) then
               at_nodes(j) = problem%rows%gap(own)
            else
               why_not = 'a node of a side that is given no gap'
            end if
         end associate
      end do
      segment%gap = along(segment, at_nodes)
   end subroutine take_gaps

   !> Multiplies the stresses of a pair by a function that is linear along it, so that the pressures have the resultant and the
   !> moment of those of the run: what a body far from its contact feels of them is the same.
   subroutine keep_resultant(problem, solution, first, n_points, is_slave, segments)
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      integer(ip), intent(in) :: first, n_points    !< points first + 1 .. first + n_points
      logical, intent(in) :: is_slave(:)            !< (n_nodes)
      type(segment_t), intent(inout) :: segments(:) !< of the pair
      real(wp), parameter :: LEAST_FACTOR = 0.2_wp, SMALL = 1.0e-6_wp
      real(wp) :: work(2), gram(2, 2), c(2), z, z_of_force, force, unit, low, high, det, factor(2)
      integer(ip) :: i, j, l
      integer :: attempt

      if (size(segments) == 0) return
      low = huge(low)
      high = -huge(high)
      do i = 1, size(segments, kind=ip)
         low = min(low, place_at(segments(i), 0.0_wp), place_at(segments(i), 1.0_wp))
         high = max(high, place_at(segments(i), 0.0_wp), place_at(segments(i), 1.0_wp))
      end do
      unit = maxval([problem%line%weight(first + 1:first + n_points)*solution%p(first + 1:first + n_points), 0.0_wp])
      if (.not. unit > 0.0_wp) return
      unit = scale(1.0_wp, exponent(unit)) ! [F], a power of two: the squares of forces in any units are of size 1
      work = 0.0_wp
      gram = 0.0_wp
      do j = first + 1, first + n_points
         force = problem%line%weight(j)*max(solution%p(j), 0.0_wp)/unit
         do l = problem%rows%first(j), problem%rows%first(j + 1) - 1
            if (.not. is_slave(problem%rows%node(l))) cycle
            z = (along_pair(problem%fem%mesh%x(:, problem%rows%node(l))) - low)/(high - low)
            work = work + force*problem%rows%coefficient(l)*[1.0_wp, z]
         end do
      end do
      do i = 1, size(segments, kind=ip)
         do j = 1, 2
            force = 0.5_wp*segments(i)%length*segments(i)%thickness*(segments(i)%p(j)/unit)
            z_of_force = (place_at(segments(i), real(j, wp)/3) - low)/(high - low)
            z = (place_at(segments(i), j - 1.0_wp) - low)/(high - low)
            work = work - force*[1.0_wp, z_of_force]
            gram(:, 1) = gram(:, 1) + force*[1.0_wp, z_of_force]
            gram(:, 2) = gram(:, 2) + force*z*[1.0_wp, z_of_force]
         end do
      end do
      det = gram(1, 1)*gram(2, 2) - gram(1, 2)*gram(2, 1)
      do attempt = 1, 2
         if (attempt == 1) then
            if (.not. det > SMALL*gram(1, 1)**2) cycle
            c = [gram(2, 2)*work(1) - gram(1, 2)*work(2), gram(1, 1)*work(2) - gram(2, 1)*work(1)]/det
         else
            if (.not. gram(1, 1) > 0.0_wp) return
            c = [work(1)/gram(1, 1), 0.0_wp]
         end if
         factor = 1 + [c(1), c(1) + c(2)]
         if (all(factor > LEAST_FACTOR .and. factor < 1/LEAST_FACTOR)) exit
         if (attempt == 2) return
      end do
      do i = 1, size(segments, kind=ip)
         factor = 1 + c(1) + c(2)*([place_at(segments(i), 0.0_wp), place_at(segments(i), 1.0_wp)] - low)/(high - low)
         segments(i)%p = factor*segments(i)%p
         segments(i)%t = factor*segments(i)%t
         segments(i)%tau = factor*segments(i)%tau
      end do
      call keep_shear(sum(problem%line%weight(first + 1:first + n_points)*solution%t(first + 1:first + n_points)), segments)

   contains

      real(wp) function place_at(segment, t)
         type(segment_t), intent(in) :: segment
         real(wp), intent(in) :: t

         associate (x => problem%fem%mesh%x(:, segment%node(:2)), s => between(segment%on_slave, t))
            place_at = along_pair((1 - s)*x(:, 1) + s*x(:, 2))
         end associate
      end function place_at

      pure real(wp) function along_pair(x)
         real(wp), intent(in) :: x(2)

         along_pair = x(2)*segments(1)%normal(1) - x(1)*segments(1)%normal(2)
      end function along_pair

   end subroutine keep_resultant

   !> By what the stresses of a face of three nodes are multiplied, so that linear from node to node they have the resultant of
   !> Simpson's rule.
   pure real(wp) function share_of_face(segment, point, p)
      type(segment_t), intent(in) :: segment
      integer(ip), intent(in) :: point(:)
      real(wp), intent(in) :: p(:)                  !< of all points [F/L^2]
      real(wp) :: ends, middle

      share_of_face = 1.0_wp
      if (segment%n /= 3) return
      if (any(point(segment%node) == 0)) return
      ends = sum(p(point(segment%node(:2))))
      middle = p(point(segment%node(3)))
      if (ends + middle > 0.0_wp) share_of_face = (2*ends + 8*middle)/(3*ends + 6*middle)
   end function share_of_face

   !> Changes shears in proportion to the room that is left below tau, so that they have a resultant; where there is not that much
   !> room they stay.
   pure subroutine keep_shear(resultant, segments)
      real(wp), intent(in) :: resultant             !< [F]
      type(segment_t), intent(inout) :: segments(:)
      real(wp) :: missing, room, share
      integer(ip) :: i

      missing = resultant
      room = 0.0_wp
      do i = 1, size(segments, kind=ip)
         associate (area => 0.5_wp*segments(i)%length*segments(i)%thickness)
            missing = missing - area*sum(segments(i)%t)
            room = room + area*sum(segments(i)%tau - abs(segments(i)%t))
         end associate
      end do
      if (.not. abs(missing) < room) return
      share = missing/room
      do i = 1, size(segments, kind=ip)
         segments(i)%t = segments(i)%t + share*(segments(i)%tau - abs(segments(i)%t))
      end do
   end subroutine keep_shear

   !> Of the material of an element, times its thickness [F/L].
   pure real(wp) function stiffness_of(fem, e)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e

      associate (section => fem%sections(fem%section_of(e)))
         stiffness_of = merge(section%stiffness(1, 1), section%young, section%is_orthotropic)*section%thickness
      end associate
   end function stiffness_of

   !> The values of points at both ends of a segment; 0 at a node without a point.
   pure function along_points(segment, point, of_points) result(values)
      type(segment_t), intent(in) :: segment
      integer(ip), intent(in) :: point(:)
      real(wp), intent(in) :: of_points(:)
      real(wp) :: values(2)
      real(wp) :: at_nodes(3)
      integer(ip) :: j

      at_nodes = 0.0_wp
      do j = 1, segment%n
         if (point(segment%node(j)) > 0) at_nodes(j) = of_points(point(segment%node(j)))
      end do
      values = along(segment, at_nodes)
   end function along_points

end module atrito_contact_tractions
