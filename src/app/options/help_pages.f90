!> `atrito help`: of a keyword, or one of the pages that are made of the tables.
module atrito_help_pages
   use atrito_bash_completion, only: compose_bash_completion
   use atrito_help, only: help_overview, help_keyword, help_manual
   use atrito_man_page, only: compose_man_page
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: compose_help

contains

   !> What is asked for; is_known is false where there is no such page and no such keyword.
   subroutine compose_help(words, lines, is_known)
      character(len=*), intent(in) :: words         !< in capitals, blanks between them
      type(string_t), allocatable, intent(out) :: lines(:)
      logical, intent(out) :: is_known

      is_known = .true.
      select case (words)
      case ('')
         call help_overview(lines)
      case ('ALL')
         call help_manual(lines)
      case ('MAN')
         call compose_man_page(lines)
      case ('BASH')
         call compose_bash_completion(lines)
      case default
         call help_keyword(words, lines, is_known)
      end select
   end subroutine compose_help

end module atrito_help_pages
