. "$(dirname "$0")/../lib.sh"
# S_rho on the five points of the block's base, spacing 0.25, rho = 0.6, w = 1/8, 1/4, 1/4, 1/4, 1/8. A unit of pressure force at point k
# adds c_k = sum_j w_j W_jk / w_k to the sum of w_j S_rho(p)_j. `most_friction 1`: at the best point; `most_friction H`: at the best two
# points with the resultant where the moment of H at mid-height puts it.
most_friction() {
   awk -v h="$1" 'BEGIN {
      for (j = 1; j <= 5; j++) w[j] = (j == 1 || j == 5) ? 0.125 : 0.25
      for (j = 1; j <= 5; j++) {
         sum = 0
         for (k = 1; k <= 5; k++) { q = (j - k)*0.25/0.6; v[k] = (q*q < 1) ? exp(1/(q*q - 1))*w[k] : 0; sum += v[k] }
         for (k = 1; k <= 5; k++) c[k] += w[j]*v[k]/sum/w[k]
      }
      x = 0.5 + h/2
      for (k = 1; k <= 5; k++) for (l = k + 1; l <= 5; l++) {
         share = (x - (k - 1)*0.25)/((l - k)*0.25)
         if (share < 0 || share > 1) continue
         f = 0.3*((1 - share)*c[k] + share*c[l]); if (f > best) best = f
      }
      for (k = 1; k <= 5; k++) if (h == 1 && 0.3*c[k] > best) best = 0.3*c[k]
      printf "%.17g", best }' </dev/null
}

# forces that would do exist, so the loop's failure is no proof: exit 3, and that is told
undecided() {
   run 3 "$1.inp" "$1-0.31" --set side=0.31 --quiet
   says "$1 H=0.31" "$1-0.31.err" 'there are forces that the contact can take and that balance the loads'
   near "$1 H=0.31 beyond nu N, and not beyond the best average" "$(value "0.31 > 0.3 && 0.31 < $(most_friction 0.31)")" 1 0
}

hold() { # NAME LAW
   sed "s/^\*CONTACT PAIR/$2\n*CONTACT PAIR/" "$here/../free-motion/block.inp" >"$1.inp"
   for side in 0.05 0.2 0.29; do
      run 0 "$1.inp" "$1-$side" --set side=$side --quiet --digits 17
      near "$1 H=$side shear" "$(summary "$1-$side" shear_resultant)" "-$side" 1e-10
      near "$1 H=$side normal" "$(summary "$1-$side" normal_resultant)" 1 1e-10
      near "$1 H=$side equilibrium" "$(summary "$1-$side" equilibrium_residual)" 0 1e-10
   done
   for side in 0.31 0.6; do
      # averaged, friction is greatest where all pressure is at one point: nothing proves that 0.31 has no solution
      case $1-$side in averaged*-0.31) undecided "$1"; continue ;; esac
      run 4 "$1.inp" "$1-$side" --set side=$side
      says "$1 H=$side" "$1-$side.err" 'body CRATE'
      says "$1 H=$side" "$1-$side.err" 'free to move along x1'
      # H beyond nu N, with both numbers
      before='nu times N = '
      case $1 in averaged*) before='friction holds ' ;; esac
      most=$(sed -n "s/.*$before\([^ ]*\) \[F\].*/\1/p" "$1-$side.err")
      near "$1 H=$side, told" "$(sed -n 's/.* drives it with H = \([^ ]*\) \[F\].*/\1/p' "$1-$side.err")" "$side" 1e-4
      case $1 in
         averaged*) near "$1 H=$side, $most told is a bound" \
            "$(value "$most >= $(most_friction $side) && $most <= $(most_friction 1)")" 1 0 ;;
         *) near "$1 H=$side, nu N told" "$most" 0.3 1e-4 ;;
      esac
      near "$1 H=$side, shortfall told" "$(sed -n 's/.*), \([^ ]*\) \[F\] too little.*/\1/p' "$1-$side.err")" \
         "$(value "$side - $most")" 1e-4
      near "$1 H=$side, N told" "$(sed -n 's/.*(N = \([^ ]*\) \[F\][,)].*/\1/p' "$1-$side.err")" 1 1e-4
      says "$1 H=$side" "$1-$side.err" 'it has no support'
      absent "$1-$side"
   done
}
hold coulomb '*FRICTION\n0.3'
hold stick-slope '*FRICTION\n0.3, 1e4'
hold local-eps '*FRICTION, NONLOCAL\n0.3, 1e-5, 0'
hold local-exact '*FRICTION, NONLOCAL\n0.3, 0, 0'
hold averaged '*FRICTION, NONLOCAL\n0.3, 1e-5, 0.6'
hold averaged-exact '*FRICTION, NONLOCAL\n0.3, 0, 0.6'
finish
