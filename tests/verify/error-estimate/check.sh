. "$(dirname "$0")/../lib.sh"
# index FOLDER TRUE: the estimate over the true error, TRUE being its square ||e||^2; both as parts of ||u_h||^2, twice the energy.
index() {
   value "sqrt(2*$(summary "$1" strain_energy)/($2))/sqrt((100/$(summary "$1" error_estimate_percent))^2 - 1)"
}
# rate WHAT COARSE FINE EXPECTED TOLERANCE: of two values on meshes of h and h/2.
rate() {
   near "rate of $1" "$(value "log($2/($3))/log(2)")" "$4" "$5"
}
estimate() {
   summary "$1" error_estimate_percent
}

# A linear displacement on any mesh: no error. At rest and after a translation: none either.
for k in 0 1; do
   run 0 "$here/patches.inp" patches$k --refine $k --digits 17 --quiet
   near "estimate of constant stresses, refined $k times" "$(estimate patches$k)" 0 0
done
run 0 "$here/patches.inp" rest --set load=0 --quiet
near "estimate at rest" "$(estimate rest)" 0 0
run 0 "$here/patches.inp" moved --set load=0 --set way=0.1 --quiet
near "estimate of a translation" "$(estimate moved)" 0 0
sed 's/CPE4/CPE9/' "$here/patches.inp" >patches9.inp
run 0 patches9.inp patches9 --digits 17 --quiet
near "estimate of constant stresses, Q2" "$(estimate patches9)" 0 0

# Timoshenko's cantilever: ||e||^2 = 2 (0.13424 - strain energy).
beam() {
   awk -v order="$1" -v nx="$((4*$2))" -v ny="$2" -f "$here/beam.awk" </dev/null >beam.inp
   run 0 beam.inp beam$1-$2 --digits 17 --quiet
   near "beam, Q$1, $2 elements over the height: index" "$(index beam$1-$2 "2*(0.13424 - $(summary beam$1-$2 strain_energy))")" 1 "$3"
}
beam 1 4 0.03
beam 1 8 0.01
beam 1 16 0.005
rate "the estimate, beam Q1" "$(estimate beam1-8)" "$(estimate beam1-16)" 1 0.02
beam 2 2 0.002
beam 2 4 0.001
beam 2 8 0.001
rate "the estimate, beam Q2" "$(estimate beam2-4)" "$(estimate beam2-8)" 2 0.02

# Lame's ring, curved and graded stresses: the true error is integrated over the printed stresses.
ring() {
   awk -v order="$1" -v n="$2" -f "$here/ring.awk" </dev/null >ring.inp
   run 0 ring.inp ring$1-$2 --digits 17 --quiet
   true=$(awk -v order="$1" -v n="$2" -f "$here/ring.awk" ring$1-$2/stress.tab)
   near "ring, Q$1, $2 x $2 elements: index" "$(index ring$1-$2 "$true")" "$3" "$4"
}
ring 1 8 1 0.15
ring 1 16 1 0.05
ring 1 32 1 0.02
ring 2 8 2.5 0.1
ring 2 16 1.3 0.1
ring 2 32 1 0.05

# A re-entrant corner, exponent 0.5445: the estimate falls as slowly as the error. Energy of the exact solution 0.8646906, by
# extrapolation.
corner() {
   awk -v order="$1" -f "$here/corner.awk" </dev/null >corner.inp
   for k in "$2" "$3"; do run 0 corner.inp corner$1-$k --refine $k --digits 17 --quiet; done
   near "corner, Q$1, refined $3 times: index" "$(index corner$1-$3 "2*(0.8646906 - $(summary corner$1-$3 strain_energy))")" "$4" 0.02
   rate "the estimate, corner Q$1" "$(estimate corner$1-$2)" "$(estimate corner$1-$3)" 0.5445 0.08
}
corner 1 3 4 0.88
corner 2 2 3 1.19
finish
