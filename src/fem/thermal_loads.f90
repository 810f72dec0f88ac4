!> Nodal forces and energy of the strains that the temperature makes, by the points of the stiffness: a body that expands freely is
!> free of stress to the last digits.
!>
!> With e_th = alpha (T - T_initial) along all axes the stresses are D (e - e_th), so that
!>
!>     f = int B' D e_th dV,     W = 1/2 u'K u - u'f + 1/2 int e_th D e_th dV.
!>
!> f is in balance by itself in every element.
module atrito_thermal_loads
   use atrito_assembly, only: fem_t
   use atrito_element_table, only: BEST_OF, POINTS_OF, MOST_NODES
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: thermal_stresses, COMPONENTS, IS_REDUCED, STATES
   use atrito_point_stress, only: point_rule_t, point_geometry_t, MOST_POINTS, make_point_rules, fetch_geometry, &
                                  point_thermal_strains, find_means, takes_means, point_depth
   implicit none (type, external)
   private
   public :: add_thermal_loads, add_thermal_of, elastic_energy, largest_thermal_strain

contains

   !> Adds the nodal forces of the thermal strains of all elements; nothing where there are no temperatures.
   pure subroutine add_thermal_loads(fem, f)
      type(fem_t), intent(in) :: fem               !< mesh, sections and temperatures are read
      real(wp), intent(inout) :: f(:, :)           !< (2, n_nodes) [F]
      real(wp) :: blocked

      if (allocated(fem%heating)) call go_through(fem, f, blocked)
   end subroutine add_thermal_loads

   !> The same of some elements.
   pure subroutine add_thermal_of(fem, elements, f)
      type(fem_t), intent(in) :: fem               !< mesh, sections and temperatures are read
      integer(ip), intent(in) :: elements(:)       !< places in the mesh
      real(wp), intent(inout) :: f(:, :)           !< (2, n_nodes) [F]
      type(point_rule_t) :: rules(MOST_NODES, 2)
      type(point_geometry_t) :: geometry
      real(wp) :: blocked
      integer(ip) :: i

      if (.not. allocated(fem%heating)) return
      call make_rules(rules)
      blocked = 0.0_wp
      do i = 1, size(elements, kind=ip)
         call add_expansion(fem, elements(i), rules, geometry, f, blocked)
      end do
   end subroutine add_thermal_of

   !> The energy of the stresses from that of the displacements alone; unchanged where there are no temperatures.
   pure real(wp) function elastic_energy(fem, u, of_displacements) result(energy)
      type(fem_t), intent(in) :: fem               !< mesh, sections and temperatures are read
      real(wp), intent(in) :: u(:, :)              !< (2, n_nodes) [L]
      real(wp), intent(in) :: of_displacements     !< u'K u/2 [F L]
      real(wp), parameter :: ROUND_OFF = 1.0e-13_wp
      real(wp), allocatable :: f(:, :)
      real(wp) :: blocked, work

      energy = of_displacements
      if (.not. allocated(fem%heating)) return
      allocate (f(2, fem%mesh%n_nodes), source=0.0_wp)
      call go_through(fem, f, blocked)
      work = sum(u*f)
      energy = of_displacements - work + blocked
      if (energy <= ROUND_OFF*(of_displacements + abs(work) + blocked)) energy = 0.0_wp
   end function elastic_energy

   !> The largest strain of the temperature of any node in any section.
   pure real(wp) function largest_thermal_strain(fem) result(strain)
      type(fem_t), intent(in) :: fem !< sections and temperatures are read

      strain = 0.0_wp
      if (allocated(fem%heating)) strain = maxval(abs(fem%sections%expansion))*maxval(abs(fem%heating))
   end function largest_thermal_strain

   !> All elements that expand, one by one.
   pure subroutine go_through(fem, f, blocked)
      type(fem_t), intent(in) :: fem
      real(wp), intent(inout) :: f(:, :)
      real(wp), intent(out) :: blocked             !< energy if nothing moved, int e_th D e_th dV/2 [F L]
      type(point_rule_t) :: rules(MOST_NODES, 2)   ! of full and of reduced integration
      type(point_geometry_t) :: geometry
      integer(ip) :: e

      call make_rules(rules)
      blocked = 0.0_wp
      do e = 1, fem%mesh%n_elements
         call add_expansion(fem, e, rules, geometry, f, blocked)
      end do
   end subroutine go_through

   !> The points of the stiffness.
   pure subroutine make_rules(rules)
      type(point_rule_t), intent(inout) :: rules(MOST_NODES, 2) !< of full and of reduced integration

      call make_point_rules(POINTS_OF, rules(:, 1))
      call make_point_rules(BEST_OF, rules(:, 2))
   end subroutine make_rules

   !> An element; nothing where it does not expand.
   pure subroutine add_expansion(fem, e, rules, geometry, f, blocked)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      type(point_rule_t), intent(in) :: rules(MOST_NODES, 2)
      type(point_geometry_t), intent(inout) :: geometry
      real(wp), intent(inout) :: f(:, :), blocked

      if (.not. abs(fem%sections(fem%section_of(e))%expansion) > 0.0_wp) return
      associate (rule => rules(fem%mesh%shape(e), merge(2, 1, IS_REDUCED(fem%mesh%state(e)))))
         call fetch_geometry(fem, e, rule, geometry)
         call add_element(fem, e, rule, geometry, f, blocked)
      end associate
   end subroutine add_expansion

   !> fe_k = sum over the points of B_k' D e_th times their volume, with b = D e_th/(alpha dT) per unit of strain: b1 and b2 of
   !> thermal_stresses push along the gradient of the shape function of node k, which is how a node strains both axes; b3, which
   !> only an orthotropic material has whose axes are turned, pushes as a shear stress does; b4 round the circle of a ring. The
   !> first node has what makes the sum zero to the last bit: gradients add up to 0, but for round-off.
   pure subroutine add_element(fem, e, rule, geometry, f, blocked)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(in) :: geometry
      real(wp), intent(inout) :: f(:, :), blocked
      real(wp) :: strain(MOST_POINTS), volume, push(MOST_POINTS, COMPONENTS + 1), b(COMPONENTS + 1), fe(2, MOST_NODES)
      integer(ip) :: i, k, n

      n = geometry%shape
      call point_thermal_strains(fem, e, rule, geometry, strain)
      fe(:, :n) = 0.0_wp
      associate (section => fem%sections(geometry%section), state => geometry%state)
         b = thermal_stresses(section, state)
         do i = 1, rule%n
            volume = volume_at(geometry, rule, i, section%thickness)
            push(i, :) = volume*b*strain(i)
            do k = 2, n
               fe(:, k) = fe(:, k) + push(i, 1:2)*point_rows(geometry, i, k)
            end do
            if (.not. geometry%is_orthotropic) cycle
            do k = 2, n
               fe(:, k) = fe(:, k) + push(i, 3)*geometry%gradient(i, 2:1:-1, k)
            end do
         end do
         fe(:, 1) = -sum(fe(:, 2:n), dim=2)        ! the gradients add up to 0
         if (geometry%has_hoop) call add_hoop(rule, geometry, push(:, COMPONENTS + 1), fe)
         if (geometry%is_orthotropic) then
            blocked = blocked + 0.5_wp*dot_product(push(:rule%n, 1) + push(:rule%n, 2) + push(:rule%n, 4), strain(:rule%n))
         else
            ! along two axes, or three, the temperature meets stiffness: not across a thin plate
            blocked = blocked + 0.5_wp*merge(2.0_wp, 3.0_wp, STATES(state)%is_thin)*sum(push(:rule%n, 1)*strain(:rule%n))
         end if
      end associate
      do k = 1, n
         f(:, fem%mesh%nodes(k, e)) = f(:, fem%mesh%nodes(k, e)) + fe(:, k)
      end do
   end subroutine add_element

   !> The volume of a point [L^3]: all of it where the strains are means.
   pure real(wp) function volume_at(geometry, rule, i, thickness) result(volume)
      type(point_geometry_t), intent(in) :: geometry
      type(point_rule_t), intent(in) :: rule
      integer(ip), intent(in) :: i                 !< point
      real(wp), intent(in) :: thickness            !< [L]
      real(wp) :: mean(geometry%shape)

      if (rule%n == 1 .and. takes_means(geometry)) then
         call find_means(geometry, mean, volume)
         volume = volume*thickness
      else
         volume = rule%weight(i)*geometry%jacobian(i)*point_depth(geometry, rule, i, thickness, geometry%radius)
      end if
   end function volume_at

   !> What a normal strain along both axes does at a point: the gradient of a node's shape function, or its mean.
   pure function point_rows(geometry, i, k) result(rows)
      type(point_geometry_t), intent(in) :: geometry
      integer(ip), intent(in) :: i, k              !< point, node
      real(wp) :: rows(2)

      if (geometry%averages) then
         rows = geometry%mean(:, k)
      else
         rows = geometry%gradient(i, :, k)
      end if
   end function point_rows

   !> The hoop strain u1/r; the mean dilatation has it already, but for the first node.
   pure subroutine add_hoop(rule, geometry, push, fe)
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(in) :: geometry
      real(wp), intent(in) :: push(MOST_POINTS)    !< [F L]
      real(wp), intent(inout) :: fe(2, MOST_NODES)
      integer(ip) :: i, n

      n = geometry%shape
      if (geometry%averages) then
         fe(1, 1) = sum(push(:rule%n))*geometry%mean(1, 1)
         return
      end if
      do i = 1, rule%n
         if (IS_REDUCED(geometry%state)) then
            fe(1, :n) = fe(1, :n) + push(i)*geometry%hoop(i, :n)
            cycle
         end if
         fe(1, :n) = fe(1, :n) + (push(i)/(geometry%radius + geometry%place(i, 1)))*rule%value(i, :n)
      end do
   end subroutine add_hoop

end module atrito_thermal_loads
