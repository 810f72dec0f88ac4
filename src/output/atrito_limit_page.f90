!> What `--bench-limit` prints: the cost of one linear solve of the glued bodies, part by part.
module atrito_limit_page
   use atrito_kinds, only: wp
   use atrito_libraries, only: library_t, list_libraries, USED
   use atrito_limit_result, only: limit_t
   use atrito_model, only: model_t
   use atrito_page, only: page_t, begin_page, add_line, add_blank, add_rule, add_entry, left, bytes, number
   use atrito_strings, only: to_text
   use atrito_timers, only: peak_memory
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: compose_limit

   integer, parameter :: WIDTH = 79                 !< columns; a terminal of 80 does not wrap

contains

   !> Composes the page.
   subroutine compose_limit(model, limit, page)
      type(model_t), intent(in) :: model
      type(limit_t), intent(in) :: limit
      type(page_t), intent(out) :: page
      integer :: i

      call begin_page(page, WIDTH)
      call add_rule(page, '=')
      call add_line(page, left(PROGRAM_NAME//' '//PROGRAM_VERSION//' limit   '//model%deck_path, WIDTH))
      if (allocated(model%heading)) then
         if (size(model%heading) > 0) call add_line(page, left(model%heading(1)%s, WIDTH))
      end if
      call add_rule(page, '-')
      call add_sizes(page, limit)
      call add_rule(page, '-')
      call add_line(page, '   '//left('part', 16)//'    wall [s]     cpu [s]')
      do i = 1, size(limit%parts)
         call add_line(page, time_line(limit%parts(i)%name, limit%parts(i)%wall, limit%parts(i)%cpu))
      end do
      call add_line(page, time_line('total', sum(limit%parts%wall), sum(limit%parts%cpu)))
      call add_blank(page)
      call add_line(page, '   The bodies glued together: no contact was solved, nothing was written.')
      call add_rule(page, '=')
   end subroutine compose_limit

   subroutine add_sizes(page, limit)
      type(page_t), intent(inout) :: page
      type(limit_t), intent(in) :: limit
      type(library_t), allocatable :: list(:)
      integer :: i

      call add_entry(page, 'nodes glued to others', to_text(limit%n_glued))
      if (limit%n_held > 0) call add_entry(page, 'nodes held by rigid surfaces', to_text(limit%n_held))
      call add_entry(page, 'equations', to_text(limit%n_equations))
      call add_entry(page, 'entries, lower triangle', to_text(limit%entries))
      call add_entry(page, 'entries of the factor', to_text(limit%factor_entries))
      call add_entry(page, 'operations of the factor', number(limit%operations, 4))
      call add_entry(page, 'memory of MUMPS', bytes(limit%memory))
      call add_entry(page, 'peak memory of the process', bytes(peak_memory()))
      call add_entry(page, 'order', 'minimum degree (AMD)')
      if (allocated(limit%order)) call add_entry(page, 'numbered in the nodes'' order', limit%order)
      call list_libraries(USED, list)
      do i = 1, size(list)
         if (list(i)%name == 'BLAS' .or. list(i)%name == 'MUMPS') call add_entry(page, trim(list(i)%name), list(i)%version)
      end do
   end subroutine add_sizes

   pure function time_line(name, wall, cpu) result(text)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: wall, cpu
      character(len=:), allocatable :: text
      character(len=12) :: first, second

      write (first, '(f12.6)') wall
      write (second, '(f12.6)') cpu
      text = '   '//left(name, 16)//first//second
   end function time_line

end module atrito_limit_page
