!> The scales by which numbers of a table are compared: by column, or by a family of columns.
module atrito_column_scales
   use atrito_kinds, only: ip, wp
   use atrito_read_table, only: table_file_t, find_column, ITEM_INTEGER, ITEM_REAL
   implicit none (type, external)
   private
   public :: kind_of, columns_of_scale, largest_number, moment_scale, is_number

   !> Columns that have one scale: components of one vector, or vectors that balance each other.
   character(len=72), parameter :: FAMILIES_OF_BODIES(3) = [character(len=72) :: ' u1 u2 ', &
                                                              ' loads_fx loads_fy supports_fx supports_fy contact_fx contact_fy ', &
                                                                                    ' loads_moment supports_moment contact_moment ']
   character(len=7), parameter :: FAMILIES_OF_RIGID(2) = [' u1 u2 ', ' r1 r2 ']
   character(len=20), parameter :: FAMILIES_OF_JOINTS(3) = [character(len=20) :: ' n t ', ' x y ', ' opening sliding ']

contains

   !> Tables that are treated in their own way, known by their columns: a copy may bear any name.
   pure function kind_of(table) result(kind)
      type(table_file_t), intent(in) :: table
      character(len=:), allocatable :: kind

      kind = 'plain'
      if (find_column(table, 'quantity') > 0 .and. find_column(table, 'value') > 0) kind = 'summary'
      if (find_column(table, 'outer') > 0 .and. find_column(table, 'inner') > 0) kind = 'iterations'
      if (find_column(table, 'phase') > 0 .and. find_column(table, 'wall') > 0) kind = 'timing'
      if (find_column(table, 'rotation') > 0 .and. find_column(table, 'loads_moment') > 0) kind = 'bodies'
      if (find_column(table, 'ur') > 0 .and. find_column(table, 'moment') > 0) kind = 'rigid'
      if (find_column(table, 'body_1') > 0 .and. find_column(table, 'opening') > 0) kind = 'joints'
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
      case ('joints')
         list = pack([(i, i=1, table%n_columns)], [(are_related(FAMILIES_OF_JOINTS, i), i=1, table%n_columns)])
      case default
         list = [column]
      end select

   contains

      pure logical function are_related(families, other)
         character(len=*), intent(in) :: families(:)
         integer(ip), intent(in) :: other           !< a column

         are_related = other == column .or. any(index(families, ' '//table%columns(column)%s//' ') > 0 .and. &
                                                index(families, ' '//table%columns(other)%s//' ') > 0)
      end function are_related

   end function columns_of_scale

   !> What a moment of joints.tab may be as large as: the largest n times the largest coordinate. 0 for other columns. A place that
   !> is the same within the tolerance makes a moment that is.
   pure real(wp) function moment_scale(table, column) result(scale)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: column
      integer(ip) :: n, x

      scale = 0.0_wp
      if (kind_of(table) /= 'joints' .or. table%columns(column)%s /= 'm') return
      n = find_column(table, 'n')
      x = find_column(table, 'x')
      if (n == 0 .or. x == 0) return
      scale = largest_number(table, [n], 1_ip, table%n_rows)* &
              largest_number(table, columns_of_scale(table, x), 1_ip, table%n_rows)
   end function moment_scale

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

   elemental logical function is_number(kind)
      integer, intent(in) :: kind                   !< ITEM_*

      is_number = kind == ITEM_INTEGER .or. kind == ITEM_REAL
   end function is_number

end module atrito_column_scales
