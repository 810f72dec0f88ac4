!> Makes the parts of a scene (atrito_scene_part), one after the other, of the scene and the plan of its cut (atrito_scene_cut).
module atrito_part_maker
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: bodies_t
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_fem_piece, only: take_piece
   use atrito_kinds, only: ip
   use atrito_scene_cut, only: place_t, scene_cut_t, unknowns_at
   use atrito_scene_elimination, only: scene_numbering_t
   use atrito_scene_part, only: scene_part_t
   use atrito_sorting, only: each_once
   implicit none (type, external)
   private
   public :: make_scene_part

contains

   !> Part p, not assembled: what there is of it, and which unknowns, rows and amplitudes of the scene its own are.
   subroutine make_scene_part(fem, rows, line, numbering, constraints, p, cut, part, place)
      type(fem_t), intent(in) :: fem                     !< whole scene; bodies, mesh and sections are taken
      type(contact_rows_t), intent(in) :: rows           !< of all contact points
      type(contact_line_t), intent(in) :: line           !< which points have rows; its numbers
      type(scene_numbering_t), intent(in) :: numbering   !< of the scene's unknowns
      type(constraint_rows_t), intent(in) :: constraints !< B of the scene
      integer(ip), intent(in) :: p                       !< 1..cut%n_parts
      type(scene_cut_t), intent(inout) :: cut            !< by plan_cut; its work arrays are 0 again on return
      type(scene_part_t), intent(out) :: part            !< numbered by itself; not assembled
      type(place_t), intent(inout) :: place          !< its unknowns, rows and pulls
      integer(ip), allocatable :: nodes(:), bodies(:)

      associate (elements => cut%element(cut%first_element(p):cut%first_element(p + 1) - 1), &
                 points => cut%point(cut%first_point(p):cut%first_point(p + 1) - 1))
         call list_members(elements, points, nodes, bodies)
         call number_part(fem, rows, numbering, nodes, bodies, p, cut, part, place)
         call take_piece(fem, nodes, elements, part%fem)
         call take_bodies(fem, numbering, elements, nodes, bodies, cut, part%fem%bodies)
         part%scene%numbering%spring = cut%unknown_at(pack(numbering%spring, cut%spring_part == p))
         part%spring_stiffness = pack(cut%spring_stiffness, cut%spring_part == p)
         call take_rows(points, place%row)
      end associate
      cut%place(nodes) = 0
      cut%place(fem%mesh%n_nodes + bodies) = 0
      cut%unknown_at(place%unknown) = 0

   contains

      !> The points with their nodes, and their rows: normal and tangential one after the other.
      subroutine take_rows(points, row)
         integer(ip), intent(in) :: points(:)
         integer(ip), allocatable, intent(out) :: row(:)
         integer(ip) :: i, k, n

         n = size(points, kind=ip)
         part%rows%n = n
         allocate (part%rows%first(n + 1), source=1_ip)
         part%rows%node = [(cut%place(rows%node(rows%first(points(i)):rows%first(points(i) + 1) - 1)), i=1, n)]
         part%line%n = n
         allocate (part%line%normal(n), part%line%tangential(n), source=0_ip)
         k = 0
         do i = 1, n
            part%rows%first(i + 1) = part%rows%first(i) + rows%first(points(i) + 1) - rows%first(points(i))
            part%rows%longest = max(part%rows%longest, part%rows%first(i + 1) - part%rows%first(i))
            if (line%normal(points(i)) > 0) part%line%normal(i) = k + 1
            if (line%tangential(points(i)) > 0) part%line%tangential(i) = k + 1 + min(1_ip, part%line%normal(i))
            k = max(k, part%line%normal(i), part%line%tangential(i))
         end do
         row = [(line%normal(points(i)), line%tangential(points(i)), i=1, n)]
         row = pack(row, row > 0)
         call take_constraints(constraints, row, cut%unknown_at, size(part%scene%numbering%body, kind=ip), part%scene%rows)
      end subroutine take_rows

      !> The nodes of the elements and points of a part, and its bodies, in their order; cut%place has their numbers.
      subroutine list_members(elements, points, nodes, bodies)
         integer(ip), intent(in) :: elements(:), points(:)
         integer(ip), allocatable, intent(out) :: nodes(:), bodies(:)
         logical :: is_in(fem%mesh%n_nodes)
         integer(ip) :: i, b

         is_in = .false.
         do i = 1, size(elements, kind=ip)
            is_in(fem%mesh%nodes(:fem%mesh%shape(elements(i)), elements(i))) = .true.
         end do
         do i = 1, size(points, kind=ip)
            is_in(rows%node(rows%first(points(i)):rows%first(points(i) + 1) - 1)) = .true.
         end do
         do b = 1, fem%bodies%n                         ! without a point their motions stand with these nodes
            if (cut%pull_part(b) == p .and. fem%bodies%list(b)%is_rigid) is_in(fem%bodies%list(b)%nodes) = .true.
         end do
         nodes = pack([(i, i=1, fem%mesh%n_nodes)], is_in)
         bodies = each_once([fem%bodies%of_node(nodes), pack([(b, b=1, fem%bodies%n)], cut%pull_part == p)])
         cut%place(nodes) = [(i, i=1, size(nodes, kind=ip))]
         cut%place(fem%mesh%n_nodes + bodies) = [(i, i=1, size(bodies, kind=ip))]
      end subroutine list_members

   end subroutine make_scene_part

   !> Numbers the unknowns: those that are kept last, in each of the two displacements before motions.
   subroutine number_part(fem, rows, numbering, nodes, bodies, p, cut, part, place)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(scene_numbering_t), intent(in) :: numbering
      integer(ip), intent(in) :: nodes(:), bodies(:), p
      type(scene_cut_t), intent(inout) :: cut
      type(scene_part_t), intent(inout) :: part
      type(place_t), intent(inout) :: place
      logical :: sees(size(bodies))
      integer(ip), allocatable :: items(:)
      integer(ip) :: i, k, n

      sees = cut%pull_part(bodies) == p
      do i = cut%first_point(p), cut%first_point(p + 1) - 1
         do k = rows%first(cut%point(i)), rows%first(cut%point(i) + 1) - 1
            sees(cut%place(fem%mesh%n_nodes + fem%bodies%of_node(rows%node(k)))) = .true.
         end do
      end do
      sees = sees .and. numbering%n_motions(bodies) > 0
      items = [nodes, fem%mesh%n_nodes + pack(bodies, sees)]
      allocate (place%unknown(2*size(nodes) + sum(numbering%n_motions(bodies))))
      n = 0
      call number_items(pack(items,.not. cut%is_shared(items)))
      part%n_kept = n
      call number_items(pack(items, cut%is_shared(items)))
      part%n_kept = n - part%n_kept
      place%unknown = place%unknown(:n)
      call number_motions(place%pull)
      part%scene%numbering%n = n
      part%scene%numbering%body = numbering%body(place%unknown)

   contains

      subroutine number_items(list)
         integer(ip), intent(in) :: list(:)
         integer(ip), allocatable :: own(:)
         integer(ip) :: m, l

         do m = 1, size(list, kind=ip)
            own = unknowns_at(fem, numbering, list(m))
            do l = 1, size(own, kind=ip)
               n = n + 1
               place%unknown(n) = own(l)
               cut%unknown_at(own(l)) = n
            end do
         end do
      end subroutine number_items

      !> Motions and pulls of the bodies of a part.
      subroutine number_motions(pull)
         integer(ip), allocatable, intent(out) :: pull(:)
         integer(ip) :: i, k, n

         n = size(bodies, kind=ip)
         allocate (pull(0))
         associate (own => part%scene%numbering)
            allocate (own%before(n), own%first_motion(n), own%n_motions(n), own%first_pull(n), source=0_ip)
            do i = 1, n
               if (.not. sees(i)) cycle
               own%n_motions(i) = numbering%n_motions(bodies(i))
               own%first_motion(i) = cut%unknown_at(numbering%first_motion(bodies(i)))
               if (cut%pull_part(bodies(i)) /= p) cycle
               own%first_pull(i) = size(pull, kind=ip) + 1
               pull = [pull, [(numbering%first_pull(bodies(i)) + k - 1, k=1, own%n_motions(i))]]
            end do
            own%k = size(pull, kind=ip)
         end associate
      end subroutine number_motions

   end subroutine number_part

   !> Bodies with the numbers of the part's unknowns as equations; of their elements one, where there is any.
   subroutine take_bodies(fem, numbering, elements, nodes, bodies, cut, own)
      type(fem_t), intent(in) :: fem
      type(scene_numbering_t), intent(in) :: numbering
      integer(ip), intent(in) :: elements(:), nodes(:), bodies(:)
      type(scene_cut_t), intent(in) :: cut
      type(bodies_t), intent(inout) :: own
      integer(ip) :: i, dof

      own%n = size(bodies, kind=ip)
      own%n_rigid = count(bodies > fem%bodies%n - fem%bodies%n_rigid, kind=ip)
      allocate (own%list(own%n))
      own%of_node = cut%place(fem%mesh%n_nodes + fem%bodies%of_node(nodes))
      own%of_element = cut%place(fem%mesh%n_nodes + fem%bodies%of_element(elements))
      own%equation = fem%bodies%equation(:, nodes)
      do i = 1, size(nodes, kind=ip)
         do dof = 1, 2
            if (own%equation(dof, i) <= 0) cycle
            own%equation(dof, i) = cut%unknown_at(numbering%before(fem%bodies%of_node(nodes(i))) + own%equation(dof, i))
         end do
      end do
      do i = size(elements, kind=ip), 1, -1
         own%list(own%of_element(i))%elements = [i]
      end do
      do i = 1, own%n
         own%list(i)%is_rigid = fem%bodies%list(bodies(i))%is_rigid
         if (own%list(i)%is_rigid) own%list(i)%nodes = pack(cut%place(fem%bodies%list(bodies(i))%nodes), &
                                                            cut%place(fem%bodies%list(bodies(i))%nodes) > 0)
      end do
   end subroutine take_bodies

   !> Some rows of B over the unknowns of the part.
   pure subroutine take_constraints(constraints, row, unknown_at, n, own)
      type(constraint_rows_t), intent(in) :: constraints
      integer(ip), intent(in) :: row(:), unknown_at(:), n
      type(constraint_rows_t), intent(out) :: own
      integer(ip) :: i, first, length

      own%n = size(row, kind=ip)
      own%n_columns = n
      own%point = constraints%point(row)
      own%to_ground = constraints%to_ground(row)
      allocate (own%first(own%n + 1), source=1_ip)
      do i = 1, own%n
         own%first(i + 1) = own%first(i) + constraints%first(row(i) + 1) - constraints%first(row(i))
      end do
      allocate (own%column(own%first(own%n + 1) - 1), own%value(own%first(own%n + 1) - 1))
      do i = 1, own%n
         first = constraints%first(row(i))
         length = own%first(i + 1) - own%first(i)
         own%column(own%first(i):own%first(i + 1) - 1) = unknown_at(constraints%column(first:first + length - 1))
         own%value(own%first(i):own%first(i + 1) - 1) = constraints%value(first:first + length - 1)
      end do
   end subroutine take_constraints

end module atrito_part_maker
