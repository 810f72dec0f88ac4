!> Whether the ranks can hold a scene that is shared out: asked of each before its part is made, and before that is factored.
!>
!> A rank has to find what it needs below its own limit (`ulimit -v`), and all ranks of a host together in what the host has. With
!> n nodes and e elements of a rank it holds the larger of
!>
!>     solving      its part, as it tells when it has assembled it; before that METIS, which orders its elements
!>     recovering   mesh of its region, and the buffer               2 (72 n + 64 e)
!>                  stresses and patches                             recovery_bytes(n, e)
!>
!> and of the smaller one what does not serve again: memory goes to pieces, on the first rank less, whose arrays are of the whole
!> scene. A region has some rings of elements more than the rank: RINGS for each node of a border. The first rank has loads,
!> displacements, reactions, stresses of the whole scene besides, and a part or a region of another rank while it is sent.
module atrito_rank_memory
   use atrito_files, only: read_system_line
   use atrito_kinds, only: ip, lp, wp
   use atrito_memory, only: address_space_left, memory_text, resident_memory, shared_memory_left
   use atrito_messages, only: message_t, add_message, SEVERITY_ERROR
   use atrito_mpi, only: rank_count, receive_buffer, send_buffer
   use atrito_buffer, only: buffer_t, put, take
   use atrito_rank_services, only: send_to_others, SERVICE_MEMORY
   use atrito_results, only: scene_t
   use atrito_scene_data, only: scene_data_t
   use atrito_scene_forecast, only: field_library_bytes, load_bytes, recovery_bytes, request_bytes, with_holes, LATER_BYTES
   use atrito_shared_scene, only: shared_scene_t
   use atrito_solver_choice, only: SOLVER_SPARSE
   use atrito_status, only: status_t, STATUS_DECK
   use atrito_strings, only: to_text
   use atrito_system, only: reusable_memory
   implicit none (type, external)
   private
   public :: check_ranks, serve_memory, rank_memory_t, shortage_t, find_shortage

   !> What a rank holds, and what it can still get.
   type :: rank_memory_t
      character(len=:), allocatable :: host      !< its name
      integer(lp) :: held = 0                    !< bytes that the rank needs as they are
      integer(lp) :: free = 0                    !< bytes that it has besides: they were given back, and serve again
      integer(lp) :: own = huge(1_lp)            !< bytes that it may still get by its own limit
      integer(lp) :: of_host = huge(1_lp)        !< bytes that all processes of its host can still get together
   end type rank_memory_t

   !> Who has too little memory.
   type :: shortage_t
      logical :: is_there = .false.              !< else nobody lacks any
      integer(ip) :: first = 0                   !< rank
      integer(ip) :: n = 1                       !< ranks: more than one share a host
      integer(lp) :: needed = 0, there = 0       !< bytes, with what is held
   end type shortage_t

   integer(lp), parameter :: MESH_NODE = 72_lp, MESH_ELEMENT = 64_lp
   !> METIS, for each element.
   integer(lp), parameter :: CUT_BYTES = 400_lp
   !> Buffers of MPI.
   integer(lp), parameter :: BUFFERS = 4000000_lp
   !> Elements in the rings of a region, for each node of a border.
   integer(lp), parameter :: RINGS = 5_lp
   !> On the first rank, for each node and element of the scene: loads, displacements, reactions and stresses as a whole, lists of
   !> who has what, while it is solved and later.
   integer(lp), parameter :: WHOLE_NODE = 150_lp, WHOLE_ELEMENT = 16_lp, LIST_NODE = 36_lp, LIST_ELEMENT = 4_lp
   !> Of the smaller of two phases: what does not serve again, on the first rank and on others.
   real(wp), parameter :: LEFT_BEHIND(2) = [0.13_wp, 0.3_wp]

contains

   !> status: STATUS_DECK, and an error, when a rank or the ranks of a host need more than there is.
   subroutine check_ranks(data, limit, scene, status)
      class(scene_data_t), intent(in) :: data        !< shared out, or about to be
      integer(lp), intent(in) :: limit               !< bytes of each rank; what there is counts where it is less
      type(scene_t), intent(inout) :: scene          !< on return with the forecast of the first rank
      type(status_t), intent(inout) :: status        !< STATUS_DECK where there is a shortage; else as it was
      type(rank_memory_t), allocatable :: ranks(:)
      integer(lp), allocatable :: growth(:)
      type(shortage_t) :: short

      call ask_for_memory(ranks)
      call forecast_ranks(data, size(ranks, kind=ip), growth)
      short = find_shortage(ranks, growth, limit)
      scene%memory = max(scene%peak_before, ranks(0)%held + growth(0))
      if (short%is_there) call add_shortage(who_text())

   contains

      subroutine add_shortage(who)
         character(len=*), intent(in) :: who            !< e.g. 'rank 1 of 2 needs'
         type(message_t) :: message

         status%code = STATUS_DECK
         if (allocated(status%text)) deallocate (status%text)   ! the message tells it
         message%severity = SEVERITY_ERROR
         message%id = 'E-MEMORY'
         if (allocated(data%model%deck_path)) message%file = data%model%deck_path
         message%text = who//' about '//memory_text(short%needed)//' of memory for the scene, '//to_text(scene%n_dofs)// &
                        ' free displacements and '//to_text(scene%n_normal + scene%n_tangential)// &
                        ' contact unknowns, there are '//memory_text(short%there)
         message%expected = 'a coarser mesh or fewer contact points, or more memory'
         if (short%first > 0 .or. short%n > 1) message%expected = 'more ranks, '//message%expected//' for each'
         call add_message(message)
      end subroutine add_shortage

      !> 'rank 1 (host node7) of 4 needs'
      function who_text() result(text)
         character(len=:), allocatable :: text, host
         integer(ip) :: r

         host = ''
         if (any([(ranks(r)%host /= ranks(0)%host, r=1, size(ranks, kind=ip) - 1)])) host = 'host '//ranks(short%first)%host
         if (short%n > 1) then
            if (len(host) == 0) host = 'this machine'
            text = 'the '//to_text(short%n)//' ranks of '//host//' need'
         else
            if (len(host) > 0) host = ' ('//host//')'
            text = 'rank '//to_text(short%first)//host//' of '//to_text(size(ranks, kind=ip))//' needs'
         end if
      end function who_text

   end subroutine check_ranks

   !> Asks all ranks.
   subroutine ask_for_memory(ranks)
      type(rank_memory_t), allocatable, intent(out) :: ranks(:)   !< (ranks) from 0
      type(buffer_t) :: request, answer
      integer(ip) :: rank
      real(wp), allocatable :: bytes(:)

      allocate (ranks(0:rank_count() - 1))
      call put(request, SERVICE_MEMORY)
      call send_to_others(request)
      do rank = 0, rank_count() - 1
         if (rank == 0) call put_own_memory(answer)
         if (rank > 0) call receive_buffer(answer, rank)
         call take(answer, ranks(rank)%host)
         call take(answer, bytes)
         ranks(rank)%held = int(bytes(1), lp)
         ranks(rank)%free = int(bytes(2), lp)
         ranks(rank)%own = int(bytes(3), lp)
         ranks(rank)%of_host = int(bytes(4), lp)
      end do
   end subroutine ask_for_memory

   !> The answer of another rank.
   subroutine serve_memory()
      type(buffer_t) :: answer

      call put_own_memory(answer)
      call send_buffer(answer, 0_ip)
   end subroutine serve_memory

   !> Of this rank: host, held, free, own, of_host.
   subroutine put_own_memory(buffer)
      type(buffer_t), intent(inout) :: buffer
      character(len=:), allocatable :: host
      integer(lp), parameter :: MOST = 2_lp**62      ! so much is no limit, and a number of double precision
      integer(lp) :: free
      logical :: found

      call read_system_line('/proc/sys/kernel/hostname', '', host, found)
      if (.not. found) host = ''
      free = min(reusable_memory(), resident_memory())
      call put(buffer, host)
      call put(buffer, real(min([resident_memory() - free, free, address_space_left(), shared_memory_left()], MOST), wp))
   end subroutine put_own_memory

   !> Growth of each rank [bytes]; before its part is there at the least.
   subroutine forecast_ranks(data, n_ranks, bytes)
      class(scene_data_t), intent(in) :: data
      integer(ip), intent(in) :: n_ranks
      integer(lp), allocatable, intent(out) :: bytes(:) !< (ranks) from 0
      integer(lp) :: nodes(0:n_ranks - 1), elements(0:n_ranks - 1), border(0:n_ranks - 1), solving(0:n_ranks - 1), sent
      integer(ip) :: p, r

      associate (mesh => data%fem%mesh, model => data%model)
         elements = mesh%n_elements/n_ranks
         border = 0
         solving = CUT_BYTES*elements
         solving(0) = CUT_BYTES*mesh%n_elements
         if (data%is_assembled) then
            select type (scene => data%assembled)
            type is (shared_scene_t)
               solving = scene%solving_of_ranks(n_ranks)
               elements = 0
               do p = 1, size(scene%parts, kind=ip)
                  elements(scene%parts(p)%rank) = scene%parts(p)%n_elements
                  border(scene%parts(p)%rank) = size(scene%parts(p)%shared)
               end do
            end select
         end if
         nodes = elements*mesh%n_nodes/max(1_ip, mesh%n_elements)
         sent = 2*maxval(MESH_NODE*nodes(1:) + MESH_ELEMENT*elements(1:))
         allocate (bytes(0:n_ranks - 1))
         do r = 1, n_ranks - 1
            bytes(r) = LATER_BYTES + BUFFERS + overlap(with_holes(SOLVER_SPARSE, solving(r)), recovering(r), LEFT_BEHIND(2))
         end do
         bytes(0) = LATER_BYTES + BUFFERS + field_library_bytes(data) &
                    + overlap(load_bytes(model) + LIST_NODE*mesh%n_nodes + LIST_ELEMENT*mesh%n_elements &
                              + with_holes(SOLVER_SPARSE, solving(0)), &
                              WHOLE_NODE*model%mesh%n_nodes + WHOLE_ELEMENT*model%mesh%n_elements + request_bytes(model, data) &
                              + recovering(0_ip) + sent, LEFT_BEHIND(1))
      end associate

   contains

      !> Two phases one after the other.
      pure integer(lp) function overlap(one, other, left_behind)
         integer(lp), intent(in) :: one, other
         real(wp), intent(in) :: left_behind

         overlap = max(one, other) + int(left_behind*real(min(one, other), wp), lp)
      end function overlap

      !> Stresses and patches of the rank's elements and of those in the rings round them.
      pure integer(lp) function recovering(r) result(held)
         integer(ip), intent(in) :: r

         associate (n => nodes(r) + RINGS*border(r)/2, e => elements(r) + RINGS*border(r)/2)
            held = 2*(MESH_NODE*n + MESH_ELEMENT*e) + recovery_bytes(data%model, n, e)
         end associate
      end function recovering

   end subroutine forecast_ranks

   !> The first rank, or the ranks of the first host, that have too little.
   pure function find_shortage(ranks, growth, limit) result(short)
      type(rank_memory_t), intent(in) :: ranks(0:)   !< what each holds and has
      integer(lp), intent(in) :: growth(0:)          !< (ranks) bytes
      integer(lp), intent(in) :: limit               !< bytes of each rank
      type(shortage_t) :: short
      logical :: is_here(0:size(ranks) - 1)
      integer(lp) :: needed, there
      integer(ip) :: r, i

      do r = 0, size(ranks, kind=ip) - 1
         needed = ranks(r)%held + growth(r)
         there = min(limit, together(min(ranks(r)%own, ranks(r)%of_host), ranks(r)%held + ranks(r)%free))
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

   !> Without an overflow where the system does not tell.
   elemental integer(lp) function together(left, held)
      integer(lp), intent(in) :: left, held

      together = left + min(held, huge(left) - left)
   end function together

end module atrito_rank_memory
