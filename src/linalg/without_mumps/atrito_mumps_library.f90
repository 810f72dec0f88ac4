!> The twin of src/linalg/atrito_mumps_library.F90 in a build without MUMPS.
module atrito_mumps_library
   implicit none (type, external)
   private
   public :: has_mumps, mumps_name, mumps_trouble

contains

   !> This build has no MUMPS.
   pure logical function has_mumps()
      has_mumps = .false.
   end function has_mumps

   !> For --version.
   pure function mumps_name() result(name)
      character(len=:), allocatable :: name

      name = 'no MUMPS'
   end function mumps_name

   !> Why there is no MUMPS, for messages.
   pure function mumps_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'this build has none'
   end function mumps_trouble

end module atrito_mumps_library
