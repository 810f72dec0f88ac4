!> Finds a contact pair of the deck by the names of its surfaces.
module atrito_pair_names
   use atrito_build_context, only: build_context_t
   use atrito_deck, only: keyword_name, token_t
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip
   use atrito_name_list, only: find_name
   use atrito_references, only: report_unknown
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: find_pair

contains

   !> The pair of a slave and a master. What is wrong is told of the place of the name.
   subroutine find_pair(context, names, places, turned, keyword, pair)
      type(build_context_t), intent(in) :: context
      type(string_t), intent(in) :: names(2)           !< slave and master, as the deck has them
      type(token_t), intent(in) :: places(2)
      character(len=*), intent(in) :: turned           !< how it should read if the surfaces are the other way round
      character(len=*), intent(in) :: keyword
      integer(ip), intent(out) :: pair                 !< place in model%pairs; 0: none
      integer(ip) :: surface(2), i

      pair = 0
      do i = 1, 2
         surface(i) = find_name(context%surface_names, names(i)%s)
         if (surface(i) == 0) call report_unknown(context, places(i), 'surface', 'E-SURFACE', context%surface_names, keyword)
      end do
      if (any(surface == 0)) return
      associate (pairs => context%model%pairs)
         do i = 1, size(pairs, kind=ip)
            if (pairs(i)%slave == surface(1) .and. pairs(i)%master == surface(2)) pair = i
         end do
         if (pair > 0 .or. .not. has_all_pairs(context)) return
         if (any(pairs%slave == surface(2) .and. pairs%master == surface(1))) then
            call report_error(context%deck, places(1), 'E-PAIR', names(1)%s//' is the master of this pair, '//names(2)%s// &
                              ' the slave', expected=turned, keyword=keyword)
         else
            call report_error(context%deck, places(1), 'E-PAIR', 'no *CONTACT PAIR has the slave '//names(1)%s// &
                              ' and the master '//names(2)%s, expected='the surfaces of one *CONTACT PAIR', keyword=keyword)
         end if
      end associate
   end subroutine find_pair

   !> Each line of *CONTACT PAIR has made a pair; where one has not, an error has been told.
   pure logical function has_all_pairs(context)
      type(build_context_t), intent(in) :: context
      integer(ip) :: i, n

      n = 0
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'CONTACT PAIR') n = n + context%deck%cards(i)%n_lines
      end do
      has_all_pairs = size(context%model%pairs) == n
   end function has_all_pairs

end module atrito_pair_names
