!> What a history holds beside what one increment takes, in the most that the process will hold (atrito_scene_forecast).
!>
!> Factors stay from one increment to the next, so stresses are recovered beside them. Three increments are whole at a time: the one
!> that is completed, the one before, and the last that is printed; the others that are printed lie on the disk and leave their
!> numbers here. Rows of tables are kept by increment and pair, and by iteration. How many increments there will be is known as far
!> as none is cut or lengthened.
module atrito_history_forecast
   use atrito_kinds, only: ip, lp
   use atrito_model, only: all_frequencies, model_t, step_t
   implicit none (type, external)
   private
   public :: is_solved_by_increments, history_bytes, field_growth

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

end module atrito_history_forecast
