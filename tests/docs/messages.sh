#!/bin/sh
# Each message that the sources can print has a cause and a cure in docs/user/messages.md, which has no other.
#    messages.sh SOURCE
. "$(dirname "$0")/../tools/lib.sh"
cd "$1" || exit 9
page=docs/user/messages.md

# documented PAGE: the names in its tables; rows without a cause or a cure are told
documented() {
   awk -F' *[|] *' '/^\| [EWN]-[A-Z]/ {
      if ($3 == "" || $(NF - 1) == "" || NF < 5) { print "no cause or no cure: " $2 >"/dev/stderr"; next }
      n = split($2, names, /, */); for (i = 1; i <= n; i++) print names[i] }' "$1" 2>"$work/bare" | sort -u
}

grep -rhowE '[EWN]-[A-Z]+(-[A-Z]+)*' --include='*.f90' --include='*.c' src | sort -u >"$work/printed"
documented $page | comm -3 - "$work/printed" >"$work/differ"
cat "$work/bare"
[ ! -s "$work/bare" ] || fail "$page"
while read -r name; do fail "printed or in $page, but not both: $name"; done <"$work/differ"

sed '/^| E-DATA /d; s/^\(| E-EMPTY |.*|\).*|$/\1 |/; s/^| W-BLAS /| W-BLASS /' $page >"$work/faulty.md"
documented "$work/faulty.md" | comm -3 - "$work/printed" | tr -d '\t' | tr '\n' ' ' >"$work/differ"
[ "$(cat "$work/differ")$(cat "$work/bare")" = 'E-DATA E-EMPTY W-BLAS W-BLASS no cause or no cure: E-EMPTY' ] ||
   fail "faults are not noticed: $(cat "$work/differ" "$work/bare")"
finish
