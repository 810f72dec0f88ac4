!> *MATERIAL with *ELASTIC, *DENSITY and *EXPANSION, *ORIENTATION, and *SOLID SECTION.
!>
!> *ELASTIC: E and mu, engineering constants or stiffnesses of an orthotropic material.
module atrito_build_materials
   use atrito_build_context, only: build_context_t, place_text, keep_token, define_name, count_cards, ids_text, has_errors
   use atrito_coordinates, only: get_positive, turned
   use atrito_deck, only: deck_t, card_t, token_t, line_item, keyword_name, is_empty_token, data_line_t, token_text
   use atrito_diagnostics, only: report_error, report_note
   use atrito_items, only: check_comma, get_real, has_option, option_text, option_word, get_integer
   use atrito_kinds, only: ip, wp, PI
   use atrito_model, only: material_t, section_t, FORMULATION_BBAR
   use atrito_name_list, only: find_name
   use atrito_node_fields, only: taper_elements
   use atrito_orthotropy, only: SPATIAL, compliance_of_constants, inverse_of, is_positive_definite
   use atrito_references, only: report_unknown
   use atrito_sets, only: find_set, members_of
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_materials

   !> In model%section_of while the model is built: the element has a section, which is faulty.
   integer(ip), parameter :: SECTION_INVALID = -1

   character(len=*), parameter :: ORIENTATION = 'ORIENTATION'

   character(len=*), parameter :: WHAT_E = "Young's modulus E, a real > 0 [F/L^2]", &
                                  WHAT_MU = "Poisson's ratio mu, plane strain -1 < mu < 0.5, plane stress -1 < mu <= 0.5 [-]"

   integer(ip), parameter :: N_CONSTANTS = 9           !< of an orthotropic material, the last one on the second line
   integer(ip), parameter :: N_FIRST = 8

contains

   !> All materials and sections of a model.
   subroutine build_materials(context)
      type(build_context_t), intent(inout) :: context  !< its model gets materials, sections, section_of
      character(len=:), allocatable :: name
      integer(ip) :: i, current, place, n_sections
      integer(ip) :: dense                             ! the last material with *DENSITY
      logical :: is_open                               ! nothing but what belongs to it since the last *MATERIAL

      i = count_cards(context%deck, 'MATERIAL')
      allocate (context%model%materials(i), context%model%sections(count_cards(context%deck, 'SOLID SECTION')))
      allocate (context%elastic_given(i), context%elastic_invalid(i), source=.false.)
      allocate (context%model%section_of(context%model%mesh%n_elements), source=0_ip)
      current = 0
      dense = 0
      is_open = .false.
      do i = 1, context%deck%n_cards
         select case (keyword_name(context%deck%cards(i)))
         case ('MATERIAL')
            call define_name(context%deck, context%deck%cards(i), 'material', context%material_names, context%materials, name, &
                             current)
            is_open = current > 0
            if (.not. is_open) cycle
            context%model%materials(current)%name = name
            context%elastic_invalid(current) = .not. context%deck%cards(i)%ok
            call keep_token(context%poisson, current, context%materials(current))
         case ('ELASTIC')
            if (current > 0) call read_elastic_card(context%deck%cards(i), context%model%materials(current), context, current)
         case ('DENSITY')
            if (current == 0) cycle
            associate (deck => context%deck, material => context%model%materials(current))
               if (current == dense .and. deck%cards(i)%ok) call report_error(deck, deck%cards(i)%place, 'E-TWICE', 'material '// &
                                                                              material%name//' has two *DENSITY', &
                                                                              expected='one *DENSITY a material')
               dense = current
               call read_density_card(deck, deck%cards(i), material)
            end associate
         case ('EXPANSION')
            if (current > 0) call read_expansion_card(context%deck, context%deck%cards(i), context%model%materials(current))
         case ('')
            ! a misspelt *ELASTIC: the material is not blamed for missing it
            if (is_open .and. has_errors() .and. .not. context%deck%cards(i)%is_ignored) context%elastic_invalid(current) = .true.
         case default
            is_open = .false.
         end select
      end do
      context%model%materials = context%model%materials(:context%material_names%n)
      allocate (context%orientation_axis(2, count_cards(context%deck, ORIENTATION)), source=0.0_wp)
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= ORIENTATION) cycle
         call define_name(context%deck, context%deck%cards(i), 'orientation', context%orientation_names, context%orientations, &
                          name, place)
         if (place > 0) call read_axis(context%deck%cards(i), context%deck, context%orientation_axis(:, place))
      end do
      n_sections = 0
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'SOLID SECTION') then
            call read_section_card(context%deck%cards(i), context, n_sections)
         end if
      end do
      context%model%sections = context%model%sections(:n_sections)
      call taper_elements(context)
   end subroutine build_materials

   !> *DENSITY: the mass per volume, which does not depend on the temperature.
   subroutine read_density_card(deck, card, material)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(material_t), intent(inout) :: material
      character(len=*), parameter :: WHAT = 'mass per volume, a real >= 0 [F T^2/L^4]'
      logical :: ok

      if (card%n_lines == 0) return
      associate (line => deck%lines(card%first_line))
         if (.not. line%ok) return
         call get_real(deck, line_item(deck, line, 1_ip), WHAT, material%density, ok)
         if (ok .and. material%density < 0.0_wp) call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', 'the density '// &
                                                                   to_text(material%density)//' is negative', expected=WHAT)
         if (ok .and. .not. is_empty_token(line_item(deck, line, 2_ip))) then
            ok = check_comma(deck, line, 1_ip, 'mass per volume [F T^2/L^4]; a temperature behind it as 20.')
         end if
      end associate
      if (ok) call check_constant(deck, card, [material%density], 'densities', ok)
   end subroutine read_density_card

   !> *EXPANSION: the coefficient alpha of the thermal strain alpha T, which does not depend on the temperature.
   subroutine read_expansion_card(deck, card, material)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(material_t), intent(inout) :: material
      character(len=*), parameter :: WHAT = 'coefficient of expansion alpha, a real [1/temperature]'
      logical :: ok

      if (material%has_expansion .and. card%ok) call report_error(deck, card%place, 'E-TWICE', 'material '//material%name// &
                                                                  ' has two *EXPANSION', expected='one *EXPANSION a material')
      material%has_expansion = .true.
      if (card%n_lines == 0) return
      if (.not. deck%lines(card%first_line)%ok) return
      call get_real(deck, line_item(deck, deck%lines(card%first_line), 1_ip), WHAT, material%expansion, ok)
      if (ok) ok = check_comma(deck, deck%lines(card%first_line), 1_ip, 'alpha [1/temperature]; a temperature behind it as 20.')
      if (ok) call check_constant(deck, card, [material%expansion], 'coefficients of expansion', ok)
   end subroutine read_expansion_card

   !> *SOLID SECTION.
   subroutine read_section_card(card, context, n_sections)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(inout) :: n_sections         !< that there are
      type(section_t) :: section
      type(token_t) :: place, elset
      character(len=:), allocatable :: material
      integer(ip) :: i_set, number
      logical :: named, ok

      associate (deck => context%deck, sets => context%model%element_sets)
         call option_text(deck, card, 'ELSET', section%elset, named, elset)
         i_set = find_set(sets, section%elset)
         if (named .and. i_set == 0) call report_unknown(context, elset, 'element set', 'E-SET', sets%names)
         ok = i_set > 0 .and. card%ok
         if (i_set == 0) context%sections_undetermined = .true.
         if (option_word(deck, card, 'FORMULATION') == 'BBAR') section%formulation = FORMULATION_BBAR
         call read_thickness(deck, card, section, ok)
         call option_text(deck, card, 'MATERIAL', material, named, place)
         section%material = find_name(context%material_names, material)
         if (named .and. section%material == 0) call report_unknown(context, place, 'material', 'E-MATERIAL', &
                                                                    context%material_names)
         ok = ok .and. section%material > 0
         call take_orientation()
         number = SECTION_INVALID
         if (ok) then
            n_sections = n_sections + 1
            context%model%sections(n_sections) = section
            call keep_token(context%sections, n_sections, card%place)
            number = n_sections
         end if
         if (i_set > 0) call assign_section(card%place, elset, section%elset, context, members_of(sets%sets(i_set)), number)
      end associate

   contains

      !> The axes of the material, where it has any.
      subroutine take_orientation()
         character(len=:), allocatable :: name, what
         type(token_t) :: place
         integer(ip) :: i
         logical :: named

         if (has_option(context%deck, card, 'ORIENTATION')) then
            call option_text(context%deck, card, 'ORIENTATION', name, named, place)
            if (.not. named) return
            i = find_name(context%orientation_names, name)
            if (i == 0) call report_unknown(context, place, 'orientation', 'E-ORIENTATION', context%orientation_names)
            if (i > 0) section%axis = context%orientation_axis(:, i)
            ok = ok .and. i > 0 .and. any(abs(section%axis) > 0.0_wp)
            ! Other programs print stresses along the axes of the material.
            if (ok) then
               what = ' turns nothing that is isotropic, and stresses are along x and y'
               if (context%model%materials(section%material)%is_orthotropic) then
                  what = ' turns the material; stresses are along x and y'
               end if
               call report_note(context%deck, place, 'N-ORIENTATION', 'the orientation '//name//what, keyword='ORIENTATION')
            end if
         end if
         if (.not. ok) return
         if (.not. context%model%materials(section%material)%is_orthotropic) return
         ! the axes of a part turn with its instance, also those that no *ORIENTATION gives
         if (card%scope > 0) section%axis = turned(context%motions(card%scope), section%axis)
         if (section%formulation /= FORMULATION_BBAR) return
         ok = .false.
         call report_error(context%deck, card%place, 'E-FORMULATION', 'FORMULATION=BBAR is for isotropic materials', &
                           expected='FORMULATION=STANDARD for an orthotropic material')
      end subroutine take_orientation
   end subroutine read_section_card

   !> The thickness in a data line. Where the nodes have it, a line with another has no effect.
   subroutine read_thickness(deck, card, section, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(section_t), intent(inout) :: section
      logical, intent(inout) :: ok                     !< the section has been understood so far
      logical :: good

      if (card%n_lines > 0) then
         associate (line => deck%lines(card%first_line))
            good = line%ok
            if (good .and. .not. is_empty_token(line_item(deck, line, 1_ip))) then
               call get_positive(deck, line_item(deck, line, 1_ip), 'thickness, a real > 0 [L]', 'the thickness ', &
                                 section%thickness, good)
            end if
            ok = ok .and. good
         end associate
      end if
      section%is_tapered = has_option(deck, card, 'NODAL THICKNESS')
      if (.not. section%is_tapered) return
      if (abs(section%thickness - 1) > 0.0_wp) call report_note(deck, card%place, 'N-THICKNESS', 'the thickness '// &
                                                                to_text(section%thickness)//' of the section has no effect: '// &
                                                                'that of the nodes counts')
      section%thickness = 1.0_wp
   end subroutine read_thickness

   !> Gives elements their section; those that have one already are an error, reported in one message.
   subroutine assign_section(card, place, elset, context, elements, number)
      type(token_t), intent(in) :: card, place         !< of the section, and of its set
      character(len=*), intent(in) :: elset
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: elements(:), number
      integer(ip), allocatable :: twice(:)
      type(token_t) :: earlier

      twice = pack(elements, context%model%section_of(elements) /= 0)
      if (size(twice) > 0) then
         earlier = card
         associate (first => maxval(context%model%section_of(twice)))
            if (first > 0) earlier = context%sections(first)
         end associate
         call report_error(context%deck, place, 'E-SECTION', 'element '//ids_text(context%model%mesh%element_id(twice))// &
                           ' of set '//elset//' has a section already, from '//place_text(context%deck, earlier, place), &
                           expected='one *SOLID SECTION for each element')
      end if
      context%model%section_of(elements) = number
   end subroutine assign_section

   !> The direction of the first axis, from two points in the plane that span it, and a rotation about one of the axes, the third
   !> one here; 0: it is faulty.
   subroutine read_axis(card, deck, axis)
      type(card_t), intent(in) :: card
      type(deck_t), intent(in) :: deck
      real(wp), intent(out) :: axis(2)
      real(wp), parameter :: FLAT = 1.0e-10_wp         ! what rounding leaves of 0
      type(data_line_t) :: line
      real(wp) :: x(3, 2), turn
      integer(ip) :: i, k, about
      logical :: good(3, 2)

      axis = 0.0_wp
      if (card%n_lines == 0 .or. .not. card%ok) return
      if (.not. all(deck%lines(card%first_line:card%first_line + card%n_lines - 1)%ok)) return
      line = deck%lines(card%first_line)
      do k = 1, 2
         do i = 1, 3
            call get_real(deck, line_item(deck, line, 3*k - 3 + i), 'coordinate, a real [L]', x(i, k), good(i, k))
         end do
      end do
      if (.not. all(good)) return
      do k = 1, 2
         if (abs(x(3, k)) <= FLAT*maxval(abs(x(:2, k)))) x(3, k) = 0.0_wp
         if (abs(x(3, k)) > 0.0_wp) then
            call report_error(deck, line_item(deck, line, 3*k), 'E-VALUE', 'the scene is plane: these axes leave it', &
                              expected='za = zb = 0')
            return
         end if
         if (maxval(abs(x(:, k))) > 0.0_wp) x(:, k) = x(:, k)/maxval(abs(x(:, k)))
      end do
      associate (a => x(:, 1), b => x(:, 2))
         if (abs(a(1)*b(2) - a(2)*b(1)) <= 1.0e-12_wp*norm2(a)*norm2(b)) then
            call report_error(deck, line_item(deck, line, 4_ip), 'E-VALUE', 'the points give no two axes', &
                              expected='points a and b in two directions from the origin')
            return
         end if
         turn = 0.0_wp
         if (card%n_lines > 1) then
            line = deck%lines(card%first_line + 1)
            call get_integer(deck, line_item(deck, line, 1_ip), 'local axis, 1, 2 or 3', about, good(1, 1))
            call get_real(deck, line_item(deck, line, 2_ip), 'angle, a real in degrees', turn, good(2, 1), 0.0_wp)
            if (.not. all(good)) return
            if (about /= 3 .and. abs(turn) > 0.0_wp) then
               call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', 'the scene is plane: this rotation leaves it', &
                                 expected='3, the axis across the plane')
               return
            end if
         end if
         a = a/norm2(a)
         turn = sign(turn, turn*(a(1)*b(2) - a(2)*b(1)))   ! round the third axis, which points to the viewer or away
         axis = [cosine(turn)*a(1) - cosine(90 - turn)*a(2), cosine(90 - turn)*a(1) + cosine(turn)*a(2)]
      end associate
   end subroutine read_axis

   !> Of an angle in degrees, exact at multiples of 90.
   pure real(wp) function cosine(angle)
      real(wp), intent(in) :: angle

      cosine = cos(angle*(PI/180))
      if (.not. abs(modulo(angle, 90.0_wp)) > 0.0_wp) cosine = anint(cosine)
   end function cosine

   !> Takes an *ELASTIC card for a material, isotropic or orthotropic. A material whose card is faulty is noted as such, so that
   !> nothing more is said of it.
   subroutine read_elastic_card(card, material, context, i)
      type(card_t), intent(in) :: card                 !< *ELASTIC, its lines may be faulty
      type(material_t), intent(inout) :: material      !< gets young and poisson, or stiffness
      type(build_context_t), intent(inout) :: context  !< elastic_given, elastic_invalid and poisson of it
      integer(ip), intent(in) :: i                     !< place of the material
      type(token_t) :: ratio
      logical :: ok(2)

      if (context%elastic_given(i)) then
         if (card%ok) call report_error(context%deck, card%place, 'E-TWICE', 'material '//material%name//' has two *ELASTIC', &
                                        expected='one *ELASTIC a material')
         return
      end if
      context%elastic_given(i) = .true.
      context%elastic_invalid(i) = .true.
      if (card%n_lines == 0) return
      associate (deck => context%deck, line => context%deck%lines(card%first_line))
         select case (option_word(deck, card, 'TYPE'))
         case ('ISOTROPIC', 'ISO')                     ! E and mu; further lines, of other temperatures, say the same
            ratio = line_item(deck, line, 2_ip)
            context%poisson(i) = ratio
            if (.not. line%ok) return
            call get_positive(deck, line_item(deck, line, 1_ip), WHAT_E, 'E = ', material%young, ok(1))
            call get_real(deck, ratio, WHAT_MU, material%poisson, ok(2))
            if (ok(2) .and. (material%poisson <= -1.0_wp .or. material%poisson > 0.5_wp)) then
               ok(2) = .false.
               call report_error(deck, ratio, 'E-VALUE', 'mu = '//to_text(material%poisson, 15)//' is out of range', &
                                 expected=WHAT_MU)
            end if
            if (all(ok) .and. index(token_text(deck, ratio), '00') == 1) then
               ok(1) = .false.
               call report_error(deck, ratio, 'E-NUMBER', token_text(deck, ratio)//' is the rest of a number with a comma in it', &
                                 expected='E and mu, as 210000., 0.3')
            else if (all(ok) .and. token_text(deck, ratio) == '0') then
               ok(1) = check_comma(deck, line, 2_ip, 'E [F/L^2], mu [-]; a temperature behind mu = 0 as 0., 20.')
            end if
            if (all(ok)) call check_constant(deck, card, [material%young, material%poisson], 'E and mu', ok(1))
            context%elastic_invalid(i) = .not. all(ok)
         case default
            call read_orthotropic(card, material, deck, ok(1))
            context%elastic_invalid(i) = .not. ok(1)
         end select
      end associate
   end subroutine read_elastic_card

   !> Lines for further temperatures say the same.
   subroutine check_constant(deck, card, values, what, ok)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(card_t), intent(in) :: card                 !< whose further lines are compared
      real(wp), intent(in) :: values(:)                !< of the first line
      character(len=*), intent(in) :: what             !< they are
      logical, intent(inout) :: ok                     !< becomes false where a line says something else
      real(wp) :: value
      integer(ip) :: i, k
      logical :: good

      do k = card%first_line + 1, card%first_line + card%n_lines - 1
         if (.not. deck%lines(k)%ok) cycle
         do i = 1, size(values, kind=ip)
            call get_real(deck, line_item(deck, deck%lines(k), i), 'a real', value, good)
            ok = ok .and. good
            if (.not. good) cycle
            if (abs(value - values(i)) <= 0.0_wp) cycle
            ok = .false.
            call report_error(deck, line_item(deck, deck%lines(k), i), 'E-OUTSIDE', what//' that depend on the temperature are '// &
                              'not what atrito computes', expected='one line: the values at the temperature of the step')
            return
         end do
      end do
   end subroutine check_constant

   !> Nine constants on two lines.
   subroutine read_orthotropic(card, material, deck, ok)
      type(card_t), intent(in) :: card
      type(material_t), intent(inout) :: material
      type(deck_t), intent(in) :: deck
      logical, intent(out) :: ok
      real(wp) :: values(N_CONSTANTS), s(SPATIAL, SPATIAL)
      character(len=:), allocatable :: wanted
      type(token_t) :: item
      integer(ip) :: i
      logical :: is_engineering, good

      is_engineering = option_word(deck, card, 'TYPE') == 'ENGINEERING CONSTANTS'
      ok = .false.
      if (card%n_lines < 2) return
      if (.not. all(deck%lines(card%first_line:card%first_line + 1)%ok)) return
      ok = .true.
      do i = 1, N_CONSTANTS
         item = line_item(deck, deck%lines(card%first_line + merge(0_ip, 1_ip, i <= N_FIRST)), merge(i, i - N_FIRST, i <= N_FIRST))
         if (.not. is_engineering) then
            call get_real(deck, item, 'elastic constant, a real [F/L^2]', values(i), good)
         else if (i > 3 .and. i < 7) then
            call get_real(deck, item, "Poisson's ratio, a real [-]", values(i), good)
         else
            call get_positive(deck, item, 'modulus, a real > 0 [F/L^2]', 'the modulus ', values(i), good)
         end if
         ok = ok .and. good
      end do
      if (.not. ok) return
      if (is_engineering) then
         s = compliance_of_constants(values(1:3), values(4:6), values(7))
         wanted = 'nu12^2 < E1/E2, nu13^2 < E1/E3, nu23^2 < E2/E3, '// &
                  'nu12 nu21 + nu13 nu31 + nu23 nu32 + 2 nu21 nu32 nu13 < 1, where nu21 = nu12 E2/E1 ...'
      else
         s = 0.0_wp                                    ! D1111, D1122, D2222, D1133, D2233, D3333, D1212, ...
         s(:3, 1) = values([1, 2, 4])
         s(:3, 2) = values([2, 3, 5])
         s(:3, 3) = values([4, 5, 6])
         s(4, 4) = values(7)
         wanted = 'a positive definite matrix D1111, D1122, D1133; D1122, D2222, D2233; D1133, D2233, D3333, and D1212 > 0'
      end if
      ok = is_positive_definite(s)
      if (.not. ok) then
         call report_error(deck, line_item(deck, deck%lines(card%first_line), 1_ip), 'E-VALUE', &
                           'these constants give some strains no energy', expected=wanted)
         return
      end if
      material%is_orthotropic = .true.
      material%stiffness = s
      if (is_engineering) material%stiffness = inverse_of(s)
      if (.not. is_engineering) s = inverse_of(s)
      material%young = 2/(s(1, 1) + s(2, 2))
      material%poisson = 0.0_wp
   end subroutine read_orthotropic

end module atrito_build_materials
