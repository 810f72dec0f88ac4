!> Keeps the frames of a history on the disk until they are written into tables: a history of any number of increments takes the
!> memory of a few. What the tables hold depends on all frames (what is rounding beside the largest of any is 0; columns are as wide
!> as the widest), so they cannot be written before the last one is there.
module atrito_frame_spool
   use atrito_archive, only: archive_t, is_sound, spool_archive, turn_to
   use atrito_exchange_results, only: exchange_results
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp
   use atrito_results, only: frame_store_t, results_t
   use atrito_spool, only: close_spool, give_up_rest, place_of
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: frame_spool_t, begin_frames, end_frames

   integer, parameter :: SOME = 16

   !> A store of frames (frame_store_t) on the disk.
   type, extends(frame_store_t) :: frame_spool_t
      private
      character(len=:), allocatable :: folder        !< on whose disk the file is
      type(archive_t) :: archive                     !< spooled, one frame behind the other
      logical :: is_open = .false.                   !< the first frame has come
      integer(lp), allocatable :: place(:)           !< where each frame begins, and where the next will [bytes]
      type(results_t) :: shown                       !< the frame that was asked for last
      integer(ip) :: i_shown = 0                     !< 0: none
   contains
      procedure :: put => put_frame
      procedure :: get => get_frame
   end type frame_spool_t

contains

   !> Gets ready to keep frames on the disk of a folder, which need not be there yet. No file is opened before the first one.
   subroutine begin_frames(folder, spool)
      character(len=*), intent(in) :: folder         !< of the tables
      type(frame_spool_t), intent(out) :: spool      !< empty, ready to be a frame_store_t

      spool%folder = folder
   end subroutine begin_frames

   !> A full disk is no failure of the run: the frame stays in the memory.
   subroutine put_frame(self, i, frame, done)
      class(frame_spool_t), intent(inout) :: self
      integer(ip), intent(in) :: i
      type(results_t), intent(inout) :: frame
      logical, intent(out) :: done

      done = .false.
      if (.not. self%is_open) then
         call spool_archive(self%folder, self%archive)
         self%is_open = is_sound(self%archive)
         if (.not. self%is_open) return
      end if
      if (.not. allocated(self%place)) allocate (self%place(SOME), source=0_lp)
      if (size(self%place) <= i) call grow(self%place, 2*size(self%place, kind=lp))
      call turn_to(self%archive, self%place(i), is_reading=.false.)
      call exchange_results(self%archive, frame)
      self%place(i + 1) = place_of(self%archive%spool)
      ! what is not with the system yet, goes there now or not at all
      call turn_to(self%archive, self%place(i), is_reading=.true.)
      done = is_sound(self%archive)
      if (done) return
      call give_up_rest(self%archive%spool)          ! what stands before it can be read
      self%archive%status = status_t()
   end subroutine put_frame

   subroutine get_frame(self, i, frame)
      class(frame_spool_t), intent(inout), target :: self
      integer(ip), intent(in) :: i
      type(results_t), pointer, intent(out) :: frame

      frame => self%shown
      if (self%i_shown == i) return
      self%shown = results_t()
      call turn_to(self%archive, self%place(i), is_reading=.true.)
      call exchange_results(self%archive, self%shown)
      self%i_shown = i
      if (is_sound(self%archive)) return
      self%i_shown = 0
      nullify (frame)
   end subroutine get_frame

   !> Gives the file back to the disk.
   subroutine end_frames(spool)
      type(frame_spool_t), intent(inout) :: spool    !< its frames are gone on return

      if (spool%is_open) call close_spool(spool%archive%spool)
      spool%is_open = .false.
   end subroutine end_frames

end module atrito_frame_spool
