!> How the program is called, for `atrito` alone and `atrito --help` (docs/user/running.md).
module atrito_usage
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_page, only: page_t, begin_page, add_line
   implicit none (type, external)
   private
   public :: compose_usage, compose_options

   !> The short form.
   character(len=80), parameter :: USAGE(5) = [character(len=80) :: &
                                               'usage: atrito DECK.inp [options]', &
                                               '       atrito check DECK.inp | sweep DECK.inp --vary NAME=v1,v2,...', &
                                               '       atrito study DECK.inp --levels N | limit DECK.inp --vary NAME=a:b', &
                                               '       atrito compare A B | help [KEYWORD]', &
                                               '       atrito --help | --version']

   !> The long form: every command, option and exit code.
   character(len=80), parameter :: HELP(48) = [character(len=80) :: &
                                               '', &
                                               'atrito DECK.inp [options]   solve the deck and write tables', &
                                               'atrito check DECK.inp       read and check all, tell what the scene needs', &
                                               'atrito sweep DECK.inp       one run a value of a parameter: --vary NAME=v1,...', &
                                               'atrito study DECK.inp       error against run time: --levels N', &
                                               'atrito limit DECK.inp       where a scene ceases to stand: --vary NAME=a:b', &
                                               'atrito compare A B          compare two tables, or two folders of them', &
                                               'atrito help [KEYWORD]       the deck language; `atrito help all`: all of it', &
                                               'atrito --help | --version', &
                                               '', &
                                               'options of a run, a sweep, a study and a limit', &
                                               '(check knows --set, --refine, --solver, --contact, --threads, --quiet)', &
                                               '  -o DIR             folder of the tables; default ./output/<name of the deck>', &
                                               '  --set NAME=VALUE   value of a *PARAMETER of the deck; may be repeated', &
                                               '  --refine K         each element into 4, K times; all else follows', &
                                               '  --solver NAME      auto (default), skyline, banded, sparse or mumps', &
                                               '  --contact NAME     auto (default), dense or sparse: form of the contact system', &
                                               '  --threads N        cores of a run, or runs of a sweep side by side; default 1', &
                                               '  --digits N         significant digits of the tables, 6 to 17, default 10', &
                                               '  --plot             pictures by gnuplot: mesh and contact pairs, in DIR/plots', &
                                               '  --quiet            no progress, no notes, no summary; warnings and errors', &
                                               'option of a run', &
                                               '  --restart FILE     go on behind the increment in a file of *RESTART, WRITE', &
                                               'options of a sweep', &
                                               '  --vary NAME=v1,..  values of a *PARAMETER; several --vary: all combinations', &
                                               'options of a study', &
                                               '  --levels N         so many meshes, each of four times the elements', &
                                               '  --elements LIST    cpe4,cpe8,cpe9,cps4,...; default the deck''s', &
                                               '  --reference Q=V    exact value of a quantity of summary.tab; Q alone:', &
                                               '                     extrapolated; may be repeated', &
                                               'options of a limit', &
                                               '  --vary NAME=a:b    it lies between these values of a *PARAMETER', &
                                               '  --tolerance T      of it, 1e-8 to 0.1, default 1e-6', &
                                               '  --watch NODE,DOF   displacement of the curve; default the largest', &
                                               'options of compare', &
                                               '  --rtol R           relative to the largest of the column, default 1e-6', &
                                               '  --atol A           absolute, default 0', &
                                               '', &
                                               'exit codes', &
                                               '  0  solved, checked, all tables written; compare: the same', &
                                               '  1  wrong command line; compare: different', &
                                               '  2  errors in the deck, all of them listed; nothing computed', &
                                               '  3  not converged, or the final check failed: the last iterate is written,', &
                                               '     and marked', &
                                               '  4  singular or indefinite system', &
                                               '  5  a file cannot be read or written', &
                                               '  9  internal error', &
                                               '  129, 130, 143  ended by SIGHUP, SIGINT, SIGTERM; nothing half-written is left']

contains

   subroutine compose_usage(page)
      type(page_t), intent(out) :: page

      call begin_page(page, 80)
      call add_lines(page, USAGE)
   end subroutine compose_usage

   subroutine compose_options(page)
      type(page_t), intent(out) :: page

      call begin_page(page, 80)
      call add_line(page, PROGRAM_NAME//' '//PROGRAM_VERSION//': contact with friction between elastic bodies')
      call add_lines(page, HELP)
   end subroutine compose_options

   subroutine add_lines(page, lines)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: lines(:)
      integer :: i

      do i = 1, size(lines)
         call add_line(page, lines(i))
      end do
   end subroutine add_lines

end module atrito_usage
