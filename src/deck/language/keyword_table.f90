!> The one table of all keywords that the program knows.
module atrito_keyword_table
   use atrito_keyword, only: keyword_t, choice_t, option_spec_t
   use atrito_keyword_lines, only: take_keyword_lines
   use atrito_keyword_reader, only: define_keyword, read_heads, read_keywords
   use atrito_strings, only: string_t, append_string, upper_case
   implicit none (type, external)
   private
   public :: keyword_table, take_table, define_keyword, find_keyword, find_option_spec, find_choice
   public :: keyword_names, option_names, choice_names, packed

contains

   !> The table, in the order of the manual.
   function keyword_table() result(table)
      type(keyword_t), allocatable :: table(:)
      type(string_t), allocatable :: lines(:)
      character(len=:), allocatable :: wrong       ! a unit test asks for it

      call take_keyword_lines(lines)
      call read_keywords(lines, table, wrong)
   end function keyword_table

   !> Its lines, and the keywords by their heads alone.
   subroutine take_table(lines, table)
      type(string_t), allocatable, intent(out) :: lines(:)  !< for define_keyword
      type(keyword_t), allocatable, intent(out) :: table(:) !< in the order of the manual
      character(len=:), allocatable :: wrong

      call take_keyword_lines(lines)
      call read_heads(lines, table, wrong)
   end subroutine take_table

   !> A keyword without its blanks and in capitals: they do not matter (`*ENDSTEP`).
   pure function packed(name) result(word)
      character(len=*), intent(in) :: name !< in any case, with any blanks
      character(len=:), allocatable :: word
      character(len=len(name)) :: capitals
      integer :: i, n

      capitals = upper_case(name)
      n = 0
      do i = 1, len(name)
         if (capitals(i:i) == ' ' .or. capitals(i:i) == achar(9)) cycle
         n = n + 1
         capitals(n:n) = capitals(i:i)
      end do
      word = capitals(:n)
   end function packed

   !> Whether a name of the tables is a word that is packed; quick, without a copy of the name: most differ in the first letters.
   pure logical function is_packed_as(name, word)
      character(len=*), intent(in) :: name, word
      integer :: i, n

      is_packed_as = .false.
      n = 0
      do i = 1, len(name)
         if (name(i:i) == ' ' .or. name(i:i) == achar(9)) cycle
         n = n + 1
         if (n > len(word)) return
         if (name(i:i) == word(n:n)) cycle
         if (upper_case(name(i:i)) /= word(n:n)) return
      end do
      is_packed_as = n == len(word)
   end function is_packed_as

   !> Index of a keyword, 0 when it is unknown.
   pure integer function find_keyword(table, name) result(i)
      type(keyword_t), intent(in) :: table(:) !< the keyword table
      character(len=*), intent(in) :: name    !< in any case, with any blanks
      character(len=:), allocatable :: word

      word = packed(name)
      i = 0
      if (len(word) == 0) return
      do i = size(table), 1, -1
         if (is_packed_as(table(i)%name, word)) return
      end do
   end function find_keyword

   !> Index of an option of a keyword, 0 when it is unknown.
   pure integer function find_option_spec(keyword, name) result(i)
      type(keyword_t), intent(in) :: keyword !< defined
      character(len=*), intent(in) :: name   !< in any case, with any blanks
      character(len=:), allocatable :: word

      word = packed(name)
      do i = size(keyword%options), 1, -1
         if (is_packed_as(keyword%options(i)%name, word)) return
      end do
   end function find_option_spec

   !> Index of a word among choices, 0 when it is none of them.
   pure integer function find_choice(choices, word) result(i)
      type(choice_t), intent(in) :: choices(:) !< of an option or an item
      character(len=*), intent(in) :: word     !< in any case, with any blanks
      character(len=:), allocatable :: wanted

      wanted = packed(word)
      do i = size(choices), 1, -1
         if (is_packed_as(choices(i)%name, wanted)) return
      end do
   end function find_choice

   !> The names of all keywords, for the nearest names in messages.
   pure function keyword_names(table) result(names)
      type(keyword_t), intent(in) :: table(:) !< the keyword table
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(size(table)))
      do i = 1, size(table)
         names(i)%s = table(i)%name
      end do
   end function keyword_names

   !> The names of the options of a keyword that have an effect, for messages.
   pure function option_names(options) result(names)
      type(option_spec_t), intent(in) :: options(:) !< of one keyword, defined
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(options)
         if (.not. options(i)%harmless) call append_string(names, options(i)%name)
      end do
   end function option_names

   !> The words that an option may have in this version, for messages.
   pure function choice_names(choices) result(names)
      type(choice_t), intent(in) :: choices(:) !< of an option or an item
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(choices)
         if (choices(i)%built) call append_string(names, choices(i)%name)
      end do
   end function choice_names

end module atrito_keyword_table
