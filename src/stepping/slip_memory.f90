!> What friction remembers of a history: the rest slip s0 of every point, at which the spring of its law has no force, and what the
!> points of each pair have dissipated.
!>
!> After an increment a sticking point keeps its s0, a slipping one has s0 = u_T - c t (c t is the elastic slip, which it keeps),
!> and one without a friction bound s0 = u_T: it touches again without shear. Friction dissipates w t ds0. Laws of the total slip
!> have no rest slip, but the same sum tells what they dissipate.
module atrito_slip_memory
   use atrito_contact_line, only: contact_line_t
   use atrito_friction_law, only: is_full, stick_compliance, FRICTION_NONE
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_restart_state, only: slip_memory_t
   use atrito_results, only: contact_result_t
   implicit none (type, external)
   private
   public :: begin_memory, remember_slips, put_rest

contains

   !> Nothing has slipped yet.
   pure subroutine begin_memory(model, n_points, memory)
      type(model_t), intent(in) :: model             !< laws of its pairs are read
      integer(ip), intent(in) :: n_points(:)         !< of each pair
      type(slip_memory_t), intent(out) :: memory     !< zeros
      integer(ip) :: i, n, first

      n = sum(n_points)
      allocate (memory%is_incremental(n), memory%slides(n), source=.false.)
      allocate (memory%rest(n), memory%slip(n), memory%shear(n), source=0.0_wp)
      allocate (memory%dissipation(size(n_points)), memory%moved(size(n_points)), source=0.0_wp)
      first = 0
      do i = 1, size(n_points, kind=ip)
         memory%is_incremental(first + 1:first + n_points(i)) = model%interactions(model%pairs(i)%interaction)%is_incremental
         first = first + n_points(i)
      end do
   end subroutine begin_memory

   !> Takes a converged increment over: rest slips, dissipation, and what each point has slipped since the one before.
   !>
   !> What counts is the friction bound, not the pressure: the nonlocal law has one at open points beside closed ones, too.
   !>
   !>     state of the point                rest slip s0 after the increment      dissipated
   !>     without a bound, or no friction   u_T                                   0
   !>     slips                             u_T - c t                             w mean(t) (change of s0)
   !>     sticks                            as before                             0
   !>
   !> The work of friction is the integral of w t ds0. A point that slid before, the same way, is taken to go from its last shear
   !> to this one in a straight line, so the mean is that of both. A point that began to slide had come to its bound before s0
   !> changed, so t is the friction of all of its way. With a law that has a memory t and the change of s0 have one sign: nothing
   !> is given back.
   pure subroutine remember_slips(line, tau, contact, memory)
      type(contact_line_t), intent(in) :: line            !< laws of the points are read
      real(wp), intent(in) :: tau(:)                 !< (points) friction bound that it was solved with [F/L^2]
      type(contact_result_t), intent(inout) :: contact(:) !< one a pair
      type(slip_memory_t), intent(inout) :: memory        !< takes the increment over
      integer(ip) :: i, j, k, first                  ! place in the pair, and on the line
      real(wp) :: rest, t, mean
      logical :: slides

      first = 0
      do i = 1, size(contact, kind=ip)
         associate (c => contact(i))
            c%slip_increment = c%slip - memory%slip(first + 1:first + c%n)
            memory%moved(i) = max(memory%moved(i), maxval(abs(c%u)), maxval(abs(c%slip)))
            do j = 1, c%n
               k = first + j
               t = -c%shear(j)
               rest = memory%rest(k)
               slides = abs(t) > 0.0_wp .and. is_full(t, tau(k))
               if (line%law(k)%kind == FRICTION_NONE .or. c%weighted_pressure(j) <= 0.0_wp) then
                  rest = c%slip(j)
               else if (slides) then
                  rest = c%slip(j) - stick_compliance(line%law(k), tau(k))*t
                  ! it slid on from the force that it had, or began to slide in this increment
                  mean = t
                  if (memory%slides(k) .and. t*memory%shear(k) > 0.0_wp) mean = 0.5_wp*(t + memory%shear(k))
                  memory%dissipation(i) = memory%dissipation(i) + c%weight(j)*mean*(rest - memory%rest(k))
               end if
               memory%slides(k) = slides
               memory%rest(k) = rest
               memory%slip(k) = c%slip(j)
               memory%shear(k) = t
            end do
            first = first + c%n
         end associate
      end do
   end subroutine remember_slips

   !> The contact line learns the rest slips of its laws, and how far its pairs have moved.
   pure subroutine put_rest(memory, line)
      type(slip_memory_t), intent(in) :: memory   !< of begin_memory
      type(contact_line_t), intent(inout) :: line !< its rest slips and ways are set
      integer(ip) :: j

      if (.not. allocated(line%rest)) allocate (line%rest(line%n), line%shear_before(line%n), line%moved(line%n))
      line%rest = 0.0_wp
      line%shear_before = 0.0_wp
      line%moved = 0.0_wp
      do j = 1, size(memory%rest, kind=ip)
         line%moved(j) = memory%moved(line%pair(j))
         if (.not. memory%is_incremental(j)) cycle
         line%rest(j) = memory%rest(j)
         line%shear_before(j) = memory%shear(j)
      end do
   end subroutine put_rest

end module atrito_slip_memory
