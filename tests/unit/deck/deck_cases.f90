!> Decks written line by line, and what the reader said of them.
module deck_cases
   use atrito_deck, only: deck_t
   use atrito_files, only: file_set_t, text_file_t, begin_files, open_text, put_line, close_text, commit_files
   use atrito_kinds, only: ip
   use atrito_messages, only: message_t, clear_messages, count_messages, get_message, sort_messages, SEVERITY_ERROR
   use atrito_reader, only: read_deck
   use atrito_status, only: status_t
   use atrito_strings, only: string_t, append_string, to_text
   implicit none (type, external)
   private
   public :: FOLDER, MAIN, line_of, write_deck, read_lines, read_with, ids_and_places, errors, first_text, has_text

   character(len=*), parameter :: FOLDER = 'unit_deck_files'
   character(len=*), parameter :: MAIN = FOLDER//'/main.inp'

contains

   !> Lines separated by '|'.
   subroutine line_of(text, lines)
      character(len=*), intent(in) :: text
      type(string_t), allocatable, intent(out) :: lines(:)
      integer :: first, bar

      allocate (lines(0))
      first = 1
      do while (first <= len(text))
         bar = index(text(first:)//'|', '|')
         call append_string(lines, text(first:first + bar - 2))
         first = first + bar
      end do
   end subroutine line_of

   !> Writes a file into FOLDER.
   subroutine write_deck(name, text)
      character(len=*), intent(in) :: name, text       !< lines separated by '|'
      type(file_set_t) :: set
      type(text_file_t) :: file
      type(string_t), allocatable :: lines(:)
      type(string_t) :: none(0)
      type(status_t) :: status
      integer :: i

      call begin_files(set, FOLDER, status)
      call open_text(set, name, file)
      call line_of(text, lines)
      do i = 1, size(lines)
         call put_line(file, lines(i)%s)
      end do
      call close_text(file, status)
      call commit_files(set, none, status)
   end subroutine write_deck

   !> Reads a deck of these lines.
   subroutine read_lines(text, deck)
      character(len=*), intent(in) :: text
      type(deck_t), intent(out) :: deck
      type(status_t) :: status
      type(string_t) :: none(0)

      call read_with(text, none, deck, status)
   end subroutine read_lines

   !> Reads a deck of these lines with settings.
   subroutine read_with(text, settings, deck, status)
      character(len=*), intent(in) :: text
      type(string_t), intent(in) :: settings(:)
      type(deck_t), intent(out) :: deck
      type(status_t), intent(out) :: status

      call clear_messages()
      call write_deck('main.inp', text)
      call read_deck(MAIN, settings, deck, status)
      call sort_messages()
   end subroutine read_with

   !> All messages as `ID line:column length`, separated by '; '.
   function ids_and_places() result(text)
      character(len=:), allocatable :: text
      type(message_t) :: message
      integer(ip) :: i

      text = ''
      do i = 1, count_messages()
         message = get_message(i)
         if (i > 1) text = text//'; '
         text = text//message%id//' '//to_text(message%line)//':'//to_text(message%column)//' '//to_text(message%length)
      end do
   end function ids_and_places

   integer(ip) function errors()
      errors = count_messages(SEVERITY_ERROR)
   end function errors

   !> Text of the first message, '' when there is none.
   function first_text() result(text)
      character(len=:), allocatable :: text
      type(message_t) :: message

      text = ''
      if (count_messages() == 0) return
      message = get_message(1_ip)
      text = message%text
   end function first_text

   !> The first message has this among what it expects, its nearest and its known names.
   logical function has_text(part)
      character(len=*), intent(in) :: part
      type(message_t) :: message
      integer :: i

      has_text = .false.
      if (count_messages() == 0) return
      message = get_message(1_ip)
      if (allocated(message%expected)) has_text = index(message%expected, part) > 0
      if (allocated(message%nearest)) then
         do i = 1, size(message%nearest)
            has_text = has_text .or. message%nearest(i)%s == part
         end do
      end if
      if (allocated(message%known)) then
         do i = 1, size(message%known)
            has_text = has_text .or. message%known(i)%s == part
         end do
      end if
   end function has_text

end module deck_cases
