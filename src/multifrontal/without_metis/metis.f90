!> The twin of src/multifrontal/metis.F90 in a build without METIS.
module atrito_metis
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: halve_graph, has_metis, metis_version, metis_trouble

contains

   !> done: .false.
   subroutine halve_graph(first, neighbour, vertex_weight, edge_weight, n_levels, imbalance, part, done)
      integer(ip), intent(in) :: first(:), neighbour(:), edge_weight(:), vertex_weight(:) !< not looked at
      integer, intent(in) :: n_levels      !< not looked at
      integer(ip), intent(in) :: imbalance !< not looked at
      integer(ip), intent(out) :: part(:)  !< zeros
      logical, intent(out) :: done         !< false

      part = 0
      done = .false.
   end subroutine halve_graph

   !> This build has no METIS.
   pure logical function has_metis()
      has_metis = .false.
   end function has_metis

   !> For --version.
   pure function metis_version() result(version)
      character(len=:), allocatable :: version

      version = 'none'
   end function metis_version

   !> Why there is no METIS, for messages.
   pure function metis_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'this build has none'
   end function metis_trouble

end module atrito_metis
