!> The profile (skyline) of a symmetric matrix, and what factoring it will cost.
!>
!> Equations are numbered 1..n; the last n_retained of them are retained: they are the contact unknowns, which the factorisation
!> does not eliminate and onto which it condenses the rest (the Schur complement). Column j of the upper triangle is stored from row
!> first(j) down to the diagonal; its height is j - first(j) + 1.
!>
!> The profile of a sum of element matrices: an element with the equations e couples all of them, so first(j) for j in e is at most
!> the least of e. The retained block is full once the interior is eliminated, therefore closing the profile lowers its columns to
!> the first retained row.
!>
!> From the profile the choice of the solver follows, by the operations and the memory of each:
!>
!>     skyline   sum over the columns of h_j^2, where h_j rows of column j are eliminated
!>     banded    n w^2, w the greatest height: as much as the skyline where all columns are equally high, and with a better rate
!>     sparse    about 45 n m for a grid m equations wide: less for all that is larger than a few thousand equations
!>
!> The first two are counts of what the routines do; the third is a fit to counts of a number of bodies, since the sparse solver
!> takes an order of its own.
module atrito_profile
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: elimination_t
   implicit none (type, external)
   private
   public :: profile_t, begin_profile, add_to_profile, close_profile, expect_profile
   public :: profile_length, half_bandwidth, largest_height, mean_height, first_coupled_row
   public :: skyline_flops, banded_flops, sparse_flops, skyline_bytes, banded_bytes, sparse_bytes, sparse_entries
   public :: BAND_BLOCK

   type :: profile_t
      integer(ip) :: n = 0                      !< number of equations
      integer(ip) :: n_retained = 0                 !< the last n_retained equations are retained
      integer(ip), allocatable :: first(:)      !< (n) row of the first entry of column j, 1 <= first(j) <= j
      integer(lp) :: entries = 0                !< of the lower triangles of all element matrices
      type(elimination_t) :: elimination        !< for the sparse solver; not allocated within: it takes an order of its own
   end type profile_t

   !> Columns that the banded solver eliminates at a time from the retained block; it pads the band by as many rows.
   integer(ip), parameter :: BAND_BLOCK = 32_ip

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8
   integer(lp), parameter :: INDEX_BYTES = storage_size(1_ip)/8 + storage_size(1_lp)/8

contains

   !> Begins with a diagonal matrix.
   pure subroutine begin_profile(profile, n, n_retained)
      type(profile_t), intent(out) :: profile   !< still open, add_to_profile comes next
      integer(ip), intent(in) :: n              !< number of equations, >= 0
      integer(ip), intent(in) :: n_retained         !< retained equations, 0 <= n_retained <= n
      integer(ip) :: j

      profile%n = n
      profile%n_retained = n_retained
      allocate (profile%first(n))
      do j = 1, n
         profile%first(j) = j
      end do
   end subroutine begin_profile

   !> Makes room for an element matrix: all of its equations reach up to the lowest of them, so that the assembled matrix fits
   !> whatever the entries are. Entries that are zero by accident take room as well.
   pure subroutine add_to_profile(profile, equations)
      type(profile_t), intent(inout) :: profile !< open; columns of these equations grow
      integer(ip), intent(in) :: equations(:)   !< equation numbers of the element in any order; 0 = prescribed, skipped
      integer(ip) :: k, lowest
      integer(lp) :: free

      lowest = huge(lowest)
      free = 0
      do k = 1, size(equations, kind=ip)
         if (equations(k) == 0) cycle
         lowest = min(lowest, equations(k))
         free = free + 1
      end do
      profile%entries = profile%entries + free*(free + 1)/2
      do k = 1, size(equations, kind=ip)
         if (equations(k) > 0) profile%first(equations(k)) = min(profile%first(equations(k)), lowest)
      end do
   end subroutine add_to_profile

   !> Ends with the retained block full, as the Schur complement is: eliminating the interior couples all retained equations that
   !> the body joins, whether or not an element has them.
   pure subroutine close_profile(profile)
      type(profile_t), intent(inout) :: profile !< every element has been added
      integer(ip) :: j, n_interior

      n_interior = profile%n - profile%n_retained
      do j = n_interior + 1, profile%n
         profile%first(j) = min(profile%first(j), n_interior + 1)
      end do
   end subroutine close_profile

   !> A profile of columns of one height, closed.
   pure subroutine expect_profile(profile, n, n_retained, height)
      type(profile_t), intent(out) :: profile   !< closed, as if it were of such a mesh
      integer(ip), intent(in) :: n, n_retained  !< equations, and how many of the last ones are retained
      integer(ip), intent(in) :: height         !< >= 1
      integer(ip) :: j

      call begin_profile(profile, n, n_retained)
      do j = height + 1, n
         profile%first(j) = j - height + 1
      end do
      profile%first(:min(height, n)) = 1
      call close_profile(profile)
   end subroutine expect_profile

   !> Entries within the profile, diagonals included.
   pure integer(lp) function profile_length(profile)
      type(profile_t), intent(in) :: profile !< open or closed
      integer(ip) :: j

      profile_length = 0
      do j = 1, profile%n
         profile_length = profile_length + int(j - profile%first(j) + 1, lp)
      end do
   end function profile_length

   !> Half bandwidth of the interior block (retained equations left out), the diagonal not counted.
   pure integer(ip) function half_bandwidth(profile)
      type(profile_t), intent(in) :: profile !< closed
      integer(ip) :: j

      half_bandwidth = 0
      do j = 1, profile%n - profile%n_retained
         half_bandwidth = max(half_bandwidth, j - profile%first(j))
      end do
   end function half_bandwidth

   !> Greatest height of a column; 0 without equations.
   pure integer(ip) function largest_height(profile)
      type(profile_t), intent(in) :: profile !< closed
      integer(ip) :: j

      largest_height = 0
      do j = 1, profile%n
         largest_height = max(largest_height, j - profile%first(j) + 1)
      end do
   end function largest_height

   !> Mean height of the columns; 0 without equations.
   pure real(wp) function mean_height(profile)
      type(profile_t), intent(in) :: profile !< closed

      mean_height = real(profile_length(profile), wp)/real(max(profile%n, 1_ip), wp)
   end function mean_height

   !> First interior row that the retained equations reach; n_interior + 1 when they reach none.
   pure integer(ip) function first_coupled_row(profile) result(row)
      type(profile_t), intent(in) :: profile !< closed
      integer(ip) :: j

      row = profile%n - profile%n_retained + 1
      do j = row, profile%n
         row = min(row, profile%first(j))
      end do
   end function first_coupled_row

   !> Predicted floating-point operations of the skyline factorisation with its Schur complement. Exact where first(j) grows with j,
   !> an upper bound elsewhere.
   !>
   !> Column j has h rows to eliminate; row k of them is a dot product of length k - 1 at the most, a multiplication and an addition
   !> a term, then comes the division by the pivot and the sum for the diagonal: h (h - 1) + h + 2 h, and with what the products are
   !> taken off h (h + 3). A retained column has a dot product of length h besides for each retained column before it.
   pure real(wp) function skyline_flops(profile) result(flops)
      type(profile_t), intent(in) :: profile !< closed
      real(wp) :: height, retained_before
      integer(ip) :: j, n_interior

      n_interior = profile%n - profile%n_retained
      flops = 0.0_wp
      do j = 1, profile%n
         height = real(min(j - 1, n_interior) - profile%first(j) + 1, wp)
         retained_before = real(max(j - n_interior - 1, 0_ip), wp)
         flops = flops + height*(height + 3.0_wp + 2.0_wp*retained_before)
      end do
   end function skyline_flops

   !> Predicted floating-point operations of the banded factorisation with its Schur complement: w (w + 3) for each column of the
   !> band, then for each retained equation the substitution, (2 w + 1) a row of the coupling, and its products with the others, of
   !> which symmetry leaves half: n_retained a row.
   pure real(wp) function banded_flops(profile) result(flops)
      type(profile_t), intent(in) :: profile !< closed
      real(wp) :: n_interior, n_retained, rows, band

      n_retained = real(profile%n_retained, wp)
      n_interior = real(profile%n, wp) - n_retained
      band = real(half_bandwidth(profile), wp)
      rows = n_interior + 1.0_wp - real(first_coupled_row(profile), wp)
      flops = n_interior*band*(band + 3.0_wp) + rows*n_retained*(2.0_wp*band + 1.0_wp + n_retained)
   end function banded_flops

   !> Expected floating-point operations of the sparse factorisation with its Schur complement.
   !>
   !> Nested dissection and minimum degree need about c n m operations for a grid of n equations that is m wide (George, SIAM J.
   !> Numer. Anal. 10 (1973) 345-363, for the square); the mean height of the columns tells the width. c was counted by MUMPS with
   !> the order of atrito_dissection for bodies of 27,000 to 850,000 equations: 30 to 55.
   pure real(wp) function sparse_flops(profile) result(flops)
      type(profile_t), intent(in) :: profile !< closed
      real(wp), parameter :: C = 45.0_wp
      real(wp) :: n_retained

      n_retained = real(profile%n_retained, wp)
      flops = C*real(profile%n - profile%n_retained, wp)*mean_height(profile) + n_retained**3/3.0_wp
   end function sparse_flops

   !> Expected entries of the sparse factor: a n log2 m - b n of the grid above, counted by MUMPS for the same bodies.
   pure real(wp) function sparse_entries(profile) result(entries)
      type(profile_t), intent(in) :: profile !< closed
      real(wp), parameter :: A = 11.0_wp, B = 16.0_wp, LEAST = 10.0_wp

      entries = real(profile%n, wp)*max(A*log(max(mean_height(profile), 1.0_wp))/log(2.0_wp) - B, LEAST)
   end function sparse_entries

   !> Memory that the sparse solver is expected to hold [bytes]: the factor, and half as much for matrix and lists. A mesh without
   !> equal elements takes up to a quarter more, a regular one half of it.
   pure integer(lp) function sparse_bytes(profile) result(bytes)
      type(profile_t), intent(in) :: profile !< closed

      bytes = REAL_BYTES*int(1.5_wp*sparse_entries(profile), lp)
   end function sparse_bytes

   !> Memory of the skyline solver [bytes].
   pure integer(lp) function skyline_bytes(profile) result(bytes)
      type(profile_t), intent(in) :: profile !< closed

      bytes = REAL_BYTES*(profile_length(profile) + int(profile%n - profile%n_retained, lp)) + INDEX_BYTES*int(profile%n, lp)
   end function skyline_bytes

   !> Memory of the banded solver [bytes].
   pure integer(lp) function banded_bytes(profile) result(bytes)
      type(profile_t), intent(in) :: profile !< closed
      integer(lp) :: n_interior, n_retained, rows, band_rows

      n_retained = int(profile%n_retained, lp)
      n_interior = int(profile%n, lp) - n_retained
      band_rows = int(half_bandwidth(profile), lp) + 1_lp
      if (n_retained > 0_lp) band_rows = band_rows + int(BAND_BLOCK, lp)
      rows = n_interior + 1_lp - int(first_coupled_row(profile), lp)
      bytes = REAL_BYTES*(band_rows*n_interior + (rows + n_retained)*n_retained)
   end function banded_bytes

end module atrito_profile
