!> Whether the contact forces make sense beside all that can ask for them, and whether those upon the two sides of a pair add up.
!>
!> Contact forces are as large as loads, overlaps, temperatures and prescribed displacements make them, times what levers and wedges
!> make of it. A pair that carries a hundred times as much is wedged by normals that are hardly apart from the free motion, so the
!> last digits of the coordinates decide what comes out.
module atrito_force_sense
   use atrito_contact_rows, only: contact_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_messages, only: add_warning
   use atrito_points, only: contact_points_t
   use atrito_results, only: contact_result_t, pair_scene_t, results_t
   use atrito_scene_data, only: scene_data_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: force_sense_t, watch_forces, tell_forces, pair_force, free_share, sides_differ

   !> What was seen so far of a run.
   type :: force_sense_t
      real(wp) :: asked = 0.0_wp                 !< the most so far that anything asked for, which friction may keep [F]
      integer(ip) :: wedged = 0                  !< pair that carried most beside that; 0: none too much
      real(wp) :: force = 0.0_wp, beside = 0.0_wp !< what it carried, and what was asked for [F]
      real(wp) :: times = 0.0_wp                 !< the one over the other
      integer(ip) :: held_pair = 0, held_point = 0 !< a point that its support wedges, and its pair; 0: none
      real(wp) :: held_force = 0.0_wp, held_beside = 0.0_wp !< the same of it [F]
      integer(ip) :: unbalanced = 0              !< pair whose sides do not add up; 0: all do
      real(wp) :: off = 0.0_wp, moment = 0.0_wp  !< the part of force times length that is missing; and the moment [F L]
   end type force_sense_t

   real(wp), parameter :: WEDGE = 100.0_wp        !< times what is asked for: a lever of 100 to 1, a wedge of 0.3 degrees
   !> A point whose row leaves no more than this to the dofs that are free, and that carries so many times what is asked for, is
   !> wedged by its support: of a force along the normal the support takes almost all.
   real(wp), parameter :: HELD = 0.1_wp, HELD_WEDGE = 5.0_wp
   real(wp), parameter :: ALIKE = 1.0e-6_wp      !< pairs that differ by less: the first one is told
   real(wp), parameter :: UNBALANCED = 0.01_wp   !< of force times length of a pair: moments of curved sides are off by less

contains

   !> Looks at an increment that was solved.
   subroutine watch_forces(data, results, sense)
      type(scene_data_t), intent(in) :: data      !< what acts, points and rows
      type(results_t), intent(in) :: results      !< of an increment that was solved
      type(force_sense_t), intent(inout) :: sense !< keeps the worst of all increments so far
      real(wp) :: force, times, off, moment
      integer(ip) :: i, j, first

      if (size(data%points) == 0) return
      sense%asked = max(sense%asked, asked_for(data))
      first = 0
      do i = 1, size(data%points, kind=ip)
         associate (contact => results%contact(i))
            do j = 1, contact%n                     ! at nodes that are held almost along their normals
               force = contact%weight(j)*contact%pressure(j)
               if (force <= max(HELD_WEDGE*sense%asked, sense%held_force)) cycle
               if (free_share(data%rows, first + j, data%held) > HELD) cycle
               sense%held_pair = i
               sense%held_point = j
               sense%held_force = force
               sense%held_beside = sense%asked
            end do
         end associate
         first = first + data%points(i)%n
         force = pair_force(results%contact(i))
         if (force > WEDGE*sense%asked) then
            times = huge(times)
            if (sense%asked > tiny(times)*force) times = force/sense%asked
            if (sense%wedged == 0 .or. times*(1 - ALIKE) > sense%times) then
               sense%wedged = i
               sense%force = force
               sense%beside = sense%asked
               sense%times = times
            end if
         end if
         call sides_differ(data%points(i), data%fem%mesh%x, results%contact(i), off, moment, data%rows, &
                           first - data%points(i)%n)
         if (off <= max(UNBALANCED, sense%off)) cycle
         sense%unbalanced = i
         sense%off = off
         sense%moment = moment
      end do
   end subroutine watch_forces

   !> What is left of the row of a point at the dofs that are free, as a part of it.
   pure real(wp) function free_share(rows, j, held) result(share)
      type(contact_rows_t), intent(in) :: rows   !< coefficients and normals of the points
      integer(ip), intent(in) :: j               !< of the rows; some coefficient of it is not 0
      logical, intent(in) :: held(:, :)          !< (2, n_nodes)
      real(wp) :: free, all
      integer(ip) :: k

      free = 0.0_wp
      all = 0.0_wp
      do k = rows%first(j), rows%first(j + 1) - 1
         associate (row => rows%coefficient(k)*rows%normal(:, j))
            free = free + sum(row**2, mask=.not. held(:, rows%node(k)))
            all = all + sum(row**2)
         end associate
      end do
      share = sqrt(free/all)
   end function free_share

   !> The largest of the forces that loads, temperatures, overlaps and prescribed displacements can make where nothing is wedged: of
   !> a displacement what it makes if one face takes it up, at each of the points.
   real(wp) function asked_for(data) result(force)
      type(scene_data_t), intent(in) :: data
      real(wp) :: moved, depth
      integer(ip) :: i

      force = sum(hypot(data%f(1, :), data%f(2, :)))
      if (allocated(data%thermal)) force = force + sum(hypot(data%thermal(1, :), data%thermal(2, :)))
      moved = max(maxval(abs(data%value), mask=data%held), -minval(data%rows%gap), 0.0_wp)
      if (data%rows%n_bilateral > 0) moved = max(moved, maxval(abs(data%rows%gap(data%rows%n - data%rows%n_bilateral + 1:))))
      do i = 1, data%rigid_prescribed%n             ! with what rotations make of the size of the surface
         associate (dof => data%rigid_prescribed%dof(i), value => abs(data%rigid_prescribed%value(i)))
            moved = max(moved, value*merge(1.0_wp, maxval(data%model%rigid_bodies%size), dof <= 2))
         end associate
      end do
      if (.not. moved > 0.0_wp) return
      depth = maxval(data%fem%sections%thickness)
      do i = 1, size(data%points, kind=ip)          ! or the way round the axis
         if (data%points(i)%n > 0) depth = max(depth, maxval(data%points(i)%weight/data%points(i)%length))
      end do
      force = force + maxval(data%model%materials%young)*depth*moved*real(data%rows%n + count(data%held), wp)
   end function asked_for

   !> The sum of the sizes of a pair's forces [F].
   pure real(wp) function pair_force(contact) result(force)
      type(contact_result_t), intent(in) :: contact !< of a pair

      force = sum(contact%weight*hypot(contact%pressure, contact%shear))
   end function pair_force

   !> What the forces of a pair upon both sides leave as a force or a moment: they should add up to nothing. None of a rigid master,
   !> on which no force is put.
   !>
   !> The force F_j of a point acts with c_jk F_j at the nodes k of its row, the slave's c adding up to 1 and the master's to -1.
   !> So
   !>
   !>     sum_j (sum_k c_jk) F_j = 0,     M = sum_j (sum_k c_jk (x_k - middle)) x F_j + couples
   !>
   !> where the first is zero but for round-off. M is zero where the force acts at one place on both sides: x_s - x_m along F. It
   !> is not where sides are apart along the tangent, or shear acts over a gap; what turning rows put at the nodes besides is
   !> counted (couples).
   pure subroutine sides_differ(points, x, contact, off, moment, rows, before)
      type(contact_points_t), intent(in) :: points !< of the pair
      real(wp), intent(in) :: x(:, :)            !< (2, n_nodes) [L]
      type(contact_result_t), intent(in) :: contact !< of the pair
      real(wp), intent(out) :: off               !< the larger one, in parts of the forces and of their lever
      real(wp), intent(out) :: moment            !< [F L]
      type(contact_rows_t), intent(in), optional :: rows !< that may balance moments (atrito_turning_rows)
      integer(ip), intent(in), optional :: before !< rows of the pairs before
      real(wp) :: force(2), arm(2), left(2), middle(2), total, size_of_pair, balance
      integer(ip) :: j, k

      off = 0.0_wp
      moment = 0.0_wp
      if (points%rigid .or. points%n == 0) return
      total = pair_force(contact)
      if (.not. total > 0.0_wp) return
      middle = sum(points%x, dim=2)/points%n
      left = 0.0_wp
      do j = 1, points%n
         associate (n => contact%normal(:, j))
            force = contact%weight(j)/total*(contact%shear(j)*[-n(2), n(1)] - contact%pressure(j)*n)
         end associate
         arm = 0.0_wp
         balance = 0.0_wp
         do k = points%first(j), points%first(j + 1) - 1
            arm = arm + points%coefficient(k)*(x(:, points%entry(k)) - middle)
            balance = balance + points%coefficient(k)
         end do
         moment = moment + (arm(1)*force(2) - arm(2)*force(1))
         left = left + balance*force
         if (present(rows) .and. present(before)) then
            moment = moment + contact%weight(j)/total*dot_product([-contact%pressure(j), contact%shear(j)], &
                                                                  couples(rows, before + j, x))
         end if
      end do
      size_of_pair = maxval(norm2(points%x - spread(middle, 2, points%n), dim=1))
      off = max(norm2(left), abs(moment)/size_of_pair)
      moment = moment*total
   end subroutine sides_differ

   !> The moments of what the normal and the tangential row put along the normal besides [L].
   pure function couples(rows, j, x)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: j
      real(wp), intent(in) :: x(:, :)            !< (2, n_nodes) [L]
      real(wp) :: couples(2), arm(2)
      integer(ip) :: k

      couples = 0.0_wp
      if (.not. allocated(rows%turn)) return
      do k = rows%first(j), rows%first(j + 1) - 1
         arm = x(:, rows%node(k)) - x(:, rows%node(rows%first(j)))
         couples = couples + rows%turn(:, k)*(arm(1)*rows%normal(2, j) - arm(2)*rows%normal(1, j))
      end do
   end function couples

   !> Tells what was seen of a run.
   subroutine tell_forces(pairs, contact, sense)
      type(pair_scene_t), intent(in) :: pairs(:)       !< names of their surfaces
      type(contact_result_t), intent(in) :: contact(:) !< one a pair, for the places
      type(force_sense_t), intent(in) :: sense         !< by watch_forces
      character(len=:), allocatable :: text

      if (sense%wedged > 0) then
         text = pair_text(pairs(sense%wedged))//' carries forces of '//to_text(sense%force, 3)//' [F], more than a hundred times' &
                //' what loads, overlaps, temperatures and prescribed displacements can ask for ('//to_text(sense%beside, 3) &
                //' [F]): bodies are wedged, by normals that are hardly apart from a motion that is free otherwise, and the last' &
                //' digits of the coordinates decide how far'
         call add_warning('W-WEDGE', text)
      end if
      if (sense%held_pair > 0) then
         associate (x => contact(sense%held_pair)%x(:, sense%held_point))
            text = pair_text(pairs(sense%held_pair))//' carries '//to_text(sense%held_force, 3)//' [F] at the point (' &
                   //to_text(x(1), 5)//', '//to_text(x(2), 5)//'), where '//to_text(sense%held_beside, 3)//' [F] act in all:' &
                   //' a support holds the node almost, but not quite, along the normal of the contact, and the two are wedged.' &
                   //' Hold it along the normal, or leave the node out of the slave'
         end associate
         call add_warning('W-WEDGE', text)
      end if
      if (sense%unbalanced > 0) then
         text = 'the forces of '//pair_text(pairs(sense%unbalanced))//' upon its two sides do not add up: a moment of ' &
                //to_text(sense%moment, 3)//' [F L] is left, '//to_text(100*sense%off, 3)//' % of the forces times the length of' &
                //' the pair; it is missing in the sums of resultants.tab'
         call add_warning('W-SUMS', text)
      end if
   end subroutine tell_forces

   pure function pair_text(pair) result(text)
      type(pair_scene_t), intent(in) :: pair
      character(len=:), allocatable :: text

      text = pair%slave//' on '//pair%master
   end function pair_text

end module atrito_force_sense
