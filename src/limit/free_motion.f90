!> Why a scene has no equilibrium, in words and numbers: which bodies move how, over which joint, what drives them, and what
!> friction could hold.
module atrito_free_motion
   use atrito_assembly, only: fem_t
   use atrito_body_motions, only: motion_text, how_it_moves
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_mechanism, only: mechanism_t
   use atrito_results, only: pair_scene_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: free_motion_text

   real(wp), parameter :: SMALL = 1.0e-6_wp    !< part of a size that is none
   real(wp), parameter :: GROWS = 2.0_wp       !< times: a load that grows by more until the step ends is told as it is then, too
   integer, parameter :: DIGITS = 5
   integer(ip), parameter :: MOST_NAMES = 3_ip !< bodies or pairs that are named

contains

   !> The whole sentence.
   function free_motion_text(fem, held, rows, line, pairs, mechanism) result(text)
      type(fem_t), intent(in) :: fem             !< bodies with their names, and the mesh
      logical, intent(in) :: held(:, :)          !< (2, n_nodes)
      type(contact_rows_t), intent(in) :: rows   !< the nodes of its rows are read
      type(contact_line_t), intent(in) :: line   !< weights, laws and pairs of the points
      type(pair_scene_t), intent(in) :: pairs(:) !< names of slaves and masters
      type(mechanism_t), intent(in) :: mechanism !< of describe_motion
      character(len=:), allocatable :: text

      associate (bodies => mechanism%bodies)
         if (size(bodies) == 1) then
            text = motion_text(fem, bodies(1), mechanism%mode(:, 1))//pivot_text() &
                   //' under its load: '//cause_text('it')
         else if (mechanism%together) then
            text = body_names(fem, bodies)//' are free to '//how_it_moves(fem, bodies(1), mechanism%mode(:, 1)) &
                   //pivot_text()//' together under their loads: '//cause_text('they')
         else
            text = body_names(fem, bodies)//' are free to move under their loads: '//each_motion()//'; ' &
                   //work_text(mechanism)//joint_text(pairs, mechanism)
         end if
         text = text//'; '//support_text(fem, bodies, held, rows)
      end associate

   contains

      !> What drives bodies that move as one, and what could hold them.
      function cause_text(subject) result(text)
         character(len=*), intent(in) :: subject  !< it, they
         character(len=:), allocatable :: text, driven

         driven = 'the load drives it with '
         if (subject == 'they') driven = 'the loads drive them with '
         if (mechanism%turns) then
            text = 'the load turns it with '
            if (subject == 'they') text = 'the loads turn them with '
            text = text//driving(mechanism, .true.)//' about that point, and '
            if (any(mechanism%slides) .and. mechanism%friction > SMALL*mechanism%load) then
               text = text//'friction holds '//amount(mechanism%friction, .true.)//' at most, '//shortfall(mechanism, .true.)
            else
               text = text//'no pressure there holds '//trim(merge('it  ', 'them', subject == 'it'))
            end if
            text = text//joint_text(pairs, mechanism)
         else if (any(mechanism%slides)) then
            text = subject//trim(merge(' slides', ' slide ', subject == 'it'))//joint_text(pairs, mechanism)//', '//driven//'H = ' &
                   //driving(mechanism, .false.)//' and '//friction_text(line, mechanism)
         else if (any(mechanism%opens)) then
            text = 'the contact opens'//joint_text(pairs, mechanism)//', '//driven//driving(mechanism, .false.)
         else
            text = driven//driving(mechanism, .false.)
            if (mechanism%touches) text = text//', and no contact is in the way'
         end if
      end function cause_text

      !> The contact node about which bodies turn as one, where there is one.
      pure function pivot_text() result(text)
         character(len=:), allocatable :: text
         real(wp) :: centre(2)
         integer(ip) :: j

         text = ''
         if (.not. mechanism%turns) return
         associate (body => fem%bodies%list(mechanism%bodies(1)), mode => mechanism%mode(:, 1))
            centre = body%centre + [-mode(2), mode(1)]*body%size/mode(3)
            do j = 1, rows%n
               if (norm2(fem%mesh%x(:, rows%node(rows%first(j))) - centre) > SMALL*body%size) cycle
               text = ', which is node '//to_text(fem%mesh%node_id(rows%node(rows%first(j))))//' of the contact,'
               return
            end do
         end associate
      end function pivot_text

      !> `A can rotate about (1, 0), B can move along x1`, of the first ones.
      function each_motion() result(text)
         character(len=:), allocatable :: text
         integer(ip) :: i

         text = ''
         do i = 1, min(size(mechanism%bodies, kind=ip), MOST_NAMES)
            if (i > 1) text = text//', '
            text = text//fem%bodies%list(mechanism%bodies(i))%name//' can ' &
                   //how_it_moves(fem, mechanism%bodies(i), mechanism%mode(:, i))
         end do
      end function each_motion

   end function free_motion_text

   !> `bodies A, B, C and 5 more`
   function body_names(fem, bodies) result(text)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: bodies(:)
      character(len=:), allocatable :: text
      integer(ip) :: i, n

      n = size(bodies, kind=ip)
      text = 'bodies '
      do i = 1, min(n, MOST_NAMES)
         text = text//fem%bodies%list(bodies(i))%name//separator(i, n)
      end do
      if (n > MOST_NAMES) text = text//to_text(n - MOST_NAMES)//' more'
   end function body_names

   !> What stands behind the i-th name of n: `, `, ` and `, or nothing.
   pure function separator(i, n) result(text)
      integer(ip), intent(in) :: i, n
      character(len=:), allocatable :: text

      text = ''
      if (i < min(n, MOST_NAMES)) text = ', '
      if (i == n - 1 .and. n <= MOST_NAMES .or. i == MOST_NAMES .and. n > MOST_NAMES) text = ' and '
   end function separator

   !> What friction can hold on a sliding motion.
   function friction_text(line, mechanism) result(text)
      type(contact_line_t), intent(in) :: line
      type(mechanism_t), intent(in) :: mechanism
      character(len=:), allocatable :: text

      if (.not. any(line%tangential > 0 .and. line%law%nu > 0.0_wp .and. mechanism%slides(line%pair))) then
         text = 'there is no friction'
         return
      end if
      text = 'friction holds '
      if (line%average%is_identity .and. count(mechanism%slides) == 1) text = text//'nu times N = '
      text = text//amount(mechanism%friction, .false.)//' at most'
      if (count(mechanism%slides) == 1) then
         text = text//' (N = '//amount(mechanism%normal, .false.)
         if (.not. line%average%is_identity) text = text//', its pressure averaged by rho'
         text = text//')'
      end if
      text = text//', '//shortfall(mechanism, .false.)
   end function friction_text

   function shortfall(mechanism, turns) result(text)
      type(mechanism_t), intent(in) :: mechanism
      logical, intent(in) :: turns
      character(len=:), allocatable :: text

      text = amount(mechanism%load - mechanism%friction, turns)//' too little'
   end function shortfall

   !> What drives bodies that move in different ways.
   function work_text(mechanism) result(text)
      type(mechanism_t), intent(in) :: mechanism
      character(len=:), allocatable :: text

      if (any(mechanism%slides) .and. mechanism%friction > SMALL*mechanism%load) then
         text = 'friction takes '//to_text(100.0_wp*mechanism%friction/mechanism%load, DIGITS) &
                //' % of the work of the loads at most'
      else
         text = 'no pressure takes up the work of the loads'
      end if
   end function work_text

   !> The pairs that slide or open: ` (B3-BOTTOM on B2-TOP)`.
   function joint_text(pairs, mechanism) result(text)
      type(pair_scene_t), intent(in) :: pairs(:)
      type(mechanism_t), intent(in) :: mechanism
      character(len=:), allocatable :: text

      text = ''
      if (any(mechanism%slides)) then
         text = pair_names(pairs, mechanism%slides)
         if (mechanism%turns) text = 'sliding: '//text
      end if
      if (any(mechanism%opens .and. .not. mechanism%slides)) then
         if (len(text) > 0) text = text//'; '
         if (mechanism%turns .or. any(mechanism%slides)) text = text//'opening: '
         text = text//pair_names(pairs, mechanism%opens .and. .not. mechanism%slides)
      end if
      if (len(text) > 0) text = ' ('//text//')'
   end function joint_text

   function pair_names(pairs, chosen) result(text)
      type(pair_scene_t), intent(in) :: pairs(:)
      logical, intent(in) :: chosen(:)
      character(len=:), allocatable :: text
      integer(ip) :: i, k, n

      n = count(chosen, kind=ip)
      k = 0
      text = ''
      do i = 1, size(chosen, kind=ip)
         if (.not. chosen(i)) cycle
         k = k + 1
         if (k > MOST_NAMES) exit
         text = text//pairs(i)%slave//' on '//pairs(i)%master//separator(k, n)
      end do
      if (n > MOST_NAMES) text = text//to_text(n - MOST_NAMES)//' more'
   end function pair_names

   !> What drives the motion, and of a step that has just begun what will at its end.
   pure function driving(mechanism, turns) result(text)
      type(mechanism_t), intent(in) :: mechanism
      logical, intent(in) :: turns
      character(len=:), allocatable :: text

      text = amount(mechanism%load, turns)
      if (mechanism%load_at_end <= GROWS*mechanism%load) return
      text = text//' already ('//amount(mechanism%load_at_end, turns)//' at the end of the step)'
   end function driving

   pure function amount(force, turns) result(text)
      real(wp), intent(in) :: force
      logical, intent(in) :: turns
      character(len=:), allocatable :: text

      text = to_text(force, DIGITS)//' [F'//trim(merge(' L]', ']  ', turns))
   end function amount

   !> Supports that the bodies have, though they leave them this motion; rows of one body are those along a direction of their own,
   !> springs to the ground, and equations.
   pure function support_text(fem, bodies, held, rows) result(text)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: bodies(:)
      logical, intent(in) :: held(:, :)        !< (2, n_nodes)
      type(contact_rows_t), intent(in) :: rows
      character(len=:), allocatable :: text
      integer(ip) :: b, i, dof, dofs, n, first, first_dof
      integer(ip), allocatable :: of_one(:)    ! bilateral rows of one of the bodies alone
      logical :: is_held

      n = 0
      first = 0
      first_dof = 0
      do b = 1, size(bodies, kind=ip)
         associate (body => fem%bodies%list(bodies(b)))
            dofs = 2
            if (body%is_rigid) dofs = size(body%modes, 1, kind=ip)
            do i = 1, merge(1_ip, size(body%nodes, kind=ip), body%is_rigid)
               do dof = 1, dofs
                  if (body%is_rigid) then           ! of u1, u2 and the rotation that in which its modes have nothing
                     is_held = .not. any(abs(body%modes(dof, :)) > 0.0_wp)
                  else
                     is_held = held(dof, body%nodes(i))
                  end if
                  if (is_held) n = n + 1
                  if (first > 0 .or. .not. is_held) cycle
                  first = fem%mesh%node_id(body%nodes(i))
                  first_dof = dof
               end do
            end do
         end associate
      end do
      of_one = pack([(i, i=rows%n - rows%n_bilateral + 1, rows%n)], &
                    [(any([(all(fem%bodies%of_node(rows%node(rows%first(i):rows%first(i + 1) - 1)) == bodies(b)), &
                            b=1, size(bodies))]), i=rows%n - rows%n_bilateral + 1, rows%n)])
      if (n == 0 .and. size(of_one) == 0) then
         text = trim(merge('it has no support   ', 'they have no support', size(bodies) == 1))
      else if (n == 0) then
         text = trim(merge('its  ', 'their', size(bodies) == 1))//' supports along directions of their own, springs or equations ' &
                //'(node '//to_text(fem%mesh%node_id(rows%node(rows%first(of_one(1)))))
         if (size(of_one) > 1) text = text//' and '//to_text(size(of_one) - 1)//' more'
         text = text//') do not prevent that'
      else
         text = trim(merge('its supports (node  ', 'their supports (node', size(bodies) == 1))//' '//to_text(first)//' ' &
                //trim(merge('against rotation', 'along x'//to_text(first_dof)//repeat(' ', 8), first_dof == 3))
         if (n > 1) text = text//' and '//to_text(n - 1)//' more'
         text = text//') do not prevent that'
      end if
   end function support_text

end module atrito_free_motion
