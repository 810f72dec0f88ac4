!> The tractions of the contact upon the slaves, as arrows over the outlines of the displaced bodies.
module atrito_traction_plot
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_contact_plot, only: state_of, N_STATES, STATE_WORD, STATE_COLOUR
   use atrito_files, only: file_set_t, text_file_t, put_line, close_text
   use atrito_kinds, only: ip, wp
   use atrito_mesh_lines, only: drawing_t, put_place, put_frame, add_lines, add_rigid_lines, LINE_INNER
   use atrito_mesh_plot, only: displacement_text
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: open_data, TRACTION_PLOT, MESH_PLOT
   use atrito_plot_text, only: range_t, cover, quoted, picture_title, begin_script, end_script, put_plot, COLOUR
   use atrito_results, only: results_t, contact_result_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_summary, only: pair_count
   use atrito_write_tables, only: origin_of
   implicit none (type, external)
   private
   public :: has_traction_plot, write_traction_plot, traction, arrow_stride

   integer(ip), parameter :: MOST_ARROWS = 3000
   real(wp), parameter :: LONGEST = 0.12_wp         !< arrow, as a share of the scene's diagonal; shorter where there are many
   real(wp), parameter :: MANY = 150.0_wp, SHORTEST = 0.25_wp !< points from which on they are, down to this share of it
   integer, parameter :: DIGITS = 6

contains

   !> Whether something is transmitted.
   pure logical function has_traction_plot(results)
      type(results_t), intent(in) :: results

      has_traction_plot = largest_traction(results) > 0.0_wp
   end function has_traction_plot

   !> The traction upon the slave at a point: -p n + sigma_T T, T being n turned by +90 degrees [F/L^2].
   pure function traction(contact, j) result(t)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: j
      real(wp) :: t(2)

      associate (n => contact%normal(:, j))
         t = -contact%pressure(j)*n
         if (contact%has_friction) t = t + contact%shear(j)*[-n(2), n(1)]
      end associate
   end function traction

   pure real(wp) function largest_traction(results) result(largest)
      type(results_t), intent(in) :: results
      real(wp) :: t(2)
      integer(ip) :: pair, j

      largest = 0.0_wp
      do pair = 1, pair_count(results)
         do j = 1, results%contact(pair)%n
            t = traction(results%contact(pair), j)
            if (all(ieee_is_finite(t))) largest = max(largest, hypot(t(1), t(2)))
         end do
      end do
   end function largest_traction

   !> Of many points each so manieth has an arrow.
   pure integer(ip) function arrow_stride(n_points) result(stride)
      integer(ip), intent(in) :: n_points

      stride = (n_points + MOST_ARROWS - 1)/MOST_ARROWS
   end function arrow_stride

   !> By which arrows are shorter so that they do not hide each other.
   pure real(wp) function shortening(results)
      type(results_t), intent(in) :: results        !< with points

      shortening = max(SHORTEST, min(1.0_wp, sqrt(MANY/sum(results%contact%n))))
   end function shortening

   !> Writes tractions.dat and tractions.gp into the set of the plots' folder, which has mesh.dat. status: STATUS_FILE.
   subroutine write_traction_plot(set, model, results, drawing, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(drawing_t), intent(in) :: drawing        !< that of the mesh
      type(status_t), intent(out) :: status
      real(wp) :: arrow
      type(range_t) :: window(2)
      logical :: has_state(0:N_STATES - 1)

      arrow = LONGEST*shortening(results)*drawing%size/largest_traction(results)
      window = drawing%window
      call write_data(set, results, drawing%scale, arrow, window, has_state, status)
      if (is_ok(status)) call write_script(set, model, results, drawing, window, arrow, has_state, status)
   end subroutine write_traction_plot

   !> Points with their tractions, and what their arrows need of the window.
   subroutine write_data(set, results, scale, arrow, window, has_state, status)
      type(file_set_t), intent(inout) :: set
      type(results_t), intent(in) :: results
      real(wp), intent(in) :: scale                 !< of the displacements
      real(wp), intent(in) :: arrow                 !< length of a traction of one [L]
      type(range_t), intent(inout) :: window(2)     !< is made so wide that the arrows are in it
      logical, intent(out) :: has_state(0:)
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      real(wp) :: t(2), tip(2)
      integer(ip) :: pair, j, i, state, n

      call open_data(set, TRACTION_PLOT, file)
      call put_line(file, '# columns: x [L]  y [L]  u1 [L]  u2 [L]  traction upon the slave along x and y [F/L^2]  state')
      has_state = .false.
      n = 0
      do pair = 1, pair_count(results)
         associate (contact => results%contact(pair))
            do j = 1, contact%n
               t = traction(contact, j)
               if (.not. all(ieee_is_finite(t))) cycle
               if (all(abs(t) <= 0.0_wp)) cycle
               n = n + 1
               if (mod(n - 1, arrow_stride(sum(results%contact%n))) > 0) cycle
               state = state_of(contact%status(j), contact%has_friction)
               has_state(state) = .true.
               tip = contact%x(:, j) + scale*contact%u(:, j) + arrow*t
               do i = 1, 2
                  call cover(window(i), tip(i:i))
               end do
               call put_place(file, [contact%x(:, j), contact%u(:, j)], trimmed_real(t(1), DIGITS)//' '// &
                              trimmed_real(t(2), DIGITS)//' '//to_text(state))
            end do
         end associate
      end do
      call close_text(file, status)
   end subroutine write_data

   subroutine write_script(set, model, results, drawing, window, arrow, has_state, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(drawing_t), intent(in) :: drawing
      type(range_t), intent(in) :: window(2)
      real(wp), intent(in) :: arrow
      logical, intent(in) :: has_state(0:)
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      character(len=:), allocatable :: fewer

      call begin_script(set, TRACTION_PLOT, 'the tractions of the contact upon the slaves', file)
      call put_line(file, '# Columns of '//TRACTION_PLOT//'.dat and of '//MESH_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L];')
      call put_line(file, '# 5, 6 traction upon the slave [F/L^2], 7 state (0 open, 1 stick, 2 slip, 3 closed without friction)')
      call put_line(file, 'scale = '//to_text(drawing%scale, 15)//'   # of the displacements; change it here')
      call put_line(file, 'arrow = '//to_text(arrow, DIGITS)//'   # length of a traction of one; change it here')
      call put_line(file, 'heading = '//quoted(picture_title(origin_of(model, results))))
      call put_frame(file, TRACTION_PLOT, window, drawing%view)
      fewer = ''
      associate (stride => arrow_stride(sum(results%contact%n)))
         if (stride > 1) fewer = ', one of '//to_text(stride)//' points'
      end associate
      call put_line(file, 'set tmargin 4')
      call put_line(file, 'set label 1 heading."\ntractions upon the slaves, up to '//to_text(largest_traction(results), 4)// &
                    ' [F/L^2]'//fewer//'; '//displacement_text(drawing%scale)//'" at screen 0.5, screen 1 - 22.0/height center '// &
                    'noenhanced')
      call put_line(file, 'head = '//to_text(0.003_wp + 0.005_wp*shortening(results), 3)//'   # length of the arrows'' heads')
      call put_curves(file, model, drawing, has_state)
      call end_script(file, status)
   end subroutine write_script

   !> One plot: outlines, rigid surfaces, and the arrows in the colours of their states.
   subroutine put_curves(file, model, drawing, has_state)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(drawing_t), intent(in) :: drawing
      logical, intent(in) :: has_state(0:)
      type(string_t), allocatable :: curves(:)
      integer(ip) :: n_inner, i

      n_inner = count(drawing%lines%kind(:drawing%lines%n_runs) == LINE_INNER, kind=ip)
      allocate (curves(0))
      call add_lines(MESH_PLOT, n_inner, drawing%lines%n_runs - 1, 'lt 1 lw 1.2 lc rgb "#808080"', curves)
      call add_rigid_lines(MESH_PLOT, drawing%lines%n_runs, 'lt 1 lw 4 lc rgb "#404040"', .false., model, curves)
      curves(1)%s = 'plot '//trim(adjustl(curves(1)%s))
      do i = 0, N_STATES - 1
         if (.not. has_state(i)) cycle
         call append_string(curves, '   "'//TRACTION_PLOT//'.dat" using ($1 + scale*$3):($2 + scale*$4):($7 == '//to_text(i)// &
                            ' ? arrow*$5 : NaN):(arrow*$6) with vectors filled size screen head,18 lt 1 lw 1.2 lc rgb "'// &
                            COLOUR(STATE_COLOUR(i))//'" title "'//trim(STATE_WORD(i))//'"')
      end do
      call put_plot(file, curves)
   end subroutine put_curves

end module atrito_traction_plot
