!> A file without a name for what does not fit into the memory for long: values are written one behind the other and read again
!> from a place that was noted. It lies on the disk of a folder and is gone with the process, whatever ends it.
!>
!> The first failure is kept in `is_sound`, after which nothing more is written.
module atrito_spool
   use, intrinsic :: iso_c_binding, only: c_associated, c_loc, c_null_char, c_null_ptr, c_ptr, c_size_t
   use atrito_kinds, only: lp
   use atrito_paths, only: nearest_folder
   use atrito_system, only: c_close_file, c_go_to_place, c_open_nameless, c_place_in_file, c_read_bytes, c_write_bytes
   implicit none (type, external)
   private
   public :: spool_t, open_spool, place_of, go_to, give_up_rest, pass_values, close_spool

   type :: spool_t
      logical :: is_sound = .false.                  !< there is a file, and all that was asked of it so far was done
      type(c_ptr), private :: stream = c_null_ptr    !< of c_open_nameless; null: closed
   end type spool_t

   !> Writes values at the place where the file is, or reads as many from there.
   interface pass_values
      module procedure pass_numbers, pass_text
   end interface pass_values

   integer(c_size_t), parameter :: NUMBER_BYTES = 8_c_size_t     !< of a real and of a long

contains

   !> Opens a file in a folder, or in the nearest one above it that is there. Where that fails, it is not sound.
   subroutine open_spool(folder, spool)
      character(len=*), intent(in) :: folder !< need not be there
      type(spool_t), intent(out) :: spool    !< `is_sound` says whether there is a file

      spool%stream = c_open_nameless(nearest_folder(folder)//c_null_char)
      spool%is_sound = c_associated(spool%stream)
   end subroutine open_spool

   !> Where the file is [bytes].
   integer(lp) function place_of(spool)
      type(spool_t), intent(in) :: spool !< without a file the place is -1

      place_of = -1
      if (c_associated(spool%stream)) place_of = c_place_in_file(spool%stream)
   end function place_of

   !> Goes to a place, before it is read or written there. What was written is with the system then, or the spool not sound.
   subroutine go_to(spool, place)
      type(spool_t), intent(inout) :: spool !< `is_sound` may become false
      integer(lp), intent(in) :: place      !< of place_of [bytes]

      if (spool%is_sound) spool%is_sound = c_go_to_place(spool%stream, place) == 1
   end subroutine go_to

   !> After a failure to write: what was there before it can be read.
   subroutine give_up_rest(spool)
      type(spool_t), intent(inout) :: spool !< becomes sound if it has a file, and is at its beginning
      integer :: done

      if (.not. c_associated(spool%stream)) return
      done = c_go_to_place(spool%stream, 0_lp)
      spool%is_sound = .true.
   end subroutine give_up_rest

   subroutine pass_numbers(spool, is_reading, values)
      type(spool_t), intent(inout) :: spool                   !< goes on behind them
      logical, intent(in) :: is_reading                       !< values are read; else written
      type(*), intent(inout), contiguous, target :: values(:) !< reals or longs

      call move_bytes(spool, is_reading, c_loc(values), NUMBER_BYTES*size(values, kind=c_size_t))
   end subroutine pass_numbers

   subroutine pass_text(spool, is_reading, text)
      type(spool_t), intent(inout) :: spool           !< goes on behind it
      logical, intent(in) :: is_reading               !< the text is read; else written
      character(len=*), intent(inout), target :: text !< of the length that is passed

      call move_bytes(spool, is_reading, c_loc(text), len(text, kind=c_size_t))
   end subroutine pass_text

   subroutine move_bytes(spool, is_reading, bytes, length)
      type(spool_t), intent(inout) :: spool
      logical, intent(in) :: is_reading
      type(c_ptr), intent(in) :: bytes
      integer(c_size_t), intent(in) :: length

      if (.not. spool%is_sound) return
      if (is_reading) then
         spool%is_sound = c_read_bytes(spool%stream, bytes, length) == 1
      else
         spool%is_sound = c_write_bytes(spool%stream, bytes, length) == 1
      end if
   end subroutine move_bytes

   !> Closes the file, which is gone then, and makes the spool as it was before it was opened.
   subroutine close_spool(spool)
      type(spool_t), intent(inout) :: spool !< open or not
      integer :: done

      if (c_associated(spool%stream)) done = c_close_file(spool%stream)
      spool = spool_t()
   end subroutine close_spool

end module atrito_spool
