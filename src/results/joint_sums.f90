!> What the contact of two bodies comes to: resultant, moment and place, opening and sliding of every joint.
!>
!> A joint is the part of a contact pair where its slave faces one body, or a rigid surface.
module atrito_joint_sums
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_points, only: contact_points_t
   use atrito_results, only: contact_result_t, joint_t
   implicit none (type, external)
   private
   public :: sum_joints

   !> Normals whose sum is a smaller share of their lengths have no mean: those of a closed ring.
   real(wp), parameter :: NO_DIRECTION = 1.0e-8_wp
   !> Round-off in the distance of points, in parts of it.
   real(wp), parameter :: SLACK = 1.0e-6_wp

contains

   !> The joints of all pairs, by pair, then along s. The points learn which joint is theirs.
   pure subroutine sum_joints(body_of_node, points, contact, joints)
      integer(ip), intent(in) :: body_of_node(:)            !< (n_nodes)
      type(contact_points_t), intent(in) :: points(:)       !< one a pair
      type(contact_result_t), intent(inout) :: contact(:)   !< one a pair
      type(joint_t), allocatable, intent(out) :: joints(:)  !< place of each is contact%joint
      type(joint_t) :: found(sum(points%n))
      integer(ip) :: i, n

      n = 0
      do i = 1, size(points, kind=ip)
         call find_joints(body_of_node, i, points(i), contact(i), found, n)
      end do
      joints = found(:n)
      do i = 1, n
         call sum_joint(contact(joints(i)%pair), i, joints(i))
      end do
   end subroutine sum_joints

   !> Adds the joints of a pair, in the order in which its points meet them.
   pure subroutine find_joints(body_of_node, pair, points, contact, joints, n)
      integer(ip), intent(in) :: body_of_node(:), pair
      type(contact_points_t), intent(in) :: points
      type(contact_result_t), intent(inout) :: contact
      type(joint_t), intent(inout) :: joints(:)
      integer(ip), intent(inout) :: n                       !< joints found so far
      type(joint_t) :: new
      integer(ip) :: before, j, k

      allocate (contact%joint(points%n), contact%follows(points%n))
      before = n
      new%pair = pair
      do j = 1, points%n
         new%bodies(1) = body_of_node(points%node(j))
         new%bodies(2) = 0
         if (.not. points%rigid) new%bodies(2) = body_of_node(points%entry(points%first(j + 1) - 1))
         do k = n, before + 1, -1                           ! most often that of the point before
            if (all(joints(k)%bodies == new%bodies)) exit
         end do
         if (k == before) then
            n = n + 1
            joints(n) = new
            k = n
         end if
         contact%joint(j) = k
         contact%follows(j) = .false.
         if (j == 1) cycle
         ! neighbours carry at least half of the face between them each
         contact%follows(j) = contact%joint(j - 1) == k .and. &
                              points%s(j) - points%s(j - 1) <= (1 + SLACK)*(points%length(j) + points%length(j - 1))
      end do
   end subroutine find_joints

   !> The sums of one joint. Forces are those of the master upon the slave.
   !>
   !> With n the outward normal of the slave, T the same turned by +90 degrees and w the weight of a point
   !>    F = sum w (sigma_T T - p n),   M = sum (x - middle) x w (sigma_T T - p n),
   !> the middle being the mean of x by the weights.
   pure subroutine sum_joint(contact, i, joint)
      type(contact_result_t), intent(in) :: contact         !< its pair
      integer(ip), intent(in) :: i                          !< the joint's number
      type(joint_t), intent(inout) :: joint
      real(wp) :: area, middle(2), normal(2), force(2), moment, at_point(2), arm(2)
      integer(ip) :: j

      area = sum(contact%weight, mask=contact%joint == i)
      middle = weighted_mean(contact, i, contact%x, area)
      normal = weighted_mean(contact, i, contact%normal, area)
      force = 0.0_wp
      moment = 0.0_wp
      do j = 1, contact%n
         if (contact%joint(j) /= i) cycle
         associate (n => contact%normal(:, j), w => contact%weight(j))
            at_point = w*(contact%shear(j)*[-n(2), n(1)] - contact%pressure(j)*n)
         end associate
         arm = contact%x(:, j) - middle
         force = force + at_point
         moment = moment + (arm(1)*at_point(2) - arm(2)*at_point(1))
         joint%length = max(joint%length, norm2(arm))
      end do
      joint%m = moment
      joint%force = norm2(force)
      joint%opening = maxval(contact%gap, mask=contact%joint == i)
      joint%sliding = sum(contact%weight/area*contact%slip, mask=contact%joint == i)
      call place_resultant(contact, i, middle, normal, force, joint)
   end subroutine sum_joint

   pure function weighted_mean(contact, i, values, area) result(mean)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: i                          !< the joint's number
      real(wp), intent(in) :: values(:, :)                  !< (2, n)
      real(wp), intent(in) :: area                          !< sum of the joint's weights [L^2]
      real(wp) :: mean(2)

      mean(1) = sum(contact%weight/area*values(1, :), mask=contact%joint == i)
      mean(2) = sum(contact%weight/area*values(2, :), mask=contact%joint == i)
   end function weighted_mean

   !> The resultant along the mean normal and its tangent, and where it crosses the line through the middle along the tangent: with
   !> the force -n N + t T at the distance e along T the moment is e n.
   pure subroutine place_resultant(contact, i, middle, normal, force, joint)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: i                          !< the joint's number
      real(wp), intent(in) :: middle(2), normal(2), force(2)
      type(joint_t), intent(inout) :: joint
      real(wp) :: along(2), across(2)

      joint%place = ieee_value(1.0_wp, ieee_quiet_nan)
      if (norm2(normal) <= NO_DIRECTION) then
         joint%n = joint%place(1)
         joint%t = joint%place(1)
         return
      end if
      across = normal/norm2(normal)
      along = [-across(2), across(1)]
      joint%n = -dot_product(across, force)
      joint%t = dot_product(along, force)
      if (joint%n <= 0.0_wp) return
      joint%place = middle + (joint%m/joint%n)*along
      joint%u = displacement_at(contact, i, middle, along, joint%m/joint%n)
   end subroutine place_resultant

   !> The slave's displacement at a distance from the middle, linear between the points; beyond the ends that of the end.
   pure function displacement_at(contact, i, middle, along, distance) result(u)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: i                          !< the joint's number
      real(wp), intent(in) :: middle(2), along(2), distance
      real(wp) :: u(2), here, before, share
      integer(ip) :: j, last

      u = 0.0_wp
      last = 0
      before = 0.0_wp
      do j = 1, contact%n
         if (contact%joint(j) /= i) cycle
         here = dot_product(contact%x(:, j) - middle, along)
         if (last == 0 .or. here <= distance) then
            u = contact%u(:, j)
         else if (before <= distance) then
            share = (distance - before)/(here - before)
            u = (1 - share)*contact%u(:, last) + share*contact%u(:, j)
         end if
         last = j
         before = here
      end do
   end function displacement_at

end module atrito_joint_sums
