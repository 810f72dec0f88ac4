!> Sets of numbers 1..n that are joined two by two, as a forest: each number knows its parent, which is lower, and the lowest of a
!> set is its own. A new forest is parent = [1, 2, ..., n]: each number is a set.
!>
!> Two sets are joined by making the lower of their two roots the parent of the other one. To find a root one goes up, and each
!> number on the way is hung to its grandparent, which halves the way for those who come later: n joins take a time that is as good
!> as linear (R. E. Tarjan, J. van Leeuwen, J. ACM 31 (1984) 245-281).
module atrito_joined_sets
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: join_sets, find_lowest

contains

   !> The sets of a and b become one.
   pure subroutine join_sets(parent, a, b)
      integer(ip), intent(inout) :: parent(:)        !< (n)
      integer(ip), intent(in) :: a, b                !< 1..n
      integer(ip) :: one, other

      one = a
      other = b
      call find_lowest(parent, one)
      call find_lowest(parent, other)
      parent(max(one, other)) = min(one, other)
   end subroutine join_sets

   !> The lowest number of a set.
   pure subroutine find_lowest(parent, number)
      integer(ip), intent(inout) :: parent(:)        !< (n)
      integer(ip), intent(inout) :: number           !< a member; on return the lowest

      do while (parent(number) /= number)
         parent(number) = parent(parent(number))
         number = parent(number)
      end do
   end subroutine find_lowest

end module atrito_joined_sets
