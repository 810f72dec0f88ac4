!> The matrix of a scene that is cut into parts, one a rank: the sparse form of the contact system (atrito_contact_system) by direct
!> substructuring (atrito_part_service has the equations).
!>
!> What the iteration needs is here, on the first rank, as for atrito_assembled_scene: numbers, rows, loads and vectors over all
!> unknowns. Elements, matrices and factors are with the parts. Sums are in the order of the parts.
module atrito_shared_scene
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: rank_count
   use atrito_buffer, only: buffer_t, put, take, take_status
   use atrito_part_maker, only: make_scene_part
   use atrito_part_service, only: ask, ask_with, begin_question, hear, hear_values, held_bytes, ASSEMBLE, EXPAND, FORGET, &
                                  MULTIPLY, REDUCE, REFACTOR, SCHUR_BEGIN, SCHUR_FACTOR, SCHUR_SOLVE
   use atrito_row_entries, only: build_constraint_rows
   use atrito_scene_cut, only: place_t, scene_cut_t, plan_cut, diagonals_of_rows
   use atrito_scene_elimination, only: eliminate_scene, number_scene
   use atrito_scene_part, only: scene_part_t, put_scene_part
   use atrito_scene_shares, only: share_elements
   use atrito_scene_system, only: scene_system_t, set_scene_gaps, set_flexibility
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: shared_scene_t, share_scene

   type(status_t), target :: failure             !< of the first solve with S that failed, until it is taken (scene_system_t)

   !> A scene in parts (scene_system_t).
   type, extends(scene_system_t) :: shared_scene_t
      type(place_t), allocatable :: parts(:)     !< the first rank, where it has one, has the first
      integer(ip), allocatable, private :: shared(:) !< unknown of the scene of each that is shared
      logical, private :: is_stale = .true.      !< S is not the sum of what is left of the parts
   contains
      procedure :: multiply => multiply_shared
      procedure :: factor => factor_shared
      procedure :: solve => solve_shared
      procedure :: memory_bytes => shared_bytes
      procedure :: solving_bytes => first_solving_bytes
      procedure :: release => release_parts
      procedure :: solving_of_ranks
   end type shared_scene_t

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INDEX_BYTES = storage_size(1_ip)/8

contains

   !> Cuts the scene, hands the parts over as they are made, one after the other, and has them assembled. status: STATUS_INTERNAL
   !> when the memory does not suffice.
   subroutine share_scene(fem, rows, line, value, n_ranks, scene, rank_of, status)
      type(fem_t), intent(in) :: fem             !< whole scene, numbered
      type(contact_rows_t), intent(in) :: rows   !< nodes of each contact point
      type(contact_line_t), intent(in) :: line   !< which points have rows, and their gaps
      real(wp), intent(in) :: value(:, :)        !< (2, n_nodes) prescribed displacements [L]
      integer(ip), intent(in) :: n_ranks         !< of the run, >= 1
      type(shared_scene_t), intent(out) :: scene !< its parts are with the ranks, assembled
      integer(ip), allocatable, intent(out) :: rank_of(:) !< (n_elements) 0..n_ranks - 1
      type(status_t), intent(out) :: status      !< STATUS_OK or STATUS_INTERNAL
      type(scene_cut_t) :: cut
      real(wp), allocatable :: diagonal(:), coupling(:)
      integer(ip), allocatable :: part_of_element(:), rank(:)
      integer(ip) :: i

      call number_scene(fem, scene%numbering)
      scene%n = scene%numbering%n
      scene%k = scene%numbering%k
      scene%n_bodies = fem%bodies%n
      scene%body = scene%numbering%body
      allocate (part_of_element(fem%mesh%n_elements))
      call share_elements(fem, scene%numbering, eliminate_scene(fem, rows, line, scene%numbering), n_ranks, part_of_element, rank)
      rank_of = rank(part_of_element)
      call build_constraint_rows(fem, rows, line, .true., scene%rows)
      call set_scene_gaps(rows, line, value, scene)
      allocate (diagonal(scene%n), coupling(scene%n))
      call diagonals_of_rows(fem, rows, scene%numbering, diagonal, coupling)
      call plan_cut(fem, rows, line, scene%numbering, diagonal, part_of_element, size(rank, kind=ip), cut)
      do i = 1, scene%k                          ! springs stand beside the elements
         associate (spring => scene%numbering%spring(i))
            if (spring > 0) diagonal(spring) = diagonal(spring) + cut%spring_stiffness(i)
         end associate
      end do
      call set_flexibility(fem, rows, line, diagonal, coupling, scene)
      deallocate (diagonal, coupling, part_of_element)
      scene%shared = pack([(i, i=1, scene%n)], cut%shared_number > 0)
      allocate (scene%parts(size(rank)))
      scene%parts%rank = rank
      scene%failure => failure
      call hand_over()
      call hear_assembled(scene, status)

   contains

      !> Makes the parts, the first rank's last: the others assemble theirs meanwhile.
      subroutine hand_over()
         type(scene_part_t) :: part, nothing
         type(buffer_t) :: request
         integer(ip) :: p

         do p = size(scene%parts, kind=ip), 1, -1
            associate (place => scene%parts(p))
               call make_scene_part(fem, rows, line, scene%numbering, scene%rows, p, cut, part, place)
               place%shared = cut%shared_number(place%unknown(size(place%unknown) - part%n_kept + 1:))
               place%n_elements = cut%first_element(p + 1) - cut%first_element(p)
               call begin_question(ASSEMBLE, request)
               call put_scene_part(request, part)
               part = nothing
               call ask(place%rank, request)
            end associate
         end do
      end subroutine hand_over

   end subroutine share_scene

   !> What became of the parts; then MUMPS is told who has which shared unknowns.
   subroutine hear_assembled(scene, status)
      type(shared_scene_t), intent(inout) :: scene
      type(status_t), intent(out) :: status
      type(status_t) :: of_part
      type(buffer_t) :: answer
      character(len=:), allocatable :: order
      logical :: is_near
      integer(ip) :: p

      do p = 1, size(scene%parts, kind=ip)
         call hear(scene%parts(p)%rank, answer)
         call take_status(answer, of_part)
         call take(answer, is_near)
         call take(answer, order)
         call take(answer, scene%parts(p)%solving)
         if (is_ok(status)) status = of_part
         scene%is_near = scene%is_near .or. is_near
         if (p == 1) call move_alloc(order, scene%order)
      end do
      if (is_ok(status)) call begin_schur(scene, status)
   end subroutine hear_assembled

   !> Says which shared unknowns each rank has. status: STATUS_INTERNAL: there is no MUMPS, or too little memory.
   subroutine begin_schur(scene, status)
      type(shared_scene_t), intent(in) :: scene
      type(status_t), intent(out) :: status
      type(buffer_t) :: request, answer
      integer(ip) :: rank, p

      do rank = rank_count() - 1, 0, -1
         call begin_question(SCHUR_BEGIN, request)
         call put(request, size(scene%shared, kind=ip))
         p = findloc(scene%parts%rank, rank, dim=1, kind=ip)
         if (p > 0) call put(request, scene%parts(p)%shared)
         if (p == 0) call put(request, [integer(ip) ::])
         call ask(rank, request)
      end do
      call hear_all(answer)
      call take_status(answer, status)
   end subroutine begin_schur

   !> Asks all ranks without anything besides.
   subroutine ask_all(wanted, answer)
      integer(ip), intent(in) :: wanted
      type(buffer_t), intent(out) :: answer
      type(buffer_t) :: request
      integer(ip) :: rank

      do rank = rank_count() - 1, 0, -1
         call begin_question(wanted, request)
         call ask(rank, request)
      end do
      call hear_all(answer)
   end subroutine ask_all

   !> The answers of all ranks; that of the first one counts.
   subroutine hear_all(answer)
      type(buffer_t), intent(out) :: answer
      integer(ip) :: rank

      do rank = rank_count() - 1, 0, -1
         call hear(rank, answer)
      end do
   end subroutine hear_all

   !> y = A x: the sum of the parts'.
   subroutine multiply_shared(self, x, y)
      class(shared_scene_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: y(:)
      real(wp), allocatable :: found(:)
      integer(ip) :: p

      do p = size(self%parts, kind=ip), 1, -1
         call ask_with(self%parts(p)%rank, MULTIPLY, x(self%parts(p)%unknown))
      end do
      y = 0.0_wp
      do p = 1, size(self%parts, kind=ip)
         call hear_values(self%parts(p)%rank, found)
         associate (own => self%parts(p)%unknown)
            y(own) = y(own) + found
         end associate
      end do
   end subroutine multiply_shared

   !> The parts, then S where what is left of any of them is another than before.
   subroutine factor_shared(self, stiffness, pull, status)
      class(shared_scene_t), intent(inout) :: self
      real(wp), intent(in) :: stiffness(:), pull(:)
      type(status_t), intent(out) :: status
      type(status_t) :: of_part
      type(buffer_t) :: request, answer
      integer(ip) :: p, failed
      logical :: is_changed

      do p = size(self%parts, kind=ip), 1, -1
         call begin_question(REFACTOR, request)
         call put(request, stiffness(self%parts(p)%row))
         call put(request, pull(self%parts(p)%pull))
         call ask(self%parts(p)%rank, request)
      end do
      self%failed = 0
      do p = 1, size(self%parts, kind=ip)
         call hear(self%parts(p)%rank, answer)
         call take_status(answer, of_part)
         call take(answer, failed)
         call take(answer, is_changed)
         self%is_stale = self%is_stale .or. is_changed
         if (is_ok(of_part) .or. .not. is_ok(status)) cycle
         status = of_part                        ! the first failure counts
         if (failed > 0) self%failed = self%parts(p)%unknown(failed)
      end do
      if (.not. (is_ok(status) .and. self%is_stale)) return
      call ask_all(SCHUR_FACTOR, answer)
      call take_status(answer, status)
      call take(answer, failed)
      if (failed > 0) self%failed = self%shared(failed)
      self%is_stale = .not. is_ok(status)
   end subroutine factor_shared

   !> Solves A x = f in three rounds (the equations are those of atrito_part_service). Each part eliminates its interior unknowns
   !> from its own loads; f at the shared unknowns, which several parts have, is added once, here, so what is handed to the parts
   !> has zeros there. The sum of what the parts leave is the right-hand side of the Schur complement, whose solution they get back
   !> to find their interior unknowns. Ranks are asked from the last to the first, which works itself while the others do, and
   !> heard from the first to the last, so that sums do not depend on who is quick.
   subroutine solve_shared(self, x)
      class(shared_scene_t), intent(in) :: self
      real(wp), intent(inout) :: x(:)
      real(wp), allocatable :: f(:), shared(:), found(:)
      integer(ip) :: p

      do p = size(self%parts, kind=ip), 1, -1
         associate (part => self%parts(p))
            f = x(part%unknown)
            f(size(f) - size(part%shared) + 1:) = 0.0_wp
            call ask_with(part%rank, REDUCE, f)
         end associate
      end do
      shared = x(self%shared)
      do p = 1, size(self%parts, kind=ip)
         call hear_values(self%parts(p)%rank, found)
         associate (own => self%parts(p)%shared)
            shared(own) = shared(own) + found
         end associate
      end do
      call solve_schur(shared)
      do p = size(self%parts, kind=ip), 1, -1
         call ask_with(self%parts(p)%rank, EXPAND, shared(self%parts(p)%shared))
      end do
      do p = 1, size(self%parts, kind=ip)
         call hear_values(self%parts(p)%rank, found)
         x(self%parts(p)%unknown) = found        ! parts that share an unknown have the same number for it
      end do
   end subroutine solve_shared

   !> x <- S^-1 x; 0 where that failed, which is noted: nothing that was found may be believed then.
   subroutine solve_schur(x)
      real(wp), intent(inout) :: x(:)            !< (shared unknowns)
      real(wp), allocatable :: found(:)
      type(buffer_t) :: request, answer
      type(status_t) :: status
      integer(ip) :: rank

      do rank = rank_count() - 1, 0, -1
         call begin_question(SCHUR_SOLVE, request)
         call put(request, x(:merge(size(x), 0, rank == 0)))
         call ask(rank, request)
      end do
      call hear_all(answer)
      call take_status(answer, status)
      call take(answer, found)
      x = 0.0_wp
      if (is_ok(status)) x = found
      if (is_ok(failure)) failure = status
   end subroutine solve_schur

   !> All ranks give back what they have.
   subroutine release_parts(self)
      class(shared_scene_t), intent(inout) :: self
      type(buffer_t) :: answer

      if (.not. allocated(self%parts)) return
      call ask_all(FORGET, answer)
      deallocate (self%parts)
   end subroutine release_parts

   pure integer(lp) function shared_bytes(self) result(bytes)
      class(shared_scene_t), intent(in) :: self

      bytes = held_bytes() + (REAL_BYTES + INDEX_BYTES)*(size(self%rows%value, kind=lp) + int(self%n, lp))
   end function shared_bytes

   !> What solving will take of the first rank.
   pure integer(lp) function first_solving_bytes(self) result(bytes)
      class(shared_scene_t), intent(in) :: self

      bytes = sum(self%solving_of_ranks(1_ip))
   end function first_solving_bytes

   !> What solving will take of the first ranks beyond what they hold when the parts are assembled [bytes]: the parts; of S a
   !> share, and what MUMPS makes of the rank's own matrix; on the first one the vectors of the iteration.
   pure function solving_of_ranks(self, n_ranks) result(bytes)
      class(shared_scene_t), intent(in) :: self
      integer(ip), intent(in) :: n_ranks
      integer(lp) :: bytes(0:n_ranks - 1)
      integer(lp), parameter :: MUMPS_BYTES = 14_lp, OF_UNKNOWNS = 12_lp, OF_ROWS = 40_lp
      integer(ip) :: p

      bytes = REAL_BYTES*size(self%shared, kind=lp)**2/2/maxval(self%parts%rank + 1)
      bytes(0) = bytes(0) + REAL_BYTES*(OF_UNKNOWNS*int(self%n, lp) + OF_ROWS*int(self%rows%n, lp))
      do p = 1, size(self%parts, kind=ip)
         associate (part => self%parts(p))
            if (part%rank < n_ranks) bytes(part%rank) = bytes(part%rank) + int(part%solving, lp) &
                                                        + MUMPS_BYTES*size(part%shared, kind=lp)**2
         end associate
      end do
   end function solving_of_ranks

end module atrito_shared_scene
