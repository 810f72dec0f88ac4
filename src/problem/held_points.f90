!> Points at nodes that supports hold along or across the normal, as where a line of symmetry goes through a contact: there the
!> tangential row has no displacement, and on a curve that begins at the line the normal should be along it.
!>
!> The normal of a curved side is known there to the resolution of the faces or to the digits of the nodes, and may be slightly off
!> the direction d of the support. What d leaves of the row is then n - d (n . d), an error e, and a row e . u is held by forces as
!> large as the support's over e. So where the normal is off d by no more than it is in doubt, it becomes d, and the point has no
!> force of its own: the support takes it. Where it is as near to the direction across d it becomes that, and the tangential row has
!> no force; gap and weight are those that leave the displacement and the force along the new normal what they were.
!>
!> What such a point slips by is known: by the values of the supports and by how the nodes move that have no free displacement. Its
!> friction acts on the supports (contact_rows_t knows which of them holds a node). An equation of a node with such nodes alone,
!> as with the reference node of a rigid body that is moved, holds the node as a support does; it takes no pressure.
!>
!> Where a node of the slave faces one of the master, the mortar row of a curve has some 1e-4 on further nodes, which nothing holds:
!> that is an error as well, and does not count.
module atrito_held_points
   use atrito_assembly, only: fem_t
   use atrito_bilateral_rows, only: bilateral_rows_t, ROW_EQUATION, ROW_SUPPORT
   use atrito_kinds, only: ip, wp
   use atrito_points, only: contact_points_t
   implicit none (type, external)
   private
   public :: straighten_held_points

   real(wp), parameter :: SAME = 1.0e-12_wp       !< of two unit vectors
   real(wp), parameter :: LITTLE = 0.01_wp        !< coefficients in a row beside those of two nodes that face each other

contains

   !> Turns the normals of such points, and notes which rows are held. Along the new normal n' a gap that is s across the face is
   !> s/(n . n'), and a weight of w (n . n') leaves the same force along it. A gap that the deck gives stays.
   pure subroutine straighten_held_points(bilateral, gap_is_given, fem, points, holder)
      type(bilateral_rows_t), intent(in) :: bilateral !< with the supports along their own directions
      logical, intent(in) :: gap_is_given(:)          !< (pairs)
      type(fem_t), intent(in) :: fem                  !< bodies, mesh
      type(contact_points_t), intent(inout) :: points(:) !< one a pair: normal, gap, weight and held rows change
      integer(ip), allocatable, intent(out) :: holder(:) !< (n_nodes) bilateral row that holds the node; 0: none
      real(wp), allocatable :: support(:, :)         ! (2, n_nodes) along what a node is held; 0: not at all
      logical :: is_fixed(fem%mesh%n_nodes)          ! held along any direction
      real(wp) :: d(2), across(2), part
      integer(ip) :: i, j

      call list_supports(bilateral, fem, support, is_fixed, holder)
      do i = 1, size(points, kind=ip)
         if (.not. allocated(points(i)%doubt)) cycle
         allocate (points(i)%is_held(2, points(i)%n), source=.false.)
         do j = 1, points(i)%n
            associate (nodes => points(i)%entry(points(i)%first(j):points(i)%first(j + 1) - 1), n => points(i)%normal(:, j), &
                       row => points(i)%coefficient(points(i)%first(j):points(i)%first(j + 1) - 1), &
                       doubt => max(points(i)%doubt(j), SAME))
               associate (main => pack(nodes,.not. is_little(row)))
                  d = common_support(support(:, main), is_fixed(main))
               end associate
               if (.not. norm2(d) > 0.0_wp) cycle
               points(i)%is_held(2, j) = abs(dot_product(n, d)) <= doubt
               points(i)%is_held(1, j) = abs(n(1)*d(2) - n(2)*d(1)) <= doubt .and. .not. any(is_equation(holder(nodes)))
               if (.not. any(points(i)%is_held(:, j))) cycle
               call leave_little(row)
               across = [-d(2), d(1)]
               if (points(i)%is_held(1, j)) across = d
               part = abs(dot_product(n, across))
               if (.not. gap_is_given(i)) points(i)%gap(j) = points(i)%gap(j)/part ! of faces across the old normal
               points(i)%weight(j) = points(i)%weight(j)*part ! the same force along it
               n = sign(1.0_wp, dot_product(n, across))*across
            end associate
         end do
      end do

   contains

      elemental logical function is_equation(row)
         integer(ip), intent(in) :: row               !< of the bilateral ones; 0: none

         is_equation = .false.
         if (row > 0) is_equation = bilateral%kind(row) == ROW_EQUATION
      end function is_equation

   end subroutine straighten_held_points

   !> What a row has little of goes to the node of the master that it has most of.
   pure subroutine leave_little(row)
      real(wp), intent(inout) :: row(:)              !< coefficients
      integer(ip) :: most

      most = minloc(row, 1, kind=ip)
      row(most) = row(most) + sum(row, mask=is_little(row))
      where (is_little(row)) row = 0.0_wp
   end subroutine leave_little

   !> What is left of a row beside two nodes that face each other, where it is little in sum.
   pure function is_little(row)
      real(wp), intent(in) :: row(:)                 !< coefficients
      logical :: is_little(size(row))

      is_little = sum(abs(row)) - maxval(row) + minval(row) <= LITTLE
      is_little([maxloc(row), minloc(row)]) = .false.
   end function is_little

   !> The direction along which a node is held: an axis, where one of its dofs has no equation, or that of a support along one of
   !> its own, a bilateral row of this node alone, or of one equation whose other nodes have no free displacement. A node with both,
   !> or with no free dof, is held along any direction (is_fixed).
   pure subroutine list_supports(bilateral, fem, support, is_fixed, holder)
      type(bilateral_rows_t), intent(in) :: bilateral !< with the supports along their own directions
      type(fem_t), intent(in) :: fem
      real(wp), allocatable, intent(out) :: support(:, :)  !< (2, n_nodes) unit vectors; 0: not held
      logical, intent(out) :: is_fixed(:)            !< (n_nodes)
      integer(ip), allocatable, intent(out) :: holder(:) !< (n_nodes) bilateral row; 0: none
      integer(ip) :: uses(fem%mesh%n_nodes), node, j, k

      allocate (support(2, fem%mesh%n_nodes), source=0.0_wp)
      allocate (holder(fem%mesh%n_nodes), source=0_ip)
      associate (equation => fem%bodies%equation)
         do node = 1, fem%mesh%n_nodes
            is_fixed(node) = all(equation(:, node) == 0)
            if (is_fixed(node)) cycle
            where (equation(:, node) == 0) support(:, node) = 1.0_wp
         end do
      end associate
      do j = 1, bilateral%n
         if (bilateral%kind(j) /= ROW_SUPPORT .or. bilateral%first(j + 1) - bilateral%first(j) /= 1) cycle
         associate (at => bilateral%node(bilateral%first(j)), vector => bilateral%vector(:, bilateral%first(j)))
            is_fixed(at) = is_fixed(at) .or. norm2(support(:, at)) > 0.0_wp
            support(:, at) = vector/norm2(vector)
            holder(at) = j
         end associate
      end do
      if (bilateral%n == 0) return
      uses = 0
      do k = 1, bilateral%first(bilateral%n + 1) - 1
         uses(bilateral%node(k)) = uses(bilateral%node(k)) + 1
      end do
      do j = 1, bilateral%n
         k = only_free_entry(bilateral, fem, j)
         if (bilateral%kind(j) /= ROW_EQUATION .or. k == 0) cycle
         associate (at => bilateral%node(k), vector => bilateral%vector(:, k))
            if (norm2(support(:, at)) > 0.0_wp .or. uses(at) > 1) cycle ! it may be held along both
            support(:, at) = vector/norm2(vector)
            holder(at) = j
         end associate
      end do
   end subroutine list_supports

   !> The entry of a bilateral row whose node is free, where all others have no free displacement along theirs; 0: there are more,
   !> or one of its dofs is held.
   pure integer(ip) function only_free_entry(bilateral, fem, j) result(entry)
      type(bilateral_rows_t), intent(in) :: bilateral
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: j                   !< row
      integer(ip) :: k

      entry = 0
      do k = bilateral%first(j), bilateral%first(j + 1) - 1
         associate (is_free => fem%bodies%equation(:, bilateral%node(k)) /= 0)
            if (.not. any(is_free .and. abs(bilateral%vector(:, k)) > 0.0_wp)) cycle
            if (entry > 0 .or. .not. all(is_free)) then
               entry = 0
               return
            end if
            entry = k
         end associate
      end do
   end function only_free_entry

   !> The direction d along which all nodes of a row are held; 0 where there is none, where two of them are held along
   !> different ones (the cross product is more than round-off), or all are held along any: such a row has no unknown.
   pure function common_support(support, is_fixed) result(d)
      real(wp), intent(in) :: support(:, :)          !< (2, nodes of the row) along what each is held; 0: not at all
      logical, intent(in) :: is_fixed(:)             !< (nodes of the row) held along any direction
      real(wp) :: d(2)
      integer(ip) :: k

      d = 0.0_wp
      k = findloc(is_fixed, .false., dim=1, kind=ip)
      if (k == 0) return
      d = support(:, k)
      do k = 1, size(is_fixed, kind=ip)
         if (is_fixed(k)) cycle
         if (abs(d(1)*support(2, k) - d(2)*support(1, k)) > SAME .or. .not. norm2(support(:, k)) > 0.0_wp) d = 0.0_wp
      end do
   end function common_support

end module atrito_held_points
