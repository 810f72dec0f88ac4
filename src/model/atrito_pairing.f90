!> The points of the contact pairs of a model. What pairs share, the master of a surface and the thickness of the elements, is made
!> once for all of them.
module atrito_pairing
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp
   use atrito_master, only: master_t, master_of_faces, master_of_segments
   use atrito_model, only: model_t, SURFACE_SEGMENTS
   use atrito_points, only: contact_points_t, pair_with_master
   implicit none (type, external)
   private
   public :: pairing_t, prepare_pairing, pair_points, element_thickness

   type :: pairing_t
      real(wp), allocatable :: thickness(:)            !< of each element [L]
      integer(ip), allocatable :: master_of(:)         !< (surfaces) place in masters; 0: the surface is no master
      type(master_t), allocatable :: masters(:)
   end type pairing_t

contains

   !> What the pairs of a model share. Each has two surfaces that are what a slave and a master must be.
   subroutine prepare_pairing(model, pairing)
      type(model_t), intent(in) :: model
      type(pairing_t), intent(out) :: pairing
      integer(ip) :: i, n

      allocate (pairing%master_of(size(model%surfaces)), source=0_ip)
      n = 0
      do i = 1, size(model%pairs, kind=ip)
         associate (place => pairing%master_of(model%pairs(i)%master))
            if (place > 0) cycle
            n = n + 1
            place = n
         end associate
      end do
      allocate (pairing%masters(n))
      do i = 1, size(model%surfaces, kind=ip)
         if (pairing%master_of(i) == 0) cycle
         associate (surface => model%surfaces(i), master => pairing%masters(pairing%master_of(i)))
            if (surface%kind == SURFACE_SEGMENTS) then
               call master_of_segments(surface%points, master, surface%is_arc, surface%centre)
            else
               call master_of_faces(model%mesh, surface%faces, master)
            end if
         end associate
      end do
      if (n > 0) pairing%thickness = element_thickness(model)
   end subroutine prepare_pairing

   !> The points of one pair.
   subroutine pair_points(model, pairing, i, points)
      type(model_t), intent(in) :: model
      type(pairing_t), intent(in) :: pairing           !< of this model
      integer(ip), intent(in) :: i                     !< the pair
      type(contact_points_t), intent(out) :: points
      type(face_list_t) :: no_faces

      associate (slave => model%surfaces(model%pairs(i)%slave)%faces, surface => model%surfaces(model%pairs(i)%master), &
                 master => pairing%masters(pairing%master_of(model%pairs(i)%master)))
         if (surface%kind == SURFACE_SEGMENTS) then
            call pair_with_master(model%mesh, pairing%thickness, slave, no_faces, master, points)
         else
            call pair_with_master(model%mesh, pairing%thickness, slave, surface%faces, master, points)
         end if
      end associate
   end subroutine pair_points

   !> Thickness [L] of each element.
   pure function element_thickness(model) result(thickness)
      type(model_t), intent(in) :: model
      real(wp), allocatable :: thickness(:)
      integer(ip) :: e

      allocate (thickness(model%mesh%n_elements))
      do e = 1, model%mesh%n_elements
         thickness(e) = model%sections(model%section_of(e))%thickness
      end do
   end function element_thickness

end module atrito_pairing
