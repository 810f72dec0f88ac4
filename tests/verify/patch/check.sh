. "$(dirname "$0")/../lib.sh"
p=3
# state_of CPE4|CPS4 E mu: ey and ex, the strains per unit of pressure of a column with free sides.
strains() {
   if [ "$1" = CPE4 ]; then
      ey="(-(1 - $3*$3)/$2)"
      ex="($3*(1 + $3)/$2)"
   else
      ey="(-1/$2)"
      ex="($3/$2)"
   fi
}
# law NAME: writes law.inp, and sets delta.
law() {
   case $1 in
   hard) delta=0; printf '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n' ;;
   linear) delta=1e-4; printf '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e4\n' ;;
   penalty) delta=1e-6; printf '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY\n1e-6\n' ;;
   stick) delta=1e-6; printf '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY\n1e-6\n*FRICTION\n0.3\n' ;;
   paper) delta=1e-6; printf '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY\n1e-6\n*FRICTION, NONLOCAL\n0.3, 1e-4, 2\n' ;;
   esac >law.inp
}
# contact_and_stress FOLDER: what all scenes share: uniform pressure, penetration p*delta, s22 = -p and nothing else in the plane.
contact_and_stress() {
   all_near "$1 pressure" "$1/contact.tab" pressure $p 3e-12
   all_near "$1 weighted pressure" "$1/contact.tab" weighted_pressure $p 3e-12
   all_near "$1 shear" "$1/contact.tab" shear 0 3e-12
   all_near "$1 gap" "$1/contact.tab" gap "$(value "-$p*$delta")" "$(value "1e-12*$size")"
   all_near "$1 s22" "$1/stress.tab" s22 -$p 3e-12
   all_near "$1 s11" "$1/stress.tab" s11 0 3e-12
   all_near "$1 s12" "$1/stress.tab" s12 0 3e-12
   below "$1 equilibrium" "$(summary "$1" equilibrium_residual)" 1e-10
   near "$1 resultant" "$(summary "$1" normal_resultant)" "$(value "$p*3*0.7")" 6e-12
   near "$1 from the start" "$(summary "$1" resultant_from_start)" 1.5 1.5e-12
}
# two_bodies STATE LAW SLAVE [options]: E2 and mu2 are set by the caller.
two_bodies() {
   name=$1-$2-$3
   sed "s/STATE/$1/" "$here/bodies.inp" >deck.inp
   law "$2"
   if [ "$3" = upper ]; then pair='UP-BOTTOM, LOW-TOP'; else pair='LOW-TOP, UP-BOTTOM'; fi
   printf '*CONTACT PAIR, INTERACTION=JOINT\n%s\n' "$pair" >pair.inp
   run 0 deck.inp "$name" --digits 17 --quiet --set E2="$E2" --set mu2="$mu2"
   strains "$1" 1000 0.3
   ex1=$ex
   ey1=$ey
   strains "$1" "$E2" "$mu2"
   size=$(value "$p*($delta - $ey - 1.2*$ey1)")
   contact_and_stress "$name"
   tol=$(value "1e-12*$size")
   field_near "$name u1" "$name/nodes.tab" u1 "(node < 100) ? $p*$ex*x : $p*$ex1*x" "$tol"
   field_near "$name u2" "$name/nodes.tab" u2 "(node < 100) ? $p*$ey*y : $p*($ey - $delta + $ey1*(y - 1))" "$tol"
}
E2=70
mu2=0.1
for state in CPE4 CPS4; do
   for behaviour in hard linear penalty; do
      for slave in upper lower; do two_bodies $state $behaviour $slave; done
   done
done
# with friction the sides must widen alike: the same mu/E (plane stress), mu(1 + mu)/E (plane strain)
E2=500
mu2=0.15
for slave in upper lower; do
   two_bodies CPS4 stick $slave
   two_bodies CPS4 paper $slave
done
E2=$(value '1000*0.15*1.15/0.3/1.3')
for slave in upper lower; do
   two_bodies CPE4 stick $slave
   two_bodies CPE4 paper $slave
done

for state in CPE4 CPS4; do
   for behaviour in hard linear penalty; do
      name=rigid-$state-$behaviour
      sed "s/STATE/$state/" "$here/rigid.inp" >deck.inp
      law $behaviour
      run 0 deck.inp "$name" --digits 17 --quiet
      strains $state 1000 0.3
      size=$(value "$p*($delta - 1.2*$ey)")
      contact_and_stress "$name"
      field_near "$name u1" "$name/nodes.tab" u1 "$p*$ex*x" "$(value "1e-12*$size")"
      field_near "$name u2" "$name/nodes.tab" u2 "$p*($ey*(y - 1) - $delta)" "$(value "1e-12*$size")"
   done
done

# sides that do not match: the resultant and equilibrium only
for slave in 'UP-BOTTOM, LOW-TOP' 'LOW-TOP, UP-BOTTOM'; do
   printf '*CONTACT PAIR, INTERACTION=JOINT, QUADRATURE=NODAL\n%s\n' "$slave" >pair.inp
   name=not-matching-${slave%%-*}
   run 0 "$here/not-matching.inp" unused-"$name" --quiet # the deck beside its own pair.inp below
done
finish
