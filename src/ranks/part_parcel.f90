!> A part of a scene (atrito_scene_part) as a parcel, before it is assembled.
module atrito_part_parcel
   use atrito_bodies, only: bodies_t
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_mesh_parcel, only: put_mesh, put_sections, take_mesh, take_sections
   use atrito_parcel, only: parcel_t, put, take
   use atrito_scene_elimination, only: scene_numbering_t
   use atrito_scene_part, only: scene_part_t
   implicit none (type, external)
   private
   public :: put_scene_part, take_scene_part

contains

   !> Adds a part that is not assembled.
   subroutine put_scene_part(parcel, part)
      type(parcel_t), intent(inout) :: parcel
      type(scene_part_t), intent(in) :: part

      call put(parcel, part%n_kept)
      call put(parcel, part%spring_stiffness)
      call put_numbering(parcel, part%scene%numbering)
      call put_constraints(parcel, part%scene%rows)
      call put_mesh(parcel, part%mesh)
      call put_sections(parcel, part%fem)
      call put_bodies(parcel, part%fem%bodies)
      call put(parcel, [part%rows%n, part%rows%longest])
      call put(parcel, part%rows%first)
      call put(parcel, part%rows%node)
      call put(parcel, part%line%normal)
      call put(parcel, part%line%tangential)
   end subroutine put_scene_part

   !> The next item, a part.
   subroutine take_scene_part(parcel, part)
      type(parcel_t), intent(inout) :: parcel
      type(scene_part_t), intent(out) :: part
      integer(ip), allocatable :: numbers(:)

      call take(parcel, part%n_kept)
      call take(parcel, part%spring_stiffness)
      call take_numbering(parcel, part%scene%numbering)
      call take_constraints(parcel, part%scene%rows)
      call take_mesh(parcel, part%mesh)
      call take_sections(parcel, part%fem)
      call take_bodies(parcel, part%fem%bodies)
      call take(parcel, numbers)
      part%rows%n = numbers(1)
      part%rows%longest = numbers(2)
      call take(parcel, part%rows%first)
      call take(parcel, part%rows%node)
      call take(parcel, part%line%normal)
      call take(parcel, part%line%tangential)
      part%line%n = part%rows%n
   end subroutine take_scene_part

   subroutine put_numbering(parcel, numbering)
      type(parcel_t), intent(inout) :: parcel
      type(scene_numbering_t), intent(in) :: numbering

      call put(parcel, [numbering%n, numbering%k])
      call put(parcel, numbering%before)
      call put(parcel, numbering%first_motion)
      call put(parcel, numbering%n_motions)
      call put(parcel, numbering%first_pull)
      call put(parcel, numbering%spring)
      call put(parcel, numbering%body)
   end subroutine put_numbering

   subroutine take_numbering(parcel, numbering)
      type(parcel_t), intent(inout) :: parcel
      type(scene_numbering_t), intent(out) :: numbering
      integer(ip), allocatable :: numbers(:)

      call take(parcel, numbers)
      numbering%n = numbers(1)
      numbering%k = numbers(2)
      call take(parcel, numbering%before)
      call take(parcel, numbering%first_motion)
      call take(parcel, numbering%n_motions)
      call take(parcel, numbering%first_pull)
      call take(parcel, numbering%spring)
      call take(parcel, numbering%body)
   end subroutine take_numbering

   subroutine put_constraints(parcel, rows)
      type(parcel_t), intent(inout) :: parcel
      type(constraint_rows_t), intent(in) :: rows

      call put(parcel, [rows%n, rows%n_columns])
      call put(parcel, rows%first)
      call put(parcel, rows%column)
      call put(parcel, rows%value)
      call put(parcel, rows%point)
   end subroutine put_constraints

   subroutine take_constraints(parcel, rows)
      type(parcel_t), intent(inout) :: parcel
      type(constraint_rows_t), intent(out) :: rows
      integer(ip), allocatable :: numbers(:)

      call take(parcel, numbers)
      rows%n = numbers(1)
      rows%n_columns = numbers(2)
      call take(parcel, rows%first)
      call take(parcel, rows%column)
      call take(parcel, rows%value)
      call take(parcel, rows%point)
   end subroutine take_constraints

   !> Of the bodies one element each, where there is any, and the nodes of rigid ones.
   subroutine put_bodies(parcel, bodies)
      type(parcel_t), intent(inout) :: parcel
      type(bodies_t), intent(in) :: bodies
      integer(ip) :: element(bodies%n), b

      element = 0
      do b = 1, bodies%n
         if (allocated(bodies%list(b)%elements)) element(b) = bodies%list(b)%elements(1)
      end do
      call put(parcel, bodies%n_rigid)
      call put(parcel, bodies%of_node)
      call put(parcel, bodies%of_element)
      call put(parcel, bodies%equation)
      call put(parcel, element)
      do b = bodies%n - bodies%n_rigid + 1, bodies%n
         call put(parcel, bodies%list(b)%nodes)
      end do
   end subroutine put_bodies

   subroutine take_bodies(parcel, bodies)
      type(parcel_t), intent(inout) :: parcel
      type(bodies_t), intent(out) :: bodies
      integer(ip), allocatable :: element(:)
      integer(ip) :: b

      call take(parcel, bodies%n_rigid)
      call take(parcel, bodies%of_node)
      call take(parcel, bodies%of_element)
      call take(parcel, bodies%equation)
      call take(parcel, element)
      bodies%n = size(element, kind=ip)
      allocate (bodies%list(bodies%n))
      do b = 1, bodies%n
         if (element(b) > 0) bodies%list(b)%elements = [element(b)]
         bodies%list(b)%is_rigid = b > bodies%n - bodies%n_rigid
         if (bodies%list(b)%is_rigid) call take(parcel, bodies%list(b)%nodes)
      end do
   end subroutine take_bodies

end module atrito_part_parcel
