!> A table: named columns with dimensions. How it becomes text: atrito_table_text.
module atrito_table
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_model, only: provenance_t
   use atrito_strings, only: string_t, replaced
   use atrito_utf8, only: visible
   implicit none (type, external)
   private
   public :: table_t, column_t, origin_t, begin_table, begin_step_table, add_reals, add_field, add_integers, add_integer_field, &
             add_words, add_real_columns, clear_small, abs_is_below, one_word, TAB_ENDING, CSV_ENDING, HEAD_ENDING
   public :: MARK_NOT_CONVERGED, MARK_COLUMNS, MARK_DIMENSIONS, ZERO_SHARE, KIND_REAL, KIND_INTEGER, KIND_WORD

   character(len=*), parameter :: TAB_ENDING = '.tab', CSV_ENDING = '.csv'   !< of the two forms of a table file
   character(len=*), parameter :: HEAD_ENDING = '.head'     !< of the head of comma-separated values, a file beside them
   character(len=*), parameter :: MARK_NOT_CONVERGED = '# NOT CONVERGED'
   character(len=*), parameter :: MARK_COLUMNS = '# columns:'
   character(len=*), parameter :: MARK_DIMENSIONS = '# dimensions:'
   !> A value below this share of its field's scale is rounding and is written as 0.
   real(wp), parameter :: ZERO_SHARE = 1.0e-14_wp

   integer, parameter :: KIND_REAL = 1, KIND_INTEGER = 2, KIND_WORD = 3   !< of a column

   type :: column_t
      character(len=:), allocatable :: name, dimension !< of one word; in F and L, '-': none
      integer :: kind = KIND_REAL                      !< KIND_*
      real(wp) :: zero = 0.0_wp                        !< smaller values are written as 0
      logical :: on_the_left = .false.                 !< within its field
      integer :: width = 0                             !< characters that its values, its name and its dimension need
      integer :: first = 0, last = 0                   !< its place in a line
      real(wp), allocatable :: reals(:)                !< (n_rows) its own
      real(wp), pointer :: field(:) => null()          !< reals that stay where they are; the table knows which of them
      integer(ip), allocatable :: integers(:)          !< (n_rows), or one for all rows
      integer(ip), pointer :: integer_field(:) => null(), ids(:) => null() !< integers that stay where they are
      type(string_t), allocatable :: words(:)          !< (n_rows) of one word each
   end type column_t

   type :: table_t
      character(len=:), allocatable :: name        !< file name without its ending
      character(len=:), allocatable :: title       !< what a row is
      type(string_t), allocatable :: remarks(:)    !< further comment lines
      integer(ip) :: n_rows = 0                    !< rows
      integer(ip), allocatable :: places(:)        !< of each row in the fields; not allocated: all, in order
      type(column_t), allocatable :: columns(:)    !< in their order
   end type table_t

   !> Where tables come from: the comment lines at their top.
   type, extends(provenance_t) :: origin_t
      character(len=:), allocatable :: deck        !< file name, without folder
      type(string_t), allocatable :: heading(:)    !< lines of *HEADING
      logical :: not_converged = .false.           !< a mark says so at the top
      character(len=:), allocatable :: ending      !< of a history that ended early: where and why
   end type origin_t

contains

   !> Begins a table without columns.
   pure subroutine begin_table(table, name, title, n_rows)
      type(table_t), intent(out) :: table         !< has no columns yet
      character(len=*), intent(in) :: name, title !< of the file, without ending; what a row is
      integer(ip), intent(in) :: n_rows           !< >= 0

      table%name = name
      table%title = title
      table%n_rows = n_rows
      allocate (table%columns(0), table%remarks(0))
   end subroutine begin_table

   !> Begins a table of one increment with the column of its step; that of the increment comes last.
   pure subroutine begin_step_table(table, name, title, n_rows, step)
      type(table_t), intent(out) :: table         !< has one column
      character(len=*), intent(in) :: name, title !< of the file, without ending; what a row is
      integer(ip), intent(in) :: n_rows, step     !< rows, >= 0; number of the step

      call begin_table(table, name, title, n_rows)
      call add_integers(table, 'step', [step])
   end subroutine begin_step_table

   !> Adds a column of reals.
   pure subroutine add_reals(table, name, dimension, values, scale)
      type(table_t), intent(inout) :: table         !< gets one column more
      character(len=*), intent(in) :: name          !< of one word
      character(len=*), intent(in) :: dimension     !< in F and L; '-' for none
      real(wp), intent(in) :: values(:)             !< (n_rows)
      real(wp), intent(in) :: scale                 !< largest value of the field; 0: nothing is rounding
      type(column_t) :: column

      column%kind = KIND_REAL
      column%zero = ZERO_SHARE*scale
      column%reals = values
      call add_column(table, name, dimension, column)
   end subroutine add_reals

   !> Adds columns of reals of which nothing is rounding.
   pure subroutine add_real_columns(table, names, dimensions, values)
      type(table_t), intent(inout) :: table                   !< gets the columns
      character(len=*), intent(in) :: names(:), dimensions(:) !< of each column, blanks at the end apart; in F and L, '-': none
      real(wp), intent(in) :: values(:, :)                    !< (n_rows, columns)
      integer :: i

      do i = 1, size(names)
         call add_reals(table, trim(names(i)), trim(dimensions(i)), values(:, i), 0.0_wp)
      end do
   end subroutine add_real_columns

   !> Adds a column of reals that are not copied but read when the table is written: those at table%places.
   subroutine add_field(table, name, dimension, field, scale)
      type(table_t), intent(inout) :: table           !< gets one column more, which points at the field
      character(len=*), intent(in) :: name, dimension !< of one word; in F and L, '-': none
      real(wp), intent(in), target :: field(:)        !< stays where it is until the table is written
      real(wp), intent(in) :: scale                   !< largest value of the field; 0: nothing is rounding
      type(column_t) :: column

      column%kind = KIND_REAL
      column%zero = ZERO_SHARE*scale
      column%field => field
      call add_column(table, name, dimension, column)
   end subroutine add_field

   !> Adds a column of integers.
   pure subroutine add_integers(table, name, values)
      type(table_t), intent(inout) :: table         !< gets one column more
      character(len=*), intent(in) :: name          !< of one word
      integer(ip), intent(in) :: values(:)          !< (n_rows), or one for all rows
      type(column_t) :: column

      column%kind = KIND_INTEGER
      column%integers = values
      call add_column(table, name, '-', column)
   end subroutine add_integers

   !> Adds a column of integers that are not copied but read when the table is written: those at table%places. With ids they are
   !> places in them, and the ids are written.
   subroutine add_integer_field(table, name, field, ids)
      type(table_t), intent(inout) :: table               !< gets one column more, which points at the field
      character(len=*), intent(in) :: name                !< of one word
      integer(ip), intent(in), target :: field(:)         !< stays where it is until the table is written
      integer(ip), intent(in), target, optional :: ids(:) !< stay where they are, too
      type(column_t) :: column

      column%kind = KIND_INTEGER
      column%integer_field => field
      if (present(ids)) column%ids => ids
      call add_column(table, name, '-', column)
   end subroutine add_integer_field

   !> Adds a column of words; none may be empty or hold a blank.
   pure subroutine add_words(table, name, dimension, values, on_the_left)
      type(table_t), intent(inout) :: table           !< gets one column more
      character(len=*), intent(in) :: name, dimension !< of one word; in F and L, '-': none
      type(string_t), intent(in) :: values(:)         !< (n_rows)
      logical, intent(in) :: on_the_left              !< names; numbers stand on the right
      type(column_t) :: column
      integer :: i

      column%kind = KIND_WORD
      column%on_the_left = on_the_left
      allocate (column%words(size(values)))
      do i = 1, size(values)
         column%words(i)%s = visible(values(i)%s)
      end do
      call add_column(table, name, dimension, column)
   end subroutine add_words

   pure subroutine add_column(table, name, dimension, column)
      type(table_t), intent(inout) :: table
      character(len=*), intent(in) :: name, dimension
      type(column_t), intent(inout) :: column
      type(column_t), allocatable :: longer(:)
      integer :: i, n

      n = size(table%columns)
      allocate (longer(n + 1))
      do i = 1, n
         call move_column(table%columns(i), longer(i))
      end do
      call move_column(column, longer(n + 1))
      longer(n + 1)%name = name
      longer(n + 1)%dimension = dimension
      call move_alloc(longer, table%columns)
   end subroutine add_column

   !> Hands a column on without a copy of its numbers.
   pure subroutine move_column(from, to)
      type(column_t), intent(inout) :: from, to

      to%kind = from%kind
      to%zero = from%zero
      to%on_the_left = from%on_the_left
      to%field => from%field
      to%integer_field => from%integer_field
      to%ids => from%ids
      if (allocated(from%name)) call move_alloc(from%name, to%name)
      if (allocated(from%dimension)) call move_alloc(from%dimension, to%dimension)
      if (allocated(from%reals)) call move_alloc(from%reals, to%reals)
      if (allocated(from%integers)) call move_alloc(from%integers, to%integers)
      if (allocated(from%words)) call move_alloc(from%words, to%words)
   end subroutine move_column

   !> What is rounding in the values of a field becomes 0.
   pure subroutine clear_small(scale, values)
      real(wp), intent(in) :: scale                 !< largest value of the field; 0: nothing is rounding
      real(wp), intent(inout) :: values(:)          !< of one field
      integer(ip) :: i

      do i = 1, size(values, kind=ip)
         if (abs_is_below(values(i), ZERO_SHARE*scale)) values(i) = 0.0_wp
      end do
   end subroutine clear_small

   !> |x| < limit, false for NaN, which must not meet an ordered comparison while invalid operations are trapped.
   pure logical function abs_is_below(x, limit)
      real(wp), intent(in) :: x, limit !< any double; no NaN

      abs_is_below = .false.
      if (.not. is_nan(x)) abs_is_below = abs(x) < limit
   end function abs_is_below

   !> Underscores for blanks and tabs, and for #, which numpy takes for the beginning of a comment.
   pure function one_word(text) result(word)
      character(len=*), intent(in) :: text !< any text
      character(len=len(text)) :: word

      word = replaced(text, ' #'//achar(9), '_')
   end function one_word

end module atrito_table
