!> The rigid motions of all bodies seen from the contact line: G by rows, and what the loads work on the motions.
!>
!> Equilibrium of the bodies is G' q = h (docs/theory/formulation.md, section 4), q being the contact forces in the order of the
!> unknowns of the line. A row touches the motions of two bodies at most, so G is kept by its entries.
!>
!>     G v     how fast the motion v opens the points and lets them slip (multiply_rows)
!>     G' q    the work of the contact forces on each motion (add_transposed)
module atrito_motion_rows
   use atrito_assembly, only: fem_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_joined_sets, only: find_lowest, join_sets
   use atrito_kinds, only: ip, wp
   use atrito_row_entries, only: motions_of_row, first_motions, work_on_motion, MOST_MODES
   use atrito_sliding_motions, only: printed_digit_error
   use atrito_sparse_rows, only: sparse_rows_t
   implicit none (type, external)
   private
   public :: motion_rows_t, build_motion_rows, part_from_held, note_digits, join_motions, contact_digit_error
   public :: DIGIT_ERRORS, MOST_PART

   !> G by the entries of its rows, and h.
   type, extends(sparse_rows_t) :: motion_rows_t
      integer(ip), allocatable :: body(:)        !< (k) whose motion it is; the motions of a body follow each other
      real(wp), allocatable :: work(:)           !< (k) h: of the loads on the motion of amplitude one [F]
      real(wp), allocatable :: work_size(:)      !< (k) the same, of the terms without their signs: what may have cancelled [F]
      real(wp), allocatable :: doubt(:)          !< (n) part of a motion that the digits of the deck may show a row; left out: none
   end type motion_rows_t

   real(wp), parameter :: DIGIT_ERRORS = 5.0_wp     !< by which the place of a force may be off
   real(wp), parameter :: EXACT = 1.0e-14_wp        !< digit error over coordinates of a deck that is not rounded to digits
   real(wp), parameter :: LATTICE = 10.0_wp         !< length of a point in digit errors, of nodes that were not rounded
   real(wp), parameter :: MOST_PART = 2.5e-3_wp    !< a larger part of the forces was meant, whatever the digits

contains

   !> G of all unknown forces by rows, and h = Z'f with the size of its terms, |Z'||f|. The motions of all bodies are
   !> numbered one body after the other; a row has at most MOST_MODES entries for each body that it touches.
   pure subroutine build_motion_rows(fem, rows, line, f, motions)
      type(fem_t), intent(in) :: fem                !< bodies with their rigid modes
      type(contact_rows_t), intent(in) :: rows      !< directions and coefficients
      type(contact_line_t), intent(in) :: line      !< which unknown is of which point
      real(wp), intent(in) :: f(:, :)                !< (2, n_nodes) applied forces [F]
      type(motion_rows_t), intent(out) :: motions    !< rows of unknowns, columns of motions, and h
      integer(ip) :: first_motion(fem%bodies%n + 1), b, i, n

      first_motion = first_motions(fem%bodies)
      motions%n_columns = first_motion(fem%bodies%n + 1) - 1
      allocate (motions%body(motions%n_columns), motions%work(motions%n_columns), motions%work_size(motions%n_columns))
      do b = 1, fem%bodies%n
         do i = first_motion(b), first_motion(b + 1) - 1
            motions%body(i) = b
            call work_on_motion(fem, fem%bodies%list(b), i - first_motion(b) + 1_ip, f, motions%work(i), motions%work_size(i))
         end do
      end do
      motions%n = size(line%point, kind=ip)
      n = 0
      do i = 1, motions%n
         n = n + MOST_MODES*max(2_ip, min(fem%bodies%n, rows%first(line%point(i) + 1) - rows%first(line%point(i))))
      end do
      allocate (motions%first(motions%n + 1), motions%column(n), motions%value(n))
      motions%first(1) = 1
      do i = 1, motions%n
         associate (first => motions%first(i))
            call motions_of_row(fem, rows, line, i, first_motion, n, motions%column(first:), motions%value(first:))
            motions%first(i + 1) = first + n
         end associate
      end do
      n = motions%first(motions%n + 1) - 1
      motions%column = motions%column(:n)
      motions%value = motions%value(:n)
   end subroutine build_motion_rows

   !> Bodies that supports along axes of their own hold, or ties, springs, lose their part in the rows of others, as those have none
   !> that supports along x and y hold: such forces balance whatever acts on them, and no motion that proves anything moves them. So
   !> bodies on one foundation are judged one by one, each by its own forces. These rows are for balances and their proofs alone.
   pure subroutine part_from_held(fem, line, motions)
      type(fem_t), intent(in) :: fem                !< bodies with their rigid modes
      type(contact_line_t), intent(in) :: line      !< which unknowns are of supports
      type(motion_rows_t), intent(inout) :: motions !< as built; entries of other rows on motions of these bodies are left out
      real(wp), parameter :: OF_ITS_OWN = 1.0e-3_wp !< part of a row that the rows before it do not have
      real(wp) :: basis(MOST_MODES, MOST_MODES, fem%bodies%n), row(MOST_MODES), length
      integer(ip) :: first_motion(fem%bodies%n + 1), rank(fem%bodies%n), first(motions%n + 1), i, k
      logical :: is_of_support(motions%n), keeps(size(motions%column))

      if (line%n_bilateral == 0) return
      first_motion = first_motions(fem%bodies)
      rank = 0
      is_of_support = line%point > line%n - line%n_bilateral .and. motions%first(2:) > motions%first(:motions%n)
      do i = 1, motions%n
         if (.not. is_of_support(i)) cycle
         associate (own => motions%column(motions%first(i):motions%first(i + 1) - 1))
            is_of_support(i) = all(motions%body(own) == motions%body(own(1)))
            if (.not. is_of_support(i)) cycle
            row = 0.0_wp
            row(own - first_motion(motions%body(own(1))) + 1) = motions%value(motions%first(i):motions%first(i + 1) - 1)
            length = norm2(row)
            associate (n => rank(motions%body(own(1))), found => basis(:, :, motions%body(own(1))))
               do k = 1, n
                  row = row - dot_product(row, found(:, k))*found(:, k)
               end do
               if (norm2(row) <= OF_ITS_OWN*length) cycle
               n = n + 1
               found(:, n) = row/norm2(row)
            end associate
         end associate
      end do
      first(1) = 1
      do i = 1, motions%n
         associate (own => motions%body(motions%column(motions%first(i):motions%first(i + 1) - 1)))
            keeps(motions%first(i):motions%first(i + 1) - 1) = is_of_support(i) .or. &
                                                               rank(own) < first_motion(own + 1) - first_motion(own)
         end associate
         first(i + 1) = first(i) + count(keeps(motions%first(i):motions%first(i + 1) - 1), kind=ip)
      end do
      motions%first = first
      motions%column = pack(motions%column, keeps)
      motions%value = pack(motions%value, keeps)
   end subroutine part_from_held

   !> Of each unknown force, the part of the largest one that the digits may make (motions%doubt), which is the part of a motion of
   !> the bodies that its row may see by them; 0: none, as of joints. The nodes of one of its bodies may have few digits where
   !> others have all. Asked for by itself, as it goes over the digits of all coordinates.
   pure subroutine note_digits(fem, rows, line, motions)
      type(fem_t), intent(in) :: fem                !< places of the nodes, bodies
      type(contact_rows_t), intent(in) :: rows      !< nodes and lengths of the points
      type(contact_line_t), intent(in) :: line      !< which unknown is of which point
      type(motion_rows_t), intent(inout) :: motions !< rows of these unknowns
      real(wp) :: digit_error(0:fem%bodies%n)
      integer(ip) :: i, b

      motions%doubt = spread(0.0_wp, 1, motions%n)
      digit_error(0) = contact_digit_error(fem%mesh%x, fem%mesh%digit_error, rows)
      do b = 1, fem%bodies%n
         digit_error(b) = max(digit_error(0), contact_digit_error(fem%mesh%x(:, fem%bodies%list(b)%nodes), 0.0_wp, rows))
      end do
      if (.not. any(digit_error > 0.0_wp)) return
      do i = 1, motions%n
         associate (j => line%point(i))
            if (j > line%n - line%n_bilateral) cycle
            associate (bodies => fem%bodies%of_node(rows%node(rows%first(j):rows%first(j + 1) - 1)))
               motions%doubt(i) = min(DIGIT_ERRORS*maxval(digit_error(bodies))/rows%reach(j), MOST_PART)
            end associate
         end associate
      end do
   end subroutine note_digits

   !> Half a unit of the last digit of coordinates [L]; 0: they are not rounded, or there is no contact.
   pure real(wp) function contact_digit_error(x, given, rows) result(digit_error)
      real(wp), intent(in) :: x(:, :)               !< (2, nodes) all of the mesh or those of a body [L]
      real(wp), intent(in) :: given                 !< of places that they are made of; 0: not known [L]
      type(contact_rows_t), intent(in) :: rows      !< lengths of the points

      digit_error = 0.0_wp
      associate (n => rows%n - rows%n_bilateral)
         if (n == 0) return
         digit_error = max(printed_digit_error(x), given)
         if (digit_error <= EXACT*maxval(abs(x))) digit_error = 0.0_wp
         if (any(rows%reach(:n) < LATTICE*digit_error)) digit_error = 0.0_wp
      end associate
   end function contact_digit_error

   !> Groups of motions that rows join: the number of each, that of its first motion.
   pure subroutine join_motions(rows, holds, group)
      type(motion_rows_t), intent(in) :: rows
      logical, intent(in) :: holds(:)               !< (m)
      integer(ip), allocatable, intent(out) :: group(:) !< (k)
      integer(ip) :: i, e

      group = [(i, i=1, rows%n_columns)]
      do i = 1, rows%n
         if (.not. holds(i)) cycle
         do e = rows%first(i) + 1, rows%first(i + 1) - 1
            call join_sets(group, rows%column(e - 1), rows%column(e))
         end do
      end do
      do i = 1, rows%n_columns
         e = i
         call find_lowest(group, e)
         group(i) = e
      end do
   end subroutine join_motions

end module atrito_motion_rows
