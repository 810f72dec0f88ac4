!> Whether the machine, and lists of integers of 32 bits, can hold a mesh, asked before it is made.
module atrito_model_memory
   use atrito_deck, only: token_t
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t
   use atrito_element_table, only: MOST_NODES_OF_ELEMENT => MOST_NODES
   use atrito_kinds, only: ip, lp
   use atrito_memory, only: memory_text
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: allow_large_meshes, fits_memory, mesh_bytes, most_nodes

   !> What a node and an element take at the peak between reading and solving, measured with blocks of a million nodes: Q1 340
   !> bytes a node, refined 440, Q2 440; of 626,000 nodes and 1,203,000 triangles 441 MB, of address space 468 MB.
   integer(lp), parameter :: NODE_BYTES = 500_lp, ELEMENT_BYTES = 140_lp
   !> Sets, surfaces and the body of a *BLOCK, or of one of its copies, from the second on: of 100,000 copies of an element 1 GB.
   integer(lp), parameter :: BLOCK_BYTES = 9000_lp
   !> Nodes of a mesh in one process: more are a slip of the pen. A thousand million displacements have their numbers.
   integer(lp), parameter :: MOST_IN_A_PROCESS = 50000000_lp, MOST_OF_NUMBERS = 500000000_lp
   integer(lp) :: most = MOST_IN_A_PROCESS

contains

   !> Several processes may share a scene: a mesh may have as many nodes as there are numbers for.
   subroutine allow_large_meshes()
      most = MOST_OF_NUMBERS
   end subroutine allow_large_meshes

   !> Nodes that one keyword, or --refine, may make.
   pure integer(lp) function most_nodes()
      most_nodes = most
   end function most_nodes

   !> Bytes of a mesh with all that is built round it before the solution.
   pure integer(lp) function mesh_bytes(n_nodes, n_elements) result(bytes)
      integer(lp), intent(in) :: n_nodes, n_elements   !< >= 0

      bytes = NODE_BYTES*n_nodes + ELEMENT_BYTES*n_elements
   end function mesh_bytes

   !> False, and an error, when the mesh with some more nodes and elements needs more memory than there is, or has more nodes than
   !> there are numbers for: displacements, and the nodes of all elements one behind the other, are counted in 32 bits.
   logical function fits_memory(place, context, new_nodes, new_elements, element_nodes, new_blocks) result(fits)
      type(token_t), intent(in) :: place               !< of the item or keyword that asks for them; source 0: none
      type(build_context_t), intent(inout) :: context  !< its mesh and blocks so far count too; loses has_room
      integer(lp), intent(in) :: new_nodes, new_elements !< to come, >= 0
      integer(ip), intent(in), optional :: element_nodes   !< of each new element; without it they may have as many as there are
      integer(lp), intent(in), optional :: new_blocks  !< blocks to come; default 0
      character(len=:), allocatable :: what
      integer(lp) :: n_nodes, n_elements, n_corners, n_blocks, bytes

      n_nodes = new_nodes + int(context%model%mesh%n_nodes, lp)
      n_elements = new_elements + int(context%model%mesh%n_elements, lp)
      n_corners = MOST_NODES_OF_ELEMENT*new_elements
      if (present(element_nodes)) n_corners = element_nodes*new_elements
      associate (mesh => context%model%mesh)
         n_corners = n_corners + int(MOST_NODES_OF_ELEMENT, lp)*int(mesh%n_elements, lp)
         ! they are fewer, and are counted where that many would be too many
         if (n_corners > int(huge(1_ip), lp) .and. mesh%n_elements > 0) then
            n_corners = n_corners - sum(int(MOST_NODES_OF_ELEMENT - mesh%shape(:mesh%n_elements), lp))
         end if
      end associate
      n_blocks = context%n_blocks
      if (present(new_blocks)) n_blocks = n_blocks + new_blocks
      bytes = mesh_bytes(n_nodes, n_elements) + BLOCK_BYTES*max(n_blocks - 1, 0_lp)
      what = 'a mesh of '//to_text(n_nodes)//' nodes and '//to_text(n_elements)//' elements '
      if (n_blocks > 1) what = what//'in '//to_text(n_blocks)//' blocks '
      fits = bytes <= context%memory
      if (.not. fits) then
         context%has_room = .false.
         call report_error(context%deck, place, 'E-MEMORY', what//'needs about '//memory_text(bytes)//' of memory, there are '// &
                           memory_text(context%memory), expected='a coarser mesh, or a larger machine')
         return
      end if
      fits = n_nodes <= MOST_OF_NUMBERS .and. n_corners <= int(huge(1_ip), lp)
      if (fits) return
      call report_error(context%deck, place, 'E-VALUE', what//'is more than there are numbers for', expected='at most '// &
                        to_text(MOST_OF_NUMBERS)//' nodes, and '//to_text(huge(1_ip))//' nodes of elements')
   end function fits_memory

end module atrito_model_memory
