!> Options of keywords, and words that options and data lines take, in Abaqus and CalculiX and not in atrito's table: what changes
!> no result of a linear static run, and what is refused by its name. Searched when a name is not in the table.
module atrito_foreign_words
   use atrito_foreign_keywords, only: is_among, NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE
   implicit none (type, external)
   private
   public :: ask_option, ask_word, is_foreign_variable, variable_of_component, may_be_empty

   !> What some options mean, or what to do instead: `KEYWORD/OPTION`, or `KEYWORD/OPTION=WORD`, a comma between two.
   type :: phrase_t
      character(len=84) :: text = ''
      character(len=219) :: names = ''
   end type phrase_t

   !> Without effect, and why.
   type(phrase_t), parameter :: IGNORED(*) = [ &
         phrase_t('for accelerations', 'AMPLITUDE/SMOOTH'), &
         phrase_t('mark of a preprocessor', &
                  'BOUNDARY/REGIONTYPE, CLOAD/REGIONTYPE, CONTACTPAIR/CPSET, DLOAD/REGIONTYPE, SURFACE/REGIONTYPE, '// &
                  'TEMPERATURE/REGIONTYPE'), &
         phrase_t('the values are displacements', 'BOUNDARY/TYPE=DISPLACEMENT'), &
         phrase_t('displacements are small, forces keep their directions', 'CLOAD/FOLLOWER'), &
         phrase_t('there are none', &
                  'CONTACTFILE/CONTACTELEMENTS, CONTACTPRINT/CONTACTELEMENTS, ELFILE/CONTACTELEMENTS, '// &
                  'NODEFILE/CONTACTELEMENTS'), &
         phrase_t('of other programs', &
                  'CONTACTFILE/LASTITERATIONS, ELFILE/LASTITERATIONS, NODEFILE/LASTITERATIONS, STATIC/ADJUST, '// &
                  'TIE/MULTIPHYSICS'), &
         phrase_t('the field file has all points', 'CONTACTFILE/NSET'), &
         phrase_t('points beyond the end of the master are left out, and told', 'CONTACTPAIR/EXTENSIONZONE'), &
         phrase_t('curved sides are told by their nodes', 'CONTACTPAIR/GEOMETRICCORRECTION'), &
         phrase_t('of the iteration of another program', &
                  'CONTACTPAIR/HCRIT, CONTROLS/ANALYSIS, CONTROLS/FIELD, STEP/CONVERTSDI'), &
         phrase_t('the contact law is met as it is written', 'CONTACTPAIR/MECHANICALCONSTRAINT'), &
         phrase_t('of the search of another program', 'CONTACTPAIR/MINIMUMDISTANCE'), &
         phrase_t('of shells', &
                  'CONTACTPAIR/NOTHICKNESS, SOLIDSECTION/OFFSET, SURFACE/MAXRATIO, SURFACE/NOOFFSET, SURFACE/NOTHICK, '// &
                  'SURFACE/SCALETHICK, TIE/CONSTRAINTRATIO'), &
         phrase_t('pairs are the same in all steps', 'CONTACTPAIR/OP'), &
         phrase_t('for large sliding', 'CONTACTPAIR/SMOOTH, CONTACTPAIR/TRACKING'), &
         phrase_t('of another program', &
                  'CONTACTPAIR/SUPPLEMENTARYCONSTRAINTS, CONTACTPAIR/WEIGHT, SURFACE/PROPERTY, '// &
                  'SURFACEINTERACTION/DEPVAR, SURFACEINTERACTION/PADTHICKNESS, SURFACEINTERACTION/UNSYMM'), &
         phrase_t('the table has all pairs', 'CONTACTPRINT/MASTER, CONTACTPRINT/SLAVE'), &
         phrase_t('the table has all points', 'CONTACTPRINT/NSET, CONTACTPRINT/SET'), &
         phrase_t('summary.tab has it', 'CONTACTPRINT/SUMMARY'), &
         phrase_t('the density is constant', 'DENSITY/DEPENDENCIES'), &
         phrase_t('displacements are small, faces keep their areas', 'DLOAD/CONSTANTRESULTANT, DSLOAD/CONSTANTRESULTANT'), &
         phrase_t('displacements are small, loads keep their directions', 'DLOAD/FOLLOWER, DSLOAD/FOLLOWER'), &
         phrase_t('statics has the moduli of the long term', 'ELASTIC/MODULI'), &
         phrase_t('axes are global', 'ELFILE/DIRECTIONS'), &
         phrase_t('of flow', &
                  'ELFILE/FREQUENCYF, ELPRINT/FREQUENCYF, NODEFILE/FREQUENCYF, NODEPRINT/FREQUENCYF, STEP/SHOCKSMOOTHING'), &
         phrase_t('ELSET= says which', 'ELFILE/NSET'), &
         phrase_t('points and nodes are both written', 'ELFILE/POSITION'), &
         phrase_t('of beams', 'ELFILE/SECTIONFORCES'), &
         phrase_t('stress.tab has the integration points', 'ELPRINT/POSITION=CENTROIDAL'), &
         phrase_t('stress.tab has the integration points, AVERAGED AT NODES the nodes', 'ELPRINT/POSITION=NODES'), &
         phrase_t('extremes are found in extremes.tab', 'ELPRINT/SUMMARY'), &
         phrase_t('what sticks does not slip at all', 'FRICTION/ELASTICSLIP, FRICTION/SLIPTOLERANCE'), &
         phrase_t('what sticks does not slip at all in any case', 'FRICTION/LAGRANGE'), &
         phrase_t('extremes.tab has it', 'NODEPRINT/SUMMARY'), &
         phrase_t('FREQUENCY= says when', 'RESTART/NUMBERINTERVAL, RESTART/TIMEMARKS'), &
         phrase_t('temperatures are given', 'RIGIDBODY/ISOTHERMAL'), &
         phrase_t('the control of hourglass modes is atrito''s own', 'SOLIDSECTION/CONTROLS'), &
         phrase_t('nothing is damped', 'STATIC/ALLSDTOL, STATIC/CONTINUE, STATIC/FACTOR'), &
         phrase_t('nothing is damped; what moves freely is told', 'STATIC/STABILIZE'), &
         phrase_t('the law is met as it is written', 'SURFACEBEHAVIOR/AUGMENTEDLAGRANGE, SURFACEBEHAVIOR/DIRECT'), &
         phrase_t('the law is met as it is written; its stiffness: PRESSURE-OVERCLOSURE=LINEAR', 'SURFACEBEHAVIOR/PENALTY')]

   !> Refused, and what to do instead.
   type(phrase_t), parameter :: OUTSIDE(*) = [ &
         phrase_t('a table of time and value', &
                  'AMPLITUDE/DEFINITION=DECAY, AMPLITUDE/DEFINITION=MODULATED, AMPLITUDE/DEFINITION=PERIODIC, '// &
                  'AMPLITUDE/DEFINITION=USER'), &
         phrase_t('pairs of time and value', 'AMPLITUDE/DEFINITION=EQUALLYSPACED'), &
         phrase_t('times and values as they are to be', 'AMPLITUDE/SHIFTX, AMPLITUDE/SHIFTY'), &
         phrase_t('no line; of a section with a load: the value in rigid.tab', 'BOUNDARY/FIXED'), &
         phrase_t('one load case a deck', 'BOUNDARY/LOADCASE, CLOAD/LOADCASE, DLOAD/LOADCASE'), &
         phrase_t('a program for flow', &
                  'BOUNDARY/MASSFLOW, INITIALCONDITIONS/TYPE=FLUIDVELOCITY, INITIALCONDITIONS/TYPE=MASSFLOW, '// &
                  'INITIALCONDITIONS/TYPE=PRESSURE, INITIALCONDITIONS/TYPE=TOTALPRESSURE'), &
         phrase_t('one deck with all of the model', 'BOUNDARY/SUBMODEL, DSLOAD/SUBMODEL'), &
         phrase_t('an *AMPLITUDE with the times that are meant', 'BOUNDARY/TIMEDELAY, CLOAD/TIMEDELAY, DLOAD/TIMEDELAY'), &
         phrase_t('displacements', 'BOUNDARY/TYPE=ACCELERATION'), &
         phrase_t('displacements: velocity times the length of the step', 'BOUNDARY/TYPE=VELOCITY'), &
         phrase_t('*BOUNDARY, FUNCTION', 'BOUNDARY/USER'), &
         phrase_t('a line a node', 'CLOAD/USER'), &
         phrase_t('*TIE', 'CONTACTPAIR/TIED, SURFACEBEHAVIOR/PRESSURE-OVERCLOSURE=TIED'), &
         phrase_t('TYPE=SURFACE TO SURFACE', 'CONTACTPAIR/TYPE=LINMORTAR, CONTACTPAIR/TYPE=PGLINMORTAR'), &
         phrase_t('TYPE=NODE TO SURFACE', 'CONTACTPAIR/TYPE=MASSLESS'), &
         phrase_t('directions along x and y', 'DLOAD/ORIENTATION, DSLOAD/ORIENTATION'), &
         phrase_t('one line of constants', 'ELASTIC/DEPENDENCIES, EXPANSION/DEPENDENCIES, EXPANSION/USER'), &
         phrase_t('an isotropic *ELASTIC', &
                  'ELASTIC/TYPE=ANISO, ELASTIC/TYPE=ANISOTROPIC, ELASTIC/TYPE=COUPLEDTRACTION, '// &
                  'ELASTIC/TYPE=ENGINEERINGCONSTANTS, ELASTIC/TYPE=LAMINA, ELASTIC/TYPE=ORTHO, ELASTIC/TYPE=ORTHOTROPIC, '// &
                  'ELASTIC/TYPE=SHEAR, ELASTIC/TYPE=TRACTION'), &
         phrase_t('*INCLUDE behind the keyword line', 'ELEMENT/INPUT, NODE/INPUT'), &
         phrase_t('equations that hold in all steps', 'EQUATION/REMOVE'), &
         phrase_t('one coefficient: in the plane there is one direction of sliding', 'FRICTION/ANISOTROPIC'), &
         phrase_t('one coefficient', 'FRICTION/DEPENDENCIES, FRICTION/EXPONENTIALDECAY, FRICTION/USER'), &
         phrase_t('*TIE, or a large coefficient', 'FRICTION/ROUGH'), &
         phrase_t('the slope as second item of the data line', 'FRICTION/SHEARTRACTIONSLOPE'), &
         phrase_t('a coefficient alone; max_abs_shear of summary.tab tells whether the bound is reached', 'FRICTION/TAUMAX'), &
         phrase_t('TYPE=TEMPERATURE with lines of nodes', 'INITIALCONDITIONS/FILE, INITIALCONDITIONS/USER'), &
         phrase_t('*CLEARANCE', 'INITIALCONDITIONS/TYPE=CONTACT'), &
         phrase_t('the load of a step before', 'INITIALCONDITIONS/TYPE=DISPLACEMENT'), &
         phrase_t('TYPE=TEMPERATURE', 'INITIALCONDITIONS/TYPE=FIELD'), &
         phrase_t('*ELASTIC alone', &
                  'INITIALCONDITIONS/TYPE=HARDENING, INITIALCONDITIONS/TYPE=PLASTICSTRAIN, '// &
                  'INITIALCONDITIONS/TYPE=SOLUTION'), &
         phrase_t('the load that makes the stress, in a first step', 'INITIALCONDITIONS/TYPE=STRESS'), &
         phrase_t('a program for dynamics', 'INITIALCONDITIONS/TYPE=VELOCITY'), &
         phrase_t('coordinates x, y', 'NODE/SYSTEM'), &
         phrase_t('the numbers of the nodes', 'NSET/ELEMENT'), &
         phrase_t('atrito --restart FILE, which goes on from the last increment in it', 'RESTART/STEP'), &
         phrase_t('REF NODE= alone, whose dof 6 is the rotation', 'RIGIDBODY/ROTNODE'), &
         phrase_t('a *SOLID SECTION for each layer, of its own elements', 'SOLIDSECTION/COMPOSITE'), &
         phrase_t('an isotropic *ELASTIC, or axes along x and y', 'SOLIDSECTION/ORIENTATION'), &
         phrase_t('no such option', 'STATIC/FULLYPLASTIC'), &
         phrase_t('atrito limit DECK --vary NAME=a:b finds the load that contact can bear', 'STATIC/RIKS'), &
         phrase_t('times that go on from step to step', 'STATIC/TIMERESET, STATIC/TOTALTIMEATSTART'), &
         phrase_t('one surface of all faces', 'SURFACE/COMBINE'), &
         phrase_t('the faces that are meant', 'SURFACE/CROP'), &
         phrase_t('TYPE=ELEMENT', 'SURFACE/TYPE=CUTTINGSURFACE'), &
         phrase_t('TYPE=SEGMENTS', 'SURFACE/TYPE=CYLINDER, SURFACE/TYPE=REVOLUTION, SURFACE/TYPE=USER'), &
         phrase_t('*TIE, where surfaces stay together', 'SURFACEBEHAVIOR/NOSEPARATION'), &
         phrase_t('LINEAR, slope about p0/c0, or HARD: contact begins at gap 0, not at c0', &
                  'SURFACEBEHAVIOR/PRESSURE-OVERCLOSURE=EXPONENTIAL'), &
         phrase_t('LINEAR, or HARD', 'SURFACEBEHAVIOR/PRESSURE-OVERCLOSURE=SCALEFACTOR, SURFACEBEHAVIOR/SCALEFACTOR'), &
         phrase_t('LINEAR with the slope at the pressure that is expected, or HARD', &
                  'SURFACEBEHAVIOR/PRESSURE-OVERCLOSURE=TABULAR'), &
         phrase_t('*SURFACE BEHAVIOR and *FRICTION', 'SURFACEINTERACTION/USER'), &
         phrase_t('a step for each temperature: within a step they go linearly', 'TEMPERATURE/AMPLITUDE'), &
         phrase_t('lines of nodes and temperatures', 'TEMPERATURE/BSTEP, TEMPERATURE/FILE, TEMPERATURE/USER'), &
         phrase_t('*TIE of two surfaces', 'TIE/FASTENER, TIE/TIEDNSET')]

   !> What *NODE PRINT, *NODE FILE, *EL PRINT and *EL FILE of CalculiX and Abaqus write besides.
   character(len=6), parameter :: VARIABLES(*) = [character(len=6) :: 'A', 'BHE', 'CEEQ', 'CENT', 'CF', 'COOR', 'COORD', 'CP', &
                                                                                                                     'DEPF', &
           'DEPT', 'E', 'EBHE', 'ECD', 'EE', 'ELKE', 'ELSE', 'EMAS', 'EMFB', 'EMFE', 'ENER', 'EPD', 'ERR', 'EVOL', 'FLUX', 'HCRI', &
             'HER', 'HFL', 'HFLF', 'KEQ', 'LE', 'MACH', 'MAXE', 'MAXS', 'MAXU', 'ME', 'MF', 'MISES', 'MOM', 'NOE', 'NT', 'PDNTDF', &
              'PE', 'PEEQ', 'PHS', 'PNT', 'POT', 'PRF', 'PS', 'PSF', 'PT', 'PTF', 'PU', 'RFL', 'SDV', 'SEN', 'SF', 'SINV', 'SMID', &
                                         'SNEG', 'SOF', 'SPOS', 'SVF', 'SVOL', 'THE', 'TS', 'TSF', 'TT', 'TTF', 'TURB', 'V', 'VF', &
                                                                           'ZZS', 'EP', 'RF3', 'RM', 'S13', 'S23', 'SP', 'U3', 'UR']

   !> Keywords that may stand without data lines: preprocessors write them for what the model does not have.
   character(len=18), parameter :: EMPTY(*) = [character(len=18) :: 'BOUNDARY', 'CLOAD', 'DLOAD', 'DSLOAD', 'TEMPERATURE', &
                                 'INITIAL CONDITIONS', 'NODE PRINT', 'EL PRINT', 'NODE FILE', 'EL FILE', 'CONTACT PAIR', 'EQUATION']

contains

   !> What is known of an option that the table does not have.
   pure subroutine ask_option(keyword, option, verdict, text)
      character(len=*), intent(in) :: keyword, option  !< in capitals, without blanks
      integer, intent(out) :: verdict                  !< NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE
      character(len=:), allocatable, intent(out) :: text   !< why it has no effect, or what to do instead

      call look_up(keyword//'/'//option, verdict, text)
   end subroutine ask_option

   !> What is known of a word that an option of the table does not take.
   pure subroutine ask_word(keyword, option, word, verdict, text)
      character(len=*), intent(in) :: keyword, option, word   !< in capitals, without blanks
      integer, intent(out) :: verdict
      character(len=:), allocatable, intent(out) :: text

      call look_up(keyword//'/'//option//'='//word, verdict, text)
   end subroutine ask_word

   pure subroutine look_up(name, verdict, text)
      character(len=*), intent(in) :: name
      integer, intent(out) :: verdict
      character(len=:), allocatable, intent(out) :: text
      integer :: i

      verdict = NOT_FOREIGN
      text = ''
      do i = 1, size(IGNORED)
         if (.not. is_among(name, IGNORED(i)%names)) cycle
         verdict = FOREIGN_IGNORED
         text = trim(IGNORED(i)%text)
         return
      end do
      do i = 1, size(OUTSIDE)
         if (.not. is_among(name, OUTSIDE(i)%names)) cycle
         verdict = FOREIGN_OUTSIDE
         text = trim(OUTSIDE(i)%text)
         return
      end do
   end subroutine look_up

   !> A variable of a request that other programs write, or a component of one: E, E11.
   pure logical function is_foreign_variable(word)
      character(len=*), intent(in) :: word         !< in capitals
      integer :: digits

      digits = len(word) - verify(word, '123', back=.true.)
      is_foreign_variable = any(VARIABLES == word) .or. (digits <= 2 .and. any(VARIABLES == word(:len(word) - digits)))
   end function is_foreign_variable

   !> The variable of which a word is a component in the plane, as Abaqus has it: U of U1, RF of RF2, S of S12; '' of others.
   pure function variable_of_component(word) result(variable)
      character(len=*), intent(in) :: word         !< in capitals
      character(len=:), allocatable :: variable

      select case (word)
      case ('U1', 'U2')
         variable = 'U'
      case ('RF1', 'RF2')
         variable = 'RF'
      case ('S11', 'S22', 'S33', 'S12')
         variable = 'S'
      case default
         variable = ''
      end select
   end function variable_of_component

   !> The keyword may have no data lines.
   pure logical function may_be_empty(keyword)
      character(len=*), intent(in) :: keyword      !< as in the table

      may_be_empty = any(EMPTY == keyword)
   end function may_be_empty

end module atrito_foreign_words
