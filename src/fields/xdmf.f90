!> The XDMF file beside an HDF5 file: it tells ParaView and other readers what the datasets are.
module atrito_xdmf
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, append_string, to_text, recoded
   implicit none (type, external)
   private
   public :: xdmf_grid_t, xdmf_field_t, xdmf_frame_t, begin_grid, add_field, begin_xdmf, add_time, end_xdmf, &
             CENTRE_NODE, CENTRE_CELL

   character(len=*), parameter :: CENTRE_NODE = 'Node', CENTRE_CELL = 'Cell'

   !> A dataset with a value a node or a cell.
   type :: xdmf_field_t
      character(len=:), allocatable :: name, path      !< path in the HDF5 file
      character(len=:), allocatable :: centre          !< CENTRE_NODE or CENTRE_CELL
      integer(ip) :: n_components = 1                  !< 1: scalar, 3: vector
      integer(ip) :: n_values = 0                      !< points or cells
      logical :: is_real = .true.                      !< else it is of whole numbers
   end type xdmf_field_t

   !> Cells of one shape and the fields upon them.
   type :: xdmf_grid_t
      character(len=:), allocatable :: name            !< of the grid, for the reader
      character(len=:), allocatable :: topology        !< XDMF's name of the shape
      character(len=:), allocatable :: cells, points   !< paths of connectivity and coordinates in the HDF5 file
      integer(ip) :: n_cells = 0, nodes_per_cell = 0, n_points = 0 !< of its cells and points
      type(xdmf_field_t), allocatable :: fields(:)     !< in the order in which they were added
   end type xdmf_grid_t

   !> What there is at one time.
   type :: xdmf_frame_t
      character(len=:), allocatable :: name            !< e.g. 'step 2'
      character(len=:), allocatable :: time            !< of the history, a number as text
      type(xdmf_grid_t), allocatable :: grids(:)       !< mesh, stress points and pairs
   end type xdmf_frame_t

contains

   !> Begins a grid without fields.
   pure subroutine begin_grid(grid, name, topology, cells, sizes, points)
      type(xdmf_grid_t), intent(out) :: grid           !< without fields
      character(len=*), intent(in) :: name, topology, cells, points !< as the components of xdmf_grid_t
      integer(ip), intent(in) :: sizes(3)              !< cells, nodes of each, points

      grid%name = name
      grid%topology = topology
      grid%cells = cells
      grid%points = points
      grid%n_cells = sizes(1)
      grid%nodes_per_cell = sizes(2)
      grid%n_points = sizes(3)
      allocate (grid%fields(0))
   end subroutine begin_grid

   !> Adds a field to a grid.
   pure subroutine add_field(grid, path, n_components, is_real, centre)
      type(xdmf_grid_t), intent(inout) :: grid         !< becomes longer by a field
      character(len=*), intent(in) :: path             !< the field is called as its dataset
      integer(ip), intent(in) :: n_components          !< 1 or 3
      logical, intent(in) :: is_real                   !< else it is of whole numbers
      character(len=*), intent(in) :: centre           !< CENTRE_NODE or CENTRE_CELL
      type(xdmf_field_t), allocatable :: longer(:)
      integer :: n

      n = size(grid%fields)
      allocate (longer(n + 1))
      longer(:n) = grid%fields
      longer(n + 1)%name = path(index(path, '/', back=.true.) + 1:)
      longer(n + 1)%path = path
      longer(n + 1)%centre = centre
      longer(n + 1)%n_components = n_components
      longer(n + 1)%n_values = merge(grid%n_cells, grid%n_points, centre == CENTRE_CELL)
      longer(n + 1)%is_real = is_real
      call move_alloc(longer, grid%fields)
   end subroutine add_field

   !> Begins the file: a collection over time, each time with its grids.
   subroutine begin_xdmf(program, warning, lines)
      character(len=*), intent(in) :: program          !< name and version
      character(len=*), intent(in) :: warning          !< why the run did not converge; '' when it did
      type(string_t), allocatable, intent(out) :: lines(:) !< of the file so far

      allocate (lines(0))
      call append_string(lines, '<?xml version="1.0" encoding="UTF-8"?>')
      call append_string(lines, '<Xdmf Version="2.0">')
      call append_string(lines, '<Domain>')
      call append_string(lines, information('program', program))
      if (len(warning) > 0) call append_string(lines, information('NOT CONVERGED', warning))
      call append_string(lines, '<Grid Name="steps" GridType="Collection" CollectionType="Temporal">')
   end subroutine begin_xdmf

   !> Adds a time.
   subroutine add_time(data_file, frame, lines)
      character(len=*), intent(in) :: data_file        !< the HDF5 file, without folder
      type(xdmf_frame_t), intent(in) :: frame          !< with all its grids and fields
      type(string_t), allocatable, intent(inout) :: lines(:) !< of the file; get those of the time
      integer :: i

      call append_string(lines, '<Grid Name="'//frame%name//'" GridType="Collection" CollectionType="Spatial">')
      call append_string(lines, '<Time Value="'//frame%time//'"/>')
      do i = 1, size(frame%grids)
         call add_grid(data_file, frame%grids(i), lines)
      end do
      call append_string(lines, '</Grid>')
   end subroutine add_time

   !> Closes what begin_xdmf opened.
   subroutine end_xdmf(lines)
      type(string_t), allocatable, intent(inout) :: lines(:) !< of the file, which is complete then

      call append_string(lines, '</Grid>')
      call append_string(lines, '</Domain>')
      call append_string(lines, '</Xdmf>')
   end subroutine end_xdmf

   pure function information(name, value) result(line)
      character(len=*), intent(in) :: name, value
      character(len=:), allocatable :: line

      line = '<Information Name="'//name//'" Value="'//xml_text(value)//'"/>'
   end function information

   subroutine add_grid(data_file, grid, lines)
      character(len=*), intent(in) :: data_file
      type(xdmf_grid_t), intent(in) :: grid
      type(string_t), allocatable, intent(inout) :: lines(:)
      integer :: i

      call append_string(lines, '<Grid Name="'//xml_text(grid%name)//'" GridType="Uniform">')
      call append_string(lines, '<Topology TopologyType="'//grid%topology//'" NumberOfElements="'//to_text(grid%n_cells)// &
                         '" NodesPerElement="'//to_text(grid%nodes_per_cell)//'">')
      call append_string(lines, data_item(data_file, grid%cells, [grid%n_cells, grid%nodes_per_cell], .false.))
      call append_string(lines, '</Topology>')
      call append_string(lines, '<Geometry GeometryType="XY">')
      call append_string(lines, data_item(data_file, grid%points, [grid%n_points, 2_ip], .true.))
      call append_string(lines, '</Geometry>')
      do i = 1, size(grid%fields)
         associate (field => grid%fields(i))
            call append_string(lines, '<Attribute Name="'//field%name//'" AttributeType="'// &
                               trim(merge('Scalar', 'Vector', field%n_components == 1))//'" Center="'//field%centre//'">')
            call append_string(lines, data_item(data_file, field%path, [field%n_values, field%n_components], field%is_real))
            call append_string(lines, '</Attribute>')
         end associate
      end do
      call append_string(lines, '</Grid>')
   end subroutine add_grid

   pure function data_item(data_file, path, sizes, is_real) result(line)
      character(len=*), intent(in) :: data_file, path
      integer(ip), intent(in) :: sizes(2)              !< rows, components
      logical, intent(in) :: is_real
      character(len=:), allocatable :: line

      line = '<DataItem Dimensions="'//to_text(sizes(1))
      if (sizes(2) > 1) line = line//' '//to_text(sizes(2))
      line = line//'" '//trim(merge('NumberType="Float" Precision="8"', 'NumberType="Int" Precision="4"  ', is_real))
      line = line//' Format="HDF">'//xml_text(data_file)//':'//path//'</DataItem>'
   end function data_item

   !> Text with the characters of XML's own replaced.
   pure function xml_text(text) result(xml)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: xml

      xml = recoded(text, '&<>"', [character(len=6) :: '&amp;', '&lt;', '&gt;', '&quot;'])
   end function xml_text

end module atrito_xdmf
