!> What acts along the sides and within the elements, as the bound of the error needs it: tractions and forces per volume, not
!> forces at nodes.
module atrito_proof_loads
   use atrito_assembly, only: fem_t
   use atrito_face_geometry, only: outward_normal
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: depth_places, face_nodes
   use atrito_mesh_sides, only: mesh_sides_t
   use atrito_model, only: model_t, step_t, LOAD_HYDROSTATIC, LOAD_LINEAR, LOAD_TRACTION, is_on_volume
   use atrito_nodal_loads, only: forces_of_load
   use atrito_plane_state, only: IS_TAPERED, STATES
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: proof_loads_t, take_loads

   type :: proof_loads_t
      logical, allocatable :: known(:, :)           !< (2, sides) by component: the traction is a datum
      real(wp), allocatable :: traction(:, :, :)    !< (2, 0:k, sides) Bernstein coefficients on the first element [F/L]
      real(wp), allocatable :: volume(:, :)         !< (2, n_elements) thickness times force per volume [F/L^2]
      real(wp), allocatable :: at_nodes(:, :, :)    !< (2, nodes, n_elements) its forces on the nodes of each element [F]
   end type proof_loads_t

   real(wp), parameter :: ROUND_OFF = 1.0e-10_wp    !< of the largest force: a reaction below it holds nothing
   real(wp), parameter :: CURVED = 1.0e-9_wp        !< of a side: what its middle node may be off the chord

contains

   !> The loads of a time, and which tractions are known: those of sides that no support holds.
   !>
   !> why_not: what acts at single points, or has no polynomial of degree k along a side.
   subroutine take_loads(model, acting, fem, sides, degree, held, reaction, loads, why_not)
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: acting            !< with the loads of the time
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      integer(ip), intent(in) :: degree             !< k
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      real(wp), intent(in) :: reaction(:, :)        !< (2, n_nodes) [F]
      type(proof_loads_t), intent(out) :: loads
      character(len=:), allocatable, intent(inout) :: why_not
      integer(ip) :: i, c
      real(wp) :: chord(2)

      associate (mesh => fem%mesh)
         do i = 1, mesh%n_elements
            if (STATES(mesh%state(i))%has_hoop) why_not = 'rings: their stresses are no polynomials'
            if (IS_TAPERED(mesh%state(i))) why_not = 'elements of varying thickness'
            if (allocated(why_not)) return
         end do
         do i = 1, sides%n
            if (sides%middle(i) == 0) cycle
            chord = mesh%x(:, sides%node(2, i)) - mesh%x(:, sides%node(1, i))
            if (norm2(mesh%x(:, sides%middle(i)) - 0.5_wp*(mesh%x(:, sides%node(1, i)) + mesh%x(:, sides%node(2, i)))) > &
                CURVED*norm2(chord)) then
               why_not = 'curved sides'
               return
            end if
         end do
         do i = 1, acting%node_loads%n
            if (acting%node_loads%value(i) /= 0.0_wp) then
               why_not = 'node '//to_text(mesh%node_id(acting%node_loads%node(i)))//' carries a force at a point'
               return
            end if
         end do
         allocate (loads%known(2, sides%n))
         allocate (loads%traction(2, 0:degree, sides%n), loads%volume(2, mesh%n_elements), &
                   loads%at_nodes(2, maxval(mesh%shape(:mesh%n_elements)), mesh%n_elements), source=0.0_wp)
         do i = 1, sides%n
            do c = 1, 2
               loads%known(c, i) = sides%element(2, i) == 0 .and. .not. all(held(c, sides%node(1:2, i)))
               if (sides%element(2, i) == 0 .and. sides%middle(i) > 0 .and. .not. loads%known(c, i)) then
                  if (.not. held(c, sides%middle(i))) why_not = 'a support that leaves the middle of a side'
               end if
            end do
         end do
      end associate
      call find_point_supports(fem, sides, held, reaction, loads%known, why_not)
      do i = 1, acting%element_loads%n
         if (allocated(why_not)) return
         call take_load(model, acting, i, fem, sides, loads, why_not)
      end do
   end subroutine take_loads

   !> One load on an element.
   subroutine take_load(model, acting, i, fem, sides, loads, why_not)
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: acting            !< with the loads of the time
      integer(ip), intent(in) :: i                  !< load
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      type(proof_loads_t), intent(inout) :: loads
      character(len=:), allocatable, intent(inout) :: why_not
      integer(ip) :: e, side, j, degree
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: fe(:, :)
      real(wp) :: thickness, n(2), x(2), ends(2, 2), depth

      degree = ubound(loads%traction, 2, kind=ip)
      associate (of => acting%element_loads, mesh => fem%mesh)
         e = of%element(i)
         thickness = fem%sections(fem%section_of(e))%thickness
         if (is_on_volume(of%kind(i))) then
            if (of%kind(i) == LOAD_LINEAR .and. any(of%value(:, i) /= 0.0_wp)) then
               why_not = 'forces per volume that vary'
               return
            end if
            loads%volume(:, e) = loads%volume(:, e) + thickness*of%value(:2, i)
            nodes = mesh%nodes(:mesh%shape(e), e)
            allocate (fe(2, size(nodes)))
            call forces_of_load(model, of, i, mesh%x(:, nodes), depth_places(mesh, mesh%state(e), nodes), fe)
            loads%at_nodes(:, :size(nodes), e) = loads%at_nodes(:, :size(nodes), e) + fe
            return
         end if
         side = sides%of_element(of%face(i), e)
         nodes = face_nodes(mesh, e, of%face(i))
         n = outward_normal(mesh%x(:, nodes(:2)), 0.0_wp)
         do j = 1, 2
            x = mesh%x(:, nodes(j))
            select case (of%kind(i))
            case (LOAD_TRACTION)
               ends(:, j) = of%value(:2, i)
            case (LOAD_HYDROSTATIC)
               depth = (x(2) - of%value(2, i))/(of%value(3, i) - of%value(2, i))
               ends(:, j) = -of%value(1, i)*max(depth, 0.0_wp)*n
               if (depth < 0.0_wp) side = -abs(side)
            case default
               ends(:, j) = -(of%value(1, i) + dot_product(of%value(2:3, i), x))*n
            end select
         end do
         if (side < 0) then
            if (any(ends /= 0.0_wp)) why_not = 'a water level within a side'
            side = -side
         end if
         if (side == 0) return
         do j = 0, degree
            loads%traction(:, j, side) = loads%traction(:, j, side) &
                                         + thickness*((1 - real(j, wp)/degree)*ends(:, 1) + real(j, wp)/degree*ends(:, 2))
         end do
         if (sides%element(2, side) > 0) why_not = 'a load on a side within a body'
         do j = 0, degree                           ! along a support it is what is looked for
            where (.not. loads%known(:, side)) loads%traction(:, j, side) = 0.0_wp
         end do
      end associate
   end subroutine take_load

   !> Supports of single nodes: the energy of a force at a point of a continuum is infinite, so no bound exists where one holds
   !> anything.
   subroutine find_point_supports(fem, sides, held, reaction, known, why_not)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      logical, intent(in) :: held(:, :), known(:, :)
      real(wp), intent(in) :: reaction(:, :)
      character(len=:), allocatable, intent(inout) :: why_not
      logical, allocatable :: is_on_side(:, :)
      integer(ip) :: i, c
      real(wp) :: largest

      allocate (is_on_side(2, size(held, 2)), source=.false.)
      do i = 1, sides%n
         if (sides%element(2, i) > 0) cycle
         do c = 1, 2
            if (known(c, i)) cycle
            is_on_side(c, sides%node(1:2, i)) = .true.
            if (sides%middle(i) > 0) is_on_side(c, sides%middle(i)) = .true.
         end do
      end do
      largest = maxval(abs(reaction))
      do i = 1, fem%mesh%n_nodes
         if (fem%bodies%of_node(i) == 0) cycle
         if (any(held(:, i) .and. .not. is_on_side(:, i) .and. abs(reaction(:, i)) > ROUND_OFF*largest)) then
            why_not = 'the support at node '//to_text(fem%mesh%node_id(i))//' is a point'
            return
         end if
      end do
   end subroutine find_point_supports

end module atrito_proof_loads
