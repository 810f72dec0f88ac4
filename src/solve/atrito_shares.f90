!> The shares of the ranks in one scene: whole bodies by their predicted work (atrito_part_work), and bodies with more of it than a
!> fair share in pieces.
!>
!> Fair is the same work for all ranks, of many but the first (fair_share); what a body takes depends on how it is cut, and with it
!> what is fair. A body that has more is cut into pieces that are fair and what is left of it. Pieces of a fair share have a rank of
!> their own, all others are shared out over the contact graph. As long as one rank has far more than the mean, its heaviest piece
!> is halved. The same scene and number of ranks give the same shares.
module atrito_shares
   use atrito_assembly, only: fem_t, body_profile
   use atrito_bodies, only: body_t
   use atrito_contact_graph, only: contact_graph_t, begin_contact_graph, add_edge, add_rows, close_contact_graph, share_vertices, &
                                   add_greedily, unevenness
   use atrito_contact_rows, only: contact_rows_t
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, wp
   use atrito_multifrontal, only: cut_elements, sort_by_squares
   use atrito_part_work, only: body_work_t, share_of_work, work_of_body, work_of_share
   use atrito_profile, only: profile_t, mean_height
   implicit none (type, external)
   private
   public :: shares_t, share_t, top_t, make_shares, share_out, rank_of_elements, predict_work, is_worth_sharing, is_over_ranks
   public :: fair_share, LEAST_WORK
   public :: SHARE_NONE, SHARE_AUTO, SHARE_ALL

   !> A part of the scene: a body, or a piece of one.
   type :: share_t
      integer(ip) :: body = 0
      integer(ip) :: rank = 0                       !< 0..n_ranks - 1
      logical :: is_whole = .true.               !< the body is
      integer(ip) :: n_cuts = 0                  !< sides that it has by cuts
      real(wp) :: work = 0.0_wp                  !< predicted [operations]
      integer(ip), allocatable :: elements(:)    !< in the order of the body
      integer(ip), allocatable :: nodes(:)       !< of a piece, in the order of the body; a whole body has its own
   end type share_t

   !> The unknowns of a body that its parts leave: those of nodes that several parts have, and the retained ones of the body.
   type :: top_t
      integer(ip) :: n = 0
      integer(ip) :: n_kept = 0                  !< the last ones: the retained equations of the body
      integer(ip), allocatable :: equation(:)    !< (n) of the body, ascending
   end type top_t

   !> All parts, those of a body one after the other.
   type :: shares_t
      integer(ip) :: n = 0
      integer(ip) :: n_ranks = 1
      type(share_t), allocatable :: list(:)      !< (n)
      integer(ip), allocatable :: first(:)       !< (bodies + 1) parts of body b: first(b) to first(b + 1) - 1; rigid ones: none
      type(top_t), allocatable :: tops(:)        !< (bodies)
   end type shares_t

   !> What the user asks for.
   integer, parameter :: SHARE_NONE = 0, SHARE_AUTO = 1, SHARE_ALL = 2

   !> Scenes of less work, some 2e5 displacements in one body or 0.3 s of one process, are not shared out.
   real(wp), parameter :: LEAST_WORK = 1.0e10_wp
   !> What each body counts for besides: of many bodies it is the contact between them that takes long.
   real(wp), parameter :: WORK_BESIDES = 1.0e7_wp
   !> A piece with this share of what is fair has a rank of its own; less than this share of a piece is no piece of its own.
   real(wp), parameter :: NEARLY_FAIR = 0.9_wp, LEAST_REST = 0.1_wp
   !> What the first of many ranks has besides, over the work of all.
   real(wp), parameter :: BESIDES = 0.2_wp
   !> The largest work of a rank over the mean for which nothing is cut any more, and pieces of the fair share that are not.
   real(wp), parameter :: EVEN_ENOUGH = 1.2_wp, LEAST_CUT = 0.05_wp
   !> For each rank, so that it ends.
   integer(ip), parameter :: MOST_HALVINGS = 2_ip
   !> Halvings of an interval in which it is found what is fair.
   integer, parameter :: HALVINGS = 30

contains

   !> What the work of all bodies depends on; nothing of rigid ones.
   function measure_bodies(fem) result(bodies)
      type(fem_t), intent(in) :: fem
      type(body_work_t) :: bodies(fem%bodies%n)
      type(profile_t) :: profile
      integer(ip) :: b

      do b = 1, fem%bodies%n
         if (fem%bodies%list(b)%is_rigid) cycle
         call body_profile(fem, b, profile)
         bodies(b)%n = real(profile%n - profile%n_retained, wp)
         bodies(b)%width = mean_height(profile)
         bodies(b)%n_kept = real(profile%n_retained, wp)
      end do
   end function measure_bodies

   !> The predicted work of all bodies.
   function predict_work(fem) result(work)
      type(fem_t), intent(in) :: fem
      real(wp) :: work(fem%bodies%n)

      work = merge(0.0_wp, work_of_body(measure_bodies(fem)), fem%bodies%list(:fem%bodies%n)%is_rigid)
   end function predict_work

   !> Whether the scene goes over the ranks.
   logical function is_worth_sharing(fem, n_ranks, asked)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: n_ranks
      integer, intent(in) :: asked               !< SHARE_*

      is_worth_sharing = n_ranks > 1 .and. asked /= SHARE_NONE
      if (.not. is_worth_sharing .or. asked /= SHARE_AUTO) return
      associate (n_bodies => real(count(.not. fem%bodies%list(:fem%bodies%n)%is_rigid), wp))
         is_worth_sharing = sum(predict_work(fem)) + WORK_BESIDES*n_bodies >= LEAST_WORK
      end associate
   end function is_worth_sharing

   !> Whether several ranks have a part.
   pure logical function is_over_ranks(shares)
      type(shares_t), allocatable, intent(in) :: shares

      is_over_ranks = allocated(shares)
      if (is_over_ranks) is_over_ranks = shares%n > 0
      if (is_over_ranks) is_over_ranks = any(shares%list%rank /= shares%list(1)%rank)
   end function is_over_ranks

   !> Shares out the elements of all bodies over the ranks where it is worth it; else there is nothing on return.
   subroutine share_out(fem, rows, n_ranks, asked, shares, rank_of)
      type(fem_t), intent(in) :: fem             !< its equations are numbered
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: n_ranks         !< >= 1
      integer, intent(in) :: asked               !< SHARE_*
      type(shares_t), allocatable, intent(out) :: shares
      integer(ip), allocatable, intent(out) :: rank_of(:) !< (n_elements)

      if (.not. is_worth_sharing(fem, n_ranks, asked)) return
      allocate (shares)
      call make_shares(fem, rows, n_ranks, shares)
      rank_of = rank_of_elements(fem, shares)
   end subroutine share_out

   !> The rank that has each element; those of rigid bodies are the first one's.
   pure function rank_of_elements(fem, shares) result(rank_of)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(in) :: shares
      integer(ip) :: rank_of(fem%mesh%n_elements), p

      rank_of = 0
      do p = 1, shares%n
         rank_of(shares%list(p)%elements) = shares%list(p)%rank
      end do
   end function rank_of_elements

   !> Shares out the elements of all bodies.
   subroutine make_shares(fem, rows, n_ranks, shares)
      type(fem_t), intent(in) :: fem             !< its equations are numbered
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: n_ranks         !< >= 1
      type(shares_t), intent(out) :: shares
      type(body_work_t) :: bodies(fem%bodies%n)
      real(wp) :: fair
      type(share_t), allocatable :: none(:)
      integer(ip) :: b, i, heaviest

      shares%n_ranks = n_ranks
      bodies = measure_bodies(fem)
      fair = fair_work(pack(bodies,.not. fem%bodies%list(:fem%bodies%n)%is_rigid), n_ranks)
      allocate (none(0))
      call move_alloc(none, shares%list)
      do b = 1, fem%bodies%n
         if (.not. fem%bodies%list(b)%is_rigid) call add_body(fem, b, bodies(b), pieces_of(bodies(b), fair), shares%list)
      end do
      call give_to_ranks(fem, rows, fair, n_ranks, shares%list)
      do i = 1, MOST_HALVINGS*n_ranks
         call find_too_heavy(shares%list, fair, n_ranks, heaviest)
         if (heaviest == 0) exit
         call halve(fem, bodies, heaviest, shares%list)
         call give_to_ranks(fem, rows, fair, n_ranks, shares%list)
      end do
      call arrange(fem, shares)
   end subroutine make_shares

   !> That of each rank but the first, of all the work. Two ranks have the same: it is time that counts. Of many the first one has
   !> less: it has the mesh and the results of the whole scene besides, and would be the largest.
   pure real(wp) function fair_share(n_ranks) result(share)
      integer(ip), intent(in) :: n_ranks         !< >= 1
      real(wp) :: n

      n = real(n_ranks, wp)
      share = 1.0_wp
      if (n_ranks > 1) share = min((1.0_wp + BESIDES*(n - 2.0_wp)/n)/n, 1.0_wp/(n - 1.0_wp))
   end function fair_share

   !> The work of a rank but the first, where bodies are cut into pieces of it: the least that is enough for all.
   pure real(wp) function fair_work(bodies, n_ranks) result(fair)
      type(body_work_t), intent(in) :: bodies(:)
      integer(ip), intent(in) :: n_ranks
      real(wp) :: low, middle
      integer :: i

      fair = sum(work_of_body(bodies))
      low = fair_share(n_ranks)*fair             ! cuts take more
      do i = 1, HALVINGS
         middle = 0.5_wp*(low + fair)
         if (fair_share(n_ranks)*work_in_pieces(bodies, middle) > middle) then
            low = middle
         else
            fair = middle
         end if
      end do
   end function fair_work

   !> All of it, where bodies are cut into fair pieces.
   pure real(wp) function work_in_pieces(bodies, fair) result(work)
      type(body_work_t), intent(in) :: bodies(:)
      real(wp), intent(in) :: fair
      real(wp), allocatable :: target(:)
      integer(ip) :: b

      work = 0.0_wp
      do b = 1, size(bodies, kind=ip)
         target = pieces_of(bodies(b), fair)
         work = work + sum(work_of_share(bodies(b), target, cuts_of(size(target, kind=ip))))
      end do
   end function work_in_pieces

   !> Sides that pieces have by cuts: two of one body have one in common.
   pure integer(ip) function cuts_of(n_pieces) result(n)
      integer(ip), intent(in) :: n_pieces

      n = min(n_pieces - 1_ip, 2_ip)
   end function cuts_of

   !> The shares of a body's pieces in it; one piece: it stays whole.
   pure function pieces_of(body, fair) result(target)
      type(body_work_t), intent(in) :: body
      real(wp), intent(in) :: fair               !< work
      real(wp), allocatable :: target(:)
      integer(ip) :: i, n
      real(wp) :: share

      if (work_of_body(body) <= (1.0_wp + LEAST_REST)*fair) then
         target = [1.0_wp]
         return
      end if
      share = share_of_work(body, fair, cuts_of(2_ip))
      if (2.0_wp + LEAST_REST < 1.0_wp/share) share = share_of_work(body, fair, cuts_of(3_ip))
      n = max(1_ip, int(1.0_wp/share + 1.0_wp - LEAST_REST, ip))
      target = [[(share, i=1, n - 1)], 1.0_wp - real(n - 1, wp)*share]
      if (target(n) >= (1.0_wp - LEAST_REST)*share) target = 1.0_wp/real(n, wp)
   end function pieces_of

   !> The elements of a body that is cut are sorted: neighbours are near in memory on their ranks.
   subroutine add_body(fem, b, body, target, list)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      type(body_work_t), intent(in) :: body
      real(wp), intent(in) :: target(:)          !< (pieces)
      type(share_t), allocatable, intent(inout) :: list(:)
      type(share_t) :: whole
      integer(ip), allocatable :: order(:)

      whole%body = b
      whole%work = work_of_body(body)
      whole%elements = fem%bodies%list(b)%elements
      if (size(target) > 1) then
         call sort_by_squares(fem%mesh%x, fem%mesh%nodes(1, whole%elements), order)
         whole%elements = whole%elements(order)
      end if
      call append(fem, body, whole, target, list)
   end subroutine add_body

   !> Adds the pieces of a part to a list of parts.
   subroutine append(fem, body, part, target, list)
      type(fem_t), intent(in) :: fem
      type(body_work_t), intent(in) :: body
      type(share_t), intent(in) :: part
      real(wp), intent(in) :: target(:)          !< (pieces)
      type(share_t), allocatable, intent(inout) :: list(:)
      type(share_t), allocatable :: longer(:)
      integer(ip), allocatable :: piece_of(:, :), first(:), member(:)
      integer(ip) :: i, n, before

      allocate (piece_of(1, size(part%elements)))
      call cut_elements(part%elements, fem%mesh%nodes, fem%mesh%shape, fem%mesh%x, target, piece_of(1, :))
      call list_holders(size(target, kind=ip), piece_of, first, member)
      before = size(list, kind=ip)
      n = 0
      allocate (longer(before + size(target)))
      do i = 1, before
         call move_share(list(i), longer(i))
      end do
      do i = 1, size(target, kind=ip)
         if (first(i) == first(i + 1)) cycle     ! of few elements
         n = n + 1
         associate (piece => longer(before + n), own => part%elements(member(first(i):first(i + 1) - 1)))
            piece%body = part%body
            piece%elements = own
            piece%is_whole = part%is_whole .and. size(own) == size(part%elements)
            if (.not. piece%is_whole) piece%n_cuts = part%n_cuts + cuts_of(size(target, kind=ip))
            piece%work = work_of_share(body, real(size(own), wp)/real(size(fem%bodies%list(part%body)%elements), wp), piece%n_cuts)
         end associate
      end do
      if (before + n < size(longer)) then
         list = longer(:before + n)
      else
         call move_alloc(longer, list)
      end if
   end subroutine append

   subroutine move_share(from, to)
      type(share_t), intent(inout) :: from, to

      to%body = from%body
      to%rank = from%rank
      to%is_whole = from%is_whole
      to%n_cuts = from%n_cuts
      to%work = from%work
      call move_alloc(from%elements, to%elements)
   end subroutine move_share

   !> The rank of each part: pieces of a fair share have one to themselves, the others are shared out over the contact graph.
   subroutine give_to_ranks(fem, rows, fair, n_ranks, list)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      real(wp), intent(in) :: fair
      integer(ip), intent(in) :: n_ranks
      type(share_t), intent(inout) :: list(:)
      type(contact_graph_t) :: graph
      integer(ip) :: rank_of(size(list)), greedy(size(list)), n_full, p
      integer(ip), allocatable :: rest(:), rank_of_rest(:)
      real(wp) :: load(n_ranks)

      n_full = 0
      rank_of = 0
      do p = 1, size(list, kind=ip)
         if (list(p)%work < NEARLY_FAIR*fair .or. n_full == n_ranks - 1) cycle
         rank_of(p) = n_ranks - n_full           ! what is left over is for the first ones
         n_full = n_full + 1
      end do
      rest = pack([(p, p=1, size(list, kind=ip))], rank_of == 0)
      allocate (rank_of_rest(size(rest)))
      if (size(rest) > 0) then
         call make_graph(fem, rows, list, rest, graph)
         call share_vertices(graph, list(rest)%work, n_ranks - n_full, rank_of_rest)
      end if
      rank_of(rest) = rank_of_rest
      load = 0.0_wp
      call add_greedily(list%work, load, greedy)
      if (unevenness(list%work, rank_of, n_ranks) > max(EVEN_ENOUGH, unevenness(list%work, greedy, n_ranks))) rank_of = greedy
      list%rank = rank_of - 1
   end subroutine give_to_ranks

   !> Parts are neighbours by contact points, by bilateral rows and by the nodes of cuts.
   subroutine make_graph(fem, rows, list, vertices, graph)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(share_t), intent(in) :: list(:)
      integer(ip), intent(in) :: vertices(:)     !< places in the list
      type(contact_graph_t), intent(out) :: graph
      integer(ip), allocatable :: vertex_of(:), seen(:)
      integer(ip) :: v, i, k, node

      allocate (vertex_of(fem%mesh%n_nodes), seen(fem%mesh%n_nodes), source=0_ip)
      call begin_contact_graph(size(vertices, kind=ip), graph)
      do v = 1, size(vertices, kind=ip)
         associate (part => list(vertices(v)))
            if (part%is_whole) then
               vertex_of(fem%bodies%list(part%body)%nodes) = v
               cycle
            end if
            do i = 1, size(part%elements, kind=ip)
               do k = 1, fem%mesh%shape(part%elements(i))
                  node = fem%mesh%nodes(k, part%elements(i))
                  if (vertex_of(node) == 0) vertex_of(node) = v
                  if (seen(node) /= v) call add_edge(vertex_of(node), v, graph)
                  seen(node) = v
               end do
            end do
         end associate
      end do
      call add_rows(rows, vertex_of, graph)
      call close_contact_graph(graph)
   end subroutine make_graph

   !> The heaviest part of the rank that has too much; 0: none has, or it is not worth a cut.
   pure subroutine find_too_heavy(list, fair, n_ranks, heaviest)
      type(share_t), intent(in) :: list(:)
      real(wp), intent(in) :: fair
      integer(ip), intent(in) :: n_ranks
      integer(ip), intent(out) :: heaviest
      real(wp) :: load(0:n_ranks - 1)
      integer(ip) :: p

      heaviest = 0
      load = 0.0_wp
      do p = 1, size(list, kind=ip)
         load(list(p)%rank) = load(list(p)%rank) + list(p)%work
      end do
      if (maxval(load) <= EVEN_ENOUGH*fair) return
      heaviest = maxloc(list%work, dim=1, kind=ip, mask=list%rank == maxloc(load, dim=1) - 1)
      if (list(heaviest)%work < LEAST_CUT*fair .or. size(list(heaviest)%elements) < 2) heaviest = 0
   end subroutine find_too_heavy

   subroutine halve(fem, bodies, heaviest, list)
      type(fem_t), intent(in) :: fem
      type(body_work_t), intent(in) :: bodies(:)
      integer(ip), intent(in) :: heaviest
      type(share_t), allocatable, intent(inout) :: list(:)
      type(share_t), allocatable :: others(:)
      type(share_t) :: part
      integer(ip) :: p

      allocate (others(size(list) - 1))
      do p = 1, size(list, kind=ip)
         if (p < heaviest) call move_share(list(p), others(p))
         if (p > heaviest) call move_share(list(p), others(p - 1))
      end do
      call move_share(list(heaviest), part)
      call move_alloc(others, list)
      call append(fem, bodies(part%body), part, [0.5_wp, 0.5_wp], list)
   end subroutine halve

   !> Puts the parts of each body one after the other, and finds what they have in common.
   subroutine arrange(fem, shares)
      type(fem_t), intent(in) :: fem
      type(shares_t), intent(inout) :: shares
      type(share_t), allocatable :: sorted(:)
      integer(ip), allocatable :: place(:), next(:)
      integer(ip) :: p, b

      shares%n = size(shares%list, kind=ip)
      allocate (sorted(shares%n), shares%tops(fem%bodies%n), place(fem%mesh%n_nodes))
      allocate (shares%first(fem%bodies%n + 1), source=0_ip)
      do p = 1, shares%n
         shares%first(shares%list(p)%body + 1) = shares%first(shares%list(p)%body + 1) + 1
      end do
      shares%first(1) = 1
      do b = 1, fem%bodies%n
         shares%first(b + 1) = shares%first(b) + shares%first(b + 1)
      end do
      next = shares%first
      do p = 1, shares%n
         b = shares%list(p)%body
         call move_share(shares%list(p), sorted(next(b)))
         next(b) = next(b) + 1
      end do
      call move_alloc(sorted, shares%list)
      do b = 1, fem%bodies%n
         associate (parts => shares%list(shares%first(b):shares%first(b + 1) - 1))
            call find_border(fem, b, place, parts, shares%tops(b))
         end associate
      end do
   end subroutine arrange

   !> The nodes of each part of a body, and the unknowns that they leave.
   subroutine find_border(fem, b, place, parts, top)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b
      integer(ip), intent(inout) :: place(:)     !< (nodes of the mesh) used for the nodes of the body
      type(share_t), intent(inout) :: parts(:)
      type(top_t), intent(out) :: top
      logical, allocatable :: is_border(:)

      associate (body => fem%bodies%list(b))
         allocate (is_border(size(body%nodes)), source=.false.)
         if (size(parts) > 1) call list_nodes(fem, body, place, parts, is_border)
         call list_unknowns(fem, body, is_border, top)
      end associate
   end subroutine find_border

   subroutine list_nodes(fem, body, place, parts, is_border)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      integer(ip), intent(inout) :: place(:)     !< (nodes of the mesh)
      type(share_t), intent(inout) :: parts(:)
      logical, intent(inout) :: is_border(:)     !< (nodes of the body) more than one part has it
      integer(ip), allocatable :: found(:)       !< places of the nodes of one part after the other
      integer(ip), allocatable :: last(:), n_parts(:)
      integer(ip) :: i, before, n, p

      place(body%nodes) = [(i, i=1, size(body%nodes, kind=ip))]
      allocate (last(size(body%nodes)), n_parts(size(body%nodes)), source=0_ip)
      allocate (found(sum(fem%mesh%shape(body%elements))))
      n = 0
      do p = 1, size(parts, kind=ip)
         before = n
         call find_nodes(fem, parts(p)%elements, place, p, last, found, n)
         n_parts(found(before + 1:n)) = n_parts(found(before + 1:n)) + 1
         parts(p)%nodes = body%nodes(found(before + 1:n))
      end do
      is_border = n_parts > 1
   end subroutine list_nodes

   !> The nodes of the elements of a part, each once, as they come.
   pure subroutine find_nodes(fem, elements, place, p, last, found, n)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:), place(:), p
      integer(ip), intent(inout) :: last(:)      !< part that was found last at each node
      integer(ip), intent(inout) :: found(:), n
      integer(ip) :: i, k, node

      do i = 1, size(elements, kind=ip)
         do k = 1, fem%mesh%shape(elements(i))
            node = place(fem%mesh%nodes(k, elements(i)))
            if (last(node) == p) cycle
            last(node) = p
            n = n + 1
            found(n) = node
         end do
      end do
   end subroutine find_nodes

   pure subroutine list_unknowns(fem, body, is_border, top)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      logical, intent(in) :: is_border(:)        !< (nodes of the body)
      type(top_t), intent(out) :: top
      integer(ip) :: i, dof, k

      top%n_kept = body%n_retained
      allocate (top%equation(2*count(is_border) + top%n_kept))
      do i = 1, size(is_border, kind=ip)
         if (.not. is_border(i)) cycle
         do dof = 1, 2
            k = fem%bodies%equation(dof, body%nodes(i))
            if (k < 1 .or. k > body%n - body%n_retained) cycle
            top%n = top%n + 1
            top%equation(top%n) = k
         end do
      end do
      top%equation(top%n + 1:top%n + top%n_kept) = [(k, k=body%n - body%n_retained + 1, body%n)]
      top%n = top%n + top%n_kept
      top%equation = top%equation(:top%n)
   end subroutine list_unknowns

end module atrito_shares
