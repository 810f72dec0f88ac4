!> --show matrix: the skyline of each body, with its equations as the nodes come and as they are renumbered, and the band beside it.
module atrito_show_matrix
   use atrito_assembly, only: body_profile, fem_t
   use atrito_bodies, only: element_equations
   use atrito_kinds, only: ip
   use atrito_page, only: page_t, add_blank, add_heading, add_line, bytes, left, right
   use atrito_profile, only: profile_t, add_to_profile, banded_bytes, banded_flops, begin_profile, close_profile, half_bandwidth, &
                             largest_height, profile_length, skyline_bytes, skyline_flops
   use atrito_strings, only: append_string, to_text
   use atrito_table, only: table_t, add_integers, begin_table
   implicit none (type, external)
   private
   public :: view_matrix

   integer(ip), parameter :: MOST_ACROSS = 36             !< characters of a drawing, of which two stand side by side
   character(len=12), parameter :: COLUMNS(8) = [character(len=12) :: 'body', 'equation', 'node_before', 'dof_before', &
                                                                                             'first_before', 'node', 'dof', 'first']
   integer, parameter :: LABEL = 20, VALUE = 22      !< widths of the columns of numbers

   !> A body before its equations were numbered for the solver.
   type :: natural_t
      type(profile_t) :: profile
      integer(ip), allocatable :: number(:)          !< (equations of the body) the number of each as the nodes come
      integer(ip), allocatable :: equation(:)        !< and back
      integer(ip), allocatable :: node(:), dof(:)    !< of each: the user's number of the node
   end type natural_t

contains

   !> Page and table of all bodies.
   subroutine view_matrix(fem, page, table)
      type(fem_t), intent(in) :: fem
      type(page_t), intent(inout) :: page
      type(table_t), intent(out) :: table
      type(natural_t) :: before
      type(profile_t) :: after
      integer(ip), allocatable :: rows(:, :)        ! columns of the table
      integer(ip) :: b, j, k

      allocate (rows(8, 0))
      do b = 1, fem%bodies%n
         associate (body => fem%bodies%list(b))
            if (body%n == 0) cycle
            call number_naturally(fem, b, before)
            call body_profile(fem, b, after)
            call add_heading(page, 'matrix of body '//body%name//': '//to_text(body%n)//' equations, the last '// &
                             to_text(body%n_retained)//' of them contact')
            call add_numbers(before%profile, after, page)
            call add_drawings(before%profile, after, page)
            do j = 1, body%n
               k = before%equation(j)
               rows = reshape([rows, b, j, before%node(k), before%dof(k), before%profile%first(j), before%node(j), before%dof(j), &
                               after%first(j)], [8, size(rows, 2) + 1])
            end do
         end associate
      end do
      call begin_table(table, 'show-matrix', 'a row an equation of a body: as the nodes come (before), and renumbered', &
                       size(rows, 2, kind=ip))
      call append_string(table%remarks, 'first: row of the first entry of the column of the equation; its height is '// &
                         'equation - first + 1')
      do j = 1, size(COLUMNS, kind=ip)
         call add_integers(table, trim(COLUMNS(j)), rows(j, :))
      end do
   end subroutine view_matrix

   !> Numbers the equations of a body as its nodes stand in the mesh.
   subroutine number_naturally(fem, i_body, natural)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      type(natural_t), intent(out) :: natural
      integer(ip), allocatable :: equations(:)
      integer(ip) :: node, dof, n, k, i

      associate (body => fem%bodies%list(i_body))
         allocate (natural%number(body%n), natural%equation(body%n), natural%node(body%n), natural%dof(body%n))
         n = 0
         do node = 1, fem%mesh%n_nodes
            if (fem%bodies%of_node(node) /= i_body) cycle
            do dof = 1, 2
               k = fem%bodies%equation(dof, node)
               if (k <= 0) cycle
               n = n + 1
               natural%number(k) = n
               natural%equation(n) = k
               natural%node(k) = fem%mesh%node_id(node)
               natural%dof(k) = dof
            end do
         end do
         call begin_profile(natural%profile, body%n, 0_ip)
         do i = 1, size(body%elements, kind=ip)
            equations = element_equations(fem%mesh, fem%bodies, body%elements(i))
            where (equations > 0) equations = natural%number(max(equations, 1_ip))
            call add_to_profile(natural%profile, equations)
         end do
         call close_profile(natural%profile)
      end associate
   end subroutine number_naturally

   !> Both numberings side by side.
   subroutine add_numbers(before, after, page)
      type(profile_t), intent(in) :: before, after
      type(page_t), intent(inout) :: page

      call add_pair('', 'as the nodes come', 'renumbered')
      call add_pair('largest height', to_text(largest_height(before)), to_text(largest_height(after)))
      call add_pair('entries (skyline)', to_text(profile_length(before)), to_text(profile_length(after)))
      call add_pair('  storage', bytes(skyline_bytes(before)), bytes(skyline_bytes(after)))
      call add_pair('  operations', to_text(skyline_flops(before), 4), to_text(skyline_flops(after), 4))
      call add_pair('half-bandwidth', to_text(half_bandwidth(before)), to_text(half_bandwidth(after))//' (interior)')
      call add_pair('  storage (banded)', bytes(banded_bytes(before)), bytes(banded_bytes(after)))
      call add_pair('  operations', to_text(banded_flops(before), 4), to_text(banded_flops(after), 4))

   contains

      subroutine add_pair(name, one, two)
         character(len=*), intent(in) :: name, one, two

         call add_line(page, left(name, LABEL)//right(one, VALUE)//right(two, VALUE))
      end subroutine add_pair

   end subroutine add_numbers

   !> The upper triangles.
   pure subroutine add_drawings(before, after, page)
      type(profile_t), intent(in) :: before, after
      type(page_t), intent(inout) :: page
      integer(ip) :: i, wide, high

      wide = (before%n - 1)/MOST_ACROSS + 1             ! equations of a character
      high = 2*wide                                ! which is twice as high as wide
      call add_blank(page)
      do i = 1, before%n, high
         call add_line(page, line_of(before)//'     '//line_of(after))
      end do
      call add_line(page, '# in the profile, k of contact alone, . above it; a character: '//to_text(wide)//' x '// &
                    to_text(high))

   contains

      pure function line_of(profile) result(line)
         type(profile_t), intent(in) :: profile
         character(len=MOST_ACROSS) :: line
         integer(ip) :: j, c

         line = ''
         c = 0
         do j = 1, profile%n, wide
            c = c + 1
            associate (first => minval(profile%first(j:min(j + wide - 1, profile%n))), last => min(j + wide - 1, profile%n))
               if (i > last) then
                  line(c:c) = ' '
               else if (first > min(i + high - 1, profile%n)) then
                  line(c:c) = '.'
               else if (i > profile%n - profile%n_retained) then
                  line(c:c) = 'k'
               else
                  line(c:c) = '#'
               end if
            end associate
         end do
      end function line_of

   end subroutine add_drawings

end module atrito_show_matrix
