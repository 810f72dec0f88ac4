!> Where results come from, in words: what the head of every table has beside the deck's name and heading.
module atrito_provenance
   implicit none (type, external)
   private
   public :: provenance_t

   !> A component that is not allocated has no line in a head.
   type :: provenance_t
      character(len=:), allocatable :: parameters    !< of the deck with their values: 'nu = 0.3, q = 10 (--set)'
      character(len=:), allocatable :: options       !< of the command line that change results or tables: '--refine 1'
      character(len=:), allocatable :: digest        !< of the deck as it was run, 16 hexadecimal digits
   end type provenance_t

end module atrito_provenance
