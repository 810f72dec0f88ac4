!> A message as one object of JSON on one line, docs/user/messages.schema.json.
module atrito_message_json
   use atrito_kinds, only: ip
   use atrito_messages, only: message_t, severity_word
   use atrito_strings, only: string_t, to_text
   use atrito_utf8, only: disturbs, utf8_length
   implicit none (type, external)
   private
   public :: json_of_message, json_text

contains

   !> All members are there, always; what a message has not is null.
   function json_of_message(message) result(line)
      type(message_t), intent(in) :: message !< as it was added
      character(len=:), allocatable :: line
      logical :: has_place

      has_place = message%line > 0
      line = '{"severity":"'//severity_word(message%severity)//'"'//text_member('id', message%id)// &
             text_member('file', message%file)//number_member('line', message%line, has_place)// &
             number_member('column', max(message%column, 1_ip), has_place)// &
             number_member('length', max(message%length, 1_ip), has_place)//text_member('text', message%text)// &
             text_member('expected', message%expected)//list_member('nearest', message%nearest)// &
             list_member('known', message%known)//text_member('keyword', message%keyword)// &
             text_member('source', message%source)//number_member('skipped', message%skipped, allocated(message%source))// &
             number_member('more', message%more, .true.)//'}'
   end function json_of_message

   pure function text_member(name, text) result(member)
      character(len=*), intent(in) :: name
      character(len=*), intent(in), optional :: text
      character(len=:), allocatable :: member

      member = 'null'
      if (present(text)) member = json_text(text)
      member = ',"'//name//'":'//member
   end function text_member

   pure function number_member(name, number, is_there) result(member)
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: number
      logical, intent(in) :: is_there
      character(len=:), allocatable :: member

      member = 'null'
      if (is_there) member = to_text(number)
      member = ',"'//name//'":'//member
   end function number_member

   !> An empty list tells nothing: null.
   pure function list_member(name, list) result(member)
      character(len=*), intent(in) :: name
      type(string_t), intent(in), optional :: list(:)
      character(len=:), allocatable :: member
      integer :: i

      member = ''
      if (present(list)) then
         do i = 1, size(list)
            member = member//','//json_text(list(i)%s)
         end do
      end if
      if (len(member) == 0) then
         member = 'null'
      else
         member = '['//member(2:)//']'
      end if
      member = ',"'//name//'":'//member
   end function list_member

   !> A text in quotes. Bytes that are not UTF-8 are taken for Latin-1: the text of a deck may be anything, JSON is UTF-8.
   pure function json_text(text) result(quoted)
      character(len=*), intent(in) :: text !< any bytes
      character(len=:), allocatable :: quoted
      integer :: i, n

      quoted = '"'
      i = 1
      do while (i <= len(text))
         n = utf8_length(text(i:))
         if (n > 1 .and. disturbs(text(i:i + max(n, 1) - 1))) then
            quoted = quoted//escaped_code(text(i:i + n - 1))
         else if (n > 1) then
            quoted = quoted//text(i:i + n - 1)
         else
            quoted = quoted//escaped(text(i:i))
         end if
         i = i + max(n, 1)
      end do
      quoted = quoted//'"'
   end function json_text

   !> The code of a character of two or three bytes.
   pure function escaped_code(symbol) result(text)
      character(len=*), intent(in) :: symbol
      character(len=6) :: text
      integer :: code, i

      code = iand(ichar(symbol(1:1)), merge(31, 15, len(symbol) == 2))
      do i = 2, len(symbol)
         code = 64*code + iand(ichar(symbol(i:i)), 63)
      end do
      write (text, '(a, z4.4)') '\u', code
   end function escaped_code

   !> One byte that is a character by itself.
   pure function escaped(symbol) result(text)
      character(len=1), intent(in) :: symbol
      character(len=:), allocatable :: text
      character(len=6) :: code

      text = symbol
      if (symbol == '"' .or. symbol == '\') then
         text = '\'//symbol
      else if (ichar(symbol) < 32 .or. ichar(symbol) >= 127) then
         write (code, '(a, z4.4)') '\u', ichar(symbol)
         text = code
      end if
   end function escaped

end module atrito_message_json
