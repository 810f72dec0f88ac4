. "$(dirname "$0")/../lib.sh"
rigid=$input/ex1-plate-on-rigid-support.inp
run 0 "$rigid" frictionless --set nu=0 --quiet
listing=frictionless/ex1-plate-on-rigid-support.lst
says 'listing' "$listing" 'tangential unknowns .............. 0'
says 'listing' "$listing" 'bodies ........................... 1'
says 'listing' "$listing" 'no friction: no tangential unknowns, no outer loop'
says 'listing' "$listing" 'rigid surface: no second body and no matrix for it'
near 'outer iterations' "$(summary frictionless picard_iterations)" 0 0
all_near 'no shear' frictionless/contact.tab shear 0 0
"$atrito" check "$rigid" --set nu=0 >check.out 2>check.err || complain 'check failed'
says 'check' check.out 'tangential unknowns .............. 0'
says 'check' check.out 'outer loop ....................... none'
says 'check' check.out 'rigid surface: no second body and no matrix for it'
absent output
run 0 "$rigid" friction --quiet
says 'listing with friction' friction/ex1-plate-on-rigid-support.lst 'tangential unknowns .............. 7'
run 0 "$input/ex1-plate-on-support.inp" two --quiet
says 'listing of two bodies' two/ex1-plate-on-support.lst 'bodies ........................... 2'
finish
