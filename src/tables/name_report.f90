!> The names of a deck, for `atrito check`: what may be asked for, held or loaded, and how much each of them is.
module atrito_name_report
   use atrito_kinds, only: ip
   use atrito_model, only: model_t, SURFACE_SEGMENTS
   use atrito_page, only: page_t, add_entry
   use atrito_sets, only: set_list_t, set_count, member_count
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: describe_names

   integer(ip), parameter :: MOST_NAMES = 24        !< of a kind; more are counted

contains

   !> Node sets with their nodes, element sets and materials with their elements, surfaces with their faces.
   subroutine describe_names(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      character(len=:), allocatable :: text
      integer(ip) :: i, n, in_use

      call describe_sets(page, 'node sets (nodes)', model%node_sets)
      call describe_sets(page, 'element sets (elements)', model%element_sets)
      text = ''
      n = size(model%surfaces, kind=ip)
      do i = 1, min(n, MOST_NAMES)
         associate (surface => model%surfaces(i))
            if (surface%kind == SURFACE_SEGMENTS) then
               call add_name(text, surface%name, size(surface%is_arc, kind=ip))
            else
               call add_name(text, surface%name, surface%faces%n)
            end if
         end associate
      end do
      call describe_list(page, 'surfaces (faces)', text, n)
      text = ''
      n = size(model%materials, kind=ip)
      do i = 1, min(n, MOST_NAMES)
         in_use = count(model%sections(model%section_of)%material == i, kind=ip)
         call add_name(text, model%materials(i)%name, in_use)
      end do
      call describe_list(page, 'materials (elements)', text, n)
   end subroutine describe_names

   subroutine describe_sets(page, label, list)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: label
      type(set_list_t), intent(in) :: list
      character(len=:), allocatable :: text
      integer(ip) :: i

      text = ''
      do i = 1, min(set_count(list), MOST_NAMES)
         call add_name(text, list%sets(i)%name, member_count(list%sets(i)))
      end do
      call describe_list(page, label, text, set_count(list))
   end subroutine describe_sets

   !> No blank within: a line ends behind a number.
   pure subroutine add_name(text, name, n)
      character(len=:), allocatable, intent(inout) :: text
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: n

      if (len(text) > 0) text = text//', '
      text = text//name//'('//to_text(n)//')'
   end subroutine add_name

   subroutine describe_list(page, label, text, n)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: label, text
      integer(ip), intent(in) :: n                  !< names that there are

      if (n == 0) return
      if (n > MOST_NAMES) then
         call add_entry(page, label, text//' and '//to_text(n - MOST_NAMES)//' more')
      else
         call add_entry(page, label, text)
      end if
   end subroutine describe_list

end module atrito_name_report
