!> How a report looks: on wide and narrow screens, light and dark, and on paper.
module atrito_report_style
   use atrito_page, only: page_t, add_line
   implicit none (type, external)
   private
   public :: add_style

   character(len=1), parameter :: LF = achar(10)
   !> First for all screens, then narrow ones, then paper.
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
      'th,td{padding:.18em .45em}pre{font-size:11px}figure img{max-width:none;width:640px}}'//LF// &
      '@page{size:A4;margin:14mm 13mm}'//LF// &
      '@media print{:root{color-scheme:light;--paper:#fff;--ink:#000;--soft:#444;--line:#bbb;--panel:#f6f6f6;--good:#064;'//LF// &
      '--good-paper:#fff;--bad:#900;--bad-paper:#fff;--accent:#0b5cad}'//LF// &
      'body{font-size:10pt}main{max-width:none;padding:0}nav{display:none}'//LF// &
      'h1{font-size:16pt}h2{font-size:13pt;margin-top:1.4em}h2,h3,.note{break-after:avoid}footer{margin-top:1em}'//LF// &
      '.verdict{border:1px solid;border-left-width:6px}'//LF// &
      'figure,.tiles div,.plain div,table,tr,.verdict,svg.chart{break-inside:avoid}'//LF// &
      'figure{margin:.6em 0 1em}figure img{width:auto;max-width:100%;max-height:225mm;border:0;margin:0 auto}'//LF// &
      'thead{display:table-header-group}'//LF// &
      '.scroll{overflow:visible}table{font-size:7pt}th,td{padding:.12em .45em}table.wide{font-size:6pt}'//LF// &
      'table.wide th,table.wide td{padding:.1em .3em}'//LF//'svg.chart{min-width:0;max-width:150mm}'//LF// &
      '.tiles{grid-template-columns:repeat(4,1fr);gap:2mm}.tiles dd{font-size:11pt}'//LF// &
      'pre{white-space:pre-wrap;font-size:6.6pt;border:0;padding:0}}'

contains

   !> The element `style` of a page.
   pure subroutine add_style(page)
      type(page_t), intent(inout) :: page

      call add_line(page, '<style>'//LF//STYLE//LF//'</style>')
   end subroutine add_style

end module atrito_report_style
