. "$(dirname "$0")/../lib.sh"

# middle FOLDER CURVATURE: pressure at the axis over that of Hertz for the load found, less one.
middle() {
   awk -v k="$2" '!/^#/ { w = $13; q += 2*w*$8; if ($5*$5 < 1e-20) p = $8 }
      END { pi = atan2(0, -1); a = sqrt(4*q/(k*pi*500/0.91)); printf "%.17g", p/(2*q/(pi*a)) - 1 }' "$1/contact.tab"
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
finish
