!> Decks as they were run that an older atrito wrote: they do not say so, but the listing beside them has their digest, in which the
!> copies of meshes are counted, too.
module atrito_unmarked_decks
   use, intrinsic :: iso_c_binding, only: c_int, c_int64_t, c_null_char, c_size_t
   use atrito_as_run_names, only: as_run_name, mesh_copy_name
   use atrito_digest, only: text_digest_t, add_characters, hexadecimal
   use atrito_kinds, only: ip
   use atrito_system, only: c_close_input, c_open_input, c_read_input
   implicit none (type, external)
   private
   public :: deck_of_copy, listed_line

contains

   !> The name of the deck of which a file is a copy, by the file's name: 'a' of 'a.run.inp', 'a.run.msh' and 'a.run-2.msh'; ''
   !> where it has another form.
   pure function deck_of_copy(name) result(deck)
      character(len=*), intent(in) :: name           !< without folder
      character(len=:), allocatable :: deck
      integer :: last

      last = index(name, '.run', back=.true.)
      deck = ''
      if (last < 2) return
      select case (name(last:))
      case ('.run.inp', '.run.msh')
         deck = name(:last - 1)
      case default
         if (index(name(last:), '.run-') == 1 .and. index(name(last:), '.msh') > 0) deck = name(:last - 1)
      end select
   end function deck_of_copy

   !> The line that the listing of a run has of its deck when the files beside it are still as the run wrote them; '' where the deck
   !> cannot be read.
   function listed_line(folder, deck) result(line)
      character(len=*), intent(in) :: folder         !< '' or with a / at its end
      character(len=*), intent(in) :: deck           !< name of the deck, without folder and .inp
      character(len=:), allocatable :: line
      type(text_digest_t) :: digest
      character(len=:), allocatable :: text, mesh, name
      integer(ip) :: n
      integer :: place
      logical :: is_read

      line = ''
      call read_whole(folder//as_run_name(deck), text, is_read)
      if (.not. is_read) return
      ! the names of copies are no part of the deck that was run
      n = 1
      do
         name = mesh_copy_name(deck, n)
         place = index(text, name)
         if (place == 0) exit
         text = text(:place - 1)//text(place + len(name):)
         n = n + 1
      end do
      call add_characters(digest, text)
      do n = 1, n - 1
         call read_whole(folder//mesh_copy_name(deck, n), mesh, is_read)
         if (.not. is_read) return
         call add_characters(digest, mesh)
      end do
      line = 'as run  '//as_run_name(deck)//', digest '//hexadecimal(digest)
   end function listed_line

   subroutine read_whole(path, text, is_read)
      character(len=*), intent(in) :: path
      character(len=:), allocatable, intent(out) :: text
      logical, intent(out) :: is_read
      integer(c_int64_t) :: length
      integer(c_int) :: file
      integer :: state

      length = 0
      file = c_open_input(path//c_null_char, length)
      is_read = file >= 0
      if (.not. is_read) return
      is_read = length <= huge(1)
      state = 0
      if (is_read) allocate (character(len=int(length)) :: text, stat=state)
      is_read = is_read .and. state == 0
      if (is_read .and. length > 0) is_read = c_read_input(file, text, int(length, c_size_t), 0_c_int64_t) == 1
      call c_close_input(file)
   end subroutine read_whole

end module atrito_unmarked_decks
