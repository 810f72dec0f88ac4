!> What the two matrices of a scene (atrito_assembled_scene, atrito_shared_scene) have in common: the numbers of the unknowns, the
!> right hand sides of the rows, and the loads.
!>
!>     g0 = B u_prescribed - gap (or rest slip)      what the rows see without displacements
!>     c_i = sum over the nodes of row i of d' K_n^-1 d, d its entries there, K_n the 2 x 2 stiffness of the node by itself
!>     f, and h = Z' f on the amplitudes
!>
!> c_i, the flexibility of the row as its own nodes have it, is the same however the scene is turned. It is the scale of rho and of
!> the pull, so nothing depends on units.
module atrito_scene_system
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t, rest_of
   use atrito_contact_rows, only: contact_rows_t, row_value, vector_of_entry
   use atrito_contact_system, only: contact_system_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_row_entries, only: direction_of, loads_on_motions
   use atrito_scene_elimination, only: scene_numbering_t
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: scene_system_t, set_scene_gaps, set_flexibility, set_scene_load, displacements_of

   type, extends(contact_system_t), abstract :: scene_system_t
      type(scene_numbering_t) :: numbering
      logical :: is_near = .false.               !< fronts have one matrix for elements that are near, and not equal
      character(len=:), allocatable :: order     !< how the order of elimination was found
      type(status_t), pointer :: failure => null() !< of the first solve that failed, where one can: solve itself has no status
   contains
      procedure(count_solving_bytes), deferred :: solving_bytes
      procedure :: check_solves => take_trouble
      procedure :: release => release_load
   end type scene_system_t

   abstract interface

      !> What solving will take beyond what the scene holds before its first factorisation [bytes].
      pure integer(lp) function count_solving_bytes(self)
         import :: scene_system_t, lp
         class(scene_system_t), intent(in) :: self
      end function count_solving_bytes

   end interface

   !> A load on a motion of at most this share of what it is the sum of is none.
   real(wp), parameter :: LOAD_ROUND_OFF = 1.0e-13_wp

contains

   !> Whether a solve has failed since this was asked last. status: STATUS_INTERNAL then, in place of what it was; else it stays.
   !>
   !> A solve over processes may fail in one of them; the interface of a solve has no status, so it is asked afterwards.
   subroutine take_trouble(self, status)
      class(scene_system_t), intent(in) :: self
      type(status_t), intent(inout) :: status

      if (.not. associated(self%failure)) return
      if (is_ok(self%failure)) return
      status = self%failure
      self%failure = status_t()
   end subroutine take_trouble

   !> Lets go of the loads; what extends the type, of what other processes hold for it, too. The rest goes with the scene.
   subroutine release_load(self)
      class(scene_system_t), intent(inout) :: self

      if (allocated(self%load)) deallocate (self%load, self%size_of_load)
   end subroutine release_load

   !> What prescribed displacements, initial gaps and rest slips leave of the rows: g0.
   !>
   !> The same numbers as in the condensed form (set_right_hand_sides), but for what the loads do: here displacements are unknowns.
   subroutine set_scene_gaps(rows, line, value, scene)
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      real(wp), intent(in) :: value(:, :)        !< (2, n_nodes) prescribed displacements [L]
      class(scene_system_t), intent(inout) :: scene
      integer(ip) :: i

      if (.not. allocated(scene%g0)) allocate (scene%g0(scene%rows%n))
      do i = 1, scene%rows%n
         associate (j => line%point(i))
            scene%g0(i) = row_value(rows, j, direction_of(rows, line, i), value)
            if (line%normal(j) == i) then
               scene%g0(i) = scene%g0(i) - rows%gap(j)
            else
               scene%g0(i) = scene%g0(i) - rest_of(line, j)
            end if
         end associate
      end do
   end subroutine set_scene_gaps

   !> b' K^-1 b over the displacements of a row, with the stiffness of each node by itself: the same however the scene is turned.
   !>
   !> A row without free displacements, between a held node and a rigid surface, has none; it gets that of the softest row, so that
   !> rho is no less there than elsewhere.
   subroutine set_flexibility(fem, rows, line, diagonal, coupling, scene)
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      real(wp), intent(in) :: diagonal(:), coupling(:) !< (n) of the stiffness (sum_diagonals), at the nodes of the rows at least
      class(scene_system_t), intent(inout) :: scene
      real(wp) :: d(2)
      integer(ip) :: i, j, k, node, first

      allocate (scene%flexibility(scene%rows%n), source=0.0_wp)
      do i = 1, scene%rows%n
         j = line%point(i)
         do k = rows%first(j), rows%first(j + 1) - 1
            node = rows%node(k)
            d = vector_of_entry(rows, j, k, direction_of(rows, line, i))
            first = scene%numbering%before(fem%bodies%of_node(node))
            scene%flexibility(i) = scene%flexibility(i) &
                                   + node_flexibility(fem%bodies%equation(:, node), first, diagonal, coupling, d)
         end do
      end do
      ! between a held node and a rigid surface, which moves, nothing gives way
      if (any(scene%flexibility > 0.0_wp)) then
         where (scene%flexibility <= 0.0_wp) scene%flexibility = maxval(scene%flexibility)
      else if (scene%n > scene%k) then
         scene%flexibility = 1.0_wp/maxval(diagonal(:scene%n - scene%k))
      end if
   end subroutine set_flexibility

   !> d' K^-1 d for the free displacements of a node.
   !>
   !> By elimination of the first displacement: d1^2/k11 + (d2 - d1 k12/k11)^2/(k22 - k12^2/k11). One that is held takes no part.
   pure real(wp) function node_flexibility(equation, before, diagonal, coupling, d) result(c)
      integer(ip), intent(in) :: equation(2), before
      real(wp), intent(in) :: diagonal(:), coupling(:) !< coupling: of a displacement with the other one of its node, at the first
      real(wp), intent(in) :: d(2)
      real(wp) :: k11, k22, k12

      c = 0.0_wp
      if (all(equation > 0)) then
         k11 = diagonal(before + equation(1))
         k22 = diagonal(before + equation(2))
         k12 = coupling(before + equation(1))
         c = d(1)*(d(1)/k11) + (d(2) - d(1)*(k12/k11))**2/(k22 - k12*(k12/k11))
      else if (equation(1) > 0) then
         c = d(1)**2/diagonal(before + equation(1))
      else if (equation(2) > 0) then
         c = d(2)**2/diagonal(before + equation(2))
      end if
   end function node_flexibility

   !> Takes the applied forces, and those less the forces of the prescribed displacements.
   !>
   !> The load on a motion is the work of the applied forces alone: what prescribed displacements and temperatures do is in balance.
   !> Where its terms cancel but for LOAD_ROUND_OFF it is none, or a body without load would move.
   subroutine set_scene_load(fem, f, free_load, scene)
      type(fem_t), intent(in) :: fem !< bodies and elements
      real(wp), intent(in) :: f(:, :), free_load(:, :) !< (2, n_nodes) [F]
      class(scene_system_t), intent(inout) :: scene
      integer(ip) :: node, dof, b, k

      if (allocated(scene%load)) deallocate (scene%load, scene%size_of_load)
      allocate (scene%load(scene%n), scene%size_of_load(scene%n), source=0.0_wp)
      do node = 1, fem%mesh%n_nodes
         b = fem%bodies%of_node(node)
         if (b == 0) cycle
         do dof = 1, 2
            if (fem%bodies%equation(dof, node) <= 0) cycle
            k = scene%numbering%before(b) + fem%bodies%equation(dof, node)
            scene%load(k) = free_load(dof, node)
            scene%size_of_load(k) = abs(free_load(dof, node))
         end do
      end do
      k = scene%n - scene%k + 1
      call loads_on_motions(fem, f, scene%load(k:), scene%size_of_load(k:))
      where (abs(scene%load(k:)) <= LOAD_ROUND_OFF*scene%size_of_load(k:)) scene%load(k:) = 0.0_wp
   end subroutine set_scene_load

   !> Displacements without rigid motions at the free dofs, (2, n_nodes).
   !>
   !> u_e; u = u_e + Z a is put together when it is recovered (add_rigid_motions).
   pure subroutine displacements_of(fem, scene, x, u)
      type(fem_t), intent(in) :: fem !< bodies and elements
      class(scene_system_t), intent(in) :: scene
      real(wp), intent(in) :: x(:)               !< (n) [L]
      real(wp), intent(inout) :: u(:, :)         !< (2, n_nodes) [L]: the free dofs are set
      integer(ip) :: node, dof, b

      do node = 1, fem%mesh%n_nodes
         b = fem%bodies%of_node(node)
         if (b == 0) cycle
         do dof = 1, 2
            if (fem%bodies%equation(dof, node) > 0) u(dof, node) = x(scene%numbering%before(b) + fem%bodies%equation(dof, node))
         end do
      end do
   end subroutine displacements_of

end module atrito_scene_system
