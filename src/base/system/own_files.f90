!> Which files may be replaced or removed: those that atrito wrote, as their first lines say, and that this run has not read.
!>
!> What a kind of file says stands with the module that writes it; here it is looked for. A link is nobody's table: what it leads to
!> is somebody else's.
module atrito_own_files
   use, intrinsic :: iso_c_binding, only: c_null_char, c_int, c_int64_t, c_size_t
   use atrito_as_run_names, only: as_run_name, mesh_copy_name
   use atrito_digest, only: text_digest_t, add_characters, hexadecimal
   use atrito_kinds, only: ip
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_strings, only: string_t, append_string, begins_with, ends_with
   use atrito_system, only: c_find_name, c_is_input, c_kind_in, c_kind_of, c_peek, c_remove_file, c_close_input, c_open_input, &
                            c_read_input
   implicit none (type, external)
   private
   public :: deck_of_copy, listed_line
   public :: check_own, check_all_own, check_length, check_unread, is_own, remove_own_file, clear_temporary, names_with
   public :: TEMPORARY, FORMER, OWN_MARK, DECK_MARK, MESH_MARK

   !> Endings of a file that is being written, and of one that steps aside for it.
   character(len=*), parameter :: TEMPORARY = '.part', FORMER = '.old'//TEMPORARY
   character(len=*), parameter :: PROGRAM = 'atrito '
   !> With what scripts, data, logs and journals begin: # for most readers the beginning of a comment.
   character(len=*), parameter :: OWN_MARK = '# '//PROGRAM, DECK_MARK = '** '//PROGRAM
   !> What ends the copy of a mesh: a section of Gmsh that nobody reads.
   character(len=*), parameter :: MESH_MARK = '$Comments'//achar(10)//PROGRAM
   character(len=*), parameter :: HDF5_MARK = char(137)//'HDF'//achar(13)//achar(10)//achar(26)//achar(10)
   !> Kinds of files: texts, which say it at their beginning; what says it elsewhere; what belongs to the script of its name. Of the
   !> last two a part that a killed run left may say nothing yet.
   integer, parameter :: IS_OTHER = 0, IS_TEXT = 1, IS_BINARY = 2, IS_PICTURE = 3
   integer, parameter :: NONE = 0, PLAIN = 1, FOLDER = 2               !< answers of c_kind_of
   integer, parameter :: HEAD = 8192, TAIL = 256
   !> Bytes that Linux takes.
   integer, parameter :: LONGEST_NAME = 255, LONGEST_PATH = 4095
   character(len=*), parameter :: WAYS_OUT = 'move it away, or take another folder (-o)'

   !> The first columns of each table, by which a file of comma-separated values is known: it has no comments.
   character(len=40), parameter :: COLUMNS(*) = [ &
                                   character(len=40) :: 'contact:step,pair,point,', 'summary:step,pair,quantity,', &
                                                        'extremes:step,quantity,value,', 'resultants:step,set,keyword,', &
                                             'history:step,increment,time,', 'nodes:step,node,x,y,', 'reactions:step,node,r1,r2,', &
                                            'stress:step,element,point,', 'nodal_stress:step,node,x,y,', 'bodies:step,body,name,', &
                                                    'rigid:step,body,node,', 'joints:step,pair,body_1,', 'sections:step,cut,x,y,', &
                                                 'ties:step,tie,', 'equations:step,equation,node,', 'springs:step,spring,node_1,', &
                                                        'iterations:step,outer,inner,', 'timing:phase,wall,cpu', 'runs:run,', &
                                                        'show-element:matrix,point,row,', 'show-matrix:body,equation,', &
                                                        'show-line:unknown,weight,', 'show-motions:motion,h', &
                                                        'show-states:step,increment,outer,', 'show-law:pair,point,s,overlap,', &
                                                        'show-picard:outer,pair,point,', &
                                           'study:level,element,h,dofs,', 'limit:value,code,', 'mechanism:body,name,x,y,', 'sweep:']

contains

   !> All of some files of a folder, and those with their temporary names. status: STATUS_FILE, of the first that is another's.
   subroutine check_all_own(folder, names, status)
      character(len=*), intent(in) :: folder !< as the user wrote it; need not be there
      type(string_t), intent(in) :: names(:) !< final names, without folder
      type(status_t), intent(out) :: status  !< STATUS_FILE where one of them is not atrito's
      type(string_t), allocatable :: parts(:)
      character(len=:), allocatable :: c_folder
      integer :: i, k

      c_folder = folder//c_null_char
      if (c_kind_of(c_folder) == NONE) return
      do i = 1, size(names)
         if (c_kind_in(c_folder, names(i)%s//c_null_char) == NONE) cycle
         call check_own(folder//'/'//names(i)%s, status)
         if (.not. is_ok(status)) return
      end do
      parts = names_with(folder, TEMPORARY)
      do k = 1, size(parts)
         do i = 1, size(names)
            if (final_name(parts(k)%s) == names(i)%s) call check_own(folder//'/'//parts(k)%s, status)
            if (.not. is_ok(status)) return
         end do
      end do
   end subroutine check_all_own

   !> Whether the system takes the name that a file has before its own, or the one that a former file of its name steps aside to.
   !> status: STATUS_FILE.
   subroutine check_length(folder, name, status)
      character(len=*), intent(in) :: folder, name !< as the user wrote it; final name of the file
      type(status_t), intent(out) :: status        !< STATUS_FILE where name or path is too long
      integer :: length

      length = len(name) + len(TEMPORARY)
      if (c_kind_in(folder//c_null_char, name//c_null_char) /= NONE) length = len(name) + len(FORMER)
      if (length > LONGEST_NAME) then
         call set_status(status, STATUS_FILE, folder//'/'//name//': cannot be written, the name is too long; rename the deck')
      else if (len(folder) + 1 + length > LONGEST_PATH) then
         call set_status(status, STATUS_FILE, folder//'/'//name//': cannot be written, the path is too long; '// &
                         'take another folder (-o)')
      end if
   end subroutine check_length

   !> Names of a folder that end so.
   function names_with(folder, ending) result(names)
      character(len=*), intent(in) :: folder, ending !< of the files; end of a name, not all of it
      type(string_t), allocatable :: names(:)
      character(len=LONGEST_NAME) :: buffer
      integer :: i, length

      allocate (names(0))
      i = 0
      do
         i = i + 1
         length = c_find_name(folder//c_null_char, ending//c_null_char, i, buffer, LONGEST_NAME)
         if (length == 0) return
         call append_string(names, buffer(:length))
      end do
   end function names_with

   !> Whether a file, if there is one, may be replaced or removed. A folder in its place is reported where a file is to be written.
   !>
   !> status: STATUS_FILE, with what to do.
   subroutine check_own(path, status, may_be_read)
      character(len=*), intent(in) :: path         !< of the file, which need not be there
      type(status_t), intent(out) :: status        !< STATUS_FILE where it may not be replaced
      logical, intent(in), optional :: may_be_read !< what takes its place holds all that it held
      integer :: kind

      kind = c_kind_of(path//c_null_char)
      if (kind == NONE .or. kind == FOLDER) return
      call check_unread(path, status, may_be_read)
      if (.not. is_ok(status)) return
      if (kind /= PLAIN) then
         call set_status(status, STATUS_FILE, path//': is a link or no plain file, and would be replaced or removed; '//WAYS_OUT)
      else if (.not. may_go(path)) then
         call set_status(status, STATUS_FILE, path//': was not written by atrito, and would be replaced or removed; '//WAYS_OUT)
      end if
   end subroutine check_own

   !> Whether a file is none that this run has read. status: STATUS_FILE.
   subroutine check_unread(path, status, may_be_read)
      character(len=*), intent(in) :: path          !< of the file, which need not be there
      type(status_t), intent(out) :: status         !< STATUS_FILE where this run has read it
      logical, intent(in), optional :: may_be_read  !< what takes its place holds all that it held

      if (present(may_be_read)) then
         if (may_be_read) return
      end if
      if (c_is_input(path//c_null_char) == 0) return
      call set_status(status, STATUS_FILE, path//': this run reads it, and would replace or remove it; -o names another folder')
   end subroutine check_unread

   !> Removes a file that atrito wrote; another one stays.
   subroutine remove_own_file(path)
      character(len=*), intent(in) :: path !< of the file, which need not be there

      if (c_kind_of(path//c_null_char) /= PLAIN) return
      if (c_is_input(path//c_null_char) == 1) return
      if (is_own(path)) call c_remove_file(path//c_null_char)
   end subroutine remove_own_file

   !> Clears the way for a file that is to be written under its temporary name.
   subroutine clear_temporary(path)
      character(len=*), intent(in) :: path !< of the temporary file, which need not be there

      if (c_kind_of(path//c_null_char) /= PLAIN) return
      if (c_is_input(path//c_null_char) == 1) return
      if (may_go(path)) call c_remove_file(path//c_null_char)
   end subroutine clear_temporary

   !> A file in the place of one that atrito writes is atrito's, or nobody can know.
   logical function may_go(path)
      character(len=*), intent(in) :: path
      integer :: family

      family = class_of(kind_of(path))
      may_go = family == IS_OTHER
      if (family == IS_BINARY .or. family == IS_PICTURE) may_go = ends_with(path, TEMPORARY) .and. .not. ends_with(path, FORMER)
      if (.not. may_go) may_go = is_own(path)
   end function may_go

   !> Which kind of file an ending has.
   pure integer function class_of(ending) result(family)
      character(len=*), intent(in) :: ending

      select case (ending)
      case ('.tab', '.csv', '.head', '.gp', '.dat', '.log', '.journal', '.lst', '.inp', '.xdmf', '.html')
         family = IS_TEXT
      case ('.h5', '.msh')
         family = IS_BINARY
      case ('.bin', '.png', '.svg', '.gif')
         family = IS_PICTURE
      case default
         family = IS_OTHER
      end select
   end function class_of

   !> The name without what it has while it is written.
   pure function final_name(path) result(name)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: name

      name = path
      if (ends_with(name, TEMPORARY)) name = name(:len(name) - len(TEMPORARY))
      if (ends_with(path, FORMER)) name = path(:len(path) - len(FORMER))
   end function final_name

   !> The ending of its final name, with the dot.
   pure function kind_of(path) result(ending)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: ending, name
      integer :: dot

      name = final_name(path)
      name = name(index(name, '/', back=.true.) + 1:)
      dot = index(name, '.', back=.true.)
      ending = '.'
      if (dot > 0) ending = name(dot:)
   end function kind_of

   !> Whether a plain file says that atrito wrote it.
   recursive logical function is_own(path)
      character(len=*), intent(in) :: path !< of the file, under its final or a temporary name
      character(len=HEAD) :: buffer
      character(len=:), allocatable :: name, kind
      integer :: n, family

      is_own = .false.
      kind = kind_of(path)
      family = class_of(kind)
      if (family == IS_OTHER) return
      n = c_peek(path//c_null_char, buffer, HEAD, 0)
      if (n < 0) return
      name = final_name(path)
      name = name(:len(name) - len(kind))
      if (n == 0) then
         is_own = ends_with(path, TEMPORARY)        ! of a run that was killed before it wrote a line
      else if (kind == '.msh') then
         n = c_peek(path//c_null_char, buffer, TAIL, 1)
         is_own = index(buffer(:n), MESH_MARK) > 0
         if (.not. is_own) is_own = is_as_listed(path)
      else if (family == IS_PICTURE) then
         is_own = is_own_script(name//'.gp')
      else
         is_own = says_so(buffer(:n), kind, name(index(name, '/', back=.true.) + 1:))
         if (.not. is_own .and. kind == '.inp') is_own = is_as_listed(path)
      end if
   end function is_own

   !> A deck as run, or the copy of a mesh, without a mark, as an older atrito wrote it: just what the listing beside it tells of.
   recursive logical function is_as_listed(path)
      character(len=*), intent(in) :: path
      character(len=HEAD) :: buffer
      character(len=:), allocatable :: deck, line
      integer :: n, slash

      is_as_listed = .false.
      slash = index(path, '/', back=.true.)
      deck = deck_of_copy(path(slash + 1:))
      if (len(deck) == 0) return
      if (.not. is_own(path(:slash)//deck//'.lst')) return
      n = c_peek(path(:slash)//deck//'.lst'//c_null_char, buffer, HEAD, 0)
      line = listed_line(path(:slash), deck)
      if (n > 0 .and. len(line) > 0) is_as_listed = index(buffer(:n), achar(10)//line//achar(10)) > 0
   end function is_as_listed

   logical function is_own_script(path)
      character(len=*), intent(in) :: path

      is_own_script = c_kind_of(path//c_null_char) == PLAIN
      if (is_own_script) is_own_script = is_own(path)
   end function is_own_script

   !> The first bytes of a file of this kind say that atrito wrote it.
   pure logical function says_so(text, ending, name)
      character(len=*), intent(in) :: text, ending
      character(len=*), intent(in) :: name          !< of a table
      character(len=*), parameter :: LINE_FEED = achar(10)

      select case (ending)
      case ('.tab', '.head')
         says_so = begins_with(text, '# program: '//PROGRAM)
         if (begins_with(text, '# NOT CONVERGED')) says_so = index(text, LINE_FEED//'# program: '//PROGRAM) > 0
      case ('.csv')
         says_so = has_columns(text, name)
      case ('.journal')                             ! the key of a sweep, and what became of a run
         says_so = .false.
         if (len(text) > 23) says_so = verify(text(:16), '0123456789abcdef') == 0 .and. &
                                       (text(17:22) == ' done ' .or. text(17:23) == ' begun ')
      case ('.gp', '.dat', '.log')
         says_so = begins_with(text, OWN_MARK)
      case ('.lst')
         says_so = begins_with(text, repeat('=', 20)) .and. index(text, '='//LINE_FEED//PROGRAM) > 0
      case ('.inp')
         says_so = begins_with(text, DECK_MARK)
      case ('.h5')
         says_so = begins_with(text, HDF5_MARK) .and. index(text, PROGRAM) > 0
      case ('.xdmf')
         says_so = begins_with(text, '<?xml') .and. index(text, '"program" Value="'//PROGRAM) > 0
      case ('.html')
         says_so = begins_with(text, '<!DOCTYPE html>') .and. index(text, 'name="generator" content="'//PROGRAM) > 0
      case default
         says_so = .false.
      end select
   end function says_so

   !> The first row is one of atrito's: its first names, and an end as atrito writes it.
   pure logical function has_columns(text, name)
      character(len=*), intent(in) :: text, name
      integer :: i, last

      has_columns = .false.
      last = index(text, achar(13)//achar(10)) - 1
      if (last < 1) return
      do i = 1, size(COLUMNS)
         if (index(COLUMNS(i), name//':') /= 1) cycle
         has_columns = index(text(:last), trim(COLUMNS(i) (len(name) + 2:))) == 1 .and. index(text(:last), achar(10)) == 0
         ! the parameters that vary stand among them
         if (name == 'sweep') has_columns = index(text(:last), ',step,pair,quantity,') > 0
         if (name == 'runs') has_columns = has_columns .and. index(text(:last), ',exit,factorisations') > 0
      end do
   end function has_columns

   ! Decks as they were run that an older atrito wrote: they do not say so, but the listing beside them has their digest, in
   ! which the copies of meshes are counted, too.

   !> The name of the deck of which a file is a copy, by the file's name: 'a' of 'a.run.inp', 'a.run.msh' and 'a.run-2.msh'; ''
   !> where it has another form.
   pure function deck_of_copy(name) result(deck)
      character(len=*), intent(in) :: name           !< without folder
      character(len=:), allocatable :: deck
      integer :: last

      last = index(name, '.run', back=.true.)
      deck = ''
      if (last < 2) return
      select case (name(last:))
      case ('.run.inp', '.run.msh')
         deck = name(:last - 1)
      case default
         if (index(name(last:), '.run-') == 1 .and. index(name(last:), '.msh') > 0) deck = name(:last - 1)
      end select
   end function deck_of_copy

   !> The line that the listing of a run has of its deck when the files beside it are still as the run wrote them; '' where the deck
   !> cannot be read.
   function listed_line(folder, deck) result(line)
      character(len=*), intent(in) :: folder         !< '' or with a / at its end
      character(len=*), intent(in) :: deck           !< name of the deck, without folder and .inp
      character(len=:), allocatable :: line
      type(text_digest_t) :: digest
      character(len=:), allocatable :: text, mesh, name
      integer(ip) :: n
      integer :: place
      logical :: is_read

      line = ''
      call read_whole(folder//as_run_name(deck), text, is_read)
      if (.not. is_read) return
      ! the names of copies are no part of the deck that was run
      n = 1
      do
         name = mesh_copy_name(deck, n)
         place = index(text, name)
         if (place == 0) exit
         text = text(:place - 1)//text(place + len(name):)
         n = n + 1
      end do
      call add_characters(digest, text)
      do n = 1, n - 1
         call read_whole(folder//mesh_copy_name(deck, n), mesh, is_read)
         if (.not. is_read) return
         call add_characters(digest, mesh)
      end do
      line = 'as run  '//as_run_name(deck)//', digest '//hexadecimal(digest)
   end function listed_line

   subroutine read_whole(path, text, is_read)
      character(len=*), intent(in) :: path
      character(len=:), allocatable, intent(out) :: text
      logical, intent(out) :: is_read
      integer(c_int64_t) :: length
      integer(c_int) :: file
      integer :: state

      length = 0
      file = c_open_input(path//c_null_char, length)
      is_read = file >= 0
      if (.not. is_read) return
      is_read = length <= huge(1)
      state = 0
      if (is_read) allocate (character(len=int(length)) :: text, stat=state)
      is_read = is_read .and. state == 0
      if (is_read .and. length > 0) is_read = c_read_input(file, text, int(length, c_size_t), 0_c_int64_t) == 1
      call c_close_input(file)
   end subroutine read_whole

end module atrito_own_files
