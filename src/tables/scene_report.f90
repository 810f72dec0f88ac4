!> What a scene needs and what it does without, for the listing and for `atrito check`; the names of its deck, for the latter.
module atrito_scene_report
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, SURFACE_SEGMENTS
   use atrito_sets, only: set_list_t, set_count, member_count
   use atrito_strings, only: to_text
   use atrito_summary, only: body_count
   use atrito_results, only: scene_t, body_result_t, pair_scene_t
   use atrito_page, only: page_t, add_line, add_blank, add_entry, add_paragraph, left, right, number, bytes, plural
   implicit none (type, external)
   private
   public :: describe_needs, describe_bodies, describe_names, describe_pairs

   !> With more bodies or pairs than this the screen shows the first ones only; the listing has all of them.
   integer(ip), parameter :: MOST_ROWS = 20_ip

   integer(ip), parameter :: MOST_NAMES = 24        !< of a kind; more are counted

   !> Gaps that differ by less than this part of the coordinates are the same: that is how far ten printed digits go.
   real(wp), parameter :: SAME_GAP = 1.0e-9_wp

contains

   !> Unknowns, loops and memory, and what was left out.
   subroutine describe_needs(page, scene)
      type(page_t), intent(inout) :: page !< the lines are added to it
      type(scene_t), intent(in) :: scene  !< counts, memory, and what was left out
      integer :: i

      call add_entry(page, 'bodies', to_text(body_count(scene)))
      call add_entry(page, 'free displacements', to_text(scene%n_dofs))
      call add_entry(page, 'normal unknowns', to_text(scene%n_normal - scene%n_rows))
      call add_entry(page, 'tangential unknowns', to_text(scene%n_tangential))
      if (scene%n_rows > 0) call add_entry(page, 'of ties, equations, springs', to_text(scene%n_rows))
      call add_entry(page, 'rigid motions as unknowns', to_text(scene%n_rigid))
      call add_entry(page, 'outer loop', trim(merge('on the friction bound', 'none                 ', scene%outer_loop)))
      if (allocated(scene%contact_form)) then
         call add_entry(page, 'contact system', scene%contact_form//', '//text_of(scene%contact_reason))
         if (allocated(scene%order)) call add_entry(page, 'order of elimination', scene%order)
      end if
      call add_entry(page, 'memory, predicted', bytes(scene%memory))
      if (.not. allocated(scene%left_out)) return
      if (size(scene%left_out) == 0) return
      call add_blank(page)
      call add_line(page, '   Left out, because this scene does not need it:')
      do i = 1, size(scene%left_out)
         call add_paragraph(page, '- '//scene%left_out(i)%s, 3)
      end do
   end subroutine describe_needs

   !> A row a body: its size, solver and why.
   subroutine describe_bodies(page, scene, factored, some)
      type(page_t), intent(inout) :: page           !< the lines are added to it
      type(scene_t), intent(in) :: scene            !< its bodies are read
      logical, intent(in) :: factored               !< lost digits and signs are known
      logical, intent(in) :: some                   !< of many the first ones only
      integer(ip) :: i, n

      if (body_count(scene) == 0) return
      n = body_count(scene)
      if (some) n = min(n, MOST_ROWS)
      call add_line(page, '   '//left('body', 13)//right('elements', 9)//right('equations', 10)//right('contact', 8)// &
                    right('free', 5)//'  '//left('solver', 8)//right('entries', 10)//right('memory', 11))
      do i = 1, n
         associate (body => scene%bodies(i))
            call add_line(page, '   '//left(text_of(body%name), 13)//right(to_text(body%n_elements), 9)// &
                          right(to_text(body%n_equations), 10)//right(to_text(body%n_contact_equations), 8)// &
                          right(to_text(body%n_free_motions), 5)//'  '//left(text_of(body%solver), 8)// &
                          right(to_text(body%profile), 10)//right(bytes(body%memory), 11))
         end associate
      end do
      do i = 1, n
         call add_solver_remarks(page, scene%bodies(i), factored)
      end do
      if (factored .and. scene%near_elements) then
         call add_paragraph(page, 'elements that differ in the last printed digits of their nodes alone were taken as equal where' &
                            //' matrices were factored, and refinement has put the difference right', 3)
      end if
      if (n < body_count(scene)) call add_line(page, '   ... and '//to_text(body_count(scene) - n)//' more bodies')
   end subroutine describe_bodies

   subroutine add_solver_remarks(page, body, factored)
      type(page_t), intent(inout) :: page
      type(body_result_t), intent(in) :: body
      logical, intent(in) :: factored
      character(len=:), allocatable :: bandwidth

      if (allocated(body%reason)) then
         bandwidth = ' (half bandwidth '//to_text(body%half_bandwidth)//')'
         if (any(text_of(body%solver) == ['sparse', 'scene ', 'none  '])) bandwidth = ''
         call add_paragraph(page, text_of(body%name)//': '//text_of(body%solver)//', '//body%reason//bandwidth, 3)
      end if
      if (allocated(body%order)) call add_paragraph(page, text_of(body%name)//': order of elimination '//body%order, 3)
      if (.not. factored) return
      if (body%n_fronts > 0) call add_paragraph(page, text_of(body%name)//': '//plural(body%n_fronts, 'front', 'fronts')//', '// &
                                                to_text(body%n_different_fronts)//' of them different: these are factored', 3)
      if (body%worst_node > 0) then
         call add_paragraph(page, text_of(body%name)//': '//number(body%digits_lost, 2)//' digits lost at most, at node '// &
                            to_text(body%worst_node)//' along '//to_text(body%worst_dof)//'; '// &
                            plural(body%sign_changes, 'sign change', 'sign changes'), 3)
      end if
   end subroutine add_solver_remarks

   pure function text_of(text) result(given)
      character(len=:), allocatable, intent(in) :: text
      character(len=:), allocatable :: given

      given = '-'
      if (allocated(text)) given = text
   end function text_of

   !> A row a contact pair before the solution.
   subroutine describe_pairs(page, scene, some)
      type(page_t), intent(inout) :: page           !< the lines are added to it
      type(scene_t), intent(in) :: scene            !< its pairs are read
      logical, intent(in) :: some                   !< of many the first ones only
      integer(ip) :: i, n

      if (.not. allocated(scene%pairs)) return
      if (size(scene%pairs) == 0) return
      n = size(scene%pairs, kind=ip)
      if (some) n = min(n, MOST_ROWS)
      call add_line(page, '   '//left('pair', 5)//left('slave / master', 37)//right('points', 7)// &
                    right('least gap', 13)//right('greatest gap', 13))
      do i = 1, n
         associate (pair => scene%pairs(i))
            call add_line(page, '   '//left(to_text(i), 5)//left(pair%slave//' / '//pair%master, 37)// &
                          right(to_text(pair%n_points), 7)//right(number(pair%least_gap, 5), 13)// &
                          right(number(pair%greatest_gap, 5), 13))
         end associate
      end do
      do i = 1, n
         call add_paragraph(page, 'pair '//to_text(i)//': '//pair_text(scene%pairs(i)), 3)
      end do
      if (n < size(scene%pairs)) call add_line(page, '   ... and '//to_text(size(scene%pairs, kind=ip) - n)//' more pairs')
   end subroutine describe_pairs

   !> What a pair is; where its gap is least and greatest, unless it is the same everywhere.
   pure function pair_text(pair) result(text)
      type(pair_scene_t), intent(in) :: pair
      character(len=:), allocatable :: text
      real(wp) :: size

      text = 'interaction '//text_of(pair%interaction)
      if (pair%master_is_rigid) then
         text = text//', the master is a rigid surface'
      else if (pair%matching) then
         text = text//', the sides match'
      else
         text = text//', the sides do not match'
      end if
      if (pair%n_left_out > 0) text = text//', '//plural(pair%n_left_out, 'slave face', 'slave faces')// &
                                      ' without a master left out'
      if (pair%least_node == 0) return              ! no points
      size = max(maxval(abs(pair%least_x)), maxval(abs(pair%greatest_x)))
      if (pair%greatest_gap - pair%least_gap <= SAME_GAP*size) return
      text = text//'; least gap at '//place_text(pair%least_node, pair%least_x)//', greatest at '// &
             place_text(pair%greatest_node, pair%greatest_x)
      if (pair%least_gap < 0.0_wp) text = text//'; a negative gap is overlap'
   end function pair_text

   !> `node 12 (0.5, 1)`
   pure function place_text(node, x) result(text)
      integer(ip), intent(in) :: node               !< the user's number
      real(wp), intent(in) :: x(2)                  !< [L]
      character(len=:), allocatable :: text

      text = 'node '//to_text(node)//' ('//number(x(1), 5)//', '//number(x(2), 5)//')'
   end function place_text

   !> Node sets with their nodes, element sets and materials with their elements, surfaces with their faces.
   subroutine describe_names(page, model)
      type(page_t), intent(inout) :: page !< the lines are added to it
      type(model_t), intent(in) :: model  !< sets, surfaces and materials are read
      character(len=:), allocatable :: text
      integer(ip) :: i, n, in_use, n_faces

      call describe_sets(page, 'node sets (nodes)', model%node_sets)
      call describe_sets(page, 'element sets (elements)', model%element_sets)
      text = ''
      n = size(model%surfaces, kind=ip)
      do i = 1, min(n, MOST_NAMES)
         associate (surface => model%surfaces(i))
            n_faces = surface%faces%n
            if (surface%kind == SURFACE_SEGMENTS) n_faces = size(surface%is_arc, kind=ip)
            call add_name(text, surface%name, n_faces)
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
      if (n > MOST_NAMES) call add_entry(page, label, text//' and '//to_text(n - MOST_NAMES)//' more')
      if (n <= MOST_NAMES) call add_entry(page, label, text)
   end subroutine describe_list

end module atrito_scene_report
