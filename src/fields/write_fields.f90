!> The field file, docs/user/results.md: <deck name>.h5 with the arrays, and <deck name>.xdmf beside it, by which it is opened.
module atrito_write_fields
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_element_table, only: SHAPES, MOST_NODES
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: STRESS_NAMES
   use atrito_strings, only: string_t, join, to_text
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_set_t, text_file_t, reserve_file, open_text, put_line, close_text
   use atrito_mesh, only: mesh_t
   use atrito_model, only: model_t, is_due
   use atrito_results, only: results_t, history_t, contact_result_t, last_frame, view_frame
   use atrito_table, only: origin_t
   use atrito_frame_tables, only: stress_rows
   use atrito_increments, only: ending_text, time_text
   use atrito_write_tables, only: origin_of
   use atrito_hdf5, only: hdf5_file_t, create_hdf5, put_array, put_attribute, close_hdf5
   use atrito_xdmf, only: xdmf_grid_t, xdmf_frame_t, begin_grid, add_field, begin_xdmf, add_time, end_xdmf, CENTRE_NODE, CENTRE_CELL
   implicit none (type, external)
   private
   public :: write_fields, list_field_files

   character(len=*), parameter :: PLACES = 'x and y, reference place'

contains

   !> Names of the files that this module can write: what a new run replaces or removes.
   pure function list_field_files(model) result(names)
      type(model_t), intent(in) :: model         !< its deck_name is read
      type(string_t) :: names(2)

      names(1)%s = model%deck_name//'.h5'
      names(2)%s = model%deck_name//'.xdmf'
   end function list_field_files

   !> Writes both files into a set, when the deck asks for fields; the HDF5 library is not touched otherwise.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_fields(model, history, set, status)
      type(model_t), intent(in) :: model               !< mesh, and what its steps ask for
      type(history_t), intent(in), target :: history   !< frames, in a store or not
      type(file_set_t), intent(inout) :: set           !< gets two files, if fields are asked for
      type(status_t), intent(out) :: status            !< STATUS_OK or STATUS_FILE
      type(xdmf_grid_t), allocatable :: mesh_grids(:)
      type(xdmf_frame_t) :: frame
      type(results_t), pointer :: results
      type(hdf5_file_t) :: file
      type(text_file_t) :: text
      type(string_t) :: names(2)
      type(string_t), allocatable :: lines(:)
      type(status_t) :: of_text
      type(origin_t) :: origin
      character(len=:), allocatable :: path
      integer(ip), allocatable :: due(:)
      integer :: i

      due = due_frames(model, history)
      if (size(due) == 0) return
      names = list_field_files(model)
      call reserve_file(set, names(1)%s, path)
      call create_hdf5(path, set%folder//'/'//names(1)%s, .false., file)
      call open_text(set, names(2)%s, text)
      call begin_xdmf(PROGRAM_NAME//' '//PROGRAM_VERSION, warning_of(history), lines)
      origin = origin_of(model, history)
      call put_attribute(file, '/', 'program', PROGRAM_NAME//' '//PROGRAM_VERSION)
      call put_attribute(file, '/', 'deck', origin%deck)
      call put_attribute(file, '/', 'heading', join(origin%heading, achar(10)))
      call put_attribute(file, '/', 'converged', merge(0_ip, 1_ip, origin%not_converged))
      if (origin%not_converged) call put_attribute(file, '/', 'NOT CONVERGED', warning_of(history))
      call put_mesh(file, model%mesh, mesh_grids)
      ! which increments there are, and at what time: a row each (frames themselves are large, and are not copied)
      call put_integers(file, '/increments/step', 'number of the step', [(history%frames(due(i))%step, i=1, size(due))])
      call put_integers(file, '/increments/increment', 'number of the increment in its step', &
                        [(history%frames(due(i))%increment, i=1, size(due))])
      call put_rows(file, '/increments/time', 'time of the history', '-', &
                    reshape([(history%frames(due(i))%time, i=1, size(due))], [1, size(due)]))
      do i = 1, size(due)
         call view_frame(history, due(i), results)
         frame%grids = mesh_grids
         call put_frame()
         call add_time(names(1)%s, frame, lines)
         call flush_lines()
      end do
      call end_xdmf(lines)
      call flush_lines()
      call close_hdf5(file, status)
      call close_text(text, of_text)
      if (is_ok(status)) status = of_text

   contains

      !> The fields of one increment, into its own group.
      subroutine put_frame()

         frame%name = 'step '//to_text(results%step)
         if (.not. results%ends_step) frame%name = frame%name//', increment '//to_text(results%increment)
         frame%time = time_text(results%time)
         call put_nodal_fields(file, model, results, frame%grids)
         if (model%steps(results%step)%requests%fields%stress) call put_stress_points(file, model, results, frame%grids)
         if (model%steps(results%step)%requests%fields%contact) call put_pairs(file, results, frame%grids)
      end subroutine put_frame

      !> Writes lines, after which there are none.
      subroutine flush_lines()
         integer :: i

         do i = 1, size(lines)
            call put_line(text, lines(i)%s)
         end do
         deallocate (lines)
         allocate (lines(0))
      end subroutine flush_lines

   end subroutine write_fields

   !> Places of the frames that are in the file: those whose step asks for fields and that are due, and the last, whatever it is.
   pure function due_frames(model, history) result(list)
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      integer(ip), allocatable :: list(:)
      logical :: is_in(size(history%frames))
      integer(ip) :: i, n

      n = size(history%frames, kind=ip)
      do i = 1, n
         associate (frame => history%frames(i), requests => model%steps(history%frames(i)%step)%requests)
            is_in(i) = requests%fields%nodes .or. requests%fields%reactions .or. requests%fields%stress .or. requests%fields%contact
            is_in(i) = is_in(i) .and. (i == n .or. is_due(requests%every%fields, frame%increment, frame%ends_step))
         end associate
      end do
      list = pack([(i, i=1, n)], is_in)
   end function due_frames

   !> Why a run did not converge, or where its history ended; '' when all went well.
   function warning_of(history) result(text)
      type(history_t), intent(in) :: history
      character(len=:), allocatable :: text

      text = ''
      if (history%ending%is_early) then
         text = ending_text(history)
         return
      end if
      associate (last => history%frames(last_frame(history)))
         if (last%converged .and. last%law_holds) return
         text = 'the last iterate, not a solution'
         if (allocated(last%verdict)) text = text//': '//last%verdict
      end associate
   end function warning_of

   !> Coordinates and numbers of the nodes; the elements of each shape as a grid.
   subroutine put_mesh(file, mesh, grids)
      type(hdf5_file_t), intent(inout) :: file
      type(mesh_t), intent(in) :: mesh
      type(xdmf_grid_t), allocatable, intent(out) :: grids(:)
      integer(ip) :: k

      call put_rows(file, '/mesh/coordinates', PLACES, 'L', mesh%x)
      call put_integers(file, '/mesh/node', 'number of the node', mesh%node_id)
      allocate (grids(0))
      do k = 1, MOST_NODES
         if (SHAPES(k)%n_nodes > 0) call put_shape(k, trim(SHAPES(k)%name), trim(SHAPES(k)%topology))
      end do

   contains

      !> The elements of one shape, if there are any.
      subroutine put_shape(shape, name, topology)
         integer(ip), intent(in) :: shape                 !< place in SHAPES
         character(len=*), intent(in) :: name, topology
         type(xdmf_grid_t) :: grid
         integer(ip), allocatable :: elements(:)
         integer(ip) :: e, n

         elements = pack([(e, e=1, mesh%n_elements)], mesh%shape(:mesh%n_elements) == shape)
         n = size(elements, kind=ip)
         if (n == 0) return
         call put_array(file, '/mesh/'//name//'/nodes', mesh%nodes(:shape, elements) - 1, 'rows of the nodes, counted from 0', '-')
         call put_integers(file, '/mesh/'//name//'/element', 'number of the element', mesh%element_id(elements))
         call begin_grid(grid, 'bodies, '//name//' elements', topology, '/mesh/'//name//'/nodes', [n, shape, mesh%n_nodes], &
                         '/mesh/coordinates')
         call add_field(grid, '/mesh/node', 1_ip, .false., CENTRE_NODE)
         call add_field(grid, '/mesh/'//name//'/element', 1_ip, .false., CENTRE_CELL)
         grids = [grids, grid]
      end subroutine put_shape

   end subroutine put_mesh

   !> Displacements, reactions and stresses at the nodes, each when asked for. They belong to the grids of all shapes.
   subroutine put_nodal_fields(file, model, results, grids)
      type(hdf5_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(xdmf_grid_t), intent(inout) :: grids(:)
      logical, allocatable :: mask(:)
      integer(ip) :: k, e

      associate (fields => model%steps(results%step)%requests%fields)
         if (fields%nodes) call put_nodal('U', 'displacement', 'L', results%u, fields%node_u)
         if (fields%reactions) call put_nodal('RF', 'force of the support upon the body', 'F', results%reaction, fields%node_rf)
         if (.not. (fields%stress .and. allocated(results%nodal_stress))) return
         ! The nodes on these elements.
         allocate (mask(model%mesh%n_nodes), source=.false.)
         do e = 1, model%mesh%n_elements
            if (fields%element_s(e)) mask(model%mesh%nodes(:model%mesh%shape(e), e)) = .true.
         end do
         do k = 1, size(STRESS_NAMES, kind=ip)
            call put_nodal(trim(STRESS_NAMES(k)), 'stress recovered at the nodes', 'F/L^2', results%nodal_stress(k:k, :), mask)
         end do
      end associate

   contains

      subroutine put_nodal(field, name, dimension, values, mask)
         character(len=*), intent(in) :: field, name, dimension
         real(wp), intent(in) :: values(:, :)
         logical, intent(in), optional :: mask(:)
         integer :: i

         call put_rows(file, frame_group(results)//'/nodes/'//field, name, dimension, values, mask=mask, &
                       in_space=size(values, 1) == 2)
         do i = 1, size(grids)
            call add_field(grids(i), frame_group(results)//'/nodes/'//field, merge(3_ip, 1_ip, size(values, 1) == 2), .true., &
                           CENTRE_NODE)
         end do
      end subroutine put_nodal

   end subroutine put_nodal_fields

   !> Where the fields of an increment are: /step_2 of that which ends the step, else /step_2/increment_5.
   pure function frame_group(results) result(path)
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: path

      path = '/step_'//to_text(results%step)
      if (.not. results%ends_step) path = path//'/increment_'//to_text(results%increment)
   end function frame_group

   !> Reals (components, n): all, or those of a list. Vectors in the plane become vectors of space, which is what readers take for
   !> vectors; what is not asked for is NaN.
   subroutine put_rows(file, path, name, dimension, values, list, mask, in_space)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name, dimension
      real(wp), intent(in) :: values(:, :)
      integer(ip), intent(in), optional :: list(:)     !< of the columns of values
      logical, intent(in), optional :: mask(:)         !< (n) asked for
      logical, intent(in), optional :: in_space        !< with a third component, 0
      real(wp), allocatable :: rows(:, :)
      integer :: i, n

      n = size(values, 1)
      if (present(list)) then
         rows = values(:, list)
      else
         if (present(in_space)) n = merge(3, n, in_space)
         allocate (rows(n, size(values, 2)), source=0.0_wp)
         rows(:size(values, 1), :) = values
      end if
      if (present(mask)) then
         do i = 1, size(mask)
            if (.not. mask(i)) rows(:, i) = ieee_value(1.0_wp, ieee_quiet_nan)
         end do
      end if
      call put_array(file, path, rows, name, dimension)
   end subroutine put_rows

   !> What stress.tab tells: the stresses at the integration points, as a grid of points.
   subroutine put_stress_points(file, model, results, grids)
      type(hdf5_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(xdmf_grid_t), allocatable, intent(inout) :: grids(:)
      type(xdmf_grid_t) :: grid
      character(len=:), allocatable :: group
      integer(ip), allocatable :: row(:)
      integer(ip) :: n, k, i

      row = stress_rows(results, model%steps(results%step)%requests%fields%element_s)
      n = size(row, kind=ip)
      if (n == 0) return
      group = frame_group(results)//'/stress_points/'
      call begin_grid(grid, 'stress points', 'Polyvertex', group//'cells', [n, 1_ip, n], group//'coordinates')
      call put_integers(file, group//'cells', 'rows of the points, counted from 0', [(i, i=0, n - 1)])
      call put_rows(file, group//'coordinates', PLACES, 'L', results%stress_x, row)
      call put_integers(file, group//'element', 'number of the element', model%mesh%element_id(results%stress_element(row)), grid)
      call put_integers(file, group//'point', 'number of the point in its element', results%stress_point(row), grid)
      do k = 1, size(STRESS_NAMES, kind=ip)
         call put_rows(file, group//trim(STRESS_NAMES(k)), 'stress', 'F/L^2', results%stress(k:k, :), row)
         call add_field(grid, group//trim(STRESS_NAMES(k)), 1_ip, .true., CENTRE_NODE)
      end do
      grids = [grids, grid]
   end subroutine put_stress_points

   !> The fields of every pair at its points, each pair as a line along the slave surface.
   subroutine put_pairs(file, results, grids)
      type(hdf5_file_t), intent(inout) :: file
      type(results_t), intent(in) :: results
      type(xdmf_grid_t), allocatable, intent(inout) :: grids(:)
      type(xdmf_grid_t) :: line
      character(len=:), allocatable :: group, cells
      integer(ip) :: i, k

      if (.not. allocated(results%contact)) return
      do i = 1, size(results%contact, kind=ip)
         if (results%contact(i)%n == 0) cycle
         group = frame_group(results)//'/pair_'//to_text(i)
         cells = group//'/cells'
         associate (n => results%contact(i)%n)      ! the points in the order of s, joined by straight pieces
            call put_rows(file, group//'/coordinates', PLACES, 'L', results%contact(i)%x(:, :n))
            if (n == 1) then
               call begin_grid(line, 'pair '//to_text(i), 'Polyvertex', cells, [1_ip, 1_ip, 1_ip], group//'/coordinates')
               call put_integers(file, cells, 'row of the point, counted from 0', [0_ip])
            else
               call begin_grid(line, 'pair '//to_text(i), 'Polyline', cells, [n - 1, 2_ip, n], group//'/coordinates')
               call put_array(file, cells, reshape([(k - 1, k, k=1, n - 1)], [2_ip, n - 1]), &
                              'rows of the points, counted from 0', '-')
            end if
         end associate
         call put_contact(file, group//'/', results%contact(i), line)
         grids = [grids, line]
         if (.not. allocated(results%scene%pairs)) cycle
         call put_attribute(file, group, 'slave', results%scene%pairs(i)%slave)
         call put_attribute(file, group, 'master', results%scene%pairs(i)%master)
      end do
   end subroutine put_pairs

   !> The columns of contact.tab, the displacements of the slave, and the tractions upon it, -p n + sigma_T T with T = n turned by
   !> +90 degrees.
   subroutine put_contact(file, group, contact, grid)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: group
      type(contact_result_t), intent(in) :: contact
      type(xdmf_grid_t), intent(inout) :: grid
      real(wp) :: traction(2, contact%n)

      associate (n => contact%n)
         call put('s', 'arc length along the slave surface', 'L', contact%s(:n))
         call put('gap', 'initial distance - u_n', 'L', contact%gap(:n))
         call put('pressure', 'p = -sigma_n', 'F/L^2', contact%pressure(:n))
         call put('weighted_pressure', 'S_rho(p)', 'F/L^2', contact%weighted_pressure(:n))
         call put('shear', 'sigma_T on the slave along T', 'F/L^2', contact%shear(:n))
         call put('slip', 'u_T', 'L', contact%slip(:n))
         call put_integers(file, group//'status', '0 open, 1 stick, 2 slip', contact%status(:n), grid)
         call put('weight', 'quadrature weight times thickness', 'L^2', contact%weight(:n))
         if (allocated(contact%slip_increment)) then
            call put('slip_increment', 'u_T since the increment before', 'L', contact%slip_increment(:n))
         else
            call put('slip_increment', 'u_T since the increment before', 'L', contact%slip(:n))
         end if
         call put_rows(file, group//'U', 'displacement of the slave', 'L', contact%u(:, :n), in_space=.true.)
         call add_field(grid, group//'U', 3_ip, .true., CENTRE_NODE)
         traction(1, :) = -contact%pressure(:n)*contact%normal(1, :n) - contact%shear(:n)*contact%normal(2, :n)
         traction(2, :) = -contact%pressure(:n)*contact%normal(2, :n) + contact%shear(:n)*contact%normal(1, :n)
         call put_rows(file, group//'traction', 'traction upon the slave, -p n + sigma_T T', 'F/L^2', traction, in_space=.true.)
         call add_field(grid, group//'traction', 3_ip, .true., CENTRE_NODE)
      end associate

   contains

      subroutine put(field, name, dimension, values)
         character(len=*), intent(in) :: field, name, dimension
         real(wp), intent(in) :: values(:)

         call put_rows(file, group//field, name, dimension, reshape(values, [1, size(values)]))
         call add_field(grid, group//field, 1_ip, .true., CENTRE_NODE)
      end subroutine put

   end subroutine put_contact

   !> Numbers; a field of the grid where there is one.
   subroutine put_integers(file, path, name, values, grid)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name
      integer(ip), intent(in) :: values(:)
      type(xdmf_grid_t), intent(inout), optional :: grid

      call put_array(file, path, reshape(values, [1, size(values)]), name, '-')
      if (present(grid)) call add_field(grid, path, 1_ip, .false., CENTRE_NODE)
   end subroutine put_integers

end module atrito_write_fields
