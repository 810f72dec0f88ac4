!> Tied bodies as one: where nodes of both sides of a tie lie in the same places, they become one node.
!>
!> Displacements are then continuous across the tie everywhere, as those of the exact problem, and the side between the bodies is
!> one within a body: the traction that it carries is looked for, of either sign, as that of any side between two elements.
module atrito_glued_ties
   use atrito_bilateral_rows, only: bilateral_rows_t, ROW_TIE
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes, mesh_t
   use atrito_mesh_sides, only: list_sides, mesh_sides_t
   use atrito_model, only: model_t
   implicit none (type, external)
   private
   public :: glue_ties

   real(wp), parameter :: SAME_PLACE = 1.0e-9_wp    !< of a side of an element
   character(len=*), parameter :: NO_MATCH = 'a tie whose sides do not match'

contains

   !> A mesh with the nodes of all ties glued, its sides, and supports and reactions at the nodes that are left.
   !>
   !> why_not: joints of other kinds, or a tie whose sides do not match.
   subroutine glue_ties(model, mesh, sides, held, reaction, why_not)
      type(model_t), intent(in) :: model
      type(mesh_t), intent(inout) :: mesh           !< at first that of the model
      type(mesh_sides_t), intent(out) :: sides
      logical, intent(inout) :: held(:, :)          !< (2, n_nodes)
      real(wp), intent(inout) :: reaction(:, :)     !< (2, n_nodes) [F]
      character(len=:), allocatable, intent(inout) :: why_not
      integer(ip) :: same_as(size(held, 2)), node, i, f

      if (any(model%bilateral%kind(:model%bilateral%n) /= ROW_TIE)) then
         why_not = 'joints other than ties'
         return
      end if
      same_as = [(node, node=1, size(held, 2))]
      call find_same(model%bilateral, same_as, why_not)
      if (.not. allocated(why_not)) call replace_nodes(same_as, mesh, why_not)
      if (allocated(why_not)) return
      call list_sides(mesh, sides)
      do i = 1, size(model%ties, kind=ip)
         associate (faces => model%surfaces(model%ties(i)%slave)%faces)
            do f = 1, faces%n
               associate (nodes => face_nodes(model%mesh, faces%element(f), faces%face(f)))
                  if (any(same_as(nodes(:2)) == nodes(:2))) cycle     ! not tied, or at the end of the master
               end associate
               if (sides%element(2, abs(sides%of_element(faces%face(f), faces%element(f)))) == 0) why_not = NO_MATCH
            end do
         end associate
      end do
      do node = 1, size(same_as, kind=ip)
         associate (other => same_as(node))
            if (other == node) cycle
            held(:, other) = held(:, other) .or. held(:, node)
            held(:, node) = .false.
            reaction(:, other) = reaction(:, other) + reaction(:, node)
         end associate
      end do
   end subroutine glue_ties

   !> The node of the master that each node of a slave is tied to.
   subroutine find_same(rows, same_as, why_not)
      type(bilateral_rows_t), intent(in) :: rows
      integer(ip), intent(inout) :: same_as(:)      !< (n_nodes)
      character(len=:), allocatable, intent(inout) :: why_not
      integer(ip) :: j, node

      do j = 1, rows%n
         associate (k => rows%first(j))
            if (rows%first(j + 1) - k /= 2) then
               why_not = NO_MATCH
            else if (any(abs(rows%vector(:, k) + rows%vector(:, k + 1)) > SAME_PLACE*maxval(abs(rows%vector(:, k))))) then
               why_not = NO_MATCH
            else
               same_as(rows%node(k)) = rows%node(k + 1)
            end if
         end associate
         if (allocated(why_not)) return
      end do
      do node = 1, size(same_as, kind=ip)           ! a master may be the slave of another tie
         do j = 1, size(same_as, kind=ip)
            if (same_as(same_as(node)) == same_as(node)) exit
            same_as(node) = same_as(same_as(node))
         end do
      end do
   end subroutine find_same

   !> Puts the nodes that are left in the place of those that are tied to them.
   subroutine replace_nodes(same_as, mesh, why_not)
      integer(ip), intent(in) :: same_as(:)
      type(mesh_t), intent(inout) :: mesh
      character(len=:), allocatable, intent(inout) :: why_not
      integer(ip) :: e, k

      do e = 1, mesh%n_elements
         do k = 1, mesh%shape(e)
            associate (node => mesh%nodes(k, e))
               if (same_as(node) == node) cycle
               if (norm2(mesh%x(:, same_as(node)) - mesh%x(:, node)) > &
                   SAME_PLACE*norm2(mesh%x(:, mesh%nodes(2, e)) - mesh%x(:, mesh%nodes(1, e)))) why_not = NO_MATCH
               node = same_as(node)
            end associate
         end do
      end do
   end subroutine replace_nodes

end module atrito_glued_ties
