!> How far a scene is from having more than one solution: an estimate of the contraction of the Picard map tau -> nu S_rho(p(tau)).
!>
!> The fixed point of tau -> nu S_rho(p(tau)) is unique where the map contracts. It is piecewise linear: on each set of states the
!> derivative is a matrix L, and the map contracts where all L that occur have a spectral radius below 1, in a norm that they
!> share.
!>
!> Where all points of a set are closed and slip, the normal forces follow the tangential ones linearly, q_n = A q_t with A =
!> -C_nn^-1 C_nt (and what the rigid motions add), and the map of tau is L = nu w^-1 A w S, S the directions of slip. Two solutions
!> on this set, or a Picard loop that cycles, need a spectral radius of L of 1 or more; for one point it is nu |C_nt|/C_nn = nu
!> |K_nt|/K_tt. Sets: all points, and those that are closed in the solution, all slipping the same way; and the solution itself,
!> where those that slip go on the way they do and those that stick hold: their forces follow, too. Other sets and directions may
!> be worse, hence an estimate. The average S_rho is left out.
module atrito_contraction
   use atrito_bound_qp, only: bound_qp_t, FREE, AT_LOWER
   use atrito_contact_line, only: contact_line_t
   use atrito_dense, only: eigen_symmetric, multiply_vector
   use atrito_dense_blocks, only: factor_in_blocks, solve_with_triangle
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: estimate_contraction

   !> The linear map of a set of closed points, of which some slip, ready to be applied.
   !>
   !> With the set's forces q, its rows r = 0 and the balance G' q = h, a change t of the friction of the slipping points changes q
   !> by -(C + D)^-1 (C_nt w t - G a), where a makes the forces balance again.
   type :: slip_map_t
      real(wp), allocatable :: factor(:, :)       !< Cholesky factor of C_nn + D, scaled
      real(wp), allocatable :: scale(:)           !< of its rows
      real(wp), allocatable :: coupling(:, :)     !< C_nt
      real(wp), allocatable :: y(:, :)            !< (C_nn + D)^-1 G_n; n: the set
      real(wp), allocatable :: gt(:, :)           !< G_t
      real(wp), allocatable :: inverse(:, :)      !< of G_n' Y, on the motions that the set holds
      real(wp), allocatable :: left(:), right(:)  !< nu/w and w of the slipping points
      integer(ip), allocatable :: place(:)        !< in the set, of the slipping points
   end type slip_map_t

   real(wp), parameter :: NULL_MOTION = 1.0e-10_wp  !< part of a motion that the set does not hold
   integer, parameter :: FIRST_STEPS = 8, STEPS = 16  !< of the powers: those that are left out, those that are measured

contains

   !> The estimate sigma; 0 without friction.
   !>
   !> Three sets are asked (see above), each with one factor of C_nn + D and 24 products: cheap beside the loop. sigma < 1 is no
   !> proof that there is one solution, since other sets might be worse; sigma >= 1 is worth a warning (W-UNIQUE).
   function estimate_contraction(problem, line, compliance, state) result(sigma)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      real(wp), intent(in) :: compliance(:)       !< (m) D of the laws [L/F]
      integer(ip), intent(in) :: state(:)         !< (m) of the solution
      real(wp) :: sigma
      logical :: can_slip(problem%n_normal)
      integer(ip), allocatable :: all_points(:), closed(:)
      integer(ip) :: i

      can_slip = [(line%tangential(line%point(i)) > 0 .and. line%law(line%point(i))%nu > 0.0_wp, i=1, problem%n_normal)]
      sigma = 0.0_wp
      if (.not. any(can_slip)) return
      all_points = [(i, i=1, problem%n_normal)]
      closed = pack(all_points, state(:problem%n_normal) == FREE)
      sigma = contraction_of_sliding(all_points, pack(all_points, can_slip))
      if (size(closed) < size(all_points)) sigma = max(sigma, contraction_of_sliding(closed, pack(closed, can_slip(closed))))
      sigma = max(sigma, contraction_of_solution())

   contains

      !> The estimate of the solution: what sticks holds. Where all closed points slip the same way it has been made.
      !>
      !> Sticking points are in the set with their tangential unknowns, so their friction follows what the others do.
      function contraction_of_solution() result(sigma)
         real(wp) :: sigma
         integer(ip), allocatable :: points(:), sticking(:), slipping(:)
         real(wp), allocatable :: direction(:)

         sigma = 0.0_wp
         points = pack(closed, can_slip(closed))
         slipping = line%tangential(line%point(points))
         sticking = pack(slipping, state(slipping) == FREE)
         points = pack(points, state(slipping) /= FREE)
         slipping = pack(slipping, state(slipping) /= FREE)
         direction = merge(-1.0_wp, 1.0_wp, state(slipping) == AT_LOWER)
         if (size(sticking) == 0 .and. abs(sum(direction)) >= size(direction)) return
         sigma = contraction_of(problem, line, compliance, [closed, sticking], points, direction)
      end function contraction_of_solution

      !> The estimate of a set of points that all slip the same way.
      function contraction_of_sliding(set, points) result(sigma)
         integer(ip), intent(in) :: set(:)           !< normal unknowns
         integer(ip), intent(in) :: points(:)        !< of those the ones that can slip
         real(wp) :: sigma
         real(wp) :: direction(size(points))

         direction = 1.0_wp
         sigma = contraction_of(problem, line, compliance, set, points, direction)
      end function contraction_of_sliding

   end function estimate_contraction

   !> The estimate of a set of unknowns that follow where some points slip.
   function contraction_of(problem, line, compliance, set, points, direction) result(sigma)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: compliance(:)
      integer(ip), intent(in) :: set(:)           !< normal unknowns, and tangential ones of points that stick
      integer(ip), intent(in) :: points(:)        !< that slip: their normal unknowns, in the set
      real(wp), intent(in) :: direction(:)        !< of their slip
      real(wp) :: sigma
      type(slip_map_t) :: map
      integer(ip) :: place(size(points)), places(problem%m)
      logical :: possible
      integer(ip) :: i

      sigma = 0.0_wp
      if (size(points) == 0) return
      places = 0
      places(set) = [(i, i=1, size(set, kind=ip))]
      place = places(points)
      call build_map(line%tangential(line%point(points)), map)
      if (possible) sigma = radius_of(map, direction)

   contains

      subroutine build_map(slipping, map)
         integer(ip), intent(in) :: slipping(:)      !< their tangential unknowns
         type(slip_map_t), intent(out) :: map
         integer(ip) :: i, n, failed

         n = size(set, kind=ip)
         map%factor = problem%c(set, set)
         do i = 1, n
            map%factor(i, i) = map%factor(i, i) + compliance(set(i))
         end do
         ! (C_nn + D) of the set, scaled to a unit diagonal and factored
         possible = all([(map%factor(i, i) > 0.0_wp, i=1, n)])  ! rows among rigid bodies alone give way nowhere
         if (.not. possible) return
         map%scale = [(1.0_wp/sqrt(map%factor(i, i)), i=1, n)]
         do i = 1, n
            map%factor(:, i) = map%factor(:, i)*map%scale*map%scale(i)
         end do
         call factor_in_blocks(map%factor, failed)
         possible = failed == 0
         if (.not. possible) return
         map%coupling = problem%c(set, slipping)
         map%gt = problem%g(slipping, :)
         map%y = problem%g(set, :)
         do i = 1, problem%k
            map%y(:, i) = solved(map, map%y(:, i))
         end do
         map%place = place
         ! pressures from forces on the left, forces from shears on the right
         map%left = line%law(line%point(slipping))%nu/problem%weight(slipping)
         map%right = problem%weight(slipping)
         call invert_on_range(matmul(transpose(problem%g(set, :)), map%y), map%inverse)
      end subroutine build_map

   end function contraction_of

   !> (C_nn + D)^-1 x
   function solved(map, x) result(y)
      type(slip_map_t), intent(in) :: map
      real(wp), intent(in) :: x(:)
      real(wp) :: y(size(x))

      y = x*map%scale
      call solve_with_triangle(map%factor, y)
      y = y*map%scale
   end function solved

   !> The inverse of a symmetric matrix on its range, the pseudo-inverse.
   subroutine invert_on_range(a, inverse)
      real(wp), intent(in) :: a(:, :)
      real(wp), allocatable, intent(out) :: inverse(:, :)
      real(wp) :: vectors(size(a, 1), size(a, 1)), values(size(a, 1))
      integer(ip) :: info, i, j

      allocate (inverse, mold=a)
      inverse = 0.0_wp
      if (size(a) == 0) return
      vectors = 0.5_wp*(a + transpose(a))
      call eigen_symmetric(vectors, values, info)
      if (info /= 0) return
      do i = 1, size(values, kind=ip)
         if (values(i) <= NULL_MOTION*maxval(values)) cycle
         do j = 1, size(values, kind=ip)
            inverse(:, j) = inverse(:, j) + vectors(:, i)*(vectors(j, i)/values(i))
         end do
      end do
   end subroutine invert_on_range

   !> The spectral radius of L, by the growth of its powers, which a complex pair of eigenvalues does not disturb.
   !>
   !> |L^k v| grows as radius^k. The mean of log |L v|/|v| over STEPS steps, after FIRST_STEPS in which lesser eigenvalues die away,
   !> is log(radius) also where two eigenvalues of the same size turn the vector for ever.
   function radius_of(map, direction) result(radius)
      type(slip_map_t), intent(in) :: map
      real(wp), intent(in) :: direction(:)
      real(wp) :: radius
      real(wp) :: v(size(map%right)), growth, sum_of_logs
      integer :: step, i

      v = [(1.0_wp + 0.5_wp*sin(real(3*i, wp)), i=1, size(v))]   ! a part of every vector, as good as surely
      v = v/norm2(v)
      radius = 0.0_wp
      sum_of_logs = 0.0_wp
      do step = 1, FIRST_STEPS + STEPS
         v = image_of(map, direction*v)
         growth = norm2(v)
         if (.not. growth > 0.0_wp) return
         v = v/growth
         if (step > FIRST_STEPS) sum_of_logs = sum_of_logs + log(growth)
      end do
      radius = exp(sum_of_logs/STEPS)
   end function radius_of

   !> nu p of the slipping points for t = v: q = -(C_nn + D)^-1 (C_nt w t - G_n a), where G_n' q = -G_t' w t gives a.
   !>
   !> x = C_nt (w t), the displacement of the set by the friction; its forces undo that, as far as the rigid motions do not: a moves
   !> the bodies so that the forces balance again.
   function image_of(map, v) result(z)
      type(slip_map_t), intent(in) :: map
      real(wp), intent(in) :: v(:)
      real(wp) :: z(size(v)), t(size(v)), x(size(map%scale)), a(size(map%inverse, 1))

      t = map%right*v
      call multiply_vector(map%coupling, t, x)
      a = matmul(map%inverse, matmul(transpose(map%y), x) - matmul(transpose(map%gt), t))
      x = -solved(map, x) + matmul(map%y, a)
      z = map%left*x(map%place)
   end function image_of

end module atrito_contraction
