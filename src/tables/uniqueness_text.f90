!> What is proved of the solution being the only one, in words that promise no more.
module atrito_uniqueness_text
   use atrito_kinds, only: ip, wp
   use atrito_page, only: number
   use atrito_results, only: uniqueness_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: uniqueness_text, solution_folder

contains

   !> One line of at most 65 columns; '' without friction, or where nothing was asked.
   pure function uniqueness_text(known) result(text)
      type(uniqueness_t), intent(in) :: known
      character(len=:), allocatable :: text
      character(len=:), allocatable :: up_to

      text = ''
      if (.not. known%nu > 0.0_wp) return
      up_to = 'nu = '//number(known%up_to_nu, 3)
      if (known%solutions > 1) then
         text = 'not the only solution: '//to_text(known%solutions - 1)//merge(' other ', ' others', known%solutions == 2)
         text = trim(text)//' found from '//to_text(known%starts)//' starts'
      else if (known%index < 0) then
         text = 'not the only solution: its index is -1'
      else if (known%up_to_nu >= known%nu) then
         text = 'exactly one solution for every load up to '//up_to//' (certified)'
      else
         text = 'not proved'
         if (known%up_to_nu > 0.0_wp) text = text//' beyond '//up_to
         if (known%solutions == 1) then
            text = text//'; '//to_text(known%starts)//' starts find no other solution'
         else if (len_trim(known%why_not) > 0) then
            text = text//': '//trim(known%why_not)
         else if (known%same_way_up_to_nu >= known%nu) then
            text = text//'; no other moves alike everywhere'
         end if
      end if
   end function uniqueness_text

   !> The folder of solution k, below that of the run, which has the first.
   pure function solution_folder(folder, k) result(path)
      character(len=*), intent(in) :: folder
      integer(ip), intent(in) :: k                  !< 2, 3, ..
      character(len=:), allocatable :: path

      path = folder//'/solution-'//to_text(k)
   end function solution_folder

end module atrito_uniqueness_text
