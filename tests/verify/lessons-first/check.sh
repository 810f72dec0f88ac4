# What the lessons of docs/user say, against closed forms; README.md has them.
. "$(dirname "$0")/../lib.sh"

# lesson NAME [options]: a deck of at most 40 lines, run into a folder of its name.
lesson() {
   name=$1
   shift
   run 0 "$input/lessons/$name.inp" "$name" --digits 17 --quiet "$@"
   [ "$(wc -l <"$input/lessons/$name.inp")" -le 40 ] || complain "$name: more than 40 lines"
}

# rows FOLDER TABLE FIRST LAST: these rows of a table, with its header, into the file rows.
rows() {
   awk -v first="$3" -v last="$4" '/^#/ || (++n >= first && n <= last)' "$1/$2.tab" >rows
}

lesson cantilever
near 'cantilever: tip against Euler' "$(summary cantilever tip_to_euler)" 1 0.006
near 'cantilever: tip against Timoshenko' "$(summary cantilever tip_to_timoshenko)" 1 0.004
near 'cantilever: stress one depth from the root' "$(summary cantilever inside)" 1 1e-4
rows cantilever path 42 82
field_near 'cantilever: stress along the path there' rows s_across '21.6*(y - 5)' 0.02

lesson hertz
near 'Hertz: half width' "$(summary hertz width)" 1 0.006
near 'Hertz: largest pressure' "$(summary hertz peak)" 1 5e-4
near 'Hertz: largest shear on the axis' "$(summary hertz subsurface)" 0.3003 0.006
rows hertz contact 1 22   # to 0.9 a
field_near 'Hertz: pressure along the line' rows pressure '37.405405*sqrt(1 - (x/0.68077837)^2)' 0.4
deepest=$(column hertz/path.tab y >y && column hertz/path.tab tresca | paste - y | sort -g | tail -1 | cut -f 2)
near 'Hertz: its depth over a' "$(value "$deepest/0.68077837")" 0.786 0.03

lesson press-fit
near 'press fit: pressure' "$(summary press-fit fit)" 1 1e-4
near 'press fit: hoop stress of the hub' "$(summary press-fit hub)" 2.6 0.03
rows press-fit path 1 11
field_near 'press fit: radial stress of the shaft' rows s_rr '-49.21875*4/3*(1 - 100/x^2)' 1.5
field_near 'press fit: hoop stress of the shaft' rows s_tt '-49.21875*4/3*(1 + 100/x^2)' 1.5
rows press-fit path 12 22
field_near 'press fit: radial stress of the hub' rows s_rr '49.21875*0.8*(1 - 900/x^2)' 1.5
field_near 'press fit: hoop stress of the hub' rows s_tt '49.21875*0.8*(1 + 900/x^2)' 1.5

lesson incline
near 'incline: normal force' "$(summary incline normal_resultant)" "$(value '49.05*cos(atan2(0, -1)/9)')" 1e-9
near 'incline: tangent of the slope' "$(summary incline ratio)" 0.36397023426620234 1e-9
near 'incline: where the weight goes' "$(summary incline foot)" 0.8180148828668988 1e-9
for limit in 'slides 0.5 10:40 26.565051177' 'tips 5 10:80 63.434948823'; do
   # shellcheck disable=SC2086 # four words
   set -- $limit
   "$atrito" limit "$input/lessons/incline.inp" --set nu="$2" --vary slope="$3" -o "$1" --quiet >"$1.out" 2>"$1.err" || complain "incline $1"
   for bound in stands falls; do
      near "incline: it $1, $bound at" "$(sed -n "s/^# stands at.*$bound at \([0-9.]*\).*/\1/p; s/^# $bound at \([0-9.]*\).*/\1/p" "$1/limit.tab")" "$4" 5e-5
   done
done

lesson plate-with-hole
near 'plate with a hole: stress concentration (Kirsch; 3.03 in a strip of this width)' "$(summary plate-with-hole concentration)" 3.02 0.02
p=$(value "$(summary plate-with-hole normal_resultant)/10")
field_near 'plate with a hole: hoop stress round it' plate-with-hole/path.tab s_tt "-$p*(1 + 2*(x*x - y*y))" "$(value "0.03*$p")"
lesson plate-with-hole --set H=1.5
near 'a wall near the hole: concentration' "$(summary plate-with-hole concentration)" 2.091 0.001
near 'a wall near the hole: what lifts off' "$(summary plate-with-hole open_points)" 1 0

# The share is 1 - 2.5 nu; half-way the stress is that of a moment and, where they slip, of a normal force: s11(y) = slope*(y - middle).
for nu in 0 0.1 0.3; do
   lesson two-beams --set nu=$nu
   near "two beams, nu = $nu: share" "$(summary two-beams share)" "$(value "1 - 2.5*$nu")" 0.003
   rows two-beams path 1 5
   field_near "two beams, nu = $nu: lower one" rows s11 "(48 - 120*$nu)*(y - 2.5) - 100*$nu" 1e-6
   rows two-beams path 6 10
   field_near "two beams, nu = $nu: upper one" rows s11 "(48 - 120*$nu)*(y - 7.5) + 100*$nu" 1e-6
done
finish
