!> The elasticity of a section: that of its material, turned by its orientation.
module atrito_section_elasticity
   use atrito_model, only: material_t, section_t
   use atrito_orthotropy, only: inverse_of, turned_compliance, turned_stiffness
   use atrito_plane_state, only: elastic_t
   implicit none (type, external)
   private
   public :: elasticity_of

contains

   !> The elasticity of a section: that of its material, turned by the orientation of the section where it is orthotropic.
   pure type(elastic_t) function elasticity_of(section, material) result(elastic)
      type(section_t), intent(in) :: section     !< thickness, formulation and axis are used
      type(material_t), intent(in) :: material   !< of the section

      elastic = elastic_t(material%young, material%poisson, section%thickness, material%density, section%formulation, &
                          material%expansion)
      if (.not. material%is_orthotropic) return
      elastic%is_orthotropic = .true.
      elastic%stiffness = turned_stiffness(material%stiffness, section%axis)
      elastic%compliance = turned_compliance(inverse_of(material%stiffness), section%axis)
   end function elasticity_of

end module atrito_section_elasticity
