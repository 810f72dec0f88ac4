!> The memory that the process will hold at the most, before anything is factored.
!>
!> What is there by then is not counted but asked of the system: libraries, mesh, model, points, averages. To that comes the largest
!> of what the phases hold that follow: bodies and contact line, or factors of the sparse form; displacements, stresses and what
!> their recovery works with. Left out are the certificate, a second form where the first finds no solution, and bodies kept for a
!> next run. Of a scene that is distributed over processes it is asked elsewhere (distribution_t): this one's was then told.
!>
!> A history holds more than what one increment takes. Factors stay from one increment to the next, so stresses are recovered beside
!> them. Three increments are whole at a time: the one that is completed, the one before, and the last that is printed; the others
!> that are printed lie on the disk and leave their numbers here. Rows of tables are kept by increment and pair, and by iteration.
!> How many increments there will be is known as far as none is cut or lengthened.
module atrito_scene_forecast
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_element_table, only: BEST_OF, CORNERS_OF, DEGREE_OF, POINT_COUNT
   use atrito_kinds, only: ip, lp, wp
   use atrito_model, only: model_t, step_t, all_frequencies
   use atrito_results, only: scene_t
   use atrito_plane_state, only: STATES
   use atrito_scene_data, only: scene_data_t, PROOF_OFF
   use atrito_solver_choice, only: SOLVER_SPARSE
   use atrito_uniqueness, only: LONGEST
   implicit none (type, external)
   private
   public :: forecast_memory, field_library_bytes, load_bytes, recovery_bytes, request_bytes, with_holes, LATER_BYTES

   integer(lp), parameter :: REAL_BYTES = 8_lp
   !> Code and places for work that are first touched later; of BLAS with large matrices.
   integer(lp), parameter :: LATER_BYTES = 4000000_lp, MOST_OF_BLAS = 3000000_lp
   !> The library of field files, which is loaded when it is wanted; with what it works with, when it writes restart files.
   integer(lp), parameter :: FIELD_LIBRARY = 4500000_lp, RESTART_LIBRARY = 5500000_lp
   !> Measured shares: holes between the factors of fronts; what the bodies leave of themselves in the process, when they have been
   !> given back; and what the C library rounds up.
   real(wp), parameter :: HOLES = 0.12_wp, LEFT_BEHIND = 0.13_wp, ROUNDING_UP = 0.065_wp

   !> What, as measured, a printed increment leaves of itself, while the list of them grows, and of HDF5; rows of history.tab, and
   !> what the iterations of an increment, four or five of them, take as rows and as a table.
   integer(lp), parameter :: FRAME_NUMBERS = 6000_lp, PAIR_ROW = 380_lp, ITERATION_ROWS = 1000_lp, FIELD_GROUPS = 25000_lp
   !> What HDF5 keeps at most.
   integer(lp), parameter :: MOST_OF_FIELDS = 30000000_lp
   !> Text of the tables, which are written side by side.
   integer(lp), parameter :: OPEN_TABLES = 500000_lp
   !> Increments that are whole beside the one that is completed; with restart files a copy of the last, one that is read again, and
   !> the lists that go into the file.
   integer(lp), parameter :: WHOLE = 2_lp, WHOLE_OF_RESTART = 3_lp

contains

   !> The most that the process will hold [bytes].
   pure integer(lp) function forecast_memory(model, data, scene) result(bytes)
      type(model_t), intent(in) :: model             !< its mesh and steps are read
      type(scene_data_t), intent(in) :: data         !< form, line and distribution are read
      type(scene_t), intent(in) :: scene             !< with its bodies, and what was held so far
      integer(lp) :: solving, kept, recovering
      logical :: is_sparse

      if (data%is_distributed) then
         bytes = scene%memory
         return
      end if
      recovering = max(recovery_bytes(model, int(model%mesh%n_nodes, lp), int(model%mesh%n_elements, lp)), proof_bytes(data)) &
                   + request_bytes(model, data)
      is_sparse = data%contact_form == CONTACT_SPARSE
      solving = load_bytes(model) + merge(scene%solving, dense_solving_bytes(scene, data%starts > 0), is_sparse)
      if (is_solved_by_increments(model)) then
         ! the factor of the contact system of the increment before, from which the next one starts, is there besides
         kept = merge(0_lp, REAL_BYTES*int(scene%n_normal + scene%n_tangential, lp)**2, is_sparse)
         solving = solving + kept + recovering + history_bytes(model, data%line%n, stress_rows(model)) + field_growth(model)
      else if (is_sparse) then
         solving = max(solving, recovering)
      else
         solving = max(solving, recovering) + share_of(LEFT_BEHIND, min(solving, recovering))
      end if
      bytes = max(scene%peak_before, scene%memory_before + LATER_BYTES + solving + field_library_bytes(data))
   end function forecast_memory

   !> Of fields and of restart files: one library.
   pure integer(lp) function field_library_bytes(data) result(bytes)
      type(scene_data_t), intent(in) :: data         !< its model is read

      bytes = 0
      if (field_growth(data%model) > 0) bytes = FIELD_LIBRARY
      if (data%model%restart_every > 0) bytes = RESTART_LIBRARY
   end function field_library_bytes

   !> Bodies one after the other, then the flexibility, its factor and a copy, and as many motions of each row.
   pure integer(lp) function dense_solving_bytes(scene, is_searched) result(most)
      type(scene_t), intent(in) :: scene
      logical, intent(in) :: is_searched             !< for other solutions
      integer(lp) :: held
      integer(ip) :: b

      held = 0
      most = 0
      do b = 1, size(scene%bodies, kind=ip)
         associate (body => scene%bodies(b))
            most = max(most, held + with_holes(body%solver_kind, body%most_memory))
            held = held + with_holes(body%solver_kind, body%memory) + REAL_BYTES*int(body%n_equations, lp)
         end associate
      end do
      most = max(most, held + contact_bytes(scene, is_searched))
      associate (m => int(scene%n_normal + scene%n_tangential, lp))
         most = most + share_of(ROUNDING_UP, most) + min(MOST_OF_BLAS, REAL_BYTES*m**2)
      end associate
   end function dense_solving_bytes

   !> The contact system of the dense form: the flexibility, its factor and a copy, and as many motions of each row; where its
   !> solution is certified to be the only one, the matrices of that besides.
   pure integer(lp) function contact_bytes(scene, is_searched) result(bytes)
      type(scene_t), intent(in) :: scene
      logical, intent(in) :: is_searched             !< for other solutions
      integer(lp), parameter :: MOTIONS = 6_lp
      integer(lp) :: m, rows, matrices
      integer(ip) :: b

      m = scene%n_normal + scene%n_tangential
      matrices = merge(8_lp, 3_lp, scene%n_tangential > 0 .and. (m <= LONGEST .or. is_searched))
      rows = 0
      do b = 1, size(scene%bodies, kind=ip)
         associate (n => scene%bodies(b)%n_contact_equations)
            rows = max(rows, n*min(m, 2*int(n, lp)))
         end associate
      end do
      bytes = REAL_BYTES*max(m*(m + scene%n_rigid) + rows, m*(matrices*m + MOTIONS*scene%n_rigid))
   end function contact_bytes

   !> With what the updates of fronts leave behind between the factors when they are given back: nothing else fits there.
   pure integer(lp) function with_holes(solver_kind, bytes)
      integer, intent(in) :: solver_kind             !< SOLVER_*
      integer(lp), intent(in) :: bytes               !< of the factors

      with_holes = bytes
      if (solver_kind >= SOLVER_SPARSE) with_holes = bytes + share_of(HOLES, bytes)
   end function with_holes

   pure integer(lp) function share_of(share, bytes)
      real(wp), intent(in) :: share
      integer(lp), intent(in) :: bytes

      share_of = int(share*real(bytes, wp), lp)
   end function share_of

   !> Forces and displacements while it is solved.
   pure integer(lp) function load_bytes(model) result(bytes)
      type(model_t), intent(in) :: model             !< its mesh is read
      integer(lp), parameter :: VECTORS = 2_lp

      bytes = VECTORS*2*REAL_BYTES*int(model%mesh%n_nodes, lp)
   end function load_bytes

   !> Displacements, reactions, stresses at Gauss points and at nodes, and the patches of their recovery, of some of the elements.
   pure integer(lp) function recovery_bytes(model, nodes, elements) result(bytes)
      type(model_t), intent(in) :: model             !< shapes of its elements are read
      integer(lp), intent(in) :: nodes, elements     !< how many of them
      integer(lp), parameter :: NODE_BYTES = 310_lp, ELEMENT_BYTES = 60_lp, SAMPLE_BYTES = 5*REAL_BYTES
      integer(lp) :: samples

      samples = maxval(BEST_OF(model%mesh%shape))
      bytes = NODE_BYTES*nodes + (ELEMENT_BYTES + samples*SAMPLE_BYTES)*elements
   end function recovery_bytes

   !> A bound of the error, with the results that are there by then: of each element the numbers of its outline and their slopes,
   !> its forces twice, sides and the chains round corners; triangles beside contact points.
   pure integer(lp) function proof_bytes(data) result(bytes)
      type(scene_data_t), intent(in) :: data
      integer(lp), parameter :: NODE_BYTES = 200_lp, SHARE_BYTES = 100_lp, POINT_BYTES = 1500_lp
      integer(lp) :: n_nodes, n_corners, degree

      bytes = 0
      if (data%proof == PROOF_OFF .or. data%rows%n_bilateral > 0 .or. data%fem%bodies%n_rigid > 0) return
      associate (mesh => data%fem%mesh)
         if (any(STATES(mesh%state(:mesh%n_elements))%has_hoop)) return
         n_nodes = maxval(mesh%shape(:mesh%n_elements))
         n_corners = maxval(CORNERS_OF(mesh%shape(:mesh%n_elements)))
         degree = maxval(DEGREE_OF(mesh%shape(:mesh%n_elements)))
         bytes = NODE_BYTES*mesh%n_nodes + POINT_BYTES*data%line%n &
                 + mesh%n_elements*(degree*SHARE_BYTES + 2*REAL_BYTES*n_corners*(2*degree + 2) + 4*REAL_BYTES*n_nodes &
                                    + n_corners*(58 + 16*(degree + 1)))
      end associate
   end function proof_bytes

   !> What is asked for of it: stresses at Gauss points, and contact points.
   pure integer(lp) function request_bytes(model, data) result(bytes)
      type(model_t), intent(in) :: model             !< what its steps ask for
      type(scene_data_t), intent(in) :: data         !< its points are counted
      integer(lp), parameter :: ROW_BYTES = 64_lp, POINT_BYTES = 250_lp

      bytes = ROW_BYTES*stress_rows(model) + POINT_BYTES*data%line%n
   end function request_bytes

   !> Gauss points at which stresses are asked for, in the first step or in the last: requests hold on.
   pure integer(lp) function stress_rows(model) result(rows)
      type(model_t), intent(in) :: model

      rows = rows_of_step(model, model%steps(1))
      if (size(model%steps) > 1) rows = max(rows, rows_of_step(model, model%steps(size(model%steps))))
   end function stress_rows

   pure integer(lp) function rows_of_step(model, step) result(rows)
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: step
      integer(ip) :: e
      logical :: wanted

      rows = 0
      associate (requests => step%requests)
         if (.not. (requests%stress .or. requests%fields%stress)) return
         do e = 1, model%mesh%n_elements
            wanted = .false.
            if (requests%stress) wanted = requests%element_s(e)
            if (requests%fields%stress) wanted = wanted .or. requests%fields%element_s(e)
            if (wanted) rows = rows + POINT_COUNT(model%mesh%shape(e), model%mesh%state(e))
         end do
      end associate
   end function rows_of_step

   !> More than one increment, or one from which another may begin.
   pure logical function is_solved_by_increments(model)
      type(model_t), intent(in) :: model !< its steps are read

      is_solved_by_increments = size(model%steps) > 1 .or. model%restart_every > 0
      if (is_solved_by_increments) return
      associate (control => model%steps(1)%increments)
         is_solved_by_increments = control%initial < control%period .or. control%least < control%period
      end associate
   end function is_solved_by_increments

   !> The most of a history [bytes], beside an increment.
   pure integer(lp) function history_bytes(model, n_points, stress_rows) result(bytes)
      type(model_t), intent(in) :: model               !< mesh, pairs and steps are counted
      integer(ip), intent(in) :: n_points              !< of all pairs
      integer(lp), intent(in) :: stress_rows           !< Gauss points of which stresses are asked for
      integer(lp) :: copies
      integer :: k

      copies = WHOLE
      if (model%restart_every > 0) copies = copies + WHOLE_OF_RESTART
      bytes = copies*frame_bytes() + OPEN_TABLES
      do k = 1, size(model%steps)
         bytes = bytes + increments_of(model%steps(k))*(ITERATION_ROWS + PAIR_ROW*size(model%pairs, kind=lp)) &
                 + maxval(due_of(model%steps(k), all_frequencies(model%steps(k)%requests%every)))*FRAME_NUMBERS
      end do

   contains

      !> The fields of an increment that is printed.
      pure integer(lp) function frame_bytes() result(bytes)
         integer(lp), parameter :: NODE_BYTES = 80_lp, POINT_BYTES = 150_lp, ROW_BYTES = 64_lp, PAIR_BYTES = 6000_lp

         bytes = NODE_BYTES*model%mesh%n_nodes + POINT_BYTES*n_points + ROW_BYTES*stress_rows + &
                 PAIR_BYTES*size(model%pairs, kind=lp)
      end function frame_bytes

   end function history_bytes

   !> What the library of field files keeps of increments that are in the file [bytes].
   pure integer(lp) function field_growth(model) result(bytes)
      type(model_t), intent(in) :: model !< steps and their field requests are read
      integer :: k

      bytes = 0
      do k = 1, size(model%steps)
         associate (fields => model%steps(k)%requests%fields, every => model%steps(k)%requests%every%fields)
            if (fields%nodes .or. fields%reactions .or. fields%stress .or. fields%contact) then
               bytes = bytes + FIELD_GROUPS*due_of(model%steps(k), every)
            end if
         end associate
      end do
      bytes = min(bytes, MOST_OF_FIELDS)
   end function field_growth

   !> Increments of a step, of which none is cut or lengthened.
   pure integer(lp) function increments_of(step)
      type(step_t), intent(in) :: step

      associate (control => step%increments)
         increments_of = control%most
         ! the quotient may leave the range of numbers
         if (control%initial > control%period/control%most) increments_of = max(1_lp, int(control%period/control%initial, lp))
      end associate
   end function increments_of

   pure elemental integer(lp) function due_of(step, every)
      type(step_t), intent(in) :: step
      integer(ip), intent(in) :: every                 !< increments; none (0): at the end alone

      due_of = 1
      if (every > 0) due_of = max(1_lp, increments_of(step)/every)
   end function due_of

end module atrito_scene_forecast
