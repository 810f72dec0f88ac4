!> The names of the units of a deck, *UNITS. Nothing is computed from them: they are for people.
module atrito_units
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: units_t, unit_names, in_units, name_units, N_UNITS

   integer(ip), parameter :: N_UNITS = 4

   !> What dimensions are written with (docs/user/keywords.md), in the order of the names.
   character(len=11), parameter :: SYMBOLS(N_UNITS) = [character(len=11) :: 'L', 'F', 'T', 'temperature']

   !> *UNITS.
   type :: units_t
      type(string_t) :: names(N_UNITS)   !< of length, force, time and temperature; %s not allocated: not named
   end type units_t

contains

   !> The names as *UNITS has them: 'm, kN'; '' where there are none.
   pure function unit_names(units) result(text)
      type(units_t), intent(in) :: units         !< of the deck
      character(len=:), allocatable :: text
      integer(ip) :: k

      text = ''
      do k = 1, N_UNITS
         if (.not. allocated(units%names(k)%s)) cycle
         if (k > 1) text = text//', '
         text = text//units%names(k)%s
      end do
   end function unit_names

   !> `[F/L^2]` is `[kN/m^2]` in a line for people, where the deck names its units.
   pure subroutine name_units(units, line, quote)
      type(units_t), intent(in) :: units
      character(len=:), allocatable, intent(inout) :: line
      character(len=1), intent(in), optional :: quote   !< round the words of the user, which stay
      character(len=:), allocatable :: name
      integer :: begin, end, next, k
      logical :: is_ours

      if (.not. any([(allocated(units%names(k)%s), k=1, N_UNITS)])) return
      begin = index(line, '[')
      do while (begin > 0)
         end = begin + index(line(begin:), ']') - 1
         if (end < begin) return
         name = line(begin + 1:end - 1)
         is_ours = .true.
         if (present(quote)) is_ours = mod(count([(line(k:k) == quote, k=1, begin)]), 2) == 0
         if (is_ours) name = in_units(units, name)
         line = line(:begin)//name//line(end:)
         end = begin + len(name) + 1
         next = index(line(end:), '[')
         begin = merge(0, end + next - 1, next == 0)
      end do
   end subroutine name_units

   !> A dimension in the units of a deck: 'F/L^2' is 'kN/m^2'. What has no name stays as it is: 'F/L^2'.
   pure function in_units(units, dimension) result(text)
      type(units_t), intent(in) :: units          !< of the deck
      character(len=*), intent(in) :: dimension   !< F, L, T and temperature with what joins them
      character(len=:), allocatable :: text
      character(len=*), parameter :: LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz'
      integer :: first, last
      integer(ip) :: k

      text = ''
      first = 1
      do while (first <= len(dimension))
         last = first + verify(dimension(first:)//' ', LETTERS) - 2
         if (last < first) then
            text = text//dimension(first:first)
            first = first + 1
            cycle
         end if
         k = findloc(SYMBOLS, dimension(first:last), 1, kind=ip)
         if (k == 0) then
            text = text//dimension(first:last)
         else if (.not. allocated(units%names(k)%s)) then
            text = text//dimension(first:last)
         else
            text = text//units%names(k)%s
         end if
         first = last + 1
      end do
   end function in_units

end module atrito_units
