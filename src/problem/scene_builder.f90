!> From the model to the bodies with their equations and the points of the contact line: the one builder of a scene.
!>
!> 1. build_scene: the mesh and the elasticity of each section, what is prescribed, and the points of every pair (those
!>    that the check of the deck has made). Rigid surfaces that move add three nodes each, which carry their motion
!>    (atrito_rigid_bodies).
!> 2. build_bodies: a body is a connected part of the mesh. Its free displacements are numbered so that those of its
!>    contact nodes are the last ones: a factorisation that stops before them leaves their flexibility, the only thing the
!>    contact line needs of the body. The motions that supports leave the body follow, and rigid bodies behind those of
!>    elements.
module atrito_scene_builder
   use atrito_kinds, only: ip, wp
   use atrito_assembly, only: fem_t, digit_error_of
   use atrito_bilateral_rows, only: bilateral_rows_t
   use atrito_bodies, only: bodies_t, find_bodies, number_equations, find_rigid_modes
   use atrito_body_names, only: name_bodies
   use atrito_incidence, only: list_holders
   use atrito_model, only: model_t, step_t, elasticity_of
   use atrito_pairing, only: pair_all
   use atrito_points, only: contact_points_t
   use atrito_rigid_bodies, only: append_rigid_bodies, attach_points, has_moving_surfaces, hold_carriers
   use atrito_solver_choice, only: needs_profile
   implicit none (type, external)
   private
   public :: build_scene, build_bodies, list_held

contains

   !> Mesh and sections, prescribed dofs and values, and the points of every pair; build_bodies adds the bodies.
   !>
   !> The points are those of the check of the deck, which has paired the sides; a model that was made without a deck is
   !> paired here. digit_error is what the coordinates of the mesh are known to: elements that differ by no more have one
   !> stiffness.
   subroutine build_scene(model, step, fem, held, value, points)
      type(model_t), intent(in), target :: model    !< as refined; its mesh is kept by pointer
      type(step_t), intent(in) :: step              !< what it prescribes
      type(fem_t), intent(out) :: fem               !< mesh, sections and bodies; equations are numbered
      logical, allocatable, intent(out) :: held(:, :)          !< (2, n_nodes)
      real(wp), allocatable, intent(out) :: value(:, :)        !< (2, n_nodes) prescribed displacements [L]
      type(contact_points_t), allocatable, intent(out) :: points(:) !< one a pair
      integer(ip) :: i

      fem%mesh => model%mesh
      if (has_moving_surfaces(model)) fem%mesh => model%solver_mesh
      fem%digit_error = digit_error_of(model%mesh%x(:, :model%mesh%n_nodes))
      fem%section_of = model%section_of
      fem%sections = [(elasticity_of(model%sections(i), model%materials(model%sections(i)%material)), &
                       i=1, size(model%sections, kind=ip))]
      if (allocated(step%heating)) fem%heating = step%heating
      call list_held(model, step, held, value)
      if (allocated(model%points)) then
         points = model%points
      else
         call pair_all(model, points)     ! no deck was checked
      end if
      if (has_moving_surfaces(model)) call attach_points(model, points)
   end subroutine build_scene

   !> Bodies, equations (contact nodes last) and rigid motions. The order of the other equations is made for the solver
   !> of the body: a small profile where it takes one.
   subroutine build_bodies(model, held, points, asked, fem)
      type(model_t), intent(in) :: model                       !< with ties, equations and rigid bodies
      logical, intent(in) :: held(:, :)                        !< (2, n_nodes)
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      integer, intent(in) :: asked                             !< solver asked for, or 0
      type(fem_t), intent(inout) :: fem                        !< with mesh in, bodies out
      integer(ip), allocatable :: first(:), contact_nodes(:)
      integer(ip) :: i, n_free

      call find_bodies(fem%mesh, fem%bodies)
      call name_bodies(model, fem%bodies)
      call list_contact_nodes(fem%bodies, points, model%bilateral, first, contact_nodes)
      do i = 1, fem%bodies%n
         n_free = count(.not. held(:, fem%bodies%list(i)%nodes), kind=ip)
         call number_equations(fem%mesh, fem%bodies, i, held, enough_nodes(fem, i, contact_nodes(first(i):first(i + 1) - 1), &
                                                                           model%bilateral%n > 0), needs_profile(asked, n_free))
         call find_rigid_modes(fem%mesh, fem%bodies%list(i), held)
      end do
      if (has_moving_surfaces(model)) call append_rigid_bodies(model, points, fem%bodies)
   end subroutine build_bodies

   !> The nodes of a body whose displacements are kept by the condensation. A body that hangs on one node alone, by a
   !> tie or a spring, could turn about it while the others are eliminated, and the factorisation would meet a pivot of
   !> nothing: the node that is farthest from it stays, too.
   pure function enough_nodes(fem, b, nodes, hangs) result(kept)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b                             !< body
      integer(ip), intent(in) :: nodes(:)                      !< of it, in contact or bilateral rows
      logical, intent(in) :: hangs                             !< there are rows that single nodes hang on
      integer(ip), allocatable :: kept(:)
      integer(ip) :: i

      kept = nodes
      if (size(nodes) /= 1 .or. .not. hangs) return
      associate (own => fem%bodies%list(b)%nodes, x => fem%mesh%x)
         kept = [nodes, own(maxloc([(norm2(x(:, own(i)) - x(:, nodes(1))), i=1, size(own, kind=ip))], dim=1))]
      end associate
   end function enough_nodes

   !> Prescribed dofs and their displacements, those of the nodes that carry motions of rigid surfaces, too.
   pure subroutine list_held(model, step, held, value)
      type(model_t), intent(in) :: model            !< with supports and prescribed displacements
      type(step_t), intent(in) :: step              !< what it prescribes
      logical, allocatable, intent(out) :: held(:, :)          !< (2, nodes of the solver's mesh)
      real(wp), allocatable, intent(out) :: value(:, :)        !< [L]
      integer(ip) :: i, n_nodes

      n_nodes = model%mesh%n_nodes
      if (has_moving_surfaces(model)) n_nodes = model%solver_mesh%n_nodes
      allocate (held(2, n_nodes), source=.false.)
      allocate (value(2, n_nodes), source=0.0_wp)
      associate (prescribed => step%prescribed)
         do i = 1, prescribed%n
            held(prescribed%dof(i), prescribed%node(i)) = .true.
            value(prescribed%dof(i), prescribed%node(i)) = prescribed%value(i)
         end do
      end associate
      if (has_moving_surfaces(model)) call hold_carriers(model, step%rigid_prescribed, held, value)
   end subroutine list_held

   !> The nodes of each body that take part in contact and bilateral rows, each once, in the order of the points. The
   !> order is that of the last equations of the bodies: neighbours on the contact line stay neighbours in the
   !> flexibility.
   subroutine list_contact_nodes(bodies, points, bilateral, first, nodes)
      type(bodies_t), intent(in) :: bodies          !< body of each node
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(bilateral_rows_t), intent(in) :: bilateral !< rows that tie nodes
      integer(ip), allocatable, intent(out) :: first(:)    !< (bodies + 1)
      integer(ip), allocatable, intent(out) :: nodes(:)    !< those of body i are nodes(first(i):first(i + 1) - 1)
      logical, allocatable :: taken(:)
      integer(ip), allocatable :: place(:)
      integer(ip) :: i, n

      nodes = [(points(i)%entry, i=1, size(points, kind=ip))]
      if (bilateral%n > 0) nodes = [nodes, bilateral%node]
      taken = bodies%of_node == 0
      n = 0
      do i = 1, size(nodes, kind=ip)
         if (taken(nodes(i))) cycle
         taken(nodes(i)) = .true.
         n = n + 1
         nodes(n) = nodes(i)
      end do
      call list_holders(bodies%n, reshape(bodies%of_node(nodes(:n)), [1_ip, n]), first, place)
      nodes = nodes(place)
   end subroutine list_contact_nodes

end module atrito_scene_builder
