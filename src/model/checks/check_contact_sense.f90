!> What a deck may well say and hardly means: bodies that overlap before they are loaded, loads on faces that touch.
module atrito_check_contact_sense
   use atrito_build_context, only: build_context_t, ids_text
   use atrito_deck, only: line_item
   use atrito_diagnostics, only: report_warning
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_nodes
   use atrito_model, only: model_t, element_load_t, is_on_volume
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_smooth_normals, only: smooth_surface
   use atrito_sorting, only: each_once
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: warn_of_overlap, warn_of_loaded_contact

   !> Overlap below this part of the largest coordinate is rounding: ten printed digits, and what cutting faces adds to it.
   real(wp), parameter :: ROUNDING = 1.0e-8_wp
   !> Faces of two meshes of one curve overlap by a part of their rise over the chord; below this part of it they fit.
   real(wp), parameter :: FITTING = 0.01_wp

contains

   !> The pair with the largest initial overlap, and how many others have some; for models without any error.
   subroutine warn_of_overlap(model, context)
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      real(wp) :: largest, least, overlap, slack
      integer(ip) :: i, j, worst, n
      character(len=:), allocatable :: others

      least = 0.0_wp
      do i = 1, size(model%pairs, kind=ip)
         least = min(least, minval(model%points(i)%gap))
      end do
      if (least >= 0.0_wp) return
      slack = ROUNDING*max(maxval(model%mesh%x), -minval(model%mesh%x))
      largest = slack
      worst = 0
      n = 0
      do i = 1, size(model%pairs, kind=ip)
         if (model%points(i)%n == 0 .or. model%pairs(i)%gap_is_given .or. model%pairs(i)%is_resolved) cycle
         overlap = -minval(model%points(i)%gap)
         if (overlap <= slack) cycle
         if (overlap <= slack + FITTING*largest_rise(model, i)) cycle
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

   !> How far the curves that both sides of a pair stand for rise over the chords of their faces at most [L].
   pure real(wp) function largest_rise(model, i) result(rise)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                     !< the pair

      rise = max(rise_of(model%mesh, model%surfaces(model%pairs(i)%slave)%faces), &
                 rise_of(model%mesh, model%surfaces(model%pairs(i)%master)%faces))
   end function largest_rise

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
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      integer(ip) :: i, told

      if (size(model%pairs) == 0) return
      told = 0
      do i = 1, size(model%steps, kind=ip)
         associate (loads => model%steps(i)%element_loads)
            if (loads%n == 0) cycle
            if (any(.not. is_on_volume(loads%kind) .and. loads%line > told)) call warn_of_loads(model, context, loads, told)
            told = max(told, maxval(loads%line))
         end associate
      end do
   end subroutine warn_of_loaded_contact

   !> The loads of a step; those that are inherited have been told of.
   subroutine warn_of_loads(model, context, loads, told)
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      type(element_load_t), intent(in) :: loads
      integer(ip), intent(in) :: told                  !< last line of the steps before
      integer(ip), allocatable :: pair_of(:)           ! of each load; 0: not on a contact face
      type(number_list_t) :: elements
      integer(ip) :: first, i, last

      call find_loaded_contact(model, loads, pair_of)
      first = 1
      do while (first <= loads%n)
         last = first
         do while (last < loads%n)
            if (loads%line(last + 1) /= loads%line(first)) exit
            last = last + 1
         end do
         elements%n = 0
         do i = first, last
            if (pair_of(i) > 0) call add_number(elements, model%mesh%element_id(loads%element(i)))
         end do
         if (elements%n > 0 .and. loads%line(first) > told) call report_loaded(model, context, loads%line(first), &
                                                                               maxval(pair_of(first:last)), elements)
         first = last + 1
      end do
   end subroutine warn_of_loads

   subroutine report_loaded(model, context, line, pair, elements)
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: line, pair            !< of the deck; one that the load acts on
      type(number_list_t), intent(in) :: elements      !< the user's numbers

      associate (place => line_item(context%deck, context%deck%lines(line), 1_ip), p => model%pairs(pair))
         call report_warning(context%deck, place, 'W-LOADED-CONTACT', 'the load acts on faces of the contact pair ' &
                             //model%surfaces(p%slave)%name//' / '//model%surfaces(p%master)%name//', at element ' &
                             //ids_text(each_once(numbers_of(elements)))//': it acts there besides the contact pressure', &
                             expected='faces that nothing touches', keyword='DSLOAD')
      end associate
   end subroutine report_loaded

   !> For each load the pair of whose slave or master it loads a face that has contact points.
   subroutine find_loaded_contact(model, loads, pair_of)
      type(model_t), intent(in) :: model
      type(element_load_t), intent(in) :: loads
      integer(ip), allocatable, intent(out) :: pair_of(:)
      type(number_list_t) :: loads_on(size(model%surfaces))
      integer(ip), allocatable :: first(:), load(:)
      logical, allocatable :: touched(:), is_listed(:)
      integer(ip) :: i, s, side

      allocate (pair_of(loads%n), source=0_ip)
      allocate (touched(model%mesh%n_nodes), is_listed(size(model%surfaces)), source=.false.)
      call list_loads(model, loads, first, load)
      do i = 1, size(model%pairs, kind=ip)
         do side = 1, 2
            s = merge(model%pairs(i)%slave, model%pairs(i)%master, side == 1)
            if (.not. is_listed(s)) call list_loads_on(model%surfaces(s)%faces, loads, first, load, loads_on(s))
            is_listed(s) = .true.
            if (loads_on(s)%n > 0) call mark_loads(model, i, loads, numbers_of(loads_on(s)), &
                                                   touched, pair_of)
         end do
      end do
   end subroutine find_loaded_contact

   !> The loads on the faces of each element: load(first(e):first(e + 1) - 1).
   pure subroutine list_loads(model, loads, first, load)
      type(model_t), intent(in) :: model
      type(element_load_t), intent(in) :: loads
      integer(ip), allocatable, intent(out) :: first(:), load(:)
      integer(ip), allocatable :: next(:)
      integer(ip) :: e, i

      allocate (first(model%mesh%n_elements + 1), source=0_ip)
      do i = 1, loads%n
         if (.not. is_on_volume(loads%kind(i))) first(loads%element(i) + 1) = first(loads%element(i) + 1) + 1
      end do
      first(1) = 1
      do e = 1, model%mesh%n_elements
         first(e + 1) = first(e + 1) + first(e)
      end do
      next = first
      allocate (load(first(model%mesh%n_elements + 1) - 1))
      do i = 1, loads%n
         if (is_on_volume(loads%kind(i))) cycle
         load(next(loads%element(i))) = i
         next(loads%element(i)) = next(loads%element(i)) + 1
      end do
   end subroutine list_loads

   !> The loads on the faces of a surface.
   pure subroutine list_loads_on(faces, loads, first, load, list)
      type(face_list_t), intent(in) :: faces
      type(element_load_t), intent(in) :: loads
      integer(ip), intent(in) :: first(:), load(:)
      type(number_list_t), intent(inout) :: list
      integer(ip) :: k, l

      do k = 1, faces%n
         do l = first(faces%element(k)), first(faces%element(k) + 1) - 1
            if (loads%face(load(l)) == faces%face(k)) call add_number(list, load(l))
         end do
      end do
   end subroutine list_loads_on

   !> Marks the loads on faces whose two ends have a part in the pair's points: of a master longer than its slave those that face
   !> nothing do not count.
   pure subroutine mark_loads(model, i, loads, listed, touched, pair_of)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                     !< the pair
      type(element_load_t), intent(in) :: loads
      integer(ip), intent(in) :: listed(:)             !< of the loads
      logical, intent(inout) :: touched(:)             !< (nodes) false, as on return
      integer(ip), intent(inout) :: pair_of(:)
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: k

      touched(model%points(i)%entry) = .true.
      do k = 1, size(listed, kind=ip)
         nodes = face_nodes(model%mesh, loads%element(listed(k)), loads%face(listed(k)))
         if (all(touched(nodes(:2)))) pair_of(listed(k)) = i
      end do
      touched(model%points(i)%entry) = .false.
   end subroutine mark_loads

end module atrito_check_contact_sense
