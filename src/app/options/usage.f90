!> How the program is called, for `atrito` alone and `atrito --help` (docs/user/running.md), from the tables of tasks and options.
module atrito_usage
   use atrito_option_groups, only: option_group_t, group_options
   use atrito_option_table, only: option_text, phrase_text
   use atrito_page, only: page_t, begin_page, add_blank, add_line, add_paragraph
   use atrito_task_table, only: TASKS, task_form, called
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: compose_usage, compose_options, exit_code_t, EXIT_CODES, SUMMARY

   character(len=*), parameter :: SUMMARY = 'contact with friction between elastic bodies'

   type :: exit_code_t
      character(len=13) :: codes
      character(len=110) :: meaning
   end type exit_code_t

   type(exit_code_t), parameter :: EXIT_CODES(*) = [ &
                                   exit_code_t('0', 'solved, checked, all tables written; compare: the same'), &
                                   exit_code_t('1', 'wrong command line; compare: different'), &
                                   exit_code_t('2', 'errors in the deck, all of them listed; nothing computed'), &
                            exit_code_t('3', 'not converged, or the final check failed: the last iterate is written, and marked'), &
                                   exit_code_t('4', 'singular or indefinite system'), &
                                   exit_code_t('5', 'a file cannot be read or written'), &
                                   exit_code_t('9', 'internal error'), &
                                   exit_code_t('129, 130, 143', 'ended by SIGHUP, SIGINT, SIGTERM; nothing half-written is left')]
   integer, parameter :: WIDTH = 80                  !< columns of the screen

contains

   !> The short form.
   subroutine compose_usage(page)
      type(page_t), intent(out) :: page
      integer :: task

      call begin_page(page, WIDTH)
      do task = 1, size(TASKS)
         call add_line(page, merge('usage: ', '       ', task == 1)//task_form(task))
      end do
      call add_line(page, '       atrito --help | --version')
   end subroutine compose_usage

   !> The long form: every command, option and exit code.
   subroutine compose_options(page)
      type(page_t), intent(out) :: page
      type(option_group_t), allocatable :: groups(:)
      integer :: i
      integer, parameter :: COMMANDS = 28, CODES = 18     !< columns before their meaning

      call begin_page(page, WIDTH)
      call add_line(page, PROGRAM_NAME//' '//PROGRAM_VERSION//': '//SUMMARY)
      call add_blank(page)
      do i = 1, size(TASKS)
         call add_pair(page, called(i)//merge(' [options]', '          ', i == 1), trim(TASKS(i)%phrase), COMMANDS)
      end do
      call add_line(page, 'atrito --help | --version')
      call group_options(groups)
      do i = 1, size(groups)
         call add_group(page, groups(i))
      end do
      call add_blank(page)
      call add_line(page, 'exit codes')
      do i = 1, size(EXIT_CODES)
         call add_pair(page, '  '//trim(EXIT_CODES(i)%codes), trim(EXIT_CODES(i)%meaning), CODES)
      end do
   end subroutine compose_options

   subroutine add_group(page, group)
      type(page_t), intent(inout) :: page
      type(option_group_t), intent(in) :: group
      integer :: i
      integer, parameter :: NAMES = 22

      call add_blank(page)
      call add_line(page, group%title)
      do i = 1, size(group%options)
         call add_pair(page, '  '//option_text(group%options(i)), phrase_text(group%options(i)), NAMES)
      end do
      if (len(group%others) > 0) call add_paragraph(page, group%others, 2)
   end subroutine add_group

   !> A word, and its meaning in a column of its own; a word that leaves no room has a line to itself.
   subroutine add_pair(page, word, meaning, column)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: word, meaning
      integer, intent(in) :: column                 !< blanks before the meaning
      integer :: first

      if (len_trim(word) >= column) call add_line(page, word)
      first = page%n + 1
      call add_paragraph(page, meaning, column)
      if (len_trim(word) < column) page%lines(first)%s(:len_trim(word)) = trim(word)
   end subroutine add_pair

end module atrito_usage
