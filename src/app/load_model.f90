!> From a deck to a model that is going to be solved: of a run, with its messages, and of each next mesh of --adapt.
!>
!> The results of another run that a folder still holds when this one writes none.
module atrito_load_model
   use atrito_adaptation, only: adaptation_t, follow_error, give_up
   use atrito_build_model, only: build_model
   use atrito_build_requests, only: refuse_field_files
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_message, print_messages, print_status
   use atrito_deck, only: deck_t
   use atrito_deck_as_run, only: take_deck_as_run
   use atrito_element_table, only: KINDS, kind_named
   use atrito_element_trees, only: element_trees_t
   use atrito_files, only: forget_inputs, protect_input, file_exists, read_file
   use atrito_given_options, only: options_of_run
   use atrito_hdf5, only: has_hdf5
   use atrito_kinds, only: ip, wp
   use atrito_messages, only: message_t, clear_messages, count_messages, sort_messages, SEVERITY_ERROR, add_note
   use atrito_model, only: model_t, provenance_t
   use atrito_observations, only: observations_t, read_observations
   use atrito_parameters, only: list_parameters
   use atrito_patched_text, only: digest_of_texts
   use atrito_plane_state, only: FULL_STATE
   use atrito_read_table, only: comment_of, table_path
   use atrito_reader, only: read_deck
   use atrito_refine_model, only: card_of_trees
   use atrito_reporter, only: reporter_t, report_phase
   use atrito_results, only: history_t, last_frame
   use atrito_status, only: status_t, set_status, is_ok, STATUS_OK, STATUS_USAGE, STATUS_DECK
   use atrito_strings, only: string_t, upper_case
   use atrito_timers, only: start_phase, stop_phase
   implicit none (type, external)
   private
   public :: load_model, read_model, prepare_observations, check_bounds, take_next_mesh, note_older_results

   integer, parameter :: MOST_PARAMETERS = 3         !< named
   character(len=*), parameter :: BY_OPTION = ' (--set)'

contains

   !> Reads a deck and builds its model. All messages are printed; errors of the deck give STATUS_DECK.
   subroutine load_model(command, reporter, model, n_printed, code, only_errors, keeps_deck, adaptation)
      type(command_t), intent(in) :: command        !< path of the deck, --set, --refine and the like
      type(reporter_t), intent(in) :: reporter      !< tells the phase
      type(model_t), intent(out) :: model           !< whole where code is STATUS_OK
      integer(ip), intent(out) :: n_printed         !< messages printed so far
      integer, intent(out) :: code                  !< STATUS_*; STATUS_DECK also for the deck's errors
      logical, intent(in), optional :: only_errors  !< the others of this deck have been printed
      logical, intent(in), optional :: keeps_deck   !< as it is run, in the model; left out: .false.
      type(adaptation_t), intent(inout), optional :: adaptation !< how the elements of the deck are cut, where they are
      type(deck_t) :: deck
      type(status_t) :: status
      logical :: silent

      call report_phase(reporter, 'read  '//command%names(1)%s)
      call start_phase('read')
      call read_deck(command%names(1)%s, command%settings, deck, status)
      call stop_phase('read')
      n_printed = 0
      code = STATUS_DECK
      if (is_ok(status) .or. status%code == STATUS_DECK) then
         call build_from(command, deck, model, adaptation)
         if (.not. has_hdf5()) call refuse_field_files(deck)
         call sort_messages()
         if (present(keeps_deck) .and. count_messages(SEVERITY_ERROR) > 0) call note_older_results(output_folder(command), &
                                                                                               command%names(1)%s, model%provenance)
         silent = .false.
         if (present(only_errors)) silent = only_errors .and. count_messages(SEVERITY_ERROR) == 0
         if (.not. silent) call print_messages(command%quiet, 1_ip, command%json)
         n_printed = count_messages()
         if (count_messages(SEVERITY_ERROR) > 0) return
         if (is_ok(status) .and. .not. has_state(model, command%element)) then
            call set_status(status, STATUS_USAGE, '--elements '//trim(command%element)// &
                            ': the deck has elements of the other plane state')
         end if
      end if
      if (present(keeps_deck) .and. is_ok(status)) call keep_deck(deck, model, status, adaptation)
      code = status%code
      if (.not. is_ok(status)) call print_status(status, command%names(1)%s, command%json)
   end subroutine load_model

   !> The model of a command of which nothing is printed. ok: its deck has no errors.
   subroutine read_model(command, model, ok, adaptation)
      type(command_t), intent(in) :: command                    !< path of the deck, --set, --refine and the like
      type(model_t), intent(out) :: model                       !< whole where ok
      logical, intent(out) :: ok                                !< no error; else of no use
      type(adaptation_t), intent(inout), optional :: adaptation !< how elements are cut; the model keeps the deck then
      type(deck_t) :: deck
      type(status_t) :: status

      call read_deck(command%names(1)%s, command%settings, deck, status)
      ok = is_ok(status) .and. count_messages(SEVERITY_ERROR) == 0
      if (.not. ok) return
      call build_from(command, deck, model, adaptation)
      ok = count_messages(SEVERITY_ERROR) == 0
      if (.not. (ok .and. present(adaptation))) return
      call keep_deck(deck, model, status, adaptation)
      ok = is_ok(status)
   end subroutine read_model

   !> The model of a deck that was read, and what the tables tell of its parameters and the options.
   subroutine build_from(command, deck, model, adaptation)
      type(command_t), intent(in) :: command
      type(deck_t), intent(inout) :: deck
      type(model_t), intent(out) :: model
      type(adaptation_t), intent(inout), optional :: adaptation

      call start_phase('mesh')
      if (command%adapt > 0.0_wp .and. present(adaptation)) then
         call build_model(deck, model, command%refine, trees=adaptation%trees)
      else
         call build_model(deck, model, command%refine, shape=command%shape, state=command%state)
      end if
      call stop_phase('mesh')
      call list_parameters(deck, [string_t ::], model%provenance%parameters)
      call options_of_run(command, model%provenance%options)
   end subroutine build_from

   !> Follows the error to the next mesh. goes_on: there is one, and the model is its; else the model stays that of the last.
   subroutine take_next_mesh(command, history, model, observations, adaptation, n_printed, goes_on)
      type(command_t), intent(in) :: command        !< of the run
      type(history_t), intent(in), target :: history !< on the mesh of the model
      type(model_t), intent(inout) :: model         !< of the mesh that was solved; of the next one
      type(observations_t), intent(inout) :: observations !< belong to the model on return
      type(adaptation_t), intent(inout) :: adaptation !< gets the mesh, trees and why it ends
      integer(ip), intent(inout) :: n_printed       !< messages that were printed, or are forgotten
      logical, intent(out) :: goes_on               !< there is a next mesh to solve on
      type(element_trees_t) :: before
      logical :: ok

      goes_on = last_frame(history) > 0
      if (goes_on) goes_on = all(history%frames%converged .and. history%frames%law_holds)
      if (.not. goes_on) return
      before = adaptation%trees
      call follow_error(model, history, adaptation, goes_on)
      if (.not. goes_on) return
      call read_again(goes_on)
      if (goes_on) return
      call give_up(adaptation)
      adaptation%trees = before
      call read_again(ok)

   contains

      !> What was said of an earlier mesh is forgotten.
      subroutine read_again(ok)
         logical, intent(out) :: ok
         integer :: code

         call forget_inputs()
         call clear_messages()
         call read_model(command, model, ok, adaptation)
         code = STATUS_OK
         if (ok) call prepare_observations(command, model, observations, code)
         ok = ok .and. code == STATUS_OK
         n_printed = count_messages()
      end subroutine read_again

   end subroutine take_next_mesh

   !> --bound is a proof, and no restart file has it. status: STATUS_USAGE.
   subroutine check_bounds(command, model, status)
      type(command_t), intent(in) :: command
      type(model_t), intent(in) :: model
      type(status_t), intent(inout) :: status

      if (.not. (is_ok(status) .and. allocated(command%bound))) return
      if (size(command%bound) == 0) return
      if (command%proof == 'off') call set_status(status, STATUS_USAGE, '--bound asks for a proof, which --proof off excludes')
      if (model%restart_every > 0 .or. allocated(command%restart)) then
         call set_status(status, STATUS_USAGE, '--bound: not with *RESTART and --restart, whose files have no bounds')
      end if
   end subroutine check_bounds

   !> Reads the expressions of the deck and of --observe. code: STATUS_DECK or STATUS_USAGE for one that is wrong, which is printed.
   subroutine prepare_observations(command, model, observations, code)
      type(command_t), intent(in) :: command            !< its --observe is read
      type(model_t), intent(in) :: model                !< expressions of its *OBSERVE are read
      type(observations_t), intent(out) :: observations !< of the model, *OBSERVE first
      integer, intent(out) :: code                      !< STATUS_OK, STATUS_DECK or STATUS_USAGE
      type(message_t) :: error
      type(string_t), allocatable :: texts(:), bounds(:)
      logical :: ok

      code = STATUS_OK
      bounds = [string_t ::]
      if (allocated(command%bound)) bounds = command%bound
      texts = [string_t ::]
      if (allocated(command%observe)) texts = command%observe
      call read_observations(texts, model, observations, ok, error, bounds)
      if (ok) return
      code = merge(STATUS_DECK, STATUS_USAGE, error%line > 0)
      call print_message(error, command%json)
   end subroutine prepare_observations

   !> The deck as it is run, and its digest; its files are protected.
   subroutine keep_deck(deck, model, status, adaptation)
      type(deck_t), intent(inout) :: deck
      type(model_t), intent(inout) :: model
      type(status_t), intent(inout) :: status
      type(adaptation_t), intent(in), optional :: adaptation !< whose mesh the deck gets
      logical :: is_cut
      integer(ip) :: i

      do i = 1, deck%n_sources
         if (is_ok(status)) call protect_input(deck%sources(i)%identity, status)
      end do
      is_cut = .false.
      if (present(adaptation)) is_cut = adaptation%target > 0.0_wp .and. model%n_cut > 0
      if (is_cut) then
         call take_deck_as_run(deck, model%as_run, card_of_trees(deck, adaptation%trees))
      else
         call take_deck_as_run(deck, model%as_run)
      end if
      model%provenance%digest = digest_of_texts(model%as_run)
   end subroutine keep_deck

   !> Whether all elements of the deck have the plane state of a kind; nothing asked is always there.
   pure logical function has_state(model, element)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: element       !< name of a kind, or empty

      has_state = .true.
      if (len_trim(element) > 0) has_state = all(FULL_STATE(model%mesh%state) &
                                                 == FULL_STATE(KINDS(kind_named(upper_case(trim(element))))%state))
   end function has_state

   !> N-OLDER, where there are such: of what run, by the head of its summary (comma-separated values have none).
   subroutine note_older_results(folder, deck, provenance)
      character(len=*), intent(in) :: folder           !< of the tables
      character(len=*), intent(in) :: deck             !< of this run, a path
      type(provenance_t), intent(in) :: provenance     !< of this run, as far as it is known
      character(len=:), allocatable :: path, text
      type(status_t) :: status

      path = table_path(folder, 'summary')
      if (.not. file_exists(path)) return
      call read_file(path, text, status)
      if (is_ok(status)) call add_note('N-OLDER', folder//' still holds the results of another run'// &
                                       difference_text(text, deck(index(deck, '/', back=.true.) + 1:), provenance))
   end subroutine note_older_results

   !> ` (push = 9, here 90)`: what the head of a table tells of another run; empty where nothing differs that it tells.
   pure function difference_text(table, deck, provenance) result(text)
      character(len=*), intent(in) :: table            !< with its head
      character(len=*), intent(in) :: deck             !< name of this run's, without folder
      type(provenance_t), intent(in) :: provenance     !< of this run, as far as it is known
      character(len=:), allocatable :: text, older, newer

      text = ''
      older = comment_of(table, 'deck')
      if (len(older) == 0) return
      if (older /= deck) text = ', of the deck '//older
      if (older == deck .and. allocated(provenance%parameters)) then
         older = comment_of(table, 'parameters')
         text = other_values(older, provenance%parameters)
      end if
      newer = ''
      if (allocated(provenance%options)) newer = provenance%options
      older = comment_of(table, 'options')
      if (older /= newer) then
         if (len(older) == 0) text = text//', without options'
         if (len(older) > 0) text = text//', with the options '//older
      end if
      if (len(text) == 0) then
         newer = ''
         if (allocated(provenance%digest)) newer = provenance%digest
         older = comment_of(table, 'digest')
         if (older /= newer) text = ', of this deck before it changed'
      end if
      if (len(text) > 0) text = ' ('//text(3:)//')'
   end function difference_text

   !> `, push = 9, here 90, ...`: parameters whose values are others, of lists as `nu = 0.3, push = 9 (--set)`.
   pure function other_values(older, newer) result(text)
      character(len=*), intent(in) :: older, newer
      character(len=:), allocatable :: text, name, value, here
      integer :: first, last, place, n

      text = ''
      n = 0
      first = 1
      do while (first <= len(older))
         last = first + index(older(first:)//', ', ', ') - 2
         place = index(older(first:last), ' = ')
         if (place > 0) then
            name = older(first:first + place)          ! with ` =`
            value = value_of(older, name)
            here = value_of(newer, name)
            if (value /= here) then
               n = n + 1
               if (n == MOST_PARAMETERS + 1) text = text//', ...'
               if (n <= MOST_PARAMETERS) text = text//', '//name//' '//value
               if (n <= MOST_PARAMETERS .and. len(here) > 0) text = text//', here '//here
            end if
         end if
         first = last + 3
      end do
   end function other_values

   !> The value behind `name =` in such a list; empty where there is none.
   pure function value_of(list, name) result(value)
      character(len=*), intent(in) :: list, name
      character(len=:), allocatable :: value
      integer :: first, last

      value = ''
      first = index(', '//list, ', '//name//' ')
      if (first == 0) return
      first = first + len(name) + 1
      last = first + index(list(first:)//', ', ', ') - 2
      value = list(first:last)
      last = index(value, BY_OPTION)
      if (last > 0) value = value(:last - 1)
   end function value_of

end module atrito_load_model
