!> Which side of a pair is the slave, where the deck's choice is unstable: pressures at many nodes of a stiff side against few of a
!> soft one are not determined by what these can do, and alternate. The softer side carries them well, finer or coarser.
module atrito_contact_roles
   use atrito_build_context, only: build_context_t
   use atrito_clearance, only: clearance_t
   use atrito_diagnostics, only: report_note, report_warning
   use atrito_face_geometry, only: has_quarter_node
   use atrito_faces, only: chain_report_t, face_list_t, order_chain
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes
   use atrito_model, only: model_t, QUADRATURE_NODAL
   use atrito_pairing, only: pair_surfaces, slave_stiffness
   use atrito_points, only: contact_points_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: choose_roles

   !> A slave that is so many times as stiff as its master is on the wrong side if it is finer, too: where this ratio times the one
   !> of their nodes less 1 is as large as FINER; below that the noise is hardly that of faces that match.
   real(wp), parameter, public :: STIFFER = 3.0_wp
   real(wp), parameter :: FINER = 2.0_wp

contains

   !> Exchanges the sides of such pairs; for models without any error, before their points are made. Where the deck says something
   !> node by node of the slave, or asks for its nodes, it is warned of.
   subroutine choose_roles(clearances, context)
      type(clearance_t), intent(in) :: clearances(:)  !< a pair whose nodes have gaps of their own stays
      type(build_context_t), intent(inout) :: context !< pairs of its model, and the order of their faces
      type(chain_report_t) :: report
      type(contact_points_t), allocatable :: points(:)
      character(len=:), allocatable :: text
      logical, dimension(context%model%mesh%n_nodes) :: is_faced, is_on_master
      real(wp) :: stiffness, fineness
      integer(ip) :: i, k, former

      do i = 1, size(context%model%pairs, kind=ip)
         stiffness = slave_stiffness(context%model, i)
         if (stiffness < STIFFER) cycle
         associate (surfaces => context%model%surfaces, pair => context%model%pairs(i), mesh => context%model%mesh)
            ! distances of the slave's points over one of the nodes of the master that they face
            call pair_surfaces(context%model, [pair%slave], [pair%master], [pair%quadrature], points)
            is_faced = .false.
            is_on_master = .false.
            if (points(1)%n > 0) is_faced(points(1)%entry) = .true.
            do k = 1, surfaces(pair%master)%faces%n
               is_on_master(face_nodes(mesh, surfaces(pair%master)%faces%element(k), surfaces(pair%master)%faces%face(k))) = .true.
            end do
            fineness = real(points(1)%n - 1, wp)/max(count(is_faced .and. is_on_master) - 1, 1)
            if (stiffness*(fineness - 1) < FINER) cycle
            text = 'the slave '//surfaces(pair%slave)%name//' is '//to_text(stiffness, 2)//' times as stiff as '// &
                   surfaces(pair%master)%name//' and '//to_text(fineness, 2)//' times as fine: '
            if (can_exchange(context%model, i, clearances)) then
               call report_note(context%deck, context%slaves(i), 'N-ROLES', text//'the softer side carries the pressures, '// &
                                surfaces(pair%master)%name//' is the slave', keyword='CONTACT PAIR')
               pair%is_exchanged = .true.
               former = pair%slave
               pair%slave = pair%master
               pair%master = former
               call order_chain(mesh, surfaces(pair%slave)%faces, report)
            else
               call report_warning(context%deck, context%slaves(i), 'W-STIFF-SLAVE', text// &
                                   'pressures on it may alternate from node to node', &
                                   expected=surfaces(pair%master)%name//', the softer side, as slave'// &
                                   trim(merge(', with QUADRATURE=MORTAR', repeat(' ', 24), pair%quadrature == QUADRATURE_NODAL)), &
                                   keyword='CONTACT PAIR')
            end if
         end associate
      end do
   end subroutine choose_roles

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
