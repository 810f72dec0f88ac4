!> What the program asks of the system: the interfaces of atrito_system.c, where it is said what each routine does.
!>
!> Names with c_ take C strings, which end with c_null_char. Answers that are 0 or 1 are no and yes.
module atrito_system
   use, intrinsic :: iso_c_binding, only: c_char, c_double, c_funptr, c_int, c_int64_t, c_null_char, c_ptr, c_size_t
   implicit none (type, external)
   private
   public :: c_is_folder, c_exists, c_may_hold, c_kind_of, c_kind_in, c_is_plain, c_may_write, c_judge_folder, c_make_folder, &
             c_remove_file, c_remove_folder, c_rename, c_true_path
   public :: c_open_input, c_identify, c_note_input, forget_inputs, c_is_input, &
             c_read_input, c_close_input, c_peek, c_read_system, c_find_name, c_confine
   public :: c_is_terminal, c_terminal_width, c_begin_line, c_set_line, hide_line
   public :: c_create_file, c_write_line, c_write_text, c_close_file, c_settle_file, c_append_line
   public :: c_open_lock, c_close_lock, c_is_lock_of, c_lock_folder
   public :: c_open_nameless, c_place_in_file, c_go_to_place, c_write_bytes, c_read_bytes
   public :: guard_interrupts, hold_interrupts, release_interrupts, note_path, forget_path, guard_exit, release_exit
   public :: terminate, be_rank, forgive_faults
   public :: c_begin_worker, c_end_worker, await_workers, c_run_command, c_share_memory, find_routine
   public :: worker_end, process_number, maker_number, pause_for, get_shared, set_shared, swap_shared
   public :: c_has_address_space, c_count_threads, stack_of_thread, stack_limit
   public :: processor_seconds, peak_memory, address_space_limit, keep_freed_memory, reusable_memory
   public :: c_suspend_halting, c_restore_halting

   abstract interface
      subroutine act() bind(C)
      end subroutine act
      subroutine act_on_path(path) bind(C)
         import :: c_char
         character(kind=c_char), intent(in) :: path(*)
      end subroutine act_on_path
      subroutine take_number(number) bind(C)
         import :: c_int
         integer(c_int), value :: number !< what the routine of C says
      end subroutine take_number
      integer(c_int) function ask() bind(C)
         import :: c_int
      end function ask
      integer(c_int) function ask_path(path) bind(C)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
      end function ask_path
      integer(c_int) function ask_two(one, other) bind(C)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: one(*), other(*)
      end function ask_two
      type(c_ptr) function open_path(path) bind(C)
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*)
      end function open_path
      integer(c_int64_t) function ask_bytes() bind(C)
         import :: c_int64_t
      end function ask_bytes
      integer(c_int) function pass_bytes(file, bytes, length) bind(C)
         import :: c_int, c_ptr, c_size_t
         type(c_ptr), value :: file, bytes  !< as c_create_file or c_open_nameless gave it; where they are
         integer(c_size_t), value :: length !< bytes
      end function pass_bytes
      integer(c_int) function write_to(file, text, length) bind(C)
         import :: c_char, c_int, c_ptr, c_size_t
         type(c_ptr), value :: file         !< as c_create_file gave it
         character(kind=c_char), intent(in) :: text(*)
         integer(c_size_t), value :: length !< bytes
      end function write_to
   end interface

   procedure(ask_path), bind(C, name='atrito_is_folder') :: c_is_folder
   procedure(ask_path), bind(C, name='atrito_may_write') :: c_may_write
   procedure(ask_path), bind(C, name='atrito_judge_folder') :: c_judge_folder
   procedure(act_on_path), bind(C, name='atrito_remove_file') :: c_remove_file
   procedure(act_on_path), bind(C, name='atrito_remove_folder') :: c_remove_folder
   procedure(write_to), bind(C, name='atrito_write_line') :: c_write_line
   procedure(write_to), bind(C, name='atrito_write_text') :: c_write_text
   procedure(pass_bytes), bind(C, name='atrito_write_bytes') :: c_write_bytes
   procedure(pass_bytes), bind(C, name='atrito_read_bytes') :: c_read_bytes
   procedure(ask_path), bind(C, name='atrito_exists') :: c_exists
   procedure(ask_path), bind(C, name='atrito_kind_of') :: c_kind_of
   procedure(ask_path), bind(C, name='atrito_may_hold') :: c_may_hold
   procedure(ask_path), bind(C, name='atrito_is_input') :: c_is_input
   procedure(take_number), bind(C, name='atrito_close_input') :: c_close_input
   procedure(ask_path), bind(C, name='atrito_open_lock') :: c_open_lock
   procedure(ask_path), bind(C, name='atrito_settle_file') :: c_settle_file
   procedure(take_number), bind(C, name='atrito_close_lock') :: c_close_lock
   procedure(take_number), bind(C, name='atrito_guard_interrupts') :: guard_interrupts
   procedure(take_number), bind(C, name='atrito_be_rank') :: be_rank
   procedure(take_number), bind(C, name='atrito_forgive_faults') :: forgive_faults
   procedure(act), bind(C, name='atrito_forget_inputs') :: forget_inputs
   procedure(act), bind(C, name='atrito_hold_interrupts') :: hold_interrupts
   procedure(act), bind(C, name='atrito_release_interrupts') :: release_interrupts
   procedure(act_on_path), bind(C, name='atrito_note_path') :: c_note_path
   procedure(act_on_path), bind(C, name='atrito_forget_path') :: c_forget_path
   procedure(take_number), bind(C, name='atrito_guard_exit') :: guard_exit
   procedure(act), bind(C, name='atrito_release_exit') :: release_exit
   procedure(act), bind(C, name='atrito_terminate') :: terminate
   procedure(ask), bind(C, name='atrito_begin_worker') :: c_begin_worker
   procedure(act), bind(C, name='atrito_end_worker') :: c_end_worker
   procedure(act), bind(C, name='atrito_await_workers') :: await_workers
   procedure(ask), bind(C, name='atrito_process_number') :: process_number
   procedure(ask), bind(C, name='atrito_maker_number') :: maker_number
   procedure(ask_bytes), bind(C, name='atrito_peak_memory') :: peak_memory
   procedure(ask_bytes), bind(C, name='atrito_address_space_limit') :: address_space_limit
   procedure(ask_bytes), bind(C, name='atrito_stack_of_thread') :: stack_of_thread
   procedure(ask_bytes), bind(C, name='atrito_stack_limit') :: stack_limit
   procedure(act), bind(C, name='atrito_keep_freed_memory') :: keep_freed_memory
   !> 1: from now on there is a line of progress on standard error.
   procedure(ask), bind(C, name='atrito_begin_line') :: c_begin_line
   !> It gives way to what is going to be written.
   procedure(act), bind(C, name='atrito_hide_line') :: hide_line
   procedure(ask_bytes), bind(C, name='atrito_reusable_memory') :: reusable_memory
   !> 1: the file has its new name, in one step of the file system; whatever had that name is replaced.
   procedure(ask_two), bind(C, name='atrito_rename') :: c_rename
   !> What a name in a folder is, as c_kind_of tells it of a path.
   procedure(ask_two), bind(C, name='atrito_kind_in') :: c_kind_in
   !> 1: the line is at the end of a plain file, which is made where it is missing; lines of several processes do not mix.
   procedure(ask_two), bind(C, name='atrito_append_line') :: c_append_line
   !> A file that is not there yet, to be written; null: it cannot be made.
   procedure(open_path), bind(C, name='atrito_create_file') :: c_create_file
   !> A file without a name on the disk of a folder, to be written and read, which is gone with the process; null: there is none.
   procedure(open_path), bind(C, name='atrito_open_nameless') :: c_open_nameless

   interface
      !> 1: a file of the process is a terminal.
      integer(c_int) function c_is_terminal(file) bind(C, name='atrito_is_terminal')
         import :: c_int
         integer(c_int), value :: file              !< 1: standard output, 2: standard error
      end function c_is_terminal
      !> Columns of it; 0: not known.
      integer(c_int) function c_terminal_width(file) bind(C, name='atrito_terminal_width')
         import :: c_int
         integer(c_int), value :: file !< as of c_is_terminal
      end function c_terminal_width
      !> What the line of progress says.
      subroutine c_set_line(is_place, text) bind(C, name='atrito_set_line')
         import :: c_char, c_int
         integer(c_int), value :: is_place             !< 1: where the run is; 0: what it does there
         character(kind=c_char), intent(in) :: text(*) !< ends with c_null_char
      end subroutine c_set_line
      !> How many threads there can be beside this one, 0 to most: they are made, and end at once.
      integer(c_int) function c_count_threads(most) bind(C, name='atrito_count_threads')
         import :: c_int
         integer(c_int), value :: most !< that are asked for, >= 0
      end function c_count_threads
      !> How a worker has ended: -1 while it runs; else its exit code, or 128 and the number of the signal that ended it.
      integer(c_int) function worker_end(id) bind(C, name='atrito_worker_end')
         import :: c_int
         integer(c_int), value :: id                !< of c_begin_worker
      end function worker_end
      !> The path without links, `.` and `..`: its length, 0 where there is no such file or its path has more than `room` bytes.
      integer(c_int) function c_true_path(path, resolved, room) bind(C, name='atrito_true_path')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)        !< ends with c_null_char
         character(kind=c_char), intent(inout) :: resolved(*) !< (room) without an end of its own
         integer(c_int), value :: room                        !< bytes that `resolved` has
      end function c_true_path
      !> Reads a small file of the system at once: the number of bytes; -1: it cannot be opened.
      integer(c_int) function c_read_system(path, text, room) bind(C, name='atrito_read_system')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)    !< ends with c_null_char
         character(kind=c_char), intent(inout) :: text(*) !< (room) those bytes come first
         integer(c_int), value :: room                    !< bytes that `text` has
      end function c_read_system
      !> 1: so many bytes of address space can be had now, in one piece.
      integer(c_int) function c_has_address_space(bytes) bind(C, name='atrito_has_address_space')
         import :: c_int, c_int64_t
         integer(c_int64_t), value :: bytes !< that are asked for
      end function c_has_address_space
      !> 1: the folder is new; where is_noted is 1 it is noted then, to be removed if the program is interrupted.
      integer(c_int) function c_make_folder(path, is_noted) bind(C, name='atrito_make_folder')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*) !< ends with c_null_char
         integer(c_int), value :: is_noted             !< 1 or 0
      end function c_make_folder
      !> Opens a file to be read: its descriptor and its length [bytes], or, negative, why it is not opened (atrito_files has the
      !> words).
      integer(c_int) function c_open_input(path, length) bind(C, name='atrito_open_input')
         import :: c_char, c_int, c_int64_t
         character(kind=c_char), intent(in) :: path(*) !< ends with c_null_char
         integer(c_int64_t), intent(inout) :: length   !< >= 0 where the file is open
      end function c_open_input
      !> 1: a text has nothing but printable characters of ASCII.
      pure integer(c_int) function c_is_plain(text, length) bind(C, name='atrito_is_plain')
         import :: c_char, c_int, c_size_t
         character(kind=c_char), intent(in) :: text(*)  !< (length)
         integer(c_size_t), intent(in), value :: length !< bytes of it
      end function c_is_plain
      !> What an open file is, whatever its name: its device and its number there.
      subroutine c_identify(file, identity) bind(C, name='atrito_identify')
         import :: c_int, c_int64_t
         integer(c_int), value :: file                    !< of c_open_input
         integer(c_int64_t), intent(inout) :: identity(2) !< device, number
      end subroutine c_identify
      !> 1: a file, by c_identify, is noted as one of the user: it is not replaced or removed until forget_inputs.
      integer(c_int) function c_note_input(identity) bind(C, name='atrito_note_input')
         import :: c_int, c_int64_t
         integer(c_int64_t), intent(in) :: identity(2) !< of c_identify
      end function c_note_input
      !> 1: so many bytes of an open file were read, from a place on [bytes].
      integer(c_int) function c_read_input(file, text, length, place) bind(C, name='atrito_read_input')
         import :: c_char, c_int, c_int64_t, c_size_t
         integer(c_int), value :: file                    !< of c_open_input
         character(kind=c_char), intent(inout) :: text(*) !< (length)
         integer(c_size_t), value :: length               !< bytes that are read
         integer(c_int64_t), value :: place               !< from 0
      end function c_read_input
      !> The first bytes of a plain file, or the last ones where from_end is 1: how many there are, room at most; -1: it is no plain
      !> file.
      integer(c_int) function c_peek(path, text, room, from_end) bind(C, name='atrito_peek')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)    !< ends with c_null_char
         character(kind=c_char), intent(inout) :: text(*) !< (room)
         integer(c_int), value :: room, from_end          !< bytes that `text` has; 1 or 0
      end function c_peek
      !> The n-th name in a folder that ends so, from 1 on: its length; 0: there is none.
      integer(c_int) function c_find_name(folder, ending, n, name, room) bind(C, name='atrito_find_name')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: folder(*), ending(*) !< both end with c_null_char
         integer(c_int), value :: n, room                           !< which of them; bytes that `name` has
         character(kind=c_char), intent(inout) :: name(*)           !< (room)
      end function c_find_name
      !> From now on files outside of the first folder are not read, and files outside of the second one not written.
      subroutine c_confine(input, output) bind(C, name='atrito_confine')
         import :: c_char
         character(kind=c_char), intent(in) :: input(*), output(*) !< true paths, which end with c_null_char
      end subroutine c_confine
      !> Has the shell run a command and waits for its end: the exit code; 128 and the number of the signal that ended it; 127 where
      !> there is no shell; 124 where it was ended after so many seconds.
      integer(c_int) function c_run_command(command, seconds) bind(C, name='atrito_run_command')
         import :: c_char, c_double, c_int
         character(kind=c_char), intent(in) :: command(*) !< ends with c_null_char
         real(c_double), value :: seconds                 !< after which it is ended
      end function c_run_command
      !> The place that is read or written next [bytes]; -1: it is not known.
      integer(c_int64_t) function c_place_in_file(file) bind(C, name='atrito_place_in_file')
         import :: c_int64_t, c_ptr
         type(c_ptr), value :: file !< as c_open_nameless gave it
      end function c_place_in_file
      !> 1: the file is at the place [bytes], and what was written before is with the system; else the rest of it is given up.
      integer(c_int) function c_go_to_place(file, place) bind(C, name='atrito_go_to_place')
         import :: c_int, c_int64_t, c_ptr
         type(c_ptr), value :: file         !< as c_open_nameless gave it
         integer(c_int64_t), value :: place !< of c_place_in_file
      end function c_go_to_place
      !> 1: the file is closed, and all that was written into it is with the system.
      integer(c_int) function c_close_file(file) bind(C, name='atrito_close_file')
         import :: c_int, c_ptr
         type(c_ptr), value :: file !< of c_create_file or c_open_nameless
      end function c_close_file
      !> 1: the file that was opened is the one that others find in the folder: the run that had it may have removed it.
      integer(c_int) function c_is_lock_of(file, folder) bind(C, name='atrito_is_lock_of')
         import :: c_char, c_int
         integer(c_int), value :: file                   !< of c_open_lock
         character(kind=c_char), intent(in) :: folder(*) !< ends with c_null_char
      end function c_is_lock_of
      !> 1: the folder is locked, or its file system has no locks; 0: others have it still after so many seconds.
      integer(c_int) function c_lock_folder(file, seconds) bind(C, name='atrito_lock_folder')
         import :: c_double, c_int
         integer(c_int), value :: file              !< of c_open_lock
         real(c_double), value :: seconds           !< to wait at the most
      end function c_lock_folder
      !> Does nothing for so many seconds; a signal ends it earlier.
      subroutine pause_for(seconds) bind(C, name='atrito_pause')
         import :: c_double
         real(c_double), value :: seconds !< to wait, >= 0
      end subroutine pause_for
      !> An integer that workers share: what was written before it was set is seen by whoever has read it.
      integer(c_int) function get_shared(number) bind(C, name='atrito_get_shared')
         import :: c_int
         integer(c_int), intent(in) :: number !< one of share_integers
      end function get_shared
      !> Sets an integer that workers share and says what it was: of two that do so at once one alone gets the old value.
      integer(c_int) function swap_shared(number, value) bind(C, name='atrito_swap_shared')
         import :: c_int
         integer(c_int), intent(inout) :: number !< one of share_integers
         integer(c_int), value :: value          !< that it is to have
      end function swap_shared
      !> Sets an integer that workers share, after all that was written before.
      subroutine set_shared(number, value) bind(C, name='atrito_set_shared')
         import :: c_int
         integer(c_int), intent(inout) :: number !< one of share_integers
         integer(c_int), value :: value          !< that it is to have
      end subroutine set_shared
      !> So many bytes of zeros that all workers to come see and change; null: the system has none.
      type(c_ptr) function c_share_memory(bytes) bind(C, name='atrito_share_memory')
         import :: c_ptr, c_size_t
         integer(c_size_t), value :: bytes !< > 0
      end function c_share_memory
      type(c_funptr) function c_find_routine(file, symbol) bind(C, name='atrito_find_routine')
         import :: c_char, c_funptr
         character(kind=c_char), intent(in) :: file(*), symbol(*)
      end function c_find_routine
      !> Processor time of this process and of its children that have ended [s].
      real(c_double) function processor_seconds() bind(C, name='atrito_processor_seconds')
         import :: c_double
      end function processor_seconds
      !> Saves the floating-point environment, in 256 bytes, clears the flags of exceptions and lets none of them halt the program.
      subroutine c_suspend_halting(environment) bind(C, name='atrito_suspend_halting')
         import :: c_int64_t
         integer(c_int64_t), intent(inout) :: environment(*) !< (32), for c_restore_halting
      end subroutine c_suspend_halting
      !> Makes the floating-point environment what it was when it was saved.
      subroutine c_restore_halting(environment) bind(C, name='atrito_restore_halting')
         import :: c_int64_t
         integer(c_int64_t), intent(in) :: environment(*) !< (32) of c_suspend_halting
      end subroutine c_restore_halting
   end interface

contains

   !> A routine of a library by the name of its symbol; null where the library cannot be loaded or has none of that name. The
   !> library stays: asking again costs next to nothing.
   type(c_funptr) function find_routine(file, symbol) result(routine)
      character(len=*), intent(in) :: file, symbol !< of the library; of the routine

      routine = c_find_routine(file//c_null_char, symbol//c_null_char)
   end function find_routine

   !> A file, or a folder that is empty by then, that is to be removed when the program ends before forget_path.
   subroutine note_path(path)
      character(len=*), intent(in) :: path !< of a file or a folder

      call c_note_path(path//c_null_char)
   end subroutine note_path

   !> A path that was noted stays when the program ends.
   subroutine forget_path(path)
      character(len=*), intent(in) :: path !< as note_path was given it

      call c_forget_path(path//c_null_char)
   end subroutine forget_path

end module atrito_system
