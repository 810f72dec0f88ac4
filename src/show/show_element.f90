!> --show element=N: B at the Gauss points, D and the stiffness of an element, its eigenvalues and rigid motions.
!>
!>     K_e = sum over the points of B' D B w,     w the weight of the rule times the Jacobian times the thickness
!>
!> holds to rounding for full integration; reduced integration with its hourglass control and the mean dilatation (B-bar) have a K_e
!> of their own, and it is told how far that is from the sum.
module atrito_show_element
   use atrito_assembly, only: fem_t, stiffness_cache_t, cached_stiffness
   use atrito_dense, only: eigen_symmetric
   use atrito_element_table, only: KINDS, kind_of, point_count
   use atrito_kinds, only: ip, wp
   use atrito_page, only: page_t, add_heading, add_line
   use atrito_plane_state, only: elasticity_matrix, COMPONENTS, IS_TAPERED, STATES
   use atrito_shape_functions, only: rule_point, shape_gradients, shape_values
   use atrito_show_text, only: add_matrix
   use atrito_strings, only: append_string, string_t, to_text
   use atrito_table, only: table_t, begin_table, add_integers, add_reals, add_words
   implicit none (type, external)
   private
   public :: view_element

   real(wp), parameter :: NONE = 1.0e-10_wp         !< an eigenvalue beside the largest: no strain at all
   integer(ip), parameter :: MOST_PRINTED = 4       !< points whose B is printed; the table has all
   character(len=3), parameter :: STRAINS(COMPONENTS) = ['e11', 'e22', 'g12']

   !> The rows of the table, as they come.
   type :: rows_t
      type(string_t), allocatable :: matrix(:)
      integer(ip), allocatable :: place(:, :)       !< (3, n) point, row, column
      real(wp), allocatable :: value(:)
   end type rows_t

contains

   !> Page and table of an element in the plane.
   subroutine view_element(fem, e, page, table)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e                  !< its place in the mesh
      type(page_t), intent(inout) :: page
      type(table_t), intent(out) :: table
      type(stiffness_cache_t) :: cache
      type(rows_t) :: rows
      real(wp), allocatable :: b(:, :), k(:, :), total(:, :), values(:)
      real(wp) :: d(COMPONENTS, COMPONENTS), xi(2), place(2), weight
      integer(ip) :: n, i, info, n_rigid
      character(len=:), allocatable :: name

      n = fem%mesh%shape(e)
      allocate (rows%matrix(0), rows%place(3, 0), rows%value(0))
      allocate (b(COMPONENTS, 2*n), total(2*n, 2*n), values(2*n), source=0.0_wp)
      call cached_stiffness(fem, e, cache)
      k = cache%k(:2*n, :2*n)
      d = elasticity_matrix(fem%sections(cache%section), cache%state)
      name = 'element '//to_text(fem%mesh%element_id(e))//', '//trim(KINDS(kind_of(n, cache%state))%name)
      call add_heading(page, name//', '//trim(STATES(cache%state)%name))
      call add_line(page, 'columns of B: u1 and u2 of the nodes in their order,'//node_list(fem, e))
      do i = 1, point_count(n, cache%state)
         call strain_matrix(cache, fem%sections(cache%section)%thickness, i, b, xi, place, weight)
         total = total + weight*matmul(transpose(b), matmul(d, b))
         call add_rows('B', i, b, rows)
         call add_rows('w', i, reshape([weight], [1, 1]), rows)
         if (i > MOST_PRINTED) cycle
         place = place + fem%mesh%x(:, fem%mesh%nodes(1, e))
         call add_matrix(page, 'B [1/L], point '//to_text(i)//', ('//to_text(xi(1), 4)//', '//to_text(xi(2), 4)//'), x = ('// &
                         to_text(place(1), 4)//', '//to_text(place(2), 4)//'), w = '//to_text(weight, 4), b, STRAINS)
      end do
      if (point_count(n, cache%state) > MOST_PRINTED) call add_line(page, 'B of the other points: show-element')
      call add_matrix(page, 'D [F/L^2]', d)
      call add_rows('D', 0_ip, d, rows)
      call add_matrix(page, 'K_e [F/L]', k)
      call add_rows('K', 0_ip, k, rows)
      total = total - k
      call eigen_symmetric(cache%k(:2*n, :2*n), values, info)
      where (abs(values) <= NONE*maxval(abs(values))) values = 0.0_wp
      call add_matrix(page, 'eigenvalues of K_e [F/L]', reshape(values, [1_ip, 2*n]))
      call add_rows('eigenvalue', 0_ip, reshape(values, [2*n, 1_ip]), rows)
      n_rigid = count(values == 0.0_wp, kind=ip)
      call add_line(page, to_text(n_rigid)//' of '//to_text(2*n)//' eigenvalues are 0: motions without strain; 3 are rigid')
      call add_line(page, 'sum of B'' D B w over the points less K_e: '//to_text(maxval(abs(total))/maxval(abs(k)), 2)// &
                    ' of the largest entry')
      call begin_table(table, 'show-element', 'a row a number of the matrices of '//name, size(rows%value, kind=ip))
      call append_string(table%remarks, 'B [1/L], D [F/L^2], K and its eigenvalues [F/L]; w: weight of a point [L^3]')
      call append_string(table%remarks, 'motions without strain: '//to_text(n_rigid))
      call add_words(table, 'matrix', '-', rows%matrix, on_the_left=.true.)
      call add_integers(table, 'point', rows%place(1, :))
      call add_integers(table, 'row', rows%place(2, :))
      call add_integers(table, 'column', rows%place(3, :))
      call add_reals(table, 'value', 'see_above', rows%value, 0.0_wp)
   end subroutine view_element

   !> B at a point, and what the point weighs.
   pure subroutine strain_matrix(form, thickness, i, b, xi, place, weight)
      type(stiffness_cache_t), intent(in) :: form
      real(wp), intent(in) :: thickness             !< of the section [L]
      integer(ip), intent(in) :: i                  !< point
      real(wp), intent(out) :: b(:, :)              !< (3, 2n) [1/L]
      real(wp), intent(out) :: xi(2), place(2), weight !< in the rule; relative to the first node [L]; [L^3]
      real(wp) :: slopes(form%shape, 2), jacobian(2, 2), determinant, g(2)
      integer(ip) :: a

      associate (n => form%shape)
         call rule_point(n, point_count(n, form%state), i, xi, weight)
         slopes = shape_gradients(n, xi)
         jacobian = matmul(form%x(:, :n), slopes)
         determinant = jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1)
         place = matmul(form%x(:, :n), shape_values(n, xi))
         weight = weight*determinant*thickness
         if (IS_TAPERED(form%state)) weight = weight*dot_product(shape_values(n, xi), form%thickness(:n))
         b = 0.0_wp
         do a = 1, n
            g(1) = (jacobian(2, 2)*slopes(a, 1) - jacobian(2, 1)*slopes(a, 2))/determinant
            g(2) = (jacobian(1, 1)*slopes(a, 2) - jacobian(1, 2)*slopes(a, 1))/determinant
            b(:, 2*a - 1) = [g(1), 0.0_wp, g(2)]
            b(:, 2*a) = [0.0_wp, g(2), g(1)]
         end do
      end associate
   end subroutine strain_matrix

   pure function node_list(fem, e) result(text)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      character(len=:), allocatable :: text
      integer(ip) :: i

      text = ''
      do i = 1, fem%mesh%shape(e)
         text = text//' '//to_text(fem%mesh%node_id(fem%mesh%nodes(i, e)))
      end do
   end function node_list

   !> Adds a matrix to the rows of the table.
   pure subroutine add_rows(name, point, a, rows)
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: point              !< 0: of the element
      real(wp), intent(in) :: a(:, :)
      type(rows_t), intent(inout) :: rows
      integer(ip) :: i, j

      do i = 1, size(a, 1, kind=ip)
         do j = 1, size(a, 2, kind=ip)
            call append_string(rows%matrix, name)
            rows%place = reshape([rows%place, point, i, j], [3, size(rows%matrix)])
            rows%value = [rows%value, a(i, j)]
         end do
      end do
   end subroutine add_rows

end module atrito_show_element
