!> Files and folders. The only `open` and `close` of the program.
!>
!> Output is written in whole sets: every file of a set first goes to a temporary name beside its final one; when all of them
!> are complete they are renamed together (commit_files), otherwise none is (discard_files).
module atrito_files
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_funptr, c_int, c_intptr_t, c_long, c_null_char, &
                                                                             c_null_funptr, c_null_ptr, c_ptr, c_size_t
   use atrito_interrupts, only: hold_interrupts, release_interrupts, note_file, forget_file, forget_folder
   use atrito_kinds, only: ip, lp
   use atrito_paths, only: file_exists, is_folder, make_folder, remove_folders, remove_file, remove_empty_folder, check_folder
   use atrito_renaming, only: find_obstacle, rename_all, TEMPORARY
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_strings, only: string_t, append_string
   implicit none (type, external)
   private
   public :: read_file, read_system_line, true_path, file_exists, is_folder, make_folder, remove_folders, remove_file, &
             remove_empty_folder, check_folder, ignore_broken_pipe
   public :: file_set_t, text_file_t, begin_files, reserve_file, open_text, put_line, put_lines, close_text, NEW_LINE_CHARACTER
   public :: end_files, commit_files, discard_files

   !> A set of files that appear together or not at all.
   type :: file_set_t
      character(len=:), allocatable :: folder
      type(string_t), allocatable :: names(:)          !< final names, without folder
      type(string_t), allocatable :: made(:)           !< folders that were made for it
   end type file_set_t

   !> A text file being written through a buffer. The run-time library of gfortran does not tell when a full disk keeps a file
   !> from being written, C does: hence fopen, fwrite and fclose.
   type :: text_file_t
      type(c_ptr) :: stream = c_null_ptr
      character(len=:), allocatable :: path            !< temporary path
      character(len=:), allocatable :: final_path      !< for messages
      character(len=:), allocatable :: buffer
      integer :: used = 0
      type(status_t) :: status                         !< first failure; later calls do nothing
   end type text_file_t

   integer, parameter :: BUFFER_LENGTH = 65536
   character(len=1), parameter :: NEW_LINE_CHARACTER = achar(10)
   !> The places in a text are default integers: one of 2 GB is larger than any deck or table.
   integer(lp), parameter :: LARGEST_FILE = 2000000000_lp
   !> A text has no zero byte; of a file with one in its first bytes no more than these is read.
   integer, parameter :: FIRST_BYTES = 65536

   interface
      type(c_ptr) function c_realpath(path, resolved) bind(C, name='realpath')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*)
         character(kind=c_char), intent(out) :: resolved(*)
      end function c_realpath
      integer(c_int) function c_open(path, flags) bind(C, name='open')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: flags
      end function c_open
      integer(c_long) function c_lseek(descriptor, offset, from) bind(C, name='lseek')
         import :: c_int, c_long
         integer(c_int), value :: descriptor, from
         integer(c_long), value :: offset
      end function c_lseek
      integer(c_int) function c_close(descriptor) bind(C, name='close')
         import :: c_int
         integer(c_int), value :: descriptor
      end function c_close
      type(c_ptr) function c_fopen(path, mode) bind(C, name='fopen')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*), mode(*)
      end function c_fopen
      integer(c_size_t) function c_fwrite(text, size, n, stream) bind(C, name='fwrite')
         import :: c_char, c_ptr, c_size_t
         character(kind=c_char), intent(in) :: text(*)
         integer(c_size_t), value :: size, n
         type(c_ptr), value :: stream
      end function c_fwrite
      integer(c_int) function c_fclose(stream) bind(C, name='fclose')
         import :: c_int, c_ptr
         type(c_ptr), value :: stream
      end function c_fclose
      type(c_funptr) function c_signal(number, handler) bind(C, name='signal')
         import :: c_funptr, c_int
         integer(c_int), value :: number
         type(c_funptr), value :: handler
      end function c_signal
   end interface

contains

   !> Reads a whole file into one string; of a file that is no text, its first bytes: they show that it is none.
   !> status: STATUS_FILE when it cannot be read.
   subroutine read_file(path, text, status)
      character(len=*), intent(in) :: path
      character(len=:), allocatable, intent(out) :: text
      type(status_t), intent(out) :: status
      character(len=256) :: reason
      integer :: unit, ios
      integer(lp) :: length

      call judge_file(path, status)
      if (.not. is_ok(status)) return
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=ios, iomsg=reason)
      if (ios /= 0) then
         call set_status(status, STATUS_FILE, path//': cannot be read: '//trim(reason))
         return
      end if
      inquire (unit=unit, size=length)
      call read_text(unit, int(max(0_lp, min(length, LARGEST_FILE))), text, ios, reason)
      close (unit)
      if (ios /= 0) call set_status(status, STATUS_FILE, path//': cannot be read: '//trim(reason))
   end subroutine read_file

   !> A deck must be a plain file: a folder has no text, and a pipe that nobody writes into would never end.
   subroutine judge_file(path, status)
      character(len=*), intent(in) :: path
      type(status_t), intent(out) :: status
      integer(c_int), parameter :: READ_AT_ONCE = 2048_c_int      ! O_RDONLY + O_NONBLOCK of Linux: a pipe does not wait either
      integer(c_int), parameter :: FROM_END = 2_c_int
      integer(c_int) :: descriptor, ignored
      integer(c_long) :: length

      if (is_folder(path)) then
         call set_status(status, STATUS_FILE, path//': is a folder')
         return
      end if
      descriptor = c_open(path//c_null_char, READ_AT_ONCE)
      if (descriptor < 0) return                                  ! the reason is told by the opening that follows
      length = c_lseek(descriptor, 0_c_long, FROM_END)
      ignored = c_close(descriptor)
      if (length < 0) then
         call set_status(status, STATUS_FILE, path//': is a pipe or a terminal; a plain file is expected')
      else if (int(length, lp) > LARGEST_FILE) then
         call set_status(status, STATUS_FILE, path//': is larger than 2 GB')
      end if
   end subroutine judge_file

   subroutine read_text(unit, length, text, ios, reason)
      integer, intent(in) :: unit, length
      character(len=:), allocatable, intent(out) :: text
      integer, intent(out) :: ios
      character(len=*), intent(inout) :: reason
      integer :: first

      first = min(length, FIRST_BYTES)
      allocate (character(len=first) :: text)
      ios = 0
      if (length == 0) return
      read (unit, iostat=ios, iomsg=reason) text
      if (ios /= 0 .or. length == first) return
      if (index(text, achar(0)) > 0) return
      deallocate (text)
      allocate (character(len=length) :: text, stat=ios, errmsg=reason)
      if (ios == 0) read (unit, pos=1, iostat=ios, iomsg=reason) text
   end subroutine read_text

   !> The first line of a file of the system (which has no length) that begins with a label.
   subroutine read_system_line(path, label, line, found)
      character(len=*), intent(in) :: path, label
      character(len=:), allocatable, intent(out) :: line
      logical, intent(out) :: found
      character(len=256) :: buffer
      integer :: unit, ios

      found = .false.
      open (newunit=unit, file=path, status='old', action='read', iostat=ios)
      if (ios /= 0) return
      do
         read (unit, '(a)', iostat=ios) buffer
         if (ios /= 0) exit
         found = index(buffer, label) == 1
         if (found) exit
      end do
      close (unit)
      if (found) line = trim(buffer)
   end subroutine read_system_line

   !> The path of a file without links, `.` and `..`, which is the same for each of its names; `path` itself where there is no
   !> such file.
   function true_path(path) result(true)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: true
      integer, parameter :: LONGEST = 4096                        ! PATH_MAX of Linux; elsewhere it is 1024
      character(len=LONGEST) :: buffer

      true = path
      if (len(path) >= LONGEST) return
      buffer = ' '
      if (c_associated(c_realpath(path//c_null_char, buffer))) true = buffer(:index(buffer, c_null_char) - 1)
   end function true_path

   !> Begins a set of files in a folder, which is made where it is missing.
   subroutine begin_files(set, folder, status)
      type(file_set_t), intent(out) :: set
      character(len=*), intent(in) :: folder
      type(status_t), intent(out) :: status

      set%folder = folder
      allocate (set%names(0))
      call make_folder(folder, status, set%made)
      call ignore_size_limit()
   end subroutine begin_files

   !> A reader of the output that goes away (`| head -1`) shall not end a run: writing to it fails, and nobody minds.
   subroutine ignore_broken_pipe()
      integer(c_int), parameter :: SIGPIPE = 13_c_int             ! Linux and BSD

      call ignore_signal(SIGPIPE)
   end subroutine ignore_broken_pipe

   !> A limit on the size of files (ulimit -f) shall come back from fwrite, as a full disk does, and not end the program.
   subroutine ignore_size_limit()
      integer(c_int), parameter :: SIGXFSZ = 25_c_int             ! Linux and BSD

      call ignore_signal(SIGXFSZ)
   end subroutine ignore_size_limit

   subroutine ignore_signal(number)
      integer(c_int), intent(in) :: number
      integer(c_intptr_t), parameter :: SIG_IGN = 1_c_intptr_t
      type(c_funptr) :: previous

      previous = c_signal(number, transfer(SIG_IGN, c_null_funptr))
   end subroutine ignore_signal

   !> Takes a file into the set that is written by other means, under the temporary path that is given back.
   subroutine reserve_file(set, name, path)
      type(file_set_t), intent(inout) :: set
      character(len=*), intent(in) :: name             !< final name, without folder
      character(len=:), allocatable, intent(out) :: path

      call append_string(set%names, name)
      path = set%folder//'/'//name//TEMPORARY
      call remove_file(path)
      call note_file(path)
   end subroutine reserve_file

   !> Opens a file of the set under its temporary name. A failure is kept in the file until close_text.
   subroutine open_text(set, name, file)
      type(file_set_t), intent(inout) :: set
      character(len=*), intent(in) :: name
      type(text_file_t), intent(out) :: file

      file%final_path = set%folder//'/'//name
      allocate (character(len=BUFFER_LENGTH) :: file%buffer)
      call reserve_file(set, name, file%path)
      file%stream = c_fopen(file%path//c_null_char, 'wb'//c_null_char)
      if (.not. c_associated(file%stream)) call set_status(file%status, STATUS_FILE, file%final_path//': cannot be written')
   end subroutine open_text

   !> Writes a line.
   subroutine put_line(file, line)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: line
      integer :: length

      length = len(line) + 1
      if (file%used + length > BUFFER_LENGTH) call flush_buffer(file)
      if (length > BUFFER_LENGTH) then
         call put_text(file, line//NEW_LINE_CHARACTER)
      else
         file%buffer(file%used + 1:file%used + length - 1) = line
         file%buffer(file%used + length:file%used + length) = NEW_LINE_CHARACTER
         file%used = file%used + length
      end if
   end subroutine put_line

   !> Writes some lines, each of which ends with NEW_LINE_CHARACTER.
   subroutine put_lines(file, lines)
      type(text_file_t), intent(inout) :: file
      character(len=*), contiguous, intent(in) :: lines(:)
      integer(c_size_t) :: written, length

      call flush_buffer(file)
      length = len(lines, kind=c_size_t)*size(lines, kind=c_size_t)
      if (.not. is_ok(file%status) .or. length == 0) return
      written = c_fwrite(lines, 1_c_size_t, length, file%stream)
      if (written /= length) call fail_to_write(file)
   end subroutine put_lines

   subroutine flush_buffer(file)
      type(text_file_t), intent(inout) :: file

      call put_text(file, file%buffer(:file%used))
      file%used = 0
   end subroutine flush_buffer

   subroutine put_text(file, text)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: text
      integer(c_size_t) :: written, length

      length = len(text, kind=c_size_t)
      if (.not. is_ok(file%status) .or. length == 0) return
      written = c_fwrite(text, 1_c_size_t, length, file%stream)
      if (written /= length) call fail_to_write(file)
   end subroutine put_text

   subroutine fail_to_write(file)
      type(text_file_t), intent(inout) :: file

      call set_status(file%status, STATUS_FILE, file%final_path//': cannot be written completely; is the disk full?')
   end subroutine fail_to_write

   !> Completes a file. status: STATUS_FILE when any part of it could not be written.
   subroutine close_text(file, status)
      type(text_file_t), intent(inout) :: file
      type(status_t), intent(out) :: status

      call flush_buffer(file)
      if (c_associated(file%stream)) then
         if (c_fclose(file%stream) /= 0_c_int .and. is_ok(file%status)) call fail_to_write(file)
         file%stream = c_null_ptr
      end if
      status = file%status
   end subroutine close_text

   !> Ends a set: commits it when all went well so far, else discards it.
   subroutine end_files(set, status, stale)
      type(file_set_t), intent(in) :: set
      type(status_t), intent(inout) :: status       !< of writing the files; of the whole set on return
      type(string_t), intent(in), optional :: stale(:)
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
      type(file_set_t), intent(in) :: set
      type(string_t), intent(in) :: stale(:)        !< names without folder
      type(status_t), intent(out) :: status
      integer :: i

      call find_obstacle(set%folder, set%names, stale, status)
      if (is_ok(status)) then
         call hold_interrupts()
         call rename_all(set%folder, set%names, status)
         if (is_ok(status)) then
            do i = 1, size(stale)
               if (is_in(set, stale(i)%s)) cycle
               call remove_file(set%folder//'/'//stale(i)%s)
               call remove_file(set%folder//'/'//stale(i)%s//TEMPORARY)   ! of a run that was killed
            end do
            call keep_files(set)
         end if
         call release_interrupts()
      end if
      if (.not. is_ok(status)) call discard_files(set)
   end subroutine commit_files

   !> The files have their names: they, and their folders, stay.
   subroutine keep_files(set)
      type(file_set_t), intent(in) :: set
      integer :: i

      do i = 1, size(set%names)
         call forget_file(set%folder//'/'//set%names(i)%s//TEMPORARY)
      end do
      if (.not. allocated(set%made)) return
      do i = 1, size(set%made)
         call forget_folder(set%made(i)%s)
      end do
   end subroutine keep_files

   pure logical function is_in(set, name)
      type(file_set_t), intent(in) :: set
      character(len=*), intent(in) :: name
      integer(ip) :: i

      is_in = .false.
      do i = 1, int(size(set%names), ip)
         is_in = is_in .or. set%names(i)%s == name
      end do
   end function is_in

   !> Removes what was written under temporary names, and the folders that were made for it.
   subroutine discard_files(set)
      type(file_set_t), intent(in) :: set
      integer :: i

      if (.not. allocated(set%names)) return
      do i = 1, size(set%names)
         call remove_file(set%folder//'/'//set%names(i)%s//TEMPORARY)
         call forget_file(set%folder//'/'//set%names(i)%s//TEMPORARY)
      end do
      call remove_folders(set%made)
   end subroutine discard_files

end module atrito_files
