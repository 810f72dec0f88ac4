!> What the first rank does while it would wait for the parts of the others.
module atrito_errand
   use atrito_assembly, only: fem_t
   use atrito_shares, only: shares_t
   implicit none (type, external)
   private
   public :: errand_t

   type, abstract :: errand_t
   contains
      procedure(run_interface), deferred :: run
   end type errand_t

   abstract interface
      subroutine run_interface(self, fem, shares)
         import :: errand_t, fem_t, shares_t
         class(errand_t), intent(inout) :: self
         type(fem_t), intent(in) :: fem
         type(shares_t), intent(in) :: shares   !< of the ranks that factor
      end subroutine run_interface
   end interface

end module atrito_errand
