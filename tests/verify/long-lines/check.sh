# Long contact lines (src/multiplier/contact_fronts.f90): the number of linear solves does not grow with the number of points, and the
# answer is that of the condensed form, which follows no fronts. Two layers that do not match, pressed and pushed so that they slip over
# a part of the line: from one end, from both, the upper one softer, with an average of the pressures over 50 points, with a stick slope.
. "$(dirname "$0")/../lib.sh"

# layers POINTS PUSH-LEFT PUSH-RIGHT MODULUS-ABOVE FRICTION >DECK
layers() {
   cat <<DECK
*BLOCK, TYPE=CPE4, ELSET=LOW, NX=$1, NY=4
0., 0.
15., 0.
15., 1.
0., 1.
*BLOCK, TYPE=CPE4, ELSET=HIGH, NX=$(($1 * 29 / 30)), NY=4
0., 1.
15., 1.
15., 2.
0., 2.
*MATERIAL, NAME=BELOW
*ELASTIC
1000., .3
*MATERIAL, NAME=ABOVE
*ELASTIC
$4, .3
*SOLID SECTION, ELSET=LOW, MATERIAL=BELOW
*SOLID SECTION, ELSET=HIGH, MATERIAL=ABOVE
*SURFACE INTERACTION, NAME=JOINT
$5
*CONTACT PAIR, INTERACTION=JOINT
LOW-TOP, HIGH-BOTTOM
*BOUNDARY
LOW-BOTTOM, 1, 2
*STEP
*STATIC
*DSLOAD
HIGH-TOP, P, 1.
*CLOAD
HIGH-LEFT, 1, $2
HIGH-RIGHT, 1, $3
*CONTACT PRINT
*END STEP
DECK
}

# does_not_grow NAME ARGUMENTS..: at most 25 solves at 200 and at 800 points, at 200 points what the condensed form finds.
does_not_grow() {
   name=$1
   shift
   for n in 200 800; do
      layers "$n" "$@" >"$name-$n.inp"
      run 0 "$name-$n.inp" "$name-$n" --contact sparse --quiet
      below "$name: solves at $n points" "$(column "$name-$n/iterations.tab" inner | wc -l)" 26
      for state in 1 2; do
         below "$name: $n points less those of status $state" \
            $((n - $(column "$name-$n/contact.tab" status | grep -c "^$state\$"))) $((n - 9))
      done
   done
   run 0 "$name-200.inp" "$name-condensed" --contact dense --quiet
   same_tables "$name: both forms" "$name-200/contact.tab" "$name-condensed/contact.tab" 1e-7
}

does_not_grow left 0.5 0. 1000. '*FRICTION
.3'
does_not_grow both 0.4 -0.35 1000. '*FRICTION
.3'
# nearly all slips, 0.85 of the 0.9 that friction can take: the last points that hold the layer must not be taken at once
does_not_grow nearly 0.85 0. 1000. '*FRICTION
.3'
does_not_grow soft 0.4 0. 50. '*FRICTION
.3'
does_not_grow averaged 0.5 0. 1000. '*FRICTION, NONLOCAL
.3, 0., 1.'
does_not_grow sloped 0.5 0. 1000. '*FRICTION
.3, 1e4'
# Loads that grow by a tenth ten times: an increment begins where the last two point to. The answer is that of one increment.
layers 200 0.5 0. 1000. '*FRICTION
.3' | sed 's/^\*STATIC$/*STATIC\n0.1, 1./' >growing.inp
run 0 growing.inp growing --contact sparse --quiet
below 'growing: solves of ten increments' "$(column growing/iterations.tab inner | wc -l)" 31
for run in growing left-200; do awk '!/^#/ { print $8, $10 }' $run/contact.tab >$run.stresses; done
paste growing.stresses left-200.stresses | awk '{ for (i = 1; i <= 2; i++) { d = $i - $(i + 2); if (d < 0) d = -d; if (d > most) most = d } }
   END { printf "growing: largest difference of pressures and shears %.1e\n", most; exit !(NR > 200 && most < 1e-7) }' ||
   complain 'growing: another answer than that of one increment'
# A flat layer pressed on one whose side is a parabola: without friction, the ends of contact are fronts, too.
layers 1600 0. 0. 3000. '' | sed 's/^\*STEP$/*CLEARANCE, SLAVE=LOW-TOP, MASTER=HIGH-BOTTOM, FUNCTION\n4e-3*(x - 7.5)**2\n*STEP/
   s/^HIGH-TOP, P, 1.$/HIGH-TOP, P, 0/; s/^\*CLOAD$/*BOUNDARY\nHIGH-TOP, 2, 2, -0.02\nHIGH-LEFT, 1\n*CLOAD/' >parabola.inp
run 0 parabola.inp parabola --contact sparse --quiet
below 'parabola: solves' "$(column parabola/iterations.tab inner | wc -l)" 21
below 'parabola: points less those in contact' $((1600 - $(column parabola/contact.tab status | grep -c '^2$'))) 1300
# A flat punch with rounded edges, pressed and pushed: beside the edges slip turns, point by point if each waited for the next.
layers 4000 0. 0. 1000. '*FRICTION
.3' | sed 's/^\*STEP$/*CLEARANCE, SLAVE=LOW-TOP, MASTER=HIGH-BOTTOM, FUNCTION\n1e-3*max(abs(x - 7.5) - 5, 0)**2\n*STEP/
   s/^HIGH-TOP, P, 1.$/HIGH-TOP, P, 0/; s/^\*CLOAD$/*BOUNDARY\nHIGH-TOP, 2, 2, -0.004\nHIGH-TOP, 1, 1, 0.001\n*CLOAD/' >punch.inp
run 0 punch.inp punch --contact sparse --quiet --proof off
below 'punch: solves' "$(column punch/iterations.tab inner | wc -l)" 26
# A wall of 410 blocks in running bond under its weight, with little friction: the halves at its ends slip at all points but one or two,
# and a block that slips at all of them would fly to the next one.
cat >wall.inp <<'DECK'
*BLOCK, TYPE=CPS4, ELSET=WHOLE, NX=8, NY=4
0., 0.
1., 0.
1., .5
0., .5
COPY, 20, 10, 1, 1
*BLOCK, TYPE=CPS4, ELSET=BETWEEN, NX=8, NY=4
.5, .5
1.5, .5
1.5, 1.
.5, 1.
COPY, 19, 10, 1, 1
*BLOCK, TYPE=CPS4, ELSET=HALF, NX=4, NY=4
0., .5
.5, .5
.5, 1.
0., 1.
COPY, 2, 10, 19.5, 1
*ELSET, ELSET=WALL
WHOLE, BETWEEN, HALF
*MATERIAL, NAME=STONE
*ELASTIC
1e7, .2
*DENSITY
20.
*SOLID SECTION, ELSET=WALL, MATERIAL=STONE
.25
*SURFACE, NAME=GROUND, TYPE=SEGMENTS
START, -1., 0.
LINE, 21., 0.
*RIGID BODY, ANALYTICAL SURFACE=GROUND
*SURFACE INTERACTION, NAME=JOINT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1e8
*FRICTION
.1, 1e8
*CONTACT
*CONTACT INCLUSIONS, ALL EXTERIOR
*CONTACT INCLUSIONS
, GROUND
*CONTACT PROPERTY ASSIGNMENT
, , JOINT
*STEP
*STATIC
*DLOAD
WALL, GRAV, 1., 0., -1.
*BODY PRINT
*END STEP
DECK
run 0 wall.inp wall --quiet --proof off
below 'wall: solves' "$(column wall/iterations.tab inner | wc -l)" 61
# More friction, 1,068 blocks in coarse elements: courses are about to slide, and the last points that hold a stone do not let go together.
sed 's/NX=8, NY=4/NX=4, NY=2/; s/NX=4, NY=4/NX=2, NY=2/; s/^COPY, 20, 10/COPY, 44, 12/; s/^COPY, 19, 10/COPY, 43, 12/
   s/^COPY, 2, 10, 19.5/COPY, 2, 12, 43.5/; s/^LINE, 21/LINE, 45/; s/^\.1, 1e8/.3, 1e8/' wall.inp >courses.inp
run 0 courses.inp courses --quiet --proof off
below 'courses: solves' "$(column courses/iterations.tab inner | wc -l)" 15
finish
