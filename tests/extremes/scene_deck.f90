!> Writes the deck of a scene: scene_deck [name=value ...] < SCENE > DECK. Values on the command line replace those read.
program scene_deck
   use, intrinsic :: iso_fortran_env, only: input_unit, output_unit
   use scene_file, only: scene_t, read_scene, set_from_text, write_deck
   implicit none (type, external)
   type(scene_t) :: scene
   character(len=200) :: argument
   integer :: i

   call read_scene(input_unit, scene)
   do i = 1, command_argument_count()
      call get_command_argument(i, argument)
      call set_from_text(scene, trim(argument))
   end do
   call write_deck(output_unit, scene, 'A scene of tests/extremes')
end program scene_deck
