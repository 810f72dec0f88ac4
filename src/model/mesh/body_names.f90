!> What bodies are called.
module atrito_body_names
   use atrito_bodies, only: bodies_t
   use atrito_kinds, only: ip
   use atrito_model, only: model_t
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_sets, only: set_count, members_of, member_count, first_number
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: name_bodies

contains

   !> A body is called after the element set of its section. One of several that share a section is called after the first set that
   !> holds just this body, as those of a *BLOCK do; where there is none, it gets a number.
   pure subroutine name_bodies(model, bodies)
      type(model_t), intent(in) :: model         !< sections, sets and instances are read
      type(bodies_t), intent(inout) :: bodies    !< each gets its name
      integer(ip) :: section(bodies%n), sharing(size(model%sections)), i, b, s
      integer(ip), allocatable :: n(:), last(:)       ! of each instance: its bodies, and the last of them
      type(name_list_t) :: names
      integer :: dot
      logical :: is_named(bodies%n)

      sharing = 0
      do i = 1, bodies%n
         section(i) = model%section_of(bodies%list(i)%elements(1))
         sharing(section(i)) = sharing(section(i)) + 1
      end do
      is_named = sharing(section) == 1
      do i = 1, bodies%n
         bodies%list(i)%name = model%sections(section(i))%elset
         if (.not. is_named(i)) bodies%list(i)%name = bodies%list(i)%name//'-'//to_text(i)
      end do
      do s = 1, merge(0_ip, set_count(model%element_sets), all(is_named))
         associate (it => model%element_sets%sets(s))
            if (member_count(it) == 0) cycle
            b = bodies%of_element(first_number(it%members))
            if (is_named(b) .or. member_count(it) /= size(bodies%list(b)%elements)) cycle
            is_named(b) = all(bodies%of_element(members_of(it)) == b)
            if (is_named(b)) bodies%list(b)%name = it%name
         end associate
      end do
      if (.not. allocated(model%instances)) return
      ! an instance that is one body gives it its name alone, without that of the set in its part
      do i = 1, size(model%instances, kind=ip)
         call add_name(names, model%instances(i)%name)
      end do
      allocate (n(names%n), last(names%n), source=0_ip)
      do b = 1, bodies%n
         do dot = 1, len(bodies%list(b)%name)
            if (bodies%list(b)%name(dot:dot) /= '.') cycle
            i = find_name(names, bodies%list(b)%name(:dot - 1))
            if (i == 0) cycle
            n(i) = n(i) + 1
            last(i) = b
         end do
      end do
      do i = 1, names%n
         if (n(i) == 1) bodies%list(last(i))%name = model%instances(i)%name
      end do
   end subroutine name_bodies

end module atrito_body_names
