!> How the program is called, for `atrito` alone and `atrito --help`.
module atrito_usage
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_page, only: page_t, begin_page, add_line, add_blank
   implicit none (type, external)
   private
   public :: compose_usage, compose_options

contains

   !> The short form.
   subroutine compose_usage(page)
      type(page_t), intent(out) :: page

      call begin_page(page, 80)
      call add_line(page, 'usage: atrito DECK.inp [options]')
      call add_line(page, '       atrito check DECK.inp | sweep DECK.inp --vary NAME=v1,v2,...')
      call add_line(page, '       atrito study DECK.inp --levels N | limit DECK.inp --vary NAME=a:b')
      call add_line(page, '       atrito compare A B | help [KEYWORD]')
      call add_line(page, '       atrito --help | --version')
   end subroutine compose_usage

   !> The long form: every command, option and exit code (docs/user/running.md).
   subroutine compose_options(page)
      type(page_t), intent(out) :: page

      call begin_page(page, 80)
      call add_line(page, PROGRAM_NAME//' '//PROGRAM_VERSION//': contact with friction between elastic bodies')
      call add_blank(page)
      call add_commands(page)
      call add_blank(page)
      call add_options(page)
      call add_blank(page)
      call add_exit_codes(page)
   end subroutine compose_options

   subroutine add_commands(page)
      type(page_t), intent(inout) :: page

      call add_line(page, 'atrito DECK.inp [options]   solve the deck and write tables')
      call add_line(page, 'atrito check DECK.inp       read and check all, tell what the scene needs')
      call add_line(page, 'atrito sweep DECK.inp       one run a value of a parameter: --vary NAME=v1,...')
      call add_line(page, 'atrito study DECK.inp       error against run time: --levels N')
      call add_line(page, 'atrito limit DECK.inp       where a scene ceases to stand: --vary NAME=a:b')
      call add_line(page, 'atrito compare A B          compare two tables, or two folders of them')
      call add_line(page, 'atrito help [KEYWORD]       the deck language; `atrito help all`: all of it')
      call add_line(page, 'atrito --help | --version')
   end subroutine add_commands

   subroutine add_options(page)
      type(page_t), intent(inout) :: page

      call add_line(page, 'options of a run, a sweep, a study and a limit')
      call add_line(page, '(check knows --set, --refine, --solver, --contact, --threads, --quiet)')
      call add_line(page, '  -o DIR             folder of the tables; default ./output/<name of the deck>')
      call add_line(page, '  --set NAME=VALUE   value of a *PARAMETER of the deck; may be repeated')
      call add_line(page, '  --refine K         each element into 4, K times; all else follows')
      call add_line(page, '  --solver NAME      auto (default), skyline, banded, sparse or mumps')
      call add_line(page, '  --contact NAME     auto (default), dense or sparse: form of the contact system')
      call add_line(page, '  --threads N        cores of a run, or runs of a sweep side by side; default 1')
      call add_line(page, '  --digits N         significant digits of the tables, 6 to 17, default 10')
      call add_line(page, '  --plot             pictures by gnuplot: mesh and contact pairs, in DIR/plots')
      call add_line(page, '  --quiet            no progress, no notes, no summary; warnings and errors')
      call add_line(page, 'options of a sweep')
      call add_line(page, '  --vary NAME=v1,..  values of a *PARAMETER; several --vary: all combinations')
      call add_line(page, 'options of a study')
      call add_line(page, '  --levels N         so many meshes, each of four times the elements')
      call add_line(page, '  --elements LIST    cpe4, cps4, cpe9, cps9 with commas; default the deck''s own')
      call add_line(page, '  --reference Q=V    exact value of a quantity of summary.tab; Q alone:')
      call add_line(page, '                     extrapolated; may be repeated')
      call add_line(page, 'options of a limit')
      call add_line(page, '  --vary NAME=a:b    it lies between these values of a *PARAMETER')
      call add_line(page, '  --tolerance T      of it, 1e-8 to 0.1, default 1e-6')
      call add_line(page, '  --watch NODE,DOF   displacement of the curve; default the largest')
      call add_line(page, 'options of compare')
      call add_line(page, '  --rtol R           relative to the largest of the column, default 1e-6')
      call add_line(page, '  --atol A           absolute, default 0')
   end subroutine add_options

   subroutine add_exit_codes(page)
      type(page_t), intent(inout) :: page

      call add_line(page, 'exit codes')
      call add_line(page, '  0  solved, checked, all tables written; compare: the same')
      call add_line(page, '  1  wrong command line; compare: different')
      call add_line(page, '  2  errors in the deck, all of them listed; nothing computed')
      call add_line(page, '  3  not converged, or the final check failed: the last iterate is written,')
      call add_line(page, '     and marked')
      call add_line(page, '  4  singular or indefinite system')
      call add_line(page, '  5  a file cannot be read or written')
      call add_line(page, '  9  internal error')
      call add_line(page, '  129, 130, 143  ended by SIGHUP, SIGINT, SIGTERM; nothing half-written is left')
   end subroutine add_exit_codes

end module atrito_usage
