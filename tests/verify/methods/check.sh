. "$(dirname "$0")/../lib.sh"
# storages
for storage in skyline banded; do
   run 0 "$input/ex1-plate-on-support.inp" $storage --solver $storage --digits 17 --quiet
   says "listing of $storage" $storage/ex1-plate-on-support.lst "  $storage  "
done
grep -q '  banded  ' skyline/ex1-plate-on-support.lst && complain "the skyline run used banded storage"
for table in contact nodes reactions stress; do
   same_tables "skyline and banded, $table" skyline/$table.tab banded/$table.tab 1e-12
done
# the sparse storage, chosen by its cost
run 0 "$input/ex1-plate-on-support.inp" sparse --solver sparse --digits 17 --quiet
says 'listing of sparse' sparse/ex1-plate-on-support.lst '  sparse  '
grep -q 'PLATE: [0-9]* fronts*, [0-9]* of them different' sparse/ex1-plate-on-support.lst || complain 'fronts are not counted'
says 'order of sparse' sparse/ex1-plate-on-support.lst 'nested dissection'
grep -q 'Cuthill' sparse/ex1-plate-on-support.lst && complain 'the order of a profile, where nothing has one'
says 'order of skyline' skyline/ex1-plate-on-support.lst 'Cuthill'
for table in contact nodes reactions stress; do
   same_tables "skyline and sparse, $table" skyline/$table.tab sparse/$table.tab 1e-12
done
# of few hundred equations a body, of one or two thousand, and of so many that nothing is numbered for its profile
for k in 0 2 4; do
   "$atrito" check "$input/ex3-pillar-in-ground.inp" --refine $k >needs-$k
done
grep -q '  sparse  ' needs-0 && complain 'bodies of 100 equations are sparse unasked'
says 'why bodies of 100 equations are not' needs-0 'predicted cost'
for k in 2 4; do
   says "bodies of --refine $k" needs-$k '  sparse  '
   says "why those of --refine $k are" needs-$k 'SOFT: sparse, predicted cost 0.'
done
# methods and laws
cp "$here/drag.inp" .
try_law() { # NAME, the lines of the law
   printf '*SURFACE INTERACTION, NAME=JOINT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e7\n%b\n' "$2" >law.inp
   for method in ANDERSON PICARD NEWTON; do
      echo "*CONTROLS, METHOD=$method, TOLERANCE=1e-12" >controls.inp
      run 0 drag.inp "$1-$method" --digits 17 --quiet
   done
   same_tables "$1 ANDERSON and PICARD" "$1-ANDERSON/contact.tab" "$1-PICARD/contact.tab" 1e-9
   same_tables "$1 ANDERSON and NEWTON" "$1-ANDERSON/contact.tab" "$1-NEWTON/contact.tab" 1e-9
   same_tables "$1 ANDERSON and NEWTON, u" "$1-ANDERSON/nodes.tab" "$1-NEWTON/nodes.tab" 1e-9
}
try_law nonlocal '*FRICTION, NONLOCAL\n0.3, 1e-5, 0.25'
try_law line '*FRICTION, NONLOCAL, KERNEL=LINE\n0.3, 1e-5, 0.35'
try_law exact '*FRICTION, NONLOCAL\n0.3, 0, 0.25'
try_law coulomb '*FRICTION\n0.3'
try_law stick-slope '*FRICTION\n0.3, 1e5'
near 'sticking points' "$(awk -v n="$(summary exact-NEWTON stick_points)" 'BEGIN { print (n > 0) }')" 1 0
near 'slipping points' "$(awk -v n="$(summary exact-NEWTON slip_points)" 'BEGIN { print (n > 0) }')" 1 0
finish
