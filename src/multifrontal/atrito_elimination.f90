!> An order of elimination and its parts.
!>
!> Parts are runs of places that are eliminated together. They form a tree in postorder, each with its children before it: what the
!> elimination of a part couples lies in the part itself and in its ancestors.
module atrito_elimination
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: elimination_t, chain_elimination

   type :: elimination_t
      integer(ip), allocatable :: place(:)       !< (n) of each equation, the kept ones last in their order
      integer(ip), allocatable :: last(:)        !< (parts) last place of each part, ascending; a part may be empty
      integer(ip), allocatable :: parent(:)      !< (parts) part that follows in the tree; 0: the kept equations
      character(len=:), allocatable :: text      !< how the order was found, for the listing
   end type elimination_t

   !> Equations eliminated together when there is no better order than the one of the numbers.
   integer(ip), parameter :: BLOCK = 16_ip

contains

   !> Equations in the order of their numbers, each part the parent of the one before.
   pure function chain_elimination(n, n_kept) result(elimination)
      integer(ip), intent(in) :: n, n_kept
      type(elimination_t) :: elimination
      integer(ip) :: n_parts, p, i

      n_parts = (n - n_kept + BLOCK - 1)/BLOCK
      allocate (elimination%place(n), elimination%last(n_parts), elimination%parent(n_parts))
      do i = 1, n
         elimination%place(i) = i
      end do
      do p = 1, n_parts
         elimination%last(p) = min(p*BLOCK, n - n_kept)
         elimination%parent(p) = merge(p + 1, 0_ip, p < n_parts)
      end do
   end function chain_elimination

end module atrito_elimination
