!> Mutations of the files of Gmsh that decks include.
module fuzz_meshes
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, to_text
   use fuzz_edits, only: replace_place, find_line, insert_at_line, flip_byte, delete_span, change_digit, delete_line, copy_line, &
                         swap_lines, truncate_deck, use_windows_ends
   use fuzz_random, only: random_t, random_integer, random_chance
   implicit none (type, external)
   private
   public :: mutate_mesh, choose_mesh

   character(len=1), parameter :: NEW_LINE_CHARACTER = achar(10)
   character(len=*), parameter :: BLANKS = ' '//NEW_LINE_CHARACTER
   integer(ip), parameter :: MOST_STEPS = 6            !< mutations of one mesh
   integer(ip), parameter :: LONGEST_MESH = 400000     !< characters
   character(len=24), parameter :: WORDS(64) = [character(len=24) :: '0', '-0', '1', '-1', '2', '3', '4', '5', '6', '7', '8', &
                         '9', '10', '12', '15', '16', '17', '21', '100', '1000', '100000', '50000000', '2147483646', '2147483647', &
                   '-2147483647', '-2147483648', '2147483648', '4294967296', '9223372036854775807', '-99999999999999999999', '+1', &
                 '1.', '1.5', '1e3', '1e-300', '1e308', '1e999', '-1e999', '1e60', 'nan', 'inf', '4.9e-324', '0.1', '-', '+', '.', &
                  '"', '""', '"a"', '"a b, c"', '"x', '"a""b"', '4.1', '2.2', '4.0', '3', '$Nodes', '$Elements', '$', '$EndNodes', &
                                                                                                 '$End', '*', 'x', '$PhysicalNames']
   character(len=20), parameter :: SECTIONS(14) = [character(len=20) :: '$Nodes', '$EndNodes', '$Elements', '$EndElements', &
                              '$PhysicalNames', '$EndPhysicalNames', '$Entities', '$EndEntities', '$MeshFormat', '$EndMeshFormat', &
                                                                   '$PartitionedEntities', '$Periodic', '$EndPeriodic', '$Comments']

contains

   !> The mesh that a deck names, the first one else; in the deck it gets another name.
   subroutine choose_mesh(names, meshes, new_name, deck, mesh)
      type(string_t), intent(in) :: names(:), meshes(:)
      character(len=*), intent(in) :: new_name
      character(len=:), allocatable, intent(inout) :: deck
      character(len=:), allocatable, intent(out) :: mesh
      integer(ip) :: i, place

      mesh = meshes(1)%s
      do i = 1, size(names, kind=ip)
         place = index(deck, names(i)%s, kind=ip)
         if (place == 0) cycle
         mesh = meshes(i)%s
         call replace_place(deck, place, place + len(names(i)%s, kind=ip) - 1, new_name)
         return
      end do
   end subroutine choose_mesh

   !> A mesh, changed once to six times.
   subroutine mutate_mesh(random, meshes, text)
      type(random_t), intent(inout) :: random
      type(string_t), intent(in) :: meshes(:)
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: n, steps

      call random_integer(random, 1_ip, MOST_STEPS, steps)
      call random_integer(random, 1_ip, (steps), steps)
      do n = 1, steps
         call mutate_once(random, meshes, text)
         if (len(text) > LONGEST_MESH) text = text(:LONGEST_MESH)
      end do
   end subroutine mutate_mesh

   subroutine mutate_once(random, meshes, text)
      type(random_t), intent(inout) :: random
      type(string_t), intent(in) :: meshes(:)
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: kind

      call random_integer(random, 1_ip, 40_ip, kind)
      select case (kind)
      case (1:2)
         call flip_byte(random, text)
      case (3)
         call delete_span(random, text)
      case (4:16)
         call replace_word(random, text)
      case (17:19)
         call change_digit(random, text)
      case (20:21)
         call delete_word(random, text)
      case (22:23)
         call delete_line(random, text)
      case (24:25)
         call copy_line(random, text)
      case (26:27)
         call swap_lines(random, text)
      case (28)
         call truncate_deck(random, text)
      case (29:33)
         call change_count(random, text)
      case default
         call disturb_section(random, meshes, text)
      end select
   end subroutine mutate_once

   !> Larger changes.
   subroutine disturb_section(random, meshes, text)
      type(random_t), intent(inout) :: random
      type(string_t), intent(in) :: meshes(:)
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: kind, i

      call random_integer(random, 1_ip, 10_ip, kind)
      select case (kind)
      case (1:2)
         call random_integer(random, 1_ip, size(SECTIONS, kind=ip), i)
         call insert_at_line(random, trim(SECTIONS(i))//NEW_LINE_CHARACTER, text)
      case (3:4)
         call move_section(random, string_t(text), text)
      case (5:6)
         call random_integer(random, 1_ip, size(meshes, kind=ip), i)
         call move_section(random, meshes(i), text)
      case (7)
         call use_windows_ends(text)
      case (8)
         call insert_at_line(random, repeat('1 ', 5000)//NEW_LINE_CHARACTER, text)
      case (9)
         call repeat_line(random, text)
      case default
         call insert_names(random, text)
      end select
   end subroutine disturb_section

   subroutine find_blank_word(random, text, first, last)
      type(random_t), intent(inout) :: random
      character(len=*), intent(in) :: text
      integer(ip), intent(out) :: first, last
      integer(ip) :: i

      first = 1
      last = 0
      if (len(text) == 0) return
      call random_integer(random, 1_ip, len(text, kind=ip), i)
      first = scan(text(:i - 1), BLANKS, back=.true., kind=ip) + 1
      last = first + scan(text(first:)//' ', BLANKS, kind=ip) - 2
   end subroutine find_blank_word

   subroutine replace_word(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: word
      integer(ip) :: first, last, i
      logical :: own

      call random_chance(random, 2_ip, own)
      if (own) then                                      ! another word of the same file
         call find_blank_word(random, text, first, last)
         word = text(first:last)
      else
         call random_integer(random, 1_ip, size(WORDS, kind=ip), i)
         word = trim(WORDS(i))
      end if
      call find_blank_word(random, text, first, last)
      call replace_place(text, first, last, word)
   end subroutine replace_word

   subroutine delete_word(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, last

      call find_blank_word(random, text, first, last)
      call replace_place(text, first, last, '')
   end subroutine delete_word

   !> A word of the first line of a section: how many there are of something.
   subroutine change_count(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: i, k, n, first, length

      call find_section(random, text, first, i)
      if (first == 0) return
      first = first + scan(text(first:)//NEW_LINE_CHARACTER, NEW_LINE_CHARACTER, kind=ip)
      call random_integer(random, 0_ip, 3_ip, n)
      do k = 1, n
         first = first + scan(text(first:)//' ', ' ', kind=ip)
      end do
      if (first > len(text)) return
      length = scan(text(first:)//' ', BLANKS, kind=ip) - 1
      call random_integer(random, 1_ip, size(WORDS, kind=ip), i)
      call replace_place(text, first, first + length - 1, trim(WORDS(i)))
   end subroutine change_count

   !> A section, from its $ to the next one that is no end; first = 0: there is none.
   subroutine find_section(random, text, first, last)
      type(random_t), intent(inout) :: random
      character(len=*), intent(in) :: text
      integer(ip), intent(out) :: first, last
      integer(ip) :: i

      last = 0
      first = 0
      if (len(text) == 0) return
      call random_integer(random, 1_ip, len(text, kind=ip), i)
      first = scan(text(:i), '$', back=.true., kind=ip)
      if (first == 0) return
      if (index(text(first:), '$End') == 1) first = scan(text(:max(first - 1, 1_ip)), '$', back=.true., kind=ip)
      if (first == 0) return
      last = first + index(text(first:), '$End', kind=ip)
      last = min(last + scan(text(last:)//NEW_LINE_CHARACTER, NEW_LINE_CHARACTER, kind=ip) - 1, len(text, kind=ip))
   end subroutine find_section

   !> A section of a mesh goes to another place, is there twice, or away.
   subroutine move_section(random, from, text)
      type(random_t), intent(inout) :: random
      type(string_t), intent(in) :: from                 !< a text of its own, not `text` itself
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: section
      integer(ip) :: first, last, kind

      call find_section(random, from%s, first, last)
      if (first == 0) return
      section = from%s(first:last)
      call find_section(random, text, first, last)
      if (first == 0) return
      call random_integer(random, 1_ip, 3_ip, kind)
      select case (kind)
      case (1)
         call replace_place(text, first, first - 1, section)
      case (2)
         call replace_place(text, first, last, section)
      case default
         call replace_place(text, first, last, '')
      end select
   end subroutine move_section

   subroutine repeat_line(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, last, n

      call find_line(random, text, first, last)
      call random_integer(random, 2_ip, 2000_ip, n)
      n = min(n, LONGEST_MESH/max(last - first + 1, 1_ip))
      call replace_place(text, first, first - 1, repeat(text(first:last), n))
   end subroutine repeat_line

   !> Physical names that are odd, long or many.
   subroutine insert_names(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=24), parameter :: NAMES(12) = [character(len=24) :: 'a b', 'a,b', 'a"b', '', ' ', 'upper', 'Surface1', '<q>', &
                                                                                                        '*NODE', 'a=b', 'a.b', '12']
      character(len=:), allocatable :: name, lines
      integer(ip) :: i, k, n, dim, tag
      logical :: odd

      call random_integer(random, 1_ip, size(NAMES, kind=ip), i)
      name = trim(NAMES(i))
      call random_chance(random, 3_ip, odd)
      if (odd) name = char(195)//char(164)//char(226)//achar(27)//repeat('n', 50*i)
      call random_integer(random, 1_ip, 300_ip, n)
      lines = '$PhysicalNames'//NEW_LINE_CHARACTER//to_text(n)//NEW_LINE_CHARACTER
      do k = 1, n
         call random_integer(random, 0_ip, 3_ip, dim)
         call random_integer(random, -1_ip, 9_ip, tag)
         lines = lines//to_text(dim)//' '//to_text(tag)//' "'//name//'"'//NEW_LINE_CHARACTER
      end do
      lines = lines//'$EndPhysicalNames'//NEW_LINE_CHARACTER
      call find_section(random, text, k, i)
      if (k > 0) call replace_place(text, k, k - 1, lines)
   end subroutine insert_names

end module fuzz_meshes
