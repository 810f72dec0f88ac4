. "$(dirname "$0")/../lib.sh"

# uniform NAME ANGLE SHEAR: in the axes of the stack s22 = -10, s12 = SHEAR, s11 = 0.
uniform() {
   below "$1: stress" "$(worst_stress "$@")" 1e-10
}
worst_stress() {
   awk -v a="$2" -v q="$3" '
      function off(x) { if (x !~ /n/ && x < 0) x = -x; if (x > worst || x ~ /n/) worst = x }
      BEGIN { a *= atan2(0, -1)/180; c = cos(a); s = sin(a) }
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2; next }
      /^#/ { next }
      { rows++; xx = $at["s11"]; yy = $at["s22"]; xy = $at["s12"]
        off(c*c*xx + 2*s*c*xy + s*s*yy); off(s*s*xx - 2*s*c*xy + c*c*yy + 10); off(s*c*(yy - xx) + (c*c - s*s)*xy - q) }
      END { if (rows == 0) print "none"; else printf "%.17g", worst }' "$1/stress.tab"
}

# balanced NAME ANGLE [LEN]: the forces on each body, and the contact forces of all bodies, with their moments; the largest is 1.
balanced() {
   below "$1: balance" "$(awk -v angle="$2" -v len="${3:-2}" '
      function size(v) { if (v < 0) v = -v; if (v > largest) largest = v }
      function off(v) { if (v < 0) v = -v; if (v > worst) worst = v }
      BEGIN { c = cos(angle*atan2(0, -1)/180); s = sin(angle*atan2(0, -1)/180); split("_fx _fy _moment", what, " ") }
      /^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2; next }
      /^#/ { next }
      { x = c*len/2 - s*(bodies + 0.5); y = s*len/2 + c*(bodies + 0.5); bodies++
        for (k = 1; k <= 3; k++) {
           a[1] = $at["loads" what[k]]; a[2] = $at["supports" what[k]]; a[3] = $at["contact" what[k]]
           size(a[1]); size(a[2]); size(a[3]); off(a[1] + a[2] + a[3]); sum[k] += a[3] }
        sum[3] += x*$at["contact_fy"] - y*$at["contact_fx"] }
      END { for (k = 1; k <= 3; k++) off(sum[k]); if (bodies < 2 || largest == 0) print "none"; else printf "%.17g", worst/largest }' \
      "$1/bodies.tab")" 1e-12
}

# joints NAME N T: resultants of all joints, t whichever body comes first.
joints() {
   all_near "$1: n of the joints" "$1/joints.tab" n "$2" 2e-11
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) if ($i == "t") k = i } !/^#/ { sub("-", "", $(k - 2)) } { print }' \
      "$1/joints.tab" >"$1.joints"
   all_near "$1: t of the joints" "$1.joints" t "$3" 2e-11
}

# 1. Patch tests
two='CPE4:3_CPE4:2 CPE9:7_CPE9:5 CPE9:1_CPE4:10 CPE4:10_CPE9:1 CPE4:20:1_CPE4:23:2'
two="$two CPE3:3_CPE3:2 CPE6:3_CPE6:2 CPE3:1_CPE3:10 CPE6:10_CPE6:1 CPE6:20:1_CPE3:23:2"
three='CPE4:2_CPE9:3_CPE4:5 CPE9:7:3_CPE4:5:11_CPE9:9:4 CPE9:7:3_CPE6:5:11_CPE3:9:4'
for layers in $two $three; do
   for roles in 0 1; do
      for law in HARD PENALTY LINEAR; do
         for form in dense sparse; do
            name=$layers-$roles-$law-$form
            stack "$name" $form layers="$(echo "$layers" | tr _ ' ')" angle=30 roles=$roles law=$law
            uniform "$name" 30 0
            balanced "$name" 30
            joints "$name" 20 0
         done
      done
   done
done
# every other plane element, the two forms of the contact system in turns; with mu = 0.3 on inclined supports
form=dense
for layers in CPS3:3_CPS6:2 CPS8:7_CPS8:5 CPE8:1_CPE4R:10 CPE4R:3_CPE4R:2 CPE8R:10_CPE8:1 CPS4R:20:1_CPS8R:23:2 \
   CPE8R:1_CPE3:10 CPS9:7:3_CPS8:5:11_CPS4R:9:4 CPS8R:2_CPS4:3_CPS6:5; do
   for roles in 0 1; do
      for law in HARD PENALTY; do
         for mu in 0 0.3; do
            name=$layers-$roles-$law-$mu
            stack "$name" $form layers="$(echo "$layers" | tr _ ' ')" angle=30 roles=$roles law=$law mu=$mu
            uniform "$name" 30 0
            balanced "$name" 30
            joints "$name" 20 0
            [ $form = dense ] && form=sparse || form=dense
         done
         [ $form = dense ] && form=sparse || form=dense
      done
   done
done
# points at nodes do not pass it, which these assertions notice
stack nodal auto layers='CPE4:3 CPE4:2' angle=30 quadrature=NODAL
awk -v w="$(worst_stress nodal 30 0)" 'BEGIN { exit !(w > 1) }' </dev/null || complain 'NODAL passes the patch test'
balanced nodal 30

# 2. Friction: a uniform shear stress, stuck, or sliding with all the friction there is
for layers in CPE4:3_CPE4:2 CPE9:1_CPE4:10 CPE9:7:3_CPE4:5:11_CPE9:9:4 CPE6:3_CPE3:2; do
   for roles in 0 1; do
      for rho in 0 0.5; do
         for form in dense sparse; do
            name=$layers-$roles-$rho-$form
            set -- layers="$(echo "$layers" | tr _ ' ')" roles=$roles rho=$rho sides=1 shear=0.2
            stack "stuck-$name" $form "$@" angle=30 nu=0.5
            uniform "stuck-$name" 30 2
            balanced "stuck-$name" 30
            joints "stuck-$name" 20 4
            all_near "stuck-$name: slip" "stuck-$name/contact.tab" slip 0 1e-14
            stack "slides-$name" $form "$@" nu=0.2 slide=0.02
            uniform "slides-$name" 0 2
            balanced "slides-$name" 0
            joints "slides-$name" 20 4
         done
      done
   done
done
# what is not uniform and slides in part: the resultants are those of the loads
for layers in CPE4:20:1_CPE4:23:2 CPE9:7:3_CPE4:5:11_CPE9:9:4; do
   for roles in 0 1; do
      for rho in 0 0.5; do
         name=part-$layers-$roles-$rho
         stack "$name" auto layers="$(echo "$layers" | tr _ ' ')" roles=$roles rho=$rho angle=30 load=wave shear=0.2 nu=0.25
         balanced "$name" 30
         joints "$name" 20 4
      done
   done
done

# 3. One face on ten under p (1 + cos(pi x/4)/2), mean p = 10, against nine-node elements that match and are ten times smaller.
# noise WHAT NAME REFERENCE LIMIT: largest difference of the pressures, in parts of the mean; linear between the points of REFERENCE.
noise() {
   for table in "$2" "$3"; do
      awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ { print $at["x"], $at["pressure"] }' "$table/contact.tab" |
         sort -g >"$table.xp"
   done
   below "$1" "$(awk 'FNR == NR { x[++n] = $1; p[n] = $2; k = 1; next }
      { while (k < n - 1 && x[k + 1] < $1) k++
        d = p[k] + (p[k + 1] - p[k])*($1 - x[k])/(x[k + 1] - x[k]) - $2; if (d < 0) d = -d; if (d > worst) worst = d; rows++ }
      END { if (n < 2 || rows < 2) print "none"; else printf "%.17g", worst/10 }' "$3.xp" "$2.xp")" "$4"
}
wave="load=wave len=4"
stack fine auto $wave layers='CPE9:160 CPE9:160' rows=20
stack coarse4 auto $wave layers='CPE4:16 CPE4:16' rows=20 quadrature=NODAL
for order in 4 9 6; do
   for roles in 0 1; do
      stack "low-$order-$roles" auto $wave layers="CPE$order:16 CPE$order:160" rows=20 roles=$roles
      stack "up-$order-$roles" auto $wave layers="CPE$order:160 CPE$order:16" rows=20 roles=$roles
   done
   noise "CPE$order, the finer side is the slave and above" low-$order-0 fine 0.02
   noise "CPE$order, the finer side is the slave and below" up-$order-1 fine 0.02
done
noise 'CPE6, the coarser side is the slave and below' low-6-1 fine 0.02
noise 'CPE6, the coarser side is the slave and above' up-6-0 fine 0.02
noise 'CPE9, the coarser side is the slave and below' low-9-1 fine 0.02
noise 'CPE9, the coarser side is the slave and above' up-9-0 fine 0.02
# 16 elements with four nodes are off by 2 % at their ends also where they match
noise 'CPE4, the coarser side is the slave and below: what is added' low-4-1 coarse4 0.02
noise 'CPE4, the coarser side is the slave and above: what is added' up-4-0 coarse4 0.02
finish
