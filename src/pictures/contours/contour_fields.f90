!> The fields of contour pictures: which there are, their values, and where the largest and the least are.
module atrito_contour_fields
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_plot_files, only: CONTOUR_PLOTS
   use atrito_plot_text, only: range_t, range_of, span
   use atrito_results, only: results_t, extreme_t
   implicit none (type, external)
   private
   public :: contour_t, field_t, places_t, contours_of, node_places, element_places, make_field

   integer, parameter :: DISPLACEMENT = 0, ERROR = -1   !< sources that are no row of the nodal stresses

   !> A field that has a picture.
   type :: contour_t
      character(len=20) :: name                     !< of the picture
      character(len=31) :: title                    !< in words
      character(len=5) :: symbol                    !< beside the bar
      character(len=5) :: dimension                 !< in F and L, or %
      integer :: source                             !< row of the nodal stresses, DISPLACEMENT or ERROR
      logical :: is_signed                          !< it may be positive and negative
      logical :: of_elements                        !< constant in each, not interpolated between nodes
   end type contour_t

   !> Nodes, or the middles of elements.
   type :: places_t
      real(wp), allocatable :: x(:, :)              !< (2, n) in the reference shape [L]
      real(wp), allocatable :: drawn(:, :)          !< (2, n) in the picture [L]
      logical, allocatable :: is_shown(:)           !< (n)
      integer(ip), allocatable :: id(:)             !< (n) the user's numbers
   end type places_t

   !> A field with its values, its range and its extremes.
   type :: field_t
      type(contour_t) :: contour                    !< which field it is
      real(wp), allocatable :: value(:)             !< at the nodes, or of the elements
      logical :: is_shown = .false.                 !< at a place at least; only then there are range and extremes
      type(range_t) :: range                        !< of what is shown
      type(extreme_t) :: extreme(2)                 !< the largest and the least of what is shown
      logical :: is_smooth(2) = .false.             !< the values round it are near it
      real(wp) :: drawn(2, 2) = 0.0_wp              !< and where in the picture [L]
   end type field_t

   type(contour_t), parameter :: &
      CONTOURS(6) = [contour_t(CONTOUR_PLOTS(1), 'Mises'' stress', 'mises', 'F/L^2', 5, .false., .false.), &
                     contour_t(CONTOUR_PLOTS(2), 'stress s11', 's11', 'F/L^2', 1, .true., .false.), &
                     contour_t(CONTOUR_PLOTS(3), 'stress s22', 's22', 'F/L^2', 2, .true., .false.), &
                     contour_t(CONTOUR_PLOTS(4), 'stress s12', 's12', 'F/L^2', 4, .true., .false.), &
                     contour_t(CONTOUR_PLOTS(5), 'displacement', '|u|', 'L', DISPLACEMENT, .false., .false.), &
                     contour_t(CONTOUR_PLOTS(6), 'error of the stresses', 'error', '%', ERROR, .false., .true.)]

   !> A stress whose largest is below this share of the largest of Mises' is none: what rounding left of it would be drawn.
   real(wp), parameter :: NO_STRESS = 1.0e-9_wp
   real(wp), parameter :: NEAR = 0.2_wp             !< of the range: a value that differs by less from those round it is smooth

contains

   !> The contours that can be drawn of results, in the order of CONTOUR_PLOTS; none where no displacement is a number.
   pure function contours_of(results) result(list)
      type(results_t), intent(in) :: results        !< last frame of the run
      type(contour_t), allocatable :: list(:)
      logical :: is_there(size(CONTOURS))

      is_there = .false.
      if (allocated(results%u)) is_there = any(ieee_is_finite(results%u))
      is_there = is_there .and. (CONTOURS%source <= DISPLACEMENT .or. allocated(results%nodal_stress)) &
                 .and. (CONTOURS%source /= ERROR .or. allocated(results%element_error))
      list = pack(CONTOURS, is_there)
   end function contours_of

   !> The nodes of elements; those that are no number, outside the window or in no element are not shown.
   pure subroutine node_places(mesh, u, scale, window, places)
      type(mesh_t), intent(in) :: mesh              !< as solved
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: scale                 !< of the displacements
      type(range_t), intent(in) :: window(2)        !< that is shown [L]
      type(places_t), intent(out) :: places         !< (n_nodes) all nodes
      integer(ip) :: e, i

      places%x = mesh%x
      places%id = mesh%node_id
      places%drawn = mesh%x + scale*u(:, :mesh%n_nodes)
      allocate (places%is_shown(mesh%n_nodes), source=.false.)
      do e = 1, mesh%n_elements
         places%is_shown(mesh%nodes(:mesh%shape(e), e)) = .true.
      end do
      do i = 1, mesh%n_nodes
         places%is_shown(i) = places%is_shown(i) .and. is_within(places%drawn(:, i), window)
      end do
   end subroutine node_places

   !> The middles of elements.
   pure subroutine element_places(mesh, u, scale, window, places)
      type(mesh_t), intent(in) :: mesh              !< as solved
      real(wp), intent(in) :: u(:, :), scale        !< (2, n_nodes) displacements [L], and their scale
      type(range_t), intent(in) :: window(2)        !< that is shown [L]
      type(places_t), intent(out) :: places         !< (n_elements) all elements
      integer(ip) :: e

      allocate (places%x(2, mesh%n_elements), places%drawn(2, mesh%n_elements), places%is_shown(mesh%n_elements))
      places%id = mesh%element_id
      do e = 1, mesh%n_elements
         associate (nodes => mesh%nodes(:mesh%shape(e), e))
            places%x(:, e) = sum(mesh%x(:, nodes), dim=2)/size(nodes)
            places%drawn(:, e) = places%x(:, e) + scale*sum(u(:, nodes), dim=2)/size(nodes)
         end associate
         places%is_shown(e) = is_within(places%drawn(:, e), window)
      end do
   end subroutine element_places

   !> Whether a place is a number within the window.
   pure logical function is_within(place, window)
      real(wp), intent(in) :: place(2)
      type(range_t), intent(in) :: window(2)

      is_within = all(ieee_is_finite(place))          ! comparing what is no number is an error
      if (is_within) is_within = all(place >= window%low .and. place <= window%high)
   end function is_within

   !> Values, range and extremes of a field.
   pure subroutine make_field(contour, results, mesh, nodes, elements, field)
      type(contour_t), intent(in) :: contour        !< one of contours_of
      type(results_t), intent(in) :: results        !< last frame of the run
      type(mesh_t), intent(in) :: mesh              !< as solved
      type(places_t), intent(in) :: nodes, elements !< by node_places and element_places
      type(field_t), intent(out) :: field           !< whole
      type(range_t) :: range, mises

      field%contour = contour
      select case (contour%source)
      case (DISPLACEMENT)
         field%value = hypot(results%u(1, :), results%u(2, :))
      case (ERROR)
         field%value = results%element_error
      case default
         field%value = results%nodal_stress(contour%source, :)
         range = range_of(field%value)
         mises = range_of(results%nodal_stress(5, :))
         if (range%low <= range%high .and. max(-range%low, range%high) <= NO_STRESS*mises%high) field%value = 0.0_wp
      end select
      if (contour%of_elements) then
         call find_extremes(elements, field)
      else
         call find_extremes(nodes, field, mesh)
      end if
   end subroutine make_field

   !> The largest and the least of what is shown.
   pure subroutine find_extremes(places, field, mesh)
      type(places_t), intent(in) :: places
      type(field_t), intent(inout) :: field
      type(mesh_t), intent(in), optional :: mesh    !< where the places are nodes
      integer(ip) :: i, k, at(2)

      at = 0
      do i = 1, size(field%value, kind=ip)
         if (.not. (places%is_shown(i) .and. ieee_is_finite(field%value(i)))) cycle
         if (at(1) == 0) at = i
         if (field%value(i) > field%value(at(1))) at(1) = i
         if (field%value(i) < field%value(at(2))) at(2) = i
      end do
      field%is_shown = at(1) > 0
      if (.not. field%is_shown) return
      field%range = range_t(field%value(at(2)), field%value(at(1)))
      do k = 1, 2
         field%extreme(k) = extreme_t(field%value(at(k)), places%id(at(k)), places%x(:, at(k)),.not. field%contour%of_elements)
         field%drawn(:, k) = places%drawn(:, at(k))
         if (present(mesh)) field%is_smooth(k) = is_near_others(mesh, field, at(k))
      end do
   end subroutine find_extremes

   !> Whether the value at a node differs little from the mean over the other nodes of its elements. At a corner without a limit it
   !> goes with a power of the distance, so that it differs much from those next to it, however fine the mesh is.
   pure logical function is_near_others(mesh, field, node) result(is_near)
      type(mesh_t), intent(in) :: mesh
      type(field_t), intent(in) :: field
      integer(ip), intent(in) :: node
      real(wp) :: total
      integer(ip) :: e, n

      total = 0.0_wp
      n = 0
      do e = 1, mesh%n_elements
         associate (nodes => mesh%nodes(:mesh%shape(e), e))
            if (all(nodes /= node)) cycle
            is_near = all(ieee_is_finite(field%value(nodes)))
            if (.not. is_near) return
            total = total + sum(field%value(nodes)) - field%value(node)
            n = n + size(nodes, kind=ip) - 1
         end associate
      end do
      is_near = abs(field%value(node) - total/max(1_ip, n)) <= NEAR*span(field%range)
   end function is_near_others

end module atrito_contour_fields
