!> Names of the files that a run writes of its deck: <deck name>.run.inp, and of each mesh of another program a copy.
module atrito_as_run_names
   use atrito_kinds, only: ip
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: as_run_name, mesh_copy_name

contains

   !> The name of the file that holds the deck as it was run: `deck.run.inp`.
   pure function as_run_name(deck) result(name)
      character(len=*), intent(in) :: deck           !< name of the deck, without folder and .inp
      character(len=:), allocatable :: name

      name = deck//'.run.inp'
   end function as_run_name

   !> Of the n-th mesh, of letters that need no quotes.
   pure function mesh_copy_name(deck, n) result(name)
      character(len=*), intent(in) :: deck           !< name of the deck, without folder and .inp
      integer(ip), intent(in) :: n                   !< >= 1
      character(len=:), allocatable :: name
      character(len=*), parameter :: PLAIN = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-+'
      integer :: i

      name = deck
      do i = 1, len(name)
         if (verify(name(i:i), PLAIN) > 0) name(i:i) = '_'
      end do
      name = name//'.run'
      if (n > 1) name = name//'-'//to_text(n)
      name = name//'.msh'
   end function mesh_copy_name

end module atrito_as_run_names
