!> A part of a scene: some of its elements and contact points with the unknowns that they touch, as one rank has it.
!>
!> With A the stiffness of the elements, B the rows of the points and P the pulls, all of this part alone, the matrix of the scene
!> is the sum of A + B' diag(stiffness) B + P over the parts. The unknowns that other parts have, too, are the last ones of a part
!> and are kept: what its factorisation leaves of them is its share in the system that holds the parts together
!> (atrito_part_service).
!>
!> A part has numbers of its own for nodes, elements, bodies, points, rows and unknowns; a contact line and contact rows say only
!> which points have which rows, and over which nodes.
module atrito_scene_part
   use atrito_assembled_scene, only: assembled_scene_t, assemble_numbered
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: bodies_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_buffer, only: buffer_t, put, take
   use atrito_piece_buffer, only: put_piece, receive_piece
   use atrito_scene_elimination, only: scene_numbering_t
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: scene_part_t, assemble_scene_part, put_scene_part, take_scene_part

   !> A part of a scene, before and behind its assembly.
   type :: scene_part_t
      integer(ip) :: n_kept = 0                  !< unknowns that other parts have, too
      type(assembled_scene_t) :: scene           !< its numbering and rows; the matrix when it is assembled
      type(fem_t) :: fem                         !< with a mesh of its own until it is assembled, as is what follows
      type(contact_rows_t) :: rows               !< first and node alone
      type(contact_line_t) :: line               !< normal and tangential alone
      real(wp), allocatable :: spring_stiffness(:) !< [F/L]
   end type scene_part_t

contains

   !> Numbers the elimination, assembles the elements and finds the fronts; mesh, rows and line are let go of. status:
   !> STATUS_INTERNAL when the memory does not suffice.
   subroutine assemble_scene_part(part, status)
      type(scene_part_t), intent(inout) :: part  !< made, not assembled
      type(status_t), intent(out) :: status      !< STATUS_OK or STATUS_INTERNAL
      type(fem_t) :: no_fem
      type(contact_rows_t) :: no_rows
      type(contact_line_t) :: no_line

      call assemble_numbered(part%fem, part%rows, part%line, part%scene, status, part%spring_stiffness, part%n_kept)
      deallocate (part%fem%mesh)
      part%fem = no_fem
      part%rows = no_rows
      part%line = no_line
   end subroutine assemble_scene_part

   !> Adds a part that is not assembled; its mesh is let go of.
   subroutine put_scene_part(buffer, part)
      type(buffer_t), intent(inout) :: buffer    !< gets the items
      type(scene_part_t), intent(inout) :: part  !< its mesh is gone on return

      call put(buffer, part%n_kept)
      call put(buffer, part%spring_stiffness)
      call put_piece(buffer, part%fem)
      deallocate (part%fem%mesh)
      call put_bodies(buffer, part%fem%bodies)
      associate (numbering => part%scene%numbering)
         call put(buffer, [numbering%n, numbering%k])
         call put(buffer, numbering%before)
         call put(buffer, numbering%first_motion)
         call put(buffer, numbering%n_motions)
         call put(buffer, numbering%first_pull)
         call put(buffer, numbering%spring)
         call put(buffer, numbering%body)
      end associate
      associate (rows => part%scene%rows)
         call put(buffer, [rows%n, rows%n_columns])
         call put(buffer, rows%first)
         call put(buffer, rows%column)
         call put(buffer, rows%value)
         call put(buffer, rows%point)
      end associate
      call put(buffer, [part%rows%n, part%rows%longest])
      call put(buffer, part%rows%first)
      call put(buffer, part%rows%node)
      call put(buffer, part%line%normal)
      call put(buffer, part%line%tangential)
   end subroutine put_scene_part

   !> The next items, a part.
   subroutine take_scene_part(buffer, part)
      type(buffer_t), intent(inout) :: buffer    !< its next items are taken
      type(scene_part_t), intent(out) :: part    !< not assembled, with a mesh of its own
      integer(ip), allocatable :: numbers(:)

      call take(buffer, part%n_kept)
      call take(buffer, part%spring_stiffness)
      call receive_piece(buffer, part%fem)
      call take_bodies(buffer, part%fem%bodies)
      call take_numbering(buffer, part%scene%numbering)
      associate (rows => part%scene%rows)
         call take(buffer, numbers)
         rows%n = numbers(1)
         rows%n_columns = numbers(2)
         call take(buffer, rows%first)
         call take(buffer, rows%column)
         call take(buffer, rows%value)
         call take(buffer, rows%point)
      end associate
      call take(buffer, numbers)
      part%rows%n = numbers(1)
      part%rows%longest = numbers(2)
      call take(buffer, part%rows%first)
      call take(buffer, part%rows%node)
      call take(buffer, part%line%normal)
      call take(buffer, part%line%tangential)
      part%line%n = part%rows%n
   end subroutine take_scene_part

   subroutine take_numbering(buffer, numbering)
      type(buffer_t), intent(inout) :: buffer
      type(scene_numbering_t), intent(out) :: numbering
      integer(ip), allocatable :: numbers(:)

      call take(buffer, numbers)
      numbering%n = numbers(1)
      numbering%k = numbers(2)
      call take(buffer, numbering%before)
      call take(buffer, numbering%first_motion)
      call take(buffer, numbering%n_motions)
      call take(buffer, numbering%first_pull)
      call take(buffer, numbering%spring)
      call take(buffer, numbering%body)
   end subroutine take_numbering

   !> Of the bodies one element each, where there is any, and the nodes of rigid ones.
   subroutine put_bodies(buffer, bodies)
      type(buffer_t), intent(inout) :: buffer
      type(bodies_t), intent(in) :: bodies
      integer(ip) :: element(bodies%n), b

      element = 0
      do b = 1, bodies%n
         if (allocated(bodies%list(b)%elements)) element(b) = bodies%list(b)%elements(1)
      end do
      call put(buffer, bodies%n_rigid)
      call put(buffer, bodies%of_node)
      call put(buffer, bodies%of_element)
      call put(buffer, [bodies%equation])
      call put(buffer, element)
      do b = bodies%n - bodies%n_rigid + 1, bodies%n
         call put(buffer, bodies%list(b)%nodes)
      end do
   end subroutine put_bodies

   subroutine take_bodies(buffer, bodies)
      type(buffer_t), intent(inout) :: buffer
      type(bodies_t), intent(out) :: bodies
      integer(ip), allocatable :: element(:)
      integer(ip) :: b

      call take(buffer, bodies%n_rigid)
      call take(buffer, bodies%of_node)
      call take(buffer, bodies%of_element)
      call take(buffer, element)
      bodies%equation = reshape(element, [2, size(element)/2])
      call take(buffer, element)
      bodies%n = size(element, kind=ip)
      allocate (bodies%list(bodies%n))
      do b = 1, bodies%n
         if (element(b) > 0) bodies%list(b)%elements = [element(b)]
         bodies%list(b)%is_rigid = b > bodies%n - bodies%n_rigid
         if (bodies%list(b)%is_rigid) call take(buffer, bodies%list(b)%nodes)
      end do
   end subroutine take_bodies

end module atrito_scene_part
