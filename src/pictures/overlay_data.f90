!> What the tables of several runs have in common: which of them can be drawn over one another, and over which ranges.
module atrito_overlay_data
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
   use atrito_kinds, only: ip, wp
   use atrito_status, only: status_t, is_ok
   use atrito_read_table, only: comment_of, table_file_t, read_table, table_path, find_column, item_text
   use atrito_plot_text, only: range_t, cover
   use atrito_strings, only: replaced, string_t, to_text
   use atrito_summary, only: quantity_names
   implicit none (type, external)
   private
   public :: overlay_t, overlay_run_t, overlay_pair_t, read_runs, is_logarithmic, field_t, FIELDS, QUANTITIES, LONGEST_LABEL
   public :: FIELD_PRESSURE, FIELD_WEIGHTED, FIELD_SHEAR, FIELD_SLIP, FIELD_GAP

   integer, parameter :: LONGEST_LABEL = 40          !< characters of a run's or a parameter's name
   !> Positive values that span more than this are drawn over a logarithmic axis.
   real(wp), parameter :: LOGARITHMIC = 100.0_wp
   !> A field along s of which a picture has a panel.
   type :: field_t
      character(len=17) :: name                     !< of its column in contact.tab
      character(len=17) :: label                    !< of its panel
      character(len=5) :: dimension                 !< in F and L
      integer(ip) :: column                         !< its place there
   end type field_t
   integer(ip), parameter :: FIELD_PRESSURE = 1, FIELD_WEIGHTED = 2, FIELD_SHEAR = 3, FIELD_SLIP = 4, FIELD_GAP = 5
   type(field_t), parameter :: FIELDS(5) = [field_t('pressure', 'pressure', 'F/L^2', 8), &
                                            field_t('weighted_pressure', 'weighted pressure', 'F/L^2', 9), &
                                            field_t('shear', 'shear', 'F/L^2', 10), field_t('slip', 'slip', 'L', 11), &
                                            field_t('gap', 'gap', 'L', 7)]
   !> A row of summary.tab that is drawn against a parameter.
   type :: quantity_t
      character(len=32) :: name                    !< in the column quantity
      character(len=32) :: label                   !< of its panel
      character(len=5) :: dimension                !< in F and L
   end type quantity_t
   integer, parameter :: MOST_OBSERVED = 4           !< panels of what is observed
   type(quantity_t), parameter :: QUANTITIES(4) = [quantity_t('normal_resultant', 'normal resultant', 'F'), &
                                                   quantity_t('effective_area_percent', 'effective area', '%'), &
                                                   quantity_t('max_pressure', 'max. pressure', 'F/L^2'), &
                                                   quantity_t('max_abs_shear', 'max. |shear|', 'F/L^2')]

   !> A run of a sweep.
   type :: overlay_run_t
      character(len=:), allocatable :: label       !< such as eps=1e-4
      character(len=:), allocatable :: path        !< of its folder, from here
      character(len=:), allocatable :: from_plots  !< of its folder, from the folder of the plots
      real(wp) :: value = 0.0_wp                   !< of the parameter that varies, when there is one
      logical :: has_tables = .false.              !< contact.tab can be read
      logical :: not_converged = .false.           !< its tables say so
      integer(ip) :: step = 1, increment = 1       !< the last of contact.tab, which is drawn
      real(wp), allocatable :: quantity(:, :)      !< (quantities of overlay_t, pairs): of summary.tab; not allocated: none
   end type overlay_run_t

   !> A contact pair over all runs.
   type :: overlay_pair_t
      character(len=:), allocatable :: name        !< `OVER-BOTTOM on SUPPORT-TOP`; empty where no table tells it
      type(range_t) :: s                           !< covers all runs [L]
      type(range_t) :: field(size(FIELDS))         !< of each field, in all runs
      integer(ip) :: most_points = 0               !< of one run
      logical :: has_shear = .false.               !< in one run at least
      logical :: has_weighted = .false.            !< it differs from the pressure in one run at least
   end type overlay_pair_t

   !> What is laid over one another.
   type :: overlay_t
      character(len=:), allocatable :: title       !< heading of the deck; empty where there is none
      logical :: by_value = .false.                !< one parameter varies
      character(len=:), allocatable :: parameter   !< its name, as it can be drawn
      type(overlay_run_t), allocatable :: runs(:)  !< in the order of the sweep
      type(overlay_pair_t), allocatable :: pairs(:) !< in the order of the deck
      type(quantity_t), allocatable :: quantities(:) !< QUANTITIES, and what is observed, which is of no pair
      logical :: is_csv = .false.                  !< the tables are comma-separated values
   end type overlay_t

contains

   !> Positive values that span more than two decades.
   pure logical function is_logarithmic(values)
      real(wp), intent(in) :: values(:)            !< of the parameter, in any order

      is_logarithmic = .false.
      if (size(values) == 0) return
      if (.not. all(ieee_is_finite(values))) return
      if (minval(values) <= 0.0_wp) return
      is_logarithmic = maxval(values)/minval(values) > LOGARITHMIC
   end function is_logarithmic

   !> Reads the tables of all runs. Those of a run that failed are missing, which is no failure here.
   subroutine read_runs(overlay)
      type(overlay_t), intent(inout) :: overlay    !< label, path and value of the runs are given
      type(table_file_t) :: table
      type(status_t) :: status
      integer(ip) :: k
      integer :: i

      allocate (overlay%pairs(0), overlay%quantities(0))
      overlay%title = ''
      do i = 1, size(overlay%runs)
         associate (run => overlay%runs(i))
            call read_table(table_path(run%path, 'contact'), table, status)
            run%has_tables = is_ok(status)
            if (.not. is_ok(status)) cycle
            run%not_converged = table%not_converged
            overlay%is_csv = table%is_csv
            if (len(overlay%title) == 0) overlay%title = comment_of(table%text, 'heading')
            call cover_run(table, run, overlay%pairs)
            do k = 1, size(overlay%pairs, kind=ip)
               overlay%pairs(k)%name = comment_of(table%text, 'pair '//to_text(k))
            end do
            call read_table(table_path(run%path, 'summary'), table, status)
            if (is_ok(status)) call take_quantities(table, overlay%quantities, run)
         end associate
      end do
   end subroutine read_runs

   !> The last increment of a run, and the ranges of the pairs widened by what they have in it.
   subroutine cover_run(table, run, pairs)
      type(table_file_t), intent(in) :: table
      type(overlay_run_t), intent(inout) :: run
      type(overlay_pair_t), allocatable, intent(inout) :: pairs(:)
      integer(ip) :: pair, c(size(FIELDS)), at(4), row, i, n
      integer(ip), allocatable :: n_points(:)

      at = [find_column(table, 'pair'), find_column(table, 's'), find_column(table, 'step'), find_column(table, 'increment')]
      if (table%n_rows == 0 .or. minval(at(3:)) == 0) return
      run%step = nint(table%value(at(3), table%n_rows), ip)
      run%increment = nint(table%value(at(4), table%n_rows), ip)
      do i = 1, size(FIELDS, kind=ip)
         c(i) = find_column(table, trim(FIELDS(i)%name))
      end do
      if (min(minval(at), minval(c)) == 0) return
      n = maxval(nint(table%value(at(1), :), ip))
      if (n > size(pairs)) pairs = [pairs, spread(overlay_pair_t(), 1, n - size(pairs))]
      allocate (n_points(size(pairs)), source=0_ip)
      do row = 1, table%n_rows
         pair = nint(table%value(at(1), row), ip)
         if (pair < 1 .or. any(nint(table%value(at(3:), row), ip) /= [run%step, run%increment])) cycle
         n_points(pair) = n_points(pair) + 1
         associate (it => pairs(pair), values => table%value(c, row))
            call cover(it%s, [table%value(at(2), row)])
            do i = 1, size(FIELDS, kind=ip)
               call cover(it%field(i), [0.0_wp, values(i)])
            end do
            it%has_shear = it%has_shear .or. abs(values(FIELD_SHEAR)) > 0.0_wp
            it%has_weighted = it%has_weighted .or. abs(values(FIELD_WEIGHTED) - values(FIELD_PRESSURE)) > 0.0_wp
         end associate
      end do
      pairs%most_points = max(pairs%most_points, n_points)
   end subroutine cover_run

   !> What a run was asked to observe, the first ones: quantities that not every summary has.
   function observed_quantities(table) result(list)
      type(table_file_t), intent(in) :: table       !< summary
      type(quantity_t), allocatable :: list(:)
      type(string_t), allocatable :: known(:)
      character(len=len(list%name)) :: name
      integer(ip) :: c_name, row
      integer :: i

      allocate (list(0))
      known = quantity_names()
      c_name = find_column(table, 'quantity')
      if (c_name == 0) return
      do row = 1, table%n_rows
         name = item_text(table, c_name, row)
         if (any([(known(i)%s == name, i=1, size(known))]) .or. any(list%name == name)) cycle
         list = [list, quantity_t(name, replaced(name, '_', ' '), '')]
         if (size(list) == MOST_OBSERVED) return
      end do
   end function observed_quantities

   !> The first run says what there is to take.
   subroutine take_quantities(table, list, run)
      type(table_file_t), intent(in) :: table       !< summary
      type(quantity_t), allocatable, intent(inout) :: list(:)
      type(overlay_run_t), intent(inout) :: run
      integer(ip) :: c_pair, c_name, c_value, row, pair, i

      if (size(list) == 0) list = [QUANTITIES, observed_quantities(table)]
      c_pair = find_column(table, 'pair')
      c_name = find_column(table, 'quantity')
      c_value = find_column(table, 'value')
      if (min(c_pair, c_name, c_value) == 0 .or. table%n_rows == 0) return
      allocate (run%quantity(size(list), max(0_ip, maxval(nint(table%value(c_pair, :), ip)))), source=0.0_wp)
      run%quantity(size(QUANTITIES) + 1:, :) = ieee_value(1.0_wp, ieee_quiet_nan)
      do row = 1, table%n_rows
         pair = nint(table%value(c_pair, row), ip)
         i = findloc(list%name == item_text(table, c_name, row), .true., dim=1, kind=ip)
         if (i == 0) cycle
         if (pair > 0) run%quantity(i, pair) = table%value(c_value, row)
         if (pair == 0) run%quantity(i, :) = table%value(c_value, row)
      end do
   end subroutine take_quantities

end module atrito_overlay_data
