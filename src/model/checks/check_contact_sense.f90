!> What a deck may well say and hardly means: bodies that overlap before they are loaded, loads on faces that touch, and pairs that
!> say the same thing twice: the same faces face each other in both, as slave and master or the other way round. Each pair takes a
!> part of the pressure then, and a contact that yields (LINEAR) is twice as stiff. Where a tie holds these faces, too, contact may
!> press as hard as the tie pulls.
module atrito_check_contact_sense
   use atrito_bilateral_rows, only: ROW_TIE
   use atrito_build_context, only: build_context_t, ids_text
   use atrito_deck, only: line_item
   use atrito_diagnostics, only: report_warning
   use atrito_element_table, only: MOST_SIDES
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp, lp
   use atrito_mesh, only: mesh_t, face_nodes
   use atrito_model, only: model_t, element_load_t, is_on_volume
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_smooth_normals, only: smooth_surface
   use atrito_sorting, only: each_once, sorted_places
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: warn_of_overlap, warn_of_loaded_contact, warn_of_pairs_twice

   !> Overlap below this part of the largest coordinate is rounding: ten printed digits, and what cutting faces adds to it.
   real(wp), parameter :: ROUNDING = 1.0e-8_wp
   !> Faces of two meshes of one curve overlap by a part of their rise over the chord; below this part of it they fit.
   real(wp), parameter :: FITTING = 0.01_wp

   !> The faces of a pair that have a part in its points, each as one number.
   type :: sides_t
      integer(lp), allocatable :: slave(:), master(:)  !< element and side; only faces that points join
   end type sides_t

   !> Moduli and faces that differ by less are alike.
   real(wp), parameter :: ALIKE = 1.0e-6_wp

contains

   !> The pair with the largest initial overlap, and how many others have some; for models without any error.
   subroutine warn_of_overlap(model, context)
      type(model_t), intent(in) :: model               !< with the points of all pairs
      type(build_context_t), intent(in) :: context     !< places in the deck, for messages
      real(wp) :: largest, overlap, slack
      integer(ip) :: i, j, worst, n
      character(len=:), allocatable :: others

      slack = ROUNDING*max(maxval(model%mesh%x), -minval(model%mesh%x))
      largest = slack
      worst = 0
      n = 0
      do i = 1, size(model%pairs, kind=ip)
         if (model%points(i)%n == 0 .or. model%pairs(i)%gap_is_given .or. model%pairs(i)%is_resolved) cycle
         overlap = -minval(model%points(i)%gap)
         if (overlap <= slack) cycle
         associate (slave => model%surfaces(model%pairs(i)%slave)%faces, master => model%surfaces(model%pairs(i)%master)%faces)
            if (overlap <= slack + FITTING*max(rise_of(model%mesh, slave), rise_of(model%mesh, master))) cycle
         end associate
         n = n + 1
         if (overlap <= largest) cycle
         largest = overlap
         worst = i
      end do
      if (worst == 0) return
      others = ''
      if (n > 1) others = '; so do the sides of '//to_text(n - 1)//' more pairs'
      associate (points => model%points(worst), pair => model%pairs(worst))
         j = minloc(points%gap, 1, kind=ip)
         call report_warning(context%deck, context%slaves(worst), 'W-OVERLAP', model%surfaces(pair%slave)%name//' and ' &
                             //model%surfaces(pair%master)%name//' overlap before any load, by '//to_text(largest, 4) &
                             //' [L] at node '//to_text(model%mesh%node_id(points%node(j)))//' (' &
                             //to_text(points%x(1, j), 5)//', '//to_text(points%x(2, j), 5)//'), and contact pushes them apart' &
                             //others, expected= &
                             'sides that touch or have a gap; ADJUST closes an overlap, *CLEARANCE with a negative value '// &
                             'means it, *CONTACT INTERFERENCE resolves it over a step', keyword='CONTACT PAIR')
      end associate
   end subroutine warn_of_overlap

   !> How far the curve that faces stand for rises over their chords at most [L].
   pure real(wp) function rise_of(mesh, faces) result(rise)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces           !< none of a drawn surface
      real(wp), allocatable :: ends(:, :, :), curvature(:), bend(:)
      integer(ip) :: k

      rise = 0.0_wp
      if (faces%n == 0) return
      call smooth_surface(mesh, faces, ends, curvature, bend)
      do k = 1, faces%n
         associate (nodes => face_nodes(mesh, faces%element(k), faces%face(k)))
            rise = max(rise, abs(bend(k))*sum((mesh%x(:, nodes(2)) - mesh%x(:, nodes(1)))**2)/8)
         end associate
      end do
   end function rise_of

   !> Loads on faces where slave and master face each other; for models without any error. A message a line of the deck.
   subroutine warn_of_loaded_contact(model, context)
      type(model_t), intent(in) :: model               !< with the points of all pairs
      type(build_context_t), intent(in) :: context     !< places in the deck, for messages
      integer(ip), allocatable :: pair_at(:, :)        ! of find_contact_faces; not listed before it is wanted
      integer(ip) :: i, reported

      if (size(model%pairs) == 0) return
      reported = 0
      do i = 1, size(model%steps, kind=ip)
         associate (loads => model%steps(i)%element_loads)
            if (loads%n == 0) cycle
            if (any(.not. is_on_volume(loads%kind) .and. loads%line > reported)) then
               if (.not. allocated(pair_at)) call find_contact_faces(pair_at)
               call warn_of_loads(loads)
            end if
            reported = max(reported, maxval(loads%line))
         end associate
      end do

   contains

      !> For each face of an element the last pair in whose points both ends of the face have a part: of a master longer than its
      !> slave
      !> the faces that face nothing do not count.
      pure subroutine find_contact_faces(pair_at)
         integer(ip), allocatable, intent(out) :: pair_at(:, :) !< (MOST_SIDES, n_elements); 0: none
         logical, allocatable :: touched(:)
         integer(ip) :: i, k, side

         allocate (pair_at(MOST_SIDES, model%mesh%n_elements), source=0_ip)
         allocate (touched(model%mesh%n_nodes), source=.false.)
         do i = 1, size(model%pairs, kind=ip)
            touched(model%points(i)%entry) = .true.
            do side = 1, 2
               associate (faces => model%surfaces(merge(model%pairs(i)%slave, model%pairs(i)%master, side == 1))%faces)
                  do k = 1, faces%n
                     associate (nodes => face_nodes(model%mesh, faces%element(k), faces%face(k)))
                        if (all(touched(nodes(:2)))) pair_at(faces%face(k), faces%element(k)) = i
                     end associate
                  end do
               end associate
            end do
            touched(model%points(i)%entry) = .false.
         end do
      end subroutine find_contact_faces

      !> The loads of a step; those that are inherited have been reported.
      subroutine warn_of_loads(loads)
         type(element_load_t), intent(in) :: loads
         type(number_list_t) :: elements                  ! of a line of the deck: those with loads on faces of pairs
         integer(ip) :: i, at, pair

         pair = 0
         do i = 1, loads%n
            if (.not. is_on_volume(loads%kind(i))) then
               at = pair_at(loads%face(i), loads%element(i))
               if (at > 0) call add_number(elements, model%mesh%element_id(loads%element(i)))
               pair = max(pair, at)
            end if
            if (i < loads%n) then
               if (loads%line(i + 1) == loads%line(i)) cycle
            end if
            if (pair > 0 .and. loads%line(i) > reported) then
               associate (place => line_item(context%deck, context%deck%lines(loads%line(i)), 1_ip), p => model%pairs(pair))
                  call report_warning(context%deck, place, 'W-LOADED-CONTACT', 'the load acts on faces of the contact pair ' &
                                      //model%surfaces(p%slave)%name//' / '//model%surfaces(p%master)%name//', at element ' &
                                      //ids_text(each_once(numbers_of(elements)))//': it acts there besides the contact pressure', &
                                      expected='faces that nothing touches', keyword='DSLOAD')
               end associate
            end if
            pair = 0
            elements%n = 0
         end do
      end subroutine warn_of_loads
   end subroutine warn_of_loaded_contact

   !> The first two pairs that are one, and how many others there are; for models without any error.
   subroutine warn_of_pairs_twice(model, context)
      type(model_t), intent(in) :: model               !< with the points of all pairs
      type(build_context_t), intent(in) :: context     !< places in the deck, for messages
      type(sides_t), allocatable :: sides(:)
      integer(ip) :: twin(size(model%pairs)), i, k
      character(len=:), allocatable :: text, advice
      real(wp) :: a(2), b(2)

      allocate (sides(size(model%pairs)))
      call list_sides(model, sides)
      if (allocated(model%ties)) call warn_of_tied_pairs(model, context, sides)
      if (size(model%pairs) < 2) return
      call find_twins(model, sides, twin)
      k = findloc(twin > 0, .true., dim=1, kind=ip)
      if (k == 0) return
      i = twin(k)
      text = pair_text(model, i)//' and '//pair_text(model, k)//': the same faces face each other in both pairs, and each carries' &
             //' a part of the pressure'
      if (any(model%interactions([model%pairs(i)%interaction, model%pairs(k)%interaction])%delta > 0.0_wp)) then
         text = text//'; together they are stiffer than the pressure-overclosure of either'
      end if
      if (count(twin > 0) > 1) text = text//'; so it is with '//to_text(count(twin > 0, kind=ip) - 1)//' more pairs'
      ! Of the two pairs the one to keep.
      a = slave_means(model, sides(i)%slave)
      b = slave_means(model, sides(k)%slave)
      if (abs(a(1) - b(1)) > ALIKE*b(1)) then
         advice = 'one of them, '//pair_text(model, merge(i, k, a(1) < b(1)))//', whose slave is the softer side'
      else if (abs(a(2) - b(2)) > ALIKE*b(2)) then
         advice = 'one of them, '//pair_text(model, merge(i, k, a(2) < b(2)))//', whose slave is the finer side'
      else
         advice = 'one of them; either will do'
      end if
      call report_warning(context%deck, context%slaves(k), 'W-TWICE', text, expected=advice, keyword='CONTACT PAIR')
   end subroutine warn_of_pairs_twice

   !> The first pair whose faces a tie holds together, and how many others there are: both ends of a face of either side are in the
   !> rows of one tie.
   subroutine warn_of_tied_pairs(model, context, sides)
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      type(sides_t), intent(in) :: sides(:)            !< of all pairs
      character(len=:), allocatable :: text
      logical :: is_tied(model%mesh%n_nodes)
      integer(ip) :: by(size(sides)), i, k, row        ! by: the tie of each pair, 0: none

      by = 0
      do k = 1, size(model%ties, kind=ip)
         is_tied = .false.
         associate (rows => model%bilateral)
            do row = 1, rows%n
               if (rows%kind(row) /= ROW_TIE .or. rows%part(row) /= k) cycle
               is_tied(rows%node(rows%first(row):rows%first(row + 1) - 1)) = .true.
            end do
         end associate
         do i = 1, size(sides, kind=ip)
            if (by(i) == 0 .and. has_tied_face(sides(i)%slave) .and. has_tied_face(sides(i)%master)) by(i) = k
         end do
      end do
      i = findloc(by > 0, .true., dim=1, kind=ip)
      if (i == 0) return
      text = pair_text(model, i)//': the tie '//model%ties(by(i))%name//' holds the same faces together, and how much of their '// &
             'force is contact is not determined'
      if (count(by > 0) > 1) text = text//'; so it is with '//to_text(count(by > 0, kind=ip) - 1)//' more pairs'
      call report_warning(context%deck, context%slaves(i), 'W-TWICE', text, expected='the tie or the pair, not both', &
                          keyword='CONTACT PAIR')

   contains

      pure logical function has_tied_face(faces) result(has)
         integer(lp), intent(in) :: faces(:)
         integer(ip) :: j, element

         has = .false.
         do j = 1, size(faces, kind=ip)
            element = int((faces(j) - 1_lp)/MOST_SIDES, ip)
            associate (nodes => face_nodes(model%mesh, element, int(faces(j) - int(element, lp)*MOST_SIDES, ip)))
               has = all(is_tied(nodes(:2)))
            end associate
            if (has) return
         end do
      end function has_tied_face
   end subroutine warn_of_tied_pairs

   !> `slave on master`
   pure function pair_text(model, i) result(text)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i
      character(len=:), allocatable :: text

      text = model%surfaces(model%pairs(i)%slave)%name//' on '//model%surfaces(model%pairs(i)%master)%name
   end function pair_text

   !> Means over some faces: Young's modulus [F/L^2] behind them, and their length [L].
   pure function slave_means(model, faces) result(means)
      type(model_t), intent(in) :: model
      integer(lp), intent(in) :: faces(:)
      real(wp) :: means(2)
      integer(ip) :: i, element

      means = 0.0_wp
      do i = 1, size(faces, kind=ip)
         element = int((faces(i) - 1_lp)/MOST_SIDES, ip)
         associate (nodes => face_nodes(model%mesh, element, int(faces(i) - int(element, lp)*MOST_SIDES, ip)))
            means = means + [model%materials(model%sections(model%section_of(element))%material)%young, &
                             norm2(model%mesh%x(:, nodes(2)) - model%mesh%x(:, nodes(1)))]/real(size(faces), wp)
         end associate
      end do
   end function slave_means

   !> The slave faces of the points; the faces of a master with both ends among the nodes of the points, none of a drawn line.
   pure subroutine list_sides(model, sides)
      type(model_t), intent(in) :: model
      type(sides_t), intent(out) :: sides(:)
      logical, allocatable :: touched(:), is_touched(:)
      integer(ip) :: i, k

      allocate (touched(model%mesh%n_nodes), source=.false.)
      do i = 1, size(model%pairs, kind=ip)
         sides(i)%slave = model%points(i)%faces
         touched(model%points(i)%entry) = .true.
         associate (faces => model%surfaces(model%pairs(i)%master)%faces)
            allocate (is_touched(faces%n))
            do k = 1, faces%n
               associate (nodes => face_nodes(model%mesh, faces%element(k), faces%face(k)))
                  is_touched(k) = all(touched(nodes(:2)))
               end associate
            end do
            sides(i)%master = pack([(int(faces%element(k), lp)*MOST_SIDES + faces%face(k), k=1, faces%n)], is_touched)
            deallocate (is_touched)
         end associate
         touched(model%points(i)%entry) = .false.
      end do
   end subroutine list_sides

   !> For each pair one before it that is the same, or 0. Pairs come together at the slave faces of one of them: of the others that
   !> have such a face the list is short, also where there are thousands.
   subroutine find_twins(model, sides, twin)
      type(model_t), intent(in) :: model
      type(sides_t), intent(in) :: sides(:)
      integer(ip), intent(out) :: twin(:)
      integer(lp), allocatable :: face(:)
      integer(ip), allocatable :: pair(:), order(:)
      logical, allocatable :: is_slave(:)
      logical :: is_same
      integer(ip) :: i, j, k, n, first, last

      n = sum([(size(sides(i)%slave, kind=ip) + size(sides(i)%master, kind=ip), i=1, size(sides, kind=ip))])
      allocate (face(n), pair(n), is_slave(n))
      n = 0
      do i = 1, size(sides, kind=ip)
         associate (s => size(sides(i)%slave, kind=ip), m => size(sides(i)%master, kind=ip))
            face(n + 1:n + s + m) = [sides(i)%slave, sides(i)%master]
            pair(n + 1:n + s + m) = i
            is_slave(n + 1:n + s + m) = [(k <= s, k=1, s + m)]
            n = n + s + m
         end associate
      end do
      order = sorted_places(face)
      twin = 0
      first = 1
      do last = 1, size(face, kind=ip)
         if (last < size(face)) then
            if (face(order(last + 1)) == face(order(last))) cycle
         end if
         ! a pair with others that have one of its slave faces on one side or the other: they are the same where they share faces
         ! of the other side, too
         do n = first, last
            if (.not. is_slave(order(n))) cycle
            i = pair(order(n))
            do j = first, last
               k = pair(order(j))
               if (k == i .or. twin(max(i, k)) > 0) cycle
               if (.not. is_slave(order(j))) then
                  is_same = share_a_face(sides(i)%master, sides(k)%slave)
               else if (model%points(i)%rigid .or. model%points(k)%rigid) then
                  is_same = model%pairs(i)%master == model%pairs(k)%master
               else
                  is_same = share_a_face(sides(i)%master, sides(k)%master)
               end if
               if (is_same) twin(max(i, k)) = min(i, k)
            end do
         end do
         first = last + 1
      end do
   end subroutine find_twins

   !> Two lists of faces have one in common.
   pure logical function share_a_face(a, b) result(share)
      integer(lp), intent(in) :: a(:), b(:)
      integer(ip) :: k

      share = .false.
      do k = 1, size(a, kind=ip)
         share = any(b == a(k))
         if (share) return
      end do
   end function share_a_face

end module atrito_check_contact_sense
