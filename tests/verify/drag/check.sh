. "$(dirname "$0")/../lib.sh"
last() { # FOLDER QUANTITY: the last value of summary.tab, that of the end of the history
   summary "$1" "$2" | tail -n 1
}
told() { # FOLDER: steps, increments and outer iterations as they were told
   sed -n 's/^ *\(step [0-9]*  increment [0-9]*\)  time .*\(outer [0-9]*\).*/\1 \2/p' "$1.out" "$1.err"
}

for form in dense sparse; do
   run 0 "$here/drag.inp" "drag-$form" --digits 17 --contact $form
   near "$form back" "$(last "drag-$form" shear_resultant)" 10 1e-9
   near "$form normal" "$(last "drag-$form" normal_resultant)" 20 1e-9
   near "$form increments" "$(told "drag-$form" | wc -l)" 21 0
   # on the plateau the increment before is the solution but for the rigid slip: few iterations
   run 0 "$here/drag.inp" "there-$form" --digits 17 --contact $form --quiet --set back=0.1
   near "$form on" "$(last "there-$form" shear_resultant)" -10 1e-9
done
run 0 "$here/drag.inp" km --digits 17 --contact dense --set L=1e-3 --set F=1e-6
told drag-dense >m.counts
told km >km.counts
cmp m.counts km.counts || complain 'other units, other iterations'
near 'back in other units' "$(last km shear_resultant)" 1e-5 1e-14
column drag-dense/contact.tab shear | tail -n 9 >dense.shear
column drag-sparse/contact.tab shear | tail -n 9 >sparse.shear
near 'both forms, shear' "$(paste dense.shear sparse.shear | awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > m) m = d } END { print m + 0 }')" 0 1e-8

for form in dense sparse; do
   run 0 "$here/push.inp" "back-$form" --digits 17 --contact $form --quiet --set push=9.6
   near "$form unloaded" "$(last "back-$form" shear_resultant)" 0 1e-9
   column "back-$form/contact.tab" shear | tail -n 9 >"back-$form.shear"
   # pressed alone it is antisymmetric
   below "$form: what slipped stays" 0.5 "$(awk '{ s[NR] = $1 } END { for (i = 1; i <= 9; i++) { d = s[i] + s[10 - i]; if (d > m) m = d } print m }' \
      "back-$form.shear")"
   run 4 "$here/push.inp" "fall-$form" --digits 17 --contact $form
   says "$form beyond" "fall-$form.err" 'ended in step 2, increment'
   says "$form beyond" "fall-$form.err" 'free to move along x1'
   says "$form beyond" "fall-$form.err" 'what converged before is written'
   near "$form until" "$(last "fall-$form" shear_resultant)" -10 0.017
   time=$(sed -n 's/.*ended in step 2, increment [0-9]*, time \([^:]*\):.*/\1/p' "fall-$form.err")
   near "$form, the increment that failed" "$time" 1.6255 0.0011
done
finish
