!> Rows of blocks for the tests of shared fields.
module part_cases
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: find_bodies, find_rigid_modes, number_equations
   use atrito_element_table, only: SHAPES
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t, add_block, add_nodes, is_hollow, trim_mesh
   use atrito_plane_state, only: elastic_t
   use random_arrays, only: random_numbers
   implicit none (type, external)
   private
   public :: make_blocks

contains

   !> Blocks side by side from x1 = 1 on with gaps between them, their inner nodes moved a little; the contact nodes of each are its
   !> upper side.
   subroutine make_blocks(state, shape, n, is_held, fem, held)
      integer(ip), intent(in) :: state, shape
      integer(ip), intent(in) :: n(:, :)         !< (2, blocks) elements, or pairs of triangles, along the sides of each
      logical, intent(in) :: is_held             !< the lower side of each is
      type(fem_t), intent(out) :: fem
      logical, allocatable, intent(out) :: held(:, :) !< (2, n_nodes)
      integer(ip), allocatable :: upper(:, :)
      integer(ip) :: b, i, j, e
      real(wp) :: x1

      allocate (fem%mesh)
      allocate (upper(2, size(n, 2)), source=0_ip)
      x1 = 1.0_wp
      do b = 1, size(n, 2, kind=ip)
         call add_one(state, shape, n(:, b), x1, fem%mesh, upper(:, b))
         x1 = x1 + 1.1_wp*real(n(1, b), wp)
      end do
      call trim_mesh(fem%mesh)
      fem%sections = [elastic_t(100.0_wp, 0.3_wp, 1.0_wp, 0.0_wp), elastic_t(300.0_wp, 0.2_wp, 2.0_wp, 0.0_wp)]
      fem%section_of = [(merge(1_ip, 2_ip, mod(e, 3_ip) == 0), e=1, fem%mesh%n_elements)]
      allocate (held(2, fem%mesh%n_nodes))
      held = spread(fem%mesh%x(2, :) < 1.0e-6_wp .and. is_held, 1, 2)
      held(2, :) = held(2, :) .and. fem%mesh%x(1, :) > 1.5_wp
      call find_bodies(fem%mesh, fem%bodies)
      do b = 1, fem%bodies%n
         fem%bodies%list(b)%name = 'BLOCK'
         i = upper(1, b)
         j = upper(2, b)
         call number_equations(fem%mesh, fem%bodies, b, held, [(e, e=i, j)], mod(b, 2_ip) == 0)
         call find_rigid_modes(fem%mesh, fem%bodies%list(b), held)
      end do
   end subroutine make_blocks

   subroutine add_one(state, shape, n, x1, mesh, upper)
      integer(ip), intent(in) :: state, shape, n(2)
      real(wp), intent(in) :: x1
      type(mesh_t), intent(inout) :: mesh
      integer(ip), intent(out) :: upper(2)       !< first and last node of the upper side
      integer(ip), allocatable :: place(:, :)
      real(wp), allocatable :: x(:, :)
      real(wp) :: noise(2)
      integer(lp) :: state_of_noise
      integer(ip) :: d, i, j, k

      d = SHAPES(shape)%degree
      state_of_noise = 4711_lp
      allocate (place(0:d*n(1), 0:d*n(2)), source=0_ip)
      allocate (x(2, size(place)))
      k = 0
      do j = 0, d*n(2)
         do i = 0, d*n(1)
            if (is_hollow(shape, i, j)) cycle
            k = k + 1
            place(i, j) = mesh%n_nodes + k
            x(:, k) = [x1, 0.0_wp] + [real(i, wp), real(j, wp)]/real(d, wp)
            if (i == 0 .or. j == 0 .or. i == d*n(1) .or. j == d*n(2)) cycle
            call random_numbers(state_of_noise, noise)
            x(:, k) = x(:, k) + 0.05_wp*noise
         end do
      end do
      upper = [place(0, d*n(2)), place(d*n(1), d*n(2))]
      call add_nodes(mesh, mesh%n_nodes + 1, x(:, :k))
      call add_block(mesh, mesh%n_elements + 1, state, shape, place)
   end subroutine add_one

end module part_cases
