#!/bin/sh
# The views of --show by their tables; see README.md.
. "$(dirname "$0")/../lib.sh"
deck=$input/ex1-plate-on-support.inp
run 0 "$deck" plain --quiet --digits 17
run 0 "$deck" shown --digits 17 --show element=3 --show matrix --show line --show states --show law --show picard
for table in contact summary nodes reactions stress extremes resultants iterations; do
   sed '/^# digest/d' "plain/$table.tab" >a; sed '/^# digest/d' "shown/$table.tab" >b
   cmp a b || complain "$table.tab is another one with --show"
done
says 'the screen' shown.out '3 of 8 eigenvalues are 0'
says 'the states' shown.out 'ooo===='

# holds WHAT FILE...: an awk program prints how far a relation is off, relative
small() { awk -v x="$2" 'BEGIN { exit !(x != "" && x < 1e-12) }' || complain "$1: off by $2"; }
small 'K_e is the sum of B D B' "$(awk '/^#/ { next }
   $1 == "B" { b[$2, $3, $4] = $5 } $1 == "w" { w[$2] = $5; n = $2 } $1 == "D" { d[$3, $4] = $5 } $1 == "K" { k[$3, $4] = $5 }
   END { for (i = 1; i <= 8; i++) for (j = 1; j <= 8; j++) { s = 0
            for (p = 1; p <= n; p++) for (r = 1; r <= 3; r++) for (c = 1; c <= 3; c++) s += w[p]*b[p, r, i]*d[r, c]*b[p, c, j]
            e = s - k[i, j]; if (e < 0) e = -e; if (e > most) most = e; if (k[i, j] > size) size = k[i, j] }
         print most/size }' shown/show-element.tab)"
small 'the contact line' "$(awk '/^#/ { next } FILENAME ~ /motions/ { h = $2; a = $3; next }
   { m++; g0[m] = $3; d[m] = $4; q[m] = $5; r[m] = $6; g[m] = $7; for (j = 8; j <= NF; j++) c[m, j - 7] = $j }
   END { for (i = 1; i <= m; i++) { s = g0[i] - d[i]*q[i] + g[i]*a - r[i]; for (j = 1; j <= m; j++) s -= c[i, j]*q[j]
            f += g[i]*q[i]; if (s < 0) s = -s; if (s > most) most = s }
         f -= h; if (f < 0) f = -f; print (most/0.014 > f/1.5 ? most/0.014 : f/1.5) }' shown/show-motions.tab shown/show-line.tab)"
heights=$(awk '!/^#/ && $1 == 1 { n += $2 - $8 + 1 } END { print n }' shown/show-matrix.tab)
[ "$heights" = 4329 ] || complain "heights add up to $heights"
says 'profile' shown/ex1-plate-on-support.lst '4329'
grep -v '^#' shown/show-law.tab >law; grep -v '^#' shown/contact.tab >contact
small 'the law of friction' "$(paste law contact | awk '
   { u = $11; v = u < 0 ? -u : u; t = $9*(v < 1 ? u : u/v); e = t - $10; if (e < 0) e = -e; f = $10 + $21; if (f < 0) f = -f
     if (e > most) most = e; if (f > most) most = f; n++ } END { if (n == 7) print most }')"
small 'the last bound' "$(awk '/^#/ { next } FILENAME ~ /contact/ { bound[$3] = 0.3*$9; next } { last[$3] = $8 }
   END { for (i = 1; i <= 7; i++) { e = bound[i] - last[i]; if (e < 0) e = -e; if (e > most) most = e } print most/3.5 }' \
   shown/contact.tab shown/show-picard.tab)"
small 'the first bound' "$(awk '/^#/ { next } $1 == 0 { bound[$3] = 0.3*$7 } $1 == 1 { e = bound[$3] - $8; if (e < 0) e = -e; if (e > most) most = e; n++ }
   END { if (n == 7) print most/3.4 }' shown/show-picard.tab)"
awk '/^#/ { next } FILENAME ~ /iterations/ { n++; row[n] = $7" "$8" "$9; next }
   { m++; s = $NF; o = gsub(/o/, "", s); k = gsub(/=/, "", s); if (row[m] != o" "k" "length(s)) print "solve " m ": " row[m] }
   END { if (n != m || n == 0) print n " solves, " m " of states" }' shown/iterations.tab shown/show-states.tab >found
[ -s found ] && { complain 'states'; cat found; }

# reduced integration: what one point in the middle does not feel is told
sed 's/CPE4/CPE4R/' "$deck" >reduced.inp
run 0 reduced.inp reduced --show element=3 --format csv
says 'reduced integration' reduced.out '3 of 8 eigenvalues are 0'
grep -q 'less K_e: 0\.[0-9]* of the largest' reduced.out || complain 'the hourglass control is no part of the sum'
[ -s reduced/show-element.csv ] || complain 'no show-element.csv'

# what cannot be seen
refused() { run 1 "$deck" refused --quiet "$@"; says "$2" refused.err "$word"; absent refused; }
word='they are 1 to 111' refused --show element=999
word='sparse form' refused --show states --contact sparse
word='element=N, matrix' refused --show all
word='points; 200 at most' refused --show law --refine 6
finish
