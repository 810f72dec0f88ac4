!> A part of a scene: some of its elements and contact points with the unknowns that they touch, as one rank has it.
!>
!> With A the stiffness of the elements, B the rows of the points and P the pulls, all of this part alone, the matrix of the scene
!> is the sum of A + B' diag(stiffness) B + P over the parts. The unknowns that other parts have, too, are the last ones of a part
!> and are kept: what its factorisation leaves of them is its share in the system that holds the parts together
!> (atrito_scene_parts).
!>
!> A part has numbers of its own for nodes, elements, bodies, points, rows and unknowns; a contact line and contact rows say only
!> which points have which rows, and over which nodes.
module atrito_scene_part
   use atrito_assembled_scene, only: assembled_scene_t, assemble_part
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_multifrontal, only: kept_matrix, reduce_variable, expand_variable
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: scene_part_t, assemble_scene_part, part_matrix, reduce_part, expand_part

   type :: scene_part_t
      integer(ip) :: n_kept = 0                  !< unknowns that other parts have, too
      type(assembled_scene_t) :: scene           !< its numbering and rows; the matrix when it is assembled
      type(mesh_t) :: mesh                       !< until it is assembled, as is what follows
      type(fem_t) :: fem                         !< of the mesh, to which it does not point
      type(contact_rows_t) :: rows               !< first and node alone
      type(contact_line_t) :: line               !< normal and tangential alone
      real(wp), allocatable :: spring_stiffness(:) !< [F/L]
   end type scene_part_t

contains

   !> Numbers the elimination, assembles the elements and finds the fronts; mesh, rows and line are let go of. status:
   !> STATUS_INTERNAL when the memory does not suffice.
   subroutine assemble_scene_part(part, status)
      type(scene_part_t), intent(inout), target :: part
      type(status_t), intent(out) :: status
      type(mesh_t) :: no_mesh
      type(fem_t) :: no_fem
      type(contact_rows_t) :: no_rows
      type(contact_line_t) :: no_line

      part%fem%mesh => part%mesh
      call assemble_part(part%fem, part%rows, part%line, part%spring_stiffness, part%n_kept, part%scene, status)
      nullify (part%fem%mesh)
      part%fem = no_fem
      part%mesh = no_mesh
      part%rows = no_rows
      part%line = no_line
   end subroutine assemble_scene_part

   !> What the last factorisation leaves of the matrix at the kept unknowns.
   pure subroutine part_matrix(part, s)
      type(scene_part_t), intent(in) :: part
      real(wp), intent(out) :: s(:, :)           !< (n_kept, n_kept) [F/L]

      call kept_matrix(part%scene%matrix, s)
   end subroutine part_matrix

   !> What loads on the unknowns that are not kept leave at those that are, added to what acts on them; for expand_part.
   subroutine reduce_part(part, f)
      type(scene_part_t), intent(in) :: part
      real(wp), intent(inout) :: f(:)            !< (n) [F]

      call reduce_variable(part%scene%matrix, f)
   end subroutine reduce_part

   !> All unknowns behind reduce_part, with the kept ones in the last places.
   subroutine expand_part(part, x)
      type(scene_part_t), intent(in) :: part
      real(wp), intent(inout) :: x(:)            !< (n) [L]

      call expand_variable(part%scene%matrix, x)
   end subroutine expand_part

end module atrito_scene_part
