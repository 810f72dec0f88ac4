!> The contact line as the certificates of uniqueness see it: A, the bounds of friction, and the forces that bodies can take.
!>
!> In forces q = (q_n, q_t) the line is r = g0 - C q + G a with G' q = h, and at each point, with delta/w on the normal diagonal,
!>
!>     A = C + diag(delta/w, 0),     q_n >= 0, r_n <= 0, q_n r_n = 0,     |q_t| <= b = nu W q_n.
!>
!> nu is the largest coefficient, W = diag(w nu_j/nu) S_rho diag(1/w) takes normal forces to friction bounds, each row with the
!> share of its own pair. Of two solutions the loads are the same, and so the difference dq lies in the kernel of G'. Bodies that
!> can move along the contact are out of reach of the certificates; where G has no tangential rows, k reflections (Householder) turn
!> its columns onto the first k normal directions, and what is left without these is the kernel:  A <- Y' A Y,  W <- W Y. No basis
!> is stored, and without free bodies nothing is done. W Y is full, so W is kept as it is, and products with it are reflected.
!>
!> What the certificates do again and again costs an eighth with half of the forces taken out: with A_tt = L L', X = L^-1 A_tn and
!> S = A_nn - X'X (X'X is kept), forces (z_n, z_t) are told by z_n and v = L' z_t + X z_n, and
!>
!>     (A z)_n = S z_n + X'v,      (A z)_t = L v.
module atrito_friction_form
   use atrito_bound_qp, only: bound_qp_t
   use atrito_contact_line, only: contact_line_t
   use atrito_dense, only: add_product, add_square, multiply_vector
   use atrito_dense_blocks, only: divide_by_triangle, factor_in_blocks
   use atrito_kinds, only: ip, wp
   use atrito_line_certificate, only: friction_form_t
   use atrito_sparse_rows, only: sparse_rows_t
   implicit none (type, external)
   private
   public :: friction_form_t, build_form, bounds_of, multiply_bounds, who_holds_along

   real(wp), parameter :: NONE_ALONG = 1.0e-12_wp  !< of the largest entry of a motion: it does not go along the contact
   integer, parameter :: SLOW = 6                  !< times that an operation takes of those that are done one by one

contains

   !> Builds A and W on the forces that leave all bodies in balance. why_not: '', or why there is no such form.
   !>
   !>     1. motions along the contact: none may be there, or friction alone holds a body, and the certificates do not apply
   !>     2. A = C + diag(delta/w, 0), of all forces
   !>     3. W, what a normal force adds to the bounds of friction (take_bounds)
   !>     4. forces that bodies cannot take, as they would move them, out of A and W (take_kernel)
   !>     5. the tangential forces out of A: L, X and X'X (take_tangential)
   !>
   !> m^2 operations for each motion in 4, some m^3/3 in 5; all certificates of the line then use the same form.
   subroutine build_form(problem, line, form, why_not)
      type(bound_qp_t), intent(in) :: problem     !< C and G
      type(contact_line_t), intent(in) :: line    !< points, laws, average S_rho
      type(friction_form_t), intent(out) :: form
      character(len=:), allocatable, intent(out) :: why_not
      real(wp) :: g(problem%n_normal, problem%k)
      integer(ip) :: i, k

      associate (n => problem%n_normal, m => problem%m)
         form%nu = maxval([0.0_wp, line%law(line%point(n + 1:))%nu])
         why_not = who_holds_along([(maxval([0.0_wp, abs(problem%g(n + 1:, k))]), k=1, problem%k)], &
                                   [(maxval(abs(problem%g(:, k))), k=1, problem%k)], line)
         if (len(why_not) > 0) return
         form%n = n
         form%a = problem%c
         do i = 1, n
            form%a(i, i) = form%a(i, i) + line%delta(line%point(i))/line%weight(line%point(i))
         end do
         form%w = bounds_of(line, line%point(n + 1:), n)
         g = problem%g(:n, :)
      end associate
      call take_kernel(g, form)
      call take_tangential(form)
   end subroutine build_form

   !> '', or what holds a body along the contact where its motions go that way: nothing is certified then.
   pure function who_holds_along(along, motion, line) result(text)
      real(wp), intent(in) :: along(:), motion(:) !< the largest of each motion along a tangent, in any direction
      type(contact_line_t), intent(in) :: line
      character(len=:), allocatable :: text

      text = ''
      if (.not. any(along > NONE_ALONG*motion)) return
      text = 'a body is held along the contact by friction alone'
      if (line%n_bilateral > 0) text = 'friction and joints hold a body along the contact'
   end function who_holds_along

   !> W of the points of the tangential forces.
   pure function bounds_of(line, point, n_normal) result(w)
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: point(:)
      integer(ip), intent(in) :: n_normal         !< its columns, before motions are left out
      type(sparse_rows_t) :: w
      integer(ip) :: i, k, n
      real(wp) :: nu

      nu = maxval([0.0_wp, line%law(point)%nu])
      w%n = size(point, kind=ip)
      w%n_columns = n_normal
      n = sum(line%average%first(point + 1) - line%average%first(point))
      allocate (w%first(w%n + 1), w%column(n), w%value(n))
      n = 0
      do i = 1, w%n
         w%first(i) = n + 1
         associate (j => point(i))
            do k = line%average%first(j), line%average%first(j + 1) - 1
               associate (other => line%average%column(k))
                  if (line%normal(other) == 0) cycle          ! its pressure is known: the same in all solutions
                  n = n + 1
                  w%column(n) = line%normal(other)
                  w%value(n) = line%law(j)%nu/nu*line%weight(j)*line%average%value(k)/line%weight(other)
               end associate
            end do
         end associate
      end do
      w%first(w%n + 1) = n + 1
      w%column = w%column(:n)
      w%value = w%value(:n)
   end function bounds_of

   !> product = left diag(share) W Y
   subroutine multiply_bounds(form, left, share, product)
      type(friction_form_t), intent(in) :: form
      real(wp), intent(in) :: left(:, :)                    !< (any, m - n)
      real(wp), intent(in) :: share(:)                      !< (m - n)
      real(wp), allocatable, intent(out) :: product(:, :)   !< (any, n + motions): its first n columns
      real(wp), allocatable :: bounds(:, :)
      real(wp) :: y(size(left, 1))
      integer(ip) :: i, j, k, left_out

      allocate (product(size(left, 1), form%w%n_columns), source=0.0_wp)
      if (SLOW*(form%w%first(form%w%n + 1) - 1) > form%w%n*form%w%n_columns) then
         allocate (bounds(form%w%n_columns, form%w%n), source=0.0_wp)
         do j = 1, form%w%n
            do k = form%w%first(j), form%w%first(j + 1) - 1
               bounds(form%w%column(k), j) = share(j)*form%w%value(k)
            end do
         end do
         call add_product(left, bounds, product)
      else
         do j = 1, form%w%n
            if (.not. abs(share(j)) > 0.0_wp) cycle
            do k = form%w%first(j), form%w%first(j + 1) - 1
               call add_column(share(j)*form%w%value(k), left(:, j), product(:, form%w%column(k)))
            end do
         end do
      end if
      do k = 1, size(form%reflection, 2, kind=ip)
         left_out = merge(k, 0_ip, k == size(form%reflection, 2))
         associate (v => form%reflection(:, k))
            call multiply_vector(product, v, y)
            do i = k + 1, size(v, kind=ip)
               if (left_out > 0) product(:, i - left_out) = product(:, i)
               call add_column(-2*v(i), y, product(:, i - left_out))
            end do
         end associate
      end do
   end subroutine multiply_bounds

   !> y <- y + factor x
   pure subroutine add_column(factor, x, y)
      real(wp), intent(in) :: factor
      real(wp), intent(in), contiguous :: x(:)
      real(wp), intent(inout), contiguous :: y(:)

      y = y + factor*x
   end subroutine add_column

   !> Takes the tangential forces out of A.
   subroutine take_tangential(form)
      type(friction_form_t), intent(inout) :: form
      integer(ip) :: j, failed

      associate (n => form%n)
         form%l = form%a(n + 1:, n + 1:)
         call factor_in_blocks(form%l, failed)
         form%is_definite = failed == 0
         if (.not. form%is_definite) return
         do j = 2, size(form%l, 1, kind=ip)
            form%l(:j - 1, j) = 0.0_wp
         end do
         form%x = form%a(n + 1:, :n)
         call divide_by_triangle(form%l, form%x)
         allocate (form%xx(n, n), source=0.0_wp)
         call add_square(form%x, .true., 1.0_wp, form%xx)
      end associate
   end subroutine take_tangential

   !> Leaves the motions' directions out of A, and keeps the reflections for W.
   !>
   !> The reflection 1 - 2 v v' that takes a column g of G, from row i on, to a multiple of the unit vector i has v along g + |g|
   !> e_i. With x = A v and y = 2 (x - (v'x) v) it makes of A the matrix A - v y' - y v'.
   pure subroutine take_kernel(g, form)
      real(wp), intent(inout) :: g(:, :)          !< (n, k) normal rows of G; reflected
      type(friction_form_t), intent(inout) :: form
      real(wp) :: v(size(g, 1)), y(size(form%a, 1)), size_before
      integer(ip) :: first, j, k, n

      n = form%n
      allocate (form%reflection(n, size(g, 2)))
      first = 1
      do k = 1, size(g, 2, kind=ip)
         size_before = norm2(g(:, k))
         v = 0.0_wp
         v(first:) = g(first:, k)
         if (.not. norm2(v) > NONE_ALONG*size_before) cycle   ! what others hold already, or nothing at all
         v(first) = v(first) + sign(norm2(v), v(first))
         v = v/norm2(v)
         do j = k, size(g, 2, kind=ip)
            g(:, j) = g(:, j) - 2*v*dot_product(v, g(:, j))
         end do
         form%reflection(:, first) = v
         y = matmul(form%a(:, :n), v)
         y(:n) = y(:n) - dot_product(v, y(:n))*v
         y = 2*y
         do j = 1, size(y, kind=ip)
            form%a(:n, j) = form%a(:n, j) - v*y(j)
            if (j <= n) form%a(:, j) = form%a(:, j) - y*v(j)
         end do
         first = first + 1
      end do
      form%reflection = form%reflection(:, :first - 1)
      form%n = n - (first - 1)
      if (first > 1) form%a = form%a(first:, first:)
   end subroutine take_kernel

end module atrito_friction_form
