!> Why there is no solution where numbers are too large or too small for the machine: what the deck asks for is then not what was
!> solved, and whatever was found of free motions or contact is found of infinities and zeros.
module atrito_number_range
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_element_table, only: SHAPES
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_results, only: results_t
   use atrito_scene_data, only: scene_data_t
   use atrito_status, only: status_t, is_ok, reword_status, STATUS_NOT_CONVERGED, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: explain_range, is_out_of_range, range_text

   character(len=*), parameter :: BEGIN = 'numbers leave the range of the machine, 2.2e-308 to 1.8e308: '
   !> Sums of a few numbers up to MOST are numbers, and products of those from LEAST on have most of their digits.
   real(wp), parameter :: MOST = 1.0e304_wp, LEAST = 1.0e-292_wp
   real(wp), parameter :: LEAST_LENGTH = 1.0e-146_wp   !< its square is no less than LEAST

contains

   !> Puts the cause in the place of what was found without a solution.
   subroutine explain_range(data, results, status)
      type(scene_data_t), intent(in) :: data     !< the scene, with its loads
      type(results_t), intent(inout) :: results  !< its verdict may become the cause
      type(status_t), intent(inout) :: status    !< its text may become the cause; the code stays
      character(len=:), allocatable :: text

      text = range_text(data)
      if (len(text) == 0) return
      if (is_ok(status)) then
         results%verdict = text
         results%converged = .false.
      else if (status%code == STATUS_SINGULAR .or. status%code == STATUS_NOT_CONVERGED) then
         call reword_status(status, text)
      end if
   end subroutine explain_range

   !> Whether explain_range has told the cause.
   pure logical function is_out_of_range(results)
      type(results_t), intent(in) :: results     !< its verdict is read

      is_out_of_range = allocated(results%verdict)
      if (is_out_of_range) is_out_of_range = index(results%verdict, BEGIN) == 1
   end function is_out_of_range

   !> What of lengths, stiffnesses, forces and displacements is out of range; '' where none is.
   function range_text(data) result(text)
      type(scene_data_t), intent(in) :: data     !< mesh, materials, loads and displacements
      character(len=:), allocatable :: text
      real(wp) :: length, force, given, stiffness(2)
      integer(ip) :: e

      ! What the smallest element is across [L].
      length = huge(length)
      do e = 1, data%model%mesh%n_elements
         associate (x => data%model%mesh%x(:, data%model%mesh%nodes(:SHAPES(data%model%mesh%shape(e))%n_corners, e)))
            length = min(length, max(maxval(x(1, :)) - minval(x(1, :)), maxval(x(2, :)) - minval(x(2, :))))
         end associate
      end do
      stiffness = stiffness_range(data%model)
      force = largest_of(data%f)
      given = largest_of(data%value)
      if (length < LEAST_LENGTH) then
         text = 'an element is '//to_text(length, 3)//' [L] across, and its area is none of them'
      else if (.not. (stiffness(2) <= MOST .and. stiffness(1) >= LEAST)) then
         text = "Young's modulus times the thickness is "//to_text(stiffness(merge(1, 2, stiffness(1) < LEAST)), 3)//' [F/L]'
      else if (.not. force <= MOST) then
         text = 'forces at nodes are '//to_text(force, 3)//' [F]'
      else if (force > MOST*min(stiffness(1), 1.0_wp)) then
         text = 'forces of '//to_text(force, 3)//' [F] on a stiffness of '//to_text(stiffness(1), 3)//' [F/L]'
      else if (given > MOST .or. given > MOST/max(stiffness(2), 1.0_wp)) then
         text = 'prescribed displacements are '//to_text(given, 3)//' [L], on a stiffness of '//to_text(stiffness(2), 3)//' [F/L]'
      else if (maxval([data%model%interactions%nu, 0.0_wp]) > MOST/max(force, given*stiffness(2), 1.0_wp)) then
         text = 'the coefficient of friction is '//to_text(maxval(data%model%interactions%nu), 3)
      else
         text = ''
         return
      end if
      text = BEGIN//text//'; other units of length and force may help'
   end function range_text

   !> The least and the greatest modulus times thickness of the sections [F/L].
   pure function stiffness_range(model) result(bounds)
      type(model_t), intent(in) :: model
      real(wp) :: bounds(2), modulus(2)
      integer :: i, k

      bounds = [huge(bounds), 0.0_wp]
      do i = 1, size(model%sections)
         associate (section => model%sections(i))
            if (section%material == 0) cycle
            associate (material => model%materials(section%material))
               ! an incompressible one resists a change of its volume with much more
               modulus = [material%young, material%young/max(1.0_wp - 2.0_wp*material%poisson, 1.0e-3_wp)]
               if (material%is_orthotropic) modulus = [minval([(material%stiffness(k, k), k=1, size(material%stiffness, 1))]), &
                                                       maxval(abs(material%stiffness))]
            end associate
            if (section%thickness > 0.0_wp) modulus = modulus*section%thickness
            bounds = [min(bounds(1), modulus(1)), max(bounds(2), modulus(2))]
         end associate
      end do
   end function stiffness_range

   !> What is no number counts as the largest one.
   pure real(wp) function largest_of(values) result(largest)
      real(wp), intent(in) :: values(:, :)
      integer(ip) :: i

      largest = 0.0_wp
      do i = 1, size(values, 2, kind=ip)
         if (all(ieee_is_finite(values(:, i)))) then
            largest = max(largest, maxval(abs(values(:, i))))
         else
            largest = huge(largest)
         end if
      end do
   end function largest_of

end module atrito_number_range
