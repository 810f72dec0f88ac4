!> Arrows of the loads on faces, with the line that joins their free ends: of several loads on a face their sum.
module atrito_face_symbols
   use atrito_element_table, only: MOST_SIDES
   use atrito_face_geometry, only: outward_normal
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes
   use atrito_model, only: is_on_volume, LOAD_TRACTION, LOAD_HYDROSTATIC
   use atrito_shape_functions, only: face_shape_values
   use atrito_symbols, only: symbols_t, begin_block, end_block, put_path, put_arrow, thinned, load_factor, ARROW_LOOKS, SLANT
   implicit none (type, external)
   private
   public :: put_face_loads

   !> Lengths in pixels.
   real(wp), parameter :: LONGEST = 40.0_wp, LEAST = 9.0_wp, SPACING = 20.0_wp, PIECE = 8.0_wp, OFF = 5.0_wp, HALF_SHEAR = 13.0_wp
   integer(ip), parameter :: MOST_PIECES = 40
   real(wp), parameter :: AXIS_OF_SHEAR = 0.2_wp    !< a load whose normal part is less than this is drawn along the face
   character(len=*), parameter :: LOOKS = ' lt 1 lw 1 lc rgb "#C8102E"', ARROWS = ARROW_LOOKS//' lw 1.2 lc rgb "#C8102E"'

   !> The faces with loads.
   type :: loaded_faces_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: load(:)           !< (n) the last load of each
      integer(ip), allocatable :: next(:)           !< (loads) the one before it on the same face; 0: none
      real(wp) :: largest = 0.0_wp                  !< traction on them [F/L^2]
   end type loaded_faces_t

   !> A place of a loaded face, and what is drawn there.
   type :: spot_t
      real(wp) :: place(2) = 0.0_wp, u(2) = 0.0_wp  !< [L]
      real(wp) :: from(2) = 0.0_wp, arrow(2) = 0.0_wp   !< [L]
      logical :: is_shear = .false.                 !< the load goes along the face
   end type spot_t

contains

   !> Puts the arrows of a step, as loads are at its end.
   subroutine put_face_loads(legend, symbols)
      character(len=*), intent(in) :: legend        !< of the arrows
      type(symbols_t), intent(inout) :: symbols
      type(loaded_faces_t) :: faces
      real(wp) :: traction(2)
      integer(ip) :: i, k

      call list_faces(symbols, faces)
      do i = 1, faces%n
         do k = -1, 1
            traction = traction_on(symbols, faces, i, real(k, wp))
            faces%largest = max(faces%largest, hypot(traction(1), traction(2)))
         end do
      end do
      if (.not. faces%largest > 0.0_wp) return
      call put_lines_of_ends(faces, symbols)
      call put_arrows(faces, legend, symbols)
   end subroutine put_face_loads

   !> Each face once, with its loads one behind the other.
   subroutine list_faces(symbols, faces)
      type(symbols_t), intent(in) :: symbols
      type(loaded_faces_t), intent(out) :: faces
      type(id_map_t) :: known_faces
      integer(ip) :: i, key, at
      logical :: known

      associate (loads => symbols%model%steps(symbols%step)%element_loads)
         allocate (faces%load(loads%n), faces%next(loads%n), source=0_ip)
         do i = 1, loads%n
            if (is_on_volume(loads%kind(i))) cycle
            key = MOST_SIDES*(loads%element(i) - 1) + loads%face(i)
            call add_id(known_faces, key, faces%n + 1, known)
            at = find_id(known_faces, key)
            if (known) faces%next(i) = faces%load(at)
            faces%load(at) = i
            faces%n = max(faces%n, at)
         end do
      end associate
   end subroutine list_faces

   !> The force per area at a place of a face.
   pure function traction_on(symbols, faces, i, t) result(traction)
      type(symbols_t), intent(in) :: symbols
      type(loaded_faces_t), intent(in) :: faces
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: t                     !< in [-1,1]
      real(wp) :: traction(2)                       !< [F/L^2]
      real(wp), allocatable :: x(:, :)
      real(wp) :: normal(2), depth, factor
      integer(ip) :: k

      traction = 0.0_wp
      x = symbols%model%mesh%x(:, nodes_of(symbols, faces%load(i)))
      normal = outward_normal(x, t)
      k = faces%load(i)
      associate (loads => symbols%model%steps(symbols%step)%element_loads)
         do while (k > 0)
            factor = load_factor(symbols, k)
            associate (value => loads%value(:, k))
               select case (loads%kind(k))
               case (LOAD_TRACTION)
                  traction = traction + factor*value(:2)
               case (LOAD_HYDROSTATIC)
                  depth = dot_product(x(2, :), face_shape_values(size(x, 2, kind=ip), t))
                  traction = traction - factor*value(1)*max(0.0_wp, (depth - value(2))/(value(3) - value(2)))*normal
               case default
                  traction = traction - factor*value(1)*normal
               end select
            end associate
            k = faces%next(k)
         end do
      end associate
   end function traction_on

   !> The nodes of the face of a load.
   pure function nodes_of(symbols, load) result(nodes)
      type(symbols_t), intent(in) :: symbols
      integer(ip), intent(in) :: load
      integer(ip), allocatable :: nodes(:)

      associate (loads => symbols%model%steps(symbols%step)%element_loads)
         nodes = face_nodes(symbols%model%mesh, loads%element(load), loads%face(load))
      end associate
   end function nodes_of

   !> Equal pieces of a face, none of which is shorter than a length.
   pure integer(ip) function pieces_of(symbols, nodes, least) result(n)
      type(symbols_t), intent(in) :: symbols
      integer(ip), intent(in) :: nodes(:)           !< of the face
      real(wp), intent(in) :: least                 !< [pixels]

      associate (x => symbols%model%mesh%x)
         n = int(min(norm2(x(:, nodes(2)) - x(:, nodes(1)))/(least*symbols%pixel), real(MOST_PIECES, wp)), ip)
      end associate
      n = max(1_ip, n)
   end function pieces_of

   !> What is drawn along a face, at the ends of its pieces.
   pure function spots_on(symbols, faces, i, least) result(spots)
      type(symbols_t), intent(in) :: symbols
      type(loaded_faces_t), intent(in) :: faces
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: least                 !< length of a piece [pixels]
      type(spot_t), allocatable :: spots(:)         !< (pieces + 1)
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: k, n

      nodes = nodes_of(symbols, faces%load(i))
      n = pieces_of(symbols, nodes, least)
      allocate (spots(n + 1))
      do k = 0, n
         spots(k + 1) = spot_on(symbols, faces, i, nodes, 2*real(k, wp)/n - 1)
      end do
   end function spots_on

   !> What is drawn at a place of a face.
   pure type(spot_t) function spot_on(symbols, faces, i, nodes, t) result(spot)
      type(symbols_t), intent(in) :: symbols
      type(loaded_faces_t), intent(in) :: faces
      integer(ip), intent(in) :: i, nodes(:)        !< the face and its nodes
      real(wp), intent(in) :: t
      real(wp) :: n(size(nodes)), share(2), normal(2), length, along

      normal = outward_normal(symbols%model%mesh%x(:, nodes), t)
      n = face_shape_values(size(nodes, kind=ip), t)
      spot%place = matmul(symbols%model%mesh%x(:, nodes), n)
      spot%u = matmul(symbols%u(:, nodes), n)
      share = traction_on(symbols, faces, i, t)/faces%largest
      length = norm2(share)
      spot%from = spot%place
      spot%arrow = LONGEST*symbols%pixel*share
      if (.not. length > 0.0_wp) return
      along = dot_product(share, normal)/length
      spot%is_shear = abs(along) < AXIS_OF_SHEAR
      if (spot%is_shear) then
         spot%arrow = 2*HALF_SHEAR*symbols%pixel*max(0.5_wp, length)/length*share
         spot%from = spot%place + OFF*symbols%pixel*normal - 0.5_wp*spot%arrow
      else if (along < -SLANT) then
         spot%from = spot%place - spot%arrow
      end if
   end function spot_on

   !> The lines that join the free ends, which show how a load goes along a side.
   subroutine put_lines_of_ends(faces, symbols)
      type(loaded_faces_t), intent(in) :: faces
      type(symbols_t), intent(inout) :: symbols
      real(wp) :: ends(2, MOST_PIECES + 1), moves(2, MOST_PIECES + 1)
      type(spot_t), allocatable :: spots(:)
      type(spot_t) :: middle
      integer(ip) :: i, k, n

      call begin_block(symbols, 'ends of the loads on faces', '', 'with lines'//LOOKS)
      do i = 1, faces%n
         middle = spot_on(symbols, faces, i, nodes_of(symbols, faces%load(i)), 0.0_wp)
         if (middle%is_shear) cycle
         spots = spots_on(symbols, faces, i, PIECE)
         n = size(spots, kind=ip)
         do k = 1, n
            ends(:, k) = spots(k)%from
            if (all(.not. abs(spots(k)%from - spots(k)%place) > 0.0_wp)) ends(:, k) = spots(k)%place + spots(k)%arrow
            moves(:, k) = spots(k)%u
         end do
         call put_path(symbols, moves(:, :n), ends(:, :n))
      end do
      call end_block(symbols)
   end subroutine put_lines_of_ends

   !> The arrows, so far apart that they can be told from each other.
   subroutine put_arrows(faces, legend, symbols)
      type(loaded_faces_t), intent(in) :: faces
      character(len=*), intent(in) :: legend
      type(symbols_t), intent(inout) :: symbols
      type(spot_t), allocatable :: spots(:)
      real(wp), allocatable :: places(:, :)
      integer(ip) :: i, n, first(faces%n + 1)       ! spots of each face

      first(1) = 1
      do i = 1, faces%n
         first(i + 1) = first(i) + pieces_of(symbols, nodes_of(symbols, faces%load(i)), SPACING) + 1
      end do
      n = first(faces%n + 1) - 1
      allocate (spots(n), places(2, n))
      do i = 1, faces%n
         spots(first(i):first(i + 1) - 1) = spots_on(symbols, faces, i, SPACING)
      end do
      do i = 1, n
         places(:, i) = spots(i)%place
      end do
      call begin_block(symbols, 'loads on faces', ':5:6', ARROWS//' title "'//legend//'"')
      spots = pack(spots, thinned(places, SPACING*symbols%pixel))
      do i = 1, size(spots, kind=ip)
         if (norm2(spots(i)%arrow) >= LEAST*symbols%pixel) call put_arrow(symbols, spots(i)%u, spots(i)%from, spots(i)%arrow)
      end do
      call end_block(symbols)
   end subroutine put_arrows

end module atrito_face_symbols
