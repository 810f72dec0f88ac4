. "$(dirname "$0")/../lib.sh"

wall() { # FILE COURSES LENGTH NU FACTOR
   awk -v courses="$2" -v len="$3" -v nu="$4" -v factor="$5" -f "$here/wall.awk" >"$1"
}

# Courses, length, limit of the factor for nu = 5: a thousandth above it nothing stands, which is proved.
for limit in "4 4 1" "6 9 1.5" "10 19 1.863411851855"; do
   # shellcheck disable=SC2086 # three words
   set -- $limit
   name=wall-$1-$2
   wall "$name.inp" "$1" "$2" 5 "$(value "1.001*$3")"
   run 4 "$name.inp" "$name" --contact sparse --quiet
   absent "$name"
   says "$name" "$name.err" 'free to '
   says "$name" "$name.err" 'rotate about'
   # a thousandth below it no proof is claimed, whether a solution is found or not
   wall "$name-below.inp" "$1" "$2" 5 "$(value "0.999*$3")"
   "$atrito" "$name-below.inp" -o "$name-below" --contact sparse --quiet >"$name-below.out" 2>"$name-below.err"
   code=$?
   echo "$name: exit $code a thousandth below the limit"
   case $code in
      0 | 3) ;;
      *) complain "$name: exit $code a thousandth below the limit" ;;
   esac
done

floor_is() { # FOLDER QUANTITY VALUE: the sum over the pairs of two blocks with the floor
   near "$1: $2" "$(awk -v q="$2" '!/^#/ && ($2 == 1 || $2 == 2) && $3 == q { s += $4 } END { printf "%.17g", s }' "$1/summary.tab")" "$3" 1e-8
}

# Solved in both forms: the floor carries the weight and the push.
for form in dense sparse; do
   wall stands.inp 4 4 5 0.1
   run 0 stands.inp stands-$form --contact $form --digits 17 --quiet
   floor_is stands-$form normal_resultant 16
   floor_is stands-$form shear_resultant -1.6
done

# Much friction: states of points oscillate unless bounds take smaller steps.
for factor in 0.4 0.5 0.6; do
   wall "firm-$factor.inp" 4 4 5 "$factor"
   run 0 "firm-$factor.inp" "firm-$factor" --contact sparse --digits 17 --quiet
   floor_is "firm-$factor" normal_resultant 16
   floor_is "firm-$factor" shear_resultant "$(value "-16*$factor")"
done
for factor in 0.45 0.6; do
   wall "firm-30-$factor.inp" 6 9 5 "$factor"
   run 0 "firm-30-$factor.inp" "firm-30-$factor" --contact sparse --quiet
done
# Many points change their states at once: the number of solves is not that of blocks that open.
wall many.inp 10 19 0.6 0.2
run 0 many.inp many --contact sparse --quiet
below 'many: linear solves' "$(column many/iterations.tab inner | wc -l)" 70
finish
