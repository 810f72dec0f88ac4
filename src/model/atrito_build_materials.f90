!> *MATERIAL with *ELASTIC, *DENSITY and *EXPANSION, and *SOLID SECTION.
module atrito_build_materials
   use atrito_deck, only: deck_t, card_t, token_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t, place_text, keep_token, define_name, count_cards, ids_text, has_errors
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
   public :: build_materials, SECTION_INVALID

   !> In model%section_of while the model is built: the element has a section, which is faulty.
   integer(ip), parameter :: SECTION_INVALID = -1

contains

   !> All materials and sections of a model.
   subroutine build_materials(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i, current, n_sections
      logical :: is_open                               ! nothing but what belongs to it since the last *MATERIAL

      i = count_cards(context%deck, 'MATERIAL')
      allocate (context%model%materials(i), context%model%sections(count_cards(context%deck, 'SOLID SECTION')))
      allocate (context%elastic_given(i), context%elastic_invalid(i), source=.false.)
      allocate (context%model%section_of(context%model%mesh%n_elements), source=0_ip)
      current = 0
      is_open = .false.
      do i = 1, context%deck%n_cards
         select case (keyword_name(context%deck%cards(i)))
         case ('MATERIAL')
            call read_material_card(context%deck%cards(i), context, current)
            is_open = current > 0
         case ('ELASTIC')
            if (current > 0) call read_elastic_card(context%deck%cards(i), context%model%materials(current), context, current)
         case ('DENSITY')
            if (current > 0) call read_density_card(context%deck, context%deck%cards(i), context%model%materials(current))
         case ('EXPANSION')
            if (current > 0) call read_expansion_card(context%deck, context%deck%cards(i), context%model%materials(current))
         case ('')
            ! a misspelt *ELASTIC: the material is not blamed for missing it
            if (is_open .and. has_errors()) context%elastic_invalid(current) = .true.
         case default
            is_open = .false.
         end select
      end do
      context%model%materials = context%model%materials(:context%material_names%n)
      n_sections = 0
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'SOLID SECTION') then
            call read_section_card(context%deck%cards(i), context, n_sections)
         end if
      end do
      context%model%sections = context%model%sections(:n_sections)
   end subroutine build_materials

   subroutine read_material_card(card, context, current)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(out) :: current              !< the material that has begun; 0: none
      character(len=:), allocatable :: name

      call define_name(context%deck, card, 'material', context%material_names, context%materials, name, current)
      if (current == 0) return
      context%model%materials(current) = material_t(name=name)
      context%elastic_invalid(current) = .not. card%ok
      call keep_token(context%poisson, current, context%materials(current))
   end subroutine read_material_card

   subroutine read_elastic_card(card, material, context, i)
      type(card_t), intent(in) :: card
      type(material_t), intent(inout) :: material
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: i                     !< place of the material
      character(len=*), parameter :: WHAT_E = "Young's modulus E, a real > 0 [F/L^2]"
      character(len=*), parameter :: WHAT_MU = "Poisson's ratio mu, plane strain -1 < mu < 0.5, plane stress -1 < mu <= 0.5 [-]"
      logical :: ok(2)

      if (context%elastic_given(i)) then
         if (card%ok) call report_error(context%deck, card%place, 'E-TWICE', 'material '//material%name//' has two *ELASTIC', &
                                        expected='one *ELASTIC a material', keyword='ELASTIC')
         return
      end if
      context%elastic_given(i) = .true.
      context%elastic_invalid(i) = .true.
      if (card%n_lines == 0) return
      associate (line => context%deck%lines(card%first_line))
         if (.not. line%ok) return
         call get_real(context%deck, line_item(context%deck, line, 1_ip), WHAT_E, material%young, ok(1), keyword='ELASTIC')
         call get_real(context%deck, line_item(context%deck, line, 2_ip), WHAT_MU, material%poisson, ok(2), keyword='ELASTIC')
         if (ok(1) .and. material%young <= 0.0_wp) then
            ok(1) = .false.
            call report_error(context%deck, line_item(context%deck, line, 1_ip), 'E-VALUE', 'E = '//to_text(material%young)// &
                              ' is not positive', expected=WHAT_E, keyword='ELASTIC')
         end if
         if (ok(2) .and. (material%poisson <= -1.0_wp .or. material%poisson > 0.5_wp)) then
            ok(2) = .false.
            call report_error(context%deck, line_item(context%deck, line, 2_ip), 'E-VALUE', 'mu = '//to_text(material%poisson, &
                                                                                                             15)// &
                              ' is out of range', expected=WHAT_MU, keyword='ELASTIC')
         end if
         context%poisson(i) = line_item(context%deck, line, 2_ip)
      end associate
      context%elastic_invalid(i) = .not. all(ok)
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

   subroutine read_expansion_card(deck, card, material)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(material_t), intent(inout) :: material
      character(len=*), parameter :: WHAT = 'coefficient of expansion alpha, a real [1/temperature]'
      logical :: ok

      if (material%has_expansion .and. card%ok) call report_error(deck, card%place, 'E-TWICE', 'material '//material%name// &
                                                   ' has two *EXPANSION', expected='one *EXPANSION a material', keyword='EXPANSION')
      material%has_expansion = .true.
      if (card%n_lines == 0) return
      associate (line => deck%lines(card%first_line))
         if (line%ok) call get_real(deck, line_item(deck, line, 1_ip), WHAT, material%expansion, ok, keyword='EXPANSION')
      end associate
   end subroutine read_expansion_card

   !> *SOLID SECTION.
   subroutine read_section_card(card, context, n_sections)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(inout) :: n_sections         !< that there are
      type(section_t) :: section
      type(token_t) :: place
      character(len=:), allocatable :: material
      integer(ip) :: i_set, number
      logical :: named, ok

      call option_text(context%deck, card, 'ELSET', section%elset, named, place)
      i_set = find_set(context%model%element_sets, section%elset)
      if (named .and. i_set == 0) call report_unknown(context, place, 'element set', 'E-SET', context%model%element_sets%names, &
                                                      'SOLID SECTION')
      ok = i_set > 0 .and. card%ok
      if (option_word(context%deck, card, 'FORMULATION') == 'BBAR') section%formulation = FORMULATION_BBAR
      call read_thickness(context%deck, card, section%thickness, ok)
      if (i_set == 0) context%sections_undetermined = .true.

      call option_text(context%deck, card, 'MATERIAL', material, named, place)
      section%material = find_name(context%material_names, material)
      if (named .and. section%material == 0) call report_unknown(context, place, 'material', 'E-MATERIAL', context%material_names, &
                                                                 'SOLID SECTION')
      ok = ok .and. section%material > 0
      number = SECTION_INVALID
      if (ok) then
         n_sections = n_sections + 1
         context%model%sections(n_sections) = section
         call keep_token(context%sections, n_sections, card%place)
         number = n_sections
      end if
      if (i_set > 0) call assign_section(card, context, context%model%element_sets%sets(i_set)%members, number)
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
   subroutine assign_section(card, context, elements, number)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: elements(:), number
      type(number_list_t) :: twice
      type(token_t) :: place, earlier
      character(len=:), allocatable :: elset
      integer(ip) :: i, first
      logical :: found

      first = 0
      do i = 1, size(elements, kind=ip)
         if (context%model%section_of(elements(i)) /= 0) then
            call add_number(twice, context%model%mesh%element_id(elements(i)))
            first = max(first, context%model%section_of(elements(i)))
         end if
         context%model%section_of(elements(i)) = number
      end do
      if (twice%n == 0) return
      call option_text(context%deck, card, 'ELSET', elset, found, place)
      earlier = card%place
      if (first > 0) earlier = context%sections(first)
      call report_error(context%deck, place, 'E-SECTION', 'element '//ids_text(numbers_of(twice))//' of set '//elset// &
                        ' has a section already, from '//place_text(context%deck, earlier, place), &
                        expected='one *SOLID SECTION for each element', keyword='SOLID SECTION')
   end subroutine assign_section

end module atrito_build_materials
