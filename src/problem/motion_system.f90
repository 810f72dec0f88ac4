!> The rows of the rigid motions from bodies, points and loads: what atrito_certificate judges.
module atrito_motion_system
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_motion_rows, only: motion_rows_t
   use atrito_row_entries, only: motions_of_row, first_motions, work_on_motion
   implicit none (type, external)
   private
   public :: build_motion_rows

   integer(ip), parameter :: MOST_MODES = 3_ip   !< of a body

contains

   !> G of all unknown forces by rows, and h = Z'f with the size of its terms.
   pure subroutine build_motion_rows(fem, rows, line, f, motions)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: f(:, :)                !< (2, n_nodes) applied forces [F]
      type(motion_rows_t), intent(out) :: motions
      integer(ip) :: first_motion(fem%bodies%n + 1), b, i, n

      first_motion = first_motions(fem%bodies)
      motions%k = first_motion(fem%bodies%n + 1) - 1
      allocate (motions%body(motions%k), motions%work(motions%k), motions%work_size(motions%k))
      do b = 1, fem%bodies%n
         do i = first_motion(b), first_motion(b + 1) - 1
            motions%body(i) = b
            call work_on_motion(fem, fem%bodies%list(b), i - first_motion(b) + 1_ip, f, motions%work(i), motions%work_size(i))
         end do
      end do
      motions%m = size(line%point, kind=ip)
      n = 0
      do i = 1, motions%m
         n = n + MOST_MODES*max(2_ip, min(fem%bodies%n, rows%first(line%point(i) + 1) - rows%first(line%point(i))))
      end do
      allocate (motions%first(motions%m + 1), motions%motion(n), motions%value(n))
      motions%first(1) = 1
      do i = 1, motions%m
         associate (first => motions%first(i))
            call motions_of_row(fem, rows, line, i, first_motion, n, motions%motion(first:), motions%value(first:))
            motions%first(i + 1) = first + n
         end associate
      end do
      n = motions%first(motions%m + 1) - 1
      motions%motion = motions%motion(:n)
      motions%value = motions%value(:n)
   end subroutine build_motion_rows

end module atrito_motion_system
