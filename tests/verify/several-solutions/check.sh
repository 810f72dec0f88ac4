. "$(dirname "$0")/../lib.sh"
# node NAME S K_XY FT FN: one element of which one node is free, with the stiffness 1 along x and along y and K_XY between them; the
# node stands on a floor, and is pulled by FT along it and pressed by FN upon it. S places the two upper nodes.
node() {
   cat >"$1.inp" <<END
*HEADING
$1
*NODE
1, 0, 0
2, 1, 0
3, $(value "1 + ($2)"), 1.7821127702606016
4, $2, 1.7821127702606016
*NSET, NSET=HELD
2, 3, 4
*ELEMENT, TYPE=CPS4, ELSET=BODY
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1.0877322528686405, 0.4
*SOLID SECTION, ELSET=BODY, MATERIAL=M
1
*SURFACE, NAME=SOLE, TYPE=ELEMENT
BODY, S1
*SURFACE, NAME=FLOOR, TYPE=SEGMENTS
START, -9, 0
LINE, 9, 0
*RIGID BODY, ANALYTICAL SURFACE=FLOOR
*SURFACE INTERACTION, NAME=JOINT
*FRICTION
3
*CONTACT PAIR, INTERACTION=JOINT
SOLE, FLOOR
*BOUNDARY
HELD, 1, 2
*STEP
*STATIC
*CLOAD
1, 1, $3
1, 2, -$4
*CONTROLS, METHOD=${5:-ANDERSON}
*NODE PRINT
U
*CONTACT PRINT
*END STEP
END
}
# state NAME: open, stick or slip of the point at node 1, its pressure and shear as forces, and u_t
state() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) c[$i] = i - 2; next } !/^#/ && $c["x"] == 0 {
      printf "%s %.15g %.15g %.15g\n", $c["status"], $c["pressure"]*$c["weight"], -$c["shear"]*$c["weight"], $c["slip"] }' "$1/contact.tab"
}
two=-0.90481900095625
three=2.40481900095627
# K = [[1, -.5], [-.5, 1]] (t, n), F = (1, .2), nu = 3: plain Picard cycles between two states; the solution is r_n = .28, r_t = .84.
for method in ANDERSON NEWTON; do
   node cycle-$method $two 1 0.2 $method
   run 0 cycle-$method.inp cycle-$method --digits 17 --quiet
   # shellcheck disable=SC2046 # four words
   set -- $(state cycle-$method)
   near "$method, 2-cycle of Picard: r_n" "$2" 0.28 1e-12
   near "$method, 2-cycle of Picard: r_t" "$3" 0.84 1e-12
   near "$method, 2-cycle of Picard: u_t" "$4" 0.16 1e-12
   says 'a warning' cycle-$method.err W-UNIQUE
done
node cycle-PICARD $two 1 0.2 PICARD
run 3 cycle-PICARD.inp cycle-PICARD --quiet
says 'plain Picard' cycle-PICARD.err 'cycles between 2 states'

# K = [[1, .5], [.5, 1]], F = (1, .45), nu = 3: open, stuck with r = (1, .45), or slipping with u_t = .7, r = (.3, .1). One is found.
for method in ANDERSON PICARD NEWTON; do
   node three-$method $three 1 0.45 $method
   run 0 three-$method.inp three-$method --digits 17 --quiet
   says 'a warning' three-$method.err W-UNIQUE
   # shellcheck disable=SC2046
   set -- $(state three-$method)
   case $1 in
   0) near "$method, three solutions: open" "$2" 0 0 ;;
   1)
      near "$method, three solutions: stuck, r_n" "$2" 0.45 1e-12
      near "$method, three solutions: stuck, r_t" "$3" 1 1e-12
      ;;
   2)
      near "$method, three solutions: slips, r_n" "$2" 0.1 1e-12
      near "$method, three solutions: slips, r_t" "$3" 0.3 1e-12
      near "$method, three solutions: slips, u_t" "$4" 0.7 1e-12
      ;;
   *) complain "$method: no point" ;;
   esac
done

# Below nu = K_tt/|K_tn| = 2 there is one solution and no warning; without friction in the way nothing holds the node: it slides.
node one $three 1 0.45
sed 's/^3$/1.9/' one.inp >below.inp
run 0 below.inp below --digits 17 --quiet
grep -q W-UNIQUE below.err && complain 'a warning below the bound'
finish
