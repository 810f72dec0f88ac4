!> The next friction bound of the outer loop, from the bounds that went in and those that came out.
!>
!> The loop seeks a fixed point x = g(x) of a map that is not differentiable where points change their states, and costs a QP each
!> time it is evaluated. f = g(x) - x is the residual.
!>
!>     Picard      x <- x + relaxation f. With relaxation 1 the iteration of the existence proof, which contracts for small nu.
!>     Anderson    with the last differences dX of bounds and dF of residuals, gamma = argmin |f - dF gamma|, and
!>                 x <- x + mixing f - (dX + mixing dF) gamma                 (D. G. Anderson, J. ACM 12 (1965) 547-560, type II)
!>
!> Were g linear, Anderson's mixing with a full memory would be GMRES on (I - g') x = g(0); with memory 5 it mostly takes fewer
!> iterations than Picard's. The least squares leave out directions of dF that are nearly the same, so that old differences do no
!> harm. Bounds are not negative: what comes out below 0 is 0. Where a bound holds no body the memory is forgotten.
module atrito_accelerator
   use atrito_dense, only: least_squares
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: accelerator_t, picard_t, anderson_t

   !> Fixed point x = g(x) of a map with values >= 0.
   !>
   !> What extends it decides on the next x from those that were tried. `reset` comes before the first one, and when the iteration
   !> has jumped to another place.
   type, abstract :: accelerator_t
   contains
      procedure(reset_accelerator), deferred :: reset
      procedure(next_iterate), deferred :: update
   end type accelerator_t

   abstract interface
      !> Forgets what went before.
      subroutine reset_accelerator(self)
         import :: accelerator_t
         class(accelerator_t), intent(inout) :: self
      end subroutine reset_accelerator

      !> The next x, >= 0.
      subroutine next_iterate(self, x, g, next)
         import :: accelerator_t, wp
         class(accelerator_t), intent(inout) :: self
         real(wp), intent(in) :: x(:), g(:)           !< x and its image
         real(wp), intent(out) :: next(:)
      end subroutine next_iterate
   end interface

   !> x <- x + relaxation (g - x), the paper's.
   !>
   !> relaxation < 1 damps a map that turns, at the price of more iterations where it contracts.
   type, extends(accelerator_t) :: picard_t
      real(wp) :: relaxation = 1.0_wp !< omega > 0, of the step to the image; 1: the whole of it
   contains
      procedure :: reset => reset_picard
      procedure :: update => update_picard
   end type picard_t

   integer(ip), parameter :: MEMORY = 5

   !> Anderson's mixing of the last differences (1965), type II, memory 5: the combination of the last residuals that is least.
   type, extends(accelerator_t) :: anderson_t
      real(wp) :: mixing = 1.0_wp                     !< of the residual that the combination leaves; 1: the whole of it
      real(wp) :: least = 0.0_wp                      !< of the values
      integer(ip) :: held = 0                         !< differences held
      real(wp), allocatable :: dx(:, :), df(:, :)     !< (n, MEMORY)
      real(wp), allocatable :: last_x(:), last_f(:)   !< (n) the last x, and g - x there
   contains
      procedure :: reset => reset_anderson
      procedure :: update => update_anderson
   end type anderson_t

contains

   subroutine reset_picard(self)
      class(picard_t), intent(inout) :: self

      if (self%relaxation <= 0.0_wp) self%relaxation = 1.0_wp
   end subroutine reset_picard

   !> next = g with relaxation 1, to the last digit.
   subroutine update_picard(self, x, g, next)
      class(picard_t), intent(inout) :: self
      real(wp), intent(in) :: x(:), g(:)
      real(wp), intent(out) :: next(:)

      next = x + self%relaxation*(g - x)
      if (self%relaxation == 1.0_wp) next = g
   end subroutine update_picard

   subroutine reset_anderson(self)
      class(anderson_t), intent(inout) :: self

      self%held = 0
      if (allocated(self%last_x)) deallocate (self%last_x, self%last_f)
   end subroutine reset_anderson

   !> gamma = argmin |f - dF gamma|; next = x + mixing f - (dX + mixing dF) gamma, and not below 0.
   !>
   !> Why that helps. On a line g the residual at x - dX gamma would be f - dF gamma, for any gamma: a combination of the last
   !> bounds has the same combination of their residuals. So the least squares choose the place where the residual is least, as far
   !> as the last six bounds tell, and the step from there is Picard's, with what residual is left:
   !>
   !>     x' = x - dX gamma,     f' = f - dF gamma,     next = x' + mixing f'.
   !>
   !> With one difference and one unknown it is the secant method. Columns of dF that agree to 1e-10 of the largest singular value
   !> give no direction of their own. The cost, some 2 n 5^2 operations, is nothing beside the QP that gave g.
   subroutine update_anderson(self, x, g, next)
      class(anderson_t), intent(inout) :: self
      real(wp), intent(in) :: x(:), g(:)
      real(wp), intent(out) :: next(:)
      real(wp), parameter :: DEPENDENT = 1.0e-10_wp   !< differences closer than this do not count twice
      real(wp) :: f(size(x))
      real(wp), allocatable :: gamma(:)
      integer(ip) :: rank, info

      f = g - x
      if (allocated(self%last_x)) call hold(self, x - self%last_x, f - self%last_f)
      self%last_x = x
      self%last_f = f
      next = x + self%mixing*f
      if (self%held > 0) then
         allocate (gamma(self%held))
         call least_squares(self%df(:, :self%held), f, gamma, DEPENDENT, rank, info)
         if (info == 0) next = next - matmul(self%dx(:, :self%held) + self%mixing*self%df(:, :self%held), gamma)
      end if
      next = max(next, self%least)
   end subroutine update_anderson

   !> Holds one more difference; the oldest goes.
   !>
   !> Column 1 is the newest: dx = x_k - x_(k-1), df = f_k - f_(k-1).
   subroutine hold(self, dx, df)
      class(anderson_t), intent(inout) :: self
      real(wp), intent(in) :: dx(:), df(:)

      if (.not. allocated(self%dx)) allocate (self%dx(size(dx), MEMORY), self%df(size(dx), MEMORY), source=0.0_wp)
      self%held = min(self%held + 1, MEMORY)
      self%dx(:, 2:) = self%dx(:, :MEMORY - 1)
      self%df(:, 2:) = self%df(:, :MEMORY - 1)
      self%dx(:, 1) = dx
      self%df(:, 1) = df
   end subroutine hold

end module atrito_accelerator
