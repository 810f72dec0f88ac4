!> The --vary of a sweep and of a limit. The runs of a sweep: every combination of the values, the last parameter changing fastest.
module atrito_sweep_plan
   use atrito_kinds, only: ip, wp
   use atrito_parameters, only: settings_t, read_settings
   use atrito_status, only: status_t, set_status, is_ok, STATUS_USAGE
   use atrito_strings, only: string_t, append_string, same_name, to_text
   implicit none (type, external)
   private
   public :: sweep_plan_t, plan_sweep, read_range

   integer(ip), parameter :: MOST_RUNS = 10000_ip

   !> The runs of a sweep.
   type :: sweep_plan_t
      integer(ip) :: n_runs = 0                      !< >= 1; product of the numbers of values
      type(string_t), allocatable :: names(:)        !< the parameters that vary
      type(string_t), allocatable :: texts(:, :)     !< (parameters, runs) values as the user wrote them
      real(wp), allocatable :: values(:, :)          !< (parameters, runs)
      type(string_t), allocatable :: labels(:)       !< (runs) 'nu=0.3, eps=1e-4'
      type(string_t), allocatable :: folders(:)      !< (runs) 'nu_0.3,eps_1e-4': no blank, and no = that awk takes for an order
   end type sweep_plan_t

   !> One --vary.
   type :: variation_t
      character(len=:), allocatable :: name          !< of the parameter
      type(string_t), allocatable :: texts(:)        !< as the user wrote them
      real(wp), allocatable :: values(:)             !< of the texts
   end type variation_t

contains

   !> Makes the plan. status: STATUS_USAGE for what is not NAME=v1,v2,..., a name given twice, also by --set, or a value twice.
   subroutine plan_sweep(vary, settings, plan, status)
      type(string_t), intent(in) :: vary(:)            !< 'NAME=v1,v2,...'
      type(string_t), intent(in) :: settings(:)        !< 'NAME=VALUE' of --set
      type(sweep_plan_t), intent(out) :: plan          !< of no use where status is not OK
      type(status_t), intent(out) :: status            !< STATUS_OK or STATUS_USAGE
      type(variation_t) :: variations(size(vary))
      integer :: i

      allocate (plan%names(0))
      plan%n_runs = 1
      do i = 1, size(vary)
         call read_variation(vary(i)%s, variations(i), status)
         if (is_ok(status)) call check_name(variations(i)%name, vary(i)%s, plan%names, settings, status)
         if (.not. is_ok(status)) return
         call append_string(plan%names, variations(i)%name)
         if (size(variations(i)%texts) > MOST_RUNS/plan%n_runs) then
            call set_status(status, STATUS_USAGE, '--vary: more than '//to_text(MOST_RUNS)//' runs')
            return
         end if
         plan%n_runs = plan%n_runs*size(variations(i)%texts, kind=ip)
      end do
      call combine(variations, plan)
   end subroutine plan_sweep

   !> Takes NAME=v1,v2,... apart.
   subroutine read_variation(text, variation, status)
      character(len=*), intent(in) :: text
      type(variation_t), intent(out) :: variation
      type(status_t), intent(out) :: status
      integer :: i, j, equals

      equals = index(text, '=')
      if (index(text, ':') > 0) then
         call complain(text, 'a sweep takes values with commas between them, NAME=v1,v2,...; a range a:b is for atrito limit', &
                       status)
         return
      end if
      variation%name = trim(adjustl(text(:max(equals - 1, 0))))
      variation%texts = split_at_commas(text(equals + 1:))
      allocate (variation%values(size(variation%texts)))
      do i = 1, size(variation%texts)
         call read_value(text, variation%name, variation%texts(i)%s, variation%values(i), status)
         if (.not. is_ok(status)) return
         do j = 1, i - 1
            if (variation%values(j) /= variation%values(i)) cycle
            call complain(text, variation%texts(i)%s//' is given twice', status)
            return
         end do
      end do
   end subroutine read_variation

   subroutine check_name(name, text, names, settings, status)
      character(len=*), intent(in) :: name, text
      type(string_t), intent(in) :: names(:), settings(:)
      type(status_t), intent(inout) :: status
      integer :: i

      do i = 1, size(names)
         if (same_name(names(i)%s, name)) call complain(text, name//' varies already', status)
      end do
      do i = 1, size(settings)
         if (.not. same_name(trim(adjustl(settings(i)%s(:index(settings(i)%s, '=') - 1))), name)) cycle
         call complain(text, name//' is given by --set '//settings(i)%s, status)
      end do
   end subroutine check_name

   !> The parts between commas; those within parentheses belong to a function.
   pure function split_at_commas(text) result(parts)
      character(len=*), intent(in) :: text
      type(string_t), allocatable :: parts(:)
      integer :: i, first, depth

      allocate (parts(0))
      first = 1
      depth = 0
      do i = 1, len(text)
         if (text(i:i) == '(') depth = depth + 1
         if (text(i:i) == ')') depth = depth - 1
         if (text(i:i) /= ',' .or. depth > 0) cycle
         call append_string(parts, trim(adjustl(text(first:i - 1))))
         first = i + 1
      end do
      call append_string(parts, trim(adjustl(text(first:))))
   end function split_at_commas

   pure subroutine combine(variations, plan)
      type(variation_t), intent(in) :: variations(:)
      type(sweep_plan_t), intent(inout) :: plan
      integer(ip) :: i, run, rest, place, n

      allocate (plan%texts(size(variations), plan%n_runs), plan%values(size(variations), plan%n_runs))
      allocate (plan%labels(plan%n_runs), plan%folders(plan%n_runs))
      do run = 1, plan%n_runs
         rest = run - 1
         do i = size(variations, kind=ip), 1, -1
            n = size(variations(i)%texts, kind=ip)
            place = mod(rest, n) + 1
            rest = rest/n
            plan%texts(i, run)%s = variations(i)%texts(place)%s
            plan%values(i, run) = variations(i)%values(place)
         end do
         call name_run(plan, run)
      end do
   end subroutine combine

   pure subroutine name_run(plan, run)
      type(sweep_plan_t), intent(inout) :: plan
      integer(ip), intent(in) :: run
      character(len=:), allocatable :: label, folder
      integer(ip) :: i

      label = ''
      folder = ''
      do i = 1, size(plan%names, kind=ip)
         if (i > 1) label = label//', '
         if (i > 1) folder = folder//','
         label = label//plan%names(i)%s//'='//plan%texts(i, run)%s
         folder = folder//plan%names(i)%s//'_'//plain(plan%texts(i, run)%s)
      end do
      do i = 1, run - 1
         if (plan%folders(i)%s /= folder) cycle       ! 1/3 and 1*3 read alike
         folder = folder//'-'//to_text(run)
         exit
      end do
      call move_alloc(label, plan%labels(run)%s)
      call move_alloc(folder, plan%folders(run)%s)
   end subroutine name_run

   !> A value as part of the name of a folder: letters, digits, point and signs stay.
   pure function plain(text) result(name)
      character(len=*), intent(in) :: text
      character(len=len(text)) :: name
      integer :: i
      character(len=*), parameter :: HARMLESS = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.+-'

      name = text
      do i = 1, len(text)
         if (scan(text(i:i), HARMLESS) == 0) name(i:i) = '_'
      end do
   end function plain

   !> Takes NAME=a:b apart. status: STATUS_USAGE for anything else, a that is not below b, or a name that --set gives as well.
   subroutine read_range(text, settings, name, ends, status)
      character(len=*), intent(in) :: text             !< 'NAME=a:b'
      type(string_t), intent(in) :: settings(:)        !< 'NAME=VALUE' of --set
      character(len=:), allocatable, intent(out) :: name !< of the parameter
      real(wp), intent(out) :: ends(2)                 !< ascending
      type(status_t), intent(out) :: status            !< STATUS_OK or STATUS_USAGE
      integer :: equals, colon

      ends = 0.0_wp
      equals = index(text, '=')
      colon = index(text, ':')
      name = trim(adjustl(text(:max(equals - 1, 0))))
      if (colon < equals + 1) then
         call complain(text, 'NAME=a:b is expected, the limit being between a and b', status)
         return
      end if
      call read_value(text, name, text(equals + 1:colon - 1), ends(1), status)
      if (is_ok(status)) call read_value(text, name, text(colon + 1:), ends(2), status)
      if (is_ok(status) .and. ends(1) >= ends(2)) call complain(text, 'the first value is not below the second one', status)
      if (is_ok(status)) call check_name(name, text, [string_t ::], settings, status)
   end subroutine read_range

   subroutine read_value(text, name, expression, x, status)
      character(len=*), intent(in) :: text, name, expression
      real(wp), intent(out) :: x
      type(status_t), intent(out) :: status
      type(settings_t) :: setting
      type(string_t) :: texts(1)

      x = 0.0_wp
      texts(1)%s = name//'='//trim(adjustl(expression))
      call read_settings(texts, setting, status)
      if (is_ok(status)) then
         x = setting%values(1)
      else
         call complain(text, status%text, status)
      end if
   end subroutine read_value

   subroutine complain(text, what, status)
      character(len=*), intent(in) :: text, what
      type(status_t), intent(inout) :: status
      character(len=:), allocatable :: copy

      copy = what                                      ! it may be the text of this status
      call set_status(status, STATUS_USAGE, '--vary '//text//': '//copy)
   end subroutine complain

end module atrito_sweep_plan
