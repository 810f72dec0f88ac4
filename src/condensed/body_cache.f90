!> The factored bodies of a scene, kept from one run to the next: a sweep over friction, penalty or loads factors each body once.
!>
!> A body is condensed once for all loads, all coefficients of friction and all contact laws, since its stiffness has none of them:
!> what a run of a sweep costs besides is the contact line. Within a history the bodies stay as long as the same dofs are held.
!>
!> Numbering and rigid motions serve again when mesh, supports and contact nodes are the same numbers; a factored body serves again
!> when its materials are, too; its reduced load when the load is the same as well. Nothing is guessed from what was varied.
module atrito_body_cache
   use atrito_assembly, only: fem_t
   use atrito_bilateral_rows, only: bilateral_rows_t
   use atrito_bodies, only: bodies_t
   use atrito_condensed_body, only: condensed_body_t, condense_body, check_held, set_load
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_plane_state, only: elastic_t
   use atrito_points, only: contact_points_t
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_results, only: body_result_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text
   use atrito_timers, only: start_phase, stop_phase
   implicit none (type, external)
   private
   public :: body_cache_t, provide_bodies, reload_bodies, take_numbering, release_bodies, forget_loads

   type :: body_cache_t
      type(reporter_t) :: reporter                     !< of factorisations
      logical :: keeps = .false.                       !< for a next run; costs a copy of the mesh
      integer(ip) :: factorisations = 0                !< of the last call of provide_bodies; behind a history of all
      type(condensed_body_t), allocatable :: bodies(:) !< as the last call of provide_bodies left them
      logical, private :: holds = .false.              !< the rest is there: what they were made of
      type(mesh_t), private :: mesh                    !< with which the bodies were made
      type(bodies_t), private :: numbering             !< of the bodies
      type(elastic_t), allocatable, private :: sections(:) !< one a combination of material and section
      integer(ip), allocatable, private :: section_of(:)   !< (n_elements)
      logical, allocatable, private :: held(:, :)      !< (2, n_nodes)
      type(contact_points_t), allocatable, private :: points(:) !< of each pair: which dofs are retained
      type(bilateral_rows_t), private :: bilateral              !< ties, equations, supports aslant
      integer, private :: asked = 0                    !< solver asked for
      real(wp), private :: digit_error = 0.0_wp        !< [L] of the elements that were taken as equal
      real(wp), allocatable, private :: load(:, :)     !< (2, n_nodes) [F] the reduced load
      type(body_result_t), allocatable, private :: results(:) !< (bodies) solver, memory, worst pivot
   end type body_cache_t

contains

   !> Condensed bodies with their reduced loads; those of the run before serve again where they can.
   !>
   !> status: STATUS_SINGULAR of condense_body.
   !>
   !> Body by body: one that may serve again (serves_again) is moved over without a copy; any other is assembled and factored. What
   !> is left in the store when something fails is nothing: a body that was taken back is not there any more.
   subroutine provide_bodies(store, fem, held, points, load, asked, results, status, bilateral)
      type(body_cache_t), intent(inout) :: store !< the factored bodies
      type(fem_t), intent(in) :: fem !< bodies and elements
      logical, intent(in) :: held(:, :)                !< (2, n_nodes)
      type(contact_points_t), intent(in) :: points(:)  !< one a pair: their nodes are retained
      real(wp), intent(in) :: load(:, :)               !< (2, n_nodes) [F], less the forces of prescribed displacements
      integer, intent(in) :: asked                     !< STORAGE_* or 0
      type(body_result_t), intent(inout) :: results(:) !< one a body
      type(status_t), intent(out) :: status            !< STATUS_SINGULAR or STATUS_INTERNAL of condense_body
      type(bilateral_rows_t), intent(in), optional :: bilateral !< without it there are none
      type(condensed_body_t), allocatable :: bodies(:)
      logical :: same_bodies, same_load
      integer(ip) :: b

      store%factorisations = 0
      same_bodies = .false.
      if (store%holds) same_bodies = store%asked == asked .and. store%digit_error == fem%digit_error &
                                     .and. has_same_numbering(store, held, points, fem, bilateral)
      ! until all is well nothing is in the store
      store%holds = .false.
      allocate (bodies(fem%bodies%n))
      do b = 1, fem%bodies%n
         if (fem%bodies%list(b)%is_rigid) then             ! nothing to factor
            call check_held(fem, b, status)
            if (.not. is_ok(status)) return
            cycle
         end if
         ! a body serves again with its reduced load, or with another one, or not at all
         same_load = .false.
         if (same_bodies) same_load = has_same_load(store, fem, b, load)
         if (serves_again(store, fem, b, same_bodies)) then
            call take_back(store, b, bodies(b), results(b))
         else
            same_load = .false.
            call report_progress(store%reporter, 'factor '//fem%bodies%list(b)%name)
            call condense_body(fem, b, asked, bodies(b), results(b), status)
            if (.not. is_ok(status)) return
            store%factorisations = store%factorisations + 1
         end if
         if (.not. same_load) then
            call start_phase('factor')
            call set_load(fem, b, load, bodies(b))
            call stop_phase('factor')
         end if
         call report_progress(store%reporter, 'body '//results(b)%name//'  dofs '//to_text(fem%bodies%list(b)%n) &
                              //'  contact dofs '//to_text(fem%bodies%list(b)%n_retained)//'  '//results(b)%solver)
      end do
      call move_alloc(bodies, store%bodies)
      if (.not. store%keeps) return
      call remember()
      if (present(bilateral)) store%bilateral = bilateral

   contains

      subroutine remember()

         store%holds = .true.
         store%asked = asked
         store%digit_error = fem%digit_error
         store%load = load
         store%results = results
         store%sections = fem%sections
         store%section_of = fem%section_of
         if (same_bodies) return
         store%mesh = fem%mesh
         store%numbering = fem%bodies
         store%held = held
         store%points = points
      end subroutine remember

   end subroutine provide_bodies

   !> The bodies as the last call of provide_bodies left them, with another load.
   !>
   !> The next increment of a history, or the next attempt at this one: factors stay, the forward substitution of the load is new.
   subroutine reload_bodies(store, fem, load)
      type(body_cache_t), intent(inout) :: store !< the factored bodies
      type(fem_t), intent(in) :: fem                   !< of that call
      real(wp), intent(in) :: load(:, :)               !< (2, n_nodes) [F], less the forces of prescribed displacements
      integer(ip) :: b

      call start_phase('factor')
      do b = 1, fem%bodies%n
         if (.not. fem%bodies%list(b)%is_rigid) call set_load(fem, b, load, store%bodies(b))
      end do
      call stop_phase('factor')
      if (store%holds) store%load = load
   end subroutine reload_bodies

   !> Gives the memory of the factored bodies back, unless they are kept for a next run.
   subroutine release_bodies(store)
      type(body_cache_t), intent(inout) :: store !< the factored bodies

      if (.not. store%keeps .and. allocated(store%bodies)) deallocate (store%bodies)
   end subroutine release_bodies

   !> The bodies have other loads than those that they were asked for with.
   !>
   !> What load_bodies has put there is no load that a next run could compare with: huge numbers equal none.
   pure subroutine forget_loads(store)
      type(body_cache_t), intent(inout) :: store !< the factored bodies

      if (store%holds) store%load = huge(store%load)
   end subroutine forget_loads

   !> Takes the bodies, their equations and rigid motions over from the scene before, where they would come out the same: how they
   !> are numbered depends on the solver.
   subroutine take_numbering(store, held, points, asked, fem, taken, bilateral)
      type(body_cache_t), intent(in) :: store          !< with the bodies of the scene before
      logical, intent(in) :: held(:, :)                !< (2, n_nodes)
      type(contact_points_t), intent(in) :: points(:)  !< one a pair: their nodes are retained
      integer, intent(in) :: asked                     !< STORAGE_* or 0
      type(fem_t), intent(inout) :: fem                !< with mesh and sections
      logical, intent(out) :: taken                    !< .false.: fem is as it was
      type(bilateral_rows_t), intent(in), optional :: bilateral !< without it there are none

      taken = .false.
      if (store%holds) taken = store%asked == asked .and. has_same_numbering(store, held, points, fem, bilateral)
      if (taken) fem%bodies = store%numbering
   end subroutine take_numbering

   !> Mesh, supports and contact nodes decide on bodies and numbering.
   !>
   !> Everything is compared number by number. A sweep over friction or loads passes; one over the mesh differs in the first
   !> coordinate.
   pure logical function has_same_numbering(store, held, points, fem, bilateral) result(same)
      type(body_cache_t), intent(in) :: store
      logical, intent(in) :: held(:, :)
      type(contact_points_t), intent(in) :: points(:)
      type(fem_t), intent(in) :: fem
      type(bilateral_rows_t), intent(in), optional :: bilateral
      integer(ip) :: i

      same = .false.
      if (size(store%points) /= size(points) .or. store%mesh%n_nodes /= fem%mesh%n_nodes &
          .or. store%mesh%n_elements /= fem%mesh%n_elements) return
      if (any(store%held .neqv. held) .or. any(store%mesh%x /= fem%mesh%x)) return
      if (any(store%mesh%shape /= fem%mesh%shape) .or. any(store%mesh%state /= fem%mesh%state)) return
      if (any(store%mesh%nodes /= fem%mesh%nodes)) return
      if (allocated(fem%mesh%thickness)) then          ! the states say that both have it
         if (any(store%mesh%thickness /= fem%mesh%thickness)) return
      end if
      do i = 1, size(points, kind=ip)
         associate (old => store%points(i), new => points(i))
            if (old%n /= new%n) return
            if (any(old%first /= new%first)) return
            if (any(old%entry /= new%entry)) return
         end associate
      end do
      if (present(bilateral)) then
         if (store%bilateral%n /= bilateral%n) return
         if (bilateral%n > 0) then
            if (size(store%bilateral%node) /= size(bilateral%node)) return
            if (any(store%bilateral%node /= bilateral%node)) return
         end if
      end if
      same = .true.
   end function has_same_numbering

   !> Whether a factored body is the same as one of this scene.
   !>
   !> Mesh, supports and contact nodes are those of the store already; what else a stiffness is made of are the sections of its
   !> elements.
   pure logical function serves_again(store, fem, b, same_bodies) result(again)
      type(body_cache_t), intent(in) :: store
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      logical, intent(in) :: same_bodies
      integer(ip) :: i, e

      again = .false.
      if (.not. same_bodies) return
      if (.not. allocated(store%bodies(b)%solver)) return
      do i = 1, size(fem%bodies%list(b)%elements, kind=ip)
         e = fem%bodies%list(b)%elements(i)
         if (.not. is_same_section(store%sections(store%section_of(e)), fem%sections(fem%section_of(e)))) return
      end do
      again = .true.
   end function serves_again

   !> Same stiffness; the density does not enter it.
   pure logical function is_same_section(a, b)
      type(elastic_t), intent(in) :: a, b

      is_same_section = a%young == b%young .and. a%poisson == b%poisson .and. a%thickness == b%thickness &
                        .and. a%formulation == b%formulation .and. (a%is_orthotropic .eqv. b%is_orthotropic)
      if (is_same_section .and. a%is_orthotropic) is_same_section = all(a%stiffness == b%stiffness)
   end function is_same_section

   pure logical function has_same_load(store, fem, b, load)
      type(body_cache_t), intent(in) :: store
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      real(wp), intent(in) :: load(:, :)
      integer(ip) :: i, n

      has_same_load = .false.
      do i = 1, size(fem%bodies%list(b)%nodes, kind=ip)
         n = fem%bodies%list(b)%nodes(i)
         if (any(store%load(:, n) /= load(:, n))) return
      end do
      has_same_load = .true.
   end function has_same_load

   !> Hands a kept body over without a copy.
   subroutine take_back(store, b, body, result)
      type(body_cache_t), intent(inout) :: store
      integer(ip), intent(in) :: b
      type(condensed_body_t), intent(inout) :: body
      type(body_result_t), intent(out) :: result

      call move_alloc(store%bodies(b)%solver, body%solver)
      call move_alloc(store%bodies(b)%factor, body%factor)
      call move_alloc(store%bodies(b)%load, body%load)
      body%is_near = store%bodies(b)%is_near
      result = store%results(b)
   end subroutine take_back

end module atrito_body_cache
