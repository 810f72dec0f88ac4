!> What a mutation puts into a deck: words of the deck language, numbers that a careless reader bends, characters that no deck
!> should hold.
module fuzz_words
   use atrito_foreign_keywords, only: foreign_keywords, FOREIGN_IGNORED, FOREIGN_OUTSIDE
   use atrito_keyword, only: keyword_t
   use atrito_keyword_table, only: keyword_table
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, append_string
   implicit none (type, external)
   private
   public :: dictionary_t, build_dictionary

   character(len=1), parameter :: NEW_LINE_CHARACTER = achar(10)

   type :: dictionary_t
      type(string_t), allocatable :: lines(:)          !< keyword lines, each with its end
      type(string_t), allocatable :: items(:)          !< anything between two commas
   end type dictionary_t

   character(len=22), parameter :: NUMBERS(68) = [character(len=22) :: '0', '-0', '+0', '1', '-1', '2', '3', '4', '5', '9', '1.', &
                     '.5', '.', '-', '+', '0.5', '0.4999999999999999', '1e999', '-1e999', '1d-400', '1e-308', '4.9e-324', '1e308', &
            '1.7976931348623157e308', '1.7976931348623159e308', '1e60', '-1e60', '1e150', '1e-150', '1e-15', '1e15', 'nan', 'NaN', &
                  'inf', '-Infinity', '3*2', '2/3', '1+5', '1,5', '1e', '1e+', '1d5d5', '0x10', '1e99999999999', '1e-99999999999', &
                   '0e99999999999', '2147483647', '-2147483647', '2147483648', '-2147483648', '4294967296', '9223372036854775808', &
          '99999999999999999999', '1073741824', '50000000', '1000000', '100000', '1000', '100', '17', '7', '12', '6', '8', '1e-6', &
                                                                                                 '1e6', '000000000000000001', '1.0']
   character(len=28), parameter :: ODDITIES(40) = [character(len=28) :: '<nu>', '<q>', '<x1>', '-<nu>', '<', '>', '<>', '-<', &
        '<nosuch>', '--<nu>', '<nu', 'nu>', '"', '""', '"a b"', '"a,b"', 'a"b', '=', '==', 'a=b', '*', '**', '***', '&', '!', '#', &
                                   '/', '\', '%', '(', ')', 'x', 'y', 'x**2', 'x/y', 'sqrt(-x)', ' ', ',', ',,', ',,,,,,,,,,,,,,,,']
   character(len=24), parameter :: NAMES(38) = [character(len=24) :: 'ALL', 'OVER', 'SPAN', 'SUPPORT', 'PLATE', 'BLOCK', &
                    'BOTTOM', 'MIDDLE', 'TOP', 'PILLAR', 'OVER-BOTTOM', 'OVER-TOP', 'SUPPORT-TOP', 'SUPPORT-BOTTOM', 'SPAN-RIGHT', &
           'SPAN-TOP', 'BLOCK-LEFT', 'JOINT', 'FLOOR', 'STEEL', 'S1', 'S2', 'S3', 'S4', 'S5', 'P', 'P1', 'P3', 'BX', 'BY', 'GRAV', &
                                                                                  'START', 'LINE', 'CIRCL', 'GRADE', 'X', 'Y', 'RF']
   !> Of parts, instances and other programs.
   character(len=48), parameter :: FOREIGN_LINES(30) = [character(len=48) :: '*PART, NAME=Block', '*PART, NAME=P1', &
                                           '*END PART', '*ASSEMBLY, NAME=A', '*END ASSEMBLY', '*INSTANCE, NAME=Lower, PART=Block', &
                          '*INSTANCE, NAME=I1, PART=P1', '*INSTANCE', '*END INSTANCE', '*INCLUDE, INPUT=fuzz-deck.inp, TYPE=GMSH', &
                                              '*STEP, NLGEOM', '*STEP, PERTURBATION', '*END STEP', '*SURFACE, NAME=S9, TYPE=NODE', &
                            '*ELASTIC, TYPE=ENGINEERING CONSTANTS', '*ELASTIC, TYPE=ORTHO', '*BOUNDARY, OP=NEW', '*CLOAD, OP=NEW', &
                   '*ELEMENT, TYPE=T3D2, ELSET=L', '*ELEMENT, TYPE=C3D8', '*ELEMENT, TYPE=M3D4', '*NSET, NSET=N1, INSTANCE=Lower', &
                '*ELSET, ELSET=E1, INSTANCE=Lower, GENERATE', '*OUTPUT, FIELD', '*NODE OUTPUT', '*SOLID SECTION, NODAL THICKNESS', &
                                  '*CONTACT PAIR, INTERACTION=I, SMALL SLIDING', '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR', &
                                                                                     '*TRANSFORM, NSET=ALL', '*ORIENTATION, NAME=O']
   character(len=32), parameter :: FOREIGN_ITEMS(46) = [character(len=32) :: 'INSTANCE=Lower', 'INSTANCE=Upper', 'PART=Block', &
                        'Lower.Head', 'Upper.12', 'Assembly.Lower.Set-1', 'Lower.', '.Head', 'Lower.Lower.Head', '..', 'Part-1-1', &
                          'Part-1', 'Set-1', 'TYPE=NODE', 'TYPE=GMSH', 'ELEMENTS=CAX', 'TYPE=ENGINEERING CONSTANTS', 'TYPE=ORTHO', &
               'ENCASTRE', 'PINNED', 'XSYMM', 'YSYMM', 'ZASYMM', 'T3D2', 'M3D4', 'C3D8', 'B21', 'S4R', 'DCC2D4', 'CPE4H', 'CPS4I', &
                             'OP=NEW', 'NLGEOM', 'NLGEOM=NO', 'GENERATE', 'INTERNAL', 'UNSORTED', 'CENTRIF', 'ORIENTATION=turned', &
                                                   'NODAL THICKNESS', '<q*2>', '<sin(30*deg)>', '<-a/2>', '<min(1, 2)>', '<1', 'S3']
   character(len=48), parameter :: EXPRESSIONS(14) = [character(len=48) :: 'p1 = 1', 'p1 = p2', 'p2 = p1', 'p1 = p1', 'q = 1/0', &
            'q = 1e308*10', 'q = (((((1', 'q = 2**-2**3', 'q = ----1', 'q = sqrt(-1)', 'q = min()', 'q = atan(1,2)', 'x = 3', '= 3']

contains

   !> Everything in the keyword table, with and without values, and the lists above.
   subroutine build_dictionary(dictionary)
      type(dictionary_t), intent(out) :: dictionary
      type(keyword_t), allocatable :: keywords(:)
      integer(ip) :: i

      allocate (dictionary%lines(0), dictionary%items(0))
      keywords = keyword_table()
      do i = 1, size(keywords, kind=ip)
         call add_keyword(keywords(i), dictionary)
      end do
      call add_words(NUMBERS, dictionary%items)
      call add_words(ODDITIES, dictionary%items)
      call add_words(NAMES, dictionary%items)
      call add_words(NUMBERS, dictionary%items)            ! twice: they are what matters most
      call add_words(FOREIGN_ITEMS, dictionary%items)
      call add_controls(dictionary%items)
      do i = 1, size(FOREIGN_LINES, kind=ip)
         call append_string(dictionary%lines, trim(FOREIGN_LINES(i))//NEW_LINE_CHARACTER)
      end do
      call add_names(foreign_keywords(FOREIGN_IGNORED), dictionary%lines)
      call add_names(foreign_keywords(FOREIGN_OUTSIDE), dictionary%lines)
      do i = 1, size(EXPRESSIONS, kind=ip)
         call append_string(dictionary%lines, '*PARAMETER'//NEW_LINE_CHARACTER//trim(EXPRESSIONS(i))//NEW_LINE_CHARACTER)
      end do
   end subroutine build_dictionary

   pure subroutine add_words(words, list)
      character(len=*), intent(in) :: words(:)
      type(string_t), allocatable, intent(inout) :: list(:)
      integer :: i

      do i = 1, size(words)
         call append_string(list, trim(words(i)))
      end do
   end subroutine add_words

   pure subroutine add_names(names, list)
      type(string_t), intent(in) :: names(:)
      type(string_t), allocatable, intent(inout) :: list(:)
      integer :: i

      do i = 1, size(names)
         call append_string(list, '*'//names(i)%s//NEW_LINE_CHARACTER)
      end do
   end subroutine add_names

   pure subroutine add_keyword(keyword, dictionary)
      type(keyword_t), intent(in) :: keyword
      type(dictionary_t), intent(inout) :: dictionary
      integer :: i, k

      call append_string(dictionary%lines, '*'//keyword%name//NEW_LINE_CHARACTER)
      call append_string(dictionary%items, '*'//keyword%name)
      do i = 1, size(keyword%options)
         call append_string(dictionary%lines, '*'//keyword%name//', '//keyword%options(i)%name//'=ALL'//NEW_LINE_CHARACTER)
         call append_string(dictionary%items, keyword%options(i)%name)
         call append_string(dictionary%items, keyword%options(i)%name//'=2')
         do k = 1, size(keyword%options(i)%choices)
            call append_string(dictionary%items, keyword%options(i)%name//'='//keyword%options(i)%choices(k)%name)
         end do
      end do
   end subroutine add_keyword

   !> Ends of lines, control characters, UTF-8 (also broken), very long names.
   pure subroutine add_controls(items)
      type(string_t), allocatable, intent(inout) :: items(:)

      call append_string(items, NEW_LINE_CHARACTER)
      call append_string(items, NEW_LINE_CHARACTER//'*')
      call append_string(items, ','//NEW_LINE_CHARACTER)
      call append_string(items, achar(13)//NEW_LINE_CHARACTER)
      call append_string(items, achar(13))
      call append_string(items, achar(9))
      call append_string(items, achar(0))
      call append_string(items, achar(27)//'[2J')
      call append_string(items, achar(127))
      call append_string(items, char(195)//char(164))
      call append_string(items, char(195))
      call append_string(items, char(226)//char(130))
      call append_string(items, char(239)//char(187)//char(191))
      call append_string(items, char(255)//char(254))
      call append_string(items, repeat('a', 79))
      call append_string(items, repeat('b', 80))
      call append_string(items, repeat('c', 81))
      call append_string(items, repeat('d', 300))
      call append_string(items, repeat('9', 400))
      call append_string(items, '0.'//repeat('0', 400)//'1')
      call append_string(items, repeat('(', 200))
      call append_string(items, '"'//repeat('q', 500))
   end subroutine add_controls

end module fuzz_words
