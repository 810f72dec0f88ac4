!> The table of elements, which all rooms ask: their shapes, and their names in decks and field files. Their plane states are in
!> atrito_plane_state.
!>
!> A shape is named by its number of nodes. A new element is a row of SHAPES or KINDS, and its shape functions and Gauss rule in
!> atrito_shape_functions.
module atrito_element_table
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: elastic_t, STATES, PLANE_STRAIN, PLANE_STRESS, AXISYMMETRIC, PLANE_STRAIN_REDUCED, &
                                 PLANE_STRESS_REDUCED, AXISYMMETRIC_REDUCED, IS_REDUCED, PLAIN_STATE, FORMULATION_BBAR
   implicit none (type, external)
   private
   public :: element_shape_t, element_kind_t, SHAPES, KINDS
   public :: CORNERS_OF, DEGREE_OF, BEST_OF, POINTS_OF, ERROR_POINTS_OF
   public :: MOST_NODES, MOST_SIDES, MOST_CORNERS, kind_named, is_membrane, kind_of, can_average, has_mean_dilatation, POINT_COUNT

   integer(ip), parameter :: MOST_NODES = 9, MOST_CORNERS = 4, MOST_SIDES = 4

   type :: element_shape_t
      integer(ip) :: n_nodes = 0                 !< 0: no element has so many nodes
      integer(ip) :: n_corners = 0               !< and sides; the corners come first, counter-clockwise
      integer(ip) :: degree = 0                  !< of the displacements along a side: 2 with a node in its middle
      integer(ip) :: n_points = 0                !< Gauss points of the stiffness
      integer(ip) :: n_best = 0                  !< points at which stresses are superconvergent
      character(len=2) :: name = ''              !< in field files
      character(len=15) :: topology = ''         !< in XDMF; its order of nodes is ours
      real(wp) :: place(2, MOST_NODES) = 0.0_wp  !< of the nodes: in [-1,1]^2; of triangles where xi, eta and 1 - xi - eta >= 0
      logical :: hollow = .false.                !< no node in the middle of its grid of nodes
   end type element_shape_t

   type :: element_kind_t
      character(len=5) :: name = ''              !< in decks
      integer(ip) :: shape = 0                   !< place in SHAPES: the number of nodes
      integer(ip) :: state = 0                   !< place in STATES
      logical :: own = .false.                   !< Abaqus has none of this name
   end type element_kind_t

   type(element_shape_t), parameter :: NO_SHAPE = element_shape_t()
   integer, private :: i
   !> Corners, middles of the sides, centre.
   real(wp), parameter :: SQUARE(2, MOST_NODES) = reshape([real(wp) :: -1, -1, 1, -1, 1, 1, -1, 1, &
                                                                                   0, -1, 1, 0, 0, 1, -1, 0, 0, 0], [2, MOST_NODES])
   !> Corners, middles of the sides; places 7 to 9 are not used.
   real(wp), parameter :: TRIANGLE(2, MOST_NODES) = 0.5_wp*reshape([real(wp) :: 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0, 1, 0, 0, 0, 0, &
                                                                                                             0, 0], [2, MOST_NODES])
   type(element_shape_t), parameter :: SHAPES(MOST_NODES) = &
                                       [(NO_SHAPE, i=1, 2), element_shape_t(3, 3, 1, 1, 1, 'T1', 'Triangle', TRIANGLE), &
                                        element_shape_t(4, 4, 1, 4, 1, 'Q1', 'Quadrilateral', SQUARE), NO_SHAPE, &
                                        element_shape_t(6, 3, 2, 3, 3, 'T2', 'Triangle_6', TRIANGLE), NO_SHAPE, &
                                        element_shape_t(8, 4, 2, 9, 4, 'S2', 'Quadrilateral_8', SQUARE, hollow=.true.), &
                                        element_shape_t(9, 4, 2, 9, 4, 'Q2', 'Quadrilateral_9', SQUARE)]

   !> Columns by themselves: of all elements of a mesh, SHAPES(shape)%degree would copy the rows.
   integer(ip), parameter :: DEGREE_OF(MOST_NODES) = SHAPES%degree, BEST_OF(MOST_NODES) = SHAPES%n_best
   integer(ip), parameter :: POINTS_OF(MOST_NODES) = SHAPES%n_points, CORNERS_OF(MOST_NODES) = SHAPES%n_corners
   !> Points at which the difference of two stress fields is integrated: of triangles more than the stiffness has, which lie where
   !> that difference is least.
   integer(ip), parameter :: ERROR_POINTS_OF(MOST_NODES) = [0_ip, 0_ip, 3_ip, 4_ip, 0_ip, 6_ip, 0_ip, 9_ip, 9_ip]

   !> Points at which an element's stiffness is integrated and its stresses are given, by shape and state.
   integer(ip), parameter :: POINT_COUNT(MOST_NODES, size(STATES)) = &
                             reshape([(merge(BEST_OF, POINTS_OF, IS_REDUCED(i)), i=1, size(STATES))], [MOST_NODES, size(STATES)])

   type(element_kind_t), parameter :: KINDS(21) = &
                                      [element_kind_t('CPE3', 3, PLANE_STRAIN), element_kind_t('CPS3', 3, PLANE_STRESS), &
                                       element_kind_t('CPE4', 4, PLANE_STRAIN), element_kind_t('CPS4', 4, PLANE_STRESS), &
                                       element_kind_t('CPE6', 6, PLANE_STRAIN), element_kind_t('CPS6', 6, PLANE_STRESS), &
                                       element_kind_t('CPE8', 8, PLANE_STRAIN), element_kind_t('CPS8', 8, PLANE_STRESS), &
                                       element_kind_t('CPE9', 9, PLANE_STRAIN, .true.), &
                                       element_kind_t('CPS9', 9, PLANE_STRESS, .true.), &
                                       element_kind_t('CAX3', 3, AXISYMMETRIC), element_kind_t('CAX4', 4, AXISYMMETRIC), &
                                       element_kind_t('CAX6', 6, AXISYMMETRIC), element_kind_t('CAX8', 8, AXISYMMETRIC), &
                                       element_kind_t('CAX9', 9, AXISYMMETRIC, .true.), &
                                       element_kind_t('CPE4R', 4, PLANE_STRAIN_REDUCED), &
                                       element_kind_t('CPS4R', 4, PLANE_STRESS_REDUCED), &
                                       element_kind_t('CPE8R', 8, PLANE_STRAIN_REDUCED), &
                                       element_kind_t('CPS8R', 8, PLANE_STRESS_REDUCED), &
                                       element_kind_t('CAX4R', 4, AXISYMMETRIC_REDUCED), &
                                       element_kind_t('CAX8R', 8, AXISYMMETRIC_REDUCED)]

contains

   !> Place in KINDS of a name in capitals; 0: there is none. A membrane (M3D4) of the plane is in plane stress (CPS4).
   pure integer(ip) function kind_named(name)
      character(len=*), intent(in) :: name !< in capitals, without blanks at its end

      if (is_membrane(name)) then
         kind_named = findloc(KINDS%name, 'CPS'//name(4:), dim=1, kind=ip)
      else
         kind_named = findloc(KINDS%name, name, dim=1, kind=ip)
      end if
   end function kind_named

   !> Whether the name of an element, in capitals, is that of a membrane: M3D3, M3D4, ... They are read as plane stress.
   pure logical function is_membrane(name)
      character(len=*), intent(in) :: name !< in capitals

      is_membrane = index(name, 'M3D') == 1
   end function is_membrane

   !> Place in KINDS of a shape in a plane state.
   pure integer(ip) function kind_of(shape, state)
      integer(ip), intent(in) :: shape, state !< place in SHAPES; place in STATES

      kind_of = findloc(KINDS%shape == shape .and. KINDS%state == PLAIN_STATE(state), .true., dim=1, kind=ip)
   end function kind_of

   !> Whether the strains of an element may have one dilatation, its mean (B-bar): four nodes without strain across the plane.
   !> In plane stress the thickness gives way and nothing locks; elements of the second degree hardly lock, and with reduced
   !> integration none does. The dilatation of three nodes is constant anyway.
   pure logical function can_average(shape, state)
      integer(ip), intent(in) :: shape, state !< place in SHAPES; place in STATES

      can_average = shape == 4 .and. .not. (STATES(state)%is_thin .or. IS_REDUCED(state))
   end function can_average

   !> Whether the strains of an element have one dilatation, the mean of the element (B-bar).
   pure logical function has_mean_dilatation(section, state, n_nodes)
      type(elastic_t), intent(in) :: section !< its formulation is read
      integer(ip), intent(in) :: state       !< place in STATES
      integer(ip), intent(in) :: n_nodes     !< of the element

      has_mean_dilatation = section%formulation == FORMULATION_BBAR .and. can_average(n_nodes, state)
   end function has_mean_dilatation

end module atrito_element_table
