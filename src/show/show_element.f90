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
   use atrito_grid, only: add_matrix
   use atrito_strings, only: append_string, string_t, to_text
   use atrito_table, only: table_t, begin_table, add_integers, add_reals, add_words
   implicit none (type, external)
   private
   public :: view_element

   real(wp), parameter :: NONE = 1.0e-10_wp         !< an eigenvalue beside the largest: no strain at all
   integer(ip), parameter :: MOST_PRINTED = 4       !< points whose B is printed; the table has all
   character(len=3), parameter :: STRAINS(COMPONENTS) = ['e11', 'e22', 'g12']

contains

   !> Page and table of an element in the plane.
   subroutine view_element(fem, e, page, table)
      type(fem_t), intent(in) :: fem                !< mesh and sections of the scene
      integer(ip), intent(in) :: e                  !< its place in the mesh
      type(page_t), intent(inout) :: page           !< gets the view
      type(table_t), intent(out) :: table           !< show-element
      type(stiffness_cache_t) :: cache
      type(string_t), allocatable :: matrices(:)    ! rows of the table, as they come
      integer(ip), allocatable :: places(:, :)      ! (3, rows) point, row, column
      real(wp), allocatable :: entries(:), b(:, :), k(:, :), total(:, :), values(:)
      real(wp) :: d(COMPONENTS, COMPONENTS), xi(2), place(2), weight
      integer(ip) :: n, i, info, n_rigid
      character(len=:), allocatable :: name, nodes

      n = fem%mesh%shape(e)
      allocate (matrices(0), places(3, 0), entries(0))
      allocate (b(COMPONENTS, 2*n), total(2*n, 2*n), values(2*n), source=0.0_wp)
      call cached_stiffness(fem, e, cache)
      k = cache%k(:2*n, :2*n)
      d = elasticity_matrix(fem%sections(cache%section), cache%state)
      name = 'element '//to_text(fem%mesh%element_id(e))//', '//trim(KINDS(kind_of(n, cache%state))%name)
      nodes = ''
      do i = 1, n
         nodes = nodes//' '//to_text(fem%mesh%node_id(fem%mesh%nodes(i, e)))
      end do
      call add_heading(page, name//', '//trim(STATES(cache%state)%name))
      call add_line(page, 'columns of B: u1 and u2 of the nodes in their order,'//nodes)
      do i = 1, point_count(n, cache%state)
         call strain_matrix(cache, fem%sections(cache%section)%thickness, i, b, xi, place, weight)
         total = total + weight*matmul(transpose(b), matmul(d, b))
         call put_rows('B', i, b)
         call put_rows('w', i, reshape([weight], [1, 1]))
         if (i > MOST_PRINTED) cycle
         place = place + fem%mesh%x(:, fem%mesh%nodes(1, e))
         call add_matrix(page, 'B [1/L], point '//to_text(i)//', ('//to_text(xi(1), 4)//', '//to_text(xi(2), 4)//'), x = ('// &
                         to_text(place(1), 4)//', '//to_text(place(2), 4)//'), w = '//to_text(weight, 4), b, STRAINS)
      end do
      if (point_count(n, cache%state) > MOST_PRINTED) call add_line(page, 'B of the other points: show-element')
      call put_rows('D', 0_ip, d, 'D [F/L^2]')
      call put_rows('K', 0_ip, k, 'K_e [F/L]')
      call eigen_symmetric(cache%k(:2*n, :2*n), values, info)
      where (abs(values) <= NONE*maxval(abs(values))) values = 0.0_wp
      call add_matrix(page, 'eigenvalues of K_e [F/L]', reshape(values, [1_ip, 2*n]))
      call put_rows('eigenvalue', 0_ip, reshape(values, [2*n, 1_ip]))
      n_rigid = count(values == 0.0_wp, kind=ip)
      call add_line(page, to_text(n_rigid)//' of '//to_text(2*n)//' eigenvalues are 0: motions without strain; 3 are rigid')
      call add_line(page, 'sum of B'' D B w over the points less K_e: '// &
                    to_text(maxval(abs(total - k))/maxval(abs(k)), 2)//' of the largest entry')
      call begin_table(table, 'show-element', 'a row a number of the matrices of '//name, size(entries, kind=ip))
      call append_string(table%remarks, 'B [1/L], D [F/L^2], K and its eigenvalues [F/L]; w: weight of a point [L^3]')
      call append_string(table%remarks, 'motions without strain: '//to_text(n_rigid))
      call add_words(table, 'matrix', '-', matrices, on_the_left=.true.)
      call add_integers(table, 'point', places(1, :))
      call add_integers(table, 'row', places(2, :))
      call add_integers(table, 'column', places(3, :))
      call add_reals(table, 'value', 'see_above', entries, 0.0_wp)

   contains

      !> Puts a matrix into the table, and with a title on the page.
      subroutine put_rows(name, point, a, title)
         character(len=*), intent(in) :: name
         integer(ip), intent(in) :: point           !< 0: of the element
         real(wp), intent(in) :: a(:, :)
         character(len=*), intent(in), optional :: title
         integer(ip) :: row, column

         do row = 1, size(a, 1, kind=ip)
            do column = 1, size(a, 2, kind=ip)
               call append_string(matrices, name)
               places = reshape([places, point, row, column], [3, size(matrices)])
               entries = [entries, a(row, column)]
            end do
         end do
         if (present(title)) call add_matrix(page, title, a)
      end subroutine put_rows

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

end module atrito_show_element
