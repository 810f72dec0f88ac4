# Quantities at places, *OBSERVE, *PATH PRINT and contact between the points, against closed forms.
. "$(dirname "$0")/../lib.sh"

# observed FOLDER NAME: at the end
observed() {
   summary "$1" "$2" | tail -1
}

# path FOLDER NAME COLUMN [INCREMENT]: a column of path.tab
path() {
   awk -v path="$2" -v name="$3" -v increment="${4:-}" '
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $2 == path && (increment == "" || $at["increment"] == increment) { print $at[name] }' "$1/path.tab"
}

# Lame's thick cylinder: s_rr, s_tt = A (1 -+ b^2/r^2), u_r = (1 + mu) A/E ((1 - 2 mu) r + b^2/r), A = p a^2/(b^2 - a^2) = 2/3.
lame() {
   awk -v r="$1" -v what="$2" 'BEGIN { A = 2/3; b2 = 4
      v["rr"] = A*(1 - b2/r^2); v["tt"] = A*(1 + b2/r^2); v["u"] = 1.3e-3*A*(0.4*r + b2/r)
      v["e1"] = 1.3e-3*A*(0.4 - b2/r^2); v["e2"] = v["u"]/r; printf "%.15g", v[what] }' </dev/null
}
run 0 "$here/ring.inp" ring --digits 17 --quiet
run 0 "$here/ring.inp" fine --digits 17 --quiet --refine 1
for folder in ring fine; do
   tol=$(if [ $folder = ring ]; then echo 2e-3; else echo 2e-4; fi)
   near "$folder: s_rr" "$(observed $folder rr)" "$(lame 1.3 rr)" "$tol"
   near "$folder: s_tt" "$(observed $folder tt)" "$(lame 1.3 tt)" "$tol"
   near "$folder: s_rt" "$(observed $folder rt)" 0 "$tol"
   near "$folder: s1" "$(observed $folder big)" "$(lame 1.3 tt)" "$tol"
   near "$folder: s2" "$(observed $folder small)" "$(lame 1.3 rr)" "$tol"
   near "$folder: u_r" "$(observed $folder ur)" "$(lame 1.3 u)" 1e-7
   near "$folder: u_t" "$(observed $folder ut)" 0 1e-8
   near "$folder: u_r between nodes of the rim" "$(observed $folder rim)" "$(lame 2 u)" 1e-7
   near "$folder: radial strain" "$(observed $folder e1)" "$(lame 1.3 e1)" 5e-6
   near "$folder: hoop strain" "$(observed $folder e2)" "$(lame 1.3 e2)" 1e-6
   near "$folder: shear strain" "$(observed $folder e3)" 0 1e-6
   near "$folder: mean hoop stress" "$(observed $folder hoop)" "$(lame 1 tt)" 0.04
   near "$folder: tresca" "$(observed $folder tr)" 5.3333 0.1
done
# off PATH COLUMN COLUMN: how far two columns are apart
off() {
   path ring "$1" "$2" >one
   path ring "$1" "$3" | paste - one | awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > w) w = d } END { print NR ? w + 0 : "none" }'
}
path ring radius s | while read -r s; do lame "$(value "1+$s")" rr; echo; done >rr
path ring radius s | while read -r s; do lame "$(value "1+$s")" tt; echo; done >tt
for name in rr tt; do
   worst=$(path ring radius s_$name | paste - $name | awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > w) w = d } END { print w }')
   below "s_$name along the radius" "$worst" 0.04
done
below 'a radius: along is radial' "$(off radius s_along s_rr)" 1e-12
below 'a radius: shear' "$(off radius s_shear s_rt)" 1e-12
[ "$(path ring radius s | wc -l)" -eq 11 ] || complain 'rows of the radius'
below 'an arc: across is radial' "$(off arc s_across s_rr)" 1e-12
[ "$(path ring arc s | wc -l)" -eq 7 ] || complain 'rows of the arc'
near 'length of the arc' "$(path ring arc s | tail -1)" "$(value '0.75*atan2(0,-1)')" 1e-12
near 'the arc begins above' "$(path ring arc y | head -1)" 1.5 1e-12
near 'and goes clockwise' "$(path ring arc x | tail -1)" 1.5 1e-12
near 'hoop stress half-way' "$(path ring arc s_tt | sed -n 4p)" "$(lame 1.5 tt)" 4e-3

# A cantilever: u2 = -P L^3/(3 E I) - 6 P L/(5 G h) to the root's share; s11 = -12 P (L - x)(y - h/2)/h^3. Half of it in increment 1.
run 0 "$here/beam.inp" beam --digits 17
near 'tip of the cantilever' "$(observed beam tip)" -4.03e-4 2e-6
says 'what is outside' beam.err '[N-PATH] 10 of the 21 points of path depth are outside of all bodies: they have no rows'
for i in 1 2; do
   worst=$(path beam depth y $i | paste - - - - - - - - - - - | tr '\t' '\n' >y
      path beam depth s_across $i | paste - y | awk -v i=$i '{ d = $1 - 0.3*i*($2 - 0.05); if (d < 0) d = -d; if (d > w) w = d }
         END { print NR == 11 ? w : "rows " NR }')
   below "bending stress through the depth, increment $i" "$worst" 1e-6
done
near 'shear in the middle of the depth' "$(path beam depth s12 2 | sed -n 6p)" -1.5e-3 5e-4

# Hertz: a = sqrt(4 P R/(pi E')), the largest shear is 0.300 p0 at a depth of 0.786 a.
run 0 "$here/disc.inp" disc --digits 17 --quiet
a=$(value "sqrt(4*$(observed disc force)*10/(atan2(0,-1)*1000/0.91))")
p0=$(value "2*$(observed disc force)/(atan2(0,-1)*$a)")
near 'half width of the contact, points 0.075 apart' "$(observed disc a)" "$a" 0.015
near 'half of the extent' "$(observed disc wide)" "$(observed disc a)" 1e-14
near 'ends' "$(observed disc ends)" "$(value "2*$(observed disc a)")" 1e-14
near 'centre of the contact' "$(observed disc middle)" 1.2 1e-9
near 'nothing sticks without friction' "$(observed disc sticks)" 0 0
path disc axis s >depth
path disc axis tresca | paste - depth | sort -g | tail -1 >most
near 'largest shear below' "$(awk '{ printf "%.15g", $1/2 }' most)" "$(value "0.300*$p0")" "$(value "0.015*$p0")"
near 'its depth' "$(awk '{ print $2 }' most)" "$(value "0.786*$a")" "$(value "0.03*$a")"
near 'pressure at the surface' "$(path disc axis s_along | head -1)" "$(value "-1*$p0")" "$(value "0.02*$p0")"

# A gap of 0.1 of which 0.13 is asked over the first step, and taken back in the second.
run 0 "$here/gap.inp" gap --digits 17 --quiet
near 'the pair closes' "$(observed gap closed)" "$(value 10/13)" 1e-9
near 'and opens' "$(observed gap opened)" "$(value 16/13)" 1e-9
[ "$(awk '!/^#/ && $2 == 7 && $1 == 1 { print $(NF - 1), $NF }' gap/history.tab)" = 'nan nan' ] || complain 'times before anything closes'

# A press fit: where the bodies touch a point has a row for each, in the order of the path.
run 0 "$here/fit.inp" fit --digits 17 --quiet
[ "$(path fit radius s | wc -l)" -eq 42 ] || complain 'rows of a path through two bodies'
near 'radial stress on both sides' "$(path fit radius s_rr | sed -n 21p)" "$(path fit radius s_rr | sed -n 22p)" 0.005
# p = d/(b/E' (outer + inner)): plane strain, b = 2 between 1 and 3
p=$(awk 'BEGIN { E = 1000/0.91; m = 0.3/0.7; print 2e-3*E/(2*((9 + 4)/(9 - 4) + m + (4 + 1)/(4 - 1) - m)) }' </dev/null)
near 'pressure of the fit' "$(path fit radius s_rr | sed -n 21p)" "$(value "-1*$p")" 0.01
near 'hoop stress of the hub' "$(path fit radius s_tt | sed -n 22p)" "$(value "13/5*$p")" 0.01
near 'hoop stress of the ring' "$(path fit radius s_tt | sed -n 21p)" "$(value "-5/3*$p")" 0.01
[ "$(path fit joint s | wc -l)" -eq 31 ] || complain 'a path that keeps to a set'
near 'it is told where it begins' "$(path fit joint x | head -1)" 0 1e-12

# *OBSERVE: columns of sweep and study; the deck as run is a deck; its errors have places.
rm -rf sweep study
"$atrito" sweep "$here/beam.inp" --vary q=1e-3,2e-3 -o sweep --observe 'more=u2(L,0)' --quiet --digits 17 || complain 'a sweep'
near 'twice the load' "$(column sweep/runs.tab tip | tail -1)" "$(value "2*$(observed beam tip)")" 1e-15
[ "$(column sweep/runs.tab more | wc -l)" -eq 2 ] || complain 'a sweep that is asked for more'
"$atrito" study "$here/beam.inp" --levels 2 -o study --reference tip=-4.03e-4 --quiet || complain 'a study'
grep -q 'tip  *tip_error  *tip_order' study/study.tab || complain 'columns of a study'
run 0 beam/beam.run.inp again --digits 17 --quiet
"$atrito" compare beam again --rtol 0 >compare.out || complain 'the deck as run'
sed 's/^tip = u2/tip = u3/' "$here/beam.inp" >wrong.inp
run 2 wrong.inp wrong --quiet
says 'a wrong line' wrong.err 'wrong.inp:19:7: error [E-OBSERVE] *OBSERVE tip: unknown quantity u3' 'nearest:  u2' 'atrito help OBSERVE'
absent wrong
sed 's/^tip = u2.*/tip/' "$here/beam.inp" >wrong.inp
run 2 wrong.inp wrong --quiet
says 'a line without a value' wrong.err 'wrong.inp:19:1: error' 'the expression ends too early'
run 1 "$here/beam.inp" twice --quiet --observe 'tip=u2(L,0)'
says 'a name in deck and command' twice.err '--observe tip: tip is given twice'
finish
