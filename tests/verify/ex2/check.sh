. "$(dirname "$0")/../lib.sh"
# displacement FOLDER X Y: u2 of the node there.
displacement() {
   awk -v x="$2" -v y="$3" '!/^#/ && $3 == x && $4 == y { print $6 }' "$1/nodes.tab"
}
# deflection FOLDER: of the axis of the lower beam at mid-span, against the axis over the support.
deflection() {
   awk -v a="$(displacement "$1" 5 0.5)" -v b="$(displacement "$1" 0 0.5)" 'BEGIN { printf "%.17g", b - a }'
}
# share OF: a tolerance as a share of a value.
share() {
   value "$1*$2"
}
independent=8.008e-3
together=2.148e-3
for level in 0 1; do
   for nu in 0 1.3 100; do
      run 0 "$input/ex2-two-plates.inp" "nu-$nu-$level" --set nu=$nu --refine $level --digits 17 --quiet
   done
   percent=$([ $level -eq 0 ] && echo 0.03 || echo 0.01)
   near "level $level: deflection of two beams" "$(deflection nu-0-$level)" $independent "$(share $percent $independent)"
   near "level $level: deflection of one beam" "$(deflection nu-100-$level)" $together "$(share $percent $together)"
   # equation (9): 3 V/(4 h) with V = q (5 - x), q = 1000, h = 1
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) c[$i] = i - 2; next } /^#/ { next }
      $c["x"] >= 2 && $c["x"] < 5 {
         wanted = 3*1000*(5 - $c["x"])/4; d = ($c["shear"] < 0 ? -$c["shear"] : $c["shear"])/wanted - 1
         if (d < 0) d = -d
         rows++; if (d > most) most = d }
      END { printf "%.6g", (rows > 10) ? most : 1 }' "nu-100-$level/contact.tab" >worst
   below "level $level: shear against 3V/(4h) for 2 <= x < 5" "$(cat worst)" 0.01
   for nu in 1.3 100; do
      for k in 0 $nu; do
         awk '/^# columns:/ { for (i = 3; i <= NF; i++) c[$i] = i - 2; print "# columns: pressure"; next }
            !/^#/ { print $c["pressure"] }' "nu-$k-$level/contact.tab" >"p-$k.tab"
      done
      same_tables "level $level: pressure with nu = 0 and $nu" p-0.tab "p-$nu.tab" 1e-8
   done
done
finish
