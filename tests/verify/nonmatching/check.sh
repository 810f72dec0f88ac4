. "$(dirname "$0")/../lib.sh"

# swap DECK A B: the deck with the roles of its pair exchanged.
swap() {
   sed "s/^$2, $3\$/swapped/; s/^swapped\$/$3, $2/" "$1"
}

# 1. Inclined cut: exact, also for a joint of 5 faces on 7, either side the slave
for slope in 0.1 0.3 0.45; do
   cp "$here/cut.inp" up.inp
   swap up.inp UP-BOTTOM LOW-TOP >low.inp
   for slave in up low; do
      name=$slave-$slope
      run 0 $slave.inp "$name" --set slope=$slope --digits 17 --quiet
      says "$name" "$name/$slave.lst" N-MORTAR
      all_near "$name: pressure" "$name/contact.tab" pressure "$(value "1/(1 + $slope*$slope)")" 1e-10
      all_near "$name: size of the slip" "$name/contact.tab" slip "$(value "-1e-4*$slope/0.5")" 1e-14
      all_near "$name: s22" "$name/stress.tab" s22 -1 1e-10
      all_near "$name: s12" "$name/stress.tab" s12 0 1e-10
   done
done
run 4 "$here/cut.inp" steep --set slope=0.51
says 'steep' steep.err 'body UP'
absent steep

# 2. A wedge pushed up a ramp: F/G = (tan a + nu)/(1 - nu tan a), the NAFEMS case with tan a = .1 and nu = .3 and another
# bound FOLDER WORD
bound() {
   sed -n "s/^# .*$2 \\([-0-9.e+]*\\).*/\\1/p" "$1/limit.tab"
}
cp "$here/wedge.inp" wedge.inp
swap wedge.inp WEDGE-BOTTOM RAMP-TOP >ramp.inp
for slave in wedge ramp; do
   for case in 0.1:0.3 0.15:0.2; do
      slope=${case%:*}
      nu=${case#*:}
      name=$slave-$case
      rm -rf "$name"
      "$atrito" limit $slave.inp -o "$name" --vary F=0:1 --set slope="$slope" --set nu="$nu" --digits 17 >"$name.out" 2>"$name.err" ||
         complain "$name: exit $?"
      wanted=$(value "($slope + $nu)/(1 - $nu*$slope)")
      near "$name: stands" "$(bound "$name" 'stands at')" "$wanted" 1e-6
      near "$name: falls" "$(bound "$name" 'falls at')" "$wanted" 1e-6
   done
done

# 3. Flat punch on a half plane: 20 faces on 28, either side the slave
# punch NAME FRICTION
punch() {
   awk -v above=20 -v below=28 -v type=CPE9 -v roles="$3" -v friction="$2" -f "$here/punch.awk" </dev/null >"$1.inp"
   run 0 "$1.inp" "$1" --digits 17 --quiet
}
# at FOLDER COLUMN X: a column of contact.tab at a place, linear between points; its size.
at() {
   awk -v name="$2" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 } !/^#/ { print $at["x"], $at[name] }' "$1/contact.tab" |
      sort -g | awk -v x="$3" '{ if (NR > 1 && last <= x && x <= $1) found = v + ($2 - v)*(x - last)/($1 - last); last = $1; v = $2 }
         END { if (found < 0) found = -found; printf "%.17g", found }'
}
# stuck FOLDER: the end of the points that stick.
stuck() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $at["status"] == 1 && $at["x"] > most { most = $at["x"] } END { printf "%.17g", most }' "$1/contact.tab"
}
for roles in 0 1; do
   punch smooth-$roles '' $roles
   for x in 0 0.25 0.5 0.75; do
      wanted=$(value "1/(atan2(0, -1)*sqrt(1 - $x*$x))")
      near "smooth punch, roles $roles: p at $x" "$(at smooth-$roles pressure $x)" "$wanted" "$(value "0.004*$wanted")"
   done
   # no slip, nu = 0.3 (B03)
   punch stuck-$roles '*FRICTION/50' $roles
   for row in 0.25:0.342657467:0.01638715267 0.5:0.3815167429:0.03934873545 0.75:0.4938749242:0.09091054632; do
      x=${row%%:*}
      p=${row#*:}
      q=${p#*:}
      p=${p%:*}
      near "stuck punch, roles $roles: p at $x" "$(at stuck-$roles pressure "$x")" "$p" "$(value "0.005*$p")"
      near "stuck punch, roles $roles: q at $x" "$(at stuck-$roles shear "$x")" "$q" "$(value "0.01*$q")"
   done
   # half width of stick (B04, coupled); elements there are 0.03 to 0.1 long
   for row in 0.2:0.360433:0.08 0.3:0.689163:0.05 0.4:0.864404:0.03; do
      nu=${row%%:*}
      c=${row#*:}
      punch "friction-$nu-$roles" "*FRICTION/$nu" $roles
      near "punch, nu $nu, roles $roles: sticks to" "$(stuck "friction-$nu-$roles")" "${c%:*}" "${c#*:}"
   done
done

# 4. Receding contact of a layer: 40 faces on 56, against elements that match and are four times smaller
run 0 "$here/receding.inp" fine --set above=160 --set below=160 --set rows=20 --digits 17 --quiet
cp "$here/receding.inp" layer.inp
swap layer.inp LAYER-BOTTOM FOUNDATION-TOP >foundation.inp
# extent FOLDER: of the points with a pressure
extent() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $at["pressure"] > 0 && $at["x"] > most { most = $at["x"] } END { printf "%.17g", most }' "$1/contact.tab"
}
for slave in layer foundation; do
   run 0 $slave.inp $slave --digits 17 --quiet
   run 0 $slave.inp $slave-10 --digits 17 --quiet --set q=10
   for x in 0 0.5 1 1.4; do
      near "receding, slave $slave: p at $x" "$(at $slave pressure $x)" "$(at fine pressure $x)" 0.008
   done
   near "receding, slave $slave: extent" "$(extent $slave)" "$(extent fine)" 0.1
   near "receding, slave $slave: extent under ten times the load" "$(extent $slave-10)" "$(extent $slave)" 0
   near "receding, slave $slave: p under ten times the load" "$(at $slave-10 pressure 0)" "$(value "10*$(at $slave pressure 0)")" 1e-9
done
finish
