!> How a report looks: on wide and narrow screens, light and dark, and on paper.
module atrito_report_style
   use atrito_page, only: page_t, add_line
   implicit none (type, external)
   private
   public :: add_style

   character(len=*), parameter :: COMMON(52) = [character(len=124) :: &
         ':root{color-scheme:light dark;--paper:#fff;--ink:#1b222c;--soft:#58626f;--line:#d5dbe3;--panel:#f4f6f9;--good:#0b6847;', &
                                                '--good-paper:#e4f4ec;--bad:#9c2408;--bad-paper:#fdebe5;--accent:#0b5cad}', &
          '@media (prefers-color-scheme:dark){:root{--paper:#14181d;--ink:#e4e8ee;--soft:#a0aab8;--line:#38414d;--panel:#1d232b;', &
                                       '--good:#6fd3a6;--good-paper:#12301f;--bad:#ff9d80;--bad-paper:#3d1a10;--accent:#7db8f5}}', &
                                                '*{box-sizing:border-box}', &
            'body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,"Segoe UI","DejaVu Sans",sans-serif}', &
                                                'main{max-width:1080px;margin:0 auto;padding:24px 20px 60px}', &
                                                'h1{font-size:1.7rem;line-height:1.25;margin:.1em 0 .2em;overflow-wrap:anywhere}', &
                                      'h2{font-size:1.25rem;margin:2em 0 .6em;padding-top:.5em;border-top:2px solid var(--line)}', &
                                                'h3{font-size:1rem;margin:1.4em 0 .3em}', &
                                                'p,li,dd,dt,td,th,figcaption{overflow-wrap:anywhere}', &
                                                'p{margin:.4em 0}', &
                                                'ul{padding-left:1.2em}', &
                                                '.small,figcaption,.note{color:var(--soft);font-size:.85rem}', &
                                                '.kind{color:var(--soft);font-size:.9rem;margin:0}', &
                                                '.verdict{border-left:6px solid;border-radius:4px;padding:.7em 1em;margin:1em 0}', &
                                                '.verdict strong{font-size:1.1rem}', &
                                                '.good{color:var(--good);background:var(--good-paper)}', &
                                                '.bad{color:var(--bad);background:var(--bad-paper)}', &
                                                '.bad strong{font-size:1.3rem}', &
                                                'nav{font-size:.9rem}', &
                                                'nav a{color:var(--accent);margin-right:1em;display:inline-block}', &
                                                'dl{margin:0}', &
                                                'dd{margin:0}', &
                                        '.tiles{display:grid;grid-template-columns:repeat(auto-fill,minmax(190px,1fr));gap:10px}', &
                           '.tiles div{background:var(--panel);border:1px solid var(--line);border-radius:6px;padding:.6em .8em}', &
                                                '.tiles dt{color:var(--soft);font-size:.85rem}', &
                                                '.tiles dd{font-size:1.15rem;font-weight:600;font-variant-numeric:tabular-nums}', &
                                                '.tiles dd.small{font-size:.8rem;font-weight:400}', &
            '.plain div{display:grid;grid-template-columns:minmax(90px,190px) 1fr;gap:0 1em;border-bottom:1px solid var(--line);', &
                                                'padding:.25em 0}', &
                                                '.plain dt{color:var(--soft)}', &
                                                '.plain dd.small{grid-column:2}', &
                                                'figure{margin:1em 0 1.6em}', &
            'figure img{display:block;max-width:100%;height:auto;background:#fff;border:1px solid var(--line);border-radius:4px}', &
                                                'figcaption{margin-top:.4em}', &
                                                '.scroll{overflow-x:auto;margin:.4em 0;max-width:100%}', &
                                                '.scroll:focus-visible{outline:2px solid var(--accent)}', &
                                             'table{border-collapse:collapse;font-size:.84rem;font-variant-numeric:tabular-nums}', &
                              'th,td{padding:.18em .7em;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}', &
                    'thead th{border-bottom:2px solid var(--line);vertical-align:bottom;white-space:normal;overflow-wrap:normal}', &
                                                'tbody th{font-weight:500;text-align:left}', &
                                                'thead .unit th,td.unit{color:var(--soft);font-weight:400}', &
                                                '.word{text-align:left}', &
                       'pre{overflow-x:auto;background:var(--panel);border:1px solid var(--line);border-radius:6px;padding:.8em;', &
                                                'font:13px/1.4 "DejaVu Sans Mono",Menlo,Consolas,monospace}', &
                                                'svg.chart{display:block;min-width:560px;width:100%;max-width:900px;height:auto}', &
                                                '.chart text{fill:var(--ink);font-size:13px}', &
                                                '.chart .grid{stroke:var(--line);stroke-width:1}', &
                                                '.chart .curve{fill:none;stroke:var(--accent);stroke-width:1.8}', &
                                                '.chart .dot{fill:var(--accent)}', &
                                                'footer{margin-top:3em;color:var(--soft);font-size:.85rem}']

   character(len=*), parameter :: NARROW(4) = [character(len=124) :: &
                                               '@media (max-width:520px){main{padding:14px 12px 40px}h1{font-size:1.35rem}', &
                                               '.tiles{grid-template-columns:1fr 1fr;gap:8px}.tiles dd{font-size:1rem}', &
                                               '.plain div{grid-template-columns:1fr}.plain dd.small{grid-column:1}', &
                                             'th,td{padding:.18em .45em}pre{font-size:11px}figure img{max-width:none;width:640px}}']

   character(len=*), parameter :: PRINT(14) = [character(len=124) :: &
                                               '@page{size:A4;margin:14mm 13mm}', &
             '@media print{:root{color-scheme:light;--paper:#fff;--ink:#000;--soft:#444;--line:#bbb;--panel:#f6f6f6;--good:#064;', &
                                               '--good-paper:#fff;--bad:#900;--bad-paper:#fff;--accent:#0b5cad}', &
                                               'body{font-size:10pt}main{max-width:none;padding:0}nav{display:none}', &
                      'h1{font-size:16pt}h2{font-size:13pt;margin-top:1.4em}h2,h3,.note{break-after:avoid}footer{margin-top:1em}', &
                                               '.verdict{border:1px solid;border-left-width:6px}', &
                                               'figure,.tiles div,.plain div,table,tr,.verdict,svg.chart{break-inside:avoid}', &
                         'figure{margin:.6em 0 1em}figure img{width:auto;max-width:100%;max-height:225mm;border:0;margin:0 auto}', &
                                               'thead{display:table-header-group}', &
                               '.scroll{overflow:visible}table{font-size:7pt}th,td{padding:.12em .45em}table.wide{font-size:6pt}', &
                                               'table.wide th,table.wide td{padding:.1em .3em}', &
                                               'svg.chart{min-width:0;max-width:150mm}', &
                                               '.tiles{grid-template-columns:repeat(4,1fr);gap:2mm}.tiles dd{font-size:11pt}', &
                                               'pre{white-space:pre-wrap;font-size:6.6pt;border:0;padding:0}}']

contains

   !> The element `style` of a page.
   pure subroutine add_style(page)
      type(page_t), intent(inout) :: page

      call add_line(page, '<style>')
      call add_lines(page, COMMON)
      call add_lines(page, NARROW)
      call add_lines(page, PRINT)
      call add_line(page, '</style>')
   end subroutine add_style

   pure subroutine add_lines(page, lines)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: lines(:)
      integer :: i

      do i = 1, size(lines)
         call add_line(page, trim(lines(i)))
      end do
   end subroutine add_lines

end module atrito_report_style
