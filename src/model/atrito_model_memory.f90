!> Whether the machine can hold a mesh, asked before it is made.
module atrito_model_memory
   use atrito_deck, only: token_t
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t
   use atrito_kinds, only: lp
   use atrito_memory, only: memory_text
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: fits_memory, mesh_bytes

   !> What a node and an element take at the peak between reading and solving, measured with blocks of a million nodes: Q1 340
   !> bytes a node, refined 440, Q2 440.
   integer(lp), parameter :: NODE_BYTES = 500_lp, ELEMENT_BYTES = 100_lp

contains

   !> Bytes of a mesh with all that is built round it before the solution.
   pure integer(lp) function mesh_bytes(n_nodes, n_elements) result(bytes)
      integer(lp), intent(in) :: n_nodes, n_elements

      bytes = NODE_BYTES*n_nodes + ELEMENT_BYTES*n_elements
   end function mesh_bytes

   !> False, and an error, when the mesh with some more nodes and elements needs more memory than there is.
   logical function fits_memory(place, context, new_nodes, new_elements, keyword) result(fits)
      type(token_t), intent(in) :: place               !< of the item or keyword that asks for them; source 0: none
      type(build_context_t), intent(in) :: context
      integer(lp), intent(in) :: new_nodes, new_elements
      character(len=*), intent(in), optional :: keyword
      integer(lp) :: n_nodes, n_elements

      n_nodes = new_nodes + int(context%model%mesh%n_nodes, lp)
      n_elements = new_elements + int(context%model%mesh%n_elements, lp)
      fits = mesh_bytes(n_nodes, n_elements) <= context%memory
      if (fits) return
      call report_error(context%deck, place, 'E-MEMORY', 'a mesh of '//to_text(n_nodes)//' nodes and '//to_text(n_elements)// &
                        ' elements needs about '//memory_text(mesh_bytes(n_nodes, n_elements))//' of memory, there are '// &
                        memory_text(context%memory), expected='a coarser mesh, or a larger machine', keyword=keyword)
   end function fits_memory

end module atrito_model_memory
