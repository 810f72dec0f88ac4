!> The certificate for every load (atrito_one_solution) without a matrix of the line: a sparse matrix whose pivots have the right
!> signs exactly where it is positive definite.
!>
!> For forces q that leave all bodies in balance, with the stiffness K of the bodies, B_n and B_t the rows of their displacements,
!> c = (alpha + 1)/2, b = (alpha - 1)/2 and mu = nu/(2 gamma), the form that is to be positive is
!>
!>     min over w, max over z of   -z'K z + 2 z'(c B_n'q_n + B_t'q_t) + w'(K - mu B_t'B_t) w + 2 b w'B_n'q_n
!>                                 + alpha q_n'D q_n - nu gamma/2 |W q_n|^2
!>
!> (docs/theory/uniqueness.md has the steps; q_t is here the tangential force and half of what -mu |A_t q|^2 = min over s of
!> |s|^2/(4 mu) + s'A_t q adds to it). So it is positive on the kernel of G' where the matrix of (z, w, q) bordered by G a has as
!> many negative eigenvalues as there are z and a, and positive ones for w and q (Sylvester). One elimination tells: that of the
!> scene, each of its parts cut in three, first z, then w and q, then a. Where a pivot has another sign nothing is proved. A part
!> that is eliminated is a scene of its own, held where it ends; that it is not worse than the whole, forces wait for the parts of
!> their neighbours, and pressures for those of all that a row of W joins.
module atrito_signed_scene
   use atrito_assembled_scene, only: collect_scene
   use atrito_assembly, only: fem_t
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_friction_form, only: bounds_of
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: create_variable_matrix, element_store_t, elimination_t, factor_variable_matrix, add_to_store, &
                                  set_variable_element, solve_variable_matrix, take_signs, variable_matrix_t
   use atrito_row_entries, only: build_constraint_rows
   use atrito_scene_elimination, only: eliminate_scene, number_scene, scene_numbering_t
   use atrito_sparse_rows, only: add_transposed, multiply_rows, sparse_rows_t
   use atrito_status, only: is_ok, status_t
   implicit none (type, external)
   private
   public :: signed_scene_t, build_signed_scene, factor_signed, multiply_compliance

   !> Unknowns: w, z, q, a.
   type :: signed_scene_t
      integer(ip) :: n = 0                        !< displacements
      integer(ip) :: n_normal = 0                 !< of the forces
      type(constraint_rows_t) :: rows             !< B, and G behind it
      type(sparse_rows_t) :: w                    !< W: a row a tangential force, over the normal ones
      real(wp), allocatable :: compliance(:)      !< (n_normal) D [L/F]
      integer(ip), allocatable :: first_bound(:)  !< rows of W are elements in groups: the first of each, and the end
      type(variable_matrix_t) :: matrix
      integer(lp), allocatable :: start(:)        !< unknowns of an element: unknown(start(v) + 1:start(v + 1)); rows, then groups
      integer(ip), allocatable :: unknown(:)
   end type signed_scene_t

   !> Of the springs that hold floating bodies (atrito_scene_elimination): a motion is alone with them until its balance comes, and
   !> has to be positive until then.
   real(wp), parameter :: SOFT = 1.0e-5_wp
   integer(ip), parameter :: FEW = 400            !< forces that all come last
   integer(ip), parameter :: NEIGHBOURS = 24      !< of a force of more, on either side

contains

   !> Sets up the matrix; nothing is factored. status: STATUS_INTERNAL when the memory does not suffice.
   subroutine build_signed_scene(fem, rows, line, signed, status)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(signed_scene_t), intent(out) :: signed
      type(status_t), intent(out) :: status
      type(scene_numbering_t) :: numbering
      type(elimination_t) :: elimination
      type(element_store_t) :: store
      integer(ip) :: i, n_all
      logical, allocatable :: negative(:)

      call number_scene(fem, numbering)
      call build_constraint_rows(fem, rows, line, .true., signed%rows)
      signed%n = numbering%n - numbering%k
      signed%n_normal = count(line%normal > 0, kind=ip)
      associate (n => signed%n, m => signed%rows%n, normal => signed%n_normal)
         n_all = 2*n + m + numbering%k
         signed%w = bounds_of(line, line%point(normal + 1:), normal)
         signed%compliance = line%delta(line%point(:normal))/line%weight(line%point(:normal))
         call list_elements(signed)
         elimination = eliminate_scene(fem, rows, line, numbering)
         call split_parts(signed, numbering%k, elimination)
         call collect_scene(fem, numbering, store)
         i = count(numbering%spring > 0, kind=ip)
         if (i > 0) then                          ! its elements are the last ones
            associate (first => store%matrix_start(store%matrix_of(store%n - i + 1)) + 1, &
                       last => store%matrix_start(store%n_matrices + 1))
               store%values(first:last) = SOFT*store%values(first:last)
            end associate
         end if
         call add_negative(n, store)
         do i = 1, numbering%k                    ! a motion that no row sees
            if (.not. any(signed%rows%column == n + i .and. abs(signed%rows%value) > 0.0_wp)) then
               call add_to_store(store, [2*n + m + i], reshape([-1.0_wp], [1, 1]))
            end if
         end do
         negative = [(i > n .and. i <= 2*n .or. i > 2*n + m, i=1, n_all)]
      end associate
      call create_variable_matrix(signed%matrix, n_all, elimination, store, signed%start, signed%unknown, status)
      if (is_ok(status)) call take_signs(signed%matrix, negative, status)
   end subroutine build_signed_scene

   !> The elements that change: a row with its force, z and w at its displacements and its motions; rows of W that follow each
   !> other, as many as have less than twice the points of one of them.
   subroutine list_elements(signed)
      type(signed_scene_t), intent(inout) :: signed
      integer(ip), allocatable :: columns(:), more(:)
      integer(ip) :: i, v, first, k, g

      associate (rows => signed%rows, w => signed%w, n => signed%n)
         allocate (signed%start(rows%n + w%n + 1), signed%first_bound(w%n + 1))
         signed%start(1) = 0
         allocate (signed%unknown(0))
         do v = 1, rows%n
            columns = rows%column(rows%first(v):rows%first(v + 1) - 1)
            call add_element([2*n + v, pack(columns, columns <= n), n + pack(columns, columns <= n), &
                              n + rows%n + pack(columns, columns > n)], v)
         end do
         g = 0
         first = 1
         do while (first <= w%n)
            g = g + 1
            signed%first_bound(g) = first
            columns = w%column(w%first(first):w%first(first + 1) - 1)
            do i = first + 1, w%n
               more = w%column(w%first(i):w%first(i + 1) - 1)
               more = [columns, pack(more, [(all(columns /= more(k)), k=1, size(more, kind=ip))])]
               if (size(more) >= 2*(w%first(first + 1) - w%first(first))) exit
               call move_alloc(more, columns)
            end do
            first = i
            call add_element(2*n + columns, rows%n + g)
         end do
         signed%first_bound(g + 1) = first
         signed%first_bound = signed%first_bound(:g + 1)
         signed%start = signed%start(:rows%n + g + 1)
         signed%unknown = signed%unknown(:signed%start(rows%n + g + 1))
      end associate

   contains

      subroutine add_element(unknowns, v)
         integer(ip), intent(in) :: unknowns(:), v

         associate (n => signed%start(v))
            if (n + size(unknowns) > size(signed%unknown)) signed%unknown = [signed%unknown, unknowns, 0*signed%unknown]
            signed%unknown(n + 1:n + size(unknowns)) = unknowns
            signed%start(v + 1) = n + size(unknowns)
         end associate
      end subroutine add_element

   end subroutine list_elements

   !> Each part of the elimination of the scene cut in three.
   subroutine split_parts(signed, k, elimination)
      type(signed_scene_t), intent(in) :: signed
      integer(ip), intent(in) :: k                !< motions
      type(elimination_t), intent(inout) :: elimination !< in: of displacements and motions; out: of all unknowns
      integer(ip), allocatable :: part(:), slot(:), last(:), parent(:), name(:)
      integer(ip) :: home(signed%rows%n), p, i, v, n_parts

      n_parts = size(elimination%last, kind=ip)
      associate (n => signed%n, m => signed%rows%n, up => elimination%parent)
         where (up == 0 .and. [(i < n_parts, i=1, n_parts)]) up = n_parts
         part = [(p_at(elimination%position(i)), i=1, n + k)]
         do i = 1, m                              ! a force goes with the last of its displacements
            associate (columns => signed%rows%column(signed%rows%first(i):signed%rows%first(i + 1) - 1))
               home(i) = maxval(part(columns))
               if (any(columns <= n)) home(i) = maxval(part(columns), mask=columns <= n)
            end associate
         end do
         call lift_forces(signed, up, home)
         do i = 1, m                              ! a balance behind its forces
            associate (columns => signed%rows%column(signed%rows%first(i):signed%rows%first(i + 1) - 1))
               where (columns > n) part(columns) = max(part(columns), home(i))
            end associate
         end do
         slot = [3*part(:n) - 1, 3*part(:n) - 2, 3*home - 1, 3*part(n + 1:)]
         allocate (last(3*n_parts), name(3*n_parts), source=0_ip)
         do i = 1, size(slot, kind=ip)
            last(slot(i)) = last(slot(i)) + 1
         end do
         v = 0
         do p = 1, 3*n_parts
            if (last(p) > 0) v = v + 1
            if (last(p) > 0) name(p) = v
            if (p > 1) last(p) = last(p) + last(p - 1)
         end do
         allocate (parent(v), source=0_ip)
         do p = 1, 3*n_parts
            if (name(p) > 0) parent(name(p)) = next_name(p)
         end do
         elimination%last = pack(last, name > 0)
         last = [0_ip, last(:3*n_parts - 1)]
         deallocate (elimination%position)
         allocate (elimination%position(size(slot)))
         do i = 1, size(slot, kind=ip)
            last(slot(i)) = last(slot(i)) + 1
            elimination%position(i) = last(slot(i))
         end do
      end associate
      call move_alloc(parent, elimination%parent)

   contains

      !> The part at a position.
      pure integer(ip) function p_at(position)
         integer(ip), intent(in) :: position
         integer(ip) :: low, high, middle

         low = 1
         high = n_parts
         do while (low < high)
            middle = (low + high)/2
            if (elimination%last(middle) >= position) then
               high = middle
            else
               low = middle + 1
            end if
         end do
         p_at = low
      end function p_at

      !> The next slot above that has unknowns.
      pure integer(ip) function next_name(slot)
         integer(ip), intent(in) :: slot
         integer(ip) :: at

         at = slot
         next_name = 0
         do while (next_name == 0)
            if (mod(at, 3_ip) == 0) then
               if (elimination%parent(at/3) == 0) return
               at = 3*elimination%parent(at/3) - 2
            else
               at = at + 1
            end if
            next_name = name(at)
         end do
      end function next_name

   end subroutine split_parts

   !> Forces wait for the part that all parts of their neighbours lead to, and pressures for that of all that a row of W joins.
   subroutine lift_forces(signed, parent, home)
      type(signed_scene_t), intent(in) :: signed
      integer(ip), intent(in) :: parent(:)        !< (parts) one alone has none, the last
      integer(ip), intent(inout) :: home(:)       !< (forces) their parts
      integer(ip) :: own(size(home)), g, i, top

      home = merge(size(parent, kind=ip), home, size(home) <= FEW)
      own = home
      do i = 1, size(home, kind=ip)
         associate (first => merge(1_ip, signed%n_normal + 1, i <= signed%n_normal), &
                    last => merge(signed%n_normal, size(home, kind=ip), i <= signed%n_normal))
            home(i) = common_part(own(max(first, i - NEIGHBOURS):min(last, i + NEIGHBOURS)))
         end associate
      end do
      own = home
      do g = signed%rows%n + 1, size(signed%start, kind=ip) - 1
         associate (forces => signed%unknown(signed%start(g) + 1:signed%start(g + 1)) - 2*signed%n)
            if (size(forces) == 0) cycle
            top = common_part(own(forces))
            home(forces) = max(home(forces), top)
         end associate
      end do

   contains

      !> The part that some parts lead to.
      pure integer(ip) function common_part(parts) result(part)
         integer(ip), intent(in) :: parts(:)
         integer(ip) :: i, other

         part = parts(1)
         do i = 2, size(parts, kind=ip)
            other = parts(i)
            do while (part /= other)
               if (part < other) then
                  part = parent(part)
               else
                  other = parent(other)
               end if
            end do
         end do
      end function common_part

   end subroutine lift_forces

   !> The elements of w, and those of z behind them: the same with the other sign.
   pure subroutine add_negative(n, store)
      integer(ip), intent(in) :: n
      type(element_store_t), intent(inout) :: store

      associate (e => (store%n), k => (store%n_matrices), entries => (store%start(store%n + 1)), &
                 last => (store%matrix_start(store%n_matrices + 1)))
         store%equations = [store%equations(:entries), merge(store%equations(:entries) + n, 0_ip, store%equations(:entries) > 0)]
         store%values = [store%values(:last), -store%values(:last)]
         store%matrix_of = [store%matrix_of(:e), store%matrix_of(:e) + k]
         store%matrix_start = [store%matrix_start(:k + 1), store%matrix_start(2:k + 1) + last]
         store%start = [store%start(:e + 1), store%start(2:e + 1) + entries]
      end associate
      store%n = 2*store%n
      store%n_matrices = 2*store%n_matrices
   end subroutine add_negative

   !> Factors the matrix for alpha, gamma and nu. is_definite: all signs are those of a form that is positive.
   subroutine factor_signed(signed, alpha, gamma, nu, is_definite)
      type(signed_scene_t), intent(inout) :: signed
      real(wp), intent(in) :: alpha, gamma, nu
      logical, intent(out) :: is_definite
      type(status_t) :: status
      real(wp), allocatable :: matrix(:, :), row(:)
      integer(ip) :: v, i, j, k, n, at

      do v = 1, size(signed%start, kind=ip) - 1
         n = int(signed%start(v + 1) - signed%start(v), ip)
         allocate (matrix(n, n), source=0.0_wp)
         if (v <= signed%rows%n) then
            call set_row()
         else
            associate (w => signed%w, unknowns => signed%unknown(signed%start(v) + 1:signed%start(v + 1)))
               allocate (row(n))
               do i = signed%first_bound(v - signed%rows%n), signed%first_bound(v - signed%rows%n + 1) - 1
                  row = 0.0_wp
                  do k = w%first(i), w%first(i + 1) - 1
                     at = findloc(unknowns, 2*signed%n + w%column(k), dim=1, kind=ip)
                     row(at) = row(at) + w%value(k)
                  end do
                  do j = 1, n
                     if (abs(row(j)) > 0.0_wp) matrix(:, j) = matrix(:, j) - row*(0.5_wp*nu*gamma*row(j))
                  end do
               end do
               deallocate (row)
            end associate
         end if
         call set_variable_element(signed%matrix, v, matrix)
         deallocate (matrix)
      end do
      call factor_variable_matrix(signed%matrix, status)
      is_definite = is_ok(status)

   contains

      !> q_v with z, w and a; of a tangential force -mu B'B on w.
      subroutine set_row()
         real(wp), allocatable :: b(:)
         integer(ip) :: n_u

         associate (rows => signed%rows)
            b = rows%value(rows%first(v):rows%first(v + 1) - 1)
            associate (is_motion => rows%column(rows%first(v):rows%first(v + 1) - 1) > signed%n)
               b = [pack(b,.not. is_motion), pack(b, is_motion)]
               n_u = count(.not. is_motion, kind=ip)
            end associate
         end associate
         if (v <= signed%n_normal) then
            matrix(1, 1) = alpha*signed%compliance(v)
            matrix(2:, 1) = [0.5_wp*(alpha - 1)*b(:n_u), 0.5_wp*(alpha + 1)*b(:n_u), b(n_u + 1:)]
         else
            matrix(2 + n_u:1 + 2*n_u, 1) = b(:n_u)
            matrix(2:1 + n_u, 2:1 + n_u) = -0.5_wp*nu/gamma*matmul(reshape(b(:n_u), [n_u, 1_ip]), reshape(b(:n_u), [1_ip, n_u]))
         end if
      end subroutine set_row

   end subroutine factor_signed

   !> What the factored form makes of y: with P for its matrix, (W q_n, B_t w) of the solution of P (w, z, q, a) =
   !> (B_t'y_t, 0, W'y_n, 0).
   subroutine multiply_compliance(signed, y_n, y_t, image_n, image_t)
      type(signed_scene_t), intent(in) :: signed  !< factored
      real(wp), intent(in) :: y_n(:), y_t(:)      !< (tangential forces)
      real(wp), intent(out) :: image_n(:), image_t(:)
      real(wp), allocatable :: x(:)
      integer(ip) :: i, k

      allocate (x(signed%matrix%n), source=0.0_wp)
      associate (n => signed%n, normal => signed%n_normal, rows => signed%rows)
         call add_transposed(signed%w, 1.0_wp, y_n, x(2*n + 1:2*n + normal))
         do i = 1, size(y_t, kind=ip)
            do k = rows%first(normal + i), rows%first(normal + i + 1) - 1
               if (rows%column(k) <= n) x(rows%column(k)) = x(rows%column(k)) + y_t(i)*rows%value(k)
            end do
         end do
         call solve_variable_matrix(signed%matrix, x)
         call multiply_rows(signed%w, x(2*n + 1:2*n + normal), image_n)
         image_t = 0.0_wp
         do i = 1, size(y_t, kind=ip)
            do k = rows%first(normal + i), rows%first(normal + i + 1) - 1
               if (rows%column(k) <= n) image_t(i) = image_t(i) + rows%value(k)*x(rows%column(k))
            end do
         end do
      end associate
   end subroutine multiply_compliance

end module atrito_signed_scene
