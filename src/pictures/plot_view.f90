!> What a user asks of the pictures of bodies, `--plot-scale`, `--plot-box` and `--plot-labels`.
module atrito_plot_view
   use atrito_kinds, only: wp
   use atrito_messages, only: add_warning
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_plot_text, only: range_t, padded
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: plot_view_t, shown_window, shows_none, warn_of_box, read_box

   !> What is asked of the pictures of bodies.
   type :: plot_view_t
      real(wp), allocatable :: scale                !< of the displacements, not negative; not allocated: by their size
      logical :: labels = .false.                   !< numbers of nodes and elements, names of sets and surfaces
      real(wp), allocatable :: box(:)               !< (4) x1, y1, x2, y2 of what is shown, x1 < x2, y1 < y2 [L]; not allocated: all
   end type plot_view_t

contains

   !> What a picture shows: the box that is asked for, else all with some room round it.
   pure function shown_window(view, window) result(shown)
      type(plot_view_t), intent(in) :: view         !< its box is read
      type(range_t), intent(in) :: window(2)        !< of all that is drawn [L]
      type(range_t) :: shown(2)

      shown = [padded(window(1)), padded(window(2))]
      if (allocated(view%box)) shown = [range_t(view%box(1), view%box(3)), range_t(view%box(2), view%box(4))]
   end function shown_window

   !> Whether the box that is asked for lies beside all that is drawn.
   pure logical function shows_none(view, window)
      type(plot_view_t), intent(in) :: view         !< its box is read
      type(range_t), intent(in) :: window(2)        !< of all that is drawn [L]

      shows_none = .false.
      if (allocated(view%box)) shows_none = any(view%box(1:2) > window%high .or. view%box(3:4) < window%low)
   end function shows_none

   !> A box without bodies is hardly meant.
   subroutine warn_of_box(view, window)
      type(plot_view_t), intent(in) :: view         !< its box is read
      type(range_t), intent(in) :: window(2)        !< of all that is drawn [L]

      if (.not. allocated(view%box)) return
      call add_warning('W-PLOT', '--plot-box shows no body; what there is lies in x = '//to_text(window(1)%low)//' to '// &
                       to_text(window(1)%high)//', y = '//to_text(window(2)%low)//' to '//to_text(window(2)%high))
   end subroutine warn_of_box

   !> Reads a box from the text x1,y1,x2,y2: two corners of it that lie across from each other.
   pure subroutine read_box(text, box, ok)
      character(len=*), intent(in) :: text          !< of the option
      real(wp), allocatable, intent(out) :: box(:)  !< (4), in order; not allocated where it is none
      logical, intent(out) :: ok                    !< four finite numbers, and an area
      real(wp) :: corner(4)
      integer :: i, first, comma, outcome

      ok = .true.
      first = 1
      do i = 1, 4
         comma = index(text(first:), ',')
         ok = ok .and. (comma > 0 .eqv. i < 4)
         if (.not. ok) return
         if (comma == 0) comma = len(text) - first + 2
         call read_real(trim(adjustl(text(first:first + comma - 2))), corner(i), outcome)
         ok = outcome == NUMBER_OK
         first = first + comma
      end do
      ok = ok .and. abs(corner(3) - corner(1)) > 0.0_wp .and. abs(corner(4) - corner(2)) > 0.0_wp
      if (ok) box = [min(corner(1:2), corner(3:4)), max(corner(1:2), corner(3:4))]
   end subroutine read_box

end module atrito_plot_view
