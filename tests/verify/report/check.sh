. "$(dirname "$0")/../lib.sh"
ex1=$input/ex1-plate-on-support.inp
judge=$here/check_page.py

quick_pictures
[ "$have_gnuplot" = yes ] || echo 'gnuplot is not installed: pages without pictures are checked'

# page FOLDER PICTURES [TEXT ...]: the page of a folder is sound and tells the texts.
page() {
   folder=$1
   pictures=$2
   [ "$have_gnuplot" = yes ] || pictures=0
   shift 2
   set -- "$@" end
   while [ "$1" != end ]; do set -- "$@" --has "$1"; shift; done
   shift
   python3 "$judge" --pictures "$pictures" "$@" "$folder/report.html" || complain "$folder/report.html"
}

# series COMMAND FOLDER CODE [options]: a sweep, study or limit.
series() {
   command=$1
   folder=$2
   wanted=$3
   shift 3
   rm -rf "$folder"
   "$atrito" "$command" "$@" -o "$folder" >"$folder.out" 2>"$folder.err"
   found=$?
   [ "$found" -eq "$wanted" ] || { complain "$command $*: exit $found"; cat "$folder.err"; }
}

sh "$here/must_fail.sh" "$judge" || complain 'the judge of pages'

# a run: what it tells
fine contour-mises.gp run 0 "$ex1" plate --report --set nu=0.25
page plate 9 'Plate on its support' 'run of ex1-plate-on-support.inp' 'Solved and checked' 'support reactions, sum' '0, 1.5' 'Contact pairs' \
   'pair 1: OVER-BOTTOM on SUPPORT-TOP' 'strain_energy' 'reactions' 'The first 20 of 145 rows; all are in nodes.tab' 'Convergence' 'Times' \
   'No warnings, no notes' '--set nu=0.25' 'BLAS' 'ex1-plate-on-support.lst' 'WHAT WAS UNDERSTOOD' \
   '*BLOCK, TYPE=CPE4, ELSET=OVER' 'all digits are in the files'
grep -q 'largest displacement</dt><dd>[0-9.e-]*.\[L\]' plate/report.html || complain 'a key number has no dimension'
says 'screen' plate.out 'report       plate/report.html'
says 'progress' plate.err 'report plate/report.html'
[ -e plate/plots/mesh.gp ] || complain '--report draws no pictures'
# beside the force of a bolt the digits of a sum are nothing
"$atrito" "$input/lessons/bolted-lap.inp" -o lap --report --quiet || complain 'a bolted lap'
grep -q 'support reactions, sum</dt><dd>-1000, 0[^0-9.]' lap/report.html || complain 'round-off is told as a force'
# every table of the folder stands in the page
for table in plate/*.tab; do
   name=$(basename "$table" .tab)
   case $name in summary) continue ;; esac
   grep -q "<h3>$name</h3>" plate/report.html || complain "the page has no table $name"
done

# the next run without --report takes the page away
"$atrito" "$ex1" -o plate --quiet || complain 'without --report'
[ ! -e plate/report.html ] || complain 'an old page stays'
[ "$(find plate -name '*.tmp*' | wc -l)" -eq 0 ] || complain 'something half-written is left'

# what it takes on paper, two pictures a row
if command -v chromium >/dev/null && command -v pdfinfo >/dev/null && [ "$have_gnuplot" = yes ]; then
   "$atrito" "$ex1" -o paper --report --quiet
   chromium --headless --no-sandbox --disable-gpu --no-pdf-header-footer --print-to-pdf=paper.pdf paper/report.html >paper.out 2>&1
   pages=$(pdfinfo paper.pdf | awk '/^Pages/ { print $2 }')
   [ "${pages:-7}" -le 6 ] || complain "ex1 takes $pages pages"
fi

# not converged
sed 's/^\*STATIC/*STATIC\n*CONTROLS, METHOD=PICARD, MAXIT=2, TOLERANCE=1e-12/' "$ex1" >slow.inp
run 3 slow.inp slow --report --quiet
page slow 9 'NOT CONVERGED: this is the last iterate, not a solution' 'the outer loop did not converge in 2 iterations'
grep -q '<div class="verdict bad">' slow/report.html || complain 'the verdict is not in clear view'

# a history, one that ends early, and a deck without contact
run 0 "$input/lessons/press-and-push.inp" drag --report --quiet
page drag 12 '4 steps, 41 increments' 'step 4' 'The first 20 of 41 rows; all are in history.tab'
[ "$have_gnuplot" = no ] || grep -q 'data:image/gif' drag/report.html || complain 'no moving picture'
printf '*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT, TYPE=CPE4, ELSET=E\n1,1,2,3,4\n*MATERIAL, NAME=M\n*ELASTIC\n1,0\n*SOLID SECTION, ELSET=E, MATERIAL=M\n*BOUNDARY\n1,1,2\n2,2\n*STEP\n*STATIC\n*CLOAD\n3,2,1\n*END STEP\n' >lone.inp
run 0 lone.inp lone --report --quiet
page lone 7 '*CLOAD 3,2,1' 'lone.inp' 'Solved and checked' '1 element, 4 nodes'

# what a user wrote: signs of HTML, several bytes, no UTF-8
odd="o'd <b>&amp; \"x\" $(printf '\303\251').inp"
sed "s/^Plate on its.*/<script>alert('1')<\/script> \& \"q\" $(printf '\316\275 \351')/; s/SUPPORT/S<\&>/g" "$ex1" >"$odd"
"$atrito" "$odd" -o odd --report --quiet 2>odd.err || { complain "odd: exit $?"; cat odd.err; }
page odd 9 "<script>alert('1')</script> & \"q\" $(printf '\316\275 \303\251')" "o'd <b>&amp; \"x\" $(printf '\303\251').inp" 'S<&>-TOP'

# many pairs: columns and pictures are cut with a note
run 0 "$input/lessons/wall-with-window.inp" wall --report --quiet
page wall 9 'The first 8 of'
run 0 "$input/lessons/arch.inp" arch --report --quiet
page arch 19 'joints'

# sweeps, studies, limits
series sweep swept 0 "$ex1" --vary nu=0,0.3 --vary q=1,2 --report
page swept 1 'sweep of ex1-plate-on-support.inp' 'Plate on its support' 'All 4 runs solved and checked' 'nu_0.3,q_2' 'sweep.tab'
says 'sweep' swept.out 'report       swept/report.html'
[ ! -e swept/nu_0,q_1/report.html ] && [ ! -e swept/nu_0,q_1/plots ] || complain 'a run of the sweep has a page of its own'
series sweep half 3 slow.inp --vary nu=0,0.3 --report --quiet
page half 2 '1 of 2 runs NOT SOLVED'
series study study 0 "$ex1" --levels 2 --reference strain_energy=4.7e-3 --report
page study 1 'study of ex1-plate-on-support.inp' 'All 2 runs' 'What becomes of the errors' 'strain_energy, reference'
says 'study' study.out 'report       study/report.html'
"$atrito" study "$ex1" --levels 2 -o study --quiet || complain 'a study without --report'
[ ! -e study/report.html ] || complain 'an old page of a study stays'
if "$atrito" --version | grep -q '^Clp: [0-9]'; then
   series limit limit 0 "$input/lessons/arch.inp" --vary t=0.05:0.3 --report --tolerance 1e-3
   page limit 2 'limit of arch.inp' 'Limit of t: 0.10' 'falls at t' 'Mechanism' 'free to move' 'mechanism.tab'
   says 'limit' limit.out 'report       limit/report.html'
fi

# no gnuplot: the page is there, without pictures, and says why
mkdir -p empty
(PATH=$PWD/empty; export PATH; "$atrito" "$ex1" -o without --quiet --report) >without.out 2>without.err || complain 'no gnuplot: not exit 0'
says 'no gnuplot' without.err 'W-PLOT'
have_gnuplot=no
page without 0 'There are no pictures; the messages tell why' 'W-PLOT'

# a page that cannot be written is a warning
rm -rf blocked
mkdir -p blocked/report.html/x
"$atrito" "$ex1" -o blocked --quiet --report 2>blocked.err || complain 'blocked: not exit 0'
says 'blocked' blocked.err 'warning [W-REPORT]'
[ -s blocked/contact.tab ] || complain 'blocked: no tables'

# no other command knows it
"$atrito" check "$ex1" --report 2>check.err
[ $? -eq 1 ] || complain 'check --report: not exit 1'
says 'check' check.err '--report is no option of atrito check'
finish
