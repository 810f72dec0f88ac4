!> The classic skyline solver: K = L D L' of the columns between profile and diagonal, without pivoting.
!>
!> Storage. Of column j of the upper triangle the entries from row m_j (`first`), the first that is not zero, down to the diagonal
!> stand one behind the other in `values`, column after column; place(j) is where the diagonal is. The elimination makes nothing
!> above m_j: g_ij below is k_ij less a sum over the rows k >= m_j, and so it is 0 where i < m_j. Hence L' takes the place of K.
!> Zeros below m_j are kept, as k_24 is here, since the elimination may fill them:
!>
!>     [ k_11   .    k_13   .   ]        values:  k_11 | k_22 | k_13 k_23 k_33 | k_24 k_34 k_44
!>     [       k_22  k_23   0   ]        place:     1      2              5                8
!>     [             k_33  k_34 ]        first:     1      2              1                2
!>     [                   k_44 ]
!>
!> Elimination by active columns (Bathe, Finite Element Procedures, 8.2.3). With g = D L' in the making, column j is
!>
!>     g_ij = k_ij - sum_k l_ki g_kj,   l_ij = g_ij/d_i,   d_j = k_jj - sum_k l_kj g_kj,      k below min(i, n_interior + 1).
!>
!> A column needs those before it alone, and of each of them the rows that both have: one dot product an entry, as long as the
!> lower of the two columns is high. With heights h_j that makes about sum of h_j^2 operations (skyline_flops).
!>
!> Condensation. The limit on k ends all sums at the last equation that is eliminated. In the columns of the retained equations,
!> index c, that leaves
!>
!>     D^-1 L^-1 K_ic   in the interior rows i,      S = K_cc - K_ci K_ii^-1 K_ic   in the rows c:
!>
!> when the last column is done, the retained block is the Schur complement.
!>
!> Solution. reduce makes D^-1 L^-1 f_i and f_c - K_ci K_ii^-1 f_i in one loop over all columns, a dot product each, since the
!> columns c hold D^-1 L^-1 K_ic. expand goes backward: once x_j is known, x_j times column j is taken off the rows above, first for
!> the columns c, which gives D^-1 L^-1 (f_i - K_ic x_c), then for those of L', which gives x_i.
!>
!> Pivots. K_ii is positive definite, so every d_j is positive, and no interchange could make the elimination more stable. A pivot
!> that is round-off of its diagonal tells that something is free to move, a negative one that the matrix is not what it should be
!> (note_pivot).
!>
!> Panels. Four neighbouring columns are eliminated at a time, filled up with zeros to the tallest of them: a column of L' that is
!> fetched from memory serves four sums, two of them at a time eight (dot_1x4, dot_2x4). One column at a time waits for memory.
module atrito_skyline
   use atrito_dot_products, only: dot, dot_1x4, dot_2x4, take_off, PANEL_WIDTH
   use atrito_kinds, only: ip, lp, wp
   use atrito_profile, only: profile_t, profile_length, largest_height
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   use atrito_linear_solver, only: linear_solver_t, factor_report_t, note_pivot, set_pivot_status
   implicit none (type, external)
   private
   public :: skyline_t

   type, extends(linear_solver_t) :: skyline_t
      private
      integer(ip), allocatable :: first(:)       !< (n) first row of column j
      integer(lp), allocatable :: place(:)       !< (n) place of the diagonal of column j in values
      integer(ip) :: most_rows = 0               !< greatest height of a column
      real(wp), allocatable :: values(:)         !< columns, one after the other: K, then L' above the diagonal
      real(wp), allocatable :: pivots(:)         !< (n_interior) D
   contains
      procedure :: create => create_skyline
      procedure :: add => add_to_skyline
      procedure :: factor => factor_skyline
      procedure :: get_schur => get_skyline_schur
      procedure :: reduce => reduce_skyline
      procedure :: expand => expand_skyline
      procedure :: memory_bytes => skyline_memory
   end type skyline_t

   !> Neighbouring columns in the making: row i of column j is g(i - top + 1, j - first + 1), zero above the profile.
   type :: panel_t
      integer(ip) :: first = 0                   !< first column
      integer(ip) :: last = 0                    !< last column
      integer(ip) :: top = 0                     !< first row
      integer(ip) :: rows = 0                    !< leading dimension of g
      real(wp), allocatable :: g(:, :)           !< (rows, PANEL_WIDTH)
   end type panel_t

contains

   !> Room for the columns, all zero. What is asked for here is all that the solver will hold: the factor takes the place of the
   !> matrix.
   subroutine create_skyline(self, profile, status)
      class(skyline_t), intent(inout) :: self !< what it held is given up
      type(profile_t), intent(in) :: profile  !< closed
      type(status_t), intent(out) :: status   !< STATUS_INTERNAL where the memory does not suffice
      integer(lp) :: length
      integer(ip) :: j
      integer :: no_memory

      self%n = profile%n
      self%n_retained = profile%n_retained
      self%report = factor_report_t()
      self%first = profile%first
      self%most_rows = largest_height(profile)
      length = profile_length(profile)
      if (allocated(self%values)) deallocate (self%values, self%pivots, self%place)
      allocate (self%values(length), self%pivots(self%n - self%n_retained), self%place(self%n), stat=no_memory)
      if (no_memory /= 0) then
         call set_status(status, STATUS_INTERNAL, 'not enough memory for the skyline')
         return
      end if
      self%values = 0.0_wp
      length = 0
      do j = 1, self%n
         length = length + int(j - self%first(j) + 1, lp)
         self%place(j) = length
      end do
   end subroutine create_skyline

   !> Adds an element matrix: the entries of the upper triangle, each at its distance above the diagonal of its column. (The profile
   !> has room for all of them: add_to_profile was given the element.)
   subroutine add_to_skyline(self, equations, matrix)
      class(skyline_t), intent(inout) :: self !< created, not yet factored
      integer(ip), intent(in) :: equations(:) !< equation numbers; 0 = prescribed, skipped
      real(wp), intent(in) :: matrix(:, :)    !< symmetric, of these equations
      integer(ip) :: a, b, i, j
      integer(lp) :: k

      do b = 1, size(equations, kind=ip)
         j = equations(b)
         if (j == 0) cycle
         do a = 1, size(equations, kind=ip)
            i = equations(a)
            if (i == 0 .or. i > j) cycle
            k = self%place(j) - int(j - i, lp)
            self%values(k) = self%values(k) + matrix(a, b)
         end do
      end do
   end subroutine add_to_skyline

   !> Panel by panel, from left to right: take the columns out of the skyline, eliminate the rows above the panel, then the triangle
   !> within it, and put D and L' back. A pivot that must not be divided by ends it.
   subroutine factor_skyline(self, status)
      class(skyline_t), intent(inout) :: self !< matrix assembled; holds the factor on return
      type(status_t), intent(out) :: status   !< STATUS_SINGULAR where K_ii is singular or indefinite
      type(panel_t) :: panel
      logical :: stopped

      self%report = factor_report_t()
      panel%rows = self%most_rows + PANEL_WIDTH
      allocate (panel%g(panel%rows, PANEL_WIDTH))
      stopped = .false.
      do while (panel%last < self%n .and. .not. stopped)
         panel%first = panel%last + 1
         panel%last = last_of_panel(self, panel%first)
         panel%top = minval(self%first(panel%first:panel%last))
         call load_panel(self, panel)
         call eliminate_panel(self, panel)
         call finish_panel(self, panel, stopped)
      end do
      call set_pivot_status(self%report, stopped, status)
   end subroutine factor_skyline

   !> The panel that begins with column j ends where the heights differ much, which would be work on zeros, or the retained block
   !> begins. The height of the taller is allowed to be twice that of the lower: of columns that are much taller than the panel is
   !> wide the zeros are then less than half of what is computed, and as much is gained by going four at a time.
   pure integer(ip) function last_of_panel(self, j) result(last)
      class(skyline_t), intent(in) :: self
      integer(ip), intent(in) :: j
      integer(ip) :: n_interior, tallest, lowest, height

      n_interior = self%n - self%n_retained
      tallest = j - self%first(j) + 1
      lowest = tallest
      last = j
      do while (last < min(j + PANEL_WIDTH - 1, self%n) .and. last /= n_interior)
         height = last + 1 - self%first(last + 1) + 1
         tallest = max(tallest, height)
         lowest = min(lowest, height)
         if (tallest > 2*lowest + 2*PANEL_WIDTH) exit
         last = last + 1
      end do
   end function last_of_panel

   !> The columns of the panel as a rectangle; the zeros above the shorter ones stay zeros through the elimination.
   pure subroutine load_panel(self, panel)
      class(skyline_t), intent(in) :: self
      type(panel_t), intent(inout) :: panel
      integer(ip) :: c, j, lead, height

      panel%g(:panel%last - panel%top + 1, :) = 0.0_wp
      do j = panel%first, panel%last
         c = j - panel%first + 1
         lead = self%first(j) - panel%top
         height = j - self%first(j) + 1
         panel%g(lead + 1:lead + height, c) = self%values(self%place(j) - int(height - 1, lp):self%place(j))
      end do
   end subroutine load_panel

   !> The rows above the panel's first column, two at a time, from the top down: g_ij for i = top + 1 .. first - 1. Row i wants the
   !> rows above it, and column i of L', which is done.
   !>
   !> Rows i and i + 1 have their sums down to row i - 1 at the same time; the one term that is left, l_i,i+1 g_ij of row i + 1, can
   !> be added when row i is known, if i is eliminated at all and column i + 1 reaches up to it. An odd row is left for the end.
   pure subroutine eliminate_panel(self, panel)
      class(skyline_t), intent(in) :: self
      type(panel_t), intent(inout) :: panel
      integer(ip) :: i, n_interior, row

      n_interior = self%n - self%n_retained
      i = panel%top + 1
      do while (i < panel%first - 1)
         call eliminate_two_rows(self, i, min(i - 1, n_interior), panel)
         if (i <= n_interior .and. self%first(i + 1) <= i) then
            row = i - panel%top + 1
            panel%g(row + 1, :) = panel%g(row + 1, :) - self%values(self%place(i + 1) - 1)*panel%g(row, :)
         end if
         i = i + 2
      end do
      if (i == panel%first - 1) call eliminate_row(self, i, max(self%first(i), panel%top), min(i - 1, n_interior), panel)
   end subroutine eliminate_panel

   !> Rows i and i + 1, with the terms down to row `bottom`. Column i of L' begins at row m_i, column i + 1 at m_i+1: where only the
   !> taller of the two has entries, its row is served alone; from the greater of m_i and m_i+1 on, which is nearly all, both are.
   pure subroutine eliminate_two_rows(self, i, bottom, panel)
      class(skyline_t), intent(in) :: self
      integer(ip), intent(in) :: i, bottom
      type(panel_t), intent(inout) :: panel
      real(wp) :: products(PANEL_WIDTH, 2)
      integer(ip) :: first_one, first_two, first_both, row
      integer(lp) :: one, two

      first_one = max(self%first(i), panel%top)
      first_two = max(self%first(i + 1), panel%top)
      first_both = max(first_one, first_two)
      if (first_one < first_both) call eliminate_row(self, i, first_one, min(first_both - 1, bottom), panel)
      if (first_two < first_both) call eliminate_row(self, i + 1, first_two, min(first_both - 1, bottom), panel)
      if (first_both > bottom) return
      one = self%place(i) - int(i - first_both, lp)
      two = self%place(i + 1) - int(i + 1 - first_both, lp)
      row = i - panel%top + 1
      call dot_2x4(bottom - first_both + 1, self%values(one), self%values(two), panel%rows, &
                   panel%g(first_both - panel%top + 1, 1), products)
      panel%g(row, :) = panel%g(row, :) - products(:, 1)
      panel%g(row + 1, :) = panel%g(row + 1, :) - products(:, 2)
   end subroutine eliminate_two_rows

   !> Row i, with the terms of rows `first` to `bottom`.
   pure subroutine eliminate_row(self, i, first, bottom, panel)
      class(skyline_t), intent(in) :: self
      integer(ip), intent(in) :: i, first, bottom
      type(panel_t), intent(inout) :: panel
      real(wp) :: products(PANEL_WIDTH)
      integer(ip) :: row

      if (first > bottom) return
      row = i - panel%top + 1
      call dot_1x4(bottom - first + 1, self%values(self%place(i) - int(i - first, lp)), panel%rows, &
                   panel%g(first - panel%top + 1, 1), products)
      panel%g(row, :) = panel%g(row, :) - products
   end subroutine eliminate_row

   !> The triangle of the panel, then D and L', which go back into the skyline.
   !>
   !> The rows of the panel's own columns come last: row i of column j > i wants column i of L', which is in the skyline as soon as
   !> finish_column has put it there. The columns are therefore gone through one by one, with single dot products; there are six of
   !> these entries in a panel of four, whatever its height.
   subroutine finish_panel(self, panel, stopped)
      class(skyline_t), intent(inout) :: self
      type(panel_t), intent(inout) :: panel
      logical, intent(out) :: stopped
      integer(ip) :: c, i, j, first, bottom, row

      stopped = .false.
      do j = panel%first, panel%last
         c = j - panel%first + 1
         do i = panel%first, j - 1
            first = max(self%first(i), panel%top)
            bottom = min(i - 1, self%n - self%n_retained)
            if (first > bottom) cycle
            row = i - panel%top + 1
            panel%g(row, c) = panel%g(row, c) - dot(bottom - first + 1, self%values(self%place(i) - int(i - first, lp)), &
                                                    panel%g(first - panel%top + 1, c))
         end do
         call finish_column(self, j, panel%g(self%first(j) - panel%top + 1:j - panel%top + 1, c), stopped)
         if (stopped) exit
      end do
   end subroutine finish_panel

   !> From g to l and d: l_ij = g_ij/d_i for the eliminated rows; d_j = k_jj - sum of l_ij g_ij. Rows of retained equations keep g,
   !> which is their part of S. In a retained column that last line makes s_jj, which is no pivot and is not judged as one.
   subroutine finish_column(self, j, column, stopped)
      class(skyline_t), intent(inout) :: self
      integer(ip), intent(in) :: j
      real(wp), intent(in), contiguous :: column(:)       !< rows first(j)..j
      logical, intent(out) :: stopped
      real(wp) :: original, pivot
      integer(ip) :: first, height, eliminated
      integer(lp) :: start
      logical :: usable

      first = self%first(j)
      height = j - first + 1
      eliminated = min(j - 1, self%n - self%n_retained) - first + 1
      start = self%place(j) - int(height, lp)
      original = column(height)
      self%values(start + 1:start + eliminated) = column(:eliminated)/self%pivots(first:first + eliminated - 1)
      self%values(start + eliminated + 1:start + height - 1) = column(eliminated + 1:height - 1)
      pivot = original
      if (eliminated > 0) pivot = pivot - dot(eliminated, self%values(start + 1), column)
      self%values(self%place(j)) = pivot
      stopped = .false.
      if (j > self%n - self%n_retained) return
      self%pivots(j) = pivot
      call note_pivot(self%report, j, self%n, original, pivot, usable)
      stopped = .not. usable
   end subroutine finish_column

   !> The columns of the retained equations, from the first retained row down: both triangles of S.
   subroutine get_skyline_schur(self, schur)
      class(skyline_t), intent(in) :: self !< factored
      real(wp), intent(out) :: schur(:, :) !< (n_retained, n_retained)
      integer(ip) :: j, n_interior

      n_interior = self%n - self%n_retained
      do j = 1, self%n_retained
         schur(:j, j) = self%values(self%place(n_interior + j) - int(j - 1, lp):self%place(n_interior + j))
         schur(j, :j - 1) = schur(:j - 1, j)
      end do
   end subroutine get_skyline_schur

   !> Forwards f_j <- f_j - sum of l_kj f_k from the first equation to the last, then the division by D, which must wait until
   !> nobody wants L^-1 f any more. f_i becomes D^-1 L^-1 f_i; the columns of retained equations hold D^-1 L^-1 K_ic, so the same
   !> loop serves f_c: sum over k of (D^-1 L^-1 K_ic)_kj (L^-1 f_i)_k is what K_ci K_ii^-1 f_i has in row j. All loads are taken
   !> with a column while it is in the cache.
   subroutine reduce_skyline(self, f)
      class(skyline_t), intent(in) :: self           !< factored
      real(wp), intent(inout), contiguous :: f(:, :) !< (n, loads)
      integer(ip) :: j, load, first, eliminated, n_interior

      n_interior = self%n - self%n_retained
      do j = 1, self%n
         first = self%first(j)
         eliminated = min(j - 1, n_interior) - first + 1
         if (eliminated < 1) cycle
         do load = 1, size(f, 2, kind=ip)
            f(j, load) = f(j, load) - dot(eliminated, self%values(self%place(j) - int(j - first, lp)), &
                                          f(first:first + eliminated - 1, load))
         end do
      end do
      do load = 1, size(f, 2, kind=ip)
         f(:n_interior, load) = f(:n_interior, load)/self%pivots
      end do
   end subroutine reduce_skyline

   !> Backward, by columns: x_j is known when all columns behind it have been taken off, and its own is taken off the rows above
   !> then. The columns of the retained equations come first and make D^-1 L^-1 (f_i - K_ic x_c) of the interior.
   subroutine expand_skyline(self, x)
      class(skyline_t), intent(in) :: self           !< factored
      real(wp), intent(inout), contiguous :: x(:, :) !< (n, loads): f_i above, x_c below
      integer(ip) :: j, load, first, last
      integer(lp) :: start

      do j = self%n, 1, -1
         first = self%first(j)
         last = min(j - 1, self%n - self%n_retained)
         start = self%place(j) - int(j - first, lp)
         if (last < first) cycle
         do load = 1, size(x, 2, kind=ip)
            call take_off(last - first + 1, (x(j, load)), self%values(start), x(first:last, load))
         end do
      end do
   end subroutine expand_skyline

   !> The columns, the pivots and the two lists of places [bytes].
   pure integer(lp) function skyline_memory(self)
      class(skyline_t), intent(in) :: self !< 0 before create

      skyline_memory = 0
      if (.not. allocated(self%values)) return
      skyline_memory = (size(self%values, kind=lp) + size(self%pivots, kind=lp))*int(storage_size(1.0_wp)/8, lp) &
                       + size(self%place, kind=lp)*int((storage_size(1_lp) + storage_size(1_ip))/8, lp)
   end function skyline_memory

end module atrito_skyline
