!> Named values of an archive, which are written or read by the same calls, so that what is stored is described once:
!>
!>     call exchange(archive, 'time', state%time)      ! writes it, or reads it
module atrito_exchange
   use atrito_archive, only: archive_t, demand, exchange_head, has_enough, pass_longs, pass_reals, pass_text, NOT_ALLOCATED, &
                             IS_REAL, IS_INTEGER, IS_LONG, IS_LOGICAL, IS_TEXT
   use atrito_kinds, only: ip, lp, wp
   use atrito_status, only: set_status, is_ok, STATUS_FILE
   use atrito_utf8, only: has_controls
   implicit none (type, external)
   private
   public :: exchange, exchange_vector, exchange_numbers, exchange_word, exchange_length

   !> Writes or reads a value with its name. Arrays and strings are allocatable.
   interface exchange
      module procedure exchange_real, exchange_reals, exchange_columns, exchange_integer, exchange_integers, exchange_long, &
         exchange_logical, exchange_logicals, exchange_logical_columns, exchange_text
   end interface exchange

contains

   subroutine exchange_real(archive, name, value)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      real(wp), intent(inout) :: value
      real(wp) :: values(1)

      values = value
      call exchange_vector(archive, name, values)
      value = values(1)
   end subroutine exchange_real

   !> A list of a length that is known.
   subroutine exchange_vector(archive, name, values)
      type(archive_t), intent(inout) :: archive       !< with an open part, or spooled
      character(len=*), intent(in) :: name            !< of the value
      real(wp), intent(inout) :: values(:)            !< what is written; read: 0 after a failure
      integer(lp) :: extents(1), n

      extents = size(values)
      call exchange_head(archive, name, IS_REAL, extents, n)
      call demand(archive, n == size(values), name)
      if (is_ok(archive%status)) then
         call pass_reals(archive, n, values)
      else if (archive%is_reading) then
         values = 0.0_wp
      end if
   end subroutine exchange_vector

   subroutine exchange_reals(archive, name, values)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      real(wp), allocatable, intent(inout) :: values(:)
      integer(lp) :: extents(1), n

      extents = NOT_ALLOCATED
      if (allocated(values)) extents = shape(values, kind=lp)
      call exchange_head(archive, name, IS_REAL, extents, n)
      if (archive%is_reading) then
         if (allocated(values)) deallocate (values)
         if (n /= NOT_ALLOCATED) allocate (values(n))
      end if
      if (allocated(values)) call pass_reals(archive, size(values, kind=lp), values)
   end subroutine exchange_reals

   subroutine exchange_columns(archive, name, values)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      real(wp), allocatable, intent(inout) :: values(:, :)
      integer(lp) :: extents(2), n

      extents = NOT_ALLOCATED
      if (allocated(values)) extents = shape(values, kind=lp)
      call exchange_head(archive, name, IS_REAL, extents, n)
      if (archive%is_reading) then
         if (allocated(values)) deallocate (values)
         if (n /= NOT_ALLOCATED) allocate (values(extents(1), extents(2)))
      end if
      if (allocated(values)) call pass_reals(archive, size(values, kind=lp), values)
   end subroutine exchange_columns

   subroutine exchange_long(archive, name, value)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      integer(lp), intent(inout) :: value
      integer(lp) :: none(0), values(1), n

      values = value
      call exchange_head(archive, name, IS_LONG, none, n)
      call pass_longs(archive, name, values)
      value = values(1)
   end subroutine exchange_long

   subroutine exchange_integer(archive, name, value)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      integer(ip), intent(inout) :: value
      integer(lp) :: none(0), values(1), n

      values = value
      call exchange_head(archive, name, IS_INTEGER, none, n)
      call pass_longs(archive, name, values)
      call demand(archive, abs(values(1)) <= huge(value), name)
      if (is_ok(archive%status)) value = int(values(1), ip)
      if (archive%is_reading .and. .not. is_ok(archive%status)) value = 0
   end subroutine exchange_integer

   !> The number of the elements of a list of a derived type, each of which has a value in this part; < 0: it is not allocated.
   subroutine exchange_length(archive, name, n, list)
      type(archive_t), intent(inout) :: archive       !< with an open part, or spooled
      character(len=*), intent(in) :: name            !< of the list
      integer(ip), intent(out) :: n                   !< < 0 also after a failure
      type(*), intent(in), optional :: list(:)        !< what is written; one that is not allocated is absent
      logical :: is_there

      is_there = present(list)
      n = 0
      if (is_there) n = size(list, kind=ip)
      call exchange(archive, name//' is there', is_there)
      call exchange(archive, name, n)
      call demand(archive, n >= 0, name)
      if (archive%is_reading) call demand(archive, has_enough(archive, IS_LONG, int(n, lp)), name)
      if (.not. (is_there .and. is_ok(archive%status))) n = -1
   end subroutine exchange_length

   subroutine exchange_integers(archive, name, values)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      integer(ip), allocatable, intent(inout) :: values(:)
      integer(lp), allocatable :: longs(:)
      integer(lp) :: extents(1), n

      extents = NOT_ALLOCATED
      if (allocated(values)) extents = shape(values, kind=lp)
      call exchange_head(archive, name, IS_INTEGER, extents, n)
      if (archive%is_reading .and. allocated(values)) deallocate (values)
      if (n == NOT_ALLOCATED) return
      allocate (longs(n))
      if (allocated(values)) longs = values
      call pass_longs(archive, name, longs)
      call demand(archive, all(abs(longs) <= huge(1_ip)), name)
      if (archive%is_reading .and. is_ok(archive%status)) values = int(longs, ip)
   end subroutine exchange_integers

   !> A list of a length that is known.
   subroutine exchange_numbers(archive, name, values)
      type(archive_t), intent(inout) :: archive       !< with an open part, or spooled
      character(len=*), intent(in) :: name            !< of the value
      integer(ip), intent(inout) :: values(:)         !< what is written; read: 0 after a failure
      integer(ip), allocatable :: copy(:)
      logical :: ok

      copy = values
      call exchange(archive, name, copy)
      if (.not. archive%is_reading) return
      ok = allocated(copy)
      if (ok) ok = size(copy) == size(values)
      call demand(archive, ok, name)
      values = 0
      if (is_ok(archive%status)) values = copy
   end subroutine exchange_numbers

   subroutine exchange_logical(archive, name, value)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      logical, intent(inout) :: value
      integer(lp) :: none(0), values(1), n

      values = merge(1, 0, value)
      call exchange_head(archive, name, IS_LOGICAL, none, n)
      call pass_longs(archive, name, values)
      call demand(archive, any(values(1) == [0, 1]), name)
      value = values(1) == 1
   end subroutine exchange_logical

   subroutine exchange_logicals(archive, name, values)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      logical, allocatable, intent(inout) :: values(:)
      integer(ip), allocatable :: numbers(:)

      if (allocated(values)) numbers = merge(1_ip, 0_ip, values)
      call exchange(archive, name, numbers)
      if (.not. archive%is_reading) return
      if (allocated(values)) deallocate (values)
      if (.not. allocated(numbers)) return
      call demand(archive, all(numbers == 0 .or. numbers == 1), name)
      values = numbers == 1
   end subroutine exchange_logicals

   subroutine exchange_logical_columns(archive, name, values)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      logical, allocatable, intent(inout) :: values(:, :)
      logical, allocatable :: flat(:)
      integer(ip) :: rows

      rows = 0
      if (allocated(values)) then
         rows = size(values, 1, kind=ip)
         allocate (flat(size(values)))
         flat = reshape(values, [size(values)])
      end if
      call exchange(archive, name//', rows', rows)
      call exchange(archive, name, flat)
      if (.not. archive%is_reading) return
      if (allocated(values)) deallocate (values)
      if (.not. allocated(flat)) return
      call demand(archive, rows > 0, name)
      if (rows > 0) call demand(archive, mod(size(flat), rows) == 0, name)
      if (is_ok(archive%status)) values = reshape(flat, [int(rows), size(flat)/int(rows)])
   end subroutine exchange_logical_columns

   subroutine exchange_text(archive, name, text)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      character(len=:), allocatable, intent(inout) :: text
      integer(lp) :: extents(1), n

      extents = NOT_ALLOCATED
      if (allocated(text)) extents = len(text, kind=lp)
      call exchange_head(archive, name, IS_TEXT, extents, n)
      if (archive%is_reading) then
         if (allocated(text)) deallocate (text)
         if (n /= NOT_ALLOCATED) allocate (character(len=n) :: text)
      end if
      if (.not. allocated(text)) return
      call pass_text(archive, text)
      if (archive%is_reading .and. is_ok(archive%status) .and. (has_controls(text) .or. index(text, achar(13)) > 0)) then
         call set_status(archive%status, STATUS_FILE, archive%path//': is damaged: control characters in '//name)
      end if
   end subroutine exchange_text

   !> A string of fixed length.
   subroutine exchange_word(archive, name, word)
      type(archive_t), intent(inout) :: archive       !< with an open part, or spooled
      character(len=*), intent(in) :: name            !< of the value
      character(len=*), intent(inout) :: word         !< what is written; read: cut, or blanks
      character(len=:), allocatable :: text

      text = word
      call exchange(archive, name, text)
      if (.not. archive%is_reading) return
      word = ' '
      if (allocated(text)) word = text
   end subroutine exchange_word

end module atrito_exchange
