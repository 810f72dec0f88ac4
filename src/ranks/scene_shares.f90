!> The shares of the ranks in a scene that is one matrix: subtrees of its order of elimination, which has small separators.
!>
!> Whole bodies would be cut along their joints; a separator may as well go through the bodies, where that is shorter: a wall in
!> bond has half as many unknowns on a line straight through its blocks as along the joints, which step from course to course.
!>
!> What is above the subtrees is shared by those below. The heaviest subtree gives way to its children until the ranks have even
!> shares (Geist and Ng, Int. J. Parallel Program. 18 (1989) 291-314); subtrees that follow each other in the tree stay on one
!> rank, so that what lies between them is not shared.
module atrito_scene_shares
   use atrito_assembly, only: fem_t
   use atrito_kinds, only: ip, wp
   use atrito_multifrontal, only: elimination_t
   use atrito_scene_elimination, only: scene_numbering_t
   implicit none (type, external)
   private
   public :: share_elements

   !> By how much of the mean a rank may have more, and subtrees of it that are not cut any more.
   real(wp), parameter :: MARGIN = 0.08_wp, LEAST_CUT = 0.02_wp

contains

   !> The part of each element, and whose it is; ranks without elements have no part.
   subroutine share_elements(fem, numbering, elimination, n_ranks, part_of_element, rank)
      type(fem_t), intent(in) :: fem                 !< bodies and mesh of the scene
      type(scene_numbering_t), intent(in) :: numbering !< of the scene's unknowns
      type(elimination_t), intent(in) :: elimination !< of all unknowns
      integer(ip), intent(in) :: n_ranks             !< >= 1
      integer(ip), intent(out) :: part_of_element(:) !< (n_elements) 1..size(rank)
      integer(ip), allocatable, intent(out) :: rank(:) !< (parts) 0..n_ranks - 1, ascending
      integer(ip) :: rank_of(size(elimination%last)), rank_at(numbering%n), part_of_rank(0:n_ranks - 1), e, i, s

      call share_supernodes(elimination, n_ranks, rank_of)
      i = 1
      do s = 1, size(rank_of, kind=ip)
         rank_at(i:elimination%last(s)) = rank_of(s)
         i = elimination%last(s) + 1
      end do
      do e = 1, fem%mesh%n_elements
         part_of_element(e) = rank_of_element()
      end do
      call join_neighbours(fem, part_of_element)
      part_of_rank = 0
      allocate (rank(0))
      do i = 0, n_ranks - 1
         if (.not. any(part_of_element == i)) cycle
         rank = [rank, i]
         part_of_rank(i) = size(rank, kind=ip)
      end do
      part_of_element = part_of_rank(part_of_element)

   contains

      !> That of the unknown of the element that is eliminated first; -1: all of them are above the subtrees, or there are none.
      pure integer(ip) function rank_of_element() result(rank)
         integer(ip) :: k, dof, first

         first = huge(first)
         do k = 1, fem%mesh%shape(e)
            do dof = 1, 2
               associate (equation => fem%bodies%equation(dof, fem%mesh%nodes(k, e)))
                  if (equation > 0) first = min(first, elimination%position(numbering%before(fem%bodies%of_element(e)) + equation))
               end associate
            end do
         end do
         rank = -1
         if (first < huge(first)) rank = rank_at(first)
      end function rank_of_element

   end subroutine share_elements

   !> Whose the supernodes of the subtrees are; -1: above them.
   !>
   !> The weight of a supernode is the number of unknowns of the subtree below it, itself included. The subtrees begin as whole
   !> trees. As long as some rank has more than (1 + MARGIN) of the mean, the heaviest subtree is replaced by those of its
   !> children, and its own supernode goes to those that the ranks share; a subtree lighter than LEAST_CUT of the mean is not cut
   !> any more.
   pure subroutine share_supernodes(elimination, n_ranks, rank_of)
      type(elimination_t), intent(in) :: elimination
      integer(ip), intent(in) :: n_ranks
      integer(ip), intent(out) :: rank_of(:)         !< (supernodes) 0..n_ranks - 1
      real(wp) :: weight(size(rank_of))              ! unknowns of the subtree of each
      logical :: is_top(size(rank_of)), is_root(size(rank_of))
      integer(ip) :: s, heaviest

      do s = 1, size(rank_of, kind=ip)
         weight(s) = real(elimination%last(s), wp)
         if (s > 1) weight(s) = weight(s) - real(elimination%last(s - 1), wp)
      end do
      do s = 1, size(rank_of, kind=ip)               ! children come first
         associate (parent => elimination%parent(s))
            if (parent > 0) weight(parent) = weight(parent) + weight(s)
         end associate
      end do
      is_top = .false.
      is_root = elimination%parent == 0
      do
         call give_to_ranks(rank_of)
         heaviest = maxloc(weight, dim=1, kind=ip, mask=is_root)
         if (is_even(n_ranks, weight, is_root, rank_of)) exit
         if (.not. any(elimination%parent == heaviest)) exit
         if (weight(heaviest) <= LEAST_CUT*sum(weight, mask=is_root)/real(n_ranks, wp)) exit
         is_root(heaviest) = .false.
         is_top(heaviest) = .true.
         where (elimination%parent == heaviest) is_root = .true.
      end do
      do s = size(rank_of, kind=ip), 1, -1           ! parents come first
         if (is_top(s)) rank_of(s) = -1
         if (.not. (is_top(s) .or. is_root(s))) rank_of(s) = rank_of(elimination%parent(s))
      end do

   contains

      !> Subtrees to ranks in their order: with the weights w_s and their sum W, subtree s goes to the rank floor(n (sum of w
      !> before s + w_s/2)/W), where its middle lies in the sum of all.
      pure subroutine give_to_ranks(rank_of)
         integer(ip), intent(inout) :: rank_of(:)       !< at the roots
         real(wp) :: before, mean
         integer(ip) :: s

         mean = max(sum(weight, mask=is_root), 1.0_wp)/real(n_ranks, wp)
         before = 0.0_wp
         do s = 1, size(rank_of, kind=ip)
            if (.not. is_root(s)) cycle
            rank_of(s) = min(floor((before + 0.5_wp*weight(s))/mean, ip), n_ranks - 1)
            before = before + weight(s)
         end do
      end subroutine give_to_ranks

   end subroutine share_supernodes

   pure logical function is_even(n_ranks, weight, is_root, rank_of)
      integer(ip), intent(in) :: n_ranks
      real(wp), intent(in) :: weight(:)
      logical, intent(in) :: is_root(:)
      integer(ip), intent(in) :: rank_of(:)
      real(wp) :: load(0:n_ranks - 1)
      integer(ip) :: s

      load = 0.0_wp
      do s = 1, size(rank_of, kind=ip)
         if (is_root(s)) load(rank_of(s)) = load(rank_of(s)) + weight(s)
      end do
      is_even = maxval(load) <= (1.0_wp + MARGIN)*sum(load)/real(n_ranks, wp)
   end function is_even

   !> Elements that no subtree has go with one that has a node of theirs; without such a one, with the first rank.
   pure subroutine join_neighbours(fem, rank_of)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(inout) :: rank_of(:)       !< (n_elements) -1: nobody's yet
      integer(ip) :: of_node(fem%mesh%n_nodes), e, before

      do
         of_node = -1
         do e = fem%mesh%n_elements, 1, -1
            if (rank_of(e) >= 0) of_node(fem%mesh%nodes(:fem%mesh%shape(e), e)) = rank_of(e)
         end do
         before = count(rank_of < 0, kind=ip)
         do e = 1, fem%mesh%n_elements
            if (rank_of(e) < 0) rank_of(e) = maxval(of_node(fem%mesh%nodes(:fem%mesh%shape(e), e)))
         end do
         if (count(rank_of < 0) == before) exit
      end do
      where (rank_of < 0) rank_of = 0
   end subroutine join_neighbours

end module atrito_scene_shares
