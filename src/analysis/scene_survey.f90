!> What a scene needs, and what it does without: for `check` and for the listing.
module atrito_scene_survey
   use atrito_assembly, only: body_profile
   use atrito_body_cost, only: choose_solver, estimate_body_memory, count_body_memory
   use atrito_contact_form, only: contact_form_name, CONTACT_SPARSE
   use atrito_kinds, only: ip, lp
   use atrito_memory, only: available_memory, held_memory, resident_memory
   use atrito_model, only: model_t
   use atrito_profile, only: profile_t
   use atrito_points, only: contact_points_t
   use atrito_results, only: scene_t, body_result_t, pair_scene_t
   use atrito_scene_data, only: scene_data_t
   use atrito_scene_forecast, only: forecast_memory
   use atrito_scene_memory, only: check_memory
   use atrito_solver_choice, only: SOLVER_SPARSE
   use atrito_status, only: status_t
   use atrito_strings, only: to_text, append_string
   use atrito_system, only: peak_memory
   implicit none (type, external)
   private
   public :: describe_scene, describe_order, count_fronts, check_scene

contains

   !> Fills what `check` and the listing print of a scene.
   subroutine describe_scene(data, scene)
      type(scene_data_t), intent(in) :: data     !< prepared, nothing factored
      type(scene_t), intent(out) :: scene        !< whole
      integer(ip) :: b

      allocate (scene%bodies(data%fem%bodies%n))
      do b = 1, data%fem%bodies%n
         call describe_body(scene%bodies(b))
         scene%n_dofs = scene%n_dofs + scene%bodies(b)%n_equations
         scene%n_rigid = scene%n_rigid + scene%bodies(b)%n_free_motions
      end do
      call describe_pairs()
      scene%n_normal = count(data%line%normal > 0, kind=ip)
      scene%n_rows = count(data%line%normal(data%line%n - data%line%n_bilateral + 1:) > 0, kind=ip)
      scene%n_tangential = count(data%line%tangential > 0, kind=ip)
      scene%outer_loop = data%line%has_friction
      scene%contact_form = contact_form_name(data%contact_form)
      scene%contact_reason = data%reason
      if (data%is_assembled) call describe_order(data, scene)
      scene%peak_before = max(peak_memory(), resident_memory())
      scene%memory_before = held_memory()
      scene%memory = forecast_memory(data%model, data, scene)
      call list_left_out(data, scene)

   contains

      !> A body, and the solver of its matrix where it has one of its own.
      subroutine describe_body(result)
         type(body_result_t), intent(inout) :: result
         type(profile_t) :: profile

         associate (body => data%fem%bodies%list(b))
            result%name = body%name
            result%n_nodes = size(body%nodes, kind=ip)
            result%n_elements = size(body%elements, kind=ip)
            result%n_equations = body%n
            result%n_contact_equations = body%n_retained
            result%n_free_motions = size(body%modes, 2, kind=ip)
         end associate
         if (data%fem%bodies%list(b)%is_rigid) then
            result%n_nodes = 1                                ! its reference node
            result%solver = 'none'
            result%reason = 'rigid'
         else if (data%contact_form == CONTACT_SPARSE) then
            result%solver = 'scene'
         else
            call body_profile(data%fem, b, profile)
            call choose_solver(profile, data%solver_kind, result)
            call estimate_body_memory(data%fem, b, result)
         end if
      end subroutine describe_body

      subroutine describe_pairs()
         integer(ip) :: i, least, greatest

         allocate (scene%pairs(size(data%points)))
         do i = 1, size(data%points, kind=ip)
            associate (pair => scene%pairs(i), points => data%points(i))
               pair%slave = data%model%surfaces(data%model%pairs(i)%slave)%name
               pair%master = data%model%surfaces(data%model%pairs(i)%master)%name
               pair%interaction = data%model%interactions(data%model%pairs(i)%interaction)%name
               pair%n_points = points%n
               pair%n_left_out = points%n_left_out
               pair%matching = points%matching
               pair%master_is_rigid = points%rigid
               if (points%n > 0) then
                  ! The least and the greatest initial gap, and where.
                  least = minloc(points%gap, 1, kind=ip)
                  greatest = maxloc(points%gap, 1, kind=ip)
                  pair%least_gap = points%gap(least)
                  pair%greatest_gap = points%gap(greatest)
                  pair%least_node = data%model%mesh%node_id(points%node(least))
                  pair%greatest_node = data%model%mesh%node_id(points%node(greatest))
                  pair%least_x = points%x(:, least)
                  pair%greatest_x = points%x(:, greatest)
               end if
            end associate
         end do
      end subroutine describe_pairs

   end subroutine describe_scene

   !> Of the sparse form, when it is assembled.
   subroutine describe_order(data, scene)
      type(scene_data_t), intent(in) :: data     !< with the assembled scene
      type(scene_t), intent(inout) :: scene      !< get order and solving

      scene%solving = data%assembled%solving_bytes()
      scene%order = data%assembled%order
   end subroutine describe_order

   !> Counts what could be estimated only: the fronts of bodies with the sparse solver. A run, which makes them itself in a while,
   !> wants it where the estimate does not fit.
   subroutine count_fronts(data, always, scene)
      type(scene_data_t), intent(in) :: data     !< bodies are read
      logical, intent(in) :: always              !< else only where the estimate does not fit
      type(scene_t), intent(inout) :: scene      !< memory of its bodies, and its own
      integer(ip) :: b

      if (.not. any(scene%bodies%solver_kind == SOLVER_SPARSE)) return
      if (.not. always) then
         if (scene%memory - scene%memory_before <= available_memory()) return
      end if
      do b = 1, size(scene%bodies, kind=ip)
         if (scene%bodies(b)%solver_kind == SOLVER_SPARSE) call count_body_memory(data%fem, b, scene%bodies(b))
      end do
      scene%peak_before = max(scene%peak_before, peak_memory())
      scene%memory = forecast_memory(data%model, data, scene)
   end subroutine count_fronts

   !> status: STATUS_DECK when the matrices of the scene need more memory than there is.
   subroutine check_scene(model, memory, scene, status)
      type(model_t), intent(in) :: model                    !< its deck_path is read
      integer(lp), intent(in) :: memory                     !< bytes there are
      type(scene_t), intent(in) :: scene                    !< memory and sizes are read
      type(status_t), intent(inout) :: status               !< STATUS_DECK where it does not fit; else as it was

      call check_memory(model%deck_path, 'the scene, '//to_text(scene%n_dofs)//' free displacements and '// &
                        to_text(scene%n_normal + scene%n_tangential)//' contact unknowns,', scene%memory, memory, status, &
                        held=scene%memory_before)
   end subroutine check_scene

   !> What the scene does not need, in sentences.
   subroutine list_left_out(data, scene)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(inout) :: scene

      allocate (scene%left_out(0))
      if (size(data%points) == 0 .and. scene%n_rows == 0) then
         call append_string(scene%left_out, 'no contact pair: no contact line, one solve a body')
      else if (size(data%points) == 0) then
         call append_string(scene%left_out, 'no contact pair: nothing opens or slides, no iteration')
      end if
      if (size(data%points) > 0 .and. .not. data%line%has_friction) then
         call append_string(scene%left_out, 'no friction: no tangential unknowns, no outer loop')
      end if
      if (any(data%points%rigid)) then
         call append_string(scene%left_out, 'rigid surface: no second body and no matrix for it')
      end if
      if (data%line%has_friction .and. data%line%average%is_identity) then
         call append_string(scene%left_out, 'local friction: no averaging of the pressure')
      end if
   end subroutine list_left_out

end module atrito_scene_survey
