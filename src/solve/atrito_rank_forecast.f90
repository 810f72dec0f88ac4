!> The memory that each rank will hold at the most when a scene is shared out, beyond what it holds before its parts are made.
!>
!> With n nodes and e elements of the parts of a rank, k unknowns that a part keeps, and i + c unknowns of the top of a body that is
!> in pieces, c of them contact dofs:
!>
!>     solving      mesh of the parts                                72 n + 64 e
!>                  and the largest of: the parcel of a part; its solvers while they are made; the factors and
!>                  what is left of parts, packed                    LEFT_BYTES k^2
!>                  fronts of tops, i' = 2 i/ranks: the first rank   8 ((i' + c)^2 + c^2)
!>                  others, with more than two ranks                 8 (i' + (i' + c)/2)^2
!>     recovering   mesh of its region, and the parcel               2 (72 n + 64 e)
!>                  stresses and patches                             recovery_bytes(n, e)
!>
!> the larger of the two, and of the smaller one what does not serve again: among factors and parcels memory goes to pieces, on the
!> first rank less, whose arrays are of the whole scene. Solvers: atrito_part_bytes. A region has some rings of elements more than
!> the rank: RINGS for each node of a border.
!>
!> The first rank has besides its parts what one process would have but for bodies and recovery: the contact system with the
!> retained matrices of all bodies, loads, displacements, reactions, stresses of the whole scene; and a part or a region of another
!> rank while it is sent. In the sparse form what the parts share counts as theirs (solving_of_ranks).
!>
!> Two bodies with 0.2 and 1.0 million displacements (equal elements) and 1.2 million (no two elements equal) on 2 and 4 ranks: the
!> forecast, with the fronts counted, is 0.94 to 1.3 of the measured peaks. Of a wall of 1,008 blocks in the sparse form on 4 ranks
!> it was 1.27 of the first rank's and 1.4 of the others' when what is left of parts was still counted twice.
module atrito_rank_forecast
   use atrito_assembly, only: fem_t
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_kinds, only: ip, lp, wp
   use atrito_model, only: model_t
   use atrito_part_bytes, only: part_bytes_t, count_kept
   use atrito_results, only: scene_t
   use atrito_scene_data, only: scene_data_t
   use atrito_scene_forecast, only: contact_bytes, field_library_bytes, load_bytes, recovery_bytes, request_bytes, with_holes, &
                                    LATER_BYTES
   use atrito_shared_fields, only: kept_share, EQUILIBRIUM_WORK, STRESS_WORK
   use atrito_shares, only: shares_t
   use atrito_solver_choice, only: SOLVER_SPARSE
   implicit none (type, external)
   private
   public :: forecast_ranks, first_rank_least

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8, INTEGER_BYTES = storage_size(1_ip)/8
   integer(lp), parameter :: MESH_NODE = 72_lp, MESH_ELEMENT = 64_lp
   !> Of what is left of a part with k unknowns, for k^2: packed, by its solver, by itself and as a front that goes on.
   integer(lp), parameter :: LEFT_BYTES = 12_lp
   !> Buffers of MPI.
   integer(lp), parameter :: BUFFERS = 4000000_lp
   !> Elements in the rings of a region, for each node of a border.
   integer(lp), parameter :: RINGS = 5_lp
   !> On the first rank, for each node and element of the scene: loads, displacements, reactions and stresses as a whole, lists of
   !> who has what.
   integer(lp), parameter :: WHOLE_NODE = 150_lp, WHOLE_ELEMENT = 16_lp
   !> Of the smaller of two phases: what does not serve again, on the first rank and on others.
   real(wp), parameter :: LEFT_BEHIND(2) = [0.13_wp, 0.3_wp]

   !> What a rank has.
   type :: rank_size_t
      integer(lp) :: nodes = 0, elements = 0
      integer(lp) :: border = 0                      !< unknowns that its pieces have in common with others
      integer(lp) :: largest = 0                     !< bytes of the mesh of the largest of its parts
      integer(lp) :: left = 0                        !< sum of k^2 of its parts
      integer(lp) :: held = 0, most = 0              !< bytes of the solvers of its parts
   end type rank_size_t

contains

   !> Growth of each rank [bytes].
   function forecast_ranks(data, scene, shares, parts, are_there) result(bytes)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene             !< with its bodies
      type(shares_t), intent(in) :: shares           !< over two ranks or more
      type(part_bytes_t), intent(in) :: parts
      logical, intent(in) :: are_there               !< the ranks have their parts already
      integer(lp), allocatable :: bytes(:)           !< (ranks) from 0
      type(rank_size_t) :: ranks(0:shares%n_ranks - 1)
      integer(lp) :: top(2), later, sent         ! top: of the first rank and of others
      real(wp) :: fields(0:shares%n_ranks - 1)   ! elements with the fields of a rank over those of its parts
      integer(ip) :: r

      call measure_ranks(data%fem, shares, parts, ranks)
      fields = share_of_fields(ranks)
      top = 0
      if (data%contact_form /= CONTACT_SPARSE) top = [top_bytes(shares, .true.), top_bytes(shares, .false.)]
      later = LATER_BYTES + BUFFERS
      sent = 2*maxval(ranks(1:)%largest)
      allocate (bytes(0:shares%n_ranks - 1))
      do r = 1, shares%n_ranks - 1
         bytes(r) = later + overlap(solving_bytes(ranks(r), are_there, top(2), ranks(r)%largest), &
                                    region_bytes(data%model, ranks(r), fields(r)), LEFT_BEHIND(2))
      end do
      bytes(0) = later + field_library_bytes(data) &
                 + overlap(load_bytes(data%model) + list_bytes(data%fem) &
                           + solving_bytes(ranks(0), are_there, top(1) + contact_system(data, scene), sent), &
                           whole_bytes(data) + region_bytes(data%model, ranks(0), fields(0)) + sent, LEFT_BEHIND(1))
   end function forecast_ranks

   !> What the first rank grows by at the least, however many there are.
   integer(lp) function first_rank_least(data, scene) result(bytes)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene

      bytes = LATER_BYTES + field_library_bytes(data) &
              + max(whole_bytes(data), load_bytes(data%model) + list_bytes(data%fem) + contact_system(data, scene))
   end function first_rank_least

   elemental integer(lp) function overlap(solving, recovering, left_behind) result(bytes)
      integer(lp), intent(in) :: solving, recovering
      real(wp), intent(in) :: left_behind

      bytes = max(solving, recovering) + int(left_behind*real(min(solving, recovering), wp), lp)
   end function overlap

   subroutine measure_ranks(fem, shares, parts, ranks)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      type(part_bytes_t), intent(in) :: parts
      type(rank_size_t), intent(out) :: ranks(0:)
      integer(lp) :: nodes, elements, kept
      integer(ip) :: p

      do p = 1, shares%n
         associate (share => shares%list(p), rank => ranks(shares%list(p)%rank))
            nodes = size(fem%bodies%list(share%body)%nodes, kind=lp)
            if (allocated(share%nodes)) nodes = size(share%nodes, kind=lp)
            elements = size(share%elements, kind=lp)
            kept = count_kept(fem, shares, p)
            rank%nodes = rank%nodes + nodes
            rank%elements = rank%elements + elements
            rank%largest = max(rank%largest, MESH_NODE*nodes + MESH_ELEMENT*elements)
            rank%left = rank%left + kept**2
            if (.not. share%is_whole) rank%border = rank%border + kept
            rank%most = max(rank%most, rank%held + with_holes(SOLVER_SPARSE, parts%most(p)))
            rank%held = rank%held + with_holes(SOLVER_SPARSE, parts%held(p))
         end associate
      end do
   end subroutine measure_ranks

   !> Parcels that come or go, or solvers while they are made, or factors and what is beside them.
   pure integer(lp) function solving_bytes(rank, are_there, beside, parcels) result(bytes)
      type(rank_size_t), intent(in) :: rank
      logical, intent(in) :: are_there
      integer(lp), intent(in) :: beside, parcels

      bytes = max(rank%most, rank%held + beside)     ! what is left of parts that are there was told with them
      if (are_there) return
      bytes = max(rank%most, rank%held + LEFT_BYTES*rank%left + beside, parcels) + MESH_NODE*rank%nodes + MESH_ELEMENT*rank%elements
   end function solving_bytes

   !> Fronts of what the parts of bodies have in common: that of the first rank has the last border and all contact dofs, and what
   !> is left of these is a full matrix; another rank may have one of half as much that is kept, and a border more.
   pure integer(lp) function top_bytes(shares, is_first) result(bytes)
      type(shares_t), intent(in) :: shares
      logical, intent(in) :: is_first
      integer(ip) :: b
      integer(lp) :: border, kept

      bytes = 0
      do b = 1, size(shares%tops, kind=ip)
         if (shares%first(b + 1) - shares%first(b) < 2) cycle
         kept = int(shares%tops(b)%n_kept, lp)
         border = 2*(int(shares%tops(b)%n, lp) - kept)/shares%n_ranks
         if (is_first) then
            bytes = bytes + REAL_BYTES*((border + kept)**2 + kept**2)
         else if (shares%n_ranks > 2) then
            bytes = bytes + REAL_BYTES*(border + (border + kept)/2)**2
         end if
      end do
   end function top_bytes

   !> The others take over what the first rank has no time for.
   pure function share_of_fields(ranks) result(share)
      type(rank_size_t), intent(in) :: ranks(0:)
      real(wp) :: share(0:size(ranks) - 1)
      real(wp) :: elements(0:size(ranks) - 1), keeps

      elements = max(1.0_wp, real(ranks%elements, wp))
      keeps = min(elements(0), kept_share(EQUILIBRIUM_WORK + STRESS_WORK, size(ranks, kind=ip))*sum(elements))
      share(0) = keeps/elements(0)
      share(1:) = (elements(1:) + (elements(0) - keeps)/real(size(ranks) - 1, wp))/elements(1:)
   end function share_of_fields

   !> Stresses and patches of the rank's elements and of those in the rings round them.
   integer(lp) function region_bytes(model, rank, share) result(bytes)
      type(model_t), intent(in) :: model
      type(rank_size_t), intent(in) :: rank
      real(wp), intent(in) :: share                  !< elements with fields over those of the rank's parts
      integer(lp) :: nodes, elements

      nodes = int(share*real(rank%nodes, wp), lp) + RINGS*rank%border/2
      elements = int(share*real(rank%elements, wp), lp) + RINGS*rank%border/2
      bytes = 2*(MESH_NODE*nodes + MESH_ELEMENT*elements) + recovery_bytes(model, nodes, elements)
   end function region_bytes

   !> What the first rank has of the scene as a whole while stresses are recovered.
   integer(lp) function whole_bytes(data) result(bytes)
      type(scene_data_t), intent(in) :: data

      bytes = WHOLE_NODE*data%model%mesh%n_nodes + WHOLE_ELEMENT*data%model%mesh%n_elements + request_bytes(data%model, data)
   end function whole_bytes

   !> Reduced loads, which part has an equation, and whose fields nodes and elements have.
   pure integer(lp) function list_bytes(fem) result(bytes)
      type(fem_t), intent(in) :: fem
      integer(ip) :: b

      bytes = INTEGER_BYTES*(int(fem%mesh%n_nodes, lp) + int(fem%mesh%n_elements, lp))
      do b = 1, fem%bodies%n
         bytes = bytes + 2*REAL_BYTES*int(fem%bodies%list(b)%n, lp)
      end do
   end function list_bytes

   !> Of the dense form, with the matrices of the retained equations.
   pure integer(lp) function contact_system(data, scene) result(bytes)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene
      integer(ip) :: b

      bytes = 0
      if (data%contact_form == CONTACT_SPARSE) return
      bytes = contact_bytes(scene)
      do b = 1, data%fem%bodies%n
         bytes = bytes + REAL_BYTES*int(data%fem%bodies%list(b)%n_retained, lp)**2
      end do
   end function contact_system

end module atrito_rank_forecast
