# check.sh ATRITO CASE_FOLDER INPUT_FOLDER
. "$(dirname "$0")/../lib.sh"

plane='CPE3 CPE4 CPE6 CPE8 CPE9 CPE4R CPE8R'
thin='CPS3 CPS4 CPS6 CPS8 CPS9 CPS4R CPS8R'
rings='CAX3 CAX4 CAX6 CAX8 CAX9 CAX4R CAX8R'

# CalculiX prints 7 digits
for type in CPE8 CPE8R; do
   sed "s/TYPE=CPE8/TYPE=$type/" "$here/grain.inp" >grain.inp
   run 0 grain.inp grain-$type --digits 17 --quiet
   awk '/stresses/ { exit } NF == 4 { print }' "$here/grain-$type.ccx" >expected.dat
   awk 'NR == FNR { u[$1] = $2; v[$1] = $3; for (i = 2; i < 4; i++) if ($i^2 > most) most = $i^2; next }
      !/^#/ { d = ($5 - u[$2])^2 + ($6 - v[$2])^2; if (d > worst) worst = d; n++ }
      END { printf "%.3e\n", (n == 13) ? sqrt(worst/most) : 1 }' expected.dat grain-$type/nodes.tab >off.txt
   below "grain of $type, displacements" "$(cat off.txt)" 2e-7
done
# the four points of each layer of two elements
awk '/stresses/ { on = 1 } on && $1 ~ /^[0-9]+$/ && $2 < 5 { print $5 }' "$here/grain-CPE8R.ccx" >expected.dat
column grain-CPE8R/stress.tab s33 | paste expected.dat - | awk '{ d = ($1 - $2)^2; if (d > w) w = d; n++ } END { printf "%.3e\n", (n == 8) ? sqrt(w) : 1 }' >off.txt
below 'grain of CPE8R, s33' "$(cat off.txt)" 1e-6

# Off-axis tension of 5: the first axis along (0.8, 0.6). strain I J: of the plane by a stress of 1 along x
tension() {
   printf '%s\n' "*BLOCK, TYPE=$1, ELSET=C, NX=3, NY=2" '0, 0' '2, 0' '2, 1' '0, 1.2' '*ORIENTATION, NAME=O' '4, 3, 0, -3, 4, 0' '*MATERIAL, NAME=M' \
      '*ELASTIC, TYPE=ENGINEERING CONSTANTS' '11e3, 900, 500, 0.4, 0.45, 0.35, 700, 650' 60 '*SOLID SECTION, ELSET=C, MATERIAL=M, ORIENTATION=O' \
      0.5 '*BOUNDARY' 'C-LEFT, 1' '1, 2' '*STEP' '*STATIC' '*DSLOAD' 'C-RIGHT, TRVEC, 5, 1, 0' 'C-TOP, TRVEC, T, 1, 0' '*NODE PRINT' 'U, RF' '*EL PRINT' 'S' '*END STEP' |
      awk '{ sub(/TRVEC, T,/, sprintf("TRVEC, %.17g,", 5*0.2/sqrt(4.04))); print }'
}
terms() { # terms PLANE: s11 s12 s22 s66 along the axes of the material
   awk -v plane="$1" 'BEGIN { s11 = 1/11e3; s22 = 1/900; s33 = 1/500; s12 = -0.4/11e3; s13 = -0.45/11e3; s23 = -0.35/900
      if (plane) { s11 -= s13^2/s33; s22 -= s23^2/s33; s12 -= s13*s23/s33 }
      c = 0.8; s = 0.6; m = 1/700
      printf "%.17g %.17g %.17g %.17g\n", s11*c^4 + (2*s12 + m)*c^2*s^2 + s22*s^4, (s11 + s22 - m)*c^2*s^2 + s12*(c^4 + s^4),
         (2*s11 - 2*s12 - m)*c^3*s - (2*s22 - 2*s12 - m)*c*s^3, -(s13*c^2 + s23*s^2)/s33 }'
}
for type in $plane $thin; do
   tension $type >tension.inp
   run 0 tension.inp tension --digits 17 --quiet
   case $type in CPE*) set -- $(terms 1) ;; *) set -- $(terms 0); shift 3; set -- $(terms 0 | cut -d' ' -f1-3) 0 ;; esac
   field_near "$type, tension" tension/nodes.tab u1 "5*($1)*x" 1e-13
   field_near "$type, tension" tension/nodes.tab u2 "5*(($2)*y + ($3)*x)" 1e-13
   all_near "$type, tension" tension/stress.tab s11 5 1e-10
   all_near "$type, tension" tension/stress.tab s22 0 1e-10
   all_near "$type, tension" tension/stress.tab s12 0 1e-10
   all_near "$type, tension" tension/stress.tab s33 "$(value "5*($4)")" 1e-10
   near "$type, tension, energy" "$(summary tension strain_energy)" "$(value "0.5*25*($1)*2.2*0.5")" 1e-12
   below "$type, tension, estimated error in %" "$(summary tension error_estimate_percent)" 1e-6
done

# u = A r^k + B r^-k from s_r(1) = -1, s_r(2) = 0
for type in $rings; do
   printf '%s\n' "*BLOCK, TYPE=$type, ELSET=C, NX=4, NY=2" '1, 0' '2, 0' '2, 1' '1, 1' '*MATERIAL, NAME=M' '*ELASTIC, TYPE=ORTHO' \
      '1000, 300, 800, 400, 350, 4000, 200, 100' 100 '*SOLID SECTION, ELSET=C, MATERIAL=M' '*BOUNDARY' 'C-BOTTOM, 2' 'C-TOP, 2' '*STEP' '*STATIC' \
      '*DSLOAD' 'C-LEFT, P, 1' '*NODE PRINT' U '*EL PRINT' S '*END STEP' >ring.inp
   run 0 ring.inp ring-$type --refine 2 --digits 17 --quiet
   tolerance=1e-6
   case $type in CAX3) tolerance=1e-2 ;; CAX4|CAX4R) tolerance=3e-3 ;; CAX6) tolerance=2e-4 ;; esac
   for r in 1 2; do
      u=$(awk -v r=$r 'BEGIN { k = 2; p = 1000*k + 400; q = -1000*k + 400 # s_r = p A r^(k-1) + q B r^(-k-1)
         a = -1/(p - q*2^(k - 1)*p/(q*2^(-k - 1))); b = -a*p*2^(k - 1)/(q*2^(-k - 1)); printf "%.17g", a*r^k + b*r^-k }')
      found=$(awk -v r=$r '!/^#/ && $3 == r && $4 == 0 { print $5 }' ring-$type/nodes.tab)
      near "$type, cylinder, r = $r" "$(value "($found)/($u)")" 1 $tolerance
   done
done

# An isotropic material by its constants, by its stiffnesses, and turned.
constants='*ELASTIC, TYPE=ENGINEERING CONSTANTS\n21e4, 21e4, 21e4, 0.3, 0.3, 0.3, <g>, <g>\n<g>, 20.'
stiffnesses='*ELASTIC, TYPE=ORTHO\n<d>, <l>, <d>, <l>, <l>, <d>, <g>, <g>\n<g>'
numbers='*PARAMETER\ng = 21e4/2.6\nl = 21e4*0.3/(1.3*0.4)\nd = l + 2*g'
for type in $plane $thin $rings; do
   for load in bend heat; do
      printf '%s\n' "*BLOCK, TYPE=$type, ELSET=C, NX=4, NY=3" '1, 0' '3, 0.2' '2.8, 1' '1, 1.3' '*MATERIAL, NAME=M' '*ELASTIC' '21e4, 0.3' \
         '*EXPANSION' 1.2e-5 '*SOLID SECTION, ELSET=C, MATERIAL=M' 1 '*INITIAL CONDITIONS, TYPE=TEMPERATURE' 'C, 20' '*BOUNDARY' 'C-LEFT, 1, 2' '*STEP' '*STATIC' >iso-$load.inp
   done
   printf '%s\n' '*DSLOAD' 'C-TOP, P, 3' 'C-RIGHT, TRVEC, 4, 1, 2' >>iso-bend.inp
   printf '%s\n' '*TEMPERATURE' 'C-LEFT, 100' 'C-RIGHT, 300' >>iso-heat.inp
   for load in bend heat; do
      printf '%s\n' '*NODE PRINT' 'U, RF' '*EL PRINT' S '*END STEP' >>iso-$load.inp
      run 0 iso-$load.inp iso --digits 17 --quiet
      for way in constants stiffnesses; do
         eval "lines=\$$way"
         awk -v numbers="$numbers" -v lines="$lines" -v turned=$way 'NR == 1 { print numbers
            if (turned == "constants") print "*ORIENTATION, NAME=O\n5, 2, 0, 0, 1, 0\n3, 17" }
            /^\*ELASTIC/ { print lines; getline; next } /^\*SOLID/ && turned == "constants" { $0 = $0 ", ORIENTATION=O" } { print }' iso-$load.inp >ortho.inp
         run 0 ortho.inp ortho --digits 17 --quiet
         same_tables "$type, $load, $way" iso/nodes.tab ortho/nodes.tab 1e-11
         same_tables "$type, $load, $way, stresses" iso/stress.tab ortho/stress.tab 1e-10
         near "$type, $load, $way, energy" "$(value "$(summary ortho strain_energy)/($(summary iso strain_energy))")" 1 1e-10
         near "$type, $load, $way, error in %" "$(summary ortho error_estimate_percent)" "$(summary iso error_estimate_percent)" 1e-7
      done
   done
done

# A quarter turn exchanges the axes, in the plane and in rings.
for type in CPE4R CPS8 CPE9 CAX4 CAX4R CAX8R; do
   printf '%s\n' "*BLOCK, TYPE=$type, ELSET=C, NX=4, NY=3" '1, 0' '3, 0.2' '2.8, 1' '1, 1.3' '*ORIENTATION, NAME=O' 'AXES' '*MATERIAL, NAME=M' \
      '*ELASTIC, TYPE=ENGINEERING CONSTANTS' NUMBERS 60 '*EXPANSION' 1e-5 '*SOLID SECTION, ELSET=C, MATERIAL=M, ORIENTATION=O' 1 '*BOUNDARY' 'C-LEFT, 1, 2' \
      '*STEP' '*STATIC' '*DSLOAD' 'C-TOP, P, 3' '*TEMPERATURE' 'C-RIGHT, 100' '*NODE PRINT' U '*EL PRINT' S '*END STEP' >turn.inp
   sed 's/AXES/1, 0, 0, 0, 1, 0/; s/NUMBERS/11e3, 900, 500, 0.4, 0.45, 0.35, 700, 650/' turn.inp >straight.inp
   # nu21 = nu12 E2/E1
   sed "s/AXES/0, 2, 0, -1, 0, 0/; s/NUMBERS/900, 11e3, 500, $(value '0.4*900/11e3'), 0.35, 0.45, 700, 650/" turn.inp >turned.inp
   sed 's/^0, 2, 0, -1, 0, 0/1, 0, 0, 0, 1, 0\n3, 90/' turned.inp >angle.inp
   run 0 straight.inp straight --digits 17 --quiet
   for way in turned angle; do
      run 0 $way.inp $way --digits 17 --quiet
      same_tables "$type, a quarter turn, $way" straight/nodes.tab $way/nodes.tab 1e-11
      same_tables "$type, a quarter turn, $way, stresses" straight/stress.tab $way/stress.tab 1e-10
   done
done

# Temperatures: a bar along its first axis, held at both ends; and free.
for type in $plane $thin; do
   printf '%s\n' "*BLOCK, TYPE=$type, ELSET=C, NX=4, NY=2" '0, 0' '2, 0' '2, 1' '0, 1' '*MATERIAL, NAME=M' \
      '*ELASTIC, TYPE=ENGINEERING CONSTANTS' '11e3, 900, 500, 0.4, 0.45, 0.35, 700, 650' 60 '*EXPANSION' '1e-4, 0' '1e-4, 100' \
      '*SOLID SECTION, ELSET=C, MATERIAL=M' 0.5 '*BOUNDARY' 'C-LEFT, 1' 'C-RIGHT, 1' '1, 2' '*STEP' '*STATIC' '*TEMPERATURE' 'C, 50' \
      '*NODE PRINT' 'U, RF' '*EL PRINT' S '*END STEP' >bar.inp
   run 0 bar.inp bar --digits 17 --quiet
   # S11 s1 + S13 s3 = -alpha T, S13 s1 + S33 s3 = -alpha T
   set -- $(awk 'BEGIN { a = 1/11e3; b = -0.45/11e3; c = 1/500; d = a*c - b^2; printf "%.17g %.17g\n", -5e-3*(c - b)/d, -5e-3*(a - b)/d }')
   case $type in CPS*) set -- -55 0 ;; esac
   all_near "$type, heated bar" bar/stress.tab s11 "$1" 1e-9
   all_near "$type, heated bar" bar/stress.tab s33 "$2" 1e-9
   all_near "$type, heated bar" bar/stress.tab s22 0 1e-9
   # half of the stresses times the strains -alpha T that are held
   near "$type, heated bar, energy" "$(summary bar strain_energy)" "$(value "-0.5*(($1) + ($2))*5e-3*2*0.5")" 1e-11
   sed '/^C-RIGHT, 1$/d; s/^3, 0.2$/3, 0.3/; s/MATERIAL=M/&, ORIENTATION=O/; s/^\*MATERIAL/*ORIENTATION, NAME=O\n1, 2, 0, 0, 1, 0\n&/' bar.inp >free.inp
   case $type in CPE*) continue ;; esac
   run 0 free.inp free --digits 17 --quiet
   for component in s11 s22 s12; do all_near "$type, free" free/stress.tab $component 0 1e-10; done
   field_near "$type, free" free/nodes.tab u1 '5e-3*x' 1e-14
done
finish
