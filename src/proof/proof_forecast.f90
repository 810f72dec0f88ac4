!> What a bound and the run that it belongs to cost, told beforehand by counts alone, so that a scene is always judged the same way.
!>
!> The unit is about 1 microsecond of a processor; it is the ratio that counts. The numbers were measured on blocks of 120 x 60
!> elements with parallel sides and with others, of all kinds, and on arches and walls (docs/verification/error-bound.md).
module atrito_proof_forecast
   use atrito_assembly, only: fem_t
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_cut_elements, only: count_cells, side_cuts_t
   use atrito_element_classes, only: element_classes_t
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh_sides, only: mesh_sides_t
   implicit none (type, external)
   private
   public :: work_of_bound, work_of_run

   !> Of an element by corners (3, 4) and degree (1, 2): any one, and one that is like no other one besides.
   real(wp), parameter :: BOUND_OF_ALL(3:4, 2) = reshape([1.7_wp, 2.1_wp, 3.2_wp, 4.0_wp], [2, 2])
   real(wp), parameter :: BOUND_OF_OWN(3:4, 2) = reshape([5.0_wp, 7.8_wp, 12.5_wp, 26.0_wp], [2, 2])
   real(wp), parameter :: RUN_OF_ALL(3:4, 2) = reshape([1.8_wp, 2.4_wp, 6.7_wp, 9.0_wp], [2, 2])
   real(wp), parameter :: RUN_OF_OWN(3:4, 2) = reshape([1.5_wp, 2.7_wp, 6.6_wp, 12.0_wp], [2, 2])
   real(wp), parameter :: BOUND_OF_CELL(2) = [9.0_wp, 31.0_wp] !< of an element that is cut
   real(wp), parameter :: START = 8000.0_wp         !< of the process
   real(wp), parameter :: FACTOR = 1.0e-4_wp        !< of a full matrix, times the cube of its order
   !> Of a solve of the sparse form: share of what an element takes in a run, and a point.
   real(wp), parameter :: SOLVE_OF_ELEMENT = 0.3_wp, SOLVE_OF_POINT = 2.6_wp

contains

   !> Of one kind of tractions of contact.
   pure real(wp) function work_of_bound(fem, classes, sides, cuts) result(work)
      type(fem_t), intent(in) :: fem
      type(element_classes_t), intent(in) :: classes
      type(mesh_sides_t), intent(in) :: sides
      type(side_cuts_t), intent(in) :: cuts

      work = sum_over(fem, classes, BOUND_OF_ALL, BOUND_OF_OWN) + BOUND_OF_CELL(most_degree(fem))*count_cells(fem, sides, cuts)
   end function work_of_bound

   !> Of the run without a bound, and rather too little: increments before this one, and what is printed, are left out.
   pure real(wp) function work_of_run(fem, classes, n_points, form, n_solves) result(work)
      type(fem_t), intent(in) :: fem
      type(element_classes_t), intent(in) :: classes
      integer(ip), intent(in) :: n_points           !< of contact
      integer, intent(in) :: form                   !< CONTACT_*
      integer(ip), intent(in) :: n_solves           !< linear ones

      work = START + sum_over(fem, classes, RUN_OF_ALL, RUN_OF_OWN)
      if (form == CONTACT_SPARSE) then
         work = work + n_solves*(SOLVE_OF_ELEMENT*sum_over(fem, classes, RUN_OF_ALL, 0*RUN_OF_OWN) + SOLVE_OF_POINT*n_points)
      else
         work = work + FACTOR*(2.0_wp*n_points)**3
      end if
   end function work_of_run

   pure real(wp) function sum_over(fem, classes, of_all, of_own) result(work)
      type(fem_t), intent(in) :: fem
      type(element_classes_t), intent(in) :: classes
      real(wp), intent(in) :: of_all(3:, :), of_own(3:, :) !< (corners, degree)
      integer(ip) :: c, degree

      degree = most_degree(fem)
      work = 0.0_wp
      do c = 1, classes%n
         associate (corners => CORNERS_OF(fem%mesh%shape(classes%member(classes%first(c)))))
            work = work + of_own(corners, degree) + (classes%first(c + 1) - classes%first(c))*of_all(corners, degree)
         end associate
      end do
   end function sum_over

   pure integer(ip) function most_degree(fem)
      type(fem_t), intent(in) :: fem

      most_degree = maxval(DEGREE_OF(fem%mesh%shape(:fem%mesh%n_elements)))
   end function most_degree

end module atrito_proof_forecast
