!> Options of keywords, and words that options and data lines take, in Abaqus and CalculiX and not in atrito's table: what changes
!> no result of a linear static run, and what is refused by its name. Searched when a name is not in the table.
module atrito_foreign_words
   use atrito_foreign_keywords, only: NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE
   implicit none (type, external)
   private
   public :: ask_option, ask_word, is_foreign_variable, variable_of_component, may_be_empty

   !> `KEYWORD/OPTION`, or `KEYWORD/OPTION=WORD`; what it means, or what to do instead.
   type :: phrase_t
      character(len=52) :: name = ''
      character(len=110) :: text = ''
   end type phrase_t

   !> Without effect, and why.
   type(phrase_t), parameter :: IGNORED(*) = [ &
                                phrase_t('AMPLITUDE/SMOOTH', 'for accelerations'), &
                                phrase_t('BOUNDARY/REGIONTYPE', 'mark of a preprocessor'), &
                                phrase_t('BOUNDARY/TYPE=DISPLACEMENT', 'the values are displacements'), &
                                phrase_t('CLOAD/FOLLOWER', 'displacements are small, forces keep their directions'), &
                                phrase_t('CLOAD/REGIONTYPE', 'mark of a preprocessor'), &
                                phrase_t('CONTACTFILE/CONTACTELEMENTS', 'there are none'), &
                                phrase_t('CONTACTFILE/LASTITERATIONS', 'of other programs'), &
                                phrase_t('CONTACTFILE/NSET', 'the field file has all points'), &
                                phrase_t('CONTACTPAIR/CPSET', 'mark of a preprocessor'), &
                              phrase_t('CONTACTPAIR/EXTENSIONZONE', 'points beyond the end of the master are left out, and told'), &
                                phrase_t('CONTACTPAIR/GEOMETRICCORRECTION', 'curved sides are told by their nodes'), &
                                phrase_t('CONTACTPAIR/HCRIT', 'of the iteration of another program'), &
                                phrase_t('CONTACTPAIR/MECHANICALCONSTRAINT', 'the contact law is met as it is written'), &
                                phrase_t('CONTACTPAIR/MINIMUMDISTANCE', 'of the search of another program'), &
                                phrase_t('CONTACTPAIR/NOTHICKNESS', 'of shells'), &
                                phrase_t('CONTACTPAIR/OP', 'pairs are the same in all steps'), &
                                phrase_t('CONTACTPAIR/SMOOTH', 'for large sliding'), &
                                phrase_t('CONTACTPAIR/SUPPLEMENTARYCONSTRAINTS', 'of another program'), &
                                phrase_t('CONTACTPAIR/TRACKING', 'for large sliding'), &
                                phrase_t('CONTACTPAIR/WEIGHT', 'of another program'), &
                                phrase_t('CONTACTPRINT/CONTACTELEMENTS', 'there are none'), &
                                phrase_t('CONTACTPRINT/MASTER', 'the table has all pairs'), &
                                phrase_t('CONTACTPRINT/NSET', 'the table has all points'), &
                                phrase_t('CONTACTPRINT/SET', 'the table has all points'), &
                                phrase_t('CONTACTPRINT/SLAVE', 'the table has all pairs'), &
                                phrase_t('CONTACTPRINT/SUMMARY', 'summary.tab has it'), &
                                phrase_t('CONTROLS/ANALYSIS', 'of the iteration of another program'), &
                                phrase_t('CONTROLS/FIELD', 'of the iteration of another program'), &
                                phrase_t('DENSITY/DEPENDENCIES', 'the density is constant'), &
                                phrase_t('DLOAD/CONSTANTRESULTANT', 'displacements are small, faces keep their areas'), &
                                phrase_t('DLOAD/FOLLOWER', 'displacements are small, loads keep their directions'), &
                                phrase_t('DLOAD/REGIONTYPE', 'mark of a preprocessor'), &
                                phrase_t('DSLOAD/CONSTANTRESULTANT', 'displacements are small, faces keep their areas'), &
                                phrase_t('DSLOAD/FOLLOWER', 'displacements are small, loads keep their directions'), &
                                phrase_t('ELASTIC/MODULI', 'statics has the moduli of the long term'), &
                                phrase_t('ELFILE/CONTACTELEMENTS', 'there are none'), &
                                phrase_t('ELFILE/DIRECTIONS', 'axes are global'), &
                                phrase_t('ELFILE/FREQUENCYF', 'of flow'), &
                                phrase_t('ELFILE/LASTITERATIONS', 'of other programs'), &
                                phrase_t('ELFILE/NSET', 'ELSET= says which'), &
                                phrase_t('ELFILE/POSITION', 'points and nodes are both written'), &
                                phrase_t('ELFILE/SECTIONFORCES', 'of beams'), &
                                phrase_t('ELPRINT/FREQUENCYF', 'of flow'), &
                                phrase_t('ELPRINT/POSITION=CENTROIDAL', 'stress.tab has the integration points'), &
                                phrase_t('ELPRINT/POSITION=NODES', 'stress.tab has the integration points, AVERAGED AT NODES '// &
                                         'the nodes'), &
                                phrase_t('ELPRINT/SUMMARY', 'extremes are found in extremes.tab'), &
                                phrase_t('FRICTION/ELASTICSLIP', 'what sticks does not slip at all'), &
                                phrase_t('FRICTION/LAGRANGE', 'what sticks does not slip at all in any case'), &
                                phrase_t('FRICTION/SLIPTOLERANCE', 'what sticks does not slip at all'), &
                                phrase_t('NODEFILE/CONTACTELEMENTS', 'there are none'), &
                                phrase_t('NODEFILE/FREQUENCYF', 'of flow'), &
                                phrase_t('NODEFILE/LASTITERATIONS', 'of other programs'), &
                                phrase_t('NODEPRINT/FREQUENCYF', 'of flow'), &
                                phrase_t('NODEPRINT/SUMMARY', 'extremes.tab has it'), &
                                phrase_t('RESTART/NUMBERINTERVAL', 'FREQUENCY= says when'), &
                                phrase_t('RESTART/TIMEMARKS', 'FREQUENCY= says when'), &
                                phrase_t('RIGIDBODY/ISOTHERMAL', 'temperatures are given'), &
                                phrase_t('SOLIDSECTION/CONTROLS', 'the control of hourglass modes is atrito''s own'), &
                                phrase_t('SOLIDSECTION/OFFSET', 'of shells'), &
                                phrase_t('STATIC/ADJUST', 'of other programs'), &
                                phrase_t('STATIC/ALLSDTOL', 'nothing is damped'), &
                                phrase_t('STATIC/CONTINUE', 'nothing is damped'), &
                                phrase_t('STATIC/FACTOR', 'nothing is damped'), &
                                phrase_t('STATIC/STABILIZE', 'nothing is damped; what moves freely is told'), &
                                phrase_t('STEP/CONVERTSDI', 'of the iteration of another program'), &
                                phrase_t('STEP/SHOCKSMOOTHING', 'of flow'), &
                                phrase_t('SURFACE/MAXRATIO', 'of shells'), &
                                phrase_t('SURFACE/NOOFFSET', 'of shells'), &
                                phrase_t('SURFACE/NOTHICK', 'of shells'), &
                                phrase_t('SURFACE/PROPERTY', 'of another program'), &
                                phrase_t('SURFACE/REGIONTYPE', 'mark of a preprocessor'), &
                                phrase_t('SURFACE/SCALETHICK', 'of shells'), &
                                phrase_t('SURFACEBEHAVIOR/AUGMENTEDLAGRANGE', 'the law is met as it is written'), &
                                phrase_t('SURFACEBEHAVIOR/DIRECT', 'the law is met as it is written'), &
               phrase_t('SURFACEBEHAVIOR/PENALTY', 'the law is met as it is written; its stiffness: PRESSURE-OVERCLOSURE=LINEAR'), &
                                phrase_t('SURFACEINTERACTION/DEPVAR', 'of another program'), &
                                phrase_t('SURFACEINTERACTION/PADTHICKNESS', 'of another program'), &
                                phrase_t('SURFACEINTERACTION/UNSYMM', 'of another program'), &
                                phrase_t('TEMPERATURE/REGIONTYPE', 'mark of a preprocessor'), &
                                phrase_t('TIE/CONSTRAINTRATIO', 'of shells'), &
                                phrase_t('TIE/MULTIPHYSICS', 'of other programs')]

   !> Refused, and what to do instead.
   type(phrase_t), parameter :: OUTSIDE(*) = [ &
                                phrase_t('AMPLITUDE/DEFINITION=DECAY', 'a table of time and value'), &
                                phrase_t('AMPLITUDE/DEFINITION=EQUALLYSPACED', 'pairs of time and value'), &
                                phrase_t('AMPLITUDE/DEFINITION=MODULATED', 'a table of time and value'), &
                                phrase_t('AMPLITUDE/DEFINITION=PERIODIC', 'a table of time and value'), &
                                phrase_t('AMPLITUDE/DEFINITION=USER', 'a table of time and value'), &
                                phrase_t('AMPLITUDE/SHIFTX', 'times and values as they are to be'), &
                                phrase_t('AMPLITUDE/SHIFTY', 'times and values as they are to be'), &
                                phrase_t('BOUNDARY/FIXED', 'no line; of a section with a load: the value in rigid.tab'), &
                                phrase_t('BOUNDARY/LOADCASE', 'one load case a deck'), &
                                phrase_t('BOUNDARY/MASSFLOW', 'a program for flow'), &
                                phrase_t('BOUNDARY/SUBMODEL', 'one deck with all of the model'), &
                                phrase_t('BOUNDARY/TIMEDELAY', 'an *AMPLITUDE with the times that are meant'), &
                                phrase_t('BOUNDARY/TYPE=ACCELERATION', 'displacements'), &
                                phrase_t('BOUNDARY/TYPE=VELOCITY', 'displacements: velocity times the length of the step'), &
                                phrase_t('BOUNDARY/USER', '*BOUNDARY, FUNCTION'), &
                                phrase_t('CLOAD/LOADCASE', 'one load case a deck'), &
                                phrase_t('CLOAD/TIMEDELAY', 'an *AMPLITUDE with the times that are meant'), &
                                phrase_t('CLOAD/USER', 'a line a node'), &
                                phrase_t('CONTACTPAIR/TIED', '*TIE'), &
                                phrase_t('CONTACTPAIR/TYPE=LINMORTAR', 'TYPE=SURFACE TO SURFACE'), &
                                phrase_t('CONTACTPAIR/TYPE=MASSLESS', 'TYPE=NODE TO SURFACE'), &
                                phrase_t('CONTACTPAIR/TYPE=PGLINMORTAR', 'TYPE=SURFACE TO SURFACE'), &
                                phrase_t('DLOAD/LOADCASE', 'one load case a deck'), &
                                phrase_t('DLOAD/ORIENTATION', 'directions along x and y'), &
                                phrase_t('DLOAD/TIMEDELAY', 'an *AMPLITUDE with the times that are meant'), &
                                phrase_t('DSLOAD/ORIENTATION', 'directions along x and y'), &
                                phrase_t('DSLOAD/SUBMODEL', 'one deck with all of the model'), &
                                phrase_t('ELASTIC/DEPENDENCIES', 'one line of constants'), &
                                phrase_t('ELASTIC/TYPE=ANISO', 'an isotropic *ELASTIC'), &
                                phrase_t('ELASTIC/TYPE=ANISOTROPIC', 'an isotropic *ELASTIC'), &
                                phrase_t('ELASTIC/TYPE=COUPLEDTRACTION', 'an isotropic *ELASTIC'), &
                                phrase_t('ELASTIC/TYPE=ENGINEERINGCONSTANTS', 'an isotropic *ELASTIC'), &
                                phrase_t('ELASTIC/TYPE=LAMINA', 'an isotropic *ELASTIC'), &
                                phrase_t('ELASTIC/TYPE=ORTHO', 'an isotropic *ELASTIC'), &
                                phrase_t('ELASTIC/TYPE=ORTHOTROPIC', 'an isotropic *ELASTIC'), &
                                phrase_t('ELASTIC/TYPE=SHEAR', 'an isotropic *ELASTIC'), &
                                phrase_t('ELASTIC/TYPE=TRACTION', 'an isotropic *ELASTIC'), &
                                phrase_t('ELEMENT/INPUT', '*INCLUDE behind the keyword line'), &
                                phrase_t('EQUATION/REMOVE', 'equations that hold in all steps'), &
                                phrase_t('EXPANSION/DEPENDENCIES', 'one line of constants'), &
                                phrase_t('EXPANSION/USER', 'one line of constants'), &
                              phrase_t('FRICTION/ANISOTROPIC', 'one coefficient: in the plane there is one direction of sliding'), &
                                phrase_t('FRICTION/DEPENDENCIES', 'one coefficient'), &
                                phrase_t('FRICTION/EXPONENTIALDECAY', 'one coefficient'), &
                                phrase_t('FRICTION/ROUGH', '*TIE, or a large coefficient'), &
                                phrase_t('FRICTION/SHEARTRACTIONSLOPE', 'the slope as second item of the data line'), &
              phrase_t('FRICTION/TAUMAX', 'a coefficient alone; max_abs_shear of summary.tab tells whether the bound is reached'), &
                                phrase_t('FRICTION/USER', 'one coefficient'), &
                                phrase_t('INITIALCONDITIONS/FILE', 'TYPE=TEMPERATURE with lines of nodes'), &
                                phrase_t('INITIALCONDITIONS/TYPE=CONTACT', '*CLEARANCE'), &
                                phrase_t('INITIALCONDITIONS/TYPE=DISPLACEMENT', 'the load of a step before'), &
                                phrase_t('INITIALCONDITIONS/TYPE=FIELD', 'TYPE=TEMPERATURE'), &
                                phrase_t('INITIALCONDITIONS/TYPE=FLUIDVELOCITY', 'a program for flow'), &
                                phrase_t('INITIALCONDITIONS/TYPE=HARDENING', '*ELASTIC alone'), &
                                phrase_t('INITIALCONDITIONS/TYPE=MASSFLOW', 'a program for flow'), &
                                phrase_t('INITIALCONDITIONS/TYPE=PLASTICSTRAIN', '*ELASTIC alone'), &
                                phrase_t('INITIALCONDITIONS/TYPE=PRESSURE', 'a program for flow'), &
                                phrase_t('INITIALCONDITIONS/TYPE=SOLUTION', '*ELASTIC alone'), &
                                phrase_t('INITIALCONDITIONS/TYPE=STRESS', 'the load that makes the stress, in a first step'), &
                                phrase_t('INITIALCONDITIONS/TYPE=TOTALPRESSURE', 'a program for flow'), &
                                phrase_t('INITIALCONDITIONS/TYPE=VELOCITY', 'a program for dynamics'), &
                                phrase_t('INITIALCONDITIONS/USER', 'TYPE=TEMPERATURE with lines of nodes'), &
                                phrase_t('NODE/INPUT', '*INCLUDE behind the keyword line'), &
                                phrase_t('NODE/SYSTEM', 'coordinates x, y'), &
                                phrase_t('NSET/ELEMENT', 'the numbers of the nodes'), &
                                phrase_t('RESTART/STEP', 'atrito --restart FILE, which goes on from the last increment in it'), &
                                phrase_t('RIGIDBODY/ROTNODE', 'REF NODE= alone, whose dof 6 is the rotation'), &
                                phrase_t('SOLIDSECTION/COMPOSITE', 'a *SOLID SECTION for each layer, of its own elements'), &
                                phrase_t('SOLIDSECTION/ORIENTATION', 'an isotropic *ELASTIC, or axes along x and y'), &
                                phrase_t('STATIC/FULLYPLASTIC', 'no such option'), &
                                phrase_t('STATIC/RIKS', 'atrito limit DECK --vary NAME=a:b finds the load that contact can bear'), &
                                phrase_t('STATIC/TIMERESET', 'times that go on from step to step'), &
                                phrase_t('STATIC/TOTALTIMEATSTART', 'times that go on from step to step'), &
                                phrase_t('SURFACE/COMBINE', 'one surface of all faces'), &
                                phrase_t('SURFACE/CROP', 'the faces that are meant'), &
                                phrase_t('SURFACE/TYPE=CUTTINGSURFACE', 'TYPE=ELEMENT'), &
                                phrase_t('SURFACE/TYPE=CYLINDER', 'TYPE=SEGMENTS'), &
                                phrase_t('SURFACE/TYPE=REVOLUTION', 'TYPE=SEGMENTS'), &
                                phrase_t('SURFACE/TYPE=USER', 'TYPE=SEGMENTS'), &
                                phrase_t('SURFACEBEHAVIOR/NOSEPARATION', '*TIE, where surfaces stay together'), &
           phrase_t('SURFACEBEHAVIOR/PRESSURE-OVERCLOSURE=EXPONENTIAL', 'LINEAR, slope about p0/c0, or HARD: contact begins at '// &
                                         'gap 0, not at c0'), &
                                phrase_t('SURFACEBEHAVIOR/PRESSURE-OVERCLOSURE=SCALEFACTOR', 'LINEAR, or HARD'), &
      phrase_t('SURFACEBEHAVIOR/PRESSURE-OVERCLOSURE=TABULAR', 'LINEAR with the slope at the pressure that is expected, or HARD'), &
                                phrase_t('SURFACEBEHAVIOR/PRESSURE-OVERCLOSURE=TIED', '*TIE'), &
                                phrase_t('SURFACEBEHAVIOR/SCALEFACTOR', 'LINEAR, or HARD'), &
                                phrase_t('SURFACEINTERACTION/USER', '*SURFACE BEHAVIOR and *FRICTION'), &
                                phrase_t('TEMPERATURE/AMPLITUDE', 'a step for each temperature: within a step they go linearly'), &
                                phrase_t('TEMPERATURE/BSTEP', 'lines of nodes and temperatures'), &
                                phrase_t('TEMPERATURE/FILE', 'lines of nodes and temperatures'), &
                                phrase_t('TEMPERATURE/USER', 'lines of nodes and temperatures'), &
                                phrase_t('TIE/FASTENER', '*TIE of two surfaces'), &
                                phrase_t('TIE/TIEDNSET', '*TIE of two surfaces')]

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
         if (IGNORED(i)%name /= name) cycle
         verdict = FOREIGN_IGNORED
         text = trim(IGNORED(i)%text)
         return
      end do
      do i = 1, size(OUTSIDE)
         if (OUTSIDE(i)%name /= name) cycle
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
