!> What the solver of a body will take, while it is factored and afterwards.
module atrito_body_memory
   use atrito_assembly, only: fem_t, collect_elements
   use atrito_bodies, only: order_by_dissection
   use atrito_element_table, only: SHAPES
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: element_store_t, elimination_t
   use atrito_results, only: body_result_t
   use atrito_solver_choice, only: SOLVER_SPARSE
   use atrito_sparse_solver, only: expect_fronts
   implicit none (type, external)
   private
   public :: estimate_body_memory, count_body_memory

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INDEX_BYTES = storage_size(1_ip)/8, &
                             LONG_BYTES = storage_size(1_lp)/8
   !> Elements that are compared with the one before.
   integer(ip), parameter :: SAMPLES = 200_ip
   !> Differences of coordinates, relative to the side of an element, that are round-off.
   real(wp), parameter :: SAME = 1.0e-9_wp

contains

   !> Estimates, as an upper bound, what is not told by the profile: the matrices of the elements, and the sparse solver, which
   !> takes a quarter more than expected where no two elements are equal.
   pure subroutine estimate_body_memory(fem, b, result)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      type(body_result_t), intent(inout) :: result !< with its solver and what that is expected to take
      real(wp), parameter :: UNEQUAL = 1.25_wp
      integer(lp) :: elements

      elements = element_bytes(fem, b, different_share(fem, b))
      if (result%solver_kind >= SOLVER_SPARSE) then
         result%memory = int(UNEQUAL*real(result%memory, wp), lp)
         result%most_memory = result%memory + elements
      else
         result%most_memory = result%memory + elements + INDEX_BYTES*int(result%n_equations, lp)
      end if
   end subroutine estimate_body_memory

   !> Counts what the sparse solver will take: order, elements and fronts are made, and nothing is factored.
   subroutine count_body_memory(fem, b, result)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      type(body_result_t), intent(inout) :: result
      type(elimination_t) :: elimination
      type(element_store_t) :: store
      integer(lp) :: held, most
      logical :: enough

      call order_by_dissection(fem%mesh, fem%bodies, b, elimination)
      result%order = elimination%text
      call collect_elements(fem, fem%bodies%list(b)%elements, store, fem%grain)
      associate (kept => fem%bodies%list(b)%n_retained)
         call expect_fronts(elimination, fem%bodies%list(b)%n, kept, store, held, most, enough)
         if (.not. enough) return
         result%memory = held + REAL_BYTES*int(kept, lp)**2
         result%most_memory = max(result%memory, most)
      end associate
   end subroutine count_body_memory

   !> Equations and matrices of the elements of a body.
   pure integer(lp) function element_bytes(fem, b, share) result(bytes)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      real(wp), intent(in) :: share              !< of the elements that have a matrix of their own
      integer(lp) :: i, n

      bytes = 0
      do i = 1, size(fem%bodies%list(b)%elements)
         n = 2*fem%mesh%shape(fem%bodies%list(b)%elements(i))
         bytes = bytes + LONG_BYTES + INDEX_BYTES*(n + 1) + int(share*real(REAL_BYTES*(n*(n + 1)/2), wp), lp)
      end do
   end function element_bytes

   !> The share of the elements that differ from the one before, by some of them.
   pure real(wp) function different_share(fem, b) result(share)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      integer(ip) :: i, e, step, seen, different

      seen = 0
      different = 0
      associate (elements => fem%bodies%list(b)%elements)
         step = max(1_ip, size(elements, kind=ip)/SAMPLES)
         do i = 2, size(elements, kind=ip), step
            e = elements(i)
            seen = seen + 1
            if (.not. are_equal(fem, elements(i - 1), e)) different = different + 1
         end do
      end associate
      share = real(different, wp)/real(max(seen, 1_ip), wp)
   end function different_share

   pure logical function are_equal(fem, before, e)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: before, e
      real(wp) :: side, apart(2), way
      integer(ip) :: k, last

      are_equal = fem%mesh%shape(before) == fem%mesh%shape(e)
      if (.not. are_equal) return
      last = SHAPES(fem%mesh%shape(e))%n_corners
      way = merge(-1.0_wp, 1.0_wp, last == 3)      ! a triangle's neighbour is often turned by 180 degrees
      associate (x => fem%mesh%x, old => fem%mesh%nodes(:, before), new => fem%mesh%nodes(:, e))
         side = maxval(abs(x(:, new(2)) - x(:, new(1)))) + maxval(abs(x(:, new(last)) - x(:, new(1))))
         do k = 2, fem%mesh%shape(e)
            apart = (x(:, new(k)) - x(:, new(1))) - way*(x(:, old(k)) - x(:, old(1)))
            are_equal = are_equal .and. maxval(abs(apart)) <= SAME*side
         end do
      end associate
   end function are_equal

end module atrito_body_memory
