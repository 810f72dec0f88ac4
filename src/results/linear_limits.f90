!> Where a solution leaves what a linear theory knows: strain, rotation and slip that are not small.
module atrito_linear_limits
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: bodies_t
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_large_deformation, only: deformation_t, may_rotate, measure_deformation
   use atrito_mesh, only: face_end
   use atrito_messages, only: add_note, add_warning
   use atrito_model, only: model_t
   use atrito_points, only: contact_points_t
   use atrito_results, only: results_t, contact_result_t, extreme_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: find_large, warn_of_large, LARGE_STRAIN, LARGE_ROTATION, LARGE_SLIP

   !> Above these a linear theory is wrong by some percent.
   real(wp), parameter :: LARGE_STRAIN = 0.05_wp      !< principal strain
   real(wp), parameter :: LARGE_ROTATION = 0.1_wp     !< [rad]
   real(wp), parameter :: LARGE_SLIP = 0.05_wp        !< over the larger of width and height of the slave's body

   !> The bound of the strains is one at the Gauss points; the best points lie between them.
   real(wp), parameter :: NEAR = 0.8_wp

contains

   !> The largest strain, rotation and slip, where they pass their bounds; 0 elsewhere.
   subroutine find_large(model, fem, strain_bound, results)
      type(model_t), intent(in) :: model
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: strain_bound               !< no strain is larger than this
      type(results_t), intent(inout) :: results
      type(deformation_t) :: largest
      logical :: deforms, rotates
      real(wp), allocatable :: shortest(:), longest(:)
      integer(ip) :: i

      rotates = .false.
      deforms = strain_bound > NEAR*LARGE_STRAIN
      if (.not. deforms) rotates = may_rotate(fem%mesh, results%u, LARGE_ROTATION)
      if (deforms .or. rotates) then
         call measure_deformation(fem, results%u, deforms, LARGE_ROTATION, largest)
         if (largest%strain > LARGE_STRAIN) results%large_strain = extreme_t(largest%strain, &
                                                                      fem%mesh%element_id(largest%strain_element), largest%strain_x)
         if (largest%rotation > LARGE_ROTATION) results%large_rotation = extreme_t(largest%rotation, &
                                                                  fem%mesh%element_id(largest%rotation_element), largest%rotation_x)
      end if
      call measure_masters(model, shortest, longest)
      do i = 1, size(results%contact, kind=ip)
         call find_large_slip(model, fem%bodies, i, shortest(model%pairs(i)%master), longest, results%contact(i), &
                              results%large_slip)
      end do
   end subroutine find_large

   !> How long the faces of masters are: the shortest of each surface, the longest at each node.
   subroutine measure_masters(model, shortest, longest)
      type(model_t), intent(in) :: model
      real(wp), allocatable, intent(out) :: shortest(:)  !< (surfaces) [L]; of one that is drawn or no master: HUGE_REAL
      real(wp), allocatable, intent(out) :: longest(:)   !< (nodes) [L]
      logical :: is_master(size(model%surfaces))
      integer(ip) :: i, k, ends(2)
      real(wp) :: length

      is_master = .false.
      is_master(model%pairs%master) = .true.
      allocate (shortest(size(model%surfaces)), source=HUGE_REAL)
      allocate (longest(merge(model%mesh%n_nodes, 0_ip, size(model%pairs) > 0)), source=0.0_wp)
      do i = 1, size(model%surfaces, kind=ip)
         if (.not. is_master(i)) cycle
         associate (faces => model%surfaces(i)%faces, mesh => model%mesh)
            do k = 1, faces%n
               ends = [mesh%nodes(faces%face(k), faces%element(k)), &
                       mesh%nodes(face_end(mesh, faces%element(k), faces%face(k)), faces%element(k))]
               length = norm2(mesh%x(:, ends(2)) - mesh%x(:, ends(1)))
               shortest(i) = min(shortest(i), length)
               longest(ends) = max(longest(ends), length)
            end do
         end associate
      end do
   end subroutine measure_masters

   !> The largest slip of a pair's closed points that is more than a face of the master there is long, or than its part of the
   !> slave's body.
   pure subroutine find_large_slip(model, bodies, i, shortest, longest, contact, largest)
      type(model_t), intent(in) :: model
      type(bodies_t), intent(in) :: bodies
      integer(ip), intent(in) :: i                       !< the pair
      real(wp), intent(in) :: shortest, longest(:)       !< face of the master, at each node [L]
      type(contact_result_t), intent(in) :: contact
      type(extreme_t), intent(inout) :: largest
      integer(ip) :: j
      real(wp) :: most, bound

      if (contact%n == 0) return
      most = maxval([abs(pack(contact%slip, contact%pressure > 0.0_wp)), 0.0_wp])
      ! the points do not reach farther than the body
      if (most <= min(shortest, LARGE_SLIP*maxval(maxval(contact%x, dim=2) - minval(contact%x, dim=2)))) return
      bound = LARGE_SLIP*extent_of_nodes(model%mesh%x, bodies%list(bodies%of_node(model%points(i)%node(1)))%nodes)
      if (most <= min(shortest, bound)) return
      do j = 1, contact%n
         if (.not. contact%pressure(j) > 0.0_wp .or. abs(contact%slip(j)) <= largest%value) cycle
         if (abs(contact%slip(j)) <= min(bound, master_length(model%points(i), j, longest))) cycle
         largest = extreme_t(abs(contact%slip(j)), model%mesh%node_id(model%points(i)%node(j)), contact%x(:, j), &
                             is_node=.true.)
      end do
   end subroutine find_large_slip

   !> The larger of width and height of some nodes [L].
   pure real(wp) function extent_of_nodes(x, nodes) result(extent)
      real(wp), intent(in) :: x(:, :)
      integer(ip), intent(in) :: nodes(:)                !< one or more
      real(wp) :: least(2), greatest(2)
      integer(ip) :: k

      least = x(:, nodes(1))
      greatest = least
      do k = 2, size(nodes, kind=ip)
         least = min(least, x(:, nodes(k)))
         greatest = max(greatest, x(:, nodes(k)))
      end do
      extent = maxval(greatest - least)
   end function extent_of_nodes

   !> How long the faces of the master are that a point faces, at the most [L]; HUGE_REAL for a rigid surface.
   pure real(wp) function master_length(points, j, longest) result(length)
      type(contact_points_t), intent(in) :: points
      integer(ip), intent(in) :: j
      real(wp), intent(in) :: longest(:)
      integer(ip) :: k

      length = 0.0_wp
      do k = points%first(j), points%first(j + 1) - 1
         if (points%coefficient(k) < 0.0_wp) length = max(length, longest(points%entry(k)))
      end do
      if (length <= 0.0_wp) length = HUGE_REAL
   end function master_length

   !> What passes its bound, and what follows.
   subroutine warn_of_large(results, asks_nlgeom)
      type(results_t), intent(in) :: results
      logical, intent(in) :: asks_nlgeom                 !< the deck asks for large displacements
      logical :: is_small

      is_small = max(results%large_strain%value, results%large_rotation%value, results%large_slip%value) <= 0.0_wp
      if (asks_nlgeom .and. is_small) then
         call add_note('N-SMALL', 'NLGEOM: no strain is above '//to_text(LARGE_STRAIN)//', no rotation above '// &
                       to_text(LARGE_ROTATION)//' rad and no slip beyond a face: large displacements would hardly change the '// &
                       'results, but for what is near buckling')
      end if
      if (results%large_strain%value > 0.0_wp) call add_warning('W-LARGE', 'the largest strain is '// &
                          value_text(results%large_strain)//': above '//to_text(LARGE_STRAIN)//' lengths and areas change so much' &
                        //' that the linear theory, which takes them as they are without loads, does not know the true equilibrium')
      if (results%large_rotation%value > 0.0_wp) call add_warning('W-LARGE', 'the largest rotation is '// &
                       value_text(results%large_rotation)//': above '//to_text(LARGE_ROTATION)//' rad the linear theory, in which' &
                               //' forces and normals keep their directions and a rotation makes strains, does not know the motion')
      if (results%large_slip%value > 0.0_wp) call add_warning('W-LARGE', 'the largest slip of a closed point is '// &
                                         value_text(results%large_slip)//': beyond a face of the master, or '//to_text(LARGE_SLIP) &
                        //' of the slave''s body, the linear theory, in which a point faces what it faced without loads, does not' &
                                                              //' know what it has come to')
   end subroutine warn_of_large

   !> `0.12 at element 7 (1.5, 0)`
   pure function value_text(extreme) result(text)
      type(extreme_t), intent(in) :: extreme
      character(len=:), allocatable :: text

      text = to_text(extreme%value, 3)//trim(merge(' at node   ', ' at element', extreme%is_node))//' '//to_text(extreme%id) &
             //' ('//to_text(extreme%x(1), 5)//', '//to_text(extreme%x(2), 5)//')'
   end function value_text

end module atrito_linear_limits
