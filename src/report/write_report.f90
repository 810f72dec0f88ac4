!> Writes report.html: all that a folder of output tells, on one page that needs nothing else.
!>
!> Comes after tables and pictures, which are complete whatever happens here: every failure is a warning, W-REPORT. What has rows
!> is read from the folder, so that a table or picture that is new appears without a change here.
module atrito_write_report
   use atrito_files, only: file_set_t, text_file_t, begin_files, open_text, put_line, close_text, end_files
   use atrito_html, only: add_element, html_text, shortened
   use atrito_kinds, only: ip
   use atrito_messages, only: add_warning
   use atrito_page, only: page_t, add_line, begin_page
   use atrito_report, only: report_t, page_section_t, begin_section, add_section
   use atrito_plot_files, only: REPORT_NAME
   use atrito_report_pictures, only: compose_pictures
   use atrito_report_sections, only: contents_t, read_contents, add_numbers, add_results, add_messages, add_sources
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text
   use atrito_model, only: name_units, units_t
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: write_report, compose_report, MOST_BYTES

   character(len=1), parameter :: LF = achar(10)
   !> How a report looks: on all screens, light and dark, then on narrow ones, then on paper.
   character(len=*), parameter :: STYLE = &
                       ':root{color-scheme:light dark;--paper:#fff;--ink:#1b222c;--soft:#58626f;--line:#d5dbe3;--panel:#f4f6f9;'// &
                                  '--good:#0b6847;'//LF// &
                                  '--good-paper:#e4f4ec;--bad:#9c2408;--bad-paper:#fdebe5;--accent:#0b5cad}'//LF// &
                         '@media (prefers-color-scheme:dark){:root{--paper:#14181d;--ink:#e4e8ee;--soft:#a0aab8;--line:#38414d;'// &
                                  '--panel:#1d232b;'//LF// &
                                  '--good:#6fd3a6;--good-paper:#12301f;--bad:#ff9d80;--bad-paper:#3d1a10;--accent:#7db8f5}}'//LF// &
                                  '*{box-sizing:border-box}'//LF// &
       'body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,"Segoe UI","DejaVu Sans",sans-serif}'//LF// &
                                  'main{max-width:1080px;margin:0 auto;padding:24px 20px 60px}'//LF// &
                                  'h1{font-size:1.7rem;line-height:1.25;margin:.1em 0 .2em;overflow-wrap:anywhere}'//LF// &
                                 'h2{font-size:1.25rem;margin:2em 0 .6em;padding-top:.5em;border-top:2px solid var(--line)}'//LF// &
                         'h3{font-size:1rem;margin:1.4em 0 .3em}'//LF//'p,li,dd,dt,td,th,figcaption{overflow-wrap:anywhere}'//LF// &
         'p{margin:.4em 0}'//LF//'ul{padding-left:1.2em}'//LF//'.small,figcaption,.note{color:var(--soft);font-size:.85rem}'//LF// &
                                  '.kind{color:var(--soft);font-size:.9rem;margin:0}'//LF// &
                                  '.verdict{border-left:6px solid;border-radius:4px;padding:.7em 1em;margin:1em 0}'//LF// &
                            '.verdict strong{font-size:1.1rem}'//LF//'.good{color:var(--good);background:var(--good-paper)}'//LF// &
                                  '.bad{color:var(--bad);background:var(--bad-paper)}'//LF//'.bad strong{font-size:1.3rem}'//LF// &
          'nav{font-size:.9rem}'//LF//'nav a{color:var(--accent);margin-right:1em;display:inline-block}'//LF//'dl{margin:0}'//LF// &
               'dd{margin:0}'//LF//'.tiles{display:grid;grid-template-columns:repeat(auto-fill,minmax(190px,1fr));gap:10px}'//LF// &
                      '.tiles div{background:var(--panel);border:1px solid var(--line);border-radius:6px;padding:.6em .8em}'//LF// &
                                  '.tiles dt{color:var(--soft);font-size:.85rem}'//LF// &
                                  '.tiles dd{font-size:1.15rem;font-weight:600;font-variant-numeric:tabular-nums}'//LF// &
                                  '.tiles dd.small{font-size:.8rem;font-weight:400}'//LF// &
       '.plain div{display:grid;grid-template-columns:minmax(90px,190px) 1fr;gap:0 1em;border-bottom:1px solid var(--line);'//LF// &
                                'padding:.25em 0}'//LF//'.plain dt{color:var(--soft)}'//LF//'.plain dd.small{grid-column:2}'//LF// &
                                  'figure{margin:1em 0 1.6em}'//LF// &
       'figure img{display:block;max-width:100%;height:auto;background:#fff;border:1px solid var(--line);border-radius:4px}'//LF// &
                                  'figcaption{margin-top:.4em}'//LF//'.scroll{overflow-x:auto;margin:.4em 0;max-width:100%}'//LF// &
                                  '.scroll:focus-visible{outline:2px solid var(--accent)}'//LF// &
                                  'table{border-collapse:collapse;font-size:.84rem;font-variant-numeric:tabular-nums}'//LF// &
                         'th,td{padding:.18em .7em;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}'//LF// &
               'thead th{border-bottom:2px solid var(--line);vertical-align:bottom;white-space:normal;overflow-wrap:normal}'//LF// &
                'tbody th{font-weight:500;text-align:left}'//LF//'thead .unit th,td.unit{color:var(--soft);font-weight:400}'//LF// &
                                  '.word{text-align:left}'//LF// &
                  'pre{overflow-x:auto;background:var(--panel);border:1px solid var(--line);border-radius:6px;padding:.8em;'//LF// &
                                  'font:13px/1.4 "DejaVu Sans Mono",Menlo,Consolas,monospace}'//LF// &
                                  'svg.chart{display:block;min-width:560px;width:100%;max-width:900px;height:auto}'//LF// &
                        '.chart text{fill:var(--ink);font-size:13px}'//LF//'.chart .grid{stroke:var(--line);stroke-width:1}'//LF// &
                     '.chart .curve{fill:none;stroke:var(--accent);stroke-width:1.8}'//LF//'.chart .dot{fill:var(--accent)}'//LF// &
                                  'footer{margin-top:3em;color:var(--soft);font-size:.85rem}'//LF// &
                                  '@media (max-width:520px){main{padding:14px 12px 40px}h1{font-size:1.35rem}'//LF// &
                                  '.tiles{grid-template-columns:1fr 1fr;gap:8px}.tiles dd{font-size:1rem}'//LF// &
                                  '.plain div{grid-template-columns:1fr}.plain dd.small{grid-column:1}'//LF// &
                                  'th,td{padding:.18em .45em}pre{font-size:11px}figure img{width:620px;max-width:none}}'//LF// &
                                  '@page{size:A4;margin:14mm 13mm}'//LF// &
        '@media print{:root{color-scheme:light;--paper:#fff;--ink:#000;--soft:#444;--line:#bbb;--panel:#f6f6f6;--good:#064;'//LF// &
                                  '--good-paper:#fff;--bad:#900;--bad-paper:#fff;--accent:#0b5cad}'//LF// &
                     'body{font-size:9pt;line-height:1.3;orphans:1;widows:1}main{max-width:none;padding:0}nav{display:none}'//LF// &
              'h1{font-size:16pt}h2{font-size:12pt;margin:.8em 0 .3em;padding-top:.3em}h3{font-size:9pt;margin:.6em 0 .2em}'//LF// &
                                 'h2,h3,h2+.note{break-after:avoid}footer{margin-top:1em}section:has(details){display:none}'//LF// &
                                  '.verdict{border:1px solid;border-left-width:6px}'//LF// &
                                  'figure,.whole,.tiles div,.plain div,table,tr,.verdict,svg.chart{break-inside:avoid}'//LF// &
                             '.pictures{display:grid;grid-template-columns:1fr 1fr;gap:4mm 6mm}figure{margin:0;min-width:0}'//LF// &
                                  'figure img{width:auto;max-width:100%;max-height:80mm;border:0;margin:0 auto}'//LF// &
                                  '.whole{display:inline-block;vertical-align:top;width:min-content;margin-right:4mm}'//LF// &
                         'thead{display:table-header-group}figcaption,.note{font-size:7.5pt}.plain{font-size:8pt;columns:2}'//LF// &
                                  '.scroll{overflow:visible}table{font-size:6.5pt;line-height:1.15}'//LF// &
                           'th,td{padding:.1em .4em}table.wide{font-size:6pt}table.wide th,table.wide td{padding:.1em .3em}'//LF// &
                                  'svg.chart{min-width:0;width:90mm}'//LF// &
                                  '.tiles{grid-template-columns:repeat(5,1fr);gap:1.5mm}.tiles dd{font-size:10pt}'//LF// &
                                  '.tiles div{padding:.3em .5em}.tiles dt,.tiles dd.small{font-size:7.5pt}'//LF// &
                                  '.plain div{grid-template-columns:20mm 1fr}pre.deck{columns:2;font-size:5.7pt}'//LF// &
                                  'pre{white-space:pre-wrap;font-size:6.2pt;border:0;padding:0;margin:.3em 0}}'

   integer, parameter :: MOST_BYTES = 3000000       !< of the page
   integer, parameter :: MOST_HEADING = 20          !< lines
   integer, parameter :: LONGEST_LINE = 1000

contains

   !> Writes the report into its folder. is_written is false where it could not be, which is a warning.
   subroutine write_report(report, date, is_written)
      type(report_t), intent(in) :: report          !< as its maker filled it
      character(len=*), intent(in) :: date          !< and time
      logical, intent(out) :: is_written            !< false: there is no file, and a warning
      type(file_set_t) :: set
      type(text_file_t) :: file
      type(status_t) :: status
      type(page_t) :: page
      integer :: i

      call compose_report(report, date, page)
      call begin_files(set, report%folder, status)
      if (is_ok(status)) then
         call open_text(set, REPORT_NAME, file)
         do i = 1, page%n
            call put_line(file, page%lines(i)%s)
         end do
         call close_text(file, status)
         call end_files(set, status)
      end if
      is_written = is_ok(status)
      if (.not. is_written) call add_warning('W-REPORT', 'no report is written: '//status%text)
   end subroutine write_report

   !> Composes the page, without writing it.
   subroutine compose_report(report, date, page)
      type(report_t), intent(in) :: report          !< as its maker filled it
      character(len=*), intent(in) :: date          !< and time
      type(page_t), intent(out) :: page             !< the whole file
      type(page_section_t), allocatable :: before(:), behind(:), sections(:)
      type(page_section_t) :: pictures
      type(contents_t) :: contents
      integer :: i, line

      call read_contents(report, contents)
      call add_numbers(report, contents, before)
      call append_sections(before, report%leading)
      call append_sections(behind, report%sections)
      call add_results(report, contents, behind)
      call name_all(report%units, before)
      call name_all(report%units, behind)
      call add_messages(report, behind)
      call add_sources(report, contents, behind)
      call compose_top(report, date, page)
      call begin_section(pictures, 'Pictures')
      call compose_pictures(report%folder, report%pictures, MOST_BYTES - size_of_page(page) - size_of_sections(before) &
                            - size_of_sections(behind), pictures%page)
      if (size(report%pictures) == 0) call add_element(pictures%page, 'p', 'There are no pictures; the messages tell why.')
      call add_section(before, pictures)
      sections = [before, behind]
      call add_line(page, '<nav aria-label="sections">')
      do i = 1, size(sections)
         call add_line(page, '<a href="#s'//to_text(int(i, ip))//'">'//html_text(sections(i)%title)//'</a>')
      end do
      call add_line(page, '</nav>')
      do i = 1, size(sections)
         call add_line(page, '<section id="s'//to_text(int(i, ip))//'">')
         call add_element(page, 'h2', sections(i)%title)
         do line = 1, sections(i)%page%n
            call add_line(page, sections(i)%page%lines(line)%s)
         end do
         call add_line(page, '</section>')
      end do
      call add_line(page, '<footer><p>'//PROGRAM_NAME//' '//PROGRAM_VERSION//', '//html_text(date)//'</p></footer>')
      call add_line(page, '</main></body></html>')
   end subroutine compose_report

   !> The units of numbers and tables.
   pure subroutine name_all(units, sections)
      type(units_t), intent(in) :: units
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      integer :: i, line

      if (.not. allocated(sections)) return
      do i = 1, size(sections)
         do line = 1, sections(i)%page%n
            call name_units(units, sections(i)%page%lines(line)%s)
         end do
      end do
   end subroutine name_all

   pure subroutine append_sections(sections, others)
      type(page_section_t), allocatable, intent(inout) :: sections(:)
      type(page_section_t), intent(in), optional :: others(:)
      integer :: i

      if (.not. present(others)) return
      do i = 1, size(others)
         call add_section(sections, others(i))
      end do
   end subroutine append_sections

   !> What comes before the sections: the head, by which nothing is fetched from anywhere and no script is run, title and verdict.
   subroutine compose_top(report, date, page)
      type(report_t), intent(in) :: report
      character(len=*), intent(in) :: date
      type(page_t), intent(out) :: page
      character(len=:), allocatable :: title
      integer :: i, first

      call begin_page(page, 80)
      title = file_name(report%deck)
      first = 1
      if (size(report%heading) > 0) then
         if (len_trim(report%heading(1)%s) > 0) then
            title = trim(report%heading(1)%s)
            first = 2
         end if
      end if
      title = shortened(title, LONGEST_LINE)
      call add_line(page, '<!DOCTYPE html>')
      call add_line(page, '<html lang="en"><head><meta charset="utf-8">')
      call add_line(page, '<meta name="viewport" content="width=device-width, initial-scale=1">')
      call add_line(page, '<meta name="generator" content="'//PROGRAM_NAME//' '//PROGRAM_VERSION//'">')
      call add_line(page, '<meta http-equiv="Content-Security-Policy" content="default-src ''none''; img-src data:; '// &
                    'style-src ''unsafe-inline''">')
      call add_element(page, 'title', title)
      call add_line(page, '<style>'//LF//STYLE//LF//'</style>')
      call add_line(page, '</head><body><main>')
      call add_element(page, 'p', PROGRAM_NAME//' '//PROGRAM_VERSION//', '//report%what//' of '//file_name(report%deck)// &
                       ', '//date, ' class="kind"')
      call add_element(page, 'h1', title)
      do i = first, min(size(report%heading), MOST_HEADING)
         call add_element(page, 'p', shortened(report%heading(i)%s, LONGEST_LINE))
      end do
      call add_line(page, '<div class="verdict '//trim(merge('good', 'bad ', report%is_good))//'">')
      call add_line(page, '<p><strong>'//html_text(report%verdict)//'</strong></p>')
      do i = 1, size(report%details)
         call add_element(page, 'p', report%details(i)%s)
      end do
      call add_line(page, '</div>')
   end subroutine compose_top

   pure function file_name(path) result(name)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: name

      name = path(index(path, '/', back=.true.) + 1:)
   end function file_name

   !> Bytes, with the ends of the lines and what stands round a section.
   pure integer function size_of_sections(sections) result(n)
      type(page_section_t), intent(in), optional :: sections(:)
      integer :: i

      n = 0
      if (.not. present(sections)) return
      do i = 1, size(sections)
         n = n + size_of_page(sections(i)%page) + 3*len(sections(i)%title) + 200
      end do
   end function size_of_sections

   pure integer function size_of_page(page) result(n)
      type(page_t), intent(in) :: page
      integer :: i

      n = 0
      do i = 1, page%n
         n = n + len(page%lines(i)%s) + 1
      end do
   end function size_of_page

end module atrito_write_report
