!> Nodes of the deck that stay opposite to each other when its elements are cut: those of both sides of a contact pair or a tie that
!> face each other one by one, and those that an equation of two nodes joins, as on periodic sides.
module atrito_partner_nodes
   use atrito_bilateral_rows, only: ROW_EQUATION, ROW_TIE
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: face_end, side_count
   use atrito_model, only: model_t
   implicit none (type, external)
   private
   public :: partner_nodes

   real(wp), parameter :: FEW = 100*EPS_MACH

contains

   !> Of each node the least of those that it stays with, itself where there are no others.
   pure function partner_nodes(model) result(partner)
      type(model_t), intent(in) :: model               !< with the mesh of the deck
      integer(ip) :: partner(model%mesh%n_nodes)
      integer(ip) :: e, i, j, k, side

      partner = [(i, i=1, model%mesh%n_nodes)]
      do i = 1, size(model%points, kind=ip)
         associate (pair => model%points(i))
            do j = 1, pair%n
               associate (first => pair%first(j), last => pair%first(j + 1) - 1)
                  if (last /= first + 1) cycle
                  if (any(abs(abs(pair%coefficient(first:last)) - 1) > FEW)) cycle
                  call join(pair%entry(first), pair%entry(last), partner)
               end associate
            end do
         end associate
      end do
      do i = 1, model%bilateral%n
         if (all(model%bilateral%kind(i) /= [ROW_EQUATION, ROW_TIE])) cycle
         if (model%bilateral%first(i + 1) /= model%bilateral%first(i) + 2) cycle
         k = model%bilateral%first(i)
         associate (node => model%bilateral%node, v => model%bilateral%vector)
            if (maxval(abs(v(:, k) + v(:, k + 1))) < FEW*maxval(abs(v(:, k)))) call join(node(k), node(k + 1), partner)
         end associate
      end do
      partner = [(last_of(i, partner), i=1, size(partner, kind=ip))]
      do e = 1, model%mesh%n_elements                  ! both ends of a side face the same node: that is no partner
         do side = 1, side_count(model%mesh, e)
            if (partner(model%mesh%nodes(side, e)) == partner(model%mesh%nodes(face_end(model%mesh, e, side), e))) then
               partner = [(i, i=1, model%mesh%n_nodes)]
               return
            end if
         end do
      end do
   end function partner_nodes

   pure subroutine join(a, b, partner)
      integer(ip), intent(in) :: a, b
      integer(ip), intent(inout) :: partner(:)
      integer(ip) :: ends(2)

      if (max(a, b) > size(partner)) return            ! reference nodes of rigid bodies
      ends = [last_of(a, partner), last_of(b, partner)]
      partner(maxval(ends)) = minval(ends)
   end subroutine join

   pure integer(ip) function last_of(node, partner) result(last)
      integer(ip), intent(in) :: node
      integer(ip), intent(in) :: partner(:)

      last = node
      do while (partner(last) /= last)
         last = partner(last)
      end do
   end function last_of

end module atrito_partner_nodes
