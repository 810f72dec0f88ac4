!> The limit of scenes A and P (scene-a.sh, scene-p.sh): their bodies glued together along the contact line, assembled, factored by
!> MUMPS (minimum degree, one thread) and solved once. No contact, no deck, no tables: what a linear solve costs.
!>
!>    gfortran -O3 -I/usr/include tests/bench/limit.f90 -o limit -ldmumps_seq -lopenblas
!>    OPENBLAS_NUM_THREADS=1 ./limit A|P K
!>
!> Prints the equations and the processor seconds of assembly, analysis, factorisation, solve and all of it.
program limit
   use, intrinsic :: iso_fortran_env, only: int64, real64
   implicit none
   include 'dmumps_struc.h'
   integer, parameter :: wp = real64
   type(dmumps_struc) :: id
   character(len=32) :: scene, word
   integer :: k
   integer, allocatable :: rectangles(:, :), number(:, :), equation(:, :), elements(:, :)
   real(wp) :: stiffness(8, 8), times(5)

   call get_command_argument(1, scene)
   call get_command_argument(2, word)
   read (word, *) k
   call cpu_time(times(1))
   if (scene == 'A') then
      rectangles = reshape([0, 32*k, 5*k, 11*k, 0, 6*k, 0, 5*k], [4, 2])
   else
      rectangles = reshape([k/2, k/2 + k, k, k + k/2, 0, 2*k, 0, k], [4, 2])
   end if
   call make_mesh()
   call make_stiffness()
   id%comm = 0
   id%par = 1
   id%sym = 1
   id%job = -1
   call dmumps(id)
   id%icntl(1:4) = 0
   id%icntl(7) = 0
   id%n = maxval(equation)
   call assemble()
   call cpu_time(times(2))
   id%job = 1
   call dmumps(id)
   call cpu_time(times(3))
   id%job = 2
   call dmumps(id)
   call cpu_time(times(4))
   allocate (id%rhs(id%n), source=1.0_wp)
   id%job = 3
   call dmumps(id)
   call cpu_time(times(5))
   if (id%infog(1) < 0) stop 1
   print '(a, i0, 5(a, f0.3))', 'equations ', id%n, '  assemble ', times(2) - times(1), '  analyse ', times(3) - times(2), &
      '  factor ', times(4) - times(3), '  solve ', times(5) - times(4), '  total ', times(5) - times(1)

contains

   !> Nodes on a lattice, one where the rectangles meet; equations of the free dofs.
   subroutine make_mesh()
      integer :: i, j, r, n, dof

      allocate (number(0:maxval(rectangles(2, :)), 0:maxval(rectangles(4, :))), source=0)
      n = 0
      do r = 1, 2
         do j = rectangles(3, r), rectangles(4, r)
            do i = rectangles(1, r), rectangles(2, r)
               if (number(i, j) > 0) cycle
               n = n + 1
               number(i, j) = n
            end do
         end do
      end do
      allocate (equation(2, n), elements(4, sum((rectangles(2, :) - rectangles(1, :))*(rectangles(4, :) - rectangles(3, :)))))
      n = 0
      do r = 1, 2
         do j = rectangles(3, r), rectangles(4, r) - 1
            do i = rectangles(1, r), rectangles(2, r) - 1
               n = n + 1
               elements(:, n) = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]
            end do
         end do
      end do
      equation = -1
      n = 0
      do r = 1, 2
         do j = rectangles(3, r), rectangles(4, r)
            do i = rectangles(1, r), rectangles(2, r)
               do dof = 1, 2
                  if (equation(dof, number(i, j)) >= 0) cycle
                  equation(dof, number(i, j)) = 0
                  if (held(i, j, dof)) cycle
                  n = n + 1
                  equation(dof, number(i, j)) = n
               end do
            end do
         end do
      end do
   end subroutine make_mesh

   logical function held(i, j, dof)
      integer, intent(in) :: i, j, dof

      if (scene == 'A') then
         held = j == 0 .or. (dof == 1 .and. i == 32*k)
      else
         held = j == 0 .or. j == k + k/2
      end if
   end function held

   !> A square in plane strain, 2 x 2 points; the side does not matter.
   subroutine make_stiffness()
      real(wp), parameter :: NU = 0.3_wp, E = 1000.0_wp/((1 + NU)*(1 - 2*NU)), G(2) = [-1, 1]/sqrt(3.0_wp)
      real(wp) :: d(3, 3), b(3, 8)
      integer :: p, q

      d = 0.0_wp
      d(1, 1) = E*(1 - NU)
      d(2, 2) = d(1, 1)
      d(1, 2) = E*NU
      d(2, 1) = d(1, 2)
      d(3, 3) = E*(1 - 2*NU)/2
      stiffness = 0.0_wp
      do p = 1, 2
         do q = 1, 2
            b = 0.0_wp
            b(1, 1:7:2) = 0.5_wp*[G(q) - 1, 1 - G(q), 1 + G(q), -1 - G(q)]
            b(2, 2:8:2) = 0.5_wp*[G(p) - 1, -1 - G(p), 1 + G(p), 1 - G(p)]
            b(3, 1:7:2) = b(2, 2:8:2)
            b(3, 2:8:2) = b(1, 1:7:2)
            stiffness = stiffness + 0.25_wp*matmul(transpose(b), matmul(d, b))
         end do
      end do
   end subroutine make_stiffness

   !> Lists a column as in atrito_mumps, so that the limit has the assembly that the program has.
   subroutine assemble()
      integer, allocatable :: newest(:), row(:), next(:)
      real(wp), allocatable :: values(:)
      integer :: e, a, b, i, j, n, at, following, eq(8)

      allocate (newest(id%n), source=0)
      allocate (row(36*size(elements, 2)), next(36*size(elements, 2)), values(36*size(elements, 2)))
      n = 0
      do e = 1, size(elements, 2)
         eq = reshape(equation(:, elements(:, e)), [8])
         do b = 1, 8
            j = eq(b)
            if (j == 0) cycle
            do a = 1, 8
               i = eq(a)
               if (i < j) cycle
               at = newest(j)
               do while (at /= 0)
                  if (row(at) == i) exit
                  at = next(at)
               end do
               if (at == 0) then
                  n = n + 1
                  at = n
                  row(at) = i
                  values(at) = 0.0_wp
                  next(at) = newest(j)
                  newest(j) = at
               end if
               values(at) = values(at) + stiffness(a, b)
            end do
         end do
      end do
      do j = 1, id%n
         at = newest(j)
         do while (at /= 0)
            following = next(at)
            next(at) = j
            at = following
         end do
      end do
      id%nnz = int(n, int64)
      allocate (id%irn(n), id%jcn(n), id%a(n))
      id%irn = row(:n)
      id%jcn = next(:n)
      id%a = values(:n)
   end subroutine assemble

end program limit
