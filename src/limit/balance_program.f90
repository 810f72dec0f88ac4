!> The linear programme of the balance of some bodies: forces that the contact can take, and what they leave unbalanced.
!>
!>     minimise sum_i y_i   with   |(h - G' q)_i| = y_i S_i,   q_n >= 0,   |q_t,j| <= w_j nu_j sum_k W_jk p_k,   p_k = q_n,k/w_k
!>
!> S_i are the sizes of the forces on the motions. The duals of the equations are S_i v_i, v being a motion of at most 1/S_i on
!> which the loads work more than any such forces, by the least sum (docs/theory/formulation.md, section 10). With least_largest
!> the largest y_i takes the place of the sum; then sum |S_i v_i| is one, and v is as simple as such a motion can be.
!>
!> A bilateral row has two columns, one for either sign. A point whose friction depends on its own pressure alone has two columns,
!> the edges of its cone; others have one for the pressure, two for the friction, and a row for the bound. Columns are scaled to a
!> largest entry of one.
!>
!> A block on a slope, two points j = 1, 2 with friction of their own pressures, three motions i of the block (two translations, a
!> rotation): three rows, four columns of forces, six of remainders y+_i, y-_i that cost one each. The column of an edge is
!>
!>     (N_j + s nu T_j)/S,   s = -1 or 1:     x of it is the normal force, s nu x the friction
!>
!> so every force within the cone of a point is one sum of its two edges with x >= 0, and no row says |q_t| <= nu q_n. With nu below
!> the tangent of the slope no such forces have the sum of the weight; the least sum of remainders is what is missing along the
!> slope, and the duals of the three rows are the sliding motion.
module atrito_balance_program
   use atrito_contact_line, only: contact_line_t, pressure_of
   use atrito_growth, only: resize
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_linear_program, only: linear_program_t
   use atrito_motion_rows, only: motion_rows_t
   implicit none (type, external)
   private
   public :: balance_program_t, build_balance_program, forces_of_columns

   type :: balance_program_t
      type(linear_program_t) :: program          !< rows and columns scaled as said above
      integer(ip) :: n_motions = 0               !< rows that are equations of balance: the first ones
      integer(ip), allocatable :: motion(:)      !< (n_motions) of each
      real(wp), allocatable :: size(:)           !< (n_motions) S [F]
      integer(ip) :: n_forces = 0                !< columns that are forces: the first ones
      integer(ip), allocatable :: force(:, :)    !< (2, n_forces) the unknowns of a column; 0: none
      real(wp), allocatable :: share(:, :)       !< (2, n_forces) what they are at x = 1 [F]
   end type balance_program_t

   !> What is added to while the programme grows, column by column.
   type :: columns_t
      integer(ip) :: n = 0                                      !< columns so far
      integer(ip) :: n_entries = 0                              !< entries so far
      integer(ip), allocatable :: first(:), row(:), force(:, :) !< by columns as in linear_program_t; (2, columns) as force
      real(wp), allocatable :: entry(:), cost(:), share(:, :)   !< of each entry; (columns); (2, columns) as share
   end type columns_t

   !> How the points take part.
   type :: point_kinds_t
      logical, allocatable :: rubs(:)            !< it has friction that works on a motion of the programme
      logical, allocatable :: is_cone(:)         !< its friction depends on its own unknown pressure, and no other friction on that
      integer(ip), allocatable :: bound(:)       !< row of its friction bound; 0: none
      real(wp), allocatable :: known(:)          !< part of sum_k W_jk p_k that is known [F/L^2]
      real(wp), allocatable :: bound_scale(:)    !< of that row [F]
   end type point_kinds_t

contains

   !> The programme of the motions with a row, and of the points that touch them.
   !>
   !>     columns                         entries in the balance         in bounds of friction       cost
   !>     friction with a bound, twice    T_j/S and -T_j/S               1                           0
   !>     bilateral row, twice            N_j/S and -N_j/S               none                        0
   !>     edges of a cone, two            (N_j +- nu T_j)/S              none                        0
   !>     other pressures                 N_k/S                          -w_j nu_j W_jk/w_k          0
   !>     remainders of a motion, two     1 and -1                       none                        1
   !>
   !>     rows       balance = h/S,   friction of point j of either sign <= w_j nu_j (what known pressures give)
   !>
   !> A point with friction of its own pressure alone is a cone, and needs no row: in walls with local friction all points are.
   !> With least_largest a row y+ + y- <= z for each motion is added, and z has the cost in the place of the remainders.
   subroutine build_balance_program(rows, line, wanted, row_of_motion, scale, least_largest, balance)
      type(motion_rows_t), intent(in) :: rows         !< G, and the work of the loads on each motion
      type(contact_line_t), intent(in) :: line        !< points, weights, laws and averages are read
      logical, intent(in) :: wanted(:)                !< (line%n) points that take part
      integer(ip), intent(in) :: row_of_motion(:)     !< (k) 1, 2, ... in the order of the motions; 0: takes no part
      real(wp), intent(in) :: scale(:)                !< (k) S [F], > 0 where there is a row
      logical, intent(in) :: least_largest            !< the largest y_i is made least, not their sum
      type(balance_program_t), intent(out) :: balance !< the programme, and what its rows and columns mean
      integer(ip), parameter :: SOME = 64_ip          !< columns and entries to begin with
      type(point_kinds_t) :: kinds
      type(columns_t) :: columns
      integer(ip) :: i

      balance%motion = pack([(i, i=1, rows%n_columns)], row_of_motion > 0)
      balance%n_motions = size(balance%motion, kind=ip)
      balance%size = scale(balance%motion)
      call sort_points(rows, line, wanted, row_of_motion, balance%n_motions, kinds)
      allocate (columns%first(SOME + 1), columns%row(SOME), columns%force(2, SOME))
      allocate (columns%entry(SOME), columns%cost(SOME), columns%share(2, SOME))
      columns%first(1) = 1
      call add_contact_columns(rows, line, wanted, row_of_motion, scale, kinds, columns)
      balance%n_forces = columns%n
      balance%force = columns%force(:, :columns%n)
      balance%share = columns%share(:, :columns%n)
      call set_rows(balance)
      call add_remainders(balance%n_motions, maxval([0_ip, kinds%bound, balance%n_motions]), least_largest, columns)
      balance%program%n_columns = columns%n
      balance%program%first = columns%first(:columns%n + 1)
      balance%program%row = columns%row(:columns%n_entries)
      balance%program%entry = columns%entry(:columns%n_entries)
      allocate (balance%program%lower(columns%n), source=0.0_wp)
      allocate (balance%program%upper(columns%n), source=HUGE_REAL)
      balance%program%objective = columns%cost(:columns%n)

   contains

      !> Right-hand sides of the balance and of the friction bounds.
      pure subroutine set_rows(balance)
         type(balance_program_t), intent(inout) :: balance
         integer(ip) :: j, n

         n = maxval([0_ip, kinds%bound, balance%n_motions])
         associate (program => balance%program)
            program%n_rows = n
            if (least_largest) program%n_rows = n + balance%n_motions
            allocate (program%row_lower(program%n_rows), source=-HUGE_REAL)
            allocate (program%row_upper(program%n_rows), source=0.0_wp)
            program%row_upper(:balance%n_motions) = rows%work(balance%motion)/balance%size
            program%row_lower(:balance%n_motions) = program%row_upper(:balance%n_motions)
            do j = 1, line%n
               if (kinds%bound(j) == 0) cycle
               program%row_upper(kinds%bound(j)) = line%weight(j)*line%law(j)%nu*kinds%known(j)/kinds%bound_scale(j)
            end do
         end associate
      end subroutine set_rows

   end subroutine build_balance_program

   pure subroutine sort_points(rows, line, wanted, row_of_motion, n_motions, kinds)
      type(motion_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      logical, intent(in) :: wanted(:)
      integer(ip), intent(in) :: row_of_motion(:), n_motions
      type(point_kinds_t), intent(out) :: kinds
      real(wp) :: known(line%n), nothing(rows%n)
      integer(ip) :: j, e, n, users(line%n)

      nothing = 0.0_wp
      known = pressure_of(line, nothing)         ! of the points without an unknown
      allocate (kinds%rubs(line%n), kinds%is_cone(line%n), source=.false.)
      allocate (kinds%bound(line%n), source=0_ip)
      allocate (kinds%known(line%n), source=0.0_wp)
      allocate (kinds%bound_scale(line%n), source=1.0_wp)
      users = 0
      do j = 1, line%n
         if (.not. wanted(j) .or. line%tangential(j) == 0 .or. line%law(j)%nu <= 0.0_wp) cycle
         kinds%rubs(j) = works(rows, line%tangential(j), row_of_motion)
         if (.not. kinds%rubs(j)) cycle
         do e = line%average%first(j), line%average%first(j + 1) - 1
            associate (k => line%average%column(e))
               kinds%known(j) = kinds%known(j) + line%average%value(e)*known(k)
               if (line%average%value(e) > 0.0_wp) users(k) = users(k) + 1
            end associate
         end do
      end do
      n = n_motions
      do j = 1, line%n
         if (.not. kinds%rubs(j)) cycle
         associate (first => line%average%first(j), last => line%average%first(j + 1) - 1)
            kinds%is_cone(j) = line%normal(j) > 0 .and. users(j) == 1 .and. &
                               all(line%average%column(first:last) == j .or. line%average%value(first:last) <= 0.0_wp)
         end associate
         if (kinds%is_cone(j)) cycle
         n = n + 1
         kinds%bound(j) = n
      end do
   end subroutine sort_points

   pure logical function works(rows, i, row_of_motion)
      type(motion_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: i, row_of_motion(:)

      works = any(row_of_motion(rows%column(rows%first(i):rows%first(i + 1) - 1)) > 0)
   end function works

   !> The columns of all points, the friction first: it sets the scales of the rows of its bounds.
   subroutine add_contact_columns(rows, line, wanted, row_of_motion, scale, kinds, columns)
      type(motion_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      logical, intent(in) :: wanted(:)
      integer(ip), intent(in) :: row_of_motion(:)
      real(wp), intent(in) :: scale(:)
      type(point_kinds_t), intent(inout) :: kinds
      type(columns_t), intent(inout) :: columns
      real(wp), allocatable :: pressed(:)
      integer(ip), allocatable :: first(:), user(:)
      integer(ip) :: j, side

      do j = 1, line%n
         if (kinds%bound(j) == 0) cycle
         do side = -1, 1, 2
            call begin_column(columns, [line%tangential(j), 0_ip], [real(side, wp), 0.0_wp])
            call add_row(rows, line%tangential(j), real(side, wp), row_of_motion, scale, columns)
            call scale_column(columns)
            kinds%bound_scale(j) = abs(columns%share(1, columns%n))
            call add_entry(columns, kinds%bound(j), 1.0_wp)
         end do
      end do
      call list_users(line, kinds, first, user, pressed)
      do j = 1, line%n
         if (.not. wanted(j) .or. line%normal(j) == 0) cycle
         if (j > line%n - line%n_bilateral) then      ! a force of either sign
            if (.not. works(rows, line%normal(j), row_of_motion)) cycle
            do side = -1, 1, 2
               call begin_column(columns, [line%normal(j), 0_ip], [real(side, wp), 0.0_wp])
               call add_row(rows, line%normal(j), real(side, wp), row_of_motion, scale, columns)
               call scale_column(columns)
            end do
         else if (kinds%is_cone(j)) then
            call add_cone(columns)
         else if (works(rows, line%normal(j), row_of_motion) .or. first(j + 1) > first(j)) then
            associate (users => user(first(j):first(j + 1) - 1), added => pressed(first(j):first(j + 1) - 1))
               call add_pressure(line%normal(j), line%weight(j), kinds%bound(users), added/kinds%bound_scale(users), columns)
            end associate
         end if
      end do

   contains

      !> A pressure, with what it adds to friction bounds.
      pure subroutine add_pressure(i, weight, bounds, added, columns)
         integer(ip), intent(in) :: i               !< its unknown
         real(wp), intent(in) :: weight             !< [L^2]
         integer(ip), intent(in) :: bounds(:)       !< rows of the bounds
         real(wp), intent(in) :: added(:)           !< to each, by a pressure of one [F/L^2]
         type(columns_t), intent(inout) :: columns
         integer(ip) :: e

         call begin_column(columns, [i, 0_ip], [1.0_wp, 0.0_wp])
         call add_row(rows, i, 1.0_wp, row_of_motion, scale, columns)
         do e = 1, size(bounds, kind=ip)
            call add_entry(columns, bounds(e), -added(e)/weight)
         end do
         call scale_column(columns)
      end subroutine add_pressure

      !> The two edges of the cone of a point: a pressure with full friction along T and against it.
      pure subroutine add_cone(columns)
         type(columns_t), intent(inout) :: columns
         real(wp) :: friction
         integer(ip) :: e, side

         friction = 0.0_wp
         do e = line%average%first(j), line%average%first(j + 1) - 1
            if (line%average%column(e) == j) friction = friction + line%law(j)%nu*line%average%value(e)
         end do
         do side = -1, 1, 2
            call begin_column(columns, [line%normal(j), line%tangential(j)], [1.0_wp, side*friction])
            call add_row(rows, line%normal(j), 1.0_wp, row_of_motion, scale, columns)
            call add_row(rows, line%tangential(j), side*friction, row_of_motion, scale, columns)
            call scale_column(columns)
         end do
      end subroutine add_cone

   end subroutine add_contact_columns

   !> Whose friction bounds the pressure of a point adds to, and how much: the entries of W by columns.
   subroutine list_users(line, kinds, first, user, pressed)
      type(contact_line_t), intent(in) :: line
      type(point_kinds_t), intent(in) :: kinds
      integer(ip), allocatable, intent(out) :: first(:), user(:)
      real(wp), allocatable, intent(out) :: pressed(:) !< w_j nu_j W_jk [L^2]
      integer(ip) :: column(1, line%average%first(line%n + 1) - 1), row(size(column)), j
      integer(ip), allocatable :: entry(:)

      column = 0
      do j = 1, line%n
         associate (from => line%average%first(j), to => line%average%first(j + 1) - 1)
            row(from:to) = j
            if (kinds%bound(j) > 0) column(1, from:to) = line%average%column(from:to)
         end associate
      end do
      call list_holders(line%n, column, first, entry)
      user = row(entry)
      pressed = line%weight(user)*line%law(user)%nu*line%average%value(entry)
   end subroutine list_users

   !> The columns of what is left unbalanced, at a cost each, or below one column that alone has a cost.
   pure subroutine add_remainders(n_motions, n_rows, least_largest, columns)
      integer(ip), intent(in) :: n_motions
      integer(ip), intent(in) :: n_rows          !< without those of least_largest
      logical, intent(in) :: least_largest
      type(columns_t), intent(inout) :: columns
      integer(ip) :: i, side

      do i = 1, n_motions
         do side = -1, 1, 2
            call begin_column(columns, [0_ip, 0_ip], [0.0_wp, 0.0_wp])
            call add_entry(columns, i, real(side, wp))
            if (least_largest) then
               call add_entry(columns, n_rows + i, 1.0_wp)
            else
               columns%cost(columns%n) = 1.0_wp
            end if
         end do
      end do
      if (.not. least_largest) return
      call begin_column(columns, [0_ip, 0_ip], [0.0_wp, 0.0_wp])
      columns%cost(columns%n) = 1.0_wp
      do i = 1, n_motions
         call add_entry(columns, n_rows + i, -1.0_wp)
      end do
   end subroutine add_remainders

   !> One more column, without entries, from zero upwards, at no cost.
   pure subroutine begin_column(columns, force, share)
      type(columns_t), intent(inout) :: columns
      integer(ip), intent(in) :: force(2)
      real(wp), intent(in) :: share(2)

      associate (n => columns%n)
         if (n == size(columns%cost)) then
            call resize(columns%first, n + 1, 2*n + 1)
            call resize(columns%cost, n, 2*n)
            call resize(columns%force, n, 2*n)
            call resize(columns%share, n, 2*n)
         end if
      end associate
      columns%n = columns%n + 1
      columns%first(columns%n + 1) = columns%first(columns%n)
      columns%cost(columns%n) = 0.0_wp
      columns%force(:, columns%n) = force
      columns%share(:, columns%n) = share
   end subroutine begin_column

   !> Adds a multiple of a row of G, over the sizes of the motions, to the last column.
   pure subroutine add_row(rows, i, factor, row_of_motion, scale, columns)
      type(motion_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: factor
      integer(ip), intent(in) :: row_of_motion(:)
      real(wp), intent(in) :: scale(:)
      type(columns_t), intent(inout) :: columns
      integer(ip) :: e

      do e = rows%first(i), rows%first(i + 1) - 1
         if (row_of_motion(rows%column(e)) == 0) cycle
         call add_entry(columns, row_of_motion(rows%column(e)), factor*rows%value(e)/scale(rows%column(e)))
      end do
   end subroutine add_row

   !> Adds to an entry of the last column.
   pure subroutine add_entry(columns, row, value)
      type(columns_t), intent(inout) :: columns
      integer(ip), intent(in) :: row
      real(wp), intent(in) :: value
      integer(ip) :: e

      if (value == 0.0_wp) return
      do e = columns%first(columns%n), columns%n_entries
         if (columns%row(e) /= row) cycle
         columns%entry(e) = columns%entry(e) + value
         return
      end do
      if (columns%n_entries == size(columns%row)) then
         call resize(columns%row, columns%n_entries, 2*columns%n_entries)
         call resize(columns%entry, columns%n_entries, 2*columns%n_entries)
      end if
      columns%n_entries = columns%n_entries + 1
      columns%row(columns%n_entries) = row
      columns%entry(columns%n_entries) = value
      columns%first(columns%n + 1) = columns%n_entries + 1
   end subroutine add_entry

   !> Scales the last column to a largest entry of one, and its forces with it.
   pure subroutine scale_column(columns)
      type(columns_t), intent(inout) :: columns
      real(wp) :: largest

      associate (first => columns%first(columns%n), last => columns%n_entries)
         if (last < first) return
         largest = maxval(abs(columns%entry(first:last)))
         if (largest <= 0.0_wp) return
         columns%entry(first:last) = columns%entry(first:last)/largest
         columns%share(:, columns%n) = columns%share(:, columns%n)/largest
      end associate
   end subroutine scale_column

   !> Adds the forces of the columns to q.
   pure subroutine forces_of_columns(balance, x, q)
      type(balance_program_t), intent(in) :: balance !< built by build_balance_program
      real(wp), intent(in) :: x(:)                   !< (columns)
      real(wp), intent(inout) :: q(:)                !< (m) [F]
      integer(ip) :: j, s

      do j = 1, balance%n_forces
         do s = 1, 2
            if (balance%force(s, j) == 0) cycle
            associate (force => q(balance%force(s, j)))
               force = force + balance%share(s, j)*max(x(j), 0.0_wp)
            end associate
         end do
      end do
   end subroutine forces_of_columns

end module atrito_balance_program
