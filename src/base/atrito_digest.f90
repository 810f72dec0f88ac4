!> A digest of data: a number of 62 bits that is another one, but for a chance of about 2**-62, where a value, its kind of zero or
!> the order of the values differs.
!>
!> Two polynomials in the values, modulo the prime 2**31 - 1, at two places: whole numbers that never overflow.
module atrito_digest
   use atrito_kinds, only: ip, lp, wp
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: digest_t, add_to, add_allocated, digest_text

   integer(lp), parameter :: PRIME = 2147483647_lp
   integer(lp), parameter :: PLACE(2) = [1103515245_lp, 805306457_lp]

   type :: digest_t
      integer(lp) :: value(2) = [1_lp, 1_lp]
   end type digest_t

   !> Takes a value, or a list with its length, into a digest.
   interface add_to
      module procedure add_real, add_reals, add_columns, add_integer, add_integers, add_table, add_logical, add_logicals, add_text
   end interface add_to

   !> Takes what may not be allocated, which is another thing than what is empty.
   interface add_allocated
      module procedure add_allocated_reals, add_allocated_columns, add_allocated_integers, add_allocated_logicals, &
         add_allocated_text
   end interface add_allocated

contains

   !> Numbers below 2**33, so that the products stay below 2**63.
   pure subroutine add_word(digest, word)
      type(digest_t), intent(inout) :: digest
      integer(lp), intent(in) :: word              !< 0..2**32

      digest%value = modulo(digest%value*PLACE + word, PRIME)
   end subroutine add_word

   pure subroutine add_real(digest, value)
      type(digest_t), intent(inout) :: digest
      real(wp), intent(in) :: value
      integer(lp) :: bits

      bits = transfer(value, bits)
      call add_word(digest, ibits(bits, 0, 32))
      call add_word(digest, ibits(bits, 32, 32))
   end subroutine add_real

   pure subroutine add_integer(digest, value)
      type(digest_t), intent(inout) :: digest
      integer(ip), intent(in) :: value

      call add_word(digest, ibits(int(value, lp), 0, 32))
   end subroutine add_integer

   pure subroutine add_logical(digest, value)
      type(digest_t), intent(inout) :: digest
      logical, intent(in) :: value

      call add_word(digest, merge(1_lp, 0_lp, value))
   end subroutine add_logical

   pure subroutine add_text(digest, text)
      type(digest_t), intent(inout) :: digest
      character(len=*), intent(in) :: text
      integer :: i

      call add_integer(digest, len(text, kind=ip))
      do i = 1, len(text)
         call add_word(digest, int(iachar(text(i:i)), lp))
      end do
   end subroutine add_text

   pure subroutine add_reals(digest, values)
      type(digest_t), intent(inout) :: digest
      real(wp), intent(in) :: values(:)
      integer :: i

      call add_integer(digest, size(values, kind=ip))
      do i = 1, size(values)
         call add_real(digest, values(i))
      end do
   end subroutine add_reals

   pure subroutine add_columns(digest, values)
      type(digest_t), intent(inout) :: digest
      real(wp), intent(in) :: values(:, :)
      integer :: i

      call add_integer(digest, size(values, 2, kind=ip))
      do i = 1, size(values, 2)
         call add_reals(digest, values(:, i))
      end do
   end subroutine add_columns

   pure subroutine add_integers(digest, values)
      type(digest_t), intent(inout) :: digest
      integer(ip), intent(in) :: values(:)
      integer :: i

      call add_integer(digest, size(values, kind=ip))
      do i = 1, size(values)
         call add_integer(digest, values(i))
      end do
   end subroutine add_integers

   pure subroutine add_table(digest, values)
      type(digest_t), intent(inout) :: digest
      integer(ip), intent(in) :: values(:, :)
      integer :: i

      call add_integer(digest, size(values, 2, kind=ip))
      do i = 1, size(values, 2)
         call add_integers(digest, values(:, i))
      end do
   end subroutine add_table

   pure subroutine add_logicals(digest, values)
      type(digest_t), intent(inout) :: digest
      logical, intent(in) :: values(:)
      integer :: i

      call add_integer(digest, size(values, kind=ip))
      do i = 1, size(values)
         call add_logical(digest, values(i))
      end do
   end subroutine add_logicals

   pure subroutine add_allocated_reals(digest, values)
      type(digest_t), intent(inout) :: digest
      real(wp), allocatable, intent(in) :: values(:)

      call add_logical(digest, allocated(values))
      if (allocated(values)) call add_reals(digest, values)
   end subroutine add_allocated_reals

   pure subroutine add_allocated_columns(digest, values)
      type(digest_t), intent(inout) :: digest
      real(wp), allocatable, intent(in) :: values(:, :)

      call add_logical(digest, allocated(values))
      if (allocated(values)) call add_columns(digest, values)
   end subroutine add_allocated_columns

   pure subroutine add_allocated_integers(digest, values)
      type(digest_t), intent(inout) :: digest
      integer(ip), allocatable, intent(in) :: values(:)

      call add_logical(digest, allocated(values))
      if (allocated(values)) call add_integers(digest, values)
   end subroutine add_allocated_integers

   pure subroutine add_allocated_logicals(digest, values)
      type(digest_t), intent(inout) :: digest
      logical, allocatable, intent(in) :: values(:)

      call add_logical(digest, allocated(values))
      if (allocated(values)) call add_logicals(digest, values)
   end subroutine add_allocated_logicals

   pure subroutine add_allocated_text(digest, text)
      type(digest_t), intent(inout) :: digest
      character(len=:), allocatable, intent(in) :: text

      call add_logical(digest, allocated(text))
      if (allocated(text)) call add_text(digest, text)
   end subroutine add_allocated_text

   pure function digest_text(digest) result(text)
      type(digest_t), intent(in) :: digest
      character(len=:), allocatable :: text

      text = to_text(digest%value(1))//'-'//to_text(digest%value(2))
   end function digest_text

end module atrito_digest
