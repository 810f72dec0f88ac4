!> The picture of the contact pairs before anything is solved: the initial gap along the slave, a panel a pair. Of many pairs those
!> with the least gaps are shown.
module atrito_gap_plot
   use atrito_files, only: file_set_t, text_file_t, put_line, close_text
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: open_data, GAP_PLOT
   use atrito_plot_text, only: range_t, cover, padded, quoted, cleaned, scene_title, begin_script, end_script, put_terminal, &
                               put_frame, put_panel, COLOUR
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: write_gap_plot, has_gap_plot, shown_pairs

   integer, parameter :: MOST_PANELS = 6, DIGITS = 8, LONGEST_NAME = 26
   !> Gaps below this part of the length of all pairs are round-off and drawn as 0.
   real(wp), parameter :: ROUND_OFF = 1.0e-12_wp
   !> A gap that is the same all along is drawn in the middle of a panel as high as so much of the slave is long.
   real(wp), parameter :: EVEN_SHARE = 0.01_wp

contains

   !> Whether there are points to draw.
   pure logical function has_gap_plot(model)
      type(model_t), intent(in) :: model

      has_gap_plot = size(shown_pairs(model)) > 0
   end function has_gap_plot

   !> The pairs that are drawn, those with the least gaps, in the order of the deck.
   pure function shown_pairs(model) result(shown)
      type(model_t), intent(in) :: model
      integer(ip), allocatable :: shown(:)
      integer(ip) :: i, k
      real(wp), allocatable :: least(:)
      logical, allocatable :: taken(:)

      allocate (shown(0))
      if (.not. allocated(model%points)) return
      least = [(least_gap(model, i), i=1, size(model%points, kind=ip))]
      allocate (taken(size(least)), source=.false.)
      do k = 1, min(MOST_PANELS, count(model%points%n > 0))
         i = minloc(least, dim=1, mask=.not. taken .and. model%points%n > 0, kind=ip)
         taken(i) = .true.
      end do
      shown = pack([(i, i=1, size(least, kind=ip))], taken)
   end function shown_pairs

   pure real(wp) function least_gap(model, i) result(least)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                  !< the pair

      least = huge(least)
      if (model%points(i)%n > 0) least = minval(model%points(i)%gap(:model%points(i)%n))
   end function least_gap

   !> Writes pairs.dat and pairs.gp into the set of the plots' folder.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_gap_plot(set, model, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model            !< with pairs that have points
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      integer(ip) :: i, j

      call open_data(set, GAP_PLOT, file)
      call put_line(file, '# initial gaps of the pairs that are drawn; columns: s [L]  gap [L]')
      associate (shown => shown_pairs(model))
         do i = 1, size(shown, kind=ip)
            call put_line(file, '# block '//to_text(i - 1)//': pair '//to_text(shown(i)))
            associate (points => model%points(shown(i)))
               do j = 1, points%n
                  call put_line(file, trimmed_real(points%s(j), DIGITS)//' '//trimmed_real(gap_of(model, shown(i), j), DIGITS))
               end do
            end associate
            call put_line(file, '')
            call put_line(file, '')
         end do
      end associate
      call close_text(file, status)
      if (is_ok(status)) call write_script(set, model, shown_pairs(model), status)
   end subroutine write_gap_plot

   !> The gap of a point; 0 where it is round-off.
   pure real(wp) function gap_of(model, pair, j) result(gap)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: pair, j

      associate (points => model%points(pair))
         gap = points%gap(j)
         if (abs(gap) <= ROUND_OFF*maxval(abs(points%s(:points%n)))) gap = 0.0_wp
      end associate
   end function gap_of

   subroutine write_script(set, model, shown, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: shown(:)           !< pairs
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(range_t) :: along
      integer :: i

      do i = 1, size(shown)
         associate (points => model%points(shown(i)))
            call cover(along, [0.0_wp, points%s(:points%n)])
         end associate
      end do
      if (along%high <= along%low) along = padded(along)
      call begin_script(set, GAP_PLOT, 'initial gaps of the contact pairs along s', file)
      call put_line(file, '# Columns of pairs.dat: 1 s [L], 2 gap [L]; a block a pair')
      call put_line(file, 'heading = '//quoted(scene_title(model%deck_path, model%heading)))
      call put_frame(file, size(shown), along, '"s [L]"')
      call put_terminal(file, GAP_PLOT, '1000,height')
      call put_line(file, 'set style fill transparent solid 0.35 noborder')
      call put_line(file, 'set multiplot title heading."\n'//what_is_shown(model, shown)//'" noenhanced')
      do i = 1, size(shown)
         call put_pair(file, model, shown(i), i)
      end do
      call put_line(file, 'unset multiplot')
      call end_script(file, status)
   end subroutine write_script

   !> The second line of the title.
   pure function what_is_shown(model, shown) result(text)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: shown(:)
      character(len=:), allocatable :: text

      text = 'initial gaps, negative where the sides overlap'
      if (size(shown) < size(model%pairs)) text = text//': the '//to_text(size(shown, kind=ip))//' of '// &
                                                  to_text(size(model%pairs, kind=ip))//' pairs with the least'
   end function what_is_shown

   !> The panel of a pair.
   subroutine put_pair(file, model, pair, place)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: pair
      integer, intent(in) :: place                  !< of the panel, 1 the uppermost
      type(range_t) :: range
      character(len=:), allocatable :: data, name
      integer(ip) :: j

      associate (points => model%points(pair), surfaces => model%surfaces, it => model%pairs(pair))
         call cover(range, [0.0_wp, (gap_of(model, pair, j), j=1, points%n)])
         if (.not. range%high > range%low) then
            associate (half => EVEN_SHARE*maxval(abs(points%s(:points%n))))
               call cover(range, [-half, half])
            end associate
         end if
         call put_panel(file, place, 'gap', 'L', range)
         name = quoted(cleaned(surfaces(it%slave)%name, LONGEST_NAME))//' noenhanced'
         data = '"'//GAP_PLOT//'.dat" index '//to_text(int(place - 1, ip))//' using 1:($2/unit) '
         call put_line(file, 'plot '//data//'with filledcurves below y=0 lc rgb "'//COLOUR(2)//'", \')
         call put_line(file, '   '//data//'with linespoints lt 1 lw 1.8 pt 7 ps 0.6*dot lc rgb "'//COLOUR(1)//'" title '//name// &
                       ', \')
         call put_line(file, '   NaN with lines lc rgb "white" title '// &
                       quoted('on '//cleaned(surfaces(it%master)%name, LONGEST_NAME))//' noenhanced, \')
         call put_line(file, '   NaN with lines lc rgb "white" title "'//least_text(model, pair)//'", \')
         call put_line(file, '   NaN with lines lc rgb "white" title "'//points_text(model, pair)//'"')
      end associate
   end subroutine put_pair

   pure function least_text(model, pair) result(text)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: pair
      character(len=:), allocatable :: text
      integer(ip) :: j

      associate (points => model%points(pair))
         text = 'least '//to_text(minval([(gap_of(model, pair, j), j=1, points%n)]), 4)
      end associate
   end function least_text

   !> How many points there are, and how many faces see no master.
   pure function points_text(model, pair) result(text)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: pair
      character(len=:), allocatable :: text

      associate (points => model%points(pair))
         text = to_text(points%n)//' points'
         if (points%n_left_out > 0) text = text//'; '//to_text(points%n_left_out)//' faces alone'
      end associate
   end function points_text

end module atrito_gap_plot
