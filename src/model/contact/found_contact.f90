!> Contact that is found: the pairs that *CONTACT makes of the outlines of the bodies.
module atrito_found_contact
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_body_names, only: name_bodies
   use atrito_contact_rules, only: contact_rules_t, rule_list_t, add_rule, last_rule, sort_rules, ANY_BODY
   use atrito_deck, only: deck_t
   use atrito_diagnostics, only: report_note, report_warning
   use atrito_build_context, only: build_context_t, keep_token
   use atrito_faces, only: face_list_t
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, lp, wp
   use atrito_master, only: master_t, master_of_faces, master_of_segments
   use atrito_model, only: model_t, pair_t, surface_t, interaction_t, SURFACE_SEGMENTS
   use atrito_outlines, only: outlines_t, sighting_t, list_outlines, look_around
   use atrito_nodal_points, only: finds_master
   use atrito_sorting, only: sorted_places
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: find_contact

   !> The search for pairs. A party is a body, or a rigid surface that may take part: those come after the bodies.
   type :: search_t
      type(bodies_t) :: bodies
      type(outlines_t) :: outlines
      integer(ip), allocatable :: first(:), of_body(:)       !< of_body(first(b):first(b + 1) - 1): the faces of body b
      integer(ip), allocatable :: rigid(:)                   !< surfaces of the rigid parties
      type(master_t), allocatable :: masters(:)              !< (parties) made when they are needed
      integer(ip), allocatable :: first_surface(:), surface_of(:)  !< the surfaces of rules and pairs to which each face belongs
      integer(ip), allocatable :: other(:)                   !< (faces) the party that it may touch; 0: none
      integer(ip), allocatable :: law(:)                     !< (faces) place of the interaction; 0: none is assigned
      logical, allocatable :: is_slave(:)                    !< (faces)
      integer(ip) :: n_partly = 0                            !< faces of slaves that find the other body in part only
   end type search_t

   !> The slave faces of all pairs.
   type :: chains_t
      integer(ip) :: n = 0, n_outlines = 0, n_faces = 0
      integer(ip), allocatable :: face(:), first(:)          !< face(first(i):first(i + 1) - 1): of pair i, in their order
      integer(ip), allocatable :: outline(:)                 !< (pairs) the same for pairs that continue each other
   end type chains_t

   !> Sides that differ by less than this part are alike.
   real(wp), parameter :: ALIKE = 1.0e-6_wp

contains

   !> Adds pairs to those that the deck gives, each with a surface for its slave; for models without any error.
   subroutine find_contact(rules, context)
      type(contact_rules_t), intent(inout) :: rules
      type(build_context_t), intent(inout) :: context
      type(search_t) :: search
      type(chains_t) :: chains

      if (.not. rules%given) return
      call begin_search(context, rules, search)
      call choose_parties(context%model, rules, search)
      call choose_slaves(context%model, search)
      call make_chains(search, chains)
      call make_pairs(rules, search, chains, context)
      call tell_what_was_found(context%deck, rules, search, chains)
   end subroutine find_contact

   subroutine begin_search(context, rules, search)
      type(build_context_t), intent(in) :: context
      type(contact_rules_t), intent(inout) :: rules
      type(search_t), intent(out) :: search
      integer(ip) :: i

      call find_bodies(context%model%mesh, search%bodies)
      call name_bodies(context%model, search%bodies)
      call list_outlines(context%model%mesh, context%around, search%bodies%of_element, search%outlines, context%cut_faces)
      associate (n => search%outlines%faces%n)
         call list_holders(search%bodies%n, reshape(search%outlines%body, [1_ip, n]), search%first, search%of_body)
         allocate (search%other(n), search%law(n), source=0_ip)
         allocate (search%is_slave(n), source=.false.)
      end associate
      call list_rigid(context%model, rules%included, search%rigid)
      allocate (search%masters(search%bodies%n + size(search%rigid)))
      do i = 1, size(search%rigid, kind=ip)
         associate (surface => context%model%surfaces(search%rigid(i)))
            call master_of_segments(surface%points, search%masters(search%bodies%n + i), surface%is_arc, surface%centre)
         end associate
      end do
      ! what the deck gives as a pair is not to be found a second time
      do i = 1, size(context%model%pairs, kind=ip)
         call add_rule(rules%excluded, context%model%pairs(i)%slave, context%model%pairs(i)%master, i)
      end do
      do i = 1, size(context%model%ties, kind=ip)
         call add_rule(rules%excluded, context%model%ties(i)%slave, context%model%ties(i)%master, i)
      end do
      call sort_rules(rules%included)
      call sort_rules(rules%excluded)
      call sort_rules(rules%assigned)
      call list_surfaces(context%model, rules, search)
   end subroutine begin_search

   !> The rigid surfaces that are included, each once.
   pure subroutine list_rigid(model, included, rigid)
      type(model_t), intent(in) :: model
      type(rule_list_t), intent(in) :: included
      integer(ip), allocatable, intent(out) :: rigid(:)
      logical :: is_named(0:size(model%surfaces))
      integer(ip) :: i

      is_named = .false.
      do i = 1, included%n
         is_named(included%surface(:, i)) = .true.
      end do
      allocate (rigid(0))
      do i = 1, size(model%surfaces, kind=ip)
         if (is_named(i) .and. model%surfaces(i)%kind == SURFACE_SEGMENTS) rigid = [rigid, i]
      end do
   end subroutine list_rigid

   !> To which surfaces that rules and pairs name each face belongs.
   subroutine list_surfaces(model, rules, search)
      type(model_t), intent(in) :: model
      type(contact_rules_t), intent(in) :: rules
      type(search_t), intent(inout) :: search
      logical :: is_named(0:size(model%surfaces))
      integer(ip), allocatable :: place(:, :), surface(:), holder(:)
      integer(ip) :: i, k, n

      is_named = .false.
      do i = 1, rules%included%n
         is_named(rules%included%surface(:, i)) = .true.
      end do
      do i = 1, rules%excluded%n
         is_named(rules%excluded%surface(:, i)) = .true.
      end do
      do i = 1, rules%assigned%n
         is_named(rules%assigned%surface(:, i)) = .true.
      end do
      n = 0
      do i = 1, size(model%surfaces, kind=ip)
         if (is_named(i)) n = n + model%surfaces(i)%faces%n
      end do
      allocate (place(1, n), surface(n))
      n = 0
      do i = 1, size(model%surfaces, kind=ip)
         if (.not. is_named(i)) cycle
         associate (faces => model%surfaces(i)%faces)
            do k = 1, faces%n
               n = n + 1
               place(1, n) = search%outlines%place(faces%face(k), faces%element(k))
               surface(n) = i
            end do
         end associate
      end do
      call list_holders(search%outlines%faces%n, place, search%first_surface, holder)
      search%surface_of = surface(holder)
   end subroutine list_surfaces

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
         if (last_rule(rules%excluded, own, others) > 0) cycle
         rule = last_rule(rules%assigned, own, others)
         if (rule > 0) search%law(i) = rules%assigned%value(rule)
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

   !> One side of each two parties that look at each other is the slave: the softer, the finer, or the first.
   subroutine choose_slaves(model, search)
      type(model_t), intent(in) :: model
      type(search_t), intent(inout) :: search
      integer(lp) :: key(search%outlines%faces%n)
      integer(ip), allocatable :: order(:)
      integer(ip) :: i, first, last

      do i = 1, size(key, kind=ip)
         key(i) = 0_lp
         if (search%other(i) == 0) cycle
         associate (a => search%outlines%body(i), b => search%other(i))
            key(i) = int(min(a, b), lp)*(int(size(search%masters), lp) + 1_lp) + int(max(a, b), lp)
         end associate
      end do
      order = sorted_places(key)
      first = 1
      do last = 1, size(order, kind=ip)
         if (last < size(order)) then
            if (key(order(last + 1)) == key(order(last))) cycle
         end if
         if (key(order(last)) > 0_lp) call choose_slave(model, order(first:last), search)
         first = last + 1
      end do
   end subroutine choose_slaves

   !> A side that finds the other one nowhere with a whole face cannot be the slave, nor can a rigid surface.
   subroutine choose_slave(model, faces, search)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: faces(:)                    !< of both, those of each in their order
      type(search_t), intent(inout) :: search
      integer(ip) :: side(2), n_partly, k

      side = [search%outlines%body(faces(1)), search%other(faces(1))]
      side = [minval(side), maxval(side)]
      if (side(2) <= search%bodies%n) then
         if (comes_before(model, search, faces, side(2), side(1))) side = side([2, 1])
      end if
      do k = 1, 2
         call mark_slave(model, pack(faces, search%outlines%body(faces) == side(k)), search, n_partly)
         if (any(search%is_slave(faces))) exit
      end do
      search%n_partly = search%n_partly + n_partly
   end subroutine choose_slave

   !> The second body is the slave for its stiffness or for its faces, and not just because it is the first in the deck.
   pure logical function comes_before(model, search, faces, b, a)
      type(model_t), intent(in) :: model
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: faces(:), b, a
      real(wp) :: young(2), length(2)                        ! means of b and of a [F/L^2], [L]

      call measure_side(model, search, pack(faces, search%outlines%body(faces) == b), young(1), length(1))
      call measure_side(model, search, pack(faces, search%outlines%body(faces) == a), young(2), length(2))
      comes_before = length(1) < (1 - ALIKE)*length(2)
      if (abs(young(1) - young(2)) > ALIKE*young(2)) comes_before = young(1) < young(2)
   end function comes_before

   pure subroutine measure_side(model, search, faces, young, length)
      type(model_t), intent(in) :: model
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: faces(:)
      real(wp), intent(out) :: young                         !< [F/L^2] mean along the faces
      real(wp), intent(out) :: length                        !< [L] mean of the faces
      integer(ip) :: i

      young = 0.0_wp
      length = 0.0_wp
      if (size(faces) == 0) return
      do i = 1, size(faces, kind=ip)
         associate (section => model%sections(model%section_of(search%outlines%faces%element(faces(i)))))
            young = young + model%materials(section%material)%young*search%outlines%length(faces(i))
         end associate
      end do
      length = sum(search%outlines%length(faces))
      young = young/length
      length = length/real(size(faces), wp)
   end subroutine measure_side

   !> Which of the faces find the other party with all their points; only some of the others do with a part of them.
   subroutine mark_slave(model, faces, search, n_partly)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: faces(:)                    !< of one body, with the same other party
      type(search_t), intent(inout) :: search
      integer(ip), intent(out) :: n_partly
      type(face_list_t) :: one
      integer(ip) :: i

      n_partly = 0
      if (size(faces) == 0) return
      associate (party => search%other(faces(1)))
         if (search%masters(party)%n == 0) then
            call master_of_faces(model%mesh, outline_of(search, party), search%masters(party))
         end if
         do i = 1, size(faces, kind=ip)
            one = face_list_t(1_ip, search%outlines%faces%element([faces(i)]), search%outlines%faces%face([faces(i)]))
            search%is_slave(faces(i)) = finds_master(model%mesh, one, 1_ip, search%masters(party))
            if (.not. search%is_slave(faces(i))) n_partly = n_partly + 1
         end do
      end associate
   end subroutine mark_slave

   !> The faces of a body.
   pure function outline_of(search, body) result(faces)
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: body
      type(face_list_t) :: faces

      associate (members => search%of_body(search%first(body):search%first(body + 1) - 1))
         faces%n = size(members, kind=ip)
         faces%element = search%outlines%faces%element(members)
         faces%face = search%outlines%faces%face(members)
      end associate
   end function outline_of

   !> The slave faces, chain by chain: a pair ends where the other party or the law changes, the surface that S_rho averages over
   !> goes on to a corner or to a face that is no slave.
   pure subroutine make_chains(search, chains)
      type(search_t), intent(in) :: search
      type(chains_t), intent(out) :: chains
      logical :: is_done(search%outlines%faces%n), has_previous(search%outlines%faces%n)
      integer(ip) :: i, n

      n = search%outlines%faces%n
      allocate (chains%face(n), chains%first(n + 1), chains%outline(n))
      has_previous = .false.
      do i = 1, n
         if (next_slave(search, i) > 0) has_previous(next_slave(search, i)) = .true.
      end do
      is_done = .not. search%is_slave
      do i = 1, n
         if (.not. (is_done(i) .or. has_previous(i))) call follow_chain(search, i, is_done, chains)
      end do
      ! what is left goes round: a wheel, a hole
      do i = 1, n
         if (.not. is_done(i)) call follow_chain(search, start_of_loop(search, i), is_done, chains)
      end do
      chains%first(chains%n + 1) = chains%n_faces + 1
   end subroutine make_chains

   !> The slave face that goes on where a slave face ends; 0: none.
   pure integer(ip) function next_slave(search, i) result(next)
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: i

      next = 0
      if (search%is_slave(i)) next = search%outlines%next(i)
      if (next == 0) return
      if (.not. search%is_slave(next)) next = 0
   end function next_slave

   !> Two faces that follow each other are of one pair.
   pure logical function is_same_pair(search, a, b)
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: a, b

      is_same_pair = search%other(a) == search%other(b) .and. search%law(a) == search%law(b)
   end function is_same_pair

   !> Where a pair begins on a chain that goes round, so that none is cut in two; the face itself where there is but one pair.
   pure integer(ip) function start_of_loop(search, face) result(start)
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: face
      integer(ip) :: i

      start = face
      i = face
      do
         if (.not. is_same_pair(search, i, search%outlines%next(i))) then
            start = search%outlines%next(i)
            return
         end if
         i = search%outlines%next(i)
         if (i == face) return
      end do
   end function start_of_loop

   pure subroutine follow_chain(search, start, is_done, chains)
      type(search_t), intent(in) :: search
      integer(ip), intent(in) :: start
      logical, intent(inout) :: is_done(:)                   !< (faces)
      type(chains_t), intent(inout) :: chains
      integer(ip) :: i, next

      chains%n_outlines = chains%n_outlines + 1
      next = start
      i = 0
      do
         if (i > 0) then
            if (.not. is_same_pair(search, i, next)) i = 0
         end if
         if (i == 0) then
            chains%n = chains%n + 1
            chains%first(chains%n) = chains%n_faces + 1
            chains%outline(chains%n) = chains%n_outlines
         end if
         i = next
         chains%n_faces = chains%n_faces + 1
         chains%face(chains%n_faces) = i
         is_done(i) = .true.
         next = next_slave(search, i)
         if (next == 0) return
         if (is_done(next)) return
      end do
   end subroutine follow_chain

   !> A pair for each chain, with a surface for its slave; the outline of a body is the master of all pairs that need it.
   subroutine make_pairs(rules, search, chains, context)
      type(contact_rules_t), intent(in) :: rules
      type(search_t), intent(in) :: search
      type(chains_t), intent(in) :: chains
      type(build_context_t), intent(inout) :: context
      type(surface_t), allocatable :: surfaces(:)
      type(pair_t) :: pairs(chains%n)
      integer(ip) :: surface_of(size(search%masters)), number(chains%n), default_law, i, n

      call provide_law(rules, search, context, default_law)
      n = size(context%model%surfaces, kind=ip)
      allocate (surfaces(n + chains%n + search%bodies%n))
      surfaces(:n) = context%model%surfaces
      surface_of = 0
      surface_of(search%bodies%n + 1:) = search%rigid
      number = count_alike(search, chains)
      do i = 1, chains%n
         associate (first => chains%face(chains%first(i)), faces => chains%face(chains%first(i):chains%first(i + 1) - 1))
            n = n + 1
            surfaces(n)%name = search%bodies%list(search%outlines%body(first))%name
            if (number(i) > 1) surfaces(n)%name = surfaces(n)%name//' ('//to_text(number(i))//')'
            surfaces(n)%faces = face_list_t(size(faces, kind=ip), search%outlines%faces%element(faces), &
                                            search%outlines%faces%face(faces))
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

   !> Of the chains of the same slave and the same other party the first, the second, ...
   pure function count_alike(search, chains) result(number)
      type(search_t), intent(in) :: search
      type(chains_t), intent(in) :: chains
      integer(ip) :: number(chains%n), order(chains%n), i
      integer(lp) :: key(chains%n)

      do i = 1, chains%n
         associate (face => chains%face(chains%first(i)))
            key(i) = int(search%outlines%body(face), lp)*(int(size(search%masters), lp) + 1_lp) + int(search%other(face), lp)
         end associate
      end do
      order = sorted_places(key)
      number = 1
      do i = 2, chains%n
         if (key(order(i)) == key(order(i - 1))) number(order(i)) = number(order(i - 1)) + 1
      end do
   end function count_alike

   !> The law of pairs to which none is assigned, where there are such pairs.
   subroutine provide_law(rules, search, context, law)
      type(contact_rules_t), intent(in) :: rules
      type(search_t), intent(in) :: search
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(out) :: law                        !< place of the interaction; 0: all pairs have one

      law = 0
      if (.not. any(search%is_slave .and. search%law == 0)) return
      context%model%interactions = [context%model%interactions, interaction_t(name='(default)')]
      law = size(context%model%interactions, kind=ip)
      call keep_token(context%interactions, law, rules%place)
      call report_note(context%deck, rules%place, 'N-DEFAULT-LAW', 'no interaction is assigned to some of the contact that is '// &
                       'found: it is hard and without friction', keyword='CONTACT PROPERTY ASSIGNMENT')
   end subroutine provide_law

   subroutine tell_what_was_found(deck, rules, search, chains)
      type(deck_t), intent(in) :: deck
      type(contact_rules_t), intent(in) :: rules
      type(search_t), intent(in) :: search
      type(chains_t), intent(in) :: chains

      if (search%n_partly > 0) call report_note(deck, rules%place, 'N-PARTLY', 'faces that look at another body with a part '// &
                                                'only are left out: '//to_text(search%n_partly), keyword='CONTACT')
      if (chains%n == 0) call report_warning(deck, rules%place, 'W-CONTACT', 'no bodies that are included look at each other', &
                                             expected='faces no farther apart than half their length, or than DISTANCE= [L]', &
                                             keyword='CONTACT')
   end subroutine tell_what_was_found

end module atrito_found_contact
