. "$(dirname "$0")/../lib.sh"
deck=$input/ex3-pillar-in-ground.inp
# sweep_of NAME VALUES LEVEL SETTING: a sweep into the folder NAME-LEVEL.
sweep_of() {
   rm -rf "$1-$3"
   "$atrito" sweep "$deck" --vary "$1=$2" --refine "$3" --set "$4" -o "$1-$3" --quiet 2>/dev/null || complain "sweep $1 at level $3"
}
# falls WHAT FOLDER QUANTITY KIND: a quantity over the runs; KIND strictly or weakly.
falls() {
   awk -v q="$3" '!/^#/ && $4 == q { print $1, $5 }' "$2/sweep.tab" >quantity
   awk -v what="$1" -v kind="$4" '{ n++; x = $2
         if (n > 1 && (kind == "strictly" ? !(x < last) : !(x <= last*(1 + 1e-9)))) bad = 1
         last = x; text = text " " $2 }
      END { print what ":" text; exit bad || n < 2 }' quantity || complain "$1 does not fall"
}
# Figures 17 and 18: below the spacing of the nodes, 2/3, rho changes nothing; beyond it both stresses fall.
sweep_of rho 0.1,0.8,1,1.5,2,4 0 eps=1e-4
falls "figure 17, largest shear over rho" rho-0 max_abs_shear weakly
falls "figure 18, largest pressure over rho" rho-0 max_pressure weakly
sweep_of rho 0.8,1,1.5,2,4 2 eps=1e-4
falls "figure 17 on a finer mesh" rho-2 max_abs_shear strictly
# Figures 19 and 20: the largest shear falls as eps grows, and fewer points reach the bound. (On finer meshes the largest shear
# is the one at the corner, where the pressure has no bound.)
for level in 0 2; do
   sweep_of eps 1e-5,1e-4,5e-4,1e-3,5e-3,1e-2 $level rho=0.1
   falls "figures 19 and 20 at level $level, slipping points over eps" eps-$level slip_points weakly
done
falls "figure 19, largest shear over eps" eps-0 max_abs_shear strictly
# The resultant converges: the steps from level to level shrink.
for level in 0 1 2 3 4; do
   run 0 "$deck" "level-$level" --refine $level --quiet
   echo "level $level: resultant $(summary level-$level normal_resultant)"
   summary "level-$level" normal_resultant >>resultants
done
awk '{ r[NR] = $1 } END { bad = NR != 5
   for (i = 2; i <= NR; i++) { d[i] = r[i - 1] - r[i]; if (!(d[i] > 0)) bad = 1; if (i > 2 && !(d[i] < 0.7*d[i - 1])) bad = 1 }
   printf "steps:"; for (i = 2; i <= NR; i++) printf " %.4g", d[i]; print ""
   exit bad }' resultants || complain "the resultant does not converge"
rm resultants
finish
