!> What `atrito check` prints: what was understood, what the scene needs and what it does without.
module atrito_check_report
   use atrito_strings, only: to_text
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_messages, only: count_messages, SEVERITY_WARNING, SEVERITY_NOTE
   use atrito_model, only: model_t
   use atrito_results, only: scene_t
   use atrito_page, only: page_t, begin_page, add_line, add_blank, add_rule, add_heading, add_paragraph, left, plural
   use atrito_model_report, only: describe_counts
   use atrito_scene_report, only: describe_needs, describe_bodies, describe_pairs
   implicit none (type, external)
   private
   public :: compose_check

   integer, parameter :: WIDTH = 79                 !< columns; a terminal of 80 does not wrap

contains

   !> Composes the report of a deck that has no errors.
   subroutine compose_check(model, scene, page)
      type(model_t), intent(in) :: model
      type(scene_t), intent(in) :: scene
      type(page_t), intent(out) :: page

      call begin_page(page, WIDTH)
      call add_rule(page, '=')
      call add_line(page, left(PROGRAM_NAME//' '//PROGRAM_VERSION//' check   '//model%deck_path, WIDTH))
      if (allocated(model%heading)) then
         if (size(model%heading) > 0) call add_line(page, left(model%heading(1)%s, WIDTH))
      end if
      call add_rule(page, '=')
      call describe_counts(page, model)
      if (allocated(scene%pairs)) then
         if (size(scene%pairs) > 0) call add_heading(page, 'contact')
      end if
      call describe_pairs(page, scene, some=.true.)
      call add_heading(page, 'solver')
      call describe_bodies(page, scene, factored=.false., some=.true.)
      call add_heading(page, 'needs')
      call describe_needs(page, scene)
      call add_blank(page)
      call add_line(page, 'no errors, '//plural(count_messages(SEVERITY_WARNING), 'warning', 'warnings')//', '// &
                    plural(count_messages(SEVERITY_NOTE), 'note', 'notes')//'; nothing was solved')
   end subroutine compose_check

end module atrito_check_report
