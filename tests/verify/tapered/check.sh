# check.sh ATRITO CASE_FOLDER INPUT_FOLDER
. "$(dirname "$0")/../lib.sh"

plane='CPE3 CPE4 CPE6 CPE8 CPE9 CPE4R CPE8R'
thin='CPS3 CPS4 CPS6 CPS8 CPS9 CPS4R CPS8R'

# mesh TYPE [NAME=VALUE ...]: a mesh of mesh.awk
mesh() {
   of=$1
   shift
   set -- "$@" end
   while [ "$1" != end ]; do set -- "$@" -v "$1"; shift; done
   shift
   awk -v type="$of" "$@" -f "$here/../mesh.awk" </dev/null
}
# thickness FILE EXPRESSION: *NODAL THICKNESS of the nodes of a mesh, by their x and y
thickness() {
   echo '*NODAL THICKNESS'
   awk -F, '/^\*/ { on = ($0 ~ /^\*NODE/); next } on { x = $2; y = $3; printf "%d, %.17g\n", $1, ('"$2"') }' "$1"
}
# section TYPE [OPTIONS]: of E = 1000, mu = 0.3
section() {
   printf '%s\n' '*MATERIAL, NAME=M' '*ELASTIC' '1000, 0.3' '*EXPANSION' 1e-3 "*SOLID SECTION, ELSET=ALL, MATERIAL=M, NODAL THICKNESS${2-}"
}

# A linear field at all nodes: energy = e'D e V/2 with V = int h dA = 1.375
motion() { # motion E11 E12 E21 E22: of all nodes
   echo '*BOUNDARY'
   awk -F, -v a="$1" -v b="$2" -v c="$3" -v d="$4" '/^\*/ { on = ($0 ~ /^\*NODE/); next }
      on { printf "%d, 1, 1, %.17g\n%d, 2, 2, %.17g\n", $1, a*$2 + b*$3, $1, c*$2 + d*$3 }' mesh.txt
}
step() { # step NAME, what it holds on standard input
   {
      cat head.txt
      printf '%s\n' '*STEP' '*STATIC'
      cat
      printf '%s\n' '*NODE PRINT' 'U, RF' '*EL PRINT' S '*END STEP'
   } >"$1.inp"
   run 0 "$1.inp" "$1" --digits 17 --quiet
}
for kind in $plane $thin CPE4-BBAR; do
   type=${kind%-BBAR}
   options=
   case $kind in *BBAR) options=', FORMULATION=BBAR' ;; esac
   mesh $type n=4 m=4 map=trapezoids >mesh.txt
   {
      cat mesh.txt
      thickness mesh.txt '1 + 0.5*x + 0.25*y'
      section $type "$options"
   } >head.txt
   motion 2e-3 1e-3 5e-4 -3e-3 | step field
   case $type in CPE*) lambda='1000*0.3/(1.3*0.4)' modulus='3*1000/0.4' ;; *) lambda='1000*0.3/(1.3*0.7)' modulus='2*1000/0.7' ;; esac
   shear='1000/2.6'
   near "$kind, energy of a linear field" "$(summary field strain_energy)" \
      "$(value "0.5*1.375*($lambda*1e-6 + 2*$shear*(4e-6 + 9e-6) + $shear*2.25e-6)")" 1e-14
   all_near "$kind, s11 of a linear field" field/stress.tab s11 "$(value "-$lambda*1e-3 + 2*$shear*2e-3")" 1e-12
   below "$kind, linear field, estimated error in %" "$(summary field error_estimate_percent)" 1e-6
   # warmer by 2: all of it is blocked when nothing moves, and nothing where it is free
   { motion 0 0 0 0; printf '%s\n' '*TEMPERATURE' 'ALL, 2'; } | step blocked
   near "$kind, blocked expansion" "$(summary blocked strain_energy)" "$(value "0.5*1.375*$modulus*4e-6")" 1e-14
   printf '%s\n' '*BOUNDARY' '1, 1, 2' 'ALL-LEFT, 1' '*TEMPERATURE' 'ALL, 2' | step free
   all_near "$kind, free expansion" free/stress.tab s11 0 1e-11
   all_near "$kind, free expansion" free/stress.tab s12 0 1e-11
done

# Two blocks, h = 1 + x/2 of both: a pressure passes from one to the other as it is, s22 = -p, whatever the mesh
for type in $plane $thin; do
   for n in 3 2; do
      mesh $type n=2 m=2 elset=LOW >low.txt
      mesh $type n=$n m=2 elset=UP first=1000 dy=1 >up.txt
      {
         cat low.txt up.txt
         cat low.txt up.txt >both.txt
         thickness both.txt '1 + 0.5*x'
         printf '%s\n' '*ELSET, ELSET=ALL' 'LOW, UP'
         section $type
         printf '%s\n' '*SURFACE INTERACTION, NAME=I' '*CONTACT PAIR, INTERACTION=I' 'UP-BOTTOM, LOW-TOP' '*BOUNDARY' 'LOW-BOTTOM, 2' \
            'LOW-LEFT, 1' 'UP-LEFT, 1' '*STEP' '*STATIC' '*DSLOAD' 'UP-TOP, P, 7' '*NODE PRINT' 'U, RF' '*EL PRINT' S '*CONTACT PRINT' 'CSTRESS' '*END STEP'
      } >patch.inp
      run 0 patch.inp patch --digits 17 --quiet
      all_near "$type over $n, pressure" patch/contact.tab pressure 7 1e-9
      all_near "$type over $n, s22" patch/stress.tab s22 -7 1e-9
      all_near "$type over $n, s11" patch/stress.tab s11 0 1e-9
      near "$type over $n, normal force" "$(summary patch normal_resultant)" "$(value 7*1.25)" 1e-10
   done
done

# Loads of all kinds balance the reactions, resultant and moment: h = 1 + x/2 + y/4
for type in CPS3 CPS4 CPS6 CPS8R CPS9; do
   mesh $type n=2 m=2 map=trapezoids >mesh.txt
   {
      cat mesh.txt
      thickness mesh.txt '1 + 0.5*x + 0.25*y'
      section $type | sed 's/^\*EXPANSION/*DENSITY/'
      printf '%s\n' '*BOUNDARY' 'ALL-LEFT, 1, 2' '*STEP' '*STATIC' '*DLOAD' 'ALL, GRAV, 3000, 0, -1' '*DSLOAD' 'ALL-RIGHT, P, 2' \
         'ALL-TOP, TRVEC, 3, 0.6, 0.8' 'ALL-BOTTOM, HP, 5, 1, 0' '*NODE PRINT' 'U, RF' '*END STEP'
   } >loads.inp
   run 0 loads.inp loads --quiet --digits 17
   below "$type, balance of loads" "$(summary loads equilibrium_residual)" 1e-12
   awk '$1 == "applied" { print $2, $3 }' loads/loads.lst >applied.txt
   # P on the right: int h = 1.625; TRVEC on the top: 1.5; HP on the bottom, 5 at the level 0: 1.25; weight 3: 1.375
   near "$type, applied along x" "$(cut -d' ' -f1 applied.txt)" "$(value '-2*1.625 + 3*0.6*1.5')" 2e-5
   near "$type, applied along y" "$(cut -d' ' -f2 applied.txt)" "$(value '3*0.8*1.5 + 5*1.25 - 3*1.375')" 2e-5
done

# A bar of thickness 1 + x/2, 4 long: F/E int dx/h = 2 ln(3) F/E without Poisson's effect; elements of four nodes give F/E times the sum
# of their lengths over their mean thickness.
bar() { # bar TYPE
   mesh $1 n=2 m=1 | awk -F, '/^\*/ { on = ($0 ~ /^\*NODE/); print; next } on { printf "%d, %.17g, %.17g\n", $1, 4*$2, $3; next } 1' >mesh.txt
   cat mesh.txt
   thickness mesh.txt '1 + 0.5*x'
}
rest() { # of the bar, with the force F
   printf '%s\n' '*MATERIAL, NAME=M' '*ELASTIC' '1000, 0' "*SOLID SECTION, ELSET=ALL, MATERIAL=M, NODAL THICKNESS" '*BOUNDARY' 'ALL-LEFT, 1' '1, 2' \
      '*STEP' '*STATIC' '*DSLOAD' "ALL-RIGHT, P, <-F/3>" '*NODE PRINT' U '*EL PRINT' S '*END STEP'
}
for type in CPS4 CPE4 CPS4R CPE4R; do
   { printf '*PARAMETER\nF = 6\n'; bar $type; rest; } >bar.inp
   run 0 bar.inp bar --digits 17 --quiet
   near "$type, end of a bar" "$(awk '!/^#/ && $3 == 4 { print $5; exit }' bar/nodes.tab)" "$(value '6/1000*(2/1.5 + 2/2.5)')" 1e-15
done
for type in CPS8 CPE8R CPS9; do
   { printf '*PARAMETER\nF = 6\n'; bar $type; rest; } >bar.inp
   run 0 bar.inp bar --refine 4 --digits 17 --quiet
   near "$type, end of a refined bar" "$(awk '!/^#/ && $3 == 4 { print $5; exit }' bar/nodes.tab)" "$(value '6/1000*2*log(3)')" 1e-9
done
# what a sweep keeps of the run before has another thickness
sed 's/^1, 1$/1, <T>/; s/^\*PARAMETER/&\nT = 1/' bar.inp >sweep.inp
rm -rf swept
"$atrito" sweep sweep.inp --vary T=1,2 -o swept --quiet --digits 17 >swept.out 2>swept.err || complain "sweep: $(cat swept.err)"
for t in 1 2; do
   run 0 sweep.inp single --set T=$t --quiet --digits 17
   near "energy of a sweep, $t" "$(summary swept/T_$t strain_energy)" "$(summary single strain_energy)" 0
done
[ "$(summary swept/T_1 strain_energy)" != "$(summary swept/T_2 strain_energy)" ] || complain 'the sweep changes nothing'

# A wedge of plane strain, beside CalculiX, which prints 7 digits; as a part, and turned in another instance
awk 'NF == 4 && $1 ~ /^[0-9]+$/ { print $1, $2, $3 }' "$here/wedge.ccx" >expected.dat
off() { # off FILE: largest difference of the displacements, of the largest one
   awk 'NR == FNR { u[$1] = $2; v[$1] = $3; for (i = 2; i < 4; i++) if ($i^2 > most) most = $i^2; next }
      !/^#/ { d = ($5 - u[$2])^2 + ($6 - v[$2])^2; if (d > worst) worst = d; n++ }
      END { printf "%.3e\n", (n == 53) ? sqrt(worst/most) : 1 }' expected.dat "$1"
}
run 0 "$here/wedge.inp" wedge --digits 17 --quiet
below 'wedge beside CalculiX' "$(off wedge/nodes.tab)" 5e-7
awk '/^\*MATERIAL/ { skip = 2 } skip { skip--; kept = kept $0 "\n"; if ($0 ~ /^\*ELASTIC/) skip = 1; next }
   /^\*BOUNDARY/ { exit } /^\*HEADING/ { getline; next } { print }
   END { printf "%s", kept >"material.txt" }' "$here/wedge.inp" >part.txt
{
   printf '%s\n' '*PART, NAME=P'
   cat part.txt
   printf '%s\n' '*END PART' '*ASSEMBLY, NAME=A' '*INSTANCE, NAME=I, PART=P' '*END INSTANCE' '*INSTANCE, NAME=J, PART=P' '10, 0, 0' '10, 0, 0, 10, 0, 1, 90' \
      '*END INSTANCE' '*END ASSEMBLY'
   cat material.txt
   printf '%s\n' '*BOUNDARY' 'I.ALLLEFT, 1, 2' 'J.ALLLEFT, 1, 2' '*STEP' '*STATIC' '*CLOAD' 'I.ALLRIGHT, 2, 0.002' 'J.ALLRIGHT, 1, -0.002' '*NODE PRINT' U '*END STEP'
} >instances.inp
run 0 instances.inp instances --digits 17 --quiet
awk '/^#/ || $2 < 100 { print }' instances/nodes.tab >first.txt
awk '/^#/ { print; next } $2 > 100 { printf "%d %d %s %s %s %.17g\n", $1, $2 - 100, $3, $4, $6, -$5 }' instances/nodes.tab >second.txt
below 'first instance' "$(off first.txt)" 5e-7
below 'turned instance' "$(off second.txt)" 5e-7
grep -Eq '  M +STANDARD +[0-9]+ +of nodes$' instances/instances.lst || complain 'listing'

# faces of both kinds of thickness, one after the other on one slave
run 0 "$here/mixed.inp" mixed --quiet
all_near 'pressure of both halves' mixed/contact.tab pressure 10 1e-12
finish
