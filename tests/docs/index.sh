#!/bin/sh
# The index by feature in docs/developer/testing.md names all tests that there are, and no other.
#    index.sh SOURCE
. "$(dirname "$0")/../tools/lib.sh"
cd "$1" || exit 9
awk -F'|' '/^## / { on = /Index by feature/ } on && /^\| / && !/^\| feature/ {
   for (k = 3; k <= 5; k++) { n = split($k, names, /[ ,]+/); for (i = 1; i <= n; i++) if (names[i] != "") print k, names[i] } }' \
   docs/developer/testing.md | sort >"$work/told"
{
   find tests/unit -name 'test_*.pf' | sed 's,.*/test_,,; s,^atrito_,,; s,\.pf$,,; s,^,3 ,'
   sed -n 's/.*atrito_add_verification(\([a-z0-9-]*\).*/4 \1/p' tests/verify/CMakeLists.txt
   ls tests/errors/*.txt | sed 's,.*/,,; s,\.txt$,,; /CMakeLists/d; s,^,5 ,'
} | sort -u >"$work/there"
sort -u "$work/told" | comm -3 - "$work/there" >"$work/differ"
while read -r line; do
   fail "column and name told or there, but not both: $line"
done <"$work/differ"
[ -z "$(uniq -d "$work/told")" ] || fail "told twice: $(uniq -d "$work/told")"
finish
