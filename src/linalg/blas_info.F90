!> Which BLAS and LAPACK the program was linked with, which of its kernels BLAS takes, and how many threads.
!>
!> CMake looks for OpenBLAS's own functions in the libraries that it found (ATRITO_OPENBLAS, ATRITO_BLAS_SHUTDOWN,
!> ATRITO_BLAS_KERNELS) and says where these are (ATRITO_BLAS_LIBRARY). The reference BLAS costs a factor of three, hence the
!> question.
module atrito_blas_info
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char, c_ptr, c_associated, c_f_pointer
   use atrito_files, only: read_system_line
   use atrito_kinds, only: ip, lp
   use atrito_lapack, only: ilaver
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: blas_buffer_bytes, claim_blas_buffers
   public :: blas_name, lapack_version, is_reference_blas, set_blas_threads, choose_blas_kernels, kernels_with

#ifdef ATRITO_OPENBLAS
   logical, parameter :: HAS_OPENBLAS = .true.

   interface
      type(c_ptr) function openblas_get_config() bind(C, name='openblas_get_config')
         import :: c_ptr
      end function openblas_get_config
      subroutine openblas_set_num_threads(threads) bind(C, name='openblas_set_num_threads')
         import :: c_int
         integer(c_int), value :: threads
      end subroutine openblas_set_num_threads
#ifdef ATRITO_BLAS_SHUTDOWN
      integer(c_int) function blas_thread_shutdown() bind(C, name='blas_thread_shutdown_')
         import :: c_int
      end function blas_thread_shutdown
#endif
#ifdef ATRITO_BLAS_MEMORY
      type(c_ptr) function blas_memory_alloc(place) bind(C, name='blas_memory_alloc')
         import :: c_int, c_ptr
         integer(c_int), value :: place
      end function blas_memory_alloc
      subroutine blas_memory_free(buffer) bind(C, name='blas_memory_free')
         import :: c_ptr
         type(c_ptr), value :: buffer
      end subroutine blas_memory_free
#endif
#ifdef ATRITO_BLAS_KERNELS
      subroutine gotoblas_dynamic_init() bind(C, name='gotoblas_dynamic_init')
      end subroutine gotoblas_dynamic_init
      subroutine gotoblas_dynamic_quit() bind(C, name='gotoblas_dynamic_quit')
      end subroutine gotoblas_dynamic_quit
      integer(c_int) function setenv(name, value, overwrites) bind(C, name='setenv')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: name(*), value(*)
         integer(c_int), value :: overwrites
      end function setenv
#endif
   end interface
#else
   logical, parameter :: HAS_OPENBLAS = .false.
#endif

contains

   !> For the listing: 'OpenBLAS 0.3.21 ...' as the library describes itself, else the name of the library file.
   function blas_name() result(name)
      character(len=:), allocatable :: name

#ifdef ATRITO_OPENBLAS
      name = to_string(openblas_get_config())
      if (index(name, 'OpenBLAS') /= 1) name = 'OpenBLAS '//name
#else
      name = ATRITO_BLAS_LIBRARY
#endif
   end function blas_name

   !> '3.11.0', as LAPACK says.
   function lapack_version() result(version)
      character(len=:), allocatable :: version
      integer(ip) :: parts(3)

      call ilaver(parts(1), parts(2), parts(3))
      version = to_text(parts(1))//'.'//to_text(parts(2))//'.'//to_text(parts(3))
   end function lapack_version

   !> True for the slow one: a library of the plain name libblas or liblapack that is not OpenBLAS in disguise.
   pure logical function is_reference_blas()
      character(len=*), parameter :: FILE = ATRITO_BLAS_LIBRARY
      character(len=*), parameter :: STEM = FILE(index(FILE, '/', back=.true.) + 1:)

      is_reference_blas = .not. HAS_OPENBLAS .and. &
                          (index(STEM, 'libblas') == 1 .or. index(STEM, 'liblapack') == 1 .or. index(STEM, 'librefblas') == 1)
   end function is_reference_blas

   !> Threads that BLAS may use from now on; without effect where the library offers no such call. OpenBLAS starts a thread a core
   !> while the program is loaded, and they spin: for one thread the others are ended, else a small run would count three to
   !> four times its wall time as processor time.
   subroutine set_blas_threads(n)
      integer(ip), intent(in) :: n              !< >= 1

#ifdef ATRITO_OPENBLAS
      call openblas_set_num_threads(int(max(n, 1_ip), c_int))
#ifdef ATRITO_BLAS_SHUTDOWN
      if (n <= 1) then
         if (blas_thread_shutdown() /= 0_c_int) return
      end if
#endif
#else
      if (n < 1) return
#endif
   end subroutine set_blas_threads

   !> Address space that BLAS takes for each thread that calls it, at its first call [bytes]. OpenBLAS asks for it again and again
   !> where it is not there, for ever: whoever has a limit has to ask first. On some processors it is less; none has more.
   pure integer(lp) function blas_buffer_bytes()
      integer(lp), parameter :: OF_OPENBLAS = 2_lp**27 + 2_lp**16

      blas_buffer_bytes = merge(OF_OPENBLAS, 0_lp, HAS_OPENBLAS)
   end function blas_buffer_bytes

   !> Has BLAS take the buffers of so many threads now, when it is known that they can be had; they stay its own.
   subroutine claim_blas_buffers(n)
      integer(ip), intent(in) :: n !< >= 1; the threads that will call BLAS
#ifdef ATRITO_BLAS_MEMORY
      type(c_ptr) :: buffers(n)
      integer(ip) :: i

      do i = 1, n
         buffers(i) = blas_memory_alloc(0_c_int)
      end do
      do i = 1, n
         call blas_memory_free(buffers(i))
      end do
#else
      if (n < 1) return
#endif
   end subroutine claim_blas_buffers

   !> Has OpenBLAS take the kernels of an earlier processor with the same instructions, where it does not know this one and takes
   !> its oldest, which are half as fast. Who has set OPENBLAS_CORETYPE has chosen. Before BLAS is called, and by one thread.
   subroutine choose_blas_kernels()
#ifdef ATRITO_BLAS_KERNELS
      character(len=*), parameter :: OLDEST = ' Prescott ', CHOICE = 'OPENBLAS_CORETYPE'
      character(len=:), allocatable :: flags, kernels
      logical :: found
      integer :: length

      call get_environment_variable(CHOICE, length=length)
      if (length > 0 .or. index(blas_name(), OLDEST) == 0) return
      call read_system_line('/proc/cpuinfo', 'flags', flags, found)
      if (.not. found) return
      kernels = kernels_with(flags)
      if (len(kernels) == 0) return
      if (setenv(CHOICE//c_null_char, kernels//c_null_char, 1_c_int) /= 0_c_int) return
      call gotoblas_dynamic_quit()
      call gotoblas_dynamic_init()
#endif
   end subroutine choose_blas_kernels

   !> The kernels of OpenBLAS that need no more than these instructions; '' for its oldest.
   pure function kernels_with(flags) result(kernels)
      character(len=*), intent(in) :: flags      !< as in /proc/cpuinfo, with blanks between them
      character(len=:), allocatable :: kernels

      kernels = ''
      if (.not. (has('avx2') .and. has('fma'))) return
      kernels = 'Haswell'
      if (has('avx512f') .and. has('avx512dq') .and. has('avx512bw') .and. has('avx512vl')) kernels = 'SkylakeX'
   contains
      pure logical function has(flag)
         character(len=*), intent(in) :: flag !< one word of them

         has = index(' '//flags//' ', ' '//flag//' ') > 0
      end function has
   end function kernels_with

#ifdef ATRITO_OPENBLAS
   !> A C string; empty for a null pointer.
   function to_string(pointer) result(text)
      type(c_ptr), intent(in) :: pointer
      character(len=:), allocatable :: text
      integer, parameter :: LONGEST = 256
      character(kind=c_char), pointer :: characters(:)
      integer :: i

      text = ''
      if (.not. c_associated(pointer)) return
      call c_f_pointer(pointer, characters, [LONGEST])
      do i = 1, LONGEST
         if (characters(i) == c_null_char) exit
         text = text//characters(i)
      end do
      text = trim(text)
   end function to_string
#endif

end module atrito_blas_info
