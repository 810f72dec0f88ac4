!> Keywords and element types of Abaqus, CalculiX and their preprocessors that the keyword table does not have: those that change
!> no result of a linear static run, and those that ask for what atrito does not solve.
!>
!> They are plain lists, searched when a name is not in the table; the table is made at each start and stays short. What a list
!> has and the table as well, the table decides.
module atrito_foreign_keywords
   use atrito_strings, only: upper_case
   implicit none (type, external)
   private
   public :: outside_t, subject_t, ask_keyword, ask_element_type, IGNORED_KEYWORDS, OUTSIDE_KEYWORDS, SUBJECTS, &
             NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE, LINEAR_STEP, CHANGE

   !> What is known of a foreign name.
   integer, parameter :: NOT_FOREIGN = 0, FOREIGN_IGNORED = 1, FOREIGN_OUTSIDE = 2

   !> What lies outside, and what to do instead.
   type :: subject_t
      character(len=72) :: what = ''
      character(len=150) :: instead = ''
      logical :: is_scene = .false.                !< nothing that is left of such a deck means what it says
   end type subject_t

   type :: outside_t
      character(len=40) :: name = ''               !< in capitals, without blanks
      integer :: subject = 1                       !< place in SUBJECTS
   end type outside_t

   integer, parameter :: YIELD = 1, RUBBER = 2, USER_LAW = 3, INERTIA = 4, EIGENVALUES = 5, HEAT = 6, FLUID = 7, SPATIAL = 8, &
                         STRUCTURE = 9, CONSTRAINT = 10, BOLT = 11, PARTICLE = 12, CYCLIC = 13, SUBMODEL = 14, CHANGE = 15, &
                         DESIGN = 16, CRACK = 17, USER_CODE = 18, AXES = 19, ELECTRIC = 20, POROUS = 21, LINEAR_STEP = 22, &
                         MIXED = 23, INCOMPATIBLE = 24, CHECK_ONLY = 25, TWISTED = 26, SOUND = 27, MADE = 28, &
                         BEGINNING = 29

   character(len=*), parameter :: OTHERS = '; else a program that has it (CalculiX, Abaqus)'
   character(len=*), parameter :: PLANE = 'the section of it in the plane: CPE (plane strain), CPS (plane stress) or CAX '// &
                                  'elements (bodies of revolution)'

   type(subject_t), parameter :: SUBJECTS(29) = &
        [subject_t('a material that yields, creeps or is damaged', '*ELASTIC alone, where mises of stress.tab stays below what '// &
                                            'the material bears'//OTHERS), &
                               subject_t('a material that is not linear', '*ELASTIC with the constants of small strains'//OTHERS), &
                                  subject_t('a material law of the user''s own', '*ELASTIC'//OTHERS), &
                                subject_t('inertia, damping and time', '*STATIC: the loads of one moment, or their peak'//OTHERS), &
                                  subject_t('frequencies, buckling and what is built upon modes', '*STATIC'//OTHERS), &
          subject_t('temperatures that are computed', 'given ones: *INITIAL CONDITIONS, TYPE=TEMPERATURE, *EXPANSION and, in a '// &
                                            '*STATIC step, *TEMPERATURE', .true.), &
        subject_t('flow and networks of fluids', 'a program for flow; a pressure that is known: *DLOAD, *DSLOAD (P, HP)', .true.), &
                                  subject_t('bodies in space', PLANE, .true.), &
                                  subject_t('beams, shells, membranes and trusses', PLANE, .true.), &
             subject_t('constraints that couple nodes in space', '*EQUATION, *TIE, or *RIGID BODY, TIE NSET=, REF NODE=', .true.), &
                              subject_t('a bolt that is tightened', '*PRE-TENSION SECTION, or *TEMPERATURE of the shank', .true.), &
                      subject_t('masses, dashpots, connectors and gaps between two nodes', '*SPRING, or a *CONTACT PAIR', .true.), &
                   subject_t('sectors that repeat', 'the whole section, or half of it with *BOUNDARY along the line of symmetry'), &
             subject_t('parts of another model', 'one deck with all of it; *BLOCK and GRADE make the mesh fine where it matters'), &
                                  subject_t('a model that changes from step to step', 'a deck of its own for each state'), &
                                subject_t('sensitivities and optimisation', 'atrito sweep DECK --vary NAME=..., one run a value'), &
              subject_t('cracks that grow, and layers that come apart', '*CONTACT PAIR for a crack that is open already'//OTHERS), &
                                  subject_t('code of the user''s own', 'keywords of atrito help'//OTHERS), &
                                  subject_t('axes of materials', 'an isotropic *ELASTIC, or axes along x and y'), &
                                  subject_t('electric and magnetic fields', 'a program for them', .true.), &
                             subject_t('flow through pores', '*DSLOAD, HP for a pressure of water that is known'//OTHERS, .true.), &
                                  subject_t('loads upon a state of other steps', '*STEP without PERTURBATION, all loads in it'), &
                    subject_t('elements with a pressure of their own', 'the same without H; CPE4 and CAX4 with *SOLID SECTION, '// &
                                            'FORMULATION=BBAR', .true.), &
           subject_t('elements with further modes of their own', 'CPE8, CPS8, CAX8, or the same of six or of four nodes', .true.), &
                                  subject_t('a deck that is not to be solved', 'atrito check DECK'), &
                            subject_t('rings that twist, and planes that move against each other', 'CAX or CPE elements', .true.), &
                                  subject_t('sound', 'a program for it', .true.), &
        subject_t('meshes that the keyword makes or moves', 'plain *NODE and *ELEMENT lines, as a preprocessor writes them, or '// &
                                            '*BLOCK, *NGEN, *NFILL, *NCOPY', .true.), &
               subject_t('what contact does with gaps and overlaps at the beginning', 'ADJUST= of *CONTACT PAIR, *CLEARANCE or '// &
                                            '*CONTACT INTERFERENCE')]

   !> Output of other programs, properties that statics does not use, controls of their solvers.
   character(len=32), parameter :: IGNORED_KEYWORDS(*) = [character(len=32) :: &
                                    'ACOUSTIC MEDIUM', 'ANNEAL TEMPERATURE', 'BULK VISCOSITY', 'CONDUCTIVITY', 'CONTACT CONTROLS', &
               'CONTACT CONTROLS ASSIGNMENT', 'CONTACT DAMPING', 'CONTACT FORMULATION', 'CONTACT OUTPUT', 'CONTACT STABILIZATION', &
                                  'DAMPING', 'DEPVAR', 'DIAGNOSTICS', 'DISPLAY BODY', 'ELECTRICAL CONDUCTIVITY', 'ELEMENT OUTPUT', &
               'EMISSIVITY', 'ENERGY FILE', 'ENERGY OUTPUT', 'ENERGY PRINT', 'FACE PRINT', 'FILE FORMAT', 'FILE OUTPUT', 'FILTER', &
                              'FLUID CONSTANTS', 'GAP CONDUCTANCE', 'GAP HEAT GENERATION', 'GAP RADIATION', 'HOURGLASS STIFFNESS', &
              'INCREMENTATION OUTPUT', 'INELASTIC HEAT FRACTION', 'INTEGRATED OUTPUT', 'INTEGRATED OUTPUT SECTION', 'LATENT HEAT', &
               'MAGNETIC PERMEABILITY', 'MATRIX OUTPUT', 'MONITOR', 'NODE OUTPUT', 'OUTPUT', 'PERMEABILITY', 'PHYSICAL CONSTANTS', &
                                 'PREPRINT', 'PRINT', 'SECTION CONTROLS', 'SECTION FILE', 'SOLUTION TECHNIQUE', 'SOLVER CONTROLS', &
                   'SPECIFIC GAS CONSTANT', 'SPECIFIC HEAT', 'SURFACE OUTPUT', 'SURFACE PROPERTY ASSIGNMENT', 'SURFACE SMOOTHING', &
              'TIME POINTS', 'TRANSVERSE SHEAR STIFFNESS', 'USER OUTPUT VARIABLES', 'VALUES AT INFINITY', 'VARIABLE MASS SCALING', &
                                                          'FIXED MASS SCALING', 'VISCOSITY']

   type(outside_t), parameter :: OUTSIDE_KEYWORDS(*) = [ &
          outside_t('PLASTIC', YIELD), outside_t('CREEP', YIELD), outside_t('VISCO', YIELD), outside_t('CYCLIC HARDENING', YIELD), &
                    outside_t('DEFORMATION PLASTICITY', YIELD), outside_t('CHANGE PLASTIC', YIELD), outside_t('POTENTIAL', YIELD), &
               outside_t('DRUCKER PRAGER', YIELD), outside_t('DRUCKER PRAGER HARDENING', YIELD), outside_t('MOHR COULOMB', YIELD), &
                outside_t('MOHR COULOMB HARDENING', YIELD), outside_t('CAP PLASTICITY', YIELD), outside_t('CAP HARDENING', YIELD), &
                            outside_t('CLAY PLASTICITY', YIELD), outside_t('CLAY HARDENING', YIELD), outside_t('CONCRETE', YIELD), &
                              outside_t('CONCRETE DAMAGED PLASTICITY', YIELD), outside_t('CONCRETE COMPRESSION HARDENING', YIELD), &
                                 outside_t('CONCRETE TENSION STIFFENING', YIELD), outside_t('TENSION STIFFENING', YIELD), &
                                outside_t('RATE DEPENDENT', YIELD), outside_t('VISCOELASTIC', YIELD), outside_t('VISCOUS', YIELD), &
            outside_t('DAMAGE INITIATION', YIELD), outside_t('DAMAGE EVOLUTION', YIELD), outside_t('CAST IRON PLASTICITY', YIELD), &
                                 outside_t('CRUSHABLE FOAM', YIELD), outside_t('SWELLING', YIELD), outside_t('ORNL', YIELD), &
                           outside_t('HYPERELASTIC', RUBBER), outside_t('HYPERFOAM', RUBBER), outside_t('MULLINS EFFECT', RUBBER), &
                           outside_t('NO COMPRESSION', RUBBER), outside_t('NO TENSION', RUBBER), outside_t('HYPOELASTIC', RUBBER), &
                                 outside_t('POROUS ELASTIC', RUBBER), outside_t('FABRIC', RUBBER), &
                                 outside_t('USER MATERIAL', USER_LAW), outside_t('USER DEFINED FIELD', USER_LAW), &
                          outside_t('DYNAMIC', INERTIA), outside_t('MODAL DYNAMIC', INERTIA), outside_t('MODAL DAMPING', INERTIA), &
                                 outside_t('STEADY STATE DYNAMICS', INERTIA), outside_t('RANDOM RESPONSE', INERTIA), &
                       outside_t('RESPONSE SPECTRUM', INERTIA), outside_t('BASE MOTION', INERTIA), outside_t('SUBSPACE', INERTIA), &
                                outside_t('GREEN', INERTIA), outside_t('IMPEDANCE', INERTIA), outside_t('DIRECT CYCLIC', INERTIA), &
               outside_t('FREQUENCY', EIGENVALUES), outside_t('COMPLEX FREQUENCY', EIGENVALUES), outside_t('BUCKLE', EIGENVALUES), &
                          outside_t('ROBUST DESIGN', DESIGN), outside_t('RANDOM FIELD', DESIGN), outside_t('SENSITIVITY', DESIGN), &
                      outside_t('OBJECTIVE', DESIGN), outside_t('DESIGN VARIABLES', DESIGN), outside_t('DESIGN RESPONSE', DESIGN), &
              outside_t('CONSTRAINT', DESIGN), outside_t('GEOMETRIC CONSTRAINT', DESIGN), outside_t('FEASIBLE DIRECTION', DESIGN), &
                                 outside_t('HEAT TRANSFER', HEAT), outside_t('COUPLED TEMPERATURE-DISPLACEMENT', HEAT), &
                        outside_t('UNCOUPLED TEMPERATURE-DISPLACEMENT', HEAT), outside_t('CFLUX', HEAT), outside_t('DFLUX', HEAT), &
                         outside_t('DSFLUX', HEAT), outside_t('FILM', HEAT), outside_t('SFILM', HEAT), outside_t('RADIATE', HEAT), &
               outside_t('SRADIATE', HEAT), outside_t('VIEWFACTOR', HEAT), outside_t('CRADIATE', HEAT), outside_t('CAVITY', HEAT), &
                                 outside_t('CFD', FLUID), outside_t('FLUID SECTION', FLUID), outside_t('FLUID SECTIONS', FLUID), &
                                 outside_t('MASS FLOW', FLUID), outside_t('BOUNDARYF', FLUID), outside_t('EQUATIONF', FLUID), &
                                 outside_t('TRANSFORMF', FLUID), outside_t('NETWORK MPC', FLUID), &
                                 outside_t('FLUID CAVITY', FLUID), &
                                 outside_t('SHELL SECTION', STRUCTURE), outside_t('SHELL GENERAL SECTION', STRUCTURE), &
                                 outside_t('BEAM SECTION', STRUCTURE), outside_t('BEAM GENERAL SECTION', STRUCTURE), &
                outside_t('MEMBRANE SECTION', STRUCTURE), outside_t('MEMBRANE', STRUCTURE), outside_t('TRUSS SECTION', STRUCTURE), &
                      outside_t('USER SECTION', STRUCTURE), outside_t('NORMAL', STRUCTURE), outside_t('FRAME SECTION', STRUCTURE), &
                      outside_t('REBAR', STRUCTURE), outside_t('REBAR LAYER', STRUCTURE), outside_t('SURFACE SECTION', STRUCTURE), &
                              outside_t('MPC', CONSTRAINT), outside_t('COUPLING', CONSTRAINT), outside_t('KINEMATIC', CONSTRAINT), &
                                 outside_t('DISTRIBUTING', CONSTRAINT), outside_t('DISTRIBUTING COUPLING', CONSTRAINT), &
                                 outside_t('KINEMATIC COUPLING', CONSTRAINT), outside_t('EMBEDDED ELEMENT', CONSTRAINT), &
                                outside_t('SHELL TO SOLID COUPLING', CONSTRAINT), outside_t('MULTI-POINT CONSTRAINT', CONSTRAINT), &
                                 outside_t('INERTIA RELIEF', CONSTRAINT), &
                                 outside_t('BOLT LOAD', BOLT), &
                               outside_t('DASHPOT', PARTICLE), outside_t('MASS', PARTICLE), outside_t('ROTARY INERTIA', PARTICLE), &
                  outside_t('GAP', PARTICLE), outside_t('CONNECTOR SECTION', PARTICLE), outside_t('CONNECTOR BEHAVIOR', PARTICLE), &
                                 outside_t('CONNECTOR ELASTICITY', PARTICLE), outside_t('CONNECTOR DAMPING', PARTICLE), &
                     outside_t('CONNECTOR MOTION', PARTICLE), outside_t('CONNECTOR LOAD', PARTICLE), outside_t('JOINT', PARTICLE), &
                                 outside_t('CYCLIC SYMMETRY MODEL', CYCLIC), outside_t('SELECT CYCLIC SYMMETRY MODES', CYCLIC), &
                                 outside_t('SYMMETRIC MODEL GENERATION', CYCLIC), &
                                 outside_t('SUBMODEL', SUBMODEL), outside_t('SUBSTRUCTURE GENERATE', SUBMODEL), &
                                 outside_t('SUBSTRUCTURE MATRIX OUTPUT', SUBMODEL), outside_t('SUBSTRUCTURE PATH', SUBMODEL), &
                                 outside_t('SUBSTRUCTURE LOAD CASE', SUBMODEL), outside_t('SLOAD', SUBMODEL), &
                outside_t('RETAINED NODAL DOFS', SUBMODEL), outside_t('MATRIX ASSEMBLE', SUBMODEL), outside_t('IMPORT', SUBMODEL), &
                                 outside_t('MAP SOLUTION', SUBMODEL), outside_t('REFINE MESH', SUBMODEL), &
            outside_t('MODEL CHANGE', CHANGE), outside_t('CHANGE FRICTION', CHANGE), outside_t('CHANGE SURFACE BEHAVIOR', CHANGE), &
                      outside_t('CHANGE SOLID SECTION', CHANGE), outside_t('CHANGE MATERIAL', CHANGE), outside_t('FIELD', CHANGE), &
                     outside_t('CHANGE CONTACT TYPE', CHANGE), outside_t('LOAD CASE', CHANGE), outside_t('END LOAD CASE', CHANGE), &
                                 outside_t('GEOSTATIC', CHANGE), &
               outside_t('CRACK PROPAGATION', CRACK), outside_t('COHESIVE SECTION', CRACK), outside_t('COHESIVE BEHAVIOR', CRACK), &
                                 outside_t('ENRICHMENT', CRACK), outside_t('DEBOND', CRACK), outside_t('CONTOUR INTEGRAL', CRACK), &
            outside_t('FRACTURE CRITERION', CRACK), outside_t('SURFACE FLAW', CRACK), outside_t('INITIAL STRAIN INCREASE', CRACK), &
              outside_t('USER ELEMENT', USER_CODE), outside_t('UEL PROPERTY', USER_CODE), outside_t('USER SUBROUTINE', USER_CODE), &
                           outside_t('ORIENTATION', AXES), outside_t('DISTRIBUTION', AXES), outside_t('DISTRIBUTION TABLE', AXES), &
                 outside_t('ELECTROMAGNETICS', ELECTRIC), outside_t('PIEZOELECTRIC', ELECTRIC), outside_t('DIELECTRIC', ELECTRIC), &
            outside_t('COUPLED THERMAL-ELECTRICAL', ELECTRIC), outside_t('CECURRENT', ELECTRIC), outside_t('DECURRENT', ELECTRIC), &
                                 outside_t('SOILS', POROUS), outside_t('SORPTION', POROUS), outside_t('MASS DIFFUSION', POROUS), &
                                 outside_t('POROUS BULK MODULI', POROUS), outside_t('CFLOW', POROUS), outside_t('DFLOW', POROUS), &
                      outside_t('ACOUSTIC', SOUND), outside_t('ACOUSTIC FLOW VELOCITY', SOUND), outside_t('INCIDENT WAVE', SOUND), &
                                 outside_t('NO ANALYSIS', CHECK_ONLY), outside_t('IMPERFECTION', MADE), &
                                 outside_t('SYSTEM', MADE), outside_t('NMAP', MADE), &
                                 outside_t('ADAPTIVE MESH', MADE), &
                                 outside_t('RIGID SURFACE', MADE), outside_t('SLIDE LINE', MADE), &
                     outside_t('CONTACT INITIALIZATION DATA', BEGINNING), outside_t('CONTACT INITIALIZATION ASSIGNMENT', BEGINNING)]

   !> Beginnings of the names of elements; the first that fits counts.
   type(outside_t), parameter :: FAMILIES(*) = [ &
                   outside_t('C3D', SPATIAL), outside_t('CIN3D', SPATIAL), outside_t('R3D', SPATIAL), outside_t('SFM3D', SPATIAL), &
                                 outside_t('CCL', SPATIAL), outside_t('F3D', FLUID), outside_t('DC', HEAT), outside_t('DS', HEAT), &
                   outside_t('DASHPOT', PARTICLE), outside_t('DCOUP', CONSTRAINT), outside_t('DGAP', HEAT), outside_t('D', FLUID), &
             outside_t('SPRING', PARTICLE), outside_t('SAX', STRUCTURE), outside_t('STRI', STRUCTURE), outside_t('SC', STRUCTURE), &
                outside_t('S', STRUCTURE), outside_t('B', STRUCTURE), outside_t('PIPE', STRUCTURE), outside_t('ELBOW', STRUCTURE), &
             outside_t('FRAME', STRUCTURE), outside_t('T2D', STRUCTURE), outside_t('T3D', STRUCTURE), outside_t('M3D', STRUCTURE), &
            outside_t('MAX', STRUCTURE), outside_t('MCL', STRUCTURE), outside_t('MASS', PARTICLE), outside_t('ROTARYI', PARTICLE), &
                outside_t('GAP', PARTICLE), outside_t('CONN', PARTICLE), outside_t('JOINT', PARTICLE), outside_t('ITS', PARTICLE), &
                 outside_t('COH', CRACK), outside_t('R2D', CONSTRAINT), outside_t('RAX', CONSTRAINT), outside_t('RB', CONSTRAINT), &
                              outside_t('FAX', FLUID), outside_t('F2D', FLUID), outside_t('HYDRO', FLUID), outside_t('AC', SOUND), &
                   outside_t('EMC', ELECTRIC), outside_t('CGAX', TWISTED), outside_t('CPEG', TWISTED), outside_t('CAXA', TWISTED), &
                     outside_t('CIN', SPATIAL), outside_t('EC3D', SPATIAL), outside_t('Q3D', SPATIAL), outside_t('US', STRUCTURE), &
                                 outside_t('U', USER_CODE)]

contains

   !> What is known of a keyword that is not in the table.
   pure subroutine ask_keyword(word, verdict, subject)
      character(len=*), intent(in) :: word         !< in capitals, without blanks
      integer, intent(out) :: verdict              !< NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE
      integer, intent(out) :: subject              !< of FOREIGN_OUTSIDE, place in SUBJECTS; else 0
      integer :: i

      verdict = NOT_FOREIGN
      subject = 0
      if (len(word) == 0) return
      do i = 1, size(IGNORED_KEYWORDS)
         if (without_blanks(IGNORED_KEYWORDS(i)) /= word) cycle
         verdict = FOREIGN_IGNORED
         return
      end do
      do i = 1, size(OUTSIDE_KEYWORDS)
         if (without_blanks(OUTSIDE_KEYWORDS(i)%name) /= word) cycle
         verdict = FOREIGN_OUTSIDE
         subject = OUTSIDE_KEYWORDS(i)%subject
         return
      end do
   end subroutine ask_keyword

   !> The subject of elements of other programs; 0: no program has such a type, as far as is known.
   pure integer function ask_element_type(name) result(subject)
      character(len=*), intent(in) :: name
      character(len=len(name)) :: word
      integer :: i

      word = upper_case(name)
      subject = special_plane_type(trim(word))
      if (subject > 0) return
      do i = 1, size(FAMILIES)
         if (index(word, trim(FAMILIES(i)%name)) /= 1 .or. .not. goes_on(word, len_trim(FAMILIES(i)%name))) cycle
         subject = FAMILIES(i)%subject
         return
      end do
   end function ask_element_type

   !> Plane and axisymmetric elements with a letter behind their nodes: CPE4H, CPS4I, CAX8RT, CPE6M.
   pure integer function special_plane_type(word) result(subject)
      character(len=*), intent(in) :: word
      integer :: i

      subject = 0
      if (len(word) < 5) return
      if (all(word(:3) /= ['CPE', 'CPS', 'CAX']) .or. scan(word(4:4), '3468') == 0) return
      do i = 5, len(word)
         select case (word(i:i))
         case ('H')
            subject = MIXED
         case ('I', 'M')
            subject = INCOMPATIBLE
         case ('T')
            subject = HEAT
         case ('P')
            subject = POROUS
         case ('E')
            subject = ELECTRIC
         case ('R')
         case default
            subject = 0
            return
         end select
      end do
   end function special_plane_type

   !> Behind one letter or two a number follows, or nothing: `B31`, `S8R`, `D`; not a misspelt name.
   pure logical function goes_on(word, n)
      character(len=*), intent(in) :: word
      integer, intent(in) :: n                     !< letters

      goes_on = len_trim(word) == n .or. n > 2
      if (.not. goes_on) goes_on = scan(word(n + 1:n + 1), '123456789') == 1
   end function goes_on

   pure function without_blanks(name) result(word)
      character(len=*), intent(in) :: name
      character(len=len(name)) :: word
      integer :: i, n

      word = ''
      n = 0
      do i = 1, len_trim(name)
         if (name(i:i) == ' ') cycle
         n = n + 1
         word(n:n) = name(i:i)
      end do
   end function without_blanks

end module atrito_foreign_keywords
