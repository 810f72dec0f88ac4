!> Normal force, shear force and moment in the cross-sections of cuts, from the forces of elements on nodes.
!>
!> Behind the line stand the elements M. At a node that they share with elements ahead they need the forces K u less those of the
!> temperatures and of the loads on them; what they do not get from forces of single nodes (loads, supports, contact) they get from
!> the elements ahead. The sum of that is in equilibrium with all else that acts behind the zigzag of elements. What acts between
!> zigzag and line is added, or taken off, so that the result is in equilibrium with all that acts behind the line:
!>
!>     F = sum over the shared nodes of (K u - f_thermal - f_load) of M + sum over nodes of share * own force
!>         + loads on the parts ahead of elements behind - loads on the parts behind of elements ahead.
!>
!> In a body of revolution the hoop stress pulls, too: over an element its mean counts, as a load along the radius.
module atrito_section_forces
   use atrito_assembly, only: stiffness_cache_t, cached_stiffness
   use atrito_crossings, only: cross_section_t
   use atrito_element_table, only: MOST_NODES
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: is_revolved
   use atrito_model, only: cut_t, element_load_t, nodal_values_t, step_t, is_on_volume
   use atrito_nodal_loads, only: add_element_load, nodal_loads
   use atrito_results, only: cut_force_t
   use atrito_scene_data, only: scene_data_t
   use atrito_split_loads, only: resultant_t, add_force, add_part_of_load, part_of_area
   use atrito_step_loads, only: act_at, moment_t
   use atrito_thermal_loads, only: add_thermal_of
   implicit none (type, external)
   private
   public :: sum_cuts

contains

   !> The rows of the cuts that the step asks for.
   subroutine sum_cuts(data, moment, u, others, rows)
      type(scene_data_t), intent(in) :: data                !< step, cuts and loads
      type(moment_t), intent(in) :: moment                  !< what acts is that of this time
      real(wp), intent(in) :: u(:, :)                       !< (2, n_nodes); rigid motions of bodies may be left out [L]
      real(wp), intent(in) :: others(:, :)                  !< (2, n_nodes) of supports, contact and bilateral rows upon bodies [F]
      type(cut_force_t), allocatable, intent(out) :: rows(:) !< one a cut, as the step asks for them
      type(step_t) :: now
      real(wp), allocatable :: own(:, :)
      integer(ip) :: i, n

      call act_at(data%model, data%step, moment, now)
      now%node_loads = nodal_values_t()
      call nodal_loads(data%model, now, own)                ! of elements, which come one by one
      n = data%model%mesh%n_nodes
      own = data%f(:, :n) - own + others(:, :n)
      allocate (rows(size(data%step%requests%cuts)))
      do i = 1, size(rows, kind=ip)
         call sum_cut(data, now%element_loads, u, own, data%model%cuts(data%step%requests%cuts(i)), rows(i))
      end do
   end subroutine sum_cuts

   !> F is what the part ahead does to the part behind. With n the normal of the cut, from behind to ahead, a its direction and M
   !> about the middle of the section:
   !>
   !>     N = n . F  (tension > 0),     V = a . F,     M = sum (x - middle) x F
   !>
   !> The sizes of all terms are kept beside, since a moment may be the small difference of large ones.
   subroutine sum_cut(data, loads, u, own, cut, row)
      type(scene_data_t), intent(in) :: data
      type(element_load_t), intent(in) :: loads
      real(wp), intent(in) :: u(:, :)
      real(wp), intent(in) :: own(:, :)                     !< forces of single nodes (2, n_nodes) [F]
      type(cut_t), intent(in) :: cut
      type(cut_force_t), intent(out) :: row
      type(resultant_t) :: sum
      integer(ip), allocatable :: place(:)                  ! in split, of each element
      integer(ip) :: i, k

      associate (section => cut%section, x => data%model%mesh%x)
         sum%about = section%middle
         call add_elements_behind(data, loads, u, section, sum)
         do i = 1, size(section%node, kind=ip)
            call add_force(sum, x(:, section%node(i)), section%share(i)*own(:, section%node(i)))
         end do
         ! Loads on the parts of elements that the line cuts off, and on faces along the line.
         allocate (place(data%model%mesh%n_elements), source=0_ip)
         place(section%split) = [(i, i=1, size(section%split, kind=ip))]
         do i = 1, loads%n
            k = place(loads%element(i))
            if (k == 0) cycle
            call add_part_of_load(data%model, loads, i, section%line, section%is_behind(k), &
                                  merge(1.0_wp, -1.0_wp, section%is_behind(k)), sum)
         end do
         if (section%edge%n > 0) call add_loads_on_edge(data, loads, section, sum)
         if (is_revolved(data%model%mesh)) call add_hoop_between(data, u, section, sum)
         row%name = cut%name
         row%middle = section%middle
         row%length = section%length
         row%n = dot_product(section%line%normal, sum%force)
         row%v = dot_product(section%line%along, sum%force)
         row%m = sum%moment
         row%terms = sum%terms
      end associate
   end subroutine sum_cut

   !> What the elements behind need at the shared nodes, besides forces of single nodes.
   subroutine add_elements_behind(data, loads, u, section, sum)
      type(scene_data_t), intent(in) :: data
      type(element_load_t), intent(in) :: loads
      real(wp), intent(in) :: u(:, :)
      type(cross_section_t), intent(in) :: section
      type(resultant_t), intent(inout) :: sum
      real(wp), allocatable :: acting(:, :), inner(:, :)
      logical, allocatable :: is_behind(:)
      integer(ip) :: i

      if (size(section%shared) == 0) return
      associate (mesh => data%model%mesh)
         allocate (acting(2, mesh%n_nodes), inner(2, mesh%n_nodes), source=0.0_wp)
         allocate (is_behind(mesh%n_elements), source=.false.)
         is_behind(section%behind) = .true.
         do i = 1, loads%n
            if (is_behind(loads%element(i))) call add_element_load(data%model, loads, i, acting)
         end do
         call add_thermal_of(data%fem, section%behind, acting)
         call add_internal(data, section%behind, u, inner)
         do i = 1, size(section%shared, kind=ip)
            associate (node => section%shared(i))
               call add_force(sum, mesh%x(:, node), inner(:, node) - acting(:, node))
            end associate
         end do
      end associate
   end subroutine add_elements_behind

   !> Adds K u of some elements.
   subroutine add_internal(data, elements, u, force)
      type(scene_data_t), intent(in) :: data
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(in) :: u(:, :)
      real(wp), intent(inout) :: force(:, :)                !< (2, n_nodes) [F]
      type(stiffness_cache_t) :: cache
      real(wp) :: fe(2*MOST_NODES)
      integer(ip) :: i, k, n

      do i = 1, size(elements, kind=ip)
         n = 2*data%fem%mesh%shape(elements(i))
         associate (nodes => data%fem%mesh%nodes(:n/2, elements(i)))
            call cached_stiffness(data%fem, elements(i), cache)
            fe(:n) = matmul(cache%k(:n, :n), reshape(u(:, nodes), [n]))
            do k = 1, n/2
               force(:, nodes(k)) = force(:, nodes(k)) + fe(2*k - 1:2*k)
            end do
         end associate
      end do
   end subroutine add_internal

   subroutine add_loads_on_edge(data, loads, section, sum)
      type(scene_data_t), intent(in) :: data
      type(element_load_t), intent(in) :: loads
      type(cross_section_t), intent(in) :: section
      type(resultant_t), intent(inout) :: sum
      real(wp), allocatable :: acting(:, :)
      integer(ip) :: i, k

      allocate (acting(2, data%model%mesh%n_nodes), source=0.0_wp)
      do i = 1, loads%n
         if (is_on_volume(loads%kind(i))) cycle
         do k = 1, section%edge%n
            if (section%edge%element(k) /= loads%element(i) .or. section%edge%face(k) /= loads%face(i)) cycle
            call add_element_load(data%model, loads, i, acting)
            exit
         end do
      end do
      do i = 1, size(section%node, kind=ip)
         associate (node => section%node(i))
            call add_force(sum, data%model%mesh%x(:, node), section%share(i)*acting(:, node))
         end associate
      end do
   end subroutine add_loads_on_edge

   !> The hoop stress of a body of revolution in the parts of elements that the line cuts off. Along the radius the forces of an
   !> element add up to what it pulls outwards.
   subroutine add_hoop_between(data, u, section, sum)
      type(scene_data_t), intent(in) :: data
      real(wp), intent(in) :: u(:, :)
      type(cross_section_t), intent(in) :: section
      type(resultant_t), intent(inout) :: sum
      real(wp), allocatable :: inner(:, :), thermal(:, :)
      real(wp) :: pull, share, centre(2)
      integer(ip) :: i, k

      allocate (inner(2, data%model%mesh%n_nodes), thermal(2, data%model%mesh%n_nodes), source=0.0_wp)
      do i = 1, size(section%split, kind=ip)
         associate (e => section%split(i), nodes => data%fem%mesh%nodes(:data%fem%mesh%shape(section%split(i)), section%split(i)))
            call add_internal(data, [e], u, inner)
            call add_thermal_of(data%fem, [e], thermal)
            pull = 0.0_wp
            do k = 1, size(nodes, kind=ip)
               pull = pull + (inner(1, nodes(k)) - thermal(1, nodes(k)))
               inner(:, nodes(k)) = 0.0_wp
               thermal(:, nodes(k)) = 0.0_wp
            end do
            call part_of_area(data%model, e, section%line, section%is_behind(i), share, centre)
            call add_force(sum, centre, [-pull*share*merge(1.0_wp, -1.0_wp, section%is_behind(i)), 0.0_wp])
         end associate
      end do
   end subroutine add_hoop_between

end module atrito_section_forces
