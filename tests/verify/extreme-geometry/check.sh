. "$(dirname "$0")/../lib.sh"
# Unit of the last place kept in a stiffness.
grid=$(value '2^-49')

# bar NAME TYPE L H NX NY OX OY OPTION TOLERANCE
bar() {
   { printf '*HEADING\nBar\n*BLOCK, TYPE=%s, ELSET=ALL, NX=%d, NY=%d\n' "$2" "$5" "$6"
     awk -v l="$3" -v h="$4" -v x="$7" -v y="$8" 'BEGIN {
        printf "%.17g, %.17g\n%.17g, %.17g\n%.17g, %.17g\n%.17g, %.17g\n", x, y, x + l, y, x + l, y + h, x, y + h }' </dev/null
     echo "*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=ALL, MATERIAL=M$9
*BOUNDARY
ALL-LEFT, 1
ALL-BOTTOM, 2
*STEP
*STATIC
*DSLOAD
ALL-RIGHT, P, -1
*NODE PRINT
U
*EL PRINT
S
*END STEP"; } >"$1.inp"
   run 0 "$1.inp" "$1" --digits 17 --quiet
   case $2 in
   CPS*) along=1e-3 across=3e-4 ;;
   *) along=0.91e-3 across=0.39e-3 ;;
   esac
   shift 9
   field_near "$name: u1 over the largest" $name/nodes.tab u1 "$along*(x - ($ox))" "$(value "$1*$along*$l")"
   field_near "$name: u2 over the largest" $name/nodes.tab u2 "-$across*(y - ($oy))" "$(value "$1*$across*$h")"
   all_near "$name: s11" $name/stress.tab s11 1 "$1"
   all_near "$name: s22" $name/stress.tab s22 0 "$1"
   all_near "$name: s12" $name/stress.tab s12 0 "$1"
}
# of KIND L H NX NY OX OY TOLERANCE
of() {
   kind=$1 l=$2 h=$3 ox=$6 oy=$7
   name=bar-$(echo "$kind-$2-$3-$4x$5-$6" | tr -d '+')
   case $kind in
   BBAR) bar "$name" CPE4 "$l" "$h" "$4" "$5" "$ox" "$oy" ", FORMULATION=BBAR" "$8" ;;
   *) bar "$name" "$kind" "$l" "$h" "$4" "$5" "$ox" "$oy" '' "$8" ;;
   esac
}
for kind in CPS4 CPE4 BBAR CPE9; do
   for a in 1e3 1e4 1e6; do
      of $kind $a 1 4 4 0 0 "$(value "4*$grid*$a*$a")"
      [ $a != 1e6 ] || says "$name" "$name.err" W-DIGITS
      of $kind 1 $a 4 4 0 0 "$(value "4*$grid*$a*$a")"
   done
   of $kind 1e-3 1e-6 4 4 0 0 "$(value "4*$grid*1e6")"
   of $kind 4 1 16 4 25000000 -25000000 1e-12
   of $kind 3 1 10 3 30000000 -30000000 2e-7
done

# patch NAME SX SY OX OY TOLERANCE: of the stresses over 100 and of the displacements over the largest
patch() {
   awk -F', ' -v sx="$2" -v sy="$3" -v ox="$4" -v oy="$5" '
      /^\*/ { in_nodes = /^\*NODE,/ }
      in_nodes && !/^\*/ { printf "%d, %.17g, %.17g\n", $1, $2*sx + ox, $3*sy + oy; next }
      { print }' "$here/../patch/patch.inp" >"$1.inp"
   run 0 "$1.inp" "$1" --digits 17 --quiet
   all_near "$1: pressure" "$1/contact.tab" pressure 100 "$(value "100*$6")"
   all_near "$1: s22" "$1/stress.tab" s22 -100 "$(value "100*$6")"
   all_near "$1: s11" "$1/stress.tab" s11 0 "$(value "100*$6")"
   all_near "$1: s12" "$1/stress.tab" s12 0 "$(value "100*$6")"
   most=$(value "24/7e4*$2 + (96/7e4 + 91/21e4)*$3")
   # plane strain; E, mu = 7e4, 0.2 below (nodes 1 to 9), 2.1e5, 0.3 above; the penalty gives way by 1e-6
   field_near "$1: u1" "$1/nodes.tab" u1 "(node < 10 ? 24/7e4 : 39/21e4)*(x - ($4))" "$(value "$6*$most")"
   field_near "$1: u2" "$1/nodes.tab" u2 "node < 10 ? -96/7e4*(y - ($5)) : -96/7e4*$3 - 1e-6 - 91/21e4*(y - ($5) - $3)" \
      "$(value "$6*$most")"
}
patch patch-in-place 1 1 0 0 1e-12
patch patch-small 1e-6 1e-6 0 0 1e-12
patch patch-moved 1 1 1e8 -1e8 1e-12
patch patch-wide 1e3 1 0 0 "$(value "4*$grid*4e6")"
patch patch-high 1 1e2 0 0 "$(value "4*$grid*4e4")"

# beam NAME L OX OY: the deck
beam() {
   { printf '*HEADING\nBeam\n*BLOCK, TYPE=CPS9, ELSET=ALL, NX=16, NY=1\n'
     awk -v l="$2" -v x="$3" -v y="$4" 'BEGIN {
        printf "%.17g, %.17g\n%.17g, %.17g\n%.17g, %.17g\n%.17g, %.17g\n", x, y, x + l, y, x + l, y + 1, x, y + 1 }' </dev/null
     echo "*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=ALL, MATERIAL=M
*BOUNDARY
ALL-LEFT, 1
34, 2
*STEP
*STATIC
*CLOAD
33, 1, $(value -1/6)
99, 1, $(value 1/6)
*NODE PRINT
U
*EL PRINT
S
*END STEP"; } >"$1.inp"
}
for l in 16 128 1024; do
   for place in 0 1e8; do
      name=beam-$l-$place
      beam $name $l $place -$place
      run 0 $name.inp $name --digits 17 --quiet
      tolerance=$(value "$grid*$l^4")
      y="(y + $place - 0.5)"
      field_near "$name: u1" $name/nodes.tab u1 "2e-3*(x - $place)*$y" "$(value "$tolerance*1e-3*$l")"
      field_near "$name: u2" $name/nodes.tab u2 "-1e-3*((x - $place)^2 + 0.3*$y^2)" "$(value "$tolerance*1e-3*$l*$l")"
      # the places of the points in the table are rounded: eps 1e8
      field_near "$name: s11" $name/stress.tab s11 "2*$y" "$(value "$tolerance + 3e-16*$place")"
      all_near "$name: s22" $name/stress.tab s22 0 "$tolerance"
      all_near "$name: s12" $name/stress.tab s12 0 "$tolerance"
      [ $l != 1024 ] || says "$name" $name.err W-DIGITS
   done
done
beam beam-8192 8192 0 0
run 4 beam-8192.inp beam-8192 --quiet
absent beam-8192
finish
