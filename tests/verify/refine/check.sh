. "$(dirname "$0")/../lib.sh"
# rows FILE: how many there are.
rows() {
   grep -vc '^#' "$1"
}
# deck_of NEW DECK TYPE: the deck with elements of this type; of nine nodes four-node elements take the corners, and the numbers from
# 11 on, which are those of the others, go.
deck_of() {
   awk -v type="$3" '
      BEGIN { four = substr(type, 4) == "4" }
      /^\*/ { in_list = /^\*N(ODE|SET)/; in_elements = /^\*ELEMENT/; sub(/TYPE=CPE9/, "TYPE=" type); sub(/STATE/, type) }
      four && in_elements && !/^\*/ { split($0, n, ","); print n[1] "," n[2] "," n[3] "," n[4] "," n[5]; next }
      four && in_list && !/^\*/ && $1 + 0 > 10 { next }
      { print }' "$2" >"$1"
}
# linear patch test; round-off grows with the number of equations, and stresses are 1000 times strains
for type in CPE4 CPE9 CPS4 CPS9; do
   deck_of "patch-$type.inp" "$here/patch.inp" $type
   case $type in
   CPE*) c='1000/1.3/0.4'; s11="$c*(0.7*0.001 - 0.3*0.003)"; s22="$c*(-0.7*0.003 + 0.3*0.001)" ;;
   CPS*) c='1000/0.91'; s11="$c*(0.001 - 0.3*0.003)"; s22="$c*(-0.003 + 0.3*0.001)" ;;
   esac
   for level in 0 1 2 3; do
      out=patch-$type-$level
      run 0 "patch-$type.inp" "$out" --refine $level --digits 17 --quiet
      case $type in *4) points=4 ;; *9) points=9 ;; esac
      near "$out stress points" "$(rows "$out/stress.tab")" "$(value "4*4^$level*$points")" 0
      field_near "$out u1" "$out/nodes.tab" u1 '0.001*x + 0.002*y' 3e-15
      field_near "$out u2" "$out/nodes.tab" u2 '0.0005*x - 0.003*y' 3e-15
      all_near "$out s11" "$out/stress.tab" s11 "$(value "$s11")" 4e-12
      all_near "$out s22" "$out/stress.tab" s22 "$(value "$s22")" 4e-12
      all_near "$out s12" "$out/stress.tab" s12 "$(value '1000/2.6*0.0025')" 4e-12
   done
done
# contact patch test
for level in 0 1 2 3; do
   out=contact-$level
   run 0 "$here/../patch/patch.inp" "$out" --refine $level --digits 17 --quiet
   near "$out points" "$(rows "$out/contact.tab")" "$(value "2*2^$level + 1")" 0
   all_near "$out pressure" "$out/contact.tab" pressure 100 1e-10
   all_near "$out s22" "$out/stress.tab" s22 -100 1e-10
   near "$out resultant" "$(summary "$out" normal_resultant)" 100 1e-11
   near "$out area" "$(summary "$out" candidate_area)" 1 1e-15
done
# bending: quadratic displacements
u1='0.01*x*y'
u2='-0.005*(x*x + 0.3*y*y)'
deck_of bending-CPS9.inp "$here/bending.inp" CPS9
deck_of bending-CPS4.inp "$here/bending.inp" CPS4
for level in 0 1 2; do
   out=nine-$level
   run 0 bending-CPS9.inp "$out" --refine $level --digits 17 --quiet
   field_near "$out u1" "$out/nodes.tab" u1 "$u1" 1e-14
   field_near "$out u2" "$out/nodes.tab" u2 "$u2" 1e-13
   field_near "$out s11" "$out/stress.tab" s11 '10*y' 1e-11
   all_near "$out s22" "$out/stress.tab" s22 0 1e-11
   all_near "$out s12" "$out/stress.tab" s12 0 1e-11
done
says 'the listing' nine-2/bending-CPS9.lst '2 times: each element of the deck is 16 now'
# largest TABLE: the largest error of a displacement.
largest() {
   awk '!/^#/ { x = $3; y = $4; a = $5 - ('"$u1"'); b = $6 - ('"$u2"'); if (a < 0) a = -a; if (b < 0) b = -b
                if (a > most) most = a; if (b > most) most = b }
        END { printf "%.17g", most }' "$1"
}
for level in 1 2 3 4; do
   out=four-$level
   run 0 bending-CPS4.inp "$out" --refine $level --digits 17 --quiet
   error=$(largest "$out/nodes.tab")
   [ $level -gt 1 ] && near "$out order of the displacements" "$(value "log($before/$error)/log(2)")" 2 0.05
   before=$error
done
# loads and reactions
for type in CPS4 CPE9 CPE8; do
   case $type in *4) nodes=3 ;; *) nodes=5 ;; esac
   sed "s/STATE/$type/; s/^HELD/A-BOTTOM, 1, 2/" "$here/loads.inp" >"set-$type.inp"
   sed "s/STATE/$type/" "$here/loads.inp" |
      awk -v n=$nodes '/^HELD/ { for (i = n; i >= 1; i--) print i ", 1, 2"; next } { print }' >"numbers-$type.inp"
   for level in 0 1 2; do
      for way in set numbers; do
         out=$way-$type-$level
         run 0 "$way-$type.inp" "$out" --refine $level --digits 17 --quiet
         near "$out held nodes" "$(rows "$out/reactions.tab")" "$(value "($nodes - 1)*2^$level + 1")" 0
         near "$out reactions along 1" "$(column "$out/reactions.tab" r1 | awk '{ s += $1 } END { printf "%.17g", s }')" \
            "$(value "3.5 - 0.75 - $nodes*0.5")" 1e-12
         near "$out reactions along 2" "$(column "$out/reactions.tab" r2 | awk '{ s += $1 } END { printf "%.17g", s }')" 23 1e-12
      done
      same_tables "$type $level: by set and by number" "set-$type-$level/nodes.tab" "numbers-$type-$level/nodes.tab" 0
   done
done
# example 2: finer by --refine and by NX, NY
for type in CPS4 CPS9 CPS8 CPS3 CPS6; do
   sed "s/CPS4/$type/" "$input/ex2-two-plates.inp" >"beams-$type.inp"
   sed "s/CPS4/$type/; s/NX=20, NY=4/NX=40, NY=8/" "$input/ex2-two-plates.inp" >"finer-$type.inp"
   run 0 "beams-$type.inp" "refined-$type" --refine 1 --digits 17 --quiet
   run 0 "finer-$type.inp" "finer-$type" --digits 17 --quiet
   same_tables "$type: contact table" "refined-$type/contact.tab" "finer-$type/contact.tab" 1e-9
   energy=$(summary "finer-$type" strain_energy)
   near "$type: strain energy" "$(summary "refined-$type" strain_energy)" "$energy" "$(value "1e-10*$energy")"
   near "$type: resultant" "$(summary "refined-$type" normal_resultant)" 5000 1e-7
done
finish
