!> A system that several ranks share, against LAPACK: run by mpirun with any number of ranks. All of them make the same random
!> matrices and know whose each of them is, so rank 0 has the sum as well. Exit 1 and lines of what is wrong where anything is.
!>
!>     mpirun -n N mumps_probe
program mumps_probe
   use, intrinsic :: iso_fortran_env, only: error_unit
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_mpi, only: begin_ranks, end_ranks, own_rank, rank_count, sum_over_ranks
   use atrito_mumps, only: mumps_system_t, begin_mumps_system, end_mumps_system, factor_mumps_system, mumps_system_bytes, &
                           solve_mumps_system
   use atrito_status, only: status_t, is_ok, STATUS_SINGULAR
   implicit none (type, external)

   !> All matrices of all ranks.
   type :: scene_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: start(:)       !< (matrices + 1)
      integer(ip), allocatable :: unknown(:)
      integer(ip), allocatable :: owner(:)       !< (matrices) rank
      real(wp), allocatable :: matrices(:, :, :) !< (most, most, matrices)
      real(wp), allocatable :: total(:, :)       !< (n, n) their sum
   end type scene_t

   !> An error over n, epsilon and the size of what is compared.
   real(wp), parameter :: LIMIT = 100.0_wp
   integer(ip) :: failures = 0, shift
   real(wp) :: found(1)

   call begin_ranks()
   call random_init(.true., .false.)             ! the same numbers on all ranks
   do shift = 0, 1
      call try_system('a matrix a rank', 40_ip, rank_count(), shift, 1.0_wp)
      call try_system('two matrices a rank', 60_ip, 2*rank_count() + 1, shift, 1.0_wp)
      call try_system('one matrix: the others have none', 30_ip, 1_ip, shift, 1.0_wp)
      call try_system('a single unknown', 1_ip, 2_ip, shift, 1.0_wp)
      call try_system('large', 900_ip, 4_ip, shift, 1.0_wp)
      call try_system('large numbers', 60_ip, 5_ip, shift, 1.0e150_wp)
      call try_system('small numbers', 60_ip, 5_ip, shift, 1.0e-150_wp)
   end do
   call try_mixed_units()
   call try_singular('a free chain', 40_ip, .false.)
   call try_singular('a large free chain', 900_ip, .false.)
   call try_singular('an empty unknown', 40_ip, .true.)
   call try_negative()
   call try_free_block()
   found = real(failures, wp)
   call sum_over_ranks(found)
   call end_ranks()
   if (found(1) > 0.0_wp) stop 1, quiet = .true.

contains

   !> Notes what is not as it should be.
   subroutine expect(holds, what)
      logical, intent(in) :: holds
      character(len=*), intent(in) :: what

      if (holds) return
      failures = failures + 1
      write (error_unit, '(a,i0,a)') 'rank ', own_rank(), ': '//what
   end subroutine expect

   !> Random matrices over some of the unknowns, positive definite by their diagonals.
   subroutine make_scene(n, count, shift, size_of, scene)
      integer(ip), intent(in) :: n, count
      integer(ip), intent(in) :: shift           !< of the owners
      real(wp), intent(in) :: size_of            !< of the entries
      type(scene_t), intent(out) :: scene
      integer(ip) :: m, i, last
      integer(ip), allocatable :: own(:)
      real(wp), allocatable :: a(:, :)

      scene%n = n
      scene%owner = [(modulo(m + shift, rank_count()), m=1, count)]
      allocate (scene%start(count + 1), scene%unknown(count*n), scene%matrices(n, n, count), scene%total(n, n))
      scene%matrices = 0.0_wp
      scene%total = 0.0_wp
      last = 0
      do m = 1, count
         scene%start(m) = last + 1
         ! every third unknown at least, in an order of their own
         own = pack([(modulo(i*7 + m, n) + 1, i=1, n)], [(count == 1 .or. modulo(i*(m + 2), 5) < 3 .or. modulo(i, count) == &
                                                          modulo(m, count), i=1, n)])
         if (modulo(n, 7) == 0) own = [(i, i=1, n)]
         allocate (a(size(own), size(own)))
         call random_number(a)
         a = size_of*(a + transpose(a) - 1.0_wp)
         do i = 1, size(own, kind=ip)
            a(i, i) = size_of*real(size(own), wp)
         end do
         scene%unknown(last + 1:last + size(own)) = own
         scene%matrices(:size(own), :size(own), m) = a
         scene%total(own, own) = scene%total(own, own) + a
         last = last + size(own, kind=ip)
         deallocate (a)
      end do
      scene%start(count + 1) = last + 1
   end subroutine make_scene

   !> Begins the system with the unknowns of the matrices of this rank.
   subroutine begin_own(scene, system)
      type(scene_t), intent(in) :: scene
      type(mumps_system_t), intent(inout) :: system
      type(status_t) :: status

      call begin_mumps_system(system, scene%n, own_unknowns(scene), status)
      call expect(is_ok(status), 'begin_mumps_system fails')
      if (.not. is_ok(status)) error stop 1
   end subroutine begin_own

   !> Those of all matrices of this rank, each once, the last first.
   function own_unknowns(scene) result(unknown)
      type(scene_t), intent(in) :: scene
      integer(ip), allocatable :: unknown(:)
      logical :: is_own(scene%n)
      integer(ip) :: m, i

      is_own = .false.
      do m = 1, size(scene%owner, kind=ip)
         if (scene%owner(m) == own_rank()) is_own(scene%unknown(scene%start(m):scene%start(m + 1) - 1)) = .true.
      end do
      unknown = pack([(i, i=scene%n, 1, -1)], is_own(scene%n:1:-1))
   end function own_unknowns

   !> Hands over the sum of the matrices of this rank and factors.
   subroutine factor_own(scene, system, status)
      type(scene_t), intent(in) :: scene
      type(mumps_system_t), intent(inout) :: system
      type(status_t), intent(out) :: status
      real(wp), allocatable :: values(:)
      real(wp) :: total(scene%n, scene%n)
      integer(ip) :: m, i, j

      total = 0.0_wp
      do m = 1, size(scene%owner, kind=ip)
         if (scene%owner(m) /= own_rank()) cycle
         associate (own => scene%unknown(scene%start(m):scene%start(m + 1) - 1))
            total(own, own) = total(own, own) + scene%matrices(:size(own), :size(own), m)
         end associate
      end do
      associate (own => own_unknowns(scene))
         values = [((total(own(i), own(j)), i=j, size(own, kind=ip)), j=1, size(own, kind=ip))]
      end associate
      call factor_mumps_system(system, values, status)
   end subroutine factor_own

   subroutine try_system(what, n, count, shift, size_of)
      character(len=*), intent(in) :: what
      integer(ip), intent(in) :: n, count, shift
      real(wp), intent(in) :: size_of
      type(scene_t) :: scene
      type(mumps_system_t) :: system
      type(status_t) :: status
      integer(ip) :: again

      call make_scene(n, count, shift, size_of, scene)
      call begin_own(scene, system)
      do again = 1, 2
         call factor_own(scene, system, status)
         if (.not. is_ok(status)) then
            call expect(.false., what//': factor_mumps_system fails: '//status%text)
            exit
         end if
         call expect(mumps_system_bytes(system) >= 8*int(n, lp), what//': no memory')
         call check_solutions(what, scene, system)
         scene%matrices = 3.0_wp*scene%matrices     ! other values of the same pattern
         scene%matrices(1, 1, :) = 2.0_wp*scene%matrices(1, 1, :)
         call add_up(scene)
      end do
      call end_mumps_system(system)
   end subroutine try_system

   subroutine add_up(scene)
      type(scene_t), intent(inout) :: scene
      integer(ip) :: m

      scene%total = 0.0_wp
      do m = 1, size(scene%owner, kind=ip)
         associate (own => scene%unknown(scene%start(m):scene%start(m + 1) - 1))
            scene%total(own, own) = scene%total(own, own) + scene%matrices(:size(own), :size(own), m)
         end associate
      end do
   end subroutine add_up

   pure logical function is_close(found, expected, measure)
      real(wp), intent(in) :: found(:, :), expected(:, :), measure

      is_close = all(abs(found - expected) <= LIMIT*EPS_MACH*real(max(size(found, 1), 10), wp)*measure)
   end function is_close

   !> The residual of two loads.
   subroutine check_solutions(what, scene, system)
      character(len=*), intent(in) :: what
      type(scene_t), intent(in) :: scene
      type(mumps_system_t), intent(inout) :: system
      type(status_t) :: status
      real(wp) :: x(scene%n, 2), f(scene%n, 2)
      integer :: i

      call random_number(x)
      f = matmul(scene%total, x)
      x = f
      do i = 1, 2
         call solve_mumps_system(system, x(:, i), status)
         call expect(is_ok(status), what//': solve_mumps_system fails')
      end do
      if (own_rank() > 0) return
      call expect(is_close(matmul(scene%total, x), f, maxval(sum(abs(scene%total), 1))*max(1.0_wp, maxval(abs(x)))), what// &
                  ': the residual is large')
   end subroutine check_solutions

   !> Unknowns of units far apart.
   subroutine try_mixed_units()
      type(scene_t) :: scene
      type(mumps_system_t) :: system
      type(status_t) :: status
      real(wp), allocatable :: unit(:)
      real(wp) :: x(50, 1)
      integer(ip) :: i, m

      call make_scene(50_ip, 5_ip, 0_ip, 1.0_wp, scene)
      unit = [(10.0_wp**(modulo(i*11, 101) - 50), i=1, 50)]
      do m = 1, 5
         associate (own_ones => scene%unknown(scene%start(m):scene%start(m + 1) - 1))
            do i = 1, size(own_ones, kind=ip)
               scene%matrices(:size(own_ones), i, m) = scene%matrices(:size(own_ones), i, m)*unit(own_ones)*unit(own_ones(i))
            end do
         end associate
      end do
      call begin_own(scene, system)
      call factor_own(scene, system, status)
      call expect(is_ok(status), 'mixed units')
      x(:, 1) = matmul(scene%total, [(1.0_wp, i=1, 50)])*unit
      call solve_mumps_system(system, x(:, 1), status)
      if (own_rank() == 0) call expect(all(abs(x(:, 1)*unit - 1.0_wp) < 1.0e-8_wp), 'mixed units: the solution')
      call end_mumps_system(system)
   end subroutine try_mixed_units

   !> Springs of stiffness 1 from each unknown to the next, shared out; what holds the first one as well.
   subroutine make_chain(n, hold, scene)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: hold
      type(scene_t), intent(out) :: scene
      integer(ip) :: i, k

      scene%n = n
      scene%owner = [(modulo(k, rank_count()), k=1, n - 1)]
      scene%start = [(2*k - 1, k=1, n)]
      scene%unknown = [((i, i=k, k + 1), k=1, n - 1)]
      allocate (scene%matrices(2, 2, n - 1), scene%total(n, n))
      scene%matrices(1, 1, :) = 1.0_wp
      scene%matrices(2, 2, :) = 1.0_wp
      scene%matrices(1, 2, :) = -1.0_wp
      scene%matrices(2, 1, :) = -1.0_wp
      scene%matrices(1, 1, 1) = 1.0_wp + hold
      call add_up(scene)
   end subroutine make_chain

   !> A chain that nothing holds. `empty`: unknown 3 has no stiffness.
   subroutine try_singular(what, n, empty)
      character(len=*), intent(in) :: what
      integer(ip), intent(in) :: n
      logical, intent(in) :: empty
      type(scene_t) :: scene
      type(mumps_system_t) :: system
      type(status_t) :: status

      call make_chain(n, merge(1.0_wp, 0.0_wp, empty), scene)
      if (empty) scene%matrices(:, :, 2:3) = 0.0_wp
      call begin_own(scene, system)
      call factor_own(scene, system, status)
      call expect(status%code == STATUS_SINGULAR, what//' is not found to be singular')
      call expect(own_rank() > 0 .or. (system%weakest > 0 .and. system%weakest <= n), what//': its unknown')
      if (empty) call expect(own_rank() > 0 .or. system%weakest == 3, what//' is not named')
      ! and a matrix that is regular afterwards
      call make_chain(n, 1.0_wp, scene)
      call factor_own(scene, system, status)
      call expect(is_ok(status), what//': held, it is singular still')
      call check_solutions(what, scene, system)
      call end_mumps_system(system)
   end subroutine try_singular

   !> A dense block that nothing holds, so large that all ranks factor its front together.
   subroutine try_free_block()
      type(scene_t) :: scene
      type(mumps_system_t) :: system
      type(status_t) :: status
      integer(ip) :: i
      real(wp), parameter :: HOLD(2) = [0.0_wp, 1.0e-3_wp]

      call make_scene(800_ip, 1_ip, 0_ip, 1.0_wp, scene)
      call begin_own(scene, system)
      do i = 1, 2
         scene%matrices = -1.0_wp
         call set_diagonal(scene%matrices(:, :, 1), 799.0_wp + HOLD(i))
         call factor_own(scene, system, status)
         call expect(is_ok(status) .eqv. i == 2, 'a large block: status')
         if (i == 1) call expect(own_rank() > 0 .or. system%weakest > 0, 'a large block: its unknown')
      end do
      call end_mumps_system(system)
   end subroutine try_free_block

   pure subroutine set_diagonal(matrix, value)
      real(wp), intent(inout) :: matrix(:, :)
      real(wp), intent(in) :: value
      integer(ip) :: i

      do i = 1, size(matrix, 1, kind=ip)
         matrix(i, i) = value
      end do
   end subroutine set_diagonal

   !> A negative pivot.
   subroutine try_negative()
      type(scene_t) :: scene
      type(mumps_system_t) :: system
      type(status_t) :: status

      call make_scene(50_ip, 4_ip, 0_ip, 1.0_wp, scene)
      scene%matrices(3, 3, 1) = -1000.0_wp
      call begin_own(scene, system)
      call factor_own(scene, system, status)
      call expect(status%code == STATUS_SINGULAR, 'a negative pivot passes')
      call end_mumps_system(system)
   end subroutine try_negative

end program mumps_probe
