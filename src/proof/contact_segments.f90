!> Parts of contact sides that face one another: gaps and stresses are linear along them, displacements as the faces have them.
module atrito_contact_segments
   use atrito_kinds, only: ip, wp
   use atrito_shape_functions, only: face_shape_values
   implicit none (type, external)
   private
   public :: segment_t, along, segment_forces, traction_at, overlap_at, slip_at, between

   !> A part of a slave's face that faces one face of the master. Arrays of two: at its ends.
   type :: segment_t
      integer(ip) :: pair = 0
      integer(ip) :: slave(2) = 0, master(2) = 0    !< element and face; master 0: rigid
      integer(ip) :: n = 0, n_master = 0            !< nodes of these faces
      integer(ip) :: node(3) = 0, master_node(3) = 0 !< in the order of face_nodes
      real(wp) :: on_slave(2) = 0.0_wp, on_master(2) = 0.0_wp       !< places on the faces, 0 to 1
      real(wp) :: length = 0.0_wp                   !< on the slave [L]
      real(wp) :: thickness = 0.0_wp                !< [L]
      real(wp) :: normal(2) = 0.0_wp                !< out of the slave
      real(wp) :: p(2) = 0.0_wp, t(2) = 0.0_wp      !< pressure, shear on the master along T [F/L^2]
      real(wp) :: tau(2) = 0.0_wp                   !< friction bound [F/L^2]
      real(wp) :: gap(2) = 0.0_wp                   !< s [L]
      real(wp) :: delta = 0.0_wp                    !< [L^3/F]
      real(wp) :: eps = 0.0_wp                      !< largest slip of a sticking point where it does not depend on tau [L]
      real(wp) :: compliance = 0.0_wp               !< and over tau where it does [L^3/F]
      real(wp) :: rest(2) = 0.0_wp                  !< slip at which there is no shear [L]
      logical :: master_is_softer = .false.
   end type segment_t

   !> Three Gauss points on [0,1].
   real(wp), parameter :: GAUSS_PLACES(3) = 0.5_wp + 0.38729833462074168852_wp*[real(wp) :: -1, 0, 1]
   real(wp), parameter :: GAUSS_WEIGHTS(3) = [real(wp) :: 5, 8, 5]/18

contains

   !> Linear from node to node, at both ends of a segment.
   pure function along(segment, at_nodes) result(values)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: at_nodes(3)
      real(wp) :: values(2)

      associate (s => segment%on_slave)
         if (segment%n == 2) then
            values = (1 - s)*at_nodes(1) + s*at_nodes(2)
         else if (sum(s) < 1.0_wp) then
            values = (1 - 2*s)*at_nodes(1) + 2*s*at_nodes(3)
         else
            values = (2 - 2*s)*at_nodes(3) + (2*s - 1)*at_nodes(2)
         end if
      end associate
   end function along

   !> int T N_i ds on both sides: the forces of a segment's tractions on the nodes of the slave's face and of the master's.
   pure subroutine segment_forces(segment, on_slave, on_master)
      type(segment_t), intent(in) :: segment
      real(wp), intent(out) :: on_slave(2, 3), on_master(2, 3)      !< (component, node) [F]
      real(wp) :: t, force(2), share(3)
      integer(ip) :: k, i

      on_slave = 0.0_wp
      on_master = 0.0_wp
      do k = 1, 3
         t = GAUSS_PLACES(k)
         force = GAUSS_WEIGHTS(k)*segment%length*traction_at(segment, t)
         associate (n => segment%n, m => segment%n_master)
            share(:n) = face_shape_values(n, 2*between(segment%on_slave, t) - 1)
            do i = 1, n
               on_slave(:, i) = on_slave(:, i) + share(i)*force
            end do
            if (m > 0) share(:m) = face_shape_values(m, 2*between(segment%on_master, t) - 1)
            do i = 1, m
               on_master(:, i) = on_master(:, i) - share(i)*force
            end do
         end associate
      end do
   end subroutine segment_forces

   !> The traction on the slave times the thickness, -p n - t T [F/L].
   pure function traction_at(segment, t) result(traction)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: t                     !< 0 to 1 along the segment
      real(wp) :: traction(2)

      traction = -segment%thickness*(between(segment%p, t)*segment%normal + &
                                     between(segment%t, t)*[-segment%normal(2), segment%normal(1)])
   end function traction_at

   !> A linear function from its values at both ends.
   pure real(wp) function between(values, t)
      real(wp), intent(in) :: values(2), t

      between = (1 - t)*values(1) + t*values(2)
   end function between

   !> u_n - s [L] at a place of a segment.
   pure real(wp) function overlap_at(segment, u, t) result(g)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: t                     !< 0 to 1 along the segment

      g = dot_product(segment%normal, relative(segment, u, t)) - between(segment%gap, t)
   end function overlap_at

   !> The slip, from where there is no shear [L].
   pure real(wp) function slip_at(segment, u, t) result(r)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)
      real(wp), intent(in) :: t

      r = dot_product([-segment%normal(2), segment%normal(1)], relative(segment, u, t)) - between(segment%rest, t)
   end function slip_at

   !> The displacement of the slave against the master.
   pure function relative(segment, u, t) result(d)
      type(segment_t), intent(in) :: segment
      real(wp), intent(in) :: u(:, :)
      real(wp), intent(in) :: t
      real(wp) :: d(2), share(3)
      integer(ip) :: k

      d = 0.0_wp
      associate (n => segment%n, m => segment%n_master)
         share(:n) = face_shape_values(n, 2*between(segment%on_slave, t) - 1)
         do k = 1, n
            d = d + share(k)*u(:, segment%node(k))
         end do
         if (m > 0) share(:m) = face_shape_values(m, 2*between(segment%on_master, t) - 1)
         do k = 1, m
            d = d - share(k)*u(:, segment%master_node(k))
         end do
      end associate
   end function relative

end module atrito_contact_segments
