!> Contact that is found: the pairs that *CONTACT makes of the outlines of the bodies.
!>
!>   1. The outline of each body is a list of faces; each face looks along its normal for a face of another body, or for a rigid
!>      surface, no farther away than DISTANCE (look_around).
!>   2. The rules say whether the two may touch, and by which law: *CONTACT INCLUSIONS, EXCLUSIONS and PROPERTY ASSIGNMENT name
!>      surfaces, and a face belongs to several. Of several rules for two faces the last one counts.
!>   3. Of two bodies that look at each other one is the slave: the softer one; of two alike the one of finer faces; else the first.
!>      A face is a slave face where all of its points find the other body.
!>   4. Slave faces that follow each other on the outline are a chain; each part of it with the same other body and the same law
!>      becomes a pair.
module atrito_found_contact
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_body_names, only: name_bodies
   use atrito_build_contact, only: contact_rules_t, add_rule, last_rule, sort_rules, ANY_BODY
   use atrito_diagnostics, only: report_note, report_warning
   use atrito_build_context, only: build_context_t, keep_token
   use atrito_face_geometry, only: face_arc_length
   use atrito_faces, only: face_list_t
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, lp, wp
   use atrito_master, only: master_t, master_of_faces, master_of_segments
   use atrito_model, only: model_t, pair_t, surface_t, interaction_t, SURFACE_SEGMENTS
   use atrito_growth, only: numbers_of
   use atrito_outlines, only: outlines_t, sighting_t, list_outlines, look_around
   use atrito_nodal_points, only: finds_master
   use atrito_refined_members, only: faces_of_deck
   use atrito_sorting, only: sorted_places
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: find_contact

   !> The search for pairs. A party is a body, or a rigid surface that may take part: those come after the bodies.
   type :: search_t
      type(bodies_t) :: bodies                               !< of the elements
      type(outlines_t) :: outlines                           !< of all bodies; faces in the search are theirs
      integer(ip), allocatable :: first(:), of_body(:)       !< of_body(first(b):first(b + 1) - 1): the faces of body b
      integer(ip), allocatable :: rigid(:)                   !< surfaces of the rigid parties
      type(master_t), allocatable :: masters(:)              !< (parties) made when they are needed
      integer(ip), allocatable :: first_surface(:), surface_of(:)  !< the surfaces of rules and pairs to which each face belongs
      integer(ip), allocatable :: other(:)                   !< (faces) the party that it may touch; 0: none
      integer(ip), allocatable :: law(:)                     !< (faces) place of the interaction; 0: none is assigned
      logical, allocatable :: is_slave(:)                    !< (faces)
      integer(ip) :: n_excluded = 0                          !< faces that look at another body and may not touch it
      integer(ip) :: n_partly = 0                            !< faces of slaves that find the other body in part only
   end type search_t

   !> The slave faces of all pairs.
   type :: chains_t
      integer(ip) :: n = 0, n_outlines = 0, n_faces = 0      !< pairs, outlines that they are of, faces
      integer(ip), allocatable :: face(:), first(:)          !< face(first(i):first(i + 1) - 1): of pair i, in their order
      integer(ip), allocatable :: outline(:)                 !< (pairs) the same for pairs that continue each other
   end type chains_t

   !> Sides that differ by less than this part are alike.
   real(wp), parameter :: ALIKE = 1.0e-6_wp

contains

   !> Adds pairs to those that the deck gives, each with a surface for its slave; for models without any error.
   subroutine find_contact(rules, context)
      type(contact_rules_t), intent(inout) :: rules   !< the deck's pairs are excluded too; all are sorted
      type(build_context_t), intent(inout) :: context !< its model gets surfaces and pairs
      type(search_t) :: search
      type(chains_t) :: chains

      if (.not. rules%given) return
      call begin_search(context, rules, search)
      call choose_parties(context%model, rules, search)
      call choose_slaves(context%model, search)
      call make_chains(search, chains)
      call make_pairs()
      if (search%n_partly > 0) call report_note(context%deck, rules%place, 'N-PARTLY', 'faces that look at another body with a '// &
                                                'part only are left out: '//to_text(search%n_partly), keyword='CONTACT')
      if (chains%n > 0) return
      if (search%n_excluded > 0 .and. size(context%model%pairs) + size(context%model%ties) > 0) return
      call report_warning(context%deck, rules%place, 'W-CONTACT', 'no bodies that are included look at each other', &
                          expected='faces no farther apart than half their length, or than DISTANCE= [L]', keyword='CONTACT')

   contains

      !> A pair for each chain, with a surface for its slave; the outline of a body is the master of all pairs that need it.
      subroutine make_pairs()
         type(surface_t), allocatable :: surfaces(:)
         type(pair_t) :: pairs(chains%n)
         integer(ip) :: surface_of(size(search%masters)), number(chains%n), order(chains%n), default_law, i, n
         integer(lp) :: key(chains%n)

         default_law = 0
         if (any(search%is_slave .and. search%law == 0)) then
            context%model%interactions = [context%model%interactions, interaction_t(name='(default)')]
            default_law = size(context%model%interactions, kind=ip)
            call keep_token(context%interactions, default_law, rules%place)
            call report_note(context%deck, rules%place, 'N-DEFAULT-LAW', &
                             'no interaction is assigned to some of the contact that '// &
                             'is found: it is hard and without friction', keyword='CONTACT PROPERTY ASSIGNMENT')
         end if
         n = size(context%model%surfaces, kind=ip)
         allocate (surfaces(n + chains%n + search%bodies%n))
         surfaces(:n) = context%model%surfaces
         surface_of = 0
         surface_of(search%bodies%n + 1:) = search%rigid
         ! of the chains of the same slave and the same other party the first, the second, ...
         associate (faces => chains%face(chains%first(:chains%n)))
            key = int(search%outlines%body(faces), lp)*(size(search%masters, kind=lp) + 1_lp) + int(search%other(faces), lp)
         end associate
         order = sorted_places(key)
         number = 1
         do i = 2, chains%n
            if (key(order(i)) == key(order(i - 1))) number(order(i)) = number(order(i - 1)) + 1
         end do
         do i = 1, chains%n
            associate (first => chains%face(chains%first(i)), faces => chains%face(chains%first(i):chains%first(i + 1) - 1))
               n = n + 1
               surfaces(n)%name = search%bodies%list(search%outlines%body(first))%name
               if (number(i) > 1) surfaces(n)%name = surfaces(n)%name//' ('//to_text(number(i))//')'
               surfaces(n)%faces = some_faces(search, faces)
               pairs(i)%slave = n
               associate (party => search%other(first))
                  if (surface_of(party) == 0) then
                     n = n + 1
                     surfaces(n)%name = search%bodies%list(party)%name
                     surfaces(n)%faces = outline_of(search, party)
                     surface_of(party) = n
                  end if
                  pairs(i)%master = surface_of(party)
               end associate
               pairs(i)%interaction = merge(search%law(first), default_law, search%law(first) > 0)
            end associate
            pairs(i)%outline = chains%outline(i)
            pairs(i)%quadrature = rules%quadrature
            call keep_token(context%slaves, size(context%model%pairs, kind=ip) + i, rules%place)
            call keep_token(context%masters, size(context%model%pairs, kind=ip) + i, rules%place)
         end do
         context%model%surfaces = surfaces(:n)
         context%model%pairs = [context%model%pairs, pairs]
      end subroutine make_pairs
   end subroutine find_contact

   !> The bodies with their outlines, the rigid surfaces that are included, and the surfaces of rules to which each face belongs.
   subroutine begin_search(context, rules, search)
      type(build_context_t), intent(in) :: context
      type(contact_rules_t), intent(inout) :: rules
      type(search_t), intent(out) :: search
      logical :: is_named(0:size(context%model%surfaces) + size(rules%groups))
      integer(ip), allocatable :: place(:, :), surface(:), holder(:), members(:), own(:), nodes(:, :)
      integer(ip) :: i, j, k, n

      associate (model => context%model)
         call find_bodies(model%mesh, search%bodies)
         call name_bodies(model, search%bodies)
         call list_outlines(model%mesh, context%around, search%bodies%of_element, search%outlines, context%cut_faces)
         n = search%outlines%faces%n
         allocate (own(n))
         call faces_of_deck(model%mesh, context%refinement, search%outlines%faces, own, nodes)
         do i = 1, n
            associate (ends => pack(nodes(:, own(i)), nodes(:, own(i)) > 0))
               search%outlines%reach(i) = 0.5_wp*face_arc_length(model%mesh%x(:, ends), 1.0_wp)
            end associate
         end do
         call list_holders(search%bodies%n, reshape(search%outlines%body, [1_ip, n]), search%first, search%of_body)
         allocate (search%other(n), search%law(n), source=0_ip)
         allocate (search%is_slave(n), source=.false.)
         ! the rigid surfaces that are included
         is_named = .false.
         is_named(numbers_of(rules%included%a)) = .true.
         is_named(numbers_of(rules%included%b)) = .true.
         search%rigid = pack([(i, i=1, size(model%surfaces, kind=ip))], is_named(1:size(model%surfaces)) .and. &
                             model%surfaces%kind == SURFACE_SEGMENTS)
         allocate (search%masters(search%bodies%n + size(search%rigid)))
         do i = 1, size(search%rigid, kind=ip)
            associate (line => model%surfaces(search%rigid(i)))
               call master_of_segments(line%points, search%masters(search%bodies%n + i), line%is_arc, line%centre)
            end associate
         end do
         ! what the deck gives as a pair is not to be found a second time
         do i = 1, size(model%pairs, kind=ip)
            call add_rule(rules%excluded, model%pairs(i)%slave, model%pairs(i)%master, i)
         end do
         do i = 1, size(model%ties, kind=ip)
            call add_rule(rules%excluded, model%ties(i)%slave, model%ties(i)%master, i)
         end do
         is_named(numbers_of(rules%excluded%a)) = .true.
         is_named(numbers_of(rules%excluded%b)) = .true.
         is_named(numbers_of(rules%assigned%a)) = .true.
         is_named(numbers_of(rules%assigned%b)) = .true.
         ! to which surfaces and groups that rules and pairs name each face belongs
         n = sum(pack(model%surfaces%faces%n, is_named(1:size(model%surfaces))))
         do i = 1, size(rules%groups, kind=ip)
            n = n + sum(model%surfaces(rules%groups(i)%surfaces)%faces%n)
         end do
         allocate (place(1, n), surface(n))
         n = 0
         do i = 1, ubound(is_named, 1, kind=ip)
            if (.not. is_named(i)) cycle
            members = [i]
            if (i > size(model%surfaces)) members = rules%groups(i - size(model%surfaces))%surfaces
            do j = 1, size(members, kind=ip)
               associate (faces => model%surfaces(members(j))%faces)
                  do k = 1, faces%n
                     n = n + 1
                     place(1, n) = search%outlines%place(faces%face(k), faces%element(k))
                     surface(n) = i
                  end do
               end associate
            end do
         end do
         place = place(:, :n)
         call list_holders(search%outlines%faces%n, place, search%first_surface, holder)
         search%surface_of = surface(holder)
      end associate
      call sort_rules(rules%included)
      call sort_rules(rules%excluded)
      call sort_rules(rules%assigned)
   end subroutine begin_search

   !> The party that each face may touch, and by which law.
   subroutine choose_parties(model, rules, search)
      type(model_t), intent(in) :: model
      type(contact_rules_t), intent(in) :: rules
      type(search_t), intent(inout) :: search
      type(sighting_t), allocatable :: seen(:)
      integer(ip), allocatable :: own(:), others(:)
      integer(ip) :: i, rule

      call look_around(model%mesh, search%outlines, search%masters(search%bodies%n + 1:), rules%distance, seen)
      do i = 1, size(seen, kind=ip)
         if (max(seen(i)%face, seen(i)%rigid) == 0) cycle
         own = surfaces_at(search, i)
         if (seen(i)%rigid > 0) then
            others = search%rigid([seen(i)%rigid])
         else
            others = surfaces_at(search, seen(i)%face)
         end if
         if (last_rule(rules%included, own, others) == 0) cycle
         if (seen(i)%rigid > 0) others = [ANY_BODY, others]
         if (last_rule(rules%excluded, own, others) > 0) then
            search%n_excluded = search%n_excluded + 1
            cycle
         end if
         rule = last_rule(rules%assigned, own, others)
         if (rule > 0) search%law(i) = rules%assigned%value%values(rule)
         search%other(i) = search%bodies%n + seen(i)%rigid
         if (seen(i)%face > 0) search%other(i) = search%outlines%body(seen(i)%face)
      end do
   end subroutine choose_parties

   !> The surfaces of rules to which a face belongs, the outlines of all bodies one of them.
   pure function surfaces_at(search, face) result(surfaces)
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: face
      integer(ip), allocatable :: surfaces(:)

      surfaces = [ANY_BODY, search%surface_of(search%first_surface(face):search%first_surface(face + 1) - 1)]
   end function surfaces_at

   !> One side of each two parties that look at each other is the slave: the softer, the finer, or the first. A side that finds the
   !> other one nowhere with a whole face cannot be it, nor can a rigid surface.
   subroutine choose_slaves(model, search)
      type(model_t), intent(in) :: model
      type(search_t), intent(inout) :: search
      integer(lp) :: key(search%outlines%faces%n)            ! of the two parties; 0: none
      integer(ip), allocatable :: order(:), faces(:)         ! faces: of two parties, those of each in their order
      integer(ip), allocatable :: own(:)                     ! of one of them
      integer(ip) :: first, last, side(2), i, k

      associate (a => search%outlines%body, b => search%other)
         key = int(min(a, b), lp)*(size(search%masters, kind=lp) + 1_lp) + int(max(a, b), lp)
         where (b == 0) key = 0_lp
      end associate
      order = sorted_places(key)
      first = 1
      do last = 1, size(order, kind=ip)
         if (last < size(order)) then
            if (key(order(last + 1)) == key(order(last))) cycle
         end if
         if (key(order(last)) > 0_lp) then
            faces = order(first:last)
            associate (a => search%outlines%body(faces(1)), b => search%other(faces(1)))
               side = [min(a, b), max(a, b)]
            end associate
            if (side(2) <= search%bodies%n) then
               if (comes_before(model, search, faces, side(2), side(1))) side = side([2, 1])
            end if
            do k = 1, 2
               own = pack(faces, search%outlines%body(faces) == side(k))
               if (size(own) == 0) cycle
               associate (master => search%masters(search%other(own(1))))
                  if (master%n == 0) call master_of_faces(model%mesh, outline_of(search, search%other(own(1))), master)
                  do i = 1, size(own, kind=ip)
                     search%is_slave(own(i)) = finds_master(model%mesh, some_faces(search, own(i:i)), 1_ip, master)
                  end do
               end associate
               if (any(search%is_slave(own))) exit
            end do
            ! of the side that was looked at last, the slave if there is one: faces that find the other party in part only
            search%n_partly = search%n_partly + count(.not. search%is_slave(own), kind=ip)
         end if
         first = last + 1
      end do
   end subroutine choose_slaves

   !> The second body is the slave for its stiffness or for its faces, and not just because it is the first in the deck: its mean
   !> modulus along the faces, E = sum E_i l_i / sum l_i, is less, or else the mean length of its faces, sum l_i / n.
   pure logical function comes_before(model, search, faces, b, a)
      type(model_t), intent(in) :: model
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: faces(:), b, a
      real(wp), dimension(size(faces)) :: young, length      ! [F/L^2], [L]
      real(wp) :: means(2, 2)                                ! of both for b and for a
      integer(ip) :: i

      do i = 1, size(faces, kind=ip)
         associate (section => model%sections(model%section_of(search%outlines%faces%element(faces(i)))))
            young(i) = model%materials(section%material)%young
         end associate
      end do
      length = search%outlines%length(faces)
      do i = 1, 2
         associate (is_own => search%outlines%body(faces) == merge(b, a, i == 1))
            means(:, i) = 0.0_wp
            if (any(is_own)) means(:, i) = [sum(young*length, is_own)/sum(length, is_own), sum(length, is_own)/count(is_own)]
         end associate
      end do
      comes_before = means(2, 1) < (1 - ALIKE)*means(2, 2)
      if (abs(means(1, 1) - means(1, 2)) > ALIKE*means(1, 2)) comes_before = means(1, 1) < means(1, 2)
   end function comes_before

   !> Some faces of the outlines.
   pure function some_faces(search, places) result(faces)
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: places(:)
      type(face_list_t) :: faces

      faces%n = size(places, kind=ip)
      faces%element = search%outlines%faces%element(places)
      faces%face = search%outlines%faces%face(places)
   end function some_faces

   !> The faces of a body.
   pure function outline_of(search, body) result(faces)
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: body
      type(face_list_t) :: faces

      faces = some_faces(search, search%of_body(search%first(body):search%first(body + 1) - 1))
   end function outline_of

   !> The slave faces, chain by chain: a pair ends where the other party or the law changes, the surface that S_rho averages over
   !> goes on to a corner or to a face that is no slave. A chain that goes round, as of a wheel or a hole, comes after the others
   !> and begins where a pair does, so that none is cut in two.
   pure subroutine make_chains(search, chains)
      type(search_t), intent(in) :: search
      type(chains_t), intent(out) :: chains
      logical, dimension(search%outlines%faces%n) :: is_done, has_previous
      integer(ip) :: next(search%outlines%faces%n)           ! the slave face that goes on where a slave face ends; 0: none
      integer(ip) :: round, i, k, before, n
      logical :: begins

      n = search%outlines%faces%n
      allocate (chains%face(n), chains%first(n + 1), chains%outline(n))
      next = merge(search%outlines%next, 0_ip, search%is_slave)
      do i = 1, n
         if (next(i) == 0) cycle
         if (.not. search%is_slave(next(i))) next(i) = 0
      end do
      has_previous = .false.
      has_previous(pack(next, next > 0)) = .true.
      is_done = .not. search%is_slave
      do round = 0, 1
         do i = 1, n
            if (is_done(i) .or. (round == 0 .and. has_previous(i))) cycle
            k = i
            if (round == 1) then
               do
                  before = k
                  k = next(before)
                  if (k == i .or. .not. is_same_pair(search, before, k)) exit
               end do
            end if
            chains%n_outlines = chains%n_outlines + 1
            begins = .true.
            do
               if (begins) then
                  chains%n = chains%n + 1
                  chains%first(chains%n) = chains%n_faces + 1
                  chains%outline(chains%n) = chains%n_outlines
               end if
               chains%n_faces = chains%n_faces + 1
               chains%face(chains%n_faces) = k
               is_done(k) = .true.
               before = k
               k = next(before)
               if (k == 0) exit
               if (is_done(k)) exit
               begins = .not. is_same_pair(search, before, k)
            end do
         end do
      end do
      chains%first(chains%n + 1) = chains%n_faces + 1
   end subroutine make_chains

   !> Two faces that follow each other are of one pair.
   pure logical function is_same_pair(search, a, b)
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: a, b

      is_same_pair = search%other(a) == search%other(b) .and. search%law(a) == search%law(b)
   end function is_same_pair

end module atrito_found_contact
