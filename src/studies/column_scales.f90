!> The scales by which numbers of a table are compared: by column, or by a family of columns.
module atrito_column_scales
   use atrito_kinds, only: ip, wp
   use atrito_read_table, only: table_file_t, find_column, item_text, ITEM_INTEGER, ITEM_REAL
   use atrito_strings, only: string_t, append_string
   implicit none (type, external)
   private
   public :: kind_of, columns_of_scale, row_scales, summary_scales, moment_scale, is_of_pair, is_number

   !> Columns that have one scale: components of one vector, or vectors that balance each other.
   character(len=72), parameter :: FAMILIES_OF_BODIES(3) = [character(len=72) :: ' u1 u2 ', &
                                                              ' loads_fx loads_fy supports_fx supports_fy contact_fx contact_fy ', &
                                                                                    ' loads_moment supports_moment contact_moment ']
   character(len=36), parameter :: FAMILIES_OF_HISTORY(2) = [character(len=36) :: ' normal_resultant shear_resultant ', &
                                                                                                          ' contact_length centre ']
   character(len=7), parameter :: FAMILIES_OF_RIGID(2) = [' u1 u2 ', ' r1 r2 ']
   character(len=7), parameter :: FAMILIES_OF_RESULTANTS(1) = [' fx fy ']
   character(len=23), parameter :: FAMILIES_OF_NODAL_STRESS(1) = [' s11 s22 s33 s12 mises ']
   character(len=20), parameter :: FAMILIES_OF_JOINTS(3) = [character(len=20) :: ' n t ', ' x y ', ' opening sliding ']

   character(len=5), parameter :: FAMILIES_OF_SECTIONS(2) = [' n v ', ' x y ']

   real(wp), parameter :: MOST_GROUPS = 100000.0_wp  !< pairs and steps that even a table of few rows can have

contains

   !> Tables that are treated in their own way, known by their columns: a copy may bear any name.
   pure function kind_of(table) result(kind)
      type(table_file_t), intent(in) :: table
      character(len=:), allocatable :: kind

      kind = 'plain'
      if (find_column(table, 'quantity') > 0 .and. find_column(table, 'value') > 0) kind = 'summary'
      if (kind == 'summary' .and. find_column(table, 'node_or_element') > 0) kind = 'extremes'
      if (find_column(table, 'keyword') > 0 .and. find_column(table, 'fx') > 0) kind = 'resultants'
      if (find_column(table, 'node') > 0 .and. find_column(table, 'mises') > 0) kind = 'nodal_stress'
      if (find_column(table, 'outer') > 0 .and. find_column(table, 'inner') > 0) kind = 'iterations'
      if (find_column(table, 'phase') > 0 .and. find_column(table, 'wall') > 0) kind = 'timing'
      if (find_column(table, 'rotation') > 0 .and. find_column(table, 'loads_moment') > 0) kind = 'bodies'
      if (find_column(table, 'ur') > 0 .and. find_column(table, 'moment') > 0) kind = 'rigid'
      if (find_column(table, 'body_1') > 0 .and. find_column(table, 'opening') > 0) kind = 'joints'
      if (find_column(table, 'cut') > 0 .and. find_column(table, 'v') > 0) kind = 'sections'
      if (find_column(table, 'dissipation') > 0 .and. find_column(table, 'elastic_energy') > 0) kind = 'history'
   end function kind_of

   !> The columns whose largest value is the scale of a column, itself among them.
   pure function columns_of_scale(table, column) result(list)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: column
      integer(ip), allocatable :: list(:)
      integer(ip) :: i

      select case (kind_of(table))
      case ('bodies')
         list = pack([(i, i=1, table%n_columns)], [(are_related(FAMILIES_OF_BODIES, i), i=1, table%n_columns)])
      case ('rigid')
         list = pack([(i, i=1, table%n_columns)], [(are_related(FAMILIES_OF_RIGID, i), i=1, table%n_columns)])
      case ('resultants')
         list = pack([(i, i=1, table%n_columns)], [(are_related(FAMILIES_OF_RESULTANTS, i), i=1, table%n_columns)])
      case ('nodal_stress')
         list = pack([(i, i=1, table%n_columns)], [(are_related(FAMILIES_OF_NODAL_STRESS, i), i=1, table%n_columns)])
      case ('joints')
         list = pack([(i, i=1, table%n_columns)], [(are_related(FAMILIES_OF_JOINTS, i), i=1, table%n_columns)])
      case ('sections')
         list = pack([(i, i=1, table%n_columns)], [(are_related(FAMILIES_OF_SECTIONS, i), i=1, table%n_columns)])
      case ('history')
         list = pack([(i, i=1, table%n_columns)], [(are_related(FAMILIES_OF_HISTORY, i), i=1, table%n_columns)])
      case default
         list = [column]
         ! an increment of the slip has the digits of the slip
         i = find_column(table, 'slip')
         if (table%columns(column)%s == 'slip_increment' .and. i > 0) list = [column, i]
      end select

   contains

      pure logical function are_related(families, other)
         character(len=*), intent(in) :: families(:)
         integer(ip), intent(in) :: other           !< a column

         are_related = other == column .or. any(index(families, ' '//table%columns(column)%s//' ') > 0 .and. &
                                                index(families, ' '//table%columns(other)%s//' ') > 0)
      end function are_related

   end function columns_of_scale

   !> What a moment of joints.tab or history.tab may be as large as: the largest force times the largest coordinate; of sections.tab
   !> the largest force times the largest length of a section. 0 for other columns. A place that is the same within the tolerance
   !> makes a moment that is.
   pure real(wp) function moment_scale(table, column) result(scale)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: column

      scale = 0.0_wp
      if (kind_of(table) == 'joints' .and. table%columns(column)%s == 'm') scale = product_of('n', 'x')
      if (kind_of(table) == 'sections' .and. table%columns(column)%s == 'm') then
         scale = max(product_of('n', 'length'), product_of('v', 'length'))
      end if
      if (kind_of(table) == 'history' .and. table%columns(column)%s == 'moment') scale = product_of('normal_resultant', 'centre')

   contains

      pure real(wp) function product_of(force, place)
         character(len=*), intent(in) :: force, place
         integer(ip) :: n, x

         product_of = 0.0_wp
         n = find_column(table, force)
         x = find_column(table, place)
         if (n == 0 .or. x == 0) return
         product_of = largest_number(table, [n], 1_ip, table%n_rows)* &
                      largest_number(table, columns_of_scale(table, x), 1_ip, table%n_rows)
      end function product_of

   end function moment_scale

   !> Whether the scale of a column is that of each contact pair: stresses and slips of a weak pair have digits of their own.
   pure logical function is_of_pair(table, column)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: column

      select case (table%columns(column)%s)
      case ('pressure', 'weighted_pressure', 'shear', 'slip', 'slip_increment')
         is_of_pair = find_column(table, 'pair') > 0
      case ('normal_resultant', 'shear_resultant', 'max_pressure', 'dissipation')
         is_of_pair = kind_of(table) == 'history' .and. find_column(table, 'pair') > 0
      case default
         is_of_pair = .false.
      end select
   end function is_of_pair

   !> The scale of each row of a column: the largest number of all rows in these columns, or of those of its pair and step; in a
   !> history, whose rows are of one pair from its beginning to its end, of its pair.
   pure function row_scales(table, columns, by_pair) result(scale)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: columns(:)
      logical, intent(in) :: by_pair
      real(wp) :: scale(table%n_rows)
      real(wp), allocatable :: largest(:, :)
      integer(ip), allocatable :: pair(:), step(:)
      integer(ip) :: row

      scale = largest_number(table, columns, 1_ip, table%n_rows)
      if (.not. by_pair) return
      pair = numbers_of_rows(table, 'pair')
      step = numbers_of_rows(table, merge('step', 'none', kind_of(table) /= 'history'))
      ! no run has steps whose pairs have no rows to speak of
      if (real(maxval([pair, 0_ip]), wp)*maxval([step, 0_ip]) > MOST_GROUPS + 10.0_wp*table%n_rows) step = 0
      allocate (largest(0:maxval([pair, 0_ip]), 0:maxval([step, 0_ip])), source=0.0_wp)
      do row = 1, table%n_rows
         associate (entry => largest(pair(row), step(row)))
            entry = max(entry, largest_number(table, columns, row, row))
         end associate
      end do
      scale = [(largest(pair(row), step(row)), row=1, table%n_rows)]
   end function row_scales

   !> The scale of each row of a summary: the largest value of its quantity and pair in any increment; of extremes, the largest
   !> displacement, stress or traction.
   pure function summary_scales(table) result(scale)
      type(table_file_t), intent(in) :: table
      real(wp) :: scale(table%n_rows)
      real(wp), allocatable :: largest(:, :)
      integer(ip), allocatable :: pair(:)
      integer(ip) :: quantity(table%n_rows), row, value

      pair = numbers_of_rows(table, 'pair')
      quantity = quantities_of_rows(table)
      value = find_column(table, 'value')
      allocate (largest(maxval([quantity, 0_ip]), 0:maxval([pair, 0_ip])), source=0.0_wp)
      do row = 1, table%n_rows
         associate (entry => largest(quantity(row), pair(row)))
            entry = max(entry, largest_number(table, [value], row, row))
         end associate
      end do
      scale = [(largest(quantity(row), pair(row)), row=1, table%n_rows)]
   end function summary_scales

   !> Each different quantity has a number; those of extremes that are of one field have the same.
   pure function quantities_of_rows(table) result(number)
      type(table_file_t), intent(in) :: table
      integer(ip) :: number(table%n_rows)
      type(string_t), allocatable :: names(:)
      character(len=:), allocatable :: name
      integer(ip) :: column, row, i

      allocate (names(0))
      column = find_column(table, 'quantity')
      do row = 1, table%n_rows
         name = item_text(table, column, row)
         if (kind_of(table) == 'extremes') name = field_of(name)
         do i = 1, size(names, kind=ip)
            if (names(i)%s == name) exit
         end do
         if (i > size(names)) call append_string(names, name)
         number(row) = i
      end do
   end function quantities_of_rows

   !> What a quantity of extremes is one of: u u1_max ..., contact_pressure ..., or stresses.
   pure function field_of(quantity) result(field)
      character(len=*), intent(in) :: quantity
      character(len=:), allocatable :: field

      field = 'stress'
      if (index(quantity, 'u') == 1) field = 'u'
      if (index(quantity, 'contact') == 1) field = 'contact'
   end function field_of

   !> The pair or the step of each row; 0 for all where there is no such column, or none that a run writes.
   pure function numbers_of_rows(table, name) result(number)
      type(table_file_t), intent(in) :: table
      character(len=*), intent(in) :: name
      integer(ip) :: number(table%n_rows)
      integer(ip) :: column
      real(wp) :: most

      number = 0
      column = find_column(table, name)
      if (column == 0) return
      if (.not. all(table%kind(column, :table%n_rows) == ITEM_INTEGER)) return
      most = MOST_GROUPS + 10.0_wp*table%n_rows     ! pairs without points have no rows
      if (any(table%value(column, :table%n_rows) < 0.0_wp .or. table%value(column, :table%n_rows) > most)) return
      number = nint(table%value(column, :table%n_rows), ip)
   end function numbers_of_rows

   !> Largest size of the numbers in some columns, 0 where there is none.
   pure real(wp) function largest_number(table, columns, first, last) result(largest)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: columns(:)
      integer(ip), intent(in) :: first, last        !< rows
      integer(ip) :: row, i

      largest = 0.0_wp
      do row = first, last
         do i = 1, size(columns, kind=ip)
            if (is_number(table%kind(columns(i), row))) largest = max(largest, abs(table%value(columns(i), row)))
         end do
      end do
   end function largest_number

   !> Whether an item of a table is an integer or a real.
   elemental logical function is_number(kind)
      integer, intent(in) :: kind                   !< ITEM_*

      is_number = kind == ITEM_INTEGER .or. kind == ITEM_REAL
   end function is_number

end module atrito_column_scales
