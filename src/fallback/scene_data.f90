!> The scene with everything that the phases of a solution share.
module atrito_scene_data
   use atrito_assembled_scene, only: assembled_scene_t, assemble_scene
   use atrito_assembly, only: fem_t
   use atrito_base_loads, only: build_bases
   use atrito_bilateral_rows, only: bilateral_rows_t, ROW_KIND_NAME, ROW_SUPPORT
   use atrito_body_cache, only: body_cache_t, take_numbering
   use atrito_contact_form, only: choose_contact_form, CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_problem, only: average_entries, build_line, set_known_points
   use atrito_contact_rows, only: contact_rows_t, allow_overlap, build_rows
   use atrito_contact_scales, only: had_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: METHOD_ANDERSON
   use atrito_held_points, only: straighten_held_points
   use atrito_kinds, only: ip, lp, wp
   use atrito_line_certificate, only: line_certificate_t
   use atrito_linear_quantity, only: linear_quantity_t
   use atrito_memory, only: available_memory
   use atrito_model, only: model_t, nodal_values_t, step_t
   use atrito_nodal_loads, only: nodal_loads
   use atrito_problem, only: problem_t, free_load
   use atrito_results, only: frame_store_t, results_t, scene_t
   use atrito_rigid_bodies, only: add_rigid_loads, has_moving_surfaces, set_rigid_motions
   use atrito_scene_builder, only: build_scene, build_bodies, list_held
   use atrito_scene_system, only: scene_system_t, set_scene_gaps, set_scene_load
   use atrito_scene_memory, only: check_average_memory, most_average_entries
   use atrito_sliding_bodies, only: let_slide, balance_loads, turn_supports
   use atrito_solver_choice, only: SOLVER_SPARSE
   use atrito_status, only: status_t, is_ok, STATUS_DECK, set_status
   use atrito_step_loads, only: base_factors, moment_t, act_at, is_end, share_at
   use atrito_strings, only: to_text
   use atrito_thermal_loads, only: add_thermal_loads
   use atrito_turning_rows, only: balance_rows
   implicit none (type, external)
   private
   public :: PROOF_AUTO, PROOF_ON, PROOF_OFF
   public :: scene_data_t, solve_options_t, distribution_t, viewer_t, prepare, set_time, assemble, drop_assembled, free_load, &
             reload, check_known_points, forces_at_end, put_back_loads

   !> A bound of the error: where it takes less than half of the time, always, never.
   integer, parameter :: PROOF_AUTO = 1, PROOF_ON = 2, PROOF_OFF = 3

   !> How a scene in the sparse form is distributed over several processes. What extends this type assembles the matrix in parts,
   !> one a process, and has each process recover the stresses of its elements; all else is done in this process, which is all there
   !> is where no such object is given (solve_options_t).
   type, abstract :: distribution_t
      character(len=:), allocatable :: reason               !< why a scene that it pays off for takes the sparse form
   contains
      procedure(ask_whether), deferred :: pays_off
      procedure(ask_processes), deferred, nopass :: check_memory
      procedure(assemble_parts), deferred :: assemble
      procedure(begin_recovery), deferred :: begin_fields
      procedure(end_recovery), deferred :: end_fields
   end type distribution_t

   !> Who looks at how small scenes are solved (--show): an increment keeps what it has made until it was viewed.
   type, abstract :: viewer_t
   contains
      procedure(check_scene), deferred :: check
      procedure(view_increment), deferred :: view
   end type viewer_t

   !> The problem of an increment, and what it was made from.
   type, extends(problem_t) :: scene_data_t
      type(model_t), pointer :: model => null()             !< as refined, which all of it was made from
      type(step_t), pointer :: step => null()               !< the one that is being solved
      type(nodal_values_t) :: rigid_prescribed              !< of reference nodes, at the same time as value
      integer :: contact_form = CONTACT_DENSE               !< CONTACT_DENSE or CONTACT_SPARSE
      character(len=:), allocatable :: reason               !< why this form
      class(distribution_t), allocatable :: distribution    !< not allocated: there is one process
      logical :: is_distributed = .false.                   !< this scene is
      class(scene_system_t), allocatable :: assembled       !< the sparse form, in one matrix or in parts
      logical :: is_assembled = .false.                     !< its matrix is there, with the loads of now
      logical :: wants_element_errors = .false.             !< of what is printed
      integer :: proof = PROOF_OFF                          !< whether there is a bound of the error of what is printed
      type(linear_quantity_t), allocatable :: quantities(:) !< that have bounds; not allocated: none
      real(wp), allocatable :: exchanged(:, :)              !< (2, n_nodes) for it, while the bodies are factored [L]
      real(wp), allocatable :: exchanged_by_points(:, :)    !< the same for another kind of tractions of contact [L]
      integer(ip) :: starts = 0                             !< of a search for other solutions
      logical :: is_printed = .true.                        !< what is solved for is printed: it is worth stresses and estimates
      logical :: is_last = .true.                           !< nothing comes after it
      logical :: is_brief = .false.                         !< that no solution was found is an answer: no costly rung is tried
      logical :: lets_out = .false.                         !< what a thin wedge lets out goes, though friction might hold it
      integer(ip) :: most_factorisations = huge(1_ip)       !< of the sparse form in an increment, before it is given up
      ! Of a history:
      logical :: may_cut = .false.                          !< without a solution a shorter increment is tried
      logical :: asks_for_bases = .false.                   !< the step begins, or the increment before has changed its loads
      real(wp), allocatable :: released(:, :)               !< (2, n_nodes) of supports that the step does not have; they fade [F]
      real(wp), allocatable :: given(:, :)                  !< f before a part was taken out of it [F]; not allocated: none was
      type(had_t) :: had                                    !< the largest so far
      type(line_certificate_t), allocatable :: certificate  !< of the flexibility that is there
      real(wp), pointer :: before(:, :) => null()           !< (2, n_nodes) displacements of the increment before [L]
      class(viewer_t), pointer :: viewer => null()          !< not associated: nobody looks
   end type scene_data_t

   !> What the user asks for.
   type :: solve_options_t
      integer :: solver_kind = 0                           !< STORAGE_* or 0
      integer :: contact_form = CONTACT_AUTO               !< CONTACT_*
      logical :: element_errors = .false.                   !< the estimated error is kept element by element
      integer(ip) :: starts = 0                             !< of a search for other solutions; 0: as the deck asks
      integer :: proof = PROOF_OFF                          !< whether a bound of the error is wanted
      type(linear_quantity_t), allocatable :: quantities(:) !< that have bounds; not allocated: none
      logical :: is_brief = .false.                         !< no attempt is made that costs more than the first one
      integer(ip) :: most_factorisations = huge(1_ip)       !< of the sparse form in an increment, before it is given up
      integer(lp) :: memory = huge(1_lp)                    !< bytes, of each process; what the machine has counts where it is less
      class(distribution_t), allocatable :: distribution    !< of a scene that it pays off for; not allocated: none
      class(viewer_t), pointer :: viewer => null()          !< not associated: nobody looks
      class(frame_store_t), pointer :: frames => null()     !< takes all printed increments but the last; not associated: none does
   end type solve_options_t

   abstract interface

      !> Whether a scene is distributed.
      logical function ask_whether(self, n_displacements, n_forces)
         import :: distribution_t, ip
         class(distribution_t), intent(in) :: self
         integer(ip), intent(in) :: n_displacements, n_forces  !< forces: of contact
      end function ask_whether

      !> Asks all processes for the memory that the scene will take of them: before it is assembled at the least, behind that in
      !> all. status: STATUS_DECK, which is told by a message, when one has too little.
      subroutine ask_processes(data, limit, scene, status)
         import :: scene_data_t, scene_t, status_t, lp
         class(scene_data_t), intent(in) :: data
         integer(lp), intent(in) :: limit                   !< bytes of each process; what there is counts where it is less
         type(scene_t), intent(inout) :: scene              !< on return with the forecast of this process
         type(status_t), intent(inout) :: status
      end subroutine ask_processes

      !> Cuts the scene, gives each process its part and has it assembled. status: STATUS_INTERNAL when the memory does not suffice.
      subroutine assemble_parts(self, fem, rows, line, value, scene, status)
         import :: distribution_t, fem_t, contact_rows_t, contact_line_t, scene_system_t, status_t, wp
         class(distribution_t), intent(inout) :: self
         type(fem_t), intent(in) :: fem
         type(contact_rows_t), intent(in) :: rows
         type(contact_line_t), intent(in) :: line
         real(wp), intent(in) :: value(:, :)                !< (2, n_nodes) prescribed displacements [L]
         class(scene_system_t), allocatable, intent(out) :: scene
         type(status_t), intent(out) :: status
      end subroutine assemble_parts

      !> Has the other processes begin with the stresses of their elements and the estimate of their error, where they have not.
      subroutine begin_recovery(self, fem, u, by_element)
         import :: distribution_t, fem_t, wp
         class(distribution_t), intent(inout) :: self
         type(fem_t), intent(in) :: fem
         real(wp), intent(in) :: u(:, :)                    !< (2, n_nodes) [L]
         logical, intent(in) :: by_element                  !< the error of each is wanted
      end subroutine begin_recovery

      !> The same as estimate_error (atrito_recovery), with what the other processes found, which have begun.
      subroutine end_recovery(self, fem, results, strain_bound)
         import :: distribution_t, fem_t, results_t, wp
         class(distribution_t), intent(inout) :: self
         type(fem_t), intent(in) :: fem
         type(results_t), intent(inout) :: results          !< with the displacements with which they have begun
         real(wp), intent(out) :: strain_bound              !< no strain is larger than this
      end subroutine end_recovery

      !> Before anything is solved. status: STATUS_USAGE where what is to be seen cannot be.
      subroutine check_scene(self, data, status)
         import :: viewer_t, scene_data_t, status_t
         class(viewer_t), intent(inout) :: self
         class(scene_data_t), intent(in) :: data
         type(status_t), intent(inout) :: status
      end subroutine check_scene

      !> An increment was solved, or tried; of one without a solution there may be nothing but the scene.
      subroutine view_increment(self, data, results, solution)
         import :: viewer_t, scene_data_t, results_t, contact_solution_t
         class(viewer_t), intent(inout) :: self
         class(scene_data_t), intent(in) :: data
         type(results_t), intent(in) :: results
         type(contact_solution_t), intent(in) :: solution
      end subroutine view_increment

   end interface

contains

   !> From the model to bodies, points, laws and loads, and the form of the contact system. status: STATUS_DECK, which is told by a
   !> message, when the averages need more memory than there is.
   !>
   !> The form is chosen first, since it decides how equations are numbered: body by body for a profile, or all for one sparse
   !> matrix. Numberings of an earlier run serve again where the same dofs are held. Points are put right while they can be: where
   !> rounding of coordinates alone keeps a body from sliding along its supports, and where supports hold what a row would ask for.
   !> Rows and the contact line follow, with the values and loads at the end of the step; set_time changes these for an increment,
   !> and nothing else.
   subroutine prepare(model, store, asked, data, status, step)
      type(model_t), intent(in), target :: model !< as refined; kept by pointer
      type(body_cache_t), intent(in) :: store    !< whose numbering serves again where the same dofs are held
      type(solve_options_t), intent(in) :: asked !< form, solver, memory, proof
      type(scene_data_t), intent(out) :: data    !< with the loads at the end of the step
      type(status_t), intent(out) :: status      !< STATUS_DECK: the averages need more memory than there is
      type(step_t), intent(in), target, optional :: step    !< left out: the first of the model
      type(bilateral_rows_t) :: bilateral                   ! of the model, but for supports that let a body turn
      integer(ip), allocatable :: holder(:)                 ! of each node: a support along a direction of its own
      logical :: known

      data%model => model
      data%bilateral => model%bilateral
      data%step => model%steps(1)
      if (present(step)) data%step => step
      call build_scene(model, data%step, data%fem, data%held, data%value, data%points)
      data%rigid_prescribed = data%step%rigid_prescribed
      if (allocated(asked%distribution)) allocate (data%distribution, source=asked%distribution)
      call choose_form(asked, data)
      data%solver_kind = asked%solver_kind
      data%is_brief = asked%is_brief
      data%most_factorisations = asked%most_factorisations
      data%starts = merge(asked%starts, data%step%controls%starts, asked%starts > 0)
      data%wants_element_errors = asked%element_errors
      data%proof = asked%proof
      if (allocated(asked%quantities)) data%quantities = asked%quantities
      data%viewer => asked%viewer
      ! all bodies in one matrix: none is numbered for a profile of its own
      if (data%contact_form == CONTACT_SPARSE) data%solver_kind = SOLVER_SPARSE
      call take_numbering(store, data%held, data%points, data%solver_kind, data%fem, known, model%bilateral)
      if (.not. known) call build_bodies(model, data%held, data%points, data%solver_kind, data%fem)
      if (has_moving_surfaces(model)) call set_rigid_motions(model, data%step%rigid_prescribed, data%fem%bodies)
      associate (rubs => model%interactions(model%pairs%interaction)%nu > 0.0_wp)
         call turn_supports(rubs, data%points, data%fem, model%bilateral, bilateral)
         call let_slide(rubs, data%points, data%fem, bilateral)
      end associate
      call straighten_held_points(model%bilateral, model%pairs%gap_is_given, data%fem, data%points, holder)
      call build_rows(data%points, data%rows, bilateral)
      call move_alloc(holder, data%rows%holder)
      call balance_rows(model%interactions(model%pairs%interaction)%nu > 0.0_wp, data%points, data%fem, bilateral, data%rows)
      if (any(model%interactions%rho > 0.0_wp)) then
         call check_average_memory(model%deck_path, data%rows%n, &
                                   average_entries(model, data%points, most_average_entries(asked%memory)), asked%memory, status)
         if (.not. is_ok(status)) return
      end if
      associate (period => data%step%increments%period)
         call resolve_overlaps(data, moment_t(period, period))
         call build_line(model, data%fem, data%points, data%rows, data%value, data%line)
         if (is_end(data%step, moment_t(period, period))) then
            call take_forces(data, data%step)
         else
            call set_time(data, moment_t(period, period))
         end if
      end associate
   end subroutine prepare

   !> The applied forces, and those of the temperatures.
   subroutine take_forces(data, acting)
      type(scene_data_t), intent(inout) :: data
      type(step_t), intent(in) :: acting                    !< with the values of a time

      if (allocated(data%given)) deallocate (data%given)
      call nodal_loads(data%model, acting, data%f)
      if (has_moving_surfaces(data%model)) call add_rigid_loads(data%model, acting%rigid_loads, data%f)
      call balance_loads(data%fem, data%f)
      if (allocated(data%thermal)) deallocate (data%thermal)
      if (.not. allocated(data%fem%heating)) return
      allocate (data%thermal, mold=data%f)
      data%thermal = 0.0_wp
      call add_thermal_loads(data%fem, data%thermal)
   end subroutine take_forces

   !> The applied forces at the end of the step, for a word about them.
   subroutine forces_at_end(data, now, f)
      type(scene_data_t), intent(in) :: data
      type(moment_t), intent(in) :: now                     !< in the step
      real(wp), allocatable, intent(out) :: f(:, :)         !< (2, n_nodes) [F]
      type(step_t) :: acting

      associate (period => data%step%increments%period)
         call act_at(data%model, data%step, moment_t(period, now%time + (period - now%step_time)), acting)
      end associate
      call nodal_loads(data%model, acting, f)
      if (has_moving_surfaces(data%model)) call add_rigid_loads(data%model, acting%rigid_loads, f)
   end subroutine forces_at_end

   !> Everything that acts at a time of the step, and the rest slips of the contact line: numbering and matrices stay.
   subroutine set_time(data, moment)
      type(scene_data_t), intent(inout) :: data !< its loads, values and rest slips are replaced
      type(moment_t), intent(in) :: moment      !< of the step, and the time of the history
      type(step_t) :: now
      real(wp) :: share

      share = share_at(data%step, moment)
      call act_at(data%model, data%step, moment, now)
      call list_held(data%model, now, data%held, data%value)
      data%rigid_prescribed = now%rigid_prescribed
      call move_alloc(now%heating, data%fem%heating)        ! which only some steps have
      call take_forces(data, now)
      if (allocated(data%released) .and. share < 1.0_wp) then
         data%f = data%f + (1.0_wp - share)*data%released
         call balance_loads(data%fem, data%f)
      end if
      if (data%asks_for_bases) call build_bases(data%model, data%step, data%released, data%fem, data%bases)
      data%asks_for_bases = .false.
      if (allocated(data%bases)) data%bases%factor = base_factors(data%model, data%step, data%bases%base, moment)
      call move_skew_supports(data, moment, share)
      call resolve_overlaps(data, moment)
      call set_known_points(data%rows, data%value, data%line)
      if (.not. data%is_assembled) return
      call set_scene_gaps(data%rows, data%line, data%value, data%assembled)
      call set_scene_load(data%fem, data%f, free_load(data), data%assembled)
   end subroutine set_time

   !> What is left of the overlaps that *CONTACT INTERFERENCE resolves; it goes linearly, whatever loads do.
   pure subroutine resolve_overlaps(data, moment)
      type(scene_data_t), intent(inout) :: data
      type(moment_t), intent(in) :: moment
      real(wp) :: share

      if (.not. allocated(data%step%overlap)) return
      share = min(moment%step_time/data%step%increments%period, 1.0_wp)
      call allow_overlap(data%points, (1.0_wp - share)*data%step%overlap_from + share*data%step%overlap, data%rows)
   end subroutine resolve_overlaps

   !> Supports along directions of their own come to their displacements in the first step, and keep them.
   pure subroutine move_skew_supports(data, moment, share)
      type(scene_data_t), intent(inout) :: data
      type(moment_t), intent(in) :: moment
      real(wp), intent(in) :: share

      if (data%rows%n_bilateral == 0) return
      associate (rows => data%model%bilateral, gap => data%rows%gap(data%rows%n - data%rows%n_bilateral + 1:))
         gap = rows%value
         if (share < 1.0_wp .and. moment%time <= moment%step_time) then
            where (rows%kind(:rows%n) == ROW_SUPPORT) gap = share*rows%value
         end if
      end associate
   end subroutine move_skew_supports

   !> The form of the contact system, by the numbers of points and nodes: in the dense form the nodes that the points see are kept,
   !> too, of which a master that is finer has more than there are points. A scene that is distributed takes the sparse form where
   !> nobody asks for the other one or for a method of it.
   subroutine choose_form(asked, data)
      type(solve_options_t), intent(in) :: asked
      type(scene_data_t), intent(inout) :: data
      logical :: seen(data%fem%mesh%n_nodes)
      logical :: is_worth_it
      integer(ip) :: i, n, n_points

      n = data%model%bilateral%n
      seen = .false.
      n_points = sum(data%points%n)
      do i = 1, size(data%points, kind=ip)
         seen(data%points(i)%entry) = .true.
         n = n + data%points(i)%n
         if (data%model%interactions(data%model%pairs(i)%interaction)%nu > 0.0_wp) n = n + data%points(i)%n
      end do
      n = max(n, count(seen, kind=ip) - n_points)
      call choose_contact_form(n, 2*data%model%mesh%n_nodes, asked%contact_form, data%step%controls%method /= METHOD_ANDERSON, &
                               min(asked%memory, available_memory()), data%contact_form, data%reason)
      is_worth_it = allocated(data%distribution) .and. any(asked%solver_kind == [0, SOLVER_SPARSE])
      if (is_worth_it) is_worth_it = data%distribution%pays_off(2*data%model%mesh%n_nodes, n)
      if (is_worth_it .and. asked%contact_form == CONTACT_AUTO .and. data%step%controls%method == METHOD_ANDERSON) then
         data%contact_form = CONTACT_SPARSE
         data%reason = data%distribution%reason
      end if
      data%is_distributed = is_worth_it .and. data%contact_form == CONTACT_SPARSE
   end subroutine choose_form

   !> All bodies in one matrix, or its parts in several processes, and their fronts; nothing is factored. status:
   !> STATUS_INTERNAL when the memory does not suffice.
   subroutine assemble(data, status)
      type(scene_data_t), intent(inout) :: data !< unchanged where the matrix is there
      type(status_t), intent(inout) :: status   !< STATUS_INTERNAL: too little memory
      type(assembled_scene_t), allocatable :: scene

      if (data%is_assembled) return
      call drop_assembled(data)
      if (data%is_distributed) then
         call data%distribution%assemble(data%fem, data%rows, data%line, data%value, data%assembled, status)
      else
         allocate (scene)
         call assemble_scene(data%fem, data%rows, data%line, data%value, scene, status)
         call move_alloc(scene, data%assembled)
      end if
      if (.not. is_ok(status)) return
      call set_scene_load(data%fem, data%f, free_load(data), data%assembled)
      data%is_assembled = .true.
   end subroutine assemble

   !> Takes the loads anew, which have changed.
   subroutine reload(data)
      type(scene_data_t), intent(inout) :: data

      if (data%is_assembled) call set_scene_load(data%fem, data%f, free_load(data), data%assembled)
   end subroutine reload

   !> The loads as they were before anything was taken out of them: an attempt that found nothing leaves no trace.
   subroutine put_back_loads(data)
      type(scene_data_t), intent(inout) :: data

      if (.not. allocated(data%given)) return
      call move_alloc(data%given, data%f)
      call reload(data)
   end subroutine put_back_loads

   !> The matrices are not needed any more.
   subroutine drop_assembled(data)
      type(scene_data_t), intent(inout) :: data !< its matrices are given back

      data%is_assembled = .false.
      if (.not. allocated(data%assembled)) return
      call data%assembled%release()
      deallocate (data%assembled)
   end subroutine drop_assembled

   !> Hard contact cannot take an overlap of prescribed dofs, nor a bilateral row without compliance a difference of them.
   pure subroutine check_known_points(data, status)
      type(scene_data_t), intent(in) :: data
      type(status_t), intent(out) :: status
      integer(ip) :: j

      do j = 1, data%line%n
         if (data%line%normal(j) > 0 .or. data%line%delta(j) > 0.0_wp) cycle
         if (j > data%line%n - data%line%n_bilateral) then
            call check_known_row(data, j, status)
            if (is_ok(status)) cycle
            return
         end if
         if (data%line%known_overlap(j) <= 1.0e-12_wp*(maxval(abs(data%fem%mesh%x))) + data%rows%doubt(j)*data%rows%reach(j)) cycle
         call set_status(status, STATUS_DECK, 'node '//to_text(data%fem%mesh%node_id(data%rows%node(data%rows%first(j)))) &
                         //' is prescribed to penetrate a hard contact by '//to_text(data%line%known_overlap(j)) &
                         //' [L]; a penalty (PRESSURE-OVERCLOSURE=LINEAR) could take it')
         return
      end do
   end subroutine check_known_points

   !> status: STATUS_DECK where all displacements of a bilateral row are prescribed, and not as it asks for.
   pure subroutine check_known_row(data, j, status)
      type(scene_data_t), intent(in) :: data
      integer(ip), intent(in) :: j                          !< row
      type(status_t), intent(out) :: status
      real(wp), parameter :: ROUND_OFF = 1.0e-9_wp
      real(wp) :: terms
      integer(ip) :: i, k

      terms = abs(data%rows%gap(j))
      do k = data%rows%first(j), data%rows%first(j + 1) - 1
         terms = terms + sum(abs(data%rows%vector(:, k - data%rows%before_vectors)*data%value(:, data%rows%node(k))))
      end do
      if (abs(data%line%known_overlap(j)) <= ROUND_OFF*terms) return
      i = j - (data%rows%n - data%rows%n_bilateral)
      call set_status(status, STATUS_DECK, 'the displacements of node ' &
                      //to_text(data%fem%mesh%node_id(data%rows%node(data%rows%first(j)))) &
                      //' and of those that its '//trim(ROW_KIND_NAME(data%model%bilateral%kind(i))) &
                      //' joins it to are all prescribed, and contradict it by '//to_text(data%line%known_overlap(j))//' [L]')
   end subroutine check_known_row

end module atrito_scene_data
