!> The names of the units of a deck, *UNITS. Nothing is computed from them: they are for people.
module atrito_units
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: units_t, unit_names, in_units, N_UNITS

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
