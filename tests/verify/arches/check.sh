. "$(dirname "$0")/../lib.sh"

arch() { # FILE N T NU ACROSS
   awk -v n="$2" -v t="$3" -v nu="$4" -v across="$5" -f "$here/arch.awk" >"$1"
}

# statics WHAT FOLDER N T: the springings carry the weight, and the sum of the rigid floor's normal stresses is it.
statics() {
   weight=$(value "$3*0.5*sin(atan2(0, -1)/$3)*((1 + $4/2)^2 - (1 - $4/2)^2)")
   last=$(($3 + 1))
   near "$1: the springings carry the weight" "$(awk -v last="$last" '
      !/^#/ && ($2 == 1 || $2 == last) && $3 == "normal_resultant" { sum += $4 } END { printf "%.17g", sum }' "$2/summary.tab")" \
      "$weight" "$(value "1e-8*$weight")"
   near "$1: thrusts of the springings" "$(awk -v last="$last" '
      !/^#/ && ($2 == 1 || $2 == last) && $3 == "shear_resultant" { sum += $4 } END { printf "%.17g", sum }' "$2/summary.tab")" \
      0 "$(value "1e-8*$weight")"
}

# N, what is varied, its limit; stands above it and falls below it by 1e-6 of it.
for limit in "9 thickness 0.1015254676" "20 thickness 0.1073477445" "9 friction 0.3089884871" "20 friction 0.3088770773"; do
   # shellcheck disable=SC2086 # three words
   set -- $limit
   n=$1
   what=$2
   for across in 1 2; do
      for side in above below; do
         factor=$([ $side = above ] && echo 1.000001 || echo 0.999999)
         varied=$(value "$3*$factor")
         if [ "$what" = thickness ]; then t=$varied; nu=1; else t=0.2; nu=$varied; fi
         arch "$what-$n-$across-$side.inp" "$n" "$t" "$nu" $across
         for form in dense sparse; do
            name=$what-$n-$across-$side-$form
            if [ $side = above ]; then
               run 0 "$what-$n-$across-$side.inp" "$name" --contact $form --digits 17 --quiet
               statics "$name" "$name" "$n" "$t"
            else
               run 4 "$what-$n-$across-$side.inp" "$name" --contact $form --quiet
               absent "$name"
               says "$name" "$name.err" 'free to '
            fi
         done
      done
   done
done
finish
