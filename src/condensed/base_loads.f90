!> The loads of a step as sums of a few: what acts at its beginning, what acts at its end, and what each amplitude multiplies.
!>
!>     load(t) = sum over k of factor_k(t) load_k
!>
!> What prescribed displacements do to the bodies, and what a load is on the contact dofs of a condensed body, are linear in the
!> loads: both are found once in a step, for each of the few, and an increment adds them up.
module atrito_base_loads
   use atrito_assembly, only: fem_t
   use atrito_condensed_body, only: condensed_body_t, set_load
   use atrito_internal_forces, only: internal_forces
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, step_t
   use atrito_nodal_loads, only: nodal_loads
   use atrito_rigid_bodies, only: has_moving_surfaces
   use atrito_scene_builder, only: list_held
   use atrito_step_loads, only: base_of, list_bases, BASE_BEGIN
   use atrito_thermal_loads, only: add_thermal_loads
   implicit none (type, external)
   private
   public :: base_loads_t, build_bases, load_of_bases, without_prescribed, load_bodies

   !> Reduced loads of a body.
   type :: reduced_t
      real(wp), allocatable :: x(:, :)              !< (n, bases) as condensed_body_t%load
   end type reduced_t

   type :: base_loads_t
      integer(ip), allocatable :: base(:)           !< BASE_BEGIN, BASE_END, or an amplitude
      real(wp), allocatable :: factor(:)            !< (bases) at the time of the increment
      real(wp), allocatable :: load(:, :, :)        !< (2, n_nodes, bases) less the forces of prescribed displacements [F]
      type(reduced_t), allocatable :: reduced(:)    !< (bodies); not allocated: not found yet
   end type base_loads_t

contains

   !> The bases of a step, where it has more increments than they are; else none. Surfaces that move have loads beside the nodes of
   !> the mesh: with them there are none, either, nor where loads are
   !> balanced to the digits of the deck (atrito_sliding_bodies).
   !>
   !> What acts at a time is sum_k factor_k(t) base_k: the loads at the beginning of the step, those at its end, and each
   !> amplitude's. So an increment costs a sum of vectors in place of an assembly of loads and a forward substitution for each body.
   subroutine build_bases(model, step, released, fem, bases)
      type(model_t), intent(in) :: model !< amplitudes, materials, sets
      type(step_t), intent(in) :: step   !< with its increments and what acts in it
      real(wp), allocatable, intent(in) :: released(:, :) !< (2, n_nodes) forces that fade [F]; not allocated: none
      type(fem_t), intent(inout) :: fem              !< its heating is as it was on return
      type(base_loads_t), allocatable, intent(out) :: bases !< not allocated: loads are assembled for each increment
      real(wp), allocatable :: heating(:)
      logical, allocatable :: acts(:)
      integer(ip) :: i

      ! what balances in their sum alone does not balance in the bases
      if (any([(allocated(fem%bodies%list(i)%slides), i=1, fem%bodies%n)])) return
      if (step%increments%period < (size(list_bases(step)) + 1)*step%increments%initial .or. has_moving_surfaces(model)) return
      allocate (bases)
      bases%base = list_bases(step)
      allocate (bases%load(2, model%mesh%n_nodes, size(bases%base)))
      if (allocated(fem%heating)) heating = fem%heating
      do i = 1, size(bases%base, kind=ip)
         call load_of_base(bases%base(i), bases%load(:, :, i))
      end do
      if (allocated(heating)) fem%heating = heating
      acts = [(any(bases%load(:, :, i) /= 0.0_wp), i=1, size(bases%base))]
      bases%load = bases%load(:, :, pack([(i, i=1, size(acts))], acts))
      bases%base = pack(bases%base, acts)
      allocate (bases%factor(size(bases%base)), source=0.0_wp)

   contains

      !> The load of one base: the forces at the nodes and of the temperatures, less what its prescribed displacements do. Forces of
      !> supports that the step does not have act at its beginning and fade.
      subroutine load_of_base(base, load)
         integer(ip), intent(in) :: base
         real(wp), intent(out) :: load(:, :)            !< (2, n_nodes) [F]
         type(step_t) :: acting
         logical, allocatable :: held(:, :)
         real(wp), allocatable :: f(:, :), value(:, :), thermal(:, :)

         call base_of(step, base, acting)
         call nodal_loads(model, acting, f)
         if (allocated(fem%heating)) then
            fem%heating = acting%heating
            allocate (thermal, mold=f)
            thermal = 0.0_wp
            call add_thermal_loads(fem, thermal)
         end if
         if (allocated(released) .and. base == BASE_BEGIN) f = f + released
         call list_held(model, acting, held, value)
         load = without_prescribed(fem, f, thermal, value)
      end subroutine load_of_base

   end subroutine build_bases

   !> Applied forces and those of the temperatures less those of the prescribed displacements.
   !>
   !> K u_prescribed of the elements at prescribed dofs: one pass over the mesh, where any of them is not zero.
   function without_prescribed(fem, f, thermal, value) result(load)
      type(fem_t), intent(in) :: fem !< bodies and elements
      real(wp), intent(in) :: f(:, :), value(:, :)   !< (2, n_nodes) [F], [L]
      real(wp), allocatable, intent(in) :: thermal(:, :) !< [F]; not allocated: none
      real(wp), allocatable :: load(:, :), force(:, :)
      real(wp) :: energy

      load = f
      if (allocated(thermal)) load = load + thermal
      if (all(value == 0.0_wp)) return
      allocate (force, mold=load)
      force = 0.0_wp
      energy = 0.0_wp
      call internal_forces(fem, value, force, energy)
      load = load - force
   end function without_prescribed

   !> The load that several bases make with their factors: sum of factor times load, (2, n_nodes) [F].
   pure function load_of_bases(bases) result(load)
      type(base_loads_t), intent(in) :: bases !< with the factors of the time
      real(wp), allocatable :: load(:, :)
      integer(ip) :: i

      allocate (load(2, size(bases%load, 2)), source=0.0_wp)
      do i = 1, size(bases%base, kind=ip)
         if (bases%factor(i) /= 0.0_wp) load = load + bases%factor(i)*bases%load(:, :, i)
      end do
   end function load_of_bases

   !> Gives the bodies the reduced load of the time that the factors are of.
   !>
   !> The reduced loads of the bases are found when they are first asked for, as they belong to the factors.
   subroutine load_bodies(fem, bases, bodies)
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(base_loads_t), intent(inout) :: bases !< reduced loads are found once a body, and kept
      type(condensed_body_t), intent(inout) :: bodies(:) !< factored; their loads are replaced
      integer(ip) :: b, i

      if (.not. allocated(bases%reduced)) call reduce_bases()
      do b = 1, size(bodies, kind=ip)
         bodies(b)%load = 0.0_wp
         do i = 1, size(bases%base, kind=ip)
            if (bases%factor(i) == 0.0_wp) cycle
            bodies(b)%load(:, 1) = bodies(b)%load(:, 1) + bases%factor(i)*bases%reduced(b)%x(:, i)
         end do
      end do

   contains

      subroutine reduce_bases()
         integer(ip) :: b, i

         allocate (bases%reduced(size(bodies)))
         do b = 1, size(bodies, kind=ip)
            allocate (bases%reduced(b)%x(fem%bodies%list(b)%n, size(bases%base)))
            do i = 1, size(bases%base, kind=ip)
               call set_load(fem, b, bases%load(:, :, i), bodies(b))
               bases%reduced(b)%x(:, i) = bodies(b)%load(:, 1)
            end do
         end do
      end subroutine reduce_bases

   end subroutine load_bodies

end module atrito_base_loads
