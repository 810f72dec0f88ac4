#!/bin/sh
# check-law.awk must notice a change in the tables: law-must-fail.sh ATRITO RANDOM_DECKS
set -u
here=$(CDPATH="" cd -- "$(dirname -- "$0")" && pwd)
mkdir -p law && cd law || exit 2
failures=0
tried=0
for k in 3 7 12 16 23 31 40 58; do
   "$2" $k 1 >deck.inp
   rm -rf out
   "$1" deck.inp -o out --digits 17 --quiet 2>said || { cat said; exit 1; }
   awk -f "$here/check-law.awk" deck.inp out/contact.tab out/nodes.tab || { echo "deck $k: a right table is refused"; failures=$((failures + 1)); }
   nu=$(awk '$3 == "nu" && /scene/ { print $5 }' deck.inp)
   size=$(awk '/^#/ { next } { for (i = 5; i <= 6; i++) { v = $i < 0 ? -$i : $i; if (v > top) top = v } } END { printf "%.17g", top }' out/nodes.tab)
   # the point of largest pressure: its pressure by a millionth, its shear a millionth beyond the bound, its gap and slip by a millionth
   # of the largest displacement
   for column in pressure shear gap slip; do
      awk -v name=$column -v nu="$nu" -v size="$size" '
         FNR == 1 { file++ }
         /^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2 }
         /^#/ { if (file == 2) print; next }
         file == 1 { n++; if ($place["pressure"] + 0 > most) { most = $place["pressure"] + 0; row = n } next }
         { m++; c = place[name]; v = $c
           if (m == row && name == "pressure") v = v*(1 + 1e-6)
           if (m == row && name == "shear") v = 1.000001*nu*$place["weighted_pressure"]
           if (m == row && (name == "gap" || name == "slip")) v += 1e-6*size
           $c = sprintf("%.16e", v); print }' out/contact.tab out/contact.tab >changed.tab
      tried=$((tried + 1))
      if awk -f "$here/check-law.awk" deck.inp changed.tab out/nodes.tab >/dev/null; then
         echo "deck $k: a wrong $column is not noticed"
         failures=$((failures + 1))
      fi
   done
done
echo "$tried changes, $failures not noticed"
[ "$tried" -eq 32 ] && [ "$failures" -eq 0 ]
