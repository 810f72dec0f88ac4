!> What a deck may well say and hardly means: bodies that overlap before they are loaded, loads on faces that touch.
module atrito_check_contact_sense
   use atrito_build_context, only: build_context_t, ids_text
   use atrito_deck, only: line_item
   use atrito_diagnostics, only: report_warning
   use atrito_element_table, only: MOST_SIDES
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
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      integer(ip), allocatable :: pair_at(:, :)        ! of find_contact_faces; not listed before it is wanted
      integer(ip) :: i, told

      if (size(model%pairs) == 0) return
      told = 0
      do i = 1, size(model%steps, kind=ip)
         associate (loads => model%steps(i)%element_loads)
            if (loads%n == 0) cycle
            if (any(.not. is_on_volume(loads%kind) .and. loads%line > told)) then
               if (.not. allocated(pair_at)) call find_contact_faces(model, pair_at)
               call warn_of_loads(model, context, loads, pair_at, told)
            end if
            told = max(told, maxval(loads%line))
         end associate
      end do
   end subroutine warn_of_loaded_contact

   !> For each face of an element the last pair in whose points both ends of the face have a part: of a master longer than its slave
   !> the faces that face nothing do not count.
   pure subroutine find_contact_faces(model, pair_at)
      type(model_t), intent(in) :: model
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

   !> The loads of a step; those that are carried on have been told of.
   subroutine warn_of_loads(model, context, loads, pair_at, told)
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      type(element_load_t), intent(in) :: loads
      integer(ip), intent(in) :: pair_at(:, :)         !< as of find_contact_faces
      integer(ip), intent(in) :: told                  !< last line of the steps before
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
         if (pair > 0 .and. loads%line(i) > told) then
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

end module atrito_check_contact_sense
