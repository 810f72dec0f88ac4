!> Text files, in and out. They are opened by the C library: the `open` of Fortran trims names, and cannot be asked what it opened.
!>
!> Output is written in whole sets: every file of a set first goes to a temporary name beside its final one; when all of them
!> are complete they are renamed together (commit_files), otherwise none is (discard_files).
module atrito_files
   use, intrinsic :: iso_c_binding, only: c_associated, c_int, c_int64_t, c_null_char, c_null_ptr, c_ptr, c_size_t
   use atrito_kinds, only: lp
   use atrito_own_files, only: check_own, check_all_own, check_length, clear_temporary, remove_own_file, TEMPORARY
   use atrito_paths, only: file_exists, is_folder, make_folder, remove_folders, remove_file, remove_empty_folder, check_folder, &
                           true_path, target_path
   use atrito_renaming, only: find_obstacle, replace_files, name_new_files, recover_files
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_system, only: c_open_input, c_identify, c_note_input, forget_inputs, &
                            c_read_input, c_read_system, c_close_input, c_confine, c_create_file, &
                            c_write_line, c_write_text, c_close_file, c_settle_file, &
                            hold_interrupts, release_interrupts, note_path, forget_path
   implicit none (type, external)
   private
   public :: read_file, read_bytes, judge_file, protect_input, forget_inputs, confine_files, read_system_line, read_system_lines, &
             true_path, target_path
   public :: file_exists, is_folder, make_folder, remove_folders, remove_file, remove_own_file, remove_empty_folder, check_folder, &
             check_own, check_all_own, check_length
   public :: file_set_t, text_file_t, begin_files, reserve_file, open_text, put_line, put_lines, put_text, close_text, &
             NEW_LINE_CHARACTER
   public :: end_files, commit_files, commit_over, discard_files

   !> A set of files that appear together or not at all.
   type :: file_set_t
      character(len=:), allocatable :: folder          !< as the user wrote it, without / at its end
      type(string_t), allocatable :: names(:)          !< final names, without folder
      type(string_t), allocatable :: made(:)           !< folders that were made for it
   end type file_set_t

   !> A text file being written. The run-time library of gfortran does not tell when a full disk keeps a file from being written, C
   !> does.
   type :: text_file_t
      type(c_ptr) :: stream = c_null_ptr               !< of c_create_file; null: closed, or never opened
      character(len=:), allocatable :: final_path      !< for messages
      type(status_t) :: status                         !< first failure; later calls do nothing
   end type text_file_t

   character(len=1), parameter :: NEW_LINE_CHARACTER = achar(10)
   !> The places in a text are default integers: one of 2 GB is larger than any deck or table.
   integer(lp), parameter :: LARGEST_FILE = 2000000000_lp
   !> A text has no zero byte; of a file with one in its first bytes no more than these is read.
   integer, parameter :: FIRST_BYTES = 65536
   !> Answers of c_open_input; the reasons for all of them are in tell_unread.
   integer(c_int), parameter :: NOT_THERE = -1, NOT_ALLOWED = -2, IS_FOLDER_CODE = -3, NOT_OPENED = -8
   !> Of a file of the system no more is read: what is asked for stands near its beginning.
   integer, parameter :: LONGEST_SYSTEM_FILE = 65536

contains

   !> Reads a whole file into one string; of a file that is no text, its first bytes: they show that it is none.
   !> status: STATUS_FILE when it cannot be read.
   subroutine read_file(path, text, status, is_plain, identity)
      character(len=*), intent(in) :: path               !< as the user wrote it
      character(len=:), allocatable, intent(out) :: text !< all bytes, ends of lines among them
      type(status_t), intent(out) :: status !< STATUS_FILE where it is not there, not allowed, no plain file or too large
      logical, intent(out), optional :: is_plain     !< .false.: there is something else, or what may not be read
      integer(lp), intent(out), optional :: identity(2)  !< for protect_input

      call read_plain(path, FIRST_BYTES, text, status, is_plain, identity)
   end subroutine read_file

   !> Reads a whole file, whatever its bytes are, one a character. status: STATUS_FILE when it cannot be read.
   subroutine read_bytes(path, bytes, status)
      character(len=*), intent(in) :: path                !< as the user wrote it
      character(len=:), allocatable, intent(out) :: bytes !< one a character; none where the status is not OK
      type(status_t), intent(out) :: status               !< STATUS_FILE where it cannot be read

      call read_plain(path, int(LARGEST_FILE), bytes, status)
   end subroutine read_bytes

   !> Whether a file can be read that is going to be read by other means, and what it is. status: STATUS_FILE where not.
   subroutine judge_file(path, status, identity)
      character(len=*), intent(in) :: path              !< as the user wrote it
      type(status_t), intent(out) :: status             !< STATUS_FILE where it cannot be read
      integer(lp), intent(out), optional :: identity(2) !< device and number, for protect_input; -1: there is no file
      integer(c_int) :: file
      integer(c_int64_t) :: length

      if (present(identity)) identity = -1_lp
      file = c_open_input(path//c_null_char, length)
      if (file < 0) then
         call tell_unread(path, file, status)
         return
      end if
      if (present(identity)) call c_identify(file, identity)
      call c_close_input(file)
   end subroutine judge_file

   !> A file of the user that was read is not replaced or removed from now on, until forget_inputs.
   subroutine protect_input(identity, status)
      integer(lp), intent(in) :: identity(2) !< of read_file or judge_file
      type(status_t), intent(out) :: status  !< STATUS_FILE without memory to note it

      if (c_note_input(identity) == 0) call set_status(status, STATUS_FILE, 'no memory for the files that are read')
   end subroutine protect_input

   !> From now on files below the first folder alone are read, and those of the output, which is written into the second.
   subroutine confine_files(input, output, status)
      character(len=*), intent(in) :: input         !< folder that the user allows to be read
      character(len=*), intent(in) :: output        !< a true path
      type(status_t), intent(out) :: status         !< STATUS_FILE where `input` is no folder

      if (.not. is_folder(input)) call set_status(status, STATUS_FILE, input//': is no folder')
      call c_confine(true_path(input)//c_null_char, output//c_null_char)
   end subroutine confine_files

   !> Reads a file: its first bytes, and where there is no zero among them the others, too.
   subroutine read_plain(path, peek, text, status, is_plain, identity)
      character(len=*), intent(in) :: path
      integer, intent(in) :: peek
      character(len=:), allocatable, intent(out) :: text
      type(status_t), intent(out) :: status
      logical, intent(out), optional :: is_plain
      integer(lp), intent(out), optional :: identity(2)
      integer(c_int) :: file
      integer(c_int64_t) :: length

      file = c_open_input(path//c_null_char, length)
      if (present(is_plain)) is_plain = file >= 0 .or. any(file == [NOT_THERE, NOT_ALLOWED, IS_FOLDER_CODE, NOT_OPENED])
      if (present(identity)) identity = -1_lp
      if (file < 0) then
         call tell_unread(path, file, status)
         return
      end if
      if (present(identity)) call c_identify(file, identity)
      if (length > LARGEST_FILE) then
         call set_status(status, STATUS_FILE, path//': is larger than 2 GB')
      else
         call read_text(int(length), text)
         if (.not. is_ok(status)) call set_status(status, STATUS_FILE, path//': '//status%text)
      end if
      call c_close_input(file)

   contains

      !> status%text says why, without the name of the file.
      subroutine read_text(length, text)
         integer, intent(in) :: length
         character(len=:), allocatable, intent(out) :: text
         integer :: first, state
         logical :: is_read

         first = min(length, peek)
         allocate (character(len=first) :: text)
         is_read = .true.
         if (length > 0) is_read = c_read_input(file, text, int(first, c_size_t), 0_c_int64_t) == 1
         if (is_read .and. length > first .and. index(text, achar(0)) == 0) then
            deallocate (text)
            allocate (character(len=length) :: text, stat=state)
            is_read = state == 0
            if (.not. is_read) call set_status(status, STATUS_FILE, 'cannot be read: there is not enough memory for its '// &
                                               to_text(length)//' bytes')
            if (is_read) is_read = c_read_input(file, text, int(length, c_size_t), 0_c_int64_t) == 1
         end if
         if (is_ok(status) .and. .not. is_read) call set_status(status, STATUS_FILE, 'cannot be read')
      end subroutine read_text

   end subroutine read_plain

   !> What is read must be a plain file: a folder has no text, and a pipe that nobody writes into would never end.
   pure subroutine tell_unread(path, code, status)
      character(len=*), intent(in) :: path
      integer(c_int), intent(in) :: code            !< of c_open_input, < 0
      type(status_t), intent(out) :: status
      character(len=*), parameter :: PLAIN = '; a plain file is expected'
      character(len=60), parameter :: REASONS(8) = [character(len=60) :: 'cannot be read: no such file', &
                                             'cannot be read: permission denied', 'is a folder', 'is a pipe or a terminal'//PLAIN, &
                                                                           'is a device'//PLAIN, 'is a file of the system'//PLAIN, &
                                                                          'is outside of the folder of --confine', 'cannot be read']

      call set_status(status, STATUS_FILE, path//': '//trim(REASONS(min(-code, size(REASONS)))))
   end subroutine tell_unread

   !> The first line of a file of the system (which has no length) that begins with a label.
   subroutine read_system_line(path, label, line, found)
      character(len=*), intent(in) :: path, label        !< of the file; with which the line begins
      character(len=:), allocatable, intent(out) :: line !< with the label; not allocated where there is none
      logical, intent(out) :: found                      !< there is such a line
      character(len=:), allocatable :: text
      integer :: first

      call read_system_text(path, text)
      first = index(text, NEW_LINE_CHARACTER//label) + 1
      found = first > 1 .and. first <= len(text)
      if (found) line = first_line(text(first:))
   end subroutine read_system_line

   !> The lines of such a file; none where it cannot be read.
   subroutine read_system_lines(path, lines)
      character(len=*), intent(in) :: path                 !< of the file, below /proc or /sys
      type(string_t), allocatable, intent(out) :: lines(:) !< without ends of lines
      character(len=:), allocatable :: text
      integer :: first

      allocate (lines(0))
      call read_system_text(path, text)
      first = 2
      do while (first <= len(text))
         call append_string(lines, first_line(text(first:)))
         first = first + len(lines(size(lines))%s) + 1
      end do
   end subroutine read_system_lines

   !> All of such a file, a line's end before its first line; '' where it cannot be read.
   subroutine read_system_text(path, text)
      character(len=*), intent(in) :: path
      character(len=:), allocatable, intent(out) :: text
      character(len=:), allocatable :: buffer
      integer(c_int) :: n

      allocate (character(len=LONGEST_SYSTEM_FILE) :: buffer)
      n = c_read_system(path//c_null_char, buffer, int(LONGEST_SYSTEM_FILE, c_int))
      text = ''
      if (n > 0) text = NEW_LINE_CHARACTER//buffer(:n)
   end subroutine read_system_text

   !> What a text has before the end of its first line.
   pure function first_line(text) result(line)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: line
      integer :: length

      length = index(text, NEW_LINE_CHARACTER) - 1
      line = text(:merge(length, len(text), length >= 0))
   end function first_line

   !> Begins a set of files in a folder, which is made where it is missing. What a run left there that was killed is cleared away.
   subroutine begin_files(set, folder, status)
      type(file_set_t), intent(out) :: set   !< empty, for reserve_file and open_text
      character(len=*), intent(in) :: folder !< as the user wrote it; is made where it is missing
      type(status_t), intent(out) :: status  !< STATUS_FILE where the folder cannot be made

      set%folder = folder
      allocate (set%names(0))
      call make_folder(folder, status, set%made)
      if (is_ok(status)) call recover_files(folder)
   end subroutine begin_files

   !> Takes a file into the set that is written by other means, under the temporary path that is given back.
   subroutine reserve_file(set, name, path)
      type(file_set_t), intent(inout) :: set             !< begun; gets the name
      character(len=*), intent(in) :: name               !< final name, without folder
      character(len=:), allocatable, intent(out) :: path !< where the file is to be written

      call append_string(set%names, name)
      path = set%folder//'/'//name//TEMPORARY
      call clear_temporary(path)
      call note_path(path)
   end subroutine reserve_file

   !> Opens a file of the set under its temporary name. A failure is kept in the file until close_text.
   subroutine open_text(set, name, file)
      type(file_set_t), intent(inout) :: set !< begun; gets the name
      character(len=*), intent(in) :: name   !< final name, without folder
      type(text_file_t), intent(out) :: file !< for put_line and the like; it knows of a failure
      character(len=:), allocatable :: path

      file%final_path = set%folder//'/'//name
      call reserve_file(set, name, path)
      file%stream = c_create_file(path//c_null_char)
      if (.not. c_associated(file%stream)) call set_status(file%status, STATUS_FILE, file%final_path//': cannot be written')
   end subroutine open_text

   !> Writes a line.
   subroutine put_line(file, line)
      type(text_file_t), intent(inout) :: file !< open; knows of a failure afterwards
      character(len=*), intent(in) :: line     !< without end of line

      if (.not. is_ok(file%status)) return
      if (c_write_line(file%stream, line, len(line, kind=c_size_t)) == 0) call fail_to_write(file)
   end subroutine put_line

   !> Writes some lines, each of which ends with NEW_LINE_CHARACTER.
   subroutine put_lines(file, lines)
      type(text_file_t), intent(inout) :: file             !< open; knows of a failure afterwards
      character(len=*), contiguous, intent(in) :: lines(:) !< with the ends of the lines

      call put_characters(file, lines, len(lines, kind=c_size_t)*size(lines, kind=c_size_t))
   end subroutine put_lines

   !> Writes a part of a line, or of many.
   subroutine put_text(file, text)
      type(text_file_t), intent(inout) :: file !< open; knows of a failure afterwards
      character(len=*), intent(in) :: text     !< with ends of lines where they are wanted

      call put_characters(file, text, len(text, kind=c_size_t))
   end subroutine put_text

   !> The one call of c_write_text: where a text and an array of them go to it, gfortran 12 forgets what is passed by value.
   subroutine put_characters(file, text, length)
      type(text_file_t), intent(inout) :: file
      character(len=1), intent(in) :: text(*)
      integer(c_size_t), intent(in) :: length

      if (.not. is_ok(file%status)) return
      if (c_write_text(file%stream, text, length) == 0) call fail_to_write(file)
   end subroutine put_characters

   subroutine fail_to_write(file)
      type(text_file_t), intent(inout) :: file

      call set_status(file%status, STATUS_FILE, file%final_path//': cannot be written completely; is the disk full?')
   end subroutine fail_to_write

   !> Completes a file. status: STATUS_FILE when any part of it could not be written.
   subroutine close_text(file, status)
      type(text_file_t), intent(inout) :: file !< open; is closed in any case
      type(status_t), intent(out) :: status    !< STATUS_FILE where anything failed since open_text

      if (c_associated(file%stream)) then
         if (c_close_file(file%stream) == 0 .and. is_ok(file%status)) call fail_to_write(file)
         file%stream = c_null_ptr
      end if
      status = file%status
   end subroutine close_text

   !> Ends a set: commits it when all went well so far, else discards it.
   subroutine end_files(set, status, stale)
      type(file_set_t), intent(in) :: set              !< all of its files closed
      type(status_t), intent(inout) :: status          !< of writing the files; of the whole set on return
      type(string_t), intent(in), optional :: stale(:) !< final names of former files, without folder
      type(string_t) :: none(0)

      if (.not. is_ok(status)) then
         call discard_files(set)
      else if (present(stale)) then
         call commit_files(set, stale, status)
      else
         call commit_files(set, none, status)
      end if
   end subroutine end_files

   !> Gives all files of the set their final names and removes the stale ones, files of an earlier run that this one does not
   !> write. A signal that would end the program waits until it is done.
   !>
   !> status: STATUS_FILE, and then the folder is as it was.
   subroutine commit_files(set, stale, status)
      type(file_set_t), intent(in) :: set           !< all of its files closed
      type(string_t), intent(in) :: stale(:)        !< names without folder
      type(status_t), intent(out) :: status         !< STATUS_FILE, and then nothing was replaced

      call find_obstacle(set%folder, set%names, stale, status)
      if (is_ok(status)) then
         call hold_interrupts()
         call replace_files(set%folder, set%names, stale, status)
         if (is_ok(status)) call keep_files(set)
         call release_interrupts()
      end if
      if (.not. is_ok(status)) call discard_files(set)
   end subroutine commit_files

   !> Gives each file of the set its final name in one step of the file system: at any moment there is the former file or the
   !> new one under it, also when the process is killed or the power goes. Meant for sets of one file, which holds all that the
   !> former one held, so that this may have been read.
   !>
   !> status: STATUS_FILE, and then the former files are there but for those that were replaced before.
   subroutine commit_over(set, status)
      type(file_set_t), intent(in) :: set   !< all of its files closed
      type(status_t), intent(out) :: status !< STATUS_FILE where a file could not be replaced
      type(string_t) :: none(0)
      integer :: i, done

      call find_obstacle(set%folder, set%names, none, status, may_be_read=.true.)
      if (is_ok(status)) then
         do i = 1, size(set%names)             ! on the disk before they take their names: else a name may outlive its text
            if (c_settle_file(set%folder//'/'//set%names(i)%s//TEMPORARY//c_null_char) == 1) cycle
            call set_status(status, STATUS_FILE, set%folder//'/'//set%names(i)%s//': cannot be written completely; '// &
                            'is the disk full?')
            exit
         end do
      end if
      if (is_ok(status)) then
         call hold_interrupts()
         call name_new_files(set%folder, set%names, done, status)
         if (is_ok(status)) call keep_files(set)
         call release_interrupts()
      end if
      if (.not. is_ok(status)) call discard_files(set)
   end subroutine commit_over

   !> The files have their names: they, and their folders, stay.
   subroutine keep_files(set)
      type(file_set_t), intent(in) :: set
      integer :: i

      do i = 1, size(set%names)
         call forget_path(set%folder//'/'//set%names(i)%s//TEMPORARY)
      end do
      if (.not. allocated(set%made)) return
      do i = 1, size(set%made)
         call forget_path(set%made(i)%s)
      end do
   end subroutine keep_files

   !> Removes what was written under temporary names, and the folders that were made for it.
   subroutine discard_files(set)
      type(file_set_t), intent(in) :: set !< begun or not
      integer :: i

      if (.not. allocated(set%names)) return
      do i = 1, size(set%names)
         call remove_file(set%folder//'/'//set%names(i)%s//TEMPORARY)
         call forget_path(set%folder//'/'//set%names(i)%s//TEMPORARY)
      end do
      call remove_folders(set%made)
   end subroutine discard_files

end module atrito_files
