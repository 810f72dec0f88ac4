!> Runs gnuplot on scripts that stand in a folder. The only place that starts another program.
!>
!> Pictures are an extra: whatever goes wrong here is a warning, W-PLOT, never a failed run.
module atrito_gnuplot
   use atrito_strings, only: string_t, append_string
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_exists, read_file, remove_own_file
   use atrito_messages, only: add_warning
   use atrito_plot_files, only: plot_folder, picture_endings, LOG_NAME
   use atrito_plot_text, only: quoted
   use atrito_kinds, only: wp
   use atrito_own_files, only: OWN_MARK
   use atrito_processes, only: run_command, TOO_LATE
   use atrito_system, only: note_path, forget_path
   implicit none (type, external)
   private
   public :: draw_written, draw_pictures, shell_quoted, plot_command, first_complaint, without_counts

   integer, parameter :: NOT_FOUND = 127            !< the shell's code for a program that is not there
   integer, parameter :: LONGEST_COMPLAINT = 200
   real(wp), parameter :: SECONDS_OF_PICTURE = 120.0_wp
   !> The first line of the log.
   character(len=*), parameter :: LOG_MARK = OWN_MARK//'had gnuplot draw, which said:'

contains

   !> Draws the pictures below the folder of the tables whose scripts were written; those that were not are a warning.
   subroutine draw_written(folder, names, status, drawn)
      character(len=*), intent(in) :: folder                    !< of the tables
      type(string_t), intent(in) :: names(:)                    !< of the scripts, without .gp
      type(status_t), intent(in) :: status                      !< of the scripts
      type(string_t), allocatable, intent(out) :: drawn(:)      !< names of those that have their pictures now

      if (is_ok(status)) then
         call draw_pictures(plot_folder(folder), names, drawn)
      else
         allocate (drawn(0))
         call add_warning('W-PLOT', 'no plots are written: '//status%text)
      end if
   end subroutine draw_written

   !> Draws the pictures of each <name>.gp of a folder. What gnuplot says stays in gnuplot.log beside them; a
   !> failure is one warning. Interrupted, none of these pictures is left.
   subroutine draw_pictures(folder, names, drawn)
      character(len=*), intent(in) :: folder                    !< of the plots
      type(string_t), intent(in) :: names(:)                    !< of the scripts, without .gp
      type(string_t), allocatable, intent(out) :: drawn(:)      !< names of those that have their pictures now
      type(string_t), allocatable :: paths(:)
      integer, allocatable :: of(:)
      integer :: i, k, exit_code, j, last, l, m
      character(len=4), allocatable :: endings(:)

      allocate (drawn(0))
      if (size(names) == 0) return
      ! The files of some pictures, one picture after the other.
      allocate (of(0))
      do l = 1, size(names)
         endings = picture_endings(names(l)%s)
         do m = 1, size(endings)
            call append_string(paths, folder//'/'//names(l)%s//endings(m))
            of = [of, l]
         end do
      end do
      call remove_own_file(folder//'/'//LOG_NAME)
      call note_path(folder//'/'//LOG_NAME)
      do k = 1, size(paths)
         ! Removes old pictures of this name; new ones go when the run is interrupted.
         call remove_own_file(paths(k)%s)
         call note_path(paths(k)%s)
      end do
      call run_command(plot_command(folder, names), SECONDS_OF_PICTURE*real(size(names), wp), exit_code)
      if (exit_code == TOO_LATE) then
         ! Removes the picture that gnuplot had begun last when it was ended: nobody knows how much of it is there.
         last = 0
         do j = 1, size(paths)
            if (file_exists(paths(j)%s)) last = of(j)
         end do
         do j = 1, size(paths)
            if (of(j) >= last) call remove_own_file(paths(j)%s)
         end do
      end if
      do i = 1, size(names)
         if (all([(file_exists(paths(k)%s) .or. of(k) /= i, k=1, size(paths))])) call append_string(drawn, names(i)%s)
      end do
      do k = 1, size(paths)
         call forget_path(paths(k)%s)
      end do
      call forget_path(folder//'/'//LOG_NAME)
      call judge_outcome(folder, exit_code, size(drawn) == size(names))
   end subroutine draw_pictures

   !> The command for the shell. Each script has a gnuplot of its own, so that one that fails does not stop the others; -d: without
   !> the settings that a user may have at home.
   pure function plot_command(folder, names) result(command)
      character(len=*), intent(in) :: folder     !< of the plots
      type(string_t), intent(in) :: names(:)     !< of the scripts, without .gp
      character(len=:), allocatable :: command, path
      integer :: i

      ! a relative path that `cd` cannot take for something else: neither for an option nor for a folder of CDPATH
      path = folder
      if (index(path, '/') /= 1) path = './'//path
      command = 'cd -- '//shell_quoted(path)//' && { echo '//shell_quoted(LOG_MARK)//'; code=0; for name in'
      do i = 1, size(names)
         command = command//' '//shell_quoted(names(i)%s)
      end do
      ! set -C: the log is a new file, not what a link leads to
      command = 'set -C; { '//command//'; do gnuplot -d "$name.gp" || code=$?; done; exit $code; } </dev/null >'//LOG_NAME// &
                ' 2>&1; } 2>/dev/null'
   end function plot_command

   !> A word of the shell, whatever the characters.
   pure function shell_quoted(text) result(word)
      character(len=*), intent(in) :: text       !< a path, or a name
      character(len=:), allocatable :: word

      word = quoted(text, '''\''''')
   end function shell_quoted

   subroutine judge_outcome(folder, exit_code, complete)
      character(len=*), intent(in) :: folder
      integer, intent(in) :: exit_code
      logical, intent(in) :: complete               !< all pictures are there
      character(len=:), allocatable :: text
      character(len=*), parameter :: SCRIPTS = '; the scripts are in '
      type(status_t) :: status

      call read_file(folder//'/'//LOG_NAME, text, status)
      if (.not. is_ok(status)) text = ''
      text = without_counts(text(min(index(text//achar(10), achar(10)), len(text)) + 1:))
      if (len(text) == 0 .or. exit_code == NOT_FOUND) call remove_own_file(folder//'/'//LOG_NAME)
      if (exit_code == NOT_FOUND) then
         call add_warning('W-PLOT', 'gnuplot was not found (Debian: gnuplot-nox), no pictures'//SCRIPTS//folder)
      else if (exit_code == TOO_LATE) then
         call add_warning('W-PLOT', 'gnuplot was ended, it took too long'//SCRIPTS//folder)
      else if (exit_code /= 0 .or. .not. complete) then
         call add_warning('W-PLOT', 'gnuplot failed: '//first_complaint(text)//SCRIPTS//folder)
      end if
   end subroutine judge_outcome

   !> What gnuplot says without its counts of images, which are no complaints.
   pure function without_counts(text) result(rest)
      character(len=*), intent(in) :: text       !< output of gnuplot
      character(len=:), allocatable :: rest
      character(len=*), parameter :: LF = achar(10), COUNTED = ' frames in animation sequence'//LF
      integer :: last, first

      rest = text
      do
         last = index(rest, COUNTED)
         if (last == 0) return
         first = index(rest(:last), LF, back=.true.)
         rest = rest(:first)//rest(last + len(COUNTED):)
      end do
   end function without_counts

   !> The line of gnuplot's output that names the error; the lines before it repeat the script.
   pure function first_complaint(text) result(line)
      character(len=*), intent(in) :: text       !< output of gnuplot
      character(len=:), allocatable :: line, first_line
      integer :: begins, ends

      first_line = ''
      begins = 1
      do while (begins <= len(text))
         ends = index(text(begins:), achar(10))
         ends = merge(len(text), begins + ends - 2, ends == 0)
         line = text(begins:min(ends, begins + LONGEST_COMPLAINT - 1))
         if (index(line, '.gp" line ') > 0) return
         if (len_trim(first_line) == 0) first_line = line
         begins = ends + 2
      end do
      line = first_line
      if (len_trim(line) == 0) line = 'it says nothing'
   end function first_complaint

end module atrito_gnuplot
