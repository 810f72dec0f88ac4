. "$(dirname "$0")/../lib.sh"
solve() { # NAME DECK options
   name=$1
   deck=$2
   shift 2
   run 0 "$here/$deck" "$name" --quiet "$@"
   grep -v "^#" "$name/contact.tab" | grep -qi "nan\|inf" && complain "$name: not a number"
   near "$name equilibrium" "$(summary "$name" equilibrium_residual)" 0 1e-10
}
solve tilted tilt.inp
solve symmetry c3n.inp
solve base c6.inp --set y0=0.1
solve overlap c6.inp --set y0=0.3
# no row sees the motion along x1
for form in dense sparse; do
   solve "unseen-$form" c6.inp --contact "$form"
   says "unseen-$form" "$name.err" "is free to move along x1: no load does it and nothing prevents it"
done
# gaps and slips are differences of far larger terms, by which they are judged
for thin in 0.01 0.02; do
   for form in dense sparse; do
      solve "bar-$thin-$form" bar.inp --contact "$form" --set h="$thin"
      all_near "bar-$thin-$form pressure" "$name/contact.tab" pressure 1 1e-6
   done
done
# loads that go straight into joints: nothing moves, and the joints carry them
joined() { # LINES FORM TYPE N
   cat >joined.inp <<END
*HEADING
a side that joints hold, and loads there
*BLOCK, TYPE=$3, ELSET=B, NX=$4, NY=$4
0., 0.
3.1, 0.
3.3, 1.7
0.1, 1.2
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*EXPANSION
1e-5
*SOLID SECTION, ELSET=B, MATERIAL=M
$1
*BOUNDARY
B-BOTTOM, 1, 2
*STEP
*STATIC
*DSLOAD
B-TOP, TRVEC, 5., 1., 0.3
*NODE PRINT
U
*END STEP
END
   run 0 joined.inp joined --quiet --contact "$2"
   below "$3, $4 x $4, $2: displacement" "$(awk '!/^#/ { for (k = 5; k <= 6; k++) { d = $k < 0 ? -$k : $k; if (d > most) most = d } rows++ }
      END { if (rows < 4) print "none"; else printf "%.17g", most }' joined/nodes.tab)" 1e-14
}
for form in auto dense sparse; do
   for mesh in 'CPE4 1' 'CPS6 4' 'CPE8 3'; do
      joined '*EQUATION
1
B-TOP, 1, 1.
1
B-TOP, 2, 1.' $form $mesh
      joined '*EQUATION
2
B-TOP, 1, 1., B-TOP, 2, -0.4
2
B-TOP, 1, 0.7, B-BOTTOM, 1, -1.' $form $mesh
      joined '*NODE
9000, 0., 5.
*RIGID BODY, REF NODE=9000, NSET=B-TOP
*BOUNDARY
9000, 1, 2
9000, 6' $form $mesh
   done
done
solve tail nan.inp --set rho=0.100068 --set eps=1e-2
run 0 "$input/ex1-plate-on-support.inp" plate --set rho=0.100068 --quiet
finish
