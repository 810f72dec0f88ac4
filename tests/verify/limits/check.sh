. "$(dirname "$0")/../lib.sh"
for scene in support rigid-support; do
   for nu in 0 0.3; do
      for delta in 0 1e-18 1e-12; do
         run 0 "$input/ex1-plate-on-$scene.inp" "$scene-$nu-$delta" --set nu=$nu --set delta=$delta --digits 17 --quiet
         near "$scene nu=$nu delta=$delta equilibrium" "$(summary "$scene-$nu-$delta" equilibrium_residual)" 0 1e-10
      done
      same_tables "$scene nu=$nu delta 1e-18 and 0" "$scene-$nu-1e-18/contact.tab" "$scene-$nu-0/contact.tab" 1e-10
      same_tables "$scene nu=$nu delta 1e-18 and 0, u" "$scene-$nu-1e-18/nodes.tab" "$scene-$nu-0/nodes.tab" 1e-10
      same_tables "$scene nu=$nu delta 1e-18 and 0, stress" "$scene-$nu-1e-18/stress.tab" "$scene-$nu-0/stress.tab" 1e-10
   done
   sed 's/OVERCLOSURE=PENALTY/OVERCLOSURE=HARD/; /^<delta>$/d' "$input/ex1-plate-on-$scene.inp" >hard.inp
   run 0 hard.inp "$scene-hard" --digits 17 --quiet
   same_tables "$scene HARD and delta = 0" "$scene-hard/contact.tab" "$scene-0.3-0/contact.tab" 0
   for eps in 0 1e-18; do
      run 0 "$input/ex1-plate-on-$scene.inp" "$scene-eps-$eps" --set delta=0 --set eps=$eps --digits 17 --quiet
   done
   same_tables "$scene eps 1e-18 and 0" "$scene-eps-1e-18/contact.tab" "$scene-eps-0/contact.tab" 1e-10
   same_tables "$scene eps 1e-18 and 0, u" "$scene-eps-1e-18/nodes.tab" "$scene-eps-0/nodes.tab" 1e-10
done
cp "$here/../methods/drag.inp" .
echo '*CONTROLS, TOLERANCE=1e-12' >controls.inp
for eps in 0 1e-18; do
   printf '*SURFACE INTERACTION, NAME=JOINT\n*FRICTION, NONLOCAL\n0.3, %s, 0.25\n' $eps >law.inp
   run 0 drag.inp drag-$eps --digits 17 --quiet
done
same_tables 'drag eps 1e-18 and 0' drag-1e-18/contact.tab drag-0/contact.tab 1e-10
near 'drag, exact stick' "$(awk -v n="$(summary drag-0 stick_points)" 'BEGIN { print (n > 0) }')" 1 0
finish
