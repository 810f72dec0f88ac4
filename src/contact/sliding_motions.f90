!> Motions in which both sides of a pair slide along themselves: a translation along straight sides, a rotation about the common
!> centre of round ones. Nothing but friction resists them.
!>
!> In the exact shapes n . v = 0 at every point, n being the normal and v the motion. Of shapes that are given by nodes with a few
!> digits, or by chords of a curve, n . v is a small number of either sign, and a body that is free to slide would be held by it:
!> by contact forces as large as the loads over that number. So the motion is found from the chords, and the rows of the points are
!> turned until it moves no point along its normal.
!>
!> Chords tell more than normals at nodes do: the perpendicular bisectors of all chords of a circle meet in its centre, however long
!> the chords are. A motion v(x) = t + w perp(x - o), perp(a) = (-a2, a1), is wanted with n_f . v(x_f) = 0 at the middle x_f of each
!> chord f, n_f its normal: three unknowns, and the least eigenvalue of
!>
!>     A = sum_f h_f^2 r_f r_f',    r_f = (n_f, n_f . perp(x_f - o)/L),     h_f the length of the chord
!>
!> has it as its vector, since a node that is off by g turns a chord by g/h_f. It is one that is meant when at each chord |n .
!> v|/|v| is less than what the printed digits, or the resolution of a curve of radius R by chords, leave in doubt:
!>
!>     3 g/h_f   or   (h_f/R)^2/100
module atrito_sliding_motions
   use atrito_dense, only: eigen_symmetric
   use atrito_element_table, only: MOST_SIDES
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_master, only: look_along, master_t
   use atrito_mesh, only: mesh_t, face_nodes
   use atrito_pieces, only: place_at, normal_at
   use atrito_points, only: contact_points_t, sliding_t
   use atrito_slave_faces, only: nodal_rule_t, nodal_rule, turn_at, sine
   implicit none (type, external)
   private
   public :: chords_t, list_chords, find_sliding, note_doubt, serves, adopted, sharpness, velocity, printed_digit_error

   !> The chords of both sides of a pair.
   type :: chords_t
      integer(ip) :: n = 0                          !< chords
      real(wp), allocatable :: place(:, :)          !< (2, n) their middles [L]
      real(wp), allocatable :: normal(:, :)         !< (2, n) unit vectors out of their bodies
      real(wp), allocatable :: length(:)            !< (n) [L]
      logical, allocatable :: of_slave(:)           !< (n)
      real(wp) :: digit_error = 0.0_wp              !< to which the nodes are known [L]
   end type chords_t

   real(wp), parameter :: DIGITS_TURN = 3.0_wp      !< by what a chord may be turned, in digit errors over its length
   real(wp), parameter :: CURVE_TURN = 0.01_wp      !< the same of chords of a curve, in squares of the angle they span
   real(wp), parameter :: LATTICE = 10.0_wp         !< length of a face in digit errors, of nodes that were not rounded
   integer, parameter :: MOST_DIGITS = 13           !< that are looked for
   integer(ip), parameter :: LEAST_CHORDS = 3_ip    !< of a round side: two bisectors always meet
   real(wp), parameter :: FLAT = 1.0e-3_wp          !< sag of a face over its length, of one that is straight
   real(wp), parameter :: EXACT = 1.0e-13_wp        !< digit error over size of nodes that are not rounded to digits
   real(wp), parameter :: CONCENTRIC = 0.99_wp     !< distance of centres of a pin and its hole, in radii of the smaller: not round

contains

   !> The chords of the faces that take part: those of the slave that are not left out, and those that they see (faces_seen).
   !> The digit error is that of the mesh or of these nodes alone, whichever is coarser; faces as short as ten digit errors tell
   !> that the nodes were not rounded to it.
   pure subroutine list_chords(mesh, slave, faces, master, points, digit_error, chords)
      type(mesh_t), intent(in) :: mesh !< where the nodes lie
      type(face_list_t), intent(in) :: slave        !< one chain, ordered
      type(face_list_t), intent(in) :: faces        !< of the master; n = 0: it is rigid
      type(master_t), intent(in) :: master          !< of the pair
      type(contact_points_t), intent(in) :: points  !< of the pair
      real(wp), intent(in) :: digit_error           !< to which all nodes of the mesh are known [L]
      type(chords_t), intent(out) :: chords         !< of both sides
      logical :: is_seen(master%n)
      integer(ip) :: i, used

      i = 3*(slave%n + master%n)
      allocate (chords%place(2, i), chords%normal(2, i), chords%length(i), chords%of_slave(i))
      is_seen = faces_seen(mesh, slave, master, points)
      ! nodes about the origin may have few digits, since the others have not many more
      chords%digit_error = max(digit_error, printed_digit_error(reshape([mesh%x(:, points%entry), &
                                                                         master%a(:, pack([(i, i=1, master%n)], is_seen))], &
                                                                        [2, size(points%entry) + count(is_seen)])))
      used = 1
      do i = 1, slave%n                             ! the list of those that are used has the same order
         if (used > size(points%faces)) exit
         if (points%faces(used) /= int(slave%element(i), lp)*MOST_SIDES + slave%face(i)) cycle
         used = used + 1
         call add_face(mesh%x(:, face_nodes(mesh, slave%element(i), slave%face(i))), .true., chords)
      end do
      do i = 1, master%n
         if (.not. is_seen(i)) cycle
         if (master%rigid) then
            call add_piece(master, i, chords)
         else
            call add_face(mesh%x(:, face_nodes(mesh, faces%element(i), faces%face(i))), .false., chords)
         end if
      end do
      chords = only(spread(.true., 1, chords%n), chords)
      ! nodes on a lattice, as of whole numbers: a mesh of faces as short as their last digit was not rounded to it
      if (any(chords%length < LATTICE*chords%digit_error)) chords%digit_error = EPS_MACH*maxval(abs(chords%place))
   end subroutine list_chords

   !> The faces of the master that the slave's see from two places inside of each. Of a node of both sides it would be round-off, or
   !> the order of the faces, which of two it sees; what is seen from nodes counts where nothing else does.
   pure function faces_seen(mesh, slave, master, points) result(is_seen)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave
      type(master_t), intent(in) :: master
      type(contact_points_t), intent(in) :: points  !< of the pair
      logical :: is_seen(master%n)
      real(wp), parameter :: INSIDE(2) = [0.5_wp - sqrt(1.0_wp/12), 0.5_wp + sqrt(1.0_wp/12)]
      real(wp) :: d(2)
      integer(ip) :: i, k, used, seen

      is_seen = .false.
      used = 1
      do i = 1, slave%n
         if (used > size(points%faces)) exit
         if (points%faces(used) /= int(slave%element(i), lp)*MOST_SIDES + slave%face(i)) cycle
         used = used + 1
         associate (x => mesh%x(:, face_nodes(mesh, slave%element(i), slave%face(i))))
            d = x(:, 2) - x(:, 1)
            do k = 1, 2
               seen = sees(x(:, 1) + INSIDE(k)*d)
               if (seen > 0) is_seen(seen) = .true.
            end do
         end associate
      end do
      if (.not. any(is_seen)) is_seen(pack(points%piece, points%piece > 0)) = .true.

   contains

      !> The piece that is met across the chord; 0: none.
      pure integer(ip) function sees(x)
         real(wp), intent(in) :: x(2)               !< [L]

         associate (sight => look_along(x, [d(2), -d(1)]/norm2(d), 2*norm2(d), master))
            sees = sight%piece
         end associate
      end function sees

   end function faces_seen

   !> One chord of a straight face, two of a bent one.
   pure subroutine add_face(x, of_slave, chords)
      real(wp), intent(in) :: x(:, :)               !< (2, 2 or 3) ends and middle [L]
      logical, intent(in) :: of_slave               !< else of the master
      type(chords_t), intent(inout) :: chords       !< those so far
      logical :: is_bent

      is_bent = size(x, 2) == 3
      if (is_bent) is_bent = norm2(x(:, 3) - 0.5_wp*(x(:, 1) + x(:, 2))) &
                             > max(FLAT*norm2(x(:, 2) - x(:, 1)), DIGITS_TURN*chords%digit_error)
      if (is_bent) then
         call add_chord(x(:, 1), x(:, 3), of_slave, chords)
         call add_chord(x(:, 3), x(:, 2), of_slave, chords)
      else
         call add_chord(x(:, 1), x(:, 2), of_slave, chords)
      end if
   end subroutine add_face

   !> The outside lies at the right of the direction of travel.
   pure subroutine add_chord(a, b, of_slave, chords)
      real(wp), intent(in) :: a(2), b(2)            !< [L]
      logical, intent(in) :: of_slave               !< else of the master
      type(chords_t), intent(inout) :: chords       !< those so far

      chords%n = chords%n + 1
      chords%place(:, chords%n) = 0.5_wp*a + 0.5_wp*b
      chords%length(chords%n) = norm2(b - a)
      chords%normal(:, chords%n) = [b(2) - a(2), a(1) - b(1)]/chords%length(chords%n)
      chords%of_slave(chords%n) = of_slave
   end subroutine add_chord

   !> A rigid segment is a chord; three of an arc say that it is round.
   pure subroutine add_piece(master, i, chords)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i                  !< chord, or piece of the master
      type(chords_t), intent(inout) :: chords       !< those so far
      real(wp), parameter :: THIRDS(3) = [1.0_wp, 3.0_wp, 5.0_wp]/6.0_wp
      integer(ip) :: k, n

      n = merge(3_ip, 1_ip, abs(master%sweep(i)) > 0.0_wp)
      do k = 1, n
         chords%n = chords%n + 1
         chords%place(:, chords%n) = place_at(master, i, merge(THIRDS(k), 0.5_wp, n == 3))
         chords%normal(:, chords%n) = normal_at(master, i, merge(THIRDS(k), 0.5_wp, n == 3))
         chords%length(chords%n) = norm2(master%d(:, i))/n
         chords%of_slave(chords%n) = .false.
      end do
   end subroutine add_piece

   !> Half a unit of the last printed digit of coordinates [L]: to so much the nodes of a deck are known.
   !>
   !> The coordinates of the first decade, 10^m <= |x| <= max |x|, have as many decimals as those of the next one below
   !> or, printed with so many digits, one less. With d digits from 10^m on the unit of the last one is 10^(m + 1 - d),
   !> and the digit error half of it. Where the first decade has round numbers the next one tells. Up to three digits are
   !> meant as they are (0.25 is a quarter, not 0.25 +- 0.005), and more than MOST_DIGITS are not rounded: the digit error is
   !> the round-off of the largest coordinate then.
   pure real(wp) function printed_digit_error(x) result(digit_error)
      real(wp), intent(in) :: x(:, :)               !< (2, n) [L]
      integer, parameter :: ROUND = 3
      real(wp) :: most, decade
      integer :: digits(2)

      most = 0.0_wp
      if (size(x) > 0) most = maxval(abs(x))
      digit_error = EPS_MACH*most
      if (.not. most > 0.0_wp) return
      decade = 10.0_wp**floor(log10(most))
      digits = [digits_of(x, decade, most, 10*decade), digits_of(x, 0.1_wp*decade, decade*(1 - EPS_MACH), 10*decade)]
      if (digits(1) < digits(2) - 1) digits(1) = digits(2)
      if (digits(1) > ROUND .and. digits(1) <= MOST_DIGITS) digit_error = max(digit_error, 5*decade*10.0_wp**(-digits(1)))
   end function printed_digit_error

   !> The digits of those of some numbers that lie in a range, counted from a decade on; one more than are looked for where there
   !> are more. A number of few digits is off them by its rounding and no more: multiples of 0.0129000073 have not three.
   pure integer function digits_of(x, least, most, decade) result(digits)
      real(wp), intent(in) :: x(:, :), least, most, decade !< (2, n); the range; the decade
      real(wp), parameter :: SPARE = 1.0e-3_wp, ROUNDINGS = 16.0_wp
      real(wp) :: per_unit, rest
      integer :: i, k

      digits = 1
      per_unit = 10.0_wp/decade
      do i = 1, size(x, 2)
         do k = 1, 2
            if (abs(x(k, i)) < least .or. abs(x(k, i)) > most) cycle
            do
               rest = abs(x(k, i))*per_unit
               rest = rest - int(rest, lp)
               if (min(rest, 1.0_wp - rest) <= min(SPARE, ROUNDINGS*EPS_MACH*decade*per_unit)) exit
               digits = digits + 1
               if (digits > MOST_DIGITS) return
               per_unit = 10.0_wp**digits/decade
            end do
         end do
      end do
   end function digits_of

   !> The sliding motion of a pair, where there is one. In this order:
   !>
   !> 1. all chords are parallel: the translation along both sides;
   !> 2. one side is straight and the other is not, a wheel on a plane: the translation along the straight side, whose normal counts
   !>    (is_of_both = .false.; meets_round where the other side is a circle);
   !> 3. the bisectors of all chords meet in one point: the rotation about the common centre;
   !> 4. each side is round by itself, one convex and one hollow, a pin in a hole with some clearance: the rotation of the
   !>    pin, if the centres are no farther apart than the smaller radius;
   !> 5. one side is round and the other has an arc about the same centre beside other faces, a pin in the end of a slot: the
   !>    rotation, along which the faces of the arc slide (is_of_both = .false.).
   subroutine find_sliding(chords, motion)
      type(chords_t), intent(in) :: chords !< of both sides
      type(sliding_t), intent(out) :: motion !< exists = .false.: there is none
      type(chords_t) :: of_side(2)
      type(sliding_t) :: own(2), round
      integer(ip) :: i, k

      if (.not. (any(chords%of_slave) .and. any(.not. chords%of_slave))) return
      call find_straight(chords, motion)
      if (motion%exists) return
      of_side = [only(chords%of_slave, chords), only(.not. chords%of_slave, chords)]
      call find_straight(of_side(1), own(1))
      call find_straight(of_side(2), own(2))
      if (own(1)%exists .neqv. own(2)%exists) then
         motion = own(merge(1, 2, own(1)%exists))
         motion%is_of_both = .false.
         call find_round(of_side(merge(2, 1, own(1)%exists)), round)
         motion%meets_round = round%exists
      end if
      if (any(own%exists) .or. any(of_side%n < LEAST_CHORDS)) return
      call find_round(chords, motion)
      if (motion%exists) return
      call find_round(of_side(1), own(1))
      call find_round(of_side(2), own(2))
      if (own(1)%exists .neqv. own(2)%exists) then
         k = merge(1_ip, 2_ip, own(1)%exists)
         associate (other => of_side(3 - k))
            if (count([(slides(other, i, own(k)), i=1, other%n)]) < LEAST_CHORDS) return
         end associate
         motion = own(k)
         motion%is_of_both = .false.
      end if
      if (.not. (own(1)%exists .and. own(2)%exists)) return
      if (own(1)%is_convex .eqv. own(2)%is_convex) return
      if (norm2(own(1)%centre - own(2)%centre) > CONCENTRIC*min(own(1)%radius, own(2)%radius)) return
      motion = own(merge(1, 2, own(1)%is_convex))   ! the pin's
   end subroutine find_sliding

   !> A translation, where all chords are parallel: across the mean normal, weighted by the squares of the lengths, the
   !> master's normals turned round. A component of the normal that the digits of the nodes leave in doubt is none:
   !> sides along an axis stay so.
   pure subroutine find_straight(chords, motion)
      type(chords_t), intent(in) :: chords
      type(sliding_t), intent(inout) :: motion
      real(wp) :: n(2)
      integer(ip) :: i

      motion = sliding_t()
      n = 0.0_wp
      do i = 1, chords%n
         n = n + merge(1.0_wp, -1.0_wp, chords%of_slave(i))*chords%length(i)**2*chords%normal(:, i)
      end do
      if (.not. norm2(n) > 0.0_wp) return
      motion%extent = sum(chords%length, mask=chords%of_slave .eqv. chords%of_slave(1))
      motion%digit_error = chords%digit_error
      n = n/norm2(n)
      where (abs(n) <= DIGITS_TURN*motion%digit_error/motion%extent) n = 0.0_wp
      motion%direction = [-n(2), n(1)]/norm2(n)
      motion%exists = all([(slides(chords, i, motion), i=1, chords%n)])
   end subroutine find_straight

   !> A rotation, where the bisectors of all chords meet; none of fewer than LEAST_CHORDS.
   !>
   !> A motion v(x) = t + w perp(x - o), o the mean of the middles of the chords, is along chord f where r_f . (t, w L)
   !> = 0, r_f = (n_f, n_f . perp(x_f - o)/L). The eigenvector (t, w L) of A = sum h_f^2 r_f r_f' with the least
   !> eigenvalue is the motion that is least across the chords; it is a rotation about c = o + perp(t)/w.
   subroutine find_round(chords, motion)
      type(chords_t), intent(in) :: chords
      type(sliding_t), intent(out) :: motion
      real(wp) :: a(3, 3), values(3), row(3), origin(2), length
      integer(ip) :: i, info

      if (chords%n < LEAST_CHORDS) return
      origin = sum(chords%place, dim=2)/chords%n
      length = maxval(abs(chords%place - spread(origin, 2, chords%n)))
      a = 0.0_wp
      do i = 1, chords%n
         row(:2) = chords%normal(:, i)
         row(3) = dot_product(row(:2), perp(chords%place(:, i) - origin))/length
         a = a + chords%length(i)**2*spread(row, 1, 3)*spread(row, 2, 3)
      end do
      call eigen_symmetric(a, values, info)
      if (info /= 0 .or. .not. abs(a(3, 1)) > EPS_MACH) return
      motion%is_round = .true.
      motion%centre = origin + perp(a(:2, 1))*(length/a(3, 1))
      ! a centre with as few digits as the nodes have is the one that is meant
      if (chords%digit_error > EXACT*length) motion%centre = anint(motion%centre/(2*chords%digit_error))*(2*chords%digit_error)
      motion%radius = sum(norm2(chords%place - spread(motion%centre, 2, chords%n), dim=1))/chords%n
      motion%extent = motion%radius
      motion%digit_error = chords%digit_error
      motion%is_convex = dot_product(chords%normal(:, 1), chords%place(:, 1) - motion%centre) > 0.0_wp
      motion%exists = all([(slides(chords, i, motion), i=1, chords%n)])
   end subroutine find_round

   !> Some of the chords, in arrays of their number.
   pure type(chords_t) function only(asked, chords) result(some)
      logical, intent(in) :: asked(:)               !< (n) those that are wanted
      type(chords_t), intent(in) :: chords
      integer(ip) :: i

      associate (list => pack([(i, i=1, chords%n)], asked))
         some%n = size(list, kind=ip)
         some%place = chords%place(:, list)
         some%normal = chords%normal(:, list)
         some%length = chords%length(list)
         some%of_slave = chords%of_slave(list)
      end associate
      some%digit_error = chords%digit_error
   end function only

   !> Whether a chord slides along itself, |n . v| <= doubt |v|, but for the digits of its ends, 3 g/h, and the
   !> resolution of the curve, (h/R)^2/100 (R is |v| of a rotation).
   pure logical function slides(chords, i, motion)
      type(chords_t), intent(in) :: chords
      integer(ip), intent(in) :: i                  !< chord, or piece of the master
      type(sliding_t), intent(in) :: motion
      real(wp) :: v(2), doubt

      v = velocity(motion, chords%place(:, i))
      doubt = DIGITS_TURN*max(chords%digit_error, motion%digit_error)/chords%length(i)
      if (motion%is_round) doubt = max(doubt, CURVE_TURN*(chords%length(i)/norm2(v))**2)
      slides = abs(dot_product(v, chords%normal(:, i))) <= doubt*norm2(v)
   end function slides

   !> Whether the motion of another pair serves as well as a pair's own, at all chords that its own serves at.
   pure logical function serves(chords, other, own)
      type(chords_t), intent(in) :: chords
      type(sliding_t), intent(in) :: other, own     !< of the other pair, of this one
      integer(ip) :: i

      serves = other%is_round .eqv. own%is_round
      if (serves) serves = all([(slides(chords, i, other) .or. .not. slides(chords, i, own), i=1, chords%n)])
   end function serves

   !> How sharply the chords of a pair tell its motion: their number, of a rotation; the longest one that slides, in digit
   !> errors, of a translation, since a node that is off by g turns a chord by g/h.
   pure integer(lp) function sharpness(chords, motion)
      type(chords_t), intent(in) :: chords
      type(sliding_t), intent(in) :: motion         !< of the pair
      integer(ip) :: i

      sharpness = chords%n
      if (motion%is_round) return
      sharpness = int(maxval(chords%length(:chords%n), mask=[(slides(chords, i, motion), i=1, chords%n)])/chords%digit_error, lp)
   end function sharpness

   !> The motion of another pair with the size of a pair's own.
   pure type(sliding_t) function adopted(other, own) result(motion)
      type(sliding_t), intent(in) :: other, own     !< of the other pair, of this one

      motion = own
      motion%direction = other%direction
      motion%centre = other%centre
   end function adopted

   !> The motion at a place, of any size: the direction of a translation, perp(x - c) of a rotation about c.
   pure function velocity(motion, x) result(v)
      type(sliding_t), intent(in) :: motion         !< a rotation or a translation
      real(wp), intent(in) :: x(2)                  !< [L]
      real(wp) :: v(2)

      v = motion%direction
      if (motion%is_round) v = perp(x - motion%centre)
   end function velocity

   !> By what normals may be off [rad]: by the digits of the nodes, 3 g/l_j; and at an end of a chain, where a curve
   !> goes on that the faces do not show, as at a line of symmetry, by half of the turn from one straight face to the
   !> next, or by what a parabola is off, of the slave or of the master: the normal is common to both.
   pure subroutine note_doubt(mesh, slave, master, digit_error, points)
      type(mesh_t), intent(in) :: mesh              !< where the nodes lie
      type(face_list_t), intent(in) :: slave        !< one chain, ordered (order_chain)
      type(face_list_t), intent(in) :: master       !< none of a drawn line
      real(wp), intent(in) :: digit_error           !< [L]
      type(contact_points_t), intent(inout) :: points !< of the pair
      type(nodal_rule_t) :: rule
      integer(ip) :: i, k, j
      real(wp) :: turn, opposite
      real(wp), parameter :: HALF = 0.6_wp          !< with some reserve
      real(wp), parameter :: PARABOLA = 1/16.0_wp   !< of a circle's arc it is off by 1/32 of the cube of the angle at its ends

      points%doubt = DIGITS_TURN*digit_error/points%length(:points%n)
      opposite = 0.0_wp
      do i = 1, master%n
         rule = nodal_rule(mesh, master%element(i), master%face(i))
         if (rule%n == 3) opposite = max(opposite, PARABOLA*asin(sine(rule%normal(:, 1), rule%normal(:, 3)))**3)
      end do
      do k = 1, 2
         i = merge(1_ip, slave%n, k == 1)
         rule = nodal_rule(mesh, slave%element(i), slave%face(i))
         j = findloc(points%node(:points%n), rule%node(merge(1_ip, rule%n, k == 1)), dim=1, kind=ip)
         if (j == 0) cycle
         turn = asin(turn_at(mesh, slave, i, rule))
         if (rule%n == 3) turn = PARABOLA*asin(sine(rule%normal(:, 1), rule%normal(:, 3)))**3
         points%doubt(j) = max(points%doubt(j), HALF*turn, HALF*opposite)
      end do
   end subroutine note_doubt

   !> A vector turned by +90 degrees.
   pure function perp(a)
      real(wp), intent(in) :: a(2)
      real(wp) :: perp(2)

      perp = [-a(2), a(1)]
   end function perp

end module atrito_sliding_motions
