!> Bodies that touch each other, directly or through others: the balance of each such group is a question of its own.
!>
!> Bodies are given by their rigid motions; one that the supports hold has none and parts the groups. Points whose pressures are
!> averaged together belong together, since the pressure of one raises the friction of the other.
module atrito_balance_groups
   use atrito_contact_line, only: contact_line_t
   use atrito_joined_sets, only: find_lowest, join_sets
   use atrito_kinds, only: ip
   use atrito_motion_rows, only: motion_rows_t
   implicit none (type, external)
   private
   public :: balance_groups_t, find_groups

   type :: balance_groups_t
      integer(ip) :: n = 0                       !< groups
      integer(ip), allocatable :: of_motion(:)   !< (k) 1 .. n
      integer(ip), allocatable :: of_point(:)    !< (line%n) 0: no motion, and none of what it is averaged with
   end type balance_groups_t

contains

   !> Groups in the order of their first motions.
   !>
   !> Motions and points are the members of sets that are joined: the motions of a body; each point with the motions that its rows
   !> see; points one of whose pressure is in the friction bound of the other. What is joined in the end is a group. A body that
   !> supports hold has no motion, so it joins nothing: a wall on its foundation is one group, two walls on one foundation are two.
   pure subroutine find_groups(rows, line, groups)
      type(motion_rows_t), intent(in) :: rows       !< G, and the body of each motion
      type(contact_line_t), intent(in) :: line      !< laws and averages of its points are read
      type(balance_groups_t), intent(out) :: groups !< (k) and (line%n), numbered from 1
      integer(ip) :: parent(rows%n_columns + line%n), number(rows%n_columns + line%n), i, j, e

      parent = [(i, i=1, rows%n_columns + line%n)]
      do i = 2, rows%n_columns
         if (rows%body(i) == rows%body(i - 1)) call join_sets(parent, i, i - 1)
      end do
      do i = 1, rows%n
         do e = rows%first(i), rows%first(i + 1) - 1
            call join_sets(parent, rows%n_columns + line%point(i), rows%column(e))
         end do
      end do
      do j = 1, line%n
         if (line%tangential(j) == 0 .or. line%law(j)%nu <= 0) cycle
         do e = line%average%first(j), line%average%first(j + 1) - 1
            if (line%average%value(e) > 0) call join_sets(parent, rows%n_columns + line%average%column(e), rows%n_columns + j)
         end do
      end do
      allocate (groups%of_motion(rows%n_columns), groups%of_point(line%n))
      number = 0
      do i = 1, rows%n_columns + line%n
         e = i
         call find_lowest(parent, e)
         if (i <= rows%n_columns .and. number(e) == 0) then
            groups%n = groups%n + 1
            number(e) = groups%n
         end if
         if (i <= rows%n_columns) groups%of_motion(i) = number(e)
         if (i > rows%n_columns) groups%of_point(i - rows%n_columns) = number(e)
      end do
   end subroutine find_groups

end module atrito_balance_groups
