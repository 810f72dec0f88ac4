!> The --vary of a limit: NAME=a:b.
module atrito_stability_range
   use atrito_kinds, only: wp
   use atrito_parameters, only: settings_t, read_settings
   use atrito_status, only: status_t, set_status, is_ok, STATUS_USAGE
   use atrito_strings, only: string_t, same_name
   implicit none (type, external)
   private
   public :: read_range

contains

   !> Takes NAME=a:b apart. status: STATUS_USAGE for anything else, a that is not below b, or a name that --set gives as well.
   subroutine read_range(text, settings, name, ends, status)
      character(len=*), intent(in) :: text
      type(string_t), intent(in) :: settings(:)        !< 'NAME=VALUE' of --set
      character(len=:), allocatable, intent(out) :: name
      real(wp), intent(out) :: ends(2)
      type(status_t), intent(out) :: status
      integer :: equals, colon

      ends = 0.0_wp
      equals = index(text, '=')
      colon = index(text, ':')
      name = trim(adjustl(text(:max(equals - 1, 0))))
      if (colon < equals + 1) then
         call complain(text, 'NAME=a:b is expected, the limit being between a and b', status)
         return
      end if
      call read_end(text, name, text(equals + 1:colon - 1), ends(1), status)
      if (is_ok(status)) call read_end(text, name, text(colon + 1:), ends(2), status)
      if (is_ok(status) .and. ends(1) >= ends(2)) call complain(text, 'the first value is not below the second one', status)
      if (is_ok(status)) call check_name(text, name, settings, status)
   end subroutine read_range

   subroutine read_end(text, name, expression, x, status)
      character(len=*), intent(in) :: text, name, expression
      real(wp), intent(out) :: x
      type(status_t), intent(out) :: status
      type(settings_t) :: setting

      x = 0.0_wp
      call read_settings([string_t(name//'='//trim(adjustl(expression)))], setting, status)
      if (is_ok(status)) then
         x = setting%values(1)
      else
         call complain(text, status%text, status)
      end if
   end subroutine read_end

   subroutine check_name(text, name, settings, status)
      character(len=*), intent(in) :: text, name
      type(string_t), intent(in) :: settings(:)
      type(status_t), intent(inout) :: status
      integer :: i

      do i = 1, size(settings)
         if (.not. same_name(trim(adjustl(settings(i)%s(:index(settings(i)%s, '=') - 1))), name)) cycle
         call complain(text, name//' is given by --set '//settings(i)%s, status)
      end do
   end subroutine check_name

   subroutine complain(text, what, status)
      character(len=*), intent(in) :: text, what
      type(status_t), intent(inout) :: status
      character(len=:), allocatable :: copy

      copy = what                                      ! it may be the text of this status
      call set_status(status, STATUS_USAGE, '--vary '//text//': '//copy)
   end subroutine complain

end module atrito_stability_range
