!> Which solver a body gets, and what that will take of time and memory, while the body is factored and afterwards.
!>
!> Time is told in operations of the skyline, from the profile of the matrix alone: nothing depends on the machine, and the same
!> deck has the same solver everywhere.
module atrito_body_cost
   use atrito_assembly, only: fem_t, collect_elements
   use atrito_bodies, only: order_by_dissection
   use atrito_element_table, only: SHAPES
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: element_store_t, elimination_t
   use atrito_profile, only: profile_t, profile_length, half_bandwidth, skyline_flops, banded_flops, sparse_flops, skyline_bytes, &
                             banded_bytes, sparse_bytes, sparse_entries
   use atrito_results, only: body_result_t
   use atrito_solver_choice, only: needs_profile, solver_name, N_STORAGES, SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE
   use atrito_sparse_solver, only: expect_fronts
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: choose_solver, kept_bytes, estimate_body_memory, count_body_memory

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INDEX_BYTES = storage_size(1_ip)/8, &
                             LONG_BYTES = storage_size(1_lp)/8
   !> Elements that are compared with the one before.
   integer(ip), parameter :: SAMPLES = 200_ip
   !> Differences of coordinates, relative to the side of an element, that are round-off.
   real(wp), parameter :: SAME = 1.0e-9_wp

   ! Costs in operations of the skyline, fitted to blocks and strips of 200 to 900,000 equations with OpenBLAS
   ! (docs/developer/solvers.md).
   !> Floating-point operations that LAPACK's band routines do in the time of one of the skyline's.
   real(wp), parameter :: BAND_SPEED = 2.2_wp
   !> The same of the fronts of the sparse solver.
   real(wp), parameter :: SPARSE_SPEED = 2.0_wp
   !> What assembly and solves take in the time of so many of them: for an equation, and for the sparse solver to begin with.
   real(wp), parameter :: SKYLINE_OVERHEAD = 1600.0_wp, BAND_OVERHEAD = 2500.0_wp, SPARSE_OVERHEAD = 1000.0_wp, &
                          SPARSE_START = 2.0e6_wp

contains

   !> Chooses the solver of a body by its predicted cost, unless one is asked for, and says why.
   !>
   !> Skyline: sums of squares of the column heights. Band: the half bandwidth squared for each equation, at the speed of LAPACK's
   !> blocks. Sparse: the fronts of nested dissection, estimated from the number of equations; for large bodies it is always that,
   !> and no profile is made. The constants were fitted to measured times; ties go to the first.
   subroutine choose_solver(profile, asked, result)
      type(profile_t), intent(in) :: profile !< of its matrix
      integer, intent(in) :: asked                 !< STORAGE_* or 0 for the choice
      type(body_result_t), intent(inout) :: result !< out: its solver, and the reason in words
      real(wp) :: cost(N_STORAGES)
      integer :: kind, second

      cost = predict_costs(profile)
      if (asked /= 0) then
         kind = asked
         result%reason = 'asked for'
      else
         kind = SOLVER_SPARSE
         if (needs_profile(asked, profile%n)) kind = minloc(cost, dim=1)
         second = minloc(cost, dim=1, mask=[SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE] /= kind)
         result%reason = 'predicted cost '//to_text(cost(kind)/max(cost(second), tiny(cost)), 2)//' of '//solver_name(second)
      end if
      result%solver = solver_name(kind)
      result%solver_kind = kind
      result%half_bandwidth = half_bandwidth(profile)
      result%profile = profile_length(profile)
      if (kind == SOLVER_SPARSE) result%profile = int(sparse_entries(profile), lp)
      select case (kind)
      case (SOLVER_SKYLINE)
         result%memory = skyline_bytes(profile)
      case (SOLVER_BANDED)
         result%memory = banded_bytes(profile)
      case default
         result%memory = sparse_bytes(profile)
      end select
      result%memory = result%memory + kept_bytes(profile%n_retained)
      result%most_memory = result%memory
   end subroutine choose_solver

   !> The matrix of the retained equations.
   elemental integer(lp) function kept_bytes(n_retained) result(bytes)
      integer(ip), intent(in) :: n_retained

      bytes = 8_lp*int(n_retained, lp)**2
   end function kept_bytes

   !> Predicted cost of every solver, in operations of the skyline.
   pure function predict_costs(profile) result(cost)
      type(profile_t), intent(in) :: profile
      real(wp) :: cost(N_STORAGES)

      cost(SOLVER_SKYLINE) = skyline_flops(profile) + SKYLINE_OVERHEAD*real(profile%n, wp)
      cost(SOLVER_BANDED) = banded_flops(profile)/BAND_SPEED + BAND_OVERHEAD*real(profile%n, wp)
      cost(SOLVER_SPARSE) = sparse_flops(profile)/SPARSE_SPEED + SPARSE_OVERHEAD*real(profile%n, wp) + SPARSE_START
   end function predict_costs

   !> Estimates, as an upper bound, what is not told by the profile: the matrices of the elements, and the sparse solver, which
   !> takes a quarter more than expected where no two elements are equal.
   !>
   !> What is held while a body is factored: its elements and their equations, the fronts or the profile, and S.
   pure subroutine estimate_body_memory(fem, b, result)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: b !< body
      type(body_result_t), intent(inout) :: result !< with its solver and what that is expected to take
      real(wp), parameter :: UNEQUAL = 1.25_wp
      integer(lp) :: elements

      elements = element_bytes(different_share())
      if (result%solver_kind >= SOLVER_SPARSE) then
         result%memory = int(UNEQUAL*real(result%memory, wp), lp)
         result%most_memory = result%memory + elements
      else
         result%most_memory = result%memory + elements + INDEX_BYTES*int(result%n_equations, lp)
      end if

   contains

      !> Equations and matrices of the elements of a body.
      pure integer(lp) function element_bytes(share) result(bytes)
         real(wp), intent(in) :: share              !< of the elements that have a matrix of their own
         integer(lp) :: i, n

         bytes = 0
         do i = 1, size(fem%bodies%list(b)%elements)
            n = 2*fem%mesh%shape(fem%bodies%list(b)%elements(i))
            bytes = bytes + LONG_BYTES + INDEX_BYTES*(n + 1) + int(share*real(REAL_BYTES*(n*(n + 1)/2), wp), lp)
         end do
      end function element_bytes

      !> The share of the elements that differ from the one before, by some of them.
      !>
      !> Equal elements share one matrix. In a regular mesh the next element in the list mostly equals the last one, so the share of
      !> those that do not is about the share of matrices; every body is asked SAMPLES times.
      pure real(wp) function different_share() result(share)
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

   end subroutine estimate_body_memory

   !> Counts what the sparse solver will take: order, elements and fronts are made, and nothing is factored.
   !>
   !> The symbolic factorisation without the numbers: exact, and some percent of the time of a factorisation.
   subroutine count_body_memory(fem, b, result)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: b !< body
      type(body_result_t), intent(inout) :: result !< gets order and memory [bytes], where it can be counted
      type(elimination_t) :: elimination
      type(element_store_t) :: store
      integer(lp) :: held, most
      logical :: enough

      call order_by_dissection(fem%mesh, fem%bodies, b, elimination)
      result%order = elimination%text
      call collect_elements(fem, fem%bodies%list(b)%elements, store, fem%digit_error)
      associate (kept => fem%bodies%list(b)%n_retained)
         call expect_fronts(elimination, fem%bodies%list(b)%n, kept, store, held, most, enough)
         if (.not. enough) return
         result%memory = held + kept_bytes(kept)
         result%most_memory = max(result%memory, most)
      end associate
   end subroutine count_body_memory

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

end module atrito_body_cost
