!> A part of the scene with all that its rank needs: nodes and elements of its own, numbered from 1, as one body.
!>
!> The retained equations of a part are those that other parts have as well, and after them those that the body keeps for the
!> contact; what is left of them when the part is factored, its Schur complement S_p, is a summand of the matrix of the body's top
!> unknowns (top_t of atrito_shares):
!>
!>     S = sum_p A_p S_p A_p',     A_p: retained equation -> part%top
!>
!> A part may be unconnected and may float: every one of its interior equations is an interior one of the body, with the same
!> elements round it, so that its interior is as regular as the body's. A body that is whole has the equations, the order and
!> the rigid motions that it has in the scene.
module atrito_part
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: body_t
   use atrito_fem_piece, only: take_piece
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_mesh_parcel, only: put_mesh, put_sections, take_mesh, take_sections
   use atrito_parcel, only: parcel_t, put, take
   use atrito_shares, only: shares_t, share_t, top_t
   implicit none (type, external)
   private
   public :: part_t, make_part, release_part, put_part, take_part, load_of_part

   !> Assigned, it has the same mesh: release_part is for the last that has it.
   type :: part_t
      integer(ip) :: number = 0                  !< among the parts of the scene
      integer(ip) :: body = 0                    !< of the scene
      integer(ip) :: rank = 0
      logical :: is_whole = .true.               !< the body is
      integer(ip) :: n_top = 0                   !< top unknowns of the body
      type(fem_t) :: fem                         !< one body; its mesh is the part's own, without maps of the user's numbers
      integer(ip), allocatable :: element(:)     !< (elements) place in the mesh of the scene
      integer(ip), allocatable :: node(:)        !< (nodes) place in the mesh of the scene
      integer(ip), allocatable :: equation(:)    !< (n) equation of the body in the scene
      integer(ip), allocatable :: top(:)         !< (n_retained) place among the top unknowns of the body, ascending
   end type part_t

contains

   subroutine make_part(fem, shares, p, part)
      type(fem_t), intent(in) :: fem             !< of the scene
      type(shares_t), intent(in) :: shares
      integer(ip), intent(in) :: p               !< 1..shares%n
      type(part_t), intent(out) :: part

      associate (share => shares%list(p), top => shares%tops(shares%list(p)%body))
         part%number = p
         part%body = share%body
         part%rank = share%rank
         part%is_whole = share%is_whole
         part%n_top = top%n
         part%element = share%elements
         call order_nodes(fem, share, top, part%node)
         call take_piece(fem, part%node, part%element, part%fem)
         call number_part(fem, top, part)
         call describe_body(fem%bodies%list(share%body), part%fem%mesh, share%is_whole, part%fem%bodies%list(1))
      end associate
   end subroutine make_part

   !> Gives the mesh back.
   subroutine release_part(part)
      type(part_t), intent(inout) :: part

      if (associated(part%fem%mesh)) deallocate (part%fem%mesh)
      nullify (part%fem%mesh)
   end subroutine release_part

   !> The nodes, those with equations that are retained last, in the order of the top.
   subroutine order_nodes(fem, share, top, nodes)
      type(fem_t), intent(in) :: fem
      type(share_t), intent(in) :: share
      type(top_t), intent(in) :: top
      integer(ip), allocatable, intent(out) :: nodes(:)
      logical, allocatable :: stays(:)
      integer(ip) :: node_at(top%n), at(2), i

      if (share%is_whole) then
         nodes = fem%bodies%list(share%body)%nodes
         return
      end if
      allocate (stays(size(share%nodes)))
      node_at = 0
      do i = 1, size(share%nodes, kind=ip)
         associate (equation => fem%bodies%equation(:, share%nodes(i)))
            at = [place_in(top%equation, equation(1)), place_in(top%equation, equation(2))]
            stays(i) = any(at > 0)
            if (stays(i)) node_at(minval(at, mask=at > 0)) = share%nodes(i)
         end associate
      end do
      nodes = [pack(share%nodes,.not. stays), pack(node_at, node_at > 0)]
   end subroutine order_nodes

   !> The place of a number in an ascending list; 0: it is not there.
   pure integer(ip) function place_in(list, number) result(place)
      integer(ip), intent(in) :: list(:), number
      integer(ip) :: low, high

      low = 1
      high = size(list, kind=ip)
      do while (low < high)
         place = low + (high - low)/2
         if (list(place) < number) then
            low = place + 1
         else
            high = place
         end if
      end do
      place = 0
      if (low > size(list)) return
      if (list(low) == number) place = low
   end function place_in

   !> The equations in the order of the nodes, the retained ones last.
   subroutine number_part(fem, top, part)
      type(fem_t), intent(in) :: fem
      type(top_t), intent(in) :: top
      type(part_t), intent(inout) :: part
      integer(ip) :: of_body(2, size(part%node)), at(2, size(part%node)), n, n_interior

      of_body = fem%bodies%equation(:, part%node)
      call find_places(top%equation, of_body, at)
      n = count(of_body > 0, kind=ip)
      n_interior = count(of_body > 0 .and. at == 0, kind=ip)
      allocate (part%equation(n), part%top(n - n_interior))
      allocate (part%fem%bodies%list(1))
      associate (bodies => part%fem%bodies)
         bodies%n = 1
         bodies%list(1)%n = n
         bodies%list(1)%n_retained = n - n_interior
         allocate (bodies%of_node(size(part%node)), bodies%of_element(size(part%element)), source=1_ip)
         bodies%equation = min(of_body, 0_ip)
         call number_those(of_body > 0 .and. at == 0, of_body, 0_ip, bodies%equation, part%equation)
         call number_those(at > 0, of_body, n_interior, bodies%equation, part%equation)
         part%top = pack(at, at > 0)
      end associate
   end subroutine number_part

   pure subroutine find_places(list, numbers, at)
      integer(ip), intent(in) :: list(:), numbers(:, :)
      integer(ip), intent(out) :: at(:, :)       !< 0: not there
      integer(ip) :: i, dof

      do i = 1, size(numbers, 2, kind=ip)
         do dof = 1, 2
            at(dof, i) = place_in(list, numbers(dof, i))
         end do
      end do
   end subroutine find_places

   !> Numbers some dofs from before + 1 on, in the order of the nodes.
   pure subroutine number_those(which, of_body, before, equation, equation_of_body)
      logical, intent(in) :: which(:, :)         !< (2, nodes)
      integer(ip), intent(in) :: of_body(:, :)   !< (2, nodes)
      integer(ip), intent(in) :: before
      integer(ip), intent(inout) :: equation(:, :) !< (2, nodes)
      integer(ip), intent(inout) :: equation_of_body(:)
      integer(ip) :: i, dof, n

      n = before
      do i = 1, size(which, 2, kind=ip)
         do dof = 1, 2
            if (.not. which(dof, i)) cycle
            n = n + 1
            equation(dof, i) = n
            equation_of_body(n) = of_body(dof, i)
         end do
      end do
   end subroutine number_those

   !> Centre, size and rigid motions are those of the body in the scene.
   pure subroutine describe_body(body, mesh, is_whole, own)
      type(body_t), intent(in) :: body
      type(mesh_t), intent(in) :: mesh           !< of the part
      logical, intent(in) :: is_whole
      type(body_t), intent(inout) :: own         !< has its equations
      real(wp) :: extent(2)
      integer(ip) :: i

      own%name = ''
      if (allocated(body%name)) own%name = body%name
      own%elements = [(i, i=1, mesh%n_elements)]
      own%nodes = [(i, i=1, mesh%n_nodes)]
      own%centre = body%centre
      own%size = body%size
      own%modes = body%modes
      own%is_touched = body%is_touched
      own%by_profile = body%by_profile .and. is_whole
      own%slenderness = body%slenderness
      if (is_whole) return
      extent = maxval(mesh%x, dim=2) - minval(mesh%x, dim=2)
      own%slenderness = minval(extent)/maxval(extent)
   end subroutine describe_body

   !> What acts on the interior of a part; the rest of the load is put on the top unknowns, once.
   pure function load_of_part(part, load) result(own)
      type(part_t), intent(in) :: part
      real(wp), intent(in) :: load(:)            !< (equations of the body) [F]
      real(wp) :: own(size(part%equation))       !< [F] 0 where it is retained
      integer(ip) :: n_interior

      n_interior = size(part%equation, kind=ip) - size(part%top, kind=ip)
      own(:n_interior) = load(part%equation(:n_interior))
      own(n_interior + 1:) = 0.0_wp
   end function load_of_part

   !> Adds a part to a parcel.
   subroutine put_part(part, parcel)
      type(part_t), intent(in) :: part
      type(parcel_t), intent(inout) :: parcel

      call put(parcel, [part%number, part%body, part%rank, part%n_top])
      call put(parcel, part%is_whole)
      call put(parcel, part%element)
      call put(parcel, part%node)
      call put(parcel, part%equation)
      call put(parcel, part%top)
      call put_mesh(parcel, part%fem%mesh)
      call put_sections(parcel, part%fem)
      call put(parcel, part%fem%bodies%equation)
      call put_body(part%fem%bodies%list(1), parcel)
   end subroutine put_part

   subroutine put_body(body, parcel)
      type(body_t), intent(in) :: body
      type(parcel_t), intent(inout) :: parcel

      call put(parcel, body%name)
      call put(parcel, body%elements)
      call put(parcel, body%nodes)
      call put(parcel, [body%n, body%n_retained])
      call put(parcel, [body%by_profile, body%is_rigid, body%is_touched])
      call put(parcel, [body%centre, body%size, body%slenderness])
      call put(parcel, body%modes)
   end subroutine put_body

   !> The next part of a parcel.
   subroutine take_part(parcel, part)
      type(parcel_t), intent(inout) :: parcel
      type(part_t), intent(out) :: part
      integer(ip), allocatable :: numbers(:)

      call take(parcel, numbers)
      part%number = numbers(1)
      part%body = numbers(2)
      part%rank = numbers(3)
      part%n_top = numbers(4)
      call take(parcel, part%is_whole)
      call take(parcel, part%element)
      call take(parcel, part%node)
      call take(parcel, part%equation)
      call take(parcel, part%top)
      allocate (part%fem%mesh)
      call take_mesh(parcel, part%fem%mesh)
      call take_sections(parcel, part%fem)
      part%fem%bodies%n = 1
      allocate (part%fem%bodies%list(1))
      allocate (part%fem%bodies%of_node(size(part%node)), part%fem%bodies%of_element(size(part%element)), source=1_ip)
      call take(parcel, part%fem%bodies%equation)
      call unpack_body(parcel, part%fem%bodies%list(1))
   end subroutine take_part

   subroutine unpack_body(parcel, body)
      type(parcel_t), intent(inout) :: parcel
      type(body_t), intent(inout) :: body
      integer(ip), allocatable :: numbers(:)
      logical, allocatable :: answers(:)
      real(wp), allocatable :: measures(:)

      call take(parcel, body%name)
      call take(parcel, body%elements)
      call take(parcel, body%nodes)
      call take(parcel, numbers)
      body%n = numbers(1)
      body%n_retained = numbers(2)
      call take(parcel, answers)
      body%by_profile = answers(1)
      body%is_rigid = answers(2)
      body%is_touched = answers(3)
      call take(parcel, measures)
      body%centre = measures(:2)
      body%size = measures(3)
      body%slenderness = measures(4)
      call take(parcel, body%modes)
   end subroutine unpack_body

end module atrito_part
