!> The options by the commands that know them, as `--help` and the manual page list them.
module atrito_option_groups
   use atrito_option_table, only: OPTIONS
   use atrito_strings, only: string_t, append_string, join
   use atrito_task_table, only: TASKS, TASK_RUN, TASK_HELP
   implicit none (type, external)
   private
   public :: option_group_t, group_options

   type :: option_group_t
      character(len=:), allocatable :: title        !< `options of a run`
      integer, allocatable :: options(:)            !< places in OPTIONS
      character(len=:), allocatable :: others       !< which of them the other commands know; '': not to be told
   end type option_group_t

contains

   !> First the options of a run, then those that a run does not know, last those of every command.
   subroutine group_options(groups)
      type(option_group_t), allocatable, intent(out) :: groups(:)
      type(option_group_t) :: of_run, of_all
      integer, allocatable :: rest(:)
      logical, allocatable :: is_alike(:)
      logical :: is_general(size(OPTIONS)), is_of_run(size(OPTIONS))
      integer :: i

      is_general = [(all(OPTIONS(i)%for_task), i=1, size(OPTIONS))]
      is_of_run = [(OPTIONS(i)%for_task(TASK_RUN), i=1, size(OPTIONS))] .and. .not. is_general
      of_run = option_group_t('options of a run', pack([(i, i=1, size(OPTIONS))], is_of_run), '')
      of_run%others = others_text(of_run%options)
      of_all = option_group_t('options of every command', pack([(i, i=1, size(OPTIONS))], is_general), '')
      groups = [of_run]
      rest = pack([(i, i=1, size(OPTIONS))],.not. (is_general .or. is_of_run))
      do while (size(rest) > 0)
         is_alike = [(all(OPTIONS(rest(i))%for_task .eqv. OPTIONS(rest(1))%for_task), i=1, size(rest))]
         groups = [groups, option_group_t('options of '//commands_text(OPTIONS(rest(1))%for_task), pack(rest, is_alike), '')]
         rest = pack(rest,.not. is_alike)
      end do
      groups = [groups, of_all]
   end subroutine group_options

   !> `sweep and limit`
   pure function commands_text(known) result(text)
      logical, intent(in) :: known(:)               !< by task
      character(len=:), allocatable :: text
      type(string_t), allocatable :: names(:)
      integer :: task

      allocate (names(0))
      do task = 1, size(known)
         if (known(task)) call append_string(names, trim(TASKS(task)%name))
      end do
      text = join(names, ' and ')
   end function commands_text

   !> `Of these check knows --set, --refine; sweep, limit all but --restart.`
   pure function others_text(members) result(text)
      integer, intent(in) :: members(:)             !< the options of a run
      character(len=:), allocatable :: text
      character(len=:), allocatable :: known, before
      integer :: task

      text = ''
      before = ''
      do task = 1, size(TASKS)
         if (task == TASK_RUN .or. task == TASK_HELP) cycle
         known = knows_text(task, members)
         if (known == before) then
            text = text//', '//trim(TASKS(task)%name)
         else if (len(text) == 0) then
            text = 'Of these '//trim(TASKS(task)%name)//' knows'
         else
            text = text//' '//before//'; '//trim(TASKS(task)%name)
         end if
         before = known
      end do
      text = text//' '//before//'.'
   end function others_text

   !> What a command knows, or what it does not know, whatever is shorter.
   pure function knows_text(task, members) result(text)
      integer, intent(in) :: task
      integer, intent(in) :: members(:)
      character(len=:), allocatable :: text
      logical :: known(size(members))
      integer :: i

      known = [(OPTIONS(members(i))%for_task(task), i=1, size(members))]
      if (all(known)) then
         text = 'all'
      else if (2*count(known) > size(members)) then
         text = 'all but '//names_text(pack(members,.not. known))
      else
         text = names_text(pack(members, known))
      end if
   end function knows_text

   pure function names_text(members) result(text)
      integer, intent(in) :: members(:)
      character(len=:), allocatable :: text
      type(string_t) :: names(size(members))
      integer :: i

      do i = 1, size(members)
         names(i)%s = trim(OPTIONS(members(i))%name)
      end do
      text = join(names, ', ')
   end function names_text

end module atrito_option_groups
