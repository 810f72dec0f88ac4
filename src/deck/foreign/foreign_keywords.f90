!> Keywords and element types of Abaqus, CalculiX and their preprocessors that the keyword table does not have: those that change
!> no result of a linear static run, and those that ask for what atrito does not solve.
!>
!> They are plain lists, searched when a name is not in the table; the table is made at each start and stays short. What a list
!> has and the table as well, the table decides.
module atrito_foreign_keywords
   use atrito_strings, only: string_t, append_string, upper_case
   implicit none (type, external)
   private
   public :: ask_keyword, ask_element_type, foreign_keywords, is_among, SUBJECTS, NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE, &
             LINEAR_STEP, CHANGE

   !> What is known of a foreign name.
   integer, parameter :: NOT_FOREIGN = 0, FOREIGN_IGNORED = 1, FOREIGN_OUTSIDE = 2

   !> What lies outside, and what to do instead.
   type :: subject_t
      character(len=72) :: what = ''
      character(len=150) :: instead = ''
      logical :: is_scene = .false.                !< nothing that is left of such a deck means what it says
   end type subject_t

   type :: names_t
      integer :: subject = 1                       !< place in SUBJECTS
      character(len=492) :: names = ''             !< in capitals, a comma and a blank between two
   end type names_t

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
   character(len=*), parameter :: IGNORED = 'ACOUSTIC MEDIUM, ANNEAL TEMPERATURE, BULK VISCOSITY, CONDUCTIVITY, '// &
         'CONTACT CONTROLS, CONTACT CONTROLS ASSIGNMENT, CONTACT DAMPING, CONTACT FORMULATION, CONTACT OUTPUT, '// &
         'CONTACT STABILIZATION, DAMPING, DEPVAR, DIAGNOSTICS, DISPLAY BODY, ELECTRICAL CONDUCTIVITY, ELEMENT OUTPUT, '// &
         'EMISSIVITY, ENERGY FILE, ENERGY OUTPUT, ENERGY PRINT, FACE PRINT, FILE FORMAT, FILE OUTPUT, FILTER, '// &
         'FLUID CONSTANTS, GAP CONDUCTANCE, GAP HEAT GENERATION, GAP RADIATION, HOURGLASS STIFFNESS, '// &
         'INCREMENTATION OUTPUT, INELASTIC HEAT FRACTION, INTEGRATED OUTPUT, INTEGRATED OUTPUT SECTION, LATENT HEAT, '// &
         'MAGNETIC PERMEABILITY, MATRIX OUTPUT, MONITOR, NODE OUTPUT, OUTPUT, PERMEABILITY, PHYSICAL CONSTANTS, '// &
         'PREPRINT, PRINT, SECTION CONTROLS, SECTION FILE, SOLUTION TECHNIQUE, SOLVER CONTROLS, SPECIFIC GAS CONSTANT, '// &
         'SPECIFIC HEAT, SURFACE OUTPUT, SURFACE PROPERTY ASSIGNMENT, SURFACE SMOOTHING, TIME POINTS, '// &
         'TRANSVERSE SHEAR STIFFNESS, USER OUTPUT VARIABLES, VALUES AT INFINITY, VARIABLE MASS SCALING, '// &
         'FIXED MASS SCALING, VISCOSITY'

   !> Names of keywords by their subjects, in the order of `atrito help`.
   type(names_t), parameter :: OUTSIDE(*) = [ &
         names_t(YIELD, 'PLASTIC, CREEP, VISCO, CYCLIC HARDENING, DEFORMATION PLASTICITY, CHANGE PLASTIC, POTENTIAL, '// &
            'DRUCKER PRAGER, DRUCKER PRAGER HARDENING, MOHR COULOMB, MOHR COULOMB HARDENING, CAP PLASTICITY, '// &
            'CAP HARDENING, CLAY PLASTICITY, CLAY HARDENING, CONCRETE, CONCRETE DAMAGED PLASTICITY, '// &
            'CONCRETE COMPRESSION HARDENING, CONCRETE TENSION STIFFENING, TENSION STIFFENING, RATE DEPENDENT, '// &
            'VISCOELASTIC, VISCOUS, DAMAGE INITIATION, DAMAGE EVOLUTION, CAST IRON PLASTICITY, CRUSHABLE FOAM, SWELLING, '// &
            'ORNL'), &
         names_t(RUBBER, 'HYPERELASTIC, HYPERFOAM, MULLINS EFFECT, NO COMPRESSION, NO TENSION, HYPOELASTIC, '// &
            'POROUS ELASTIC, FABRIC'), &
         names_t(USER_LAW, 'USER MATERIAL, USER DEFINED FIELD'), &
         names_t(INERTIA, 'DYNAMIC, MODAL DYNAMIC, MODAL DAMPING, STEADY STATE DYNAMICS, RANDOM RESPONSE, '// &
            'RESPONSE SPECTRUM, BASE MOTION, SUBSPACE, GREEN, IMPEDANCE, DIRECT CYCLIC'), &
         names_t(EIGENVALUES, 'FREQUENCY, COMPLEX FREQUENCY, BUCKLE'), &
         names_t(DESIGN, 'ROBUST DESIGN, RANDOM FIELD, SENSITIVITY, OBJECTIVE, DESIGN VARIABLES, DESIGN RESPONSE, '// &
            'CONSTRAINT, GEOMETRIC CONSTRAINT, FEASIBLE DIRECTION'), &
         names_t(HEAT, 'HEAT TRANSFER, COUPLED TEMPERATURE-DISPLACEMENT, UNCOUPLED TEMPERATURE-DISPLACEMENT, CFLUX, '// &
            'DFLUX, DSFLUX, FILM, SFILM, RADIATE, SRADIATE, VIEWFACTOR, CRADIATE, CAVITY'), &
         names_t(FLUID, 'CFD, FLUID SECTION, FLUID SECTIONS, MASS FLOW, BOUNDARYF, EQUATIONF, TRANSFORMF, NETWORK MPC, '// &
            'FLUID CAVITY'), &
         names_t(STRUCTURE, 'SHELL SECTION, SHELL GENERAL SECTION, BEAM SECTION, BEAM GENERAL SECTION, '// &
            'MEMBRANE SECTION, MEMBRANE, TRUSS SECTION, USER SECTION, NORMAL, FRAME SECTION, REBAR, REBAR LAYER, '// &
            'SURFACE SECTION'), &
         names_t(CONSTRAINT, 'MPC, COUPLING, KINEMATIC, DISTRIBUTING, DISTRIBUTING COUPLING, KINEMATIC COUPLING, '// &
            'EMBEDDED ELEMENT, SHELL TO SOLID COUPLING, MULTI-POINT CONSTRAINT, INERTIA RELIEF'), &
         names_t(BOLT, 'BOLT LOAD'), &
         names_t(PARTICLE, 'DASHPOT, MASS, ROTARY INERTIA, GAP, CONNECTOR SECTION, CONNECTOR BEHAVIOR, '// &
            'CONNECTOR ELASTICITY, CONNECTOR DAMPING, CONNECTOR MOTION, CONNECTOR LOAD, JOINT'), &
         names_t(CYCLIC, 'CYCLIC SYMMETRY MODEL, SELECT CYCLIC SYMMETRY MODES, SYMMETRIC MODEL GENERATION'), &
         names_t(SUBMODEL, 'SUBMODEL, SUBSTRUCTURE GENERATE, SUBSTRUCTURE MATRIX OUTPUT, SUBSTRUCTURE PATH, '// &
            'SUBSTRUCTURE LOAD CASE, SLOAD, RETAINED NODAL DOFS, MATRIX ASSEMBLE, IMPORT, MAP SOLUTION, REFINE MESH'), &
         names_t(CHANGE, 'MODEL CHANGE, CHANGE FRICTION, CHANGE SURFACE BEHAVIOR, CHANGE SOLID SECTION, '// &
            'CHANGE MATERIAL, FIELD, CHANGE CONTACT TYPE, LOAD CASE, END LOAD CASE, GEOSTATIC'), &
         names_t(CRACK, 'CRACK PROPAGATION, COHESIVE SECTION, COHESIVE BEHAVIOR, ENRICHMENT, DEBOND, CONTOUR INTEGRAL, '// &
            'FRACTURE CRITERION, SURFACE FLAW, INITIAL STRAIN INCREASE'), &
         names_t(USER_CODE, 'USER ELEMENT, UEL PROPERTY, USER SUBROUTINE'), &
         names_t(AXES, 'ORIENTATION, DISTRIBUTION, DISTRIBUTION TABLE'), &
         names_t(ELECTRIC, 'ELECTROMAGNETICS, PIEZOELECTRIC, DIELECTRIC, COUPLED THERMAL-ELECTRICAL, CECURRENT, '// &
            'DECURRENT'), &
         names_t(POROUS, 'SOILS, SORPTION, MASS DIFFUSION, POROUS BULK MODULI, CFLOW, DFLOW'), &
         names_t(SOUND, 'ACOUSTIC, ACOUSTIC FLOW VELOCITY, INCIDENT WAVE'), &
         names_t(CHECK_ONLY, 'NO ANALYSIS'), &
         names_t(MADE, 'IMPERFECTION, SYSTEM, NMAP, ADAPTIVE MESH, RIGID SURFACE, SLIDE LINE'), &
         names_t(BEGINNING, 'CONTACT INITIALIZATION DATA, CONTACT INITIALIZATION ASSIGNMENT')]

   !> Beginnings of the names of elements; the longest that fits counts.
   type(names_t), parameter :: FAMILIES(*) = [ &
         names_t(SPATIAL, 'C3D, CIN3D, R3D, SFM3D, CCL, CIN, EC3D, Q3D'), &
         names_t(FLUID, 'F3D, D, FAX, F2D, HYDRO'), &
         names_t(HEAT, 'DC, DS, DGAP'), &
         names_t(PARTICLE, 'DASHPOT, SPRING, MASS, ROTARYI, GAP, CONN, JOINT, ITS'), &
         names_t(CONSTRAINT, 'DCOUP, R2D, RAX, RB'), &
         names_t(STRUCTURE, 'SAX, STRI, SC, S, B, PIPE, ELBOW, FRAME, T2D, T3D, M3D, MAX, MCL, US'), &
         names_t(CRACK, 'COH'), &
         names_t(SOUND, 'AC'), &
         names_t(ELECTRIC, 'EMC'), &
         names_t(TWISTED, 'CGAX, CPEG, CAXA'), &
         names_t(USER_CODE, 'U')]

contains

   !> What is known of a keyword that is not in the table.
   pure subroutine ask_keyword(word, verdict, subject)
      character(len=*), intent(in) :: word         !< in capitals, without blanks
      integer, intent(out) :: verdict              !< NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE
      integer, intent(out) :: subject              !< of FOREIGN_OUTSIDE, place in SUBJECTS; else 0
      integer :: i

      verdict = NOT_FOREIGN
      subject = 0
      if (is_among(word, IGNORED)) verdict = FOREIGN_IGNORED
      if (verdict == FOREIGN_IGNORED) return
      do i = 1, size(OUTSIDE)
         if (.not. is_among(word, OUTSIDE(i)%names)) cycle
         verdict = FOREIGN_OUTSIDE
         subject = OUTSIDE(i)%subject
      end do
   end subroutine ask_keyword

   !> The names of other programs' keywords.
   pure function foreign_keywords(verdict, subject) result(names)
      integer, intent(in) :: verdict               !< FOREIGN_IGNORED, FOREIGN_OUTSIDE
      integer, intent(in), optional :: subject     !< of FOREIGN_OUTSIDE these alone; place in SUBJECTS
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      if (verdict == FOREIGN_IGNORED) call append_names(IGNORED, names)
      if (verdict == FOREIGN_IGNORED) return
      do i = 1, size(OUTSIDE)
         if (present(subject)) then
            if (OUTSIDE(i)%subject /= subject) cycle
         end if
         call append_names(trim(OUTSIDE(i)%names), names)
      end do
   end function foreign_keywords

   pure subroutine append_names(list, names)
      character(len=*), intent(in) :: list
      type(string_t), allocatable, intent(inout) :: names(:)
      integer :: first, last

      first = 1
      do while (first <= len(list))
         last = first - 2 + index(list(first:)//',', ',')
         call append_string(names, list(first:last))
         first = last + 3
      end do
   end subroutine append_names

   !> A word is one of the names of a list, blanks apart.
   pure logical function is_among(word, list)
      character(len=*), intent(in) :: word         !< in capitals, without blanks
      character(len=*), intent(in) :: list         !< a comma between two names

      is_among = index(','//trim(without_blanks(list))//',', ','//word//',') > 0 .and. len(word) > 0 .and. index(word, ',') == 0
   end function is_among

   !> The subject of elements of other programs; 0: no program has such a type, as far as is known.
   pure integer function ask_element_type(name) result(subject)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: word
      integer :: i, n

      word = trim(upper_case(name))
      subject = special_plane_type(word)
      if (subject > 0) return
      do n = len(word), 1, -1
         if (.not. goes_on(word, n)) cycle
         do i = 1, size(FAMILIES)
            if (is_among(word(:n), FAMILIES(i)%names)) subject = FAMILIES(i)%subject
         end do
         if (subject > 0) return
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
