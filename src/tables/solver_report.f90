!> How a run was solved: solver and libraries, increments and iterations; sections 3 and 4 of the listing.
module atrito_solver_report
   use atrito_increments, only: increment_t, increment_name, list_increments, time_text
   use atrito_kinds, only: ip, wp
   use atrito_libraries, only: library_t, list_libraries
   use atrito_page, only: page_t, add_blank, add_entry, add_line, add_paragraph, number, right
   use atrito_results, only: unsettled_t, results_t, history_t, scene_t, last_frame
   use atrito_scene_report, only: describe_bodies
   use atrito_strings, only: to_text
   use atrito_summary, only: closed_word, uniqueness_text
   implicit none (type, external)
   private
   public :: describe_solver, describe_increments, describe_iterations, list_used_libraries

   integer, parameter :: DIGITS = 6                 !< of numbers for people
   real(wp), parameter :: LEAST_CONTRACTION = 1.0e-6_wp      !< below it nothing couples pressure and friction but round-off

contains

   !> How the bodies were factored, and by which libraries.
   subroutine describe_solver(page, history, results)
      type(page_t), intent(inout) :: page           !< the lines are added to it
      type(history_t), intent(in) :: history        !< factorisations are read
      type(results_t), intent(in) :: results        !< the last of it
      type(library_t), allocatable :: list(:)
      integer :: i

      call describe_bodies(page, results%scene, factored=.true., some=.false.)
      if (uses(results%scene, 'skyline') .or. uses(results%scene, 'banded')) then
         call add_entry(page, 'order', 'reverse Cuthill-McKee, contact nodes last')
      end if
      if (uses(results%scene, 'sparse')) call add_entry(page, 'order of sparse bodies', 'nested dissection, contact nodes last')
      call add_entry(page, 'factorisations', to_text(max(history%factorisations, int(results%factorisations, ip))))
      call add_entry(page, 'linear solves of the line', to_text(int(results%linear_solves, ip)))
      call list_used_libraries(results%scene, list)
      do i = 1, size(list)
         call add_entry(page, trim(list(i)%name), list(i)%version)
      end do
   end subroutine describe_solver

   !> A row an increment; its iterations are in iterations.tab.
   subroutine describe_increments(page, history)
      type(page_t), intent(inout) :: page    !< the lines are added to it
      type(history_t), intent(in) :: history !< with all frames; it is not empty
      type(increment_t), allocatable :: list(:)
      character(len=:), allocatable :: name_of_last
      integer :: i

      list = list_increments(history)
      associate (last => history%frames(last_frame(history)))
         name_of_last = increment_name(last%step, last%increment, last%time)
      end associate
      call add_line(page, right('step', 8)//right('increment', 11)//right('time', 18)//right('outer iterations', 18)// &
                    right('residual', 14))
      do i = 1, size(list)
         call add_line(page, right(to_text(list(i)%step), 8)//right(to_text(list(i)%increment), 11)// &
                       right(time_text(list(i)%time), 18)//right(to_text(list(i)%outer), 18)// &
                       right(number(list(i)%residual, 4), 14))
      end do
      call add_blank(page)
      call add_line(page, '   of the last increment that is printed, '//name_of_last//':')
      call add_blank(page)
   end subroutine describe_increments

   !> Outer and inner iterations, what is known of other solutions, and points that did not settle.
   subroutine describe_iterations(page, results)
      type(page_t), intent(inout) :: page    !< the lines are added to it
      type(results_t), intent(in) :: results !< of one increment
      character(len=:), allocatable :: unique
      integer :: i

      call add_entry(page, 'outer iterations', to_text(int(results%outer_iterations, ip)))
      if (results%contraction > 0.0_wp) call add_entry(page, 'contraction, measured', number(results%contraction, 3))
      unique = uniqueness_text(results%uniqueness)
      if (len(unique) > 0) call add_entry(page, 'uniqueness', unique)
      if (results%contraction_estimate > LEAST_CONTRACTION) then
         call add_entry(page, 'contraction, estimated', number(results%contraction_estimate, 3) &
                        //'; from 1 on there may be several solutions')
      end if
      if (allocated(results%verdict)) call add_entry(page, 'outcome', results%verdict)
      if (.not. allocated(results%iterations)) return
      if (size(results%iterations) == 0) return
      call add_blank(page)
      call add_line(page, right('outer', 8)//right('inner', 6)//right('open', 7)//right('stick', 7)// &
                    right(closed_word(results%scene), 7)//right('d displ.', 11)// &
                    right('d press.', 11)//right('d frict.', 11)//right('residual', 11))
      do i = 1, size(results%iterations)
         associate (row => results%iterations(i))
            call add_line(page, right(to_text(row%outer), 8)//right(to_text(row%inner), 6)//right(to_text(row%open), 7)// &
                          right(to_text(row%stick), 7)//right(to_text(row%slip), 7)// &
                          right(number(row%change_displacement, 4), 11)//right(number(row%change_pressure, 4), 11)// &
                          right(number(row%change_friction, 4), 11)//right(number(row%residual, 4), 11))
         end associate
      end do
      if (allocated(results%unsettled)) call add_unsettled(page, results%unsettled)
   end subroutine describe_iterations

   !> All points that changed their states in the last outer iterations.
   subroutine add_unsettled(page, unsettled)
      type(page_t), intent(inout) :: page
      type(unsettled_t), intent(in) :: unsettled(:)
      integer :: i

      if (size(unsettled) == 0) return
      call add_blank(page)
      call add_paragraph(page, &
                         'Points that are unsettled, with their states at the end of the last outer iterations, oldest first: ' &
                         //'o open, = sticking, + slipping along T, - against it, c closed without friction', 3)
      call add_line(page, right('pair', 8)//right('point', 7)//right('node', 10)//right('x', 16)//right('y', 16)//'   states')
      do i = 1, size(unsettled)
         associate (c => unsettled(i))
            call add_line(page, right(to_text(c%pair), 8)//right(to_text(c%point), 7)//right(to_text(c%node), 10)// &
                          right(number(c%x(1), DIGITS), 16)//right(number(c%x(2), DIGITS), 16)//'   '//c%states)
         end associate
      end do
   end subroutine add_unsettled

   !> Compiler and libraries; those that this run did not use are told so.
   subroutine list_used_libraries(scene, list)
      type(scene_t), intent(in) :: scene                   !< its bodies and their orders are read
      type(library_t), allocatable, intent(out) :: list(:) !< name and version, or that it was not used
      logical :: is_by_metis                               ! any order of elimination
      integer :: i

      is_by_metis = .false.
      if (allocated(scene%order)) is_by_metis = index(scene%order, 'METIS') > 0
      do i = 1, size(scene%bodies)
         if (allocated(scene%bodies(i)%order)) is_by_metis = is_by_metis .or. index(scene%bodies(i)%order, 'METIS') > 0
      end do
      call list_libraries(.true., list, is_by_metis)
   end subroutine list_used_libraries

   !> Whether any body has a solver.
   pure logical function uses(scene, solver)
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: solver       !< skyline, ...
      integer :: i

      uses = .false.
      do i = 1, size(scene%bodies)
         if (.not. allocated(scene%bodies(i)%solver)) cycle
         uses = uses .or. scene%bodies(i)%solver == solver
      end do
   end function uses

end module atrito_solver_report
