!> Words of Abaqus and CalculiX in data lines: what requests of output have besides, and keywords that may have no data lines.
module atrito_foreign_words
   implicit none (type, external)
   private
   public :: is_foreign_variable, variable_of_component, may_be_empty

   !> What *NODE PRINT, *NODE FILE, *EL PRINT and *EL FILE of CalculiX and Abaqus write besides.
   character(len=6), parameter :: VARIABLES(*) = [character(len=6) :: 'A', 'BHE', 'CEEQ', 'CENT', 'CF', 'COOR', 'COORD', 'CP', &
                                                                                                                     'DEPF', &
           'DEPT', 'E', 'EBHE', 'ECD', 'EE', 'ELKE', 'ELSE', 'EMAS', 'EMFB', 'EMFE', 'ENER', 'EPD', 'ERR', 'EVOL', 'FLUX', 'HCRI', &
             'HER', 'HFL', 'HFLF', 'KEQ', 'LE', 'MACH', 'MAXE', 'MAXS', 'MAXU', 'ME', 'MF', 'MISES', 'MOM', 'NOE', 'NT', 'PDNTDF', &
              'PE', 'PEEQ', 'PHS', 'PNT', 'POT', 'PRF', 'PS', 'PSF', 'PT', 'PTF', 'PU', 'RFL', 'SDV', 'SEN', 'SF', 'SINV', 'SMID', &
                                         'SNEG', 'SOF', 'SPOS', 'SVF', 'SVOL', 'THE', 'TS', 'TSF', 'TT', 'TTF', 'TURB', 'V', 'VF', &
                                                                           'ZZS', 'EP', 'RF3', 'RM', 'S13', 'S23', 'SP', 'U3', 'UR']

   !> Keywords that may stand without data lines: preprocessors write them for what the model does not have.
   character(len=18), parameter :: EMPTY(*) = [character(len=18) :: 'BOUNDARY', 'CLOAD', 'DLOAD', 'DSLOAD', 'TEMPERATURE', &
                                 'INITIAL CONDITIONS', 'NODE PRINT', 'EL PRINT', 'NODE FILE', 'EL FILE', 'CONTACT PAIR', 'EQUATION']

contains

   !> A variable of a request that other programs write, or a component of one: E, E11.
   pure logical function is_foreign_variable(word)
      character(len=*), intent(in) :: word         !< in capitals
      integer :: digits

      digits = len(word) - verify(word, '123', back=.true.)
      is_foreign_variable = any(VARIABLES == word) .or. (digits <= 2 .and. any(VARIABLES == word(:len(word) - digits)))
   end function is_foreign_variable

   !> The variable of which a word is a component in the plane, as Abaqus has it: U of U1, RF of RF2, S of S12; '' of others.
   pure function variable_of_component(word) result(variable)
      character(len=*), intent(in) :: word         !< in capitals
      character(len=:), allocatable :: variable

      select case (word)
      case ('U1', 'U2')
         variable = 'U'
      case ('RF1', 'RF2')
         variable = 'RF'
      case ('S11', 'S22', 'S33', 'S12')
         variable = 'S'
      case default
         variable = ''
      end select
   end function variable_of_component

   !> The keyword may have no data lines.
   pure logical function may_be_empty(keyword)
      character(len=*), intent(in) :: keyword      !< as in the table

      may_be_empty = any(EMPTY == keyword)
   end function may_be_empty

end module atrito_foreign_words
