!> What it means that no solution was found: there is none, and why; or there may be one, and the last iterate is what there is.
module atrito_verdict
   use atrito_bodies, only: mode_at
   use atrito_body_cache, only: body_cache_t
   use atrito_certificate, only: certificate_t, BALANCE_IMPOSSIBLE, BALANCE_POSSIBLE
   use atrito_clp, only: clp_trouble
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_contact_problem, only: set_known_points
   use atrito_pairing, only: add_end_points
   use atrito_free_motion, only: free_motion_text
   use atrito_dense, only: null_space
   use atrito_kinds, only: ip, wp
   use atrito_load_digits, only: is_loaded, is_within_digits, take_out, work_along
   use atrito_mechanism, only: mechanism_t, describe_motion
   use atrito_model, only: model_t
   use atrito_motion_rows, only: motion_rows_t, build_motion_rows, part_from_held
   use atrito_own_axes, only: prove_in_own_axes
   use atrito_results, only: pair_scene_t
   use atrito_scene_data, only: prepare, scene_data_t, solve_options_t
   use atrito_sparse_rows, only: add_transposed, transposed_sizes
   use atrito_status, only: is_ok, status_t, set_status, STATUS_DECK, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: judge_balance

   real(wp), parameter :: NO_LOAD = 1.0e-13_wp    !< of what was added up: round-off

contains

   !> Judges a contact line without solution. status: STATUS_SINGULAR with the whole text where no forces that the contact can take
   !> balance the loads, STATUS_DECK where joints contradict each other. Else it is OK, and the verdict says more.
   subroutine judge_balance(data, f_end, pairs, verdict, again, status)
      type(scene_data_t), intent(inout) :: data      !< of the increment; its loads change where `again` says so
      real(wp), intent(in) :: f_end(:, :)            !< (2, n_nodes) applied forces at the end of the step [F]
      type(pair_scene_t), intent(in) :: pairs(:)     !< names of slaves and masters
      character(len=:), allocatable, intent(inout) :: verdict !< why there is no solution
      logical, intent(inout) :: again                !< in: whether loads may change; out: they have, a proof hung on their digits
      type(status_t), intent(out) :: status          !< OK, or STATUS_SINGULAR or STATUS_DECK with the whole text
      type(motion_rows_t) :: motions, motions_at_end
      type(certificate_t) :: certificate
      type(mechanism_t) :: mechanism
      character(len=:), allocatable :: ends
      logical :: is_doubtful

      call find_conflict(data, status)
      if (.not. is_ok(status)) return
      call build_motion_rows(data%fem, data%rows, data%line, data%f, motions)
      call part_from_held(data%fem, data%line, motions)
      call prove_in_own_axes(data%fem, data%rows, data%line, data%f, certificate)
      is_doubtful = .false.
      if (certificate%verdict == BALANCE_IMPOSSIBLE) then
         is_doubtful = is_within_digits(data, motions, certificate%motion, certificate%q)
      end if
      if (again) call take_doubtful_out()
      if (again) return
      if (certificate%verdict == BALANCE_IMPOSSIBLE) call look_at_ends(data, ends)
      if (certificate%verdict == BALANCE_IMPOSSIBLE .and. .not. (is_doubtful .or. allocated(ends))) then
         call build_motion_rows(data%fem, data%rows, data%line, f_end, motions_at_end)
         call describe_motion(data%fem, data%rows, data%line, motions, certificate, mechanism, motions_at_end%work)
         call set_status(status, STATUS_SINGULAR, free_motion_text(data%fem, data%held, data%rows, data%line, pairs, mechanism))
         return
      end if
      if (.not. allocated(verdict)) verdict = 'no solution was found'
      if (allocated(ends)) then
         verdict = verdict//'; '//ends
      else
         if (certificate%verdict == BALANCE_POSSIBLE) then
            verdict = verdict//'; there are forces that the contact can take and that balance the loads, but no solution with '// &
                      'them was found'
         else if (certificate%solver_missing) then
            verdict = verdict//'; whether the contact can take the loads at all cannot be told without Clp: '//clp_trouble()
         else
            verdict = verdict//'; whether the contact can take the loads at all is not decided, it is too near the limit'
         end if
      end if

   contains

      !> What the digits of the deck alone make of the loads: their work on the motion of a proof, or what forces leave that balance
      !> the loads to IN_BALANCE, which no form of the contact system can solve for where nothing holds it.
      subroutine take_doubtful_out()
         type(motion_rows_t) :: rest

         again = is_doubtful
         if (is_doubtful) then
            associate (v => certificate%motion)
               call take_out(data, work_along(motions, reshape(v/norm2(v), [size(v), 1])))
            end associate
         else if (certificate%verdict == BALANCE_POSSIBLE) then
            rest = motions
            call add_transposed(motions, -1.0_wp, certificate%q, rest%work)
            where (.not. is_loaded(motions)) rest%work = 0.0_wp
            again = any(abs(rest%work) > NO_LOAD*(motions%work_size + transposed_sizes(motions, certificate%q)))
            if (again) again = is_within_digits(data, rest, rest%work/maxval(abs(rest%work)), certificate%q)
            if (again) call take_out(data, rest%work)
         end if
      end subroutine take_doubtful_out

   end subroutine judge_balance

   !> Whether ties, equations, rigid bodies and inclined supports ask for what no displacements have: of their rows M' u = b over
   !> free dofs and motions some combination M z is 0 and z'b is not. status: STATUS_DECK with their nodes.
   subroutine find_conflict(data, status)
      type(scene_data_t), intent(in) :: data
      type(status_t), intent(out) :: status
      integer(ip), parameter :: MOST_ROWS = 300, MOST_NAMES = 5 ! that are looked at; told
      real(wp), parameter :: NONE = 1.0e-9_wp, SHARE = 0.1_wp ! of the terms of a row; of the largest part in a combination
      integer(ip), allocatable :: used(:), place(:)
      character(len=:), allocatable :: names
      real(wp), allocatable :: m(:, :), b(:), terms(:), z(:, :)
      integer(ip) :: i, info, j, k

      used = [integer(ip) ::]
      do j = data%rows%n - data%rows%n_bilateral + 1, data%rows%n
         if (data%line%delta(j) > 0.0_wp .or. data%line%normal(j) == 0) cycle
         if (all(data%fem%bodies%of_node(data%rows%node(data%rows%first(j):data%rows%first(j + 1) - 1)) > 0)) used = [used, j]
      end do
      if (size(used) < 2 .or. size(used) > MOST_ROWS) return
      call fill_rows(data, used, m, b, terms)
      call null_space(m, NONE, z, info)
      if (info /= 0) return
      do i = 1, size(z, 2, kind=ip)
         if (abs(dot_product(z(:, i), b)) <= NONE*dot_product(abs(z(:, i)), terms)) cycle
         place = pack(data%rows%first(used), abs(z(:, i)) > SHARE*maxval(abs(z(:, i))))
         associate (ids => data%fem%mesh%node_id(data%rows%node(place)))
            names = to_text(ids(1))
            do k = 2, min(size(ids, kind=ip), MOST_NAMES)
               if (all(ids(:k - 1) /= ids(k))) names = names//', '//to_text(ids(k))
            end do
         end associate
         call set_status(status, STATUS_DECK, 'ties, equations, rigid bodies and inclined supports contradict each other, '// &
                         'or what is prescribed, by some '//to_text(maxval(abs(b)), 2)//' [L], at node '//names)
         return
      end do
   end subroutine find_conflict

   !> A column a row: its coefficients of free dofs, and of the motions of rigid bodies; what prescribed displacements are off by,
   !> and the sum of their terms [L].
   subroutine fill_rows(data, used, m, b, terms)
      type(scene_data_t), intent(in) :: data
      integer(ip), intent(in) :: used(:)             !< places of the rows
      real(wp), allocatable, intent(out) :: m(:, :), b(:), terms(:)
      integer(ip) :: column(2, data%fem%mesh%n_nodes), motion(data%fem%bodies%n), dof, i, j, k, n

      associate (rows => data%rows, bodies => data%fem%bodies, x => data%fem%mesh%x)
         motion = 0
         column = 0
         n = 0
         do i = 1, bodies%n
            motion(i) = n                            ! before the first of a rigid body
            if (bodies%list(i)%is_rigid) n = n + size(bodies%list(i)%modes, 2, kind=ip)
         end do
         do i = 1, size(used, kind=ip)
            do k = rows%first(used(i)), rows%first(used(i) + 1) - 1
               if (bodies%list(bodies%of_node(rows%node(k)))%is_rigid) cycle
               do dof = 1, 2
                  if (data%held(dof, rows%node(k)) .or. column(dof, rows%node(k)) > 0) cycle
                  n = n + 1
                  column(dof, rows%node(k)) = n
               end do
            end do
         end do
         allocate (m(n, size(used)), b(size(used)), terms(size(used)), source=0.0_wp)
         do i = 1, size(used, kind=ip)
            b(i) = data%line%known_overlap(used(i))
            terms(i) = abs(rows%gap(used(i)))
            do k = rows%first(used(i)), rows%first(used(i) + 1) - 1
               associate (v => rows%vector(:, k - rows%before_vectors), node => rows%node(k), &
                          body => bodies%list(bodies%of_node(rows%node(k))), before => motion(bodies%of_node(rows%node(k))))
                  terms(i) = terms(i) + sum(abs(v*data%value(:, node)))
                  do dof = 1, 2
                     if (body%is_rigid) then
                        do j = 1, size(body%modes, 2, kind=ip)
                           m(before + j, i) = m(before + j, i) + v(dof)*mode_at(body, body%modes(:, j), x(:, node), dof)
                        end do
                     else if (column(dof, node) > 0) then
                        m(column(dof, node), i) = m(column(dof, node), i) + v(dof)
                     end if
                  end do
               end associate
            end do
            associate (size_of_row => norm2(m(:, i)))
               if (.not. size_of_row > 0.0_wp) cycle ! all are prescribed
               m(:, i) = m(:, i)/size_of_row
               b(i) = b(i)/size_of_row
               terms(i) = terms(i)/size_of_row
            end associate
         end do
      end associate
   end subroutine fill_rows

   !> Whether loads that the points cannot take may be taken by forces at ends of masters, where the slave's nodes beside them leave
   !> no point (atrito_end_points): a text, not allocated where they are not. The motion proves nothing of the bodies then.
   subroutine look_at_ends(data, text)
      type(scene_data_t), intent(in) :: data
      character(len=:), allocatable, intent(out) :: text
      type(model_t), target :: model
      type(scene_data_t) :: longer
      type(body_cache_t) :: store
      type(solve_options_t) :: asked
      type(certificate_t) :: certificate
      type(status_t) :: status
      real(wp), allocatable :: places(:, :)

      if (all(data%model%points%n == 0)) return
      model = data%model
      call add_end_points(model, places)
      if (size(places) == 0) return
      asked%contact_form = CONTACT_SPARSE              ! no body is numbered for a profile
      call prepare(model, store, asked, longer, status, data%step)
      if (.not. is_ok(status)) return
      longer%f = data%f
      call set_known_points(longer%rows, data%value, longer%line)
      call prove_in_own_axes(longer%fem, longer%rows, longer%line, longer%f, certificate)
      if (certificate%verdict == BALANCE_IMPOSSIBLE) return
      text = 'no forces at the points of this mesh balance the loads, but forces at the ends of masters between nodes of the '// &
             'slave may, as at ('//to_text(places(1, 1), 6)//', '//to_text(places(2, 1), 6)//'): it takes a node of the slave '// &
             'there, or the other surface as the slave'
   end subroutine look_at_ends

end module atrito_verdict
