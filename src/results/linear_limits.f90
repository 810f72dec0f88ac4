!> Where a solution leaves what a linear theory knows: strain, rotation and slip that are not small.
module atrito_linear_limits
   use atrito_assembly, only: fem_t
   use atrito_kinds, only: ip, wp
   use atrito_large_deformation, only: deformation_t, may_rotate, measure_deformation
   use atrito_messages, only: add_note, add_warning
   use atrito_model, only: model_t
   use atrito_results, only: results_t, extreme_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: find_large, warn_of_large, LARGE_STRAIN, LARGE_ROTATION, LARGE_SLIP

   !> Above these a linear theory is wrong by some percent.
   real(wp), parameter :: LARGE_STRAIN = 0.05_wp      !< principal strain
   real(wp), parameter :: LARGE_ROTATION = 0.1_wp     !< [rad]
   real(wp), parameter :: LARGE_SLIP = 0.05_wp        !< over the length of the joint, from end to end

   !> The bound of the strains is one at the Gauss points; the best points lie between them.
   real(wp), parameter :: NEAR = 0.8_wp

contains

   !> The largest strain, rotation and slip, where they pass their bounds; 0 elsewhere.
   subroutine find_large(model, fem, strain_bound, results)
      type(model_t), intent(in) :: model                 !< ids and points of its pairs
      type(fem_t), intent(in) :: fem                     !< whole scene
      real(wp), intent(in) :: strain_bound               !< no strain is larger than this
      type(results_t), intent(inout) :: results          !< with u, contact and joints; gets large_*
      type(deformation_t) :: largest
      logical :: deforms, rotates
      integer(ip) :: i, j
      real(wp) :: bound

      rotates = .false.
      deforms = strain_bound > NEAR*LARGE_STRAIN
      if (.not. deforms) rotates = may_rotate(fem%mesh, results%u, LARGE_ROTATION)
      if (deforms .or. rotates) then
         call measure_deformation(fem, results%u, deforms, LARGE_ROTATION, largest)
         if (largest%strain > LARGE_STRAIN) results%large_strain = extreme_t(largest%strain, &
                                                                      fem%mesh%element_id(largest%strain_element), largest%strain_x)
         if (largest%rotation > LARGE_ROTATION) results%large_rotation = extreme_t(largest%rotation, &
                                                                  fem%mesh%element_id(largest%rotation_element), largest%rotation_x)
      end if
      do i = 1, size(results%contact, kind=ip)
         ! The largest slip of a pair's closed points that is more than its part of the joint, from end to end: how fine the mesh
         ! is does not count.
         associate (contact => results%contact(i))
            do j = 1, contact%n
               bound = 2*LARGE_SLIP*results%joints(contact%joint(j))%length
               if (.not. contact%pressure(j) > 0.0_wp .or. abs(contact%slip(j)) <= max(bound, results%large_slip%value)) cycle
               if (bound <= 0.0_wp) cycle                   ! a single point has no extent
               results%large_slip = extreme_t(abs(contact%slip(j)), model%mesh%node_id(model%points(i)%node(j)), contact%x(:, j), &
                                              is_node=.true.)
            end do
         end associate
      end do
   end subroutine find_large

   !> What passes its bound, and what follows.
   subroutine warn_of_large(results, asks_nlgeom)
      type(results_t), intent(in) :: results             !< its large_* are read
      logical, intent(in) :: asks_nlgeom                 !< the deck asks for large displacements
      logical :: is_small

      is_small = max(results%large_strain%value, results%large_rotation%value, results%large_slip%value) <= 0.0_wp
      if (asks_nlgeom .and. is_small) then
         call add_note('N-SMALL', 'NLGEOM: no strain is above '//to_text(LARGE_STRAIN)//', no rotation above '// &
                       to_text(LARGE_ROTATION)//' rad and no slip above '//to_text(LARGE_SLIP)//' of its joint: large '// &
                       'displacements would hardly change the results, but for what is near buckling')
      end if
      if (results%large_strain%value > 0.0_wp) call add_warning('W-LARGE', 'the largest strain is '// &
                          value_text(results%large_strain)//': above '//to_text(LARGE_STRAIN)//' lengths and areas change so much' &
                        //' that the linear theory, which takes them as they are without loads, does not know the true equilibrium')
      if (results%large_rotation%value > 0.0_wp) call add_warning('W-LARGE', 'the largest rotation is '// &
                       value_text(results%large_rotation)//': above '//to_text(LARGE_ROTATION)//' rad the linear theory, in which' &
                               //' forces and normals keep their directions and a rotation makes strains, does not know the motion')
      if (results%large_slip%value > 0.0_wp) call add_warning('W-LARGE', 'the largest slip of a closed point is '// &
                           value_text(results%large_slip)//': above '//to_text(LARGE_SLIP)//' of the length of its contact the '// &
                             'linear theory, in which a point faces what it faced without loads, does not know what it has come to')
   end subroutine warn_of_large

   !> `0.12 at element 7 (1.5, 0)`
   pure function value_text(extreme) result(text)
      type(extreme_t), intent(in) :: extreme
      character(len=:), allocatable :: text

      text = to_text(extreme%value, 3)//trim(merge(' at node   ', ' at element', extreme%is_node))//' '//to_text(extreme%id) &
             //' ('//to_text(extreme%x(1), 5)//', '//to_text(extreme%x(2), 5)//')'
   end function value_text

end module atrito_linear_limits
