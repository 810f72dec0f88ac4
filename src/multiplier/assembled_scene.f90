!> All bodies of a scene in one sparse matrix, with the contact points as elements that change: the sparse form of the contact
!> system (atrito_contact_system).
!>
!> The matrix is A + sum_i s_i B_i' B_i + pull on the amplitudes, where the stiffness s_i of a row is 1/(D_i + rho_i) while its
!> point is closed or sticks, else 0. A point is an element over the displacements of its rows and the rigid motions of its bodies,
!> the pull on a floating body an element over its motions. Nested dissection takes them like any other element, so the
!> factorisation follows the contact line as it follows the bodies, and a point that changes costs the fronts above it
!> (docs/developer/multifrontal.md).
!>
!> The springs of atrito_scene_elimination are elements, too: of the size of the stiffness at their displacement. They take no
!> force where the forces on a body balance, and only say which part of u is u_e.
module atrito_assembled_scene
   use atrito_assembly, only: fem_t, collect_elements
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: elimination_t, element_store_t, add_to_store, sum_diagonals, take_own_matrices, front_bytes_t, &
                                  variable_matrix_t, create_variable_matrix, set_variable_element, factor_variable_matrix, &
                                  solve_variable_matrix, solve_at_variable, add_fixed_product, fixed_diagonal, &
                                  expect_variable_factors, variable_matrix_bytes
   use atrito_row_entries, only: build_constraint_rows
   use atrito_scene_elimination, only: scene_numbering_t, number_scene, eliminate_scene
   use atrito_scene_system, only: scene_system_t, set_scene_gaps, set_flexibility
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: assembled_scene_t, assemble_scene, assemble_numbered, collect_scene

   integer(ip), parameter :: ROWS_A_POINT = 2

   type, extends(scene_system_t) :: assembled_scene_t
      type(variable_matrix_t) :: matrix
      integer(ip), allocatable, private :: point_row(:, :)  !< (ROWS_A_POINT, points with a row) normal, tangential; 0: none
      integer(lp), allocatable, private :: start(:)         !< (variable elements + 1) their unknowns
      integer(ip), allocatable, private :: unknown(:)
      real(wp), allocatable, private :: stiffness(:)        !< (rows) of the last factorisation
      real(wp), allocatable, private :: pull(:)             !< (k) of the last factorisation
   contains
      procedure :: multiply => multiply_scene
      procedure :: factor => factor_scene
      procedure :: solve => solve_scene
      procedure :: solve_at_rows => solve_scene_at_rows
      procedure :: memory_bytes => scene_bytes
      procedure :: solving_bytes
   end type assembled_scene_t

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INDEX_BYTES = storage_size(1_ip)/8

contains

   !> Numbers the unknowns, assembles the bodies and finds the fronts. status: STATUS_INTERNAL when the memory does not suffice.
   !>
   !> Nothing is factored: what the factors will take is known afterwards (solving_bytes), and the memory can be asked for.
   subroutine assemble_scene(fem, rows, line, value, scene, status)
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      real(wp), intent(in) :: value(:, :)        !< (2, n_nodes) prescribed displacements [L]
      type(assembled_scene_t), intent(out) :: scene
      type(status_t), intent(out) :: status
      real(wp), allocatable :: diagonal(:), coupling(:)

      call number_scene(fem, scene%numbering)
      scene%body = scene%numbering%body
      call build_constraint_rows(fem, rows, line, .true., scene%rows)
      call set_scene_gaps(rows, line, value, scene)
      call assemble_numbered(fem, rows, line, scene, status)
      if (.not. is_ok(status)) return
      allocate (diagonal(scene%n), coupling(scene%n))
      call fixed_diagonal(scene%matrix, diagonal, coupling)
      call set_flexibility(fem, rows, line, diagonal, coupling, scene)
   end subroutine assemble_scene

   !> The same of a scene with its numbering and its rows: matrices of the elements, order of elimination, fronts. A part of a scene
   !> has last unknowns that other parts have, too: they are kept (atrito_variable_matrix), and the part is there to be multiplied,
   !> factored and reduced, not to be solved. status: STATUS_INTERNAL when the memory does not suffice.
   subroutine assemble_numbered(fem, rows, line, scene, status, spring_stiffness, n_kept)
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(assembled_scene_t), intent(inout) :: scene
      type(status_t), intent(out) :: status
      real(wp), intent(in), optional :: spring_stiffness(:) !< of the numbering's springs [F/L]; left out: the diagonal there
      integer(ip), intent(in), optional :: n_kept !< last unknowns that are kept; left out: none
      type(element_store_t) :: store
      type(elimination_t) :: elimination

      scene%n = scene%numbering%n
      scene%k = scene%numbering%k
      scene%n_bodies = fem%bodies%n
      call list_variable_elements(line, scene)
      call collect_scene(fem, scene%numbering, store, spring_stiffness)
      scene%is_near = store%is_near
      elimination = eliminate_scene(fem, rows, line, scene%numbering, n_kept)
      call create_variable_matrix(scene%matrix, scene%n, elimination, store, scene%start, scene%unknown, status, n_kept)
      call move_alloc(elimination%text, scene%order)
   end subroutine assemble_numbered

   !> The elements that change: the points with the unknowns of their rows, then the motions of each floating body.
   !>
   !> start and unknown are lists in one: element v has the unknowns unknown(start(v) + 1 : start(v + 1)). The normal and the
   !> tangential row of a point have the same nodes, so they are one element.
   subroutine list_variable_elements(line, scene)
      type(contact_line_t), intent(in) :: line
      type(assembled_scene_t), intent(inout) :: scene
      integer(ip) :: j, b, n, v, i
      integer(lp) :: first

      n = count(line%normal > 0 .or. line%tangential > 0, kind=ip)
      associate (floating => count(scene%numbering%first_pull > 0, kind=ip))
         allocate (scene%point_row(ROWS_A_POINT, n), scene%start(n + floating + 1), &
                   scene%unknown(size(scene%rows%column) + scene%k))
      end associate
      scene%start(1) = 0
      v = 0
      do j = 1, line%n
         if (line%normal(j) == 0 .and. line%tangential(j) == 0) cycle
         v = v + 1
         scene%point_row(:, v) = [line%normal(j), line%tangential(j)]
         first = scene%start(v)
         scene%start(v + 1) = first
         do i = 1, ROWS_A_POINT
            if (scene%point_row(i, v) > 0) call add_unknowns(scene, scene%point_row(i, v), v)
         end do
      end do
      do b = 1, scene%n_bodies
         if (scene%numbering%first_pull(b) == 0) cycle
         v = v + 1
         first = scene%start(v)
         scene%start(v + 1) = first + scene%numbering%n_motions(b)
         scene%unknown(first + 1:scene%start(v + 1)) = scene%numbering%first_motion(b) &
                                                       + [(i, i=0, scene%numbering%n_motions(b) - 1)]
      end do
      scene%unknown = scene%unknown(:scene%start(size(scene%start)))
   end subroutine list_variable_elements

   !> Adds the unknowns of a row that its point does not have yet.
   !>
   !> A tangential row has mostly the nodes of the normal one; they are few, so looking them up is as good as any list.
   pure subroutine add_unknowns(scene, row, v)
      type(assembled_scene_t), intent(inout) :: scene
      integer(ip), intent(in) :: row, v
      integer(ip) :: k

      do k = scene%rows%first(row), scene%rows%first(row + 1) - 1
         if (any(scene%unknown(scene%start(v) + 1:scene%start(v + 1)) == scene%rows%column(k))) cycle
         scene%start(v + 1) = scene%start(v + 1) + 1
         scene%unknown(scene%start(v + 1)) = scene%rows%column(k)
      end do
   end subroutine add_unknowns

   !> Elements of all bodies in the numbers of the scene, and the springs that say which part of u is u_e.
   !>
   !> Near elements share one matrix in the fronts (fem%digit_error); products take each element's own. The factor is then that of
   !> K~, and as every step of the multipliers solves for a residual, the steps refine by themselves.
   subroutine collect_scene(fem, numbering, store, spring_stiffness)
      type(fem_t), intent(in) :: fem
      type(scene_numbering_t), intent(in) :: numbering
      type(element_store_t), intent(out) :: store
      real(wp), intent(in), optional :: spring_stiffness(:) !< (springs) [F/L]; left out: the diagonal there
      type(element_store_t) :: own
      integer(ip) :: e, b, i
      integer(lp) :: k
      real(wp) :: diagonal(numbering%n), spring

      call collect_elements(fem, [(e, e=1, fem%mesh%n_elements)], store, fem%digit_error)
      if (store%is_near) then
         ! fronts of the one, products of the other: every step of the iteration refines
         call collect_elements(fem, [(e, e=1, fem%mesh%n_elements)], own)
         call take_own_matrices(own, store)
      end if
      do e = 1, store%n
         b = fem%bodies%of_element(e)
         do k = store%start(e) + 1, store%start(e + 1)
            if (store%equations(k) > 0) store%equations(k) = store%equations(k) + numbering%before(b)
         end do
      end do
      if (size(numbering%spring) == 0) return
      if (.not. present(spring_stiffness)) call sum_diagonals(store, store%n, diagonal)
      do i = 1, size(numbering%spring, kind=ip)
         if (numbering%spring(i) == 0) cycle
         if (present(spring_stiffness)) then
            spring = spring_stiffness(i)
         else
            spring = diagonal(numbering%spring(i))
         end if
         call add_to_store(store, [numbering%spring(i)], reshape([spring], [1, 1]))
      end do
   end subroutine collect_scene

   !> y = A x, with the springs: the matrix without its elements that change.
   subroutine multiply_scene(self, x, y)
      class(assembled_scene_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: y(:)

      y = 0.0_wp
      call add_fixed_product(self%matrix, x, y)
   end subroutine multiply_scene

   !> Only points and bodies whose numbers have changed are taken anew.
   !>
   !> What is set anew marks the fronts above it; factor_variable_matrix goes through these alone. After a failure all are set
   !> again.
   subroutine factor_scene(self, stiffness, pull, status)
      class(assembled_scene_t), intent(inout) :: self
      real(wp), intent(in) :: stiffness(:), pull(:)
      type(status_t), intent(out) :: status
      integer(ip) :: v, b, n_points

      n_points = size(self%point_row, 2, kind=ip)
      if (.not. allocated(self%stiffness)) then
         allocate (self%stiffness(self%rows%n), self%pull(self%k), source=-1.0_wp)
      end if
      ! points whose states have changed
      do v = 1, n_points
         if (is_changed(self, v, stiffness)) call set_point()
      end do
      ! floating bodies whose pull has changed
      v = n_points
      do b = 1, self%n_bodies
         if (self%numbering%first_pull(b) == 0) cycle
         v = v + 1
         associate (first => self%numbering%first_pull(b), n => self%numbering%n_motions(b))
            if (any(self%pull(first:first + n - 1) /= pull(first:first + n - 1))) then
               call set_variable_element(self%matrix, v, diagonal_matrix(pull(first:first + n - 1)))
            end if
         end associate
      end do
      self%stiffness = stiffness
      self%pull = pull
      call factor_variable_matrix(self%matrix, status)
      self%failed = self%matrix%failed
      if (is_ok(status)) return
      self%stiffness = -1.0_wp
      self%pull = -1.0_wp

   contains

      !> The element of a point: the sum of stiffness b b' over its rows b.
      subroutine set_point()
         real(wp), allocatable :: row(:), matrix(:, :)
         integer(ip) :: i, j, k, at

         associate (n => self%start(v + 1) - self%start(v))
            allocate (row(n), matrix(n, n))
         end associate
         matrix = 0.0_wp
         do i = 1, ROWS_A_POINT
            j = self%point_row(i, v)
            if (j == 0) cycle
            row = 0.0_wp
            do k = self%rows%first(j), self%rows%first(j + 1) - 1
               at = findloc(self%unknown(self%start(v) + 1:self%start(v + 1)), self%rows%column(k), dim=1, kind=ip)
               row(at) = row(at) + self%rows%value(k)
            end do
            do k = 1, size(row, kind=ip)
               matrix(:, k) = matrix(:, k) + row*(stiffness(j)*row(k))
            end do
         end do
         call set_variable_element(self%matrix, v, matrix)
      end subroutine set_point

   end subroutine factor_scene

   !> Whether a row of point v has another stiffness than in the last factorisation.
   pure logical function is_changed(self, v, stiffness)
      class(assembled_scene_t), intent(in) :: self
      integer(ip), intent(in) :: v
      real(wp), intent(in) :: stiffness(:)
      integer(ip) :: i

      is_changed = .false.
      do i = 1, ROWS_A_POINT
         associate (row => self%point_row(i, v))
            if (row > 0) is_changed = is_changed .or. self%stiffness(row) /= stiffness(row)
         end associate
      end do
   end function is_changed

   pure function diagonal_matrix(d) result(matrix)
      real(wp), intent(in) :: d(:)
      real(wp) :: matrix(size(d), size(d))
      integer(ip) :: i

      matrix = 0.0_wp
      do i = 1, size(d, kind=ip)
         matrix(i, i) = d(i)
      end do
   end function diagonal_matrix

   !> x <- H^-1 x with the last factors.
   subroutine solve_scene(self, x)
      class(assembled_scene_t), intent(in) :: self
      real(wp), intent(inout) :: x(:)

      call solve_variable_matrix(self%matrix, x)
   end subroutine solve_scene

   !> The same at the unknowns of the rows and the amplitudes, of a load at these alone: by the fronts above the points.
   subroutine solve_scene_at_rows(self, x)
      class(assembled_scene_t), intent(in) :: self
      real(wp), intent(inout) :: x(:)

      call solve_at_variable(self%matrix, x)
   end subroutine solve_scene_at_rows

   !> Memory held: the matrix with its factors, the rows and the lists of the elements that change.
   pure integer(lp) function scene_bytes(self) result(bytes)
      class(assembled_scene_t), intent(in) :: self

      bytes = variable_matrix_bytes(self%matrix) + (REAL_BYTES + INDEX_BYTES)*size(self%rows%value, kind=lp) &
              + INDEX_BYTES*size(self%unknown, kind=lp)
   end function scene_bytes

   !> What solving will take beyond what the scene holds before its first factorisation [bytes]: factors, and the vectors of the
   !> iteration.
   pure integer(lp) function solving_bytes(self) result(bytes)
      class(assembled_scene_t), intent(in) :: self
      integer(lp), parameter :: OF_UNKNOWNS = 10_lp, OF_ROWS = 40_lp
      type(front_bytes_t) :: factors

      call expect_variable_factors(self%matrix, factors)
      bytes = factors%most + REAL_BYTES*(OF_UNKNOWNS*int(self%n, lp) + OF_ROWS*int(self%rows%n, lp))
   end function solving_bytes

end module atrito_assembled_scene
