!> The tractions of the contact upon the slaves, as arrows over the outlines of the displaced bodies.
module atrito_traction_plot
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_contact_plot, only: state_of, N_STATES, STATE_WORD, STATE_COLOUR
   use atrito_drawing, only: drawing_t, put_place, put_head, put_plane, put_title, add_lines, add_rigid_lines, &
                             displacement_text, largest_length, MOVED
   use atrito_kinds, only: ip, wp
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: TRACTION_PLOT, MESH_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_data, end_data, begin_script, end_script, put_plot
   use atrito_plot_text, only: range_t, cover, COLOUR, LF
   use atrito_results, only: results_t, contact_result_t
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_summary, only: pair_count
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
      integer(ip) :: pair, j

      largest = 0.0_wp
      do pair = 1, pair_count(results)
         do j = 1, results%contact(pair)%n
            largest = max(largest, largest_length(reshape(traction(results%contact(pair), j), [2, 1])))
         end do
      end do
   end function largest_traction

   !> Of many points each so manieth has an arrow.
   pure integer(ip) function arrow_stride(n_points) result(stride)
      integer(ip), intent(in) :: n_points

      stride = (n_points + MOST_ARROWS - 1)/MOST_ARROWS
   end function arrow_stride

   !> Writes tractions.dat and tractions.gp beside mesh.dat.
   subroutine write_traction_plot(plots, drawing)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(inout) :: drawing     !< that of the mesh; its window has room for the arrows while this is written
      type(string_t), allocatable :: curves(:)
      type(range_t) :: window(2)
      character(len=:), allocatable :: fewer
      real(wp) :: shorter, arrow, largest
      integer(ip) :: i, n_points
      logical :: has_state(0:N_STATES - 1)

      n_points = sum(drawing%results%contact%n)
      largest = largest_traction(drawing%results)
      shorter = max(SHORTEST, min(1.0_wp, sqrt(MANY/n_points)))     ! so that arrows do not hide each other
      arrow = LONGEST*shorter*drawing%size/largest
      window = drawing%window
      call write_data(plots, drawing, arrow, arrow_stride(n_points), has_state)
      call begin_script(plots, TRACTION_PLOT, 'the tractions of the contact upon the slaves', &
                        'Columns of '//TRACTION_PLOT//'.dat and of '//MESH_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L];'// &
                        LF//'# 5, 6 traction upon the slave [F/L^2], 7 state (0 open, 1 stick, 2 slip, 3 closed without friction)')
      call put_head(plots, drawing, 'arrow = '//to_text(arrow, DIGITS)//'   # length of a traction of one; change it here'//LF)
      call put_plane(plots, drawing)
      fewer = ''
      if (arrow_stride(n_points) > 1) fewer = ', one of '//to_text(arrow_stride(n_points))//' points'
      call put_title(plots, '"\ntractions upon the slaves, up to '//to_text(largest, 4)//' [F/L^2]'//fewer//'; '// &
                     displacement_text(drawing%scale)//'"')
      call put(plots, 'head = '//to_text(0.003_wp + 0.005_wp*shorter, 3)//'   # length of the arrows'' heads')
      allocate (curves(0))
      call add_lines(MESH_PLOT, drawing%n_inner, drawing%lines%n_runs - 1, 'lt 1 lw 1.2 lc rgb "#808080"', curves)
      call add_rigid_lines(MESH_PLOT, drawing, 'lt 1 lw 4 lc rgb "#404040"', .false., curves)
      do i = 0, N_STATES - 1
         if (has_state(i)) call append_string(curves, '"'//TRACTION_PLOT//'.dat" using '//MOVED//':($7 == '//to_text(i)// &
                                              ' ? arrow*$5 : NaN):(arrow*$6) with vectors filled size screen head,18 lt 1'// &
                                              ' lw 1.2 lc rgb "'//COLOUR(STATE_COLOUR(i))//'" title "'//trim(STATE_WORD(i))//'"')
      end do
      call put_plot(plots, curves)
      call end_script(plots)
      drawing%window = window
   end subroutine write_traction_plot

   !> Points with their tractions. The window is widened to their arrows.
   subroutine write_data(plots, drawing, arrow, stride, has_state)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(inout) :: drawing
      real(wp), intent(in) :: arrow                 !< length of a traction of one [L]
      integer(ip), intent(in) :: stride             !< one of so many points has an arrow
      logical, intent(out) :: has_state(0:)
      real(wp) :: t(2), tip(2)
      integer(ip) :: pair, j, i, state, n

      call begin_data(plots, TRACTION_PLOT, &
                      'columns: x [L]  y [L]  u1 [L]  u2 [L]  traction upon the slave along x and y [F/L^2]  state')
      has_state = .false.
      n = 0
      do pair = 1, pair_count(drawing%results)
         associate (contact => drawing%results%contact(pair))
            do j = 1, contact%n
               t = traction(contact, j)
               if (.not. all(ieee_is_finite(t))) cycle
               if (all(abs(t) <= 0.0_wp)) cycle
               n = n + 1
               if (mod(n - 1, stride) > 0) cycle
               state = state_of(contact%status(j), contact%has_friction)
               has_state(state) = .true.
               tip = contact%x(:, j) + drawing%scale*contact%u(:, j) + arrow*t
               do i = 1, 2
                  call cover(drawing%window(i), tip(i:i))
               end do
               call put_place(plots, [contact%x(:, j), contact%u(:, j)], trimmed_real(t(1), DIGITS)//' '// &
                              trimmed_real(t(2), DIGITS)//' '//to_text(state))
            end do
         end associate
      end do
      call end_data(plots)
   end subroutine write_data

end module atrito_traction_plot
