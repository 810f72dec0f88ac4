. "$(dirname "$0")/../lib.sh"
hold() { # NAME LAW
   sed "s/^\*CONTACT PAIR/$2\n*CONTACT PAIR/" "$here/../free-motion/block.inp" >"$1.inp"
   for side in 0.05 0.2 0.29; do
      run 0 "$1.inp" "$1-$side" --set side=$side --quiet --digits 17
      near "$1 H=$side shear" "$(summary "$1-$side" shear_resultant)" "-$side" 1e-10
      near "$1 H=$side normal" "$(summary "$1-$side" normal_resultant)" 1 1e-10
      near "$1 H=$side equilibrium" "$(summary "$1-$side" equilibrium_residual)" 0 1e-10
   done
   for side in 0.31 0.6; do
      run 4 "$1.inp" "$1-$side" --set side=$side
      says "$1 H=$side" "$1-$side.err" 'body CRATE'
      says "$1 H=$side" "$1-$side.err" 'free to move along x1'
      # H beyond nu N, with both numbers; the average moves pressure off the ends and across them, which takes 3 % of it
      off=1e-4
      case $1 in averaged*) off=1.2e-2 ;; esac
      near "$1 H=$side, told" "$(sed -n 's/.* drives it with H = \([^ ]*\) \[F\].*/\1/p' "$1-$side.err")" "$side" 1e-4
      near "$1 H=$side, nu N told" "$(sed -n 's/.*nu times N = \([^ ]*\) \[F\].*/\1/p' "$1-$side.err")" 0.3 $off
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
