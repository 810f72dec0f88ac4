!> METIS (G. Karypis and V. Kumar, SIAM J. Sci. Comput. 20 (1998) 359-392); the only module that knows it.
!>
!> The library is loaded when it is asked for, not with the program: CMake says which file that is (ATRITO_METIS_LIBRARY, its name
!> with the version in it) and its version (ATRITO_METIS_VERSION), and sees to it that its integers have 32 bits.
module atrito_metis
   use, intrinsic :: iso_c_binding, only: c_associated, c_f_procpointer, c_float, c_funptr, c_int32_t, c_int64_t, &
                                                                             c_null_ptr, c_ptr
   use atrito_kinds, only: ip, wp
   use atrito_system, only: c_restore_halting, c_suspend_halting, find_routine, terminate
   implicit none (type, external)
   private
   public :: halve_graph, share_graph, cut_mesh, has_metis, metis_version, metis_trouble

   integer(c_int32_t), parameter :: METIS_OK = 1, METIS_ERROR = -4, N_OPTIONS = 40
   !> Places in the list of options, counted from one.
   integer(c_int32_t), parameter :: SEED = 9, UFACTOR = 17
   !> Numbers of a floating-point environment, as in atrito_halting: METIS divides by sums that may be zero.
   integer, parameter :: ENVIRONMENT_LENGTH = 32
   !> Elements are neighbours in the dual graph that have a side in common.
   integer(c_int32_t), parameter :: NODES_OF_A_SIDE = 2

   abstract interface
      integer(c_int32_t) function partition(n, n_constraints, first, neighbour, vertex_weight, vertex_size, edge_weight, n_parts, &
                                            target, balance, options, cut, part) bind(C)
         import :: c_int32_t, c_ptr
         integer(c_int32_t), intent(in) :: n, n_constraints, first(*), neighbour(*), vertex_weight(*), edge_weight(*), n_parts
         type(c_ptr), value :: vertex_size, target, balance
         integer(c_int32_t), intent(in) :: options(*)
         integer(c_int32_t), intent(out) :: cut, part(*)
      end function partition
      integer(c_int32_t) function partition_mesh(n, n_nodes, first, node, weight, element_size, n_common, n_parts, target, &
                                                 options, cut, part, part_of_node) bind(C)
         import :: c_float, c_int32_t, c_ptr
         integer(c_int32_t), intent(in) :: n, n_nodes, first(*), node(*), weight(*), n_common, n_parts
         type(c_ptr), value :: element_size
         real(c_float), intent(in) :: target(*)
         integer(c_int32_t), intent(in) :: options(*)
         integer(c_int32_t), intent(out) :: cut, part(*), part_of_node(*)
      end function partition_mesh
      integer(c_int32_t) function set_options(options) bind(C)
         import :: c_int32_t
         integer(c_int32_t), intent(out) :: options(*)
      end function set_options
   end interface

contains

   !> Cuts a graph in halves, these in halves, and so on: 2**n_levels parts, of whose numbers from zero the highest bit tells the
   !> half, the next one the half of the half. The same for every call with the same graph.
   subroutine halve_graph(first, neighbour, vertex_weight, edge_weight, n_levels, imbalance, part, done)
      integer(ip), intent(in) :: first(:)        !< (n + 1) neighbours of vertex i: neighbour(first(i):first(i + 1) - 1)
      integer(ip), intent(in) :: neighbour(:), edge_weight(:)
      integer(ip), intent(in) :: vertex_weight(:) !< (n)
      integer, intent(in) :: n_levels
      integer(ip), intent(in) :: imbalance       !< thousandths by which the largest part may be heavier than the mean
      integer(ip), intent(out) :: part(:)        !< (n)
      logical, intent(out) :: done               !< there is METIS, and it had enough memory
      procedure(partition), pointer :: cut_up
      integer(c_int32_t) :: options(N_OPTIONS), cut

      call begin('METIS_PartGraphRecursive', options, done)
      if (.not. done) return
      call c_f_procpointer(routine('METIS_PartGraphRecursive'), cut_up)
      options(UFACTOR) = imbalance
      call judge(cut_up(size(first, kind=ip) - 1, 1_ip, first - 1_ip, neighbour - 1_ip, vertex_weight, c_null_ptr, edge_weight, &
                        2_ip**n_levels, c_null_ptr, c_null_ptr, options, cut, part), done)
   end subroutine halve_graph

   !> Shares out the vertices of a graph, the heavier the edges the rather together. The same for every call with the same graph.
   subroutine share_graph(first, neighbour, vertex_weight, edge_weight, n_parts, part, done)
      integer(ip), intent(in) :: first(:)        !< (n + 1) neighbours of vertex i: neighbour(first(i):first(i + 1) - 1)
      integer(ip), intent(in) :: neighbour(:), edge_weight(:)
      integer(ip), intent(in) :: vertex_weight(:) !< (n)
      integer(ip), intent(in) :: n_parts         !< >= 2
      integer(ip), intent(out) :: part(:)        !< (n) 1..n_parts
      logical, intent(out) :: done               !< there is METIS, and it had enough memory
      procedure(partition), pointer :: cut_up
      integer(c_int32_t) :: options(N_OPTIONS), cut, code
      integer(c_int64_t) :: environment(ENVIRONMENT_LENGTH)

      call begin('METIS_PartGraphKway', options, done)
      if (.not. done) return
      call c_f_procpointer(routine('METIS_PartGraphKway'), cut_up)
      call c_suspend_halting(environment)
      code = cut_up(size(first, kind=ip) - 1, 1_ip, first - 1_ip, neighbour - 1_ip, vertex_weight, c_null_ptr, edge_weight, &
                    n_parts, c_null_ptr, c_null_ptr, options, cut, part)
      call c_restore_halting(environment)
      call judge(code, done)
      part = part + 1_ip
   end subroutine share_graph

   !> Cuts a mesh between its elements. The same for every call with the same mesh.
   subroutine cut_mesh(first, node, n_nodes, weight, target, part, done)
      integer(ip), intent(in) :: first(:)        !< (n + 1) nodes of element i: node(first(i):first(i + 1) - 1)
      integer(ip), intent(in) :: node(:)         !< 1..n_nodes
      integer(ip), intent(in) :: n_nodes
      integer(ip), intent(in) :: weight(:)       !< (n)
      real(wp), intent(in) :: target(:)          !< (parts) shares of the weight; their sum is 1
      integer(ip), intent(out) :: part(:)        !< (n) 1..size(target)
      logical, intent(out) :: done               !< there is METIS, and it had enough memory
      procedure(partition_mesh), pointer :: cut_up
      integer(c_int32_t) :: options(N_OPTIONS), cut, code
      integer(c_int32_t), allocatable :: part_of_node(:)
      integer(c_int64_t) :: environment(ENVIRONMENT_LENGTH)

      call begin('METIS_PartMeshDual', options, done)
      if (.not. done) return
      call c_f_procpointer(routine('METIS_PartMeshDual'), cut_up)
      allocate (part_of_node(n_nodes))
      call c_suspend_halting(environment)
      code = cut_up(size(first, kind=ip) - 1, n_nodes, first - 1_ip, node - 1_ip, weight, c_null_ptr, NODES_OF_A_SIDE, &
                    size(target, kind=ip), real(target, c_float), options, cut, part, part_of_node)
      call c_restore_halting(environment)
      call judge(code, done)
      part = part + 1_ip
   end subroutine cut_mesh

   !> The options that all have in common, and whether a routine can be loaded.
   subroutine begin(symbol, options, done)
      character(len=*), intent(in) :: symbol
      integer(c_int32_t), intent(out) :: options(:)
      logical, intent(out) :: done
      procedure(set_options), pointer :: begin_options

      options = 0
      done = has_metis()
      if (done) done = c_associated(routine(symbol))
      if (.not. done) return
      call c_f_procpointer(routine('METIS_SetDefaultOptions'), begin_options)
      done = begin_options(options) == METIS_OK
      options(SEED) = 1
   end subroutine begin

   subroutine judge(code, done)
      integer(c_int32_t), intent(in) :: code     !< what a routine of METIS returned
      logical, intent(out) :: done

      ! while it works METIS takes SIGTERM for an error of its own: it was meant for the program
      if (code == METIS_ERROR) call terminate()
      done = code == METIS_OK
   end subroutine judge

   type(c_funptr) function routine(symbol)
      character(len=*), intent(in) :: symbol

      routine = find_routine(ATRITO_METIS_LIBRARY, symbol)
   end function routine

   !> Whether the library can be loaded.
   logical function has_metis()
      has_metis = c_associated(routine('METIS_PartGraphRecursive')) .and. c_associated(routine('METIS_SetDefaultOptions'))
   end function has_metis

   !> For --version: '5.1.0'.
   pure function metis_version() result(version)
      character(len=:), allocatable :: version

      version = ATRITO_METIS_VERSION
   end function metis_version

   !> Why there is no METIS, where there is none.
   pure function metis_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'the library '//ATRITO_METIS_LIBRARY//' cannot be loaded'
   end function metis_trouble

end module atrito_metis
