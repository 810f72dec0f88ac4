!> What a report is made of: what its maker knows, and the names of the files from which the rest is read.
module atrito_report
   use atrito_html, only: fact_t
   use atrito_page, only: page_t
   use atrito_strings, only: string_t
   use atrito_model, only: units_t
   implicit none (type, external)
   private
   public :: report_t, page_section_t, begin_section, add_section

   !> A part of the page with a heading.
   type :: page_section_t
      character(len=:), allocatable :: title        !< plain text
      type(page_t) :: page                          !< lines of HTML
   end type page_section_t

   !> What the maker of a report knows; the rest is read from the folder.
   type :: report_t
      character(len=:), allocatable :: what         !< run, sweep, study, limit
      character(len=:), allocatable :: deck         !< as the user wrote it
      character(len=:), allocatable :: folder       !< of the tables, and of the report
      character(len=:), allocatable :: command      !< that was given; not allocated: not known
      type(string_t), allocatable :: heading(:)     !< of the deck
      logical :: is_good = .false.                  !< solved and checked
      character(len=:), allocatable :: verdict      !< in few words
      type(string_t), allocatable :: details(:)     !< of the verdict
      type(fact_t), allocatable :: facts(:)         !< key numbers
      type(page_section_t), allocatable :: leading(:)    !< sections that stand before the pictures
      type(page_section_t), allocatable :: sections(:)   !< those that stand behind them
      character(len=:), allocatable :: other_messages   !< where there are more messages; not allocated: nowhere
      type(string_t), allocatable :: pairs(:)       !< names of contact pairs
      type(string_t), allocatable :: files(:)       !< in the folder, without pictures
      type(string_t), allocatable :: pictures(:)    !< that were drawn, names without ending
      type(fact_t), allocatable :: versions(:)      !< of the compiler and the libraries
      type(units_t) :: units                        !< of the deck
   end type report_t

contains

   !> A section without lines.
   pure subroutine begin_section(section, title)
      type(page_section_t), intent(out) :: section  !< without lines
      character(len=*), intent(in) :: title         !< plain text

      section%title = title
      allocate (section%page%lines(64))
   end subroutine begin_section

   !> Adds a section that has lines.
   pure subroutine add_section(sections, section)
      type(page_section_t), allocatable, intent(inout) :: sections(:) !< become longer by one; not allocated: empty
      type(page_section_t), intent(in) :: section   !< without lines: nothing is added

      if (section%page%n == 0) return
      if (.not. allocated(sections)) allocate (sections(0))
      sections = [sections, section]
   end subroutine add_section

end module atrito_report
