!> A look inside, --show: how an element, the matrices, the contact line and its iterations of a small scene are made.
!>
!> Each increment hands over what it has just made (viewer_t), nothing is computed again, and where nobody asks nothing is kept.
!> What is shown is that of the last increment, but for the states, which are those of all.
module atrito_show
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_contact_solution, only: contact_solution_t
   use atrito_kinds, only: ip
   use atrito_mesh, only: find_element
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_page, only: page_t, begin_page
   use atrito_plane_state, only: STATES
   use atrito_results, only: results_t
   use atrito_scene_data, only: scene_data_t, viewer_t
   use atrito_show_element, only: view_element
   use atrito_show_law, only: view_law
   use atrito_show_line, only: view_line
   use atrito_show_loop, only: add_states, states_t, view_picard, view_states
   use atrito_show_matrix, only: view_matrix
   use atrito_status, only: status_t, set_status, STATUS_USAGE
   use atrito_strings, only: string_t, to_text
   use atrito_table, only: table_t
   implicit none (type, external)
   private
   public :: show_t, is_view

   integer(ip), parameter :: MOST_EQUATIONS = 4000, MOST_POINTS = 200  !< of a scene whose matrices, contact line are shown
   character(len=*), parameter :: ELEMENT = 'element='
   character(len=6), parameter :: VIEWS(5) = ['matrix', 'line  ', 'states', 'law   ', 'picard']

   !> Who looks at the increments of --show (viewer_t).
   type, extends(viewer_t) :: show_t
      type(string_t), allocatable :: views(:)        !< as the user asked for them
      type(page_t) :: page                           !< for the screen
      type(table_t) :: tables(7)                     !< of each name one
      integer :: n_tables = 0                        !< tables in use
      type(states_t) :: states                       !< of all increments so far
   contains
      procedure :: check => check_views
      procedure :: view => view_all
   end type show_t

contains

   !> Whether the word is a view: `matrix`, `element=12`.
   pure logical function is_view(word)
      character(len=*), intent(in) :: word           !< as the user wrote it

      is_view = any(VIEWS == word) .or. element_of(word) > 0
   end function is_view

   !> The number of an element; 0 of another view.
   pure integer(ip) function element_of(word) result(id)
      character(len=*), intent(in) :: word
      integer :: outcome

      id = 0
      if (index(word, ELEMENT) /= 1) return
      call read_integer(word(len(ELEMENT) + 1:), id, outcome)
      if (outcome /= NUMBER_OK) id = 0
   end function element_of

   !> Whether the scene has what is to be seen, and is small.
   subroutine check_views(self, data, status)
      class(show_t), intent(inout) :: self
      class(scene_data_t), intent(in) :: data
      type(status_t), intent(inout) :: status
      character(len=:), allocatable :: reason
      integer :: i
      integer(ip) :: e

      self%states = states_t()                       ! nothing of the mesh before
      self%n_tables = 0
      do i = 1, size(self%views)
         reason = ''
         associate (view => self%views(i)%s)
            if (element_of(view) > 0) then
               e = find_element(data%fem%mesh, element_of(view))
               if (e == 0) then
                  associate (ids => data%fem%mesh%element_id(:data%fem%mesh%n_elements))
                     reason = 'there is no such element; they are '//to_text(minval(ids))//' to '//to_text(maxval(ids))
                  end associate
               else if (STATES(data%fem%mesh%state(e))%has_hoop) then
                  reason = 'the element is axisymmetric; those in the plane can be seen'
               end if
            else if (view == 'matrix') then
               if (.not. all(data%fem%bodies%list%by_profile)) then
                  reason = 'no body is numbered for a profile; with --solver skyline one is'
               else if (maxval(data%fem%bodies%list%n) > MOST_EQUATIONS) then
                  reason = 'a body has '//to_text(maxval(data%fem%bodies%list%n))//' equations; '//to_text(MOST_EQUATIONS)// &
                           ' at most can be seen'
               end if
            else if (data%line%n == 0) then
               reason = 'the scene has no contact'
            else if (data%line%n > MOST_POINTS) then
               reason = 'there are '//to_text(data%line%n)//' contact points; '//to_text(MOST_POINTS)//' at most can be seen'
            else if (data%contact_form == CONTACT_SPARSE .and. view /= 'law') then
               reason = 'the sparse form of the contact system has none; --contact dense has'
            end if
            if (len(reason) > 0) call set_status(status, STATUS_USAGE, '--show '//view//': '//reason)
         end associate
      end do
   end subroutine check_views

   !> What the last increment made, in place of what the one before made.
   subroutine view_all(self, data, results, solution)
      class(show_t), intent(inout) :: self
      class(scene_data_t), intent(in) :: data
      type(results_t), intent(in) :: results
      type(contact_solution_t), intent(in) :: solution
      type(table_t) :: table, motions
      integer :: i

      call begin_page(self%page, 79)
      self%n_tables = 0
      call add_states(results, solution, self%states)
      do i = 1, size(self%views)
         select case (self%views(i)%s)
         case ('matrix')
            call view_matrix(data%fem, self%page, table)
         case ('line')
            if (.not. allocated(data%flexibility)) cycle
            call view_line(data%flexibility, data%line, solution, self%page, table, motions)
            if (motions%n_rows > 0) call keep_table(motions, self)
         case ('states')
            call view_states(self%states, self%page, table)
         case ('picard')
            call view_picard(data%line, data%points, results, solution, self%page, table)
         case ('law')
            if (.not. allocated(results%contact)) cycle
            call view_law(data%line, results, self%page, table)
         case default
            call view_element(data%fem, find_element(data%fem%mesh, element_of(self%views(i)%s)), self%page, table)
         end select
         call keep_table(table, self)
      end do
   end subroutine view_all

   subroutine keep_table(table, show)
      type(table_t), intent(in) :: table
      type(show_t), intent(inout) :: show
      integer :: i

      do i = 1, show%n_tables
         if (show%tables(i)%name == table%name) return    ! asked for twice, or of a second element
      end do
      show%n_tables = show%n_tables + 1
      show%tables(show%n_tables) = table
   end subroutine keep_table

end module atrito_show
