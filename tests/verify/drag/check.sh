. "$(dirname "$0")/../lib.sh"
last() { # FOLDER QUANTITY: the last value of summary.tab, that of the end of the history
   summary "$1" "$2" | tail -n 1
}
history() { # FOLDER COLUMN STEP INCREMENT: of history.tab
   awk -v name="$2" -v step="$3" -v increment="$4" '/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
      !/^#/ && $1 == step && $2 == increment { print $at[name] }' "$1/history.tab"
}
told() { # FOLDER: steps, increments and outer iterations as they were told
   sed -n 's/^ *\(step [0-9]*  increment [0-9]*\)  time .*\(outer [0-9]*\).*/\1 \2/p' "$1.out" "$1.err"
}

for form in dense sparse; do
   run 0 "$here/drag.inp" "drag-$form" --digits 17 --contact $form --progress all
   near "$form back" "$(last "drag-$form" shear_resultant)" 10 1e-9
   near "$form normal" "$(last "drag-$form" normal_resultant)" 20 1e-9
   near "$form increments" "$(told "drag-$form" | wc -l)" 21 0
   # on the plateaus the block is carried along as a whole, by 0.005 and 0.01 an increment, and friction takes nu N times that
   for k in 6 7 8 9 10; do
      near "$form, there, increment $k: force" "$(history "drag-$form" shear_resultant 2 $k)" -10 1e-9
      near "$form, back, increment $k: force" "$(history "drag-$form" shear_resultant 3 $k)" 10 1e-9
      near "$form, there, increment $k: dissipation" \
         "$(value "$(history "drag-$form" dissipation 2 $k) - $(history "drag-$form" dissipation 2 $((k - 1)))")" 0.05 5e-12
      near "$form, back, increment $k: dissipation" \
         "$(value "$(history "drag-$form" dissipation 3 $k) - $(history "drag-$form" dissipation 3 $((k - 1)))")" 0.1 1e-11
   done
   # on the plateau the increment before is the solution but for the rigid slip: few iterations
   run 0 "$here/drag.inp" "there-$form" --digits 17 --contact $form --quiet --set back=0.1
   near "$form on" "$(last "there-$form" shear_resultant)" -10 1e-9
done
run 0 "$here/drag.inp" km --digits 17 --contact dense --set L=1e-3 --set F=1e-6 --progress all
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
   run 4 "$here/push.inp" "fall-$form" --digits 17 --contact $form --progress all
   says "$form beyond" "fall-$form.err" 'ended in step 2, increment'
   says "$form beyond" "fall-$form.err" 'free to move along x1'
   says "$form beyond" "fall-$form.err" 'what converged before is written'
   near "$form until" "$(last "fall-$form" shear_resultant)" -10 0.017
   time=$(sed -n 's/.*ended in step 2, increment [0-9]*, time \([^:]*\):.*/\1/p' "fall-$form.err")
   near "$form, the increment that failed" "$time" 1.6255 0.0011
   # 0.4 goes whole; another one would be past the limit, half of it is not
   near "$form, whole" "$(history "fall-$form" time 2 1)" 1.4 1e-12
   near "$form, halved" "$(history "fall-$form" time 2 2)" 1.6 1e-12
   says "$form, halved" "fall-$form.err" 'increment 2 of step 2 has no solution; cut'
   near "$form, halved once" "$(grep -c 'increment 2  time 1.6  outer .*  cut 1 time' "fall-$form.err")" 1 0
done

# Newton's method in three iterations: half a way at once is too much for it, its parts are not
few() { # METHOD DATA: drag.inp with increments of half a way
   awk -v method="$1" -v data="$2" '/^\*STATIC/ && steps++ { print "*CONTROLS, METHOD=NEWTON, MAXIT=3\n*STATIC" method; getline; print data; next }
      { print }' "$here/drag.inp"
}
few '' '0.5, 1, 0.001' >short.inp
few ', DIRECT' '0.5, 1' >direct.inp
run 0 short.inp short --digits 17 --progress all
for step in 2 3; do
   below "few iterations, step $step: uncut" "$(grep -c "of step $step has no solution; cut" short.err | awk '{ print ($1 == 0) }')" 1
done
near 'few iterations: there' "$(awk '$1 == 2 { f = $6 } END { print f }' short/history.tab)" -10 1e-9
near 'few iterations: back' "$(last short shear_resultant)" 10 1e-9
run 3 direct.inp direct --digits 17
says 'few iterations, DIRECT' direct.err 'ended in step 2, increment 2'
finish
