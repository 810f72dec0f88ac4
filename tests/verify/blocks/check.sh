# check.sh ATRITO CASE_FOLDER INPUT_FOLDER ERROR_NORMS
. "$(dirname "$0")/../lib.sh"
errors=$4
. "$here/../convergence/rates.sh"
. "$here/fit.sh"
rm -f rates.txt

# A ring and a plate with a hole: full orders, the arcs being arcs at every level.
for type in 4 8 9; do
   case $type in 4) l2=2 energy=1 ;; *) l2=3 energy=2 ;; esac
   for case in ring hole; do
      sed "s/\(TYPE=CP[ES]\)4/\1$type/" "$here/$case.inp" >$case-$type.inp
      for level in 1 2 3; do
         case $case in
            ring) row rates.txt $case-$type $level $case-$type.inp ring 1 2 10 0 ;;
            hole) row rates.txt $case-$type $level $case-$type.inp hole 1 10 ;;
         esac
      done
      orders rates.txt $case-$type $l2 $energy 0.15
   done
done
markdown rates.txt

# Kirsch: the largest stress, at the integration point that is nearest to the hole, over what it should be there: 3 S at the hole.
run 0 hole-8.inp hole --refine 3 --digits 17 --quiet
near 'stress concentration at the hole' "$(awk '!/^#/ && $6 > s { s = $6; y = $5 } END { printf "%.17g", s/(5*(2 + 1/y^2 + 3/y^4))*3 }' hole/stress.tab)" 3 0.005
near 'largest stress' "$(awk '!/^#/ && $6 > s { s = $6 } END { printf "%.17g", s }' hole/stress.tab)" 30 1

# Two forces of 100 on a disc of radius 10: s11 = F/(pi R) and s22 = -3 F/(pi R) at the centre, here in the mean of the four points
# round it, which differs by their distance squared (6.4e-3, 1.7e-3, 4.3e-4 measured at levels 2, 3, 4).
run 0 "$here/disc.inp" disc --refine 3 --digits 17 --quiet
near 'the force stands at the top' "$(awk '$2 == 187 { print $4 }' disc/nodes.tab)" 10 1e-13
for s in '6 1' '7 -3' '9 0'; do
   near "disc, s$s at the centre" "$(awk -v k="${s% *}" '!/^#/ && $4*$4 + $5*$5 < 0.004 { n++; t += $k } END { printf "%.17g", (n > 0) ? t/n : "none" }' \
      disc/stress.tab)" "$(value "${s#* }*100/(10*atan2(0, -1))")" 3e-3
done
near 'points at the centre' "$(awk '!/^#/ && $4*$4 + $5*$5 < 0.004' disc/stress.tab | wc -l)" 4 0
# every node of the outline on the circle, at all levels
near 'largest radius' "$(awk '!/^#/ { r = sqrt($3*$3 + $4*$4); if (r > m) m = r } END { printf "%.17g", m }' disc/nodes.tab)" 10 1e-13
near 'nodes of the outline' "$(awk '!/^#/ { r = sqrt($3*$3 + $4*$4); if (r > 10*(1 - 1e-14)) n++ } END { print n }' disc/nodes.tab)" 256 0

# Hertz: the lesson's deck, either side the slave.
lesson=$input/lessons/disc-on-plate.inp
sed 's/^CAP-BOTTOM, PLATE-TOP/PLATE-TOP, CAP-BOTTOM/' "$lesson" >other.inp
for level in 0 1 2; do
   run 0 "$lesson" hertz-$level --refine $level --digits 17 --quiet
   run 0 other.inp other-$level --refine $level --digits 17 --quiet
   case $level in 0) within=1e-2 ;; *) within=1e-3 ;; esac
   for role in hertz other; do
      near "$role, level $level: p(0)/p0 - 1" "$(awk '!/^#/ && $5*$5 < 1e-20 { print $8/8.2417582417582418 - 1 }' $role-$level/contact.tab)" 0 $within
   done
done

# Press fit: Lame, d = p (c/E') ((b^2 + c^2)/(b^2 - c^2) + (c^2 + a^2)/(c^2 - a^2)) with E' = E/(1 - mu^2). The force is that over
# the quarter's weights; 0.5 % between the roles, 1e-4 of the closed form with the second degree.
p=$(value '0.01*1000/0.91/2/(13/5 + 5/3)')
force() {
   awk '!/^#/ { f += $8*$13; w += $13 } END { printf "%.17g", f/w }' "$1/contact.tab"
}
for case in '4 16 16 5e-3' '4 12 17 5e-3' '8 6 9 1e-4' '9 6 9 1e-4' '9 8 8 1e-4'; do
   set -- $case
   for role in in out; do
      fit $role CPE$1 $2 $3 >fit.inp
      run 0 fit.inp fit-$role --digits 17 --quiet
      near "press fit, CPE$1 $2 and $3, slave $role" "$(value "$(force fit-$role)/$p")" 1 "$(value "2*$4")"
   done
   near "press fit, CPE$1 $2 and $3: the roles" "$(value "$(force fit-in)/$(force fit-out)")" 1 "$4"
done
# the same gap node by node
sed 's/VALUE=-0.01/TABULAR\nOUT-LEFT, -0.01/' fit.inp >table.inp
run 0 table.inp table --digits 17 --quiet
same_tables 'clearance by nodes' table/contact.tab fit-out/contact.tab 1e-13

# ADJUST: a ring that is 0.003 away is moved onto the other one; then the pressure is that of rings that touch.
for quadrature in NODAL MORTAR; do
   fit out CPE9 8 8 ", ADJUST=0.01, QUADRATURE=$quadrature" |
      sed -e '/^\*CLEARANCE/d' -e 's/^\*CONTACT PRINT/*DSLOAD\nIN-LEFT, P, 10\n&/' >touch.inp
   sed -e '/ELSET=OUT/,/^ARC/ { s/^2, 0/2.003, 0/; s/^0, 2/0, 2.003/ }' touch.inp >away.inp
   run 0 touch.inp touch --digits 17 --quiet
   run 0 away.inp away --digits 17
   says "told, $quadrature" away.err '[N-ADJUST] ADJUST moves 17 nodes of the slave onto the master, at most by 0.003 at node'
   all_near "gap, $quadrature" away/contact.tab gap 0 1e-12
   near "force, $quadrature" "$(value "$(force away)/$(force touch)")" 1 1e-3
   sed 's/ADJUST=0.01/ADJUST=0.002/' away.inp >short.inp
   run 0 short.inp short --digits 17
   says "too far, $quadrature" short.err '[N-ADJUST] ADJUST moves no node: none of the slave is near enough'
done
finish
