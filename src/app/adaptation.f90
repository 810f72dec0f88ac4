!> --adapt P: the mesh is cut where the error is, and the deck solved again, until the error is at most P percent.
!>
!> Of the squares of the elements' errors the largest are taken that make up half of the sum (W. Doerfler, SIAM J. Numer. Anal. 33,
!> 1996); their leaves are cut (atrito_element_trees).
module atrito_adaptation
   use atrito_command_line, only: command_t
   use atrito_element_trees, only: count_leaves, cut_leaves, element_trees_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_memory, only: available_memory, held_memory
   use atrito_messages, only: message_t, count_messages, get_message, SEVERITY_ERROR
   use atrito_model, only: model_t
   use atrito_model_memory, only: most_nodes
   use atrito_results, only: frame_numbers_t, history_t, results_t, view_frame
   use atrito_sorting, only: order_key, sorted_places
   use atrito_strings, only: to_text
   use atrito_system, only: processor_seconds
   use atrito_table, only: table_t, add_integers, add_reals, begin_table
   implicit none (type, external)
   private
   public :: adaptation_t, adapted_mesh_t, begin_adaptation, follow_error, build_adaptation, adaptation_text, give_up, &
             mesh_text, missed_text

   real(wp), parameter :: BULK = 0.5_wp              !< of the sum of squares, that of the elements which are cut ...
   real(wp), parameter :: LEAST_BULK = 0.1_wp        !< ... less where less is enough: cut in four they have some quarter of it left
   real(wp), parameter :: ENOUGH = 2.0_wp            !< over what has to go of the sum of squares
   real(wp), parameter :: ALIKE = 1.0e-6_wp          !< errors that differ by less are cut together: symmetric meshes stay so
   integer, parameter :: PATIENCE = 4                !< meshes, one after the other, ...
   real(wp), parameter :: PROGRESS = 0.97_wp         !< ... over which the error has to fall by this factor
   real(wp), parameter :: MEMORY_GROWTH = 1.2_wp     !< memory goes with this power of the number of nodes, at the most

   !> A mesh that was solved.
   type :: adapted_mesh_t
      integer(ip) :: n_elements = 0, n_dofs = 0, n_solves = 0 !< of the mesh, and linear solves on it
      real(wp) :: percent = 0.0_wp                   !< of the error
      logical :: is_certified = .false.              !< it is at most that
      real(wp) :: seconds(2) = 0.0_wp                !< wall clock and processor, from the beginning of the run
   end type adapted_mesh_t

   !> What --adapt has come to.
   type :: adaptation_t
      real(wp) :: target = 0.0_wp                    !< percent; 0: the mesh stays as it is
      type(element_trees_t) :: trees                 !< elements of the deck, as they are cut so far
      type(adapted_mesh_t), allocatable :: meshes(:) !< that were solved, in their order
      character(len=:), allocatable :: why           !< the error is larger than it was to be; not allocated: it is not
      integer(lp) :: began = 0                       !< count of system_clock at the beginning
      real(wp) :: processor = 0.0_wp                 !< seconds at the beginning
   end type adaptation_t

contains

   !> What --adapt asks for, and when it began.
   subroutine begin_adaptation(command, adaptation)
      type(command_t), intent(in) :: command         !< its --adapt is read
      type(adaptation_t), intent(out) :: adaptation  !< at the mesh of the deck; the clock runs

      adaptation%target = command%adapt
      allocate (adaptation%meshes(0))
      call system_clock(adaptation%began)
      adaptation%processor = processor_seconds()
   end subroutine begin_adaptation

   !> The bound of the error of an increment, or its estimate [%].
   elemental real(wp) function error_of(frame) result(percent)
      class(frame_numbers_t), intent(in) :: frame

      percent = merge(frame%error_bound%percent, frame%error_estimate, frame%error_bound%exists)
   end function error_of

   !> Notes what was found on a mesh, and cuts it for the next one: of a history where the printed increment with the largest error
   !> has it. goes_on: there is to be a next one.
   !>
   !> To come from the error e [%] down to the target the share 1 - (target/e)^2 of the sum of squares has to go; the elements that
   !> have twice that share are cut, at least those with a tenth and at most those with half.
   subroutine follow_error(model, history, adaptation, goes_on)
      type(model_t), intent(in) :: model             !< whose history it is
      type(history_t), intent(in), target :: history !< with frames
      type(adaptation_t), intent(inout) :: adaptation !< gets the mesh; its trees are cut
      logical, intent(out) :: goes_on                !< the error is too large, and can be followed
      type(adapted_mesh_t) :: mesh
      real(wp), allocatable :: squares(:)
      type(results_t), pointer :: results
      integer(lp) :: now, rate

      call view_frame(history, maxloc(error_of(history%frames), dim=1, kind=ip), results)
      ! In one place: the square of each element's share, and the error of the whole [%], of the bound where there is one, else
      ! of the estimate.
      squares = results%element_error**2
      mesh%percent = error_of(results)
      mesh%is_certified = results%error_bound%is_certified
      mesh%n_elements = model%mesh%n_elements
      mesh%n_dofs = results%scene%n_dofs
      mesh%n_solves = size(history%iterations, kind=ip)
      call system_clock(now, rate)
      mesh%seconds = [real(now - adaptation%began, wp)/real(rate, wp), processor_seconds() - adaptation%processor]
      adaptation%meshes = [adaptation%meshes, mesh]
      goes_on = mesh%percent > adaptation%target
      if (.not. goes_on) return
      call cut_where_errors_are(squares, min(BULK, max(LEAST_BULK, ENOUGH*(1 - (adaptation%target/mesh%percent)**2))), &
                                adaptation%trees)
      call look_for_limit(model, results, adaptation)
      goes_on = .not. allocated(adaptation%why)
   end subroutine follow_error

   !> Cuts the leaves with the largest errors.
   pure subroutine cut_where_errors_are(squares, part, trees)
      real(wp), intent(in) :: squares(:)             !< of the elements of the mesh
      real(wp), intent(in) :: part                   !< of the sum of squares, that they have together
      type(element_trees_t), intent(inout) :: trees
      real(wp) :: of_leaf(trees%n), total
      integer(ip) :: order(trees%n), e, n

      of_leaf = 0.0_wp
      do e = 1, size(squares, kind=ip)
         of_leaf(trees%leaf_of(e)) = of_leaf(trees%leaf_of(e)) + squares(e)
      end do
      order = sorted_places(order_key(-of_leaf))
      total = 0.0_wp
      do n = 1, trees%n
         total = total + of_leaf(order(n))
         if (total >= part*sum(of_leaf)) exit
      end do
      do while (n < trees%n)
         if (of_leaf(order(n + 1)) < (1 - ALIKE)*of_leaf(order(n))) exit
         n = n + 1
      end do
      call cut_leaves(order(:n), trees)
   end subroutine cut_where_errors_are

   !> Whether the next mesh is not to be made: why.
   subroutine look_for_limit(model, results, adaptation)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(adaptation_t), intent(inout) :: adaptation
      real(wp) :: growth, nodes, memory
      integer :: n

      n = size(adaptation%meshes)
      associate (before => model%mesh%n_elements, after => count_leaves(adaptation%trees), meshes => adaptation%meshes)
         growth = max(real(after, wp)/real(before, wp), 1.0_wp)
         nodes = growth*real(model%mesh%n_nodes, wp)
         memory = real(results%scene%memory, wp)*growth**MEMORY_GROWTH
         if (n > PATIENCE) then
            if (meshes(n)%percent > PROGRESS*meshes(n - PATIENCE)%percent) adaptation%why = &
               'over the last '//to_text(int(PATIENCE, ip))// &
               ' meshes it has not become smaller, as where a single node is held or loaded'
         end if
         if (nodes > real(most_nodes(), wp)) then
            adaptation%why = 'the next mesh would have more than '//to_text(most_nodes())//' nodes'
         else if (memory > real(available_memory() + held_memory(), wp)) then
            adaptation%why = 'the next mesh would need more memory than there is'
         end if
      end associate
   end subroutine look_for_limit

   !> The next mesh cannot be built: the first error says why.
   subroutine give_up(adaptation)
      type(adaptation_t), intent(inout) :: adaptation !< gets the reason
      type(message_t) :: message
      integer(ip) :: i

      do i = 1, count_messages()
         message = get_message(i)
         if (message%severity == SEVERITY_ERROR) exit
      end do
      adaptation%why = 'the next mesh is no good'
      if (i <= count_messages()) adaptation%why = adaptation%why//' ('//message%text//')'
   end subroutine give_up

   !> adapt.tab.
   subroutine build_adaptation(adaptation, table)
      type(adaptation_t), intent(in) :: adaptation   !< of a run that used it
      type(table_t), intent(out) :: table            !< a row a mesh
      integer(ip) :: i, n

      associate (meshes => adaptation%meshes)
         n = size(meshes, kind=ip)
         call begin_table(table, 'adapt', 'a row a mesh; seconds from the beginning of the run', n)
         call add_integers(table, 'mesh', [(i, i=1, n)])
         call add_integers(table, 'elements', meshes%n_elements)
         call add_integers(table, 'dofs', meshes%n_dofs)
         call add_reals(table, 'error_percent', '%', meshes%percent, 0.0_wp)
         call add_integers(table, 'linear_solves', meshes%n_solves)
         call add_reals(table, 'total_wall', 's', meshes%seconds(1), 0.0_wp)
         call add_reals(table, 'total_cpu', 's', meshes%seconds(2), 0.0_wp)
         call add_integers(table, 'certified', merge(1_ip, 0_ip, meshes%is_certified))
      end associate
   end subroutine build_adaptation

   !> `mesh 4: 392 elements, error 10.3 %`, the last one.
   function mesh_text(adaptation) result(text)
      type(adaptation_t), intent(in) :: adaptation
      character(len=:), allocatable :: text

      associate (n => size(adaptation%meshes), meshes => adaptation%meshes)
         text = 'mesh '//to_text(int(n, ip))//': '//to_text(meshes(n)%n_elements)//' elements, error '//percent_text(meshes(n))
      end associate
   end function mesh_text

   !> `7 meshes, 111 to 2350 elements; error 18.6 to at most 4.9 %`
   function adaptation_text(adaptation) result(text)
      type(adaptation_t), intent(in) :: adaptation   !< of a run that used it
      character(len=:), allocatable :: text

      associate (n => size(adaptation%meshes), meshes => adaptation%meshes)
         if (n < 2) then
            text = 'the first mesh'
            if (n == 1) text = text//' has an error of '//percent_text(meshes(1))
            return
         end if
         text = to_text(int(n, ip))//' meshes, '//to_text(meshes(1)%n_elements)//' to '// &
                to_text(meshes(n)%n_elements)//' elements; error '//to_text(meshes(1)%percent, 3)//' to '//percent_text(meshes(n))
      end associate
   end function adaptation_text

   !> `at most 4.9 %`, of a bound, or `some 4.9 %`, of an estimate.
   pure function percent_text(mesh) result(text)
      type(adapted_mesh_t), intent(in) :: mesh
      character(len=:), allocatable :: text

      text = trim(merge('at most', 'some   ', mesh%is_certified))//' '//to_text(mesh%percent, 3)//' %'
   end function percent_text

   !> Why the run ends with a larger error than it was to have.
   function missed_text(adaptation) result(text)
      type(adaptation_t), intent(in) :: adaptation   !< with `why`
      character(len=:), allocatable :: text

      associate (n => size(adaptation%meshes))
         text = 'the error is '//percent_text(adaptation%meshes(n))//', not '//to_text(adaptation%target, 3)// &
                ' % as --adapt asks: '//adaptation%why//'; the last mesh is written'
      end associate
   end function missed_text

end module atrito_adaptation
