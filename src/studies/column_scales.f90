!> The scales by which numbers of a table are compared: by column, or by a family of columns.
module atrito_column_scales
   use atrito_kinds, only: ip, wp
   use atrito_read_table, only: table_file_t, find_column, item_text, ITEM_INTEGER, ITEM_REAL
   use atrito_strings, only: string_t, append_string
   implicit none (type, external)
   private
   public :: kind_of, columns_of_scale, row_scales, summary_scales, moment_scale, is_of_pair, is_number

   !> Tables that are treated in their own way, and the columns by which they are known; one that is several is the last of them.
   type :: kind_t
      character(len=12) :: name                     !< e.g. 'joints'
      character(len=15) :: columns(3)               !< blank: any
   end type kind_t
   type(kind_t), parameter :: KINDS(12) = [kind_t('summary', ['quantity       ', 'value          ', '               ']), &
                                           kind_t('extremes', ['quantity       ', 'value          ', 'node_or_element']), &
                                           kind_t('resultants', ['keyword        ', 'fx             ', '               ']), &
                                           kind_t('nodal_stress', ['node           ', 'mises          ', '               ']), &
                                           kind_t('iterations', ['outer          ', 'inner          ', '               ']), &
                                           kind_t('timing', ['phase          ', 'wall           ', '               ']), &
                                           kind_t('bodies', ['rotation       ', 'loads_moment   ', '               ']), &
                                           kind_t('rigid', ['ur             ', 'moment         ', '               ']), &
                                           kind_t('joints', ['body_1         ', 'opening        ', '               ']), &
                                           kind_t('sections', ['cut            ', 'v              ', '               ']), &
                                           kind_t('path', ['path           ', 's_along        ', '               ']), &
                                           kind_t('history', ['dissipation    ', 'elastic_energy ', '               '])]

   !> Columns of a kind of table that have one scale: components of one vector, or vectors that balance each other.
   type :: family_t
      character(len=12) :: kind                     !< as kind_of has it
      character(len=80) :: columns                  !< with a blank before and behind each
   end type family_t
   type(family_t), parameter :: &
      FAMILIES(17) = [family_t('bodies', ' u1 u2 '), &
                      family_t('bodies', ' loads_fx loads_fy supports_fx supports_fy contact_fx contact_fy '), &
                      family_t('bodies', ' loads_moment supports_moment contact_moment '), &
                      family_t('history', ' normal_resultant shear_resultant '), &
                      family_t('history', ' contact_length centre '), family_t('rigid', ' u1 u2 '), family_t('rigid', ' r1 r2 '), &
                      family_t('resultants', ' fx fy '), family_t('nodal_stress', ' s11 s22 s33 s12 mises '), &
                      family_t('joints', ' n t '), family_t('joints', ' x y '), family_t('joints', ' opening sliding '), &
                      family_t('sections', ' n v '), family_t('sections', ' x y '), &
                      family_t('path', ' u1 u2 u_along u_across u_r u_t '), family_t('path', ' x y '), &
                      family_t('path', ' s11 s22 s33 s12 mises s1 s2 tresca s_along s_across s_shear s_rr s_tt s_rt ')]

   real(wp), parameter :: MOST_GROUPS = 100000.0_wp  !< pairs and steps that even a table of few rows can have

contains

   !> What a table is, by its columns: a copy may bear any name; `plain` of most.
   pure function kind_of(table) result(kind)
      type(table_file_t), intent(in) :: table       !< its columns are read
      character(len=:), allocatable :: kind
      logical :: is_there(3)
      integer :: i, k

      kind = 'plain'
      do i = 1, size(KINDS)
         is_there = [(KINDS(i)%columns(k) == '' .or. find_column(table, trim(KINDS(i)%columns(k))) > 0, k=1, 3)]
         if (all(is_there)) kind = trim(KINDS(i)%name)
      end do
   end function kind_of

   !> The columns whose largest value is the scale of a column, itself among them.
   pure function columns_of_scale(table, column) result(list)
      type(table_file_t), intent(in) :: table       !< of any kind
      integer(ip), intent(in) :: column             !< from 1
      integer(ip), allocatable :: list(:)
      character(len=:), allocatable :: kind
      logical :: is_related(table%n_columns)
      integer(ip) :: i

      kind = kind_of(table)
      associate (names => table%columns)
         do i = 1, table%n_columns
            is_related(i) = any(FAMILIES%kind == kind .and. index(FAMILIES%columns, ' '//names(column)%s//' ') > 0 .and. &
                                index(FAMILIES%columns, ' '//names(i)%s//' ') > 0)
         end do
         is_related(column) = .true.
         i = find_column(table, 'slip')             ! an increment of the slip has the digits of the slip
         if (names(column)%s == 'slip_increment' .and. i > 0) is_related(i) = .true.
      end associate
      list = pack([(i, i=1, table%n_columns)], is_related)
   end function columns_of_scale

   !> What a moment of joints.tab or history.tab may be as large as: the largest force times the largest coordinate; of sections.tab
   !> the largest force times the largest length of a section. 0 for other columns. A place that is the same within the tolerance
   !> makes a moment that is.
   pure real(wp) function moment_scale(table, column) result(scale)
      type(table_file_t), intent(in) :: table       !< of any kind
      integer(ip), intent(in) :: column             !< from 1

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
      type(table_file_t), intent(in) :: table       !< of any kind
      integer(ip), intent(in) :: column             !< from 1

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
      type(table_file_t), intent(in) :: table       !< of any kind
      integer(ip), intent(in) :: columns(:)         !< of one scale, from 1
      logical, intent(in) :: by_pair                !< of each pair and step; else of all rows
      real(wp) :: scale(table%n_rows)
      integer(ip), allocatable :: pair(:), step(:)
      integer(ip) :: row

      if (.not. by_pair) then
         scale = largest_number(table, columns, 1_ip, table%n_rows)
         return
      end if
      pair = numbers_of_rows(table, 'pair')
      step = numbers_of_rows(table, merge('step', 'none', kind_of(table) /= 'history'))
      ! no run has steps whose pairs have no rows to speak of
      if (real(maxval([pair, 0_ip]), wp)*maxval([step, 0_ip]) > MOST_GROUPS + 10.0_wp*table%n_rows) step = 0
      scale = largest_of_group(pair, step, [(largest_number(table, columns, row, row), row=1, table%n_rows)])
   end function row_scales

   !> The scale of each row of a summary: the largest value of its quantity and pair in any increment; of extremes, the largest
   !> displacement, stress or traction.
   pure function summary_scales(table) result(scale)
      type(table_file_t), intent(in) :: table       !< with a column value: summary or extremes
      real(wp) :: scale(table%n_rows)
      integer(ip) :: row, value

      value = find_column(table, 'value')
      scale = largest_of_group(numbers_of_rows(table, 'pair'), quantities_of_rows(table), &
                               [(largest_number(table, [value], row, row), row=1, table%n_rows)])
   end function summary_scales

   !> For each row the largest size in its group, that is, of the rows that have its two numbers.
   pure function largest_of_group(first, second, sizes) result(scale)
      integer(ip), intent(in) :: first(:), second(:)    !< (rows) numbers, not negative
      real(wp), intent(in) :: sizes(:)                  !< (rows)
      real(wp) :: scale(size(sizes))
      real(wp), allocatable :: largest(:, :)
      integer(ip) :: row

      allocate (largest(0:maxval([first, 0_ip]), 0:maxval([second, 0_ip])), source=0.0_wp)
      do row = 1, size(sizes, kind=ip)
         largest(first(row), second(row)) = max(largest(first(row), second(row)), sizes(row))
      end do
      scale = [(largest(first(row), second(row)), row=1, size(sizes, kind=ip))]
   end function largest_of_group

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
         if (kind_of(table) == 'extremes') then     ! u u1_max ..., contact_pressure ..., or stresses
            if (index(name, 'u') == 1) then
               name = 'u'
            else if (index(name, 'contact') == 1) then
               name = 'contact'
            else
               name = 'stress'
            end if
         end if
         do i = 1, size(names, kind=ip)
            if (names(i)%s == name) exit
         end do
         if (i > size(names)) call append_string(names, name)
         number(row) = i
      end do
   end function quantities_of_rows

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
