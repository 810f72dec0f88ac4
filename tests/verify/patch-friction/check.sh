. "$(dirname "$0")/../lib.sh"
p=3
# strains STATE E mu: ex and ey per unit of pressure of a column with free sides.
strains() {
   if [ "$1" = CPE4 ]; then
      ey=$(value "-(1 - $3*$3)/$2")
      ex=$(value "$3*(1 + $3)/$2")
   else
      ey=$(value "-1/$2")
      ex=$(value "$3/$2")
   fi
}
# law NAME: writes law.inp and sets delta [L^3/F].
law() {
   delta=1e-6
   printf '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY\n<delta>\n' >law.inp
   case $1 in
   hard) delta=0 ;;
   soft) delta=1e-3 ;;
   stick) printf '*FRICTION\n0.3\n' ;;
   slope) printf '*FRICTION\n0.3, 1e3\n' ;;
   paper) printf '*FRICTION, NONLOCAL\n0.3, 1e-4, 2\n' ;;
   exact) delta=0; printf '*FRICTION, NONLOCAL\n0.3, 0, 2\n' ;;
   esac >>law.inp
}
pair() { # upper or lower: the slave
   printf '*CONTACT PAIR, INTERACTION=JOINT, QUADRATURE=NODAL\n'
   if [ "$1" = upper ]; then echo 'UP-BOTTOM, LOW-TOP'; else echo 'LOW-TOP, UP-BOTTOM'; fi
}
# patch STATE LAW SLAVE E2 mu2: both bodies; the upper one has E = 1000, mu = 0.3.
patch() {
   name=$1-$2-$3
   sed "s/STATE/$1/" "$here/bodies.inp" >deck.inp
   law "$2"
   pair "$3" >pair.inp
   run 0 deck.inp "$name" --digits 17 --quiet --set delta=$delta --set E2="$4" --set mu2="$5"
   strains "$1" 1000 0.3
   ex1=$ex
   ey1=$ey
   strains "$1" "$4" "$5"
   size=$(value "$p*($delta - $ey - 1.2*$ey1)")
   tol=$(value "1e-12*$size")
   all_near "$name pressure" "$name/contact.tab" pressure $p 3e-12
   all_near "$name weighted pressure" "$name/contact.tab" weighted_pressure $p 3e-12
   all_near "$name shear" "$name/contact.tab" shear 0 3e-12
   all_near "$name gap" "$name/contact.tab" gap "$(value "-$p*$delta")" "$tol"
   for s in s11=0 s22=-$p s12=0; do all_near "$name $s" "$name/stress.tab" "${s%=*}" "${s#*=}" 3e-12; done
   field_near "$name u1" "$name/nodes.tab" u1 "(node < 100) ? $p*($ex)*x : $p*($ex1)*x" "$tol"
   field_near "$name u2" "$name/nodes.tab" u2 "(node < 100) ? $p*($ey)*y : $p*(($ey) - $delta + ($ey1)*(y - 1))" "$tol"
   resultant "$name"
}
# resultant FOLDER: its size, its place, and equilibrium.
resultant() {
   near "$1 resultant" "$(summary "$1" normal_resultant)" 6.3 6.3e-12
   near "$1 place of the resultant" "$(summary "$1" resultant_from_start)" 1.5 3e-12
   below "$1 equilibrium" "$(summary "$1" equilibrium_residual)" 1e-10
}
for slave in upper lower; do
   for state in CPE4 CPS4; do
      for none in hard soft; do patch $state $none $slave 70 0.1; done
   done
   for rough in stick slope paper exact; do
      patch CPS4 $rough $slave 500 0.15
      patch CPE4 $rough $slave "$(value '1000*0.15*1.15/0.3/1.3')" 0.15
   done
   cp "$here/not-matching.inp" .
   pair $slave >pair.inp
   run 0 not-matching.inp not-matching-$slave --digits 17 --quiet
   resultant not-matching-$slave
   echo "pressures: $(column not-matching-$slave/contact.tab pressure | tr '\n' ' ')"
done
finish
