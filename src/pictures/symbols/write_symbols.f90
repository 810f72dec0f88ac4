!> All symbols of a step of a scene: <picture>-symbols.dat, and what a script draws of it.
module atrito_write_symbols
   use atrito_drawing, only: drawing_t
   use atrito_kinds, only: ip
   use atrito_link_symbols, only: put_links
   use atrito_load_symbols, only: put_loads
   use atrito_plot_files, only: SCENE_PLOT
   use atrito_plot_scripts, only: plots_t, end_data
   use atrito_strings, only: string_t
   use atrito_support_symbols, only: put_supports
   use atrito_surface_symbols, only: put_surfaces
   use atrito_symbols, only: symbols_t, begin_symbols
   implicit none (type, external)
   private
   public :: write_symbols, legend_lines

contains

   !> Writes <picture>-symbols.dat. The window of the drawing is widened to the symbols.
   subroutine write_symbols(plots, picture, step, drawing, curves)
      type(plots_t), intent(inout), target :: plots
      character(len=*), intent(in) :: picture       !< without ending; that of a scene has surfaces too, undisplaced
      integer(ip), intent(in) :: step               !< whose supports and loads they are, as at its end
      type(drawing_t), intent(inout), target :: drawing
      type(string_t), allocatable, intent(out) :: curves(:)   !< to be drawn over the bodies
      type(symbols_t) :: symbols

      call begin_symbols(plots, picture, step, drawing, symbols)
      if (picture == SCENE_PLOT) call put_surfaces(drawing%model, symbols)
      call put_links(symbols)
      call put_supports(symbols)
      call put_loads(symbols)
      drawing%window = symbols%window
      call move_alloc(symbols%curves, curves)
      call end_data(plots)
   end subroutine write_symbols

   !> Lines of the legend: symbols have long names, so two stand side by side below those of the bodies.
   pure integer(ip) function legend_lines(curves) result(n)
      type(string_t), intent(in) :: curves(:)
      integer :: i

      n = 0
      do i = 1, size(curves)
         if (index(curves(i)%s, ' title ') > 0) n = n + 1
      end do
      n = 1 + (n + 1)/2
   end function legend_lines

end module atrito_write_symbols
