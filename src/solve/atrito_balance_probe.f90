!> Whether a scene can stand at all, without solving it: the certificate of its loads, and the motion that it proves.
module atrito_balance_probe
   use atrito_bodies, only: mode_at
   use atrito_body_cache, only: body_cache_t
   use atrito_certificate, only: certificate_t, prove_balance, BALANCE_IMPOSSIBLE, BALANCE_POSSIBLE
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_free_motion, only: free_motion_text
   use atrito_kinds, only: ip, wp
   use atrito_mechanism, only: mechanism_t, describe_motion
   use atrito_model, only: model_t
   use atrito_motion_rows, only: motion_rows_t
   use atrito_motion_system, only: build_motion_rows
   use atrito_results, only: pair_scene_t
   use atrito_scene_data, only: scene_data_t, asked_t, prepare
   use atrito_stability_result, only: collapse_t
   use atrito_stability_search, only: STANDS, FALLS, UNDECIDED
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: probe_balance

contains

   !> Asks the certificate. status: STATUS_DECK, which is told by a message, where the averages take more memory than there is.
   subroutine probe_balance(model, answer, excess, status, collapse)
      type(model_t), intent(in), target :: model
      integer, intent(out) :: answer                !< STANDS: there are forces that balance the loads; FALLS or UNDECIDED
      real(wp), intent(out) :: excess               !< FALLS: work that the contact cannot take, over the sum of the loads
      type(status_t), intent(out) :: status
      type(collapse_t), intent(out), optional :: collapse !< FALLS: the motion
      type(scene_data_t) :: data
      type(body_cache_t) :: store
      type(asked_t) :: asked
      type(motion_rows_t) :: motions
      type(certificate_t) :: certificate

      answer = UNDECIDED
      excess = 0.0_wp
      asked%contact_form = CONTACT_SPARSE           ! no body is numbered for a profile
      call prepare(model, store, asked, data, status)
      if (.not. is_ok(status)) return
      call build_motion_rows(data%fem, data%rows, data%line, data%f, motions)
      call prove_balance(motions, data%line, certificate)
      if (certificate%verdict == BALANCE_POSSIBLE) answer = STANDS
      if (certificate%verdict /= BALANCE_IMPOSSIBLE) return
      answer = FALLS
      ! not over the work of the loads, all of which is too much where they fall off a slope
      excess = certificate%excess/sum(motions%work_size, mask=abs(certificate%motion) > 0.0_wp)
      if (present(collapse)) call describe_collapse(data, motions, certificate, collapse)
   end subroutine probe_balance

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
      call move_nodes(data, mechanism, collapse)
      largest = max(maxval(norm2(collapse%u, dim=1)), tiny(largest))
      collapse%u = collapse%u(:, :data%model%mesh%n_nodes)/largest
      collapse%motion = collapse%motion/largest
   end subroutine describe_collapse

   !> The bodies' motions, and what they do to the nodes.
   subroutine move_nodes(data, mechanism, collapse)
      type(scene_data_t), intent(in) :: data
      type(mechanism_t), intent(in) :: mechanism
      type(collapse_t), intent(inout) :: collapse
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

end module atrito_balance_probe
