!> The factored bodies of a scene, kept from one run to the next: a sweep over friction, penalty or loads factors each body once.
!>
!> A kept body serves again when its elements, their nodes, coordinates, materials and equation numbers are the same numbers; its
!> reduced load serves again when the load is the same too. Nothing is guessed from what was varied.
module atrito_body_store
   use atrito_assembly, only: fem_t
   use atrito_condensed_body, only: condensed_body_t, condense_body, set_load
   use atrito_elasticity, only: elastic_t
   use atrito_kinds, only: ip, wp
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_results, only: body_result_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: body_store_t, provide_bodies

   type :: body_store_t
      logical :: keeps = .false.                       !< for a next run; costs a copy of the mesh
      integer(ip) :: factorisations = 0                !< of the last call of provide_bodies
      type(condensed_body_t), allocatable :: bodies(:) !< as the last call of provide_bodies left them
      type(fem_t), private :: fem                      !< what they were made of; only if keeps
      integer, private :: asked = 0                    !< storage asked for
      real(wp), allocatable, private :: load(:, :)     !< (2, n_nodes) [F] the reduced load
      type(body_result_t), allocatable, private :: results(:)
   end type body_store_t

contains

   !> Condensed bodies with their reduced loads; those of the run before serve again where they can.
   !>
   !> status: STATUS_SINGULAR of condense_body.
   subroutine provide_bodies(store, fem, load, asked, reporter, results, status)
      type(body_store_t), intent(inout) :: store
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: load(:, :)               !< (2, n_nodes) [F], less the forces of prescribed displacements
      integer, intent(in) :: asked                     !< STORAGE_* or 0
      type(reporter_t), intent(in) :: reporter
      type(body_result_t), intent(inout) :: results(:) !< one a body
      type(status_t), intent(out) :: status
      type(condensed_body_t), allocatable :: bodies(:)
      logical :: same_load
      integer(ip) :: b

      store%factorisations = 0
      allocate (bodies(fem%bodies%n))
      do b = 1, fem%bodies%n
         same_load = .false.
         if (serves_again(store, fem, b, asked)) then
            same_load = has_same_load(store, fem, b, load)
            call take_back(store, b, bodies(b), results(b))
         else
            call condense_body(fem, b, asked, bodies(b), results(b), status)
            if (.not. is_ok(status)) return
            store%factorisations = store%factorisations + 1
         end if
         if (.not. same_load) call set_load(fem, b, load, bodies(b))
         call report_body(reporter, fem, b, bodies(b), results(b))
      end do
      call move_alloc(bodies, store%bodies)
      if (store%keeps) call remember(store, fem, load, asked, results)
   end subroutine provide_bodies

   subroutine remember(store, fem, load, asked, results)
      type(body_store_t), intent(inout) :: store
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: load(:, :)
      integer, intent(in) :: asked
      type(body_result_t), intent(in) :: results(:)

      store%asked = asked
      store%load = load
      store%results = results
      if (store%factorisations > 0) store%fem = fem
   end subroutine remember

   !> Whether a kept body is the same body as one of this scene.
   pure logical function serves_again(store, fem, b, asked) result(again)
      type(body_store_t), intent(in) :: store
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      integer, intent(in) :: asked
      integer(ip) :: i, e, n

      again = .false.
      if (.not. allocated(store%results) .or. .not. allocated(store%bodies)) return
      if (store%asked /= asked .or. store%fem%bodies%n /= fem%bodies%n) return
      if (.not. allocated(store%bodies(b)%storage)) return
      associate (old => store%fem%bodies%list(b), new => fem%bodies%list(b))
         if (size(old%elements) /= size(new%elements) .or. size(old%nodes) /= size(new%nodes)) return
         if (old%n /= new%n .or. old%n_kept /= new%n_kept .or. size(old%modes, 2) /= size(new%modes, 2)) return
         if (any(old%elements /= new%elements) .or. any(old%nodes /= new%nodes)) return
         do i = 1, size(new%nodes, kind=ip)
            n = new%nodes(i)
            if (any(store%fem%mesh%x(:, n) /= fem%mesh%x(:, n))) return
            if (any(store%fem%bodies%equation(:, n) /= fem%bodies%equation(:, n))) return
         end do
         do i = 1, size(new%elements, kind=ip)
            e = new%elements(i)
            if (store%fem%mesh%shape(e) /= fem%mesh%shape(e) .or. store%fem%mesh%state(e) /= fem%mesh%state(e)) return
            if (any(store%fem%mesh%nodes(:, e) /= fem%mesh%nodes(:, e))) return
            if (.not. is_same_section(store%fem%sections(store%fem%section_of(e)), fem%sections(fem%section_of(e)))) return
         end do
      end associate
      again = .true.
   end function serves_again

   !> Same stiffness; the density does not enter it.
   pure logical function is_same_section(a, b)
      type(elastic_t), intent(in) :: a, b

      is_same_section = a%young == b%young .and. a%poisson == b%poisson .and. a%thickness == b%thickness
   end function is_same_section

   pure logical function has_same_load(store, fem, b, load)
      type(body_store_t), intent(in) :: store
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
      type(body_store_t), intent(inout) :: store
      integer(ip), intent(in) :: b
      type(condensed_body_t), intent(inout) :: body
      type(body_result_t), intent(out) :: result

      call move_alloc(store%bodies(b)%storage, body%storage)
      call move_alloc(store%bodies(b)%factor, body%factor)
      call move_alloc(store%bodies(b)%load, body%load)
      result = store%results(b)
   end subroutine take_back

   subroutine report_body(reporter, fem, b, body, result)
      type(reporter_t), intent(in) :: reporter
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      type(condensed_body_t), intent(in) :: body
      type(body_result_t), intent(in) :: result

      call report_progress(reporter, 'body '//result%name//'  dofs '//to_text(fem%bodies%list(b)%n)//'  contact dofs ' &
                           //to_text(fem%bodies%list(b)%n_kept)//'  '//body%storage%name())
   end subroutine report_body

end module atrito_body_store
