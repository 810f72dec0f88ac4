!> Arrays in a row of bytes, to be sent from one rank to another: what is put first is taken first.
!>
!> Every item says of what kind it is and how long, so that whoever takes another one than was put stops at once.
module atrito_buffer
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_loc, c_ptr
   use, intrinsic :: iso_fortran_env, only: int8
   use atrito_kinds, only: ip, lp, wp
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: buffer_t, put, take, put_text, put_status, take_status, make_buffer, buffer_bytes

   !> An empty one needs no call before the first put.
   type :: buffer_t
      private
      integer(int8), allocatable :: bytes(:)     !< (>= length) grows by doubling; not allocated: nothing was put
      integer(lp) :: length = 0                  !< bytes that are filled
      integer(lp) :: taken = 0                   !< bytes that were taken
   end type buffer_t

   !> call put(buffer, x): adds a number, a logical, a text, or an array of numbers (reals of rank 2, too).
   interface put
      module procedure put_number, put_real, put_logical, put_letters, put_numbers, put_reals, put_real_columns
   end interface put

   !> call take(buffer, x): the next item; texts and arrays are allocated.
   interface take
      module procedure take_number, take_real, take_logical, take_letters, take_numbers, take_reals, take_real_columns
   end interface take

   integer(lp), parameter :: NUMBERS = 1, REALS = 2, LETTERS = 3
   !> Bytes of an entry of each kind, and of what stands before an item: its kind and the length of rows and columns.
   integer(lp), parameter :: ENTRY_BYTES(3) = [4_lp, 8_lp, 1_lp], HEAD = 3_lp, HEAD_BYTES = 8*HEAD
   integer(lp), parameter :: FIRST_LENGTH = 1024_lp

contains

   !> A buffer of so many bytes that are filled by whoever receives them (buffer_bytes).
   subroutine make_buffer(length, buffer)
      integer(lp), intent(in) :: length          !< >= 0 [bytes]
      type(buffer_t), intent(out) :: buffer      !< its bytes are not set yet

      allocate (buffer%bytes(length))
      buffer%length = length
   end subroutine make_buffer

   !> All bytes that were put.
   function buffer_bytes(buffer) result(bytes)
      type(buffer_t), intent(in), target :: buffer !< keep it a target as long as the bytes are used
      integer(int8), pointer :: bytes(:)
      integer(int8), target, save :: nothing(0)

      bytes => nothing
      if (buffer%length > 0) bytes => buffer%bytes(:buffer%length)
   end function buffer_bytes

   subroutine put_number(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      integer(ip), intent(in) :: x

      call put_numbers(buffer, [x])
   end subroutine put_number

   subroutine put_real(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      real(wp), intent(in) :: x

      call put_reals(buffer, [x])
   end subroutine put_real

   subroutine put_logical(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      logical, intent(in) :: x

      call put_numbers(buffer, [merge(1_ip, 0_ip, x)])
   end subroutine put_logical

   subroutine put_letters(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      character(len=*), intent(in), target :: x

      call append(buffer, LETTERS, [len(x, kind=lp), 1_lp], c_loc(x))
   end subroutine put_letters

   !> A text; one that is not allocated is empty.
   subroutine put_text(buffer, text)
      type(buffer_t), intent(inout) :: buffer           !< the item goes behind the others
      character(len=:), allocatable, intent(in) :: text !< of any length

      if (allocated(text)) call put_letters(buffer, text)
      if (.not. allocated(text)) call put_letters(buffer, '')
   end subroutine put_text

   subroutine put_numbers(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      integer(ip), intent(in), contiguous, target :: x(:)

      call append(buffer, NUMBERS, [size(x, kind=lp), 1_lp], c_loc(x))
   end subroutine put_numbers

   subroutine put_reals(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      real(wp), intent(in), contiguous, target :: x(:)

      call append(buffer, REALS, [size(x, kind=lp), 1_lp], c_loc(x))
   end subroutine put_reals

   subroutine put_real_columns(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      real(wp), intent(in), contiguous, target :: x(:, :)

      call append(buffer, REALS, shape(x, kind=lp), c_loc(x))
   end subroutine put_real_columns

   subroutine take_number(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      integer(ip), intent(out) :: x
      integer(ip), allocatable :: list(:)

      call take_numbers(buffer, list)
      x = list(1)
   end subroutine take_number

   subroutine take_real(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      real(wp), intent(out) :: x
      real(wp), allocatable :: list(:)

      call take_reals(buffer, list)
      x = list(1)
   end subroutine take_real

   subroutine take_logical(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      logical, intent(out) :: x
      integer(ip), allocatable :: list(:)

      call take_numbers(buffer, list)
      x = list(1) == 1
   end subroutine take_logical

   subroutine take_letters(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      character(len=:), allocatable, intent(out), target :: x
      integer(lp) :: lengths(2)

      call begin_item(buffer, LETTERS, lengths)
      allocate (character(len=lengths(1)) :: x)
      call copy_item(buffer, LETTERS, lengths, c_loc(x))
   end subroutine take_letters

   subroutine take_numbers(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      integer(ip), allocatable, intent(out), target :: x(:)
      integer(lp) :: lengths(2)

      call begin_item(buffer, NUMBERS, lengths)
      allocate (x(lengths(1)))
      call copy_item(buffer, NUMBERS, lengths, c_loc(x))
   end subroutine take_numbers

   subroutine take_reals(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      real(wp), allocatable, intent(out), target :: x(:)
      integer(lp) :: lengths(2)

      call begin_item(buffer, REALS, lengths)
      allocate (x(lengths(1)))
      call copy_item(buffer, REALS, lengths, c_loc(x))
   end subroutine take_reals

   subroutine take_real_columns(buffer, x)
      type(buffer_t), intent(inout) :: buffer
      real(wp), allocatable, intent(out), target :: x(:, :)
      integer(lp) :: lengths(2)

      call begin_item(buffer, REALS, lengths)
      allocate (x(lengths(1), lengths(2)))
      call copy_item(buffer, REALS, lengths, c_loc(x))
   end subroutine take_real_columns

   !> Adds an outcome.
   subroutine put_status(buffer, status)
      type(buffer_t), intent(inout) :: buffer    !< the item goes behind the others
      type(status_t), intent(in) :: status       !< its code and, where it has one, its text

      call put_number(buffer, int(status%code, ip))
      call put_text(buffer, status%text)
   end subroutine put_status

   !> The next item, an outcome.
   subroutine take_status(buffer, status)
      type(buffer_t), intent(inout) :: buffer    !< its next item is taken
      type(status_t), intent(out) :: status      !< as it was put
      integer(ip) :: code

      call take_number(buffer, code)
      status%code = int(code)
      call take_letters(buffer, status%text)
   end subroutine take_status

   !> Adds an item: its head, then its entries as they lie in memory.
   subroutine append(buffer, kind_of, lengths, start)
      type(buffer_t), intent(inout) :: buffer
      integer(lp), intent(in) :: kind_of, lengths(2)
      type(c_ptr), intent(in) :: start           !< of lengths(1)*lengths(2) entries
      integer(int8), pointer :: bytes(:)
      integer(lp) :: n

      n = ENTRY_BYTES(kind_of)*lengths(1)*lengths(2)
      call make_room_for(buffer, HEAD_BYTES + n)
      buffer%bytes(buffer%length + 1:buffer%length + HEAD_BYTES) = transfer([kind_of, lengths], buffer%bytes, HEAD_BYTES)
      buffer%length = buffer%length + HEAD_BYTES
      if (n == 0) return
      call c_f_pointer(start, bytes, [n])
      buffer%bytes(buffer%length + 1:buffer%length + n) = bytes
      buffer%length = buffer%length + n
   end subroutine append

   subroutine make_room_for(buffer, n)
      type(buffer_t), intent(inout) :: buffer
      integer(lp), intent(in) :: n               !< bytes to come
      integer(int8), allocatable :: longer(:)

      if (.not. allocated(buffer%bytes)) allocate (buffer%bytes(max(FIRST_LENGTH, n)))
      if (buffer%length + n <= size(buffer%bytes, kind=lp)) return
      allocate (longer(max(buffer%length + n, 2*size(buffer%bytes, kind=lp))))
      longer(:buffer%length) = buffer%bytes(:buffer%length)
      call move_alloc(longer, buffer%bytes)
   end subroutine make_room_for

   !> The head of the next item, which must be of this kind.
   subroutine begin_item(buffer, kind_of, lengths)
      type(buffer_t), intent(inout) :: buffer
      integer(lp), intent(in) :: kind_of
      integer(lp), intent(out) :: lengths(2)
      integer(lp) :: found(HEAD)

      if (buffer%taken + HEAD_BYTES > buffer%length) error stop 'atrito_buffer: nothing is left in a buffer'
      found = transfer(buffer%bytes(buffer%taken + 1:buffer%taken + HEAD_BYTES), found)
      if (found(1) /= kind_of) error stop 'atrito_buffer: the next item of a buffer is of another kind'
      lengths = found(2:)
      buffer%taken = buffer%taken + HEAD_BYTES
   end subroutine begin_item

   subroutine copy_item(buffer, kind_of, lengths, start)
      type(buffer_t), intent(inout) :: buffer
      integer(lp), intent(in) :: kind_of, lengths(2)
      type(c_ptr), intent(in) :: start
      integer(int8), pointer :: bytes(:)
      integer(lp) :: n

      n = ENTRY_BYTES(kind_of)*lengths(1)*lengths(2)
      if (n == 0) return
      call c_f_pointer(start, bytes, [n])
      bytes = buffer%bytes(buffer%taken + 1:buffer%taken + n)
      buffer%taken = buffer%taken + n
   end subroutine copy_item

end module atrito_buffer
