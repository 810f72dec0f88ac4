!> An order of elimination, and what is eliminated together.
!>
!> Supernodes are ranges of positions that are eliminated together. They form a tree in postorder, each with its children before it:
!> what the elimination of a supernode couples lies in the supernode itself and in its ancestors.
module atrito_elimination
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: elimination_t, chain_elimination

   type :: elimination_t
      integer(ip), allocatable :: position(:)       !< (n) of each equation, the retained ones last in their order
      integer(ip), allocatable :: last(:)        !< (supernodes) last position of each, ascending; one may be empty
      integer(ip), allocatable :: parent(:)      !< (supernodes) that follows in the tree; 0: the retained equations
      character(len=:), allocatable :: text      !< how the order was found, for the listing
   end type elimination_t

   !> Equations eliminated together when there is no better order than the one of the numbers.
   integer(ip), parameter :: BLOCK = 16_ip

contains

   !> Equations in the order of their numbers, each supernode the parent of the one before.
   pure function chain_elimination(n, n_retained) result(elimination)
      integer(ip), intent(in) :: n, n_retained !< equations; the last ones of them, which are not eliminated
      type(elimination_t) :: elimination
      integer(ip) :: n_supernodes, p, i

      n_supernodes = (n - n_retained + BLOCK - 1)/BLOCK
      allocate (elimination%position(n), elimination%last(n_supernodes), elimination%parent(n_supernodes))
      do i = 1, n
         elimination%position(i) = i
      end do
      do p = 1, n_supernodes
         elimination%last(p) = min(p*BLOCK, n - n_retained)
         elimination%parent(p) = merge(p + 1, 0_ip, p < n_supernodes)
      end do
   end function chain_elimination

end module atrito_elimination
