!> The contact problem of two blocks in quadruple precision: the law of docs/theory/formulation.md at the points, and its solution.
!>
!> Unknowns are the contact forces q (normal, then tangential, one of each a point) and the amplitudes a of the rigid motions:
!> relative displacement less distance = g0 - C q + G a, and G' q = h.
module quad_contact
   use, intrinsic :: iso_fortran_env, only: real64, real128
   use quad_body, only: body_t
   implicit none (type, external)
   private
   public :: contact_t, build_contact, place_of, bound_of

   integer, parameter :: qp = real128

   type :: contact_t
      integer :: n = 0                                 !< points
      integer :: k = 0                                 !< rigid motions
      real(qp), allocatable :: x(:, :)                 !< (2, n)
      real(qp), allocatable :: s(:)                    !< (n) arc length on the slave
      real(qp), allocatable :: length(:), weight(:)    !< (n) quadrature weights, without and with thickness
      real(qp), allocatable :: distance(:)             !< (n) initial
      real(qp), allocatable :: average(:, :)           !< W
      real(qp), allocatable :: c(:, :), g0(:), g(:, :), h(:)
      logical, allocatable :: known(:)                 !< (2n) a row without a free dof: its place is known
      real(qp) :: nu = 0, eps = 0, delta = 0
      real(qp), allocatable :: placed(:)               !< (2n) prescribed part of known rows
   end type contact_t

contains

   subroutine build_contact(upper, lower, nu, eps, rho, delta, contact)
      type(body_t), intent(in) :: upper, lower
      real(real64), intent(in) :: nu, eps, rho, delta
      type(contact_t), intent(out) :: contact
      real(qp), allocatable :: upper_rows(:, :), lower_rows(:, :)
      integer :: n, i

      contact%nu = nu
      contact%eps = eps
      contact%delta = delta
      call place_points(upper, lower, contact, upper_rows, lower_rows)
      n = contact%n
      contact%average = average_of(contact, real(rho, qp))
      contact%k = size(upper%work) + size(lower%work)
      contact%c = matmul(upper_rows, matmul(upper%flexibility, transpose(upper_rows))) &
                  + matmul(lower_rows, matmul(lower%flexibility, transpose(lower_rows)))
      contact%c = (contact%c + transpose(contact%c))/2
      contact%g0 = matmul(upper_rows, upper%u0) + matmul(lower_rows, lower%u0)
      contact%g0(:n) = contact%g0(:n) - contact%distance
      allocate (contact%g(2*n, contact%k))
      contact%g(:, :size(upper%work)) = matmul(upper_rows, upper%modes)
      contact%g(:, size(upper%work) + 1:) = matmul(lower_rows, lower%modes)
      contact%h = [upper%work, lower%work]
      contact%known = [(.not. (any(abs(upper_rows(i, :)) > 0 .and. .not. upper%contact_held) &
                               .or. any(abs(lower_rows(i, :)) > 0 .and. .not. lower%contact_held)), i=1, 2*n)]
   end subroutine build_contact

   !> The points are the slave's nodes, with the trapezoidal or Simpson's rule on the faces all of whose nodes see the master. Each
   !> looks along the slave's normal; the master is one straight line.
   subroutine place_points(upper, lower, contact, upper_rows, lower_rows)
      type(body_t), intent(in) :: upper, lower
      type(contact_t), intent(inout) :: contact
      real(qp), allocatable, intent(out) :: upper_rows(:, :), lower_rows(:, :)
      real(qp), parameter :: OVERHANG = 1.0e-6_qp      !< of a master face
      real(qp) :: tangent(2), normal(2), start(2), along(2), shape(3), share(0:2), from, face, piece
      real(qp), allocatable :: place(:), distance(:), weight(:)
      logical, allocatable :: used(:)
      integer :: i, j, n_slave, first, o, point

      n_slave = size(upper%contact)
      o = upper%order
      associate (x => upper%x(:, upper%contact), m => lower%x(:, lower%contact))
         tangent = (x(:, n_slave) - x(:, 1))/norm2(x(:, n_slave) - x(:, 1))
         normal = [tangent(2), -tangent(1)]
         start = m(:, 1)
         along = m(:, size(m, 2)) - m(:, 1)
         allocate (place(n_slave), distance(n_slave), weight(n_slave), used(n_slave))
         do i = 1, n_slave
            ! x + distance*normal = start + place*along
            place(i) = ((x(1, i) - start(1))*normal(2) - (x(2, i) - start(2))*normal(1))/(along(1)*normal(2) - along(2)*normal(1))
            distance(i) = dot_product(start + place(i)*along - x(:, i), normal)
         end do
         share = [0.5_qp, 0.5_qp, 0.0_qp]
         if (o == 2) share = [1.0_qp, 4.0_qp, 1.0_qp]/6
         used = .false.
         weight = 0
         from = -OVERHANG/lower%nx
         do i = 1, n_slave - o, o
            if (any(place(i:i + o) < from) .or. any(place(i:i + o) > 1 - from)) cycle
            used(i:i + o) = .true.
            face = norm2(x(:, i + o) - x(:, i))
            weight(i:i + o) = weight(i:i + o) + share(:o)*face
         end do
         contact%n = count(used)
         allocate (contact%x(2, contact%n), contact%s(contact%n))
         allocate (upper_rows(2*contact%n, 2*n_slave), lower_rows(2*contact%n, 2*size(lower%contact)), source=0.0_qp)
         contact%length = pack(weight, used)
         contact%weight = contact%length*upper%thickness
         contact%distance = pack(distance, used)
         point = 0
         do i = 1, n_slave
            if (.not. used(i)) cycle
            point = point + 1
            contact%x(:, point) = x(:, i)
            contact%s(point) = norm2(x(:, i) - x(:, 1))
            upper_rows(point, 2*i - 1:2*i) = normal
            upper_rows(contact%n + point, 2*i - 1:2*i) = tangent
            piece = min(max(place(i), 0.0_qp), 1.0_qp)*lower%nx
            first = min(int(piece), lower%nx - 1)
            shape = face_shapes(lower%order, piece - first)
            do j = 0, lower%order
               associate (dof => 2*(first*lower%order + j))
                  lower_rows(point, dof + 1:dof + 2) = -shape(j + 1)*normal
                  lower_rows(contact%n + point, dof + 1:dof + 2) = -shape(j + 1)*tangent
               end associate
            end do
         end do
      end associate
   end subroutine place_points

   pure function face_shapes(order, t) result(shape)
      integer, intent(in) :: order
      real(qp), intent(in) :: t
      real(qp) :: shape(3)

      shape = [1 - t, t, 0.0_qp]
      if (order == 2) shape = [(1 - t)*(1 - 2*t), 4*t*(1 - t), t*(2*t - 1)]
   end function face_shapes

   !> W of the kernel exp(rho^2/(r^2 - rho^2)), rows that sum to one; the identity up to the least spacing.
   pure function average_of(contact, rho) result(w)
      type(contact_t), intent(in) :: contact
      real(qp), intent(in) :: rho
      real(qp) :: w(contact%n, contact%n), r, least
      integer :: j, k

      w = 0
      least = huge(least)
      do j = 2, contact%n
         least = min(least, norm2(contact%x(:, j) - contact%x(:, j - 1)))
      end do
      do j = 1, contact%n
         do k = 1, contact%n
            r = norm2(contact%x(:, j) - contact%x(:, k))
            if (rho <= least) then
               if (j == k) w(j, k) = 1
            else if (r < rho) then
               w(j, k) = exp(rho**2/(r**2 - rho**2))*contact%length(k)
            end if
         end do
         w(j, :) = w(j, :)/sum(w(j, :))
      end do
   end function average_of

   !> Relative displacement less distance, (2n): normal (overlap), then tangential (slip).
   pure function place_of(contact, q, a) result(place)
      type(contact_t), intent(in) :: contact
      real(qp), intent(in) :: q(:), a(:)
      real(qp) :: place(size(q))

      place = contact%g0 - matmul(contact%c, q) + matmul(contact%g, a)
   end function place_of

   !> tau = nu S_rho(p).
   pure function bound_of(contact, q, nu) result(tau)
      type(contact_t), intent(in) :: contact
      real(qp), intent(in) :: q(:), nu
      real(qp) :: tau(contact%n)

      tau = nu*matmul(contact%average, max(q(:contact%n)/contact%weight, 0.0_qp))
   end function bound_of

end module quad_contact
