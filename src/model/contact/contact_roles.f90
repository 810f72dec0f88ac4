!> Which side of a pair is the slave, where the deck's choice is unstable: pressures at many nodes of a stiff side against few of a
!> soft one are not determined by what these can do, and alternate. The softer side carries them well, finer or coarser.
!>
!> A curved side of straight faces stays a polygon when it grows or shrinks: between its nodes it lags by u h^2/(8 R^2) behind the
!> curve, u being what its nodes move by. A finer slave follows each face, with pressures that vary by about E*/h times that within
!> it, E* being its own; the coarse side itself as the slave does not see it.
module atrito_contact_roles
   use atrito_build_context, only: build_context_t
   use atrito_clearance, only: clearance_t
   use atrito_diagnostics, only: report_note, report_warning
   use atrito_face_geometry, only: has_quarter_node
   use atrito_faces, only: chain_report_t, face_list_t, order_chain
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes, mesh_t
   use atrito_model, only: model_t, QUADRATURE_NODAL
   use atrito_pairing, only: pair_surfaces, slave_stiffness
   use atrito_points, only: contact_points_t
   use atrito_smooth_normals, only: smooth_surface
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: choose_roles, follows_polygon, polygon_angle

   !> A slave that is so many times as stiff as its master is on the wrong side if it is finer, too: where this ratio times the one
   !> of their nodes less 1 is as large as FINER; below that the noise is hardly that of faces that match.
   real(wp), parameter, public :: STIFFER = 3.0_wp
   real(wp), parameter :: FINER = 2.0_wp
   !> The same times the mean angle between faces of a polygon: pressures vary by a quarter to a half of that
   !> (tests/verify/pressures-told).
   real(wp), parameter :: ANGULAR = 0.05_wp

contains

   !> Exchanges the sides of such pairs; for models without any error, before their points are made. Where the deck says something
   !> node by node of the slave, or asks for its nodes, it is warned of.
   subroutine choose_roles(clearances, context)
      type(clearance_t), intent(in) :: clearances(:)  !< a pair whose nodes have gaps of their own stays
      type(build_context_t), intent(inout) :: context !< pairs of its model, and the order of their faces
      type(chain_report_t) :: report
      character(len=:), allocatable :: text, known, told
      real(wp) :: stiffness, fineness, angle
      integer(ip) :: i, former
      logical :: is_whole

      do i = 1, size(context%model%pairs, kind=ip)
         stiffness = slave_stiffness(context%model, i)
         if (stiffness <= 0.0_wp) cycle
         associate (surfaces => context%model%surfaces, pair => context%model%pairs(i), mesh => context%model%mesh)
            if (stiffness < STIFFER) then
               ! polygons alone, and only where the longest face opposite the shortest one would do
               angle = polygon_angle(mesh, surfaces(pair%master)%faces)
               if (.not. follows_polygon(stiffness, most_fineness(mesh, surfaces(pair%slave)%faces, surfaces(pair%master)%faces), &
                                         angle)) cycle
            end if
            call compare_sides(context%model)
            text = 'the slave '//surfaces(pair%slave)%name//' is '
            if (stiffness >= STIFFER .and. stiffness*(fineness - 1) >= FINER) then
               text = text//to_text(stiffness, 2)//' times as stiff as '//surfaces(pair%master)%name//' and '// &
                      to_text(fineness, 2)//' times as fine: '
               known = 'the softer side'
               told = 'pressures on it may alternate from node to node'
            else if (follows_polygon(stiffness, fineness, angle)) then
               text = text//to_text(fineness, 2)//' times as fine as the curved side '//surfaces(pair%master)%name// &
                      ', whose faces are straight: '
               known = 'the coarser side'
               told = 'pressures on it follow the corners between those faces'
            else
               cycle
            end if
            if (is_whole .and. can_exchange(context%model, i, clearances)) then
               call report_note(context%deck, context%slaves(i), 'N-ROLES', text//known//' carries the pressures, '// &
                                surfaces(pair%master)%name//' is the slave', keyword='CONTACT PAIR')
               pair%is_exchanged = .true.
               former = pair%slave
               pair%slave = pair%master
               pair%master = former
               call order_chain(mesh, surfaces(pair%slave)%faces, report)
            else
               call report_warning(context%deck, context%slaves(i), 'W-STIFF-SLAVE', text//told, &
                                   expected=surfaces(pair%master)%name//', '//known//', as slave'// &
                                   trim(merge(', with QUADRATURE=MORTAR', repeat(' ', 24), pair%quadrature == QUADRATURE_NODAL)), &
                                   keyword='CONTACT PAIR')
            end if
         end associate
      end do

   contains

      !> Distances of the slave's points over one of the nodes of the master that they face, and the angle between faces of it
      !> there.
      subroutine compare_sides(model)
         type(model_t), intent(in) :: model
         type(contact_points_t), allocatable :: points(:)
         logical, dimension(model%mesh%n_nodes) :: is_faced, is_on_master
         integer(ip) :: k

         associate (pair => model%pairs(i), faces => model%surfaces(model%pairs(i)%master)%faces)
            call pair_surfaces(model, [pair%slave], [pair%master], [pair%quadrature], points)
            is_faced = .false.
            is_on_master = .false.
            if (points(1)%n > 0) is_faced(points(1)%entry) = .true.
            do k = 1, faces%n
               is_on_master(face_nodes(model%mesh, faces%element(k), faces%face(k))) = .true.
            end do
            fineness = real(points(1)%n - 1, wp)/max(count(is_faced .and. is_on_master) - 1, 1)
            angle = polygon_angle(model%mesh, faces, is_faced)
            is_whole = all(is_faced .or. .not. is_on_master)
         end associate
      end subroutine compare_sides
   end subroutine choose_roles

   !> Whether pressures of a slave follow the straight faces of a curved master.
   pure logical function follows_polygon(stiffness, fineness, angle) result(follows)
      real(wp), intent(in) :: stiffness !< of the slave over that of the master
      real(wp), intent(in) :: fineness  !< nodes of the slave over those of the master
      real(wp), intent(in) :: angle     !< of polygon_angle, of the master [rad]

      follows = stiffness*angle*(fineness - 1) >= ANGULAR
   end function follows_polygon

   !> The mean angle [rad] by which a side turns from one straight face to the next, corners left out; faces with a node in their
   !> middle count as 0. With is_faced only faces whose ends both are.
   pure real(wp) function polygon_angle(mesh, faces, is_faced) result(angle)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces           !< of one surface
      logical, intent(in), optional :: is_faced(:)     !< (n_nodes)
      real(wp), allocatable :: ends(:, :, :), curvature(:), bend(:)
      integer(ip) :: k, n

      angle = 0.0_wp
      if (faces%n == 0) return
      call smooth_surface(mesh, faces, ends, curvature, bend)
      n = 0
      do k = 1, faces%n
         associate (nodes => face_nodes(mesh, faces%element(k), faces%face(k)))
            if (present(is_faced)) then
               if (.not. all(is_faced(nodes(:2)))) cycle
            end if
            n = n + 1
            if (size(nodes) == 2) angle = angle + curvature(k)*norm2(mesh%x(:, nodes(2)) - mesh%x(:, nodes(1)))
         end associate
      end do
      angle = angle/max(n, 1_ip)
   end function polygon_angle

   !> The longest distance of the master's nodes over the shortest of the slave's.
   pure real(wp) function most_fineness(mesh, slave, master) result(most)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave, master

      most = maxval(spacings(master))/minval(spacings(slave))

   contains

      pure function spacings(faces)
         type(face_list_t), intent(in) :: faces
         real(wp) :: spacings(faces%n)
         integer(ip) :: k

         do k = 1, faces%n
            associate (nodes => face_nodes(mesh, faces%element(k), faces%face(k)))
               spacings(k) = norm2(mesh%x(:, nodes(2)) - mesh%x(:, nodes(1)))/(size(nodes) - 1)
            end associate
         end do
      end function spacings
   end function most_fineness

   !> The master can be the slave, and nothing else in the deck hangs on who it is.
   logical function can_exchange(model, i, clearances) result(can)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i
      type(clearance_t), intent(in) :: clearances(:)
      type(face_list_t) :: faces
      type(chain_report_t) :: report
      integer(ip) :: k

      associate (pair => model%pairs(i))
         can = pair%quadrature /= QUADRATURE_NODAL .and. .not. pair%is_adjusted .and. pair%outline == 0
         do k = 1, size(clearances, kind=ip)
            can = can .and. (clearances(k)%pair /= i .or. clearances(k)%is_uniform)
         end do
         can = can .and. n_uses(pair%slave) == 1 .and. n_uses(pair%master) == 1
         if (.not. can) return
         faces = model%surfaces(pair%master)%faces
         call order_chain(model%mesh, faces, report)
         can = report%branch_node == 0 .and. report%loose_face == 0
         do k = 1, faces%n
            can = can .and. .not. has_quarter_node(model%mesh%x(:, face_nodes(model%mesh, faces%element(k), faces%face(k))))
         end do
      end associate

   contains

      !> By pairs and ties.
      pure integer(ip) function n_uses(surface)
         integer(ip), intent(in) :: surface

         n_uses = count(model%pairs%slave == surface, kind=ip) + count(model%pairs%master == surface, kind=ip)
         if (allocated(model%ties)) n_uses = n_uses + count(model%ties%slave == surface .or. model%ties%master == surface, kind=ip)
      end function n_uses
   end function can_exchange

end module atrito_contact_roles
