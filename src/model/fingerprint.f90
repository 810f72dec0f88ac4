!> The fingerprint of a model: a digest of each of its parts, by which a restart file is known to belong to a deck, and which says
!> what differs where it does not.
!>
!> It is that of the model, not of the deck's text: comments, names of files and the order of cards do not matter, nor does how
!> often restart files are written. Parts of a step are compared up to the step that has begun; later ones may be changed.
module atrito_fingerprint
   use atrito_bilateral_rows, only: bilateral_rows_t
   use atrito_digest, only: digest_t, add_to, add_allocated, digest_text
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t
   use atrito_model, only: model_t, path_t, step_t, nodal_values_t, element_load_t, requested_t, all_frequencies
   use atrito_points, only: contact_points_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: fingerprint_t, take_fingerprint, find_difference

   !> A part of a model.
   type :: part_t
      character(len=:), allocatable :: name          !< e.g. 'mesh', 'loads of step 2'
      character(len=:), allocatable :: size          !< in words
      character(len=:), allocatable :: digest        !< 16 hexadecimal digits
      integer(ip) :: step = 0                        !< that it belongs to; 0: the whole history
   end type part_t

   !> A model and the options of a run, part by part.
   type :: fingerprint_t
      type(part_t), allocatable :: parts(:)          !< of the scene, then of each step
      integer(ip) :: n_steps = 0                     !< of the history
   end type fingerprint_t

   integer(ip), parameter :: SCENE_PARTS = 7, STEP_PARTS = 5

contains

   !> The fingerprint of a model and of the options of a run, part by part.
   subroutine take_fingerprint(model, options, fingerprint)
      type(model_t), intent(in) :: model              !< whole: mesh, laws, surfaces, rows and all steps
      character(len=*), intent(in) :: options         !< of the run, that change digits of its results
      type(fingerprint_t), intent(out) :: fingerprint !< of the scene, options and all steps
      type(digest_t) :: of_options
      integer(ip) :: i

      call add_to(of_options, options)
      fingerprint%n_steps = size(model%steps, kind=ip)
      allocate (fingerprint%parts(SCENE_PARTS + STEP_PARTS*fingerprint%n_steps))
      associate (parts => fingerprint%parts)
         parts(1) = make_part('mesh', to_text(model%mesh%n_nodes)//' nodes, '//to_text(model%mesh%n_elements)//' elements', &
                              digest_of_mesh(model%mesh))
         parts(2) = make_part('sections and materials', to_text(size(model%materials, kind=ip))//' materials', &
                              digest_of_materials(model))
         parts(3) = make_part('surfaces', to_text(size(model%surfaces, kind=ip))//' surfaces', digest_of_surfaces(model))
         parts(4) = make_part('surface interactions', to_text(size(model%interactions, kind=ip))//' interactions', &
                              digest_of_interactions(model))
         parts(5) = make_part('contact pairs', to_text(size(model%pairs, kind=ip))//' pairs', digest_of_pairs(model))
         parts(6) = make_part('ties, equations and springs', to_text(model%bilateral%n)//' rows', digest_of_rows(model%bilateral))
         parts(7) = make_part('options', options, of_options)
         do i = 1, fingerprint%n_steps
            parts(SCENE_PARTS + STEP_PARTS*(i - 1) + 1:SCENE_PARTS + STEP_PARTS*i) = parts_of_step(model, i)
         end do
      end associate
   end subroutine take_fingerprint

   pure type(part_t) function make_part(name, size_of, digest) result(part)
      character(len=*), intent(in) :: name, size_of
      type(digest_t), intent(in) :: digest

      part%name = name
      part%size = size_of
      part%digest = digest_text(digest)
   end function make_part

   pure function digest_of_mesh(mesh) result(digest)
      type(mesh_t), intent(in) :: mesh
      type(digest_t) :: digest

      call add_to(digest, mesh%node_id(:mesh%n_nodes))
      call add_to(digest, mesh%x(:, :mesh%n_nodes))
      call add_to(digest, mesh%element_id(:mesh%n_elements))
      call add_to(digest, mesh%shape(:mesh%n_elements))
      call add_to(digest, mesh%state(:mesh%n_elements))
      call add_to(digest, mesh%nodes(:, :mesh%n_elements))
      if (allocated(mesh%thickness)) call add_to(digest, mesh%thickness)
      call add_to(digest, mesh%digit_error)
   end function digest_of_mesh

   pure function digest_of_materials(model) result(digest)
      type(model_t), intent(in) :: model
      type(digest_t) :: digest
      integer :: i

      do i = 1, size(model%materials)
         associate (material => model%materials(i))
            call add_to(digest, [material%young, material%poisson, material%density, material%expansion])
            call add_to(digest, material%has_expansion)
            call add_to(digest, material%is_orthotropic)
            if (material%is_orthotropic) call add_to(digest, material%stiffness)
         end associate
      end do
      do i = 1, size(model%sections)
         call add_to(digest, model%sections(i)%material)
         call add_to(digest, model%sections(i)%thickness)
         call add_to(digest, model%sections(i)%formulation)
         call add_to(digest, model%sections(i)%axis)
      end do
      call add_allocated(digest, model%section_of)
   end function digest_of_materials

   pure function digest_of_surfaces(model) result(digest)
      type(model_t), intent(in) :: model
      type(digest_t) :: digest
      integer :: i

      do i = 1, size(model%surfaces)
         associate (surface => model%surfaces(i))
            call add_allocated(digest, surface%name)
            call add_to(digest, surface%kind)
            call add_to(digest, surface%is_rigid_body)
            call add_to(digest, surface%faces%n)
            if (surface%faces%n > 0) call add_to(digest, surface%faces%element(:surface%faces%n))
            if (surface%faces%n > 0) call add_to(digest, surface%faces%face(:surface%faces%n))
            call add_allocated(digest, surface%points)
            call add_allocated(digest, surface%is_arc)
            if (.not. allocated(surface%is_arc)) cycle
            if (any(surface%is_arc)) call add_allocated(digest, surface%centre)
         end associate
      end do
      if (.not. allocated(model%rigid_bodies)) return
      if (size(model%rigid_bodies) == 0) return
      call add_to(digest, model%rigid_bodies%surface)
      call add_to(digest, model%rigid_bodies%node)
   end function digest_of_surfaces

   pure function digest_of_interactions(model) result(digest)
      type(model_t), intent(in) :: model
      type(digest_t) :: digest
      integer :: i

      do i = 1, size(model%interactions)
         associate (law => model%interactions(i))
            call add_allocated(digest, law%name)
            call add_to(digest, [law%delta, law%nu, law%eps, law%rho, law%stick_slope])
            call add_to(digest, [law%friction, law%kernel])
            call add_to(digest, law%is_incremental)
         end associate
      end do
   end function digest_of_interactions

   pure function digest_of_pairs(model) result(digest)
      type(model_t), intent(in) :: model
      type(digest_t) :: digest
      integer :: i

      do i = 1, size(model%pairs)
         associate (pair => model%pairs(i))
            call add_to(digest, [pair%interaction, pair%slave, pair%master, pair%quadrature, pair%outline])
            call add_to(digest, [pair%is_adjusted, pair%gap_is_given])
         end associate
      end do
      if (.not. allocated(model%points)) return
      do i = 1, size(model%points)
         call add_points(digest, model%points(i))
      end do
   end function digest_of_pairs

   !> Points with their gaps: what *CLEARANCE and ADJUST made of them is in them.
   pure subroutine add_points(digest, points)
      type(digest_t), intent(inout) :: digest
      type(contact_points_t), intent(in) :: points

      call add_to(digest, points%n)
      call add_to(digest, [points%matching, points%rigid, points%is_mortar])
      if (points%n == 0) return
      call add_to(digest, points%x(:, :points%n))
      call add_to(digest, points%normal(:, :points%n))
      call add_to(digest, points%gap(:points%n))
      call add_allocated(digest, points%given_gap)
      call add_allocated(digest, points%given_node)
      call add_to(digest, points%weight(:points%n))
      call add_to(digest, points%entry(:points%first(points%n + 1) - 1))
      call add_to(digest, points%coefficient(:points%first(points%n + 1) - 1))
   end subroutine add_points

   pure function digest_of_rows(rows) result(digest)
      type(bilateral_rows_t), intent(in) :: rows
      type(digest_t) :: digest
      integer(ip) :: last

      call add_to(digest, rows%n)
      if (rows%n == 0) return
      last = rows%first(rows%n + 1) - 1
      call add_to(digest, rows%first(:rows%n + 1))
      call add_to(digest, rows%node(:last))
      call add_to(digest, rows%vector(:, :last))
      call add_to(digest, rows%compliance(:rows%n))
      call add_to(digest, rows%weight(:rows%n))
      call add_to(digest, rows%kind(:rows%n))
      call add_to(digest, rows%group(:rows%n))
      call add_to(digest, rows%part(:rows%n))
      call add_to(digest, rows%value(:rows%n))
   end function digest_of_rows

   !> The parts of a step.
   pure function parts_of_step(model, i) result(parts)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i
      type(part_t) :: parts(STEP_PARTS)
      type(digest_t) :: supports, loads, overlaps, way, requests

      associate (step => model%steps(i), of_step => ' of step '//to_text(i))
         call add_nodal_values(supports, model, step%prescribed)
         if (step%rigid_prescribed%n > 0) call add_nodal_values(supports, model, step%rigid_prescribed)
         call add_to(supports, step%at_once)
         call add_nodal_values(loads, model, step%node_loads)
         if (step%rigid_loads%n > 0) call add_nodal_values(loads, model, step%rigid_loads)
         call add_element_loads(loads, model, step%element_loads)
         call add_allocated(loads, step%heating)
         call add_allocated(loads, step%heating_from)
         call add_to(loads, step%at_once)
         call add_allocated(overlaps, step%overlap)
         call add_allocated(overlaps, step%overlap_from)
         call add_way(way, step)
         call add_requests(requests, model, step)
         parts(1) = make_part('prescribed displacements'//of_step, to_text(step%prescribed%n + step%rigid_prescribed%n)// &
                              ' values', supports)
         parts(2) = make_part('loads'//of_step, to_text(step%node_loads%n + step%rigid_loads%n)//' on nodes, '// &
                              to_text(step%element_loads%n)//' on elements', loads)
         parts(3) = make_part('*CONTACT INTERFERENCE'//of_step, '', overlaps)
         parts(4) = make_part('*STATIC or *CONTROLS'//of_step, '', way)
         parts(5) = make_part('what is printed in step '//to_text(i), '', requests)
      end associate
      parts%step = i
   end function parts_of_step

   pure subroutine add_nodal_values(digest, model, values)
      type(digest_t), intent(inout) :: digest
      type(model_t), intent(in) :: model
      type(nodal_values_t), intent(in) :: values

      call add_to(digest, values%n)
      if (values%n == 0) return
      call add_to(digest, values%node(:values%n))
      call add_to(digest, values%dof(:values%n))
      call add_to(digest, values%value(:values%n))
      if (allocated(values%from)) call add_to(digest, values%from(:values%n))
      if (allocated(values%amplitude)) call add_amplitudes(digest, model, values%amplitude(:values%n))
   end subroutine add_nodal_values

   pure subroutine add_element_loads(digest, model, loads)
      type(digest_t), intent(inout) :: digest
      type(model_t), intent(in) :: model
      type(element_load_t), intent(in) :: loads

      call add_to(digest, loads%n)
      if (loads%n == 0) return
      call add_to(digest, loads%element(:loads%n))
      call add_to(digest, loads%kind(:loads%n))
      call add_to(digest, loads%face(:loads%n))
      call add_to(digest, loads%value(:, :loads%n))
      if (allocated(loads%from)) call add_to(digest, loads%from(:, :loads%n))
      if (allocated(loads%amplitude)) call add_amplitudes(digest, model, loads%amplitude(:loads%n))
   end subroutine add_element_loads

   !> Each amplitude that is used, once, and which value has which: an amplitude of later steps does not matter.
   pure subroutine add_amplitudes(digest, model, used)
      type(digest_t), intent(inout) :: digest
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: used(:)              !< places; 0: none
      integer(ip) :: number(0:size(model%amplitudes))
      integer :: i

      number = 0
      do i = 1, size(used)
         if (used(i) > 0) then
            if (number(used(i)) == 0) then
               number(used(i)) = maxval(number) + 1_ip
               associate (amplitude => model%amplitudes(used(i)))
                  call add_allocated(digest, amplitude%time)
                  call add_allocated(digest, amplitude%value)
                  call add_to(digest, [amplitude%is_total_time, amplitude%is_smooth])
               end associate
            end if
         end if
         call add_to(digest, number(used(i)))
      end do
   end subroutine add_amplitudes

   !> How the step goes through its time.
   pure subroutine add_way(digest, step)
      type(digest_t), intent(inout) :: digest
      type(step_t), intent(in) :: step

      associate (way => step%increments)
         call add_to(digest, [way%initial, way%period, way%least, way%greatest])
         call add_to(digest, way%most)
      end associate
      associate (controls => step%controls)
         call add_to(digest, [controls%method, controls%max_iterations, controls%starts])
         call add_to(digest, [controls%tolerance, controls%relaxation, controls%most_entries])
         call add_to(digest, controls%is_coarse)
      end associate
   end subroutine add_way

   !> What is printed decides which increments are kept.
   pure subroutine add_requests(digest, model, step)
      type(digest_t), intent(inout) :: digest
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: step
      integer(ip) :: i

      call add_requested(digest, step%requests%requested_t)
      call add_requested(digest, step%requests%fields)
      call add_to(digest, [step%requests%bodies, step%requests%joints, step%requests%nodal_stress])
      call add_allocated(digest, step%requests%node_s)
      call add_to(digest, all_frequencies(step%requests%every))
      if (allocated(step%requests%paths)) call add_paths(digest, model%paths(step%requests%paths))
      if (.not. allocated(step%requests%cuts)) return
      do i = 1, size(step%requests%cuts, kind=ip)
         associate (cut => model%cuts(step%requests%cuts(i)))
            call add_to(digest, cut%name)
            call add_to(digest, cut%ends)
            call add_to(digest, cut%elset)
         end associate
      end do
   end subroutine add_requests

   pure subroutine add_paths(digest, paths)
      type(digest_t), intent(inout) :: digest
      type(path_t), intent(in) :: paths(:)
      integer :: i

      do i = 1, size(paths)
         associate (path => paths(i))
            call add_to(digest, path%name)
            call add_to(digest, [path%is_arc, path%has_centre])
            call add_to(digest, path%ends)
            call add_to(digest, [path%centre, path%radius, path%angles])
            call add_to(digest, [path%n_points, path%elset])
         end associate
      end do
   end subroutine add_paths

   pure subroutine add_requested(digest, requested)
      type(digest_t), intent(inout) :: digest
      class(requested_t), intent(in) :: requested

      call add_to(digest, [requested%nodes, requested%reactions, requested%stress, requested%contact, requested%principal])
      call add_allocated(digest, requested%node_u)
      call add_allocated(digest, requested%node_rf)
      call add_allocated(digest, requested%element_s)
   end subroutine add_requested

   !> What of a file's fingerprint is not that of the deck, in words; '' where they agree up to a step.
   pure function find_difference(in_file, in_deck, step) result(text)
      type(fingerprint_t), intent(in) :: in_file, in_deck !< of the restart file, and of this run
      integer(ip), intent(in) :: step                 !< that has begun
      character(len=:), allocatable :: text
      integer :: i, k

      text = ''
      if (step > in_deck%n_steps) then
         text = 'it stands in step '//to_text(step)//', the deck has '//to_text(in_deck%n_steps)
         return
      end if
      do i = 1, size(in_deck%parts)
         associate (part => in_deck%parts(i))
            if (part%step > step) cycle
            do k = 1, size(in_file%parts)
               if (in_file%parts(k)%name == part%name) exit
            end do
            if (k > size(in_file%parts)) then
               text = 'it has no '//part%name
            else if (in_file%parts(k)%digest /= part%digest) then
               text = part%name//': not the same'
               if (in_file%parts(k)%size /= part%size) text = part%name//': '//in_file%parts(k)%size//' in the file, '// &
                                                              part%size//' in the deck'
            end if
         end associate
         if (len(text) > 0) return
      end do
   end function find_difference

end module atrito_fingerprint
