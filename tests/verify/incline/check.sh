. "$(dirname "$0")/../lib.sh"
for slope in 0.1 0.3 0.45; do
   run 0 "$here/incline.inp" "s$slope" --set slope=$slope --digits 17 --quiet
   all_near "tan=$slope pressure" "s$slope/contact.tab" pressure "$(awk -v t=$slope 'BEGIN { printf "%.17g", 1/(1 + t*t) }')" 1e-10
   all_near "tan=$slope shear" "s$slope/contact.tab" shear "$(awk -v t=$slope 'BEGIN { printf "%.17g", t/(1 + t*t) }')" 1e-10
   all_near "tan=$slope slip" "s$slope/contact.tab" slip "$(awk -v t=$slope 'BEGIN { printf "%.17g", -1e-4*t/0.5 }')" 1e-14
   all_near "tan=$slope s22" "s$slope/stress.tab" s22 -1 1e-10
done
for slope in 0.51 0.6; do
   run 4 "$here/incline.inp" "s$slope" --set slope=$slope
   says "tan=$slope" "s$slope.err" 'body UP'
   says "tan=$slope" "s$slope.err" 'free to'
   absent "s$slope"
done
finish
