!> Definitions of the keywords of a step: loads, controls, tables.
module atrito_step_keywords
   use atrito_keyword, only: keyword_list_t, define_keyword, add_option, add_form, add_item, add_word_item, add_example, &
                             LEVEL_MODEL, LEVEL_STEP, LEVEL_BOTH, ANY_NUMBER, KIND_FLAG, KIND_NAME, KIND_WORD, KIND_OPTIONAL_WORD, &
                             KIND_INTEGER, KIND_REAL, KIND_ID_OR_NAME, KIND_TEXT, NO_EFFECT
   implicit none (type, external)
   private
   public :: define_step_keywords

   character(len=*), parameter :: FIELD_FILE = '<deck name>.h5, an HDF5 file that ParaView opens by <deck name>.xdmf; there is '// &
                                  'one when a *... FILE asks for it.'

   character(len=*), parameter :: FREQUENCY_DOC = 'every so many increments, >= 1, and at the end of the step; 0: never; left '// &
                                  'out: at the end alone'
   character(len=*), parameter :: OP_DOC = 'MOD: lines change and add; NEW: what the steps before gave is removed, the same in '// &
                                  'all cards of the keyword in a step'

contains

   !> Adds the keywords of steps: amplitudes, loads, controls and what is printed, in the order of the manual.
   subroutine define_step_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_amplitude(k)
      call define_step(k)
      call define_static(k)
      call define_forces(k)
      call define_element_loads(k)
      call define_temperature(k)
      call define_interference(k)
      call define_controls(k)
      call define_print_keywords(k)
      call define_file_keywords(k)
      call define_restart(k)
      call define_keyword(k, 'END STEP', LEVEL_STEP, 'ends the step', doc='Nothing may follow the last one.')
      call add_example(k, '*END STEP')
   end subroutine define_step_keywords

   subroutine define_amplitude(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'AMPLITUDE', LEVEL_MODEL, 'a curve over time that multiplies loads or displacements', &
                          doc='AMPLITUDE= of *BOUNDARY, *CLOAD, *DLOAD and *DSLOAD names it: each value is multiplied by '// &
                          'that of the curve. Before the first time and after the last the curve stays what it is there. '// &
                          'Times ascend.')
      call add_option(k, 'NAME!', KIND_NAME, 'name of the curve')
      call add_option(k, 'TIME', KIND_WORD, 'times since the beginning of the step, or of the history', default='STEP TIME', &
                      choices='STEP_TIME TOTAL_TIME')
      call add_option(k, 'DEFINITION', KIND_WORD, 'straight between two times, or s^3 (10 - 15 s + 6 s^2), which begins and '// &
                      'ends without a kink', default='TABULAR', choices='TABULAR SMOOTH_STEP')
      call add_option(k, 'VALUE', KIND_WORD, 'values are parts of what the lines of a load give', default='RELATIVE', &
                      choices='RELATIVE -ABSOLUTE')
      call add_option(k, '(SMOOTH)', KIND_REAL, 'for accelerations')
      call add_form(k, 'up to four pairs of time and value a line', 1, ANY_NUMBER)
      call add_item(k, 'time', KIND_REAL, 'later than the one before, >= 0', dimension='time')
      call add_item(k, 'value', KIND_REAL, 'of the curve', dimension='-')
      call add_item(k, '[further]...', KIND_REAL, 'pairs')
      call add_example(k, '*AMPLITUDE, NAME=there-and-back|0., 0., 1., 1., 2., -1., 3., 0.')
   end subroutine define_amplitude

   subroutine define_restart(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'RESTART', LEVEL_BOTH, 'writes a file from which an interrupted history goes on', &
                          doc='It goes on by atrito --restart FILE, not by the deck.')
      call add_option(k, 'WRITE', KIND_FLAG, 'must be given')
      call add_option(k, 'FREQUENCY', KIND_INTEGER, 'increments from one file to the next, >= 1', default='1', needs='WRITE')
      call add_option(k, 'READ', KIND_FLAG, 'is an error: atrito --restart FILE')
      call add_option(k, '(OVERLAY)', KIND_FLAG, 'there is one file, always the newest')
      call add_example(k, '*RESTART, WRITE, FREQUENCY=5')
   end subroutine define_restart

   subroutine define_step(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'STEP', LEVEL_STEP, 'begins a step', &
                          doc='A step has what the steps before gave, but for what its own lines change. Displacements are small.')
      call add_option(k, 'NLGEOM', KIND_OPTIONAL_WORD, 'asks for large displacements: small ones are solved, and at the '// &
                      'end it is told whether that mattered', default='NO', choices='YES NO')
      call add_option(k, '(NAME)', KIND_NAME, 'the step has no name here')
      call add_option(k, 'INC', KIND_INTEGER, 'most increments, >= 1; one more ends the run', default='100')
      call add_option(k, '(PERTURBATION)', KIND_FLAG, 'of other programs')
      call add_option(k, 'AMPLITUDE', KIND_WORD, 'values without an amplitude of their own go linearly over the step, or are '// &
                      'there at once', default='RAMP', choices='RAMP STEP')
      call add_option(k, '(UNSYMM)', KIND_WORD, 'of other programs')
      call add_option(k, '(EXTRAPOLATION)', KIND_WORD, 'of other programs')
      call add_form(k, 'a title of the step', 0, ANY_NUMBER)
      call add_item(k, '[text]', KIND_TEXT, 'a line of the title')
      call add_example(k, '*STEP|press, then|*STATIC|*DSLOAD|plate-TOP, P, 10.|*NODE PRINT|U|*END STEP')
   end subroutine define_step

   subroutine define_static(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'STATIC', LEVEL_STEP, 'the step is static; its increments', &
                          doc='Without a data line the step is one increment of time 1. With one, an increment that does not '// &
                          'converge is halved, down to the least; afterwards increments grow again, up to the greatest.')
      call add_option(k, '(SOLVER)', KIND_WORD, 'atrito takes it from --solver')
      call add_option(k, 'DIRECT', KIND_FLAG, 'all increments are like the first; none is cut')
      call add_form(k, 'increments', 0, 1)
      call add_item(k, 'first increment', KIND_REAL, '> 0, not longer than the step', dimension='time', default='the step')
      call add_item(k, 'length of the step', KIND_REAL, '> 0', dimension='time', default='1')
      call add_item(k, 'least increment', KIND_REAL, '> 0, not longer than the first', dimension='time', &
                    default='1e-5 of the step')
      call add_item(k, 'greatest increment', KIND_REAL, '> 0; a longer first is cut to it', dimension='time', &
                    default='the first; the step where INC of these do not reach its end')
      call add_example(k, '*STATIC|0.1, 1., 1e-4, 0.2')
   end subroutine define_static

   subroutine define_forces(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'CLOAD', LEVEL_STEP, 'forces at nodes', &
                          doc='For the whole thickness, or the full circle of CAX elements. Lines on one dof in a step add up; '// &
                          'they take the place of what earlier steps gave there. At a set every node takes the force. Dof 6 of '// &
                          'the reference node of a *RIGID BODY takes a moment, counter-clockwise [F L].')
      call add_changes(k)
      call add_form(k, 'one force a line', 1, ANY_NUMBER)
      call add_item(k, 'node', KIND_ID_OR_NAME, 'number of a node, or a node set')
      call add_item(k, 'dof', KIND_INTEGER, '1 (x) or 2 (y); of a reference node also 6')
      call add_item(k, 'force', KIND_REAL, 'along the axis', dimension='F')
      call add_example(k, '*CLOAD|7, 2, -10.')
   end subroutine define_forces

   subroutine define_element_loads(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'DLOAD', LEVEL_STEP, 'pressure on faces, force per volume, weight', &
                          doc='P1 to P4: pressure on that face, positive pushes on the element. BX, BY: force per volume. '// &
                          'GRAV: acceleration times *DENSITY along a direction. CENTRIF: *DENSITY times the square of an '// &
                          'angular velocity times the distance from its axis, away from it; the axis goes through x, y, z '// &
                          'along ax, ay, az, across the plane or in it, and is y for CAX elements. '// &
                          'HP1 to HP4 and TRVEC1 to TRVEC4: hydrostatic '// &
                          'pressure and traction on that face, as HP and TRVEC of *DSLOAD. All are multiplied by the '// &
                          'thickness, or go round the full circle.')
      call add_changes(k)
      call add_form(k, 'one load a line', 1, ANY_NUMBER)
      call add_item(k, '[element]', KIND_ID_OR_NAME, 'number of an element, or an element set; left out with BX, BY, '// &
                    'GRAV or CENTRIF: all')
      call add_word_item(k, 'label', 'P1 P2 P3 P4 BX BY GRAV CENTRIF HP1 HP2 HP3 HP4 TRVEC1 TRVEC2 TRVEC3 TRVEC4', 'kind of load')
      call add_item(k, 'magnitude', KIND_REAL, 'P, HP, TRVEC [F/L^2], B [F/L^3], GRAV [L/T^2], CENTRIF [1/T^2]')
      call add_item(k, '[gx]', KIND_REAL, 'direction of GRAV and TRVEC; of HP the level of zero pressure [L]; of CENTRIF x [L]', &
                    dimension='-')
      call add_item(k, '[gy]', KIND_REAL, 'direction of GRAV and TRVEC; of HP the level of the magnitude [L]; of CENTRIF y [L]', &
                    dimension='-')
      call add_item(k, '[gz]', KIND_REAL, 'direction of GRAV and TRVEC, must be 0; of CENTRIF z [L]', dimension='-')
      call add_item(k, '[ax]', KIND_REAL, 'direction of the axis of CENTRIF', dimension='-')
      call add_item(k, '[ay]', KIND_REAL, 'direction of the axis of CENTRIF', dimension='-')
      call add_item(k, '[az]', KIND_REAL, 'direction of the axis of CENTRIF', dimension='-')
      call add_example(k, '*DLOAD|plate, P3, 10.|plate, GRAV, 9.81, 0., -1.')

      call define_keyword(k, 'DSLOAD', LEVEL_STEP, 'pressure and traction on surfaces', &
                          doc='P: pressure, positive pushes on the body. TRVEC: traction of this size along a direction of '// &
                          'any length. HP: hydrostatic pressure, 0 at one level x2, the magnitude at another, linear between '// &
                          'and beyond; on the other side of the first level it is 0. All are multiplied by the thickness.')
      call add_changes(k)
      call add_form(k, 'one load a line', 1, ANY_NUMBER)
      call add_item(k, 'surface', KIND_NAME, 'a surface of elements')
      call add_word_item(k, 'label', 'P TRVEC HP', 'kind of load')
      call add_item(k, 'magnitude', KIND_REAL, 'pressure, positive pushes; TRVEC: along the direction', dimension='F/L^2')
      call add_item(k, '[t1]', KIND_REAL, 'direction of TRVEC; of HP the level of zero pressure [L]', dimension='-')
      call add_item(k, '[t2]', KIND_REAL, 'direction of TRVEC; of HP the level of the magnitude [L]', dimension='-')
      call add_item(k, '[t3]', KIND_REAL, 'direction of TRVEC, must be 0', dimension='-')
      call add_example(k, '*DSLOAD|plate-TOP, P, 10.|plate-TOP, TRVEC, 2., 1., 0.|plate-LEFT, HP, 9.81, 1., 0.')
   end subroutine define_element_loads

   subroutine define_temperature(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'TEMPERATURE', LEVEL_STEP, 'temperatures of nodes, which expand materials with *EXPANSION', &
                          doc='Nodes that no line names keep the temperature of *INITIAL CONDITIONS, or 0. The shape functions '// &
                          'of each element interpolate the temperatures of its nodes, those in the middle of its sides '// &
                          'included; --refine does not change that field.')
      call add_option(k, 'OP', KIND_WORD, OP_DOC, default='MOD', choices='MOD NEW')
      call add_form(k, 'one temperature a line', 1, ANY_NUMBER)
      call add_item(k, 'node', KIND_ID_OR_NAME, 'number of a node, or a node set')
      call add_item(k, 'value', KIND_REAL, 'temperature', dimension='temperature')
      call add_example(k, '*TEMPERATURE|all, 120.')
   end subroutine define_temperature

   subroutine define_controls(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'CONTROLS+', LEVEL_STEP, 'how the contact iteration goes', &
                          doc='PICARD is the iteration of the paper; ANDERSON accelerates it; NEWTON solves for all unknowns '// &
                          'at once.')
      call add_option(k, 'METHOD+', KIND_WORD, 'outer iteration', default='ANDERSON', choices='ANDERSON PICARD NEWTON')
      call add_option(k, 'TOLERANCE+', KIND_REAL, 'largest relative change at convergence, > 0', dimension='-')
      call add_option(k, 'MAXIT+', KIND_INTEGER, 'most outer iterations, > 0')
      call add_option(k, 'RELAXATION+', KIND_REAL, 'part of each change that PICARD takes, 0 < r <= 1', dimension='-')
      call add_option(k, '(PARAMETERS)', KIND_NAME, 'of other programs, with its data lines')
      call add_option(k, '(RESET)', KIND_FLAG, 'of other programs')
      call add_form(k, 'of PARAMETERS=', 0, ANY_NUMBER, when='PARAMETERS', harmless=.true.)
      call add_item(k, '[value]...', KIND_REAL, NO_EFFECT)
      call add_example(k, '*CONTROLS, METHOD=PICARD, TOLERANCE=1e-12, MAXIT=200')
   end subroutine define_controls

   !> Requests of tables.
   subroutine define_print_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'NODE PRINT', LEVEL_STEP, 'writes nodes.tab (U) and reactions.tab (RF)', &
                          doc='A component of other programs, U1, stands for all.')
      call add_option(k, 'NSET', KIND_NAME, 'these nodes only')
      call add_print_options(k)
      call add_form(k, 'the tables', 1, ANY_NUMBER)
      call add_word_item(k, 'variable...', 'U RF', 'displacements, reactions')
      call add_example(k, '*NODE PRINT, NSET=base|U, RF')

      call define_keyword(k, 'EL PRINT', LEVEL_STEP, 'writes stress.tab (S), or nodal_stress.tab', &
                          doc='For both tables the step has two cards. A component of other programs, S11, stands for '// &
                          'all. The stresses at the nodes are recovered from all '// &
                          'elements round them; where materials meet they are the mean of the sides.')
      call add_option(k, 'ELSET', KIND_NAME, 'these elements only')
      call add_option(k, 'POSITION', KIND_WORD, 'of stress.tab, or of nodal_stress.tab', &
                      default='INTEGRATION POINTS', choices='INTEGRATION_POINTS AVERAGED_AT_NODES')
      call add_print_options(k)
      call add_form(k, 'the tables', 1, ANY_NUMBER)
      call add_word_item(k, 'variable...', 'S', 'stresses')
      call add_example(k, '*EL PRINT, ELSET=plate|S|*EL PRINT, POSITION=AVERAGED AT NODES|S')

      call define_keyword(k, 'CONTACT PRINT', LEVEL_STEP, 'writes contact.tab', &
                          doc='contact.tab is written whenever there is a pair, with or without this request.')
      call add_print_options(k)
      call add_option(k, '(NSET)', KIND_NAME, 'the table has all points')
      call add_option(k, '(SLAVE)', KIND_NAME, 'the table has all pairs')
      call add_option(k, '(MASTER)', KIND_NAME, 'the table has all pairs')
      call add_form(k, 'variables', 0, ANY_NUMBER)
      call add_item(k, '[variable]...', KIND_NAME, 'of other programs; the table always has all columns')
      call add_example(k, '*CONTACT PRINT')

      call define_keyword(k, 'BODY PRINT+', LEVEL_STEP, 'writes bodies.tab', &
                          doc='A row a body: its best rigid motion, and the resultants of loads, supports and contact. '// &
                          'There are no data lines.')
      call add_option(k, 'FREQUENCY', KIND_INTEGER, FREQUENCY_DOC)
      call add_example(k, '*BODY PRINT')

      call define_keyword(k, 'JOINT PRINT+', LEVEL_STEP, 'writes joints.tab', &
                          doc='A row for each two bodies that a contact pair brings together: the resultant, its moment '// &
                          'and its place, opening and sliding. With --plot also a picture of the joints and the line of '// &
                          'thrust. There are no data lines.')
      call add_option(k, 'FREQUENCY', KIND_INTEGER, FREQUENCY_DOC)
      call add_example(k, '*JOINT PRINT')

      call define_keyword(k, 'SECTION PRINT', LEVEL_STEP, 'writes sections.tab: normal force, shear force and moment in cuts', &
                          doc='A cut is a straight line through a body, from one point to another. What is on its right, seen '// &
                          'from the first point, pulls at what is on its left with n, normal to the cut, and v, along it; m is '// &
                          'the moment about the middle, counter-clockwise. Over the whole thickness, or the full circle. A cut '// &
                          'has to go through the body; several lines make the cuts NAME-1, NAME-2, ...')
      call add_option(k, 'NAME!', KIND_NAME, 'name of the cut')
      call add_option(k, 'ELSET', KIND_NAME, 'of several places where the line meets bodies only those at elements of this set')
      call add_option(k, 'FREQUENCY', KIND_INTEGER, FREQUENCY_DOC)
      call add_option(k, '(SURFACE)', KIND_NAME, 'the card is that of other programs, and nothing is written; here a cut is a line')
      call add_option(k, '(AXES)', KIND_WORD, 'of other programs')
      call add_option(k, '(UPDATE)', KIND_WORD, 'of other programs')
      call add_option(k, '(TIME POINTS)', KIND_NAME, 'FREQUENCY= says when')
      call add_form(k, 'one cut a line', 1, ANY_NUMBER, when='-SURFACE')
      call add_item(k, 'x1', KIND_REAL, 'the first point', dimension='L')
      call add_item(k, 'y1', KIND_REAL, 'the first point', dimension='L')
      call add_item(k, 'x2', KIND_REAL, 'the second point', dimension='L')
      call add_item(k, 'y2', KIND_REAL, 'the second point', dimension='L')
      call add_form(k, 'with SURFACE=', 0, ANY_NUMBER, when='SURFACE', harmless=.true.)
      call add_item(k, '[variable]...', KIND_TEXT, 'has no effect')
      call add_example(k, '*SECTION PRINT, NAME=root|0.1, 0., 0.1, 1.')
   end subroutine define_print_keywords

   !> Requests of fields.
   subroutine define_file_keywords(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'NODE FILE', LEVEL_STEP, 'writes displacements (U) and reactions (RF) into the field file', &
                          doc=FIELD_FILE//' Nodes outside NSET are nan there.')
      call add_option(k, 'NSET', KIND_NAME, 'these nodes only')
      call add_file_options(k)
      call add_form(k, 'the fields', 1, ANY_NUMBER)
      call add_word_item(k, 'variable...', 'U RF', 'displacements, reactions')
      call add_example(k, '*NODE FILE|U, RF')

      call define_keyword(k, 'EL FILE', LEVEL_STEP, 'writes stresses (S) into the field file', doc=FIELD_FILE// &
                          ' Nodes that are on no element of ELSET are nan there.')
      call add_option(k, 'ELSET', KIND_NAME, 'these elements only')
      call add_file_options(k)
      call add_form(k, 'the fields', 1, ANY_NUMBER)
      call add_word_item(k, 'variable...', 'S', 'stresses, at the integration points and recovered at the nodes')
      call add_example(k, '*EL FILE, ELSET=plate|S')

      call define_keyword(k, 'CONTACT FILE', LEVEL_STEP, 'writes the fields of the contact points into the field file', &
                          doc=FIELD_FILE//' All columns of contact.tab, and the traction upon the slave.')
      call add_file_options(k)
      call add_form(k, 'variables', 0, ANY_NUMBER)
      call add_item(k, '[variable]...', KIND_NAME, 'of other programs; the file always has all fields')
      call add_example(k, '*CONTACT FILE')
   end subroutine define_file_keywords

   subroutine define_interference(k)
      type(keyword_list_t), intent(inout) :: k

      call define_keyword(k, 'CONTACT INTERFERENCE', LEVEL_STEP, 'resolves the initial overlap of contact pairs over the step', &
                          doc='Contact does not feel the overlap in the steps before. Over the step the overlap that is '// &
                          'allowed goes linearly to 0, whatever AMPLITUDE= of *STEP says; so it should have increments. '// &
                          'Pairs that no line names have their whole overlap from the first increment on.')
      call add_option(k, 'SHRINK', KIND_FLAG, 'must be given: the initial overlap of each point, of coordinates or *CLEARANCE')
      call add_option(k, 'TYPE', KIND_WORD, 'of what', default='CONTACT PAIR', choices='CONTACT_PAIR -ELEMENT')
      call add_option(k, 'AMPLITUDE', KIND_NAME, 'is an error: the overlap goes linearly')
      call add_option(k, 'OP', KIND_WORD, 'the same: an overlap is resolved at the end of its step', default='MOD', &
                      choices='MOD NEW')
      call add_form(k, 'one pair a line', 1, ANY_NUMBER)
      call add_item(k, 'slave', KIND_NAME, 'the slave of a *CONTACT PAIR')
      call add_item(k, 'master', KIND_NAME, 'its master')
      call add_example(k, '*CONTACT INTERFERENCE, SHRINK|hub-INSIDE, shaft-OUTSIDE')
   end subroutine define_interference

   !> How loads change from step to step.
   subroutine add_changes(k)
      type(keyword_list_t), intent(inout) :: k

      call add_option(k, 'AMPLITUDE', KIND_NAME, 'curve over time that multiplies the values')
      call add_option(k, 'OP', KIND_WORD, OP_DOC, default='MOD', choices='MOD NEW')
   end subroutine add_changes

   subroutine add_print_options(k)
      type(keyword_list_t), intent(inout) :: k

      call add_option(k, 'FREQUENCY', KIND_INTEGER, FREQUENCY_DOC)
      call add_option(k, '(TOTALS)', KIND_WORD, 'the listing has the resultants')
      call add_option(k, '(GLOBAL)', KIND_WORD, 'axes are global')
      call add_option(k, '(TIME POINTS)', KIND_NAME, 'FREQUENCY= says when')
   end subroutine add_print_options

   subroutine add_file_options(k)
      type(keyword_list_t), intent(inout) :: k

      call add_option(k, 'FREQUENCY', KIND_INTEGER, FREQUENCY_DOC)
      call add_option(k, '(GLOBAL)', KIND_WORD, 'axes are global')
      call add_option(k, '(TIME POINTS)', KIND_NAME, 'FREQUENCY= says when')
      call add_option(k, '(OUTPUT)', KIND_WORD, 'the file is of the plane')
   end subroutine add_file_options

end module atrito_step_keywords
