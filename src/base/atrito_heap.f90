!> Keeps the memory that the program gives back to the C library for what it asks for next.
!>
!> Left to itself the library takes every large array from the system and gives it back there: the system clears each page anew when
!> it is touched, which took a fifth of the processor time of a large run. In one growing heap a page is cleared once: the page
!> faults of a run are its peak memory, and that is no larger (docs/developer/multifrontal.md).
module atrito_heap
   use, intrinsic :: iso_c_binding, only: c_associated, c_f_procpointer, c_funptr, c_int, c_size_t
   use atrito_dynamic_library, only: find_routine
   use atrito_kinds, only: lp
   implicit none (type, external)
   private
   public :: keep_freed_memory, reusable_memory

   !> What the C library tells of its heap [bytes].
   type, bind(C) :: mallinfo_t
      integer(c_size_t) :: arena, ordblks, smblks, hblks, hblkhd, usmblks, fsmblks
      integer(c_size_t) :: fordblks                !< free
      integer(c_size_t) :: keepcost
   end type mallinfo_t

   abstract interface
      function tell_heap() result(info) bind(C)
         import :: mallinfo_t
         type(mallinfo_t) :: info
      end function tell_heap
   end interface

   interface
      integer(c_int) function c_mallopt(option, value) bind(C, name='mallopt')
         import :: c_int
         integer(c_int), value :: option, value
      end function c_mallopt
   end interface

   !> Options of the GNU C library: bytes at the top of the heap beyond which it shrinks (-1: it does not), bytes that it grows by
   !> beyond what is asked for, and how many arrays may have memory of their own.
   integer(c_int), parameter :: TRIM_THRESHOLD = -1_c_int, TOP_PAD = -2_c_int, MMAP_MAX = -4_c_int
   integer(c_int), parameter :: GROWS_BY = 1048576_c_int
   !> The library, which has had the routine since 2021.
   character(len=*), parameter :: C_LIBRARY = 'libc.so.6', TELLER = 'mallinfo2'

contains

   !> To be called before the first large array is allocated. Where the library refuses, nothing changes.
   subroutine keep_freed_memory()
      integer(c_int) :: taken

      taken = c_mallopt(MMAP_MAX, 0_c_int)
      taken = c_mallopt(TRIM_THRESHOLD, -1_c_int)
      taken = c_mallopt(TOP_PAD, GROWS_BY)
   end subroutine keep_freed_memory

   !> Memory that the process holds and that will serve again [bytes], without what may not have been touched yet; 0 where the
   !> library does not tell.
   integer(lp) function reusable_memory() result(bytes)
      type(c_funptr) :: routine
      procedure(tell_heap), pointer :: tell
      type(mallinfo_t) :: info

      bytes = 0
      routine = find_routine(C_LIBRARY, TELLER)
      if (.not. c_associated(routine)) return
      call c_f_procpointer(routine, tell)
      info = tell()
      bytes = max(0_lp, int(info%fordblks, lp) - int(GROWS_BY, lp))
   end function reusable_memory

end module atrito_heap
