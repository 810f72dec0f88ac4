. "$(dirname "$0")/../lib.sh"
ex1=$input/ex1-plate-on-support.inp

# between FOLDER NAME VALUE [SLACK]: the bounds of a quantity have a value between them, but for a slack
between() {
   least=$(summary "$1" "$2_least")
   most=$(summary "$1" "$2_most")
   near "$1: $2 between its bounds" "$(value "$3")" "$(value "(($least) + ($most))/2")" "$(value "(($most) - ($least))/2 + ${4:-0}")"
}

width() { value "$(summary "$1" "$2_most") - ($(summary "$1" "$2_least"))"; }

# A column under its weight: the exact displacements and stresses are known
for n in 4 8 16; do
   run 0 "$here/column.inp" "column-$n" --set n=$n --quiet --observe 'sink=mean(u2,BODY)' --observe 'top=mean(u2,BODY-TOP)' \
      --observe 'stress=mean(s22,BODY)' --observe 'foot=rf2(BODY-BOTTOM)' --observe 'all=2*mean(u2,BODY)-mean(s22,BODY)/50+1' \
      --bound sink,top,stress,foot,all
   between "column-$n" sink "-3*4/300" 1e-12
   between "column-$n" top "-3*4/200" 1e-12
   between "column-$n" stress -3 1e-10
   between "column-$n" foot 6 1e-10
   between "column-$n" all "2*(-3*4/300) + 3/50 + 1" 1e-10
done
near 'twice as fine, a quarter as wide' "$(value "$(width column-4 sink)/$(width column-8 sink)")" 4 1e-6
near 'the same again' "$(value "$(width column-8 sink)/$(width column-16 sink)")" 4 1e-6
below 'equilibrium alone' "$(width column-4 foot)" 1e-9
grep -q 'no states are held' column-4/column.lst || complain 'what is proved, without contact'

# A clamped block: a mesh 8 x as fine of second degree tells
tip="--observe tip=mean(u2,BODY-RIGHT) --observe body=mean(u1,BODY) --observe pull=rf2(BODY-LEFT) --observe stress=mean(s11,BODY)"
sed 's/CPE4/CPE9/' "$here/clamped.inp" >fine.inp
# shellcheck disable=SC2086
run 0 fine.inp fine --refine 4 --proof off --quiet $tip
for type in CPE3 CPE4 CPE6 CPE8 CPE9 CPE4R CPE8R; do
   sed "s/CPE4/$type/" "$here/clamped.inp" >clamped.inp
   # shellcheck disable=SC2086
   run 0 clamped.inp "clamped-$type" --quiet $tip --bound tip,body,pull --bound stress
   between "clamped-$type" tip "$(summary fine tip)"
   between "clamped-$type" body "$(summary fine body)"
   between "clamped-$type" pull 2 1e-9
   between "clamped-$type" stress 0 1e-9
done
# shellcheck disable=SC2086
run 0 "$here/clamped.inp" clamped-1 --refine 1 --quiet $tip --bound tip
# shellcheck disable=SC2086
run 0 "$here/clamped.inp" clamped-2 --refine 2 --quiet $tip --bound tip
between clamped-2 tip "$(summary fine tip)"
below 'the corners are singular: narrower by more than 2.5 each time' "$(value "$(width clamped-2 tip)/$(width clamped-1 tip)")" 0.4

# Contact that sticks everywhere, which holding the states does not change: bounds of the contact problem itself
push="--observe top=c*mean(u1,UPPER-TOP)+s*mean(u2,UPPER-TOP) --observe part=c*mean(u2,UPPER)-s*mean(u1,UPPER) --observe press=mean(pressure,1)"
push="$push --observe across=shear_resultant --observe force=normal_resultant"
sed 's/CPE4/CPE9/' "$here/blocks.inp" >fine.inp
# shellcheck disable=SC2086
run 0 fine.inp fine-blocks --refine 3 --proof off --quiet $push
near 'all sticks' "$(summary fine-blocks open_points)$(summary fine-blocks slip_points)" 00 0
for type in CPE3 CPE4 CPE6 CPE8 CPE9; do
   sed "s/CPE4/$type/" "$here/blocks.inp" >blocks.inp
   # shellcheck disable=SC2086
   run 0 blocks.inp "blocks-$type" --quiet $push --bound top,part,press,across,force
   near "$type: all sticks" "$(summary "blocks-$type" open_points)$(summary "blocks-$type" slip_points)" 00 0
   for name in top part; do between "blocks-$type" $name "$(summary fine-blocks $name)"; done
   for name in press across force; do between "blocks-$type" $name "$(summary fine-blocks $name)" 1e-7; done
done
grep -q 'contact states held' blocks-CPE9.out && complain 'quiet'
grep -q 'certified, contact states held' blocks-CPE9/blocks.lst || complain 'the words of the listing'
# turned, in other units: the same numbers
# shellcheck disable=SC2086
run 0 "$here/blocks.inp" plain --quiet --digits 15 $push --bound top,part
# shellcheck disable=SC2086
run 0 "$here/blocks.inp" turned --quiet --digits 15 --set turn=0.65 --set m=1000 --set kn=0.001 $push --bound top,part
for name in top_least top_most part_least part_most; do
   near "turned: $name" "$(value "$(summary turned $name)/1000")" "$(summary plain $name)" 1e-9
done

# Example 1: equilibrium alone determines the resultant of the pressures, all points slip, and each mesh has the sag of a finer one
sag="--observe sag=mean(u2,SPAN-RIGHT) --observe normal=normal_resultant"
for refine in 0 1 2; do
   # shellcheck disable=SC2086
   run 0 "$ex1" "ex1-$refine" --refine $refine $sag --bound sag,normal
   near "ex1-$refine: the plate's weight" "$(summary "ex1-$refine" normal_least)" 1.5 1e-8
   between "ex1-$refine" sag -0.01408
done
grep -q 'bounded .*sag -0.01.* to -0.01.* (certified, contact states held)' ex1-2.out || complain 'the words of the screen'

# The potential energy: without contact less the strain energy; with contact a mesh of second degree, finer, has the narrower interval
run 0 "$here/clamped.inp" potential --quiet --bound potential_energy
between potential potential_energy "-($(summary fine strain_energy))" 1e-6
sed 's/CPE4/CPE8/' "$ex1" >ex1-second.inp
run 0 ex1-second.inp energy-fine --set nu=0 --refine 2 --quiet --bound potential_energy
low=$(summary energy-fine potential_energy_least)
high=$(summary energy-fine potential_energy_most)
below 'a narrow interval' "$(value "(($high) - ($low))/-($low)")" 1e-3
for refine in 0 1 2; do
   run 0 "$ex1" "energy-$refine" --set nu=0 --refine $refine --quiet --bound potential_energy
   between "energy-$refine" potential_energy "$low"
   between "energy-$refine" potential_energy "$high"
done
run 0 "$ex1" energy-friction --quiet --bound potential_energy
grep -q 'for the friction bound of this run' energy-friction/*.lst || complain 'the words of the energy'

# A history: bounds at the ends of steps
sed 's/^\*END STEP/&\n*STEP\n*STATIC\n0.5, 1.\n*DSLOAD\nBODY-TOP, P, 1.\n*END STEP/' "$here/clamped.inp" >history.inp
# shellcheck disable=SC2086
run 0 history.inp history --quiet $tip --bound tip
[ "$(column history/history.tab tip_least | grep -c nan)" -eq 1 ] || complain 'an increment within a step has no bound'
[ "$(column history/history.tab tip_most | grep -c .)" -eq 3 ] || complain 'increments of the history'

# No bound, and why
sed 's/BODY-LEFT, 1, 2/BODY-LEFT, 1\n1, 2/' "$here/clamped.inp" >point.inp
# shellcheck disable=SC2086
run 0 point.inp point $tip --bound tip
grep -q 'bounded .*tip has no bound: the support at node 1 is a point' point.out || complain 'a support at a point'
[ "$(summary point tip_least)" = nan ] || complain 'no bound is nan'
sed 's/NX=5, NY=3/NX=4, NY=3/' "$here/blocks.inp" | sed '0,/NX=4/s//NX=5/' >unlike.inp
# shellcheck disable=SC2086
run 0 unlike.inp unlike $push --bound top
grep -q 'top has no bound: joined sides that do not match' unlike.out || complain 'sides that do not match'

# Mistakes of the command line: exit 1
mistake() {
   words=$1
   shift
   run 1 "$here/clamped.inp" mistake --quiet "$@"
   grep -qF -e "$words" mistake.err || { complain "$words"; cat mistake.err; }
}
mistake 'nearest:  tip' --observe 'tip=mean(u2,BODY)' --bound tipp
mistake 'nothing of this name is observed' --bound tip
mistake 'u2 at points has no bound' --observe 'tip=u2(1.0, 0.5)' --bound tip
mistake 's11 at points has no bound' --observe 'tip=mean(s11,BODY-TOP)' --bound tip
mistake 'it is not linear' --observe 'tip=mean(u2,BODY)**2' --bound tip
mistake 'it is not linear' --observe 'tip=abs(mean(u2,BODY))' --bound tip
mistake 'mean(mises, ...) has no bound' --observe 'tip=mean(mises,BODY)' --bound tip
mistake 'strain_energy has no bound' --observe 'tip=strain_energy' --bound tip
mistake 'another quantity that is observed' --observe 'tip=mean(u2,BODY)' --observe 'tip_most=time' --bound tip
mistake '--proof off excludes' --observe 'tip=mean(u2,BODY)' --bound tip --proof off
mistake '--bound tip,tip is not possible' --observe 'tip=mean(u2,BODY)' --bound tip,tip

finish
