!> What a careful user should know of a solution, told as warnings and notes.
module atrito_solution_warnings
   use atrito_blas_info, only: is_reference_blas
   use atrito_body_motions, only: find_moved_body, motion_text
   use atrito_condensed_body, only: hourglass_text
   use atrito_contact_solution, only: contact_solution_t
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_hourglass, only: worst_hourglass
   use atrito_kinds, only: ip, wp
   use atrito_linear_limits, only: warn_of_large
   use atrito_messages, only: add_warning
   use atrito_model, only: model_t
   use atrito_results, only: results_t
   use atrito_scene_data, only: scene_data_t
   use atrito_shared_points, only: note_shared_points
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: warn, idle_text

   real(wp), parameter :: MANY_DIGITS = 10.0_wp             !< lost digits worth a warning
   real(wp), parameter :: MUCH_LOST = 1.0e8_wp              !< condition of the contact line worth a warning
   real(wp), parameter :: LARGE_FRICTION = 3.0_wp           !< from here on other solutions have been seen
   real(wp), parameter :: LARGE_HOURGLASS = 1.0_wp          !< as much strain energy as is seen is not

contains

   !> What a careful user should know of a solution.
   subroutine warn(data, solution, results, idle)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(in) :: results
      character(len=*), intent(in) :: idle                 !< which motions nothing determines (idle_text); '': none
      integer(ip) :: b

      if (is_reference_blas()) call add_warning('W-BLAS', 'this program was linked with the reference BLAS; with OpenBLAS' &
                                                //' it is about three times as fast')
      if (len(idle) > 0) call add_warning('W-IDLE', idle//': no load does it and nothing prevents it; the least motion is given')
      do b = 1, size(results%scene%bodies, kind=ip)
         associate (body => results%scene%bodies(b))
            if (body%digits_lost > MANY_DIGITS) call add_warning('W-DIGITS', 'body '//body%name//': the pivot of node ' &
                              //to_text(body%worst_node)//' dof '//to_text(body%worst_dof)//' lost '//to_text(body%digits_lost, 3) &
                                        //' digits: a very slender or nearly incompressible body, or one that is barely held there')
         end associate
      end do
      if (solution%inner%condition > MUCH_LOST) call add_warning('W-DIGITS', 'the equations of the contact line lose ' &
                                                     //to_text(log10(solution%inner%condition), 3)//' digits of 16: a stiff slave' &
                                                                 //' with more points than its soft master has nodes, or points' &
                                                                 //' that are almost one')
      call warn_of_hourglass(data, results)
      call note_shared_points(data%fem%mesh, data%rows, data%line, solution)
      call warn_of_others(data%model, results)
      call warn_of_large(results, data%model%asks_nlgeom)
   end subroutine warn

   !> 'body BLOCK is free to move along x1', where a motion of a solution is not determined; else ''.
   function idle_text(data, solution) result(text)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      character(len=:), allocatable :: text
      real(wp) :: mode(3)
      integer(ip) :: b

      text = ''
      if (.not. allocated(solution%inner%undetermined)) return
      call find_moved_body(data%fem%bodies, solution%inner%undetermined, b, mode)
      text = motion_text(data%fem, b, mode)
   end function idle_text

   !> Elements of reduced integration that contact alone keeps in shape, and rows of them whose displacements are for a good part
   !> what their points do not see.
   subroutine warn_of_hourglass(data, results)
      type(scene_data_t), intent(in) :: data
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: text
      real(wp) :: ratio
      integer(ip) :: b, element

      if (.not. allocated(results%u) .or. .not. allocated(data%fem%bodies%list)) return
      do b = 1, data%fem%bodies%n
         text = hourglass_text(data%fem, b)
         if (len(text) > 0) then
            call add_warning('W-HOURGLASS', text//': here contact or joints alone do')
            cycle
         end if
         call worst_hourglass(data%fem, data%fem%bodies%list(b), results%u, ratio, element)
         if (ratio <= LARGE_HOURGLASS) cycle
     call add_warning('W-HOURGLASS', 'body '//data%fem%bodies%list(b)%name//': elements in one row take the shape that reduced '// &
                         'integration hardly feels, an hourglass, most of all element '//to_text(element)//': full integration '// &
                          'would see '//to_text(ratio, 2)//' times the strain energy in it; CPE8 or CPS8 there, or more rows')
      end do
   end subroutine warn_of_hourglass

   !> Whether there may be other solutions.
   subroutine warn_of_others(model, results)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: measured
      real(wp) :: nu

      nu = maxval([pack(model%interactions%nu, model%interactions%friction /= FRICTION_NONE), 0.0_wp])
      if (results%contraction_estimate < 1.0_wp .and. nu < LARGE_FRICTION) return
      measured = ' (estimated contraction of the outer loop '//to_text(results%contraction_estimate, 3)
      if (results%contraction > 0.0_wp) measured = measured//', measured '//to_text(results%contraction, 3)
      if (results%contraction_estimate >= 1.0_wp) then
         call add_warning('W-UNIQUE', 'friction coefficient '//to_text(nu)//': there may be other solutions than the one found;' &
                          //' one alone is expected below '//to_text(nu/results%contraction_estimate, 3)//measured//')')
      else
         call add_warning('W-UNIQUE', 'friction coefficient '//to_text(nu)//': there may be other solutions than the one found' &
                          //measured//'; below 1 others are rare)')
      end if
   end subroutine warn_of_others

end module atrito_solution_warnings
