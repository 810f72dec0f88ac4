!> METIS (G. Karypis and V. Kumar, SIAM J. Sci. Comput. 20 (1998) 359-392); the only module that knows it.
!>
!> The library is loaded when it is asked for, not with the program: CMake says which file that is (ATRITO_METIS_LIBRARY, its name
!> with the version in it) and its version (ATRITO_METIS_VERSION), and sees to it that its integers have 32 bits.
module atrito_metis
   use, intrinsic :: iso_c_binding, only: c_associated, c_f_procpointer, c_funptr, c_int32_t, c_null_ptr, c_ptr
   use atrito_kinds, only: ip
   use atrito_system, only: find_routine, terminate
   implicit none (type, external)
   private
   public :: halve_graph, has_metis, metis_version, metis_trouble

   integer(c_int32_t), parameter :: METIS_OK = 1, METIS_ERROR = -4, N_OPTIONS = 40
   !> Places in the list of options, counted from one.
   integer(c_int32_t), parameter :: SEED = 9, UFACTOR = 17

   abstract interface
      integer(c_int32_t) function partition(n, n_constraints, first, neighbour, vertex_weight, vertex_size, edge_weight, n_parts, &
                                            target, balance, options, cut, part) bind(C)
         import :: c_int32_t, c_ptr
         integer(c_int32_t), intent(in) :: n, n_constraints, first(*), neighbour(*), vertex_weight(*), edge_weight(*), n_parts
         type(c_ptr), value :: vertex_size, target, balance
         integer(c_int32_t), intent(in) :: options(*)
         integer(c_int32_t), intent(out) :: cut, part(*)
      end function partition
      integer(c_int32_t) function set_options(options) bind(C)
         import :: c_int32_t
         integer(c_int32_t), intent(out) :: options(*)
      end function set_options
   end interface

contains

   !> Cuts a graph in halves, these in halves, and so on: 2**n_levels parts, of whose numbers from zero the highest bit tells the
   !> half, the next one the half of the half. The same for every call with the same graph.
   subroutine halve_graph(first, neighbour, vertex_weight, edge_weight, n_levels, imbalance, part, done)
      integer(ip), intent(in) :: first(:) !< (n + 1) neighbours of vertex i: neighbour(first(i):first(i + 1) - 1)
      integer(ip), intent(in) :: neighbour(:), edge_weight(:) !< one entry an edge and direction; edge_weight > 0
      integer(ip), intent(in) :: vertex_weight(:)             !< (n)
      integer, intent(in) :: n_levels                         !< 2**n_levels parts
      integer(ip), intent(in) :: imbalance                    !< thousandths by which the largest part may be heavier than the mean
      integer(ip), intent(out) :: part(:)                     !< (n)
      logical, intent(out) :: done                            !< there is METIS, and it had enough memory
      procedure(partition), pointer :: cut_up
      integer(c_int32_t) :: options(N_OPTIONS), cut

      call begin('METIS_PartGraphRecursive', options, done)
      if (.not. done) return
      call c_f_procpointer(routine('METIS_PartGraphRecursive'), cut_up)
      options(UFACTOR) = imbalance
      call judge(cut_up(size(first, kind=ip) - 1, 1_ip, first - 1_ip, neighbour - 1_ip, vertex_weight, c_null_ptr, edge_weight, &
                        2_ip**n_levels, c_null_ptr, c_null_ptr, options, cut, part), done)
   end subroutine halve_graph

   !> The options, and whether a routine can be loaded.
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
