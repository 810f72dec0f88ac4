!> Stresses at given points of many elements, fast: shape functions are evaluated once for each kind of element, their gradients
!> once for neighbours that are equal, and the innermost loops run over the points of an element.
!>
!>     s = D sum_a B_a (u_a - u_1) - b alpha dT,     B_a of the gradients dN_a/dx at the point
!>
!> b being the stress of a thermal strain of one that is held (thermal_stresses), which depends on the plane state. Displacements
!> are taken less those of the first node: a body may move far more than it deforms, and the gradients add up to zero but for
!> round-off. s33 follows from s11 + s22 by the plane state (stress_33), or has a row of its own in rings.
module atrito_point_stress
   use atrito_assembly, only: fem_t, form_t, has_form, take_form
   use atrito_axisymmetric, only: mean_rows
   use atrito_element, only: mean_gradients
   use atrito_element_table, only: SHAPES, MOST_NODES, MOST_CORNERS, has_mean_dilatation
   use atrito_kinds, only: ip, wp
   use atrito_orthotropy, only: IN_PLANE, ACROSS
   use atrito_plane_state, only: elasticity_matrix, thermal_stresses, IS_REDUCED, IS_TAPERED, COMPONENTS, depth_at
   use atrito_reduced_integration, only: spread_gradients, spread_values
   use atrito_reduced_rings, only: spread_ring_strains
   use atrito_shape_functions, only: shape_values, shape_gradients, rule_point
   use atrito_tapered, only: tapered_means
   implicit none (type, external)
   private
   public :: point_rule_t, point_geometry_t, MOST_POINTS, make_point_rules, make_point_rule, fetch_geometry, point_stresses
   public :: hoop_strain, point_thermal_strains, find_means, takes_means, point_depth

   integer(ip), parameter :: MOST_POINTS = 9

   !> A Gauss rule with the shape functions of one kind of element.
   type :: point_rule_t
      integer(ip) :: n = 0                                      !< points, the first ones of each list
      real(wp) :: weight(MOST_POINTS) = 0.0_wp                  !< of the points, on the parent square or triangle
      real(wp) :: value(MOST_POINTS, MOST_NODES) = 0.0_wp       !< shape functions at each point
      real(wp) :: slope(MOST_POINTS, 2, MOST_NODES) = 0.0_wp    !< their derivatives along xi and eta
   end type point_rule_t

   !> An element at the points of a rule, without its displacements.
   type, extends(form_t) :: point_geometry_t
      real(wp) :: d(COMPONENTS, COMPONENTS) = 0.0_wp               !< elasticity matrix [F/L^2]
      logical :: is_orthotropic = .false.        !< s33 goes by `across`, not by E and mu
      real(wp) :: across(4) = 0.0_wp             !< then s33 by e11, e22, 2 e12 and e33 [F/L^2]
      logical :: averages = .false.              !< the dilatation is the same everywhere in the element: FORMULATION=BBAR
      real(wp) :: mean(2, MOST_CORNERS) = 0.0_wp     !< then the mean gradients of the shape functions [1/L]
      real(wp) :: place(MOST_POINTS, 2) = 0.0_wp !< less the element's first node [L]
      real(wp) :: jacobian(MOST_POINTS) = 0.0_wp !< [L^2]
      real(wp) :: steepness(MOST_POINTS) = 0.0_wp           !< sum of the squares of dxi/dx [1/L^2]
      real(wp) :: gradient(MOST_POINTS, 2, MOST_NODES) = 0.0_wp !< dN/dx of all nodes but the first [1/L]
      real(wp) :: hoop(MOST_POINTS, MOST_NODES) = 0.0_wp    !< of rings with reduced integration: u1/x1 = hoop u1 [1/L]
   end type point_geometry_t

contains

   !> The rules of all shapes: the Gauss points of their stiffness, where stresses are best, or those of integrals of errors.
   pure subroutine make_point_rules(n_of, rules)
      integer(ip), intent(in) :: n_of(MOST_NODES)            !< points by shape: POINTS_OF, BEST_OF or ERROR_POINTS_OF
      type(point_rule_t), intent(out) :: rules(MOST_NODES)   !< by shape
      integer(ip) :: k

      do k = 1, MOST_NODES
         if (SHAPES(k)%n_nodes > 0) call make_point_rule(k, n_of(k), rules(k))
      end do
   end subroutine make_point_rules

   !> The rule of n points.
   pure subroutine make_point_rule(n_nodes, n, rule)
      integer(ip), intent(in) :: n_nodes         !< of the element: place in SHAPES
      integer(ip), intent(in) :: n               !< 1, 4 or 9; of triangles 1, 3 or 6
      type(point_rule_t), intent(out) :: rule    !< shape functions at its n points
      real(wp) :: xi(2)
      integer(ip) :: k

      rule%n = n
      do k = 1, n
         call rule_point(n_nodes, n, k, xi, rule%weight(k))
         rule%value(k, :n_nodes) = shape_values(n_nodes, xi)
         rule%slope(k, :, :n_nodes) = transpose(shape_gradients(n_nodes, xi))
      end do
   end subroutine make_point_rule

   !> An element at the points of a rule; nothing is done when it is like the element that is there.
   pure subroutine fetch_geometry(fem, e, rule, geometry)
      type(fem_t), intent(in) :: fem                     !< mesh and sections are read
      integer(ip), intent(in) :: e                       !< place in the mesh
      type(point_rule_t), intent(in) :: rule             !< that of the element's shape
      type(point_geometry_t), intent(inout) :: geometry  !< of another element by the same rule, or nothing
      real(wp) :: mean(2, 4), volume
      integer(ip) :: k

      if (has_form(fem, e, geometry%form_t, 0.0_wp, may_turn=.false.)) return
      call take_form(fem, e, geometry%form_t)
      associate (section => fem%sections(geometry%section))
         geometry%d = elasticity_matrix(section, geometry%state)
         geometry%averages = has_mean_dilatation(section, geometry%state, geometry%shape)
         geometry%is_orthotropic = section%is_orthotropic
         if (section%is_orthotropic) geometry%across = section%stiffness([IN_PLANE, ACROSS], ACROSS)
      end associate
      if (geometry%averages .and. geometry%has_hoop) then
         k = geometry%shape                      ! of the first degree: corners alone
         call mean_rows(geometry%x(:, :k), geometry%radius, 1.0_wp, geometry%state, geometry%mean(:, :k), volume)
      else if (geometry%averages .and. IS_TAPERED(geometry%state)) then
         call tapered_means(geometry%x(:, :MOST_CORNERS), geometry%thickness(:MOST_CORNERS), geometry%mean, volume)
      else if (geometry%averages) then
         geometry%mean = mean_gradients(geometry%x(:, :MOST_CORNERS))
      end if
      call map_points(rule, geometry)
      if (IS_REDUCED(geometry%state) .and. geometry%has_hoop) then
         k = geometry%shape
         call spread_ring_strains(rule%n, geometry%x(:, :k), geometry%radius, geometry%state, geometry%gradient, geometry%hoop)
      else if (has_mean_strains(geometry)) then
         call tapered_means(geometry%x(:, :4), geometry%thickness(:4), mean, volume)
         geometry%gradient(:rule%n, :, :4) = spread(mean, 1, rule%n)
      else if (IS_REDUCED(geometry%state)) then
         call spread_gradients(rule%n, geometry%shape, geometry%x, geometry%gradient)
      end if
   end subroutine fetch_geometry

   !> Places, Jacobians and gradients at the points: with J = dx/dxi the gradient of a shape function is J^-T dN/dxi, h below being
   !> J^-1 = d(xi, eta)/d(x, y). `steepness`, the sum of the squares of J^-1, is about 1/h^2 of an element of size h: round-off of
   !> displacements makes strains of the order eps |u| times its root (atrito_error_estimate). All points go through a loop
   !> together, which is what the compiler wants.
   pure subroutine map_points(rule, geometry)
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(inout) :: geometry
      real(wp), dimension(MOST_POINTS, 2) :: dx, dy  !< derivatives along xi and eta
      real(wp), dimension(MOST_POINTS) :: h11, h12, h21, h22 !< d(xi, eta)/d(x, y)
      integer(ip) :: k, direction, n

      n = rule%n
      dx = 0.0_wp
      dy = 0.0_wp
      geometry%place(:n, :) = 0.0_wp
      do k = 2, geometry%shape                   ! the first node is the origin
         do direction = 1, 2
            dx(:n, direction) = dx(:n, direction) + geometry%x(1, k)*rule%slope(:n, direction, k)
            dy(:n, direction) = dy(:n, direction) + geometry%x(2, k)*rule%slope(:n, direction, k)
            geometry%place(:n, direction) = geometry%place(:n, direction) + geometry%x(direction, k)*rule%value(:n, k)
         end do
      end do
      geometry%jacobian(:n) = dx(:n, 1)*dy(:n, 2) - dx(:n, 2)*dy(:n, 1)
      h11(:n) = dy(:n, 2)/geometry%jacobian(:n)
      h12(:n) = -dx(:n, 2)/geometry%jacobian(:n)
      h21(:n) = -dy(:n, 1)/geometry%jacobian(:n)
      h22(:n) = dx(:n, 1)/geometry%jacobian(:n)
      geometry%steepness(:n) = h11(:n)**2 + h12(:n)**2 + h21(:n)**2 + h22(:n)**2
      do k = 2, geometry%shape
         geometry%gradient(:n, 1, k) = rule%slope(:n, 1, k)*h11(:n) + rule%slope(:n, 2, k)*h21(:n)
         geometry%gradient(:n, 2, k) = rule%slope(:n, 1, k)*h12(:n) + rule%slope(:n, 2, k)*h22(:n)
      end do
   end subroutine map_points

   !> s11, s22, s12 of an element at the points [F/L^2], s = D (e - e_th) with the strains e = sum_k B_k u_k.
   !>
   !> The strains are those that the stiffness knows. With the mean dilatation that of each point is replaced by the mean theta_m of
   !> the element: e11 and e22 get (theta_m - e11 - e22)/2 each, of rings a third of what is missing in each direction. With reduced
   !> integration they are spread from its points (fetch_geometry). Displacements are taken relative to the first node, so that a
   !> rigid translation costs no digits. Axisymmetric elements have a hoop stress s33 of its own.
   pure subroutine point_stresses(fem, e, u, rule, geometry, s, hoop)
      type(fem_t), intent(in) :: fem                         !< mesh, sections and temperatures are read
      integer(ip), intent(in) :: e                           !< place in the mesh
      real(wp), intent(in) :: u(:, :)                        !< (2, n_nodes) [L]
      type(point_rule_t), intent(in) :: rule                 !< that of the element's shape
      type(point_geometry_t), intent(in) :: geometry         !< of the element by the rule
      real(wp), intent(inout) :: s(MOST_POINTS, COMPONENTS)  !< the first rule%n are set
      real(wp), intent(inout), optional :: hoop(MOST_POINTS) !< s33 [F/L^2]; the first rule%n are set, of axisymmetric elements
      real(wp) :: way(2, MOST_NODES), dilatation
      integer(ip) :: k, first

      first = fem%mesh%nodes(1, e)
      do k = 1, geometry%shape
         way(:, k) = u(:, fem%mesh%nodes(k, e)) - u(:, first)
      end do
      select case (rule%n)                       ! the compiler makes much more of numbers than of n
      case (1_ip)
         call strain_points(1_ip, geometry%shape, geometry%gradient, way, s)
      case (4_ip)
         call strain_points(4_ip, geometry%shape, geometry%gradient, way, s)
      case default
         call strain_points(rule%n, geometry%shape, geometry%gradient, way, s)
      end select
      if (geometry%has_hoop) then
         call axisymmetric_stresses(rule, geometry, way, u(1, first), s, hoop)
      else
         if (geometry%averages) then
            dilatation = sum(geometry%mean*way(:, :MOST_CORNERS))
            do k = 1, rule%n
               s(k, 1:2) = s(k, 1:2) + 0.5_wp*(dilatation - (s(k, 1) + s(k, 2)))
            end do
         end if
         if (geometry%is_orthotropic) then
            s(:rule%n, :) = matmul(s(:rule%n, :), geometry%d)
         else
            call strains_to_stresses(rule%n, geometry%d, s)
         end if
      end if
      if (allocated(fem%heating)) call subtract_thermal_stress(fem, e, rule, geometry, s, hoop)
   end subroutine point_stresses

   !> sigma = D (e - e_th): what the strains of the temperature take from the stresses.
   pure subroutine subtract_thermal_stress(fem, e, rule, geometry, s, hoop)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(in) :: geometry
      real(wp), intent(inout) :: s(MOST_POINTS, COMPONENTS)
      real(wp), intent(inout), optional :: hoop(MOST_POINTS)
      real(wp) :: strain(MOST_POINTS), b(COMPONENTS + 1)
      integer(ip) :: i

      if (.not. abs(fem%sections(geometry%section)%expansion) > 0.0_wp) return
      call point_thermal_strains(fem, e, rule, geometry, strain)
      b = thermal_stresses(fem%sections(geometry%section), geometry%state)
      do i = 1, COMPONENTS
         s(:rule%n, i) = s(:rule%n, i) - b(i)*strain(:rule%n)
      end do
      if (present(hoop) .and. geometry%has_hoop) hoop(:rule%n) = hoop(:rule%n) - b(COMPONENTS + 1)*strain(:rule%n)
   end subroutine subtract_thermal_stress

   !> The strains of the temperature at the points, alpha times its rise, which the element's shape functions interpolate: as the
   !> stiffness knows its strains, with reduced integration from its points alone, with the mean dilatation in the mean.
   pure subroutine point_thermal_strains(fem, e, rule, geometry, strain)
      type(fem_t), intent(in) :: fem                 !< with temperatures
      integer(ip), intent(in) :: e                   !< place in the mesh
      type(point_rule_t), intent(in) :: rule         !< that of the element's shape
      type(point_geometry_t), intent(in) :: geometry !< of the element by the rule
      real(wp), intent(out) :: strain(MOST_POINTS)   !< the first rule%n are set
      real(wp) :: value(MOST_POINTS, MOST_NODES), rise(MOST_NODES), volume
      integer(ip) :: n

      n = geometry%shape
      rise(:n) = fem%heating(fem%mesh%nodes(:n, e))
      strain = 0.0_wp
      if (takes_means(geometry)) then
         call find_means(geometry, value(1, :n), volume)
         strain(:rule%n) = dot_product(value(1, :n), rise(:n))
      else if (IS_REDUCED(geometry%state)) then
         call spread_values(rule%n, n, value)
         strain(:rule%n) = matmul(value(:rule%n, :n), rise(:n))
      else
         strain(:rule%n) = matmul(rule%value(:rule%n, :n), rise(:n))
      end if
      strain(:rule%n) = fem%sections(geometry%section)%expansion*strain(:rule%n)
   end subroutine point_thermal_strains

   !> What stands behind a point of an element.
   pure real(wp) function point_depth(geometry, rule, i, thickness, x1) result(depth)
      type(point_geometry_t), intent(in) :: geometry !< of the element by the rule
      type(point_rule_t), intent(in) :: rule         !< that of the element's shape
      integer(ip), intent(in) :: i                   !< point
      real(wp), intent(in) :: thickness              !< of the section [L]
      real(wp), intent(in) :: x1                     !< of the element's first node [L]

      if (IS_TAPERED(geometry%state)) then
         depth = depth_at(geometry%state, thickness, dot_product(rule%value(i, :geometry%shape), &
                                                                 geometry%thickness(:geometry%shape)))
      else
         depth = depth_at(geometry%state, thickness, x1 + geometry%place(i, 1))
      end if
   end function point_depth

   !> Means of the shape functions over the volume, and that of the full circle where there is one, else the area times the unit.
   pure subroutine find_means(geometry, mean, volume)
      type(point_geometry_t), intent(in) :: geometry !< of the element
      real(wp), intent(out) :: mean(geometry%shape)  !< means of the shape functions
      real(wp), intent(out) :: volume                !< [L^3]; without a circle the area [L^2], or taper times it
      real(wp) :: xi(2), weight, j(2, 2), n(geometry%shape)
      integer(ip) :: k

      mean = 0.0_wp
      volume = 0.0_wp
      do k = 1, SHAPES(geometry%shape)%n_points
         call rule_point(geometry%shape, SHAPES(geometry%shape)%n_points, k, xi, weight)
         j = matmul(geometry%x(:, :geometry%shape), shape_gradients(geometry%shape, xi))
         n = shape_values(geometry%shape, xi)
         weight = weight*(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))
         if (IS_TAPERED(geometry%state)) then
            weight = weight*dot_product(n, geometry%thickness(:geometry%shape))
         else
            weight = weight*depth_at(geometry%state, 1.0_wp, geometry%radius + dot_product(n, geometry%x(1, :geometry%shape)))
         end if
         mean = mean + weight*n
         volume = volume + weight
      end do
      mean = mean/volume
   end subroutine find_means

   !> Whether the strains are means over the volume: the mean dilatation, and all those of some reduced elements.
   pure logical function takes_means(geometry)
      type(point_geometry_t), intent(in) :: geometry !< of the element

      takes_means = geometry%averages .or. has_mean_strains(geometry)
   end function takes_means

   !> Whether all strains are means over the volume: of four nodes with reduced integration where the depth varies.
   pure logical function has_mean_strains(geometry)
      type(point_geometry_t), intent(in) :: geometry

      has_mean_strains = geometry%shape == 4 .and. IS_REDUCED(geometry%state) &
                         .and. (geometry%has_hoop .or. IS_TAPERED(geometry%state))
   end function has_mean_strains

   !> From the strains in the plane to the stresses of an axisymmetric element.
   pure subroutine axisymmetric_stresses(rule, geometry, way, u, s, hoop)
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(in) :: geometry
      real(wp), intent(in) :: way(2, MOST_NODES) !< displacements less those of the first node [L]
      real(wp), intent(in) :: u                  !< the first node's, along the radius [L]
      real(wp), intent(inout) :: s(MOST_POINTS, COMPONENTS) !< strains; stresses on return
      real(wp), intent(inout), optional :: hoop(MOST_POINTS)
      real(wp) :: at_point(COMPONENTS), e11, e22, e33, s33, excess
      integer(ip) :: k, n

      n = geometry%shape
      do k = 1, rule%n
         e11 = s(k, 1)
         e22 = s(k, 2)
         e33 = hoop_strain(rule, geometry, k, way, u)
         if (geometry%averages) then             ! the mean dilatation, a third of it in each direction
            excess = sum(geometry%mean(:, :n)*way(:, :n)) + u*sum(geometry%mean(1, :n)) - (e11 + e22 + e33)
            e11 = e11 + excess/3
            e22 = e22 + excess/3
            e33 = e33 + excess/3
         end if
         at_point = matmul(geometry%d, [e11, e22, s(k, 3)])
         if (geometry%is_orthotropic) then
            at_point = at_point + geometry%across(:COMPONENTS)*e33
            s33 = dot_product(geometry%across, [e11, e22, s(k, 3), e33])
         else
            ! what a hoop strain adds to the stresses in the plane, and its own stress
            at_point(1:2) = at_point(1:2) + geometry%d(1, 2)*e33
            s33 = geometry%d(1, 2)*(e11 + e22) + geometry%d(1, 1)*e33
         end if
         s(k, :) = at_point
         if (present(hoop)) hoop(k) = s33
      end do
   end subroutine axisymmetric_stresses

   !> u1/x1 at a point of an axisymmetric element.
   pure real(wp) function hoop_strain(rule, geometry, k, way, u)
      type(point_rule_t), intent(in) :: rule         !< that of the element's shape
      type(point_geometry_t), intent(in) :: geometry !< of the axisymmetric element by the rule
      integer(ip), intent(in) :: k                   !< point, 1 .. rule%n
      real(wp), intent(in) :: way(2, MOST_NODES)     !< displacements less those of the first node [L]
      real(wp), intent(in) :: u                      !< the first node's, along the radius [L]

      associate (n => geometry%shape)
         if (IS_REDUCED(geometry%state)) then
            hoop_strain = dot_product(geometry%hoop(k, :n), u + way(1, :n))
         else
            hoop_strain = (u + dot_product(rule%value(k, :n), way(1, :n)))/(geometry%radius + geometry%place(k, 1))
         end if
      end associate
   end function hoop_strain

   !> e11 = sum_k g_k1 u_k1, e22 = sum_k g_k2 u_k2, 2 e12 = sum_k (g_k2 u_k1 + g_k1 u_k2) at n points; the first node's
   !> displacements are taken off the others and have no term.
   pure subroutine strain_points(n, shape, gradient, way, e)
      integer(ip), intent(in) :: n, shape
      real(wp), intent(in) :: gradient(MOST_POINTS, 2, MOST_NODES), way(2, MOST_NODES)
      real(wp), intent(inout) :: e(MOST_POINTS, COMPONENTS) !< e11, e22, 2 e12
      integer(ip) :: k

      e(:n, :) = 0.0_wp
      do k = 2, shape
         e(:n, 1) = e(:n, 1) + gradient(:n, 1, k)*way(1, k)
         e(:n, 2) = e(:n, 2) + gradient(:n, 2, k)*way(2, k)
         e(:n, 3) = e(:n, 3) + (gradient(:n, 2, k)*way(1, k) + gradient(:n, 1, k)*way(2, k))
      end do
   end subroutine strain_points

   !> s <- D s of an isotropic D, whose entries between normal and shear components are 0.
   pure subroutine strains_to_stresses(n, d, s)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: d(COMPONENTS, COMPONENTS)
      real(wp), intent(inout) :: s(MOST_POINTS, COMPONENTS)
      real(wp) :: e11
      integer(ip) :: i

      do i = 1, n
         e11 = s(i, 1)
         s(i, 1) = d(1, 1)*e11 + d(1, 2)*s(i, 2)
         s(i, 2) = d(1, 2)*e11 + d(2, 2)*s(i, 2)
         s(i, 3) = d(3, 3)*s(i, 3)
      end do
   end subroutine strains_to_stresses

end module atrito_point_stress
