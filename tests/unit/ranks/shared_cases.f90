!> Scenes of decks for the tests of shared scenes.
module shared_cases
   use atrito_body_cache, only: body_cache_t
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_messages, only: count_messages, SEVERITY_ERROR
   use atrito_model, only: model_t
   use atrito_scene_data, only: scene_data_t, solve_options_t, prepare
   use atrito_status, only: status_t, is_ok
   use model_cases, only: build
   implicit none (type, external)
   private
   public :: prepare_deck, PRESSED, WALL, ROWS, PLATENS, LAYERS

   character(len=*), parameter :: STONE = '*MATERIAL, NAME=STONE|*ELASTIC|1000., .3|'
   character(len=*), parameter :: JOINT = '*SURFACE INTERACTION, NAME=JOINT|*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR|1e5|'// &
                                  '*FRICTION|.5, 1e5|*CONTACT PAIR, INTERACTION=JOINT|'

   !> Orthotropic and of varying thickness on isotropic, B-bar; and a block that floats beside them and touches nothing.
   character(len=*), parameter :: LAYERS = &
                                  '*BLOCK, TYPE=CPS4, ELSET=LOWER, NX=6, NY=3|0., 0.|3., 0.|3., 1.|0., 1.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=UPPER, NX=4, NY=3|.5, 1.|2.5, 1.|2.5, 2.|.5, 2.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=LONE, NX=3, NY=3|5., 0.|6., 0.|6., 1.|5., 1.|'// &
                                  STONE//'*MATERIAL, NAME=WOOD|*ELASTIC, TYPE=ENGINEERING CONSTANTS|'// &
                                  '900., 300., 400., .2, .1, .3, 150., 120.|110.|'// &
                                  '*ELSET, ELSET=REST|UPPER, LONE|*SOLID SECTION, ELSET=LOWER, MATERIAL=WOOD, NODAL THICKNESS|'// &
                                  '*SOLID SECTION, ELSET=REST, MATERIAL=STONE, FORMULATION=BBAR|1.|'// &
                                  '*NSET, NSET=OVER, GENERATE|8, 28|*NODAL THICKNESS|LOWER-BOTTOM, 2.|OVER, 3.|'// &
                                  JOINT//'UPPER-BOTTOM, LOWER-TOP|*BOUNDARY|LOWER-BOTTOM, 1, 2|'// &
                                  '*STEP|*STATIC|*DLOAD|UPPER, BY, -1.|*END STEP'

   !> A block on another, pressed and sheared; the meshes do not match.
   character(len=*), parameter :: PRESSED = &
                                  '*BLOCK, TYPE=CPE4, ELSET=LOWER, NX=10, NY=5|0., 0.|2., 0.|2., 1.|0., 1.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=UPPER, NX=7, NY=4|.5, 1.|1.5, 1.|1.5, 1.5|.5, 1.5|'//STONE// &
                                  '*ELSET, ELSET=ALL|LOWER, UPPER|*SOLID SECTION, ELSET=ALL, MATERIAL=STONE|1.|'// &
                                  '*SURFACE INTERACTION, NAME=JOINT|*FRICTION, NONLOCAL|.3, 1e-4, .05|'// &
                                  '*CONTACT PAIR, INTERACTION=JOINT|UPPER-BOTTOM, LOWER-TOP|*BOUNDARY|LOWER-BOTTOM, 1, 2|'// &
                                  '*STEP|*STATIC|*BOUNDARY|UPPER-TOP, 2, 2, -.01|UPPER-TOP, 1, 1, .007|*END STEP'

   !> Three courses of floating blocks in running bond on a long one, with head joints.
   character(len=*), parameter :: WALL = &
                                  '*BLOCK, TYPE=CPE4, ELSET=A, NX=12, NY=2|0., -1.|6., -1.|6., 0.|0., 0.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=B, NX=4, NY=2|0., 0.|2., 0.|2., 1.|0., 1.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=C, NX=4, NY=2|2., 0.|4., 0.|4., 1.|2., 1.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=D, NX=4, NY=2|4., 0.|6., 0.|6., 1.|4., 1.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=E, NX=4, NY=2|1., 1.|3., 1.|3., 2.|1., 2.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=F, NX=4, NY=2|3., 1.|5., 1.|5., 2.|3., 2.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=G, NX=4, NY=2|2., 2.|4., 2.|4., 3.|2., 3.|'//STONE// &
                                  '*ELSET, ELSET=ALL|A, B, C, D, E, F, G|*SOLID SECTION, ELSET=ALL, MATERIAL=STONE|1.|'//JOINT// &
                                  'B-BOTTOM, A-TOP|C-BOTTOM, A-TOP|D-BOTTOM, A-TOP|C-LEFT, B-RIGHT|D-LEFT, C-RIGHT|'// &
                                  'E-BOTTOM, B-TOP|E-BOTTOM, C-TOP|F-BOTTOM, C-TOP|F-BOTTOM, D-TOP|F-LEFT, E-RIGHT|'// &
                                  'G-BOTTOM, E-TOP|G-BOTTOM, F-TOP|*BOUNDARY|A-BOTTOM, 1, 2|'// &
                                  '*STEP|*STATIC|*DLOAD|ALL, BY, -1.|ALL, BX, .1|*END STEP'

   !> A body tied to one on the ground, and one that equations and a spring hold and that nothing touches.
   character(len=*), parameter :: ROWS = &
                                  '*BLOCK, TYPE=CPE4, ELSET=A, NX=6, NY=3|0., 0.|3., 0.|3., 1.|0., 1.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=B, NX=4, NY=3|0., 1.|2., 1.|2., 2.|0., 2.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=C, NX=3, NY=3|4., 0.|5., 0.|5., 1.|4., 1.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=G, NX=7, NY=2|-.5, -1.|5., -1.|5., 0.|-.5, 0.|'//STONE// &
                                  '*ELSET, ELSET=ALL|A, B, C, G|*SOLID SECTION, ELSET=ALL, MATERIAL=STONE|1.|'// &
                                  '*TIE, NAME=GLUE|B-BOTTOM, A-TOP|'//JOINT//'A-BOTTOM, G-TOP|'// &
                                  '*EQUATION|2|49, 2, 1., 87, 2, -1.|2|52, 2, 1., 88, 2, -1.|3|50, 1, 1., 7, 1, -.5, 60, 1, .2|'// &
                                  '*ELEMENT, TYPE=SPRING2, ELSET=S|9001, 60, 48|*SPRING, ELSET=S|1, 1|50.|'// &
                                  '*BOUNDARY|G-BOTTOM, 1, 2|*STEP|*STATIC|*DLOAD|ALL, BY, -1.|B, BX, .2|*END STEP'

   !> Two columns, one of eight nodes an element, between rigid platens: one that is loaded, one that is moved.
   character(len=*), parameter :: PLATENS = &
                                  '*NODE|1000, 1.5, 2.|2000, 1.5, -1.|'// &
                                  '*BLOCK, TYPE=CPE4, ELSET=A, NX=6, NY=6|0., 0.|1., 0.|1., 1.|0., 1.|'// &
                                  '*BLOCK, TYPE=CPE8, ELSET=B, NX=4, NY=5|2., 0.|3., 0.|3., 1.|2., 1.|'// &
                                  '*MATERIAL, NAME=M|*ELASTIC|1000., 0.3|*MATERIAL, NAME=N|*ELASTIC|2500., 0.2|'// &
                                  '*SOLID SECTION, ELSET=A, MATERIAL=M|*SOLID SECTION, ELSET=B, MATERIAL=N|'// &
                                  '*SURFACE, NAME=UP, TYPE=SEGMENTS|START, 4., 1.|LINE, -1., 1.|'// &
                                  '*SURFACE, NAME=DOWN, TYPE=SEGMENTS|START, -1., 0.|LINE, 4., 0.|'// &
                                  '*RIGID BODY, ANALYTICAL SURFACE=UP, REF NODE=1000|'// &
                                  '*RIGID BODY, ANALYTICAL SURFACE=DOWN, REF NODE=2000|'// &
                                  '*SURFACE INTERACTION, NAME=J|*FRICTION|0.4|*CONTACT PAIR, INTERACTION=J|'// &
                                  'A-TOP, UP|B-TOP, UP|A-BOTTOM, DOWN|B-BOTTOM, DOWN|*STEP|*STATIC|*BOUNDARY|'// &
                                  '2000, 1, 2, 0.01|2000, 6, 6, 0.002|*CLOAD|1000, 2, -50.|1000, 6, 6.|1000, 1, 2.|*END STEP'

contains

   !> The scene of a deck in the sparse form, before anything is assembled. The model stays: the scene points to it.
   subroutine prepare_deck(text, data, ok)
      character(len=*), intent(in) :: text
      type(scene_data_t), intent(out) :: data
      logical, intent(out) :: ok
      type(model_t), pointer :: model
      type(body_cache_t) :: store
      type(solve_options_t) :: asked
      type(status_t) :: status

      allocate (model)
      call build(text, model)
      ok = count_messages(SEVERITY_ERROR) == 0
      if (.not. ok) return
      asked%contact_form = CONTACT_SPARSE
      call prepare(model, store, asked, data, status)
      ok = is_ok(status)
   end subroutine prepare_deck

end module shared_cases
