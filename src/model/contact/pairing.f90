!> Pairs of a model: their slaves in order, and their points.
module atrito_pairing
   use atrito_faces, only: face_list_t, chain_report_t, order_chain
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_master, only: master_t, master_of_faces, master_of_segments, turn_master
   use atrito_model, only: model_t, SURFACE_SEGMENTS, QUADRATURE_NODAL, QUADRATURE_MORTAR, elasticity_of
   use atrito_mortar_points, only: pair_by_mortar
   use atrito_nodal_points, only: pair_with_master
   use atrito_plane_state, only: compliance_matrix, COMPONENTS
   use atrito_points, only: contact_points_t, sliding_t
   use atrito_mesh, only: is_revolved
   use atrito_sliding_motions, only: chords_t, list_chords, find_sliding, note_doubt, printed_digit_error, serves, adopted, &
                                     sharpness
   use atrito_sorting, only: sorted_places
   implicit none (type, external)
   private
   public :: order_slaves, pair_all, pair_surfaces, make_master, slave_stiffness

contains

   !> Puts the faces of slaves into the order of their chains; reports: of each surface, what is wrong with its chain.
   subroutine order_slaves(model, reports)
      type(model_t), intent(inout) :: model                        !< faces of its slaves change their order
      type(chain_report_t), allocatable, intent(out) :: reports(:) !< (surfaces) of what is no slave nothing is told
      logical :: is_slave(size(model%surfaces))
      integer(ip) :: i

      is_slave = .false.
      is_slave(model%pairs%slave) = .true.
      if (allocated(model%ties)) is_slave(model%ties%slave) = .true.
      allocate (reports(size(model%surfaces)))
      do i = 1, size(model%surfaces, kind=ip)
         associate (surface => model%surfaces(i))
            if (.not. is_slave(i) .or. surface%kind == SURFACE_SEGMENTS .or. surface%faces%n == 0) cycle
            call order_chain(model%mesh, surface%faces, reports(i))
         end associate
      end do
   end subroutine order_slaves

   !> The points of all pairs. Each has two surfaces that are what a slave and a master must be, the slave in its order; a master is
   !> made once for all of its pairs. In the plane the sides of a pair may slide along themselves in a motion of the whole body:
   !> pairs that have the same one but for digits, as rings in rings, take that of the one which tells it most sharply.
   subroutine pair_all(model, points)
      type(model_t), intent(in) :: model         !< surfaces, sections and mesh are read
      type(contact_points_t), allocatable, intent(out) :: points(:) !< of each pair; n is 0 where it faces nothing
      type(chords_t), allocatable :: chords(:)
      type(sliding_t) :: motions(size(model%pairs))
      integer(lp) :: sharp(size(model%pairs))
      integer(ip) :: order(size(model%pairs)), i, k, n

      call pair_surfaces(model, model%pairs%slave, model%pairs%master, model%pairs%quadrature, points, chords=chords)
      if (is_revolved(model%mesh)) return
      sharp = 0
      do i = 1, size(points, kind=ip)
         if (points(i)%n > 0) call find_sliding(chords(i), points(i)%sliding)
         if (points(i)%sliding%exists) sharp(i) = sharpness(chords(i), points(i)%sliding)
      end do
      order = sorted_places(-sharp)
      n = 0
      do i = 1, size(points, kind=ip)
         associate (own => chords(order(i)), sliding => points(order(i))%sliding)
            if (.not. sliding%exists) cycle
            do k = 1, n
               if (serves(own, motions(k), sliding)) exit
            end do
            if (k <= n) then
               sliding = adopted(motions(k), sliding)
            else
               n = n + 1
               motions(n) = sliding
            end if
         end associate
      end do
   end subroutine pair_all

   !> The same of any pairs of surfaces, by their places.
   subroutine pair_surfaces(model, slaves, partners, quadrature, points, from_behind, chords)
      type(model_t), intent(in) :: model               !< surfaces, sections and mesh are read
      integer(ip), intent(in) :: slaves(:), partners(:) !< slaves and masters
      integer(ip), intent(in) :: quadrature(:)         !< QUADRATURE_*
      type(contact_points_t), allocatable, intent(out) :: points(:) !< of each pair; n is 0 where it faces nothing
      logical, intent(in), optional :: from_behind(:)  !< the master's outside is taken for its inside; default: nowhere
      type(chords_t), allocatable, intent(out), optional :: chords(:) !< of the pairs
      type(master_t), allocatable, target :: masters(:) ! of the surfaces
      type(master_t), target :: turned
      type(master_t), pointer :: master
      logical :: is_master(size(model%surfaces)), is_done
      real(wp), allocatable :: thickness(:)            ! of the elements [L]
      real(wp) :: digit_error                          ! of coordinates of few digits [L]
      integer(ip) :: i

      allocate (points(size(slaves)), masters(size(model%surfaces)))
      if (present(chords)) allocate (chords(size(slaves)))
      if (size(points) == 0) return
      digit_error = max(printed_digit_error(model%mesh%x), model%mesh%digit_error)
      if (digit_error <= EPS_MACH*maxval(abs(model%mesh%x))) digit_error = 0.0_wp
      thickness = model%sections(model%section_of)%thickness
      is_master = .false.
      is_master(partners) = .true.
      do i = 1, size(masters, kind=ip)
         if (is_master(i)) call make_master(model, i, masters(i), digit_error)
      end do
      do i = 1, size(points, kind=ip)
         associate (slave => model%surfaces(slaves(i))%faces, others => model%surfaces(partners(i))%faces, mesh => model%mesh)
            master => masters(partners(i))
            if (present(from_behind)) then
               if (from_behind(i)) then
                  turned = master
                  call turn_master(turned)
                  master => turned
               end if
            end if
            ! by the quadrature that is asked for; else MORTAR where the sides do not match
            is_done = .false.
            if (quadrature(i) /= QUADRATURE_MORTAR) then
               call pair_with_master(mesh, thickness, slave, others, master, points(i))
               is_done = quadrature(i) == QUADRATURE_NODAL .or. points(i)%rigid .or. (points(i)%matching .and. points(i)%n > 0)
            end if
            if (.not. is_done) call pair_by_mortar(mesh, thickness, slave, others, master, face_compliance(model, slave), &
                                                   face_compliance(model, others), points(i))
            if (present(chords)) then
               call list_chords(mesh, slave, others, masters(partners(i)), points(i), digit_error, chords(i))
               call note_doubt(mesh, slave, others, chords(i)%digit_error, points(i))
            end if
         end associate
      end do
   end subroutine pair_surfaces

   !> A surface as the master of pairs: its faces or segments, with what finds the nearest of them.
   subroutine make_master(model, i, master, digit_error)
      type(model_t), intent(in) :: model               !< surfaces and mesh are read
      integer(ip), intent(in) :: i                     !< the surface
      type(master_t), intent(out) :: master            !< of faces, or of segments and arcs
      real(wp), intent(in), optional :: digit_error    !< to which the nodes of the mesh are known [L]; left out: all digits

      associate (surface => model%surfaces(i))
         if (surface%kind == SURFACE_SEGMENTS) then
            call master_of_segments(surface%points, master, surface%is_arc, surface%centre)
         else
            call master_of_faces(model%mesh, surface%faces, master, digit_error)
         end if
         if (present(digit_error)) master%digit_error = digit_error
      end associate
   end subroutine make_master

   !> How much the surface of a half plane gives way [L^2/F], of the material behind each face: 1/E* of Hertz, which is
   !> (1 - mu^2)/E in plane strain and 1/E in plane stress; of an orthotropic material the mean of its two axes.
   pure function face_compliance(model, faces) result(compliance)
      type(model_t), intent(in) :: model
      type(face_list_t), intent(in) :: faces
      real(wp) :: compliance(faces%n), c(COMPONENTS, COMPONENTS)
      integer(ip) :: i

      do i = 1, faces%n
         associate (section => model%sections(model%section_of(faces%element(i))))
            c = compliance_matrix(elasticity_of(section, model%materials(section%material)), model%mesh%state(faces%element(i)))
         end associate
         compliance(i) = 0.5_wp*(c(1, 1) + c(2, 2))    ! of an isotropic material they are the same
      end do
   end function face_compliance

   !> How many times as stiff the slave of a pair is as its master, in the mean along their sides; 0 of a rigid master.
   pure real(wp) function slave_stiffness(model, i) result(stiffness)
      type(model_t), intent(in) :: model               !< surfaces, sections and mesh are read
      integer(ip), intent(in) :: i                     !< the pair

      stiffness = 0.0_wp
      associate (slave => model%surfaces(model%pairs(i)%slave), master => model%surfaces(model%pairs(i)%master))
         if (min(slave%faces%n, master%faces%n) == 0 .or. master%kind == SURFACE_SEGMENTS) return
         stiffness = sum(face_compliance(model, master%faces))/master%faces%n &
                     /(sum(face_compliance(model, slave%faces))/slave%faces%n)
      end associate
   end function slave_stiffness

end module atrito_pairing
