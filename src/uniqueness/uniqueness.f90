!> Whether the solution of a contact line is the only one: what is proved, and what is not.
!>
!>     1. without friction there is one;
!>     2. a certificate of the matrix (atrito_one_solution), for every load up to a coefficient of friction. It does not depend on
!>        the loads: a history makes one as long as the bodies are factored;
!>     3. where it does not reach the deck's coefficients: the index of the solution (atrito_state_index); with exact stick, whether
!>        another one can move the same way at every point; and an estimate of the contraction (atrito_contraction), no proof.
!>
!> The largest coefficient stands for all: those of other pairs are scaled with it.
module atrito_uniqueness
   use atrito_assembly, only: fem_t
   use atrito_bound_qp, only: bound_qp_t
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_contraction, only: estimate_contraction
   use atrito_friction_form, only: build_form, who_holds_along
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_kinds, only: ip, wp
   use atrito_line_certificate, only: line_certificate_t
   use atrito_one_solution, only: certify, MOST
   use atrito_results, only: uniqueness_t
   use atrito_row_entries, only: build_constraint_rows
   use atrito_sparse_certificate, only: certify_sparse
   use atrito_state_index, only: index_of_solution, meet_state
   use atrito_status, only: is_ok, status_t
   implicit none (type, external)
   private
   public :: certify_line, certify_scene, judge_solution, judge_contraction, is_certified, LONGEST

   integer(ip), parameter :: LONGEST = 400        !< unknown forces of a line that is certified without being asked to

contains

   !> What is certified of a line for every load.
   subroutine certify_line(problem, line, is_asked, certificate)
      type(bound_qp_t), intent(in) :: problem     !< C and G
      type(contact_line_t), intent(in) :: line    !< points, laws, average S_rho
      logical, intent(in) :: is_asked             !< also where the line is long
      type(line_certificate_t), intent(out) :: certificate
      character(len=:), allocatable :: why_not
      real(wp) :: nu

      associate (known => certificate%known)
         known%nu = maxval([0.0_wp, line%law(line%point(problem%n_normal + 1:))%nu])
         if (.not. known%nu > 0.0_wp) return
         if (problem%m > LONGEST .and. .not. is_asked) then
            known%why_not = 'the line is long: --unique asks for it'
            return
         end if
         allocate (certificate%form)
         call build_form(problem, line, certificate%form, why_not)
         if (len(why_not) == 0) then
            call certify(certificate%form, nu, certificate%alpha)
            known%up_to_nu = rounded_down(nu)
            if (.not. nu > 0.0_wp) why_not = 'contact points depend on each other'
         end if
         known%why_not = why_not
         if (len(why_not) > 0 .or. is_certified(known)) deallocate (certificate%form)   ! no solution asks for it
      end associate
   end subroutine certify_line

   !> The same in the sparse form, where it costs some factorisations of the scene.
   subroutine certify_scene(fem, rows, line, is_asked, certificate)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      logical, intent(in) :: is_asked             !< else it is told why there is none
      type(line_certificate_t), intent(out) :: certificate
      type(constraint_rows_t) :: b
      type(status_t) :: status
      real(wp), allocatable :: g(:, :)
      real(wp) :: nu
      integer(ip) :: i, k, n, n_normal

      associate (known => certificate%known)
         known%nu = maxval(line%law%nu)
         call build_constraint_rows(fem, rows, line, .true., b)
         n = sum(fem%bodies%list%n)
         n_normal = count(line%normal > 0, kind=ip)
         allocate (g(2, n + 1:b%n_columns), source=0.0_wp)   ! the largest of each motion along a normal, along a tangent
         do i = 1, b%n
            do k = b%first(i), b%first(i + 1) - 1
               associate (column => b%column(k), kind_of => merge(1, 2, i <= n_normal))
                  if (column > n) g(kind_of, column) = max(g(kind_of, column), abs(b%value(k)))
               end associate
            end do
         end do
         known%why_not = who_holds_along(g(2, :), maxval(g, dim=1), line)
         if (len_trim(known%why_not) > 0) return
         known%why_not = 'in the sparse form --unique asks for it'
         if (.not. is_asked) return
         call certify_sparse(fem, rows, line, MOST, nu, status)
         known%why_not = ''
         known%up_to_nu = rounded_down(nu)
         if (is_certified(known)) known%index = 1
         if (.not. nu > 0.0_wp) known%why_not = 'contact points depend on each other'
         if (.not. is_ok(status)) known%why_not = 'not enough memory'
      end associate
   end subroutine certify_scene

   !> Adds what is proved of a solution that no certificate makes the only one.
   !>
   !> For bodies that move along the contact, and where points depend on each other, the index proves nothing, as the certificates.
   !> With exact stick, where one solution at most moves a certain way, no state that slips that way is singular for smaller
   !> coefficients, and its index is 1.
   subroutine judge_solution(problem, line, solution, is_last, certificate, uniqueness)
      type(bound_qp_t), intent(in) :: problem     !< C and G
      type(contact_line_t), intent(in) :: line    !< points, laws, average S_rho
      type(contact_solution_t), intent(in) :: solution !< converged or not
      logical, intent(in) :: is_last              !< its own way is asked for; else the first one that was found serves
      type(line_certificate_t), intent(inout) :: certificate
      type(uniqueness_t), intent(inout) :: uniqueness  !< of certify_line
      character(len=:), allocatable :: why_not
      logical :: is_along
      real(wp) :: direction(problem%m - problem%n_normal)

      if (is_certified(uniqueness)) uniqueness%index = 1
      if (is_certified(uniqueness) .or. .not. solution%converged .or. len_trim(uniqueness%why_not) > 0) return
      if (.not. allocated(certificate%form)) then
         allocate (certificate%form)
         call build_form(problem, line, certificate%form, why_not)
      end if
      call meet_state(problem, line, solution, certificate)
      is_along = .false.
      ! Not where some law has elastic slip before its full friction.
      if (all(line%law%kind == FRICTION_NONE .or. (line%law%eps <= 0.0_wp .and. line%law%compliance <= 0.0_wp))) then
         ! The directions along which a solution moves; points that stick may be taken to go along with most of the others.
         direction = certificate%share
         associate (r => solution%state%r(problem%n_normal + 1:))
            where (solution%bounds%upper(problem%n_normal + 1:) <= 0.0_wp) direction = sign(1.0_wp, r)
            where (abs(direction) <= 0.0_wp) direction = merge(1.0_wp, -1.0_wp, sum(direction) >= 0.0_wp)
         end associate
         if (is_last .or. .not. allocated(certificate%way)) call keep_way(direction, certificate)
         if (is_last) uniqueness%same_way_up_to_nu = certificate%way_up_to_nu
         associate (slip => certificate%share, way => certificate%way)
            is_along = certificate%way_up_to_nu >= uniqueness%nu .and. all(slip*way >= 0.0_wp)
         end associate
      end if
      uniqueness%index = index_of_solution(problem, line, solution, is_along, certificate)
      if (is_last) deallocate (certificate%form)
   end subroutine judge_solution

   !> The certificate of a way, if it is not that which is there.
   subroutine keep_way(way, certificate)
      real(wp), intent(in) :: way(:)
      type(line_certificate_t), intent(inout) :: certificate  !< with the form

      if (allocated(certificate%way)) then
         if (all(certificate%way*way > 0.0_wp)) return
      end if
      certificate%way = way
      call certify(certificate%form, certificate%way_up_to_nu, certificate%alpha, way)
      certificate%way_up_to_nu = rounded_down(certificate%way_up_to_nu)
   end subroutine keep_way

   !> The estimate of the contraction; 0 where it says nothing new. It is made again where states or laws have changed.
   subroutine judge_contraction(problem, line, solution, certificate, contraction)
      type(bound_qp_t), intent(in) :: problem     !< C and G
      type(contact_line_t), intent(in) :: line    !< points, laws, average S_rho
      type(contact_solution_t), intent(in) :: solution !< converged or not
      type(line_certificate_t), intent(inout) :: certificate
      real(wp), intent(out) :: contraction

      contraction = 0.0_wp
      if (is_certified(certificate%known)) return
      call meet_state(problem, line, solution, certificate)
      if (certificate%contraction < 0.0_wp) then
         certificate%contraction = estimate_contraction(problem, line, solution%bounds%d, solution%state%state)
      end if
      contraction = certificate%contraction
   end subroutine judge_contraction

   !> Whether there is one solution alone, as far as is proved.
   pure logical function is_certified(uniqueness)
      type(uniqueness_t), intent(in) :: uniqueness

      is_certified = .not. uniqueness%nu > uniqueness%up_to_nu
   end function is_certified

   !> Three digits of a number, none larger: what is told is certified, whatever the last digits of the search.
   pure real(wp) function rounded_down(x)
      real(wp), intent(in) :: x                   !< >= 0
      character(len=9) :: text

      rounded_down = 0.0_wp
      if (.not. x > 0.0_wp) return
      associate (unit => 10.0_wp**(floor(log10(x)) - 2))
         write (text, '(es9.2)') floor(x/unit)*unit
      end associate
      read (text, '(es9.2)') rounded_down
   end function rounded_down

end module atrito_uniqueness
