!> The results of another run that a folder still holds when this one writes none.
module atrito_older_results
   use atrito_files, only: file_exists, read_file
   use atrito_messages, only: add_note
   use atrito_model, only: provenance_t
   use atrito_read_table, only: comment_of, table_path
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: note_older_results, difference_text

   integer, parameter :: MOST_PARAMETERS = 3         !< named
   character(len=*), parameter :: BY_OPTION = ' (--set)'

contains

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

end module atrito_older_results
