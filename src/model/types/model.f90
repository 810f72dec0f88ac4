!> What a deck means: one model_t, all that the solver and the writers need, no deck text.
!>
!> The names of the units of a deck, *UNITS. Nothing is computed from them: they are for people.
module atrito_model
   use atrito_bilateral_rows, only: bilateral_rows_t
   use atrito_controls, only: controls_t
   use atrito_crossings, only: cross_section_t
   use atrito_element_places, only: place_t
   use atrito_faces, only: face_list_t
   use atrito_friction_law, only: FRICTION_NONE, FRICTION_LOCAL, FRICTION_NONLOCAL, KERNEL_POINTS, KERNEL_LINE
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_orthotropy, only: SPATIAL, inverse_of, turned_compliance, turned_stiffness
   use atrito_patched_text, only: named_text_t
   use atrito_plane_state, only: FORMULATION_STANDARD, FORMULATION_BBAR, elastic_t
   use atrito_points, only: contact_points_t
   use atrito_sets, only: set_list_t
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: model_t, step_t, material_t, section_t, surface_t, interaction_t, pair_t, nodal_values_t, element_load_t, &
            elasticity_of, provenance_t, rigid_body_t, cut_t, observed_line_t, path_t, amplitude_t, increments_t, spring_t, tie_t, &
            requests_t, requested_t, SURFACE_ELEMENTS, SURFACE_SEGMENTS, FORMULATION_STANDARD, FORMULATION_BBAR, FORMULATION_NAME, &
             FRICTION_NONE, FRICTION_LOCAL, FRICTION_NONLOCAL, KERNEL_POINTS, KERNEL_LINE, QUADRATURE_AUTO, QUADRATURE_NODAL, &
             QUADRATURE_MORTAR, FRICTION_NAME, KERNEL_NAME, is_due, all_frequencies, rigid_body_name, LOAD_PRESSURE, LOAD_BODY, &
             LOAD_TRACTION, LOAD_HYDROSTATIC, LOAD_LINEAR, is_on_volume, units_t, unit_names, in_units, name_units, N_UNITS

   integer(ip), parameter :: SURFACE_ELEMENTS = 1, SURFACE_SEGMENTS = 2
   character(len=8), parameter :: FORMULATION_NAME(2) = ['STANDARD', 'BBAR    ']
   integer(ip), parameter :: QUADRATURE_AUTO = 0, QUADRATURE_NODAL = 1, QUADRATURE_MORTAR = 2
   character(len=8), parameter :: FRICTION_NAME(0:2) = ['none    ', 'LOCAL   ', 'NONLOCAL']
   character(len=6), parameter :: KERNEL_NAME(2) = ['POINTS', 'LINE  ']
   integer(ip), parameter :: LOAD_PRESSURE = 1, LOAD_BODY = 2, LOAD_TRACTION = 3, LOAD_HYDROSTATIC = 4, LOAD_LINEAR = 5

   !> Where results come from, in words: what the head of every table has beside the deck's name and heading. A component that
   !> is not allocated has no line there.
   type :: provenance_t
      character(len=:), allocatable :: parameters    !< of the deck with their values: 'nu = 0.3, q = 10 (--set)'
      character(len=:), allocatable :: options       !< of the command line that change results or tables: '--refine 1'
      character(len=:), allocatable :: digest        !< of the deck as it was run, 16 hexadecimal digits
   end type provenance_t

   !> *MATERIAL: its elasticity, density and expansion.
   type :: material_t
      character(len=:), allocatable :: name    !< as the deck has it
      real(wp) :: young = 0.0_wp               !< E [F/L^2], > 0
      real(wp) :: poisson = 0.0_wp             !< mu [-]
      real(wp) :: density = 0.0_wp             !< mass per volume
      real(wp) :: expansion = 0.0_wp           !< alpha [1/temperature]
      logical :: has_expansion = .false.       !< it is given
      logical :: is_orthotropic = .false.      !< E is the mean of E1 and E2 then, mu is nothing
      real(wp) :: stiffness(SPATIAL, SPATIAL) = 0.0_wp  !< then, along the axes of the material: 11, 22, 33, 12 [F/L^2]
   end type material_t

   !> *SOLID SECTION: material and thickness of the elements of a set.
   type :: section_t
      character(len=:), allocatable :: elset   !< name of its element set
      integer(ip) :: material = 0              !< place in model%materials
      real(wp) :: thickness = 1.0_wp           !< [L], > 0
      logical :: is_tapered = .false.          !< the nodes have the thickness, and that of the section is 1
      integer(ip) :: formulation = FORMULATION_STANDARD !< FORMULATION_*, of four-node quadrilaterals
      real(wp) :: axis(2) = [1.0_wp, 0.0_wp]   !< the first axis of the material: *ORIENTATION
   end type section_t

   !> A surface of element faces (a connected chain when it is a slave) or of rigid segments, straight ones and arcs.
   type :: surface_t
      character(len=:), allocatable :: name    !< as the deck has it
      integer(ip) :: kind = SURFACE_ELEMENTS   !< SURFACE_*
      logical :: is_rigid_body = .false.       !< a *RIGID BODY names it
      type(face_list_t) :: faces               !< SURFACE_ELEMENTS
      real(wp), allocatable :: points(:, :)    !< SURFACE_SEGMENTS: ends of the segments [L], (2, n+1), in direction of travel
      logical, allocatable :: is_arc(:)        !< (n)
      real(wp), allocatable :: centre(:, :)    !< (2, n) of arcs [L]
   end type surface_t

   !> *SURFACE INTERACTION: the law of contact and of friction.
   type :: interaction_t
      character(len=:), allocatable :: name    !< as the deck has it
      real(wp) :: delta = 0.0_wp               !< penalty parameter [L^3/F]; 0 is exact (HARD)
      integer(ip) :: friction = FRICTION_NONE  !< FRICTION_*
      real(wp) :: nu = 0.0_wp                  !< friction coefficient
      real(wp) :: eps = 0.0_wp                 !< NONLOCAL: [L]; 0 is exact stick
      real(wp) :: rho = 0.0_wp                 !< NONLOCAL: [L]; 0 is local
      logical :: is_incremental = .false.      !< slip counts from the last increment, not from the beginning
      real(wp) :: stick_slope = 0.0_wp         !< LOCAL: k [F/L^3]; 0 is exact stick
      integer(ip) :: kernel = KERNEL_POINTS    !< NONLOCAL: KERNEL_*, how S_rho averages
   end type interaction_t

   !> A contact pair: its two surfaces, its law, and how its points are made.
   type :: pair_t
      integer(ip) :: interaction = 0, slave = 0, master = 0   !< places in the model's lists
      logical :: is_exchanged = .false.                       !< the deck has them the other way round (choose_roles)
      integer(ip) :: quadrature = QUADRATURE_AUTO             !< as the deck asks for
      logical :: is_adjusted = .false.                        !< ADJUST: slave nodes are moved onto the master
      real(wp) :: adjust = 0.0_wp                             !< up to this gap [L] ...
      integer(ip) :: adjust_set = 0                           !< ... or those of this node set; 0: none
      logical :: gap_is_given = .false.                       !< *CLEARANCE gives its initial gaps
      logical :: is_resolved = .false.                        !< *CONTACT INTERFERENCE, SHRINK: its overlap goes over a step
      integer(ip) :: outline = 0    !< of *CONTACT: the same for slaves that continue each other, which S_rho does not cut; 0: none
   end type pair_t

   !> What a line of a support or a load acts on, as the deck names it: a row of resultants.tab.
   type :: source_t
      character(len=:), allocatable :: keyword      !< BOUNDARY, CLOAD, DLOAD or DSLOAD
      character(len=:), allocatable :: name         !< of a set or a surface, or the number of a node or an element
   end type source_t

   !> Values at single dofs: prescribed displacements [L], or forces [F] for the whole thickness.
   type :: nodal_values_t
      integer(ip) :: n = 0                          !< values in use
      integer(ip), allocatable :: node(:), dof(:)   !< dof 1 or 2; of reference nodes also 6, rotation [-] and moment [F L]
      real(wp), allocatable :: value(:)             !< at the end of a step, or what an amplitude multiplies
      real(wp), allocatable :: from(:)              !< at the beginning of a step; not allocated: 0
      integer(ip), allocatable :: amplitude(:)      !< place in model%amplitudes; 0, or not allocated: none
      integer(ip), allocatable :: source(:)         !< place in model%sources; 0, or not allocated: no line of the deck
   end type nodal_values_t

   !> A rigid surface that moves with a reference node, as a body does that turns about it; or nodes of bodies that do.
   type :: rigid_body_t
      integer(ip) :: surface = 0, node = 0          !< places; the node belongs to no element; surface 0: it has none
      real(wp) :: size = 1.0_wp                     !< largest distance of its surface and nodes from the node [L]
      logical :: is_section = .false.               !< a *PRE-TENSION SECTION: its node moves along 1 alone
      character(len=:), allocatable :: name         !< where there is no surface: that of the set of its nodes
   end type rigid_body_t

   !> *TIE: two surfaces that are joined.
   type :: tie_t
      character(len=:), allocatable :: name         !< as the deck has it
      integer(ip) :: slave = 0, master = 0          !< places of surfaces
      integer(ip) :: quadrature = QUADRATURE_AUTO   !< QUADRATURE_*
      real(wp) :: tolerance = -1.0_wp               !< farther nodes of the slave are not tied [L]; < 0: not set yet
      logical :: adjusts = .true.                   !< nodes of the slave are moved onto the master
      integer(ip) :: n_nodes = 0, n_far = 0         !< of the slave that are tied, and that are not
   end type tie_t

   !> SPRING1 holds one node, SPRING2 and SPRINGA two; dof 0: along the line between them, 6: rotations of reference nodes.
   type :: spring_t
      integer(ip) :: id = 0                         !< the user's number
      integer(ip) :: node(2) = 0, dof(2) = 0        !< second node 0: the ground
      real(wp) :: stiffness = 0.0_wp                !< [F/L], > 0; of dof 6 [F L]
      real(wp) :: arm = 1.0_wp                      !< of dof 6: what the row has the rotations times [L]
   end type spring_t

   !> Loads on elements; several add up.
   type :: element_load_t
      integer(ip) :: n = 0                          !< loads; the arrays have this length
      integer(ip), allocatable :: element(:)        !< (n) places in the mesh
      integer(ip), allocatable :: kind(:)           !< LOAD_*
      integer(ip), allocatable :: face(:)           !< 1..4; LOAD_BODY and LOAD_LINEAR: 0
      integer(ip), allocatable :: line(:)           !< of the deck, that gives it
      integer(ip), allocatable :: source(:)         !< place in model%sources; 0, or not allocated: not known
      real(wp), allocatable :: value(:, :)          !< (3, n): pressure at the origin and its slopes along x and y, 0 where it is
      !< uniform [F/L^2], [F/L^3]; force per volume [F/L^3] or traction [F/L^2] in two; LOAD_HYDROSTATIC: pressure at a level x2,
      !< the level where it is 0, and that level [F/L^2], [L]; LOAD_LINEAR: force per volume A x, x from the origin: A11, A12 = A21,
      !< A22 [F/L^4]
      real(wp), allocatable :: from(:, :)           !< (3, n) the same at the beginning of a step; not allocated: 0, with the levels
      !< of LOAD_HYDROSTATIC as they are in value
      integer(ip), allocatable :: amplitude(:)      !< (n) place in model%amplitudes; 0, or not allocated: none
   end type element_load_t

   !> A curve over time that multiplies loads and displacements: *AMPLITUDE.
   type :: amplitude_t
      character(len=:), allocatable :: name         !< as the deck has it
      real(wp), allocatable :: time(:), value(:)    !< time ascends; before the first and after the last the value stays
      logical :: is_total_time = .false.            !< of the history, not of the step
      logical :: is_smooth = .false.                !< between two times the slope is 0 at both
   end type amplitude_t

   !> How a step goes through its time: *STATIC. Times are of the step.
   type :: increments_t
      real(wp) :: initial = 1.0_wp, period = 1.0_wp !< length of the first increment, and of the step
      real(wp) :: least = 1.0_wp, greatest = 1.0_wp !< an increment that fails is cut, down to the least
      integer(ip) :: most = 100                     !< increments of the step: INC=
   end type increments_t

   !> How often what is asked for is printed: every so many increments; 0: at the end of the step, as it always is.
   type :: frequencies_t
      integer(ip) :: nodes = 0, reactions = 0, stress = 0, nodal_stress = 0, contact = 0, bodies = 0, joints = 0 !< increments
      !< between two prints of each; 0: at the end of the step
      integer(ip) :: sections = 0, paths = 0, fields = 0 !< of *SECTION PRINT, *PATH PRINT and the field file
   end type frequencies_t

   !> Nodes, elements and contact that were asked for.
   type :: requested_t
      logical :: nodes = .false., reactions = .false., stress = .false., contact = .false. !< asked for, at some node or element
      logical :: principal = .false.                !< stresses, too: in a table of all steps
      logical, allocatable :: node_u(:), node_rf(:), element_s(:)  !< which nodes, nodes, elements; allocated when asked for
   end type requested_t

   !> What is to be printed, and what goes into the field file.
   type, extends(requested_t) :: requests_t
      logical :: bodies = .false., joints = .false., nodal_stress = .false. !< bodies.tab, joints.tab, stresses at nodes
      logical, allocatable :: node_s(:)             !< nodes whose stresses were asked for; allocated when they were
      integer(ip), allocatable :: cuts(:)           !< places in model%cuts; not allocated: none
      integer(ip), allocatable :: paths(:)          !< the same in model%paths
      type(requested_t) :: fields                   !< the same for the field file
      type(frequencies_t) :: every                  !< increments between two prints
   end type requests_t

   !> A cut through bodies, with the forces in the cross-section: *SECTION PRINT.
   type :: cut_t
      character(len=:), allocatable :: name         !< NAME= of the card; of several lines with -i behind it
      real(wp) :: ends(2, 2) = 0.0_wp               !< two points of its line [L]
      integer(ip) :: elset = 0                      !< place of the element set that chooses crossings; 0: all
      type(cross_section_t) :: section              !< of the mesh as it is solved
   end type cut_t

   !> A line or an arc along which values are printed: *PATH PRINT.
   type :: path_t
      character(len=:), allocatable :: name         !< NAME= of the card; of several lines with -i behind it
      logical :: is_arc = .false., has_centre = .false. !< has_centre: a line asks for polar components by it
      real(wp) :: ends(2, 2) = 0.0_wp               !< of a line [L]
      real(wp) :: centre(2) = 0.0_wp                !< of the arc, or of polar components [L]
      real(wp) :: radius = 0.0_wp, angles(2) = 0.0_wp !< of an arc [L], [rad]
      integer(ip) :: n_points = 41                  !< at equal distances, both ends among them
      integer(ip) :: elset = 0                      !< place of the element set that it keeps to; 0: all
      type(place_t), allocatable :: place(:)        !< (rows) the elements of the mesh as it is solved
      real(wp), allocatable :: s(:), x(:, :), along(:, :) !< (rows) arc length, (2, rows) place [L], direction
   end type path_t

   !> A parameter of *PARAMETER, evaluated.
   type :: parameter_value_t
      character(len=:), allocatable :: name         !< without the brackets
      character(len=:), allocatable :: written      !< its expression in the deck; not allocated: not known
      real(wp) :: value = 0.0_wp                    !< that it has in this run
      logical :: overridden = .false.               !< by --set
   end type parameter_value_t

   !> A line of *OBSERVE.
   type :: observed_line_t
      character(len=:), allocatable :: text         !< name = expression
      character(len=:), allocatable :: file         !< as the user wrote it
      integer(ip) :: line = 0, column = 0           !< of its first character
   end type observed_line_t

   !> An instance of a part.
   type :: instance_t
      character(len=:), allocatable :: name, part   !< as the deck has them
      integer(ip) :: first_number = 1               !< that of the part's node or element 1
      real(wp) :: shift(2) = 0.0_wp                 !< [L], before the rotation
      real(wp) :: angle = 0.0_wp                    !< [degrees]
   end type instance_t

   !> A step of the history: all that acts in it, what it inherits from earlier steps too, and what it asks for. From the
   !> beginning of the step to its end values go linearly with the time, or at once; those with an amplitude follow it.
   type :: step_t
      character(len=:), allocatable :: title        !< as the deck has it; '' without one
      type(increments_t) :: increments              !< times of the step
      real(wp) :: began = 0.0_wp                    !< time of the history at its beginning
      logical :: at_once = .false.                  !< AMPLITUDE=STEP: what has no amplitude has its last value from the beginning
      type(nodal_values_t) :: prescribed            !< each dof once
      type(nodal_values_t) :: node_loads            !< several on one dof add up
      type(nodal_values_t) :: rigid_prescribed      !< of reference nodes, each dof once
      type(nodal_values_t) :: rigid_loads           !< of reference nodes; several on one dof add up
      type(element_load_t) :: element_loads         !< of this step and those it inherits
      real(wp), allocatable :: heating(:)           !< (n_nodes) rise of the temperature; not allocated where none expands anything
      real(wp), allocatable :: heating_from(:)      !< (n_nodes) the same at the beginning; not allocated: 0
      real(wp), allocatable :: overlap(:)           !< (pairs) share of the initial overlap that is allowed at the end ...
      real(wp), allocatable :: overlap_from(:)      !< ... and at the beginning; not allocated: 0
      type(controls_t) :: controls                  !< of the outer loop in this step
      type(requests_t) :: requests                  !< what is printed of this step
   end type step_t

   integer(ip), parameter :: N_UNITS = 4

   !> What dimensions are written with (docs/user/keywords.md), in the order of the names.
   character(len=11), parameter :: SYMBOLS(N_UNITS) = [character(len=11) :: 'L', 'F', 'T', 'temperature']

   !> *UNITS.
   type :: units_t
      type(string_t) :: names(N_UNITS)   !< of length, force, time and temperature; %s not allocated: not named
   end type units_t

   !> All that a deck means.
   type :: model_t
      character(len=:), allocatable :: deck_path    !< as the user wrote it
      character(len=:), allocatable :: deck_name    !< without folder and .inp
      type(string_t), allocatable :: heading(:)     !< lines of *HEADING
      type(units_t) :: units                        !< that the deck names
      type(provenance_t) :: provenance              !< for the heads of tables; empty: the heads have none of it
      type(named_text_t), allocatable :: as_run(:)  !< the deck as it is run, for the writer alone; not allocated: it is not kept
      type(parameter_value_t), allocatable :: parameters(:) !< in the order of the deck
      type(observed_line_t), allocatable :: observed(:) !< lines of *OBSERVE, in the order of the deck
      type(instance_t), allocatable :: instances(:) !< of parts; a deck without parts has none
      type(mesh_t) :: mesh                          !< nodes and elements as they are solved
      logical :: has_arcs = .false.                 !< sides of a *BLOCK are: elements with straight sides make polygons of them
      integer(ip) :: levels = 0                     !< of --refine: each element of the deck is 4**levels of the mesh
      integer(ip) :: n_cut = 0                      !< elements of the deck that are cut where the error is
      type(set_list_t) :: node_sets, element_sets   !< members are places in the mesh
      type(material_t), allocatable :: materials(:) !< in the order of the deck
      type(section_t), allocatable :: sections(:)   !< one a *SOLID SECTION
      integer(ip), allocatable :: section_of(:)     !< section of each element
      type(surface_t), allocatable :: surfaces(:)   !< of the deck, of its blocks, curves and found pairs
      type(rigid_body_t), allocatable :: rigid_bodies(:) !< the rigid surfaces with a reference node
      type(mesh_t), allocatable :: solver_mesh      !< with the nodes that carry their motions, behind the mesh's own; not
      !< allocated: there are none
      type(interaction_t), allocatable :: interactions(:) !< in the order of the deck
      type(pair_t), allocatable :: pairs(:)         !< those of *CONTACT PAIR, then those of *CONTACT
      type(contact_points_t), allocatable :: points(:) !< of each pair
      type(bilateral_rows_t) :: bilateral           !< of ties, equations, supports along other directions, springs
      type(nodal_values_t) :: inclined              !< the supports among them, along directions that are no axis
      type(nodal_values_t) :: equations             !< node, dof and coefficient of the first term of each
      type(spring_t), allocatable :: springs(:)     !< in the order of the deck
      type(tie_t), allocatable :: ties(:)           !< in the order of the deck
      type(amplitude_t), allocatable :: amplitudes(:) !< in the order of the deck
      type(source_t), allocatable :: sources(:)     !< of supports and loads of all steps, in the order of the deck
      type(cut_t), allocatable :: cuts(:)           !< of all steps; not allocated: none
      type(path_t), allocatable :: paths(:)         !< the same
      type(step_t), allocatable :: steps(:)         !< the history, >= 1
      logical :: asks_nlgeom = .false.              !< a step asks for large displacements; small ones are solved
      integer(ip) :: restart_every = 0              !< increments between two restart files; 0: none is written
   end type model_t

contains

   !> Whether a load acts on the volume of an element, not on a face.
   pure elemental logical function is_on_volume(kind)
      integer(ip), intent(in) :: kind               !< LOAD_*

      is_on_volume = kind == LOAD_BODY .or. kind == LOAD_LINEAR
   end function is_on_volume

   !> The name of a rigid body.
   pure function rigid_body_name(model, i) result(name)
      type(model_t), intent(in) :: model            !< surfaces and rigid bodies are read
      integer(ip), intent(in) :: i                  !< of the rigid bodies
      character(len=:), allocatable :: name

      associate (body => model%rigid_bodies(i))
         if (body%surface > 0) then
            name = model%surfaces(body%surface)%name
         else
            name = body%name
         end if
      end associate
   end function rigid_body_name

   !> All of them.
   pure function all_frequencies(every) result(list)
      type(frequencies_t), intent(in) :: every      !< of one step
      integer(ip) :: list(10)

      list = [every%nodes, every%reactions, every%stress, every%nodal_stress, every%contact, every%bodies, every%joints, &
              every%sections, every%paths, every%fields]
   end function all_frequencies

   !> Whether an increment is printed.
   pure elemental logical function is_due(every, increment, ends_step)
      integer(ip), intent(in) :: every              !< so many increments; 0: at the end of the step alone
      integer(ip), intent(in) :: increment          !< of the step, counted from 1
      logical, intent(in) :: ends_step              !< it is the last of its step

      is_due = ends_step
      if (every > 0) is_due = is_due .or. mod(increment, every) == 0
   end function is_due

   !> The elasticity of a section: that of its material, turned by the orientation of the section where it is orthotropic.
   pure type(elastic_t) function elasticity_of(section, material) result(elastic)
      type(section_t), intent(in) :: section     !< thickness, formulation and axis are used
      type(material_t), intent(in) :: material   !< of the section

      elastic = elastic_t(material%young, material%poisson, section%thickness, material%density, section%formulation, &
                          material%expansion)
      if (.not. material%is_orthotropic) return
      elastic%is_orthotropic = .true.
      elastic%stiffness = turned_stiffness(material%stiffness, section%axis)
      elastic%compliance = turned_compliance(inverse_of(material%stiffness), section%axis)
   end function elasticity_of

   !> The names as *UNITS has them: 'm, kN'; '' where there are none.
   pure function unit_names(units) result(text)
      type(units_t), intent(in) :: units         !< of the deck
      character(len=:), allocatable :: text
      integer(ip) :: k

      text = ''
      do k = 1, N_UNITS
         if (.not. allocated(units%names(k)%s)) cycle
         if (k > 1) text = text//', '
         text = text//units%names(k)%s
      end do
   end function unit_names

   !> `[F/L^2]` is `[kN/m^2]` in a line for people, where the deck names its units.
   pure subroutine name_units(units, line, quote)
      type(units_t), intent(in) :: units
      character(len=:), allocatable, intent(inout) :: line
      character(len=1), intent(in), optional :: quote   !< round the words of the user, which stay
      character(len=:), allocatable :: name
      integer :: begin, end, next, k
      logical :: is_ours

      if (.not. any([(allocated(units%names(k)%s), k=1, N_UNITS)])) return
      begin = index(line, '[')
      do while (begin > 0)
         end = begin + index(line(begin:), ']') - 1
         if (end < begin) return
         name = line(begin + 1:end - 1)
         is_ours = .true.
         if (present(quote)) is_ours = mod(count([(line(k:k) == quote, k=1, begin)]), 2) == 0
         if (is_ours) name = in_units(units, name)
         line = line(:begin)//name//line(end:)
         end = begin + len(name) + 1
         next = index(line(end:), '[')
         begin = merge(0, end + next - 1, next == 0)
      end do
   end subroutine name_units

   !> A dimension in the units of a deck: 'F/L^2' is 'kN/m^2'. What has no name stays as it is: 'F/L^2'.
   pure function in_units(units, dimension) result(text)
      type(units_t), intent(in) :: units          !< of the deck
      character(len=*), intent(in) :: dimension   !< F, L, T and temperature with what joins them
      character(len=:), allocatable :: text
      character(len=*), parameter :: LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz'
      integer :: first, last
      integer(ip) :: k

      text = ''
      first = 1
      do while (first <= len(dimension))
         last = first + verify(dimension(first:)//' ', LETTERS) - 2
         if (last < first) then
            text = text//dimension(first:first)
            first = first + 1
            cycle
         end if
         k = findloc(SYMBOLS, dimension(first:last), 1, kind=ip)
         if (k == 0) then
            text = text//dimension(first:last)
         else if (.not. allocated(units%names(k)%s)) then
            text = text//dimension(first:last)
         else
            text = text//units%names(k)%s
         end if
         first = last + 1
      end do
   end function in_units

end module atrito_model
