!> The pictures of a report, as letters within the page: drawings as SVG where that is small, else PNG; bytes as
!> text of 64 letters (RFC 4648, section 4).
module atrito_report_pictures
   use atrito_files, only: read_file, read_bytes, file_exists
   use atrito_html, only: html_text, add_note
   use atrito_page, only: page_t, begin_page, add_line
   use atrito_plot_files, only: plot_folder, picture_endings
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string, join
   implicit none (type, external)
   private
   public :: compose_pictures, picture_caption, base64_text, base64_length

   !> A drawing of more bytes is taken as points, where these are fewer.
   integer, parameter :: LARGE_DRAWING = 200000
   integer, parameter :: FRAME_BYTES = 1000         !< what stands round a picture

   !> A picture as it stands in its file.
   type :: picture_t
      character(len=:), allocatable :: file         !< name within the folder of plots
      character(len=:), allocatable :: bytes        !< of the file; not allocated: no room
   end type picture_t

   character(len=*), parameter :: LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/'
   character(len=1), parameter :: FILLER = '='

contains

   !> Puts pictures onto a page, in their order, as long as there is room. Those that find none are named.
   subroutine compose_pictures(folder, names, room, page)
      character(len=*), intent(in) :: folder        !< of the tables
      type(string_t), intent(in) :: names(:)        !< of pictures that were drawn, without ending
      integer, intent(in) :: room                   !< bytes
      type(page_t), intent(out) :: page             !< pictures as lines of HTML
      type(string_t), allocatable :: left_out(:)
      type(picture_t) :: picture
      integer :: i, free
      character(len=:), allocatable :: caption, kind

      call begin_page(page, 80)
      allocate (left_out(0))
      free = room
      if (size(names) > 0) call add_line(page, '<div class="pictures">')
      do i = 1, size(names)
         call choose_picture(plot_folder(folder), names(i)%s, free, picture)
         if (allocated(picture%bytes)) then
            associate (name => names(i)%s)
               caption = picture_caption(plot_folder(folder), name)
               kind = picture%file(index(picture%file, '.', back=.true.) + 1:)
               if (kind == 'svg') kind = 'svg+xml'
               call add_line(page, '<figure id="'//html_text('picture-'//name)//'">')
               call add_line(page, '<div class="scroll" tabindex="0" role="region" aria-label="'//html_text('picture '//name)//'">')
               call add_line(page, '<img alt="'//html_text(name//': '//caption)//'" src="data:image/'//kind//';base64,'// &
                             base64_text(picture%bytes)//'"></div>')
               call add_line(page, '<figcaption><strong>'//html_text(name)//'</strong> '//html_text(caption)//'. File: '// &
                             html_text('plots/'//picture%file)//'</figcaption>')
               call add_line(page, '</figure>')
            end associate
            free = free - base64_length(len(picture%bytes)) - FRAME_BYTES
         else
            call append_string(left_out, names(i)%s)
         end if
      end do
      if (size(names) > 0) call add_line(page, '</div>')
      if (size(left_out) > 0) call add_note(page, 'Left out, for the report would be too large: '//join(left_out, ', ')// &
                                            '. They are in '//plot_folder(folder)//'.')
   end subroutine compose_pictures

   !> The file of a picture to be taken; none where no file has room.
   subroutine choose_picture(folder, name, room, picture)
      character(len=*), intent(in) :: folder        !< of the plots
      character(len=*), intent(in) :: name
      integer, intent(in) :: room
      type(picture_t), intent(out) :: picture
      character(len=4), allocatable :: endings(:)
      character(len=:), allocatable :: bytes
      type(status_t) :: status
      integer :: k

      endings = picture_endings(name)
      do k = 1, size(endings)
         if (.not. file_exists(folder//'/'//name//endings(k))) cycle
         call read_bytes(folder//'/'//name//endings(k), bytes, status)
         if (.not. is_ok(status) .or. len(bytes) == 0) cycle
         if (base64_length(len(bytes)) + FRAME_BYTES > room) cycle
         if (allocated(picture%bytes)) then         ! lines are sharp at any size, as long as they are not too many
            if (len(bytes) >= len(picture%bytes) .and. .not. (endings(k) == '.svg' .and. len(bytes) <= LARGE_DRAWING)) cycle
         end if
         picture%file = name//endings(k)
         call move_alloc(bytes, picture%bytes)
      end do
   end subroutine choose_picture

   !> What a picture shows: the first line of its script says it behind the name of the program.
   function picture_caption(folder, name) result(caption)
      character(len=*), intent(in) :: folder        !< of the plots
      character(len=*), intent(in) :: name          !< of the picture, without ending
      character(len=:), allocatable :: caption, text
      type(status_t) :: status
      integer :: ends, colon

      caption = 'a picture'
      if (.not. file_exists(folder//'/'//name//'.gp')) return
      call read_file(folder//'/'//name//'.gp', text, status)
      if (.not. is_ok(status)) return
      ends = index(text, achar(10)) - 1
      if (ends < 1) return
      colon = index(text(:ends), ': ')
      if (text(1:1) == '#' .and. colon > 0) caption = text(colon + 2:ends)
   end function picture_caption

   !> Letters that so many bytes need.
   pure integer function base64_length(n_bytes) result(n)
      integer, intent(in) :: n_bytes !< >= 0

      n = 4*((n_bytes + 2)/3)
   end function base64_length

   !> Three bytes in four letters; what the last three lack is filled.
   pure function base64_text(bytes) result(text)
      character(len=*), intent(in) :: bytes         !< any bytes, one a character
      character(len=:), allocatable :: text
      integer :: i, k, word, there

      allocate (character(len=base64_length(len(bytes))) :: text)
      k = 0
      do i = 1, len(bytes), 3
         there = min(3, len(bytes) - i + 1)
         word = 65536*ichar(bytes(i:i))
         if (there > 1) word = word + 256*ichar(bytes(i + 1:i + 1))
         if (there > 2) word = word + ichar(bytes(i + 2:i + 2))
         text(k + 1:k + 4) = letter(word/262144)//letter(word/4096)//letter(word/64)//letter(word)
         if (there < 3) text(k + there + 2:k + 4) = repeat(FILLER, 3 - there)
         k = k + 4
      end do
   end function base64_text

   !> The letter of the last six bits.
   pure character(len=1) function letter(word)
      integer, intent(in) :: word
      integer :: i

      i = iand(word, 63) + 1
      letter = LETTERS(i:i)
   end function letter

end module atrito_report_pictures
