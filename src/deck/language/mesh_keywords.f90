!> Definitions of the keywords that make meshes, sets and surfaces.
module atrito_mesh_keywords
   use atrito_element_table, only: SHAPES, KINDS, MOST_NODES
   use atrito_keyword, only: keyword_list_t, define_keyword, add_option, add_form, let_lines_go_on, add_item, add_word_item, &
                             add_example, LEVEL_MODEL, LEVEL_BOTH, ANY_NUMBER, KIND_FLAG, KIND_NAME, KIND_WORD, KIND_INTEGER, &
                             KIND_REAL, KIND_FILE, KIND_ID, KIND_ID_OR_NAME, KIND_TEXT
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: define_mesh_keywords

contains

   !> Adds the keywords of meshes: parameters and files, nodes, elements, blocks, surfaces, parts, in the order of the manual.
   subroutine define_mesh_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_deck_keywords(k)
      call define_node_keywords(k)
      call define_ncopy_and_nset(k)
      call define_element_keywords(k)
      call define_block(k)
      call define_surface_keywords(k)
      call define_part_keywords(k)
   end subroutine define_mesh_keywords

   !> The title, other files, parameters.
   subroutine define_deck_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'HEADING', LEVEL_MODEL, 'title of the deck', &
                          doc='The title stands in the listing and at the top of every table.')
      call add_form(k, 'the title, free text', 0, ANY_NUMBER)
      call add_item(k, '[text]', KIND_TEXT, 'a line of the title')
      call add_example(k, '*HEADING|Plate on its support, units kN and m')

      call define_keyword(k, 'INCLUDE', LEVEL_BOTH, 'reads another file in this place', &
                          doc='The file may begin with data lines of the keyword before. Files may include others, 20 deep. '// &
                          'TYPE=GMSH reads a mesh of Gmsh (.msh, format 4.1 or 2.2, ASCII) before *STEP: physical surfaces '// &
                          'become element sets, physical curves surfaces, all of them node sets; clockwise elements are '// &
                          'turned, nodes of no element are left out. More in docs/user/gmsh.md.')
      call add_option(k, 'INPUT!', KIND_FILE, 'the file, relative to the one that includes it')
      call add_option(k, 'TYPE+', KIND_WORD, 'what the file is, when it is no deck', default='DECK', choices='DECK GMSH')
      call add_option(k, 'ELEMENTS+', KIND_WORD, 'plane state of the elements of a mesh', default='CPS', choices='CPS CPE CAX', &
                      needs='TYPE')
      call add_example(k, '*INCLUDE, INPUT=mesh/plate.inp|*INCLUDE, INPUT=disk.msh, TYPE=GMSH, ELEMENTS=CPE')

      call define_keyword(k, 'PARAMETER', LEVEL_BOTH, 'named numbers, set from the command line by --set', &
                          doc='Stands before the first use. Expressions know + - * / ** ( ) sqrt abs exp log sin cos tan atan '// &
                          'min max pi deg (= pi/180, unless the deck has a parameter deg) and the parameters defined earlier; '// &
                          'all is real, 1/2 is 0.5. A data item or the value of an option that is a number takes an '// &
                          'expression as <...> or -<...>: <name>, -<name>, <2*name>, <sin(30*deg)>. Defined twice is an error.')
      call add_form(k, 'one parameter a line', 1, ANY_NUMBER)
      call add_item(k, 'name = expression', KIND_TEXT, 'letters, digits and underscores, a letter first')
      call add_example(k, '*PARAMETER|q = 1000|eps = 4e-4*q|*DSLOAD|plate-TOP, P, <q>')
   end subroutine define_deck_keywords

   !> Nodes one by one and in rows.
   subroutine define_node_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'NODE', LEVEL_MODEL, 'nodes by number and coordinates', &
                          doc='A number given twice is an error; a node in no element has no unknowns.')
      call add_option(k, 'NSET', KIND_NAME, 'puts these nodes into a node set')
      call add_form(k, 'one node a line', 1, ANY_NUMBER)
      call add_item(k, 'id', KIND_ID, 'number of the node, positive')
      call add_item(k, 'x', KIND_REAL, 'coordinate', dimension='L', default='0')
      call add_item(k, 'y', KIND_REAL, 'coordinate', dimension='L', default='0')
      call add_item(k, 'z', KIND_REAL, 'coordinate, 0 but for 1e-10 of the size of the scene', dimension='L', default='0')
      call add_item(k, '(further)...', KIND_REAL, 'of other programs')
      call add_example(k, '*NODE, NSET=corners|1, 0., 0.|2, 1.5, 0.')

      call define_keyword(k, 'NGEN', LEVEL_MODEL, 'nodes evenly spaced between two nodes', &
                          doc='The two nodes must be defined before; the new nodes lie on the straight line between them.')
      call add_option(k, 'NSET', KIND_NAME, 'puts the end nodes and the new ones into a node set')
      call add_option(k, 'LINE', KIND_WORD, 'shape of the line', choices='P -C')
      call add_form(k, 'one row of nodes a line', 1, ANY_NUMBER)
      call add_item(k, 'first', KIND_ID, 'number of the first node')
      call add_item(k, 'last', KIND_ID, 'number of the last node')
      call add_item(k, 'increment', KIND_INTEGER, 'of the numbers between them', default='1')
      call add_example(k, '*NGEN, NSET=bottom|1, 16, 1')

      call define_keyword(k, 'NFILL', LEVEL_MODEL, 'nodes between two node sets', &
                          doc='The k-th node of the first set is joined to the k-th of the second by evenly spaced nodes.')
      call add_option(k, 'NSET', KIND_NAME, 'puts the nodes of both sets and the new ones into a node set')
      call add_option(k, '-BIAS', KIND_REAL, 'ratio of neighbouring distances')
      call add_form(k, 'one area a line', 1, ANY_NUMBER)
      call add_item(k, 'first set', KIND_NAME, 'node set on one side')
      call add_item(k, 'second set', KIND_NAME, 'node set on the other side')
      call add_item(k, 'intervals', KIND_INTEGER, 'number of intervals between the two')
      call add_item(k, 'increment', KIND_INTEGER, 'of the node numbers from interval to interval', default='1')
      call add_example(k, '*NFILL, NSET=plate|bottom, top, 5, 100')
   end subroutine define_node_keywords

   subroutine define_ncopy_and_nset(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'NCOPY', LEVEL_MODEL, 'copies of nodes, moved', &
                          doc='The set must be defined above. The nodes are moved first, then rotated about the axis.')
      call add_option(k, 'CHANGE NUMBER!', KIND_INTEGER, 'added to the numbers of the nodes')
      call add_option(k, 'OLD SET!', KIND_NAME, 'the nodes that are copied')
      call add_option(k, 'SHIFT!', KIND_FLAG, 'a translation and a rotation')
      call add_option(k, 'MULTIPLE', KIND_INTEGER, 'how often the rotation is done', default='1')
      call add_option(k, 'NEW SET', KIND_NAME, 'puts the copies into a node set')
      call add_option(k, '-REFLECT', KIND_WORD, 'mirrors the nodes')
      call add_option(k, '-POLE', KIND_FLAG, 'projects the nodes from a pole')
      call add_form(k, 'the translation', 1, 1)
      call add_motion_items(k, .true.)
      call add_form(k, 'the rotation', 0, 1)
      call add_motion_items(k, .false.)
      call add_example(k, '*NCOPY, CHANGE NUMBER=1000, OLD SET=stone, SHIFT, NEW SET=next|0., 0., 0.|0., 0., 0., 0., 0., 1., 9.')

      call define_keyword(k, 'NSET', LEVEL_MODEL, 'names a set of nodes', doc='A set named again grows.')
      call add_option(k, 'NSET!', KIND_NAME, 'name of the set')
      call add_set_forms(k, 'node')
      call add_example(k, '*NSET, NSET=base|1, 2, 3, corners|*NSET, NSET=base, GENERATE|10, 20, 2')
   end subroutine define_ncopy_and_nset

   subroutine define_element_keywords(k)
      type(keyword_list_t), intent(inout) :: k
      integer(ip) :: shape

      call define_keyword(k, 'ELEMENT', LEVEL_MODEL, 'elements by number and nodes', &
                          doc='Corners counter-clockwise, then mid-sides (1-2, 2-3, 3-4, 4-1), then the centre. CPE is plane '// &
                          'strain, CPS plane stress, CAX axisymmetric (x the radius >= 0, y the axis; forces are of the full '// &
                          'circle); 4 nodes are bilinear, 9 biquadratic, '// &
                          '8 the same without a centre (serendipity); R: integrated at fewer points. '// &
                          'Faces: S1 = nodes 1-2, S2 = 2-3, '// &
                          'S3 = 3-4, S4 = 4-1. Triangles: 3 nodes are linear, 6 quadratic; mid-sides 1-2, 2-3, 3-1; '// &
                          'S3 = 3-1, and no S4. M3D, a membrane, is plane stress. T3D2 and T3D3 are lines of Gmsh: they have '// &
                          'no stiffness, and their element sets are node sets and surfaces.')
      call add_option(k, 'TYPE!', KIND_WORD, 'type of the elements', choices=element_types()// &
                      ' M3D3 M3D4 M3D4R M3D6 M3D8 M3D8R +M3D9 T3D2 T3D3 SPRING1 SPRING2 SPRINGA')
      call add_option(k, 'ELSET', KIND_NAME, 'puts these elements into an element set')
      do shape = 1, MOST_NODES
         if (SHAPES(shape)%n_nodes > 0) call add_element_form(k, shape)
      end do
      call add_form(k, 'one spring to the ground a line; *SPRING gives its dof', 1, ANY_NUMBER, when='TYPE=SPRING1')
      call add_item(k, 'id', KIND_ID, 'number of the spring, positive')
      call add_item(k, 'node', KIND_ID, 'that it holds')
      call add_form(k, 'one spring between two nodes a line', 1, ANY_NUMBER, when='TYPE=SPRING2|SPRINGA')
      call add_item(k, 'id', KIND_ID, 'number of the spring, positive')
      call add_item(k, 'node 1', KIND_ID, 'first end')
      call add_item(k, 'node 2', KIND_ID, 'second end')
      call add_form(k, 'one line between two nodes a line', 1, ANY_NUMBER, when='TYPE=T3D2')
      call add_item(k, 'id', KIND_ID, 'number of the line, positive')
      call add_item(k, 'node 1', KIND_ID, 'first end')
      call add_item(k, 'node 2', KIND_ID, 'last end')
      call add_form(k, 'one line over three nodes a line', 1, ANY_NUMBER, when='TYPE=T3D3')
      call add_item(k, 'id', KIND_ID, 'number of the line, positive')
      call add_item(k, 'node 1', KIND_ID, 'first end')
      call add_item(k, 'node 2', KIND_ID, 'middle')
      call add_item(k, 'node 3', KIND_ID, 'last end')
      call add_example(k, '*ELEMENT, TYPE=CPE4, ELSET=plate|1, 1, 2, 102, 101')

      call define_keyword(k, 'ELGEN', LEVEL_MODEL, 'repeats an element in a row, and the row', &
                          doc='The new elements have the type of the master element.')
      call add_option(k, 'ELSET', KIND_NAME, 'puts the master element and the new ones into an element set')
      call add_form(k, 'one master element a line', 1, ANY_NUMBER)
      call add_item(k, 'master', KIND_ID, 'number of an element defined before')
      call add_item(k, 'n', KIND_INTEGER, 'elements in the row, the master counted')
      call add_item(k, 'node step', KIND_INTEGER, 'of the node numbers along the row', default='1')
      call add_item(k, 'element step', KIND_INTEGER, 'of the element numbers along the row', default='1')
      call add_item(k, 'rows', KIND_INTEGER, 'number of rows, the first counted', default='1')
      call add_item(k, 'node step of rows', KIND_INTEGER, 'of the node numbers from row to row', default='1')
      call add_item(k, 'element step of rows', KIND_INTEGER, 'of the element numbers from row to row', default='1')
      call add_example(k, '*ELGEN, ELSET=plate|1, 15, 1, 1, 5, 100, 15')

      call define_keyword(k, 'ELCOPY', LEVEL_MODEL, 'copies of elements on other nodes', &
                          doc='The set must be defined above, the nodes anywhere. The new elements have the types of the old ones.')
      call add_option(k, 'ELEMENT SHIFT!', KIND_INTEGER, 'added to the numbers of the elements')
      call add_option(k, 'OLD SET!', KIND_NAME, 'the elements that are copied')
      call add_option(k, 'SHIFT NODES!', KIND_INTEGER, 'added to the numbers of their nodes')
      call add_option(k, 'NEW SET', KIND_NAME, 'puts the copies into an element set')
      call add_option(k, '-REFLECT', KIND_FLAG, 'the nodes are mirrored')
      call add_example(k, '*ELCOPY, ELEMENT SHIFT=100, OLD SET=stone, SHIFT NODES=1000, NEW SET=next')

      call define_keyword(k, 'ELSET', LEVEL_MODEL, 'names a set of elements', doc='A set named again grows.')
      call add_option(k, 'ELSET!', KIND_NAME, 'name of the set')
      call add_set_forms(k, 'element')
      call add_example(k, '*ELSET, ELSET=plate, GENERATE|1, 75')
   end subroutine define_element_keywords

   !> The lines of the elements of one shape.
   subroutine add_element_form(k, shape)
      type(keyword_list_t), intent(inout) :: k
      integer(ip), intent(in) :: shape                 !< place in SHAPES
      character(len=:), allocatable :: names
      integer(ip) :: i

      names = ''
      do i = 1, size(KINDS, kind=ip)
         if (KINDS(i)%shape /= shape) cycle
         names = names//'|'//trim(KINDS(i)%name)
         if (KINDS(i)%name(:3) == 'CPS') names = names//'|M3D'//trim(KINDS(i)%name(4:))
      end do
      call add_form(k, 'one element a line', 1, ANY_NUMBER, when='TYPE='//names(2:))
      call let_lines_go_on(k)
      call add_item(k, 'id', KIND_ID, 'number of the element, positive')
      do i = 1, shape
         call add_item(k, 'node '//achar(iachar('0') + i), KIND_ID, merge('corner  ', 'mid-side', i <= SHAPES(shape)%n_corners))
      end do
   end subroutine add_element_form

   !> The names of all elements, a + behind those that Abaqus has not.
   pure function element_types() result(names)
      character(len=:), allocatable :: names
      integer(ip) :: i

      names = ''
      do i = 1, size(KINDS, kind=ip)
         names = names//' '//trim(KINDS(i)%name)//trim(merge('+', ' ', KINDS(i)%own))
      end do
      names = names(2:)
   end function element_types

   subroutine define_block(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'BLOCK+', LEVEL_MODEL, 'a meshed quadrilateral with its sets and surfaces', &
                          doc='Numbers follow the greatest so far, row by row from BOTTOM, the side of the first two corners. '// &
                          'Makes the node set <elset>, and the node sets and surfaces <elset>-BOTTOM, -RIGHT, -TOP and '// &
                          '-LEFT. COPY makes columns and rows of equal blocks, each a body of its own: that in column 3 of '// &
                          'row 2 is <elset>-3-2, with its own sets and sides; <elset> holds all of them, and <elset>-BOTTOM '// &
                          'those of the first row, -TOP of the last row, -LEFT of the first column, -RIGHT of the last. '// &
                          'Triangles come in twos: each square is cut from its corner towards LEFT and BOTTOM.')
      call add_option(k, 'TYPE!', KIND_WORD, 'type of the elements', choices=element_types())
      call add_option(k, 'ELSET!', KIND_NAME, 'name of the block')
      call add_option(k, 'NX!', KIND_INTEGER, 'elements along BOTTOM; triangles: squares, of two each')
      call add_option(k, 'NY!', KIND_INTEGER, 'elements along LEFT')
      call add_option(k, 'MERGE', KIND_NAME, 'block, of as many nodes an element, with which it shares the '// &
                      'nodes that coincide within 1e-6 of an edge')
      call add_form(k, 'the four corners, counter-clockwise', 4, 4)
      call add_item(k, 'x', KIND_REAL, 'coordinate', dimension='L')
      call add_item(k, 'y', KIND_REAL, 'coordinate', dimension='L')
      call add_form(k, 'grading', 0, 1, word='GRADE')
      call add_item(k, 'rx', KIND_REAL, 'last over first element length along BOTTOM', dimension='-')
      call add_item(k, 'ry', KIND_REAL, 'last over first element length along LEFT', dimension='-')
      call add_form(k, 'inner break points along BOTTOM', 0, 1, word='X')
      call add_item(k, 'x1...', KIND_REAL, 'rising, between 0 and 1; NX - 1 of them', dimension='-')
      call add_form(k, 'inner break points along LEFT', 0, 1, word='Y')
      call add_item(k, 'y1...', KIND_REAL, 'rising, between 0 and 1; NY - 1 of them', dimension='-')
      call add_form(k, 'sides that are arcs of less than 180 degrees', 0, 4, word='ARC')
      call add_word_item(k, 'side', 'BOTTOM RIGHT TOP LEFT', 'which of the four')
      call add_item(k, 'xc', KIND_REAL, 'coordinate of the centre, as far from both ends', dimension='L')
      call add_item(k, 'yc', KIND_REAL, 'coordinate of the centre', dimension='L')
      call add_form(k, 'further blocks with which it shares nodes', 0, ANY_NUMBER, word='MERGE')
      call add_item(k, 'block...', KIND_NAME, 'as of MERGE=')
      call add_form(k, 'columns and rows of equal blocks', 0, 1, word='COPY')
      call add_item(k, 'columns', KIND_INTEGER, 'number of them, the block itself counted')
      call add_item(k, 'rows', KIND_INTEGER, 'number of them, the block itself counted')
      call add_item(k, 'dx', KIND_REAL, 'along x from column to column', dimension='L')
      call add_item(k, 'dy', KIND_REAL, 'along y from row to row', dimension='L')
      call add_item(k, 'dx of rows', KIND_REAL, 'along x from row to row', dimension='L', default='0')
      call add_item(k, 'dy of columns', KIND_REAL, 'along y from column to column', dimension='L', default='0')
      call add_example(k, '*BLOCK, TYPE=CPE4, ELSET=plate, NX=15, NY=5|0.0, 0.0|1.5, 0.0|1.5, 0.5|0.0, 0.5|'// &
                       '*BLOCK, TYPE=CPE4, ELSET=brick, NX=8, NY=4|0., 1.|2., 1.|2., 2.|0., 2.|COPY, 10, 5, 2., 2.')
   end subroutine define_block

   subroutine define_surface_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'SURFACE', LEVEL_MODEL, 'names a surface: faces of elements, or a drawn line', &
                          doc='Over a set, face Sn of each of its elements; without a face, all outer faces. A face inside the '// &
                          'mesh is an error. TYPE=NODE: the outer faces all of whose nodes are listed. The outward '// &
                          'normal of a drawn line is its direction of travel turned by +90 '// &
                          'degrees: a floor drawn from left to right faces up. An arc runs the shorter way round its centre, '// &
                          'which is as far from both ends within 1e-4 and is moved to be so exactly.')
      call add_option(k, 'NAME!', KIND_NAME, 'name of the surface')
      call add_option(k, 'TYPE', KIND_WORD, 'kind of surface', default='ELEMENT', choices='ELEMENT NODE SEGMENTS')
      call add_option(k, '(INTERNAL)', KIND_FLAG, 'mark of a preprocessor')
      call add_form(k, 'faces', 1, ANY_NUMBER, when='TYPE=ELEMENT')
      call add_item(k, 'element', KIND_ID_OR_NAME, 'number of an element, or an element set')
      call add_word_item(k, '[face]', 'S1 S2 S3 S4', 'face of each element; all outer faces when left out')
      call add_form(k, 'nodes', 1, ANY_NUMBER, when='TYPE=NODE')
      call add_item(k, 'node', KIND_ID_OR_NAME, 'number of a node, or a node set')
      call add_item(k, '(area)', KIND_REAL, 'of another solver; each node or set has its line')
      call add_form(k, 'where the line begins', 1, 1, when='TYPE=SEGMENTS', word='START')
      call add_item(k, 'x', KIND_REAL, 'coordinate', dimension='L')
      call add_item(k, 'y', KIND_REAL, 'coordinate', dimension='L')
      call add_form(k, 'a straight segment', 0, ANY_NUMBER, when='TYPE=SEGMENTS', word='LINE')
      call add_item(k, 'x', KIND_REAL, 'coordinate of its end', dimension='L')
      call add_item(k, 'y', KIND_REAL, 'coordinate of its end', dimension='L')
      call add_form(k, 'an arc of less than 180 degrees', 0, ANY_NUMBER, when='TYPE=SEGMENTS', word='CIRCL')
      call add_item(k, 'x', KIND_REAL, 'coordinate of its end', dimension='L')
      call add_item(k, 'y', KIND_REAL, 'coordinate of its end', dimension='L')
      call add_item(k, 'xc', KIND_REAL, 'coordinate of its centre', dimension='L')
      call add_item(k, 'yc', KIND_REAL, 'coordinate of its centre', dimension='L')
      call add_example(k, '*SURFACE, NAME=sole|plate, S1|*SURFACE, NAME=floor, TYPE=SEGMENTS|START, -1., 0.|LINE, 2., 0.')

      call define_keyword(k, 'RIGID BODY', LEVEL_MODEL, 'makes a drawn surface, or nodes, a rigid body', &
                      doc='A surface without a reference node is fixed. With one it moves with that node: *BOUNDARY prescribes '// &
                          'its dofs 1, 2 and 6, the rotation about the node, *CLOAD loads them, and what is not prescribed '// &
                          'is free. Nodes of elements that belong to it move as it does, whatever their elements would do '// &
                          'otherwise. Beside CAX elements it moves along the axis alone. rigid.tab has motions and reactions.')
      call add_option(k, 'ANALYTICAL SURFACE', KIND_NAME, 'a surface of TYPE=SEGMENTS')
      call add_option(k, 'NSET', KIND_NAME, 'nodes of elements')
      call add_option(k, 'PIN NSET', KIND_NAME, 'the same: nodes have no rotation of their own')
      call add_option(k, 'TIE NSET', KIND_NAME, 'the same')
      call add_option(k, 'ELSET', KIND_NAME, 'the nodes of these elements')
      call add_option(k, 'REF NODE', KIND_ID_OR_NAME, 'a node of no element, or a set of one')
      call add_example(k, '*RIGID BODY, ANALYTICAL SURFACE=floor|*RIGID BODY, ANALYTICAL SURFACE=punch, REF NODE=1000|'// &
                       '*RIGID BODY, REF NODE=1001, TIE NSET=plate-TOP')
   end subroutine define_surface_keywords

   !> Decks in parts.
   subroutine define_part_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'PART', LEVEL_MODEL, 'begins a part: a mesh that stands in the scene once an *INSTANCE of it', &
                          doc='Its numbers begin at 1, and its sets and surfaces have names of their own. *SOLID SECTION holds '// &
                          'in every instance. Materials, contact, supports and loads stand outside.')
      call add_option(k, 'NAME!', KIND_NAME, 'name of the part')
      call add_example(k, '*PART, NAME=block|*NODE|1, 0., 0.|*END PART')

      call define_keyword(k, 'END PART', LEVEL_MODEL, 'ends a part')
      call add_example(k, '*END PART')

      call define_keyword(k, 'ASSEMBLY', LEVEL_MODEL, 'begins the assembly, in which the instances stand', &
                          doc='Outside of an instance its sets and surfaces are instance.name, its nodes and elements '// &
                          'instance.number; a bare number is one of the assembly. Numbers of the first instance stay as they '// &
                          'are, those of the others get a round number added, which the listing has.')
      call add_option(k, 'NAME', KIND_NAME, 'name of the assembly')
      call add_example(k, '*ASSEMBLY, NAME=all|*INSTANCE, NAME=upper, PART=block|0., 1.|*END INSTANCE|*END ASSEMBLY|*BOUNDARY|'// &
                       'upper.3, 1, 2')

      call define_keyword(k, 'END ASSEMBLY', LEVEL_MODEL, 'ends the assembly')
      call add_example(k, '*END ASSEMBLY')

      call define_keyword(k, 'INSTANCE', LEVEL_MODEL, 'a part in its place', &
                          doc='Moved first, then rotated about the axis. Nodes, elements, sets and surfaces up to *END '// &
                          'INSTANCE are of this instance alone.')
      call add_option(k, 'NAME!', KIND_NAME, 'name of the instance')
      call add_option(k, 'PART!', KIND_NAME, 'the part')
      call add_form(k, 'the translation', 0, 1)
      call add_motion_items(k, .true.)
      call add_form(k, 'the rotation', 0, 1)
      call add_motion_items(k, .false.)
      call add_example(k, '*INSTANCE, NAME=upper, PART=block|0., 1.|0., 1., 0., 0., 1., 1., 90.|*END INSTANCE')

      call define_keyword(k, 'END INSTANCE', LEVEL_MODEL, 'ends an instance')
      call add_example(k, '*END INSTANCE')
   end subroutine define_part_keywords

   !> Items of the line of a translation, or of that of a rotation.
   subroutine add_motion_items(k, is_translation)
      type(keyword_list_t), intent(inout) :: k
      logical, intent(in) :: is_translation

      if (is_translation) then
         call add_item(k, 'dx', KIND_REAL, 'along x', dimension='L')
         call add_item(k, 'dy', KIND_REAL, 'along y', dimension='L')
         call add_item(k, 'dz', KIND_REAL, 'along z, must be 0', dimension='L', default='0')
         return
      end if
      call add_item(k, 'xa', KIND_REAL, 'first point of the axis', dimension='L')
      call add_item(k, 'ya', KIND_REAL, 'first point of the axis', dimension='L')
      call add_item(k, 'za', KIND_REAL, 'first point of the axis', dimension='L')
      call add_item(k, 'xb', KIND_REAL, 'second point of the axis, = xa', dimension='L')
      call add_item(k, 'yb', KIND_REAL, 'second point of the axis, = ya', dimension='L')
      call add_item(k, 'zb', KIND_REAL, 'second point of the axis', dimension='L')
      call add_item(k, 'angle', KIND_REAL, 'round the axis from the first to the second point, in degrees', dimension='-')
   end subroutine add_motion_items

   subroutine add_set_forms(k, member)
      type(keyword_list_t), intent(inout) :: k
      character(len=*), intent(in) :: member

      call add_option(k, 'GENERATE', KIND_FLAG, 'the data lines are ranges of numbers')
      call add_option(k, 'INSTANCE', KIND_NAME, 'in an *ASSEMBLY: the instance of which these are')
      call add_option(k, '(INTERNAL)', KIND_FLAG, 'mark of a preprocessor')
      call add_option(k, '(UNSORTED)', KIND_FLAG, 'sets keep the order of the deck')
      call add_form(k, 'members', 1, ANY_NUMBER, when='-GENERATE')
      call add_item(k, member//'...', KIND_ID_OR_NAME, 'number of the '//member//', or a set defined earlier')
      call add_form(k, 'ranges, one a line', 1, ANY_NUMBER, when='GENERATE')
      call add_item(k, 'first', KIND_ID, 'number of the first '//member)
      call add_item(k, 'last', KIND_ID, 'number of the last '//member)
      call add_item(k, 'increment', KIND_INTEGER, 'from one number to the next; what is beyond the last is left out', default='1')
   end subroutine add_set_forms

end module atrito_mesh_keywords
