!> The expressions of *OBSERVE and --observe: read once against the model, evaluated at the end of each increment.
module atrito_observations
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_expression_names, only: call_t, is_name
   use atrito_expressions, only: evaluate_expression, expression_fault_t, list_calls
   use atrito_kinds, only: ip, is_nan, wp
   use atrito_linear_quantity, only: linear_quantity_t, POTENTIAL_ENERGY
   use atrito_mesh, only: mesh_t
   use atrito_messages, only: add_warning, message_t, SEVERITY_ERROR
   use atrito_model, only: model_t, observed_line_t
   use atrito_observed_names, only: field_names, find_term, observable_names
   use atrito_observed_quantities, only: find_quantity
   use atrito_observed_terms, only: is_of_strain, is_of_stress, term_t, value_of_term, TERM_STEP
   use atrito_observer, only: observer_t
   use atrito_place_fields, only: nodal_strains
   use atrito_results, only: history_row_t, observed_t, results_t
   use atrito_strings, only: append_string, nearest_names, same_name, string_t, to_text
   use atrito_summary, only: all_step_quantities, quantity_t
   implicit none (type, external)
   private
   public :: observations_t, read_observations, observation_name, observation_names

   !> One of them.
   type :: observation_t
      character(len=:), allocatable :: name, text    !< text: the expression
      type(observed_line_t) :: line                  !< of the deck; its text is not allocated where --observe gives it
      type(call_t), allocatable :: calls(:)          !< of it
      type(term_t), allocatable :: terms(:)          !< what they mean
      logical :: has_warned = .false.                !< that it is not defined: told once
   end type observation_t

   !> All expressions of a run (observer_t).
   type, extends(observer_t) :: observations_t
      type(linear_quantity_t), allocatable :: quantities(:) !< of --bound; not allocated: none
      type(observation_t), allocatable, private :: list(:)    !< of the deck, then of --observe
      type(string_t), allocatable, private :: names(:)        !< parameters of the deck
      real(wp), allocatable, private :: values(:)             !< of the parameters
      logical, private :: has_own_degree = .false.            !< one of them is deg
      type(mesh_t), allocatable, private :: mesh              !< where strains are asked for
   contains
      procedure :: observe => evaluate_all
   end type observations_t

   integer, parameter :: MOST_NEAREST = 3, FEW = 20  !< names that are told: near ones, or all where they are few
   !> Other columns of the tables in which the names stand.
   character(len=*), parameter :: COLUMNS(26) = [character(len=14) :: 'step', 'increment', 'pair', 'quantity', 'value', 'run', &
                                                         'exit', 'factorisations', 'folder', 'moment', 'contact_length', 'centre', &
                                                                 'dissipation', 'elastic_energy', 'level', 'element', 'h', 'dofs', &
                                                                      'contact_points', 'open', 'stick', 'slip', 'code', 'excess', &
                                                                                                       'displacement', 'iterations']

   !> What stands behind the names of bounds.
   character(len=*), parameter :: FROM = '_least', TO = '_most'

contains

   !> Reads `NAME=EXPRESSION`, several: those of the deck, then the texts of --observe. is_ok is false where one is
   !> wrong, and error says how. bounds: the names of those that bounds are asked for.
   subroutine read_observations(texts, model, observations, is_ok, error, bounds)
      type(string_t), intent(in) :: texts(:)            !< of --observe
      type(model_t), intent(in) :: model                !< whose names the expressions use
      type(observations_t), intent(out) :: observations !< read, for this model
      logical, intent(out) :: is_ok                     !< no expression is wrong
      type(message_t), intent(out) :: error             !< text not allocated: there is none
      type(string_t), intent(in), optional :: bounds(:) !< names, of --bound; not present: none
      integer :: i, k, n

      is_ok = .true.
      n = size(model%observed)
      observations%is_there = n + size(texts) > 0
      if (present(bounds)) observations%is_there = observations%is_there .or. size(bounds) > 0
      if (.not. observations%is_there) return
      allocate (observations%list(n + size(texts)), observations%names(size(model%parameters)))
      do i = 1, size(model%parameters)
         observations%names(i)%s = model%parameters(i)%name
         observations%has_own_degree = observations%has_own_degree .or. same_name(model%parameters(i)%name, 'deg')
      end do
      observations%values = model%parameters%value
      do i = 1, size(observations%list)
         associate (one => observations%list(i))
            if (i <= n) one%line = model%observed(i)
            if (i <= n) one%text = one%line%text
            if (i > n) one%text = texts(i - n)%s
            one%name = observation_name(one%text)
            one%text = one%text(index(one%text//'=', '=') + 1:)
            call check_name(observations, i, is_ok, error)
            if (is_ok) call find_terms(model, observations, i, is_ok, error)
            if (.not. is_ok) return
            observations%wants_stress = observations%wants_stress .or. wants_stress(one%terms)
            do k = 1, size(one%terms)
               if (is_of_strain(one%terms(k))) observations%mesh = model%mesh
            end do
         end associate
      end do
      if (present(bounds)) call find_bounds()

   contains

      !> The quantities of --bound: observed ones by their names. What is wrong is a matter of the command line.
      subroutine find_bounds()
         type(string_t), allocatable :: observed(:)
         integer :: b, i

         if (size(bounds) == 0) return
         allocate (observed(0))
         do i = 1, size(observations%list)
            call append_string(observed, observations%list(i)%name)
         end do
         allocate (observations%quantities(size(bounds)))
         do b = 1, size(bounds)
            do i = 1, size(observed)
               if (same_name(observed(i)%s, bounds(b)%s)) exit
            end do
            if (i > size(observed) .and. same_name(bounds(b)%s, POTENTIAL_ENERGY)) then
               observations%quantities(b)%name = POTENTIAL_ENERGY
               allocate (observations%quantities(b)%parts(0))
            else if (i > size(observed)) then
               error%text = 'nothing of this name is observed'
               error%expected = 'the name of a quantity of --observe or *OBSERVE, or '//POTENTIAL_ENERGY
               error%nearest = nearest_names(bounds(b)%s, observed, MOST_NEAREST)
            else
               observations%quantities(b)%name = observed(i)%s
               call find_bound(model, observations, i, observed, observations%quantities(b), error)
            end if
            is_ok = .not. allocated(error%text)
            if (is_ok) cycle
            error%severity = SEVERITY_ERROR
            error%id = 'E-OBSERVE'
            error%file = 'atrito'
            error%text = '--bound '//bounds(b)%s//': '//error%text
            if (error%column > 0) error%text = error%text//', column '//to_text(error%column)
            if (error%column > 0) error%source = observations%list(i)%text
            return
         end do
      end subroutine find_bounds
   end subroutine read_observations

   !> The i-th one as a linear quantity. error%text: it is none, or its columns have no names.
   subroutine find_bound(model, observations, i, observed, quantity, error)
      type(model_t), intent(in) :: model
      type(observations_t), intent(in) :: observations
      integer, intent(in) :: i
      type(string_t), intent(in) :: observed(:)        !< names of all
      type(linear_quantity_t), intent(inout) :: quantity
      type(message_t), intent(inout) :: error
      type(observed_t) :: longest

      associate (one => observations%list(i))
         call find_quantity(model, one%text, observations%names, observations%values, observations%has_own_degree, one%calls, &
                            one%terms, quantity, error)
         if (allocated(error%text)) return
         if (len(one%name) + len(FROM) > len(longest%name)) error%text = 'its name is too long'
         if (is_one_of(one%name//FROM, observed) .or. is_one_of(one%name//TO, observed)) then
            error%text = 'its bounds have the name of another quantity that is observed'
         end if
         if (allocated(error%text)) error%expected = 'columns '//one%name//FROM//' and '//one%name//TO//', each of at most '// &
                                                     to_text(len(longest%name, kind=ip))//' characters'
      end associate
   end subroutine find_bound

   !> NAME of `NAME=EXPRESSION`, or of itself.
   pure function observation_name(text) result(name)
      character(len=*), intent(in) :: text             !< as the user wrote it
      character(len=:), allocatable :: name

      name = trim(adjustl(text))
      if (index(text, '=') > 0) name = trim(adjustl(text(:index(text, '=') - 1)))
   end function observation_name

   !> The names of those of a deck, then of --observe.
   pure function observation_names(lines, texts) result(names)
      type(observed_line_t), intent(in) :: lines(:)    !< of *OBSERVE
      type(string_t), intent(in) :: texts(:)           !< NAME=EXPRESSION
      type(string_t), allocatable :: names(:)
      integer :: i, n

      n = size(lines)
      allocate (names(n + size(texts)))
      do i = 1, size(names)
         if (i <= n) names(i)%s = observation_name(lines(i)%text)
         if (i > n) names(i)%s = observation_name(texts(i - n)%s)
      end do
   end function observation_names

   !> The name of the i-th one is a word, of its own, and no other column of the tables.
   subroutine check_name(observations, i, is_ok, error)
      type(observations_t), intent(in) :: observations
      integer, intent(in) :: i
      logical, intent(out) :: is_ok
      type(message_t), intent(inout) :: error
      type(observed_t) :: longest
      character(len=:), allocatable :: what
      integer :: k

      associate (name => observations%list(i)%name)
         what = ''
         if (.not. is_name(name) .or. len(name) > len(longest%name)) what = 'is no name'
         if (is_one_of(name, observable_names())) what = 'is a quantity or function already'
         do k = 1, size(COLUMNS)
            if (same_name(name, COLUMNS(k))) what = 'is a column of the tables already'
         end do
         if (is_one_of(name, observations%names)) what = 'is a parameter of the deck'
         do k = 1, i - 1
            if (same_name(name, observations%list(k)%name)) what = 'is given twice'
         end do
         is_ok = len(what) == 0
         if (is_ok) return
         error%text = name//' '//what
         error%expected = 'another name: letters, digits and underscores, a letter first, at most ' &
                          //to_text(len(longest%name, kind=ip))//' characters'
         call complete_error(observations%list(i), error)
      end associate
   end subroutine check_name

   pure logical function is_one_of(name, list)
      character(len=*), intent(in) :: name
      type(string_t), intent(in) :: list(:)
      integer :: i

      is_one_of = .false.
      do i = 1, size(list)
         is_one_of = is_one_of .or. same_name(list(i)%s, name)
      end do
   end function is_one_of

   !> What the names in the i-th expression mean.
   subroutine find_terms(model, observations, i, is_ok, error)
      type(model_t), intent(in) :: model
      type(observations_t), intent(inout) :: observations
      integer, intent(in) :: i
      logical, intent(out) :: is_ok
      type(message_t), intent(inout) :: error
      type(expression_fault_t) :: fault
      type(message_t) :: wrong
      integer :: k

      associate (one => observations%list(i))
         call list_calls(one%text, observations%names, field_names(), one%calls, fault, observations%has_own_degree)
         is_ok = .not. allocated(fault%text)
         if (is_ok) then
            allocate (one%terms(size(one%calls)))
            do k = 1, size(one%calls)
               call find_term(model, one%calls(k), one%terms(k), wrong)
               is_ok = .not. allocated(wrong%text)
               if (is_ok) cycle
               error = wrong
               exit
            end do
         else
            error%text = fault%text
            error%expected = 'numbers, quantities, parameters of the deck, + - * / ** ( ), functions'
            error%column = int(fault%first, ip)
            error%length = int(fault%last - fault%first + 1, ip)
         end if
         if (.not. is_ok) call complete_error(one, error)
      end associate
   end subroutine find_terms

   !> An error of the deck or the command line, of which its words are known and where in the expression it is; of names that are
   !> known the nearest are told, or all where none is near and they are few.
   subroutine complete_error(one, error)
      type(observation_t), intent(in) :: one
      type(message_t), intent(inout) :: error

      error%severity = SEVERITY_ERROR
      error%id = 'E-OBSERVE'
      error%file = 'atrito'
      error%text = label_of(one)//': '//error%text
      if (error%column > 0 .and. allocated(error%known)) then
         error%nearest = nearest_names(one%text(error%column:error%column + error%length - 1), error%known, MOST_NEAREST)
         if (size(error%nearest) > 0 .or. size(error%known) > FEW) deallocate (error%known)
      end if
      if (allocated(one%line%text)) then
         error%file = one%line%file
         error%line = one%line%line
         error%source = one%line%text
         error%skipped = one%line%column - 1
         error%column = error%column + index(one%line%text, '=')          ! 0: the line has neither a place nor an =
         if (error%column > 0) error%column = error%column + one%line%column - 1
         error%keyword = 'OBSERVE'
      else if (error%column > 0) then
         error%text = error%text//', column '//to_text(error%column)
         error%source = one%text
      end if
   end subroutine complete_error

   !> Whose an expression is, in messages.
   pure function label_of(one) result(label)
      type(observation_t), intent(in) :: one
      character(len=:), allocatable :: label

      label = '--observe '//one%name
      if (allocated(one%line%text)) label = '*OBSERVE '//one%name
   end function label_of

   !> Whether terms want what costs a recovery of stresses.
   pure logical function wants_stress(terms)
      type(term_t), intent(in) :: terms(:)
      type(quantity_t), allocatable :: list(:)
      integer :: i

      wants_stress = .false.
      list = all_step_quantities()
      do i = 1, size(terms)
         associate (term => terms(i))
            wants_stress = wants_stress .or. is_of_stress(term)
            if (term%kind == TERM_STEP) wants_stress = wants_stress .or. list(term%field)%name == 'error_estimate_percent'
         end associate
      end do
   end function wants_stress

   !> Puts the values into the results.
   subroutine evaluate_all(self, results, rows)
      class(observations_t), intent(inout) :: self
      type(results_t), intent(inout) :: results
      type(history_row_t), intent(in) :: rows(:)     !< of the history so far
      type(observed_t), allocatable :: found(:)
      real(wp), allocatable :: strain(:, :)
      integer :: i, n, n_bounds

      if (allocated(self%mesh)) call nodal_strains(self%mesh, results%u, strain)
      n = size(self%list)
      n_bounds = 0
      if (allocated(self%quantities)) n_bounds = size(self%quantities)
      allocate (found(n + 2*n_bounds))
      do i = 1, n
         found(i)%name = self%list(i)%name
         call evaluate(found(i)%value)
      end do
      do i = 1, n_bounds
         associate (least => found(n + 2*i - 1), largest => found(n + 2*i))
            least = observed_t(self%quantities(i)%name//FROM, ieee_value(1.0_wp, ieee_quiet_nan))
            largest = observed_t(self%quantities(i)%name//TO, ieee_value(1.0_wp, ieee_quiet_nan))
            if (.not. allocated(results%bounded)) cycle
            if (.not. results%bounded(i)%exists) cycle
            least%value = results%bounded(i)%least
            largest%value = results%bounded(i)%most
         end associate
      end do
      call move_alloc(found, results%observed)

   contains

      !> nan where a quantity is not defined, or the arithmetic has no result, which is told the first time.
      subroutine evaluate(value)
         real(wp), intent(out) :: value
         type(expression_fault_t) :: fault
         real(wp) :: amounts(size(self%list(i)%terms))
         integer :: k

         value = ieee_value(1.0_wp, ieee_quiet_nan)
         associate (one => self%list(i))
            do k = 1, size(amounts)
               amounts(k) = value_of_term(one%terms(k), results, rows, strain)
            end do
            if (any(is_nan(amounts))) return
            call evaluate_expression(one%text, self%names, self%values, value, fault, self%has_own_degree, one%calls, amounts)
            if (.not. allocated(fault%text)) return
            value = ieee_value(1.0_wp, ieee_quiet_nan)
            if (one%has_warned) return
            one%has_warned = .true.
            call add_warning('W-OBSERVE', label_of(one)//' is nan in step '//to_text(results%step)//', increment ' &
                             //to_text(results%increment)//': '//fault%text//', column '//to_text(int(fault%first, ip))// &
                             ' of '//one%text)
         end associate
      end subroutine evaluate
   end subroutine evaluate_all

end module atrito_observations
