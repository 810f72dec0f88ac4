!> The certificate in axes that turn with the scene.
!>
!> What a load is beside others on its motion must not hang on the axes of the deck: a block on a slope has a load along x and one
!> along y, and what drives it down is a small difference of both, where on a level floor it is all the load along x. So each free
!> body has axes of its own here, those of sum n n' over the normals n of its points. Its translations along them are the motions
!> that the certificate knows; what it finds is given in the motions of the bodies.
module atrito_own_axes
   use atrito_assembly, only: fem_t
   use atrito_certificate, only: certificate_t, prove_balance
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_motion_rows, only: motion_rows_t, build_motion_rows, note_digits, part_from_held
   use atrito_row_entries, only: first_motions
   implicit none (type, external)
   private
   public :: prove_in_own_axes

   real(wp), parameter :: ROUND = 1.0e-6_wp       !< difference of both sums, over them, of a body with normals of all directions

contains

   !> prove_balance of the loads f, whose answer does not hang on how the scene is turned.
   subroutine prove_in_own_axes(fem, rows, line, f, certificate, counts)
      type(fem_t), intent(inout) :: fem               !< as before; meanwhile its bodies have other motions
      type(contact_rows_t), intent(in) :: rows        !< directions and coefficients
      type(contact_line_t), intent(in) :: line        !< points, weights, laws and averages
      real(wp), intent(in) :: f(:, :)                 !< (2, n_nodes) applied forces [F]
      type(certificate_t), intent(out) :: certificate !< as of prove_balance, in the motions that the bodies have
      logical, intent(in), optional :: counts(:)      !< (line%n) points that may bear forces; left out: all
      type(motion_rows_t) :: own
      real(wp) :: axes(2, 2, fem%bodies%n), largest   ! columns are the axes
      logical :: has_own(fem%bodies%n)
      integer(ip) :: first(fem%bodies%n + 1), b

      call find_axes(fem, rows, axes, has_own)
      first = first_motions(fem%bodies)
      do b = 1, fem%bodies%n
         if (has_own(b)) fem%bodies%list(b)%modes(:2, :2) = axes(:, :, b)
      end do
      call build_motion_rows(fem, rows, line, f, own)
      call part_from_held(fem, line, own)
      call note_digits(fem, rows, line, own)
      do b = 1, fem%bodies%n
         if (.not. has_own(b)) cycle
         fem%bodies%list(b)%modes(:2, :2) = reshape([1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [2, 2])
         associate (k => first(b), nodes => fem%bodies%list(b)%nodes)
            own%work_size(k:k + 1) = sum(abs(matmul(transpose(axes(:, :, b)), f(:, nodes))), dim=2) ! along them
         end associate
      end do
      call prove_balance(own, line, certificate, counts)
      associate (v => certificate%motion)
         do b = 1, fem%bodies%n
            if (has_own(b)) v(first(b):first(b) + 1) = matmul(axes(:, :, b), v(first(b):first(b) + 1))
         end do
         largest = maxval(abs([v, 0.0_wp]))
         if (.not. largest > 0.0_wp) return
         v = v/largest
         certificate%excess = certificate%excess/largest
      end associate
   end subroutine prove_in_own_axes

   !> Axes of bodies that nothing holds, the eigenvectors of sum n n'. Where they are those of the deck, and where there are no such
   !> axes since the normals have all directions, the motions stay what they are.
   pure subroutine find_axes(fem, rows, axes, has_own)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      real(wp), intent(out) :: axes(:, :, :)          !< (2, 2, bodies), columns of length one
      logical, intent(out) :: has_own(:)              !< (bodies)
      real(wp) :: tensor(3, 0:fem%bodies%n), angle    ! xx + yy, xx - yy, 2 xy
      integer(ip) :: b, j, k

      tensor = 0.0_wp
      do j = 1, rows%n
         associate (n => rows%normal(:, j))
            do k = rows%first(j), rows%first(j + 1) - 1
               b = fem%bodies%of_node(rows%node(k))
               tensor(:, b) = tensor(:, b) + abs(rows%coefficient(k))*[sum(n**2), n(1)**2 - n(2)**2, 2*n(1)*n(2)]
            end do
         end associate
      end do
      axes = 0.0_wp
      do b = 1, fem%bodies%n
         has_own(b) = size(fem%bodies%list(b)%modes, 2) == 3 .and. .not. fem%bodies%list(b)%is_rigid &
                      .and. abs(tensor(3, b)) > epsilon(angle)*tensor(1, b) .and. norm2(tensor(2:, b)) > ROUND*tensor(1, b)
         if (.not. has_own(b)) cycle
         angle = 0.5_wp*atan2(tensor(3, b), tensor(2, b))
         axes(:, 1, b) = [cos(angle), sin(angle)]
         axes(:, 2, b) = [-sin(angle), cos(angle)]
      end do
   end subroutine find_axes

end module atrito_own_axes
