!> Models of decks written line by line, and what was said of them.
module model_cases
   use atrito_build_model, only: build_model
   use atrito_deck, only: deck_t
   use atrito_files, only: file_set_t, text_file_t, begin_files, open_text, put_line, close_text, commit_files
   use atrito_kinds, only: ip, lp
   use atrito_messages, only: message_t, clear_messages, count_messages, get_message, sort_messages
   use atrito_model, only: model_t
   use atrito_reader, only: read_deck
   use atrito_sets, only: find_set, members_of
   use atrito_status, only: status_t
   use atrito_strings, only: string_t, same_name, to_text
   implicit none (type, external)
   private
   public :: PLATE, SECTION, ENDING, FLOOR, build, build_with, build_refined, build_within, read_scene, write_file, said, &
             first_text, node_ids, element_ids, faces_text

   !> Two unit squares side by side.
   character(len=*), parameter :: PLATE = '*NODE|1, 0, 0|2, 1, 0|3, 2, 0|11, 0, 1|12, 1, 1|13, 2, 1|'// &
                                  '*ELEMENT, TYPE=CPE4, ELSET=E|1, 1, 2, 12, 11|2, 2, 3, 13, 12|'
   character(len=*), parameter :: SECTION = '*MATERIAL, NAME=M|*ELASTIC|1000, 0.3|*SOLID SECTION, ELSET=E, MATERIAL=M|'
   character(len=*), parameter :: ENDING = '*STEP|*END STEP'
   !> A rigid floor under the plate.
   character(len=*), parameter :: FLOOR = '*SURFACE, NAME=LOW, TYPE=ELEMENT|E, S1|*SURFACE, NAME=FLOOR, TYPE=SEGMENTS|'// &
                                  'START, -1, 0|LINE, 3, 0|*RIGID BODY, ANALYTICAL SURFACE=FLOOR|'

   character(len=*), parameter :: FOLDER = 'unit_model_files'

contains

   !> The model of a deck; its lines are separated by '|'.
   subroutine build(text, model)
      character(len=*), intent(in) :: text
      type(model_t), intent(out) :: model
      type(string_t) :: none(0)

      call build_with(text, none, model)
   end subroutine build

   !> As build, refined.
   subroutine build_refined(text, levels, model)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: levels
      type(model_t), intent(out) :: model
      type(string_t) :: none(0)

      call build_with(text, none, model, levels)
   end subroutine build_refined

   !> As build, with settings.
   subroutine build_with(text, settings, model, levels)
      character(len=*), intent(in) :: text
      type(string_t), intent(in) :: settings(:)
      type(model_t), intent(out) :: model
      integer(ip), intent(in), optional :: levels       !< of refinement
      type(deck_t) :: deck
      type(status_t) :: status

      call clear_messages()
      call write_deck(text)
      call read_deck(FOLDER//'/scene.inp', settings, deck, status)
      call build_model(deck, model, levels)
      call sort_messages()
   end subroutine build_with

   !> As build, refined, with so much memory.
   subroutine build_within(text, levels, memory, model)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: levels
      integer(lp), intent(in) :: memory                !< bytes
      type(model_t), intent(out) :: model
      type(deck_t) :: deck

      call read_scene(text, deck)
      call build_model(deck, model, levels, memory)
      call sort_messages()
   end subroutine build_within

   !> The deck alone.
   subroutine read_scene(text, deck)
      character(len=*), intent(in) :: text
      type(deck_t), intent(out) :: deck
      type(string_t) :: none(0)
      type(status_t) :: status

      call clear_messages()
      call write_deck(text)
      call read_deck(FOLDER//'/scene.inp', none, deck, status)
   end subroutine read_scene

   subroutine write_deck(text)
      character(len=*), intent(in) :: text

      call write_file('scene.inp', text)
   end subroutine write_deck

   !> Writes a file beside the deck; lines separated by '|'.
   subroutine write_file(name, text)
      character(len=*), intent(in) :: name, text
      type(file_set_t) :: set
      type(text_file_t) :: file
      type(string_t) :: none(0)
      type(status_t) :: status
      integer :: first, bar

      call begin_files(set, FOLDER, status)
      call open_text(set, name, file)
      first = 1
      do while (first <= len(text))
         bar = index(text(first:)//'|', '|')
         call put_line(file, text(first:first + bar - 2))
         first = first + bar
      end do
      call close_text(file, status)
      call commit_files(set, none, status)
   end subroutine write_file

   !> All messages as `ID line:column`, separated by '; '.
   function said() result(text)
      character(len=:), allocatable :: text
      type(message_t) :: message
      integer(ip) :: i

      text = ''
      do i = 1, count_messages()
         message = get_message(i)
         if (i > 1) text = text//'; '
         text = text//message%id//' '//to_text(message%line)//':'//to_text(message%column)
      end do
   end function said

   !> Text of the first message, '' when there is none.
   function first_text() result(text)
      character(len=:), allocatable :: text
      type(message_t) :: message

      text = ''
      if (count_messages() == 0) return
      message = get_message(1_ip)
      text = message%text
   end function first_text

   !> Ids in a node set, [-1] when there is none of this name.
   pure function node_ids(model, name) result(ids)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: name
      integer(ip), allocatable :: ids(:)
      integer(ip) :: i

      i = find_set(model%node_sets, name)
      ids = [-1_ip]
      if (i > 0) ids = model%mesh%node_id(members_of(model%node_sets%sets(i)))
   end function node_ids

   !> As node_ids for an element set.
   pure function element_ids(model, name) result(ids)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: name
      integer(ip), allocatable :: ids(:)
      integer(ip) :: i

      i = find_set(model%element_sets, name)
      ids = [-1_ip]
      if (i > 0) ids = model%mesh%element_id(members_of(model%element_sets%sets(i)))
   end function element_ids

   !> Faces of a surface as `element:face`, with a blank before each.
   pure function faces_text(model, name) result(text)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: text
      integer(ip) :: i, s

      text = 'no surface'
      do s = 1, size(model%surfaces, kind=ip)
         if (same_name(model%surfaces(s)%name, name)) exit
      end do
      if (s > size(model%surfaces)) return
      text = ''
      associate (faces => model%surfaces(s)%faces)
         do i = 1, faces%n
            text = text//' '//to_text(model%mesh%element_id(faces%element(i)))//':'//to_text(faces%face(i))
         end do
      end associate
   end function faces_text

end module model_cases
