!> Motions that nothing holds and no load drives, on the sparse form of the bodies.
!>
!> With the states of a solution, H being the matrix that was factored last, the step a <- H^-1 (kappa a) leaves such a motion as
!> it is, since nothing but the pull kappa is in H for it; any other motion is held by stiffnesses of the rows and is taken to less
!> than a millionth. So a vector without pattern, twice through the step, becomes an undetermined motion, or nothing; what is left
!> is made orthogonal to those that are known, until nothing is left (subspace iteration with the eigenvalues 1 and 0).
!>
!> Of the displacements that differ by undetermined motions those are given whose relative displacements at the points, |B (x + V
!> s)|^2, are least: the bodies stay together. That is taken back where a point would penetrate or slip along with its friction;
!> what is best there atrito_idle_motions finds. In a history amplitudes count from those of the increment before.
module atrito_undetermined_motions
   use atrito_bodies, only: simplest_motion
   use atrito_bound_qp, only: box_bounds_t, box_state_t, FREE, AT_LOWER, AT_UPPER
   use atrito_contact_system, only: contact_system_t
   use atrito_dense, only: least_squares
   use atrito_kinds, only: ip, wp
   use atrito_multiplier_step, only: set_forces
   use atrito_multipliers, only: multiplier_t
   use atrito_sparse_rows, only: multiply_rows, add_transposed
   implicit none (type, external)
   private
   public :: settle_undetermined_motions

   integer(ip), parameter :: MOST_UNDETERMINED = 6_ip    !< motions that are looked for
   real(wp), parameter :: NO_PART = 1.0e-3_wp    !< of a vector that is left of it without undetermined motion
   real(wp), parameter :: STAYS = 0.999_wp       !< of an undetermined motion without its round-off
   real(wp), parameter :: STAYS_PUT = 1.0e-9_wp  !< of a row in a motion of size one
   real(wp), parameter :: DEPENDENT = 1.0e-8_wp
   real(wp), parameter :: GOLDEN = 0.6180339887498949_wp

contains

   !> Takes the least motion, unless points would penetrate or slip with their friction. undetermined: one of the motions, (k); not
   !> allocated when there is none. position: where the bodies were before, from where it counts.
   !>
   !> basis: the undetermined motions; the amplitudes are measured from `position`, the displacements of the increment before, so
   !> that a body stays where it is.
   subroutine settle_undetermined_motions(system, bounds, multipliers, state, undetermined, position)
      class(contact_system_t), intent(in) :: system !< A, B, loads, flexibilities
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(multiplier_t), intent(inout) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      real(wp), allocatable, intent(out) :: undetermined(:)
      real(wp), intent(in), optional :: position(:) !< (k) [L]; not there: 0
      real(wp), allocatable :: basis(:, :)
      type(multiplier_t) :: least
      type(box_state_t) :: least_state

      ! the rest is tried on copies, as it may be taken back
      call find_undetermined_motions(system, multipliers, basis)
      if (size(basis, 2) == 0) return
      allocate (undetermined, source=simplest_motion(basis(system%n - system%k + 1:, :)))
      least = multipliers
      least_state = state
      associate (amplitudes => least%x(system%n - system%k + 1:))
         if (present(position)) amplitudes = amplitudes - position
         call reduce_motion(system, basis, least%x)
         if (present(position)) amplitudes = amplitudes + position
      end associate
      call set_forces(system, bounds, least, least_state)
      if (changes_a_state(bounds, state, least%e - bounds%d*state%q, &
                          least%noise*(bounds%d + least%r*least%part*system%flexibility))) return
      multipliers = least
      state%a = least_state%a
      where (state%state /= FREE) state%r = least%e - bounds%d*state%q
   end subroutine settle_undetermined_motions

   !> Whether r > 0 at an open point or one that slips at its lower bound, or r < 0 at one that slips at its upper one.
   !>
   !> Motions of bodies do not change forces, only r = B x + g0 - D q. Where r gets the other sign the point would close, or stick.
   pure logical function changes_a_state(bounds, state, r, slack) result(changes)
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(in) :: state
      real(wp), intent(in) :: r(:), slack(:)     !< (m) [L]

      changes = any(bounds%lower < bounds%upper .and. (state%state == AT_LOWER .and. r > slack .or. &
                                                       state%state == AT_UPPER .and. r < -slack))
   end function changes_a_state

   !> The basis (n, motions) has orthonormal amplitudes; the displacements in them are round-off.
   !>
   !> For each candidate: a vector without pattern, orthogonal to the motions that are known; two steps of the proximal method;
   !> orthogonal again. What is left after that (more than NO_PART) is undetermined, unless it strains something (take_out_held,
   !> STAYS).
   subroutine find_undetermined_motions(system, multipliers, basis)
      class(contact_system_t), intent(in) :: system
      type(multiplier_t), intent(in) :: multipliers
      real(wp), allocatable, intent(out) :: basis(:, :)
      real(wp) :: v(system%n), before
      real(wp), allocatable :: found(:, :)
      integer(ip) :: n, i, j

      allocate (found(system%n, min(MOST_UNDETERMINED, system%k)))
      n = 0
      associate (first => system%n - system%k + 1)
         do i = 1, size(found, 2, kind=ip)
            v = 0.0_wp
            ! numbers between -1/2 and 1/2 with no relation to the bodies
            v(first:) = [(modulo(GOLDEN*real(j*(j + 2*i), wp), 1.0_wp) - 0.5_wp, j=1, system%k)]
            call orthogonalise(found(first:, :n), v(first:))
            before = norm2(v)
            call apply_step()
            call apply_step()
            call orthogonalise(found(first:, :n), v(first:))
            if (norm2(v(first:)) <= NO_PART*before) exit
            before = norm2(v(first:))
            call take_out_held()
            if (norm2(v(first:)) <= STAYS*before) exit
            n = n + 1
            found(:, n) = v/norm2(v(first:))
         end do
      end associate
      basis = found(:, :n)

   contains

      !> An undetermined motion strains nothing: what strain there is is round-off of the step, and is taken out.
      !>
      !> v <- v - H^-1 (A v + B' s B v), twice: what the rows and the bodies feel of v goes. A motion that loses a thousandth of
      !> itself by that was held, weakly.
      subroutine take_out_held()
         real(wp) :: force(system%n), relative(system%rows%n)
         integer(ip) :: i

         do i = 1, 2
            call system%multiply(v, force)
            call multiply_rows(system%rows, v, relative)
            call add_transposed(system%rows, 1.0_wp, multipliers%stiffness*relative, force)
            call system%solve(force)
            v = v - force
         end do
      end subroutine take_out_held

      !> a <- H^-1 (kappa a), with the displacements that go with it.
      !>
      !> The step from rest with a_o = a and no loads: x = H^-1 (0, kappa H a).
      subroutine apply_step()

         associate (n_displacements => system%n - system%k)
            v(:n_displacements) = 0.0_wp
            v(n_displacements + 1:) = multipliers%pull*v(n_displacements + 1:)
         end associate
         call system%solve(v)
      end subroutine apply_step

   end subroutine find_undetermined_motions

   pure subroutine orthogonalise(basis, v)
      real(wp), intent(in) :: basis(:, :)
      real(wp), intent(inout) :: v(:)
      integer(ip) :: j

      do j = 1, size(basis, 2, kind=ip)
         v = v - dot_product(basis(:, j), v)*basis(:, j)
      end do
   end subroutine orthogonalise

   !> Least squares of B x over the undetermined motions; those that no row sees get the amplitude zero.
   !>
   !> First x without its part along them, so that motions that no row sees get the amplitude zero; then the least |B x + B V s|^2.
   subroutine reduce_motion(system, basis, x)
      class(contact_system_t), intent(in) :: system
      real(wp), intent(in) :: basis(:, :)
      real(wp), intent(inout) :: x(:)
      real(wp) :: moved(system%rows%n, size(basis, 2)), relative(system%rows%n), amplitude(size(basis, 2))
      integer(ip) :: j, rank, info

      associate (first => system%n - system%k + 1)
         x = x - matmul(basis, matmul(transpose(basis(first:, :)), x(first:)))
      end associate
      do j = 1, size(basis, 2, kind=ip)
         call multiply_rows(system%rows, basis(:, j), moved(:, j))
      end do
      where (abs(moved) < STAYS_PUT) moved = 0.0_wp
      call multiply_rows(system%rows, x, relative)
      call least_squares(moved, relative, amplitude, DEPENDENT, rank, info)
      if (info == 0) x = x - matmul(basis, amplitude)
   end subroutine reduce_motion

end module atrito_undetermined_motions
