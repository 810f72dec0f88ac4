!> Finding the named parts of a model, without case.
module atrito_model_names
   use atrito_kinds, only: ip
   use atrito_model, only: model_t
   use atrito_strings, only: string_t, same_name
   implicit none (type, external)
   private
   public :: surface_names, material_names, interaction_names, find_name

contains

   !> Place of a name in a list; 0 when it is not there.
   pure integer(ip) function find_name(names, name) result(i)
      type(string_t), intent(in) :: names(:)
      character(len=*), intent(in) :: name

      do i = 1, size(names, kind=ip)
         if (same_name(names(i)%s, name)) return
      end do
      i = 0
   end function find_name

   pure function surface_names(model) result(names)
      type(model_t), intent(in) :: model
      type(string_t) :: names(size(model%surfaces))
      integer :: i

      do i = 1, size(names)
         names(i)%s = model%surfaces(i)%name
      end do
   end function surface_names

   pure function material_names(model) result(names)
      type(model_t), intent(in) :: model
      type(string_t) :: names(size(model%materials))
      integer :: i

      do i = 1, size(names)
         names(i)%s = model%materials(i)%name
      end do
   end function material_names

   pure function interaction_names(model) result(names)
      type(model_t), intent(in) :: model
      type(string_t) :: names(size(model%interactions))
      integer :: i

      do i = 1, size(names)
         names(i)%s = model%interactions(i)%name
      end do
   end function interaction_names

end module atrito_model_names
