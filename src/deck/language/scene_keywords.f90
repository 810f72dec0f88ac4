!> Definitions of the keywords of materials, sections, contact and supports.
module atrito_scene_keywords
   use atrito_kinds, only: ip
   use atrito_keyword, only: keyword_list_t, define_keyword, add_option, add_form, add_item, add_example, LEVEL_MODEL, LEVEL_BOTH, &
                             ANY_NUMBER, KIND_FLAG, KIND_NAME, KIND_WORD, KIND_INTEGER, KIND_REAL, KIND_ID_OR_NAME, KIND_TEXT, &
                             KIND_REAL_OR_NAME, NO_EFFECT
   implicit none (type, external)
   private
   public :: define_scene_keywords

   !> Of an orthotropic material, on its first line.
   character(len=*), parameter :: STIFFNESSES(8) = ['D1111', 'D1122', 'D2222', 'D1133', 'D2233', 'D3333', 'D1212', 'D1313']

contains

   !> Adds the keywords of the scene: materials, contact, supports, constraints, in the order of the manual.
   subroutine define_scene_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_material_keywords(k)
      call define_interaction_keywords(k)
      call define_contact_keywords(k)
      call define_boundary(k)
      call define_initial_conditions(k)
      call define_linear_constraints(k)
      call define_tie(k)
      call define_pretension(k)
      call define_springs(k)
   end subroutine define_scene_keywords

   subroutine define_material_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'MATERIAL', LEVEL_MODEL, 'begins a material', doc='*ELASTIC, *DENSITY and *EXPANSION follow.')
      call add_option(k, 'NAME!', KIND_NAME, 'name of the material')
      call add_example(k, '*MATERIAL, NAME=concrete|*ELASTIC|25e6, 0.2')

      call define_keyword(k, 'ELASTIC', LEVEL_MODEL, 'linear elasticity, isotropic or orthotropic', parent='MATERIAL', &
                          doc='Orthotropic: the third axis stands across the plane, the first one is x, or what '// &
                          'ORIENTATION= of *SOLID SECTION says. nu12 is the strain along 2 by a stress along 1. '// &
                          'ENGINEERING CONSTANTS: E1, E2, E3, nu12, nu13, nu23, G12, G13, and G23 on a second line. '// &
                          'ORTHO: D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, and D2323. '// &
                          'G13, G23, D1313 and D2323 have no effect in the plane. '// &
                          'Lines for further temperatures must say the same.')
      call add_option(k, 'TYPE', KIND_WORD, 'symmetry of the material', default='ISOTROPIC', &
                      choices='ISOTROPIC ISO ENGINEERING_CONSTANTS ORTHO ORTHOTROPIC -ANISOTROPIC')
      call add_form(k, 'the constants', 1, ANY_NUMBER, when='TYPE=ISOTROPIC|ISO')
      call add_item(k, 'E', KIND_REAL, "Young's modulus, > 0", dimension='F/L^2')
      call add_item(k, 'mu', KIND_REAL, "Poisson's ratio: plane strain -1 < mu < 0.5, plane stress -1 < mu <= 0.5", dimension='-')
      call add_item(k, '[temperature]', KIND_REAL, NO_EFFECT, dimension='temperature')
      call add_orthotropic_forms(k)
      call add_example(k, '*ELASTIC|1000., 0.3|*ELASTIC, TYPE=ENGINEERING CONSTANTS|11e6, 4e5, 4e5, 0.3, 0.3, 0.4, 7e5, 7e5|1.4e5')

      call define_keyword(k, 'DENSITY', LEVEL_MODEL, 'mass per volume, for the loads GRAV and CENTRIF', parent='MATERIAL')
      call add_form(k, 'the constant; lines for further temperatures must say the same', 1, ANY_NUMBER)
      call add_item(k, 'density', KIND_REAL, 'mass per volume, >= 0', dimension='F T^2/L^4')
      call add_item(k, '[temperature]', KIND_REAL, NO_EFFECT, dimension='temperature')
      call add_example(k, '*DENSITY|2.5')

      call define_keyword(k, 'EXPANSION', LEVEL_MODEL, 'thermal expansion, the same along all axes', parent='MATERIAL', &
                          doc='Strains are alpha times the rise of the temperature, from *INITIAL CONDITIONS to *TEMPERATURE.')
      call add_option(k, 'TYPE', KIND_WORD, 'symmetry of the expansion', default='ISO', choices='ISO -ORTHO -ANISO')
      call add_option(k, '(ZERO)', KIND_REAL, 'reference temperature: alpha is constant, only differences count')
      call add_form(k, 'the constant; lines for further temperatures must say the same', 1, ANY_NUMBER)
      call add_item(k, 'alpha', KIND_REAL, 'strain a unit of temperature', dimension='1/temperature')
      call add_item(k, '[temperature]', KIND_REAL, NO_EFFECT, dimension='temperature')
      call add_example(k, '*EXPANSION|1.2e-5')

      call define_keyword(k, 'ORIENTATION', LEVEL_MODEL, 'axes of an orthotropic material', &
                          doc='The first axis points from the origin to a, the second lies on the side of b. A second line '// &
                          'turns both about the third axis. What is printed is along x and y.')
      call add_option(k, 'NAME!', KIND_NAME, 'name of the axes')
      call add_option(k, 'SYSTEM', KIND_WORD, 'kind of the axes', default='RECTANGULAR', choices='RECTANGULAR -CYLINDRICAL')
      call add_option(k, 'DEFINITION', KIND_WORD, 'how they are given', default='COORDINATES', &
                      choices='COORDINATES -NODES -OFFSET_TO_NODES')
      call add_form(k, 'the points', 1, 1)
      call add_item(k, 'xa', KIND_REAL, 'point a', dimension='L')
      call add_item(k, 'ya', KIND_REAL, 'point a', dimension='L')
      call add_item(k, 'za', KIND_REAL, 'point a, must be 0', dimension='L')
      call add_item(k, 'xb', KIND_REAL, 'point b', dimension='L')
      call add_item(k, 'yb', KIND_REAL, 'point b', dimension='L')
      call add_item(k, 'zb', KIND_REAL, 'point b, must be 0', dimension='L')
      call add_item(k, '(further)...', KIND_REAL, 'of other programs')
      call add_form(k, 'a rotation', 0, 1)
      call add_item(k, 'axis', KIND_INTEGER, '3')
      call add_item(k, 'angle', KIND_REAL, 'in degrees, from the first axis to the second', dimension='-', default='0')
      call add_example(k, '*ORIENTATION, NAME=grain|1., 0., 0., 0., 1., 0.|3, 30.')

      call define_keyword(k, 'SOLID SECTION', LEVEL_MODEL, 'gives elements a material and a thickness', &
                          doc='Every element has exactly one section. BBAR gives CPE4 and CAX4 elements one dilatation, the '// &
                          'mean of each: they do not lock near mu = 0.5. Other elements are left as they are; but for those '// &
                          'with three nodes they do not need it. That of CAX elements has no effect.')
      call add_option(k, 'ELSET!', KIND_NAME, 'the elements')
      call add_option(k, 'MATERIAL!', KIND_NAME, 'their material')
      call add_option(k, 'ORIENTATION', KIND_NAME, 'axes of an orthotropic material')
      call add_option(k, 'NODAL THICKNESS', KIND_FLAG, 'the thickness is that of *NODAL THICKNESS')
      call add_option(k, 'FORMULATION+', KIND_WORD, 'how the stiffness is integrated', default='STANDARD', choices='STANDARD BBAR')
      call add_form(k, 'the thickness', 0, 1)
      call add_item(k, 'thickness', KIND_REAL, '> 0', dimension='L', default='1')
      call add_example(k, '*SOLID SECTION, ELSET=plate, MATERIAL=concrete|0.2')

      call define_keyword(k, 'NODAL THICKNESS', LEVEL_MODEL, 'gives nodes a thickness', &
                          doc='Plane elements of a *SOLID SECTION with NODAL THICKNESS interpolate it by shape functions. '// &
                          'All their nodes need one, those in the middle of sides, too; --refine does not change that field.')
      call add_form(k, 'one thickness a line', 1, ANY_NUMBER)
      call add_item(k, 'node', KIND_ID_OR_NAME, 'number of a node, or a node set')
      call add_item(k, 'thickness', KIND_REAL, '> 0', dimension='L')
      call add_example(k, '*NODAL THICKNESS|root, 0.02|tip, 0.01')
   end subroutine define_material_keywords

   subroutine add_orthotropic_forms(k)
      type(keyword_list_t), intent(inout) :: k
      character(len=*), parameter :: MODULUS = 'modulus, > 0', RATIO = "Poisson's ratio", STIFF = 'stiffness'
      integer(ip) :: i

      call add_form(k, 'eight of the constants', 1, 1, when='TYPE=ENGINEERING CONSTANTS')
      do i = 1, 3
         call add_item(k, 'E'//achar(iachar('0') + i), KIND_REAL, MODULUS, dimension='F/L^2')
      end do
      call add_item(k, 'nu12', KIND_REAL, RATIO, dimension='-')
      call add_item(k, 'nu13', KIND_REAL, RATIO, dimension='-')
      call add_item(k, 'nu23', KIND_REAL, RATIO, dimension='-')
      call add_item(k, 'G12', KIND_REAL, MODULUS, dimension='F/L^2')
      call add_item(k, 'G13', KIND_REAL, MODULUS, dimension='F/L^2')
      call add_form(k, 'the last one', 1, 1, when='TYPE=ENGINEERING CONSTANTS')
      call add_item(k, 'G23', KIND_REAL, MODULUS, dimension='F/L^2')
      call add_item(k, '[temperature]', KIND_REAL, NO_EFFECT, dimension='temperature')
      call add_form(k, 'eight of the stiffnesses', 1, 1, when='TYPE=ORTHO|ORTHOTROPIC')
      do i = 1, 8
         call add_item(k, STIFFNESSES(i), KIND_REAL, STIFF, dimension='F/L^2')
      end do
      call add_form(k, 'the last one', 1, 1, when='TYPE=ORTHO|ORTHOTROPIC')
      call add_item(k, 'D2323', KIND_REAL, STIFF, dimension='F/L^2')
      call add_item(k, '[temperature]', KIND_REAL, NO_EFFECT, dimension='temperature')
   end subroutine add_orthotropic_forms

   subroutine define_interaction_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'SURFACE INTERACTION', LEVEL_MODEL, 'begins a law of contact', &
                          doc='*SURFACE BEHAVIOR and *FRICTION follow; without them contact is hard and without friction.')
      call add_option(k, 'NAME!', KIND_NAME, 'name of the law')
      call add_form(k, 'a thickness, written by preprocessors', 0, 1, harmless=.true.)
      call add_item(k, '[thickness]', KIND_REAL, NO_EFFECT, dimension='L')
      call add_example(k, '*SURFACE INTERACTION, NAME=rough|*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD|*FRICTION|0.3')

      call define_keyword(k, 'SURFACE BEHAVIOR', LEVEL_MODEL, 'pressure against penetration', parent='SURFACE INTERACTION', &
                          doc='HARD: no penetration, delta = 0. LINEAR: pressure = slope times penetration. PENALTY: '// &
                          'pressure = penetration over delta, the penalty parameter of the paper; delta = 0 is HARD.')
      call add_option(k, 'PRESSURE-OVERCLOSURE', KIND_WORD, 'the law', default='HARD', choices='HARD LINEAR PENALTY+')
      call add_form(k, 'of LINEAR', 1, 1, when='PRESSURE-OVERCLOSURE=LINEAR')
      call add_item(k, 'slope', KIND_REAL, 'pressure over penetration, 1/delta, > 0', dimension='F/L^3')
      call add_item(k, '(further)...', KIND_REAL, 'of other programs')
      call add_form(k, 'of PENALTY', 1, 1, when='PRESSURE-OVERCLOSURE=PENALTY')
      call add_item(k, 'delta', KIND_REAL, 'penetration over pressure, >= 0', dimension='L^3/F')
      call add_example(k, '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY|1e-6')

      call define_keyword(k, 'FRICTION', LEVEL_MODEL, "Coulomb's law, local or the nonlocal one of the paper", &
                          parent='SURFACE INTERACTION', &
                          doc='Local: shear = min(stick slope |u_T|, nu p); without a stick slope exact stick. NONLOCAL: '// &
                          'shear = nu S_rho(p) phi''(|u_T|) with the average S_rho of the pressure and the smoothed phi of '// &
                          'the paper. nu = 0 is no friction, eps = 0 exact stick, rho = 0 local. In a '// &
                          'history a local law remembers where it stuck: slip counts from the last increment, as in Abaqus and '// &
                          'CalculiX. The nonlocal law of the paper has the whole slip u_T since the beginning. SLIP= chooses '// &
                          'the other way. In one increment from rest both are the same.')
      call add_option(k, 'NONLOCAL+', KIND_FLAG, 'the law of the paper')
      call add_option(k, 'SLIP+', KIND_WORD, 'from where slip counts: from the beginning, or from the last increment; '// &
                      'INCREMENTAL when left out, with NONLOCAL TOTAL', choices='TOTAL INCREMENTAL')
      call add_option(k, 'KERNEL+', KIND_WORD, 'average normalised on the quadrature points, or on the whole line', &
                      default='POINTS', choices='POINTS LINE', needs='NONLOCAL')
      call add_form(k, 'local', 1, 1, when='-NONLOCAL')
      call add_item(k, 'nu', KIND_REAL, 'coefficient of friction, >= 0', dimension='-')
      call add_item(k, '[stick slope]', KIND_REAL, 'shear over slip while sticking, > 0; exact stick when left out', &
                    dimension='F/L^3')
      call add_form(k, 'nonlocal', 1, 1, when='NONLOCAL')
      call add_item(k, 'nu', KIND_REAL, 'coefficient of friction, >= 0', dimension='-')
      call add_item(k, 'eps', KIND_REAL, 'slip up to which phi is smoothed, >= 0', dimension='L')
      call add_item(k, 'rho', KIND_REAL, 'radius of the average by straight distance, >= 0', dimension='L')
      call add_example(k, '*FRICTION, NONLOCAL|0.3, 4e-4, 0.1')
   end subroutine define_interaction_keywords

   subroutine define_contact_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'CONTACT PAIR', LEVEL_MODEL, 'two surfaces that may touch', &
                          doc='The contact points are the slave''s nodes. NODAL: the gap at each, by the trapezoidal or '// &
                          'Simpson''s rule. MORTAR: the gap in the mean round each, by integrals over segments cut at '// &
                          'the nodes of both sides, for sides that do not match. A slave that is stiffer and finer than its '// &
                          'master is exchanged with it, which is told.')
      call add_option(k, 'INTERACTION!', KIND_NAME, 'the law of contact')
      call add_option(k, 'QUADRATURE+', KIND_WORD, 'how the gap is measured; left out: NODAL where the sides match or the '// &
                      'master is rigid, else MORTAR', choices='NODAL MORTAR')
      call add_option(k, 'TYPE', KIND_WORD, 'the same in the words of other programs: NODAL or MORTAR', &
                      choices='NODE_TO_SURFACE SURFACE_TO_SURFACE MORTAR')
      call add_option(k, 'ADJUST', KIND_REAL_OR_NAME, 'slave nodes that overlap the master, or are not farther from it than '// &
                      'this value, or all of a node set, are moved onto it before anything is computed, without strain', &
                      dimension='L')
      call add_option(k, '(SMALL SLIDING)', KIND_FLAG, 'sliding is always small')
      call add_form(k, 'one pair a line', 1, ANY_NUMBER)
      call add_item(k, 'slave', KIND_NAME, 'surface of elements, one connected chain')
      call add_item(k, 'master', KIND_NAME, 'surface of elements, or of a rigid body')
      call add_example(k, '*CONTACT PAIR, INTERACTION=rough|plate-BOTTOM, support-TOP')

      call define_keyword(k, 'CLEARANCE', LEVEL_MODEL, 'gives the initial gaps of a contact pair', &
                          doc='Whatever the coordinates say; a negative gap is an overlap that contact pushes apart, as of a '// &
                          'press fit. Of several lines that name a node the last one counts; points whose node no line names '// &
                          'keep the gap of their coordinates. Between them --refine and --elements interpolate along the faces.')
      call add_option(k, 'SLAVE!', KIND_NAME, 'the slave of a *CONTACT PAIR')
      call add_option(k, 'MASTER!', KIND_NAME, 'its master')
      call add_option(k, 'VALUE', KIND_REAL, 'gap of all points', dimension='L')
      call add_option(k, 'TABULAR', KIND_FLAG, 'the data lines have the gaps')
      call add_form(k, 'gaps by nodes of the slave', 1, ANY_NUMBER, when='TABULAR')
      call add_item(k, 'node', KIND_ID_OR_NAME, 'number of a node, or a node set')
      call add_item(k, 'gap', KIND_REAL, 'initial gap', dimension='L')
      call add_item(k, '(normal)...', KIND_REAL, 'the normal is that of the surfaces')
      call add_example(k, '*CONTACT PAIR, INTERACTION=fit|hub-INSIDE, shaft-OUTSIDE|'// &
                       '*CLEARANCE, SLAVE=hub-INSIDE, MASTER=shaft-OUTSIDE, VALUE=-2e-5')

      call define_keyword(k, 'CONTACT', LEVEL_MODEL, 'begins contact that is found by itself', &
                          doc='*CONTACT INCLUSIONS, *CONTACT EXCLUSIONS and *CONTACT PROPERTY ASSIGNMENT follow. Faces of '// &
                          'different bodies that look at each other become pairs. The slave is the softer body, else the '// &
                          'finer one, else the first in the deck; a rigid surface is the master. A slave ends where its '// &
                          'outline has a corner and where another body or law begins; S_rho is not cut there. A '// &
                          '*CONTACT PAIR goes before what is found.')
      call add_option(k, 'DISTANCE+', KIND_REAL, 'faces farther apart than this take no part; half a face when left out', &
                      dimension='L')
      call add_option(k, 'QUADRATURE+', KIND_WORD, 'as of *CONTACT PAIR', choices='NODAL MORTAR')
      call add_example(k, '*CONTACT|*CONTACT INCLUSIONS, ALL EXTERIOR|*CONTACT PROPERTY ASSIGNMENT|, , rough')

      call define_keyword(k, 'CONTACT INCLUSIONS', LEVEL_MODEL, 'what may touch', parent='CONTACT', &
                          doc='ALL EXTERIOR: all bodies each other. Rigid surfaces take part where a line names them.')
      call add_option(k, 'ALL EXTERIOR', KIND_FLAG, 'the outlines of all bodies')
      call add_surface_pair(k, '-ALL EXTERIOR')
      call add_example(k, '*CONTACT INCLUSIONS, ALL EXTERIOR|*CONTACT INCLUSIONS|, floor')

      call define_keyword(k, 'CONTACT EXCLUSIONS', LEVEL_MODEL, 'what does not touch', parent='CONTACT', &
                          doc='Goes before the inclusions.')
      call add_surface_pair(k, '')
      call add_example(k, '*CONTACT EXCLUSIONS|brick-1-1-TOP, brick-1-2-BOTTOM')

      call define_keyword(k, 'CONTACT PROPERTY ASSIGNMENT', LEVEL_MODEL, 'laws of the contact that is found', parent='CONTACT', &
                          doc='Of several lines that a place belongs to the last one counts. Without one contact is hard and '// &
                          'without friction.')
      call add_surface_pair(k, '')
      call add_item(k, 'interaction', KIND_NAME, 'the law of contact')
      call add_example(k, '*CONTACT PROPERTY ASSIGNMENT|, , rough|brick-1-1-LEFT, , smooth')
   end subroutine define_contact_keywords

   subroutine define_boundary(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'BOUNDARY', LEVEL_BOTH, 'prescribed displacements', &
                          doc='Before *STEP zero values only, which hold until a step says otherwise. Dof 1 is x, 2 is y; a '// &
                          'dof 3 to 6 of value 0 is a note, but 6 turns the reference node of a *RIGID BODY, '// &
                          'counter-clockwise [rad]. Two different values for one dof in a step are an error. A later step has '// &
                          'the displacements of the one before, but for the dofs that its lines give anew. FUNCTION: in the '// &
                          'step, evaluated at each node. '// &
                          'Words alone: ENCASTRE, PINNED and ZASYMM are dofs 1 and 2, XSYMM and YASYMM 1, YSYMM and XASYMM 2, '// &
                          'ZSYMM none; ENCASTRE, XSYMM, YSYMM and ZASYMM also hold dof 6 of a reference node.')
      call add_option(k, 'FUNCTION+', KIND_FLAG, 'the value is an expression in x and y')
      call add_option(k, 'AMPLITUDE', KIND_NAME, 'curve over time that multiplies the values, in a step')
      call add_option(k, 'OP', KIND_WORD, 'MOD: lines change and add; NEW: what was given before, also before *STEP, is '// &
                      'removed; the same in all cards of the keyword in a step', default='MOD', choices='MOD NEW')
      call add_form(k, 'one support a line', 1, ANY_NUMBER, when='-FUNCTION')
      call add_item(k, 'node', KIND_ID_OR_NAME, 'number of a node, or a node set')
      call add_item(k, 'first dof', KIND_INTEGER, '1 or 2; of a reference node also 6; or a word in its place')
      call add_item(k, 'last dof', KIND_INTEGER, '1 or 2; of a reference node also 6', default='first dof')
      call add_item(k, 'value', KIND_REAL, 'displacement; of dof 6 the rotation [rad]', dimension='L', default='0')
      call add_form(k, 'one support a line', 1, ANY_NUMBER, when='FUNCTION')
      call add_item(k, 'node', KIND_ID_OR_NAME, 'number of a node, or a node set')
      call add_item(k, 'first dof', KIND_INTEGER, '1 or 2')
      call add_item(k, 'last dof', KIND_INTEGER, '1 or 2', default='first dof')
      call add_item(k, 'value...', KIND_TEXT, 'expression in x, y and earlier parameters, as in *PARAMETER', dimension='L')
      call add_example(k, '*BOUNDARY|plate-RIGHT, 1|support-BOTTOM, 1, 2|*BOUNDARY, FUNCTION|pillar-TOP, 2, 2, '// &
                       '-(0.10 - 0.001*x)')
   end subroutine define_boundary

   subroutine define_initial_conditions(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'INITIAL CONDITIONS', LEVEL_MODEL, 'temperatures at which there are no thermal strains', &
                          doc='Nodes that no line names have 0.')
      call add_option(k, 'TYPE!', KIND_WORD, 'what the lines give', choices='TEMPERATURE')
      call add_form(k, 'one temperature a line', 1, ANY_NUMBER)
      call add_item(k, 'node', KIND_ID_OR_NAME, 'number of a node, or a node set')
      call add_item(k, 'value', KIND_REAL, 'temperature', dimension='temperature')
      call add_example(k, '*INITIAL CONDITIONS, TYPE=TEMPERATURE|all, 20.')
   end subroutine define_initial_conditions

   subroutine define_linear_constraints(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'TRANSFORM', LEVEL_MODEL, 'local axes of nodes', &
                          doc='*BOUNDARY, *CLOAD, *EQUATION and *SPRING at these nodes, reference nodes too, are along the '// &
                          'local axes; what is printed is along x and y. R: the local x axis points from the origin to a, '// &
                          'local y to the side of b. C: local x is the direction from a to the node, local y is that turned '// &
                          'by +90 degrees.')
      call add_option(k, 'NSET!', KIND_NAME, 'the nodes')
      call add_option(k, 'TYPE', KIND_WORD, 'rectangular or cylindrical', default='R', choices='R C -S')
      call add_form(k, 'the axes', 1, 1)
      call add_item(k, 'xa', KIND_REAL, 'point a', dimension='L')
      call add_item(k, 'ya', KIND_REAL, 'point a', dimension='L')
      call add_item(k, 'za', KIND_REAL, 'point a; of R 0', dimension='L', default='0')
      call add_item(k, 'xb', KIND_REAL, 'point b; of C as point a', dimension='L', default='on the axis')
      call add_item(k, 'yb', KIND_REAL, 'point b; of C as point a', dimension='L', default='on the axis')
      call add_item(k, 'zb', KIND_REAL, 'point b; of R 0', dimension='L', default='0')
      call add_example(k, '*TRANSFORM, NSET=block-BOTTOM|0.8660254, 0.5, 0., -0.5, 0.8660254, 0.|*BOUNDARY|block-BOTTOM, 2')

      call define_keyword(k, 'EQUATION', LEVEL_MODEL, 'linear equations between displacements', &
                          doc='The sum of coefficient times displacement over the terms is 0. Where the first term names a '// &
                          'set, there is one equation for each of its nodes; other terms have one node, or a set of as '// &
                          'many, taken in order. All dofs may be prescribed or take part in other equations.')
      call add_form(k, 'the number of terms, then the terms, up to four a line', 2, ANY_NUMBER)
      call add_item(k, 'node', KIND_ID_OR_NAME, 'number of a node, or a node set; or the number of terms, alone')
      call add_item(k, '[dof]', KIND_INTEGER, '1 or 2, of a reference node also 6, its rotation; other terms of 3 to 6 are 0')
      call add_item(k, '[coefficient]', KIND_REAL, 'not all of them 0', dimension='-')
      call add_item(k, '[further terms]...', KIND_TEXT, 'node, dof, coefficient')
      call add_example(k, '*EQUATION|2|17, 1, 1., 205, 1, -1.')
   end subroutine define_linear_constraints

   subroutine define_tie(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'TIE', LEVEL_MODEL, 'joins two surfaces for good', &
                          doc='The displacements of both sides are the same: in the mean (mortar) where the sides do not '// &
                          'match, node by node where they do. Nodes of the slave farther from the master than the tolerance '// &
                          'are not tied. What is left of a gap makes no strain. A node can be a slave in one tie only.')
      call add_option(k, 'NAME!', KIND_NAME, 'name of the tie')
      call add_option(k, 'ADJUST', KIND_WORD, 'whether nodes of the slave are moved onto the master before anything else', &
                      default='YES', choices='YES NO')
      call add_option(k, 'POSITION TOLERANCE', KIND_REAL, 'farther nodes are not tied; 0.05 of the mean face of the master '// &
                      'when left out', dimension='L')
      call add_option(k, 'TYPE', KIND_WORD, 'always by mortar, or always node by node', &
                      choices='SURFACE_TO_SURFACE NODE_TO_SURFACE')
      call add_option(k, '(NO ROTATION)', KIND_FLAG, 'nodes have no rotations')
      call add_option(k, '(NO THICKNESS)', KIND_FLAG, 'of shells')
      call add_option(k, '-CYCLIC SYMMETRY', KIND_FLAG, 'sectors')
      call add_form(k, 'one tie a line', 1, ANY_NUMBER)
      call add_item(k, 'slave', KIND_NAME, 'surface of elements, one connected chain')
      call add_item(k, 'master', KIND_NAME, 'surface of elements')
      call add_example(k, '*TIE, NAME=glue|layer-BOTTOM, ground-TOP')
   end subroutine define_tie

   subroutine define_pretension(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'PRE-TENSION SECTION', LEVEL_MODEL, 'a section of a bolt, by which it is tightened', &
                          doc='The surface lies inside a body, from outline to outline. There the body is cut; its sides move '// &
                          'alike across the normal, and along it but for one displacement: dof 1 of the node. *CLOAD on that '// &
                          'dof is the force in the section, *BOUNDARY the length that is taken out of the body there. Both '// &
                          'are positive where they pull, for a normal that points away from the elements of the surface. '// &
                          'rigid.tab has both.')
      call add_option(k, 'SURFACE!', KIND_NAME, 'faces inside a body, all of elements on one side of the section')
      call add_option(k, 'NODE!', KIND_ID_OR_NAME, 'a node of no element, or a set of one; where it stands does not matter')
      call add_form(k, 'the normal; that of the faces in the mean when left out', 0, 1)
      call add_item(k, 'nx', KIND_REAL, 'any length', dimension='-')
      call add_item(k, 'ny', KIND_REAL, 'any length', dimension='-', default='0')
      call add_item(k, 'nz', KIND_REAL, '0', dimension='-', default='0')
      call add_example(k, '*PRE-TENSION SECTION, SURFACE=shank, NODE=4608|0., -1.')
   end subroutine define_pretension

   subroutine define_springs(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'SPRING', LEVEL_MODEL, 'gives springs their direction and stiffness', &
                          doc='The springs are made by *ELEMENT, TYPE=SPRING1 (a node to the ground), SPRING2 (between two '// &
                          'nodes) or SPRINGA (along the line between two nodes). The force is stiffness times u_dof of the '// &
                          'first node, less that of the second; of SPRINGA stiffness times elongation, tension > 0.')
      call add_option(k, 'ELSET!', KIND_NAME, 'the springs, as ELSET of their *ELEMENT')
      call add_option(k, '-NONLINEAR', KIND_FLAG, 'force by a table')
      call add_option(k, '-ORIENTATION', KIND_NAME, 'local axes')
      call add_form(k, 'the dofs; SPRINGA has none', 1, 1)
      call add_item(k, 'dof', KIND_INTEGER, 'of the first node, 1 or 2; of a reference node also 6, its rotation')
      call add_item(k, 'second dof', KIND_INTEGER, 'of the second node, of SPRING2', default='dof')
      call add_form(k, 'the stiffness', 0, 1)
      call add_item(k, 'stiffness', KIND_REAL, 'force over elongation, > 0; of dof 6 moment over rotation [F L]', dimension='F/L')
      call add_item(k, '(further)...', KIND_REAL, 'of other programs')
      call add_example(k, '*ELEMENT, TYPE=SPRING1, ELSET=bedding|1001, 17|*SPRING, ELSET=bedding|2|2.5e4')
   end subroutine define_springs

   !> A line of two surfaces; with a condition on an option.
   subroutine add_surface_pair(k, when)
      type(keyword_list_t), intent(inout) :: k
      character(len=*), intent(in) :: when

      call add_form(k, 'one pair of surfaces a line', 1, ANY_NUMBER, when=when)
      call add_item(k, 'surface', KIND_NAME, 'of elements, or of a rigid body', default='the outlines of all bodies')
      call add_item(k, 'other surface', KIND_NAME, 'of elements, or of a rigid body', default='the first, bodies of it each other')
   end subroutine add_surface_pair

end module atrito_scene_keywords
