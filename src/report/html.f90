!> Elements of HTML: text of the user, lines with a tag, lists of facts. Lines are gathered on a page of text.
module atrito_html
   use atrito_page, only: page_t, add_line
   use atrito_strings, only: string_t
   use atrito_utf8, only: utf8_length
   implicit none (type, external)
   private
   public :: html_text, shortened, unbroken, fact_t, add_fact, add_element, add_facts, add_list, add_note, add_pre

   !> Replacement character: what can be no letter of a page.
   character(len=*), parameter :: NO_LETTER = '&#65533;'

   !> A label and what belongs to it, as plain text.
   type :: fact_t
      character(len=:), allocatable :: label, value !< plain text
      character(len=:), allocatable :: remark       !< in small letters below; not allocated: none
   end type fact_t

contains

   !> Plain text as text of HTML, also within the quotes of an attribute. Bytes that are not UTF-8 are taken for Latin-1.
   pure function html_text(text) result(html)
      character(len=*), intent(in) :: text          !< plain text of any bytes
      character(len=:), allocatable :: html
      character(len=10*len(text)) :: room           ! of the longest replacement
      integer :: i, n, last
      character(len=:), allocatable :: piece
      character(len=*), parameter :: SIGNS = '&<>"'''
      character(len=6), parameter :: NAMES(len(SIGNS)) = ['&amp; ', '&lt;  ', '&gt;  ', '&quot;', '&#39; ']
      character(len=3) :: code

      last = 0
      i = 1
      do while (i <= len(text))
         n = utf8_length(text(i:))
         ! One letter, or one byte that is none of UTF-8.
         associate (bytes => text(i:i + max(n, 1) - 1))
            piece = bytes
            if (index(SIGNS, bytes) > 0) then
               piece = trim(NAMES(index(SIGNS, bytes)))
            else if (bytes == achar(9)) then
               piece = ' '
            else if (n > 0) then
               if (is_control(bytes)) piece = NO_LETTER
            else
               write (code, '(i3)') ichar(bytes)
               piece = '&#'//code//';'
               if (ichar(bytes) < 160) piece = NO_LETTER
            end if
         end associate
         room(last + 1:last + len(piece)) = piece
         last = last + len(piece)
         i = i + max(n, 1)
      end do
      html = room(:last)
   end function html_text

   !> Control characters, those of UTF-8 with two bytes too, and letters that are for the use of programs alone.
   pure logical function is_control(letter)
      character(len=*), intent(in) :: letter
      integer :: lead, second, third

      lead = ichar(letter(1:1))
      is_control = len(letter) == 1 .and. (lead < 32 .or. lead == 127)
      if (len(letter) == 1) return
      second = ichar(letter(2:2))
      if (len(letter) == 2) is_control = lead == 194 .and. second < 160
      if (len(letter) < 3) return
      third = ichar(letter(len(letter):))
      if (len(letter) == 3) is_control = (lead == 239 .and. second == 183 .and. third >= 144 .and. third < 176) .or. &
                                         (lead == 239 .and. second == 191 .and. third >= 190)
      if (len(letter) == 4) is_control = iand(second, 15) == 15 .and. ichar(letter(3:3)) == 191 .and. third >= 190
   end function is_control

   !> A text cut where it is too long; no letter is taken apart.
   pure function shortened(text, most) result(short)
      character(len=*), intent(in) :: text          !< plain text
      integer, intent(in) :: most                   !< bytes
      character(len=:), allocatable :: short
      integer :: last

      short = text
      if (len(text) <= most) return
      last = most
      do while (last > 1)
         if (iand(ichar(text(last + 1:last + 1)), 192) /= 128) exit
         last = last - 1
      end do
      short = text(:last)//' ...'
   end function shortened

   !> A text that is not broken into lines.
   pure function unbroken(text) result(whole)
      character(len=*), intent(in) :: text          !< plain text
      character(len=:), allocatable :: whole
      character(len=2), parameter :: BLANK = char(194)//char(160)
      integer :: i

      whole = ''
      do i = 1, len(text)
         if (text(i:i) == ' ') then
            whole = whole//BLANK
         else
            whole = whole//text(i:i)
         end if
      end do
   end function unbroken

   !> Adds a label with its value, plain text, and a remark below it where one is given.
   pure subroutine add_fact(facts, label, value, remark)
      type(fact_t), allocatable, intent(inout) :: facts(:) !< becomes longer by one; not allocated: empty
      character(len=*), intent(in) :: label, value         !< plain text
      character(len=*), intent(in), optional :: remark     !< plain text; left out: none
      type(fact_t) :: fact

      fact%label = label
      fact%value = value
      if (present(remark)) fact%remark = remark
      if (.not. allocated(facts)) allocate (facts(0))
      facts = [facts, fact]
   end subroutine add_fact

   !> `<tag>text</tag>`, the text plain.
   pure subroutine add_element(page, tag, text, attributes)
      type(page_t), intent(inout) :: page                    !< gets a line of HTML
      character(len=*), intent(in) :: tag, text              !< name of the element; plain text
      character(len=*), intent(in), optional :: attributes   !< with a blank before them
      character(len=:), allocatable :: opening

      opening = tag
      if (present(attributes)) opening = tag//attributes
      call add_line(page, '<'//opening//'>'//html_text(text)//'</'//tag//'>')
   end subroutine add_element

   !> A paragraph in small letters.
   pure subroutine add_note(page, text)
      type(page_t), intent(inout) :: page           !< gets a line of HTML
      character(len=*), intent(in) :: text          !< plain text

      call add_element(page, 'p', text, ' class="note"')
   end subroutine add_note

   !> A list of facts.
   pure subroutine add_facts(page, facts, class)
      type(page_t), intent(inout) :: page           !< gets lines of HTML
      type(fact_t), intent(in) :: facts(:)          !< in their order; of none nothing is added
      character(len=*), intent(in) :: class         !< tiles or plain
      character(len=:), allocatable :: remark
      integer :: i

      if (size(facts) == 0) return
      call add_line(page, '<dl class="'//class//'">')
      do i = 1, size(facts)
         remark = ''
         if (allocated(facts(i)%remark)) remark = '<dd class="small">'//html_text(facts(i)%remark)//'</dd>'
         call add_line(page, '<div><dt>'//html_text(facts(i)%label)//'</dt><dd>'//html_text(facts(i)%value)//'</dd>' &
                       //remark//'</div>')
      end do
      call add_line(page, '</dl>')
   end subroutine add_facts

   !> A list of texts.
   pure subroutine add_list(page, texts)
      type(page_t), intent(inout) :: page           !< gets lines of HTML
      type(string_t), intent(in) :: texts(:)        !< plain text; of none nothing is added
      integer :: i

      if (size(texts) == 0) return
      call add_line(page, '<ul>')
      do i = 1, size(texts)
         call add_element(page, 'li', texts(i)%s)
      end do
      call add_line(page, '</ul>')
   end subroutine add_list

   !> The lines of a text as they are.
   pure subroutine add_pre(page, text, attributes)
      type(page_t), intent(inout) :: page                    !< gets lines of HTML
      character(len=*), intent(in) :: text                   !< plain text, lines with LF between them
      character(len=*), intent(in) :: attributes             !< with a blank before them, or none
      integer :: first, last

      call add_line(page, '<pre'//attributes//'>')
      first = 1
      do while (first <= len(text))
         last = index(text(first:), achar(10))
         last = merge(len(text), first + last - 2, last == 0)
         call add_line(page, html_text(text(first:last)))
         first = last + 2
      end do
      call add_line(page, '</pre>')
   end subroutine add_pre

end module atrito_html
