!> The best rigid motion of every body and the resultants of what acts upon it.
!>
!> Best is the least sum of squares over the nodes, each with its share of the volume, the integral of its shape function.
module atrito_body_sums
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: body_t
   use atrito_element, only: body_load
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: element_coordinates, is_revolved, depth_places
   use atrito_results, only: body_motion_t
   implicit none (type, external)
   private
   public :: sum_bodies, nodal_volumes

contains

   !> All bodies. The contact's forces enter as contact_forces has them: what they take from the loads.
   subroutine sum_bodies(fem, u, f, reaction, contact, bodies)
      type(fem_t), intent(in) :: fem                        !< bodies, mesh and sections
      real(wp), intent(in) :: u(:, :)                       !< (2, n_nodes) [L]
      real(wp), intent(in) :: f(:, :)                       !< applied forces (2, n_nodes) [F]
      real(wp), intent(in) :: reaction(:, :)                !< (2, n_nodes) [F]
      real(wp), intent(in) :: contact(:, :)                 !< B'q (2, n_nodes) [F]
      type(body_motion_t), allocatable, intent(out) :: bodies(:) !< of elements, in the order of the bodies
      real(wp), allocatable :: volume(:)
      integer(ip) :: b

      volume = nodal_volumes(fem)
      allocate (bodies(fem%bodies%n - fem%bodies%n_rigid))
      do b = 1, size(bodies, kind=ip)
         associate (body => fem%bodies%list(b), row => bodies(b))
            row%name = body%name
            row%size = body%size
            call find_motion(fem, body, volume, u, row)
            call add_forces(fem, body, f, row%centre, row%loads, row%terms)
            call add_forces(fem, body, reaction, row%centre, row%supports, row%terms)
            call add_forces(fem, body, contact, row%centre, row%contact, row%terms)
            row%contact = -row%contact
            ! A body of revolution as a whole: its centre lies on the axis and stays there, forces along a radius have no
            ! resultant, and neither they nor those along the axis have a moment.
            if (is_revolved(fem%mesh)) then
               row%centre(1) = 0.0_wp
               row%u(1) = 0.0_wp
               row%rotation = 0.0_wp
               row%loads([1, 3]) = 0.0_wp
               row%supports([1, 3]) = 0.0_wp
               row%contact([1, 3]) = 0.0_wp
            end if
         end associate
      end do
   end subroutine sum_bodies

   !> The integral of the shape function of each node, times the thickness (n_nodes) [L^3].
   function nodal_volumes(fem) result(volume)
      type(fem_t), intent(in) :: fem             !< mesh and thicknesses are read
      real(wp), allocatable :: volume(:)
      real(wp), allocatable :: x(:, :), share(:, :)
      integer(ip) :: e, n

      allocate (volume(fem%mesh%n_nodes), source=0.0_wp)
      do e = 1, fem%mesh%n_elements
         n = fem%mesh%shape(e)
         x = element_coordinates(fem%mesh, e)
         if (allocated(share)) deallocate (share)
         allocate (share(2, n))
         call body_load(x, [1.0_wp, 0.0_wp], fem%sections(fem%section_of(e))%thickness, &
                        fem%mesh%state(e), share, places=depth_places(fem%mesh, fem%mesh%state(e), fem%mesh%nodes(:n, e)))
         associate (nodes => fem%mesh%nodes(:n, e))
            volume(nodes) = volume(nodes) + share(1, :)
         end associate
      end do
   end function nodal_volumes

   !> Centre, its displacement and the rotation, in parts of volume and size of the body so that no power of a length is formed.
   !>
   !> With the shares w of the volume, their sum 1, and r the way from the centre, the sum of
   !> w |u - u0 - theta (-r2, r1)|^2 is least for
   !>    u0 = sum w u,   theta = sum w (r1 (u2 - u02) - r2 (u1 - u01)) / sum w |r|^2,
   !> since sum w r = 0: the two do not mix.
   pure subroutine find_motion(fem, body, volume, u, row)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: volume(:), u(:, :)
      type(body_motion_t), intent(inout) :: row
      real(wp) :: weight(size(body%nodes)), arm(2), turned, inertia
      integer(ip) :: i

      associate (nodes => body%nodes)
         weight = volume(nodes)/sum(volume(nodes))
         do i = 1, 2
            ! from the middle of the body: far from the origin the sum of the places themselves would lose digits
            row%centre(i) = body%centre(i) + sum(weight*(fem%mesh%x(i, nodes) - body%centre(i)))
            row%u(i) = sum(weight*u(i, nodes))
         end do
         turned = 0.0_wp
         inertia = 0.0_wp
         do i = 1, size(nodes, kind=ip)
            arm = (fem%mesh%x(:, nodes(i)) - row%centre)/body%size
            turned = turned + weight(i)*(arm(1)*(u(2, nodes(i)) - row%u(2)) - arm(2)*(u(1, nodes(i)) - row%u(1)))
            inertia = inertia + weight(i)*(arm(1)**2 + arm(2)**2)
         end do
      end associate
      row%rotation = turned/inertia/body%size
   end subroutine find_motion

   !> Sum of nodal forces along x and y, and their moment about a point. The sizes of the terms are added.
   pure subroutine add_forces(fem, body, force, centre, resultant, terms)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: force(:, :)                   !< (2, n_nodes) [F]
      real(wp), intent(in) :: centre(2)                     !< [L]
      real(wp), intent(out) :: resultant(3)                 !< [F], [F L]
      real(wp), intent(inout) :: terms(2)                   !< [F], [F L]
      real(wp) :: arm(2)
      integer(ip) :: i

      resultant = 0.0_wp
      do i = 1, size(body%nodes, kind=ip)
         associate (f => force(:, body%nodes(i)))
            arm = fem%mesh%x(:, body%nodes(i)) - centre
            resultant(1:2) = resultant(1:2) + f
            resultant(3) = resultant(3) + (arm(1)*f(2) - arm(2)*f(1))
            terms = terms + [norm2(f), norm2(arm)*norm2(f)]
         end associate
      end do
   end subroutine add_forces

end module atrito_body_sums
