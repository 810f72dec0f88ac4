!> *ELASTIC: E and mu, engineering constants or stiffnesses of an orthotropic material.
module atrito_read_elastic
   use atrito_build_context, only: build_context_t
   use atrito_deck, only: card_t, deck_t, token_t, token_text, line_item
   use atrito_diagnostics, only: report_error
   use atrito_items, only: check_comma, get_real, option_word
   use atrito_kinds, only: ip, wp
   use atrito_model, only: material_t
   use atrito_orthotropy, only: SPATIAL, compliance_of_constants, inverse_of, is_positive_definite
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_elastic_card, get_positive, check_constant

   character(len=*), parameter :: WHAT_E = "Young's modulus E, a real > 0 [F/L^2]", &
                                  WHAT_MU = "Poisson's ratio mu, plane strain -1 < mu < 0.5, plane stress -1 < mu <= 0.5 [-]"

   integer(ip), parameter :: N_CONSTANTS = 9           !< of an orthotropic material, the last one on the second line
   integer(ip), parameter :: N_FIRST = 8

contains

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

   !> A real that must be positive.
   subroutine get_positive(deck, token, what, name, value, ok)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(token_t), intent(in) :: token               !< the item; messages point at it
      character(len=*), intent(in) :: what, name       !< what is expected, and what stands before the value in a message
      real(wp), intent(out) :: value                   !< > 0 where ok
      logical, intent(out) :: ok                       !< it is one; else that is reported

      call get_real(deck, token, what, value, ok)
      if (.not. ok .or. value > 0.0_wp) return
      ok = .false.
      call report_error(deck, token, 'E-VALUE', name//to_text(value)//' is not positive', expected=what)
   end subroutine get_positive

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

end module atrito_read_elastic
