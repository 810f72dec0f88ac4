!> What the limit program prints: the cost of one linear solve of the glued bodies, phase by phase.
module linear_solve_page
   use atrito_kinds, only: wp
   use atrito_libraries, only: library_t, list_libraries
   use atrito_mumps, only: mumps_version
   use atrito_page, only: page_t, begin_page, add_line, add_rule, add_entry, left, bytes, number
   use atrito_strings, only: to_text
   use atrito_system, only: peak_memory, processor_seconds
   use atrito_timers, only: phase_time_t, get_phases
   use glued_bodies, only: NUMBERING_TEXTS
   use linear_solve, only: plan_t, solve_facts_t, METIS, SOLVE_PHASES
   implicit none (type, external)
   private
   public :: compose_solve

   integer, parameter :: WIDTH = 79                 !< columns; a terminal of 80 does not wrap

contains

   !> Composes the page.
   subroutine compose_solve(deck, plan, facts, wall, page)
      character(len=*), intent(in) :: deck
      type(plan_t), intent(in) :: plan
      type(solve_facts_t), intent(in) :: facts
      real(wp), intent(in) :: wall                  !< seconds since the program began
      type(page_t), intent(out) :: page

      call begin_page(page, WIDTH)
      call add_rule(page, '=')
      call add_line(page, left('limit   '//deck, WIDTH))
      call add_rule(page, '-')
      call add_sizes(page, plan, facts)
      call add_rule(page, '-')
      call add_times(page, wall)
      call add_rule(page, '=')
   end subroutine compose_solve

   subroutine add_sizes(page, plan, facts)
      type(page_t), intent(inout) :: page
      type(plan_t), intent(in) :: plan
      type(solve_facts_t), intent(in) :: facts
      type(library_t), allocatable :: list(:)
      integer :: i

      call add_entry(page, 'nodes glued to others', to_text(facts%n_glued))
      if (facts%n_held > 0) call add_entry(page, 'nodes held by rigid surfaces', to_text(facts%n_held))
      call add_entry(page, 'equations', to_text(facts%n_equations))
      call add_entry(page, 'largest displacement of them', number(facts%largest, 4))
      call add_entry(page, 'entries, lower triangle', to_text(facts%entries))
      call add_entry(page, 'entries of the factor', to_text(facts%factor_entries))
      call add_entry(page, 'operations of the factor', number(facts%operations, 4))
      call add_entry(page, 'memory of MUMPS', bytes(facts%memory))
      call add_entry(page, 'peak memory of the process', bytes(peak_memory()))
      if (plan%ordering == METIS) then
         call add_entry(page, 'eliminated by', 'nested dissection (METIS)')
      else
         call add_entry(page, 'eliminated by', 'minimum degree (AMD)')
      end if
      call add_entry(page, 'numbered in the nodes'' order', trim(NUMBERING_TEXTS(plan%numbering)))
      call list_libraries(.true., list)
      do i = 1, size(list)
         if (list(i)%name == 'BLAS') call add_entry(page, 'BLAS', list(i)%version)
      end do
      call add_entry(page, 'MUMPS', mumps_version())
   end subroutine add_sizes

   !> A line a phase; the sum of those of the solve; the whole process until now.
   subroutine add_times(page, wall)
      type(page_t), intent(inout) :: page
      real(wp), intent(in) :: wall
      type(phase_time_t), allocatable :: phases(:)
      type(phase_time_t) :: total
      integer :: i

      phases = get_phases()
      call add_line(page, '   '//left('phase', 16)//'    wall [s]     cpu [s]')
      do i = 1, size(phases)
         call add_line(page, time_line(phases(i)%name, phases(i)%wall, phases(i)%cpu))
         if (.not. any(phases(i)%name == SOLVE_PHASES)) cycle
         total%wall = total%wall + phases(i)%wall
         total%cpu = total%cpu + phases(i)%cpu
      end do
      call add_line(page, time_line('total', total%wall, total%cpu)//'   '//trim(SOLVE_PHASES(1))//' to '//trim(SOLVE_PHASES(5)))
      call add_line(page, time_line('process', wall, processor_seconds()))
   end subroutine add_times

   pure function time_line(name, wall, cpu) result(text)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: wall, cpu
      character(len=:), allocatable :: text
      character(len=12) :: first, second

      write (first, '(f12.6)') wall
      write (second, '(f12.6)') cpu
      text = '   '//left(name, 16)//first//second
   end function time_line

end module linear_solve_page
