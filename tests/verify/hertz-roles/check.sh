. "$(dirname "$0")/../lib.sh"

# middle FOLDER CURVATURE [RATIO]: pressure at the axis over that of Hertz for the load found, less one; one body RATIO times as stiff.
middle() {
   awk -v k="$2" -v ratio="${3:-1}" '!/^#/ { w = $13; q += 2*w*$8; if ($5*$5 < 1e-20) p = $8 }
      END { pi = atan2(0, -1); a = sqrt(4*q/(k*pi*1000/0.91/(1 + 1/ratio))); printf "%.17g", p/(2*q/(pi*a)) - 1 }' "$1/contact.tab"
}

# pair NAME LIMIT BETWEEN CURVATURE OPTIONS: either side as slave, against the closed form and each other.
pair() {
   for slave in A B; do
      awk -v slave=$slave -f "$here/bodies.awk" -v type="$5" -v n="$6" -v m="$7" -v radius="$8" -v load="$9" >"$1-$slave.inp"
      run 0 "$1-$slave.inp" "$1-$slave" --digits 17 --quiet
      near "$1, slave $slave: p(0)/p0 - 1" "$(middle "$1-$slave" "$4")" 0 "$2"
   done
   near "$1: p(0) of either role" "$(middle "$1-A" "$4")" "$(middle "$1-B" "$4")" "$3"
}
# 0.1 % of the closed form; 0.02 % between the roles, where the meshes are the same
pair flat4 1e-3 2e-4 0.1 CPE4 32 32 0 3.9
pair flat9 1e-3 2e-4 0.1 CPE9 32 32 0 3.9
pair flat6 1e-3 2e-4 0.1 CPE6 64 64 0 3.9
# R = 6: sides that do not match, so MORTAR; the discretisations of the roles differ
pair mortar9 1e-3 5e-4 0.16666666666666667 CPE9 40 31 15 6
pair mortar6 1e-3 5e-4 0.16666666666666667 CPE6 80 62 15 6
# a cylinder in a bore of radius 11: the half plane is good to (a/R)^2, 0.0025
pair bore9 2.5e-3 2e-4 0.0090909090909090912 CPE9 40 40 -11 1

# p(0) within a share of 1/n^2 (Q1), 1.2/n^2 (Q2), and of the finite bodies: order 2, whichever element the edge of the contact is in
for type in CPE4 CPE8 CPE9; do
   case $type in *4) share=0.65 ;; *) share=1 ;; esac
   for n in 12 16 24 32 48 64; do
      limit=$(value "$share/($n*$n) + 1.5e-4")
      pair order$type-$n "$limit" 2e-4 0.1 $type $n $n 0 3.9
   done
done

# A rigid cylinder on an elastic block, and the elastic cylinder on a rigid plane: E* is twice as large, so is the load for a/R = 0.03
for type in CPE4 CPE8 CPE9; do
   for case in A:B B:A; do
      name=rigid-$type-${case#*:}
      awk -v slave="${case%:*}" -v rigid="${case#*:}" -v type=$type -v n=32 -v m=32 -v radius=0 -v load=7.8 -f "$here/bodies.awk" >"$name.inp"
      run 0 "$name.inp" "$name" --digits 17 --quiet
      near "$name: p(0)/p0 - 1" "$(middle "$name" 0.2)" 0 1e-3
   done
done

# Chords that do not match: 50 elements on 20, 24 on 40, of bodies alike and of one that is ten times as stiff
# unequal NAME LIMIT CURVATURE N M RADIUS LOAD
unequal() {
   for slave in A B; do
      for ratio in 1 10; do
         awk -v slave=$slave -f "$here/bodies.awk" -v type=CPE4 -v n="$4" -v m="$5" -v radius="$6" -v load="$7" |
            sed "s/^\*SOLID SECTION, ELSET=A, MATERIAL=M/*SOLID SECTION, ELSET=A, MATERIAL=STIFF/
               s/^\*MATERIAL, NAME=M/*MATERIAL, NAME=STIFF\n*ELASTIC\n${ratio}000, 0.3\n&/" >"$1-$slave.inp"
         run 0 "$1-$slave.inp" "$1-$slave" --digits 17 --quiet
         near "$1, slave $slave, ratio $ratio: p(0)/p0 - 1" "$(middle "$1-$slave" "$3" $ratio)" 0 "$2"
      done
   done
}
unequal plane5020 4e-3 0.1 50 20 0 3.9
unequal plane2440 4e-3 0.1 24 40 0 3.9
unequal cylinders5020 4e-3 0.16666666666666667 50 20 15 6
unequal bore5020 6e-3 0.0090909090909090912 50 20 -11 1
unequal bore2440 6e-3 0.0090909090909090912 24 40 -11 1
finish
