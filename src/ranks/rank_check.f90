!> Whether the ranks can hold a scene that is shared out: asked of each before its part is made, and before that is factored.
!>
!> A rank has to find what it needs below its own limit (`ulimit -v`), and all ranks of a host together in what the host has. With
!> n nodes and e elements of a rank it holds the larger of
!>
!>     solving      its part, as it tells when it has assembled it (solving_of_ranks)
!>     recovering   mesh of its region, and the parcel               2 (72 n + 64 e)
!>                  stresses and patches                             recovery_bytes(n, e)
!>
!> and of the smaller one what does not serve again: among factors and parcels memory goes to pieces, on the first rank less, whose
!> arrays are of the whole scene. A region has some rings of elements more than the rank: RINGS for each node of a border. The first
!> rank has loads, displacements, reactions, stresses of the whole scene besides, and a part or a region of another rank while it is
!> sent. Of a wall of 1,008 blocks on 4 ranks the forecast is 1.27 of the measured peak of the first rank, 1.4 of the others'.
!>
!> Before the parts are there it is known what they need at the least: their mesh, and what METIS takes to order them.
module atrito_rank_check
   use atrito_kinds, only: ip, lp, wp
   use atrito_memory, only: memory_text
   use atrito_messages, only: message_t, add_message, SEVERITY_ERROR
   use atrito_model, only: model_t
   use atrito_rank_memory, only: rank_memory_t, ask_for_memory
   use atrito_ranked_parts, only: ranked_parts_t
   use atrito_results, only: scene_t
   use atrito_scene_data, only: scene_data_t
   use atrito_scene_forecast, only: field_library_bytes, load_bytes, recovery_bytes, request_bytes, with_holes, LATER_BYTES
   use atrito_scene_shares, only: fair_share
   use atrito_shared_fields, only: kept_share, EQUILIBRIUM_WORK, STRESS_WORK
   use atrito_shared_scene, only: shared_scene_t
   use atrito_solver_choice, only: SOLVER_SPARSE
   use atrito_status, only: status_t, STATUS_DECK
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: check_ranks, shortage_t, find_shortage

   !> Who has too little memory.
   type :: shortage_t
      logical :: is_there = .false.
      integer(ip) :: first = 0                       !< rank
      integer(ip) :: n = 1                           !< ranks: more than one share a host
      integer(lp) :: needed = 0, there = 0           !< bytes, with what is held
   end type shortage_t

   !> What a rank has.
   type :: rank_size_t
      integer(lp) :: nodes = 0, elements = 0
      integer(lp) :: border = 0                      !< unknowns that its part shares with others
      integer(lp) :: solving = 0                     !< bytes that its part takes
   end type rank_size_t

   integer(lp), parameter :: REAL_BYTES = storage_size(1.0_wp)/8
   integer(lp), parameter :: MESH_NODE = 72_lp, MESH_ELEMENT = 64_lp
   !> METIS, for each element.
   integer(lp), parameter :: CUT_BYTES = 400_lp
   !> Buffers of MPI.
   integer(lp), parameter :: BUFFERS = 4000000_lp
   !> Elements in the rings of a region, for each node of a border.
   integer(lp), parameter :: RINGS = 5_lp
   !> On the first rank, for each node and element of the scene: loads, displacements, reactions and stresses as a whole, lists of
   !> who has what.
   integer(lp), parameter :: WHOLE_NODE = 150_lp, WHOLE_ELEMENT = 16_lp
   !> Of the smaller of two phases: what does not serve again, on the first rank and on others.
   real(wp), parameter :: LEFT_BEHIND(2) = [0.13_wp, 0.3_wp]

contains

   !> status: STATUS_DECK, and an error, when a rank or the ranks of a host need more than there is.
   subroutine check_ranks(data, limit, scene, status)
      class(scene_data_t), intent(in) :: data         !< shared out, or about to be
      integer(lp), intent(in) :: limit               !< bytes of each rank; what there is counts where it is less
      type(scene_t), intent(inout) :: scene          !< on return with the forecast of the first rank
      type(status_t), intent(inout) :: status
      type(rank_memory_t), allocatable :: ranks(:)
      integer(lp), allocatable :: growth(:)
      type(shortage_t) :: short

      call ask_for_memory(ranks)
      if (data%is_assembled) then
         call forecast_ranks(data, size(ranks, kind=ip), growth)
      else
         growth = least_of_ranks(data, size(ranks, kind=ip))
      end if
      short = find_shortage(ranks, growth, limit)
      scene%memory = max(scene%peak_before, ranks(0)%held + growth(0))
      if (short%is_there) call tell(data, scene, who_text(ranks, short), short, status)
   end subroutine check_ranks

   !> What each rank grows by at the least [bytes]: to order its elements, and on the first one those of the whole scene.
   function least_of_ranks(data, n_ranks) result(bytes)
      class(scene_data_t), intent(in) :: data
      integer(ip), intent(in) :: n_ranks
      integer(lp) :: bytes(0:n_ranks - 1)
      real(wp) :: nodes, elements

      nodes = fair_share(n_ranks)*real(data%fem%mesh%n_nodes, wp)
      elements = fair_share(n_ranks)*real(data%fem%mesh%n_elements, wp)
      bytes = LATER_BYTES + BUFFERS + MESH_NODE*int(nodes, lp) + (MESH_ELEMENT + CUT_BYTES)*int(elements, lp)
      bytes(0) = LATER_BYTES + field_library_bytes(data) &
                 + max(whole_bytes(data), load_bytes(data%model) + list_bytes(data), CUT_BYTES*data%fem%mesh%n_elements)
   end function least_of_ranks

   !> Growth of each rank when its part is there [bytes].
   subroutine forecast_ranks(data, n_ranks, bytes)
      class(scene_data_t), intent(in) :: data
      integer(ip), intent(in) :: n_ranks
      integer(lp), allocatable, intent(out) :: bytes(:) !< (ranks) from 0
      type(rank_size_t) :: ranks(0:n_ranks - 1)
      real(wp) :: fields(0:n_ranks - 1)              ! elements with the fields of a rank over those of its part
      integer(lp) :: sent
      integer(ip) :: r

      call measure_ranks(data, ranks)
      fields = share_of_fields(ranks)
      allocate (bytes(0:n_ranks - 1))
      do r = 1, n_ranks - 1
         bytes(r) = LATER_BYTES + BUFFERS + overlap(ranks(r)%solving, region_bytes(data%model, ranks(r), fields(r)), LEFT_BEHIND(2))
      end do
      sent = 2*maxval(MESH_NODE*ranks(1:)%nodes + MESH_ELEMENT*ranks(1:)%elements)
      bytes(0) = LATER_BYTES + BUFFERS + field_library_bytes(data) &
                 + overlap(load_bytes(data%model) + list_bytes(data) + ranks(0)%solving, &
                           whole_bytes(data) + region_bytes(data%model, ranks(0), fields(0)) + sent, LEFT_BEHIND(1))
   end subroutine forecast_ranks

   elemental integer(lp) function overlap(solving, recovering, left_behind) result(bytes)
      integer(lp), intent(in) :: solving, recovering
      real(wp), intent(in) :: left_behind

      bytes = max(solving, recovering) + int(left_behind*real(min(solving, recovering), wp), lp)
   end function overlap

   !> What the ranks have, and told when they had assembled it.
   subroutine measure_ranks(data, ranks)
      class(scene_data_t), intent(in) :: data
      type(rank_size_t), intent(out) :: ranks(0:)
      integer(lp) :: solving(0:size(ranks) - 1)
      integer(ip) :: r, p

      solving = 0
      select type (scene => data%assembled)
      type is (shared_scene_t)
         select type (parts => scene%parts)
         type is (ranked_parts_t)
            solving = parts%solving_of_ranks(size(ranks, kind=ip))
            solving(0) = solving(0) + scene%solving_bytes() - parts%solving_bytes()   ! vectors of the whole scene
            do p = 1, size(parts%rank, kind=ip)
               ranks(parts%rank(p))%border = scene%lists%n_kept(p)
            end do
         end select
      end select
      do r = 0, size(ranks, kind=ip) - 1
         select type (scene => data%assembled)
         type is (shared_scene_t)
            ranks(r)%elements = count(scene%rank_of == r, kind=lp)
         end select
         ranks(r)%nodes = ranks(r)%elements*data%fem%mesh%n_nodes/data%fem%mesh%n_elements
         ranks(r)%solving = with_holes(SOLVER_SPARSE, solving(r))
      end do
   end subroutine measure_ranks

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
      real(wp), intent(in) :: share                  !< elements with fields over those of the rank's part
      integer(lp) :: nodes, elements

      nodes = int(share*real(rank%nodes, wp), lp) + RINGS*rank%border/2
      elements = int(share*real(rank%elements, wp), lp) + RINGS*rank%border/2
      bytes = 2*(MESH_NODE*nodes + MESH_ELEMENT*elements) + recovery_bytes(model, nodes, elements)
   end function region_bytes

   !> What the first rank has of the scene as a whole while stresses are recovered.
   integer(lp) function whole_bytes(data) result(bytes)
      class(scene_data_t), intent(in) :: data

      bytes = WHOLE_NODE*data%model%mesh%n_nodes + WHOLE_ELEMENT*data%model%mesh%n_elements + request_bytes(data%model, data)
   end function whole_bytes

   !> Reduced loads, which part has an unknown, and whose fields nodes and elements have.
   pure integer(lp) function list_bytes(data) result(bytes)
      class(scene_data_t), intent(in) :: data
      integer(lp), parameter :: INTEGER_BYTES = storage_size(1_ip)/8

      bytes = INTEGER_BYTES*(int(data%fem%mesh%n_nodes, lp) + int(data%fem%mesh%n_elements, lp)) &
              + 4*REAL_BYTES*int(data%fem%mesh%n_nodes, lp)
   end function list_bytes

   !> The first rank, or the ranks of the first host, that have too little.
   pure function find_shortage(ranks, growth, limit) result(short)
      type(rank_memory_t), intent(in) :: ranks(0:)
      integer(lp), intent(in) :: growth(0:)          !< (ranks) bytes
      integer(lp), intent(in) :: limit               !< bytes of each rank
      type(shortage_t) :: short
      logical :: is_here(0:size(ranks) - 1)
      integer(lp) :: needed, there
      integer(ip) :: r, i

      do r = 0, size(ranks, kind=ip) - 1
         needed = ranks(r)%held + growth(r)
         there = there_for(ranks(r), limit)
         if (needed > there) then
            short = shortage_t(.true., r, 1_ip, needed, there)
            return
         end if
      end do
      do r = 0, size(ranks, kind=ip) - 1
         is_here = [(ranks(i)%host == ranks(r)%host, i=0, size(ranks, kind=ip) - 1)]
         if (findloc(is_here, .true., dim=1) /= r + 1) cycle
         needed = sum(ranks%held + growth, mask=is_here)
         there = together(minval(ranks%of_host, mask=is_here), sum(ranks%held + ranks%free, mask=is_here))
         if (needed > there) then
            short = shortage_t(.true., r, count(is_here, kind=ip), needed, there)
            return
         end if
      end do
   end function find_shortage

   !> What a rank can hold by itself.
   elemental integer(lp) function there_for(rank, limit) result(bytes)
      type(rank_memory_t), intent(in) :: rank
      integer(lp), intent(in) :: limit               !< bytes

      bytes = min(limit, together(min(rank%own, rank%of_host), rank%held + rank%free))
   end function there_for

   !> Without an overflow where the system does not tell.
   elemental integer(lp) function together(left, held)
      integer(lp), intent(in) :: left, held

      together = left + min(held, huge(left) - left)
   end function together

   subroutine tell(data, scene, who, short, status)
      class(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: who            !< e.g. 'rank 1 of 2 needs'
      type(shortage_t), intent(in) :: short
      type(status_t), intent(inout) :: status
      type(message_t) :: message

      status%code = STATUS_DECK
      if (allocated(status%text)) deallocate (status%text)   ! the message tells it
      message%severity = SEVERITY_ERROR
      message%id = 'E-MEMORY'
      if (allocated(data%model%deck_path)) message%file = data%model%deck_path
      message%text = who//' about '//memory_text(short%needed)//' of memory for the scene, '//to_text(scene%n_dofs)// &
                     ' free displacements and '//to_text(scene%n_normal + scene%n_tangential)//' contact unknowns, there are '// &
                     memory_text(short%there)
      message%expected = 'a coarser mesh or fewer contact points, or more memory'
      if (short%first > 0 .or. short%n > 1) message%expected = 'more ranks, '//message%expected//' for each'
      call add_message(message)
   end subroutine tell

   !> 'rank 1 (host node7) needs'
   function who_text(ranks, short) result(text)
      type(rank_memory_t), intent(in) :: ranks(0:)
      type(shortage_t), intent(in) :: short
      character(len=:), allocatable :: text
      integer(ip) :: r
      logical :: several_hosts

      several_hosts = .false.
      do r = 1, size(ranks, kind=ip) - 1
         several_hosts = several_hosts .or. ranks(r)%host /= ranks(0)%host
      end do
      if (short%n > 1) then
         text = 'the '//to_text(short%n)//' ranks of '
         if (several_hosts) then
            text = text//'host '//ranks(short%first)%host//' need'
         else
            text = text//'this machine need'
         end if
      else
         text = 'rank '//to_text(short%first)
         if (several_hosts) text = text//' (host '//ranks(short%first)%host//')'
         text = text//' of '//to_text(size(ranks, kind=ip))//' needs'
      end if
   end function who_text

end module atrito_rank_check
