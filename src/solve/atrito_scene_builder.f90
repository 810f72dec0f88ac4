!> From the model to the bodies with their equations and the points of the contact line.
module atrito_scene_builder
   use atrito_kinds, only: ip, wp
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: find_bodies, number_equations, find_rigid_modes
   use atrito_elasticity, only: elastic_t
   use atrito_faces, only: face_list_t
   use atrito_model, only: model_t, SURFACE_SEGMENTS
   use atrito_points, only: contact_points_t, pair_surfaces
   use atrito_solver_choice, only: needs_profile
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_scene, build_bodies, section_thickness, pair_points

contains

   !> Mesh and sections, prescribed dofs and values, and the points of every pair; build_bodies adds the bodies.
   subroutine build_scene(model, fem, held, value, points)
      type(model_t), intent(in), target :: model
      type(fem_t), intent(out) :: fem
      logical, allocatable, intent(out) :: held(:, :)          !< (2, n_nodes)
      real(wp), allocatable, intent(out) :: value(:, :)        !< (2, n_nodes) prescribed displacements [L]
      type(contact_points_t), allocatable, intent(out) :: points(:) !< one a pair
      integer(ip) :: i

      fem%mesh => model%mesh
      fem%section_of = model%section_of
      allocate (fem%sections(size(model%sections)))
      do i = 1, size(model%sections, kind=ip)
         associate (section => model%sections(i), material => model%materials(model%sections(i)%material))
            fem%sections(i) = elastic_t(material%young, material%poisson, section%thickness, material%density, &
                                        section%formulation)
         end associate
      end do
      call list_prescribed(model, held, value)
      allocate (points(size(model%pairs)))
      do i = 1, size(model%pairs, kind=ip)
         call pair_points(model, i, points(i))
      end do
   end subroutine build_scene

   !> Bodies, equations (contact nodes last) and rigid motions.
   subroutine build_bodies(model, held, points, asked, fem)
      type(model_t), intent(in) :: model
      logical, intent(in) :: held(:, :)                        !< (2, n_nodes)
      type(contact_points_t), intent(in) :: points(:)
      integer, intent(in) :: asked                             !< storage asked for, or 0
      type(fem_t), intent(inout) :: fem
      integer(ip) :: i, n_free

      call find_bodies(fem%mesh, fem%bodies)
      call name_bodies(model, fem)
      do i = 1, fem%bodies%n
         n_free = count(.not. held(:, fem%bodies%list(i)%nodes), kind=ip)
         call number_equations(fem%mesh, fem%bodies, i, held, contact_nodes(fem, i, points), needs_profile(asked, n_free))
         call find_rigid_modes(fem%mesh, fem%bodies%list(i), held)
      end do
   end subroutine build_bodies

   pure subroutine list_prescribed(model, held, value)
      type(model_t), intent(in) :: model
      logical, allocatable, intent(out) :: held(:, :)
      real(wp), allocatable, intent(out) :: value(:, :)
      integer(ip) :: i

      allocate (held(2, model%mesh%n_nodes), source=.false.)
      allocate (value(2, model%mesh%n_nodes), source=0.0_wp)
      do i = 1, model%prescribed%n
         held(model%prescribed%dof(i), model%prescribed%node(i)) = .true.
         value(model%prescribed%dof(i), model%prescribed%node(i)) = model%prescribed%value(i)
      end do
   end subroutine list_prescribed

   !> The points of one pair.
   pure subroutine pair_points(model, i, points)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i
      type(contact_points_t), intent(out) :: points
      type(face_list_t) :: no_faces
      real(wp) :: no_points(2, 0)

      associate (slave => model%surfaces(model%pairs(i)%slave), master => model%surfaces(model%pairs(i)%master))
         if (master%kind == SURFACE_SEGMENTS) then
            call pair_surfaces(model%mesh, section_thickness(model), slave%faces, no_faces, master%points, points, &
                               master%is_arc, master%centre)
         else
            call pair_surfaces(model%mesh, section_thickness(model), slave%faces, master%faces, no_points, points)
         end if
      end associate
   end subroutine pair_points

   !> Thickness [L] of each element.
   pure function section_thickness(model) result(thickness)
      type(model_t), intent(in) :: model
      real(wp) :: thickness(model%mesh%n_elements)
      integer(ip) :: e

      do e = 1, model%mesh%n_elements
         thickness(e) = model%sections(model%section_of(e))%thickness
      end do
   end function section_thickness

   !> A body is called after the element set of its section; bodies that share one get a number as well.
   pure subroutine name_bodies(model, fem)
      type(model_t), intent(in) :: model
      type(fem_t), intent(inout) :: fem
      integer(ip) :: first(fem%bodies%n), i

      do i = 1, fem%bodies%n
         first(i) = model%section_of(fem%bodies%list(i)%elements(1))
      end do
      do i = 1, fem%bodies%n
         fem%bodies%list(i)%name = model%sections(first(i))%elset
         if (count(first == first(i)) > 1) fem%bodies%list(i)%name = fem%bodies%list(i)%name//'-'//to_text(i)
      end do
   end subroutine name_bodies

   !> The nodes of a body that take part in contact, each once, in the order of the points.
   function contact_nodes(fem, i_body, points) result(nodes)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      type(contact_points_t), intent(in) :: points(:)
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i, j, k, n
      logical, allocatable :: taken(:)

      allocate (taken(fem%mesh%n_nodes))
      taken = fem%bodies%of_node /= i_body
      allocate (nodes(count(.not. taken)))
      n = 0
      do i = 1, size(points, kind=ip)
         do j = 1, points(i)%n
            call take(points(i)%node(j))
            do k = 1, points(i)%n_master(j)
               if (points(i)%master_shape(k, j) /= 0.0_wp) call take(points(i)%master_node(k, j))
            end do
         end do
      end do
      nodes = nodes(:n)

   contains

      subroutine take(node)
         integer(ip), intent(in) :: node

         if (taken(node)) return
         taken(node) = .true.
         n = n + 1
         nodes(n) = node
      end subroutine take

   end function contact_nodes

end module atrito_scene_builder
