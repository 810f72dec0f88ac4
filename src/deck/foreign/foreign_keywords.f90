!> Keywords, options and types of elements of other programs that the keyword table does not have: those that change no result of a
!> linear static run, and those that ask for what atrito does not solve. They stand in foreign.txt, which is searched when a name is
!> not in the table. Besides: variables of output in their data lines, and keywords that may have no data lines.
module atrito_foreign_keywords
   use atrito_foreign_lines, only: take_foreign_lines
   use atrito_strings, only: string_t, append_string, begins_with, upper_case
   implicit none (type, external)
   private
   public :: is_foreign_variable, variable_of_component, may_be_empty
   public :: subject_t, ask_keyword, ask_element_type, ask_option, foreign_keywords, take_subjects, subject_named, NOT_FOREIGN, &
             FOREIGN_IGNORED, FOREIGN_OUTSIDE

   !> What is known of a foreign name.
   integer, parameter :: NOT_FOREIGN = 0, FOREIGN_IGNORED = 1, FOREIGN_OUTSIDE = 2

   !> What lies outside, and what to do instead. Subjects are known by their places in the list of all.
   type :: subject_t
      character(len=:), allocatable :: key, what, instead !< short name; what atrito does not do; what to do
      logical :: is_scene = .false.                       !< nothing that is left of such a deck means what it says
   end type subject_t

   !> Keywords that may stand without data lines: preprocessors write them for what the model does not have.
   character(len=18), parameter :: EMPTY(*) = [character(len=18) :: 'BOUNDARY', 'CLOAD', 'DLOAD', 'DSLOAD', 'TEMPERATURE', &
                                 'INITIAL CONDITIONS', 'NODE PRINT', 'EL PRINT', 'NODE FILE', 'EL FILE', 'CONTACT PAIR', 'EQUATION']

contains

   !> All subjects, in the order of the manual.
   pure subroutine take_subjects(subjects)
      type(subject_t), allocatable, intent(out) :: subjects(:) !< (all) their places are known to cards
      type(string_t), allocatable :: lines(:)
      integer :: i, k, first, second, n

      call take_foreign_lines(lines)
      n = count([(begins_with(lines(i)%s, 'subject ') .or. begins_with(lines(i)%s, 'scene '), i=1, size(lines))])
      allocate (subjects(n))
      do i = 1, n                                  ! they stand before all else
         associate (line => lines(i)%s)
            k = index(line, ' ')
            first = index(line, ' | ')
            second = first + 2 + index(line(first + 3:), ' | ')
            subjects(i)%is_scene = line(:k - 1) == 'scene'
            subjects(i)%key = line(k + 1:first - 1)
            subjects(i)%what = line(first + 3:second - 1)
            subjects(i)%instead = line(second + 3:)
         end associate
      end do
   end subroutine take_subjects

   !> The place of a subject; 0: there is none of this key.
   pure integer function subject_named(key) result(place)
      character(len=*), intent(in) :: key !< of a subject, in the letters of the list
      type(string_t), allocatable :: lines(:)

      call take_foreign_lines(lines)
      do place = 1, size(lines)                    ! the subjects stand before all else
         if (begins_with(lines(place)%s, 'subject '//key//' | ') .or. begins_with(lines(place)%s, 'scene '//key//' | ')) return
      end do
      place = 0
   end function subject_named

   !> What is known of a keyword that is not in the table.
   pure subroutine ask_keyword(word, verdict, subject)
      character(len=*), intent(in) :: word         !< in capitals, without blanks
      integer, intent(out) :: verdict              !< NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE
      integer, intent(out) :: subject              !< of FOREIGN_OUTSIDE; else 0
      character(len=:), allocatable :: head
      type(string_t), allocatable :: lines(:)

      verdict = NOT_FOREIGN
      subject = 0
      call take_foreign_lines(lines)
      call look_up(lines, 'ignored keywords', word, head)
      if (allocated(head)) then
         verdict = FOREIGN_IGNORED
         return
      end if
      call look_up(lines, 'keywords ', word, head)
      if (.not. allocated(head)) return
      verdict = FOREIGN_OUTSIDE
      subject = subject_named(head)
   end subroutine ask_keyword

   !> What is known of an option that the table does not have, or of a word that one of the table does not take.
   pure subroutine ask_option(name, verdict, text)
      character(len=*), intent(in) :: name         !< KEYWORD/OPTION or KEYWORD/OPTION=WORD, in capitals, without blanks
      integer, intent(out) :: verdict              !< NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE
      character(len=:), allocatable, intent(out) :: text !< why it has no effect, or what to do instead
      type(string_t), allocatable :: lines(:)

      verdict = FOREIGN_IGNORED
      call take_foreign_lines(lines)
      call look_up(lines, 'without effect: ', name, text)
      if (allocated(text)) return
      verdict = FOREIGN_OUTSIDE
      call look_up(lines, 'instead: ', name, text)
      if (allocated(text)) return
      verdict = NOT_FOREIGN
      text = ''
   end subroutine ask_option

   !> What stands between the kind of a line and its names, of the line that has a name among them; not allocated: there is none.
   pure subroutine look_up(lines, kind, name, head)
      type(string_t), intent(in) :: lines(:)
      character(len=*), intent(in) :: kind, name
      character(len=:), allocatable, intent(out) :: head
      integer :: i, bar

      do i = 1, size(lines)
         if (lines(i)%s(1:1) /= kind(1:1)) cycle   ! no line is empty
         if (.not. begins_with(lines(i)%s, kind)) cycle
         bar = index(lines(i)%s, ' | ')
         if (is_among(name, lines(i)%s(bar + 3:))) head = lines(i)%s(len(kind) + 1:bar - 1)
         if (allocated(head)) return
      end do
   end subroutine look_up

   !> The names of other programs' keywords.
   pure function foreign_keywords(verdict, subject) result(names)
      integer, intent(in) :: verdict               !< FOREIGN_IGNORED, FOREIGN_OUTSIDE
      character(len=*), intent(in), optional :: subject !< of FOREIGN_OUTSIDE those of this key alone
      type(string_t), allocatable :: names(:), lines(:)
      character(len=:), allocatable :: kind
      integer :: i

      allocate (names(0))
      kind = 'keywords '
      if (present(subject)) kind = 'keywords '//subject//' |'
      if (verdict == FOREIGN_IGNORED) kind = 'ignored keywords'
      call take_foreign_lines(lines)
      do i = 1, size(lines)
         if (begins_with(lines(i)%s, kind)) call append_names(lines(i)%s(index(lines(i)%s, ' | ') + 3:), names)
      end do
   end function foreign_keywords

   pure subroutine append_names(list, names)
      character(len=*), intent(in) :: list
      type(string_t), allocatable, intent(inout) :: names(:)
      integer :: first, last

      first = 1
      do while (first <= len(list))
         last = first - 2 + index(list(first:)//',', ',')
         call append_string(names, list(first:last))
         first = last + 3
      end do
   end subroutine append_names

   !> A word is one of the names of a list, blanks apart: letter by letter, since all words of a deck may be unknown.
   pure logical function is_among(word, list)
      character(len=*), intent(in) :: word         !< in capitals, without blanks
      character(len=*), intent(in) :: list         !< a comma between two names

      integer :: i, n                              ! n: letters that the name and the word have in common; -1: it is another

      n = 0
      do i = 1, len(list)
         if (list(i:i) == ',') then
            if (n == len(word)) exit
            n = 0
         else if (n >= 0 .and. list(i:i) /= ' ') then
            n = n + 1
            if (n > len(word)) then
               n = -1
            else if (word(n:n) /= list(i:i)) then
               n = -1
            end if
         end if
      end do
      is_among = n == len(word) .and. n > 0
   end function is_among

   !> The subject of elements of other programs; 0: no program has such a type, as far as is known.
   pure integer function ask_element_type(name) result(subject)
      character(len=*), intent(in) :: name !< in any case
      character(len=:), allocatable :: word, key
      type(string_t), allocatable :: lines(:)
      integer :: n
      logical :: goes_on

      call take_foreign_lines(lines)
      word = trim(upper_case(name))
      key = special_plane_type(word)
      n = len(word)
      if (len(key) > 0) n = 0
      do n = n, 1, -1                              ! the longest beginning counts
         ! Behind one letter or two a number follows, or nothing: `B31`, `S8R`, `D`; not a misspelt name.
         goes_on = len_trim(word) == n .or. n > 2
         if (.not. goes_on) goes_on = scan(word(n + 1:n + 1), '123456789') == 1
         if (.not. goes_on) cycle
         call look_up(lines, 'elements ', word(:n), key)
         if (allocated(key)) exit
      end do
      subject = 0
      if (allocated(key)) subject = subject_named(key)
   end function ask_element_type

   !> Plane and axisymmetric elements with a letter behind their nodes: CPE4H, CPS4I, CAX8RT, CPE6M.
   pure function special_plane_type(word) result(key)
      character(len=*), intent(in) :: word
      character(len=:), allocatable :: key         !< of the subject; '': it is none of these
      integer :: i

      key = ''
      if (len(word) < 5) return
      if (all(word(:3) /= ['CPE', 'CPS', 'CAX']) .or. scan(word(4:4), '3468') == 0) return
      do i = 5, len(word)
         select case (word(i:i))
         case ('H')
            key = 'mixed'
         case ('I', 'M')
            key = 'incompatible'
         case ('T')
            key = 'heat'
         case ('P')
            key = 'porous'
         case ('E')
            key = 'electric'
         case ('R')
         case default
            key = ''
            return
         end select
      end do
   end function special_plane_type

   !> A variable of a request that other programs write, or a component of one: E, E11.
   pure logical function is_foreign_variable(word)
      character(len=*), intent(in) :: word         !< in capitals
      type(string_t), allocatable :: lines(:)
      character(len=:), allocatable :: head
      integer :: digits

      digits = len(word) - verify(word, '123', back=.true.)
      call take_foreign_lines(lines)
      call look_up(lines, 'variables', word, head)
      if (digits <= 2 .and. .not. allocated(head)) call look_up(lines, 'variables', word(:len(word) - digits), head)
      is_foreign_variable = allocated(head)
   end function is_foreign_variable

   !> The variable of which a word is a component in the plane, as Abaqus has it: U of U1, RF of RF2, S of S12; '' of others.
   pure function variable_of_component(word) result(variable)
      character(len=*), intent(in) :: word         !< in capitals
      character(len=:), allocatable :: variable

      select case (word)
      case ('U1', 'U2')
         variable = 'U'
      case ('RF1', 'RF2')
         variable = 'RF'
      case ('S11', 'S22', 'S33', 'S12')
         variable = 'S'
      case default
         variable = ''
      end select
   end function variable_of_component

   !> The keyword may have no data lines.
   pure logical function may_be_empty(keyword)
      character(len=*), intent(in) :: keyword      !< as in the table

      may_be_empty = any(EMPTY == keyword)
   end function may_be_empty

end module atrito_foreign_keywords
