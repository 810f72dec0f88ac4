!> Energies of elements by the numbers of their outlines, packed.
module atrito_packed_energies
   use atrito_airy_stress, only: side_place, MOST_OUTLINE
   use atrito_element_table, only: CORNERS_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   implicit none (type, external)
   private
   public :: outlines_t, pack_energy, packed_size, take_columns

   !> Elements by their outlines: E = a'H a + 2 g'a + c of each, elements of one class with one H.
   !>
   !> Linear functions phi make no stress: H times their outlines is 0. So what belongs to phi and its gradient at the first corner
   !> follows from the rest, and the lower triangle of the rest is all that is kept, half of H. Where a side is cut it keeps its
   !> tractions whatever the numbers are, and H is kept whole.
   type :: outlines_t
      integer(ip) :: degree = 0                     !< k
      integer(ip), allocatable :: place(:)          !< (n_elements) of an element in what follows: class by class
      integer(ip), allocatable :: class_of(:)       !< (n_elements) of a place
      real(wp), allocatable :: h(:, :)              !< (packed_size, classes) [1/F] and so on
      real(wp), allocatable :: of_cut(:, :, :)      !< (numbers, numbers, classes behind these) H of elements that are cut
      real(wp), allocatable :: a(:, :)              !< (numbers, n_elements)
      real(wp), allocatable :: slope(:, :)          !< (numbers, n_elements) H a + g
      real(wp), allocatable :: energy(:)            !< (n_elements) E [F L]
   end type outlines_t

contains

   !> Numbers of H that are kept.
   pure integer(ip) function packed_size(n)
      integer(ip), intent(in) :: n                  !< numbers of the outline

      packed_size = ((n - 3)*(n - 2))/2
   end function packed_size

   !> Keeps H of a class.
   pure subroutine pack_energy(h, class, outlines)
      real(wp), intent(in) :: h(:, :)
      integer(ip), intent(in) :: class
      type(outlines_t), intent(inout) :: outlines
      integer(ip) :: j, l, n

      n = size(h, 1, kind=ip)
      l = 0
      do j = 4, n
         outlines%h(l + 1:l + n - j + 1, class) = h(j:, j)
         l = l + n - j + 1
      end do
   end subroutine pack_energy

   !> Columns of H of an element: of all numbers, or of some, behind the first corner.
   !>
   !> With z the outlines of phi = 1, x_1, x_2 (less the first corner), which at the first corner are 1 each, and H z = 0,
   !>
   !>     H(:, first) = -H(:, others) z(others),     H(first, :) the same of each column.
   pure subroutine take_columns(mesh, outlines, e, h, z, place)
      type(mesh_t), intent(in) :: mesh
      type(outlines_t), intent(in) :: outlines
      integer(ip), intent(in) :: e
      real(wp), intent(inout), contiguous :: h(:, :)
      real(wp), intent(out) :: z(:, :)              !< (numbers, 3); 0: the element has a side that is cut
      integer(ip), intent(in), optional :: place(:) !< those that are wanted, all > 3: without rows 1 to 3
      real(wp) :: first(MOST_OUTLINE, 3), of_first(3, 3)
      integer(ip) :: i, j, k, l, n, c, kind, start(MOST_OUTLINE)

      kind = outlines%class_of(outlines%place(e))
      z = 0.0_wp
      if (kind > size(outlines%h, 2)) then
         h = outlines%of_cut(:, :, kind - size(outlines%h, 2))
         return
      end if
      n = CORNERS_OF(mesh%shape(e))*(2*outlines%degree + 2)
      call linear_outlines(mesh, e, outlines%degree, z)
      l = 0
      do j = 4, n
         start(j) = l - j + 1                       ! H(i, j), i >= j, is number start + i
         l = l + n - j + 1
      end do
      if (present(place)) then
         do k = 1, size(place, kind=ip)
            j = place(k)
            do i = 4, j - 1
               h(i, j) = outlines%h(start(i) + j, kind)
            end do
            do i = j, n
               h(i, j) = outlines%h(start(j) + i, kind)
            end do
         end do
         return
      end if
      first = 0.0_wp
      of_first = 0.0_wp
      do j = 4, n
         h(j, j) = outlines%h(start(j) + j, kind)
         do c = 1, 3
            first(j, c) = first(j, c) - h(j, j)*z(j, c)
         end do
         do i = j + 1, n
            h(i, j) = outlines%h(start(j) + i, kind)
            h(j, i) = h(i, j)
            do c = 1, 3
               first(i, c) = first(i, c) - h(i, j)*z(j, c)
               first(j, c) = first(j, c) - h(i, j)*z(i, c)
            end do
         end do
         do c = 1, 3                                ! first(j, :) is complete
            h(j, c) = first(j, c)
            h(c, j) = first(j, c)
            do i = 1, 3
               of_first(i, c) = of_first(i, c) - first(j, i)*z(j, c)
            end do
         end do
      end do
      h(:3, :3) = of_first
   end subroutine take_columns

   !> The outlines of phi = 1, x_1, x_2, less the first corner of an element.
   pure subroutine linear_outlines(mesh, e, degree, z)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e, degree
      real(wp), intent(inout) :: z(:, :)            !< (numbers, 3)
      real(wp) :: x(2), side(2), length
      integer(ip) :: i, c, l, n

      n = CORNERS_OF(mesh%shape(e))
      associate (nodes => mesh%nodes(:n, e))
         do i = 1, n
            x = mesh%x(:, nodes(i)) - mesh%x(:, nodes(1))
            side = mesh%x(:, nodes(1 + mod(i, n))) - mesh%x(:, nodes(i))
            length = sqrt(side(1)**2 + side(2)**2)
            z(3*i - 2, 1) = 1.0_wp
            z(3*i - 2, 2:3) = x
            z(3*i - 1, 2) = 1.0_wp
            z(3*i, 3) = 1.0_wp
            l = side_place(n, degree, i)
            do c = l, l + degree - 1
               z(c, 2) = side(2)/length
               z(c, 3) = -side(1)/length
            end do
            if (degree == 2) z(l + 2, :) = [1.0_wp, x(1) + 0.5_wp*side(1), x(2) + 0.5_wp*side(2)]
         end do
      end associate
   end subroutine linear_outlines

end module atrito_packed_energies
