!> path.tab: displacements and stresses along lines and arcs, interpolated between the nodes.
module atrito_path_table
   use atrito_kinds, only: ip, is_nan, wp
   use atrito_model, only: model_t, path_t
   use atrito_place_fields, only: along_direction, place_field, place_values_t, PLACE_FIELDS
   use atrito_results, only: results_t
   use atrito_strings, only: string_t
   use atrito_summary, only: scales_t
   use atrito_table, only: table_t, add_integers, add_reals, add_words, begin_step_table, clear_small, one_word
   implicit none (type, external)
   private
   public :: build_path_table, path_values, PATH_COLUMNS, ALONG_PATH, ACROSS_PATH, SHEAR_OF_PATH

   !> What stands behind s, x, y and element. Those that are no PLACE_FIELDS go by the direction of the path.
   character(len=8), parameter :: PATH_COLUMNS(20) = [character(len=8) :: 'u1', 'u2', 's11', 's22', 's33', 's12', 'mises', 's1', &
                                                      's2', 'tresca', 'u_along', 'u_across', 's_along', 's_across', 's_shear', &
                                                      'u_r', 'u_t', 's_rr', 's_tt', 's_rt']
   integer, parameter :: FIRST_ALONG = 11, ALONG_PATH = 13, ACROSS_PATH = 14, SHEAR_OF_PATH = 15

contains

   !> A row a point and body that holds it, path by path.
   subroutine build_path_table(model, results, scales, table)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results           !< with stresses at the nodes
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      type(string_t), allocatable :: names(:)
      real(wp), allocatable :: field(:, :), x(:, :), s(:)
      integer(ip), allocatable :: element(:)
      integer(ip) :: i, first, n
      integer :: k

      associate (asked => model%steps(results%step)%requests%paths)
         n = 0
         do i = 1, size(asked, kind=ip)
            n = n + size(model%paths(asked(i))%place, kind=ip)
         end do
         allocate (names(n), field(n, size(PATH_COLUMNS)), x(2, n), s(n), element(n))
         first = 0
         do i = 1, size(asked, kind=ip)
            associate (path => model%paths(asked(i)), rows => [(first + k, k=1, size(model%paths(asked(i))%place))])
               do k = 1, size(rows)
                  names(rows(k))%s = one_word(path%name)
               end do
               field(rows, :) = path_values(model, results, path)
               x(:, rows) = path%x
               s(rows) = path%s
               element(rows) = model%mesh%element_id(path%place%element)
               first = first + size(rows, kind=ip)
            end associate
         end do
      end associate
      call begin_step_table(table, 'path', 'a row a point of a path and body that holds it; stresses are those of the nodes, '// &
                            'interpolated', n, results%step)
      call add_words(table, 'path', '-', names, on_the_left=.true.)
      call add_reals(table, 's', 'L', s, 0.0_wp)
      call add_reals(table, 'x', 'L', x(1, :), scales%length)
      call add_reals(table, 'y', 'L', x(2, :), scales%length)
      call add_integers(table, 'element', element)
      do k = 1, size(PATH_COLUMNS)
         if (PATH_COLUMNS(k)(1:1) == 'u') then
            call add_reals(table, trim(PATH_COLUMNS(k)), 'L', field(:, k), scales%displacement)
         else
            call add_reals(table, trim(PATH_COLUMNS(k)), 'F/L^2', field(:, k), scales%nodal_stress)
         end if
      end do
   end subroutine build_path_table

   !> The values of a path: (rows, PATH_COLUMNS).
   pure function path_values(model, results, path) result(values)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(path_t), intent(in) :: path
      real(wp) :: values(size(path%place), size(PATH_COLUMNS))
      type(place_values_t) :: at
      integer :: i, k

      do i = 1, size(path%place)
         associate (e => path%place(i)%element, n => model%mesh%shape(path%place(i)%element))
            associate (nodes => model%mesh%nodes(:n, e), share => path%place(i)%value(:n))
               at%u = matmul(results%u(:, nodes), share)
               at%s = matmul(results%nodal_stress(:4, nodes), share)
            end associate
         end associate
         at%arm = path%x(:, i) - path%centre
         values(i, FIRST_ALONG:SHEAR_OF_PATH) = along_direction(at, path%along(:, i))
         do k = 1, size(PATH_COLUMNS)
            if (k < FIRST_ALONG .or. k > SHEAR_OF_PATH) values(i, k) = place_field(field_named(PATH_COLUMNS(k)), at)
         end do
      end do
   end function path_values

   pure integer function field_named(name)
      character(len=*), intent(in) :: name

      field_named = findloc(PLACE_FIELDS == name, .true., dim=1)
   end function field_named

end module atrito_path_table
