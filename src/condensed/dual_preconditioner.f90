!> A solve of the contact line with the factor of an earlier one.
!>
!> Conjugate gradients in the space of forces that balance the load, preconditioned by P, the earlier factor seen from the present
!> set (N. I. M. Gould, M. E. Hribar, J. Nocedal, SIAM J. Sci. Comput. 23, 2001). Each step solves
!>
!>     [P -G; -G' 0] [dq; da] = [r; -s],       r = rhs + G a - M q,   s = load - G' q
!>
!> with s = 0. They go on until r is round-off of the terms it is made of; then comes one refinement, as after a solve with a
!> factor of its own. All of it is scaled to a unit diagonal of M = C + D.
module atrito_dual_preconditioner
   use atrito_dense, only: eigen_symmetric
   use atrito_dense_blocks, only: multiply_symmetric
   use atrito_kinds, only: ip, wp
   use atrito_free_set_factor, only: free_set_factor_t, relation_t, relate_sets, apply_inverse
   implicit none (type, external)
   private
   public :: complement_t, free_system_t, find_complement, refine_complement, solve_with_kept, scaled_product

   !> The equations of a free set, scaled: M q - G a = rhs, G' q = load.
   type :: free_system_t
      integer(ip), allocatable :: set(:)         !< (n) free unknowns
      real(wp), allocatable :: d(:)              !< (n) D of them [L/F]
      real(wp), allocatable :: scale(:)          !< (n) of the rows and columns
      real(wp), allocatable :: g(:, :)           !< (n, k)
      real(wp), allocatable :: rhs(:)            !< (n)
      real(wp), allocatable :: load(:)           !< (k) [F]
   end type free_system_t

   !> How firmly a free set holds each motion: eigenvectors and eigenvalues of G' M^-1 G, scaled to a unit diagonal.
   type :: complement_t
      real(wp), allocatable :: vectors(:, :), values(:), scale(:) !< (k, k), (k) ascending, (k) of the diagonal
   end type complement_t

   !> P and its complement of the motions.
   type :: preconditioner_t
      type(relation_t) :: relation               !< of the factor's set to the set asked for
      real(wp), allocatable :: y(:, :)           !< P^-1 G
      real(wp), allocatable :: inverse(:, :)     !< of G' P^-1 G
   end type preconditioner_t

   !> Steps that take about the time of a factor: n^3/3 operations against n^2 that wait for memory, the more so the larger n is
   !> (measured for 400 to 3,200 unknowns: 14 to 34).
   integer(ip), parameter :: FACTOR_IN_STEPS = 20_ip, ORDER_OVER_STEPS = 200_ip
   integer(ip), parameter :: FEW_STEPS = 3_ip       !< that a near set takes
   real(wp), parameter :: ROUND_OFF = 1.0e-15_wp    !< of the terms of the residual
   real(wp), parameter :: FALSE_END = 1.0e-11_wp    !< of the terms of the true residual: the steps did not go where they said
   real(wp), parameter :: LEAST_CURVATURE = 1.0e-13_wp !< of M; below it points depend on each other, which a factor tells
   real(wp), parameter :: WEAKLY_HELD = 1.0e-6_wp   !< a motion that the free set hardly holds asks for a factor of its own
   real(wp), parameter :: HARDLY_HELD = 1.0e-12_wp  !< round-off of the complement
   real(wp), parameter :: SEES = 1.0e-6_wp, SEES_NONE = 1.0e-13_wp !< of a motion, of its size: a row; round-off

   !> Forces and motions of the system so far, and the residual of their rows.
   type :: approximation_t
      real(wp), allocatable :: x(:), b(:), r(:) !< (n) forces, (k) motions, (n) residual, all scaled
   end type approximation_t

contains

   !> Solves from the present q and a. solved is false where the factor's set is not near or has served its time, a motion is held
   !> weakly, or the steps would take longer than a factor: q and a are then as they were.
   !>
   !> P^-1 costs one solve with the factor of the earlier set, r one product with C: 4 n^2 operations a step, where a factor takes
   !> n^3/3. Where few unknowns differ the eigenvalues of P^-1 M are 1 but for as many, and conjugate gradients end after about as
   !> many steps.
   subroutine solve_with_kept(factor, c, system, q, a, solved)
      type(free_set_factor_t), intent(inout) :: factor !< of the last solve
      real(wp), intent(in), contiguous :: c(:, :) !< (m, m) [L/F]
      type(free_system_t), intent(in) :: system   !< scaled, of the free set that is asked for
      real(wp), intent(inout) :: q(:)            !< (n) scaled
      real(wp), intent(inout) :: a(:)            !< (k) [L]
      logical, intent(out) :: solved             !< .false.: q and a are as they were
      type(preconditioner_t) :: p
      type(approximation_t) :: found
      real(wp) :: terms, remains
      integer(ip) :: most, steps

      solved = .false.
      if (.not. allocated(factor%set)) return
      most = FACTOR_IN_STEPS + size(q, kind=ip)/ORDER_OVER_STEPS
      if (factor%steps > most) return
      ! how the present set lies in that of the factor: unknowns that have become free stand in P with their diagonal alone
      call relate_sets(factor, size(c, 1, kind=ip), system%set, system%scale, p%relation)
      if (2*p%relation%differences > size(q)) return
      call prepare_motions(factor, system, p, solved)
      if (.not. solved) return
      found%x = q
      found%b = a
      ! a first step makes the forces balance the load; all later ones keep that
      call correct()
      call find_residual(terms)
      call take_steps(factor, c, system, p, most, ROUND_OFF*terms, found, steps)
      solved = maxval(abs(found%r)) <= ROUND_OFF*terms
      factor%steps = factor%steps + max(steps - FEW_STEPS, 0_ip)
      if (.not. solved) return
      ! the residual of the recurrence may have left the true one behind
      call correct()
      solved = remains <= FALSE_END
      if (.not. solved) return
      q = found%x
      a = found%b

   contains

      !> One step with both residuals.
      subroutine correct()
         real(wp) :: z(size(found%x)), db(size(found%b)), terms

         call find_residual(terms)
         remains = 0.0_wp
         if (terms > 0.0_wp) remains = maxval(abs(found%r))/terms
         call apply_inverse(factor, p%relation, found%r, z)
         db = matmul(p%inverse, system%load - matmul(transpose(system%g), found%x) - matmul(transpose(system%g), z))
         found%x = found%x + z + matmul(p%y, db)
         found%b = found%b + db
      end subroutine correct

      !> r, and the size of what it is the difference of.
      !>
      !> All in the scaled unknowns; the product with C goes through the whole matrix.
      subroutine find_residual(terms)
         real(wp), intent(out) :: terms
         real(wp) :: moved(size(found%x)), product(size(found%x))

         moved = matmul(system%g, found%b)
         product = scaled_product(c, system, found%x)
         found%r = system%rhs + moved - product
         terms = maxval(abs(system%rhs)) + maxval(abs(moved)) + maxval(abs(product))
      end subroutine find_residual

   end subroutine solve_with_kept

   !> S = G' M^-1 G, scaled to a unit diagonal, by its eigenvectors; y = M^-1 G. A motion that no free unknown sees has the scale 1
   !> and the eigenvalue 0.
   subroutine find_complement(g, y, complement)
      real(wp), intent(in) :: g(:, :), y(:, :)   !< (n, k)
      type(complement_t), intent(out) :: complement !< of all motions
      integer(ip) :: j, k, info

      k = size(g, 2, kind=ip)
      complement%vectors = matmul(transpose(g), y)
      complement%vectors = 0.5_wp*(complement%vectors + transpose(complement%vectors))
      allocate (complement%scale(k), source=1.0_wp)
      allocate (complement%values(k))
      associate (vectors => complement%vectors, scale => complement%scale)
         do j = 1, k
            if (vectors(j, j) > 0.0_wp) scale(j) = 1.0_wp/sqrt(vectors(j, j))
         end do
         do j = 1, k
            vectors(:, j) = vectors(:, j)*scale*scale(j)
         end do
         call eigen_symmetric(vectors, complement%values, info)
      end associate
   end subroutine find_complement

   !> Motions that seem not to be held may be held well, but by rows that are far softer than others of their bodies: a stiff body
   !> on a soft one, with supports aslant. S has the digits of the stiff rows. So such motions N get a complement of their
   !> own, (G N)' M^-1 (G N), without what round-off leaves of the stiff rows in G N, and a scale of its own. Where no row
   !> sees more of them than SEES they are not held, and stay as they are.
   subroutine refine_complement(g, y, complement)
      real(wp), intent(in) :: g(:, :), y(:, :)   !< (n, k)
      type(complement_t), intent(inout) :: complement !< motions that seemed not to be held are judged anew
      type(complement_t) :: own
      integer(ip), allocatable :: weak(:)
      real(wp), allocatable :: n(:, :), seen(:, :), size_of(:, :)
      integer(ip) :: j

      weak = pack([(j, j=1, size(complement%values, kind=ip))], complement%values <= HARDLY_HELD)
      if (size(weak) == 0) return
      n = complement%vectors(:, weak)*spread(complement%scale, 2, size(weak))
      seen = matmul(g, n)
      size_of = spread(sum(abs(g), dim=2), 2, size(weak))*spread(maxval(abs(n), dim=1), 1, size(g, 1))
      if (all(abs(seen) <= SEES*size_of)) return
      where (abs(seen) <= SEES_NONE*size_of) seen = 0.0_wp
      call find_complement(seen, matmul(y, n), own)
      complement%vectors = complement%vectors*spread(complement%scale, 2, size(complement%scale))
      complement%scale = 1.0_wp
      complement%vectors(:, weak) = matmul(n, own%vectors*spread(own%scale, 2, size(weak)))
      complement%values(weak) = own%values
   end subroutine refine_complement

   !> P^-1 G and the inverse of G' P^-1 G, where the set holds all motions.
   !>
   !> A motion that is held weakly (an eigenvalue below WEAKLY_HELD) is decided on by digits that P does not have: a factor of its
   !> own.
   !>
   !> The inverse is wanted in full, k being three a body at the most: with S = diag(scale)^-1 V diag(values) V' diag(scale)^-1
   !>
   !>     inverse = sum_i (scale v_i) (scale v_i)' / value_i,
   !>
   !> one term a motion. It takes k solves with the factor, 2 n^2 operations each, before the first step.
   subroutine prepare_motions(factor, system, p, held)
      type(free_set_factor_t), intent(in) :: factor
      type(free_system_t), intent(in) :: system
      type(preconditioner_t), intent(inout) :: p
      logical, intent(out) :: held
      type(complement_t) :: complement
      integer(ip) :: i, j, k

      k = size(system%g, 2, kind=ip)
      allocate (p%y(size(system%g, 1), k), p%inverse(k, k))
      held = .true.
      if (k == 0) return
      do j = 1, k
         call apply_inverse(factor, p%relation, system%g(:, j), p%y(:, j))
      end do
      call find_complement(system%g, p%y, complement)
      held = all(complement%values > WEAKLY_HELD)
      if (.not. held) return
      p%inverse = 0.0_wp
      associate (vectors => complement%vectors, scale => complement%scale)
         do i = 1, k
            do j = 1, k
               p%inverse(:, j) = p%inverse(:, j) + vectors(:, i)*(vectors(j, i)*scale(j)/complement%values(i))*scale
            end do
         end do
      end associate
   end subroutine prepare_motions

   !> Conjugate gradients until the largest entry of r is small enough.
   !>
   !> With the projection of the residual onto balanced forces, z = P^-1 (r + G db) with G' z = 0, the method is that of M on the
   !> space G' q = 0: alpha = r'z/p'Mp, q <- q + alpha p, r <- r - alpha M p, beta = r'z over that of the step before. Ends early
   !> where a curvature p'Mp that is round-off shows that rows depend on each other.
   subroutine take_steps(factor, c, system, p, most, enough, found, step)
      type(free_set_factor_t), intent(in) :: factor
      real(wp), intent(in), contiguous :: c(:, :)
      type(free_system_t), intent(in) :: system
      type(preconditioner_t), intent(in) :: p
      integer(ip), intent(in) :: most
      real(wp), intent(in) :: enough
      type(approximation_t), intent(inout) :: found
      integer(ip), intent(out) :: step           !< steps that were made
      real(wp) :: z(size(found%x)), direction(size(found%x)), product(size(found%x)), db(size(found%b))
      real(wp) :: begin, now, rz, last_rz, curvature

      direction = 0.0_wp
      last_rz = 1.0_wp
      begin = maxval(abs(found%r))
      do step = 0, most
         now = maxval(abs(found%r))
         if (now <= enough) return
         if (step >= 2*FEW_STEPS .and. is_slow(step, most, enough, begin, now)) return
         call apply_inverse(factor, p%relation, found%r, z)
         ! projection onto forces that balance nothing: G' z = 0
         db = -matmul(p%inverse, matmul(transpose(system%g), z))
         z = z + matmul(p%y, db)
         found%r = found%r + matmul(system%g, db)
         found%b = found%b + db
         rz = dot_product(found%r, z)
         direction = z + (rz/last_rz)*direction
         product = scaled_product(c, system, direction)
         ! p' M p beside p' p: below LEAST_CURVATURE rows depend on each other
         curvature = dot_product(direction, product)
         if (.not. (rz > 0.0_wp .and. curvature > LEAST_CURVATURE*dot_product(direction, direction))) return
         found%x = found%x + (rz/curvature)*direction
         found%r = found%r - (rz/curvature)*product
         last_rz = rz
      end do
   end subroutine take_steps

   !> Whether the steps, going on as they did, would be too many.
   !>
   !> The logarithm of the residual falls evenly, as far as is known: log(begin/now) in `step` steps, and log(now/enough) is still
   !> to go.
   pure logical function is_slow(step, most, enough, begin, now)
      integer(ip), intent(in) :: step, most
      real(wp), intent(in) :: enough, begin, now

      is_slow = now >= begin
      if (is_slow) return
      is_slow = real(most - step, wp)*log(begin/now) < real(step, wp)*log(now/enough)
   end function is_slow

   !> M q.
   function scaled_product(c, system, q) result(product)
      real(wp), intent(in), contiguous :: c(:, :) !< (m, m) of all unknowns [L/F]
      type(free_system_t), intent(in) :: system   !< its set, D and scale
      real(wp), intent(in) :: q(:)                !< (n) scaled
      real(wp) :: product(size(q))
      real(wp) :: force(size(c, 1)), moved(size(c, 1))

      force = 0.0_wp
      force(system%set) = q*system%scale
      call multiply_symmetric(c, force, moved)
      product = (moved(system%set) + system%d*force(system%set))*system%scale
   end function scaled_product

end module atrito_dual_preconditioner
