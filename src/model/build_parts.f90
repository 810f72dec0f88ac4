!> What a build context is made of: blocks, sections, what is known of nodes and elements by their numbers, the step that is built.
module atrito_build_parts
   use atrito_block_map, only: block_map_t
   use atrito_deck, only: token_t
   use atrito_id_map, only: id_map_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_load_lists, only: condition_list_t
   use atrito_name_list, only: name_list_t
   use atrito_named_nodes, only: BLOCK_SIDES
   implicit none (type, external)
   private
   public :: drawn_lines_t, open_step_t, inherited_t, replaced_t, numbered_t, block_t, section_cut_t, node_finder_t, BLOCK_SIDES
   public :: LOOSE_HELD, LOOSE_RELEASED, LOOSE_MOVES

   !> A *BLOCK between the pass that makes its nodes and the one that makes its elements.
   type :: block_t
      character(len=:), allocatable :: name            !< NAME= of the card, or that of a copy
      integer(ip) :: card = 0                          !< place in deck%cards
      integer(ip) :: state = 0                         !< place in STATES
      integer(ip) :: shape = 0                         !< place in SHAPES
      integer(ip) :: order = 1                         !< node intervals along an edge of an element
      integer(ip), allocatable :: nodes(:, :)          !< (0:order*nx, 0:order*ny), places; 0: none
      integer(ip) :: first_element = 0                 !< place; row by row from BOTTOM
      integer(ip) :: n_elements = 0                    !< quadrilaterals, or triangles, of it
      integer(ip) :: joined_to = 0                     !< a block that MERGE joins it with; 0: none
      real(wp) :: low(2) = 0.0_wp, high(2) = 0.0_wp    !< the box round its nodes [L]
      character(len=:), allocatable :: array           !< name of the copies of which it is one; not allocated: it is none
      logical :: at_side(4) = .false.                  !< it stands at this side of all copies, as in BLOCK_SIDES
      type(block_map_t) :: map                         !< of its unit square
      real(wp), allocatable :: along(:), across(:)     !< places of its nodes in the unit square, (0:order*nx), (0:order*ny)
   end type block_t

   !> A *PRE-TENSION SECTION: the nodes on the side of its surface's elements, and those on the other that stand there, too.
   type :: section_cut_t
      integer(ip) :: body = 0                          !< its node, place in the model's rigid bodies
      integer(ip), allocatable :: own(:), other(:)     !< (n) places of nodes: own(i) stands where other(i) stands
      real(wp) :: normal(2) = 0.0_wp                   !< unit vector across it
      real(wp) :: size = 0.0_wp                        !< [L] across the nodes
   end type section_cut_t

   !> What is known of the nodes or the elements by their numbers.
   type :: numbered_t
      type(id_map_t) :: invalid                        !< numbers whose definition is faulty
      integer(ip) :: greatest = 0                      !< number
      integer(ip), allocatable :: place(:)             !< of each, by its place in the mesh; > 0: token; < 0: card
   end type numbered_t

   !> Nodes of elements in the order of their x.
   type :: node_finder_t
      integer(ip), allocatable :: node(:)              !< places; not allocated: not asked for yet
      integer(lp), allocatable :: key(:)               !< of x
      real(wp), allocatable :: longest(:)              !< side of the elements round each [L]
      real(wp) :: reach = 0.0_wp                       !< half of the longest of all [L]
   end type node_finder_t

   !> The loads that a step inherits, in lists by the dof or the element on which they act.
   type :: inherited_t
      integer(ip) :: n = 0                             !< the first of the step's loads
      integer(ip), allocatable :: head(:)              !< of each dof or element the first of these; 0: none
      integer(ip), allocatable :: next(:)              !< (n)
   end type inherited_t

   !> Lines of earlier steps whose loads end, and the lines that take their place.
   type :: replaced_t
      integer(ip) :: n = 0                             !< pairs of lines in use
      integer(ip), allocatable :: lines(:, :)          !< (2, n) both lines; those up to n are in use
      integer(ip) :: by = 0                            !< the line that took the last place
      type(id_map_t) :: before                         !< the lines whose loads it has ended so far
   end type replaced_t

   !> The lines of *SECTION PRINT, or of *PATH PRINT, that were read so far.
   type :: drawn_lines_t
      character(len=4) :: what = ''                    !< cut, path
      integer(ip) :: n = 0                             !< of the model
      integer(ip) :: n_before = 0                      !< of them, those of earlier steps
      type(name_list_t) :: names                       !< of those of the step that is being built
      type(token_t), allocatable :: items(:)           !< of each of the model its first item
   end type drawn_lines_t

   !> The step that is being built.
   type :: open_step_t
      integer(ip) :: number = 1                        !< in the order of the deck, from 1
      integer(ip) :: first_card = 1, last_card = 0     !< of the deck: its cards are among these (is_of_step)
      integer(ip) :: first_token = 0                   !< of its lines: what stands before it is inherited
      integer(ip) :: line = 0                          !< of the deck, that is being read
      integer(ip) :: amplitude = 0                     !< that the card being read names
      integer(ip) :: source = 0                        !< of the line being read, place in the model's sources
      type(condition_list_t) :: supports, forces       !< at nodes, along the dofs of the deck, which may be local axes
      type(condition_list_t) :: loads                  !< on elements
      type(inherited_t) :: old_forces, old_loads       !< what earlier steps gave on each dof, element
      type(replaced_t) :: replaced                     !< what ends of earlier steps' loads
   end type open_step_t

   !> A dof of a node of no element: held at 0 so far, no longer, or moved or held later than in the first step; 0: free.
   integer(ip), parameter :: LOOSE_HELD = 1, LOOSE_RELEASED = 2, LOOSE_MOVES = 3

end module atrito_build_parts
