. "$(dirname "$0")/../lib.sh"
lessons=$input/lessons
# forces FOLDER: normal and tangential force of the first point, and its displacements u1, u2
forces() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) c[$i] = i - 2; next } !/^#/ {
      printf "%.15g %.15g\n", $c["pressure"]*$c["weight"], $c["shear"]*$c["weight"]; exit }' "$1/contact.tab"
}

# one triangle: off the floor, stuck, slipping
run 0 "$lessons/three-solutions.inp" three --digits 17 --observe 'n=solutions_found + index' --observe 'sure=unique_up_to_nu'
near 'solutions' "$(summary three solutions_found)" 3 0
near 'solutions that are observed, and the index' "$(summary three n)" 4 0
near 'what is certified, observed' "$(summary three sure)" "$(summary three unique_up_to_nu)" 0
for folder in three three/solution-2 three/solution-3; do
   below 'what is left of the balance' "$(summary $folder equilibrium_residual)" 1e-8
done
near 'their indices' "$(value "$(summary three index) + $(summary three/solution-2 index) + $(summary three/solution-3 index)")" 1 0
near 'off the floor, u1' "$(column three/nodes.tab u1 | head -1)" -9.2943967e-5 1e-12
near 'off the floor, u2' "$(column three/nodes.tab u2 | head -1)" 9.4528315e-6 1e-13
slipping=three/solution-3
stuck=three/solution-2
near 'slipping has index -1' "$(summary $slipping index)" -1 0
# shellcheck disable=SC2046 # two words
set -- $(forces $stuck)
near 'stuck, normal' "$1" 1 1e-12
near 'stuck, tangential' "$2" 0.9 1e-12
# shellcheck disable=SC2046
set -- $(forces $slipping)
near 'slipping, normal' "$1" 0.7029703 1e-7
near 'slipping, tangential' "$2" 0.7029703 1e-7
near 'slipping, u1' "$(column $slipping/nodes.tab u1 | head -1)" -1.7227723e-5 1e-12
says 'three solutions' three.out 'not the only solution: 2 others found from 40 starts'
says 'three solutions' three.err '[W-UNIQUE] this is not the only solution: the search found 2 more'
says 'three solutions' three/three-solutions.lst 'not the only solution: 2 others'

# below the coefficient that is certified the other folders go, and nothing is warned of; the same for every coefficient
run 0 "$lessons/three-solutions.inp" three --set nu=0.65
[ ! -e three/solution-2 ] || complain 'the other solutions of the run before are still there'
says 'one solution' three.out 'exactly one solution for every load up to nu = 0.656 (certified)'
grep -q W-UNIQUE three.err && complain 'a warning though one solution is certified'
near 'found' "$(summary three solutions_found)" 1 0
grep -q search three/timing.tab && complain 'a search for what is certified not to be there'
below 'certified' "$(summary three unique_up_to_nu)" 0.66333
run 0 "$lessons/three-solutions.inp" beyond --set nu=0.66
says 'beyond what is certified' beyond.out 'not proved beyond nu = 0.656; 40 starts find no other solution'
run 0 "$lessons/three-solutions.inp" sparse --set nu=0.65 --contact sparse
says 'sparse' sparse.out 'exactly one solution for every load up to nu = 0.65'
below 'sparse: certified' "$(summary sparse unique_up_to_nu)" 0.66333
near 'sparse: index' "$(summary sparse index)" 1 0
run 0 "$lessons/three-solutions.inp" sparse --set nu=0.66 --contact sparse
says 'sparse, beyond' sparse.out 'not proved beyond nu = 0.65'

# a leaning block: off the floor, jammed, and one between them
run 0 "$lessons/leaning-block.inp" lean --digits 17 --quiet
near 'leaning: solutions' "$(summary lean solutions_found)" 3 0
near 'leaning: indices' "$(value "$(summary lean index) + $(summary lean/solution-2 index) + $(summary lean/solution-3 index)")" 1 0
near 'leaning: one of index -1' "$(grep -ho 'index *-1' lean/solution-*/summary.tab | wc -l)" 1 0
# each increment of a history says what is known of it
sed 's/^\*STATIC/*STATIC\n0.5, 1/; s/^\*CONTACT PRINT/&, FREQUENCY=1/' "$lessons/leaning-block.inp" >steps.inp
run 0 steps.inp steps --quiet
[ "$(column steps/history.tab unique_up_to_nu | sort -u | wc -l)" = 1 ] || complain 'a history without certificates, or with several'
[ "$(column steps/history.tab index | tr '\n' ' ')" = '1 1 ' ] || complain 'a history without indices'
near 'found in the first increment' "$(awk '$3 == "solutions_found" && $5 == 1 { print $4 }' steps/summary.tab)" 3 0
[ ! -e steps/solution-2 ] || complain 'other solutions of a history are written'

# a corner between a floor and a wall: one node, two points, whose forces can be shared out in many ways; nothing moves otherwise
cat >corner.inp <<END
*HEADING
corner
*BLOCK, TYPE=CPS4, ELSET=BLOCK, NX=1, NY=1
0, 0
1, 0
1, 1
0, 1
*MATERIAL, NAME=M
*ELASTIC
1000, 0.44
*SOLID SECTION, ELSET=BLOCK, MATERIAL=M
1
*SURFACE, NAME=FLOOR, TYPE=SEGMENTS
START, -3, 0
LINE, 9, 0
*RIGID BODY, ANALYTICAL SURFACE=FLOOR
*SURFACE, NAME=WALL, TYPE=SEGMENTS
START, 0, 4
LINE, 0, -2
*RIGID BODY, ANALYTICAL SURFACE=WALL
*SURFACE INTERACTION, NAME=ROUGH
*FRICTION
2.6
*SURFACE INTERACTION, NAME=OTHER
*FRICTION
0.95
*CONTACT PAIR, INTERACTION=ROUGH
BLOCK-BOTTOM, FLOOR
*CONTACT PAIR, INTERACTION=OTHER
BLOCK-LEFT, WALL
*STEP
*STATIC
*BOUNDARY
BLOCK-TOP, 1, 1, 0.0044
BLOCK-TOP, 2, 2, -0.0095
*CONTACT PRINT
*END STEP
END
run 0 corner.inp corner --unique 24
says 'forces alone' corner.out 'not proved; 24 starts find no other solution'
near 'forces alone' "$(summary corner solutions_found)" 1 0

# certified NAME DECK LEAST MOST: what is certified of a deck lies between them
certified() {
   run 0 "$2" "$1" --quiet
   below "$1: certified" "$(summary "$1" unique_up_to_nu)" "$4"
   below "$1: not far below" "$3" "$(summary "$1" unique_up_to_nu)"
}
# blocks NAME UPPER LOWER E_UPPER E_LOWER REST: an upper block over a lower one, both cut at the axis of symmetry
blocks() {
   cat >"$1.inp" <<END
*HEADING
$1
*BLOCK, TYPE=CPE4, ELSET=UPPER, $2
*BLOCK, TYPE=CPE4, ELSET=LOWER, $3
*MATERIAL, NAME=HARD
*ELASTIC
$4, 0.3
*MATERIAL, NAME=SOFT
*ELASTIC
$5, 0.3
*SOLID SECTION, ELSET=UPPER, MATERIAL=HARD
1
*SOLID SECTION, ELSET=LOWER, MATERIAL=SOFT
1
*SURFACE INTERACTION, NAME=JOINT
*FRICTION
0.4
*CONTACT PAIR, INTERACTION=JOINT
UPPER-BOTTOM, LOWER-TOP
*BOUNDARY
$6
*STEP
*STATIC
*DSLOAD
UPPER-TOP, P, 1
*CONTACT PRINT
*END STEP
END
}
nl='
'
blocks punch "NX=4, NY=4${nl}0, 0${nl}1, 0${nl}1, 1${nl}0, 1" "NX=12, NY=8${nl}0, -2${nl}3, -2${nl}3, 0${nl}0, 0" 1000 200 \
   "UPPER-LEFT, 1${nl}LOWER-LEFT, 1${nl}LOWER-BOTTOM, 1, 2"
certified punch punch.inp 5.58 5.9
run 0 punch.inp sparse --contact sparse
says 'what to do' sparse.out 'not proved: in the sparse form --unique asks for it'
blocks hertz "NX=8, NY=4${nl}0, 0${nl}2, 0${nl}2, 1${nl}0, 1" "NX=8, NY=8${nl}0, -2${nl}2, -2${nl}2, 0${nl}0, 0" 1000 250 \
   "UPPER-LEFT, 1${nl}LOWER-LEFT, 1${nl}LOWER-BOTTOM, 1, 2"
certified hertz hertz.inp 1.80 1.91
blocks beams "NX=16, NY=2${nl}0, 0${nl}4, 0${nl}4, 0.5${nl}0, 0.5" "NX=16, NY=2${nl}0, -0.5${nl}4, -0.5${nl}4, 0${nl}0, 0" 1000 1000 \
   "UPPER-LEFT, 1, 2${nl}LOWER-LEFT, 1, 2"
certified beams beams.inp 999 1001
sed 's/^rho = .*/rho = 0.1/' "$input/ex1-plate-on-support.inp" >nonlocal.inp
run 0 nonlocal.inp nonlocal --refine 1 --quiet
below 'nonlocal: certified' "$(summary nonlocal unique_up_to_nu)" 1.073
below 'nonlocal: not far below' 1.03 "$(summary nonlocal unique_up_to_nu)"
# with a radius of its own the law is certified to the same on finer meshes, 25 and 49 points
for level in 2 3; do
   run 0 nonlocal.inp finer-$level --quiet --proof off --refine $level
done
near 'nonlocal, finer' "$(value "$(summary finer-3 unique_up_to_nu)/$(summary finer-2 unique_up_to_nu)")" 1 0.01

# The sparse form certifies the same by the signs of one elimination: never more than the most of all alpha and gamma, which SciPy
# found of the dense matrix (unit tests have the eigenvalues), and hardly less. rough DECK OPTIONS LEAST MOST
rough() {
   # shellcheck disable=SC2086 # options are words
   run 0 "$1" rough --quiet --proof off --contact sparse --unique 1 $2
   below "$1 $2, sparse: certified" "$(summary rough unique_up_to_nu)" "$4"
   below "$1 $2, sparse: not far below" "$3" "$(summary rough unique_up_to_nu)"
}
rough punch.inp '' 5.3 5.8823
rough "$input/ex1-plate-on-support.inp" '' 0.80 0.8729
rough "$input/ex1-plate-on-rigid-support.inp" '' 0.31 0.3395
rough nonlocal.inp '--refine 2' 1.03 1.0925
rough "$lessons/leaning-block.inp" '' 0.53 0.5556
rough beams.inp '' 900 1001
# two layers that do not match, the upper one free across the contact, with more than 400 forces: parts of the elimination
layers() {
   cat <<END
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
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=LOW, MATERIAL=M
*SOLID SECTION, ELSET=HIGH, MATERIAL=M
*SURFACE INTERACTION, NAME=JOINT
$2
*CONTACT PAIR, INTERACTION=JOINT
LOW-TOP, HIGH-BOTTOM
*BOUNDARY
LOW-BOTTOM, 1, 2
HIGH-LEFT, 1
*STEP
*STATIC
*DSLOAD
HIGH-TOP, P, 1.
*CLOAD
HIGH-RIGHT, 1, 0.5
*CONTACT PRINT
*END STEP
END
}
layers 201 '*FRICTION
.3' >local.inp
layers 201 '*FRICTION, NONLOCAL
.2, 0., 1.' >wide.inp
for law in local wide; do
   run 0 $law.inp $law --quiet --proof off --contact dense --unique 1
   both=$(summary $law unique_up_to_nu)
   rough $law.inp '' "$(value "0.94*$both")" "$(value "1.06*$both")"
done
layers 501 '*FRICTION, NONLOCAL
.2, 0., 1.' >long.inp
run 0 long.inp long --proof off --unique 1
says 'a long line' long.out 'exactly one solution for every load up to nu = 0.2'
below 'the same as of a shorter one' "$(summary long unique_up_to_nu)" "$(value "1.06*$(summary wide unique_up_to_nu)")"
run 0 long.inp long --proof off
says 'a long line' long.out 'not proved: in the sparse form --unique asks for it'

# friction alone holds it
run 0 "$lessons/block-on-floor.inp" pushed
says 'held by friction' pushed.out 'not proved: a body is held along the contact by friction alone'
grep -q unique_up_to_nu pushed/summary.tab && complain 'a body held by friction alone is certified'
run 0 "$lessons/block-on-floor.inp" pushed --contact sparse
says 'held by friction, sparse' pushed.out 'not proved: a body is held along the contact by friction alone'
finish
