!> Scenes of rigid blocks for the tests of the certificate: bodies with three motions each, points between them, forces on them.
module rigid_cases
   use atrito_average, only: identity_average, build_average
   use atrito_contact_line, only: contact_line_t, number_unknowns
   use atrito_friction_law, only: FRICTION_LOCAL, FRICTION_NONE, KERNEL_POINTS
   use atrito_kinds, only: ip, wp, PI
   use atrito_motion_rows, only: motion_rows_t
   use surface_pairs, only: join_averages
   implicit none (type, external)
   private
   public :: rigid_scene_t, start_scene, add_force, add_point, finish_scene, average_points, arch_scene

   type :: rigid_scene_t
      integer(ip) :: n_bodies = 0
      real(wp), allocatable :: centre(:, :), size(:)     !< (2, n_bodies), (n_bodies) [L]
      real(wp), allocatable :: work(:, :), work_size(:, :) !< (3, n_bodies) [F]
      integer(ip), allocatable :: side(:, :)             !< (2, points) slave and master; 0: the ground
      real(wp), allocatable :: x(:, :), normal(:, :)     !< (2, points)
      real(wp), allocatable :: weight(:), nu(:)          !< (points)
      type(motion_rows_t) :: rows
      type(contact_line_t) :: line
   end type rigid_scene_t

contains

   subroutine start_scene(scene, n_bodies)
      type(rigid_scene_t), intent(out) :: scene
      integer(ip), intent(in) :: n_bodies

      scene%n_bodies = n_bodies
      allocate (scene%centre(2, n_bodies), scene%work(3, n_bodies), scene%work_size(3, n_bodies), source=0.0_wp)
      allocate (scene%size(n_bodies), source=1.0_wp)
      allocate (scene%side(2, 0), scene%x(2, 0), scene%normal(2, 0), scene%weight(0), scene%nu(0))
   end subroutine start_scene

   !> A force at a place; the centre and the size of the body must be set.
   subroutine add_force(scene, body, force, place)
      type(rigid_scene_t), intent(inout) :: scene
      integer(ip), intent(in) :: body
      real(wp), intent(in) :: force(2), place(2)
      real(wp) :: arm(2), terms(2)

      arm = (place - scene%centre(:, body))/scene%size(body)
      terms = [arm(1)*force(2), -arm(2)*force(1)]
      scene%work(:, body) = scene%work(:, body) + [force, sum(terms)]
      scene%work_size(:, body) = scene%work_size(:, body) + [abs(force), sum(abs(terms))]
   end subroutine add_force

   !> A point on the slave, whose outward normal there is given.
   subroutine add_point(scene, slave, master, x, normal, weight, nu)
      type(rigid_scene_t), intent(inout) :: scene
      integer(ip), intent(in) :: slave, master
      real(wp), intent(in) :: x(2), normal(2), weight, nu

      scene%side = reshape([scene%side, slave, master], [2, size(scene%nu) + 1])
      scene%x = reshape([scene%x, x], [2, size(scene%nu) + 1])
      scene%normal = reshape([scene%normal, normal/norm2(normal)], [2, size(scene%nu) + 1])
      scene%weight = [scene%weight, weight]
      scene%nu = [scene%nu, nu]
   end subroutine add_point

   !> Makes the line and the rows, with friction that depends on the pressure of each point alone.
   subroutine finish_scene(scene)
      type(rigid_scene_t), intent(inout) :: scene
      integer(ip) :: n, j

      n = size(scene%nu, kind=ip)
      scene%line%n = n
      scene%line%weight = scene%weight
      allocate (scene%line%delta(n), scene%line%known_overlap(n), scene%line%known_slip(n), source=0.0_wp)
      allocate (scene%line%law(n))
      scene%line%law%nu = scene%nu
      scene%line%law%kind = merge(FRICTION_LOCAL, FRICTION_NONE, scene%nu > 0.0_wp)
      scene%line%average = identity_average(n)
      call number_unknowns(scene%line, scene%side(1, :) >= 0, scene%side(1, :) >= 0)
      scene%rows%n = size(scene%line%point, kind=ip)
      scene%rows%n_columns = 3*scene%n_bodies
      scene%rows%body = [((j - 1)/3 + 1, j=1, scene%rows%n_columns)]
      scene%rows%work = reshape(scene%work, [scene%rows%n_columns])
      scene%rows%work_size = reshape(scene%work_size, [scene%rows%n_columns])
      call fill_rows(scene)
   end subroutine finish_scene

   subroutine fill_rows(scene)
      type(rigid_scene_t), intent(inout) :: scene
      real(wp) :: direction(2), arm(2)
      integer(ip) :: i, j, s, b

      scene%rows%first = [1_ip]
      allocate (scene%rows%column(0), scene%rows%value(0))
      do i = 1, scene%rows%n
         j = scene%line%point(i)
         direction = scene%normal(:, j)
         if (scene%line%normal(j) /= i) direction = [-direction(2), direction(1)]
         do s = 1, 2
            b = scene%side(s, j)
            if (b == 0) cycle
            arm = (scene%x(:, j) - scene%centre(:, b))/scene%size(b)
            scene%rows%column = [scene%rows%column, 3*b - 2, 3*b - 1, 3*b]
            scene%rows%value = [scene%rows%value, merge(1.0_wp, -1.0_wp, s == 1) &
                                *[direction, arm(1)*direction(2) - arm(2)*direction(1)]]
         end do
         scene%rows%first = [scene%rows%first, size(scene%rows%column, kind=ip) + 1_ip]
      end do
   end subroutine fill_rows

   !> Takes a pair's pressures together within rho: the points first .. last, and all others by themselves.
   subroutine average_points(scene, first, last, rho)
      type(rigid_scene_t), intent(inout) :: scene
      integer(ip), intent(in) :: first, last
      real(wp), intent(in) :: rho

      scene%line%average = join_averages([identity_average(first - 1_ip), &
                                          build_average(scene%x(:, first:last), scene%weight(first:last), rho, KERNEL_POINTS), &
                                          identity_average(scene%line%n - last)])
   end subroutine average_points

   !> A semicircular arch of n voussoirs with straight sides, corners on circles of radius 1 -+ t/2, on rigid springings, under its
   !> own weight; two points a joint, its ends.
   subroutine arch_scene(n, t, nu, scene)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: t, nu
      type(rigid_scene_t), intent(out) :: scene
      real(wp) :: corner(2, 4), angle(2), area, centroid(2), outward(2)
      integer(ip) :: b, j, side

      call start_scene(scene, n)
      do b = 1, n
         angle = PI - PI*[real(b - 1, wp), real(b, wp)]/n
         corner(:, 1) = (1.0_wp - t/2)*[cos(angle(1)), sin(angle(1))]
         corner(:, 2) = (1.0_wp - t/2)*[cos(angle(2)), sin(angle(2))]
         corner(:, 3) = (1.0_wp + t/2)*[cos(angle(2)), sin(angle(2))]
         corner(:, 4) = (1.0_wp + t/2)*[cos(angle(1)), sin(angle(1))]
         call polygon_centroid(corner, area, centroid)
         scene%centre(:, b) = centroid
         scene%size(b) = maxval(norm2(corner - spread(centroid, 2, 4), dim=1))
         call add_force(scene, b, [0.0_wp, -abs(area)], centroid)
      end do
      do j = 0, n
         angle(1) = PI - PI*j/n
         ! the block before the joint is the slave, the one behind the master; at the start the other way round
         b = max(j, 1_ip)
         outward = merge(-1.0_wp, 1.0_wp, j == 0)*[sin(angle(1)), -cos(angle(1))]
         do side = -1, 1, 2
            call add_point(scene, b, merge(j + 1_ip, 0_ip, j > 0 .and. j < n), &
                           (1.0_wp + side*t/2)*[cos(angle(1)), sin(angle(1))], outward, t/2, nu)
         end do
      end do
      call finish_scene(scene)
   end subroutine arch_scene

   subroutine polygon_centroid(corner, area, centroid)
      real(wp), intent(in) :: corner(:, :)               !< (2, n)
      real(wp), intent(out) :: area, centroid(2)
      real(wp) :: cross
      integer(ip) :: i, next

      area = 0.0_wp
      centroid = 0.0_wp
      do i = 1, size(corner, 2, kind=ip)
         next = mod(i, size(corner, 2, kind=ip)) + 1
         cross = corner(1, i)*corner(2, next) - corner(2, i)*corner(1, next)
         area = area + cross/2
         centroid = centroid + cross*(corner(:, i) + corner(:, next))/6
      end do
      centroid = centroid/area
   end subroutine polygon_centroid

end module rigid_cases
