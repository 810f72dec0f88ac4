!> Nested dissection by METIS of the graph of the glued nodes: two nodes are neighbours where they share an element, and weigh as much
!> as they have equations. (Debian's MUMPS has no METIS of its own; the order is given to it.)
!>
!> The library is loaded when it is asked for. CMake says which file that is (BENCH_METIS_LIBRARY); without METIS there is no such name.
module metis_order
   use, intrinsic :: iso_c_binding, only: c_associated, c_f_procpointer, c_funptr, c_int, c_null_ptr, c_ptr
   use atrito_system, only: find_routine
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t
   use glued_bodies, only: glued_t
   implicit none (type, external)
   private
   public :: order_by_metis, has_metis

   abstract interface
      !> METIS_NodeND of METIS 5 with indices of 32 bits, as Debian builds it.
      integer(c_int) function node_nd(n, start, neighbour, weight, options, perm, place) bind(C)
         import :: c_int, c_ptr
         integer(c_int), intent(in) :: n, start(*), neighbour(*), weight(*)
         type(c_ptr), value :: options              !< null: METIS's own
         integer(c_int), intent(out) :: perm(*), place(*)
      end function node_nd
   end interface

   integer(c_int), parameter :: METIS_OK = 1_c_int

contains

   !> place(equation): when it is eliminated, 1..n. Not allocated where METIS is missing or fails.
   subroutine order_by_metis(mesh, glued, place)
      type(mesh_t), intent(in) :: mesh
      type(glued_t), intent(in) :: glued
      integer(ip), allocatable, intent(out) :: place(:)
      procedure(node_nd), pointer :: metis
      integer(ip), allocatable :: vertex(:), weight(:), start(:), neighbour(:), perm(:), inverse(:)

      call load_metis(metis)
      if (.not. associated(metis)) return
      call number_vertices(glued, vertex, weight)
      call make_graph(mesh, vertex, size(weight, kind=ip), start, neighbour)
      allocate (perm(size(weight)), inverse(size(weight)))
      if (metis(size(weight, kind=ip), start, neighbour, weight, c_null_ptr, perm, inverse) /= METIS_OK) return
      call place_equations(weight, perm, place)
   end subroutine order_by_metis

   logical function has_metis()
      procedure(node_nd), pointer :: metis

      call load_metis(metis)
      has_metis = associated(metis)
   end function has_metis

   subroutine load_metis(metis)
      procedure(node_nd), pointer, intent(out) :: metis
#ifdef BENCH_METIS_LIBRARY
      type(c_funptr) :: routine
#endif

      metis => null()
#ifdef BENCH_METIS_LIBRARY
      routine = find_routine(BENCH_METIS_LIBRARY, 'METIS_NodeND')
      if (c_associated(routine)) call c_f_procpointer(routine, metis)
#endif
   end subroutine load_metis

   !> Nodes with equations, in the order of these.
   subroutine number_vertices(glued, vertex, weight)
      type(glued_t), intent(in) :: glued
      integer(ip), allocatable, intent(out) :: vertex(:)   !< (n_nodes) 0: without equations
      integer(ip), allocatable, intent(out) :: weight(:)   !< (n_vertices) equations of a vertex
      integer(ip) :: owner(glued%n), i, n

      do i = 1, size(glued%first, kind=ip)
         if (glued%equation(1, i) > 0) owner(glued%equation(1, i)) = glued%first(i)
         if (glued%equation(2, i) > 0) owner(glued%equation(2, i)) = glued%first(i)
      end do
      allocate (vertex(size(glued%first)), weight(glued%n), source=0_ip)
      n = 0
      do i = 1, glued%n
         if (vertex(owner(i)) == 0) then
            n = n + 1
            vertex(owner(i)) = n
         end if
         weight(n) = weight(n) + 1
      end do
      weight = weight(:n)
      vertex = vertex(glued%first)
   end subroutine number_vertices

   !> Neighbours from 0, as METIS counts.
   subroutine make_graph(mesh, vertex, n, start, neighbour)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: vertex(:), n
      integer(ip), allocatable, intent(out) :: start(:)    !< (n + 1)
      integer(ip), allocatable, intent(out) :: neighbour(:)
      integer(ip), allocatable :: corners(:, :), first(:), element(:), newest(:)
      integer(ip) :: pass, v, k, a, m

      corners = vertices_of_elements(mesh, vertex)
      call list_holders(n, corners, first, element)
      allocate (start(n + 1), newest(n))
      do pass = 1, 2                                ! counts, then fills
         newest = 0
         m = 0
         do v = 1, n
            start(v) = m
            newest(v) = v
            do k = first(v), first(v + 1) - 1
               do a = 1, size(corners, 1, kind=ip)
                  associate (w => corners(a, element(k)))
                     if (w == 0) exit
                     if (newest(w) == v) cycle
                     newest(w) = v
                     m = m + 1
                     if (pass == 2) neighbour(m) = w - 1
                  end associate
               end do
            end do
         end do
         start(n + 1) = m
         if (pass == 1) allocate (neighbour(m))
      end do
   end subroutine make_graph

   !> The vertices of each element, then zeros.
   pure function vertices_of_elements(mesh, vertex) result(corners)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: vertex(:)
      integer(ip) :: corners(maxval(mesh%shape(:mesh%n_elements)), mesh%n_elements)
      integer(ip) :: e, a, m

      corners = 0
      do e = 1, mesh%n_elements
         m = 0
         do a = 1, mesh%shape(e)
            if (vertex(mesh%nodes(a, e)) == 0) cycle
            m = m + 1
            corners(m, e) = vertex(mesh%nodes(a, e))
         end do
      end do
   end function vertices_of_elements

   !> The equations of the vertices, those of a vertex one after the other.
   pure subroutine place_equations(weight, perm, place)
      integer(ip), intent(in) :: weight(:)          !< vertices are numbered as their equations
      integer(ip), intent(in) :: perm(:)            !< the vertex, from 0, that comes i-th
      integer(ip), allocatable, intent(out) :: place(:)
      integer(ip) :: before(size(weight)), i, k, n

      n = 0
      do i = 1, size(weight, kind=ip)
         before(i) = n
         n = n + weight(i)
      end do
      allocate (place(n))
      n = 0
      do i = 1, size(perm, kind=ip)
         associate (v => perm(i) + 1)
            place(before(v) + 1:before(v) + weight(v)) = [(n + k, k=1, weight(v))]
            n = n + weight(v)
         end associate
      end do
   end subroutine place_equations

end module metis_order
