!> Arrays in a row of bytes, to be sent from one rank to another: what is put first is taken first.
!>
!> Every item says of what kind it is and how long, so that whoever takes another one than was put stops at once.
module atrito_parcel
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_loc, c_ptr
   use, intrinsic :: iso_fortran_env, only: int8
   use atrito_kinds, only: ip, lp, wp
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: parcel_t, put, take, put_text, put_status, take_status, make_parcel, parcel_bytes

   !> An empty one needs no call before the first put.
   type :: parcel_t
      private
      integer(int8), allocatable :: bytes(:)
      integer(lp) :: length = 0                  !< bytes that are filled
      integer(lp) :: taken = 0                   !< bytes that were taken
   end type parcel_t

   !> call put(parcel, x): adds a number, a logical, a text, or an array of numbers (reals of rank 2, too).
   interface put
      module procedure put_number, put_real, put_logical, put_letters, put_numbers, put_reals, put_real_columns
   end interface put

   !> call take(parcel, x): the next item; texts and arrays are allocated.
   interface take
      module procedure take_number, take_real, take_logical, take_letters, take_numbers, take_reals, take_real_columns
   end interface take

   integer(lp), parameter :: NUMBERS = 1, REALS = 2, LETTERS = 3
   !> Bytes of an entry of each kind, and of what stands before an item: its kind and the length of rows and columns.
   integer(lp), parameter :: ENTRY_BYTES(3) = [4_lp, 8_lp, 1_lp], HEAD = 3_lp, HEAD_BYTES = 8*HEAD
   integer(lp), parameter :: FIRST_LENGTH = 1024_lp

contains

   !> A parcel of so many bytes that are filled by whoever receives them (parcel_bytes).
   subroutine make_parcel(length, parcel)
      integer(lp), intent(in) :: length
      type(parcel_t), intent(out) :: parcel

      allocate (parcel%bytes(length))
      parcel%length = length
   end subroutine make_parcel

   !> All bytes that were put.
   function parcel_bytes(parcel) result(bytes)
      type(parcel_t), intent(in), target :: parcel
      integer(int8), pointer :: bytes(:)
      integer(int8), target, save :: nothing(0)

      bytes => nothing
      if (parcel%length > 0) bytes => parcel%bytes(:parcel%length)
   end function parcel_bytes

   subroutine put_number(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      integer(ip), intent(in) :: x

      call put_numbers(parcel, [x])
   end subroutine put_number

   subroutine put_real(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      real(wp), intent(in) :: x

      call put_reals(parcel, [x])
   end subroutine put_real

   subroutine put_logical(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      logical, intent(in) :: x

      call put_numbers(parcel, [merge(1_ip, 0_ip, x)])
   end subroutine put_logical

   subroutine put_letters(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      character(len=*), intent(in), target :: x

      call append(parcel, LETTERS, [len(x, kind=lp), 1_lp], c_loc(x))
   end subroutine put_letters

   !> A text; one that is not allocated is empty.
   subroutine put_text(parcel, text)
      type(parcel_t), intent(inout) :: parcel
      character(len=:), allocatable, intent(in) :: text

      if (allocated(text)) call put_letters(parcel, text)
      if (.not. allocated(text)) call put_letters(parcel, '')
   end subroutine put_text

   subroutine put_numbers(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      integer(ip), intent(in), contiguous, target :: x(:)

      call append(parcel, NUMBERS, [size(x, kind=lp), 1_lp], c_loc(x))
   end subroutine put_numbers

   subroutine put_reals(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      real(wp), intent(in), contiguous, target :: x(:)

      call append(parcel, REALS, [size(x, kind=lp), 1_lp], c_loc(x))
   end subroutine put_reals

   subroutine put_real_columns(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      real(wp), intent(in), contiguous, target :: x(:, :)

      call append(parcel, REALS, shape(x, kind=lp), c_loc(x))
   end subroutine put_real_columns

   subroutine take_number(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      integer(ip), intent(out) :: x
      integer(ip), allocatable :: list(:)

      call take_numbers(parcel, list)
      x = list(1)
   end subroutine take_number

   subroutine take_real(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      real(wp), intent(out) :: x
      real(wp), allocatable :: list(:)

      call take_reals(parcel, list)
      x = list(1)
   end subroutine take_real

   subroutine take_logical(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      logical, intent(out) :: x
      integer(ip), allocatable :: list(:)

      call take_numbers(parcel, list)
      x = list(1) == 1
   end subroutine take_logical

   subroutine take_letters(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      character(len=:), allocatable, intent(out), target :: x
      integer(lp) :: lengths(2)

      call begin_item(parcel, LETTERS, lengths)
      allocate (character(len=lengths(1)) :: x)
      call copy_item(parcel, LETTERS, lengths, c_loc(x))
   end subroutine take_letters

   subroutine take_numbers(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      integer(ip), allocatable, intent(out), target :: x(:)
      integer(lp) :: lengths(2)

      call begin_item(parcel, NUMBERS, lengths)
      allocate (x(lengths(1)))
      call copy_item(parcel, NUMBERS, lengths, c_loc(x))
   end subroutine take_numbers

   subroutine take_reals(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      real(wp), allocatable, intent(out), target :: x(:)
      integer(lp) :: lengths(2)

      call begin_item(parcel, REALS, lengths)
      allocate (x(lengths(1)))
      call copy_item(parcel, REALS, lengths, c_loc(x))
   end subroutine take_reals

   subroutine take_real_columns(parcel, x)
      type(parcel_t), intent(inout) :: parcel
      real(wp), allocatable, intent(out), target :: x(:, :)
      integer(lp) :: lengths(2)

      call begin_item(parcel, REALS, lengths)
      allocate (x(lengths(1), lengths(2)))
      call copy_item(parcel, REALS, lengths, c_loc(x))
   end subroutine take_real_columns

   !> Adds an outcome.
   subroutine put_status(parcel, status)
      type(parcel_t), intent(inout) :: parcel
      type(status_t), intent(in) :: status

      call put_number(parcel, int(status%code, ip))
      call put_text(parcel, status%text)
   end subroutine put_status

   !> The next item, an outcome.
   subroutine take_status(parcel, status)
      type(parcel_t), intent(inout) :: parcel
      type(status_t), intent(out) :: status
      integer(ip) :: code

      call take_number(parcel, code)
      status%code = int(code)
      call take_letters(parcel, status%text)
   end subroutine take_status

   !> Adds an item: its head, then its entries as they lie in memory.
   subroutine append(parcel, kind_of, lengths, start)
      type(parcel_t), intent(inout) :: parcel
      integer(lp), intent(in) :: kind_of, lengths(2)
      type(c_ptr), intent(in) :: start           !< of lengths(1)*lengths(2) entries
      integer(int8), pointer :: bytes(:)
      integer(lp) :: n

      n = ENTRY_BYTES(kind_of)*lengths(1)*lengths(2)
      call make_room_for(parcel, HEAD_BYTES + n)
      parcel%bytes(parcel%length + 1:parcel%length + HEAD_BYTES) = transfer([kind_of, lengths], parcel%bytes, HEAD_BYTES)
      parcel%length = parcel%length + HEAD_BYTES
      if (n == 0) return
      call c_f_pointer(start, bytes, [n])
      parcel%bytes(parcel%length + 1:parcel%length + n) = bytes
      parcel%length = parcel%length + n
   end subroutine append

   subroutine make_room_for(parcel, n)
      type(parcel_t), intent(inout) :: parcel
      integer(lp), intent(in) :: n               !< bytes to come
      integer(int8), allocatable :: longer(:)

      if (.not. allocated(parcel%bytes)) allocate (parcel%bytes(max(FIRST_LENGTH, n)))
      if (parcel%length + n <= size(parcel%bytes, kind=lp)) return
      allocate (longer(max(parcel%length + n, 2*size(parcel%bytes, kind=lp))))
      longer(:parcel%length) = parcel%bytes(:parcel%length)
      call move_alloc(longer, parcel%bytes)
   end subroutine make_room_for

   !> The head of the next item, which must be of this kind.
   subroutine begin_item(parcel, kind_of, lengths)
      type(parcel_t), intent(inout) :: parcel
      integer(lp), intent(in) :: kind_of
      integer(lp), intent(out) :: lengths(2)
      integer(lp) :: found(HEAD)

      if (parcel%taken + HEAD_BYTES > parcel%length) error stop 'atrito_parcel: nothing is left in a parcel'
      found = transfer(parcel%bytes(parcel%taken + 1:parcel%taken + HEAD_BYTES), found)
      if (found(1) /= kind_of) error stop 'atrito_parcel: the next item of a parcel is of another kind'
      lengths = found(2:)
      parcel%taken = parcel%taken + HEAD_BYTES
   end subroutine begin_item

   subroutine copy_item(parcel, kind_of, lengths, start)
      type(parcel_t), intent(inout) :: parcel
      integer(lp), intent(in) :: kind_of, lengths(2)
      type(c_ptr), intent(in) :: start
      integer(int8), pointer :: bytes(:)
      integer(lp) :: n

      n = ENTRY_BYTES(kind_of)*lengths(1)*lengths(2)
      if (n == 0) return
      call c_f_pointer(start, bytes, [n])
      bytes = parcel%bytes(parcel%taken + 1:parcel%taken + n)
      parcel%taken = parcel%taken + n
   end subroutine copy_item

end module atrito_parcel
