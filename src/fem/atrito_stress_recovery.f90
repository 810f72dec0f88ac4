!> Continuous stresses by superconvergent patch recovery (O. C. Zienkiewicz and J. Z. Zhu, Int. J. Numer. Methods Eng. 33, 1992).
!>
!> A polynomial of the elements' degree p is fitted to the stresses at their best points (Q1: the centre; Q2: 2 x 2 Gauss points)
!> round every corner node inside a zone; nodes on the outline of the zone take their values from the patches inside. Where there
!> is none at hand, the patch of an outer node takes all Gauss points of two elements or more, and an element without neighbours
!> its best points and degree p - 1.
module atrito_stress_recovery
   use atrito_assembly, only: fem_t
   use atrito_elasticity, only: stress_33, von_mises
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: Q1_NODES, Q2_NODES
   use atrito_patch_fit, only: patch_fit_t, COMPONENTS, begin_fit, clear_fit, add_sample, solve_fit, fitted_value
   use atrito_patches, only: patches_t, build_patches, PATCH_NONE, PATCH_OUTER, PATCH_SINGLE
   use atrito_point_stress, only: point_rule_t, element_data_t, point_values_t, make_point_rule, fetch_element, point_stresses
   use atrito_shape_functions, only: gauss_count
   implicit none (type, external)
   private
   public :: stress_field_t, recover_stress_field, nodal_stresses

   !> A stress field that is continuous in every zone: values at places, interpolated by the shape functions of the elements.
   type :: stress_field_t
      integer(ip) :: n = 0                         !< places
      integer(ip), allocatable :: node(:)          !< (n) node of a place
      integer(ip), allocatable :: element(:)       !< (n) an element that the place belongs to
      integer(ip), allocatable :: place(:, :)      !< (Q2_NODES, n_elements): places of an element's nodes
      real(wp), allocatable :: stress(:, :)        !< (COMPONENTS, n) [F/L^2]
   end type stress_field_t

   !> The rules of one kind of element.
   type :: sampling_t
      type(point_rule_t) :: best, all              !< superconvergent points; Gauss points of the stiffness
   end type sampling_t

   !> What a recovery works with.
   type :: recovery_t
      type(sampling_t) :: sampling(2)              !< of Q1, of Q2
      type(patches_t) :: patches
      real(wp), allocatable :: x(:, :, :)          !< best points less the element's first node [L], (2, points, n_elements)
      real(wp), allocatable :: s(:, :, :)          !< stresses there [F/L^2], (COMPONENTS, points, n_elements)
      integer(ip), allocatable :: rank(:), count(:) !< of each place: rank of the values taken (RANK_OF), and how many
   end type recovery_t

   !> How good the patch of a corner is for a node of the element: 1 the node's own, or that of its edge or its element; then the
   !> corners next to it along an edge; then across the element. Only the best rank at hand is taken. (corner, node)
   integer(ip), parameter :: RANK_OF(Q1_NODES, Q2_NODES) = reshape([1, 2, 3, 2, 2, 1, 2, 3, 3, 2, 1, 2, 2, 3, 2, 1, &
                                                                    1, 1, 2, 2, 2, 1, 1, 2, 2, 2, 1, 1, 1, 2, 2, 1, &
                                                                    1, 1, 1, 1], [4, 9])
   integer(ip), parameter :: RANK_NONE = 4

contains

   !> Recovers the stresses of a displacement field.
   subroutine recover_stress_field(fem, u, field)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)              !< (2, n_nodes) [L]
      type(stress_field_t), intent(out) :: field
      type(recovery_t) :: work
      type(patch_fit_t) :: fit
      integer(ip) :: i

      call begin_recovery(fem, u, work)
      field%n = work%patches%n
      allocate (field%stress(COMPONENTS, field%n), source=0.0_wp)
      do i = 1, field%n
         if (work%patches%kind(i) == PATCH_NONE) cycle
         call fit_patch(fem, u, i, work, fit)
         call spread_patch(fem, i, fit, work, field%stress)
      end do
      do i = 1, field%n
         field%stress(:, i) = field%stress(:, i)/real(work%count(i), wp)
      end do
      call move_alloc(work%patches%place, field%place)
      call move_alloc(work%patches%node, field%node)
      call name_elements(fem, field)
   end subroutine recover_stress_field

   !> Patches, rules, and the stresses at the best points of all elements.
   subroutine begin_recovery(fem, u, work)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      type(recovery_t), intent(out) :: work
      type(element_data_t) :: data
      type(point_values_t) :: at
      integer(ip) :: e, k

      call build_patches(fem, work%patches)
      allocate (work%rank(work%patches%n), source=RANK_NONE)
      allocate (work%count(work%patches%n), source=0_ip)
      call make_sampling(Q1_NODES, work%sampling(1))
      call make_sampling(Q2_NODES, work%sampling(2))
      k = work%sampling(kind_of(maxval([fem%mesh%shape, Q1_NODES])))%best%n
      allocate (work%x(2, k, fem%mesh%n_elements), work%s(COMPONENTS, k, fem%mesh%n_elements))
      do e = 1, fem%mesh%n_elements
         call fetch_element(fem, e, u, data)
         associate (rule => work%sampling(kind_of(data%n))%best)
            call point_stresses(data, rule, at)
            work%s(:, :rule%n, e) = transpose(at%s(:rule%n, :))
            work%x(:, :rule%n, e) = transpose(at%x(:rule%n, :))
         end associate
      end do
   end subroutine begin_recovery

   pure subroutine make_sampling(n_nodes, sampling)
      integer(ip), intent(in) :: n_nodes
      type(sampling_t), intent(out) :: sampling

      call make_point_rule(n_nodes, gauss_count(n_nodes) - 1, sampling%best)
      call make_point_rule(n_nodes, gauss_count(n_nodes), sampling%all)
   end subroutine make_sampling

   !> Kind of an element, which is the degree of its polynomials too: 1 for Q1, 2 for Q2.
   pure integer(ip) function kind_of(n_nodes)
      integer(ip), intent(in) :: n_nodes

      kind_of = merge(1_ip, 2_ip, n_nodes == Q1_NODES)
   end function kind_of

   !> The polynomial of a patch. When its samples do not determine it, all Gauss points and lower degrees are tried.
   pure subroutine fit_patch(fem, u, i, work, fit)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: i                 !< place of the patch
      type(recovery_t), intent(in) :: work
      type(patch_fit_t), intent(inout) :: fit
      integer(ip) :: degree, k
      logical :: determined

      associate (patches => work%patches)
         call lay_coordinates(fem, i, patches, fit)
         degree = kind_of(fem%mesh%shape(patches%element(patches%first(i))))
         determined = .false.
         if (patches%kind(i) /= PATCH_OUTER) then
            do k = patches%first(i), patches%first(i + 1) - 1
               call add_best_points(fem, i, patches%element(k), degree, work, fit)
            end do
            call solve_fit(merge(degree - 1, degree, patches%kind(i) == PATCH_SINGLE), fit, determined)
         end if
         if (determined) return
         call clear_fit(fit)
         do k = patches%first(i), patches%first(i + 1) - 1
            call add_all_points(fem, u, i, patches%element(k), degree, work, fit)
         end do
      end associate
      do k = degree, 0, -1
         call solve_fit(k, fit, determined)
         if (determined) return
      end do
   end subroutine fit_patch

   pure subroutine lay_coordinates(fem, i, patches, fit)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i
      type(patches_t), intent(in) :: patches
      type(patch_fit_t), intent(inout) :: fit
      integer(ip), parameter :: ENOUGH = 16        !< elements round a node; more give no better coordinates
      real(wp) :: corners(2, Q1_NODES*ENOUGH)
      integer(ip) :: j, k, n

      n = 0
      do j = patches%first(i), min(patches%first(i + 1), patches%first(i) + ENOUGH) - 1
         do k = 1, Q1_NODES
            n = n + 1
            corners(:, n) = from_patch(fem, patches, i, fem%mesh%nodes(k, patches%element(j)))
         end do
      end do
      call begin_fit(corners(:, :n), fit)
   end subroutine lay_coordinates

   !> A node less the node of a patch [L].
   pure function from_patch(fem, patches, i, node) result(x)
      type(fem_t), intent(in) :: fem
      type(patches_t), intent(in) :: patches
      integer(ip), intent(in) :: i, node
      real(wp) :: x(2)

      x = fem%mesh%x(:, node) - fem%mesh%x(:, patches%node(i))
   end function from_patch

   pure subroutine add_best_points(fem, i, e, degree, work, fit)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i, e, degree
      type(recovery_t), intent(in) :: work
      type(patch_fit_t), intent(inout) :: fit
      real(wp) :: first(2)
      integer(ip) :: point

      first = from_patch(fem, work%patches, i, fem%mesh%nodes(1, e))
      do point = 1, work%sampling(degree)%best%n
         call add_sample(first + work%x(:, point, e), work%s(:, point, e), degree, fit)
      end do
   end subroutine add_best_points

   pure subroutine add_all_points(fem, u, i, e, degree, work, fit)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: i, e, degree
      type(recovery_t), intent(in) :: work
      type(patch_fit_t), intent(inout) :: fit
      type(element_data_t) :: data
      type(point_values_t) :: at
      real(wp) :: first(2)
      integer(ip) :: point

      call fetch_element(fem, e, u, data)
      first = from_patch(fem, work%patches, i, fem%mesh%nodes(1, e))
      associate (rule => work%sampling(degree)%all)
         call point_stresses(data, rule, at)
         do point = 1, rule%n
            call add_sample(first + at%x(point, :), at%s(point, :), degree, fit)
         end do
      end associate
   end subroutine add_all_points

   !> Hands the values of a patch's polynomial to the nodes of its elements that have none of a better rank.
   pure subroutine spread_patch(fem, i, fit, work, stress)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i
      type(patch_fit_t), intent(in) :: fit
      type(recovery_t), intent(inout) :: work
      real(wp), intent(inout) :: stress(:, :)      !< sums
      integer(ip) :: j, k, e, at, rank

      do j = work%patches%first(i), work%patches%first(i + 1) - 1
         e = work%patches%element(j)
         do k = 1, fem%mesh%shape(e)
            at = work%patches%place(k, e)
            rank = RANK_OF(work%patches%corner(j), k)
            if (rank > work%rank(at) .or. (k <= Q1_NODES .and. rank > 1 .and. work%patches%kind(at) /= PATCH_NONE)) cycle
            if (rank < work%rank(at)) then
               work%rank(at) = rank
               work%count(at) = 0
               stress(:, at) = 0.0_wp
            end if
            work%count(at) = work%count(at) + 1
            stress(:, at) = stress(:, at) + fitted_value(from_patch(fem, work%patches, i, fem%mesh%nodes(k, e)), fit)
         end do
      end do
   end subroutine spread_patch

   pure subroutine name_elements(fem, field)
      type(fem_t), intent(in) :: fem
      type(stress_field_t), intent(inout) :: field
      integer(ip) :: e

      allocate (field%element(field%n))
      do e = 1, fem%mesh%n_elements
         field%element(field%place(:fem%mesh%shape(e), e)) = e
      end do
   end subroutine name_elements

   !> s11 s22 s33 s12 mises at the nodes: the mean of the zones that meet there, and Mises' stress of that mean. 0 at nodes in no
   !> element.
   pure subroutine nodal_stresses(fem, field, stress)
      type(fem_t), intent(in) :: fem
      type(stress_field_t), intent(in) :: field
      real(wp), allocatable, intent(out) :: stress(:, :)  !< (5, n_nodes) [F/L^2]
      integer(ip) :: zones(fem%mesh%n_nodes)
      integer(ip) :: i, e, node

      allocate (stress(5, fem%mesh%n_nodes), source=0.0_wp)
      zones = 0
      do i = 1, field%n
         e = field%element(i)
         node = field%node(i)
         zones(node) = zones(node) + 1
         associate (s => field%stress(:, i))
            stress(1:2, node) = stress(1:2, node) + s(1:2)
            stress(3, node) = stress(3, node) + stress_33(fem%sections(fem%section_of(e)), fem%mesh%state(e), s)
            stress(4, node) = stress(4, node) + s(3)
         end associate
      end do
      do node = 1, fem%mesh%n_nodes
         if (zones(node) == 0) cycle
         stress(:4, node) = stress(:4, node)/real(zones(node), wp)
         stress(5, node) = von_mises(stress([1, 2, 4], node), stress(3, node))
      end do
   end subroutine nodal_stresses

end module atrito_stress_recovery
