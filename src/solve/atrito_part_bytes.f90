!> What the solvers of the parts of a scene will take on their ranks, before the parts are made.
!>
!> A part is expected to take of what its body would take by itself the share that it has in the body's elements; what it leaves of
!> the equations that it keeps is a full matrix. That is an upper bound, but for some hundredths of small parts that keep much, and
!> some twice of what elements take that are equal, so where it does not fit the parts are made one after the other, on the first
!> rank, and their fronts counted.
module atrito_part_bytes
   use atrito_assembly, only: fem_t, body_profile, collect_elements
   use atrito_bodies, only: order_by_dissection
   use atrito_body_memory, only: estimate_body_memory
   use atrito_condensed_body, only: choose_solver
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: element_store_t, elimination_t
   use atrito_part, only: part_t, make_part, release_part
   use atrito_profile, only: profile_t
   use atrito_results, only: body_result_t
   use atrito_shares, only: shares_t, share_t, top_t
   use atrito_solver_choice, only: SOLVER_SPARSE
   use atrito_sparse_solver, only: expect_fronts
   implicit none (type, external)
   private
   public :: part_bytes_t, estimate_parts, count_parts, scale_parts, spread_over_parts, count_kept

   !> [bytes], (parts of the scene)
   type :: part_bytes_t
      integer(lp), allocatable :: held(:)        !< by its factors, and what is left of it
      integer(lp), allocatable :: most(:)        !< while it is factored
   end type part_bytes_t

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8

contains

   !> An upper bound, nearly.
   subroutine estimate_parts(fem, shares, parts)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      type(part_bytes_t), intent(out) :: parts
      type(profile_t) :: profile
      type(body_result_t) :: body, nothing
      real(wp) :: share
      integer(lp) :: left
      integer(ip) :: b, p
      integer :: kind

      allocate (parts%held(shares%n), parts%most(shares%n))
      do b = 1, fem%bodies%n
         if (shares%first(b) == shares%first(b + 1)) cycle
         body = nothing
         call body_profile(fem, b, profile)
         call choose_solver(profile, SOLVER_SPARSE, kind, body)
         call estimate_body_memory(fem, b, body)
         do p = shares%first(b), shares%first(b + 1) - 1
            share = real(size(shares%list(p)%elements), wp)/real(size(fem%bodies%list(b)%elements), wp)
            left = REAL_BYTES*count_kept(fem, shares, p)**2
            parts%held(p) = left + int(share*real(body%memory, wp), lp)
            parts%most(p) = left + int(share*real(body%most_memory, wp), lp)
         end do
      end do
   end subroutine estimate_parts

   !> Counts what the parts will take: they are made, and nothing is factored.
   subroutine count_parts(fem, shares, parts)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      type(part_bytes_t), intent(inout) :: parts     !< where the memory to count does not suffice it stays
      integer(ip) :: p

      do p = 1, shares%n
         call count_part(fem, shares, p, parts%held(p), parts%most(p))
      end do
   end subroutine count_parts

   subroutine count_part(fem, shares, p, held, most)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      integer(ip), intent(in) :: p
      integer(lp), intent(inout) :: held, most
      type(part_t) :: part
      type(elimination_t) :: elimination
      type(element_store_t) :: store
      integer(lp) :: counted, counted_most, left
      logical :: enough

      call make_part(fem, shares, p, part)
      call order_by_dissection(part%fem%mesh, part%fem%bodies, 1_ip, elimination)
      associate (body => part%fem%bodies%list(1))
         call collect_elements(part%fem, body%elements, store, part%fem%grain)
         call expect_fronts(elimination, body%n, body%n_retained, store, counted, counted_most, enough)
         left = REAL_BYTES*int(body%n_retained, lp)**2
      end associate
      call release_part(part)
      if (.not. enough) return
      held = counted + left
      most = counted_most + left
   end subroutine count_part

   !> Parts of other shares of a scene whose parts take a share of what is expected of them.
   subroutine scale_parts(counted, expected, parts)
      type(part_bytes_t), intent(in) :: counted, expected    !< of the shares that there are
      type(part_bytes_t), intent(inout) :: parts
      real(wp) :: share

      share = real(sum(counted%most), wp)/real(max(sum(expected%most), 1_lp), wp)
      parts%held = int(share*real(parts%held, wp), lp)
      parts%most = int(share*real(parts%most, wp), lp)
   end subroutine scale_parts

   !> What ranks say that all of their parts take, in proportion to what is expected of each.
   subroutine spread_over_parts(shares, of_ranks, parts)
      type(shares_t), intent(in) :: shares
      integer(lp), intent(in) :: of_ranks(0:)        !< (ranks)
      type(part_bytes_t), intent(inout) :: parts     !< in, as they are expected
      integer(lp) :: expected(0:size(of_ranks) - 1)
      integer(ip) :: p

      expected = 0
      do p = 1, shares%n
         expected(shares%list(p)%rank) = expected(shares%list(p)%rank) + parts%most(p)
      end do
      do p = 1, shares%n
         associate (rank => shares%list(p)%rank)
            parts%most(p) = int(real(of_ranks(rank), wp)*real(parts%most(p), wp)/real(max(expected(rank), 1_lp), wp), lp)
         end associate
      end do
      parts%held = parts%most
   end subroutine spread_over_parts

   !> Equations that a part keeps: those of its body that are retained, or, of a piece, all top unknowns that it has.
   pure integer(lp) function count_kept(fem, shares, p) result(n)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      integer(ip), intent(in) :: p
      logical, allocatable :: is_top(:)
      integer(ip) :: i, dof, k

      associate (share => shares%list(p), body => fem%bodies%list(shares%list(p)%body))
         n = int(body%n_retained, lp)
         if (share%is_whole) return
         n = 0
         allocate (is_top(0:body%n), source=.false.)
         is_top(shares%tops(share%body)%equation) = .true.
         do i = 1, size(share%nodes, kind=ip)
            do dof = 1, 2
               k = max(fem%bodies%equation(dof, share%nodes(i)), 0_ip)
               if (is_top(k)) n = n + 1
            end do
         end do
      end associate
   end function count_kept

end module atrito_part_bytes
