!> --show line: what the bodies are to the contact line in the dense form, C, G, g0 and h, with what was found.
!>
!>     r = g0 - (C + D) q + G a,     G' q = h
module atrito_show_line
   use atrito_bound_qp, only: bound_qp_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_dense, only: eigen_symmetric
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_page, only: page_t, add_heading, add_line, plural
   use atrito_grid, only: add_matrix
   use atrito_strings, only: append_string, to_text, trimmed_strings
   use atrito_table, only: table_t, add_integers, add_reals, add_words, begin_table
   implicit none (type, external)
   private
   public :: view_line

   integer(ip), parameter :: MOST_NUMBERS = 16      !< unknowns of which C and G are printed; of more there are digits of C
   integer(ip), parameter :: MOST_DIGITS = 75       !< of a line

contains

   !> Page and tables: a row an unknown, and a row a rigid motion.
   subroutine view_line(qp, line, solution, page, table, motions)
      type(bound_qp_t), intent(in) :: qp               !< of the dense form
      type(contact_line_t), intent(in) :: line         !< which point each unknown is of
      type(contact_solution_t), intent(in) :: solution !< what was found; not allocated: nothing was
      type(page_t), intent(inout) :: page              !< gets the view
      type(table_t), intent(out) :: table, motions     !< show-line and show-motions
      real(wp) :: vectors(qp%m, qp%m), values(qp%m)
      character(len=4) :: names(qp%m)               ! `n1` and `t1`: the forces of point 1, of 200 at most
      integer(ip) :: i, info

      do i = 1, qp%m
         names(i) = merge('n', 't', i <= qp%n_normal)//to_text(line%point(i))
      end do
      call add_heading(page, 'contact line: '//to_text(qp%m)//' unknown forces, '//to_text(qp%n_normal)//' of them normal, ' &
                       //plural(qp%k, 'rigid motion', 'rigid motions'))
      call add_line(page, 'r = g0 - (C + D) q + G a,  G'' q = h;  n3, t3: normal, tangential of point 3')
      if (qp%m == 0) return
      if (qp%m <= MOST_NUMBERS) then
         call add_matrix(page, 'C [L/F]', qp%c, names)
      else
         call add_digits(qp%c, page)
      end if
      if (qp%k > 0) then
         if (qp%m <= MOST_NUMBERS) call add_matrix(page, 'G', qp%g, names)
         call add_matrix(page, 'h [F]', reshape(qp%h, [1_ip, qp%k]))
      end if
      vectors = qp%c
      call eigen_symmetric(vectors, values, info)
      call add_line(page, 'eigenvalues of C: '//to_text(values(1), 4)//' to '//to_text(values(qp%m), 4)//' [L/F], their ratio '// &
                    to_text(values(qp%m)/max(values(1), EPS_MACH*values(qp%m)), 3))
      call begin_table(table, 'show-line', 'a row an unknown force of the contact line', qp%m)
      call append_string(table%remarks, 'r = g0 - (C + D) q + G a; c_j: column j of C, g_j: column j of G')
      call add_words(table, 'unknown', '-', trimmed_strings(names), on_the_left=.true.)
      call add_reals(table, 'weight', 'L^2', qp%weight, 0.0_wp)
      call add_reals(table, 'g0', 'L', qp%g0, 0.0_wp)
      if (allocated(solution%p)) then
         call add_reals(table, 'd', 'L/F', solution%bounds%d, 0.0_wp)
         call add_reals(table, 'q', 'F', solution%state%q, 0.0_wp)
         call add_reals(table, 'r', 'L', solution%state%r, 0.0_wp)
      end if
      do i = 1, qp%k
         call add_reals(table, 'g_'//to_text(i), '-', qp%g(:, i), 0.0_wp)
      end do
      do i = 1, qp%m
         call add_reals(table, 'c_'//to_text(i), 'L/F', qp%c(:, i), 0.0_wp)
      end do
      call begin_table(motions, 'show-motions', 'a row a rigid motion that supports leave', qp%k)
      call add_integers(motions, 'motion', [(i, i=1, qp%k)])
      call add_reals(motions, 'h', 'F', qp%h, 0.0_wp)
      if (allocated(solution%p)) call add_reals(motions, 'a', 'L', solution%state%a, 0.0_wp)
   end subroutine view_line

   !> C as digits: by how many powers of ten an entry is below the largest, 9 for all that are smaller.
   pure subroutine add_digits(c, page)
      real(wp), intent(in) :: c(:, :)
      type(page_t), intent(inout) :: page
      character(len=MOST_DIGITS) :: text
      integer(ip) :: i, j, n

      n = min(size(c, 1, kind=ip), MOST_DIGITS)
      call add_line(page, 'C: by how many powers of ten an entry is below the largest, '//to_text(maxval(abs(c)), 4)//' [L/F]')
      do i = 1, n
         text = ''
         do j = 1, n
            text(j:j) = '9'
            if (abs(c(i, j)) > 1.0e-9_wp*maxval(abs(c))) text(j:j) = achar(iachar('0') + int(log10(maxval(abs(c))/abs(c(i, j)))))
         end do
         call add_line(page, text)
      end do
      if (n < size(c, 1)) call add_line(page, 'the first '//to_text(n)//' of '//to_text(size(c, 1, kind=ip))//'; show-line has all')
   end subroutine add_digits

end module atrito_show_line
