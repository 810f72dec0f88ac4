. "$(dirname "$0")/../lib.sh"
# one FOLDER DECK STATE DELTA UPPER: UPPER alone on a rigid line (1) or both blocks (0)
one() {
   run 0 "$2" "$1" --digits 17 --quiet
   near "$1 equilibrium" "$(summary "$1" equilibrium_residual)" 0 1e-10
   all_near "$1 pressure" "$1/contact.tab" pressure 100 1e-10
   all_near "$1 gap" "$1/contact.tab" gap "$(awk -v d="$4" 'BEGIN { printf "%.17g", -100*d }')" 1e-15
   all_near "$1 s22" "$1/stress.tab" s22 -100 1e-10
   all_near "$1 s11" "$1/stress.tab" s11 0 1e-10
   all_near "$1 s12" "$1/stress.tab" s12 0 1e-10
   near "$1 displacements" "$(awk -v state="$3" -v delta="$4" -v rigid="$5" '
      function lateral(e, mu) { return state == "CPE4" ? mu*(1 + mu)/e : mu/e }
      function along(e, mu) { return state == "CPE4" ? (1 - mu*mu)/e : 1/e }
      BEGIN { p = 100; if (!rigid) low = along(70000, 0.2) }
      /^#/ { next }
      { n++
        for (i = 3; i <= 6; i++) if ($i !~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/) bad = 1
        if ($2 < 10) { u = p*lateral(70000, 0.2)*$3; v = -p*along(70000, 0.2)*$4 }
        else { u = p*lateral(210000, 0.3)*$3; v = -p*(low + delta + along(210000, 0.3)*($4 - 1)) }
        d = $5 - u; if (d < 0) d = -d; if (d > worst) worst = d
        d = $6 - v; if (d < 0) d = -d; if (d > worst) worst = d
        if (-v > size) size = -v }
      END { if (bad || n == 0) print "none"; else printf "%.17g", worst/size }' "$1/nodes.tab")" 0 1e-12
}
for state in CPE4 CPS4; do
   for law in PENALTY LINEAR HARD; do
      case $law in
      PENALTY) delta=1e-8; edit='' ;;
      LINEAR) delta=1e-8; edit='s/OVERCLOSURE=PENALTY/OVERCLOSURE=LINEAR/; s/^1e-8$/1e8/' ;;
      HARD) delta=0; edit='s/OVERCLOSURE=PENALTY/OVERCLOSURE=HARD/; /^1e-8$/d' ;;
      esac
      name=$state-$law
      sed "s/TYPE=CPE4/TYPE=$state/; $edit" "$here/patch.inp" >"$name-two.inp"
      sed 's/^UP-BOTTOM, LOW-TOP$/LOW-TOP, UP-BOTTOM/' "$name-two.inp" >"$name-two-other.inp"
      sed "s/TYPE=CPE4/TYPE=$state/; $edit" "$here/rigid.inp" >"$name-rigid.inp"
      one "$name-two" "$name-two.inp" $state $delta 0
      one "$name-two-other" "$name-two-other.inp" $state $delta 0
      one "$name-rigid" "$name-rigid.inp" $state $delta 1
   done
done
run 0 "$here/nonmatching.inp" nonmatching --digits 17 --quiet
near 'nonmatching resultant' "$(summary nonmatching normal_resultant)" 1 1e-10
near 'nonmatching equilibrium' "$(summary nonmatching equilibrium_residual)" 0 1e-10
finish
