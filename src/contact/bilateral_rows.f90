!> Rows that hold whatever the sign of their force: ties, equations, supports along any direction, springs,
!> pre-tension sections, nodes of rigid bodies.
!>
!> Row j asks for
!>
!>     sum_k v_k . u(node(k)) = value(j) + compliance(j) q_j,     k = first(j) .. first(j + 1) - 1,   v_k = vector(:, k),
!>
!> with a force q_j of any sign, which takes v_k q_j from the loads of node(k). A tie has the slave's node with a unit
!> vector and the master's with minus their shape functions; an equation has the coefficients of the deck; a support
!> along d has v = d and the prescribed displacement as its value; a spring of stiffness k has the compliance 1/k, all
!> others 0; a pre-tension section and a rigid body have rows that tie nodes to a reference node. For the solver these
!> are normal rows of contact without the bound q >= 0: see atrito_contact_line.
module atrito_bilateral_rows
   use atrito_growth, only: resize
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: bilateral_rows_t, begin_rows, add_row, trim_rows
   public :: ROW_SUPPORT, ROW_EQUATION, ROW_TIE, ROW_SPRING, ROW_SECTION, ROW_RIGID, ROW_KIND_NAME

   integer(ip), parameter :: ROW_SUPPORT = 1, ROW_EQUATION = 2, ROW_TIE = 3, ROW_SPRING = 4, ROW_SECTION = 5, ROW_RIGID = 6
   character(len=10), parameter :: ROW_KIND_NAME(6) = [character(len=10) :: 'support', 'equation', 'tie', 'spring', 'section', &
                                                                                                                       'rigid body']

   type :: bilateral_rows_t
      integer(ip) :: n = 0                           !< rows
      integer(ip), allocatable :: first(:)           !< (n + 1)
      integer(ip), allocatable :: node(:)            !< (entries) number in the mesh, or of a reference node
      real(wp), allocatable :: vector(:, :)          !< (2, entries); none is 0
      real(wp), allocatable :: value(:)              !< (n) right-hand side [L]
      real(wp), allocatable :: compliance(:)         !< (n) 1/k of springs [L/F]
      real(wp), allocatable :: weight(:)             !< (n) what shared forces are divided by [L^2]
      integer(ip), allocatable :: kind(:)            !< (n) ROW_*
      integer(ip), allocatable :: group(:)           !< (n) ascending from 1: rows that are judged by each other's forces
      integer(ip), allocatable :: part(:)            !< (n) place in the model's list of ties, equations, supports or springs
      integer(ip) :: n_groups = 0                    !< the largest of group
   end type bilateral_rows_t

contains

   !> No rows, with room for some.
   pure subroutine begin_rows(rows)
      type(bilateral_rows_t), intent(out) :: rows !< none, with room for some
      integer(ip), parameter :: SOME = 16_ip

      allocate (rows%vector(2, 0))
      call set_room(0_ip, SOME, 0_ip, SOME, rows)
      rows%first(1) = 1
   end subroutine begin_rows

   !> Appends a row, sum_k vectors(:, k) . u(nodes(k)) = value + compliance q; entries of one node are added up, and
   !> those that are 0 are left out. weight: what shared forces are divided by; identity: kind of row, group of rows
   !> that are judged together, place in the model's list.
   pure subroutine add_row(nodes, vectors, value, compliance, weight, identity, rows)
      integer(ip), intent(in) :: nodes(:)            !< (entries) a node may come twice
      real(wp), intent(in) :: vectors(:, :)          !< (2, entries)
      real(wp), intent(in) :: value, compliance, weight !< [L], [L/F], [L^2]
      integer(ip), intent(in) :: identity(3)         !< kind, group, part
      type(bilateral_rows_t), intent(inout) :: rows  !< with a row more
      type(id_map_t) :: entry_of                     ! of each node, counted from the row's first
      integer(ip) :: k, at, last
      logical :: known

      last = rows%first(rows%n + 1) - 1
      if (rows%n == size(rows%value) .or. last + size(nodes) > size(rows%node)) then
         call set_room(rows%n, 2*(rows%n + 1_ip), last, 2*(last + size(nodes, kind=ip)), rows)
      end if
      rows%n = rows%n + 1
      do k = 1, size(nodes, kind=ip)
         if (all(vectors(:, k) == 0.0_wp)) cycle
         at = find_id(entry_of, nodes(k)) + rows%first(rows%n) - 1
         if (at < rows%first(rows%n)) then
            last = last + 1
            call add_id(entry_of, nodes(k), last - rows%first(rows%n) + 1, known)
            at = last
            rows%node(at) = nodes(k)
            rows%vector(:, at) = 0.0_wp
         end if
         rows%vector(:, at) = rows%vector(:, at) + vectors(:, k)
      end do
      rows%first(rows%n + 1) = last + 1
      rows%value(rows%n) = value
      rows%compliance(rows%n) = compliance
      rows%weight(rows%n) = weight
      rows%kind(rows%n) = identity(1)
      rows%group(rows%n) = identity(2)
      rows%part(rows%n) = identity(3)
      rows%n_groups = max(rows%n_groups, identity(2))
   end subroutine add_row

   !> Gives back what was allocated for more rows and entries.
   pure subroutine trim_rows(rows)
      type(bilateral_rows_t), intent(inout) :: rows !< room behind the last row is given back

      associate (n => rows%n, entries => rows%first(rows%n + 1) - 1)
         call set_room(n, n, entries, entries, rows)
      end associate
   end subroutine trim_rows

   !> Room for `most` rows and `most_entries` entries; the n rows and their entries stay. Rooms that double keep the
   !> time of n rows at some n copies.
   pure subroutine set_room(n, most, entries, most_entries, rows)
      integer(ip), intent(in) :: n, most, entries, most_entries
      type(bilateral_rows_t), intent(inout) :: rows

      call resize(rows%first, n + 1_ip, most + 1_ip)
      call resize(rows%value, n, most)
      call resize(rows%compliance, n, most)
      call resize(rows%weight, n, most)
      call resize(rows%kind, n, most)
      call resize(rows%group, n, most)
      call resize(rows%part, n, most)
      call resize(rows%node, entries, most_entries)
      call resize(rows%vector, entries, most_entries)
   end subroutine set_room

end module atrito_bilateral_rows
