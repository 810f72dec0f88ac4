!> The Cholesky factor of C + D on a set of free unknowns, scaled to a unit diagonal.
!>
!> C is the compliance of a contact line, D the diagonal of its laws. Of the free unknowns F, those not at a bound,
!>
!>     M = T (C_FF + D_FF) T = L L',      T = diag(c_kk + d_k)^-1/2
!>
!> is factored. T is the scaling by which the condition of M is within a factor n of the best that a diagonal can do (van der Sluis,
!> Numer. Math. 14 (1969) 14-23), and pivots of M lie between 0 and 1: one below LEAST_PIVOT is the round-off of a row that depends
!> on those before, whatever the units.
!>
!> From one solve of a contact line to the next few unknowns change their state and D changes little. For another set G with the
!> scaling U the factor is the preconditioner of conjugate gradients (atrito_dual_preconditioner): on the unknowns that F has, too,
!> it is the inverse of M without the rows and columns of the others,
!>
!>     P^-1 = U^-1 T R (L L')^-1 R' T U^-1,      R: those of F that G has,
!>
!> and 1 on those that have become free, which are scaled to 1 themselves. With k unknowns that only one of the sets has, P^-1 times
!> the matrix of G differs from the unit matrix by one whose rank is about 2k, and so conjugate gradients take about as many steps,
!> at 4 n^2 operations each, in place of the n^3/3 of a new factor.
module atrito_free_set_factor
   use atrito_dense, only: estimate_condition
   use atrito_dense_blocks, only: factor_in_blocks, solve_with_triangle
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: free_set_factor_t, relation_t, factor_free_set, condition_of, is_worth_keeping, relate_sets, apply_inverse

   type :: free_set_factor_t
      integer(ip), allocatable :: set(:)         !< (n) unknowns; not allocated: there is no factor
      real(wp), allocatable :: scale(:)          !< (n) of the rows and columns
      real(wp), allocatable :: matrix(:, :)      !< (n, n) factor below and on the diagonal, the scaled matrix above
      integer(ip) :: steps = 0                   !< more than a near set takes, in all the solves that it served since
   end type free_set_factor_t

   !> How a set of unknowns lies in that of a factor.
   type :: relation_t
      integer(ip), allocatable :: place(:)       !< (n) of its unknowns in the factor's set; 0: none
      real(wp), allocatable :: ratio(:)          !< (n) scale of the factor over the present one
      integer(ip) :: differences = 0             !< unknowns that only one of the two has
   end type relation_t

   integer(ip), parameter :: LEAST_KEPT = 400_ip    !< free unknowns from which on the factor is kept
   real(wp), parameter :: LEAST_PIVOT = 1.0e-13_wp  !< scaled; below it points depend on each other

contains

   !> Whether a set is so large that its factor serves again.
   pure logical function is_worth_keeping(n)
      integer(ip), intent(in) :: n               !< free unknowns

      is_worth_keeping = n >= LEAST_KEPT
   end function is_worth_keeping

   !> Factors T (C + D) T of the free set, the lower triangle in place. The upper one keeps the scaled matrix, of which condition_of
   !> takes the norm; its diagonal is 1 and needs no place.
   !>
   !> A pivot is the square of the distance of a row from those before it, measured so that the row has the length 1: where it is
   !> below LEAST_PIVOT the row depends on them, two points of the line say the same, and the unknown is named to the caller.
   subroutine factor_free_set(c, d, set, factor, dependent)
      real(wp), intent(in), contiguous :: c(:, :)      !< (m, m) [L/F]
      real(wp), intent(in) :: d(:)                     !< (m) [L/F]
      integer(ip), intent(in) :: set(:)                !< (n) distinct free unknowns, 1 .. m
      type(free_set_factor_t), intent(inout) :: factor !< replaced; its memory is used again where n is the same
      integer(ip), intent(out) :: dependent !< 0, or an unknown whose row depends on those before; then there is no factor
      integer(ip) :: i, j, n, failed

      n = size(set, kind=ip)
      if (allocated(factor%matrix)) then
         if (size(factor%matrix, 1) /= n) deallocate (factor%matrix)
      end if
      if (.not. allocated(factor%matrix)) allocate (factor%matrix(n, n))
      factor%set = set
      factor%steps = 0
      factor%scale = [(1.0_wp/sqrt(c(set(i), set(i)) + d(set(i))), i=1, n)]
      !$omp parallel do schedule(static) default(none) shared(c, set, factor) if(size(set) >= LEAST_KEPT)
      do j = 1, size(set, kind=ip)
         factor%matrix(:, j) = c(set, set(j))*(factor%scale*factor%scale(j))
         factor%matrix(j, j) = 1.0_wp
      end do
      !$omp end parallel do
      call factor_in_blocks(factor%matrix, failed)
      if (failed == 0) then
         do i = 1, n
            if (factor%matrix(i, i)**2 < LEAST_PIVOT) failed = i
         end do
      end if
      dependent = 0
      if (failed == 0) return
      dependent = set(failed)
      deallocate (factor%set)
   end subroutine factor_free_set

   !> Estimate of the condition of the scaled matrix, in the 1-norm. Its norm is that of the upper triangle, which is still there:
   !> the column sums of |M| are 1 for the diagonal and each entry twice, in its column and, by symmetry, in that of its row.
   real(wp) function condition_of(factor) result(condition)
      type(free_set_factor_t), intent(in) :: factor !< as factor_free_set left it; 1 without a factor
      real(wp), allocatable :: sums(:)
      integer(ip) :: j, n

      condition = 1.0_wp
      if (.not. allocated(factor%set)) return
      n = size(factor%set, kind=ip)
      if (n == 0) return
      allocate (sums(n), source=1.0_wp)
      do j = 2, n
         sums(j) = sums(j) + sum(abs(factor%matrix(:j - 1, j)))
         sums(:j - 1) = sums(:j - 1) + abs(factor%matrix(:j - 1, j))
      end do
      condition = estimate_condition(factor%matrix, maxval(sums))
   end function condition_of

   !> Where the unknowns of a set stand in a factor, and by how much their scaling differs: R and U^-1 T of the head of this module.
   !> What only one of the two sets has is counted, to tell whether the factor is still near enough.
   pure subroutine relate_sets(factor, m, set, scale, relation)
      type(free_set_factor_t), intent(in) :: factor !< there is one
      integer(ip), intent(in) :: m                  !< unknowns there are
      integer(ip), intent(in) :: set(:)             !< (n) distinct free unknowns, 1 .. m
      real(wp), intent(in) :: scale(:)              !< its present scale
      type(relation_t), intent(out) :: relation     !< how `set` lies in the set of the factor
      integer(ip) :: place_of(m), i

      place_of = 0
      place_of(factor%set) = [(i, i=1, size(factor%set, kind=ip))]
      relation%place = place_of(set)
      allocate (relation%ratio(size(set)), source=0.0_wp)
      do i = 1, size(set, kind=ip)
         if (relation%place(i) > 0) relation%ratio(i) = factor%scale(relation%place(i))/scale(i)
      end do
      associate (common => count(relation%place > 0, kind=ip))
         relation%differences = size(set, kind=ip) + size(factor%set, kind=ip) - 2*common
      end associate
   end subroutine relate_sets

   !> P^-1 x in scaled form: x is taken to the unknowns of the factor and to its scaling, 0 where F has one that G has not; solved;
   !> and taken back. On the others P is 1. Two triangles go by: 2 n^2 operations, and the time that they take to come from memory.
   subroutine apply_inverse(factor, relation, x, y)
      type(free_set_factor_t), intent(in) :: factor !< as factor_free_set left it
      type(relation_t), intent(in) :: relation      !< of the present set to that of the factor
      real(wp), intent(in) :: x(:)                  !< (n)
      real(wp), intent(out) :: y(:)                 !< (n)
      real(wp) :: work(size(factor%set))
      integer(ip) :: i

      work = 0.0_wp
      do i = 1, size(x, kind=ip)
         if (relation%place(i) > 0) work(relation%place(i)) = x(i)*relation%ratio(i)
      end do
      call solve_with_triangle(factor%matrix, work)
      do i = 1, size(x, kind=ip)
         y(i) = x(i)
         if (relation%place(i) > 0) y(i) = work(relation%place(i))*relation%ratio(i)
      end do
   end subroutine apply_inverse

end module atrito_free_set_factor
