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

contains

   !> Page and table of all bodies.
   subroutine view_matrix(fem, page, table)
      type(fem_t), intent(in) :: fem             !< bodies with their numbers
      type(page_t), intent(inout) :: page        !< gets the view
      type(table_t), intent(out) :: table        !< show-matrix
      type(profile_t) :: before, after
      integer(ip), allocatable :: rows(:, :), equation(:), node(:), dof(:)
      integer(ip) :: b, j, n

      allocate (rows(sum(fem%bodies%list%n), size(COLUMNS)))
      n = 0
      do b = 1, fem%bodies%n
         associate (body => fem%bodies%list(b))
            if (body%n == 0) cycle
            call number_naturally(fem, b, equation, node, dof, before)
            call body_profile(fem, b, after)
            call add_heading(page, 'matrix of body '//body%name//': '//to_text(body%n)//' equations, the last '// &
                             to_text(body%n_retained)//' of them contact')
            call add_numbers(before, after, page)
            call add_drawings(before, after, page)
            do j = 1, body%n
               rows(n + j, [1, 2, 3, 4, 5, 8]) = [b, j, node(j), dof(j), before%first(j), after%first(j)]
               rows(n + equation(j), 6:7) = [node(j), dof(j)]
            end do
            n = n + body%n
         end associate
      end do
      call begin_table(table, 'show-matrix', 'a row an equation of a body: as the nodes come (before), and renumbered', n)
      call append_string(table%remarks, 'first: row of the first entry of the column of the equation; its height is '// &
                         'equation - first + 1')
      do j = 1, size(COLUMNS, kind=ip)
         call add_integers(table, trim(COLUMNS(j)), rows(:n, j))
      end do
   end subroutine view_matrix

   !> The equations of a body as its nodes stand in the mesh, with the numbers of their nodes, and their profile.
   subroutine number_naturally(fem, i_body, equation, node, dof, profile)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      integer(ip), allocatable, intent(out) :: equation(:), node(:), dof(:)
      type(profile_t), intent(out) :: profile
      integer(ip), allocatable :: equations(:)
      integer(ip) :: number(fem%bodies%list(i_body)%n), i
      logical :: is_there(2, fem%mesh%n_nodes)

      associate (body => fem%bodies%list(i_body), all_equations => fem%bodies%equation)
         is_there = all_equations > 0 .and. spread(fem%bodies%of_node == i_body, 1, 2)
         equation = pack(all_equations, is_there)
         node = pack(spread(fem%mesh%node_id, 1, 2), is_there)
         dof = pack(spread([1_ip, 2_ip], 2, fem%mesh%n_nodes), is_there)
         number(equation) = [(i, i=1, body%n)]
         call begin_profile(profile, body%n, 0_ip)
         do i = 1, size(body%elements, kind=ip)
            equations = element_equations(fem%mesh, fem%bodies, body%elements(i))
            where (equations > 0) equations = number(max(equations, 1_ip))
            call add_to_profile(profile, equations)
         end do
         call close_profile(profile)
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
      call add_line(page, '# in the profile, k of contact alone, . above it; a character: '//to_text(wide)//' x '//to_text(high))

   contains

      pure function line_of(profile) result(line)
         type(profile_t), intent(in) :: profile
         character(len=MOST_ACROSS) :: line
         integer(ip) :: j, c

         line = ''
         do c = 1, (profile%n - 1)/wide + 1
            j = (c - 1)*wide + 1
            associate (last => min(j + wide - 1, profile%n))
               if (i > last) cycle
               line(c:c) = merge('.', merge('k', '#', i > profile%n - profile%n_retained), &
                                 minval(profile%first(j:last)) > i + high - 1)
            end associate
         end do
      end function line_of

   end subroutine add_drawings

end module atrito_show_matrix
