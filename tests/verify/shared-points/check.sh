. "$(dirname "$0")/../lib.sh"

# law_holds WHAT FOLDER NU: the law holds at every point, friction to 1e-9 of the largest bound of its pair.
law_holds() {
   below "$1: law" "$(awk -v nu="$3" -f "$here/law.awk" "$2/contact.tab")" 1e-9
}

# resultant FOLDER PAIR QUANTITY
resultant() {
   awk -v pair="$2" -v q="$3" '!/^#/ && $2 == pair && $3 == q { print $4 }' "$1/summary.tab"
}

# same_column WHAT A B COLUMN [SIGN]: of contact.tab, to 1e-8 of its largest value.
same_column() {
   column "$2/contact.tab" "$4" >same.a
   column "$3/contact.tab" "$4" >same.b
   below "$1: $4" "$(paste same.a same.b | awk -v sign="${5:-1}" '
      { d = $1 - sign*$2; if (d < 0) d = -d; if (d > worst) worst = d; z = $1 < 0 ? -$1 : $1; if (z > most) most = z }
      END { if (NR == 0 || most == 0) print "none"; else printf "%.3e", worst/most }')" 1e-8
}

# rectangle NAME NX NY X0 Y0 X1 Y1: a block, turned by $turn (radians) about the origin.
rectangle() {
   echo "*BLOCK, TYPE=CPE4, ELSET=$1, NX=$2, NY=$3"
   awk -v a="$turn" -v x0="$4" -v y0="$5" -v x1="$6" -v y1="$7" 'BEGIN {
      split(x0 " " x1 " " x1 " " x0, x, " "); split(y0 " " y0 " " y1 " " y1, y, " ")
      for (i = 1; i <= 4; i++) printf "%.17g, %.17g\n", x[i]*cos(a) - y[i]*sin(a), x[i]*sin(a) + y[i]*cos(a) }' </dev/null
}

material() { # ELSET ...
   printf '*MATERIAL, NAME=M\n*ELASTIC\n2500, 0.2\n'
   for set in "$@"; do printf '*SOLID SECTION, ELSET=%s, MATERIAL=M\n0.7\n' "$set"; done
}

# T-joint: 3 x 0.8 below, two of 1.5 x 0.8 with a joint between them; pressed from above and from the left, t = 0.7.
t_joint() { # FILE TURN
   turn=$2
   {
      rectangle B1 6 2 0 0 3 0.8
      rectangle B2 3 2 0 0.8 1.5 1.6
      rectangle B3 3 2 1.5 0.8 3 1.6
      material B1 B2 B3
      printf '*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.6\n*CONTACT PAIR, INTERACTION=I\n'
      printf 'B2-BOTTOM, B1-TOP\nB3-BOTTOM, B1-TOP\nB3-LEFT, B2-RIGHT\n*STEP\n*STATIC\n*BOUNDARY\nB1-BOTTOM, 1, 2\n'
      printf '*DSLOAD\nB2-TOP, P, 3\nB3-TOP, P, 2\nB2-LEFT, P, 1.1\n*NODE PRINT\nU\n*END STEP\n'
   } >"$1"
}
for turn_of in 0 0.4 1.9; do
   t_joint "t-$turn_of.inp" $turn_of
   run 0 "t-$turn_of.inp" "t-$turn_of" --digits 17
   says "t-joint $turn_of" "t-$turn_of.err" 'N-SHARED'
   law_holds "t-joint $turn_of" "t-$turn_of" 0.6
done
for name in pressure shear; do
   same_column 't-joint turned by 0.4' t-0 t-0.4 $name
   same_column 't-joint turned by 1.9' t-0 t-1.9 $name
done
sed 's/^\*STATIC/*STATIC\n*CONTROLS, METHOD=NEWTON/' t-0.inp >t-newton.inp
run 0 t-newton.inp t-newton --digits 17 --quiet
same_column 't-joint by NEWTON' t-0 t-newton pressure
sed 's/^\*STATIC/*STATIC\n*CONTROLS, METHOD=PICARD/' t-0.inp >t-picard.inp
run 0 t-picard.inp t-picard --digits 17 --quiet
same_column 't-joint by PICARD' t-0 t-picard shear
# T of the beds is +x, of the head joint (slave normal -x) -y; the shear is that on the slave
near 't-joint, weight' "$(value "$(resultant t-0 1 normal_resultant) + $(resultant t-0 2 normal_resultant)")" "$(value '0.7*1.5*5')" 1e-9
near 't-joint, push' "$(value "-($(resultant t-0 1 shear_resultant)) - ($(resultant t-0 2 shear_resultant))")" "$(value '0.7*0.8*1.1')" 1e-9
near 't-joint, B3 along x' "$(value "$(resultant t-0 3 normal_resultant) + $(resultant t-0 2 shear_resultant)")" 0 1e-9
near 't-joint, B3 along y' "$(value "$(resultant t-0 2 normal_resultant) - ($(resultant t-0 3 shear_resultant))")" "$(value '0.7*1.5*2')" 1e-9

# A corner of a rough floor and a rough wall; mirrored the wall stands on the left and the pairs change their order.
corner() { # FILE MIRRORED
   turn=0
   {
      rectangle B 6 3 0 0 1.8 0.9
      material B
      printf '*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -1, 0\nLINE, 3, 0\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR\n'
      if [ "$2" = mirrored ]; then
         printf '*SURFACE, NAME=WALL, TYPE=SEGMENTS\nSTART, 0, 2\nLINE, 0, -1\n*RIGID BODY, ANALYTICAL SURFACE=WALL\n'
         pairs='B-LEFT, WALL\nB-BOTTOM, FLOOR\n'
         side=RIGHT
      else
         printf '*SURFACE, NAME=WALL, TYPE=SEGMENTS\nSTART, 1.8, -1\nLINE, 1.8, 2\n*RIGID BODY, ANALYTICAL SURFACE=WALL\n'
         pairs='B-BOTTOM, FLOOR\nB-RIGHT, WALL\n'
         side=LEFT
      fi
      printf '*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.35\n*CONTACT PAIR, INTERACTION=I\n'"$pairs"
      printf '*STEP\n*STATIC\n*DSLOAD\nB-TOP, P, 12\nB-%s, P, 5\n*NODE PRINT\nU\n*END STEP\n' $side
   } >"$1"
}
corner corner.inp plain
corner mirrored.inp mirrored
for name in corner mirrored; do
   run 0 $name.inp $name --digits 17
   says $name $name.err 'N-SHARED'
   law_holds $name $name 0.35
done
# T of the floor is +x, of the wall +y; of the mirrored wall -y
near 'corner along y' "$(value "$(resultant corner 1 normal_resultant) + $(resultant corner 2 shear_resultant)")" "$(value '0.7*1.8*12')" 1e-9
near 'corner along x' "$(value "$(resultant corner 2 normal_resultant) - ($(resultant corner 1 shear_resultant))")" "$(value '0.7*0.9*5')" 1e-9
near 'mirrored floor' "$(resultant mirrored 2 normal_resultant)" "$(resultant corner 1 normal_resultant)" 1e-8
near 'mirrored floor' "$(resultant mirrored 2 shear_resultant)" "$(value "-($(resultant corner 1 shear_resultant))")" 1e-8
near 'mirrored wall' "$(resultant mirrored 1 normal_resultant)" "$(resultant corner 2 normal_resultant)" 1e-8
near 'mirrored wall' "$(resultant mirrored 1 shear_resultant)" "$(value "-($(resultant corner 2 shear_resultant))")" 1e-8

# A floor that falls by 0.08 in 1, rollers on the left: the node there has one free dof and two unknowns.
{
   printf '*BLOCK, TYPE=CPE4, ELSET=B, NX=6, NY=3\n0, 0\n1.5, -0.12\n1.5, 1\n0, 1\n'
   material B
   printf '*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -1, 0.08\nLINE, 3, -0.24\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR\n'
   printf '*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.4\n*CONTACT PAIR, INTERACTION=I\nB-BOTTOM, FLOOR\n'
   printf '*STEP\n*STATIC\n*BOUNDARY\nB-LEFT, 1\n*DSLOAD\nB-TOP, P, 7\n*NODE PRINT\nU, RF\n*END STEP\n'
} >tilted.inp
run 0 tilted.inp tilted --digits 17
says tilted tilted.err 'N-SHARED'
law_holds tilted tilted 0.4
# p acts along (0.08, 1)/l, the shear on the slave along T = (1, -0.08)/l
near 'tilted along y' "$(value "($(resultant tilted 1 normal_resultant) - 0.08*($(resultant tilted 1 shear_resultant)))/sqrt(1 + 0.08^2)")" \
   "$(value '0.7*1.5*7')" 1e-9

# A quarter of a shrink fit, overlap 2e-4 of the radius, coordinates with 12 digits, symmetry lines, friction.
awk 'BEGIN {
   n = 18; rings = 3; pi = atan2(0, -1)
   for (body = 1; body <= 2; body++) {
      inner = body == 1 ? 0.7 : 0.9998; outer = body == 1 ? 1 : 1.4; base = 1000*body
      printf "*NODE\n"
      for (i = 0; i <= rings; i++) for (j = 0; j <= n; j++) {
         r = inner + (outer - inner)*i/rings; a = j*pi/(2*n)
         printf "%d, %.12g, %.12g\n", base + i*(n + 1) + j + 1, j == n ? 0 : r*cos(a), j == 0 ? 0 : r*sin(a) }
      printf "*ELEMENT, TYPE=CPE4, ELSET=RING%d\n", body
      for (i = 0; i < rings; i++) for (j = 0; j < n; j++) {
         k = base + i*(n + 1) + j + 1
         printf "%d, %d, %d, %d, %d\n", base + i*n + j + 1, k, k + n + 1, k + n + 2, k + 1 } }
   printf "*MATERIAL, NAME=M\n*ELASTIC\n1000, 0.3\n*SOLID SECTION, ELSET=RING1, MATERIAL=M\n1\n*SOLID SECTION, ELSET=RING2, MATERIAL=M\n1\n"
   # element n1 = (i, j), n2 = (i+1, j): S1 on the ray j, S2 outside, S3 on the ray j+1, S4 inside
   printf "*SURFACE, NAME=OUT\n"; for (j = 0; j < n; j++) printf "%d, S2\n", 1000 + (rings - 1)*n + j + 1
   printf "*SURFACE, NAME=IN\n"; for (j = 0; j < n; j++) printf "%d, S4\n", 2000 + j + 1
   printf "*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.25\n*CONTACT PAIR, INTERACTION=I, QUADRATURE=NODAL\nOUT, IN\n*STEP\n*STATIC\n*BOUNDARY\n"
   for (body = 1; body <= 2; body++) for (i = 0; i <= rings; i++) {
      printf "%d, 2\n%d, 1\n", 1000*body + i*(n + 1) + 1, 1000*body + i*(n + 1) + n + 1 }
   printf "*NODE PRINT\nU\n*END STEP\n" }' </dev/null >shrink.inp
run 0 shrink.inp shrink --digits 17
law_holds shrink shrink 0.25
# Lame, plane strain, both of E: p (a (1+b^2)/(1-b^2) + ...) = overlap E'/R; the mesh of 3 rings and 5 degrees is 2 % off
pressure=$(value '2e-4*1000/(1 - 0.09)/((1.4^2 + 1)/(1.4^2 - 1) + (1 + 0.7^2)/(1 - 0.7^2))')
all_near 'shrink fit, Lame' shrink/contact.tab pressure "$pressure" "$(value "0.03*$pressure")"
column shrink/contact.tab pressure >p.txt
below 'shrink fit, symmetry' "$(awk '{ p[NR] = $1 } END { for (i = 1; i <= NR; i++) { d = p[i]/p[NR + 1 - i] - 1; if (d < 0) d = -d; if (d > w) w = d }
   printf "%.3e", w }' p.txt)" 1e-8

# A slave that is prescribed as a whole, with twice as many nodes as its elastic master.
{
   turn=0
   rectangle B1 3 2 0 0 1.2 0.5
   rectangle B2 6 1 0 0.5 1.2 0.8
   material B1 B2
   printf '*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3\n*CONTACT PAIR, INTERACTION=I, QUADRATURE=NODAL\nB2-BOTTOM, B1-TOP\n'
   printf '*STEP\n*STATIC\n*BOUNDARY\nB1-BOTTOM, 1, 2\nB2, 1\nB2, 2, 2, -0.003\n*NODE PRINT\nU, RF\n*END STEP\n'
} >finer.inp
run 0 finer.inp finer --digits 17
says finer finer.err 'N-SHARED'
law_holds finer finer 0.3
near 'finer slave, reaction' "$(resultant finer 1 normal_resultant)" \
   "$(awk '!/^#/ && $2 <= 4 { sum += $4 } END { printf "%.17g", sum }' finer/reactions.tab)" 1e-9

# At rest. Uniform stress -4 along x, plane strain: e11 = -4 (1 - 0.04)/2500, e22 = 4*0.2*1.2/2500.
{
   turn=0
   rectangle B 5 3 0 0 1.5 0.6
   material B
   printf '*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -1, 0\nLINE, 3, 0\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR\n'
   printf '*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.8\n*CONTACT PAIR, INTERACTION=I\nB-BOTTOM, FLOOR\n'
   printf '*STEP\n*STATIC\n*DSLOAD\nB-LEFT, P, 4\nB-RIGHT, P, 4\n*NODE PRINT\nU\n*EL PRINT\nS\n*END STEP\n'
} >squeeze.inp
run 0 squeeze.inp squeeze --digits 17
all_near 'squeezed, p' squeeze/contact.tab pressure 0 0
all_near 'squeezed, s11' squeeze/stress.tab s11 -4 1e-12
all_near 'squeezed, s22' squeeze/stress.tab s22 0 1e-12

for nu in 0.45 0; do
   {
      turn=0
      rectangle A 4 2 0 0 2 0.7
      rectangle B 4 2 0 0.7004 2 1.3
      rectangle C 4 2 0 1.3 2 1.9
      material A B C
      printf '*SURFACE INTERACTION, NAME=I\n*FRICTION\n%s\n*CONTACT PAIR, INTERACTION=I\nB-BOTTOM, A-TOP\nC-BOTTOM, B-TOP\n' $nu
      printf '*STEP\n*STATIC\n*BOUNDARY\nA-BOTTOM, 1, 2\nC-TOP, 1, 2\n*DLOAD\nC, BX, 0.21\nC, BY, 0.09\n*NODE PRINT\nU, RF\n*END STEP\n'
   } >"loose-$nu.inp"
   run 0 "loose-$nu.inp" "loose-$nu" --digits 17
   all_near "loose block, nu $nu, p" "loose-$nu/contact.tab" pressure 0 0
   all_near "loose block, nu $nu, shear" "loose-$nu/contact.tab" shear 0 0
done

# Two blocks on one base, one pressed 3e9 times as much as the other; both are pushed.
{
   turn=0
   rectangle BASE 12 2 0 0 6 1
   rectangle STRONG 4 2 0.5 1 2.5 1.8
   rectangle WEAK 4 2 3.5 1 5.5 1.8
   material BASE STRONG WEAK
   printf '*SURFACE INTERACTION, NAME=I\n*FRICTION, NONLOCAL\n0.5, 0, 0\n*CONTACT PAIR, INTERACTION=I\nSTRONG-BOTTOM, BASE-TOP\nWEAK-BOTTOM, BASE-TOP\n'
   printf '*STEP\n*STATIC\n*BOUNDARY\nBASE-BOTTOM, 1, 2\n*DSLOAD\nSTRONG-TOP, P, 6\nSTRONG-LEFT, P, 2\n'
   printf 'WEAK-TOP, P, 2e-9\nWEAK-LEFT, P, 2.45e-9\n*NODE PRINT\nU\n*END STEP\n'
} >weak.inp
run 0 weak.inp weak --digits 17
law_holds 'weak pair' weak 0.5
# some of its points slip, so the law above is one of full friction
near 'weak pair, slipping' "$(resultant weak 2 slip_points)" 5 4
near 'weak pair, push' "$(resultant weak 2 shear_resultant)" "$(value '-0.7*0.8*2.45e-9')" 1e-18

# A stack of 130 blocks under their own weight: p = 0.3 per block above, every pair has two points.
awk 'BEGIN {
   n = 130
   for (i = 1; i <= n; i++) printf "*BLOCK, TYPE=CPE4, ELSET=B%d, NX=1, NY=1\n0, %d\n2, %d\n2, %d\n0, %d\n", i, i - 1, i - 1, i, i
   printf "*MATERIAL, NAME=M\n*ELASTIC\n1e6, 0.\n"
   for (i = 1; i <= n; i++) printf "*SOLID SECTION, ELSET=B%d, MATERIAL=M\n1\n", i
   printf "*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.5\n*CONTACT PAIR, INTERACTION=I\n"
   for (i = 2; i <= n; i++) printf "B%d-BOTTOM, B%d-TOP\n", i, i - 1
   printf "*STEP\n*STATIC\n*BOUNDARY\nB1-BOTTOM, 1, 2\n*DLOAD\n"
   for (i = 1; i <= n; i++) printf "B%d, BY, -0.3\n", i
   printf "*NODE PRINT\nU\n*END STEP\n" }' </dev/null >stack.inp
run 0 stack.inp stack --digits 17
below 'stack, statics' "$(awk '!/^#/ { d = $8/(0.3*(130 - $2)) - 1; if (d < 0) d = -d; if (d > w) w = d } END { printf "%.3e", (NR > 129) ? w : 1 }' \
   stack/contact.tab)" 1e-10
below 'stack, memory in MiB' "$(awk '/^# peak memory/ { print $NF/2^20 }' stack/timing.tab)" 60

# One body, dragged along a rigid line: ANDERSON comes to no end.
run 0 "$here/stalls.inp" stalls --digits 17
law_holds 'where ANDERSON stalls' stalls 0.15
sed 's/^\*STATIC/*STATIC\n*CONTROLS, METHOD=PICARD/' "$here/stalls.inp" >picard.inp
run 0 picard.inp picard --digits 17 --quiet
same_column 'as by PICARD' stalls picard pressure
finish
