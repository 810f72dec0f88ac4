!> Whether a scene can stand at all, without solving it: the certificate of its loads at all times of the history that matter, and
!> the motion that it proves.
module atrito_balance_probe
   use atrito_bodies, only: mode_at
   use atrito_body_cache, only: body_cache_t
   use atrito_certificate, only: certificate_t, find_largest_share, BALANCE_IMPOSSIBLE, BALANCE_POSSIBLE
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_contact_rows, only: bodies_of_row
   use atrito_free_motion, only: free_motion_text
   use atrito_kinds, only: ip, wp
   use atrito_mechanism, only: mechanism_t, describe_motion
   use atrito_model, only: model_t
   use atrito_motion_rows, only: motion_rows_t, build_motion_rows
   use atrito_own_axes, only: prove_in_own_axes
   use atrito_results, only: pair_scene_t
   use atrito_rigid_bodies, only: hold_the_same
   use atrito_scene_builder, only: list_held
   use atrito_scene_data, only: scene_data_t, solve_options_t, prepare, set_time
   use atrito_stability_result, only: collapse_t
   use atrito_stability_search, only: STANDS, FALLS, UNDECIDED
   use atrito_status, only: status_t, is_ok
   use atrito_step_loads, only: moment_t, load_breakpoints
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: probe_balance, predict_share, describe_gaps

   real(wp), parameter :: FAR_APART = 1.0e-3_wp          !< a gap, over the size of the smaller body, that strains do not close

contains

   !> Asks the certificate at all times of the history that matter. status: STATUS_DECK, which is told by a message, where the
   !> averages take more memory than there is.
   !>
   !>     1. the scene of a step without factors: points, rows, loads
   !>     2. at each time at which loads may be hardest (load_breakpoints) the certificate (ask_moment)
   !>     3. FALLS at one of them is the answer, with the largest excess; without any, UNDECIDED at one of them is; else STANDS
   !>
   !> The answer is about forces alone: STANDS says that some balance the loads. Whether a scene comes to have them takes a run.
   subroutine probe_balance(model, answer, excess, status, collapse)
      type(model_t), intent(in), target :: model    !< as read, refined if that was asked
      integer, intent(out) :: answer                !< STANDS: forces balance the loads at all times; FALLS at some; or UNDECIDED
      real(wp), intent(out) :: excess               !< FALLS: the largest work that contact cannot take, over the sum of the loads
      type(status_t), intent(out) :: status         !< STATUS_DECK where averages need too much memory
      type(collapse_t), intent(out), optional :: collapse !< FALLS: the motion, at the first such time
      type(scene_data_t) :: data
      real(wp), allocatable :: times(:)
      real(wp) :: began
      integer(ip) :: k
      integer :: i
      character(len=:), allocatable :: text

      answer = STANDS
      excess = 0.0_wp
      began = 0.0_wp
      do k = 1, size(model%steps, kind=ip)
         times = load_breakpoints(model, k)
         call begin_step(status)
         if (.not. is_ok(status)) return
         do i = 1, size(times)
            if (size(model%steps) > 1 .or. size(times) > 1) call set_time(data, moment_t(times(i), began + times(i)))
            if (present(collapse)) then
               ! The time, where there is more than one to be asked about.
               text = ''
               if (.not. (size(model%steps) == 1 .and. model%steps(1)%increments%initial >= model%steps(1)%increments%period)) then
                  text = 'in step '//to_text(k)//', at time '//to_text(began + times(i), 6)//': '
               end if
               call ask_moment(text, collapse)
            else
               call ask_moment('')
            end if
         end do
         began = began + model%steps(k)%increments%period
      end do

   contains

      !> The scene of a step; with the same dofs held it is the one that is there. Where supports go, their forces are not known
      !> here: then only the end is asked about, where they are gone.
      subroutine begin_step(status)
         type(status_t), intent(out) :: status
         logical, allocatable :: held(:, :)
         real(wp), allocatable :: value(:, :)
         logical :: same_motions
         type(body_cache_t) :: store
         type(solve_options_t) :: asked

         if (k > 1) then
            call list_held(model, model%steps(k), held, value)
            same_motions = hold_the_same(model, data%rigid_prescribed, model%steps(k)%rigid_prescribed)
            if (any(data%held .and. .not. held) .or. .not. same_motions) times = times(size(times):)
            if (all(held .eqv. data%held) .and. same_motions) then
               data%step => model%steps(k)
               return
            end if
         end if
         asked%contact_form = CONTACT_SPARSE           ! no body is numbered for a profile
         call prepare(model, store, asked, data, status, model%steps(k))
      end subroutine begin_step

      !> Asks the certificate of what acts now, and keeps the worst answer.
      subroutine ask_moment(when, collapse)
         character(len=*), intent(in) :: when          !< in words, before those of the motion
         type(collapse_t), intent(inout), optional :: collapse
         type(motion_rows_t) :: motions
         type(certificate_t) :: certificate

         call build_motion_rows(data%fem, data%rows, data%line, data%f, motions)
         call prove_in_own_axes(data%fem, data%rows, data%line, data%f, certificate)
         if (certificate%verdict == BALANCE_POSSIBLE) return
         if (certificate%verdict /= BALANCE_IMPOSSIBLE) then
            if (answer == STANDS) answer = UNDECIDED
            return
         end if
         ! not over the work of the loads, all of which is too much where they fall off a slope
         excess = max(excess, certificate%excess/sum(motions%work_size, mask=abs(certificate%motion) > 0.0_wp))
         if (present(collapse) .and. answer /= FALLS) then
            call describe_collapse(data, motions, certificate, collapse)
            collapse%text = when//collapse%text
         end if
         answer = FALLS
      end subroutine ask_moment

   end subroutine probe_balance

   !> Where between two models their balance ends, as a share of the way: known where they differ in the sizes of their loads alone
   !> and have a single increment.
   subroutine predict_share(stands, falls, share, found)
      type(model_t), intent(in), target :: stands, falls !< one whose loads can be balanced, one whose cannot
      real(wp), intent(out) :: share                     !< 0 to 1, of the way from the first to the second
      logical, intent(out) :: found                      !< the question can be asked, and was answered
      type(scene_data_t) :: data(2)
      type(motion_rows_t) :: motions(2)
      type(solve_options_t) :: asked
      type(body_cache_t) :: store
      type(status_t) :: status
      integer :: i

      share = 0.0_wp
      found = size(stands%steps) == 1
      if (found) found = size(load_breakpoints(stands, 1_ip)) == 1
      if (.not. found) return
      asked%contact_form = CONTACT_SPARSE
      call prepare(stands, store, asked, data(1), status)
      if (is_ok(status)) call prepare(falls, store, asked, data(2), status)
      found = is_ok(status)
      if (.not. found) return
      do i = 1, 2
         call build_motion_rows(data(i)%fem, data(i)%rows, data(i)%line, data(i)%f, motions(i))
      end do
      found = motions(1)%n == motions(2)%n .and. motions(1)%n_columns == motions(2)%n_columns
      if (found) found = size(motions(1)%value) == size(motions(2)%value)
      if (found) found = all(motions(1)%value == motions(2)%value) .and. all(data(1)%line%law%nu == data(2)%line%law%nu)
      if (found) call find_largest_share(motions(1), data(1)%line, motions(2), share, found)
   end subroutine predict_share

   !> Whether loads of a single increment that can be balanced can be so without the points that gaps keep apart: the balance knows
   !> no gaps. Not allocated: they can.
   subroutine describe_gaps(model, text)
      type(model_t), intent(in), target :: model         !< as read, refined if that was asked
      character(len=:), allocatable, intent(out) :: text !< what to tell of the gaps, without a stop
      type(scene_data_t) :: data
      type(certificate_t) :: certificate
      type(solve_options_t) :: asked
      type(body_cache_t) :: store
      type(status_t) :: status
      logical, allocatable :: touches(:)
      integer(ip) :: j, k

      if (size(model%steps) > 1) return
      asked%contact_form = CONTACT_SPARSE
      call prepare(model, store, asked, data, status)
      if (.not. is_ok(status)) return
      allocate (touches(data%line%n), source=.true.)
      do j = 1, data%rows%n - data%rows%n_bilateral
         associate (bodies => bodies_of_row(data%rows, j, data%fem%bodies%of_node))
            do k = 1, size(bodies, kind=ip)
               if (bodies(k) > 0) touches(j) = touches(j) .and. data%rows%gap(j) <= FAR_APART*data%fem%bodies%list(bodies(k))%size
            end do
         end associate
      end do
      if (all(touches)) return
      call prove_in_own_axes(data%fem, data%rows, data%line, data%f, certificate, touches)
      if (certificate%verdict /= BALANCE_POSSIBLE) then
         text = 'the balance counts points as touching that are up to '//to_text(maxval(data%rows%gap, mask=.not. touches), 3) &
                //' apart without loads; without them nothing balances the loads, so its limit says little of what stands'
      end if
   end subroutine describe_gaps

   subroutine describe_collapse(data, motions, certificate, collapse)
      type(scene_data_t), intent(in) :: data
      type(motion_rows_t), intent(in) :: motions
      type(certificate_t), intent(in) :: certificate
      type(collapse_t), intent(out) :: collapse
      type(mechanism_t) :: mechanism
      type(pair_scene_t) :: pairs(size(data%model%pairs))
      real(wp) :: largest
      integer(ip) :: i

      do i = 1, size(pairs, kind=ip)
         pairs(i)%slave = data%model%surfaces(data%model%pairs(i)%slave)%name
         pairs(i)%master = data%model%surfaces(data%model%pairs(i)%master)%name
      end do
      call describe_motion(data%fem, data%rows, data%line, motions, certificate, mechanism)
      collapse%text = free_motion_text(data%fem, data%held, data%rows, data%line, pairs, mechanism)
      call move_nodes()
      largest = max(maxval(norm2(collapse%u, dim=1)), tiny(largest))
      collapse%u = collapse%u(:, :data%model%mesh%n_nodes)/largest
      collapse%motion = collapse%motion/largest

   contains

      !> The bodies' motions, and what they do to the nodes.
      subroutine move_nodes()
         integer(ip) :: i, k, dof, n

         n = size(mechanism%bodies, kind=ip)
         collapse%bodies = mechanism%bodies
         collapse%motion = mechanism%mode
         allocate (collapse%centre(2, n), collapse%names(n))
         allocate (collapse%u(2, data%fem%mesh%n_nodes), source=0.0_wp)
         do i = 1, n
            associate (body => data%fem%bodies%list(mechanism%bodies(i)))
               collapse%names(i)%s = body%name
               collapse%centre(:, i) = body%centre
               collapse%motion(3, i) = mechanism%mode(3, i)/body%size
               do k = 1, size(body%nodes, kind=ip)
                  do dof = 1, 2
                     collapse%u(dof, body%nodes(k)) = mode_at(body, mechanism%mode(:, i), data%fem%mesh%x(:, body%nodes(k)), dof)
                  end do
               end do
            end associate
         end do
      end subroutine move_nodes

   end subroutine describe_collapse

end module atrito_balance_probe
