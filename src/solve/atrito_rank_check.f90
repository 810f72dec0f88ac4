!> Whether the ranks can hold a scene that is shared out, asked of each before its part is made.
!>
!> A rank has to find what it needs below its own limit (`ulimit -v`), and all ranks of a host together in what the host has. Where
!> that does not suffice, it is told for how many ranks it would do: the number is doubled, and the scene shared out again, until it
!> fits or is more than MOST_RANKS. The ranks that come stand on hosts like the ones that there are, as many on each, and have the
!> least limit of the others.
module atrito_rank_check
   use atrito_kinds, only: ip, lp
   use atrito_memory, only: memory_text
   use atrito_messages, only: message_t, add_message, SEVERITY_ERROR
   use atrito_part_bytes, only: part_bytes_t, count_parts, estimate_parts, scale_parts, spread_over_parts
   use atrito_rank_forecast, only: first_rank_least, forecast_ranks
   use atrito_rank_memory, only: rank_memory_t, ask_for_memory, own_memory
   use atrito_ranked_parts, only: ranked_parts_t
   use atrito_results, only: scene_t
   use atrito_scene_data, only: scene_data_t
   use atrito_shared_scene, only: shared_scene_t
   use atrito_shares, only: shares_t, make_shares
   use atrito_status, only: status_t, STATUS_DECK
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: check_first_rank, check_ranks, shortage_t, find_shortage, more_ranks, PARTS_LEAST, PARTS_ESTIMATED, PARTS_COUNTED, &
             PARTS_THERE

   !> How well it is known what the parts take: no less than a quarter of the estimate; they are estimated, and counted where that
   !> does not fit; counted in any case; the ranks have assembled them and told.
   integer, parameter :: PARTS_LEAST = 1, PARTS_ESTIMATED = 2, PARTS_COUNTED = 3, PARTS_THERE = 4

   !> Who has too little memory.
   type :: shortage_t
      logical :: is_there = .false.
      integer(ip) :: first = 0                       !< rank
      integer(ip) :: n = 1                           !< ranks: more than one share a host
      integer(lp) :: needed = 0, there = 0           !< bytes, with what is held
   end type shortage_t

   integer(ip), parameter :: MOST_RANKS = 1024_ip

contains

   !> Before the scene is shared out: what the first rank needs however many there are, and to cut bodies. status: as check_ranks.
   subroutine check_first_rank(data, limit, scene, status)
      type(scene_data_t), intent(in) :: data
      integer(lp), intent(in) :: limit               !< bytes
      type(scene_t), intent(in) :: scene             !< with its bodies
      type(status_t), intent(inout) :: status
      integer(lp), parameter :: CUT_BYTES = 400_lp   !< METIS, for each element
      type(rank_memory_t) :: first
      type(shortage_t) :: short

      call own_memory(first)
      short%needed = first%held + max(first_rank_least(data, scene), CUT_BYTES*data%fem%mesh%n_elements)
      short%there = there_for(first, limit)
      if (short%needed > short%there) call tell(data, scene, 'rank 0 needs', short, no_number_text(short%needed), status)
   end subroutine check_first_rank

   !> status: STATUS_DECK, and an error, when a rank or the ranks of a host need more than there is.
   subroutine check_ranks(data, limit, known, scene, status)
      type(scene_data_t), intent(in) :: data         !< shared out
      integer(lp), intent(in) :: limit               !< bytes of each rank; what there is counts where it is less
      integer, intent(in) :: known                   !< PARTS_*
      type(scene_t), intent(inout) :: scene          !< with its bodies; on return with the forecast of the first rank
      type(status_t), intent(inout) :: status
      type(rank_memory_t), allocatable :: ranks(:)
      type(part_bytes_t) :: expected, parts
      type(shortage_t) :: short
      logical :: counted

      call ask_for_memory(ranks)
      call estimate_parts(data%fem, data%shares, expected)
      parts = expected
      counted = known /= PARTS_ESTIMATED
      if (known == PARTS_LEAST) call quarter(parts)
      if (known == PARTS_THERE) call take_told(data, parts)
      if (known == PARTS_COUNTED) call count_parts(data%fem, data%shares, parts)
      call judge(parts)
      if (short%is_there .and. .not. counted) then
         call count_parts(data%fem, data%shares, parts)
         call judge(parts)
      end if
      if (short%is_there) call refuse(data, scene, ranks, limit, short, parts, expected, status)

   contains

      subroutine judge(of_parts)
         type(part_bytes_t), intent(in) :: of_parts
         integer(lp) :: growth(0:data%shares%n_ranks - 1)

         growth = forecast_ranks(data, scene, data%shares, of_parts, known == PARTS_THERE)
         short = find_shortage(ranks, growth, limit)
         scene%memory = max(scene%peak_before, ranks(0)%held + growth(0))
      end subroutine judge

   end subroutine check_ranks

   !> Elements that are all equal take so little.
   pure subroutine quarter(parts)
      type(part_bytes_t), intent(inout) :: parts

      parts%held = parts%held/4
      parts%most = parts%most/4
   end subroutine quarter

   !> What the ranks told when they had assembled their parts.
   subroutine take_told(data, parts)
      type(scene_data_t), intent(in) :: data
      type(part_bytes_t), intent(inout) :: parts     !< as they are expected
      integer(lp) :: told(data%shares%n_ranks)

      select type (scene => data%assembled)
      type is (shared_scene_t)
         select type (of_ranks => scene%parts)
         type is (ranked_parts_t)
            told = of_ranks%solving_of_ranks(data%shares%n_ranks)
            told(1) = told(1) + scene%solving_bytes() - of_ranks%solving_bytes()    ! vectors of the whole scene
            call spread_over_parts(data%shares, told, parts)
         end select
      end select
   end subroutine take_told

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

   !> As many ranks as there would be: those that come are like the least of those that there are, and stand together on hosts like
   !> the least, as many on each.
   pure function more_ranks(ranks, n) result(more)
      type(rank_memory_t), intent(in) :: ranks(0:)   !< two or more
      integer(ip), intent(in) :: n
      type(rank_memory_t) :: more(0:n - 1)
      integer(ip) :: r, i, per_host, most

      most = 1
      do r = 0, size(ranks, kind=ip) - 1
         per_host = count([(ranks(i)%host == ranks(r)%host, i=0, size(ranks, kind=ip) - 1)], kind=ip)
         most = max(most, per_host)
      end do
      do r = 0, n - 1
         if (r < size(ranks)) then
            more(r) = ranks(r)
         else
            more(r)%held = maxval(ranks(1:)%held)
            more(r)%own = minval(ranks(1:)%own)
            more(r)%of_host = minval(ranks%of_host)
            more(r)%host = 'another '//to_text((r - size(ranks, kind=ip))/most)
         end if
      end do
   end function more_ranks

   !> Tells who has too little, and for how many ranks it would do.
   subroutine refuse(data, scene, ranks, limit, short, parts, expected, status)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene
      type(rank_memory_t), intent(in) :: ranks(0:)
      integer(lp), intent(in) :: limit
      type(shortage_t), intent(in) :: short
      type(part_bytes_t), intent(in) :: parts, expected
      type(status_t), intent(inout) :: status
      integer(ip) :: enough
      integer(lp) :: least

      least = ranks(0)%held + first_rank_least(data, scene)
      enough = 0
      if (least <= there_for(ranks(0), limit)) enough = ranks_that_suffice(data, scene, ranks, limit, parts, expected)
      if (enough > 0) then
         call tell(data, scene, who_text(ranks, short), short, to_text(enough)//' ranks, for which it would do with as much '// &
                   'memory for each, a coarser mesh or fewer contact points', status)
      else
         call tell(data, scene, who_text(ranks, short), short, no_number_text(least), status)
      end if
   end subroutine refuse

   function no_number_text(least) result(text)
      integer(lp), intent(in) :: least               !< bytes that the first rank needs in any case
      character(len=:), allocatable :: text

      text = 'a coarser mesh or fewer contact points, or more memory: no number of ranks up to '//to_text(MOST_RANKS)// &
             ' would do, for rank 0 alone needs '//memory_text(least)//' or more'
   end function no_number_text

   subroutine tell(data, scene, who, short, expected, status)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: who            !< e.g. 'rank 1 needs'
      type(shortage_t), intent(in) :: short
      character(len=*), intent(in) :: expected
      type(status_t), intent(inout) :: status
      type(message_t) :: message

      status%code = STATUS_DECK                      ! without a text: the message tells it
      message%severity = SEVERITY_ERROR
      message%id = 'E-MEMORY'
      if (allocated(data%model%deck_path)) message%file = data%model%deck_path
      message%text = who//' about '//memory_text(short%needed)//' of memory for the scene, '//to_text(scene%n_dofs)// &
                     ' free displacements and '//to_text(scene%n_normal + scene%n_tangential)//' contact unknowns, there are '// &
                     memory_text(short%there)
      message%expected = expected
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

   !> The least number of ranks that is found by doubling; 0: none up to MOST_RANKS.
   integer(ip) function ranks_that_suffice(data, scene, ranks, limit, parts, expected) result(n)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene
      type(rank_memory_t), intent(in) :: ranks(0:)
      integer(lp), intent(in) :: limit
      type(part_bytes_t), intent(in) :: parts, expected  !< of the shares that there are
      type(shares_t) :: shares
      type(part_bytes_t) :: others
      type(shortage_t) :: short

      n = size(ranks, kind=ip)
      do
         n = 2*n
         if (n > MOST_RANKS) exit
         call make_shares(data%fem, data%rows, n, shares)
         call estimate_parts(data%fem, shares, others)
         call scale_parts(parts, expected, others)
         short = find_shortage(more_ranks(ranks, n), forecast_ranks(data, scene, shares, others, .false.), limit)
         if (.not. short%is_there) return
      end do
      n = 0
   end function ranks_that_suffice

end module atrito_rank_check
