!> An archive of named values (atrito_exchange), which is written or read by the same calls.
!>
!> Values are kept in parts, each of which is three lists in the file (reals, whole numbers, text): some thousands of arrays cost
!> no more than a few. Before each value stands a number that is made of its name and kind, and the extents of arrays, so reading
!> that does not agree with what was written is found at the first value. Reals come back bit by bit. Arrays and strings may be
!> unallocated. The first failure is kept until close_archive; after it reading gives unallocated arrays, zeros and blanks.
!>
!> What the same process reads again goes one value behind the other into a file without a name (spool_archive): nothing of it is
!> gathered first, and a part is what lies between a place and the next.
module atrito_archive
   use atrito_growth, only: growing_text_t, append_text, grow
   use atrito_hdf5, only: hdf5_file_t, create_hdf5, open_hdf5, put_list, get_list, close_hdf5
   use atrito_kinds, only: ip, lp, wp
   use atrito_spool, only: spool_t, open_spool, go_to, pass_values
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   implicit none (type, external)
   private
   public :: archive_t, spool_archive, turn_to, create_archive, open_archive, begin_part, end_part, demand, is_sound, close_archive
   public :: exchange_head, has_enough, pass_longs, pass_reals, pass_text
   public :: NOT_ALLOCATED, IS_REAL, IS_INTEGER, IS_LONG, IS_LOGICAL, IS_TEXT

   !> A file of named values while it is written or read.
   type :: archive_t
      logical :: is_reading = .false.                !< else it is written
      character(len=:), allocatable :: path          !< for messages
      type(status_t) :: status                       !< first failure
      type(hdf5_file_t), private :: file             !< of one that is not spooled
      logical, private :: is_spooled = .false.       !< no file with a name, no parts
      type(spool_t) :: spool                         !< of one that is spooled
      character(len=:), allocatable, private :: part !< path in the file of the part that is open; '': none
      real(wp), allocatable, private :: reals(:)     !< of the part
      integer(lp), allocatable, private :: longs(:)  !< whole numbers, marks and extents of the part
      type(growing_text_t), private :: text          !< letters of the part
      integer(lp), private :: n_reals = 0, n_longs = 0  !< of them written or read so far; of the text text%n
   end type archive_t

   integer(lp), parameter :: SOME = 1024
   !> What stands in the place of an extent of an array or a string that is not allocated.
   integer(lp), parameter :: NOT_ALLOCATED = -1
   !> Kinds of values.
   integer, parameter :: IS_REAL = 1, IS_INTEGER = 2, IS_LONG = 3, IS_LOGICAL = 4, IS_TEXT = 5

contains

   !> Begins an archive that is written into a file. A failure is kept until close_archive.
   subroutine create_archive(path, final_path, archive)
      character(len=*), intent(in) :: path            !< where it is written
      character(len=*), intent(in) :: final_path      !< what messages call it
      type(archive_t), intent(out) :: archive         !< written, no part is open

      archive%path = final_path
      call create_hdf5(path, final_path, .true., archive%file)
      call empty_part(archive)
   end subroutine create_archive

   !> Begins an archive that is read from a file. A failure is kept until close_archive.
   subroutine open_archive(path, archive)
      character(len=*), intent(in) :: path           !< of the file
      type(archive_t), intent(out) :: archive        !< read, no part is open

      archive%is_reading = .true.
      archive%path = path
      call open_hdf5(path, archive%file)
      call empty_part(archive)
   end subroutine open_archive

   !> An archive without a name on the disk of a folder, or of the nearest one above it. Where there can be none it is not sound.
   subroutine spool_archive(folder, archive)
      character(len=*), intent(in) :: folder         !< which need not be there yet
      type(archive_t), intent(out) :: archive        !< written, at its beginning

      archive%is_spooled = .true.
      archive%path = folder
      archive%part = ''
      call open_spool(folder, archive%spool)
      call note_outcome(archive)
   end subroutine spool_archive

   !> From now on what is exchanged is written at a place of a spooled archive [bytes], or read there.
   subroutine turn_to(archive, place, is_reading)
      type(archive_t), intent(inout) :: archive      !< spooled
      integer(lp), intent(in) :: place               !< from 0; where the next value begins [bytes]
      logical, intent(in) :: is_reading              !< else it is written

      archive%is_reading = is_reading
      call go_to(archive%spool, place)
      call note_outcome(archive)
   end subroutine turn_to

   subroutine note_outcome(archive)
      type(archive_t), intent(inout) :: archive

      if (archive%spool%is_sound .or. .not. is_ok(archive%status)) return
      call set_status(archive%status, STATUS_FILE, archive%path//': what was put aside there cannot be written or read')
   end subroutine note_outcome

   subroutine empty_part(archive)
      type(archive_t), intent(inout) :: archive

      archive%part = ''
      archive%n_reals = 0
      archive%n_longs = 0
      archive%text%n = 0
      if (allocated(archive%reals)) return
      allocate (archive%reals(SOME), archive%longs(SOME))
      allocate (character(len=SOME) :: archive%text%letters)
   end subroutine empty_part

   !> All went well so far.
   pure logical function is_sound(archive)
      type(archive_t), intent(in) :: archive         !< of any kind

      is_sound = is_ok(archive%status)
   end function is_sound

   !> Begins a part of the file, /part.
   subroutine begin_part(archive, part)
      type(archive_t), intent(inout) :: archive      !< with a file; no part is open
      character(len=*), intent(in) :: part           !< name without /

      call empty_part(archive)
      archive%part = '/'//part
      if (.not. archive%is_reading) return
      call get_list(archive%file, archive%part//'/reals', archive%reals)
      call get_list(archive%file, archive%part//'/integers', archive%longs)
      call get_list(archive%file, archive%part//'/text', archive%text%letters)
      if (is_ok(archive%status)) archive%status = archive%file%status
      ! no room to hold them: there is nothing, and the first value will be missing
      if (.not. allocated(archive%reals)) allocate (archive%reals(0))
      if (.not. allocated(archive%longs)) allocate (archive%longs(0))
      if (.not. allocated(archive%text%letters)) archive%text%letters = ''
   end subroutine begin_part

   !> Ends a part: writes it, or asks whether all of it was read.
   subroutine end_part(archive)
      type(archive_t), intent(inout) :: archive      !< with a file; its part is complete

      if (archive%is_reading) then
         call demand(archive, archive%n_reals == size(archive%reals) .and. archive%n_longs == size(archive%longs) .and. &
                     archive%text%n == len(archive%text%letters), 'the end')
      else if (is_ok(archive%status)) then
         call put_list(archive%file, archive%part//'/reals', archive%reals(:archive%n_reals))
         call put_list(archive%file, archive%part//'/integers', archive%longs(:archive%n_longs))
         call put_list(archive%file, archive%part//'/text', archive%text%letters(:archive%text%n))
      end if
   end subroutine end_part

   !> What is read must be so; a file in which it is not is damaged.
   subroutine demand(archive, condition, name)
      type(archive_t), intent(inout) :: archive       !< gets the failure, unless it has one
      logical, intent(in) :: condition                !< of a whole file
      character(len=*), intent(in) :: name            !< of the value

      if (condition .or. .not. is_ok(archive%status)) return
      call set_status(archive%status, STATUS_FILE, archive%path//': is damaged: '//archive%part//' has no '//name// &
                      ' of the size that is expected')
   end subroutine demand

   !> Completes an archive. status: STATUS_FILE when any part of it could not be written or read.
   subroutine close_archive(archive, status)
      type(archive_t), intent(inout) :: archive      !< no part is open; the file is closed
      type(status_t), intent(out) :: status          !< STATUS_OK or STATUS_FILE
      type(status_t) :: of_file

      status = archive%status
      call close_hdf5(archive%file, of_file)
      ! what fails in the file makes nothing but failures behind it
      if (.not. is_ok(of_file)) status = of_file
   end subroutine close_archive

   !> A number made of the name and the kind of a value.
   pure integer(lp) function mark_of(name, kind, rank) result(mark)
      character(len=*), intent(in) :: name
      integer, intent(in) :: kind, rank
      integer(lp), parameter :: PRIME = 2147483647_lp, PLACE = 1103515245_lp
      integer :: i

      mark = 10*kind + rank
      do i = 1, len(name)
         mark = modulo(mark*PLACE + iachar(name(i:i)), PRIME)
      end do
   end function mark_of

   !> Writes the mark of a value and its extents, or reads them: the number of its elements, NOT_ALLOCATED where it is not.
   subroutine exchange_head(archive, name, kind, extents, n)
      type(archive_t), intent(inout) :: archive       !< with an open part, or spooled
      character(len=*), intent(in) :: name            !< of the value
      integer, intent(in) :: kind                     !< IS_REAL, IS_LONG, IS_TEXT, ...
      integer(lp), intent(inout) :: extents(:)        !< none: a scalar
      integer(lp), intent(out) :: n                   !< product of the extents; NOT_ALLOCATED
      integer(lp) :: head(0:size(extents)), mark
      integer :: k

      mark = 0                                       ! what the same process wrote is known by its place
      if (.not. archive%is_spooled) mark = mark_of(name, kind, size(extents))
      head(0) = mark
      head(1:) = extents
      call pass_longs(archive, name, head)
      if (archive%is_reading) then
         call demand(archive, head(0) == mark .and. all(head(1:) >= NOT_ALLOCATED), name)
         ! extents that no part of a file can have; the products below are not too large then
         call demand(archive, all(head(1:) <= huge(1_ip)), name)
         if (.not. is_ok(archive%status)) head(1:) = NOT_ALLOCATED
         extents = head(1:)
      end if
      n = 1
      do k = 1, size(extents)
         n = n*extents(k)
      end do
      if (any(extents == NOT_ALLOCATED)) n = NOT_ALLOCATED
      if (archive%is_reading .and. n /= NOT_ALLOCATED) call demand(archive, has_enough(archive, kind, n), name)
      if (.not. is_ok(archive%status)) n = NOT_ALLOCATED
      if (n == NOT_ALLOCATED) extents = NOT_ALLOCATED
   end subroutine exchange_head

   !> The part has so many values more.
   pure logical function has_enough(archive, kind, n)
      type(archive_t), intent(in) :: archive         !< read
      integer, intent(in) :: kind                    !< IS_REAL, IS_TEXT; others are whole numbers
      integer(lp), intent(in) :: n                   !< values, >= 0

      has_enough = archive%is_spooled                 ! its own words are believed
      if (has_enough) return
      select case (kind)
      case (IS_REAL)
         has_enough = n <= size(archive%reals, kind=lp) - archive%n_reals
      case (IS_TEXT)
         has_enough = n <= len(archive%text%letters, kind=lp) - archive%text%n
      case default
         has_enough = n <= size(archive%longs, kind=lp) - archive%n_longs
      end select
   end function has_enough

   !> Writes or reads whole numbers, without a head.
   subroutine pass_longs(archive, name, values)
      type(archive_t), intent(inout) :: archive      !< with an open part, or spooled
      character(len=*), intent(in) :: name           !< of the value, for messages
      integer(lp), intent(inout) :: values(:)        !< what is written; read: 0 after a failure
      integer(lp) :: next

      if (archive%is_spooled) then
         call pass_values(archive%spool, archive%is_reading, values)
         call note_outcome(archive)
         if (.not. is_ok(archive%status)) values = 0
         return
      end if
      next = archive%n_longs + size(values, kind=lp)
      if (archive%is_reading) then
         call demand(archive, next <= size(archive%longs, kind=lp), name)
         if (.not. is_ok(archive%status)) values = 0
         if (.not. is_ok(archive%status)) return
         values = archive%longs(archive%n_longs + 1:next)
      else
         if (next > size(archive%longs, kind=lp)) call grow(archive%longs, 2*next)
         archive%longs(archive%n_longs + 1:next) = values
      end if
      archive%n_longs = next
   end subroutine pass_longs

   !> Writes or reads reals, of which there are enough.
   subroutine pass_reals(archive, n, values)
      type(archive_t), intent(inout) :: archive      !< with an open part, or spooled
      integer(lp), intent(in) :: n                   !< how many
      real(wp), intent(inout) :: values(n)           !< what is written or read; an array of any rank, at once
      integer(lp) :: next

      if (archive%is_spooled) then
         call pass_values(archive%spool, archive%is_reading, values)
         call note_outcome(archive)
         return
      end if
      next = archive%n_reals + n
      if (archive%is_reading) then
         values = archive%reals(archive%n_reals + 1:next)
      else
         if (next > size(archive%reals, kind=lp)) call grow(archive%reals, 2*next)
         archive%reals(archive%n_reals + 1:next) = values
      end if
      archive%n_reals = next
   end subroutine pass_reals

   !> Writes or reads characters, of which there are enough.
   subroutine pass_text(archive, text)
      type(archive_t), intent(inout) :: archive      !< with an open part, or spooled
      character(len=*), intent(inout) :: text        !< what is written or read

      if (archive%is_spooled) then
         call pass_values(archive%spool, archive%is_reading, text)
         call note_outcome(archive)
         return
      end if
      if (archive%is_reading) then
         text = archive%text%letters(archive%text%n + 1:archive%text%n + len(text))
         archive%text%n = archive%text%n + len(text, kind=ip)
      else
         call append_text(archive%text, text)
      end if
   end subroutine pass_text

end module atrito_archive
