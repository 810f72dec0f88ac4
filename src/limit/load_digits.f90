!> Loads on a motion that the digits of the deck alone make.
!>
!> A roller on one node of its rim, loaded through its centre, stands: nothing but rounding of coordinates, by some units g of their
!> last digit, makes a moment about that node, which would turn it onto the next one. So where a motion v of the bodies were idle
!> but for points with small forces, the work W = h'v of the loads is compared with what the digits can make of it: of the forces on
!> a body that turns by w, of those of the points that hold, which have places as well and whose normals are known to some g over
!> their lengths l_j, and of those on loaded faces, since the ends of a face of length l_f say how much of a pressure acts and
!> whereto (|w| at a point is the larger one of its two bodies):
!>
!>    |W| <= 5 g (sum over bodies of |w| sum |f| + sum over points of |q_j| (|w| + |v_T,j|/l_j)
!>                + sum over loaded faces of |f| |v|/l_f)
!>
!> Then, and below 2.5e-3 of the forces, which is what four digits leave, it is none, and the least change of the loads takes it out
!> of them. Normals along an axis, and decks that are not rounded to digits, leave nothing in doubt.
module atrito_load_digits
   use atrito_contact_rows, only: vector_of_entry
   use atrito_dense, only: least_squares, solve_lu
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes
   use atrito_motion_rows, only: motion_rows_t, contact_digit_error, DIGIT_ERRORS, MOST_PART
   use atrito_row_entries, only: first_motions, modes_at_node
   use atrito_scene_data, only: scene_data_t, reload
   use atrito_sparse_rows, only: transposed_sizes
   implicit none (type, external)
   private
   public :: is_within_digits, rate_of_point, work_along, is_loaded, take_out

   real(wp), parameter :: ALONG_AXIS = 1.0e-12_wp   !< part of a normal

contains

   !> Whether the loads work no more on a motion than the digits make.
   logical function is_within_digits(data, rows, v, q)
      type(scene_data_t), intent(in) :: data        !< bodies, loads, normals and reach of the points
      type(motion_rows_t), intent(in) :: rows       !< G, and the work of the loads on each motion
      real(wp), intent(in) :: v(:)                  !< (k) its amplitudes
      real(wp), intent(in) :: q(:)                  !< (m) forces of the rows, 0: of those that do not hold [F]
      real(wp) :: allowed, most, sizes(rows%n_columns), turn(0:data%fem%bodies%n)
      integer(ip) :: first(data%fem%bodies%n + 1), b, i, j

      first = first_motions(data%fem%bodies)
      allowed = 0.0_wp
      turn(0) = 0.0_wp
      do b = 1, data%fem%bodies%n
         associate (body => data%fem%bodies%list(b))
            turn(b) = abs(dot_product(body%modes(3, :), v(first(b):first(b + 1) - 1)))/body%size
            if (turn(b) > 0.0_wp) allowed = allowed + turn(b)*sum(hypot(data%f(1, body%nodes), data%f(2, body%nodes)))
         end associate
      end do
      do i = 1, rows%n
         j = data%line%point(i)
         if (j > data%rows%n - data%rows%n_bilateral) cycle
         if (minval(abs(data%rows%normal(:, j))) <= ALONG_AXIS) cycle
         associate (nodes => data%rows%node(data%rows%first(j):data%rows%first(j + 1) - 1))
            allowed = allowed + abs(q(i))*maxval(turn(data%fem%bodies%of_node(nodes)))
         end associate
         allowed = allowed + abs(q(i)*rate_of_point(data, j, data%rows%tangent(:, j), v))/data%rows%reach(j)
      end do
      do i = 1, data%step%element_loads%n
         allowed = allowed + doubt_of_face(i)
      end do
      sizes = rows%work_size + transposed_sizes(rows, q)
      most = 0.0_wp
      do b = 1, data%fem%bodies%n                   ! whatever arms the forces on a body have
         associate (own => sizes(first(b):first(b + 1) - 1))
            most = most + MOST_PART*maxval([0.0_wp, own])*sum(abs(v(first(b):first(b + 1) - 1)))
         end associate
      end do
      allowed = min(DIGIT_ERRORS*contact_digit_error(data%fem%mesh%x, data%fem%mesh%digit_error, data%rows)*allowed, most)
      is_within_digits = abs(dot_product(v, rows%work)) <= allowed

   contains

      !> The forces at the ends of a loaded face times their way, over its length; 0: of other loads.
      real(wp) function doubt_of_face(i) result(doubt)
         integer(ip), intent(in) :: i                  !< load
         integer(ip), allocatable :: ends(:)
         integer(ip) :: b, k

         doubt = 0.0_wp
         associate (loads => data%step%element_loads, mesh => data%fem%mesh, n_modes => first(2:) - first(:data%fem%bodies%n))
            if (loads%face(i) == 0) return
            ends = face_nodes(mesh, loads%element(i), loads%face(i))
            b = data%fem%bodies%of_node(ends(1))
            if (b == 0) return
            do k = 1, 2
               associate (way => matmul(modes_at_node(data%fem, b, ends(k)), [v(first(b):first(b + 1) - 1), &
                                                                              spread(0.0_wp, 1, 3 - n_modes(b))]))
                  doubt = doubt + norm2(data%f(:, ends(k)))*norm2(way)/norm2(mesh%x(:, ends(2)) - mesh%x(:, ends(1)))
               end associate
            end do
         end associate
      end function doubt_of_face

   end function is_within_digits

   !> How fast the sides of point j move along a direction in a motion of the bodies, the slave's less the master's.
   pure real(wp) function rate_of_point(data, j, direction, v) result(rate)
      type(scene_data_t), intent(in) :: data        !< rows, bodies
      integer(ip), intent(in) :: j
      real(wp), intent(in) :: direction(2)          !< the normal or the tangent of the point
      real(wp), intent(in) :: v(:)                  !< (k) amplitudes of the motion
      real(wp) :: z(2, 3)
      integer(ip) :: first(data%fem%bodies%n + 1), b, k, n

      first = first_motions(data%fem%bodies)
      rate = 0.0_wp
      do k = data%rows%first(j), data%rows%first(j + 1) - 1
         b = data%fem%bodies%of_node(data%rows%node(k))
         if (b == 0) cycle
         n = first(b + 1) - first(b)
         z = modes_at_node(data%fem, b, data%rows%node(k))
         rate = rate + dot_product(vector_of_entry(data%rows, j, k, direction), matmul(z(:, :n), v(first(b):first(b + 1) - 1)))
      end do
   end function rate_of_point

   !> The work h' on the motions of the bodies that is to be taken out where the loads are to do none on the motions V: the least
   !> with V'h' = V'h that leaves bodies without loads as they are, h' = P V s, P taking the loaded bodies, V'P V s = V'h; or,
   !> where these have next to no part in the motions, the least of all, h' = V V'h.
   function work_along(rows, motions) result(work)
      type(motion_rows_t), intent(in) :: rows       !< h
      real(wp), intent(in) :: motions(:, :)         !< (k, motions) V, columns of length one, each across the others
      real(wp) :: work(size(motions, 1)), part(size(motions, 1), size(motions, 2))
      real(wp) :: s(size(motions, 2)), asked(size(motions, 2))
      real(wp), parameter :: DEPENDENT = 1.0e-10_wp, FARTHEST = 3.0_wp, SAME = 1.0e-3_wp
      logical :: loaded(rows%n_columns)
      integer(ip) :: k, rank, info

      loaded = is_loaded(rows)
      do k = 1, rows%n_columns
         part(k, :) = merge(motions(k, :), 0.0_wp, loaded(k))
      end do
      asked = matmul(rows%work, motions)
      call least_squares(matmul(transpose(part), part), asked, s, DEPENDENT, rank, info)
      work = matmul(part, s)
      if (info == 0 .and. norm2(work) <= FARTHEST*norm2(asked) .and. norm2(matmul(work, part) - asked) <= SAME*norm2(asked)) return
      work = matmul(motions, asked)
   end function work_along

   !> Of each motion, whether its body has loads.
   pure function is_loaded(rows) result(loaded)
      type(motion_rows_t), intent(in) :: rows
      logical :: loaded(rows%n_columns), of_body(max(0_ip, maxval(rows%body)))

      of_body = .false.
      of_body(pack(rows%body, rows%work_size > 0.0_wp)) = .true.
      loaded = of_body(rows%body)
   end function is_loaded

   !> Takes work h on the motions of the bodies out of the loads: of all forces with that work the least, Z (Z'Z)^-1 h. The loads of
   !> the increment are no sum of the bases of its step any more; the next increment has its own.
   !>
   !> Z'(f - Z a) = h_old - h gives Z'Z a = h, a system of order three at the most for each body. Among all changes of the nodal
   !> forces with this work the one along Z is the shortest, sum |df|^2 least, so no node is loaded more than it must.
   subroutine take_out(data, work)
      type(scene_data_t), intent(inout) :: data     !< of the increment; its loads change
      real(wp), intent(in) :: work(:)               !< (k) [F]
      real(wp) :: z(2, 3), metric(3, 3), force(3)
      real(wp), allocatable :: small(:, :), own(:)  ! of as many motions as the body has
      integer(ip) :: first(data%fem%bodies%n + 1), b, i, n, info

      if (.not. allocated(data%given)) data%given = data%f
      first = first_motions(data%fem%bodies)
      do b = 1, data%fem%bodies%n
         n = first(b + 1) - first(b)
         if (n == 0) cycle
         if (.not. any(abs(work(first(b):first(b + 1) - 1)) > 0.0_wp)) cycle
         associate (nodes => data%fem%bodies%list(b)%nodes)
            metric = 0.0_wp
            do i = 1, size(nodes, kind=ip)
               z = modes_at_node(data%fem, b, nodes(i))
               metric = metric + matmul(transpose(z), z)
            end do
            force = 0.0_wp
            small = metric(:n, :n)
            own = work(first(b):first(b + 1) - 1)
            call solve_lu(small, own, info)
            force(:n) = own
            do i = 1, size(nodes, kind=ip)
               data%f(:, nodes(i)) = data%f(:, nodes(i)) - matmul(modes_at_node(data%fem, b, nodes(i)), force)
            end do
         end associate
      end do
      data%asks_for_bases = data%asks_for_bases .or. allocated(data%bases)
      if (allocated(data%bases)) deallocate (data%bases)
      call reload(data)
   end subroutine take_out

end module atrito_load_digits
