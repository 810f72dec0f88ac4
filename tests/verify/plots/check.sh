. "$(dirname "$0")/../lib.sh"
ex1=$input/ex1-plate-on-support.inp
lessons_block=$input/lessons/block.inp

# picture FILE: FILE.png is a png of some size, FILE.svg an svg that draws something, and both have a script.
picture() {
   [ -s "$1.gp" ] || complain "$1.gp is missing"
   [ "$have_gnuplot" = yes ] || return 0
   [ "$(head -c 8 "$1.png" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || complain "$1.png is no png"
   [ "$(wc -c <"$1.png")" -gt 10000 ] || complain "$1.png is too small to show anything"
   # bytes 17 to 20 of a png are its width
   [ "$(od -An -tu1 -j16 -N4 "$1.png" | awk '{ print 256*$3 + $4 }')" -eq 1000 ] || complain "$1.png is not 1000 pixels wide"
   grep -q '<svg' "$1.svg" && grep -q '</svg>' "$1.svg" || complain "$1.svg is no svg"
   [ "$(grep -c '<path' "$1.svg")" -gt 5 ] || complain "$1.svg shows nothing"
}

# pictures FOLDER NAME...: all of them, and nothing that gnuplot complained of.
pictures() {
   folder=$1
   shift
   for stem; do picture "$folder/plots/$stem"; done
   [ ! -e "$folder/plots/gnuplot.log" ] || { complain "$folder: gnuplot complains"; cat "$folder/plots/gnuplot.log"; }
}

quick_pictures
[ "$have_gnuplot" = yes ] || echo 'gnuplot is not installed: the pictures themselves are not checked'

# drawn SCRIPT TABLE: what each panel of a script draws, by the names that the table has for the columns: `panel column ...`.
drawn() {
   awk '
      FNR == 1 { file++ }
      file == 1 && /^# columns:/ { for (i = 3; i <= NF; i++) name[i - 2] = $i }
      file == 1 { next }
      /^is_shown\(/ || /^marked\(/ {
         line = "by"
         rest = $0
         while (match(rest, /column\([0-9]+\)/)) {
            line = line " " name[substr(rest, RSTART + 7, RLENGTH - 8) + 0]
            rest = substr(rest, RSTART + RLENGTH) }
         print line }
      /^set label 1 / { panel = $4; sub(/^"/, "", panel) }
      /^plot .*table/ {
         line = panel
         rest = $0
         while (match(rest, /using [0-9]+:\([-a-z*]*(col|column|marked|early)\((i, )?[0-9]+/)) {
            item = substr(rest, RSTART + 6, RLENGTH - 6)
            rest = substr(rest, RSTART + RLENGTH)
            along = name[item + 0]
            sub(/.*[( ]/, "", item)
            line = line " " along ":" name[item + 0] }
         print line }' "$2" "$1"
}

# The columns of a picture are those that its panels are named after.
panels_draw() { # WHAT SCRIPT TABLE EXPECTED, a line each
   drawn "$2" "$3" | awk '{ delete seen; line = $1; for (i = 2; i <= NF; i++) if (!($i in seen)) { seen[$i] = 1; line = line " " $i } print line }' >drawn.out
   printf '%s\n' "$4" | diff drawn.out - >drawn.diff || { complain "$1: other columns"; cat drawn.diff; }
}

# every example, with and without friction
rm -rf './-o d d' sweep grid told without
fine 'contour-mises.gp' run 0 "$ex1" told --plot
for deck in "$input"/*.inp; do
   name=$(basename "$deck" .inp)
   [ "$deck" = "$ex1" ] || run 0 "$deck" "$name" --plot --quiet
   [ "$deck" = "$ex1" ] && name=told
   pictures "$name" mesh contact-1
   if [ "$have_gnuplot" = yes ] && grep -q W-PLOT "$name.err"; then complain "$name: W-PLOT"; fi
   name=$(basename "$deck" .inp)
   run 0 "$deck" "$name-0" --plot --quiet --set nu=0
   pictures "$name-0" mesh contact-1
   says 'pressure and gap alone' "$name-0/plots/contact-1.gp" 'panels = 2'
done
run 0 "$ex1" none --plot --quiet --set q=0
pictures none mesh contact-1
[ "$have_gnuplot" = no ] || says 'summary' told.out 'plots in     told/plots: mesh contours tractions contact-1'
says 'listing' told/ex1-plate-on-support.lst 'mesh, contour-mises, contour-s11'

panels_draw 'contact' told/plots/contact-1.gp told/contact.tab 'by pair step increment
by status
pressure s:pressure s:weighted_pressure
shear s:shear s:weighted_pressure
slip s:slip
gap s:gap'
panels_draw 'contact without friction' ex1-plate-on-support-0/plots/contact-1.gp ex1-plate-on-support-0/contact.tab 'by pair step increment
by status
pressure s:pressure
gap s:gap'
says 'marks of states' told/plots/contact-1.gp '(marked(8,0)) with points ls 4 title "open"'
says 'marks of states' told/plots/contact-1.gp '(marked(8,2)) with points ls 6 title "slip"'

# a script can be run again where it stands
if [ "$have_gnuplot" = yes ]; then
   rm told/plots/mesh.png told/plots/contact-1.png
   (cd told/plots && gnuplot contact-1.gp && gnuplot mesh.gp) >again.out 2>&1 || complain 'the scripts do not run again'
   [ ! -s again.out ] || { complain 'the scripts complain'; cat again.out; }
   pictures told mesh contact-1
fi

# a run that did not converge says so in its pictures
sed 's/^\*STATIC/*STATIC\n*CONTROLS, METHOD=PICARD, MAXIT=2, TOLERANCE=1e-12/' "$ex1" >slow.inp
run 3 slow.inp slow --plot --quiet
pictures slow mesh contact-1
says 'not converged' slow/plots/mesh.gp "heading = 'NOT CONVERGED"
says 'not converged' slow/plots/contact-1.gp "heading = 'NOT CONVERGED"

# contours: every field, with the largest and least of the nodes, at most 1.5 MB each (one of them as fine as it is for a user, which
# takes a second); the scale and the box that are asked for
contours='contour-mises contour-s11 contour-s22 contour-s12 contour-displacement contour-error'
contour() { # FOLDER
   for stem in $contours; do
      [ -s "$1/plots/$stem.bin" ] || complain "$1: no $stem.bin"
      [ "$have_gnuplot" = yes ] || continue
      grep -q '<image' "$1/plots/$stem.svg" && [ "$(wc -c <"$1/plots/$stem.svg")" -lt 1500000 ] || complain "$1: $stem.svg"
      [ "$(wc -c <"$1/plots/$stem.png")" -gt 10000 ] || complain "$1: $stem.png"
   done
   [ ! -e "$1/plots/gnuplot.log" ] || { complain "$1: gnuplot complains"; cat "$1/plots/gnuplot.log"; }
}
contour told
pictures told tractions
fine contour-mises.gp run 0 "$ex1" zoomed --plot --quiet --plot-scale 4 --plot-box 0.4,-0.2,0.8,0.2
contour zoomed
pictures zoomed mesh tractions
says 'scale' zoomed/plots/mesh.gp 'scale = 4 '
says 'box' zoomed/plots/contour-mises.gp 'set xrange [0.4:0.8]'
says 'box' zoomed/plots/tractions.gp 'set yrange [-0.2:0.2]'
run 0 "$ex1" beside --plot --quiet --plot-box 5,5,6,6
says 'box' beside.err '[W-PLOT] --plot-box shows no body'
contour beside
# the displacements of the tables are those of the picture
largest=$(awk '!/^#/ { u = sqrt($5*$5 + $6*$6); if (u > most) { most = u; node = $2 } } END { printf "largest %.4g at node %d", most, node }' told/nodes.tab)
says 'largest displacement' told/plots/contour-displacement.gp "$largest"
fine contour-s22.gp run 0 "$lessons_block" flat --plot --quiet
contour flat
says 'a flat field' flat/plots/contour-s22.gp 'the same everywhere: -10"'
says 'a stress that is none' flat/plots/contour-s12.gp 'the same everywhere: 0"'

# joints: on request, with one body, with many, and with none that touches
joints_of() { # NAME DECK [options]
   name=$1
   sed 's/^\*END STEP/*JOINT PRINT\n*END STEP/' "$2" >"$name.inp"
   shift 2
   run 0 "$name.inp" "$name" --plot --quiet "$@"
   if [ "$have_gnuplot" = yes ] && grep -q W-PLOT "$name.err"; then complain "$name: W-PLOT"; fi
}
joints_of joints_1 "$input/ex1-plate-on-rigid-support.inp"
pictures joints_1 mesh joints contact-1
says 'one body' joints_1/plots/joints.gp 'title "slip"'
joints_of joints_open "$input/ex1-plate-on-rigid-support.inp" --set q=0
pictures joints_open mesh joints contact-1
if grep -q 'line of thrust, n' joints_open/plots/joints.gp; then complain 'a line of thrust without forces'; fi
awk -v courses=10 -v len=19 -v nu=0.6 -v factor=0.2 -f "$here/../walls/wall.awk" >wall100.inp
[ "$(grep -c '^\*BLOCK' wall100.inp)" -eq 100 ] || complain 'the wall has not 100 blocks'
joints_of joints_100 wall100.inp
pictures joints_100 mesh joints
absent joints_100/plots/contact-1.gp
for state in open stick slip; do says 'wall' joints_100/plots/joints.gp "title \"$state\""; done
says 'wall' joints_100/plots/joints.gp 'line of thrust, n up to'
run 0 "$ex1" joints_1 --plot --quiet
absent joints_1/plots/joints.png
absent joints_1/plots/joints.dat

# odd names: of deck, heading, sets and folder; nothing of them is executed
odd='it'\''s 100% "$(touch HIT)" `touch HIT` {a_b^c} @x & <tag> \'
{ printf '*HEADING\n%s\n' "$odd \\"; sed '1,2d; s/PLATE$/"P{L_A}^T\\"/; s/ELSET=PLATE,/ELSET="P{L_A}^T\\",/' "$ex1"; } >"$odd.inp"
grep -q 'P{L_A}' "$odd.inp" || complain 'the odd name is not in the deck'
run_again() { "$atrito" "$@" >again.out 2>again.err; }
run_again "$odd.inp" -o "-o d d/$odd" --plot --quiet || { complain "the odd deck: exit $?"; cat again.err; }
pictures "./-o d d/$odd" mesh contact-1
[ -z "$(find . -name 'HIT*' -print)" ] || complain 'a name was executed'
if [ "$have_gnuplot" = yes ]; then
   grep -q '{a_b^c}.*&lt;tag&gt;\|{a_b^c}' "./-o d d/$odd/plots/mesh.svg" || complain 'the heading is not in the picture'
fi
printf '*HEADING\nn\351 \377 half \303\n' >latin.inp
sed 1,2d "$ex1" >>latin.inp
run 0 latin.inp latin --plot --quiet
pictures latin mesh contact-1

# pictures of an earlier run go with its tables; what the user put there stays
cp told/plots/contact-1.gp told/plots/mine.gp
run_again "$ex1" -o told --quiet --set nosuch=1
[ -s told/plots/mesh.gp ] || complain 'a run that wrote nothing removed pictures'
run_again "$ex1" -o told --quiet || complain 'the run without pictures failed'
[ "$(ls told/plots)" = mine.gp ] || { complain 'files of an earlier run are left'; ls told/plots; }
run_again "$ex1" -o told --quiet --plot
pictures told mesh contact-1
rm told/plots/mine.gp
run_again "$ex1" -o told --quiet
absent told/plots

# no gnuplot: a warning, the scripts, exit 0
mkdir -p empty
(PATH=$PWD/empty; export PATH; "$atrito" "$ex1" -o without --quiet --plot) >without.out 2>without.err || complain 'no gnuplot: not exit 0'
says 'no gnuplot' without.err 'warning [W-PLOT] gnuplot was not found'
[ "$(wc -l <without.err)" -eq 1 ] || complain 'no gnuplot: more than one line'
[ -s without/plots/mesh.gp ] && [ -s without/plots/mesh.dat ] && [ -s without/plots/contact-1.gp ] || complain 'no gnuplot: no scripts'
[ ! -e without/plots/mesh.png ] || complain 'no gnuplot, but a picture'

# a gnuplot that fails
mkdir -p broken
printf '#!/bin/sh\necho "\\"mesh.gp\\" line 3: out of ink" >&2\nexit 2\n' >broken/gnuplot
chmod +x broken/gnuplot
(PATH=$PWD/broken:$PATH; export PATH; "$atrito" "$ex1" -o without --quiet --plot) >without.out 2>without.err || complain 'broken gnuplot: not exit 0'
says 'broken gnuplot' without.err 'warning [W-PLOT] gnuplot failed: "mesh.gp" line 3: out of ink'

# no folder for the plots
rm -rf without/plots
echo mine >without/plots
(run_again "$ex1" -o without --quiet --plot) || complain 'no folder: not exit 0'
says 'no folder' again.err 'warning [W-PLOT] no plots are written: without/plots'
[ "$(cat without/plots)" = mine ] || complain 'a file of the user was replaced'

# a scene before it is solved: pictures of it and nothing else, into a folder of its own
rm -rf output here without
run_again "$ex1" -o told --quiet --plot || complain 'the run beside the check failed'
"$atrito" check "$ex1" >check.out 2>check.err || complain 'check failed'
absent output
"$atrito" check "$ex1" --plot >check.out 2>check.err || complain 'check --plot failed'
checked=output/ex1-plate-on-support-check
pictures "$checked" scene sets pairs
[ "$(ls output)" = ex1-plate-on-support-check ] && [ "$(ls "$checked")" = plots ] || complain 'check --plot writes other files'
[ "$have_gnuplot" = no ] || says 'check' check.out "plots in     $checked/plots: scene sets pairs"
says 'supports' "$checked/plots/scene.gp" 'title "held in both directions"'
says 'loads' "$checked/plots/scene.gp" 'title "loads on faces, resultant (0, -1.5) [F]"'
says 'sides' "$checked/plots/scene.gp" 'title "slaves, with normals"'
says 'names of bodies' "$checked/plots/scene.gp" "title 'PLATE' noenhanced"
says 'mesh of a run' told/plots/mesh.gp 'title "loads on faces, resultant (0, -1.5) [F]"'
says 'the surface that moves' "$checked/plots/pairs.gp" "title 'OVER-BOTTOM'"
# what is in a box, of scene and sets
"$atrito" check "$ex1" --plot --quiet --plot-box 0.8,0.2,0.4,-0.2 -o boxed 2>check.err || complain 'check --plot-box failed'
pictures boxed scene sets pairs
for stem in scene sets; do
   says "box of $stem" boxed/plots/$stem.gp 'set xrange [0.4:0.8]'
   says "box of $stem" boxed/plots/$stem.gp 'set yrange [-0.2:0.2]'
done
[ ! -s check.err ] || complain 'check --plot-box warns'
"$atrito" check "$ex1" --plot --quiet --plot-box 5,5,6,6 -o boxed 2>check.err || complain 'check --plot-box beside the scene failed'
says 'box beside the scene' check.err '[W-PLOT] --plot-box shows no body'
# numbers and names, of a mesh of Gmsh too, whose groups have names
"$atrito" check "$input/gmsh/plate-with-hole.inp" --plot --plot-labels --quiet -o named 2>check.err || complain 'check --plot-labels failed'
pictures named scene sets
for name in hole plate platen; do says 'names of groups' named/plots/scene-symbols.dat "\"$name\""; done
says 'legend of labels' named/plots/scene.gp ' of 1342 nodes"'
# beside a run, whose pictures stay; those of an earlier check go, with a scene that has no pair
"$atrito" check "$ex1" --plot --quiet -o told 2>check.err || complain 'check into the folder of a run failed'
pictures told mesh contact-1 scene sets pairs
"$atrito" check "$here/../water/dam.inp" --plot --quiet -o told 2>check.err || complain 'check without pairs failed'
pictures told mesh contact-1 scene sets
absent told/plots/pairs.gp
run_again "$ex1" -o told --quiet
absent told/plots/mesh-symbols.dat
[ -s told/plots/scene-symbols.dat ] || complain 'a run removed the pictures of a check'
# what else is drawn: rows, temperatures, sections of bolts, reference nodes, the axis
for scene in joints/rows thermal/plate thermal/tube pretension/joint rigid-histories/push axisymmetric/disc centrifugal/askew; do
   "$atrito" check "$here/../$scene.inp" --plot --quiet -o here 2>check.err || complain "check --plot of $scene failed"
   pictures here scene
   cp here/plots/scene.gp "$(basename "$scene").gp"
done
for title in 'ties, with normals' springs 'equations (2)' 'forces at nodes, resultant (1.5, -5) [F]'; do
   says 'rows' rows.gp "title \"$title\""
done
says 'temperature' plate.gp 'title "warmer by up to 100"'
says 'bolt' joint.gp 'title "pre-tension section, force 0.03 [F]"'
says 'reference node' push.gp 'title "reference nodes, in squares: no rotation"'
says 'several steps' push.gp 'supports and loads of step 1 of 4, at its end'
says 'axis' disc.gp 'title "axis of revolution"'
says 'turning' askew.gp 'title "body loads, resultant (1.354, -0.677) [F]"'
# nothing is a failure, as with a run
(PATH=$PWD/empty; export PATH; "$atrito" check "$ex1" -o without --quiet --plot) >check.out 2>check.err || complain 'check without gnuplot: not exit 0'
says 'check without gnuplot' check.err 'warning [W-PLOT]'
rm -rf here
echo mine >here
"$atrito" check "$ex1" --plot --quiet -o here 2>check.err || complain 'check into a file: not exit 0'
says 'check into a file' check.err 'warning [W-PLOT] no plots are written'
[ "$(cat here)" = mine ] || complain 'check replaced a file of the user'
if "$atrito" check "$ex1" -o nowhere 2>check.err; then complain 'check -o without --plot is taken'; fi
says 'check -o' check.err 'without --plot'
absent nowhere

# sweeps: a legend up to ten runs, then a palette; a picture against one parameter
"$atrito" sweep "$ex1" --vary nu=0,0.1,0.3 --plot --quiet -o sweep 2>sweep.err || complain 'the sweep failed'
pictures sweep overlay-1 overlay-summary
panels_draw 'overlay' sweep/plots/overlay-1.gp told/contact.tab 'by pair step increment
pressure s:pressure
shear s:shear
slip s:slip
gap s:gap'
"$atrito" sweep "$ex1" --vary nu=0.1,0.2,0.3,0.4 --vary rho=0.1,0.2,0.3 --plot --quiet -o grid 2>grid.err || complain 'the grid failed'
pictures grid overlay-1
absent grid/plots/overlay-summary.gp
"$atrito" sweep "$ex1" --vary nu=0,0.1 --quiet -o sweep 2>sweep.err || complain 'the second sweep failed'
absent sweep/plots
# values that span decades, and 0 among them
"$atrito" sweep "$ex1" --vary q=0,1e-3,1 --plot --quiet -o decades 2>decades.err || complain 'the sweep over decades failed'
pictures decades overlay-summary
says 'an axis with 0' decades/plots/overlay-summary.gp 'set nonlinear x'
"$atrito" sweep "$ex1" --vary q=1e-4,1e-3,1 --plot --quiet -o decades 2>decades.err || complain 'the sweep over decades failed'
pictures decades overlay-summary
[ "$(grep -c '^set logscale y' decades/plots/overlay-summary.gp)" -eq 3 ] || complain 'the resultant, pressure and shear go with q'

# histories: curves over time, the loop, steps over one another, and a picture that moves
moving() { # FOLDER IMAGES
   [ -s "$1/plots/motion.gp" ] && [ -s "$1/plots/motion.dat" ] || complain "$1: motion.gp or motion.dat is missing"
   [ "$(grep -c '^name\[' "$1/plots/motion.gp")" -eq "$2" ] || complain "$1: not $2 images"
   [ "$have_gnuplot" = yes ] || return 0
   [ "$(head -c 6 "$1/plots/motion.gif")" = GIF89a ] || complain "$1: motion.gif is no gif"
   # each image begins with the graphic control extension 21 f9 04
   [ "$(od -An -v -tx1 "$1/plots/motion.gif" | tr -d ' \n' | grep -o 21f904 | wc -l)" -ge "$2" ] || complain "$1: motion.gif has not $2 images"
   [ "$(wc -c <"$1/plots/motion.gif")" -gt $((1000*$2)) ] || complain "$1: motion.gif is too small to show anything"
}
lessons=$input/lessons
run 0 "$lessons/press-and-push.inp" push --plot
pictures push mesh history loop contact-1
moving push 4
[ "$have_gnuplot" = no ] || says 'summary' push.out 'plots in     push/plots: mesh contours tractions history loop motion contact-1'
tr -s ' \n' ' ' <push/press-and-push.lst >pushed          # the line is broken
says 'listing' pushed 'history, loop, motion, contact-1'
panels_draw 'history' push/plots/history.gp push/history.tab 'normal time:normal_resultant
shear time:shear_resultant
contact time:contact_length
dissipation time:dissipation'
panels_draw 'steps over one another' push/plots/contact-1.gp push/contact.tab 'by pair step increment
by status
pressure s:pressure
shear s:shear s:weighted_pressure
slip s:slip
gap s:gap'
says 'the ends of steps' push/plots/contact-1.gp 'early_step[3] = 3; early_increment[3] = 16'
run 0 "$lessons/press-and-push.inp" push_0 --plot --quiet --set nu=0
pictures push_0 mesh history contact-1
absent push_0/plots/loop.gp
panels_draw 'history without friction' push_0/plots/history.gp push_0/history.tab 'normal time:normal_resultant
largest time:max_pressure
contact time:contact_length'
run 0 "$lessons/block-there-and-back.inp" drag --plot --quiet
pictures drag mesh history loop contact-1
moving drag 101
# the loop has the resultants of history.tab, and the slip of contact.tab over the area
grep -v '^#' drag/plots/loop.dat | awk 'NF { print $2 + 0 }' >loop.out
awk '!/^#/ { print $6 + 0 }' drag/history.tab >resultant.out
paste loop.out resultant.out | awk '($1 - $2)^2 > 1e-16 { wrong++ } END { exit !(NR == 101 && !wrong) }' || complain 'the loop has other resultants'
near 'the mean slip' "$(grep -v '^#' drag/plots/loop.dat | awk 'NF { slip = $1 } END { print slip }')" \
   "$(awk '!/^#/ && $1 == 2 && $15 == 100 { a += $13; b += $13*$11 } END { printf "%.12g", b/a }' drag/contact.tab)" 1e-9
# many pairs and joints
sed 's/^\*STATIC/*STATIC\n0.25, 1/; s/^\*END STEP/*CONTACT PRINT, FREQUENCY=1\n*END STEP/' "$lessons/wall-with-window.inp" >wall.inp
run 0 wall.inp wall --plot --quiet
pictures wall mesh history loop joints
moving wall 4
says 'of many pairs' wall/plots/history.gp 'the 7 of 105 pairs with the largest forces'
"$atrito" sweep "$lessons/press-and-push.inp" --vary nu=0.2,0.3 --plot --quiet -o sweep 2>sweep.err || complain 'the sweep of a history failed'
pictures sweep overlay-1 overlay-summary
run_again "$lessons/press-and-push.inp" -o push --quiet || complain 'the run without pictures failed'
absent push/plots
finish
