!> The rows of history.tab: what each pair transmits at the end of an increment.
module atrito_history_rows
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_points, only: contact_points_t
   use atrito_results, only: contact_result_t, history_row_t, results_t, POINT_OPEN, POINT_STICK, POINT_SLIP
   implicit none (type, external)
   private
   public :: row_of_pair

contains

   !> The row of one pair.
   pure type(history_row_t) function row_of_pair(points, results, pair, dissipation) result(row)
      type(contact_points_t), intent(in) :: points   !< directions of the points of this pair
      type(results_t), intent(in) :: results         !< of the increment
      integer(ip), intent(in) :: pair                !< place in the list of pairs
      real(wp), intent(in) :: dissipation            !< from the beginning of the history [F L]
      real(wp) :: force(2), of_s
      integer(ip) :: j

      row%step = results%step
      row%increment = results%increment
      row%time = results%time
      row%pair = pair
      row%dissipation = dissipation
      row%elastic_energy = results%strain_energy
      row%unique_up_to_nu = results%uniqueness%up_to_nu
      row%index = results%uniqueness%index
      associate (c => results%contact(pair))
         row%open = count(c%status == POINT_OPEN, kind=ip)
         row%stick = count(c%status == POINT_STICK, kind=ip)
         row%slip = count(c%status == POINT_SLIP, kind=ip)
         if (c%n > 0) row%max_pressure = maxval(c%pressure(:c%n))
         if (c%n > 0) row%mean_slip = dot_product(c%weight(:c%n), c%slip(:c%n))/sum(c%weight(:c%n))
         ! Of the tractions on the slave, -p n + sigma_T T.
         of_s = 0.0_wp
         do j = 1, c%n
            associate (n => c%normal(:, j), p => c%pressure(j), w => c%weight(j))
               force = w*(c%shear(j)*[-n(2), n(1)] - p*n)
               row%normal = row%normal + w*p
               row%shear = row%shear + w*c%shear(j)
               row%moment = row%moment + (c%x(1, j)*force(2) - c%x(2, j)*force(1))
               of_s = of_s + w*p*c%s(j)
               if (p > 0.0_wp) row%length = row%length + points%length(j)
            end associate
         end do
         row%centre = ieee_value(1.0_wp, ieee_quiet_nan)
         if (row%normal > 0.0_wp) row%centre = of_s/row%normal
      end associate
   end function row_of_pair

end module atrito_history_rows
