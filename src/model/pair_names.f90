!> Finds a contact pair of the deck by the names of its surfaces.
module atrito_pair_names
   use atrito_build_context, only: build_context_t
   use atrito_deck, only: count_lines, token_t
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip, lp
   use atrito_name_list, only: find_name
   use atrito_references, only: report_unknown
   use atrito_sorting, only: first_at_least, sorted_places
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: pair_index_t, index_pairs, find_pair

   !> The pairs of the model, sorted by their surfaces: a deck may name each of thousands.
   type :: pair_index_t
      private
      integer(lp), allocatable :: key(:)               !< rising
      integer(ip), allocatable :: pair(:)              !< in the order of their keys
      logical :: is_complete = .false.                 !< each line of *CONTACT PAIR has made one
   end type pair_index_t

contains

   !> Sorts the contact pairs by their surfaces, so that find_pair finds them by name.
   subroutine index_pairs(context, pairs)
      type(build_context_t), intent(in) :: context     !< the pairs of its model are indexed
      type(pair_index_t), intent(out) :: pairs         !< sorted by the two surfaces
      integer(ip) :: i

      associate (all_pairs => context%model%pairs)
         pairs%key = [(key_of(context, [all_pairs(i)%slave, all_pairs(i)%master]), i=1, size(all_pairs, kind=ip))]
      end associate
      pairs%pair = sorted_places(pairs%key)
      pairs%key = pairs%key(pairs%pair)
      ! Each line of *CONTACT PAIR has made a pair; where one has not, an error has been reported.
      pairs%is_complete = size(context%model%pairs) == count_lines(context%deck, 'CONTACT PAIR')
   end subroutine index_pairs

   pure integer(lp) function key_of(context, surfaces) result(key)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: surfaces(2)           !< slave and master

      key = int(surfaces(1), lp)*(size(context%model%surfaces, kind=lp) + 1) + surfaces(2)
   end function key_of

   !> The pair of two surfaces, of several the last; 0: there is none.
   pure integer(ip) function pair_of(context, pairs, surfaces) result(pair)
      type(build_context_t), intent(in) :: context
      type(pair_index_t), intent(in) :: pairs
      integer(ip), intent(in) :: surfaces(2)           !< slave and master
      integer(ip) :: i

      pair = 0
      i = first_at_least(pairs%key, key_of(context, surfaces) + 1) - 1
      if (i == 0) return
      if (pairs%key(i) == key_of(context, surfaces)) pair = pairs%pair(i)
   end function pair_of

   !> The pair of a slave and a master. What is wrong is reported at the place of the name.
   subroutine find_pair(context, pairs, names, places, turned, keyword, pair)
      type(build_context_t), intent(in) :: context     !< names of its surfaces are read
      type(pair_index_t), intent(in) :: pairs          !< of index_pairs
      type(string_t), intent(in) :: names(2)           !< slave and master, as the deck has them
      type(token_t), intent(in) :: places(2)           !< of the two names
      character(len=*), intent(in) :: turned           !< how it should read if the surfaces are the other way round
      character(len=*), intent(in) :: keyword          !< of the card, for `atrito help KEYWORD`
      integer(ip), intent(out) :: pair                 !< place in model%pairs; 0: none
      integer(ip) :: surface(2), i

      pair = 0
      do i = 1, 2
         surface(i) = find_name(context%surface_names, names(i)%s)
         if (surface(i) == 0) call report_unknown(context, places(i), 'surface', 'E-SURFACE', context%surface_names, keyword)
      end do
      if (any(surface == 0)) return
      pair = pair_of(context, pairs, surface)
      if (pair > 0 .or. .not. pairs%is_complete) return
      if (pair_of(context, pairs, surface(2:1:-1)) > 0) then
         call report_error(context%deck, places(1), 'E-PAIR', names(1)%s//' is the master of this pair, '//names(2)%s// &
                           ' the slave', expected=turned, keyword=keyword)
      else
         call report_error(context%deck, places(1), 'E-PAIR', 'no *CONTACT PAIR has the slave '//names(1)%s// &
                           ' and the master '//names(2)%s, expected='the surfaces of one *CONTACT PAIR', keyword=keyword)
      end if
   end subroutine find_pair

end module atrito_pair_names
