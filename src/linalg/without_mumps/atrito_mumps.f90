!> The twin of src/linalg/atrito_mumps.F90 in a build without MUMPS (ATRITO_MUMPS=OFF, or not found). The sparse storage is neither
!> chosen nor accepted on the command line then, so nothing here is reached; create fails all the same.
module atrito_mumps
   use atrito_kinds, only: ip, lp, wp
   use atrito_profile, only: profile_t
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   use atrito_storage, only: storage_t
   implicit none (type, external)
   private
   public :: sparse_t, mumps_facts_t, has_mumps, mumps_name, mumps_trouble

   type :: mumps_facts_t
      integer(lp) :: entries = 0, factor_entries = 0, memory = 0
      real(wp) :: operations = 0.0_wp
   end type mumps_facts_t

   type, extends(storage_t) :: sparse_t
   contains
      procedure :: create => create_sparse
      procedure :: add => add_to_sparse
      procedure :: factor => factor_sparse
      procedure :: get_schur => get_sparse_schur
      procedure :: reduce => reduce_sparse
      procedure :: expand => expand_sparse
      procedure :: memory_bytes => sparse_memory
      procedure, nopass :: name => sparse_name
      procedure :: close => close_sparse
      procedure :: analyse => analyse_sparse
      procedure :: facts => sparse_facts
   end type sparse_t

contains

   pure logical function has_mumps()
      has_mumps = .false.
   end function has_mumps

   pure function mumps_name() result(name)
      character(len=:), allocatable :: name

      name = 'no MUMPS'
   end function mumps_name

   pure function mumps_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'this build has none'
   end function mumps_trouble

   subroutine create_sparse(self, profile, status)
      class(sparse_t), intent(inout) :: self
      type(profile_t), intent(in) :: profile
      type(status_t), intent(out) :: status

      call set_status(status, STATUS_INTERNAL, 'the sparse solver needs MUMPS, and '//mumps_trouble())
   end subroutine create_sparse

   subroutine add_to_sparse(self, equations, matrix)
      class(sparse_t), intent(inout) :: self
      integer(ip), intent(in) :: equations(:)
      real(wp), intent(in) :: matrix(:, :)
   end subroutine add_to_sparse

   subroutine close_sparse(self)
      class(sparse_t), intent(inout) :: self
   end subroutine close_sparse

   subroutine analyse_sparse(self)
      class(sparse_t), intent(inout) :: self
   end subroutine analyse_sparse

   subroutine factor_sparse(self, status)
      class(sparse_t), intent(inout) :: self
      type(status_t), intent(out) :: status

      call set_status(status, STATUS_INTERNAL, 'the sparse solver needs MUMPS, and '//mumps_trouble())
   end subroutine factor_sparse

   subroutine get_sparse_schur(self, schur)
      class(sparse_t), intent(in) :: self
      real(wp), intent(out) :: schur(:, :)

      schur = 0.0_wp
   end subroutine get_sparse_schur

   subroutine reduce_sparse(self, f)
      class(sparse_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: f(:, :)
   end subroutine reduce_sparse

   subroutine expand_sparse(self, x)
      class(sparse_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: x(:, :)
   end subroutine expand_sparse

   pure integer(lp) function sparse_memory(self)
      class(sparse_t), intent(in) :: self

      sparse_memory = 0
   end function sparse_memory

   pure type(mumps_facts_t) function sparse_facts(self) result(facts)
      class(sparse_t), intent(in) :: self

      facts = mumps_facts_t()
   end function sparse_facts

   pure function sparse_name() result(name)
      character(len=:), allocatable :: name

      name = 'sparse'
   end function sparse_name

end module atrito_mumps
