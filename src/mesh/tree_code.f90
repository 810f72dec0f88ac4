!> Trees as words, for decks: of an element a letter a cell, C where it is cut and L where it is a leaf, each followed by those of
!> its parts; leaves at the end are left out. CLC is an element that is cut, and its second part, too.
module atrito_tree_code
   use atrito_element_trees, only: cut_cell, element_trees_t, part_count
   use atrito_growing_text, only: growing_text_t, append_text
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: code_of_tree, take_code, is_code

   character(len=1), parameter :: CUT = 'C', LEAF = 'L'

contains

   !> The word of an element that is cut.
   pure function code_of_tree(trees, root) result(code)
      type(element_trees_t), intent(in) :: trees      !< children of cells are read
      integer(ip), intent(in) :: root                 !< element of the deck
      character(len=:), allocatable :: code
      type(growing_text_t) :: text

      call add(root, text)
      code = text%letters(:index(text%letters(:text%n), CUT, back=.true.))

   contains

      pure recursive subroutine add(cell, text)
         integer(ip), intent(in) :: cell
         type(growing_text_t), intent(inout) :: text
         integer(ip) :: k

         if (trees%first_child(cell) == 0) then
            call append_text(text, LEAF)
         else
            call append_text(text, CUT)
            do k = 0, part_count(trees, cell) - 1
               call add(trees%first_child(cell) + k, text)
            end do
         end if
      end subroutine add

   end function code_of_tree

   !> Cuts an element as a word says; what is cut already stays cut. The neighbours are not looked after.
   pure subroutine take_code(root, code, trees)
      integer(ip), intent(in) :: root                 !< element of the deck
      character(len=*), intent(in) :: code            !< is_code
      type(element_trees_t), intent(inout) :: trees   !< gets the cells that the word asks for
      integer :: position

      position = 0
      call take(root, trees, position)

   contains

      pure recursive subroutine take(cell, trees, position)
         integer(ip), intent(in) :: cell
         type(element_trees_t), intent(inout) :: trees
         integer, intent(inout) :: position           !< the last letter that was taken
         integer(ip) :: k

         position = position + 1
         if (position > len(code)) return
         if (scan(code(position:position), 'Cc') == 0) return
         call cut_cell(cell, trees)
         if (trees%first_child(cell) == 0) return     ! it cannot be cut further
         do k = 0, part_count(trees, cell) - 1
            call take(trees%first_child(cell) + k, trees, position)
         end do
      end subroutine take

   end subroutine take_code

   !> Whether a word is one of these.
   pure logical function is_code(word)
      character(len=*), intent(in) :: word !< as the user wrote it

      is_code = len(word) > 0 .and. verify(word, 'CLcl') == 0
   end function is_code

end module atrito_tree_code
