!> What the lines of supports and loads act on, by the names of the deck: the rows of resultants.tab.
module atrito_sources
   use atrito_build_context, only: build_context_t
   use atrito_deck, only: token_t, token_text, is_empty_token
   use atrito_deck_expressions, only: evaluate_at
   use atrito_kinds, only: ip, wp
   use atrito_name_list, only: add_name, find_name, names_of
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: open_source, keep_sources

   character(len=*), parameter :: ALL_ELEMENTS = 'all_elements'   !< of a line that names none

contains

   !> What is added from now on is of the line that begins with this token. Lines of a keyword that name the same are one source.
   subroutine open_source(context, keyword, token)
      type(build_context_t), intent(inout) :: context  !< open%source is set; a new source is kept
      character(len=*), intent(in) :: keyword          !< without blanks
      type(token_t), intent(in) :: token               !< its first item: set, surface or number; empty: all elements
      character(len=:), allocatable :: name
      type(token_t) :: inner
      real(wp) :: value
      logical :: known

      name = ALL_ELEMENTS
      if (.not. is_empty_token(token)) name = token_text(context%deck, token)
      if (index(name, '<') == 1) then                  ! of an expression the number that it is
         inner = token
         inner%first = token%first + 1
         inner%last = token%last - 1
         call evaluate_at(context%deck, inner, value, known, silent=.true.)
         if (known) known = abs(value) < real(huge(1_ip), wp)
         if (known) name = to_text(nint(value, ip))
      end if
      name = keyword//' '//name
      context%open%source = find_name(context%source_names, name)
      if (context%open%source > 0) return
      call add_name(context%source_names, name)
      context%open%source = context%source_names%n
   end subroutine open_source

   !> The model has them all.
   pure subroutine keep_sources(context)
      type(build_context_t), intent(inout) :: context !< its model gets sources
      type(string_t), allocatable :: names(:)
      integer :: i, blank

      names = names_of(context%source_names)
      allocate (context%model%sources(size(names)))
      do i = 1, size(names)
         blank = index(names(i)%s, ' ')
         context%model%sources(i)%keyword = names(i)%s(:blank - 1)
         context%model%sources(i)%name = names(i)%s(blank + 1:)
      end do
   end subroutine keep_sources

end module atrito_sources
