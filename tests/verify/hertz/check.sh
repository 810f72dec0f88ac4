. "$(dirname "$0")/../lib.sh"
mesh=$here/../mesh.awk

# judge NAME LIMIT_P LIMIT_A LIMIT_PROFILE: half of the contact is modelled.
judge() {
   set -- "$@" $(awk '!/^#/ { w = $13; q += 2*w*$8; m += 2*w*$8*$5*$5; if ($8 > 0) { n++; x[n] = $5; p[n] = $8 }
         if ($5*$5 < 1e-20) middle = $8 }
      END { pi = atan2(0, -1); a = sqrt(4*q*10/(pi*1000/0.91)); p0 = 2*q/(pi*a)
         for (i = 1; i <= n; i++) if (x[i] < 0.8*a) { d = p[i] - p0*sqrt(1 - (x[i]/a)^2); if (d < 0) d = -d; if (d > most) most = d }
         printf "%.17g %.17g %.17g %d", middle/p0 - 1, 2*sqrt(m/q)/a - 1, most/p0, n }' "$1/contact.tab")
   near "$1: p(0)/p0 - 1" "$5" 0 "$2"
   near "$1: a" "$6" 0 "$3"
   near "$1: profile" "$7" 0 "$4"
   echo "| $1 | $8 | $5 | $6 | $7 |" >>hertz.txt
}
: >hertz.txt

# scene TYPE SLAVE MASTER: the second half of the decks.
scene() {
   echo "*MATERIAL, NAME=A
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=ALL, MATERIAL=A
*RIGID BODY, ANALYTICAL SURFACE=RIGID
*SURFACE INTERACTION, NAME=JOINT
*CONTACT PAIR, INTERACTION=JOINT
$1, RIGID"
}
for type in CPE4 CPE9 CPE6; do
   for n in 16 32; do
      { printf '*HEADING\nCylinder on a floor\n'
        awk -v type=$type -v n=$n -v m=$n -v map=ring -v r1=2 -v r2=10 -v start=-90 -v turn=90 -v gx=-4 -v gy=4 -v dy=10 -f "$mesh"
        printf '*SURFACE, NAME=RIGID, TYPE=SEGMENTS\nSTART, -1, 0\nLINE, 11, 0\n'
        scene ALL-RIGHT
        printf '*BOUNDARY\nALL-BOTTOM, 1\nALL-LEFT, 1\n*STEP\n*STATIC\n*BOUNDARY\nALL-LEFT, 2, 2, -0.005\n*END STEP\n'; } >cylinder.inp
      run 0 cylinder.inp cylinder-$type-$n --digits 17 --quiet
      { printf '*HEADING\nRigid cylinder on a block\n'
        awk -v type=$type -v n=$n -v m=$n -v map=square -v size=20 -v gx=4 -v gy=-4 -v dy=-20 -f "$mesh"
        printf '*SURFACE, NAME=RIGID, TYPE=SEGMENTS\nSTART, 5, 1.3397459621556135\nCIRCL, 0, 0, 0, 10\n'
        scene ALL-TOP
        printf '*BOUNDARY\nALL-LEFT, 1\n*STEP\n*STATIC\n*BOUNDARY\nALL-BOTTOM, 2, 2, 0.01\n*END STEP\n'; } >disc.inp
      run 0 disc.inp disc-$type-$n --digits 17 --quiet
   done
done
for scene in cylinder disc; do
   judge $scene-CPE4-16 0.03 0.06 0.1
   judge $scene-CPE4-32 0.03 0.06 0.05
   judge $scene-CPE9-16 0.01 0.02 0.05
   judge $scene-CPE9-32 0.01 0.02 0.025
   judge $scene-CPE6-16 0.01 0.02 0.05
   judge $scene-CPE6-32 0.01 0.02 0.025
done
echo
echo '| scene | closed points | p(0)/p0 - 1 | half width over a, less 1 | largest error of p up to 0.8 a, over p0 |
|---|---|---|---|---|'
awk -F'|' '{ printf "|%s|%s| %.2e | %.2e | %.2e |\n", $2, $3, $4, $5, $6 }' hertz.txt
finish
