!> Loads on a system that the ranks have as fronts (atrito_shared_fronts): up the tree, and down again.
!>
!> Right-hand sides and solutions are on rank 0, which hands out what acts on the pivots of each rank and gets their solution back.
!> All ranks call every procedure in the same order.
module atrito_shared_loads
   use atrito_front_plan, only: front_plan_t
   use atrito_kinds, only: ip, wp
   use atrito_lapack, only: dgemm, dtrsm
   use atrito_mpi, only: own_rank, rank_count, receive_parcel, send_parcel
   use atrito_parcel, only: parcel_t, put, take
   use atrito_shared_fronts, only: shared_fronts_t
   implicit none (type, external)
   private
   public :: solve_load

contains

   !> Solves K x = f.
   subroutine solve_load(fronts, loads, x)
      type(shared_fronts_t), intent(inout) :: fronts
      integer(ip), intent(in) :: loads           !< the same on all ranks
      real(wp), intent(inout) :: x(:, :)         !< (n, loads) on rank 0: f; on return x. Other ranks: of any size

      call hand_out(fronts, loads, x)
      call go_up(fronts)
      call go_down(fronts)
      call collect(fronts, x)
      call drop_loads(fronts)
   end subroutine solve_load

   !> Each rank gets what acts on its pivots.
   subroutine hand_out(fronts, loads, f)
      type(shared_fronts_t), intent(inout) :: fronts
      integer(ip), intent(in) :: loads
      real(wp), intent(in) :: f(:, :)
      type(parcel_t) :: parcel, empty
      real(wp), allocatable :: columns(:, :)
      integer(ip) :: i, rank, first

      if (own_rank() == 0) then
         do rank = 1, rank_count() - 1
            parcel = empty
            call put(parcel, f(fronts%plan%unknown(pivots_of(fronts%plan, rank)), :))
            call send_parcel(parcel, rank)
         end do
         columns = f(fronts%plan%unknown(pivots_of(fronts%plan, 0_ip)), :)
      else
         call receive_parcel(parcel, 0_ip)
         call take(parcel, columns)
      end if
      first = 1
      do i = 1, size(fronts%held, kind=ip)
         associate (front => fronts%plan%front(i))
            if (front%holder /= own_rank()) cycle
            allocate (fronts%held(i)%x(size(front%position), loads), source=0.0_wp)
            fronts%held(i)%x(:front%n_pivots, :) = columns(first:first + front%n_pivots - 1, :)
            first = first + front%n_pivots
         end associate
      end do
   end subroutine hand_out

   !> Positions that a rank eliminates, front by front.
   pure function pivots_of(plan, rank) result(position)
      type(front_plan_t), intent(in) :: plan
      integer(ip), intent(in) :: rank
      integer(ip), allocatable :: position(:)
      integer(ip) :: f

      allocate (position(0))
      do f = 1, size(plan%front, kind=ip)
         if (plan%front(f)%holder == rank) position = [position, plan%front(f)%position(:plan%front(f)%n_pivots)]
      end do
   end function pivots_of

   !> y_p = L_pp^-1 f_p, and -L_bp y_p for the front above.
   subroutine go_up(fronts)
      type(shared_fronts_t), intent(inout) :: fronts
      type(parcel_t) :: parcel, empty
      integer(ip) :: f

      do f = 1, size(fronts%held, kind=ip)
         associate (front => fronts%plan%front(f), held => fronts%held(f))
            if (front%holder /= own_rank()) cycle
            call add_loads_of_children(fronts, f)
            associate (order => size(held%x, 1, kind=ip), loads => size(held%x, 2, kind=ip), p => front%n_pivots)
               if (p > 0 .and. loads > 0) then
                  call dtrsm('L', 'L', 'N', 'N', p, loads, 1.0_wp, held%columns, order, held%x, order)
                  if (p < order) call dgemm('N', 'N', order - p, loads, p, -1.0_wp, held%columns(p + 1, 1), order, held%x, order, &
                                            1.0_wp, held%x(p + 1, 1), order)
               end if
            end associate
            if (front%parent == 0) cycle
            if (fronts%plan%front(front%parent)%holder == own_rank()) cycle
            parcel = empty
            call put(parcel, held%x(front%n_pivots + 1:, :))
            call send_parcel(parcel, fronts%plan%front(front%parent)%holder)
         end associate
      end do
   end subroutine go_up

   subroutine add_loads_of_children(fronts, f)
      type(shared_fronts_t), intent(inout) :: fronts
      integer(ip), intent(in) :: f
      type(parcel_t) :: parcel
      real(wp), allocatable :: columns(:, :)
      integer(ip), allocatable :: at(:)
      integer(ip) :: i, c

      do i = 1, 2
         c = fronts%plan%front(f)%child(i)
         if (c == 0) cycle
         associate (child => fronts%plan%front(c))
            if (child%holder /= own_rank()) then
               call receive_parcel(parcel, child%holder)
               call take(parcel, columns)
            else
               columns = fronts%held(c)%x(child%n_pivots + 1:, :)
            end if
            at = places_of_child(fronts%plan, f, c)
            fronts%held(f)%x(at, :) = fronts%held(f)%x(at, :) + columns
         end associate
      end do
   end subroutine add_loads_of_children

   !> Where what a front leaves stands in the one above.
   pure function places_of_child(plan, f, child) result(at)
      type(front_plan_t), intent(in) :: plan
      integer(ip), intent(in) :: f, child
      integer(ip), allocatable :: at(:)
      integer(ip) :: place(plan%n), i

      place(plan%front(f)%position) = [(i, i=1, size(plan%front(f)%position, kind=ip))]
      at = place(plan%front(child)%position(plan%front(child)%n_pivots + 1:))
   end function places_of_child

   !> x_p = L_pp^-T (y_p - L_bp' x_b), with x_b from the front above.
   subroutine go_down(fronts)
      type(shared_fronts_t), intent(inout) :: fronts
      integer(ip) :: f

      do f = size(fronts%held, kind=ip), 1, -1
         associate (front => fronts%plan%front(f), held => fronts%held(f))
            if (front%holder /= own_rank()) cycle
            call take_from_above(fronts, f)
            associate (order => size(held%x, 1, kind=ip), loads => size(held%x, 2, kind=ip), p => front%n_pivots)
               if (p > 0 .and. loads > 0) then
                  if (p < order) call dgemm('T', 'N', p, loads, order - p, -1.0_wp, held%columns(p + 1, 1), order, &
                                            held%x(p + 1, 1), order, 1.0_wp, held%x, order)
                  call dtrsm('L', 'L', 'T', 'N', p, loads, 1.0_wp, held%columns, order, held%x, order)
               end if
            end associate
            call give_below(fronts, f)
         end associate
      end do
   end subroutine go_down

   subroutine take_from_above(fronts, f)
      type(shared_fronts_t), intent(inout) :: fronts
      integer(ip), intent(in) :: f
      type(parcel_t) :: parcel
      real(wp), allocatable :: columns(:, :)

      associate (front => fronts%plan%front(f))
         if (front%parent == 0) return
         if (fronts%plan%front(front%parent)%holder /= own_rank()) then
            call receive_parcel(parcel, fronts%plan%front(front%parent)%holder)
            call take(parcel, columns)
         else
            columns = fronts%held(front%parent)%x(places_of_child(fronts%plan, front%parent, f), :)
         end if
         fronts%held(f)%x(front%n_pivots + 1:, :) = columns
      end associate
   end subroutine take_from_above

   subroutine give_below(fronts, f)
      type(shared_fronts_t), intent(in) :: fronts
      integer(ip), intent(in) :: f
      type(parcel_t) :: parcel, empty
      integer(ip) :: i, c

      do i = 2, 1, -1                            ! as they are taken
         c = fronts%plan%front(f)%child(i)
         if (c == 0) cycle
         if (fronts%plan%front(c)%holder == own_rank()) cycle
         parcel = empty
         call put(parcel, fronts%held(f)%x(places_of_child(fronts%plan, f, c), :))
         call send_parcel(parcel, fronts%plan%front(c)%holder)
      end do
   end subroutine give_below

   !> The solutions come to rank 0.
   subroutine collect(fronts, x)
      type(shared_fronts_t), intent(in) :: fronts
      real(wp), intent(inout) :: x(:, :)
      type(parcel_t) :: parcel
      real(wp), allocatable :: columns(:, :)
      integer(ip) :: rank

      if (own_rank() > 0) then
         call put(parcel, own_pivots(fronts))
         call send_parcel(parcel, 0_ip)
         return
      end if
      x(fronts%plan%unknown(pivots_of(fronts%plan, 0_ip)), :) = own_pivots(fronts)
      do rank = 1, rank_count() - 1
         call receive_parcel(parcel, rank)
         call take(parcel, columns)
         x(fronts%plan%unknown(pivots_of(fronts%plan, rank)), :) = columns
      end do
   end subroutine collect

   !> What stands at the pivots of this rank, front by front.
   pure function own_pivots(fronts) result(columns)
      type(shared_fronts_t), intent(in) :: fronts
      real(wp), allocatable :: columns(:, :)
      integer(ip) :: f, n, loads

      n = 0
      loads = 0
      do f = 1, size(fronts%held, kind=ip)
         if (.not. allocated(fronts%held(f)%x)) cycle
         n = n + fronts%plan%front(f)%n_pivots
         loads = size(fronts%held(f)%x, 2, kind=ip)
      end do
      allocate (columns(n, loads))
      n = 0
      do f = 1, size(fronts%held, kind=ip)
         if (.not. allocated(fronts%held(f)%x)) cycle
         associate (p => fronts%plan%front(f)%n_pivots)
            columns(n + 1:n + p, :) = fronts%held(f)%x(:p, :)
            n = n + p
         end associate
      end do
   end function own_pivots

   subroutine drop_loads(fronts)
      type(shared_fronts_t), intent(inout) :: fronts
      integer(ip) :: f

      do f = 1, size(fronts%held, kind=ip)
         if (allocated(fronts%held(f)%x)) deallocate (fronts%held(f)%x)
      end do
   end subroutine drop_loads

end module atrito_shared_loads
