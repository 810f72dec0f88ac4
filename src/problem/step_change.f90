!> From one step of a history to the next: where prescribed displacements begin, and whether the form of the contact system changes.
!>
!> Within a step a prescribed displacement goes on from where it was at the end of the step before (`from`). What was free
!> before has no such value in the deck: it begins where the body has come to.
module atrito_step_change
   use atrito_controls, only: METHOD_ANDERSON
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, step_t
   implicit none (type, external)
   private
   public :: begin_from, changes_form

contains

   !> Whether a step asks for a method of the dense form and the one before does not, or the other way round.
   pure logical function changes_form(model, k)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: k

      changes_form = (model%steps(k)%controls%method == METHOD_ANDERSON) &
                     .neqv. (model%steps(k - 1)%controls%method == METHOD_ANDERSON)
   end function changes_form

   !> A displacement that is prescribed now and was free before begins where it is.
   pure subroutine begin_from(held_before, u, step)
      logical, intent(in) :: held_before(:, :)       !< (2, n_nodes)
      real(wp), intent(in) :: u(:, :)                !< (2, n_nodes) at the end of the step before [L]
      type(step_t), intent(inout) :: step            !< prescribed%from is replaced
      integer(ip) :: i

      associate (prescribed => step%prescribed)
         if (.not. allocated(prescribed%from)) allocate (prescribed%from(prescribed%n), source=0.0_wp)
         do i = 1, prescribed%n
            if (held_before(prescribed%dof(i), prescribed%node(i))) cycle
            prescribed%from(i) = u(prescribed%dof(i), prescribed%node(i))
         end do
      end associate
   end subroutine begin_from

end module atrito_step_change
