. "$(dirname "$0")/../lib.sh"
deck=$input/lessons/nonmatching.inp
sed 's/INTERACTION=JOINT$/&, QUADRATURE=NODAL/' "$deck" >nodal.inp
for name in mortar nodal; do
   [ $name = mortar ] && cp "$deck" mortar.inp
   sed 's/^COARSE-BOTTOM, FINE-TOP$/FINE-TOP, COARSE-BOTTOM/' $name.inp >$name-fine.inp
done

# extremes FOLDER: least and largest s22.
extremes() {
   column "$1/stress.tab" s22 | sort -g | sed -n '1p;$p' | tr '\n' ' '
}

run 0 nodal.inp nodal --digits 17
says 'NODAL' nodal.err 'W-COARSE-SLAVE'
says 'NODAL' nodal.err '6.7 times as far apart'
set -- $(extremes nodal)
near 'NODAL: least stress' "$1" -46.00 5e-3
near 'NODAL: largest stress' "$2" 1.16 5e-3
run 0 nodal-fine.inp nodal-fine --digits 17 --quiet
set -- $(extremes nodal-fine)
near 'NODAL, the finer side is the slave: least stress' "$1" -10.03 5e-3
near 'NODAL, the finer side is the slave: largest stress' "$2" -9.95 5e-3

for slave in mortar mortar-fine; do
   run 0 $slave.inp $slave --digits 17
   says "$slave" $slave.err 'N-MORTAR'
   grep -q warning $slave.err && complain "$slave: a warning"
   all_near "$slave: stress" $slave/stress.tab s22 -10 1e-10
   run 0 $slave.inp $slave-narrow --set left=0.33 --digits 17 --quiet
   all_near "$slave: resultant" $slave-narrow/joints.tab n 16.7 1e-11
   all_near "$slave: its place" $slave-narrow/joints.tab x 1.165 1e-11
done
finish
