#!/bin/sh
# What `atrito compare` answers about a folder of tables and broken copies of it, by its exit code.
#    compare_tables.sh ATRITO FOLDER
. "$(dirname "$0")/lib.sh"
atrito=$1
folder=$2

expect() { # expect CODE WHAT ARGUMENTS: the exit code of compare
   code=$1
   what=$2
   shift 2
   "$atrito" compare "$@" >"$work/said" 2>&1
   found=$?
   if [ "$found" -ne "$code" ]; then
      fail "$what: exit $found, expected $code"
      cat "$work/said"
   fi
}

fresh() { # a copy of the folder
   rm -rf "$work/copy"
   mkdir "$work/copy"
   cp "$folder"/*.tab "$work/copy"
}

fresh
expect 0 'a copy' "$folder" "$work/copy"
expect 1 'a folder that is not there' "$folder" "$work/none"
expect 5 'two that are not there' "$work/none" "$work/none"

# the last real number, before the increment, of the first, a middle and the last row of each table that is compared, by 1e-5 of itself or to 1e-5
for table in contact nodes reactions stress; do
   [ -f "$folder/$table.tab" ] || continue
   rows=$(grep -c -v '^#' "$folder/$table.tab")
   for row in 1 $(((rows + 1) / 2)) "$rows"; do
      fresh
      awk -v row="$row" '/^#/ { print; next }
         { n++; k = NF - 1; if (n == row) $k = sprintf("%.12e", $k == 0 ? 1e-5 : $k * 1.00002); print }' \
         "$folder/$table.tab" >"$work/copy/$table.tab"
      # of its own value: noticed in a column as large as it; the column of one value always is
      expect "$(awk -v row="$row" '/^#/ { next } { n++; k = NF - 1; a = $k < 0 ? -$k : $k; if (a > s) s = a; if (n == row) v = a }
         END { d = v == 0 ? 1e-5 : 2e-5 * v; if (v == 0 && s == 0) s = 0; print (d > 1e-6 * s) ? 1 : 0 }' "$folder/$table.tab")" \
         "$table, row $row, last number changed" "$folder" "$work/copy"
   done
done

fresh
rm "$work/copy/summary.tab"
expect 1 'a missing table' "$folder" "$work/copy"

fresh
sed '$d' "$folder/summary.tab" >"$work/copy/summary.tab"
expect 1 'a missing row' "$folder" "$work/copy"

fresh
sed 's/^# columns: *step/# columns: stage/' "$folder/summary.tab" >"$work/copy/summary.tab"
expect 1 'another column' "$folder" "$work/copy"

fresh
{ echo '# NOT CONVERGED'; cat "$folder/summary.tab"; } >"$work/copy/summary.tab"
expect 1 'a run that did not converge' "$folder" "$work/copy"

fresh
awk '/equilibrium_residual/ { $(NF - 1) = "2e-8" } { print }' "$folder/summary.tab" >"$work/copy/summary.tab"
expect 1 'a large residual' "$folder" "$work/copy"

fresh
awk '/equilibrium_residual/ { $(NF - 1) = "9e-9" } { print }' "$folder/summary.tab" >"$work/copy/summary.tab"
expect 0 'another small residual' "$folder" "$work/copy"

fresh
sed 's/^# deck:.*/# deck: another.inp/; s/^# program:.*/# program: atrito 99/' "$folder/summary.tab" >"$work/copy/summary.tab"
rm -f "$work/copy/timing.tab"
expect 0 'other comment lines, no timing' "$folder" "$work/copy"

fresh
printf 'not a table\n' >"$work/copy/summary.tab"
expect 5 'a file that is no table' "$folder" "$work/copy"

fresh
awk '/^#/ { print; next } { n++; if (n == 2) NF--; print }' "$folder/summary.tab" >"$work/copy/summary.tab"
expect 5 'a row with a value too few' "$folder" "$work/copy"

finish
