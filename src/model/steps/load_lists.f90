!> Boundary conditions as the builders keep them while a deck is read, and the lists of values and loads that a step has of them.
module atrito_load_lists
   use atrito_growth, only: make_room
   use atrito_kinds, only: ip, wp
   use atrito_model, only: nodal_values_t, element_load_t, LOAD_HYDROSTATIC
   implicit none (type, external)
   private
   public :: condition_t, condition_list_t, add_condition, add_part, nodal_values_of, element_loads_of
   public :: add_nodal_value, amplitude_of, dof_slot, scaled, SLOTS

   integer(ip), parameter :: SLOTS = 3                 !< dofs that a node can have: two displacements, a rotation

   !> A displacement or rotation that is prescribed at a node, a force or moment there, or a load on an element.
   type :: condition_t
      integer(ip) :: place = 0                         !< node or element
      integer(ip) :: dof = 0                           !< of a node: 1, 2, and of a reference node also 6
      integer(ip) :: kind = 0                          !< of a load on an element: LOAD_*
      integer(ip) :: face = 0                          !< of the element; 0: the load acts on its volume
      integer(ip) :: label = 0                         !< of the load in the deck, place in the list of labels
      integer(ip) :: line = 0                          !< of the deck that gives it; 0: none
      integer(ip) :: amplitude = 0                     !< place in model%amplitudes; 0: none
      integer(ip) :: source = 0                        !< place in model%sources; 0: none
      real(wp) :: value(3) = 0.0_wp                    !< as element_load_t has it; of a node the first alone
      real(wp) :: from(3) = 0.0_wp                     !< the same at the beginning of the step
   end type condition_t

   !> A list that grows by doubling.
   type :: condition_list_t
      integer(ip) :: n = 0                             !< conditions in use
      type(condition_t), allocatable :: list(:)        !< the first n are in use
   end type condition_list_t

contains

   !> The place of a dof among those that a node can have: 1, 2, and 3 for 6.
   pure elemental integer(ip) function dof_slot(dof)
      integer(ip), intent(in) :: dof             !< 1, 2 or 6

      dof_slot = min(dof, SLOTS)
   end function dof_slot

   !> A value times a factor: the levels of a hydrostatic pressure stay where they are.
   pure function scaled(kind, value, factor) result(product)
      integer(ip), intent(in) :: kind                  !< LOAD_*; 0: at a node
      real(wp), intent(in) :: value(3), factor         !< as element_load_t has it
      real(wp) :: product(3)

      product = value*factor
      if (kind == LOAD_HYDROSTATIC) product(2:) = value(2:)
   end function scaled

   !> Appends a condition.
   pure subroutine add_condition(conditions, condition)
      type(condition_list_t), intent(inout) :: conditions !< becomes longer by one
      type(condition_t), intent(in) :: condition          !< at a node, or on an element
      type(condition_t), allocatable :: longer(:)
      integer(ip) :: n

      n = conditions%n
      if (.not. allocated(conditions%list)) allocate (conditions%list(16))
      if (n == size(conditions%list)) then
         allocate (longer(2*n))
         longer(:n) = conditions%list
         call move_alloc(longer, conditions%list)
      end if
      conditions%n = n + 1
      conditions%list(n + 1) = condition
   end subroutine add_condition

   !> Appends a part of a condition at a node, along an axis.
   pure subroutine add_part(conditions, condition, axis, part)
      type(condition_list_t), intent(inout) :: conditions !< becomes longer by one
      type(condition_t), intent(in) :: condition       !< along a dof of the deck
      integer(ip), intent(in) :: axis                  !< 1 or 2
      real(wp), intent(in) :: part                     !< of its value
      type(condition_t) :: along

      along = condition
      along%dof = axis
      along%value = condition%value*part
      along%from = condition%from*part
      call add_condition(conditions, along)
   end subroutine add_part

   !> Appends a value at a dof, without an amplitude, that was 0 at the beginning of the step.
   pure subroutine add_nodal_value(list, node, dof, value)
      type(nodal_values_t), intent(inout) :: list      !< becomes longer by one
      integer(ip), intent(in) :: node, dof             !< place; 1, 2 or 6
      real(wp), intent(in) :: value                    !< [L], [F], [-] or [F L]

      call make_room(list%node, list%n, list%n + 1)
      call make_room(list%dof, list%n, list%n + 1)
      call make_room(list%value, list%n, list%n + 1)
      list%n = list%n + 1
      list%node(list%n) = node
      list%dof(list%n) = dof
      list%value(list%n) = value
   end subroutine add_nodal_value

   !> Conditions at nodes as a step has them: what is 0 of all of them is not allocated.
   pure function nodal_values_of(conditions) result(values)
      type(condition_list_t), intent(in) :: conditions !< at nodes, along x and y
      type(nodal_values_t) :: values
      type(condition_t), allocatable :: used(:)

      allocate (used(0))
      if (conditions%n > 0) used = conditions%list(:conditions%n)
      values%n = conditions%n
      values%node = used%place
      values%dof = used%dof
      values%value = used%value(1)
      if (any(abs(used%from(1)) > 0.0_wp)) values%from = used%from(1)
      if (any(used%amplitude > 0)) values%amplitude = used%amplitude
      if (any(used%source > 0)) values%source = used%source
   end function nodal_values_of

   !> Loads on elements as a step has them; those of the first step have nothing at its beginning.
   pure function element_loads_of(conditions, is_first) result(loads)
      type(condition_list_t), intent(in) :: conditions !< on elements
      logical, intent(in) :: is_first                  !< step
      type(element_load_t) :: loads
      integer(ip) :: i

      loads%n = conditions%n
      allocate (loads%element(loads%n), loads%kind(loads%n), loads%face(loads%n), loads%line(loads%n), loads%value(3, loads%n))
      if (.not. is_first) allocate (loads%from(3, loads%n))
      if (loads%n == 0) return
      associate (used => conditions%list(:loads%n))
         loads%element = used%place
         loads%kind = used%kind
         loads%face = used%face
         loads%line = used%line
         if (any(used%amplitude > 0)) loads%amplitude = used%amplitude
         if (any(used%source > 0)) loads%source = used%source
         do i = 1, loads%n
            loads%value(:, i) = used(i)%value
            if (.not. is_first) loads%from(:, i) = used(i)%from
         end do
      end associate
   end function element_loads_of

   !> The amplitude of the i-th value; 0: none.
   pure integer(ip) function amplitude_of(amplitude, i) result(a)
      integer(ip), allocatable, intent(in) :: amplitude(:) !< component of nodal_values_t or element_load_t
      integer(ip), intent(in) :: i                         !< of the values, from 1

      a = 0
      if (allocated(amplitude)) a = amplitude(i)
   end function amplitude_of

end module atrito_load_lists
