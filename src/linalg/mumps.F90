!> The solver of the MUMPS library: L D L' by fronts, sequential, with the retained equations as its Schur complement.
!>
!> It checks the program's own sparse solver (atrito_multifrontal).
!>
!> The library is loaded when the first matrix is created (atrito_mumps_library).
!>
!> The interior is scaled to a diagonal between 1/2 and 2 by powers of two, which rounds nothing: MUMPS's smallest pivot then
!> tells the digits lost, and no unit of the deck matters. It does not tell the equation of that pivot. Where the matrix is
!> singular, or nearly so, the equation that moves most in the softest motion is looked for by inverse iteration.
!>
!> Reference: P. R. Amestoy, I. S. Duff, J. Koster, J.-Y. L'Excellent, SIAM J. Matrix Anal. Appl. 23 (2001) 15-41; MUMPS users'
!> guide 5.5 (ICNTL, INFOG and RINFOG below are its names).
module atrito_mumps
   use atrito_coordinate_matrix, only: coordinate_matrix_t, begin_matrix, add_element_matrix, finish_matrix, drop_matrix
   use atrito_kinds, only: ip, lp, wp
   use atrito_mumps_library, only: dmumps_struc, begin_mumps, mumps_failure, run_mumps
   use atrito_profile, only: profile_t
   use atrito_status, only: status_t, set_status, is_ok, STATUS_INTERNAL, STATUS_SINGULAR
   use atrito_linear_solver, only: linear_solver_t, factor_report_t, ALL_DIGITS, smallest_ratio
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: mumps_t

   !> What MUMPS works on, behind a pointer: solving changes it, and the matrix is only read then.
   type :: instance_t
      type(dmumps_struc) :: mumps
      type(coordinate_matrix_t) :: matrix        !< until factor
      integer(ip), allocatable :: place(:)       !< (n) of the equations in the elimination; not allocated: MUMPS decides
      real(wp), allocatable :: reduced(:, :)     !< (n_interior, loads) the load whose half-solved part MUMPS holds
   end type instance_t

   type, extends(linear_solver_t) :: mumps_t
      private
      type(instance_t), pointer :: instance => null()
      real(wp), allocatable :: scale(:)          !< (n) of rows and columns; 1 for the retained ones
   contains
      procedure :: create => create_mumps
      procedure :: add => add_to_mumps
      procedure :: factor => factor_mumps
      procedure :: get_schur => get_mumps_schur
      procedure :: reduce => reduce_by_mumps
      procedure :: expand => expand_by_mumps
      procedure :: memory_bytes => mumps_memory
      final :: finish_mumps
   end type mumps_t

   ! JOB
   integer, parameter :: ANALYSE_AND_FACTOR = 4, FACTOR_AGAIN = 2, SOLVE = 3, FINISH = -2
   ! ICNTL(26)
   integer, parameter :: INTERIOR_ALONE = 0, CONDENSE = 1, EXPAND = 2
   ! INFOG(1)
   integer, parameter :: ZERO_PIVOT = -10, NO_ROOM = -9
   !> Digits lost from which the place is worth two solves.
   real(wp), parameter :: MANY_DIGITS = 9.0_wp
   !> Added to the unit diagonal of a matrix that could not be factored, to find the motion that it leaves free; far below the
   !> softest elastic one.
   real(wp), parameter :: SHIFT = 1.0e-13_wp

contains

   subroutine create_mumps(self, profile, status)
      class(mumps_t), intent(inout) :: self
      type(profile_t), intent(in) :: profile
      type(status_t), intent(out) :: status
      integer :: no_memory

      call free_instance(self)
      self%n = profile%n
      self%n_retained = profile%n_retained
      self%report = factor_report_t()
      allocate (self%instance)
      call begin_mumps(self%instance%mumps, status)
      if (.not. is_ok(status)) then
         deallocate (self%instance)
         return
      end if
      if (allocated(profile%elimination%position)) self%instance%place = profile%elimination%position
      call begin_matrix(self%instance%matrix, self%n, profile%entries, no_memory)
      if (no_memory /= 0) call set_status(status, STATUS_INTERNAL, 'not enough memory for the sparse matrix')
   end subroutine create_mumps

   subroutine add_to_mumps(self, equations, matrix)
      class(mumps_t), intent(inout) :: self
      integer(ip), intent(in) :: equations(:)
      real(wp), intent(in) :: matrix(:, :)

      call add_element_matrix(self%instance%matrix, equations, matrix)
   end subroutine add_to_mumps

   subroutine factor_mumps(self, status)
      class(mumps_t), intent(inout) :: self
      type(status_t), intent(out) :: status
      integer(ip) :: empty

      self%report = factor_report_t()
      call hand_over_matrix(self, empty)
      call prepare_schur(self)
      if (self%n == self%n_retained) then
         call add_retained(self)
      else if (empty > 0) then
         self%report%worst_equation = empty
         self%report%digits_lost = ALL_DIGITS
         call set_status(status, STATUS_SINGULAR, 'the matrix is singular: equation '//to_text(empty)//' is empty')
      else
         call run_mumps(self%instance%mumps, ANALYSE_AND_FACTOR)
         if (self%instance%mumps%infog(1) == NO_ROOM) then
            self%instance%mumps%icntl(14) = 200
            call run_mumps(self%instance%mumps, FACTOR_AGAIN)
         end if
         call judge_pivots(self, status)
      end if
      call drop_matrix(self%instance%matrix)         ! MUMPS wants it no more
      if (allocated(self%instance%place)) deallocate (self%instance%place)
      nullify (self%instance%mumps%irn, self%instance%mumps%jcn, self%instance%mumps%a, self%instance%mumps%perm_in)
   end subroutine factor_mumps

   !> Scales the matrix and shows it to MUMPS, with the order of elimination. `empty`: an interior equation without stiffness,
   !> else 0.
   subroutine hand_over_matrix(self, empty)
      class(mumps_t), intent(inout) :: self
      integer(ip), intent(out) :: empty

      if (allocated(self%scale)) deallocate (self%scale)
      allocate (self%scale(self%n))
      call finish_matrix(self%instance%matrix, self%n - self%n_retained, self%scale, empty)
      associate (mumps => self%instance%mumps)
         mumps%n = self%n
         mumps%nnz = int(self%instance%matrix%entries, lp)
         mumps%irn => self%instance%matrix%row
         mumps%jcn => self%instance%matrix%column
         mumps%a => self%instance%matrix%values
         if (allocated(self%instance%place)) then
            mumps%perm_in => self%instance%place
            mumps%icntl(7) = 1                    ! the order that is given
         end if
      end associate
   end subroutine hand_over_matrix

   subroutine prepare_schur(self)
      class(mumps_t), intent(inout) :: self
      integer(ip) :: i

      if (self%n_retained == 0) return
      associate (mumps => self%instance%mumps, n_retained => self%n_retained)
         if (associated(mumps%schur)) deallocate (mumps%schur, mumps%listvar_schur)
         allocate (mumps%listvar_schur(n_retained), mumps%schur(int(n_retained, lp)**2))
         mumps%listvar_schur = [(i, i=self%n - n_retained + 1, self%n)]
         mumps%size_schur = n_retained
         mumps%icntl(19) = 2                      ! lower triangle by columns
         mumps%nprow = 1
         mumps%npcol = 1
         mumps%mblock = 100
         mumps%nblock = 100
         mumps%schur_lld = n_retained
      end associate
   end subroutine prepare_schur

   !> The retained block alone: nothing to eliminate.
   pure subroutine add_retained(self)
      class(mumps_t), intent(inout) :: self
      integer(ip) :: k

      associate (mumps => self%instance%mumps)
         if (self%n_retained > 0) mumps%schur = 0.0_wp
         do k = 1, self%instance%matrix%entries
            associate (s => mumps%schur(int(mumps%jcn(k) - 1, lp)*int(self%n_retained, lp) + int(mumps%irn(k), lp)))
               s = s + mumps%a(k)
            end associate
         end do
      end associate
   end subroutine add_retained

   !> Fills the report and the status from what MUMPS says.
   subroutine judge_pivots(self, status)
      class(mumps_t), intent(inout) :: self
      type(status_t), intent(out) :: status
      logical :: singular

      associate (mumps => self%instance%mumps, report => self%report)
         if (mumps%infog(1) < 0 .and. mumps%infog(1) /= ZERO_PIVOT) then
            call set_status(status, STATUS_INTERNAL, 'the sparse solver failed: '//mumps_failure(mumps))
            return
         end if
         singular = mumps%infog(1) == ZERO_PIVOT
         if (.not. singular) then
            report%sign_changes = mumps%infog(12)
            report%smallest_pivot = mumps%rinfog(19)
            report%largest_pivot = mumps%rinfog(21)
            singular = report%smallest_pivot <= smallest_ratio(self%n)
         end if
         report%digits_lost = ALL_DIGITS
         if (.not. singular) report%digits_lost = max(-log10(report%smallest_pivot), 0.0_wp)
         if (singular .or. report%sign_changes > 0) then
            call find_weakest(self, merge(SHIFT, 0.0_wp, mumps%infog(1) == ZERO_PIVOT))
            call set_status(status, STATUS_SINGULAR, pivot_text(report))
         else if (report%digits_lost > MANY_DIGITS) then
            call find_weakest(self, 0.0_wp)
         end if
      end associate
   end subroutine judge_pivots

   pure function pivot_text(report) result(text)
      type(factor_report_t), intent(in) :: report
      character(len=:), allocatable :: text

      text = 'the matrix is singular'
      if (report%sign_changes > 0) text = text//' or indefinite ('//to_text(report%sign_changes)//' negative pivots)'
      text = text//': its softest motion is largest at equation '//to_text(report%worst_equation)
   end function pivot_text

   !> Puts the equation that moves most in the softest motion of the interior into the report, by inverse iteration. With a
   !> shift the matrix is factored again and lost.
   subroutine find_weakest(self, shift)
      class(mumps_t), intent(inout) :: self
      real(wp), intent(in) :: shift                !< added to the diagonal; 0: the factor is good enough
      integer(ip) :: n_interior, i
      integer(lp) :: k
      real(wp), allocatable :: x(:, :), y(:)

      n_interior = self%n - self%n_retained
      if (shift > 0.0_wp) then
         associate (mumps => self%instance%mumps)
            do k = 1, mumps%nnz
               if (mumps%irn(k) == mumps%jcn(k)) mumps%a(k) = mumps%a(k) + shift
            end do
         end associate
         call run_mumps(self%instance%mumps, FACTOR_AGAIN)
         if (self%instance%mumps%infog(1) < 0) return
      end if
      allocate (x(self%n, 1), y(self%n))
      y = 0.0_wp
      ! without a symmetry that the motion could have
      y(:n_interior) = [(1.0_wp + real(modulo(37*modulo(i, 101), 101), wp)/101.0_wp, i=1, n_interior)]
      do i = 1, 3
         x(:, 1) = y/self%scale/maxval(abs(y))
         call solve_with(self, INTERIOR_ALONE, x)
         y = x(:, 1)/self%scale                    ! scaled unknowns: those of the deck may leave the range of numbers
         y(n_interior + 1:) = 0.0_wp
      end do
      x(:, 1) = y/maxval(abs(y))*self%scale
      self%report%worst_equation = maxloc(abs(x(:n_interior, 1)), dim=1, kind=ip)
   end subroutine find_weakest

   subroutine get_mumps_schur(self, schur)
      class(mumps_t), intent(in) :: self
      real(wp), intent(out) :: schur(:, :)
      integer(ip) :: j
      integer(lp) :: first

      associate (mumps => self%instance%mumps, n => self%n_retained)
         do j = 1, n
            first = int(j - 1, lp)*int(n, lp)
            schur(j:, j) = mumps%schur(first + j:first + n)
            schur(j, j + 1:) = schur(j + 1:, j)
         end do
      end associate
   end subroutine get_mumps_schur

   !> f_i stays; MUMPS keeps the half-solved part.
   subroutine reduce_by_mumps(self, f)
      class(mumps_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: f(:, :)
      integer(ip) :: n_interior

      n_interior = self%n - self%n_retained
      if (n_interior == 0 .or. self%n_retained == 0 .or. size(f, 2) == 0) return
      self%instance%reduced = f(:n_interior, :)
      call solve_with(self, CONDENSE, f)
   end subroutine reduce_by_mumps

   !> Where MUMPS holds the half-solved part of another load, or has used it up, that is made again.
   subroutine expand_by_mumps(self, x)
      class(mumps_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: x(:, :)
      integer(ip) :: n_interior
      real(wp), allocatable :: copy(:, :)

      n_interior = self%n - self%n_retained
      if (n_interior == 0 .or. size(x, 2) == 0) return
      if (self%n_retained == 0) then
         call solve_with(self, INTERIOR_ALONE, x)
         return
      end if
      if (.not. is_reduced(self%instance, x(:n_interior, :))) then
         copy = x
         call solve_with(self, CONDENSE, copy)
         deallocate (copy)
      end if
      if (allocated(self%instance%reduced)) deallocate (self%instance%reduced)
      call solve_with(self, EXPAND, x)
   end subroutine expand_by_mumps

   pure logical function is_reduced(instance, f)
      type(instance_t), intent(in) :: instance
      real(wp), intent(in) :: f(:, :)

      is_reduced = .false.
      if (.not. allocated(instance%reduced)) return
      if (size(instance%reduced, 2) /= size(f, 2)) return
      is_reduced = all(instance%reduced == f)     ! bitwise the same load
   end function is_reduced

   !> One of MUMPS's solves in the unknowns of the deck. CONDENSE changes x_c alone, EXPAND reads x_c and sets x_i.
   subroutine solve_with(self, mode, x)
      class(mumps_t), intent(in) :: self
      integer, intent(in) :: mode
      real(wp), intent(inout), contiguous :: x(:, :)   !< (n, loads)
      integer(ip) :: j, n_interior, loads
      integer(lp) :: first

      n_interior = self%n - self%n_retained
      loads = size(x, 2, kind=ip)
      associate (mumps => self%instance%mumps, n => self%n, n_retained => self%n_retained)
         allocate (mumps%rhs(int(n, lp)*int(loads, lp)), mumps%redrhs(int(n_retained, lp)*int(loads, lp)))
         mumps%nrhs = loads
         mumps%lrhs = n
         mumps%lredrhs = n_retained
         mumps%icntl(26) = mode
         do j = 1, loads
            first = int(j - 1, lp)*int(n, lp)
            mumps%rhs(first + 1:first + n) = x(:, j)*self%scale
            if (mode == EXPAND) mumps%redrhs(int(j - 1, lp)*int(n_retained, lp) + 1:int(j, lp)*int(n_retained, &
                                                                                                   lp)) = x(n_interior + 1:, j)
         end do
         call run_mumps(self%instance%mumps, SOLVE)
         do j = 1, loads
            first = int(j - 1, lp)*int(n, lp)
            if (mode == CONDENSE) then
               x(n_interior + 1:, j) = mumps%redrhs(int(j - 1, lp)*int(n_retained, lp) + 1:int(j, lp)*int(n_retained, lp))
            else
               x(:n_interior, j) = mumps%rhs(first + 1:first + n_interior)*self%scale(:n_interior)
            end if
         end do
         deallocate (mumps%rhs, mumps%redrhs)
      end associate
   end subroutine solve_with

   !> The factor as MUMPS counts it, and the rest.
   pure integer(lp) function mumps_memory(self)
      class(mumps_t), intent(in) :: self
      integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8

      mumps_memory = 0
      if (.not. associated(self%instance)) return
      mumps_memory = REAL_BYTES*(int(self%n, lp) + int(self%n_retained, lp)**2)
      associate (factor => self%instance%mumps%infog(29))
         ! a negative number counts millions
         if (self%n > self%n_retained) mumps_memory = mumps_memory &
                                                      + REAL_BYTES*merge(int(factor, lp), -1000000_lp*int(factor, lp), factor >= 0)
      end associate
   end function mumps_memory

   subroutine finish_mumps(self)
      type(mumps_t), intent(inout) :: self

      call free_instance(self)
   end subroutine finish_mumps

   !> Ends the instance and frees what MUMPS does not own.
   subroutine free_instance(self)
      class(mumps_t), intent(inout) :: self

      if (.not. associated(self%instance)) return
      associate (mumps => self%instance%mumps)
         nullify (mumps%irn, mumps%jcn, mumps%a, mumps%perm_in)    ! of the instance, and go with it
         if (associated(mumps%schur)) deallocate (mumps%schur, mumps%listvar_schur)
      end associate
      call run_mumps(self%instance%mumps, FINISH)
      deallocate (self%instance)
   end subroutine free_instance

end module atrito_mumps
