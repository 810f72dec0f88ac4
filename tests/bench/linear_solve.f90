!> What one linear solve of a deck's own scene costs: its bodies glued together, assembled, ordered, factored once by MUMPS and
!> solved once. Nothing else: no contact, no stresses, no tables. A run is measured by it (docs/performance.md).
!>
!> The matrix is a plain sum of element matrices. The order is MUMPS's own minimum degree (AMD), or nested dissection by METIS,
!> which is counted. What minimum degree finds depends on how the equations are numbered, by a factor of two and more, since ties
!> decide: count_operations tells which numbering is the cheapest.
!>
!> What is not needed any more goes before the factorisation, the mesh included, so that the peak memory of the process is that of
!> the solve.
module linear_solve
   use, intrinsic :: iso_c_binding, only: c_int, c_size_t
   use atrito_assembly, only: fem_t
   use coordinate_matrix, only: coordinate_matrix_t, begin_matrix, finish_matrix
   use atrito_kinds, only: ip, lp, wp
   use atrito_model, only: model_t
   use atrito_mumps, only: dmumps_struc, begin_mumps, run_mumps
   use atrito_nodal_loads, only: nodal_loads
   use atrito_points, only: contact_points_t
   use atrito_scene_builder, only: build_scene
   use atrito_status, only: status_t, set_status, is_ok, STATUS_INTERNAL, STATUS_SINGULAR
   use atrito_linear_solver, only: smallest_ratio
   use atrito_strings, only: to_text
   use atrito_timers, only: start_phase, stop_phase
   use glued_bodies, only: glued_t, glue_bodies, node_order, number_glued, count_entries, glued_load, assemble_glued, &
                           glued_displacements, NUMBERINGS
   use metis_order, only: order_by_metis
   implicit none (type, external)
   private
   public :: plan_t, solve_facts_t, solve_once, count_operations, ORDERINGS, AMD, METIS, SOLVE_PHASES

   character(len=5), parameter :: ORDERINGS(2) = ['amd  ', 'metis']
   integer, parameter :: AMD = 1, METIS = 2
   !> The phases that count.
   character(len=8), parameter :: SOLVE_PHASES(5) = ['assemble', 'order   ', 'analyse ', 'factor  ', 'solve   ']

   !> How to solve.
   type :: plan_t
      integer :: ordering = AMD                     !< place in ORDERINGS
      integer :: numbering = 1                      !< of the nodes, place in NUMBERINGS
      logical :: keeps_scene = .false.              !< the model stays, and u is found
   end type plan_t

   type :: solve_facts_t
      integer(ip) :: n_equations = 0
      integer(ip) :: n_glued = 0                    !< nodes that became one with another
      integer(ip) :: n_held = 0                     !< nodes held along the normal of a rigid surface, or altogether
      integer(lp) :: entries = 0, factor_entries = 0 !< of the lower triangle of the matrix, and of the factor
      integer(lp) :: memory = 0                     !< bytes that MUMPS took, the matrix not counted
      real(wp) :: operations = 0.0_wp               !< floating-point, of the factorisation, as the analysis counts them
      real(wp) :: largest = 0.0_wp                  !< [L] of the displacements that are not prescribed
      real(wp), allocatable :: u(:, :)              !< (2, n_nodes) [L] displacements of the glued bodies
   end type solve_facts_t

   ! JOB
   integer, parameter :: ANALYSE = 1, FACTOR = 2, SOLVE = 3, FINISH = -2
   ! INFOG(1)
   integer, parameter :: ZERO_PIVOT = -10, NO_ROOM = -9
   integer(lp), parameter :: MEGABYTE = 1000000_lp

   interface
      !> Of the C library: gives back what is free.
      integer(c_int) function malloc_trim(pad) bind(C)
         import :: c_int, c_size_t
         integer(c_size_t), value :: pad
      end function malloc_trim
   end interface

contains

   !> Solves. Afterwards the model is empty, unless the plan keeps it. status: STATUS_USAGE where the bodies cannot be glued,
   !> STATUS_SINGULAR where they are free to move although glued, STATUS_INTERNAL where a library is missing or fails.
   subroutine solve_once(model, plan, facts, status)
      type(model_t), intent(inout), target :: model
      type(plan_t), intent(in) :: plan
      type(solve_facts_t), intent(out) :: facts
      type(status_t), intent(out) :: status
      type(fem_t) :: fem
      type(glued_t) :: glued
      type(coordinate_matrix_t), target :: matrix
      integer(ip), allocatable :: place(:)
      real(wp), allocatable :: x(:, :), scale(:)

      call glue(model, plan%numbering, fem, glued, x, status)
      if (.not. is_ok(status)) return
      facts%n_equations = glued%n
      facts%n_glued = glued%n_glued
      facts%n_held = glued%n_held
      call assemble(fem, glued, matrix, x, scale, status)
      if (is_ok(status)) call order(fem, glued, plan%ordering, place, status)
      if (.not. is_ok(status)) return
      if (.not. plan%keeps_scene) then
         call forget(model, fem, glued)
         if (malloc_trim(0_c_size_t) < 0) return    ! never: 0 or 1
      end if
      call solve_by_mumps(matrix, place, scale, x, facts, status)
      if (.not. is_ok(status)) return
      facts%largest = maxval(abs(x))
      if (plan%keeps_scene) facts%u = glued_displacements(glued, x)
   end subroutine solve_once

   !> Operations of the factorisation as the analysis counts them: by AMD for each numbering, by METIS for the deck's; negative
   !> where METIS is missing.
   subroutine count_operations(model, amd_operations, metis_operations, status)
      type(model_t), intent(in), target :: model
      real(wp), intent(out) :: amd_operations(:)    !< (size(NUMBERINGS))
      real(wp), intent(out) :: metis_operations
      type(status_t), intent(out) :: status
      type(status_t) :: no_metis
      type(fem_t) :: fem
      type(glued_t) :: glued
      integer(ip), allocatable :: place(:)
      real(wp), allocatable :: x(:, :)
      integer :: i

      metis_operations = -1.0_wp
      do i = size(NUMBERINGS), 1, -1                ! the deck's is the last one
         call glue(model, i, fem, glued, x, status)
         if (is_ok(status)) call analyse_alone(fem, glued, x, place, amd_operations(i), status)
         if (.not. is_ok(status)) return
      end do
      call order(fem, glued, METIS, place, no_metis)
      if (is_ok(no_metis)) call analyse_alone(fem, glued, x, place, metis_operations, status)
   end subroutine count_operations

   !> Bodies, equations and load.
   subroutine glue(model, numbering, fem, glued, x, status)
      type(model_t), intent(in), target :: model
      integer, intent(in) :: numbering
      type(fem_t), intent(out) :: fem
      type(glued_t), intent(out) :: glued
      real(wp), allocatable, intent(out) :: x(:, :) !< (n, 1) [F] nodal forces
      type(status_t), intent(out) :: status
      type(contact_points_t), allocatable :: points(:)
      logical, allocatable :: held(:, :)
      real(wp), allocatable :: value(:, :), f(:, :)
      integer(ip), allocatable :: nodes(:)

      call start_phase('glue')
      call build_scene(model, model%steps(1), fem, held, value, points)
      call glue_bodies(model, held, value, points, glued, status)
      if (is_ok(status)) then
         call node_order(fem%mesh, numbering, nodes)
         call number_glued(fem%mesh, nodes, glued)
         call nodal_loads(model, model%steps(1), f)
         call glued_load(glued, f, x)
      end if
      call stop_phase('glue')
   end subroutine glue

   subroutine assemble(fem, glued, matrix, x, scale, status)
      type(fem_t), intent(in) :: fem
      type(glued_t), intent(in) :: glued
      type(coordinate_matrix_t), intent(out) :: matrix
      real(wp), intent(inout) :: x(:, :)            !< (n, 1) [F] the forces of prescribed displacements are added
      real(wp), allocatable, intent(out) :: scale(:) !< (n) of rows and columns
      type(status_t), intent(out) :: status
      integer(ip) :: empty
      integer :: no_memory

      call start_phase('assemble')
      call begin_matrix(matrix, glued%n, count_entries(fem%mesh, glued), no_memory)
      if (no_memory /= 0) then
         call set_status(status, STATUS_INTERNAL, 'not enough memory for the matrix')
         return
      end if
      call assemble_glued(fem, glued, matrix, x)
      allocate (scale(glued%n))
      call finish_matrix(matrix, glued%n, scale, empty)
      call stop_phase('assemble')
   end subroutine assemble

   !> place stays unallocated where MUMPS is to find the order itself.
   subroutine order(fem, glued, ordering, place, status)
      type(fem_t), intent(in) :: fem
      type(glued_t), intent(in) :: glued
      integer, intent(in) :: ordering
      integer(ip), allocatable, intent(out) :: place(:)
      type(status_t), intent(out) :: status

      call start_phase('order')
      if (ordering == METIS) then
         call order_by_metis(fem%mesh, glued, place)
         if (.not. allocated(place)) call set_status(status, STATUS_INTERNAL, 'METIS is missing, or failed')
      end if
      call stop_phase('order')
   end subroutine order

   pure subroutine forget(model, fem, glued)
      type(model_t), intent(out) :: model
      type(fem_t), intent(out) :: fem
      type(glued_t), intent(out) :: glued
   end subroutine forget

   subroutine solve_by_mumps(matrix, place, scale, x, facts, status)
      type(coordinate_matrix_t), intent(inout), target :: matrix
      integer(ip), allocatable, intent(inout), target :: place(:)
      real(wp), intent(in) :: scale(:)
      real(wp), intent(inout) :: x(:, :)            !< (n, 1): nodal forces in, displacements out
      type(solve_facts_t), intent(inout) :: facts
      type(status_t), intent(out) :: status
      type(dmumps_struc) :: instance

      call analyse_matrix(matrix, place, instance, facts, status)
      if (.not. is_ok(status)) return
      call start_phase('factor')
      call run_mumps(instance, FACTOR)
      if (instance%infog(1) == NO_ROOM) then
         instance%icntl(14) = 200
         call run_mumps(instance, FACTOR)
      end if
      call stop_phase('factor')
      call judge(instance, status)
      if (is_ok(status)) then
         facts%factor_entries = in_millions(instance%infog(29))
         facts%memory = MEGABYTE*int(instance%infog(22), lp)
         call start_phase('solve')
         allocate (instance%rhs(matrix%n))
         instance%rhs = x(:, 1)*scale
         call run_mumps(instance, SOLVE)
         x(:, 1) = instance%rhs*scale
         deallocate (instance%rhs)
         call stop_phase('solve')
      end if
      call finish_instance(instance)
   end subroutine solve_by_mumps

   !> The matrix of glued bodies as far as its analysis.
   subroutine analyse_alone(fem, glued, load, place, operations, status)
      type(fem_t), intent(in) :: fem
      type(glued_t), intent(in) :: glued
      real(wp), intent(in) :: load(:, :)
      integer(ip), allocatable, intent(inout), target :: place(:)
      real(wp), intent(out) :: operations
      type(status_t), intent(out) :: status
      type(coordinate_matrix_t), target :: matrix
      type(dmumps_struc) :: instance
      type(solve_facts_t) :: facts
      real(wp), allocatable :: x(:, :), scale(:)

      operations = 0.0_wp
      x = load
      call assemble(fem, glued, matrix, x, scale, status)
      if (is_ok(status)) call analyse_matrix(matrix, place, instance, facts, status)
      if (.not. is_ok(status)) return
      operations = facts%operations
      call finish_instance(instance)
   end subroutine analyse_alone

   !> Shows the matrix to MUMPS, and the order where there is one, and has it analysed.
   subroutine analyse_matrix(matrix, place, instance, facts, status)
      type(coordinate_matrix_t), intent(in), target :: matrix
      integer(ip), allocatable, intent(in), target :: place(:)
      type(dmumps_struc), intent(out) :: instance
      type(solve_facts_t), intent(inout) :: facts
      type(status_t), intent(out) :: status

      call start_phase('analyse')
      call begin_mumps(instance, status)
      if (.not. is_ok(status)) return
      instance%n = matrix%n
      instance%nnz = int(matrix%entries, lp)
      instance%irn => matrix%row
      instance%jcn => matrix%column
      instance%a => matrix%values
      if (allocated(place)) then
         instance%perm_in => place
         instance%icntl(7) = 1                      ! the order that is given
      end if
      call run_mumps(instance, ANALYSE)
      call stop_phase('analyse')
      if (instance%infog(1) < 0) call judge(instance, status)
      facts%entries = instance%nnz
      facts%operations = instance%rinfog(1)
   end subroutine analyse_matrix

   !> The diagonal is about 1, so the smallest pivot tells the digits lost.
   subroutine judge(instance, status)
      type(dmumps_struc), intent(in) :: instance
      type(status_t), intent(inout) :: status
      logical :: singular

      singular = instance%infog(1) == ZERO_PIVOT
      if (instance%infog(1) < 0 .and. .not. singular) then
         call set_status(status, STATUS_INTERNAL, 'MUMPS failed: INFOG(1:2) = '//to_text(int(instance%infog(1), ip))//', '// &
                         to_text(int(instance%infog(2), ip)))
         return
      end if
      if (.not. singular) singular = instance%rinfog(19) <= smallest_ratio(instance%n) .or. instance%infog(12) > 0
      if (singular) call set_status(status, STATUS_SINGULAR, 'the bodies are free to move although glued together')
   end subroutine judge

   subroutine finish_instance(instance)
      type(dmumps_struc), intent(inout) :: instance

      nullify (instance%irn, instance%jcn, instance%a, instance%perm_in)    ! they are the caller's
      call run_mumps(instance, FINISH)
   end subroutine finish_instance

   !> A number as MUMPS tells it: a negative one counts millions.
   elemental integer(lp) function in_millions(told)
      integer, intent(in) :: told

      in_millions = int(told, lp)
      if (told < 0) in_millions = -MEGABYTE*int(told, lp)
   end function in_millions

end module linear_solve
