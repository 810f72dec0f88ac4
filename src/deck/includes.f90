!> Which files an *INCLUDE may read, and where they are.
module atrito_includes
   use atrito_deck, only: deck_t, card_t, token_t, token_text, LEVEL_STEP
   use atrito_diagnostics, only: report_error
   use atrito_files, only: file_exists, true_path
   use atrito_items, only: option_word
   use atrito_kinds, only: ip, lp
   use atrito_strings, only: replaced, to_text
   implicit none (type, external)
   private
   public :: path_of_include, may_include, is_told

   integer, parameter :: DEEPEST_INCLUDE = 20
   !> Includes that each include two others would fill any memory at a depth of 20.
   integer(ip), parameter :: MOST_SOURCES = 10000
   integer(lp), parameter :: MOST_CHARACTERS = 2000000000_lp   !< of all files

contains

   !> No circle, and not too deep.
   logical function may_include(deck, depth, from, name, place)
      type(deck_t), intent(in) :: deck                 !< its sources, and texts for messages
      integer, intent(in) :: depth                     !< of the includes so far
      integer(ip), intent(in) :: from                  !< source that includes it
      character(len=*), intent(in) :: name             !< path of the file, by path_of_include
      type(token_t), intent(in) :: place               !< where it is named, for messages
      character(len=:), allocatable :: path
      integer(lp) :: characters                    ! of all files so far
      integer(ip) :: above

      may_include = .false.
      characters = sum([(len(deck%sources(above)%text, kind=lp), above=1, deck%n_sources)])
      path = true_path(name)                       ! a/../a/deck.inp is deck.inp again
      above = from
      do while (above > 0)
         if (true_path(deck%sources(above)%name) == path) exit
         above = deck%sources(above)%parent
      end do
      if (above > 0) then
         call report_error(deck, place, 'E-INCLUDE', 'the includes go in a circle: '//name//' is being read', &
                           expected='another file', keyword='INCLUDE')
      else if (depth >= DEEPEST_INCLUDE) then
         call report_error(deck, place, 'E-INCLUDE', 'includes more than '//to_text(DEEPEST_INCLUDE)//' deep', keyword='INCLUDE')
      else if (deck%n_sources >= MOST_SOURCES .or. characters > MOST_CHARACTERS) then
         call report_error(deck, place, 'E-INCLUDE', 'includes of more than '//to_text(MOST_SOURCES)//' files, or 2 GB in all', &
                           keyword='INCLUDE')
      else
         may_include = .true.
      end if
   end function may_include

   !> The path of the file that an *INCLUDE names. Where there is none with backslashes in its name they are those of Windows.
   function path_of_include(from, name) result(path)
      character(len=*), intent(in) :: from, name !< path of the file that includes it; what stands in that file
      character(len=:), allocatable :: path

      path = relative_path(from, name)
      if (index(name, '\') == 0) return
      if (.not. file_exists(path)) path = relative_path(from, replaced(name, '\', '/'))
   end function path_of_include

   !> The path of a file relative to the folder of another one, without `./`.
   pure function relative_path(from, name) result(path)
      character(len=*), intent(in) :: from, name
      character(len=:), allocatable :: path

      path = name
      do while (index(path, './') == 1 .and. len(path) > 2)
         path = path(3:)
         do while (path(1:1) == '/' .and. len(path) > 1)
            path = path(2:)                        ! .//a is no absolute path
         end do
      end do
      if (path(1:1) /= '/') path = from(:index(from, '/', back=.true.))//path
   end function relative_path

   !> A mesh of Gmsh is no deck, and stands before the steps.
   logical function is_told(deck, card, text, place)
      type(deck_t), intent(in) :: deck                 !< its texts are read
      type(card_t), intent(in) :: card                 !< *INCLUDE
      character(len=*), intent(in) :: text             !< of the file
      type(token_t), intent(in) :: place               !< of the file's name

      is_told = (index(text(:min(len(text), 80)), '$MeshFormat') == 0) .or. option_word(deck, card, 'TYPE') == 'GMSH'
      if (.not. is_told) then
         call report_error(deck, place, 'E-INCLUDE', 'this file is a mesh of Gmsh', &
                           expected='TYPE=GMSH: *INCLUDE, INPUT='//token_text(deck, place)//', TYPE=GMSH', keyword='INCLUDE')
      else if (option_word(deck, card, 'TYPE') == 'GMSH' .and. card%level == LEVEL_STEP) then
         is_told = .false.
         call report_error(deck, card%place, 'E-LEVEL', 'a mesh stands inside the step', expected='its place before *STEP', &
                           keyword='INCLUDE')
      end if
   end function is_told

end module atrito_includes
