. "$(dirname "$0")/../lib.sh"
ex1=$input/ex1-plate-on-support.inp

# bound NAME LEAST MOST: certified, and between the two
bound() {
   near "$1: certified" "$(summary "$1" error_certified)" 1 0
   below "$1: at most" "$(summary "$1" error_bound_percent)" "$3"
   below "$1: at least" "$2" "$(summary "$1" error_bound_percent)"
}

# a uniform stress is found exactly, whether the sides match or not
for type in CPE4 CPE6; do
   sed "s/CPE4/$type/" "$here/column.inp" >column.inp
   for nx in 3 5; do
      run 0 column.inp "column-$type-$nx" --proof on --set nx=$nx --quiet
      near "column-$type-$nx: certified" "$(summary "column-$type-$nx" error_certified)" 1 0
      below "column-$type-$nx" "$(summary "column-$type-$nx" error_bound_percent)" 1.01e-7
   done
done

# the columns under their weight, and no lateral strain: a stress of degree 1 is the exact one, so the bound is the error itself,
# b^2 h^3/12 E an element of the height h over the energy of the run; with three nodes along a side it vanishes
for nx in 3 5; do
   for type in CPE4 CPE8; do
      sed "s/CPE4/$type/; s/^100., 0.3/100., 0.\n*DENSITY\n1./; s/^\*DSLOAD/*DLOAD\nALL, GRAV, 1., 0., -1.\n&/" "$here/column.inp" >weight.inp
      run 0 weight.inp "weight-$type-$nx" --proof on --set nx=$nx --quiet
   done
   near "weight, $nx: the bound is the error" "$(summary "weight-CPE4-$nx" error_bound_percent)" \
      "$(value '100*sqrt(0.5/1200/(26/300 - 0.5/1200))')" 1e-6
   below "weight, $nx: second degree" "$(summary "weight-CPE8-$nx" error_bound_percent)" 1.01e-7
done

# elements of both degrees in one scene
sed 's/CPE4, ELSET=UPPER/CPE8, ELSET=UPPER/' "$here/column.inp" >column.inp
run 0 column.inp mixed --proof on --quiet
near 'mixed: certified' "$(summary mixed error_certified)" 1 0
below 'mixed' "$(summary mixed error_bound_percent)" 1.01e-7

# no contact: the true error is sqrt(1 - E_h/E) of the exact energy E, here that of a fine mesh (which is a little low)
sed 's/CPE4/CPE9/' "$here/clamped.inp" >clamped-fine.inp
run 0 clamped-fine.inp fine --refine 4 --proof off --quiet
for type in CPE3 CPE4 CPE6 CPE8 CPE9; do
   sed "s/CPE4/$type/" "$here/clamped.inp" >clamped.inp
   run 0 clamped.inp "clamped-$type" --proof on --quiet
   true_error=$(value "100*sqrt($(summary fine strain_energy)/$(summary "clamped-$type" strain_energy) - 1)")
   bound "clamped-$type" "$true_error" "$(value "1.35*$true_error")"
done

# beside a body whose stress is found exactly: its elements have nothing but round-off, of either sign
sed 's/^\*MATERIAL, NAME=M/*BLOCK, TYPE=CPE4, ELSET=BAR, NX=9, NY=7\n5., 0.\n7.7, 0.\n7.7, 1.3\n5., 1.3\n&/
   s/^\*SOLID SECTION, ELSET=BODY/*SOLID SECTION, ELSET=BAR, MATERIAL=M\n1.\n&/; s/^\*BOUNDARY/&\nBAR-LEFT, 1\nBAR-BOTTOM, 2/
   s/^\*DSLOAD/&\nBAR-RIGHT, P, 0.3\nBAR-TOP, P, 0.7/' "$here/clamped.inp" >bar.inp
run 0 bar.inp bar --proof on --quiet
near 'beside a bar: certified' "$(summary bar error_certified)" 1 0
near 'beside a bar' "$(value "$(summary bar error_bound_percent)*sqrt($(summary bar strain_energy))")" \
   "$(value "$(summary clamped-CPE4 error_bound_percent)*sqrt($(summary clamped-CPE4 strain_energy))")" 1e-6

# example 1, local friction: an independent program found 24.80, 14.81, 9.14
for refine in 0:24.80 1:14.81 2:9.14; do
   run 0 "$ex1" "ex1-${refine%:*}" --set rho=0 --refine "${refine%:*}" --proof on --quiet
   near "ex1, --refine ${refine%:*}" "$(summary "ex1-${refine%:*}" error_bound_percent)" "${refine#*:}" "$(value "0.02*${refine#*:}")"
done
says 'on the screen' "ex1-0/ex1-plate-on-support.lst" 'certified for the friction bound of this run'

# sides that do not match: delta is so small that the overlaps between points would cost 30 times the bound, or nearly nothing
sed 's/ELSET=SUPPORT, NX=6/ELSET=SUPPORT, NX=7/' "$ex1" >seven.inp
for delta in 1e-6 1e-9; do run 0 seven.inp "seven-$delta" --set rho=0 --set delta=$delta --proof on --quiet; done
bound seven-1e-6 24 25.5
sed 's/^\*CONTACT PAIR/&, QUADRATURE=NODAL/' seven.inp >nodal.inp     # with nodes of the support that no node of the plate faces
run 0 nodal.inp nodal --set rho=0 --proof on --quiet
bound nodal 24 25.5
near 'delta 1e-9' "$(summary seven-1e-9 error_bound_percent)" "$(summary seven-1e-6 error_bound_percent)" 0.49

# a block that contact alone holds; turned, in other units, with other numbers it is the same
for type in CPE4 CPE9; do
   for upper in 3 4; do
      i=0
      for way in angle=0 angle=37 length_unit=1000 force_unit=250 reverse=1; do
         i=$((i + 1))
         awk -v type=$type -v upper=$upper -v $way -f "$here/blocks.awk" </dev/null >blocks.inp
         run 0 blocks.inp "blocks-$i" --proof on --digits 15 --quiet
         near "$type, $upper, $way: certified" "$(summary "blocks-$i" error_certified)" 1 0
         near "$type, $upper, $way" "$(summary "blocks-$i" error_bound_percent)" "$(summary blocks-1 error_bound_percent)" \
            "$(value "1e-9*$(summary blocks-1 error_bound_percent)")"
      done
   done
done

# a gap that is linear along the joint turns the block, and that is all: the run has means of it, the bound what the nodes are given
for upper in 3 5; do
   for gap in 0 0.01; do
      awk -v type=CPE4 -v upper=$upper -v clearance=$gap -v rule=', QUADRATURE=MORTAR' -f "$here/blocks.awk" </dev/null >gap.inp
      run 0 gap.inp "gap-$upper-$gap" --proof on --digits 15 --quiet
   done
   near "a linear gap, $upper" "$(summary "gap-$upper-0.01" error_bound_percent)" "$(summary "gap-$upper-0" error_bound_percent)" \
      "$(value "1e-6*$(summary "gap-$upper-0" error_bound_percent)")"
done

# no_bound NAME REASON: nothing in the tables, the reason on the screen
no_bound() {
   grep -q error_bound "$1/summary.tab" && complain "$1: a bound"
   says "$1" "$1.out" "no bound: $2"
}
run 0 "$input/ex2-two-plates.inp" point-support --proof on
no_bound point-support 'the support at node 1 is a point'
sed 's/^\*DSLOAD/*CLOAD\n40, 2, -0.1\n*DSLOAD/' "$ex1" >force.inp
run 0 force.inp force --proof on
no_bound force 'node 40 carries a force at a point'
sed 's/CPE4/CPE8/; s/^2., 1.$/&/; s/^0., 1.$/&\nARC, TOP, 1., -2./' "$here/clamped.inp" >arc.inp
run 0 arc.inp arc --proof on
no_bound arc 'curved sides'
says 'an estimate' arc.out 'estimated    '
sed 's/CPE8/CPE4/' arc.inp >polygon.inp
run 0 polygon.inp polygon --proof on
says 'of the polygon' polygon.out '% (certified, of the polygon), estimated'
says 'of the polygon, in the listing' polygon/polygon.lst 'of the polygon of the mesh: sides of a *BLOCK are arcs'
grep -q polygon clamped-CPE4/clamped.lst && complain 'a polygon where no side is an arc'
sed 's/CPE4/CAX4/; s/1, 2$/2/' "$here/clamped.inp" >ring.inp
run 0 ring.inp ring --proof on
no_bound ring 'rings'
run 0 "$ex1" huge --set q=1e150 --set eps=4e146 --proof on
no_bound huge 'displacements above 1e100'
run 0 "$input/lessons/leaning-block.inp" leaning --proof on
no_bound leaning 'no strain'

# ties whose sides match: the block in two halves is the whole one; the columns are one under a uniform stress
sed '/^\*CONTACT PAIR/{s/.*/*TIE, NAME=T/}; /^\*SURFACE INTERACTION/,/^0.5, 1e-3/d; /^UPPER-LEFT/d' "$here/column.inp" >tied.inp
for nx in 3 5; do run 0 tied.inp "tied-$nx" --proof on --set nx=$nx; done
near 'tied columns: certified' "$(summary tied-3 error_certified)" 1 0
below 'tied columns' "$(summary tied-3 error_bound_percent)" 1.01e-7
no_bound tied-5 'a tie whose sides do not match'
for type in CPE3 CPE4 CPE8; do
   sed "s/CPE4, ELSET=BODY, NX=4/$type, ELSET=BODY, NX=2/; s/^2., /1., /
      s/^\*MATERIAL, NAME=M/*BLOCK, TYPE=$type, ELSET=REST, NX=2, NY=2\n1., 0.\n2., 0.\n2., 1.\n1., 1.\n&/
      s/^\*SOLID SECTION, ELSET=BODY/*SOLID SECTION, ELSET=REST, MATERIAL=M\n1.\n&/
      s/^\*BOUNDARY/*TIE, NAME=T\nREST-LEFT, BODY-RIGHT\n&/; s/^BODY-RIGHT, T/REST-RIGHT, T/; s/^BODY-TOP.*/&\nREST-TOP, P, 0.5/" "$here/clamped.inp" >halves.inp
   run 0 halves.inp "halves-$type" --proof on --quiet
   near "halves, $type: certified" "$(summary "halves-$type" error_certified)" 1 0
   near "halves, $type" "$(summary "halves-$type" error_bound_percent)" "$(summary "clamped-$type" error_bound_percent)" \
      "$(value "1e-2*$(summary "clamped-$type" error_bound_percent)")"
done
# on a support without friction, where each half alone could turn: the bound of the whole plate
sed 's/, MERGE=OVER//; s/^\*BOUNDARY/*TIE, NAME=T\nSPAN-LEFT, OVER-RIGHT\n&/' "$ex1" >plate.inp
run 0 plate.inp plate --set rho=0 --proof on --quiet
near 'a plate in two: certified' "$(summary plate error_certified)" 1 0
near 'a plate in two' "$(summary plate error_bound_percent)" "$(summary ex1-0 error_bound_percent)" 0.25
sed 's/^\*BOUNDARY/*EQUATION\n2\n1, 1, 1., 2, 1, -1.\n&/' "$here/clamped.inp" >equation.inp
run 0 equation.inp equation --proof on
no_bound equation 'joints other than ties'
# without being asked for, where it takes less than the rest of the run: by counts, the same on any machine
sed 's/CPE4/CPE8/' "$input/lessons/arch.inp" >arch.inp
run 0 arch.inp arch
no_bound arch 'it takes longer than the run: --proof on'
for type in CPE4 CPE8; do
   sed "s/CPE4/$type/; s/NX=4, NY=2/NX=80, NY=40/" "$here/clamped.inp" >equal.inp
   sed 's/^2., 1.$/2.2, 1.1/' equal.inp >unequal.inp
   run 0 equal.inp "equal-$type"
   near "equal-$type: certified" "$(summary "equal-$type" error_certified)" 1 0
   run 0 unequal.inp "unequal-$type"
   no_bound "unequal-$type" 'it takes longer than the run: --proof on'
done
# two pairs on one side, one of them open: its pieces lie over those of the other, and cut the triangles of w once more
awk -v upper=3 -f "$here/blocks.awk" </dev/null >far.inp
sed 's/^UPPER-BOTTOM, LOWER-TOP/&\nFAR-BOTTOM, LOWER-TOP/; s/^\*SOLID SECTION, ELSET=LOWER/*SOLID SECTION, ELSET=FAR, MATERIAL=SOFT\n1.\n&/
   s/^\*MATERIAL, NAME=SOFT/*BLOCK, TYPE=CPE4, ELSET=FAR, NX=5, NY=1\n0.3, 4.\n1.7, 4.\n1.7, 5.\n0.3, 5.\n*BOUNDARY\nFAR-TOP, 1, 2\n&/' far.inp >both.inp
run 0 far.inp one --proof on --quiet
run 0 both.inp both --proof on --quiet
near 'an open pair besides' "$(summary both error_bound_percent)" "$(summary one error_bound_percent)" 0.05

# a block over the end of the one below: as at the end, where it reaches beyond by what the search for the master lets pass, or by a
# little more, where nodes still face nodes but one is beyond
for reach in 2 2.0000004 2.0000009; do run 0 "$here/over.inp" "over-$reach" --set reach=$reach --proof on; done
no_bound over-2.0000004 'contact beyond the end of a master side'
near 'over the end' "$(summary over-2.0000004 strain_energy)" "$(summary over-2 strain_energy)" 1e-6
near 'a little farther' "$(summary over-2.0000009 strain_energy)" "$(summary over-2 strain_energy)" 1e-6
finish
