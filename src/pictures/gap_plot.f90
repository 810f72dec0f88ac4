!> The picture of the contact pairs before anything is solved: the initial gap along the slave, a panel a pair. Of many pairs those
!> with the least gaps are shown.
module atrito_gap_plot
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: GAP_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_data, end_data, begin_script, end_script, put_terminal, put_frame, &
                                  put_panel, put_plot
   use atrito_plot_text, only: range_t, cover, padded, range_of, quoted, cleaned, scene_title, COLOUR, LF
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: write_gap_plot, has_gap_plot, shown_pairs

   integer(ip), parameter :: MOST_PANELS = 6
   integer, parameter :: DIGITS = 8, LONGEST_NAME = 26
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
      logical, allocatable :: is_left(:)

      allocate (shown(0))
      if (.not. allocated(model%points)) return
      is_left = model%points%n > 0
      allocate (least(size(is_left)), source=huge(1.0_wp))
      do i = 1, size(least, kind=ip)
         if (is_left(i)) least(i) = minval(model%points(i)%gap(:model%points(i)%n))
      end do
      do k = 1, min(MOST_PANELS, count(is_left, kind=ip))
         is_left(minloc(least, dim=1, mask=is_left, kind=ip)) = .false.
      end do
      shown = pack([(i, i=1, size(least, kind=ip))], model%points%n > 0 .and. .not. is_left)
   end function shown_pairs

   !> Writes pairs.dat and pairs.gp.
   subroutine write_gap_plot(plots, model)
      type(plots_t), intent(inout) :: plots
      type(model_t), intent(in) :: model            !< with pairs that have points
      integer(ip), allocatable :: shown(:)
      type(range_t) :: along
      character(len=:), allocatable :: title
      integer(ip) :: i, j

      shown = shown_pairs(model)
      call begin_data(plots, GAP_PLOT, 'initial gaps of the pairs that are drawn; columns: s [L]  gap [L]')
      do i = 1, size(shown, kind=ip)
         call put(plots, '# block '//to_text(i - 1)//': pair '//to_text(shown(i)))
         associate (points => model%points(shown(i)))
            call cover(along, [0.0_wp, points%s(:points%n)])
            do j = 1, points%n
               call put(plots, trimmed_real(points%s(j), DIGITS)//' '//trimmed_real(gap_of(model, shown(i), j), DIGITS))
            end do
         end associate
         call put(plots, LF)
      end do
      call end_data(plots)
      if (along%high <= along%low) along = padded(along)
      call begin_script(plots, GAP_PLOT, 'initial gaps of the contact pairs along s', &
                        'Columns of pairs.dat: 1 s [L], 2 gap [L]; a block a pair')
      call put(plots, 'heading = '//quoted(scene_title(model%deck_path, model%heading)))
      call put_frame(plots, size(shown, kind=ip), along, '"s [L]"')
      call put_terminal(plots, '1000,height')
      title = 'initial gaps, negative where the sides overlap'
      if (size(shown) < size(model%pairs)) title = title//': the '//to_text(size(shown, kind=ip))//' of '// &
                                                   to_text(size(model%pairs, kind=ip))//' pairs with the least'
      call put(plots, 'set style fill transparent solid 0.35 noborder'//LF// &
               'set multiplot title heading."\n'//title//'" noenhanced')
      do i = 1, size(shown, kind=ip)
         call put_pair(plots, model, shown(i), i)
      end do
      call put(plots, 'unset multiplot')
      call end_script(plots)
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

   !> The panel of a pair, in its legend the names, the least gap, the number of points, and how many faces see no master.
   subroutine put_pair(plots, model, pair, place)
      type(plots_t), intent(inout) :: plots
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: pair, place        !< place of the panel, 1 the uppermost
      character(len=*), parameter :: ENTRY = 'NaN with lines lc rgb "white" title '
      type(range_t) :: range
      character(len=:), allocatable :: data, points_text
      real(wp), allocatable :: gaps(:)
      real(wp) :: half
      integer(ip) :: j

      associate (points => model%points(pair), surfaces => model%surfaces, it => model%pairs(pair))
         gaps = [(gap_of(model, pair, j), j=1, points%n)]
         range = range_of([0.0_wp, gaps])
         half = EVEN_SHARE*maxval(abs(points%s(:points%n)))
         if (.not. range%high > range%low) call cover(range, [-half, half])
         call put_panel(plots, place, 'gap', 'L', range)
         data = '"'//GAP_PLOT//'.dat" index '//to_text(place - 1)//' using 1:($2/unit) '
         points_text = to_text(points%n)//' points'
         if (points%n_left_out > 0) points_text = points_text//'; '//to_text(points%n_left_out)//' faces alone'
         call put_plot(plots, [string_t(data//'with filledcurves below y=0 lc rgb "'//COLOUR(2)//'"'), &
                               string_t(data//'with linespoints lt 1 lw 1.8 pt 7 ps 0.6*dot lc rgb "'//COLOUR(1)//'" title '// &
                                        quoted(cleaned(surfaces(it%slave)%name, LONGEST_NAME))//' noenhanced'), &
                               string_t(ENTRY//quoted('on '//cleaned(surfaces(it%master)%name, LONGEST_NAME))//' noenhanced'), &
                               string_t(ENTRY//'"least '//to_text(minval(gaps), 4)//'"'), &
                               string_t(ENTRY//'"'//points_text//'"')])
      end associate
   end subroutine put_pair

end module atrito_gap_plot
