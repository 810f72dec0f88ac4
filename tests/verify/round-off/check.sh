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
solve tail nan.inp --set rho=0.100068 --set eps=1e-2
run 0 "$input/ex1-plate-on-support.inp" plate --set rho=0.100068 --quiet
finish
