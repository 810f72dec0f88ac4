!> Sums over all nodes of the forces on the bodies, chunk by chunk of the nodes.
module atrito_force_sums
   use atrito_kinds, only: ip, wp
   use atrito_range, only: work_of, unit_of
   use atrito_results, only: balance_t
   use atrito_threads, only: is_shared, chunk_count, find_chunk
   implicit none (type, external)
   private
   public :: sum_forces

   type :: sums_t
      type(balance_t) :: balance                 !< of these nodes
      real(wp) :: work = 0.0_wp                  !< over the unit of displacement [F]
   end type sums_t

contains

   !> Resultants, and the work of applied forces and reactions.
   subroutine sum_forces(x, u, f, reaction, contact, balance, work)
      real(wp), intent(in) :: x(:, :)            !< (2, n_nodes) [L]
      real(wp), intent(in) :: u(:, :)            !< (2, n_nodes) [L]
      real(wp), intent(in) :: f(:, :)            !< applied forces (2, n_nodes) [F]
      real(wp), intent(in) :: reaction(:, :)     !< (2, n_nodes) [F]
      real(wp), intent(in) :: contact(:, :)      !< B'q (2, n_nodes) [F]
      type(balance_t), intent(out) :: balance    !< applied, reactions and rigid parts are set
      real(wp), intent(out) :: work              !< [F L]
      type(sums_t) :: sums(chunk_count(size(u, 2, kind=ip)))
      real(wp) :: unit
      integer(ip) :: chunk, first, last

      unit = unit_of(u)
      !$omp parallel do schedule(static) private(first, last) if (is_shared(size(u, 2, kind=ip)))
      do chunk = 1, size(sums, kind=ip)
         call find_chunk(chunk, size(u, 2, kind=ip), first, last)
         call sum_run(x(:, first:last), u(:, first:last), 1/unit, f(:, first:last), reaction(:, first:last), &
                      contact(:, first:last), sums(chunk))
      end do
      !$omp end parallel do
      do chunk = 1, size(sums, kind=ip)
         associate (part => sums(chunk)%balance)
            balance%applied = balance%applied + part%applied
            balance%reactions = balance%reactions + part%reactions
            balance%applied_moment = balance%applied_moment + part%applied_moment
            balance%reaction_moment = balance%reaction_moment + part%reaction_moment
            balance%rigid = balance%rigid + part%rigid
            balance%rigid_moment = balance%rigid_moment + part%rigid_moment
         end associate
      end do
      work = work_of(1_ip, [sum(sums%work)], [unit])
   end subroutine sum_forces

   !> Of a run of nodes the resultants of loads, reactions and contact, their moments about the origin x1 F2 - x2 F1, and the work
   !> of loads and reactions on the displacements over the unit.
   pure subroutine sum_run(x, u, per_unit, f, reaction, contact, sums)
      real(wp), intent(in) :: x(:, :), u(:, :), per_unit, f(:, :), reaction(:, :), contact(:, :)
      type(sums_t), intent(out) :: sums
      integer(ip) :: i

      do i = 1, size(x, 2, kind=ip)
         associate (s => sums%balance)
            s%applied = s%applied + f(:, i)
            s%reactions = s%reactions + reaction(:, i)
            s%applied_moment = s%applied_moment + (x(1, i)*f(2, i) - x(2, i)*f(1, i))
            s%reaction_moment = s%reaction_moment + (x(1, i)*reaction(2, i) - x(2, i)*reaction(1, i))
            s%rigid = s%rigid + contact(:, i)
            s%rigid_moment = s%rigid_moment + (x(1, i)*contact(2, i) - x(2, i)*contact(1, i))
         end associate
         sums%work = sums%work + ((f(1, i) + reaction(1, i))*(u(1, i)*per_unit) + (f(2, i) + reaction(2, i))*(u(2, i)*per_unit))
      end do
   end subroutine sum_run

end module atrito_force_sums
