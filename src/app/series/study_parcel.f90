!> What a rank found in a run of a study, on its way to rank 0. A component that a row gets is added here, too.
module atrito_study_parcel
   use atrito_kinds, only: ip, wp
   use atrito_parcel, only: parcel_t, put, take
   use atrito_study_errors, only: study_row_t
   use atrito_timers, only: phase_time_t
   implicit none (type, external)
   private
   public :: put_row, take_row

contains

   !> A row of study.tab, for the first rank.
   subroutine put_row(row, parcel)
      type(study_row_t), intent(in) :: row           !< with values and phases
      type(parcel_t), intent(inout) :: parcel
      integer :: i

      call put(parcel, [row%code, row%n_dofs, row%n_points, row%degree])
      call put(parcel, merge(1_ip, 0_ip, [row%is_written, row%is_whole, row%peak_is_end, row%has_delta, row%has_eps, &
                                          row%has_stick_slope]))
      call put(parcel, [row%h, row%peak, row%estimate, row%penetration, row%pressure])
      call put(parcel, row%values)
      call put(parcel, size(row%phases, kind=ip))
      do i = 1, size(row%phases)
         call put(parcel, trim(row%phases(i)%name))
         call put(parcel, row%phases(i)%wall)
         call put(parcel, row%phases(i)%cpu)
      end do
   end subroutine put_row

   !> Element and level stay.
   subroutine take_row(parcel, row)
      type(parcel_t), intent(inout) :: parcel
      type(study_row_t), intent(inout) :: row
      integer(ip) :: n, i

      call take_facts(parcel, row)
      call take(parcel, row%values)
      call take(parcel, n)
      if (allocated(row%phases)) deallocate (row%phases)
      allocate (row%phases(n))
      do i = 1, n
         call take_phase(parcel, row%phases(i))
      end do
   end subroutine take_row

   subroutine take_facts(parcel, row)
      type(parcel_t), intent(inout) :: parcel
      type(study_row_t), intent(inout) :: row
      integer(ip), allocatable :: numbers(:), flags(:)
      real(wp), allocatable :: amounts(:)

      call take(parcel, numbers)
      call take(parcel, flags)
      call take(parcel, amounts)
      row%code = numbers(1)
      row%n_dofs = numbers(2)
      row%n_points = numbers(3)
      row%degree = numbers(4)
      row%is_written = flags(1) == 1
      row%is_whole = flags(2) == 1
      row%peak_is_end = flags(3) == 1
      row%has_delta = flags(4) == 1
      row%has_eps = flags(5) == 1
      row%has_stick_slope = flags(6) == 1
      row%h = amounts(1)
      row%peak = amounts(2:3)
      row%estimate = amounts(4)
      row%penetration = amounts(5)
      row%pressure = amounts(6)
   end subroutine take_facts

   subroutine take_phase(parcel, phase)
      type(parcel_t), intent(inout) :: parcel
      type(phase_time_t), intent(out) :: phase
      character(len=:), allocatable :: name

      call take(parcel, name)
      phase%name = name
      call take(parcel, phase%wall)
      call take(parcel, phase%cpu)
   end subroutine take_phase

end module atrito_study_parcel
