!> Band Cholesky by LAPACK, with the retained equations as a border.
!>
!> With i for the interior and c for the retained equations
!>
!>     [ K_ii  K_ic ]   [ L   0 ] [ I  0 ] [ L'  H ]
!>     [ K_ci  K_cc ] = [ H'  I ] [ 0  S ] [ 0   I ],      K_ii = L L',   H = L^-1 K_ic,   S = K_cc - H'H.
!>
!> L is found by dpbtrf and has the half bandwidth w of K_ii: n w^2 operations for n interior equations. The coupling H is a full
!> block from row r on, the first interior row that a retained equation reaches (`first_coupled`): above it K_ic is 0, and so is
!> L^-1 K_ic, as L^-1 is a lower triangle. That makes 2 (n - r) w operations a retained equation for H, and n - r for each entry of
!> S.
!>
!> A load is reduced by f_i <- L^-1 f_i, f_c <- f_c - H'f_i, and the solution expanded by x_i <- L^-T (f_i - H x_c).
!>
!> LAPACK keeps a_ij, i >= j, in band(1 + i - j, j): the diagonal in the first row, what is below it in the rows beneath. With w = 1
!>
!>     [ a11  a21   .    .  ]                    [ a11  a22  a33  a44 ]
!>     [ a21  a22  a32   .  ]         band  =    [ a21  a32  a43   0  ]
!>     [  .   a32  a33  a43 ]                    [  0    0    0    0  ]   padding
!>     [  .    .   a43  a44 ]
!>
!> With ld for the leading dimension its address is (i - 1) + (j - 1)(ld - 1), that of an entry of a full matrix whose leading
!> dimension is ld - 1. So a block of columns of L can be handed to the BLAS as it lies in the band (eliminate_coupling), if what
!> lies below the band reads as 0: that is what the padding is for.
!>
!> The band is worth its zeros where K_ii is nearly as wide everywhere: dpbtrf works on full blocks at the rate of dgemm. Where the
!> columns are of very different lengths the skyline (atrito_skyline) has fewer operations, one dot product each.
module atrito_banded
   use atrito_dot_products, only: dot_down
   use atrito_halting, only: halting_t, suspend_halting, restore_halting
   use atrito_kinds, only: ip, lp, wp
   use atrito_lapack, only: dgemm, dpbtrf, dsyrk, dtbtrs, dtrsm
   use atrito_profile, only: profile_t, half_bandwidth, first_coupled_row, BAND_BLOCK
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   use atrito_linear_solver, only: linear_solver_t, factor_report_t, note_pivot, set_pivot_status
   implicit none (type, external)
   private
   public :: banded_t

   type, extends(linear_solver_t) :: banded_t
      private
      integer(ip) :: half_width = 0              !< entries below the diagonal
      integer(ip) :: first_coupled = 1           !< first row of the coupling
      real(wp), allocatable :: band(:, :)        !< (half_width + 1 + padding, n_interior): a_ij in (1 + i - j, j), i >= j
      real(wp), allocatable :: coupling(:, :)    !< (n_interior - first_coupled + 1, n_retained): K_ic, then H
      real(wp), allocatable :: retained(:, :)        !< (n_retained, n_retained), lower triangle: K_cc, then S
   contains
      procedure :: create => create_banded
      procedure :: add => add_to_banded
      procedure :: factor => factor_banded
      procedure :: get_schur => get_banded_schur
      procedure :: reduce => reduce_banded
      procedure :: expand => expand_banded
      procedure :: memory_bytes => banded_memory
   end type banded_t

contains

   !> Room for band, coupling and retained block, all zero.
   subroutine create_banded(self, profile, status)
      class(banded_t), intent(inout) :: self !< what it held is given up
      type(profile_t), intent(in) :: profile !< closed
      type(status_t), intent(out) :: status  !< STATUS_INTERNAL where the memory does not suffice
      integer(ip) :: n_interior, padding
      integer :: no_memory

      self%n = profile%n
      self%n_retained = profile%n_retained
      self%report = factor_report_t()
      self%half_width = half_bandwidth(profile)
      self%first_coupled = first_coupled_row(profile)
      n_interior = self%n - self%n_retained
      padding = 0
      if (self%n_retained > 0) padding = BAND_BLOCK      ! zeros that eliminate_coupling multiplies with
      if (allocated(self%band)) deallocate (self%band, self%coupling, self%retained)
      allocate (self%band(self%half_width + 1 + padding, n_interior), &
                self%coupling(n_interior - self%first_coupled + 1, self%n_retained), &
                self%retained(self%n_retained, self%n_retained), stat=no_memory)
      if (no_memory /= 0) then
         call set_status(status, STATUS_INTERNAL, 'not enough memory for the band')
         return
      end if
      self%band = 0.0_wp
      self%coupling = 0.0_wp
      self%retained = 0.0_wp
   end subroutine create_banded

   !> Adds an element matrix, its lower triangle: to the band where both equations are interior; to the coupling, K_ic, where the
   !> greater one is retained; to the lower triangle of K_cc where both are.
   subroutine add_to_banded(self, equations, matrix)
      class(banded_t), intent(inout) :: self  !< created, not yet factored
      integer(ip), intent(in) :: equations(:) !< equation numbers; 0 = prescribed, skipped
      real(wp), intent(in) :: matrix(:, :)    !< symmetric, of these equations
      integer(ip) :: a, b, i, j, n_interior

      n_interior = self%n - self%n_retained
      do b = 1, size(equations, kind=ip)
         j = equations(b)
         if (j == 0) cycle
         do a = 1, size(equations, kind=ip)
            i = equations(a)
            if (i < j) cycle
            if (i <= n_interior) then
               self%band(1 + i - j, j) = self%band(1 + i - j, j) + matrix(a, b)
            else if (j <= n_interior) then
               self%coupling(j - self%first_coupled + 1, i - n_interior) = &
                  self%coupling(j - self%first_coupled + 1, i - n_interior) + matrix(a, b)
            else
               self%retained(i - n_interior, j - n_interior) = self%retained(i - n_interior, j - n_interior) + matrix(a, b)
            end if
         end do
      end do
   end subroutine add_to_banded

   !> L by dpbtrf, whose pivots are then looked through; H and S where there are retained equations that reach the interior. BLAS
   !> and LAPACK raise floating-point exceptions that mean nothing: halting is suspended round them.
   subroutine factor_banded(self, status)
      class(banded_t), intent(inout) :: self !< matrix assembled; holds the factor on return
      type(status_t), intent(out) :: status  !< STATUS_SINGULAR where K_ii is singular or indefinite
      type(halting_t) :: halting
      real(wp) :: diagonal(self%n - self%n_retained)
      integer(ip) :: info, rows
      logical :: stopped

      diagonal = self%band(1, :)
      rows = size(self%coupling, 1, kind=ip)
      call suspend_halting(halting)
      call dpbtrf('L', size(diagonal, kind=ip), self%half_width, self%band, size(self%band, 1, kind=ip), info)
      call restore_halting(halting)
      call check_pivots(self, diagonal, info, stopped)
      call set_pivot_status(self%report, stopped, status)
      if (stopped .or. self%n_retained == 0 .or. rows == 0) return
      call suspend_halting(halting)
      call eliminate_coupling(self, rows)
      call dsyrk('L', 'T', self%n_retained, rows, -1.0_wp, self%coupling, rows, 1.0_wp, self%retained, self%n_retained)
      call restore_halting(halting)
   end subroutine factor_banded

   !> The pivots are the squares of L's diagonal, each compared with the diagonal that stood there before. dpbtrf stops at the first
   !> one that is not positive (`failed` > 0) and leaves no number for it: it is computed anew from its row,
   !>
   !>     d_j = k_jj - sum of l_jk^2,      k from j - w to j - 1,
   !>
   !> to tell a negative one, an indefinite matrix, from round-off, a motion that is free.
   subroutine check_pivots(self, diagonal, failed, stopped)
      class(banded_t), intent(inout) :: self
      real(wp), intent(in) :: diagonal(:)            !< of K_ii
      integer(ip), intent(in) :: failed
      logical, intent(out) :: stopped
      real(wp) :: pivot
      logical :: usable
      integer(ip) :: j, k

      self%report = factor_report_t()
      stopped = .false.
      do j = 1, size(diagonal, kind=ip)
         if (j == failed) then
            pivot = diagonal(j)
            do k = max(1_ip, j - self%half_width), j - 1
               pivot = pivot - self%band(1 + j - k, k)**2
            end do
         else
            pivot = self%band(1, j)**2
         end if
         call note_pivot(self%report, j, self%n, diagonal(j), pivot, usable)
         stopped = j == failed .or. .not. usable
         if (stopped) return
      end do
   end subroutine check_pivots

   !> coupling <- L^-1 coupling, by blocks of columns of L (dtbtrs takes one column of the coupling at a time and is slow). With a
   !> block of L, its triangle L_kk and the w rows L_bk below it,
   !>
   !>     H_k <- L_kk^-1 H_k  (dtrsm),      H_b <- H_b - L_bk H_k  (dgemm),
   !>
   !> for all retained equations at once. With one row less as leading dimension the band reads as a full matrix; the padding holds
   !> the zeros below it, which L_bk has where its later columns reach farther down than its first.
   subroutine eliminate_coupling(self, rows)
      class(banded_t), intent(inout) :: self
      integer(ip), intent(in) :: rows
      integer(ip) :: leading, k, row, columns, below

      leading = size(self%band, 1, kind=ip) - 1
      do row = 1, rows, BAND_BLOCK
         k = self%first_coupled + row - 1
         columns = min(BAND_BLOCK, rows - row + 1)
         call dtrsm('L', 'L', 'N', 'N', columns, self%n_retained, 1.0_wp, self%band(1, k), leading, self%coupling(row, 1), rows)
         below = min(self%half_width, rows - row - columns + 1)
         if (below == 0) cycle
         call dgemm('N', 'N', below, self%n_retained, columns, -1.0_wp, self%band(1 + columns, k), leading, &
                    self%coupling(row, 1), rows, 1.0_wp, self%coupling(row + columns, 1), rows)
      end do
   end subroutine eliminate_coupling

   !> Both triangles of S.
   subroutine get_banded_schur(self, schur)
      class(banded_t), intent(in) :: self  !< factored
      real(wp), intent(out) :: schur(:, :) !< (n_retained, n_retained)
      integer(ip) :: j

      do j = 1, self%n_retained
         schur(j:, j) = self%retained(j:, j)
         schur(j, j + 1:) = self%retained(j + 1:, j)
      end do
   end subroutine get_banded_schur

   !> f_i <- L^-1 f_i, f_c <- f_c - H' f_i.
   subroutine reduce_banded(self, f)
      class(banded_t), intent(in) :: self            !< factored
      real(wp), intent(inout), contiguous :: f(:, :) !< (n, loads)

      call reduce_columns(self, self%n, size(f, 2, kind=ip), f)
   end subroutine reduce_banded

   subroutine reduce_columns(self, n, loads, f)
      class(banded_t), intent(in) :: self
      integer(ip), intent(in) :: n, loads
      real(wp), intent(inout) :: f(n, loads)
      type(halting_t) :: halting
      integer(ip) :: n_interior, rows, ignored

      n_interior = n - self%n_retained
      rows = size(self%coupling, 1, kind=ip)
      if (n_interior == 0 .or. loads == 0) return
      call suspend_halting(halting)
      call dtbtrs('L', 'N', 'N', n_interior, self%half_width, loads, self%band, size(self%band, 1, kind=ip), f, n, ignored)
      if (self%n_retained > 0 .and. rows > 0) then
         call dgemm('T', 'N', self%n_retained, loads, rows, -1.0_wp, self%coupling, rows, f(self%first_coupled, 1), n, 1.0_wp, &
                    f(n_interior + 1, 1), n)
      end if
      call restore_halting(halting)
   end subroutine reduce_columns

   !> x_i <- L^-T (f_i - H x_c).
   subroutine expand_banded(self, x)
      class(banded_t), intent(in) :: self            !< factored
      real(wp), intent(inout), contiguous :: x(:, :) !< (n, loads): f_i above, x_c below

      call expand_columns(self, self%n, size(x, 2, kind=ip), x)
   end subroutine expand_banded

   subroutine expand_columns(self, n, loads, x)
      class(banded_t), intent(in) :: self
      integer(ip), intent(in) :: n, loads
      real(wp), intent(inout) :: x(n, loads)
      type(halting_t) :: halting
      integer(ip) :: n_interior, rows, load, j

      n_interior = n - self%n_retained
      rows = size(self%coupling, 1, kind=ip)
      if (n_interior == 0 .or. loads == 0) return
      call suspend_halting(halting)
      if (self%n_retained > 0 .and. rows > 0) then
         call dgemm('N', 'N', rows, loads, self%n_retained, -1.0_wp, self%coupling, rows, x(n_interior + 1, 1), n, 1.0_wp, &
                    x(self%first_coupled, 1), n)
      end if
      call restore_halting(halting)
      ! dtbtrs does the same, but reads each column forward, against the way in which it goes through them: 1.5 times as long
      do load = 1, loads
         do j = n_interior, 1, -1
            rows = min(self%half_width, n_interior - j)
            if (rows > 0) x(j, load) = x(j, load) - dot_down(rows, self%band(2, j), x(j + 1, load))
            x(j, load) = x(j, load)/self%band(1, j)
         end do
      end do
   end subroutine expand_columns

   !> Band with its padding, coupling and retained block [bytes].
   pure integer(lp) function banded_memory(self)
      class(banded_t), intent(in) :: self !< 0 before create

      banded_memory = 0
      if (.not. allocated(self%band)) return
      banded_memory = (size(self%band, kind=lp) + size(self%coupling, kind=lp) + size(self%retained, kind=lp)) &
                      *int(storage_size(1.0_wp)/8, lp)
   end function banded_memory

end module atrito_banded
