!> Strain energy beside half of the work of loads, supports and contact: what is stored in linear bodies is half of what forces do
!> that grow with their displacements, U = (f.u + q.B u)/2, so a listing can be checked by adding up.
module atrito_energy_report
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_page, only: page_t, add_entry, number
   use atrito_results, only: results_t
   use atrito_summary, only: pair_count, scales_t
   implicit none (type, external)
   private
   public :: energies_t, find_energies, describe_energies

   !> Halves of works, on the way from the bodies as they were drawn [F L].
   type :: energies_t
      real(wp) :: strain = 0.0_wp                !< of all bodies
      real(wp) :: external = 0.0_wp              !< of loads and supports
      real(wp) :: friction = 0.0_wp              !< of the shears
      real(wp) :: pressure = 0.0_wp              !< of the pressures: over initial gaps, and in what a penalty lets in
      real(wp) :: rest = 0.0_wp                  !< strain less all others
      real(wp) :: scale = 0.0_wp                 !< sum of the sizes of the parts of all of them
   end type energies_t

   integer, parameter :: DIGITS = 6
   real(wp), parameter :: AGREES = 1.0e-3_wp     !< of the scale
   real(wp), parameter :: ROUND_OFF = 1.0e-12_wp !< of the scale: no work

contains

   !> Adds up what the points of a frame tell.
   pure type(energies_t) function find_energies(model, results) result(found)
      type(model_t), intent(in) :: model     !< gaps of the points before the loads are read
      type(results_t), intent(in) :: results !< of one increment
      real(wp) :: parts
      integer(ip) :: i

      found%strain = results%strain_energy
      found%external = 0.5_wp*results%external_work
      if (.not. are_numbers(results)) return
      parts = abs(found%strain) + abs(found%external)
      do i = 1, merge(pair_count(results), 0_ip, allocated(model%points))
         associate (c => results%contact(i), n => results%contact(i)%n)
            found%friction = found%friction + 0.5_wp*sum(c%weight(:n)*c%shear(:n)*c%slip(:n))
            associate (done => 0.5_wp*c%weight(:n)*c%pressure(:n)*(c%gap(:n) - model%points(i)%gap(:n)))
               found%pressure = found%pressure + sum(done)
               parts = parts + sum(abs(done))
            end associate
         end associate
      end do
      found%rest = found%strain - found%external - found%friction - found%pressure
      found%scale = parts + abs(found%friction)
   end function find_energies

   !> Whether the energies are within the range of numbers: forces of 1e200 times displacements may not be.
   pure logical function are_numbers(results)
      type(results_t), intent(in) :: results

      are_numbers = ieee_is_finite(results%strain_energy) .and. ieee_is_finite(results%external_work)
   end function are_numbers

   !> A line each, and whether they add up.
   subroutine describe_energies(page, model, results, scales)
      type(page_t), intent(inout) :: page    !< the lines are added to it
      type(model_t), intent(in) :: model     !< gaps of the points, temperatures
      type(results_t), intent(in) :: results !< of one increment
      type(scales_t), intent(in) :: scales   !< of the history: what is nothing beside them is 0
      type(energies_t) :: e
      character(len=:), allocatable :: reasons
      integer :: i

      e = find_energies(model, results)
      if (.not. are_numbers(results)) then
         call add_energy('strain energy', e%strain)
         call add_energy('half of the external work', e%external)
         return
      end if
      if (e%scale <= ROUND_OFF*scales%force*scales%displacement) e = energies_t()
      call add_energy('strain energy', e%strain)
      call add_energy('half of the external work', e%external)
      if (abs(e%friction) > ROUND_OFF*e%scale) call add_energy('half of the work of friction', e%friction)
      if (abs(e%pressure) > ROUND_OFF*e%scale) call add_energy('half of the work of pressures', e%pressure)
      if (abs(e%rest) <= AGREES*e%scale) then
         if (e%scale > 0.0_wp) call add_entry(page, 'the energy and these works', 'agree to '// &
                                              number(abs(e%rest)/e%scale, 2)//' of the largest')
         return
      end if
      reasons = ''
      if (allocated(results%row_force)) then
         if (size(results%row_force) > 0) reasons = ', springs, ties and equations'
      end if
      if (allocated(results%rigid)) reasons = reasons//', surfaces that move'
      if (any([(allocated(model%steps(i)%heating), i=1, size(model%steps))])) reasons = reasons//', temperatures'
      if (len(reasons) == 0) reasons = ', more than round-off'
      call add_entry(page, 'the energy less these works', number(e%rest, DIGITS)//' [F L]: '//reasons(3:))

   contains

      subroutine add_energy(name, value)
         character(len=*), intent(in) :: name
         real(wp), intent(in) :: value

         call add_entry(page, name, number(merge(0.0_wp, value, abs(value) <= ROUND_OFF*e%scale), DIGITS)//' [F L]')
      end subroutine add_energy

   end subroutine describe_energies

end module atrito_energy_report
