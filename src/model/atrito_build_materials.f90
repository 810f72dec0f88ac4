!> *MATERIAL with *ELASTIC and *DENSITY, and *SOLID SECTION.
module atrito_build_materials
   use atrito_deck, only: deck_t, card_t, token_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_draft, only: draft_t, place_text, keep_token, define_name, count_cards, ids_text, has_errors
   use atrito_items, only: get_real, option_text, option_word
   use atrito_kinds, only: ip, wp
   use atrito_model, only: material_t, section_t, FORMULATION_BBAR
   use atrito_name_list, only: find_name
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_references, only: report_unknown
   use atrito_sets, only: find_set
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_materials, SECTION_SPOILED

   !> In model%section_of while the model is built: the element has a section, which is faulty.
   integer(ip), parameter :: SECTION_SPOILED = -1

contains

   !> All materials and sections of a model.
   subroutine build_materials(draft)
      type(draft_t), intent(inout) :: draft
      integer(ip) :: i, current, n_sections
      logical :: is_open                               ! nothing but *ELASTIC and *DENSITY since the last *MATERIAL

      i = count_cards(draft%deck, 'MATERIAL')
      allocate (draft%model%materials(i), draft%model%sections(count_cards(draft%deck, 'SOLID SECTION')))
      allocate (draft%elastic_given(i), draft%elastic_spoiled(i), source=.false.)
      allocate (draft%model%section_of(draft%model%mesh%n_elements), source=0_ip)
      current = 0
      is_open = .false.
      do i = 1, draft%deck%n_cards
         select case (keyword_name(draft%deck%cards(i)))
         case ('MATERIAL')
            call read_material_card(draft%deck%cards(i), draft, current)
            is_open = current > 0
         case ('ELASTIC')
            if (current > 0) call read_elastic_card(draft%deck%cards(i), draft%model%materials(current), draft, current)
         case ('DENSITY')
            if (current > 0) call read_density_card(draft%deck, draft%deck%cards(i), draft%model%materials(current))
         case ('')
            ! a misspelt *ELASTIC: the material is not blamed for missing it
            if (is_open .and. has_errors()) draft%elastic_spoiled(current) = .true.
         case default
            is_open = .false.
         end select
      end do
      draft%model%materials = draft%model%materials(:draft%material_names%n)
      n_sections = 0
      do i = 1, draft%deck%n_cards
         if (keyword_name(draft%deck%cards(i)) == 'SOLID SECTION') then
            call read_section_card(draft%deck%cards(i), draft, n_sections)
         end if
      end do
      draft%model%sections = draft%model%sections(:n_sections)
   end subroutine build_materials

   subroutine read_material_card(card, draft, current)
      type(card_t), intent(in) :: card
      type(draft_t), intent(inout) :: draft
      integer(ip), intent(out) :: current              !< the material that has begun; 0: none
      character(len=:), allocatable :: name

      call define_name(draft%deck, card, 'material', draft%material_names, draft%materials, name, current)
      if (current == 0) return
      draft%model%materials(current) = material_t(name=name)
      draft%elastic_spoiled(current) = .not. card%ok
      call keep_token(draft%poisson, current, draft%materials(current))
   end subroutine read_material_card

   subroutine read_elastic_card(card, material, draft, i)
      type(card_t), intent(in) :: card
      type(material_t), intent(inout) :: material
      type(draft_t), intent(inout) :: draft
      integer(ip), intent(in) :: i                     !< place of the material
      character(len=*), parameter :: WHAT_E = "Young's modulus E, a real > 0 [F/L^2]"
      character(len=*), parameter :: WHAT_MU = "Poisson's ratio mu, plane strain -1 < mu < 0.5, plane stress -1 < mu <= 0.5 [-]"
      logical :: ok(2)

      if (draft%elastic_given(i)) then
         if (card%ok) call report_error(draft%deck, card%place, 'E-TWICE', 'material '//material%name//' has two *ELASTIC', &
                                        expected='one *ELASTIC a material', keyword='ELASTIC')
         return
      end if
      draft%elastic_given(i) = .true.
      draft%elastic_spoiled(i) = .true.
      if (card%n_lines == 0) return
      associate (line => draft%deck%lines(card%first_line))
         if (.not. line%ok) return
         call get_real(draft%deck, line_item(draft%deck, line, 1_ip), WHAT_E, material%young, ok(1), keyword='ELASTIC')
         call get_real(draft%deck, line_item(draft%deck, line, 2_ip), WHAT_MU, material%poisson, ok(2), keyword='ELASTIC')
         if (ok(1) .and. material%young <= 0.0_wp) then
            ok(1) = .false.
            call report_error(draft%deck, line_item(draft%deck, line, 1_ip), 'E-VALUE', 'E = '//to_text(material%young)// &
                              ' is not positive', expected=WHAT_E, keyword='ELASTIC')
         end if
         if (ok(2) .and. (material%poisson <= -1.0_wp .or. material%poisson > 0.5_wp)) then
            ok(2) = .false.
            call report_error(draft%deck, line_item(draft%deck, line, 2_ip), 'E-VALUE', 'mu = '//to_text(material%poisson, 15)// &
                              ' is out of range', expected=WHAT_MU, keyword='ELASTIC')
         end if
         draft%poisson(i) = line_item(draft%deck, line, 2_ip)
      end associate
      draft%elastic_spoiled(i) = .not. all(ok)
   end subroutine read_elastic_card

   subroutine read_density_card(deck, card, material)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(material_t), intent(inout) :: material
      character(len=*), parameter :: WHAT = 'mass per volume, a real >= 0 [F T^2/L^4]'
      logical :: ok

      if (card%n_lines == 0) return
      associate (line => deck%lines(card%first_line))
         if (.not. line%ok) return
         call get_real(deck, line_item(deck, line, 1_ip), WHAT, material%density, ok, keyword='DENSITY')
         if (ok .and. material%density < 0.0_wp) call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', &
                                        'the density '//to_text(material%density)//' is negative', expected=WHAT, keyword='DENSITY')
      end associate
   end subroutine read_density_card

   !> *SOLID SECTION.
   subroutine read_section_card(card, draft, n_sections)
      type(card_t), intent(in) :: card
      type(draft_t), intent(inout) :: draft
      integer(ip), intent(inout) :: n_sections         !< that there are
      type(section_t) :: section
      type(token_t) :: place
      character(len=:), allocatable :: material
      integer(ip) :: i_set, number
      logical :: named, ok

      call option_text(draft%deck, card, 'ELSET', section%elset, named, place)
      i_set = find_set(draft%model%element_sets, section%elset)
      if (named .and. i_set == 0) call report_unknown(draft, place, 'element set', 'E-SET', draft%model%element_sets%names, &
                                                      'SOLID SECTION')
      ok = i_set > 0 .and. card%ok
      if (option_word(draft%deck, card, 'FORMULATION') == 'BBAR') section%formulation = FORMULATION_BBAR
      call read_thickness(draft%deck, card, section%thickness, ok)
      if (i_set == 0) draft%sections_unsure = .true.

      call option_text(draft%deck, card, 'MATERIAL', material, named, place)
      section%material = find_name(draft%material_names, material)
      if (named .and. section%material == 0) call report_unknown(draft, place, 'material', 'E-MATERIAL', draft%material_names, &
                                                                 'SOLID SECTION')
      ok = ok .and. section%material > 0
      number = SECTION_SPOILED
      if (ok) then
         n_sections = n_sections + 1
         draft%model%sections(n_sections) = section
         call keep_token(draft%sections, n_sections, card%place)
         number = n_sections
      end if
      if (i_set > 0) call assign_section(card, draft, draft%model%element_sets%sets(i_set)%members, number)
   end subroutine read_section_card

   subroutine read_thickness(deck, card, thickness, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      real(wp), intent(inout) :: thickness
      logical, intent(inout) :: ok
      character(len=*), parameter :: WHAT = 'thickness, a real > 0 [L]'
      logical :: good

      if (card%n_lines == 0) return
      associate (line => deck%lines(card%first_line))
         good = line%ok
         if (good) call get_real(deck, line_item(deck, line, 1_ip), WHAT, thickness, good, 1.0_wp, 'SOLID SECTION')
         if (good .and. thickness <= 0.0_wp) then
            good = .false.
            call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', 'the thickness '//to_text(thickness)// &
                              ' is not positive', expected=WHAT, keyword='SOLID SECTION')
         end if
         ok = ok .and. good
      end associate
   end subroutine read_thickness

   !> Gives elements their section; those that have one already are an error, told in one message.
   subroutine assign_section(card, draft, elements, number)
      type(card_t), intent(in) :: card
      type(draft_t), intent(in) :: draft
      integer(ip), intent(in) :: elements(:), number
      type(number_list_t) :: twice
      type(token_t) :: place, earlier
      character(len=:), allocatable :: elset
      integer(ip) :: i, first
      logical :: found

      first = 0
      do i = 1, size(elements, kind=ip)
         if (draft%model%section_of(elements(i)) /= 0) then
            call add_number(twice, draft%model%mesh%element_id(elements(i)))
            first = max(first, draft%model%section_of(elements(i)))
         end if
         draft%model%section_of(elements(i)) = number
      end do
      if (twice%n == 0) return
      call option_text(draft%deck, card, 'ELSET', elset, found, place)
      earlier = card%place
      if (first > 0) earlier = draft%sections(first)
      call report_error(draft%deck, place, 'E-SECTION', 'element '//ids_text(numbers_of(twice))//' of set '//elset// &
                        ' has a section already, from '//place_text(draft%deck, earlier, place), &
                        expected='one *SOLID SECTION for each element', keyword='SOLID SECTION')
   end subroutine assign_section

end module atrito_build_materials
