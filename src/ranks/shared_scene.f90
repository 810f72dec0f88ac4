!> The matrix of a scene that is cut into parts: the sparse form of the contact system (atrito_contact_system) by direct
!> substructuring.
!>
!> What the iteration needs is here, as for atrito_assembled_scene: numbers, rows, loads and vectors over all unknowns. Elements,
!> matrices and factors are with the parts. A product is the sum of the parts'; a solution is the parts' reduction, the solution of
!> the shared unknowns, and the parts' expansion. Sums are in the order of the parts.
module atrito_shared_scene
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_part_maker, only: make_scene_part
   use atrito_row_entries, only: build_constraint_rows
   use atrito_scene_cut, only: scene_cut_t, plan_cut, diagonals_of_rows
   use atrito_scene_elimination, only: number_scene
   use atrito_scene_part, only: scene_part_t
   use atrito_scene_parts, only: scene_parts_t, part_lists_t
   use atrito_scene_system, only: scene_system_t, set_scene_gaps, set_flexibility
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: shared_scene_t, share_scene

   type, extends(scene_system_t) :: shared_scene_t
      class(scene_parts_t), allocatable :: parts
      type(part_lists_t) :: lists
      integer(ip), allocatable :: rank_of(:)     !< (n_elements)
      integer(ip), allocatable, private :: unknown(:) !< of the scene, of those of the parts one after the other
      integer(ip), allocatable, private :: row(:), pull(:) !< the same of rows and amplitudes
      logical, allocatable, private :: is_kept(:)  !< (unknowns of the parts)
      integer(ip), allocatable, private :: shared(:) !< (n_top) unknown of the scene
   contains
      procedure :: multiply => multiply_shared
      procedure :: factor => factor_shared
      procedure :: solve => solve_shared
      procedure :: memory_bytes => shared_bytes
      procedure :: solving_bytes => shared_solving_bytes
      procedure :: release => release_parts
   end type shared_scene_t

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INDEX_BYTES = storage_size(1_ip)/8

contains

   !> Cuts the scene, hands the parts over as they are made, and has them assembled. status: STATUS_INTERNAL when the memory does
   !> not suffice.
   subroutine share_scene(fem, rows, line, value, part_of_element, n_parts, parts, scene, status)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: value(:, :)        !< (2, n_nodes) prescribed displacements [L]
      integer(ip), intent(in) :: part_of_element(:) !< (n_elements) 1..n_parts
      integer(ip), intent(in) :: n_parts
      class(scene_parts_t), allocatable, intent(inout) :: parts !< where they go; then the scene has them
      type(shared_scene_t), intent(out) :: scene
      type(status_t), intent(out) :: status
      type(scene_cut_t) :: cut
      real(wp), allocatable :: diagonal(:), coupling(:)
      integer(ip) :: i

      call number_scene(fem, scene%numbering)
      scene%n = scene%numbering%n
      scene%k = scene%numbering%k
      scene%n_bodies = fem%bodies%n
      scene%body = scene%numbering%body
      call build_constraint_rows(fem, rows, line, .true., scene%rows)
      call set_scene_gaps(rows, line, value, scene)
      allocate (diagonal(scene%n), coupling(scene%n))
      call diagonals_of_rows(fem, rows, scene%numbering, diagonal, coupling)
      call plan_cut(fem, rows, line, scene%numbering, diagonal, part_of_element, n_parts, cut)
      do i = 1, scene%k                          ! springs stand beside the elements
         associate (spring => scene%numbering%spring(i))
            if (spring > 0) diagonal(spring) = diagonal(spring) + cut%spring_stiffness(i)
         end associate
      end do
      call set_flexibility(fem, rows, line, diagonal, coupling, scene)
      call move_alloc(parts, scene%parts)
      call hand_over(fem, rows, line, cut, scene)
      call scene%parts%assemble(scene%lists, scene%is_near, scene%order, status)
   end subroutine share_scene

   !> Makes the parts one after the other: there is never more than one of them here.
   subroutine hand_over(fem, rows, line, cut, scene)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(scene_cut_t), intent(inout) :: cut
      type(shared_scene_t), intent(inout) :: scene
      type(scene_part_t) :: part
      integer(ip), allocatable :: unknown(:), row(:), pull(:)
      integer(ip) :: p, i

      associate (lists => scene%lists)
         lists%n_parts = cut%n_parts
         lists%n_top = cut%n_top
         allocate (lists%n_kept(cut%n_parts))
         allocate (lists%first_unknown(cut%n_parts + 1), lists%first_row(cut%n_parts + 1), lists%first_pull(cut%n_parts + 1), &
                   lists%first_top(cut%n_parts + 1), source=1_ip)
         allocate (lists%top(0), scene%unknown(0), scene%row(0), scene%pull(0), scene%is_kept(0))
         call scene%parts%begin(cut%n_parts)
         do p = 1, cut%n_parts
            call make_scene_part(fem, rows, line, scene%numbering, scene%rows, p, cut, part, unknown, row, pull)
            lists%n_kept(p) = part%n_kept
            lists%first_unknown(p + 1) = lists%first_unknown(p) + size(unknown, kind=ip)
            lists%first_row(p + 1) = lists%first_row(p) + size(row, kind=ip)
            lists%first_pull(p + 1) = lists%first_pull(p) + size(pull, kind=ip)
            lists%first_top(p + 1) = lists%first_top(p) + part%n_kept
            lists%top = [lists%top, cut%top_of(unknown(size(unknown) - part%n_kept + 1:))]
            scene%unknown = [scene%unknown, unknown]
            scene%row = [scene%row, row]
            scene%pull = [scene%pull, pull]
            scene%is_kept = [scene%is_kept, cut%top_of(unknown) > 0]
            call scene%parts%take(p, part)
         end do
      end associate
      scene%shared = pack([(i, i=1, scene%n)], cut%top_of > 0)
   end subroutine hand_over

   subroutine multiply_shared(self, x, y)
      class(shared_scene_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: y(:)
      real(wp), allocatable :: of_parts(:)
      integer(ip) :: i

      allocate (of_parts(size(self%unknown)))
      call self%parts%multiply(x(self%unknown), of_parts)
      y = 0.0_wp
      do i = 1, size(of_parts, kind=ip)
         y(self%unknown(i)) = y(self%unknown(i)) + of_parts(i)
      end do
   end subroutine multiply_shared

   subroutine factor_shared(self, stiffness, pull, status)
      class(shared_scene_t), intent(inout) :: self
      real(wp), intent(in) :: stiffness(:), pull(:)
      type(status_t), intent(out) :: status
      integer(ip) :: failed, failed_top

      call self%parts%factor(stiffness(self%row), pull(self%pull), failed, failed_top, status)
      self%failed = 0
      if (failed > 0) self%failed = self%unknown(failed)
      if (failed_top > 0) self%failed = self%shared(failed_top)
   end subroutine factor_shared

   subroutine solve_shared(self, x)
      class(shared_scene_t), intent(in) :: self
      real(wp), intent(inout) :: x(:)
      real(wp), allocatable :: of_parts(:), top(:)

      of_parts = x(self%unknown)
      where (self%is_kept) of_parts = 0.0_wp
      top = x(self%shared)
      call self%parts%solve(of_parts, top)
      x(self%unknown) = of_parts                 ! parts that share an unknown have the same number for it
   end subroutine solve_shared

   !> The ranks give back what they have.
   subroutine release_parts(self)
      class(shared_scene_t), intent(inout) :: self

      if (allocated(self%parts)) call self%parts%release()
   end subroutine release_parts

   pure integer(lp) function shared_bytes(self) result(bytes)
      class(shared_scene_t), intent(in) :: self

      bytes = self%parts%memory_bytes() + (REAL_BYTES + INDEX_BYTES)*size(self%rows%value, kind=lp) &
              + 2*INDEX_BYTES*size(self%unknown, kind=lp) + INDEX_BYTES*(size(self%row, kind=lp) + size(self%pull, kind=lp))
   end function shared_bytes

   !> That of the parts in this process, and the vectors of the iteration, over the scene and over the parts.
   pure integer(lp) function shared_solving_bytes(self) result(bytes)
      class(shared_scene_t), intent(in) :: self
      integer(lp), parameter :: OF_UNKNOWNS = 12_lp, OF_ROWS = 40_lp

      bytes = self%parts%solving_bytes() &
              + REAL_BYTES*(OF_UNKNOWNS*size(self%unknown, kind=lp) + OF_ROWS*int(self%rows%n, lp))
   end function shared_solving_bytes

end module atrito_shared_scene
