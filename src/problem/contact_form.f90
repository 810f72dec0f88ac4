!> The form of the contact system: the flexibility of all points, a dense matrix; or all bodies in one sparse matrix.
!>
!> With m unknown contact forces and n displacements the dense form (condensed/) keeps a matrix of m^2 numbers and takes
!> some m^3 operations a solution; the sparse form (multiplier/) takes some n operations times a large factor, as often
!> as it factors and solves. So the predicted costs are m^3 and 1e5 n, and the cheaper form is taken, unless one is
!> asked for, the method is one of the dense form, or the dense matrices (the flexibility, its scaled part, its factor)
!> would take more than half of the memory.
module atrito_contact_form
   use atrito_kinds, only: ip, lp, wp
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE, choose_contact_form, dense_bytes, can_be_dense, contact_form_name

   integer, parameter :: CONTACT_AUTO = 0, CONTACT_DENSE = 1, CONTACT_SPARSE = 2

   !> Operations of the dense form for each displacement that the sparse one takes in the same time, from layers of 200 to 3,000
   !> points, walls of 30 to 300 blocks and scene P (docs/performance.md).
   real(wp), parameter :: DENSE_FOR_SPARSE = 1.0e5_wp
   !> Unknowns up to which the dense form is tried where the sparse one does not converge: some seconds.
   integer(ip), parameter :: MOST_DENSE = 1000_ip

contains

   !> Chooses the form by its predicted cost, unless one is asked for, and says why.
   subroutine choose_contact_form(n_unknowns, n_displacements, asked, only_dense, memory, form, reason)
      integer(ip), intent(in) :: n_unknowns          !< contact forces
      integer(ip), intent(in) :: n_displacements     !< free dofs of all bodies
      integer, intent(in) :: asked                   !< CONTACT_*
      logical, intent(in) :: only_dense              !< the method is one of the dense form
      integer(lp), intent(in) :: memory              !< bytes there are
      integer, intent(out) :: form                   !< CONTACT_DENSE or CONTACT_SPARSE
      character(len=:), allocatable, intent(out) :: reason !< in words, for listing and screen
      real(wp) :: dense, sparse

      dense = real(n_unknowns, wp)**3
      sparse = DENSE_FOR_SPARSE*real(n_displacements, wp)
      if (asked /= CONTACT_AUTO) then
         form = asked
         reason = 'asked for'
      else if (n_unknowns == 0) then
         form = CONTACT_DENSE
         reason = 'there is no contact'
      else if (dense_bytes(n_unknowns) > memory/2) then
         form = CONTACT_SPARSE
         reason = 'the dense one does not fit into the memory'
      else if (only_dense) then
         form = CONTACT_DENSE
         reason = 'the method that is asked for is one of this form'
      else if (sparse < dense) then
         form = CONTACT_SPARSE
         reason = 'predicted cost '//to_text(sparse/dense, 2)//' of the dense one'
      else
         form = CONTACT_DENSE
         reason = 'predicted cost '//to_text(dense/sparse, 2)//' of the sparse one'
      end if
   end subroutine choose_contact_form

   !> The flexibility, its scaled part and its factor.
   elemental integer(lp) function dense_bytes(n_unknowns) result(bytes)
      integer(ip), intent(in) :: n_unknowns

      bytes = 3*8_lp*int(n_unknowns, lp)**2
   end function dense_bytes

   !> Whether the dense form is worth a try where the sparse one does not converge: up to MOST_DENSE unknowns it takes some seconds.
   elemental logical function can_be_dense(n_unknowns)
      integer(ip), intent(in) :: n_unknowns

      can_be_dense = n_unknowns <= MOST_DENSE
   end function can_be_dense

   !> A form of the contact system as tables and messages have it: `dense` or `sparse`.
   pure function contact_form_name(form) result(name)
      integer, intent(in) :: form !< CONTACT_DENSE or CONTACT_SPARSE
      character(len=:), allocatable :: name

      name = 'dense'
      if (form == CONTACT_SPARSE) name = 'sparse'
   end function contact_form_name

end module atrito_contact_form
