!> Lists of prescribed displacements and loads that grow by doubling.
module atrito_load_lists
   use atrito_growth, only: make_room, resize
   use atrito_kinds, only: ip, wp
   use atrito_model, only: nodal_values_t, element_load_t, LOAD_HYDROSTATIC
   implicit none (type, external)
   private
   public :: add_nodal_value, add_element_load, replace_nodal_value, replace_element_load, trim_nodal_values, trim_element_loads
   public :: amplitude_of, from_of, source_of, replace_source

contains

   !> Adds a prescribed displacement, or a force at a node.
   pure subroutine add_nodal_value(list, node, dof, value, from, amplitude, source)
      type(nodal_values_t), intent(inout) :: list
      integer(ip), intent(in) :: node, dof             !< place; 1 or 2
      real(wp), intent(in) :: value                    !< [L] or [F]
      real(wp), intent(in), optional :: from           !< at the beginning of the step; default 0
      integer(ip), intent(in), optional :: amplitude   !< default 0: none
      integer(ip), intent(in), optional :: source      !< default 0: none

      call set_from(list%n, from, list%from)
      call set_place(list%n, amplitude, list%amplitude)
      call set_place(list%n, source, list%source)
      call make_room(list%node, list%n, list%n + 1)
      call make_room(list%dof, list%n, list%n + 1)
      call make_room(list%value, list%n, list%n + 1)
      list%n = list%n + 1
      list%node(list%n) = node
      list%dof(list%n) = dof
      list%value(list%n) = value
   end subroutine add_nodal_value

   !> What the next value was at the beginning of the step; a list that holds nothing but zeros is not there.
   pure subroutine set_from(n, from, list)
      integer(ip), intent(in) :: n                     !< values that there are
      real(wp), intent(in), optional :: from
      real(wp), allocatable, intent(inout) :: list(:)
      real(wp) :: value

      value = 0.0_wp
      if (present(from)) value = from
      if (.not. allocated(list)) then
         if (.not. abs(value) > 0.0_wp) return
         allocate (list(n + 1), source=0.0_wp)
      end if
      call make_room(list, n, n + 1)
      list(n + 1) = value
   end subroutine set_from

   !> The same of an amplitude or a source.
   pure subroutine set_place(n, place, list)
      integer(ip), intent(in) :: n                     !< values that there are
      integer(ip), intent(in), optional :: place
      integer(ip), allocatable, intent(inout) :: list(:)
      integer(ip) :: value

      value = 0
      if (present(place)) value = place
      if (.not. allocated(list)) then
         if (value == 0) return
         allocate (list(n + 1), source=0_ip)
      end if
      call make_room(list, n, n + 1)
      list(n + 1) = value
   end subroutine set_place

   !> Another value in the place of the i-th; what it had at the beginning of the step stays.
   pure subroutine replace_nodal_value(list, i, value, amplitude)
      type(nodal_values_t), intent(inout) :: list
      integer(ip), intent(in) :: i, amplitude
      real(wp), intent(in) :: value

      list%value(i) = value
      call replace_place(size(list%value), i, amplitude, list%amplitude)
   end subroutine replace_nodal_value

   !> Another source of the i-th value.
   pure subroutine replace_source(list, i, source)
      type(nodal_values_t), intent(inout) :: list
      integer(ip), intent(in) :: i, source

      call replace_place(size(list%value), i, source, list%source)
   end subroutine replace_source

   !> As replace_nodal_value, of a load on an element.
   pure subroutine replace_element_load(list, i, value, amplitude)
      type(element_load_t), intent(inout) :: list
      integer(ip), intent(in) :: i, amplitude
      real(wp), intent(in) :: value(:)

      list%value(:, i) = 0.0_wp
      list%value(:size(value), i) = value
      call replace_place(size(list%element), i, amplitude, list%amplitude)
   end subroutine replace_element_load

   !> An amplitude or a source in the place of the i-th.
   pure subroutine replace_place(room, i, place, list)
      integer, intent(in) :: room                      !< of the lists beside this one
      integer(ip), intent(in) :: i, place
      integer(ip), allocatable, intent(inout) :: list(:)

      if (place > 0 .and. .not. allocated(list)) allocate (list(room), source=0_ip)
      if (allocated(list)) list(i) = place
   end subroutine replace_place

   !> What the i-th value was at the beginning of the step.
   pure real(wp) function from_of(list, i) result(from)
      type(nodal_values_t), intent(in) :: list
      integer(ip), intent(in) :: i

      from = 0.0_wp
      if (allocated(list%from)) from = list%from(i)
   end function from_of

   !> The source of the i-th value; 0: none.
   pure integer(ip) function source_of(list, i) result(source)
      type(nodal_values_t), intent(in) :: list
      integer(ip), intent(in) :: i

      source = 0
      if (allocated(list%source)) source = list%source(i)
   end function source_of

   !> The amplitude of the i-th value; 0: none.
   pure integer(ip) function amplitude_of(list, i) result(amplitude)
      type(nodal_values_t), intent(in) :: list
      integer(ip), intent(in) :: i

      amplitude = 0
      if (allocated(list%amplitude)) amplitude = list%amplitude(i)
   end function amplitude_of

   !> Gives back the room kept for growing.
   pure subroutine trim_nodal_values(list)
      type(nodal_values_t), intent(inout) :: list

      if (allocated(list%from)) call resize(list%from, list%n, list%n)
      if (allocated(list%amplitude)) call resize(list%amplitude, list%n, list%n)
      if (allocated(list%source)) call resize(list%source, list%n, list%n)
      call drop_zeros(list%from, list%amplitude)
      call resize(list%node, list%n, list%n)
      call resize(list%dof, list%n, list%n)
      call resize(list%value, list%n, list%n)
   end subroutine trim_nodal_values

   !> Adds a load on an element.
   pure subroutine add_element_load(list, element, kind, face, value, amplitude, source)
      type(element_load_t), intent(inout) :: list
      integer(ip), intent(in) :: element               !< place
      integer(ip), intent(in) :: kind                  !< LOAD_*
      integer(ip), intent(in) :: face                  !< 1..4; LOAD_BODY: 0
      real(wp), intent(in) :: value(:)                 !< as element_load_t has it; what is not given is 0
      integer(ip), intent(in), optional :: amplitude   !< default 0: none
      integer(ip), intent(in), optional :: source      !< default 0: none

      call set_place(list%n, amplitude, list%amplitude)
      call set_place(list%n, source, list%source)
      call make_room(list%element, list%n, list%n + 1)
      call make_room(list%kind, list%n, list%n + 1)
      call make_room(list%face, list%n, list%n + 1)
      call make_room(list%line, list%n, list%n + 1)
      if (.not. allocated(list%value)) allocate (list%value(3, size(list%element)))
      if (list%n == size(list%value, 2)) call resize(list%value, list%n, size(list%element, kind=ip))
      list%n = list%n + 1
      list%element(list%n) = element
      list%kind(list%n) = kind
      list%face(list%n) = face
      list%line(list%n) = 0
      list%value(:, list%n) = 0.0_wp
      list%value(:size(value), list%n) = value
      if (.not. allocated(list%from)) return
      if (list%n > size(list%from, 2)) call resize(list%from, list%n - 1, size(list%element, kind=ip))
      list%from(:, list%n) = [0.0_wp, list%value(2:, list%n)*merge(1, 0, kind == LOAD_HYDROSTATIC)]
   end subroutine add_element_load

   !> Gives back the room kept for growing.
   pure subroutine trim_element_loads(list)
      type(element_load_t), intent(inout) :: list

      call resize(list%element, list%n, list%n)
      call resize(list%kind, list%n, list%n)
      call resize(list%face, list%n, list%n)
      call resize(list%line, list%n, list%n)
      if (.not. allocated(list%value)) allocate (list%value(3, 0))
      call resize(list%value, list%n, list%n)
      if (allocated(list%amplitude)) call resize(list%amplitude, list%n, list%n)
      if (allocated(list%amplitude)) then
         if (all(list%amplitude == 0)) deallocate (list%amplitude)
      end if
      if (allocated(list%source)) call resize(list%source, list%n, list%n)
      if (allocated(list%from)) call resize(list%from, list%n, list%n)
   end subroutine trim_element_loads

   !> What a one-step deck without amplitudes has no use for.
   pure subroutine drop_zeros(from, amplitude)
      real(wp), allocatable, intent(inout) :: from(:)
      integer(ip), allocatable, intent(inout) :: amplitude(:)

      if (allocated(from)) then
         if (.not. any(abs(from) > 0.0_wp)) deallocate (from)
      end if
      if (allocated(amplitude)) then
         if (all(amplitude == 0)) deallocate (amplitude)
      end if
   end subroutine drop_zeros

end module atrito_load_lists
