. "$(dirname "$0")/../lib.sh"
# last FOLDER COLUMN: of its adapt.tab.
last() {
   column "$1/adapt.tab" "$2" | tail -1
}
# value_of LEVEL ELEMENT COLUMN of study.tab
value_of() {
   awk -v level="$1" -v element="$2" -v name="$3" '/^# columns:/ { for (i = 3; i <= NF; i++) c[$i] = i - 2; next }
      !/^#/ && $1 == level && $2 == element { print $c[name] }' study/study.tab
}
# contact patch test
awk '/^\*STEP/ { print "*REFINE\n4, 2\n13, 1" } { print }' "$here/../patch/patch.inp" >patch.inp
run 0 patch.inp patch --digits 17 --quiet
below 'points' 3 "$(grep -vc '^#' patch/contact.tab)"
all_near 'pressure' patch/contact.tab pressure 100 1e-10
all_near 's22' patch/stress.tab s22 -100 1e-10
# example 1: the study has a run of --adapt, and meshes that are refined everywhere
sed 's/CPE4/CPE3/' "$input/ex1-plate-on-support.inp" >ex1.inp
"$atrito" study ex1.inp --levels 4 --adapt 8 -o study --digits 15 --quiet || complain 'a study'
run 0 ex1.inp ex1 --adapt 8 --solver sparse --digits 15 --quiet
"$atrito" compare ex1 study/adapt_3 --rtol 0 >/dev/null || complain 'a run and its study: other tables'
below 'bound' "$(last ex1 error_percent)" 8.0000001
near 'the last mesh is written' "$(summary ex1 error_bound_percent)" "$(last ex1 error_percent)" 0
near 'dofs' "$(value_of 3 adapt dofs)" "$(last ex1 dofs)" 0
near 'study: the bound' "$(value_of 3 adapt error_bound_percent)" "$(last ex1 error_percent)" 0
below 'the same everywhere' 8 "$(value_of 2 deck error_estimate_percent)"
below 'displacements' "$(last ex1 dofs)" "$(value_of 2 deck dofs)"
below 'error of the energy' "$(value "4.9299e-3 - $(summary ex1 strain_energy)")" \
   "$(value "0.6*(4.9299e-3 - $(value_of 2 deck strain_energy))")"
near 'resultant' "$(summary ex1 normal_resultant)" 1.5 1e-11
near 'reactions' "$(awk '!/^#/ { s += $4 } END { printf "%.17g", s }' ex1/reactions.tab)" 1.5 1e-11
says 'study' study/study.tab '# an estimated error of'
# the deck of the last mesh
cp ex1/ex1.run.inp again.inp
run 0 again.inp again --proof on --solver sparse --digits 15 --quiet
"$atrito" compare ex1 again --rtol 1e-11 >/dev/null || complain 'the deck as it was run: other tables'
# single nodes carry example 2
run 3 "$input/ex2-two-plates.inp" ex2 --adapt 5 --quiet
says 'why' ex2.err 'not 5 % as --adapt asks: over the last 4 meshes it has not become smaller'
grep -q 'NOT CONVERGED' ex2/summary.tab && complain 'the tables of a solution are marked'
# Cook's membrane with nine nodes: all pieces have straight sides, so the bound is still there (10.7 % on the mesh of the deck)
run 0 "$here/cook.inp" cook --adapt 8 --quiet
near 'Cook: certified' "$(last cook certified)" 1 0
below 'Cook: bound' "$(last cook error_percent)" 8
# an L: the energy of its exact solution is 0.8646906 (tests/verify/error-estimate), so its error is known; refined everywhere
# 98,944 displacements have 1.21 %, with eight nodes 18,752 have 1.58 %
for type in 4 8; do
   awk -v order=1 -f "$here/../error-estimate/corner.awk" </dev/null | sed "s/CPE4/CPE$type/" >corner.inp
   run 0 corner.inp "corner-$type" --adapt 1 --digits 15 --quiet
   near "L, $type nodes: certified" "$(last "corner-$type" certified)" 1 0
   below "L, $type nodes: bound" "$(last "corner-$type" error_percent)" 1
   below "L, $type nodes: the error is below the bound" \
      "$(value "100*sqrt(0.8646906/$(summary "corner-$type" strain_energy) - 1)")" "$(last "corner-$type" error_percent)"
   below "L, $type nodes: displacements" "$(last "corner-$type" dofs)" 6000
done
# an arch of nine voussoirs; refined everywhere 14,994 displacements have 2.28 %. Sides that match still do
sed 's/CPE4/CPE8/' "$input/lessons/arch.inp" >arch.inp
run 0 arch.inp arch --adapt 2.5 --digits 15 --quiet
near 'arch: certified' "$(last arch certified)" 1 0
below 'arch: bound' "$(last arch error_percent)" 2.5
below 'arch: displacements' "$(last arch dofs)" 7000
near 'arch: thrust at the crown' "$(column arch/joints.tab t | head -1)" 0.09127 2e-5
near 'arch: its weight' "$(column arch/joints.tab n | awk 'NR == 1 || NR == 10 { s += $1 } END { printf "%.17g", s }')" \
   "$(value '9*0.15*sin(atan2(0, -1)/9)')" 1e-11
# a history, by its largest error
run 0 "$input/lessons/block-there-and-back.inp" history --adapt 8.8 --digits 15 --quiet
near 'largest of the printed increments' "$(awk '!/^#/ && $3 == "error_bound_percent" && $4 > most { most = $4 }
   END { print most }' history/summary.tab)" "$(last history error_percent)" 0
finish
